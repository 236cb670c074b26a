"""The fast extra: heyoka's Taylor integrator, compiled from the same generated programs.

A cyclic coordinate and an angle, which may grow without end, are carried so small that they are never the largest state, which
heyoka measures its error by. What is compiled, one or two seconds a program and order, is kept for the process, by heyoka on
disk. The read-out at any time is as exact as the run.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from threading import get_ident
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.codegen import Program, reduce_common
from lagrotor.numerics.heyoka_programs import heyoka_module, translated
from lagrotor.numerics.integrate import Solution
from lagrotor.numerics.pulse import segments
from lagrotor.numerics.segment import Projection, StopError
from lagrotor.numerics.taylor_steps import (
    MOST_STEPS,
    compiled_solver,
    dummy_size,
    march,
    taylor_order,
)

Array = NDArray[np.float64]
Counts = NDArray[np.int64]
_CARRIED = 2.0**-20  # of a coordinate that may grow without end: a millionth, that rounds nothing
LANES = 8  # trajectories in step with each other: what vectors of four doubles do best with
# (with the pulse or not) → the program and the values of its parameters, without the force.
Generated = Callable[[bool], tuple[Program, tuple[float, ...]]]


@dataclass(frozen=True)
class Pulse:
    """The torque force exp(−((t − at)/width)²) that goes with the last three parameters of the driven program."""

    force: tuple[float, float, float]
    at: float
    width: float


def integrate_taylor(
    generated: Generated,
    start: Array,
    pulse: Pulse | None,
    times: Array,
    tol: float,
    project: Projection | None = None,
    longest_between: float = np.inf,
    order: int | None = None,
    angles: tuple[int, ...] = (),
) -> Solution:
    """Integrate from t = 0 through `times`; states (n, d) there, and steps times order for evaluations.

    Cut at the pulse's edges as `integrate` is, and projected there, at the end, and after no more than `longest_between`.
    order: another than the cheapest for `tol`. angles: which states may grow without end besides the cyclic ones; their
    error is held by that of their rates, which are states too.
    Raises InputError without heyoka, StopError where it stops.
    """
    order = order or taylor_order(tol)
    at, width = (pulse.at, pulse.width) if pulse else (0.0, 0.0)
    t_eval = times - at if pulse else times
    found: list[Array] = []
    d, y, nfev = len(start), start, 0
    for left, right, driven in segments(-at, float(t_eval[-1]), width):
        program, values = generated(driven)
        solver, scale = _solver(program, d, driven, order, 1, get_ident(), angles), _carried(program, d, angles)
        if pulse and driven:
            values = (*values, *pulse.force, width)
        solver.pars[:] = values[: len(solver.pars)]  # the last ones may be in no expression
        inside = t_eval[(t_eval > left if found else t_eval >= left) & (t_eval <= right)]
        onto = None if project is None else lambda y, scale=scale: project(y / scale) * scale
        longest = width if driven else np.inf
        try:
            states, y, more = march(
                solver, y * scale, inside, (left, right), dummy_size(tol, order), onto, longest_between, longest
            )
        except StopError as stopped:
            raise StopError(at + stopped.at, stopped.reason, nfev=nfev + stopped.nfev) from None
        found.append(states / scale)
        y, nfev = y / scale, nfev + more
    states = np.concatenate(found)
    return Solution(states if project is None else project(states.T).T, nfev)


def companion_order(tol: float) -> int:
    """Never that of the run it is compared with: where the size of the states sets the steps, both have the same at any tol."""
    return taylor_order(tol) - 1


def march_taylor(program: Program, start: Array, parameters: Array, times: Array, tol: float) -> tuple[Array, Counts]:
    """States (n, m, d) at times (m,) of n starts (d, n) with parameters (p, n), LANES at a time, and evaluations (n,).

    The lanes of a processor's vectors step together, each with its own step. One that stops leaves NaN. Raises InputError
    without heyoka.
    """
    (d, n), m = start.shape, len(times)
    states, spent = np.full((n, m, d), np.nan), np.zeros(n, np.int64)
    solver = _solver(program, d, False, taylor_order(tol), LANES, get_ident())
    first, cyclic = int(times[0] == 0), _cyclic(program, d)
    grid = np.repeat(np.concatenate([[0.0], times[first:]])[:, None], LANES, axis=1)
    for begin in range(0, n, LANES):
        lanes = np.minimum(np.arange(begin, begin + LANES), n - 1)  # the last few are filled up with copies
        solver.set_time(np.zeros(LANES))
        solver.state[:d], solver.state[d] = start[:, lanes], dummy_size(tol, taylor_order(tol))
        solver.state[cyclic] *= _CARRIED
        solver.pars[:] = parameters[:, lanes]
        _, found = solver.propagate_grid(grid, max_steps=MOST_STEPS)
        found[:, cyclic] /= _CARRIED
        kept = min(LANES, n - begin)
        steps = [steps for _, _, _, steps in solver.propagate_res[:kept]]
        stopped = ["time_limit" not in str(outcome) for outcome, *_ in solver.propagate_res[:kept]]
        states[begin : begin + kept] = found[1 - first :, :d, :kept].transpose(2, 0, 1)
        states[begin : begin + kept][stopped] = np.nan
        spent[begin : begin + kept] = np.array(steps) * solver.order
    return states, spent


def _carried(program: Program, states: int, angles: tuple[int, ...]) -> Array:
    """What each state is multiplied by while it is integrated."""
    scale = np.ones(states)
    scale[[*_cyclic(program, states), *angles]] = _CARRIED
    return scale


@lru_cache(maxsize=64)
def _cyclic(program: Program, states: int) -> list[int]:
    """Which of the states no rate depends on."""
    stages, outputs = reduce_common(program)
    used = {s for e in (*(e for _, e in stages), *outputs) for s in e.free_symbols}
    return [i for i, s in enumerate(program.arguments[:states]) if s not in used]


@lru_cache(maxsize=64)
def _solver(
    program: Program, states: int, driven: bool, order: int, lanes: int, thread: int, angles: tuple[int, ...] = ()
) -> Any:
    """The compiled integrator of a program whose first `states` arguments are the state; each thread has its own.

    Its state has one component more, which is constant.
    """
    heyoka = heyoka_module()
    names, parameters = program.arguments[:states], program.arguments[states:]
    variables, scale = [heyoka.make_vars(str(s)) for s in names], _carried(program, states, angles)
    known = {s: x if c == 1 else x * (1 / c) for s, x, c in zip(names, variables, scale, strict=True)}
    known |= {s: heyoka.par[i] for i, s in enumerate(parameters)}
    if driven:
        pulse = heyoka.exp(-((heyoka.time / heyoka.par[len(parameters)]) ** 2.0))
        known |= {s: known[s] * pulse for s in parameters[-3:]}
    rates = translated(program, known, heyoka)
    # A pulse is short: there what compiles faster pays.
    equations = [(x, r if c == 1 else r * c) for x, r, c in zip(variables, rates, scale, strict=True)]
    return compiled_solver(equations, order, lanes, compact=lanes == 1 and (driven or states > 6))
