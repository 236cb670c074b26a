"""DOP853 (Hairer, Nørsett & Wanner, II.5), step by step: slow in Python, but it follows any motion and says where it stops."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from lagrotor.numerics.segment import Segment, StopError, Stretch, states_on_constraints

_TURN = 0.5  # of a state with constraints, in a step, where a solver may be far from where the constraints fail
_PATIENCE = 5_000  # evaluations before they are weighed against the share of the segment that is done
_FIRST = 1e-6  # of a segment: the first step, where the one that is tried leaves the range of the right-hand side
_LEAST_RELATIVE = 2.3e-14  # scipy's solvers take no smaller relative tolerance


def dop853_steps(segment: Segment, error: float, first: float = 1.0) -> Iterator[Any]:
    """scipy's solver after each step at a local error `error`, relative and absolute: its t_old, t, y and dense_output().

    first: the first step over the one that scipy would take. A state is brought back onto constraints before the next step.
    Raises StopError where it stops.
    """
    from scipy.integrate import DOP853

    project = segment.project
    with np.errstate(divide="ignore", invalid="ignore"):  # of its first step, where values are not finite
        solver = DOP853(
            segment.rhs,
            segment.left,
            segment.start,
            segment.right,
            rtol=max(error, _LEAST_RELATIVE),
            atol=error,
            max_step=segment.longest,
        )
    if not np.isfinite(solver.f).all():
        raise StopError(segment.left, "the right-hand side is not finite", evaluations=solver.nfev)
    if not np.isfinite(solver.h_abs):  # the first step, which scipy would take for ever
        solver.h_abs = _FIRST * (segment.right - segment.left)
    solver.h_abs *= first
    while solver.status == "running":
        if project is not None:  # no step over where the constraints fail
            turned = _TURN * (1 + np.abs(solver.y).max()) / (np.abs(solver.f).max() + 1e-300)
            solver.max_step = min(segment.longest, turned, segment.clear(solver.y))
        t, y = solver.t, solver.y
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            reached = Stretch(np.empty((0, len(y))), y, solver.nfev)
            raise StopError(t, message or "a value is not finite", reached)
        yield solver
        share = (solver.t - segment.left) / (segment.right - segment.left)
        if solver.status == "running" and solver.nfev > min(segment.budget, _PATIENCE + share * segment.budget):
            reached = Stretch(np.empty((0, len(y))), solver.y, solver.nfev)
            raise StopError(solver.t, f"{solver.nfev} evaluations spent", reached, cause="budget")
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(segment.rhs(solver.t, solver.y))
            solver.nfev += 1


def dop853(segment: Segment, error: float) -> Stretch:
    """The segment at a local error `error`, relative and absolute. Raises StopError with what was reached."""
    t_eval = segment.t_eval
    states, done, solver = np.empty((len(t_eval), len(segment.start))), 0, None
    try:
        for solver in dop853_steps(segment, error):
            reached = int(np.searchsorted(t_eval, solver.t, side="right"))
            if reached > done:
                states[done:reached] = solver.dense_output()(t_eval[done:reached]).T
                done = reached
    except StopError as stop:
        end = stop.reached.end if stop.reached else segment.start
        part = Stretch(states_on_constraints(segment.project, states[:done]), end, stop.evaluations)
        raise StopError(stop.at, stop.reason, part, cause=stop.cause) from None
    assert solver is not None  # a segment has a length
    return Stretch(states_on_constraints(segment.project, states[:done]), solver.y, solver.nfev)
