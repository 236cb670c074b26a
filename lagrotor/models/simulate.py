"""`simulate`: a scene, times and a model in; a trajectory with its error estimate out."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, nan

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError, IntegrationError, LagrotorWarning, near
from lagrotor.models import euler, minimal, spheres
from lagrotor.models.choose import choose
from lagrotor.models.closed_form_model import closed_form
from lagrotor.models.estimate_constants import BEYOND, gathered_error
from lagrotor.models.estimated import Estimated, run_at, run_within
from lagrotor.models.linear import linear_error, linear_run
from lagrotor.models.model import Model, Observed, constant_momenta
from lagrotor.models.natural_units import PACE, NaturalUnits, natural_units
from lagrotor.numerics.integrate import check_engine, check_tolerance
from lagrotor.numerics.segment import StopError
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Array, Trajectory
from lagrotor.shown import scientific

LADDER = (minimal.MODEL, spheres.MODEL)  # of `auto`: where one stops, the next runs the scene
MODELS: dict[str, Model] = {model.name: model for model in (*LADDER, euler.MODEL)}


@dataclass(frozen=True, eq=False)
class Direct:
    """A motion known at any time at once: what is observed, the largest error of an axis, a sentence on why."""

    seen: Observed
    error: float
    reason: str


def _closed_form(scene: Scene, times: Array, tol: float, best: bool) -> Direct:
    answer = closed_form(scene, float(times[-1]), tol, best)
    seen = Observed(*answer.motion(times), constant_momenta(scene, len(times)))
    missed = ", more than tol" if answer.error > tol else ""
    return Direct(
        seen, answer.error, f"by name; {answer.reason}; estimated error {scientific(answer.error, 1)}{missed}"
    )


def _linear(scene: Scene, times: Array, tol: float, best: bool) -> Direct:
    seen = linear_run(scene, times)
    try:
        return Direct(seen, linear_error(scene, float(times[-1])), "by name")
    except DomainError:  # more turns than the estimate sums over
        return Direct(seen, nan, "by name")


# (scene, times, tol, whether to give the best there is, by name, or what `choose` took)
DIRECT: dict[str, Callable[[Scene, Array, float, bool], Direct]] = {"closed_form": _closed_form, "linear": _linear}


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


def simulate(
    scene: Scene,
    t: ArrayLike,
    model: str = "auto",
    tol: float = 1e-9,
    engine: str = "core",
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Run `scene` from t = 0 and read it at the times `t` (n,), in s.

    model: "closed_form", "linear", "minimal", "spheres", "euler", or "auto": the cheapest that keeps the axes within `tol`
    of the exact ones over the run, named with its reason in the trajectory; see `choose`. tol: for "auto" that error
    (tips: in units of R), for an integrated model the solver's relative and absolute local error, 1e-13 to 0.1.

    The trajectory carries `error`, the estimated largest error of an axis, and `horizon`, the time after which neighbouring
    motions have parted too far for `tol` to be meant. An integrated run is compared with a second one at another tolerance
    and held to what the motion conserves; a LagrotorWarning says when `tol` is not kept, and what was reached.

    engine: "core", scipy's solvers and our own; "fast", heyoka's (`pip install lagrotor[fast]`), for "minimal", and for
    "spheres" where there is no bar. Never chosen silently: it compiles for a moment, and its last digits are others.

    progress: called with the time in s of each evaluation by the core; a solver's last step may go past the end, and each
    of the runs that are compared begins anew.

    Raises InputError for a bad argument, SingularError where a model's coordinates cannot hold the start,
    DomainError where a closed form or the normal modes do not hold the scene, IntegrationError when the run cannot go on,
    or did not conserve what it must.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"simulate: scene = {scene!r} must be a Scene")
    times, tolerance = check_times(t), check_tolerance(tol)
    check_engine(engine)
    if model == "auto":
        return _automatic(scene, times, tolerance, engine, progress)
    if model in DIRECT:
        direct = DIRECT[model](scene, times, tolerance, True)
        return _direct(scene, model, direct.reason, times, direct, tolerance)
    if model not in MODELS:
        known = "auto", *DIRECT, *MODELS
        raise InputError(f"simulate: model = {model!r} is not one of {', '.join(known)}{near(model, known)}")
    return _by_name(MODELS[model], scene, times, tolerance, engine, progress)


def _direct(scene: Scene, model: str, why: str, times: Array, direct: Direct, tol: float) -> Trajectory:
    seen, horizon = direct.seen, inf if direct.error <= tol else nan
    return Trajectory(
        scene, model, why, times, seen.axes, seen.rates, seen.momenta, 0, error=direct.error, horizon=horizon
    )


def _by_name(
    model: Model, scene: Scene, times: Array, tol: float, engine: str, progress: Callable[[float], None] | None
) -> Trajectory:
    if engine == "fast" and not _fast_runs(model, scene):
        raise InputError(
            f"simulate: engine='fast' does not run model={model.name!r} with this scene: a Taylor step may pass where its "
            "constraints fail; take minimal, or engine='core'"
        )
    units = _in_units(scene, times)
    promised = gathered_error(tol, float(times[-1]) * units.rate * PACE)
    try:
        found = run_at(_reporting(model, units, progress), units.scene, times * units.rate, tol, engine, promised)
    except StopError as stopped:
        raise _in_seconds(stopped, units) from None
    return _trajectory(scene, model.name, "by name", times, found, units, promised, tol)


def _automatic(
    scene: Scene, times: Array, tol: float, engine: str, progress: Callable[[float], None] | None
) -> Trajectory:
    choice = choose(scene, float(times[-1]), tol, engine)
    if choice.model in DIRECT:
        direct = DIRECT[choice.model](scene, times, tol, False)
        return _direct(scene, choice.model, choice.reason, times, replace(direct, error=choice.estimate), tol)
    units, why, spent = _in_units(scene, times), choice.reason, 0
    for model in LADDER[[model.name for model in LADDER].index(choice.model) :]:
        last, runs_by = model is LADDER[-1], engine if _fast_runs(model, scene) else "core"
        try:
            reporting = _reporting(model, units, progress)
            found = run_within(reporting, units.scene, times * units.rate, tol, runs_by, not last)
            found = replace(found, nfev=found.nfev + spent)
            return _trajectory(scene, model.name, why, times, found, units, tol, tol)
        except IntegrationError as refusal:
            if last:
                raise _in_seconds(refusal, units) from None
            why, spent = f"regular everywhere; {_in_seconds(refusal, units)}", spent + refusal.nfev
    raise AssertionError("the last model returns or raises")


def _reporting(model: Model, units: NaturalUnits, progress: Callable[[float], None] | None) -> Model:
    return model if progress is None else replace(model, progress=lambda t: progress(t / units.rate))


def _fast_runs(model: Model, scene: Scene) -> bool:
    """Whether Taylor steps cannot pass a position at which the model's constraints fail."""
    return model.outside is None or scene.link is None


def _in_units(scene: Scene, times: Array) -> NaturalUnits:
    """Time is counted from the pulse: one far off that is not felt is left out, it would only cost digits."""
    return natural_units(replace(scene, shock=scene.shock_until(float(times[-1]))))


def _in_seconds(refusal: IntegrationError, units: NaturalUnits) -> IntegrationError:
    return StopError(refusal.at / units.rate, refusal.reason) if isinstance(refusal, StopError) else refusal


def _trajectory(
    scene: Scene,
    model: str,
    why: str,
    times: Array,
    found: Estimated,
    units: NaturalUnits,
    promised: float,
    tol: float,
) -> Trajectory:
    """The run in the units of the scene; warns where the estimate exceeds what was promised."""
    error, horizon = float(found.errors[-1]), found.horizon / units.rate
    if error > promised:
        warnings.warn(_not_kept(model, tol, found, units.rate), LagrotorWarning, stacklevel=4)
    seen, before = found.seen, constant_momenta(units.scene, len(times))
    momentum = units.inertia * units.rate
    return Trajectory(
        scene=scene,
        model=model,
        why=why,
        t=times,
        axes=seen.axes,
        rates=seen.rates * units.rate,
        momenta=constant_momenta(scene, len(times)) + (seen.momenta - before) * momentum,
        evaluations=found.nfev,
        error=error,
        horizon=horizon,
    )


def _not_kept(model: str, tol: float, found: Estimated, rate: float) -> str:
    error, horizon = float(found.errors[-1]), found.horizon / rate
    apart = error / found.tol
    reason = (
        f"neighbouring motions part about {scientific(apart)}-fold, and tol can be meant only up to"
        if apart > 1e5
        else "it is below what the solver can give after"
    )
    estimated = f"the estimated error is {scientific(error, 1)}"
    beyond = f"; from t = {found.loosened / rate:.6g} s its local error is {BEYOND:g}" if found.loosened < inf else ""
    return f"simulate: {model} does not keep tol = {tol:g}: {estimated}; {reason} t = {horizon:.6g} s{beyond}"
