"""Floquet multipliers from an enclosed monodromy matrix.

Of a conservative system they come in pairs μ, 1/μ: one pair of ones for the energy with the shift of time, one more for every
further integral. Where one pair is left, its sum is the trace less the ones: inside (−2, 2) the pair lies on the unit circle,
outside it is real. Of any other orbit all multipliers but the one along the motion are enclosed one by one.
"""

from dataclasses import dataclass
from typing import Any, Literal

from lagrotor.errors import InputError
from lagrotor.proofs.balls import Ball, Balls, Matrix, arb, arb_poly
from lagrotor.proofs.matrices import diagonal, inverse

Kind = Literal["elliptic", "hyperbolic", "attracting", "parabolic", "undecided"]


def trace(matrix: Matrix) -> Ball:
    """The sum of the diagonal."""
    return sum((matrix[i, i] for i in range(matrix.nrows())), arb(0))


def monodromy(quarter: Matrix, first: tuple[int, ...], last: tuple[int, ...]) -> Matrix:
    """(A D⁻¹ B D)^m from the derivative D between the reversals A at the start and B at the end, m the order of A B."""
    A, B = diagonal(first), diagonal(last)
    part = A * inverse(quarter) * B * quarter
    return part if first == last else part * part


@dataclass(frozen=True)
class Multipliers:
    """pair_sum: μ + 1/μ of the one pair that is not 1, None where there are more; values: complex balls (real, imaginary)."""

    kind: Kind
    pair_sum: Ball | None
    values: tuple[tuple[Ball, Ball], ...]


def of_pairs(matrix: Matrix, ones: int) -> Multipliers:
    """The pair μ, 1/μ of a conservative orbit whose other multipliers are 1; parabolic where all are, undecided of more pairs."""
    left = matrix.nrows() - ones
    total = trace(matrix) - ones
    if left not in (0, 2):
        return Multipliers("undecided", None, ())
    if not fits(matrix, total, ones):
        raise InputError(
            f"periodic_orbit: the multipliers are not {ones} ones and a pair: the system has fewer integrals"
        )
    if not left:
        return Multipliers("parabolic", None, ())
    if abs(total) < 2:
        half, high = total / 2, (1 - total * total / 4).sqrt()
        return Multipliers("elliptic", total, ((half, high), (half, -high)))
    if abs(total) > 2:
        root = (total * total / 4 - 1).sqrt()
        zero = arb(0)
        return Multipliers("hyperbolic", total, ((total / 2 + root, zero), (total / 2 - root, zero)))
    return Multipliers("undecided", total, ())


def fits(matrix: Matrix, total: Ball, ones: int) -> bool:
    """Whether the characteristic polynomial may be (z − 1)^ones (z² − total z + 1), without the pair where none is left."""
    pair = arb_poly([1, -total, 1]) if matrix.nrows() > ones else arb_poly([1])
    return all(x.contains(0) for x in (matrix.charpoly() - arb_poly([-1, 1]) ** ones * pair).coeffs())


def of_any(matrix: Matrix) -> Multipliers:
    """All multipliers, where they are apart; "hyperbolic" where all but the one along the motion are off the unit circle."""
    try:
        found: list[Any] = matrix.eig()
    except ValueError:
        return Multipliers("undecided", None, ())
    sizes: Balls = [abs(z) for z in found]
    along = [i for i, z in enumerate(found) if z.contains(1)]
    others = [s for i, s in enumerate(sizes) if i not in along]
    kind: Kind = "undecided"
    if len(along) == 1 and all(s < 1 for s in others):
        kind = "attracting"
    elif len(along) == 1 and all(s < 1 or s > 1 for s in others):
        kind = "hyperbolic"
    return Multipliers(kind, None, tuple((z.real, z.imag) for z in found))
