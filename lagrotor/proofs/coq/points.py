"""Rational points at which hypotheses hold, and enclosures of values there."""

import random
from collections.abc import Iterator, Mapping, Sequence
from math import floor, log10
from types import MappingProxyType
from typing import Any

import sympy as sp
from mpmath import mp

from lagrotor.algebra.enclosures import enclosed_at
from lagrotor.errors import NotExactError
from lagrotor.proofs.coq.coq_terms import Comparison

_VALUES = [
    sp.Rational(n, d) for n, d in ((1, 1), (2, 1), (3, 1), (1, 2), (3, 2), (5, 2), (1, 3), (2, 3), (1, 4), (5, 4))
]
_TRIES, _DIGITS, _CLEAR = 200, 30, 1e-6


def points_of(
    symbols: Sequence[sp.Symbol],
    eliminated: Mapping[sp.Symbol, sp.Expr],
    hold: Sequence[Comparison],
    limit: int = 1,
    fixed: Mapping[sp.Symbol, sp.Expr] = MappingProxyType({}),
    zeros: Sequence[sp.Expr] = (),
) -> Iterator[dict[sp.Symbol, sp.Expr]]:
    """Yield up to `limit` points that satisfy the eliminated equations and the conditions, the same ones in each call.

    `fixed` has values of some symbols. `zeros` are further expressions that must vanish; each is a polynomial in one of the
    symbols.
    """
    drawn, count = random.Random(1), 0
    for _ in range(_TRIES):
        free = {x: drawn.choice(_VALUES) * drawn.choice((1, -1)) for x in symbols if x not in eliminated}
        free |= {x: value for x, value in fixed.items() if x in free}
        free = {x: abs(v) if x.is_nonnegative else -abs(v) if x.is_nonpositive else v for x, v in free.items()}
        if zeros and not _solve(free, zeros, drawn):
            continue
        values = {x: sp.sympify(value, strict=True) for x, value in eliminated.items() if x in symbols}
        point = free | {x: value.xreplace(free) for x, value in values.items()}
        if all(_holds(sign, value_at_point(e, point)) for sign, e in hold):
            yield point
            count += 1
            if count == limit:
                return


def _solve(free: dict[sp.Symbol, sp.Expr], zeros: Sequence[sp.Expr], drawn: random.Random) -> bool:
    """Change values in `free` to rational numbers at which all `zeros` vanish; return True if that succeeds."""
    solved: list[tuple[sp.Symbol, sp.Expr]] = []
    for zero in zeros:
        for symbol, value in solved:
            zero = zero.xreplace({symbol: value})
        over = sp.numer(sp.together(zero))
        linear = [x for x in over.free_symbols if over.is_polynomial(x) and sp.degree(over, x) == 1]
        symbols = sorted(linear or over.free_symbols, key=str)
        if not symbols:
            return False
        symbol = drawn.choice(symbols)
        if linear:
            slope, constant = sp.Poly(over, symbol).all_coeffs()
            solved.append((symbol, -constant / slope))
            continue
        others = {x: free[x] for x in symbols if x != symbol}
        if others:  # cosines 3/5 and 5/13 have rational sines
            others[drawn.choice(list(others))] = drawn.choice((sp.Rational(3, 5), sp.Rational(5, 13), sp.S.One))
        over = sp.numer(sp.together(over.xreplace(others)))
        if not over.is_polynomial(symbol) or not (roots := sp.Poly(over, symbol).ground_roots()):
            return False
        solved += [(symbol, drawn.choice(sorted(roots))), *others.items()]
    for symbol, value in reversed(solved):
        free[symbol] = value.xreplace(free)
    return all(zero.xreplace(free) == 0 for zero in zeros)


def _holds(sign: str, value: Any) -> bool:
    if value is None:
        return False
    return bool(abs(value) > _CLEAR if sign == "<>" else value > _CLEAR if sign == "<" else value >= 0)


def value_at_point(expression: sp.Expr, point: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """Return the real value at a point; None if there is none."""
    try:
        value = enclosed_at(sp.sympify(expression, strict=True), dict(point), _DIGITS)
    except NotExactError:
        return None
    complex_there = value.imag.a > 0 or value.imag.b < 0 or value.imag.delta > 0
    return None if complex_there else mp.mpf(value.real.mid)


def rational_bounds(value: Any) -> tuple[sp.Rational, sp.Rational]:
    """Return two rationals with few digits, one below and one above a value, both with the sign of the value."""
    step = sp.Integer(10) ** (floor(log10(abs(float(value)))) - 2)
    low = step * (int(mp.floor(value / (mp.mpf(step.p) / step.q))) - 1)
    return low, low + 3 * step
