"""One integration of a model by an engine: states at the times of the run, as axes and rates."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lagrotor.models.model import Array, Model, Observed
from lagrotor.models.natural_units import typical_rate
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.segment import OutsideError
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program


class Patience(NamedTuple):
    """Evaluations that a run may take: `begin` in all, and `radian` more for each radian of the scene's typical rate."""

    begin: float
    radian: float


BY_NAME = Patience(20_000, 250)
BETWEEN_PROJECTIONS = 3.0  # rad of the scene's typical rate, by the fast extra


@dataclass(frozen=True)
class Integrated:
    """What a model observes at the times of a run, its own state at the last, evaluations of its right-hand side."""

    seen: Observed
    end: Array
    nfev: int


def problem_of(
    model: Model,
    scene: Scene,
    t_end: float,
    bounded: bool = False,
    start: Array | None = None,
    patience: Patience = BY_NAME,
) -> Problem:
    """What `integrate` is given of a scene and a model; bounded: the run ends where the model is badly conditioned.

    start: the model's state at t = 0, where it is not that of the scene.
    """
    shock, rate = scene.shock, typical_rate(scene)
    return Problem(
        free=model.rate(scene, False, bounded),
        start=model.start(scene) if start is None else start,
        max_nfev=patience.begin + patience.radian * rate * t_end,
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
    start: Array | None = None,
    patience: Patience = BY_NAME,
) -> Integrated:
    """The model's run at increasing `times` (n,) in s, with a local error `tol` as `integrate` has it.

    companion: from a start that is off by rounding, and by steps that a run without it does not take. start: the model's
    state at t = 0, where it is not that of the scene.

    Raises SingularError where the coordinates cannot hold the start, StopError where the run cannot go on, with `bounded`
    also where the model is badly conditioned, InputError without heyoka.
    """
    begun = _start(model, scene, companion) if start is None else start
    if engine == "core":
        solution = integrate(problem_of(model, scene, float(times[-1]), bounded, begun, patience), times, tol)
        return Integrated(model.observe(scene, solution.states), solution.states[-1], solution.nfev)
    from lagrotor.numerics.taylor import Pulse, companion_order, integrate_taylor
    from lagrotor.numerics.taylor_steps import taylor_order

    shock, project = scene.shock, model.projection(scene) if model.projection else None
    x, y, z = (scene.rotor.length * f for f in (shock.force if shock else (0.0, 0.0, 0.0)))
    pulse = Pulse((x, y, z), shock.at, shock.width) if shock else None
    rate = typical_rate(scene)
    solution = integrate_taylor(
        lambda driven: model.program(scene, driven),
        begun,
        pulse,
        times,
        tol,
        project,
        BETWEEN_PROJECTIONS / rate if project else inf,
        companion_order(tol) if companion else taylor_order(tol),
        model.angles,
    )
    if bounded:
        _check_states(*model.program(scene, False), times, solution.states)
    return Integrated(model.observe(scene, solution.states), solution.states[-1], solution.nfev)


def _start(model: Model, scene: Scene, companion: bool) -> Array:
    start = model.start(scene)
    if not companion:
        return start
    beside = start * (1 + np.finfo(float).eps * np.cos(np.arange(1, len(start) + 1)))  # in no special direction
    return model.projection(scene)(beside) if model.projection else beside


def check_range(model: Model, scene: Scene) -> None:
    """Raises SingularError where the model cannot hold the scene's start, OutsideError where it is badly conditioned there."""
    if not np.isfinite(model.rate(scene, False, bounded=True)(0.0, model.start(scene))).all():
        raise OutsideError(0.0)


def _check_states(program: Program, values: tuple[float, ...], times: Array, states: Array) -> None:
    """Raises OutsideError at the first of the states (n, d) where the program is badly conditioned."""
    from lagrotor.numerics.codegen import compile_program

    bounds = compile_program(replace(program, outputs=program.positive), "numpy")
    outside = ~np.all([bound > 0 for bound in bounds(*states.T, *values)], axis=0)
    if outside.any():
        raise OutsideError(float(times[np.argmax(outside)]))
