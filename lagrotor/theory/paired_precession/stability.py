"""Stability of the paired precession at small amplitude: its characteristic exponents as a power series.

Besides rotation about the joint line and a shift of the phase, the orbit has one pair of perturbations: a shift of both axes
along x, and a twist. The bar and the orbit couple them, xi' = A eta, eta' = B xi per radian of phase, with exponents ± lambda,
lambda² = A B:

    A = −sigma (sigma − 1)/2 r_0² + …,    B = 3 sigma/(8 k²) r_0⁴ + …

The variational equations along the Lindstedt–Poincaré series give A and B exactly (derivations/t5_floquet.py).
"""

from functools import cache, lru_cache
from math import sqrt

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.weakly_nonlinear import ExponentSeries, characteristic_exponents
from lagrotor.pair.notation import k, r0, sigma
from lagrotor.theory.closed_form import Array, ClosedForm
from lagrotor.theory.paired_precession.remainder import with_error
from lagrotor.theory.paired_precession.series import PairedSeries, equations, paired_series

_SINES = (False, True, False, False, False)  # x, Y, z and the two multipliers along the orbit
_NEW = "past the paper"
_X, _TWIST = 0, 1  # the unknowns with a neutral displacement at rest


def exponent_series(order: int, shape: sp.Expr = sigma, ratio: sp.Expr = k, exact: bool = True) -> ExponentSeries:
    """Compute the coefficients A and B of the coupled perturbations, xi' = A eta, eta' = B xi, through r_0**order.

    Parameters
    ----------
    order : int
        Highest power of the amplitude r_0, at least 1.
    shape : Expr, default sigma
        Shape (a + b)/(a − b) of the bar, a rational number or symbol.
    ratio : Expr, default k
        Length ratio ell/R, a rational number or symbol.
    exact : bool, default True
        If True, exact coefficients; if False, floating point, for numbers only.

    Returns
    -------
    ExponentSeries
        A and B per radian of phase, and the periodic perturbations.

    References
    ----------
    derivations/t5_floquet.py.
    """
    return _exponents(paired_series(order, shape, ratio, exact), exact)


@lru_cache(maxsize=16)
def _exponents(orbit: PairedSeries, exact: bool) -> ExponentSeries:
    """Return A and B through the order to which the series of the orbit is given."""
    residual = equations(orbit.shape, orbit.ratio, orbit.field)
    numeric = None if exact else equations(orbit.shape, orbit.ratio)
    # The exchange of the rotors, half a period later, gives a shift in x and a twist the opposite sign.
    return characteristic_exponents(
        residual, orbit.solution, _SINES, (_X, _TWIST), orbit.order, orbit.field, exchange=-1, numeric=numeric
    )


@cache
def growth_squared(order: int = 6, dumbbell: bool = False) -> ClosedForm:
    """Derive lambda² of the paired precession per radian² of phase, through r_0**order; the growth per period is 2 pi lambda.

        lambda² = (3/16) sigma² (1 − sigma) r_0⁶ / k² + …      for a bar with b ≠ 0 (sigma ≠ 1),
        lambda² = (9/32) r_0⁸ / k⁴ + …                         `dumbbell`: sigma = 1, order at least 8.

    If lambda² is negative, the orbit is elliptic, and nearby orbits rotate about it by 2 pi sqrt(−lambda²) per period.

    Parameters
    ----------
    order : int, default 6
        Highest power of the amplitude r_0, at least the power of the first term.
    dumbbell : bool, default False
        If True, the bar is two point masses at its ends, sigma = 1.

    Returns
    -------
    ClosedForm
        The square as a function of r_0, sigma and k, all dimensionless.

    Raises
    ------
    InputError
        If the order is lower than the order of the first term.

    References
    ----------
    derivations/t5_floquet.py.

    Examples
    --------
    >>> growth_squared().expressions
    (-3*r_0**6*sigma**2*(sigma - 1)/(16*k**2),)
    """
    first = 8 if dumbbell else 6
    if order < first:
        raise InputError(f"growth_squared: order = {order} must be at least {first}, the order of the first term")
    shape = sp.Integer(1) if dumbbell else sigma
    # A begins with r_0² (r_0⁴ for sigma = 1), B with r_0⁴.
    series = exponent_series(order - (4 if dumbbell else 2), shape)
    square = series.A.through(order) * series.B.through(order)
    domain = sp.Gt(r0, -1), sp.Lt(r0, 1), *((sp.Eq(sigma, 1),) if dumbbell else ())
    growth, validity = paired_series(1, shape).expression(square), ("opposite spins, small amplitude", _NEW, order, r0)
    form = ClosedForm("growth_squared", ("lambda²",), (growth,), (r0, sigma, k), domain, *validity)
    return with_error(form, _square, _square_rest)


def _numbers(series: PairedSeries, order: int) -> Array:
    """Return the coefficients of A and B in powers of r_0 for a numeric bar, shape (2, order + 1)."""
    exponents = exponent_series(order, series.shape, series.ratio, exact=False)
    values = np.zeros((2, order + 1))
    for row, series_part in zip(values, (exponents.A, exponents.B), strict=True):
        for (n, _), value in series_part.terms.items():
            row[n] = float(value)
    return values


def _square(series: PairedSeries, values: dict[sp.Symbol, Array]) -> Array:
    A, B = (np.polynomial.polynomial.polyval(values[r0], row) for row in _numbers(series, series.order))
    return np.asarray([A * B])


def _square_rest(series: PairedSeries, amplitude: float) -> float:
    coefficients = _numbers(series, series.order)
    A, B = np.abs(coefficients) @ abs(amplitude) ** np.arange(series.order + 1)
    rest_A, rest_B = (series.remainder_like(row, amplitude) for row in coefficients)
    return float(A * rest_B + B * rest_A + rest_A * rest_B)


@cache
def elliptic_edge() -> ClosedForm:
    """Derive the amplitude r_0 at which the orbit of a bar with b > 0 turns from elliptic to hyperbolic, for small sigma − 1.

    There A = 0; its first two terms give r_0² = 24 k² (sigma − 1) / (37 k² sigma³ − … + 6) → (2/3) k² (sigma − 1).

    Returns
    -------
    ClosedForm
        The dimensionless amplitude as a function of sigma and k. `error` compares it with the root of A through r_0^12; it is inf
        if that root has not converged.

    References
    ----------
    derivations/t5_floquet.py.
    """
    terms = exponent_series(4).A.terms
    field = paired_series(1).field
    square = sp.factor(-field.to_sympy(terms[2, 0]) / field.to_sympy(terms[4, 0]))
    edge, validity = sp.sqrt(square), ("opposite spins, b > 0, sigma − 1 small", _NEW, 1, sigma)

    def error(shapes: Array, ratios: Array) -> Array:
        return np.array([[_edge_error(s, q) for s, q in zip(shapes, ratios, strict=True)]])

    return ClosedForm("elliptic_edge", ("r_0",), (edge,), (sigma, k), (sp.Gt(sigma, 1),), *validity, error)


def _edge_error(shape: float, ratio: float) -> float:
    """Return the error of the law for the edge; inf if the root of A has not converged.

    It is the distance of the law from the root of A through r_0^12, plus twice the larger of the last two changes of this root.
    """
    series = paired_series(1, *map(sp.Rational, (shape, ratio)))
    A = _numbers(series, 12)[0]
    roots = [_least_root(A[2 : order + 1 : 2]) for order in (8, 10, 12)]
    change = max(abs(roots[2] - roots[1]), abs(roots[1] - roots[0]))
    law = (-A[2] / A[4]) ** 0.5
    return float(abs(law - roots[2]) + 2 * change) if np.isfinite(change) else np.inf


def _least_root(coefficients: Array) -> float:
    """Return the least positive r_0 with sum_n c_n r_0^(2 n) = 0; inf if there is none."""
    squares = np.polynomial.polynomial.polyroots(coefficients)
    real = squares.real[(abs(squares.imag) < 1e-9) & (squares.real > 0)]
    return float(np.sqrt(real.min())) if real.size else np.inf


def growth_bound(r0: float, sigma: float, k: float) -> float:
    """Return an empirical bound of the growth exponent lambda per radian of phase, from both leading laws of `growth_squared`.

    lambda² ≤ (3/16) sigma² (1 − sigma) r_0⁶ / k² + (9/32) r_0⁸ / k⁴ holds for the exact multipliers of random bars in the
    tests, r_0 ≤ 0.5, 0.4 < sigma < 1.8, 0.5 < k < 2.
    """
    return sqrt(max(3 * sigma**2 * (1 - sigma) * r0**6 / (16 * k**2), 0.0) + 9 * r0**8 / (32 * k**4))
