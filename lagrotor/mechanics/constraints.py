"""Constraints in numbers: the multipliers at one state, and the projection onto the constraints.

With the mass matrix M, the bias h, the forces Q and the constraints' rows G and γ (see `equations`), the Schur complement
S = G M⁻¹ Gᵀ gives the multipliers and then the accelerations,

    λ = −S⁻¹ (G M⁻¹ (Q − h) + γ),        a = M⁻¹ (Q − h + Gᵀ λ).

Hairer, Lubich & Wanner, Geometric Numerical Integration, §§IV.4, VII.1.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import ConstraintError, SingularError
from lagrotor.mechanics.lagrangian import dependent_rows

Array = NDArray[np.floating[Any]]

# Beyond this condition number of the (row-scaled) Schur complement rounding errors exceed the multipliers.
WORST_CONDITION = 1e12


def solve_constrained(M: Array, h: Array, G: Array, gamma: Array, Q: Array) -> tuple[Array, Array]:
    """Solve M a + h = Q + Gᵀ λ and G a + γ = 0 for (a, λ), shapes (n,) and (k,)."""
    W, S = _normals("solve_constrained", G, M)
    free = np.linalg.solve(M, Q - h)
    lam = -np.linalg.solve(S, G @ free + gamma)
    return free + W @ lam, lam


_ROUNDING = 4 * float(np.finfo(float).eps)
_SHORT, _STEPS = 1e-14, 20  # Newton's method: the relative step at which it has converged, and the most steps


def project_position(
    g_fun: Callable[[Array], Array], G_fun: Callable[[Array], Array], q: Array, mass: Array | None = None
) -> Array:
    """Project a configuration onto g = 0 by Newton's method along M⁻¹ Gᵀ: q ← q − M⁻¹ Gᵀ S⁻¹ g.

    `g_fun` and `G_fun` return g, shape (k,), and its Jacobian G, shape (k, n). To first order in the distance the result is
    the nearest configuration in the mass metric. The iteration ends after a step below 10⁻¹⁴ (1 + |q|), or when g is below
    the rounding error of its terms. Near dependent constraints such a step may be longer.
    """
    start, q = q, np.array(q, dtype=float)
    for _ in range(_STEPS):
        G, g = G_fun(q), g_fun(q)
        W, S = _normals("project_position", G, mass)
        step = W @ np.linalg.solve(S, g)
        below_rounding = bool((np.abs(g) <= _ROUNDING * (np.abs(G) @ np.abs(q))).all())
        q = q - step
        if below_rounding or np.linalg.norm(step) <= _SHORT * (1 + np.linalg.norm(q)):
            return q
    raise ConstraintError(
        f"project_position: |g| = {np.linalg.norm(g_fun(q)):.3g} after {_STEPS} steps from q = {start}: "
        "Newton's method has not reached the constraints; start nearer to them"
    )


def project_velocity(G: Array, v: Array, mass: Array | None = None) -> Array:
    """Return the velocity with G v = 0 that is nearest to v in the mass metric, v − M⁻¹ Gᵀ S⁻¹ G v."""
    W, S = _normals("project_velocity", G, mass)
    return v - W @ np.linalg.solve(S, G @ v)


def _normals(where: str, G: Array, mass: Array | None) -> tuple[Array, Array]:
    """Return W = M⁻¹ Gᵀ and S = G W, or raise SingularError if M or S is singular."""
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
