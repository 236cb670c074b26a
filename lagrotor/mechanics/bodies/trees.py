"""A mechanism as a tree of links: each joint turns about, or slides along, one axis by one coordinate.

Fixed turns and shifts between two joints are taken together, and bodies are brought to the joint's frame that carries them.
"""

from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.mechanics.bodies.moving_frames import MovingFrame, turn_matrix
from lagrotor.mechanics.bodies.rigid_bodies import Body, Energy
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import t

Place = tuple[int, sp.Matrix, sp.Matrix]


@dataclass(frozen=True)
class Mass:
    """A body in the axes of its link: mass, centre (3, 1), inertia about that centre (3, 3)."""

    mass: sp.Expr
    centre: sp.Matrix
    inertia: sp.Matrix


@dataclass(frozen=True)
class Link:
    """A joint and what it carries: its parent's number (−1: the ground), the fixed shift and rotation before it, in the
    parent's axes, and the coordinate with its sign, about (`turns`) or along axis 0, 1, 2.
    """

    parent: int
    shift: sp.Matrix
    rotation: sp.Matrix
    turns: bool
    axis: int
    coordinate: int
    sign: int
    masses: tuple[Mass, ...]

    @property
    def is_round(self) -> bool:
        """Whether the bodies on it are symmetric about its axis."""
        k, i, j = self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3
        return all(
            mass.centre[i] == mass.centre[j] == 0
            and mass.inertia[i, i] == mass.inertia[j, j]
            and mass.inertia[i, j] == mass.inertia[i, k] == mass.inertia[j, k] == 0
            for mass in self.masses
        )


@dataclass(frozen=True)
class Tree:
    """Links, parents first; the field (3, 1) that all bodies are in, and the rest of the Lagrangian, a function of q, t."""

    links: tuple[Link, ...]
    field: sp.Matrix
    rest: sp.Expr


def tree_of(system: Equations) -> Tree | None:
    """The tree, if the Lagrangian is one: T of bodies less their potentials in one field, plus a function of q and t."""
    L = system.lagrangian
    if not isinstance(L, Energy) or L.rest.free_symbols & {*system.c.v}:
        return None
    kinetic = [body for body, field, factor in L.terms if field is None and factor == 1]
    fallen = [(body, field) for body, field, factor in L.terms if field is not None and factor == -1]
    fields = {field for _, field in fallen}
    complete = not fields or {body for body, _ in fallen} == {*kinetic}
    if len({*kinetic}) != len(kinetic) or len(kinetic) + len(fallen) != len(L.terms) or len(fields) > 1 or not complete:
        return None
    links = _links(system, kinetic)
    if links is None:
        return None
    field = sp.Matrix(next(iter(fields))) if fields else sp.zeros(3, 1)
    return None if field.free_symbols & {*system.c.q, *system.c.v} else Tree(links, field, L.rest)


class _NoTreeError(Exception):
    """A step that is not a joint of one coordinate of its own."""


def _links(system: Equations, bodies: list[Body]) -> tuple[Link, ...] | None:
    """The links on the way to the bodies; None where they do not make a tree of joints."""
    walk = _Walk(system.c.q, {*system.c.q, *system.c.v})
    try:
        for body in bodies:
            number, d, R = walk.reached(body.frame)
            if number >= 0:
                walk.masses[number].append(Mass(body.mass, d + R * body.centre, R * body.inertia * R.T))
    except _NoTreeError:
        return None
    if len(walk.links) != len(system.c.q):
        return None
    return tuple(replace(link, masses=tuple(masses)) for link, masses in zip(walk.links, walk.masses, strict=True))


class _Walk:
    """The links found so far, and of each frame the link that carries it with the fixed shift and rotation from there."""

    def __init__(self, q: tuple[sp.Symbol, ...], moving: set[sp.Symbol]) -> None:
        self.q, self.moving = q, moving
        self.links: list[Link] = []
        self.masses: list[list[Mass]] = []
        self.known: dict[MovingFrame, Place] = {}

    def reached(self, frame: MovingFrame) -> Place:
        if frame.parent is None:
            return -1, sp.zeros(3, 1), sp.eye(3)
        if frame not in self.known:
            self.known[frame] = self.stepped(frame, *self.reached(frame.parent))
        return self.known[frame]

    def stepped(self, frame: MovingFrame, parent: int, d: sp.Matrix, R: sp.Matrix) -> Place:
        """One step of frames on from a place."""
        symbols = frame.amount.free_symbols
        if t in symbols:
            raise _NoTreeError
        if frame.axis is not None:
            if symbols & self.moving:
                return self.joint(parent, d, R, True, frame.axis, frame.amount)
            return parent, d, R * turn_matrix(frame.axis, frame.amount)
        if frame.amount.cols == 3:
            if symbols & self.moving:
                raise _NoTreeError
            return parent, d, R * frame.amount
        slides = [axis for axis, amount in enumerate(frame.amount) if amount.free_symbols & self.moving]
        fixed = sp.Matrix([0 if axis in slides else amount for axis, amount in enumerate(frame.amount)])
        place: Place = (parent, d + R * fixed, R)
        for axis in slides:
            place = self.joint(*place, False, axis, frame.amount[axis])
        return place

    def joint(self, parent: int, d: sp.Matrix, R: sp.Matrix, turns: bool, axis: int, amount: sp.Expr) -> Place:
        """A new link, its amount a coordinate of its own or the negative of one."""
        sign = 1 if amount in self.q else -1
        if sign * amount not in self.q or any(self.q.index(sign * amount) == link.coordinate for link in self.links):
            raise _NoTreeError
        self.links.append(Link(parent, d, R, turns, axis, self.q.index(sign * amount), sign, ()))
        self.masses.append([])
        return len(self.links) - 1, sp.zeros(3, 1), sp.eye(3)
