"""A verdict in words for a terminal, and as data for machines."""

import json
from collections.abc import Iterable
from typing import Any

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.audit import NOT_YET
from lagrotor.paper.catalogue import Equation
from lagrotor.paper.papers import Paper
from lagrotor.paper.readable import from_latex, readable
from lagrotor.paper.verdicts import Relation, Verdict


def in_words(verdict: Verdict, paper: Paper) -> str:
    """A verdict as a terminal shows it: printed, wrong, right, premises, domain, where it is derived."""
    statement, entry = verdict.statement, paper.equation(verdict.id)
    order = (
        f" through order {verdict.order} in {readable(str(verdict.small))}"
        if verdict.verdict == "holds-to-order"
        else ""
    )
    rows: list[tuple[str, str]] = []
    rows += [("printed", line) for line in _printed(entry)]
    rows += [("wrong", readable(statement.wrong))] if statement.wrong and verdict.verdict == "refuted" else []
    rows += [("right", line) for line in _lines(statement.correction)]
    rows += [("correction", verdict.correction_verdict)] if verdict.correction_verdict else []
    rows += [("if", readable(premise.sentence)) for premise in verdict.premises]
    rows += [("domain", f"{readable(str(factor))} ≠ 0") for factor in verdict.domain]
    if verdict.reaches_result is not None:
        reach = (
            "a result of the paper falls with it" if verdict.reaches_result else "no result of the paper depends on it"
        )
        rows.append(("reach", reach))
    rows += [("read", readable(entry.reading))] if entry.reading else []
    rows.append(("derived in", paper.derived_in(verdict.id) or "?"))
    head = f"{entry.id}  {readable(entry.title)}: {verdict.verdict}{order}"
    return "\n".join([head, *(f"  {name:<11}{text}" for name, text in rows)])


def _printed(entry: Equation) -> list[str]:
    """The lines of the catalogue, quantity = member = …, in plain text."""
    return [" = ".join([from_latex(row["quantity"]), *map(readable, row.get("members", ()))]) for row in entry.line]


def _lines(relations: Iterable[Relation]) -> list[str]:
    """quantity = expression for each relation, in plain text."""
    found = []
    for relation in relations:
        rest = f" + O({relation.small}**{relation.claimed + 1})" if relation.small is not None else ""
        right = from_latex(relation.written) if relation.written else readable(str(relation.printed) + rest)
        found.append(f"{from_latex(relation.quantity)} = {right}")
    return list(dict.fromkeys(found))


def _sides(relations: tuple[Relation, ...], side: str) -> str | None:
    lines = ((r.quantity, r.written or latex(getattr(r, side))) for r in relations)
    found = dict.fromkeys((f"{quantity} = " if quantity else "") + line for quantity, line in lines)
    return r" \quad ".join(found) or None


def as_data(verdict: Verdict, paper: Paper) -> dict[str, Any]:
    """One verdict as the JSON object of `lagrotor audit --json`."""
    statement, entry = verdict.statement, paper.equation(verdict.id)
    return {
        "id": entry.id,
        "section": entry.section,
        "title": entry.title,
        "printed": entry.latex,
        "reading": entry.reading,
        "derived": _sides(statement.relations, "derived"),
        "derived_in": paper.derived_in(entry.id),
        "verdict": verdict.verdict,
        "premises": [premise.sentence for premise in verdict.premises],
        "order": verdict.order,
        "small": latex(verdict.small) if verdict.small else None,
        "domain": [latex(factor) + r" \neq 0" for factor in verdict.domain],
        "wrong": statement.wrong,
        "correction": _sides(statement.correction, "printed"),
        "correction_verdict": verdict.correction_verdict,
        "depends_on": list(statement.depends_on),
        "reaches_result": verdict.reaches_result,
        "evidence": list(verdict.evidence),
        "seconds": round(verdict.seconds, 4),
    }


def waiting(entry: Equation) -> dict[str, Any]:
    """An equation that is not yet judged as an object of the same JSON."""
    printed = {"id": entry.id, "section": entry.section, "title": entry.title, "printed": entry.latex}
    return {**printed, "verdict": NOT_YET}


def to_json(verdicts: Iterable[Verdict], paper: Paper, not_yet: Iterable[str] = ()) -> str:
    """Verdicts as a JSON list, then the equations that are not yet judged."""
    rows = [as_data(verdict, paper) for verdict in verdicts] + [waiting(paper.equation(i)) for i in not_yet]
    return json.dumps(rows, indent=1, ensure_ascii=False)
