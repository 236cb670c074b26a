"""Series of 1/(1 − c), log, arctan and artanh by the ratio of their terms: at the ends of their range, and with near misses."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_zero

n = sp.Symbol("n", integer=True)
x = sp.Symbol("x", real=True)


def series(term: sp.Expr, first: int = 0) -> sp.Sum:
    return sp.Sum(term, (n, first, sp.oo))


TRUE = {
    "Leibniz": (series((-1) ** n / (2 * n + 1)), sp.pi / 4),
    "Mercator": (series((-1) ** (n + 1) / n, 1), sp.log(2)),
    "log of a half": (series(1 / (2**n * n), 1), sp.log(2)),
    "artanh of a third": (series(sp.Rational(1, 3) ** (2 * n + 1) / (2 * n + 1)), sp.log(2) / 2),
    "log": (series(x**n / n, 1), -sp.log(1 - x)),
    "arctan": (series((-1) ** n * x ** (2 * n + 1) / (2 * n + 1)), sp.atan(x)),
}


@pytest.mark.parametrize("name", TRUE)
def test_a_series_is_its_function_and_no_other(name: str) -> None:
    left, right = TRUE[name]
    assert decide_zero(left - right, within=[x > -1, x < 1]).answer == "zero"
    assert decide_zero(left - right - sp.Rational(1, 10**12), within=[x > -1, x < 1]).answer == "nonzero"


@pytest.mark.parametrize(
    "diverges", [series(1 / n, 1), series(1 / (2 * n + 1)), series((-1) ** n), series((-2) ** n / (n + 1))]
)
def test_a_series_that_diverges_has_no_value(diverges: sp.Sum) -> None:
    assert decide_zero(diverges - sp.log(3)).answer == "undecided"


def test_outside_its_range_a_series_is_not_decided() -> None:
    assert decide_zero(TRUE["log"][0] - TRUE["log"][1], within=[x > 0, x < 3]).answer == "undecided"
