"""`simulate`: a scene, times and a model in; a trajectory with its error estimate out."""

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
    ClosedMotion,
    Model,
    NaturalUnits,
    check_range,
    conservation_defect,
    constant_momenta,
    integrate_model,
    natural_units,
    pulse_nodes,
    typical_rate,
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

LADDER = (minimal.MODEL, spheres.MODEL)  # of `auto`: where one stops, the next runs the scene
MODELS: dict[str, Model] = {model.name: model for model in (*LADDER, euler.MODEL)}
_BY_NAME = EvaluationBudget(20_000, 250 * 2 * pi)
# Where a looser run may take its place: five times as many serve none better.
_REPLACEABLE = EvaluationBudget(1_000, 500 * 2 * pi)
LONG_RUN = Calibrated(
    300.0,
    "turns beyond which the averaged motion is tried before one is integrated",
    "turns that an integration follows in the time in which the normal form of order 8 is made",
    "test_averaged.py::test_auto_takes_it_for_long_runs",
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
    "95 of the recorded wide scenes beside the joint line: of 11 that unit vectors do not keep within tol, 9 begin by minimal",
    "test_wide_scenes.py::test_beside_a_dead_point_the_model_that_keeps_the_tolerance_is_taken",
)
_RESOLVED = 10 * np.finfo(float).eps  # of a start: all that it may be off without a reason of its own


# (scene, the run's last time, tol, whether to give the best there is, by name, or what `choose` took)
DIRECT: dict[str, Callable[[Scene, float, float, bool], ClosedMotion]] = {
    "closed_form": closed_form,
    "linear": linear_motion,
    "averaged": averaged_motion,
}


@dataclass(frozen=True)
class Choice:
    """model: its name. estimate: largest error of an axis over the run (tips: in units of R). reason: a sentence. motion: of a
    model without integration."""

    model: str
    estimate: float
    reason: str
    motion: ClosedMotion | None = field(default=None, repr=False, compare=False)


def choose(scene: Scene, t_end: float, tol: float, engine: str = "core") -> Choice:
    """The cheapest model whose axes stay within `tol` (tips: in units of R) of the exact ones from 0 to t_end (s).

    The errors of the closed forms and of the linear model are estimated analytically; no integration is needed. A short run
    of a pair with its bar takes engine = "fast" less time than that estimate, and is integrated at once. An integrated
    model is held to `tol` while it runs: see `lagrotor.numerics.error_estimate`.
    """
    turns, missed = typical_rate(scene) * t_end / (2 * pi), "a run too short to estimate the cheaper ones' errors"
    names = ["closed_form", "linear"] if engine == "core" or scene.link is None or turns > SHORT.value else []
    if scene.link and scene.spins[0] == -scene.spins[1] and turns > LONG_RUN.value:
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
    scene: Scene,
    t: ArrayLike,
    model: str = "auto",
    tol: float = 1e-9,
    engine: str = "core",
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Run `scene` from its start, which holds at t[0], through the times `t` (n,), in s.

    The trajectory carries `errors`, the estimated largest error of an axis up to each time, `horizon`, the time from which
    they exceed `tol`, and `ending`. A run is integrated twice, at two local errors, and held to what the motion conserves; a
    LagrotorWarning says when `tol` is not kept and what was reached, or that the run ended before its last time: it then
    holds the times up to there.

    Parameters
    ----------
    model : str, default 'auto'
        "closed_form", "linear", "averaged", "minimal", "spheres", "euler", or "auto": the cheapest that keeps the axes
        within `tol` of the exact ones over the run, named with its reason in the trajectory; see `choose`.
    tol : float, default 1e-09
        The largest error of an axis (a unit vector; tips: in units of R) over the whole run, 1e-13 to 0.1.
    engine : str, default 'core'
        "core", scipy's solvers and our own; "fast", heyoka's (`pip install lagrotor[fast]`), for "minimal", and for
        "spheres" where there is no bar. Never chosen silently: it compiles for a moment, and its last digits are others.
    progress : callable or None, optional
        Called with the time in s of each evaluation by the core; a solver's last step may go past the end, and each of
        the runs that are compared begins anew.

    Raises
    ------
    InputError
        A bad argument.
    SingularError
        A model's coordinates cannot hold the start.
    DomainError
        A closed form or the normal modes do not hold the scene.
    IntegrationError
        Nothing of the run could be computed, or it did not conserve what it must.

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
    at_zero = scene.since(float(times[0]))  # all that follows counts time from the start
    if model in tuple(DIRECT):  # a value without a hash is refused below
        motion = DIRECT[model](at_zero, float(times[-1] - times[0]), tolerance, True)
        error = "not known" if np.isnan(motion.error) else scientific(motion.error, 1)
        missed = not motion.error <= tolerance
        more = ", more than tol" if motion.error > tolerance else ""
        why = f"by name; {motion.reason}; estimated error {error}{more}"
        trajectory = _direct(scene, model, why, times, motion, tolerance)
        if missed:
            until = f"; tol is kept up to t = {trajectory.horizon:.6g} s" if motion.errors else ""
            said = f"simulate: {model} does not keep tol = {tolerance:g}: the estimated error is {error}{until}"
            warnings.warn(said, LagrotorWarning, stacklevel=2)
        return trajectory
    if model == "auto":
        choice = choose(at_zero, float(times[-1] - times[0]), tolerance, engine)
        if choice.motion:
            return _direct(scene, choice.model, choice.reason, times, choice.motion, tolerance)
    elif model not in tuple(MODELS):
        known = "auto", *DIRECT, *MODELS
        raise InputError(f"simulate: model = {model!r} is not one of {', '.join(known)}{near(model, known)}")
    elif engine == "fast" and not _fast_runs(MODELS[model], scene):
        raise InputError(
            f"simulate: engine='fast' does not run model={model!r} with this scene: a Taylor step may pass where its "
            "constraints fail; take minimal, or engine='core'"
        )
    # Time is counted from the pulse: one far off that is not felt is left out, it would only cost digits.
    duration = float(times[-1] - times[0])
    door = _Door(
        natural_units(replace(at_zero, shock=at_zero.shock_until(duration))), times, tolerance, engine, progress
    )
    if model == "auto":
        name, why, run = door.by_ladder(choice)
    else:
        name, why, run = model, "by name", door.run(MODELS[model], _BY_NAME)
    run.warn_unless_kept(name, tolerance)
    return trajectory_of(scene, door.units, name, why, times, run)


def trajectory_of(
    scene: Scene, units: NaturalUnits, model: str, why: str, times: Array, run: EstimatedRun
) -> Trajectory:
    """What a run of the model in natural units shows of the scene, at those of the times (n,) that it reached."""
    seen, n = MODELS[model].observe(units.scene, run.states), len(run.t)
    momenta = seen.momenta - constant_momenta(units.scene, n)
    # By the clock of the natural units the last time is off by rounding.
    ending = replace(run.ending, at=float(times[-1])) if run.ending.kind == "end" else run.ending
    return Trajectory(
        **run.run_fields | {"t": times[:n], "ending": ending}, scene=scene, model=model, why=why, axes=seen.axes,
        rates=seen.rates * units.rate, momenta=constant_momenta(scene, n) + momenta * units.inertia * units.rate,
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
class _Door:
    """A scene in natural units and how it is to be run: what the contract of runs needs of a model of it."""

    units: NaturalUnits
    times: Array
    tol: float
    engine: str
    progress: Callable[[float], None] | None

    def run(self, model: Model, patience: EvaluationBudget, bounded: bool = False) -> EstimatedRun:
        """The model's run; bounded: it ends where the model is badly conditioned, and another is at hand.

        Raises StopError, in s, where nothing is reached.
        """
        rate, begin = self.units.rate, float(self.times[0])
        t = (self.times - begin) * rate
        told = self.progress
        evolution = evolution_of(
            model,
            self.units.scene,
            float(t[-1]),
            patience,
            self.engine,
            bounded=bounded,
            progress=told and (lambda s: told(begin + s / rate)),
        )
        try:
            return estimate_run(evolution, t, self.tol).by_clock(begin, 1 / rate)
        except StopError as stop:
            at = begin + stop.at / rate
            raise StopError(at, stop.reason, evaluations=stop.evaluations, cause=stop.cause) from None
        except IntegrationError as refusal:
            refusal.args = (f"{model.name}: {refusal}",)
            raise

    def by_ladder(self, choice: Choice) -> tuple[str, str, EstimatedRun]:
        """The model that `auto` takes, why, and its run: the first of the ladder that reaches the end, from the chosen one on;
        else the one that comes farthest."""
        begun = [model.name for model in LADDER].index(choice.model)
        # Where none reaches the end, those before the last go on where they are badly conditioned.
        tries = [(model, model is not LADDER[-1]) for model in LADDER[begun:]]
        unbounded = [(model, False) for model in LADDER[:-1] if self.units.scene.link]
        # Whether the constraints are so nearly dependent at the start that rounding may exceed `tol`.
        slack, start = False, np.concatenate([*self.units.scene.axes, *self.units.scene.rates])
        if unbounded and (off := MODELS[choice.model].slack):
            slack = bool(MOST_SLACK.value * np.finfo(float).eps * off(start[None])[0] > self.tol)
        tries = [*unbounded, *tries] if slack else [*tries, *unbounded]
        why = (
            f"beside a dead point rounding of the constraints of {choice.model} may exceed tol"
            if slack
            else choice.reason
        )
        spent, early = 1, list[tuple[str, str, EstimatedRun]]()  # `choose` looked at the start
        refused: dict[str, IntegrationError | SingularError] = {}
        for model, bounded in tries:
            try:
                run = self.run(model, _REPLACEABLE, bounded)
                stopped: object = run.ending
                spent += run.evaluations
                early.append((model.name, why, replace(run, evaluations=spent)))
                if not run.ending.early:
                    return early[-1]
            except (IntegrationError, SingularError) as refusal:
                stopped = refused[model.name] = refusal
                spent += refusal.evaluations if isinstance(refusal, IntegrationError) else 0
            why = f"regular everywhere; {model.name}: {stopped}" if bounded else f"{why}; {model.name}: {stopped}"
        if not early:
            last = refused[LADDER[-1].name]
            if isinstance(last, IntegrationError):
                last.evaluations = spent
            raise last
        name, why, run = max(early, key=lambda each: (len(each[2].t), -float(each[2].errors[-1])))
        return name, why, replace(run, evaluations=spent)


def evolution_of(
    model: Model,
    scene: Scene,
    t_end: float,
    patience: EvaluationBudget,
    engine: str = "core",
    *,
    bounded: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Evolution:
    """What the contract of runs needs of a model of a scene in natural units, from 0 to t_end of its time.

    bounded: it ends where the model is badly conditioned, and another is at hand.
    """
    engine = engine if _fast_runs(model, scene) else "core"
    nodes = pulse_nodes(scene, t_end)
    start = model.start(scene)

    def integrate(start: Array, times: Array, local: float, companion: bool, budget: float) -> Stretch:
        begin = float(times[0])
        here, after = scene.since(begin), times - begin
        here = replace(here, shock=here.shock_until(float(after[-1])))
        shown = model if progress is None else replace(model, progress=lambda s: progress(begin + s))
        try:
            return integrate_model(shown, here, after, local, engine, bounded, companion, start, budget)
        except StopError as stop:
            stop.at += begin
            raise

    def defect(times: Array, states: Array) -> Array:
        felt = replace(scene, shock=scene.shock_until(float(times[-1])))
        whole = nodes if nodes and nodes.t[-1] <= times[-1] else None
        return conservation_defect(felt, times, model.observe(scene, states), whole)

    def distance(one: Array, other: Array) -> Array:
        apart = model.observe(scene, one).axes - model.observe(scene, other).axes
        return np.asarray(np.linalg.norm(apart, axis=-1).max(axis=0))

    def difference(one: Array, other: Array) -> float:
        apart = model.observe(scene, one).rates - model.observe(scene, other).rates
        return float(np.abs(apart).max(initial=0.0)) / PACE

    return Evolution(
        start,
        integrate,
        distance,
        turn=2 * pi / PACE,
        budget=patience,
        project=model.projection(scene) if model.projection else None,
        start_error=start_unsure(model, scene, start),
        constraint_uncertainty=model.slack if scene.link else None,
        conservation_error=defect,
        difference=difference,
        watch=nodes.t if nodes else np.empty(0),
        singular=lambda y: model.singular(model.observe(scene, y[None]).axes[:, 0]),
        has_other_coordinates=bounded,
    )


def start_unsure(model: Model, scene: Scene, start: Array) -> float:
    """How far, in units of rounding, the model's start (d,) is off the scene's: beside the joint line the bar hardly says where
    an axis on it is, and coordinates made for the bar may take another than the nearest."""
    unsure, many = 1.0, 1e4  # a step of rounding itself may move nothing
    seen = model.observe(scene, np.array([start, perturbed_state(start, many)]))
    for given, part, unit in ((scene.axes, seen.axes, 1.0), (scene.rates, seen.rates, PACE)):
        off = float(np.abs(part[:, 0] - given).max()) / unit
        moved = float(np.abs(part[:, 1] - part[:, 0]).max()) / unit / many
        unsure = max(unsure, off / moved) if off > _RESOLVED and moved > 0 else unsure
    return unsure


def _fast_runs(model: Model, scene: Scene) -> bool:
    """Return whether Taylor steps cannot pass a position at which the model's constraints fail."""
    return model.outside is None or scene.link is None
