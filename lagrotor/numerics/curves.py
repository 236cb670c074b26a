"""Numbers that are read off curves: orders of convergence, amplitudes, spectra, means over turns, fits of harmonics."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.numerics.arrays import Array


def measured_order(amplitudes: ArrayLike, errors: ArrayLike) -> float:
    """Fit the power p of errors ∝ amplitudes**p by a straight line through the logarithms.

    Parameters
    ----------
    amplitudes, errors : ArrayLike
        Positive numbers, shape (n,) each.

    Returns
    -------
    float
        The power p.
    """
    slope, _ = np.polyfit(np.log(np.asarray(amplitudes, float)), np.log(np.asarray(errors, float)), 1)
    return float(slope)


def swing(values: Array) -> float:
    """Return the largest value minus the smallest.

    Parameters
    ----------
    values : Array
        Samples of a curve.

    Returns
    -------
    float
        The difference, in the unit of the values.
    """
    return float(np.ptp(values))


def spectrum(t: Array, x: Array) -> tuple[Array, Array]:
    """Compute the amplitude spectrum of x minus its mean, in a Hann window that zeros extend to eight times its length.

    Parameters
    ----------
    t : Array
        Equally spaced times in s, shape (n,).
    x : Array
        Samples, shape (n,).

    Returns
    -------
    tuple of Array
        Rates below 30 rad/s, and the amplitude at each, in the unit of x.
    """
    window = np.hanning(len(t))
    weight = (x - (x * window).sum() / window.sum()) * window
    amplitude = 2 * np.abs(np.fft.rfft(weight, 8 * len(t))) / window.sum()
    rate = 2 * np.pi * np.fft.rfftfreq(8 * len(t), t[1] - t[0])
    return rate[rate < 30], amplitude[rate < 30]


def peak(rate: Array, amplitude: Array) -> float:
    """Find the rate of the highest peak, by a parabola through the logarithms of its three largest amplitudes.

    Parameters
    ----------
    rate, amplitude : Array
        Rates in rad/s and the amplitude at each, shape (n,).

    Returns
    -------
    float
        The rate in rad/s.
    """
    n = int(np.argmax(amplitude))
    first, top, last = np.log(amplitude[n - 1 : n + 2])
    return float(rate[n] + (first - last) / (first - 2 * top + last) / 2 * (rate[1] - rate[0]))


def mean_between(t: Array, x: Array, start: float, end: float) -> Array:
    """Return the mean of x from time `start` to time `end`, by linear interpolation. For x of shape (n,) it is a number, for (n,
    k) its shape is (k,)."""
    times = np.linspace(start, end, 400, endpoint=False)
    columns = x.reshape(len(t), -1).T
    return np.array([np.interp(times, t, column).mean() for column in columns]).reshape(x.shape[1:])


def first_passage(t: Array, x: Array, level: float) -> float:
    """Find the first time at which x rises to a level, on the cubic spline through its samples.

    Parameters
    ----------
    t : Array
        Times in s, shape (n,).
    x : Array
        Samples of a smooth curve, shape (n,).
    level : float
        The level, in the unit of x.

    Returns
    -------
    float
        The time in s; infinity if x stays below the level.
    """
    from scipy.interpolate import CubicSpline

    if x[0] >= level:
        return float(t[0])
    return float(min(CubicSpline(t, x).solve(level, extrapolate=False), default=np.inf))


def turn_means(t: Array, tips: Array) -> tuple[Array, Array]:
    """Compute the mean positions of both tips over each turn.

    A turn lasts from one upward passage of y₁ − y₂ through the middle of its range to the next.

    Parameters
    ----------
    t : Array
        Times in s, shape (n,).
    tips : Array
        Positions of both tips in m, shape (2, n, 3).

    Returns
    -------
    tuple of Array
        The times in s between the turns, shape (m + 1,), and the mean positions in m, shape (2, m, 3).
    """
    apart = tips[0, :, 1] - tips[1, :, 1]
    apart = apart - (apart.max() + apart.min()) / 2
    up = np.flatnonzero((apart[:-1] < 0) & (apart[1:] >= 0))
    crossings = t[up] - apart[up] * (t[up + 1] - t[up]) / (apart[up + 1] - apart[up])
    steps = np.diff(t)[:, None] * (tips[:, 1:] + tips[:, :-1]) / 2
    sums = np.concatenate([np.zeros((2, 1, 3)), steps.cumsum(1)], axis=1)
    at = np.array([[np.interp(crossings, t, sums[i, :, j]) for j in range(3)] for i in (0, 1)]).swapaxes(1, 2)
    return crossings, np.diff(at, axis=1) / np.diff(crossings)[:, None]


@dataclass(frozen=True, eq=False)
class Harmonics:
    """A fit x(t) ≈ constant + slope (t − t̄) + Re Σ waves_n exp(i n rate (t − t_0)) of k columns of samples. The rate is in
    rad/s; `constant` and `slope` have the shape (k,). The complex amplitudes of the harmonics 1, 2, … are `waves`, shape (count,
    k). The samples minus the fit are `residual`, shape (n, k)."""

    rate: float
    constant: Array
    slope: Array
    waves: NDArray[np.complex128]
    residual: Array

    @property
    def residual_squares(self) -> float:
        """The sum of the squares of the residual."""
        return float((self.residual**2).sum())


def harmonics_at(t: Array, x: Array, rate: float, count: int = 2) -> Harmonics:
    """Fit a constant, a slope and `count` harmonics of a rate in rad/s to samples x, shape (n,) or (n, k), at the times t in
    s."""
    s, columns = t - t[0], x.reshape(len(t), -1)
    waves = [wave(n * rate * s) for n in range(1, count + 1) for wave in (np.cos, np.sin)]
    table = np.column_stack([np.ones_like(s), s - s.mean(), *waves])
    fit = np.linalg.lstsq(table, columns, rcond=None)[0]
    return Harmonics(rate, fit[0], fit[1], fit[2::2] - 1j * fit[3::2], columns - table @ fit)


def best_harmonics(t: Array, x: Array, guess: float, low: float = 0.8, high: float = 1.3) -> Harmonics:
    """Fit two harmonics of the rate, between low · guess and high · guess in rad/s, that leaves the least residual. The rate is
    first sought on a grid; each cell changes the phase over the whole run by a fifth of a turn. Then it is refined near the best
    grid point."""
    from scipy.optimize import minimize_scalar

    def misfit(rate: float) -> float:
        return harmonics_at(t, x, rate).residual_squares

    step = 2 * np.pi / (t[-1] - t[0]) / 5
    grid = np.append(np.arange(low * guess, high * guess, step), high * guess)
    best = float(grid[np.argmin([misfit(rate) for rate in grid])])
    minimum = minimize_scalar(
        misfit, bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-7 * guess}
    )
    return harmonics_at(t, x, float(minimum.x))
