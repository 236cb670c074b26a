"""Closed forms of the paired precession, read off its periodic series: frequency, trajectories, inclinations, momentum."""

from functools import cache

import numpy as np
import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.pair.notation import Phi, k, r0, sigma
from lagrotor.theory.closed_form import Array, ClosedForm
from lagrotor.theory.paired_precession.orbit_harmonics import harmonic_momentum
from lagrotor.theory.paired_precession.remainder import with_error
from lagrotor.theory.paired_precession.series import PairedSeries, paired_series

_ORBIT_DOMAIN = (sp.Gt(r0, -1), sp.Lt(r0, 1))
_Values = dict[sp.Symbol, Array]


@cache
def paired_frequency(order: int = 3) -> ClosedForm:
    """Omega / Omega_0 of the paired precession at amplitude r_0 (opposite spins), through r_0**order (5.21).

    Arguments r_0, sigma, k.

    Raises
    ------
    InputError
        Unless order is a whole number, 1 or more.
    """
    series = paired_series(order)
    form = ClosedForm(
        "paired_frequency",
        ("Omega/Omega_0",),
        (series.expression(series.frequency),),
        (r0, sigma, k),
        _ORBIT_DOMAIN,
        "opposite spins, the symmetric periodic orbit",
        "5.21",
        order,
        r0,
    )
    return with_error(form, _frequency, lambda series, amplitude: series.remainder(amplitude).frequency)


def _frequency(series: PairedSeries, given: _Values) -> Array:
    return np.array([[series.relative_frequency(float(v)) for v in given[r0]]])


@cache
def corrected_trajectories(order: int = 3) -> ClosedForm:
    """Axes (x_1, y_1, z_1, x_2, y_2, z_2) of the paired precession at phase Phi = Omega t, through r_0**order (5.22).

    r_0 is the sine of the inclination when the axes are parallel (Phi = 0). Tips: ∓ell/2 e_x + R r_i.
    Arguments r_0, Phi, sigma, k.

    Raises
    ------
    InputError
        Unless order is a whole number, 1 or more.
    """
    series = paired_series(order)
    x, y, z = (series.expression(part) for part in (series.x, series.Y, series.z))
    y *= sp.sqrt(sigma)
    later = {Phi: Phi + sp.pi}
    second = (-x.subs(later), y.subs(later), z.subs(later))
    form = ClosedForm(
        "corrected_trajectories",
        ("x_1", "y_1", "z_1", "x_2", "y_2", "z_2"),
        (x, y, z, *second),
        (r0, Phi, sigma, k),
        _ORBIT_DOMAIN,
        "opposite spins with G_1 > 0, the symmetric periodic orbit",
        "5.22",
        order,
        r0,
    )
    return with_error(form, _axes)


def _axes(series: PairedSeries, given: _Values) -> Array:
    axes = series.axes(float(given[r0][0]), given[Phi])
    return np.moveaxis(axes, -1, 1).reshape(6, -1)


@cache
def paired_momentum(order: int = 4) -> ClosedForm:
    """P/G of the paired precession of amplitude r_0 through r_0**order: sigma r_0²/k + …

    P = sum_i (y_i p_zi − z_i p_yi) + G (x_1 − x_2), p_i = a r_i' + b r_j': constant on the orbit, even in r_0.
    Times G (kg m²/s) it is the momentum. Arguments r_0, sigma, k.

    Raises
    ------
    InputError
        Unless order is a whole number, 1 or more.
    SingularError
        Should it not be constant in the phase.
    """
    orbit = paired_series(order)
    s = orbit.field.from_sympy(sigma)
    one = orbit.field.one
    heavy, light = (one + one / s) / 2, (one - one / s) / 2  # units a + b = 1
    x, Y, z = orbit.x, orbit.Y, orbit.z
    Y2, z2 = Y.half_period_later(), z.half_period_later()

    def weighted_slope(first: FourierSeries, second: FourierSeries) -> FourierSeries:
        return first.derivative().times(heavy) + second.derivative().times(light)

    turning = (
        Y * weighted_slope(z, z2) - z * weighted_slope(Y, Y2) + Y2 * weighted_slope(z2, z) - z2 * weighted_slope(Y2, Y)
    )
    total = (orbit.frequency * turning).times(s) + x + x.half_period_later()  # x_2 = −x_1 half a period later
    if any(h for _, h in total.terms):
        raise SingularError("paired_momentum: the momentum varies along the orbit: the series is wrong")
    form = ClosedForm(
        "paired_momentum",
        ("P/G",),
        (orbit.expression(total),),
        (r0, sigma, k),
        _ORBIT_DOMAIN,
        "opposite spins, the symmetric periodic orbit",
        "5.2.1",
        order,
        r0,
    )
    return with_error(form, _momentum, _momentum_rest)


def _scaled_inertias(series: PairedSeries) -> tuple[float, float]:
    """(a, b) in units of G / Omega_0: a² − b² = 1, (a + b)/(a − b) = sigma."""
    root = float(series.shape) ** 0.5
    return (root + 1 / root) / 2, (root - 1 / root) / 2


def _momentum(series: PairedSeries, given: _Values) -> Array:
    inertias = _scaled_inertias(series)
    motions = [(series.harmonics(r), series.relative_frequency(r)) for r in given[r0].tolist()]
    return np.array([[harmonic_momentum(harmonics, rate, inertias, 1.0) for harmonics, rate in motions]])


def _momentum_rest(series: PairedSeries, amplitude: float) -> float:
    """As the momentum depends on axes of length 1 and on velocities of at most some Omega_0 R."""
    (own, shared), left = _scaled_inertias(series), series.remainder(amplitude)
    return 2 * (1 + 3 * (own + abs(shared))) * (left.axes + left.frequency)
