"""The paired precession of opposite spins as a periodic orbit, by Lindstedt–Poincaré, for any bar.

Exchanging the rotors, with a reflection in the plane between them, shifts the orbit by half a period,

    x_2(Phi) = −x_1(Phi + pi),   y_2(Phi) = y_1(Phi + pi),   z_2(Phi) = z_1(Phi + pi),

and time reversal with y → −y makes x, z even and y odd in Phi. The unknowns are x_1, y_1, z_1 and two multipliers.

In units of Omega_0 = |G| / sqrt(a² − b²) and with y = sqrt(sigma) Y, sigma = (a + b)/(a − b), every coefficient is rational in
sigma and k = ell / R. The amplitude r_0 is x_1(0) = x_2(0): the sine of the inclination when both axes are parallel.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike
from sympy.polys.domains.domain import Domain

from lagrotor.errors import InputError
from lagrotor.mechanics.fourier import FourierSeries, Series
from lagrotor.mechanics.weakly_nonlinear import PeriodicSeries, Residual, periodic_series
from lagrotor.pair.lagrangians import INERTIAS, J_OF
from lagrotor.pair.notation import I1, J, K, M, Phi, R, a, b, ell, k, m, r0, sigma
from lagrotor.pair.scene import Scene
from lagrotor.theory.paired_precession.orbit_harmonics import Array, axes_of

# The remainder is estimated as a geometric series, calibrated by tests/models/test_orbit_errors.py on random bars and amplitudes.
# LARGEST_RATIO: of consecutive pairs of orders, for an estimate. OF_AXES: least size of the terms of a frequency or an exponent
# over the terms of the axes, since single terms may vanish.
GROWTH_OF_RATIO, SERIES_SAFETY, LARGEST_RATIO, OF_AXES = 1.3, 2.5, 0.9, 0.25
_HIGHEST_WITH_SYMBOLS, _HIGHEST_OF_NUMBERS = 16, 32  # orders that take seconds, not minutes


class Remainder(NamedTuple):
    """Estimated bounds of the truncation error; inf if the series does not converge.

    `axes` bounds the error of the axes and of dr/dPhi at equal phase, and `frequency` the error of Omega/Omega_0.
    """

    axes: float
    frequency: float


@dataclass(frozen=True, eq=False)
class PairedSeries:
    """The paired precession as a series through r0**order, for sigma = `shape` and k = `ratio`.

    The axis of rotor 1 is (x, sqrt(sigma) Y, z), and `frequency` is Omega/Omega_0. `solution` also holds the multipliers of the
    constraints.
    """

    solution: PeriodicSeries
    order: int
    shape: sp.Expr
    ratio: sp.Expr
    field: Domain

    @property
    def x(self) -> FourierSeries:
        """The series of x_1."""
        return self.solution.unknowns[0]

    @property
    def Y(self) -> FourierSeries:
        """The series of y_1 / sqrt(sigma)."""
        return self.solution.unknowns[1]

    @property
    def z(self) -> FourierSeries:
        """The series of z_1."""
        return self.solution.unknowns[2]

    @property
    def frequency(self) -> FourierSeries:
        """The series of Omega / Omega_0."""
        return self.solution.frequency

    def expression(self, series: FourierSeries) -> sp.Expr:
        """Return a series as an expression in r_0 and Phi, and in sigma and k unless they are numbers."""
        total = sp.Integer(0)
        for (n, h), value in sorted(series.terms.items()):
            wave = sp.cos(h * Phi) if h >= 0 else sp.sin(-h * Phi)
            total += sp.factor(self.field.to_sympy(value)) * r0**n * wave
        return total

    @property
    def coefficients(self) -> Array:
        """The coefficients of r_1 for a numeric bar, shape (order + 1, order + 1, 3); entry [n, h] is of r0**n and harmonic h."""
        table = np.zeros((self.order + 1, self.order + 1, 3))
        for i, (component, width) in enumerate(((self.x, 1.0), (self.Y, sqrt(self.shape)), (self.z, 1.0))):
            for (n, h), value in component.terms.items():
                table[n, abs(h), i] = width * float(value)
        return table

    @property
    def frequency_coefficients(self) -> Array:
        """The coefficients of Omega/Omega_0 in powers of r0 for a numeric bar, shape (order + 1,)."""
        row = np.zeros(self.order + 1)
        for (n, _), value in self.frequency.terms.items():
            row[n] = float(value)
        return row

    def harmonics(self, r0: float) -> Array:
        """Return the harmonics of r_1 at amplitude r0, shape (order + 1, 3)."""
        return np.tensordot(r0 ** np.arange(self.order + 1), self.coefficients, 1)

    def axes(self, r0: float, phase: ArrayLike) -> Array:
        """Return both axes (2, …, 3) at amplitude r0 and phases (…) in rad."""
        return axes_of(self.harmonics(r0), phase)

    def relative_frequency(self, r0: float) -> float:
        """Return Omega / Omega_0 at amplitude r0."""
        return float(np.polynomial.polynomial.polyval(r0, self.frequency_coefficients))

    def remainder(self, r0: float) -> Remainder:
        """Estimate the truncation error at amplitude r0 from the decay of the series.

        If two consecutive orders decrease at least by a factor q, the remainder is at most q/(1 − q) times the last two; q has
        a margin, and the bound a safety factor, both tested on random bars.
        """
        of_axes = tail_bound(self._sizes * abs(r0) ** np.arange(self.order + 1))
        return Remainder(of_axes, self.remainder_like(self.frequency_coefficients, r0))

    def remainder_like(self, coefficients: Array, r0: float) -> float:
        """Estimate the truncation error of another series of the orbit; its terms are a fraction of the terms of the axes."""
        sizes = self._sizes[: len(coefficients)]
        ratio = max(OF_AXES, float((np.abs(coefficients)[2:] / sizes[2:]).max(initial=0.0)))
        return ratio * tail_bound(sizes * abs(r0) ** np.arange(len(sizes)))

    @property
    def _sizes(self) -> Array:
        """The size of the coefficient of each power of r0 in the axes and their phase derivatives, shape (order + 1,)."""
        harmonic = np.maximum(np.arange(self.order + 1), 1)[:, None]
        return np.linalg.norm((np.abs(self.coefficients) * harmonic).sum(1), axis=-1)


def tail_bound(terms: Array) -> float:
    """Estimate a bound of the terms beyond the last of `terms`; inf if they do not decrease."""
    pairs = terms[1:] + terms[:-1]  # pairs[n]: orders n and n + 1
    if not pairs[-1]:
        return 0.0
    if len(pairs) < 5:
        return inf
    # From order 3 on: lower orders do not predict the decay.
    ratios = pairs[3:] / np.maximum(pairs[1:-2], np.finfo(float).tiny)
    fall = GROWTH_OF_RATIO * float(ratios[-4:].max())
    return SERIES_SAFETY * float(pairs[-1]) * fall / (1 - fall) if fall < LARGEST_RATIO else inf


def shape_of(scene: Scene) -> tuple[sp.Rational, sp.Rational]:
    """Return (sigma, k) of a scene as exact rational numbers; a parameter has the value of the decimal that it prints.

    Raises InputError unless the spins are opposite and there is a bar.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"the paired precession needs a Scene, not {scene!r}")
    if scene.link is None or scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0:
        raise InputError(f"the paired precession needs a bar and opposite spins, not spins = {scene.spins}")
    exact = {M: scene.rotor.mass, R: scene.rotor.length, I1: scene.rotor.I1}
    exact |= {ell: scene.link.length, m: scene.link.mass, K: scene.link.inertia}
    values = {symbol: sp.Rational(repr(value)) for symbol, value in exact.items()}
    both = {symbol: INERTIAS[symbol].xreplace({J: J_OF}).xreplace(values) for symbol in (a, b)}
    return (both[a] + both[b]) / (both[a] - both[b]), values[ell] / values[R]


def coefficient_field(shape: sp.Expr, ratio: sp.Expr) -> Domain:
    """Return the field of the coefficients: the rational functions of those of sigma and k that are symbols."""
    free = sorted((sp.sympify(shape, strict=True).free_symbols | sp.sympify(ratio, strict=True).free_symbols), key=str)
    return sp.ZZ.frac_field(*free) if free else sp.QQ  # integer coefficients reduce faster than fractions


def equations(shape: sp.Expr, ratio: sp.Expr, field: Domain | None = None) -> Residual:
    """Return a function that evaluates the equations of motion of r_1 and the two constraints, |r_1| = 1 and the bar.

    The unknowns are x, Y, z and the multipliers of both constraints. Units are a + b = 1 and Omega_0 = 1, and y is divided by
    sqrt(sigma). r_2 is r_1 half a period later, with the rotors exchanged. Without `field` the coefficients are floating-point
    numbers. Derived from the Lagrangian in derivations/t3_paired_orbit.py.
    """
    s, length, unit_value = (float(v) if field is None else field.from_sympy(v) for v in (shape, ratio, sp.S.One))
    a_scaled, b_scaled = (unit_value + unit_value / s) / 2, (unit_value - unit_value / s) / 2  # a, b

    def residual(unknowns: Sequence[Series], frequency: Series) -> list[Series]:
        x, Y, z, unit, pull = unknowns
        tension = (pull + pull.half_period_later()).times(unit_value / 2)  # the same bar for both rotors
        x2, Y2, z2 = -x.half_period_later(), Y.half_period_later(), z.half_period_later()
        xd, Yd, zd = x.derivative(), Y.derivative(), z.derivative()
        squared = frequency * frequency

        def inertia(first: Series, second: Series) -> Series:
            accelerations = first.derivative().derivative(), second.derivative().derivative()
            return squared * (accelerations[0].times(a_scaled) + accelerations[1].times(b_scaled))

        return [
            inertia(x, x2) - frequency * (Y * zd - z * Yd) - unit * x + tension * (x.constant(length) + x2),
            inertia(Y, Y2) - frequency * (z * xd - x * zd).times(unit_value / s) - unit * Y + tension * Y2,
            inertia(z, z2) - frequency * (x * Yd - Y * xd) - unit * z + tension * z2,
            x * x + (Y * Y).times(s) + z * z - x.constant(unit_value),
            (x2 - x).times(length) + x.constant(unit_value) - x * x2 - (Y * Y2).times(s) - z * z2,
        ]

    return residual


def check_order(order: int) -> int:
    """Return the order of a series. Raises InputError unless it is an integer, at least 1."""
    if isinstance(order, bool) or not isinstance(order, int) or order < 1:
        raise InputError(f"the series of the paired precession: order = {order!r} must be a whole number, 1 or more")
    return order


def paired_series(order: int, shape: sp.Expr = sigma, ratio: sp.Expr = k, exact: bool = True) -> PairedSeries:
    """Compute the paired precession as a series through r0**order.

    Parameters
    ----------
    order : int
        Highest power of the amplitude r0, at least 1; at most 16 with a symbol and 32 without.
    shape : Expr, default sigma
        Shape (a + b)/(a − b) of the bar, a rational number or symbol.
    ratio : Expr, default k
        Length ratio ell/R, a rational number or symbol.
    exact : bool, default True
        If True, exact coefficients; if False, floating point, for numbers only, ten times as fast.

    Returns
    -------
    PairedSeries
        The orbit and its frequency.

    Raises
    ------
    InputError
        If the order is outside this range.

    References
    ----------
    Equations (5.21) and (5.22) of the paper, corrected; derivations/t3_paired_orbit.py.
    """
    check_order(order)
    shape, ratio = sp.sympify(shape, strict=True), sp.sympify(ratio, strict=True)
    highest = _HIGHEST_WITH_SYMBOLS if shape.free_symbols | ratio.free_symbols else _HIGHEST_OF_NUMBERS
    if order > highest:
        raise InputError(
            f"the series of the paired precession: order = {order} is above {highest}, from where it takes minutes and more; "
            "for one pair lagrotor.precession_orbit gives the exact orbit at any amplitude"
        )
    return _solve_series(order, shape, ratio, exact)


@lru_cache(maxsize=32)
def _solve_series(order: int, shape: sp.Expr, ratio: sp.Expr, exact: bool) -> PairedSeries:
    field = coefficient_field(shape, ratio)
    mode: list[dict[int, Any]] = [{1: field.one}, {-1: field.one}, {}, {}, {}]
    exactly, numeric = equations(shape, ratio, field), None if exact else equations(shape, ratio)
    equilibrium = [field.zero, field.zero, field.one, field.zero, field.zero]  # x, Y, z and the two multipliers
    solution = periodic_series(exactly, equilibrium, mode, order, field, numeric=numeric)
    return PairedSeries(solution, order, shape, ratio, field)
