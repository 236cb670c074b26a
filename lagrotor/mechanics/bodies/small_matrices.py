"""Matrices of at most six rows whose products skip zeros, and the stages of a program, which store their entries.

Matrices of sympy would take most of the recursion's time: they multiply zeros, for which sympy asks if the factor is finite.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import sympy as sp

from lagrotor.numerics.codegen import Stage

Scalar = Any  # an expression
_0 = sp.S.Zero


class Small:
    """A small matrix as a list of rows. Entry i of a column v is also v[i]."""

    __slots__ = ("rows",)

    def __init__(self, rows: Sequence[Sequence[Any]]) -> None:
        self.rows = [list(row) for row in rows]

    @classmethod
    def of(cls, matrix: sp.Matrix) -> "Small":
        return cls(matrix.tolist())

    @classmethod
    def column(cls, *entries: Any) -> "Small":
        return cls([[e] for e in entries])

    def __getitem__(self, key: Any) -> Any:
        return self.rows[key[0]][key[1]] if isinstance(key, tuple) else self.rows[key][0]

    @property
    def matrix(self) -> sp.Matrix:
        return sp.Matrix(self.rows)

    @property
    def T(self) -> "Small":
        return Small(list(zip(*self.rows, strict=True)))

    def each(self, function: Callable[[Any], Any]) -> "Small":
        """Apply a function to every entry."""
        return Small([[function(e) for e in row] for row in self.rows])

    def __add__(self, other: "Small") -> "Small":
        return Small(
            [
                [b if a is _0 else a if b is _0 else a + b for a, b in zip(mine, theirs, strict=True)]
                for mine, theirs in zip(self.rows, other.rows, strict=True)
            ]
        )

    def __neg__(self) -> "Small":
        return self.each(lambda e: -e)

    def __sub__(self, other: "Small") -> "Small":
        return self + -other

    def __mul__(self, other: Union["Small", Scalar]) -> "Small":
        if not isinstance(other, Small):
            return self.each(lambda e: e if e is _0 else e * other)
        columns = list(zip(*other.rows, strict=True))
        return Small([[_dot(row, column) for column in columns] for row in self.rows])

    def dot(self, other: "Small") -> Scalar:
        return _dot([row[0] for row in self.rows], [row[0] for row in other.rows])

    def cross(self, other: "Small") -> "Small":
        (a, b, c), (x, y, z) = ([row[0] for row in vector.rows] for vector in (self, other))
        return Small.column(_dot((b, -c), (z, y)), _dot((c, -a), (x, z)), _dot((a, -b), (y, x)))


def zeros(rows: int, columns: int) -> Small:
    return Small([[_0] * columns for _ in range(rows)])


def blocks(grid: Sequence[Sequence[Small]]) -> Small:
    return Small([[e for block in row for e in block.rows[i]] for row in grid for i in range(len(row[0].rows))])


def halves(e: Small) -> tuple[Small, Small]:
    """Return the first three rows (angular) and the last three rows (linear) of a matrix of six rows."""
    return Small(e.rows[:3]), Small(e.rows[3:])


def unit(axis: int, length: Scalar) -> Small:
    """Return a column of three entries, `length` in the row `axis` and zero in the others."""
    return Small.column(*(length if i == axis else _0 for i in range(3)))


def wedge(v: Small) -> Small:
    """Return [v]×, the matrix (3, 3) of the cross product."""
    return Small([[_0, -v[2], v[1]], [v[2], _0, -v[0]], [-v[1], v[0], _0]])


def _dot(a: Sequence[Scalar], b: Sequence[Scalar]) -> Scalar:
    terms = [x * y for x, y in zip(a, b, strict=True) if x is not _0 and y is not _0]
    return terms[0] if len(terms) == 1 else sp.Add(*terms)


@dataclass
class Stages:
    """The stages of a program, pairs (symbol, expression), in order.

    A call with an expression adds a stage and returns its symbol; an expression that occurs again has the same stage.
    """

    made: list[Stage] = field(default_factory=list)
    names: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)

    def __call__(self, e: sp.Expr) -> sp.Expr:
        if e.is_Atom:
            return e
        if e.is_Mul and e.args[0].is_negative and e.args[0].is_Rational:
            return -self(-e)
        if e not in self.names:
            self.names[e] = sp.Symbol(f"_a{len(self.made)}", real=True)
            self.made.append((self.names[e], e))
        return self.names[e]

    def each(self, matrix: Small) -> Small:
        return matrix.each(self)

    def symmetric(self, matrix: Small) -> Small:
        """Store the upper triangle of a symmetric matrix as stages; return the matrix of their symbols."""
        n = len(matrix.rows)
        upper = {(i, j): self(matrix[i, j]) for i in range(n) for j in range(i, n)}
        return Small([[upper[min(i, j), max(i, j)] for j in range(n)] for i in range(n)])
