"""Uniform toppling about the joint line: growth and threshold predicted against the exact model."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor import Link, Scene, simulate
from lagrotor.theory import toppling_growth, toppling_threshold


@settings(max_examples=10, deadline=None)
@given(st.floats(0.6, 1.8), st.floats(0.01, 1), st.floats(0, 0.5), st.floats(1.5, 6))
def test_toppling_grows_as_predicted(length, mass, inertia, rate):
    scene = Scene(spins=(10, -10), link=Link(length, mass, inertia), rates=((1e-9, -rate, 0.0),) * 2)
    growth = float(toppling_growth()(rate, 10.0, *scene.inertias, length))
    if growth < 0.3:
        return
    times = np.linspace(8 / growth, 13 / growth, 31)
    x = np.abs(simulate(scene, [0.0, *times], "spheres", 1e-12).after(times[0]).axes[:, :, 0].mean(0))
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
