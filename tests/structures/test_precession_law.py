"""The law of precessions at small tilts: Routh's top, exact orbits and their multipliers, the edge, what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Structure
from lagrotor.numerics import measured_order
from lagrotor.structures.coefficients import coefficients

TRIANGLE = Structure([(0, 0), (1, 0), (0.3, 0.9)], [(0, 1), (1, 2), (2, 0)], [-6.5, 7.7, 7.5], hinge=20.0)


@pytest.mark.parametrize("mode", [0, 1])
def test_a_tops_shift_is_that_of_its_steady_precession(mode: int) -> None:
    """A Ω² cos θ − G Ω + w = 0: over sin² θ, ± A Ω²/(2 R) with R² = G² − 4 A w."""
    top = Structure([(0, 0)], spins=13.0, gravity=9.81, load=0.2)
    law, c = top.precession_law(mode), coefficients(top)
    root = np.sqrt(c.G[0] ** 2 - 4 * c.A[0] * 9.81 * c.S[0])
    assert law.shift == pytest.approx((-1, 1)[mode] * c.A[0] * law.rate**2 / (2 * root), rel=1e-9)
    assert law.skew == pytest.approx(0, abs=1e-12) and law.edge == np.inf
    assert law.rate_at(0.0) == law.rate == pytest.approx(top.modes().rates[mode])


def test_what_it_leaves_of_exact_orbits_is_of_fourth_order() -> None:
    structure, tilts, left = replace(TRIANGLE, spins=(9, 14, 7), gravity=9.81, load=0.3, hinge=40.0), (0.015, 0.03), []
    law = structure.precession_law(0)
    assert law.sign == 1 and (law.others > 0).all() and "stable" in repr(law)
    for tilt in tilts:
        orbit = structure.steady_precession(0, tilt)
        rate = 2 * np.pi / orbit.period
        apart = np.abs(np.subtract.outer(orbit.multipliers[2:], law.multipliers_at(tilt))).min(1).max()
        symmetric = law.rate + law.shift * tilt**2  # twin: without what the tilt is off the amplitude
        left.append((abs(rate - law.rate_at(tilt)), apart, abs(rate - symmetric)))
    orders = [measured_order(tilts, part) for part in zip(*left, strict=True)]
    assert orders == pytest.approx([4, 4, 3], abs=0.1)


def test_beyond_its_edge_exact_multipliers_leave_the_circle() -> None:
    law = TRIANGLE.precession_law(2)
    assert 0.05 < law.edge < 0.06
    tilts = np.linspace(0, law.reach, 2001)
    first = next(tilt for tilt in tilts if law.growth_at(tilt))  # twin: sought at many tilts
    assert 0 <= first - law.edge < 1.01 * tilts[1]
    below, beyond = (TRIANGLE.steady_precession(2, factor * law.edge) for factor in (0.9, 1.3))
    assert below.growth == 0 == law.growth_at(0.9 * law.edge)
    assert beyond.growth == pytest.approx(law.growth_at(1.3 * law.edge), rel=0.02)
    for orbit in (below, beyond):  # symplectic: the multipliers' product is 1
        assert abs(np.prod(orbit.multipliers) - 1) < 4 * orbit.errors.max() < 1e-8
