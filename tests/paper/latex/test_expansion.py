r"""Macros, conditions and files: what a source expands to, what is refused, and what the expansion costs, in tokens."""

from pathlib import Path

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.latex import macros
from lagrotor.paper.latex.definitions import PRIMITIVES
from lagrotor.paper.latex.displays import read_latex, read_source
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.macros import Expander
from lagrotor.paper.latex.readings import statement_text
from lagrotor.paper.latex.tokens import latex_of

PREAMBLE = "\\documentclass{article}\n\\def\\be{\\begin{equation}}\\def\\ee{\\end{equation}}\\def\\x#1{(#1)}\n"


def expanded(text: str) -> str:
    return "".join(latex_of(Expander(text, None, PRIMITIVES)).split())


@pytest.mark.parametrize(
    ("text", "result"),
    [
        (r"\newcommand\x[2][z]{#2#1}\x[a]{b} \x b", "ba bz"),
        (r"\newcommand{\x}{a}\renewcommand\x{b}\providecommand\x{c}\providecommand{\y}{d}\x\y", "bd"),
        (r"\def\x{a}\def\y{\x}\def\x{b}\y", "b"),
        (r"\let\y=\alpha\let\x\y\renewcommand\y{b}\x\y", r"\alpha b"),
        (r"\newcommand{\f}[1]{\newcommand{\g}[1]{#1##1}}\f a\g b", "ab"),
        (r"\def\x#1;{(#1)}\x a; b", r"\x a; b"),  # a sign that ends an argument is not read
        (r"\def\x#1#2{#2#1}\x ab \x{c}{d}", "ba dc"),
        (r"\NewDocumentCommand\x{s m O{z} d()}{\IfBooleanTF{#1}{*}{-}#2#3\IfValueTF{#4}{#4}{.}}\x*a[b](c)\x a", "*abc-az."),
        (r"\DeclareMathOperator*{\argmin}{arg min}\argmin", r"\operatorname*{arg min}"),
        (r"\DeclarePairedDelimiter\abs{|}{|}\abs*{a}\abs[\big]{b}", r"\left|a\right|\left|b\right|"),
        (r"{\def\x{a}\x}\x", r"{a}\x"),
        (r"\newenvironment{w}[1]{\def\x{#1}}{\x}\def\x{a}\begin{w}{b}\x\end{w}\x", "bba"),
        (r"\newif\ifdraft\ifdraft a\else b\fi c", "c"),
        (r"\let\ifdraft\iftrue\ifdraft a\ifdraft b\else c\fi d\else e\fi f", "abdf"),
        (r"\newif\foo \foo a\fi", r"\foo a"),  # no condition: LaTeX refuses it
        (r"\edef\x{a}\x", r"\x"),
        (r"\def\x{a}\AtBeginDocument{\def\x{b}}\x", "b"),
        (r"\let\x\relax\x a", "a"),
        (r"\ifentrytype{a}{b}{c}d", "d"),  # it has arguments and no \fi
        (r"\iffalse a\ifnum1=1 b\fi\ifthenelse{a}{b}{c}\iff\ifq{a} c\else d\fi e", "de"),
    ],
)  # fmt: skip
def test_a_definition_stands_for_its_body(text: str, result: str) -> None:
    assert expanded(text) == "".join(result.split())


DECIDED = r"write \iftrue or \iffalse"
CONDITIONS = {
    r"\ifnum1=1 \section{A}\ifodd2 b\fi\else c\fi d": (r"paper.tex:3: \ifnum", []),
    r"\ifnum1=1 a\ifodd2 b\fi\else c\fi d": ("", []),
    "\\ifx\\a\\b \\begin{equation} a = b \\end{equation}\n\\else c\\fi": (r"paper.tex:3: \ifx", []),
    r"\ifthenelse{\boolean{a}}{\[ a = b \]}{\[ c = d \]}\ifthenelse{}{}{}": (r"paper.tex:3: \ifthenelse", []),
    r"\def\q{a}\ifx\a\b \else\renewcommand{\q}{c}\fi \[ p = \q \]": ("", [r"p = \q"]),
    r"\def\q{\ifdim 1pt=1pt a\else b\fi} \[ p = \q \]": ("", [r"p = \ifdim 1pt=1pt a\else b\fi"]),
}


@pytest.mark.parametrize("body", CONDITIONS)
def test_a_condition_is_not_guessed(body: str, tmp_path: Path) -> None:
    """Both branches are left out and named; in a formula the condition stays, and no reader takes it."""
    said, prints = CONDITIONS[body]
    (file := tmp_path / "paper.tex").write_text(PREAMBLE + f"\\begin{{document}}{body}\\end{{document}}")
    source = read_source(file)
    assert [each.latex for each in source.equations] == prints
    notes = [note for note in source.notes if DECIDED in note]
    assert [note.partition(" is not decided")[0] for note in notes] == ([said] if said else [])
    readings = [read_formula(latex) for latex in prints]
    assert all(reading.stop for reading, latex in zip(readings, prints, strict=True) if "\\" in latex)


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


@pytest.mark.parametrize(
    "text", [r"\def\x{\x}\x", r"\def\x{a\y}\def\y{\x}\x", r"\def\x#1{\x{#1#1}}\x a", r"\newenvironment{x}{\begin{x}}{}\begin{x}",
             r"\def\x#1{#1#1}" + 40 * r"\x{" + "a" + 40 * "}"]
)  # fmt: skip
def test_a_macro_without_end_is_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(macros, "_MOST_EXPANSIONS", 2_000)
    monkeypatch.setattr(macros, "_MOST_TOKENS", 20_000)
    with pytest.raises(InputError, match=r"line 1: .* expands without end: define it without a call"):
        expanded(text)


def test_commands_that_are_nested_too_deeply_are_refused() -> None:
    with pytest.raises(InputError, match="nested too deeply: write them in parts"):
        read_latex(r"\setcounter{a}{" * 3000 + "}" * 3000)
    assert len(read_latex(r"\begin{subequations}" * 3000 + r"\[ a = b \]").equations) == 1


DERIVATIVES = [
    (r"\dv{f}{x}", "Derivative(f, x)"),
    (r"\dv[2]{f}{x}", "Derivative(f, x, 2)"),
    (r"\pdv{f}{x,y}", "the variable of the derivative is not clear"),
    (r"\pdv{f}{x}{y}", "Derivative(Derivative(f, x), y)"),
    (r"\pdv[2]{f}{x}{y}", "Derivative(Derivative(f, x), y)"),
    (r"\pdv[2]{f}{x}", "Derivative(f, x, 2)"),
    (r"\pdv{x} f", "Derivative(f, x)"),
    (r"\sin[2](x)", "sin(x)**2"),
    (r"\qty(a + b) \qty[c]", "(a + b)*c"),
    (r"\ket{a}", r"\ket is unknown"),
    (r"\SI{2}{m}", r"\SI is unknown"),
]


@pytest.mark.parametrize(("formula", "said"), DERIVATIVES)
def test_commands_of_physics_are_read_or_refused_in_words(formula: str, said: str) -> None:
    text = rf"\documentclass{{article}}\usepackage{{physics}}\begin{{document}}\[ g = {formula} \]\end{{document}}"
    (equation,) = read_latex(text).equations
    reading = read_formula(equation.latex)
    assert (reading.stop[0] if reading.stop else statement_text(reading.statements[0]).removeprefix("g = ")) == said


def test_files_are_sought_in_the_folder_of_the_source_and_nowhere_else(tmp_path: Path) -> None:
    (folder := tmp_path / "paper").mkdir()
    (folder / "part").mkdir()
    (tmp_path / "secret.tex").write_text(r"\[ s = 0 \]", encoding="utf-8")
    (folder / "link.tex").symlink_to(tmp_path / "secret.tex")
    (folder / "part" / "one.tex").write_text(r"\[ a = 1 \]\input{two}\input{three}", encoding="utf-8")
    (folder / "part" / "two.tex").write_text(r"\[ b = 2 \]", encoding="utf-8")
    (folder / "of its own.tex").write_text(r"\[ c = 3 \]", encoding="utf-8")
    file = folder / "paper.tex"
    body = (
        r"\import{part/}{one}\input{two}\include{../secret}\input link \input{/etc/hostname}\input{"
        + 9 * "long " * 9
        + r"}\input{"
    )
    file.write_text(
        rf'\documentclass{{article}}\begin{{document}}{body}"of its own.tex"}}\end{{document}}', encoding="utf-8"
    )
    source = read_source(file)
    assert [(each.latex, each.place[0]) for each in source.equations] == [
        ("a = 1", "part/one.tex"),
        ("b = 2", "part/two.tex"),
        ("c = 3", "of its own.tex"),
    ]
    outside = [note.split()[0] for note in source.notes if "is outside the folder of the source" in note]
    assert outside == ["../secret", "link", "/etc/hostname"]
    assert [note.split()[1] for note in source.notes if "is missing" in note][:2] == ["three", "two"]


NAMES = {
    r"A. Bee$^{1}$}\author{C. Dee$^{2,3}$, E. Eff\textsuperscript{1,*}": ("A. Bee", "C. Dee", "E. Eff"),
    r"A. Bee\thanks{Paid by \url{http://a_b}} \and C.\,Dee \\ Univ. of X, Y \\ \texttt{a\_b@c}": ("A. Bee", "C. Dee"),
    r"Jos\'e \surname{Garc\'{\i}a} and {\O}. \c{S}. Stra{\ss}e": ("José García", "Ø. Ş. Straße"),
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
