"""Series that grow order by order are, through any order, what FourierSeries makes of the same terms."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.mechanics import FourierSeries, GrowingSeries, Unknowns

ORDER = 4
KEYS = st.tuples(st.integers(0, ORDER), st.integers(-3, 3))
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
    x, y = FourierSeries(first, ORDER), FourierSeries(second, ORDER)
    growing = Unknowns()
    equation = EQUATIONS[name](growing.series(x), growing.series(y))
    assert [dict(equation.at(n)) for n in range(ORDER + 1)] == [
        waves(EQUATIONS[name](x, y), n) for n in range(ORDER + 1)
    ]


def found_at(forget: bool) -> tuple[GrowingSeries, Unknowns]:
    """x² of x = eps cos Phi, read through eps**2 before the term 3 eps**2 cos 2 Phi of x is found."""
    growing = Unknowns()
    x = growing.series(FourierSeries({(0, 0): Fraction(1), (1, 1): Fraction(1)}, ORDER))
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
