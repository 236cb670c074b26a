"""Square roots: which expressions in them vanish, where their signs are known, and where they differ by region."""

import mpmath
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sympy import Abs, I, Rational, S, cos, cosh, exp, pi, sin, sqrt, tan

from lagrotor.algebra import decide_equal, decide_zero, normal_form
from lagrotor.algebra.evidence import points
from lagrotor.errors import NotExactError

x, y, z = sp.symbols("x y z")
r, s = sp.symbols("r s", real=True)
p, q = sp.symbols("p q", positive=True)
neg = sp.Symbol("n", negative=True)
R = sqrt(x**2 + y**2)


def raw(base: sp.Expr, power: sp.Expr = S.Half) -> sp.Expr:
    return sp.Pow(base, power, evaluate=False)


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (1 / (R - x), (R + x) / y**2),
        (sqrt(4 * x + 4 * y), 2 * sqrt(x + y)),
        (sqrt(sp.expand((p + q) ** 2 * x)), (p + q) * sqrt(x)),
        (sqrt(sp.expand(p * (x + y))), sqrt(p) * sqrt(x + y)),
        (sqrt(1 / p + 1), sqrt(1 + p) / sqrt(p)),
        (sqrt(x / (y**2 + p)) * sqrt(x / (y**2 + p)), x / (y**2 + p)),
        (sqrt(sp.expand((r - s) ** 2)) ** 2, (r - s) ** 2),
        (Abs(neg * r), -neg * Abs(r)),
        (sqrt(x) * sin(2 * y) / sqrt(x), 2 * sin(y) * cos(y)),
        (1 / (sqrt(2) + sqrt(3) + sqrt(5)), (2 * sqrt(3) + 3 * sqrt(2) - sqrt(30)) / 12),
        (raw(-12, -S.Half), -I * sqrt(3) / 6),
        (raw(Rational(8, 27)), sqrt(6) * 2 / 9),
        (raw(S(6)) * raw(S(10)), 2 * sqrt(15)),
        (raw(S(7) ** 40 * (10**30 + 57)), 7**20 * raw(S(10**30 + 57))),
        (sqrt(pi * p + pi), sqrt(pi) * sqrt(p + 1)),
        ((1 + sqrt(x)) ** Rational(4, 2) * R ** Rational(2, 1), (1 + 2 * sqrt(x) + x) * (x**2 + y**2)),
    ],
)
def test_an_identity_of_roots_holds_and_its_twin_does_not(left: sp.Expr, right: sp.Expr) -> None:
    assert decide_equal(left, right).answer == "zero"
    twin = decide_equal(left, right * Rational(1000, 1001))
    assert twin.answer == "nonzero" and not twin.partly


@pytest.mark.parametrize(
    "expression",
    [
        sqrt(x**2) - x,
        sqrt(sp.expand((r - s) ** 2)) - r + s,
        sqrt(x * y) - sqrt(x) * sqrt(y),
        sqrt(x - y) - I * sqrt(y - x),
        sqrt(x) * sqrt(x + 1) * sqrt(1 / (x**2 + x)) - 1,
        sqrt(sp.expand((p - q) ** 2)) - p + q,
        cos(x) * (sqrt(x**2 * y) - x * sqrt(y)),
    ],
)
def test_what_holds_only_for_one_sign_of_a_root_is_not_zero(expression: sp.Expr) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "nonzero" and decision.partly
    assert decision.witness is not None
    assert abs(sp.N(expression.subs(decision.witness), 30)) > 1e-6
    with pytest.raises(NotExactError, match="may differ from region to region"):
        normal_form(expression)


def test_what_no_point_settles_stays_undecided() -> None:
    """sqrt((x**2 + 1)**2) is x**2 + 1 for real x, its negative for x = 2*i; nothing is declared of x."""
    decision = decide_zero(sqrt((x**2 + 1) ** 2) - x**2 - 1)
    assert decision.answer == "undecided"
    assert "some signs of sqrt((x**2 + 1)**2)" in decision.reason
    assert decide_zero(sqrt((x**2 + 1) ** 2) - x**2).answer == "nonzero"
    many = sum(sqrt(sp.Symbol(f"x{k}") ** 2) for k in range(4))
    assert decide_zero(many).answer == "nonzero"


def test_the_sign_of_a_product_of_roots_is_that_of_the_assumptions() -> None:
    assert decide_zero(sqrt(neg * x) - sqrt(-neg) * sqrt(-x)).answer == "zero"
    assert decide_zero(sqrt(neg * s**2) - I * sqrt(-neg) * s).partly
    assert decide_zero(sqrt(sp.expand((p + 1) ** 2 * (q + 1))) + (p + 1) * sqrt(q + 1)).answer == "nonzero"


@pytest.mark.parametrize(
    ("expression", "domain"),
    [
        (1 / R - (x + 1) / (R * x + R), {x**2 + y**2, x + 1}),
        (1 / (R - x) - (R + x) / y**2, {y, x - R}),
        ((1 + sqrt(x / y)) ** 2 - 1 - x / y - 2 * sqrt(x / y), {y}),
        (sqrt(p * q) - sqrt(p) * sqrt(q), set()),
    ],
)
def test_domain(expression: sp.Expr, domain: set[sp.Expr]) -> None:
    decision = decide_zero(expression)
    assert decision.answer == "zero"
    assert set(decision.domain) == domain


def test_normal_form_frees_the_denominator_of_roots() -> None:
    assert sp.expand(normal_form(1 / (R - x)) - (R + x) / y**2) == 0
    assert normal_form(sqrt(p * q) * sqrt(p)) == normal_form(p * sqrt(q))
    assert normal_form(sqrt(4 * x) / sqrt(x)) == 2


def test_the_laplace_runge_lenz_vector_is_conserved() -> None:
    """r'' = -k r/r**3; A = r' x (r x r') - k r/r, and with the force of a spring it is not."""
    k, place, velocity = sp.Symbol("k"), sp.Matrix([x, y, z]), sp.Matrix(sp.symbols("u v w"))
    distance = sqrt(x**2 + y**2 + z**2)
    vector = velocity.cross(place.cross(velocity)) - k * place / distance

    def change(force: sp.Matrix) -> sp.Matrix:
        return vector.jacobian(place) * velocity + vector.jacobian(velocity) * force

    kepler = decide_equal(change(-k * place / distance**3), sp.zeros(3, 1))
    assert kepler.answer == "zero"
    assert kepler.domain == (x**2 + y**2 + z**2,)
    assert decide_equal(change(-k * place), sp.zeros(3, 1)).answer == "nonzero"
    assert decide_equal(change(-k * place / distance**2), sp.zeros(3, 1)).answer == "nonzero"


def test_large_radicands_are_refused_by_their_size() -> None:
    with pytest.raises(NotExactError, match="too large"):
        normal_form(sqrt(sp.expand((x + y + z + p + 1) ** 4)) - x)
    assert decide_zero(sqrt((x + y + z) ** 40 + 1) - x).answer == "nonzero"
    large = sp.nextprime(10**60) * sp.nextprime(10**61)  # its factors are not sought
    assert decide_equal(raw(large) * raw(large + 1), raw(large * (large + 1))).answer == "zero"
    assert decide_equal(raw(large) * raw(large + 1), raw(large * (large + 1) + 1)).answer == "nonzero"


SYMBOLS = st.sampled_from([x, y, r, p, p, q, neg])
NUMBERS = st.sampled_from([S(1), S(-1), S(2), S(3), Rational(1, 2), Rational(-2, 3)])
LINEAR = st.builds(lambda a, s, b, t: a * s + b * t, NUMBERS, SYMBOLS, NUMBERS, st.one_of(SYMBOLS, st.just(S(1))))
RADICANDS = st.one_of(
    LINEAR,
    st.builds(lambda a, b: sp.expand(a * b), LINEAR, LINEAR),
    st.builds(lambda a: sp.expand(a**2), LINEAR),
    st.builds(lambda a, b: a / b, LINEAR, LINEAR),
)
ATOMS = st.one_of(
    st.builds(lambda base, power: base**power, RADICANDS, st.sampled_from([S.Half, -S.Half, Rational(3, 2)])),
    st.sampled_from(
        [x, p, r, I, pi, sqrt(2), sqrt(6), cos(pi / 12), raw(S(-3)), Abs(r), sin(x), cos(30 * x), tan(y / 2)]
    ),
    st.sampled_from([exp(p), cosh(2 * r), sin(x + pi / 3), exp(-25 * p)]),
)
EXPRESSIONS = st.recursive(
    ATOMS,
    lambda parts: st.one_of(
        st.builds(sp.Add, parts, parts),
        st.builds(sp.Mul, parts, parts),
        st.builds(sp.Pow, parts, st.sampled_from([2, -1])),
    ),
    max_leaves=5,
)
# Each is zero for some or all values of its letters, or nearly so.
RELATIONS = st.one_of(
    st.builds(lambda u, v: sqrt(sp.expand(u * v)) - sqrt(u) * sqrt(v), LINEAR, LINEAR),
    st.builds(lambda u, v: sqrt(sp.expand(u**2 * v)) - u * sqrt(v), LINEAR, LINEAR),
    st.builds(lambda u, v: sqrt(u / v) - sqrt(u) / sqrt(v), LINEAR, LINEAR),
    st.builds(lambda u: sqrt(-u) - I * sqrt(u), LINEAR),
    st.builds(lambda u, v: (sqrt(u) + sqrt(v)) ** 2 - sp.expand(u + v) - 2 * sqrt(u) * sqrt(v), LINEAR, LINEAR),
    st.builds(lambda e: e - sp.expand(e), EXPRESSIONS),
    st.builds(lambda e: e - sp.powsimp(sp.together(e)), EXPRESSIONS),
    EXPRESSIONS,
)


def values(expression: sp.Expr, digits: int) -> list[mpmath.mpf]:
    """|expression| at random points by sympy's own evaluation, not the one that the decision uses."""
    found = []
    for point in points(expression.free_symbols, 6):
        value = sp.N(expression.subs(point), digits, maxn=4 * digits, chop=False)
        if value.is_number and not value.has(sp.nan, sp.zoo, sp.oo):
            found.append(abs(mpmath.mpmathify(value)))
    return found


@settings(max_examples=15, deadline=None)
@given(RELATIONS)
def test_random_expressions_agree_with_their_values_at_sixty_digits(expression: sp.Expr) -> None:
    assume(not expression.has(sp.zoo, sp.nan))
    decision = decide_zero(expression)
    assume(decision.answer != "undecided")
    found = values(expression, 60)
    if decision.answer == "zero":
        assert all(value < 1e-40 for value in found)
    elif decision.partly or decision.witness is not None:
        assert decision.witness is not None
        assert abs(sp.N(expression.subs(decision.witness), 60)) > 1e-40
    else:
        assert not found or max(found) > 1e-40


@pytest.mark.parametrize("kind", ["odd", "even", "prime", "integer", "negative", "nonnegative", "imaginary", "zero"])
def test_points_are_of_the_kind_that_is_declared(kind: str) -> None:
    symbol = sp.Symbol("s", **{kind: True})
    assert all(getattr(point[symbol], f"is_{kind}") for point in points([symbol]))
