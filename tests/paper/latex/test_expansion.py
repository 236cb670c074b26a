r"""What the expansion of a source costs, and arguments that end with a mark: counted in tokens, not in seconds."""

from pathlib import Path

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.latex import token_stream
from lagrotor.paper.latex.displays import read_latex
from lagrotor.paper.latex.expansion import Expander
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.markup import markdown_as_latex, read_source
from lagrotor.paper.latex.primitives import PRIMITIVES
from lagrotor.paper.latex.printed import statement_text
from lagrotor.paper.latex.tokens import latex_of

PREAMBLE = "\\documentclass{article}\n\\def\\be#1\\ee{\\begin{equation}#1\\end{equation}}\\def\\x#1;{(#1)}\n"


def expanded(text: str) -> str:
    return "".join(latex_of(Expander(text, None, PRIMITIVES).tokens()).split())


@pytest.mark.parametrize(
    ("text", "result"),
    [
        (r"\def\x#1;{(#1)}\x a_{b;}c; d", "(a_{b;}c) d"),
        (r"\def\x#1;{(#1)}{\x a} b; c", "{()a} b; c"),  # the group ends first: its brace is no part of the argument
        ("\\def\\x#1;{(#1)}\\x a\n\nb; c", "()a\n\nb; c"),
        (r"\def\x#1\y{(#1)}\x a\par b\y c", r"()a\par b\y c"),
        ("\\newcommand\\x[1][1]{(#1)}\\x [0, 1)\n\nand [2]", "(1)[0, 1)\n\nand [2]"),
        (r"\def\x{}\ifx\x\empty a\else b\fi\ifx\x\@empty c\else d\fi", "ac"),
        (r"\def\x{y}\ifx\x\empty a\else b\fi", "b"),
        (r"\let\ifdraft\iffalse\ifdraft a\else b\fi", "b"),
        (r"\let\ifdraft\iftrue\ifdraft a\else b\fi", "a"),
        (r"\newboolean{long}\longtrue\iflong a\else b\fi\longfalse\iflong c\else d\fi", "ad"),
        (r"\newif\foo \foo a\fi", r"\foo a"),  # no condition: LaTeX refuses it
    ],
)  # fmt: skip
def test_an_argument_ends_with_its_mark_or_takes_nothing(text: str, result: str) -> None:
    assert expanded(text) == "".join(result.split())


def test_lines_that_a_macro_reads_as_they_stand_take_no_powers() -> None:
    r"""asymptote.sty reads its pictures by \def\line#1^^M{…}: no ^ of a formula ends them."""
    text = "\\def\\line#1^^M{(#1)\\line}\\def\\begun{\\line}\\begin{asy}\n$x^2$ \\end{asy}\n\\begun\n\\[ a^2 = b^{n-1} \\]\n"
    assert [each.latex for each in read_latex(text).equations] == ["a^2 = b^{n-1}"]


@pytest.mark.parametrize(
    "each", ["\\be a_{1} = b \\ee\n\n", "\\x a_{1} b\n\n", "\\begin{equation*}\\y [0, 1)\\end{equation*}\n\n"]
)
def test_the_tokens_taken_grow_as_the_source_does(each: str, monkeypatch: pytest.MonkeyPatch) -> None:
    taken = 0
    one = Expander.next

    def counted(expander: Expander) -> object:
        nonlocal taken
        taken += 1
        return one(expander)

    monkeypatch.setattr(Expander, "next", counted)
    costs = []
    for times in (100, 400):
        taken = 0
        read_latex(PREAMBLE + "\\newcommand\\y[1][1]{y_{#1}}\\begin{document}\n" + times * each + "\\end{document}\n")
        costs.append(taken)
    assert costs[1] < 4.2 * costs[0]


@pytest.mark.parametrize(("each", "mark"), [("\\x a_{1} b\n", ";"), ("\\y [0, 1) b\n", "]")])
def test_ends_that_never_come_are_refused_before_they_cost_much(
    each: str, mark: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(token_stream, "_MOST_TOKENS", 50_000)
    (file := tmp_path / "paper.tex").write_text(
        PREAMBLE + "\\newcommand\\y[1][1]{y_{#1}}\\begin{document}\n" + 1000 * each + "\\end{document}\n"
    )
    with pytest.raises(InputError, match=rf"paper.tex:\d+: the argument that begins here, .* has no {mark} in its"):
        read_source(file)


DERIVATIVES = [
    ("esdiff", r"\diff[2]{f}{x}", "Derivative(f, x, 2)"),
    ("esdiff", r"\diffp{f}{{x^2}{y}}", "Derivative(Derivative(f, x, 2), y)"),
    ("esdiff", r"\diffp*{f}{x}{y} + 1", r"\left(\frac{\partial f}{\partial x}\right)_{y} + 1"),
    ("diffcoeff", r"\diff/{f}{x} g", "Derivative(f, x)*g"),
    ("diffcoeff", r"\diffp[2]{f}{x,y}", "Derivative(Derivative(f, x, 2), y)"),
    ("diffcoeff", r"\diffp*{f}{{x},{y}}", "Derivative(Derivative(f, x), y)"),
    ("diffcoeff", r"\diff{f}{x}[0]", r"\left.\frac{\mathrm{d} f}{\mathrm{d} x}\right|_{0}"),
    ("diffcoeff", r"\int_0^1 x^2 \dl x", "Integral(x**2, x, 0, 1)"),
    ("derivative", r"\odv[order=2]{f}{x}", "Derivative(f, x, 2)"),
    ("derivative", r"\pdv[order={2,3}]{f}{x,y}", "Derivative(Derivative(f, x, 2), y, 3)"),
    ("derivative", r"\odv{f}/{x}", "Derivative(f, x)"),
    ("derivative", r"\odv{f}{x}_{x=0}", r"\left.\frac{\mathrm{d} f}{\mathrm{d} x}\right|_{x=0}"),
    ("derivative", r"\pdv{f}{x^2,y}", "the orders of the derivative differ"),
    ("derivative", r"\iint x \odif{x,y}", r"\iint x \,\mathrm{d} x\,\mathrm{d} y"),
    ("physics", r"\pdv{f}{x,y}", "what is differentiated by is not clear"),
    ("physics", r"\pdv{f}{x}{y}", "Derivative(Derivative(f, x), y)"),
    ("physics", r"\pdv[2]{f}{x}{y}", "Derivative(Derivative(f, x), y)"),
    ("physics", r"\pdv[2]{f}{x}", "Derivative(f, x, 2)"),
]


@pytest.mark.parametrize(("package", "formula", "said"), DERIVATIVES)
def test_derivatives_of_packages_are_read_or_refused_in_words(package: str, formula: str, said: str) -> None:
    text = rf"\documentclass{{article}}\usepackage{{{package}}}\begin{{document}}\[ g = {formula} \]\end{{document}}"
    (equation,) = read_latex(text).equations
    reading = read_formula(equation.latex)
    shown = reading.stop[0] if reading.stop else statement_text(reading.statements[0]).removeprefix("g = ")
    assert said in (shown, equation.latex.removeprefix("g = "))


def test_div_is_a_divergence_where_physics_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text("$$ a = b\\div r $$\n", encoding="utf-8")
    (equation,) = read_source(tmp_path / "a.md").equations
    loaded = r"\documentclass{article}\usepackage{physics}\begin{document}\[ a = \div{r} \]\end{document}"
    assert r"\nabla" not in equation.latex and r"\nabla" in read_latex(loaded).equations[0].latex


def test_a_file_is_taken_in_as_it_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """All tokens of 5 MB took 220 MB before the first was looked at."""
    stream = token_stream.TokenStream("a $b$ " * 100_000)
    longest = 0
    while stream.next() is not None:
        longest = max(longest, len(stream.waiting[-1]) if stream.waiting else 0)
    assert 0 < longest < 10_000


def test_an_argument_may_be_longer_than_what_was_read() -> None:
    body = "x $y$ " * 20_000
    source = rf"\def\f#1\end{{}}\f {body}\end \[ a = b \]"
    assert [each.latex for each in read_latex(source).equations] == ["a = b"]


def test_an_environment_with_numbers_of_lines_in_the_margin_stays_what_it_is() -> None:
    r"""As packages redefine it, `array` was what they begin it with, and no formula."""
    lines = r"{\linenomath\csname oldarray\endcsname}{\csname oldendarray\endcsname\endlinenomath}"
    formula = r"\begin{array}{l}a\\b\end{array}"
    patched = rf"\expandafter\let\csname oldarray\expandafter\endcsname\csname array\endcsname\renewenvironment{{array}}{lines}"
    assert expanded(patched + formula).strip() == formula
    own = r"\newenvironment{numbered}{\linenomath\begin{equation}}{\end{equation}\endlinenomath}"
    (found,) = read_latex(own + r"\begin{document}\begin{numbered} a = b \end{numbered}\end{document}").equations
    assert found.number == "1"


def test_a_file_is_sought_beside_the_one_that_names_it_and_its_name_may_stand_in_quotes(tmp_path: Path) -> None:
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "one.tex").write_text(r"\[ a = 1 \]\input{two}\input{three}", encoding="utf-8")
    (tmp_path / "part" / "two.tex").write_text(r"\[ b = 2 \]", encoding="utf-8")
    (tmp_path / "of its own.tex").write_text(r"\[ c = 3 \]", encoding="utf-8")
    file = tmp_path / "paper.tex"
    body = r"\import{part/}{one}\input{two}\input{"
    file.write_text(
        rf'\documentclass{{article}}\begin{{document}}{body}"of its own.tex"}}\end{{document}}', encoding="utf-8"
    )
    found = read_source(file)
    assert [each.latex for each in found.equations] == ["a = 1", "b = 2", "c = 3"]
    assert [note.split()[0] for note in found.notes] == ["three", "two"], "behind its end a file names none"


IEEE = (
    r"\IEEEauthorblockN{1\textsuperscript{st} A. Bee} \IEEEauthorblockA{\textit{dept. name}\\ City\\ a@b.c} \and C.~Dee"
)
NAMES = {
    r"A. Bee$^{1}$}\author{C. Dee$^{2,3}$, E. Eff\textsuperscript{1,*}": ("A. Bee", "C. Dee", "E. Eff"),
    r"A. Bee\thanks{Paid by \url{http://a_b}} \and C.\,Dee \\ Univ. of X, Y \\ \texttt{a\_b@c}": ("A. Bee", "C. Dee"),
    r"Jos\'e \surname{Garc\'{\i}a}\corref{cor1} and {\O}. \c{S}. Stra{\ss}e": ("José García", "Ø. Ş. Straße"),
    IEEE: ("A. Bee", "C. Dee"),
    r"A.~Bee,~\IEEEmembership{Member,~IEEE,} and~C.~Dee \\ E. Eff": ("A. Bee", "C. Dee", "E. Eff"),
    r"Anders Sand (12345)": ("Anders Sand (12345)",),
}
TITLES = {
    r"On $E=mc^2$ \& 5\%:\\[2ex] a \textbf{b}\thanks{x}": "On E=mc² & 5%: a b",
    r"\vspace{-2cm}\texorpdfstring{$\alpha$}{alpha}-decay of $\beta$ in {\em H$_2$O} at \$5": "alpha-decay of β in H₂O at $5",
    r"\own{} ``G\"odel'' \{\LaTeX\}": 'own "Gödel" {LaTeX}',
}


@pytest.mark.parametrize("given", NAMES)
def test_marks_and_addresses_are_no_part_of_a_name(given: str) -> None:
    assert read_latex(rf"\author{{{given}}}\begin{{document}}\end{{document}}").authors == NAMES[given]


@pytest.mark.parametrize("given", TITLES)
def test_a_title_keeps_its_letters_and_formulas(given: str) -> None:
    found = read_latex(
        rf"\newcommand{{\own}}{{own}}\title{{{given}}}\begin{{document}}\section{{{given}}}\end{{document}}"
    )
    assert found.title == TITLES[given]
    assert found.sections["1"] == TITLES[given]


def test_a_formula_of_markdown_may_follow_any_letter_but_latin_ones() -> None:
    """Behind 函数 no formula began, and the one after it ended another: US$5 and 10$ are prices."""
    assert markdown_as_latex("函数$f(x)$的 é$a$ US$5 and 10$") == r"函数\(f(x)\)的 é\(a\) US 5 and 10 "


AUTHORS = {
    "author: A. Bee": ("A. Bee",),
    'authors: [A. Bee, "C. Dee$^1$"]': ("A. Bee", "C. Dee"),
    "author:\n- A. Bee\n- C. Dee": ("A. Bee", "C. Dee"),
    "authors:\n  - name: A. Bee\n    affiliations:\n      - Univ\n  - name: C. Dee": ("A. Bee", "C. Dee"),
    "authors:\n  - name: A. Bee\n  - C. Dee\n  - email: x@y\n    name: E. Eff": ("A. Bee", "C. Dee", "E. Eff"),
    "kernelspec: python": (),
}


@pytest.mark.parametrize("given", AUTHORS)
def test_title_and_authors_of_markdown_are_those_of_its_front_matter(tmp_path: Path, given: str) -> None:
    file = tmp_path / "notes.md"
    file.write_text(f"---\ntitle: On $x$\n{given}\n---\n```python\n# no title\n```\n$$ x = 1 $$\n", encoding="utf-8")
    found = read_source(file)
    assert (found.title, found.authors) == ("On x", AUTHORS[given])
    file.write_text("```python\n# no title\n```\n# Notes\n$$ x = 1 $$\n", encoding="utf-8")
    assert read_source(file).title == "Notes"


def test_formulas_within_notes_and_theorems_of_myst_are_read_and_those_in_code_are_not(tmp_path: Path) -> None:
    file = tmp_path / "notes.md"
    inner = "```{math}\n:label: one\nx = 1\n```"
    note = f"````{{note}}\n{inner}\n````\n:::{{math}}\ny = 2\n:::\n```{{prf:theorem}} A\n$$ z = 3 $$\n```\n"
    file.write_text(f"{note}````python\n{inner}\n````\n```{{code-cell}}\n$$ w = 4 $$\n```\n", encoding="utf-8")
    assert [(each.latex, each.place[1]) for each in read_source(file).equations] == [
        ("x = 1", 3),
        ("y = 2", 7),
        ("z = 3", 11),
    ]


def test_cells_without_a_source_are_passed_over(tmp_path: Path) -> None:
    file = tmp_path / "notes.ipynb"
    file.write_text('{"cells": [{"cell_type": "markdown"}, {"cell_type": "markdown", "source": ["$$x = 1$$"]}, {}]}')
    assert [each.latex for each in read_source(file).equations] == ["x = 1"]
    file.write_text('{"cells": [1]}')
    with pytest.raises(InputError, match="no notebook"):
        read_source(file)
