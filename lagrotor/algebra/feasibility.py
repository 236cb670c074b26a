"""Proofs that equations and inequalities have no common solution.

Each side is a linear form in kernels: symbols, products or functions. `signs` gives bounds of the kernels. If Fourier–Motzkin
elimination of the kernels ends in a false inequality between numbers, the conditions exclude each other; otherwise nothing is
decided.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import sympy as sp

from lagrotor.algebra.scalar import node_count
from lagrotor.algebra.signs import ANY, NONNEGATIVE, POSITIVE, Region, bounds, conditions, is_real, signs

_MOST_ROWS, _MOST_PARTS = 200, 400
_SMALL = sp.Rational(1, 10**6)  # upper bound of a small quantity


class _Row(NamedTuple):
    """A linear inequality: Σ rate · kernel + number > 0 if `strict`, and ≥ 0 otherwise."""

    rates: dict[sp.Expr, sp.Rational]
    number: sp.Expr
    strict: bool

    def plus(self, second: _Row, kernel: sp.Expr) -> _Row:
        """Return a positive combination of two rows in which a kernel cancels; its two coefficients must have opposite signs."""
        a, b = (1 / abs(row.rates[kernel]) for row in (self, second))
        rates = {
            k: a * self.rates.get(k, sp.S.Zero) + b * second.rates.get(k, sp.S.Zero)
            for k in {**self.rates, **second.rates}
        }
        number = sp.expand(a * self.number + b * second.number)
        return _Row({k: rate for k, rate in rates.items() if rate}, number, self.strict or second.strict)


def is_infeasible(equations: Sequence[sp.Expr], where: Region, small: Sequence[sp.Symbol] = ()) -> bool:
    """Return True if it is proved that no point of the region solves all e = 0; symbols in `small` are at most 10⁻⁶ in size."""
    if sum(node_count(e) for e in (*equations, *(e for e, _ in where.above))) > _MOST_PARTS:
        return False
    if any(map(_has_no_root, equations)) or any(0 not in (signs(e, where) or ANY) for e in equations):
        return True
    facts = [(sign * e, False) for e in equations if is_real(e, where) for sign in (1, -1)]
    stronger = Region((*facts, *where.above))
    if any(not (signs(e, stronger) or ANY) & (POSITIVE if strict else NONNEGATIVE) for e, strict in where.above):
        return True
    sides = [*((sign * e, False) for e in equations for sign in (1, -1)), *where.above]
    rows = [_Row(*_linear(form), strict) for e, strict in sides for form in _forms(e)]
    kernels = sorted({kernel for row in rows for kernel in row.rates}, key=sp.default_sort_key)
    # In a real sum, one term of unknown kind is real; two are not known to be.
    unknown = {kernel for kernel in kernels if not is_real(kernel, stronger)}
    rows = [row for row in rows if len(unknown & row.rates.keys()) < 2]
    rows += [row for kernel in kernels for row in _bounding(kernel, stronger, small)]
    return _excludes(rows, kernels)


def has_principal_values(e: sp.Basic, equations: Sequence[sp.Expr], where: Region) -> bool:
    """Return True if roots and logarithms in e must be read as complex principal values.

    This is so if e contains i or a complex symbol, or if e has no odd root and is real at no inner point of the region.
    """
    if e.has(sp.I) or not all(s.is_real for s in e.free_symbols):
        return True
    natural = conditions(e)
    odd = any(n.exp.is_Rational and n.exp.q > 2 for n in e.atoms(sp.Pow))
    inside = [sp.Gt(r.gts, r.lts) for r in natural if r is not sp.false]
    return not odd and (sp.false in natural or sp.false in inside or is_infeasible(equations, where.with_(*inside)))


def _has_no_root(e: sp.Expr) -> bool:
    """Return True if a rational polynomial in one real symbol has no real root."""
    if len(e.free_symbols) != 1 or not next(iter(e.free_symbols)).is_real or not e.is_polynomial():
        return False
    polynomial = sp.Poly(e, *e.free_symbols)
    return bool(polynomial.domain.is_QQ or polynomial.domain.is_ZZ) and polynomial.count_roots() == 0


def _forms(e: sp.Expr) -> list[sp.Expr]:
    """Return the forms of an expression that are tried: itself, its expansion, and completed squares; none if it contains i."""
    if e.has(sp.I):
        return []
    return list(dict.fromkeys((e, sp.expand(e), _completed(sp.expand(e)))))


def _completed(e: sp.Expr) -> sp.Expr:
    """Return a x² + b x + c as a (x + b/2a)² + c − b²/4a, symbol by symbol."""
    for symbol in sorted(e.free_symbols, key=sp.default_sort_key):
        if e.is_polynomial(symbol) and sp.degree(e, symbol) == 2:
            c, b, a = (e.coeff(symbol, k) for k in range(3))
            if a.is_Rational:
                return a * (symbol + b / (2 * a)) ** 2 + _completed(sp.expand(c - b**2 / (4 * a)))
    return e


def _linear(e: sp.Expr) -> tuple[dict[sp.Expr, sp.Rational], sp.Expr]:
    """Write e as Σ rate · kernel + number, and return the rational rate of each kernel, and the number."""
    rates, number = dict[sp.Expr, sp.Rational](), sp.S.Zero
    for term in sp.Add.make_args(e):
        rate, kernel = term.as_coeff_Mul(rational=True)
        if kernel.is_number:
            number += term
        else:
            rates[kernel] = rates.get(kernel, sp.S.Zero) + rate
    return {kernel: rate for kernel, rate in rates.items() if rate}, number


def _bounding(kernel: sp.Expr, where: Region, small: Sequence[sp.Symbol]) -> Iterator[_Row]:
    """Yield the inequalities that bound a single kernel, from the region, from smallness, and for an even root from its sign."""
    for side, bound in zip((1, -1), bounds(kernel, where), strict=True):
        if bound is not None:
            yield _Row({kernel: sp.Integer(side)}, -side * bound[0], bound[1])
        if kernel in small:
            yield _Row({kernel: sp.Integer(side)}, _SMALL, False)
    if kernel.is_Pow and kernel.exp.is_Rational and kernel.exp.q % 2 == 0:
        yield _Row({kernel: sp.S.One}, sp.S.Zero, False)


def _excludes(rows: list[_Row], kernels: Sequence[sp.Expr]) -> bool:
    """Return True if the rows have no common solution when the kernels are treated as independent real numbers."""
    for kernel in kernels:
        above, below = ([row for row in rows if side * row.rates.get(kernel, 0) > 0] for side in (1, -1))
        rows = [row for row in rows if kernel not in row.rates]
        rows += [a.plus(b, kernel) for a in above for b in below]
        if len(rows) > _MOST_ROWS:
            return False
    return any(row.number.is_negative or (row.strict and row.number.is_zero) for row in rows)
