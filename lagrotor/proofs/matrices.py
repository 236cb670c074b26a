"""Matrices of balls: inverses, and Krawczyk's test of a box in which a map has a zero, and one only.

For F with the derivative in DF over the box z + w, A near its inverse and K = z − A F(z) + (1 − A DF) w:
where K lies within the box's interior, F has one zero in the box, and it is in K.
Krawczyk 1969; Neumaier, Interval Methods for Systems of Equations, § 5.1.
"""

from collections.abc import Sequence

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import ZERO, Ball, Balls, Matrix, arb, arb_mat, exact, max_of


def column(values: Balls) -> Matrix:
    """Return a column."""
    return arb_mat(len(values), 1, values)


def times(matrix: Matrix, values: Balls) -> Balls:
    """Return the entries of a matrix times a column."""
    return (matrix * column(values)).entries()


def diagonal(entries: Sequence[int]) -> Matrix:
    """Return a diagonal matrix."""
    n = len(entries)
    return arb_mat(n, n, [entries[i] if i == j else 0 for i in range(n) for j in range(n)])


def identity(size: int) -> Matrix:
    """Return the unit matrix."""
    return diagonal([1] * size)


def middle_of(matrix: Matrix) -> Matrix:
    """Return the matrix of the midpoints, which is exact."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [exact(x) for x in matrix.entries()])


def matrix_norm(matrix: Matrix) -> Ball:
    """Return the largest sum of absolute values along a row, an upper bound."""
    return max_of([sum(map(abs, row), ZERO) for row in matrix.tolist()])


def middle_inverse(slope: Matrix) -> Matrix:
    """Return an exact matrix near the inverse of the derivative's middle.

    Raises
    ------
    NotProved
        If the middle is singular.
    """
    try:
        return middle_of(middle_of(slope).inv())
    except ZeroDivisionError:
        raise NotProved("the conditions do not determine the orbit: their derivative is singular") from None


def inverse(matrix: Matrix) -> Matrix:
    """Enclose the inverses of all matrices of a ball: X (1 + R + R² + …), X near the middle's inverse, R = 1 − M X.

    Raises
    ------
    NotProved
        If the sum is not shown to converge.
    """
    n, X = matrix.nrows(), middle_inverse(matrix)
    R = identity(n) - matrix * X
    size = matrix_norm(R)
    if not size < 1:
        raise NotProved("the derivative along the orbit is too wide to be inverted")
    rest = (size * size / (1 - size)).upper()
    return X * (identity(n) + R + arb_mat(n, n, [arb(0, rest)] * (n * n)))


def krawczyk(value: Balls, slope: Matrix, A: Matrix, w: Balls) -> Balls:
    """Return K − z from F(z), DF over the box, A and the box w about z."""
    return (-(A * column(value)) + (identity(len(w)) - A * slope) * column(w)).entries()


def inside(image: Balls, w: Balls) -> bool:
    """Return whether K − z lies within the interior of the box w."""
    return all(box.contains_interior(x) for x, box in zip(image, w, strict=True))
