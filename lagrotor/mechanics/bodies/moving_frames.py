"""Frames that turn and move with the coordinates, and the velocities of their points.

A frame is reached from its parent by one step: a turn about one of its axes, a shift along them, or a rotation of one's
own. With the rotation R (components in the frame → in the parent), the shift d and a dot for d/dt, in the frame's axes,

    ω = Rᵀ ω_parent + u,        v = Rᵀ (v_parent + ω_parent × d + d'),

u the turn's own rate about its axis (the axial vector of Rᵀ R'). Featherstone, Rigid Body Dynamics Algorithms, ch. 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import sympy as sp

from lagrotor.algebra import check_names, decide_equal, decide_zero
from lagrotor.algebra.subexpressions import with_shared_parts
from lagrotor.errors import InputError
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, total_derivative

Vector = Sequence[Any]
AXES = "xyz"
Kind = TypeVar("Kind", bound="MovingFrame")


@dataclass(frozen=True, eq=False)
class MovingFrame:
    """The ground, or a frame reached from its parent.

    axis, amount: the step from the parent: a turn by the angle `amount` about axis 0, 1, 2; a shift by the vector
    `amount` (axis None); or a rotation matrix. quaternion, omega: of a ball joint, see `named_joints`.
    """

    c: Coordinates
    parent: "MovingFrame | None" = None
    axis: int | None = None
    amount: Any = None
    quaternion: tuple[sp.Symbol, ...] = ()
    omega: tuple[sp.Symbol, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.c, Coordinates):
            raise InputError(f"Frame: {self.c!r} must be Coordinates: Frame(coordinates('phi theta psi'))")
        check_names("Frame", self.c.q, self.c.v, [frame.amount for frame in self.to_the_ground])

    @property
    def to_the_ground(self) -> "list[MovingFrame]":
        """This frame, its parent, and so on."""
        return [self] if self.parent is None else [self, *self.parent.to_the_ground]

    def __repr__(self) -> str:
        if self.parent is None:
            return "Frame(ground)"
        if self.omega:
            return f"Frame(turned by the quaternion {self.quaternion})"
        if self.axis is not None:
            return f"Frame(turned about {AXES[self.axis]} by {self.amount})"
        return f"Frame({'turned' if self.amount.cols == 3 else 'moved'} by {self.amount.tolist()})"

    def turned(self: Kind, axes: Any, angles: Any = None) -> Kind:
        """Turned about its own axes one after another, "zxz" by three angles; or by a rotation matrix of one's own.

        Raises InputError when letters and angles do not fit, or R Rᵀ = 1 is not decided.
        """
        if not isinstance(axes, str):
            return type(self)(self.c, self, None, _rotation(axes))
        given = list(angles) if isinstance(angles, Sequence | sp.MatrixBase) else [angles]
        if not axes or set(axes) - set(AXES) or len(given) != len(axes) or None in given:
            raise InputError(f"turned: axes {axes!r} and angles {angles!r}: one angle for each letter of x, y, z")
        frame = self
        for letter, angle in zip(axes, given, strict=True):
            frame = type(self)(self.c, frame, AXES.index(letter), expression("turned: angle", angle))
        return frame

    def moved(self: Kind, x: Any = 0, y: Any = 0, z: Any = 0) -> Kind:
        """Shifted along its own axes; lengths may be coordinates."""
        return type(self)(self.c, self, None, sp.Matrix(vector_of("moved: (x, y, z)", (x, y, z), 3)))

    @cached_property
    def rotation(self) -> sp.Matrix:
        """R: components in this frame → components in the parent."""
        if self.axis is not None:
            return turn_matrix(self.axis, self.amount)
        return self.amount if self.parent is not None and self.amount.cols == 3 else sp.eye(3)

    @property
    def shift(self) -> sp.Matrix:
        """d: the origin, from the parent's, in the parent's axes."""
        shifted = self.parent is not None and self.axis is None and self.amount.cols == 1
        return self.amount if shifted else sp.zeros(3, 1)

    @property
    def own_rate(self) -> sp.Matrix:
        """u: the turn's own angular velocity, in this frame's axes."""
        if self.axis is not None:
            return sp.eye(3)[:, self.axis] * total_derivative(self.amount, self.c)
        if self.omega:
            return sp.Matrix(list(self.own_velocities.values()))
        R = self.rotation
        spin = R.T * R.applyfunc(lambda e: total_derivative(e, self.c))
        return sp.Matrix([spin[2, 1], spin[0, 2], spin[1, 0]])

    @property
    def own_velocities(self) -> dict[sp.Symbol, sp.Expr]:
        """ω of a ball joint by its names: 2 E(q) q'."""
        if not self.omega:
            return {}
        rates = [self.c.v[self.c.q.index(q)] for q in self.quaternion]
        rows = zip(self.omega, quaternion_rows(*self.quaternion), strict=True)
        return {w: 2 * sp.Add(*map(sp.Mul, row, rates)) for w, row in rows}

    @property
    def unit_length(self) -> sp.Expr:
        """|q|² − 1 of a ball joint, which stays zero."""
        return sp.Add(*(q**2 for q in self.quaternion), -1)

    @cached_property
    def angular_velocity(self) -> sp.Matrix:
        """ω, in the frame's own axes, (3, 1)."""
        if self.parent is None:
            return sp.zeros(3, 1)
        return (self.rotation.T * self.parent.angular_velocity + self.own_rate).applyfunc(with_shared_parts)

    @cached_property
    def origin_velocity(self) -> sp.Matrix:
        """v of the origin, in the frame's own axes, (3, 1)."""
        if self.parent is None:
            return sp.zeros(3, 1)
        d = self.shift
        carried = self.parent.angular_velocity.cross(d) + d.applyfunc(lambda e: total_derivative(e, self.c))
        return (self.rotation.T * (self.parent.origin_velocity + carried)).applyfunc(with_shared_parts)

    def place(self, point: Vector = (0, 0, 0), seen: "MovingFrame | None" = None) -> sp.Matrix:
        """Where a point of the frame is, in the axes of the ground, or of a frame `seen` that it descends from."""
        position = sp.Matrix(list(point))
        frame: MovingFrame = self
        while frame is not seen and frame.parent is not None:
            position = (frame.rotation * position + frame.shift).applyfunc(with_shared_parts)
            frame = frame.parent
        return position

    def velocity(self, point: Vector = (0, 0, 0), seen: "MovingFrame | None" = None) -> sp.Matrix:
        """The velocity of the point that moves with this frame and is now at `point`; both in the axes of `seen`.

        seen: this frame, or one that it descends from, as the frame of a wheel's axle for the point of contact.
        """
        at, other = sp.Matrix(list(point)), seen or self
        spin, origin, drift = self._relative(other)
        return other.origin_velocity + other.angular_velocity.cross(at) + drift + spin.cross(at - origin)

    def _relative(self, seen: "MovingFrame") -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """ω, origin and its velocity relative to the frame `seen`, in the axes of that frame."""
        chain: list[MovingFrame] = []
        frame = self
        while frame is not seen:
            if frame.parent is None:
                raise InputError("velocity: `seen` must be a frame from which this one was turned or moved")
            chain.append(frame)
            frame = frame.parent
        R, spin, origin, drift = sp.eye(3), sp.zeros(3, 1), sp.zeros(3, 1), sp.zeros(3, 1)
        for step in reversed(chain):
            d = R * step.shift
            drift += spin.cross(d) + R * step.shift.applyfunc(lambda e: total_derivative(e, self.c))
            origin += d
            R = R * step.rotation
            spin += R * step.own_rate
        return spin, origin, drift


def quaternion_rows(a: Any, b: Any, c: Any, d: Any) -> tuple[tuple[Any, ...], ...]:
    """E (3, 4) of a unit quaternion, with ω = 2 E q' and q' = ½ Eᵀ ω."""
    return (-b, a, d, -c), (-c, -d, a, b), (-d, c, -b, a)


def turn_matrix(axis: int, angle: sp.Expr) -> sp.Matrix:
    """The rotation by an angle about axis 0, 1 or 2: components in the turned frame → in the one before."""
    c, s = sp.cos(angle), sp.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = sp.eye(3)
    R[i, i], R[j, j], R[i, j], R[j, i] = c, c, -s, s
    return R


def _rotation(given: Any) -> sp.Matrix:
    try:
        R = sp.Matrix(given)
    except (TypeError, ValueError):
        raise InputError(f"turned: {given!r} is neither letters of x, y, z nor a rotation matrix (3, 3)") from None
    if R.shape != (3, 3) or decide_equal(R * R.T, sp.eye(3)).answer == "nonzero":
        raise InputError("turned: a rotation of one's own must be a matrix (3, 3) with R Rᵀ = 1; this one is not")
    if decide_zero(R.det(method="berkowitz") - 1).answer == "nonzero":
        raise InputError("turned: this matrix has R Rᵀ = 1 and det R = −1: it reflects; change the sign of one axis")
    return R
