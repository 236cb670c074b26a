"""The least factor on all spins above which a structure is linearly stable upright, and the signs of spins that minimise it.

Without friction, with K the stiffness and B the gyroscopic matrix on the n degrees of freedom:

- If an odd number of degrees of freedom is unstable (det K < 0), no spin stabilises the structure (Kelvin; Thomson & Tait,
  Natural Philosophy, § 345).
- If K is negative definite, the structure is stable above some spin if and only if det B ≠ 0. The factor is

      max_k min_ω λ_k(ω),   λ_k the positive roots of det(ω M + |K|/ω − λ i B) = 0.

  At a factor λ above its minimum, each of the n/2 branches λ_k gives two real rates ω. These are all n rates.
- For M = a 1 and K = −κ 1 (massless bars, equal loads) the factor is 2 sqrt(a κ)/β, with ±i β the smallest eigenvalues of B.

Friction on every axis makes the structure unstable again, however slowly (Kelvin, Tait & Chetaev: Merkin, § 6.5). Friction on
only some axes does so if spins and stiffness couple the damped motion to the unstable one.
"""

from dataclasses import dataclass
from itertools import product
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.small_motion import SmallMotion, check_upright, small_motion

_MOST = 12  # rotors
_SAME = 1e-9  # relative difference of spins that count as equal
_GRID = np.geomspace(1e-3, 1e4, 281)  # of the natural factor: the scan if K is indefinite


def critical_spin(s: Assembly) -> float:
    """Return the factor on all spins above which the linear motion stays bounded: see `Structure.critical_spin`. A motion that
    friction reaches only by a relative coupling below 1e-10 counts as undamped."""
    check_upright(s, "critical_spin")
    return spin_threshold(small_motion(s))


def spin_threshold(linear: SmallMotion) -> float:
    """Return the factor on all spins above which a linear system is stable: 0 if it needs no spin, inf if none suffices."""
    K = np.linalg.eigvalsh(stiffness_in_masses(linear))
    falling, factor = int((K < -1e-12).sum()), 0.0
    if falling:
        if falling % 2 or friction_undoes(linear):
            return inf
        if falling == len(K) and not linear.damping.any():
            return _by_branches(linear)
        factor = _by_scan(linear)
    return inf if factor < inf and linear.at_spins(2 * factor or 1.0).drifts else factor


def stiffness_in_masses(linear: SmallMotion) -> Array:
    """Return L⁻¹ K L⁻ᵀ / pull², (n, n), with M = L Lᵀ. The unit `pull` (rad/s) does not depend on the spins."""
    root = np.linalg.inv(np.linalg.cholesky(linear.mass))
    return np.asarray(root @ linear.stiffness @ root.T / (linear.pull or linear.rate) ** 2)


def friction_undoes(linear: SmallMotion) -> bool:
    """Return True if friction makes the motion unstable at every multiple of these spins.

    The theorem of Kelvin, Tait & Chetaev is applied to the smallest subspace that contains the damped motions and is invariant
    under K and the gyroscopic matrix. The motion is unstable if K has a negative eigenvalue on this subspace.
    """
    root, K = np.linalg.inv(np.linalg.cholesky(linear.mass)), stiffness_in_masses(linear)
    forms = [f / (np.abs(f).max() or 1.0) for f in (K, root @ linear.gyroscopic @ root.T)]
    scale = np.sqrt(np.diag(linear.damping))
    scale = np.where(scale > 0, scale, 1)  # friction counts however small it is
    rows = root @ (scale[:, None] * _range(linear.damping / np.outer(scale, scale)))
    reached = _range(rows / np.linalg.norm(rows, axis=0))
    while (wider := _range(np.hstack([reached, *(f @ reached for f in forms)]))).shape[1] > reached.shape[1]:
        reached = wider
    return bool(reached.shape[1] and np.linalg.eigvalsh(reached.T @ K @ reached)[0] < -1e-12)


def _range(columns: Array) -> Array:
    """Return an orthonormal basis of the span of the columns."""
    vectors, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(vectors[:, sizes > 1e-10 * sizes.max(initial=0.0)])


def _by_branches(linear: SmallMotion) -> float:
    """Return the critical factor if K is negative definite; inf if the gyroscopic matrix B is singular. The factor is 1/max
    h(ω), where h is the smallest positive root of det(i B − h (ω M + |K|/ω)) = 0."""
    from scipy.linalg import eigh
    from scipy.optimize import minimize_scalar

    M, H, K = linear.mass, 1j * linear.gyroscopic, -linear.stiffness
    size = np.abs(np.linalg.eigvalsh(H)).max()
    half = len(M) // 2
    if np.sort(np.abs(np.linalg.eigvalsh(H)))[0] <= 1e-9 * size:
        return inf

    squares, shapes = eigh(K, M)
    modal = shapes.T @ H @ shapes  # in this basis M = 1, and K and ω M + K/ω are diagonal

    def least(log_rates: ArrayLike) -> Array:
        w = np.exp(log_rates)[..., None]
        over = 1 / np.sqrt(w + squares / w)
        return np.asarray(np.linalg.eigvalsh(over[..., :, None] * modal * over[..., None, :])[..., half])

    log_natural = np.log(squares) / 2
    grid = np.linspace(log_natural[0] - 0.5, log_natural[-1] + 0.5, 101)
    values = least(grid)
    best = int(np.argmax(values))
    around = (grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)])
    highest = minimize_scalar(lambda at: -least(at), bounds=around, method="bounded", options={"xatol": 1e-10})
    return float(1 / max(-highest.fun, values[best]))


def _by_scan(linear: SmallMotion) -> float:
    """Find the largest factor at which growth ends, by a scan and bisection: 0 if no motion grows at any factor, inf if one
    grows at the largest. The factors of the scan are 6 % apart. Intervals of growth between two of them are missed."""
    size = np.abs(linear.gyroscopic).max()
    if size == 0:
        return inf
    natural = 2 * np.sqrt(np.abs(linear.stiffness).max() * np.abs(linear.mass).max()) / size
    grid = natural * _GRID
    falls = [linear.at_spins(factor).growth > 0 for factor in grid]
    if falls[-1]:
        return inf
    if not any(falls):
        return 0.0
    k = int(np.flatnonzero(falls)[-1])
    low, high = grid[k], grid[k + 1]
    while high - low > 1e-12 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if linear.at_spins(middle).growth > 0 else (low, middle)
    return float(high)


@dataclass(frozen=True, repr=False)
class Patterns(Shown):
    """The result of `sign_patterns`: `count` patterns of signs were tried, and a finite spin makes `standing` of them stable.
    The smallest critical spin is `least` (rad/s, inf if no pattern can be stable), and `best` are the signs of its pattern."""

    _shown = (
        ("patterns of signs", "count"),
        ("stable at a finite spin", "standing"),
        ("smallest critical spin [rad/s]", "least"),
        ("its signs", lambda p: " ".join("+" if sign > 0 else "−" for sign in p.best)),
    )

    count: int
    standing: int
    least: float
    best: tuple[int, ...]


def sign_patterns(s: Assembly) -> Patterns:
    """Find the signs of spins of equal size for which the critical spin is smallest.

    The first sign is always +, because a reversal of all signs only reflects the motion.

    Parameters
    ----------
    s : Assembly
        The structure, with at most 12 rotors.

    Returns
    -------
    Patterns
        The number of patterns tried, the number of stable ones, and the best pattern.

    Examples
    --------
    >>> from lagrotor.structures import example
    >>> sign_patterns(example("square")).best
    (1, 1, 1, -1)
    """
    N = len(s.joints)
    if N > _MOST:
        raise InputError(f"sign_patterns: {N} rotors have 2^{N - 1} patterns: give at most {_MOST} rotors")
    check_upright(s, "sign_patterns")
    linear = small_motion(s)
    I3 = np.array([rotor.I3 for rotor in s.rotor])
    needed = {}
    for further_signs in product((1, -1), repeat=N - 1):
        signs = (1, *further_signs)
        needed[signs] = spin_threshold(linear.with_momenta(I3 * np.array(signs)))
    least = min(needed.values())
    best = next(signs for signs, spin in needed.items() if spin <= least * (1 + _SAME))
    return Patterns(len(needed), sum(v < inf for v in needed.values()), least, best)
