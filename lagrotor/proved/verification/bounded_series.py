"""Power series of the second program, with bounds of their rests, and their derivatives by dual numbers, forward."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from flint import arb, arb_poly

from lagrotor.errors import InputError
from lagrotor.proved.verification.recurrences import ZERO, demand, rational_of, slopes_of, terms_of
from lagrotor.proved.verification.tapes import results_of

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

    def at_start(self) -> Ball:
        """The value at s = 0."""
        return self.terms[0] if self.terms else ZERO


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


def _inverse(a: Rest) -> Rest:
    """1/a = q/(1 − r), r = 1 − a q."""
    demand(a.at_start() > 0 or a.at_start() < 0, "a denominator is not shown to be other than zero")
    q, _ = terms_of("divide", a.terms, a.n)
    size = total(q)
    r = _high(a.terms, q, a.n) + size * a.rest
    return Rest(q, size * r / below_one(r), a.n)


def _root(a: Rest) -> Rest:
    """q + e with e = (a − q² − e²)/(2 q): |e| ≤ k d/(1 + √(1 − k² d)), k = |1/q|, d = |a − q²|."""
    demand(a.at_start() > 0, "a root's argument is not shown to be positive")
    q, _ = terms_of("sqrt", a.terms, a.n)
    k = _inverse(Rest(q, ZERO, a.n)).size()
    d = _high(q, q, a.n) + a.rest
    return Rest(q, k * d / (1 + below_one(k * k * d).sqrt()), a.n)


def _logarithm(a: Rest) -> Rest:
    """log a_0 + ∫ a'/a."""
    demand(a.at_start() > 0, "a logarithm's argument is not shown to be positive")
    return _integral_of(a, _inverse(a), a.at_start().log())


def _exponential(a: Rest) -> Rest:
    """q + e with e' = a' e + (a' q − q'); never more than the whole, exp(a_0 + |a − a_0|)."""
    (q, _), rate = terms_of("exp", a.terms, a.n), slopes_of(a.terms)
    whole = (a.at_start() + total(a.terms[1:]) + a.rest).exp()
    if not total(rate) / (a.n + 1) < 1:
        return Rest(q, arb(whole.upper()), a.n)
    e = _high(rate, q, a.n - 1) / a.n / below_one(total(rate) / (a.n + 1))
    return Rest(q, arb(whole.upper()).min(e + (total(q) + e) * (a.rest.exp() - 1)), a.n)


def _turning(a: Rest) -> tuple[Rest, Rest]:
    """sin(a) and cos(a): the errors of both solve a linear equation with the coefficient a'."""
    rate, pair = slopes_of(a.terms), terms_of("sin", a.terms, a.n)
    e = sum((_high(rate, q, a.n - 1) for q in pair), ZERO) / a.n / below_one(total(rate) / (a.n + 1))
    rest = e + (sum(map(total, pair), ZERO) + 2 * e) * (a.rest.exp() - 1)
    return Rest(pair[0], rest, a.n), Rest(pair[1], rest, a.n)


def _integral_of(a: Rest, slope: Rest, value: Ball) -> Rest:
    """g(a) from g' (a): g(a_0) + ∫ a' g'(a) ds, and the rest of a times g'."""
    rate = slopes_of(a.terms)
    product = (arb_poly(rate) * arb_poly(slope.terms)).coeffs()
    terms = [value, *(x / (k + 1) for k, x in enumerate(product[: a.n - 1]))]
    left = total(product[a.n - 1 :]) + total(rate) * slope.rest
    return Rest(terms, left / a.n + a.rest * slope.size(), a.n)


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


def evaluated(tape: Any, arguments: list[Dual], n: int) -> list[Dual]:
    """The tape's outputs."""
    one, minus = Rest([arb(1)], ZERO, n), Rest([arb(-1)], ZERO, n)

    def operation(name: str, a: Dual, b: Dual | None = None) -> Dual:
        if b is None:
            return _function(name, a, one, n)
        if name == "add":
            return Dual(a.value + b.value, a.linear(one, b, one))
        if name == "subtract":
            return Dual(a.value - b.value, a.linear(one, b, minus))
        if name == "multiply":
            return Dual(a.value * b.value, a.linear(b.value, b, a.value))
        over = _inverse(b.value)
        quotient = a.value * over
        return Dual(quotient, a.linear(over, b, minus * quotient * over))

    found = results_of(tape, arguments.__getitem__, lambda x: Dual(Rest([rational_of(x)], ZERO, n)), operation)
    return [found[place] for place in tape["outputs"]]


def _function(name: str, a: Dual, one: Rest, n: int) -> Dual:
    """A function of one variable with its derivative."""
    x = a.value
    if name == "exp":
        value = slope = _exponential(x)
    elif name == "sqrt":
        value = _root(x)
        slope = _inverse(value + value)
    elif name == "log":
        value, slope = _logarithm(x), _inverse(x)
    elif name in ("sin", "cos"):
        sine, cosine = _turning(x)
        value, slope = (sine, cosine) if name == "sin" else (cosine, Rest([arb(-1)], ZERO, n) * sine)
    elif name == "asin":
        slope = _inverse(_root(one - x * x))
        value = _integral_of(x, slope, x.at_start().asin())
    elif name == "atan":
        slope = _inverse(one + x * x)
        value = _integral_of(x, slope, x.at_start().atan())
    else:
        raise InputError(f"check: the operation {name!r} is unknown")
    return Dual(value, a.linear(slope))
