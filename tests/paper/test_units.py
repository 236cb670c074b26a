"""Dimensions of printed lines: a changed exponent is found, a number that stands for a quantity is said to do so."""

import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import coordinates
from lagrotor.paper import Glossary, Paper, Premise
from lagrotor.paper.catalogue import section_glossary, section_meanings
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.paper.scripts import beside
from lagrotor.paper.units import Dimensions, dimension_of, dimensions, unit_text
from lagrotor.paper.verdicts import Statement, chain

GLOSSARY = Glossary()
m = GLOSSARY.letter("m", "mass", "kg", positive=True)
l = GLOSSARY.letter("l", "length", "m", positive=True)
g = GLOSSARY.letter("g", "free fall", "m/s²", positive=True)
I = GLOSSARY.letter("I", "inertia", "kg m²", positive=True)
t = GLOSSARY.letter("t", "time", "s", real=True)
n = GLOSSARY.letter("n", "a number", "1", positive=True)
odd = GLOSSARY.letter("q", "an old length", "furlong", positive=True)
c = GLOSSARY.moving(coordinates("theta"), ("angle", "rad"))
(theta,), (theta_dot,) = c.q, c.v
alien = sp.Symbol("z", real=True)
f = sp.Function("l")


@pytest.mark.parametrize(
    ("unit", "read"),
    [
        ("kg m²/s", "kg m²/s"),
        ("kg m^2 s^-1", "kg m²/s"),
        ("kg*m**2 / s", "kg m²/s"),
        ("N/(rad s)", "kg m/s³"),
        ("rad/s/s²", "1/s³"),
        ("mJ", "kg m²/s²"),
        ("W", "kg m²/s³"),
        ("kg m⁻¹ s⁻²", "kg m⁻¹ s⁻²"),
        ("Pa", "kg m⁻¹ s⁻²"),
        ("°", "1"),
        ("1", "1"),
        ("m^(1/2)", "m^(1/2)"),
    ],
)
def test_a_unit_is_read_as_glossaries_write_it(unit: str, read: str) -> None:
    assert unit_text(dimension_of(unit)) == read


@pytest.mark.parametrize("unit", ["furlong", "J/kg K", "2 m", "m + s", "", "sin(m)", "m**n", "__import__('os')"])
def test_what_is_no_unit_is_not_guessed(unit: str) -> None:
    with pytest.raises(InputError, match="unit"):
        dimension_of(unit)


def of(printed: object, derived: object, **values: object) -> Dimensions:
    numbers = {s: sp.sympify(values[s.name]) for s in GLOSSARY if s.name in values}
    return dimensions(sp.sympify(printed), sp.sympify(derived), GLOSSARY, numbers)


ENERGY = m * l**2 * theta_dot**2 / 2 + m * g * l * (1 - sp.cos(theta))


@pytest.mark.parametrize(
    "alike",
    [
        ENERGY,
        sp.Integer(0),
        sp.Abs(ENERGY),
        sp.sqrt(I * m * g**2),
        m * g * sp.diff(f(t), t) * t,
        I * sp.Integral(theta_dot**3, t),
        m * g * l * sp.exp(-t * sp.sqrt(g / l)),
        m * g * l * sp.log(l / f(t)) ** n,
        m * g * sp.Max(l, f(t)),
        I * sp.atan2(l, f(t)) / t**2,
    ],
)
def test_terms_of_one_dimension_are_consistent(alike: sp.Expr) -> None:
    assert of(alike, ENERGY).answer == "consistent"
    assert of(alike * g, ENERGY).answer == ("consistent" if alike == 0 else "inconsistent")


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        (ENERGY + m * l * theta_dot**2, "a sum of different dimensions"),
        (m * g * l * sp.cos(t), "the argument of cos, t, is s"),
        (m * g * l * 2**t, "an exponent, t, is s"),
        (m * g * l**2, "printed kg m³/s², derived kg m²/s²; derived/printed is 1/m"),
        (ENERGY / I, "derived/printed is kg m²"),
        (sp.Max(m, t), "a sum of different dimensions"),
        (alien + m + t, "a sum of different dimensions"),
    ],
)
def test_what_differs_is_named(wrong: sp.Expr, why: str) -> None:
    found = of(wrong, ENERGY)
    assert found.answer == "inconsistent" and why in found.says


def test_a_letter_without_a_unit_is_named() -> None:
    assert of(alien * m, m) == Dimensions("not known", "z: it has no unit")
    assert "'furlong' is not defined" in of(odd, l).says
    assert "with a symbol in the exponent" in of(l**n, l).says


def test_numbers_stand_for_quantities_where_a_premise_says_so() -> None:
    found = of(1 + l / 2, l, l=1, m=1)
    assert (found.answer, found.says.split(" written as numbers")[0]) == ("in units", "with l = 1")
    assert of(1 + l / 2, l, m=1).answer == "inconsistent"
    assert of(1 + l / 2, l, l=0).answer == "inconsistent", "nothing is measured in units of zero"
    both = of(sp.Integer(3), l**3 * m**2, l=1, m=20)
    assert both.answer == "in units" and both.says.startswith(
        "with m = 20, l = 1 written as numbers, the units of the sides differ"
    )


def test_the_verdict_does_not_rest_on_them_but_shows_them() -> None:
    statement = Statement("", chain(I * theta_dot, theta_dot), (Premise("unit inertia", {I: sp.Integer(1)}),))
    decided = decide(statement, GLOSSARY)
    assert (decided.verdict, decided.lines[0].dimensions.answer) == ("holds-if", "in units")
    wrong = decide(Statement("", chain(I * theta_dot, theta_dot)), GLOSSARY)
    assert wrong.verdict == "refuted" and wrong.lines[0].dimensions.answer == "inconsistent"
    assert decide(statement).lines[0].dimensions is None


def beside_papers(name: str) -> Paper:
    return Paper(beside("derivations").parent / "papers" / name)


# Every line of the papers whose dimensions differ, and why: each is refuted.
INCONSISTENT = {
    ("rotor_pair", "3.16"): "P(Ω) = ΩᵀΩ lacks the square of the norm below it: derived/printed is s²",
    ("rotor_pair", "5.16"): "B = 2 ω lacks the inertia: derived/printed is kg m²",
    ("heavy_top", "4.1"): "4 m g l I₁/I₃ lacks a square of I₃, misprinted on purpose: derived/printed is kg⁻¹ m⁻²",
}


@pytest.mark.parametrize("name", ["rotor_pair", "heavy_top", "hoop", "pendulum"])
def test_every_printed_line_of_the_papers(name: str) -> None:
    """All that the papers' records name, and 5.16 and 3.16 themselves."""
    paper = PAPER if name == "rotor_pair" else beside_papers(name)
    wrong = {
        (name, identifier): sentence
        for identifier, row in paper.recorded.items()
        for sentence in row.dimensions or ()
        if ": inconsistent: " in sentence
    }
    assert wrong.keys() == {key for key in INCONSISTENT if key[0] == name}
    for key, sentence in wrong.items():
        assert sentence.rpartition("; ")[2] in INCONSISTENT[key]
        assert paper.recorded[key[1]].verdict == "refuted"


def test_units_of_a_sections_letters_are_those_of_the_catalogue(tmp_path) -> None:
    (tmp_path / "paper.toml").write_text('title = "A"\n[sections]\n1 = "one"\n')
    head = '[letters.1]\nvector = "F"\n[units.1]\nN = "F"\n'
    (tmp_path / "equations.toml").write_text(head)
    assert {s.name: entry.unit for s, entry in section_glossary(Paper(tmp_path), "1").items()} == dict.fromkeys(
        ("F_x", "F_y", "F_z"), "N"
    )
    (tmp_path / "equations.toml").write_text(head + 'kg = "M"\n')
    with pytest.raises(InputError, match="section 1 has no symbol 'M'"):
        section_glossary(Paper(tmp_path), "1")


def test_meanings_of_a_sections_letters_go_before_those_of_the_glossary(tmp_path) -> None:
    (tmp_path / "paper.toml").write_text('title = "A"\n[sections]\n1 = "one"\n2 = "two"\n')
    (tmp_path / "equations.toml").write_text("[meanings.1]\nR = ['a rotation', '1']\n")
    assert section_meanings(Paper(tmp_path), "1") == {"R": ("a rotation", "1")}
    assert section_meanings(Paper(tmp_path), "2") == {}
    assert section_meanings(PAPER, "3")["M"] == ("sum of the masses", "kg")
    assert section_meanings(PAPER, "5.2")["M"] == ("mass of a rotor", "kg")
    for wrong in ("R = 'a rotation'", "R = ['a rotation']", "R = ['a rotation', 1]"):
        (tmp_path / "equations.toml").write_text(f"[meanings.1]\n{wrong}\n")
        with pytest.raises(InputError, match=r"meanings: section 1: R has .*: write \[meaning, unit\]"):
            Paper(tmp_path)
