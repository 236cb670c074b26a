"""Whether two systems move alike: decided from their equations of motion."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeVar

import sympy as sp

from lagrotor.algebra import Decision, decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations, constrained_accelerations
from lagrotor.mechanics.lagrangian import Coordinates, total_derivative

Kind = TypeVar("Kind", bound=Equations)


def same_as(system: Equations, other: Equations) -> Decision:
    """Whether both have the same accelerations in the same coordinates: zero, or nonzero with a witness, and the domain.

    Lagrangians may differ by a factor and a total time derivative; forces and constraints are compared by what they do.
    Under constraints, what agrees only by virtue of them is "undecided".

    Raises InputError when the coordinates are not the same: bring one into those of the other by `in_coordinates`.
    """
    if system.c != other.c:
        raise InputError(
            f"same_as: {system.c.q} and {other.c.q} are not the same coordinates: write one system in those of the other "
            "with in_coordinates"
        )
    if (direct := _from_lagrangians(system, other)).answer == "zero":
        return direct
    if not (system.multipliers or other.multipliers):
        direct = decide_equal(system.motion, other.motion)
        if direct.answer == "zero":
            return direct
    left, right = (constrained_accelerations(each)[0] for each in (system, other))
    decision = decide_equal(left, right)
    if decision.answer == "nonzero" and (system.multipliers or other.multipliers):
        return replace(decision, answer="undecided", reason=f"Off the constraints they differ. {decision.reason}")
    return decision


def _from_lagrangians(system: Equations, other: Equations) -> Decision:
    """Whether only the Lagrangians may differ, and do not."""
    parts = [(e.constraints, e.rolling, e.dissipation, e.forces) for e in (system, other)]
    if parts[0] != parts[1]:
        return Decision("undecided", (), "More than the Lagrangians may differ.")
    return decide_equal(system.L, other.L)


def in_coordinates(system: Kind, c: Coordinates, where: Mapping[sp.Symbol, sp.Expr]) -> Kind:
    """The system in new coordinates: where = {old coordinate: expression in the new ones and t}, fewer where constraints
    are solved by it; constraints that then vanish identically are left out.

    L, D and the constraints are put in with q(Q, t) and v = dq/dt, forces by the virtual work Q' = (∂q/∂Q)ᵀ Q. Old
    coordinates that are not named keep their names, and must be among the new ones.

    Raises InputError when an old coordinate is neither given nor kept.
    """
    old = system.c
    if lost := [str(q) for q in old.q if q not in where and q not in c.q]:
        raise InputError(
            f"in_coordinates: {', '.join(lost)} neither given nor among the new coordinates {c.q}: give it"
        )
    places = [sp.sympify(where.get(q, q)) for q in old.q]
    put = dict(zip(old.q, places, strict=True))
    put |= {v: total_derivative(e, c) for v, e in zip(old.v, places, strict=True)}

    def carried(e: sp.Expr) -> sp.Expr:
        return sp.sympify(e).subs(put, simultaneous=True)

    slope = sp.Matrix(places).jacobian(list(c.q))
    forces = tuple(slope.T * sp.Matrix([carried(f) for f in system.forces])) if system.forces else ()

    def left(expressions: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
        moved = [carried(e) for e in expressions]
        return tuple(e for e in moved if decide_equal(e, sp.S.Zero).answer != "zero")

    return replace(
        system,
        c=c,
        lagrangian=carried(system.L),
        constraints=left(system.constraints),
        rolling=left(system.rolling),
        dissipation=carried(system.dissipation),
        forces=forces,
    )
