"""What the readers of the parts of a formula share: its source, the paper's notation, and the grammar that they call back."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

from lagrotor.paper.latex.boxes import Box, FormulaError, left_open
from lagrotor.paper.latex.tree import Node
from lagrotor.paper.latex.usage import Notation


def settled(name: str, *keys: str) -> str:
    """The lines of [notation] by one of which the author says what a letter is."""
    return " or ".join(f'{key} = "{name}"' for key in keys)


def asked(box: Box, what: str, *keys: str) -> FormulaError:
    """The stop at a letter of which the author is to say whether it is this."""
    return left_open(box, what, f"write in paper.toml [notation] {settled(box.name, *keys)}")


@dataclass
class FormulaReader(ABC):
    """One formula that is read. guesses: what custom settled; bound: indices of the sums that are open here.

    integrating, exponents: how many integrals, and powers of e, the place that is read lies in. lowered: what stands in an
    index, a ket or a bound of this formula. row: its boxes; above: its upper indices, once they are needed.
    """

    source: str
    notation: Notation
    guesses: list[str] = field(default_factory=list)
    bound: list[str] = field(default_factory=list)
    integrating: int = 0
    exponents: int = 0
    lowered: frozenset[str] = frozenset()
    row: list[Box] = field(default_factory=list)
    above: frozenset[str] | None = None
    alone: bool = False
    reaching: bool = False

    def guess(self, key: str, what: str, settles: str = "") -> None:
        """Mark a reading: what custom takes, and the line of [notation] that settles it."""
        if key not in self.notation.usual:
            line = settles or f'usual = "{key}"'
            self.guesses.append(f"{what} ([notation] {line})")

    @abstractmethod
    def expression(self, row: list[Box]) -> Node:
        """The sum that a row of boxes is. Raises FormulaError where it is none."""

    @abstractmethod
    def term(self, row: list[Box]) -> Node:
        """The product that a row of boxes is, its factors joined by signs."""

    @abstractmethod
    def product(self, row: list[Box]) -> Node:
        """Factors side by side."""

    @abstractmethod
    def factor(self, row: list[Box], place: int) -> tuple[Node, int]:
        """One factor and the place behind it."""
