"""Numeric evidence, for what is not decided exactly: the size of an expression at random rational points."""

import random

import sympy as sp
from mpmath import mp

_POINTS = 8
_DIGITS = 34


def largest_value(expression: sp.Expr) -> tuple[dict[sp.Symbol, sp.Rational] | None, float | None]:
    """Return the point, out of some random rational ones, where |expression| is largest, and that value."""
    generator = random.Random(1)
    symbols = sorted(expression.free_symbols, key=sp.default_sort_key)
    try:
        evaluate = sp.lambdify(symbols, expression, "mpmath", dummify=True)
    except (KeyError, NotImplementedError):  # a constant or an operator that has no numeric counterpart
        return None, None
    best: tuple[dict[sp.Symbol, sp.Rational] | None, float | None] = (None, None)
    for _ in range(_POINTS if symbols else 1):
        point = {symbol: sp.Rational(generator.randrange(150, 950), 499) for symbol in symbols}
        values = []
        for digits in (_DIGITS, 2 * _DIGITS):
            with mp.workdps(digits):
                try:
                    values.append(abs(evaluate(*(mp.mpf(value.p) / value.q for value in point.values()))))
                except (ArithmeticError, NameError, TypeError, ValueError):
                    break
        # At a pole hidden by rounding, the value depends on the number of digits.
        if len(values) == 2 and mp.almosteq(*values, 1e-9, 1e-20):
            size = float(values[1])
            if best[1] is None or size > best[1]:
                best = point, size
    return best
