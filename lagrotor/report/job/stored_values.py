"""Values of derivations as data for JSON: numbers, texts, collections, arrays, sympy expressions of the classes listed here.

The classes stand in a table, so that stored data cannot name anything else.
"""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import sympy as sp

_CLASSES = {
    cls.__name__: cls
    for cls in (
        sp.Add,
        sp.Mul,
        sp.Pow,
        sp.Abs,
        sp.Max,
        sp.Min,
        sp.sin,
        sp.cos,
        sp.tan,
        sp.sinh,
        sp.cosh,
        sp.tanh,
        sp.exp,
    )
}
_CONSTANTS = {"pi": sp.pi, "I": sp.I, "E": sp.E}
_COLLECTIONS: dict[str, Any] = {"list": list, "tuple": tuple, "dict": dict}


def values_as_json(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return those values that can be stored; the script that needs another one runs the derivation again."""
    stored = {}
    for name, value in values.items():
        with suppress(TypeError):
            stored[name] = _as_json(value)
    return stored


def _as_json(value: Any) -> Any:
    """Return a value as JSON data: simple ones as they are, others as [kind, data]. Raise TypeError if it cannot be stored."""
    kind = type(value).__name__
    if value is None or type(value) in (bool, int, float, str):
        return value
    if type(value) in _COLLECTIONS.values():
        return [kind, [_as_json(item) for item in (value.items() if kind == "dict" else value)]]
    if type(value) is np.float64:
        return [kind, float(value)]
    if type(value) is np.ndarray and value.dtype.kind in "fib":
        return [kind, value.tolist(), value.dtype.str]
    if isinstance(value, sp.Basic):
        data = _expression_as_json(value)
        if value_from_json(data) == value:
            return data
    raise TypeError(f"a value of {kind} cannot be stored")


def _expression_as_json(expression: sp.Basic) -> list[Any]:
    if isinstance(expression, sp.Rational):
        return ["Rational", expression.p, expression.q]
    if type(expression) is sp.Symbol:
        return ["Symbol", expression.name, expression.assumptions0]
    for name, constant in _CONSTANTS.items():
        if expression is constant:
            return ["constant", name]
    name = type(expression).__name__
    if _CLASSES.get(name) is not type(expression):
        raise TypeError(f"an expression of {name} cannot be stored")
    return [name, [_expression_as_json(part) for part in expression.args]]


def value_from_json(data: Any) -> Any:
    """Return a stored value. Raises ValueError, TypeError or KeyError if the data have another form."""
    if not isinstance(data, list):
        return data
    kind, *content = data
    if kind in _COLLECTIONS:
        return _COLLECTIONS[kind](map(value_from_json, *content))
    if kind == "float64":
        return np.float64(*content)
    if kind == "ndarray":
        return np.array(content[0], np.dtype(content[1]))
    if kind == "Rational":
        return sp.Rational(*map(int, content))
    if kind == "Symbol":
        return sp.Symbol(str(content[0]), **content[1])
    if kind == "constant":
        return _CONSTANTS[content[0]]
    return _CLASSES[kind](*map(value_from_json, *content), evaluate=False)
