"""What acts between points of bodies, by virtual work.

A force F along a path of length ℓ(q, t) does the work F δℓ, so that it is Q = F ∂ℓ/∂q: positive pushes the ends apart. A force
at a point r is Q = (∂r/∂q)ᵀ F, a torque between frames (∂(ω − ω')/∂v)ᵀ T. Round a cylinder the shortest path is straight where
its surface is unrolled: two tangents and an arc across the axis, and along it the same rise for each length.

Moore, Learn Multibody Dynamics, chs. 12, 13; Rayleigh, The Theory of Sound, §81 (friction).
"""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.moving_frames import MovingFrame, Vector, in_ground
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, gradient, jacobian, t, total_derivative


@dataclass(frozen=True)
class Pathway:
    """A path between two points: its possible lengths (weight, ℓ), of which one has the weight 1 at each time, the others 0.

    Pathway.line(c, P, Q) is straight, Pathway.around(c, P, Q, radius) goes round a cylinder where that is in the way; points are
    (x, y, z) in the ground's axes, as frame.place((0, 0, l)) gives them.
    """

    c: Coordinates
    lengths: tuple[tuple[sp.Expr, sp.Expr], ...]

    def __post_init__(self) -> None:
        if not isinstance(self.c, Coordinates):
            raise InputError(f"Pathway: {self.c!r} must be Coordinates: coordinates('phi theta psi') makes them")

    @classmethod
    def line(cls, c: Coordinates, P: Vector, Q: Vector) -> "Pathway":
        """The straight line between two points.

        Parameters
        ----------
        c : Coordinates
            The coordinates.
        P : Vector
            Where it begins.
        Q : Vector
            Where it ends.

        Raises
        ------
        InputError
            For what is no point.
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
        """The shortest path that does not enter a cylinder; straight where the straight line passes on that side.

        Parameters
        ----------
        c : Coordinates
            The coordinates.
        P : Vector
            Where it begins.
        Q : Vector
            Where it ends.
        radius
            Of the cylinder.
        centre : Vector, default (0, 0, 0)
            A point of its axis.
        axis : Vector, default (0, 0, 1)
            The axis' direction.
        side : int, default 1
            1 where the path turns about the axis in its positive sense from P to Q, −1 in the other, by up to 3/2 π.

        Raises
        ------
        InputError
            For an axis that is none, another side, or an end that stays inside.
        """
        p, q = _points(P, Q)
        o, a = (
            sp.Matrix(vector_of(f"around: {name}", given, 3)) for name, given in (("centre", centre), ("axis", axis))
        )
        R, size = expression("around: radius", radius), a.dot(a)
        if size == 0 or not R.is_positive or side not in (1, -1):
            raise InputError(
                f"around: radius = {radius}, axis = {axis}, side = {side}: give a positive radius (a letter that is declared "
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
                    f"around: an end is {sp.sqrt(square)} from the axis, inside the cylinder of radius {R}"
                )
            if decide_zero(square - R**2).answer != "zero":  # else the end is on the surface
                turn -= sp.acos(R / sp.sqrt(square))
                tangents += sp.sqrt(square - R**2)
        wrapped = sp.sqrt((tangents + R * turn) ** 2 + rise**2) if rise != 0 else tangents + R * turn
        straight = sp.sqrt((q - p).dot(q - p) + rise**2)
        touches = sp.Heaviside(turn)
        return cls(c, ((1 - touches, straight), (touches, wrapped)))

    @property
    def length(self) -> sp.Expr:
        """ℓ(q, t)."""
        return sp.Add(*(weight * length for weight, length in self.lengths))

    @property
    def rate(self) -> sp.Expr:
        """dℓ/dt."""
        return sp.Add(*(weight * total_derivative(length, self.c) for weight, length in self.lengths))

    def spring(self, stiffness: Any, rest: Any = 0) -> sp.Expr:
        """The potential ½ k (ℓ − ℓ₀)², to be taken from the kinetic energy."""
        self._check_moves("spring")
        k, free = expression("spring: stiffness", stiffness), expression("spring: rest", rest)
        return sp.Add(*(weight * k * (length - free) ** 2 / 2 for weight, length in self.lengths))

    def damper(self, constant: Any) -> sp.Expr:
        """Rayleigh's function ½ d ℓ'², for `dissipation`."""
        self._check_moves("damper")
        d = expression("damper: constant", constant)
        return sp.Add(*(weight * d * total_derivative(length, self.c) ** 2 / 2 for weight, length in self.lengths))

    def dry_friction(self, force: Any) -> sp.Expr:
        """F |ℓ'|, for `dissipation`: Coulomb's friction of the size F, which may hold the length."""
        self._check_moves("dry_friction")
        factors = [f for f in sp.Mul.make_args(self.rate) if not isinstance(f, sp.sign)]  # of a length along one axis
        return expression("dry_friction: force", force) * sp.Abs(sp.Mul(*factors))

    def actuator(self, force: Any) -> sp.Matrix:
        """Q = F ∂ℓ/∂q, (n, 1), for `forces`: a positive F pushes the ends apart, a rope pulls with a negative one."""
        self._check_moves("actuator")
        F = expression("actuator: force", force)
        zero = sp.zeros(len(self.c.q), 1)
        return sum((gradient(length, self.c.q) * weight * F for weight, length in self.lengths), zero)

    def _check_moves(self, what: str) -> None:
        if not self.length.has(*self.c.q, t):
            raise InputError(f"{what}: the length {self.length} depends on none of {self.c.q}: it gives no force")


def push(frame: MovingFrame, force: Vector, at: Vector = (0, 0, 0)) -> sp.Matrix:
    """The generalised forces (n, 1) of a force, in the ground's axes, at a point of the frame."""
    F = sp.Matrix(vector_of("push: force", force, 3))
    place = frame.place(vector_of("push: at", at, 3))
    return (jacobian(place, frame.c.q).T * F).applyfunc(shortest)


def torque(frame: MovingFrame, moment: Vector, against: MovingFrame | None = None) -> sp.Matrix:
    """The generalised forces (n, 1) of a torque on the frame, in the frame's own axes; its reaction acts on `against`, or on the
    ground."""
    T, w = sp.Matrix(vector_of("torque: moment", moment, 3)), frame.angular_velocity
    if against is not None:
        if not isinstance(against, MovingFrame):
            raise InputError(f"torque: against = {against!r} must be a Frame")
        w = w - in_ground(frame)[0].T * in_ground(against)[1]
    return (jacobian(w, frame.c.v).T * T).applyfunc(shortest)


def _points(*given: Vector) -> list[sp.Matrix]:
    return [sp.Matrix(vector_of("Pathway: a point", list(p) if isinstance(p, sp.MatrixBase) else p, 3)) for p in given]


def _distance(p: sp.Matrix, q: sp.Matrix) -> sp.Expr:
    return sp.sqrt(shortest((q - p).dot(q - p)))
