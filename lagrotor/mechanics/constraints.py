"""Holonomic constraints: their forces, and the way back to them.

One convention of sign throughout. Constraints g(q) = 0 with Jacobian G = ∂g/∂q act by the forces Gᵀ λ:

    M a + h = Q + Gᵀ λ,        G v = 0,        G a + γ = 0,    γ = G' v.

Eliminating a with the Schur complement S = G M⁻¹ Gᵀ gives the multipliers and then the accelerations,

    λ = −S⁻¹ (G M⁻¹ (Q − h) + γ),        a = M⁻¹ (Q − h + Gᵀ λ).

The symbolic and the numeric half say the same; the numeric one takes the values of M, h, G, γ, Q at one state.

Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., §2.4; Hairer, Lubich & Wanner, Geometric Numerical
Integration, §§IV.4, VII.1.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics.lagrangian import (
    Coordinates,
    bias,
    force_column,
    linear_solve,
    mass_matrix,
    singular_mass,
    total_derivative,
)

Array = NDArray[np.floating[Any]]

# Beyond this condition number of the (row-scaled) Schur complement the multipliers carry no digit worth reading.
WORST_CONDITION = 1e12


@dataclass(frozen=True)
class Constrained:
    """A Lagrangian L(q, v) with k holonomic constraints g(q) = 0; k = 0 is a free system.

    Raises InputError when a constraint contains a velocity or an acceleration.
    """

    L: sp.Expr
    c: Coordinates
    g: tuple[sp.Expr, ...] = ()

    def __post_init__(self) -> None:
        for i, constraint in enumerate(self.g):
            if moving := sp.sympify(constraint).free_symbols & {*self.c.v, *self.c.a}:
                raise InputError(
                    f"Constrained: g[{i}] contains {', '.join(sorted(map(str, moving)))}: a holonomic constraint "
                    "depends on the coordinates alone; integrate it first"
                )


def jacobian(g: Sequence[sp.Expr], c: Coordinates) -> sp.Matrix:
    """G = ∂g/∂q, shape (k, n)."""
    return sp.Matrix(len(g), len(c.q), lambda i, j: sp.diff(g[i], c.q[j]))


def velocity_residual(g: Sequence[sp.Expr], c: Coordinates) -> sp.Matrix:
    """g' = G v, shape (k, 1): zero at a consistent velocity."""
    return jacobian(g, c) * sp.Matrix(c.v)


def acceleration_bias(g: Sequence[sp.Expr], c: Coordinates) -> sp.Matrix:
    """γ = G' v, shape (k, 1), so that g'' = G a + γ."""
    return jacobian(g, c).applyfunc(lambda entry: total_derivative(entry, c)) * sp.Matrix(c.v)


def schur(M: sp.Matrix, G: sp.Matrix) -> sp.Matrix:
    """S = G M⁻¹ Gᵀ, shape (k, k): the inverse mass seen along the constraint forces.

    Raises SingularError when det M vanishes identically.
    """
    return G * linear_solve(M, G.T, "schur: the mass matrix is singular (det M = 0): M⁻¹ does not exist")


def constrained_accelerations(
    system: Constrained, forces: Sequence[sp.Expr] | None = None
) -> tuple[sp.Matrix, sp.Matrix]:
    """(a, λ), shapes (n, 1) and (k, 1), at a state that satisfies the constraints; Q = forces.

    Raises SingularError when det M or det S vanishes identically, InputError when there are not n forces.
    """
    L, c, g = system.L, system.c, system.g
    M, G = mass_matrix(L, c), jacobian(g, c)
    push = force_column(forces, c, "constrained_accelerations") - bias(L, c)
    # M⁻¹ (Q − h) and W = M⁻¹ Gᵀ side by side, so that M is inverted once.
    solved = linear_solve(M, push.row_join(G.T), singular_mass("constrained_accelerations", M, c))
    free, W = solved[:, :1], solved[:, 1:]
    violated = G * free + acceleration_bias(g, c)
    lam = -linear_solve(G * W, violated, dependent_rows("constrained_accelerations", "det S = 0"))
    return free + W * lam, lam


def degrees_of_freedom(system: Constrained, at: Mapping[sp.Symbol, float]) -> int:
    """n − rank G at one configuration. The rank is numerical: the singular values of G above rounding.

    Raises InputError when a symbol of G has no value in `at`.
    """
    G = jacobian(system.g, system.c).subs(at)
    if G.free_symbols:
        raise InputError(
            f"degrees_of_freedom: {', '.join(sorted(map(str, G.free_symbols)))} without a value: "
            "the rank of G belongs to one configuration; give every symbol a number"
        )
    k, n = G.shape
    return n - int(np.linalg.matrix_rank(np.array(G.tolist(), dtype=float))) if k else n


def solve_constrained(M: Array, h: Array, G: Array, gamma: Array, Q: Array) -> tuple[Array, Array]:
    """(a, λ) at one state, shapes (n,) and (k,), from M (n, n), h (n,), G (k, n), γ (k,), Q (n,).

    Raises SingularError when M is singular or the rows of G are linearly dependent.
    """
    W, S = _normals("solve_constrained", G, M)
    free = np.linalg.solve(M, Q - h)
    lam = -np.linalg.solve(S, G @ free + gamma)
    return free + W @ lam, lam


def project_position(
    g_fun: Callable[[Array], Array],
    G_fun: Callable[[Array], Array],
    q: Array,
    mass: Array | None = None,
    tol: float = 1e-14,
    max_steps: int = 20,
) -> Array:
    """The configuration with g = 0 reached from q by Newton's method along M⁻¹ Gᵀ: q ← q − M⁻¹ Gᵀ S⁻¹ g.

    To first order in the distance it is the nearest one in the mass metric (M = 1 when none is given). The steps end
    when one is shorter than tol (1 + |q|): a length in q, whatever the units of g.

    Raises ConstraintError with the residual left after max_steps, SingularError where the rows of G are dependent.
    """
    start, q = q, np.array(q, dtype=float)
    for _ in range(max_steps):
        W, S = _normals("project_position", G_fun(q), mass)
        step = W @ np.linalg.solve(S, g_fun(q))
        q = q - step
        if np.linalg.norm(step) <= tol * (1 + np.linalg.norm(q)):
            return q
    raise ConstraintError(
        f"project_position: |g| = {np.linalg.norm(g_fun(q)):.3g} left after {max_steps} steps from q = {start}: "
        "Newton's method has not reached the constraints; start nearer to them"
    )


def project_velocity(G: Array, v: Array, mass: Array | None = None) -> Array:
    """v − M⁻¹ Gᵀ S⁻¹ G v, shape (n,): the velocity with G v = 0 nearest to v in the mass metric (M = 1 if none).

    Raises SingularError when M is singular or the rows of G are linearly dependent.
    """
    W, S = _normals("project_velocity", G, mass)
    return v - W @ np.linalg.solve(S, G @ v)


def dependent_rows(where: str, value: str) -> str:
    """The refusal of constraints that repeat each other."""
    return f"{where}: the constraints are dependent ({value}): their multipliers are not unique; drop a constraint"


def _normals(where: str, G: Array, mass: Array | None) -> tuple[Array, Array]:
    """W = M⁻¹ Gᵀ and S = G W, once S is known to be invertible."""
    try:
        W = G.T if mass is None else np.linalg.solve(mass, G.T)
    except np.linalg.LinAlgError:
        raise SingularError(f"{where}: the mass matrix is singular at this state: use fewer coordinates") from None
    S = G @ W
    # Scaled to a unit diagonal, S holds the cosines between the constraint normals: free of the constraints' units.
    length = np.sqrt(np.abs(np.diag(S)))
    if not (np.isfinite(length).all() and length.all()):
        raise SingularError(dependent_rows(where, f"lengths of the normals: {length}"))
    spread = np.linalg.svd(S / np.outer(length, length), compute_uv=False)
    if spread.size and spread[0] > WORST_CONDITION * spread[-1]:
        raise SingularError(dependent_rows(where, f"singular values of S, scaled: {spread}"))
    return W, S
