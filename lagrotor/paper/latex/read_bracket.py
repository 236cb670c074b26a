"""What is enclosed: brackets, bars, roots, accents over more than a letter, matrices, cases."""

import re
from collections.abc import Callable
from itertools import pairwise

from lagrotor.paper.latex.boxes import Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_derivative import read_advection, read_operators
from lagrotor.paper.latex.read_scripts import index_parts, letter_of, power_of
from lagrotor.paper.latex.read_statements import read_statement
from lagrotor.paper.latex.rows import all_boxes, derivative_mark, parted, strip, without_thin
from lagrotor.paper.latex.tree import CONDITIONS, Call, Letter, Node, Number, is_matrix, is_vector, number
from lagrotor.paper.latex.usage import arguments


def read_bracket(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    pair = _PLAIN.get(box.name, box.name), _PLAIN.get(box.closing, box.closing)
    content = without_thin(box.parts[0])
    if pair in (("(", ")"), ("[", "]")) and content and (made := read_operators(reader, row, place)) is not None:
        return made
    if pair == ("(", ")") and len(content) > 2 and content[-1].kind == "nabla" and content[-2].name == "cdot":
        return read_advection(reader, row, place)
    held = pair == ("(", ")") and box.sub and box.sup is None and [b.kind for b in content] == ["fraction"]
    if held and box.sub and derivative_mark(content[0]):
        constant = map(reader.expression, arguments(box.sub))  # (∂S/∂E)_{N,V}
        return Call("at_constant", (reader.expression(content), *constant)), place + 1
    if pair == (".", "|") or (pair == ("[", "]") and box.sub and box.sup):
        return _evaluated(reader, box, content), place + 1
    if pair == (r"\{", ".") and len(content) == 1 and content[0].kind in ("matrix", "rows"):
        return read_cases(reader, content, 0)[0], place + 1
    if pair not in _ENCLOSED:
        raise FormulaError(box.at, f"{box.name} … {box.closing} is not read", "write brackets that belong together")
    node = _ENCLOSED[pair](reader, box)
    if box.sub is not None:
        node = _indexed(reader, node, box)
    return power_of(reader, node, box), place + 1


_NAMED = ("mean", "ket", "bra", "length", "norm", "inner", "commutator", "poisson")  # by an index


def _indexed(reader: FormulaReader, node: Node, box: Box) -> Node:
    """A state, a mean or a norm that is named by its index, |0⟩_A; a component of a vector, (a × b)_i."""
    index = index_parts(box)
    if isinstance(node, Call) and node.name in _NAMED:
        return Call("_".join((node.name, *index)), node.args)
    rising = isinstance(node, Number) or (isinstance(node, Letter) and len(node.name) == 1)  # (a)_n = a(a + 1)…
    component = is_vector(node) or (not rising and {*"".join(index)} <= {*"ijklmnabpqrs0123456789"})
    if box.name == "(" and component and all(len(part) <= 2 for part in index):
        return Call("component", (node, *(number(i) if i.isdigit() else Letter(i) for i in index)))
    raise FormulaError(box.at, "a bracket has an index", "write what it means")


def _bars(reader: FormulaReader, box: Box) -> Node:
    """A magnitude."""
    content = box.parts[0]
    inner = reader.expression(content)
    if isinstance(inner, Letter) and is_matrix(inner):
        reader.guess("bars", f"|{inner.name}| is a length, no determinant")
    elif is_matrix(inner):
        raise left_open(box, "the bars are a determinant or a length", "write \\det")
    return Call("norm" if is_vector(inner) else "Abs", (inner,))


def _double_bars(reader: FormulaReader, box: Box) -> Node:
    inner = reader.expression(box.parts[0])
    return Call("norm" if is_vector(inner) else "length", (inner,))


def _angles(reader: FormulaReader, box: Box) -> Node:
    """A mean, or a product of a bra and a ket with what stands between them."""
    content = without_thin(box.parts[0])
    bars = [k for k, b in enumerate(content) if b.kind == "bar"]
    if bars and bars[0] and not any(content[k].sub or content[k].sup for k in bars):
        return Call("braket", tuple(_label(reader, each) for each in parted(content, "bar", "comma")))
    if any(b.kind == "bracket" and b.name == "|" for b in content[1:-1]):
        raise left_open(box, "bars part a bra from a ket", "write \\middle| for each")
    held = tuple(reader.expression(part) for part in arguments(content))
    return Call("mean" if len(held) == 1 else "inner", held)


def _vector_of_state(reader: FormulaReader, box: Box) -> Node:
    name = "bra" if _PLAIN.get(box.name, box.name) == r"\langle" else "ket"
    return Call(name, tuple(_label(reader, part) for part in arguments(box.parts[0])))


def _label(reader: FormulaReader, row: list[Box]) -> Node:
    """What stands in a ket: an expression, or a sign as a letter."""
    row = strip(row)
    if len(row) == 1 and row[0].kind in ("operator", "relation"):
        word = re.sub(r"\W", "", reader.source[row[0].at : row[0].end]) or {"+": "plus"}.get(row[0].name, "minus")
        return Letter(f"sign_{word}")
    if len(row) == 1 and row[0].kind == "letter" and row[0].name in ("i", "j"):
        return letter_of(reader, row[0])[0]
    return reader.expression(row)


def _rounded(reader: FormulaReader, box: Box) -> Node:
    return Call(box.name[2:].removeprefix("l"), (reader.expression(box.parts[0]),))


def _inside(reader: FormulaReader, box: Box) -> Node:
    """What is in brackets; a list is a vector of components, a commutator or Poisson bracket a call."""
    content = box.parts[0]
    parts = [strip(part) for part in arguments(content)]
    if len(content) == 1 and content[0].kind == "matrix":
        return reader.expression(content)
    if len(parts) == 1:
        if any(b.kind == "relation" for b in content):
            why = "a relation stands in brackets"
            raise FormulaError(content[0].at if content else box.at, why, "write it by itself")
        return reader.expression(content)
    if not all(parts):
        raise FormulaError(box.at, "a component is missing", "write it")
    if (
        len(parts) == 2
        and all(b.kind in ("number", "operator", "infinity") for p in parts for b in p)
        and box.name == "["
    ):
        return Call("interval", tuple(map(reader.expression, parts)))
    if box.name == "[" and any(b.kind == "function" for b in all_boxes(content)):
        raise left_open(box, "the brackets hold components or an interval", "write round brackets")
    name = {"[": "commutator", r"\{": "poisson"}.get(box.name, "column") if len(parts) == 2 else "column"
    if name != "column":
        reader.guess("commutator", f"{name} brackets are meant, no {'interval' if box.name == '[' else 'set'}")
    if box.name == r"\{" and name == "column":
        name = "set"
    return Call(name, tuple(map(reader.expression, parts)))


def _evaluated(reader: FormulaReader, box: Box, content: list[Box]) -> Node:
    """An expression at a place: x = 0."""
    where = box.sub or []
    places = [k for k, b in enumerate(where) if b.kind == "relation" and b.name == "="]
    node = reader.expression(content)
    if where and box.sup is not None:
        start = where[places[0] + 1 :] if places else where
        return Call("between", (node, reader.expression(start), reader.expression(box.sup)))
    if not places and len(where) == 1 and where[0].name in ("i", "j"):  # at a point of a grid
        return Call("at", (node, letter_of(reader, where[0])[0]))
    if not places and any(b.kind == "comma" for b in where) and all(b.kind in ("letter", "comma") for b in where):
        reader.guess("at", "what the comma parts is held constant")
        return Call("at_constant", (node, *map(reader.expression, arguments(where))))
    if len(places) > 1 or not where:
        raise FormulaError(box.at, "where it is evaluated is not an equation", "write |_{x = 0}")
    if not places and len(where) > 1:
        raise FormulaError(box.at, "where it is evaluated is not clear", "write |_{x = 0}")
    sides = (where[: places[0]], where[places[0] + 1 :]) if places else (where,)
    return Call("at", (node, *map(reader.expression, sides)))


# Names of the same bracket; what is between brackets that belong together.
_PLAIN = (
    {r"\lbrace": r"\{", r"\rbrace": r"\}", r"\lbrack": "[", r"\rbrack": "]"}
    | dict.fromkeys(("<", "⟨"), r"\langle")
    | dict.fromkeys((">", "⟩"), r"\rangle")
    | dict.fromkeys((r"\vert", r"\lvert", r"\rvert"), "|")
    | dict.fromkeys((r"\Vert", r"\lVert", r"\rVert"), r"\|")
)
_ENCLOSED: dict[tuple[str, str], Callable[[FormulaReader, Box], Node]] = {
    ("(", ")"): _inside, ("[", "]"): _inside, (r"\{", r"\}"): _inside, (".", "."): _inside, ("|", "|"): _bars,
    (r"\|", r"\|"): _double_bars, (r"\langle", r"\rangle"): _angles,
    ("|", r"\rangle"): _vector_of_state, (r"\langle", "|"): _vector_of_state,
    (r"\lfloor", r"\rfloor"): _rounded, (r"\lceil", r"\rceil"): _rounded,
}  # fmt: skip


def read_group(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    adds = any(b.kind == "operator" and b.name in ("+", "-", "pm", "mp") for b in strip(box.parts[0])[1:])
    if adds and (box.sup or len(strip(row)) > 1 or reader.source[: box.at].rstrip().endswith("-")):
        reader.guess("brace", "a sum over or under a brace is one factor, as if brackets stood around it")
    return power_of(reader, reader.expression(box.parts[0]), box), place + 1


def read_root(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    inner = reader.expression(box.parts[0])
    if len(box.parts) > 1:
        degree = reader.expression(box.parts[1])
        return power_of(reader, Call("power", (inner, Call("quotient", (number(1), degree)))), box), place + 1
    return power_of(reader, Call("sqrt", (inner,)), box), place + 1


def read_binomial(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    above, below = (sorted("".join(b.name for b in part)) for part in box.parts)
    if above == below and len(above) > 2 and "".join(above).isdigit():
        reader.guess("matrix", "two rows of the same numbers are a binomial, and no permutation")
    return power_of(reader, Call("binomial", tuple(map(reader.expression, box.parts))), box), place + 1


def read_infinity(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    return power_of(reader, Letter("oo"), row[place]), place + 1


def read_accent(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    """A mark over more than a letter: a rate, a mean."""
    box = row[place]
    inner = reader.expression(box.parts[0])
    if box.name not in ("dot", "ddot"):
        reader.guess("bar", f"the {box.name} over several signs is no conjugate or segment")
    if box.name in ("dot", "ddot", "bar"):  # a rate; a mean or a conjugate
        made = Call("bar" if box.name == "bar" else "rate", (inner,))
        return power_of(reader, Call("rate", (made,)) if box.name == "ddot" else made, box), place + 1
    if box.name == "vec" and isinstance(inner, Call) and all(isinstance(a, Letter) for a in inner.args):
        names = "".join(a.name for a in inner.args if isinstance(a, Letter))
        return Letter(f"{names}vec", True), place + 1
    raise FormulaError(box.at, f"a {box.name} stands over what is no letter", "give it a letter of its own")


def read_matrix(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    lines = [[reader.expression(cell) for cell in line.parts] for line in box.parts[0]]
    if not lines or len({len(line) for line in lines}) != 1:
        raise FormulaError(box.at, "the rows of a matrix have different lengths", "write every entry")
    if box.name not in ("pmatrix", "bmatrix", "vmatrix"):
        reader.guess("array", f"the {box.name} is a matrix, and no table or symbol")
    elif box.name == "pmatrix" and [len(line) for line in lines] in ([3, 3], [1, 1]):
        reader.guess("array", "the brackets hold a matrix, and no 3j symbol or binomial")
    if len(lines[0]) == 1 and box.name != "vmatrix":
        return power_of(reader, Call("column", tuple(line[0] for line in lines)), box), place + 1
    rows = tuple(Call("row", tuple(line)) for line in lines)
    return power_of(reader, Call("det" if box.name == "vmatrix" else "matrix", rows), box), place + 1


# Words for all that the other cases are not.
_ELSE = "otherwise, else, elsewhere, in other cases, in all other cases, sonst, sinon, altrimenti, иначе"


def read_cases(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    made: list[Node] = []
    for line in box.parts[0]:
        if len(line.parts) != 2:
            raise FormulaError(box.at, "a case has no condition", "write the value, &, and where it holds")
        value, where = (strip(cell) for cell in line.parts)
        words = " ".join(b.name for b in where if b.kind == "text").strip(" ,.;").lower()
        where = strip([b for b in where if b.kind not in ("text", "wide", "thin")])
        condition: Node = Letter("otherwise")
        if not where and words not in ("", *_ELSE.split(", ")):
            raise FormulaError(box.at, "the condition of a case is not read", "write one relation")
        if where:
            stated = read_statement(reader, where)
            joined = [b for b in strip(line.parts[1])[1:] if b.kind == "text" and b.name not in (".", ",")]
            if not stated.relations or joined or not {*stated.relations} <= CONDITIONS.keys():
                raise FormulaError(where[0].at, "the condition of a case is not read", "write one relation")
            pairs = zip(stated.relations, pairwise(side.node for side in stated.sides), strict=True)
            each = [Call(CONDITIONS[relation], two) for relation, two in pairs]
            condition = each[0] if len(each) == 1 else Call("And", tuple(each))
        made.append(Call("case", (reader.expression(value), condition)))
    return Call("cases", tuple(made)), place + 1
