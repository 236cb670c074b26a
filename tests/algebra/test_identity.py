"""The decision of identities: textbook ones hold, their mutated twins do not, and the rest stays undecided."""

import re
from collections.abc import Callable

import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sympy import cos, cosh, cot, coth, csc, csch, exp, pi, sec, sech, sin, sinh, sqrt, tan, tanh

from lagrotor.algebra import decide_equal, decide_zero, normal_form
from lagrotor.algebra.signs import Region
from lagrotor.algebra.translation import Translation, prove_zero
from lagrotor.errors import InputError, NotExactError

x, y, omega, t = sp.symbols("x y omega t")
m = sp.Symbol("m", positive=True)

IDENTITIES = [
    (sin(x) ** 2 + cos(x) ** 2, 1),
    (tan(x / 2), sin(x) / (1 + cos(x))),
    (cos(x / 3) ** 3, (cos(x) + 3 * cos(x / 3)) / 4),
    (cos(5 * x), 16 * cos(x) ** 5 - 20 * cos(x) ** 3 + 5 * cos(x)),
    (sin(x + y), sin(x) * cos(y) + cos(x) * sin(y)),
    (sin(x) * sin(y), (cos(x - y) - cos(x + y)) / 2),
    (tan(x + y), (tan(x) + tan(y)) / (1 - tan(x) * tan(y))),
    (csc(x), cot(x / 2) - cot(x)),
    (sin(x + pi / 4), (sin(x) + cos(x)) / sqrt(2)),
    (cos(x + pi / 3) + cos(x - pi / 3), cos(x)),
    (sin(x + pi / 12), sin(x) * (sqrt(6) + sqrt(2)) / 4 + cos(x) * (sqrt(6) - sqrt(2)) / 4),
    (sin(omega * t + x), sin(omega * t) * cos(x) + cos(omega * t) * sin(x)),
    (cosh(x) ** 2 - sinh(x) ** 2, 1),
    (tanh(x + y), (tanh(x) + tanh(y)) / (1 + tanh(x) * tanh(y))),
    (coth(x) ** 2 - csch(x) ** 2, tanh(x) ** 2 + sech(x) ** 2),
    (exp(x), cosh(x) + sinh(x)),
    ((exp(x) - exp(-x)) / (exp(x) + exp(-x)), tanh(x)),
    (1 / (sqrt(2) - 1), 1 + sqrt(2)),
    ((cos(x) + sp.I * sin(x)) ** 2, cos(2 * x) + sp.I * sin(2 * x)),
]


@pytest.mark.parametrize(("left", "right"), IDENTITIES)
def test_a_textbook_identity_is_zero_and_its_mutated_twin_is_not(left: sp.Expr, right: sp.Expr) -> None:
    assert decide_equal(left, right).answer == "zero"
    difference = left - right * sp.Rational(1000, 1001)
    decision = decide_zero(difference)
    assert decision.answer == "nonzero" and decision.witness is not None
    value = abs(difference.subs(decision.witness).evalf(30))
    assert value > 0 and float(value) == pytest.approx(decision.evidence)


@pytest.mark.parametrize(
    ("expression", "domain"),
    [
        (tan(2 * x) - 2 * tan(x) / (1 - tan(x) ** 2), {cos(x), cos(2 * x)}),
        (1 / (1 - cos(x) ** 2) - csc(x) ** 2, {sin(x)}),
        (1 / (1 + cos(x)) - 1 / (1 + cos(x)), set()),
        (tan(x / 2) - sin(x) / (1 + cos(x)), {cos(x / 2)}),
        ((x**2 - y**2) / (x**2 * y - y**3) - 1 / y, {y, x - y, x + y}),
        (1 / (m + m * x) - 1 / (m * (x + 1)), {m, x + 1}),
        ((sqrt(2) - 1) * (sqrt(2) + 1) - 1 / (3 - 2 * sqrt(2)) / (3 + 2 * sqrt(2)), set()),
    ],
)
def test_domain(expression: sp.Expr, domain: set[sp.Expr]) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "zero"
    assert set(decision.domain) == domain


@pytest.mark.parametrize(
    ("expression", "reason"),
    [
        (sqrt(1 + sp.zoo * x), "outside"),
        (sp.Symbol("A", commutative=False), "outside"),
        (0.5 * x, "floating-point number 0.5"),
        (sqrt(x) * sin(0.25 * x), "floating-point number 0.25"),
        (sp.Symbol("u", infinite=True) - x, "must commute and be finite"),
        (sin(2 * sp.Symbol("A", commutative=False)), "must commute and be finite"),
        (x + sp.Symbol("z", zero=True) ** -1, "outside"),
        (sp.Pow(sp.Pow(0, sp.S.Half, evaluate=False), -3, evaluate=False), "vanishes identically"),
        (1 / (sin(x) ** 2 + cos(x) ** 2 - 1), "denominator vanishes identically"),
    ],
)
def test_undecided(expression: sp.Expr, reason: str) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "undecided"
    assert reason in decision.reason
    with pytest.raises(NotExactError, match=reason):
        normal_form(expression)


@pytest.mark.parametrize(
    "expression",
    [
        *(sp.cbrt(x) - x, sqrt(sqrt(x) + 1), sqrt(sin(x)), sqrt(sp.Add(2, sqrt(3), evaluate=False)), sp.log(x), x**y),
        *(sp.Function("f")(x), sp.Function("f")(x).diff(x), sin(1), sin(sqrt(2) * x), sinh(x + pi), cos(x + pi / 7)),
        cos(pi * sp.Symbol("n", integer=True) / 2),
    ],
)
def test_what_has_no_normal_form_is_refuted_at_a_point(expression: sp.Expr) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "nonzero" and decision.witness is not None
    assert decision.evidence is not None and decision.evidence > 1e-3
    with pytest.raises(NotExactError):
        normal_form(expression)


def test_undecided_carries_numeric_evidence() -> None:
    holds = decide_zero(sqrt((x**2 + 1) ** 2) - x**2 - 1)
    assert holds.answer == "undecided" and holds.evidence is not None and holds.evidence < 1e-30
    assert decide_zero(1 / (sin(x) ** 2 + cos(x) ** 2 - 1)).evidence is None
    for without in (exp(exp(exp(10**6 * m))), sp.Integral(sp.Function("f")(x) * x, (x, 0, y))):
        assert decide_zero(without).evidence is None


@pytest.mark.parametrize("given", [None, "x", True, object(), [1], sp.Eq(x, 1), sp.Interval(0, 1), sp.eye(2), (x,)])
def test_what_is_no_scalar_expression_is_named(given: object) -> None:
    for function in (decide_zero, normal_form, lambda e: decide_equal(e, x), lambda e: decide_equal(1, e)):
        with pytest.raises(InputError, match=r"decide_zero|decide_equal|normal_form"):
            function(given)


ONE_NAME = [
    sp.Symbol("x", **{kind: True}) for kind in ("real", "positive", "even", "odd", "integer", "finite", "prime")
]


@pytest.mark.parametrize("other", [*ONE_NAME, sp.Symbol("x", extended_real=True)])
def test_two_symbols_of_one_name_are_refused(other: sp.Symbol) -> None:
    for function in (lambda: decide_zero(x - other), lambda: decide_equal(x, other), lambda: normal_form(x * other)):
        with pytest.raises(InputError, match="two different symbols are called 'x', one declared"):
            function()


def test_dummies_of_one_name_are_two_symbols() -> None:
    other = sp.Dummy("x")
    assert decide_zero(x - other).answer == "nonzero"
    assert decide_zero((x + other) ** 2 - x**2 - 2 * x * other - other**2).answer == "zero"
    assert decide_zero(sqrt(x + other) ** 2 - x - other).answer == "zero"


@pytest.mark.parametrize("name", ["pi", "I", "E", "g0", "zero", "gens", "sin(x)", "sqrt(2)", "exp", "lambda", ""])
def test_a_symbol_may_have_any_name(name: str) -> None:
    symbol = sp.Symbol(name)
    for other in (pi, sp.I, sp.Integer(1), sin(x), sqrt(2)):
        decision = decide_zero(symbol - other)
        assert decision.answer == "nonzero"
        assert decision.evidence is not None and decision.evidence > 0
    assert decide_zero(sin(2 * symbol) * exp(symbol) - 2 * sin(symbol) * cos(symbol) * exp(symbol)).answer == "zero"


def test_a_symbol_that_is_zero_is_zero() -> None:
    for null in (sp.Symbol("z", zero=True), sp.Symbol("z", nonnegative=True, nonpositive=True)):
        assert decide_zero(null).answer == decide_zero(x * null + sin(null) * cos(x)).answer == "zero"
        assert decide_zero(cos(null + x) - cos(x)).answer == "zero"
        assert decide_zero(null + x).answer == "nonzero"


def test_what_sympy_has_not_evaluated_is_read_as_it_stands() -> None:
    def raw(kind: type[sp.Expr], *parts: sp.Expr) -> sp.Expr:
        return kind(*parts, evaluate=False)

    assert decide_zero(raw(sp.Pow, sp.S.Zero, sp.S.Half)).answer == "zero"
    assert decide_zero(raw(sp.Pow, sp.S.Zero, sp.S.Zero) - 1).answer == "zero"
    assert decide_equal(sin(raw(sp.Add, x, x)), 2 * sin(x) * cos(x)).answer == "zero"
    assert decide_equal(sin(raw(sp.Add, x, x)), sin(x)).answer == "nonzero"
    assert decide_equal(raw(exp, sp.S.Zero), 1).answer == "zero"
    assert decide_equal(raw(cos, 7 * pi / 3), sp.Rational(1, 2)).answer == "zero"
    assert decide_zero(raw(tan, pi / 2)).answer == "undecided"


def test_large_multiples_of_an_angle_are_decided() -> None:
    for n in (11, 12, 13, 24, 25, 1000, 10**12):
        assert decide_equal(sin(n * x), 2 * sin(n * x / 2) * cos(n * x / 2)).answer == "zero"
        assert decide_equal(sinh(n * x), 2 * sinh(n * x / 2) * cosh(n * x / 2)).answer == "zero"
        assert (
            decide_equal(tan(n * x) * cos(n * x) + exp(n * y), sin(n * x) + cosh(n * y) + sinh(n * y)).answer == "zero"
        )
        assert decide_equal(cos(n * x + y), cos(n * x) * cos(y) - sin(n * x) * sin(y)).answer == "zero"
        assert decide_equal(cos(n * x + y), cos(n * x) * cos(y) + sin(n * x) * sin(y)).answer == "nonzero"
        assert decide_equal(sec(n * x) ** 2 - tan(n * x) ** 2, coth(n * x) ** 2 - csch(n * x) ** 2).answer == "zero"
    assert decide_zero(2 * sinh(501 * x / 1000) * cosh(501 * x / 1000) - sinh(501 * x / 500)).answer == "zero"
    assert decide_zero(tan(40 * x) - sin(40 * x) / cos(40 * x)).domain == (cos(40 * x),)
    assert (
        decide_equal(sum(cos(k * x) for k in range(1, 25)), sin(12 * x) * cos(25 * x / 2) / sin(x / 2)).answer == "zero"
    )


@pytest.mark.parametrize(
    "expression",
    [
        (x + y + m + 1) ** 400 - x,
        (x + 1) ** (10**9) - x,
        sin(x) ** (10**8) - x,
        pytest.param(sp.prod(x + k * y + k**2 * m + 1 for k in range(40)) - 1, marks=pytest.mark.slow),
        sp.Pow(3, 10**12, evaluate=False),
        sp.Pow(sp.Rational(2, 3), 10**12, evaluate=False),
        sp.prod(sin(sp.Symbol(f"x_{k}") + sp.Symbol(f"y_{k}")) for k in range(30)),
    ],
)
def test_what_takes_too_much_work_is_refuted_at_a_point_or_undecided(expression: sp.Expr) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "nonzero" or "takes more than" in decision.reason
    with pytest.raises(NotExactError, match="takes more than"):
        normal_form(expression)


def test_angles_of_different_monomials_are_independent() -> None:
    for other in (x**2 / 2, x**2, 1 / x, x * y, pi * x, pi**2 * x, x**2 * y):
        assert decide_equal(sin(other) ** 2, 1 - cos(x) ** 2).answer == "nonzero"
        assert decide_equal(sin(other) ** 2, 1 - cos(other) ** 2).answer == "zero"
        assert normal_form(sin(other)) == sin(other)


def test_arguments_and_depth_are_bounded() -> None:
    with pytest.raises(NotExactError, match="more than 200 terms"):
        normal_form(sin((x + y + m + 1) ** 50))
    assert decide_zero(sin((x + y + m + 1) ** 50)).answer == "nonzero"
    deep = x
    for _ in range(1000):
        deep = sp.Pow(sp.Add(deep, 1, evaluate=False), 2, evaluate=False)
    for decision in (decide_zero(deep), decide_equal(deep, 1)):
        assert decision.answer == "undecided" and "nested" in decision.reason
    with pytest.raises(NotExactError, match="nested"):
        normal_form(deep)
    shared, few = x, x
    for step in range(60):
        shared = sp.Mul(sp.Add(shared, 1, evaluate=False), sp.Add(shared, 2, evaluate=False), evaluate=False)
        few = few if step > 13 else sp.log(few) + sp.cbrt(few)
    assert "more than 1,000,000 parts" in decide_zero(shared).reason
    assert decide_zero(few).evidence is not None  # 2**14 equal parts are evaluated once
    assert decide_equal(sin((x + y) ** 2), sin(x**2 + y**2 + 2 * x * y)).answer == "zero"
    assert decide_equal(sin((x + y) ** 2 / x), sin(x + y**2 / x + y)).answer == "nonzero"


def test_constants() -> None:
    assert decide_zero(sp.Integer(0)).answer == "zero"
    assert decide_zero(sqrt(2) - sp.Rational(577, 408)).answer == "nonzero"
    assert decide_zero(cos(pi / 5) - (1 + sqrt(5)) / 4).answer == "zero"


def test_matrices() -> None:
    turn = sp.Matrix([[cos(x), -sin(x)], [sin(x), cos(x)]])
    assert decide_equal(turn * turn.T, sp.eye(2)).answer == "zero"
    assert decide_equal(turn * turn, turn.subs(x, 2 * x)).answer == "zero"
    off = decide_equal(turn * turn.T, sp.Matrix([[1, 0], [0, 1 + x]]))
    assert off.answer == "nonzero"
    assert off.reason.startswith("Entry (2, 2)")
    assert decide_equal(sp.Matrix([sp.airyai(x), 0]), sp.Matrix([1, 0])).answer == "undecided"
    assert decide_equal(sp.Matrix([sp.log(x), 1]), sp.Matrix([1, 0])).answer == "nonzero"
    assert decide_equal(sp.Matrix([1 / x, tan(y)]), sp.Matrix([1 / x, sin(y) / cos(y)])).domain == (cos(y),)
    for other in (sp.eye(3), sp.Integer(1)):
        with pytest.raises(InputError, match="cannot be compared"):
            decide_equal(turn, other)


@pytest.mark.parametrize(
    ("expression", "form"),
    [
        (sin(3 * x), 4 * sin(x) * cos(x) ** 2 - sin(x)),
        (1 / (1 + sin(x)), (1 - sin(x)) / cos(x) ** 2),
        ((x**2 - 1) / (x - 1), x + 1),
        (1 / sqrt(2) + 1 / (1 + sqrt(2)), (3 * sqrt(2) - 2) / 2),
        (sin(x) ** 2 + cos(x) ** 2 - 1, 0),
    ],
)
def test_normal_form(expression: sp.Expr, form: sp.Expr) -> None:
    assert sp.expand(normal_form(expression) - form) == 0


ATOMS = st.sampled_from(
    [
        *(x, y, m, sp.Integer(2), sp.Rational(-1, 3), sin(x), cos(x), tan(y), sec(x)),
        *(sin(x - y), cos(2 * y), sinh(x), cosh(x + y), sin(x + pi / 6)),
    ]
)


def combine(parts: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    return st.one_of(
        st.builds(sp.Add, parts, parts),
        st.builds(sp.Mul, parts, parts),
        st.builds(sp.Pow, parts, st.sampled_from([2, -1])),
    )


EXPRESSIONS = st.recursive(ATOMS, combine, max_leaves=5)


def within_bounds(form: Callable[[sp.Expr], sp.Expr], expression: sp.Expr) -> sp.Expr:
    """The form, or another example where it is refused for the work it would take."""
    try:
        return form(expression)
    except NotExactError as refusal:
        assume(not re.search("too large|products of terms", str(refusal)))
        raise


def rewritten(expression: sp.Expr) -> sp.Expr:
    """The same function in other words: tan as sin/cos, angles expanded, products multiplied out."""
    return sp.expand_trig(sp.expand(expression)).rewrite([tan, sec], cos)


@settings(max_examples=60, deadline=None)
@given(EXPRESSIONS, st.fractions(min_value=1, max_value=2, max_denominator=10**6))
def test_random_expressions(expression: sp.Expr, ratio: object) -> None:
    assume(not expression.has(sp.zoo, sp.nan) and decide_zero(expression).answer == "nonzero")
    twin = rewritten(expression)
    same = decide_equal(expression, twin)
    assume("products of terms" not in same.reason)
    assert same.answer == "zero"
    assert decide_equal(expression, twin + sp.Rational(ratio) / 10**9).answer == "nonzero"


@settings(max_examples=40, deadline=None)
@given(EXPRESSIONS)
def test_normal_form_is_unique_and_idempotent(expression: sp.Expr) -> None:
    assume(not expression.has(sp.zoo, sp.nan) and decide_zero(expression).answer != "undecided")
    form = within_bounds(normal_form, expression)
    assert normal_form(form) == form
    assert within_bounds(normal_form, rewritten(expression)) == form
    assert decide_equal(form, expression).answer == "zero"


def test_a_large_divisor_stands_in_the_domain_unfactored() -> None:
    """Factors of a small one are told apart; those of a large one might take hours, and the decision does not need them."""
    small, large = (x + y) * (x - y + 1), (x + y + m + 1) ** 3 * (x * y - m + 2) ** 3
    assert len(decide_equal(1 / sp.expand(small), 1 / small).domain) == 2
    found = decide_equal(1 / sp.expand(large), 1 / sp.expand(large) + x - x)
    assert decide_zero(1 / sp.expand(large) - 1 / large).answer == "zero"
    assert [sp.Poly(factor).total_degree() for factor in decide_zero(1 / sp.expand(large + 1)).domain] == [9]
    assert found.answer == "zero"


def test_a_sign_that_no_real_letter_has_is_no_branch() -> None:
    b, c, s, v, x = sp.symbols("b c s v x", real=True)
    power = (v * sp.Abs(x)) ** (s * sp.sqrt(1 - b))
    assert decide_equal(power, c * sp.sqrt(1 - b) / sp.Abs(x)).answer == "nonzero"
    assert decide_equal(power, (sp.Abs(x) * v) ** (s * sp.sqrt(1 - b))).answer == "zero"
    assert decide_equal(sp.sqrt(x**2), x).branch == (x >= 0,)


HALVES = -2 * sin(x / 2) * cos(x / 2)


@pytest.mark.parametrize(("terms", "passes"), [((HALVES, sin(x)), 1), ((sin(x), HALVES), 2)])
def test_a_second_pass_is_made_only_if_a_later_term_divides_an_angle(
    terms: tuple[sp.Expr, ...], passes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[object] = []
    begin = Translation.__init__
    monkeypatch.setattr(Translation, "__init__", lambda self, *given: begun.append(self) or begin(self, *given))
    divisors, _ = prove_zero(sp.Add(*terms, evaluate=False), Region())
    assert divisors is not None
    assert len(begun) == passes
