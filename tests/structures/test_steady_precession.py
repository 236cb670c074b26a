"""Steady precessions and their multipliers: the top's textbook law, the pair's own orbit, the modes' limit, exact runs."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Structure, floquet
from lagrotor.structures import example
from lagrotor.structures.coefficients import coefficients

TOP = Structure([(0, 0)], spins=12.0, gravity=9.81, load=0.2)
EQUAL = replace(example("corner"), spins=(26.8, 0.0, 26.8))  # its rates are equal in pairs
CORNER = replace(EQUAL, spins=(27.0, 3.0, 27.5))


@pytest.mark.parametrize(("mode", "tilt"), [(0, 0.2), (1, 0.6)])
def test_a_top_precesses_and_nutates_as_the_textbooks_have_it(mode: int, tilt: float) -> None:
    """A Ω² cos θ − G Ω + S g = 0; ν² = Ω² − 2 (S g/A) cos θ + (S g/(A Ω))² (Routh, Advanced Rigid Dynamics, § 207)."""
    c, cosine = coefficients(TOP), np.sqrt(1 - tilt**2)
    A, G, pull = c.A[0], c.G[0], 9.81 * c.S[0]
    Omega = (G + (-1, 1)[mode] * np.sqrt(G**2 - 4 * A * cosine * pull)) / (2 * A * cosine)
    nu = np.sqrt(Omega**2 - 2 * pull / A * cosine + (pull / (A * Omega)) ** 2)
    orbit = TOP.steady_precession(mode, tilt)
    assert 2 * np.pi / orbit.period == pytest.approx(Omega, rel=1e-10)
    assert orbit.axes[0] == pytest.approx([tilt, 0, cosine], abs=1e-11)
    off = np.abs(orbit.multipliers[2:] - np.exp(2j * np.pi * nu / Omega * np.array([1, -1])))
    other = np.abs(orbit.multipliers[2:] - np.exp(-2j * np.pi * nu / Omega * np.array([1, -1])))
    assert np.minimum(off, other).max() < orbit.errors.max() < 1e-5
    assert orbit.multipliers[:2] == pytest.approx(1) and orbit.growth == 0


@pytest.mark.parametrize("link", [Link(mass=0.01, inertia=0.1), Link(mass=1.0, inertia=1.0)])
def test_the_pairs_paired_precession_is_one_of_a_structure(link: Link) -> None:
    pair = Structure([(-0.5, 0), (0.5, 0)], [(0, 1)], [10, -10], link=link)
    orbit, exact = pair.steady_precession(2, 0.3), floquet(Scene(spins=(10, -10), link=link), 0.3)
    assert 2 * np.pi / orbit.period == pytest.approx(exact.frequency, rel=1e-10)
    assert exact.kind == "hyperbolic" and orbit.growth == pytest.approx(exact.growth, abs=2 * orbit.errors[2])
    assert orbit.errors[2] < 1e-7 and "growth" in repr(orbit)
    # Another amplitude is told apart.
    assert abs(floquet(Scene(spins=(10, -10), link=link), 0.301).growth - orbit.growth) > 1e3 * orbit.errors[2]


def test_the_exact_motion_leaves_a_precession_as_its_multiplier_has_it() -> None:
    """Near a resonance the fastest mode's precession feeds the others: each turn by the largest multiplier."""
    orbit = CORNER.steady_precession(3, 0.05)
    growth, turns = np.exp(orbit.growth), 30
    assert orbit.growth > 0.1 and orbit.mismatch < 1e-9
    t = orbit.period * np.arange(turns + 1)
    apart = (
        CORNER.simulate(t, orbit.axes + 1e-7 * np.arange(9).reshape(3, 3), orbit.rates, tol=1e-7).axes
        - orbit.axes[:, None]
    )
    sizes = np.linalg.norm(apart, axis=(0, 2))
    assert sizes[-1] > 100 * sizes[1] and sizes[-1] / sizes[-2] == pytest.approx(growth, rel=5e-3)
