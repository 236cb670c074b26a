"""States of an initial value problem at any times, by the solver that is fastest at the tolerance."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.pulse import Window, segments
from lagrotor.numerics.segment import (
    Array,
    OutsideError,
    Projection,
    RightHandSide,
    Segment,
    SegmentSolver,
    StopError,
    Stretch,
)
from lagrotor.numerics.solver_constants import CROSSOVER, DETOUR, LSODA_SAFETY
from lagrotor.numerics.solvers import adams, dop853, lsoda

TIGHTEST = 1e-13
_IN_PULSE = 1e-7  # local error of LSODA in a pulse above which it is proportional to the root of the tolerance
Engine = Literal["core", "fast"]


@dataclass(frozen=True)
class Problem:
    """The initial value problem y' = free(s, y) with s = t − at, and y = start at t = `begin`. Within the windows, driven(s, y)
    takes the place of free(s, y)."""

    free: RightHandSide
    start: Array
    budget: float  # evaluations after which the run stops
    driven: RightHandSide | None = None
    at: float = 0.0
    windows: tuple[Window, ...] = ()  # of s, in order, in which something acts briefly and steps are bounded
    project: Projection | None = None  # brings a state (d,), or states (d, n), back onto their constraints
    typical_rate: float = 0.0  # in rad/s; it bounds the first step
    time_to_singular: Callable[[Array], float] | None = None  # of a state, in s; no step is longer than half of it
    begin: float = 0.0


def check_tolerance(tol: float, caller: str = "simulate") -> float:
    """Return `tol` as a float, or raise InputError outside [1e-13, 0.1]."""
    if not (isinstance(tol, int | float | np.floating) and TIGHTEST <= tol <= 0.1):
        raise InputError(f"{caller}: tol = {tol!r} must lie between {TIGHTEST:g}, the limit of doubles, and 0.1")
    return float(tol)


def check_engine(engine: str, caller: str = "simulate") -> None:
    """Raise InputError for an engine other than "core" and "fast"."""
    if engine not in ("core", "fast"):
        raise InputError(f"{caller}: engine = {engine!r} is neither core nor fast")


def check_progress(progress: object) -> None:
    """Raise InputError for an object that is neither a function nor None."""
    if progress is not None and not callable(progress):
        raise InputError(f"simulate: progress = {progress!r} must be a function of the time (s), or None")


def integrate(problem: Problem, times: Array, tol: float, solver: SegmentSolver | None = None) -> Stretch:
    """Integrate from `begin` through increasing times (n,) in s with the local error `tol`, by the given solver or the fastest
    one of the core. In the time s = t − at, a pulse far shorter than the spacing of doubles near `at` is resolved. The run is cut
    at the edges of its windows, so that no tolerance can miss a brief force. A StopError holds the states up to the stop."""
    t_eval = times - problem.at
    begin, end = problem.begin - problem.at, float(t_eval[-1])
    y, evaluations = problem.start, 0
    pieces = [np.repeat(y[None], np.count_nonzero(t_eval == begin), axis=0)]
    for lower, until, longest in segments(begin, end, problem.windows):
        if until > lower:
            pulsed = longest < np.inf
            segment = Segment(
                problem.driven if pulsed and problem.driven else problem.free,
                y,
                lower,
                until,
                t_eval[(t_eval > lower) & (t_eval <= until)],
                longest,
                problem.budget - evaluations,
                problem.project,
                problem.typical_rate,
                problem.time_to_singular,
            )
            try:
                stretch = (solver or by_fastest)(segment, pulsed, tol)
            except StopError as stop:
                evaluations += stop.evaluations
                reached = stop.reached or Stretch(np.empty((0, len(y))), y, 0)
                so_far = Stretch(np.concatenate([*pieces, reached.states]), reached.end, evaluations)
                raise StopError(problem.at + stop.at, stop.reason, so_far, evaluations, stop.cause) from None
            pieces.append(stretch.states)
            y, evaluations = stretch.end, evaluations + stretch.evaluations
    return Stretch(np.concatenate(pieces), y, evaluations)


class _Progress:
    """The part of a segment that is solved so far, and in `segment` the part that remains."""

    def __init__(self, segment: Segment) -> None:
        self.segment, self.evaluations, self.pieces = segment, 0, [np.empty((0, len(segment.start)))]

    def remaining(self, until: float) -> Segment:
        """Return the rest of the segment up to the time `until`, or raise StopError if its budget is spent."""
        segment = self.segment
        if self.evaluations > segment.budget:
            raise self.stopped(
                StopError(segment.begin, f"the run did not end within {self.evaluations} evaluations", cause="budget")
            )
        inside = segment.t_eval <= until
        return replace(segment, until=until, t_eval=segment.t_eval[inside], budget=segment.budget - self.evaluations)

    def add(self, at: float, stretch: Stretch) -> None:
        """Append the states up to the time `at`, without their evaluations."""
        self.pieces.append(stretch.states)
        self.segment = replace(
            self.segment, start=stretch.end, begin=at, t_eval=self.segment.t_eval[len(stretch.states) :]
        )

    def result(self) -> Stretch:
        return Stretch(np.concatenate(self.pieces), self.segment.start, self.evaluations)

    def stopped(self, stop: StopError) -> StopError:
        """Return a StopError with all states and evaluations of the segment, for a stop in its last part."""
        self.evaluations += stop.evaluations
        if stop.reached:
            self.add(stop.at, stop.reached)
        at = stop.at if isinstance(stop, OutsideError) else self.segment.begin
        return StopError(at, stop.reason, self.result(), cause=stop.cause)


def by_fastest(segment: Segment, pulsed: bool, tol: float) -> Stretch:
    """Solve a segment by the fastest solver at this tolerance; if that solver stops, DOP853 continues for a while. The fast
    solver is tried again when DOP853 has taken as many evaluations as the last trial lost. So all trials but the last lose
    together no more evaluations than DOP853 takes."""
    # From a rate that is not finite a solver makes a step that is not finite, and repeats it for ever.
    by_dop853, progress = pulsed and tol < CROSSOVER.value, _Progress(segment)
    progress.evaluations = 1
    if not np.isfinite(segment.rhs(segment.begin, segment.start)).all():
        raise StopError(segment.begin, "the right-hand side is not finite", evaluations=1)
    detour = DETOUR.value / segment.typical_rate if segment.typical_rate and not by_dop853 else np.inf
    # Evaluations and time of the last trial of the fast solver; evaluations of DOP853 since then, and per second.
    trial_cost, trial_progress, since, per_time = 0, 0.0, np.inf, np.inf
    while (now := progress.segment.begin) < segment.until:
        lost_cost = trial_cost - per_time * trial_progress if trial_progress else trial_cost
        if not by_dop853 and since >= lost_cost and per_time * (segment.until - now) > lost_cost:
            try:
                run = _fastest(progress.remaining(segment.until), pulsed, tol)
                progress.evaluations += run.evaluations
                progress.add(segment.until, run)
                break
            except StopError as stop:
                if isinstance(stop, OutsideError):
                    raise progress.stopped(stop) from None
                progress.stopped(stop)
                trial_cost, trial_progress, since = stop.evaluations, progress.segment.begin - now, 0
        now = progress.segment.begin
        until = min(now + detour, segment.until)
        detour_segment = progress.remaining(until)
        try:
            run = dop853(detour_segment, tol / 20)
        except StopError as stop:
            raise progress.stopped(stop) from None
        per_time, since = run.evaluations / (until - now), since + run.evaluations
        progress.evaluations += run.evaluations
        progress.add(until, run)
    return progress.result()


def _fastest(segment: Segment, pulsed: bool, tol: float) -> Stretch:
    if tol >= CROSSOVER.value:
        error = tol / LSODA_SAFETY.value
        # In a pulse the error is small and differs between tolerances, or the two compared runs would agree and be wrong.
        return lsoda(segment, min(error, (_IN_PULSE * error) ** 0.5) if pulsed else error)
    # A small budget, so that a motion for which equal steps are too costly soon gets another solver.
    return adams(replace(segment, budget=min(segment.budget, 5_000 + 0.15 * segment.budget)), tol)
