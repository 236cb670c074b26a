"""The verdicts on record: what each equation and claim came out as, and which equations each of them uses."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from lagrotor.errors import LagrotorError


@dataclass(frozen=True)
class OnRecord:
    """The verdict or outcome on record, and the ids of the equations that the equation uses."""

    verdict: str
    uses: Sequence[str] = ()


def recorded(file: Path) -> dict[str, OnRecord]:
    """The record by id; empty when there is none yet. Raises LagrotorError for a broken file."""
    try:
        rows = json.loads(file.read_text(encoding="utf-8"))
        return {i: OnRecord(**({"verdict": row} if isinstance(row, str) else row)) for i, row in rows.items()}
    except FileNotFoundError:
        return {}
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise LagrotorError(f"{file} cannot be read ({error!r}): restore it") from None


def as_text(found: Mapping[str, OnRecord]) -> str:
    """A record as JSON, a line for each id: its verdict, with what it uses where it uses something."""
    rows = (
        f"{json.dumps(i)}: {json.dumps({'verdict': row.verdict, 'uses': list(row.uses)} if row.uses else row.verdict)}"
        for i, row in found.items()
    )
    return "{\n " + ",\n ".join(rows) + "\n}\n"


def changes(found: Mapping[str, str], on_record: Mapping[str, OnRecord], ids: Iterable[str]) -> list[str]:
    """A sentence for each of the ids whose verdict differs from the one on record; none where there is no record."""
    if not on_record:
        return []
    before = {i: row.verdict for i, row in on_record.items()}
    return [
        f"{i}: recorded {before.get(i, 'nothing')}, found {found.get(i, 'nothing')}"
        for i in ids
        if before.get(i) != found.get(i)
    ]


def reaches_result(
    identifier: str, results: Iterable[str], verdicts: Mapping[str, str], uses: Mapping[str, Iterable[str]]
) -> bool:
    """Whether a refuted equation takes a result of the paper with it: one that rests on it, or is it, is refuted too."""
    ends = set(results)
    seen, left = {identifier}, [identifier]
    while left:
        current = left.pop()
        if current in ends and verdicts.get(current) == "refuted":
            return True
        users = {user for user, used in uses.items() if current in used} - seen
        seen |= users
        left += users
    return False
