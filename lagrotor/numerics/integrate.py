"""One door to scipy's initial value solvers, which never steps over a pulse."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.numerics.adams import adams
from lagrotor.numerics.integrators import OutsideError, Run, StopError, Stretch, dop853, lsoda
from lagrotor.numerics.integrators import Projection as Projection
from lagrotor.numerics.integrators import Rate as Rate
from lagrotor.numerics.pulse import segments

Array = NDArray[np.float64]

TIGHTEST = 1e-13
# LSODA leaves up to 200 times the error it is asked for, and cannot be asked for much less than 1e-13. 10 s of the
# displaced pair: an error of 1e-10 takes it 9 ms, Adams of order 12 11 ms, DOP853 in Python 60; one of 1e-13 only Adams
# reaches, in 16 ms.
CROSSOVER = 5e-11


@dataclass(frozen=True)
class Problem:
    """y' = free(s, y), or driven(s, y) within the pulse centred `at` with `width`; y = start at t = 0; s = t − at.

    `project` brings a state (d,), or states (d, n), back onto their constraints; `allowance` is how many evaluations the
    run may take before it is said to crawl; `typical_rate`, in rad/s, bounds the first step;
    no step is longer than half of `time_to_singular` of the state where it begins.
    """

    free: Rate
    start: Array
    allowance: float
    driven: Rate | None = None
    at: float = 0.0
    width: float = 0.0
    project: Projection | None = None
    typical_rate: float = 0.0
    time_to_singular: Callable[[Array], float] | None = None


@dataclass(frozen=True)
class Solution:
    """States (n, d) at the asked times, and how often the right-hand side was evaluated."""

    states: Array
    evaluations: int


def check_tolerance(tol: float) -> float:
    """`tol` as a float, refused outside [1e-13, 0.1]."""
    if not (isinstance(tol, int | float) and TIGHTEST <= tol <= 0.1):
        raise InputError(f"simulate: tol = {tol!r} must lie between {TIGHTEST:g}, what doubles can carry, and 0.1")
    return float(tol)


def integrate(problem: Problem, times: Array, tol: float) -> Solution:
    """Integrate from t = 0 through `times` (increasing, not negative); states (n, d) there.

    In the time s = t − at a pulse far shorter than the spacing of doubles near `at` is still resolved. The run is cut
    at the pulse's edges, s = ± 6.5 width; within them no step is longer than `width`, so no tolerance can miss it.

    Raises StopError, an IntegrationError with the time, when the solver cannot go on, or crawls.
    """
    asked = times - problem.at
    begin, end = -problem.at, float(asked[-1])
    states = np.empty((len(times), len(problem.start)))
    states[asked == begin] = problem.start
    y, evaluations = problem.start, 0
    for left, right, pulsed in segments(begin, end, problem.width if problem.driven else 0.0):
        if right > left:
            inside = (asked > left) & (asked <= right)
            try:
                run = _run(problem, pulsed, y, left, right, asked[inside], tol, evaluations)
            except StopError as stopped:
                raise StopError(problem.at + stopped.at, stopped.reason) from None
            states[inside], y = run.states, run.end
            evaluations += run.evaluations
    return Solution(states, evaluations)


def _run(
    problem: Problem, pulsed: bool, y: Array, left: float, right: float, asked: Array, tol: float, spent: int
) -> Run:
    """One stretch without an edge inside, by the engine that is fastest at this tolerance.

    Where that engine stops, DOP853 tries again in its own steps, and says where it stops if it does.
    """
    rate = problem.driven if pulsed and problem.driven else problem.free
    # From a rate that is not finite a solver makes a step that is not, and retries it for ever.
    if not np.isfinite(rate(left, y)).all():
        raise StopError(left, "the right-hand side is not finite")
    longest, allowance = problem.width if pulsed else np.inf, problem.allowance - spent
    stretch = Stretch(
        rate, y, left, right, asked, longest, allowance, problem.project, problem.typical_rate, problem.time_to_singular
    )
    try:
        if tol >= CROSSOVER:
            return lsoda(stretch, min(tol / 200, 1e-6 if pulsed else np.inf))
        if pulsed:
            return dop853(stretch, tol / 20)
        # Where equal steps do not pay, Adams is given up soon and DOP853 takes its own steps.
        return adams(replace(stretch, allowance=min(allowance, 5_000 + 0.15 * allowance)), tol)
    except OutsideError:
        raise
    except StopError:
        return dop853(stretch, tol / 20)
