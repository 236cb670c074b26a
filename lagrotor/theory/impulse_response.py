"""The linear response of the coupled pair at rest to an impulse, in closed form, for any two spins and any bar.

The linear pair, q = (x, y_1, y_2), is M q'' + C q' = Q(t), and one integration gives M q' + C q = p(t), with p the impulse
received. C has one null vector n, the direction of toppling or twisting, and N = M⁻¹ C satisfies N³ = −Omega² N. So the
response to a unit impulse is a polynomial in N:

    H(s) = n nᵀ s / (n.M n) + D (1 − cos Omega s) + S sin(Omega s) / Omega,
    D = −N M⁻¹ / Omega²  (permanent displacement),    S = −N² M⁻¹ / Omega²  (velocity of the oscillation).

Derived in derivations/t2_shock_response.py. `theory.shock_response` evaluates it for a scene and its Gaussian pulse.
"""

from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from lagrotor.mechanics import LinearSystem
from lagrotor.pair.notation import G_1, G_2, P_1, P_2, P_X, a, b
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.natural_frequency import linear_pair, natural_frequency

_SPUN = (sp.Gt(a, sp.Abs(b)), sp.Gt(G_1**2 + G_2**2, 0))


@dataclass(frozen=True)
class ImpulseMatrices:
    """Matrices of the response H(s) = drift s + displacement (1 − cos Omega s) + swing sin(Omega s)/Omega, in (x, y_1, y_2).

    Each has the shape (3, 3), except `null`, the null vector n of C, with the shape (3, 1). `mass` is M, `gyroscopic` is C, and
    `frequency_squared` is Omega².
    """

    mass: sp.Matrix
    gyroscopic: sp.Matrix
    null: sp.Matrix
    drift: sp.Matrix
    displacement: sp.Matrix
    swing: sp.Matrix
    frequency_squared: sp.Expr


@cache
def impulse_matrices() -> ImpulseMatrices:
    """Derive the matrices of the response to a unit impulse from the linear pair.

    Returns
    -------
    ImpulseMatrices
        Matrices in (x, y_1, y_2) as functions of a, b (kg m²), G_1, G_2 (kg m²/s).

    References
    ----------
    derivations/t2_shock_response.py.
    """
    linear = _in_plane_order(linear_pair())
    M, C = linear.mass, linear.gyroscopic
    inverse = M.inv().applyfunc(sp.factor)
    squared = natural_frequency().expressions[0] ** 2
    N = (inverse * C).applyfunc(sp.factor)
    # C n = 0 from the cofactors of the antisymmetric C: n = (C_23, −C_13, C_12).
    null = sp.Matrix([C[1, 2], -C[0, 2], C[0, 1]])
    weight = sp.factor((null.T * M * null)[0])
    drift = (null * null.T / weight).applyfunc(sp.factor)
    displacement = (-N * inverse / squared).applyfunc(sp.factor)
    swing = (-N * N * inverse / squared).applyfunc(sp.factor)
    return ImpulseMatrices(M, C, null, drift, displacement, swing, sp.factor(squared))


def _in_plane_order(linear: LinearSystem) -> LinearSystem:
    """Transform the linear system of the pair to the coordinates (x, y_1, y_2). They are the rows x_1, y_1, y_2 of its basis."""
    rows = [linear.basis.row(i) for i in (0, 1, 4)]
    change = sp.Matrix.vstack(*rows).inv()
    matrices = (change.T * m * change for m in (linear.mass, linear.gyroscopic, linear.stiffness))
    mass, gyroscopic, stiffness = matrices
    return LinearSystem(mass, gyroscopic, stiffness, linear.basis * change)


def shock_displacement() -> ClosedForm:
    """Derive the permanent displacement D p, about which the pair precesses just after an impulse p.

    Returns
    -------
    ClosedForm
        The displacement (x, y_1, y_2) in units of R as a function of a, b (kg m²), G_1, G_2 (kg m²/s), p_x, p_1, p_2 (N m s).

    References
    ----------
    Sections 4.2, 5 and 5.2.1 of the paper; derivations/t2_shock_response.py.
    """
    return _form("shock_displacement", ("x", "y_1", "y_2"), impulse_matrices().displacement * _impulse())


def shock_drift() -> ClosedForm:
    """Derive the mean velocity (x', y_1', y_2') in 1/s after an impulse p: n (n.p)/(n.M n) with n = (0, G_2, −G_1).

    Opposite spins topple, y_1' = y_2'; equal spins twist, y_1' = −y_2'; no pair drifts along x.
    """
    return _form("shock_drift", ("x'", "y_1'", "y_2'"), impulse_matrices().drift * _impulse())


def shock_swing() -> ClosedForm:
    """Derive S p, the velocity amplitudes (x, y_1, y_2) in 1/s of the oscillation after a short pulse."""
    return _form("shock_swing", ("x", "y_1", "y_2"), impulse_matrices().swing * _impulse())


def shock_energy() -> ClosedForm:
    """Derive the energies that an impulse p gives to the drift, (n.p)²/(2 n.M n), and to the oscillation, p.S p/2.

    Their sum is p.M⁻¹ p/2. A Gaussian pulse of width w gives E_drift + exp(−(Omega_0 w)²/2) E_swing.

    Returns
    -------
    ClosedForm
        The energies (E_drift, E_swing) in J as functions of a, b (kg m²), G_1, G_2 (kg m²/s), p_x, p_1, p_2 (N m s).

    References
    ----------
    Sections 4.2, 5 and 5.2.1 of the paper; derivations/t2_shock_response.py.
    """
    matrices, p = impulse_matrices(), _impulse()
    drift, swing = ((p.T * m * p)[0] / 2 for m in (matrices.drift, matrices.swing))
    transverse = swing.subs(P_X, 0)
    form = _form("shock_energy", ("E_drift", "E_swing"), sp.Matrix([drift, sp.factor(swing - transverse)]))
    return replace(form, expressions=(form.expressions[0], form.expressions[1] + sp.factor(transverse)))


def _impulse() -> sp.Matrix:
    return sp.Matrix([P_X, P_1, P_2])


def _form(name: str, outputs: tuple[str, ...], column: sp.Matrix) -> ClosedForm:
    assumptions = "first order in the impulse, from rest upright, any spins not both zero, any bar"
    expressions, arguments = tuple(sp.factor(e) for e in column), (a, b, G_1, G_2, P_X, P_1, P_2)
    return ClosedForm(name, outputs, expressions, arguments, _SPUN, assumptions, "4.2, 5, 5.2.1", 1)
