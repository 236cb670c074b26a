"""The readings of a paper's equations, which an author compares with the source, and the kinds of its symbols."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.notation import KINDS, Notation, declared_notation, propose, with_proposals
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.tokens import NESTING, Token, latex_of, tokenize
from lagrotor.paper.latex.tree import Letter, Number, in_catalogue, is_constant, text_of, walk


@dataclass(frozen=True)
class Print:
    """The reading of an equation as data for the catalogue equations.toml.

    lines: its rows, each with quantity and members. aside: statements that no row can express, as text. letters,
    vectors: the names of its scalars and of its vectors. stop: (reason, remedy) if the equation is not read, else None.
    """

    lines: tuple[Mapping[str, Any], ...] = ()
    aside: tuple[str, ...] = ()
    letters: tuple[str, ...] = ()
    vectors: tuple[str, ...] = ()
    stop: tuple[str, str] | None = None


def paper_notation(formulas: Iterable[str], table: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """Return the kind of each symbol of a paper: the kind declared in `table`, otherwise the kind that the formulas suggest.

    `table` is [notation] in paper.toml; `where` names this file in messages.
    """
    return with_proposals(declared_notation(table, where), propose(formulas))


def read_print(latex: str, notation: Notation, lead: str = "") -> Print:
    """Read an equation and return its reading as data; `lead` is the left side of the row that it continues, or ""."""
    reading = read_formula(latex, notation, lead)
    if not reading.whole:
        return Print(stop=reading.stop)
    rows = [(statement, _line(statement)) for statement in reading.statements]
    sides = (side.node for statement, line in rows if line is not None for side in statement.sides)
    nodes = (node for side in sides if in_catalogue(side) for node in walk(side))
    symbols = dict.fromkeys(node for node in nodes if isinstance(node, Letter) and not is_constant(node))
    return Print(
        tuple(line for _, line in rows if line is not None),
        tuple(statement_text(statement) for statement, line in rows if line is None),
        tuple(dict.fromkeys(symbol.name for symbol in symbols if not symbol.vector)),
        tuple(dict.fromkeys(symbol.name for symbol in symbols if symbol.vector)),
    )


def _line(statement: PrintedStatement) -> dict[str, Any] | None:
    """Return a statement as a row with quantity, members and claimed order; None if a row cannot express it."""
    sides = statement.sides
    allowed = [in_catalogue(side.node) for side in sides]
    first = next((place for place, fits in enumerate(allowed) if place and fits), 0)
    if statement.kind != "equation" or not first or not all(allowed[first:]):
        return None
    names, members = sides[:first], sides[first:]  # p = ∂L/∂q̇ before the members is the quantity of the line
    if isinstance(sides[0].node, Number) and all(allowed):
        names, members = sides[1:2], (sides[0], *sides[2:])
    line = {"quantity": " = ".join(map(_latex, names)), "members": [text_of(side.node) for side in members]}
    small, power = statement.order or ("", 0)
    return line | {"order": power - 1, "small": small} if small else line


def _latex(side: Side) -> str:
    r"""Return a side in LaTeX, without the signs & and \\ that divide its display into columns and rows."""
    tokens, depth = list[Token](), 0
    for token in tokenize(side.latex):
        depth += NESTING.get(token.text, 0)
        if depth or token.text not in ("&", r"\\"):
            tokens.append(token)
    return " ".join(latex_of(tokens).split())


def statement_text(statement: PrintedStatement) -> str:
    """Return a statement as one line of text with Python names, such as x_dot = v + O(v**2)."""
    first, *others = (text_of(side.node) for side in statement.sides)
    order = "" if statement.order is None else f" + O({statement.order[0]}**{statement.order[1]})"
    tail = (f" {relation} {text}" for relation, text in zip(statement.relations, others, strict=False))
    return "".join([first, *tail, order])


@dataclass(frozen=True)
class EquationReading:
    """The reading of one equation; `print` is its LaTeX.

    status: confirmed, unconfirmed, by hand or not read; changed if the LaTeX has changed; gone if the source lacks the
    equation; aside if no statement of it can be compared; unread so far if [notation] has changed and init must run again.
    lines: its printed lines and the statements that are not compared, as text. stopped, helps: the reason why the reading
    stopped, and the remedy. number: the printed number if it differs from the id, else "".
    """

    id: str
    title: str
    print: str
    status: str
    lines: tuple[str, ...] = ()
    stopped: str = ""
    helps: str = ""
    number: str = ""


def readings(paper: Catalogue) -> Iterator[EquationReading]:
    """Yield the reading of every equation in the paper's order. Raises InputError for an error in [notation]."""
    equations = list(paper.equations.values())
    notation = paper_notation((e.latex for e in equations), paper.about.notation, str(paper.folder / "paper.toml"))
    for entry in equations:
        renumbered = entry.number and entry.read != "gone" and str(entry.number) != entry.id
        yield replace(_reading(entry, notation), number=str(entry.number) if renumbered else "")


def _reading(entry: Equation, notation: Notation) -> EquationReading:
    result = EquationReading(entry.id, entry.title, entry.latex, "gone", _line_texts(entry.line))
    if entry.read == "gone":
        return result
    if entry.line:
        status = "by hand" if not entry.read else "confirmed" if entry.is_confirmed else "unconfirmed"
        status = "changed" if entry.changed and status == "unconfirmed" else status
        return replace(result, status=status, lines=(*result.lines, *entry.aside))
    print_ = read_print(entry.latex, notation, entry.lead)
    if print_.stop is not None:
        return replace(result, status="not read", stopped=print_.stop[0], helps=print_.stop[1])
    if print_.lines:  # [notation] has changed since init
        return replace(result, status="unread so far", lines=_line_texts(print_.lines))
    return replace(result, status="aside", lines=print_.aside)


@dataclass(frozen=True)
class SymbolKind:
    """The kind of one symbol. The author has declared it in [notation], or the formula `evidence` suggests it."""

    symbol: str
    kind: str
    declared: bool
    evidence: str = ""


def symbol_kinds(paper: Catalogue) -> list[SymbolKind]:
    """Return the symbols of a paper that are not plain real numbers: first the declared, then the proposed ones."""
    table = declared_notation(paper.about.notation, str(paper.folder / "paper.toml"))
    kinds = [SymbolKind(name, kind, True) for kind in KINDS for name in sorted(getattr(table, kind))]
    declared = {kind.symbol for kind in kinds}
    proposals = propose(entry.latex for entry in paper.equations.values())
    return kinds + [SymbolKind(p.symbol, p.kind, False, p.evidence) for p in proposals if p.symbol not in declared]


def _line_texts(lines: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return rows of the catalogue as text, quantity = member = …, each with the order O(…) that it claims."""
    claimed = (f" + O({row['small']}**{row.get('order', 0) + 1})" if row.get("small") else "" for row in lines)
    texts = (" = ".join([row["quantity"], *map(str, row.get("members", ()))]) for row in lines)
    return tuple(map("".join, zip(texts, claimed, strict=True)))


def typeset_lines(paper: Catalogue, identifier: str) -> tuple[str, ...]:
    """Return the lines of an equation, as they are judged, in LaTeX; none if a symbol is not declared."""
    try:
        lines = paper.lines(identifier)
    except InputError:
        return ()
    return tuple(" = ".join([line.quantity, *map(latex, line.members)]) for line in lines)
