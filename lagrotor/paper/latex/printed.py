"""The print of an equation as data: its lines, from what was read of its LaTeX; and whether its reading is confirmed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import Notation, declared_notation, propose, with_proposals
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.tokens import NESTING, Token, latex_of, tokenize
from lagrotor.paper.latex.tree import Letter, Number, in_catalogue, is_constant, text_of, walk


@dataclass(frozen=True)
class Print:
    """The reading of an equation as data.

    lines: for the catalogue. aside: statements that no line can hold, as text. letters, vectors: names of scalars and vectors.
    stop: (token, the way out) where it cannot be read whole.
    """

    lines: tuple[Mapping[str, Any], ...] = ()
    aside: tuple[str, ...] = ()
    letters: tuple[str, ...] = ()
    vectors: tuple[str, ...] = ()
    stop: tuple[str, str] | None = None

    @property
    def read(self) -> bool:
        """Whether the equation was read whole."""
        return self.stop is None


def paper_notation(formulas: Iterable[str], table: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """Return the kinds of a paper's letters: those that its [notation] declares, and the proposals of one sweep."""
    return with_proposals(declared_notation(table, where), propose(formulas))


def read_print(latex: str, notation: Notation, lead: str = "") -> Print:
    """Return the printed lines of an equation as data."""
    reading = read_formula(latex, notation, lead)
    if not reading.whole:
        return Print(stop=reading.stop)
    lines, aside, letters, vectors = [], [], dict[str, None](), dict[str, None]()
    for statement in reading.statements:
        line = _line(statement)
        if line is None:
            aside.append(statement_text(statement))
            continue
        lines.append(line)
        for side in (each for each in statement.sides if in_catalogue(each.node)):
            for each in walk(side.node):
                if isinstance(each, Letter) and not is_constant(each):
                    (vectors if each.vector else letters)[each.name] = None
    return Print(tuple(lines), tuple(aside), tuple(letters), tuple(vectors))


def _line(statement: PrintedStatement) -> dict[str, Any] | None:
    """quantity, members, and the order that is claimed; None for what no line of the catalogue can hold."""
    if statement.kind != "equation":
        return None
    held = [in_catalogue(side.node) for side in statement.sides]
    first_member = next((place for place, each in enumerate(held) if place and each), 0)
    if not first_member or not all(held[first_member:]):
        return None
    names = statement.sides[:first_member]  # p = ∂L/∂q̇: what the line is about
    line: dict[str, Any] = {"quantity": " = ".join(_latex(side) for side in names)}
    line["members"] = [text_of(side.node) for side in statement.sides[first_member:]]
    if statement.order is not None:
        small, power = statement.order
        line |= {"order": power - 1, "small": small}
    first = statement.sides[0].node
    if isinstance(first, Number) and all(held):
        line["quantity"] = _latex(statement.sides[1])
        line["members"] = [text_of(side.node) for side in (statement.sides[0], *statement.sides[2:])]
    return line


def _latex(side: Side) -> str:
    """A side in LaTeX without the columns and rows of its display."""
    kept: list[Token] = []
    depth = 0
    for token in tokenize(side.latex):
        depth += NESTING.get(token.text, 0)
        if depth or token.text not in ("&", r"\\"):
            kept.append(token)
    return " ".join(latex_of(kept).split())


def statement_text(statement: PrintedStatement) -> str:
    """A statement as one line of text."""
    text = text_of(statement.sides[0].node)
    for relation, side in zip(statement.relations, statement.sides[1:], strict=False):
        text += f" {relation} {text_of(side.node)}"
    if statement.order is not None:
        text += f" + O({statement.order[0]}**{statement.order[1]})"
    return text
