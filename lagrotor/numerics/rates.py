"""A program as the rate that a solver calls with one state at a time: Python floats, and nothing done twice.

What depends on the parameters alone is worked out once, squares are products, and no call stands between the solver and
the program: three quarters of the time that `compile_program` and a wrapper around it take.
"""

import math
from collections.abc import Callable
from typing import Any

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from .codegen import Program, reduce_common
from .engines import Rate


class _Products(PythonCodePrinter):  # type: ignore[misc]
    """Python in which a small power of a symbol is a product."""

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> Any:
        if expr.base.is_Symbol and expr.exp in (2, 3):
            return f"({'*'.join([self._print(expr.base)] * int(expr.exp))})"
        return super()._print_Pow(expr, rational=rational)


def rate_factory(program: Program, states: int) -> Callable[..., Rate]:
    """parameters → rate(s, y), for a program whose first `states` arguments are the state.

    A state outside the coordinates' reach gives NaN, which makes a solver shorten its step.
    """
    stages, outputs = reduce_common(program)
    show = _Products({"fully_qualified_modules": False}).doprint
    state, parameters = program.arguments[:states], program.arguments[states:]
    fixed, moving, known = [], [], set(parameters)
    for name, expression in stages:
        if expression.free_symbols <= known:
            known.add(name)
            fixed.append(f"    {name} = {show(expression)}")
        else:
            moving.append(f"            {name} = {show(expression)}")
    source = [
        f"def make({', '.join(map(str, parameters))}):",
        *fixed,
        "    def rate(s, y):",
        "        try:",
        f"            {', '.join(map(str, state))} = y.tolist()",
        *moving,
        f"            return [{', '.join(map(show, outputs))}]",
        "        except (ValueError, ZeroDivisionError, OverflowError):",
        f"            return [nan] * {len(outputs)}",
        "    return rate",
    ]
    names = dict(vars(math))
    exec("\n".join(source), names)
    return names["make"]
