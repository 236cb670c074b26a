"""What a derivation says besides its proofs and verdicts."""

from collections.abc import Iterable
from dataclasses import dataclass

from lagrotor.paper.tables import Table


@dataclass(frozen=True)
class Remark:
    """Something that a derivation found besides the judged equations: a heading and what was found, with its numbers."""

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"


def findings_table(findings: Iterable[tuple[str, str]]) -> Table:
    """What a script found beyond the judged equations."""
    return Table("Findings", ("what", "found"), tuple(findings))
