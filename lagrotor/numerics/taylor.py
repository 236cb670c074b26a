"""The engine "fast": heyoka's functions and Taylor integrator, compiled from the same generated programs.

heyoka's error is relative to the largest component of the state. Cyclic coordinates and angles, which may grow without end, are
scaled so small that they are never the largest. Compiling takes one or two seconds for each program and order; the process
keeps the result in memory, heyoka on disk. States at any time are as exact as the run.

heyoka chooses its order by the tolerance for which it is compiled. Its error of a step is that tolerance times the largest
component of the state. The state therefore gets one more component, a constant whose size sets the tolerance of each run. It
decouples the step size from the order, so that three orders serve every tolerance.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache, reduce
from math import exp
from operator import mul
from threading import get_ident
from typing import Any, TypeVar

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.numerics.codegen import Program, reduce_common
from lagrotor.numerics.error_estimate import Legs, Motions, finite_times
from lagrotor.numerics.segment import (
    Array,
    Projection,
    Segment,
    SegmentSolver,
    StopError,
    Stretch,
    states_on_constraints,
)

_CARRIED = 2.0**-20  # factor of a coordinate that may grow without end: a power of two rounds nothing
_LAST_STEPS = 10_000  # steps in which the reason of a stop is sought
_MOST_STEPS = 1_000_000  # between two edges, beyond which a run stops
_LANES = 8  # trajectories at once: the fastest number with vectors of four doubles
Size = TypeVar("Size", float, Array)
# True in a pulse → the program and the values of its parameters.
Generated = Callable[[bool], tuple[Program, tuple[float, ...]]]


def heyoka_module() -> Any:
    try:
        import heyoka
    except ImportError:
        raise InputError("engine='fast' needs heyoka: pip install 'lagrotor[fast]', or use engine='core'") from None
    return heyoka


def heyoka_sum(terms: Sequence[Any]) -> Any:
    """Return heyoka's sum of its expressions and of numbers."""
    heyoka = heyoka_module()
    return heyoka.sum([heyoka.expression(x) if isinstance(x, float) else x for x in terms])


def _heyoka_expressions(program: Program, values: dict[sp.Symbol, Any]) -> list[Any]:
    """Translate the program's outputs, given heyoka's expressions of its arguments."""
    heyoka, named = heyoka_module(), dict(values)
    stages, outputs = reduce_common(program)
    for name, expression in stages:
        named[name] = _translate(expression, named, heyoka)
    return [_translate(e, named, heyoka) for e in outputs]


def _translate(e: sp.Expr, values: dict[sp.Symbol, Any], heyoka: Any) -> Any:
    if e in values:
        return values[e]
    if e.is_Number:
        return heyoka.expression(float(e))
    if e.is_Pow:
        base, power = _translate(e.base, values, heyoka), e.exp
        if power == sp.Rational(1, 2):
            return heyoka.sqrt(base)
        if not power.is_Integer:
            return base ** float(power)
        product = reduce(mul, [base] * abs(int(power)))
        return product if power > 0 else 1.0 / product
    arguments = [_translate(x, values, heyoka) for x in e.args]
    if e.is_Add:
        return heyoka.sum(arguments)
    if e.is_Mul:
        return reduce(mul, arguments)
    if isinstance(e, sp.sech):
        return 1.0 / heyoka.cosh(*arguments)
    if not hasattr(heyoka, e.func.__name__):
        raise InputError(f"engine='fast' does not know the function {e.func.__name__}: use engine='core'")
    return getattr(heyoka, e.func.__name__)(*arguments)


def taylor_rhs(program: Program, states: int, parameters: tuple[float, ...]) -> Callable[[float, Array], Array]:
    """Compile the program with given parameters to a right-hand side (s, y) → y', for any solver."""
    compiled, inputs = _compiled_function(program), np.array([*[0.0] * states, *parameters])

    def rhs(s: float, y: Array) -> Array:
        inputs[:states] = y
        return np.asarray(compiled(inputs))

    return rhs


@lru_cache(maxsize=16)
def _compiled_function(program: Program) -> Any:
    """Compile the program to heyoka's function of an array of its arguments."""
    heyoka = heyoka_module()
    variables = {s: heyoka.make_vars(str(s)) for s in program.arguments}
    outputs = _heyoka_expressions(program, variables)
    return heyoka.cfunc(outputs, [variables[s] for s in program.arguments], fast_math=True)


def taylor_solver(
    generated: Generated, order: int, longest_between: float = np.inf, angles: tuple[int, ...] = ()
) -> SegmentSolver:
    """Return a solver of segments by heyoka. Its number of evaluations is steps times order. The function `generated` takes True
    in a pulse, otherwise False, and returns the program and the values of its parameters. In a pulse the last three parameters
    are the peaks of a force exp(−(s/width)²), and the value of `width` follows them. States are projected at least every
    `longest_between` seconds. The states with the indices `angles`, like cyclic ones, may grow without end; since their rates are
    states too, the error of the rates bounds that of the angles."""
    heyoka_module()

    def solve(segment: Segment, pulsed: bool, tol: float) -> Stretch:
        (program, values), d, project = generated(pulsed), len(segment.start), segment.project
        solver, scale = _solver(program, d, pulsed, order, 1, get_ident(), angles), _carried(program, d, angles)
        solver.pars[:] = values[: len(solver.pars)]  # the last ones may be unused
        onto = None if project is None else lambda y: project(y / scale) * scale
        span, size = (segment.begin, segment.until), dummy_size(tol, order)

        def unscaled(run: Stretch) -> Stretch:
            return Stretch(states_on_constraints(project, run.states / scale), run.end / scale, run.evaluations)

        try:
            return unscaled(
                taylor_march(
                    solver, segment.start * scale, segment.t_eval, span, size, onto, longest_between, segment.longest
                )
            )
        except StopError as stop:
            stop.reached = stop.reached and unscaled(stop.reached)
            raise

    return solve


def march_lanes(program: Program, parameters: Array, legs: Legs) -> Motions:
    """Integrate n legs of an autonomous motion, each with its own column of the parameters (p, n). Eight legs of similar
    duration are integrated at once, each with its own steps."""
    finished, d, (n, m) = heyoka_module().taylor_outcome.time_limit, legs.start.shape[1], legs.times.shape
    keys = list(zip(legs.local.tolist(), legs.companion.tolist(), strict=True))
    order_of = {key: taylor_order(*key) for key in set(keys)}
    orders = np.array([order_of[key] for key in keys])
    motions = Motions.begun(legs, np.empty((m, d, n)).transpose(1, 2, 0))  # as the solver returns states
    # A shorter leg is read at its end again and again, at neighbouring doubles.
    times = legs.times - legs.times[:, :1]
    again = np.maximum(np.cumsum(times == times[:, -1:], axis=1) - 1, 0)
    times *= 1 + 4 * np.finfo(float).eps * again
    stopped, at_zero = np.zeros(n, bool), np.zeros(_LANES)
    for order in np.unique(orders).tolist():
        solver, cyclic = _solver(program, d, False, order, _LANES, get_ident()), _cyclic(program, d)
        numbers = np.flatnonzero(orders == order)
        numbers = numbers[np.argsort(times[numbers, -1], kind="stable")]
        starts = np.vstack([legs.start.T, dummy_size(legs.local, order)])
        starts[cyclic] *= _CARRIED
        for begin in range(0, len(numbers), _LANES):
            batch = numbers[begin : begin + _LANES]
            k = len(batch)
            lanes = batch if k == _LANES else np.append(batch, [batch[-1]] * (_LANES - k))  # copies fill the last lanes
            solver.set_time(at_zero)
            solver.state[:], solver.pars[:] = starts[:, lanes], parameters[:, lanes]
            _, states = solver.propagate_grid(np.ascontiguousarray(times[lanes].T), max_steps=_MOST_STEPS)
            adjacent = batch[-1] - batch[0] == k - 1 and batch[0] == batch.min()
            rows = slice(batch[0], batch[0] + k) if adjacent else batch
            motions.components[:, rows] = states[:, :d, :k].transpose(1, 2, 0)
            outcomes = solver.propagate_res[:k]
            motions.evaluations[rows] = [order * steps for _, _, _, steps in outcomes]
            stopped[rows] = [outcome != finished for outcome, _, _, _ in outcomes]
    motions.components[_cyclic(program, d)] /= _CARRIED
    motions.reached[:] = finite_times(motions.components)
    stopped |= motions.reached < m
    for i in np.flatnonzero(stopped).tolist():
        at = float(legs.times[i, max(int(motions.reached[i]), 1) - 1])
        motions.stops[i] = StopError(at, "the Taylor series gives no further step")
    return motions


@lru_cache(maxsize=64)
def _carried(program: Program, states: int, angles: tuple[int, ...]) -> Array:
    """Return the factor of each state during the integration, shape (states,); it is small for states that may grow without
    end."""
    scale = np.ones(states)
    scale[[*_cyclic(program, states), *angles]] = _CARRIED
    return scale


@lru_cache(maxsize=64)
def _cyclic(program: Program, states: int) -> list[int]:
    """Return the indices of the cyclic states, on which no rate depends."""
    stages, outputs = reduce_common(program)
    used = {s for e in (*(e for _, e in stages), *outputs) for s in e.free_symbols}
    return [i for i, s in enumerate(program.arguments[:states]) if s not in used]


@lru_cache(maxsize=64)
def _solver(
    program: Program, states: int, driven: bool, order: int, lanes: int, thread: int, angles: tuple[int, ...] = ()
) -> Any:
    """Compile the integrator of a program whose first `states` arguments are the state. Each thread has its own integrator."""
    heyoka = heyoka_module()
    names, parameters = program.arguments[:states], program.arguments[states:]
    variables, scale = [heyoka.make_vars(str(s)) for s in names], _carried(program, states, angles)
    values = {s: x if c == 1 else x * (1 / c) for s, x, c in zip(names, variables, scale, strict=True)}
    values |= {s: heyoka.par[i] for i, s in enumerate(parameters)}
    if driven:
        pulse = heyoka.exp(-((heyoka.time / heyoka.par[len(parameters)]) ** 2.0))
        values |= {s: values[s] * pulse for s in parameters[-3:]}
    rates = _heyoka_expressions(program, values)
    # A pulse is short, so that fast compiling outweighs fast code.
    equations = [(x, r if c == 1 else r * c) for x, r, c in zip(variables, rates, scale, strict=True)]
    return compiled_solver(equations, order, lanes, compact=lanes == 1 and (driven or states > 6))


def taylor_order(tol: float, companion: bool = False) -> int:
    """Return the order that is cheapest for a local error. Orders from 7 to 19 were tried with the displaced pair; the code of
    higher orders does not fit a cache. A companion has another order, since equal states may give equal steps. At the tightest
    errors both orders are even: the phase error of an even order grows as t, that of an odd order as t²."""
    return (10 if tol >= 1e-7 else 14) - companion if tol >= 1e-11 else 16 + 2 * companion


def compiled_solver(equations: Sequence[tuple[Any, Any]], order: int, lanes: int = 1, compact: bool = True) -> Any:
    """Compile the integrator of (variable, rate) pairs; its state has one more component, a constant. Compact code keeps its
    loops, so that it compiles many times faster and runs a little slower."""
    heyoka = heyoka_module()
    equations = [*equations, (heyoka.make_vars("size"), heyoka.expression(0.0))]
    settings = {"tol": _compiled_for(order), "fast_math": True}
    if lanes > 1:
        zero = np.zeros((len(equations), lanes))
        return heyoka.taylor_adaptive_batch(equations, state=zero, compact_mode=compact, **settings)
    return heyoka.taylor_adaptive(equations, state=[0.0] * len(equations), compact_mode=compact, **settings)


def dummy_size(tol: Size, order: int) -> Size:
    """Return the size of the constant component for which the error of a step of this order is a tenth of `tol`."""
    return tol / 10 / _compiled_for(order)


def taylor_march(
    solver: Any,
    y: Array,
    times: Array,
    span: tuple[float, float],
    size: float,
    project: Projection | None = None,
    longest_between: float = np.inf,
    longest: float = np.inf,
    after_step: Callable[[Any], bool] | None = None,
) -> Stretch:
    """Integrate from the state y (d,), and return the states (n, d) at the times within the span. The number of evaluations is
    steps times order. The constant component has the value `size`, and no step is longer than `longest`. The state is projected
    at least every `longest_between` seconds. After each step `after_step` is called with the solver; the run stops if it returns
    False."""
    (now, end), pieces, steps = span, [np.empty((0, len(y)))], 0
    options: dict[str, Any] = {"max_delta_t": longest, "max_steps": _MOST_STEPS}
    options |= {} if after_step is None else {"callback": after_step}
    while now < end or len(pieces) == 1:
        until = min(end, now + longest_between)
        inside = times[(times > now if len(pieces) > 1 else times >= now) & (times <= until)]
        grid = np.concatenate([[now], inside, [until]])
        later = np.append(True, grid[1:] > grid[:-1])  # False for a first or last time that is requested, too
        grid, places = grid[later], np.cumsum(later)[1:-1] - 1
        solver.time, solver.state[:-1], solver.state[-1] = now, y, size
        outcome, _, _, new_steps, _, states = solver.propagate_grid(grid, **options)
        steps += new_steps
        finite = np.isfinite(states).all(axis=1)
        whole = len(finite) if finite.all() else int(np.argmin(finite))
        pieces.append(states[places[places < whole], :-1])
        y = states[whole - 1, :-1].copy() if whole else y
        if whole < len(grid) or "time_limit" not in str(outcome):
            at, y = _last_step(solver, float(grid[max(whole, 1) - 1]), y, size)
            reached = Stretch(np.concatenate(pieces), y, steps * solver.order)
            raise StopError(at, "the Taylor series gives no further step; engine='core' may continue", reached)
        try:
            y, now = (y if project is None else project(y)), until
        except StopError as stop:
            earlier = np.concatenate(pieces)[: np.searchsorted(times, stop.at)]
            reached = Stretch(earlier, earlier[-1] if len(earlier) else y, steps * solver.order)
            raise StopError(stop.at, stop.reason, reached, cause=stop.cause) from None
    return Stretch(np.concatenate(pieces), y, steps * solver.order)


def _compiled_for(order: int) -> float:
    """Return the tolerance for which heyoka chooses this order, the least whole number not below 1 − ln(tol)/2."""
    return exp(-2 * (order - 1)) * (1 + 1e-9)


def _last_step(solver: Any, at: float, y: Array, size: float) -> tuple[float, Array]:
    """Return the time and the state (d,) after the last step that the solver can take, starting from the state y at the time
    `at`."""
    solver.time, solver.state[:-1], solver.state[-1] = at, y, size
    for _ in range(_LAST_STEPS):
        outcome, _ = solver.step()
        if "success" not in str(outcome) or not np.isfinite(solver.state).all():
            break
        at, y = float(solver.time), solver.state[:-1].copy()
    return at, y
