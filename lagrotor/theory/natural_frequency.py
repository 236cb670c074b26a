"""The natural frequency of the coupled pair, for any spins and any bar, and two exact precession rates of the paper.

`lagrotor.theory.natural_rate` evaluates the frequency for a scene.
"""

from functools import cache

import sympy as sp

from lagrotor.mechanics import LinearSystem, euler_lagrange
from lagrotor.mechanics.lagrangian import linear_solve
from lagrotor.pair.lagrangians import ansatz_integrals, axes_pair, rotor_lagrangian
from lagrotor.pair.notation import ANSATZ, AXES, G_1, G_2, I3, ROTOR, A, B, G, J, a, b, omega
from lagrotor.theory.closed_form import ClosedForm


@cache
def linear_pair() -> LinearSystem:
    """Linearise the coupled pair at rest, in (x, y_1, y_2), for any spins and any bar.

    Returns
    -------
    LinearSystem
        M, C and K = 0 as functions of a, b (kg m²) and G_1, G_2 (kg m²/s).

    References
    ----------
    derivations/t1_natural_rate.py.
    """
    return axes_pair().linearise(dict(zip(AXES.q, (0, 0, 1, 0, 0, 1), strict=True)))


@cache
def natural_frequency() -> ClosedForm:
    """Derive Omega_0² = (a (G_1² + G_2²) − 2 b G_1 G_2) / (2 (a + b)(a² − b²)) of the only oscillation of the linear pair.

    The other roots of det(s² M + s C) are zero: rotation about the joint line and displacements at rest. Omega_0 in rad/s, by
    a, b (kg m²), G_1, G_2 (kg m²/s). Equation (5.28) of the paper, corrected; derivations/t1_natural_rate.py.
    """
    s = sp.Symbol("s")
    polynomial = sp.Poly(linear_pair().characteristic(s), s)
    leading, constant = polynomial.coeff_monomial(s**6), polynomial.coeff_monomial(s**4)
    rate, domain = sp.sqrt(sp.factor(constant / leading)), (sp.Gt(a, sp.Abs(b)),)
    assumptions = "small motion about the upright rest state, any spins, any bar"
    return ClosedForm("natural_frequency", ("Omega_0",), (rate,), (a, b, G_1, G_2), domain, assumptions, "5.28")


@cache
def pair_precession_rate() -> ClosedForm:
    """Derive the precession rate phi' under the paper's ansatz, from the integrals A and B of the motion, for any J and I_3.

    The ansatz has no bar, so the rate does not hold for a bar with mass or inertia.

    Returns
    -------
    ClosedForm
        The rate in rad/s as a function of theta_1, theta_2 (rad), A, B (kg m²/s), J, I_3 (kg m²).

    References
    ----------
    Equation (5.15) of the paper, where J = I_3 = I.
    """
    theta_1, theta_2 = ANSATZ.q[:2]
    phi_v, psi_v = ANSATZ.v[2:]
    integral_A, integral_B = ansatz_integrals()
    matrix, right_side = sp.linear_eq_to_matrix([integral_A - A, integral_B - B], [phi_v, psi_v])
    rate = linear_solve(matrix, right_side, "pair_precession_rate: the integrals do not give the rates")[0]
    numerator, denominator = sp.fraction(sp.factor(rate))
    arguments, domain = (theta_1, theta_2, A, B, J, I3), (sp.Ne(sp.factor(denominator), 0),)
    assumptions = "the ansatz phi_1' = −phi_2', psi_1' = −psi_2'; a link that exerts nothing"
    rate = numerator / denominator
    return ClosedForm("pair_precession_rate", ("phi'",), (rate,), arguments, domain, assumptions, "5.15")


@cache
def free_precession_rate() -> ClosedForm:
    """Derive G / (J cos theta), the steady precession rate of one free grounded rotor.

    It follows from theta'' = 0 in the Euler–Lagrange equation of theta, sin theta phi' (J cos theta phi' − G) = 0.

    Returns
    -------
    ClosedForm
        The rate phi' in rad/s as a function of theta (rad), G (kg m²/s), J (kg m²).

    References
    ----------
    Equation (5.23) of the paper.

    Examples
    --------
    >>> free_precession_rate().expressions
    (G/(J*cos(theta)),)
    """
    theta, (theta_v, phi_v, psi_v), theta_a = ROTOR.q[0], ROTOR.v, ROTOR.a[0]
    steady_motion = {theta_a: 0, theta_v: 0, psi_v: omega - phi_v * sp.cos(theta)}
    steady = euler_lagrange(rotor_lagrangian(), ROTOR)[0].subs(steady_motion)
    rate = next(root for root in sp.solve(steady, phi_v) if root != 0)
    rate, domain = rate.subs(omega, G / I3), (sp.Ne(sp.cos(theta), 0),)
    assumptions = "one grounded rotor, no gravity, theta constant"
    return ClosedForm("free_precession_rate", ("phi'",), (rate,), (theta, G, J), domain, assumptions, "5.23")
