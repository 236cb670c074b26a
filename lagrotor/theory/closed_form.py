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
from lagrotor.formula_text import with_greek
from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.printers import compile_program, in_blocks, program_source
from lagrotor.pair.notation import GLOSSARY
from lagrotor.result_display import in_lines, text_of

_Bound = Callable[..., Array]


@dataclass(frozen=True, repr=False)
class ClosedForm:
    """Expressions with their arguments and domain. A call with numbers or arrays in the order of `arguments` evaluates them.

    Attributes
    ----------
    name : str
        Name of the form in messages.
    outputs : tuple[str, ...]
        Name of each output.
    expressions : tuple[Expr, ...]
        Expression of each output.
    arguments : tuple[Symbol, ...]
        Symbols of the arguments; `lagrotor.pair.notation` states the unit of each.
    domain : tuple[Basic, ...]
        Conditions that the arguments must satisfy.
    assumptions : str
        Physical assumptions in words.
    source : str
        Equation or section of the paper.
    order : int, optional
        Power of `small` through which a series is correct; None for an exact form.
    small : Symbol, optional
        The expansion parameter of a series.
    bound : callable, optional
        Function from arguments, shape (n,) each, to bounds of the errors, shape (outputs, n) after broadcasting.

    Examples
    --------
    >>> from lagrotor import paired_frequency
    >>> form = paired_frequency(3)
    >>> form.arguments, round(float(form(0.2, 1.0, 1.0)), 12)
    ((r_0, sigma, k), 0.99)
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
        """Two functions of the arguments: one returns the outputs, the other whether each condition of the domain is true."""
        units = ", ".join(f"{s} [{GLOSSARY[s].unit}]" if s in GLOSSARY else str(s) for s in self.arguments)
        doc = f"{self.name}({units}) -> {', '.join(self.outputs)}"
        conditions = Program(self.arguments, (), self.domain)
        return compile_program(self._program, "numpy", doc), compile_program(conditions, "numpy")

    @property
    def _program(self) -> Program:
        return Program(self.arguments, (), self.expressions)

    def code(self, module: str = "math") -> str:
        """Generate source code of a function that returns the list of outputs; it does not check the domain.

        Parameters
        ----------
        module : str, default 'math'
            Module of the elementary functions, 'math' or 'numpy'.

        Returns
        -------
        str
            Python source.
        """
        return program_source(self._program, module)

    def __repr__(self) -> str:
        rows = {with_greek(name): text_of(e) for name, e in zip(self.outputs, self.expressions, strict=True)}
        rows |= {"where": text_of(self.domain)} if self.domain else {}
        rows |= {"under": with_greek(self.assumptions)} if self.assumptions else {}
        return in_lines(f"{self.name}({text_of(self.arguments)})", rows)

    def _repr_latex_(self) -> str:
        pairs = zip(self.outputs, self.expressions, strict=True)
        named = ((re.sub("(?=Omega|phi|theta|sin)", r"\\", name), sp.latex(e)) for name, e in pairs)
        lines = r" \\ ".join(f"{name} &= {expression}" for name, expression in named)
        return rf"$\displaystyle \begin{{aligned}} {lines} \end{{aligned}}$"

    def __call__(self, *values: ArrayLike) -> Array | tuple[Array, ...]:
        """Return the outputs, one array or a tuple of arrays.

        Raises InputError for a wrong number of arguments, DomainError for a value outside the domain.
        """
        flat, shape = self._check_arguments(values)
        rows = in_blocks(self._functions[0], flat, len(self.outputs), prod(shape))
        return self._in_shape(rows, shape)

    def error(self, *values: ArrayLike) -> Array | tuple[Array, ...]:
        """Compute a bound of the error of each output, without rounding errors.

        Parameters
        ----------
        *values : array_like
            The arguments in the order of `arguments`.

        Returns
        -------
        ndarray or tuple[ndarray, ...]
            Bounds with the same shapes as the outputs; zero for an exact form.

        Raises
        ------
        InputError
            If the number of arguments is wrong, or if no bound is known for the series.
        DomainError
            Outside the domain, and where the series does not converge.
        """
        flat, shape = self._check_arguments(values)
        if self.order is None:
            bounds = np.zeros(1)
        elif self.bound is None:
            raise InputError(f"{self.name}: no bound of this series' error is known; compare it with a simulation")
        else:
            bounds = self.bound(*(np.broadcast_to(v, prod(shape)) for v in flat))
        return self._in_shape(np.broadcast_to(bounds, (len(self.outputs), prod(shape))).copy(), shape)

    def _in_shape(self, rows: Array, shape: tuple[int, ...]) -> Array | tuple[Array, ...]:
        results = tuple(row.reshape(shape) for row in rows)
        return results if len(results) > 1 else results[0]

    def _check_arguments(self, values: tuple[ArrayLike, ...]) -> tuple[list[float | Array], tuple[int, ...]]:
        """Return the arguments as numbers or rows, and their broadcast shape. Raises DomainError outside the domain."""
        if len(values) != len(self.arguments):
            names = ", ".join(map(str, self.arguments))
            raise InputError(f"{self.name}: takes {len(self.arguments)} arguments ({names})")
        try:
            arrays = [np.asarray(v, dtype=float) for v in values]
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.name}: {error}: give numbers or arrays of them") from None
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
        for argument, array in zip(self.arguments, arrays, strict=True):
            if not np.isfinite(array).all():
                raise DomainError(f"{self.name}: {argument} holds a value that is not finite")
            if argument.is_positive and not (array > 0).all():
                raise DomainError(f"{self.name}: {argument} = {array.min():g} must be greater than zero")
        flat = [float(v.flat[0]) if v.size == 1 else np.broadcast_to(v, shape).ravel() for v in arrays]
        for relation, holds in zip(self.domain, self._functions[1](*flat), strict=True):
            inside = np.broadcast_to(holds, prod(shape))
            if not inside.all():
                where = int(np.argmin(inside))
                numbers = [v if isinstance(v, float) else v[where] for v in flat]
                at = ", ".join(f"{s} = {v:g}" for s, v in zip(self.arguments, numbers, strict=True))
                raise DomainError(f"{self.name}: outside its domain {relation}: {at}")
        return flat, shape
