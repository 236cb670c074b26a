"""Friction and spin-down: what they take from the energy, for any structure of massless bars; the pair's decay."""

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Structure

CORNER = {"joints": [(0, 0), (1, 0), (1, 1)], "bars": [(0, 1), (1, 2)]}
TILT = [(0.3, 0.1), (0.3, -0.2), (-0.1, -0.2)]
RATES = [(0.5, 1.0), (0.5, -1.0), (1.5, -1.0)]
J = Rotor().J


@pytest.mark.parametrize("spins", [(20.0, -10.0, 5.0), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("spin_friction", [0.0, 0.3])
def test_friction_takes_the_energy_of_any_large_motion_at_one_rate_whatever_the_spins(spins, spin_friction) -> None:
    s = Structure(**CORNER, spins=spins, friction=0.4, spin_friction=spin_friction)
    t = np.linspace(0, 3, 16)
    energy = s.simulate(t, TILT, RATES, tol=1e-9).tilt_energy
    assert energy / energy[0] == pytest.approx(np.exp(-2 * 0.4 * t / J), rel=1e-7)
    heavy = (
        Structure(**CORNER, spins=spins, friction=0.4, link=Link(1, 1, 0.5))
        .simulate(t, TILT, RATES, tol=1e-9)
        .tilt_energy
    )
    assert np.abs(heavy / heavy[0] / np.exp(-2 * 0.4 * t / J) - 1).max() > 0.05


def test_spin_down_alone_takes_nothing_of_the_energy_of_the_tilt() -> None:
    s = Structure(**CORNER, spins=(20.0, -10.0, 5.0), spin_friction=0.5, link=Link(1, 1, 0.5))
    run = s.simulate(np.linspace(0, 4, 9), TILT, RATES, tol=1e-9)
    assert np.ptp(run.tilt_energy) < 1e-7 * run.tilt_energy[0]


@pytest.mark.parametrize("link", [Link(), Link(1, 1, 0.5), Link(1, 1, 0)])
@pytest.mark.parametrize("friction", [0.05, 0.5])
def test_the_paired_precession_decays_at_its_closed_form(link, friction) -> None:
    a, b = Scene(spins=(10.0, -10.0), link=link).inertias
    found = Structure([(0, 0), (1, 0)], [(0, 1)], [10.0, -10.0], link=link, friction=friction).modes()
    k = int(np.argmax(found.rates))
    assert -found.growth[k] == pytest.approx(a * friction / (a**2 - b**2), rel=1e-9)
