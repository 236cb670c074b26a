"""Integrals in closed form: an antiderivative that is differentiated again, continuous between the limits.

Where the antiderivative comes from does not matter: F' = f is decided, and F must be continuous from one limit to the other
(the fundamental theorem; without continuity ∫ dt/t² from −1 to 1 would be −2).
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp
from sympy.integrals.manualintegrate import manualintegrate
from sympy.simplify.fu import TR8

from lagrotor.algebra.constancy import is_continuous
from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.signs import ANY, Region, is_nonnegative, is_positive, signs

_MOST_OPERATIONS = 60


def value_of_integral(e: sp.Integral, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """∫ f dx between its limits, None where nothing certain is known."""
    body, *limits = e.args
    if len(limits) > 1:
        inner = value_of_integral(sp.Integral(body, limits[0]), where, vanishes)
        return None if inner is None else sp.Integral(inner, *limits[1:])
    x, *ends = limits[0]
    if len(ends) != 2 or sp.count_ops(body) > _MOST_OPERATIONS:
        return None
    low, high = ends
    t = sp.Dummy(str(x), real=True)
    body = body.xreplace({x: t})
    if not body.has(t) and all(end.is_finite is not False for end in ends):
        return body * (high - low)
    if body.has(sp.core.function.AppliedUndef):
        return None
    between = where.with_(*_between(t, low, high, where))
    try:
        F = manualintegrate(TR8(sp.expand(body)) if body.has(sp.sin, sp.cos) else body, t)
    except (NotImplementedError, ValueError, TypeError, AttributeError):
        return None
    F = F.replace(lambda n: isinstance(n, sp.Piecewise), lambda n: n.args[-1][0])
    if F.has(sp.Integral, sp.Piecewise) or not is_continuous(F, between, frozenset({t})):
        return None
    if not vanishes(derivative(F, t) - body, between):
        return None
    above, below = (_at(F, t, end, where) for end in (high, low))
    return None if above is None or below is None else above - below


def _between(t: sp.Symbol, low: sp.Expr, high: sp.Expr, where: Region) -> list[sp.Basic]:
    """What is known of t between the limits."""
    if low.is_infinite or high.is_infinite or is_nonnegative(high - low, where):
        found = [sp.Ge(t, low)] if low.is_finite is not False else []
        return found + ([sp.Le(t, high)] if high.is_finite is not False else [])
    if all(is_positive(end, where) for end in (low, high)):
        return [sp.Gt(t, 0)]
    if all(is_nonnegative(end, where) for end in (low, high)):
        return [sp.Ge(t, 0)]
    return []


def _at(F: sp.Expr, t: sp.Symbol, end: sp.Expr, where: Region) -> sp.Expr | None:
    """F at a limit; at ±∞ its limit, where each term has one that is certain."""
    if end.is_finite is not False:
        value = F.subs(t, end)
        return None if value.has(sp.nan, sp.zoo, sp.oo) else value
    if F.is_Add:
        values = [_at(part, t, end, where) for part in F.args]
        return None if None in values else sp.Add(*values)
    side = 1 if end is sp.oo else -1
    constant, rest = F.as_independent(t, as_Add=False)
    if rest == 1:
        return constant
    if rest.is_Add and (expanded := sp.expand(F)).is_Add:
        return _at(expanded, t, end, where)
    if isinstance(rest, sp.atan | sp.erf | sp.tanh):
        slope = sp.expand(rest.args[0]).coeff(t)
        sign = signs(slope, where) or ANY
        if not slope.has(t) and len(sign) == 1 and sp.expand(rest.args[0] - slope * t).is_finite is not False:
            [direction] = sign
            return constant * side * direction * (sp.pi / 2 if isinstance(rest, sp.atan) else 1)
    return sp.S.Zero if _falls(rest, t, side, where) else None


def _falls(rest: sp.Expr, t: sp.Symbol, side: int, where: Region) -> bool:
    """Whether a product of powers, bounded waves and an exponential tends to 0."""
    power, decays = sp.S.Zero, False
    for factor in sp.Mul.make_args(rest):
        if isinstance(factor, sp.sin | sp.cos):
            continue
        base, exponent = factor.as_base_exp()
        if isinstance(factor, sp.exp):
            terms = sp.Poly(exponent, t).all_coeffs() if exponent.is_polynomial(t) else []
            if len(terms) not in (2, 3):
                return False
            decays = is_positive(-terms[0] * side ** (len(terms) - 1), where)
            if not decays:
                return False
        elif base == t and exponent.is_number and exponent.is_real:
            power += exponent
        else:
            return False
    return decays or bool(power < 0)
