"""Search for a counterexample: a point where the enclosure of an expression excludes zero."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import sympy as sp

from lagrotor.algebra.enclosures import DIGITS, Point, PointEnclosure, enclosed_at, excludes_zero, working_digits
from lagrotor.algebra.evidence import points
from lagrotor.algebra.scalar import node_count
from lagrotor.algebra.signs import Region
from lagrotor.errors import NotExactError

_FIRST = 2  # points that are tried before a proof
_LARGE = 2000  # nodes beyond which an expression is evaluated at four points only
_SIZES = ((sp.S.One, 6), (sp.Rational(1, 8), 3), (sp.Integer(5), 4))  # (scale of the symbols, number of points)


class _Witness(NamedTuple):
    """A point where the enclosure of an expression excludes zero; `real` is True if all subexpressions are real there."""

    point: Point
    real: bool


class Sample(NamedTuple):
    """The witness that a search found, or None, and the number of points at which the expression was enclosed."""

    witness: _Witness | None
    enclosed: int


def find_witness(expression: sp.Expr, where: Region) -> Sample:
    """Search for a witness, preferably one where all subexpressions are real."""
    complex_witness: _Witness | None = None
    enclosed, size = 0, node_count(expression)
    symbols = expression.free_symbols | set().union(*(e.free_symbols for e, _ in where.above))
    for point in _points(symbols, where):
        if enclosed > 3 and size > _LARGE:
            break
        witness, defined = _at(expression, point)
        enclosed += defined
        if witness is not None and witness.real:
            return Sample(witness, enclosed)
        complex_witness = complex_witness or witness
    return Sample(complex_witness, enclosed)


def is_refuted(expression: sp.Expr, where: Region) -> bool:
    """Return True if one of the first points shows that a real expression is not zero everywhere in the region."""
    symbols = expression.free_symbols | set().union(*(e.free_symbols for e, _ in where.above))
    witnesses = (_at(expression, point)[0] for point in islice(_points(symbols, where), _FIRST))
    return any(witness is not None and witness.real for witness in witnesses)


def _points(symbols: set[sp.Symbol], where: Region) -> Iterator[Point]:
    for seed, (scale, number) in enumerate(_SIZES, 1):
        for point in points(symbols, number if not where.above else 4 * number, scale, seed):
            if all(_certainly_above(e, point) for e, _ in where.above):
                yield point


def _certainly_above(e: sp.Expr, point: Point) -> bool:
    try:
        return bool(enclosed_at(e, point, 20).real.a > 0)
    except NotExactError:
        return False


def _at(expression: sp.Expr, point: Point) -> tuple[_Witness | None, bool]:
    with working_digits(DIGITS):
        enclosure = PointEnclosure(point)
        try:
            value = enclosure.value(expression)
        except (NotExactError, RecursionError):
            return None, False
        if not excludes_zero(value):
            return None, True
        return _Witness({**point, **enclosure.jets}, enclosure.real), True
