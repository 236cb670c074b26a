"""Letters are real: a witness is a point at which both sides are, and an equation that holds wherever they are holds there."""

import pytest
import sympy as sp
from sympy import I, Symbol, cos, cosh, log, sqrt

from lagrotor.paper import judge

x, y, v, c, omega, zeta = sp.symbols("x y v c omega zeta", real=True)
w = Symbol("w")

SAME_KIND = [
    (c * sqrt(1 - v**2 / c**2), sqrt(c**2 - v**2), c > 0),
    (1 / sqrt(1 - v**2 / c**2), c / sqrt(c**2 - v**2), c > 0),
    (omega * sqrt(1 - zeta**2), sqrt(omega**2 - zeta**2 * omega**2), omega >= 0),
    (x * sqrt(1 + y**2), sqrt(x**2 + x**2 * y**2), x >= 0),
    (x * sqrt(1 - y), sqrt(x**2 - x**2 * y), x >= 0),
    (-x * sqrt(1 - y), sqrt(x**2 - x**2 * y), x <= 0),
    (x * sqrt(y - 1), sqrt(x**2 * y - x**2), x >= 0),
    (log(x**2) - 2 * log(x), sp.S.Zero, x > 0),
]


@pytest.mark.parametrize(("left", "right", "branch"), SAME_KIND, ids=str)
def test_the_branch_is_found_where_squares_are_factors(left: sp.Expr, right: sp.Expr, branch: sp.Basic) -> None:
    verdict = judge(left, right)
    assert verdict.verdict == "holds-if"
    assert [r for premise in verdict.premises for r in premise.conditions] == [branch]
    assert judge(left, right, premises=[branch]).verdict == "holds-if"
    assert judge(left, right, premises=[sp.Not(branch)]).verdict != "holds-if"
    assert judge(2 * left + 1, right).verdict == "refuted"


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (2 * sqrt(x - 1), sqrt(x - 1)),
        (sqrt(x - 100), 2 * sqrt(x - 100)),
        (log(x - 1), log(x)),
        (sp.acosh(x), 2 * sp.acosh(x)),
        (sqrt(x) * sqrt(y), 2 * sqrt(x * y)),
        (sp.asin(x - 3), x),
    ],
    ids=str,
)
def test_both_sides_are_real_at_a_witness(left: sp.Expr, right: sp.Expr) -> None:
    verdict = judge(left, right)
    assert verdict.verdict == "refuted"
    [line] = verdict.lines
    assert line.sides is not None and line.witness is not None
    for side, between in zip((left, right), line.sides, strict=True):
        value = sp.N(side.subs(line.witness), 30)
        assert value.is_real and between is not None
        assert [float(end) for end in between] == pytest.approx([float(value)] * 2)


@pytest.mark.parametrize(
    ("left", "right", "verdict"),
    [
        (sqrt(-(x**2) - 1), 2 * sqrt(-(x**2) - 1), "refuted"),  # real nowhere
        (sqrt(-(x**2) - 1), I * sqrt(x**2 + 1), "holds"),
        (cosh(sqrt(x)), 2 * cos(sqrt(-x)), "refuted"),  # its parts are real at x = 0 alone, its sides everywhere
        (sqrt(w**2), 2 * w, "refuted"),
        (sp.exp(I * x), cos(x) - I * sp.sin(x), "refuted"),
    ],
    ids=str,
)
def test_principal_values_are_meant_with_i_with_complex_letters_and_where_nothing_is_real(
    left: sp.Expr, right: sp.Expr, verdict: str
) -> None:
    assert judge(left, right).verdict == verdict
