"""What is enclosed: brackets, bars, roots, accents over more than a letter, matrices, cases."""

from lagrotor.paper.source.boxes import Box, FormulaError
from lagrotor.paper.source.formula_reader import FormulaReader
from lagrotor.paper.source.read_scripts import power_of
from lagrotor.paper.source.read_statements import read_statement
from lagrotor.paper.source.rows import strip
from lagrotor.paper.source.tree import Call, Letter, Node, is_matrix, is_vector, number
from lagrotor.paper.source.usage import arguments

_CONDITIONS = {"=": "Eq", "<": "Lt", ">": "Gt", "<=": "Le", ">=": "Ge", "!=": "Ne"}


def read_bracket(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    if box.sub is not None and not (box.closing in ("|", r"\vert", r"\rvert") and box.name == "."):
        raise FormulaError(box.sub[0].at if box.sub else box.at, "a bracket has an index", "write what it means")
    pair = box.name, box.closing
    content = box.parts[0]
    if pair in (("(", ")"), ("[", "]"), (r"\{", r"\}"), (r"\lbrace", r"\rbrace"), (r"\lbrack", r"\rbrack")):
        return power_of(reader, _inside(reader, box, content), box), place + 1
    if pair in (("|", "|"), (r"\vert", r"\vert"), (r"\lvert", r"\rvert")):
        if len(content) == 2 and all(b.kind == "letter" and b.name.isupper() and not b.style for b in content):
            raise FormulaError(box.at, "whether the bars are a distance of points is open", "give it a letter")
        inner = reader.expression(content)
        if isinstance(inner, Letter) and is_matrix(inner):
            reader.guesses.append(f"|{inner.name}| is a length, no determinant")
        elif is_matrix(inner):
            raise FormulaError(box.at, "whether the bars are a determinant or a length is open", "write \\det")
        return power_of(reader, Call("norm" if is_vector(inner) else "Abs", (inner,)), box), place + 1
    if pair in ((r"\|", r"\|"), (r"\lVert", r"\rVert"), (r"\Vert", r"\Vert")):
        inner = reader.expression(content)
        return power_of(reader, Call("norm" if is_vector(inner) else "length", (inner,)), box), place + 1
    if pair in ((r"\langle", r"\rangle"), ("<", ">"), ("⟨", "⟩")):
        if any(b.kind in ("bar", "comma") for b in content):
            raise FormulaError(box.at, "angle brackets with two parts are not read", "write the product in words")
        return power_of(reader, Call("mean", (reader.expression(content),)), box), place + 1
    if pair in ((r"\lfloor", r"\rfloor"), (r"\lceil", r"\rceil")):
        return power_of(reader, Call(box.name[2:].removeprefix("l"), (reader.expression(content),)), box), place + 1
    if pair == (".", "|") or pair == (".", r"\vert") or pair == (".", r"\rvert"):
        return _evaluated(reader, box, content), place + 1
    if pair == (".", "."):
        return power_of(reader, reader.expression(content), box), place + 1
    raise FormulaError(box.at, f"{box.name} … {box.closing} is not read", "write brackets that belong together")


def _inside(reader: FormulaReader, box: Box, content: list[Box]) -> Node:
    """What is in brackets; a list is a vector of components, a commutator or Poisson bracket a call."""
    parts = [strip(part) for part in arguments(content)]
    if len(content) == 1 and content[0].kind == "matrix":
        return reader.expression(content)
    if len(parts) == 1:
        if any(b.kind == "relation" for b in content):
            raise FormulaError(
                content[0].at if content else box.at, "a relation stands in brackets", "write it by itself"
            )
        return reader.expression(content)
    if not all(parts):
        raise FormulaError(box.at, "a component is missing", "write it")
    if (
        len(parts) == 2
        and all(b.kind in ("number", "operator", "infinity") for p in parts for b in p)
        and box.name == "["
    ):
        raise FormulaError(box.at, "an interval is not read", "keep it aside")
    name = {"(": "column", "[": "commutator", r"\{": "poisson"}.get(box.name, "column")
    return Call(name, tuple(map(reader.expression, parts)))


def _evaluated(reader: FormulaReader, box: Box, content: list[Box]) -> Node:
    """An expression at a place: x = 0."""
    where = box.sub or []
    places = [k for k, b in enumerate(where) if b.kind == "relation" and b.name == "="]
    if len(places) != 1 or box.sup is not None:
        raise FormulaError(box.at, "where it is evaluated is not an equation", "write |_{x = 0}")
    left, right = where[: places[0]], where[places[0] + 1 :]
    return Call("at", (reader.expression(content), reader.expression(left), reader.expression(right)))


def read_group(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    if box.sub is not None:
        raise FormulaError(box.at, "a group has an index", "write it on the letter")
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
    return power_of(reader, Call("binomial", tuple(map(reader.expression, box.parts))), box), place + 1


def read_infinity(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    return Letter("oo"), place + 1


def read_accent(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    """A mark over more than a letter: a rate, a mean."""
    box = row[place]
    if box.sub is not None:
        raise FormulaError(box.at, "an index follows what is no letter", "write it on the letter")
    inner = reader.expression(box.parts[0])
    if box.name == "dot":
        return power_of(reader, Call("rate", (inner,)), box), place + 1
    if box.name == "ddot":
        return power_of(reader, Call("rate", (Call("rate", (inner,)),)), box), place + 1
    if box.name == "bar":
        return power_of(reader, Call("mean", (inner,)), box), place + 1
    if box.name == "vec" and isinstance(inner, Call) and all(isinstance(a, Letter) for a in inner.args):
        names = "".join(a.name for a in inner.args if isinstance(a, Letter))
        return Letter(f"{names}vec", True), place + 1
    raise FormulaError(box.at, f"a {box.name} stands over what is no letter", "give it a letter of its own")


def read_matrix(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    if box.sub is not None:
        raise FormulaError(box.at, "a matrix has an index", "write what it means")
    lines = [[reader.expression(cell) for cell in line.parts] for line in box.parts[0]]
    if not lines or len({len(line) for line in lines}) != 1:
        raise FormulaError(box.at, "the rows of a matrix have different lengths", "write every entry")
    if box.name in ("vmatrix",):
        made = Call("det", tuple(Call("row", tuple(line)) for line in lines))
        return power_of(reader, made, box), place + 1
    if len(lines[0]) == 1:
        return power_of(reader, Call("column", tuple(line[0] for line in lines)), box), place + 1
    return power_of(reader, Call("matrix", tuple(Call("row", tuple(line)) for line in lines)), box), place + 1


def read_cases(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    made: list[Node] = []
    for line in box.parts[0]:
        if len(line.parts) != 2:
            raise FormulaError(box.at, "a case has no condition", "write the value, &, and where it holds")
        value, where = (strip(cell) for cell in line.parts)
        where = [b for b in where if b.kind not in ("text", "wide", "thin")]
        condition: Node = Letter("otherwise")
        if where:
            stated = read_statement(reader, strip(where))
            if len(stated.relations) != 1 or stated.relations[0] not in _CONDITIONS:
                raise FormulaError(where[0].at, "the condition of a case is not read", "write one relation")
            condition = Call(_CONDITIONS[stated.relations[0]], tuple(side.node for side in stated.sides))
        made.append(Call("case", (reader.expression(value), condition)))
    return Call("cases", tuple(made)), place + 1
