"""Rigid bodies, and energies that remember the bodies of which they are made.

    T = ½ m |v|² + ½ ω·I ω,        V = −m g·r      (g a uniform field, r the place of the centre).

A sum of such energies and of expressions is a Lagrangian, which every function of sympy takes as an expression. From the
bodies System makes a tree, for faster code and for the picture.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self
from warnings import warn

import sympy as sp
from mpmath import mp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies import force_elements, moving_frames
from lagrotor.mechanics.bodies.contacts import Contact, contact
from lagrotor.mechanics.bodies.moving_frames import MovingFrame, Vector
from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import t
from lagrotor.result_display import text_of

Outline = list[list[Any]]  # points (x, y, z) of lines, in the body's frame
_ARCS = 32  # chords of a drawn rim
_ROUNDING = 1e-9  # relative, of an inertia


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body in a frame, with mass in kg, inertia (3, 3) about its centre of mass in kg m², and that centre in m."""

    frame: MovingFrame
    mass: sp.Expr
    inertia: sp.Matrix
    centre: sp.Matrix

    def __repr__(self) -> str:
        return f"Body(mass {self.mass}, inertia {self.inertia.tolist()}, centre {list(self.centre)}, {self.frame})"

    @property
    def velocity(self) -> sp.Matrix:
        """The velocity (3, 1) of the centre of mass, in the frame's axes, m/s."""
        return self.frame.velocity(self.centre)

    @property
    def kinetic(self) -> "Energy":
        """The kinetic energy ½ m |v|² + ½ ω·I ω, in J."""
        return Energy(((self, None, sp.S.One),))

    def potential(self, field: Vector) -> "Energy":
        """Return the potential energy −m g·r in J, for a uniform field g in the ground's axes: (0, 0, −g) if z points up."""
        return Energy(((self, vector_of("potential: field", field, 3), sp.S.One),))

    def rolls_on(self, surface: Any, radius: Any, axis: Vector | None = None, centre: Vector | None = None) -> Contact:
        """Return the contact of a ball, or of a thin disc about an axis, with a Plane, a Sphere or a Cylinder.

        `axis` and `centre`, by default the centre of mass, are in the frame's axes.
        """
        return contact(self.frame, surface, radius, axis, list(self.centre) if centre is None else centre)

    @property
    def outline(self) -> Outline:
        """The lines of a picture: from the frame's origin to the centre, and a rim with the axial radius of gyration.

        Without either they are lines along the axes. A body with inertia about one axis alone is a uniform rod on the line
        through origin and centre.
        """
        lines: Outline = [[[0, 0, 0], list(self.centre)]] if any(self.centre) else []
        I = [self.inertia[i, i] for i in range(3)]
        if lines and sum(x != 0 for x in I) == 1:
            half = self.centre * sp.sqrt(3 * sum(I) / self.mass) / self.centre.norm()
            return [*lines, [list(self.centre - half), list(self.centre + half)]]
        axis = next((k for k in (2, 1, 0) if I[k - 2] == I[k - 1] and I[k]), None)
        if axis is not None:
            radius, rim = sp.sqrt(I[axis] / self.mass), []
            for k in range(_ARCS + 1):
                point = list(self.centre)
                point[axis - 2] += radius * sp.cos(2 * sp.pi * k / _ARCS)
                point[axis - 1] += radius * sp.sin(2 * sp.pi * k / _ARCS)
                rim.append(point)
            lines.append([list(self.centre), *rim])
        if not lines and any(I):
            for k in range(3):
                reach = sp.sqrt(sp.Abs(sum(I) / 2 - I[k]) / self.mass)  # root mean square of the body along axis k
                lines.append([[sign * reach * int(i == k) for i in range(3)] for sign in (-1, 1)])
        return lines or [[[0, 0, 0], [0, 0, 0]]]


def make_body(frame: MovingFrame, mass: Any, inertia: Any, centre: Vector) -> Body:
    """Fix a rigid body to a frame: `Frame.body`."""
    try:
        I = sp.diag(*inertia) if sp.Matrix(inertia).shape in ((3, 1), (1, 3)) else sp.Matrix(inertia)
        place = sp.Matrix(list(centre))
    except (TypeError, ValueError):
        raise InputError(f"body: inertia = {inertia!r}, centre = {centre!r}: give (I1, I2, I3) and (x, y, z)") from None
    if I.shape != (3, 3) or place.shape != (3, 1) or decide_equal(I, I.T).answer == "nonzero":
        raise InputError(
            f"body: inertia = {inertia!r} must be (I1, I2, I3) or a symmetric (3, 3), and the centre (x, y, z)"
        )
    I = sp.Matrix(3, 3, lambda i, j: I[min(i, j), max(i, j)])  # symmetric also as expressions
    m = expression("body: mass", mass)
    if used := (m.free_symbols | I.free_symbols | place.free_symbols) & {*frame.c.q, *frame.c.v, t}:
        raise InputError(
            f"body: {', '.join(sorted(map(str, used)))} in a rigid body: its mass, inertia and centre are fixed; move its "
            "frame, and describe a changing mass by forces"
        )
    body = Body(frame, m, I, place)
    check_body("body", body)
    return body


def check_body(where: str, body: Body, values: Mapping[sp.Symbol, Any] | None = None) -> None:
    """Raise InputError if no body can have that mass and inertia: m ≥ 0, and ½ tr I − I = ∫ r rᵀ dm ≥ 0.

    For principal inertias the second condition is I1 ≤ I2 + I3 and its permutations. Inertia about one axis alone is allowed,
    for motion in a plane. Symbols without a number are not checked.
    """
    mass, I = (e.xreplace(dict(values or {})) for e in (body.mass, body.inertia))
    if mass.is_negative:
        raise InputError(f"{where}: mass = {mass} must not be negative: give 0 or more")
    if any(I[i, i].is_negative for i in range(3)):
        raise InputError(f"{where}: inertia = {I.tolist()} must not be negative about an axis")
    if I.free_symbols or sum(e != 0 for e in I) == sum(I[i, i] != 0 for i in range(3)) == 1:
        return
    spread = mp.eigsy(mp.matrix((sp.eye(3) * I.trace() / 2 - I).evalf().tolist()), eigvals_only=True)
    if min(spread) < -_ROUNDING * max(map(abs, spread)):
        entries = [[float(e) for e in row] for row in I.tolist()]
        raise InputError(
            f"{where}: no body has the inertia {entries}: of its principal inertias none is larger than the two others "
            "together; correct it"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Frame(MovingFrame):
    """A frame of a mechanism; Frame(c) is the ground.

    `turned`, `moved` and the joints lead to other frames. Vectors, points and axes that a method takes are in the axes of
    the frame that it belongs to. Angles and lengths are expressions, or names of coordinates; an axis is "x", "y" or "z", or
    a direction (x, y, z).

    Attributes
    ----------
    c : Coordinates
        The coordinates of the system.
    parent : Frame or None
        The frame before the step; None for the ground.
    axis : int or None
    amount : Expr or Matrix
        The step from the parent. For a turn, `axis` is 0, 1 or 2 and `amount` the angle in rad. If `axis` is None, `amount`
        is a shift (3, 1) in m or a rotation matrix (3, 3).
    quaternion : tuple of Symbol
    omega : tuple of Symbol
        The coordinates, scalar first, and the angular velocities of a ball joint.
    name : str
        The name of the joint that leads to this frame; "" if it was given none.
    base : Frame or None
        The frame before that joint.

    Examples
    --------
    >>> from sympy import symbols
    >>> from lagrotor.mechanics import System, coordinates
    >>> m, g, l, I1, I3 = symbols("m g l I1 I3", positive=True)
    >>> c = coordinates("phi theta psi")
    >>> top = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    >>> System(c, top.kinetic - top.potential((0, 0, -g))).cyclic
    (phi, psi)
    """

    def body(self, mass: Any, inertia: Any = (0, 0, 0), centre: Vector = (0, 0, 0)) -> Body:
        """Fix a rigid body to this frame.

        Parameters
        ----------
        mass : Expr
            The mass in kg.
        inertia : sequence or Matrix, default (0, 0, 0)
            The principal inertias (I1, I2, I3) or the inertia (3, 3) about the centre of mass, in kg m².
        centre : sequence, default (0, 0, 0)
            The centre of mass (x, y, z), in m.

        Returns
        -------
        Body
            The body with its energies.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("theta")).pin("theta").body(mass=2, centre=(3, 0, 0)).kinetic.expression
        9*theta_dot**2
        """
        return make_body(self, mass, inertia, centre)

    def force(self, components: Vector, at: Vector = (0, 0, 0), axes: MovingFrame | str = "frame") -> sp.Matrix:
        """Return the generalised forces of a force that acts at a point of this frame.

        Parameters
        ----------
        components : sequence
            The force (x, y, z), in N.
        at : sequence, default (0, 0, 0)
            The point in this frame, in m.
        axes : str or Frame, default 'frame'
            The axes of the components: "frame" for this frame, "ground", or another frame.

        Returns
        -------
        Matrix
            Q for `forces`, shape (n, 1).

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> rod = Frame(coordinates("theta")).pin("theta")
        >>> rod.force((0, 5, 0), at=(2, 0, 0)), rod.force((0, 5, 0), at=(2, 0, 0), axes="ground")
        (Matrix([[10]]), Matrix([[10*cos(theta)]]))
        """
        return force_elements.force(self, components, at, axes)

    def push(self, force: Vector, at: Vector = (0, 0, 0)) -> sp.Matrix:
        """Return the generalised forces of a force in the ground's axes: the old form of `force` with axes="ground".

        Parameters
        ----------
        force, at : sequence
            The force in the ground's axes and the point in this frame.

        Returns
        -------
        Matrix
            Q, shape (n, 1).
        """
        warn("Frame.push(F, at) is now Frame.force(F, at, axes='ground')", DeprecationWarning, stacklevel=2)
        return force_elements.force(self, force, at, "ground")

    def torque(
        self, moment: Vector, against: MovingFrame | None = None, axes: MovingFrame | str = "frame"
    ) -> sp.Matrix:
        """Return the generalised forces of a torque on this frame.

        Parameters
        ----------
        moment : sequence
            The torque (x, y, z), in N m.
        against : Frame or None, optional
            The frame on which the reaction acts; by default the ground.
        axes : str or Frame, default 'frame'
            The axes of the components: "frame" for this frame, "ground", or another frame.

        Returns
        -------
        Matrix
            Q for `forces`, shape (n, 1).

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> arm = Frame(coordinates("phi theta")).pin("phi")
        >>> arm.pin("theta").torque((0, 0, 3), against=arm).T
        Matrix([[0, 3]])
        """
        return force_elements.torque(self, moment, against, axes)

    def weld(self, at: Vector = (0, 0, 0), axes: str = "", angles: Any = (), name: str = "") -> Self:
        """Return a frame fixed to this one.

        Parameters
        ----------
        at : sequence, default (0, 0, 0)
            The origin, in m.
        axes, angles, name : str, sequence and str
            Axes of turns, one after another, fixed angles in rad, and the name of the joint.

        Returns
        -------
        Frame
            The fixed frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("theta")).pin("theta").weld((0, 2, 0)).place().T
        Matrix([[-2*sin(theta), 2*cos(theta), 0]])
        """
        return moving_frames.weld(self, at, axes, angles, name)

    def pin(self, angle: Any, axis: Any = "z", name: str = "") -> Self:
        """Return a frame turned by an angle about an axis.

        Parameters
        ----------
        angle, axis, name : Expr or str
            The angle in rad, the axis, and the name of the joint.

        Returns
        -------
        Frame
            The turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("theta")).pin("theta", "x").angular_velocity.T
        Matrix([[theta_dot, 0, 0]])
        """
        return moving_frames.pin(self, angle, axis, name)

    def prismatic(self, length: Any, axis: Any = "z", name: str = "") -> Self:
        """Return a frame shifted along an axis.

        Parameters
        ----------
        length, axis, name : Expr or str
            The length in m, the axis, and the name of the joint.

        Returns
        -------
        Frame
            The shifted frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("s")).prismatic("s", (3, 4, 0)).place().T
        Matrix([[3*s/5, 4*s/5, 0]])
        """
        return moving_frames.prismatic(self, length, axis, name)

    def screw(self, angle: Any, pitch: Any, axis: Any = "z", name: str = "") -> Self:
        """Return a frame that advances along an axis as it turns about it.

        Parameters
        ----------
        angle, pitch, axis, name : Expr or str
            The angle in rad, the advance in m for each turn of 2 π, the axis, and the name of the joint.

        Returns
        -------
        Frame
            The turned and shifted frame.

        Examples
        --------
        >>> from sympy import pi
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("theta")).screw("theta", 2 * pi).place().T
        Matrix([[0, 0, theta]])
        """
        return moving_frames.screw(self, angle, pitch, axis, name)

    def cylindrical(self, length: Any, angle: Any, axis: Any = "z", name: str = "") -> Self:
        """Return a frame shifted along an axis and turned about it.

        Parameters
        ----------
        length, angle, axis, name : Expr or str
            The length in m, the angle in rad, the axis, and the name of the joint.

        Returns
        -------
        Frame
            The shifted and turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("s theta")).cylindrical("s", "theta").place((1, 0, 0)).T
        Matrix([[cos(theta), sin(theta), s]])
        """
        return moving_frames.cylindrical(self, length, angle, axis, name)

    def universal(self, first: Any, second: Any, axes: str = "xy", name: str = "") -> Self:
        """Return a frame turned about one axis and then about another, by a Cardan or Hooke joint.

        Parameters
        ----------
        first, second, axes, name : Expr or str
            The angles in rad, two different axes, and the name of the joint.

        Returns
        -------
        Frame
            The turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("alpha beta")).universal("alpha", "beta").angular_velocity.T
        Matrix([[alpha_dot*cos(beta), beta_dot, alpha_dot*sin(beta)]])
        """
        return moving_frames.universal(self, first, second, axes, name)

    def planar(self, x: Any, y: Any, angle: Any, normal: Any = "z", name: str = "") -> Self:
        """Return a frame shifted in a plane and turned about its normal.

        Parameters
        ----------
        x, y, angle, normal, name : Expr or str
            The shifts in m, the angle in rad, the axis normal to the plane, and the name of the joint.

        Returns
        -------
        Frame
            The shifted and turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("x y theta")).planar("x", "y", "theta").place((1, 0, 0)).T
        Matrix([[x + cos(theta), y + sin(theta), 0]])
        """
        return moving_frames.planar(self, x, y, angle, normal, name)

    def ball(self, quaternion: Any, omega: Any, name: str = "") -> Self:
        """Return a frame turned by a unit quaternion, which has no pole.

        Parameters
        ----------
        quaternion : str or sequence
            Four coordinates or their names, scalar first.
        omega : str or sequence
            Three new symbols or their names: the angular velocities about the axes of the turned frame. In the system they
            replace the velocities of the four coordinates.
        name : str, default ''
            The name of the joint.

        Returns
        -------
        Frame
            The turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("a b c d")
        >>> gyro = Frame(c).ball("a b c d", "u v w").body(mass=1, inertia=(2, 2, 3))
        >>> System(c, gyro.kinetic).speeds
        (u, v, w)
        """
        return moving_frames.ball_joint(self, quaternion, omega, name)

    def free(self, place: Any, quaternion: Any, omega: Any, name: str = "") -> Self:
        """Return a frame shifted along the axes and turned by a unit quaternion: six degrees of freedom.

        Parameters
        ----------
        place : str or sequence
            Three coordinates or their names.
        quaternion, omega : str or sequence
            Four coordinates, and three new symbols of angular velocities: see `ball`.
        name : str, default ''
            The name of the joint.

        Returns
        -------
        Frame
            The shifted and turned frame.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> Frame(coordinates("x y z a b c d")).free("x y z", "a b c d", "u v w").place().T
        Matrix([[x, y, z]])
        """
        return moving_frames.free(self, place, quaternion, omega, name)

    def coincides(
        self, other: MovingFrame, at: Vector = (0, 0, 0), point: Vector = (0, 0, 0), name: str = ""
    ) -> tuple[sp.Expr, ...]:
        """Return the constraints that hold a point of this frame on a point of another: a ball joint that closes a loop.

        Parameters
        ----------
        other : Frame
            The other frame.
        at, point : sequence, default (0, 0, 0)
            The points in this frame and in the other, in m.
        name : str, default ''
            The name of the joint that closes the loop.

        Returns
        -------
        tuple of Expr
            Expressions that stay zero, without those that vanish identically.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> ground = Frame(coordinates("theta s"))
        >>> ground.pin("theta").coincides(ground.prismatic("s", "x"), at=(2, 0, 0))
        (-s + 2*cos(theta), 2*sin(theta))
        """
        return moving_frames.coincides(self, other, at, point, name)

    def keeps_axis(
        self, other: MovingFrame, axis: Any = "z", other_axis: Any = None, name: str = ""
    ) -> tuple[sp.Expr, ...]:
        """Return the constraints that hold an axis of this frame parallel to one of another.

        With `coincides` they are a pin that closes a loop. The axes may be opposite to each other.

        Parameters
        ----------
        other : Frame
            The other frame.
        axis, other_axis : str or sequence
            The axes of this frame and of the other, by default "z" and the same.
        name : str, default ''
            The name of the joint that closes the loop, as in `coincides`.

        Returns
        -------
        tuple of Expr
            Expressions that stay zero, without those that vanish identically.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> ground = Frame(coordinates("alpha"))
        >>> ground.pin("alpha", "x").keeps_axis(ground)
        (-sin(alpha),)
        """
        return moving_frames.keeps_axis(self, other, axis, other_axis, name)


@dataclass(frozen=True)
class Energy:
    """A sum of energies of bodies, each times a factor, plus an expression.

    A term is (body, field, factor): the potential energy in that field, or the kinetic energy if field is None.
    """

    terms: tuple[tuple[Body, tuple[sp.Expr, ...] | None, sp.Expr], ...]
    remainder: sp.Expr = sp.S.Zero

    _op_priority = 100.0  # sympy leaves + and − to this class

    def __repr__(self) -> str:
        return f"Energy(bodies={len(self.bodies)}, remainder={self.remainder})"

    def __str__(self) -> str:
        return text_of(self.expression)

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The bodies in the sum, each of them once."""
        return tuple(dict.fromkeys(body for body, _, _ in self.terms))

    @cached_property
    def expression(self) -> sp.Expr:
        """The energy in q, v and t."""
        return sp.Add(self.remainder, *(factor * _value(body, field) for body, field, factor in self.terms))

    @cached_property
    def parts(self) -> tuple[sp.Expr, ...]:
        """The expressions in the energies: masses, inertias, centres, fields, factors, and the steps of the frames."""
        parts, frames = dict[sp.Expr, None](), set[MovingFrame]()
        for body, field, factor in self.terms:
            parts |= dict.fromkeys((body.mass, *body.inertia, *body.centre, *(field or ()), factor))
            frame: MovingFrame | None = body.frame
            while frame is not None and frame.parent is not None and frame not in frames:
                frames.add(frame)
                parts |= dict.fromkeys([frame.amount] if frame.axis is not None else frame.amount)
                frame = frame.parent
        return tuple(parts)

    @cached_property
    def free_symbols(self) -> set[sp.Basic]:
        """The symbols of the energy without the velocities."""
        return self.remainder.free_symbols.union(*(e.free_symbols for e in self.parts))

    def _sympy_(self) -> sp.Expr:
        return self.expression

    def xreplace(self, replacements: Mapping[sp.Basic, sp.Basic]) -> "Energy":
        """Return the energy with symbols replaced in its expression, not in the bodies."""
        return replace(self, remainder=self.remainder.xreplace(replacements))

    def __add__(self, other: Any) -> "Energy":
        if isinstance(other, Energy):
            return Energy(self.terms + other.terms, self.remainder + other.remainder)
        return Energy(self.terms, self.remainder + expression("Energy: a summand", other))

    def __mul__(self, factor: Any) -> "Energy":
        number = expression("Energy: a factor", factor)
        return Energy(tuple((body, field, number * f) for body, field, f in self.terms), number * self.remainder)

    def __neg__(self) -> "Energy":
        return self * -1

    def __sub__(self, other: Any) -> "Energy":
        return self + (-other)

    def __rsub__(self, other: Any) -> "Energy":
        return -self + other

    def __truediv__(self, factor: Any) -> "Energy":
        return self * (1 / expression("Energy: a divisor", factor))

    __radd__, __rmul__ = __add__, __mul__


def _value(body: Body, field: tuple[sp.Expr, ...] | None) -> sp.Expr:
    if field is not None:
        return -body.mass * Small.column(*field).dot(Small.of(body.frame.place(body.centre)))
    v, w = Small.of(body.velocity), Small.of(body.frame.angular_velocity)
    return body.mass * v.dot(v) / 2 + w.dot(Small.of(body.inertia) * w) / 2
