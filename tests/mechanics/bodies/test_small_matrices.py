"""The small matrices against sympy's, on random entries with many zeros."""

import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.mechanics.bodies.small_matrices import Small, unit, wedge, zeros

SYMBOLS = sp.symbols("a b c")
ENTRIES = st.sampled_from([sp.S.Zero, sp.S.Zero, sp.S.One, -sp.S.One, *SYMBOLS, -SYMBOLS[0]])


def matrices(rows: int, columns: int) -> st.SearchStrategy:
    entries = st.lists(ENTRIES, min_size=rows * columns, max_size=rows * columns)
    return entries.map(lambda found: sp.Matrix(rows, columns, found))


def same(small: Small, matrix: sp.Matrix) -> bool:
    return (sp.Matrix(small.rows) - matrix).expand().is_zero_matrix


@settings(max_examples=30, deadline=None)
@given(matrices(3, 3), matrices(3, 3), matrices(3, 1), matrices(3, 1))
def test_the_operations_are_those_of_matrices(A: sp.Matrix, B: sp.Matrix, v: sp.Matrix, w: sp.Matrix) -> None:
    a, b, x, y = map(Small.of, (A, B, v, w))
    assert same(a + b, A + B) and same(a - b, A - B) and same(a * b, A * B) and same(a * x, A * v)
    assert same(a * SYMBOLS[1], A * SYMBOLS[1]) and same(a.T, A.T) and same(-a, -A)
    assert same(x.cross(y), v.cross(w)) and sp.expand(x.dot(y) - v.dot(w)) == 0
    assert same(wedge(x) * y, v.cross(w))
    assert same(a.col(1), A[:, 1]) and same(a.row(2), A[2, :].T) and a[1, 2] == A[1, 2] and x[1] == v[1]
    assert a.is_zero == (sp.zeros(3, 3) == A)


def test_zeros_and_units() -> None:
    assert zeros(3, 2).is_zero and len(zeros(3, 2).rows[0]) == 2
    assert [unit(1, SYMBOLS[0])[i] for i in range(3)] == [0, SYMBOLS[0], 0]
    assert Small.column(1, 2).rows == [[1], [2]]
