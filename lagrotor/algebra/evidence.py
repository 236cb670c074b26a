"""Numeric evidence: values of an expression at random rational points that its symbols allow."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator
from functools import reduce
from operator import add, mul
from typing import Any, TypeAlias

import sympy as sp
from mpmath import mp

from lagrotor.errors import NotExactError

Point: TypeAlias = dict[sp.Symbol, sp.Expr]

_POINTS = 8
_DIGITS = 34
# Larger arguments of functions and larger exponents are not evaluated: their values have too many digits.
_LARGEST = 1e30
_FUNCTIONS: dict[Any, Any] = {
    **{f: getattr(mp, f.__name__) for f in (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc)},
    **{f: getattr(mp, f.__name__) for f in (sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.sech, sp.csch)},
    **{f: getattr(mp, f.__name__) for f in (sp.asin, sp.acos, sp.atan, sp.acot, sp.asinh, sp.acosh, sp.atanh)},
    **{sp.exp: mp.exp, sp.log: mp.log, sp.sign: mp.sign, sp.Abs: mp.fabs},
}
_CONSTANTS = {sp.pi: mp.pi, sp.E: mp.e, sp.EulerGamma: mp.euler, sp.Catalan: mp.catalan, sp.GoldenRatio: mp.phi}


def points(symbols: Iterable[sp.Symbol], number: int = _POINTS) -> Iterator[Point]:
    """Random rational points, the same at each call, of the sign and the kind that each symbol was declared with.

    A symbol of which nothing is declared takes real values of both signs.
    """
    generator = random.Random(1)
    ordered = sorted(symbols, key=sp.default_sort_key)
    for _ in range(number if ordered else 1):
        yield {symbol: _drawn(symbol, generator) for symbol in ordered}


def _drawn(symbol: sp.Symbol, generator: random.Random) -> sp.Expr:
    value = sp.Rational(generator.randrange(150, 950), 499)
    sign = generator.choice((-1, 1))
    if symbol.is_zero:
        return sp.S.Zero
    if symbol.is_integer:
        value = sp.Integer(4 * generator.randrange(1, 9) + (2 if symbol.is_even else 1))
        value = sp.Integer(generator.choice((5, 7, 11, 13))) if symbol.is_prime else value
    if symbol.is_imaginary:
        return sp.I * value * sign
    if symbol.is_extended_nonnegative or (sign > 0 and not symbol.is_extended_nonpositive):
        return value
    return -value


def largest_value(expression: sp.Expr, at: Iterable[Point] | None = None) -> tuple[Point | None, float | None]:
    """Return the point, of those given or of some random ones, where |expression| is largest, and that value.

    Both are None without a value.
    """
    best: tuple[Point | None, float | None] = (None, None)
    for point in points(expression.free_symbols) if at is None else at:
        size = size_at(expression, point)
        if size is not None and (best[1] is None or size > best[1]):
            best = point, size
    return best


def size_at(expression: sp.Expr, point: Point) -> float | None:
    """|expression| at the point, None where it cannot be computed."""
    values = []
    for digits in (_DIGITS, 2 * _DIGITS):
        with mp.workdps(digits):
            try:
                values.append(abs(value_at(expression, point)))
            except (ArithmeticError, NotExactError, TypeError, ValueError, RecursionError):
                return None
    # At a pole hidden by rounding, the value depends on the number of digits.
    if not mp.almosteq(*values, 1e-9, 1e-20) or not values[1] < 1e300:
        return None
    return float(values[1])


def sign_at(expression: sp.Expr, point: Point) -> int | None:
    """The sign of an expression that is +1 or -1 wherever it is defined; None where it is not."""
    with mp.workdps(_DIGITS):
        try:
            value = mp.re(value_at(expression, point))
        except (ArithmeticError, NotExactError, TypeError, ValueError):
            return None
    return int(mp.sign(value)) if abs(abs(value) - 1) < 1e-9 else None


def value_at(expression: sp.Expr, point: Point) -> Any:
    """The value at the precision in force; raise NotExactError where a function has no value here or one too large."""
    known: dict[sp.Expr, Any] = {}

    def value(node: sp.Expr) -> Any:
        if node not in known:
            known[node] = _combined(node, [value(part) for part in node.args]) if node.args else _leaf(node, point)
        return known[node]

    return value(expression)


def _leaf(node: sp.Expr, point: Point) -> Any:
    if node in point:
        return value_at(point[node], {})
    if node.is_Rational:
        return mp.mpf(node.p) / node.q
    if node.is_Float:
        return mp.mpf(node)
    if node is sp.I:
        return mp.mpc(0, 1)
    if node in _CONSTANTS:
        return +_CONSTANTS[node]
    raise NotExactError(f"{node} is not evaluated.")


def _combined(node: sp.Expr, arguments: list[Any]) -> Any:
    """The value of a node whose parts have these values."""
    if node.is_Add or node.is_Mul:
        return reduce(add if node.is_Add else mul, arguments)
    if (function := mp.power if node.is_Pow else _FUNCTIONS.get(node.func)) is None:
        raise NotExactError(f"{node.func} is not evaluated.")
    if abs(arguments[-1]) > _LARGEST:
        raise NotExactError(f"An argument of {node.func} is larger than {_LARGEST:.0e}.")
    return function(*arguments)
