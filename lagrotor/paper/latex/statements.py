"""The statements of a formula as data: sides, the relations between them, the kind of each."""

from dataclasses import dataclass

from lagrotor.paper.latex.tree import Node


@dataclass(frozen=True)
class Side:
    """One side of a relation: its expression, its LaTeX and its place in the formula."""

    node: Node
    latex: str
    at: int


@dataclass(frozen=True)
class PrintedStatement:
    """Sides and the relations between them; `order`: (small letter, power) of a term O(…) that the last side had.

    kind: equation, approximation, inequality, range, condition, expression or other.
    """

    sides: tuple[Side, ...]
    relations: tuple[str, ...]
    kind: str
    order: tuple[str, int] | None = None
