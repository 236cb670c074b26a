"""Every answer about the paired precession, the exact orbit too, gives its error: held to orbits in numbers of 64 bits."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from lagrotor import (
    Link,
    Rotor,
    Scene,
    corrected_trajectories,
    natural_rate,
    paired_frequency,
    paired_momentum,
    precession_orbit,
)
from lagrotor.errors import DomainError, InputError
from lagrotor.models import exact_orbit
from lagrotor.models.orbits.precession import orbit_harmonics
from lagrotor.theory import PrecessionOrbit, series_orbit
from tests.models.orbits_at_once import ENOUGH, exact_orbits

PHASES = np.linspace(0, 2 * np.pi, 121)
MASSLESS = Scene(spins=(10, -10))


def random_scene(rng: np.random.Generator) -> Scene:
    """Any rotor, a bar from half to twice as long as its axis, massless or with sigma from 0.4 to 1.8, either sense."""
    spin, mass = rng.choice([-1, 1]) * rng.uniform(3, 20), rng.choice([0.0, 1.0], p=[0.2, 0.8]) * rng.uniform(0.05, 1.5)
    rotor = Rotor(rng.uniform(0.5, 2), rng.uniform(0.7, 1.5), transverse := rng.uniform(0.5, 2), transverse * 0.8)
    length = rotor.length * rng.choice([rng.uniform(0.5, 1), 1.0, rng.uniform(1, 2)])
    values = [round(float(v), 3) for v in (spin, mass, mass * rng.uniform(0, 0.5), length)]
    exact = Rotor(*(round(float(v), 3) for v in (rotor.mass, rotor.length, rotor.I1, rotor.I3)))
    length = exact.length if length == rotor.length else values[3]
    return Scene((values[0], -values[0]), exact, Link(length, values[1], values[2]))


class Truth(NamedTuple):
    """Axes (2, 121, 3) at PHASES; at the start their slope by the phase (2, 3); frequency and momentum."""

    axes: np.ndarray
    slope: np.ndarray
    frequency: float
    momentum: float


def exact(scene: Scene, r0: float) -> PrecessionOrbit:
    return orbit_harmonics(exact_orbit(scene, r0), scene, r0)


def in_64_bits(answers: list[PrecessionOrbit]) -> list[Truth]:
    """Of the same pairs and amplitudes, by thirty steps in a quarter of the turn; the others are its images."""
    found, flip, side = [], np.array([1.0, -1.0, 1.0]), np.array([-1.0, 1.0, 1.0])
    orbits = exact_orbits([(one.start, one.frequency) for one in answers], [one.r0 for one in answers], 30)
    for one, z, time, axes, v in zip(answers, orbits.start, orbits.time, orbits.axes, orbits.rates, strict=True):
        frequency, first, later = np.copysign(np.pi / 2 / float(time), one.frequency), axes[0], axes[1] * side
        turn = np.concatenate([first, (later * flip)[::-1][1:], later[1:], (first * flip)[::-1][1:-1]])
        other = np.roll(turn, 60, axis=0) * side  # r_1 half a turn before, x → −x
        both = np.stack([turn, other])[:, np.arange(121) * int(np.sign(frequency)) % 120]
        momentum = 2 * sum(one.scene.inertias) * (1 - one.r0**2) * float(z[2])
        found.append(Truth(both, v[:, 0] / frequency, frequency, momentum))
    return found


def off(one: PrecessionOrbit, truth: Truth) -> float:
    return float(np.linalg.norm(one.at_phase(PHASES) - truth.axes, axis=-1).max())


def held(answer: PrecessionOrbit, truth: Truth) -> dict[str, float]:
    """True errors over those given, by answer; what is refused is left out."""
    found, scene, r0 = {}, answer.scene, answer.r0
    found["orbit"] = off(answer, truth) / answer.error
    found["frequency"] = abs(answer.frequency - truth.frequency) / answer.frequency_error
    start = answer.start
    away, slower = np.array(start.axes) - truth.axes[:, 0], np.array(start.rates) / truth.frequency - truth.slope
    found["start"] = np.linalg.norm([away, slower], axis=-1).max() / (2 * answer.error)
    for order in (5, 9):
        try:
            one = series_orbit(scene, r0, order)
        except DomainError:
            continue
        found[f"order {order}"] = off(one, truth) / one.error
        found[f"frequency, order {order}"] = abs(one.frequency - truth.frequency) / one.frequency_error
    bar = (scene.sigma, scene.k)
    true = {
        paired_frequency(3): ((r0, *bar), truth.frequency / natural_rate(scene) * np.sign(scene.spins[0])),
        paired_momentum(4): ((r0, *bar), truth.momentum / scene.momenta[0]),
        corrected_trajectories(3): ((r0, PHASES[38], *bar), truth.axes[:, 38].ravel()),
    }
    for form, (arguments, value) in true.items():
        try:
            bound = np.array(form.error(*arguments))
        except DomainError:
            continue
        found[form.name] = float((np.abs(np.array(form(*arguments)) - value) / (bound + 1e-13)).max())
    return found


def checked(bars: int, amplitudes: int, seed: int) -> dict[str, list[float]]:
    rng, answers, ratios = np.random.default_rng(seed), [], {}
    for _ in range(bars):
        scene = random_scene(rng)
        for r0 in np.exp(rng.uniform(np.log(0.01), np.log(0.7), amplitudes)):
            tol = rng.choice([1e-4, 1e-6, 1e-9])
            answers.append(precession_orbit(scene, r0, tol))
            assert answers[-1].error <= tol and answers[-1].frequency_error <= tol * natural_rate(scene)
        answers.append(exact(scene, r0))
    for answer, truth in zip(answers, in_64_bits(answers), strict=True):
        for name, ratio in held(answer, truth).items():
            assert ratio < 1, (name, answer)
            ratios.setdefault(name, []).append(ratio)
    return ratios


@pytest.mark.skipif(not ENOUGH, reason="needs numbers of 64 bits")
def test_no_answer_is_farther_off_than_it_says() -> None:
    """Nor is an exact orbit, and no bound is idle."""
    ratios = checked(4, 1, 1)
    assert all(max(each) > 0.03 for each in ratios.values())


@pytest.mark.slow
@pytest.mark.skipif(not ENOUGH, reason="needs numbers of 64 bits")
@pytest.mark.parametrize("seed", [2, 3])
def test_no_answer_of_five_thousand_is_farther_off_than_it_says(seed: int) -> None:
    """Of each kind some are within a factor of ten, of a start, whose bound is twice the orbit's, of twenty."""
    ratios = checked(50, 50, seed)
    assert len(ratios["orbit"]) == 2_550
    for name, values in ratios.items():
        assert len(values) > 1_000, name
        assert max(values) > (0.05 if name == "start" else 0.1), name


@pytest.mark.parametrize(
    ("scene", "r0", "seen"),
    [(MASSLESS, 0.5, 7.53671), (Scene((10, -10), link=Link(0.5)), 0.3, 6.53314)],
)
def test_where_the_series_was_off_the_exact_orbit_answers(scene: Scene, r0: float, seen: float) -> None:
    orbit = precession_orbit(scene, r0)
    assert orbit.frequency == pytest.approx(seen, abs=6e-6)
    assert orbit.method.startswith("exact orbit")
    assert precession_orbit(scene, 0.05).method.startswith("series")


def test_an_orbit_of_negative_amplitude_is_half_a_period_later() -> None:
    one, other = precession_orbit(MASSLESS, 0.4), precession_orbit(MASSLESS, -0.4)
    assert other.frequency == pytest.approx(one.frequency, rel=1e-10)
    assert np.abs(one.at_phase(PHASES + np.pi)[0] - other.at_phase(PHASES)[0]).max() < 1e-9


def test_a_form_without_a_bound_says_so_and_an_exact_one_is_exact() -> None:
    from lagrotor.theory.natural_frequency import natural_frequency

    form = natural_frequency()
    assert form.error(1.25, 0.1, 10, -10) == 0
    assert np.shape(form.error([1.25, 1.3], 0.1, 10, -10)) == (2,)
    with pytest.raises(InputError, match="no bound"):
        replace(paired_frequency(3), bound=None).error(0.1, 1.0, 1.0)
    with pytest.raises(DomainError, match="outside its domain"):
        paired_frequency(3).error(1.1, 1.0, 1.0)
