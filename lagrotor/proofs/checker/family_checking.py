"""The second program for a family of motions: its own series in s and ε, which share nothing with `taylor_models`.

A function of 0 ≤ s ≤ 1 and |ε| ≤ 1 is a list of polynomials of ε, one for each power of s, and a bound of the rest in the maximum
norm. Functions come from recurrences in s; what they leave out is bounded by the equation that each satisfies: 1 − a q, a − q²,
q' − a' q, a q' − a'. Derivatives are found by dual numbers, forward.
"""

from collections.abc import Sequence
from functools import reduce
from operator import add
from typing import Any

from flint import arb, arb_mat, arb_poly, arb_series, ctx

from lagrotor.errors import NotProved
from lagrotor.proofs.checker.bounded_series import Dual, evaluated
from lagrotor.proofs.checker.tapes import ZERO, demand, motion_terms, terms_of

Ball = Any


def top(x: Ball) -> Ball:
    """The upper end of what is no less than zero."""
    return arb(x.upper())


def bound(poly: Any) -> Ball:
    """Of a polynomial of ε."""
    return top(sum(map(abs, poly.coeffs()), ZERO))


class Sheet:
    """terms: n polynomials of ε of degree p; rest: bound of what is beside them."""

    def __init__(self, terms: list[Any], rest: Ball, n: int, p: int) -> None:
        self.terms, self.rest, self.n, self.p = terms, rest, n, p

    def like(self, terms: list[Any], rest: Ball) -> "Sheet":
        """Another of the same order."""
        return Sheet(terms, rest, self.n, self.p)

    def number(self, value: Ball) -> "Sheet":
        """A constant."""
        return self.like([arb_poly([value])], ZERO)

    def size(self) -> Ball:
        """Of the maximum of the absolute value."""
        return sum(map(bound, self.terms), ZERO) + self.rest

    def __add__(self, other: "Sheet") -> "Sheet":
        return self._plus(other, 1)

    def __sub__(self, other: "Sheet") -> "Sheet":
        return self._plus(other, -1)

    def _plus(self, other: "Sheet", sign: int) -> "Sheet":
        width = max(len(self.terms), len(other.terms))
        none = arb_poly([])
        a, b = (x.terms + [none] * (width - len(x.terms)) for x in (self, other))
        return self.like([x + y if sign > 0 else x - y for x, y in zip(a, b, strict=True)], self.rest + other.rest)

    def __mul__(self, other: "Sheet") -> "Sheet":
        if not self.terms or not other.terms:
            return self.like([], _rest_of_product(self, other, ZERO))
        whole = [arb_poly([])] * (len(self.terms) + len(other.terms) - 1)
        for i, x in enumerate(self.terms):
            for j, y in enumerate(other.terms):
                whole[i + j] += x * y
        terms = [poly.truncate(self.p + 1) for poly in whole[: self.n]]
        left = sum((bound(poly.right_shift(self.p + 1)) for poly in whole[: self.n]), ZERO)
        left += sum((bound(poly) for poly in whole[self.n :]), ZERO)
        return self.like(terms, _rest_of_product(self, other, left))

    def rate(self) -> "Sheet":
        """The derivative by s of the terms alone."""
        return self.like([k * x for k, x in enumerate(self.terms)][1:], ZERO)

    def at_centre(self) -> Ball:
        """The value at s = ε = 0."""
        return self.terms[0][0] if self.terms else ZERO

    def inverse(self) -> "Sheet":
        """1/a = q/(1 − r), r = 1 − a q."""
        demand(bool(self.at_centre() > 0 or self.at_centre() < 0), "a denominator is not shown to be other than zero")
        found, _ = _function(self, "divide")
        r = (self.number(arb(1)) - self * found).size()
        return found.like(found.terms, top(found.size() * r / _left(r)))

    def sqrt(self) -> "Sheet":
        """√a with a − q² = d: |√a − q| ≤ |q| (1 − √(1 − |d|/q²))."""
        demand(bool(self.at_centre() > 0), "a root's argument is not shown to be positive")
        found, _ = _function(self, "sqrt")
        d, k = (self - found * found).size(), found.inverse().size()
        return found.like(found.terms, top(found.size() * (1 - _left(d * k * k).sqrt())))

    def exp(self) -> "Sheet":
        """q' − a' q = ρ gives |e^a − q| ≤ (|ρ_ε| + |ρ_s|) e^|a'|, first along ε, then along s."""
        (found, _), flat = _function(self, "exp"), self.like(self.terms, ZERO)
        start, first = (self.terms[0] if self.terms else arb_poly([])), found.terms[0]
        along = bound(first.derivative() - start.derivative() * first) * bound(start.derivative()).exp()
        slope = flat.rate()
        missed = (found.rate() - slope * found).size()
        error = (along + missed) * slope.size().exp()
        whole = found.size() + error
        return found.like(found.terms, top(error + whole * (self.rest.exp() - 1)))

    def sin_cos(self) -> tuple["Sheet", "Sheet"]:
        """(sin a, cos a): the error's square sum grows by the defects alone."""
        sine, cosine = _function(self, "sin")
        start = (self.terms[0] if self.terms else arb_poly([])).derivative()
        first, second = sine.terms[0], cosine.terms[0]
        error = bound(first.derivative() - start * second) + bound(second.derivative() + start * first)
        slope = self.like(self.terms, ZERO).rate()
        error += (sine.rate() - slope * cosine).size() + (cosine.rate() + slope * sine).size()
        rest = top(error + self.rest)
        return sine.like(sine.terms, rest), cosine.like(cosine.terms, rest)

    def log(self) -> tuple["Sheet", "Sheet"]:
        """a q' − a' = ρ gives |log a − q| ≤ (|ρ_ε| + |ρ_s|) |1/a|; and 1/a."""
        over = self.inverse()
        demand(bool(self.at_centre() > 0), "a logarithm's argument is not shown to be positive")
        (found, _), flat = _function(self, "log"), self.like(self.terms, ZERO)
        start, first = self.terms[0], found.terms[0]
        along = bound(start * first.derivative() - start.derivative())
        missed = (flat * found.rate() - flat.rate()).size()
        k = over.size()
        rest = top((along + missed) * k + self.rest * k / _left(self.rest * k))
        return found.like(found.terms, rest), over

    def arc(self, name: str) -> tuple["Sheet", "Sheet"]:
        """None is known."""
        raise NotProved(f"check: {name} is no operation of a family")


def _rest_of_product(a: Sheet, b: Sheet, left: Ball) -> Ball:
    return top(left + a.rest * b.size() + b.rest * (a.size() - a.rest))


def _poly(x: Any) -> Any:
    """A term as a polynomial of ε."""
    return arb_poly([x] if isinstance(x, arb) else list(x))


def _function(a: Sheet, name: str) -> tuple[Sheet, Sheet]:
    """The terms of a function, and those of its twin, without their rests."""
    value, twin = terms_of(name, [arb_series(x.coeffs(), a.p + 1) for x in a.terms], a.n)
    return a.like([_poly(x) for x in value], ZERO), a.like([_poly(x) for x in twin], ZERO)


def _left(x: Ball) -> Ball:
    demand(bool(x < 1), "a bound does not close over a step of the family")
    return 1 - x


class FamilyFlow:
    """The motions of every ε, followed by the steps of a certificate; x, b and V at their end.

    x: polynomials of ε; W: the box of the start; steps: h, tube, exact numbers.
    """

    def __init__(self, tape: Any, x: list[Any], W: list[Ball], n: int, p: int) -> None:
        self.tape, self.W, self.n, self.p = tape, W, n, p
        self.moving, self.size = len(tape["outputs"]), len(x)
        demand(self.size == len(tape["arguments"]), "a family's motion has no parameters but its pace")
        self.x, self.b = x, [ZERO] * self.size
        self.V = [[Sheet([arb_poly([int(i == j)])], ZERO, 1, p) for j in range(self.size)] for i in range(self.size)]

    def step(self, h: Ball, tube: list[Ball]) -> None:
        """One step."""
        demand(bool(h > 0) and all(r >= 0 for r in tube), "a step has no length or no bounds")
        before, ctx.cap = ctx.cap, self.p + 1
        try:
            self._step(h, tube)
        finally:
            ctx.cap = before

    def _step(self, h: Ball, tube: list[Ball]) -> None:
        moving = self.moving
        terms = [[_poly(x) for x in row] for row in self.series(h)]
        missed = []
        still = [self._full([x], ZERO) for x in self.x[moving:]]
        for row, rate in zip(terms, self.rates([*(self._full(row, ZERO) for row in terms), *still]), strict=True):
            change = _integral(rate, h) - self._full(row, ZERO) + self._full([row[0]], ZERO)
            missed.append(change.size())
        wide = [
            b + sum((v.size() * w for v, w in zip(row, self.W, strict=True)), ZERO)
            for b, row in zip(self.b, self.V, strict=True)
        ]
        J, growth = self._slopes(terms, wide, h, tube)
        off = [x + y for x, y in zip(wide, missed, strict=False)] + wide[moving:]
        demand(
            all(x <= r for x, r in zip(_grown(growth, off)[:moving], tube, strict=True)),
            "the tube about a family is too narrow",
        )
        D = self._derivative(J, h, growth)
        rests = _grown(growth, [*missed, *[ZERO] * (self.size - moving)])
        ends = [_centred(self._full([sum(row, arb_poly([]))], ZERO)) for row in terms]
        ends += [self._full([poly], ZERO) for poly in self.x[moving:]]
        self.b = [
            top(sum((d.size() * x for d, x in zip(row, self.b, strict=True)), rest + end.rest))
            for row, rest, end in zip(D, rests, ends, strict=True)
        ]
        self.V = [[_centred(self._along(row, j)) for j in range(self.size)] for row in D]
        self.x = [end.terms[0] for end in ends]

    def series(self, h: Ball) -> list[list[Any]]:
        """Terms in s of what moves, each a series of ε."""
        x = [arb_series(poly.coeffs(), self.p + 1) for poly in self.x]
        return motion_terms(self.tape, x[: self.moving], x[self.moving :], h, self.n)

    def rates(self, x: list[Sheet]) -> list[Sheet]:
        """Of what moves."""
        return [rate.value for rate in evaluated(self.tape, list(map(Dual, x)))]

    def jacobian(self, x: list[Sheet]) -> list[list[Sheet]]:
        """The rates' derivatives by x."""
        zero = self._full([], ZERO)
        by = [[zero.number(arb(int(i == j))) for j in range(self.size)] for i in range(self.size)]
        rows = evaluated(self.tape, list(map(Dual, x, by)))
        return [row.by or [zero] * self.size for row in rows]

    def _along(self, row: list[Sheet], j: int) -> Sheet:
        return _sum([d * v[j] for d, v in zip(row, self.V, strict=True)])

    def _full(self, terms: list[Any], rest: Ball) -> Sheet:
        return Sheet(terms, rest, self.n, self.p)

    def _slopes(
        self, terms: list[list[Any]], wide: list[Ball], h: Ball, tube: list[Ball]
    ) -> tuple[list[list[Sheet]], Any]:
        """J over the tube, and exp of the bounds of |h J|."""
        rows = [self._full(row, r) for row, r in zip(terms, tube, strict=True)]
        rows += [self._full([poly], w) for poly, w in zip(self.x[self.moving :], wide[self.moving :], strict=True)]
        J = self.jacobian(rows)
        sizes = [[top(h * x.size()) for x in row] for row in J] + [[ZERO] * self.size] * (self.size - self.moving)
        return J, arb_mat(sizes).exp()

    def _derivative(self, J: list[list[Sheet]], h: Ball, growth: Any) -> list[list[Sheet]]:
        """Of the step, by states and pace."""
        size, none = self.size, arb_poly([])
        D = [[[arb_poly([int(i == j)])] for j in range(size)] for i in range(size)]
        for k in range(1, self.n):
            new = [[none] * size for _ in J]
            for i, row in enumerate(J):
                for m, g in enumerate(row):
                    for a, poly in enumerate(g.terms[:k]):
                        for j in range(size):
                            if k - 1 - a < len(D[m][j]):
                                new[i][j] += poly * D[m][j][k - 1 - a]
            for i, row_of_new in enumerate(new):
                for j in range(size):
                    D[i][j].append((row_of_new[j] * (h / k)).truncate(self.p + 1))
        end = [[Sheet([sum(entry, none)], ZERO, 1, self.p) for entry in row] for row in D]
        for j in range(size):
            missed = []
            for i, row in enumerate(J):
                rate = _sum([g * self._full(D[m][j], ZERO) for m, g in enumerate(row)])
                change = _integral(rate, h) - self._full(D[i][j], ZERO)
                missed.append((change + change.number(arb(int(i == j)))).size())
            for i, rest in enumerate(_grown(growth, [*missed, *[ZERO] * (size - len(J))])[: len(J)]):
                end[i][j] = end[i][j].like(end[i][j].terms, rest)
        return end

    def end(self, i: int, eps: Ball) -> Ball:
        """A state of the middle at the end, for every ε of a ball."""
        return self.x[i](eps) + arb(0, self.b[i].upper())

    def slope(self, i: int, j: int, eps: Ball) -> Ball:
        """Its derivative by a start, over the box."""
        v = self.V[i][j]
        return _flat(v)(eps) + arb(0, v.rest.upper())


def _sum(sheets: Sequence[Sheet]) -> Sheet:
    return reduce(add, sheets)


def _flat(a: Sheet) -> Any:
    """The polynomial of ε of what has no s."""
    return sum(a.terms, arb_poly([]))


def _centred(a: Sheet) -> Sheet:
    """With exact coefficients, their balls in the rest."""
    rest = sum((arb(c.rad()) for poly in a.terms for c in poly.coeffs()), a.rest)
    return a.like([arb_poly([c.mid() for c in poly.coeffs()]) for poly in a.terms], top(rest))


def _integral(rate: Sheet, h: Ball) -> Sheet:
    terms = [arb_poly([]), *(poly * (h / (k + 1)) for k, poly in enumerate(rate.terms))]
    rest = h * rate.rest + sum((bound(poly) for poly in terms[rate.n :]), ZERO)
    return rate.like(terms[: rate.n], top(rest))


def _grown(growth: Any, off: Sequence[Ball]) -> list[Ball]:
    """Gronwall's inequality."""
    return [top(x) for x in (growth * arb_mat(len(off), 1, list(off))).entries()]
