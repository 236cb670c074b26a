"""One scene, many methods: each at every knob, held to the reference; its points, what failed, and the front."""

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from statistics import median
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.reference import reference
from lagrotor.errors import LagrotorError
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
Run = Callable[[float], tuple[Array, int]]
Prepare = Callable[[Scene, Array], Run]
Family = Literal["closed", "core", "fast", "scipy", "springs", "candidate", "peer", "trap"]


TOLERANCES = tuple(10.0**-n for n in range(3, 14))
# A method is not asked for more once a run took as long (s); one that takes a tenth of it is timed once.
PATIENCE = 2.0
# A run is repeated, one after another, until that long (s): a millisecond by itself is a measure of what ran before it.
SAMPLE = 0.01
# Processor time, which other work on the machine does not lengthen, where it ticks finely enough.
_CLOCK = time.process_time if time.get_clock_info("process_time").resolution < 1e-6 else time.perf_counter
_COMPILING = "closed", "fast"  # a first run may derive or compile
_REFUSALS = LagrotorError, RuntimeError, ValueError


@dataclass(frozen=True)
class Method:
    """prepare(scene, times) → run(knob) → tips (2, n, 3) in m, and evaluations.

    The knob is a tolerance, or one of `steps` (s) for what goes in equal steps; `extra`: what of pyproject installs it.
    """

    family: Family
    prepare: Prepare
    steps: tuple[float, ...] = ()
    extra: str = ""


def tips(scene: Scene, axes: Array) -> Array:
    """Tips (2, n, 3) in m of axes (2, n, 3)."""
    half = (scene.link.length if scene.link else scene.rotor.length) / 2
    return np.array([[[-half, 0, 0]], [[half, 0, 0]]]) + scene.rotor.length * axes


@dataclass(frozen=True)
class Point:
    """One method at one knob, a tolerance or a step in s: largest error of a tip (m; the reference's floor where it is
    below), evaluations, median over samples of the seconds of processor time a run, and those of the first, which may
    compile."""

    method: str
    family: Family
    knob: float
    error: float
    evaluations: int
    seconds: float
    first: float


@dataclass(frozen=True)
class Failure:
    """A method that gave no point at some knobs, or at all (none), and why."""

    method: str
    knobs: tuple[float, ...]
    reason: str

    def __str__(self) -> str:
        at = ", ".join(f"{knob:g}" for knob in self.knobs)
        return f"{self.method} at {at}: {self.reason}" if at else f"{self.method}: {self.reason}"


@dataclass(frozen=True)
class Chart:
    """A scene's points and failures, seconds that each method takes to get ready, and the reference's floor (m)."""

    scene: str
    says: str
    points: tuple[Point, ...]
    failures: tuple[Failure, ...]
    setup: dict[str, float]
    floor: float


@dataclass(frozen=True)
class Course:
    """A scene to run, its times (s), how many samples are taken of each run after the first, and a sentence."""

    scene: Scene
    times: Array
    repeats: int
    says: str


@dataclass(frozen=True)
class _Ready:
    """A method that is prepared: its run, its knobs from crude to fine, and the seconds that it took to get there."""

    run: Run
    knobs: tuple[float, ...]
    seconds: float


# Method, the knob or none, and the reason.
_Failed = list[tuple[str, float | None, str]]


def chart(
    name: str,
    course: Course,
    methods: dict[str, Method],
    tolerances: Iterable[float] = TOLERANCES,
    patience: float = PATIENCE,
) -> Chart:
    """Run every method at every knob, all of them once before any of them again; medians of the samples' seconds."""
    truth = reference(course.scene, course.times)
    failed: _Failed = []
    ready = _get_ready(course, methods, tuple(tolerances), failed)
    deepest = max((len(one.knobs) for one in ready.values()), default=0)
    turns = [(method, one.knobs[i]) for i in range(deepest) for method, one in ready.items() if i < len(one.knobs)]

    found: dict[tuple[str, float], tuple[float, int]] = {}
    seconds: dict[tuple[str, float], list[float]] = {}
    tired: dict[str, str] = {}
    for method, knob in turns:
        if method in tired:
            failed.append((method, knob, tired[method]))
            continue
        try:
            tips, evaluations, spent = _timed(ready[method].run, knob)
        except _REFUSALS as refusal:
            failed.append((method, knob, str(refusal).split("\n")[0]))
            continue
        if spent > patience and methods[method].family not in _COMPILING:
            tired[method] = f"left out: at {knob:g} a run took {spent:.1f} s"
        error = float(np.linalg.norm(tips - truth.tips, axis=-1).max())
        if np.isfinite(error):
            found[method, knob], seconds[method, knob] = (max(error, truth.floor), evaluations), [spent]
        else:
            failed.append((method, knob, "a value is not finite"))
    again = [
        (method, knob)
        for method, knob in found
        if methods[method].family in _COMPILING or seconds[method, knob][0] < patience / 10
    ]
    for method, knob in again * course.repeats:
        seconds[method, knob].append(_sample(ready[method].run, knob))

    points = []
    for (method, knob), (error, evaluations) in found.items():
        first, *later = seconds[method, knob]
        usual = median(later or [first])
        points.append(Point(method, methods[method].family, knob, error, evaluations, usual, first))
    setup = {
        method: one.seconds + max([0.0, *(p.first - p.seconds for p in points if p.method == method)])
        for method, one in ready.items()
    }
    return Chart(name, course.says, tuple(points), _grouped(failed, ready), setup, truth.floor)


def _get_ready(
    course: Course, methods: dict[str, Method], tolerances: tuple[float, ...], failed: _Failed
) -> dict[str, _Ready]:
    """Prepare each method and run it once at its crudest; what cannot be prepared goes to `failed`."""
    ready = {}
    for method, given in methods.items():
        began, knobs = time.perf_counter(), given.steps or tolerances
        try:
            run = given.prepare(course.scene, course.times)
            with suppress(*_REFUSALS):  # to fail again, and be listed, when its turn comes
                run(knobs[0])
            ready[method] = _Ready(run, knobs, time.perf_counter() - began)
        except ImportError as absent:
            failed.append((method, None, f"not installed ({absent.name}): pip install 'lagrotor[{given.extra}]'"))
        except LagrotorError as refusal:
            failed.append((method, None, str(refusal)))
    return ready


def _timed(run: Run, knob: float) -> tuple[Array, int, float]:
    began = _CLOCK()
    tips, evaluations = run(knob)
    return tips, evaluations, _CLOCK() - began


def _sample(run: Run, knob: float) -> float:
    """Seconds a run, of as many as SAMPLE holds, and at least one."""
    began, runs, spent = _CLOCK(), 0, 0.0
    while spent < SAMPLE:
        run(knob)
        runs, spent = runs + 1, _CLOCK() - began
    return spent / runs


def _grouped(failed: _Failed, ready: dict[str, _Ready]) -> tuple[Failure, ...]:
    """One failure a method and reason; without knobs where it is all of them."""
    grouped = []
    for (method, reason), group in groupby(sorted(failed, key=lambda f: (f[0], f[2])), key=lambda f: (f[0], f[2])):
        at = tuple(knob for _, knob, _ in group if knob is not None)
        whole = method not in ready or len(at) == len(ready[method].knobs)
        grouped.append(Failure(method, () if whole else at, reason))
    return tuple(grouped)


def listed(failures: Iterable[Failure]) -> list[str]:
    """Sentences, one for all methods that share knobs and reason."""
    shared: dict[tuple[tuple[float, ...], str], list[str]] = {}
    for failure in failures:
        shared.setdefault((failure.knobs, failure.reason), []).append(failure.method)
    return [str(Failure("; ".join(methods), *key)) for key, methods in shared.items()]


def front(points: Iterable[Point], work: str = "seconds") -> list[Point]:
    """The points that no other beats both in error and in work, from the cheapest to the most exact; traps left out."""
    kept: list[Point] = []
    for point in sorted(points, key=lambda p: (getattr(p, work), p.error)):
        if point.family != "trap" and (not kept or point.error < kept[-1].error):
            kept.append(point)
    return kept


def seconds_at(points: Iterable[Point], error: float) -> float | None:
    """Seconds for an error (m), between the neighbours of the front on logarithmic scales; None where none reaches it."""
    best = front(points)
    if not best or best[-1].error > error:
        return None
    errors, spent = (np.log([getattr(p, name) for p in reversed(best)]) for name in ("error", "seconds"))
    return float(np.exp(np.interp(np.log(error), errors, spent)))
