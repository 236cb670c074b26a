"""The paired precession as a function of time, and one amplitude from another."""

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, corrected_trajectories, paired_frequency, paired_momentum, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models import exact_orbit
from lagrotor.numerics import operations
from lagrotor.theory import (
    paired_series,
    series_orbit,
)
from lagrotor.theory.paired_precession.horner import horner_program
from lagrotor.theory.paired_precession.series import shape_of

SCENES = {
    "massless": Scene(spins=(10, -10)),
    "paper": Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)),
    "heavy, other sense": Scene(spins=(-10, 10), link=Link(1, 1, 1)),
    "long, other rotor": Scene(spins=(7, -7), rotor=Rotor(1.3, 0.8, 0.9, 1.2), link=Link(1.1, 0.6, 0.2)),
}


@pytest.mark.parametrize(("name", "order"), [("paper", 9), ("heavy, other sense", 9), ("massless", 11)])
def test_close_to_the_exact_orbit_over_a_turn(name, order):
    exact, orbit = exact_orbit(SCENES[name], 0.204), series_orbit(SCENES[name], 0.204, order)
    times = np.linspace(0, 2 * np.pi / abs(exact.frequency), 101)
    run = simulate(exact.scene, times, "minimal", 1e-13)
    assert np.abs(orbit(times) - run.axes).max() < 1e-6
    assert orbit.frequency == pytest.approx(exact.frequency, rel=1e-7)
    assert orbit.momentum == pytest.approx(run.joint_line_momentum[0], abs=1e-5)


def test_axes_are_the_sum_of_the_harmonics():
    """Clenshaw's recurrence against the sympy expressions, for odd and even orders."""
    scene, phases = SCENES["long, other rotor"], np.linspace(0, 7, 33)
    shape, ratio = (float(v) for v in shape_of(scene))
    for order in (1, 4, 5):
        expected = np.array(corrected_trajectories(order)(0.3, phases, shape, ratio)).reshape(2, 3, -1)
        series = paired_series(order, *shape_of(scene))
        assert np.abs(series.axes(0.3, phases) - expected.transpose(0, 2, 1)).max() < 1e-14
        assert series.axes(0.3, 0.7).shape == (2, 3)


def test_a_point_of_the_page_costs_few_operations():
    """Horner's rule in cos² Phi: six operations an order for both axes, and no wave but one cosine and one sine."""
    counts = {order: operations(horner_program(order)) for order in (9, 15)}
    assert counts[15] - counts[9] <= 6 * 6
    assert counts[15] <= 6 * 15 + 16


def test_shapes_and_start():
    orbit = series_orbit(SCENES["paper"], 0.2, 3)
    assert orbit(0.0).shape == (2, 3)
    assert orbit(np.zeros((4, 5))).shape == (2, 4, 5, 3)
    assert orbit(0.0)[:, 0] == pytest.approx([0.2, 0.2])
    whole = series_orbit(SCENES["paper"], 0.2, 15)
    assert np.abs(whole(0.0) - np.array(whole.start.axes)).max() < 1e-9
    assert whole.start.shock is None


def test_refused():
    scene = SCENES["paper"]
    with pytest.raises(InputError, match="opposite"):
        series_orbit(Scene(spins=(10, 10)), 0.1, 5)
    for order in (0, -1, 2.5, True):
        with pytest.raises(InputError, match="order"):
            series_orbit(scene, 0.1, order)
    for r0 in (1.0, -2, float("nan"), "much"):
        with pytest.raises(DomainError, match="r0"):
            series_orbit(scene, r0, 5)
    with pytest.raises(DomainError, match="finite"):
        series_orbit(scene, 0.1, 3)([0.0, np.inf])


@pytest.mark.parametrize("make", [corrected_trajectories, paired_frequency, paired_momentum])
def test_an_order_that_is_none_is_refused(make):
    for order in (0, -1, 1.5):
        with pytest.raises(InputError, match=f"order = {order}"):
            make(order=order)


def test_too_few_terms_give_no_bound_and_terms_that_do_not_fall_are_refused():
    assert series_orbit(SCENES["massless"], 0.1, 3).error == np.inf
    assert series_orbit(SCENES["massless"], 0.1, 5).error < 1e-4
    with pytest.raises(DomainError, match=r"at r0 = 0\.7 .* do not fall"):
        series_orbit(SCENES["massless"], 0.7, 9)
