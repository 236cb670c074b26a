"""The verdict `proved`: theorems decide parts of claims and printed numbers; what is rejected, contradicted or not proved."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from lagrotor.errors import InputError, ProofError
from lagrotor.mechanics import System, coordinates
from lagrotor.paper import ClaimTest, Finding, Paper, Part, Theorem, equation_statements, papers, verdict
from lagrotor.paper import claim_tests as tests_of_claims
from lagrotor.paper.audit import in_words, verdict_data
from lagrotor.paper.ledger import decide
from lagrotor.paper.record import changes, record_text, recorded, row_of
from lagrotor.paper.scripts import beside
from lagrotor.paper.verdicts import Relation, Statement
from lagrotor.proofs import NotProved, enclose

RATE = "the rate is 1.00"
C = coordinates("x")


@cache
def swing() -> Theorem:
    """x″ = −x from x = 1 at rest: cos 1 is enclosed."""

    proved = enclose(System(C, (C.v[0] ** 2 - C.q[0] ** 2) / 2), {}, [1], [0], 1)
    return Theorem.of(proved, "x = 0.5403…", "x")


def claim(*proved: Part, off: float = 0.0, refusal: str = "") -> ClaimTest:
    """A claim of two parts, of which some follow from theorems."""

    def measured_parts(measured: Any) -> Finding:
        return Finding((Part(RATE, measured["off"] < 1), Part("it goes on", True)), "As measured.")

    def prove(case: Any) -> Iterator[Part]:
        yield from proved
        if refusal:
            raise NotProved(refusal)

    return ClaimTest("C01", None, {}, "a model", lambda case: {"off": off}, measured_parts, prove)


def test_a_claim_is_proved_where_each_part_follows_from_a_theorem() -> None:
    both = claim(Part(RATE, True, theorems=(swing(),)), Part("it goes on", True, theorems=(swing(),))).result.finding
    assert (both.outcome, [p.outcome for p in both.parts]) == ("proved", ["holds, proved", "holds, proved"])
    one = claim(Part(RATE, True, theorems=(swing(),))).result.finding
    assert (one.outcome, [p.outcome for p in one.parts]) == ("confirmed", ["holds, proved", "holds"])


def mutated(theorem: Theorem) -> Theorem:
    """Its claim moved by 1e-6."""
    document = json.loads(json.dumps(theorem.certificate))
    document["claim"]["t"] = ["100001p-20", "0p0"]
    return replace(theorem, certificate=document)


@pytest.mark.parametrize(
    ("part", "says"),
    [
        (
            lambda: Part(RATE, False, theorems=(swing(),)),
            "by the simulation it holds, by a theorem it does not hold",
        ),
        (lambda: Part(RATE, True), "has no theorem"),
        (lambda: Part("another", True, theorems=(swing(),)), "is not a part of the claim"),
        (lambda: Part(RATE, True, theorems=(mutated(swing()),)), "the certificate of a theorem is rejected"),
        (lambda: Part(RATE, True, theorems=(replace(swing(), says="All is well."),)), "proves another theorem"),
        (lambda: Part(RATE, True, theorems=(Theorem("All is well."),)), "has no certificate"),
        (lambda: Part(RATE, True, theorems=(replace(swing(), certificate={"kind": "x"}),)), "is rejected"),
        (lambda: Part(RATE, True, theorems=(replace(swing(), certificate={"a": sp.S.One}),)), "is rejected"),
    ],
)
def test_a_theorem_that_does_not_bear_a_part_out_is_an_error(part: Any, says: str) -> None:
    with pytest.raises(ProofError, match=says):
        _ = claim(part()).result


def test_without_flint_what_is_on_record_stands_and_is_said_to(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(beside("papers") / "pendulum", tmp_path / "mine"))
    script = folder / "derivations" / "c1_period.py"
    test = claim(Part(RATE, True, theorems=(swing(),)), Part("it goes on", True, theorems=(swing(),)))
    paper = Paper(folder)
    monkeypatch.setitem(vars(paper), "claim_tests", {"C01": test})
    row = row_of(test.result, {})
    (folder / "recorded.toml").write_text(record_text({"C01": row}), encoding="utf-8")
    assert recorded(folder / "recorded.toml")["C01"] == row
    for module in (tests_of_claims, papers):
        monkeypatch.setattr(module, "can_prove", lambda: False)
    again = replace(test)
    monkeypatch.setitem(vars(paper), "claim_tests", {"C01": again})
    found = paper.measured("C01")
    assert again.result.finding.outcome == "confirmed" and found.finding.outcome == "proved"
    assert changes({"C01": row_of(found, {})}, {"C01": row}, ["C01"]) == []
    assert all("not proved again here" in theorem.text for _, theorem in found.finding.theorems)
    # A run that contradicts what is on record is a change all the same.
    monkeypatch.setitem(vars(paper), "claim_tests", {"C01": claim(off=2)})
    assert changes({"C01": row_of(paper.measured("C01"), {})}, {"C01": row}, ["C01"])
    assert script.is_file()


@pytest.mark.parametrize(
    ("printed", "within", "answer"),
    [
        ("0.54", "0.01", "proved"),
        ("0.5403", "0.0001", "proved"),
        ("0.55", "0.01", "refuted"),
        ("-0.54", "0.01", "refuted"),
        ("0.540302305868", "1e-20", "refuted"),
    ],
)
def test_a_printed_number_is_held_against_the_bounds_of_a_theorem(printed: str, within: str, answer: str) -> None:
    relation = Relation(sp.Rational(printed), sp.Integer(7), within=sp.Rational(within), theorem=swing())
    found = decide(Statement("", (relation,), measured=True))
    assert found.verdict == answer, found
    if answer == "refuted":
        assert "a theorem encloses it between 0.5403" in found.lines[0].reason


def test_the_bounds_of_a_number_are_the_certificate_s() -> None:
    low, high = swing().bounds or (0, 0)
    assert low < sp.cos(1) < high and high - low < sp.Rational(1, 10**15)
    document = json.loads(json.dumps(swing().certificate))
    document["claim"]["states"][0][1] = "1p-10"
    wide = replace(swing(), certificate=document)
    assert wide.bounds and wide.bounds[1] - wide.bounds[0] > sp.Rational(1, 1000)
    relation = Relation(sp.Rational("0.5403"), sp.Integer(7), within=sp.Rational("0.0001"), theorem=wide)
    assert decide(Statement("", (relation,), measured=True)).verdict == "undecided"
    with pytest.raises(InputError, match="it has no quantity 'frequency'; it has x, x_dot"):
        Theorem.of(enclose(System(C, (C.v[0] ** 2 - C.q[0] ** 2) / 2), {}, [1], [0], 1), "", "frequency")


def number(folder: Path, line: str, prove: str) -> Paper:
    """The pendulum's paper, which prints a number that a theorem encloses."""
    with (folder / "equations.toml").open("a", encoding="utf-8") as file:
        file.write(
            '\n[[equation]]\nid = "1.2"\nsection = "1"\ntitle = "a number"\nlatex = "x = 0.54"\nmeasured = true\n'
            f"[[equation.line]]\nquantity = 'x'\n{line}\n"
        )
    (folder / "derivations" / "s2_number.py").write_text(
        "# %%\nfrom tests.paper.test_theorems import swing\nfrom lagrotor.errors import NotProved\n"
        "from lagrotor.paper import verdict, Theorem\nimport sympy as sp\n\n"
        f"def refuse():\n    raise NotProved('it came to t = 0.5')\n\nverdict('1.2', sp.Rational('0.5403'), prove={prove})\n",
        encoding="utf-8",
    )
    return Paper(folder)


READ_OFF = 'members = ["0.54"]\nread_off = "0.54"'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(beside("papers") / "pendulum", tmp_path / "mine"))


def test_an_equation_is_proved_recorded_and_stands_without_flint(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paper = number(folder, READ_OFF, "swing")
    found = paper.audit("1.2")
    assert found.verdict == "proved" and found.theorems == (swing(),)
    assert "proved" in in_words(found, paper) and verdict_data(found, paper)["proved"][0]["says"] == swing().says
    paper.renew_record([found])
    for module in (equation_statements, papers):
        monkeypatch.setattr(module, "can_prove", lambda: False)
    again = Paper(folder)
    standing = again.audit("1.2")
    assert standing.verdict == "proved" and "not proved again here" in in_words(standing, again)
    assert again.changes([standing], ["1.2"]) == []
    # Without a record it is only measured.
    (folder / "recorded.toml").unlink()
    assert Paper(folder).audit("1.2").verdict == "measured"


def test_a_number_that_is_not_proved_is_measured_and_says_so(folder: Path) -> None:
    found = number(folder, READ_OFF, "refuse").audit("1.2")
    assert found.verdict == "measured" and "The proof failed: it came to t = 0.5" in found.evidence


def test_theorems_of_equations_are_refused_in_words(folder: Path) -> None:
    with pytest.raises(InputError, match="no number that is read off"):
        number(folder, 'members = ["0.54"]', "swing").audit("1.2")
    assert verdict("1.2", sp.S.One, prove=swing).prove is swing
