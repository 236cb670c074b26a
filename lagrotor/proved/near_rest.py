"""Motions near a rest, x = u ξ: the field f(u ξ)/u is analytic in u, u = 0 with its linear motion included.

Every intermediate result of the program is kept as v = v₀ + u w, v₀ its value at rest and w a Taylor model; the rules give w
without a division by u. As f(0) = 0 exactly, the rates of ξ are the w of f, and their derivatives by ξ those of f by x.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lagrotor.proved.balls import Ball
from lagrotor.proved.stepping import Motion
from lagrotor.proved.tails import ZERO, Evaluation, TailError
from lagrotor.proved.taylor_models import TaylorModel


@dataclass(frozen=True, eq=False)
class NearRest:
    """v₀ + u w: at = v₀, off = w."""

    at: TaylorModel
    off: TaylorModel
    u: TaylorModel

    @cached_property
    def whole(self) -> TaylorModel:
        """The value."""
        return self.at + self.u * self.off

    @property
    def poly(self) -> Any:
        """The value's polynomial."""
        return self.whole.poly

    def _with(self, at: TaylorModel, off: TaylorModel) -> "NearRest":
        return NearRest(at, off, self.u)

    def constant(self, value: Ball) -> "NearRest":
        """A number."""
        return self._with(self.at.constant(value), self.at.constant(ZERO))

    def __add__(self, other: "NearRest") -> "NearRest":
        return self._with(self.at + other.at, self.off + other.off)

    def __sub__(self, other: "NearRest") -> "NearRest":
        return self._with(self.at - other.at, self.off - other.off)

    def __neg__(self) -> "NearRest":
        return self._with(-self.at, -self.off)

    def __mul__(self, other: "NearRest") -> "NearRest":
        return self._with(self.at * other.at, self.whole * other.off + other.at * self.off)

    def inverse(self) -> "NearRest":
        """1/v − 1/v₀ = −u w/(v v₀)."""
        at = self.at.inverse()
        return self._with(at, -(self.off * at * self.whole.inverse()))

    def sqrt(self) -> "NearRest":
        """√v − √v₀ = u w/(√v + √v₀)."""
        at = self.at.sqrt()
        return self._with(at, self.off * (self.whole.sqrt() + at).inverse())

    def exp(self) -> "NearRest":
        """e^v − e^v₀ = e^v₀ (e^(u w) − 1)."""
        at = self.at.exp()
        return self._with(at, at * self.off * (self.u * self.off).ratio("exp"))

    def sin_cos(self) -> tuple["NearRest", "NearRest"]:
        """The addition theorems."""
        z = self.u * self.off
        sine, cosine = self.at.sin_cos()
        along, across = self.off * z.ratio("sin"), self.off * z.ratio("cos")
        return self._with(sine, cosine * along - sine * across), self._with(cosine, -(sine * along + cosine * across))

    def by_slope(self, name: str, slope: "NearRest") -> "NearRest":
        """log v − log v₀ = log(1 + u w/v₀)."""
        if name != "log":
            raise TailError(f"{name} in the equations has no Taylor model here")
        part = self.off * self.at.inverse()
        return self._with(self.at.by_slope(name, slope.at), part * (self.u * part).ratio("log"))


@dataclass(frozen=True)
class RestEvaluation:
    """Rates of ξ and their derivatives by ξ and by the pace, the last argument."""

    evaluation: Evaluation

    @property
    def outputs(self) -> list[TaylorModel]:
        """The w of f. Raises TailError unless f vanishes at rest, exactly."""
        found = self.evaluation.outputs
        if not all(f.at.norm.is_zero() for f in found):
            raise TailError("the rates do not vanish at rest")
        return [f.off for f in found]

    def gradient(self, output: int) -> list[TaylorModel | None]:
        """Of one rate."""
        *states, pace = self.evaluation.gradient(output)
        return [*(g and g.whole for g in states), pace and pace.off]


@dataclass(frozen=True)
class MotionNearRest(Motion):
    """The motion of ξ = x/u with its pace; u: a polynomial of ε."""

    u: Any = None

    def evaluation(self, arguments: Sequence[TaylorModel]) -> Any:
        """Of the states ξ and the pace."""
        *states, pace = arguments
        zero = pace.constant(ZERO)
        u = TaylorModel(self.u, zero.rest, pace.order)
        return RestEvaluation(Evaluation(self.tape, [*(NearRest(zero, x, u) for x in states), NearRest(pace, zero, u)]))
