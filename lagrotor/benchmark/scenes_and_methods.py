"""Speed against accuracy: every rung, solver and tolerance on the same scenes, held to the same reference."""

import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.compiled_solvers import CANDIDATES
from lagrotor.benchmark.peers import PEERS
from lagrotor.benchmark.runner import (
    PATIENCE,
    TOLERANCES,
    Chart,
    Course,
    Failure,
    Family,
    Method,
    Prepare,
    Run,
    chart,
    seconds_at,
)
from lagrotor.benchmark.scipy_solvers import ENGINES, TRAPS
from lagrotor.models.closed_form import closed_form
from lagrotor.models.simulate import simulate
from lagrotor.models.spring_link.run import paper_system, run_steps
from lagrotor.pair.examples import DAMPING, HEAVY, SCENES, STIFFNESS
from lagrotor.pair.scene import Link, Scene
from lagrotor.theory.natural_frequency import natural_rate
from lagrotor.theory.paired_precession.series_orbit import series_orbit

Array = NDArray[np.float64]

AMPLITUDE, ORDER = 0.204, 21  # the start lies on the periodic orbit to 1e-12
QUICK_PATIENCE = 0.2


def courses(quick: bool = False) -> dict[str, Course]:
    """The four scenes; quick: fewer repeats, and 100 turns for 1,000."""
    opposite, heavy = (series_orbit(Scene((10, -10), link=bar), AMPLITUDE, ORDER).start for bar in (Link(), HEAVY))
    ten, repeats, turns = np.linspace(0, 10, 1001), 1 if quick else 2, 100 if quick else 1000
    period = 2 * np.pi / natural_rate(opposite)
    shocked = SCENES["free-precession"].scene
    return {
        "displaced": Course(opposite, ten, repeats, f"paired precession, r0 = {AMPLITUDE}, 10 s"),
        "shock": Course(shocked, ten, repeats, "shock of 5.2.1 on a light bar, 10 s"),
        "heavy": Course(heavy, ten, repeats, "bar of 1 kg, 10 s"),
        "long": Course(opposite, np.linspace(0, turns * period, 1001), 1, f"paired precession, {turns:,} turns"),
    }


def _rung(model: str, engine: str = "core") -> Prepare:
    def prepare(scene: Scene, times: Array) -> Run:
        def run(tol: float) -> tuple[Array, int]:
            closed_form.cache_clear()  # no run knows of the one before: each meets its scene for the first time
            found = simulate(scene, times, model, tol, engine)
            return found.tips, found.evaluations

        return run

    return prepare


def _springs(stiffer: float) -> Prepare:
    """The paper's own method, its springs `stiffer` times as stiff at the same ratio of damping."""

    def prepare(scene: Scene, times: Array) -> Run:
        system = paper_system(scene, stiffer * STIFFNESS, stiffer**0.5 * DAMPING)

        def run(step: float) -> tuple[Array, int]:
            found = run_steps(system, scene.shock, times, step)
            return found.tips, found.evaluations

        return run

    return prepare


METHODS: dict[str, Method] = {
    "closed form": Method("closed", _rung("closed_form")),
    "normal modes": Method("closed", _rung("linear")),
    "minimal": Method("core", _rung("minimal")),
    "spheres": Method("core", _rung("spheres")),
    "euler": Method("core", _rung("euler")),
    **ENGINES,
    "minimal, fast": Method("fast", _rung("minimal", "fast")),
    "springs of the paper": Method("springs", _springs(1), (2e-3, 1e-3, 5e-4)),
    "springs, 100 times as stiff": Method("springs", _springs(100), (2e-4, 1e-4)),
}


# What is left out, in a hurry and of single scenes, and why; listed with what failed.
_ELSEWHERE = "takes seconds a run; see the displaced pair"
_SLOW = {
    "quick": {
        "minimal, CyRK": "compiles for six seconds",
        "minimal, numba": "slower than minimal, CyRK",
        "PyDy, lambdify": "slower than PyDy, Cython",
        "LagrangesMethod": "slower than PyDy, Cython",
        "Drake, SAP": "gives no digit in less than a second",
        "Drake, multipliers": "slower than Pinocchio, which is as exact",
        "euler": "slower than minimal, which goes as far",
        "springs, 100 times as stiff": "takes two seconds a run",
    }
    | {name: "slower than minimal" for name, given in ENGINES.items() if given.family == "scipy"},
    "heavy": dict.fromkeys(("solve_ivp, Radau", "solve_ivp, BDF"), _ELSEWHERE),
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


def charts(quick: bool = False, step: Callable[[str], None] = lambda name: None) -> list[Chart]:
    """All four charts: candidates and peers on the displaced scene, the plain calls on the shock."""
    patience = QUICK_PATIENCE if quick else PATIENCE
    found = []
    for name, course in courses(quick).items():
        step(name)
        methods = METHODS | {"displaced": CANDIDATES | PEERS, "shock": TRAPS}.get(name, {})
        slow = _SLOW.get(name, {}) | (_SLOW["quick"] if quick else {})
        left_out = {method: why for method, why in slow.items() if method in methods}
        asked = TOLERANCES[:: 5 if quick else 2 if name == "long" else 1]
        with warnings.catch_warnings():  # what a solver warns of, it fails of, or its error shows
            warnings.simplefilter("ignore")
            one = chart(name, course, {m: g for m, g in methods.items() if m not in left_out}, asked, patience)
        omitted = tuple(Failure(method, (), f"left out: {why}") for method, why in left_out.items())
        found.append(replace(one, failures=one.failures + omitted))
    return found


# What others are held to: the best rung of the core packages, the closed form included, and the best integrations.
LADDERS: dict[str, tuple[Family, ...]] = {"any rung": ("closed", "core"), "core": ("core",), "fast": ("fast",)}


def ratios(found: Chart, errors: Iterable[float] = (1e-6, 1e-8, 1e-10, 1e-12, 1e-13)) -> dict[str, dict[str, Any]]:
    """Error → seconds of each of LADDERS, and the best of others as multiples of them; None where one does not get there.

    "any rung" and "core" take the four core packages alone, "core" and "fast" integrate.
    """
    by = {name: [p for p in found.points if p.family in families] for name, families in LADDERS.items()}
    others = {name: [p for p in found.points if p.method == name] for name in (*CANDIDATES, *PEERS)}
    table = {}
    for error in errors:
        ours = {name: seconds_at(points, error) for name, points in by.items()}
        row: dict[str, Any] = ours | {"core / fast": _over(ours["core"], ours["fast"])}
        for name, points in others.items():
            theirs = seconds_at(points, error)
            row |= {f"{name} / {ladder}": _over(theirs, spent) for ladder, spent in ours.items()}
        table[f"{error:g}"] = row
    return table


def _over(theirs: float | None, ours: float | None) -> float | None:
    return theirs / ours if theirs and ours else None
