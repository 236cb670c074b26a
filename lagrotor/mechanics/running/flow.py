"""The smooth motion of a system in numbers: its right-hand side, its projection onto constraints, its integration."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.narrow_features import NarrowPart, with_followed
from lagrotor.mechanics.running.programs import depends_on_time, motion_program, parameter_values, projection_program
from lagrotor.mechanics.running.singular_positions import singular_position
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.arrays import real_array
from lagrotor.numerics.integrate import Engine, Problem, by_fastest, check_engine, integrate
from lagrotor.numerics.pulse import Window, windows_since
from lagrotor.numerics.segment import Cause, Integrate, Segment, SegmentSolver, StopError, Stretch, by_units, reporting
from lagrotor.numerics.solver_constants import CROSSOVER
from lagrotor.numerics.taylor import taylor_order, taylor_rhs, taylor_solver

Values = Mapping[Any, Any]
Rhs = Callable[[float, Array], Any]
_LIKE = 8.0  # ratio of a component to one up to which no component is scaled


def rhs(system: Equations, values: Values, engine: Engine = "core") -> Rhs:
    """Return the right-hand side for `System.rhs`, a function of the time t and the state y = (q, u, x) that returns y'."""
    check_engine(engine)
    program = motion_program(system)
    parameters = parameter_values(program, values, "rhs")
    if engine == "fast" and any(map(callable, parameters)):
        raise InputError("rhs: engine='fast' takes no callable and no table for a function: use engine='core'")
    fast = engine == "fast"
    function = taylor_rhs(program.program, len(program.states), parameters) if fast else program.rhs(*parameters)
    timed, shape = depends_on_time(system), (len(system.variables),)
    parts = "q and then " * bool(system.c.q) + ("u" if system.kinematics else "q'") * bool(system.c.q)
    parts += (", then " * bool(parts) + "the states") * bool(system.states)

    def rate(t: float, y: Any) -> Any:
        if getattr(y, "shape", None) != shape or y.dtype.kind not in "iuf":
            state = real_array(y)
            if state is None or state.shape != shape:
                raise InputError(f"rhs: y = {y!r} must be {shape[0]} numbers, {parts}")
            y = state
        return function(t, np.append(y, t))[:-1] if timed else function(t, y)

    return rate


def projection_of(system: Equations, values: Values) -> Callable[[Array], Array]:
    """Return a function that projects a state (d,), or states (d, n), onto the constraints, by two steps of Newton's method along
    M⁻¹ Gᵀ. It does not change components beyond q, u and t, which are integrated along with the motion."""
    program = projection_program(system)
    function, parameters, d = program.function, parameter_values(program, values), len(program.states)

    def project(y: Array) -> Array:
        with np.errstate(all="ignore"):
            for _ in range(2):
                rows = *function(*y[:d], *parameters), *y[d:]
                y = np.array([np.broadcast_to(e, y.shape[1:]) for e in rows], dtype=float)
        return y

    return project


def powers_of_two(sizes: Array) -> Array:
    """Round the sizes to powers of two, since scaling by these causes no rounding error. Return ones if all sizes lie between 1/8
    and 8."""
    scale = np.exp2(np.rint(np.log2(sizes)))
    return scale if scale.max() > _LIKE or scale.min() < 1 / _LIKE else np.ones(len(sizes))


def smooth_motion(
    system: Equations,
    values: Values,
    engine: Engine,
    sizes: Array,
    turn: float,
    start: Array,
    windows: tuple[Window, ...],
    followed: tuple[NarrowPart, ...] = (),
    progress: Callable[[float], None] | None = None,
    solver: SegmentSolver | None = None,
    stiff: bool = False,
) -> Integrate:
    """Return a function of the type `Integrate` that integrates a system without events. The solver measures each component in
    units of its size. The typical period in s is `turn`, and the mass matrix is regular at `start`. The narrow terms in
    `followed` are integrated along with the motion. If `stiff` is true, the companion run is integrated at a far tighter
    tolerance."""
    program, size = motion_program(system, followed), len(sizes)
    parameters, d = parameter_values(program, values), len(program.states) - len(followed)
    project = projection_of(system, values) if system.multipliers else None
    units, begun = np.append(powers_of_two(sizes), np.ones(d - size)), np.zeros(len(followed))
    words = singular_position(system, values, start, sizes)

    def motion(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        if len(times) == 1:
            return Stretch(start[None], start, 0)
        begin, since = float(times[0]), times - times[0]
        start = np.concatenate([start[:size], [begin] * (d - size), begun])
        problem = Problem(
            reporting(program.rate(parameters, begin), progress, begin),
            start,
            np.inf if engine == "fast" else budget,
            windows=windows_since(begin, windows, companion),
            project=project,
            typical_rate=2 * np.pi / turn,
        )
        if engine == "fast":
            clock = tuple(range(size, d + len(followed)))  # the time is a state, which may grow without end
            order, between = taylor_order(local, companion), turn / 2 if project else np.inf
            chosen = taylor_solver(lambda _: (program.program, parameters), order, between, clock)
        else:
            scale = with_followed(units, followed, local, companion)
            core = solver or (_as_in_pulse if followed else by_fastest)
            chosen = by_units(_tighter(core) if stiff and companion else core, scale)
        try:
            return integrate(problem, since, local, chosen).cut(d)
        except StopError as stop:
            singular = words(stop.reached.end if stop.reached else start)
            cause: Cause = "singular" if singular else stop.cause
            reached = stop.reached and stop.reached.cut(d)
            raise StopError(begin + stop.at, singular or stop.reason, reached, stop.evaluations, cause) from None

    return motion


def _as_in_pulse(segment: Segment, pulsed: bool, tol: float) -> Stretch:
    return by_fastest(segment, pulsed or tol >= CROSSOVER.value, tol)


def _tighter(solver: SegmentSolver) -> SegmentSolver:
    """Return the solver with a hundredth of its tolerance, for the companion of a stiff run. At similar tolerances, the two runs
    that are compared would share their error."""

    def solve(segment: Segment, pulsed: bool, tol: float) -> Stretch:
        return solver(segment, pulsed, max(tol / 100, min(tol, CROSSOVER.value)))

    return solve
