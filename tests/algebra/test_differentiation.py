"""Derivatives are those of sympy, term for term."""

import pytest
import sympy as sp

from lagrotor.algebra import along, derivative, hessian

x, y = sp.symbols("x y", real=True)
m = sp.Symbol("m", positive=True)
EXPRESSIONS = [
    m * (x * sp.cos(y) - sp.sin(x * y) / 2) ** 2 / (1 + x**2),
    sp.sqrt(m**2 + x**2) * sp.exp(-(x**2)) * sp.log(m + x**2),
    sp.tan(x) * sp.atan(x * y) + sp.cosh(x / m) ** -3,
    (x + y) ** 2 * (x - y),
    m**x + x**x,
    sp.Abs(x) * sp.Function("f")(x, y),
    sp.Piecewise((x**2, x > 0), (sp.sin(x), True)),
    sp.atan2(x, y),
    sp.pi * m,
]


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=str)
def test_it_is_what_sympy_gives(expression: sp.Expr) -> None:
    for symbol in (x, y, m):
        assert derivative(expression, symbol) == sp.diff(expression, symbol)
    assert derivative(expression * x, x) != derivative(expression * x, m)  # twin


def test_a_rate_is_the_sum_over_what_moves() -> None:
    expected = y * sp.diff(EXPRESSIONS[0], x) + m**2 * sp.diff(EXPRESSIONS[0], y)
    assert along(EXPRESSIONS[0], (x, y, m), (y, m**2, 0)) == expected
    assert along(EXPRESSIONS[0], (x, y, m), (y, m**2, 1)) != expected  # twin


def test_a_second_derivative_does_not_depend_on_the_order() -> None:
    second = hessian(EXPRESSIONS[0], (x, y))
    assert (second - sp.hessian(EXPRESSIONS[0], (x, y))).expand().is_zero_matrix
    assert sp.expand(second[0, 1] - second[1, 0]) == 0 != sp.expand(second[0, 0] - second[1, 1])  # twin


@pytest.mark.parametrize(
    ("expression", "slope"),
    [
        (x**2 * sp.Heaviside(x), 2 * x * sp.Heaviside(x)),
        (m * sp.sin(x) ** 2 * sp.Heaviside(sp.sin(x)), 2 * m * sp.sin(x) * sp.cos(x) * sp.Heaviside(sp.sin(x))),
        ((y - 2 * x) * sp.Heaviside(2 * x - y), -2 * sp.Heaviside(2 * x - y)),
        (x * sp.sign(x), sp.sign(x)),
        (
            (x**2 + y**2 - 1) ** 2 * sp.Heaviside(1 - x**2 - y**2),
            4 * x * (x**2 + y**2 - 1) * sp.Heaviside(1 - x**2 - y**2),
        ),
    ],
)
def test_a_distribution_is_zero_where_its_factor_is(expression: sp.Expr, slope: sp.Expr) -> None:
    assert sp.expand(derivative(expression, x) - slope) == 0
    assert derivative(expression + sp.Heaviside(x - 1), x).has(
        sp.DiracDelta
    )  # twins: a step, and one with another factor
    assert derivative((x - 1) * sp.Heaviside(x), x).has(sp.DiracDelta)
