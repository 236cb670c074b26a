"""Integrals: from the sign to the differential; terms with as many differentials on each side."""

import re

from lagrotor.paper.latex.boxes import BIG, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_derivative import behind_function, is_differential, read_differential
from lagrotor.paper.latex.rows import VARIABLES, ends_integral, has_differential_above, is_d, is_measure, without_thin
from lagrotor.paper.latex.tree import Call, Letter, Node, Number, is_printed_zero, is_vector, number, product_of, walk
from lagrotor.paper.latex.usage import simple_argument


def read_integral(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    """From the sign to its differential."""
    box = row[place]
    rest = row[place + 1 :]
    if box.sub is not None and box.sup is None and not any(map(ends_integral, rest)):
        reader.guess("integral", "the integral is over what stands below it, and its differential is left out")
        return Call("Integral", (reader.expression(rest), _region(reader, box))), len(row)
    reader.integrating += 1
    try:
        end, before = _differential_at(rest, box)
        if before:  # \int dx f(x): the differential comes first
            variable = read_differential(reader, without_thin(rest), 0)
            if variable is None:
                raise FormulaError(box.at, "the differential of the integral is not clear", "write d and its letter")
            inner_row = without_thin(rest)[variable[1] :]
            further, start = _further(reader, inner_row, 0)
            inner: Node = reader.expression(inner_row[start:]) if inner_row[start:] else number(1)
            differential, behind = variable[0], len(row)
        else:
            inner, differential = _taken_out(reader.expression(rest[:end]), box)
            behind, further = place + 1 + end, []
            if behind < len(row) and row[behind].kind == "bracket" and simple_argument(row[behind].parts[0]):
                way_out = "write the differential last, or \\cdot"  # d\nu(x)
                raise left_open(row[behind], "the bracket belongs to the differential", way_out)
    finally:
        reader.integrating -= 1
    assert isinstance(differential, Call)
    bounds: list[Node] = []
    if box.sub is not None and box.sup is not None:
        bounds = [reader.expression(box.sub), reader.expression(box.sup)]
        _mark_bounds(reader, inner, differential.args[0], bounds)
    elif box.sub is not None or box.sup is not None:
        bounds = [_region(reader, box)]
    variable_of = differential.args[0] if len(differential.args) == 1 else differential
    name = variable_of.name.replace("lamda", "lambda") if isinstance(variable_of, Letter) else ""
    if any(isinstance(each, Call) and name in each.name.split("_")[1:] for each in walk(inner)):  # B_\lambda(T)
        reader.guess("index", f"the index {name} of a function is part of its name, and is not integrated over")
    if not reader.integrating and not before:
        further, behind = _further(reader, row, behind)
    if further:
        if len(bounds) > 1:
            why = "two differentials follow one integral"
            raise FormulaError(box.at, why, "write as many integrals as differentials")
        variable_of = Call("volume", (variable_of, *further))
    return Call("Integral", (inner, variable_of, *bounds)), behind


def _mark_bounds(reader: FormulaReader, inner: Node, variable: Node, bounds: list[Node]) -> None:
    r"""Mark bounds that may be of another letter, on which what is integrated over depends: \int_a^b dF."""
    name = variable.name.split("_")[0] if isinstance(variable, Letter) else ""
    known, alone = reader.notation, inner == number(1)
    depends = name in known.applied | known.differentiated or (alone and name[:1].isupper())
    held = {each.name.split("_")[0].lower() for bound in bounds for each in walk(bound) if isinstance(each, Letter)}
    if depends and (alone or name not in VARIABLES - {"u", "v"}) and name.lower() not in held:
        reader.guess("bounds", f"the bounds of the integral are values of {name}")


def _region(reader: FormulaReader, box: Box) -> Letter:
    """What an integral is over, as a name."""
    return Letter("over_" + "_".join(re.findall(r"\w+", reader.source[(box.sub or box.sup or [box])[0].at : box.end])))


def _further(reader: FormulaReader, row: list[Box], place: int) -> tuple[list[Node], int]:
    """What else is integrated over, y and z of dx dy dz, and the place behind."""
    variables: list[Node] = []
    while True:
        start = next((k for k in range(place, len(row)) if row[k].kind != "thin"), len(row))
        begins = start < len(row) and (row[start].name == "d" or is_measure(row[start]))
        made = read_differential(reader, row, start) if begins else None
        if made is None or not isinstance(made[0], Call):
            return variables, place
        variables.append(made[0].args[0] if len(made[0].args) == 1 else made[0])
        place = made[1]


def _differential_at(rest: list[Box], box: Box) -> tuple[int, bool]:
    """Where the integral's differential ends, and whether it comes first."""
    inner = 0
    first = next((k for k, b in enumerate(rest) if b.kind != "thin"), None)
    for place, each in enumerate(rest):
        inner += each.kind == "big" and BIG.get(each.name) == "Integral"
        target = next((k for k in range(place + 1, len(rest)) if rest[k].kind != "thin"), place)
        held = ("letter", "group", "function", *(("bracket",) if each.upright else ()))
        plain = (is_d(each, "d") or is_measure(each)) and target > place and rest[target].kind in held
        if not plain and not has_differential_above(each):
            continue
        if inner:
            inner -= 1
        elif plain:
            end = behind_function(rest, target)
            return end, place == first and any(b.kind != "thin" for b in rest[end:])
        else:
            return (len(rest) if place == first else place + 1), False
    raise FormulaError(box.at, "the differential of the integral is missing", "write d and its letter")


def _taken_out(node: Node, box: Box) -> tuple[Node, Node]:
    """What is integrated, and the differential that is a factor of it."""
    if isinstance(node, Call):
        if node.name == "differential":
            return number(1), node
        if node.name in ("negative", "quotient"):
            inner, found = _taken_out(node.args[0], box)
            return Call(node.name, (inner, *node.args[1:])), found
        if node.name in ("product", "matmul"):
            for place, each in enumerate(node.args):
                if _holds(each):
                    inner, found = _taken_out(each, box)
                    rest = [*node.args[:place], *([] if inner == number(1) else [inner]), *node.args[place + 1 :]]
                    ordered = node.name == "matmul" and len(rest) > 1
                    return Call("matmul", tuple(rest)) if ordered else product_of(rest or [number(1)]), found
        if node.name in ("sum", "dot", "cross") and _holds(last := node.args[-1]):
            if node.name != "sum" and any(is_differential(each) and is_vector(each) for each in walk(last)):  # F·dr
                return node, next(filter(is_differential, walk(last)))
            inner, found = _taken_out(last, box)
            return Call(node.name, (*node.args[:-1], inner)), found
    raise FormulaError(box.at, "the differential is no factor of what is integrated", "write it at the end")


def _holds(node: Node) -> bool:
    return isinstance(node, Call) and (
        node.name == "differential"
        or (node.name in ("product", "matmul", "quotient", "negative", "sum") and any(map(_holds, node.args)))
    )


def holds_variation(node: Node) -> bool:
    """Whether it holds a small change, delta Q, which may stand beside a differential."""
    return any(isinstance(each, Letter) and each.name.startswith("delta_") for each in walk(node))


def differential_degree(node: Node, at: int) -> int:
    """How many differentials its terms have as factors. Raises FormulaError where the terms of a sum have not as many."""
    if not isinstance(node, Call):
        return 0
    if node.name == "differential":
        return 1
    degrees = [differential_degree(each, at) for each in node.args]
    if node.name in ("product", "dot", "cross", "matmul", "contraction"):
        return sum(degrees)
    if node.name == "quotient":
        return degrees[0] - degrees[1]
    if node.name == "power" and isinstance(node.args[1], Number):
        return int(degrees[0] * node.args[1].value)
    if node.name in ("sum", "plus_minus", "minus_plus", "column"):
        terms = {d for d, each in zip(degrees, node.args, strict=True) if not is_printed_zero(each)}
        if len(terms) > 1 and not holds_variation(node):
            raise FormulaError(at, "a differential stands in one term only", "write what is added in each")
        return max(terms, default=0)
    return degrees[0] if node.name in ("negative", "Sum", "Abs", "norm", "sqrt", "transpose") and degrees else 0
