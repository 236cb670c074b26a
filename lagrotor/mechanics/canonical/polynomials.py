"""Polynomials in many variables as arrays, truncated at an order: products, Poisson brackets, Lie transforms.

Coefficients are floating-point numbers, or elements of a field in arrays of objects: rational, or rational in
parameters. Variables come in canonical pairs, z_1 … z_n and then w_1 … w_n, with {z_j, w_j} = c_j:

    {f, g} = sum_j c_j (∂f/∂z_j ∂g/∂w_j − ∂f/∂w_j ∂g/∂z_j),       exp(L_g) f = f + {f, g} + {{f, g}, g}/2! + …

Equal exponents have equal keys, sum_j e_j r_j modulo 2⁶⁴ with fixed random r_j; keys add like exponents.
Dragt & Finn, J. Math. Phys. 17 (1976) 2215; Hori, Publ. Astron. Soc. Japan 18 (1966) 287.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

Coefficients = NDArray[Any]
Exponents = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial, the sum of coefficients[k] × prod_j x_j^exponents[k, j].

    `exponents` has the shape (m, n) and no equal rows. `coefficients` has the shape (m,) and no zeros.
    """

    exponents: NDArray[np.int64]
    coefficients: Coefficients

    @property
    def variables(self) -> int:
        """The number of variables."""
        return int(self.exponents.shape[1])

    @cached_property
    def terms(self) -> dict[Exponents, Any]:
        """The nonzero coefficients, {exponents: coefficient}."""
        return {tuple(e): c for e, c in zip(self.exponents.tolist(), self.coefficients.tolist(), strict=True)}

    @cached_property
    def parts(self) -> dict[int, Polynomial]:
        """The homogeneous polynomials by degree, {degree: polynomial}."""
        degrees = self.exponents.sum(1)
        return {int(d): self.where(degrees == d) for d in np.unique(degrees)}

    @cached_property
    def _keys(self) -> NDArray[np.uint64]:
        return self.exponents.astype(np.uint64) @ _multipliers(self.variables)

    def where(self, chosen: NDArray[np.bool_]) -> Polynomial:
        """Return the terms selected by a mask (m,)."""
        return Polynomial(self.exponents[chosen], self.coefficients[chosen])

    def part(self, degree: int) -> Polynomial:
        """Return the homogeneous part of a degree."""
        return self.parts.get(degree, self.where(np.zeros(len(self.coefficients), dtype=bool)))

    def through(self, order: int) -> Polynomial:
        """Return the terms up to a degree."""
        return self.where(self.exponents.sum(1) <= order)

    def __add__(self, other: Polynomial) -> Polynomial:
        return total([self, other])

    def __sub__(self, other: Polynomial) -> Polynomial:
        return total([self, other.times(-1)])

    def times(self, factor: Any) -> Polynomial:
        """Return the product with a nonzero number, or with one nonzero number for each term, shape (m,)."""
        return Polynomial(self.exponents, self.coefficients * factor)

    def over(self, divisor: Any) -> Polynomial:
        """Return the quotient by a number, or by one number for each term, shape (m,)."""
        return Polynomial(self.exponents, self.coefficients / divisor)

    def product(self, factor: Polynomial, order: int) -> Polynomial:
        """Return the product without its terms of degrees above `order`."""
        pairs = [(a, b) for d, a in self.parts.items() for e, b in factor.parts.items() if d + e <= order]
        return total([_product(a, b) for a, b in pairs] or [self.part(-1)])

    def power(self, n: int, order: int) -> Polynomial:
        """Return the n-th power, n ≥ 1, of the polynomial without its terms of degrees above `order`."""
        return reduce(lambda a, b: a.product(b, order), [self] * n)

    def derivative(self, k: int) -> Polynomial:
        """Return ∂/∂x_k."""
        by = self.where(self.exponents[:, k] > 0)
        lower = by.exponents.copy()
        lower[:, k] -= 1
        return Polynomial(lower, by.coefficients * by.exponents[:, k].astype(by.coefficients.dtype))

    def substitute(self, values: Sequence[Polynomial], order: int, first: int = 0) -> Polynomial:
        """Substitute x_k = values[k] for k ≥ `first` by Horner's rule, without terms of degrees above `order`."""
        if first == self.variables:
            constants = np.zeros((len(self.coefficients), values[0].variables), dtype=np.int64)
            return Polynomial(constants, self.coefficients)
        powers, result = self.exponents[:, first], None
        for power in range(int(powers.max(initial=0)), -1, -1):
            term = self.where(powers == power).substitute(values, order, first + 1)
            result = term if result is None else result.product(values[first], order) + term
        return result if result is not None else self

    def at(self, point: Coefficients) -> Any:
        """Return the values at points of shape (…, n), as an array of shape (…)."""
        return (np.prod(np.asarray(point)[..., None, :] ** self.exponents, axis=-1) * self.coefficients).sum(-1)


@lru_cache(maxsize=64)
def _multipliers(n: int) -> NDArray[np.uint64]:
    return np.random.default_rng(0).integers(0, 2**64, size=n, dtype=np.uint64)


def polynomial(terms: Mapping[Exponents, Any], variables: int, kind: Any = complex) -> Polynomial:
    """Return the polynomial of {exponents: coefficient}; kind: complex or object, the type of the coefficients."""
    nonzero = {e: c for e, c in terms.items() if c}
    values = np.empty(len(nonzero), dtype=kind)
    values[:] = list(nonzero.values())
    return Polynomial(np.array(list(nonzero), dtype=np.int64).reshape(-1, variables), values)


def variable(k: int, variables: int, unit: Any = 1.0, kind: Any = complex) -> Polynomial:
    return polynomial({tuple(int(j == k) for j in range(variables)): unit}, variables, kind)


def linear_form(row: Sequence[Any] | Coefficients, kind: Any = complex) -> Polynomial:
    """Return sum_j row_j x_j."""
    units = map(tuple, np.eye(len(row), dtype=int).tolist())
    return polynomial(dict(zip(units, row, strict=True)), len(row), kind)


def constant(value: Any, variables: int, kind: Any = complex) -> Polynomial:
    return polynomial({(0,) * variables: value}, variables, kind)


def total(polynomials: Sequence[Polynomial]) -> Polynomial:
    rows = zip(*((p._keys, p.exponents, p.coefficients) for p in polynomials), strict=True)
    return _collect(*map(np.concatenate, rows))


def _product(a: Polynomial, b: Polynomial) -> Polynomial:
    """Return the sum of all products of a term of a and a term of b."""
    if not len(a.coefficients) or not len(b.coefficients):
        return a.part(-1)
    keys = (a._keys[:, None] + b._keys).ravel()
    exponents = (a.exponents[:, None] + b.exponents).reshape(len(keys), -1)
    return _collect(keys, exponents, np.multiply.outer(a.coefficients, b.coefficients).ravel())


def _collect(keys: NDArray[np.uint64], exponents: NDArray[np.int64], coefficients: Coefficients) -> Polynomial:
    """Add terms of equal exponents, and drop zeros."""
    if not len(keys):
        return Polynomial(exponents, coefficients)
    order = np.argsort(keys, kind="stable")
    ascending = keys[order]
    first = np.flatnonzero(np.append(True, ascending[1:] != ascending[:-1]))
    sums = np.add.reduceat(coefficients[order], first)
    nonzero = sums.astype(bool)
    return Polynomial(exponents[order[first[nonzero]]], sums[nonzero])


def inverse_matrix(m: Sequence[Sequence[Polynomial]], order: int) -> list[list[Polynomial]]:
    """Return the inverse m₀⁻¹ − m₀⁻¹ (m − m₀) m₀⁻¹ + … of a square matrix of polynomials, without degrees above `order`.

    The matrix m₀ of the constant terms must be regular.
    """
    n, some = range(len(m)), m[0][0]
    over = np.linalg.inv([[f.part(0).coefficients.sum() for f in row] for row in m])
    higher = [[f - f.part(0) for f in row] for row in m]
    start = [[constant(c, some.variables, some.coefficients.dtype) for c in row] for row in over]
    inverse = start
    for _ in range(order):
        product = [[total([higher[a][k].product(inverse[k][b], order) for k in n]) for b in n] for a in n]
        inverse = [
            [total([start[a][b], *(product[k][b].times(-over[a, k]) for k in n if over[a, k])]) for b in n] for a in n
        ]
    return inverse


def poisson_bracket(f: Polynomial, g: Polynomial, weights: Coefficients, order: int) -> Polynomial:
    """Return {f, g} without degrees above `order`; `weights`, shape (n,), are the brackets c_j of the canonical pairs."""
    n = len(weights)
    summands = [f.part(-1)]
    for j in range(n):
        up = f.derivative(j).product(g.derivative(n + j), order)
        down = f.derivative(n + j).product(g.derivative(j), order)
        summands += [(up - down).times(weights[j])]
    return total(summands)


def lie_transform(f: Polynomial, g: Polynomial, weights: Coefficients, order: int) -> Polynomial:
    """Return f after the flow of g in unit time, exp(L_g) f, without degrees above `order`. g has no terms below degree 3."""
    result = term = f
    k = 0
    while len(term.coefficients):
        k += 1
        term = poisson_bracket(term, g, weights, order).over(k)
        result = result + term
    return result
