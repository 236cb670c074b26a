"""A bound on the work of a decision is kept, and what it cut short is not remembered."""

import pytest
import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.algebra.work import at_most
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
