"""Closed forms of the paired precession, read off its periodic series: frequency, trajectories, start, momentum, growth."""

from functools import cache
from math import sqrt

import numpy as np
import sympy as sp

from lagrotor.algebra import normal_form, truncated_series
from lagrotor.errors import DomainError, SingularError
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.pair.initial_conditions import consistent_scene
from lagrotor.pair.scene import Scene
from lagrotor.pair.symbols import Phi, k, r0, sigma
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.natural_frequency import natural_rate
from lagrotor.theory.paired_precession.series import evaluate, last_terms, paired_series, shape_of


@cache
def paired_frequency(order: int = 3) -> ClosedForm:
    """Omega / Omega_0 of the paired precession at amplitude r_0 (opposite spins), through r_0**order (5.21)."""
    series = paired_series(order + 1)  # order n of the orbit fixes the frequency's order n − 1
    return ClosedForm(
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


_ORBIT_DOMAIN = (sp.Gt(r0, -1), sp.Lt(r0, 1))


@cache
def corrected_trajectories(order: int = 3) -> ClosedForm:
    """Axes (x_1, y_1, z_1, x_2, y_2, z_2) of the paired precession at phase Phi = Omega t, through r_0**order (5.22).

    r_0 is the sine of the inclination when the axes are parallel (Phi = 0). Tips: ∓ell/2 e_x + R r_i.
    """
    series = paired_series(order)
    x, y, z = (series.expression(part) for part in (series.x, series.Y, series.z))
    y *= sp.sqrt(sigma)
    later = {Phi: Phi + sp.pi}
    second = (-x.subs(later), y.subs(later), z.subs(later))
    return ClosedForm(
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


@cache
def corrected_inclinations(order: int = 2) -> ClosedForm:
    """(sin theta_1, sin theta_2) of the paired precession with a massless bar or a dumbbell (sigma = 1), in r_0 (5.20)."""
    series = paired_series(order + 1, sp.Integer(1))
    x, y = series.expression(series.x), series.expression(series.Y)
    first = truncated_series(r0 * sp.sqrt(normal_form((x**2 + y**2) / r0**2)), r0, order)
    return ClosedForm(
        "corrected_inclinations",
        ("sin theta_1", "sin theta_2"),
        (first, first.subs(Phi, Phi + sp.pi)),
        (r0, Phi, k),
        (sp.Ge(r0, 0), sp.Lt(r0, 1)),
        "opposite spins, sigma = 1",
        "5.20",
        order,
        r0,
    )


def paired_scene(scene: Scene, r0: float, order: int = 9) -> Scene:
    """`scene` started on its paired precession of amplitude r0 at Phi = 0, by the series through r0**order.

    The start is exact on the bar; its velocities are off the periodic orbit by O(r0**(order + 1)) Omega.
    Raises InputError unless the spins are opposite; DomainError unless |r0| < 1, and where the series has not converged.
    """
    shape, ratio = shape_of(scene)
    if not -1 < r0 < 1:
        raise DomainError(f"paired_scene: r0 = {r0:g} must lie between −1 and 1: it is the sine of an inclination")
    series = paired_series(order, shape, ratio)
    rate = natural_rate(scene) * float(evaluate(series.frequency, r0, 0.0)) * np.sign(scene.spins[0])
    if (off := last_terms(series, r0)) > 1e-3:
        raise DomainError(
            f"paired_scene: at r0 = {r0:g} the last terms of the series of order {order} are still {off:.1g}: take a smaller "
            "amplitude or a higher order, or find the orbit by lagrotor.models.orbits.shooting.exact_orbit"
        )
    widths = np.array([1.0, np.sqrt(float(shape)), 1.0])
    first, slope = (
        widths * [float(evaluate(part, r0, 0.0)) for part in parts]
        for parts in ((series.x, series.Y, series.z), [p.derivative() for p in (series.x, series.Y, series.z)])
    )
    later = widths * [float(evaluate(p, r0, np.pi)) for p in (series.x, series.Y, series.z)]
    later_slope = widths * [float(evaluate(p.derivative(), r0, np.pi)) for p in (series.x, series.Y, series.z)]
    mirror = np.array([-1.0, 1.0, 1.0])
    axes, rates = (first, mirror * later), (rate * slope, rate * mirror * later_slope)
    return consistent_scene(scene.spins, axes, rates, scene.rotor, scene.link, scene.shock)


@cache
def paired_momentum(order: int = 4, shape: sp.Expr = sigma, ratio: sp.Expr = k) -> ClosedForm:
    """P/G of the paired precession of amplitude r_0 through r_0**order, for sigma = `shape`, k = `ratio`: sigma r_0²/k + …

    P = sum_i (y_i p_zi − z_i p_yi) + G (x_1 − x_2), p_i = a r_i' + b r_j': constant on the orbit, even in r_0.
    Times G (kg m²/s) it is the momentum. Arguments r_0, sigma, k.
    Raises SingularError should the series not be constant in the phase.
    """
    orbit = paired_series(order, shape, ratio)
    s = orbit.field.from_sympy(sp.sympify(shape))
    one = orbit.field.one
    heavy, light = (one + one / s) / 2, (one - one / s) / 2  # units a + b = 1
    x, Y, z = orbit.x, orbit.Y, orbit.z
    Y2, z2 = Y.half_period_later(), z.half_period_later()

    def carried(first: FourierSeries, second: FourierSeries) -> FourierSeries:
        return first.derivative().scaled(heavy) + second.derivative().scaled(light)

    turning = Y * carried(z, z2) - z * carried(Y, Y2) + Y2 * carried(z2, z) - z2 * carried(Y2, Y)
    total = (orbit.frequency * turning).scaled(s) + x + x.half_period_later()  # x_2 = −x_1 half a period later
    if any(h for _, h in total.terms):
        raise SingularError("paired_momentum: the momentum varies along the orbit: the series is wrong")
    return ClosedForm(
        "paired_momentum",
        ("P/G",),
        (orbit.expression(total),),
        (r0, sigma, k),
        (sp.Gt(r0, -1), sp.Lt(r0, 1)),
        "opposite spins, the symmetric periodic orbit",
        "5.2.1",
        order,
        r0,
    )


def leading_square(r0: float, sigma: float, k: float) -> float:
    """lambda² of the pair per radian of phase, at small amplitude: positive means growth by 2 pi lambda a turn.

        lambda² = (3/16) sigma² (1 − sigma) r0⁶ / k²      for a bar with b != 0 (sigma != 1),
        lambda² = (9/32) r0⁸ / k⁴                         for a massless bar or a dumbbell (sigma = 1).

    The powers follow from the averaged motion (`rotors.averaged`: the twist's stiffness is b Omega_0² d²/8, that of the
    mean x vanishes to the same order). The three rational factors were read off exact multipliers, not derived.
    """
    return 9 * r0**8 / (32 * k**4) if sigma == 1 else 3 * sigma**2 * (1 - sigma) * r0**6 / (16 * k**2)


def most_growth(r0: float, sigma: float, k: float) -> float:
    """A bound on lambda per radian of phase: both laws together, the first where it is positive. Not proved.

    The tests hold it to the exact multipliers of ten bars at r0 = 0.2 and 0.5.
    """
    return sqrt(max(leading_square(r0, sigma, k), 0.0) + leading_square(r0, 1.0, k))
