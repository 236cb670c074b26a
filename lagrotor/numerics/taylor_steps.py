"""heyoka's Taylor integrator on equations in its own expressions: compiled, and propagated through the times of a run.

heyoka takes its order from the tolerance that it is compiled for, and a step that leaves this tolerance times the largest
component of the state. A constant dummy state, the last one, of a size chosen at each run, decouples the step size from the
order: three orders serve every tolerance, each in the steps that pay.
"""

from collections.abc import Callable, Sequence
from math import exp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.heyoka_programs import heyoka_module
from lagrotor.numerics.segment import Projection, StopError

Array = NDArray[np.float64]
MOST_STEPS = 1_000_000  # between two edges, beyond which a run is stopped


def taylor_order(tol: float) -> int:
    """The cheapest order for a local error, of 7 to 19 tried with the displaced pair; code of higher ones outgrows a cache."""
    return 10 if tol >= 1e-7 else 14 if tol >= 1e-11 else 16


def compiled_solver(equations: Sequence[tuple[Any, Any]], order: int, lanes: int = 1, compact: bool = True) -> Any:
    """The integrator of (variable, its rate) of this order, its state one constant component longer.

    compact: its loops are not unrolled, which compiles many times faster and runs a little slower.
    """
    heyoka = heyoka_module()
    equations = [*equations, (heyoka.make_vars("size"), heyoka.expression(0.0))]
    given = {"tol": _compiled_for(order), "fast_math": True}
    if lanes > 1:
        zero = np.zeros((len(equations), lanes))
        return heyoka.taylor_adaptive_batch(equations, state=zero, compact_mode=compact, **given)
    return heyoka.taylor_adaptive(equations, state=[0.0] * len(equations), compact_mode=compact, **given)


def dummy_size(tol: float, order: int) -> float:
    """Of the constant dummy state: with it a step of this order leaves a tenth of `tol`."""
    return tol / 10 / _compiled_for(order)


def march(
    solver: Any,
    y: Array,
    times: Array,
    span: tuple[float, float],
    size: float | Array,
    project: Projection | None = None,
    longest_between: float = np.inf,
    longest: float = np.inf,
    after_step: Callable[[Any], bool] | None = None,
) -> tuple[Array, Array, int]:
    """States (n, d) at the times within the span, begun with y (d,); the state at its end; evaluations, steps times order.

    With a solver of L lanes, which step side by side, each its own way, y is (d, L), size (L,) and the states (n, d, L).
    size: of the dummy state. project: brings a state onto its constraints, after no more than `longest_between`.
    longest: of a step. after_step: called with the solver after each step; whether to go on. Raises StopError where it stops.
    """
    (left, right), found, steps = span, list[Array](), 0
    while left < right or not found:
        solver.state[:-1], solver.state[-1] = y, size
        until = min(right, left + longest_between)
        inside = times[(times > left if found else times >= left) & (times <= until)]
        states, y, more = _propagated(solver, left, inside, until, longest, after_step)
        if states is None:
            reason = "the Taylor series has no step; engine='core' may go on"
            raise StopError(float(np.min(solver.time)), reason, nfev=(steps + more) * solver.order)
        found.append(states)
        y, left, steps = (y if project is None else project(y)), until, steps + more
    return np.concatenate(found), y, steps * solver.order


def _propagated(
    solver: Any, begin: float, t_eval: Array, until: float, longest: float, after_step: Callable[[Any], bool] | None
) -> tuple[Array | None, Array, int]:
    """States (n, d) at the times from `begin` to `until`, the state there, and steps; None where it stops."""
    before = 0 if len(t_eval) and t_eval[0] == begin else 1
    after = 0 if len(t_eval) and t_eval[-1] == until else int(until > begin)
    grid = np.concatenate([[begin] * before, t_eval, [until] * after])
    more: dict[str, Any] = {"max_delta_t": longest, "max_steps": MOST_STEPS}
    more |= {} if after_step is None else {"callback": after_step}
    if solver.state.ndim > 1:
        solver.set_time(begin)
        _, states = solver.propagate_grid(np.repeat(grid[:, None], solver.state.shape[1], axis=1), **more)
        outcomes, steps = [each[0] for each in solver.propagate_res], sum(each[3] for each in solver.propagate_res)
    else:
        solver.time = begin
        outcome, _, _, steps, _, states = solver.propagate_grid(grid, **more)
        outcomes = [outcome]
    if any("time_limit" not in str(outcome) for outcome in outcomes) or not np.isfinite(states).all():
        return None, np.empty(0), steps
    states = states[:, :-1]
    return states[before : before + len(t_eval)].copy(), states[-1].copy(), steps


def _compiled_for(order: int) -> float:
    """The tolerance of which heyoka makes this order, the least whole number not under 1 − ln(tol)/2."""
    return exp(-2 * (order - 1)) * (1 + 1e-9)
