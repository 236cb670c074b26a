"""Premises are one set: no order and no form changes what is decided; what decides nothing is named; a refutation has a point."""

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.paper import Premise, Series, Verdict, judge
from lagrotor.paper.hypotheses import vanishes_on

I1, I3, J, w, M, m1, m2 = sp.symbols("I_1 I_3 J omega M m_1 m_2", positive=True)
x, y, z, a, b, c, theta = sp.symbols("x y z a b c theta", real=True)


def apart(verdict: Verdict) -> bool:
    """Whether every refuted line has a point at which an enclosure, or an order at which a coefficient, excludes zero."""
    for line in verdict.lines:
        if line.verdict == "refuted" and line.enclosure is not None:
            low, high = line.enclosure
            if not (low > 0 or high < 0) or line.witness is None:
                return False
    return True


HOLD = [
    ((m1 + m2) * x, M * x, {m1 + m2: M}),
    (a**4 - b**4, a**2 - b**2, {a**2 + b**2: 1}),
    (sp.cos(2 * x), 2 * c**2 - 1, {sp.cos(x): c}),
    (sp.sqrt(x**2), x, {x >= 0: True}),
    (sp.sqrt(x**2), -x, [x < 0]),
    (sp.sqrt((a - b) ** 2), a - b, [a >= b]),
    (x, y, [sp.Eq(a * x, a * y), sp.Ne(a, 0)]),
    (x**2 + y**2, 1, [sp.Eq(x, sp.cos(theta)), sp.Eq(y, sp.sin(theta))]),
    (sp.sin(theta) ** 2, 1 - c**2, [sp.Eq(c, sp.cos(theta))]),
    ((a * z - b * c) ** 2 + (a * c + b * z) ** 2, 1, [sp.Eq(a**2 + b**2, 1), sp.Eq(c**2 + z**2, 1)]),
    (sp.sqrt(1 - sp.sin(x) ** 2), sp.cos(x), [x > -sp.pi / 2, x < sp.pi / 2]),
    (sp.acos(sp.cos(x)), 2 * sp.pi - x, [x >= sp.pi, x <= 2 * sp.pi]),
    (sp.cos(z / 2), sp.sqrt((1 + x) / 2), [sp.Eq(z, sp.acos(x))]),
    (x * y, sp.sqrt(2) * y, [sp.Eq(x**2, 2), x > 0]),
    (x * z, y * z, [sp.Eq(x**2, y**2), x > 0, y > 0]),
    (y, z, [sp.Eq(x * y, x * z), x > 1]),
]
# Lines whose answers are true with "undecided" in the place of what holds or is refuted.
F = sp.Function("F")
HARD = [
    (sp.sqrt(x**2), -x, [x >= 0, sp.Ne(x, 0)], "refuted"),
    (x / y, 1, [sp.Eq(x, y), sp.Eq(y, 0)], "undecided"),
    (x, y, [sp.Eq(x, y), sp.Eq(y, x)], "undecided"),
    (sp.log(x * y), sp.log(x) + sp.log(y), [x < 0, y < 0], "refuted"),
    (sp.sqrt(x * y), sp.sqrt(x) * sp.sqrt(y), [x < 0, y < 0], "refuted"),
    (sp.atan(sp.tan(x)), x, [x > sp.pi / 2, x < sp.pi], "refuted"),
    (x**3, 1, [sp.Eq(x, 1), x > 2], "undecided"),
    (F(x), F(y), [sp.Eq(x, y)], "holds-if"),
    (F(x), F(y), [sp.Eq(x**2, y**2)], "refuted"),
    (x**2 + x, 0, [sp.Eq(x * (x + 1), 0)], "undecided"),
    (sp.exp(x), sp.exp(y), [sp.Eq(x - y, 2 * sp.pi * sp.I)], "holds-if"),
]


@pytest.mark.parametrize(("printed", "derived", "premises", "answer"), HARD)
def test_a_hard_answer_is_true_whatever_the_order_and_the_form(printed, derived, premises, answer) -> None:
    turned = [sp.Eq(each.rhs, each.lhs) if isinstance(each, sp.Eq) else each for each in reversed(premises)]
    (seen,) = {judge(printed, derived, premises=given).verdict for given in (premises, turned)}
    assert seen in (answer, "undecided")


@pytest.mark.parametrize(("printed", "derived", "premises"), HOLD)
def test_a_true_line_holds_under_its_premises_and_a_false_twin_is_refuted(printed, derived, premises) -> None:
    held = judge(printed, derived, premises=premises)
    assert held.verdict == "holds-if", held.evidence
    for twin in (printed + sp.Rational(1, 1000), 2 * printed, printed * (1 + a**2)):
        wrong = judge(twin, derived, premises=premises)
        assert wrong.verdict in ("refuted", "undecided") and apart(wrong)
    assert judge(printed + sp.Rational(1, 10**20) * (1 + x**2), derived, premises=premises).verdict != "holds-if"
    alone = judge(printed, derived)
    assert alone.verdict != "holds" and apart(alone)


def test_a_refuting_point_satisfies_the_premises() -> None:
    wrong = judge(a**4 - b**4, a**2 - 2 * b**2, premises=sp.Eq(a**2 + b**2, 1))
    point = {s: (v[0] + v[1]) / 2 if isinstance(v, tuple) else v for s, v in wrong.lines[0].witness.items()}
    assert abs(float((a**2 + b**2 - 1).xreplace(point))) < 1e-15
    assert abs(float((a**4 - b**4 - a**2 + 2 * b**2).xreplace(point)) - float(wrong.lines[0].enclosure[0])) < 1e-12


def forms(left: sp.Expr, right: sp.Expr) -> list[object]:
    return [
        sp.Eq(left, right),
        sp.Eq(right, left),
        sp.Eq(3 * left - 3 * right, 0),
        {left: right},
        Premise("in words", {left: right}),
        Premise("in words", where=(sp.Eq(left, right),)),
        [sp.Eq(left, right), sp.Eq(right, left)],
    ]


p, q, r, s, t = letters = sp.symbols("p q r s t", positive=True)
EQUATIONS = [(p, q), (q, r + s), (s, 2 * t), (r, t), (p + q, 6 * t)]
LINES = [
    (p * x, 3 * t * x),
    (q * x, 3 * t * x),
    (p * x, q * x + 1),
    (sp.sqrt(p**2) * x, (r + s) * x),
    (p * x, 3 * s * x),
]
LINES = [
    (left + sum(letters), right + sum(letters)) for left, right in LINES
]  # each premise touches a letter of each line


@settings(max_examples=60)
@given(st.data())
def test_order_and_form_of_premises_do_not_change_the_verdict(data: st.DataObject) -> None:
    chosen = data.draw(st.lists(st.sampled_from(EQUATIONS), unique=True, max_size=5))
    line = data.draw(st.sampled_from(LINES))
    plain = judge(*line, premises=[sp.Eq(*pair) for pair in chosen])
    shuffled = data.draw(st.permutations(chosen))
    other = judge(*line, premises=[data.draw(st.sampled_from(forms(*pair))) for pair in shuffled])
    assert plain.verdict == other.verdict
    assert apart(plain) and apart(other)


@settings(max_examples=40)
@given(st.lists(st.sampled_from(EQUATIONS), unique=True, max_size=5), st.sampled_from(LINES))
def test_of_the_premises_that_are_named_none_can_be_left_out(chosen: list, line: tuple) -> None:
    found = judge(*line, premises=[sp.Eq(*pair) for pair in chosen])
    if found.verdict == "holds-if":
        assert judge(*line, premises=found.premises).verdict == "holds-if"
        for left_out in found.premises:
            rest = [premise for premise in found.premises if premise is not left_out]
            assert judge(*line, premises=rest).verdict not in ("holds", "holds-if")


@pytest.mark.parametrize(
    "premises",
    [
        [sp.Eq(a, 1), sp.Eq(a, 2)],
        [sp.Eq(a, 1), sp.Eq(b, a), sp.Eq(b, 2)],
        [x >= 1, x <= 0],
        [x > y, y > z, z > x],
        {w: -1},
        {m1: -m2},
        [sp.Eq(m1, -m2)],
        [sp.Eq(a**2 + b**2, -1)],
        [sp.Eq(a**2, 1), sp.Eq(a**2, 2)],
        [sp.Eq(m1, m2), sp.Ne(m1, m2)],
        [sp.Eq(sp.sin(theta), 2)],
        [sp.Eq(sp.sqrt(w), -1)],
        [x * y > 0, x * y < 0],
        [x > 0, y > 0, x * y < 0],
        [sp.Eq(x**2 + x + 1, 0)],
        [sp.cos(theta) > 0, theta > sp.pi / 2, theta < sp.pi],
        [Premise("small z", small=z), sp.Eq(z, 3)],
    ],
)
def test_contradictory_premises_are_named_and_decide_nothing(premises: object) -> None:
    touched = a + b + x + y + z + theta + w + m1 + m2
    for left, right in ((x, y), (a * x, a * y), (x, x + 1)):
        decided = judge(left + touched, right + touched, premises=premises)
        assert decided.verdict == "undecided" and "contradict" in decided.evidence[0]
    assert judge(touched, touched, premises=premises).verdict == "holds"


@pytest.mark.parametrize(
    "premises",
    [
        [sp.Eq(sp.sin(theta), sp.Rational(1, 2))],
        [x * y > 0, x < 0],
        [sp.Eq(x**2 + x - 1, 0)],
        [sp.cos(theta) < 0, theta > sp.pi / 2, theta < sp.pi],
        [x**3 < 0],
    ],
)
def test_premises_that_can_hold_are_not_called_contradictory(premises: object) -> None:
    touched = a * z + x + y + theta
    assert "contradict" not in str(judge(touched, touched + 1, premises=premises).evidence)


def test_principal_values_refute_where_nothing_is_real() -> None:
    assert judge(sp.log(x**2), 2 * sp.log(x), premises=[x < 0]).verdict == "refuted"
    assert judge(sp.log(x**2), 2 * sp.log(-x), premises=[x < 0]).verdict == "holds-if"


def test_premises_that_leave_no_domain_are_named() -> None:
    decided = judge(1 / sp.sin(theta), x, premises={sp.sin(theta): 0})
    assert decided.verdict == "undecided" and "contradict" in decided.evidence[0]
    assert judge(1 / a, x, premises={a: 0}).verdict == "undecided"


def test_trivial_and_circular_premises_are_named_and_decide_nothing() -> None:
    for decided, word in (
        (judge(x * y, 2 * x * y, premises={x: 0}), "trivial"),
        (judge(a, b, premises=sp.Eq(b, a)), "circular"),
    ):
        assert decided.verdict == "undecided" and decided.evidence[0].startswith(word) and decided.premises == ()
    assert judge(2 * a, 2 * b, premises={a: b}).verdict == "undecided"
    assert judge(x * a, x * b, premises={a: b}).verdict == "holds-if", "x may be anything"
    both = judge(x * w, x, premises=[sp.Eq(x, 0), sp.Eq(w, 1)])
    assert [premise.says for premise in both.premises] == ["ω = 1"], "not the one under which both sides are 0"


@pytest.mark.parametrize(
    ("printed", "derived", "branch"),
    [
        (sp.sqrt(x**2), x, "x ≥ 0"),
        (sp.sqrt(x**2), -x, "x ≤ 0"),
        (abs(a - b), b - a, "a − b ≤ 0"),
        (sp.sqrt(x**2) * y, x * y, "x ≥ 0"),
    ],
)
def test_what_is_true_on_a_branch_holds_if_with_the_branch(printed: sp.Expr, derived: sp.Expr, branch: str) -> None:
    decided = judge(printed, derived)
    assert (decided.verdict, decided.condition) == ("holds-if", branch)
    assert judge(printed, derived + 1).verdict in ("refuted", "undecided")


def test_holds_to_order_is_never_vacuous() -> None:
    wrong = judge(1000 * y * sp.sin(b), a * y, small=y)
    assert wrong.verdict == "refuted" and "both sides vanish through order 0" in wrong.evidence[0]
    assert judge(y**9, 2 * y**9, small=y).verdict == "undecided"
    near = judge(y, sp.sin(y), small=y)
    assert (near.verdict, near.order) == ("holds-to-order", 2)


def test_a_series_holds_to_its_order_at_most() -> None:
    known = Series(x - x**3 / 6, x, 3)
    exact = judge(x - x**3 / 6, known)
    assert (exact.verdict, exact.order) == ("holds-to-order", 3)
    assert judge(sp.sin(x), known).order == 3
    assert judge(sp.sin(x), known, small=x, order=5).verdict == "undecided", "what was derived ends before"
    assert judge(x - x**3 / 5, known, small=x, order=3).verdict == "refuted"


def test_each_line_has_its_verdict_and_the_weakest_is_the_equations() -> None:
    wrong = judge(sp.Matrix([x, y]), sp.Matrix([x, 2 * y]))
    (line,) = wrong.lines
    assert (line.verdict, line.place, line.difference) == ("refuted", (1, 0), -y)
    assert set(line.witness) == {y} and apart(wrong)


def test_membership_in_an_ideal_and_its_radical() -> None:
    assert vanishes_on(a - b, [(a - b) ** 2]) == "zero"
    assert vanishes_on(a - 1, [x * a - x], [x]) == "zero"
    assert vanishes_on(a - 1, [x * a - x]) == "nonzero"
    assert vanishes_on(x, [a**2 - 1, a**2 - 2]) == "nowhere"


@pytest.mark.parametrize("sign", [y > 0, y < 0])
def test_a_small_quantity_of_one_sign_stays_small(sign: sp.Basic) -> None:
    near = judge(sp.sin(y), y, premises=[sign], small=y, order=1)
    assert (near.verdict, near.order) == ("holds-to-order", 2)
    assert judge(sp.sin(y), 2 * y, premises=[sign], small=y, order=1).verdict == "refuted"
    root = y if sign == (y > 0) else -y
    assert judge(sp.sqrt(y**2 + y**4), root, premises=[sign], small=y, order=1).verdict in (
        "holds-if",
        "holds-to-order",
    )
    assert judge(sp.sqrt(y**2 + y**4), -root, premises=[sign], small=y, order=1).verdict == "refuted"


def test_coefficients_of_a_series_are_compared_where_the_equations_hold() -> None:
    squares = sp.Eq(a**2, b**2)
    near = judge(sp.cos(a * y), 1 - b**2 * y**2 / 2, premises=squares, small=y, order=2)
    assert near.verdict == "holds-to-order" and near.condition is not None and "a² = b²" in near.condition
    wrong = judge(sp.cos(a * y), 1 - b**2 * y**2 / 2, premises=sp.Eq(a**2, 2 * b**2), small=y, order=2)
    assert wrong.verdict == "refuted"
    # What the equations make zero leads nothing: without them both sides would seem to share a leading term.
    vacuous = judge(a**2 - b**2 + y**7, a**2 - b**2 + c * y**7, premises=squares, small=y, order=1)
    assert vacuous.verdict != "refuted" and "both sides vanish" in vacuous.evidence[0]
    # Two inequalities may leave one value only, at which the coefficient is zero.
    assert judge(sp.sin(x * y) + a, a, premises=[x >= 0, x <= 0], small=y, order=1).verdict != "refuted"
    assert judge(sp.sin(x * y) + a, a, premises=[x >= 1, x <= 2], small=y, order=1).verdict == "refuted"


def test_a_branch_has_a_point_inside() -> None:
    e = sp.Abs(1 - x**2)
    assert judge(e, x**2 - 1, premises=[x >= -1, x <= 1]).verdict in ("refuted", "undecided")
    assert judge(e, x**2 - 1, premises=[x >= -1, x <= 2]).verdict == "holds-if"


def test_a_function_s_equation_may_fix_its_derivative() -> None:
    t, f = sp.Symbol("t", real=True), sp.Function("f")
    rate = f(t).diff(t)
    assert judge(rate + a, a, premises=sp.Eq(f(t), b)).verdict == "undecided"
    assert judge(rate, sp.cos(t), premises=sp.Eq(f(t), sp.sin(t))).verdict != "refuted"
    assert judge(rate + c, c, premises=sp.Eq(c, b)).verdict == "refuted"
    assert judge(rate**2, b, premises=sp.Eq(rate, b)).verdict == "refuted"


def test_what_is_bound_stays_bound() -> None:
    assert judge(sp.Integral(x, (x, 0, 1)), x / 2, premises=sp.Eq(x, 1)).verdict == "holds-if"
    assert judge(sp.Integral(x, (x, 0, 1)), x, premises=sp.Eq(x, 1)).verdict in ("refuted", "undecided")
    assert judge(sp.Derivative(x**2, x), sp.Integer(5), premises=sp.Eq(x, 3)).verdict in ("refuted", "undecided")
    assert judge(sp.Derivative(x**2, x), sp.Integer(6), premises=sp.Eq(x, 3)).verdict not in ("refuted",)
