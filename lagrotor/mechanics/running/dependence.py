"""Whether a run passed a position where its constraints are dependent, so that their reactions may have no limit.

There the product of the rows of G, g₁ ∧ … ∧ g_k, is zero. Where it is simply zero it is reversed beyond, and then
det(G(t) G(t')ᵀ) < 0 for times before and after it.
"""

import warnings
from dataclasses import replace

import numpy as np

from lagrotor.errors import LagrotorWarning
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.integration import Array
from lagrotor.mechanics.running.motion import Motion
from lagrotor.mechanics.running.programs import parameter_values, rows_program

_BETWEEN = 8  # intervals of the interpolation between two samples, which must resolve the motion


def warn_of_dependence(run: Motion) -> None:
    """A LagrotorWarning with the time where the constraints of a run are dependent between two of its samples."""
    rows = run.system.rows
    if len(run.t) < 2 or not rows.free_symbols & {*run.system.c.q, t}:
        return
    from scipy.interpolate import CubicHermiteSpline

    fine = np.append(np.linspace(run.t[:-1], run.t[1:], _BETWEEN, endpoint=False).T.ravel(), run.t[-1])
    q = CubicHermiteSpline(run.t, run.q, run.v)(fine)
    G = _rows(replace(run, t=fine, q=q, v=0 * q))
    turned = np.linalg.det(G[:-1] @ G[1:].swapaxes(1, 2)) < 0
    if turned.any():
        at = fine[int(np.argmax(turned))]
        warnings.warn(
            f"simulate: near t = {at:.6g} s the constraints become dependent: their reactions may have no limit there, "
            "and the motion beyond may be one of several; end the run before",
            LagrotorWarning,
            stacklevel=3,
        )


def _rows(run: Motion) -> Array:
    """G at the states of a run, (n, k, N)."""
    given = rows_program(run.system)
    columns = [*run.q.T, *run.v.T, *((run.t,) if len(given.states) > 2 * run.q.shape[1] else ())]
    found = given.function(*columns, *parameter_values(given, run.values))
    return np.stack([np.broadcast_to(e, run.t.shape) for e in found], -1).reshape(-1, *run.system.rows.shape)
