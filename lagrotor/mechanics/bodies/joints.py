"""The joints of a tree at one state, from the ground outward: axes, turns, velocities, accelerations without q'', energy.

A link that turns is seen in axes that do not turn with it where that is shorter: where it is symmetric about the axis of its
turn and carries nothing, and where all that it carries turns about the same axis, so that angles add. Bodies and shifts
are then turned in place of velocities, forces and inertias.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.mechanics.bodies.small_matrices import Small, Stages, wedge, zeros
from lagrotor.mechanics.bodies.trees import ZERO, Mass, Pair, Tree, TreeLink

_EYE = sp.eye(3)
_STILL = zeros(3, 3)


@dataclass(frozen=True)
class Turn:
    """A rotation by an angle, of cosine c and sine s, about an axis; none where s is zero."""

    axis: int | None = None
    angle: sp.Expr = sp.S.Zero
    c: sp.Expr = sp.S.One
    s: sp.Expr = sp.S.Zero

    @classmethod
    def by(cls, axis: int, angle: sp.Expr, keep: Stages) -> "Turn":
        """By an angle."""
        return cls(axis, angle, keep(sp.cos(angle)), keep(sp.sin(angle)))

    def back(self) -> "Turn":
        """The inverse."""
        return replace(self, s=-self.s)

    def of(self, e: Small, keep: Stages) -> Small:
        """R e, for the columns of e, (3, m)."""
        if self.axis is None or self.s == 0:
            return e
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        rows = [*e.rows]
        turned = Small([[self.c, -self.s], [self.s, self.c]]) * Small([rows[i], rows[j]])
        rows[i], rows[j] = keep.each(turned).rows
        return Small(rows)

    def of_symmetric(self, A: Small, keep: Stages) -> Small:
        """R A Rᵀ; where A is round about the axis, nothing is done.

        With e = a − d and w = c e − 2 s b the block [[a, b], [b, d]] becomes [[d + c w, b + s w], [b + s w, a − c w]].
        """
        if self.axis is None or self.s == 0:
            return A
        c, s, k = self.c, self.s, self.axis
        i, j = (k + 1) % 3, (k + 2) % 3
        rows = [[*row] for row in A.rows]
        a, b, d = rows[i][i], rows[i][j], rows[j][j]
        w = keep(c * keep(a - d) - keep(2 * s) * b)
        if w != 0:
            rows[i][i], rows[j][j], rows[i][j] = d + c * w, a - c * w, b + s * w
        f, h = rows[i][k], rows[j][k]
        rows[i][k], rows[j][k] = c * f - s * h, s * f + c * h
        rows[j][i], rows[k][i], rows[k][j] = rows[i][j], rows[i][k], rows[j][k]
        return keep.symmetric(Small(rows))


@dataclass(frozen=True)
class JointMass:
    """A body in the axes of its joint: mass, centre (3, 1), inertia about that centre and about the joint, (3, 3)."""

    mass: sp.Expr
    centre: Small
    inertia: Small
    about_joint: Small


@dataclass(frozen=True)
class Joint:
    """A link at one state.

    shift, rotation, turn: from the parent's axes. own: what is left from its axes to those of the link. spin: ω.
    lift: (α, a) with all q'' = 0. bend: K = [α]× + [ω]×², so that the point r has the acceleration a + K r.
    """

    link: TreeLink
    shift: Small
    rotation: Small | None
    turn: Turn
    own: Turn
    masses: tuple[JointMass, ...]
    columns: tuple[Pair, ...]
    rate: Pair
    spin: Small = ZERO
    lift: Pair = (ZERO, ZERO)
    bend: Small = _STILL

    def inward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the parent → in the link."""
        if self.rotation is not None:
            e = keep.each(self.rotation.T * e)
        return self.turn.back().of(e, keep)

    def outward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the link → in the parent."""
        e = self.turn.of(e, keep)
        return e if self.rotation is None else keep.each(self.rotation * e)

    def outward_symmetric(self, A: Small, keep: Stages) -> Small:
        """The same of a symmetric matrix."""
        A = self.turn.of_symmetric(A, keep)
        return A if self.rotation is None else keep.symmetric(keep.each(self.rotation * A) * self.rotation.T)


def joints(tree: Tree, keep: Stages) -> list[Joint]:
    """From the ground outward, link by link: ω, and (α, a)."""
    chain: list[Joint] = []
    for number, link in enumerate(tree.links):
        before = chain[link.parent] if link.parent >= 0 else None
        carried = [other for other in tree.links if other.parent == number]
        chain.append(_with_motion(_joint(link, carried, before, keep), before, -Small.of(tree.field), keep))
    return chain


def _joint(link: TreeLink, carried: Sequence[TreeLink], before: Joint | None, keep: Stages) -> Joint:
    """The joint without its motion."""
    turn, own = Turn(), Turn()
    if link.axis is not None and not (link.is_round and not carried):
        angle = keep(link.angle + before.own.angle) if before else link.angle
        turn = Turn.by(link.axis, angle, keep)
        if all(other.axis == link.axis and other.rotation == _EYE for other in carried):
            turn, own = own, turn
    shift = keep.each(Small.of(link.shift))
    return Joint(
        link,
        before.own.of(shift, keep) if before else shift,
        None if link.rotation == _EYE else keep.each(Small.of(link.rotation)),
        turn,
        own,
        tuple(_joint_mass(mass, own, keep) for mass in link.masses),
        tuple((keep.each(w), keep.each(v)) for w, v in link.columns),
        (keep.each(link.rate[0]), keep.each(link.rate[1])),
    )


def _joint_mass(mass: Mass, own: Turn, keep: Stages) -> JointMass:
    centre, inertia = keep.each(Small.of(mass.centre)), Small.of(mass.inertia)
    c = wedge(centre)
    about = keep.symmetric(inertia - c * c * mass.mass)
    return JointMass(mass.mass, own.of(centre, keep), own.of_symmetric(inertia, keep), own.of_symmetric(about, keep))


def _with_motion(joint: Joint, before: Joint | None, ground: Small, keep: Stages) -> Joint:
    """The joint with its ω and (α, a): those of the parent, turned and shifted, and its own.

    α = α' + ω' × u + u',  a = a' + K' d + 2 ω × d' + d'', in turn.
    """
    w, (b, a) = (before.spin, before.lift) if before else (ZERO, (ZERO, ground))
    u, d = joint.rate
    a = keep.each(a + before.bend * joint.shift) if before else a
    w, b, a = (joint.inward(e, keep) for e in (w, b, a))
    b = keep.each(b + w.cross(u) + keep.each(joint.link.swing[0]))
    a = keep.each(a + w.cross(d) * 2 + keep.each(joint.link.swing[1]))
    w = keep.each(w + u)
    return replace(joint, spin=w, lift=(b, a), bend=keep.each(wedge(b) + _centripetal(w, keep)))


def _centripetal(w: Small, keep: Stages) -> Small:
    """[ω]×² = ω ωᵀ − ω² 1."""
    products = keep.symmetric(w * w.T)
    rows = [[*row] for row in products.rows]
    for i in range(3):
        rows[i][i] = -products[i - 1, i - 1] - products[i - 2, i - 2]
    return Small(rows)


def tree_energy(tree: Tree, chain: Sequence[Joint], speeds: Sequence[sp.Symbol], keep: Stages) -> sp.Expr:
    """v·∂L/∂v − L, in stages, with the velocities (ω, v) of the links.

    Where time moves a joint, T = T₂ + T₁ + T₀ in powers of the velocities, and the Jacobi integral is T₂ − T₀ + V. With v* the
    velocity that time alone gives, T₂ − T₀ is ½ m (v − 2 v*)·v, and likewise for the turning. Goldstein §2.7.
    """
    total, fields, depths = -tree.rest.subs(dict.fromkeys(speeds, 0)), list[Small](), list[sp.Expr]()
    moving = _velocities(chain, [joint.rate for joint in chain], keep)
    by_time = [(_at_rest(u, speeds), _at_rest(d, speeds)) for u, d in (joint.link.rate for joint in chain)]
    driven = _velocities(chain, by_time, keep)
    for joint, (w, v), (w_t, v_t) in zip(chain, moving, driven, strict=True):
        parent = joint.link.parent
        field, depth = (fields[parent], depths[parent]) if parent >= 0 else (Small.of(tree.field), sp.S.Zero)
        fields.append(joint.inward(field, keep))
        depths.append(keep(depth + field.dot(joint.shift)))
        for mass in joint.masses:
            centre, I = mass.centre, mass.inertia
            at, at_t = keep.each(v + w.cross(centre)), keep.each(v_t + w_t.cross(centre))
            total += keep(mass.mass * at.dot(at - at_t * 2) / 2 + w.dot(I * (w - w_t * 2)) / 2)
            total -= keep(mass.mass * (depths[-1] + fields[-1].dot(centre)))
    return total


def _at_rest(rate: Small, speeds: Sequence[sp.Symbol]) -> Small:
    return rate.each(lambda e: e.subs(dict.fromkeys(speeds, 0)))


def _velocities(chain: Sequence[Joint], rates: Sequence[Pair], keep: Stages) -> list[Pair]:
    """(ω, v) of each link, in its axes: its parent's, and its own relative to it."""
    velocities: list[Pair] = []
    for joint, (u, d) in zip(chain, rates, strict=True):
        w, v = velocities[joint.link.parent] if joint.link.parent >= 0 else (ZERO, ZERO)
        v = joint.inward(keep.each(v + w.cross(joint.shift)), keep)
        velocities.append((keep.each(joint.inward(w, keep) + u), keep.each(v + d)))
    return velocities
