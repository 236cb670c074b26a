"""The fast extra: heyoka's Taylor integrator, compiled from the same generated programs.

Order and step follow the tolerance, so the cost grows slowly towards the last digit; the read-out at any time is as exact
as the run. What is compiled is kept for the process, one a program and tolerance: 0.1 s at 1e-3, 2 s at 1e-13.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, reduce
from itertools import pairwise
from operator import mul
from threading import get_ident
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from ..errors import InputError, IntegrationError
from .codegen import Program, reduce_common
from .solve import PULSE_REACH, Solution

Array = NDArray[np.float64]
Counts = NDArray[np.int64]
_MOST_STEPS = 1_000_000  # between two edges, beyond which a run is taken to crawl
LANES = 8  # trajectories in step with each other: what vectors of four doubles do best with
# (with the pulse or not) → the program and the values of its parameters, without the force.
Generated = Callable[[bool], tuple[Program, tuple[float, ...]]]


@dataclass(frozen=True)
class Pulse:
    """The torque force exp(−((t − at)/width)²) that goes with the last three parameters of the driven program."""

    force: tuple[float, float, float]
    at: float
    width: float


def integrate_taylor(generated: Generated, start: Array, pulse: Pulse | None, times: Array, tol: float) -> Solution:
    """Integrate from t = 0 through `times`; states (n, d) there, and steps times order for evaluations.

    Cut at the pulse's edges as `integrate` is. Raises InputError without heyoka, IntegrationError where it stops.
    """
    at, width = (pulse.at, pulse.width) if pulse else (0.0, 1.0)
    begin, end, reach = -at, float(times[-1]) - at, PULSE_REACH * width
    inner = [s for s in (-reach, reach) if pulse and begin < s < end]
    edges, asked = [begin, *inner, end], times - at
    states, y, evaluations = np.empty((len(times), len(start))), start, 0
    states[asked == begin] = start
    for left, right in pairwise(edges):
        driven = pulse is not None and abs(left + right) / 2 < reach
        program, values = generated(driven)
        solver = _solver(program, len(start), driven, max(_decade(tol), 1e-16), 1, get_ident())
        if pulse and driven:
            values = (*values, *pulse.force, width)
        solver.time = left
        solver.state[:] = y
        solver.pars[: len(values)] = values
        inside = (asked > left) & (asked <= right)
        last = [] if right in asked[-1:] or not right > left else [right]
        grid = np.concatenate([[left], asked[inside], last])
        outcome, _, _, steps, _, found = solver.propagate_grid(
            grid, max_delta_t=width if driven else np.inf, max_steps=_MOST_STEPS
        )
        if "time_limit" not in str(outcome) or not np.isfinite(found).all():
            raise IntegrationError(f"the Taylor solver stopped near t = {at + solver.time:.6g} s; use engine='core'")
        states[inside], y = found[1 : 1 + inside.sum()], found[-1]
        evaluations += steps * solver.order
    return Solution(states, evaluations)


def march_taylor(program: Program, start: Array, parameters: Array, times: Array, tol: float) -> tuple[Array, Counts]:
    """States (n, m, d) at times (m,) of n starts (d, n) with parameters (p, n), LANES at a time, and evaluations (n,).

    The lanes of a processor's vectors step together, each with its own step. One that stops leaves NaN. Raises InputError
    without heyoka.
    """
    (d, n), m = start.shape, len(times)
    states, spent = np.full((n, m, d), np.nan), np.zeros(n, np.int64)
    solver = _solver(program, d, False, max(_decade(tol), 1e-16), LANES, get_ident())
    first = int(times[0] == 0)
    grid = np.repeat(np.concatenate([[0.0], times[first:]])[:, None], LANES, axis=1)
    for begin in range(0, n, LANES):
        lanes = np.minimum(np.arange(begin, begin + LANES), n - 1)  # the last few are filled up with copies
        solver.set_time(np.zeros(LANES))
        solver.state[:], solver.pars[:] = start[:, lanes], parameters[:, lanes]
        _, found = solver.propagate_grid(grid, max_steps=_MOST_STEPS)
        kept = min(LANES, n - begin)
        steps = [steps for _, _, _, steps in solver.propagate_res[:kept]]
        stopped = ["time_limit" not in str(outcome) for outcome, *_ in solver.propagate_res[:kept]]
        states[begin : begin + kept] = found[1 - first :, :, :kept].transpose(2, 0, 1)
        states[begin : begin + kept][stopped] = np.nan
        spent[begin : begin + kept] = np.array(steps) * solver.order
    return states, spent


def _decade(tol: float) -> float:
    """What heyoka is asked for: a tenth of the decade of `tol`, so that few programs are compiled."""
    return float(10.0 ** np.floor(np.log10(tol) + 1e-9) / 10)


@lru_cache(maxsize=64)
def _solver(program: Program, states: int, driven: bool, tol: float, lanes: int, thread: int) -> Any:
    """The compiled integrator of a program whose first `states` arguments are the state; each thread has its own."""
    try:
        import heyoka
    except ImportError:
        raise InputError("engine='fast' needs heyoka: pip install 'lagrotor[fast]', or use engine='core'") from None
    names, parameters = program.arguments[:states], program.arguments[states:]
    known = {s: heyoka.make_vars(str(s)) for s in names}
    known |= {s: heyoka.par[i] for i, s in enumerate(parameters)}
    if driven:
        pulse = heyoka.exp(-((heyoka.time / heyoka.par[len(parameters)]) ** 2.0))
        known |= {s: known[s] * pulse for s in parameters[-3:]}
    stages, outputs = reduce_common(program)
    for name, expression in stages:
        known[name] = _translate(expression, known, heyoka)
    rates = [_translate(e, known, heyoka) for e in outputs]
    equations = [(known[s], rate) for s, rate in zip(names, rates, strict=True)]
    if lanes > 1:
        return heyoka.taylor_adaptive_batch(equations, state=np.zeros((states, lanes)), tol=tol)
    # A pulse is short: there its loops are not unrolled, which compiles many times faster and runs a little slower.
    return heyoka.taylor_adaptive(equations, state=[0.0] * states, tol=tol, compact_mode=driven)


def _translate(e: sp.Expr, known: dict[sp.Symbol, Any], heyoka: Any) -> Any:
    if e in known:
        return known[e]
    if e.is_Number:
        return heyoka.expression(float(e))
    if e.is_Pow:
        base, power = _translate(e.base, known, heyoka), e.exp
        if power == sp.Rational(1, 2):
            return heyoka.sqrt(base)
        if not power.is_Integer:
            return base ** float(power)
        product = _product([base] * abs(int(power)))
        return product if power > 0 else 1.0 / product
    parts = [_translate(x, known, heyoka) for x in e.args]
    if e.is_Add:
        return heyoka.sum(parts)
    return _product(parts) if e.is_Mul else getattr(heyoka, e.func.__name__)(*parts)


def _product(parts: Sequence[Any]) -> Any:
    return reduce(mul, parts)
