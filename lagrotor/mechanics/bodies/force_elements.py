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
from lagrotor.mechanics.bodies.moving_frames import MovingFrame, Vector, in_ground
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import Coordinates, gradient, jacobian, t, total_derivative
from lagrotor.renamed import accept_old_keywords
from lagrotor.result_display import Shown, text_of


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
        return sum((gradient(length, self.c.q) * weight * F for weight, length in self.lengths), zero)

    def _check_moves(self, what: str) -> None:
        if not self.length.has(*self.c.q, t):
            raise InputError(
                f"{what}: the length {self.length} depends on none of {self.c.q}: it gives no force; move an end"
            )


def force(frame: MovingFrame, components: Vector, at: Vector, axes: MovingFrame | None) -> sp.Matrix:
    """Return the generalised forces of a force: `Frame.force`."""
    F = _rotation("force", frame, axes) * sp.Matrix(vector_of("force: components", components, 3))
    place = frame.place(vector_of("force: at", at, 3))
    return (jacobian(place, frame.c.q).T * F).applyfunc(shortest)


def torque(frame: MovingFrame, moment: Vector, against: MovingFrame | None, axes: MovingFrame | None) -> sp.Matrix:
    """Return the generalised forces of a torque: `Frame.torque`."""
    T, w = sp.Matrix(vector_of("torque: moment", moment, 3)), frame.angular_velocity
    if against is not None:
        _check("torque: against", frame, against)
        w = w - in_ground(frame)[0].T * in_ground(against)[1]
    if axes is not None:
        T = in_ground(frame)[0].T * _rotation("torque", frame, axes) * T
    return (jacobian(w, frame.c.v).T * T).applyfunc(shortest)


def _rotation(where: str, frame: MovingFrame, axes: MovingFrame | None) -> sp.Matrix:
    """Return the rotation into the ground's axes from those of `axes`, or from those of `frame` if `axes` is None."""
    if axes is not None:
        _check(f"{where}: axes", frame, axes)
    return in_ground(frame if axes is None else axes)[0]


def _check(where: str, frame: MovingFrame, other: Any) -> None:
    """Raise InputError unless another frame has the coordinates of this one."""
    if not isinstance(other, MovingFrame) or other.c != frame.c:
        raise InputError(f"{where} = {other!r} must be a Frame with the same coordinates; Frame(c) is the ground")


def _points(*points: Vector) -> list[sp.Matrix]:
    return [sp.Matrix(vector_of("Pathway: a point", list(p) if isinstance(p, sp.MatrixBase) else p, 3)) for p in points]


def _distance(p: sp.Matrix, q: sp.Matrix) -> sp.Expr:
    return sp.sqrt(shortest((q - p).dot(q - p)))
