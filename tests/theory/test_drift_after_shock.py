"""The drift of opposite spins after a shock: closed forms and their errors against exact runs, and the force that cancels it."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, cancelling_force, natural_rate, shock_response, toppling_after_shock
from lagrotor.errors import DomainError, InputError
from lagrotor.models import (
    exact_cancelling_force,
    mean_error,
    run_after,
    time_to_wander,
    turning_rate,
    wandering_rate,
)
from lagrotor.numerics import measured_order
from lagrotor.theory import calibrated_factors, cancelling_force_error, toppling_error, wander_after_shock, wander_error
from lagrotor.theory.drift_error import SHAPES
from tests.theory.random_pairs import held, random_pair, shocked

WINDOWS = (8, 24, 60)  # swings
MANY = [8, pytest.param(2_000, marks=pytest.mark.slow)]


def scene(x, y=0.0, body=1, link=None, spins=(10, -10)):
    return Scene(spins=spins, link=link or Link(1, 0.01, 0.1), shock=Shock((x, y, 0), 0.5, 1 / 20, body))


@pytest.mark.parametrize("link", [Link(1.5, 0.4, 0.05), Link(0.7, 1, 1)])
@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("spins", [(10, -10), (-10, 10)])
def test_rates_after_a_shock(link, body, spins):
    tried = scene(3, 0.3, body, link, spins)
    run = run_after(tried, 30)
    assert turning_rate(run) == pytest.approx(toppling_after_shock(tried), rel=0.01)
    assert wandering_rate(run) == pytest.approx(wander_after_shock(tried), rel=0.02)


def test_second_order():
    forces = (3, 6, 12)
    off = [abs(turning_rate(run_after(scene(f), 16)) - toppling_after_shock(scene(f))) for f in forces]
    assert measured_order(forces, off) == pytest.approx(4, abs=0.3)


def opposite_pair(rng):
    """Opposite spins; bars of the errors' range, massless ones besides: ell/R and sigma from end to end."""
    one = random_pair(rng, "opposite")
    if rng.random() < 1 / 3:
        return replace(one, link=Link(one.link.length))
    shape, length = rng.uniform(*SHAPES), one.link.length
    while True:
        mass = np.exp(rng.uniform(np.log(0.01), np.log(20)))
        tried = replace(one, link=Link(length, mass, rng.choice([0.0, rng.uniform(0, 1)]) * mass * length**2))
        if abs(tried.sigma - shape) < 0.2 and SHAPES[0] <= tried.sigma <= SHAPES[1]:
            return tried


def drifts_within_their_errors(seed, count, law, error, measure):
    rng, pairs, refused = np.random.default_rng(seed), [], 0
    while len(pairs) + refused < count:
        scene, turns = shocked(rng, opposite_pair(rng)), int(rng.choice(WINDOWS))
        duration = scene.shock.end - scene.shock.at + turns * 2 * np.pi / natural_rate(scene)
        try:
            given = error(scene, duration)
        except DomainError:
            refused += 1
            continue
        run = run_after(scene, turns, 1e-10)
        leak = mean_error(run.rates, turns)
        pairs.append((abs(measure(run) - law(scene)), given + leak))
    held(pairs, refused, count, 0.6)


@pytest.mark.parametrize("count", MANY)
def test_toppling_after_a_shock(count):
    drifts_within_their_errors(4, count, toppling_after_shock, toppling_error, turning_rate)


@pytest.mark.parametrize("count", MANY)
def test_the_mean_x_after_a_shock(count):
    drifts_within_their_errors(5, count, wander_after_shock, wander_error, wandering_rate)


@pytest.mark.parametrize("count", [4, pytest.param(200, marks=pytest.mark.slow)])
def test_cancelling_force_of_random_pairs(count):
    rng, pairs, refused = np.random.default_rng(6), [], 0
    while len(pairs) + refused < count:
        # Below 0.05 the accuracy of the runs is what one sees.
        scene = shocked(rng, opposite_pair(rng), 0.05)
        x = float(np.hypot(*scene.shock.force[:2]))
        scene = replace(scene, shock=replace(scene.shock, force=(x, 0.0, 0.0)))
        turns = int(rng.choice([8, 20, 40]))
        duration = scene.shock.end - scene.shock.at + turns * 2 * np.pi / natural_rate(scene)
        try:
            given = cancelling_force_error(scene, duration)
        except DomainError:
            refused += 1
            continue
        exact = exact_cancelling_force(scene, turns)
        pairs.append((abs(exact - cancelling_force(scene)), given + 1e-6 * abs(exact)))
    held(pairs, refused, count, 0.5)


def test_cancelling_force_of_the_paper():
    assert cancelling_force(scene(40)) == pytest.approx(-10.6, abs=0.01)
    assert toppling_after_shock(scene(40, cancelling_force(scene(40)))) == pytest.approx(0, abs=1e-14)


def test_the_papers_cancelling_force_lies_within_its_error_for_every_window():
    """−10.98 N over 8 swings, −11.07 over 20, −11.24 over 40: against F_x = 40 the second order has −10.60."""
    scene = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((40, 0, 0), 0.5, 1 / 20))
    turn, law = 2 * np.pi / natural_rate(scene), cancelling_force(scene)
    found = {turns: exact_cancelling_force(scene, turns) for turns in (8, 20)}
    assert found == pytest.approx({8: -10.98, 20: -11.07}, abs=0.006)
    for turns, exact in found.items():
        assert abs(exact - law) < cancelling_force_error(scene, turns * turn + scene.shock.end - scene.shock.at)


def test_a_cancelling_force_that_is_not_found_is_said_so(monkeypatch):
    """With a turning that no force changes, the secant goes nowhere."""
    monkeypatch.setattr("lagrotor.models.mean_motion.run_after", lambda scene, turns, tol: scene.shock.force[1])
    monkeypatch.setattr("lagrotor.models.mean_motion.turning_rate", lambda force: 1 + force**2)
    with pytest.raises(DomainError, match=r"no force near -\S+ N.*a weaker shock"):
        exact_cancelling_force(scene(10))


@pytest.mark.slow
def test_exact_cancelling_force():
    exact = {f: exact_cancelling_force(scene(f)) for f in (10, 20, 40)}
    assert exact[40] == pytest.approx(-11.11, abs=0.02)
    off = [abs(exact[f] - cancelling_force(scene(f))) for f in (10, 20)]
    assert measured_order((10, 20), off) == pytest.approx(4, abs=0.3)


@pytest.mark.slow
def test_the_time_in_which_the_mean_x_grows_falls_as_the_cube():
    leave = [time_to_wander(scene(f), 0.03, 0.06 / abs(wander_after_shock(scene(f)))) for f in (4, 8)]
    assert measured_order((4, 8), leave) == pytest.approx(-3, abs=0.1)


@pytest.mark.parametrize("k", [0.5, 2.0])
def test_over_no_time_the_errors_are_the_next_orders(k):
    """With q² = (p_x² + sigma p_y²)/G², P = −p_y; k tells its powers apart."""
    given = scene(3, 2, link=Link(k, 0.2, 0.01))
    (a, b), G = given.inertias, given.momenta[0]
    p_x, p_y = shock_response(given).impulse[:2]
    q, P = np.sqrt(p_x**2 + given.sigma * p_y**2) / G, abs(p_y)
    c, d = calibrated_factors.FOURTH_ORDER.value, calibrated_factors.FIFTH_ORDER.value
    fourth = G * q**4 * (c[0] / k + c[1] / k**3) + P * q**2 * (c[2] + c[3] / k**2)
    fifth = G * q**5 * (d[0] + d[1] / k**4) + P * q**3 * (d[2] + d[3] / k**2)
    assert toppling_error(given, 0.0) == pytest.approx(fourth / (a + b))
    assert wander_error(given, 0.0) == pytest.approx(fifth / (a + b))


def test_what_is_out_of_range_is_refused():
    with pytest.raises(DomainError, match="a turn by"):
        toppling_error(scene(40), 60.0)
    with pytest.raises(DomainError, match=r"q = 0\.44"):
        wander_error(scene(40, spins=(8, -8)), 1.0)


def test_refused():
    with pytest.raises(InputError, match="opposite"):
        cancelling_force(scene(40, spins=(10, 10)))
    with pytest.raises(DomainError, match="outside its domain"):
        cancelling_force(scene(400))
