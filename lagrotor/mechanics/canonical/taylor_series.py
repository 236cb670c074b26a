"""Taylor series in several variables, of expressions and of programs.

`LocalSeries` gives the Taylor polynomial of an expression about a point, exact or in floating-point numbers. A
`TruncatedSeries` stores all coefficients through a degree, lowest degrees first, and compiled programs accept it as a number:
jet transport. The motion of such a series contains all derivatives with respect to the initial state: it solves the
variational equations to any order. Both expand f about the value u of its argument, f(u + v) = sum_m f^(m)(u) v^m / m!; v has
no constant term, so that the sum is finite.

Berz, Modern Map Methods in Particle Beam Physics, ch. 2; Jorba & Zou, Experimental Mathematics 14 (2005) 99.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache, reduce
from itertools import combinations_with_replacement
from operator import mul
from typing import Any

import numpy as np
import sympy as sp
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import NDArray

from lagrotor.errors import DomainError
from lagrotor.mechanics.canonical.polynomials import Polynomial, constant, total
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.printers import compile_program

_Z = sp.Symbol("_argument")  # a symbol, since a Dummy has no name in compiled code
_CORNERED = (sp.Abs, sp.sign, sp.Heaviside, sp.floor, sp.ceiling, sp.re, sp.im, sp.conjugate, sp.arg)


@dataclass(frozen=True)
class LocalSeries:
    """Polynomials of expressions at x = at[x] + displacements[x], where the displacements are polynomials without constant terms.

    `value` converts a number of sympy to a coefficient. Raises DomainError if an expression is not analytic at the point.
    """

    at: Mapping[sp.Symbol, sp.Expr]
    displacements: Mapping[sp.Symbol, Polynomial]
    order: int
    value: Callable[[sp.Expr], Any]
    cache: dict[sp.Expr, Polynomial] = field(default_factory=dict)

    def of(self, e: sp.Expr) -> Polynomial:
        """Return the Taylor polynomial of an expression, of the degree `order`."""
        if e not in self.cache:
            self.cache[e] = self._expanded(e)
        return self.cache[e]

    def _expanded(self, e: sp.Expr) -> Polynomial:
        if not e.free_symbols & self.displacements.keys():
            return self._number(e)
        if e in self.displacements:
            return self.displacements[e] + self._number(e)
        if isinstance(e, sp.Add):
            return total([self.of(argument) for argument in e.args])
        if isinstance(e, sp.Mul):
            first, *factors = map(self.of, e.args)
            for factor in factors:
                first = first.product(factor, self.order)
            return first
        if isinstance(e, sp.Pow):
            return self._power(e)
        if len(e.args) == 1 and not isinstance(e, _CORNERED):
            return self._composed(e.func(_Z), e.args[0])
        raise DomainError(
            f"normal_form: {e} has no Taylor series that is known: write it with powers and analytic functions of one argument"
        )

    def _power(self, e: sp.Expr) -> Polynomial:
        if e.exp.is_Integer and e.exp > 0:
            return self.of(e.base).power(int(e.exp), self.order)
        if e.exp.free_symbols & self.displacements.keys():
            return self._composed(sp.exp(_Z), e.exp * sp.log(e.base))
        return self._composed(_Z**e.exp, e.base)

    def _composed(self, f: sp.Expr, inner: sp.Expr) -> Polynomial:
        """Return f(inner), by Horner's rule in the polynomial of inner without its constant."""
        u, v = inner.xreplace(self.at), self.of(inner)
        v = v.where(v.exponents.sum(1) > 0)
        values = (_derivative(f, m).xreplace({_Z: u}) / sp.factorial(m) for m in range(self.order + 1))
        *lower, result = map(self._number, values)
        for coefficient in reversed(lower):
            result = result.product(v, self.order) + coefficient
        return result

    def _number(self, e: sp.Expr) -> Polynomial:
        at_point = e.xreplace(self.at)
        if at_point.has(sp.zoo, sp.nan, sp.oo, -sp.oo):
            raise DomainError(f"normal_form: {e} is singular at {dict(self.at)}: use coordinates regular there")
        some = next(iter(self.displacements.values()))
        return constant(self.value(at_point), some.variables, some.coefficients.dtype)


@lru_cache(maxsize=4096)
def _derivative(f: sp.Expr, m: int) -> sp.Expr:
    return f if m == 0 else _derivative(f, m - 1).diff(_Z)


_NAMES = {f"arc{f}": f"a{f}" for f in ("sin", "cos", "tan", "sinh", "cosh", "tanh")}
_SMOOTH = ("sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", *_NAMES)


@dataclass(frozen=True, eq=False)
class JetSpace:
    """The exponents of all monomials in n variables through a degree, shape (N, n), and a table for products of series.

    Coefficient k of a product a·b is the sum of a[first[j]] b[second[j]] for j from begins[k] up to, not including, begins[k
    + 1].
    """

    exponents: NDArray[np.int64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    begins: NDArray[np.int64]

    @property
    def degree(self) -> int:
        return int(self.exponents[-1].sum())

    def product(self, a: Array, b: Array) -> Array:
        """Return the coefficients of a product of two series, without the powers above the degree."""
        return np.add.reduceat(a[self.first] * b[self.second], self.begins)

    def constant(self, value: float) -> TruncatedSeries:
        return TruncatedSeries(np.append(value, np.zeros(len(self.exponents) - 1)), self)

    def variable(self, k: int) -> TruncatedSeries:
        unit = np.arange(self.exponents.shape[1]) == k
        return TruncatedSeries((self.exponents == unit).all(axis=1).astype(float), self)


@lru_cache(maxsize=16)
def jet_space(variables: int, degree: int) -> JetSpace:
    """Return the space of the series in a number of variables through a degree."""
    choices = [choice for d in range(degree + 1) for choice in combinations_with_replacement(range(variables), d)]
    rows = [np.bincount(np.array(choice, dtype=int), minlength=variables) for choice in choices]
    exponents = np.array(rows, dtype=np.int64).reshape(-1, variables)
    place = {tuple(e): k for k, e in enumerate(exponents.tolist())}
    pairs = [(i, j, a + b) for i, a in enumerate(exponents) for j, b in enumerate(exponents)]
    triples = sorted((place[tuple(e.tolist())], i, j) for i, j, e in pairs if e.sum() <= degree)
    out, first, second = np.array(triples).T
    return JetSpace(exponents, first, second, np.searchsorted(out, np.arange(len(exponents))))


@dataclass(frozen=True, eq=False)
class TruncatedSeries(NDArrayOperatorsMixin):
    """A series sum_k coefficients[k] × prod_j x_j^exponents[k, j], which numpy's analytic functions of one argument accept.

    Any other function raises DomainError.
    """

    coefficients: Array
    space: JetSpace

    @property
    def polynomial(self) -> Polynomial:
        """The series as a polynomial of its nonzero terms."""
        return Polynomial(self.space.exponents, self.coefficients + 0j).where(self.coefficients != 0)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **_: Any) -> TruncatedSeries:
        name = ufunc.__name__
        if len(inputs) == 1:
            return TruncatedSeries(-self.coefficients, self.space) if name == "negative" else self._composed(name)
        a, b = inputs
        if name == "power" and not isinstance(b, TruncatedSeries):
            return a._power(b)
        if name == "power":
            return np.exp(b * np.log(a))
        rows = [
            x.coefficients if isinstance(x, TruncatedSeries) else self.space.constant(x).coefficients for x in inputs
        ]
        if name in ("add", "subtract"):
            return TruncatedSeries(ufunc(*rows), self.space)
        if name == "multiply":
            plain = not (isinstance(a, TruncatedSeries) and isinstance(b, TruncatedSeries))
            scaled = rows[0][0] * rows[1] if not isinstance(a, TruncatedSeries) else rows[0] * rows[1][0]
            return TruncatedSeries(scaled if plain else self.space.product(*rows), self.space)
        if name == "divide":
            plain = not isinstance(b, TruncatedSeries)
            return TruncatedSeries(rows[0] / b, self.space) if plain else a * b._composed("power", -1.0)
        raise _not_analytic(name)

    def _power(self, n: float) -> TruncatedSeries:
        if n != int(n) or n < 0:
            return self._composed("power", float(n))
        return reduce(mul, [self] * int(n)) if n else self.space.constant(1.0)

    def _composed(self, name: str, *exponent: float) -> TruncatedSeries:
        """Return f of this series, by Horner's rule in the series without its constant term; NaN outside the domain of f."""
        f = _taylor(name, self.space.degree, *exponent)
        try:
            *lower, last = f(float(self.coefficients[0]))
        except (ArithmeticError, TypeError, ValueError):  # outside the function's domain: the solver shortens its step
            return TruncatedSeries(np.full(len(self.coefficients), np.nan), self.space)
        v = self.coefficients.copy()
        v[0] = 0.0
        result = last * (np.arange(len(v)) == 0)
        for c in reversed(lower):
            result = self.space.product(result, v)
            result[0] += c
        return TruncatedSeries(result, self.space)


def _not_analytic(name: str) -> DomainError:
    return DomainError(f"normal_form: {name} is not expanded: write H by analytic functions of one argument")


@lru_cache(maxsize=64)
def _taylor(name: str, degree: int, n: float = 1.0) -> Callable[[float], list[float]]:
    """Return a function of u that gives f^(m)(u)/m! for m = 0 … degree; f is a function of numpy by name, or the power n."""
    if name != "power" and name not in _SMOOTH:
        raise _not_analytic(name)
    f = _Z ** (int(n) if n == int(n) else n) if name == "power" else getattr(sp, _NAMES.get(name, name))(_Z)
    return compile_program(Program((_Z,), (), tuple(_derivative(f, m) / sp.factorial(m) for m in range(degree + 1))))
