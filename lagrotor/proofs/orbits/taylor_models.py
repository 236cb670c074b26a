"""Taylor models: functions of 0 ≤ s ≤ 1 and |ε| ≤ 1 as a polynomial and a bound of what it leaves out.

The polynomial has n powers of s and p + 1 of ε. The bound is of the maximum norm, in which |f g| ≤ |f| |g|; the polynomial's
own norm is the sum of its coefficients' absolute values. Functions are found as polynomials and then held to what they
satisfy: 1/a by 1 − a q, a root by a − q², exp, log, sin and cos by Taylor's series about the value at s = ε = 0.
Makino & Berz, Int. J. Pure Appl. Math. 4 (2003) 379.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, log2
from typing import Any

from lagrotor.proofs.balls import ZERO, Ball, Balls, arb, arb_poly, ctx, exact, upper
from lagrotor.proofs.tails import TailError

_LONGEST = 80  # terms of a function's series


@dataclass(frozen=True)
class Order:
    """n powers of s, p + 1 of ε. They are packed in one polynomial, s^k ε^j at k width + j, so that products do not overlap."""

    n: int
    p: int

    @property
    def width(self) -> int:
        """Places for each power of s."""
        return 2 * self.p + 1

    def split(self, whole: Any) -> tuple[Any, Balls]:
        """The polynomial's part within the order, and the other coefficients."""
        width, coeffs = self.width, whole.coeffs()
        kept: Balls = []
        dropped: Balls = coeffs[self.n * width :]
        for k in range(0, min(len(coeffs), self.n * width), width):
            kept += coeffs[k : k + self.p + 1]
            beyond = coeffs[k + self.p + 1 : k + width]
            dropped += beyond
            kept += [ZERO] * (self.p if k + width <= len(coeffs) else 0)
        return arb_poly(kept), dropped


def sum_of_sizes(values: Sequence[Ball]) -> Ball:
    """The sum of the absolute values, an upper bound."""
    return upper(sum(map(abs, values), ZERO))


class TaylorModel:
    """poly: packed; rest: bound of what it leaves out, None where only the polynomial is sought."""

    __slots__ = ("_norm", "order", "poly", "rest")

    def __init__(self, poly: Any, rest: Ball | None, order: Order) -> None:
        self.poly, self.rest, self.order, self._norm = poly, rest, order, None

    @property
    def norm(self) -> Ball:
        """Bound of the maximum of the absolute value."""
        if self._norm is None:
            self._norm = sum_of_sizes(self.poly.coeffs()) + (self.rest or ZERO)
        return self._norm

    def constant(self, value: Ball) -> "TaylorModel":
        """A number, with as much sought as here."""
        return TaylorModel(arb_poly([value]), None if self.rest is None else ZERO, self.order)

    def _with(self, poly: Any, *rests: Ball | None) -> "TaylorModel":
        known = [rest for rest in rests if rest is not None]
        return TaylorModel(poly, sum(known, ZERO) if len(known) == len(rests) else None, self.order)

    def __add__(self, other: "TaylorModel") -> "TaylorModel":
        return self._with(self.poly + other.poly, self.rest, other.rest)

    def __sub__(self, other: "TaylorModel") -> "TaylorModel":
        return self._with(self.poly - other.poly, self.rest, other.rest)

    def __neg__(self) -> "TaylorModel":
        return TaylorModel(-self.poly, self.rest, self.order)

    def __mul__(self, other: "TaylorModel") -> "TaylorModel":
        poly, dropped = self.order.split(self.poly * other.poly)
        if self.rest is None or other.rest is None:
            return TaylorModel(poly, None, self.order)
        rest = sum_of_sizes(dropped)
        if not self.rest.is_zero():
            rest += self.rest * other.norm
        if not other.rest.is_zero():
            rest += other.rest * sum_of_sizes(self.poly.coeffs())
        return TaylorModel(poly, rest, self.order)

    def __truediv__(self, other: "TaylorModel") -> "TaylorModel":
        return self * other.inverse()

    def _product(self, first: Any, second: Any) -> Any:
        return self.order.split(first * second)[0]

    def _doublings(self) -> range:
        return range(ceil(log2(self.order.n + self.order.p)) + 1)

    def inverse(self) -> "TaylorModel":
        """q/(1 − r) with r = 1 − a q."""
        q = arb_poly([1 / exact(_nonzero(self, "a denominator"))])
        for _ in self._doublings():
            q = self._product(q, 2 - self._product(self.poly, q))
        found = TaylorModel(q, None if self.rest is None else ZERO, self.order)
        if self.rest is None:
            return found
        r = (self.constant(arb(1)) - self * found).norm
        found.rest = found.norm * r / _below_one(r)
        found._norm = None
        return found

    def sqrt(self) -> "TaylorModel":
        """q √(1 + d/q²) with d = a − q²; |√(1 + x) − 1| ≤ 1 − √(1 − |x|)."""
        centre = exact(_nonzero(self, "a root's argument"))
        if not centre > 0:
            raise TailError("a root's argument is not shown to be positive")
        y = arb_poly([1 / centre.sqrt()])
        for _ in self._doublings():
            y = self._product(y, 3 - self._product(self.poly, self._product(y, y))) * arb(0.5)
        found = TaylorModel(self._product(self.poly, y), None if self.rest is None else ZERO, self.order)
        if self.rest is None:
            return found
        over = found.inverse().norm
        x = over * over * (self - found * found).norm
        found.rest = found.norm * (1 - _below_one(x).sqrt())
        found._norm = None
        return found

    def _about(self) -> tuple[Ball, "TaylorModel"]:
        """The value at s = ε = 0, and what is left."""
        centre = self.poly[0]
        return centre, TaylorModel(self.poly - centre, self.rest, self.order)

    def _series(self, factors: Sequence[Ball], left: Ball) -> "TaylorModel":
        """Σ factors[m] a^m, and a bound of the terms beyond."""
        total = self.constant(factors[-1])
        for factor in reversed(factors[:-1]):
            total = total * self + self.constant(factor)
        return TaylorModel(total.poly, None if total.rest is None else total.rest + left, self.order)

    def _terms(self, size: Ball, growth: Any) -> int:
        """How many terms of a series with sizes growth(m) are above the precision."""
        least = arb(2) ** -ctx.prec
        for m in range(4, _LONGEST):
            if growth(m) < least:
                return m
        raise TailError("a function's series does not converge over the step")

    def exp(self) -> "TaylorModel":
        """e^c Σ d^m/m! with a = c + d."""
        c, d = self._about()
        size = d.norm
        count = self._terms(size, lambda m: size**m / arb(m).fac() * size.exp())
        left = size**count / arb(count).fac() * size.exp()
        return d._series([c.exp() / arb(m).fac() for m in range(count)], c.exp() * left)

    def sin_cos(self) -> tuple["TaylorModel", "TaylorModel"]:
        """The addition theorem with a = c + d."""
        c, d = self._about()
        size = d.norm
        count = self._terms(size, lambda m: size**m / arb(m).fac())
        left = size**count / arb(count).fac()
        ring = (c.sin(), c.cos(), -c.sin(), -c.cos())
        sine = d._series([ring[m % 4] / arb(m).fac() for m in range(count)], left)
        return sine, d._series([ring[(m + 1) % 4] / arb(m).fac() for m in range(count)], left)

    def by_slope(self, name: str, slope: "TaylorModel") -> "TaylorModel":
        """log a = log c + Σ (−1)^(m+1) (d/c)^m/m with a = c + d."""
        if name != "log":
            raise TailError(f"{name} in the equations has no Taylor model here")
        c, d = self._about()
        size = upper(d.norm / c)
        count = self._terms(size, lambda m: size**m / (m * _below_one(size)))
        left = size**count / (count * _below_one(size))
        return d._series([c.log(), *(arb((-1) ** (m + 1)) / m / c**m for m in range(1, count))], left)

    def integral(self, h: Ball) -> "TaylorModel":
        """h times the integral from s = 0."""
        width, coeffs = self.order.width, self.poly.coeffs()
        moved = [x * h / (place // width + 1) for place, x in enumerate(coeffs)]
        poly, dropped = self.order.split(arb_poly([ZERO] * width + moved))
        if self.rest is None:
            return TaylorModel(poly, None, self.order)
        return TaylorModel(poly, sum_of_sizes(dropped) + upper(h * self.rest), self.order)

    def at_end(self) -> "TaylorModel":
        """At s = 1, of ε alone."""
        width, coeffs = self.order.width, self.poly.coeffs()
        found = [sum(coeffs[j::width], ZERO) for j in range(self.order.p + 1)]
        return TaylorModel(arb_poly(found), self.rest, Order(1, self.order.p))


def _nonzero(a: TaylorModel, what: str) -> Ball:
    """The value at s = ε = 0, which must not be zero."""
    value = a.poly[0]
    if not (value > 0 or value < 0):
        raise TailError(f"{what} is not shown to be other than zero")
    return value


def _below_one(x: Ball) -> Ball:
    """1 − x, which must be positive."""
    if not x < 1:
        raise TailError("a bound does not close: the step is too long, or the piece too wide")
    return 1 - x
