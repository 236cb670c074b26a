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

from lagrotor.errors import InputError
from lagrotor.paper.latex.displays import Displayed
from lagrotor.paper.latex.sentence import MEANING, said_of
from lagrotor.paper.latex.statements import PrintedStatement
from lagrotor.paper.latex.tree import Call, Letter, Node, Number, is_vector, letters_of, text_of, walk
from lagrotor.paper.units import dimension_of

Row = dict[str, Fraction]
# A base unit stands in brackets, a letter without.
_QUANTITIES = {"hbar": "J s", "k_B": "J/K"}
_NUMBERS = ("sin", "cos", "tan", "cot", "sinh", "cosh", "tanh", "exp", "log", "asin", "acos", "atan")


class _UnknownError(Exception):
    """A dimension that cannot be given."""


class FormulaDimensions:
    """What the equations so far say: rows, each of which gives a letter by letters that no row gives and by units."""

    def __init__(self, numbers: Collection[str] = ()) -> None:
        """numbers: letters of quantities to which the paper gives the value 1."""
        self.rows: dict[str, Row] = {}
        self.used_by: defaultdict[str, set[str]] = defaultdict(set)  # letter → rows that have it
        self.pending: list[tuple[Row, str]] = []
        for name, unit in _QUANTITIES.items():
            if name not in numbers:
                self._put(name, _unit(unit))

    def add(self, sides: Iterable[Node]) -> str | None:
        """Take in an equation; a sentence where it contradicts those before, and then it is left out."""
        self.pending = []
        try:
            self._alike([side for side in sides if not _is_zero(side)], "the sides", 0)
        except _UnknownError:
            return None
        before: list[tuple[str, Row | None]] = []
        for row, where in self.pending:
            reduced = self._reduced(row)
            name = next((each for each in reduced if each[0] != "["), None)
            if name is not None:
                factor = -reduced.pop(name)
                given = {other: value / factor for other, value in reduced.items()}
                for of in (*self.used_by[name], name):
                    old = self.rows.get(of)
                    before.append((of, old))
                    self._put(of, given if old is None else _plus(_without(old, name), given, old[name]))
            elif reduced:
                for of, old in reversed(before):
                    self._put(of, old)
                return f"{where} have different dimensions"
        return None

    def _reduced(self, row: Row) -> Row:
        made: Row = {}
        for name, value in row.items():
            made = _plus(made, self.rows.get(name, {name: Fraction(1)}), value)
        return made

    def _put(self, name: str, row: Row | None) -> None:
        """What gives a letter; None: nothing does."""
        for letter in self.rows.pop(name, {}):
            self.used_by[letter].discard(name)
        if row is not None:
            self.rows[name] = row
            for letter in row:
                self.used_by[letter].add(name)

    def _alike(self, nodes: list[Node], where: str, number: int) -> Row:
        """The dimension of all; number: what may stand alone among them."""
        values = [_rational(each) for each in nodes if not letters_of(each)]
        if any(value is None or abs(value) != number for value in values):
            raise _UnknownError
        rows = [self._of(each) for each in nodes]
        self.pending += [(_plus(rows[0], row, -1), where) for row in rows[1:]]
        return rows[0] if rows else {}

    def _of(self, node: Node) -> Row:
        """The dimension of a node; what it needs within is kept as pending."""
        if isinstance(node, Number):
            if node.value.denominator != 1:
                raise _UnknownError
            return {}
        if isinstance(node, Letter):
            return _letter(node.name)
        if (
            node.name in ("negative", "norm", "Abs", "mean", "transpose", "plus_minus", "minus_plus")
            and len(node.args) == 1
        ):
            return self._of(node.args[0])
        if node.name in ("sum", "plus_minus", "minus_plus"):
            terms = [each for each in node.args if not _is_zero(each)]
            return self._alike(terms, f"the terms of {text_of(node)}", 1)
        if node.name in ("product", "dot", "cross", "matmul"):
            total: Row = {}
            measured = any(name.startswith("unit_") for name in letters_of(node))
            for each in node.args:
                if measured and isinstance(each, Number):
                    continue
                total = _plus(total, self._of(each))
            return total
        if node.name == "quotient":
            return _plus(self._of(node.args[0]), self._of(node.args[1]), -1)
        if node.name == "sqrt":
            return {n: v / 2 for n, v in self._of(node.args[0]).items()}
        if node.name == "power":
            return self._power(node)
        if node.name in _NUMBERS:
            self.pending.append((self._of(node.args[0]), f"the argument of {node.name} and a number"))
            return {}
        return self._analysis(node)

    def _power(self, node: Call) -> Row:
        base, exponent = node.args
        inner = self._of(base)
        value = _rational(exponent)
        if value is None:
            if inner:
                raise _UnknownError
            return {}
        return {n: v * value for n, v in inner.items()}

    def _analysis(self, node: Call) -> Row:
        """Derivatives, integrals, sums and rates."""
        if node.name == "rate":
            return _plus(self._of(node.args[0]), {"t": Fraction(1)}, -1)
        if node.name == "Derivative":
            times = _rational(node.args[2]) if len(node.args) > 2 else Fraction(1)
            return _plus(self._of(node.args[0]), self._of(node.args[1]), -(times or Fraction(1)))
        if node.name == "differential" and len(node.args) == 1:
            return self._of(node.args[0])
        if node.name == "Integral" and len(node.args) in (2, 4):
            return _plus(self._of(node.args[0]), self._of(node.args[1]))
        if node.name == "Sum":
            return self._of(node.args[0])
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
    made = dict(a)
    for name, value in b.items():
        made[name] = made.get(name, Fraction(0)) + times * value
    return {name: value for name, value in made.items() if value}


def _without(row: Row, name: str) -> Row:
    return {other: value for other, value in row.items() if other != name}


def _rational(node: Node) -> Fraction | None:
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Call) and node.name in ("negative", "quotient"):
        parts = [_rational(each) for each in node.args]
        if None in parts:
            return None
        first = parts[0] or Fraction(0)
        return -first if node.name == "negative" else first / (parts[1] or Fraction(1))
    return None


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
    chapters: defaultdict[str, FormulaDimensions] = defaultdict(lambda: FormulaDimensions(numbers))
    broken: list[tuple[str, Displayed, set[str], str]] = []
    for section, sides, each in rows:
        chapter = section.split(".")[0]
        if (why := chapters[chapter].add(sides)) is not None and each is not None:
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
