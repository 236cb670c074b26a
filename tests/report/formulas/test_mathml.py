"""MathML of formulas: in the elements that browsers draw, spaced as TeX spaces, a line for each part."""

import re
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest
import sympy as sp

from lagrotor.mechanics.glossary import latex as tex
from lagrotor.pair.notation import PAIR, ROTOR, Omega, ell, r0
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.formulas import mathml_latex

THIN = '<mspace width="0.167em" />'
# Elements of MathML Core; browsers draw others as plain rows.
CORE = {
    "math",
    "mrow",
    "mi",
    "mn",
    "mo",
    "mtext",
    "mspace",
    "mfrac",
    "msqrt",
    "mroot",
    "msub",
    "msup",
    "msubsup",
    "mover",
    "munder",
    "munderover",
    "mpadded",
    "mtable",
    "mtr",
    "mtd",
}
theta, phi = ROTOR.q[0], ROTOR.q[1]


@pytest.fixture(scope="module")
def printed() -> dict[str, str]:
    pytest.importorskip("latex2mathml", reason="latex2mathml reads the printed formulas")
    return {entry.id: mathml_latex.mathml(entry.latex) or "" for entry in PAPER.equations.values()}


def tree(formula: str) -> Element:
    return ElementTree.fromstring(formula)


def latex(source: str) -> str:
    """One formula within a line, without the outer elements."""
    pytest.importorskip("latex2mathml", reason="latex2mathml reads the printed formulas")
    found = mathml_latex.mathml(source, display=False)
    assert found
    return bare(found)


def bare(formula: str) -> str:
    return re.sub(r"^<math>(<mrow>)?|(</mrow>)?</math>$", "", formula)


def lines(source: str) -> list[Element]:
    """The `<math>` elements of a formula on lines of its own."""
    return list(tree(f"<div>{mathml_latex.mathml(source)}</div>"))


def test_every_printed_equation_is_whole_and_in_the_words_of_browsers(printed: dict[str, str]) -> None:
    assert len(printed) == len(PAPER.equations) > 60
    for identifier, formula in printed.items():
        elements = list(tree(f"<div>{formula}</div>").iter())[1:]
        assert {element.tag for element in elements} <= CORE, identifier
        assert all((e.text or "").strip("\u00a0") for e in elements if e.tag in ("mi", "mn", "mo", "mtext")), identifier
        assert {e.get("mathvariant") for e in elements} <= {None, "normal"}, identifier
        for script in (e for e in elements if e.tag in ("msub", "msup", "mfrac", "mover", "munder")):
            assert len(script) == 2, identifier


@pytest.mark.parametrize(
    ("source", "expression"),
    [
        (r"\sin^{2} \theta \cos \phi", sp.sin(theta) ** 2 * sp.cos(phi)),
        (r"\dot{\theta}_1", PAIR.v[0]),
        (r"\ddot{\phi}", ROTOR.a[1]),
        (r"\frac{\dot{\phi}^{2}}{r_0^{2}}", ROTOR.v[1] ** 2 / r0**2),
        (r"\Omega \ell", sp.Mul(Omega, ell, evaluate=False)),
        (r"\cos{\left(2 \theta \right)}", sp.cos(2 * theta)),
    ],
)
def test_printed_and_derived_look_alike(source: str, expression: sp.Expr) -> None:
    assert latex(source) == latex(tex(expression))


def test_functions_stand_upright_with_their_spaces() -> None:
    sine, cosine = "<mi>sin</mi>", "<mi>cos</mi>"
    assert latex(r"\sin\theta\cos\phi") == f"{sine}{THIN}<mi>θ</mi>{THIN}{cosine}{THIN}<mi>ϕ</mi>"
    assert f"</mi>{THIN}<mo" not in latex(r"a\sin(x)"), "no space before a bracket"
    assert THIN not in latex("ab"), "letters stand close"
    power = tree("<math>" + latex(r"\sin^2 x") + "</math>")
    assert [len(e) for e in power.iter("msup")] == [2], "no space within a script"


def test_a_sign_with_nothing_to_its_left_is_a_prefix() -> None:
    forms = [mo.get("form") for mo in tree(f"<math>{latex('-a-b=(-c,-d)')}</math>").iter("mo") if mo.text == "−"]
    assert forms == ["prefix", "infix", "prefix", "prefix"]


def test_accents_primes_styles_and_sums() -> None:
    assert 'accent="true"' in latex(r"\hat{r}") and "ˆ" in latex(r"\hat{r}")
    assert "→" in latex(r"\vec{F}") and 'stretchy="false"' in latex(r"\vec{F}")
    assert latex(r"\dot{\hat{r}}").count("<mover") == 2
    assert "mpadded" in latex(r"\dot{x}^2") and "mpadded" not in latex("x^2")
    assert "<msup>" not in latex("R'(t)"), "the font's prime is raised already"
    assert "𝟙" in latex(r"\mathbb{1}")
    assert "ℒ" in latex(r"\mathcal L") and latex(r"\mathcal L") == latex(r"\mathcal{L}")
    assert '<mi mathvariant="normal">Ω</mi>' in latex(r"\Omega")
    assert 'lspace="0.278em"' in latex(r"B\sim 2")


def test_what_a_wide_space_parts_stands_on_a_line_of_its_own() -> None:
    assert len(lines(r"a = b \quad = c")) == 2
    assert len(lines(r"a = \text{x \quad y}")) == 1, "not within braces"
    assert len(lines(r"\begin{aligned} a &= b \quad c \\ d &= e \end{aligned}")) == 1, "nor within an environment"
    assert len(lines(r"\left\{ a = 0 \quad \text{on } y = 0 \right.")) == 1, "nor between brackets that grow"
    assert len(lines("a = b")) == 1
    assert mathml_latex.mathml(r"a \quad b", display=False).count("<math>") == 1


@pytest.mark.parametrize(
    "address",
    ["javascript:alert(1)", "JaVaScript:alert(1)", "&#106;avascript:alert(1)", "data:text/html,x"],
)
def test_a_link_that_would_run_is_not_kept(address: str) -> None:
    drawn = mathml_latex.mathml(rf"\href{{{address}}}{{x}} + 1")
    assert drawn and "href" not in drawn and "<mi>x</mi>" in drawn
    assert 'href="https://example.org"' in (mathml_latex.mathml(r"\href{https://example.org}{x}") or "")


@pytest.mark.parametrize(
    ("source", "levels"),
    [
        (r"x^{a_b}", 1),  # a script of a script
        (r"\frac{\frac{a_1}{b}}{c}", 1),  # in a fraction within a fraction
        (r"\frac{a_1}{b_2}", 0),
        (r"\hat{x}^2 + a_{b}", 0),
        (r"e^{\frac{a}{b}}", 2),
        (r"\tfrac{a^2}{b}", 1),  # a small fraction makes scripts of its parts
        (r"\tfrac{a}{b}", 0),
    ],
)
def test_scripts_of_scripts_are_no_smaller_than_scripts(source: str, levels: int) -> None:
    drawn = mathml_latex.mathml(source) or ""
    assert drawn.count('scriptlevel="1"') == levels, drawn
