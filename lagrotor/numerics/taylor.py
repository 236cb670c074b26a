"""The fast extra: heyoka's Taylor integrator, compiled from the same generated programs.

heyoka takes its order from the tolerance that it is compiled for, and a step that leaves this tolerance times the largest
component of the state. A constant dummy state, of a size chosen at each run, decouples the step size from the order:
three orders serve every tolerance, each in the steps that pay. A cyclic coordinate, which may grow without end, is carried
so small that it is never the largest. What is compiled is kept for the process, some tenths of a
second a program and order. The read-out at any time is as exact as the run.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import exp
from threading import get_ident
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.codegen import Program, reduce_common
from lagrotor.numerics.heyoka_programs import heyoka_module, translated
from lagrotor.numerics.integrate import Solution
from lagrotor.numerics.pulse import segments
from lagrotor.numerics.segment import Projection, StopError

Array = NDArray[np.float64]
Counts = NDArray[np.int64]
_MOST_STEPS = 1_000_000  # between two edges, beyond which a run is stopped
_CARRIED = 2.0**-20  # of a cyclic coordinate: a millionth, that rounds nothing
LANES = 8  # trajectories in step with each other: what vectors of four doubles do best with
# (with the pulse or not) → the program and the values of its parameters, without the force.
Generated = Callable[[bool], tuple[Program, tuple[float, ...]]]


@dataclass(frozen=True)
class Pulse:
    """The torque force exp(−((t − at)/width)²) that goes with the last three parameters of the driven program."""

    force: tuple[float, float, float]
    at: float
    width: float


def taylor_order(tol: float) -> int:
    """The cheapest order for a local error, of 7 to 19 tried with the displaced pair; code of higher ones outgrows a cache."""
    return 10 if tol >= 1e-7 else 14 if tol >= 1e-11 else 16


def companion_order(tol: float) -> int:
    """An order that takes other steps than that of a tighter run: at the tightest the next lower one."""
    return min(taylor_order(tol), 14)


def integrate_taylor(
    generated: Generated,
    start: Array,
    pulse: Pulse | None,
    times: Array,
    tol: float,
    project: Projection | None = None,
    longest_between: float = np.inf,
    order: int | None = None,
) -> Solution:
    """Integrate from t = 0 through `times`; states (n, d) there, and steps times order for evaluations.

    Cut at the pulse's edges as `integrate` is, and projected there, at the end, and after no more than `longest_between`.
    order: another than the cheapest for `tol`.
    Raises InputError without heyoka, StopError where it stops.
    """
    order = order or taylor_order(tol)
    at, width = (pulse.at, pulse.width) if pulse else (0.0, 0.0)
    t_eval = times - at if pulse else times
    found: list[Array] = []
    d, y, nfev = len(start), start, 0
    for left, right, driven in segments(-at, float(t_eval[-1]), width):
        program, values = generated(driven)
        solver = _solver(program, d, driven, order, 1, get_ident())
        cyclic = _cyclic(program, d)
        if pulse and driven:
            values = (*values, *pulse.force, width)
        solver.pars[: len(values)] = values
        while left < right or not found:
            solver.time, solver.state[:d], solver.state[d] = left, y, _size(tol, order)
            solver.state[cyclic] *= _CARRIED
            until = min(right, left + longest_between)
            inside = t_eval[(t_eval > left if found else t_eval >= left) & (t_eval <= until)]
            states, y, steps = _propagated(solver, inside, until, width if driven else np.inf)
            if states is None:
                raise StopError(at + solver.time, "the Taylor series has no step; engine='core' may go on")
            states[:, cyclic] /= _CARRIED
            y[cyclic] /= _CARRIED
            found.append(states[:, :d])
            y, left = (y[:d] if project is None else project(y[:d])), until
            nfev += steps * solver.order
    states = np.concatenate(found)
    return Solution(states if project is None else project(states.T).T, nfev)


def _propagated(solver: Any, t_eval: Array, until: float, longest: float) -> tuple[Array | None, Array, int]:
    """States (n, d) at the times within the solver's and `until`, the state there, and steps; None where it stops."""
    before = 0 if len(t_eval) and t_eval[0] == solver.time else 1
    after = 0 if len(t_eval) and t_eval[-1] == until else int(until > solver.time)
    grid = np.concatenate([[solver.time] * before, t_eval, [until] * after])
    outcome, _, _, steps, _, states = solver.propagate_grid(grid, max_delta_t=longest, max_steps=_MOST_STEPS)
    if "time_limit" not in str(outcome) or not np.isfinite(states).all():
        return None, np.empty(0), steps
    return states[before : before + len(t_eval)].copy(), states[-1].copy(), steps


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
        solver.state[:d], solver.state[d] = start[:, lanes], _size(tol, taylor_order(tol))
        solver.state[cyclic] *= _CARRIED
        solver.pars[:] = parameters[:, lanes]
        _, found = solver.propagate_grid(grid, max_steps=_MOST_STEPS)
        found[:, cyclic] /= _CARRIED
        kept = min(LANES, n - begin)
        steps = [steps for _, _, _, steps in solver.propagate_res[:kept]]
        stopped = ["time_limit" not in str(outcome) for outcome, *_ in solver.propagate_res[:kept]]
        states[begin : begin + kept] = found[1 - first :, :d, :kept].transpose(2, 0, 1)
        states[begin : begin + kept][stopped] = np.nan
        spent[begin : begin + kept] = np.array(steps) * solver.order
    return states, spent


def _size(tol: float, order: int) -> float:
    """Of the constant dummy state: with it a step of this order leaves a tenth of `tol`."""
    return tol / 10 / _compiled_for(order)


def _compiled_for(order: int) -> float:
    """The tolerance of which heyoka makes this order, the least whole number not under 1 − ln(tol)/2."""
    return exp(-2 * (order - 1)) * (1 + 1e-9)


@lru_cache(maxsize=64)
def _cyclic(program: Program, states: int) -> list[int]:
    """Which of the states no rate depends on."""
    stages, outputs = reduce_common(program)
    used = {s for e in (*(e for _, e in stages), *outputs) for s in e.free_symbols}
    return [i for i, s in enumerate(program.arguments[:states]) if s not in used]


@lru_cache(maxsize=64)
def _solver(program: Program, states: int, driven: bool, order: int, lanes: int, thread: int) -> Any:
    """The compiled integrator of a program whose first `states` arguments are the state; each thread has its own.

    Its state has one component more, which is constant.
    """
    heyoka = heyoka_module()
    names, parameters = program.arguments[:states], program.arguments[states:]
    known = {s: heyoka.make_vars(str(s)) for s in names}
    known |= {s: heyoka.par[i] for i, s in enumerate(parameters)}
    if driven:
        pulse = heyoka.exp(-((heyoka.time / heyoka.par[len(parameters)]) ** 2.0))
        known |= {s: known[s] * pulse for s in parameters[-3:]}
    rates = translated(program, known, heyoka)
    for i in _cyclic(program, states):
        rates[i] *= _CARRIED
    equations = [(known[s], rate) for s, rate in zip(names, rates, strict=True)]
    equations.append((heyoka.make_vars("size"), heyoka.expression(0.0)))
    given = {"tol": _compiled_for(order), "fast_math": True}
    if lanes > 1:
        return heyoka.taylor_adaptive_batch(equations, state=np.zeros((states + 1, lanes)), **given)
    # A pulse is short: there its loops are not unrolled, which compiles many times faster and runs a little slower.
    return heyoka.taylor_adaptive(equations, state=[0.0] * (states + 1), compact_mode=driven or states > 6, **given)
