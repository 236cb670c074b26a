"""Lyapunov exponents, from the motion linearised along a run (Benettin, Galgani, Giorgilli & Strelcyn 1980)."""

from dataclasses import dataclass

import numpy as np

from lagrotor.errors import InputError
from lagrotor.mechanics.running.flow import Array, projection_of
from lagrotor.mechanics.running.motion import SampledMotion
from lagrotor.mechanics.running.programs import motion_program, parameter_values, tangent_motion
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.pulse import windows_since
from lagrotor.shown import Shown

_PIECES, _PARTS = 200, 10  # of a run: between them the tangent is brought back to length one; for the standard error
MOST = 10_000_000  # evaluations
_TIGHTEST = 1e-9  # tolerance: an exponent has fewer digits than that


@dataclass(frozen=True, eq=False, repr=False)
class Lyapunov(Shown):
    """The largest Lyapunov exponent, 1/s: the mean growth rate of the distance of neighbours along the run.

    error: the standard error of that mean, from ten parts of the run; history (m,): the mean so far at the times t (m,).
    """

    exponent: float
    error: float
    t: Array
    history: Array

    def summary(self) -> dict[str, str]:
        """The exponent, its error and the time it belongs to, name → words."""
        return {
            "largest exponent [1/s]": f"{self.exponent:.4g} ± {self.error:.1g}",
            "over": f"{self.t[-1] - self.t[0]:g} s" if len(self.t) else "no time",
        }


def lyapunov(run: SampledMotion) -> Lyapunov:
    """The largest Lyapunov exponent over the time of the run.

    It belongs to that time: for a regular motion it falls off as log(t)/t. Raises InputError for a run of one sample,
    IntegrationError where a neighbour's motion cannot go on, as at a singular position that the run passes.
    """
    if len(run.t) < 2:
        raise InputError("lyapunov: a run of one sample has no duration: simulate to a later time")
    if not run.switched.smooth:
        raise InputError(
            "lyapunov: the motion has events or forces that jump: its linearised motion jumps, too, and is not run"
        )
    given, n = tangent_motion(motion_program(run.system)), run.q.shape[1] + run.u.shape[1]
    parameters, d = parameter_values(given, run.values), len(given.states) // 2
    project = projection_of(run.system, run.values) if run.system.multipliers else None
    grid = np.linspace(run.t[0], run.t[-1], _PIECES + 1)
    y = np.concatenate([run.q[0], run.u[0], [run.t[0]] * (d - n)])
    tangent = np.append(np.random.default_rng(1).normal(size=n), [0.0] * (d - n))  # time is not displaced
    growth = np.zeros(_PIECES)
    for i, h in enumerate(np.diff(grid)):
        tangent = tangent / np.linalg.norm(tangent)
        begin = float(grid[i])
        problem = Problem(
            given.rate(parameters, begin),
            np.concatenate([y, tangent]),
            MOST // _PIECES,
            windows=windows_since(begin, run.scales.windows),
        )
        end = integrate(problem, np.array([h]), max(run.tol, _TIGHTEST)).states[-1]
        y, tangent = end[:d] if project is None else project(end[:d]), end[d:]
        growth[i] = np.log(np.linalg.norm(tangent))
    duration = grid[1:] - grid[0]
    parts = growth.reshape(_PARTS, -1).sum(1) * _PARTS / duration[-1]
    history = np.cumsum(growth) / duration
    return Lyapunov(float(history[-1]), float(parts.std(ddof=1) / np.sqrt(_PARTS)), grid[1:], history)
