"""Truncated series against known expansions, and the order of the first term that differs."""

from dataclasses import replace

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Rational, asinh, atan, cos, cosh, exp, log, sin, sqrt, tan

from lagrotor.algebra import LeadingTerm, agreement_order, decide_zero, leading_term, power_series, truncated_series
from lagrotor.errors import InputError, NotExactError

x, y, e = sp.symbols("x y epsilon")


@pytest.mark.parametrize(
    ("expression", "order", "series"),
    [
        (sqrt(1 + e * x), 2, 1 + e * x / 2 - e**2 * x**2 / 8),
        (1 / sqrt(1 - e), 3, 1 + e / 2 + 3 * e**2 / 8 + 5 * e**3 / 16),
        (sin(e * x), 4, e * x - e**3 * x**3 / 6),
        (cos(x + e), 2, cos(x) - e * sin(x) - e**2 * cos(x) / 2),
        (1 / (x + e), 2, 1 / x - e / x**2 + e**2 / x**3),
        (log(1 + e * y), 3, e * y - e**2 * y**2 / 2 + e**3 * y**3 / 3),
        (exp(e * x) * (1 + e) ** 2, 1, 1 + e * (x + 2)),
        (2**e, 1, 1 + e * log(2)),
        (tan(e) + atan(e) + asinh(e), 3, 3 * e - e**3 / 6),
        (sin(e) / e, 4, 1 - e**2 / 6 + e**4 / 120),
        ((1 - cos(e * x)) / e**2, 2, x**2 / 2 - e**2 * x**4 / 24),
        (e**3 / (sin(e) - e), 2, -6 - 3 * e**2 / 10),
        (1 / e - 1 / sin(e), 1, -e / 6),
        (sqrt(x**2 + y**2 + e), 1, sqrt(x**2 + y**2) + e / (2 * sqrt(x**2 + y**2))),
        ((sin(x) ** 2 + cos(x) ** 2 - 1) * exp(e), 2, 0),
        (e**5, 4, 0),
        (x * cos(y), 3, x * cos(y)),
    ],
)
def test_series(expression: sp.Expr, order: int, series: sp.Expr) -> None:
    found = truncated_series(expression, e, order)
    assert sp.expand(found - series) == 0


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        (1 / e, "negative power"),
        (cos(e) / e**2, "negative power"),
        (sin(1 / e), "negative power"),
        (log(e), "singular"),
        (log(e + sin(x) ** 2 + cos(x) ** 2 - 1), "singular"),
        (sqrt(e), "singular"),
        (sqrt(e**2 + e**3), "singular"),
        (tan(sp.pi / 2 + e) * x, "singular|negative"),
        (sp.Abs(x + e), "not known to be analytic"),
        ((1 + e) ** e, "not known to be analytic"),
        (1 / (sin(e) ** 2 + cos(e) ** 2 - 1), "too few terms"),
        (1 / (e + sqrt(x * y) - sqrt(x) * sqrt(y)), "cannot tell"),
        (1 / (e + log(x * y) - log(x) - log(y)), "cannot tell"),
    ],
)
def test_refused(expression: sp.Expr, reason: str) -> None:
    with pytest.raises(NotExactError, match=reason):
        truncated_series(expression, e, 3)


def test_leading_term() -> None:
    assert leading_term(cos(e * x) - 1 + e**2 * x**2 / 2, e) == LeadingTerm(4, x**4 / 24, 8)
    assert leading_term(sin(e) ** 2 + cos(e) ** 2 - 1, e, through=5) == LeadingTerm(None, sp.S.Zero, 5)
    assert leading_term(e**9, e) == LeadingTerm(None, sp.S.Zero, 8)
    assert leading_term(x + e, e) == LeadingTerm(0, x, 8)


def test_undecided_coefficient_is_named() -> None:
    with pytest.raises(NotExactError, match=r"coefficient airyai\(x\) of epsilon\*\*1"):
        leading_term(e * sp.airyai(x) + e**2, e)
    assert leading_term(e * log(x) + e**2, e).order == 1
    with pytest.raises(NotExactError, match="is undecided: The reduced numerator is not zero"):
        leading_term(e * (sqrt(x**2) - x) + e**2, e)  # vanishes where x > 0
    assert leading_term(e * sqrt(x) + e**2, e).order == 1


@pytest.mark.parametrize(("size", "told"), [(1.0, True), (1e-16, False), (None, False)])
def test_an_undecided_coefficient_is_one_only_where_a_value_says_so(
    monkeypatch: pytest.MonkeyPatch, size: float | None, told: bool
) -> None:
    """Also where no point gives a value."""
    undecided = replace(decide_zero(x), answer="undecided", reason="no reason")
    monkeypatch.setattr(power_series, "decide_zero", lambda coefficient: undecided)
    monkeypatch.setattr(power_series, "size_at", lambda coefficient, point: size)
    if told:
        assert truncated_series(1 / (x + e), e, 1) == 1 / x - e / x**2
    else:
        with pytest.raises(NotExactError, match="cannot tell whether x vanishes: no reason"):
            truncated_series(1 / (x + e), e, 1)


p, n, m = sp.Symbol("p", positive=True), sp.Symbol("n", negative=True), sp.Symbol("m", imaginary=True)
i = sp.I


@pytest.mark.parametrize(
    "expression",
    [
        sqrt(-1 + i * e),
        1 / sqrt(-1 + i * e),
        log(-1 + i * e),
        sqrt(x + i * e),
        sqrt(n + i * e * x),
        (-2 + i * e) ** Rational(1, 3),
        (-2 + i * e) ** x,
        sqrt(-exp(i * e)),
        sqrt(-1 + e * m),
        log(x + e * log(y)),
        atan(2 * i + e),
        atan(m + e),
        asinh(-3 * i + e * x),
    ],
)
def test_a_series_from_a_branch_cut_is_refused(expression: sp.Expr) -> None:
    with pytest.raises(NotExactError, match="may lie on a branch cut"):
        truncated_series(expression, e, 2)


@pytest.mark.parametrize(
    "expression",
    [
        sqrt(-1 + e),
        1 / sqrt(-2 - e + e**2),
        log(-1 + e * Rational(1, 2)),
        sqrt(1 + i * e),
        log(3 * i + i * e),
        (-2 + e) ** Rational(1, 3),
        (2 + i * e) ** Rational(-5, 3),
        sqrt(-cos(e)),
        atan(i / 2 + e),
        atan(3 + 2 * i * e),
        atan(1 + 2 * i + e),
        asinh(1 + i * e),
        sqrt(2 * exp(i * sp.pi / 7) + e),
    ],
)
def test_off_a_cut_or_along_it_a_series_is_near_its_function_on_both_sides(expression: sp.Expr) -> None:
    series = truncated_series(expression, e, 4)
    for size in (Rational(1, 50), -Rational(1, 50)):
        assert abs(sp.N((expression - series).subs(e, size), 30)) < 1e-7
    assert abs(sp.N((sqrt(-1 + i * e) - i - e / 2).subs(e, -Rational(1, 50)), 30)) > 1  # what is refused is wrong


@pytest.mark.parametrize(
    ("expression", "small", "order"), [(None, e, 2), (x, x + 1, 2), (x, 3, 2), (x, e, -1), (x, e, 2.0), ("e", e, 1)]
)
def test_bad_input_is_named(expression: object, small: sp.Expr, order: int) -> None:
    with pytest.raises(InputError, match=r"truncated_series|series: small"):
        truncated_series(expression, small, order)


def test_a_large_power_is_expanded() -> None:
    assert sp.expand(truncated_series((1 + e) ** (10**6), e, 2) - 1 - 10**6 * e - 499999500000 * e**2) == 0
    assert truncated_series((e + e**2) ** 5, e, 6) == e**5 + 5 * e**6


@pytest.mark.parametrize(
    ("printed", "derived", "order"),
    [
        (1 + e / 2, sqrt(1 + e), 2),
        (e, sin(e), 3),
        (1 - e**2 / 2, cos(e), 4),
        (1 + e**2 / 2, cosh(e), 4),
        (sin(x) + e * cos(x), sin(x + e), 2),
        (sin(x) * cos(e) + cos(x) * sin(e), sin(x + e), None),
        ((1 + e) * (1 - e), 1 - e**2, None),
        (sqrt(1 + 2 * e + e**2), 1 + e, None),
        (Rational(1, 2), Rational(1, 2) + e, 1),
    ],
)
def test_agreement_order(printed: sp.Expr, derived: sp.Expr, order: int | None) -> None:
    assert agreement_order(printed, derived, e).order == order


COEFFICIENTS = st.lists(st.integers(-3, 3), min_size=1, max_size=4)


def polynomial(coefficients: list[int]) -> sp.Expr:
    return sp.Add(*(c * e**k for k, c in enumerate(coefficients)))


@settings(max_examples=8, deadline=None)
@given(COEFFICIENTS, st.sampled_from([sin, cos, exp, atan, lambda u: 1 / (2 + e * u), lambda u: sqrt(1 + e * u)]))
def test_against_sympy_for_random_polynomials(coefficients: list[int], function: type[sp.Function]) -> None:
    expression = polynomial(coefficients) * function(polynomial([0, *coefficients]))
    expected = sp.series(expression, e, 0, 5).removeO()
    assert sp.expand(truncated_series(expression, e, 4) - expected) == 0


@settings(max_examples=25, deadline=None)
@given(COEFFICIENTS, st.integers(0, 6))
def test_a_disturbance_is_found_at_its_order(coefficients: list[int], order: int) -> None:
    base = cos(polynomial(coefficients) * x)
    found = agreement_order(base + e**order * y / (1 + e), base, e)
    assert found == LeadingTerm(order, y, 8)
