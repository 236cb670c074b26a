"""A limit of a method, predicted and measured."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log


@dataclass(frozen=True)
class Limit:
    """One row of the table of limits: the regime, the quantity with its unit, the formula of its prediction, the predicted and
    the measured value, and lagrotor's way out."""

    regime: str
    what: str
    formula: str
    predicted: float
    measured: float
    tool: str

    @property
    def ratio(self) -> float:
        return self.measured / self.predicted


def threshold(fails: Callable[[float], bool], low: float, high: float, share: float = 0.01) -> float:
    """Return the positive x between low and high at which `fails` changes its value, with the relative accuracy `share`.

    It is found by bisection in log x. Raises ValueError if `fails` has the same value at both ends.
    """
    below = fails(low)
    if fails(high) == below:
        raise ValueError(f"threshold: the result is the same at {low:g} and {high:g}: widen the interval")
    lower, upper = log(low), log(high)
    while upper - lower > share:
        middle = (lower + upper) / 2
        lower, upper = (middle, upper) if fails(exp(middle)) == below else (lower, middle)
    return exp((lower + upper) / 2)
