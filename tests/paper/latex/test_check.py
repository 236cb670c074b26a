"""A source by itself: slips are found with their line, what may be physics is left alone."""

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.paper.latex import compared, slips
from lagrotor.paper.latex.check import BEFORE, HOLDS, MEANINGS, NO_IDENTITY, REFUTED, UNITS, StepFinding, check_source
from lagrotor.paper.latex.displays import read_latex
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.markup import read_source
from lagrotor.paper.latex.tokens import Token, tokenize
from lagrotor.paper.latex.usage import Notation
from lagrotor.paper.readable import readable


def findings(folder: Path, body: str) -> list[StepFinding]:
    file = folder / "paper.tex"
    file.write_text(
        f"\\documentclass{{article}}\\usepackage{{amsmath}}\n\\begin{{document}}\n{body}\n\\end{{document}}\n"
    )
    return check_source(read_source(file))


def verdicts(folder: Path, body: str) -> list[str]:
    return [each.verdict for each in findings(folder, body)]


SQUARE = (
    r"\begin{equation} T = \frac12 m(\dot x + l\dot\phi)^2"
    r" = \frac12 m(\dot x^2 SIGN 2 l\dot x\dot\phi + l^2\dot\phi^2)\end{equation}"
)


def test_a_wrong_sign_within_a_chain_is_found_with_its_line_and_term(tmp_path: Path) -> None:
    assert verdicts(tmp_path, SQUARE.replace("SIGN", "+")) == [HOLDS]
    (found,) = findings(tmp_path, "\n" + SQUARE.replace("SIGN", "-"))
    assert (found.verdict, found.step, found.line) == (REFUTED, 2, 4)
    assert "with the sign of" in found.why


def test_a_slip_between_two_rows_has_the_line_of_its_row(tmp_path: Path) -> None:
    body = "\\begin{align}\n E &= m v^2 + 2 m g h \\\\\n &= m(v^2 + 2 g h) \\\\\n &= m(v^2 - 2 g h)\n\\end{align}"
    found = findings(tmp_path, body)
    assert [(each.equation, each.verdict, each.line) for each in found] == [("2", HOLDS, 5), ("3", REFUTED, 6)]


@pytest.mark.parametrize(
    "body",
    [
        r"\begin{equation} F = -k x = m\ddot x \end{equation}",
        r"\begin{equation} 0 = m_1 a + m_2 b = m_1(a + g) + m_2(a - b) \end{equation}",
        r"\begin{equation} f = x^2 - l^2 = 0 \end{equation}",
        r"\begin{equation} A = \int_0^1 x\,dx = B \end{equation}",
    ],
)
def test_what_may_be_physics_is_not_refuted(body: str, tmp_path: Path) -> None:
    assert set(verdicts(tmp_path, body)) <= {"undecided", HOLDS}


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (r"\[ y = 9^{9^{9^9}} = 9^{9^{9^9}} + 1 \]", "undecided"),
        (r"\[ w = 99999999! = 99999999! + 1 \]", "undecided"),
        (r"\[ y = (a + 9^{2})^2 = a^2 - 2\cdot 9^{2} a + 9^{4} \]", REFUTED),
    ],
)
def test_numbers_that_no_one_writes_out_are_not_evaluated(body: str, expected: str, tmp_path: Path) -> None:
    assert verdicts(tmp_path, body) == [expected]


@pytest.mark.parametrize("right", [r"2\sin\theta\cos\theta", r"\sin\theta\cos\theta", r"-2\sin\theta\cos\theta"])
def test_a_factor_or_a_sign_of_a_whole_side_is_a_slip(right: str, tmp_path: Path) -> None:
    body = rf"\[ y = \sin 2\theta = {right} \] \[ z = e^{{a}} e^{{b}} = e^{{a + b}} \]"
    assert verdicts(tmp_path, body) == [HOLDS if right.startswith("2") else REFUTED, HOLDS]


# A chain, the step that follows it, and the same step with one slip of an author.
STEPS = [
    (r"(2ab)^3", "8a^3b^3", "6a^3b^3"),
    (r"\sqrt{a^2 b^4}", "|a| b^2", "|a| b"),
    (r"2\sin\alpha\cos\alpha", r"\sin(2\alpha)", r"\cos(2\alpha)"),
    (r"\frac{1}{1/a + 1/b}", r"\frac{ab}{a + b}", r"\frac{a + b}{ab}"),
    (r"m_1 v_1 + m_2 v_2 - m_1 v_1", "m_2 v_2", "m_2 v_1"),
    (r"e^{-2k t} e^{k t}", "e^{-k t}", "e^{k t}"),
    (r"\cosh^2 x - \sinh^2 x", "1", "-1"),
    (r"\frac34\cdot\frac25 a", r"\frac{3}{10} a", r"\frac{3}{20} a"),
    (r"\begin{vmatrix} a & b\\ c & d\end{vmatrix}", "ad - bc", "ad + bc"),
    (r"\frac{d}{dx} x^3", "3x^2", "3x"),
    (r"\int_0^a x\,dx", r"\frac{a^2}{2}", "a^2"),
    (r"\sum_{k=1}^3 k a", "6a", "5a"),
]


@pytest.mark.parametrize(("left", "right", "slip"), STEPS)
def test_slips_of_factors_powers_indices_and_functions_are_found(
    left: str, right: str, slip: str, tmp_path: Path
) -> None:
    assert verdicts(tmp_path, rf"\[ y = {left} = {right} \]") == [HOLDS]
    assert verdicts(tmp_path, rf"\[ y = {left} = {slip} \]") == [REFUTED]


@pytest.mark.parametrize(
    ("left", "right", "slip", "condition"),
    [
        (
            r"\sqrt{\frac{m}{m g + k}}",
            r"\frac{1}{\sqrt{g + k/m}}",
            r"\frac{1}{\sqrt{g - k/m}}",
            "where its roots are real",
        ),
        (
            r"\sqrt{m^2 c^4 + p^2 c^2}",
            r"m c^2\sqrt{1 + \frac{p^2}{m^2 c^2}}",
            r"m c\sqrt{1 + \frac{p^2}{m^2 c^2}}",
            "positive",
        ),
        (r"\sqrt{a + b}", r"\sqrt{b + a}", r"\sqrt{b - a}", "identity where its roots are real"),
    ],
)
def test_roots_are_compared_where_they_are_real_and_a_condition_is_said(
    left: str, right: str, slip: str, condition: str, tmp_path: Path
) -> None:
    (found,) = findings(tmp_path, rf"\[ y = {left} = {right} \]")
    assert found.verdict == HOLDS and condition in found.why
    assert HOLDS not in verdicts(tmp_path, rf"\[ y = {left} = {slip} \]")


@pytest.mark.parametrize("said", ["For $q<0$", "As $q$ is negative,", "Of a negative charge $q$", r"With $q \le 0$"])
def test_a_letter_that_is_said_to_be_negative_is_not_taken_as_positive(said: str, tmp_path: Path) -> None:
    """√(q²) = q held for positive letters, in a text about an electron."""
    step = r"\[ \omega = \frac{\sqrt{q^2} B}{m} = \frac{q B}{m} \]"
    assert HOLDS not in verdicts(tmp_path, f"{said} we have {step}")
    for other in (said.replace("q", "v"), "For $q>0$", r"For $q^2 - s^2 < 0$", "Along the negative $q$ axis"):
        assert verdicts(tmp_path, f"{other} we have {step}") == [HOLDS], other


@pytest.mark.parametrize("sign", "+-")
def test_of_a_square_no_positive_root_is_taken_where_the_text_says_negative(sign: str, tmp_path: Path) -> None:
    """x² = a, x < 0: x + 1 = √a + 1 held."""
    step = rf"\[ y = x + 1 = {sign.strip('+')}\sqrt{{a}} + 1 \]"
    assert verdicts(tmp_path, rf"With $x^2 = a$, where $x < 0$, we have {step}") == ["undecided"]
    assert (verdicts(tmp_path, rf"With $x^2 = a$, where $x > 0$, we have {step}") == [HOLDS]) == (sign == "+")


def test_a_product_is_itself_where_its_roots_are_real_nowhere(tmp_path: Path) -> None:
    step = r"\[ y = x\sqrt{-1 - x^2} = FACTOR\sqrt{-1 - x^2}\,x \]"
    assert verdicts(tmp_path, step.replace("FACTOR", "")) == [HOLDS]
    assert HOLDS not in verdicts(tmp_path, step.replace("FACTOR", "2"))


def test_a_step_that_derivatives_alone_give_says_so(tmp_path: Path) -> None:
    """It ended with "with" and nothing."""
    step = r"\[ v = \frac{d}{dt} \sqrt{x^2 + y^2} = \frac{x\dot x SIGN y\dot y}{\sqrt{x^2 + y^2}} \]"
    (good,), (slip,) = (findings(tmp_path, step.replace("SIGN", sign)) for sign in "+-")
    assert (good.verdict, good.why) == (HOLDS, "with derivatives taken")
    assert slip.verdict == REFUTED and slip.why.startswith("with derivatives taken the two sides differ")


def test_what_the_text_gives_for_a_square_is_put_in_without_a_root(tmp_path: Path) -> None:
    text = (
        r"With $\omega_0^2 = g/l + k/m$, \[ \omega = \sqrt{\frac gl + \frac km - s^2} = \sqrt{\omega_0^2 SIGN s^2} \]"
    )
    assert verdicts(tmp_path, text.replace("SIGN", "-")) == [HOLDS]
    assert verdicts(tmp_path, text.replace("SIGN", "+")) == [REFUTED]


@pytest.mark.parametrize(
    "step",
    [
        "T + V = 2T",  # the virial theorem
        "T + V = T",  # V is zero here
        r"\frac{d}{dx} a x = a",  # a may depend on x
        r"\sum_{k=1}^2 a_k = 2 a_k",  # a_k is another letter
        r"\frac{d}{dt} p = p",
        r"(\vec a + \vec b)\cdot\vec c = \vec a\cdot\vec c",  # b is normal to c
    ],
)
def test_conditions_and_what_may_depend_on_a_variable_are_left_alone(step: str, tmp_path: Path) -> None:
    assert verdicts(tmp_path, rf"\[ E = {step} \]") == ["undecided"]


def test_environments_without_end_are_refused_in_words(tmp_path: Path) -> None:
    many = r"\begin{subequations}" * 3000 + r"\[ a = b \]" + r"\end{subequations}" * 3000
    with pytest.raises(InputError, match="nested too deeply"):
        findings(tmp_path, many)
    assert verdicts(tmp_path, many.replace("subequations", "center")) == []


def test_definitions_before_are_put_in(tmp_path: Path) -> None:
    body = r"\begin{equation} v = l\omega \end{equation}\begin{equation} T = \frac12 m v^2 = \frac12 m l^2\omega^2 \end{equation}"
    (found,) = findings(tmp_path, body)
    assert (found.verdict, found.why) == (HOLDS, "with (1)")


CITED = r"""\begin{equation} v = \omega r \label{v}\end{equation} \begin{equation} F = \frac{m v^2}{r} + b\label{F}\end{equation}
With \eqref{v} in \eqref{F}, \begin{equation} F = m\omega^2 r SIGN b \end{equation}"""


def test_an_equation_is_held_against_those_that_it_cites(tmp_path: Path) -> None:
    assert verdicts(tmp_path, CITED.replace("SIGN", "+")) == [HOLDS]
    (found,) = findings(tmp_path, CITED.replace("SIGN", "-"))
    assert found.verdict == REFUTED and "with (2), (1)" in found.why


@pytest.mark.parametrize(("power", "verdict"), [("6", HOLDS), ("3", REFUTED)])
def test_an_order_that_is_claimed_is_checked(power: str, verdict: str, tmp_path: Path) -> None:
    body = rf"\begin{{equation}} y = \sin\epsilon = \epsilon - \frac{{\epsilon^3}}{{{power}}} + O(\epsilon^5)\end{{equation}}"
    assert verdicts(tmp_path, body) == [verdict]


LAWS = ["F = m a", r"a = \ddot x", r"v = \dot x", "F = k x", r"E = \frac12 m v^2", "E = F x", "p = m v", "P = F v"]
SLIPS = [
    ("F = m a", "F = m v"),
    (r"v = \dot x", r"v = \ddot x"),
    (r"E = \frac12 m v^2", r"E = \frac12 m v"),
    ("E = F x", r"E = F x + F\dot x"),
    ("P = F v", "P = F a"),
    ("p = m v", r"p = m v e^{-x}"),
    ("F = k x", r"F = k x + \hbar v"),
]


@pytest.mark.parametrize(("good", "wrong"), SLIPS)
def test_a_wrong_dimension_is_found_where_the_paper_prints_units_and_none_among_pure_numbers(
    good: str, wrong: str, tmp_path: Path
) -> None:
    body = "".join(rf"\[ {each} \]" for each in [*LAWS, r"P = \hbar\omega^2", wrong])
    units = r"With $m = 2\,\mathrm{kg}$, $x = 3\,\mathrm{m}$ and $v = 0.5\,\mathrm{m/s}$, "
    found = [each for each in findings(tmp_path, units + body) if each.verdict == UNITS]
    assert [each.equation for each in found] == ["0j"]
    assert UNITS not in verdicts(tmp_path, units + body.replace(rf"\[ {wrong} \]", rf"\[ {good} \]"))
    assert UNITS not in verdicts(tmp_path, r"With $m = 2$, $x = 3$ and $\hbar = 1$, " + body)


@pytest.mark.parametrize("values", [r"x = 3", r"x = 2.5 t", r"n = 10^{16} + 10^{14} = 10^{16}\,\mathrm{cm^{-3}}"])
def test_numbers_that_may_have_a_unit_say_nothing(values: str, tmp_path: Path) -> None:
    assert UNITS not in verdicts(tmp_path, rf"At $x = 3\,\mathrm{{m}}$, $t = 2\,\mathrm{{s}}$ \[ {values} \]")
    assert UNITS in verdicts(tmp_path, r"At $x = 3\,\mathrm{m}$, $t = 2\,\mathrm{s}$ \[ x = t \]")


def test_a_number_behind_a_sign_of_nearly_equal_may_be_a_quantity_without_its_unit(tmp_path: Path) -> None:
    known = r"Here $v = 20\,\mathrm{m/s}$, $g = 9.8\,\mathrm{m/s^2}$ and $t = 2\,\mathrm{s}$. "
    assert UNITS not in verdicts(tmp_path, known + r"\[ t = \frac{2v}{g} \approx \frac{2v}{10} \]")
    assert UNITS in verdicts(tmp_path, known + r"\[ t = \frac{2v}{g} \approx 2v \]")


def test_two_definitions_and_a_use_before_the_definition_are_found(tmp_path: Path) -> None:
    body = "".join(
        rf"\begin{{equation}} {each} \end{{equation}}" for each in ("y = H x", r"H \equiv a + b", "H := a - b")
    )
    assert set(verdicts(tmp_path, body)) == {BEFORE, MEANINGS}


def test_the_command_gives_rows_for_an_editor_and_an_exit_status(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import json

    findings(tmp_path, SQUARE.replace("SIGN", "-"))
    assert main(["check", str(tmp_path / "paper.tex"), "--json"]) == 1
    (row,) = json.loads(capsys.readouterr().out)
    assert sorted(row) == ["equation", "line", "step", "verdict", "why"]
    findings(tmp_path, SQUARE.replace("SIGN", "+"))
    assert main(["check", str(tmp_path / "paper.tex")]) == 0
    capsys.readouterr()
    for body, said in (("no formula", "it has no displayed equation"), (r"\input{part}", "part is missing")):
        findings(tmp_path, body)
        assert main(["check", str(tmp_path / "paper.tex")]) == 0
        assert f"paper.tex: {said}" in "".join(capsys.readouterr())


def test_a_finding_in_a_part_has_its_file_and_line_whatever_comes_first(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import json

    slip = r"\[ E = (x + y)^2 = x^2 - 2xy + y^2 \]"
    (tmp_path / "my parts").mkdir()
    (tmp_path / "my parts" / "one.tex").write_text("\n" + slip + "\n\\[ a = b \n", encoding="utf-8")
    findings(tmp_path, rf"\input{{my parts/one}} {slip}")
    assert main(["check", str(tmp_path / "paper.tex"), "--json"]) == 1
    rows = json.loads(capsys.readouterr().out)
    one, own = str(tmp_path / "my parts" / "one.tex"), None
    places = [(row.get("file"), row["line"], row["verdict"]) for row in rows]
    assert places == [(one, 3, "no LaTeX"), (one, 2, REFUTED), (own, 3, REFUTED)]
    assert main(["check", str(tmp_path / "paper.tex")]) == 1
    assert f"{one}:2:".replace(" ", "") in "".join(capsys.readouterr().out.split())


def test_a_letter_with_another_meaning_in_another_section_is_no_contradiction(tmp_path: Path) -> None:
    waves = r"\section{Waves} \[ t = 2\,\mathrm{s} \] \[ v = a\omega \] \[ v = l/t \] \[ \omega t = 1 \] \[ a = l \] "
    fall = r"\section{Fall} \[ t = 3\,\mathrm{s} \] \[ v = a t \] \[ l = \frac12 a t^2 \] "
    assert UNITS not in verdicts(tmp_path, waves + fall)
    assert verdicts(tmp_path, waves + r"\section{Fall} \[ v = a t \]").count(UNITS) == 1, "one by itself is a slip"
    for where in (r"where \[ v = a t \] is the speed", r"By the definition of $v$ \[ v = a t \]"):
        assert UNITS not in verdicts(tmp_path, waves + r"\section{Fall} " + where), "the text gives it"
    assert verdicts(tmp_path, waves + fall + r"\[ l = a t^3 \]").count(UNITS) == 1, "against its own section"


def test_notation_beside_the_source_settles_what_is_marked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "paper.tex"
    step = r"\[ y = a\cdot x'\cdot(b + c) = a\cdot x' b - a\cdot x' c \] \[ a\,b = 2a \]"
    file.write_text(rf"\documentclass{{article}}\begin{{document}}{step}\end{{document}}", encoding="utf-8")
    assert main(["check", str(file)]) == 0
    (tmp_path / "paper.toml").write_text('[notation]\nusual = "prime cdot"\nletters = "x"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 1
    assert "would be refuted" in " ".join(capsys.readouterr().out.split())


def test_definitions_by_each_other_are_not_worked_out_without_end(tmp_path: Path) -> None:
    given = r"\[ x = a + \frac{1}{\tan(y)} \]\[ y = a + \tan(x) \]"
    assert verdicts(tmp_path, given + r"\[ b = x + y = \tan(x) + y^3 \]") == ["undecided"]


def test_a_step_that_takes_too_much_work_is_left_undecided_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twin: with the whole budget the same step is decided."""
    inner = r"\tan(C - 2 + \frac{1}{C - 1/y} - 1/y)"
    monkeypatch.setattr(compared, "MOST_CALLS", 2_000)
    (found,) = findings(tmp_path, rf"\[ b = p {inner} + v = v + p {inner} + \ln(p^2 + 1) - \ln(1 + p^2) \]")
    assert (found.verdict, found.why) == ("undecided", "the difference is too large")
    monkeypatch.undo()
    given = rf"\[ u = {inner} \] \[ p = w \] \[ b = p u + v = q u^n \]"
    assert [each.why for each in findings(tmp_path, given)] == ["n, q may be related to the letters before"]
    for right, verdict in ((rf"v + p {inner}", HOLDS), (rf"v - p {inner}", REFUTED)):
        assert verdicts(tmp_path, rf"\[ b = p {inner} + v = {right} \]") == [verdict]
    nested = r"\tan(\tan(\tan(x)))"
    assert verdicts(tmp_path, rf"\[ b = {nested} + 1 = {nested} + 2 \]") == [REFUTED]


def test_with_definitions_put_in_only_what_agrees_at_a_point_is_decided_exactly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    decisions = []

    def counted(a: Any, b: Any, within: Any) -> Any:
        decisions.append((a, b))
        return decide_equal(a, b, within)

    monkeypatch.setattr(compared, "decide_equal", counted)
    assert verdicts(tmp_path, r"\[ u = x + y \] \[ b = p u + v = q u^2 \]") == ["undecided"] and not decisions
    assert verdicts(tmp_path, r"\[ u = x + y \] \[ b = p u + v = p x + p y + v \]") == [HOLDS] and len(decisions) == 1


def test_a_long_source_is_read_and_checked_with_progress(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "long.tex"
    file.write_text("".join(rf"\[ a_{{{n}}} = b^{n} \] " for n in range(501)), encoding="utf-8")
    assert main(["check", str(file)]) == 0
    lines = [line.partition(" s  ")[2] for line in capsys.readouterr().err.splitlines()]
    ranges = "equations 1 to 500", "equations 501 to 501"
    assert [line for line in lines if line] == [f"{what} {each}" for what in ("read", "check") for each in ranges]
    file.write_text(r"\[ a = b \]", encoding="utf-8")
    assert main(["check", str(file)]) == 0 and "equations 1" not in capsys.readouterr().err


def test_each_display_falls_into_parts_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Counted, not timed: a source of 5 MB has 30,000 displays, and each was parsed for its letters and for its reading."""
    shown = [rf"a_{n} = \frac{{b^{n}}}{{e}}\left(c + e^{{d}}\right)" for n in range(20)]
    stopped = [rf"a_{n} = (b" for n in range(20)]
    file = tmp_path / "long.tex"
    file.write_text("Here $b = a$. " + "".join(rf"\[ {each} \] " for each in (*shown, *stopped)), encoding="utf-8")
    source, parsed, notation = read_source(file), Counter[str](), Notation()

    def counted(latex: str) -> list[Token]:
        parsed[latex] += 1
        return tokenize(latex)

    monkeypatch.setattr("lagrotor.paper.latex.boxes.tokenize", counted)
    assert {each.verdict for each in check_source(source, notation)} == {MEANINGS, "not read"}
    assert parsed.keys() == {*shown, *stopped, "b = a"} and {*parsed.values()} == {1}
    read_formula(shown[0], notation)
    assert parsed[shown[0]] == 1
    read_formula(shown[0])
    assert parsed[shown[0]] == 2, "without the notation of its paper"


def test_a_latin_1_source_is_read(tmp_path: Path) -> None:
    file = tmp_path / "old.tex"
    file.write_bytes(
        "\\documentclass{article}\\begin{document}% \xa9 caf\xe9\n\\[ a = b \\]\\end{document}".encode("latin-1")
    )
    assert [each.latex for each in read_source(file).equations] == ["a = b"]


SLIP = r"\[ E = (x + y)^2 = x^2 - 2xy + y^2 \] "


@pytest.mark.parametrize(
    "said",
    [
        r"\[ xy = 0 \]", r"\[ |y| = 0 \]", "Let $xy = 0$.", r"For $y = 0$,", r"For $y\ll x$,", r"As $y\to 0$,",
        r"\[ \lVert y\rVert_{\|x} = 0 \]",
    ],
)  # fmt: skip
def test_what_the_text_says_of_the_letters_of_a_step_may_be_used(said: str, tmp_path: Path) -> None:
    assert REFUTED not in verdicts(tmp_path, said + SLIP)


@pytest.mark.parametrize(
    "said", [r"\[ (x + y)^2 = x^2 + 2xy + y^2 \]", r"\[ y = z w \]", "Let $y > 0$ and $x$ be large.", "With $z = 1$,"]
)
def test_identities_bounds_and_other_letters_say_nothing_of_a_step(said: str, tmp_path: Path) -> None:
    assert REFUTED in verdicts(tmp_path, said + SLIP)


def test_a_letter_of_another_chapter_is_not_used_before_it_is_given(tmp_path: Path) -> None:
    spring, wave = r"\section{Spring} \[ F = k x \] ", r"\[ k \equiv 2\pi/\lambda \]"
    assert BEFORE in verdicts(tmp_path, spring + wave)
    assert BEFORE not in verdicts(tmp_path, spring + r"\section{Wave}" + wave)


def test_e_with_two_meanings_is_named_where_it_is_a_letter(tmp_path: Path) -> None:
    (found,) = findings(tmp_path, "\\[ a = b \\]\n\\[ y = e^{ax} \\]\n\\[ F = e E \\]")
    assert (found.verdict, found.line) == (MEANINGS, 5)


@pytest.mark.parametrize(
    "words", ["By symmetry,", "Modulo total derivatives", "Integrating by parts", "We drop boundaries:"]
)
def test_a_condition_in_words_refutes_nothing(words: str) -> None:
    step = r"\[ S = a_1 + a_2 = 2 a_1 \]"
    assert [each.verdict for each in check_source(read_latex(f"{words} {step}"))] == ["undecided"]
    assert [each.verdict for each in check_source(read_latex(f"Then {step} as we may {words.lower()}"))] == [
        "undecided"
    ]
    assert [each.verdict for each in check_source(read_latex(f"{words} much is won.\n\nThen {step}"))] == [
        "would be refuted"
    ]


@pytest.mark.parametrize(
    ("text", "slip"),
    [
        (r"\[ a = b + c \]\[ d = a^2 = b^2 + b c + c^2 \]", "with b·c doubled"),
        (r"\[ r = \sqrt{x^2 + y^2} = x^2 + y^2 \]", "the root of the whole"),
        (r"\[ f = \cosh^2 x + \sinh^2 x = 1 \]", "the sign of"),
        (
            r"\begin{equation}\label{a} x = 2y\end{equation}\begin{equation}\label{b} z = x^2 + x\end{equation}"
            r"From \eqref{a} and \eqref{b} \begin{equation} z = 2y^2 + 2y \end{equation}",
            "doubled",
        ),
    ],
)
def test_a_slip_is_found_where_definitions_are_put_in(text: str, slip: str) -> None:
    wrong = [each for each in check_source(read_latex(text)) if each.verdict == "would be refuted"]
    assert len(wrong) == 1
    assert slip in readable(wrong[0].why)


# A single equation of known functions: what is an identity, with one slip; what may be a condition.
FIRST = [
    (r"\sin(2x) = 2\sin x\cos x", r"\sin(2x) = \sin x\cos x"),
    (r"\cos(a + b) = \cos a\cos b - \sin a\sin b", r"\cos(a + b) = \cos a\cos b + \sin a\sin b"),
    (r"\cos 2x = 1 - 2\sin^2 x", r"\cos 2x = 1 - \sin^2 x"),
    (r"e^{x} e^{y} = e^{x + y}", r"e^{x} e^{y} = e^{x - y}"),
    (r"\cos^2 x + \sin^2 x = 1", r"\cos^2 x + \sin^2 x = 2"),
]


@pytest.mark.parametrize(("good", "wrong"), FIRST)
def test_a_single_equation_of_known_functions_is_an_identity(good: str, wrong: str, tmp_path: Path) -> None:
    assert verdicts(tmp_path, rf"\[ {good} \]") == [HOLDS]
    assert verdicts(tmp_path, rf"\[ {wrong} \]") in ([NO_IDENTITY], [REFUTED])
    assert verdicts(tmp_path, rf"The identity \[ {wrong} \]") == [REFUTED]


@pytest.mark.parametrize("words", ["Using", "The identity", "Recall that", "We know that", "For all $x$", "Note that"])
def test_a_single_equation_is_refuted_where_the_text_says_that_it_is_an_identity(words: str) -> None:
    (single,) = check_source(read_latex(rf"{words} \[ \cos^2 x = 1 + \sin^2 x \] is well known."))
    (chain,) = check_source(read_latex(r"We have \[ y = \cos^2 x = 1 + \sin^2 x \]"))
    assert single.verdict == chain.verdict == REFUTED


# Conditions as physicists write them, one sign, factor or power from an identity.
CONDITIONS = [
    "The system is at resonance when □", "We require □", "At resonance □", "The phase must satisfy □", "Setting □ we find",
    "We set □", "The boundary condition at the free end gives □", "The frequencies are given by □",
    "The allowed energies follow from □", "Stationary points obey □", "This vanishes for □", "which happens at □",
    "The quantization condition reads □", "Equating the two forces, □", "The two curves cross at □",
    "Matching at the boundary yields □", "Continuity demands □", "The orbit is closed provided that □",
    "Let $x$ be such that □", "Choose $x$ so that □", "Suppose that □", "Assume □", "Imposing □",
    "To have □ the angle is small", "Demanding □ fixes the phase", "We want □", "We look for solutions of □",
    "Hence □ and thus $x = 0$", "The equilibrium angle is determined by □", "The critical angle is defined by □",
    "For the special case □ nothing moves", "In the case □", "Consider □", "Consider the equation □", "We have to solve □",
    "Therefore □ whose solutions are known", "It follows that □ and thus $x = 0$", "Newton's law gives □",
    "The torque balance is □", "Fix the gauge by □", "Take □", "with □", "given that □", "The turning points are where □",
    "The roots of □", "Energy conservation implies □", "The constraint is □", "The characteristic equation becomes □",
    "The dispersion relation is □", "The minimum lies at □", "Maximizing, we get □", "The derivative is zero at □",
    "Snell's law reads □", "The two agree only for □", "Solve for $x$: □", "Exercise. Find $x$ with □",
    "The ansatz works as long as □", "The bifurcation takes place once □", "Putting □ in the first integral",
    "A closed orbit needs □", "Eigenvalues: □", "This is possible only if □", "Using the boundary conditions we get □",
    "From the formula for the torque, □ if it rests", "□", "Hence □",
]  # fmt: skip


@pytest.mark.parametrize("words", CONDITIONS)
def test_what_may_be_a_condition_is_no_error(words: str) -> None:
    equations = (r"\cos^2 x = 1 + \sin^2 x", r"\sin 2x = \sin x\cos x", r"\cos 2x = \cos^2 x + \sin^2 x")
    equation = equations[len(words) % 3]
    found = {each.verdict for each in check_source(read_latex(words.replace("□", rf"\[ {equation} \]")))}
    assert found <= {NO_IDENTITY, "two meanings"}


@pytest.mark.parametrize(
    "condition",
    [
        r"\sin\theta = \cos\theta", r"\tan x = \cot x", r"\tan x = \tanh x", r"\cos x\cosh x = 1", r"\sin 2x = 2\sin x",
        r"\cosh^2 x + \sinh^2 x = 1", "e^{x} = e^{-x}", r"\cos x = -\cos x", "(a + b)^2 = a^2 - 2ab + b^2", r"\tan x = x",
        r"\cos^2\theta_1 - \sin^2\theta_2 = \cos 2\theta_2", r"2\sin\theta_1\cos\theta_2 = \sin 2\theta_1",
    ],
)  # fmt: skip
def test_a_single_equation_that_may_be_a_condition_is_left_alone(condition: str, tmp_path: Path) -> None:
    assert verdicts(tmp_path, rf"\[ {condition} \]") == []


def test_an_equation_to_be_solved_is_no_identity(tmp_path: Path) -> None:
    assert verdicts(tmp_path, r"The roots of \[ \sin(2x) = \sin x\cos x \]") == []


@pytest.mark.parametrize("beside", [False, True])
def test_a_package_that_is_not_beside_the_source_is_named_where_its_command_stops_a_reading(
    beside: bool, tmp_path: Path
) -> None:
    if beside:
        (tmp_path / "notation.sty").write_text(r"\newcommand{\twice}[1]{2 #1}")
    (file := tmp_path / "paper.tex").write_text(
        "\\documentclass{article}\n\\usepackage{amsmath,graphicx}\n\\usepackage{notation}\n"
        "\\begin{document}\n\\[ E = \\twice{x} + x = 3 x \\]\n\\end{document}\n"
    )
    (found,) = check_source(read_source(file))
    if beside:
        assert found.verdict == HOLDS
    else:
        assert found.verdict == "not read"
        assert found.why == (
            r"\twice is not known: notation.sty, loaded in line 3, is not beside the source: \twice may be defined there"
        )
    source = read_latex(
        "\\documentclass{article}\\usepackage{amsmath}\\begin{document}\\[ E = \\twice{x} \\]\\end{document}"
    )
    (other,) = check_source(source)
    assert other.why == r"\twice is not known: write what it stands for, or define it by \newcommand"


def test_a_class_that_is_not_beside_the_source_is_named_too() -> None:
    source = read_latex(
        "\\documentclass{house}\n\\usepackage{own}\\begin{document}\\[ E = \\twice{x} \\]\\end{document}"
    )
    (found,) = check_source(source)
    assert "house.cls, loaded in line 1, and own.sty, loaded in line 2, are not beside the source" in found.why


@pytest.mark.parametrize(
    ("sides", "verdict"),
    [
        (r"e^{10^{24} + x} y = 2 e^{10^{24} - x} y", "undecided"),
        (r"e^{900 + x} y = e^{900 - x} y", "undecided"),
        (r"e^{10^{24} x} y = y e^{10^{24} x}", HOLDS),
    ],
)
def test_values_beyond_what_floats_hold_end_no_check(sides: str, verdict: str, tmp_path: Path) -> None:
    found = findings(tmp_path, rf"\[ E = {sides} \]")
    assert [each.verdict for each in found] == [verdict]


def test_a_change_a_ratio_and_a_constant_of_what_is_too_large_are_not_sought() -> None:
    x, y = sp.symbols("x y", real=True)
    huge = sp.exp(10**24 + x)
    point = {x: sp.Rational(3, 5), y: sp.Rational(5, 7)}
    assert compared.value_at(huge, point) is sp.nan and compared.value_at(sp.exp(900) * y, point) is sp.nan
    assert slips._ratio(huge, 2 * y, point) is None and slips.constant_value(huge) is None
    assert slips._ratio(sp.exp(600) * x, sp.exp(-600) * x, point) is None
    assert slips._ratio(2 * y, y, point) == 2 and slips.constant_value(y - y + sp.Integer(2)) == 2


def _nested(n: int, inner: str) -> str:
    for i in range(n):
        inner = rf"\frac{{1}}{{a_{{{i}}}+{inner}}}"
    return inner


@pytest.mark.parametrize(
    "step",
    [
        r"x^{10^{12}} = x^{10^{12}+1}",
        r"(2/3)^{10^9} x = x",
        r"(10^{10^5} + x)^{50} = x^{50}",
        r"x^{x^{x^x}} = e^{x^{x^x} \ln(x)} + x",
        f"{_nested(60, 'x')} = {_nested(60, '2 x')}",
        "".join(f"(a_{{{i}}} + b_{{{i}}})" for i in range(30))
        + " = "
        + "".join(f"(a_{{{i}}} - b_{{{i}}})" for i in range(30)),
    ],
)
def test_every_step_ends_with_a_word(tmp_path: Path, step: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compared, "MOST_CALLS", 100_000)
    assert verdicts(tmp_path, rf"\[ y = {step} \]") == ["undecided"]


@pytest.mark.parametrize(
    ("step", "verdict"),
    [
        (r"(a + \eta)\ddot\eta + \dot\eta^2 = a \ddot\eta", HOLDS),
        (r"(a + \eta)\ddot\eta + \dot\eta^2 = 2 a \ddot\eta", REFUTED),
        (r"(a + \eta)\frac{d\eta}{dt} = a \frac{d\eta}{dt}", HOLDS),
        (r"(a + \eta)\eta'(x) = a \eta'(x)", "undecided"),
        (r"\cos\eta = 1 - \eta", REFUTED),
    ],
)
def test_the_rates_of_a_small_quantity_are_small(step: str, verdict: str, tmp_path: Path) -> None:
    assert verdicts(tmp_path, rf"\[ y = {step} + O(\eta^2) \]") == [verdict]


def test_a_macro_that_nothing_defines_is_said_once_with_the_number_of_its_displays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    body = r"\[ x = \odd{y} \] \[ y = \odd{z} \] \[ a = \other \] \[ z = \odd{x} \] \[ a = \] \[ b = \]"
    findings(tmp_path, body)
    assert main(["check", str(tmp_path / "paper.tex"), "--all"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said.count("odd is not known") == said.count("other is not known") == 1
    assert said.count("so in 3 displays") == said.count("so in") == 1
    assert said.count("a side of the relation is missing") == 2, "each by its line"


# What the text gives before a step, the step, and a part of it with a slip in its place.
WITH_PREMISES = [
    (r"Here $v = l\dot\theta$.", r"T = \frac12 m v^2 = \frac12 m l^2\dot\theta^2", r"= \frac12 m l^2", r"= \frac14 m l^2"),
    (r"\[ v = l\dot\theta \]", r"T = m v^2 = m l^2\dot\theta^2", r"\dot\theta", r"\theta"),
    (r"\[ H = \frac{p^2}{2M} + \frac{k q^2}{2} \]", r"\dot p = -\frac{\partial H}{\partial q} = -k q", "-k", "k"),
    (
        r"\[ L = T - V \] where $T = \frac12 m\dot q^2$ and $V = \frac12 k q^2$.",
        r"p = \frac{\partial L}{\partial\dot q} = m\dot q", r"m\dot q", "m q",
    ),
    (
        r"\[ \mathbf v = \dot{\mathbf r} \]",
        r"T = \frac12 m\mathbf v\cdot\mathbf v = \frac12 m\dot{\mathbf r}\cdot\dot{\mathbf r}",
        r"\frac12 m\dot{\mathbf r}", r"m\dot{\mathbf r}",
    ),
    (
        r"\[ L = \frac12 m l^2\dot\theta^2 + m g l\cos\theta \]"
        r"\[ p = \frac{\partial L}{\partial\dot\theta} = m l^2\dot\theta \]",
        r"H = p\dot\theta - L = \frac{p^2}{2 m l^2} - m g l\cos\theta", r"- m g l", r"+ m g l",
    ),
    (
        r"\[ x = r\cos\theta \] \[ y = r\sin\theta \]",
        r"T = \frac12 m(\dot x^2 + \dot y^2) = \frac12 m(\dot r^2 + r^2\dot\theta^2)", r"+ r^2", r"+ r",
    ),
    (
        r"The motion is $x(t) = A\cos\omega t$.", r"E = \frac12 m\dot x^2 + \frac12 m\omega^2 x^2 = \frac12 m\omega^2 A^2",
        r"= \frac12 m\omega^2 A", r"= m\omega^2 A",
    ),
    ("", r"N = \frac{d}{dt}\left(\frac13 m b^2\dot\theta\right) = \frac13 m b^2\ddot\theta", r"= \frac13", r"= -\frac13"),
    ("", r"S = \int_0^a b x\,dx = \frac{a^2 b}{2}", "{a^2", "{a^3"),
    (
        "", r"E = \left(1 + \frac{\partial f}{\partial x}\right)^2 = 1 + 2\frac{\partial f}{\partial x}"
        r" + \left(\frac{\partial f}{\partial x}\right)^2", r"2\frac", r"\frac",
    ),
    (r"At $x = 0$, \[ x\ddot x + y = 0 \]", "E = (b + y)^2 x = x b^2 + 2 b y x + x y^2", "+ 2 b", "- 2 b"),
]  # fmt: skip


# The same in passages of textbooks, where single equations are worked out from what is given.
PASSAGES = {
    "the velocity of a pendulum": (
        r"\begin{align} x &= l\sin\theta, \\ y &= -l\cos\theta .\end{align} The velocities follow by differentiation,",
        r"\dot y = l\dot\theta\sin\theta", "= l", "= -l",
    ),
    "the force of a pendulum": (
        r"\[ L = \frac12 m l^2\dot\theta^2 + m g l\cos\theta \] The momentum is $p$, and the force",
        r"\frac{\partial L}{\partial\theta} = -m g l\sin\theta", "-m", "m",
    ),
    "a cyclic angle": (
        r"\[ p_\varphi = m l^2\sin^2\theta\,\dot\varphi \] is conserved, and the energy becomes",
        r"E = \frac12 m l^2(\dot\theta^2 + \sin^2\theta\,\dot\varphi^2) = \frac12 m l^2\dot\theta^2"
        r" + \frac{p_\varphi^2}{2 m l^2\sin^2\theta}", r"m l^2\sin^2\theta}", r"m l^2\sin\theta}",
    ),
    "the angular momentum put in": (
        r"The angular momentum is $\ell = \mu r^2\dot\phi$. Solving for $\dot\phi = \ell/(\mu r^2)$ we write the energy as",
        r"E = \frac12\mu\dot r^2 + \frac12\mu r^2\dot\phi^2 = \frac12\mu\dot r^2 + \frac{\ell^2}{2\mu r^2}", r"{2\mu", r"{\mu",
    ),
    "an effective potential": (
        r"\[ U(r) = \frac{\ell^2}{2\mu r^2} - \frac{k}{r} \] Its derivative is",
        r"\frac{dU}{dr} = -\frac{\ell^2}{\mu r^3} + \frac{k}{r^2} \] which vanishes at $r_0$. \[ r_0 = \frac{\ell^2}{\mu k}",
        r"{\mu r^3}", r"{\mu r^2}",
    ),
    "a rate put into a rate": (
        r"\begin{align}\dot\omega_1 &= -\Omega\omega_2, \\ \dot\omega_2 &= \Omega\omega_1 .\end{align} Once more,",
        r"\ddot\omega_1 = -\Omega\dot\omega_2 = -\Omega^2\omega_1", r"\Omega^2", r"\Omega^3",
    ),
    "the equation of motion put in": (
        r"With the equation of motion $m\ddot x = -k x - b\dot x$ the power becomes",
        r"\frac{dE}{dt} = \dot x(m\ddot x + k x) = -b\dot x^2", "-b", "b",
    ),
    "beats": (
        "By the addition theorem this is",
        r"y = A(\cos\omega_1 t + \cos\omega_2 t)"
        r" = 2A\cos\left(\frac{\omega_1 + \omega_2}{2}t\right)\cos\left(\frac{\omega_1 - \omega_2}{2}t\right)",
        r"- \omega_2}{2}", r"- \omega_2}{1}",
    ),
    "a standing wave": (
        "On a string", r"y = A\sin(kx - \omega t) + A\sin(kx + \omega t) = 2A\sin kx\cos\omega t", r"kx\cos", r"kx\sin",
    ),
    "a group velocity": (
        r"\[ \omega^2 = g k + \frac{\sigma}{\rho}k^3 \] and the group velocity",
        r"v_g = \frac{d\omega}{dk} = \frac{g + 3\sigma k^2/\rho}{2\omega}", r"{2\omega}", r"{\omega}",
    ),
    "heats of a cycle": (
        r"\begin{align} Q_1 &= N k T_1\ln\frac{V_2}{V_1}, \\ Q_2 &= N k T_2\ln\frac{V_2}{V_1} .\end{align} The work is",
        r"W = Q_1 - Q_2 = N k(T_1 - T_2)\ln\frac{V_2}{V_1}", "T_1 - T_2", "T_1 + T_2",
    ),
    "an enthalpy": (
        r"An ideal gas has $U = \frac{f}{2} N k T$ and $p V = N k T$. The enthalpy is",
        r"H = U + p V = \frac{f + 2}{2} N k T", "f + 2", "f - 2",
    ),
    "probabilities": (
        r"\begin{align} r &= \frac{k - q}{k + q}, \\ t &= \frac{2k}{k + q} .\end{align} They add up to one:",
        r"T = \frac{q}{k}t^2 = \frac{4kq}{(k + q)^2}", "{4kq", "{2kq",
    ),
    "a variance": (
        r"\[ \langle n\rangle = N p \] \[ \langle n^2\rangle = N p(1 - p) + N^2 p^2 \] and the variance is",
        r"\sigma^2 = \langle n^2\rangle - \langle n\rangle^2 = N p(1 - p)", "(1 - p)", "(1 + p)",
    ),
    "an integral to infinity": (
        r"With $a > 0$,", r"\int_0^\infty v^2 e^{-a v^2}\,dv = \frac{\sqrt\pi}{4a^{3/2}}", "{4a", "{2a",
    ),
    "the energy of a charged sphere": (
        r"\[ E(r) = \frac{Q}{4\pi\varepsilon_0 r^2} \] The energy stored is",
        r"W = \int_R^\infty\frac{\varepsilon_0}{2}E^2\,4\pi r^2\,dr = \frac{Q^2}{8\pi\varepsilon_0 R}", r"_0 R}", r"_0 R^2}",
    ),
    "a circuit": (
        r"The charge is $q(t) = q_0\cos\omega t$ with $\omega^2 = 1/(LC)$. \[ I = \dot q = -q_0\omega\sin\omega t \] Then",
        r"W = \frac12 L I^2 = \frac{q_0^2}{2C}\sin^2\omega t", "{2C}", "{C}",
    ),
    "the derivative of a function by a prime": (
        r"The potential is $V(r) = a r^4 - b r^2$. Its slope is", r"V'(r) = 4 a r^3 - 2 b r", "- 2 b", "+ 2 b",
    ),
    "stated again with others put in": (
        r"\[ E = \frac12 m\dot s^2 + \frac12 I\dot\varphi^2 - mgs \] where $I = \frac12 mR^2$ and $\dot\varphi = \dot s/R$."
        " Substituting,",
        r"E = \frac{3}{4}m\dot s^2 - mgs", "{4}", "{2}",
    ),
    "in other coordinates": (
        r"\[ V = \frac{k}{2}(x_1 - x_2)^2 + b x_1 \] With $x_1 = u + v$ and $x_2 = u - v$ this becomes",
        r"V = 2 k v^2 + b(u + v)", "2 k", "k",
    ),
    "a derivative at constant volume": (
        r"With $p = \frac{R T}{V - b} - \frac{a}{V^2}$ the pressure rises by",
        r"\left(\frac{\partial p}{\partial T}\right)_V = \frac{R}{V - b}", "V - b", "V + b",
    ),
    "a magnitude": (
        r"The modulus is \[ |Z| = \sqrt{R^2 + \omega^2 L^2} \] and the mean power",
        r"P = \frac{U^2 R}{2|Z|^2} = \frac{U^2 R}{2(R^2 + \omega^2 L^2)}", r"L^2", "L",
    ),
    "a tangent": (
        r"The phase is given by \[ \tan\delta = \frac{2\gamma\omega}{\Omega^2} \] Then",
        r"c = \frac{1}{1 + \tan^2\delta} = \frac{\Omega^4}{\Omega^4 + 4\gamma^2\omega^2}", r"4\gamma", r"2\gamma",
    ),
    "a factor before a bracket that is differentiated": (
        r"\[ V(r) = D(1 - e^{-\alpha r})^2 \] The force follows from",
        r"\frac{dV}{dr} = 2\alpha D(1 - e^{-\alpha r})e^{-\alpha r}", r"= 2\alpha D", r"= \alpha D",
    ),
    "an amplitude that is no operator": (
        r"With $x = Ae^{-\gamma t}\cos\omega t$ the velocity is",
        r"\dot x = -Ae^{-\gamma t}(\gamma\cos\omega t + \omega\sin\omega t)", r"+ \omega\sin", r"- \omega\sin",
    ),
    "differences that are quantities": (
        r"\[ v(r) = \frac{\Delta p}{4\eta l}(R^2 - r^2) \] The flux is",
        r"Q = 2\pi\int_0^R v(r)\,r\,dr = \frac{\pi\Delta p}{8\eta l}R^4", r"}R^4", r"}R^3",
    ),
    "a factor that is missing": (
        r"\[ V(\theta) = -mgR\cos\theta - \frac12 m\Omega^2R^2\sin^2\theta \] Its slope is",
        r"V'(\theta) = mgR\sin\theta - m\Omega^2R^2\sin\theta\cos\theta", r"\sin\theta\cos\theta", r"\sin\theta",
    ),
    "a factor below a root": (
        r"Here $v = \sqrt{2gh}$. The level sinks as", r"\dot h = -\frac{a}{A}v = -\frac{a}{A}\sqrt{2gh}", "{2gh", "{gh",
    ),
    "a half-integer power": (
        r"\[ B(z) = \frac{b}{(R^2 + z^2)^{3/2}} \] The derivative",
        r"B'(z) = -\frac{3bz}{(R^2 + z^2)^{5/2}}", "5/2", "3/2",
    ),
    "a square of numbers where nothing is said of operators": (
        r"\[ L = \frac m2(\dot x - \Omega y)^2 + \frac m2(\dot y + \Omega x)^2 \]",
        r"p = \frac{\partial L}{\partial\dot y} = m(\dot y + \Omega x)", r"+ \Omega x", r"- \Omega x",
    ),
    "a term of another number": (
        r"\[ F = -N k T\left[\ln\frac VN + \frac32\ln T + 1\right] \] The entropy is",
        r"S = -\frac{\partial F}{\partial T} = N k\left[\ln\frac VN + \frac32\ln T + \frac52\right]", r"\frac52", r"\frac32",
    ),
    "a power for a root": (
        r"Here $\Phi(z) = \frac{Q}{\sqrt{R^2 + z^2}}$. The field is",
        r"E = -\frac{d\Phi}{dz} = \frac{Q z}{(R^2 + z^2)^{3/2}}", "{3/2}", "{1/2}",
    ),
    "a product of what is known": (
        r"The distances are $r_1 = b(1 - k)$ and $r_2 = b + bk$. Their product is", r"r_1 r_2 = b^2(1 - k^2)", "k^2", "k",
    ),
    "a factor before two brackets": (
        r"The stream function is $\psi = U\left(r - \frac{a^2}{r}\right)\sin\theta$. The velocity is",
        r"v = \frac1r\frac{\partial\psi}{\partial\theta} = U\left(1 - \frac{a^2}{r^2}\right)\cos\theta", "{r^2}", "{r^3}",
    ),
    "a power of a bracket": (
        r"Along the adiabat $T = b\left(\frac{c}{V}\right)^{\gamma - 1}$, so that",
        r"\frac{dT}{dV} = -(\gamma - 1)\frac{T}{V}", "{V}", "{V^2}",
    ),
    "rates in what is marked": (
        r"On the curve $x = a\cos\phi$, $y = b\sin\phi$",
        r"J = m(x\dot y - y\dot x) = mab\dot\phi \] \[ J = m(x\dot y - y\dot x) = m a b\dot\phi", r"m a b", r"2 m a b",
    ),
    "a power of which the derivative is taken": (
        r"With $p = C\rho^\gamma$ we have", r"\frac{dp}{d\rho} = \gamma C\rho^{\gamma - 1}", "- 1", "+ 1",
    ),
    "a function elsewhere": (
        r"The potential is $V(r) = a r^4 - b r^2$. There", r"V(r_0) = a r_0^4 - b r_0^2", "- b", "+ b",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("before", "step", "part", "slip"), [*WITH_PREMISES, *PASSAGES.values()])
def test_a_slip_is_found_where_the_step_holds_with_what_the_text_gives(
    before: str, step: str, part: str, slip: str, tmp_path: Path
) -> None:
    assert verdicts(tmp_path, rf"{before} \[ {step} \]")[-1] == HOLDS
    assert step.count(part) == 1 and verdicts(tmp_path, rf"{before} \[ {step.replace(part, slip)} \]")[-1] == REFUTED


@pytest.mark.parametrize(
    "text",
    [
        r"Here $v = l\omega$, and for the other $v = b\omega$. \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
        r"\section{One} $v = l\omega$ \section{Two} \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
        r"\[ v = l\omega \] By symmetry \[ T = m v^2 = \frac12 m l^2\omega^2 \]",
        r"\[ x = r\cos\theta \] \[ x = b\cos\theta \] \[ T = m\dot x^2 = 2 m r^2\dot\theta^2\sin^2\theta \]",
        r"\[ l\omega = 2 l\omega^2 \] \[ v = l\omega \] \[ T = v = 2 l\omega^2 \]",
        r"\[ A = \frac{\partial f}{\partial x} + b = \frac{\partial f}{\partial y} - b \]",
        r"\[ A = \int_0^1 f(x)\,dx = -\int_0^1 f(x)\,dx = 0 \]",
        r"\[ xy = 0 \] \[ E = (x + y)^2 = x^2 - 2xy + y^2 \]",
    ],
)
def test_what_the_text_gives_twice_elsewhere_or_under_a_condition_refutes_nothing(text: str, tmp_path: Path) -> None:
    assert REFUTED not in verdicts(tmp_path, text)


def test_a_guess_of_another_side_or_of_a_premise_stands_by_itself(tmp_path: Path) -> None:
    """Twin: with the guess in the step itself, or in the premise that is put in, nothing is refuted."""
    assert verdicts(tmp_path, r"\[ E = \bar{A} = (x + y)^2 = x^2 - 2xy + y^2 \]")[-1] == REFUTED
    assert REFUTED not in verdicts(tmp_path, r"\[ E = (\bar{A} + y)^2 = \bar{A}^2 - 2\bar{A}y + y^2 \]")
    for name, expected in (("l", REFUTED), (r"\bar{L}", "undecided")):
        assert verdicts(tmp_path, rf"\[ v = {name}\omega \] \[ T = m v^2 = m {name}\omega^2 \]")[-1] == expected


def test_a_guess_of_a_name_matters_only_where_something_is_differentiated(tmp_path: Path) -> None:
    for step, expected in (
        ("(x' + y)^2 = x'^2 - 2x'y + y^2", REFUTED),
        (r"x'\frac{\partial f}{\partial x} + y = y - x'\frac{\partial f}{\partial x}", "undecided"),
    ):
        assert verdicts(tmp_path, rf"\[ E = {step} \]")[-1] == expected


def test_what_vanishes_itself_is_no_condition(tmp_path: Path) -> None:
    body = r"The potential is $U(x) = b x^2 - \frac{k}{x}$. Its force \[ F = -U'(x) = -2 b x + \frac{k}{x^2} \] WORDS the centre."
    assert verdicts(tmp_path, body.replace("WORDS", "vanishes at")) == [REFUTED]
    assert verdicts(tmp_path, body.replace("WORDS", "where the last term vanishes at")) == ["undecided"]


CASES_OF_A_PREMISE = {
    "given twice": (
        r"\begin{equation} y = a x\end{equation} for $x>0$; \begin{equation} y = - a x\end{equation} for $x<0$. "
        r"\begin{equation} z = y + x = x(1 + a)\end{equation}"
    ),
    "given with either sign": (
        r"\begin{equation}\omega = \pm\sqrt{k/m}\end{equation}\begin{equation}\omega = -\sqrt{k/m}\end{equation}"
        r"\begin{equation} s = \omega t = \sqrt{k/m}\, t\end{equation}"
    ),
    "the half of it": (
        r"\begin{equation} A = 4\pi r^2\end{equation} is the area of the sphere. The hemisphere has half of it: "
        r"\begin{equation} F = p A = 2\pi r^2 p\end{equation}"
    ),
    "another case": (
        r"\begin{equation} V = -\frac{k}{r}\end{equation} For repulsion, "
        r"\begin{equation} E = T + V = T + \frac{k}{r}\end{equation}"
    ),
    "a count of states": (
        r"\begin{equation} N = \frac{V k^3}{6\pi^2}\end{equation} With two spins a state: "
        r"\begin{equation} n = \frac{N}{V} = \frac{k^3}{3\pi^2}\end{equation}"
    ),
}


@pytest.mark.parametrize("body", CASES_OF_A_PREMISE.values(), ids=CASES_OF_A_PREMISE)
def test_a_premise_of_another_case_refutes_nothing(tmp_path: Path, body: str) -> None:
    assert REFUTED not in verdicts(tmp_path, body)


def test_the_premise_of_the_same_case_does(tmp_path: Path) -> None:
    """The twin: one value, and no word of another case."""
    area = (
        r"\begin{equation} A = 4\pi r^2\end{equation} is the area. It follows that "
        r"\begin{equation} F = p A = FACTOR\pi r^2 p\end{equation}"
    )
    assert verdicts(tmp_path, area.replace("FACTOR", "2")) == [REFUTED]
    assert verdicts(tmp_path, area.replace("FACTOR", "4")) == [HOLDS]


def test_a_row_that_goes_on_from_a_function_is_judged_by_its_own_step(tmp_path: Path) -> None:
    body = r"\begin{align} f(x) &= \frac{1}{1+x} - \frac{1}{1-x} \\ &= SIGN\frac{2x}{1-x^2}\end{align}"
    assert verdicts(tmp_path, body.replace("SIGN", "")) == [REFUTED]
    assert verdicts(tmp_path, body.replace("SIGN", "-")) == [HOLDS]


@pytest.mark.parametrize(
    ("premise", "right", "slip"),
    [
        (r"x = a\cos(\omega t)", r"-a\omega\sin(\omega t)", r"a\omega\sin(\omega t)"),
        (r"x = b t + l\sin\theta", r"b + l\dot\theta\cos\theta", r"b - l\dot\theta\cos\theta"),
    ],
)
def test_a_rate_is_that_of_what_the_section_gives(tmp_path: Path, premise: str, right: str, slip: str) -> None:
    body = rf"\begin{{equation}} {premise}\end{{equation}}\begin{{equation}} v = \dot x = RIGHT\end{{equation}}"
    assert verdicts(tmp_path, body.replace("RIGHT", right)) == [HOLDS]
    assert verdicts(tmp_path, body.replace("RIGHT", slip)) == [REFUTED]


def test_a_derivative_of_what_the_section_gives_is_no_condition(tmp_path: Path) -> None:
    body = r"\begin{align} f &= x^3 - 3 x \\ \frac{df}{dx} &= 3 x^2 SIGN 3\end{align}"
    assert verdicts(tmp_path, body.replace("SIGN", "-")) == [HOLDS]
    assert verdicts(tmp_path, body.replace("SIGN", "+")) == [REFUTED]
    speed = r"\begin{equation} v = u\frac{r}{R}\end{equation}BEFORE\begin{equation}\frac{dv}{dr} = \frac{2 v}{r}\end{equation}"
    assert REFUTED in verdicts(tmp_path, speed.replace("BEFORE", "It follows that "))
    assert REFUTED not in verdicts(tmp_path, speed.replace("BEFORE", "The equation to be solved is "))


def test_a_function_of_other_letters_is_fixed_in_a_derivative(tmp_path: Path) -> None:
    body = (
        r"\begin{equation} L = \frac12 m\dot r^2 + \frac12 m r^2\dot\theta^2 - V(r)\end{equation}"
        r"\begin{equation} J = \frac{\partial L}{\partial\dot\theta} = FACTOR m r^2\dot\theta\end{equation}"
    )
    assert verdicts(tmp_path, body.replace("FACTOR", "")) == [HOLDS]
    assert REFUTED not in verdicts(tmp_path, body.replace(r"V(r)", r"V(r, \dot\theta)"))


@pytest.mark.parametrize(
    "text",
    [
        r"The solution is $x = A\cos\omega t$. \[ \ddot x = -\omega_0^2 x \]",  # the equation of motion
        r"\[ x = A\cos\omega t \] \[ E = \dot x^2 + \omega_0^2 x^2 = \omega_0^2 A^2 \]",
        r"Here $\omega^2 = k/m$. \[ v = a\omega = - a\sqrt{k/m} \]",  # the root of either sign
        r"\[ V(r) = a r^2 \] \[ V(r) = - a r^2 \]",
        r"\[ V(r) = a r^2 \] \[ V(x) = - a x^2 \]",
        r"\[ V(r, s) = a r^2 + s^2 \] \[ V(u, v) = a u^2 - v^2 \]",
        r"\[ W = \int_0^\infty e^{bt}\,dt = -\frac1b \]",  # b is negative
        r"\[ E = A B = -B A \]",  # operators
        r"\[ I = 4 b\cos^2(2\pi m) = 4 b \]",  # m is whole
        r"\[ P = S_x S_y S_x = - S_x^2 S_y \]",  # no one prints that of numbers
        r"With operators \[ E = (A + \dot B)^2 - A^2 - \dot B^2 = 2 A\dot B - \dot B A \]",
        r"Here $F = k x$ and $G = k y$, and in equilibrium \[ F + G = k(x - y) \]",
        r"\[ f = \sin^2 x/2 = \frac{1 - \cos x}{2} \]",
        r"\[ x = r\cos\phi \] \[ r = 2 x \] \[ E = x^2 = \frac14 r^2 \]",
        r"\[ y = a x^2 \] For the other branch \[ \frac{dy}{dx} = -2 a x \]",
        r"\[ y = a x^2 \] To be solved is the equation \[ \frac{dy}{dx} = -2 a x \]",
        r"$V$ is even. \[ D = V(x - y) - V = V(y - x) - V \]",  # V alone for V(0)
        r"\[ D = V(a + b)^2 - V = V(b + a)V(a + b) - V \]",
        r"\[ X = Re^2 + b = Re\cdot Re + b \]",  # Reynolds's number
        r"\[ P = \sigma_x\sigma_y - \sigma_y\sigma_x = 2\sigma_x\sigma_y \]",  # Pauli's matrices
        r"Here $T = \frac12 m v^2$. Including the rotation it becomes \[ T = \frac{7}{10} m v^2 \]",
        r"Here $V = -mgx$ and $x = R\phi$. Measured from the top it becomes \[ V = mgR\phi \]",
        r"Here $\varphi = kx - \omega t$, $k = 2\pi/l$. The reflected wave thus has \[ \varphi = -\frac{2\pi x}{l} - \omega t \]",
        r"With $p = N T/V$, \[ \left(\frac{\partial p}{\partial V}\right)_S = -\frac{2p}{V} \]",
    ],
)
def test_what_may_be_a_law_another_case_or_another_reading_refutes_nothing(text: str, tmp_path: Path) -> None:
    assert REFUTED not in verdicts(tmp_path, text)


@pytest.mark.parametrize(
    "subject", ["By the lemma and the theorem, of random variables: ", "Of the energy of masses: "]
)
def test_in_a_text_of_proofs_only_what_numbers_alone_have_is_judged(subject: str, tmp_path: Path) -> None:
    text = subject + r"\[ a = \sin 2x = SIGN 2\sin x\cos x \] \[ b = (u + v)^2 = u^2 + 2 u v SIGN v^2 \]"
    matrices = subject.startswith("By")
    assert verdicts(tmp_path, text.replace("SIGN", "+")) == [HOLDS, "undecided" if matrices else HOLDS]
    assert verdicts(tmp_path, text.replace("SIGN", "-")) == [REFUTED, "undecided" if matrices else REFUTED]
