"""Random points that satisfy the assumptions of symbols, and the absolute value of an expression there."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence

import sympy as sp

from lagrotor.algebra.enclosures import Point, enclosed_at, excludes_zero
from lagrotor.errors import NotExactError

_POINTS = 8


def points(
    symbols: Iterable[sp.Symbol], number: int = _POINTS, scale: sp.Rational = sp.S.One, seed: int = 1
) -> Iterator[Point]:
    """Yield random rational points, the same at each call, that satisfy the assumptions of each symbol.

    A symbol without assumptions takes real values of both signs. `scale` multiplies values that need not be integers. Values are
    drawn in the order of a given sequence of symbols, otherwise in the order of their names.
    """
    generator = random.Random(seed)
    ordered = list(symbols) if isinstance(symbols, Sequence) else sorted(symbols, key=sp.default_sort_key)
    for _ in range(number if ordered else 1):
        yield {symbol: _drawn(symbol, generator, scale) for symbol in ordered}


def _drawn(symbol: sp.Symbol, generator: random.Random, scale: sp.Rational) -> sp.Expr:
    value = scale * sp.Rational(generator.randrange(150, 950), 499)
    sign = generator.choice((-1, 1))
    if symbol.is_zero:
        return sp.S.Zero
    if symbol.is_integer:
        value = sp.Integer(generator.randrange(1, 8))
        value = 2 * value + (1 if symbol.is_odd else 0) if symbol.is_even or symbol.is_odd else value
        value = sp.Integer(generator.choice((5, 7, 11, 13))) if symbol.is_prime else value
    if symbol.is_imaginary:
        return sp.I * value * sign
    if symbol.is_extended_nonnegative or (sign > 0 and not symbol.is_extended_nonpositive):
        return value
    return -value


def largest_value(expression: sp.Expr, at: Iterable[Point] | None = None) -> tuple[Point | None, float | None]:
    """Return the point with the largest |expression|, and this value; real points come first. (None, None) without a value."""
    places = list(points(expression.free_symbols) if at is None else at)
    sizes = [(i, size) for i, point in enumerate(places) if (size := magnitude_at(expression, point)) is not None]
    ranked = [(_is_real_at(expression, places[i]), size, i) for i, size in sizes]
    _, size, place = max(ranked, default=(False, None, None))
    return None if place is None else places[place], size


def _is_real_at(expression: sp.Expr, point: Point) -> bool:
    try:
        imaginary = enclosed_at(expression, point).imag
    except (NotExactError, RecursionError):
        return False
    return bool(imaginary.a == imaginary.b == 0)


def magnitude_at(expression: sp.Expr, point: Point) -> float | None:
    """Return |expression| at the point; None if no enclosure is known."""
    try:
        value = enclosed_at(expression, point)
        size = float((abs(value.real.mid) ** 2 + abs(value.imag.mid) ** 2).b) ** 0.5
    except (NotExactError, RecursionError, OverflowError):
        return None
    return size if size < 1e300 else None


def sign_at(expression: sp.Expr, point: Point) -> int | None:
    """Return the sign at a point of an expression that equals +1 or −1 wherever it is defined; None if it is undefined."""
    try:
        value = enclosed_at(expression, point)
    except (NotExactError, RecursionError):
        return None
    if not excludes_zero(value) or not 0.5 < abs(value.real).a < 1.5:
        return None
    return 1 if value.real.a > 0 else -1
