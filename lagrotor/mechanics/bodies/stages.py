"""The stages of a program as they are made, each once."""

from dataclasses import dataclass, field

import sympy as sp

from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.numerics.codegen import Stage


@dataclass
class Stages:
    """Stages made one after another; an expression that was made before is the stage it was made in."""

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
        """Every entry."""
        return matrix.each(self)

    def symmetric(self, matrix: Small) -> Small:
        """Every entry of a symmetric matrix, once."""
        upper = {(i, j): self(matrix[i, j]) for i in range(3) for j in range(i, 3)}
        return Small([[upper[min(i, j), max(i, j)] for j in range(3)] for i in range(3)])
