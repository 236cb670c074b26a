"""Integrals between limits, and sums: one that diverges has no value, and without end none is decided."""

import pytest
import sympy as sp

from lagrotor.paper import judge

x = sp.Symbol("x", real=True)
p = sp.Symbol("p", positive=True)
i = sp.Symbol("i", integer=True)
TURN = (x, 0, 2 * sp.pi)

# What is integrated, between which limits, its value, and what it is not.
VALUES = [
    (x**3 * sp.exp(-x), (x, 0, 1), 6 - 16 / sp.E, 6 - 15 / sp.E),
    (x**4 * sp.exp(-p * x**2), (x, -sp.oo, sp.oo), 3 * sp.sqrt(sp.pi / p) / (4 * p**2), 3 * sp.sqrt(sp.pi) / p**3),
    (x**2 / (1 + x**2) ** 2, (x, 0, sp.oo), sp.pi / 4, sp.pi / 3),
    (1 / (x**2 + x + 1), (x, -sp.oo, sp.oo), 2 * sp.pi / sp.sqrt(3), sp.pi),
    ((1 + x**2) ** -2, (x, -1, 1), sp.pi / 4 + sp.Rational(1, 2), sp.pi / 4),
    (sp.sqrt(x), (x, 0, p), 2 * p * sp.sqrt(p) / 3, 2 * p * sp.sqrt(p)),
    (1 / (p + x), (x, 0, p), sp.log(2), sp.log(3)),
    (sp.sin(x) ** 4, TURN, 3 * sp.pi / 4, sp.pi / 2),
]


@pytest.mark.parametrize(("body", "limits", "value", "other"), VALUES)
def test_values(body: sp.Expr, limits: tuple[sp.Expr, ...], value: sp.Expr, other: sp.Expr) -> None:
    assert judge(sp.Integral(body, limits), value).verdict == "holds"
    assert judge(sp.Integral(body, limits), other).verdict == "refuted"


# What an antiderivative gives where the integral diverges, jumps between the limits, or has a limit that is no number.
NONE = [
    (1 / x, (x, -1, 1), 0),
    (x**-2, (x, -1, 1), -2),
    (sp.log(x) / x, (x, 0, 1), 0),
    (sp.log(x), (x, -1, 1), -2),
    (1 / sp.cos(x), TURN, 0),
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


@pytest.mark.parametrize("term", [1 / i, (-1) ** i, (-2) ** i / (i + 1), 1 / i**2])
def test_a_series_without_end_is_not_decided(term: sp.Expr) -> None:
    for value in (sp.log(3), sp.pi**2 / 6, sp.Rational(-1, 2)):
        assert judge(sp.Sum(term, (i, 1, sp.oo)), value).verdict == "undecided"
