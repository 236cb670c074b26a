"""Every closed form's error estimate against exact runs, on random bars, lengths, spins and amplitudes.

The fast tests take a tenth of the pairs; `pytest -m slow` takes 200 for each closed form.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, consistent_scene, natural_rate, shock_response, simulate
from lagrotor.errors import DomainError, LagrotorError
from lagrotor.models.linear import modes, shock_response_error
from lagrotor.models.mean_motion import (
    exact_cancelling_force,
    mean_error,
    mean_over,
    run_after,
    turning_rate,
    wandering_rate,
)
from lagrotor.numerics.spectrum import peak, spectrum
from lagrotor.theory import calibrated
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock
from lagrotor.theory.drift_error import cancelling_force_error, toppling_error, wander_error
from lagrotor.theory.natural_frequency import natural_rate_error
from lagrotor.theory.parallel_precession import (
    parallel_scene,
    twist_bounded,
    twist_growth,
    twist_growth_error,
    twist_multiplier_growth,
)

ROOT = Path(__file__).parents[2]
COUNTS = [20, pytest.param(200, marks=pytest.mark.slow)]
TURNS = 24


def random_pair(rng, kind="any"):
    """A rotor, a bar with 0.4 < ell/R < 2.5, massless or not, and two spins."""
    transverse = rng.uniform(0.3, 2)
    rotor = Rotor(rng.uniform(0.3, 2), rng.uniform(0.5, 1.5), transverse, rng.uniform(0.3, 1.9) * transverse)
    length = rotor.length * np.exp(rng.uniform(np.log(0.4), np.log(2.5)))
    mass = rng.choice([0, 1]) * rng.uniform(0.01, 2)
    spin = rng.uniform(3, 15) * rng.choice([-1, 1])
    other = {"opposite": -spin, "equal": spin, "any": rng.choice([-spin, spin, rng.uniform(-15, 15)])}[kind]
    return Scene((spin, other), rotor, Link(length, mass, mass and rng.uniform(0, 1) * mass * length**2))


def shocked(rng, scene, least=0.02, largest=0.4):
    """The scene with a shock of random width, direction and rotor, `least` to `largest` of the spin's momentum."""
    G, (a, b), natural = max(np.abs(scene.momenta)), scene.inertias, natural_rate(scene)
    size, width = np.exp(rng.uniform(np.log(least), np.log(largest))), rng.uniform(0.05, 1.2) / natural
    angle = rng.choice([0, rng.uniform(-1, 1) * size, rng.uniform(0, 2 * np.pi)])
    impulse = size * G * np.array([np.cos(angle), np.sin(angle) / np.sqrt((a + b) / (a - b)), 0])
    force = tuple(impulse / (scene.rotor.length * width * np.sqrt(np.pi)))
    shock = Shock(force, 8 * width, width, int(rng.choice([1, 2])))
    return Scene(scene.spins, scene.rotor, scene.link, shock)


def held(pairs, refusals, count, most_refused):
    """True errors below the given ones, and not by refusing too often."""
    true, given = np.array(pairs).T
    worst = int(np.argmax(true / given))
    assert (true <= given).all(), (worst, true[worst], given[worst])
    assert refusals <= most_refused * count


def swinging(rng, scene, amplitude):
    """The scene on its linear mode, the larger inclination of the two being `amplitude`."""
    linear = modes(scene)
    values, vectors = np.linalg.eig(linear.upright @ linear.turning @ np.linalg.inv(linear.upright))
    fastest = np.argmax(values.imag)
    mode = vectors[:, fastest] * np.exp(2j * np.pi * rng.uniform())
    mode *= amplitude / max(np.linalg.norm(mode[[0, 1]]), np.linalg.norm(mode[[0, 2]]))
    axes, rates = (
        [[q[0], q[i], z] for i, z in ((1, up), (2, up))]
        for q, up in ((mode.real, 1.0), ((-values[fastest] * mode).real, 0.0))
    )
    axes = np.array(axes)
    axes[:, 2] = np.sqrt(1 - (axes[:, :2] ** 2).sum(1))
    return consistent_scene(scene.spins, axes, rates, scene.rotor, scene.link)


@pytest.mark.parametrize("count", COUNTS)
def test_natural_rate(count):
    rng, pairs, refused = np.random.default_rng(1), [], 0
    while len(pairs) + refused < count:
        scene, amplitude = random_pair(rng), 10 ** rng.uniform(-2, np.log10(0.2))
        natural = natural_rate(scene)
        try:
            times = np.linspace(0, 20 * 2 * np.pi / natural, 1201)
            run = simulate(swinging(rng, scene, amplitude), times, "minimal", 1e-10)
        except LagrotorError:
            refused += 1  # the bar does not reach, or the pair topples over
            continue
        seen = peak(*spectrum(times * natural, run.rates[:, :, 0].mean(0))) * natural
        # The spectrum's own error is about 1e-5 of the rate.
        pairs.append((abs(seen - natural), natural_rate_error(scene, amplitude) + 1e-5 * natural))
    held(pairs, refused, count, 0.1)


@pytest.mark.parametrize("count", COUNTS)
def test_natural_rate_of_one_rotor(count):
    rng = np.random.default_rng(2)
    for _ in range(count):
        one, angle = random_pair(rng), rng.uniform(0.01, 0.4)
        scene = Scene(one.spins, one.rotor, None)
        exact = abs(scene.momenta[0]) / (scene.rotor.J * np.cos(angle))
        error = natural_rate_error(scene, np.sin(angle))
        assert exact - natural_rate(scene) == pytest.approx(error, rel=1e-9)


@pytest.mark.parametrize("count", COUNTS)
def test_shock_response(count):
    rng, pairs, refused = np.random.default_rng(3), [], 0
    while len(pairs) + refused < count:
        scene = shocked(rng, random_pair(rng))
        end = scene.shock.end + rng.uniform(0.2, 3) * 2 * np.pi / natural_rate(scene)
        times = np.linspace(0, end, 301)
        try:
            given = shock_response_error(scene, end)
        except DomainError:
            refused += 1
            continue
        axes, seen = simulate(scene, times, "minimal", 1e-12).axes, shock_response(scene).through(times)
        off = [np.linalg.norm(axes[i, :, :2] - seen[:, [0, i + 1]], axis=-1).max() for i in (0, 1)]
        pairs.append((max(off), given + 1e-11))
    held(pairs, refused, count, 0.5)


def drifts(seed, count, law, error, measure):
    rng, pairs, refused = np.random.default_rng(seed), [], 0
    while len(pairs) + refused < count:
        scene = shocked(rng, random_pair(rng, "opposite"))
        duration = scene.shock.end - scene.shock.at + TURNS * 2 * np.pi / natural_rate(scene)
        try:
            given = error(scene, duration)
        except DomainError:
            refused += 1
            continue
        run = run_after(scene, TURNS, 1e-12)
        leak = mean_error(run.rates, TURNS)
        pairs.append((abs(measure(run) - law(scene)), given + leak))
    held(pairs, refused, count, 0.6)


@pytest.mark.parametrize("count", COUNTS)
def test_toppling_after_a_shock(count):
    drifts(4, count, toppling_after_shock, toppling_error, turning_rate)


@pytest.mark.parametrize("count", COUNTS)
def test_the_mean_x_after_a_shock(count):
    drifts(5, count, wander_after_shock, wander_error, wandering_rate)


@pytest.mark.parametrize("count", [4, pytest.param(40, marks=pytest.mark.slow)])
def test_cancelling_force(count):
    rng, pairs, refused = np.random.default_rng(6), [], 0
    while len(pairs) + refused < count:
        # Below 0.05 the accuracy of the runs is what one sees.
        scene = shocked(rng, random_pair(rng, "opposite"), 0.05)
        x = float(np.hypot(*scene.shock.force[:2]))
        scene = replace(scene, shock=replace(scene.shock, force=(x, 0.0, 0.0)))
        turns = int(rng.choice([8, 20]))
        duration = scene.shock.end - scene.shock.at + turns * 2 * np.pi / natural_rate(scene)
        try:
            given = cancelling_force_error(scene, duration)
        except DomainError:
            refused += 1
            continue
        exact = exact_cancelling_force(scene, turns)
        pairs.append((abs(exact - cancelling_force(scene)), given + 1e-6 * abs(exact)))
    held(pairs, refused, count, 0.5)


def test_the_papers_cancelling_force_lies_within_its_error_for_every_window():
    """−10.98 N over 8 swings, −11.07 over 20, −11.24 over 40: against F_x = 40 the second order has −10.60."""
    scene = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((40, 0, 0), 0.5, 1 / 20))
    turn, law = 2 * np.pi / natural_rate(scene), cancelling_force(scene)
    found = {turns: exact_cancelling_force(scene, turns) for turns in (8, 20)}
    assert found == pytest.approx({8: -10.98, 20: -11.07}, abs=0.006)
    for turns, exact in found.items():
        assert abs(exact - law) < cancelling_force_error(scene, turns * turn + scene.shock.end - scene.shock.at)


@pytest.mark.parametrize("count", COUNTS)
def test_twist_growth(count):
    """Against Hill's equation, itself held to exact runs below."""
    rng, pairs, refused = np.random.default_rng(7), [], 0
    while len(pairs) + refused < count:
        scene, angle = random_pair(rng, "equal"), rng.uniform(0.02, 1.4)
        arguments = (np.sin(angle), scene.momenta[0], *scene.inertias)
        try:
            law, given = float(twist_growth()(*arguments)), float(twist_growth_error()(*arguments))
        except DomainError:
            assert scene.inertias[1] > 0 and not twist_bounded(scene, angle)
            refused += 1
            continue
        turn = abs(scene.momenta[0]) / (sum(scene.inertias) * np.cos(angle))
        pairs.append((abs(twist_multiplier_growth(scene, angle) - law), given + 5e-6 * turn))
    held(pairs, refused, count, 0.3)


@pytest.mark.parametrize("count", [5, pytest.param(50, marks=pytest.mark.slow)])
def test_hills_equation_against_exact_runs(count):
    rng, checked = np.random.default_rng(8), 0
    while checked < count:
        scene, angle = random_pair(rng, "equal"), rng.uniform(0.1, 0.9)
        growth = twist_multiplier_growth(scene, angle)
        half = np.pi * sum(scene.inertias) * np.cos(angle) / abs(scene.momenta[0])
        if growth * half < 0.02:
            continue
        times = half * np.array([np.ceil(6 / growth / half), np.ceil(11 / growth / half)])
        axes = simulate(parallel_scene(scene, angle, 1e-7), times, "minimal", 1e-12).axes
        apart = np.linalg.norm(axes[0] - axes[1], axis=-1)
        assert np.log(apart[1] / apart[0]) / (times[1] - times[0]) == pytest.approx(growth, rel=5e-3)
        checked += 1


def test_a_twist_that_lyapunov_bounds_is_bounded_and_beyond_some_grow():
    grown = []
    for mass in (1, 5, 20):
        scene = Scene((10, 10), link=Link(1, mass, 0))
        for angle in np.linspace(0.1, 1.4, 14):
            growth = twist_multiplier_growth(scene, angle)
            if twist_bounded(scene, angle):
                assert growth == 0
            elif growth:
                grown.append(growth)
    assert max(grown) > 1  # twin: the criterion is not empty


@pytest.mark.parametrize("turns", [4, 6.3, 8, 12.7, 24])
def test_the_mean_of_an_oscillation_is_below_its_error(turns):
    t = np.linspace(0, 1, 2001)
    for phase in np.linspace(0, np.pi, 9):
        wave = np.cos(2 * np.pi * turns * t + phase)
        assert abs(mean_over(t, wave)) < mean_error(wave, turns)
        assert abs(wave.mean()) > 0 or phase  # a plain mean leaves more


def test_what_is_out_of_range_is_refused():
    scene = Scene((10, -10), link=Link(1, 0.01, 0.1), shock=Shock((40, 0, 0), 0.5, 1 / 20))
    with pytest.raises(DomainError, match="a turn by"):
        toppling_error(scene, 60.0)
    with pytest.raises(DomainError, match=r"q = 0\.44"):
        wander_error(Scene((8, -8), link=scene.link, shock=scene.shock), 1.0)
    with pytest.raises(DomainError, match=r"must lie between 0 and 0\.4"):
        natural_rate_error(scene, 0.5)
    with pytest.raises(DomainError, match="the response is not small"):
        shock_response_error(scene, 5.0)
    with pytest.raises(DomainError, match="too few"):
        mean_error(np.ones(9), 3)


def test_every_calibrated_number_names_a_test_that_holds_it():
    assert len(calibrated.TABLE) >= 5
    for name, row in calibrated.TABLE.items():
        file, test = row.held_by.split("::")
        assert f"def {test}(" in (ROOT / file).read_text(), name
