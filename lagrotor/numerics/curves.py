"""Numbers read off curves: orders in an amplitude, swings, spectra and their peaks, means over whole turns."""

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


def spectrum(t: Array, x: Array) -> tuple[Array, Array]:
    """Rates (rad/s) below 30 and amplitudes (m) of x less its mean: Hann window, padded eightfold."""
    window = np.hanning(len(t))
    weight = (x - (x * window).sum() / window.sum()) * window
    amplitude = 2 * np.abs(np.fft.rfft(weight, 8 * len(t))) / window.sum()
    rate = 2 * np.pi * np.fft.rfftfreq(8 * len(t), t[1] - t[0])
    return rate[rate < 30], amplitude[rate < 30]


def peak(rate: Array, amplitude: Array) -> float:
    """Rate (rad/s) of the highest peak: the top of the parabola through the logarithms of its three highest points."""
    n = int(np.argmax(amplitude))
    before, top, after = np.log(amplitude[n - 1 : n + 2])
    return float(rate[n] + (before - after) / (before - 2 * top + after) / 2 * (rate[1] - rate[0]))


def mean_between(t: Array, x: Array, start: float, end: float) -> Array:
    """Mean of x (n,) or (n, k), given at times t (n,), from `start` to `end`: of whole turns, it is their centre."""
    times = np.linspace(start, end, 400, endpoint=False)
    columns = x.reshape(len(t), -1).T
    return np.array([np.interp(times, t, column).mean() for column in columns]).reshape(x.shape[1:])


def turn_means(t: Array, tips: Array) -> tuple[Array, Array]:
    """Times (n + 1,) at which y_1 − y_2 rises through mid-range, and the tips' means over the turns (2, n, 3)."""
    apart = tips[0, :, 1] - tips[1, :, 1]
    apart = apart - (apart.max() + apart.min()) / 2
    up = np.flatnonzero((apart[:-1] < 0) & (apart[1:] >= 0))
    crossings = t[up] - apart[up] * (t[up + 1] - t[up]) / (apart[up + 1] - apart[up])
    steps = np.diff(t)[:, None] * (tips[:, 1:] + tips[:, :-1]) / 2
    sums = np.concatenate([np.zeros((2, 1, 3)), steps.cumsum(1)], axis=1)
    at = np.array([[np.interp(crossings, t, sums[i, :, j]) for j in range(3)] for i in (0, 1)]).swapaxes(1, 2)
    return crossings, np.diff(at, axis=1) / np.diff(crossings)[:, None]
