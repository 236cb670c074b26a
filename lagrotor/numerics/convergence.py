"""Judging one motion against another: orders in an amplitude, swings, the ansatz integral along a run."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def measured_order(amplitudes: ArrayLike, errors: ArrayLike) -> float:
    """The power p of errors ~ amplitudes**p: the slope of a straight line through the logarithms."""
    slope, _ = np.polyfit(np.log(np.asarray(amplitudes, float)), np.log(np.asarray(errors, float)), 1)
    return float(slope)


def swing(values: Array) -> float:
    """Largest less smallest value."""
    return float(np.ptp(values))
