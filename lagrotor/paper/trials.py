"""Claims on trial: what the paper says in words, run, measured, and decided by the numbers alone.

A `Trial` separates the run from the decision, so that the same decision can be given the numbers of a scene that the
claim is not about, and must then come out otherwise.
"""

import json
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from lagrotor.paper import scripts
from lagrotor.paper.catalogue import claims

Outcome = Literal["confirmed", "confirmed-if", "refuted"]
Spins = tuple[float, float]


@dataclass(frozen=True)
class Finding:
    """What the numbers say: the outcome, the condition under which a claim is confirmed, one plain sentence."""

    outcome: Outcome
    explanation: str
    condition: str | None = None


@dataclass(frozen=True)
class Trial:
    """One claim: `measure(spins)` runs the scene and returns name → number; `decide` turns the numbers into a finding.

    spins: of the scene that the claim is about (rad/s); foreign: spins of a scene it is not about. model: what is run.
    """

    id: str
    spins: Spins
    foreign: Spins
    model: str
    measure: Callable[[Spins], Mapping[str, float]]
    decide: Callable[[Mapping[str, float]], Finding]


@dataclass(frozen=True)
class Result:
    """A claim after its trial."""

    trial: Trial
    measured: Mapping[str, float]
    finding: Finding
    seconds: float


@cache
def hear(trial: Trial) -> Result:
    """Run one trial, once in a process, and decide it."""
    began = time.perf_counter()
    measured = {name: float(value) for name, value in trial.measure(trial.spins).items()}
    return Result(trial, measured, trial.decide(measured), time.perf_counter() - began)


def listed() -> dict[str, Trial]:
    """Every trial that a script holds, by claim, in the paper's order."""
    found: dict[str, Trial] = {}
    for stem in scripts.names("derivations", "c"):
        found |= {trial.id: trial for trial in scripts.run("derivations", stem)["trials"]}
    return {identifier: found[identifier] for identifier in claims() if identifier in found}


def hear_all(progress: Callable[[str], None] | None = None, wanted: Collection[str] | None = None) -> list[Result]:
    """Every claim (or the wanted ones) in the paper's order; `progress` is told each claim's id before its run."""
    results = []
    for identifier, trial in listed().items():
        if wanted is None or identifier in wanted:
            if progress:
                progress(f"claim {identifier}")
            results.append(hear(trial))
    return results


def record(result: Result) -> dict[str, Any]:
    """One claim as the JSON object of `lagrotor claims --json`."""
    entry = claims()[result.trial.id]
    return {
        "id": entry.id,
        "section": entry.section,
        "text": entry.text,
        "verdict": result.finding.outcome,
        "condition": result.finding.condition,
        "model": result.trial.model,
        "measured": dict(result.measured),
        "explanation": result.finding.explanation,
        "seconds": round(result.seconds, 3),
    }


def to_json(results: list[Result]) -> str:
    """All claims as a JSON list."""
    return json.dumps([record(r) for r in results], indent=1, ensure_ascii=False)
