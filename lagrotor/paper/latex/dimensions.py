"""The dimensions of a paper's letters as its equations need them: each sum is of like terms, dots are per t.

The dimension of a letter is unknown, that of t too; each equation gives linear relations between the logarithms. Only units that
are printed, and ℏ and k_B, are known not to be numbers: where a relation says that they are, the equation contradicts those
before. So a text of pure numbers is never judged, and a letter only where relations lead to a unit. A number that is a side, a
decimal, or a term other than 1 may be a quantity without its unit: such an equation says nothing. Whole factors are numbers.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import reduce

from lagrotor.errors import InputError
from lagrotor.paper.latex.displays import Displayed
from lagrotor.paper.latex.sentence import MEANING, said_of
from lagrotor.paper.latex.statements import PrintedStatement
from lagrotor.paper.latex.tree import Letter, Node, Number, is_vector, letters_of, rational_value, text_of, walk
from lagrotor.paper.units import dimension_of

Row = dict[str, Fraction]
# A base unit stands in brackets, a letter without.
_QUANTITIES = {"hbar": "J s", "k_B": "J/K"}
_NUMBERS = ("sin", "cos", "tan", "cot", "sinh", "cosh", "tanh", "exp", "log", "asin", "acos", "atan")
_KEEPING = ("negative", "norm", "Abs", "mean", "transpose", "differential", "plus_minus", "minus_plus")


class _UnknownError(Exception):
    """A dimension that cannot be given."""


class _Chapter:
    """The dimensions that the equations of a chapter need: rows, each of which gives one letter by others and by units."""

    def __init__(self, numbers: Collection[str]) -> None:
        """numbers: letters of quantities to which the paper gives the value 1."""
        self.rows = {name: _unit(unit) for name, unit in _QUANTITIES.items() if name not in numbers}
        self.pending: list[tuple[Row, str]] = []

    def add(self, sides: Iterable[Node]) -> str | None:
        """Take over an equation; return a sentence where it contradicts those before, and leave it out then."""
        self.pending, new = [], list[str]()
        try:
            self._alike([side for side in sides if not _is_zero(side)], "the sides", 0)
        except _UnknownError:
            return None
        for row, where in self.pending:
            for letter, value in self.rows.items():  # a row has no letters of the rows before it
                if letter in row:
                    row = _plus(_without(row, letter), value, row[letter])
            free = next((each for each in row if each[0] != "["), None)
            if free is not None:
                self.rows[free] = {other: -value / row[free] for other, value in _without(row, free).items()}
                new.append(free)
            elif row:
                for letter in new:
                    del self.rows[letter]
                return f"{where} have different dimensions"
        return None

    def _alike(self, nodes: list[Node], where: str, number: int) -> Row:
        """Return the dimension of all nodes; a number among them is unknown unless it is `number`."""
        values = [rational_value(each) for each in nodes if not letters_of(each)]
        if any(value is None or abs(value) != number for value in values):
            raise _UnknownError
        rows = [self._of(each) for each in nodes]
        self.pending += [(_plus(rows[0], row, -1), where) for row in rows[1:]]
        return rows[0] if rows else {}

    def _of(self, node: Node) -> Row:
        """Return the dimension of a node; conditions on its parts are added to `pending`."""
        if isinstance(node, Letter):
            return _letter(node.name)
        if isinstance(node, Number):
            if node.value.denominator != 1:
                raise _UnknownError
            return {}
        name, args = node.name, node.args
        if (name in _KEEPING and len(args) == 1) or name == "Sum":
            return self._of(args[0])
        if name in ("sum", "plus_minus", "minus_plus"):
            return self._alike([each for each in args if not _is_zero(each)], f"the terms of {text_of(node)}", 1)
        if name in ("product", "dot", "cross", "matmul"):
            measured = any(letter.startswith("unit_") for letter in letters_of(node))
            parts = (self._of(each) for each in args if not (measured and isinstance(each, Number)))
            return reduce(_plus, parts, Row())
        if name == "quotient":
            return _plus(self._of(args[0]), self._of(args[1]), -1)
        if name == "sqrt":
            return _plus({}, self._of(args[0]), Fraction(1, 2))
        if name == "power":
            base, exponent = self._of(args[0]), rational_value(args[1])
            if base and exponent is None:
                raise _UnknownError
            return _plus({}, base, exponent or 0)
        if name in _NUMBERS:
            self.pending.append((self._of(args[0]), f"the argument of {name} and a number"))
            return {}
        return self._of_analysis(name, args)

    def _of_analysis(self, name: str, args: tuple[Node, ...]) -> Row:
        """Return the dimension of a derivative or an integral."""
        if name == "rate":
            return _plus(self._of(args[0]), {"t": Fraction(1)}, -1)
        if name == "Derivative":
            times = rational_value(args[2]) if len(args) > 2 else None
            return _plus(self._of(args[0]), self._of(args[1]), -(times or 1))
        if name == "Integral" and len(args) in (2, 4):
            return _plus(self._of(args[0]), self._of(args[1]))
        raise _UnknownError


def _letter(name: str) -> Row:
    if name in ("pi", "imaginary_unit"):
        return {}
    if name in ("oo", "all", "otherwise"):
        raise _UnknownError
    if name.startswith("unit_"):
        return _unit(name.removeprefix("unit_"))
    dots = re.search(r"_(d*)dot$", name)
    if dots:
        return _plus({name[: dots.start()]: Fraction(1)}, {"t": Fraction(1)}, -(len(dots[1]) + 1))
    return {name: Fraction(1)}


def _unit(text: str) -> Row:
    try:
        powers = dimension_of(text).as_powers_dict()
    except InputError:
        raise _UnknownError from None
    return {f"[{base}]": Fraction(int(power)) for base, power in powers.items() if base != 1}


def _plus(a: Row, b: Row, times: int | Fraction = 1) -> Row:
    total = {name: a.get(name, Fraction(0)) + times * b.get(name, Fraction(0)) for name in (*a, *b)}
    return {name: value for name, value in total.items() if value}


def _without(row: Row, name: str) -> Row:
    return {other: value for other, value in row.items() if other != name}


def _is_zero(node: Node) -> bool:
    return isinstance(node, Number) and node.value == 0 and not is_vector(node)


def other_dimensions(
    statements: Iterable[tuple[Displayed, PrintedStatement]],
    values: Iterable[tuple[str, list[Node]]],
    words: Mapping[str, str],
) -> Iterator[tuple[Displayed, str]]:
    """Find equations whose dimensions contradict those of the others.

    Each chapter is compared with itself. An equation is reported if no other one that contradicts its chapter has a letter of
    it: a letter that several equations need otherwise has another meaning there.

    Parameters
    ----------
    statements : iterable of tuple
        Each equation with a statement of it.
    values : iterable of tuple
        Sections, and sides of equations in the text that may give a unit: m = 2 kg.
    words : Mapping[str, str]
        Equation id to the words beside it.

    Yields
    ------
    tuple of Displayed and str
        The equation, and the parts whose dimensions differ.
    """
    printed = [row for row in statements if row[1].kind in ("equation", "approximation", "inequality")]
    rows: list[tuple[str, list[Node], Displayed | None]] = [(section, sides, None) for section, sides in values]
    rows += [(each.section, _without_values(statement), each) for each, statement in printed]
    numbers = {
        side.name
        for _, sides, _ in rows
        if any(isinstance(side, Number) for side in sides)
        for side in sides
        if isinstance(side, Letter)
    }
    chapters: defaultdict[str, _Chapter] = defaultdict(lambda: _Chapter(numbers))
    broken: list[tuple[str, Displayed, set[str], str]] = []
    for section, sides, each in rows:
        chapter = section.split(".")[0]
        if (why := chapters[chapter].add(sides)) is not None and each is not None:
            letter = next((side.name for side in sides if isinstance(side, Letter)), "")
            why += f", unless {letter} has another meaning here" if letter else ""
            broken.append((chapter, each, {name for side in sides for name in letters_of(side)}, why))
    counts = Counter((chapter, name) for chapter, _, names, _ in broken for name in names)
    for chapter, each, names, why in broken:
        if all(counts[chapter, name] == 1 for name in names) and not said_of(words.get(each.id, ""), MEANING):
            yield each, why


def _without_values(statement: PrintedStatement) -> list[Node]:
    """Return the sides but for those behind ≈ with a number of their own, which may be quantities without a unit."""
    nodes = [side.node for side in statement.sides]
    numbers = [{each for each in walk(node) if isinstance(each, Number)} for node in nodes]
    pairs = zip(statement.relations, numbers, numbers[1:], nodes[1:], strict=False)
    return [nodes[0], *(node for relation, before, after, node in pairs if relation != "~" or after <= before)]
