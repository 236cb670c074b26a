"""The benchmark's scenes and methods: every model and solver runs at every tolerance and is compared with the same reference."""

import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from lagrotor.benchmark.runner import (
    LONGEST_QUICK_RUN,
    LONGEST_RUN,
    TOLERANCES,
    Benchmark,
    Case,
    Failure,
    Family,
    Method,
    Prepare,
    Runner,
    benchmark,
    work_at,
)
from lagrotor.benchmark.scipy_solvers import ENGINES, TRAPS
from lagrotor.errors import LagrotorWarning
from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import run_steps
from lagrotor.models.spring_link.system import paper_system
from lagrotor.numerics.arrays import Array
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, SCENES, STIFFNESS
from lagrotor.pair.scene import Link, Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series_orbit import series_orbit

AMPLITUDE, SERIES_ORDER = 0.204, 21  # the start lies on the periodic orbit to 1e-12
_TEN = np.linspace(0, 10, 1001)


def _long_case(quick: bool) -> Case:
    scene, turns = _scene_on_orbit(Link()), 100 if quick else 1000
    t_eval = np.linspace(0, turns * 2 * np.pi / natural_rate(scene), 1001)
    return Case(scene, t_eval, 1, f"paired precession, {turns:,} turns")


def _scene_on_orbit(bar: Link) -> Scene:
    return series_orbit(Scene((10, -10), link=bar), AMPLITUDE, SERIES_ORDER).start


def _ten_seconds(scene: Scene, quick: bool, says: str) -> Case:
    return Case(scene, _TEN, 1 if quick else 2, says)


# Name → function of `quick`, which takes fewer repeats, and 100 turns for 1,000. A start on the orbit costs a series.
CASES: dict[str, Callable[[bool], Case]] = {
    "displaced": lambda quick: _ten_seconds(
        _scene_on_orbit(Link()), quick, f"paired precession, r0 = {AMPLITUDE}, 10 s"
    ),
    "shock": lambda quick: _ten_seconds(SCENES["free-precession"].scene, quick, "shock of 5.2.1 on a light bar, 10 s"),
    "heavy": lambda quick: _ten_seconds(_scene_on_orbit(HEAVY_LINK), quick, "bar of 1 kg, 10 s"),
    "long": _long_case,
}


def _model(model: str, engine: str = "core") -> Prepare:
    def prepare(scene: Scene, t_eval: Array) -> Runner:
        def run(tol: float) -> tuple[Array, int]:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", LagrotorWarning)  # the chart shows the true error
                trajectory = simulate(scene, t_eval, model, tol, engine)
            return trajectory.tips, trajectory.evaluations

        return run

    return prepare


def _springs(stiffer: float) -> Prepare:
    """Return the paper's own method with springs that are `stiffer` times as stiff and have the same damping ratio."""

    def prepare(scene: Scene, t_eval: Array) -> Runner:
        system = paper_system(scene, stiffer * STIFFNESS, stiffer**0.5 * DAMPING)

        def run(step: float) -> tuple[Array, int]:
            spring_run = run_steps(system, scene.shock, t_eval, step)
            return spring_run.tips, spring_run.evaluations

        return run

    return prepare


METHODS: dict[str, Method] = {
    "closed form": Method("closed", _model("closed_form")),
    "normal modes": Method("closed", _model("linear")),
    "minimal": Method("core", _model("minimal")),
    "spheres": Method("core", _model("spheres")),
    "euler": Method("core", _model("euler")),
    **ENGINES,
    "minimal, fast": Method("fast", _model("minimal", "fast")),
    "springs of the paper": Method("springs", _springs(1), (2e-3, 1e-3, 5e-4)),
    "springs, 100 times as stiff": Method("springs", _springs(100), (2e-4, 1e-4)),
}


# Methods that quick runs or single cases omit, with the reason; they are listed with the failures.
_ELSEWHERE = "takes seconds a run; see the displaced pair"
_LEFT_OUT = {
    "quick": {
        "euler": "slower than minimal, which goes as far",
        "springs, 100 times as stiff": "takes two seconds a run",
    }
    | {name: "slower than minimal" for name, engine in ENGINES.items() if engine.family == "scipy"},
    "long": dict.fromkeys(
        (
            "minimal, DOP853",
            "solve_ivp, RK45",
            "solve_ivp, Radau",
            "solve_ivp, BDF",
            "ode, DOP853",
            "ode, Dormand–Prince 5",
        ),
        _ELSEWHERE,
    ),
}


def benchmarks(quick: bool = False, step: Callable[[str], None] = lambda name: None) -> list[Benchmark]:
    """Run the methods on all four cases, and on the shock also the plain solver calls of TRAPS. The function `step` is called
    with the name of each case."""
    longest = (LONGEST_QUICK_RUN if quick else LONGEST_RUN).value
    charts = []
    for name, case in CASES.items():
        step(name)
        methods = METHODS | (TRAPS if name == "shock" else {})
        slow = _LEFT_OUT.get(name, {}) | (_LEFT_OUT["quick"] if quick else {})
        left_out = {method: why for method, why in slow.items() if method in methods}
        tolerances = TOLERANCES[:: 5 if quick else 2 if name == "long" else 1]
        with warnings.catch_warnings():  # a solver that warns fails, or its error shows why
            warnings.simplefilter("ignore")
            included = {method: entry for method, entry in methods.items() if method not in left_out}
            chart = benchmark(name, case(quick), included, tolerances, longest)
        omitted = tuple(Failure(method, (), f"left out: {why}") for method, why in left_out.items())
        charts.append(replace(chart, failures=chart.failures + omitted))
    return charts


# Families of lagrotor's methods: all models, integrations with the core packages, integrations with the fast extra.
OURS: dict[str, tuple[Family, ...]] = {"any model": ("closed", "core"), "core": ("core",), "fast": ("fast",)}


def ratios(chart: Benchmark, errors: Iterable[float] = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)) -> dict[str, dict[str, Any]]:
    """Return, for each error in m, the time in s of the best method of each group of OURS, and the ratio of core to fast. A value
    is None if no method reaches the error."""
    points = {name: [p for p in chart.points if p.family in families] for name, families in OURS.items()}
    table = {}
    for error in errors:
        ours = {name: work_at(of, error) for name, of in points.items()}
        core, fast = ours["core"], ours["fast"]
        table[f"{error:g}"] = ours | {"core / fast": core / fast if core and fast else None}
    return table
