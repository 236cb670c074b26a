"""Closed forms of definite integrals: a candidate antiderivative F is checked by F' = f and by continuity between the limits.

By the fundamental theorem this is a proof; without continuity ∫ dt/t² from −1 to 1 would be −2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp
from sympy.integrals.manualintegrate import manualintegrate
from sympy.integrals.rationaltools import ratint
from sympy.simplify.fu import TR8

from lagrotor.algebra.constancy import is_continuous
from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.signs import ANY, Region, is_nonnegative, is_positive, signs

_MOST_OPERATIONS = 60


def value_of_integral(e: sp.Integral, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """Return the value of a definite integral ∫ f dx if a closed form is proved, and None otherwise."""
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
    F = _antiderivative(body, t)
    inside, to_high, from_low = (
        where.with_(*_between(t, low, high, where, *kinds))
        for kinds in ((sp.Gt, sp.Lt), (sp.Gt, sp.Le), (sp.Ge, sp.Lt))
    )
    if F.has(sp.Integral, sp.Piecewise) or not is_continuous(F, inside, frozenset({t})):
        return None
    if not vanishes(derivative(F, t) - body, inside):
        return None
    above, below = _at(F, t, high, to_high), _at(F, t, low, from_low)
    return None if above is None or below is None else above - below


def _antiderivative(body: sp.Expr, t: sp.Symbol) -> sp.Expr:
    """Return a candidate for an antiderivative. If none is found, the result still contains an integral."""
    power, cofactor = sp.S.Zero, body
    for factor in sp.Mul.make_args(sp.factor_terms(body)):
        base, exponent = factor.as_base_exp()
        if base == t and exponent.is_Integer:
            power, cofactor = exponent, cofactor / factor
    if power > 1 and isinstance(wave := cofactor.as_independent(t, as_Add=False)[1], sp.exp):
        square = sp.Poly(wave.args[0], t) if wave.args[0].is_polynomial(t) else sp.Poly(0, t)
        if square.monoms() == [(2,)]:  # ∫ tⁿ exp(a t²) dt = (tⁿ⁻¹ exp(a t²) − (n − 1) ∫ tⁿ⁻² exp(a t²) dt)/2a
            shorter = _antiderivative(t ** (power - 2) * cofactor, t)
            return (t ** (power - 1) * cofactor - (power - 1) * shorter) / (2 * square.LC())
    if body.free_symbols == {t} and body.is_rational_function(t):
        return ratint(body, t, real=True).replace(lambda n: isinstance(n, sp.RootSum), lambda n: sp.Integral(body, t))
    try:
        F = manualintegrate(TR8(sp.expand(body)) if body.has(sp.sin, sp.cos) else body, t)
    except (NotImplementedError, ValueError, TypeError, AttributeError):
        return sp.Integral(body, t)
    return F.replace(lambda n: isinstance(n, sp.Piecewise), lambda n: n.args[-1][0])


def _between(t: sp.Symbol, low: sp.Expr, high: sp.Expr, where: Region, lower: Any, upper: Any) -> list[sp.Basic]:
    """Return the inequalities that hold for t between the limits. `lower` and `upper` build a relation, such as Gt or Le."""
    if low.is_infinite or high.is_infinite or is_nonnegative(high - low, where):
        relations = [lower(t, low)] if low.is_finite is not False else []
        if low.free_symbols and is_positive(low, where):
            relations.append(sp.Gt(t, 0))
        return relations + ([upper(t, high)] if high.is_finite is not False else [])
    if all(is_positive(end, where) for end in (low, high)):
        return [sp.Gt(t, 0)]
    if all(is_nonnegative(end, where) for end in (low, high)):
        return [sp.Ge(t, 0)]
    return []


def _at(F: sp.Expr, t: sp.Symbol, end: sp.Expr, where: Region) -> sp.Expr | None:
    """Return the value of the antiderivative F at an end of the integral, or the limit of F for t → end.

    If F is not continuous at the end, the limits of its terms are added. The result is None if one of them is not certain.
    """
    if end.is_finite is not False and is_continuous(F, where, frozenset({t})):
        value = F.subs(t, end)
        return None if value.has(sp.nan, sp.zoo, sp.oo, -sp.oo) else value
    if F.is_Add:
        values = [_at(term, t, end, where) for term in F.args]
        return None if None in values else sp.Add(*values)
    side = 1 if end is sp.oo else -1
    constant, dependent = F.as_independent(t, as_Add=False)
    if dependent == 1:
        return constant
    if end.is_finite is not False:
        return None
    if dependent.is_rational_function(t) and not dependent.is_polynomial(t):
        over, under = (sp.Poly(term, t) for term in sp.fraction(sp.together(dependent)))
        if under.LC().is_number and over.degree() < under.degree():
            return sp.S.Zero
    if dependent.is_Add and (expanded := sp.expand(F)).is_Add:
        return _at(expanded, t, end, where)
    if isinstance(dependent, sp.atan | sp.erf | sp.tanh):
        slope = sp.expand(dependent.args[0]).coeff(t)
        sign = signs(slope, where) or ANY
        if not slope.has(t) and len(sign) == 1 and sp.expand(dependent.args[0] - slope * t).is_finite is not False:
            [direction] = sign
            return constant * side * direction * (sp.pi / 2 if isinstance(dependent, sp.atan) else 1)
    return sp.S.Zero if _falls(dependent, t, side, where) else None


def _falls(product: sp.Expr, t: sp.Symbol, side: int, where: Region) -> bool:
    """Return True if a product of powers of t, sines, cosines and an exponential tends to 0 for t → ∞ (`side` 1) or −∞ (−1)."""
    power, decays = sp.S.Zero, False
    for factor in sp.Mul.make_args(product):
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
