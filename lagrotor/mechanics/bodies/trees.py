"""A mechanism as a tree of links: each joint turns about, or slides along, one axis by one coordinate.

Fixed turns and shifts between two joints are taken together, and bodies are brought to the joint's frame that carries them.
"""

from dataclasses import dataclass

import sympy as sp

from lagrotor.mechanics.bodies.moving_frames import MovingFrame, turn_matrix
from lagrotor.mechanics.bodies.rigid_bodies import Body, Energy
from lagrotor.mechanics.equations import Equations


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


def _links(system: Equations, bodies: list[Body]) -> tuple[Link, ...] | None:
    """The links on the way to the bodies; None where a step is not a joint of one coordinate of its own."""
    q = system.c.q
    moving = {*q, *system.c.v}
    links: list[Link] = []
    masses: list[list[Mass]] = []
    # Of each frame: the link that carries it, and the fixed shift and rotation from there.
    known: dict[MovingFrame, tuple[int, sp.Matrix, sp.Matrix]] = {}

    def carried(frame: MovingFrame) -> tuple[int, sp.Matrix, sp.Matrix] | None:
        if frame.parent is None:
            return -1, sp.zeros(3, 1), sp.eye(3)
        if frame not in known:
            before = carried(frame.parent)
            after = before and _stepped(frame, *before)
            if after is None:
                return None
            known[frame] = after
        return known[frame]

    def joint(parent: int, d: sp.Matrix, R: sp.Matrix, turns: bool, axis: int, amount: sp.Expr) -> int | None:
        sign = 1 if amount in q else -1
        if sign * amount not in q or any(q.index(sign * amount) == link.coordinate for link in links):
            return None
        links.append(Link(parent, d, R, turns, axis, q.index(sign * amount), sign, ()))
        masses.append([])
        return len(links) - 1

    def _stepped(
        frame: MovingFrame, parent: int, d: sp.Matrix, R: sp.Matrix
    ) -> tuple[int, sp.Matrix, sp.Matrix] | None:
        symbols = sp.sympify(frame.amount).free_symbols
        if frame.axis is not None:
            if not symbols & moving:
                return (parent, d, R * turn_matrix(frame.axis, frame.amount)) if not _timed(symbols) else None
            number = joint(parent, d, R, True, frame.axis, frame.amount)
            return None if number is None else (number, sp.zeros(3, 1), sp.eye(3))
        if _timed(symbols) or (symbols & moving and frame.amount.cols == 3):
            return None
        if frame.amount.cols == 3:
            return parent, d, R * frame.amount
        for axis, amount in enumerate(frame.amount):
            if not amount.free_symbols & moving:
                d = d + R[:, axis] * amount
        for axis, amount in enumerate(frame.amount):
            if amount.free_symbols & moving:
                number = joint(parent, d, R, False, axis, amount)
                if number is None:
                    return None
                parent, d, R = number, sp.zeros(3, 1), sp.eye(3)
        return parent, d, R

    for body in bodies:
        place = carried(body.frame)
        if place is None:
            return None
        number, d, R = place
        if number >= 0:
            masses[number].append(Mass(body.mass, d + R * body.centre, R * body.inertia * R.T))
    if len(links) != len(q):
        return None
    return tuple(_with(link, bodies_) for link, bodies_ in zip(links, masses, strict=True))


def _with(link: Link, masses: list[Mass]) -> Link:
    return Link(
        link.parent, link.shift, link.rotation, link.turns, link.axis, link.coordinate, link.sign, tuple(masses)
    )


def _timed(symbols: set[sp.Basic]) -> bool:
    return any(str(s) == "t" for s in symbols)
