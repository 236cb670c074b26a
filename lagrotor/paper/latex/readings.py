"""The readings of a paper's equations, for comparison with the source, and the kinds of its symbols."""

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
    """The reading of an equation as data.

    lines: rows of the catalogue. aside: statements that no row can hold, as text. letters, vectors: names of scalars and of
    vectors. stop: (token, remedy) if the equation is not read.
    """

    lines: tuple[Mapping[str, Any], ...] = ()
    aside: tuple[str, ...] = ()
    letters: tuple[str, ...] = ()
    vectors: tuple[str, ...] = ()
    stop: tuple[str, str] | None = None


def paper_notation(formulas: Iterable[str], table: Mapping[str, Any], where: str = "paper.toml") -> Notation:
    """Return the kinds of a paper's symbols: those declared in its [notation], and the proposals of one sweep."""
    return with_proposals(declared_notation(table, where), propose(formulas))


def read_print(latex: str, notation: Notation, lead: str = "") -> Print:
    """Return the printed lines of an equation as data."""
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
    """Return a row with quantity, members and claimed order; None if no row of the catalogue can hold the statement."""
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
    """Return a side in LaTeX without the columns and rows of its display."""
    tokens, depth = list[Token](), 0
    for token in tokenize(side.latex):
        depth += NESTING.get(token.text, 0)
        if depth or token.text not in ("&", r"\\"):
            tokens.append(token)
    return " ".join(latex_of(tokens).split())


def statement_text(statement: PrintedStatement) -> str:
    """Return a statement as one line of text."""
    first, *others = (text_of(side.node) for side in statement.sides)
    order = "" if statement.order is None else f" + O({statement.order[0]}**{statement.order[1]})"
    tail = (f" {relation} {text}" for relation, text in zip(statement.relations, others, strict=False))
    return "".join([first, *tail, order])


@dataclass(frozen=True)
class EquationReading:
    """The reading of one equation.

    status: confirmed, unconfirmed, by hand, changed (new LaTeX), gone (no longer in the source), aside (read, but no
    statement can be compared), not read. lines: its printed lines and uncompared statements, as text. stopped, helps: the
    token at which a reading stopped, and the remedy. number: the printed number, if it is not the id.
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
    """Read every equation in the paper's order. Raises InputError if the table [notation] cannot be read."""
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
    """The kind of one symbol: declared in [notation], or proposed by the formula `evidence`."""

    symbol: str
    kind: str
    declared: bool
    evidence: str = ""


def symbol_kinds(paper: Catalogue) -> list[SymbolKind]:
    """Return the symbols of a paper that are not plain real numbers, the declared ones first."""
    table = declared_notation(paper.about.notation, str(paper.folder / "paper.toml"))
    kinds = [SymbolKind(name, kind, True) for kind in KINDS for name in sorted(getattr(table, kind))]
    declared = {kind.symbol for kind in kinds}
    proposals = propose(entry.latex for entry in paper.equations.values())
    return kinds + [SymbolKind(p.symbol, p.kind, False, p.evidence) for p in proposals if p.symbol not in declared]


def _line_texts(lines: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Return printed lines as text, each with its claimed order."""
    claimed = (f" + O({row['small']}**{row.get('order', 0) + 1})" if row.get("small") else "" for row in lines)
    texts = (" = ".join([row["quantity"], *map(str, row.get("members", ()))]) for row in lines)
    return tuple(map("".join, zip(texts, claimed, strict=True)))


def typeset_lines(paper: Catalogue, identifier: str) -> tuple[str, ...]:
    """Return the judged lines of an equation in LaTeX; the tuple is empty if a symbol is not declared."""
    try:
        lines = paper.lines(identifier)
    except InputError:
        return ()
    return tuple(" = ".join([line.quantity, *map(latex, line.members)]) for line in lines)
