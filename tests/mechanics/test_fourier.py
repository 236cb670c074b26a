"""Series in an amplitude and a phase, whole and order by order; Lindstedt–Poincaré series and exponents of oscillators."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.errors import SingularError
from lagrotor.mechanics import FourierSeries, GrowingSeries, Unknowns, characteristic_exponents, lindstedt_poincare


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


THROUGH = 4
KEYS = st.tuples(st.integers(0, THROUGH), st.integers(-3, 3))
TERMS = st.dictionaries(KEYS, st.fractions(-3, 3, max_denominator=4).filter(bool), max_size=5)
# Nested products, of which the inner ones are read again at each order.
EQUATIONS = {
    "product": lambda x, y: x * y,
    "nested": lambda x, y: (x * y - y.derivative()) * (x + x.half_period_later()).times(Fraction(2, 3)),
    "constant": lambda x, y: x * x + y * y - x.constant(Fraction(1)),
}


def waves(series: FourierSeries, n: int) -> dict[int, Fraction]:
    return dict(series.harmonics(n))


@pytest.mark.parametrize("name", EQUATIONS)
@settings(max_examples=25, deadline=None)
@given(first=TERMS, second=TERMS)
def test_each_order_is_that_of_the_whole(name: str, first: dict, second: dict) -> None:
    x, y = FourierSeries(first, THROUGH), FourierSeries(second, THROUGH)
    growing = Unknowns()
    equation = EQUATIONS[name](growing.series(x), growing.series(y))
    assert [dict(equation.at(n)) for n in range(THROUGH + 1)] == [
        waves(EQUATIONS[name](x, y), n) for n in range(THROUGH + 1)
    ]


def found_at(forget: bool) -> tuple[GrowingSeries, Unknowns]:
    """x² of x = eps cos Phi, read through eps**2 before the term 3 eps**2 cos 2 Phi of x is found."""
    growing = Unknowns()
    x = growing.series(FourierSeries({(0, 0): Fraction(1), (1, 1): Fraction(1)}, THROUGH))
    square = x * x
    square.at(2)
    growing.put(x, 2, 2, Fraction(3))
    if forget:
        growing.forget(2)
    return square, growing


def test_what_is_found_counts_once_the_order_is_forgotten() -> None:
    square, _ = found_at(True)
    assert square.at(2) == {0: Fraction(1, 2), 2: Fraction(1, 2) + 6}


def test_without_forgetting_the_order_stays_what_it_was() -> None:
    square, _ = found_at(False)
    assert square.at(2) == {0: Fraction(1, 2), 2: Fraction(1, 2)}


def test_nothing_is_computed_twice() -> None:
    square, growing = found_at(True)
    square.at(2), square.at(4)
    counted: list[int] = []
    square.compute = counted.append  # type: ignore[assignment]
    square.at(2), square.at(4)
    assert counted == []
    growing.forget(4)
    square.at(4)
    assert counted == [4]


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
    orbit = lindstedt_poincare(charge, [zero, zero], [{1: one}, {-1: -one}], LAST, sp.QQ)
    found = characteristic_exponents(charge, orbit, (False, True), (0, 1), LAST - 1, sp.QQ)
    e = sp.Symbol("e", positive=True)
    exact = -((sp.sqrt(1 + 6 * e**2) / ((1 + sp.sqrt(1 + 4 * e**2)) / 2) - 1) ** 2)
    series = sp.series(exact, e, 0, LAST).removeO()
    square = sum(sp.QQ.to_sympy(v) * e**n for (n, _), v in found.square.terms.items())
    assert sp.expand(series - square) == 0
    assert series.coeff(e, 4) == -4
    assert sp.expand(series - square.subs(e, 2 * e)) != 0  # twin


def test_p_and_q_solve_the_variational_equations() -> None:
    """By symmetry a shift along x drives one along y as the other way about, with the other sign: A = −B."""
    one, zero = sp.QQ.one, sp.QQ.zero
    orbit = lindstedt_poincare(charge, [zero, zero], [{1: one}, {-1: -one}], 5, sp.QQ)
    found = characteristic_exponents(charge, orbit, (False, True), (0, 1), 4, sp.QQ)
    assert (found.A + found.B).terms == {}
    assert found.p[0].harmonics(0) == {0: one} and found.q[1].harmonics(0) == {0: one}
