"""The statements of a formula. Rows are joined, split at commas and words, and read as sides with relations."""

import re
from dataclasses import dataclass, replace

from lagrotor.paper.latex.boxes import Box, FormulaError, split_at, strip
from lagrotor.paper.latex.grammar import Grammar
from lagrotor.paper.latex.tree import Call, Letter, Node, Number, is_printed_zero, is_vector, letters_of, number

_JOINING = re.compile(r"(?:and|where|with|for|if|when|at)\b")
_CONDITION = re.compile(r"(?:if|for|when|whenever|at|provided|as long as|with)\b")
_DENYING = re.compile(r"\b(?:not|nor|neither|unless|except|instead|rather|or)\b")
_SETS = ("in", "->")  # relations between objects of different kinds
# Kinds of statements → their possible relations.
_EQUAL, _BOUNDS = {"=", ":="}, {"<", ">", "<=", ">=", "<<", ">>", "!=", "<~", ">~"}
_KINDS = {"expression": set[str](), "equation": _EQUAL, "approximation": {*_EQUAL, "~"}, "inequality": _EQUAL | _BOUNDS}
_PARTING = ("wide", "arrow", "text")


@dataclass(frozen=True)
class Side:
    """One side of a relation: its expression as a tree, its LaTeX, and its position `at` in the formula."""

    node: Node
    latex: str
    at: int


@dataclass(frozen=True)
class PrintedStatement:
    """One statement: its sides, and the signs of the relations between them.

    kind: equation, approximation, inequality, condition, expression or other. order: (x, n) if the last side ends with
    + O(x^n), which is then not a part of that side; None without such a term.
    """

    sides: tuple[Side, ...]
    relations: tuple[str, ...]
    kind: str
    order: tuple[str, int] | None = None


def read_statements(reader: Grammar, row: list[Box]) -> list[PrintedStatement]:
    """Return the statements of a formula; a row that continues the row before is joined to it."""
    statements: list[PrintedStatement] = []
    for piece in _pieces(strip(row)):
        statements += _statements(reader, piece)
    return statements


def _is_related(row: list[Box]) -> bool:
    return any(box.kind == "relation" for box in row)


def _pieces(row: list[Box]) -> list[list[Box]]:
    """Return the pieces of a display: each row joined with the rows that continue it.

    Boxes after the rows, such as a condition, form the last piece. A formula without rows is one piece.
    """
    lines = _system(row[0]) if row else None
    remainder = strip(row[1:])
    if lines is None or (remainder and row[1].kind not in ("wide", "comma", "text")):
        return [row]
    pieces: list[list[Box]] = []
    for line in lines:
        while line and line[0].kind == "wide":
            line = line[1:]
        if not line:
            continue
        if pieces and _continues(pieces[-1], line):
            twice = pieces[-1][-1].kind == line[0].kind == "relation"  # = \\ =
            pieces[-1] = [*pieces[-1][: -1 if twice else None], *line]
        else:
            pieces.append(line)
    split = [inner for piece in pieces for inner in (_pieces(strip(piece)) if len(strip(piece)) == 1 else [piece])]
    return [*split, *([remainder] if remainder else [])]


def _system(box: Box) -> list[list[Box]] | None:
    """Return the lines of a box that holds several rows, perhaps behind one brace; None for any other box."""
    if box.sub is not None or box.sup is not None:
        return None
    if box.kind == "bracket" and box.name in (r"\{", ".", r"\lbrace") and "." in (box.closing, box.name):
        inside = strip(box.contents[0])
        return _system(inside[0]) if len(inside) == 1 else None
    return [[b for cell in line.contents for b in cell] for line in box.contents[0]] if box.kind == "rows" else None


def _continues(previous: list[Box], line: list[Box]) -> bool:
    last, first = previous[-1], line[0]
    if last.kind in ("operator", "relation"):
        return True
    if last.kind == "comma" or first.kind in ("arrow", "text"):
        return False
    starts = first.kind == "relation" or (first.kind == "operator" and first.name in ("+", "-", "cdot", "times", "/"))
    if starts and _is_related(line) and first.kind != "relation":
        raise FormulaError("it is unclear whether a row continues the row before", "write a comma between statements")
    if starts and any(box.kind in ("text", "wide", "comma") for box in strip(previous)):
        raise FormulaError("a row continues one of several statements", "write each statement in rows of its own")
    if not starts and not _is_related(line):
        raise FormulaError("a row has no relation", "begin the row with the sign that joins it to the row before")
    return starts


def _segments(reader: Grammar, row: list[Box]) -> list[tuple[str, list[Box]]]:
    """Split a piece at wide spaces, words, arrows and commas.

    Return pairs (separator, boxes after it). The separator is "" at the beginning, "condition" after a word such as if.
    """
    segments: list[tuple[str, list[Box]]] = [("", [])]
    for place, box in enumerate(row):
        following = next((b for b in row[place + 1 :] if b.kind != "wide"), None)
        if box.kind in ("arrow", "text"):
            if box.kind == "text" and _DENYING.search(box.name):
                raise FormulaError(f"the words {box.name} negate a statement", "write the statements that hold")
            behind = row[place - 1].kind if place else "wide"
            if box.kind == "text" and behind in ("number", "relation", "operator") and not _JOINING.match(box.name):
                raise FormulaError(
                    f"the words {box.name} are a unit or a side of a relation", "write a symbol, or omit the unit"
                )
            condition = box.name == "forall" or (box.kind == "text" and _CONDITION.match(box.name))
            segments.append(("condition" if condition else box.kind, []))
        elif box.kind == "bracket" and box.name == "(" and _is_related(box.contents[0]) and not (box.sup or box.sub):
            segments += [("condition", list(box.contents[0])), ("wide", [])]
        elif box.name == "." and box.kind == "comma" and following and row[place + 1].kind not in _PARTING:
            raise FormulaError("a full stop is inside the formula", r"write \cdot for a product")
        elif box.kind in ("wide", "comma"):
            previous, right = strip(segments[-1][1]), following or box
            goes_on = previous and previous[-1].kind in ("operator", "relation")
            signed = right.kind == "relation" or (box.kind == "wide" and right.kind == "operator" and right.name != "-")
            if not (goes_on or (signed and previous)):
                waiting = not previous and segments[-1][0] in ("text", "condition")
                segments.append((segments[-1][0] if waiting else box.kind, []))
        elif not (box.name == ":" and not segments[-1][1]):
            segments[-1][1].append(box)
    return segments


def _statements(reader: Grammar, row: list[Box]) -> list[PrintedStatement]:
    """Return the statements of one piece, which commas, words or wide spaces may separate."""
    statements: list[PrintedStatement] = []
    segments = _segments(reader, row)
    for sign, segment in segments:
        segment = strip(segment)
        if not segment:
            continue
        if _is_related(segment) and statements and sign == "comma" and statements[-1].kind == "expression":
            raise FormulaError("the part before the comma has no relation", "write the relation for each symbol")
        if not _is_related(segment) and statements and sign in ("comma", "wide"):
            raise FormulaError("the part after the comma has no relation", "write it as a separate statement")
        elif sign == "condition":
            conditions = _statements(reader, segment)
            statements += [replace(condition, kind=sign) for condition in conditions]
        else:
            statements.append(read_statement(reader, segment))
    return statements


def read_statement(reader: Grammar, row: list[Box]) -> PrintedStatement:
    """Read a row of boxes as one statement. Raises FormulaError if a side is missing, or if a vector equals a number."""
    sides = [strip(side) for side in split_at(row, "relation")]
    relations = [box.name for box in row if box.kind == "relation"]
    if len(sides) > 2 and [b.kind for b in sides[-1]] == ["dots"]:
        sides, relations = sides[:-1], relations[:-1]  # the chain goes on
    if not all(sides):
        raise FormulaError("a side of the relation is missing", "write the side, or join the row to the row before")
    read: list[Side] = []
    for place, side in enumerate(sides):
        _check_side(side)
        index = not place and len(sides) > 1 and [(b.name, b.sup) for b in side] in ([("i", None)], [("j", None)])
        node: Node = reader.letter(side[0]) if index else reader.expression(side)
        read.append(Side(node, reader.source[side[0].at : side[-1].end].strip(), side[0].at))
    kinds = {is_vector(side.node) for side in read if not is_printed_zero(side.node) and side.node != Call("dots", ())}
    if len(kinds) > 1 and not {*relations} & {*_SETS}:
        raise FormulaError("a vector is equal to a number", "declare the vectors in [notation], or mark them alike")
    if summed := set[str]().union(*(_repeated(side.node) for side in read)):
        missing = summed - set[str].intersection(*(_indices(side.node) for side in read))
        if missing and len(read) > 1:
            raise FormulaError(
                f"it is unclear whether {min(missing)} is summed over", r"write \sum, or give it another index"
            )
    order, value = without_order(read[-1].node)
    read[-1] = replace(read[-1], node=value)
    return PrintedStatement(tuple(read), tuple(relations), _kind(relations), order)


def _indices(node: Node) -> set[str]:
    """Return the letters i, j, k, μ and ν that occur as subscripts in a node and that no sum over them binds."""
    if isinstance(node, Call):
        bound = set(letters_of(Call("", node.args[1:]))) if node.name in ("Sum", "Product") else set[str]()
        return set[str]().union(*map(_indices, node.args)) - bound
    words = node.name.split("_")[1:] if isinstance(node, Letter) else []
    return {
        index for word in words for index in ([word] if word in ("mu", "nu") else word if {*word} <= {*"ijk"} else "")
    }


def _repeated(node: Node) -> set[str]:
    """Return the indices without Σ that two factors of a product share; the author may mean a sum over them."""
    if not isinstance(node, Call):
        return set()
    shared = [_indices(argument) for argument in node.args] if node.name in ("product", "dot") else []
    twice = {index for place, a in enumerate(shared) for b in shared[:place] for index in a & b}
    return twice.union(*map(_repeated, node.args)) & _indices(node)


def _check_side(side: list[Box]) -> None:
    """Raise FormulaError for a side that is an acronym or has square brackets."""
    plain = [b for b in side if b.kind == "letter" and not (b.sub or b.sup or b.marks or b.style)]
    name = "".join(box.name for box in plain)
    if 2 < len(side) == len(name) and name.isupper():
        raise FormulaError(f"{name} is a word", r"write \mathrm{…} for a word, or \cdot for a product")
    square = len(side) == 1 and side[0].name == "[" and not (side[0].sub or side[0].sup)
    if square and [b.kind for b in side[0].contents[0]] != ["matrix"]:
        raise FormulaError("it is unclear what the square brackets mean", "write the meaning, or omit the brackets")


def _kind(relations: list[str]) -> str:
    return next((kind for kind, signs in _KINDS.items() if {*relations} <= signs), "other")


def without_order(node: Node) -> tuple[tuple[str, int] | None, Node]:
    """Split off the last term O(x^n) of a sum. Return (x, n) and the remaining sum, or None and the whole node."""
    last = node.args[-1] if isinstance(node, Call) and node.name == "sum" else None
    if not (isinstance(node, Call) and isinstance(last, Call) and last.name == "order"):
        return None, node
    power: Node
    inner, power = last.args[0], number(1)
    if isinstance(inner, Call) and inner.name == "power":
        inner, power = inner.args
    if not (isinstance(inner, Letter) and isinstance(power, Number) and power.value.denominator == 1):
        return None, node
    terms = node.args[:-1]
    return (inner.name, int(power.value)), terms[0] if len(terms) == 1 else Call("sum", terms)
