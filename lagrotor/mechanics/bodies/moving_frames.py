"""Frames that turn and move with the coordinates, the velocities of their points, and joints by name.

A frame is reached from its parent by one step: a turn about one of its axes, a shift along them, or a rotation of one's
own. With the rotation R (components in the frame → in the parent), the shift d and a dot for d/dt, in the frame's axes,

    ω = Rᵀ ω_parent + u,        v = Rᵀ (v_parent + ω_parent × d + d'),

u the turn's own rate about its axis (the axial vector of Rᵀ R'). Featherstone, Rigid Body Dynamics Algorithms, ch. 2.

Joints are such steps by name: pin, prismatic, screw, cylindrical, universal, planar, weld; ball and free, which have no pole;
`coincides` and `keeps_axis` close loops. A ball joint turns by a unit quaternion q = (q0, q1, q2, q3), scalar first. Its
velocities are those of its angular velocity ω relative to the frame before it, in the turned axes:

    R = 1 + 2 q0 [e]× + 2 [e]×²,  e = (q1, q2, q3),        q' = ½ q ∘ (0, ω),        ω = 2 E(q) q'.

|q| = 1 is a constraint of the system that ω uses up. Altmann, Rotations, Quaternions and Double Groups (1986), ch. 12.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
    `amount` (axis None); or a rotation matrix. quaternion, omega: of a ball joint, see `moving_frames`.
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
        _, spin, origin, drift = self.relative(other)
        return other.origin_velocity + other.angular_velocity.cross(at) + drift + spin.cross(at - origin)

    def relative(self, seen: "MovingFrame") -> tuple[sp.Matrix, sp.Matrix, sp.Matrix, sp.Matrix]:
        """Rotation, ω, origin and its velocity relative to the frame `seen`, in the axes of that frame."""
        steps = self.to_the_ground
        if seen not in steps:
            raise InputError("velocity: `seen` must be a frame from which this one was turned or moved")
        R, spin, origin, drift = sp.eye(3), sp.zeros(3, 1), sp.zeros(3, 1), sp.zeros(3, 1)
        for step in reversed(steps[: steps.index(seen)]):
            drift += spin.cross(R * step.shift) + R * step.shift.applyfunc(lambda e: total_derivative(e, self.c))
            origin += R * step.shift
            before, R = R, R * step.rotation
            spin += (R if step.axis is None else before) * step.own_rate  # a turn keeps its axis
        return R, spin, origin, drift


def in_ground(frame: MovingFrame) -> tuple[sp.Matrix, sp.Matrix]:
    """Rotation and ω of a frame in the axes of the ground."""
    return frame.relative(frame.to_the_ground[-1])[:2]


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


def weld(frame: Kind, at: Vector = (0, 0, 0), axes: str = "", angles: Any = ()) -> Kind:
    """A frame fixed to this one: shifted to `at`, then turned by fixed angles about its axes.

    Raises InputError where a coordinate moves it.
    """
    place = vector_of("weld: at", at, 3)
    given = [
        expression("weld: angle", e) for e in (angles if isinstance(angles, Sequence | sp.MatrixBase) else [angles])
    ]
    moving = set().union(*(e.free_symbols for e in (*place, *given))) & {*frame.c.q, *frame.c.v}
    if moving:
        raise InputError(
            f"weld: {', '.join(sorted(map(str, moving)))} moves it: a weld is fixed; take a joint that moves"
        )
    shifted = frame.moved(*place)
    return shifted.turned(axes, given) if axes or given else shifted


def pin(frame: Kind, angle: Any, axis: Any = "z") -> Kind:
    """Turned by an angle about one of its axes, "x", "y" or "z", or about a direction (x, y, z) in them."""
    return _about("pin", frame, axis, lambda it: it.turned("z", expression("pin: angle", angle)))


def prismatic(frame: Kind, length: Any, axis: Any = "z") -> Kind:
    """Shifted by a length along one of its axes, or along a direction (x, y, z) in them."""
    along = _direction("prismatic", axis)
    return frame.moved(*(along * expression("prismatic: length", length)))


def cylindrical(frame: Kind, length: Any, angle: Any, axis: Any = "z") -> Kind:
    """Shifted along an axis, and turned about it."""
    return _about("cylindrical", frame, axis, lambda it: it.moved(0, 0, length).turned("z", angle))


def screw(frame: Kind, angle: Any, pitch: Any, axis: Any = "z") -> Kind:
    """Turned by an angle about an axis, along which it moves by `pitch` with each turn of 2 π."""
    turned = expression("screw: angle", angle)
    way = expression("screw: pitch", pitch) * turned / (2 * sp.pi)
    return _about("screw", frame, axis, lambda it: it.moved(0, 0, way).turned("z", turned))


def universal(frame: Kind, first: Any, second: Any, axes: str = "xy") -> Kind:
    """Turned about one of its axes and then about another, a Cardan or Hooke joint."""
    if not isinstance(axes, str) or len(axes) != 2 or len({*axes}) != 2 or {*axes} - {*AXES}:
        raise InputError(f"universal: axes {axes!r} must be two different letters of x, y, z")
    return frame.turned(axes, [first, second])


def planar(frame: Kind, x: Any, y: Any, angle: Any, normal: Any = "z") -> Kind:
    """Shifted by x and y in the plane across an axis, and turned about it."""
    return _about("planar", frame, normal, lambda it: it.moved(x, y, 0).turned("z", angle))


def ball_joint(frame: Kind, quaternion: Any, omega: Any) -> Kind:
    """Turned by a unit quaternion: four of the coordinates by name, scalar first; omega: names of the angular velocities about
    the axes of the turned frame, which are velocities of the system in place of those of the four.

    Raises InputError for what is no such name.
    """
    q = tuple(_coordinate("ball", frame, name) for name in _names("ball: quaternion", quaternion, 4))
    names = _names("ball: omega", omega, 3)
    if len({*q}) < 4 or len({*names}) < 3 or {*names} & {str(s) for s in (*frame.c.q, *frame.c.v, *frame.c.a)}:
        raise InputError(
            f"ball: quaternion {quaternion!r} and omega {omega!r}: seven different names, of which those of omega are no "
            "coordinates'"
        )
    if taken := [str(s) for step in frame.to_the_ground for s in {*step.quaternion} & {*q}]:
        raise InputError(f"ball: {taken[0]} turns another ball joint on the way: give each four coordinates of its own")
    a, b, c, d = q
    R = sp.Matrix(
        [
            [1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)],
        ]
    )
    step = type(frame)(frame.c, frame, None, R)
    return replace(step, quaternion=q, omega=tuple(sp.Symbol(name, real=True) for name in names))


def free(frame: Kind, place: Any, quaternion: Any, omega: Any) -> Kind:
    """Shifted by three coordinates along its axes, and turned as `ball`: six degrees of freedom."""
    x, y, z = (_coordinate("free", frame, name) for name in _names("free: place", place, 3))
    return ball_joint(frame.moved(x, y, z), quaternion, omega)


def coincides(
    frame: MovingFrame, other: MovingFrame, at: Vector = (0, 0, 0), point: Vector = (0, 0, 0)
) -> tuple[sp.Expr, ...]:
    """Constraints that hold the point `at` of the frame on the point `point` of another: a ball joint that closes a loop.

    Components that vanish identically are left out. Raises InputError where nothing is bound.
    """
    _check_frame("coincides", other)
    apart = frame.place(vector_of("coincides: at", at, 3)) - other.place(vector_of("coincides: point", point, 3))
    return _bound("coincides", list(apart), frame)


def keeps_axis(frame: MovingFrame, other: MovingFrame, axis: Any = "z", of_other: Any = None) -> tuple[sp.Expr, ...]:
    """Constraints that hold an axis of the frame along one of another: with `coincides`, a pin that closes a loop.

    The axis has no component along two directions across that of the other; it may be opposite to it.
    """
    _check_frame("keeps_axis", other)
    mine = _direction("keeps_axis", axis)
    theirs = _direction("keeps_axis", axis if of_other is None else of_other)
    e = frame.place(list(mine)) - frame.place()
    seen = [other.place(list(v)) - other.place() for v in _axes_to(theirs)[:2]]
    return _bound("keeps_axis", [e.dot(v) for v in seen], frame)


def _check_frame(where: str, other: Any) -> None:
    if not isinstance(other, MovingFrame):
        raise InputError(f"{where}: {other!r} must be a Frame, in which the other part of the loop is fixed")


def _bound(where: str, given: Sequence[sp.Expr], frame: MovingFrame) -> tuple[sp.Expr, ...]:
    kept = tuple(e for e in map(sp.expand, given) if e != 0)
    if not any(e.free_symbols & {*frame.c.q} for e in kept):
        raise InputError(f"{where}: {', '.join(map(str, given))} = 0 binds no coordinate: give frames that move apart")
    return kept


def _about(where: str, frame: Kind, axis: Any, step: Any) -> Kind:
    """A step about z, taken about another axis: turned there before and back after it."""
    if isinstance(axis, str) and axis in ("x", "y", "z"):
        k = AXES.index(axis)
        R = sp.Matrix(3, 3, lambda i, j: int((i - j - k - 1) % 3 == 0))  # z → axis k, x and y → those after it
    else:
        R = sp.Matrix.hstack(*_axes_to(_direction(where, axis)))
    if sp.eye(3) == R:
        moved: Kind = step(frame)
        return moved
    done: Kind = step(frame.turned(R)).turned(R.T)
    return done


def _axes_to(e: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
    """Three directions of length one across each other, the last e."""
    k = min(range(3), key=lambda i: (abs(float(e[i])) if e[i].is_number else 0.5, i))
    first = sp.eye(3)[:, k] - e * e[k]
    first = first / sp.sqrt(first.dot(first))
    return first, e.cross(first), e


def _direction(where: str, axis: Any) -> sp.Matrix:
    if isinstance(axis, str):
        if axis not in ("x", "y", "z"):
            raise InputError(f"{where}: axis = {axis!r} must be 'x', 'y' or 'z', or a direction (x, y, z)")
        return sp.eye(3)[:, AXES.index(axis)]
    e = sp.Matrix(vector_of(f"{where}: axis", axis, 3))
    length = sp.sqrt(e.dot(e))
    if length.is_zero or not all(entry.is_number for entry in e):
        raise InputError(f"{where}: axis = {axis!r} must be a direction in numbers, not zero")
    return e / length


def _names(where: str, given: Any, number: int) -> list[str]:
    names = given.replace(",", " ").split() if isinstance(given, str) else given
    if not isinstance(names, Sequence) or len(names) != number:
        raise InputError(f"{where} = {given!r} must be {number} names: {' '.join(f'a{i}' for i in range(number))}")
    return [str(name) for name in names]


def _coordinate(where: str, frame: MovingFrame, name: str) -> sp.Symbol:
    known = {str(q): q for q in frame.c.q}
    if name not in known:
        raise InputError(f"{where}: {name} is none of the coordinates {', '.join(known)}: name some of these")
    return known[name]
