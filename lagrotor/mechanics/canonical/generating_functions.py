"""Canonical transformations (q, p) → (Q, P) from a generating function of the second kind, F(q, P, t):

    p = ∂F/∂q,     Q = ∂F/∂P,     K = H + ∂F/∂t,

canonical whatever F is, where det ∂²F/∂q∂P ≠ 0. Where K does not have Q, P are first integrals: the equation of Hamilton and
Jacobi. Goldstein, Classical Mechanics, § 9.1, ch. 10; Arnold, Mathematical Methods of Classical Mechanics, § 48.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from lagrotor.algebra import decide_zero, derivative
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.expressions import shortest, vector_of
from lagrotor.mechanics.lagrangian import gradient, jacobian, t


@dataclass(frozen=True)
class GeneratedTransformation:
    """new: P, old: p, symbols; p_of and Q_of: old momenta and new coordinates of (q, P, t), and the new Hamiltonian K."""

    new: tuple[sp.Symbol, ...]
    old: tuple[sp.Symbol, ...]
    p_of: tuple[sp.Expr, ...]
    Q_of: tuple[sp.Expr, ...]
    K: sp.Expr

    def explicit(self) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
        """Q and P of (q, p, t), p = ∂F/∂q solved for P.

        Raises:
            DomainError: where no solution in closed form is known, or more than one.
        """
        rows = [own - of for own, of in zip(self.old, self.p_of, strict=True)]
        try:
            solutions = sp.solve(rows, self.new, dict=True)
        except NotImplementedError:
            solutions = []
        kept = [
            s for s in solutions if len(s) == len(rows) and all(decide_zero(e.subs(s)).answer == "zero" for e in rows)
        ]
        if len(kept) != 1:
            raise DomainError(f"explicit: p = ∂F/∂q has {len(kept)} solutions {kept} for {self.new}: use p_of and Q_of")
        return (
            tuple(shortest(Q.subs(kept[0])) for Q in self.Q_of),
            tuple(shortest(kept[0][P]) for P in self.new),
        )


def generated_transformation(
    H: sp.Expr, q: Sequence[sp.Symbol], p: Sequence[sp.Symbol], F: sp.Expr, P: Sequence[sp.Symbol]
) -> GeneratedTransformation:
    """The canonical transformation of F(q, P, t).

    Args:
        H: of canonical q and p.
        q: its coordinates.
        p: its momenta.
        F: the generating function of the second kind.
        P: the new momenta, symbols of their own.

    Raises:
        InputError: for a P that is no symbol or is already one of H, and an F with old momenta.
        SingularError: where det ∂²F/∂q∂P vanishes identically: it generates nothing.
    """
    new = vector_of("generated: P", P, len(q))
    taken = {*q, *p, t} | H.free_symbols
    if len({*new}) < len(new) or not all(isinstance(s, sp.Symbol) and s not in taken for s in new):
        raise InputError(f"generated: P = {new} must be {len(q)} symbols that H does not have: name new ones")
    if old := F.free_symbols & {*p}:
        raise InputError(f"generated: F = {F} contains {', '.join(sorted(map(str, old)))}: it is a function of q and P")
    p_of = gradient(F, q)
    if decide_zero(jacobian(p_of, new).det(method="berkowitz")).answer == "zero":
        raise SingularError(f"generated: det ∂²F/∂q∂P = 0 for F = {F}: it generates no transformation")
    K = shortest(H.xreplace(dict(zip(p, p_of, strict=True))) + derivative(F, t))
    return GeneratedTransformation(new, tuple(p), tuple(p_of), tuple(gradient(F, new)), K)
