"""The drift of opposite spins after a shock: closed forms and their errors against exact runs, and the force that cancels it."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, cancelling_force, natural_rate, toppling_after_shock
from lagrotor.errors import DomainError, InputError
from lagrotor.models import (
    cancelling_force_error,
    exact_cancelling_force,
    mean_over,
    run_after,
    time_to_wander,
    toppling_error,
    turning_rate,
    wander_error,
    wandering_rate,
)
from lagrotor.numerics import measured_order
from lagrotor.theory import wander_after_shock


def scene(x, y=0.0, body=1, link=None, spins=(10, -10)):
    return Scene(spins=spins, link=link or Link(1, 0.01, 0.1), shock=Shock((x, y, 0), 0.5, 1 / 20, body))


@pytest.mark.parametrize(
    ("link", "body", "spins"),
    [(Link(1.5, 0.4, 0.05), 1, (-10, 10)), (Link(0.7, 1, 1), 1, (10, -10)), (Link(0.7, 1, 1), 2, (-10, 10))],
)
def test_rates_after_a_shock(link, body, spins):
    tried = scene(3, 0.3, body, link, spins)
    run = run_after(tried, 30)
    assert turning_rate(run) == pytest.approx(toppling_after_shock(tried), rel=0.01)
    assert wandering_rate(run) == pytest.approx(wander_after_shock(tried), rel=0.02)


def test_second_order():
    forces = (3, 6, 12)
    off = [abs(turning_rate(run_after(scene(f), 16)) - toppling_after_shock(scene(f))) for f in forces]
    assert measured_order(forces, off) == pytest.approx(4, abs=0.3)


def test_cancelling_force_of_the_paper():
    assert cancelling_force(scene(40)) == pytest.approx(-10.6, abs=0.01)
    assert toppling_after_shock(scene(40, cancelling_force(scene(40)))) == pytest.approx(0, abs=1e-14)


def window(scene, turns):
    """The seconds from the pulse's peak to `turns` swings after its end."""
    return scene.shock.end - scene.shock.at + turns * 2 * np.pi / natural_rate(scene)


def test_the_papers_cancelling_force_and_its_error_in_two_windows():
    """−10.98 N over 8 swings, −11.07 over 20: against F_x = 40 the second order has −10.60."""
    for turns, force in ((8, -10.98), (20, -11.07)):
        assert exact_cancelling_force(scene(40), turns) == pytest.approx(force, abs=0.006)
        assert cancelling_force_error(scene(40), window(scene(40), turns)) == pytest.approx(-10.60 - force, abs=0.012)


@pytest.mark.parametrize(("error", "force", "turns", "order"), [(toppling_error, 4, 16, 4), (wander_error, 8, 24, 5)])
def test_the_error_falls_as_the_next_order(error, force, turns, order):
    forces = (force, 2 * force)
    assert measured_order(forces, [error(scene(f), window(scene(f), turns)) for f in forces]) == pytest.approx(
        order, abs=0.3
    )


def test_a_cancelling_force_that_is_not_found_is_said_so(monkeypatch):
    """With a turning that no force changes, the secant goes nowhere."""
    monkeypatch.setattr("lagrotor.models.mean_motion.run_after", lambda scene, turns, tol: scene.shock.force[1])
    monkeypatch.setattr("lagrotor.models.mean_motion.turning_rate", lambda force: 1 + force**2)
    with pytest.raises(DomainError, match=r"no force near -\S+ N.*a weaker shock"):
        exact_cancelling_force(scene(10))


@pytest.mark.slow
def test_the_time_in_which_the_mean_x_grows_falls_as_the_cube():
    leave = [time_to_wander(scene(f), 0.03, 0.06 / abs(wander_after_shock(scene(f)))) for f in (4, 8)]
    assert measured_order((4, 8), leave) == pytest.approx(-3, abs=0.1)


def test_without_motion_and_without_a_force_the_error_is_zero():
    """Nothing happens; or nothing is to be cancelled, though the pair turns."""
    for still in (scene(0), replace(scene(0), shock=Shock((0, 0, 4), 0.5, 1 / 20))):
        assert (toppling_error(still, 10), wander_error(still, 10)) == pytest.approx((0, 0), abs=1e-9)
        assert cancelling_force_error(still, 10) == 0
    assert cancelling_force_error(scene(0, 4), 10) == 0 < 1e-6 < toppling_error(scene(0, 4), 10)
    assert 0 < cancelling_force_error(scene(4), 10) < 1e-3


ERRORS = (toppling_error, wander_error, cancelling_force_error)
REFUSALS = [
    (lambda: cancelling_force(scene(40, spins=(10, 10))), "opposite"),
    (lambda: cancelling_force(scene(400)), "outside its domain"),
    *(
        (lambda error=error: error(scene(4), window(scene(4), 3.9)), r"3\.9 swings .* take 3\.72 to")
        for error in ERRORS
    ),
    *((lambda error=error: error(scene(4), 1e9), "swings after the pulse") for error in ERRORS),
    *(
        (lambda wrong=wrong: toppling_error(scene(4), wrong), "duration = .* not a")
        for wrong in ("a", np.inf, True, None)
    ),
    (lambda: cancelling_force_error(scene(0), np.nan), "cancelling_force_error: duration"),
    (lambda: mean_over(np.arange(3.0), np.arange(3.0)), "too few"),
    (lambda: run_after(Scene((10, -10))), "a Scene with a bar and a shock"),
    (lambda: run_after(scene(4, spins=(0, 0))), "no shock or no spin"),
]


@pytest.mark.parametrize(("call", "message"), REFUSALS)
def test_refused(call, message):
    with pytest.raises((DomainError, InputError), match=message):
        call()


@pytest.mark.parametrize("turns", [4, 6.3, 24])
def test_the_mean_of_an_oscillation_falls_as_its_turns(turns):
    t, left = np.linspace(0, 1, 2001), np.exp(-np.sqrt(4 * np.pi * turns))
    worst = max(abs(mean_over(t, np.cos(2 * np.pi * turns * t + phase))) for phase in np.linspace(0, np.pi, 9))
    assert left < worst < 30 * left
