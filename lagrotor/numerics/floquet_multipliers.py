"""Floquet multipliers with their errors: eigenvalues of products of matrices, and their printed form.

Rounding of a matrix hides eigenvalues below 10⁻¹⁶ of its norm. In a product of well-conditioned factors each eigenvalue is
resolved by the periodic Schur form (Bojanczyk, Golub & Van Dooren 1992, The periodic Schur decomposition).
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.arrays import Array
from lagrotor.result_display import scientific

_SWEEPS = 40  # sweeps of the orthogonal iteration: enough to separate eigenvalues whose ratio is 2
_APART = 1e-12  # entry of a direction below which two blocks count as separated


def product_eigenvalues(factors: Sequence[Array], error: float) -> tuple[NDArray[np.complex128], Array]:
    """Return the eigenvalues (n,) of a product of matrices (n, n), and their errors (n,); the first factor acts first. Orthogonal
    iteration makes the factors block triangular. A block has eigenvalues of nearly equal modulus, so that no larger one hides
    them. `error` is the relative error of each factor, or its absolute error if its norm is below one."""
    start, n = np.eye(len(factors[0])), len(factors[0])
    for _ in range(_SWEEPS):
        basis, triangles = start, list[tuple[Array, float]]()
        for factor in factors:
            basis, upper = np.linalg.qr(factor @ basis)
            triangles.append((upper, max(1.0, float(np.linalg.norm(factor, 2)))))
        turn, start = start.T @ basis, basis
    values, errors = list[complex](), list[float]()
    edges = [0, *(i for i in range(1, n) if np.abs(turn[i:, :i]).max() < _APART), n]
    for a, b in pairwise(edges):
        block, noise = turn[a:b, a:b], 0.0
        for upper, size in reversed(triangles):
            block = block @ upper[a:b, a:b]
            noise += error * size / max(float(np.linalg.norm(upper[a:b, a:b], -2)), size * np.finfo(float).tiny)
        roots, right = np.linalg.eig(block)
        conditions = np.linalg.norm(np.linalg.pinv(right, 0), axis=1) * np.linalg.norm(right, axis=0)
        several = np.linalg.norm(block, 2) * noise ** (1 / (b - a))  # bound for eigenvalues that nearly coincide
        values += roots.tolist()
        errors += np.minimum(conditions * noise * np.abs(roots), several).tolist()
    order = np.lexsort((np.imag(values), -np.abs(values)))
    return np.array(values, complex)[order], np.array(errors)[order]


def resolved_multipliers(values: NDArray[np.complex128], errors: Array) -> tuple[NDArray[np.complex128], Array]:
    """Return the multipliers and their errors. A multiplier below its error becomes NaN, and its error an upper bound of its
    modulus."""
    below = ~(np.abs(values) > errors)
    return np.where(below, complex(np.nan, np.nan), values), np.where(below, np.abs(values) + errors, errors)


def multiplier_rows(values: NDArray[np.complex128], errors: Array) -> dict[str, str]:
    """Describe each multiplier and its error in words, by name; a complex conjugate pair has one entry."""
    rows = list[str]()
    for value, error in zip(values.tolist(), errors.tolist(), strict=True):
        if value != value:
            rows.append(f"below {scientific(error)}")
        elif value.imag >= 0:
            number = f"{value.real:.8g}" + (f" ± {value.imag:.8g} i, of modulus {abs(value):.8g}" if value.imag else "")
            rows.append(f"{number}, known to {scientific(error, 1)}")
    return {f"multiplier {i + 1}": row for i, row in enumerate(rows)}
