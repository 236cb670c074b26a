"""Checks of what is handed to this room: scalar expressions, with the symbols that are zero by assumption replaced."""

from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotExactError

# Deeper expressions exhaust the stack.
_MOST_DEPTH = 150


def sympified(given: Any, name: str) -> Any:
    """A sympy object; raise InputError, on behalf of the function `name`, where there is none. No text is parsed."""
    try:
        return sp.sympify(given, strict=True)
    except sp.SympifyError:
        raise InputError(f"{name}: {given!r} is not an expression: give a sympy expression or a number") from None


def scalar(given: Any, name: str) -> sp.Expr:
    """A scalar expression; raise InputError where there is none, NotExactError where it is nested too deep."""
    expression = sympified(given, name)
    if not isinstance(expression, sp.Expr) or isinstance(expression, sp.MatrixExpr):
        raise InputError(f"{name}: {given!r} is not a scalar expression: give a sympy expression or a number")
    _check_depth(expression)
    zeros = {symbol: sp.S.Zero for symbol in expression.free_symbols if symbol.is_zero}
    return expression.xreplace(zeros) if zeros else expression


def _check_depth(expression: sp.Basic) -> None:
    left = [(expression, 0)]
    seen: set[sp.Basic] = set()
    while left:
        node, depth = left.pop()
        if depth > _MOST_DEPTH:
            raise NotExactError(f"The expression is nested more than {_MOST_DEPTH} deep.")
        if node not in seen:
            seen.add(node)
            left += [(part, depth + 1) for part in node.args]
