"""Closed forms of the paired precession from its periodic series: frequency, trajectories, inclinations, momentum."""

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

_ORBIT = "opposite spins, the symmetric periodic orbit"
_ORBIT_DOMAIN = (sp.Gt(r0, -1), sp.Lt(r0, 1))
_Values = dict[sp.Symbol, Array]


@cache
def paired_frequency(order: int = 3) -> ClosedForm:
    """Derive Omega / Omega_0 of the paired precession of opposite spins, through r_0**order.

    Parameters
    ----------
    order : int, default 3
        Highest power of the amplitude r_0, at least 1.

    Returns
    -------
    ClosedForm
        The ratio of frequencies as a function of r_0, sigma and k, all dimensionless.

    Raises
    ------
    InputError
        Unless order is an integer, at least 1.

    References
    ----------
    Equation (5.21) of the paper, corrected; derivations/t3_paired_orbit.py.

    Examples
    --------
    >>> paired_frequency(3).expressions
    (1 - r_0**2*sigma*(k**2*sigma - 3*k**2 + 3)/(4*k**2),)
    """
    series = paired_series(order)
    ratio, validity = series.expression(series.frequency), (_ORBIT, "5.21", order, r0)
    form = ClosedForm("paired_frequency", ("Omega/Omega_0",), (ratio,), (r0, sigma, k), _ORBIT_DOMAIN, *validity)
    return with_error(form, _frequency, lambda series, amplitude: series.remainder(amplitude).frequency)


def _frequency(series: PairedSeries, values: _Values) -> Array:
    return np.array([[series.relative_frequency(float(v)) for v in values[r0]]])


@cache
def corrected_trajectories(order: int = 3) -> ClosedForm:
    """Derive both axes of the paired precession at phase Phi = Omega t, through r_0**order.

    The amplitude r_0 is the sine of the inclination at the moments of parallel axes (Phi = 0). The tips are at ∓ell/2 e_x + R
    r_i.

    Parameters
    ----------
    order : int, default 3
        Highest power of the amplitude r_0, at least 1.

    Returns
    -------
    ClosedForm
        The unit vectors (x_1, y_1, z_1, x_2, y_2, z_2) as functions of r_0, Phi (rad), sigma and k. For a pair these are
        scene.sigma and scene.k; a massless bar with ell = R has 1 and 1.

    Raises
    ------
    InputError
        Unless order is an integer, at least 1.

    References
    ----------
    Equation (5.22) of the paper, corrected; derivations/t3_paired_orbit.py.

    Examples
    --------
    >>> axes = corrected_trajectories(3)(0.2, 0.0, 1.0, 1.0)
    >>> [round(float(component), 6) for component in axes[:3]]
    [0.2, 0.0, 0.98]
    """
    series = paired_series(order)
    x, y, z = (series.expression(component) for component in (series.x, series.Y, series.z))
    y *= sp.sqrt(sigma)
    later = {Phi: Phi + sp.pi}
    second = (-x.subs(later), y.subs(later), z.subs(later))
    outputs, validity = ("x_1", "y_1", "z_1", "x_2", "y_2", "z_2"), (f"{_ORBIT}, G_1 > 0", "5.22", order, r0)
    arguments = r0, Phi, sigma, k
    form = ClosedForm("corrected_trajectories", outputs, (x, y, z, *second), arguments, _ORBIT_DOMAIN, *validity)
    return with_error(form, _axes)


def _axes(series: PairedSeries, values: _Values) -> Array:
    axes = series.axes(float(values[r0][0]), values[Phi])
    return np.moveaxis(axes, -1, 1).reshape(6, -1)


@cache
def paired_momentum(order: int = 4) -> ClosedForm:
    """Derive P/G of the paired precession, sigma r_0²/k + …, through r_0**order.

    P = sum_i (y_i p_zi − z_i p_yi) + G (x_1 − x_2), p_i = a r_i' + b r_j', is the momentum about the joint line, constant on
    the orbit and even in r_0.

    Parameters
    ----------
    order : int, default 4
        Highest power of the amplitude r_0, at least 1.

    Returns
    -------
    ClosedForm
        The ratio P/G as a function of r_0, sigma and k, all dimensionless.

    Raises
    ------
    InputError
        Unless order is an integer, at least 1.
    SingularError
        If the derived P depends on the phase.

    References
    ----------
    Section 5.2.1 of the paper; derivations/t3_paired_orbit.py.

    Examples
    --------
    >>> paired_momentum(2).expressions
    (r_0**2*sigma/k,)
    """
    orbit = paired_series(order)
    s = orbit.field.from_sympy(sigma)
    unit = orbit.field.one
    heavy, light = (unit + unit / s) / 2, (unit - unit / s) / 2  # units a + b = 1
    x, Y, z = orbit.x, orbit.Y, orbit.z
    Y2, z2 = Y.half_period_later(), z.half_period_later()

    def weighted_slope(first: FourierSeries, second: FourierSeries) -> FourierSeries:
        return first.derivative().times(heavy) + second.derivative().times(light)

    first = Y * weighted_slope(z, z2) - z * weighted_slope(Y, Y2)
    turning = first + Y2 * weighted_slope(z2, z) - z2 * weighted_slope(Y2, Y)
    total = (orbit.frequency * turning).times(s) + x + x.half_period_later()  # x_2 = −x_1 half a period later
    if any(h for _, h in total.terms):
        raise SingularError("paired_momentum: the momentum varies along the orbit: the series is wrong")
    ratio, validity = orbit.expression(total), (_ORBIT, "5.2.1", order, r0)
    form = ClosedForm("paired_momentum", ("P/G",), (ratio,), (r0, sigma, k), _ORBIT_DOMAIN, *validity)
    return with_error(form, _momentum, _momentum_rest)


def _scaled_inertias(series: PairedSeries) -> tuple[float, float]:
    """Return (a, b) in units of G / Omega_0, from a² − b² = 1 and (a + b)/(a − b) = sigma."""
    root = float(series.shape) ** 0.5
    return (root + 1 / root) / 2, (root - 1 / root) / 2


def _momentum(series: PairedSeries, values: _Values) -> Array:
    inertias = _scaled_inertias(series)
    motions = [(series.harmonics(r), series.relative_frequency(r)) for r in values[r0].tolist()]
    return np.array([[harmonic_momentum(harmonics, rate, inertias, 1.0) for harmonics, rate in motions]])


def _momentum_rest(series: PairedSeries, amplitude: float) -> float:
    """Return a bound of the error of P/G, from the errors of the axes (of length 1) and of the frequency."""
    (a, b), remainder = _scaled_inertias(series), series.remainder(amplitude)
    return 2 * (1 + 3 * (a + abs(b))) * (remainder.axes + remainder.frequency)
