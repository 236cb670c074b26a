"""Whether two systems move alike: decided from their equations of motion."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import TypeVar

import sympy as sp

from lagrotor.algebra import Decision, decide_equal, normal_form
from lagrotor.algebra.enclosures import apart, solved_at
from lagrotor.algebra.evidence import points
from lagrotor.errors import InputError, NotExactError
from lagrotor.mechanics.equations import Equations, constrained_accelerations
from lagrotor.mechanics.expressions import expression, put_in
from lagrotor.mechanics.lagrangian import Coordinates, euler_lagrange, jacobian, t, total_derivative

_POINTS = 3  # at which accelerations are compared before anything is derived
_MOST, _MOST_OPERATIONS = 3, 1000  # coordinates up to which, and operations of M up to which, accelerations are derived

Kind = TypeVar("Kind", bound=Equations)


def same_as(system: Equations, other: Equations) -> Decision:
    """Whether both have the same accelerations in the same coordinates: zero, or nonzero with a witness, and the domain.

    Lagrangians may differ by a factor and a total time derivative; forces and constraints are compared by what they do.
    Under constraints, what agrees only by virtue of them is "undecided".

    Raises InputError when the coordinates are not the same: bring one into those of the other by `in_coordinates`.
    """
    if not isinstance(other, Equations):
        raise InputError(f"same_as: {other!r} is no System to compare with")
    if system.c != other.c:
        raise InputError(
            f"same_as: {system.c.q} and {other.c.q} are not the same coordinates: write one system in those of the other "
            "with in_coordinates"
        )
    if (direct := _from_lagrangians(system, other)).answer == "zero":
        return direct
    if not (system.multipliers or other.multipliers):
        return _refutation(system, other) or _without_constraints(system, other)
    decision = _accelerations(system, other)
    if decision.answer == "nonzero":
        return replace(decision, answer="undecided", reason=f"Off the constraints they differ. {decision.reason}")
    return decision


def _without_constraints(system: Equations, other: Equations) -> Decision:
    """From the Euler–Lagrange expression of what is left of the Lagrangians, then from the accelerations."""
    factor = _factor(system, other)
    left = factor * system.L - other.L
    with suppress(NotExactError):
        left = normal_form(left)
    direct = decide_equal(euler_lagrange(left, system.c), factor * system.push - other.push)
    if direct.answer == "nonzero":
        return _accelerations(system, other)
    return direct


def _accelerations(system: Equations, other: Equations) -> Decision:
    """From both accelerations, where they are short enough to be derived."""
    if (
        len(system.c.q) > _MOST
        and (size := sum(sp.count_ops(each.mass) for each in (system, other))) > _MOST_OPERATIONS
    ):
        return Decision("undecided", (), f"Their mass matrices are too large to be inverted: {size} operations.")
    left, right = (constrained_accelerations(each)[0] for each in (system, other))
    return decide_equal(left, right)


def _refutation(system: Equations, other: Equations) -> Decision | None:
    """Accelerations that differ at a point, where their enclosures are apart; None where none is seen or enclosed."""
    given = [(each.mass, each.push - each.bias) for each in (system, other)]
    symbols = set().union(*(part.free_symbols for pair in given for part in pair))
    for point in points(symbols, _POINTS):
        try:
            left, right = (solved_at(*pair, point) for pair in given)
        except NotExactError:
            continue
        if (i := apart(left, right)) is not None:
            one, two = (float(x[i].mid) for x in (left, right))
            apart_by = sp.Rational(float((left[i] - right[i]).mid))
            reason = f"At the witness {system.c.a[i]} is {one:.6g}, and {two:.6g} of the other."
            return Decision("nonzero", (), reason, seen=apart_by, at=(point,))
    return None


def _factor(system: Equations, other: Equations) -> sp.Expr:
    """By what the other mass matrix is larger, where that is a number or a parameter: from its shortest entry; else 1."""
    entries = [pair for pair in zip(system.mass, other.mass, strict=True) if 0 not in pair]
    mine, theirs = min(entries, key=lambda pair: sp.count_ops(pair), default=(sp.S.One, sp.S.One))
    try:
        ratio = normal_form(theirs / mine)
    except NotExactError:
        return sp.S.One
    return sp.S.One if ratio.free_symbols & {*system.c.q, t} else ratio


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
    if not isinstance(c, Coordinates) or not isinstance(where, Mapping):
        raise InputError(
            f"in_coordinates: give new coordinates(…) and {{old: expression in them, …}}, not {c!r}, {where!r}"
        )
    if lost := [str(q) for q in old.q if q not in where and q not in c.q]:
        raise InputError(
            f"in_coordinates: {', '.join(lost)} neither given nor among the new coordinates {c.q}: give it"
        )
    places = [expression(f"in_coordinates: {q}", where.get(q, q)) for q in old.q]
    put = dict(zip(old.q, places, strict=True))
    put |= {v: total_derivative(e, c) for v, e in zip(old.v, places, strict=True)}

    def rewritten(e: sp.Expr) -> sp.Expr:
        return put_in(sp.sympify(e, strict=True), put)

    slope = jacobian(places, c.q)
    forces = tuple(slope.T * sp.Matrix([rewritten(f) for f in system.forces])) if system.forces else ()

    def left(expressions: tuple[sp.Expr, ...]) -> list[tuple[int, sp.Expr]]:
        moved = [rewritten(e) for e in expressions]
        return [(i, e) for i, e in enumerate(moved) if decide_equal(e, sp.S.Zero).answer != "zero"]

    constraints, rolling = left(system.constraints), left(system.rolling)
    numbers = [*(i for i, _ in constraints), *(len(system.constraints) + i for i, _ in rolling)]
    return replace(
        system,
        c=c,
        lagrangian=rewritten(system.L),
        constraints=tuple(e for _, e in constraints),
        rolling=tuple(e for _, e in rolling),
        names=tuple(system.names[i] for i in numbers) if system.names else (),
        dissipation=rewritten(system.dissipation),
        forces=forces,
        velocities=tuple((u, rewritten(e)) for u, e in system.velocities),
    )
