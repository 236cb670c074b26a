"""Speed against accuracy: every rung, solver and tolerance on the same scenes, held to the same reference."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import product
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, LagrotorError
from ..models import minimal
from ..models.simulate import problem_of, simulate
from ..numerics.engines import Stretch, adams, dop853
from ..rotors.closed_forms import natural_rate
from ..rotors.consistent import paired_scene
from ..rotors.parameters import Scene
from ..rotors.scenes import HEAVY, SCENES
from .peers import PEERS
from .reference import reference

Array = NDArray[np.float64]
Method = Callable[[float], tuple[Array, int]]
Prepare = Callable[[Scene, Array], Method]

AMPLITUDE = 0.204
TOLERANCES = tuple(10.0**-n for n in range(3, 14))


@dataclass(frozen=True)
class Point:
    """One method at one tolerance: largest error of a tip (m; the reference's floor where it is below), evaluations,
    median seconds a run."""

    method: str
    tol: float
    error: float
    evaluations: int
    seconds: float


@dataclass(frozen=True)
class Chart:
    """A scene's points; what failed or is absent, and why; seconds before each method's first result; the floor (m)."""

    scene: str
    says: str
    points: tuple[Point, ...]
    failures: dict[str, str]
    setup: dict[str, float]
    floor: float


@dataclass(frozen=True)
class Course:
    """A scene to run, its times (s), how often each run is repeated, and a sentence."""

    scene: Scene
    times: Array
    repeats: int
    says: str


def courses(quick: bool = False) -> dict[str, Course]:
    """The four scenes; quick: fewer repeats, and 100 turns for 1,000."""
    opposite = paired_scene(Scene((10, -10)), AMPLITUDE)
    ten, repeats, turns = np.linspace(0, 10, 1001), 2 if quick else 3, 100 if quick else 1000
    period = 2 * np.pi / natural_rate(opposite)
    shocked = SCENES["free-precession"].scene
    return {
        "displaced": Course(opposite, ten, repeats, f"paired precession, r0 = {AMPLITUDE}, 10 s"),
        "shock": Course(shocked, ten, repeats, "shock of 5.2.1 on a light bar, 10 s"),
        "heavy": Course(paired_scene(Scene((10, -10), link=HEAVY), AMPLITUDE), ten, repeats, "bar of 1 kg, 10 s"),
        "long": Course(opposite, np.linspace(0, turns * period, 1001), 1, f"paired precession, {turns:,} turns"),
    }


def _rung(model: str, engine: str = "core") -> Prepare:
    def prepare(scene: Scene, times: Array) -> Method:
        def run(tol: float) -> tuple[Array, int]:
            found = simulate(scene, times, model, tol, engine)
            return found.tips, found.evaluations

        return run

    return prepare


def _solver(engine: Callable[[Stretch, float], Any]) -> Prepare:
    def prepare(scene: Scene, times: Array) -> Method:
        problem = problem_of(minimal.MODEL, scene, float(times[-1]))
        if problem.driven is not None:
            raise InputError("takes no pulse")
        stretch = Stretch(problem.free, problem.start, 0.0, float(times[-1]), times)

        def run(tol: float) -> tuple[Array, int]:
            found = engine(stretch, tol)
            axes = minimal.MODEL.observe(scene, found.states).axes
            return _tips(scene, axes), found.evaluations

        return run

    return prepare


def _tips(scene: Scene, axes: Array) -> Array:
    half = (scene.link.length if scene.link else scene.rotor.length) / 2
    return np.array([[[-half, 0, 0]], [[half, 0, 0]]]) + scene.rotor.length * axes


METHODS: dict[str, Prepare] = {
    "closed form": _rung("closed_form"),
    "normal modes": _rung("linear"),
    "minimal": _rung("minimal"),
    "spheres": _rung("spheres"),
    "euler": _rung("euler"),
    "minimal, DOP853": _solver(dop853),
    "minimal, Adams 12": _solver(adams),
    "minimal, fast": _rung("minimal", "fast"),
    "spheres, fast": _rung("spheres", "fast"),
}


def chart(name: str, course: Course, methods: dict[str, Prepare], tolerances: Iterable[float] = TOLERANCES) -> Chart:
    """Run every method at every tolerance, all of them once before any of them again; medians of the seconds."""
    truth = reference(course.scene, course.times)
    failures, setup, ready = {}, {}, {}
    tolerances = tuple(tolerances)
    for method, prepare in methods.items():
        began = time.perf_counter()
        try:
            run = prepare(course.scene, course.times)
            run(tolerances[0])
            ready[method] = run
            setup[method] = time.perf_counter() - began
        except ImportError as absent:
            failures[method] = f"not installed ({absent.name}): pip install 'lagrotor[peers]'"
        except LagrotorError as refusal:
            failures[method] = str(refusal)
    errors: dict[tuple[str, float], tuple[float, int]] = {}
    seconds: dict[tuple[str, float], list[float]] = {}
    for turn, tol, method in product(range(course.repeats + 1), tolerances, ready):
        key = method, tol
        if turn and key not in errors:
            continue
        began = time.perf_counter()
        try:
            tips, evaluations = ready[method](tol)
        except (LagrotorError, RuntimeError, ValueError) as refusal:
            failures[f"{method}, tol {tol:g}"] = str(refusal).split("\n")[0]
            continue
        spent = time.perf_counter() - began
        if turn == 0:  # warms up and compiles; counted only where there is no second run
            error = max(float(np.linalg.norm(tips - truth.tips, axis=-1).max()), truth.floor)
            if not np.isfinite(error):
                failures[f"{method}, tol {tol:g}"] = "a value is not finite"
                continue
            errors[key] = error, evaluations
        else:
            seconds.setdefault(key, []).append(spent)
    points = (Point(m, tol, *errors[m, tol], median(seconds[m, tol])) for m, tol in errors if (m, tol) in seconds)
    return Chart(name, course.says, tuple(points), failures, setup, truth.floor)


# What is left out for its time: long set-ups when in a hurry, DOP853 in Python over a thousand turns.
_SLOW: dict[str, set[str]] = {
    "quick": {"spheres, fast", "PyDy, lambdify"},
    "displaced": set(),
    "shock": set(),
    "heavy": set(),
    "long": {"minimal, DOP853"},
}


def charts(quick: bool = False, step: Callable[[str], None] = lambda name: None) -> list[Chart]:
    """All four charts, the peers on the displaced scene."""
    tolerances = TOLERANCES[::4] + TOLERANCES[-1:] if quick else TOLERANCES
    found = []
    for name, course in courses(quick).items():
        step(name)
        left_out = _SLOW[name] | (_SLOW["quick"] if quick else set())
        offered = METHODS | PEERS if name == "displaced" else METHODS
        methods = {method: prepare for method, prepare in offered.items() if method not in left_out}
        found.append(chart(name, course, methods, tolerances[::2] if name == "long" and not quick else tolerances))
    return found


def front(points: Iterable[Point], work: str = "seconds") -> list[Point]:
    """The points that no other beats both in error and in work, from the cheapest to the most exact."""
    kept: list[Point] = []
    for point in sorted(points, key=lambda p: (getattr(p, work), p.error)):
        if not kept or point.error < kept[-1].error:
            kept.append(point)
    return kept


def seconds_at(points: Iterable[Point], error: float) -> float | None:
    """Seconds for an error (m), between the neighbours of the front on logarithmic scales; None where none reaches it."""
    best = front(points)
    if not best or best[-1].error > error:
        return None
    errors, spent = (np.log([getattr(p, name) for p in reversed(best)]) for name in ("error", "seconds"))
    return float(np.exp(np.interp(np.log(error), errors, spent)))


def ratios(found: Chart, errors: Iterable[float] = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)) -> dict[str, dict[str, Any]]:
    """Error → seconds of the core's and the fast extra's best integration, and each peer's best as a multiple of them."""
    core = [p for p in found.points if p.method.startswith(("minimal", "spheres", "euler")) and "fast" not in p.method]
    fast = [p for p in found.points if p.method.endswith(", fast")]
    others = {name: [p for p in found.points if p.method == name] for name in (*PEERS, "closed form")}
    table: dict[str, dict[str, Any]] = {}
    for error in errors:
        ours, extra = seconds_at(core, error), seconds_at(fast, error)
        row: dict[str, Any] = {"core": ours, "fast": extra}
        for name, points in others.items():
            theirs = seconds_at(points, error)
            row[f"{name} / core"] = theirs / ours if theirs and ours else None
            row[f"{name} / fast"] = theirs / extra if theirs and extra else None
        row["core / fast"] = ours / extra if ours and extra else None
        table[f"{error:g}"] = row
    return table
