"""Rigid bodies, and the energies that keep the bodies they are made of.

    T = ½ m |v|² + ½ ω·I ω,        V = −m g·r      (g a uniform field, r the place of the centre).

A sum of such energies and of plain expressions is a Lagrangian that any sympy function takes as an expression; System
keeps the bodies, whose tree gives faster code and the picture.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp
from mpmath import mp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies import moving_frames
from lagrotor.mechanics.bodies.contacts import Contact, contact
from lagrotor.mechanics.bodies.force_elements import push, torque
from lagrotor.mechanics.bodies.moving_frames import MovingFrame, Vector
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import t

Outline = list[list[Any]]  # points (x, y, z) of lines, in the body's frame
_ARCS = 32  # chords of a drawn rim
_ROUNDING = 1e-9  # of an inertia


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body: its frame, mass, inertia (3, 3) about its centre of mass, and that centre, in the frame's axes."""

    frame: MovingFrame
    mass: sp.Expr
    inertia: sp.Matrix
    centre: sp.Matrix

    def __repr__(self) -> str:
        return f"Body(mass {self.mass}, inertia {self.inertia.tolist()}, centre {list(self.centre)}, {self.frame})"

    @property
    def velocity(self) -> sp.Matrix:
        """v of the centre of mass, in the frame's axes, (3, 1)."""
        return self.frame.velocity(self.centre)

    @property
    def kinetic(self) -> "Energy":
        """½ m |v|² + ½ ω·I ω."""
        return Energy(((self, None, sp.S.One),))

    def potential(self, field: Vector) -> "Energy":
        """−m g·r in a uniform field g (3,), in the ground's axes: (0, 0, −g) for gravity with z up."""
        return Energy(((self, vector_of("potential: field", field, 3), sp.S.One),))

    def rolls_on(self, surface: Any, radius: Any, axis: Vector | None = None, centre: Vector | None = None) -> Contact:
        """The contact, without slip, of a ball of that radius, or of a thin disc about an axis, with a Plane, a Sphere or a
        Cylinder: see `contacts`. centre: of the ball or the disc, in the frame's axes; the centre of mass unless given."""
        return contact(self.frame, surface, radius, axis, list(self.centre) if centre is None else centre)

    @property
    def outline(self) -> Outline:
        """Lines to draw: from the frame's origin to the centre, and a rim with the body's axial radius of gyration.

        Where there is neither, lines along its axes. A body that turns in a plane, with inertia about one axis alone, is a
        uniform rod on the line through both points, where these are apart.
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
                reach = sp.sqrt(sp.Abs(sum(I) / 2 - I[k]) / self.mass)  # the body's mean square along its axis k
                lines.append([[sign * reach * int(i == k) for i in range(3)] for sign in (-1, 1)])
        return lines or [[[0, 0, 0], [0, 0, 0]]]


def make_body(frame: MovingFrame, mass: Any, inertia: Any = (0, 0, 0), centre: Vector = (0, 0, 0)) -> Body:
    """A rigid body fixed to the frame: mass, inertia (3,) or (3, 3) about its centre of mass, in the frame's axes.

    Raises InputError for a shape that is neither, or an inertia that is not symmetric.
    """
    try:
        I = sp.diag(*inertia) if sp.Matrix(inertia).shape in ((3, 1), (1, 3)) else sp.Matrix(inertia)
        place = sp.Matrix(list(centre))
    except (TypeError, ValueError):
        raise InputError(f"body: inertia = {inertia!r}, centre = {centre!r}: give (I1, I2, I3) and (x, y, z)") from None
    if I.shape != (3, 3) or place.shape != (3, 1) or decide_equal(I, I.T).answer == "nonzero":
        raise InputError(
            f"body: inertia = {inertia!r} must be (I1, I2, I3) or a symmetric (3, 3), the centre (x, y, z)"
        )
    I = sp.Matrix(3, 3, lambda i, j: I[min(i, j), max(i, j)])  # symmetric as written, too
    m = expression("body: mass", mass)
    if used := (m.free_symbols | I.free_symbols | place.free_symbols) & {*frame.c.q, *frame.c.v, t}:
        raise InputError(
            f"body: {', '.join(sorted(map(str, used)))} in a rigid body: its mass, inertia and centre are fixed; move its "
            "frame, and give what mass that is lost or gained does to the forces"
        )
    body = Body(frame, m, I, place)
    check_body("body", body)
    return body


def check_body(where: str, body: Body, values: Mapping[sp.Symbol, Any] | None = None) -> None:
    """Raise InputError where no body has that mass and inertia: m ≥ 0, and ½ tr I − I = ∫ r rᵀ dm ≥ 0.

    For principal inertias that is I1 ≤ I2 + I3 in turn. Inertia about one axis alone is that of motion in a plane. What has
    no number is passed over.
    """
    mass, I = (e.subs(values or {}) for e in (body.mass, body.inertia))
    if mass.is_negative:
        raise InputError(f"{where}: mass = {mass} must not be negative")
    if any(I[i, i].is_negative for i in range(3)):
        raise InputError(f"{where}: inertia = {I.tolist()} must not be negative about an axis")
    if I.free_symbols or sum(e != 0 for e in I) == sum(I[i, i] != 0 for i in range(3)) == 1:
        return
    spread = mp.eigsy(mp.matrix((sp.eye(3) * I.trace() / 2 - I).tolist()), eigvals_only=True)
    if min(spread) < -_ROUNDING * max(map(abs, spread)):
        shown = [[float(e) for e in row] for row in I.tolist()]
        raise InputError(
            f"{where}: no body has the inertia {shown}: of its principal inertias none is larger than the two others "
            "together; correct it"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Frame(MovingFrame):
    """Frame(c) is the ground; `turned` and `moved` lead to others; `body` fixes a rigid body to one; `push` and `torque` give the
    generalised forces of a force at one of its points, and of a torque on it. Joints by name lead to others, too, and close
    loops: see `moving_frames`.

    c = coordinates("phi theta psi")
    top = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    System(c, top.kinetic - top.potential((0, 0, -g)))
    """

    body = make_body
    push = push
    torque = torque
    weld, pin, prismatic, screw = moving_frames.weld, moving_frames.pin, moving_frames.prismatic, moving_frames.screw
    cylindrical, universal, planar = moving_frames.cylindrical, moving_frames.universal, moving_frames.planar
    ball, free = moving_frames.ball_joint, moving_frames.free
    coincides, keeps_axis = moving_frames.coincides, moving_frames.keeps_axis


@dataclass(frozen=True)
class Energy:
    """Σ factor × (kinetic energy, or potential in a field) of bodies, plus an expression; see `Body`."""

    terms: tuple[tuple[Body, tuple[sp.Expr, ...] | None, sp.Expr], ...]
    rest: sp.Expr = sp.S.Zero

    _op_priority = 100.0  # sympy hands + and − over

    def __repr__(self) -> str:
        return f"Energy(bodies={len(self.bodies)}, rest={self.rest})"

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The bodies, each once."""
        return tuple(dict.fromkeys(body for body, _, _ in self.terms))

    @cached_property
    def expression(self) -> sp.Expr:
        """The energy in q, v and t."""
        return sp.Add(self.rest, *(factor * _value(body, field) for body, field, factor in self.terms))

    @cached_property
    def free_symbols(self) -> set[sp.Basic]:
        """The symbols in it, velocities left aside."""
        symbols = set(self.rest.free_symbols)
        for body, field, factor in self.terms:
            symbols |= (
                body.mass.free_symbols | body.inertia.free_symbols | body.centre.free_symbols | factor.free_symbols
            )
            symbols |= set().union(*(e.free_symbols for e in field or ()))
            frame: MovingFrame | None = body.frame
            while frame is not None and frame.parent is not None:
                symbols |= frame.amount.free_symbols
                frame = frame.parent
        return symbols

    def _sympy_(self) -> sp.Expr:
        return self.expression

    def xreplace(self, put: Mapping[sp.Basic, sp.Basic]) -> "Energy":
        """The energy with letters put in beside the bodies."""
        return replace(self, rest=self.rest.xreplace(put))

    def __add__(self, other: Any) -> "Energy":
        if isinstance(other, Energy):
            return Energy(self.terms + other.terms, self.rest + other.rest)
        return Energy(self.terms, self.rest + expression("Energy: a summand", other))

    def __mul__(self, factor: Any) -> "Energy":
        number = expression("Energy: a factor", factor)
        return Energy(tuple((body, field, number * f) for body, field, f in self.terms), number * self.rest)

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
        return -body.mass * sp.Matrix(field).dot(body.frame.place(body.centre))
    v, w = body.velocity, body.frame.angular_velocity
    return body.mass * v.dot(v) / 2 + w.dot(body.inertia * w) / 2
