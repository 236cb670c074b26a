"""Systems of sympy.physics.mechanics: functions of time become plain letters, forces on points generalised forces.

A Lagrangian of dynamicsymbols with its coordinates, or a LagrangesMethod with its constraints and loads. The generalised force
of a load F at a point of velocity v is F·∂v/∂q', of a torque on a frame of angular velocity ω it is T·∂ω/∂q'. The
multipliers are those of sympy's `mass_matrix_full`; in its `eom` they have the opposite sign, M a + … = Q − Gᵀ λ.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.lagrangian import Coordinates, coordinates, t


def parts_from_sympy(given: Any, q: Sequence[Any] = ()) -> dict[str, Any]:
    """The coordinates and expressions of a `System`, by name.

    Raises InputError for what is neither a Lagrangian with its coordinates nor a LagrangesMethod, and for functions of time that
    are no coordinates.
    """
    from sympy.physics.mechanics import LagrangesMethod, Point, dynamicsymbols

    clock = dynamicsymbols._t
    lagrange = isinstance(given, LagrangesMethod)
    if not lagrange and (not isinstance(given, sp.Expr) or q in ((), [])):
        raise InputError(
            f"from_sympy: {type(given).__name__} must be a LagrangesMethod, or a Lagrangian with its coordinates: "
            "from_sympy(L, (q1, q2)); a KanesMethod has no Lagrangian, give that of its bodies"
        )
    if not isinstance(q, Sequence | sp.MatrixBase):
        raise InputError(f"from_sympy: q = {q!r} must be a tuple of coordinates: write ({q},)")
    functions = list(given.q) if lagrange else list(q)
    if not all(isinstance(f, sp.core.function.AppliedUndef) and f.args == (clock,) for f in functions):
        raise InputError(f"from_sympy: {functions} must be dynamicsymbols, each a coordinate")
    c = coordinates([f.func.__name__ for f in functions])
    if not lagrange:
        return {"c": c, "lagrangian": _plain(given, functions, c, clock)}
    rates, Q = [f.diff(clock) for f in functions], [sp.S.Zero] * len(functions)
    for place, load in given.forcelist or ():
        N = given.inertial
        velocity = place.vel(N) if isinstance(place, Point) else place.ang_vel_in(N)
        Q = [total + velocity.diff(rate, N, var_in_dcm=False).dot(load) for total, rate in zip(Q, rates, strict=True)]
    held = list(given._hol_coneqs)
    return {
        "c": c,
        "lagrangian": _plain(given._L[0] if isinstance(given._L, sp.MatrixBase) else given._L, functions, c, clock),
        "constraints": tuple(_plain(e, functions, c, clock) for e in held),
        "rolling": tuple(_plain(e, functions, c, clock) for e in list(given.coneqs)[len(held) :]),
        "forces": tuple(_plain(e, functions, c, clock) for e in Q) if any(Q) else (),
    }


def _plain(e: Any, functions: Sequence[Any], c: Coordinates, clock: sp.Symbol) -> sp.Expr:
    """An expression of functions of time in plain letters."""
    put: dict[Any, sp.Expr] = {clock: t}
    for f, q, v, a in zip(functions, c.q, c.v, c.a, strict=True):
        put |= {f.diff(clock, 2): a, f.diff(clock): v, f: q}
    return sp.sympify(e).doit().xreplace(put)
