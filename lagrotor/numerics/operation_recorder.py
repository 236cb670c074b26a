"""Numbers that record the operations on them, so that a numerical function becomes a line of source for each operation.

Arrays of them (dtype object) go through numpy's sums, products and functions, as long as nothing branches on a value.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeAlias

Term: TypeAlias = "Recorded | float"
_LONGEST = 160  # characters from which an expression gets a name


@dataclass(eq=False)
class Recorded:
    """The result of a recorded operation. Its kind is "+", "-", "*", "/", "neg" or the name of a function of the operands;
    without operands it is the name of an argument. The tape holds all results of one record in the order of their computation."""

    tape: list[Recorded] = field(repr=False)
    kind: str
    operands: tuple[Term, ...] = ()

    def __post_init__(self) -> None:
        self.tape.append(self)

    def _with(self, kind: str, *operands: Term) -> Recorded:
        return Recorded(self.tape, kind, operands)

    def __add__(self, term: Term) -> Recorded:
        return self if term == 0 else self._with("+", self, term)

    __radd__ = __add__

    def __sub__(self, term: Term) -> Recorded:
        return self if term == 0 else self._with("-", self, term)

    def __rsub__(self, term: Term) -> Recorded:
        return -self if term == 0 else self._with("-", term, self)

    def __mul__(self, term: Term) -> Term:
        if term == 0:
            return 0.0
        return self if term == 1 else -self if term == -1 else self._with("*", term, self)

    __rmul__ = __mul__

    def __truediv__(self, term: Term) -> Recorded:
        return self._with("/", self, term)

    def __rtruediv__(self, term: Term) -> Recorded:
        return self._with("/", term, self)

    def __neg__(self) -> Recorded:
        return self._with("neg", self)

    def sqrt(self) -> Recorded:
        """Record a square root; numpy calls this method, `sin`, `cos` and `hypot`."""
        return self._with("sqrt", self)

    def sin(self) -> Recorded:
        return self._with("sin", self)

    def cos(self) -> Recorded:
        return self._with("cos", self)

    def hypot(self, term: Term) -> Recorded:
        return self._with("hypot", self, term)


sqrt = Recorded.sqrt


def lines(outputs: Iterable[Term], tape: list[Recorded]) -> tuple[list[str], list[str]]:
    """Return source lines that give a name to each number that is used more than once, and the text of each output."""
    terms, used = list(outputs), dict[Recorded, int]()
    for x in terms:
        _count(x, used)
    for x in reversed(tape):
        if x in used:
            for operand in x.operands:
                _count(operand, used)
    texts, statements = dict[Recorded, str](), list[str]()
    for x in tape:
        if x in used:
            texts[x] = _text(x, texts)
            if x.operands and (used[x] > 1 or len(texts[x]) > _LONGEST):
                statements.append(f"t{len(statements)} = {texts[x]}")
                texts[x] = f"t{len(statements) - 1}"
    return statements, [texts[x] if isinstance(x, Recorded) else repr(float(x)) for x in terms]


def _count(x: Term, used: dict[Recorded, int]) -> None:
    if isinstance(x, Recorded):
        used[x] = used.get(x, 0) + 1


def _text(x: Recorded, texts: dict[Recorded, str]) -> str:
    operands = [texts[operand] if isinstance(operand, Recorded) else repr(float(operand)) for operand in x.operands]
    if x.kind in "+-*/":
        return f"({x.kind.join(operands)})"
    return f"(-{operands[0]})" if x.kind == "neg" else f"{x.kind}({', '.join(operands)})" if operands else x.kind
