"""Judging one motion against another: orders in an amplitude, swings, the ansatz integral along a run."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.pair.trajectory import Trajectory

Array = NDArray[np.float64]


def measured_order(amplitudes: ArrayLike, errors: ArrayLike) -> float:
    """The power p of errors ~ amplitudes**p: the slope of a straight line through the logarithms."""
    slope, _ = np.polyfit(np.log(np.asarray(amplitudes, float)), np.log(np.asarray(errors, float)), 1)
    return float(slope)


def swing(values: Array) -> float:
    """Largest less smallest value."""
    return float(np.ptp(values))


def ansatz_A(run: Trajectory) -> Array:
    """A = p_phi1 − p_phi2 along a run, (n,), in kg m²/s: the paper's integral (5.12), the bar's inertia included."""
    a, b = run.scene.inertias
    (r1, r2), (v1, v2) = run.axes, run.rates
    about_z = np.cross(r1, a * v1 + b * v2)[:, 2] - np.cross(r2, a * v2 + b * v1)[:, 2]
    return about_z + run.momenta[0] * r1[:, 2] - run.momenta[1] * r2[:, 2]
