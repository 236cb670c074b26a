"""DOP853 (Hairer, Nørsett & Wanner, II.5), step by step: slow in Python, but it follows any motion and says where it stops."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from lagrotor.numerics.segment import Run, Segment, StopError

_TURN = 0.5  # of a state with constraints, in a step, where a solver may be far from where the constraints fail
_PATIENCE = 5_000  # evaluations before they are weighed against the share of the segment that is done
_LEAST_RELATIVE = 2.3e-14  # scipy's solvers take no smaller relative tolerance


def dop853_steps(segment: Segment, error: float) -> Iterator[Any]:
    """scipy's solver after each step at a local error `error`, relative and absolute: its t_old, t, y and dense_output().

    A state is brought back onto constraints before the next step. Raises StopError where it stops.
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
    while solver.status == "running":
        if project is not None:  # no step over where the constraints fail
            turned = _TURN * (1 + np.abs(solver.y).max()) / (np.abs(solver.f).max() + 1e-300)
            solver.max_step = min(segment.longest, turned, segment.clear(solver.y))
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise StopError(solver.t, message or "a value is not finite", nfev=solver.nfev)
        share = (solver.t - segment.left) / (segment.right - segment.left)
        if solver.nfev > min(segment.max_nfev, _PATIENCE + share * segment.max_nfev):
            raise StopError(solver.t, f"{solver.nfev} evaluations spent", nfev=solver.nfev)
        yield solver
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(segment.rhs(solver.t, solver.y))
            solver.nfev += 1


def dop853(segment: Segment, error: float) -> Run:
    """The segment at a local error `error`, relative and absolute. Raises StopError with what was reached."""
    t_eval, project = segment.t_eval, segment.project
    states, done, solver = np.empty((len(t_eval), len(segment.start))), 0, None
    for solver in dop853_steps(segment, error):
        reached = int(np.searchsorted(t_eval, solver.t, side="right"))
        if reached > done:
            states[done:reached] = solver.dense_output()(t_eval[done:reached]).T
            done = reached
    assert solver is not None  # a segment has a length
    return Run(project(states.T).T if project and len(states) else states, solver.y, solver.nfev)
