"""The errors of the closed forms of the paired orbit for many amplitudes and spin ratios, compared with one exact ensemble."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from lagrotor.benchmark.runner import check_work
from lagrotor.errors import InputError
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.sweeps.sweep import sweep
from lagrotor.numerics.arrays import Array
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series import paired_series, shape_of

USEFUL = 0.1  # largest error relative to the amplitude for which a series is a correction
_TIMES = 12


@dataclass(frozen=True, eq=False)
class Usefulness:
    """The errors of the series for opposite spins, for each order, departure and amplitude.

    The amplitudes are r0 (n,), the departures from opposite spins 1 + omega_2/omega_1 (m,). The errors in units of R have the
    shape (orders, m, n). An error is the largest distance over the first turn between the axes of the series and of the exact
    pair from the same start.
    """

    amplitudes: Array
    departures: Array
    orders: tuple[int, ...]
    errors: Array


def usefulness(
    amplitudes: Array, departures: Array, orders: tuple[int, ...] = (1, 3, 5), spin: float = 10.0, tol: float = 1e-10
) -> Usefulness:
    """Compare each series, at its own frequency, with the exact run of every scene of the grid over one turn.

    Raises InputError if amplitudes or departures are not rows of numbers.
    """
    if np.ndim(amplitudes) != 1 or np.ndim(departures) != 1 or not len(amplitudes) or not len(departures):
        raise InputError("usefulness: amplitudes and departures must be rows of numbers")
    base = Scene((spin, -spin))
    starts = [exact_orbit(base, float(r0)).scene for r0 in amplitudes]
    scenes = [replace(scene, spins=(spin, -spin * (1 - float(d)))) for d in departures for scene in starts]
    times = 2 * pi / natural_rate(base) * np.arange(1, _TIMES + 1) / _TIMES
    runs = sweep(scenes, [0.0, *times], tol)
    check_work("the map of errors", runs.evaluations.min(), runs.axes[:, 0], float(runs.error.max()), 10 * tol)
    exact = runs.axes[:, :, 1:].reshape(len(departures), len(amplitudes), 2, _TIMES, 3)
    errors = np.empty((len(orders), len(departures), len(amplitudes)))
    for i, order in enumerate(orders):
        series = paired_series(order, *shape_of(base))
        for j, r0 in enumerate(amplitudes):
            phases = natural_rate(base) * series.relative_frequency(float(r0)) * times
            difference = exact[:, j] - series.axes(float(r0), phases)
            errors[i, :, j] = np.linalg.norm(difference, axis=-1).max((1, 2))
    return Usefulness(np.asarray(amplitudes, float), np.asarray(departures, float), orders, errors)
