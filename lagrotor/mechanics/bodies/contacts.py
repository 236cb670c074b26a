"""Bodies that touch a surface: the gap, and the velocities at the point of contact that vanish where they roll.

With the shape's centre p and the surface's normal n, in the surface's axes, a ball of radius ρ touches at p − ρ n, a thin disc
with the axis a at p − ρ e/|e|, e = n − (n·a) a. It rolls where v + ω × (x − p) of the body is the velocity of the surface there.
Multipliers are then forces in N: of the gap the normal one, of the slips those along the two tangents.

Neimark & Fufaev, Dynamics of Nonholonomic Systems, ch. I, §§2, 3; Routh, Advanced Rigid Dynamics, §§212–244.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.moving_frames import MovingFrame, Vector, in_ground
from lagrotor.mechanics.expressions import expression, shortest, vector_of
from lagrotor.mechanics.lagrangian import total_derivative


@dataclass(frozen=True, eq=False)
class Plane:
    """The xy-plane of a frame, which may move: what is on it has z > 0."""

    frame: MovingFrame

    def normal(self, p: sp.Matrix) -> sp.Matrix:
        """The normal below a point p, in the frame's axes."""
        return sp.Matrix([0, 0, 1])

    def height(self, p: sp.Matrix) -> sp.Expr:
        """How high a point is above the surface."""
        return p[2]

    def tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Two directions in the surface, each of length one."""
        return sp.Matrix([1, 0, 0]), sp.Matrix([0, 1, 0])


@dataclass(frozen=True, eq=False)
class Sphere:
    """The sphere about the origin of a frame; hollow: what touches it is inside. Its tangents are not defined where the frame's y
    axis passes."""

    frame: MovingFrame
    radius: Any
    hollow: bool = False

    def normal(self, p: sp.Matrix) -> sp.Matrix:
        """The normal at the foot of a point p, in the frame's axes."""
        return p / sp.sqrt(shortest(p.dot(p))) * (-1 if self.hollow else 1)

    def height(self, p: sp.Matrix) -> sp.Expr:
        """How high a point is above the surface."""
        return (sp.sqrt(shortest(p.dot(p))) - self.radius) * (-1 if self.hollow else 1)

    def tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Two directions in the surface, each of length one."""
        first = sp.Matrix([0, 1, 0]).cross(n)
        first = first / sp.sqrt(shortest(first.dot(first)))
        return first, n.cross(first)


@dataclass(frozen=True, eq=False)
class Cylinder(Sphere):
    """The cylinder about the z axis of a frame; hollow: what touches it is inside."""

    def normal(self, p: sp.Matrix) -> sp.Matrix:
        """The normal at the foot of a point p, in the frame's axes."""
        return super().normal(sp.Matrix([p[0], p[1], 0]))

    def height(self, p: sp.Matrix) -> sp.Expr:
        """How high a point is above the surface."""
        return super().height(sp.Matrix([p[0], p[1], 0]))

    def tangents(self, n: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Two directions in the surface, each of length one."""
        along = sp.Matrix([0, 0, 1])
        return along, n.cross(along)


@dataclass(frozen=True, eq=False)
class Contact:
    """Where a body touches a surface: the gap g(q, t), m; the two velocities of slip f(q, v, t), m/s; the point (3, 1) in the
    ground's axes.

    constraints and rolling are those of a System of a body that rolls; of one that slides, constraints alone. Each has a name,
    by which `run.reactions` has its force, along the surface's own axes where it is a plane.
    """

    gap: sp.Expr
    slips: tuple[sp.Expr, sp.Expr]
    point: sp.Matrix

    @property
    def constraints(self) -> Mapping[str, sp.Expr]:
        """The gap; none where the coordinates keep it closed."""
        return {} if decide_zero(self.gap).answer == "zero" else {"normal": self.gap}

    @property
    def rolling(self) -> Mapping[str, sp.Expr]:
        """The slips that some velocity makes."""
        named = zip(("along 1", "along 2"), self.slips, strict=True)
        return {name: e for name, e in named if decide_zero(e).answer != "zero"}


def contact(
    frame: MovingFrame, surface: Plane | Sphere | Cylinder, radius: Any, axis: Vector | None, centre: Vector
) -> Contact:
    """The contact of a ball about `centre`, in the frame's axes, or of a thin disc with an `axis` there, and a surface.

    Raises InputError for a disc on what is no plane, and what is no surface.
    """
    if not isinstance(surface, Plane | Sphere) or not isinstance(surface.frame, MovingFrame):
        raise InputError(
            f"rolls_on: {surface!r} is no surface: Plane(frame), Sphere(frame, radius) or Cylinder(frame, radius)"
        )
    r = expression("rolls_on: radius", radius)
    if not r.is_positive:
        raise InputError(f"rolls_on: radius = {r} must be positive, a letter declared so: Symbol('r', positive=True)")
    if isinstance(surface, Sphere):
        R = expression("rolls_on: radius of the surface", surface.radius)
        if not R.is_positive or (surface.hollow and (R - r).is_nonpositive):
            least = f"larger than that of the ball inside, {r}" if surface.hollow else "positive"
            raise InputError(f"rolls_on: radius = {R} of the surface must be {least}")
    ground, (axes, drift) = surface.frame, in_ground(surface.frame)
    if frame.c != ground.c:
        raise InputError("rolls_on: the surface has other coordinates than the body: build both from one Frame(c)")
    at = frame.place(vector_of("rolls_on: centre", centre, 3))
    p = (axes.T * (at - ground.place())).applyfunc(shortest)
    n = surface.normal(p)
    if axis is None:
        below, gap = n * r, surface.height(p) - r
    else:
        if not isinstance(surface, Plane):
            raise InputError(
                "rolls_on: a disc rolls on a Plane: of other surfaces its point of contact is no closed form"
            )
        own = sp.Matrix(vector_of("rolls_on: axis", axis, 3))
        if own.dot(own) == 0:
            raise InputError(f"rolls_on: axis = {axis} is no direction")
        a = (axes.T * in_ground(frame)[0] * own).applyfunc(shortest) / sp.sqrt(own.dot(own))
        lean = sp.sqrt(1 - n.dot(a) ** 2)
        below, gap = (n - a * n.dot(a)) * r / lean, surface.height(p) - r * lean
    point = at - axes * below
    spin = in_ground(frame)[1] - drift
    # Relative to the surface: of the body's centre, and of the point about it.
    carried = drift.cross(at - ground.place())
    centre_moves = (at - ground.place()).applyfunc(lambda e: total_derivative(e, frame.c)) - carried
    slip = axes.T * centre_moves - (axes.T * spin).cross(below)
    slips = tuple(shortest(slip.dot(e)) for e in surface.tangents(n))
    return Contact(shortest(gap), (slips[0], slips[1]), point)
