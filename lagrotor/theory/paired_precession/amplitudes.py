"""The amplitudes of a paired precession: r_0, the first harmonic of x, the largest inclination, one from another.

r_0 is x_1 = x_2 at the phase where the axes are parallel. The first harmonic is the coefficient of cos Phi in x_1, odd
in r_0. The largest inclination is reached by each axis somewhere on its way:

    sin² theta / r_0² = cos² Phi + sigma sin² Phi + r_0 (…) + …

so at Phi = 0 and exactly r_0 for sigma < 1; near Phi = pi/2 for sigma > 1; and where the next term is largest for
sigma = 1. From there it is followed order by order.
"""

from functools import cache

import numpy as np
import sympy as sp

from lagrotor.algebra import truncated_series
from lagrotor.errors import InputError
from lagrotor.pair.notation import COSINE, a_1, k, r0, sigma
from lagrotor.theory.closed_form import Array, ClosedForm
from lagrotor.theory.paired_precession.remainder import with_error
from lagrotor.theory.paired_precession.series import PairedSeries, paired_series


def first_harmonic(order: int = 5) -> ClosedForm:
    """Coefficient of cos Phi in x_1 of the paired precession of amplitude r_0, through r_0**order. (r_0, sigma, k)."""
    series = paired_series(order)
    total = sum(
        (sp.factor(series.field.to_sympy(v)) * r0**n for (n, h), v in sorted(series.x.terms.items()) if h == 1),
        sp.Integer(0),
    )
    form = _form("first_harmonic", "a_1", total, (r0, sigma, k), order)
    return with_error(form, lambda series, given: np.array([[series.harmonics(r)[1, 0] for r in given[r0].tolist()]]))


@cache
def amplitude_of_first_harmonic(order: int = 3) -> ClosedForm:
    """r_0 of the paired precession whose x_1 has a_1 cos Phi, through a_1**order: the series reversed. (a_1, sigma, k)."""
    forward = first_harmonic(order).expressions[0]
    guess: sp.Expr = a_1
    for _ in range(order // 2):
        # r_0 = a_1 − (a_1(r_0) − r_0): two more orders each time, as the series is odd.
        guess = _through(a_1 - (forward - r0).subs(r0, guess), a_1, order)

    def reversed_series(series: PairedSeries, given: dict[sp.Symbol, Array]) -> Array:
        harmonic = np.polynomial.Polynomial(series.coefficients[:, 1, 0])
        return np.array([[_root(harmonic, size) for size in given[a_1].tolist()]])

    form = _form("amplitude_of_first_harmonic", "r_0", guess, (a_1, sigma, k), order)
    return with_error(form, reversed_series, lambda series, amplitude: 2 * series.remainder(amplitude).axes)


def _root(polynomial: np.polynomial.Polynomial, value: float) -> float:
    """Where a_1(r_0) is `value`, by Newton's method from r_0 = value."""
    at = value
    for _ in range(20):
        at -= float((polynomial(at) - value) / polynomial.deriv()(at))
    return at


def _through(expression: sp.Expr, small: sp.Symbol, order: int) -> sp.Expr:
    polynomial = sp.Poly(expression, small)
    return sum((sp.factor(polynomial.coeff_monomial(small**n)) * small**n for n in range(order + 1)), sp.Integer(0))


@cache
def largest_inclination(shape: str = "dumbbell", order: int = 3) -> ClosedForm:
    """sin of the largest inclination of either axis on the paired precession of amplitude r_0 > 0. (r_0, sigma, k).

    shape: "dumbbell" for sigma = 1 (a massless bar too), "rod" for sigma > 1, "ring" for sigma < 1, where it is r_0
    itself. Small r_0: for a rod r_0 must be well below sigma − 1. Raises InputError for another shape.
    """
    if shape == "ring":
        return _form("largest_inclination", "sin theta", r0, (r0, sigma, k), None, (sp.Ge(r0, 0), sp.Lt(sigma, 1)))
    if shape not in ("dumbbell", "rod"):
        raise InputError(f"largest_inclination: shape = {shape!r} must be dumbbell, rod or ring")
    even = shape == "dumbbell"
    square = _squared_sine(order + 1, sp.Integer(1) if even else sigma)
    leading = square.coeff(r0, 1 if even else 0)
    # Both leading terms are stationary within the turn, at a largest value.
    place = max(sp.solve(leading.diff(COSINE), COSINE))
    top = _largest(square, place, 1 if even else 0, order)
    half = sp.Poly(top, r0)
    scale = half.coeff_monomial(1)
    sine = truncated_series(r0 * sp.sqrt(sp.expand(top / scale)), r0, order)
    sine = _through(sp.expand(sine), r0, order)
    condition = sp.Eq(sigma, 1) if even else sp.Gt(sigma, 1)
    form = _form(
        "largest_inclination", "sin theta", sp.sqrt(scale) * sine, (r0, sigma, k), order, (sp.Ge(r0, 0), condition)
    )
    return with_error(form, _steepest)


def _steepest(series: PairedSeries, given: dict[sp.Symbol, Array]) -> Array:
    """The largest sine of the inclination over a turn; sampled finely enough for its square to be right to 1e-7."""
    axes = series.axes(float(given[r0][0]), np.linspace(0, 2 * np.pi, 20_001))
    return np.full((1, given[r0].size), np.hypot(axes[..., 0], axes[..., 1]).max())


def _squared_sine(order: int, shape: sp.Expr) -> sp.Expr:
    """(1 − z_1²)/r_0² through r_0**(order − 2), a polynomial in r_0 and the cosine of the phase: z_1 is even in it."""
    series = paired_series(order, shape)
    z = series.z
    total = sp.Integer(0)
    for (n, h), value in (z * z).terms.items():
        if n:
            total -= series.field.to_sympy(value) * r0 ** (n - 2) * sp.chebyshevt(h, COSINE)
    return sp.expand(total)


def _largest(square: sp.Expr, place: sp.Expr, lowest: int, order: int) -> sp.Expr:
    """The largest value over the phase, through r_0**(order − 1), followed from the cosine `place` at r_0 = 0."""
    slope = square.diff(COSINE)
    curvature = sp.cancel(slope.coeff(r0, lowest).diff(COSINE).subs(COSINE, place))
    where = place
    for n in range(1, order):
        left = sp.expand(slope.subs(COSINE, where)).coeff(r0, n + lowest)
        where -= sp.cancel(left / curvature) * r0**n
    return _through(sp.expand(square.subs(COSINE, where)), r0, order - 1)


def _form(
    name: str,
    output: str,
    expression: sp.Expr,
    arguments: tuple[sp.Symbol, ...],
    order: int | None,
    more: tuple[sp.Basic, ...] = (),
) -> ClosedForm:
    small = arguments[0]
    return ClosedForm(
        name,
        (output,),
        (expression,),
        arguments,
        (sp.Gt(small, -1), sp.Lt(small, 1), *more),
        "opposite spins, the symmetric periodic orbit",
        "5.20",
        order,
        small,
    )
