"""A family near a rest for the second program: x = u ξ, each intermediate result its value at rest plus u times a sheet."""

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_series, ctx

from lagrotor.proofs.checker.family_checking import FamilyFlow, Sheet
from lagrotor.proofs.checker.recurrences import ZERO, demand, motion_terms, rational_of
from lagrotor.proofs.checker.tapes import results_of

Ball = Any
Split = tuple[Sheet, Sheet]  # v₀ and w of v₀ + u w
_MOST = 60  # terms of a function's series


class FlowNearRest(FamilyFlow):
    """The motions of ξ = x/u, u a polynomial of ε."""

    def __init__(self, tape: Any, x: list[Any], W: list[Ball], n: int, p: int, u: Any) -> None:
        super().__init__(tape, x, W, n, p)
        self.u = Sheet([u], ZERO, n, p)

    def series(self, h: Ball) -> list[list[Any]]:
        """The terms of x over u."""
        *states, pace = (arb_series(poly.coeffs(), self.p + 1) for poly in self.x)
        u = arb_series(self.u.terms[0].coeffs(), self.p + 1)
        rows = motion_terms(self.tape, [u * x for x in states], [pace], h, self.n)
        return [[x / u for x in row] for row in rows]

    def rates(self, x: list[Sheet]) -> list[Sheet]:
        """Of ξ."""
        return rates_near_rest(self.tape, x[:-1], x[-1], self.u)

    def jacobian(self, x: list[Sheet]) -> list[list[Sheet]]:
        """By ξ that of the motion at x; by the pace the rates at the pace 1."""
        rows = super().jacobian([*(self.u * y for y in x[:-1]), x[-1]])
        by_pace = rates_near_rest(self.tape, x[:-1], self.u.number(arb(1)), self.u)
        return [[*row[:-1], slope] for row, slope in zip(rows, by_pace, strict=True)]


def rates_near_rest(tape: Any, states: Sequence[Sheet], pace: Sheet, u: Sheet) -> list[Sheet]:
    """The rates of ξ."""
    none = u.like([], ZERO)
    arguments: list[Split] = [*((none, x) for x in states), (pace, none)]

    def operation(name: str, a: Split, b: Split | None = None) -> Split:
        if b is None:
            return _moved(name, a, u)
        if name == "add":
            return a[0] + b[0], a[1] + b[1]
        if name == "subtract":
            return a[0] - b[0], a[1] - b[1]
        return _joined(name, a, b, u)

    found = results_of(tape, arguments.__getitem__, lambda x: (u.number(rational_of(x)), none), operation)
    for place in tape["outputs"]:
        demand(found[place][0].size().is_zero(), "the rates do not vanish at rest")
    return [found[place][1] for place in tape["outputs"]]


def _whole(a: Split, u: Sheet) -> Sheet:
    return a[0] + u * a[1]


def _joined(name: str, a: Split, b: Split, u: Sheet) -> Split:
    """a b, with a (b − b₀) + (a − a₀) b₀ off its value at rest; a/b = q, with (a − a₀ − q₀ (b − b₀))/b."""
    if name == "multiply":
        return a[0] * b[0], _whole(a, u) * b[1] + a[1] * b[0]
    q = a[0] * b[0].inverse()
    return q, (a[1] - q * b[1]) * _whole(b, u).inverse()


def _moved(name: str, a: Split, u: Sheet) -> Split:
    """A function, by its addition theorem."""
    at, w = a
    if name == "sqrt":
        q = at.sqrt()
        return q, w * (q + _whole(a, u).sqrt()).inverse()
    if name == "log":
        value, over = at.log()
        part = w * over
        return value, part * quotient(u * part, "log")
    z = u * w
    if name == "exp":
        q = at.exp()
        return q, q * w * quotient(z, "exp")
    demand(name in ("sin", "cos"), f"{name} is no operation of a family")
    sine, cosine = at.sin_cos()
    along, across = w * quotient(z, "sin"), w * quotient(z, "cos")
    if name == "sin":
        return sine, cosine * along - sine * across
    return cosine, w.like([], ZERO) - (sine * along + cosine * across)


def quotient(z: Sheet, name: str) -> Sheet:
    """(e^z − 1)/z, sin(z)/z, (1 − cos z)/z, log(1 + z)/z: Σ c_m z^m with |c_m| ≤ 1/(m + 1), of the first three ≤ 1/(m + 1)!.

    All further terms together are at most the next one over 1 − |z|.
    """
    size = z.size()
    demand(bool(size < 1), "the piece near the rest is too wide")
    least, count, left = arb(2) ** -ctx.prec, 1, size
    while count < _MOST and not left < least:
        count += 1
        left = size**count if name == "log" else size**count / arb(count + 1).fac()
    total = z.like([], arb((left / (1 - size)).upper()))
    power = z.number(arb(1))
    for m in range(count):
        total, power = total + power * z.number(_coefficient(name, m)), power * z
    return total


def _coefficient(name: str, m: int) -> Ball:
    if name == "log":
        return arb((-1) ** m) / (m + 1)
    if name != "exp" and m % 2 == (name == "sin"):
        return ZERO
    return (1 if name == "exp" else (-1) ** (m // 2)) / arb(m + 1).fac()
