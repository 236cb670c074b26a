"""Run the derivations and judge what they state: one verdict for each equation, in the paper's order."""

import json
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from lagrotor.pair.symbols import latex
from lagrotor.paper import scripts
from lagrotor.paper.catalogue import equation, equations
from lagrotor.paper.ledger import Relation, Statement, Verdict, follow_errors, judge
from lagrotor.paper.notebook import Remark

Progress = Callable[[str], None]


def statements(stem: str) -> list[Statement]:
    """What one derivation script hands to the ledger."""
    script = scripts.executed("derivations", stem)
    return [*script.names.get("statements", ()), *script.shown(Statement)]


def findings(prefix: str) -> list[tuple[str, str]]:
    """(title, sentence) of what the derivations with this prefix found beyond the judged equations."""
    found = []
    for stem in scripts.names("derivations", prefix):
        script = scripts.executed("derivations", stem)
        found += script.names.get("findings", [])
        found += [(remark.title, remark.text) for remark in script.shown(Remark)]
    return found


def audit(progress: Progress | None = None) -> list[Verdict]:
    """Every equation that a derivation states, judged: verdicts in the paper's order.

    `progress` is called with the name of each script before it runs. Seconds include an equal share of its script's.
    """
    verdicts: dict[str, Verdict] = {}
    for stem in scripts.names("derivations", "s"):
        if progress:
            progress(stem)
        began = time.perf_counter()
        stated = statements(stem)
        share = (time.perf_counter() - began) / max(len(stated), 1)
        for statement in stated:
            verdict = judge(statement)
            verdicts[statement.id] = replace(verdict, seconds=verdict.seconds + share)
    ordered = [verdicts[i] for i in equations() if i in verdicts]
    return follow_errors(ordered)


def _sides(relations: tuple[Relation, ...], side: str) -> str | None:
    found = list(dict.fromkeys(latex(getattr(r, side)) for r in relations))
    return r" \quad ".join(found) or None


def record(verdict: Verdict) -> dict[str, Any]:
    """One verdict as the JSON object of `lagrotor audit --json`."""
    statement, entry = verdict.statement, equation(verdict.id)
    return {
        "id": entry.id,
        "section": entry.section,
        "title": entry.title,
        "printed": entry.latex,
        "derived": _sides(statement.relations, "derived"),
        "verdict": verdict.verdict,
        "premises": [premise.sentence for premise in verdict.premises],
        "order": verdict.order,
        "small": latex(verdict.small) if verdict.small else None,
        "domain": [latex(factor) + r" \neq 0" for factor in verdict.domain],
        "correction": _sides(statement.correction, "printed"),
        "correction_verdict": verdict.correction_verdict,
        "depends_on": list(statement.depends_on),
        "reaches_result": verdict.reaches_result,
        "evidence": list(verdict.evidence),
        "seconds": round(verdict.seconds, 4),
    }


def to_json(verdicts: list[Verdict]) -> str:
    """All verdicts as a JSON list."""
    return json.dumps([record(v) for v in verdicts], indent=1, ensure_ascii=False)
