"""Truncated series against known expansions, and the order of the first term that differs."""

from dataclasses import replace
from random import Random

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    Rational,
    acos,
    acosh,
    asin,
    asinh,
    atan,
    cos,
    cosh,
    cot,
    coth,
    csc,
    csch,
    exp,
    log,
    pi,
    sec,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
)  # fmt: skip

from lagrotor.algebra import LeadingTerm, agreement_order, decide_zero, leading_term, power_series, truncated_series
from lagrotor.errors import InputError, NotExactError

x, y, e = sp.symbols("x y epsilon")


@pytest.mark.parametrize(
    ("expression", "order", "series"),
    [
        (sqrt(1 + e * x), 2, 1 + e * x / 2 - e**2 * x**2 / 8),
        (cos(x + e), 2, cos(x) - e * sin(x) - e**2 * cos(x) / 2),
        (exp(e * x) * (1 + e) ** 2, 1, 1 + e * (x + 2)),
        (2**e, 1, 1 + e * log(2)),
        (tan(e) + atan(e) + asinh(e), 3, 3 * e - e**3 / 6),
        ((1 - cos(e * x)) / e**2, 2, x**2 / 2 - e**2 * x**4 / 24),
        (e**3 / (sin(e) - e), 2, -6 - 3 * e**2 / 10),
        (1 / e - 1 / sin(e), 1, -e / 6),
        (sqrt(x**2 + y**2 + e), 1, sqrt(x**2 + y**2) + e / (2 * sqrt(x**2 + y**2))),
        ((sin(x) ** 2 + cos(x) ** 2 - 1) * exp(e), 2, 0),
        (x * cos(y), 3, x * cos(y)),
    ],
)
def test_series(expression: sp.Expr, order: int, series: sp.Expr) -> None:
    found = truncated_series(expression, e, order)
    assert sp.expand(found - series) == 0


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        (sin(1 / e), "essential singularity or a jump at epsilon = 0: its argument has the negative power -1"),
        (exp(x / sqrt(e)), "negative power -1/2"),
        (sqrt(e**2 + e**3), "depends on the sign of epsilon: declare it positive"),
        (log(-e), "depends on the sign"),
        (acos(cos(e)), "depends on the sign"),
        (sqrt(-1 + sqrt(e)), "may lie on a branch cut"),
        (1 / log(e), "leading term is a logarithm"),
        (e**x, "no rational number"),
        (e ** Rational(1, 25), "common denominator 25"),
        (cos(e) / e**30, "too few terms"),
        (sp.gamma(e), "not known to be analytic"),
        (1 / (e + sqrt(x**2) - x), "cannot tell"),
        (sp.Abs(x + e), "not known to be analytic"),
        (1 / (sin(e) ** 2 + cos(e) ** 2 - 1), "too few terms"),
        (1 / (e + sqrt(x * y) - sqrt(x) * sqrt(y)), "cannot tell"),
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
    monkeypatch.setattr(power_series, "magnitude_at", lambda coefficient, point: size)
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
        1 / sqrt(-1 + i * e),
        log(-1 + i * e),
        sqrt(x + i * e),
        (-2 + i * e) ** Rational(1, 3),
        sqrt(-1 - i * e**20),
        log(-1 + e**20 * sqrt(-2 + e)),
        sqrt(-1 + e ** Rational(41, 2)),
        sqrt(-1 + e**20 * (sqrt(n) + e)),
        sqrt(-1 + e * m),
        log(x + e * log(y)),
        atan(m + e),
    ],
)
def test_a_series_from_a_branch_cut_is_refused(expression: sp.Expr) -> None:
    with pytest.raises(NotExactError, match="may lie on a branch cut"):
        truncated_series(expression, e, 2)


@pytest.mark.parametrize(
    "expression",
    [
        1 / sqrt(-2 - e + e**2),
        sqrt(1 + i * e),
        (-2 + e) ** Rational(1, 3),
        (2 + i * e) ** Rational(-5, 3),
        sqrt(-cos(e)),
        atan(i / 2 + e),
        atan(1 + 2 * i + e),
        sqrt(2 * exp(i * sp.pi / 7) + e),
    ],
)
def test_off_a_cut_or_along_it_a_series_is_near_its_function_on_both_sides(expression: sp.Expr) -> None:
    series = truncated_series(expression, e, 4)
    for size in (Rational(1, 50), -Rational(1, 50)):
        assert abs(sp.N((expression - series).subs(e, size), 30)) < 1e-7
    assert abs(sp.N((sqrt(-1 + i * e) - i - e / 2).subs(e, -Rational(1, 50)), 30)) > 1  # what is refused is wrong


@pytest.mark.parametrize(
    ("expression", "small", "order"), [(None, e, 2), (x, x + 1, 2), (x, 3, 2), (x, e, True), (x, e, 2.0), ("e", e, 1)]
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
        (sin(x) + e * cos(x), sin(x + e), 2),
        (sin(x) * cos(e) + cos(x) * sin(e), sin(x + e), None),
        (sqrt(1 + 2 * e + e**2), 1 + e, None),
    ],
)
def test_agreement_order(printed: sp.Expr, derived: sp.Expr, order: int | None) -> None:
    assert agreement_order(printed, derived, e).order == order


q, half = sp.Symbol("q", positive=True), Rational(1, 2)


@pytest.mark.parametrize(
    ("expression", "order", "series"),
    [
        (cot(e * x), 3, 1 / (e * x) - e * x / 3 - (e * x) ** 3 / 45),
        (tan(pi / 2 + e) + sec(e - pi / 2), 1, e / 2),
        (tan(e + atan(q) + atan(1 / q)), 0, -1 / e),
        (tanh(i * pi / 2 + e) - coth(e), 3, 0),
        (sqrt(sin(e)), 4, e**half - e ** (5 * half) / 12),
        (sqrt(e * q + e**2), 2, sqrt(q) * e**half + e ** (3 * half) / (2 * sqrt(q))),
        (e ** Rational(1, 3) * sqrt(1 + sqrt(e)), 1, e ** Rational(1, 3) + e ** Rational(5, 6) / 2),
        (acos(1 - e), 2, sqrt(2) * (e**half + e ** (3 * half) / 12)),
        (acosh(1 + e) + asin(1 - e), 1, pi / 2),
        ((1 + e) ** (1 / e), 2, exp(1) * (1 - e / 2 + 11 * e**2 / 24)),
        (log(sin(e)), 4, log(e) - e**2 / 6 - e**4 / 180),
        (e**e, 2, 1 + e * log(e) + e**2 * log(e) ** 2 / 2),
    ],
)
def test_about_a_singular_point(expression: sp.Expr, order: int, series: sp.Expr) -> None:
    assert sp.expand(truncated_series(expression, e, order) - series) == 0


def test_one_side_of_a_branch_point_may_be_all_that_is_known() -> None:
    assert truncated_series(sqrt(q**2 + q**3), q, 3) == q + q**2 / 2 - q**3 / 8
    assert truncated_series(sqrt(1 + q**-4), q, 2) == q**-2 + q**2 / 2
    assert truncated_series(sqrt(x * q), q, 1) == sqrt(x) * sqrt(q)
    assert sp.expand(truncated_series(sqrt(-1 + sqrt(q)), q, 1) - i * (1 - sqrt(q) / 2 - q / 8)) == 0
    # With both signs each of these would be false: sqrt(e**2) at e < 0 is -e, and so on.
    for refused in (sqrt(e**2), sqrt(e**3), sqrt(1 / e), sqrt(x * e), sqrt(-1 + e ** (3 * half))):
        with pytest.raises(NotExactError, match=r"declare it positive|branch cut"):
            truncated_series(refused, e, 1)


def _gap(expression: sp.Expr, series: sp.Expr, small: sp.Symbol, size: sp.Rational) -> sp.Expr:
    return sp.Abs((expression - series).subs(small, size).evalf(400, maxn=900)).evalf(20)


_FUNCTIONS = (sin, cos, tan, cot, sec, csc, sinh, cosh, tanh, coth, csch, exp, log, atan, asinh, asin, acos, acosh)
_CONSTANTS = (sp.S.One, -sp.S.One, half, pi / 2, pi, i, sqrt(2), sp.S.Zero, sp.Integer(-2), 1 + i)
_POWERS = (half, -half, Rational(3, 2), Rational(-2, 3), *map(sp.Integer, (-2, -1, 2, 3)))


def _singular(random: Random, small: sp.Symbol, depth: int) -> sp.Expr:
    """A random expression, most often singular where small = 0."""
    if not depth:
        a, b, power = random.choice(_CONSTANTS), random.choice(_CONSTANTS), random.choice(_POWERS)
        return random.choice((small, a + b * small, small**power))
    left, right = _singular(random, small, depth - 1), _singular(random, small, depth - 1)
    outer = random.choice(_FUNCTIONS)(left)
    return random.choice((left + right, left * right, left ** random.choice(_POWERS), outer, outer))


@pytest.mark.parametrize("seed", [*range(12), *(pytest.param(s, marks=pytest.mark.slow) for s in range(12, 60))])
def test_a_random_series_about_a_singular_point_is_as_near_as_its_order_says(seed: int) -> None:
    """At two tiny values of the small quantity, of both signs where it has both; a changed coefficient is refuted."""
    random, compared = Random(seed), 0
    for _ in range(20):
        small, order = random.choice((e, q)), random.choice((-1, 0, 1, 2))
        expression = _singular(random, small, random.choice((1, 2)))
        if not expression.has(small) or expression.has(sp.nan, sp.zoo, sp.oo, sp.Abs):
            continue
        try:
            series = truncated_series(expression, small, order)
            changed = agreement_order(series + small**order / 7, expression, small, max(order, 0))
        except NotExactError:
            continue
        for sign in (1, -1) if small is e else (1,):
            far, near = (_gap(expression, series, small, sign * Rational(1, 10) ** k) for k in (30, 40))
            equal = max(far, near) < Rational(1, 10) ** 250
            assert equal or sp.log(far / near, 10) > 10 * order + Rational(1, 5), (expression, series)
        assert (changed.order, sp.nsimplify(changed.coefficient)) == (order, Rational(1, 7)), (expression, changed)
        compared += 1
    assert compared > 5


def test_orders_about_a_singular_point_are_absolute() -> None:
    found = agreement_order(1 / e, csc(e), e)
    assert (found.order, found.coefficient, found.vanishes_through) == (1, -Rational(1, 6), 0)
    assert agreement_order(2 / e, csc(e), e).vanishes_through == -2
    found = agreement_order(sqrt(e), sqrt(sin(e)), e)
    assert (found.order, found.vanishes_through) == (5 * half, 2)
    assert leading_term(e ** (5 * half), e, 2).order == 5 * half  # no O(e**3)
    assert leading_term(e**3, e, 2) == LeadingTerm(None, sp.S.Zero, 2)
    assert leading_term(1 + e**3 * log(e) - cos(e**2), e, 2) == LeadingTerm(3, log(e), 2)  # no O(e**3) either
    assert leading_term(1 + e**4 * log(e) - cos(e**2), e, 2).order is None


@pytest.mark.parametrize("coefficient", [sp.airyai(x), sqrt(x**2) - x])
def test_an_undecided_principal_part_is_named(coefficient: sp.Expr) -> None:
    for power in (-2, -half, half):
        with pytest.raises(NotExactError, match="is undecided"):
            leading_term(coefficient * e**power + e, e)


COEFFICIENTS = st.lists(st.integers(-3, 3), min_size=1, max_size=4)


def polynomial(coefficients: list[int]) -> sp.Expr:
    return sp.Add(*(c * e**k for k, c in enumerate(coefficients)))


@settings(max_examples=25, deadline=None)
@given(COEFFICIENTS, st.integers(0, 6))
def test_a_disturbance_is_found_at_its_order(coefficients: list[int], order: int) -> None:
    base = cos(polynomial(coefficients) * x)
    found = agreement_order(base + e**order * y / (1 + e), base, e)
    assert found == LeadingTerm(order, y, 8)
