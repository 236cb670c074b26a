"""What refutes under hypotheses: a point that satisfies them, at which an enclosure keeps the two sides apart."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from lagrotor.algebra.enclosed_roots import enclosed_root
from lagrotor.algebra.enclosures import Bounds, are_apart, enclosure, enclosures
from lagrotor.algebra.evidence import points
from lagrotor.algebra.feasibility import has_principal_values
from lagrotor.algebra.numbering import letters_in_order, without_number
from lagrotor.algebra.proving import evaluated
from lagrotor.algebra.signs import conditions, region
from lagrotor.paper.hypotheses import Hypotheses, replaced

Values: TypeAlias = dict[sp.Symbol, Any]  # letter → an exact value, or two rationals between which it lies
_POINTS, _CHECKED = 40, 2


@dataclass(frozen=True)
class Witness:
    """A point, two rationals of one sign between which the difference of the sides lies, and those of each side there.

    sides: of the printed and of the derived side; None where principal values are meant and that of a side is not real.
    """

    point: Values
    enclosure: Bounds
    sides: tuple[Bounds | None, Bounds | None]


def witness(
    sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr = sp.S.Zero, principal: bool = False
) -> Witness | None:
    """Return a point where the hypotheses hold, both sides are real and |left − right| > beyond ≥ 0; None without one.

    principal: of sides with i or complex letters, and of sides that are real nowhere, principal values count; the absolute
    value of the difference is then enclosed.
    """
    there = sp.Tuple(*map(under.on, sides))
    real = replace(under, region=tuple(dict.fromkeys((*under.region, *conditions(there)))))
    found = _apart(sides, real, beyond, False) if sp.false not in real.region else None
    if found is None and principal and has_principal_values(there, under.left, region(under.inside)):
        return _apart(sides, under, beyond, True)
    return found


def _apart(sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr, principal: bool) -> Witness | None:
    """Return a point of the hypotheses that keeps the sides apart."""
    signed = under.signed
    both = tuple(signed.on(side) for side in sides)
    difference = sides[0] - sides[1]
    e = evaluated(signed.on(difference))
    if signed.contradiction or _says_more(e, signed):
        return None
    for values in _points((e, *both), signed):
        between = enclosure(e, values)
        if principal and between is None:
            between = enclosure(sp.Abs(e, evaluate=False), values)
        if between is not None and (between[0] > beyond or between[1] < -beyond):
            left, right = enclosures(map(evaluated, both), values)
            if principal or (left and right):
                return Witness(_of_letters(difference, under, signed, values), between, (left, right))
    return None


def contradicted(left: Any, right: Any, under: Hypotheses) -> Values | None:
    """Return a point of the hypotheses that keeps two real sides apart that were decided to be equal; None as it should be.

    The sides are enclosed as they came: nothing is put into them.
    """
    signed = under.signed
    for a, b in zip(*(side if isinstance(side, sp.MatrixBase) else [side] for side in (left, right)), strict=True):
        for values in islice(_points([signed.on(a), signed.on(b)], signed), _CHECKED):
            if are_apart(a, b, {**signed.put, **values}):
                return values
    return None


def _says_more(e: sp.Expr, signed: Hypotheses) -> bool:
    """Return whether an equation about a function may fix a derivative of it, or an equation that is left holds one."""
    given = sp.Tuple(*signed.left, *signed.put.values())
    new = e.atoms(sp.Derivative) - given.atoms(sp.Derivative)
    functions = given.atoms(AppliedUndef)
    return any(x.has(AppliedUndef) for x in signed.left) or any(d.has(*functions) for d in new if functions)


def _points(compared: Sequence[sp.Expr], signed: Hypotheses) -> Iterator[Values]:
    """Points of the letters that are left which satisfy all that the hypotheses say."""
    conditions = *signed.left, *signed.region
    order = letters_in_order((without_number(compared[0])[1], *compared[1:], *conditions))
    letters = [s for s in order if any(s in x.free_symbols for x in (*compared, *conditions))]
    scales = (1, 2) if signed.region else (1,)
    for at in chain(*(islice(points(letters, _POINTS, sp.Integer(scale)), _POINTS) for scale in scales)):
        values: Values = dict(at)
        if signed.left:
            box = enclosed_root(signed.left, unknowns, at) if (unknowns := _unknowns(signed, order)) else None
            if box is None:
                continue
            values |= box
        if _as_declared(values) and all(_satisfied(relation, values) for relation in signed.region):
            yield values


def _unknowns(signed: Hypotheses, order: list[sp.Symbol]) -> list[sp.Symbol]:
    """A letter for each equation that is left, each once, of those that are in the fewest; empty where there are too few."""
    found: list[sp.Symbol] = []
    for e in sorted(signed.left, key=lambda e: len(e.free_symbols)):
        free = sorted(e.free_symbols - set(found) - set(signed.small), key=order.index)
        if not free:
            return []
        found.append(free[0])
    return found


def _as_declared(values: Values) -> bool:
    """Return whether the letters that an equation fixes have the signs that they were declared with."""
    return all(
        not ((s.is_extended_nonnegative and v[0] <= 0) or (s.is_extended_nonpositive and v[1] >= 0) or s.is_integer)
        for s, v in values.items()
        if isinstance(v, tuple)
    )


def _satisfied(relation: Relational, values: Values) -> bool:
    """Return whether a condition certainly holds at a point."""
    between = enclosure(sp.sympify(relation.lhs - relation.rhs, strict=True), values)
    if between is None:
        return False
    low, high = between
    if isinstance(relation, sp.StrictGreaterThan | sp.StrictLessThan):
        return bool(low > 0 if isinstance(relation, sp.StrictGreaterThan) else high < 0)
    if isinstance(relation, sp.GreaterThan | sp.LessThan):
        return bool(low >= 0 if isinstance(relation, sp.GreaterThan) else high <= 0)
    return bool(low > 0 or high < 0)


def _of_letters(difference: sp.Expr, under: Hypotheses, signed: Hypotheses, values: Values) -> Values:
    """The point in the letters of the statement: what was eliminated has its value, too."""
    exact = {s: v for s, v in values.items() if not isinstance(v, tuple)}
    found: Values = {}
    for letter in sorted(difference.free_symbols | set(under.put), key=sp.default_sort_key):
        value = signed.on(letter)
        if value in values:
            found[letter] = values[value]
        elif value.free_symbols <= set(exact):
            found[letter] = replaced(value, exact)
        elif (between := enclosure(value, values)) is not None:
            found[letter] = between
    return found
