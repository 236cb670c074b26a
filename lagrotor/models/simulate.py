"""`simulate`: a scene, times and a model in; a trajectory out."""

from collections.abc import Callable
from dataclasses import replace
from math import hypot

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError
from lagrotor.models.model import Model, Observed
from lagrotor.numerics.integrate import TIGHTEST, Problem, check_tolerance, integrate
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Array, Trajectory


def _minimal() -> Model:
    from lagrotor.models.minimal import MODEL

    return MODEL


def _spheres() -> Model:
    from lagrotor.models.spheres import MODEL

    return MODEL


def _euler() -> Model:
    from lagrotor.models.euler import MODEL

    return MODEL


def _closed_form(scene: Scene, times: Array, tol: float) -> Observed:
    from lagrotor.models.closed_form import closed_form_run

    return closed_form_run(scene, times, tol)


def _linear(scene: Scene, times: Array, tol: float) -> Observed:
    from lagrotor.models.linear import linear_run

    return linear_run(scene, times)


# Rungs that answer at any time at once, and rungs that are integrated.
DIRECT: dict[str, Callable[[Scene, Array, float], Observed]] = {"closed_form": _closed_form, "linear": _linear}
MODELS: dict[str, Callable[[], Model]] = {"minimal": _minimal, "spheres": _spheres, "euler": _euler}


def check_times(t: ArrayLike) -> Array:
    """Times as a float array (n,), refused unless finite, increasing and not before 0."""
    try:
        if isinstance(t, str | bytes):
            raise TypeError
        times = np.atleast_1d(np.asarray(t, dtype=float))
    except (TypeError, ValueError):
        raise InputError(f"simulate: t = {t!r} is not an array of times in s") from None
    if times.ndim != 1 or times.size == 0:
        raise InputError(f"simulate: t has shape {times.shape}: give a row of at least one time in s")
    if times[0] >= 0 and times[-1] < np.inf and (times[1:] > times[:-1]).all():  # of a NaN nothing is true
        return times
    if not np.isfinite(times).all():
        raise InputError("simulate: t holds a time that is not finite")
    if times[0] < 0:
        raise InputError(
            f"simulate: t starts at {times[0]:g} s: the scene is given at t = 0, so times start there or later"
        )
    raise InputError("simulate: the times must increase; sort them and drop repeated ones")


def simulate(scene: Scene, t: ArrayLike, model: str = "auto", tol: float = 1e-9, engine: str = "core") -> Trajectory:
    """Run `scene` from t = 0 and read it at the times `t` (n,), in s.

    model: "closed_form", "linear", "minimal", "spheres", "euler", or "auto": the cheapest that keeps the axes within `tol`
    of the exact ones over the run, named with its reason in the trajectory; see `choose`. tol: for "auto" that error
    (tips: in units of R), for an integrated model the solver's relative and absolute local error, 1e-13 to 0.1; the closed
    form gives the best it has, and says in `why` how far off it may be.

    engine: "core", scipy's solvers and our own; "fast", heyoka's (`pip install lagrotor[fast]`), for "minimal", and for
    "spheres" where there is no bar. Never chosen silently: it compiles for a moment, and its last digits are others.

    Raises InputError for a bad argument, SingularError where a model's coordinates cannot hold the start,
    DomainError where a closed form or the normal modes do not hold the scene, IntegrationError when the run cannot go on.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"simulate: scene = {scene!r} must be a Scene")
    times, tolerance = check_times(t), check_tolerance(tol)
    if engine not in ("core", "fast"):
        raise InputError(f"simulate: engine = {engine!r} is neither core nor fast")
    if model == "auto":
        return _automatic(scene, times, tolerance, engine)
    if model in DIRECT:
        seen = DIRECT[model](scene, times, tolerance)
        return _trajectory(scene, model, _foreseen(scene, model, float(times[-1]), tolerance), times, seen, 0)
    if model not in MODELS:
        raise InputError(f"simulate: model = {model!r} is not one of auto, {', '.join((*DIRECT, *MODELS))}")
    return _run(MODELS[model](), scene, times, tolerance, "asked for", engine)


def _foreseen(scene: Scene, model: str, t_end: float, tol: float) -> str:
    """Why, and how far off, a model that was asked for by name; it may miss `tol`."""
    if model != "closed_form":
        return "asked for"
    from lagrotor.models.closed_form import closed_form

    answer = closed_form(scene, t_end, tol, best=True)
    missed = ", more than tol" if answer.error > tol else ""
    return f"asked for; {answer.reason}; an error up to {answer.error:.1e} is foreseen{missed}"


def _automatic(scene: Scene, times: Array, tol: float, engine: str) -> Trajectory:
    from lagrotor.models.choose import choose

    choice = choose(scene, float(times[-1]), tol, engine)
    if choice.model in DIRECT:
        return _trajectory(scene, choice.model, choice.reason, times, DIRECT[choice.model](scene, times, tol), 0)
    if choice.model == "spheres" and scene.link:
        engine = "core"
    try:
        return _run(MODELS[choice.model](), scene, times, choice.solver_tol, choice.reason, engine)
    except IntegrationError as refusal:
        if choice.model == "spheres":
            raise
        # Beside a singular position any error grows a millionfold: the solver gives all it has.
        return _run(_spheres(), scene, times, TIGHTEST, f"regular everywhere; {refusal}", "core")


def _run(model: Model, scene: Scene, times: Array, tol: float, why: str, engine: str) -> Trajectory:
    # Time is counted from the pulse: one that does not act within the run would only cost digits.
    acting = replace(scene, shock=scene.shock_until(float(times[-1])))
    if engine == "fast":
        seen, evaluations = _fast(model, acting, times, tol)
        return _trajectory(scene, model.name, why, times, seen, evaluations)
    solution = integrate(problem_of(model, acting, float(times[-1])), times, tol)
    return _trajectory(scene, model.name, why, times, model.observe(scene, solution.states), solution.evaluations)


def problem_of(model: Model, scene: Scene, t_end: float) -> Problem:
    """What `integrate` is given of a scene and a model that is integrated."""
    return Problem(
        free=model.rate(scene, False),
        start=model.start(scene),
        allowance=20_000 + 250 * _fastest(scene) * t_end,
        driven=model.rate(scene, True) if scene.shock else None,
        at=scene.shock.at if scene.shock else 0.0,
        width=scene.shock.width if scene.shock else 0.0,
        project=model.projection(scene) if model.projection else None,
    )


def _fast(model: Model, scene: Scene, times: Array, tol: float) -> tuple[Observed, int]:
    from lagrotor.models import minimal, spheres
    from lagrotor.numerics.taylor import Pulse, integrate_taylor

    offered = {"minimal": minimal.generated} | ({} if scene.link else {"spheres": spheres.generated})
    if model.name not in offered:
        raise InputError(
            f"simulate: engine='fast' does not run model={model.name!r} with this scene: it has no projection onto "
            "constraints; take minimal, or engine='core'"
        )
    start, pulse = model.start(scene), None
    if scene.shock:
        x, y, z = (scene.rotor.length * f for f in scene.shock.force)
        pulse = Pulse((x, y, z), scene.shock.at, scene.shock.width)
    solution = integrate_taylor(lambda pulsed: offered[model.name](scene, pulsed), start, pulse, times, tol)
    observe = minimal.observe_fast if model.name == "minimal" else model.observe
    return observe(scene, solution.states), solution.evaluations


def _trajectory(scene: Scene, model: str, why: str, times: Array, seen: Observed, evaluations: int) -> Trajectory:
    return Trajectory(
        scene=scene,
        model=model,
        why=why,
        t=times,
        axes=seen.axes,
        rates=seen.rates,
        momenta=seen.momenta,
        evaluations=evaluations,
    )


def _fastest(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: spins, start and shock, in units of the tilting inertia."""
    shock = hypot(*scene.shock.impulse) * scene.rotor.length if scene.shock else 0.0
    spin = abs(scene.momenta[0]) + abs(scene.momenta[1])
    return 1.0 + (spin + shock) / scene.rotor.J + hypot(*scene.rates[0]) + hypot(*scene.rates[1])
