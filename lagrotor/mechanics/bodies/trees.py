"""A mechanism as a tree of links, each moved from its parent by a joint of any number of coordinates of its own, and by time.

A joint is a turn about one axis, a shift, or a rotation matrix. A screw, whose turn and shift have one coordinate, is no such
joint: the mass matrix serves a system with one. The joint's velocity relative to the parent, in the link's axes, is linear in
the rates of its own coordinates,

    (u, d') = Σ_j s_j(q, t) v_j + s_t(q, t).

Fixed turns and shifts between two joints are taken together, and bodies are brought to the joint's frame that carries them.
"""

from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.mechanics.bodies.moving_frames import MovingFrame
from lagrotor.mechanics.bodies.rigid_bodies import Body, Energy
from lagrotor.mechanics.bodies.small_matrices import Small, unit, zeros
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import Coordinates, bias, mass_matrix, t

Pair = tuple[Small, Small]  # angular and linear part
Place = tuple[int, sp.Matrix, sp.Matrix]
ZERO = zeros(3, 1)


@dataclass(frozen=True)
class Mass:
    """A body in the axes of its link: mass, centre (3, 1), inertia about that centre (3, 3)."""

    mass: sp.Expr
    centre: Small
    inertia: Small


@dataclass(frozen=True)
class TreeLink:
    """A joint and what it carries.

    parent: its number, −1 for the ground. shift: the link's origin from the parent's, in the parent's axes. rotation, then a
    turn by `angle` about `axis`, if any: components in the link → in the parent. coordinates: the numbers of its own
    velocities. columns: s_j for each of them; rate: the relative velocity; swing: its derivative without accelerations.
    """

    parent: int
    shift: sp.Matrix
    rotation: sp.Matrix
    axis: int | None
    angle: sp.Expr
    coordinates: tuple[int, ...]
    columns: tuple[Pair, ...]
    rate: Pair
    swing: Pair
    masses: tuple[Mass, ...] = ()


@dataclass(frozen=True)
class Tree:
    """Links, parents first; the field (3, 1) that all bodies are in; the rest of the Lagrangian, at most linear in v."""

    links: tuple[TreeLink, ...]
    field: sp.Matrix
    rest: sp.Expr


def tree_of(system: Equations) -> Tree | None:
    """The tree, if the Lagrangian is one: T of bodies less their potentials in one field, plus a function linear in v."""
    L = system.lagrangian
    if not isinstance(L, Energy):
        return None
    if L.rest.free_symbols & {*system.c.v} and mass_matrix(L.rest, system.c).is_zero_matrix is not True:
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


def rest_forces(tree: Tree, c: Coordinates) -> sp.Matrix:
    """The generalised forces of the rest of the Lagrangian, (n, 1), which give no accelerations a part."""
    return -bias(tree.rest, c)


class _NoTreeError(Exception):
    """A step by coordinates that another joint has, or by velocities; a velocity of one's own that is no joint's."""


def _links(system: Equations, bodies: list[Body]) -> tuple[TreeLink, ...] | None:
    """The links on the way to the bodies; None where they do not make a tree of joints."""
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
    """The links found so far, and of each frame the link that carries it with the fixed shift and rotation from there."""

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
        if frame.parent is None:
            return -1, sp.zeros(3, 1), sp.eye(3)
        if frame not in self.known:
            self.known[frame] = self.step(frame, *self.place_of(frame.parent))
        return self.known[frame]

    def step(self, frame: MovingFrame, parent: int, d: sp.Matrix, R: sp.Matrix) -> Place:
        """One step of frames on from a place: a new link where the step moves."""
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
        own = tuple(self.number[u] for u in speeds)
        if frame.omega:
            columns = (*((unit(k, sp.S.One), ZERO) for k in range(3)), (ZERO, ZERO))
            rate, swing = (Small.column(*speeds), ZERO), (ZERO, ZERO)
        else:
            columns, rate, swing = _velocities(frame, [*places, t], [*speeds, sp.S.One])
        angle = frame.amount if frame.axis is not None else sp.S.Zero
        if is_shift:
            d = d + R * frame.amount
        elif frame.axis is None:
            R = R * frame.amount
        self.links.append(TreeLink(parent, d, R, frame.axis, angle, own, columns[:-1], rate, swing))
        self.masses.append([])
        return len(self.links) - 1, sp.zeros(3, 1), sp.eye(3)


def _velocities(
    frame: MovingFrame, places: list[sp.Symbol], rates: list[sp.Expr]
) -> tuple[tuple[Pair, ...], Pair, Pair]:
    """The columns s_j of a step for the coordinates and the time, the sum of s_j v_j, and its derivative."""
    slopes = [_slope(frame, s) for s in places]
    rate = _sum(slopes, rates)
    swing = _sum([_derivative(rate, s) for s in places], rates)
    turns = frame.axis is not None or frame.amount.cols == 3

    def pair(e: Small) -> Pair:
        return (e, ZERO) if turns else (ZERO, e)

    return tuple(map(pair, slopes)), pair(rate), pair(swing)


def _slope(frame: MovingFrame, s: sp.Symbol) -> Small:
    """The derivative of a step by one coordinate, or the time, in the axes that it leads to."""
    if frame.axis is not None:
        return unit(frame.axis, derivative(frame.amount, s))
    moved = _derivative(Small.of(frame.amount), s)
    if frame.amount.cols == 1:
        return moved
    spin = Small.of(frame.amount).T * moved
    return Small.column(spin[2, 1], spin[0, 2], spin[1, 0])


def _derivative(matrix: Small, s: sp.Symbol) -> Small:
    return matrix.each(lambda e: derivative(e, s))


def _sum(columns: list[Small], factors: list[sp.Expr]) -> Small:
    return sum((column * x for column, x in zip(columns, factors, strict=True)), ZERO)
