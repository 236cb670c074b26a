"""The motion from a start near a paired precession: a fit of amplitude, phase and azimuth, and the series of the orbit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from math import exp, inf, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import DomainError
from lagrotor.models.model import Array, ClosedMotion
from lagrotor.numerics.error_estimate import UNKNOWN
from lagrotor.pair.scene import Link, Rotor, Scene
from lagrotor.result_display import superscript
from lagrotor.theory.natural_rate import natural_rate

if TYPE_CHECKING:
    import sympy as sp

    from lagrotor.mechanics.fourier import FourierSeries

_Waves = NDArray[np.complex128]
_ORDERS = (3, 5, 7, 9, 11, 13, 15)
_FURTHER = (17, 19, 21)  # they take a second to derive, and only this model by name uses them
_LARGEST = 0.5  # the largest amplitude of the series
_DERIVED = (9, 15, 21)  # the derived orders; lower orders truncate them
ROUND = 4e-16  # relative, of an angle
_SMALL = 0.1  # the largest error that is known to first order
# The effect on an axis of exchanging the rotors half a period later.
_MIRRORS = np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])


class _Series(NamedTuple):
    """The power series of the orbit in the amplitude r0, through one order.

    `waves[n, h, i]` is the coefficient of r0**n exp(i h Phi) in component i of the axis r_1, which is the real part of the sum.
    `frequency[n]` is the coefficient of r0**n in Omega/Omega_0. `wave_sizes` and `frequency_sizes` are the sizes of the
    coefficients of each power.
    """

    waves: _Waves
    frequency: Array
    wave_sizes: list[float]
    frequency_sizes: list[float]


@lru_cache(maxsize=64)
def _series(order: int, shape: sp.Rational, ratio: sp.Rational) -> _Series:
    """Return the series of the orbit through r0**order, for a pair of the ratios `shape` (of inertias) and `ratio` (k)."""
    from lagrotor.theory.paired_precession.series import paired_series

    series = paired_series(next(n for n in _DERIVED if n >= order), shape, ratio)
    waves, frequency = np.zeros((order + 1, order + 1, 3), dtype=complex), np.zeros(order + 1)
    for i, (component, width) in enumerate(((series.x, 1.0), (series.Y, sqrt(shape)), (series.z, 1.0))):
        for (n, h), value in _through(component, order):
            waves[n, abs(h), i] += width * float(value) * (1 if h >= 0 else -1j)
    for (n, _), value in _through(series.frequency, order):
        frequency[n] = float(value)
    return _Series(waves, frequency, np.abs(waves).sum(axis=(1, 2)).tolist(), np.abs(frequency).tolist())


def _through(series: FourierSeries, order: int) -> Iterator[tuple[tuple[int, int], Any]]:
    return ((term, value) for term, value in series.terms.items() if term[0] <= order)


def _summed(powers: Array, waves: _Waves) -> _Waves:
    """Return the harmonics sum_n powers_n waves_n, (…, order + 1, 3), for powers r0**n, (…, order + 1), of an amplitude."""
    summed: _Waves = powers @ waves.reshape(len(waves), -1)
    return summed.reshape(*powers.shape, 3)


def _axes_at(waves: _Waves, phase: float) -> Array:
    """Return the axes (…, 2, 3): Re sum_h waves_h exp(i h Phi) for rotor 1, its mirror image half a period later for rotor
    2."""
    turn = np.exp(1j * phase * np.arange(waves.shape[-2]))
    both = np.stack([turn, turn])
    both[1, 1::2] *= -1
    return np.real(both @ waves) * _MIRRORS


def _turned(vectors: Any, angle: float) -> Any:
    """Return the vectors (…, 3) rotated about the joint line by `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    return vectors @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])


def _fit(axes: Array, velocity: Array, unknowns: Array, series: _Series) -> tuple[Array, float]:
    """Return (r0, phase, azimuth) of the nearest orbit by two Gauss–Newton steps, and its distance from the start. The start
    has the axes `axes` and the rates `velocity` in units of Omega_0, (2, 3) each."""
    n = np.arange(len(series.frequency))
    derivatives = np.array([n**0, 1j * n, -(n**2), n**0, 1j * n])[..., None]  # the waves' derivatives by Phi
    target = np.stack([axes, velocity])
    reached, by = np.empty((2, 2, 3)), np.empty((2, 2, 3, 3))
    for last in (False, False, True):
        r0, phase, azimuth = unknowns
        powers = np.stack([r0**n, n * r0 ** np.maximum(n - 1, 0)])
        rate, rate_by_r0 = powers @ series.frequency
        curves = _axes_at(_summed(powers, series.waves)[[0, 0, 0, 1, 1]] * derivatives, phase)
        reached[0], slope, bend, grown, sloped = _turned(curves, azimuth)
        reached[1] = rate * slope
        residual = (target - reached).ravel()
        if last:
            break
        by[0, ..., 0], by[1, ..., 0] = grown, rate * sloped + rate_by_r0 * slope
        by[0, ..., 1], by[1, ..., 1] = slope, rate * bend
        by[..., 0, 2], by[..., 1, 2], by[..., 2, 2] = 0.0, -reached[..., 2], reached[..., 1]
        unknowns = unknowns + np.linalg.lstsq(by.reshape(12, 3), residual, rcond=None)[0]
    return unknowns, float(np.linalg.norm(residual))


def paired_answer(scene: Scene, axes: Array, rates: Array, t_end: float, tol: float, best: bool) -> ClosedMotion:
    """Return the motion of opposite spins near their paired precession.

    The error has two parts: the distance of the start from the orbit, which grows with the phase, and the last terms of the
    series, which exceed the omitted terms. Both parts grow exponentially on a hyperbolic orbit. Each order costs more than the
    order before. If the terms decrease too slowly for `tol`, no further order is derived unless `best` is True.
    """
    width, natural = sqrt(scene.sigma), natural_rate(scene)
    signed = natural if scene.spins[0] > 0 else -natural
    angle, velocity = natural * t_end, rates / signed
    guess = _guess(axes, velocity, width)

    from lagrotor.theory.paired_precession.stability import growth_bound

    shape, ratio = _shape(scene.rotor, scene.link)
    error, previous = inf, inf
    orders = (*_ORDERS, *_FURTHER) if best else _ORDERS
    r0 = float(guess[0])
    growth = exp(min(growth_bound(r0, float(shape), float(ratio)) * angle, 700.0))
    for order in orders:
        series = _series(order, shape, ratio)
        last = range(order - 1, order + 1)
        tail = sum(r0**n * series.wave_sizes[n] for n in last)
        slip = sum(r0**n * series.frequency_sizes[n] for n in last) * r0 * max(1.0, width)
        previous, error = error, tail * growth + slip * angle
        fall = (error / previous) ** ((orders[-1] - order) / 2) if order > 5 else 0.0
        if error <= tol / 4 or (error * fall > tol and not best):
            break
    unknowns, mismatch = _fit(axes, velocity, guess, series)
    powers = unknowns[0] ** np.arange(order + 1)
    error += (mismatch + ROUND) * (angle + growth)
    error = error if error < _SMALL else UNKNOWN  # above it the estimate is invalid
    frequency = signed * float(powers @ series.frequency)
    r0, phase, azimuth = (float(u) for u in unknowns)
    waves, odd = _summed(powers, series.waves), np.arange(order + 1)[:, None] % 2
    # Half a period later odd waves change sign.
    rotors = _turned(np.stack([waves, np.where(odd, -waves, waves)]) * _MIRRORS[:, None], azimuth)
    reason = f"on its paired precession of amplitude {r0:.3g}: periodic series through r₀{superscript(order)}"
    return ClosedMotion(error, reason, fourier_motion(rotors, frequency, phase))


@lru_cache(maxsize=64)
def _shape(rotor: Rotor, link: Link | None) -> tuple[sp.Rational, sp.Rational]:
    from lagrotor.theory.paired_precession.series import shape_of

    return shape_of(Scene((1.0, -1.0), rotor, link))


def _guess(axes: Array, velocity: Array, width: float) -> Array:
    """Return (r0, phase, azimuth) of the linear orbit x_i = r0 cos Phi, y_1 = −y_2 = width r0 sin Phi through a start. Raises
    DomainError if the start is not near such an orbit."""
    azimuth = float(np.arctan2(-axes[:, 1], axes[:, 2]).mean())
    first, second = np.stack([_turned(axes, -azimuth), _turned(velocity, -azimuth)], axis=1)
    (x, x_v), (y, y_v) = (first + second)[:, 0] / 2, (first - second)[:, 1] / (2 * width)
    r0, phase = float(np.hypot(x, y)), float(np.arctan2(y, x))
    residual = np.hypot(x_v + r0 * np.sin(phase), y_v - r0 * np.cos(phase))
    if not residual <= 2 * (1 + width**2) * r0**2 or r0 > _LARGEST:
        raise DomainError(
            f"closed_form: the start is not on a paired precession: its rates miss the orbit of amplitude {r0:.2g} by "
            f"{residual:.2g} of the natural rate; use paired_scene, or model='linear' or 'minimal'"
        )
    return np.array([r0, phase, azimuth])


def fourier_motion(
    waves: NDArray[np.complex128], frequency: float, phase: float = 0.0
) -> Callable[[Array], tuple[Array, Array]]:
    """Return a function of times (n,) that gives the axes Re sum_h waves_h exp(i h (phase + frequency t)) and their rates.
    `waves` (2, h, 3) are the harmonics of both axes. The results have shape (2, n, 3)."""
    count = waves.shape[1]
    slopes = 1j * frequency * np.arange(count)[:, None] * waves
    table = np.concatenate([waves, slopes]).transpose(1, 0, 2).reshape(count, 12)
    table = np.concatenate([table.real, -table.imag])  # in cos and sin: a real product costs half of a complex one

    def motion(t: Array) -> tuple[Array, Array]:
        turn = np.exp(1j * (phase + frequency * t))
        powers = np.ones((count, len(t)), dtype=complex)
        for n in range(count - 1):
            np.multiply(powers[n], turn, out=powers[n + 1])
        values = (np.concatenate([powers.real, powers.imag]).T @ table).reshape(-1, 2, 2, 3).transpose(1, 2, 0, 3)
        return values[0], values[1]

    return motion
