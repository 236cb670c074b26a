"""Section 4: energies and the shock. Verdicts, their twins, and numbers from other sources."""

from functools import cache

import numpy as np
import pytest
import sympy as sp

from lagrotor.paper.rotor_pair.own_paper import PAPER

LINKS, ENERGY, SHOCK = "s4a_link_constants", "s4b_energy", "s4c_shock"


def names_of(stem):
    return PAPER.scripts.run("derivations", stem)


@cache
def stated():
    return {s.id: s for stem in (LINKS, ENERGY, SHOCK) for s in PAPER.statements(stem)}


@pytest.fixture(scope="module")
def masses():
    return names_of(ENERGY)["masses"]


@pytest.fixture(scope="module")
def kinetic():
    """The energy that 4.02 prints."""
    return stated()["4.02"].relations[-1].printed


def test_changed_physics_of_the_energy_and_of_the_damper(changed_physics):
    doubled = changed_physics([(ENERGY, "sp.expand(dot(field, field) / 2)", "sp.expand(dot(field, field))")], ENERGY)
    assert [doubled[i].verdict for i in ("4.02", "4.03", "4.05")] == ["refuted"] * 3
    turning = changed_physics([(ENERGY, "field = U + cross(Omega, d)", "field = U + 2 * cross(Omega, d)")], ENERGY)
    assert turning["4.03"].verdict == "refuted"
    quadratic = changed_physics([(LINKS, "newton / (metre / second)\n", "newton / (metre / second) ** 2\n")], LINKS)
    assert quadratic["4.01"].verdict == "refuted"


def test_the_light_bar_counts_a_hundredfold(kinetic, masses):
    listing = stated()["4.05"].relations[0].printed
    light = {**dict(zip(masses, (1, 1, sp.Rational(1, 100)), strict=True)), names_of(ENERGY)["velocities"][2][0]: 1}
    rest = dict.fromkeys(listing.free_symbols | kinetic.free_symbols, 0)
    listed, right = (side.subs(rest | light) for side in (listing, kinetic))
    assert listed == 100 * right == sp.Rational(1, 2)
    even = light | {masses[2]: 1}
    assert listing.subs(rest | even) == kinetic.subs(rest | even)


def test_the_damping_ratio_is_that_of_the_roots():
    names = names_of(LINKS)
    values = {names["M"]: 1, names["n"]: 20, names["omega_s"]: 10, names["m_eff"]: sp.Rational(4, 5)}
    ratio, S, D = (float(names[name].subs(values)) for name in ("damping_ratio", "S", "D"))
    roots = np.roots([0.8, D, S])
    expected = -roots.real.sum() / (2 * np.sqrt(np.prod(roots).real))
    assert ratio == pytest.approx(expected, rel=1e-12)
    assert 2 * ratio != pytest.approx(expected, rel=1e-3)
