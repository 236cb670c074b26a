"""Integrals between limits: improper at an end, over the whole line, over a turn; one that diverges has no value."""

import pytest
import sympy as sp

from lagrotor.paper import judge

x = sp.Symbol("x", real=True)
p = sp.Symbol("p", positive=True)
TURN = (x, 0, 2 * sp.pi)

# What is integrated, between which limits, its value (Gradshteyn & Ryzhik, 3.461, 2.711, 3.613, 3.616), and what it is not.
VALUES = [
    (x**2 * sp.exp(-(x**2)), (x, -sp.oo, sp.oo), sp.sqrt(sp.pi) / 2, sp.sqrt(sp.pi) / 3),
    (
        x**4 * sp.exp(-p * x**2),
        (x, -sp.oo, sp.oo),
        3 * sp.sqrt(sp.pi) / (4 * p**2 * sp.sqrt(p)),
        3 * sp.sqrt(sp.pi) / p**3,
    ),
    (x**3 * sp.exp(-(x**2)), (x, 0, sp.oo), sp.Rational(1, 2), sp.Rational(1, 3)),
    ((1 + x**2) ** -2, (x, -sp.oo, sp.oo), sp.pi / 2, sp.pi / 3),
    (x**2 / (1 + x**2) ** 2, (x, 0, sp.oo), sp.pi / 4, sp.pi / 3),
    (1 / (x**2 + x + 1), (x, -sp.oo, sp.oo), 2 * sp.pi / sp.sqrt(3), sp.pi),
    (sp.log(x), (x, 0, 1), sp.Integer(-1), sp.Integer(-2)),
    (x**2 * sp.log(x) ** 2, (x, 0, 1), sp.Rational(2, 27), sp.Rational(1, 27)),
    (1 / sp.sqrt(x), (x, 0, 1), sp.Integer(2), sp.Integer(1)),
    (1 / (2 + sp.cos(x)), TURN, 2 * sp.pi / sp.sqrt(3), 2 * sp.pi / sp.sqrt(5)),
    (1 / (2 + sp.sin(x)), (x, -sp.pi, sp.pi), 2 * sp.pi / sp.sqrt(3), sp.pi),
    (1 / (p + 1 + sp.cos(x)), TURN, 2 * sp.pi / sp.sqrt(p**2 + 2 * p), 2 * sp.pi / (p + 1)),
    ((5 - 3 * sp.cos(x)) ** -2, (x, 0, sp.pi), 5 * sp.pi / 64, 5 * sp.pi / 32),
    (sp.sin(x) ** 2 / (5 + 4 * sp.cos(x)), TURN, sp.pi / 4, sp.pi / 3),
    (1 / (1 + sp.cos(x)), (x, 0, sp.pi / 2), sp.Integer(1), sp.Integer(2)),
]


@pytest.mark.parametrize(("body", "limits", "value", "other"), VALUES)
def test_values(body: sp.Expr, limits: tuple[sp.Expr, ...], value: sp.Expr, other: sp.Expr) -> None:
    assert judge(sp.Integral(body, limits), value).verdict == "holds"
    assert judge(sp.Integral(body, limits), other).verdict == "refuted"


# What an antiderivative gives where the integral diverges, or jumps between the limits.
NONE = [
    (1 / x, (x, -1, 1), 0),
    (x**-2, (x, -1, 1), -2),
    (sp.log(x) / x, (x, 0, 1), 0),
    (sp.log(x), (x, -1, 1), -2),
    (1 / sp.cos(x), TURN, 0),
    (1 / (1 + 2 * sp.cos(x)), TURN, 0),
    (1 / (1 + sp.cos(x)), TURN, 0),
    (sp.exp(1 / x) / x**2, (x, -1, 1), sp.exp(-1) - sp.E),
    (x / (1 + x**2), (x, -sp.oo, sp.oo), 0),
    (sp.cos(x), (x, 0, sp.oo), 0),
]


@pytest.mark.parametrize(("body", "limits", "said"), NONE)
def test_an_integral_that_diverges_has_no_value(body: sp.Expr, limits: tuple[sp.Expr, ...], said: sp.Expr) -> None:
    for other in (said, said + 1):
        assert judge(sp.Integral(body, limits), sp.sympify(other)).verdict == "undecided"


def test_where_an_antiderivative_jumps_its_jump_is_left_out() -> None:
    """∫ of d/dx arctan(1/x) = −1/(1 + x²) over (−1, 1) is −π/2, not arctan 1 − arctan(−1)."""
    body = sp.atan(1 / x).diff(x)
    assert judge(sp.Integral(body, (x, -1, 1)), -sp.pi / 2).verdict == "holds"
    assert judge(sp.Integral(body, (x, -1, 1)), sp.pi / 2).verdict == "refuted"
