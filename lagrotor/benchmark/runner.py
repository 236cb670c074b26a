"""Benchmarks of one scene: each method is run at every setting and compared with the reference. The results are points, failures
and the Pareto front."""

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from math import inf
from statistics import median
from typing import Any, Literal

import numpy as np

from lagrotor.errors import LagrotorError
from lagrotor.models import minimal, spheres
from lagrotor.models.model import integrate_model
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.solver_constants import Calibrated
from lagrotor.pair.scene import Scene

Runner = Callable[[float], tuple[Array, int]]
Prepare = Callable[[Scene, Array], Runner]
Family = Literal["closed", "core", "fast", "scipy", "springs", "compiled", "peer", "trap"]

TOLERANCES = tuple(10.0**-n for n in range(3, 14))
LONGEST_RUN = Calibrated(
    2.0,
    "s: after a longer run a method is not run at a finer setting; runs of up to a tenth of it are repeated",
    "all methods on four scenes: the slowest, implicit ones take minutes at 1e-13",
    "test_runner.py::test_a_method_that_takes_long_is_not_run_at_finer_settings",
)
LONGEST_QUICK_RUN = Calibrated(
    0.2,
    "s: after a longer run of `lagrotor chart --quick` a method is not run at a finer setting",
    "all methods on four scenes: the whole then takes about half a minute",
    "test_scenes_and_methods.py::test_what_is_left_out_is_listed",
)
SAMPLE = Calibrated(
    0.01,
    "s for which a run is repeated to time it, since a single run of a millisecond depends on earlier runs",
    "the minimal model, whose runs take 3 to 30 ms: ten samples of it agree to 5 %",
    "test_runner.py::test_a_short_run_is_repeated_until_a_sample_is_full_and_a_long_one_is_not",
)
LSODA_LEAST = Calibrated(
    3e-14,
    "tolerance below which LSODA does not start",
    "scipy's odeint and ode",
    "test_limits.py::test_solvers_keep_an_orbit",
)


def check_work(
    run: str, evaluations: float, states: Any, error: float = 0.0, bound: float = inf, least: float = 1.0
) -> None:
    """Raise LagrotorError unless a run has at least `least` evaluations, a motion along axis 1 of `states`, and an error of at
    most `bound`."""
    motion = float((states.max(axis=1) - states.min(axis=1)).max())
    if not (evaluations >= least and motion > 0 and error <= bound):
        raise LagrotorError(
            f"{run}: the benchmark did not do its work: {evaluations:g} evaluations (at least {least:.3g}), "
            f"motion {motion:.3g}, error {error:.3g} (at most {bound:.3g})"
        )


@dataclass(frozen=True)
class Method:
    """A benchmarked method: its family, its settings, and the package that pip installs for it.

    The function `prepare` takes a scene and output times (n,) in s. It returns a function that takes a setting and returns the
    tips (2, n, 3) in m and the number of evaluations. A setting is a tolerance, or one of `steps` in s if the method has equal
    steps.
    """

    family: Family
    prepare: Prepare
    steps: tuple[float, ...] = ()
    install: str = ""


def tips(scene: Scene, axes: Array) -> Array:
    """Return the positions of the tips in m, shape (2, n, 3), of unit axes (2, n, 3)."""
    half = (scene.link.length if scene.link else scene.rotor.length) / 2
    return np.array([[[-half, 0, 0]], [[half, 0, 0]]]) + scene.rotor.length * axes


@dataclass(frozen=True)
class Case:
    """A scene to benchmark: its output times (n,) in s, how often a run is repeated after the first, and a description in
    words."""

    scene: Scene
    t_eval: Array
    repeats: int
    says: str


# Processor time does not depend on other processes; the wall clock is used if its resolution is too coarse.
_CLOCK = time.process_time if time.get_clock_info("process_time").resolution < 1e-6 else time.perf_counter
Work = Literal["seconds", "nfev"]
_COMPILING = "closed", "fast", "compiled"  # families whose first run may derive or compile
_REFUSALS = LagrotorError, RuntimeError, ValueError
_FLOOR = 1e-6  # m, the largest difference of the reference's two formulations


@dataclass(frozen=True)
class Reference:
    """The reference solution: its tips (2, n, 3) in m. `floor` is the largest distance in m between two formulations, which is
    their rounding error."""

    tips: Array
    floor: float


def reference(scene: Scene, t_eval: Array) -> Reference:
    """Compute a scene with the minimal model (six states) and the spheres model (twelve), both at the tolerance 1e-13.

    The result holds the tips by the minimal model, and the largest distance between the tips by the two models. For comparison,
    tests/benchmark/reference.json has 10 s of the displaced pair to thirty digits, by extrapolation. Raises LagrotorError if
    the pair does not move, or if the two models differ by more than _FLOOR.
    """
    runs = [(model, integrate_model(model, scene, t_eval, TIGHTEST)) for model in (minimal.MODEL, spheres.MODEL)]
    first, second = (tips(scene, model.observe(scene, run.states).axes) for model, run in runs)
    floor = float(np.linalg.norm(first - second, axis=-1).max())
    check_work("the reference", min(run.evaluations for _, run in runs), first, floor, _FLOOR)
    return Reference(first, floor)


@dataclass(frozen=True)
class ChartPoint:
    """One method at one setting, a tolerance or a step in s.

    `error` is the largest error of a tip in m, at least that of the reference. `nfev` counts evaluations of the right-hand
    side. `seconds` is the processor time of a run, the median of its samples; `first` is that of the first run, which may
    compile.
    """

    method: str
    family: Family
    setting: float
    error: float
    nfev: int
    seconds: float
    first: float


@dataclass(frozen=True)
class Failure:
    """The settings at which a method has no point, and the reason. If there are no settings, the method has no point at all."""

    method: str
    settings: tuple[float, ...]
    reason: str

    def __str__(self) -> str:
        at = ", ".join(f"{setting:g}" for setting in self.settings)
        return f"{self.method} at {at}: {self.reason}" if at else f"{self.method}: {self.reason}"


@dataclass(frozen=True)
class Benchmark:
    """The points and failures of all methods on a scene, the set-up time of each method in s, and the error of the reference in
    m."""

    scene: str
    says: str
    points: tuple[ChartPoint, ...]
    failures: tuple[Failure, ...]
    setup: dict[str, float]
    floor: float


def benchmark(
    name: str,
    case: Case,
    methods: dict[str, Method],
    tolerances: Iterable[float] = TOLERANCES,
    longest: float = LONGEST_RUN.value,
) -> Benchmark:
    """Run every method at every setting, from coarse to fine.

    After a run that takes more than `longest` seconds, a method is not run at finer settings. Raises LagrotorError if the
    reference or a method did no work.
    """
    truth, points, failures, setup = reference(case.scene, case.t_eval), list[ChartPoint](), list[Failure](), {}
    tolerances = tuple(tolerances)
    for method, entry in methods.items():
        began, settings = time.perf_counter(), entry.steps or tolerances
        try:
            runner = entry.prepare(case.scene, case.t_eval)
            with suppress(*_REFUSALS):  # the run below fails again and is recorded
                runner(settings[0])
        except ImportError as absent:
            failures.append(Failure(method, (), f"not installed ({absent.name}): pip install {entry.install}"))
            continue
        except LagrotorError as refusal:
            failures.append(Failure(method, (), str(refusal)))
            continue
        setup[method] = time.perf_counter() - began
        rows, reasons = _points(method, entry, runner, settings, case.repeats, truth, longest)
        setup[method] += max([0.0, *(p.first - p.seconds for p in rows)])
        points += rows
        for reason in sorted(set(reasons.values())):
            at = tuple(setting for setting, why in reasons.items() if why == reason)
            failures.append(Failure(method, () if len(at) == len(settings) else at, reason))
    failures.sort(key=lambda failure: (failure.method, failure.reason))
    return Benchmark(name, case.says, tuple(points), tuple(failures), setup, truth.floor)


def _points(
    name: str,
    method: Method,
    runner: Runner,
    settings: tuple[float, ...],
    repeats: int,
    truth: Reference,
    longest: float,
) -> tuple[list[ChartPoint], dict[float, str]]:
    """Return the points of a method, and for each setting without a point the reason."""
    points, reasons, slow = list[ChartPoint](), dict[float, str](), ""
    for setting in settings:
        if slow:
            reasons[setting] = slow
            continue
        try:
            began = _CLOCK()
            tips, nfev = runner(setting)
            first = _CLOCK() - began
        except _REFUSALS as refusal:
            reasons[setting] = str(refusal).split("\n")[0]
            continue
        if first > longest and method.family not in _COMPILING:
            slow = f"left out: at {setting:g} a run took {first:.1f} s"
        if tips.shape != truth.tips.shape:
            reasons[setting] = f"the run ended early, at {tips.shape[1]} of {truth.tips.shape[1]} times"
            continue
        error = float(np.linalg.norm(tips - truth.tips, axis=-1).max())
        if not np.isfinite(error):
            reasons[setting] = "a value is not finite"
            continue
        check_work(f"{name} at {setting:g}", nfev, truth.tips, least=0 if method.family == "closed" else 1)
        samples = repeats if method.family in _COMPILING or first < longest / 10 else 0
        seconds = median([_sample(runner, setting) for _ in range(samples)] or [first])
        points.append(ChartPoint(name, method.family, setting, max(error, truth.floor), nfev, seconds, first))
    return points, reasons


def _sample(runner: Runner, setting: float) -> float:
    """Return the processor time of a run in s, averaged over as many runs as take SAMPLE seconds, at least one."""
    began, runs, elapsed = _CLOCK(), 0, 0.0
    while elapsed < SAMPLE.value:
        runner(setting)
        runs, elapsed = runs + 1, _CLOCK() - began
    return elapsed / runs


def failure_sentences(failures: Iterable[Failure]) -> list[str]:
    """Return one sentence for each group of methods that fail at the same settings for the same reason."""
    shared: dict[tuple[tuple[float, ...], str], list[str]] = {}
    for failure in failures:
        shared.setdefault((failure.settings, failure.reason), []).append(failure.method)
    return [str(Failure("; ".join(methods), *key)) for key, methods in shared.items()]


def front(points: Iterable[ChartPoint], work: Work = "seconds") -> list[ChartPoint]:
    """Return the Pareto front in error and work, from the cheapest to the most accurate point, without the family "trap"."""
    best: list[ChartPoint] = []
    for point in sorted(points, key=lambda p: (getattr(p, work), p.error)):
        if point.family != "trap" and (not best or point.error < best[-1].error):
            best.append(point)
    return best


def work_at(points: Iterable[ChartPoint], error: float, work: Work = "seconds") -> float | None:
    """Return the work (time in s or evaluations) for an error in m, by logarithmic interpolation on the front. Return None if no
    point reaches the error."""
    best = front(points, work)
    if not best or best[-1].error > error:
        return None
    with np.errstate(divide="ignore"):  # the closed form takes no evaluation
        errors, works = (np.log([getattr(p, name) for p in reversed(best)]) for name in ("error", work))
    return float(np.exp(np.interp(np.log(error), errors, works)))
