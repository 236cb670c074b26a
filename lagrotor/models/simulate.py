"""`simulate`: a scene, times and a model in; a trajectory out."""

from collections.abc import Callable
from math import hypot

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError, LagrotorError, SingularError
from ..numerics.solve import Problem, check_tolerance, integrate
from ..numerics.trajectory import Array, Trajectory
from ..rotors.parameters import Scene
from .model import Model


def _minimal() -> Model:
    from .minimal import MODEL

    return MODEL


def _spheres() -> Model:
    from .spheres import MODEL

    return MODEL


def _euler() -> Model:
    from .euler import MODEL

    return MODEL


MODELS: dict[str, Callable[[], Model]] = {"minimal": _minimal, "spheres": _spheres, "euler": _euler}


def check_times(t: ArrayLike) -> Array:
    """Times as a float array (n,), refused unless finite, increasing and not before 0."""
    try:
        times = np.atleast_1d(np.asarray(t, dtype=float))
    except (TypeError, ValueError):
        raise InputError(f"simulate: t = {t!r} is not an array of times in s") from None
    if times.ndim != 1 or times.size == 0:
        raise InputError(f"simulate: t has shape {times.shape}: give a row of at least one time in s")
    if not np.isfinite(times).all():
        raise InputError("simulate: t holds a time that is not finite")
    if times[0] < 0:
        raise InputError(
            f"simulate: t starts at {times[0]:g} s: the scene is given at t = 0, so times start there or later"
        )
    if (np.diff(times) <= 0).any():
        raise InputError("simulate: the times must increase; sort them and drop repeated ones")
    return times


def simulate(scene: Scene, t: ArrayLike, model: str = "auto", tol: float = 1e-9) -> Trajectory:
    """Run `scene` from t = 0 and read it at the times `t` (n,), in s.

    model: "minimal", "spheres", "euler", or "auto": the smallest exact model that can hold the scene, named with its
    reason in the trajectory. tol: the solver's relative and absolute local error, 1e-13 to 0.1.

    Raises InputError for a bad argument, SingularError where a model's coordinates cannot hold the start,
    IntegrationError when the run cannot go on.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"simulate: scene = {scene!r} must be a Scene")
    times, tolerance = check_times(t), check_tolerance(tol)
    if model == "auto":
        return _automatic(scene, times, tolerance)
    if model not in MODELS:
        raise InputError(f"simulate: model = {model!r} is not one of auto, {', '.join(MODELS)}")
    return _run(MODELS[model](), scene, times, tolerance, "asked for")


def _automatic(scene: Scene, times: Array, tol: float) -> Trajectory:
    try:
        return _run(_minimal(), scene, times, tol, "least exact model: bar eliminated, six states")
    except LagrotorError as refusal:
        if not isinstance(refusal, SingularError | ArithmeticError):
            raise
        return _run(_spheres(), scene, times, tol, f"regular everywhere; {refusal}")


def _run(model: Model, scene: Scene, times: Array, tol: float, why: str) -> Trajectory:
    problem = Problem(
        free=model.rate(scene, False),
        start=model.start(scene),
        allowance=20_000 + 500 * _fastest(scene) * times[-1],
        driven=model.rate(scene, True) if scene.shock else None,
        at=scene.shock.at if scene.shock else 0.0,
        width=scene.shock.width if scene.shock else 0.0,
        project=model.projection(scene) if model.projection else None,
    )
    solution = integrate(problem, times, tol)
    seen = model.observe(scene, solution.states)
    return Trajectory(
        scene=scene,
        model=model.name,
        why=why,
        t=times,
        axes=seen.axes,
        rates=seen.rates,
        momenta=seen.momenta,
        evaluations=solution.evaluations,
    )


def _fastest(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: spins, start and shock, in units of the tilting inertia."""
    shock = hypot(*scene.shock.impulse) * scene.rotor.length if scene.shock else 0.0
    spin = abs(scene.momenta[0]) + abs(scene.momenta[1])
    return 1.0 + (spin + shock) / scene.rotor.J + hypot(*scene.rates[0]) + hypot(*scene.rates[1])
