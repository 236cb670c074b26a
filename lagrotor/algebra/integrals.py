"""Integrals in closed form: an antiderivative that is differentiated again, continuous between the limits.

Where the antiderivative comes from does not matter: F' = f is decided, and F must be continuous from one limit to the other
(the fundamental theorem; without continuity ∫ dt/t² from −1 to 1 would be −2).
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
from lagrotor.algebra.signs import Region, is_nonnegative, is_positive

_MOST_OPERATIONS = 60


def value_of_integral(e: sp.Integral, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """∫ f dx between its limits, None where nothing certain is known."""
    body, *limits = e.args
    if len(limits) > 1:
        inner = value_of_integral(sp.Integral(body, limits[0]), where, vanishes)
        return None if inner is None else sp.Integral(inner, *limits[1:])
    x, *ends = limits[0]
    if len(ends) != 2 or any(end.is_infinite for end in ends) or sp.count_ops(body) > _MOST_OPERATIONS:
        return None
    low, high = ends
    t = sp.Dummy(str(x), real=True)
    body = body.xreplace({x: t})
    if not body.has(t):
        return body * (high - low)
    if body.has(sp.core.function.AppliedUndef):
        return None
    F = _antiderivative(body, t)
    inside, whole = (where.with_(*_between(t, low, high, where, *kinds)) for kinds in ((sp.Gt, sp.Lt), (sp.Ge, sp.Le)))
    if F.has(sp.Integral, sp.Piecewise) or not is_continuous(F, whole, frozenset({t})):
        return None
    value = F.subs(t, high) - F.subs(t, low)
    finite = not value.has(sp.nan, sp.zoo, sp.oo, -sp.oo)
    return value if finite and vanishes(derivative(F, t) - body, inside) else None


def _antiderivative(body: sp.Expr, t: sp.Symbol) -> sp.Expr:
    """What may be one; with an integral left in it where none was found."""
    if body.free_symbols == {t} and body.is_rational_function(t):
        return ratint(body, t, real=True).replace(lambda n: isinstance(n, sp.RootSum), lambda n: sp.Integral(body, t))
    try:
        F = manualintegrate(TR8(sp.expand(body)) if body.has(sp.sin, sp.cos) else body, t)
    except (NotImplementedError, ValueError, TypeError, AttributeError):
        return sp.Integral(body, t)
    return F.replace(lambda n: isinstance(n, sp.Piecewise), lambda n: n.args[-1][0])


def _between(t: sp.Symbol, low: sp.Expr, high: sp.Expr, where: Region, least: Any, most: Any) -> list[sp.Basic]:
    """What is known of t between the limits: least(t, low), most(t, high)."""
    if is_nonnegative(high - low, where):
        above = [sp.Gt(t, 0)] if low.free_symbols and is_positive(low, where) else []
        return [least(t, low), *above, most(t, high)]
    if all(is_positive(end, where) for end in (low, high)):
        return [sp.Gt(t, 0)]
    if all(is_nonnegative(end, where) for end in (low, high)):
        return [sp.Ge(t, 0)]
    return []
