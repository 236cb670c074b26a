"""Actions and frequencies of librations against closed forms and the normal form."""

from math import pi, sqrt

import pytest
import sympy as sp
from scipy.special import ellipe, ellipk

from lagrotor.errors import DomainError, InputError, IntegrationError
from lagrotor.mechanics import System, coordinates, libration

c = coordinates("x")
(x,), (v,) = c.q, c.v
PENDULUM = System(c, v**2 / 2 + sp.cos(x)).hamiltonian()


@pytest.mark.parametrize("energy", [-0.999, -0.5, 0.9, 0.9999])
def test_the_pendulum_has_its_elliptic_integrals(energy):
    m, found = (1 + energy) / 2, libration(PENDULUM, energy, 0.0)
    assert found.action == pytest.approx(8 / pi * (ellipe(m) - (1 - m) * ellipk(m)), rel=1e-11)
    assert found.frequency == pytest.approx(pi / (2 * ellipk(m)), rel=1e-9)
    assert found.error < 1e-12


def test_a_morse_well_and_a_bead_with_a_turning_mass():
    D, k = 2.0, 0.7
    morse = System(c, v**2 / 2 - D * (1 - sp.exp(-sp.Float(k) * x)) ** 2).hamiltonian()
    E = 1.3
    assert libration(morse, E, 0.0).action == pytest.approx(sqrt(2 * D) / k * (1 - sqrt(1 - E / D)), rel=1e-12)
    assert libration(morse, E, 0.0).frequency == pytest.approx(k * sqrt(2 * (D - E)), rel=1e-12)
    # A mass of the place and a term linear in the velocity, which is a total derivative: the same as without it.
    parts = [System(c, (1 + x**2) * v**2 / 2 - x**2 + more).hamiltonian() for more in (0, x**2 * v)]
    one, other = (libration(h, 0.5, 0.1) for h in parts)
    assert one.action == pytest.approx(other.action, rel=1e-12) and one.frequency != pytest.approx(sqrt(2), rel=1e-3)


def test_the_normal_form_is_the_energy_as_a_function_of_the_action():
    """To tenth order: what is left falls as the action to the sixth."""
    n, off = PENDULUM.normal_form(order=10, at={x: 0}), []
    for energy in (-0.9, -0.8):
        found = libration(PENDULUM, energy, 0.0)
        series = sum(float(value) * found.action**power for (power,), value in n.actions.items())
        off.append(abs(series - energy))
        assert float(n.frequencies_at([found.action])[0]) == pytest.approx(found.frequency, abs=1e-6)
    assert 5.5 < sp.log(off[1] / off[0]) / sp.log(2.1) < 6.5


def test_what_does_not_librate_is_refused():
    with pytest.raises(IntegrationError, match="does not turn"):
        libration(PENDULUM, 1.5, 0.0)
    with pytest.raises(InputError, match="not above that of rest"):
        libration(PENDULUM, -1.5, 0.0)
    with pytest.raises(InputError, match="g without a value"):
        libration(System(c, v**2 / 2 - sp.Symbol("g") * x**2).hamiltonian(), 1.0, 0.0)
    two = coordinates("x y")
    with pytest.raises(DomainError, match="one degree of freedom"):
        libration(System(two, sum(u**2 for u in two.v)).hamiltonian(), 1.0, 0.0)


@pytest.mark.parametrize("below", [1e-6, 1e-9, 1e-11])
def test_beside_the_separatrix_the_frequency_is_right_to_its_error(below):
    """The place where the force vanishes is a turning point's neighbour: E − W bends there and is no force times a distance."""
    from mpmath import mp

    with mp.workdps(30):
        m = (1 + mp.mpf(1 - below)) / 2
        frequency, action = mp.pi / (2 * mp.ellipk(m)), 8 / mp.pi * (mp.ellipe(m) - (1 - m) * mp.ellipk(m))
    found = libration(PENDULUM, 1 - below, 0.0)
    assert found.frequency == pytest.approx(float(frequency), rel=found.frequency_error)
    assert found.action == pytest.approx(float(action), rel=found.error)
    assert found.error < 1e-12 and found.frequency_error < 1e-14 / below + 1e-10
    assert found.frequency != pytest.approx(
        float(frequency) * (1 + 1e3 * found.frequency_error), rel=found.frequency_error
    )


@pytest.mark.parametrize("energy", [1.0, 1.0 + 1e-9, float("nan"), "1"])
def test_on_the_separatrix_and_without_an_energy_there_is_no_frequency(energy):
    """Stepped with an error of 1e-10 a pendulum of 1e-9 too much seems to turn after some rounds."""
    with pytest.raises((IntegrationError, InputError), match=r"separatrix|finite numbers"):
        libration(PENDULUM, energy, 0.0)
