"""A segment of a run without an edge of a pulse inside, as a solver is given it, and the states that it returns."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError

Array = NDArray[np.float64]
RightHandSide = Callable[[float, Array], list[float]]
Projection = Callable[[Array], Array]

LOST = ValueError, ZeroDivisionError, OverflowError  # raised by arithmetic outside the range of the coordinates


@dataclass(frozen=True)
class Segment:
    """y' = rhs(s, y) from `start` at `left` to `right`, read at `t_eval` within; no step is longer than `longest`.

    `project` brings a state (d,), or states (d, n), back onto constraints; `max_nfev`: evaluations after which the solver
    stops; no step is longer than half of `time_to_singular` of the state where it begins.
    """

    rhs: RightHandSide
    start: Array
    left: float
    right: float
    t_eval: Array
    longest: float = np.inf
    max_nfev: float = np.inf
    project: Projection | None = None
    typical_rate: float = 0.0
    time_to_singular: Callable[[Array], float] | None = None

    @property
    def relative_speed(self) -> float:
        """Largest component of y' over 1 + that of y, at the start (1/s)."""
        return float(np.abs(self.rhs(self.left, self.start)).max() / (1 + np.abs(self.start).max()))

    def clear(self, y: Array) -> float:
        """The longest step from a state that does not pass a singular position."""
        return self.time_to_singular(y) / 2 if self.time_to_singular else np.inf


@dataclass(frozen=True)
class Run:
    """States (n, d) at the first n of `t_eval`, all of them if the end was reached; the last state; evaluations."""

    states: Array
    end: Array
    nfev: int


Engine = Callable[[Segment, float], Run]


class StopError(IntegrationError):
    """A solver that stopped at the time `at` (in a solver: the segment's own time), for a reason.

    reached: the run up to there, where the solver can go on from it; nfev: evaluations spent.
    """

    def __init__(self, at: float, reason: str, reached: Run | None = None, nfev: int = 0) -> None:
        super().__init__(
            f"the solver stopped near t = {at:.6g} s ({reason.rstrip('.')}): the motion reaches a singular position of these "
            "coordinates, or the tolerance is out of reach; try another model or a larger tol"
        )
        self.at, self.reason, self.reached, self.nfev = at, reason, reached, reached.nfev if reached else nfev


class OutsideError(StopError):
    """A run that left the range in which its right-hand side is well conditioned."""

    def __init__(self, at: float) -> None:
        super().__init__(at, "the coordinates become singular")
