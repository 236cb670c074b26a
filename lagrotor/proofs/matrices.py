"""Matrices of balls: inverses, and the Krawczyk test for a unique zero of a map F in a box z + w.

DF encloses the derivative over the box, A is near its inverse, and K = z − A F(z) + (1 − A DF) w. If K lies in the interior
of the box, F has exactly one zero in the box, and it lies in K. Krawczyk 1969; Neumaier, Interval Methods for Systems of
Equations, § 5.1.
"""

from collections.abc import Sequence

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import ZERO, Ball, Balls, Matrix, arb, arb_mat, exact, max_of


def column(values: Balls) -> Matrix:
    return arb_mat(len(values), 1, values)


def times(matrix: Matrix, values: Balls) -> Balls:
    """Return the entries of a matrix times a column."""
    return (matrix * column(values)).entries()


def diagonal(entries: Sequence[int]) -> Matrix:
    n = len(entries)
    return arb_mat(n, n, [entries[i] if i == j else 0 for i in range(n) for j in range(n)])


def identity(size: int) -> Matrix:
    return diagonal([1] * size)


def middle_of(matrix: Matrix) -> Matrix:
    """Return the exact matrix of the midpoints."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [exact(x) for x in matrix.entries()])


def matrix_norm(matrix: Matrix) -> Ball:
    """Return an upper bound of the row-sum norm, the largest sum of absolute values in a row."""
    return max_of([sum(map(abs, row), ZERO) for row in matrix.tolist()])


def middle_inverse(slope: Matrix) -> Matrix:
    """Return an exact matrix near the inverse of the midpoint. Raises NotProved if the midpoint is singular."""
    try:
        return middle_of(middle_of(slope).inv())
    except ZeroDivisionError:
        raise NotProved("the conditions do not determine the orbit: their derivative is singular") from None


def inverse(matrix: Matrix) -> Matrix:
    """Enclose the inverses of a matrix ball M by X (1 + R + R² + …), R = 1 − M X. Raises NotProved if the series may diverge."""
    n, X = matrix.nrows(), middle_inverse(matrix)
    R = identity(n) - matrix * X
    size = matrix_norm(R)
    if not size < 1:
        raise NotProved("the derivative along the orbit is too wide to be inverted")
    remainder = (size * size / (1 - size)).upper()
    return X * (identity(n) + R + arb_mat(n, n, [arb(0, remainder)] * (n * n)))


def krawczyk(value: Balls, slope: Matrix, A: Matrix, w: Balls) -> Balls:
    """Return the Krawczyk box K minus its centre z, (1 − A D) w − A F(z).

    `value` is F(z), `slope` encloses the Jacobian matrix D on the box, A approximates the inverse of D, and w is the box minus
    z.
    """
    return (-(A * column(value)) + (identity(len(w)) - A * slope) * column(w)).entries()


def inside(image: Balls, w: Balls) -> bool:
    """Return True if `image`, the Krawczyk box K − z, lies in the interior of the box w."""
    return all(box.contains_interior(x) for x, box in zip(image, w, strict=True))
