"""What every run promises, by whatever door it comes: one set of tests that all of them inherit.

Each door runs motions that are known to 64 bits, made by hand-written equations and an extrapolated integration of the tests'
own (`references`, `extended`): no solver of the package takes part.
"""

import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Rotor, Scene, Structure, Trajectory, consistent_scene, simulate, sweep
from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.mechanics import System, SystemRun, coordinates
from lagrotor.mechanics.running import simulation as system_door
from lagrotor.models import averaged, paper_system, run_solver
from lagrotor.models.spring_link.run import SpringRun
from lagrotor.numerics import error_estimate
from lagrotor.numerics.error_estimate import EstimatedRun
from lagrotor.numerics.rotations import turn_about
from lagrotor.numerics.run import Ending, Run
from lagrotor.structures import StructureRun
from lagrotor.structures.exact import structure_run as structure_door
from tests.mechanics.running.references import EXTENDED, drawn, extrapolated
from tests.structures.extended import exact as exact_structure

pytestmark = pytest.mark.skipif(
    not EXTENDED, reason="the references need numbers of 64 bits, which this machine has not"
)
X = np.longdouble
scene_door = sys.modules[simulate.__module__]
ROUNDED = 1e-13  # an error that rounding alone may make
UNITS = (1.0, 1.0, 1.0), (7.3, 0.02, 411.0)  # mass, length, time


@dataclass(frozen=True)
class Case:
    """A motion: run: (tol, mass, length, time) → its run with those units so many times smaller; apart: of a run and the exact
    states, how far apart they are at each time; held: by how much it is off its constraints; load: what reads it back."""

    t: np.ndarray
    tol: float
    run: Callable[..., Run]
    exact: Callable[[], Any]
    apart: Callable[[Any, Any], np.ndarray]
    held: Callable[[Any], float]
    load: Callable[[Path], Run]


def scaled(scene: Scene, mass: float, length: float, time: float) -> Scene:
    """The same scene with those units so many times smaller."""
    rotor, link, inertia = scene.rotor, scene.link, mass * length**2
    return Scene(
        [w / time for w in scene.spins],
        Rotor(mass * rotor.mass, length * rotor.length, inertia * rotor.I1, inertia * rotor.I3),
        link and Link(length * link.length, mass * link.mass, inertia * link.inertia),
        None,
        scene.axes,
        np.array(scene.rates) / time,
    )


def lengthened(t: np.ndarray, times: float) -> np.ndarray:
    """Times that begin where these do and go on so many times as long."""
    return t[0] + times * (t - t[0])


def cross(a: Any, b: Any) -> Any:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def pair(seed: int, small: bool = False) -> tuple[Scene, np.ndarray, float]:
    """A leaning pair, anything from slow to fast, and a tolerance; small: of opposite spins, its axes nearly parallel."""
    rng, apart = np.random.default_rng([1, seed]), 0.05 if small else 1.0
    while True:
        inertia = rng.uniform(0.2, 1)
        rotor = Rotor(rng.uniform(0.3, 2), rng.uniform(0.5, 2), inertia, inertia * rng.uniform(0.4, 1.9))
        ell = rotor.length * rng.uniform(0.6, 1.8)
        link = Link(ell, *(rng.uniform(0.05, 0.5, 2) if rng.random() < 0.7 else (0.0, 0.0)))
        lean = rng.uniform(-0.4, 0.4, (2, 2))
        lean = np.column_stack([apart * lean + (1 - apart) * lean[0], np.ones(2)])
        spins = rng.choice([-1, 1], 2) * rng.uniform(2, 12, 2)
        spins = np.array([spins[0], -spins[0]]) if small else spins
        try:
            axes = lean / np.linalg.norm(lean, axis=1)[:, None]
            scene = consistent_scene(spins, axes, apart * rng.normal(size=(2, 3)), rotor, link)
        except LagrotorError:  # a lean that the bar does not allow
            continue
        turns, rate = rng.uniform(1, 4), max(np.abs(scene.momenta)) / rotor.J + np.abs(scene.rates).max()
        t = rng.uniform(-2, 2) + 2 * pi * turns / rate * np.array([0.0, 0.3, 0.55, 1.0])
        return scene, t, float(10 ** rng.uniform(-10, -4))


@cache
def exact_pair(seed: int, small: bool = False) -> Any:
    """Axes (2, n, 3) of `pair`."""
    scene, t, _ = pair(seed, small)
    assert scene.link is not None
    half = scene.link.length / 2
    same = Structure([(-half, 0), (half, 0)], [(0, 1)], scene.spins, scene.rotor, scene.link)
    return exact_structure(same, scene.axes, scene.rates, t - t[0])[0]


def axes_apart(run: Any, axes: Any) -> np.ndarray:
    return np.asarray(np.linalg.norm(run.axes - axes[:, : len(run.t)].astype(float), axis=-1).max(0))


def of_scene(model: str) -> Callable[[int], Case]:
    small = model == "averaged"

    def case(seed: int) -> Case:
        scene, t, tol = pair(seed, small)

        def run(tol: float, mass: float = 1.0, length: float = 1.0, time: float = 1.0, long: float = 1.0) -> Run:
            given = scaled(scene, mass, length, time)
            return (
                sweep([given, given], time * lengthened(t, long), tol).trajectory(1)
                if model == "sweep"
                else simulate(given, time * lengthened(t, long), model, tol)
            )

        def held(run: Any) -> float:
            units = np.abs(np.linalg.norm(run.axes, axis=-1) - 1).max()
            return max(
                float(units), float(np.abs(run.link_length - run.scene.link.length).max()) / run.scene.rotor.length
            )

        return Case(t, tol, run, lambda: exact_pair(seed, small), axes_apart, held, Trajectory.load)

    return case


def of_structure(seed: int) -> Case:
    """Three rotors in a row, under gravity, between two walls of numbers."""
    rng = np.random.default_rng([2, seed])
    s = Structure(
        [(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2)], list(rng.uniform(3, 12, 3)),
        Rotor(1, 1, rng.uniform(0.5, 1), rng.uniform(0.2, 1)), Link(1, 0.2, 0.05), gravity=9.81,
    )  # fmt: skip
    given = {"tilt": rng.uniform(-0.3, 0.3, (3, 2)), "rates": rng.normal(size=(3, 2))}
    t = rng.uniform(-2, 2) + rng.uniform(0.4, 1.2) * np.array([0.0, 0.3, 0.55, 1.0])

    def run(tol: float, mass: float = 1.0, length: float = 1.0, time: float = 1.0, long: float = 1.0) -> Run:
        inertia, rotor, link = mass * length**2, s.rotor[0], s.link[0]
        same = Structure(
            [(length * x, length * y) for x, y in s.joints],
            [(i, j) for i, j, _ in s.bars],
            [w / time for w in s.spins],
            Rotor(mass * rotor.mass, length * rotor.length, inertia * rotor.I1, inertia * rotor.I3),
            Link(1, mass * link.mass, inertia * link.inertia),
            gravity=s.gravity * length / time**2,
        )
        return same.simulate(time * lengthened(t, long), given["tilt"], given["rates"] / time, tol=tol)

    def exact() -> Any:
        start: Any = run(1e-3)
        return exact_structure(s, start.axes[:, 0], start.rates[:, 0], t)[0]

    def held(run: Any) -> float:
        size = run.structure.rotor[0].length
        return float(
            max(np.abs(np.linalg.norm(run.axes, axis=-1) - 1).max(), np.abs(run.link_length - size).max() / size)
        )

    return Case(t, float(10 ** rng.uniform(-10, -4)), run, exact, axes_apart, held, StructureRun.load)


def of_system(seed: int) -> Case:
    """A double pendulum of points in a plane: two lengths are constraints, the reference is by angles."""
    rng = np.random.default_rng([3, seed])
    c = coordinates("x_1 y_1 x_2 y_2")
    m1, m2, l1, l2, g = names = sp.symbols("m_1 m_2 l_1 l_2 g", positive=True)
    (x1, y1, x2, y2), v = c.q, c.v
    L = m1 * (v[0] ** 2 + v[1] ** 2) / 2 + m2 * (v[2] ** 2 + v[3] ** 2) / 2 - g * (m1 * y1 + m2 * y2)
    system = System(c, L, (x1**2 + y1**2 - l1**2, (x2 - x1) ** 2 + (y2 - y1) ** 2 - l2**2))
    numbers = [*rng.uniform(0.3, 2, 2), *rng.uniform(0.3, 1.5, 2), 9.81]
    M1, M2, R1, R2, G = (X(x) for x in numbers)
    begun = np.concatenate([rng.uniform(-1.5, 1.5, 2), rng.normal(size=2)])
    t = rng.uniform(-2, 2) + rng.uniform(0.5, 3) * np.array([0.0, 0.3, 0.55, 1.0])

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        (a, b, u, w), M = y, M1 + M2
        d, s = np.cos(a - b), np.sin(a - b)
        det = M - M2 * d * d
        f1 = -M2 * R2 / R1 * s * w * w - M * G / R1 * np.sin(a)
        f2 = R1 / R2 * s * u * u - G / R2 * np.sin(b)
        return np.array([u, w, (f1 - M2 * R2 / R1 * d * f2) / det, (M * f2 - R1 / R2 * d * f1) / det], X)

    def placed(y: Any) -> np.ndarray:
        lengths, angles, speeds = np.array([R1, R2], float), y[:2], y[2:]
        steps = [r * np.array([np.sin(a), -np.cos(a)]) for r, a in zip(lengths, angles, strict=True)]
        rates = [r * w * np.array([np.cos(a), np.sin(a)]) for r, a, w in zip(lengths, angles, speeds, strict=True)]
        return np.concatenate([steps[0], steps[0] + steps[1], rates[0], rates[0] + rates[1]])

    def run(tol: float, mass: float = 1.0, length: float = 1.0, time: float = 1.0, long: float = 1.0) -> Run:
        factors = [mass, mass, length, length, length / time**2]
        values = {name: f * x for name, f, x in zip(names, factors, numbers, strict=True)}
        start = placed(begun)
        return system.simulate(values, length * start[:4], length / time * start[4:], time * lengthened(t, long), tol)

    def apart(run: Any, exact: Any) -> np.ndarray:
        sizes = np.abs(exact).max(0)
        unit = run.scales.sizes / np.where(sizes > 0, sizes, 1)
        given = np.hstack([run.q, run.v])
        factor = np.array(
            [run.values[l1] / float(R1)] * 4 + [np.sqrt(run.values[l1] / float(R1) * run.values[g] / 9.81)] * 4
        )
        assert (unit / factor > 1e-3).all() and (unit / factor < 1e4).all()  # no error is hidden in a size
        return np.asarray(run.scales.distance(given, exact[: len(run.t)] * factor))

    def held(run: Any) -> float:
        return float(run.drift.max() / run.values[l1] ** 2 / max(1.0, run.values[g] / run.values[l1]) ** 0.5)

    return Case(
        t, float(10 ** rng.uniform(-10, -4)), run,
        lambda: np.array([placed(y) for y in extrapolated(rhs, begun, t)]), apart, held,
        lambda path: SystemRun.load(path, system),
    )  # fmt: skip


def of_springs(seed: int) -> Case:
    """The pair's three bodies on soft springs; the reference by Newton's and Euler's equations, body by body."""
    rng = np.random.default_rng([4, seed])
    scene, _, tol = pair(seed)
    if scene.link and not scene.link.mass:
        scene = replace(scene, link=Link(scene.link.length, 0.2, 0.05))
    S, D = float(rng.uniform(50, 400)), float(rng.choice([0.0, rng.uniform(0.5, 5)]))
    t = rng.uniform(-2, 2) + rng.uniform(0.1, 0.25) * np.array([0.0, 0.3, 0.55, 1.0])

    def system(mass: float, length: float, time: float) -> Any:
        return paper_system(scaled(scene, mass, length, time), S * mass / time**2, D * mass / time)

    def run(tol: float, mass: float = 1.0, length: float = 1.0, time: float = 1.0, long: float = 1.0) -> Run:
        return run_solver(system(mass, length, time), None, time * lengthened(t, long), tol)

    built = system(1.0, 1.0, 1.0)
    masses, inverse = 1 / built.inverse_mass[:3, 0].astype(X), built.inverse_inertia[:3].astype(X)
    arms = [np.asarray(part, X) for part in built.vertices]
    feet = [X(0.5) * np.array([-(scene.link.length if scene.link else 0), 0, 0], X), None]
    feet[1] = -feet[0]
    joints = [((1, 0), feet[1]), ((0, 0), feet[0]), ((0, 1), (2, 0)), ((1, 1), (2, 1))]

    def rhs(_: Any, y: np.ndarray) -> np.ndarray:
        (x, u, turning), R = y[:27].reshape(3, 3, 3), y[27:].reshape(3, 3, 3)
        omega = np.array([R[i] @ (inverse[i] @ (R[i].T @ turning[i])) for i in range(3)])
        force, torque = np.zeros((2, 3, 3), X)
        for one, other in joints:
            ends = [one, other] if isinstance(other, tuple) else [one]
            arm = [R[i] @ arms[i][k] for i, k in ends]
            places = [x[i] + a for (i, _), a in zip(ends, arm, strict=True)]
            speeds = [u[i] + cross(omega[i], a) for (i, _), a in zip(ends, arm, strict=True)]
            gap, rate = (
                (places[0] - places[1], speeds[0] - speeds[1]) if len(ends) > 1 else (places[0] - other, speeds[0])
            )
            pull = -X(S) * gap - X(D) * rate
            for (i, _), a, sign in zip(ends, arm, (1, -1), strict=False):
                force[i] += sign * pull
                torque[i] += sign * cross(a, pull)
        turned = np.array([cross(omega[i], R[i]) for i in range(3)])
        return np.concatenate([u.ravel(), (force / masses[:, None]).ravel(), torque.ravel(), turned.ravel()])

    def apart(run: Any, exact: Any) -> np.ndarray:
        places, turned = exact[:, :9].reshape(-1, 3, 3), exact[:, 27:].reshape(-1, 3, 3, 3)
        size = max(float(np.linalg.norm(part, axis=1).max()) for part in arms)
        factor = np.linalg.norm(run.tips[0, 0] - run.feet[0, 0]) / scene.rotor.length
        off = np.linalg.norm(run.centres.swapaxes(0, 1) / factor - places, axis=-1) / size
        about = np.linalg.norm((run.rotations.swapaxes(0, 1) - turned).reshape(-1, 3, 9), axis=-1)
        return np.asarray(np.maximum(off.max(1), about.max(1)))

    def held(run: Any) -> float:
        R = run.rotations  # as far from a rotation as half of what R R' lies from 1: (1 + d)(1 + d)' = 1 + d + d' + …
        return float(np.abs(R @ R.swapaxes(-1, -2) - np.eye(3)).max()) / 2

    def exact() -> Any:
        return extrapolated(rhs, built.state[:54], t)

    return Case(t, tol, run, exact, apart, held, SpringRun.load)


DOORS: dict[str, Callable[[int], Case]] = {
    "scene, minimal": of_scene("minimal"),
    "scene, spheres": of_scene("spheres"),
    "scene, auto": of_scene("auto"),
    "scene, averaged": of_scene("averaged"),
    "sweep": of_scene("sweep"),
    "structure": of_structure,
    "system": of_system,
    "springs": of_springs,
}
MANY = 45
LONG = dict.fromkeys(
    ("scene, minimal", "scene, spheres", "scene, auto", "scene, averaged", "system", "springs"), 30.0
)  # times as long: no 1e-13 is kept


@cache
def case_of(door: str, seed: int) -> Case:
    return DOORS[door](seed)


@cache
def exact_of(door: str, seed: int) -> Any:
    return case_of(door, seed).exact()


def quiet(case: Case, *given: float) -> tuple[Any, bool]:
    """A run, and whether it was announced that it does not keep what it should."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        run = case.run(*given)
    return run, any(w.category is LagrotorWarning for w in said)


@cache
def run_of(door: str, seed: int) -> tuple[Any, bool]:
    case = case_of(door, seed)
    return quiet(case, case.tol)


def check_the_start_holds_at_the_first_time(door: str, seed: int) -> None:
    case, (run, _) = case_of(door, seed), run_of(door, seed)
    assert run.t[0] == case.t[0] and (run.t == case.t).all()
    assert case.apart(run, exact_of(door, seed))[0] < 1e-11


def check_no_error_is_larger_than_it_is_told(door: str, seed: int) -> None:
    judge(door, seed, *run_of(door, seed))


def judge(door: str, seed: int, run: Any, said: bool) -> None:
    case = case_of(door, seed)
    true = case.apart(run, exact_of(door, seed))
    assert run.errors.shape == run.t.shape and (np.diff(run.errors) >= 0).all() and run.error == run.errors[-1]
    assert (true <= run.errors + ROUNDED).all(), (true, run.errors, case.tol)
    assert said or true.max() <= case.tol
    assert said or run.horizon == np.inf


def check_constraints(door: str, seed: int) -> None:
    run, _ = run_of(door, seed)
    assert case_of(door, seed).held(run) < max(run.error, 1e-12)


def check_the_ending(door: str, seed: int) -> None:
    run, _ = run_of(door, seed)
    assert run.ending == Ending("end", run.ending.at) and run.ending.at == pytest.approx(
        run.t[-1], rel=1e-14, abs=1e-14
    )
    assert not run.ending.early and run.evaluations > 0


def check_a_file_is_the_run(door: str, seed: int, tmp_path: Path) -> None:
    run, again = run_of(door, seed)[0], case_of(door, seed).load(run_of(door, seed)[0].save(tmp_path / "run.npz"))
    assert type(again) is type(run) and (again.t == run.t).all() and (again.errors == run.errors).all()
    assert (again.ending, again.horizon, again.evaluations) == (run.ending, run.horizon, run.evaluations)
    np.testing.assert_allclose(again.energy, run.energy, rtol=1e-12, atol=1e-12)
    header = run.save(tmp_path / "run.csv").read_text().splitlines()
    assert len(header) == len(run.t) + 1 and header[0].startswith("t [s],")


def check_the_words(door: str, seed: int) -> None:
    run, _ = run_of(door, seed)
    words = run.summary()
    assert {"times", "evaluations", "estimated error", "ending"} <= set(words)
    assert words["ending"] == "the last time was reached" and words["evaluations"] == f"{run.evaluations:,}"
    part = run.after(float(run.t[1]))
    assert (part.t == run.t[1:]).all() and (part.errors == run.errors[1:]).all() and type(part) is type(run)


def check_tables(door: str, seed: int) -> None:
    pandas = pytest.importorskip("pandas", reason="the notebook extra is not installed")
    run, _ = run_of(door, seed)
    frame, data = run.to_dataframe(), run.to_xarray()
    assert isinstance(frame, pandas.DataFrame) and (frame.index == run.t).all() and np.isfinite(frame.to_numpy()).all()
    assert (
        (data.t == run.t).all() and (data["energy"] == run.energy).all() and data["energy"].attrs["units"] is not None
    )


def check_units(door: str, seed: int) -> None:
    case, (run, _) = case_of(door, seed), run_of(door, seed)
    other, _ = quiet(case, case.tol, *UNITS[1])
    exact = exact_of(door, seed)
    assert (case.apart(other, exact) <= other.errors + ROUNDED).all()
    assert other.error == pytest.approx(run.error, rel=1.5, abs=1e-11)  # of rounding, which is another


def check_what_is_not_kept_is_said(door: str, seed: int) -> None:
    case = case_of(door, seed)
    with pytest.warns(LagrotorWarning, match=r"1e-13") as said:
        run = case.run(1e-13, long=LONG.get(door, 1.0))
    if door == "sweep":
        assert "do not keep tol" in str(said[0].message)
    else:
        assert f"t = {run.horizon:.6g} s" in str(said[0].message)
    assert run.error > 1e-13 and run.t[0] <= run.horizon <= run.t[-1]


def trusted(evolution: Any, times: Any, tol: float) -> EstimatedRun:
    """A twin of the estimate: one integration with `tol` for its local error, and its error taken for granted."""
    once = evolution.integrate(evolution.start, times, tol, False, np.inf)
    end, errors = Ending("end", float(times[-1])), np.full(len(times), tol)
    return EstimatedRun(times, once.states, errors, np.inf, once.evaluations, end, tol)


def of_free_tops(door: str) -> Case:
    """Many turns of two tops without a bar: each axis turns about its angular momentum H = J r × r' + G r, at |H|/J."""
    scene = Scene(
        (9.0, -5.0), Rotor(1, 1, 0.7, 0.9), None, None, ((0.6, 0, 0.8), (0, 0.6, 0.8)), ((0, 4, 0), (3, 0, 0))
    )
    J, t = scene.rotor.J, np.linspace(0.0, 100.0, 5)

    def exact() -> Any:
        H = [
            J * np.cross(r, v) + G * np.array(r) for r, v, G in zip(scene.axes, scene.rates, scene.momenta, strict=True)
        ]
        turns = (turn_about((h / np.linalg.norm(h))[None].repeat(5, 0), np.linalg.norm(h) / J * t) for h in H)
        return np.array([turn @ r for turn, r in zip(turns, scene.axes, strict=True)])

    def run(tol: float) -> Run:
        if door == "structure":
            same = Structure([(-1, 0), (1, 0)], [], scene.spins, scene.rotor)
            return same.simulate(t, scene.axes, scene.rates, tol=tol)
        return simulate(scene, t, "spheres", tol)

    return Case(t, 1e-6, run, exact, axes_apart, lambda run: 0.0, Trajectory.load)


def of_long_pendulum(_: str) -> Case:
    given = drawn(1200)
    run = lambda tol: given.system.simulate(given.values, given.q, given.v, given.t, tol)  # noqa: E731
    apart = lambda run, exact: run.scales.distance(np.hstack([run.q, run.v]), exact)  # noqa: E731
    return Case(
        given.t, 1e-6, run, given.exact, apart, lambda run: 0.0, lambda path: SystemRun.load(path, given.system)
    )


@pytest.mark.parametrize("door", ["scene, spheres", "structure", "system"])
def test_a_door_that_hands_tol_on_as_a_local_error_is_found_out(door: str, monkeypatch: pytest.MonkeyPatch) -> None:
    case = of_long_pendulum(door) if door == "system" else of_free_tops(door)
    exact = case.exact()
    run, said = quiet(case, case.tol)
    assert (case.apart(run, exact) <= run.errors).all() and (said or run.error <= case.tol)
    for module in (scene_door, structure_door, system_door):
        monkeypatch.setattr(module, "estimate_run", trusted)
    twin, said = quiet(case, case.tol)
    assert not said and case.apart(twin, exact).max() > case.tol


@pytest.mark.parametrize("door", DOORS)
def test_an_estimate_that_says_too_little_is_found_out(door: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for constant in ("SAFETY", "LEAST"):
        monkeypatch.setattr(error_estimate, constant, getattr(error_estimate, constant)._replace(value=1e-4))
    monkeypatch.setattr(averaged, "FALLING", averaged.FALLING._replace(value=1e-4))
    run, said = quiet(case_of(door, 0), case_of(door, 0).tol)
    with pytest.raises(AssertionError):
        judge(door, 0, run, said)


CHECKS = [check for name, check in sorted(globals().items()) if name.startswith("check_")]


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__[6:])
@pytest.mark.parametrize("door", DOORS)
def test_every_door(door: str, check: Callable[..., None], tmp_path: Path) -> None:
    check(door, 0, *([tmp_path] if check is check_a_file_is_the_run else []))


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS)
def test_every_door_on_many_motions(door: str) -> None:
    ratios = []
    for seed in range(100, 100 + MANY):
        check_no_error_is_larger_than_it_is_told(door, seed)
        check_constraints(door, seed)
        true = case_of(door, seed).apart(run_of(door, seed)[0], exact_of(door, seed)).max()
        ratios.append(run_of(door, seed)[0].error / max(true, 1e-16))
    assert np.median(ratios) < 60
