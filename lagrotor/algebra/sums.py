"""Sums with symbolic limits: by induction on the upper one; series by the ratio of their terms or by partial sums."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp
from sympy.concrete.gosper import gosper_sum

from lagrotor.algebra.signs import Region, is_positive

_MOST_TERMS = 40  # that are written out


def written_out(e: sp.Sum) -> sp.Expr | None:
    """Between whole numbers, and in the least form: Σ to n + 2 as Σ to n and two terms, constant factors outside."""
    body, (i, low, high), *others = e.args
    if others:
        return None
    if low.is_Integer and high.is_Integer:
        if high - low >= _MOST_TERMS or high < low - 1:
            return None
        return sp.Add(*(body.subs(i, k) for k in range(int(low), int(high) + 1)))
    expanded = sp.expand_mul(body)
    if expanded.is_Add and body.has(sp.core.function.AppliedUndef):
        return sp.Add(*(sp.Sum(part, (i, low, high)) for part in expanded.args))
    constant, rest = expanded.as_independent(i, as_Add=False)
    if constant != 1:
        return constant * sp.Sum(rest, (i, low, high))
    if high is sp.oo:
        return None
    shift, base = high.as_coeff_Add()
    if shift.is_Integer and shift and abs(shift) < _MOST_TERMS:
        added = range(1, int(shift) + 1) if shift > 0 else range(int(shift) + 1, 1)
        sign = 1 if shift > 0 else -1
        return sp.Sum(body, (i, low, base)) + sign * sp.Add(*(body.subs(i, base + k) for k in added))
    if body.has(sp.core.function.AppliedUndef):
        return _from_one(body, i, low, high)
    return None


def _from_one(body: sp.Expr, i: sp.Symbol, low: sp.Expr, high: sp.Expr) -> sp.Expr | None:
    """Σ of an unknown f(i + c) as one of f(i) from 1."""
    shifts = {sp.expand(f.args[0] - i) for f in body.atoms(sp.core.function.AppliedUndef) if f.has(i)}
    if len(shifts) == 1 and (c := shifts.pop()).is_Integer and c:
        return sp.Sum(sp.expand(body.subs(i, i - c)), (i, low + c, high + c))
    if low.is_Integer and low != 1 and abs(low) < _MOST_TERMS:
        missing = sp.Add(*(body.subs(i, k) for k in (range(1, int(low)) if low > 1 else range(int(low), 1))))
        return sp.Sum(body, (i, 1, high)) + (-missing if low > 1 else missing)
    return None


def value_of_sum(e: sp.Sum, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """Gosper's closed form, proved by induction on the upper limit."""
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


def value_of_series(e: sp.Sum, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> sp.Expr | None:
    """A sum by the ratio of its neighbours, or by the limit of its partial sums; Σ 1/i²ᵏ by Euler's formula."""
    body, (i, low, high), *others = e.args
    if others or not low.is_Integer or (high is not sp.oo and not high.is_nonnegative):
        return None
    k = sp.Dummy("k", integer=True, nonnegative=True)
    first = body.subs(i, low)
    if first.has(sp.nan, sp.zoo, sp.oo) or first == 0:
        return None
    ratio = sp.cancel(sp.combsimp(body.subs(i, low + k + 1) / body.subs(i, low + k)))
    if high is sp.oo:
        power = sp.cancel(1 / body)
        if (
            low == 1
            and power.is_Pow
            and power.base == i
            and power.exp.is_Integer
            and power.exp.is_even
            and power.exp > 0
        ):
            return sp.zeta(power.exp)
        value = _of_a_function(ratio, k, first, where)
        return _by_partial_sums(body, i, low, where, vanishes) if value is None else value
    c = sp.cancel(ratio * (k + 1) / (high - k))  # the binomial theorem
    return first * (1 + c) ** high if low == 0 and high.is_Symbol and not c.has(k) else None


def _of_a_function(ratio: sp.Expr, k: sp.Symbol, first: sp.Expr, where: Region) -> sp.Expr | None:
    """Those of 1/(1 − c), exp, cosh and cos, sinh and sin, log, artanh and arctan, by the ratio of the terms k + 1 and k."""
    r = ratio
    if not r.has(k):
        return first / (1 - r) if _converges(r, where) else None
    for under, over in ((k + 2, k + 1), (2 * k + 3, 2 * k + 1)):  # Abel: also at c = −1
        c = sp.cancel(r * under / over)
        if not c.has(k) and (sp.cancel(1 + c) == 0 or _converges(c, where)):
            if under == k + 2:
                return -first * sp.log(1 - c) / c
            for sign, function in ((1, sp.atanh), (-1, sp.atan)):
                if (size := _root_of(sign * c)) is not None and sp.expand(size**2 - sign * c) == 0:
                    return first * function(size) / size
    if not (c := sp.cancel(r * (k + 1))).has(k):
        return first * sp.exp(c)
    kinds: tuple[tuple[sp.Expr, tuple[Any, Any], bool], ...] = (
        ((2 * k + 1) * (2 * k + 2), (sp.cosh, sp.cos), False),
        ((2 * k + 2) * (2 * k + 3), (sp.sinh, sp.sin), True),
    )
    for under, functions, odd in kinds:
        c = sp.cancel(r * under)
        for sign, function in zip((1, -1), functions, strict=True):
            size = None if c.has(k) else _root_of(sign * c)
            if size is not None and sp.expand(size**2 - sign * c) == 0:
                return first * function(size) / (size if odd else 1)
    return None


def _converges(c: sp.Expr, where: Region) -> bool:
    return bool(is_positive(sp.cancel(1 - c), where) and is_positive(sp.cancel(1 + c), where))


def _root_of(c: sp.Expr) -> sp.Expr | None:
    """x where c = x², x rational in the letters."""
    root = sp.sqrt(sp.factor(c)).replace(sp.Abs, lambda x: x)
    return (
        None if root.has(sp.I) or any(p.exp.is_Rational and not p.exp.is_Integer for p in root.atoms(sp.Pow)) else root
    )


def _by_partial_sums(
    body: sp.Expr, i: sp.Symbol, low: sp.Expr, where: Region, vanishes: Callable[[sp.Expr, Region], bool]
) -> sp.Expr | None:
    """The limit of Gosper's closed form: polynomials times rⁿ, 0 < r < 1, and rational functions of falling degree vanish."""
    n = sp.Symbol("n_of_partial_sums", integer=True, positive=True)
    if low > 1 or (value := value_of_sum(sp.Sum(body, (i, low, n)), where, vanishes)) is None:
        return None
    limit = sp.S.Zero
    for term in sp.Add.make_args(sp.expand(value)):
        over, under = sp.fraction(sp.powsimp(term))
        powers = [p for p in term.atoms(sp.Pow) if p.exp.has(n)]
        rate = sp.Mul(*(p.base ** p.exp.coeff(n) for p in powers)) if powers else sp.S.One
        if not term.has(n):
            limit += term
        elif powers and rate.is_number and rate.is_positive and rate < 1:
            rest = sp.cancel(term / sp.Mul(*powers))
            if not rest.is_rational_function(n) or any(
                not p.exp.is_polynomial(n) or sp.degree(p.exp, n) != 1 for p in powers
            ):
                return None
        elif not powers and term.is_rational_function(n):
            whole = sp.cancel(term)
            over, under = whole.as_numer_denom()
            gap = sp.degree(over, n) - sp.degree(under, n)
            if gap > 0:
                return None
            limit += sp.LC(over, n) / sp.LC(under, n) if gap == 0 else 0
        else:
            return None
    return limit


def holds_by_induction(expression: sp.Expr, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> bool:
    """Whether an expression, linear in one sum to a natural n, is zero for all n: at the first, and with n at n + 1."""
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
    rest = linear - c * S
    if rest.has(S) or c.has(S, n) or c == 0:
        return False
    start = 1 if n.is_positive else 0
    first = sp.Add(*(body.subs(i, k) for k in range(int(low), start + 1)))
    at_start = (c * first + rest).subs(n, start)
    after = c * body.subs(i, n + 1) - rest + rest.subs(n, n + 1)
    return vanishes(at_start, where) and vanishes(after, where)
