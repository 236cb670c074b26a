"""A generated program as a tape of elementary operations with exact constants.

An operation is (name, operand, …); its operands are places of earlier results. A tape is plain data for a certificate.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.numerics.codegen import Program, reduce_common
from lagrotor.proofs.balls import rational

Operation = tuple[Any, ...]
# Name → number of operands. The operand of "argument" is an index, that of "number" a text.
_FUNCTIONS = ("sqrt", "exp", "log", "sin", "cos", "asin", "atan")
OPERATIONS = {"add": 2, "subtract": 2, "multiply": 2, "divide": 2} | dict.fromkeys(_FUNCTIONS, 1)


@dataclass(frozen=True)
class Tape:
    """The names of the arguments, the operations in order, and the places of the outputs."""

    arguments: tuple[str, ...]
    operations: tuple[Operation, ...]
    outputs: tuple[int, ...]

    def data(self) -> dict[str, Any]:
        operations = [list(operation) for operation in self.operations]
        return {"arguments": list(self.arguments), "operations": operations, "outputs": list(self.outputs)}


class Recorder:
    """The operations of expressions, each recorded once."""

    def __init__(self, arguments: Sequence[str]) -> None:
        self.arguments = tuple(arguments)
        self.operations: list[Operation] = []
        self._places: dict[Operation, int] = {}
        self._known: dict[sp.Basic, int] = {}

    def keep(self, *operation: Any) -> int:
        if operation[0] in ("add", "multiply"):
            operation = (operation[0], *sorted(operation[1:]))
        place = self._places.get(operation)
        if place is None:
            place = self._places[operation] = len(self.operations)
            self.operations.append(operation)
        return place

    def number(self, value: Any) -> int:
        if value is sp.pi:
            return self.keep("number", "pi")
        return self.keep("number", str(rational(value, "a number in the equations")))

    def name(self, symbol: sp.Symbol, place: int) -> None:
        """Let a symbol denote the result at a place of the tape."""
        self._known[symbol] = place

    def record(self, e: sp.Expr) -> int:
        place = self._known.get(e)
        if place is None:
            place = self._known[e] = self._new(e)
        return place

    def _new(self, e: sp.Expr) -> int:
        if e.is_Rational or e.is_Float or e is sp.pi:
            return self.number(e)
        if e is sp.E:
            return self.keep("exp", self.number(1))
        if e.is_Add:
            return self._sum(e)
        if e.is_Mul:
            return self._product(e)
        if e.is_Pow:
            return self._power(e.base, e.exp)
        rule = _RULES.get(type(e))
        if rule is None:
            raise InputError(
                f"proofs: {type(e).__name__} in the equations has no rigorous series here; rational functions, roots, exp, log, "
                "sin, cos, tan, asin, acos, atan, sinh, cosh and tanh have"
            )
        return rule(self, self.record(e.args[0]))

    def _sum(self, e: sp.Expr) -> int:
        plus = [a for a in e.args if not a.could_extract_minus_sign()]
        minus = [-a for a in e.args if a.could_extract_minus_sign()]
        places = [self.record(a) for a in plus]
        total = places[0] if places else self.number(0)
        for place in places[1:]:
            total = self.keep("add", total, place)
        for a in minus:
            total = self.keep("subtract", total, self.record(a))
        return total

    def _product(self, e: sp.Expr) -> int:
        below = [a for a in e.args if a.is_Pow and a.exp.could_extract_minus_sign()]
        above = [a for a in e.args if a not in below]
        total = self._times([self.record(a) for a in above])
        if below:
            total = self.keep("divide", total, self._times([self._power(a.base, -a.exp) for a in below]))
        return total

    def _times(self, places: Sequence[int]) -> int:
        total = places[0] if places else self.number(1)
        for place in places[1:]:
            total = self.keep("multiply", total, place)
        return total

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        if base is sp.E:
            return self.keep("exp", self.record(exponent))
        if exponent.could_extract_minus_sign():
            return self.keep("divide", self.number(1), self._power(base, -exponent))
        place = self.record(base)
        if exponent.is_Integer:
            return self._whole(place, int(exponent))
        if exponent.is_Rational and exponent.q == 2:
            root = self.keep("sqrt", place)
            return root if exponent.p == 1 else self.keep("multiply", self._whole(place, int(exponent.p) // 2), root)
        return self.keep("exp", self.keep("multiply", self.record(exponent), self.keep("log", place)))

    def _whole(self, place: int, power: int) -> int:
        if power == 1:
            return place
        half = self._whole(place, power // 2) if power > 1 else self.number(1)
        square = self.keep("multiply", half, half)
        return self.keep("multiply", square, place) if power % 2 else square


def _hyperbolic(r: Recorder, x: int) -> tuple[int, int]:
    e = r.keep("exp", x)
    return e, r.keep("divide", r.number(1), e)


def _halved(r: Recorder, name: str, x: int) -> int:
    return r.keep("divide", r.keep(name, *_hyperbolic(r, x)), r.number(2))


def _tanh(r: Recorder, x: int) -> int:
    rise, fall = _hyperbolic(r, x)
    return r.keep("divide", r.keep("subtract", rise, fall), r.keep("add", rise, fall))


def _acos(r: Recorder, x: int) -> int:
    right = r.keep("divide", r.number(sp.pi), r.number(2))
    return r.keep("subtract", right, r.keep("asin", x))


_RULES: dict[Any, Any] = {
    **{f: lambda r, x, name=f.__name__: r.keep(name, x) for f in (sp.sin, sp.cos, sp.exp, sp.log, sp.asin, sp.atan)},
    sp.tan: lambda r, x: r.keep("divide", r.keep("sin", x), r.keep("cos", x)),
    sp.cot: lambda r, x: r.keep("divide", r.keep("cos", x), r.keep("sin", x)),
    sp.sec: lambda r, x: r.keep("divide", r.number(1), r.keep("cos", x)),
    sp.csc: lambda r, x: r.keep("divide", r.number(1), r.keep("sin", x)),
    sp.acos: _acos,
    sp.sinh: lambda r, x: _halved(r, "subtract", x),
    sp.cosh: lambda r, x: _halved(r, "add", x),
    sp.tanh: _tanh,
}


def tape_of(program: Program) -> Tape:
    recorder = Recorder([str(s) for s in program.arguments])
    for i, s in enumerate(program.arguments):
        recorder.name(s, recorder.keep("argument", i))
    stages, outputs = reduce_common(program)
    for name, e in stages:
        recorder.name(name, recorder.record(e))
    places = [recorder.record(e) for e in outputs]
    return _needed(tuple(recorder.arguments), recorder.operations, places)


def select_outputs(first: Tape, others: Sequence[int]) -> Tape:
    return _needed(first.arguments, first.operations, [first.outputs[i] for i in others])


def with_pace(tape: Tape, states: int) -> Tape:
    """Return the tape of the motion in s = t / pace: each output is multiplied by the pace, a new argument after the states."""
    operations: list[Operation] = []
    for name, *on in tape.operations:
        operations.append(("argument", on[0] + (on[0] >= states)) if name == "argument" else (name, *on))
    operations.append(("argument", states))
    pace = len(operations) - 1
    outputs = []
    for place in tape.outputs:
        outputs.append(len(operations))
        operations.append(("multiply", place, pace))
    arguments = (*tape.arguments[:states], "pace", *tape.arguments[states:])
    return Tape(arguments, tuple(operations), tuple(outputs))


def _needed(arguments: tuple[str, ...], operations: Sequence[Operation], outputs: Sequence[int]) -> Tape:
    """Return the tape without operations that no output needs."""
    needed = set(outputs)
    for place in reversed(range(len(operations))):
        name, *operands = operations[place]
        if place in needed and name in OPERATIONS:
            needed.update(operands)
    order = {place: i for i, place in enumerate(sorted(needed))}
    rows = []
    for place in order:
        name, *operands = operations[place]
        rows.append((name, *((order[p] for p in operands) if name in OPERATIONS else operands)))
    return Tape(arguments, tuple(rows), tuple(order[p] for p in outputs))
