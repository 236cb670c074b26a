"""Every answer about the paired precession gives its own error, and the true one is below it: random rotors and bars.

The exact orbits are held to an independent solution, Fourier collocation of the Cartesian equations; all answers to orbits in
numbers of 64 bits.
"""

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
from lagrotor.theory.paired_precession.orbit_harmonics import start_of
from tests.models.orbits_at_once import ENOUGH, exact_orbits

PHASES = np.linspace(0, 2 * np.pi, 121)
MASSLESS, LONG_ROTOR = Scene(spins=(10, -10)), Rotor(1.3, 0.8, 0.9, 1.2)


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


def sampled(orbit: PrecessionOrbit) -> Truth:
    return Truth(orbit.at_phase(PHASES), start_of(orbit.harmonics)[1], orbit.frequency, orbit.momentum)


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
    found["momentum"] = abs(answer.momentum - truth.momentum) / answer.momentum_error
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


def checked(bars: int, amplitudes: int, seed: int, truths) -> dict[str, list[float]]:
    rng, answers, ratios = np.random.default_rng(seed), [], {}
    for _ in range(bars):
        scene = random_scene(rng)
        for r0 in np.exp(rng.uniform(np.log(0.01), np.log(0.7), amplitudes)):
            tol = rng.choice([1e-4, 1e-6, 1e-9])
            answers.append(precession_orbit(scene, r0, tol))
            assert answers[-1].error <= tol and answers[-1].frequency_error <= tol * natural_rate(scene)
    for answer, truth in zip(answers, truths(answers), strict=True):
        for name, ratio in held(answer, truth).items():
            assert ratio < 1, (name, answer)
            ratios.setdefault(name, []).append(ratio)
    return ratios


def test_no_answer_is_farther_off_than_it_says() -> None:
    """And no bound is idle."""
    ratios = checked(4, 1, 1, lambda answers: [sampled(exact(one.scene, one.r0)) for one in answers])
    assert all(max(each) > 0.03 for each in ratios.values())


@pytest.mark.slow
@pytest.mark.skipif(not ENOUGH, reason="needs numbers of 64 bits")
@pytest.mark.parametrize("seed", [2, 3, 4, 5])
def test_no_answer_of_ten_thousand_is_farther_off_than_it_says(seed: int) -> None:
    """And the bounds are not idle: of each kind some are within a factor of ten; a tenth of them would fail.

    Of a start a factor of twenty: its bound is twice the orbit's, since going to the bar may double a distance.
    """
    ratios = checked(50, 50, seed, in_64_bits)
    assert len(ratios["orbit"]) == 2_500
    for name, values in ratios.items():
        assert len(values) > 1_000, name
        assert max(values) > (0.05 if name == "start" else 0.1), name


def collocated(scene: Scene, r0: float, guess: PrecessionOrbit) -> tuple[float, np.ndarray]:
    """(frequency, harmonics) of the orbit, by Newton's method on the Cartesian equations with multipliers, in SI units.

    Unknown are the harmonics of x, y, z of rotor 1, of its multiplier and of the bar's, and the frequency; their Jacobian
    is had by complex steps. No integration, no reduced coordinates.
    """
    own, shared = scene.inertias
    H, G, k = len(guess.harmonics) + 8, abs(scene.momenta[0]), scene.k
    natural = G / np.sqrt(own**2 - shared**2)
    h = np.arange(H + 1)
    phase, even, odd = np.pi * (h + 0.5) / (H + 1), h[h % 2 == 0], (-1.0) ** h
    c, s = np.cos(np.outer(phase, h)), np.sin(np.outer(phase, h))
    ends = np.cumsum([H + 1, H, H + 1, H + 1, len(even)])

    def equations(v: np.ndarray) -> np.ndarray:
        X, Y, Z, unit, pull, last = np.split(v, ends)
        Y, w = np.concatenate([[0.0], Y]), last[0] * natural
        normal, tension = own * natural**2 * (c @ unit), own * natural**2 * (c[:, even] @ pull)

        def three(waves: np.ndarray, first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, ...]:
            return first @ waves, w * (second @ (h * waves)), -(w**2) * (first @ (h**2 * waves))

        (x, xd, xa), (y, yd, ya), (z, zd, za) = three(X, c, -s), three(Y, s, c), three(Z, c, -s)
        (x2, _, x2a), (y2, _, y2a), (z2, _, z2a) = (
            three(waves, *of) for waves, of in ((-X * odd, (c, -s)), (Y * odd, (s, c)), (Z * odd, (c, -s)))
        )
        motion = [
            own * xa + shared * x2a - G * (y * zd - z * yd) - normal * x + tension * (k + x2),
            own * ya + shared * y2a - G * (z * xd - x * zd) - normal * y + tension * y2,
            own * za + shared * z2a - G * (x * yd - y * xd) - normal * z + tension * z2,
        ]
        bar = k * (x2 - x) + 1 - x * x2 - y * y2 - z * z2  # even under the exchange
        rows = [*(m / (own * natural**2) for m in motion), x * x + y * y + z * z - 1, 2 / (H + 1) * c[:, even].T @ bar]
        return np.concatenate([*rows, [X.sum() - r0]])

    start = np.zeros((H + 1, 3))
    start[: len(guess.harmonics)] = guess.harmonics
    v = np.concatenate([start[:, 0], start[1:, 1], start[:, 2], np.zeros(H + 1 + len(even)), [1.0]])
    for _ in range(12):
        slope = np.stack([equations(v + 1e-30j * unit).imag / 1e-30 for unit in np.eye(len(v))], axis=1)
        step = np.linalg.lstsq(slope, equations(v), rcond=1e-13)[0]
        v = v - step
        if np.abs(step).max() < 1e-14:
            break
    X, Y, Z = np.split(v, ends)[:3]
    return float(v[-1] * natural), np.stack([X, np.concatenate([[0.0], Y]), Z], axis=1)


@pytest.mark.parametrize(
    ("scene", "r0"),
    [
        (MASSLESS, 0.5),
        (Scene((-7, 7), LONG_ROTOR, Link(1.1, 0.6, 0.2)), 0.2),
        pytest.param(Scene((12, -12), link=Link(0.7, 0.5, 0.1)), 0.4, marks=pytest.mark.slow),
        pytest.param(MASSLESS, 0.8, marks=pytest.mark.slow),
        pytest.param(Scene((5, -5), link=Link(1.6, 0.2, 0.05)), 0.7, marks=pytest.mark.slow),
    ],
)
def test_the_exact_orbit_is_that_of_collocation_within_its_error(scene: Scene, r0: float) -> None:
    orbit = exact_orbit(scene, r0)
    answer = orbit_harmonics(orbit, scene, r0)
    frequency, harmonics = collocated(scene, r0, answer)
    apart = (
        np.abs(harmonics[: len(answer.harmonics)] - answer.harmonics).sum()
        + np.abs(harmonics[len(answer.harmonics) :]).sum()
    )
    assert apart < answer.error < 1e-11
    assert abs(frequency - abs(orbit.frequency)) < orbit.frequency_error < 1e-10
    other = collocated(replace(scene, link=replace(scene.link, length=1.01 * scene.link.length)), r0, answer)[0]
    assert abs(other - frequency) > 1e-5  # twin: another bar


@pytest.mark.parametrize(
    ("scene", "r0", "seen"),
    [(MASSLESS, 0.5, 7.53671), (Scene((10, -10), link=Link(0.5)), 0.3, 6.53314)],
)
def test_where_the_series_was_off_the_exact_orbit_answers(scene: Scene, r0: float, seen: float) -> None:
    orbit = precession_orbit(scene, r0)
    assert orbit.frequency == pytest.approx(seen, abs=6e-6)
    assert orbit.method.startswith("exact orbit")
    assert precession_orbit(scene, 0.05).method.startswith("series")


def test_more_orders_for_a_smaller_tolerance_then_the_exact_orbit() -> None:
    methods = [precession_orbit(MASSLESS, 0.15, tol).method for tol in (1e-2, 1e-4, 1e-6, 1e-10)]
    assert methods == [f"series through r₀{n}" for n in ["⁵", "⁹", "¹³"]] or len(set(methods)) >= 3
    assert methods[-1].startswith("exact orbit")


def test_at_any_time_within_the_error_that_time_allows() -> None:
    """A hundred turns later, against the exact orbit continued by its period; the phase's error adds up."""
    truth, orbit = exact(MASSLESS, 0.2), precession_orbit(MASSLESS, 0.2, 1e-6)
    times = 100 * 2 * np.pi / truth.frequency + np.linspace(0, 1, 41)
    apart = np.linalg.norm(orbit(times) - truth(times), axis=-1).max()
    assert orbit.error < apart < orbit.error_at(times).max()


def test_refused() -> None:
    for r0 in (1.0, -2, float("nan"), "much"):
        with pytest.raises(DomainError, match="r0"):
            precession_orbit(MASSLESS, r0)
    for tol in (0, -1e-9, 2, "fine", True):
        with pytest.raises(InputError, match="tol"):
            precession_orbit(MASSLESS, 0.1, tol)
    with pytest.raises(InputError, match="opposite"):
        precession_orbit(Scene(spins=(10, 10)), 0.1)
    with pytest.raises(DomainError, match="reaches tol = 1e-14; take a larger tol"):
        precession_orbit(MASSLESS, 0.3, 1e-14)
    with pytest.raises(DomainError, match="at rest"):
        exact_orbit(MASSLESS, 0.0)


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
