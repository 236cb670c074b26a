"""Canonical transformations (q, p) → (Q, P) from a generating function of the second kind, F(q, P, t):

    p = ∂F/∂q,     Q = ∂F/∂P,     K = H + ∂F/∂t,

canonical whatever F is, where det ∂²F/∂q∂P ≠ 0. Where K does not have Q, P are first integrals: the equation of Hamilton and
Jacobi. Goldstein, Classical Mechanics, § 9.1, ch. 10; Arnold, Mathematical Methods of Classical Mechanics, § 48.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from lagrotor.algebra import decide_zero, derivative
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import gradient, jacobian, t

if TYPE_CHECKING:
    from lagrotor.mechanics.canonical.hamiltonians import Hamiltonian


@dataclass(frozen=True)
class GeneratedTransformation:
    """new momenta P (symbols); old momenta p, new coordinates Q and the new Hamiltonian K, each of (q, P, t)."""

    hamiltonian: "Hamiltonian"
    P: tuple[sp.Symbol, ...]
    p: tuple[sp.Expr, ...]
    Q: tuple[sp.Expr, ...]
    K: sp.Expr

    def explicit(self) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
        """Q and P of (q, p, t), p = ∂F/∂q solved for P.

        Raises:
            DomainError: where no solution in closed form is found, or more than one.
        """
        momenta = self.hamiltonian.p
        rows = [own - said for own, said in zip(momenta, self.p, strict=True)]
        try:
            solutions = sp.solve(rows, self.P, dict=True)
        except NotImplementedError:
            solutions = []
        kept = [
            s
            for s in solutions
            if all(decide_zero(row.subs(s)).answer == "zero" for row in rows) and len(s) == len(rows)
        ]
        if len(kept) != 1:
            raise DomainError(
                f"explicit: p = ∂F/∂q has {len(kept)} solutions {kept} for {self.P}: take one by hand, or use p and Q as they are"
            )
        P = tuple(shortest(kept[0][s]) for s in self.P)
        return tuple(shortest(Q.subs(dict(zip(self.P, P, strict=True)))) for Q in self.Q), P


def generated(h: "Hamiltonian", F: sp.Expr, P: Sequence[sp.Symbol]) -> GeneratedTransformation:
    """The canonical transformation of F(q, P, t).

    Args:
        h: with canonical momenta and no constraints.
        F: the generating function of the second kind.
        P: the new momenta, symbols of their own.

    Raises:
        InputError: for a P that is no symbol or is already one of H, and an F with old momenta.
        SingularError: where det ∂²F/∂q∂P vanishes identically: it generates nothing.
        DomainError: for kinetic momenta or constraints.
    """
    if h.constraints or not h.field.is_zero_matrix:
        raise DomainError("generated: H must have canonical momenta and no constraints: use independent coordinates")
    F, new = expression("generated: F", F), vector_of("generated: P", P, len(h.q))
    taken = {*h.q, *h.p, t} | h.H.free_symbols
    if len({*new}) < len(new) or not all(isinstance(s, sp.Symbol) and s not in taken for s in new):
        raise InputError(f"generated: P = {new} must be {len(h.q)} symbols that H does not have: name new ones")
    if old := F.free_symbols & {*h.p, *h.v}:
        raise InputError(f"generated: F = {F} contains {', '.join(sorted(map(str, old)))}: it is a function of q and P")
    p, Q = gradient(F, h.q), gradient(F, new)
    if decide_zero(jacobian(p, new).det(method="berkowitz")).answer == "zero":
        raise SingularError(f"generated: det ∂²F/∂q∂P = 0 for F = {F}: it generates no transformation")
    K = shortest(h.H.xreplace(dict(zip(h.p, p, strict=True))) + derivative(F, t))
    return GeneratedTransformation(h, new, tuple(p), tuple(Q), K)
