"""One door to scipy's initial value solvers, which never steps over a pulse."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, IntegrationError

Array = NDArray[np.float64]
Rate = Callable[[float, Array], list[float]]
Projection = Callable[[Array], Array]

# A Gaussian pulse exp(−s²) is below the last bit of its peak beyond |s| = 6.5: exp(−6.5²) = 4e-19.
PULSE_REACH = 6.5
TIGHTEST = 1e-13


@dataclass(frozen=True)
class Problem:
    """y' = free(s, y), or driven(s, y) within the pulse centred `at` with `width`; y = start at t = 0; s = t − at.

    `project` brings a state back onto its constraints; `allowance` is how many evaluations the run may take before it
    is said to crawl.
    """

    free: Rate
    start: Array
    allowance: float
    driven: Rate | None = None
    at: float = 0.0
    width: float = 0.0
    project: Projection | None = None


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
    DOP853 (Hairer, Nørsett & Wanner, II.5) with a local error of tol / 20, which leaves `tol` for what a run gathers.

    Raises IntegrationError when the solver cannot go on, or crawls.
    """
    asked = times - problem.at
    begin, end, reach = -problem.at, float(asked[-1]), PULSE_REACH * problem.width
    edges = [begin, end]
    if problem.driven is not None:
        edges += [s for s in (-reach, reach) if begin < s < end]
    edges.sort()
    states = np.empty((len(times), len(problem.start)))
    states[asked == begin] = problem.start
    y, evaluations = problem.start, 0
    for left, right in pairwise(edges):
        if right > left:
            inside = (asked > left) & (asked <= right)
            pulsed = problem.driven is not None and abs(left + right) / 2 < reach
            states[inside], y, used = _stretch(problem, pulsed, y, left, right, asked[inside], tol / 20, evaluations)
            evaluations += used
    return Solution(states, evaluations)


def _stretch(
    problem: Problem, pulsed: bool, y: Array, left: float, right: float, asked: Array, error: float, spent: int
) -> tuple[Array, Array, int]:
    """One stretch without an edge inside: states at `asked`, the last state, evaluations."""
    from scipy.integrate import DOP853

    rate = problem.driven if pulsed and problem.driven else problem.free
    longest = problem.width if pulsed else np.inf
    # From a rate that is not finite scipy makes a step that is not, and retries it for ever.
    if not np.isfinite(rate(left, y)).all():
        raise IntegrationError(_stopped(problem.at + left, "the rate is not finite"))
    solver = DOP853(rate, left, y, right, rtol=max(error, 2.3e-14), atol=error, max_step=longest)
    found, done = np.empty((len(asked), len(y))), 0
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise IntegrationError(_stopped(problem.at + solver.t, message or "a value is not finite"))
        if spent + solver.nfev > problem.allowance:
            raise IntegrationError(_stopped(problem.at + solver.t, f"{spent + solver.nfev} evaluations spent"))
        reached = int(np.searchsorted(asked, solver.t, side="right"))
        if reached > done:
            found[done:reached] = solver.dense_output()(asked[done:reached]).T
            done = reached
        if problem.project is not None:
            solver.y = problem.project(solver.y)
            solver.f = np.asarray(rate(solver.t, solver.y))
            solver.nfev += 1
    if problem.project is not None and done:
        found = np.array([problem.project(row) for row in found])
    return found, solver.y, solver.nfev


def _stopped(t: float, reason: str) -> str:
    return (
        f"the solver stopped near t = {t:.6g} s ({reason.rstrip('.')}): the motion reaches a singular position of these "
        "coordinates, or the tolerance is out of reach; try another model or a larger tol"
    )
