"""The audit: derivations are run, what they state is judged, and each verdict is put into words.

`audit()` judges the whole paper, `audit("5.22")` one equation, by running the one script that derives it.
"""

import json
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, overload

from lagrotor.errors import InputError
from lagrotor.pair.symbols import latex
from lagrotor.paper import scripts
from lagrotor.paper.catalogue import equation, equations
from lagrotor.paper.ledger import Relation, Statement, Verdict, judge, verdict_table
from lagrotor.paper.readable import from_latex, readable
from lagrotor.paper.record import reaches_result, recorded

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Audit:
    """The verdicts of an audit in the paper's order, by id: `audit()["5.22"]`."""

    verdicts: tuple[Verdict, ...]

    def __getitem__(self, identifier: str) -> Verdict:
        for verdict in self.verdicts:
            if verdict.id == identifier:
                return verdict
        equation(identifier)
        raise InputError(f"equation {identifier} is not yet judged: no derivation states it")

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __len__(self) -> int:
        return len(self.verdicts)

    def __repr__(self) -> str:
        counted = Counter(verdict.verdict for verdict in self.verdicts)
        return f"<Audit of {len(self)} equations: {', '.join(f'{n} {answer}' for answer, n in counted.most_common())}>"

    def _repr_html_(self) -> str:
        return verdict_table(self.verdicts)._repr_html_()


@overload
def audit(identifier: str, progress: Progress | None = None) -> Verdict: ...
@overload
def audit(identifier: None = None, progress: Progress | None = None) -> Audit: ...
def audit(identifier: str | None = None, progress: Progress | None = None) -> Audit | Verdict:
    """Judge every equation, or one.

    One equation runs its own derivation only; whether its error reaches a result of the paper is then taken from the record
    of the last whole audit. `progress` is called with the name of each script before it runs. Raises InputError for an
    equation that the paper does not have, or that no derivation states.
    """
    if identifier is not None:
        return _one(identifier, progress)
    return Audit(tuple(with_reach(v for stem in scripts.names("derivations", "s") for v in judged(stem, progress))))


def with_reach(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Verdicts in the paper's order, the refuted ones with whether a result of the paper falls with them."""
    found = {verdict.id: verdict for verdict in verdicts}
    answers = {i: v.verdict for i, v in found.items()}
    uses = {i: v.statement.depends_on for i, v in found.items()}
    return [_followed(found[i], answers, uses) for i in equations() if i in found]


def _one(identifier: str, progress: Progress | None) -> Verdict:
    equation(identifier)
    if identifier not in scripts.stating():
        raise InputError(f"equation {identifier} is not yet judged: no derivation states it")
    on_record = recorded()
    if progress:
        progress(scripts.stating()[identifier])
    stated = next(s for s in statements(scripts.stating()[identifier]) if s.id == identifier)
    verdict = judge(stated)
    answers = {i: row.verdict for i, row in on_record.items()} | {identifier: verdict.verdict}
    return _followed(verdict, answers, {i: row.uses for i, row in on_record.items()})


def _followed(verdict: Verdict, answers: dict[str, Any], uses: Mapping[str, Iterable[str]]) -> Verdict:
    """The verdict of a refuted equation with whether a result of the paper falls with it."""
    if verdict.verdict != "refuted":
        return verdict
    return replace(verdict, reaches_result=reaches_result(verdict.id, answers, uses))


def judged(stem: str, progress: Progress | None = None) -> list[Verdict]:
    """The verdicts on what one script states. Seconds include an equal share of its script's."""
    if progress:
        progress(stem)
    began = time.perf_counter()
    stated = statements(stem)
    share = (time.perf_counter() - began) / max(len(stated), 1)
    verdicts = [judge(statement) for statement in stated]
    return [replace(verdict, seconds=verdict.seconds + share) for verdict in verdicts]


def statements(stem: str) -> list[Statement]:
    """What one derivation states of the paper's equations."""
    script = scripts.executed("derivations", stem)
    return script.shown(Statement)


def in_words(verdict: Verdict) -> str:
    """A verdict as a terminal shows it: printed, wrong, right, premises, domain, where it is derived."""
    statement, entry = verdict.statement, equation(verdict.id)
    order = (
        f" through order {verdict.order} in {readable(str(verdict.small))}"
        if verdict.verdict == "holds-to-order"
        else ""
    )
    rows: list[tuple[str, str]] = []
    rows += [("printed", line) for line in _lines(statement.relations)]
    rows += [("wrong", readable(statement.wrong))] if statement.wrong and verdict.verdict == "refuted" else []
    rows += [("right", line) for line in _lines(statement.correction)]
    rows += [("correction", verdict.correction_verdict)] if verdict.correction_verdict else []
    rows += [("if", premise.sentence) for premise in verdict.premises]
    rows += [("domain", f"{readable(str(factor))} ≠ 0") for factor in verdict.domain]
    if verdict.reaches_result is not None:
        reach = (
            "a result of the paper falls with it" if verdict.reaches_result else "no result of the paper depends on it"
        )
        rows.append(("reach", reach))
    rows += [("read", readable(entry.reading))] if entry.reading else []
    rows.append(("derived in", f"derivations/{scripts.stating().get(verdict.id, '?')}.py"))
    head = f"{entry.id}  {readable(entry.title)}: {verdict.verdict}{order}"
    return "\n".join([head, *(f"  {name:<11}{text}" for name, text in rows)])


def _lines(relations: Iterable[Relation]) -> list[str]:
    """quantity = expression for each relation, in plain text."""
    found = []
    for relation in relations:
        rest = f" + O({relation.small}**{relation.claimed + 1})" if relation.small is not None else ""
        found.append(f"{from_latex(relation.quantity)} = {readable(str(relation.printed) + rest)}")
    return list(dict.fromkeys(found))


def _sides(relations: tuple[Relation, ...], side: str) -> str | None:
    lines = ((r.quantity, r.written or latex(getattr(r, side))) for r in relations)
    found = dict.fromkeys((f"{quantity} = " if quantity else "") + line for quantity, line in lines)
    return r" \quad ".join(found) or None


def record(verdict: Verdict) -> dict[str, Any]:
    """One verdict as the JSON object of `lagrotor audit --json`."""
    statement, entry = verdict.statement, equation(verdict.id)
    return {
        "id": entry.id,
        "section": entry.section,
        "title": entry.title,
        "printed": entry.latex,
        "reading": entry.reading,
        "derived": _sides(statement.relations, "derived"),
        "derived_in": f"derivations/{scripts.stating().get(entry.id, '?')}.py",
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


def to_json(verdicts: Iterable[Verdict]) -> str:
    """Verdicts as a JSON list."""
    return json.dumps([record(v) for v in verdicts], indent=1, ensure_ascii=False)
