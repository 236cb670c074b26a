"""The checker's power series with remainder bounds, and forward-mode derivatives by dual numbers."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

from flint import arb, arb_poly

from lagrotor.errors import InputError
from lagrotor.proofs.checker.tapes import ZERO, demand, rational_of, results_of, slopes_of, terms_of

Ball = Any


class Series:
    """A power series on 0 ≤ s ≤ 1: n terms, and a bound of the sum of the absolute values of all further terms.

    The bound is nan if the series may diverge.
    """

    def __init__(self, terms: list[Ball], remainder: Ball, n: int) -> None:
        self.terms, self.remainder, self.n = terms[:n], remainder, n

    @cached_property
    def total(self) -> Ball:
        """The sum of the terms' absolute values, rounded up."""
        return total(self.terms)

    def size(self) -> Ball:
        return self.total + self.remainder

    def __add__(self, b: "Series") -> "Series":
        return Series(_longer(self.terms, b.terms, 1), self.remainder + b.remainder, self.n)

    def __sub__(self, b: "Series") -> "Series":
        return Series(_longer(self.terms, b.terms, -1), self.remainder + b.remainder, self.n)

    def __mul__(self, b: "Series") -> "Series":
        product = (arb_poly(self.terms) * arb_poly(b.terms)).coeffs()
        remainder = total(product[self.n :])
        if not b.remainder.is_zero():
            remainder += self.size() * b.remainder
        if not self.remainder.is_zero():
            remainder += b.total * self.remainder
        return Series(product, remainder, self.n)

    def number(self, value: Ball) -> "Series":
        return Series([value], ZERO, self.n)

    def at_start(self) -> Ball:
        return self.terms[0] if self.terms else ZERO

    def inverse(self) -> "Series":
        """Return 1/a = q/(1 − r), where q is the truncated inverse and r = 1 − a q."""
        demand(self.at_start() > 0 or self.at_start() < 0, "a denominator is not proved to be nonzero")
        q, _ = terms_of("divide", self.terms, self.n)
        size = total(q)
        r = _high(self.terms, q, self.n) + size * self.remainder
        return Series(q, size * r / below_one(r), self.n)

    def sqrt(self) -> "Series":
        """Return √a = q + e with the truncated root q. The error e = (a − q² − e²)/(2 q) is bounded by a contraction.

        With k = |1/q| and d = |a − q²| the bound is |e| ≤ k d/(1 + √(1 − k² d)).
        """
        demand(self.at_start() > 0, "a root's argument is not proved to be positive")
        q, _ = terms_of("sqrt", self.terms, self.n)
        k = Series(q, ZERO, self.n).inverse().size()
        d = _high(q, q, self.n) + self.remainder
        return Series(q, k * d / (1 + below_one(k * k * d).sqrt()), self.n)

    def log(self) -> tuple["Series", "Series"]:
        """Return log a = log a_0 + ∫ a'/a, and 1/a."""
        demand(self.at_start() > 0, "a logarithm's argument is not proved to be positive")
        slope = self.inverse()
        return self._by_slope(slope, self.at_start().log()), slope

    def exp(self) -> "Series":
        """Return exp a = q + e with a truncated q and e' = a' e + (a' q − q'); the size is at most exp(a_0 + |a − a_0|)."""
        (q, _), rate, n = terms_of("exp", self.terms, self.n), slopes_of(self.terms), self.n
        whole = (self.at_start() + total(self.terms[1:]) + self.remainder).exp()
        if not total(rate) / (n + 1) < 1:
            return Series(q, arb(whole.upper()), n)
        e = _high(rate, q, n - 1) / n / below_one(total(rate) / (n + 1))
        return Series(q, arb(whole.upper()).min(e + (total(q) + e) * (self.remainder.exp() - 1)), n)

    def sin_cos(self) -> tuple["Series", "Series"]:
        """Return sin(a) and cos(a). The errors of both truncated series solve a linear equation with the coefficient a'."""
        rate, pair, n = slopes_of(self.terms), terms_of("sin", self.terms, self.n), self.n
        e = sum((_high(rate, q, n - 1) for q in pair), ZERO) / n / below_one(total(rate) / (n + 1))
        remainder = e + (sum(map(total, pair), ZERO) + 2 * e) * (self.remainder.exp() - 1)
        return Series(pair[0], remainder, n), Series(pair[1], remainder, n)

    def arc(self, name: str) -> tuple["Series", "Series"]:
        """Return asin(a) or atan(a), and the derivative with respect to a. Raises InputError for any other operation."""
        unit, square = self.number(arb(1)), self * self
        if name not in ("asin", "atan"):
            raise InputError(f"check: the operation {name!r} is unknown")
        slope = (unit - square).sqrt().inverse() if name == "asin" else (unit + square).inverse()
        return self._by_slope(slope, getattr(self.at_start(), name)()), slope

    def _by_slope(self, slope: "Series", value: Ball) -> "Series":
        """Return g(a) = g(a_0) + ∫ a' g'(a) ds from `slope` = g'(a); the remainder of a is multiplied by the size of g'."""
        rate = slopes_of(self.terms)
        product = (arb_poly(rate) * arb_poly(slope.terms)).coeffs()
        terms = [value, *(x / (k + 1) for k, x in enumerate(product[: self.n - 1]))]
        high = total(product[self.n - 1 :]) + total(rate) * slope.remainder
        return Series(terms, high / self.n + self.remainder * slope.size(), self.n)


def total(terms: Sequence[Ball]) -> Ball:
    """Return the sum of the absolute values, rounded up."""
    return arb(sum(map(abs, terms), ZERO).upper())


def _longer(a: list[Ball], b: list[Ball], sign: int) -> list[Ball]:
    """Return the terms of a + b (`sign` 1) or a − b (−1); the shorter list is extended by zeros."""
    width = max(len(a), len(b))
    first, second = a + [ZERO] * (width - len(a)), b + [ZERO] * (width - len(b))
    return [x + y if sign > 0 else x - y for x, y in zip(first, second, strict=True)]


def _high(a: list[Ball], b: list[Ball], n: int) -> Ball:
    """Return the sum of the absolute values of the terms of a b with powers from s^n on."""
    return total((arb_poly(a) * arb_poly(b)).coeffs()[n:])


def below_one(x: Ball) -> Ball:
    """Return 1 − x if it is positive, else nan, for which every comparison is False."""
    return 1 - x if x < 1 else arb("nan")


def sign_over(poly: Any, remainder: Ball, low: Ball, high: Ball, depth: int = 30) -> int:
    """Return the sign of a polynomial plus a bounded remainder between two values of s, by bisection; 0 if it is not proved."""
    s, middle = low.union(high), (low + high) / 2
    value = poly(middle) + poly.derivative()(s) * (s - middle) + arb(0, remainder.upper())
    if value > 0 or value < 0:
        return 1 if value > 0 else -1
    if not depth or not abs(poly(middle)) > remainder:
        return 0
    first = sign_over(poly, remainder, low, middle, depth - 1)
    return first if first and sign_over(poly, remainder, middle, high, depth - 1) == first else 0


class Dual:
    """A series and its derivatives with respect to the initial coordinates; `by` is None if it does not depend on them."""

    def __init__(self, value: Series, by: list[Series] | None = None) -> None:
        self.value, self.by = value, by

    def linear(self, factor: Series, b: "Dual | None" = None, second: Series | None = None) -> list[Series] | None:
        """Return the derivatives factor · self' + second · b' of a function of two duals; None if both are constant."""
        first = None if self.by is None else [factor * x for x in self.by]
        if b is None or b.by is None or second is None:
            return first
        terms = [second * x for x in b.by]
        return terms if first is None else [x + y for x, y in zip(first, terms, strict=True)]


def evaluate(tape: Any, arguments: Sequence[Dual]) -> list[Dual]:
    unit = arguments[0].value.number(arb(1))
    minus = unit.number(arb(-1))

    def operation(name: str, a: Dual, b: Dual | None = None) -> Dual:
        if b is None:
            return applied(name, a)
        if name == "add":
            return Dual(a.value + b.value, a.linear(unit, b, unit))
        if name == "subtract":
            return Dual(a.value - b.value, a.linear(unit, b, minus))
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

    results = results_of(tape, arguments.__getitem__, lambda x: Dual(unit.number(rational_of(x))), operation)
    return [results[place] for place in tape["outputs"]]
