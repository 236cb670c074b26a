"""Precession rates of one grounded rotor, and of the pair under the paper's ansatz, from their first integrals."""

from functools import cache

import sympy as sp

from lagrotor.mechanics import euler_lagrange, momenta
from lagrotor.mechanics.lagrangian import linear_solve
from lagrotor.pair.lagrangians import ansatz_integrals, rotor_lagrangian
from lagrotor.pair.notation import ANSATZ, I3, M_3, ROTOR, A, B, G, J, M_z, omega
from lagrotor.theory.closed_form import ClosedForm


@cache
def rotor_precession_rate() -> ClosedForm:
    """phi' = (M_z − M_3 cos theta) / (J sin² theta) of one grounded rotor, from its two cyclic momenta (5.02)."""
    theta, (_, phi_v, psi_v) = ROTOR.q[0], ROTOR.v
    p = momenta(rotor_lagrangian(), ROTOR)
    matrix, given = sp.linear_eq_to_matrix([p[1] - M_z, p[2] - M_3], [phi_v, psi_v])
    rate = linear_solve(matrix, given, "rotor_precession_rate: the momenta do not give the rates")[0]
    return ClosedForm(
        "rotor_precession_rate",
        ("phi'",),
        (sp.factor(rate),),
        (theta, M_z, M_3, J),
        (sp.Ne(sp.sin(theta), 0),),
        "one grounded rotor, no gravity",
        "5.02",
    )


@cache
def pair_precession_rate() -> ClosedForm:
    """phi' of the ansatz pair from its integrals A and B, for any J and I_3; the paper's (5.15) for J = I_3 = I."""
    theta_1, theta_2 = ANSATZ.q[:2]
    phi_v, psi_v = ANSATZ.v[2:]
    integral_A, integral_B = ansatz_integrals()
    matrix, given = sp.linear_eq_to_matrix([integral_A - A, integral_B - B], [phi_v, psi_v])
    rate = linear_solve(matrix, given, "pair_precession_rate: the integrals do not give the rates")[0]
    numerator, denominator = sp.fraction(sp.factor(rate))
    return ClosedForm(
        "pair_precession_rate",
        ("phi'",),
        (numerator / denominator,),
        (theta_1, theta_2, A, B, J, I3),
        (sp.Ne(sp.factor(denominator), 0),),
        "the ansatz phi_1' = −phi_2', psi_1' = −psi_2'; a link that exerts nothing",
        "5.15",
    )


@cache
def free_precession_rate() -> ClosedForm:
    """G / (J cos theta): the steady precession of one free grounded rotor about the angular momentum it has (5.23).

    From theta'' = 0 in the Euler–Lagrange equation of theta, sin theta phi' (J cos theta phi' − G) = 0.
    """
    theta, (theta_v, phi_v, psi_v), theta_a = ROTOR.q[0], ROTOR.v, ROTOR.a[0]
    steady = euler_lagrange(rotor_lagrangian(), ROTOR)[0].subs(
        {theta_a: 0, theta_v: 0, psi_v: omega - phi_v * sp.cos(theta)}
    )
    rate = next(root for root in sp.solve(steady, phi_v) if root != 0)
    return ClosedForm(
        "free_precession_rate",
        ("phi'",),
        (rate.subs(omega, G / I3),),
        (theta, G, J),
        (sp.Ne(sp.cos(theta), 0),),
        "one grounded rotor, no gravity, theta constant",
        "5.23",
    )
