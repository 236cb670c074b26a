"""A shocked scene by both methods: the pulse, the paper's program, and what is read off the runs."""

import numpy as np
import pytest

from lagrotor import Scene, Shock, simulate
from lagrotor.pair import SCENES
from lagrotor.paper.rotor_pair.runs import (
    after_shock,
    angle_between,
    centre_numbers,
    centre_off,
    centre_runs,
    rate_numbers,
    rate_runs,
    shocked_scene,
    turned_about_joint_line,
)

SHOCKED = SCENES["same-spin-shock"].scene
TIMES = np.arange(601) * 0.005


def test_the_centre_is_read_where_the_exact_run_ends():
    exact = simulate(SHOCKED, TIMES[:501])
    runs = centre_runs(TIMES, exact)
    assert runs["exact_centre"][0] == pytest.approx([-0.5, 0, 0.5])
    assert np.abs(runs["centre"][:501] - runs["exact_centre"]).max() < 5e-3
    runs["exact_centre"] = runs["centre"][:501] + [0, 0, 1e-3]
    assert centre_off(runs) == pytest.approx(1e-3)
    numbers = centre_numbers(runs | {"centre": np.outer(TIMES, [1, 2, 0])})
    assert [numbers[f"{letter} of the centre, range (m)"] for letter in "xyz"] == pytest.approx([3, 6, 0])
    assert numbers["energy after the shock (J)"] == pytest.approx(numbers["exact energy after the shock (J)"], abs=0.01)


def test_rates_are_read_off_the_curve_they_name():
    scene = Scene((20, 0), link=None, shock=Shock((40, 0, 0), 2.0, 1 / 20))
    runs = rate_runs(simulate(scene, np.linspace(0, 10, 2001), "spheres", 1e-8), 15.0)
    numbers = rate_numbers(runs)
    assert numbers["rate, exact model (rad/s)"] == pytest.approx(numbers["rate, closed form (rad/s)"], rel=1e-4)
    assert numbers["closed form, largest residual (m)"] < numbers["printed rate, largest residual (m)"] / 20
    swapped = rate_numbers(runs | {"printed": runs["corrected"], "corrected": runs["printed"]})  # the twin
    assert swapped["closed form, largest residual (m)"] == numbers["printed rate, largest residual (m)"]


def test_a_run_after_its_shock_is_that_of_a_kick():
    """Without spins a shock along the bar topples the pair in the x-z plane at P R/(2 (a + b))."""
    scene = shocked_scene((0, 0), (20, 0, 0))
    assert scene.shock and scene.shock.at == 10 * scene.shock.width
    run = after_shock(scene, 2.0)
    assert run.t[0] > scene.shock.at and run.t[-1] == pytest.approx(scene.shock.at + 2)
    leaning = np.arctan2(run.axes[0, :, 0], run.axes[0, :, 2])
    rate = scene.shock.impulse[0] / (2 * sum(scene.inertias))
    assert np.diff(leaning) / np.diff(run.t) == pytest.approx(
        rate, rel=1e-5
    )  # it leans a little already during the pulse
    assert turned_about_joint_line(run.axes) == pytest.approx(0, abs=1e-12)
    assert angle_between(run.axes) == pytest.approx(0, abs=1e-8)
    across = after_shock(shocked_scene((0, 0), (0, 20, 0)), 2.0)  # the twin
    assert abs(turned_about_joint_line(across.axes)[-1]) > 0.3
    assert angle_between(across.axes).max() > 0.01
