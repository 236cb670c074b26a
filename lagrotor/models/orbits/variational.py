"""The variational equations of the minimal model: its Jacobian along a motion, generated from the same program."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrotor.models.minimal import MODEL, RATIOS, program
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.integrate import TIGHTEST, Problem, integrate
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.models.programs.minimal_program import Ratio

_LAST_STEP = 1e-8  # of Newton's method, relative: the next is its square


@generated((massive, ratio) for massive in (False, True) for ratio in RATIOS)
def _tangents(massive: bool, ratio: Ratio) -> str:
    """Return the source of a function of the parameters, which returns a function of time and state. The latter gives the
    accelerations (3,), then their derivatives by the state (3, 6)."""
    from lagrotor.numerics.codegen import tangent_program
    from lagrotor.numerics.printers import rhs_source

    whole = program(massive, ratio, 0)
    directions = dict(zip(whole.arguments, np.eye(6, dtype=int).tolist(), strict=False))
    return rhs_source(tangent_program(replace(whole, outputs=whole.outputs[3:]), directions, whole.arguments), 6)


@dataclass(frozen=True)
class Flow:
    """The flow of the minimal model from a state over a time. `end` (6,) is the final state, `slope` (6, 6) its derivative by
    the initial state, and `rate` (6,) its time derivative."""

    end: Array
    slope: Array
    rate: Array


def flow(scene: Scene) -> Callable[..., Flow]:
    """Return a function (state, time in s, tol) → `Flow`, with states (U, chi, alpha, rates). Raises SingularError without a
    bar."""
    (massive, ratio, _), parameters = MODEL.kind(scene, False)
    accelerations = _tangents(massive, ratio)(*parameters)
    plain = MODEL.rate(scene, False)

    def rate(s: float, y: Array) -> Any:
        numbers = np.array(accelerations(s, y[:6]))
        products = numbers[3:].reshape(3, 6).dot(y[6:].reshape(6, 6)).ravel()
        return np.concatenate((y[3:6], numbers[:3], y[24:], products))

    def through(state: Array, time: float, tol: float = TIGHTEST) -> Flow:
        start = np.concatenate([state, np.eye(6).ravel()])
        end = integrate(Problem(rate, start, 12_000), np.array([time]), tol).states[0]
        return Flow(end[:6], end[6:].reshape(6, 6), np.array(plain(time, end[:6])))

    return through


def close_arc(
    through: Callable[..., Flow], start: Array, free: list[int], time: float, rows: list[int], end: Array,
    longest: float,
) -> tuple[Array, float]:  # fmt: skip
    """Find a start and a time after which the entries `rows` of the final state equal `end`, by Newton's method. The entries
    `free` of the start may change. Returns (start, time); the time is 0 if the steps do not converge or exceed `longest`."""
    for _ in range(12):
        now = through(start, time)
        slope = np.column_stack([now.slope[np.ix_(rows, free)], now.rate[rows]])
        step = -np.linalg.solve(slope, now.end[rows] - end)
        start, time = start.copy(), time + float(step[-1])
        start[free] += step[:-1]
        if not (np.isfinite(start).all() and 0 < time < longest):
            break
        if np.abs(step).max() < _LAST_STEP * max(1.0, time, float(np.abs(start[free]).max())):
            return start, time
    return start, 0.0
