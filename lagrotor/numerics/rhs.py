"""A program as the rate that a solver calls with one state at a time: Python floats, and nothing done twice.

What depends on the parameters alone is worked out once, squares are products, and no call stands between the solver and
the program: three quarters of the time that `compile_program` and a wrapper around it take.
"""

import math
from collections.abc import Callable
from typing import Any

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from lagrotor.numerics.codegen import Program, reduce_common
from lagrotor.numerics.integrators import LOST, Rate


class _Products(PythonCodePrinter):  # type: ignore[misc]
    """Python in which a small power of a symbol is a product, and no sum begins with a minus sign that it can do without."""

    def _as_ordered_terms(self, expr: sp.Add, order: Any = None) -> list[sp.Expr]:
        return sorted(super()._as_ordered_terms(expr, order), key=lambda term: term.could_extract_minus_sign())

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> Any:
        if expr.base.is_Symbol and expr.exp in (2, 3):
            return f"({'*'.join([self._print(expr.base)] * int(expr.exp))})"
        return super()._print_Pow(expr, rational=rational)


def rate_factory(program: Program, states: int) -> Callable[..., Rate]:
    """parameters → rate(s, y), for a program whose first `states` arguments are the state.

    A state outside the coordinates' reach gives NaN, which makes a solver shorten its step; `rate.bare`, for a solver that
    cannot, raises one of LOST there instead.
    """
    stages, outputs = reduce_common(program)
    show = _Products({"fully_qualified_modules": False}).doprint
    state, parameters = program.arguments[:states], program.arguments[states:]
    fixed, moving, known = [], [], set(parameters)
    for name, expression in stages:
        if expression.free_symbols <= known:
            known.add(name)
            fixed.append(f"{name} = {show(expression)}")
        else:
            moving.append(f"{name} = {show(expression)}")
    unpack, values = f"{', '.join(map(str, state))} = y.tolist()", f"return [{', '.join(map(show, outputs))}]"
    body = [unpack, *moving, values]
    source = [
        f"def make({', '.join(map(str, parameters))}):",
        *(f"    {line}" for line in fixed),
        "    def bare(s, y):",
        *(f"        {line}" for line in body),
        "    def rate(s, y):",
        "        try:",
        *(f"            {line}" for line in body),
        "        except LOST:",
        f"            return [nan] * {len(outputs)}",
        "    rate.bare = bare",
        "    return rate",
    ]
    names = dict(vars(math)) | {"LOST": LOST}
    exec("\n".join(source), names)
    return names["make"]
