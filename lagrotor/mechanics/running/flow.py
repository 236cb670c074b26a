"""The smooth motion of a system in numbers: its right-hand side, the way back onto its constraints, its integration."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.programs import depends_on_time, motion_program, parameter_values, projection_program
from lagrotor.mechanics.running.singular import singular_position
from lagrotor.numerics.arrays import real_array
from lagrotor.numerics.calibrated import CROSSOVER
from lagrotor.numerics.dop853 import dop853
from lagrotor.numerics.integrate import Engine, Problem, by_fastest, check_engine, integrate
from lagrotor.numerics.pulse import COMPANION_STEP, PULSE_REACH
from lagrotor.numerics.segment import Integrate, StopError, Stretch, by_units
from lagrotor.numerics.taylor import companion_order, taylor_order, taylor_rhs, taylor_solver

Array = NDArray[np.float64]
Values = Mapping[Any, Any]
Rhs = Callable[[float, Array], Any]
_LIKE = 8.0  # ratio of a component to one below which none is scaled


class Brief(NamedTuple):
    """What acts briefly by the clock, a pulse or a step in a force of t: within `reach` (s) of the time `at`. There no step of a
    run is longer than `longest` (s), in which it changes by all that it ever does, at its fastest.
    """

    at: float
    reach: float
    longest: float

    def within(self, problem: Problem, begin: float, companion: bool = False) -> Problem:
        """The problem, whose clock shows 0 at the time `begin`, cut where it begins to act and ends; by the same steps two runs
        would agree, and be wrong."""
        width = self.reach / PULSE_REACH
        share = COMPANION_STEP if companion else 1.0
        return replace(
            problem, driven=problem.free, at=self.at - begin, width=width, longest=share * self.longest / width
        )


def rhs(system: Equations, values: Values, engine: Engine = "core") -> Rhs:
    """(t, y) → (v, u'), for the state y = (q, u), (N + m,): for any solver, and the fastest that the engine has. u is q' where
    the system has no velocities of its own.

    engine: "core", generated Python, which gives a list, or "fast", compiled by heyoka, which gives an array.

    Raises InputError for a value that is missing, another engine, and without heyoka; when called, for another y.
    """
    check_engine(engine)
    program = motion_program(system)
    parameters = parameter_values(program, values, "rhs")
    if engine == "fast" and any(map(callable, parameters)):
        raise InputError("rhs: engine='fast' takes no callable and no table for a function: use engine='core'")
    fast = engine == "fast"
    function = taylor_rhs(program.program, len(program.states), parameters) if fast else program.rhs(*parameters)
    timed, shape = depends_on_time(system), (len(system.c.q) + len(system.speeds),)
    speeds = "u" if system.kinematics else "q'"

    def rate(t: float, y: Any) -> Any:
        if getattr(y, "shape", None) != shape or y.dtype.kind not in "iuf":
            state = real_array(y)
            if state is None or state.shape != shape:
                raise InputError(f"rhs: y = {y!r} must be {shape[0]} numbers, q and then {speeds}")
            y = state
        return function(t, np.append(y, t))[:-1] if timed else function(t, y)

    return rate


def projection_of(system: Equations, values: Values) -> Callable[[Array], Array]:
    """A state (d,), or states (d, n), brought back onto the constraints: two steps of Newton's method along M⁻¹ Gᵀ."""
    program = projection_program(system)
    function, parameters = program.function, parameter_values(program, values)

    def project(y: Array) -> Array:
        with np.errstate(all="ignore"):
            for _ in range(2):
                y = np.array([np.broadcast_to(e, y.shape[1:]) for e in function(*y, *parameters)], dtype=float)
        return y

    return project


def powers_of_two(sizes: Array) -> Array:
    """The sizes as powers of two, which rounds nothing; ones, where all are about as large as one."""
    scale = np.exp2(np.rint(np.log2(sizes)))
    return scale if scale.max() > _LIKE or scale.min() < 1 / _LIKE else np.ones(len(sizes))


def smooth_motion(
    system: Equations,
    values: Values,
    engine: Engine,
    sizes: Array,
    turn: float,
    start: Array,
    stiff: bool,
    brief: Brief | None,
) -> Integrate:
    """(start, times, local error, companion, budget) → the motion of a system without events, its start at times[0].

    The solver is given each component in units of its size. turn: the time in which the motion typically turns. start: a state at
    which it is regular. brief: what acts briefly by the clock.
    """
    program, known = motion_program(system), len(sizes)
    parameters, d = parameter_values(program, values), len(program.states)
    project = projection_of(system, values) if system.multipliers else None
    scale = np.append(powers_of_two(sizes), np.ones(d - known))
    words = singular_position(system, values, start)

    def by_taylor(start: Array, times: Array, local: float, companion: bool) -> Stretch:
        order = companion_order(local) if companion else taylor_order(local)
        between = turn / 2 if project else np.inf
        # The time is a state, which may grow without end.
        clock = tuple(range(known, d))
        problem = Problem(program.rhs(*parameters), start, np.inf, project=project)
        problem = brief.within(problem, start[known], companion) if brief else problem
        solver = taylor_solver(lambda _: (program.program, parameters), order, between, clock)
        return integrate(problem, times, local, solver)

    def by_core(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        """By the solver that is fastest; the companion of a stiff motion by DOP853 instead of LSODA: two runs by its methods
        for stiff ones may be off by the same."""
        rate, spent = 2 * np.pi / turn, 0
        problem = Problem(
            program.rhs(*parameters),
            start,
            budget,
            project=project,
            typical_rate=rate,
        )
        problem = brief.within(problem, start[known], companion) if brief else problem
        if companion and stiff and local >= CROSSOVER.value:
            by_dop853 = by_units(lambda segment, _, tol: dop853(segment, tol / 20), scale)
            try:
                return integrate(replace(problem, budget=budget / 2), times, local, by_dop853)
            except StopError as stop:
                if stop.cause != "budget":
                    raise
                spent = stop.evaluations
        try:
            stretch = integrate(replace(problem, budget=budget - spent), times, local, by_units(by_fastest, scale))
            return replace(stretch, evaluations=spent + stretch.evaluations)
        except StopError as stop:
            stop.evaluations += spent
            raise

    def motion(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        if len(times) == 1:
            return Stretch(start[None], start, 0)
        since = times - times[0]
        try:
            return (
                by_taylor(start, since, local, companion)
                if engine == "fast"
                else by_core(start, since, local, companion, budget)
            )
        except StopError as stop:
            at = float(times[0]) + stop.at
            singular = words(stop.reached.end if stop.reached else start)
            if singular:
                raise StopError(at, singular, stop.reached, stop.evaluations, "singular") from None
            raise StopError(at, stop.reason, stop.reached, stop.evaluations, stop.cause) from None

    return motion
