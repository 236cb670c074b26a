"""One integration of a model by an engine: states at the times of the run, as axes and rates."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf

import numpy as np

from lagrotor.models.model import Array, Model, Observed
from lagrotor.models.natural_units import typical_rate
from lagrotor.numerics.codegen import Program, compile_program
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.integrators import OutsideError
from lagrotor.numerics.taylor import Pulse, companion_order, integrate_taylor, taylor_order
from lagrotor.pair.scene import Scene

BETWEEN_PROJECTIONS = 3.0  # rad of the scene's typical rate, by the fast extra


@dataclass(frozen=True)
class Integrated:
    """What a model observes at the times of a run, and how often its right-hand side was evaluated."""

    seen: Observed
    nfev: int


def problem_of(model: Model, scene: Scene, t_end: float, bounded: bool = False, companion: bool = False) -> Problem:
    """What `integrate` is given of a scene and a model; bounded: the run ends where the model is badly conditioned."""
    shock, rate = scene.shock, typical_rate(scene)
    return Problem(
        free=model.rate(scene, False, bounded),
        start=_start(model, scene, companion),
        allowance=20_000 + 250 * rate * t_end,
        driven=model.rate(scene, True, bounded) if shock else None,
        at=shock.at if shock else 0.0,
        width=shock.width if shock else 0.0,
        project=model.projection(scene) if model.projection else None,
        typical_rate=rate,
        time_to_singular=model.time_to_singular if scene.link else None,
    )


def integrated(
    model: Model,
    scene: Scene,
    times: Array,
    tol: float,
    engine: str = "core",
    bounded: bool = False,
    companion: bool = False,
) -> Integrated:
    """The model's run at increasing `times` (n,) in s, with a local error `tol` as `integrate` has it.

    companion: by steps that a run without it does not take, from the start brought onto its constraints once more, so that
    the rounding of the two differs.

    Raises SingularError where the coordinates cannot hold the start, StopError where the run cannot go on, with `bounded`
    also where the model is badly conditioned, InputError without heyoka.
    """
    if engine == "core":
        solution = integrate(problem_of(model, scene, float(times[-1]), bounded, companion), times, tol)
        return Integrated(model.observe(scene, solution.states), solution.evaluations)
    shock, project = scene.shock, model.projection(scene) if model.projection else None
    x, y, z = (scene.rotor.length * f for f in (shock.force if shock else (0.0, 0.0, 0.0)))
    pulse = Pulse((x, y, z), shock.at, shock.width) if shock else None
    rate, (program, values) = typical_rate(scene), model.program(scene, False)
    solution = integrate_taylor(
        lambda driven: model.program(scene, driven),
        _start(model, scene, companion),
        pulse,
        times,
        tol,
        project,
        BETWEEN_PROJECTIONS / rate if project else inf,
        companion_order(tol) if companion else taylor_order(tol),
    )
    if bounded:
        _check_range(program, values, times, solution.states)
    return Integrated(model.observe(scene, solution.states), solution.evaluations)


def _start(model: Model, scene: Scene, companion: bool) -> Array:
    start = model.start(scene)
    return model.projection(scene)(start) if companion and model.projection else start


def check_range(model: Model, scene: Scene) -> None:
    """Raises SingularError where the model cannot hold the scene's start, OutsideError where it is badly conditioned there."""
    _check_range(*model.program(scene, False), np.zeros(1), model.start(scene)[None])


def _check_range(program: Program, values: tuple[float, ...], times: Array, states: Array) -> None:
    """Raises OutsideError at the first of the states (n, d) where the program is badly conditioned."""
    outside = ~np.all([bound > 0 for bound in _bounds(program)(*states.T, *values)], axis=0)
    if outside.any():
        raise OutsideError(float(times[np.argmax(outside)]))


@lru_cache(maxsize=16)
def _bounds(program: Program) -> Callable[..., list[Array]]:
    return compile_program(Program(program.arguments, program.stages, program.positive), "numpy")
