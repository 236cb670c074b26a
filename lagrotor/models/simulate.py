"""`simulate`: integrate a scene by a chosen model, and return its trajectory with an error estimate."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError, LagrotorError, LagrotorWarning, SingularError, near
from lagrotor.models import euler, minimal, spheres
from lagrotor.models.averaged import averaged_motion
from lagrotor.models.closed_form_model import closed_form
from lagrotor.models.linear import linear_motion
from lagrotor.models.model import (
    PACE,
    TURN,
    ClosedMotion,
    Model,
    NaturalUnits,
    Observed,
    check_range,
    conservation_defect,
    constant_momenta,
    integrate_model,
    natural_units,
    pulse_nodes,
    tilting_rate,
    typical_rate,
    without_idle_shock,
)
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.error_estimate import (
    EstimatedRun,
    EvaluationBudget,
    Evolution,
    estimate_run,
    first_time,
    perturbed_state,
)
from lagrotor.numerics.integrate import check_engine, check_progress, check_tolerance
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import StopError, Stretch
from lagrotor.numerics.solver_constants import Calibrated
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Array, Trajectory
from lagrotor.result_display import scientific

LADDER = (minimal.MODEL, spheres.MODEL)  # the models that `auto` tries in turn
MODELS: dict[str, Model] = {model.name: model for model in (*LADDER, euler.MODEL)}
_BY_NAME = EvaluationBudget(20_000, 250 * 2 * pi)
# For a run that another model can replace: five times as many evaluations improve none.
_REPLACEABLE = EvaluationBudget(1_000, 500 * 2 * pi)
LONG_RUN = Calibrated(
    600.0,
    "turns beyond which the averaged motion is tried before one is integrated",
    "turns that an integration follows in the time in which the normal form of order 8 is made",
    "test_averaged.py::test_auto_takes_it_for_long_runs",
)
LONG_FAST_RUN = Calibrated(
    10_000.0,
    "the same number of turns for the fast extra",
    "turns that the fast extra follows in the time in which the normal form of order 8 is made",
    "test_averaged.py::test_auto_takes_it_for_long_runs",
)
SMALL = Calibrated(
    0.1,
    "least error of the linear model in units of the square of the tilting rate over the typical rate, times that of the turns "
    "in a run of less than one",
    "1,500 random scenes of 0.3 to 50 s: 19 of 20 have a larger error",
    "test_choose.py::test_nothing_is_estimated_that_cannot_keep_the_tolerance",
)
SHORT = Calibrated(
    20.0,
    "turns below which the fast extra integrates at once",
    "random scenes of up to 20 turns",
    "test_choose.py::test_the_fast_extra_misses_none_either_and_foresees_only_long_runs",
)

MOST_SLACK = Calibrated(
    1000.0,
    "slack of nearly dependent constraints, in units of rounding, times which rounding may exceed tol before another goes first",
    "95 of the recorded wide scenes near the joint line: of 11 that unit vectors do not keep within tol, 9 begin by minimal",
    "test_wide_scenes.py::test_beside_a_dead_point_the_model_that_keeps_the_tolerance_is_taken",
)
_RESOLVED = 10 * np.finfo(float).eps  # the rounding of a start


# (scene, last time, tol, best): by name the best that can be had, for `choose` the cheapest
DIRECT: dict[str, Callable[[Scene, float, float, bool], ClosedMotion]] = {
    "closed_form": closed_form,
    "linear": linear_motion,
    "averaged": averaged_motion,
}


@dataclass(frozen=True)
class Choice:
    """The model that `auto` takes first, the estimated error of an axis, and the reason in words. `motion` is the closed form
    of the motion; None if the model has to be integrated."""

    model: str
    estimate: float
    reason: str
    motion: ClosedMotion | None = field(default=None, repr=False, compare=False)


def choose(scene: Scene, t_end: float, tol: float, engine: str = "core") -> Choice:
    """Choose the cheapest model whose axes stay within `tol` (tips: in units of R) of the exact ones up to t_end (s).

    The errors of the closed forms and of the linear model are estimated without integration, unless the motion is so wide that
    the linear model cannot keep `tol`. For a short run with a bar, integration by the fast engine costs less than this estimate
    and is chosen at once. An integrated model is checked while it runs: see `lagrotor.numerics.error_estimate`.
    """
    scene = without_idle_shock(scene, t_end)
    rate, missed = typical_rate(scene), "a run too short to estimate the cheaper ones' errors"
    turns, names = rate * t_end / (2 * pi), list[str]()
    if engine == "core" or scene.link is None or turns > SHORT.value:
        names, missed = ["closed_form"], "the motion is too wide for normal modes"
        if SMALL.value * (min(1.0, turns) * tilting_rate(scene)) ** 2 <= tol * rate**2:
            names.append("linear")
    long_run = LONG_RUN.value if engine == "core" else LONG_FAST_RUN.value
    if scene.link and scene.spins[0] == -scene.spins[1] and turns > long_run:
        names.append("averaged")
    for name in names:
        try:
            motion = DIRECT[name](scene, t_end, tol, False)
            error = scientific(motion.error, 1)
            if motion.error <= tol:
                return Choice(name, motion.error, f"{motion.reason}; error {error}", motion)
            missed = f"normal modes have an error of {error}" if name == "linear" else missed
        except LagrotorError as refusal:
            missed = str(refusal).split(";")[0] if name == "linear" else missed
    try:
        check_range(minimal.MODEL, scene)
    except LagrotorError as refusal:
        return Choice("spheres", tol, f"regular everywhere; {refusal}")
    return Choice("minimal", tol, f"smallest exact model: bar eliminated, six states; {missed}")


def simulate(
    scene: Scene, t: ArrayLike, model: str = "auto", tol: float = 1e-9, engine: str = "core",
    progress: Callable[[float], None] | None = None,
) -> Trajectory:  # fmt: skip
    """Integrate a scene from its initial state, which holds at t[0].

    A run is integrated twice, at two local errors, and compared with the conservation laws.

    A LagrotorWarning is issued if `tol` is not kept or the run ends early. The trajectory contains the times that were reached.

    Parameters
    ----------
    scene : Scene
        The pair, its initial state, and its shock.
    t : array_like
        The increasing times (n,), s.
    model : str, default "auto"
        "closed_form", "linear", "averaged", "minimal", "spheres", "euler", or "auto" for the cheapest model that keeps `tol`.
    tol : float, default 1e-9
        The largest error of an axis (of tips: in units of R) over the whole run, from 1e-13 to 0.1.
    engine : str, default "core"
        "core", or "fast" for heyoka (`pip install lagrotor[fast]`), for "minimal", and for "spheres" without a bar.
    progress : callable or None, optional
        A function of the time (s), called at each evaluation. The times begin anew with each compared run.

    Returns
    -------
    Trajectory
        The motion, with its error, the model, and the reason for this model.

    Raises
    ------
    InputError
        If an argument is invalid.
    SingularError, DomainError
        If the chosen model cannot represent the scene.
    IntegrationError
        If no part of the run can be computed, or it violates a conservation law.

    Examples
    --------
    >>> from lagrotor import Scene, paired_scene
    >>> run = simulate(paired_scene(Scene(spins=(10, -10)), 0.204), [0.0, 1.0, 2.0], tol=1e-9)
    >>> run.tips.shape, run.error < 1e-9
    ((2, 3, 3), True)
    """
    if not isinstance(scene, Scene):
        raise InputError(f"simulate: scene = {scene!r} must be a Scene")
    times, tolerance = check_times("simulate", t), check_tolerance(tol)
    check_engine(engine)
    check_progress(progress)
    at_zero = scene.since(float(times[0]))  # from now on time counts from the start
    if model in tuple(DIRECT):  # an unhashable value is refused below
        motion = DIRECT[model](at_zero, float(times[-1] - times[0]), tolerance, True)
        error = "not known" if np.isnan(motion.error) else scientific(motion.error, 1)
        missed = not motion.error <= tolerance
        suffix = ", more than tol" if motion.error > tolerance else ""
        why = f"by name; {motion.reason}; estimated error {error}{suffix}"
        trajectory = _direct(scene, model, why, times, motion, tolerance)
        if missed:
            until = f"; tol is kept up to t = {trajectory.horizon:.6g} s" if motion.errors else ""
            message = f"simulate: {model} does not keep tol = {tolerance:g}: the estimated error is {error}{until}"
            warnings.warn(message, LagrotorWarning, stacklevel=2)
        return trajectory
    if model == "auto":
        choice = choose(at_zero, float(times[-1] - times[0]), tolerance, engine)
        if choice.motion:
            return _direct(scene, choice.model, choice.reason, times, choice.motion, tolerance)
    elif model not in tuple(MODELS):
        names = "auto", *DIRECT, *MODELS
        raise InputError(f"simulate: model = {model!r} is not one of {', '.join(names)}{near(model, names)}")
    elif engine == "fast" and not _fast_runs(MODELS[model], scene):
        raise InputError(
            f"simulate: engine='fast' does not run model={model!r} with this scene: a Taylor step may pass a position where "
            "its constraints fail; take minimal, or engine='core'"
        )
    # Time counts from the pulse. A distant pulse without effect is dropped, as it would cost digits.
    duration = float(times[-1] - times[0])
    scaled = _ScaledScene(natural_units(without_idle_shock(at_zero, duration)), times, tolerance, engine, progress)
    if model == "auto":
        name, why, run = scaled.by_ladder(choice)
    else:
        name, why, run = model, "by name", scaled.run(MODELS[model], _BY_NAME)
    run.warn_unless_kept(name, tolerance)
    return trajectory_of(scene, scaled.units, name, why, times, run)


def trajectory_of(
    scene: Scene, units: NaturalUnits, model: str, why: str, times: Array, run: EstimatedRun
) -> Trajectory:
    """Return the trajectory in SI units of a run in natural units, at the times that the run reached."""
    observed, n = MODELS[model].observe(units.scene, run.states), len(run.t)
    momenta = observed.momenta - constant_momenta(units.scene, n)
    # In natural units the last time has a rounding error.
    ending = replace(run.ending, at=float(times[-1])) if run.ending.kind == "end" else run.ending
    return Trajectory(
        **run.run_fields | {"t": times[:n], "ending": ending}, scene=scene, model=model, why=why, axes=observed.axes,
        rates=observed.rates * units.rate, momenta=constant_momenta(scene, n) + momenta * units.inertia * units.rate,
    )  # fmt: skip


def _direct(scene: Scene, model: str, why: str, times: Array, closed: ClosedMotion, tol: float) -> Trajectory:
    since = times - times[0]
    axes, rates = closed.motion(since)
    errors = closed.errors(since) if closed.errors else np.full(len(times), closed.error)
    horizon = first_time(times, ~(errors <= tol))
    return Trajectory(
        scene=scene, model=model, why=why, t=times, axes=axes, rates=rates, momenta=constant_momenta(scene, len(times)),
        errors=errors, horizon=horizon, evaluations=closed.evaluations, ending=Ending("end", float(times[-1])),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _ScaledScene:
    """A scene in natural units with its times, tolerance and engine."""

    units: NaturalUnits
    times: Array
    tol: float
    engine: str
    progress: Callable[[float], None] | None

    def run(self, model: Model, patience: EvaluationBudget, bounded: bool = False) -> EstimatedRun:
        """Return the run by a model. Raises StopError, with its time in s, if the run does not reach any time."""
        rate, begin = self.units.rate, float(self.times[0])
        t = (self.times - begin) * rate
        report = self.progress
        evolution = evolution_of(
            model, self.units.scene, float(t[-1]), patience, self.engine, bounded=bounded,
            progress=report and (lambda s: report(begin + s / rate)),
        )  # fmt: skip
        try:
            return estimate_run(evolution, t, self.tol).by_clock(begin, 1 / rate)
        except StopError as stop:
            at = begin + stop.at / rate
            raise StopError(at, stop.reason, evaluations=stop.evaluations, cause=stop.cause) from None
        except IntegrationError as refusal:
            refusal.args = (f"{model.name}: {refusal}",)
            raise

    def by_ladder(self, choice: Choice) -> tuple[str, str, EstimatedRun]:
        """Return name, reason and run of the first model of the ladder that reaches the end, or else of the one that gets
        furthest."""
        first_model = [model.name for model in LADDER].index(choice.model)
        # If none reaches the end, the first models continue where they are badly conditioned.
        tries = [(model, model is not LADDER[-1]) for model in LADDER[first_model:]]
        unbounded = [(model, False) for model in LADDER[:-1] if self.units.scene.link]
        # Nearly dependent constraints at the start amplify rounding, perhaps above `tol`.
        slack = False
        if unbounded and (uncertainty := MODELS[choice.model].slack):
            start = np.concatenate([*self.units.scene.axes, *self.units.scene.rates])
            slack = bool(MOST_SLACK.value * np.finfo(float).eps * uncertainty(start[None])[0] > self.tol)
        tries = [*unbounded, *tries] if slack else [*tries, *unbounded]
        why = (
            f"near a dead point the rounding of the constraints of {choice.model} may exceed tol"
            if slack
            else choice.reason
        )
        evaluations, early = 1, list[tuple[str, str, EstimatedRun]]()  # `choose` evaluated the start
        refused: dict[str, IntegrationError | SingularError] = {}
        for model, bounded in tries:
            try:
                run = self.run(model, _REPLACEABLE, bounded)
                stopped: object = run.ending
                evaluations += run.evaluations
                early.append((model.name, why, replace(run, evaluations=evaluations)))
                if not run.ending.early:
                    return early[-1]
            except (IntegrationError, SingularError) as refusal:
                stopped = refused[model.name] = refusal
                evaluations += refusal.evaluations if isinstance(refusal, IntegrationError) else 0
            why = f"regular everywhere; {model.name}: {stopped}" if bounded else f"{why}; {model.name}: {stopped}"
        if not early:
            last = refused[LADDER[-1].name]
            if isinstance(last, IntegrationError):
                last.evaluations = evaluations
            raise last
        name, why, run = max(early, key=lambda row: (len(row[2].t), -float(row[2].errors[-1])))
        return name, why, replace(run, evaluations=evaluations)


def evolution_of(
    model: Model, scene: Scene, t_end: float, patience: EvaluationBudget, engine: str = "core", *, bounded: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Evolution:  # fmt: skip
    """Return the motion of a scene in natural units up to t_end by a model, with the measures of its error. With `bounded` the
    run stops where the model is badly conditioned."""
    engine = engine if _fast_runs(model, scene) else "core"
    nodes = pulse_nodes(scene, t_end)
    start = model.start(scene)

    def observed(states: Array) -> tuple[Array, Array]:
        found = model.observe(scene, states)
        return found.axes, found.rates

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        begin = float(times[0])
        elapsed = times - begin
        segment = without_idle_shock(scene.since(begin), float(elapsed[-1]))
        reporting_model = model if progress is None else replace(model, progress=lambda s: progress(begin + s))
        try:
            return integrate_model(reporting_model, segment, elapsed, local, engine, bounded, companion, start, budget)
        except StopError as stop:
            stop.at += begin
            raise

    def defect(times: Array, observed: Observed) -> Array:
        whole = nodes if nodes and nodes.t[-1] <= times[-1] else None
        return conservation_defect(without_idle_shock(scene, float(times[-1])), times, observed, whole)

    def distance(first: Observed, second: Observed) -> Array:
        return np.asarray(np.linalg.norm(first.axes - second.axes, axis=-1).max(axis=0))

    def difference(first: Observed, second: Observed) -> float:
        return float(np.abs(first.rates - second.rates).max(initial=0.0)) / PACE

    return Evolution(
        start,
        integrate,
        distance,
        turn=TURN,
        budget=patience,
        project=model.projection(scene) if model.projection else None,
        start_error=float(start_error(np.array(scene.axes), np.array(scene.rates), observed, start)),
        constraint_uncertainty=model.slack if scene.link else None,
        observe=lambda states: model.observe(scene, states),
        conservation_error=defect,
        difference=difference,
        watch=nodes.t if nodes else np.empty(0),
        singular=lambda y: model.singular(model.observe(scene, y[None]).axes[:, 0]),
        has_other_coordinates=bounded,
    )


def start_error(axes: Array, rates: Array, observed: Callable[[Array], tuple[Array, Array]], start: Array) -> Array:
    """Return the errors (…) of the initial states (…, d) of a model in units of the rounding error, at least 1.

    Near the joint line the bar hardly determines an axis, and the coordinates may represent another start than the given one,
    with the axes and rates (2, …, 3). `observed` returns the axes and rates (2, …, n, 3) of states (…, n, d). The error counts
    twice, since the response to a perturbation in one direction may be smaller than that to the actual one.
    """
    epsilons = 1e4  # one rounding step may change nothing
    unsure: Array = np.ones(start.shape[:-1])
    computed = observed(np.stack([start, perturbed_state(start, epsilons)], axis=-2))
    for target, values, unit in zip((axes, rates), computed, (1.0, PACE), strict=True):
        error = np.abs(values[..., 0, :] - target).max((0, -1)) / unit
        response = np.abs(values[..., 1, :] - values[..., 0, :]).max((0, -1)) / unit / epsilons
        moved = (error > _RESOLVED) & (response > 0)
        unsure = np.maximum(unsure, np.divide(2 * error, response, out=np.ones(error.shape), where=moved))
    return unsure


def _fast_runs(model: Model, scene: Scene) -> bool:
    """Return True if Taylor steps cannot pass a position at which the model's constraints fail."""
    return model.outside is None or scene.link is None
