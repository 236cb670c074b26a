"""What a derivation says besides its proofs and verdicts."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Remark:
    """Something that a derivation found besides the judged equations: a heading and what was found, with its numbers."""

    title: str
    text: str

    def _repr_markdown_(self) -> str:
        return f"**{self.title}.** {self.text}"
