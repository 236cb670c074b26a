"""Values at a rational point enclosed in intervals: what they exclude is proved, at that point.

Outward rounding at every operation (mpmath.iv). Moore, Kearfott & Cloud, Introduction to Interval Analysis, chs. 2, 7.
"""

from collections.abc import Sequence
from functools import reduce
from operator import add, mul
from typing import Any

import sympy as sp
from mpmath import iv

from lagrotor.algebra.evidence import Point
from lagrotor.errors import NotExactError

_DIGITS = 50
_FUNCTIONS: dict[Any, Any] = {
    sp.sin: lambda x: iv.sin(x),
    sp.cos: lambda x: iv.cos(x),
    sp.tan: lambda x: iv.sin(x) / iv.cos(x),
    sp.cot: lambda x: iv.cos(x) / iv.sin(x),
    sp.sec: lambda x: 1 / iv.cos(x),
    sp.csc: lambda x: 1 / iv.sin(x),
    sp.exp: lambda x: iv.exp(x),
    sp.sinh: lambda x: (iv.exp(x) - iv.exp(-x)) / 2,
    sp.cosh: lambda x: (iv.exp(x) + iv.exp(-x)) / 2,
    sp.tanh: lambda x: 1 - 2 / (iv.exp(2 * x) + 1),
}


def solved_at(A: sp.Matrix, b: sp.Matrix, point: Point) -> list[Any]:
    """Intervals that hold x of A x = b at the point, by elimination.

    Raises NotExactError where something has no enclosure, or A is not shown to be regular.
    """
    before, iv.dps = iv.dps, _DIGITS
    try:
        known: dict[sp.Expr, Any] = {}
        rows = [[_enclosed(e, point, known) for e in row] for row in A.row_join(b).tolist()]
        return _eliminated(rows)
    except (ArithmeticError, ValueError) as error:
        raise NotExactError(f"Not enclosed at {point}: {error}.") from None
    finally:
        iv.dps = before


def apart(left: Sequence[Any], right: Sequence[Any]) -> int | None:
    """The first place where two intervals have no number in common."""
    return next((i for i, (x, y) in enumerate(zip(left, right, strict=True)) if x.b < y.a or y.b < x.a), None)


def _enclosed(e: sp.Expr, point: Point, known: dict[sp.Expr, Any]) -> Any:
    if e not in known:
        known[e] = _of_parts(e, [_enclosed(part, point, known) for part in e.args]) if e.args else _leaf(e, point)
    return known[e]


def _leaf(e: sp.Expr, point: Point) -> Any:
    value = point.get(e, e)
    if value.is_Rational:
        return iv.mpf(value.p) / value.q
    if value is sp.pi:
        return iv.pi
    raise NotExactError(f"{value} is not enclosed.")


def _of_parts(e: sp.Expr, parts: list[Any]) -> Any:
    if e.is_Add or e.is_Mul:
        return reduce(add if e.is_Add else mul, parts)
    if e.is_Pow and e.exp.is_Rational and e.exp.q <= 2:
        return (parts[0] if e.exp.q == 1 else iv.sqrt(parts[0])) ** int(e.exp.p)
    if e.func not in _FUNCTIONS:
        raise NotExactError(f"{e.func} is not enclosed.")
    return _FUNCTIONS[e.func](parts[0])


def _eliminated(rows: list[list[Any]]) -> list[Any]:
    """x from the rows of [A | b]."""
    n = len(rows)
    for j in range(n):
        pivot = max(range(j, n), key=lambda i: abs(rows[i][j].mid))
        rows[j], rows[pivot] = rows[pivot], rows[j]
        if 0 in rows[j][j]:
            raise NotExactError("The matrix is not shown to be regular.")
        for i in range(j + 1, n):
            factor = rows[i][j] / rows[j][j]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[j], strict=True)]
    found: list[Any] = []
    for row in reversed(rows):
        done = row[n - len(found) : n]
        rest = sum((a * x for a, x in zip(done, reversed(found), strict=True)), iv.mpf(0))
        found.append((row[n] - rest) / row[n - len(found) - 1])
    return found[::-1]
