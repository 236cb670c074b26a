"""Power series of the second program, with bounds of their rests, and their derivatives by dual numbers, forward."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from flint import arb, arb_poly

from lagrotor.errors import InputError
from lagrotor.proofs.checker.tapes import ZERO, demand, rational_of, results_of, slopes_of, terms_of

Ball = Any


class Rest:
    """A power series on 0 ≤ s ≤ 1: n terms, and a bound of the sum of the absolute values of all further ones, which is no
    number where the series may not converge."""

    def __init__(self, terms: list[Ball], rest: Ball, n: int) -> None:
        self.terms, self.rest, self.n = terms[:n], rest, n

    @cached_property
    def total(self) -> Ball:
        """The sum of the terms' absolute values, rounded up."""
        return total(self.terms)

    def size(self) -> Ball:
        """Bound of the sum of all absolute values."""
        return self.total + self.rest

    def __add__(self, other: "Rest") -> "Rest":
        return Rest(_longer(self.terms, other.terms, 1), self.rest + other.rest, self.n)

    def __sub__(self, other: "Rest") -> "Rest":
        return Rest(_longer(self.terms, other.terms, -1), self.rest + other.rest, self.n)

    def __mul__(self, other: "Rest") -> "Rest":
        product = (arb_poly(self.terms) * arb_poly(other.terms)).coeffs()
        rest = total(product[self.n :])
        if not other.rest.is_zero():
            rest += self.size() * other.rest
        if not self.rest.is_zero():
            rest += other.total * self.rest
        return Rest(product, rest, self.n)

    def number(self, value: Ball) -> "Rest":
        """A constant."""
        return Rest([value], ZERO, self.n)

    def at_start(self) -> Ball:
        """The value at s = 0."""
        return self.terms[0] if self.terms else ZERO

    def inverse(self) -> "Rest":
        """1/a = q/(1 − r), r = 1 − a q."""
        demand(self.at_start() > 0 or self.at_start() < 0, "a denominator is not shown to be other than zero")
        q, _ = terms_of("divide", self.terms, self.n)
        size = total(q)
        r = _high(self.terms, q, self.n) + size * self.rest
        return Rest(q, size * r / below_one(r), self.n)

    def sqrt(self) -> "Rest":
        """q + e with e = (a − q² − e²)/(2 q): |e| ≤ k d/(1 + √(1 − k² d)), k = |1/q|, d = |a − q²|."""
        demand(self.at_start() > 0, "a root's argument is not shown to be positive")
        q, _ = terms_of("sqrt", self.terms, self.n)
        k = Rest(q, ZERO, self.n).inverse().size()
        d = _high(q, q, self.n) + self.rest
        return Rest(q, k * d / (1 + below_one(k * k * d).sqrt()), self.n)

    def log(self) -> tuple["Rest", "Rest"]:
        """log a_0 + ∫ a'/a, and 1/a."""
        demand(self.at_start() > 0, "a logarithm's argument is not shown to be positive")
        slope = self.inverse()
        return self._by_slope(slope, self.at_start().log()), slope

    def exp(self) -> "Rest":
        """q + e with e' = a' e + (a' q − q'); never more than the whole, exp(a_0 + |a − a_0|)."""
        (q, _), rate, n = terms_of("exp", self.terms, self.n), slopes_of(self.terms), self.n
        whole = (self.at_start() + total(self.terms[1:]) + self.rest).exp()
        if not total(rate) / (n + 1) < 1:
            return Rest(q, arb(whole.upper()), n)
        e = _high(rate, q, n - 1) / n / below_one(total(rate) / (n + 1))
        return Rest(q, arb(whole.upper()).min(e + (total(q) + e) * (self.rest.exp() - 1)), n)

    def sin_cos(self) -> tuple["Rest", "Rest"]:
        """sin(a) and cos(a): the errors of both solve a linear equation with the coefficient a'."""
        rate, pair, n = slopes_of(self.terms), terms_of("sin", self.terms, self.n), self.n
        e = sum((_high(rate, q, n - 1) for q in pair), ZERO) / n / below_one(total(rate) / (n + 1))
        rest = e + (sum(map(total, pair), ZERO) + 2 * e) * (self.rest.exp() - 1)
        return Rest(pair[0], rest, n), Rest(pair[1], rest, n)

    def arc(self, name: str) -> tuple["Rest", "Rest"]:
        """asin(a) or atan(a), and its slope. Raises InputError for any other operation."""
        one, square = self.number(arb(1)), self * self
        if name not in ("asin", "atan"):
            raise InputError(f"check: the operation {name!r} is unknown")
        slope = (one - square).sqrt().inverse() if name == "asin" else (one + square).inverse()
        return self._by_slope(slope, getattr(self.at_start(), name)()), slope

    def _by_slope(self, slope: "Rest", value: Ball) -> "Rest":
        """g(a) from g' (a): g(a_0) + ∫ a' g'(a) ds, and the rest of a times g'."""
        rate = slopes_of(self.terms)
        product = (arb_poly(rate) * arb_poly(slope.terms)).coeffs()
        terms = [value, *(x / (k + 1) for k, x in enumerate(product[: self.n - 1]))]
        left = total(product[self.n - 1 :]) + total(rate) * slope.rest
        return Rest(terms, left / self.n + self.rest * slope.size(), self.n)


def total(terms: Sequence[Ball]) -> Ball:
    """The sum of the absolute values, rounded up."""
    return arb(sum(map(abs, terms), ZERO).upper())


def _longer(a: list[Ball], b: list[Ball], sign: int) -> list[Ball]:
    """a ± b, term by term."""
    width = max(len(a), len(b))
    first, second = a + [ZERO] * (width - len(a)), b + [ZERO] * (width - len(b))
    return [x + y if sign > 0 else x - y for x, y in zip(first, second, strict=True)]


def _high(a: list[Ball], b: list[Ball], n: int) -> Ball:
    """What the product of two polynomials has from s^n on."""
    return total((arb_poly(a) * arb_poly(b)).coeffs()[n:])


def below_one(x: Ball) -> Ball:
    """1 − x where that is positive; else no number, with which nothing compares."""
    return 1 - x if x < 1 else arb("nan")


def sign_over(poly: Any, rest: Ball, low: Ball, high: Ball, depth: int = 30) -> int:
    """Return the sign of a polynomial with a rest between two places, by middle and slope, by halves; 0 if none is shown."""
    s, middle = low.union(high), (low + high) / 2
    value = poly(middle) + poly.derivative()(s) * (s - middle) + arb(0, rest.upper())
    if value > 0 or value < 0:
        return 1 if value > 0 else -1
    if not depth or not abs(poly(middle)) > rest:
        return 0
    first = sign_over(poly, rest, low, middle, depth - 1)
    return first if first and sign_over(poly, rest, middle, high, depth - 1) == first else 0


class Dual:
    """A series and its derivatives by the start's coordinates; none where it does not depend on them."""

    def __init__(self, value: Rest, by: list[Rest] | None = None) -> None:
        self.value, self.by = value, by

    def linear(self, factor: Rest, other: "Dual | None" = None, second: Rest | None = None) -> list[Rest] | None:
        """factor · self' + second · other'."""
        first = None if self.by is None else [factor * x for x in self.by]
        if other is None or other.by is None or second is None:
            return first
        moved = [second * x for x in other.by]
        return moved if first is None else [x + y for x, y in zip(first, moved, strict=True)]


def evaluated(tape: Any, arguments: Sequence[Dual]) -> list[Dual]:
    """The tape's outputs."""
    one = arguments[0].value.number(arb(1))
    minus = one.number(arb(-1))

    def operation(name: str, a: Dual, b: Dual | None = None) -> Dual:
        if b is None:
            return applied(name, a)
        if name == "add":
            return Dual(a.value + b.value, a.linear(one, b, one))
        if name == "subtract":
            return Dual(a.value - b.value, a.linear(one, b, minus))
        if name == "multiply":
            return Dual(a.value * b.value, a.linear(b.value, b, a.value))
        over = b.value.inverse()
        quotient = a.value * over
        return Dual(quotient, a.linear(over, b, minus * quotient * over))

    def applied(name: str, a: Dual) -> Dual:
        x = a.value
        if name == "exp":
            value = slope = x.exp()
        elif name == "sqrt":
            value = x.sqrt()
            slope = (value + value).inverse()
        elif name in ("sin", "cos"):
            sine, cosine = x.sin_cos()
            value, slope = (sine, cosine) if name == "sin" else (cosine, minus * sine)
        else:
            value, slope = x.log() if name == "log" else x.arc(name)
        return Dual(value, a.linear(slope))

    found = results_of(tape, arguments.__getitem__, lambda x: Dual(one.number(rational_of(x))), operation)
    return [found[place] for place in tape["outputs"]]
