"""The check of a source by itself: slips are found with their line, and a law or a condition is left alone."""

import json
from pathlib import Path

import pytest

from lagrotor.commands.command_line import main
from lagrotor.paper.latex import comparison
from lagrotor.paper.latex.check import HOLDS, INDEX, NOT_JUDGED, REFUTED, StepFinding, check_source
from lagrotor.paper.latex.displays import read_latex
from lagrotor.paper.latex.notation import declared_notation


def written(folder: Path, body: str) -> Path:
    file = folder / "paper.tex"
    head = "\\documentclass{article}\\usepackage{amsmath}\n\\begin{document}\n"
    file.write_text(f"{head}{body}\n\\end{{document}}\n", encoding="utf-8")
    return file


def findings(body: str) -> tuple[StepFinding, ...]:
    return check_source(read_latex(f"\\begin{{document}}\n{body}\n\\end{{document}}\n")).findings


def verdicts(body: str) -> list[str]:
    return [each.verdict for each in findings(body)]


SQUARE = (
    r"\begin{equation} T = m(\dot x + l\dot\phi)^2 = m(\dot x^2 SIGN 2 l\dot x\dot\phi + l^2\dot\phi^2)\end{equation}"
)
SLIP = r"\[ E = (x + y)^2 = x^2 - 2xy + y^2 \] "


def test_a_slip_is_found_with_its_line_its_members_and_its_term() -> None:
    assert verdicts(SQUARE.replace("SIGN", "+")) == [HOLDS]
    (slip,) = findings("\n" + SQUARE.replace("SIGN", "-"))
    assert (slip.verdict, slip.step, slip.line) == (REFUTED, 2, 3) and "with the sign of" in slip.why
    assert slip.members[0].startswith("m*(x_dot + l*phi_dot)**2") and "- 2*l*x_dot*phi_dot" in slip.members[1]
    body = "\\begin{align}\n E &= m v^2 + 2 m g h \\\\\n &= m(v^2 + 2 g h) \\\\\n &= m(v^2 - 2 g h)\n\\end{align}"
    assert [(each.equation, each.verdict, each.line) for each in findings(body)] == [("2", HOLDS, 4), ("3", REFUTED, 5)]


# A chain of rows of which one claims an order: what follows it must agree through that order.
ORDERS = [
    (r"1-\cos\theta &= 2\sin^2\frac\theta2 \\ &= \frac{\theta^2}{2} + O(\theta^4) \\ &= \frac{\theta^2}{4}", REFUTED),
    (r"1-\cos\theta &= 2\sin^2\frac\theta2 \\ &= \frac{\theta^2}{2} + O(\theta^4) \\ &= \frac{\theta^2}{2}", HOLDS),
    (r"y &= \sin\epsilon \\ &= \epsilon - \frac{\epsilon^3}{6} + O(\epsilon^5)", HOLDS),
    (r"y &= \sin\epsilon \\ &= \epsilon - \frac{\epsilon^3}{3} + O(\epsilon^5)", REFUTED),
    (r"y &= (a + \eta)\ddot\eta + \dot\eta^2 \\ &= a\ddot\eta + O(\eta^2)", HOLDS),
    (r"y &= (a + \eta)\ddot\eta + \dot\eta^2 \\ &= 2a\ddot\eta + O(\eta^2)", REFUTED),
]
# Chains without another equation: slips are refuted; laws, conditions and what may be one are not judged.
CHAINS = [
    (r"F = -k x = m\ddot x", NOT_JUDGED),
    (r"f = x^2 - l^2 = 0", NOT_JUDGED),
    (r"A = \int_0^1 x\,dx = B", NOT_JUDGED),
    (r"E = T + V = 2T", NOT_JUDGED),
    (r"E = a b + c = a b - c", REFUTED),
    (r"E = \frac{d}{dt} p = p", NOT_JUDGED),
    (r"E = (\vec a + \vec b)\cdot\vec c = \vec a\cdot\vec c", NOT_JUDGED),
    (r"y = 9^{9^{9^9}} = 9^{9^{9^9}} + 1", NOT_JUDGED),
    (r"w = 99999999! = 99999999! + 1", NOT_JUDGED),
    (r"w = \binom{1000000000}{500000000} = 1", NOT_JUDGED),
    (r"w = 4\pi\cdot 1.2 = 15.08", NOT_JUDGED),
    (r"w = 4\cdot 2 = 9", REFUTED),
    (r"w = a^2 + 2bc = 2bc", NOT_JUDGED),
    (r"w = a^2 + 2bc = a^2 + bc", REFUTED),
    (r"y = (a + 9^{2})^2 = a^2 - 2\cdot 9^{2} a + 9^{4}", REFUTED),
    (r"y = e^{10^{24} x} z = z e^{10^{24} x}", HOLDS),
    (r"y = x^{10^{12}} = x^{10^{12}+1}", NOT_JUDGED),
    (r"y = (10^{10^5} + x)^{50} = x^{50}", NOT_JUDGED),
    (r"y = \sqrt{x^2} = x", HOLDS),  # for positive symbols, and it says so
    (r"y = \cosh^2 x - \sinh^2 x = -1", REFUTED),
    (r"y = x - x = 1", REFUTED),
    (r"y = x\sqrt{-1 - x^2} = \sqrt{-1 - x^2}\,x", HOLDS),
    (r"A = \frac{\partial f}{\partial x} + b = \frac{\partial f}{\partial y} - b", NOT_JUDGED),
    (r"A = \int_0^1 f(x)\,dx = -\int_0^1 f(x)\,dx = 0", NOT_JUDGED),
    (r"N = \frac{d}{dt}\left(\frac13 m b^2\dot\theta\right) = \frac13 m b^2\ddot\theta", HOLDS),
    (r"S = \int_0^a b x\,dx = \frac{a^2 b}{2}", HOLDS),
    (r"S = \int_0^a b x\,dx = \frac{a^2 b}{3}", NOT_JUDGED),
    (r"\sin(2x) = 2\sin x\cos x", HOLDS),
    (r"e^{x} e^{y} = e^{x + y}", HOLDS),
]


@pytest.mark.parametrize(
    ("body", "verdict"),
    [*((rf"\begin{{align}} {rows} \end{{align}}", v) for rows, v in ORDERS), *((rf"\[ {c} \]", v) for c, v in CHAINS)],
)
def test_a_chain_is_judged_by_itself(body: str, verdict: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparison, "MOST_CALLS", 300_000)
    assert verdicts(body)[-1] == verdict


# A member of a chain, the next one, and the same with one slip of an author.
STEPS = [
    (r"(2ab)^3", "8a^3b^3", "6a^3b^3"),
    (r"\sqrt{a^2 b^4}", "|a| b^2", "|a| b"),
    (r"2\sin\alpha\cos\alpha", r"\sin(2\alpha)", r"\cos(2\alpha)"),
    (r"e^{-2k t} e^{k t}", "e^{-k t}", "e^{k t}"),
    (r"\frac34\cdot\frac25 a", r"\frac{3}{10} a", r"\frac{3}{20} a"),
    (r"\begin{vmatrix} a & b\\ c & d\end{vmatrix}", "ad - bc", "ad + bc"),
    (r"\frac{d}{dx} x^3", "3x^2", "3x"),
    (r"\int_0^a x\,dx", r"\frac{a^2}{2}", "a^2"),
    (r"\sum_{k=1}^3 k a", "6a", "5a"),
    (
        r"A(\cos\omega t + \cos\nu t)",
        r"2A\cos(\frac{\omega + \nu}{2}t)\cos(\frac{\omega - \nu}{2}t)",
        r"2A\cos(\frac{\omega + \nu}{2}t)\cos((\omega - \nu)t)",
    ),
    (
        r"(1 + \frac{\partial f}{\partial x})^2",
        r"1 + 2\frac{\partial f}{\partial x} + (\frac{\partial f}{\partial x})^2",
        r"1 + \frac{\partial f}{\partial x} + (\frac{\partial f}{\partial x})^2",
    ),
]


@pytest.mark.parametrize(("left", "right", "slip"), STEPS)
def test_slips_of_factors_powers_and_functions_are_found(left: str, right: str, slip: str) -> None:
    assert verdicts(rf"\[ y = {left} = {right} \]") == [HOLDS]
    assert verdicts(rf"\[ y = {left} = {slip} \]") == [REFUTED]


@pytest.mark.parametrize(
    ("before", "refuted"),
    [
        *((each, False) for each in (r"\[ xy = 0 \]", r"\[ |y| = 0 \]", "Let $xy = 0$.", r"For $y\ll x$,")),
        *((each, True) for each in (r"\[ (x + y)^2 = x^2 + 2xy + y^2 \]", r"\[ y = z w \]", "$y > 0$.", "$z = 1$.")),
    ],
)
def test_an_equation_of_the_letters_of_a_step_leaves_it_alone_and_an_identity_does_not(
    before: str, refuted: bool
) -> None:
    assert (REFUTED in verdicts(before + SLIP)) is refuted


# A sum over an index, a step with it, and a slip: the index outside its sum.
INDICES = [
    (r"S = \sum_j \cos\theta_j \sum_{k=j}^N 1 = (N-j+1)\sum_j \cos\theta_j", ["j"]),
    (r"S = \sum_{k=1}^2 a_k = 2 a_k", ["k"]),
    (r"S = \sum_j (N-j+1)\cos\theta_j = \sum_k (N-k+1)\cos\theta_k", []),
    (r"p_k = \sum_{j} A_{jk} q_j + b_k", []),
]


@pytest.mark.parametrize(("equation", "letters"), INDICES)
def test_an_index_outside_its_sum_is_found(equation: str, letters: list[str]) -> None:
    reported = [each.why.split()[0] for each in findings(rf"\[ {equation} \]") if each.verdict == INDEX]
    assert reported == letters


@pytest.mark.parametrize("equation", [r"\cos^2 x = 1 + \sin^2 x", r"\sin 2x = \sin x\cos x", "x = y"])
def test_a_single_equation_may_be_a_condition(equation: str) -> None:
    assert verdicts(rf"\[ {equation} \]") == []


def test_a_step_that_takes_too_much_work_is_not_judged_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twin: with the whole budget the same step is decided."""
    inner = r"\tan(C - 2 + \frac{1}{C - 1/y} - 1/y)"
    body = rf"\[ b = p {inner} + v = v + p {inner} + \ln(p^2 + 1) - \ln(1 + p^2) \]"
    monkeypatch.setattr(comparison, "MOST_CALLS", 2_000)
    (step,) = findings(body)
    assert (step.verdict, step.why) == (NOT_JUDGED, "the difference is too large")
    monkeypatch.undo()
    for right, verdict in ((rf"v + p {inner}", HOLDS), (rf"v - p {inner}", REFUTED)):
        assert verdicts(rf"\[ b = p {inner} + v = {right} \]") == [verdict]


def test_a_declared_kind_changes_the_reading(tmp_path: Path) -> None:
    source = read_latex(r"\begin{document}\[ E = c(x + 1) - c x = c \]\end{document}")
    assert [each.verdict for each in check_source(source).findings] == [HOLDS], "letters are real numbers"
    assert HOLDS not in [each.verdict for each in check_source(source, declared_notation({"functions": "c"})).findings]
    file = written(tmp_path, r"\[ E = c(x + 1) - c x = 2c \]")
    assert main(["check", str(file)]) == 1
    (tmp_path / "paper.toml").write_text('[notation]\nfunctions = "c"\n', encoding="utf-8")
    assert main(["check", str(file)]) == 0


def test_the_command_counts_steps_names_reasons_and_shows_both_members(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path, SQUARE.replace("SIGN", "-") + r" \[ y = a + a = 2a \] \[ F = -k x = m\ddot x \]")
    assert main(["check", str(file)]) == 1
    said = " ".join("".join(capsys.readouterr()).split())
    assert "(1), step 2: refuted" in said and "·φ̇)² = m·(" in said
    assert "3 displayed equations; steps: holds: 1; refuted: 1; not judged: 1" in said
    assert "the right member has symbols that the left member lacks (1)" in said
    assert main(["check", str(file), "--all"]) == 1
    assert "k·x = m·" in capsys.readouterr().out, "the members of what is not judged"
    assert main(["check", str(file), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["steps"] == {"holds": 1, "refuted": 1, "not judged": 1} and len(data["reasons"]) == 1
    (row,) = data["findings"]
    assert sorted(row) == ["equation", "line", "members", "step", "verdict", "why"]
    assert main(["check", str(written(tmp_path, SQUARE.replace("SIGN", "+")))]) == 0
    capsys.readouterr()
    for body, words in (("no formula", "it has no displayed equation"), (r"\input{part}", "part is missing")):
        assert main(["check", str(written(tmp_path, body))]) == 0
        assert words in "".join(capsys.readouterr())


def test_a_finding_in_a_part_has_its_file_and_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "my parts").mkdir()
    (tmp_path / "my parts" / "one.tex").write_text("\n" + SLIP, encoding="utf-8")
    file = written(tmp_path, rf"\input{{my parts/one}} {SLIP}")
    assert main(["check", str(file), "--json"]) == 1
    rows = json.loads(capsys.readouterr().out)["findings"]
    places = [(row.get("file"), row["line"], row["verdict"]) for row in rows]
    assert places == [(str(tmp_path / "my parts" / "one.tex"), 2, REFUTED), (None, 3, REFUTED)]


def test_the_three_commonest_reasons_are_counted() -> None:
    several = r"\[ y = \frac{\partial f}{\partial x} = \frac{\partial f}{\partial z} \]"
    steps = [r"\[ y = a = b \]"] * 3 + [several] * 2 + [r"\[ y = a^2 - b^2 = 0 \]", r"\[ y = \]"]
    check = check_source(read_latex(rf"\begin{{document}}{''.join(steps)}\end{{document}}"))
    assert check.counts == {"holds": 0, "refuted": 0, "not judged": 7}
    assert [*check.reasons.values()] == [3, 2, 1]
