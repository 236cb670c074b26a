"""The value of an expression as it is written, for the second program: its words are held to the operations that it checks."""

import ast
import re
from collections.abc import Mapping
from typing import Any

from flint import arb, fmpz

from lagrotor.errors import NotProved

Ball = Any
_LONGEST = 20_000  # characters
_FUNCTIONS = (
    "sqrt",
    "exp",
    "log",
    "sin",
    "cos",
    "tan",
    "sec",
    "csc",
    "cot",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
)
_CONSTANTS = {"pi": arb.pi, "E": arb.const_e}
_JOINED: dict[Any, Any] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}


def value_of(text: str, names: Mapping[str, Ball]) -> Ball:
    """Of numbers, names, + − * / ** and the functions that a tape has. Raises NotProved for anything else; nothing runs."""
    if len(text) > _LONGEST:
        raise NotProved(f"check: an expression has more than {_LONGEST} characters")
    order = sorted(names, key=len, reverse=True)
    known = "|".join(map(re.escape, order)) or r"(?!)"
    put = re.sub(rf"(?<![\w\\}}])(?:{known})(?![\w{{}}'(])", lambda hit: f"v_{order.index(hit[0])}", text)
    try:
        if not re.fullmatch(r"[\w +\-*/().]*", put):
            raise ValueError(put)
        return _value(ast.parse(put.strip(), mode="eval").body, {f"v_{i}": names[name] for i, name in enumerate(order)})
    except (SyntaxError, ValueError, RecursionError, MemoryError, ZeroDivisionError):
        raise NotProved(f"check: the expression {text[:60]!r} cannot be read") from None


def _value(node: ast.expr, names: Mapping[str, Ball]) -> Ball:
    match node:
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]()
        case ast.Constant(value=int(value)) if not isinstance(value, bool):
            return arb(fmpz(value))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, names)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return _power(_value(left, names), _value(right, names))
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _JOINED:
            return _JOINED[type(op)](_value(left, names), _value(right, names))
        case ast.Call(func=ast.Name(id=name), args=[operand], keywords=[]) if name in _FUNCTIONS:
            return getattr(_value(operand, names), name)()
    raise ValueError(ast.dump(node)[:60])


def _power(base: Ball, exponent: Ball) -> Ball:
    whole = exponent.unique_fmpz()
    if whole is None:
        return base.sqrt() if exponent == arb(0.5) else base**exponent
    return base ** int(whole) if whole >= 0 else 1 / base ** int(-whole)
