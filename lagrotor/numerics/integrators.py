"""The solvers behind `integrate`: each takes a stretch without an edge and a local error, and gives the states asked for.

All raise StopError when they cannot go on or crawl.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError

Array = NDArray[np.float64]
Rate = Callable[[float, Array], list[float]]
Projection = Callable[[Array], Array]

LOST = ValueError, ZeroDivisionError, OverflowError  # what a rate in Python meets outside its coordinates' reach
_A_CUT = 5_000  # evaluations between two projections, beyond which something else than the motion is followed
_DRIFT = 200.0  # local errors that the constraints may gather between projections: what the run as a whole is asked for


@dataclass(frozen=True)
class Stretch:
    """y' = rate(s, y) from `start` at `left` to `right`, to be read at `asked`; no step over `longest`.

    `project` brings a state (d,), or states (d, n), back onto constraints; `allowance`: evaluations before it crawls.
    """

    rate: Rate
    start: Array
    left: float
    right: float
    asked: Array
    longest: float = np.inf
    allowance: float = np.inf
    project: Projection | None = None
    typical_rate: float = 0.0
    time_to_singular: Callable[[Array], float] | None = None

    @property
    def pace(self) -> float:
        """A rate of change (1/s) of the state at the start."""
        return float(np.abs(self.rate(self.left, self.start)).max() / (1 + np.abs(self.start).max()))

    def clear(self, y: Array) -> float:
        """The longest step from a state that does not pass a singular position."""
        return self.time_to_singular(y) / 2 if self.time_to_singular else np.inf


@dataclass(frozen=True)
class Run:
    """States (n, d) at the asked times, the state at the end, and evaluations spent."""

    states: Array
    end: Array
    evaluations: int


Engine = Callable[[Stretch, float], Run]


class StopError(IntegrationError):
    """A solver that stopped at the time `at` (in a solver: the segment's own time), for a reason."""

    def __init__(self, at: float, reason: str) -> None:
        super().__init__(
            f"the solver stopped near t = {at:.6g} s ({reason.rstrip('.')}): the motion reaches a singular position of these "
            "coordinates, or the tolerance is out of reach; try another model or a larger tol"
        )
        self.at, self.reason = at, reason


class OutsideError(StopError):
    """A run that left the range in which its right-hand side is well conditioned."""

    def __init__(self, at: float) -> None:
        super().__init__(at, "the coordinates become singular")


def lsoda(stretch: Stretch, error: float) -> Run:
    """Adams and BDF methods of variable order (Petzold 1983) in scipy's compiled loop: only the rate is Python.

    The first step is given, not found from the first output, so outputs do not change the run. Where there are
    constraints the run is cut about once a turn and projected: the drift feeds on itself where the axes are pressed.
    """
    if stretch.project is None:
        return _lsoda(stretch, error)
    found, spent, left, y, longest_cut = [], 0, stretch.left, stretch.start, np.inf
    while left < stretch.right:
        cut = min(5 / (replace(stretch, left=left, start=y).pace + 1e-300), longest_cut, stretch.clear(y))
        right = left + cut if left + 1.5 * cut < stretch.right else stretch.right
        # A state with constraints moves no more than a fifth in a step, so that none leaps over where they fail.
        longest = min(stretch.longest, cut / 25)
        part = replace(stretch, start=y, left=left, right=right, longest=longest)
        try:
            part, run = _up_to_singular(part, min(stretch.allowance - spent, _A_CUT), error)
            end, spent = stretch.project(run.end), spent + run.evaluations + 1
            drifted = np.abs(end - run.end).max() / (1 + np.abs(end).max())
        except StopError:
            if cut < longest_cut / 2 or spent + _A_CUT > stretch.allowance:
                raise
            drifted, spent = np.inf, spent + _A_CUT
        if not drifted <= _DRIFT * error:  # what has grown so far would not be brought back to where it left
            longest_cut = cut / 8
            if longest_cut < 1e-6 * (stretch.right - stretch.left):
                raise StopError(left, "the constraints drift faster than they can be kept")
            continue
        found.append(run.states)
        y, left = end, part.right
    states = stretch.project(np.concatenate(found).T).T
    if not np.isfinite(states).all():
        raise StopError(stretch.left, "a state could not be brought back onto its constraints")
    return Run(states, y, spent)


def _up_to_singular(part: Stretch, allowance: float, error: float) -> tuple[Stretch, Run]:
    """The part of a run, or what of it comes before its steps might pass a singular position, with the states asked for."""
    inside = (part.asked > part.left) & (part.asked <= part.right)
    if part.time_to_singular is None:
        return part, _lsoda(replace(part, asked=part.asked[inside], allowance=allowance), error)
    watched = np.linspace(part.left, part.right, 66)[1:-1]
    asked = np.union1d(part.asked[inside], watched)
    run = _lsoda(replace(part, asked=asked, allowance=allowance), error)
    for s, y in zip(asked, run.states, strict=True):
        if s < part.right and part.clear(y) < part.longest and s - part.left > part.longest:
            shorter = replace(part, right=float(s), longest=min(part.longest, (s - part.left) / 25))
            inside = (part.asked > part.left) & (part.asked <= s)
            again = _lsoda(replace(shorter, asked=part.asked[inside], allowance=allowance), error)
            return shorter, replace(again, evaluations=again.evaluations + run.evaluations)
    return part, replace(run, states=run.states[np.searchsorted(asked, part.asked[inside])])


def _lsoda(stretch: Stretch, error: float) -> Run:
    from scipy.integrate import odeint

    left, right, lost = stretch.left, stretch.right, False

    def watched(s: float, y: Array) -> list[float]:
        # LSODA takes a rate of NaN for a number and may step over where it came from; DOP853 then has to try.
        nonlocal lost
        rates = stretch.rate(s, y)
        lost = lost or rates[0] != rates[0]
        return rates

    first = min(np.sqrt(error) / (1 + np.abs(stretch.rate(left, stretch.start)).max()), stretch.longest, right - left)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            states, log = odeint(
                getattr(stretch.rate, "bare", watched),
                stretch.start,
                np.concatenate([[left], stretch.asked, [right]]),
                tfirst=True,
                rtol=error,
                atol=error,
                full_output=True,
                h0=first,
                hmax=0.0 if np.isinf(stretch.longest) else stretch.longest,
                mxstep=int(min(stretch.allowance, 2**30)) + 1,
            )
    except LOST:
        raise StopError(left, "a rate was not finite") from None
    spent = int(log["nfe"][-1]) + 1
    if lost or log["message"] != "Integration successful." or not np.isfinite(states).all():
        raise StopError(left, "a rate was not finite" if lost else log["message"])
    if spent > stretch.allowance:
        raise StopError(right, f"{spent} evaluations spent")
    return Run(states[1:-1], states[-1], spent)


def dop853(stretch: Stretch, error: float) -> Run:
    """DOP853 (Hairer, Nørsett & Wanner, II.5), step by step: slow in Python, but it says where it stops."""
    from scipy.integrate import DOP853

    asked, project = stretch.asked, stretch.project
    solver = DOP853(
        stretch.rate,
        stretch.left,
        stretch.start,
        stretch.right,
        rtol=max(error, 2.3e-14),
        atol=error,
        max_step=stretch.longest,
    )
    found, done = np.empty((len(asked), len(stretch.start))), 0
    while solver.status == "running":
        if project is not None:  # no step over where the constraints fail
            solver.max_step = min(
                stretch.longest,
                0.1 * (1 + np.abs(solver.y).max()) / (np.abs(solver.f).max() + 1e-300),
                stretch.clear(solver.y),
            )
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise StopError(solver.t, message or "a value is not finite")
        if solver.nfev > stretch.allowance:
            raise StopError(solver.t, f"{solver.nfev} evaluations spent")
        reached = int(np.searchsorted(asked, solver.t, side="right"))
        if reached > done:
            found[done:reached] = solver.dense_output()(asked[done:reached]).T
            done = reached
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(stretch.rate(solver.t, solver.y))
            solver.nfev += 1
    return Run(project(found.T).T if project else found, solver.y, solver.nfev)
