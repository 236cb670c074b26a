"""Equilibria with tilted axes and small motion about them, for bars of any length.

On the tangent space of the constraints, r = r₀ + T q with T orthonormal, the exact accelerations a(r, r') give

    q'' = Tᵀ ∂a/∂r T q + Tᵀ ∂a/∂r' T q',    K = −M Tᵀ ∂a/∂r T,    C = −M Tᵀ ∂a/∂r' T,    M = Tᵀ A T,

where central differences of fourth order give the derivatives. Steps −|K|⁻¹ ∂V/∂q find the equilibrium. Near a minimum of the
energy they are Newton's steps; elsewhere they descend in energy.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError, InputError
from lagrotor.numerics.arrays import finite_array
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.bar_closure import close_bars
from lagrotor.structures.exact.exact_motion import ExactMotion, exact_motion, off_constraints, pulls
from lagrotor.structures.small_motion import Modes, SmallMotion, left_by, modes_of

_STEP = 1e-3  # of the differences; their error is about 10⁻² times its fourth power
_SOFT = 1e-9  # relative to the largest stiffness: below it, within the error of differences, zero
_AT_REST = 1e-9  # relative to the rate squared: smaller accelerations are zero
_MOST = 60  # steps


def rest_near(s: Assembly, tilt: ArrayLike) -> Array:
    """Find an equilibrium by descending in energy: see `Structure.rest_near`."""
    motion, N = exact_motion(s), len(s.joints)
    start = finite_array("rest_near: tilt", tilt, (N, 2))
    if not (np.hypot(*start.T) < 1).all():
        raise InputError(f"rest_near: tilt = {start.tolist()}: x and y of an axis must have x² + y² < 1")
    r = close_bars(motion, np.column_stack([start, np.sqrt(1 - np.square(start).sum(1))]))
    for _ in range(_MOST):
        T = constraint_tangents(motion, r)
        residual = T.T @ motion.accelerations(0.0, r, 0 * r).ravel()
        if np.abs(residual).max(initial=0) < 1e-13 * motion.c.rate**2:
            return r
        M, stiff, vectors, _ = _linear(motion, r, T)
        soft = stiff == 0
        step = vectors @ (np.where(soft, 0, vectors.T @ M @ residual) / np.where(soft, 1, np.abs(stiff)))
        trial = r + (T @ step).reshape(N, 3) * min(1.0, 0.2 / max(float(np.abs(step).max()), 1e-300))
        try:
            r = close_bars(motion, trial / np.linalg.norm(trial, axis=1)[:, None])
        except ConstraintError:
            break
    if np.abs(residual).max(initial=0) < _AT_REST * motion.c.rate**2:
        return r
    raise InputError(f"rest_near: no equilibrium is reached from tilt = {start.tolist()}: start nearer to one")


def modes_about(s: Assembly, axes: ArrayLike) -> Modes:
    """Compute the normal modes about a tilted equilibrium: see `Structure.modes_about`."""
    motion, N = exact_motion(s), len(s.joints)
    r = finite_array("modes_about: axes", axes, (N, 3))
    residual = max(
        float(np.abs(motion.accelerations(0.0, r, 0 * r)).max()) / motion.c.rate**2,
        float((np.abs(off_constraints(motion.c, r)) / np.append(np.ones(N), motion.c.ell**2)).max()),
    )
    if not residual < 10 * _AT_REST:
        raise InputError(
            f"modes_about: the structure is not at rest at these axes (residual {residual:.1e}): give axes from rest_near"
        )
    T = constraint_tangents(motion, r)
    M, stiff, vectors, C = _linear(motion, r, T)
    damping = (C + C.T) / 2 * bool(motion.c.friction.any() or motion.c.damping.any())
    linear = SmallMotion(M, damping, (C - C.T) / 2, vectors * stiff @ vectors.T, T, motion.c.rate)
    return modes_of(linear, linear, components=3)


def _linear(motion: ExactMotion, r: Array, T: Array) -> tuple[Array, Array, Array, Array]:
    """Return M, the eigenvalues and eigenvectors of K, and C (damping plus gyroscopic) at an equilibrium. Eigenvalues within
    the error of the differences are set to zero."""
    M = np.asarray(T.T @ np.kron(motion.c.inertia, np.eye(3)) @ T)
    K, C = (-M @ slope for slope in _slopes(motion, r, T))
    stiff, vectors = np.linalg.eigh((K + K.T) / 2)
    return M, np.where(np.abs(stiff) < _SOFT * np.abs(stiff).max(initial=0), 0, stiff), vectors, C


def constraint_tangents(motion: ExactMotion, r: Array) -> Array:
    """Return an orthonormal basis (3N, n) of the tangent space of the constraints at the axes r (N, 3)."""
    c, N = motion.c, len(r)
    rows = np.zeros((N + len(c.i), N, 3))
    rows[np.arange(N), np.arange(N)] = r
    bars = N + np.arange(len(c.i))
    rows[bars, c.i], rows[bars, c.j] = pulls(c, r)
    rank, vectors = left_by(rows.reshape(len(rows), -1))
    return np.asarray(vectors[:, int(rank) :])


def _slopes(motion: ExactMotion, r: Array, T: Array) -> tuple[Array, Array]:
    """Return Tᵀ ∂a/∂r T in 1/s² and Tᵀ ∂a/∂r' T in 1/s for the accelerations a at an equilibrium, (n, n) each."""
    rate, still = motion.c.rate, 0 * r

    def differences(at: Callable[[Array], tuple[Array, Array]]) -> Array:
        columns = []
        for direction in T.T.reshape(-1, *r.shape):
            terms = [
                w * motion.accelerations(0.0, *at(k * _STEP * direction))
                for w, k in ((8, 1), (-8, -1), (-1, 2), (1, -2))
            ]
            columns.append(T.T @ np.sum(terms, axis=0).ravel() / (12 * _STEP))
        return np.reshape(columns, (T.shape[1], -1)).T

    return differences(lambda change: (r + change, still)), differences(lambda change: (r, rate * change)) / rate
