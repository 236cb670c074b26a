"""The Taylor polynomial of an expression about a point, exact or in floating-point numbers, in variables that one may choose.

Sums and products are those of polynomials; a function is expanded about the value u of its argument there,
f(u + v) = sum_m f^(m)(u) v^m / m!, of which v, that vanishes at the point, leaves finitely many terms.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import sympy as sp

from lagrotor.errors import DomainError
from lagrotor.mechanics.canonical.polynomials import Polynomial, constant, total

_Z = sp.Dummy("z")
_CORNERED = (sp.Abs, sp.sign, sp.Heaviside, sp.floor, sp.ceiling, sp.re, sp.im, sp.conjugate, sp.arg)


@dataclass(frozen=True)
class LocalSeries:
    """Polynomials of expressions at x = at[x] + moved[x] for each x of `moved`, polynomials without constant terms.

    value: a number of sympy as a coefficient. Raises DomainError where an expression is not analytic at the point.
    """

    at: Mapping[sp.Symbol, sp.Expr]
    moved: Mapping[sp.Symbol, Polynomial]
    order: int
    value: Callable[[sp.Expr], Any]
    known: dict[sp.Expr, Polynomial] = field(default_factory=dict)

    def of(self, e: sp.Expr) -> Polynomial:
        """The polynomial of an expression, through the order."""
        if e not in self.known:
            self.known[e] = self._expanded(e)
        return self.known[e]

    def _expanded(self, e: sp.Expr) -> Polynomial:
        if not e.free_symbols & self.moved.keys():
            return self._number(e)
        if e in self.moved:
            return self.moved[e] + self._number(e)
        if isinstance(e, sp.Add):
            return total([self.of(part) for part in e.args])
        if isinstance(e, sp.Mul):
            first, *rest = map(self.of, e.args)
            for factor in rest:
                first = first.product(factor, self.order)
            return first
        if isinstance(e, sp.Pow):
            return self._power(e)
        if len(e.args) == 1 and not isinstance(e, _CORNERED):
            return self._composed(e.func(_Z), e.args[0])
        raise DomainError(f"normal_form: {e} is not expanded: write it by analytic functions of one argument")

    def _power(self, e: sp.Expr) -> Polynomial:
        if e.exp.is_Integer and e.exp > 0:
            return self.of(e.base).power(int(e.exp), self.order)
        if e.exp.free_symbols & self.moved.keys():
            return self._composed(sp.exp(_Z), e.exp * sp.log(e.base))
        return self._composed(_Z**e.exp, e.base)

    def _composed(self, f: sp.Expr, inner: sp.Expr) -> Polynomial:
        """f(inner): Horner's rule in what of `inner` vanishes at the point."""
        u, v = inner.xreplace(self.at), self.of(inner)
        v = v.where(v.exponents.sum(1) > 0)
        *lower, result = (
            self._number(_derivative(f, m).xreplace({_Z: u}) / sp.factorial(m)) for m in range(self.order + 1)
        )
        for coefficient in reversed(lower):
            result = result.product(v, self.order) + coefficient
        return result

    def _number(self, e: sp.Expr) -> Polynomial:
        at_point = e.xreplace(self.at)
        if at_point.has(sp.zoo, sp.nan, sp.oo, -sp.oo):
            raise DomainError(
                f"normal_form: {e} is singular at {dict(self.at)}: use coordinates that are regular there"
            )
        some = next(iter(self.moved.values()))
        return constant(self.value(at_point), some.variables, some.coefficients.dtype)


@lru_cache(maxsize=4096)
def _derivative(f: sp.Expr, m: int) -> sp.Expr:
    return f if m == 0 else _derivative(f, m - 1).diff(_Z)
