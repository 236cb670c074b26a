"""Numbers read off curves: orders in an amplitude, swings, spectra and their peaks, means over whole turns, fits of harmonics."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.numerics.arrays import Array


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
    first, top, last = np.log(amplitude[n - 1 : n + 2])
    return float(rate[n] + (first - last) / (first - 2 * top + last) / 2 * (rate[1] - rate[0]))


def mean_between(t: Array, x: Array, start: float, end: float) -> Array:
    """Mean of x: of whole turns, it is their centre.

    Parameters
    ----------
    t : Array
        Times (n,).
    x : Array
        (n,) or (n, k).
    start : float
        From this time.
    end : float
        To this.
    """
    times = np.linspace(start, end, 400, endpoint=False)
    columns = x.reshape(len(t), -1).T
    return np.array([np.interp(times, t, column).mean() for column in columns]).reshape(x.shape[1:])


def first_passage(t: Array, x: Array, level: float) -> float:
    """Return when x first rises to a level, on the cubic spline through its samples; infinity where it does not.

    Parameters
    ----------
    t : Array
        Times (n,).
    x : Array
        Samples (n,) of a smooth curve.
    level : float
        The value to be passed.
    """
    from scipy.interpolate import CubicSpline

    if x[0] >= level:
        return float(t[0])
    return float(min(CubicSpline(t, x).solve(level, extrapolate=False), default=np.inf))


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


@dataclass(frozen=True, eq=False)
class Harmonics:
    """x(t) ≈ constant + slope (t − t̄) + Re Σ wave_n exp(i n rate (t − t_0)), each (k,) for k columns of x.

    waves (count, k), complex; rest (n, k) what the fit leaves.
    """

    rate: float
    constant: Array
    slope: Array
    waves: NDArray[np.complex128]
    residual: Array

    @property
    def residual_squares(self) -> float:
        """Sum of the squares that the fit leaves."""
        return float((self.residual**2).sum())


def harmonics_at(t: Array, x: Array, rate: float, count: int = 2) -> Harmonics:
    """The fit of harmonics of a given rate.

    Parameters
    ----------
    t : Array
        Times (n,), s.
    x : Array
        (n,) or (n, k).
    rate : float
        Rad/s.
    count : int, default 2
        Of harmonics.
    """
    s, columns = t - t[0], x.reshape(len(t), -1)
    waves = [wave(n * rate * s) for n in range(1, count + 1) for wave in (np.cos, np.sin)]
    table = np.column_stack([np.ones_like(s), s - s.mean(), *waves])
    coefficients = np.linalg.lstsq(table, columns, rcond=None)[0]
    return Harmonics(
        rate,
        coefficients[0],
        coefficients[1],
        coefficients[2::2] - 1j * coefficients[3::2],
        columns - table @ coefficients,
    )


def best_harmonics(t: Array, x: Array, guess: float, low: float = 0.8, high: float = 1.3) -> Harmonics:
    """The fit that leaves least.

    Its rate is sought on a grid, five cells to a turn of the phase over the whole run; then within the best cell and its
    neighbour.

    Parameters
    ----------
    t : Array
        Times (n,), s.
    x : Array
        (n,) or (n, k).
    guess : float
        Of the rate, rad/s.
    low : float, default 0.8
        Times the guess, from which it is sought.
    high : float, default 1.3
        Times the guess, to which.
    """
    from scipy.optimize import minimize_scalar

    def misfit(rate: float) -> float:
        return harmonics_at(t, x, rate).residual_squares

    step = 2 * np.pi / (t[-1] - t[0]) / 5  # a fifth of what takes the phase once round over the run
    grid = np.append(np.arange(low * guess, high * guess, step), high * guess)
    best = float(grid[np.argmin([misfit(rate) for rate in grid])])
    minimum = minimize_scalar(
        misfit, bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-7 * guess}
    )
    return harmonics_at(t, x, float(minimum.x))
