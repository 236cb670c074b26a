"""Hostile premises: whatever their order and form, the answer is one, and never wrong.

Each row holds a line, premises, and the answers that are true of it; "undecided" is never wrong.
"""

from itertools import islice, permutations
from typing import Any

import pytest
from sympy import (
    Abs,
    Eq,
    Function,
    I,
    Integral,
    Ne,
    Sum,
    asin,
    atan,
    cos,
    cosh,
    exp,
    log,
    pi,
    sin,
    sinh,
    sqrt,
    symbols,
    tan,
)

from lagrotor.paper import judge

x, y, z, w = symbols("x y z w", real=True)
a, b, c = symbols("a b c", positive=True)
f = Function("f")

ROWS: list[tuple[Any, Any, list[Any], set[str]]] = [
    (sqrt(x**2), x, [x >= 0, Eq(y, x)], {"holds-if"}),
    (sqrt(x**2), -x, [x >= 0, Ne(x, 0)], {"refuted"}),
    (sin(x), 1, [Eq(x, pi / 2)], {"holds-if"}),
    (x / y, 1, [Eq(x, y), Ne(y, 0)], {"holds-if"}),
    (x / y, 1, [Eq(x, y), Eq(y, 0)], {"undecided"}),
    (x**2 + y**2, 1, [Eq(x, cos(z)), Eq(y, sin(z))], {"holds-if"}),
    (x, y, [Eq(x, y), Eq(y, x)], {"undecided"}),
    (x, y, [Eq(x**2, y**2), x > 0, y > 0], {"holds-if"}),
    (x, y, [Eq(x**2, y**2), x > 0], {"holds-if"}),
    (x * z, y * z, [Eq(x, y), Eq(z, 0)], {"holds-if", "undecided"}),
    (a * b, c, [Eq(a, c / b)], {"holds-if", "undecided"}),
    (log(x * y), log(x) + log(y), [x < 0, y < 0], {"refuted", "undecided"}),
    (log(x * y), log(x) + log(y), [x > 0, y > 0], {"holds-if"}),
    (sqrt(x * y), sqrt(x) * sqrt(y), [x < 0, y < 0], {"refuted"}),
    (Abs(x - y), x - y, [x >= y], {"holds-if"}),
    (Abs(x - y), y - x, [x >= y, Ne(x, y)], {"refuted"}),
    (atan(tan(x)), x, [x > -pi / 2, x < pi / 2], {"holds-if", "undecided"}),
    (atan(tan(x)), x, [x > pi / 2, x < pi], {"refuted", "undecided"}),
    (asin(sin(x)), pi - x, [x > pi / 2, x < 3 * pi / 2], {"holds-if", "undecided"}),
    (x, 1, [Eq(a, -1)], {"undecided"}),
    (x**3, 1, [Eq(x, 1), x > 2], {"undecided"}),
    (f(x), f(y), [Eq(x, y)], {"holds-if"}),
    (f(x), f(y), [Eq(f(x), f(y))], {"undecided"}),
    (f(x), f(y), [Eq(x**2, y**2)], {"undecided", "refuted"}),
    (Integral(f(w), (w, 0, x)), 0, [Eq(x, 0)], {"holds-if", "undecided"}),
    (Integral(w * y, (w, 0, x)), y * x**2 / 2, [Eq(w, 3)], {"holds"}),
    (Sum(x, (w, 1, 3)), 3 * x, [Eq(w, 2)], {"holds"}),
    ((x + y) ** 2, z, [Eq(x + y, 1), Eq(z, 1)], {"holds-if"}),
    (x * y, -1, [Eq(x + y, 0), Eq(x, 1)], {"holds-if"}),
    (x**2 + x, 0, [Eq(x * (x + 1), 0)], {"undecided"}),
    (x**3 + x**2, 0, [Eq(x * (x + 1), 0)], {"holds-if", "undecided"}),
    (a / (b + c), 1, [Eq(a - b, c)], {"holds-if"}),
    (cosh(x), 1, [Eq(sinh(x), 0)], {"holds-if", "undecided"}),
    (exp(x), exp(y), [Eq(x - y, 2 * pi * I)], {"holds-if", "undecided"}),
    (sqrt(1 - sin(x) ** 2), cos(x), [x > -pi / 2, x < pi / 2], {"holds-if"}),
    (sqrt(1 - sin(x) ** 2), -cos(x), [x > pi / 2, x < 3 * pi / 2], {"holds-if", "undecided"}),
    (x**y, 1, [Eq(y, 0), Ne(x, 0)], {"holds-if"}),
    ((-1) ** x, 1, [Eq(x, 2)], {"holds-if"}),
]


@pytest.mark.slow
@pytest.mark.parametrize(("printed", "derived", "premises", "answers"), ROWS, ids=lambda e: str(e)[:30])
def test_the_answer_is_true_and_does_not_depend_on_order_and_form(
    printed: Any, derived: Any, premises: list[Any], answers: set[str]
) -> None:
    seen = set()
    for row in islice(permutations(premises), 6):
        turned = [Eq(each.rhs, each.lhs) if isinstance(each, Eq) else each for each in row]
        seen |= {judge(printed, derived, given=list(form)).verdict for form in (row, turned)}
    assert len(seen) == 1 and seen <= answers, seen


def test_what_holds_on_a_branch_of_its_premises_says_the_branch() -> None:
    verdict = judge(x, y, given=[Eq(x**2, y**2), x > 0])
    assert verdict.verdict == "holds-if" and any(premise.formula == "y ≥ 0" for premise in verdict.premises)
    assert judge(x, y, given=[Eq(x**2, y**2)]).verdict == "refuted"
