"""MathML of printed and derived formulas: alike, spaced as TeX spaces, and broken where a line is too long."""

import re
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest
import sympy as sp

from lagrotor.pair.symbols import ANSATZ, PAIR, ROTOR, M, Omega, ell, r0
from lagrotor.paper import scripts
from lagrotor.paper.audit import statements
from lagrotor.paper.catalogue import equations
from lagrotor.report.formulas import mathml_latex
from lagrotor.report.formulas.mathml import mathml
from lagrotor.report.formulas.mathml_break import WIDTH, width

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
    return {entry.id: mathml_latex.from_latex(entry.latex) or "" for entry in equations().values()}


def tree(formula: str) -> Element:
    return ElementTree.fromstring(formula)


def latex(source: str) -> str:
    """One formula within a line, without the outer elements."""
    pytest.importorskip("latex2mathml", reason="latex2mathml reads the printed formulas")
    found = mathml_latex.from_latex(source, display=False)
    assert found
    return bare(found)


def bare(formula: str) -> str:
    return re.sub(r"^<math>(<mrow>)?|(</mrow>)?</math>$", "", formula)


def test_every_printed_equation_is_whole_and_in_the_words_of_browsers(printed: dict[str, str]) -> None:
    assert len(printed) == len(equations()) > 60
    for identifier, formula in printed.items():
        elements = list(tree(formula).iter())
        assert {element.tag for element in elements} <= CORE, identifier
        assert all((e.text or "").strip("\u00a0") for e in elements if e.tag in ("mi", "mn", "mo", "mtext")), identifier
        assert {e.get("mathvariant") for e in elements} <= {None, "normal"}, identifier
        for script in (e for e in elements if e.tag in ("msub", "msup", "mfrac", "mover", "munder")):
            assert len(script) == 2, identifier


def test_without_the_converter_there_is_no_formula(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "latex2mathml.converter", None)
    assert mathml_latex.from_latex("x") is None


@pytest.mark.parametrize(
    ("source", "expression"),
    [
        (r"\sin^2\theta\cos\phi", sp.sin(theta) ** 2 * sp.cos(phi)),
        (r"\dot{\theta}_1", PAIR.v[0]),
        (r"\ddot{\phi}", ROTOR.a[1]),
        (r"\frac{\dot{\phi}^2}{r_0^2}", ROTOR.v[1] ** 2 / r0**2),
        (r"\Omega\ell", sp.Mul(Omega, ell, evaluate=False)),
        (r"\left(M+r_0\right)^2", (M + r0) ** 2),
        (r"\cos(2\theta)", sp.cos(2 * theta)),
        (r"\sqrt{M}-1", sp.sqrt(M) - 1),
    ],
)
def test_printed_and_derived_look_alike(source: str, expression: sp.Expr) -> None:
    assert latex(source) == bare(mathml(expression, display=False))


def test_functions_stand_upright_with_their_spaces() -> None:
    sine, cosine = "<mi>sin</mi>", "<mi>cos</mi>"
    assert latex(r"\sin\theta\cos\phi") == (f"{sine}{THIN}<mi>θ</mi>{THIN}{cosine}{THIN}<mi>ϕ</mi>")
    assert latex(r"a\sin(x)").startswith(f"<mi>a</mi>{THIN}{sine}<mrow>"), "no space before a bracket"
    assert THIN not in latex("ab"), "letters stand close"


def test_brackets_stretch_only_over_what_is_tall() -> None:
    assert 'stretchy="true"' in latex(r"\left(\frac{a}{b}\right)")
    assert 'stretchy="true"' not in latex(r"\left(a\right)")
    assert 'stretchy="true"' in mathml((M + 1 / r0) ** 2)
    assert 'stretchy="true"' not in mathml((M + r0) ** 2)


def test_brackets_are_paired_even_where_they_look_the_same_on_both_sides() -> None:
    for formula in (latex(r"\|a\|\|b\|"), latex("|a||b|")):
        rows = [e for e in tree(f"<math>{formula}</math>") if e.tag == "mrow"]
        assert [len(row) for row in rows] == [3, 3]
        assert [row[0].get("form") for row in rows] == ["prefix", "prefix"]
    assert latex("(a").count("<mo>(</mo>") == 1, "one that nothing closes stays a letter among others"


def test_a_sign_with_nothing_to_its_left_is_a_prefix() -> None:
    forms = [mo.get("form") for mo in tree(f"<math>{latex('-a-b=(-c,-d)')}</math>").iter("mo") if mo.text == "−"]
    assert forms == ["prefix", "infix", "prefix", "prefix"]


def test_accents_primes_styles_and_sums() -> None:
    assert 'accent="true"' in latex(r"\hat{r}") and "ˆ" in latex(r"\hat{r}")
    assert "→" in latex(r"\vec{F}") and 'stretchy="false"' in latex(r"\vec{F}")
    assert latex(r"\dot{\hat{r}}").count("<mover") == 2
    assert "<msup>" not in latex("R'(t)"), "the font's prime is raised already"
    assert "<mn>𝟙</mn>" in latex(r"\mathbb{1}")
    assert "<mi>𝐯</mi>" in latex(r"\mathbf{v}")
    assert "<munder>" in latex(r"\left(\sum_{i} m_i\right)")
    assert '<mi mathvariant="normal">Ω</mi>' in latex(r"\Omega")
    assert "<mtext>of\u00a0it</mtext>" in latex(r"\text{of it}")


def test_matrices_cases_and_names_of_functions() -> None:
    power = tree(latex(r"\begin{pmatrix} a & b \\ c & d \end{pmatrix}^{-1}"))
    assert power.tag == "msup" and len(power) == 2 and len(power[0].find("mtable")) == 2
    cases = latex(r"\begin{cases} x & x>0 \\ 0 & x \le 0 \end{cases}")
    assert cases.count("<mtr>") == 2 and cases.count("text-align: left") == 4
    aligned = latex(r"\begin{aligned} a &= b \\ &= c \end{aligned}")
    assert aligned.count("<mtr>") == 2 and "&amp;" not in aligned
    assert f"<mi>artanh</mi>{THIN}<mi>x</mi>" in latex(r"\operatorname{artanh} x")
    assert latex(r"\max_i x").startswith("<munder><mi>max</mi>")


def test_rates_are_dotted_and_indices_low() -> None:
    assert '<msub><mover accent="true"><mi>θ</mi><mo stretchy="false">˙</mo></mover><mn>1</mn></msub>' in mathml(
        ANSATZ.v[0] + M
    )
    assert "¨" in mathml(ROTOR.a[0])
    assert "<msub><mi>r</mi><mn>0</mn></msub>" in mathml(r0, display=False)
    assert "<msub><mi>F</mi><mrow><mi>A</mi><mi>x</mi></mrow></msub>" in mathml(sp.Symbol("F_A_x"))
    assert mathml(sp.Symbol("phi_0_dot")).count("˙") == 1
    assert "<msubsup><mi>r</mi><mn>0</mn><mn>2</mn></msubsup>" in mathml(r0**2)


def lines(formula: str) -> list[Element]:
    """The lines of a formula that was broken."""
    table = tree(formula)[0]
    assert table.tag == "mtable"
    return [line[0] for line in table]


def test_a_long_sum_is_broken_before_its_signs_and_fits() -> None:
    total = sp.Add(*sp.symbols("x_1:40"))
    broken = lines(mathml(total))
    assert 2 < len(broken) < 6
    for line in broken:
        assert width(line) <= WIDTH
    assert all(line.find(".//mo").text == "+" for line in broken)
    assert [e.tag for e in broken[1][0]][:2] == ["mspace", "mo"], "indented, its sign in front"
    whole = tree(mathml(total, display=False))
    indices = [e.text for line in broken for e in line.iter("mn")]
    assert indices == [e.text for e in whole.iter("mn")], "nothing is lost or moved"
    assert "mtable" not in mathml(total, display=False), "within a line nothing is broken"
    assert "mtable" not in mathml(sum(sp.symbols("x_1:9")))


def test_a_break_is_outside_brackets_where_it_can_be() -> None:
    a, b, c, d = (sp.Add(*sp.symbols(f"{letter}_1:9")) for letter in "abcd")
    broken = lines(mathml(sp.Symbol("p") * a * b - sp.Symbol("q") * c * d))
    assert len(broken) == 2
    assert broken[1].find(".//mo").text == "−"


def test_a_wide_fraction_and_a_wide_root_are_broken_inside() -> None:
    long = sp.Add(*sp.symbols("x_1:30"))
    fraction, root = tree(mathml(long / M)), tree(mathml(sp.sqrt(long)))
    assert fraction.find(".//mfrac/mtable") is not None
    assert root.find(".//msqrt/mtable") is not None


def test_a_wide_vector_keeps_its_brackets_and_a_wide_matrix_is_listed() -> None:
    long = sp.Add(*sp.symbols("x_1:30"))
    vector = tree(mathml(sp.Matrix([long, M])))
    assert vector.find(".//mo").text == "["
    assert len(vector.find(".//mtable")) == 2
    matrix = mathml(sp.Matrix([[long, M], [1, 2]]))
    assert len(lines(matrix)) == 4
    assert [mn.text for mn in tree(matrix).iter("mn") if len(mn.text or "") == 2][:1] == ["11"]
    assert len(tree(mathml(sp.Matrix([[M, 1], [1, 2]]))).find(".//mtable")[0]) == 2, "a narrow one stays a matrix"


def test_the_source_breaks_its_own_lines(printed: dict[str, str]) -> None:
    assert len(lines(printed["3.13"])) == 4, "four formulas between semicolons"
    second = lines(printed["4.02"])[1]
    assert second.find(".//mo").text == "=", "the source sets = on a new line"
    assert "mtable" not in printed["5.13"] and 'width="1em"' not in printed["5.13"], "it fits on one"


def test_widths_follow_what_is_drawn() -> None:
    narrow, wide = tree(mathml(M, display=False)), tree(mathml(M + r0 + 1, display=False))
    assert 0 < width(narrow) < width(wide)
    assert width(tree("<mfrac><mi>a</mi><mrow><mi>b</mi><mi>c</mi></mrow></mfrac>")) < 2
    assert [width(tree(f'<mspace width="{w}" />')) for w in ("2em", "10pt", "0")] == [2, 1, 0]
    assert latex(r"x\quad").startswith("<mi>x</mi>"), "a blank at the end is nothing to break at"
    assert width(tree("<msup><mi>a</mi><mi>b</mi></msup>")) < 2 * width(tree("<mi>a</mi>"))


def test_no_letter_is_spelled() -> None:
    """Every symbol of every statement is drawn as letters, none as the name of one."""
    spelled = re.compile(r"<mi[^>]*>(var)?(theta|phi|epsilon|omega|psi|chi|alpha|lambda|sigma|Omega|Phi)")
    for statement in (one for stem in scripts.names("derivations", "s") for one in statements(stem)):
        for relation in (*statement.relations, *statement.correction):
            for side in (relation.printed, relation.derived):
                assert not spelled.search(mathml(side)), statement.id
    assert spelled.search("<mi>vartheta</mi>")  # twin
