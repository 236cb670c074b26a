"""The closed forms: each against the exact models, from any start that it holds."""

from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, paired_scene, simulate
from lagrotor.errors import DomainError
from lagrotor.models import exact_orbit, minimal
from lagrotor.models.closed_form_model import closed_form
from lagrotor.theory import parallel_scene, series_orbit
from tests.models.one_integration import observed

T = np.linspace(0, 5, 101)
ROTOR = Rotor(1.3, 0.9, 0.7, 1.1)
LEANING = ((sin(0.7), 0.0, cos(0.7)), (0.0, -1.0, 0.0))
TURNING = ((0.0, 3.0, 0.0), (-2.0, 0.0, 1.0))


def check(scene: Scene, bound: float, model: str = "minimal", tol: float = 1e-9) -> float:
    """The largest error of an axis, below `bound` and below what the answer says; rates are derivatives of the axes."""
    run, exact = simulate(scene, T, "closed_form", tol), simulate(scene, T, model, 1e-13)
    found = float(np.linalg.norm(run.axes - exact.axes, axis=-1).max())
    assert found < bound
    assert found < max(tol, closed_form(scene, T[-1], tol, best=True).error) + 5e-12
    assert np.abs(run.rates - exact.rates).max() < 50 * bound
    return found


@pytest.mark.parametrize("spins", [(10.0, -7.0), (3.0, 0.0)])
def test_free_rotors_turn_about_their_angular_momentum(spins: tuple[float, float]) -> None:
    free = Scene(spins, ROTOR, None, axes=LEANING, rates=TURNING)
    check(free, 1e-11, "spheres")
    # Twin: the other sense of spin is another motion.
    other = simulate(replace(free, spins=(-spins[0], spins[1])), T, "closed_form").axes
    assert np.abs(other - simulate(free, T, "spheres", 1e-12).axes).max() > 0.1


@pytest.mark.parametrize("link", [Link(0.9, 1.0, 0.1), Link(1.3, 0.5)])
def test_equal_spins_in_parallel_are_one_rotor(link: Link) -> None:
    check(parallel_scene(Scene((10, 10), ROTOR, link), 0.3), 1e-10)
    free = Scene((4, 4), ROTOR, link, axes=(LEANING[0],) * 2, rates=(TURNING[0],) * 2)
    check(free, 1e-10)
    with pytest.raises(DomainError, match="none is known for a bar and spins 4, 3 rad/s"):
        simulate(replace(free, spins=(4, 3)), T, "closed_form")


def test_without_spin_the_pair_swings_on_a_great_circle() -> None:
    check(Scene((0, 0), rates=((0, 1, 0), (0, 1, 0))), 1e-11)
    with pytest.raises(DomainError, match="turn alike, not 2 apart"):
        simulate(Scene((0, 0), rates=((0, 1, 0), (0, -1, 0))), T, "closed_form")


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("link", [Link(1, 0.01, 0.1), Link(0.7), Link(1.3, 1.0, 0.05)])
def test_paired_precession_from_any_phase_and_azimuth(link: Link, sign: int) -> None:
    orbit = exact_orbit(Scene((10 * sign, -10 * sign), link=link), 0.08)
    c, s = cos(1.1), sin(1.1)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    for at in (0.0, 0.17, 0.31):
        now = simulate(orbit.scene, np.union1d(0.0, at), "minimal", 1e-13).after(at)
        axes, rates = ((part[:, 0] @ turn.T).tolist() for part in (now.axes, now.rates))
        check(replace(orbit.scene, axes=axes, rates=rates), 1e-8)


def test_a_start_off_the_orbit_is_in_the_error() -> None:
    scene = series_orbit(Scene((10, -10)), 0.2, 5).start
    assert check(scene, 1e-2) > 1e-5


@pytest.mark.parametrize(
    ("r0", "t_end"),
    [(0.45, 200.0), (0.48, 400.0), *(pytest.param(0.4, t, marks=pytest.mark.slow) for t in (200.0, 2000.0))],
)
def test_where_the_orbit_is_hyperbolic_what_is_foreseen_grows(r0: float, t_end: float) -> None:
    """Over hundreds of turns a start that is off by the series' last terms parts from the orbit."""
    scene, times = series_orbit(Scene((-5.1, 5.1), link=Link(1.3, 0.5, 0.2)), r0, 15).start, np.linspace(0, t_end, 60)
    exact = observed(minimal.MODEL, scene, times, 1e-9).axes  # told.error is above 1e-4
    for best in (False, True):
        told = closed_form(scene, t_end, 1e-4, best)
        assert np.linalg.norm(told.motion(times)[0] - exact, axis=-1).max() < told.error > 1e-4
    if t_end > 300:  # a slip that large says only that two axes are at most opposite
        assert told.error == 2.0
        assert "estimated error 2.0, more than tol" in simulate(scene, times, "closed_form", 1e-4).why
    assert closed_form(scene, 0.1, 1e-4).error < 0.1


def test_asked_for_by_name_the_series_goes_on_to_order_21() -> None:
    """On the exact orbit each two orders gain a digit; the rung's own choice is given up early."""
    scene = exact_orbit(Scene((10, -10)), 0.204).scene
    exact = simulate(scene, T, "minimal", 1e-13).axes
    errors = [np.abs(simulate(scene, T, "closed_form", tol).axes - exact).max() for tol in (1e-6, 1e-8, 1e-13)]
    assert errors[0] < 1e-8 and errors[1] < errors[0] / 50 and errors[2] < errors[1] / 5
    assert closed_form(scene, 5.0, 1e-13).error > 1e-5  # given up early: no order to 15 would do
    assert "r₀²¹" in closed_form(scene, 5.0, 1e-13, best=True).reason
    # Twin: the orbit of another amplitude is not this one.
    other = exact_orbit(Scene((10, -10)), 0.2).scene
    assert np.abs(simulate(other, T, "closed_form", 1e-13).axes - exact).max() > 1e-3


def test_a_closed_form_asked_for_by_name_says_how_far_off_it_may_be() -> None:
    off = simulate(series_orbit(Scene((10, -10)), 0.204, 9).start, T, "closed_form", 1e-9)
    assert off.why.startswith("by name; on its paired precession") and off.why.endswith("more than tol")
    assert "more than tol" not in simulate(paired_scene(Scene((10, -10)), 0.204), T, "closed_form", 1e-3).why
