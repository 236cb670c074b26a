"""A segment of a run, inside which no window of a pulse begins or ends: the input of a solver, and the states that it returns."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from lagrotor.errors import IntegrationError
from lagrotor.numerics.arrays import Array as Array

RightHandSide = Callable[[float, Array], list[float]]
Projection = Callable[[Array], Array]

LOST = ValueError, ZeroDivisionError, OverflowError  # raised by arithmetic outside the range of the coordinates


@dataclass(frozen=True)
class Segment:
    """The problem y' = rhs(s, y) from the state `start` at the time `begin` to `until`, with states at the times `t_eval`. No
    step is longer than `longest`, or than half the time from its first state to a singular position. The function `project`
    brings a state (d,), or states (d, n), back onto the constraints. The solver stops after `budget` evaluations. The typical
    rate in rad/s bounds the first step."""

    rhs: RightHandSide
    start: Array
    begin: float
    until: float
    t_eval: Array
    longest: float = np.inf
    budget: float = np.inf
    project: Projection | None = None
    typical_rate: float = 0.0
    time_to_singular: Callable[[Array], float] | None = None

    @property
    def relative_speed(self) -> float:
        """The rate of change of the state at the start in 1/s, max |y'| / (1 + max |y|)."""
        return float(np.abs(self.rhs(self.begin, self.start)).max() / (1 + np.abs(self.start).max()))

    def clear(self, y: Array) -> float:
        """Return the longest step in s from a state y that cannot pass a singular position; inf if there is none."""
        return self.time_to_singular(y) / 2 if self.time_to_singular else np.inf


@dataclass(frozen=True, eq=False)
class Stretch:
    """A motion computed by a solver: states (n, d) at the first n of the requested times, the last state (d,) and the number of
    evaluations. All times are reached unless the solver stopped. At the times `jumps` an event changed the state."""

    states: Array
    end: Array
    evaluations: int
    jumps: tuple[float, ...] = ()

    def cut(self, d: int) -> "Stretch":
        return replace(self, states=self.states[:, :d], end=self.end[:d])


SegmentSolver = Callable[[Segment, bool, float], Stretch]  # a segment, True in a pulse, a local error
Integrate = Callable[[Array, Array, float, bool, float], Stretch]  # start, times, local error, companion, budget
Cause = Literal["budget", "singular", "event", "stopped"]
_WAYS_OUT = {
    "budget": "take a larger tol or a shorter run",
    "singular": "the motion has a singular position there; end the run before, or describe it by other coordinates",
    "event": "",
    "stopped": "no step can be taken from there with this tolerance; end the run before, or take another tol",
}


def reporting(rate: RightHandSide, progress: Callable[[float], None] | None, at: float) -> RightHandSide:
    """Return a right-hand side that also calls `progress` with the time at + s of each evaluation."""
    if progress is None:
        return rate

    def reported(s: float, y: Array) -> list[float]:
        progress(s + at)
        return rate(s, y)

    if bare := getattr(rate, "bare", None):
        reported.bare = reporting(bare, progress, at)  # type: ignore[attr-defined]
    return reported


def in_units(segment: Segment, scale: Array) -> Segment:
    """Return the segment for the state z = y / scale, with a scale (d,) for each component."""
    project = segment.project
    onto = None if project is None else lambda z: (project((z.T * scale).T).T / scale).T
    return replace(segment, rhs=_scaled_rhs(segment.rhs, scale), start=segment.start / scale, project=onto)


def _scaled_rhs(bare: RightHandSide, scale: Array) -> RightHandSide:
    """Return the right-hand side for the state z = y / scale."""
    if (scale == 1).all():
        return bare

    def rate(s: float, z: Array) -> Any:
        return (np.asarray(bare(s, z * scale)) / scale).tolist()

    if inner := getattr(bare, "bare", None):
        rate.bare = _scaled_rhs(inner, scale)  # type: ignore[attr-defined]
    return rate


def by_units(solve: SegmentSolver, scale: Array) -> SegmentSolver:
    """Return a solver that solves a segment in units of `scale` (d,) and returns its states in the original units."""

    def to_units(stretch: Stretch) -> Stretch:
        return replace(stretch, states=stretch.states * scale, end=stretch.end * scale)

    def scaled(segment: Segment, pulsed: bool, local: float) -> Stretch:
        try:
            return to_units(solve(in_units(segment, scale), pulsed, local))
        except StopError as stop:
            stop.reached = stop.reached and to_units(stop.reached)
            raise

    return scaled


def states_on_constraints(project: Projection | None, states: Array) -> Array:
    """Return the states (n, d) projected back onto their constraints; without a projection return them unchanged."""
    return project(states.T).T if project and len(states) else states


class StopError(IntegrationError):
    """A solver stopped at the time `at` in s; within a solver this is the segment's own time. There are four causes: budget (the
    evaluations are spent), singular (a singular position was measured), event (an event ends the run), and stopped. In the last
    case the solver cannot continue and gives only its reason. `reached` is the motion up to the stop, with its last state."""

    def __init__(
        self,
        at: float,
        reason: str,
        reached: Stretch | None = None,
        evaluations: int = 0,
        cause: Cause = "stopped",
    ) -> None:
        super().__init__(f"the solver stopped near t = {at:.6g} s ({reason.rstrip('.')}): {_WAYS_OUT[cause]}")
        self.at, self.reason, self.reached, self.cause = at, reason, reached, cause
        self.evaluations = max(evaluations, reached.evaluations if reached else 0)


class OutsideError(StopError):
    """The state left the range in which the right-hand side is well conditioned."""

    def __init__(self, at: float) -> None:
        super().__init__(at, "the coordinates become singular", cause="singular")
