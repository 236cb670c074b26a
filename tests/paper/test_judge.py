"""One printed expression against a derived one, in a line, without a paper."""

import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.paper import Premise, judge

x, y = sp.symbols("x y", real=True)
n = sp.Symbol("n", positive=True)


def test_an_identity_holds_and_a_wrong_sign_is_refuted() -> None:
    assert judge(sp.sin(x) ** 2, 1 - sp.cos(x) ** 2).verdict == "holds"
    assert judge(sp.sin(x) ** 2, 1 + sp.cos(x) ** 2).verdict == "refuted"


def test_text_is_read_in_the_letters_of_the_derived_side() -> None:
    assert judge("n*sin(x)", n * sp.sin(x)).verdict == "holds"
    assert judge("n*cos(x)", n * sp.sin(x)).verdict == "refuted"
    assert judge("0.5*x", x / 2).verdict == "holds", "a decimal is the rational that it is"
    with pytest.raises(InputError, match="'z' is not defined: declare the letter"):
        judge("z*x", x)


def test_what_is_given_is_named_only_where_it_is_needed() -> None:
    decided = judge("n*x", x, given={n: 1})
    assert (decided.verdict, decided.condition) == ("holds-if", "n = 1")
    assert judge("n*x", n * x, given={n: 1}).premises == ()
    named = judge(n * x, x, given=[Premise("unit number", {n: 1})])
    assert named.condition == "unit number"
    assert judge("n*x", x, given={n: 2}).verdict == "refuted"


def test_an_order_is_claimed_in_a_small_letter() -> None:
    near = judge(x - x**3 / 6, sp.sin(x), small=x, order=3)
    assert (near.verdict, near.order) == ("holds-to-order", 4)
    assert judge("x", sp.sin(x), small=x, order=3).verdict == "refuted"


@pytest.mark.parametrize("places", [(0, 1, 2), (1, 0, 2), (2, 1, 0)])
def test_of_a_vector_the_component_that_differs_first_decides(places: tuple[int, ...]) -> None:
    printed, derived = [x, 1 - x**2 / 2, n * x], [sp.sin(x), sp.cos(x), n * x]  # off in order 3, in order 4, nowhere
    near = judge(sp.Matrix([printed[i] for i in places]), sp.Matrix([derived[i] for i in places]), small=x, order=1)
    assert (near.verdict, near.order) == ("holds-to-order", 2)


def test_matrices_are_compared_entry_by_entry() -> None:
    turn = sp.Matrix([[sp.cos(x), -sp.sin(x)], [sp.sin(x), sp.cos(x)]])
    assert judge(sp.eye(2), turn * turn.T).verdict == "holds"
    assert judge(sp.eye(2), turn * turn).verdict == "refuted"


def test_a_verdict_by_itself_is_shown_in_text_and_in_a_notebook() -> None:
    decided = judge("n*x", x, given={n: 1})
    assert repr(decided).splitlines() == ["n·x = x: holds-if", "  under the given premise n = 1"]
    html = decided._repr_html_()
    assert "holds-if<br>under the given premise n = 1" in html and "<table" in html


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: judge(x, "x"),
        lambda: judge(None, x),
        lambda: judge([x], x),
        lambda: judge(x, y, given={"x": "y"}),
        lambda: judge(x, y, given={x: "y"}),
        lambda: Premise("x is y", {x: "y"}),
        lambda: judge(x, sp.sin(x), small="x", order=2),
        lambda: judge(x, sp.sin(x), small=x, order="2"),
        lambda: judge(x, sp.sin(x), small=x, order=-1),
    ],
)
def test_what_is_no_expression_is_refused(wrong) -> None:
    with pytest.raises(InputError):
        wrong()
