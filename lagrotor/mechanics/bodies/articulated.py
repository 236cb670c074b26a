"""The articulated-body recursion as stages of a program: operations linear in the bodies, nothing multiplied out.

Outward, each link has in its own axes the angular velocity ω and the accelerations (α, a) that it would have with all q'' = 0,
and from them the torque and force (N, F) about its joint that its bodies then need; a uniform field g is an acceleration −g
of the ground. What is missing to these accelerations is linear in q''. Inward, each link has the inertia of all that it carries,

    [N]   [J   H] [α]
    [F] = [Hᵀ  M] [a],

and each coordinate of its joint, of column s, takes its part away, I − U Uᵀ/D with U = I s, D = s·U; what is left is turned
and shifted to the parent. Outward again, q''. With several columns of joint forces τ the same factors give M⁻¹ τ column by
column, for the constraints.

Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 7; Luh, Walker & Paul (1980) for the accelerations.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics.bodies.small_matrices import Small, wedge, zeros
from lagrotor.mechanics.bodies.stages import Stages
from lagrotor.mechanics.bodies.trees import ZERO, Link, Pair, Tree
from lagrotor.mechanics.lagrangian import Coordinates

Column = list[sp.Expr]
_EYE = sp.eye(3)


@dataclass(frozen=True)
class Inertia:
    """J (3, 3) symmetric, H (3, 3), M (3, 3) symmetric."""

    J: Small
    H: Small
    M: Small


@dataclass(frozen=True)
class Factor:
    """What a coordinate leaves: its number and column s, E = U/D, 1/D, and u = τ − s·(N, F) for each column of torques."""

    number: int
    s: Pair
    E: Pair
    inverse: sp.Expr
    u: Column


@dataclass(frozen=True)
class Joint:
    """A link at one state: its shift and rotation, then cosine and sine of its turn; its columns, and its own motion.

    spin: ω. lift: (α, a) with all q'' = 0.
    """

    link: Link
    shift: Small
    rotation: Small | None
    cosine: sp.Expr
    sine: sp.Expr
    columns: tuple[Pair, ...]
    rate: Pair
    spin: Small = ZERO
    lift: Pair = (ZERO, ZERO)

    def inward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the parent → in the link."""
        if self.rotation is not None:
            e = keep.each(self.rotation.T * e)
        return _turned(e, self.link.axis, self.cosine, -self.sine, keep)

    def outward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the link → in the parent."""
        e = _turned(e, self.link.axis, self.cosine, self.sine, keep)
        return e if self.rotation is None else keep.each(self.rotation * e)


def joints(tree: Tree, keep: Stages) -> list[Joint]:
    """From the ground outward, link by link: ω, and (α, a).

    What turns about its own axis of symmetry and carries nothing is seen in axes that do not turn with it.
    """
    found: list[Joint] = []
    carrying = {link.parent for link in tree.links}
    for link in tree.links:
        cosine, sine = sp.S.One, sp.S.Zero
        if link.axis is not None and not (link.is_round and len(found) not in carrying):
            cosine, sine = keep(sp.cos(link.angle)), keep(sp.sin(link.angle))
        columns = tuple((keep.each(w), keep.each(v)) for w, v in link.columns)
        rate = keep.each(link.rate[0]), keep.each(link.rate[1])
        rotation = None if link.rotation == _EYE else keep.each(Small.of(link.rotation))
        joint = Joint(link, keep.each(Small.of(link.shift)), rotation, cosine, sine, columns, rate)
        before = found[link.parent] if link.parent >= 0 else None
        found.append(_moved(joint, before, -Small.of(tree.field), keep))
    return found


def _moved(joint: Joint, before: Joint | None, ground: Small, keep: Stages) -> Joint:
    """The joint with its ω and (α, a): those of the parent, turned and shifted, and its own.

    α = α' + ω' × u + u',  a = a' + α' × d + ω' × (ω' × d) + 2 ω × d' + d'', in turn.
    """
    w, (b, a) = (before.spin, before.lift) if before else (ZERO, (ZERO, ground))
    u, d = joint.rate
    a = keep.each(a + b.cross(joint.shift) + keep.each(w.cross(keep.each(w.cross(joint.shift)))))
    w, b, a = (joint.inward(e, keep) for e in (w, b, a))
    b = keep.each(b + w.cross(u) + keep.each(joint.link.swing[0]))
    a = keep.each(a + w.cross(d) * 2 + keep.each(joint.link.swing[1]))
    return replace(joint, spin=keep.each(w + u), lift=(b, a))


def tree_accelerations(chain: Sequence[Joint], c: Coordinates, torques: Sequence[Column], keep: Stages) -> list[Column]:
    """M⁻¹ (τ − h) for the first column of joint forces, velocities and field included, and M⁻¹ τ for the others.

    Raises SingularError where a coordinate moves no mass.
    """
    inertias = [_rigid(joint.link, keep) for joint in chain]
    forces = [[_needed(joint, keep), *[(ZERO, ZERO)] * (len(torques) - 1)] for joint in chain]
    factors: list[list[Factor]] = []
    for i in reversed(range(len(chain))):
        joint, I, parent = chain[i], inertias[i], chain[i].link.parent
        factors.append([])
        for number, s in zip(joint.link.coordinates, joint.columns, strict=True):
            U = keep.each(I.J * s[0] + I.H * s[1]), keep.each(I.H.T * s[0] + I.M * s[1])
            D = keep(s[0].dot(U[0]) + s[1].dot(U[1]))
            if D == 0:
                raise SingularError(
                    f"simulate: the mass matrix is singular: {c.v[number]} moves no mass; use fewer coordinates, or give the "
                    "bodies that it turns an inertia"
                )
            inverse = keep(1 / D)
            E = keep.each(U[0] * inverse), keep.each(U[1] * inverse)
            u = [keep(tau[number] - s[0].dot(N) - s[1].dot(F)) for tau, (N, F) in zip(torques, forces[i], strict=True)]
            factors[-1].append(Factor(number, s, E, inverse, u))
            if parent < 0 and s is joint.columns[-1]:
                break
            I = _eliminated(I, U, E, s, keep)
            forces[i] = [
                (keep.each(N + E[0] * x), keep.each(F + E[1] * x)) for (N, F), x in zip(forces[i], u, strict=True)
            ]
        if parent >= 0:
            inertias[parent] = _sum(inertias[parent], _shifted(joint, I, keep), keep)
            for j, (N, F) in enumerate(forces[i]):
                N, F, (to_N, to_F) = joint.outward(N, keep), joint.outward(F, keep), forces[parent][j]
                forces[parent][j] = keep.each(to_N + N + joint.shift.cross(F)), keep.each(to_F + F)
    factors.reverse()
    return [_outcome(chain, factors, j, keep) for j in range(len(torques))]


def _outcome(chain: Sequence[Joint], factors: Sequence[Sequence[Factor]], j: int, keep: Stages) -> Column:
    """Outward again: the accelerations of column j, in the order of the coordinates."""
    found: dict[int, sp.Expr] = {}
    places: list[Pair] = []
    for joint, eliminated in zip(chain, factors, strict=True):
        b, a = places[joint.link.parent] if joint.link.parent >= 0 else (ZERO, ZERO)
        a = joint.inward(keep.each(a + b.cross(joint.shift)), keep)
        b = joint.inward(b, keep)
        for f in reversed(eliminated):
            x = found[f.number] = keep(f.u[j] * f.inverse - f.E[0].dot(b) - f.E[1].dot(a))
            b, a = keep.each(b + f.s[0] * x), keep.each(a + f.s[1] * x)
        places.append((b, a))
    return [found[number] for number in range(len(found))]


def _rigid(link: Link, keep: Stages) -> Inertia:
    """The inertia of the bodies on a link, about its joint."""
    J, H, m = zeros(3, 3), zeros(3, 3), sp.S.Zero
    for mass in link.masses:
        c = wedge(Small.of(mass.centre))
        J, H, m = J + Small.of(mass.inertia) - c * c * mass.mass, H + c * mass.mass, m + mass.mass
    m = keep(m)
    return Inertia(
        keep.symmetric(J), keep.each(H), Small([[m if i == j else sp.S.Zero for j in range(3)] for i in range(3)])
    )


def _needed(joint: Joint, keep: Stages) -> Pair:
    """(N, F) about the joint, Σ m (a + α × c + ω × (ω × c)) and its moment, with I α + ω × I ω, for the motion without q''."""
    w, (b, a) = joint.spin, joint.lift
    N, F = ZERO, ZERO
    for mass in joint.link.masses:
        c, I = Small.of(mass.centre), Small.of(mass.inertia)
        at = keep.each(a + b.cross(c) + keep.each(w.cross(keep.each(w.cross(c)))))
        force = keep.each(at * mass.mass)
        N, F = keep.each(N + I * b + w.cross(keep.each(I * w)) + c.cross(force)), keep.each(F + force)
    return N, F


def _eliminated(I: Inertia, U: Pair, E: Pair, s: Pair, keep: Stages) -> Inertia:
    """I − U Uᵀ/D; along s, where that is one axis, nothing is left."""
    J, H, M = I.J - U[0] * E[0].T, I.H - U[0] * E[1].T, I.M - U[1] * E[1].T
    axes = [(turns, k) for turns, part in ((True, s[0]), (False, s[1])) for k in range(3) if part[k] != 0]
    if len(axes) == 1:
        turns, k = axes[0]
        for i in range(3):
            if turns:
                J.rows[k][i] = J.rows[i][k] = H.rows[k][i] = sp.S.Zero
            else:
                M.rows[k][i] = M.rows[i][k] = H.rows[i][k] = sp.S.Zero
    return Inertia(keep.symmetric(J), keep.each(H), keep.symmetric(M))


def _shifted(joint: Joint, I: Inertia, keep: Stages) -> Inertia:
    """The inertia in the parent's axes, about the parent's joint: H + [d] M, J − H [d] + [d] Hᵀ − [d] M [d]."""
    J, M = (_turned_symmetric(part, joint, keep) for part in (I.J, I.M))
    H = joint.outward(joint.outward(I.H, keep).T, keep).T
    if joint.shift.is_zero:
        return Inertia(J, H, M)
    d = wedge(joint.shift)
    carried = keep.each(H + d * M)
    return Inertia(keep.symmetric(J - H * d + d * carried.T), carried, M)


def _sum(I: Inertia, other: Inertia, keep: Stages) -> Inertia:
    return Inertia(keep.symmetric(I.J + other.J), keep.each(I.H + other.H), keep.symmetric(I.M + other.M))


def _turned(e: Small, axis: int | None, c: sp.Expr, s: sp.Expr, keep: Stages) -> Small:
    """The rotation by (c, s) about an axis of the columns of e, (3, m)."""
    if axis is None or s == 0:
        return e
    i, j = (axis + 1) % 3, (axis + 2) % 3
    rows = [*e.rows]
    turned = Small([[c, -s], [s, c]]) * Small([rows[i], rows[j]])
    rows[i], rows[j] = keep.each(turned).rows
    return Small(rows)


def _turned_symmetric(A: Small, joint: Joint, keep: Stages) -> Small:
    """R A Rᵀ; where A is round about the axis, nothing is done.

    With e = a − d and w = c e − 2 s b the block [[a, b], [b, d]] becomes [[d + c w, b + s w], [b + s w, a − c w]].
    """
    c, s, k = joint.cosine, joint.sine, joint.link.axis
    if k is not None and s != 0:
        i, j = (k + 1) % 3, (k + 2) % 3
        rows = [[*row] for row in A.rows]
        a, b, d = rows[i][i], rows[i][j], rows[j][j]
        w = keep(c * keep(a - d) - 2 * s * b)
        if w != 0:
            rows[i][i], rows[j][j], rows[i][j] = d + c * w, a - c * w, b + s * w
        f, h = rows[i][k], rows[j][k]
        rows[i][k], rows[j][k] = c * f - s * h, s * f + c * h
        rows[j][i], rows[k][i], rows[k][j] = rows[i][j], rows[i][k], rows[j][k]
        A = keep.symmetric(Small(rows))
    if joint.rotation is None:
        return A
    R = joint.rotation
    return keep.symmetric(keep.each(R * A) * R.T)
