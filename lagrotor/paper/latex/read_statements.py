"""The statements of a formula: rows that continue each other, parts between commas and words, sides and relations."""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from lagrotor.paper.latex.boxes import Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader, settled
from lagrotor.paper.latex.read_integral import differential_degree, holds_variation
from lagrotor.paper.latex.read_scripts import letter_of
from lagrotor.paper.latex.rows import is_related, is_unit_like, parted, strip, without_thin
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.tree import (
    KNOWN,
    Call,
    Letter,
    Node,
    Number,
    is_printed_zero,
    is_scalar,
    is_vector,
    letters_of,
    may_be_vector,
    number,
    text_of,
    walk,
)
from lagrotor.paper.latex.usage import arguments

_CONDITION = re.compile(
    r"(?:if|for|when|whenever|at|provided|as long as|with|si|pour|wenn|falls|für|mit|para|per|se)\b"
)
_SETS = ("in", "->", "subset", "supset", "not in", "<->", "<-")  # relations of what need not be alike
_DENYING = re.compile(r"\b(?:not|nor|neither|unless|except|instead|rather)\b")


def read_statements(reader: FormulaReader, row: list[Box]) -> list[PrintedStatement]:
    """The statements of a formula, its rows joined where one continues the other."""
    found: list[PrintedStatement] = []
    for piece in _pieces(reader, strip(row)):
        found += _statements(reader, piece)
    if reader.alone and reader.reaching:  # d/dx x - x d/dx = 1
        way_out = "write brackets around what it acts on, or let all operators act"
        raise left_open(row[0], "a derivative acts on what follows it or is an operator", way_out)
    kinds = {each.kind for each in found}
    if len(found) > 1 and "expression" in kinds:
        reader.guess("list", "what has no relation beside what has one is a statement of its own")
    if "inequality" in kinds and kinds & {"equation", "approximation", "other"}:
        reader.guess("condition", "an inequality beside an equation is a statement, and no condition of it")
    places = ("t", "x", "y", "z", "r")  # what may have its value there alone: u = 0, x = 1; A(n) = 1, n = 0
    given = {*places} if found and text_of(found[0].sides[0].node) not in places else {"t"}
    before: set[str] = set()
    for each in found:
        letters = {name for side in each.sides for name in letters_of(side.node)}
        if each.kind == "inequality" == found[0].kind and len(letters) == 1 and letters <= before:
            reader.guess("condition", "the last bound is a statement, and no condition of what is before it")
        before |= letters
        if each is not found[0] and each.kind == "equation" and text_of(each.sides[0].node) in given:
            reader.guess("condition", "the value of an argument is a statement, and no condition of what is before it")
        first = each.sides[0].node
        given |= {text_of(n) for n in first.args} if isinstance(first, Call) and first.name not in KNOWN else set()
        _mark_sides(reader, each)
    return found


def _mark_sides(reader: FormulaReader, statement: PrintedStatement) -> None:
    nodes = [side.node for side in statement.sides]
    if any(a == b for a, b in pairwise(nodes)):
        reader.guess("same", "two signs that differ in print are the same, as a dot and a rate")
    terms = (term for n in nodes for term in (n.args if isinstance(n, Call) and n.name == "sum" else (n,)))
    plain = (each for each in terms if not any(isinstance(n, Call) and n.name in KNOWN for n in walk(each)))
    if (acting := _may_act(nodes)) and acting not in reader.notation.letters:
        what = f"{acting} is a factor of what follows, and no operator on it"
        reader.guess("operator", what, settled(acting, "letters"))
    for a, b in pairwise(nodes):
        if isinstance(a, Call) and a.name == "product" and b in a.args and all(isinstance(n, Letter) for n in a.args):
            reader.guess("name", f"{''.join(map(text_of, a.args))} is a product, and no name")  # sk = s
    compared = [n for n in nodes if not is_printed_zero(n) and (is_vector(n) or not isinstance(n, Letter))]
    if len(set(map(is_vector, compared))) > 1 and statement.kind in ("equation", "approximation"):
        reader.guess("matrix", "what is printed as a vector and what is none are equal, and neither is a matrix")
    if statement.kind == "range" and any(isinstance(n, Letter) for node in nodes[1:] for n in walk(node)):
        reader.guess("list", "what the comma parts are values, and no components or arguments")


def _may_act(nodes: list[Node]) -> str:
    """The capital of L u = v, which may act on u though L is a number elsewhere; empty for other sides."""
    sides = [n.args if isinstance(n, Call) and n.name == "product" else (n,) for n in nodes]
    if list(map(len, sides)) != [2, 1] or not all(isinstance(n, Letter) for n in sides[0]):
        return ""
    (acting, on), (other,) = ([text_of(n) for n in side] for side in sides)
    functions = ("u", "v", "w", "x", "y", "f", "g", "psi", "phi", "varphi")
    return (
        acting if len(acting) == 1 and acting.isupper() and on in functions and other in (*functions, "b", "0") else ""
    )


def _pieces(reader: FormulaReader, row: list[Box]) -> list[list[Box]]:
    """Rows of a display, each continued ones with what they continue; what stands beside them is a piece of its own."""
    if len(row) == 1 and row[0].kind == "group" and not (row[0].sub or row[0].sup):
        return _pieces(reader, strip(row[0].parts[0]))
    lines = _system(row[0]) if row else None
    if lines and any(box.name == "array" for box in (row[0], *(b for part in row[0].parts for b in part))):
        reader.guess("array", "the lines of the array are statements, and no table")
    beside = strip(row[1:])
    if lines is None or (beside and row[1].kind not in ("wide", "comma", "thin", "text", "bracket")):
        return [row]
    pieces: list[list[Box]] = []
    for line in lines:
        line = without_thin(line)
        while line and line[0].kind == "wide":
            line = line[1:]
        if not line:
            continue
        if pieces and _continues(pieces[-1], line):
            last, first = pieces[-1][-1], line[0]
            begins = first.name in ("+", "-") and last.kind not in ("operator", "relation")
            several = len(parts := parted(pieces[-1], "comma", "wide")) > 1 and is_related(parts[-1])  # …, u = x / a
            worded = first.kind == "relation" and (several or any(box.kind == "text" for box in pieces[-1]))
            if worded or (begins and is_related(line)):
                reader.guess("rows", "a row that begins with its sign continues what stands just before it")
            twice = last.kind == first.kind == "relation" and last.name == first.name  # = \\\\ =
            pieces[-1] = [*pieces[-1][: -1 if twice else None], *line]
        else:
            pieces.append(line)
    inner = [each for piece in pieces for each in (_pieces(reader, piece) if _holds_system(piece) else [piece])]
    return [*inner, *([beside] if beside else [])]


def _holds_system(piece: list[Box]) -> bool:
    """Whether a row of a display is itself a system of equations."""
    held = strip(piece)
    return len(held) == 1 and held[0].kind == "cases" and _system(held[0]) is not None


def _system(box: Box) -> list[list[Box]] | None:
    """The lines of rows or of a system of equations; None where a box is neither."""
    if box.sub is not None or box.sup is not None:
        return None
    if box.kind == "bracket" and box.name in (r"\{", ".", r"\lbrace") and "." in (box.closing, box.name):
        inside = strip(box.parts[0])
        return _system(inside[0]) if len(inside) == 1 else None
    if box.kind in ("rows", "cases") or (box.kind == "matrix" and box.name == "array"):
        lines = [_joined(line.parts) for line in box.parts[0]]
        if box.kind == "rows" or all(map(is_related, lines)):
            return lines
    return None


def _joined(cells: Sequence[list[Box]]) -> list[Box]:
    """The cells of a line; what has a relation and begins none is a statement beside another: y' = x & y(0) = 1."""
    line: list[Box] = []
    for cell in cells:
        before, inner = strip(line), strip(cell)
        ends = any(b and b[k].kind in ("operator", "relation") for b, k in ((before, -1), (inner, 0)))
        if not ends and is_related(before) and is_related(inner):
            line.append(Box("wide", "", inner[0].at, inner[0].at))
        line += cell
    return line


def _continues(before: list[Box], line: list[Box]) -> bool:
    last, first = before[-1], line[0]
    if last.kind in ("operator", "relation"):
        return True
    if first.kind == "relation":
        return last.kind != "comma"
    if first.kind == "operator" and first.name in ("+", "-", "cdot", "times", "/", "pm", "mp"):
        return last.kind != "comma" or first.name != "-"
    if first.kind in ("arrow", "text"):
        return False
    if not is_related(line) and last.kind != "comma":
        raise FormulaError(first.at, "a row has no relation", "begin it with the sign that joins it to the row before")
    return False


def _parts(reader: FormulaReader, row: list[Box]) -> list[tuple[str, list[Box]]]:
    """One piece parted by wide spaces, words, arrows and commas: what stands before each part, and its boxes."""
    parts: list[tuple[str, list[Box]]] = [("", [])]
    for place, box in enumerate(row):
        if box.kind == "arrow" or (box.kind == "text" and not _is_side(row, place)):
            _check_words(reader, box, row[place + 1] if place + 1 < len(row) else None)
            condition = box.name == "forall" or (box.kind == "text" and _CONDITION.match(box.name))
            parts.append(("condition" if condition else box.kind, []))
        elif _is_condition(row, place):
            parts += [("condition", box.parts[0]), ("wide", [])]
        elif (
            box.kind == "comma"
            and box.name == "."
            and any(b.kind not in ("thin", "wide", "comma") for b in row[place + 1 :])
            and (row[place + 1].kind not in ("wide", "arrow", "text"))
        ):
            raise FormulaError(box.at, "a full stop stands within the formula", "write \\cdot for a product")
        elif box.kind == "wide" or box.kind == "comma":
            following = next((b.kind for b in row[place + 1 :] if b.kind not in ("thin", "wide")), "")
            if box.kind == "comma" and following == "relation" and strip(parts[-1][1]):
                continue  # a = b, \\\\ = c
            if box.kind == "wide" and _goes_on(row, place, parts[-1][1]):
                continue
            waiting = not parts[-1][1] and parts[-1][0] in ("text", "condition")
            parts.append((parts[-1][0] if waiting else box.kind, []))
        elif box.kind == "operator" and box.name == ":" and not parts[-1][1]:
            continue
        else:
            parts[-1][1].append(box)
    return parts


def _statements(reader: FormulaReader, row: list[Box]) -> list[PrintedStatement]:
    """The statements of one piece."""
    parts = _parts(reader, row)
    found: list[PrintedStatement] = []
    listed: list[list[Box]] = []  # i and j of i, j = 1, 2
    for place, (sign, part) in enumerate(parts):
        part = without_thin(part) if not part or part[0].kind == "thin" else part
        if not strip(part):
            continue
        if listed or (sign != "comma" and _is_list(parts, place)):
            if is_related(part):
                found += _of_each(reader, listed, strip(part))
                listed = []
            else:
                listed.append(strip(part))
            continue
        if sign == "comma" and is_related(part) and found and found[-1].kind == "expression":
            raise FormulaError(part[0].at, "what stands before the comma has no relation", "write it for each letter")
        if not is_related(part) and found and sign in ("comma", "wide"):
            follows = place + 1 < len(parts) and parts[place + 1][0] == "comma" and bool(strip(parts[place + 1][1]))
            _further(reader, found, strip(part), listed=follows or found[-1].kind == "range")
        elif sign == "condition":
            stated = _statements(reader, part)
            found += [replace(each, kind="range" if each.kind == "range" else sign) for each in stated]
        else:
            found.append(read_statement(reader, strip(part)))
    return found


def _is_list(parts: list[tuple[str, list[Box]]], place: int) -> bool:
    """Whether letters parted by commas begin here, of which the last has a relation: i, j = 1, 2."""
    behind = place
    while behind < len(parts) and [box.kind for box in strip(parts[behind][1])] == ["letter"]:
        behind += 1
        if behind < len(parts) and parts[behind][0] != "comma":
            return False
    last = strip(parts[behind][1]) if place < behind < len(parts) else []
    return [box.kind for box in last[:2]] == ["letter", "relation"] and sum(b.kind == "relation" for b in last) == 1


def _of_each(reader: FormulaReader, letters: list[list[Box]], part: list[Box]) -> list[PrintedStatement]:
    """The statement of several letters that a list has in common."""
    stated = read_statement(reader, part)
    names = [letter_of(reader, each[0])[0] for each in letters]
    reader.guess("list", "what follows the letters holds for each of them")
    first = replace(stated.sides[0], node=Call("values", (*names, letter_of(reader, part[0])[0])))
    return [replace(stated, sides=(first, *stated.sides[1:]), kind="range")]


def _is_condition(row: list[Box], place: int) -> bool:
    """Whether a bracket holds a relation and stands by itself: (c > 0), (n = 1, 2)."""
    box, apart = row[place], place and row[place - 1].kind in ("thin", "wide", "cases", "rows")
    held = box.kind == "bracket" and box.name in "([" and not box.sup and is_related(box.parts[0])
    return bool(held and (apart or not place))


def _check_words(reader: FormulaReader, box: Box, following: Box | None) -> None:
    """Words that deny what they join are not read, nor functions by name; of "or" it is taken that both are stated."""
    if box.kind == "arrow" and box.name != "forall":
        reader.guess("relation", f"{box.name} joins two statements, and both are meant")
    joined = following is not None and following.kind == "bracket" and following.at == box.end
    if joined and box.name.isalpha() and reader.source[box.end - 2].isalpha() and not _CONDITION.match(box.name):
        way_out = f"write \\operatorname{{{box.name}}}, or a space behind the word"
        raise left_open(box, f"{box.name} acts on what follows", way_out)
    if _DENYING.search(box.name):
        raise FormulaError(box.at, f"{box.name}: the words deny what they join", "write the statements by themselves")
    if re.search(r"\bor\b", box.name):
        reader.guess("or", "what or joins are two statements, and both are meant")


def _goes_on(row: list[Box], place: int, part: list[Box]) -> bool:
    """Whether a wide space stands within a formula: beside an operator or a relation."""
    rest = [box for box in row[place + 1 :] if box.kind not in ("thin", "wide")]
    before = strip(part)
    if before and before[-1].kind in ("operator", "relation"):
        return True
    return bool(rest and before and rest[0].kind in ("relation", "operator") and rest[0].name not in ("-", ":"))


def _is_side(row: list[Box], place: int) -> bool:
    """Whether words are a whole side of a relation, or a unit behind a number."""
    before = next((b for b in reversed(row[:place]) if b.kind != "thin"), None)
    after = row[place + 1] if place + 1 < len(row) else None
    if before is not None and before.kind == "number" and is_unit_like(row[place].name):
        return True
    edges = (before is None or before.kind == "relation") and (
        after is None or after.kind == "relation" or (before is not None and after.kind in ("wide", "comma"))
    )
    return edges and not (before is None and after is None)


def _further(reader: FormulaReader, found: list[PrintedStatement], part: list[Box], listed: bool) -> None:
    """What follows a comma without a relation: n = 1, 2, …; listed: whether more than one comma does."""
    last = found[-1]
    before = reader.source[max(part[0].at - 2, 0) : max(part[0].at - 1, 0)]
    if not listed and part[0].kind == "number" and before.isdigit():
        why = "whether the comma is in a number is open"
        raise FormulaError(part[0].at - 1, why, "write {,} in the number, or a space behind the comma")
    simple = all(b.kind in ("number", "dots", "letter", "operator", "infinity", "fraction", "root") for b in part)
    if simple and last.kind in ("equation", "range", "condition") and len(last.sides) == 2:
        first, end = last.sides
        if last.kind == "range" or (isinstance(first.node, Letter) and isinstance(end.node, Number | Letter)):
            values = end.node.args if isinstance(end.node, Call) and last.kind == "range" else (end.node,)
            ends = [part[:-1], part[-1:]] if len(part) > 1 and part[-1].kind == "dots" else [part]  # 1, 2...
            end = replace(end, node=Call("values", (*values, *(_side(reader, each) for each in ends))))
            found[-1] = replace(last, sides=(first, end), kind="range")
            return
    if last.kind == "expression" or (last.relations and last.relations[-1] in (*_SETS, "!=")):
        found.append(read_statement(reader, part))
        return
    raise FormulaError(part[0].at, "what follows the comma has no relation", "write it as a statement of its own")


def _sides(reader: FormulaReader, row: list[Box]) -> tuple[list[list[Box]], list[str]]:
    """What stands between the relations of a statement, and the relations."""
    sides, relations = parted(row, "relation"), [box.name for box in row if box.kind == "relation"]
    if len(sides) > 2 and not strip(sides[0]) and relations[0] == "=":
        reader.guess("continued", "the display begins with its sign: what it continues stands before, and is not read")
        sides, relations = sides[1:], relations[1:]
    if len(sides) > 1 and not strip(sides[0]):
        raise FormulaError(row[0].at, "the left side is missing", "write what is equal, or join it to the row before")
    return sides, relations


def read_statement(reader: FormulaReader, row: list[Box]) -> PrintedStatement:
    sides, relations = _sides(reader, row)
    read: list[Side] = []
    for place, side in enumerate(sides):
        side = strip(side)
        if not side:
            raise FormulaError(row[-1].at, "a side of the relation is missing", "write it")
        if len(side) == 1 and side[0].kind == "dots" and relations and place == len(sides) - 1:
            relations.pop()
            reader.guess("dots", "the dots at the end say that the chain goes on, and leave nothing out")
            continue
        _check_side(side)
        latex = _balanced(reader.source, side[0].at, side[-1].end)
        letter = not place and len(sides) == 2 and [(b.kind, b.sup) for b in side] == [("letter", None)]
        index = letter and side[0].name in ("i", "j")
        if place and relations[place - 1] in ("in", "not in"):
            node = read_set(reader, side)
        else:
            node = letter_of(reader, side[0])[0] if index else _side(reader, side)
        read.append(Side(node, latex, side[0].at))
    degrees = {differential_degree(side.node, side.at) for side in read if not is_printed_zero(side.node)}
    varied = len(degrees) > 1 and any(holds_variation(side.node) for side in read)
    if len(degrees) > 1 and not varied and not any(relation in _SETS for relation in relations):
        why = "a differential stands on one side only"
        raise FormulaError(row[0].at, why, "write the derivative, or both differentials")
    vectors = any(isinstance(n, Letter) and n.vector for s in read if is_vector(s.node) for n in walk(s.node))
    scalar = next((side for side in read if is_scalar(side.node)), None)
    if vectors and scalar is not None and may_be_vector(scalar.node):
        reader.guess("vector", "what has a hat, or is the divergence of a tensor, is a vector")
    elif vectors and scalar is not None and set(relations) <= {"=", ":=", "~"}:
        raise FormulaError(scalar.at, "a vector is equal to a number", "mark the vectors alike, as \\hat{\\mathbf r}")
    order, kept = _order_term(read[-1].node)
    read[-1] = replace(read[-1], node=kept)
    return PrintedStatement(tuple(read), tuple(relations), _kind(relations), order)


# A font or an arrow that what follows stands in.
_ENCLOSING = re.compile(
    r"(?:\{\\(?:bf|rm|cal|it|sf|tt|bfseries|mathrm)"
    r"|\\(?:math(?:bf|bb|cal|frak|it|rm|scr|sf|tt)|bm|boldsymbol|pmb|operatorname|vec)\*?\s*\{?)\s*$"
)


def _opened(source: str, at: int) -> int:
    """Where the fonts and arrows begin that what begins here stands in."""
    while enclosing := _ENCLOSING.search(source, 0, at):
        at = enclosing.start()
    return at


def _balanced(source: str, at: int, end: int) -> str:
    r"""LaTeX of a side with the braces and fonts that enclose its ends: {\bf k}_1 and \mathbf{k} + q, not k}_1 and {k} + q."""
    at = _opened(source, at)
    bare = re.sub(r"\\.", "  ", source)
    depth = least = 0
    for sign in bare[at:end]:
        depth += (sign == "{") - (sign == "}")
        least = min(least, depth)
    for _ in range(-least):
        at = _opened(source, bare.rfind("{", 0, at))
    for _ in range(depth - least):
        end = bare.find("}", end) + 1 or end
    return source[at:end].strip()


def _check_side(side: list[Box]) -> None:
    """Raise FormulaError for a side that is an acronym, or that is in square brackets: a mean, a dimension, a part."""
    name = "".join(
        box.name for box in side if not (box.sub or box.sup or box.marks or box.style or box.kind != "letter")
    )
    if 2 < len(side) == len(name) and name.isupper():
        raise FormulaError(side[0].at, f"{name} is a word", "write \\mathrm for it, or \\cdot")
    if len(side) == 1 and side[0].kind == "bracket" and side[0].name == "[" and not (side[0].sub or side[0].sup):
        inside = side[0].parts[0]
        if not any(b.kind == "comma" for b in inside) and len(inside) > 1:
            why = "what the square brackets mean is open"
            raise FormulaError(side[0].at, why, "leave them out, or write what it is")


def _side(reader: FormulaReader, row: list[Box]) -> Node:
    if len(row) == 1 and row[0].kind == "text":
        name = "".join(c if c.isalnum() else "_" for c in row[0].name).strip("_")
        if not re.match(r"[A-Za-z]\w*$", name) or _DENYING.search(row[0].name):
            raise FormulaError(row[0].at, "words stand for a side", "give it a letter")
        return Letter(name)
    return reader.expression(row)


def read_set(reader: FormulaReader, row: list[Box]) -> Node:
    """A side of a relation between a member and a set: what is listed in curly brackets is a set there."""
    inner = strip(row)
    if len(inner) == 1 and is_set(inner[0]):
        return Call("set", tuple(map(reader.expression, arguments(inner[0].parts[0]))))
    return reader.expression(row)


def is_set(box: Box) -> bool:
    """Whether a box is a list in curly brackets."""
    listed = box.kind == "bracket" and box.name in (r"\{", r"\lbrace") and not (box.sub or box.sup)
    return listed and any(b.kind == "comma" for b in box.parts[0])


def _kind(relations: list[str]) -> str:
    kinds = set(relations)
    if not kinds:
        return "expression"
    if kinds <= {"=", ":="}:
        return "equation"
    if kinds <= {"=", ":=", "~"}:
        return "approximation"
    if kinds <= {"=", ":=", "<", ">", "<=", ">=", "<<", ">>", "!=", "<~", ">~"}:
        return "inequality"
    return "other"


def _order_term(node: Node) -> tuple[tuple[str, int] | None, Node]:
    """The power of a term O(x^n) in which a sum ends, and the sum without it."""
    last = node.args[-1] if isinstance(node, Call) and node.name == "sum" else None
    if not (isinstance(node, Call) and isinstance(last, Call) and last.name == "order"):
        return None, node
    power: Node
    inner, power = last.args[0], number(1)
    if isinstance(inner, Call) and inner.name == "power":
        inner, power = inner.args
    if not (isinstance(inner, Letter) and isinstance(power, Number) and power.value.denominator == 1):
        return None, node
    rest = node.args[:-1]
    return (inner.name, int(power.value)), rest[0] if len(rest) == 1 else Call("sum", rest)
