"""The record of verdicts, `recorded.toml`. Each equation and each claim has one block, and each list has one line per item.

The blocks are sorted by id, so that authors who judge different equations change different places of the file.
"""

import hashlib
import json
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from lagrotor.errors import LagrotorError
from lagrotor.paper.catalogue import Equation
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.scripts import by_numbers
from lagrotor.paper.theorems import Theorem
from lagrotor.paper.verdicts import LineVerdict, Verdict


@dataclass(frozen=True)
class OnRecord:
    """The record of an equation or of a claim; None stands for an item that the record does not have.

    `printed` is a hash of the print, `uses` the ids of the equations that this one uses. `lines` and `correction` give verdict,
    order and premises of each member. `dimensions` lists the lines whose sides differ in dimension, `parts` the outcomes of a
    claim's parts.
    """

    verdict: str
    printed: str | None = None
    uses: tuple[str, ...] | None = None
    premises: tuple[str, ...] | None = None
    domain: tuple[str, ...] | None = None
    lines: tuple[str, ...] | None = None
    correction: tuple[str, ...] | None = None
    dimensions: tuple[str, ...] | None = None
    parts: tuple[str, ...] | None = None
    theorems: tuple[str, ...] | None = None

    def theorems_of(self, what: str) -> tuple[Theorem, ...]:
        """Return the recorded theorems about a part of a claim or about a quantity, which `what` names."""
        texts = (text.removeprefix(f"{what}: ") for text in self.theorems or () if text.startswith(f"{what}: "))
        return tuple(Theorem(text) for text in texts)


def row_of(result: Verdict | Result, equations: Mapping[str, Equation]) -> OnRecord:
    """Return the record of a verdict on an equation, or of the result of a claim's test."""
    if isinstance(result, Result):
        finding = result.finding
        proved = tuple(f"{part.says}: {' '.join(filter(None, (t.says, t.encloses)))}" for part, t in finding.theorems)
        parts = tuple(f"{part.says}: {part.outcome}" for part in finding.parts)
        return OnRecord(finding.outcome, parts=parts, theorems=proved or None)
    entry = equations.get(result.id)
    return OnRecord(
        result.verdict,
        printed_digest(entry) if entry else None,
        tuple(result.statement.depends_on),
        tuple(f"{premise.says}: {premise.formula}" for premise in result.premises),
        tuple(sorted(f"{r.lhs} {r.rel_op} {r.rhs}" for r in result.domain)),
        tuple(map(_line, result.lines)),
        tuple(map(_line, result.correction_lines)),
        tuple(dict.fromkeys(_dimensions(result.lines))),
        theorems=tuple(dict.fromkeys(_theorem_texts(result.lines))) or None,
    )


def printed_digest(entry: Equation) -> str:
    """Return a hash of an equation's print in the catalogue, which changes if its LaTeX, lines or symbols change."""
    rows = [{key: row[key] for key in sorted(row)} for row in entry.line]
    text = json.dumps([entry.latex, rows, dict(entry.letters), dict(entry.refers)], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _line(line: LineVerdict) -> str:
    order = f" through order {line.order} in {line.small}" if line.verdict == "holds-to-order" else ""
    how = "under" if line.verdict == "refuted" else "if"
    needs = f" {how} {'; '.join(premise.says for premise in line.premises)}" if line.premises else ""
    return f"{line.relation.quantity}: {line.verdict}{order}{needs}"


def _theorem_texts(lines: Iterable[LineVerdict]) -> Iterator[str]:
    for line in lines:
        if theorem := line.relation.theorem:
            yield f"{line.relation.quantity}: {' '.join(filter(None, (theorem.says, theorem.encloses)))}"


def _dimensions(lines: Iterable[LineVerdict]) -> Iterator[str]:
    for line in lines:
        if line.dimensions and line.dimensions.answer != "consistent":
            yield f"{line.relation.quantity}: {line.dimensions.answer}: {line.dimensions.says}"


def recorded(file: Path) -> dict[str, OnRecord]:
    """Read a record as id → its row; empty if there is no file. Raises LagrotorError if the file cannot be read."""
    columns = {field.name for field in fields(OnRecord)}
    try:
        rows = tomllib.loads(file.read_text(encoding="utf-8"))
        records = {}
        for identifier, row in rows.items():
            if unknown := row.keys() - columns:
                raise ValueError(f"{identifier}: {min(unknown)!r} is not a key of a record")
            read: dict[str, Any] = {k: tuple(map(str, v)) if isinstance(v, list) else str(v) for k, v in row.items()}
            records[identifier] = OnRecord(**read)
        return records
    except FileNotFoundError:
        return {}
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise LagrotorError(f"{file} cannot be read ({error}): restore it from version control") from None


def record_text(rows: Mapping[str, OnRecord]) -> str:
    """Return a record as the text of its TOML file."""
    blocks = []
    for identifier in sorted(rows, key=by_numbers):
        row, lines = rows[identifier], [f"[{_quoted(identifier)}]"]
        for field in fields(row):
            value = getattr(row, field.name)
            if isinstance(value, str):
                lines.append(f"{field.name} = {_quoted(value)}")
            elif value:
                lines += [f"{field.name} = [", *(f"  {_quoted(item)}," for item in value), "]"]
            elif value is not None:
                lines.append(f"{field.name} = []")
        blocks.append("\n".join(lines) + "\n")
    return "\n".join(blocks)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def changes(current: Mapping[str, OnRecord], on_record: Mapping[str, OnRecord], ids: Iterable[str]) -> list[str]:
    """Return one sentence for each difference between current and recorded rows of these ids; none if there is no record."""
    if not on_record:
        return []
    return [sentence for i in ids for sentence in _changes_of(i, current.get(i), on_record.get(i))]


def _changes_of(identifier: str, now: OnRecord | None, recorded_row: OnRecord | None) -> list[str]:
    if now is None or recorded_row is None or now.verdict != recorded_row.verdict:
        verdicts = [row.verdict if row else "nothing" for row in (recorded_row, now)]
        return [] if now is recorded_row else [f"{identifier}: recorded {verdicts[0]}, found {verdicts[1]}"]
    different: list[str] = []
    for field in fields(OnRecord):
        old, new = getattr(recorded_row, field.name), getattr(now, field.name)
        # The digits of theorems differ between machines; parts and lines already say that there is a theorem.
        if field.name != "theorems" and old is not None and old != new:
            different.append(
                f"{identifier}: {_WORDS.get(field.name, field.name)}: recorded {_as_text(old)}, found {_as_text(new)}"
            )
    return different


_WORDS = {
    "printed": "the print has changed (hash)",
    "uses": "the equations that it uses",
}  # else the field's name


def _as_text(value: Any) -> str:
    return value if isinstance(value, str) else "; ".join(value or ()) or "nothing"


def reaches_result(
    identifier: str, results: Iterable[str], verdicts: Mapping[str, str], uses: Mapping[str, Iterable[str]]
) -> bool:
    """Return True if a refuted main result is this equation or depends on it; `uses` has the equations that each uses."""
    ends = set(results)
    visited, stack = {identifier}, [identifier]
    while stack:
        current = stack.pop()
        if current in ends and verdicts.get(current) == "refuted":
            return True
        users = {user for user, used in uses.items() if current in used} - visited
        visited |= users
        stack += users
    return False
