"""Numbers as balls, a midpoint and a radius. Arb's arithmetic rounds outward (Johansson 2017).

A decimal denotes the rational number that it prints: 0.1 is 1/10. An interval is a pair (lowest, highest).
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from numbers import Integral, Rational, Real
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.errors import InputError

try:
    from flint import arb, arb_mat, arb_poly, arb_series, ctx, fmpq, fmpz
except ImportError:
    raise InputError("lagrotor.proofs needs python-flint: pip install lagrotor[proof]") from None

Ball: TypeAlias = Any  # flint.arb
Balls: TypeAlias = list[Any]
Matrix: TypeAlias = Any  # flint.arb_mat
ZERO = arb(0)

__all__ = ["arb", "arb_mat", "arb_poly", "arb_series", "ctx", "fmpq"]


@contextmanager
def precision(bits: int, terms: int = 10) -> Iterator[None]:
    """Set the precision of Arb in bits, and the number of terms of its power series, within a `with` block."""
    outer = ctx.prec, ctx.cap
    ctx.prec, ctx.cap = bits, terms
    try:
        yield
    finally:
        ctx.prec, ctx.cap = outer


def rational(value: Any, where: str) -> Fraction:
    """Return the rational number that a value denotes: for a float, the decimal that it prints."""
    if isinstance(value, bool):
        raise InputError(f"{where} = {value!r} must be a number")
    if isinstance(value, Integral | Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    if isinstance(value, sp.Rational):
        return Fraction(int(value.p), int(value.q))
    if isinstance(value, sp.Float):
        value = float(value)
    if isinstance(value, Real):
        value = repr(float(value))
    try:
        return Fraction(Decimal(value)) if isinstance(value, str | Decimal) else Fraction(value)
    except (ArithmeticError, TypeError, ValueError):
        raise InputError(f"{where} = {value!r} must be a finite number, or a pair (lowest, highest)") from None


def upper(x: Ball) -> Ball:
    """Return an upper bound of |x| for all x in a ball."""
    return arb(x.abs_upper())


def exact(x: Ball) -> Ball:
    """Return the midpoint of a ball, an exact number."""
    return x.mid()


def radius(x: Ball) -> Ball:
    """Return an upper bound of the radius."""
    return arb(x.rad().upper())


def around(middle: Ball, wide: Ball) -> Ball:
    """Return the ball about a midpoint with a radius; if these are balls, the result covers all their values."""
    return middle + arb(0, wide.abs_upper())


def max_of(values: Sequence[Ball]) -> Ball:
    """Return the largest upper end of nonnegative balls."""
    largest = ZERO
    for value in values:
        largest = largest.max(upper(value))
    return largest


def as_text(x: Ball) -> str:
    """Return an exact number as text: mantissa in base 16, p, exponent of two. For example, 3p-1 is 3/2."""
    mantissa, exponent = x.man_exp()
    return f"{int(mantissa):x}p{int(exponent)}"


def of_text(text: str) -> Ball:
    mantissa, _, exponent = text.partition("p")
    bits = max(64, 4 * len(mantissa) + 8)
    with ctx.workprec(bits):
        return arb(fmpz(int(mantissa, 16))) * arb(2) ** int(exponent)


def ball_data(x: Ball) -> list[str]:
    return [as_text(exact(x)), as_text(x.rad())]


def balls_data(values: Sequence[Ball]) -> list[list[str]]:
    return [ball_data(x) for x in values]


def exact_data(values: Sequence[Ball]) -> list[str]:
    return [as_text(x) for x in values]


def matrix_data(matrix: Matrix) -> list[list[str]]:
    return [exact_data(row) for row in matrix.tolist()]


def format_ball(x: Ball, digits: int = 30) -> str:
    """Return a ball as text, [8.1234567 +/- 3e-8]; if no digit is certain, return the two ends. The text contains the ball."""
    if x.rel_accuracy_bits() > 3 or abs(x) < 1e-6:
        return str(x.str(digits))
    ends = x.lower() - abs(x.lower()) * 0.01, x.upper() + abs(x.upper()) * 0.01
    low, high = (arb(end).str(3, radius=False) for end in ends)
    return f"[{low}, {high}]"
