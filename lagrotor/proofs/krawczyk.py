"""Krawczyk's test: a box in which a map has a zero, and one only.

For F with the derivative in DF over the box z + w, A near its inverse and K = z − A F(z) + (1 − A DF) w:
where K lies within the box's interior, F has one zero in the box, and it is in K.
Krawczyk 1969; Neumaier, Interval Methods for Systems of Equations, § 5.1.
"""

from lagrotor.errors import NotProved
from lagrotor.proofs.balls import Balls, Matrix, arb_mat, exact
from lagrotor.proofs.carried_sets import column_matrix, entries_of, identity


def middle_inverse(slope: Matrix) -> Matrix:
    """An exact matrix near the inverse of the derivative's middle. Raises NotProved where there is none."""
    rows, columns = slope.nrows(), slope.ncols()
    try:
        found = arb_mat(rows, columns, [exact(x) for x in slope.entries()]).inv()
    except ZeroDivisionError:
        raise NotProved("the conditions do not determine the orbit: their derivative is singular") from None
    return arb_mat(rows, columns, [exact(x) for x in found.entries()])


def krawczyk(value: Balls, slope: Matrix, A: Matrix, w: Balls) -> Balls:
    """K − z: from F(z), DF over the box, A, the box w about z."""
    return entries_of(-(A * column_matrix(value)) + (identity(len(w)) - A * slope) * column_matrix(w))


def inside(found: Balls, w: Balls) -> bool:
    """Whether K − z lies within the interior of the box w."""
    return all(box.contains_interior(x) for x, box in zip(found, w, strict=True))
