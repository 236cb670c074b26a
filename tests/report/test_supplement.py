"""The LaTeX supplement: the whole report in ASCII, and a compiler that has nothing to say against it."""

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from lagrotor.pair.notation import M
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report, contents
from lagrotor.report.latex import END, displayed_expression, displayed_formula, head, latex_prose
from lagrotor.report.text_forms import supplement
from tests.report.hostile import LONG, long_report, short_report

HOSTILE = r'<script>alert("1 & 2")</script> | `a` *b* _c_ 50% #1 $x$ {y} ~ ^ \end{document} ±θ²≤☃'


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    report = short_report(HOSTILE, tmp_path_factory.mktemp("supplement"))
    missing = replace(report.pictures[0], png=report.pictures[0].png.with_name("missing_one.png"))
    return long_report(replace(report, pictures=(*report.pictures, replace(missing, key="t2"))), HOSTILE)


def compiled(source: str, folder: Path, passes: int = 1) -> str:
    """The log of pdflatex, its lines put together again; a table of contents takes two passes."""
    compiler = shutil.which("pdflatex")
    if compiler is None:
        pytest.skip("no pdflatex on this machine: install a LaTeX distribution to check that the supplement compiles")
    (folder / "report.tex").write_text(source, encoding="ascii")
    command = [compiler, "-interaction=nonstopmode", "report.tex"]
    for _ in range(passes):
        subprocess.run(command, cwd=folder, capture_output=True, check=False)
    return (folder / "report.log").read_text(encoding="latin-1")


def complaints(log: str, points: float = 20.0) -> list[str]:
    """Errors, references to nothing, and lines wider than the page by more than so many points."""
    wide = re.findall(r"^Overfull \\hbox \(([0-9.]+)pt.*$", log, re.MULTILINE)
    found = re.findall(r"^!.*$|^.*(?:undefined|has been referenced but).*$", log, re.MULTILINE)
    return found + [f"{width} pt too wide" for width in wide if float(width) > points]


def test_it_is_ascii_with_balanced_braces(report: Report) -> None:
    text = supplement(report)
    assert text.isascii()
    bare = re.sub(r"\\[{}\\]", "", text)
    assert bare.count("{") == bare.count("}")
    assert text.startswith(head(report.title)) and text.endswith(END)
    assert text.count(r"\end{document}") == 1, "no text ends the document"


def test_nothing_is_left_out(report: Report) -> None:
    text = supplement(report)
    for _, heading in contents(report):
        assert rf"\section*{{{heading}}}" in text
    for verdict in report.verdicts:
        assert text.count(rf"\hypertarget{{eq-{verdict.id}}}") == 1
    for entry in report.waiting:
        assert entry.id in text
    for part in (
        PAPER.claims["C16"].text.split()[0],
        "holds if",
        "by the same procedure, is: holds",
        "Effect on results",
        "agree through order 0 in",
        r"\drawn{figures/fig17_stub.png}",
        r"\hyperlink{figure-t6}{figure t6}",
        "1.5",
        "sympy",
        "0a0a0a0a",
        "@software",
        r"pdfauthor={The lagrotor developers}",
        "measured.json & the numbers",
    ):
        assert part in text, part
    assert r"\hyperlink{figure-t7}" not in text, "what is not drawn is not linked"


def test_it_compiles(report: Report) -> None:
    folder = report.pictures[0].png.parent.parent
    log = compiled(supplement(report), folder, passes=2)
    assert complaints(log) == []
    assert "fig17_stub.png" in log
    assert (folder / "report.pdf").stat().st_size > 20_000


def test_every_printed_equation_compiles(tmp_path: Path) -> None:
    pages = "\n\n".join(displayed_formula(entry.latex) for entry in PAPER.equations.values())
    assert complaints(compiled(head("A test") + pages + END, tmp_path)) == []


def test_long_expressions_fit_the_page(tmp_path: Path) -> None:
    wide = [LONG, M / LONG, sp.sqrt(LONG), sp.Matrix([LONG, 1]), sp.Matrix([[LONG, 1], [1, LONG]]), M * (LONG + 1) ** 2]
    log = compiled(head("A test") + "\n\n".join(map(displayed_expression, wide)) + END, tmp_path)
    assert complaints(log) == []


def test_what_is_wrong_is_found(tmp_path: Path) -> None:
    wrong = r"\undefinedword \ref{nowhere} \hbox{" + "x" * 200 + "}" + END
    found = " ".join(complaints(compiled(head("A test") + wrong, tmp_path)))
    assert "Undefined control sequence" in found and "nowhere" in found and "too wide" in found


def test_text_is_text() -> None:
    assert latex_prose("50 % of r_0² & more") == r"50 \% of $r_{0}$$^2$ \& more"
    assert latex_prose("a\\b^c~d") == r"a\textbackslash{}b\^{}c\~{}d"
    assert latex_prose("phi_dot, theta_1_dot and Omega") == r"$\dot{\phi}$, $\dot{\theta}_{1}$ and $\Omega$"
    assert latex_prose("☃éßŁş") == r"\text{[snowman]}\'{e}\ss{}\L{}\c{s}", "a sign without a word of its own is named"
    assert latex_prose("∫₀₁² f₂ ∞†") == r"$\int$$_{01}$$^2$ $f_{2}$ $\infty$$\dagger$", "an index without a letter"
    assert r"\allowbreak" in latex_prose("G_1**2*a-2*G_1*G_2*b+G_2**2*a") and r"\allowbreak" not in latex_prose(
        "a short word"
    )


def test_brackets_of_a_broken_formula_keep_their_size() -> None:
    short, broken = re.fullmatch(
        r"\\fit\{(.*)\}\{\\broken\{(.*)\}\}", displayed_formula(r"\left(\frac{a}{b}\right)+\left(c\right).")
    ).groups()
    assert short == r"\left(\frac{a}{b}\right)+\left(c\right)", "the sentence's full stop is gone"
    assert broken == r"\Bigl(\frac{a}{b}\Bigr)+(c)"
