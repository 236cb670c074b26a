"""Bodies that touch a surface: the gap, and the slip velocities at the point of contact, which vanish in rolling.

With the shape's centre p and the surface's normal n, in the surface's axes, a ball of radius ρ touches at p − ρ n, a thin disc
with the axis a at p − ρ e/|e|, e = n − (n·a) a. It rolls where v + ω × (x − p) of the body is the velocity of the surface there.
The multipliers are forces in N: the gap has the normal force, and the slips have the forces along the two tangents.

Neimark & Fufaev, Dynamics of Nonholonomic Systems, ch. I, §§2, 3; Routh, Advanced Rigid Dynamics, §§212–244.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.moving_frames import Load, MovingFrame, Source, Vector, in_ground
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import total_derivative
from lagrotor.result_display import Shown, text_of

_NONE = sp.zeros(3, 1)


@dataclass(frozen=True, eq=False)
class Plane:
    """The xy-plane of a frame, which may move; bodies on it have z > 0.

    Attributes
    ----------
    frame : Frame
        The frame.
    """

    frame: MovingFrame

    def _normal(self, p: sp.Matrix) -> sp.Matrix:
        """Return the unit normal at the foot of a point p, in the frame's axes."""
        return sp.Matrix([0, 0, 1])

    def _height(self, p: sp.Matrix) -> sp.Expr:
        """Return the height of a point above the surface."""
        return p[2]

    def _tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Return two orthonormal directions in the surface."""
        return sp.Matrix([1, 0, 0]), sp.Matrix([0, 1, 0])


@dataclass(frozen=True, eq=False)
class Sphere:
    """The sphere about the origin of a frame. Its tangents are not defined on the frame's y axis.

    Attributes
    ----------
    frame : Frame
        The frame.
    radius : Expr
        The radius in m.
    hollow : bool, default False
        True if bodies touch it from inside.
    """

    frame: MovingFrame
    radius: Any
    hollow: bool = False

    def _normal(self, p: sp.Matrix) -> sp.Matrix:
        return p / sp.sqrt(shortest(p.dot(p))) * (-1 if self.hollow else 1)

    def _height(self, p: sp.Matrix) -> sp.Expr:
        return (sp.sqrt(shortest(p.dot(p))) - self.radius) * (-1 if self.hollow else 1)

    def _tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        first = sp.Matrix([0, 1, 0]).cross(n)
        first = first / sp.sqrt(shortest(first.dot(first)))
        return first, n.cross(first)


@dataclass(frozen=True, eq=False)
class Cylinder(Sphere):
    """The cylinder about the z axis of a frame.

    Attributes
    ----------
    frame : Frame
    radius : Expr
    hollow : bool
        The frame, the radius in m, and True if bodies touch the cylinder from inside.
    """

    def _normal(self, p: sp.Matrix) -> sp.Matrix:
        return super()._normal(sp.Matrix([p[0], p[1], 0]))

    def _height(self, p: sp.Matrix) -> sp.Expr:
        return super()._height(sp.Matrix([p[0], p[1], 0]))

    def _tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        axis = sp.Matrix([0, 0, 1])
        return axis, n.cross(axis)


@dataclass(frozen=True, eq=False, repr=False)
class Contact(Shown):
    """The contact of a body with a surface.

    If the body rolls, give the System both `constraints` and `rolling` of the contact. If it slides, give `constraints` only.
    `run.reactions` has the contact forces by these names; on a plane they are along the axes of its frame.

    Attributes
    ----------
    gap : Expr
        The distance g(q, t) between body and surface in m.
    slips : tuple of Expr
        The two slip velocities f(q, v, t) in m/s.
    point : Matrix
        The point of contact (3, 1) in the ground's axes, in m.
    """

    _shown = (("gap [m]", "gap"), ("slip velocities [m/s]", lambda c: "; ".join(map(text_of, c.slips))))

    gap: sp.Expr
    slips: tuple[sp.Expr, sp.Expr]
    point: sp.Matrix

    @property
    def constraints(self) -> Mapping[str, sp.Expr]:
        """The gap by name; empty if it vanishes identically."""
        return {} if decide_zero(self.gap).answer == "zero" else {"normal": self.gap}

    @property
    def rolling(self) -> Mapping[str, sp.Expr]:
        """The slip velocities by name, without those that vanish identically."""
        named = zip(("along 1", "along 2"), self.slips, strict=True)
        return {name: e for name, e in named if decide_zero(e).answer != "zero"}


def contact(
    frame: MovingFrame, surface: Plane | Sphere | Cylinder, radius: Any, axis: Vector | None, centre: Vector
) -> Contact:
    """Return the contact of a surface with a ball about a centre, or with a thin disc about an axis: `Body.rolls_on`."""
    if not isinstance(surface, Plane | Sphere) or not isinstance(surface.frame, MovingFrame):
        raise InputError(
            f"rolls_on: {surface!r} is no surface: give Plane(frame), Sphere(frame, radius) or Cylinder(frame, radius)"
        )
    r = expression("rolls_on: radius", radius)
    if not r.is_positive:
        raise InputError(f"rolls_on: radius = {r} must be positive, a symbol declared so: Symbol('r', positive=True)")
    if isinstance(surface, Sphere):
        R = expression("rolls_on: radius of the surface", surface.radius)
        if not R.is_positive or (surface.hollow and (R - r).is_nonpositive):
            least = f"larger than the radius {r} of the ball inside" if surface.hollow else "positive"
            raise InputError(f"rolls_on: radius = {R} of the surface must be {least}")
    ground, (axes, drift) = surface.frame, in_ground(surface.frame)
    if frame.c != ground.c:
        raise InputError("rolls_on: the surface has other coordinates than the body: build both from one Frame(c)")
    at = frame.place(vector_of("rolls_on: centre", centre, 3))
    p = (axes.T * (at - ground.place())).applyfunc(shortest)
    n = surface._normal(p)
    if axis is None:
        below, gap = n * r, surface._height(p) - r
    else:
        if not isinstance(surface, Plane):
            raise InputError(
                "rolls_on: a disc rolls on a Plane: on other surfaces its point of contact has no closed form"
            )
        axle = sp.Matrix(vector_of("rolls_on: axis", axis, 3))
        if axle.dot(axle) == 0:
            raise InputError(f"rolls_on: axis = {axis} is no direction: give one that is not zero")
        a = (axes.T * in_ground(frame)[0] * axle).applyfunc(shortest) / sp.sqrt(axle.dot(axle))
        lean = sp.sqrt(1 - n.dot(a) ** 2)
        below, gap = (n - a * n.dot(a)) * r / lean, surface._height(p) - r * lean
    point = at - axes * below
    spin = in_ground(frame)[1] - drift
    # Velocities relative to the surface: that of the body's centre, and of the point of contact about it.
    carried = drift.cross(at - ground.place())
    centre_moves = (at - ground.place()).applyfunc(lambda e: total_derivative(e, frame.c)) - carried
    slip = axes.T * centre_moves - (axes.T * spin).cross(below)
    tangents = surface._tangents(n)
    slips = tuple(shortest(slip.dot(e)) for e in tangents)
    gap, arm = shortest(gap), in_ground(frame)[0].T * axes * below
    for e, direction in zip((gap, *slips), (n, *tangents), strict=True):
        on_body = Load(frame, list(sp.Matrix(centre) - arm), direction, _NONE, ground)
        on_surface = Load(ground, list(p - below), -direction, _NONE, ground)
        frame.c.sources.setdefault(e, []).append(Source("", (on_body, on_surface)))
    return Contact(gap, (slips[0], slips[1]), point)
