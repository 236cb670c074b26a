"""Tests of the paper's claims: what is said in words is run, measured, and decided by the numbers alone.

A `ClaimTest` separates the run from the decision, so that the same decision can be given the numbers of a case that
contradicts the claim, and must then come out otherwise.
"""

import json
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from lagrotor.paper import scripts
from lagrotor.paper.catalogue import claims
from lagrotor.paper.tables import Table

Outcome = Literal["confirmed", "confirmed-if", "refuted"]


@dataclass(frozen=True)
class Finding:
    """What the numbers say: the outcome, the condition under which a claim is confirmed, one plain sentence."""

    outcome: Outcome
    explanation: str
    condition: str | None = None


@dataclass(frozen=True)
class ClaimTest:
    """The test of one claim: `measure(case)` runs a case and returns name → number; `decide` makes a finding of them.

    case: what the claim is about, whatever `measure` takes; foreign: a case that contradicts it. model: what is run.
    """

    id: str
    case: Any
    foreign: Any
    model: str
    measure: Callable[[Any], Mapping[str, float]]
    decide: Callable[[Mapping[str, float]], Finding]

    @cached_property
    def result(self) -> "Result":
        """The claim evaluated, once: it takes the runs, up to seconds."""
        began = time.perf_counter()
        measured = {name: float(value) for name, value in self.measure(self.case).items()}
        return Result(self, measured, self.decide(measured), time.perf_counter() - began)

    def _repr_html_(self) -> str:
        finding = self.result.finding
        outcome = tuple(filter(None, (finding.outcome, finding.condition)))
        row = (f"{self.id}: {claims()[self.id].text}", outcome, finding.explanation)
        return Table("Claim", ("claim", "outcome", "why"), (row,))._repr_html_()


@dataclass(frozen=True)
class Result:
    """A claim after its test."""

    test: ClaimTest
    measured: Mapping[str, float]
    finding: Finding
    seconds: float


def claim_tests() -> dict[str, ClaimTest]:
    """Every test that a script shows, by claim, in the paper's order. Nothing is run."""
    found: dict[str, ClaimTest] = {}
    for stem in scripts.names("derivations", "c"):
        found |= {test.id: test for test in scripts.executed("derivations", stem).shown(ClaimTest)}
    return {identifier: found[identifier] for identifier in claims() if identifier in found}


def evaluate(progress: Callable[[str], None] | None = None, wanted: Collection[str] | None = None) -> list[Result]:
    """Every claim (or the wanted ones) in the paper's order; `progress` gets each claim's id before its run."""
    results = []
    for identifier, test in claim_tests().items():
        if wanted is None or identifier in wanted:
            if progress:
                progress(f"claim {identifier}")
            results.append(test.result)
    return results


def record(result: Result) -> dict[str, Any]:
    """One claim as the JSON object of `lagrotor claims --json`."""
    entry = claims()[result.test.id]
    return {
        "id": entry.id,
        "section": entry.section,
        "text": entry.text,
        "verdict": result.finding.outcome,
        "condition": result.finding.condition,
        "model": result.test.model,
        "measured": dict(result.measured),
        "explanation": result.finding.explanation,
        "seconds": round(result.seconds, 3),
    }


def to_json(results: list[Result]) -> str:
    """All claims as a JSON list."""
    return json.dumps([record(r) for r in results], indent=1, ensure_ascii=False)
