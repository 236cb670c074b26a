"""Recurrences that bring special functions to a least set: Γ, its logarithm and derivatives, Bessel functions, elliptic
integrals, the error function.

Abramowitz & Stegun, Handbook of Mathematical Functions, 6.1.15–6.1.20, 6.4.6, 9.1.27, 9.6.26, 10.1.11.
"""

from __future__ import annotations

from collections.abc import Callable
from math import floor
from typing import Any

import sympy as sp

_MOST_STEPS = 30


def _constant(u: sp.Expr) -> tuple[sp.Rational, sp.Expr]:
    """The rational term of u, and the rest."""
    constant, rest = sp.expand(u).as_coeff_Add()
    return (constant, rest) if constant.is_Rational else (sp.S.Zero, constant + rest)


def _gamma(u: sp.Expr) -> sp.Expr | None:
    """Γ of an argument with a constant in [0, 1), of positive leading sign, that is no multiple."""
    u = sp.expand(u)
    constant, rest = _constant(u)
    if not rest:
        value = sp.gamma(constant)
        if not value.has(sp.gamma):
            return value
        if constant > 1:
            return (constant - 1) * sp.gamma(constant - 1, evaluate=False)
        if constant < 0:
            return sp.gamma(constant + 1, evaluate=False) / constant
        if constant > sp.S.Half:
            return sp.pi / (sp.sin(sp.pi * constant) * sp.gamma(1 - constant, evaluate=False))
        return None
    shift = floor(constant)
    if shift and abs(shift) <= _MOST_STEPS:
        base = u - shift
        if shift > 0:
            return sp.gamma(base, evaluate=False) * sp.Mul(*(base + k for k in range(shift)))
        return sp.gamma(base, evaluate=False) / sp.Mul(*(base - k for k in range(1, -shift + 1)))
    if rest.could_extract_minus_sign() and not u.is_integer:
        return sp.pi / (sp.sin(sp.pi * u) * sp.gamma(1 - u, evaluate=False))
    content, _ = rest.primitive()
    n = int(content.p) if content.is_Rational else 1
    if content.is_Rational and content.q == 1 and 1 < n <= 4:
        v = u / n  # the multiplication theorem
        product = sp.Mul(*(sp.gamma(v + sp.Rational(k, n), evaluate=False) for k in range(n)))
        return (2 * sp.pi) ** sp.Rational(1 - n, 2) * sp.Integer(n) ** (u - sp.S.Half) * product
    return None


def _polygamma(n: sp.Expr, u: sp.Expr) -> sp.Expr | None:
    """ψ⁽ⁿ⁾ of an argument with a constant in [0, 1): ψ⁽ⁿ⁾(u + 1) = ψ⁽ⁿ⁾(u) + (−1)ⁿ n!/uⁿ⁺¹ (6.4.6)."""
    shift = floor(_constant(u)[0])
    if not n.is_Integer or n < 0 or not 0 < shift <= _MOST_STEPS or not _constant(u)[1]:
        return None
    base = u - shift
    added = (sp.S.NegativeOne**n * sp.factorial(n) / (base + k) ** (n + 1) for k in range(shift))
    return sp.polygamma(n, base, evaluate=False) + sp.Add(*added)


def _log_gamma(u: sp.Expr) -> sp.Expr | None:
    """ln Γ of an argument with a constant in [0, 1), where what is left is positive."""
    shift = floor(_constant(u)[0])
    base = u - shift
    if not (0 < shift <= _MOST_STEPS and base.is_positive):
        return None
    return sp.loggamma(base, evaluate=False) + sp.Add(*(sp.log(base + k) for k in range(shift)))


def _binomial(n: sp.Expr, k: sp.Expr) -> sp.Expr | None:
    if n.is_Integer and k.is_Integer:
        return sp.binomial(n, k)
    if n.is_integer and not n.is_nonnegative:
        return None
    return sp.gamma(n + 1) / (sp.gamma(k + 1) * sp.gamma(n - k + 1))


def _wave(f: Any, sign: int = 1) -> Callable[[sp.Expr], sp.Expr]:
    return lambda x: sign * sp.sqrt(2 / sp.pi) / sp.sqrt(x) * f(x)


def _decay(x: sp.Expr) -> sp.Expr:
    return sp.sqrt(sp.pi / 2) / sp.sqrt(x) * sp.exp(-x)


# Of order 1/2 and −1/2.
_HALF: dict[Any, tuple[Callable[[sp.Expr], sp.Expr], Callable[[sp.Expr], sp.Expr]]] = {
    sp.besselj: (_wave(sp.sin), _wave(sp.cos)),
    sp.bessely: (_wave(sp.cos, -1), _wave(sp.sin)),
    sp.besseli: (_wave(sp.sinh), _wave(sp.cosh)),
    sp.besselk: (_decay, _decay),
}


def _bessel(function: Any, signs: tuple[int, int]) -> Callable[[sp.Expr, sp.Expr], sp.Expr | None]:
    """Order ν to ν − 1 and ν − 2, down to a constant in [0, 2): C_ν = s (2(ν − 1)/x) C_{ν−1} + t C_{ν−2}."""
    once, twice = signs

    def rule(order: sp.Expr, x: sp.Expr) -> sp.Expr | None:
        constant, rest = _constant(order)
        if not rest and abs(constant) == sp.S.Half:
            return _HALF[function][bool(constant < 0)](x)
        down = sp.expand(order)
        if 2 <= constant <= _MOST_STEPS or (not rest and constant == sp.Rational(3, 2)):
            return once * 2 * (down - 1) / x * function(down - 1, x) + twice * function(down - 2, x)
        if -_MOST_STEPS <= constant < 0:  # half orders end at ±1/2; C_ν = t C_{ν+2} − s t 2(ν + 1)/x C_{ν+1}
            return twice * function(down + 2, x) - once * twice * 2 * (down + 1) / x * function(down + 1, x)
        return None

    return rule


RULES: dict[Any, Callable[..., sp.Expr | None]] = {
    sp.gamma: _gamma,
    sp.factorial: lambda n: sp.gamma(n + 1, evaluate=False),
    sp.binomial: _binomial,
    sp.besselj: _bessel(sp.besselj, (1, -1)),
    sp.bessely: _bessel(sp.bessely, (1, -1)),
    sp.besseli: _bessel(sp.besseli, (-1, 1)),
    sp.besselk: _bessel(sp.besselk, (1, 1)),
    sp.polygamma: _polygamma,
    sp.loggamma: _log_gamma,
    sp.erfc: lambda x: 1 - sp.erf(x),
    sp.beta: lambda a, b: sp.gamma(a) * sp.gamma(b) / sp.gamma(a + b),
}
