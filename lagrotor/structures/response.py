"""Transfer functions about upright: the tips' complex amplitudes under harmonic force and ground motion.

    X = R Z (−ω² M + i ω C + K)⁻¹ Zᵀ f,   f_i = R_i F_i − S_i a_ground,

for F e^(iωt) on the tips and the ground's acceleration a e^(iωt). Exact for small motion.
"""

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import finite_array
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Complex, coefficients
from lagrotor.structures.small_motion import check_upright, small_motion


def response(
    s: Assembly,
    rates: ArrayLike,
    force: ArrayLike | None = None,
    at: int | None = None,
    ground: ArrayLike | None = None,
) -> Complex:
    """Amplitudes (n, N, 2) of the tips' x and y in m at the rates (n,) in rad/s; relative to the ground.

    force: amplitude (x, y) in N on tip `at`, or (N, 2) on all; ground: amplitude (x, y) of its acceleration, m/s². Complex
    amplitudes have phases. Raises InputError for what makes no sense, and at the very rate of a resonance without damping.
    """
    check_upright(s, "response")
    c, linear = coefficients(s), small_motion(s)
    N, w = len(c.R), np.atleast_1d(finite_array("response: rates", rates))
    if w.ndim != 1:
        raise InputError(f"response: rates must be a row of numbers in rad/s, not of shape {w.shape}")
    F = np.zeros((N, 2), dtype=complex)
    if force is not None:
        F += c.R[:, None] * _forces(force, at, N)
    if ground is not None:
        F -= c.S[:, None] * finite_array("response: ground", ground, (2,), complex)
    if force is None and ground is None:
        raise InputError("response: give a force (x, y) in N with its tip `at`, or ground (x, y) in m/s²")
    right = linear.basis.T @ F.ravel()
    square = (w**2)[:, None, None]
    pencil = linear.stiffness - square * linear.mass + 1j * w[:, None, None] * (linear.damping + linear.gyroscopic)
    try:
        q = np.linalg.solve(pencil, np.broadcast_to(right[:, None], (len(w), len(right), 1)))[..., 0]
    except np.linalg.LinAlgError:
        raise InputError("response: one of the rates is a resonance without damping: give others, or damping") from None
    return np.asarray((q @ linear.basis.T).reshape(-1, N, 2) * c.R[:, None])


def _forces(force: ArrayLike, at: int | None, N: int) -> Complex:
    if at is None:
        return finite_array("response: force", force, (N, 2), complex)
    if isinstance(at, bool) or not isinstance(at, int) or not 0 <= at < N:
        raise InputError(f"response: at = {at!r} is no rotor: they are numbered 0 to {N - 1}")
    amplitudes = np.zeros((N, 2), dtype=complex)
    amplitudes[at] = finite_array("response: force", force, (2,), complex)
    return amplitudes
