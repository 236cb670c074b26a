"""Tests of the paper's claims: what is said in words is run, measured, and decided by the numbers alone.

A `ClaimTest` separates the run from the decision, so that the same decision can be given the numbers of a case that
contradicts the claim, and must then come out otherwise.
"""

import json
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal

from lagrotor.paper.catalogue import Claim
from lagrotor.paper.tables import Table

Outcome = Literal["confirmed", "confirmed-if", "refuted"]


@dataclass(frozen=True)
class Part:
    """One part of a claim's sentence, in words, and whether the numbers bear it out.

    only_if: where it does not hold unconditionally, the condition under which it does; empty where there is none.
    """

    says: str
    holds: bool
    only_if: str = ""

    @property
    def outcome(self) -> str:
        """In words."""
        if self.holds:
            return "holds"
        return f"holds only if: {self.only_if}" if self.only_if else "does not hold"


@dataclass(frozen=True)
class Finding:
    """What the numbers say of each part of the sentence, and an explanation with the numbers.

    A claim is confirmed where every part holds, confirmed-if where some hold only under a condition, and refuted where one
    does not hold under any.
    """

    parts: tuple[Part, ...]
    explanation: str

    @property
    def outcome(self) -> Outcome:
        """What follows from the parts."""
        if any(not part.holds and not part.only_if for part in self.parts):
            return "refuted"
        return "confirmed" if all(part.holds for part in self.parts) else "confirmed-if"

    @property
    def condition(self) -> str | None:
        """The conditions of the parts, each once; None unless the outcome is confirmed-if."""
        needed = dict.fromkeys(part.only_if for part in self.parts if not part.holds)
        return "; ".join(needed) if self.outcome == "confirmed-if" else None


@dataclass(frozen=True)
class ClaimTest:
    """The test of one claim: `measure(case)` runs a case and returns name → number; `decide` makes a finding of them.

    case: what the claim is about, whatever `measure` takes. foreign: part of the sentence → a case in which that part comes
    out otherwise. model: what is run.
    """

    id: str
    case: Any
    foreign: Mapping[str, Any]
    model: str
    measure: Callable[[Any], Mapping[str, float]]
    decide: Callable[[Mapping[str, float]], Finding]

    def evaluated(self, case: Any) -> "Result":
        """Any case, measured and decided."""
        began = time.perf_counter()
        measured = {name: float(value) for name, value in self.measure(case).items()}
        return Result(self, measured, self.decide(measured), time.perf_counter() - began)

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
        "parts": [asdict(part) for part in result.finding.parts],
        "model": result.test.model,
        "measured": dict(result.measured),
        "explanation": result.finding.explanation,
        "seconds": round(result.seconds, 3),
    }


def claims_json(results: Iterable[Result], claims: Mapping[str, Claim]) -> str:
    """All claims as a JSON list."""
    return json.dumps([claim_data(r, claims[r.test.id]) for r in results], indent=1, ensure_ascii=False)
