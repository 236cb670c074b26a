"""Checks of what is handed to this room: scalar expressions, with the symbols that are zero by assumption replaced."""

from typing import Any

import sympy as sp

from lagrotor.algebra.enclosures import enclosure
from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError, NotExactError

# Deeper expressions exhaust the stack, larger ones the memory; equal parts count as often as they occur.
_MOST_DEPTH, _MOST_NODES = 150, 1_000_000


def sympified(value: Any, name: str) -> Any:
    """A sympy object; raise InputError, on behalf of the function `name`, where there is none. No text is parsed."""
    try:
        return sp.sympify(value, strict=True)
    except sp.SympifyError:
        raise InputError(f"{name}: {value!r} is not an expression: give a sympy expression or a number") from None


def scalar(value: Any, name: str) -> sp.Expr:
    """A scalar expression; raise InputError where there is none, NotExactError where it is too large or too deep."""
    expression = sympified(value, name)
    if not isinstance(expression, sp.Expr) or isinstance(expression, sp.MatrixExpr):
        raise InputError(f"{name}: {value!r} is not a scalar expression: give a sympy expression or a number")
    zeros = {symbol: sp.S.Zero for symbol in _sizes(expression) if symbol.is_Symbol and symbol.is_zero}
    check_names(name, expression)
    return expression.xreplace(zeros) if zeros else expression


def _sizes(expression: sp.Basic) -> dict[sp.Basic, tuple[int, int]]:
    """Every different part of an expression that is neither too large nor too deep, with its nodes and its depth."""
    sizes: dict[sp.Basic, tuple[int, int]] = {}
    stack = [(expression, False)]
    while stack:
        node, ready = stack.pop()
        if node in sizes:
            continue
        if not node.args:
            sizes[node] = 1, 1
        elif ready:
            below, depths = zip(*(sizes[argument] for argument in node.args), strict=True)
            sizes[node] = 1 + sum(below), 1 + max(depths)
        else:
            stack.append((node, True))
            stack += [(argument, False) for argument in node.args if argument not in sizes]
    nodes, depth = sizes[expression]
    if depth > _MOST_DEPTH:
        raise NotExactError(f"The expression is nested more than {_MOST_DEPTH} deep.")
    if nodes > _MOST_NODES:
        raise NotExactError(f"The expression has more than {_MOST_NODES:,} parts.")
    return sizes


def node_count(expression: sp.Expr) -> int:
    """How many nodes the tree of an expression has, equal ones counted as often as they occur."""
    return _sizes(expression)[expression][0]


def degree(expression: sp.Expr) -> int:
    """A bound on its degree in its letters and functions, as a quotient, and on those of their arguments."""
    degrees: dict[sp.Basic, int] = {}
    largest = 0
    for node in sp.postorder_traversal(expression):
        below = [degrees[argument] for argument in node.args]
        if node.is_Add:
            degrees[node] = max(below)
        elif node.is_Mul:
            degrees[node] = sum(below)
        elif node.is_Pow and node.exp.is_Rational:
            degrees[node] = degrees[node.base] * int(sp.ceiling(abs(node.exp)))
        else:
            degrees[node] = int(not getattr(node, "is_number", True))
        largest = max(largest, degrees[node])
    return largest


def split_content(e: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return a number that is certainly not zero and the expression divided by it, such that no number is in all terms."""
    common: dict[sp.Expr, sp.Rational] | None = None
    terms = sp.Add.make_args(e)
    for term in terms:
        numbers = (f for f in sp.Mul.make_args(term) if f.is_number and not f.is_Rational and not f.has(sp.Float))
        powers = dict((f, sp.S.One) if f.is_Pow and f.base.is_Rational else f.as_base_exp() for f in numbers)
        common = {
            base: min(power, (common or powers)[base])
            for base, power in powers.items()
            if power.is_Rational and power > 0 and base in (powers if common is None else common)
        }
        if not common:
            break
    number = sp.Mul(*(base**power for base, power in (common or {}).items() if _is_apart(base)))
    quotient = e if number == 1 else sp.Add(*(term / number for term in terms))
    content, quotient = quotient.primitive() if quotient.is_Add else quotient.as_coeff_Mul(rational=True)
    return (number * content, quotient) if content else (sp.S.One, e)


def _is_apart(number: sp.Expr) -> bool:
    """Return whether a number is certainly real and not zero."""
    huge = number.is_Pow and number.exp.is_Integer  # written, not evaluated
    between = None if huge else enclosure(number, {})
    return between is not None and (between[0] > 0 or between[1] < 0)
