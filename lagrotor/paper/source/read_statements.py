"""The statements of a formula: rows that continue each other, parts between commas and words, sides and relations."""

import re
from dataclasses import dataclass, replace

from lagrotor.paper.source.boxes import Box, FormulaError
from lagrotor.paper.source.formula_reader import FormulaReader
from lagrotor.paper.source.read_integral import differential_degree
from lagrotor.paper.source.rows import is_unit_like, strip, without_thin
from lagrotor.paper.source.tree import Call, Letter, Node, Number, is_printed_zero, is_scalar, is_vector, walk

_DENYING = re.compile(r"\b(?:not|nor|neither|unless|except|instead|rather)\b")


@dataclass(frozen=True)
class Side:
    """One side of a relation: what it says and how it is printed."""

    node: Node
    latex: str
    at: int


@dataclass(frozen=True)
class PrintedStatement:
    """Sides and the relations between them; `order`: (small letter, power) of a term O(…) that the last side had.

    kind: equation, approximation, inequality, range, expression or other.
    """

    sides: tuple[Side, ...]
    relations: tuple[str, ...]
    kind: str
    order: tuple[str, int] | None = None


def read_statements(reader: FormulaReader, row: list[Box]) -> list[PrintedStatement]:
    """The statements of a formula, its rows joined where one continues the other."""
    found: list[PrintedStatement] = []
    for piece in _pieces(reader, strip(row)):
        found += _statements(reader, piece)
    return found


def _pieces(reader: FormulaReader, row: list[Box]) -> list[list[Box]]:
    """Rows of a display, each continued ones with what they continue."""
    if len(row) == 1 and row[0].kind == "group":
        return _pieces(reader, strip(row[0].parts[0]))
    system = _system(reader, row)
    if system is None:
        return [row]
    lines, always = system
    pieces: list[list[Box]] = []
    for line in lines:
        line = without_thin(line)
        while line and line[0].kind == "wide":
            line = line[1:]
        if not line:
            continue
        if pieces and (always or _continues(reader, pieces[-1], line)):
            pieces[-1] = [*pieces[-1], *line]
        else:
            pieces.append(line)
    return pieces


def _system(reader: FormulaReader, row: list[Box]) -> tuple[list[list[Box]], bool] | None:
    """The lines of a display that is all rows, and whether each continues the one before."""
    if len(row) != 1:
        return None
    box = row[0]
    if box.sub is not None or box.sup is not None:
        return None
    if box.kind == "bracket" and box.name in (r"\{", ".", r"\lbrace") and "." in (box.closing, box.name):
        return _system(reader, strip(box.parts[0]))
    if box.kind in ("rows", "cases") or (box.kind == "matrix" and box.name == "array"):
        lines = [[each for cell in line.parts for each in cell] for line in box.parts[0]]
        if box.kind == "rows" or all(any(b.kind == "relation" for b in line) for line in lines):
            return lines, False
    return None


def _continues(reader: FormulaReader, before: list[Box], line: list[Box]) -> bool:
    last, first = before[-1], line[0]
    if last.kind in ("operator", "relation"):
        return True
    if first.kind == "relation":
        return last.kind != "comma"
    if first.kind == "operator" and first.name in ("+", "-", "cdot", "times", "/", "pm", "mp"):
        return last.kind != "comma" or first.name != "-"
    if first.kind in ("arrow", "text"):
        return False
    if not any(box.kind == "relation" for box in line) and last.kind != "comma":
        raise FormulaError(first.at, "a row has no relation", "begin it with the sign that joins it to the row before")
    return False


def _statements(reader: FormulaReader, row: list[Box]) -> list[PrintedStatement]:
    """The statements of one piece, parted by wide spaces, words, arrows and commas."""
    parts: list[tuple[str, list[Box]]] = [("", [])]
    for place, box in enumerate(row):
        if box.kind == "arrow" or (box.kind == "text" and not _is_side(reader, row, place)):
            _check_words(reader, box)
            parts.append((box.kind, []))
        elif (
            box.kind == "comma"
            and box.name == "."
            and any(b.kind not in ("thin", "wide", "comma") for b in row[place + 1 :])
            and (row[place + 1].kind not in ("wide", "arrow", "text"))
        ):
            raise FormulaError(box.at, "a full stop stands within the formula", "write \\cdot for a product")
        elif box.kind == "wide" or box.kind == "comma":
            if box.kind == "wide" and _goes_on(reader, row, place, parts[-1][1]):
                continue
            parts.append((parts[-1][0] if not parts[-1][1] and parts[-1][0] == "text" else box.kind, []))
        elif box.kind == "operator" and box.name == ":" and not parts[-1][1]:
            continue
        else:
            parts[-1][1].append(box)
    found: list[PrintedStatement] = []
    for parted, part in parts:
        part = without_thin(part) if not part or part[0].kind == "thin" else part
        if not strip(part):
            continue
        has_relation = any(box.kind == "relation" for box in part)
        if parted == "comma" and has_relation and found and found[-1].kind == "expression":
            raise FormulaError(part[0].at, "what stands before the comma has no relation", "write it for each letter")
        if not has_relation and found and parted in ("comma", "wide"):
            _further(reader, found, strip(part))
        else:
            found.append(read_statement(reader, strip(part)))
    return found


def _check_words(reader: FormulaReader, box: Box) -> None:
    """Words that deny what they join are not read; of "or" it is taken that both are stated."""
    if _DENYING.search(box.name):
        raise FormulaError(box.at, f"{box.name}: the words deny what they join", "write the statements by themselves")
    if re.search(r"\bor\b", box.name):
        reader.guesses.append("what or joins are two statements, and both are meant")


def _goes_on(reader: FormulaReader, row: list[Box], place: int, part: list[Box]) -> bool:
    """Whether a wide space stands within a formula: beside an operator or a relation."""
    rest = [box for box in row[place + 1 :] if box.kind not in ("thin", "wide")]
    before = strip(part)
    if before and before[-1].kind in ("operator", "relation"):
        return True
    return bool(rest and before and rest[0].kind in ("relation", "operator") and rest[0].name not in ("-", ":"))


def _is_side(reader: FormulaReader, row: list[Box], place: int) -> bool:
    """Whether words are a whole side of a relation, or a unit behind a number."""
    before = next((b for b in reversed(row[:place]) if b.kind != "thin"), None)
    after = row[place + 1] if place + 1 < len(row) else None
    if before is not None and before.kind == "number" and is_unit_like(row[place].name):
        return True
    edges = (before is None or before.kind == "relation") and (after is None or after.kind == "relation")
    return edges and not (before is None and after is None)


def _further(reader: FormulaReader, found: list[PrintedStatement], part: list[Box]) -> None:
    """What follows a comma without a relation: n = 1, 2, …."""
    last = found[-1]
    if part[0].kind == "number" and part[0].at and reader.source[part[0].at - 2 : part[0].at - 1].isdigit():
        raise FormulaError(
            part[0].at - 1,
            "whether the comma is in a number is open",
            "write {,} in the number, or a space behind the comma",
        )
    simple = all(b.kind in ("number", "dots", "letter", "operator", "infinity") for b in part)
    if simple and last.kind in ("equation", "range") and len(last.sides) == 2:
        end = last.sides[-1].node
        if last.kind == "range" or isinstance(end, Number | Letter):
            found[-1] = replace(last, kind="range")
            return
    if last.kind == "expression" or (last.relations and last.relations[-1] in ("in", "->", "!=")):
        found.append(read_statement(reader, part))
        return
    raise FormulaError(part[0].at, "what follows the comma has no relation", "write it as a statement of its own")


def read_statement(reader: FormulaReader, row: list[Box]) -> PrintedStatement:
    sides: list[list[Box]] = [[]]
    relations: list[str] = []
    for box in row:
        if box.kind == "relation":
            relations.append(box.name)
            sides.append([])
        else:
            sides[-1].append(box)
    if len(sides) > 1 and not strip(sides[0]):
        raise FormulaError(row[0].at, "the left side is missing", "write what is equal, or join it to the row before")
    read: list[Side] = []
    for place, side in enumerate(sides):
        side = strip(side)
        if not side:
            raise FormulaError(row[-1].at, "a side of the relation is missing", "write it")
        if len(side) == 1 and side[0].kind == "dots" and relations and place == len(sides) - 1:
            relations.pop()
            continue
        latex = reader.source[side[0].at : side[-1].end].strip()
        read.append(Side(_side(reader, side), latex, side[0].at))
    degrees = {differential_degree(side.node, side.at) for side in read if not is_printed_zero(side.node)}
    if len(degrees) > 1 and not any(relation in ("->", "in") for relation in relations):
        raise FormulaError(
            row[0].at, "a differential stands on one side only", "write the derivative, or both differentials"
        )
    vectors = any(isinstance(n, Letter) and n.vector for s in read if is_vector(s.node) for n in walk(s.node))
    scalar = next((side for side in read if is_scalar(side.node)), None)
    if vectors and scalar is not None and set(relations) <= {"=", ":=", "~"}:
        raise FormulaError(scalar.at, "a vector is equal to a number", "mark the vectors alike, as \\hat{\\mathbf r}")
    order = None
    final = read[-1].node
    if isinstance(final, Call) and final.name == "sum":
        order, kept = _order_term(final)
        if order is not None:
            read[-1] = replace(read[-1], node=kept)
    return PrintedStatement(tuple(read), tuple(relations), _kind(relations), order)


def _side(reader: FormulaReader, row: list[Box]) -> Node:
    if len(row) == 1 and row[0].kind == "text":
        name = "".join(c if c.isalnum() else "_" for c in row[0].name).strip("_")
        if not re.match(r"[A-Za-z]\w*$", name):
            raise FormulaError(row[0].at, "words stand for a side", "give it a letter")
        return Letter(name)
    return reader.expression(row)


def _kind(relations: list[str]) -> str:
    kinds = set(relations)
    if not kinds:
        return "expression"
    if kinds <= {"=", ":="}:
        return "equation"
    if kinds <= {"=", ":=", "~"}:
        return "approximation"
    if kinds <= {"=", ":=", "<", ">", "<=", ">=", "<<", ">>", "!="}:
        return "inequality"
    return "other"


def _order_term(node: Call) -> tuple[tuple[str, int] | None, Node]:
    """The power of a term O(x^n), and the sum without it."""
    last = node.args[-1]
    if not (isinstance(last, Call) and last.name == "order" and len(last.args) == 1):
        return None, node
    inner = last.args[0]
    if isinstance(inner, Letter):
        found = inner.name, 1
    elif isinstance(inner, Call) and inner.name == "power" and isinstance(inner.args[0], Letter):
        if not isinstance(inner.args[1], Number) or inner.args[1].value.denominator != 1:
            return None, node
        found = inner.args[0].name, int(inner.args[1].value)
    else:
        return None, node
    rest = node.args[:-1]
    return found, rest[0] if len(rest) == 1 else Call("sum", rest)
