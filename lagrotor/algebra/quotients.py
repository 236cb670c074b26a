"""Quotients of polynomials in generators, some of which have a known square, with a bound on the work.

The ring is Q[g_1, ..., g_n] with rules g**2 = square, where no square contains a generator with a rule.  The work of a product
is its number of pairs of terms times the length of their coefficients and monomials; a product beyond the bound is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache, reduce
from typing import Any, NamedTuple

import sympy as sp
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.errors import NotExactError, TooLargeError

# Units of work for one expression: a few seconds.
MOST_WORK = 300_000
# Bits of a coefficient that one unit of work multiplies.
_BITS = 256
# Generators that one unit of work multiplies.
_SYMBOLS = 16


class Quotient(NamedTuple):
    """A numerator over a product of factor**exponent; the factors are stored separately to recognize common ones."""

    numerator: PolyElement
    factors: dict[PolyElement, int]


class Ring:
    """A ring of polynomials in the generators `names`. Its `divisors` record every factor by which something was divided."""

    def __init__(self, names: Iterable[sp.Expr]) -> None:
        self.names = tuple(names) or (sp.Dummy(),)
        self.polynomials = _polynomials(len(self.names))
        self.one = self.polynomials.one
        self.generators: dict[sp.Expr, PolyElement] = dict(zip(self.names, self.polynomials.gens, strict=True))
        self.squares: dict[int, PolyElement] = {}
        self.divisors: dict[PolyElement, sp.Expr | None] = {}
        self.work = 0

    def set_square(self, name: sp.Expr, square: PolyElement) -> None:
        """Add the rule name**2 = square."""
        self.squares[self.names.index(name)] = square

    def number(self, value: sp.Rational) -> Quotient:
        return Quotient(self.one * sp.QQ(value.p, value.q), {})

    def expression(self, polynomial: PolyElement) -> sp.Expr:
        return polynomial.as_expr(*self.names)

    def spend(self, work: int) -> None:
        """Add to the work that was done in this ring; raise NotExactError beyond the bound."""
        self.work += work
        if self.work > MOST_WORK:
            raise TooLargeError(f"Deciding it takes more than {MOST_WORK:,} products of terms.")

    def product(self, a: PolyElement, b: PolyElement) -> PolyElement:
        if a is self.one or b is self.one:
            return a if b is self.one else b
        self.spend(len(a) * len(b) * _length(a) * _length(b) * (1 + len(self.names) // _SYMBOLS))
        return self.reduced(a * b)

    def products(self, polynomials: Iterable[PolyElement]) -> PolyElement:
        return reduce(self.product, polynomials, self.one)

    def power(self, polynomial: PolyElement, times: int) -> PolyElement:
        if len(polynomial) == 1:
            [(monomial, coefficient)] = polynomial.iterterms()
            if abs(coefficient) != 1:
                self.spend((1 + times * _bits(coefficient) // _BITS) ** 2)
            raised = self.polynomials.from_dict({tuple(times * e for e in monomial): coefficient**times})
            return self.reduced(raised)
        result = self.one
        for _ in range(times):
            result = self.product(result, polynomial)
        return result

    def expanded(self, factors: Mapping[PolyElement, int]) -> PolyElement:
        return self.products(self.power(factor, times) for factor, times in factors.items())

    def reduced(self, polynomial: PolyElement) -> PolyElement:
        """Replace g**(2*k + r) by square**k * g**r, r = 0 or 1, for every generator g with a known square."""
        degrees = tuple(map(max, zip(*polynomial.itermonoms(), strict=True))) if self.squares else ()
        for index, square in self.squares.items():
            # A square contains no generator with a rule, so it does not change the degrees in such generators.
            if not degrees or degrees[index] < 2:
                continue
            blocks: dict[int, dict[tuple[int, ...], Any]] = {}
            for monomial, coefficient in polynomial.iterterms():
                times, parity = divmod(monomial[index], 2)
                blocks.setdefault(times, {})[(*monomial[:index], parity, *monomial[index + 1 :])] = coefficient
            polynomial = self.polynomials.zero
            for times, block in blocks.items():
                polynomial += self.product(self.power(square, times), self.polynomials.from_dict(block))
        return polynomial

    def times(self, a: Quotient, b: Quotient) -> Quotient:
        factors = {f: a.factors.get(f, 0) + b.factors.get(f, 0) for f in a.factors | b.factors}
        return Quotient(self.product(a.numerator, b.numerator), factors)

    def sum(self, terms: Iterable[Quotient]) -> Quotient:
        """Add the terms over the least common multiple of their factors, equal denominators first."""
        alike: dict[frozenset[tuple[PolyElement, int]], PolyElement] = {}
        common: dict[PolyElement, int] = {}
        for numerator, factors in terms:
            key = frozenset(factors.items())
            alike[key] = alike.get(key, self.polynomials.zero) + numerator
            common |= {factor: max(times, common.get(factor, 0)) for factor, times in factors.items()}
        total = self.polynomials.zero
        for key, numerator in alike.items():
            exponents = dict(key)
            missing = {factor: times - exponents.get(factor, 0) for factor, times in common.items()}
            total += self.product(numerator, self.expanded(missing))
        return Quotient(total, common)

    def raised(self, base: Quotient, times: int) -> Quotient:
        """Return base**times for a positive or negative exponent."""
        if times < 0:
            base = self.times(Quotient(self.expanded(base.factors), {}), self.inverse(base.numerator))
        factors = {factor: abs(times) * power for factor, power in base.factors.items()}
        return Quotient(self.power(base.numerator, abs(times)), factors)

    def inverse(self, polynomial: PolyElement, name: sp.Expr | None = None) -> Quotient:
        """Return 1/polynomial and record its factors, or `name` if given, in `divisors`; raise NotExactError for zero."""
        if not polynomial:
            raise NotExactError("A denominator vanishes identically.")
        powers = tuple(min(exponents) for exponents in zip(*polynomial.itermonoms(), strict=True))
        factors = {g: n for g, n in zip(self.polynomials.gens, powers, strict=True) if n}
        cofactor = {tuple(m - p for m, p in zip(e, powers, strict=True)): c for e, c in polynomial.iterterms()}
        if len(cofactor) > 1:
            factors[self.polynomials.from_dict(cofactor).monic()] = 1
        if name is None:
            for factor in factors:
                self.divisors.setdefault(factor, None)
        else:
            self.divisors[polynomial.monic()] = name
        return Quotient(self.one * (1 / polynomial.LC), factors)


@cache
def _polynomials(generators: int) -> PolyRing:
    """Return a polynomial ring in symbols with fixed names, since the names of the actual generators may coincide."""
    return PolyRing(sp.symbols(f"g:{generators}"), sp.QQ)


def _length(polynomial: PolyElement) -> int:
    """Return the length of the longest coefficient of a polynomial, in multiples of _BITS bits."""
    return 1 + max(map(_bits, polynomial.itercoeffs()), default=0) // _BITS


def _bits(coefficient: Any) -> int:
    return coefficient.numerator.bit_length() + coefficient.denominator.bit_length()
