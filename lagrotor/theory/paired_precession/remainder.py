"""Bounds of the errors of closed forms of the paired precession: their distance from a series of higher order.

The error of a form through r_0**n is its distance from what the series through r_0**(n + 6) gives for the same
quantity, and the estimated remainder of that series.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import sympy as sp

from lagrotor.errors import DomainError
from lagrotor.pair.notation import k, r0, sigma
from lagrotor.theory.closed_form import Array, ClosedForm
from lagrotor.theory.paired_precession.series import PairedSeries, paired_series

MORE_ORDERS = 6
_ROUNDED = 1e-3  # of the largest error of an output: the rounding of both, and of a run that they are held to

# (series, the form's arguments by symbol, one amplitude and bar) → the outputs (outputs, n); and (series, r_0) → the
# bound of their error.
SeriesReference = Callable[[PairedSeries, dict[sp.Symbol, Array]], Array]
Rest = Callable[[PairedSeries, float], float]


def of_axes(series: PairedSeries, amplitude: float) -> float:
    """For outputs that are components of the axes."""
    return series.remainder(amplitude).axes


def with_error(form: ClosedForm, reference: SeriesReference, rest: Rest = of_axes) -> ClosedForm:
    """The form with a bound of its error; where its `arguments` have no sigma it is 1."""
    assert form.order is not None
    order = max(form.order + MORE_ORDERS, 9)

    def bound(*values: Array) -> Array:
        given = dict(zip(form.arguments, values, strict=True))
        ones = np.ones_like(values[0])
        places = np.stack([values[0], given.get(sigma, ones), given.get(k, ones)])
        bounds = np.empty((len(form.outputs), values[0].size))
        for place in np.unique(places, axis=1).T:
            here = (places == place[:, None]).all(0)
            shape, ratio = map(sp.Rational, place[1:])
            series = paired_series(order, shape, ratio, exact=False)
            part = {symbol: array[here] for symbol, array in given.items()}
            exact, left = reference(series, part), _rest(form.name, series, rest, float(place[0]))
            mine = np.reshape(form(*(part[s] for s in form.arguments)), exact.shape)
            apart = np.abs(mine - exact)
            bounds[:, here] = apart + _ROUNDED * apart.max(0) + left
        return bounds

    return replace(form, bound=bound)


def _rest(name: str, series: PairedSeries, rest: Rest, amplitude: float) -> float:
    left = rest(series, amplitude)
    if not np.isfinite(left):
        raise DomainError(
            f"{name}: at {r0} = {amplitude:g} the series does not converge, so that its error is not known; take a smaller "
            "amplitude, or lagrotor.precession_orbit"
        )
    return left
