"""Stability of the paired precession at small amplitude, derived: its characteristic exponents as a power series.

Besides turning about the joint line and shifting the phase, the orbit has one pair of perturbations: a shift of both axes
along x, and a twist. The bar and the orbit let each drive the other, xi' = A eta, eta' = B xi per radian of phase, and the
exponents are ± lambda with lambda² = A B:

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
_X, _TWIST = 0, 1  # the unknowns whose displacement changes nothing at rest


def exponent_series(order: int, shape: sp.Expr = sigma, ratio: sp.Expr = k, exact: bool = True) -> ExponentSeries:
    """A and B through r_0**order.

    Parameters
    ----------
    order : int
        A whole number.
    shape : Expr, default sigma
        Sigma, a rational number or symbol.
    ratio : Expr, default k
        K, likewise.
    exact : bool, default True
        As in `paired_series`.
    """
    return _exponents(paired_series(order, shape, ratio, exact), exact)


@lru_cache(maxsize=16)
def _exponents(orbit: PairedSeries, exact: bool) -> ExponentSeries:
    """A and B as far as the orbit's own series goes."""
    residual = equations(orbit.shape, orbit.ratio, orbit.field)
    numeric = None if exact else equations(orbit.shape, orbit.ratio)
    # The exchange of the rotors, half a period later, gives a shift in x and a twist the opposite sign.
    return characteristic_exponents(
        residual, orbit.solution, _SINES, (_X, _TWIST), orbit.order, orbit.field, exchange=-1, numeric=numeric
    )


@cache
def growth_squared(order: int = 6, dumbbell: bool = False) -> ClosedForm:
    """lambda² of the paired precession per radian² of phase, through r_0**order: growth by 2 pi lambda a turn.

        lambda² = (3/16) sigma² (1 − sigma) r_0⁶ / k² + …      for a bar with b ≠ 0 (sigma ≠ 1),
        lambda² = (9/32) r_0⁸ / k⁴ + …                         `dumbbell`: sigma = 1, order 8 at least.

    Negative: the orbit is elliptic and its neighbours turn about it by 2 pi sqrt(−lambda²) a turn.
    Arguments r_0, sigma, k.

    Raises
    ------
    InputError
        For an order below the first term's.
    """
    first = 8 if dumbbell else 6
    if order < first:
        raise InputError(f"growth_squared: order = {order} must be at least {first}, the order of the first term")
    shape = sp.Integer(1) if dumbbell else sigma
    # A begins with r_0² (r_0⁴ for sigma = 1), B with r_0⁴.
    series = exponent_series(order - (4 if dumbbell else 2), shape)
    square = series.A.through(order) * series.B.through(order)
    form = ClosedForm(
        "growth_squared",
        ("lambda²",),
        (paired_series(1, shape).expression(square),),
        (r0, sigma, k),
        (sp.Gt(r0, -1), sp.Lt(r0, 1), *((sp.Eq(sigma, 1),) if dumbbell else ())),
        "opposite spins, small amplitude",
        "past the paper",
        order,
        r0,
    )
    return with_error(form, _square, _square_rest)


def _numbers(series: PairedSeries, order: int) -> Array:
    """A and B of a bar with numbers, in powers of r_0: (2, order + 1)."""
    exponents = exponent_series(order, series.shape, series.ratio, exact=False)
    values = np.zeros((2, order + 1))
    for row, part in zip(values, (exponents.A, exponents.B), strict=True):
        for (n, _), value in part.terms.items():
            row[n] = float(value)
    return values


def _square(series: PairedSeries, given: dict[sp.Symbol, Array]) -> Array:
    A, B = (np.polynomial.polynomial.polyval(given[r0], part) for part in _numbers(series, series.order))
    return np.asarray([A * B])


def _square_rest(series: PairedSeries, amplitude: float) -> float:
    parts = _numbers(series, series.order)
    A, B = np.abs(parts) @ abs(amplitude) ** np.arange(series.order + 1)
    rest_A, rest_B = (series.remainder_like(part, amplitude) for part in parts)
    return float(A * rest_B + B * rest_A + rest_A * rest_B)


@cache
def elliptic_edge() -> ClosedForm:
    """r_0 at which the elliptic orbit of a bar with b > 0 turns hyperbolic, to first order in sigma − 1.

    Where A = 0, by its first two terms: r_0² = 24 k² (sigma − 1) / (37 k² sigma³ − … + 6) → (2/3) k² (sigma − 1).
    Arguments sigma, k. `error` compares with the root of A through r_0^12, and is inf where that has no settled root.
    """
    terms = exponent_series(4).A.terms
    field = paired_series(1).field
    square = sp.factor(-field.to_sympy(terms[2, 0]) / field.to_sympy(terms[4, 0]))
    return ClosedForm(
        "elliptic_edge",
        ("r_0",),
        (sp.sqrt(square),),
        (sigma, k),
        (sp.Gt(sigma, 1),),
        "opposite spins, b > 0, sigma − 1 small",
        "past the paper",
        1,
        sigma,
        lambda shapes, ratios: np.array([[_edge_error(s, q) for s, q in zip(shapes, ratios, strict=True)]]),
    )


def _edge_error(shape: float, ratio: float) -> float:
    """Distance of the law from the root of A through r_0^12, and what that root moved by in its last two orders."""
    series = paired_series(1, *map(sp.Rational, (shape, ratio)))
    A = _numbers(series, 12)[0]
    roots = [_least_root(A[2 : order + 1 : 2]) for order in (8, 10, 12)]
    moved = max(abs(roots[2] - roots[1]), abs(roots[1] - roots[0]))
    law = (-A[2] / A[4]) ** 0.5
    return float(abs(law - roots[2]) + 2 * moved) if np.isfinite(moved) else np.inf


def _least_root(coefficients: Array) -> float:
    """The least positive r_0 with sum_n c_n r_0^(2 n) = 0; inf where there is none."""
    squares = np.polynomial.polynomial.polyroots(coefficients)
    real = squares.real[(abs(squares.imag) < 1e-9) & (squares.real > 0)]
    return float(np.sqrt(real.min())) if real.size else np.inf


def most_growth(r0: float, sigma: float, k: float) -> float:
    """An empirical bound on lambda per radian of phase: both leading laws together, where positive.

    lambda² ≤ (3/16) sigma² (1 − sigma) r_0⁶ / k² + (9/32) r_0⁸ / k⁴. The terms are derived (`growth_squared`); that their
    sum is a bound is not: the tests hold it to the exact multipliers of random bars, 0.4 < sigma < 1.8, 0.5 < k < 2.

    Parameters
    ----------
    r0 : float
        Amplitude, at most 0.5.
    sigma : float
        Shape.
    k : float
        Ell / R.
    """
    return sqrt(max(3 * sigma**2 * (1 - sigma) * r0**6 / (16 * k**2), 0.0) + 9 * r0**8 / (32 * k**4))
