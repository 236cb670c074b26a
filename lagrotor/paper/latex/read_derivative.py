r"""Fractions and derivatives: \frac{dx}{dt}, \partial_x u, \nabla f."""

import re
from dataclasses import replace
from itertools import pairwise

from lagrotor.paper.latex.boxes import BIG, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_scripts import letter_of, mark_of, power_of, stands_alone
from lagrotor.paper.latex.rows import (
    DIVISORS,
    TENSOR,
    VARIABLES,
    all_boxes,
    derivative_mark,
    ends_integral,
    is_d,
    is_derivative_operator,
    is_measure,
    letters_in_row,
    strip,
    without_thin,
)
from lagrotor.paper.latex.tree import Call, Letter, Node, Number, is_vector, number, walk
from lagrotor.paper.latex.usage import arguments, index_of, name_of, power_in, simple_argument

_INDICES = (*TENSOR, "alpha", "beta", "gamma", "i", "j", "k", "l", "m", "n", "a", "b", "c", "d")


def behind_function(row: list[Box], place: int) -> int:
    r"""The place behind x of dx, and behind \ln m of d\ln m."""
    if row[place].kind != "function":
        return place + 1
    return min(place + 2 + (place + 1 < len(row) and row[place + 1].kind == "thin"), len(row))


def read_differential(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    """dx, d^3 x."""
    box = row[place]
    if box.upright and box.primes:
        raise FormulaError(box.at, "a differential has a prime", "write what it means")
    behind = next((k for k in range(place + 1, len(row)) if row[k].kind != "thin"), len(row))
    after = row[behind] if behind < len(row) else None
    if box.upright and box.sup is None and after is not None and after.kind == "bracket" and after.sup is None:
        return Call("differential", (reader.expression(after.parts[0]),)), behind + 1
    if after is not None and after.kind == "function" and box.sup is None and (box.upright or reader.integrating):
        inner, behind = reader.factor(row[: behind_function(row, behind)], behind)
        return Call("differential", (inner,)), behind
    if after is None or after.kind not in ("letter", "group"):
        if box.upright and "d" not in reader.notation.letters:
            raise FormulaError(box.at, "an upright d has no letter", "write the letter behind it")
        return None
    counted = all(b.kind == "number" or (reader.integrating and b.name.isupper()) for b in box.sup or ())  # d^{3N} r
    if box.primes or "d" in reader.notation.letters or not counted:
        return None
    if not box.upright and "d" in reader.notation.bare and not reader.integrating:
        if stands_alone(reader, "d"):
            raise left_open(box, "d is a letter or a differential", "write \\mathrm{d} for the differential")
        reader.guess("differential", "d before a letter is its differential, and no factor", 'letters = "d"')
    if row[behind].kind == "group":
        inner, behind = reader.expression(row[behind].parts[0]), behind + 1
        return Call("differential", (inner,)), behind
    target = row[behind]
    node, raised = letter_of(reader, target)
    if target.sup is not None and not raised:
        if box.sup or [b.name for b in target.sup] != ["2"]:
            raise FormulaError(target.at, "a differential has a power", "write brackets around it")
        node = letter_of(reader, replace(target, sup=None))[0]
        reader.guess("square", "ds^2 is the square of ds")
        return Call("power", (Call("differential", (node,)), number(2))), behind + 1
    if is_measure(box):
        reader.guess("differential", "the integral is over functions, with their measure D")
        return Call("differential", (Call("measure", (node,)),)), behind + 1
    args = (node, reader.expression(box.sup)) if box.sup else (node,)
    return Call("differential", args), behind + 1


def read_fraction(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box = row[place]
    if marks := derivative_mark(box):
        return _derivative(reader, row, place, marks)
    first, second = (without_thin(part)[:1] for part in box.parts)
    if first and second and first[0].name == second[0].name and first[0].name in ("d", "D") and len(box.parts[1]) > 1:
        raise left_open(box, "the fraction is a derivative", "write a letter below, \\frac{d f}{d x}")
    over, under = (reader.expression(part) for part in box.parts)
    if any(map(is_differential, walk(under))) and not any(map(is_differential, walk(over))):
        raise FormulaError(box.at, "a differential stands below and none above", "write \\frac{d f}{d x}")
    if is_vector(under):
        raise FormulaError(box.at, "a vector is divided by", "write its length")
    return power_of(reader, Call("quotient", (over, under)), box), place + 1


def _derivative(reader: FormulaReader, row: list[Box], place: int, mark: str) -> tuple[Node, int]:
    box = row[place]
    over, under = (without_thin(part) for part in box.parts)
    order = _order(over[0])
    variables = _variables(reader, under, mark, order)
    if sum(n for _, n in variables) != order:
        raise FormulaError(box.at, "the orders of the derivative differ", "write the same order above and below")
    operand = over[1:]
    behind = place + 1
    _mark_derivative(reader, box, mark, operand, without_thin(row[behind:]))
    if operand:
        node = reader.expression(operand)
    elif _stands_alone(reader, row, behind):
        orders = tuple(each for variable, times in variables for each in (variable, number(times)))
        return Call("operator_derivative", orders[:1] if order == 1 else orders), behind
    else:
        node, behind = _operand(reader, row, behind, box)
    if len(variables) == 1 and mark != "partial":
        made = _total_derivative(node, variables[0][0], order)
    else:
        made = node
        for variable, times in variables:
            made = Call("Derivative", (made, *_by(variable, times)))
    return (power_of(reader, made, box) if operand else made), behind


def _mark_derivative(reader: FormulaReader, box: Box, mark: str, operand: list[Box], rest: list[Box]) -> None:
    if operand and operand[0].kind == "letter" and operand[0].sup and power_in(operand[0]):
        reader.guess("derivative", "the power above is differentiated, and is none of the differential")
    if not operand and rest and rest[0].kind == "bracket" and rest[0].name == ".":
        reader.guess("at", "what is differentiated is taken at a place, and the derivative is not taken there")
    if operand and operand[0].kind == "number":
        reader.guess("derivative", "the number above is differentiated, and is no order")
    _mark_arguments(reader, operand or rest, box.parts[1])
    if mark in ("D", "delta"):
        reader.guess("derivative", f"the fraction with {mark} is a derivative like any other")
    if mark == "d" and "times" in reader.notation.seen and [b.name for b in box.parts[1]][1:] == ["t"]:
        reader.guess("dot", "the derivative by t is the rate that a dot has")
    if mark == "d" and [b.name for b in operand] == ["t"]:
        by = set().union(*(letters for stem, letters in reader.notation.varied.items() if stem != "t"))
        if {"t", box.parts[1][-1].name} <= by:
            reader.guess("derivative", "the fraction with dt above is a derivative, and no quotient of two steps")


def _mark_arguments(reader: FormulaReader, operand: list[Box], variables: list[Box]) -> None:
    """Mark a derivative of a function whose arguments do not hold what it differentiates by: it is taken there.

    Of one argument, only where it is a value of that letter, F(m_0) by m.
    """
    if len(operand) > 1 and operand[0].kind == "letter" and operand[1].kind == "bracket":
        by = letters_in_row(variables)
        held = [b for b in all_boxes(operand[1].parts[0]) if b.name in by]
        indexed = [[part.name for part in b.sub] for b in all_boxes(variables) if b.name in by and b.sub]
        value = bool(held) and all(b.sub and [part.name for part in b.sub] not in indexed for b in held)
        if value or (not held and any(b.kind == "comma" for b in operand[1].parts[0])):
            what = f"the value of {operand[0].name} is differentiated, and the derivative is not taken there"
            reader.guess("at", what)


def _order(box: Box) -> int:
    if not box.sup:
        return 1
    if len(box.sup) == 1 and box.sup[0].kind == "number" and box.sup[0].name.isdigit():
        return int(box.sup[0].name)
    raise FormulaError(box.at, "the order of the derivative is no number", "write a number")


def _variables(reader: FormulaReader, under: list[Box], mark: str, order: int = 0) -> list[tuple[Node, int]]:
    found: list[tuple[Node, int]] = []
    place = 0
    while place < len(under):
        if not is_d(under[place], mark) or place + 1 >= len(under) or under[place + 1].kind not in DIVISORS:
            raise FormulaError(under[place].at, "what is differentiated by is not clear", "write \\frac{d f}{d x}")
        target = under[place + 1]
        if target.kind == "partial":  # \partial \partial_\mu \phi, without its brackets
            return [*found, (reader.expression(under[place + 1 :]), 1)]
        if mark == "delta" and place + 2 < len(under) and under[place + 2].kind == "bracket":  # \delta f(x)
            variable, times = reader.expression(under[place + 1 : place + 3]), 1
            place += 1
        elif target.kind != "letter":
            variable, times = reader.expression(target.parts[0]), _order(target)
        else:
            raised = mark_of(reader, target)
            if raised is None and order == 1 and target.sup and all(b.kind == "letter" for b in target.sup):
                raised = index_of(replace(target, sub=target.sup, sup=None))  # of a first derivative, no order
                reader.guess("mark", f"the superscript of {target.name} is part of the name")
            variable = letter_of(reader, replace(target, sup=None))[0]
            if raised and isinstance(variable, Letter):
                variable = Letter(name_of(target, index_of(target) or (), raised), variable.vector)
            times = 1 if raised and target.sup else _order(target)
        found.append((variable, times))
        place += 2
    return found


def _stands_alone(reader: FormulaReader, row: list[Box], place: int) -> bool:
    """Whether a derivative has nothing behind it that it acts on, as in P = -i d/dx: an operator."""
    rest = strip(row[place:])
    found = not reader.integrating and (not rest or rest[0].name in ("+", "-"))
    reader.alone = reader.alone or found
    return found


def _operand(reader: FormulaReader, row: list[Box], place: int, box: Box) -> tuple[Node, int]:
    """What a derivative without an operand above acts on: what follows."""
    rest = strip(row[place:])
    if not rest or rest[0].kind == "operator":
        raise FormulaError(box.at, "the derivative has nothing to act on", "write what is differentiated")
    for k in range(place + 1, len(row) - 1) if reader.integrating else ():  # of the differential it is not taken
        if is_d(row[k], "d") and row[k + 1].kind in ("letter", "group", "thin"):
            return _operand(reader, row[:k], place, box)
    reader.reaching = True
    node, behind = reader.factor(rest, 0)
    remaining = without_thin(rest[behind:])
    if not remaining:
        if isinstance(node, Number):
            reader.guess("reach", "the derivative is of the number that follows it alone")
        return node, len(row)
    if rest[0].kind == "bracket":
        reader.guess("reach", "a derivative acts on the bracket that follows it, not on what is behind")
        return node, len(row) - len(rest) + behind
    if any(b.kind == "fraction" and derivative_mark(b) for b in rest) or any(b.kind == "partial" for b in rest[1:]):
        why = "how far the derivative reaches is open"
        raise FormulaError(box.at, why, "write brackets around what is differentiated")
    reader.guess("reach", "a derivative acts on the whole product that follows it")
    return reader.product(rest), len(row)


def _by(variable: Node, order: int) -> tuple[Node, ...]:
    """What is differentiated by, and how often where that is not once."""
    return (variable, number(order)) if order > 1 else (variable,)


def _total_derivative(node: Node, variable: Node, order: int) -> Node:
    r"""dx/dt as \dot x."""
    if variable == Letter("t") and isinstance(node, Letter) and order <= 2:
        dots = re.search(r"_(d*)dot$", node.name)
        total = order + (len(dots[1]) + 1 if dots else 0)
        if total <= 2:
            stem = node.name[: dots.start()] if dots else node.name
            return Letter(f"{stem}_{'d' * (total - 1)}dot", node.vector)
    if variable == Letter("t") and order == 1 and not isinstance(node, Letter):
        return Call("rate", (node,))
    return Call("Derivative", (node, *_by(variable, order)))


def read_partial(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    r"""\partial_x f, \partial_t^2 u, \partial^\mu f; by itself on a side \partial\Omega, a boundary."""
    box = row[place]
    after = row[place + 1] if place + 1 < len(row) else box
    body = after.kind == "letter" and after.name[0].isupper() and not (after.sup or after.sub or after.marks)
    if body and not (box.sub or box.sup or place or row[2:]):
        reader.guess("boundary", f"∂{after.name} is the boundary of {after.name}")
        return Letter(f"boundary_{after.name}{after.style}"), 2
    index = box.sub or box.sup or []
    above = not box.sub and bool(index) and {b.name for b in index} <= {*_INDICES}
    if not (box.sub or above):
        why = "what ∂ differentiates by is missing"
        raise FormulaError(box.at, why, "write \\partial_x or \\frac{\\partial f}{\\partial x}")
    if len(index) != 1 or index[0].kind != "letter":
        raise FormulaError(box.at, "what ∂ differentiates by is not clear", "write \\frac{\\partial f}{\\partial x}")
    _mark_arguments(reader, without_thin(row[place + 1 :]), index)
    if above or index[0].name not in VARIABLES - {"rho"}:
        reader.guess("index", "the index of ∂ is what it differentiates by")
    order = 1 if above else _order(box)
    variable = Letter(f"x_{index[0].name}") if above else letter_of(reader, index[0])[0]  # \partial^\mu: by x_\mu
    base = index[0].name if isinstance(variable, Letter) and not (above or index[0].sub) else ""
    if base in {*_INDICES} - (reader.notation.bare - reader.lowered) and isinstance(variable, Letter):
        variable = Letter(f"x__{variable.name}")  # \partial_\mu is \partial/\partial x^\mu
    if _stands_alone(reader, row, place + 1):
        return Call("operator_derivative", _by(variable, order)), place + 1
    node, behind = _operand(reader, row, place + 1, box)
    return Call("Derivative", (node, *_by(variable, order))), behind


def read_nabla(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    r"""\nabla f, \nabla^2 f; with \cdot and \times it is not read here."""
    box = row[place]
    if box.sub is not None and (len(box.sub) != 1 or box.sub[0].kind != "letter"):
        raise FormulaError(box.at, "what ∇ differentiates by is not clear", "write one letter below")
    if box.sub:
        reader.guess("index", "the index of \\nabla is what it differentiates by")
    if box.sup and "hessian" in reader.notation.seen:
        reader.guess("laplacian", "\\nabla^2 is the Laplacian, and no matrix of second derivatives")
    by = (letter_of(reader, box.sub[0])[0],) if box.sub else ()
    after = row[place + 1] if place + 1 < len(row) else box
    if after.kind == "operator" and after.name in ("cdot", "times", "wedge") and box.sup is None:
        node, behind = _operand(reader, row, place + 2, box)
        return Call("divergence" if after.name == "cdot" else "curl", (node, *by)), behind
    if (box.sup is None or _order(box) == 2) and _stands_alone(reader, row, place + 1):
        return Call("operator_laplacian" if box.sup else "operator_gradient", by), place + 1
    node, behind = _operand(reader, row, place + 1, box)
    if box.sup is not None:
        if _order(box) != 2:
            raise FormulaError(box.at, "a power of ∇ is not read", "write the derivatives")
        return Call("laplacian", (node, *by)), behind
    if is_vector(node):
        raise FormulaError(box.at, "∇ of a vector is not read", "write \\cdot or \\times")
    if after.kind == "letter" and place + 2 < len(row) and row[place + 2].kind == "bracket":
        letters = [b for b in all_boxes(row[place + 2].parts[0]) if b.kind == "letter"]
        if letters and all(b.sub for b in letters):
            reader.guess("at", f"the value of {after.name} is differentiated, and the gradient is not taken there")
    if "wedge" in reader.notation.seen:
        reader.guess("gradient", "\\nabla gives a gradient, and no product with vectors and planes")
    return Call("gradient", (node, *by)), behind


def read_square(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    r"""\Box f."""
    if row[place].sub or row[place].sup:
        raise FormulaError(row[place].at, "a power of \\Box is not read", "write the derivatives")
    node, behind = _operand(reader, row, place + 1, row[place])
    return Call("dalembertian", (node,)), behind


def read_operators(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int] | None:
    r"""(\nabla^2 + k^2) f as \nabla^2 f + k^2 f: a sum with a derivative of what follows; None where the bracket is none."""
    box, rest = row[place], strip(row[place + 1 :])
    content = without_thin(box.parts[0])
    signs = [k for k, b in enumerate(content) if k and b.kind == "operator" and b.name in ("+", "-")]
    terms = [content[a:b] for a, b in pairwise([0, *signs, len(content)])]
    if box.sub or box.sup or not rest or rest[0].kind in ("operator", "comma") or not any(map(_acts, terms)):
        return None
    if len(terms) == 1 and len(content) > 2 and content[-2].name == "cdot":
        return None  # an advection
    if len(without_thin(rest)) > 1:
        reader.guess("reach", "the operator in brackets acts on all that follows it")
    made: list[Box] = []
    for term in terms:
        inner = next((b for b in term if b.kind == "nabla"), None)
        if inner is not None and not _acts(term):
            raise FormulaError(inner.at, "how far ∇ reaches is open", "write brackets around what it acts on")
        if term[-1].kind == "nabla" and term[-1].sup is None and len(term) > 2 and term[-2].name == "cdot":
            term = [*term[:-3], Box("bracket", "(", term[-3].at, term[-1].end, [term[-3:]], closing=")")]
        made += [*term, Box("group", "", rest[0].at, rest[-1].end, [rest])]
    return reader.expression(made), len(row)


def _acts(term: list[Box]) -> bool:
    """Whether a term ends in a derivative of what follows the bracket."""
    last = term[-1]
    return (last.kind in ("nabla", "square") or (last.kind == "partial" and bool(last.sub))) or (
        last.kind == "fraction" and is_derivative_operator(last)
    )


def read_advection(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    r"""(\vec v\cdot\nabla) of what follows."""
    content = without_thin(row[place].parts[0])
    along = reader.expression(content[:-2])
    if content[-1].sub or content[-1].sup:
        raise FormulaError(content[-1].at, "∇ has an index or a power", "write the derivatives")
    if _stands_alone(reader, row, place + 1):
        return Call("operator_advection", (along,)), place + 1
    node, behind = _operand(reader, row, place + 1, row[place])
    return Call("advection", (node, along)), behind


def read_along(reader: FormulaReader, vector: Node, row: list[Box]) -> Node | None:
    r"""\vec v\cdot\nabla\vec u as (\vec v\cdot\nabla)\vec u; None where what follows the dot is no \nabla of a vector."""
    if row[0].kind != "nabla" or row[0].sub or row[0].sup or len(row) < 2 or row[1].kind == "operator":
        return None
    rest = strip(row[1:])
    node, behind = reader.factor(rest, 0)
    if behind < len(rest) or not is_vector(node):
        return None
    reader.reaching = True
    reader.guess("advection", "v · ∇u of a vector u is (v · ∇)u")
    return Call("advection", (node, vector))


def at_its_variable(reader: FormulaReader, row: list[Box], place: int, behind: int, node: Node) -> tuple[Node, int]:
    r"""\frac{dx}{dt}(t): the bracket is the derivative's own argument; \frac{\partial S}{\partial q}(q, t): it is taken there."""
    box, bracket = row[place], row[behind]
    mark = derivative_mark(box)
    if not mark or len(without_thin(box.parts[0])) == 1 or bracket.name != "(" or not simple_argument(bracket.parts[0]):
        return node, behind
    given = [reader.expression(part) for part in arguments(bracket.parts[0])]
    if given == [_variables(reader, without_thin(box.parts[1]), mark)[0][0]]:
        return node, behind + 1
    if len(given) > 1 and bracket.sup is None:
        return Call("called", (node, *given)), behind + 1
    raise left_open(bracket, "a derivative is taken there or multiplied", "write |_{t = 0} or \\cdot")


def is_open_integral(part: list[Box]) -> bool:
    """Whether an integral's differential is still to come: the sign belongs to what is integrated."""
    opened = 0
    for place, box in enumerate(part):
        if box.kind == "big" and BIG.get(box.name, "") == "Integral":
            opened += 1
        elif opened and ends_integral(box) and (place + 1 < len(part) or box.kind == "fraction"):
            opened -= 1
    return opened > 0


def in_integral(part: list[Box]) -> bool:
    """Whether a sign belongs to what a large sign or d/dx before it acts on."""
    return any(b.kind == "big" for b in part) or bool(
        part and part[0].kind == "fraction" and is_derivative_operator(part[0]) and len(part) == 1
    )


def is_differential(node: Node) -> bool:
    return isinstance(node, Call) and node.name == "differential"
