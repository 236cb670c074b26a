"""Conversion of the text of expressions into tapes. The checker evaluates the words of a theorem themselves."""

import ast
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from operator import add, mul, sub, truediv
from typing import Any

from lagrotor.errors import NotProved
from lagrotor.proofs.checker.tapes import Tape, demand, read_tape, results_of
from lagrotor.proofs.tape import OPERATIONS

_LONGEST = 20_000  # characters
_LARGEST = 10_000  # integer exponent
_INNER = "ⴰ"  # a character that occurs in no expression
_EXACTLY: dict[Any, Any] = {ast.Add: add, ast.Sub: sub, ast.Mult: mul, ast.Div: truediv}
_JOINED = {ast.Add: "add", ast.Sub: "subtract", ast.Mult: "multiply", ast.Div: "divide"}


def tape_of_words(named: Sequence[Any], arguments: Sequence[str], observed: Any) -> Tape:
    """Convert expressions to a tape. A row is {of: text}, or {of: name, means: text} for an expression with a name."""
    words = Words(arguments, observed)
    meanings: dict[str, str] = {}
    for row in named:
        if "means" in row:
            name = row["of"]
            free = name.isidentifier() and name not in words.names and name not in _FUNCTIONS
            demand(free, f"the name of an expression is taken or invalid: {name[:60]!r}")
            words.constants.pop(name, None)
            demand(meanings.setdefault(name, row["means"]) == row["means"], f"{name} has two meanings")
    places = [words.place(row.get("means", row["of"])) for row in named]
    return words.tape(places)


class Words:
    """The operations of some expressions, each recorded once.

    `names` gives the place of each argument and observable, `constants` the places of E and pi.
    """

    def __init__(self, arguments: Sequence[str], observed: Any) -> None:
        self.arguments = [*arguments]
        self.operations: list[list[Any]] = [["argument", i] for i in range(len(arguments))]
        self._places = {tuple(operation): place for place, operation in enumerate(self.operations)}
        self.constants = dict(_CONSTANTS)
        self.names = {name: i for i, name in enumerate(arguments)}
        if observed:
            tape, names = read_tape(observed), observed["names"]
            fits = tape["arguments"] == list(arguments) and len({*names} - {*arguments}) == len(tape["outputs"])
            demand(fits, "the names of the observables do not fit the motion")
            self.names |= dict(zip(names, self.include(tape), strict=True))
        plain = not any(re.search(r"^\d|[\s+*/().-]", name) or name in {"pi", *_FUNCTIONS} for name in self.names)
        demand(plain, "the name of a state or observable is an expression")

    def include(self, tape: Tape) -> list[int]:
        """Add the operations of a tape, whose arguments are matched by name, and return the places of its outputs."""
        names = tape["arguments"]
        places = results_of(tape, lambda i: self.names[names[i]], lambda x: self.keep("number", x), self.keep)
        return [places[place] for place in tape["outputs"]]

    def keep(self, *operation: Any) -> int:
        place = self._places.setdefault(operation, len(self.operations))
        if place == len(self.operations):
            self.operations.append(list(operation))
        return place

    def place(self, text: str) -> int:
        """Return the place of an expression's value; the text is parsed, never run. Raises NotProved if it cannot be read."""
        demand(len(text) <= _LONGEST, f"an expression has more than {_LONGEST} characters")
        order = sorted(self.names, key=len, reverse=True)
        pattern = "|".join(map(re.escape, order)) or r"(?!)"
        word = rf"(?<![\w\\}}])(?:{pattern})(?![\w{{}}'(])"
        marked = re.sub(word, lambda hit: f"{_INNER}{order.index(hit[0])}", text)
        places = {f"{_INNER}{i}": self.names[name] for i, name in enumerate(order)}
        try:
            if _INNER in text or not re.fullmatch(r"[\w +\-*/().]*", marked):
                raise ValueError(marked)
            return self._place(ast.parse(marked.strip(), mode="eval").body, places)
        except (SyntaxError, ValueError, RecursionError, MemoryError, ZeroDivisionError):
            raise NotProved(f"check: the expression {text[:60]!r} cannot be read") from None

    def _place(self, node: ast.expr, names: Mapping[str, int]) -> int:
        if (value := _rational(node)) is not None:
            return self.keep("number", str(value))
        match node:
            case ast.Name(id=name) if name in names:
                return names[name]
            case ast.Name(id=name) if name in self.constants:
                return self.constants[name](self)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self.keep("subtract", self.keep("number", "0"), self._place(operand, names))
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(self._place(left, names), right, names)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _JOINED:
                return self.keep(_JOINED[type(op)], self._place(left, names), self._place(right, names))
            case ast.Call(func=ast.Name(id=name), args=[operand], keywords=[]) if name in _FUNCTIONS:
                return _FUNCTIONS[name](self, self._place(operand, names))
        raise ValueError(ast.dump(node)[:60])

    def _power(self, base: int, exponent: ast.expr, names: Mapping[str, int]) -> int:
        value = _rational(exponent)
        if value is None or value.denominator > 2:
            return self.keep("exp", self.keep("multiply", self._place(exponent, names), self.keep("log", base)))
        if abs(value) > _LARGEST:
            raise ValueError("exponent")
        place = self._whole(base, abs(value.numerator) // value.denominator)
        if value.denominator == 2:
            place = self.keep("multiply", place, self.keep("sqrt", base))
        return place if value >= 0 else self.keep("divide", self.keep("number", "1"), place)

    def _whole(self, base: int, power: int) -> int:
        if power < 2:
            return base if power else self.keep("number", "1")
        half = self._whole(base, power // 2)
        square = self.keep("multiply", half, half)
        return self.keep("multiply", square, base) if power % 2 else square

    def over(self, above: int, below: int) -> int:
        return self.keep("divide", above, below)

    def slope(self, place: int, direction: Mapping[int, int]) -> int:
        """Add the derivative of a result along a direction, and return the place.

        `direction` maps an argument to the place of a component; all other components are zero.
        """
        zero, needed = self.keep("number", "0"), self.below([place])
        slopes = {at: direction.get(at, zero) for at in needed}
        for at in sorted(needed):
            name, *on = self.operations[at]
            if name in OPERATIONS and any(slopes[x] != zero for x in on):
                slopes[at] = self._slope(at, name, on, [slopes[x] for x in on])
        return slopes[place]

    def tape(self, places: Sequence[int]) -> Tape:
        """Return a tape with these results as outputs; operations that they do not need are replaced by zero."""
        needed, operations = self.below(places), [*self.operations]
        for place in {*range(len(operations))} - needed:
            operations[place] = ["number", "0"]
        return {"arguments": self.arguments, "operations": operations, "outputs": [*places]}

    def below(self, places: Sequence[int]) -> set[int]:
        """Return the given places and all places that they depend on."""
        needed = {*places}
        for at in range(max(places, default=-1), -1, -1):
            name, *on = self.operations[at]
            if at in needed and name in OPERATIONS:
                needed.update(on)
        return needed

    def _slope(self, at: int, name: str, on: Sequence[int], by: Sequence[int]) -> int:
        if name in ("add", "subtract"):
            return self.keep(name, *by)
        if name == "multiply":
            return self.keep("add", self.keep(name, by[0], on[1]), self.keep(name, on[0], by[1]))
        if name == "divide":
            return self.over(self.keep("subtract", by[0], self.keep("multiply", at, by[1])), on[1])
        (a,), unit = on, self.keep("number", "1")
        if name == "sqrt":  # √a a'/(2 a), comparable without an identity of roots
            return self.over(self.keep("multiply", at, by[0]), self.keep("add", a, a))
        if name in ("log", "asin", "atan"):
            square = self.keep("multiply", a, a)
            complement = self.keep("add" if name == "atan" else "subtract", unit, square)
            root = self.keep("sqrt", complement) if name == "asin" else complement
            return self.over(by[0], a if name == "log" else root)
        if name == "cos":
            return self.keep("subtract", self.keep("number", "0"), self.keep("multiply", self.keep("sin", a), by[0]))
        return self.keep("multiply", at if name == "exp" else self.keep("cos", a), by[0])

    def exponential_sum(self, name: str, x: int) -> int:
        """Add exp(x) + exp(−x) for "add", the difference for "subtract", and return the place."""
        rise = self.keep("exp", x)
        return self.keep(name, rise, self.over(self.keep("number", "1"), rise))


def _rational(node: ast.expr) -> Fraction | None:
    """Return a number written with + − * / alone; None for any other expression."""
    match node:
        case ast.Constant(value=int(value)) if not isinstance(value, bool):
            return Fraction(value)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            below = _rational(operand)
            return None if below is None else -below
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() as op, right=right):
            a, b = _rational(left), _rational(right)
            if a is not None and b is not None:
                return _EXACTLY[type(op)](a, b)
    return None


_ONE = ("number", "1")
_CONSTANTS: dict[str, Any] = {"pi": lambda w: w.keep("number", "pi"), "E": lambda w: w.keep("exp", w.keep(*_ONE))}
_FUNCTIONS: dict[str, Any] = {
    **{name: lambda w, x, name=name: w.keep(name, x) for name, count in OPERATIONS.items() if count == 1},
    "tan": lambda w, x: w.over(w.keep("sin", x), w.keep("cos", x)),
    "cot": lambda w, x: w.over(w.keep("cos", x), w.keep("sin", x)),
    "sec": lambda w, x: w.over(w.keep("number", "1"), w.keep("cos", x)),
    "csc": lambda w, x: w.over(w.keep("number", "1"), w.keep("sin", x)),
    "acos": lambda w, x: w.keep("subtract", w.over(w.keep("number", "pi"), w.keep("number", "2")), w.keep("asin", x)),
    "sinh": lambda w, x: w.over(w.exponential_sum("subtract", x), w.keep("number", "2")),
    "cosh": lambda w, x: w.over(w.exponential_sum("add", x), w.keep("number", "2")),
    "tanh": lambda w, x: w.over(w.exponential_sum("subtract", x), w.exponential_sum("add", x)),
}
