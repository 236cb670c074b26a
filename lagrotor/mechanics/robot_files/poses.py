"""Fixed displacements in exact rationals: a rotation is that of a rational quaternion.

For every quaternion (a, b, c, d) ≠ 0 of rationals, R = 1 + 2 (a [e]× + [e]×²)/|q|² with e = (b, c, d) is rational and exactly
orthogonal. A multiple of π/2 is exact. Of another angle θ, tan(θ/2) or its inverse is rounded to 10⁻¹⁸, so that R differs
from the file's by less than the rounding of a double, and whether an entry vanishes stays decidable.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

Quaternion = tuple[sp.Rational, ...]
ORIGIN = sp.ImmutableMatrix([0, 0, 0])
UNTURNED: Quaternion = (sp.S.One, sp.S.Zero, sp.S.Zero, sp.S.Zero)
_PLACES = 10**18


@dataclass(frozen=True, eq=False)
class Pose:
    """A shift d (3, 1) in m in the axes of the parent, and then a rotation R (3, 3)."""

    shift: sp.Matrix = ORIGIN
    quaternion: Quaternion = UNTURNED

    @cached_property
    def rotation(self) -> sp.Matrix:
        return rotation_of(self.quaternion)

    def then(self, other: "Pose") -> "Pose":
        """Return this displacement followed by another one in the new axes."""
        return Pose(self.shift + self.rotation * other.shift, product(self.quaternion, other.quaternion))


def rotation_of(quaternion: Quaternion) -> sp.Matrix:
    a, e = quaternion[0], sp.Matrix(quaternion[1:])
    wedge = sp.Matrix([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
    return sp.eye(3) + (wedge * a + wedge * wedge) * 2 / sum(x * x for x in quaternion)


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return p ∘ q, divided by its largest component."""
    (a, b, c, d), (e, f, g, h) = p, q
    r = (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )
    largest = max(map(abs, r))
    return tuple(x / largest for x in r)


def about(axis: Sequence[sp.Expr], angle: sp.Expr) -> Quaternion:
    """Return the quaternion of a turn about an axis of rationals, which need not have the length 1."""
    half = sp.Mod(angle, 2 * sp.pi) / 2 if angle.has(sp.pi) else angle / 2
    c, s = sp.cos(half), sp.sin(half)
    length = sp.sqrt(sum(x * x for x in axis))
    if length.is_Rational and (s == 0 or c == 0 or abs(s / c) == 1):  # a multiple of π/2
        return (sp.sign(c), *(sp.sign(s) * x / length for x in axis))
    return rounded((c, *(s * x / length for x in axis)))


def rounded(quaternion: Sequence[sp.Expr]) -> Quaternion:
    """Return a quaternion of rationals with the largest component 1, the others rounded to 10⁻¹⁸."""
    numbers = [sp.sympify(x, strict=True).evalf(40) for x in quaternion]
    largest = max(map(abs, numbers))
    return tuple(sp.Rational(int((x / largest * _PLACES).round()), _PLACES) for x in numbers)


def number(e: sp.Expr) -> sp.Rational:
    """Return a real number as a rational of 20 significant digits; a rational stays as it is."""
    return e if e.is_Rational else sp.Rational(str(e.evalf(20)))


def to_axis(axis: Sequence[sp.Rational]) -> Quaternion:
    """Return the quaternion of the shortest turn that takes z to the direction of an axis."""
    x, y, z = axis
    length = sp.sqrt(x * x + y * y + z * z)
    if x == y == 0:
        return UNTURNED if z > 0 else (sp.S.Zero, sp.S.One, sp.S.Zero, sp.S.Zero)
    quaternion = (length + z, -y, x, sp.S.Zero)
    return quaternion if length.is_Rational else rounded(quaternion)


def quaternion_of(R: sp.Matrix) -> Quaternion:
    """Return the quaternion of a rotation matrix of real numbers."""
    R = R.evalf(40)
    squares = [1 + R.trace(), *(1 + 2 * R[i, i] - R.trace() for i in range(3))]  # 4 a², 4 b², 4 c², 4 d²
    k = max(range(4), key=lambda i: squares[i])
    wedge = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]  # 4 a (b, c, d)
    if k == 0:
        return rounded((squares[0], *wedge))
    return rounded((wedge[k - 1], *(squares[k] if i == k - 1 else R[i, k - 1] + R[k - 1, i] for i in range(3))))
