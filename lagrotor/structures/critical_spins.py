"""The least factor on all its spins from which on a structure stands upright to first order, and the signs for which it is least.

What weight tips over, spin alone may hold. Without friction, K the stiffness and B the gyroscopic matrix on the n degrees of
freedom:

- an odd number of degrees of freedom that fall (det K < 0) falls at any spin (Kelvin; Thomson & Tait, Natural Philosophy, § 345);
- where all of K is negative it stands from some spin on if and only if det B ≠ 0, and that is the factor

      max_k min_ω λ_k(ω),   λ_k the positive roots of det(ω M + |K|/ω − λ i B) = 0,

  as above every branch's minimum each branch gives two real rates ω, n in all, and no more exist;
- with M = a 1 and K = −κ 1 (massless bars, equal loads) that is 2 sqrt(a κ)/β, i β the least root of B.

Friction on every axis undoes it: what fell still falls, however slowly (Kelvin, Tait & Chetaev: Merkin, § 6.5). So does friction
on some, where spins and stiffness let it act on what falls.

All of this is the linear motion.
"""

from dataclasses import dataclass
from itertools import product
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.small_motion import SmallMotion, check_upright, small_motion

_MOST = 12  # rotors whose patterns of signs are tried
_SAME = 1e-9  # relative: spins as near as that are one
_GRID = np.geomspace(1e-3, 1e4, 281)  # of the natural factor: where thresholds are looked for when K is of both signs


def critical_spin(s: Assembly) -> float:
    """The factor on all spins from which on the linear motion stays bounded, at every larger one too: to first order.

    At single factors beyond, resonances may let a push fall: `spin_intervals` gives those at which none does.

    0 where every factor will do, inf where none does, as with friction on a motion that falls without spins, or with a motion
    that nothing holds and no spin acts on. Friction reaches a motion through couplings of stiffness and spins of more than
    1e-10 of the largest: weaker ones cannot be distinguished from rounding, and are taken for none.
    Raises InputError where upright breaks a bar's length.
    """
    check_upright(s, "critical_spin")
    return spin_threshold(small_motion(s))


def spin_threshold(linear: SmallMotion) -> float:
    """`critical_spin` of a linear system."""
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
    """K in the metric of M, in units of pull²: whatever the spins, what falls is not taken for neutral."""
    root = np.linalg.inv(np.linalg.cholesky(linear.mass))
    return np.asarray(root @ linear.stiffness @ root.T / (linear.pull or linear.rate) ** 2)


def friction_undoes(linear: SmallMotion) -> bool:
    """Whether friction lets fall, at any spins, what falls without: K is negative on the motions that it reaches.

    They are those that are rubbed themselves, and what K and G make of them: the least such subspace, on which every motion is
    damped in time, so that the theorem of Kelvin, Tait & Chetaev holds. The rest moves by itself.
    """
    root, K = np.linalg.inv(np.linalg.cholesky(linear.mass)), stiffness_in_masses(linear)
    forms = [f / (np.abs(f).max() or 1.0) for f in (K, root @ linear.gyroscopic @ root.T)]
    scale = np.sqrt(np.diag(linear.damping))
    scale = np.where(scale > 0, scale, 1)  # however little of it there is
    rows = root @ (scale[:, None] * _range(linear.damping / np.outer(scale, scale)))
    reached = _range(rows / np.linalg.norm(rows, axis=0))
    while (wider := _range(np.hstack([reached, *(f @ reached for f in forms)]))).shape[1] > reached.shape[1]:
        reached = wider
    return bool(reached.shape[1] and np.linalg.eigvalsh(reached.T @ K @ reached)[0] < -1e-12)


def _range(columns: Array) -> Array:
    """An orthonormal basis of what columns span."""
    vectors, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(vectors[:, sizes > 1e-10 * sizes.max(initial=0.0)])


def _by_branches(linear: SmallMotion) -> float:
    """All of K negative: one over the largest, over ω, of the least positive root h of det(i B − h (ω M + |K|/ω)) = 0."""
    from scipy.linalg import eigh
    from scipy.optimize import minimize_scalar

    M, H, K = linear.mass, 1j * linear.gyroscopic, -linear.stiffness
    size = np.abs(np.linalg.eigvalsh(H)).max()
    half = len(M) // 2
    if np.sort(np.abs(np.linalg.eigvalsh(H)))[0] <= 1e-9 * size:
        return inf

    squares, shapes = eigh(K, M)
    modal = shapes.T @ H @ shapes  # as M is one and K diagonal there, so is ω M + K/ω

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
    """The largest factor at which growth ends, by scan and bisection; windows narrower than the scan are not seen."""
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


@dataclass(frozen=True)
class Patterns:
    """tried: patterns; standing: how many stand at some spin; least: the least spin (rad/s, inf where none); best: the
    first pattern that needs it.
    """

    tried: int
    standing: int
    least: float
    best: tuple[int, ...]


def sign_patterns(s: Assembly) -> Patterns:
    """The structure of equal |spin| with each pattern of signs, the first sign +; at most 12 rotors.

    A turn of all signs changes nothing (a mirror image).

    Raises
    ------
    InputError
        For more rotors, and where upright breaks a bar's length.
    """
    N = len(s.joints)
    if N > _MOST:
        raise InputError(f"sign_patterns: {N} rotors have 2^{N - 1} patterns: at most {_MOST} rotors")
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
