"""Error bounds of closed forms of the paired precession, from a comparison with a series of higher order.

The bound of a form through r_0**n is its distance from the series through r_0**(n + 6), plus the estimated remainder of that
series.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import sympy as sp

from lagrotor.errors import DomainError
from lagrotor.pair.notation import k, r0, sigma
from lagrotor.theory.closed_form import Array, ClosedForm
from lagrotor.theory.paired_precession.series import PairedSeries, paired_series

EXTRA_ORDERS = 6
_ROUNDED = 1e-3  # of the largest error of an output, for rounding in the forms and in a simulation for comparison

# (series, arguments by symbol at one amplitude and bar) → outputs, (outputs, n); and (series, r_0) → bound of their error.
SeriesReference = Callable[[PairedSeries, dict[sp.Symbol, Array]], Array]
RemainderBound = Callable[[PairedSeries, float], float]


def of_axes(series: PairedSeries, amplitude: float) -> float:
    """Return a bound of the series' truncation error for outputs that are components of the axes."""
    return series.remainder(amplitude).axes


def with_error(form: ClosedForm, reference: SeriesReference, remainder: RemainderBound = of_axes) -> ClosedForm:
    """Return the closed form with a function `bound` for its error. If sigma is not among the arguments, sigma = 1 is used."""
    assert form.order is not None
    order = max(form.order + EXTRA_ORDERS, 9)

    def bound(*values: Array) -> Array:
        arguments = dict(zip(form.arguments, values, strict=True))
        ones = np.ones_like(values[0])
        places = np.stack([values[0], arguments.get(sigma, ones), arguments.get(k, ones)])
        bounds = np.empty((len(form.outputs), values[0].size))
        for place in np.unique(places, axis=1).T:
            selected = (places == place[:, None]).all(0)
            shape, ratio = map(sp.Rational, place[1:])
            series = paired_series(order, shape, ratio, exact=False)
            selection = {symbol: array[selected] for symbol, array in arguments.items()}
            exact, truncation = reference(series, selection), _rest(form.name, series, remainder, float(place[0]))
            mine = np.reshape(form(*(selection[s] for s in form.arguments)), exact.shape)
            apart = np.abs(mine - exact)
            bounds[:, selected] = apart + _ROUNDED * apart.max(0) + truncation
        return bounds

    return replace(form, bound=bound)


def _rest(name: str, series: PairedSeries, remainder: RemainderBound, amplitude: float) -> float:
    bound = remainder(series, amplitude)
    if not np.isfinite(bound):
        raise DomainError(
            f"{name}: at {r0} = {amplitude:g} the series does not converge, so that its error is not known; take a smaller "
            "amplitude, or lagrotor.precession_orbit"
        )
    return bound
