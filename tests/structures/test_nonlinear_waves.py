"""Waves beyond first order: the shift of their rate against exact runs and the heavy top, and where three of them meet."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from lagrotor import Link, Pattern, Rotor
from lagrotor.errors import InputError
from lagrotor.numerics import measured_order
from lagrotor.structures import local_hamiltonian, polygon_ring, square, straight_row, wave_amplitude
from lagrotor.structures.coefficients import coefficients
from lagrotor.structures.resonances import normal_form_of
from lagrotor.structures.small_motion import small_motion

MIXED = Pattern(
    joints=((0, 0), (1, 0)), steps=((1, 1),), turn=pi, bars=((0, 1),), braces=((1, 0, 1, 12.0),), spins=(9.0, 14.0),
    hinge=(20.0, 31.0), load=(0.0, 0.3), rotor=(Rotor(), Rotor(mass=1.5, length=1.2)),
)  # fmt: skip


def seen(wave, count: int, amplitude: float, band: int) -> tuple[float, float]:
    """Rate and amplitude of the wave in 15 turns of the exact motion."""
    t = np.linspace(0, 30 * pi / wave.rate, 601)
    run = wave.pattern.piece(count).simulate(t, *wave.state(count, amplitude=amplitude), tol=1e-7)
    a, weight = wave_amplitude(wave.pattern, run, (count,), wave.q, band), np.hanning(len(t) + 2)[1:-1]
    return -np.polyfit(t, np.unwrap(np.angle(a)), 1, w=weight)[0], np.average(np.abs(a), weights=weight)


@pytest.mark.parametrize(
    ("pattern", "count", "turns", "band", "amplitudes"),
    [
        (polygon_ring(5, spins=14.0, hinge=30.0, link=Link(mass=0.2, inertia=0.05)), 5, 2, 0, (0.03, 0.045, 0.07)),
        (MIXED, 2, 1, 1, (0.03, 0.045, 0.07)),
    ],
)
def test_what_the_shift_leaves_is_of_fourth_order(pattern, count, turns, band, amplitudes) -> None:
    """Rigid bars, unequal rotors with bars and springs in turn at q = π.

    The twin is the shift left out, of second order.
    """
    wave = pattern.nonlinear_wave(2 * pi * turns / count, band)
    rates, sizes = np.transpose([seen(wave, count, a, band) for a in amplitudes])
    rest = rates - wave.rate - wave.shift * sizes**2
    assert abs(measured_order(sizes, np.abs(rest)) - 4) < 0.1
    assert abs(measured_order(sizes, np.abs(rates - wave.rate)) - 2) < 0.1


@pytest.mark.parametrize("band", [0, 1])
def test_rotors_that_lean_alike_are_a_heavy_top(band: int) -> None:
    """A cos θ φ'² − G φ' + g S = 0 of its steady precession, whatever the springs between: at q = 0 they stay as they are."""
    pattern = straight_row(spring=30.0, spins=25.0, gravity=9.81, load=0.4)
    c = coefficients(pattern.piece(1))
    A, G, S = c.A[0], c.G[0], 9.81 * c.S[0]

    def precession(a: float) -> float:
        slope = A * sqrt(1 - a * a)
        return (G + (-1, 1)[band] * sqrt(G * G - 4 * slope * S)) / (2 * slope)

    wave = pattern.nonlinear_wave(0.0, band)
    assert wave.rate == pytest.approx(precession(0.0)) and wave.energy_sign == (-1, 1)[band]
    small = np.array([0.02, 0.04, 0.08])
    rest = [abs(precession(a) - wave.rate_at(a)) for a in small]
    assert abs(measured_order(small, rest) - 4) < 0.1 and rest[-1] < 1e-3 * wave.rate


@pytest.mark.parametrize(
    ("pattern", "count", "waves"),
    [
        (replace(MIXED, spins=(2.0, -14.0)), 2, ((0, 0), (0, 2), (1, 1))),
        (
            polygon_ring(5, spins=40.0, load=0.2, gravity=9.81, link=Link(mass=0.3, inertia=0.05)),
            5,
            ((1, 0), (2, 0), (2, -1)),
        ),
    ],
)
def test_the_shift_is_that_of_the_normal_form_of_a_ring(pattern, count, waves) -> None:
    """ω_j + 2 c_j I with the action I of the ring, by canonical transformations of its Hamiltonian: springs, opposite spins with
    bars, slow waves with less energy than rest, of bands below zero. The twin is c of another mode."""
    s = pattern.piece(count)
    form, rate, basis = normal_form_of(s), local_hamiltonian(s).rate, local_hamiltonian(s).basis
    linear = small_motion(s)
    unit = np.abs(linear.mass).max() * rate
    frequencies = np.real(form.frequencies) * rate
    own = [form.actions.get(tuple(2 * (i == j) for i in range(len(frequencies))), 0) for j in range(len(frequencies))]
    for turns, band in waves:
        wave = pattern.nonlinear_wave(2 * pi * turns / count, band)
        tilts, rates = (x.reshape(-1) @ basis for x in wave.state(count, amplitude=1e-7))
        # twice the energy of the linear wave is 2 |ω| times its action
        energy = rates @ linear.mass @ rates / 2 + tilts @ linear.stiffness @ tilts / 2
        action, shift = np.abs(energy) / wave.rate / unit / 1e-14, 2 * np.array(own) * wave.energy_sign
        mode = int(np.argmin(np.abs(frequencies - wave.energy_sign * wave.rate)))
        assert abs(frequencies[mode]) == pytest.approx(wave.rate) and np.sign(energy) == wave.energy_sign
        assert wave.shift == pytest.approx(shift[mode] * action * rate, rel=1e-5)
        assert np.abs(np.delete(shift, mode) * action * rate / wave.shift - 1).min() > 1e-2


def test_a_pattern_in_the_plane_that_is_joined_along_one_step_is_a_row() -> None:
    row = straight_row(spring=20.0, spins=11.0, hinge=15.0).nonlinear_wave(1.1, 1)
    plane = Pattern(((0, 0),), ((1, 0), (0, 1)), spins=11.0, hinge=15.0, braces=((0, 0, (1, 0), 20.0),))
    assert plane.nonlinear_wave((1.1, 0.7), 1).shift == pytest.approx(row.shift, rel=1e-9)
    net = square(spring=20.0, spins=11.0, hinge=15.0).nonlinear_wave((1.1, 0.7), 1)
    turned = square(spring=20.0, spins=11.0, hinge=15.0).nonlinear_wave((-0.7, 1.1), 1)
    assert net.shift == pytest.approx(turned.shift, rel=1e-9) and abs(net.shift / row.shift - 1) > 1e-3


def test_a_wave_that_is_pumped_decays_into_two_at_the_rate_of_the_coupling() -> None:
    """A hexagon tuned so that waves of 3 and 4 turns of phase add up to one of 1; what the law leaves is of third order."""
    pattern = polygon_ring(6, spring=30.0, spins=6.0, hinge=13.170295680965312)
    triads = pattern.three_waves(pi)
    triad = min(triads, key=lambda w: abs(w.q[1, 0] - 4 * pi / 3))
    assert triad.q[:, 0] % (2 * pi) == pytest.approx([pi, 4 * pi / 3, pi / 3], abs=1e-9)
    assert triad.rates[0] + triad.rates[1] == pytest.approx(triad.rates[2]) and triad.energy_signs == (1, 1, 1)
    assert triad.growth(0, 1.0) == triad.growth(1, 1.0) == 0 and not triad.explosive
    pumped, rest = (0.01, 0.02, 0.04), []
    for amplitude in pumped:
        growth = triad.growth(2, amplitude)
        parts = [
            pattern.nonlinear_wave(triad.q[k], triad.bands[k]).state(6, amplitude=a)
            for k, a in ((0, 1e-6), (2, amplitude))
        ]
        t = np.linspace(0, 5 / growth, 401)
        run = pattern.piece(6).simulate(t, *(one + other for one, other in zip(*parts, strict=True)), tol=1e-8)
        grown = np.abs(wave_amplitude(pattern, run, (6,), triad.q[0], triad.bands[0]))
        rest.append(1 - np.polyfit(t[200:], np.log(grown[200:]), 1)[0] / growth)
    assert abs(measured_order(pumped, rest) - 2) < 0.3 and rest[0] < 0.02


def test_energies_of_both_signs_grow_together() -> None:
    """Under weight the slow precessions have less energy than rest: two of them and a fast one that is their sum explode."""
    pattern = polygon_ring(6, spring=0.3, spins=7.2, gravity=9.81, load=0.3)
    triads = [w for m in range(6) for w in pattern.three_waves(pi / 3 * m)]
    growing = [w for w in triads if w.explosive]
    assert growing and all(w.energy_signs == (-1, -1, 1) for w in growing)
    assert all(w.growth(k, 1.0) > 0 for w in growing for k in range(3))


def test_a_triad_may_have_a_wave_that_is_numbered_at_the_opposite_wave_number_and_leaves_out_what_grows() -> None:
    pattern = polygon_ring(6, spring=4.0, spins=9.0, gravity=9.81, load=0.3)
    assert pattern.dispersion(np.linspace(0, 2 * pi, 25)).falls
    triad = next(w for w in pattern.three_waves(0.0) if min(w.bands) < 0)
    assert triad.rates[0] + triad.rates[1] == pytest.approx(triad.rates[2]) and triad.rates.min() > 0
    k = int(np.argmin(triad.bands))
    opposite = pattern.dispersion(-triad.q[k]).rates[0]
    assert opposite[-1 - triad.bands[k]] == pytest.approx(-triad.rates[k])
    with pytest.raises(InputError, match=f"it is band {triad.bands[k]} of −q"):
        pattern.nonlinear_wave(-triad.q[k], -1 - triad.bands[k])
