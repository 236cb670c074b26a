"""Proofs that an expression is zero in a region.

The methods are evaluation, translation, induction on n, comparison of squares, and zero derivatives.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import lcm, prod

import sympy as sp

from lagrotor.algebra.constancy import is_constant_zero, is_small_angle
from lagrotor.algebra.enclosures import jet_of
from lagrotor.algebra.integrals import value_of_integral
from lagrotor.algebra.signs import Region, is_positive
from lagrotor.algebra.sums import expand_sum, holds_by_induction, value_of_sum
from lagrotor.algebra.translation import prove_zero
from lagrotor.errors import NotExactError

_MOST_CASES = 16
_MOST_ROUNDS = 6


@dataclass(frozen=True)
class Proof:
    """The result of an attempt to prove that an expression is zero.

    `how` names the method; it is None if the attempt failed. The proof holds where no expression in `divisors` vanishes. A
    failed attempt might succeed under the inequalities in `missing`.
    """

    how: str | None
    divisors: tuple[sp.Expr, ...] = ()
    missing: tuple[sp.Basic, ...] = ()


def evaluated(e: sp.Expr, where: Region = Region()) -> sp.Expr:  # noqa: B008
    """Evaluate the derivatives and finite sums in an expression, and those integrals whose closed form is proved."""
    for _ in range(_MOST_ROUNDS):
        previous = e
        e = e.replace(lambda n: isinstance(n, sp.Derivative) and jet_of(n) is None, _differentiated)
        e = e.replace(lambda n: isinstance(n, sp.Subs) and jet_of(n) is None, lambda n: n.doit(deep=False))
        e = e.replace(lambda n: isinstance(n, sp.Sum), lambda n: _summed(n, where))
        e = e.replace(lambda n: isinstance(n, sp.Integral), lambda n: _integral(n, where))
        if e == previous:
            break
    return e


def _differentiated(e: sp.Derivative) -> sp.Expr:
    result = e.expr
    for symbol, times in e.variable_count:
        if not times.is_Integer:
            return e
        for _ in range(int(times)):
            result = sp.diff(result, symbol)
    return result


def _summed(e: sp.Sum, where: Region) -> sp.Expr:
    value = expand_sum(e)
    value = value_of_sum(e, where, _vanishes) if value is None else value
    return e if value is None else value


def _integral(e: sp.Integral, where: Region) -> sp.Expr:
    expanded = sp.expand(e.function)
    limits = e.limits
    if len(limits) == 1 and expanded.has(sp.core.function.AppliedUndef):
        if expanded.is_Add:
            return sp.Add(*(sp.Integral(term, *limits) for term in expanded.args))
        constant, dependent = expanded.as_independent(limits[0][0], as_Add=False)
        if constant != 1:
            return constant * sp.Integral(dependent, *limits)
    value = value_of_integral(e, where, _vanishes)
    return e if value is None else value


def proof_of_zero(expression: sp.Expr, where: Region) -> Proof:
    """Try to prove that an expression is zero by translation, induction on the upper limit of a sum, squares, or derivatives."""
    divisors: tuple[sp.Expr, ...] = ()
    missing: tuple[sp.Basic, ...] = ()
    try:
        for case, inside in _cases(expression, where):
            case_divisors, case_missing = prove_zero(case, inside)
            missing += case_missing
            if case_divisors is None:
                break
            divisors += case_divisors
        else:
            return Proof("The reduced numerator is the zero polynomial.", tuple(dict.fromkeys(divisors)), missing)
        reason = None
    except NotExactError as refusal:
        reason = refusal
    if holds_by_induction(expression, where, _vanishes):
        return Proof("It holds for the first n, and for n + 1 if for n.")
    if _is_difference_of_squares(expression, where):
        return Proof("Both sides are positive, and their squares are equal.")
    if is_small_angle(expression, _vanishes):
        return Proof("Its sine vanishes, and it lies between −π and π.")
    if is_constant_zero(expression, where, _vanishes):
        return Proof("Its derivatives vanish, and it is zero at a point of a connected region.")
    if reason is not None and not missing:
        raise reason
    return Proof(None, (), missing)


def _is_difference_of_squares(expression: sp.Expr, where: Region) -> bool:
    """Return True if the expression is a difference a − b of positive terms with a² = b², and is therefore zero."""
    terms = sp.Add.make_args(expression)
    sides = [sp.Add(*(sign * term for term in terms if is_positive(sign * term, where))) for sign in (1, -1)]
    if not expression.has(sp.Pow) or 0 in sides or sides[0] - sides[1] != expression:
        return False
    return _vanishes(sides[0] ** 2 - sides[1] ** 2, where)


def _vanishes(expression: sp.Expr, where: Region) -> bool:
    try:
        return all(prove_zero(case, inside)[0] is not None for case, inside in _cases(evaluated(expression), where))
    except NotExactError:
        return False


def _cases(expression: sp.Expr, where: Region) -> Iterator[tuple[sp.Expr, Region]]:
    """Yield (expression, region) for each residue class of the integer symbols n in signs (−1)**n and angles n π r.

    In each case n is replaced by period * m + residue with a new integer m, so that the signs and angles have fixed values.
    """
    periods: dict[sp.Symbol, int] = {}
    for node in sp.preorder_traversal(expression):
        for symbol, period in _periods(node):
            periods[symbol] = lcm(periods.get(symbol, 1), period)
    if prod(periods.values()) > _MOST_CASES:
        raise NotExactError(f"The integer symbols give more than {_MOST_CASES} cases.")
    for residues in product(*(range(period) for period in periods.values())):
        replacements = {}
        for (symbol, period), residue in zip(periods.items(), residues, strict=True):
            quotient = sp.Dummy(symbol.name, integer=True, **({"nonnegative": True} if symbol.is_nonnegative else {}))
            start = period if symbol.is_positive and residue == 0 else residue
            replacements[symbol] = period * quotient + start
        yield (expression.subs(replacements) if replacements else expression), where.put(replacements)


def _periods(node: sp.Expr) -> Iterator[tuple[sp.Symbol, int]]:
    """Yield (n, period) for each integer symbol n on which a sign (−1)**n, a power i**n or an angle n π r depends."""
    if (node.is_Pow and node.base in (sp.S.NegativeOne, sp.I)) or (node.is_Pow and node.base.is_negative):
        turn = sp.expand(node.exp * (sp.Rational(1, 2) if node.base is sp.I else 1)) / 2
    elif isinstance(node, sp.sin | sp.cos | sp.tan | sp.cot | sp.sec | sp.csc):
        turn = sp.expand(node.args[0] / (2 * sp.pi))
    elif isinstance(node, sp.exp):
        turn = sp.expand(node.args[0] / (2 * sp.pi * sp.I))
    else:
        return
    for term in sp.Add.make_args(turn):
        rate, symbol = term.as_coeff_Mul()
        if symbol.is_Symbol and symbol.is_integer and rate.is_Rational:
            yield symbol, int(rate.q)
