"""Intervals at a point: they hold the solution of a linear system, and tell neighbours apart."""

import pytest
import sympy as sp

from lagrotor.algebra.enclosures import apart, solved_at
from lagrotor.errors import NotExactError

x, y = sp.symbols("x y", real=True)
POINT = {x: sp.Rational(3, 7), y: sp.Rational(-5, 3)}
A = sp.Matrix([[sp.cos(x) + 2, sp.tan(y) * sp.sqrt(x)], [sp.exp(x) / 3, sp.cosh(y) ** 2 + sp.pi]])
B = sp.Matrix([sp.sinh(x * y), 1 / sp.sin(y) + sp.tanh(x)])


def test_an_enclosure_holds_the_solution_and_nothing_far_from_it() -> None:
    truth = A.subs(POINT).evalf(60).LUsolve(B.subs(POINT).evalf(60))
    for found, value in zip(solved_at(A, B, POINT), truth, strict=True):
        low, high = (sp.Float(str(end).strip("[]").split(",")[0], 60) for end in (found.a, found.b))
        assert abs(low - value) < 1e-16 and abs(high - value) < 1e-16
        assert found.delta < 1e-45


def test_neighbours_are_apart_and_the_same_is_not() -> None:
    one = solved_at(A, B, POINT)
    assert apart(one, solved_at(2 * A, 2 * B, POINT)) is None
    assert apart(one, solved_at(A, B + sp.Matrix([0, sp.Rational(1, 10**40)]), POINT)) == 0


@pytest.mark.parametrize("entry", [sp.Symbol("z"), sp.airyai(x), sp.Float(0.1), sp.log(y), y ** sp.Rational(1, 3)])
def test_what_has_no_enclosure_is_refused(entry: sp.Expr) -> None:
    with pytest.raises(NotExactError, match="enclosed"):
        solved_at(sp.eye(2), sp.Matrix([entry, 1]), POINT)


def test_a_matrix_not_shown_to_be_regular_is_refused() -> None:
    with pytest.raises(NotExactError, match="regular"):
        solved_at(sp.Matrix([[sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1]]), sp.ones(1, 1), POINT)
