"""Conversion of an expression to a quotient of polynomials in its generators."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import NamedTuple

import sympy as sp
from sympy.polys.rings import PolyElement

from lagrotor.algebra.enclosures import Point
from lagrotor.algebra.evidence import sign_at
from lagrotor.algebra.generators import CIRCULAR, FAMILY, HYPERBOLIC, Angle, Survey, angle_of, radicand
from lagrotor.algebra.quotients import Quotient, Ring
from lagrotor.algebra.roots import Dependent, Root, split_roots


class Pair(NamedTuple):
    """Cosine and sine of an angle, both divided by the same product of factors."""

    cosine: PolyElement
    sine: PolyElement
    factors: dict[PolyElement, int]

    def part(self, place: int) -> PolyElement:
        return self.sine if place else self.cosine


class Roots(NamedTuple):
    """The square roots of some expressions, divided into independent and dependent ones, and the ring of their polynomials.

    Each dependent root comes with its sign, which is None if it may differ from region to region.
    """

    ring: Ring
    independent: list[Root]
    dependent: list[tuple[Dependent, int | None]]

    @property
    def unsigned(self) -> list[Dependent]:
        return [root for root, sign in self.dependent if sign is None]

    def sign_ratio(self, root: Dependent) -> sp.Expr:
        """Return a dependent root divided by its expression in independent roots with the sign +1; the value is +1 or −1."""
        return sp.sqrt(root.base) / (self._factor(root) * sp.Mul(*(sp.sqrt(factor.base) for factor in root.of)))

    def signs_at(self, point: Point) -> tuple[int | None, ...]:
        return tuple(sign_at(self.sign_ratio(root), point) for root in self.unsigned)

    def _factor(self, root: Dependent) -> sp.Expr:
        """Return the factor by which the product of the square roots in `root.of` is multiplied to give ± the root."""
        over = [root.numerator, *(factor.denominator for factor in root.of)]
        return sp.Mul(*map(self.ring.expression, over)) / self.ring.expression(root.denominator)

    def known_sign(self, root: Dependent) -> int | None:
        """Return the sign of a dependent root if the symbols' assumptions decide it, and None otherwise.

        For example, sqrt(a)*sqrt(b) = sqrt(a*b) if a >= 0 or b >= 0.
        """
        if not root.numerator:
            return 1
        if not any(base.free_symbols for base in (root.base, *(member.base for member in root.of))):
            return sign_at(self.sign_ratio(root), {})
        if sum(not member.base.is_nonnegative for member in root.of) > 1:
            return None
        factor = self._factor(root)
        return 1 if factor.is_nonnegative else -1 if factor.is_nonpositive else None


def find_roots(survey: Survey) -> Roots:
    """Divide the square roots of the survey into independent ones and ones that these determine."""
    if not survey.radicands:
        return Roots(Ring(()), [], [])
    plain = Reader(survey, Ring(sorted(survey.atoms, key=sp.default_sort_key)), {})
    ordered = sorted(survey.radicands, key=lambda base: (bool(base.free_symbols), base.sort_key()))
    quotients = [(base, *plain.quotient(base)) for base in ordered]
    independent, dependent = split_roots(plain.ring, [(b, over, plain.ring.expanded(f)) for b, over, f in quotients])
    unsigned = Roots(plain.ring, independent, [(root, None) for root in dependent])
    return Roots(plain.ring, independent, [(root, unsigned.known_sign(root)) for root in dependent])


def reader(survey: Survey, roots: Roots, signs: Sequence[int] = ()) -> Reader:
    """Return a reader for the expressions of a survey; `signs` are the choices for the unknown signs of dependent roots."""
    names = set(survey.atoms)
    named = {root: roots.ring.expression(root.denominator) * sp.sqrt(root.base) for root in roots.independent}
    names |= set(named.values())
    for angle in survey.angles:
        names |= set(_names(survey, angle))
    ring = Ring(sorted(names, key=sp.default_sort_key))
    for angle in survey.angles:
        if not survey.compact(angle):
            c, s = _names(survey, angle)
            square = ring.generators[c] ** 2 - 1
            ring.set_square(s, square if angle[0] else -square)

    def lifted(polynomial: PolyElement) -> PolyElement:
        generators = [ring.generators[name] for name in roots.ring.names if name in ring.generators]
        terms = (ring.products([ring.one * c, *map(ring.power, generators, m)]) for m, c in polynomial.terms())
        return sum(terms, ring.polynomials.zero)

    for root, name in named.items():
        ring.set_square(name, lifted(root.square))
    values: dict[sp.Expr, Quotient] = {}
    for root, name in named.items():
        values[root.base] = ring.times(Quotient(ring.generators[name], {}), ring.inverse(lifted(root.denominator)))
    remaining_signs = iter(signs)
    for image, sign in roots.dependent:
        over = ring.products([lifted(image.numerator), *(ring.generators[named[member]] for member in image.of)])
        over *= next(remaining_signs) if sign is None else sign
        values[image.base] = ring.times(Quotient(over, {}), ring.inverse(lifted(image.denominator)))
    return Reader(survey, ring, values)


def _names(survey: Survey, angle: Angle) -> tuple[sp.Expr, ...]:
    """Return the generators of a base angle: an exponential, or cosine and sine."""
    hyperbolic, monomial = angle
    base = monomial / survey.angles[angle].step
    if survey.compact(angle):
        return (sp.exp(base if hyperbolic else sp.I * base, evaluate=False),)
    return tuple(function(base, evaluate=False) for function in FAMILY[hyperbolic])


class Reader:
    """Converts expressions of a survey into quotients in a ring; `roots` holds the square root of each radicand."""

    def __init__(self, survey: Survey, ring: Ring, roots: dict[sp.Expr, Quotient]) -> None:
        self.survey, self.ring, self.roots = survey, ring, roots
        self.known: dict[sp.Expr, Quotient] = {}

    def quotient(self, node: sp.Expr) -> Quotient:
        """Return the node as a quotient in the ring; raise NotExactError if a denominator vanishes identically."""
        if node not in self.known:
            self.known[node] = self._build(node)
        return self.known[node]

    def _build(self, node: sp.Expr) -> Quotient:
        ring = self.ring
        if node.is_Symbol or node is sp.pi:
            return Quotient(ring.generators[node], {})
        if node.is_Rational:
            return ring.number(node)
        if node is sp.I:
            return self.roots[sp.S.NegativeOne]
        if (base := radicand(node)) is not None:
            return ring.raised(self.roots[base], int(2 * node.exp) if node.is_Pow else 1)
        if node.is_Add:
            return ring.sum(map(self.quotient, node.args))
        if node.is_Mul:
            return reduce(ring.times, map(self.quotient, node.args))
        if node.is_Pow:
            return ring.raised(self.quotient(node.base), int(node.exp))
        if node.func is sp.exp:
            terms = (self._exponential(*term) for term in angle_of(node)[1].items())
            return reduce(ring.times, terms, ring.number(sp.S.One))
        return self._function(node)

    def _function(self, node: sp.Expr) -> Quotient:
        ring, pair = self.ring, self._pair(node)
        over, under = (CIRCULAR | HYPERBOLIC)[node.func]
        numerator = ring.expanded(pair.factors) if over is None else pair.part(over)
        if under is None:
            return Quotient(numerator, pair.factors)
        name = FAMILY[node.func in HYPERBOLIC][under](node.args[0], evaluate=False)
        return ring.times(Quotient(numerator, {}), ring.inverse(pair.part(under), name))

    def _pair(self, node: sp.Expr) -> Pair:
        """Return cosine and sine of the function's argument by the addition theorems."""
        hyperbolic, (turn, rates) = node.func in HYPERBOLIC, angle_of(node)
        cosine, sine = (self.quotient(function(turn * sp.pi)).numerator for function in FAMILY[False])
        total = Pair(cosine, sine, {})
        for monomial, rate in rates.items():
            total = self._plus(hyperbolic, total, self._multiple((hyperbolic, monomial), rate))
        return total

    def _plus(self, hyperbolic: bool, a: Pair, b: Pair) -> Pair:
        """Return cosine and sine of the sum of two angles: C = C1*C2 -+ S1*S2, S = S1*C2 + C1*S2."""
        product, sign = self.ring.product, 1 if hyperbolic else -1
        cosine = product(a.cosine, b.cosine) + sign * product(a.sine, b.sine)
        sine = product(a.sine, b.cosine) + product(a.cosine, b.sine)
        return Pair(cosine, sine, {f: a.factors.get(f, 0) + b.factors.get(f, 0) for f in a.factors | b.factors})

    def _multiple(self, angle: Angle, rate: sp.Rational) -> Pair:
        """Return cosine and sine of rate*monomial as polynomials in the generators of its base angle, by repeated doubling."""
        ring, times = self.ring, abs(int(rate * self.survey.angles[angle].step))
        names, sign = _names(self.survey, angle), 1 if rate > 0 else -1
        if self.survey.compact(angle):
            w = ring.generators[names[0]]
            square = ring.power(w, 2 * times)
            i = ring.one if angle[0] else self.roots[sp.S.NegativeOne].numerator
            sine = ring.product(i if angle[0] else -i, (square - 1) / 2)
            return Pair((square + 1) / 2, sign * sine, {w: times})
        c, s = (ring.generators[name] for name in names)
        double, total = Pair(c, sign * s, {}), Pair(ring.one, ring.polynomials.zero, {})
        while times:
            if times % 2:
                total = self._plus(angle[0], total, double)
            times //= 2
            double = self._plus(angle[0], double, double) if times else double
        return total

    def _exponential(self, monomial: sp.Expr, rate: sp.Rational) -> Quotient:
        """Return exp(rate*monomial), written as a power of the generator or as cosh + sinh."""
        angle = True, monomial
        if not self.survey.compact(angle):
            pair = self._multiple(angle, rate)
            return Quotient(pair.cosine + pair.sine, {})
        w, times = self.ring.generators[_names(self.survey, angle)[0]], int(rate * self.survey.angles[angle].step)
        return Quotient(self.ring.power(w, times), {}) if times > 0 else Quotient(self.ring.one, {w: -times})
