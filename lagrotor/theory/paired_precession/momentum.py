"""The momentum about the joint line that the paired precession carries, as a series in its amplitude."""

from functools import cache

import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.pair.symbols import k, r0, sigma
from lagrotor.theory.closed_form import ClosedForm
from lagrotor.theory.paired_precession.series import paired_series


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
