"""Printed programs: Python functions of numbers or arrays, the right-hand side for a solver, JavaScript.

A right-hand side takes one state at a time. Stages that contain only parameters are evaluated once, and squares are printed as
products. Such a function takes three quarters of the time of a compiled function in a wrapper.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce
from operator import attrgetter
from typing import Any

import numpy as np
import sympy as sp
from sympy.printing.numpy import SciPyPrinter
from sympy.printing.pycode import AbstractPythonCodePrinter, MpmathPrinter, PythonCodePrinter

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.codegen import Program, Stage, reduce_common
from lagrotor.numerics.source_cache import function_of

_BLOCK = 8192  # values at once, which fit into a processor's cache


class _Printer(AbstractPythonCodePrinter):  # type: ignore[misc]
    """A Python printer that can rename symbols."""

    module: str

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": False})
        self.names: dict[sp.Symbol, str] = {}

    def _print_Float(self, expr: sp.Float) -> str:
        """Print all digits: sympy's 15 would change 192943.6528778573 s by 3·10⁻¹⁰ s."""
        return repr(float(expr))

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return self.names.get(expr) or super()._print_Symbol(expr)

    def _print_AppliedUndef(self, expr: sp.Expr) -> str:
        """Print a call of a function that is an argument of the program."""
        return f"{expr.func}({', '.join(map(self._print, expr.args))})"

    def _print_sech(self, expr: sp.sech) -> str:
        """Print sech without cosh, which overflows for arguments above 711, where sech is zero. In numpy's code √x² replaces |x|,
        which has no derivative by a complex step."""
        x = sp.Dummy("x")
        small = sp.exp(-(sp.sqrt(x**2) if self.module == "numpy" else sp.Abs(x)))
        source = f"({self._print(2 * small)}/({self._print(1 + small**2)}))"
        inside = self._print(expr.args[0])
        return source.replace(self._print(x), f"({inside})" if self.module == "numpy" else inside)

    def _print_not_supported(self, expr: sp.Expr) -> str:
        raise InputError(f"{expr} has no code in Python's {self.module} module: write it with elementary functions")

    _print_Integral = _print_Derivative = _print_Limit = _print_not_supported


class _Scalars(_Printer, PythonCodePrinter):  # type: ignore[misc]
    """A printer for floats. It prints a small power of a symbol as a product, and begins a sum with a positive term if there is
    one."""

    module = "math"

    def _as_ordered_terms(self, expr: sp.Add, order: Any = None) -> list[sp.Expr]:
        return sorted(super()._as_ordered_terms(expr, order), key=lambda term: term.could_extract_minus_sign())

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> Any:
        if expr.base.is_Symbol and expr.exp in (2, 3):
            return f"({'*'.join([self._print(expr.base)] * int(expr.exp))})"
        return super()._print_Pow(expr, rational=rational)


class _Arrays(_Printer, SciPyPrinter):  # type: ignore[misc]
    """A printer for arrays of numpy."""

    module = "numpy"

    def _print_Max(self, expr: sp.Max) -> str:
        return self._of_two("maximum", expr)

    def _print_Min(self, expr: sp.Min) -> str:
        return self._of_two("minimum", expr)

    def _of_two(self, name: str, expr: sp.Expr) -> str:
        """Nest calls of a function of two arguments. sympy 1.13.0 stacks the arguments, which fails for a number and an array."""
        name = self._module_format(f"numpy.{name}")
        return reduce(lambda a, b: f"{name}({a}, {b})", map(self._print, expr.args))


class _Digits(_Printer, MpmathPrinter):  # type: ignore[misc]
    """A printer for numbers of mpmath."""

    module = "mpmath"
    _print_Float = MpmathPrinter._print_Float


_PRINTERS: dict[str, type[_Printer]] = {printer.module: printer for printer in (_Scalars, _Arrays, _Digits)}


def _quick(e: sp.Expr, show: _Printer) -> str:
    """Print a sum of products without sympy's search for the best order of its terms."""
    if e.is_Symbol:
        return show.names.get(e) or e.name
    if e.is_Add:
        summands = sorted((_quick(term, show) for term in e.args), key=lambda text: text[0] == "-")
        return "".join([summands[0], *(summand if summand[0] == "-" else f"+{summand}" for summand in summands[1:])])
    if e.is_Mul and e.args[0] == -1:
        return f"-{'*'.join(_factor(f, show) for f in e.args[1:])}"
    if e.is_Mul:
        return "*".join(_factor(f, show) for f in e.args)
    return str(show.doprint(e))


def _factor(e: sp.Expr, show: _Printer) -> str:
    return _quick(e, show) if e.is_Symbol or e.is_Integer else f"({_quick(e, show)})"


def _assignments(stages: Sequence[Stage], outputs: Sequence[sp.Expr], show: _Printer, quick: bool) -> list[str]:
    """Print the stages as assignments that reuse a name when its value is no longer needed. With more than 255 local names Python
    runs many times slower."""
    used_in = [e.free_symbols for _, e in stages]
    last = {s: i for i, symbols in enumerate(used_in) for s in symbols}
    passing = {name for name, _ in stages}.difference(*(e.free_symbols for e in outputs))
    free, lines, used = list[str](), list[str](), 0
    for i, (name, expression) in enumerate(stages):
        right = _quick(expression, show) if quick else show.doprint(expression)
        free += [show.names[s] for s in sorted(used_in[i] & passing, key=attrgetter("name")) if last[s] == i]
        if not free:
            free, used = [f"_{used}"], used + 1
        show.names[name] = free.pop()
        lines.append(f"{show.names[name]} = {right}")
    return lines


def program_source(program: Program, module: str = "math") -> str:
    """Return the source of a function that takes the program's arguments and returns the list of its outputs."""
    stages, outputs = reduce_common(program)
    show = _PRINTERS[module]()
    lines = _assignments(stages, outputs, show, program.shared)
    lines.append(f"return [{', '.join(map(show.doprint, outputs))}]")
    imports = [f"from {name} import {', '.join(sorted(used))}" for name, used in show.module_imports.items()]
    head = f"def outputs({', '.join(map(str, program.arguments))}):"
    return "\n".join([*imports, head, *(f"    {line}" for line in lines)])


def compile_program(program: Program, module: str = "math", doc: str = "") -> Callable[..., Any]:
    """Compile a program to a function of its arguments that returns a list of outputs. The module "math" takes floats
    (fastest for one state at a time), "numpy" arrays that broadcast, "mpmath" any precision."""
    function = function_of(program_source(program, module))
    function.__doc__ = doc or f"{', '.join(map(str, program.arguments))} -> {len(program.outputs)} numbers"
    return function


def arrays_source(program: Program, states: int, passing: int = 0) -> str:
    """Return the source of a function that takes parameters and returns a function rate(*state, *force) of arrays. The state is
    the program's first `states` arguments, and the force its last `passing` ones. Stages of parameters are evaluated once."""
    stages, outputs = reduce_common(program)
    show = _Arrays()
    split = len(program.arguments) - passing
    parameters, varying = program.arguments[states:split], program.arguments[:states] + program.arguments[split:]
    fixed, moving = _parameter_stages(stages, set(parameters), show)
    lines = _assignments(moving, outputs, show, program.shared)
    text = [
        f"def make({', '.join(map(str, parameters))}):",
        *(f"    {line}" for line in fixed),
        f"    def rate({', '.join(map(str, varying))}):",
        *(f"        {line}" for line in lines),
        f"        return [{', '.join(map(show.doprint, outputs))}]",
        "    return rate",
    ]
    imports = [f"from {name} import {', '.join(sorted(used))}" for name, used in show.module_imports.items()]
    return "\n".join([*imports, *text])


def _parameter_stages(
    stages: Sequence[Stage], parameters: set[sp.Symbol], show: _Printer
) -> tuple[list[str], list[Stage]]:
    """Return the stages that contain only parameters as printed assignments, and the other stages."""
    fixed, moving, known = list[str](), list[Stage](), set(parameters)
    for name, expression in stages:
        if expression.free_symbols <= known:
            known.add(name)
            fixed.append(f"{name} = {show.doprint(expression)}")
        else:
            moving.append((name, expression))
    return fixed, moving


def rhs_source(
    program: Program, states: int, driven: bool = False, bounded: bool = False, clock: int | None = None
) -> str:
    """Return the source of a function that takes parameters and returns a right-hand side rhs(s, y). The state is the program's
    first `states` arguments. If `driven` is true, the last three parameters are the peaks of a force exp(−(s/width)²), and
    `width` follows them. If `bounded` is true, OutsideError is raised where one of the program's `positive` expressions is not
    positive. If the time is number `clock` of the state, its value is begin + s, and `begin` is the last parameter. Outside the
    coordinates' range rhs returns NaN, which makes a solver shorten its step; `rhs.bare` raises one of the errors LOST."""
    expressions = (*program.outputs, *(program.positive if bounded else ()))
    stages, reduced = reduce_common(replace(program, outputs=expressions))
    outputs, bounds = reduced[: len(program.outputs)], reduced[len(program.outputs) :]
    show = _Scalars()
    state, parameters = program.arguments[:states], program.arguments[states:]
    force = parameters[-3:] if driven else ()
    fixed, moving = _parameter_stages(stages, set(parameters) - set(force), show)
    lines = _assignments(moving, reduced, show, program.shared)
    checks = [f"{show.doprint(e)} > 0" for e in bounds]
    body = [
        f"{', '.join(map(str, state))}{',' * (states == 1)} = y.tolist()",
        *([f"if begin is not None: {state[clock]} = begin + s"] if clock is not None else []),
        *(["pulse = exp(-(s / width) ** 2)", *(f"{f} = peak_{f} * pulse" for f in force)] if driven else []),
        *lines,
        *([f"if not ({' and '.join(checks)}): raise OutsideError(s)"] if checks else []),
        f"return [{', '.join(map(show.doprint, outputs))}]",
    ]
    names = [*map(str, parameters[: len(parameters) - len(force)]), *(f"peak_{f}" for f in force)]
    names += ["begin=None"] if clock is not None else []
    return rhs_text(body, fixed, [*names, "width"] if driven else names, len(outputs))


def rhs_text(body: list[str], fixed: list[str], names: list[str], outputs: int) -> str:
    """Return the source of a function that takes the parameters `names` and returns rhs(s, y). It evaluates the lines `fixed`
    once, and the lines `body` at each call of rhs."""
    source = [
        "from math import *",
        "from lagrotor.numerics.segment import LOST, OutsideError",
        f"def make({', '.join(names)}):",
        *(f"    {line}" for line in fixed),
        "    def bare(s, y):",
        *(f"        {line}" for line in body),
        "    def rate(s, y):",
        "        try:",
        "            return bare(s, y)",
        "        except LOST:",
        f"            return [nan] * {outputs}",
        "    rate.bare = bare",
        "    return rate",
    ]
    return "\n".join(source)


def in_blocks(function: Callable[..., Any], arguments: Sequence[float | Array], outputs: int, n: int) -> Array:
    """Evaluate a numpy program at n places, and return its outputs, shape (outputs, n). It takes some thousands of places at
    once, whose values fit into the cache."""
    table = np.empty((outputs, n))
    for i in range(0, n, _BLOCK):
        rows = function(*(v if isinstance(v, float) else v[i : i + _BLOCK] for v in arguments))
        for row, values in zip(table, rows, strict=True):
            row[i : i + _BLOCK] = values
    return table


def javascript(program: Program, name: str) -> str:
    """Return the program as the source of a JavaScript function that returns an array of the outputs."""
    stages, outputs = reduce_common(program)
    lines = [f"  const {s} = {sp.jscode(e)};" for s, e in stages]
    values = ", ".join(sp.jscode(e) for e in outputs)
    return "\n".join(
        [f"function {name}({', '.join(map(str, program.arguments))}) {{", *lines, f"  return [{values}];", "}"]
    )
