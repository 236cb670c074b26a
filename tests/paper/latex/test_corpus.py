"""A hundred sources of our own, one construct each: numbers as pdflatex prints them, and readings, as they are on record."""

import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.latex.displays import read_latex
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.init import aux_numbers
from lagrotor.paper.latex.markup import read_source
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.printed import statement_text

CORPUS: list[dict[str, Any]] = tomllib.loads(Path(__file__).with_name("corpus.toml").read_text(encoding="utf-8"))[
    "source"
]
TEX = [row for row in CORPUS if row["suffix"] == ".tex" and "numbers" in row and r"\label" in row["text"]]


def written(row: dict[str, Any], folder: Path) -> Path:
    """The files of a source; gives its main file."""
    for name, text in row.get("files", {}).items():
        (folder / f"{name}.tex").write_text(text, encoding="utf-8")
    file = folder / f"paper{row['suffix']}"
    file.write_text(row["text"], encoding="utf-8")
    return file


def named(row: dict[str, Any]) -> str:
    return str(row["name"])


def test_the_corpus_is_as_large_as_it_is_said_to_be() -> None:
    assert len({row["name"] for row in CORPUS}) == len(CORPUS) >= 100


@pytest.mark.parametrize("row", CORPUS, ids=named)
def test_numbers_and_readings_are_as_recorded(row: dict[str, Any], tmp_path: Path) -> None:
    file = written(row, tmp_path)
    if "refused" in row:
        with pytest.raises(InputError) as refusal:
            read_source(file)
        assert row["refused"] in str(refusal.value)
        return
    source = read_source(file)
    assert [each.number for each in source.equations] == row["numbers"]
    notation = with_proposals(Notation(), propose([*(each.latex for each in source.equations), *source.inline]))
    readings = [read_formula(each.latex, notation, each.lead) for each in source.equations]
    said = [
        "; ".join(map(statement_text, r.statements)) if r.stop is None else f"stopped: {r.stop[0]}" for r in readings
    ]
    assert said == row["readings"]


def test_a_changed_print_would_be_read_otherwise(tmp_path: Path) -> None:
    row = CORPUS[0]
    file = written(row | {"text": row["text"].replace("-k", "k")}, tmp_path)
    (equation,) = read_source(file).equations
    assert statement_text(read_formula(equation.latex).statements[0]) not in row["readings"]


@pytest.mark.slow
@pytest.mark.parametrize("row", TEX, ids=named)
def test_pdflatex_prints_the_same_numbers(row: dict[str, Any], tmp_path: Path) -> None:
    compiler = shutil.which("pdflatex")
    if compiler is None:
        pytest.skip("no pdflatex on this machine: install a LaTeX distribution to compare numbers with it")
    file = written(row, tmp_path)
    for _ in range(2):
        run = subprocess.run(
            [compiler, "-interaction=nonstopmode", "-draftmode", file.name],
            cwd=tmp_path,
            capture_output=True,
            check=False,
        )
    printed = {label: number for label, number in aux_numbers(file).items() if label != "LastPage"}
    if not printed and b"not found" in run.stdout:
        pytest.skip("a package that this source loads is not installed")
    labels = read_source(file).labels
    assert printed == {label: labels.get(label) for label in printed} and printed


def equations_of(folder: Path, body: str, **files: str) -> list[tuple[str, str]]:
    """Numbers and prints of a source beside which other files stand."""
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text, encoding="utf-8")
    own = r"\documentclass{own}" if "own_cls" in files else r"\documentclass{article}\usepackage{side}"
    (folder / "paper.tex").write_text(rf"{own}\begin{{document}}{body}\end{{document}}", encoding="utf-8")
    return [(each.number, each.latex) for each in read_source(folder / "paper.tex").equations]


# A package and a class whose commands look at what comes next; without that each calls itself without end.
SIDE = r"""\def\sidebox{\@ifnextchar[{\side@lines}{\side@lines[2]}}
\def\side@lines[#1]#2{\@ifnextchar[{\side@lines}{\side@plain}}
\def\side@plain{\begin{equation} q = p \end{equation}}"""
OWN = r"""\LoadClass{article}\def\notes{\@ifnextchar[\notes@\relax}\def\notes@[#1]{\@ifnextchar[\notes@\relax}
\newcommand{\lemma}{\@ifstar{\setcounter{equation}{7}}{\setcounter{equation}{4}}}"""


@pytest.mark.parametrize(("call", "numbers"), [(r"\sidebox[3]{r}[1pt]{l}", "123"), (r"\sidebox{r}", "123"), ("", "12")])
def test_a_package_that_looks_at_what_comes_next_hides_no_display(call: str, numbers: str, tmp_path: Path) -> None:
    body = rf"\begin{{equation}} a = b \end{{equation}}{call}\begin{{equation}} c = d \end{{equation}}"
    found = equations_of(tmp_path, body, side_sty=SIDE)
    assert "".join(number for number, _ in found) == numbers
    assert (found[0][1], found[-1][1]) == ("a = b", "c = d") and len(found) == len(numbers)


def test_a_file_is_found_by_its_name_in_other_capitals(tmp_path: Path) -> None:
    body = r"\input{Side}\begin{equation} a = b \end{equation}"
    assert [number for number, _ in equations_of(tmp_path, body, side_tex=r"\setcounter{equation}{3}")] == ["4"]


@pytest.mark.parametrize(("star", "number"), [("*", "8"), ("", "5")])
def test_a_class_that_looks_at_what_comes_next_keeps_the_numbers(star: str, number: str, tmp_path: Path) -> None:
    body = rf"\notes[a][b] \lemma{star} \begin{{equation}} a = b \end{{equation}}"
    assert equations_of(tmp_path, body, own_cls=OWN) == [(number, "a = b")]


# A class that does something at each environment for which it has a command of this name, as classes of journals do.
HOOKS = r"""\LoadClass{article}\let\Begin=\begin\def\IfUnDef#1{\expandafter\ifx\csname#1\endcsname\relax}
\def\begin#1{\IfUnDef{AfterBeg#1}\let\now=\Begin\else\Begin{#1}\csname AfterBeg#1\endcsname\def\now##1{}\fi\now{#1}}
\expandafter\def\csname AfterBegcenter\endcsname{\setcounter{equation}{5}}"""


def test_a_name_that_nothing_defines_is_relax(tmp_path: Path) -> None:
    display = r"\begin{equation} a = b \end{equation}"
    body = rf"{display}\begin{{center}}{display}\end{{center}}"
    assert equations_of(tmp_path, body, own_cls=HOOKS) == [("1", "a = b"), ("6", "a = b")]


def test_what_a_class_hides_is_read_without_it_and_with_the_packages(tmp_path: Path) -> None:
    (tmp_path / "side.sty").write_text(r"\newcommand{\vect}[1]{\mathbf{#1}}", encoding="utf-8")
    own = r"\LoadClass{article}\def\begin#1{\lost{#1}}"
    assert equations_of(tmp_path, "", own_cls=own) == []
    text = (
        r"\documentclass{own}\usepackage{side}\begin{document}\begin{equation} \vect a = b \end{equation}\end{document}"
    )
    (tmp_path / "paper.tex").write_text(text, encoding="utf-8")
    assert [each.latex for each in read_source(tmp_path / "paper.tex").equations] == [r"\mathbf{a} = b"]


@pytest.mark.parametrize(("tag", "number"), [(r"$\dagger$", "†"), (r"$\ddagger$", "‡"), (r"$\ast$", "*")])
def test_signs_of_a_tag_are_signs(tag: str, number: str, tmp_path: Path) -> None:
    body = rf"\begin{{equation}} a = b \tag{{{tag}}} \end{{equation}}"
    assert equations_of(tmp_path, body, side_sty="") == [(number, "a = b")]


def test_the_second_column_of_numcases_is_text(tmp_path: Path) -> None:
    body = r"\begin{numcases}{f = } 1 & $x<0$\\ 2 & otherwise, $c$ large\\ 3 & \end{numcases}"
    prints = [latex for _, latex in equations_of(tmp_path, body, side_sty="")]
    assert prints == [r"f =  1 \quad x<0", r"f =  2 \quad\text{ otherwise, }c\text{ large}", r"f =  3 \quad"]


@pytest.mark.parametrize(
    ("printed", "number"),
    [
        (r"\@arabic\c@equation", "1"),
        (r"\@Roman{\c@section}.\@alph\c@equation", "II.a"),
        (r"\number\value{section}", "2"),
    ],
)
def test_a_class_may_print_numbers_as_latex_does_inside(printed: str, number: str, tmp_path: Path) -> None:
    own = rf"\LoadClass{{article}}\def\theequation{{{printed}}}"
    body = r"\section{A}\section{B}\begin{equation} a = b \end{equation}"
    assert equations_of(tmp_path, body, own_cls=own) == [(number, "a = b")]


# What classes and packages beside a source do to counters, each with its twin, which does not: the numbers of a = b.
_APPENDIX = r"\def\appendix{\par\setcounter{equation}{0}\def\theequation{\hbox{\@Alph\c@section\arabic{equation}}}}"
_MORE = r"""\newcommand\appendices{\c@chapter\z@ \renewcommand\thechapter{\@Alph\c@chapter}\def\more{\secdef\@more\@mores}}
\def\@more[#1]#2{\refstepcounter{chapter}}\def\@mores#1{\advance\c@chapter by 2 }"""
_LATE = r"\AtEndOfClass{\renewcommand\theequation{\Alph{equation}}}\def\theequation{\roman{equation}}"
_CHAPTERS = r"\def\thechapter{\arabic{chapter}}\def\theequation{\thechapter.\arabic{equation}}"
_CASE = (
    r"\def\style{%s}%s\ifcase\style \setcounter{equation}{1}\or\setcounter{equation}{2}\else\setcounter{equation}{3}\fi"
)
_TESTED = r"\newboolean{yes}\setboolean{yes}{true}\newboolean{no}\ifthenelse{%s}{\setcounter{equation}{4}}{}"
_HOLD = (
    r"\boolean{yes}",
    r"\boolean{no}\OR\boolean{yes}",
    r"\boolean{yes}\AND\NOT\boolean{no}",
    r"\isundefined{\chapter}\AND\equal{a}{a}",
    r"\boolean{no}\OR\(\equal{a}{b}\OR\value{section}<1\)",
)
_CHOSEN = r"\newif\ifown\DeclareOption{own}{\owntrue}\ExecuteOptions{%s}\ProcessOptions\ifown\def\theequation{*}\fi"


@pytest.mark.parametrize(
    ("own", "body", "numbers"),
    [
        (_APPENDIX, r"\section{A}=\appendix\section{B}==", "1 B1 B2"),
        ("", r"\section{A}=\appendix\section{B}==", "1 2 3"),
        (rf"\LoadClass{{book}}{_MORE}", r"\chapter{A}=\appendices\more{B}=\more*{C}=", "1.1 A.1 C.2"),
        (r"\LoadClass{book}", r"\chapter{A}=\appendix\chapter{B}=\chapter*{C}=", "1.1 A.1 A.2"),
        (_LATE, "==", "A B"),
        (_LATE.replace("AtEndOfClass", "AtBeginDocument"), "==", "A B"),
        (_LATE.replace("AtEndOfClass", "def\\late"), "==", "i ii"),
        (_CHOSEN % "own", "=", "*"),
        (_CHOSEN % "other", "=", "1"),
        (r"\providecommand{\section}{}\numberwithin{equation}{section}", r"\section{A}=", "1.1"),
        (r"\renewcommand{\section}[1]{}\numberwithin{equation}{section}", r"\section{A}=", "0.1"),
        (r"\ifeof\f\else\loop\unless\ifeof\f\relax\repeat\setcounter{equation}{4}\fi", "=", "5"),
        (r"\iftrue\else\setcounter{equation}{4}\fi", "=", "1"),
        (
            r"\numberwithin{equation}{section}",
            r"\titlespacing*{\section}\titleformat\section[hang]{}\section{A}=",
            "1.1",
        ),
        (r"\numberwithin{equation}{section}", r"\section{}\section[hang]{}\section{A}=", "3.1"),
        (r"\apptocmd{\appendix}{\numberwithin{equation}{section}}{}{}", r"\section{A}=\appendix\section{B}=", "1 A.1"),
        (r"\g@addto@macro\appendix{\setcounter{equation}{0}}", r"\section{A}=\appendix=", "1 1"),
        (r"\pretocmd{\section}{\setcounter{equation}{3}}{}{}", r"=\section{A}=", "1 4"),
        (r"\def\base{book}\LoadClass{\base}", r"\chapter{A}=", "1.1"),
        (r"\LoadClass{scrreprt}", r"=\chapter{A}=", "0.1 1.1"),
        (r"\LoadClass{report}", r"=\chapter{A}=", "1 1.1"),
        (r"\LoadClass{report}", r"\chapter{A}\begin{appendix}\chapter{B}=\end{appendix}\chapter{C}=", "A.1 B.1"),
        (r"\LoadClass{report}", r"\chapter{A}\begin{append}\chapter{B}=\end{append}\chapter{C}=", "2.1 3.1"),
        (r"\LoadClass{book}", r"\begin{chapter}{A}=\end{chapter}\begin{chapter}{B}=\end{chapter}", "1.1 2.1"),
        (r"\LoadClass{book}", r"\begin{chapters}{A}=\end{chapters}\begin{chapters}{B}=\end{chapters}", "1 2"),
        (rf"\newcounter{{chapter}}{_CHAPTERS}", r"\chapter{A}=\appendix\chapter{B}=", "1.1 A.2"),
        (rf"\newcounter{{chapter}}{_CHAPTERS}", r"\chapter{A}=\chapter{B}=", "1.1 2.2"),
        (r"\@ifundefined{chapter}{}{\setcounter{equation}{4}}", "=", "1"),
        (r"\@ifundefined{section}{}{\setcounter{equation}{4}}", "=", "5"),
        (r"\@ifpackageloaded{side}{\setcounter{equation}{4}}{}\@ifclassloaded{article}{}{\undefined}", "=", "1"),
        (r"\RequirePackage{side}\@ifpackageloaded{side}{\setcounter{equation}{4}}{}", "=", "5"),
        *((_CASE % (style, ""), "=", number) for style, number in (("0", "2"), ("1", "3"), ("2", "4"), ("7", "4"))),
        *((_CASE % (style, r"\def\style{1}"), "=", "3") for style in "07"),
        (r"\def\point#1{\ifnum\spacefactor>\@m \else#1\fi}\def\head#1{\textbf{#1\point{.}}}", r"\head{A}==", "1 2"),
        (r"\def\point{\ifnum\value{section}>\@m 1\else\setcounter{equation}{4}\fi}", r"\point=", "5"),
        (r"\def\point{\ifnum\value{section}<\@m 1\else\setcounter{equation}{4}\fi}", r"\point=", "1"),
        *((_TESTED % test, "=", "5") for test in _HOLD),
        *((_TESTED % rf"\NOT\({test}\)", "=", "1") for test in _HOLD),
        (r"\endinput\setcounter{equation}{4}", "=", "1"),
        (r"\setcounter{equation}{4}\endinput", "=", "5"),
    ],
)
def test_what_a_class_does_to_counters_is_done(own: str, body: str, numbers: str, tmp_path: Path) -> None:
    text = body.replace("=", r"\begin{equation} a = b \end{equation}")
    assert [
        number for number, _ in equations_of(tmp_path, text, own_cls=rf"\LoadClass{{article}}{own}")
    ] == numbers.split()


@pytest.mark.parametrize(
    ("options", "number"),
    [("", "1"), ("roman", "i"), ("roman,at=3", "iv"), ("roman=false", "1"), ("at = 2, roman", "iii"), ("at=0", "1")],
)
def test_options_of_a_package_hold_what_it_is_loaded_with(options: str, number: str, tmp_path: Path) -> None:
    keys = r"""\SetupKeyvalOptions{prefix=own@}\DeclareBoolOption{roman}\DeclareStringOption[0]{at}\ProcessKeyvalOptions*
    \ifown@roman\def\theequation{\roman{equation}}\fi\ifnum\own@at>0 \setcounter{equation}{\own@at}\fi"""
    for own in (
        rf"\PassOptionsToPackage{{{options}}}{{keys}}\RequirePackage{{keys}}",
        rf"\RequirePackage[{options}]{{keys}}",
    ):
        body = r"\begin{equation} a = b \end{equation}"
        found = equations_of(tmp_path, body, own_cls=rf"\LoadClass{{article}}{own}", keys_sty=keys)
        assert found == [(number, "a = b")]


def test_a_class_in_which_the_document_is_lost_is_left_out(tmp_path: Path) -> None:
    body = r"\begin{equation} a = b \end{equation}\date{a}\begin{equation} c = d \end{equation}"
    lost = r"\LoadClass{article}\def\date#1{\iffalse}"
    assert len(equations_of(tmp_path, body, own_cls=lost)) == 2
    assert len(equations_of(tmp_path, body, own_cls=lost.replace("false", "true"))) == 2


# Labels of rows without a number, each with what LaTeX prints for it.
@pytest.mark.parametrize(
    ("body", "label"),
    [
        (r"\begin{eqnarray} a &=& b \nonumber\label{l} \\ c &=& d \end{eqnarray}", "1"),
        (r"\begin{eqnarray} c &=& d \\ a &=& b \nonumber\label{l} \end{eqnarray}", "2"),
        (r"\begin{eqnarray*} a &=& b \label{l} \end{eqnarray*}", "1"),
        (r"\begin{equation*} a = b \label{l} \end{equation*}", "3.1"),
        (r"\begin{subequations}\begin{align} a &= b \end{align}\label{l}\end{subequations}", "1"),
        (r"\begin{subequations}\begin{align} a &= b \label{l}\end{align}\end{subequations}", "1a"),
    ],
)
def test_a_label_refers_to_what_latex_prints(body: str, label: str) -> None:
    text = rf"\setcounter{{section}}{{2}}\section{{S}}\subsection{{T}}{body}"
    assert read_latex(rf"\documentclass{{article}}\begin{{document}}{text}\end{{document}}").labels == {"l": label}


@pytest.mark.parametrize(
    ("document_class", "body", "label"),
    [
        ("revtex4-2", r"\section{S}\subsection{T}=", "I A"),
        ("revtex4-2", r"\section{S}\subsection{T}\subsubsection{U}=", "I A 1"),
        ("revtex4-2", r"\section{S}=", "I"),
        ("article", r"\section{S}\subsection{T}=", "1.1"),
        ("beamer", r"\section{S}\begin{frame}\end{frame}\begin{frame}=\end{frame}", "2"),
        ("article", r"\section{S}\begin{frame}\end{frame}\begin{frame}=\end{frame}", "1"),
        ("article", r"\section{R}\hypertarget{s}{\section{S}}=", "2"),
        ("folder/beamer", r"\section{S}\begin{frame}\end{frame}\begin{frame}=\end{frame}", "2"),
        ("article", r"\newtheorem{t}{T}[section]\section{S}\begin{t}\end{t}\begin{t}=\end{t}", "1.2"),
        (
            "article",
            r"\newtheorem{t}{T}[section]\newtheorem{u}[t]{U}\section{S}\begin{t}\end{t}\begin{u}=\end{u}",
            "1.2",
        ),
        ("article", r"\newtheorem{t}{T}\section{S}\section{V}\begin{t}=\end{t}", "1"),
        ("article", r"\newtheorem{t}{T}[section]\section{S}\begin{t}\end{t}\begin{t}\end{t}=", "1"),
        ("article", r"\newcounter{k}\setcounter{k}{3}\section{S}\refstepcounter{k}=", "4"),
        ("article", r"\newcounter{k}\setcounter{k}{3}\section{S}{\refstepcounter{k}}=", "1"),
        ("article", r"\newcounter{k}\setcounter{k}{3}\section{S}\stepcounter{k}=", "1"),
    ],
)
def test_a_label_without_a_number_refers_to_what_was_numbered_last(document_class: str, body: str, label: str) -> None:
    text = body.replace("=", r"\begin{equation*} a = b \label{l} \end{equation*}")
    assert read_latex(rf"\documentclass{{{document_class}}}\begin{{document}}{text}\end{{document}}").labels == {
        "l": label
    }


@pytest.mark.parametrize(
    ("document_class", "command", "labels"),
    [("beamer", r"\uncover<+->", "1 2"), ("beamer", r"\only", "1 2"), ("article", r"\uncover<+->", "1 1")],
)
def test_rows_may_end_in_what_a_slide_uncovers(document_class: str, command: str, labels: str) -> None:
    rows = rf"{command}{{a &= b \label{{l}} \\}} {command}{{c &= d \label{{m}}}}"
    text = rf"\begin{{frame}}\begin{{align}} {rows} \end{{align}}\end{{frame}}"
    found = read_latex(rf"\documentclass{{{document_class}}}\begin{{document}}{text}\end{{document}}").labels
    assert [found["l"], found["m"]] == labels.split()


@pytest.mark.parametrize(("main", "number"), [("main.tex", "1.1"), ("parts/main.tex", "1.1"), ("other.tex", "1")])
def test_the_main_file_of_a_part_is_beside_it_or_above_or_said_to_be_missing(
    main: str, number: str, tmp_path: Path
) -> None:
    (tmp_path / "parts").mkdir()
    whole = r"\documentclass{book}\begin{document}\subfile{parts/one}\end{document}"
    (tmp_path / main).write_text(whole, encoding="utf-8")
    display = r"\begin{document}\chapter{A}\begin{equation} a = b \end{equation}\end{document}"
    (tmp_path / "parts" / "one.tex").write_text(rf"\documentclass[main.tex]{{subfiles}}{display}", encoding="utf-8")
    source = read_source(tmp_path / "parts" / "one.tex")
    assert [each.number for each in source.equations] == [number]
    assert any("main.tex, the main file, is missing" in note for note in source.notes) == (number == "1")


@pytest.mark.parametrize(("star", "numbers"), [("*", ["2", "3"]), ("ed", ["1", "2"])])
def test_a_tag_does_not_take_back_the_number_of_a_display_that_holds_another(star: str, numbers: list[str]) -> None:
    held = rf"\fbox{{\begin{{minipage}}{{9em}}\begin{{align{star}}} a &= b \end{{align{star}}}\end{{minipage}}}}"
    tagged = rf"\begin{{equation}} {held} \refstepcounter{{equation}}\tag{{\theequation}}\label{{l}} \end{{equation}}"
    text = rf"{tagged}\begin{{equation}} c = d \label{{m}} \end{{equation}}"
    labels = read_latex(rf"\documentclass{{article}}\begin{{document}}{text}\end{{document}}").labels
    assert [labels["l"], labels["m"]] == numbers


@pytest.mark.parametrize("end", ["\n\n", r"\par "])
def test_an_argument_that_is_not_closed_ends_with_its_paragraph(end: str, tmp_path: Path) -> None:
    text = rf"\def\aside#1;{{}} \aside open{end}\begin{{equation}} a = b \end{{equation}} then; \[ c\aside x; = d \]"
    assert equations_of(tmp_path, text) == [("1", "a = b"), ("", "c = d")]
    assert equations_of(tmp_path, text.replace(end, " ")) == [("", "c = d")]
