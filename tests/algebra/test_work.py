"""A bound on the work of a decision is kept, and what it cut short is not remembered."""

import sys

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.algebra.work_budget import at_most
from lagrotor.errors import WorkError

A, B, X = sp.symbols("a b x", positive=True)
SIDES = sp.log(A**3 * B**2 + A**2 * B**3), 2 * sp.log(A) + 2 * sp.log(B) + sp.log(A + B)


def test_beyond_the_bound_nothing_is_decided_and_without_it_the_same_is() -> None:
    with pytest.raises(WorkError):
        at_most(10_000, decide_equal, *SIDES)
    assert at_most(1_000_000, decide_equal, *SIDES).answer == "zero"
    assert decide_equal(SIDES[0], SIDES[1] + 1).answer == "nonzero"


def test_what_is_too_large_is_so_whatever_was_decided_before() -> None:
    """Twin: with the answer at hand, the same is no work."""
    assert decide_equal(*SIDES).answer == decide_equal(*SIDES).answer == "zero"
    with pytest.raises(WorkError):
        at_most(10_000, decide_equal, *SIDES)
    decide_equal(*SIDES)
    calls = list[str]()
    sys.setprofile(lambda frame, event, argument: calls.append(event))
    decide_equal(*SIDES)
    sys.setprofile(None)
    assert len(calls) < 10_000


def test_the_count_is_the_same_each_time() -> None:
    """Within five parts in a hundred: it ends above, not below."""
    least, most = 1000, 1_000_000
    while most > 1.05 * least:
        middle = (least + most) // 2
        try:
            at_most(middle, decide_equal, *SIDES)
            most = middle
        except WorkError:
            least = middle
    for _ in range(2):
        assert at_most(int(1.05 * most), decide_equal, *SIDES).answer == "zero"
        with pytest.raises(WorkError):
            at_most(int(least / 1.05), decide_equal, *SIDES)


def _holds_every_error() -> str:
    try:
        sp.factor((A + B) ** 60 - sp.expand((A + B) ** 59 * (A + B)))
    except:  # noqa: E722
        return "held"
    return "ended"


def _goes_on_after_an_error() -> None:
    _holds_every_error()
    for n in range(10**6):
        sp.sin(sp.Integer(n)).diff(X)


@pytest.mark.parametrize(
    "work",
    [
        lambda: sp.factor(sum(sp.sqrt(X + n) for n in range(12)) ** 40 - 1),
        lambda: sp.integrate(sp.sin(X) ** 9 * sp.exp(X**2) / (1 + X**7), X),
        lambda: [n for n in iter(int, 1) if sp.Integer(n + 2).is_composite],
        _holds_every_error,
        _goes_on_after_an_error,
    ],
)
def test_whatever_is_done_ends(work, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(WorkError):
        at_most(20_000, work)
    assert sys.getprofile() is None
    assert capfd.readouterr().err == ""


def test_an_error_of_the_work_itself_is_its_own() -> None:
    with pytest.raises(ZeroDivisionError):
        at_most(1000, lambda: 1 // 0)
    assert at_most(1000, max, 1, 2) == 2
