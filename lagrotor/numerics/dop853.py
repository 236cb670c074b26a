"""DOP853 (Hairer, Nørsett & Wanner, II.5), step by step: slow in Python, but it follows any motion and says where it stops."""

import numpy as np

from lagrotor.numerics.segment import Run, Segment, StopError

_TURN = 0.5  # of a state with constraints, in a step, where a solver may be far from where the constraints fail
_PATIENCE = 5_000  # evaluations before they are weighed against the share of the segment that is done
_LEAST_RELATIVE = 2.3e-14  # scipy's solvers take no smaller relative tolerance


def dop853(segment: Segment, error: float) -> Run:
    """The segment at a local error `error`, relative and absolute. Raises StopError with what was reached."""
    from scipy.integrate import DOP853

    t_eval, project = segment.t_eval, segment.project
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
    found, done = np.empty((len(t_eval), len(segment.start))), 0
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
        reached = int(np.searchsorted(t_eval, solver.t, side="right"))
        if reached > done:
            found[done:reached] = solver.dense_output()(t_eval[done:reached]).T
            done = reached
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(segment.rhs(solver.t, solver.y))
            solver.nfev += 1
    return Run(project(found.T).T if project and len(found) else found, solver.y, solver.nfev)
