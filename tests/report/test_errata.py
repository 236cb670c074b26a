"""The errata sheet: a row for each refuted equation, LaTeX in ASCII that compiles where there is a compiler."""

import shutil
import subprocess
import unicodedata
from pathlib import Path

import pytest

from lagrotor.paper import Audit, Verdict
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.errata import errata, latex_document
from lagrotor.report.latex import latex_prose, tidy


@pytest.fixture(scope="module")
def verdicts(audit: Audit) -> list[Verdict]:
    return list(audit)


def test_every_refuted_equation_has_its_row_and_no_other(verdicts: list[Verdict]) -> None:
    refuted = [v.id for v in verdicts if v.verdict == "refuted"]
    rows = list(errata(verdicts, PAPER))
    assert [e.id for e in rows] == refuted
    assert len(refuted) > 10
    for e in rows:
        assert e.wrong
        assert e.corrected
        assert all(" = " in line for line in e.corrected)
        assert e.printed


def test_an_error_that_stops_short_is_told_from_one_that_does_not(verdicts: list[Verdict]) -> None:
    reach = {e.id: e.survives for e in errata(verdicts, PAPER)}
    assert reach["2.08"], "the sign is made good before (7)"
    assert not reach["5.20"], "the trajectories 5.22 fall with it"


def test_the_document_compiles(verdicts: list[Verdict], tmp_path: Path) -> None:
    compiler = shutil.which("pdflatex")
    if compiler is None:
        pytest.skip("no pdflatex on this machine: install a LaTeX distribution to check that the sheet compiles")
    (tmp_path / "errata.tex").write_text(latex_document(verdicts, PAPER), encoding="ascii")
    command = [compiler, "-interaction=nonstopmode", "-halt-on-error", "errata.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-1500:]
    assert (tmp_path / "errata.pdf").stat().st_size > 10_000
    assert "errata.pdf (3 pages" in done.stdout


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("J r̂ × r̂″", r"J $\hat{r}$ $\times$ $\hat{r}$$''$"),
        ("|r̂′| ≪ ω", r"$|$$\hat{r}$$'$$|$ $\ll$ $\omega$"),
        ("sin(‖Ω‖ Δt)", r"sin($\|$$\Omega$$\|$ $\Delta$t)"),
        ("a ⊗ b", r"a \text{[circled times]} b"),
    ],
)
def test_no_character_becomes_a_question_mark(text: str, written: str) -> None:
    assert latex_prose(text) == written
    everything = " ".join(
        chr(code) for code in range(33, 0x2AFF) if "?" not in unicodedata.normalize("NFKD", chr(code))
    )
    assert "?" not in latex_prose(everything) and "?" not in tidy(everything)
