"""A rate and its first harmonics fitted to a run by least squares, beside a constant and a slope."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Harmonics:
    """x(t) ≈ constant + slope (t − t̄) + Re Σ wave_n exp(i n rate (t − t_0)), each (k,) for k columns of x.

    waves (count, k), complex; rest (n, k) what the fit leaves.
    """

    rate: float
    constant: Array
    slope: Array
    waves: NDArray[np.complex128]
    rest: Array

    @property
    def left(self) -> float:
        """Sum of the squares that the fit leaves."""
        return float((self.rest**2).sum())


def harmonics_at(t: Array, x: Array, rate: float, count: int = 2) -> Harmonics:
    """The fit of `count` harmonics of a given rate (rad/s) to x (n, k) or (n,) at times t (n,) in s."""
    s, columns = t - t[0], x.reshape(len(t), -1)
    waves = [wave(n * rate * s) for n in range(1, count + 1) for wave in (np.cos, np.sin)]
    table = np.column_stack([np.ones_like(s), s - s.mean(), *waves])
    parts = np.linalg.lstsq(table, columns, rcond=None)[0]
    return Harmonics(rate, parts[0], parts[1], parts[2::2] - 1j * parts[3::2], columns - table @ parts)


def best_harmonics(t: Array, x: Array, guess: float, low: float = 0.8, high: float = 1.3, count: int = 2) -> Harmonics:
    """The fit that leaves least, its rate sought from `low` to `high` times a guess (rad/s).

    On a grid first, five cells to a turn of the phase over the whole run; then within the best cell and its neighbour.
    """
    from scipy.optimize import minimize_scalar

    def left(rate: float) -> float:
        return harmonics_at(t, x, rate, count).left

    step = 2 * np.pi / (t[-1] - t[0]) / 5  # a fifth of what takes the phase once round over the run
    grid = np.append(np.arange(low * guess, high * guess, step), high * guess)
    best = float(grid[np.argmin([left(rate) for rate in grid])])
    found = minimize_scalar(left, bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-7 * guess})
    return harmonics_at(t, x, float(found.x), count)
