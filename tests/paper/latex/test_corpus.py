"""A hundred sources of our own, one construct each: numbers as pdflatex prints them, and readings, as they are on record."""

import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.latex.displays import read_latex, read_source
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.numbers import aux_numbers
from lagrotor.paper.latex.readings import statement_text

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
    """Without the .aux the numbers are LaTeX's, or a note says that they may be others; with it all are LaTeX's."""
    compiler = shutil.which("pdflatex")
    if compiler is None:
        pytest.skip("no pdflatex on this machine: install a LaTeX distribution to compare numbers with it")
    file = written(row, tmp_path)
    alone = read_source(file)
    for _ in range(2):
        subprocess.run(
            [compiler, "-interaction=nonstopmode", "-draftmode", file.name],
            cwd=tmp_path,
            capture_output=True,
            check=False,
        )
    printed = {label: number for label, number in aux_numbers(file).items() if label in alone.labels}
    if not printed:
        pytest.skip("a package that this source loads is not installed, or no equation of it is read")
    uncertain = any("the equation numbers may differ from the printed ones" in note for note in alone.notes)
    assert uncertain or {label: alone.labels[label] for label in printed} == printed
    beside = {each.label: each.number for each in read_source(file).equations if each.number and each.label in printed}
    assert beside == {label: printed[label] for label in beside}


def equations_of(folder: Path, body: str, **files: str) -> list[tuple[str, str]]:
    """Numbers and prints of a source beside which other files stand."""
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_text(text, encoding="utf-8")
    whole = rf"\documentclass{{article}}\usepackage{{side}}\begin{{document}}{body}\end{{document}}"
    (folder / "paper.tex").write_text(whole, encoding="utf-8")
    return [(each.number, each.latex) for each in read_source(folder / "paper.tex").equations]


@pytest.mark.parametrize(("tag", "number"), [(r"$\dagger$", "†"), (r"$\ddagger$", "‡"), (r"$\ast$", "*")])
def test_signs_of_a_tag_are_signs(tag: str, number: str, tmp_path: Path) -> None:
    body = rf"\begin{{equation}} a = b \tag{{{tag}}} \end{{equation}}"
    assert equations_of(tmp_path, body) == [(number, "a = b")]


@pytest.mark.parametrize(
    ("document_class", "body", "numbers"),
    [
        ("article", r"\section{A}=\appendix\section{B}==", "1 2 3"),
        ("amsart", r"\numberwithin{equation}{section}\section{A}=\appendix\section{B}==", "1.1 A.1 A.2"),
        ("article", r"\numberwithin{equation}{section}\section{}\section[hang]{}\section{A}=", "3.1"),
        ("article", r"\numberwithin{equation}{section}\renewcommand{\section}[1]{}\section{A}=", "1.1"),
        ("book", r"=\chapter{A}=\section{B}=\appendix\chapter{B}=\chapter*{C}=", "1 1.1 1.2 A.1 A.2"),
        ("book", r"\frontmatter\chapter{A}=\mainmatter\chapter{B}=", "1 1.1"),
        ("report", r"=\chapter{A}=", "1 1.1"),
        ("report", r"\chapter{A}\begin{appendix}\chapter{B}=\end{appendix}\chapter{C}=", "A.1 B.1"),
        ("report", r"=\appendix=", "1 2"),
        ("article", r"\renewcommand{\theequation}{A\arabic{equation}}={\renewcommand{\theequation}{B}=}=", "A1 B A3"),
        ("article", r"\newtheorem{law}{Law}=\begin{law}=\end{law}=", "1 2 3"),
    ],
)
def test_standard_classes_number_as_latex_does(document_class: str, body: str, numbers: str) -> None:
    text = body.replace("=", r"\begin{equation} a = b \end{equation}")
    source = read_latex(rf"\documentclass{{{document_class}}}\begin{{document}}{text}\end{{document}}")
    assert [each.number for each in source.equations] == numbers.split()
    assert not source.notes


ARTICLE = r"\documentclass{article}\begin{document}"
AUX = r"\relax\newlabel{a}{{4.2}{7}}\newlabel{b}{{$3^\prime $}{7}{Title}{equation.3}{}}"
MAY_BE_OTHERS = (
    "and the equation numbers may differ from the printed ones: put paper.aux, which LaTeX writes, next to the source"
)
COUNTS = r"\begin{equation}\label{a} a = b \end{equation}\begin{equation}\label{b} c = d \end{equation}"


@pytest.mark.parametrize(
    ("start", "said"),
    [
        (r"\documentclass{strange}\begin{document}", "the class strange is unknown"),
        (ARTICLE + r"\setcounter{equation}{\x}", r"paper.tex:1: \setcounter{equation}{\x} is unknown"),
        (ARTICLE + r"\newtheorem{law}[equation]{Law}", "theorems share the counter of equations"),
        (ARTICLE + r"\mathtoolsset{showonlyrefs}", "showonlyrefs of mathtools removes numbers"),
        (ARTICLE + r"\ifnum1=1 \stepcounter{equation}\fi", "a part of the source is skipped"),
        (ARTICLE, ""),
    ],
)
def test_numbers_that_cannot_be_known_are_said_and_taken_from_the_aux(start: str, said: str, tmp_path: Path) -> None:
    (file := tmp_path / "paper.tex").write_text(start + COUNTS + r"\end{document}", encoding="utf-8")
    alone = read_source(file)
    assert [note for note in alone.notes if MAY_BE_OTHERS in note] == ([f"{said}, {MAY_BE_OTHERS}"] if said else [])
    assert [each.number for each in alone.equations] == ["1", "2"]
    (tmp_path / "paper.aux").write_text(AUX, encoding="utf-8")
    source = read_source(file)
    assert [(each.id, each.number) for each in source.equations] == [("4.2", "4.2"), ("3'", "3'")]
    (tmp_path / "paper.aux").write_text(r"\newlabel{a}{{1}{7}}", encoding="utf-8")
    assert read_source(file).notes[-1] == "paper.aux has no label b: run LaTeX again, which writes the numbers there"


@pytest.mark.parametrize(
    ("body", "labels"),
    [
        (r"\begin{eqnarray} a &=& b \label{l} \\ c &=& d \end{eqnarray}", {"l": "1"}),
        (r"\begin{align} a &= b \nonumber\label{l} \\ c &= d \end{align}", {"l": "1"}),
        (r"\begin{equation*} a = b \label{l} \end{equation*}", {}),
        (r"\begin{subequations}\begin{align} a &= b \end{align}\label{l}\end{subequations}", {"l": "1"}),
        (r"\begin{subequations}\begin{align} a &= b \label{l}\end{align}\end{subequations}", {"l": "1a"}),
        (r"\section{S}\label{s}", {}),
        (r"{\begin{subequations}}\label{l}", {"l": "1"}),
    ],
)
def test_a_label_has_the_number_of_its_equation(body: str, labels: dict[str, str]) -> None:
    assert read_latex(rf"\documentclass{{article}}\begin{{document}}{body}\end{{document}}").labels == labels
