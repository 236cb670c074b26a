"""Section 5.3: under which premises its rates are those measured, twins, and the closed forms against exact runs."""

from dataclasses import replace
from functools import cache
from typing import Any

import pytest
import sympy as sp

from lagrotor import Link, Scene, natural_rate
from lagrotor.models import exact_orbit
from lagrotor.pair import lagrangians
from lagrotor.pair.notation import J, K, R, ell, k, m, sigma
from lagrotor.paper import Premise
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.claims.natural_rates import coefficient
from lagrotor.paper.rotor_pair.premises import (
    HEAVY_BAR,
    LIGHT_BAR_PREMISE,
    ONE_KILOGRAM_BAR,
    PAPERS_ROTOR,
)
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.verdicts import Statement

STEMS = ("s5_3a_equal_spins", "s5_3b_opposite_spins")


@cache
def names() -> dict[str, Any]:
    first, second = (PAPER.scripts.run("derivations", stem) for stem in STEMS)
    return first | second


@cache
def stated() -> dict[str, Statement]:
    return {s.id: s for stem in STEMS for s in PAPER.statements(stem)}


def alone(identifier: str, quantity: str, premises: tuple[Premise, ...] = ()) -> str:
    """The verdict of one line of an equation, under these premises only."""
    lines = tuple(r for r in stated()[identifier].relations if quantity in r.quantity)
    return decide(replace(stated()[identifier], relations=lines, correction=(), premises=premises)).verdict


def test_5_28_agrees_with_5_25_on_equal_spins_and_is_refuted_by_opposite_ones() -> None:
    assert alone("5.28", "equal", (PAPERS_ROTOR, ONE_KILOGRAM_BAR)) == "holds-if"
    assert alone("5.27", "equal", (PAPERS_ROTOR, ONE_KILOGRAM_BAR)) == "holds-if"
    for bar in (HEAVY_BAR, LIGHT_BAR_PREMISE):
        assert alone("5.28", "opposite", (PAPERS_ROTOR, bar)) == "refuted"
    in_its_ends = Premise("a bar of 1 kg, its mass in its ends", {m: 1, K: sp.Rational(1, 4)})
    assert alone("5.28", "opposite", (PAPERS_ROTOR, in_its_ends)) == "holds-if"
    assert alone("5.27", "opposite", (PAPERS_ROTOR, in_its_ends)) == "refuted", "the inclination is wrong besides"


@pytest.mark.parametrize("number", ["5.7", "0.57"])
def test_neither_number_of_5_26_is_the_rate_of_a_listed_bar(number: str) -> None:
    (printed,) = (r for r in stated()["5.26"].relations if r.printed == sp.Rational(number))
    lone = replace(stated()["5.26"], relations=(printed,), correction=())
    assert decide(lone).verdict == "refuted"
    its_bar = Premise("the bar that has 5.7", {m: 1, K: names()["inertia_of_product"].subs(m, 1), names()["eta"]: 0})
    assert decide(replace(lone, premises=(its_bar,))).verdict == ("measured" if number == "5.7" else "refuted")


def test_other_inertia_flips_the_rate_of_one_rotor(monkeypatch: pytest.MonkeyPatch, changed_physics: Any) -> None:
    energy = lagrangians._rotor_energy
    monkeypatch.setattr(lagrangians, "_rotor_energy", lambda inertia, *rest: energy(2 * inertia, *rest))
    assert {i: found.verdict for i, found in changed_physics([], "s5_3a_equal_spins").items()} == {
        "5.23": "refuted",
        "5.24": "measured",
        "5.25": "measured",
    }, "the pair is not built from this Lagrangian"


def test_other_masses_of_the_bar_flip_the_constant(monkeypatch: pytest.MonkeyPatch, changed_physics: Any) -> None:
    """The bar's mass whole on each axis, a = J + m R²/2 + K R²/ell²: the premises of 5.24 and 5.25 suffice no longer."""
    before = stated()["5.25"]
    monkeypatch.setitem(lagrangians.INERTIAS, lagrangians.a, J + m * R**2 / 2 + K * R**2 / ell**2)
    assert decide(before).verdict == "measured", "what was derived before stays"
    found = changed_physics([], "s5_3a_equal_spins")
    assert (found["5.24"].verdict, found["5.25"].verdict) == ("refuted", "refuted")


@pytest.mark.parametrize("mass", [0.2, 1.0, 2.0])
def test_curve_of_bars_that_give_the_printed_product(mass: float) -> None:
    inertia = float(names()["inertia_of_product"].subs(m, mass))
    assert natural_rate(Scene(spins=(10, -10), link=Link(1, mass, inertia))) == pytest.approx(5.7, rel=1e-12)
    assert natural_rate(Scene(spins=(10, -10), link=Link(1, mass, inertia * 1.1))) != pytest.approx(5.7, rel=1e-4)


@pytest.mark.parametrize("length", [1.2, 1.3])
def test_exact_orbits_on_both_sides_of_the_turn(length: float) -> None:
    scene = Scene(spins=(10, -10), link=Link(length=length))
    change = exact_orbit(scene, 0.02).frequency / natural_rate(scene) - 1
    assert (change > 0) == (length > float(names()["flip_k"]))
    assert change / 0.02**2 == pytest.approx(float(names()["curvature"].subs({sigma: 1, k: length})), abs=2e-3)
    assert change / 0.02**2 != pytest.approx(0.5, abs=0.3)  # what 1/cos theta would give


@pytest.mark.parametrize(
    ("mass", "inertia", "by_average", "by_parallel"), [(1, 1, -0.0955, -0.0725), (1, 0.1, -0.330, -0.364)]
)
def test_the_change_of_the_rate_is_by_the_average_inclination(
    mass: float, inertia: float, by_average: float, by_parallel: float
) -> None:
    """The print has the average inclination; by that of parallel axes the exact orbits' change is another."""
    bar = Link(1, mass, inertia)
    big, coupled = Scene(spins=(10, -10), link=bar).inertias
    put = {sigma: (big + coupled) / (big - coupled), k: 1}
    measured, _ = coefficient((10, -10), bar)
    assert measured == pytest.approx(by_average, abs=5e-4)
    assert measured != pytest.approx(by_parallel, abs=5e-4)
    assert float(names()["in_average"].subs(put)) == pytest.approx(by_average, abs=5e-4)
    assert float(names()["curvature"].subs(put)) == pytest.approx(by_parallel, abs=5e-4)
