"""A hundred sources of our own, one construct each: numbers as pdflatex prints them, and readings, as they are on record."""

import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

from lagrotor.errors import InputError
from lagrotor.paper.source.formula import read_formula
from lagrotor.paper.source.markup import read_source
from lagrotor.paper.source.printed import statement_text
from lagrotor.paper.source.start import aux_numbers
from lagrotor.paper.source.usage import notation_of

CORPUS: list[dict[str, Any]] = tomllib.loads(Path(__file__).with_name("corpus.toml").read_text(encoding="utf-8"))[
    "source"
]
TEX = [row for row in CORPUS if row["suffix"] == ".tex" and "numbers" in row]


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
    notation = notation_of([*(each.latex for each in source.equations), *source.inline])
    readings = [read_formula(each.latex, notation, each.lead) for each in source.equations]
    said = [
        "; ".join(map(statement_text, r.statements)) if r.stop is None else f"stopped: {r.stop[0]}" for r in readings
    ]
    assert said == row["readings"]
    if "marked" in row:
        assert [e.number for e, r in zip(source.equations, readings, strict=True) if r.whole and r.guesses] == row[
            "marked"
        ]


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
