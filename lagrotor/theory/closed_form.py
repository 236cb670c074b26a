"""A closed form: expressions with their arguments, domain and order, generated as numpy functions that broadcast."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.printers import compile_program, in_blocks, program_source
from lagrotor.pair.notation import GLOSSARY

# From the arguments, each (n,): estimated bounds of the errors, (outputs, n) or what broadcasts to it.
_Bound = Callable[..., Array]


@dataclass(frozen=True)
class ClosedForm:
    """Expressions of `arguments`, valid under `assumptions` where every condition of `domain` holds.

    `order`: through which power of `small` a series is right; None for an exact form. `source`: the paper's equation.
    Called with numbers or arrays in the order of `arguments` it returns the expressions' values, broadcast; `error` takes
    the same arguments. `bound`: of a series, the errors' bounds for arguments (n,) each.
    """

    name: str
    outputs: tuple[str, ...]
    expressions: tuple[sp.Expr, ...]
    arguments: tuple[sp.Symbol, ...]
    domain: tuple[sp.Basic, ...]
    assumptions: str
    source: str
    order: int | None = None
    small: sp.Symbol | None = None
    bound: _Bound | None = None

    @cached_property
    def _functions(self) -> tuple[Callable[..., Any], Callable[..., Any]]:
        """Of the arguments: the outputs, and whether each condition of the domain holds."""
        units = ", ".join(f"{s} [{GLOSSARY[s].unit}]" if s in GLOSSARY else str(s) for s in self.arguments)
        doc = f"{self.name}({units}) -> {', '.join(self.outputs)}"
        conditions = Program(self.arguments, (), self.domain)
        return compile_program(self._program, "numpy", doc), compile_program(conditions, "numpy")

    @property
    def _program(self) -> Program:
        return Program(self.arguments, (), self.expressions)

    def code(self, module: str = "math") -> str:
        """Source of the function arguments → list of outputs, without the conditions of the domain."""
        return program_source(self._program, module)

    def _repr_latex_(self) -> str:
        pairs = zip(self.outputs, self.expressions, strict=True)
        named = ((re.sub("(?=Omega|phi|theta|sin)", r"\\", name), sp.latex(e)) for name, e in pairs)
        lines = r" \\ ".join(f"{name} &= {expression}" for name, expression in named)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __call__(self, *values: ArrayLike) -> Array | tuple[Array, ...]:
        """The outputs at these argument values: one array, or a tuple where there are several outputs.

        Raises InputError for a wrong number of arguments, DomainError where a value is outside the domain.
        """
        flat, shape = self._check_arguments(values)
        rows = in_blocks(self._functions[0], flat, len(self.outputs), prod(shape))
        return self._in_shape(rows, shape)

    def error(self, *values: ArrayLike) -> Array | tuple[Array, ...]:
        """Bounds of the outputs' errors at these argument values, in the form of the outputs; rounding is not counted.

        Zero for an exact form (order None), under its assumptions.

        Raises
        ------
        InputError
            As a call does, and for a series of which no bound is known.
        DomainError
            As a call does, and where the series is beyond its range.
        """
        flat, shape = self._check_arguments(values)
        if self.order is None:
            bounds = np.zeros(1)
        elif self.bound is None:
            raise InputError(
                f"{self.name}: no bound of this series' error is known; compare it with a simulated motion"
            )
        else:
            bounds = self.bound(*(np.broadcast_to(v, prod(shape)) for v in flat))
        return self._in_shape(np.broadcast_to(bounds, (len(self.outputs), prod(shape))).copy(), shape)

    def _in_shape(self, rows: Array, shape: tuple[int, ...]) -> Array | tuple[Array, ...]:
        results = tuple(row.reshape(shape) for row in rows)
        return results if len(results) > 1 else results[0]

    def _check_arguments(self, values: tuple[ArrayLike, ...]) -> tuple[list[float | Array], tuple[int, ...]]:
        """The arguments as numbers or rows, and the shape that they broadcast to; refused outside the domain."""
        if len(values) != len(self.arguments):
            raise InputError(
                f"{self.name}: takes {len(self.arguments)} arguments ({', '.join(map(str, self.arguments))})"
            )
        try:
            given = [np.asarray(v, dtype=float) for v in values]
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.name}: {error}: give numbers or arrays of them") from None
        shape = np.broadcast_shapes(*(array.shape for array in given))
        for argument, array in zip(self.arguments, given, strict=True):
            if not np.isfinite(array).all():
                raise DomainError(f"{self.name}: {argument} holds a value that is not finite")
            if argument.is_positive and not (array > 0).all():
                raise DomainError(f"{self.name}: {argument} = {array.min():g} must be greater than zero")
        # One value for all stays one number.
        flat = [float(v.flat[0]) if v.size == 1 else np.broadcast_to(v, shape).ravel() for v in given]
        for relation, holds in zip(self.domain, self._functions[1](*flat), strict=True):
            inside = np.broadcast_to(holds, prod(shape))
            if not inside.all():
                where = int(np.argmin(inside))
                at = ", ".join(
                    f"{s} = {v if isinstance(v, float) else v[where]:g}"
                    for s, v in zip(self.arguments, flat, strict=True)
                )
                raise DomainError(f"{self.name}: outside its domain {relation}: {at}")
        return flat, shape
