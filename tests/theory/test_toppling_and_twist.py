"""Uniform toppling and the twist of equal spins: growth rates predicted against the exact model."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor import Link, Scene, simulate
from lagrotor.errors import InputError
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.parallel_precession import (
    parallel_scene,
    twist_bounded,
    twist_growth,
    twist_growth_error,
    twist_multiplier_growth,
)
from lagrotor.theory.toppling import toppling_growth, toppling_threshold


@settings(max_examples=10, deadline=None)
@given(st.floats(0.6, 1.8), st.floats(0.01, 1), st.floats(0, 0.5), st.floats(1.5, 6))
def test_toppling_grows_as_predicted(length, mass, inertia, rate):
    scene = Scene(spins=(10, -10), link=Link(length, mass, inertia), rates=((1e-9, -rate, 0.0),) * 2)
    growth = float(toppling_growth()(rate, 10.0, *scene.inertias, length))
    if growth < 0.3:
        return
    times = np.linspace(8 / growth, 13 / growth, 31)
    x = np.abs(simulate(scene, times, "spheres", 1e-12).axes[:, :, 0].mean(0))
    assert np.polyfit(times, np.log(x), 1)[0] == pytest.approx(growth, rel=0.02)


@pytest.mark.parametrize("link", [Link(1, 0, 0), Link(1.4, 1, 0.05)])
def test_the_other_sense_is_stable(link):
    scene = Scene(spins=(10, -10), link=link, rates=((1e-8, 2.0, 0.0),) * 2)
    assert float(toppling_growth()(-2.0, 10.0, *scene.inertias, link.length)) == 0
    x = simulate(scene, np.linspace(0, 20, 200), "spheres", 1e-12).axes[..., 0]
    assert np.abs(x).max() < 1e-7


def test_threshold():
    a, b = Scene(spins=(10, -10), link=Link(1, 1, 1)).inertias
    edge = float(toppling_threshold()(10.0, b, 1.0))
    growth = toppling_growth()
    assert growth(edge * 0.99, 10.0, a, b, 1.0) == 0
    assert growth(edge * 1.01, 10.0, a, b, 1.0) > 0
    assert growth(np.array([1.0, -1.0]), 10.0, a, b, 1.0).shape == (2,)


@pytest.mark.parametrize(("link", "angle"), [(Link(1, 1, 1), 0.2), (Link(1.5, 1, 0.8), 0.5)])
def test_twist_grows_as_hills_equation_says(link, angle):
    scene = Scene(spins=(10, 10), link=link)
    growth = twist_multiplier_growth(scene, angle)
    half = np.pi * sum(scene.inertias) * np.cos(angle) / 10
    times = half * np.array([np.ceil(6 / growth / half), np.ceil(11 / growth / half)])
    axes = simulate(parallel_scene(scene, angle, 1e-7), times, "minimal", 1e-12).axes
    apart = np.linalg.norm(axes[0] - axes[1], axis=-1)
    assert np.log(apart[1] / apart[0]) / (times[1] - times[0]) == pytest.approx(growth, rel=5e-3)
    assert not twist_bounded(scene, angle)


def test_twist_growth_is_first_order_in_the_angle():
    scene = Scene(spins=(10, 10), link=Link(1, 1, 1))
    angles = (0.05, 0.1, 0.2)
    form = twist_growth()
    off = [abs(twist_multiplier_growth(scene, x) - float(form(np.sin(x), 10.0, *scene.inertias))) for x in angles]
    assert measured_order(angles, off) == pytest.approx(3, abs=0.1)


@pytest.mark.parametrize("link", [Link(1, 1, 1), Link(1, 0.5, 0.9)])
def test_the_error_of_the_twists_growth_is_its_next_term(link):
    """Above the true error, and by no more than |beta| for beta against it: at most a fifth at small angles."""
    scene = Scene(spins=(10, 10), link=link)
    for angle in (0.1, 0.2, 0.4):
        arguments = np.sin(angle), 10.0, *scene.inertias
        off = twist_multiplier_growth(scene, angle) - float(twist_growth()(*arguments))
        given = float(twist_growth_error()(*arguments))
        assert off < given < 1.2 * off / (1 - np.sin(angle) ** 2)
        assert float(twist_growth().error(*arguments)) == given


def test_light_stiff_bar_keeps_the_axes_parallel():
    scene = Scene(spins=(10, 10), link=Link(1, 1, 0.2))
    assert twist_bounded(scene, 0.3)
    assert twist_multiplier_growth(scene, 0.3) == 0
    run = simulate(parallel_scene(scene, 0.3, 1e-7), np.linspace(0, 40, 200), "minimal", 1e-12)
    assert np.abs(run.axes[0] - run.axes[1]).max() < 1e-5


def test_refused():
    with pytest.raises(InputError, match="equal spins"):
        twist_multiplier_growth(Scene(spins=(10, -10)), 0.2)
