"""A segment of a run without an edge of a pulse inside, as a solver is given it, and the states that it returns."""

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
    """y' = rhs(s, y) from `start` at `left` to `right`, read at `t_eval` within; no step is longer than `longest`.

    `project` brings a state (d,), or states (d, n), back onto constraints; `budget`: evaluations after which the solver
    stops; no step is longer than half of `time_to_singular` of the state where it begins.
    """

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
        """Largest component of y' over 1 + that of y, at the start (1/s)."""
        return float(np.abs(self.rhs(self.begin, self.start)).max() / (1 + np.abs(self.start).max()))

    def clear(self, y: Array) -> float:
        """The longest step from a state that does not pass a singular position."""
        return self.time_to_singular(y) / 2 if self.time_to_singular else np.inf


@dataclass(frozen=True, eq=False)
class Stretch:
    """States (n, d) at the first n of the times of a stretch of motion, all of them if its end was reached; the last state;
    evaluations. jumps: times within at which an event changed the state.
    """

    states: Array
    end: Array
    evaluations: int
    jumps: tuple[float, ...] = ()

    def cut(self, d: int) -> "Stretch":
        """The stretch in the first d components."""
        return replace(self, states=self.states[:, :d], end=self.end[:d])


SegmentSolver = Callable[[Segment, bool, float], Stretch]  # a segment, whether within a pulse, a local error
Integrate = Callable[[Array, Array, float, bool, float], Stretch]  # start, times, local error, companion, budget
Cause = Literal["budget", "singular", "event", "stopped"]
_WAYS_OUT = {
    "budget": "take a larger tol or a shorter run",
    "singular": "the motion has a singular position there; end the run before, or describe it by other coordinates",
    "event": "",
    "stopped": "no step can be taken from there with this tolerance; end the run before, or take another tol",
}


def reporting(rate: RightHandSide, progress: Callable[[float], None] | None, at: float) -> RightHandSide:
    """The right-hand side that calls `progress`, if it is one, with each time `at` + s at which it is evaluated."""
    if progress is None:
        return rate

    def reported(s: float, y: Array) -> list[float]:
        progress(s + at)
        return rate(s, y)

    if bare := getattr(rate, "bare", None):
        reported.bare = reporting(bare, progress, at)  # type: ignore[attr-defined]
    return reported


def in_units(segment: Segment, scale: Array) -> Segment:
    """The segment for the state z, y = scale z."""
    project = segment.project
    onto = None if project is None else lambda z: (project((z.T * scale).T).T / scale).T
    return replace(segment, rhs=_scaled_rhs(segment.rhs, scale), start=segment.start / scale, project=onto)


def _scaled_rhs(bare: RightHandSide, scale: Array) -> RightHandSide:
    """The right-hand side for the state z, y = scale z."""
    if (scale == 1).all():
        return bare

    def rate(s: float, z: Array) -> Any:
        return (np.asarray(bare(s, z * scale)) / scale).tolist()

    if inner := getattr(bare, "bare", None):
        rate.bare = _scaled_rhs(inner, scale)  # type: ignore[attr-defined]
    return rate


def by_units(solve: SegmentSolver, scale: Array) -> SegmentSolver:
    """The solver, given each component of a segment's state over its scale (d,)."""

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
    """States (n, d), brought back onto their constraints."""
    return project(states.T).T if project and len(states) else states


class StopError(IntegrationError):
    """A solver that stopped at the time `at` (in a solver: the segment's own time), for a reason.

    cause: its evaluations are spent (budget), a singular position was measured, an event ends the run, or it cannot go on and
    the reason is all that is known. reached: the motion up to there, with its last state; evaluations: those spent.
    """

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
    """A run that left the range in which its right-hand side is well conditioned."""

    def __init__(self, at: float) -> None:
        super().__init__(at, "the coordinates become singular", cause="singular")
