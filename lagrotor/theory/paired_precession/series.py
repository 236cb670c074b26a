"""The paired precession of opposite spins as a periodic orbit, by Lindstedt–Poincaré, for any bar.

Symmetry: exchanging the rotors, mirrored in the plane between them, is the orbit half a period later,

    x_2(Phi) = −x_1(Phi + pi),   y_2(Phi) = y_1(Phi + pi),   z_2(Phi) = z_1(Phi + pi),

and reversing time with y → −y makes x, z even and y odd in Phi. Unknown are x_1, y_1, z_1 and two multipliers.

Scaled by Omega_0 = |G| / sqrt(a² − b²) and y = sqrt(sigma) Y, sigma = (a + b)/(a − b), every coefficient is rational in
sigma and k = ell / R. The amplitude r_0 is x_1(0) = x_2(0): the sine of the inclination when both axes are parallel.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray
from sympy.polys.domains.domain import Domain

from lagrotor.errors import InputError
from lagrotor.mechanics.fourier import FourierSeries, constant
from lagrotor.mechanics.perturbation import lindstedt_poincare
from lagrotor.pair.lagrangians import INERTIAS, J_OF
from lagrotor.pair.scene import Scene
from lagrotor.pair.symbols import I1, J, K, M, Phi, R, a, b, ell, k, m, r0, sigma


@dataclass(frozen=True)
class PairedSeries:
    """The orbit through r0**order: axes of rotor 1 (x, Y, z), tension and frequency / Omega_0; Y = y / sqrt(sigma)."""

    x: FourierSeries
    Y: FourierSeries
    z: FourierSeries
    frequency: FourierSeries
    order: int
    field: Domain

    def expression(self, series: FourierSeries) -> sp.Expr:
        """A series as an expression in r_0 and Phi (and sigma, k where they were left free)."""
        total = sp.Integer(0)
        for (n, h), value in sorted(series.terms.items()):
            wave = sp.cos(h * Phi) if h >= 0 else sp.sin(-h * Phi)
            total += sp.factor(self.field.to_sympy(value)) * r0**n * wave
        return total


def shape_of(scene: Scene) -> tuple[sp.Rational, sp.Rational]:
    """(sigma, k) of a scene as exact rationals, its parameters read as the decimals they are written as.

    Raises InputError unless the spins are opposite and there is a bar: the paired precession needs both.
    """
    if scene.link is None or scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0:
        raise InputError(f"the paired precession needs a bar and opposite spins, not spins = {scene.spins}")
    exact = {M: scene.rotor.mass, R: scene.rotor.length, I1: scene.rotor.I1}
    exact |= {ell: scene.link.length, m: scene.link.mass, K: scene.link.inertia}
    values = {symbol: sp.Rational(repr(value)) for symbol, value in exact.items()}
    both = {symbol: INERTIAS[symbol].subs(J, J_OF).subs(values) for symbol in (a, b)}
    return (both[a] + both[b]) / (both[a] - both[b]), values[ell] / values[R]


def evaluate(series: FourierSeries, amplitude: float, phases: ArrayLike) -> NDArray[np.float64]:
    """A series with numbers for coefficients at an amplitude and phases (n,): the sum of its harmonics."""
    phases = np.asarray(phases, dtype=float)
    waves: dict[int, float] = {}
    for (n, h), value in series.terms.items():
        waves[h] = waves.get(h, 0.0) + float(value) * amplitude**n
    total = np.zeros_like(phases)
    for h, size in waves.items():
        total += size * (np.cos(h * phases) if h >= 0 else np.sin(-h * phases))
    return total


def last_terms(series: PairedSeries, r0: float) -> float:
    """Size of the last two orders of the orbit at amplitude r0: what a truncated series leaves undecided."""
    kept = [(value, n) for part in (series.x, series.Y) for (n, _), value in part.terms.items() if n > series.order - 2]
    return max(abs(float(value)) * abs(r0) ** n for value, n in kept)


def field_of(shape: sp.Expr, ratio: sp.Expr) -> Domain:
    """The field of the coefficients: rational functions of whichever of sigma and k is left a symbol."""
    free = sorted((sp.sympify(shape).free_symbols | sp.sympify(ratio).free_symbols), key=str)
    return sp.QQ.frac_field(*free) if free else sp.QQ


@lru_cache(maxsize=32)
def paired_series(order: int, shape: sp.Expr = sigma, ratio: sp.Expr = k) -> PairedSeries:
    """The orbit for sigma = `shape` and k = `ratio`, rational numbers or symbols, through r0**order."""
    shape, ratio = sp.sympify(shape), sp.sympify(ratio)
    field = field_of(shape, ratio)
    s, length = field.from_sympy(shape), field.from_sympy(ratio)
    one = field.one
    # Units a + b = 1, so a − b = 1/sigma; own = a, shared = b.
    own, shared = (one + one / s) / 2, (one - one / s) / 2

    def residual(unknowns: Sequence[FourierSeries], frequency: FourierSeries) -> list[FourierSeries]:
        x, Y, z, unit, pull = unknowns
        order = x.order
        tension = (pull + pull.half_period_later()).scaled(one / 2)  # the same bar for both rotors
        x2, Y2, z2 = -x.half_period_later(), Y.half_period_later(), z.half_period_later()
        unit_length = constant(one, order)
        xd, Yd, zd = x.derivative(), Y.derivative(), z.derivative()
        squared = frequency * frequency

        def inertia(first: FourierSeries, second: FourierSeries) -> FourierSeries:
            return squared * (
                first.derivative().derivative().scaled(own) + second.derivative().derivative().scaled(shared)
            )

        return [
            inertia(x, x2) - frequency * (Y * zd - z * Yd) - unit * x + tension * (constant(length, order) + x2),
            inertia(Y, Y2) - frequency * (z * xd - x * zd).scaled(one / s) - unit * Y + tension * Y2,
            inertia(z, z2) - frequency * (x * Yd - Y * xd) - unit * z + tension * z2,
            x * x + (Y * Y).scaled(s) + z * z - unit_length,
            (x2 - x).scaled(length) + unit_length - x * x2 - (Y * Y2).scaled(s) - z * z2,
        ]

    rest: list[Any] = [field.zero, field.zero, one, field.zero, field.zero]
    mode: list[dict[int, Any]] = [{1: one}, {-1: one}, {}, {}, {}]
    found = lindstedt_poincare(residual, rest, mode, order, field)
    x, Y, z, *_ = found.unknowns
    return PairedSeries(x, Y, z, found.frequency, order, field)
