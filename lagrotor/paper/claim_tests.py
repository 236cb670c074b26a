"""Tests of the paper's claims: what is said in words is run, measured, and decided by the numbers alone.

A `ClaimTest` separates the run from the decision, so that the same decision can be given the numbers of a case that
contradicts the claim, and must then come out otherwise. Where motion can be enclosed, a part is decided by a theorem instead.
"""

import json
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

from lagrotor.errors import NotProved, ProofError
from lagrotor.paper.catalogue import Claim
from lagrotor.paper.tables import Table
from lagrotor.paper.theorems import Theorem, can_prove, verify

Outcome = Literal["proved", "confirmed", "confirmed-if", "refuted"]


class PrintedNumber(float):
    """A number by its printed digits. It stands for every number that rounds to it: half a unit of its last digit either way."""

    def __init__(self, digits: str) -> None:
        self.digits, self.half_unit = digits, 0.5 / 10 ** len(digits.partition(".")[2])

    def is_matched(self, number: float) -> bool:
        """Return whether a number rounds to it."""
        return abs(number - self) < self.half_unit

    @property
    def rule(self) -> str:
        """The numbers for which it stands, in words."""
        return f"{self.digits} as printed stands for {self - self.half_unit:.8g} to {self + self.half_unit:.8g}"


@dataclass(frozen=True)
class Part:
    """One part of a claim's sentence, in words, and whether the numbers bear it out.

    Attributes
    ----------
    only_if : str, default ''
        Where it does not hold unconditionally, the condition under which it does; empty where there is none.
    theorems : tuple[Theorem, ...], default ()
        Those from which it follows; without any it rests on runs, which are estimates.
    """

    says: str
    holds: bool
    only_if: str = ""
    theorems: tuple[Theorem, ...] = ()

    @property
    def outcome(self) -> str:
        """In words."""
        if self.holds or not self.only_if:
            said = "holds" if self.holds else "does not hold"
            return f"{said}, proved" if self.theorems else said
        return f"holds only if: {self.only_if}{'; it is proved that it does not always hold' if self.theorems else ''}"


@dataclass(frozen=True)
class Finding:
    """What the numbers say of each part of the sentence, and an explanation with the numbers.

    A claim is confirmed where every part holds, proved where each of them follows from theorems, confirmed-if where some hold
    only under a condition, and refuted where one does not hold under any.
    """

    parts: tuple[Part, ...]
    explanation: str

    @property
    def outcome(self) -> Outcome:
        """What follows from the parts."""
        if any(not part.holds and not part.only_if for part in self.parts):
            return "refuted"
        if not all(part.holds for part in self.parts):
            return "confirmed-if"
        return "proved" if self.parts and all(part.theorems for part in self.parts) else "confirmed"

    @property
    def condition(self) -> str | None:
        """The conditions of the parts, each once; None unless the outcome is confirmed-if."""
        needed = dict.fromkeys(part.only_if for part in self.parts if not part.holds)
        return "; ".join(needed) if self.outcome == "confirmed-if" else None

    @property
    def theorems(self) -> tuple[tuple[Part, Theorem], ...]:
        """The parts that follow from theorems, each with each of its theorems."""
        return tuple((part, theorem) for part in self.parts for theorem in part.theorems)

    def decided_by(self, proved: Iterable[Part], where: str) -> "Finding":
        """The finding with parts that follow from theorems in place of those of the same words.

        Raises
        ------
        ProofError
            Where there is no such part, where it has no theorem, or where a run says otherwise.
        """
        parts = {part.says: part for part in self.parts}
        for part in proved:
            if part.says not in parts or not part.theorems:
                wrong = "has no theorem" if part.says in parts else "is not a part of the claim"
                raise ProofError(f"{where}: {part.says!r} {wrong}")
            if part.holds != parts[part.says].holds:
                raise ProofError(
                    f"{where}: {part.says}: the run says that it {parts[part.says].outcome}, and a theorem that it {part.outcome}"
                )
            parts[part.says] = replace(parts[part.says], theorems=part.theorems)
        return replace(self, parts=tuple(parts.values()))


@dataclass(frozen=True)
class ClaimTest:
    """The test of one claim: `measure(case)` runs a case and returns name → number; `decide` makes a finding of them.

    Attributes
    ----------
    case
        What the claim is about, whatever `measure` takes.
    foreign : mapping
        Part of the sentence → a case in which that part comes out otherwise.
    model : str
        What is run.
    prove : callable or None, optional
        Case → those parts that follow from theorems, with them; a part that the runs decide otherwise, and a certificate
        that is rejected, are errors.
    unproved : str, default ''
        Why the other parts rest on runs.
    """

    id: str
    case: Any
    foreign: Mapping[str, Any]
    model: str
    measure: Callable[[Any], Mapping[str, float]]
    decide: Callable[[Mapping[str, float]], Finding]
    prove: Callable[[Any], Iterable[Part]] | None = None
    unproved: str = ""

    def evaluated(self, case: Any) -> "Result":
        """Any case, measured and decided, by theorems where there are any.

        Raises
        ------
        ProofError
            Where a theorem contradicts a run or its certificate is rejected.
        """
        began = time.perf_counter()
        measured = {name: float(value) for name, value in self.measure(case).items()}
        finding = self.decide(measured)
        if self.unproved:
            what = "the rest" if self.prove else "it"
            finding = replace(finding, explanation=f"{finding.explanation} Why {what} is no theorem: {self.unproved}.")
        if self.prove is not None and can_prove():
            parts: list[Part] = []
            try:
                parts += self.prove(case)
            except NotProved as refusal:
                finding = replace(finding, explanation=f"{finding.explanation} Not proved: {refusal}.")
            finding = finding.decided_by(parts, self.id)
            verify({id(theorem): theorem for _, theorem in finding.theorems}.values(), self.id)
        return Result(self, measured, finding, time.perf_counter() - began)

    @cached_property
    def result(self) -> "Result":
        """The claim's own case, evaluated once: it takes the runs, up to seconds."""
        return self.evaluated(self.case)

    def _repr_html_(self) -> str:
        finding = self.result.finding
        rows = tuple((part.says, part.outcome) for part in finding.parts)
        return Table(self.id, ("part of the claim", finding.outcome), rows, finding.explanation)._repr_html_()


@dataclass(frozen=True)
class Result:
    """A claim after its test."""

    test: ClaimTest
    measured: Mapping[str, float]
    finding: Finding
    seconds: float


def claim_data(result: Result, entry: Claim) -> dict[str, Any]:
    """One claim as the JSON object of `lagrotor claims --json`."""
    return {
        "id": entry.id,
        "section": entry.section,
        "text": entry.text,
        "verdict": result.finding.outcome,
        "condition": result.finding.condition,
        "parts": [
            {
                "says": part.says,
                "holds": part.holds,
                "only_if": part.only_if,
                "proved": [{"says": each.says, "encloses": each.encloses} for each in part.theorems],
            }
            for part in result.finding.parts
        ],
        "model": result.test.model,
        "measured": dict(result.measured),
        "explanation": result.finding.explanation,
        "seconds": round(result.seconds, 3),
    }


def claims_json(results: Iterable[Result], claims: Mapping[str, Claim]) -> str:
    """All claims as a JSON list."""
    return json.dumps([claim_data(r, claims[r.test.id]) for r in results], indent=1, ensure_ascii=False)
