"""Springs, dampers, actuators and loads on bodies as generalised forces, by virtual work.

A force F along a path of length ℓ(q, t) does the work F δℓ, so Q = F ∂ℓ/∂q, and a positive F pushes the ends apart. A force
F at a point r gives Q = (∂r/∂q)ᵀ F, a torque T between frames Q = (∂(ω − ω')/∂v)ᵀ T. The shortest path round a cylinder is
straight on the unrolled surface: two tangents and an arc across the axis, which rises in proportion to the length.

Moore, Learn Multibody Dynamics, chs. 12, 13; Rayleigh, The Theory of Sound, §81 (friction).
"""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.moving_frames import Load, MovingFrame, Vector, in_ground
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, gradient, jacobian, t, total_derivative
from lagrotor.renamed import accept_old_keywords
from lagrotor.result_display import Shown, text_of

_ZERO = (sp.S.Zero,) * 3


class AppliedForce(sp.ImmutableDenseMatrix):  # type: ignore[misc]
    """Generalised forces Q, shape (n, 1), that remember on which frames they act, for the forces in joints.

    Sums with other columns and multiples remember it, too. After any other operation `loads` is None.
    """

    loads: tuple[Load, ...] | None = None
    _op_priority = 20.0

    @classmethod
    def of(cls, Q: sp.Matrix, loads: tuple[Load, ...] | None) -> "AppliedForce":
        """Return the forces with their loads."""
        force = cls(Q)
        force.loads = loads
        return force

    def __add__(self, other: Any) -> "AppliedForce":
        theirs = other.loads if isinstance(other, AppliedForce) else ()
        both = None if self.loads is None or theirs is None else self.loads + theirs
        return self.of(sp.Matrix(self) if other == 0 else sp.Matrix(self) + sp.Matrix(other), both)

    def __mul__(self, factor: Any) -> Any:
        if isinstance(factor, sp.MatrixBase):
            return sp.Matrix(self) * factor
        loads = self.loads and tuple(load.each(lambda e: factor * e) for load in self.loads)
        return self.of(sp.Matrix(self) * factor, loads)

    def __rmul__(self, factor: Any) -> Any:
        return factor * sp.Matrix(self) if isinstance(factor, sp.MatrixBase) else self * factor

    def __neg__(self) -> "AppliedForce":
        return self * -1

    def __sub__(self, other: Any) -> "AppliedForce":
        return self + -other

    def __rsub__(self, other: Any) -> "AppliedForce":
        return -self + other

    def __truediv__(self, divisor: Any) -> "AppliedForce":
        return self * (sp.S.One / divisor)

    __radd__ = __add__


@dataclass(frozen=True, repr=False)
class Pathway(Shown):
    """A path between two points, along which springs, dampers and actuators act.

    Pathway.line(c, P, Q) is straight, Pathway.around(c, P, Q, radius) goes round a cylinder where that is in the way. Points
    are (x, y, z) in the ground's axes, as frame.place((0, 0, l)) gives them, in m.

    Attributes
    ----------
    c : Coordinates
        The coordinates of the system.
    lengths : tuple of (weight, length)
        The possible lengths in m. At each time one length has the weight 1 and the others have the weight 0.
    """

    _shown = (("length [m]", lambda p: "; or ".join(text_of(length) for _, length in p.lengths)),)

    c: Coordinates
    lengths: tuple[tuple[sp.Expr, sp.Expr], ...]

    def __post_init__(self) -> None:
        if not isinstance(self.c, Coordinates):
            raise InputError(f"Pathway: {self.c!r} must be Coordinates: coordinates('phi theta psi') makes them")

    @classmethod
    def line(cls, c: Coordinates, P: Vector, Q: Vector) -> "Pathway":
        """Return the straight line between two points.

        Parameters
        ----------
        c : Coordinates
            The coordinates.
        P, Q : sequence
            The ends (x, y, z).

        Returns
        -------
        Pathway
            The path.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x y")
        >>> Pathway.line(c, (0, 0, 0), (c.x, c.y, 0)).spring(8)
        4*x**2 + 4*y**2
        """
        return cls(c, ((sp.S.One, _distance(*_points(P, Q))),))

    @classmethod
    def around(
        cls,
        c: Coordinates,
        P: Vector,
        Q: Vector,
        radius: Any,
        centre: Vector = (0, 0, 0),
        axis: Vector = (0, 0, 1),
        side: int = 1,
    ) -> "Pathway":
        """Return the shortest path that does not enter a cylinder.

        Parameters
        ----------
        c : Coordinates
            The coordinates.
        P, Q : sequence
            The ends (x, y, z).
        radius : Expr
            The radius of the cylinder, declared positive.
        centre : sequence, default (0, 0, 0)
            A point of the axis.
        axis : sequence, default (0, 0, 1)
            The direction of the axis.
        side : int, default 1
            1 if the path from P to Q turns about the axis in the positive sense, −1 if in the negative. It turns by at most
            3/2 π. Where the straight line passes the cylinder on that side, the path is straight.

        Returns
        -------
        Pathway
            The path.
        """
        p, q = _points(P, Q)
        o, a = (
            sp.Matrix(vector_of(f"around: {name}", vector, 3)) for name, vector in (("centre", centre), ("axis", axis))
        )
        R, size = expression("around: radius", radius), a.dot(a)
        if size == 0 or not R.is_positive or side not in (1, -1):
            raise InputError(
                f"around: radius = {radius}, axis = {axis}, side = {side}: give a positive radius (a symbol declared "
                "positive), a direction, ±1"
            )
        a = a / sp.sqrt(size)
        rise = (q - p).dot(a)
        p, q = ((e - o) - a * (e - o).dot(a) for e in (p, q))
        turn = sp.pi / 2 + sp.atan2(-p.dot(q), side * a.dot(p.cross(q)))
        tangents = sp.S.Zero
        for e in (p, q):
            square = shortest(e.dot(e))
            if (R**2 - square).is_positive:
                raise InputError(
                    f"around: an end is {sp.sqrt(square)} from the axis, inside the cylinder of radius {R}: move it"
                )
            if decide_zero(square - R**2).answer != "zero":  # otherwise the end is on the surface
                turn -= sp.acos(R / sp.sqrt(square))
                tangents += sp.sqrt(square - R**2)
        wrapped = sp.sqrt((tangents + R * turn) ** 2 + rise**2) if rise != 0 else tangents + R * turn
        straight = sp.sqrt((q - p).dot(q - p) + rise**2)
        touches = sp.Heaviside(turn)
        return cls(c, ((1 - touches, straight), (touches, wrapped)))

    @property
    def length(self) -> sp.Expr:
        """The length ℓ(q, t), in m."""
        return sp.Add(*(weight * length for weight, length in self.lengths))

    @property
    def rate(self) -> sp.Expr:
        """The rate dℓ/dt, in m/s."""
        return sp.Add(*(weight * total_derivative(length, self.c) for weight, length in self.lengths))

    @accept_old_keywords
    def spring(self, stiffness: Any, rest_length: Any = 0) -> sp.Expr:
        """Return the potential energy ½ k (ℓ − ℓ₀)² of a spring.

        Parameters
        ----------
        stiffness : Expr
            The stiffness k, in N/m.
        rest_length : Expr, default 0
            The length ℓ₀ without force, in m.

        Returns
        -------
        Expr
            The energy in J, to be subtracted from the kinetic energy.
        """
        self._check_moves("spring")
        k, free = expression("spring: stiffness", stiffness), expression("spring: rest_length", rest_length)
        return sp.Add(*(weight * k * (length - free) ** 2 / 2 for weight, length in self.lengths))

    def damper(self, constant: Any) -> sp.Expr:
        """Return Rayleigh's function ½ d ℓ'² of a damper.

        Parameters
        ----------
        constant : Expr
            The damping constant d, in N s/m.

        Returns
        -------
        Expr
            The function for `dissipation`, in W.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> Pathway.line(c, (0, 0, 0), (c.x, 0, 0)).damper(6)
        3*x_dot**2
        """
        self._check_moves("damper")
        d = expression("damper: constant", constant)
        squares = [(weight, total_derivative(length, self.c) ** 2) for weight, length in self.lengths]
        smooth = [  # along one axis the length is |x| and its rate sign(x) x'; the square of the sign is 1
            (
                weight,
                square.replace(lambda e: e.is_Pow and e.exp == 2 and isinstance(e.base, sp.sign), lambda _: sp.S.One),
            )
            for weight, square in squares
        ]
        return sp.Add(*(weight * d * square / 2 for weight, square in smooth))

    def dry_friction(self, force: Any) -> sp.Expr:
        """Return Rayleigh's function F |ℓ'| of Coulomb's friction, under which the path may stick.

        Parameters
        ----------
        force : Expr
            The largest force F, in N.

        Returns
        -------
        Expr
            The function for `dissipation`, in W.
        """
        self._check_moves("dry_friction")
        factors = [
            f for f in sp.Mul.make_args(self.rate) if not isinstance(f, sp.sign)
        ]  # of a length along a coordinate axis
        return expression("dry_friction: force", force) * sp.Abs(sp.Mul(*factors))

    def actuator(self, force: Any) -> sp.Matrix:
        """Return the generalised forces Q = F ∂ℓ/∂q of a force along the path.

        Parameters
        ----------
        force : Expr
            The force F in N: positive pushes the ends apart, a rope pulls with a negative one.

        Returns
        -------
        Matrix
            Q for `forces`, shape (n, 1).
        """
        self._check_moves("actuator")
        F = expression("actuator: force", force)
        zero = sp.zeros(len(self.c.q), 1)
        Q = sum((gradient(length, self.c.q) * weight * F for weight, length in self.lengths), zero)
        return AppliedForce.of(Q, None)

    def _check_moves(self, what: str) -> None:
        if not self.length.has(*self.c.q, t):
            raise InputError(
                f"{what}: the length {self.length} depends on none of {self.c.q}: it gives no force; move an end"
            )


def force(frame: MovingFrame, components: Vector, at: Vector, axes: MovingFrame | str | None) -> AppliedForce:
    """Return the generalised forces of a force: `Frame.force`."""
    along, F = _axes("force", frame, axes), vector_of("force: components", components, 3)
    point = vector_of("force: at", at, 3)
    Q = (jacobian(frame.place(point), frame.c.q).T * in_ground(along)[0] * sp.Matrix(F)).applyfunc(shortest)
    return AppliedForce.of(Q, (Load(frame, point, F, _ZERO, along),))


def torque(
    frame: MovingFrame, moment: Vector, against: MovingFrame | None, axes: MovingFrame | str | None
) -> AppliedForce:
    """Return the generalised forces of a torque: `Frame.torque`."""
    along, T = _axes("torque", frame, axes), vector_of("torque: moment", moment, 3)
    w, loads = frame.angular_velocity, [Load(frame, _ZERO, _ZERO, T, along)]
    if against is not None:
        _check("torque: against", frame, against)
        w = w - in_ground(frame)[0].T * in_ground(against)[1]
        loads.append(Load(against, _ZERO, _ZERO, tuple(-e for e in T), along))
    moment = in_ground(frame)[0].T * in_ground(along)[0] * sp.Matrix(T)
    return AppliedForce.of((jacobian(w, frame.c.v).T * moment).applyfunc(shortest), tuple(loads))


def _axes(where: str, frame: MovingFrame, axes: MovingFrame | str | None) -> MovingFrame:
    """Return the frame along whose axes a vector is given: "frame", "ground", or a frame."""
    if axes is None or axes == "frame":
        return frame
    if axes == "ground":
        return frame.to_the_ground[-1]
    if isinstance(axes, str):
        raise InputError(f"{where}: axes = {axes!r} must be 'frame', 'ground' or a Frame")
    _check(f"{where}: axes", frame, axes)
    return axes


def _check(where: str, frame: MovingFrame, other: Any) -> None:
    """Raise InputError unless another frame has the coordinates of this one."""
    if not isinstance(other, MovingFrame) or other.c != frame.c:
        raise InputError(f"{where} = {other!r} must be a Frame with the same coordinates; Frame(c) is the ground")


def _points(*points: Vector) -> list[sp.Matrix]:
    return [sp.Matrix(vector_of("Pathway: a point", list(p) if isinstance(p, sp.MatrixBase) else p, 3)) for p in points]


def _distance(p: sp.Matrix, q: sp.Matrix) -> sp.Expr:
    return sp.sqrt(shortest((q - p).dot(q - p)))
