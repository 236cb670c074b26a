"""A mechanism as a tree of links, each moved from its parent by a joint with coordinates of its own, and by time.

A joint is a turn about one axis, a shift, or a rotation matrix. A screw, whose turn and shift share a coordinate, is no such
joint: a system with one uses the mass matrix. The joint's velocity relative to the parent, in the link's axes, is linear in
the rates of its coordinates,

    (u, d') = Σ_j s_j(q, t) v_j + s_t(q, t).

Fixed turns and shifts between two joints are combined, and bodies are expressed in the frame of the joint that carries them.
"""

from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.mechanics.bodies.moving_frames import MovingFrame
from lagrotor.mechanics.bodies.rigid_bodies import Body, Energy
from lagrotor.mechanics.bodies.small_matrices import Small, blocks, unit, zeros
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import Coordinates, bias, mass_matrix, t

Place = tuple[int, sp.Matrix, sp.Matrix]
_NONE = zeros(3, 1)


@dataclass(frozen=True)
class Mass:
    """A body in the axes of its link: mass, centre (3, 1), inertia about that centre (3, 3)."""

    mass: sp.Expr
    centre: Small
    inertia: Small


@dataclass(frozen=True)
class TreeLink:
    """A joint and the bodies that it carries; parent −1 is the ground.

    The link's axes come from the parent's by `shift`, then `rotation`, then a turn by `angle` about `axis`. `coordinates` are
    the indices of the joint's velocities, and `columns` their s_j. `rate`, shape (6, 1), is its velocity relative to the
    parent, and `swing` the time derivative of that velocity at a = 0.
    """

    parent: int
    shift: sp.Matrix
    rotation: sp.Matrix
    axis: int | None
    angle: sp.Expr
    coordinates: tuple[int, ...]
    columns: tuple[Small, ...]
    rate: Small
    swing: Small
    masses: tuple[Mass, ...] = ()

    @property
    def is_round(self) -> bool:
        """True if the link turns about an axis of symmetry of its bodies."""
        if self.axis is None:
            return False
        k, i, j = self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3
        return all(
            mass.centre[i] == mass.centre[j] == 0
            and mass.inertia[i, i] == mass.inertia[j, j]
            and mass.inertia[i, j] == mass.inertia[i, k] == mass.inertia[j, k] == 0
            for mass in self.masses
        )


@dataclass(frozen=True)
class Tree:
    """The links, parents first; the field (3, 1) on all bodies; the terms of L without bodies.

    `rotors` has the inertia of each speed that these terms add to its own mass, ½ J v², without a coupling.
    """

    links: tuple[TreeLink, ...]
    field: sp.Matrix
    remainder: sp.Expr
    rotors: dict[sp.Symbol, sp.Expr]


def tree_of(system: Equations) -> Tree | None:
    """Return the tree if L is T of bodies minus their potentials in one field, plus terms at most linear in v and constant
    inertias of single speeds; else None."""
    L = system.lagrangian
    if not isinstance(L, Energy) or (rotors := _rotors(system, L.remainder)) is None:
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
    return None if field.free_symbols & {*system.c.q, *system.c.v} else Tree(links, field, L.remainder, rotors)


def _rotors(system: Equations, remainder: sp.Expr) -> dict[sp.Symbol, sp.Expr] | None:
    """Return {v: J} for an expression Σ ½ J v² + terms linear in v with constant J; None for any other quadratic form in v."""
    if not remainder.free_symbols & {*system.c.v}:
        return {}
    M = mass_matrix(remainder, system.c)
    if not M.is_diagonal() or M.free_symbols & {*system.c.q, *system.c.v, t}:
        return None
    inertias = {v: M[i, i] for i, v in enumerate(system.c.v) if M[i, i] != 0}
    return inertias if inertias.keys() <= {*system.speeds} else None


def rest_forces(tree: Tree, c: Coordinates) -> sp.Matrix:
    """Return the generalised forces, shape (n, 1), of the terms of L without bodies; these do not enter the mass matrix."""
    return -bias(tree.remainder, c)


class _NoTreeError(Exception):
    """The system is no tree: a step shares coordinates with another joint or contains velocities, or a rate is no velocity."""


def _links(system: Equations, bodies: list[Body]) -> tuple[TreeLink, ...] | None:
    """Return the links that carry the bodies; None if these links do not form a tree of joints."""
    walk = _Walk(system)
    try:
        for body in bodies:
            number, d, R = walk.place_of(body.frame)
            if number >= 0:
                walk.masses[number].append(
                    Mass(body.mass, Small.of(d + R * body.centre), Small.of(R * body.inertia * R.T))
                )
    except _NoTreeError:
        return None
    if len(walk.used) != len(system.c.q) or len(walk.turned) != len(system.speeds):
        return None
    return tuple(replace(link, masses=tuple(masses)) for link, masses in zip(walk.links, walk.masses, strict=True))


class _Walk:
    """A walk from the bodies to the ground, with the links that it has found so far.

    `known` has the place of each frame: the index of the link that carries it, and the fixed shift and rotation from there.
    """

    def __init__(self, system: Equations) -> None:
        c = self.c = system.c
        self.rate = dict(zip((*c.q, t), (*c.v, sp.S.One), strict=True))
        self.number = {u: i for i, u in enumerate(system.speeds)}
        self.turned: list[sp.Symbol] = []
        self.moving = {*c.q, *c.v, t}
        self.links: list[TreeLink] = []
        self.masses: list[list[Mass]] = []
        self.known: dict[MovingFrame, Place] = {}
        self.used: set[sp.Symbol] = set()

    def place_of(self, frame: MovingFrame) -> Place:
        steps, place = list[MovingFrame](), (-1, sp.zeros(3, 1), sp.eye(3))
        while frame.parent is not None and frame not in self.known:
            steps.append(frame)
            frame = frame.parent
        place = self.known.get(frame, place)
        for step in reversed(steps):
            place = self.known[step] = self.step(step, *place)
        return place

    def step(self, frame: MovingFrame, parent: int, d: sp.Matrix, R: sp.Matrix) -> Place:
        """Return the place (link, d, R) of a frame, found from the place of its parent; a step that moves adds a new link."""
        is_shift = frame.axis is None and frame.amount.cols == 1
        moving = frame.amount.free_symbols & self.moving
        if not moving:
            return (parent, d + R * frame.amount, R) if is_shift else (parent, d, R * frame.rotation)
        places = sorted(moving & {*self.c.q}, key=self.c.q.index)
        speeds = frame.omega or tuple(self.rate[q] for q in places)
        if moving & {*self.c.v} or not {*speeds} <= self.number.keys() or moving & self.used:
            raise _NoTreeError
        self.used |= moving - {t}
        self.turned += speeds
        numbers = tuple(self.number[u] for u in speeds)
        if frame.omega:
            columns = [blocks([[unit(k, sp.S.One)], [_NONE]]) for k in range(3)]
            rate, swing = blocks([[Small.column(*speeds)], [_NONE]]), zeros(6, 1)
        else:
            columns = [_slope(frame, s) for s in (*places, t)]
            rate = _sum(columns, [*speeds, sp.S.One])
            swing = _sum([_derivative(rate, s) for s in (*places, t)], [*speeds, sp.S.One])
        angle = frame.amount if frame.axis is not None else sp.S.Zero
        if is_shift:
            d = d + R * frame.amount
        elif frame.axis is None:
            R = R * frame.amount
        self.links.append(
            TreeLink(parent, d, R, frame.axis, angle, numbers, tuple(columns[: len(numbers)]), rate, swing)
        )
        self.masses.append([])
        return len(self.links) - 1, sp.zeros(3, 1), sp.eye(3)


def _slope(frame: MovingFrame, s: sp.Symbol) -> Small:
    """Return the velocity (6, 1) of a step per unit rate of a coordinate or of time, in the axes after the step."""
    if frame.axis is not None:
        return blocks([[unit(frame.axis, derivative(frame.amount, s))], [_NONE]])
    slope = _derivative(Small.of(frame.amount), s)
    if frame.amount.cols == 1:
        return blocks([[_NONE], [slope]])
    spin = Small.of(frame.amount).T * slope
    return blocks([[Small.column(spin[2, 1], spin[0, 2], spin[1, 0])], [_NONE]])


def _derivative(matrix: Small, s: sp.Symbol) -> Small:
    return matrix.each(lambda e: derivative(e, s))


def _sum(columns: list[Small], factors: list[sp.Expr]) -> Small:
    return sum((column * x for column, x in zip(columns, factors, strict=True)), zeros(6, 1))
