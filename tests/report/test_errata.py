"""The errata sheet: a row for each refuted equation, LaTeX in ASCII that compiles where there is a compiler."""

import re
import shutil
import subprocess
import unicodedata
from pathlib import Path

import numpy as np
import pytest

from lagrotor import Link, Scene, natural_rate
from lagrotor.models import exact_orbit
from lagrotor.paper import Audit, Paper, Verdict
from lagrotor.paper.catalogue import section_meanings
from lagrotor.paper.plain_text import readable_on_page
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report
from lagrotor.report.errata import (
    errata,
    latex_document,
    letter_table,
    letters_in,
    listed_premises,
    premise_text,
    sheet_summary,
)
from lagrotor.report.facts import unmet
from lagrotor.report.latex import latex_prose, tidy
from lagrotor.report.text_forms import errata_sheet


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
    assert "errata.pdf (5 pages" in done.stdout


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


@pytest.mark.parametrize(
    ("formula", "letters"),
    [
        (r"\dot\phi\text{ (equal spins)} = \frac{I_3 \omega}{\left(a + b\right) \cos \theta} + O\left(\theta^{4}\right)",
         ["\\phi", "I_3", "\\omega", "a", "b", "\\theta"]),
        (r"\vec F_{12} = - (S s + D \vec{U}_{1}\cdot \hat{e}) \hat{e}",
         ["vec F_12", "S", "s", "D", "vec U_1", "hat e"]),
        (r"\omega_1 I\dot{\hat r} = \frac{1}{M} \sum_i m_{i}", ["\\omega_1", "I", "hat r", "M", "m_i"]),
        (r"P(\vec\Omega) = \vec{\Omega}^{T} I_0^{-1} A_{x} + O(r_0^3)", ["P", "vec \\Omega", "I_0", "A_x", "r_0"]),
        (r"\frac{d}{dt}\vec X_r = O", ["vec X_r", "O"]),
    ],
)  # fmt: skip
def test_the_letters_of_a_formula_are_found(formula: str, letters: list[str]) -> None:
    assert list(letters_in(formula)) == letters


def unexplained(verdicts: list[Verdict]) -> set[tuple[str, str]]:
    """The letters of corrected lines that the table of the sheet lacks, each with its item."""
    rows = list(errata(verdicts, PAPER))
    explained = {(i, letters_in(tex)[0]) for tex, _, _, ids in letter_table(rows, PAPER) for i in ids.split(", ")}
    return {(e.id, letter) for e in rows for line in e.corrected for letter in letters_in(line)} - explained


def test_every_letter_of_a_corrected_line_is_in_the_table(
    verdicts: list[Verdict], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not unexplained(verdicts)

    def fewer(paper: Paper, section: str) -> dict[str, tuple[str, str]]:
        return {tex: row for tex, row in section_meanings(paper, section).items() if tex not in ("A_x", r"\hat e", "s")}

    monkeypatch.setattr("lagrotor.report.errata.section_meanings", fewer)
    assert unexplained(verdicts) == {("5.22", "A_x"), ("3.19", "hat e"), ("3.19", "s")}


def test_a_letter_has_one_meaning_in_an_item(verdicts: list[Verdict]) -> None:
    table = letter_table(errata(verdicts, PAPER), PAPER)
    placed = [(letters_in(tex), i) for tex, _, _, ids in table for i in ids.split(", ")]
    assert len(placed) == len(set(placed))
    assert all(meaning and unit for _, meaning, unit, _ in table)
    assert {i for tex, _, _, ids in table if tex == "R" for i in [ids]} > {"3.12, 3.17, 3.18"}
    assert not any("rho" in line for e in errata(verdicts, PAPER) for line in e.corrected)


def test_a_premise_is_printed_once_and_every_cited_number_exists(verdicts: list[Verdict]) -> None:
    listed = listed_premises(errata(verdicts, PAPER))
    markdown, tex = errata_sheet(Report(PAPER, tuple(verdicts), (), ())), latex_document(verdicts, PAPER)
    for sheet, labels in ((markdown, r"\*\*(P\d+):\*\* "), (tex, r"^(P\d+): ")):
        numbers = re.findall(labels, sheet, re.MULTILINE)
        assert numbers == [f"P{i}" for i in range(1, len(listed) + 1)]
        items = sheet.split("### Erratum" if sheet is markdown else r"\item ")[1:]
        cited = {n for item in items for n in re.findall(r"\bP\d+\b", item)}
        assert cited == set(numbers)
    for premise in listed:
        words = readable_on_page(premise.says)
        assert markdown.count(f":** {words}") == 1, words
        assert sum(words in readable_on_page(premise_text(other)) for other in listed) == 1, words


def test_the_authors_own_numbers_are_those_of_his_scene(verdicts: list[Verdict]) -> None:
    wrong = {e.id: e.wrong for e in errata(verdicts, PAPER)}
    heavy, light = Link(mass=1, inertia=1), Link(mass=0.01, inertia=0.1)
    for spins, ids in (((10, -10), ("5.26", "5.28", "6.02")), ((10, 10), ("5.28",))):
        for bar in (heavy, light):
            rate = f"{natural_rate(Scene(spins=spins, link=bar)):.3f} rad/s"
            assert all(rate in wrong[i] for i in ids), rate
    for bar in (heavy, light):  # the rate on the exact orbit, over the squared average inclination
        scene = Scene(spins=(10, -10), link=bar)
        a, b = scene.inertias
        turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
        q = np.sqrt(np.cos(turn) ** 2 + (a + b) / (a - b) * np.sin(turn) ** 2).mean()
        small = 0.02
        drop = (1 - exact_orbit(scene, small).frequency / natural_rate(scene)) / (q * small) ** 2
        told = re.search(rf"{natural_rate(scene):.3f} \(1 − (\d\.\d+) θ²\)", wrong["5.27"])
        assert told and abs(float(told[1]) - drop) < 2e-3
    assert "B is 20 kg m²/s" in wrong["5.16"]
    assert f"{0.204**2:.4f} m" in wrong["5.22"]
    lengths = [float(n) for n in re.findall(r"\d\.\d{3}(?= |,)", wrong["5.20"].replace("0.204", ""))]
    assert lengths == [round(np.sqrt(1 + 4 * 0.204**2 + 4 * c * 0.204**4), 3) for c in (0, 1)]


def test_the_sheet_begins_with_what_it_is(verdicts: list[Verdict]) -> None:
    what, counted = sheet_summary(verdicts, list(errata(verdicts, PAPER)))
    assert what.count(". ") == 2
    assert "2.08, is that of the report, not of a section" in what
    assert "20 differ" in counted and "7 of the errors change a result" in counted and "other 13" in counted
    markdown = errata_sheet(Report(PAPER, tuple(verdicts), (), ()))
    places = [markdown.index(text) for text in (what[:40], counted[:30], "| Letter |", "**P1:**", "### Erratum 2.08")]
    assert places == sorted(places)


def test_the_report_says_in_front_which_premises_the_scene_does_not_meet(verdicts: list[Verdict]) -> None:
    text = unmet(Report(PAPER, tuple(verdicts), (), ()))
    holding = [v for v in verdicts if v.verdict.startswith("holds")]
    affected = [v for v in holding if any(p.broken for p in v.premises)]
    assert f"Of the {len(holding)} equations that hold, {len(affected)} need" in text
    for words in re.findall(r"(?:are: |\); )([^;]+) \((\d+) equations\)", text):
        assert sum(any(p.says == words[0] and p.broken for p in v.premises) for v in holding) == int(words[1])
    assert text.count("equations)") == 3
    met = [v for v in verdicts if not any(p.broken for p in v.premises)]
    assert not unmet(Report(PAPER, tuple(met), (), ()))
