"""A periodic motion with the symmetry of the paired precession, as the harmonics of one axis.

    x_1 = sum_h X_h cos h Phi,    y_1 = sum_h Y_h sin h Phi,    z_1 = sum_h Z_h cos h Phi,

and r_2(Phi) = r_1(Phi + pi) with x → −x. `harmonics` is the array (X, Y, Z)_h, (H + 1, 3).
"""

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.printers import in_blocks


def axes_of(harmonics: Array, phase: ArrayLike) -> Array:
    """Return both axes, shape (2, …, 3), at phases in rad, shape (…).

    Clenshaw's recurrence in 2 Phi sums the even and the odd harmonics.
    """
    phases = np.asarray(phase, dtype=float)
    padded = np.pad(harmonics, ((0, len(harmonics) % 2), (0, 0)))
    rows = padded.reshape(-1, 6, 1)[::-1]  # even x, y, z and odd x, y, z, the highest first

    def of(block: Array) -> list[Array]:
        c, s = np.cos(block), np.sin(block)
        c_2, s_2 = 2 * c * c - 1, 2 * s * c
        b_1, b_2 = np.zeros((6, block.size)), np.zeros((6, block.size))
        for row in rows:
            b_1, b_2 = row + 2 * c_2 * b_1 - b_2, b_1
        even_x, even_z = (b_1[i] - b_2[i] * c_2 for i in (0, 2))
        odd_x, odd_z = (c * (b_1[i] - b_2[i]) for i in (3, 5))
        even_y, odd_y = s_2 * b_2[1], s * (b_1[4] + b_2[4])
        first = [odd_x + even_x, even_y + odd_y, even_z + odd_z]
        return [*first, odd_x - even_x, even_y - odd_y, even_z - odd_z]

    axes = in_blocks(of, [phases.ravel()], 6, phases.size)
    return np.moveaxis(axes.reshape(2, 3, *phases.shape), 1, -1)


def start_of(harmonics: Array) -> tuple[Array, Array]:
    """Return both axes at Phi = 0 and their derivatives with respect to the phase, each of shape (2, 3)."""
    h = np.arange(len(harmonics))
    signs = np.stack([h**0, (-1) ** h])
    parallel, perpendicular = np.array([1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    exchanged = np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])
    return exchanged * parallel * (signs @ harmonics), perpendicular * (signs * h @ harmonics)


def harmonic_momentum(harmonics: Array, frequency: float, inertias: tuple[float, float], momentum: float) -> float:
    """Return the momentum about the joint line at Phi = 0, P = sum_i (r_i × (a r_i' + b r_j'))_x + G (x_1 − x_2)."""
    a, b = inertias
    r, slope = start_of(harmonics)
    turning = np.cross(r, frequency * (a * slope + b * slope[::-1]))[:, 0].sum()
    return float(turning + momentum * (r[0, 0] - r[1, 0]))
