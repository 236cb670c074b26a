"""Equations of a LaTeX or Markdown source with their numbers and labels; and the print, read whole or not at all."""

from pathlib import Path

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.new_paper.printed import read_print
from lagrotor.paper.new_paper.source import read_source

TEX = r"""
\documentclass{article}\title{Two masses \& a spring\thanks{none}}\author{A. One \and B. Two}
\numberwithin{equation}{section}
\begin{document}
\[ x = a \]
\section{First} % a comment with $$ no = equation $$
\begin{equation}\label{eq:one} y = b. \end{equation}
\begin{align} u &= c \\ v &= d \nonumber \\ w &= e \tag{*} \end{align}
\subsection*{Aside}
$$ z = f $$
\section{Second}
\begin{equation*} q = 1 \end{equation*}
\begin{equation} r = 2 \end{equation}
\end{document}
"""


def write(folder: Path, text: str, name: str = "paper.tex") -> Path:
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def test_latex_gives_title_sections_numbers_and_labels(tmp_path: Path) -> None:
    found = read_source(write(tmp_path, TEX))
    assert (found.title, found.authors) == ("Two masses & a spring", ("A. One", "B. Two"))
    assert found.sections == {"0": "Before the first section", "1": "First", "1a": "Aside", "2": "Second"}
    rows = [(e.id, e.number, e.section, e.label, e.latex) for e in found.equations]
    assert rows == [
        ("0a", "", "0", "", "x = a"),
        ("1.1", "1.1", "1", "eq:one", "y = b."),
        ("1.2", "1.2", "1", "", "u = c"),
        ("1.2a", "", "1", "", "v = d"),
        ("*", "*", "1", "", "w = e"),
        ("*a", "", "1a", "", "z = f"),
        ("*b", "", "2", "", "q = 1"),
        ("2.1", "2.1", "2", "", "r = 2"),
    ]


def test_markdown_gives_numbers_in_tags_and_behind_the_formula(tmp_path: Path) -> None:
    text = "# A title\n\n## 2 Theory\n\n$$a = b \\tag{7}$$\n\n$$c = d$$\n (8)\n\n### 2.1 More\n\n$$\ne\n= f\n$$\n"
    found = read_source(write(tmp_path, text, "paper.md"))
    assert (found.title, found.sections) == ("A title", {"2": "Theory", "2.1": "More"})
    assert [(e.id, e.section, e.latex) for e in found.equations] == [
        ("7", "2", "a = b"),
        ("8", "2", "c = d"),
        ("8a", "2.1", "e = f"),
    ]


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [("paper.pdf", "", "give a .tex or an .md file"), ("paper.tex", r"\section{A}", "no displayed equation")],
)
def test_a_source_without_equations_is_refused(name: str, text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=says):
        read_source(write(tmp_path, text, name))
    with pytest.raises(InputError, match="missing"):
        read_source(tmp_path / "missing.tex")


pytest.importorskip("antlr4", reason="sympy's parser of LaTeX needs the extra `latex`")


@pytest.mark.parametrize(
    ("latex", "members"),
    [
        (r"\ddot\theta = -\frac{g}{l}\,\theta.", ("-g*theta/l",)),
        (r"T = \tfrac12 m \dot{x}_1^2 = T_1", ("m*x_1_dot**2/2", "T_1")),
        (r"E = a\left(b + c\right)", ("a*(b + c)",)),
        (r"V = x_{cm}\,0.7125", ("57*x_cm/80",)),
        (r"\phi = \frac{M}{\cos\theta (I_1 + I_3)}", ("M/((I_1 + I_3)*cos(theta))",)),
        (r"x = \lambda e^{-\gamma t}", ("lamda*exp(-gamma*t)",)),
        (r"k = 4\pi^2/T^2", ("4*pi**2/T**2",)),
    ],
)
def test_what_is_read_is_what_is_printed(latex: str, members: tuple[str, ...]) -> None:
    read = read_print(latex)
    assert read is not None and read.members == members


@pytest.mark.parametrize(
    "latex",
    [
        r"v = f(t)", r"E = K(1) + K(2)", r"v = \frac{dx}{dt}", r"\vec F = m\vec a", r"x \approx y", r"M = \sum_i m_i",
        r"x + y", r"x = \foo y", r"x = ", r"A = \int_0^1 x\,dx",
    ],
)  # fmt: skip
def test_what_might_be_read_wrongly_is_not_read(latex: str) -> None:
    assert read_print(latex) is None
