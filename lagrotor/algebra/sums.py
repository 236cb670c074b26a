"""Sums with symbolic limits: expansion, and proof by induction on the upper limit; infinite series are not decided."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp
from sympy.concrete.gosper import gosper_sum

from lagrotor.algebra.signs import Region

_MOST_TERMS = 40  # of an expanded sum


def expand_sum(e: sp.Sum) -> sp.Expr | None:
    """Rewrite a sum by one of three rules, and return None if none applies.

    A sum between integers is expanded. Constant factors are taken out of a sum. A sum to n + 2 becomes a sum to n and two
    terms.
    """
    body, (i, low, high), *others = e.args
    if others:
        return None
    if low.is_Integer and high.is_Integer:
        if high - low >= _MOST_TERMS or high < low - 1:
            return None
        return sp.Add(*(body.subs(i, k) for k in range(int(low), int(high) + 1)))
    expanded = sp.expand_mul(body)
    if expanded.is_Add and body.has(sp.core.function.AppliedUndef):
        return sp.Add(*(sp.Sum(term, (i, low, high)) for term in expanded.args))
    constant, dependent = expanded.as_independent(i, as_Add=False)
    if constant != 1:
        return constant * sp.Sum(dependent, (i, low, high))
    if high is sp.oo:
        return None
    shift, base = high.as_coeff_Add()
    if shift.is_Integer and shift and abs(shift) < _MOST_TERMS:
        added = range(1, int(shift) + 1) if shift > 0 else range(int(shift) + 1, 1)
        sign = 1 if shift > 0 else -1
        return sp.Sum(body, (i, low, base)) + sign * sp.Add(*(body.subs(i, base + k) for k in added))
    return None


def value_of_sum(e: sp.Sum, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """Return a closed form of a sum, found by Gosper's algorithm and proved by induction; None if there is none."""
    body, (i, low, high), *others = e.args
    if others or not (high.is_Symbol and high.is_integer and low.is_Integer) or body.has(high):
        return None
    try:
        value = gosper_sum(body, (i, low, high))
    except (ValueError, TypeError, AttributeError, NotImplementedError):
        return None
    if value is None or value.has(sp.nan, sp.zoo, sp.oo, sp.Sum):
        return None
    return value if holds_by_induction(e - value, where, vanishes) else None


def holds_by_induction(expression: sp.Expr, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> bool:
    """Return True if an expression, linear in one sum to n, is zero for the first n, and for n + 1 whenever it is for n."""
    sums = expression.atoms(sp.Sum)
    if len(sums) != 1:
        return False
    [total] = sums
    body, (i, low, n), *others = total.args
    if others or not (n.is_Symbol and n.is_integer and low.is_Integer) or body.has(n):
        return False
    if not ((n.is_positive and low <= 1) or (n.is_nonnegative and low <= 0)):
        return False
    S = sp.Dummy("S")
    linear = sp.expand(expression.xreplace({total: S}))
    c = linear.coeff(S)
    remainder = linear - c * S
    if remainder.has(S) or c.has(S, n) or c == 0:
        return False
    start = 1 if n.is_positive else 0
    first = sp.Add(*(body.subs(i, k) for k in range(int(low), start + 1)))
    at_start = (c * first + remainder).subs(n, start)
    step = c * body.subs(i, n + 1) - remainder + remainder.subs(n, n + 1)
    return vanishes(at_start, where) and vanishes(step, where)
