"""Section 5.3: the rates. Verdicts, their twins, and the closed forms against exact runs."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from lagrotor import Link, Scene, natural_rate
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.pair.symbols import K, k, m, omega, r0, sigma
from lagrotor.paper.ledger import Relation, judge
from lagrotor.paper.scripts import run as run_script

NAMES = run_script("derivations", "s5_3_natural_rates")
STATED = {s.id: s for s in NAMES["statements"]}
VERDICTS = {
    "5.23": "holds-to-order",
    "5.24": "measured",
    "5.25": "measured",
    "5.26": "refuted",
    "5.27": "refuted",
    "5.28": "refuted",
}


def twins(expression: sp.Expr) -> list[sp.Expr]:
    """The expression with its sign turned, doubled, and with one coefficient of each of its sums turned."""
    found = [-expression, 2 * expression]
    for total in expression.atoms(sp.Add):
        term = total.args[0]
        found.append(expression.xreplace({total: total - 2 * term}))
    return found


def test_every_equation_of_the_section_has_one_statement() -> None:
    assert list(STATED) == list(VERDICTS)


@pytest.mark.parametrize("identifier", VERDICTS)
def test_verdict(identifier: str) -> None:
    verdict = judge(STATED[identifier])
    assert verdict.verdict == VERDICTS[identifier]
    if identifier != "5.23":
        assert verdict.correction_verdict == ("holds-to-order" if identifier == "5.27" else "holds")


@pytest.mark.parametrize("identifier", VERDICTS)
def test_changed_coefficients_are_refuted(identifier: str) -> None:
    statement = STATED[identifier]
    held = statement.correction or statement.relations
    for i, relation in enumerate(held):
        for twin in twins(relation.printed):
            others = (*held[:i], replace(relation, printed=twin), *held[i + 1 :])
            assert judge(replace(statement, relations=others, correction=(), measured=False)).verdict == "refuted"


def test_inclination_is_refuted_at_second_order_on_its_own() -> None:
    factor = STATED["5.27"].relations[2]
    verdict = judge(replace(STATED["5.27"], relations=(factor,), correction=()))
    assert (verdict.verdict, verdict.order) == ("refuted", 1)


def test_constant_holds_for_the_bar_it_belongs_to_and_no_other() -> None:
    relation = STATED["5.25"].correction[1]
    heavy = Relation(sp.Rational(57, 80), relation.derived.subs(m, NAMES["mass_of_c"]))
    assert judge(replace(STATED["5.25"], relations=(heavy,), correction=(), measured=False)).verdict == "holds"
    other = Relation(sp.Rational(57, 80), relation.derived)
    assert judge(replace(STATED["5.25"], relations=(other,), correction=(), measured=False)).verdict == "refuted"


@pytest.mark.parametrize("mass", [0.2, 1.0, 2.0])
def test_curve_of_bars_that_give_the_printed_product(mass: float) -> None:
    inertia = float(NAMES["bar_of_product"].subs(m, mass))
    assert natural_rate(Scene(spins=(10, -10), link=Link(1, mass, inertia))) == pytest.approx(5.7, rel=1e-12)
    assert natural_rate(Scene(spins=(10, -10), link=Link(1, mass, inertia * 1.1))) != pytest.approx(5.7, rel=1e-4)


def test_no_listed_bar_gives_it() -> None:
    assert all(abs(rate - 5.7) > 0.5 for rate in NAMES["rates"].values())
    assert all(abs(rate - 0.57) > 3 for rate in NAMES["rates"].values())


def test_measured_rates() -> None:
    assert NAMES["one_gentle"] == pytest.approx(16, rel=1e-5)
    assert NAMES["pair_gentle"] == pytest.approx(80 / 7, rel=1e-5)
    assert NAMES["pair_gentle"] != pytest.approx(11.4, rel=1e-3)
    assert NAMES["one_rate"] == pytest.approx(16 / np.sqrt(1 - NAMES["one_amplitude"] ** 2), rel=1e-4)
    assert NAMES["steady_rate"] == pytest.approx(NAMES["turning"], rel=1e-8)
    assert NAMES["apart"] < 1e-9


def test_sign_of_the_change_with_amplitude() -> None:
    """Below the curve sigma = 3 − 3/k² the rate rises, above it falls; at ell = R it always falls."""
    curvature = NAMES["curvature"]
    for ratio, shape in ((1, 0.5), (1, 2), (1.2, 1), (1.3, 1), (2, 2.2), (2, 2.3)):
        rises = shape < NAMES["flip_sigma"].subs(k, ratio)
        assert (curvature.subs({k: ratio, sigma: shape}) > 0) == rises
    assert NAMES["flip_k"] == sp.sqrt(sp.Rational(3, 2))


@pytest.mark.parametrize("length", [1.2, 1.3])
def test_exact_orbits_on_both_sides_of_the_turn(length: float) -> None:
    scene = Scene(spins=(10, -10), link=Link(length=length))
    change = exact_orbit(scene, 0.02).frequency / natural_rate(scene) - 1
    assert (change > 0) == (length > float(NAMES["flip_k"]))
    assert change / 0.02**2 == pytest.approx(float(NAMES["curvature"].subs({sigma: 1, k: length})), abs=2e-3)
    assert change / 0.02**2 != pytest.approx(0.5, abs=0.3)  # what 1/cos theta would give


def test_rates_depend_on_the_inertia_of_the_bar_for_opposite_spins_only() -> None:
    assert not NAMES["equal"].has(K)
    assert NAMES["opposite_squared"].has(K)
    assert NAMES["ratio"].subs(r0, 0) == 1
    assert NAMES["of_paper_rotor"].has(omega)
