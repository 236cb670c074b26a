"""The linear response of the coupled pair at rest to an impulse, in closed form, for any two spins and any bar.

With q = (x, y_1, y_2) the linear pair is M q'' + C q' = Q(t). One integral is at once M q' + C q = p(t), the impulse
received so far. C has one null vector n, along which the pair topples or twists, and N = M⁻¹ C satisfies
N³ = −Omega² N. So the response to a unit impulse is a polynomial in N:

    H(s) = n nᵀ s / (n.M n) + D (1 − cos Omega s) + S sin(Omega s) / Omega,
    D = −N M⁻¹ / Omega²  (displacement that stays),    S = −N² M⁻¹ / Omega²  (velocity of the swing).

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
    """H(s) = drift s + displacement (1 − cos Omega s) + swing sin(Omega s)/Omega, all (3, 3), in (x, y_1, y_2).

    `mass`, `gyroscopic`: M and C in the same order; `null`: n, (3, 1); `frequency_squared`: Omega².
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
    """The matrices of the response to a unit impulse, from the linear pair (symbols a, b, G_1, G_2)."""
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
    """The linear pair with its coordinates in the order (x, y_1, y_2), read off the basis (rows x_1, y_1, …, z_2)."""
    rows = [linear.basis.row(i) for i in (0, 1, 4)]
    change = sp.Matrix.vstack(*rows).inv()
    parts = (change.T * m * change for m in (linear.mass, linear.gyroscopic, linear.stiffness))
    mass, gyroscopic, stiffness = parts
    return LinearSystem(mass, gyroscopic, stiffness, linear.basis * change)


def shock_displacement() -> ClosedForm:
    """(x, y_1, y_2) about which the pair precesses just after an impulse: the permanent displacement (1).

    D p with D = −M⁻¹ C M⁻¹ / Omega_0². Arguments: a, b, G_1, G_2 and the impulse's moment R × N s along x, y_1, y_2.
    """
    return _form("shock_displacement", ("x", "y_1", "y_2"), impulse_matrices().displacement * _impulse())


def shock_drift() -> ClosedForm:
    """(x', y_1', y_2') of the mean motion after an impulse, (1/s): n (n.p)/(n.M n), n = (0, G_2, −G_1) up to sign.

    Toppling, y_1' = y_2', for opposite spins; twisting, y_1' = −y_2', for equal ones; never along x.
    """
    return _form("shock_drift", ("x'", "y_1'", "y_2'"), impulse_matrices().drift * _impulse())


def shock_swing() -> ClosedForm:
    """Velocity amplitudes (x, y_1, y_2) of the swing's sine, (1/s), in the limit of a short pulse: S p.

    The motion is displacement (1 − cos Omega s) + (swing/Omega) sin Omega s + drift s.
    """
    return _form("shock_swing", ("x", "y_1", "y_2"), impulse_matrices().swing * _impulse())


def shock_energy() -> ClosedForm:
    """(E_drift, E_swing) in J gained from an impulse: (n.p)²/(2 n.M n) and p.S p/2; their sum is p.M⁻¹ p/2.

    A Gaussian pulse of width w gives E_drift + exp(−(Omega_0 w)²/2) E_swing.
    """
    matrices, p = impulse_matrices(), _impulse()
    along, swing = ((p.T * m * p)[0] / 2 for m in (matrices.drift, matrices.swing))
    across = swing.subs(P_X, 0)
    form = _form("shock_energy", ("E_drift", "E_swing"), sp.Matrix([along, sp.factor(swing - across)]))
    return replace(form, expressions=(form.expressions[0], form.expressions[1] + sp.factor(across)))


def _impulse() -> sp.Matrix:
    return sp.Matrix([P_X, P_1, P_2])


def _form(name: str, outputs: tuple[str, ...], column: sp.Matrix) -> ClosedForm:
    return ClosedForm(
        name,
        outputs,
        tuple(sp.factor(e) for e in column),
        (a, b, G_1, G_2, P_X, P_1, P_2),
        _SPUN,
        "first order in the impulse, from rest upright, any spins not both zero, any bar",
        "4.2, 5, 5.2.1",
        1,
    )
