"""Frames that turn and move with the coordinates, the velocities of their points, and joints by name.

A frame is reached from its parent by one step: a turn about one of its axes, a shift along them, or any
rotation. With the rotation R (components in the frame → in the parent), the shift d and a dot for d/dt, in the frame's axes,

    ω = Rᵀ ω_parent + u,        v = Rᵀ (v_parent + ω_parent × d + d'),

u the rate of the turn about its axis (the axial vector of Rᵀ R'). Featherstone, Rigid Body Dynamics Algorithms, ch. 2.

Joints are such steps by name: pin, prismatic, screw, cylindrical, universal, planar, weld; ball and free, which have no pole;
`coincides` and `keeps_axis` close loops. A ball joint turns by a unit quaternion q = (q0, q1, q2, q3), scalar first. Its
velocities are the components of its angular velocity ω relative to the frame before it, in the turned axes:

    R = 1 + 2 q0 [e]× + 2 [e]×²,  e = (q1, q2, q3),        q' = ½ q ∘ (0, ω),        ω = 2 E(q) q'.

|q| = 1 is a constraint of the system; ω satisfies it by itself, so that it has no multiplier. Altmann, Rotations, Quaternions
and Double Groups (1986), ch. 12.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self, TypeVar

import sympy as sp

from lagrotor.algebra import decide_equal, decide_zero
from lagrotor.algebra.name_clashes import check_names
from lagrotor.algebra.subexpressions import with_shared_parts
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, total_derivative
from lagrotor.renamed import accept_old_keywords

Vector = Sequence[Any]
AXES = "xyz"
_NONE = sp.zeros(3, 1)
Kind = TypeVar("Kind", bound="MovingFrame")


@dataclass(frozen=True, eq=False)
class MovingFrame:
    """The ground, or a frame reached from its parent by one step; `Frame` describes the fields."""

    c: Coordinates
    parent: "MovingFrame | None" = None
    axis: int | None = None
    amount: Any = None
    quaternion: tuple[sp.Symbol, ...] = ()
    omega: tuple[sp.Symbol, ...] = ()
    name: str = ""
    base: "MovingFrame | None" = None

    def __post_init__(self) -> None:
        if not isinstance(self.c, Coordinates):
            raise InputError(f"Frame: {self.c!r} must be Coordinates: Frame(coordinates('phi theta psi'))")
        _ = self.letters

    @property
    def to_the_ground(self) -> "list[MovingFrame]":
        """The list of frames from this one to the ground, both included."""
        steps = [self]
        while (parent := steps[-1].parent) is not None:
            steps.append(parent)
        return steps

    @cached_property
    def letters(self) -> frozenset[sp.Symbol]:
        """The symbols in the steps from the ground to this frame, without those of the coordinates."""
        before = self.parent.letters if self.parent is not None else frozenset[sp.Symbol]()
        symbols = getattr(self.amount, "free_symbols", frozenset[sp.Symbol]()) - before
        new = {s: self.c._symbols.get(str(s), s) for s in symbols if self.c._symbols.get(str(s)) != s}
        check_names("Frame", before if new else (), new)
        return before.union(new) if new else before

    def __repr__(self) -> str:
        if self.parent is None:
            return "Frame(ground)"
        if self.omega:
            return f"Frame(turned by the quaternion {self.quaternion})"
        if self.axis is not None:
            return f"Frame(turned about {AXES[self.axis]} by {self.amount})"
        return f"Frame({'turned' if self.amount.cols == 3 else 'moved'} by {self.amount.tolist()})"

    def turned(self, axes: Any, angles: Any = None, name: str = "") -> Self:
        """Return a frame turned about the axes one after another.

        Parameters
        ----------
        axes : str or Matrix
            Names of axes, "zxz", each in the frame turned before; or a rotation matrix (3, 3).
        angles : Expr, str or sequence
            An angle in rad for each axis: expressions, or names of coordinates, "phi theta psi".
        name : str, default ''
            The name of the joint.

        Returns
        -------
        Frame
            The turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> Frame(coordinates("phi theta psi")).turned("zxz", "phi theta psi").angular_velocity[2]
        phi_dot*cos(theta) + psi_dot
        """
        if not isinstance(axes, str):
            return _joint("turned", self, type(self)(self.c, self, None, _rotation(axes)), name)
        split = angles.replace(",", " ").split() if isinstance(angles, str) else angles
        amounts = list(split) if isinstance(split, Sequence | sp.MatrixBase) else [split]
        if not axes or set(axes) - set(AXES) or len(amounts) != len(axes) or None in amounts:
            raise InputError(f"turned: axes {axes!r} and angles {angles!r}: give one angle for each letter of x, y, z")
        frame = self
        for letter, angle in zip(axes, amounts, strict=True):
            frame = type(self)(self.c, frame, AXES.index(letter), _amount("turned: angle", self, angle))
        return _joint("turned", self, frame, name)

    def moved(self, x: Any = 0, y: Any = 0, z: Any = 0, name: str = "") -> Self:
        """Return a frame shifted along the axes of this one.

        Parameters
        ----------
        x, y, z : Expr or str, default 0
            Lengths in m, or names of coordinates.
        name : str, default ''
            The name of the joint.

        Returns
        -------
        Frame
            The shifted frame.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> Frame(coordinates("s")).moved(z="s").place().T
        Matrix([[0, 0, s]])
        """
        if isinstance(x, Sequence | sp.MatrixBase) and not isinstance(x, str):
            raise InputError(f"moved: x, y and z are three arguments: moved({', '.join(map(str, x))})")
        shift = [_amount("moved: (x, y, z)", self, length) for length in (x, y, z)]
        return _joint("moved", self, type(self)(self.c, self, None, sp.Matrix(shift)), name)

    @cached_property
    def rotation(self) -> sp.Matrix:
        """The rotation R (3, 3) from components in this frame to components in the parent."""
        if self.axis is not None:
            return turn_matrix(self.axis, self.amount)
        return self.amount if self.parent is not None and self.amount.cols == 3 else sp.eye(3)

    @property
    def shift(self) -> sp.Matrix:
        """The shift d (3, 1) from the parent's origin to this one, in the parent's axes."""
        shifted = self.parent is not None and self.axis is None and self.amount.cols == 1
        return self.amount if shifted else sp.zeros(3, 1)

    @property
    def turn_rate(self) -> sp.Matrix:
        """The angular velocity u (3, 1) relative to the parent, in the axes of this frame, 1/s."""
        if self.axis is not None:
            return sp.eye(3)[:, self.axis] * total_derivative(self.amount, self.c)
        if self.omega:
            return sp.Matrix(list(self.ball_velocities.values()))
        R = self.rotation
        spin = R.T * R.applyfunc(lambda e: total_derivative(e, self.c))
        return sp.Matrix([spin[2, 1], spin[0, 2], spin[1, 0]])

    @cached_property
    def ball_velocities(self) -> dict[sp.Symbol, sp.Expr]:
        """The angular velocities ω = 2 E(q) q' of a ball joint by symbol; empty for any other step."""
        if not self.omega:
            return {}
        rates = [self.c.v[self.c.q.index(q)] for q in self.quaternion]
        rows = zip(self.omega, quaternion_rows(*self.quaternion), strict=True)
        return {w: 2 * sp.Add(*map(sp.Mul, row, rates)) for w, row in rows}

    @property
    def unit_length(self) -> sp.Expr:
        """The expression |q|² − 1 of a ball joint, which stays zero."""
        return sp.Add(*(q**2 for q in self.quaternion), -1)

    @cached_property
    def angular_velocity(self) -> sp.Matrix:
        """The angular velocity ω (3, 1), in the axes of this frame, 1/s."""
        if self.parent is None:
            return sp.zeros(3, 1)
        carried = Small.of(self.rotation).T * Small.of(self.parent.angular_velocity)
        return (carried + Small.of(self.turn_rate)).each(with_shared_parts).matrix

    @cached_property
    def origin_velocity(self) -> sp.Matrix:
        """The velocity v (3, 1) of the origin, in the axes of this frame, m/s."""
        if self.parent is None:
            return sp.zeros(3, 1)
        d = Small.of(self.shift)
        carried = Small.of(self.parent.angular_velocity).cross(d) + d.each(lambda e: total_derivative(e, self.c))
        v = Small.of(self.rotation).T * (Small.of(self.parent.origin_velocity) + carried)
        return v.each(with_shared_parts).matrix

    @accept_old_keywords
    def place(self, point: Vector = (0, 0, 0), frame: "MovingFrame | None" = None) -> sp.Matrix:
        """Return the position of a point of this frame.

        Parameters
        ----------
        point : sequence, default (0, 0, 0)
            Components (x, y, z) in this frame, in m.
        frame : Frame or None, optional
            A frame before this one, by default the ground: the result is relative to its origin, in its axes.

        Returns
        -------
        Matrix
            The position, shape (3, 1), in m.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> Frame(coordinates("theta")).pin("theta").place((1, 0, 0)).T
        Matrix([[cos(theta), sin(theta), 0]])
        """
        position = Small.column(*vector_of("place: point", point, 3))
        step, end = self, None if frame is None else self._step("place", frame)
        while step is not end and step.parent is not None:
            position = (Small.of(step.rotation) * position + Small.of(step.shift)).each(with_shared_parts)
            step = step.parent
        return position.matrix

    @accept_old_keywords
    def velocity(self, point: Vector = (0, 0, 0), frame: "MovingFrame | None" = None) -> sp.Matrix:
        """Return the velocity relative to the ground of a point that moves with this frame.

        Parameters
        ----------
        point : sequence, default (0, 0, 0)
            The present components (x, y, z) of the point in `frame`, in m.
        frame : Frame or None, optional
            The frame whose axes are used: this one, or one before it. For a wheel's point of contact the axle's frame is
            handy.

        Returns
        -------
        Matrix
            The velocity in the axes of `frame`, shape (3, 1), in m/s.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> Frame(coordinates("theta")).pin("theta").velocity((1, 0, 0)).T
        Matrix([[0, theta_dot, 0]])
        """
        at, axes = Small.column(*vector_of("velocity: point", point, 3)), self._step("velocity", frame or self)
        _, spin, origin, drift = (Small.of(e) for e in self._relative(axes))
        carried = Small.of(axes.origin_velocity) + Small.of(axes.angular_velocity).cross(at)
        return (carried + drift + spin.cross(at - origin)).matrix

    def _step(self, where: str, frame: Any) -> "MovingFrame":
        """Return one of the frames from this one to the ground; Frame(c) is the ground."""
        steps = self.to_the_ground
        if isinstance(frame, MovingFrame) and frame.parent is None and frame.c == self.c:
            return steps[-1]
        if frame not in steps:
            raise InputError(f"{where}: frame = {frame!r} must be a frame from which this one was turned or moved")
        return next(step for step in steps if step is frame)

    def _relative(self, frame: "MovingFrame") -> tuple[sp.Matrix, sp.Matrix, sp.Matrix, sp.Matrix]:
        """Return the rotation, ω, the origin and its velocity relative to another frame, along the axes of the other frame."""
        steps = self.to_the_ground
        R, spin, origin, drift = sp.eye(3), sp.zeros(3, 1), sp.zeros(3, 1), sp.zeros(3, 1)
        for step in reversed(steps[: steps.index(frame)]):
            drift += spin.cross(R * step.shift) + R * step.shift.applyfunc(lambda e: total_derivative(e, self.c))
            origin += R * step.shift
            parent_axes, R = R, R * step.rotation
            spin += (R if step.axis is None else parent_axes) * step.turn_rate  # a turn keeps its axis
        return R, spin, origin, drift


def in_ground(frame: MovingFrame) -> tuple[sp.Matrix, sp.Matrix]:
    """Return the rotation matrix of a frame into the ground's axes, and its ω in these axes, shapes (3, 3) and (3, 1)."""
    return frame._relative(frame.to_the_ground[-1])[:2]


def quaternion_rows(a: Any, b: Any, c: Any, d: Any) -> tuple[tuple[Any, ...], ...]:
    """Return E (3, 4) of a unit quaternion, with ω = 2 E q' and q' = ½ Eᵀ ω."""
    return (-b, a, d, -c), (-c, -d, a, b), (-d, c, -b, a)


def turn_matrix(axis: int, angle: sp.Expr) -> sp.Matrix:
    """Return the rotation by an angle about axis 0, 1 or 2, from components in the turned frame."""
    c, s = sp.cos(angle), sp.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = sp.eye(3)
    R[i, i], R[j, j], R[i, j], R[j, i] = c, c, -s, s
    return R


def _amount(where: str, frame: MovingFrame, amount: Any) -> sp.Expr:
    """Return the coordinate if `amount` is its name, else `amount` as an expression."""
    return _coordinate(where, frame, amount) if isinstance(amount, str) else expression(where, amount)


def _rotation(matrix: Any) -> sp.Matrix:
    try:
        R = sp.Matrix(matrix)
    except (TypeError, ValueError):
        raise InputError(
            f"turned: {matrix!r} is neither letters of x, y, z nor a rotation matrix (3, 3): give one"
        ) from None
    if R.shape != (3, 3) or decide_equal(R * R.T, sp.eye(3)).answer == "nonzero":
        raise InputError("turned: a rotation must be a matrix (3, 3) with R Rᵀ = 1; correct this one")
    if decide_zero(R.det(method="berkowitz") - 1).answer == "nonzero":
        raise InputError("turned: this matrix has R Rᵀ = 1 and det R = −1: it reflects; change the sign of one axis")
    return R


def _joint(where: str, base: MovingFrame, frame: Kind, name: str) -> Kind:
    """Return the last frame of a joint, which knows the frame `base` before the joint, and the joint's name."""
    if not isinstance(name, str) or name != name.strip():
        raise InputError(f"{where}: name = {name!r} must be a text without blanks around it")
    return replace(frame, name=name, base=base)


def weld(frame: Kind, at: Vector, axes: str, angles: Any, name: str = "") -> Kind:
    """Fix a frame to another: `Frame.weld`."""
    place = vector_of("weld: at", at, 3)
    turns = angles if isinstance(angles, Sequence | sp.MatrixBase) and not isinstance(angles, str) else [angles]
    amounts = [expression("weld: angle", e) for e in turns]
    moving = set().union(*(e.free_symbols for e in (*place, *amounts))) & {*frame.c.q, *frame.c.v}
    if moving:
        raise InputError(
            f"weld: {', '.join(sorted(map(str, moving)))} moves the frame, but a weld is fixed: take a joint that moves"
        )
    shifted = frame.moved(*place)
    return _joint("weld", frame, shifted.turned(axes, amounts) if axes or amounts else shifted, name)


def pin(frame: Kind, angle: Any, axis: Any, name: str = "") -> Kind:
    """Turn a frame about an axis: `Frame.pin`."""
    turn = _amount("pin: angle", frame, angle)
    return _about("pin", frame, axis, lambda it: it.turned("z", turn), name)


def prismatic(frame: Kind, length: Any, axis: Any, name: str = "") -> Kind:
    """Shift a frame along an axis: `Frame.prismatic`."""
    x, y, z = _direction("prismatic", axis) * _amount("prismatic: length", frame, length)
    return frame.moved(x, y, z, name)


def cylindrical(frame: Kind, length: Any, angle: Any, axis: Any, name: str = "") -> Kind:
    """Shift a frame along an axis and turn it about it: `Frame.cylindrical`."""
    return _about("cylindrical", frame, axis, lambda it: it.moved(0, 0, length).turned("z", angle), name)


def screw(frame: Kind, angle: Any, pitch: Any, axis: Any, name: str = "") -> Kind:
    """Turn a frame about an axis along which it advances: `Frame.screw`."""
    turn = _amount("screw: angle", frame, angle)
    advance = expression("screw: pitch", pitch) * turn / (2 * sp.pi)
    return _about("screw", frame, axis, lambda it: it.moved(0, 0, advance).turned("z", turn), name)


def universal(frame: Kind, first: Any, second: Any, axes: str, name: str = "") -> Kind:
    """Turn a frame about two of its axes: `Frame.universal`."""
    if not isinstance(axes, str) or len(axes) != 2 or len({*axes}) != 2 or {*axes} - {*AXES}:
        raise InputError(f"universal: axes {axes!r} must be two different letters of x, y, z")
    return frame.turned(axes, [first, second], name)


def planar(frame: Kind, x: Any, y: Any, angle: Any, normal: Any, name: str = "") -> Kind:
    """Shift a frame in a plane and turn it about the normal: `Frame.planar`."""
    return _about("planar", frame, normal, lambda it: it.moved(x, y, 0).turned("z", angle), name)


def ball_joint(frame: Kind, quaternion: Any, omega: Any, name: str = "") -> Kind:
    """Turn a frame by a unit quaternion: `Frame.ball`."""
    q = tuple(_coordinate("ball", frame, name) for name in _names("ball: quaternion", quaternion, 4))
    w = [s if isinstance(s, sp.Symbol) else sp.Symbol(s, real=True) for s in _names("ball: omega", omega, 3)]
    names = {*map(str, w)}
    if len({*q}) < 4 or len(names) < 3 or names & frame.c._symbols.keys():
        raise InputError(
            f"ball: quaternion {quaternion!r} and omega {omega!r}: give seven different names, and for omega none of a "
            "coordinate"
        )
    if shared := [str(s) for step in frame.to_the_ground for s in {*step.quaternion} & {*q}]:
        raise InputError(
            f"ball: {shared[0]} turns another ball joint on the way: give each four coordinates of its own"
        )
    a, b, c, d = q
    R = sp.Matrix(
        [
            [1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)],
        ]
    )
    step = type(frame)(frame.c, frame, None, R)
    return _joint("ball", frame, replace(step, quaternion=q, omega=tuple(w)), name)


def free(frame: Kind, place: Any, quaternion: Any, omega: Any, name: str = "") -> Kind:
    """Shift a frame by three coordinates and turn it by a quaternion: `Frame.free`."""
    x, y, z = (_coordinate("free", frame, name) for name in _names("free: place", place, 3))
    return _joint("free", frame, ball_joint(frame.moved(x, y, z), quaternion, omega), name)


@dataclass(frozen=True, eq=False)
class Load:
    """A force at a point of a frame, and a torque on that frame, with components along the axes of the frame `axes`."""

    frame: MovingFrame
    at: Sequence[Any]
    force: Sequence[Any]
    torque: Sequence[Any]
    axes: MovingFrame

    def each(self, function: Callable[[Any], Any]) -> "Load":
        """Apply a function to every component of the force and of the torque."""
        return replace(self, force=tuple(map(function, self.force)), torque=tuple(map(function, self.torque)))


@dataclass(frozen=True, eq=False)
class Source:
    """The loads by which a constraint acts on frames if its multiplier is 1, and the name of the joint that it belongs to."""

    name: str
    loads: tuple[Load, ...]


def coincides(
    first: MovingFrame, second: MovingFrame, at: Vector, point: Vector, name: str = ""
) -> tuple[sp.Expr, ...]:
    """Return the constraints that hold two points together: `Frame.coincides`."""
    _check_frame("coincides", second)
    places = vector_of("coincides: at", at, 3), vector_of("coincides: point", point, 3)
    apart = first.place(places[0]) - second.place(places[1])
    ends, directions = tuple(zip((first, second), places, strict=True)), sp.eye(3)
    return _constraints("coincides", list(apart), ends, [(directions[:, k], _NONE) for k in range(3)], name)


def keeps_axis(
    first: MovingFrame, second: MovingFrame, axis: Any, second_axis: Any, name: str = ""
) -> tuple[sp.Expr, ...]:
    """Return the constraints that hold two axes parallel: `Frame.keeps_axis`."""
    _check_frame("keeps_axis", second)
    theirs = _direction("keeps_axis", axis if second_axis is None else second_axis)
    e = first.place(list(_direction("keeps_axis", axis))) - first.place()
    transverse = [second.place(list(v)) - second.place() for v in _axes_to(theirs)[:2]]
    ends, turning = ((first, _NONE), (second, _NONE)), [(_NONE, e.cross(v)) for v in transverse]
    return _constraints("keeps_axis", [e.dot(v) for v in transverse], ends, turning, name)


def _check_frame(where: str, frame: Any) -> None:
    if not isinstance(frame, MovingFrame):
        raise InputError(f"{where}: {frame!r} must be a Frame, in which the other part of the loop is fixed")


def _constraints(
    where: str, components: Sequence[sp.Expr], ends: Sequence[Any], actions: Sequence[Any], name: str
) -> tuple[sp.Expr, ...]:
    """Return the components without those that vanish identically; raise InputError if none depends on a coordinate.

    `ends` are the two frames with their points. `actions` are the force and torque of each component on the first frame, in
    the ground's axes, for a multiplier of 1; the second frame gets the opposite.
    """
    c, ground = ends[0][0].c, ends[0][0].to_the_ground[-1]
    acting = [(g, action) for e, action in zip(components, actions, strict=True) if (g := sp.expand(e)) != 0]
    if not any(g.free_symbols & {*c.q} for g, _ in acting):
        raise InputError(
            f"{where}: {', '.join(map(str, components))} = 0 binds no coordinate: give frames that move apart"
        )
    for g, (force, torque) in acting:
        signs = zip(ends, (1, -1), strict=True)
        loads = tuple(Load(frame, at, force * sign, torque * sign, ground) for (frame, at), sign in signs)
        c.sources.setdefault(g, []).append(Source(name, loads))
    return tuple(g for g, _ in acting)


def _about(where: str, frame: Kind, axis: Any, step: Any, name: str) -> Kind:
    """Apply `step`, a function that turns or shifts a frame along its z axis, along another axis instead."""
    if isinstance(axis, str) and axis in ("x", "y", "z"):
        k = AXES.index(axis)
        R = sp.Matrix(3, 3, lambda i, j: int((i - j - k - 1) % 3 == 0))  # z → axis k, x and y → those after it
    else:
        R = sp.Matrix.hstack(*_axes_to(_direction(where, axis)))
    if sp.eye(3) == R:
        return _joint(where, frame, step(frame), name)
    return _joint(where, frame, step(frame.turned(R)).turned(R.T), name)


def _axes_to(e: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
    """Return three orthonormal directions, the last of them e."""
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


def _names(where: str, names: Any, number: int) -> list[str | sp.Symbol]:
    """Return a list of names or symbols from a text or a sequence; raise InputError unless there are `number` of them."""
    listed = names.replace(",", " ").split() if isinstance(names, str) else names
    if (
        not isinstance(listed, Sequence)
        or len(listed) != number
        or not all(isinstance(s, str | sp.Symbol) for s in listed)
    ):
        raise InputError(f"{where} = {names!r} must be {number} names: {' '.join(f'a{i}' for i in range(number))}")
    return list(listed)


def _coordinate(where: str, frame: MovingFrame, name: str | sp.Symbol) -> sp.Symbol:
    q = frame.c._symbols.get(str(name))
    if q not in frame.c.q:
        raise InputError(
            f"{where}: {name} is none of the coordinates {', '.join(map(str, frame.c.q))}: name some of these"
        )
    return q
