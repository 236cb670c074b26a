"""What every model promises, each within the `error` that its own run gives: one set of tests for all of them."""

from dataclasses import replace
from functools import cache
from math import cos, sin
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from lagrotor import Link, Rotor, Scene, Shock, Trajectory, consistent_scene, simulate
from lagrotor.models import exact_orbit

END, POINTS = 1.5, 81
TIMES = END / 2 * (1 - np.cos(np.pi * np.arange(POINTS) / (POINTS - 1)))  # Chebyshev points: rates integrate exactly
TOL = 1e-10
ROUNDING = 1e-11
ROTOR, BAR = Rotor(1.3, 0.9, 0.7, 1.1), Link(0.8, 0.3, 0.05)
LEAN = np.array([[0.06, -0.03, 1.0], [0.06, 0.08, 1.0]])
FLIP = np.array([-1, 1, 1])


def unequal() -> Scene:
    axes = LEAN / np.linalg.norm(LEAN, axis=1)[:, None]
    return consistent_scene((10, -7), axes, [[0.2, -0.1, 0], [0.2, 0.3, 0]], ROTOR, BAR)


@cache
def scene_of(name: str) -> Scene:
    if name == "wide":
        return consistent_scene(
            (6, 9), [[0.5, 0.2, 0.84], [0.4, 0.3, 0.87]], [[1.0, -1.2, 0], [0.9, 1.5, 0]], ROTOR, BAR
        )
    if name == "paired":
        return exact_orbit(Scene((10, -10), link=Link(1, 0.3, 0.1)), 0.08).scene
    shock = Shock((0.5, -0.35, 0.2), 0.75, 0.1, body=2)
    if name == "struck":
        return replace(unequal(), spins=(10, -10), shock=replace(shock, at=0.3))
    return replace(unequal(), shock=shock) if name == "shocked" else unequal()


def mirrored(scene: Scene) -> Scene:
    """Seen in the plane x = 0: the rotors change places, their spins turn round."""
    axes, rates = (np.array(part)[::-1] * FLIP for part in (scene.axes, scene.rates))
    shock = scene.shock and replace(scene.shock, force=tuple(FLIP * scene.shock.force), body=3 - scene.shock.body)
    return replace(scene, spins=[-w for w in scene.spins[::-1]], axes=axes, rates=rates, shock=shock)


class Model:
    """A model that `simulate` offers, and the scenes that it holds; `rigid`: it keeps the bar's length to rounding."""

    scenes: tuple[str, ...] = ("paired", "unequal", "shocked", "wide")

    def __init__(self, name: str, *scenes: str, rigid: bool = False) -> None:
        self.name, self.rigid = name, rigid
        self.scenes = scenes or self.scenes

    def run(self, scene: Scene, t: Any, tol: Any = TOL) -> Trajectory:
        return simulate(scene, t, self.name, tol)


MODELS = [
    Model("closed_form", "paired"),
    Model("linear", "paired", "unequal", "shocked", rigid=True),
    Model("averaged", "paired", "struck", rigid=True),
    Model("minimal", rigid=True),
    Model("spheres"),
    Model("euler"),
]


@cache
def run_of(model: Model, name: str) -> Trajectory:
    return model.run(scene_of(name), TIMES)


def within(*runs: Trajectory) -> float:
    """The errors of the runs together."""
    return sum(run.error + ROUNDING for run in runs)


def fastest(scene: Scene) -> float:
    """Rate (rad/s) of a free rotor's axis: an error of the axes by e is one of their rates by about this times e."""
    return max(map(abs, scene.momenta)) / scene.rotor.J


def check_unit_axes(model: Model, name: str) -> None:
    run = run_of(model, name)
    assert np.abs(np.linalg.norm(run.axes, axis=-1) - 1).max() < within(run)


def check_tangent_rates(model: Model, name: str) -> None:
    run = run_of(model, name)
    assert np.abs((run.axes * run.rates).sum(-1)).max() < fastest(run.scene) * within(run)


def check_rates_are_derivatives(model: Model, name: str) -> None:
    """The rates, integrated as a Chebyshev series, give the axes back."""
    run = run_of(model, name)
    for axes, rates in zip(run.axes, run.rates, strict=True):
        for x, v in zip(axes.T, rates.T, strict=True):
            whole = Chebyshev.fit(TIMES, v, POINTS - 1, domain=[0, END]).integ(lbnd=0)
            assert np.abs(whole(TIMES) + x[0] - x).max() < 2 * within(run)


def check_bar_length(model: Model, name: str) -> None:
    run = run_of(model, name)
    allowed = ROUNDING if model.rigid else 2 * run.scene.rotor.length * within(run)
    assert np.abs(run.link_length - run.scene.link.length).max() < allowed


def check_conserved(model: Model, name: str) -> None:
    """To the model's error e: rates are off by Omega e, so that E and P are by their gradients times that."""
    run = run_of(model, name)
    e = within(run)
    (a, b), Omega = run.scene.inertias, fastest(run.scene)
    free = run.t > run.scene.shock.end if run.scene.shock else slice(None)
    speed, inertia = np.linalg.norm(run.rates, axis=-1).max(), 2 * (a + abs(b))
    assert np.ptp(run.energy[free]) < 2 * inertia * speed * Omega * e
    assert np.ptp(run.invariants["P"][free]) < 2 * (inertia * (speed + Omega) + np.abs(run.momenta).sum()) * e
    assert np.ptp(run.momenta, axis=1).max() < ROUNDING * np.abs(run.momenta).max()


def check_start(model: Model, name: str) -> None:
    scene, run = scene_of(name), run_of(model, name)
    e = ROUNDING if model.rigid else within(run)
    assert np.abs(run.axes[:, 0] - scene.axes).max() < e
    assert np.abs(run.rates[:, 0] - scene.rates).max() < fastest(scene) * e


@cache
def exact_of(name: str, model: str) -> Trajectory:
    return simulate(scene_of(name), TIMES, model, 1e-13)


def check_error(model: Model, name: str) -> None:
    run = run_of(model, name)
    exact = exact_of(name, "spheres" if model.name == "minimal" else "minimal")
    assert np.linalg.norm(run.axes - exact.axes, axis=-1).max() < within(run, exact)


def check_parts_of_the_times(model: Model, name: str) -> None:
    whole = run_of(model, name)
    for part in (slice(None, None, 7), slice(40, None), slice(-1, None)):
        run = model.run(whole.scene, np.union1d(0.0, TIMES[part])).after(TIMES[part][0])
        e = 2 * within(whole)
        assert np.abs(run.axes - whole.axes[:, part]).max() < e
        assert np.abs(run.rates - whole.rates[:, part]).max() < fastest(run.scene) * e


def check_mirrored(model: Model, name: str) -> None:
    run, image = run_of(model, name), model.run(mirrored(scene_of(name)), TIMES)
    assert np.abs(image.axes - run.axes[::-1] * FLIP).max() < within(run, image)


CHECKS = {check.__name__.removeprefix("check_"): check for check in (
    check_unit_axes, check_tangent_rates, check_rates_are_derivatives, check_bar_length, check_conserved, check_start,
    check_error, check_parts_of_the_times, check_mirrored,
)}  # fmt: skip


@pytest.mark.parametrize("check", CHECKS)
@pytest.mark.parametrize(
    ("model", "name"),
    [(m, s) for m in MODELS for s in m.scenes],
    ids=lambda v: getattr(v, "name", v),
)
def test_every_model(model: Model, name: str, check: str) -> None:
    CHECKS[check](model, name)


# Twins: the minimal model with one thing wrong, and the check that must see it.


def turned(axes: np.ndarray, angle: float) -> np.ndarray:
    """About the vertical, the second rotor only: the bar is no longer as long."""
    c, s = cos(angle), sin(angle)
    return np.array([axes[0], axes[1] @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])])


WRONG: dict[str, Any] = {
    "unit_axes": lambda run: replace(run, axes=run.axes * (1 + 1e-6)),
    "tangent_rates": lambda run: replace(run, rates=run.rates + 1e-5 * run.axes),
    "rates_are_derivatives": lambda run: replace(run, rates=run.rates * (1 + 1e-5)),
    "bar_length": lambda run: replace(run, axes=turned(run.axes, 1e-6)),
    "conserved": lambda run: replace(run, rates=run.rates * (1 + 1e-4 * run.t[:, None])),
    "start": lambda run: replace(run, axes=np.roll(run.axes, -1, axis=1)),
    "error": lambda run: replace(run, axes=turned(run.axes, 1e-4)),
    "parts_of_the_times": lambda run: replace(run, axes=turned(run.axes, 1e-6 * len(run.t))),
    "mirrored": lambda run: replace(run, axes=turned(run.axes, 1e-4)),
}


class Spoiled(Model):
    def __init__(self, check: str) -> None:
        super().__init__("minimal", rigid=True)
        self.check = check

    def run(self, scene: Scene, t: Any, tol: Any = TOL) -> Trajectory:
        return WRONG[self.check](super().run(scene, t, tol))


@pytest.mark.parametrize("check", CHECKS)
def test_a_model_with_a_fault_fails(check: str) -> None:
    with pytest.raises(AssertionError):
        CHECKS[check](Spoiled(check), "unequal")
