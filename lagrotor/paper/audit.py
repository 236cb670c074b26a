"""The result of an audit: the verdicts of a paper in its order, as text for a terminal and as JSON."""

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.catalogue import Equation
from lagrotor.paper.plain_text import from_latex, readable
from lagrotor.paper.premises import Premise, relation_text
from lagrotor.paper.tables import Table
from lagrotor.paper.verdicts import LineVerdict, Relation, Verdict, point_text, verdict_table

NOT_YET = "not-yet-judged"


@dataclass(frozen=True)
class Audit:
    """The verdicts of an audit in the paper's order; `audit["5.22"]` is the verdict on one equation.

    Attributes
    ----------
    verdicts : tuple[Verdict, ...]
        One verdict for each equation that a derivation states.
    waiting : tuple[str, ...], default ()
        Ids of the equations that no derivation states.

    Examples
    --------
    >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
    >>> audit = Audit((PAPER.audit("2.01"), PAPER.audit("4.01")))
    >>> audit["4.01"].verdict, audit.counts
    ('holds', {'holds-if': 1, 'holds': 1})
    """

    verdicts: tuple[Verdict, ...]
    waiting: tuple[str, ...] = ()

    def __getitem__(self, identifier: str) -> Verdict:
        for verdict in self.verdicts:
            if verdict.id == identifier:
                return verdict
        if identifier in self.waiting:
            raise InputError(f"equation {identifier} is not yet judged: state it in a derivation by `verdict`")
        raise InputError(f"equation {identifier!r} is not in the paper: its equations are {', '.join(self.ids)}")

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __len__(self) -> int:
        return len(self.verdicts)

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of the equations: first those that are judged, then those that are waiting."""
        return (*(verdict.id for verdict in self.verdicts), *self.waiting)

    @property
    def counts(self) -> dict[str, int]:
        """The number of equations with each verdict. The most frequent verdict is first, `not-yet-judged` last."""
        counts = dict(Counter[str](verdict.verdict for verdict in self.verdicts).most_common())
        return counts | ({NOT_YET: len(self.waiting)} if self.waiting else {})

    def __repr__(self) -> str:
        return (
            f"<Audit of {len(self.ids)} equations: {', '.join(f'{n} {answer}' for answer, n in self.counts.items())}>"
        )

    def _repr_html_(self) -> str:
        table = verdict_table(self.verdicts)
        rows = tuple((identifier, NOT_YET, "") for identifier in self.waiting)
        return Table(table.title, table.head, (*table.rows, *rows))._repr_html_()


_LONGEST = 120  # characters; a longer difference is replaced by the reason


def in_words(verdict: Verdict, paper: Any) -> str:
    """Return a verdict as text for a terminal: print, error, correction, premises, domain and derivation."""
    statement, entry = verdict.statement, paper.equation(verdict.id)
    order = (
        f" through order {verdict.order} in {readable(str(verdict.small))}"
        if verdict.verdict == "holds-to-order"
        else ""
    )
    rows: list[tuple[str, str]] = []
    rows += [("printed", line) for line in _printed(entry)]
    rows += [("wrong", readable(statement.wrong))] if statement.wrong and verdict.verdict == "refuted" else []
    wrong = [line for line in verdict.lines if line.verdict in ("refuted", "undecided")]
    rows += [("line", ": ".join(filter(None, (line_text(line), point_text(line))))) for line in wrong]
    rows += [("stated if", readable(premise.with_formula)) for premise in verdict.refuted_under]
    rows += [("right", line) for line in _lines(statement.correction)]
    rows += [("derived", line) for line in _lines(uncorrected(verdict), "derived")]
    rows += [("letters", _undefined_symbol_text(name)) for name in _not_derived(uncorrected(verdict))]
    rows += [("correction", verdict.correction_verdict)] if verdict.correction_verdict else []
    needed = "right if" if verdict.verdict == "refuted" else "if"
    rows += [(needed, readable(premise.with_formula)) for premise in verdict.premises]
    rows += [("domain", relation_text(relation)) for relation in verdict.domain]
    rows += [("dimensions", text) for text in dimension_texts(verdict)]
    rows += [("proved", theorem.text) for theorem in verdict.theorems]
    rows += [("evidence", line) for line in verdict.evidence if verdict.verdict in ("measured", "undecided")]
    if verdict.reaches_result is not None:
        reach = (
            "a result of the paper depends on it" if verdict.reaches_result else "no result of the paper depends on it"
        )
        rows.append(("reach", reach))
    rows += [("read", readable(entry.reading))] if entry.reading else []
    rows.append(("derived in", _derivation(paper, verdict.id) or "?"))
    head = f"{entry.id}  {readable(entry.title)}: {verdict.verdict}{order}"
    return "\n".join([head, *(f"  {name:<11}{text}" for name, text in rows)])


def _derivation(paper: Any, identifier: str) -> str | None:
    place = paper.scripts.stating.get(identifier)
    return f"derivations/{place[0]}.py" if place else None


def _not_derived(relations: Iterable[Relation]) -> list[str]:
    """Return the names of symbols that a printed side contains and the derived side lacks."""

    def names(side: Any) -> set[str]:
        return {str(s) for s in getattr(side, "expression", side).free_symbols}

    return sorted({name for r in relations for name in names(r.printed) - names(r.derived)})


def _undefined_symbol_text(name: str) -> str:
    return f'{readable(name)} is printed, but not derived: if the paper defines it, write letters = {{ {name} = "…" }}'


def _printed(entry: Equation) -> list[str]:
    """Return the printed lines of an equation in plain text, each as quantity = member = …."""
    return [" = ".join([from_latex(row["quantity"]), *map(readable, row.get("members", ()))]) for row in entry.line]


def line_text(line: LineVerdict) -> str:
    """Return the verdict on one member of a line in plain text, with the difference of the sides or the reason."""
    text = f"{from_latex(line.relation.quantity)}: {line.verdict}".removeprefix(": ")
    difference = "" if line.difference is None or line.reason else readable(str(line.difference))
    reason = f"the sides differ by {difference}" if 0 < len(difference) <= _LONGEST else line.reason
    return f"{text}: {reason}" if reason else text


def dimension_texts(verdict: Verdict) -> tuple[str, ...]:
    """Return the dimensional analysis in sentences: one for all consistent lines together, and one for each other line."""
    alike, apart = dict[str, None](), dict[str, None]()
    for line in verdict.lines:
        dimensions, quantity = line.dimensions, from_latex(line.relation.quantity)
        if dimensions and dimensions.answer == "consistent":
            alike[dimensions.says] = None
        elif dimensions:
            apart[f"{quantity}: {dimensions.answer}: {dimensions.says}"] = None
    return (*([f"the dimensions of both sides are equal: {'; '.join(alike)}"] if alike else []), *apart)


def uncorrected(verdict: Verdict) -> list[Relation]:
    """Return the refuted relations for which no correction is given; the report shows their derived sides instead."""
    right = {relation.quantity for relation in verdict.statement.correction}
    refuted = (line.relation for line in verdict.lines if line.verdict == "refuted")
    return [relation for relation in refuted if relation.quantity not in right]


def _lines(relations: Iterable[Relation], side: str = "printed") -> list[str]:
    """Return the lines `quantity = expression` of the printed or the derived side of relations, each line once."""
    lines = []
    for relation in relations:
        small, order = relation.known or (relation.small, relation.claimed)
        order_term = f" + O({small}**{order + 1})" if small is not None else ""
        right = (
            from_latex(relation.written) if relation.written else readable(str(getattr(relation, side)) + order_term)
        )
        lines.append(f"{from_latex(relation.quantity)} = {right}")
    return list(dict.fromkeys(lines))


def _sides(relations: tuple[Relation, ...], side: str) -> str | None:
    lines = ((r.quantity, r.written or latex(getattr(r, side))) for r in relations)
    sides = dict.fromkeys((f"{quantity} = " if quantity else "") + line for quantity, line in lines)
    return r" \quad ".join(sides) or None


def verdict_data(verdict: Verdict, paper: Any) -> dict[str, Any]:
    """Return one verdict as the JSON object that `lagrotor audit --json` prints."""
    statement, entry = verdict.statement, paper.equation(verdict.id)
    return {
        "id": entry.id,
        "section": entry.section,
        "title": entry.title,
        "printed": entry.latex,
        "reading": entry.reading,
        "derived": _sides(statement.relations, "derived"),
        "derived_in": _derivation(paper, entry.id),
        "verdict": verdict.verdict,
        "premises": [premise_data(premise) for premise in verdict.premises],
        "refuted_under": [premise_data(premise) for premise in verdict.refuted_under],
        "lines": [line_data(line) for line in verdict.lines],
        "order": verdict.order,
        "small": latex(verdict.small) if verdict.small else None,
        "domain": [latex(relation) for relation in verdict.domain],
        "wrong": statement.wrong,
        "correction": _sides(statement.correction, "printed"),
        "correction_verdict": verdict.correction_verdict,
        "correction_lines": [line_data(line) for line in verdict.correction_lines],
        "depends_on": list(statement.depends_on),
        "reaches_result": verdict.reaches_result,
        "proved": [{"says": theorem.says, "encloses": theorem.encloses} for theorem in verdict.theorems],
        "evidence": list(verdict.evidence),
        "seconds": round(verdict.seconds, 4),
    }


def premise_data(premise: Premise) -> dict[str, Any]:
    """Return a premise as a JSON object."""
    relations = [f"{lhs} = {rhs}" for lhs, rhs in premise.equations] + [str(r) for r in premise.conditions]
    return {
        "says": premise.says,
        "put": relations,
        "small": str(premise.small) if premise.small else None,
        "broken": premise.broken,
    }


def line_data(line: LineVerdict) -> dict[str, Any]:
    """Return the verdict on one member as a JSON object. Its `witness` gives each symbol an exact value or two bounds."""
    ends = line.enclosure
    return {
        "quantity": line.relation.quantity,
        "printed": str(line.relation.printed),
        "verdict": line.verdict,
        "premises": [premise.says for premise in line.premises],
        "order": line.order,
        "small": str(line.small) if line.small else None,
        "domain": [f"{r.lhs} {r.rel_op} {r.rhs}" for r in line.domain],
        "difference": None if line.difference is None else str(line.difference),
        "entry": line.place,
        "witness": None if line.witness is None else {str(s): _exact(value) for s, value in line.witness.items()},
        "enclosure": None if ends is None else [float(end) for end in ends],
        "reason": line.reason,
        "dimensions": None if line.dimensions is None else asdict(line.dimensions),
    }


def _exact(value: Any) -> Any:
    return [str(end) for end in value] if isinstance(value, tuple) else str(value)


def waiting(entry: Equation) -> dict[str, Any]:
    """Return the JSON object of an equation that is not yet judged."""
    printed = {"id": entry.id, "section": entry.section, "title": entry.title, "printed": entry.latex}
    return {**printed, "verdict": NOT_YET}


def verdicts_json(verdicts: Iterable[Verdict], paper: Any, not_yet: Iterable[str] = ()) -> str:
    """Return the text of a JSON list: first the verdicts, then the equations that are not yet judged."""
    rows = [verdict_data(verdict, paper) for verdict in verdicts] + [waiting(paper.equation(i)) for i in not_yet]
    return json.dumps(rows, indent=1, ensure_ascii=False)
