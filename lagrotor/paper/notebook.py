"""What a notebook shows at the end of a derivation's cell, for what has no display of its own.

Statements are judged when they are shown, so that importing a script stays fast.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from lagrotor.paper import scripts
from lagrotor.paper.ledger import Statement, judge, verdict_table
from lagrotor.paper.proof import Formula as Formula
from lagrotor.paper.tables import Table


@dataclass(frozen=True)
class Remark:
    """Something that a derivation found besides the judged equations: a heading and what was found, with its numbers."""

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"


@dataclass(frozen=True)
class Judged:
    """The verdicts of statements."""

    statements: Sequence[Statement] = field(repr=False)  # a notebook keeps the repr beside the table

    def _repr_html_(self) -> str:
        return verdict_table(map(judge, self.statements))._repr_html_()


def findings_table(findings: Iterable[tuple[str, str]]) -> Table:
    """What a script found beyond the judged equations."""
    return Table("Findings", ("what", "found"), tuple(findings))


def findings(prefix: str) -> list[tuple[str, str]]:
    """(title, sentence) of what the derivations with this prefix found beyond the judged equations."""
    found = []
    for stem in scripts.names("derivations", prefix):
        script = scripts.executed("derivations", stem)
        found += script.names.get("findings", [])
        found += [(remark.title, remark.text) for remark in script.shown(Remark)]
    return found
