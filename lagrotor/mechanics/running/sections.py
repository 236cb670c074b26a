"""Where a motion crosses a section: events, and Poincaré sections."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.errors import InputError
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.integration import Array
from lagrotor.mechanics.running.motion import Motion

Kind = TypeVar("Kind", bound=Motion)
_BETWEEN = 8  # intervals of the interpolation between two samples in which a crossing is sought
_STEPS = 8  # of Newton's method, which needs two or three


def crossings(run: Kind, section: sp.Expr, direction: int = 0) -> Kind:
    """The states where section(q, v, t) = 0 is crossed: upward (direction = 1), downward (−1), or both (0).

    Sought on a cubic interpolation between the samples, which must therefore resolve the motion; the times are found by
    Newton's method on states integrated to the run's tolerance. There may be none.
    """
    from scipy.interpolate import CubicHermiteSpline

    if direction not in (-1, 0, 1):
        raise InputError(f"crossings: direction = {direction!r} must be 1 (upward), −1 (downward) or 0 (both)")
    if len(run.t) < 2:
        raise InputError("crossings: a run of one sample crosses nothing: simulate to a later time")
    section, n = expression("crossings: section", section), run.q.shape[1]
    curve = CubicHermiteSpline(run.t, np.hstack([run.q, run.v]), run.derivatives())
    fine = np.append(np.linspace(run.t[:-1], run.t[1:], _BETWEEN, endpoint=False).T.ravel(), run.t[-1])
    values = _moved(run, fine, curve(fine)).evaluate(section)
    up, down = (values[:-1] < 0) & (values[1:] >= 0), (values[:-1] > 0) & (values[1:] <= 0)
    i = np.flatnonzero((up & (direction >= 0)) | (down & (direction <= 0)))
    if not len(i):
        return _moved(run, np.zeros(0), np.zeros((0, 2 * n)))
    low, high = fine[i], fine[i + 1]
    times = low + (high - low) * values[i] / (values[i] - values[i + 1])
    slopes = [derivative(section, s) for s in (*run.system.c.q, *run.system.c.v)]
    for _ in range(_STEPS):
        there = run.at(times)
        rates = there.derivatives().T
        speed = there.evaluate(derivative(section, t)) + sum(
            there.evaluate(slope) * rate for slope, rate in zip(slopes, rates, strict=True)
        )
        with np.errstate(all="ignore"):
            moved = np.clip(times - there.evaluate(section) / speed, low, high)
        if not np.isfinite(moved).all() or np.abs(moved - times).max() <= 1e-15 * (1 + np.abs(times).max()):
            break
        times = moved
    return run.at(times)


def poincare(run: Motion, section: sp.Expr, of: Sequence[sp.Expr], direction: int = 1) -> Array:
    """The values of the expressions `of` at the crossings, (m, len(of)): of two, the points of a Poincaré section."""
    wanted = vector_of("poincare: of", of, len(of) if isinstance(of, Sequence) else 2)
    there = crossings(run, section, direction)
    return np.stack([there.evaluate(e) for e in wanted], axis=1)


def _moved(run: Kind, times: Array, states: Array) -> Kind:
    n = run.q.shape[1]
    return replace(run, t=times, q=states[:, :n], v=states[:, n:])
