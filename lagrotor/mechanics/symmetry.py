"""Symmetries, their Noether integrals, and the reductions they allow.

A point transformation q → q + ε ξ(q) carries velocities along by v → v + ε ξ', so a Lagrangian changes by

    δL = ∂L/∂q · ξ + ∂L/∂v · ξ',        and along a motion        d/dt (p · ξ) = δL + λ · (G ξ).

The momentum p · ξ is therefore conserved when ξ leaves L invariant and is tangent to the constraints in force. The
translation of a cyclic coordinate is the plainest case; its conserved momentum allows the Legendre transform in that
velocity alone, to the Routhian.

Arnold, Mathematical Methods of Classical Mechanics, §20; Goldstein, Poole & Safko, Classical Mechanics, 3rd ed.,
§§2.6, 8.1, 8.3; Noether, Invariante Variationsprobleme (1918).
"""

from collections.abc import Sequence

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import DomainError, InputError, NotASymmetryError
from lagrotor.mechanics.constraints import Constrained, jacobian
from lagrotor.mechanics.lagrangian import Coordinates, gradient, linear_solve, momenta, total_derivative


def cyclic_coordinates(L: sp.Expr, c: Coordinates) -> tuple[sp.Symbol, ...]:
    """Those q on which L does not depend: ∂L/∂q decided to vanish identically. Goldstein §2.6."""
    return tuple(q for q in c.q if _vanishes(sp.diff(L, q)))


def variation(L: sp.Expr, c: Coordinates, xi: Sequence[sp.Expr]) -> sp.Expr:
    """δL = ∂L/∂q · ξ + ∂L/∂v · ξ' under q → q + ε ξ(q): L along the prolonged vector field.

    Raises InputError when ξ does not have n components or contains a velocity.
    """
    field = _field("variation", c, xi)
    carried = field.applyfunc(lambda component: total_derivative(component, c))
    return gradient(L, c.q).dot(field) + gradient(L, c.v).dot(carried)


def noether_integral(L: sp.Expr, c: Coordinates, xi: Sequence[sp.Expr]) -> sp.Expr:
    """p · ξ, conserved along every free motion, because ξ leaves L invariant. Arnold §20.

    Raises NotASymmetryError when δL is not decided to vanish identically, InputError as `variation` does.
    """
    delta = variation(L, c, xi)
    decision = decide_zero(delta)
    if decision.answer != "zero":
        raise NotASymmetryError(
            f"noether_integral: δL = {delta} (decided: {decision.answer}): q → q + ε ξ does not leave L invariant; "
            "noether_rate tells how p · ξ changes"
        )
    return momenta(L, c).dot(list(xi))


def noether_rate(system: Constrained, xi: Sequence[sp.Expr], lam: Sequence[sp.Expr]) -> sp.Expr:
    """d/dt (p · ξ) = δL + λ · (G ξ) along the constrained motion without other forces, λ one for each constraint.

    The second term is the work of the constraint forces on ξ: zero when ξ is tangent to the constraints.
    Raises InputError when there are not k multipliers, or as `variation` does.
    """
    if len(lam) != len(system.g):
        raise InputError(
            f"noether_rate: {len(lam)} multipliers for {len(system.g)} constraints: each constraint has one; "
            "give as many"
        )
    work = sum((force * slope for force, slope in zip(lam, _crossing(system, xi), strict=True)), sp.S.Zero)
    return variation(system.L, system.c, xi) + work


def is_conserved(system: Constrained, xi: Sequence[sp.Expr]) -> bool:
    """Whether δL and every component of G ξ are decided to vanish identically, so that p · ξ is conserved.

    Sufficient: a ξ that preserves g = 0 only as a surface, and a δL that vanishes only on it, give False.
    """
    return all(_vanishes(e) for e in (variation(system.L, system.c, xi), *_crossing(system, xi)))


def legendre(L: sp.Expr, c: Coordinates, p: Sequence[sp.Symbol]) -> sp.Expr:
    """H(q, p) = p · v − L at p = ∂L/∂v: for L = ½ v·M v + b·v − V,  H = ½ (p − b)·M⁻¹(p − b) + V. Goldstein §8.1.

    Raises DomainError when L is not quadratic in v, SingularError when det M vanishes identically, InputError when p
    does not name n new symbols.
    """
    return -_reduced("legendre", L, c, c.v, p)


def routhian(L: sp.Expr, c: Coordinates, cyclic: Sequence[sp.Symbol], p: Sequence[sp.Symbol]) -> sp.Expr:
    """R = L − Σ p v over the cyclic coordinates, their velocities eliminated at the momentum values p.

    R is a Lagrangian for the other coordinates (Goldstein §8.3, there with the opposite sign). Only the cyclic
    velocities have to enter L quadratically.

    Raises NotASymmetryError when a coordinate is not cyclic, and DomainError, SingularError, InputError as `legendre`.
    """
    if strangers := [str(q) for q in cyclic if q not in c.q]:
        raise InputError(f"routhian: {', '.join(strangers)} not among the coordinates {c.q}: name some of these")
    if bound := [str(q) for q in cyclic if not _vanishes(sp.diff(L, q))]:
        raise NotASymmetryError(
            f"routhian: L depends on {', '.join(bound)}: its momentum is not conserved; leave it among the coordinates"
        )
    return _reduced("routhian", L, c, [c.v[c.q.index(q)] for q in cyclic], p)


def _reduced(where: str, L: sp.Expr, c: Coordinates, u: Sequence[sp.Symbol], p: Sequence[sp.Symbol]) -> sp.Expr:
    """L − p·u at its stationary point in the velocities u: L|₀ − ½ (p − b)·A⁻¹(p − b), b = ∂L/∂u|₀, A = ∂²L/∂u∂u."""
    if not u or len(p) != len(u) or len({*p}) != len(p) or {*p} & (L.free_symbols | {*c.q, *c.v, *c.a}):
        raise InputError(
            f"{where}: momenta {tuple(p)} for the velocities {tuple(u)}: at least one velocity, and for each a symbol "
            "of its own that L does not use; rename them"
        )
    slope = gradient(L, u)
    A = slope.jacobian(u)
    if not all(_vanishes(sp.diff(entry, w)) for entry in A for w in u):
        raise DomainError(
            f"{where}: L is not quadratic in {', '.join(map(str, u))}: p = ∂L/∂v is not linear there; "
            "solve it for the velocities by hand"
        )
    at_rest = dict.fromkeys(u, 0)
    excess = sp.Matrix(list(p)) - slope.subs(at_rest)
    singular = f"{where}: ∂²L/∂v∂v is singular in {', '.join(map(str, u))}: p does not determine the velocities"
    velocities = linear_solve(A.subs(at_rest), excess, f"{singular}; use fewer coordinates")
    return L.subs(at_rest) - excess.dot(velocities) / 2


def _vanishes(expression: sp.Expr) -> bool:
    return decide_zero(expression).answer == "zero"


def _crossing(system: Constrained, xi: Sequence[sp.Expr]) -> sp.Matrix:
    """G ξ, shape (k, 1): how fast the transformation leaves each constraint."""
    return jacobian(system.g, system.c) * _field("G ξ", system.c, xi)


def _field(where: str, c: Coordinates, xi: Sequence[sp.Expr]) -> sp.Matrix:
    field = sp.Matrix(list(xi))
    if len(field) != len(c.q) or field.free_symbols & {*c.v, *c.a}:
        raise InputError(
            f"{where}: ξ = {tuple(xi)}: a point transformation has one component ξ(q) for each of {c.q}, free of "
            "velocities; write it so"
        )
    return field
