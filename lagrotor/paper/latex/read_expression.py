r"""Sums and products: which sign joins what; \\cdot and \\times of vectors and of numbers."""

from collections.abc import Callable
from itertools import pairwise

from lagrotor.paper.latex.boxes import FUNCTIONS, Box, FormulaError, left_open
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_bracket import (
    read_accent,
    read_binomial,
    read_bracket,
    read_cases,
    read_group,
    read_infinity,
    read_matrix,
    read_root,
)
from lagrotor.paper.latex.read_derivative import (
    at_its_variable,
    in_integral,
    is_differential,
    is_open_integral,
    read_along,
    read_fraction,
    read_nabla,
    read_partial,
    read_square,
)
from lagrotor.paper.latex.read_function import read_function
from lagrotor.paper.latex.read_letter import is_called, read_letter
from lagrotor.paper.latex.read_number import read_number, read_unit
from lagrotor.paper.latex.read_sum import read_sum
from lagrotor.paper.latex.rows import (
    ENDING,
    TENSOR,
    ends_integral,
    ends_with_bracket,
    fold_derivatives,
    pair_bars,
    refuse_words,
    strip,
)
from lagrotor.paper.latex.tree import (
    Call,
    Node,
    is_matrix,
    is_numeric,
    is_operator,
    is_printed_zero,
    is_vector,
    may_be_vector,
    product_of,
)


def _read_dots(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    """Dots for terms, entries or factors that are left out."""
    if len(row) > 1:
        beside = [b.kind for b in (*row[max(place - 1, 0) : place], *row[place + 1 : place + 2])]
        if len(beside) < 2 or not {*beside} <= {"letter", "bracket", "fraction", "group"}:
            raise FormulaError(row[place].at, "dots stand for factors", "write them, or as a product")
        reader.guess("dots", "the dots stand for factors that are left out, and for no part of a list")
    return Call("dots", ()), place + 1


Factor = Callable[[FormulaReader, list[Box], int], tuple[Node, int]]
_FACTORS: dict[str, Factor] = {
    "number": read_number, "unit": read_unit, "letter": read_letter, "bracket": read_bracket, "group": read_group,
    "root": read_root, "binomial": read_binomial, "infinity": read_infinity, "accent": read_accent, "matrix": read_matrix,
    "cases": read_cases, "fraction": read_fraction, "partial": read_partial, "nabla": read_nabla, "function": read_function,
    "big": read_sum, "dots": _read_dots, "square": read_square,
}  # fmt: skip


# What has a power at most.
_WITHOUT_INDEX = {
    "infinity": "∞", "root": "a root", "binomial": "a binomial", "group": "a group", "accent": "what is no letter",
    "matrix": "a matrix", "fraction": "a fraction",
}  # fmt: skip


class Grammar(FormulaReader):
    """Sums of products of factors."""

    def expression(self, row: list[Box]) -> Node:
        """The sum that a row of boxes is. Raises FormulaError where it is none."""
        row = pair_bars(strip(row))
        if not row:
            raise FormulaError(0, "nothing stands here", "write what is meant")
        terms: list[tuple[str, list[Box]]] = []
        sign = "+"
        part: list[Box] = []
        for place, box in enumerate(row):
            if box.kind == "operator" and box.name in ("+", "-", "pm", "mp"):
                last = part[-1] if part else None
                if (last is None and (terms or sign != "+")) or (last and last.kind == "operator" and last.name != "!"):
                    raise FormulaError(box.at, "two signs follow each other", "write brackets around the second")
                if last is None:
                    sign = box.name
                    continue
                if is_open_integral(part) and any(map(ends_integral, row[place:])):
                    part.append(box)
                    continue
                terms.append((sign, part))
                sign, part = box.name, []
            else:
                part.append(box)
        if not strip(part):
            raise FormulaError(row[-1].at, "nothing follows the sign", "write what is added")
        terms.append((sign, part))
        return _added(self, terms)

    def term(self, row: list[Box]) -> Node:
        """The product that a row of boxes is."""
        row = fold_derivatives(row, "d" not in self.notation.bare and "d" not in self.notation.letters)
        if row and row[-1].kind == "operator" and row[-1].name != "!":
            raise FormulaError(row[-1].at, f"nothing follows {row[-1].name}", "write the second factor")
        groups: list[tuple[str, list[Box]]] = [("", [])]
        for box in row:
            if (
                box.kind == "operator"
                and box.name in ("cdot", "times", "/", "*")
                and not in_integral(groups[-1][1])
                and not (box.name in ("cdot", "times") and (last := strip(groups[-1][1])) and last[-1].kind == "nabla")
            ):
                if not strip(groups[-1][1]):
                    raise FormulaError(box.at, f"nothing is before {box.name}", "write the first factor")
                groups.append((box.name, []))
            else:
                groups[-1][1].append(box)
        made: Node | None = None
        for place, (operator, part) in enumerate(groups):
            made = _joined(self, made, operator, part, groups[place - 1][1] if place else [])
        assert made is not None
        return made

    def product(self, row: list[Box]) -> Node:
        """Factors side by side."""
        row = strip(row)
        if not row:
            raise FormulaError(0, "a factor is missing", "write it")
        refuse_words(row)
        factors: list[Node] = []
        place = 0
        while place < len(row):
            if row[place].kind == "thin":
                place += 1
                continue
            _numbers_apart(row, place)
            node, behind = self.factor(row, place)
            if row[place].kind == "fraction" and behind < len(row) and row[behind].kind == "bracket":
                node, behind = at_its_variable(self, row, place, behind, node)
            factors.append(node)
            place = behind
        ends = isinstance(factors[-1], Call) and factors[-1].name.startswith("operator_")  # numbers times d/dx
        if any(map(is_operator, factors[: -1 if ends else None])) and len(factors) > 1:
            return Call("matmul", tuple(factors))  # in this order
        vectors = [each for each in factors if is_vector(each)]
        if self.integrating and len(vectors) == 2 and factors[-1] is vectors[1] and is_differential(factors[-1]):
            self.guess("line", "the vector before the differential of a vector is multiplied by it with a dot")
            return Call("dot", (product_of(factors[:-1]), factors[-1]))  # \int\vec F d\vec r
        if self.exponents and len(vectors) == 2 and not any(map(is_matrix, vectors)):
            self.guess("matrix", "vectors side by side in an exponent are multiplied with a dot")
            return product_of([*(each for each in factors if not is_vector(each)), Call("dot", tuple(vectors))])
        if len(vectors) > 1:
            return _matrices(factors, row)
        if _is_contracted(row, (self.notation.upper - self.notation.exponents) | (self.above or set())):
            return Call("contraction", tuple(factors))
        return product_of(factors)

    def factor(self, row: list[Box], place: int) -> tuple[Node, int]:
        """One factor and the place behind it."""
        box = row[place]
        named = box.upright and len(box.name) > 1 and box.name in FUNCTIONS and not box.marks  # {\rm cos}
        reader = read_function if named else _FACTORS.get(box.kind)
        if (
            box.kind == "function"
            and box.name == "Re"
            and (box.sub or place + 1 >= len(row) or row[place + 1].kind in ENDING)
        ):
            self.guess("words", "Re is a number of its own, and no real part")
            reader = read_letter
        if reader is None:
            why = f"{self.source[box.at : box.end]} is not read here"
            raise FormulaError(box.at, why, "write what it stands for")
        if box.sub is not None and box.kind in _WITHOUT_INDEX:
            raise FormulaError(box.at, f"{_WITHOUT_INDEX[box.kind]} has an index", "write it on the letter")
        node, behind = reader(self, row, place)
        while behind < len(row) and row[behind].name == "!":
            twice = behind + 1 < len(row) and row[behind + 1].name == "!"
            node, behind = Call("double_factorial" if twice else "factorial", (node,)), behind + 1 + twice
        return node, behind


def _added(reader: FormulaReader, terms: list[tuple[str, list[Box]]]) -> Node:
    made: list[Node] = []
    for sign, part in terms:
        term = reader.term(part)
        if sign == "-":
            term = Call("negative", (term,))
        elif sign in ("pm", "mp"):
            rest = made and (made[0] if len(made) == 1 else Call("sum", tuple(made)))
            term = Call("plus_minus" if sign == "pm" else "minus_plus", (rest, term) if rest else (term,))
            made = []
        made.append(term)
    if len(made) == 1:
        return made[0]
    _check_sums(terms)
    kinds = {is_vector(each) for each in made if not is_printed_zero(each) and each != Call("dots", ())}
    if len(kinds) > 1 and all(is_vector(n) or may_be_vector(n) for n in made):
        reader.guess("vector", "what has a hat, or is the divergence of a tensor, is a vector")
    elif len(kinds) > 1 and not any(isinstance(n, Call) and n.name == "order" for n in made):
        raise FormulaError(terms[1][1][0].at, "a vector and a number are added", "mark the vectors alike")
    return Call("sum", tuple(made))


def _check_sums(terms: list[tuple[str, list[Box]]]) -> None:
    """A term behind a sum that has its index: whether the sum ends before it is not clear."""
    indices: set[str] = set()
    for _, part in terms:
        indexed = any(b.kind == "letter" and b.sub and any(s.name in indices for s in b.sub) for b in part)
        if indexed and not any(b.kind == "big" for b in part):
            raise left_open(part[0], "the sum ends here", "write brackets around what is summed")
        for box in part:
            if box.kind == "big" and box.name in ("sum", "prod") and box.sub:
                indices |= {s.name for s in box.sub if s.kind == "letter"}


def _joined(reader: FormulaReader, made: Node | None, operator: str, part: list[Box], before: list[Box]) -> Node:
    if operator == "/":
        part, before = strip(part), strip(before)
        if (
            part
            and before
            and all(b.kind == "letter" and b.upright and len(b.name) == 1 for b in (part[0], before[-1]))
        ):
            raise left_open(part[0], "upright letters are a unit", "write \\mathrm{m/s}")
        right = reader.product(part)
        factors = _count(reader, part)
        assert made is not None
        if factors > 1 and not _is_one_divisor(reader, part):
            raise FormulaError(part[0].at, "what the slash divides by is open", "write \\frac or brackets")
        if len([b for b in before if b.kind == "function"]) and not ends_with_bracket(before):
            raise left_open(part[0], "the slash is within the function", "write brackets")
        if is_vector(right):
            raise FormulaError(part[0].at, "a vector is divided by", "write its length")
        return Call("quotient", (made, right))
    if operator == "cdot" and made is not None and is_vector(made) and strip(part):
        advection = read_along(reader, made, strip(part))
        if advection is not None:
            return advection
    right = reader.product(strip(part))
    if made is None:
        return right
    return _vector_product(made, operator, right, part[0].at, before)


def _is_one_divisor(reader: FormulaReader, part: list[Box]) -> bool:
    """Whether several factors divide by custom: 2\u03c0 and kT anywhere, and in an exponent all that follows the slash."""
    names = [box.name for box in part]
    plain = all(box.kind in ("number", "letter") for box in part)
    custom = (len(part) == 2 and plain and part[0].kind == "number" and names[1] == "pi") or names == ["k", "T"]
    if custom or (reader.exponents and plain):
        reader.guess("slash", "all that follows the slash divides")
        return True
    return False


def _vector_product(made: Node, operator: str, right: Node, at: int, before: list[Box]) -> Node:
    """Two factors joined by a dot, a cross or a star, of vectors or of numbers."""
    left_vector, right_vector = is_vector(made), is_vector(right)
    reaches = bool(before) and before[0].kind == "nabla" and isinstance(made, Call) and made.name == "advection"
    if reaches or any(b.kind == "nabla" and b.sup is None and c.kind == "operator" for b, c in pairwise(before)):
        raise FormulaError(at, "how far ∇ reaches is open", "write brackets around what it acts on")
    if left_vector and right_vector:
        if operator not in ("cdot", "times"):
            raise FormulaError(at, "two vectors are multiplied by *", "write \\cdot or \\times")
        if operator == "times" and any(isinstance(side, Call) and side.name == "matrix" for side in (made, right)):
            raise FormulaError(at, "× stands between matrices", "write them side by side")
        if operator == "times" and isinstance(made, Call) and made.name == "cross" and not ends_with_bracket(before):
            raise FormulaError(at, "which × comes first is open", "write brackets")
        return Call("dot" if operator == "cdot" else "cross", (made, right))
    if (
        operator == "cdot"
        and right_vector
        and isinstance(made, Call)
        and made.name == "dot"
        and not ends_with_bracket(before)
    ):
        raise FormulaError(at, "which · comes first is open", "write brackets")  # a tensor between vectors
    other = made if right_vector else right if left_vector else None  # F(r) \cdot d\vec r
    if operator == "cdot" and isinstance(other, Call) and len(other.name.split("_")[0]) == 1:
        raise FormulaError(at, f"whether {other.name} is a vector is open", "mark the vectors alike")
    if operator == "times" and not (is_numeric(made) or is_numeric(right)):
        raise FormulaError(at, "whether × is of vectors or of numbers is open", "mark the vectors, or write \\cdot")
    return product_of([made, right])


def _count(reader: FormulaReader, part: list[Box]) -> int:
    """How many factors stand there: of dx one, of f(x) one."""
    count = place = 0
    while place < len(part):
        box = part[place]
        if box.kind == "thin":
            return 2 if place + 1 < len(part) else count
        if box.kind == "letter" and box.name in ("d", "delta", "Delta") and place + 1 < len(part):
            place += 1
        elif box.kind == "function":
            return count + 1 if place == 0 else 2
        elif box.kind == "bracket" and place and part[place - 1].kind == "letter":
            count -= is_called(reader, part[place - 1], box) is True
        count += 1
        place += 1
    return count


def _is_contracted(row: list[Box], upper: set[str]) -> bool:
    """Whether an index stands up and down in a product, and is summed over."""
    held = [box for box in row if box.kind in ("letter", "partial", "nabla")]
    up = {each.name for box in held if box.sup for each in box.sup if each.name in TENSOR or each.name in upper}
    return bool(up) and any(each.name in up for box in held if box.sub for each in box.sub)


def _matrices(factors: list[Node], row: list[Box]) -> Node:
    """Matrices times vectors, side by side; two vectors side by side are not read."""
    scalars = [each for each in factors if not is_vector(each)]
    others = [each for each in factors if is_vector(each)]
    if not all(map(is_matrix, others[:-1])):
        raise FormulaError(row[0].at, "two vectors stand side by side", "write \\cdot or \\times between them")
    made = Call("matmul", tuple(others))
    return product_of([*scalars, made])


def _numbers_apart(row: list[Box], place: int) -> None:
    """Numbers side by side are groups of digits, or not read."""
    before, box = row[place - 1] if place else None, row[place]
    if before is None:
        return
    if box.kind == "number" and before.kind == "number":
        raise FormulaError(box.at, "two numbers stand side by side", "write \\cdot between them")
    called = before.kind == "bracket" and place > 1 and row[place - 2].kind == "letter" and not box.sup
    if box.kind == "number" and (called or before.kind in ("letter", "root", "group")):
        raise FormulaError(box.at, "a number stands behind a letter", "write it first, or braces where it is a script")
    parts = [each for part in box.parts for each in part] if box.kind == "fraction" else []
    if before.kind == "number" and before.sup is None and parts and all(each.kind == "number" for each in parts):
        raise left_open(box, "a mixed number or a product is meant", "write \\cdot between them")
