"""Section 4: energies and the shock. Verdicts, their twins, and numbers from other sources."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.paper.audit import statements
from lagrotor.paper.ledger import Relation, judge
from lagrotor.paper.scripts import run as run_script

NAMES = run_script("derivations", "s4_energies")
STATED = {s.id: s for s in NAMES["statements"]}
VERDICTS = {"4.01": "definition", "4.02": "holds", "4.03": "holds", "4.04": "definition", "4.05": "holds-if"}


def changed(relation: Relation) -> Relation:
    return replace(relation, printed=2 * relation.printed)


def test_every_equation_of_the_section_has_one_statement():
    assert [s.id for s in statements("s4_energies")] == list(VERDICTS)


@pytest.mark.parametrize("identifier", VERDICTS)
def test_verdict(identifier):
    assert judge(STATED[identifier]).verdict == VERDICTS[identifier]


@pytest.mark.parametrize("identifier", VERDICTS)
def test_a_changed_coefficient_is_refuted(identifier):
    statement = STATED[identifier]
    for relation in statement.relations:
        assert judge(replace(statement, relations=(changed(relation),), correction=())).verdict == "refuted"


def test_one_wrong_sign_in_the_energy_is_refuted():
    statement = STATED["4.02"]
    M_3 = NAMES["M_3"]
    twin = replace(statement.relations[0], printed=statement.relations[0].printed.subs(M_3, -M_3))
    assert judge(replace(statement, relations=(twin,), correction=())).verdict == "refuted"


def test_the_listing_needs_equal_masses():
    verdict = judge(STATED["4.05"])
    assert verdict.condition.startswith("M_3 = M_2")
    assert judge(replace(STATED["4.05"], given={})).verdict == "refuted"


def test_the_total_energy_is_the_correction_of_4_02():
    assert judge(STATED["4.02"]).correction_verdict == "holds"
    S = NAMES["S"]
    stretched = STATED["4.02"].correction[0]
    without = replace(stretched, printed=stretched.printed.subs(S, 0))
    assert judge(replace(STATED["4.02"], relations=(without,), correction=())).verdict == "refuted"


def test_kinetic_energy_of_point_masses():
    random = np.random.default_rng(4)
    masses, arms = random.uniform(1, 2, 6), random.normal(size=(6, 3))
    arms -= masses @ arms / masses.sum()
    U, Omega = random.normal(size=3), random.normal(size=3)
    direct = (masses * ((U + np.cross(Omega, arms)) ** 2).sum(1)).sum() / 2
    C = (masses[:, None] * arms).T @ arms
    values = dict(zip([*NAMES["U_1"], *NAMES["O_1"], NAMES["M_1"]], [*U, *Omega, masses.sum()], strict=True))
    values |= {NAMES["moments"][0][i, j]: C[i, j] for i in range(3) for j in range(3)}
    others = dict.fromkeys(NAMES["printed_E"].free_symbols - set(values), 0)
    assert float(NAMES["printed_E"].subs(values | others)) == pytest.approx(direct, rel=1e-12)
    assert float(NAMES["printed_E"].subs(values | others | {NAMES["M_1"]: 0})) != pytest.approx(direct, rel=1e-3)


def test_the_light_bar_counts_a_hundredfold():
    light = {NAMES["M_1"]: 1, NAMES["M_2"]: 1, NAMES["M_3"]: sp.Rational(1, 100), NAMES["U_3"][0]: 1}
    sides = NAMES["listed_E"], NAMES["printed_E"]
    rest = dict.fromkeys(sides[0].free_symbols | sides[1].free_symbols, 0)
    listed, right = (side.subs(rest | light) for side in sides)
    assert listed == 100 * right == sp.Rational(1, 2)
    even = light | {NAMES["M_3"]: 1}
    assert sides[0].subs(rest | even) == sides[1].subs(rest | even)


def test_the_initial_energy_is_that_of_a_run():
    def run(spin):
        return simulate(Scene(spins=(10, spin), link=Link(mass=1, inertia=1)), np.linspace(0, 1, 5)).energy

    np.testing.assert_allclose(run(10), 100, rtol=1e-9)
    assert abs(run(11)[0] - 100) > 1


def test_the_shock_and_its_impulse():
    shock = Shock(force=(50, 0, 0), at=2.0, width=1 / 50)
    assert shock.impulse[0] == pytest.approx(float(NAMES["impulse"]), rel=1e-14)
    times = np.linspace(0, 10, 100001)
    summed = (50 * np.exp(-((50 * (times - 2)) ** 2))).sum() * (times[1] - times[0])
    assert summed == pytest.approx(np.sqrt(np.pi), rel=1e-9)
    assert Shock(force=(50, 0, 0), at=2.0, width=1 / 20).impulse[0] != pytest.approx(summed, rel=0.1)


def test_the_damping_ratio_is_that_of_the_roots():
    values = {NAMES["M"]: 1, NAMES["n"]: 20, NAMES["omega_s"]: 10, NAMES["m_eff"]: sp.Rational(4, 5)}
    ratio, S, D = (float(NAMES[name].subs(values)) for name in ("damping_ratio", "printed_S", "printed_D"))
    roots = np.roots([0.8, D, S])
    expected = -roots.real.sum() / (2 * np.sqrt(np.prod(roots).real))
    assert ratio == pytest.approx(expected, rel=1e-12)
    assert 2 * ratio != pytest.approx(expected, rel=1e-3)
