"""The check that a benchmark makes of its work before it reports a number: evaluations, motion and error of the run."""

from math import inf
from typing import Any

from lagrotor.errors import LagrotorError


def check_work(
    run: str, evaluations: float, states: Any, error: float = 0.0, bound: float = inf, least: float = 1.0
) -> None:
    """Refuse a run that did not do the work which a benchmark reports, with a LagrotorError.

    The run took at least so many evaluations, its states (…, n, …) change along axis 1, and its error is within the bound.
    """
    motion = float((states.max(axis=1) - states.min(axis=1)).max())
    if not (evaluations >= least and motion > 0 and error <= bound):
        raise LagrotorError(
            f"{run}: the benchmark did not do its work: {evaluations:g} evaluations (at least {least:.3g}), "
            f"motion {motion:.3g}, error {error:.3g} (at most {bound:.3g})"
        )
