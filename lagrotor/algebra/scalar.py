"""Checks of arguments. An expression must be scalar and of bounded size; symbols that are zero by assumption become 0."""

from typing import Any

import sympy as sp

from lagrotor.algebra.enclosures import enclosure
from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError, NotExactError

# Deeper expressions exhaust the stack, larger ones the memory; repeated nodes count each time.
_MOST_DEPTH, _MOST_NODES = 150, 1_000_000


def sympified(value: Any, name: str) -> Any:
    """Convert a value to a sympy object; raise InputError, with the function's `name`, if that fails. Text is not parsed."""
    try:
        return sp.sympify(value, strict=True)
    except sp.SympifyError:
        raise InputError(f"{name}: {value!r} is not an expression: give a sympy expression or a number") from None


def scalar(value: Any, name: str) -> sp.Expr:
    """Convert a value to a scalar expression; raise InputError if it is none, NotExactError if it is too large or too deep."""
    expression = sympified(value, name)
    if not isinstance(expression, sp.Expr) or isinstance(expression, sp.MatrixExpr):
        raise InputError(f"{name}: {value!r} is not a scalar expression: give a sympy expression or a number")
    zeros = {symbol: sp.S.Zero for symbol in _sizes(expression) if symbol.is_Symbol and symbol.is_zero}
    check_names(name, expression)
    return expression.xreplace(zeros) if zeros else expression


def _sizes(expression: sp.Basic) -> dict[sp.Basic, tuple[int, int]]:
    """Return the number of nodes and the depth of each distinct subexpression; raise NotExactError beyond the bounds."""
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
    """Return the number of nodes in the tree of an expression, with repetitions."""
    return _sizes(expression)[expression][0]


def degree(expression: sp.Expr) -> int:
    """Return an upper bound of the degree of an expression, and of the arguments of functions, in its symbols and functions."""
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
    """Split off the common numerical factor of all terms, and return (number, e / number) with a nonzero number."""
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
    """Return True if a number is certainly real and nonzero."""
    huge = number.is_Pow and number.exp.is_Integer  # not evaluated
    between = None if huge else enclosure(number, {})
    return between is not None and (between[0] > 0 or between[1] < 0)
