"""States of an initial value problem at any times: the solver that is fastest at the tolerance, never over a pulse."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.adams import adams
from lagrotor.numerics.dop853 import dop853
from lagrotor.numerics.lsoda import lsoda
from lagrotor.numerics.pulse import segments
from lagrotor.numerics.segment import Array, OutsideError, Projection, RightHandSide, Run, Segment, StopError
from lagrotor.numerics.solver_constants import CROSSOVER, DETOUR, LSODA_SAFETY

TIGHTEST = 1e-13
Engine = Literal["core", "fast"]


@dataclass(frozen=True)
class Problem:
    """y' = free(s, y), or driven(s, y) within the pulse centred `at` with `width`; y = start at t = 0; s = t − at.

    `project` brings a state (d,), or states (d, n), back onto their constraints; `max_nfev` is how many evaluations the
    run may take before it is stopped; `typical_rate`, in rad/s, bounds the first step;
    no step is longer than half of `time_to_singular` of the state where it begins.
    """

    free: RightHandSide
    start: Array
    max_nfev: float
    driven: RightHandSide | None = None
    at: float = 0.0
    width: float = 0.0
    project: Projection | None = None
    typical_rate: float = 0.0
    time_to_singular: Callable[[Array], float] | None = None


@dataclass(frozen=True)
class Solution:
    """States (n, d) at the times of the run, and how often the right-hand side was evaluated."""

    states: Array
    nfev: int


def check_tolerance(tol: float) -> float:
    """`tol` as a float, refused outside [1e-13, 0.1]."""
    if not (isinstance(tol, int | float | np.floating) and TIGHTEST <= tol <= 0.1):
        raise InputError(f"simulate: tol = {tol!r} must lie between {TIGHTEST:g}, what doubles can carry, and 0.1")
    return float(tol)


def check_engine(engine: str, caller: str = "simulate") -> None:
    """Raises InputError where it is neither "core" nor "fast"."""
    if engine not in ("core", "fast"):
        raise InputError(f"{caller}: engine = {engine!r} is neither core nor fast")


def integrate(problem: Problem, times: Array, tol: float) -> Solution:
    """Integrate from t = 0 through `times` (increasing, not negative); states (n, d) there.

    In the time s = t − at a pulse far shorter than the spacing of doubles near `at` is still resolved. The run is cut
    at the pulse's edges, s = ± 6.5 width; within them no step is longer than `width`, so no tolerance can miss it.

    Raises StopError, an IntegrationError with the time, when the solver cannot go on, or takes more than `max_nfev`.
    """
    t_eval = times - problem.at
    begin, end = -problem.at, float(t_eval[-1])
    states = np.empty((len(times), len(problem.start)))
    states[t_eval == begin] = problem.start
    y, nfev = problem.start, 0
    for left, right, pulsed in segments(begin, end, problem.width if problem.driven else 0.0):
        if right > left:
            inside = (t_eval > left) & (t_eval <= right)
            segment = Segment(
                problem.driven if pulsed and problem.driven else problem.free,
                y,
                left,
                right,
                t_eval[inside],
                problem.width if pulsed else np.inf,
                problem.max_nfev - nfev,
                problem.project,
                problem.typical_rate,
                problem.time_to_singular,
            )
            try:
                run = _run(segment, pulsed, tol)
            except StopError as stopped:
                raise StopError(problem.at + stopped.at, stopped.reason, nfev=nfev + stopped.nfev) from None
            states[inside], y = run.states, run.end
            nfev += run.nfev
            if nfev > problem.max_nfev:
                raise StopError(problem.at + right, f"{nfev} evaluations spent", nfev=nfev)
    return Solution(states, nfev)


def _run(segment: Segment, pulsed: bool, tol: float) -> Run:
    """A segment by the solver that is fastest at this tolerance; where that stops, DOP853 goes on for a while.

    The while is longer after each time that the solver took more evaluations than DOP853 does for as long a run.
    """
    # From a velocity that is not finite a solver makes a step that is not, and retries it for ever.
    if not np.isfinite(segment.rhs(segment.left, segment.start)).all():
        raise StopError(segment.left, "the right-hand side is not finite")
    if pulsed and tol < CROSSOVER:
        return dop853(segment, tol / 20)
    whole, nfev, found, per_time = segment.right - segment.left, 0, list[Array](), np.inf
    detour = DETOUR / segment.typical_rate if segment.typical_rate else whole
    while True:
        left = segment.left
        try:
            run = _fastest(replace(segment, max_nfev=segment.max_nfev - nfev), pulsed, tol)
            break
        except OutsideError:
            raise
        except StopError as stopped:
            nfev += stopped.nfev
            if stopped.reached:
                segment = _after(segment, stopped.at, stopped.reached, found)
                if stopped.nfev >= per_time * (stopped.at - left):
                    detour *= 4
            else:
                detour *= 4
        left, right = segment.left, min(segment.left + detour, segment.right)
        inside = segment.t_eval <= right
        part = replace(segment, right=right, t_eval=segment.t_eval[inside], max_nfev=segment.max_nfev - nfev)
        try:
            run = dop853(part, tol / 20)
        except StopError as stopped:
            raise StopError(stopped.at, stopped.reason, nfev=nfev + stopped.nfev) from None
        if right == segment.right:
            break
        per_time = run.nfev / (right - left)
        segment, nfev = _after(segment, right, run, found), nfev + run.nfev
    return Run(np.concatenate([*found, run.states]), run.end, nfev + run.nfev)


def _fastest(segment: Segment, pulsed: bool, tol: float) -> Run:
    if tol >= CROSSOVER:
        return lsoda(segment, min(tol / LSODA_SAFETY, 1e-6 if pulsed else np.inf))
    # Where equal steps do not pay, Adams is left soon.
    return adams(replace(segment, max_nfev=min(segment.max_nfev, 5_000 + 0.15 * segment.max_nfev)), tol)


def _after(segment: Segment, t: float, run: Run, found: list[Array]) -> Segment:
    """What is left of a segment after a run up to t, whose states are added to what was found."""
    found.append(run.states)
    return replace(segment, start=run.end, left=t, t_eval=segment.t_eval[len(run.states) :])
