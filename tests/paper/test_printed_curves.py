"""The ansatz, the paper's correction and the series as curves, and their distance from the exact orbit."""

import numpy as np
import pytest

from lagrotor import Scene
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.paper.rotor_pair.runs import against_orbit, ansatz_axes, paper_axes, series_axes

R0, PHASE = 0.2, np.linspace(0, 2 * np.pi, 49)


def bar(axes):
    """Length of a bar (n,) between tips of axes (2, n, 3), with ell = R = 1."""
    return np.linalg.norm(axes[1] - axes[0] + [1, 0, 0], axis=-1)


def test_the_papers_correction_is_as_printed():
    """(5.20): the inclinations' sines are r_0 ∓ r_0² cos phi, which levels the bar's length but makes it too long."""
    axes = paper_axes(R0, PHASE)
    first, second = np.hypot(axes[..., 0], axes[..., 1])
    assert first == pytest.approx(R0 - R0**2 * np.cos(PHASE))
    assert second == pytest.approx(R0 + R0**2 * np.cos(PHASE))
    assert np.ptp(bar(axes)) < np.ptp(bar(ansatz_axes([R0, R0], PHASE))) / 5
    assert bar(axes).mean() > 1 + R0**2


@pytest.mark.parametrize("order", [2, 3])
def test_the_series_keeps_the_bar_to_its_order(order):
    """Half a turn and exchanging the rotors turn r_0 into −r_0: the length is even in it, so both orders leave r_0⁴."""
    sizes = np.array([0.025, 0.05, 0.1])
    off = [np.abs(bar(series_axes(order, r0, PHASE)) - 1).max() for r0 in sizes]
    assert measured_order(sizes, off) == pytest.approx(4, abs=0.1)
    papers = [np.abs(bar(paper_axes(r0, PHASE)) - 1).max() for r0 in sizes]  # the twin
    assert measured_order(sizes, papers) == pytest.approx(2, abs=0.1)


def test_distances_are_those_from_the_exact_orbit():
    orbit = exact_orbit(Scene(spins=(10, -10)), R0)
    seen = against_orbit(orbit, PHASE, {"paper": paper_axes(R0, PHASE), "series": series_axes(3, R0, PHASE)}, 1e-9)
    exact = seen["exact"] - [[[-0.5, 0, 0]], [[0.5, 0, 0]]]
    again = against_orbit(orbit, PHASE, {"itself": exact}, 1e-9)
    assert again["itself_distance"].max() < 1e-12
    assert seen["series_distance"].max() < 0.005 < seen["paper_distance"].max()
    assert bar(exact) == pytest.approx(1, abs=1e-8)
