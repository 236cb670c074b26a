"""Section 4: energies and the shock. Verdicts, their twins, and numbers from other sources."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.paper import decide
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


def test_every_equation_of_the_section_has_one_statement():
    assert sorted(stated()) == [identifier for identifier in PAPER.equations if identifier.startswith("4.")]


def test_one_wrong_sign_in_the_energy_is_refuted(kinetic, masses):
    statement = stated()["4.02"]
    twin = replace(statement.relations[-1], printed=kinetic.subs(masses[2], -masses[2]))
    assert decide(replace(statement, relations=(twin,), correction=())).verdict == "refuted"


def test_only_the_chosen_function_is_a_definition():
    assert {i: decide(s).verdict for i, s in stated().items() if not decide(s).premises} == {
        "4.01": "holds",
        "4.04": "definition",
    }


def test_the_printed_energy_needs_unstretched_links_and_the_listing_equal_masses_too():
    kinetic, listing = decide(stated()["4.02"]), decide(stated()["4.05"])
    assert ["no link is stretched" in premise.says for premise in kinetic.premises] == [True]
    assert "S/4" in kinetic.premises[0].broken
    assert [premise.says for premise in listing.premises] == [
        "the bar is as heavy as a rotor, M₃ = M₂",
        "no link is stretched, s_j = 0",
    ]
    for premise in listing.premises:
        left = tuple(other for other in listing.premises if other != premise)
        assert decide(replace(stated()["4.05"], premises=left)).verdict == "refuted"
    assert decide(replace(stated()["4.02"], premises=())).verdict == "refuted"


def test_the_total_energy_is_the_correction_of_4_02():
    assert decide(stated()["4.02"]).correction_verdict == "holds"
    whole = stated()["4.02"].correction[0]
    without = replace(whole, printed=whole.printed.subs(names_of(ENERGY)["S"], 0))
    assert decide(replace(stated()["4.02"], relations=(without,), premises=(), correction=())).verdict == "refuted"


def test_changed_physics_of_the_energy_and_of_the_damper(changed_physics):
    doubled = changed_physics([(ENERGY, "sp.expand(dot(field, field) / 2)", "sp.expand(dot(field, field))")], ENERGY)
    assert [doubled[i].verdict for i in ("4.02", "4.03", "4.05")] == ["refuted"] * 3
    turning = changed_physics([(ENERGY, "field = U + cross(Omega, d)", "field = U + 2 * cross(Omega, d)")], ENERGY)
    assert turning["4.03"].verdict == "refuted"
    quadratic = changed_physics([(LINKS, "newton / (metre / second)\n", "newton / (metre / second) ** 2\n")], LINKS)
    assert quadratic["4.01"].verdict == "refuted"


def test_kinetic_energy_of_point_masses(kinetic, masses):
    random = np.random.default_rng(4)
    points, arms = random.uniform(1, 2, 6), random.normal(size=(6, 3))
    arms -= points @ arms / points.sum()
    U, Omega = random.normal(size=3), random.normal(size=3)
    direct = (points * ((U + np.cross(Omega, arms)) ** 2).sum(1)).sum() / 2
    tensor = sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(points, arms, strict=True))
    names = names_of(ENERGY)
    letters = [*names["velocities"][0], *names["turns"][0], masses[0], *names["inertias"][0]]
    values = dict(zip(letters, [*U, *Omega, points.sum(), *tensor.ravel()], strict=True))
    others = dict.fromkeys(kinetic.free_symbols - set(values), 0)
    assert float(kinetic.subs(values | others)) == pytest.approx(direct, rel=1e-12)
    assert float(kinetic.subs(values | others | {masses[0]: 0})) != pytest.approx(direct, rel=1e-3)


def test_the_light_bar_counts_a_hundredfold(kinetic, masses):
    listing = stated()["4.05"].relations[0].printed
    light = {**dict(zip(masses, (1, 1, sp.Rational(1, 100)), strict=True)), names_of(ENERGY)["velocities"][2][0]: 1}
    rest = dict.fromkeys(listing.free_symbols | kinetic.free_symbols, 0)
    listed, right = (side.subs(rest | light) for side in (listing, kinetic))
    assert listed == 100 * right == sp.Rational(1, 2)
    even = light | {masses[2]: 1}
    assert listing.subs(rest | even) == kinetic.subs(rest | even)


def test_the_initial_energy_is_that_of_a_run():
    def run(spin):
        return simulate(Scene(spins=(10, spin), link=Link(mass=1, inertia=1)), np.linspace(0, 1, 5)).energy

    np.testing.assert_allclose(run(10), 100, rtol=1e-9)
    assert abs(run(11)[0] - 100) > 1


def test_the_shock_and_its_impulse():
    shock = Shock(force=(50, 0, 0), at=2.0, width=1 / 50)
    assert shock.impulse[0] == pytest.approx(float(names_of(SHOCK)["impulse"].subs(names_of(SHOCK)["own"])), rel=1e-14)
    times = np.linspace(0, 10, 100001)
    summed = (50 * np.exp(-((50 * (times - 2)) ** 2))).sum() * (times[1] - times[0])
    assert summed == pytest.approx(np.sqrt(np.pi), rel=1e-9)
    assert Shock(force=(50, 0, 0), at=2.0, width=1 / 20).impulse[0] != pytest.approx(summed, rel=0.1)


def test_the_damping_ratio_is_that_of_the_roots():
    names = names_of(LINKS)
    values = {names["M"]: 1, names["n"]: 20, names["omega_s"]: 10, names["m_eff"]: sp.Rational(4, 5)}
    ratio, S, D = (float(names[name].subs(values)) for name in ("damping_ratio", "S", "D"))
    roots = np.roots([0.8, D, S])
    expected = -roots.real.sum() / (2 * np.sqrt(np.prod(roots).real))
    assert ratio == pytest.approx(expected, rel=1e-12)
    assert 2 * ratio != pytest.approx(expected, rel=1e-3)
