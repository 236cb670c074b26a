"""A bound on the work of a decision is kept, and what it cut short is not remembered."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.algebra.scalar import parts
from lagrotor.algebra.work import at_most, factored, multiplied_out
from lagrotor.errors import WorkError


def test_beyond_the_bound_nothing_is_decided_and_without_it_the_same_is() -> None:
    a, b = sp.symbols("a b", positive=True)
    sides = sp.log(a**3 * b**2 + a**2 * b**3), 2 * sp.log(a) + 2 * sp.log(b) + sp.log(a + b)
    with pytest.raises(WorkError), at_most(50):
        decide_equal(*sides)
    with at_most(100_000):
        assert decide_equal(*sides).answer == "zero"
    assert decide_equal(sides[0], sides[1] + 1).answer == "nonzero"


def test_what_is_too_large_is_so_whatever_was_decided_before() -> None:
    a, b = sp.symbols("a b", positive=True)
    sides = sp.log(a**3 * b**2 + a**2 * b**3), 2 * sp.log(a) + 2 * sp.log(b) + sp.log(a + b)
    assert decide_equal(*sides).answer == "zero"
    with pytest.raises(WorkError), at_most(50):
        decide_equal(*sides)


@pytest.mark.parametrize(("number", "refused"), [(2, False), (10, True)])
def test_what_is_multiplied_out_is_counted_before_it_is_factored(
    number: int, refused: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    x = sp.symbols("a b c d f g h k", real=True)
    e = sp.Add(*(x[i % 8] * sp.log(x[i % 7]) / (x[i % 5] + sp.sqrt(x[(i + 1) % 8]) + i + 1) for i in range(number)))
    sought = list[sp.Expr]()
    factor = sp.factor
    monkeypatch.setattr(sp, "factor", lambda e: sought.append(e) or factor(e))
    if refused:
        assert parts(e) ** 2 < 200_000  # as many as are printed say nothing of it
        with pytest.raises(WorkError), at_most(200_000):
            factored(e)
    else:
        with at_most(200_000):
            factored(e)
    assert len(sought) == (not refused)


def test_no_fewer_terms_are_counted_than_there_are() -> None:
    a, b, c, d = sp.symbols("a b c d")
    for e in (
        (a + b * c) ** 3 * (c - d + 1) ** 2,
        a / (b + c) + d / (a + b + 1) ** 2 - c / (b + c),
        sp.log((a + b) ** 4) + sp.sqrt(c * (a + d) ** 2),
        1 / (1 / (a + b) + 1 / (c + d)),
    ):
        over, under = sp.fraction(sp.together(e))
        assert multiplied_out(e) >= len(sp.Add.make_args(sp.expand(over)))
        assert multiplied_out(e) >= len(sp.Add.make_args(sp.expand(under)))
        assert multiplied_out(sp.expand(over)) >= len(sp.Add.make_args(sp.expand(over)))
