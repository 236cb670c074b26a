"""A limit of a method: by a formula, and as measured."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, log


@dataclass(frozen=True)
class Limit:
    """One row: the regime, the quantity (with its unit), the formula, its value, the measured value, what lagrotor does there."""

    regime: str
    what: str
    formula: str
    predicted: float
    measured: float
    tool: str

    @property
    def ratio(self) -> float:
        """Measured over predicted."""
        return self.measured / self.predicted


def threshold(fails: Callable[[float], bool], low: float, high: float, share: float = 0.01) -> float:
    """The positive x between low and high at which `fails` changes, to a relative `share`, by halving in log x.

    Raises ValueError when it does not change between them.
    """
    below = fails(low)
    if fails(high) == below:
        raise ValueError(f"threshold: no change between {low:g} and {high:g}")
    lower, upper = log(low), log(high)
    while upper - lower > share:
        middle = (lower + upper) / 2
        lower, upper = (middle, upper) if fails(exp(middle)) == below else (lower, middle)
    return exp((lower + upper) / 2)
