"""The articulated-body recursion as stages of a program: operations linear in the bodies, nothing multiplied out.

Each link has the motion (ω, v) of its joint, in its own axes, and the inertia of all that it carries,

    [L]   [J   H] [ω]
    [p] = [Hᵀ  M] [v].

A joint along s takes its part away, I − U Uᵀ/D with U = I s, D = s·U; what is left is turned and shifted to the parent.
With several columns of joint forces τ the same factors give M⁻¹ τ column by column, for the constraints. A uniform field
g is an acceleration −g of the ground.

Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 7.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import sympy as sp

from lagrotor.mechanics.bodies.small_matrices import Small, unit, wedge, zeros
from lagrotor.mechanics.bodies.trees import Link, Tree
from lagrotor.mechanics.lagrangian import Coordinates
from lagrotor.numerics.codegen import Stage

Column = list[sp.Expr]
Pair = tuple[Small, Small]  # angular and linear part
_ZERO = zeros(3, 1)
_EYE = sp.eye(3)


@dataclass
class Stages:
    """Stages made one after another; an expression that was made before is the stage it was made in."""

    made: list[Stage] = field(default_factory=list)
    names: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)

    def __call__(self, e: sp.Expr) -> sp.Expr:
        if e.is_Atom or (e.is_Mul and e.args[0] is sp.S.NegativeOne and len(e.args) == 2 and e.args[1].is_Atom):
            return e
        if e not in self.names:
            self.names[e] = sp.Symbol(f"_a{len(self.made)}", real=True)
            self.made.append((self.names[e], e))
        return self.names[e]

    def each(self, matrix: Small) -> Small:
        """Every entry."""
        return matrix.each(self)

    def symmetric(self, matrix: Small) -> Small:
        """Every entry of a symmetric matrix, once."""
        upper = {(i, j): self(matrix[i, j]) for i in range(3) for j in range(i, 3)}
        return Small([[upper[min(i, j), max(i, j)] for j in range(3)] for i in range(3)])


@dataclass(frozen=True)
class Inertia:
    """J (3, 3) symmetric, H (3, 3), M (3, 3) symmetric."""

    J: Small
    H: Small
    M: Small


@dataclass(frozen=True)
class Joint:
    """A link at one state: cosine and sine of its turn, the shift to it, its motion (ω, v), its own rate."""

    link: Link
    cosine: sp.Expr
    sine: sp.Expr
    shift: Small
    motion: Pair
    rate: sp.Expr

    def inward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the parent → in the link."""
        if self.link.rotation != _EYE:
            e = keep.each(Small.of(self.link.rotation.T) * e)
        return _turned(e, self.link.axis, self.cosine, -self.sine, keep)

    def outward(self, e: Small, keep: Stages) -> Small:
        """A vector's components in the link → in the parent."""
        e = _turned(e, self.link.axis, self.cosine, self.sine, keep)
        return e if self.link.rotation == _EYE else keep.each(Small.of(self.link.rotation) * e)


def joints(tree: Tree, c: Coordinates, keep: Stages) -> list[Joint]:
    """From the ground outward: the velocities, link by link.

    What turns about its own axis of symmetry and carries nothing is seen in axes that do not turn with it.
    """
    found: list[Joint] = []
    for link in tree.links:
        q, rate = link.sign * c.q[link.coordinate], link.sign * c.v[link.coordinate]
        shift = link.shift if link.turns else link.shift + link.rotation[:, link.axis] * q
        cosine, sine = sp.S.One, sp.S.Zero
        if link.turns and not (link.is_round and all(other.parent != len(found) for other in tree.links)):
            cosine = keep(sp.cos(c.q[link.coordinate]))
            sine = link.sign * keep(sp.sin(c.q[link.coordinate]))
        before = found[link.parent].motion if link.parent >= 0 else (_ZERO, _ZERO)
        here = Joint(link, cosine, sine, keep.each(Small.of(shift)), (_ZERO, _ZERO), rate)
        w, v = here.inward(before[0], keep), here.inward(keep.each(before[1] + before[0].cross(here.shift)), keep)
        own = unit(link.axis, rate)
        motion = (keep.each(w + own), v) if link.turns else (w, keep.each(v + own))
        found.append(Joint(link, cosine, sine, here.shift, motion, rate))
    return found


def tree_accelerations(tree: Tree, chain: Sequence[Joint], torques: Sequence[Column], keep: Stages) -> list[Column]:
    """M⁻¹ (τ − h) for the first column of joint forces, velocities and field included, and M⁻¹ τ for the others."""
    inertias = [_rigid(joint.link, keep) for joint in chain]
    rest = [(_ZERO, _ZERO)] * (len(torques) - 1)
    forces = [[_bias(joint, I, keep), *rest] for joint, I in zip(chain, inertias, strict=True)]
    factors: list[tuple[Pair, sp.Expr, Column]] = []
    for i in reversed(range(len(chain))):
        joint, I, link = chain[i], inertias[i], chain[i].link
        k = link.axis
        U = (I.J.col(k), I.H.row(k)) if link.turns else (I.H.col(k), I.M.col(k))
        inverse = keep(1 / U[0 if link.turns else 1][k])
        u = [
            keep(link.sign * tau[link.coordinate] - p[0 if link.turns else 1][k])
            for tau, p in zip(torques, forces[i], strict=True)
        ]
        factors.append((U, inverse, u))
        if link.parent >= 0:
            E = keep.each(U[0] * inverse), keep.each(U[1] * inverse)
            left = _eliminated(I, U, E, link, keep)
            inertias[link.parent] = _sum(inertias[link.parent], _shifted(joint, left, keep), keep)
            for j, p in enumerate(forces[i]):
                c = _swing(joint, keep) if j == 0 else (_ZERO, _ZERO)
                L = keep.each(p[0] + left.J * c[0] + left.H * c[1] + E[0] * u[j])
                f = keep.each(p[1] + left.H.T * c[0] + left.M * c[1] + E[1] * u[j])
                L, f = joint.outward(L, keep), joint.outward(f, keep)
                to = forces[link.parent][j]
                forces[link.parent][j] = keep.each(to[0] + L + joint.shift.cross(f)), keep.each(to[1] + f)
    factors.reverse()
    return [_outcome(tree, chain, factors, j, keep) for j in range(len(torques))]


def _outcome(
    tree: Tree, chain: Sequence[Joint], factors: Sequence[tuple[Pair, sp.Expr, Column]], j: int, keep: Stages
) -> Column:
    """Outward again: the accelerations of column j, in the order of the coordinates."""
    found: Column = [sp.S.Zero] * len(chain)
    places: list[Pair] = []
    for joint, (U, inverse, u) in zip(chain, factors, strict=True):
        link = joint.link
        ground = _ZERO, (-Small.of(tree.field) if j == 0 else _ZERO)
        w, v = places[link.parent] if link.parent >= 0 else ground
        c = _swing(joint, keep) if j == 0 else (_ZERO, _ZERO)
        v = joint.inward(keep.each(v + w.cross(joint.shift)), keep)
        w, v = keep.each(joint.inward(w, keep) + c[0]), keep.each(v + c[1])
        a = keep(keep(u[j] - U[0].dot(w) - U[1].dot(v)) * inverse)
        own = unit(link.axis, a)
        places.append((keep.each(w + own), v) if link.turns else (w, keep.each(v + own)))
        found[link.coordinate] = link.sign * a
    return found


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


def _bias(joint: Joint, I: Inertia, keep: Stages) -> Pair:
    """(ω × L + v × p, ω × p): what keeps a rigid body's momentum turning with it."""
    w, v = joint.motion
    L, p = keep.each(I.J * w + I.H * v), keep.each(I.H.T * w + I.M * v)
    return keep.each(w.cross(L) + v.cross(p)), keep.each(w.cross(p))


def _swing(joint: Joint, keep: Stages) -> Pair:
    """The acceleration that the joint's own velocity makes in the turning axes."""
    w, v = joint.motion
    own = unit(joint.link.axis, joint.rate)
    return (keep.each(w.cross(own)), keep.each(v.cross(own))) if joint.link.turns else (_ZERO, keep.each(w.cross(own)))


def _eliminated(I: Inertia, U: Pair, E: Pair, link: Link, keep: Stages) -> Inertia:
    """I − U Uᵀ/D; along the joint nothing is left."""
    J, H, M = I.J - U[0] * E[0].T, I.H - U[0] * E[1].T, I.M - U[1] * E[1].T
    k = link.axis
    for i in range(3):
        if link.turns:
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


def _turned(e: Small, axis: int, c: sp.Expr, s: sp.Expr, keep: Stages) -> Small:
    """The rotation by (c, s) about an axis of the columns of e, (3, m)."""
    if s == 0:
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
    if s != 0:
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
    if joint.link.rotation == _EYE:
        return A
    R = Small.of(joint.link.rotation)
    return keep.symmetric(R * A * R.T)
