"""Series in an amplitude and a phase, whole and order by order; Lindstedt–Poincaré series and exponents of oscillators."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lagrotor.errors import SingularError
from lagrotor.mechanics.fourier import FourierSeries
from lagrotor.mechanics.weakly_nonlinear import characteristic_exponents, periodic_series


def value(series: FourierSeries, eps: float, phase: float) -> float:
    waves = {(n, h): np.cos(h * phase) if h >= 0 else np.sin(-h * phase) for n, h in series.terms}
    return float(sum(float(v) * eps**n * waves[n, h] for (n, h), v in series.terms.items()))


ORDER = 6
series = st.dictionaries(
    st.tuples(st.integers(0, 2), st.integers(-3, 3)), st.fractions(-3, 3, max_denominator=5), max_size=4
).map(lambda terms: FourierSeries({k: v for k, v in terms.items() if v}, ORDER))


@given(series, series, st.floats(-3, 3))
def test_products_and_derivatives_are_those_of_the_functions(f: FourierSeries, g: FourierSeries, phase: float) -> None:
    # Products of two series through eps² lie within the order kept, so nothing is dropped.
    eps, step = 0.7, 1e-5
    assert value(f * g, eps, phase) == pytest.approx(value(f, eps, phase) * value(g, eps, phase), abs=1e-9)
    slope = (value(f, eps, phase + step) - value(f, eps, phase - step)) / (2 * step)
    assert value(f.derivative(), eps, phase) == pytest.approx(slope, abs=1e-5)
    assert value(f.half_period_later(), eps, phase) == pytest.approx(value(f, eps, phase + np.pi), abs=1e-9)
    assert value(f - g, eps, phase) == pytest.approx(value(f, eps, phase) - value(g, eps, phase), abs=1e-9)


def duffing(order: int):
    """x'' + x + x³ = 0 in the phase: w² x'' + x + x³."""

    def residual(unknowns, frequency):
        (x,) = unknowns
        return [frequency * frequency * x.derivative().derivative() + x + x * x * x]

    return periodic_series(residual, [sp.QQ.zero], [{1: sp.QQ.one}], order, sp.QQ)


@pytest.mark.parametrize("order", [1, 4, 7])
def test_the_frequency_is_known_through_the_order_that_is_named(order: int) -> None:
    """At every order the terms are those of the longest series; Nayfeh & Mook: w = 1 + 3/8 e² − 21/256 e⁴ + …."""
    found, longest = duffing(order), duffing(9)
    assert found.known_through == order and longest.frequency.terms[4, 0] == sp.QQ(-21, 256)
    assert found.frequency.terms == longest.frequency.through(order).terms
    assert found.unknowns[0].terms == longest.unknowns[0].through(order).terms


def test_a_resonance_is_refused() -> None:
    """A second oscillator at twice the frequency, driven by x²: no periodic orbit near the first mode."""

    def residual(unknowns, frequency):
        x, y = unknowns
        squared = frequency * frequency
        return [
            squared * x.derivative().derivative() + x,
            squared * y.derivative().derivative() + y.times(4) + x * x,
        ]

    with pytest.raises(SingularError, match="resonance"):
        periodic_series(residual, [sp.QQ.zero] * 2, [{1: sp.QQ.one}, {}], 3, sp.QQ)


LAST = 9


def charge(unknowns, frequency):
    """x'' = y' − x (x² + y²), y'' = −x' − y (x² + y²): a unit charge in a unit field, in the phase."""
    x, y = unknowns
    squared, well = frequency * frequency, x * x + y * y
    return [
        squared * x.derivative().derivative() - frequency * y.derivative() + x * well,
        squared * y.derivative().derivative() + frequency * x.derivative() + y * well,
    ]


def test_the_drift_of_the_guiding_centre() -> None:
    """A circle of radius e turns at w = (1 + sqrt(1 + 4 e²))/2, its neighbours at sqrt(1 + 6 e²) in its frame.

    So the centre drifts by sqrt(1 + 6 e²)/w − 1 per radian of phase: lambda² = −4 e⁴ + …
    """
    one, zero = sp.QQ.one, sp.QQ.zero
    orbit = periodic_series(charge, [zero, zero], [{1: one}, {-1: -one}], LAST, sp.QQ)
    found = characteristic_exponents(charge, orbit, (False, True), (0, 1), LAST - 1, sp.QQ)
    e = sp.Symbol("e", positive=True)
    exact = -((sp.sqrt(1 + 6 * e**2) / ((1 + sp.sqrt(1 + 4 * e**2)) / 2) - 1) ** 2)
    series = sp.series(exact, e, 0, LAST).removeO()
    square = sum(sp.QQ.to_sympy(v) * e**n for (n, _), v in found.square.terms.items())
    assert sp.expand(series - square) == 0
    assert series.coeff(e, 4) == -4
    assert sp.expand(series - square.subs(e, 2 * e)) != 0  # twin
    # By symmetry a shift along x drives one along y as the other way about, with the other sign.
    assert (found.A + found.B).terms == {} and found.p[0].harmonics(0) == found.q[1].harmonics(0) == {0: one}
