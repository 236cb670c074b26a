"""Recurrences that reduce factorials, binomial coefficients and Bessel functions J to a minimal set.

Abramowitz & Stegun, Handbook of Mathematical Functions, 6.1.15, 9.1.27, 10.1.11.
"""

from __future__ import annotations

from collections.abc import Callable
from math import floor
from typing import Any

import sympy as sp

_MOST_STEPS = 30


def _constant(u: sp.Expr) -> tuple[sp.Rational, sp.Expr]:
    """Split u into a rational number and the remaining terms."""
    constant, remainder = sp.expand(u).as_coeff_Add()
    return (constant, remainder) if constant.is_Rational else (sp.S.Zero, constant + remainder)


def _gamma(u: sp.Expr) -> sp.Expr | None:
    """Write Γ(u) in terms of Γ at an argument whose rational term lies in [0, 1); None if there is nothing to reduce."""
    u = sp.expand(u)
    constant, remainder = _constant(u)
    if not remainder and not (value := sp.gamma(constant)).has(sp.gamma):
        return value
    shift = floor(constant)
    if shift and abs(shift) <= _MOST_STEPS:
        base = u - shift
        if shift > 0:
            return sp.gamma(base, evaluate=False) * sp.Mul(*(base + k for k in range(shift)))
        return sp.gamma(base, evaluate=False) / sp.Mul(*(base - k for k in range(1, -shift + 1)))
    return None


def _binomial(n: sp.Expr, k: sp.Expr) -> sp.Expr | None:
    if n.is_Integer and k.is_Integer:
        return sp.binomial(n, k)
    if n.is_integer and not n.is_nonnegative:
        return None
    return sp.gamma(n + 1) / (sp.gamma(k + 1) * sp.gamma(n - k + 1))


def _bessel(order: sp.Expr, x: sp.Expr) -> sp.Expr | None:
    """Reduce the rational term of the order to [0, 2) by J_ν = (2(ν − 1)/x) J_{ν−1} − J_{ν−2}; None if it lies there."""
    constant, remainder = _constant(order)
    if not remainder and abs(constant) == sp.S.Half:
        return sp.sqrt(2 / sp.pi) / sp.sqrt(x) * (sp.cos(x) if constant < 0 else sp.sin(x))
    down = sp.expand(order)
    if 2 <= constant <= _MOST_STEPS or (not remainder and constant == sp.Rational(3, 2)):
        return 2 * (down - 1) / x * sp.besselj(down - 1, x) - sp.besselj(down - 2, x)
    if -_MOST_STEPS <= constant < 0:  # half-integer orders end at ±1/2
        return 2 * (down + 1) / x * sp.besselj(down + 1, x) - sp.besselj(down + 2, x)
    return None


RULES: dict[Any, Callable[..., sp.Expr | None]] = {
    sp.gamma: _gamma,
    sp.factorial: lambda n: sp.gamma(n + 1, evaluate=False),
    sp.binomial: _binomial,
    sp.besselj: _bessel,
}
