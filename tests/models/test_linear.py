"""The linear rung: its exponential, its error measured and estimated, and shocks."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, simulate
from lagrotor.errors import LagrotorError
from lagrotor.models import linear
from lagrotor.models.linear import LINEAR_MARGIN, linear_error, linear_run, pair_modes
from tests.models.test_choose import random_scene
from tests.theory.random_pairs import exact_axes

ROTOR, BAR = Rotor(1.3, 0.9, 0.7, 1.1), Link(0.8, 0.3, 0.05)
UP = np.array([[0, 0, 1.0], [0, 0, 1.0]])
LEAN = np.array([[0.6, -0.3, 0.0], [0.6, 0.8, 0.0]])
PUSH = np.array([[2.0, -1.0, 0.0], [2.0, 3.0, 0.0]])


def started(size: float, spins: tuple[float, float] = (10, -7), link: Link = BAR) -> Scene:
    axes = UP + size * LEAN
    return consistent_scene(spins, axes / np.linalg.norm(axes, axis=1)[:, None], size * PUSH, ROTOR, link)


def error(scene: Scene, t: np.ndarray) -> float:
    exact = simulate(scene, t, "minimal", 1e-13)
    return float(np.linalg.norm(linear_run(scene, t).axes - exact.axes, axis=-1).max())


@pytest.mark.parametrize("spins", [(10.0, -7.0), (3.0, 3.0), (5.0, 0.0), (1e-3, -1e-3), (0.0, 0.0)])
def test_the_exponential_is_the_matrix_exponential(spins: tuple[float, float]) -> None:
    modes, t = pair_modes(started(0.1, spins)), np.array([0.0, 0.3, 4.0])
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [np.zeros((3, 3)), -modes.turning]])
    y = np.array([0.1, -0.2, 0.3, 0.5, 0.7, -0.4])
    assert modes.free(y[:3], y[3:], t) == pytest.approx(np.array([expm(A * s) @ y for s in t]), abs=1e-11)


@pytest.mark.parametrize("link", [Link(0.6, 0.3, 0.05), Link(0.9), Link(1.3, 1.0, 1.0)])
@pytest.mark.parametrize("body", [1, 2])
def test_error_is_foreseen(link: Link, body: int) -> None:
    t = np.linspace(0, 6, 400)
    shock = Shock((1.0, -0.7, 0.4), 1.5, 0.05, body)
    for scene in (started(0.01, link=link), replace(started(0.01, link=link), shock=shock)):
        assert linear_error(scene, 6.0) / LINEAR_MARGIN.value == pytest.approx(error(scene, t), rel=0.1)


@pytest.mark.parametrize("link", [Link(), Link(1.3, 1.0, 0.05), Link(0.7, 1.0, 1.0)])
@pytest.mark.parametrize("lean", [(1e-7, 0.0), (0.0, 1e-7)])
def test_error_beside_a_fast_toppling_is_foreseen(lean: tuple[float, float], link: Link) -> None:
    """A tiny lean or twist grows exponentially there: the next terms alone would say far too little."""
    axes = UP + [[lean[0], lean[1], 0], [lean[0], -lean[1], 0]]
    scene = consistent_scene((10, -10), axes, [[0, -2, 0], [0, -2, 0]], link=link)
    for end, least in ((3.0, 1e-6), (5.0, 1e-4)):
        found = error(scene, np.linspace(0, end, 200))
        assert least < found < linear_error(scene, end)
    assert linear_error(scene, 3.0) < 1e3 * error(scene, np.linspace(0, 3, 200))


@pytest.mark.parametrize("at", [-0.02, 0.0, 0.1])
def test_a_pulse_that_began_before_the_start(at: float) -> None:
    """Only what comes after t = 0 is felt."""
    scene, t = Scene((10, -7), ROTOR, BAR, Shock((0.01, 0.02, 0), at, 0.05)), np.linspace(0, 2, 50)
    assert error(scene, t) < 1e-6 < np.abs(linear_run(scene, t).axes - UP[:, None]).max()


@pytest.mark.parametrize(("at", "width"), [(-0.1, 0.12), (0.7, 0.02)])
def test_a_pulse_meets_the_axes_where_they_are_at_its_peak_or_at_the_start_after_it(at: float, width: float) -> None:
    turning, t = Scene((0, 0), rates=((0, -4, 0), (0, -4, 0))), np.linspace(0, 1.5, 7)
    scene = replace(turning, shock=Shock((0, 0.02, 0.02), at, width))
    swing = np.abs(simulate(turning, t, "minimal", 1e-11).axes - simulate(scene, t, "minimal", 1e-11).axes).max()
    assert error(scene, t) < swing / 4  # turned back to another time it is above half


def test_a_pulse_beyond_the_run_is_none() -> None:
    scene, t = started(0.01), np.linspace(0, 1, 5)
    for at in (-1.0, 2.0):
        assert (linear_run(replace(scene, shock=Shock((9, 9, 9), at, 0.05)), t).axes == linear_run(scene, t).axes).all()


def test_what_grows_after_a_short_pulse_is_in_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pulse so late and so short that the points of a turn leave none between it and the end."""
    scene, t = started(0.0, (700, -700)), np.linspace(0, 0.012, 7)
    scene = replace(scene, shock=Shock((3e5, 6e5, 0), 0.0115, 6e-7))
    assert 1e-12 < error(scene, t) < linear_error(scene, float(t[-1]))
    monkeypatch.setattr(linear, "_A_PART", 2)  # twin: the ends of the parts alone
    assert error(scene, t) > linear_error(scene, float(t[-1]))


def estimates_and_errors(seed: int, count: int) -> list[tuple[float, float]]:
    """(estimate, true error) of the linear model on random scenes with an estimate of 1e-8 to 0.1."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        tried = []
        while len(tried) < min(2_500, 1.2 * (count - len(found)) + 1):
            t = np.linspace(0, rng.uniform(0.5, 20), 100)
            try:
                scene = random_scene(rng, ("displaced", "shocked", "turning")[rng.integers(3)])
                estimate = linear_error(scene, t[-1])
                if 1e-8 < estimate < 0.1:
                    tried.append((scene, t, estimate, linear_run(scene, t).axes))
            except LagrotorError:
                continue
        runs = exact_axes([one[0] for one in tried], [one[1] for one in tried], 1e-12)
        for (_, _, estimate, axes), run in zip(tried, runs, strict=True):
            error = float(np.linalg.norm(axes - run[0], axis=-1).max()) if run else 0.0
            if error > 1e-9:
                found.append((estimate, error))
    return found[:count]


@pytest.mark.parametrize("count", [8, pytest.param(10_000, marks=pytest.mark.slow)])
def test_the_linear_error_is_bounded(count: int) -> None:
    found = estimates_and_errors(23, count)
    assert all(error <= estimate for estimate, error in found)
    assert (
        sum(error > estimate / LINEAR_MARGIN.value for estimate, error in found) > count / 20
    )  # twin: without a margin


@pytest.mark.parametrize("at", [0.0, 1.5])
def test_a_single_time_is_the_start(at: float) -> None:
    """A run without a length was a division by zero."""
    scene = consistent_scene((10, -9), ((0.01, 0, 1), (0.012, 0.003, 1)), ((0, 0.1, 0), (0, 0.1, 0)))
    assert linear_error(scene, 0.0) < 1e-12
    run = simulate(scene, [at], "auto")
    assert run.axes[:, 0] == pytest.approx(np.array(scene.axes), abs=1e-14) and run.error < 1e-12
