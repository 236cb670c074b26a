"""Lindstedt–Poincaré series of textbook oscillators."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lagrotor.errors import SingularError
from lagrotor.mechanics import FourierSeries, lindstedt_poincare


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


def test_terms_beyond_the_order_are_dropped() -> None:
    high = FourierSeries({(4, 1): Fraction(1)}, ORDER)
    assert (high * high).terms == {}


def duffing(order: int, cubic: int = 1):
    """x'' + x + cubic x³ = 0 in the phase: w² x'' + x + cubic x³."""

    def residual(unknowns, frequency):
        (x,) = unknowns
        return [frequency * frequency * x.derivative().derivative() + x + (x * x * x).times(cubic)]

    one = sp.QQ.one
    return lindstedt_poincare(residual, [sp.QQ.zero], [{1: one}], order, sp.QQ)


def test_duffing_has_its_known_series() -> None:
    # Nayfeh & Mook: w = 1 + 3/8 e² − 21/256 e⁴ + 81/2048 e⁶ for x(0) = e.
    found = duffing(7)
    assert found.frequency.terms == {
        (0, 0): 1,
        (2, 0): sp.QQ(3, 8),
        (4, 0): sp.QQ(-21, 256),
        (6, 0): sp.QQ(81, 2048),
    }
    x = found.unknowns[0].harmonics(3)
    assert x == {1: sp.QQ(-1, 32), 3: sp.QQ(1, 32)}


@pytest.mark.parametrize("order", range(1, 8))
def test_the_frequency_is_known_through_the_order_that_is_named(order: int) -> None:
    """At every order the terms are those of the longest series, and not one less."""
    found, longest = duffing(order), duffing(9)
    assert found.known_through == order
    assert found.frequency.terms == longest.frequency.through(order).terms
    assert found.unknowns[0].terms == longest.unknowns[0].through(order).terms


def test_another_spring_has_another_series() -> None:
    assert duffing(3, -1).frequency.terms[2, 0] == sp.QQ(-3, 8)


def test_an_even_force_shifts_the_mean() -> None:
    """x'' + x + x² = 0: mean −e²/2, w = 1 − 5/12 e²."""

    def residual(unknowns, frequency):
        (x,) = unknowns
        return [frequency * frequency * x.derivative().derivative() + x + x * x]

    found = lindstedt_poincare(residual, [sp.QQ.zero], [{1: sp.QQ.one}], 3, sp.QQ)
    assert found.unknowns[0].harmonics(2)[0] == sp.QQ(-1, 2)
    assert found.frequency.terms[2, 0] == sp.QQ(-5, 12)


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
        lindstedt_poincare(residual, [sp.QQ.zero] * 2, [{1: sp.QQ.one}, {}], 3, sp.QQ)
