"""The articulated-body recursion as stages of a program: operations linear in the number of bodies, nothing multiplied out.

The first pass goes outward from the ground. Each link gets, in its own axes, the angular velocity ω and the accelerations
(α, a) at q'' = 0, and from them the torque and force (N, F) about its joint that its bodies need. A uniform field g is an
acceleration −g of the ground. A link that is symmetric about the axis of its turn and carries nothing is described in axes
that do not turn with it, so that its angle enters no equation.

The second pass goes inward. Each link gets the inertia I of all that it carries,

    [N]   [J   H] [α]
    [F] = [Hᵀ  M] [a],

and each coordinate of its joint, with the column s and an inertia J of its own, reduces it to I − U Uᵀ/D with U = I s and
D = s·U + J. The result is turned and shifted to the parent's axes and origin. The third pass goes outward and gives q''.
With several columns of joint forces τ the same factors give M⁻¹ τ for each, which the constraints need.

Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 7; Luh, Walker & Paul (1980) for the accelerations.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics.bodies.small_matrices import Small, Stages, blocks, halves, wedge, zeros
from lagrotor.mechanics.bodies.trees import Tree, TreeLink

_EYE = sp.eye(3)
_NONE, _STILL = zeros(3, 1), zeros(3, 3)


@dataclass(frozen=True)
class Turn:
    """A rotation about an axis by an angle of cosine c and sine s; the identity if s is zero."""

    axis: int | None = None
    angle: sp.Expr = sp.S.Zero
    c: sp.Expr = sp.S.One
    s: sp.Expr = sp.S.Zero

    @classmethod
    def by(cls, axis: int, angle: sp.Expr, keep: Stages) -> "Turn":
        return cls(axis, angle, keep(sp.cos(angle)), keep(sp.sin(angle)))

    def back(self) -> "Turn":
        """Return the inverse rotation."""
        return replace(self, s=-self.s)

    def of(self, e: Small, keep: Stages) -> Small:
        """Rotate the columns of e (3, m)."""
        if self.axis is None or self.s == 0:
            return e
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        rows = [*e.rows]
        mixed = Small([[self.c, -self.s], [self.s, self.c]]) * Small([rows[i], rows[j]])
        rows[i], rows[j] = keep.each(mixed).rows
        return Small(rows)


@dataclass(frozen=True)
class Joint:
    """A link at one state, with the shift, rotation and turn from the parent's axes.

    `columns` are the velocities (angular, linear) per unit rate of each coordinate, and `rate` is the velocity relative to
    the parent. `spin` is ω, and `lift` is (α, a) at q'' = 0. With `bend` K = [α]× + [ω]×² the point r has the acceleration a
    + K r.
    """

    link: TreeLink
    shift: Small
    rotation: Small | None
    turn: Turn
    columns: tuple[Small, ...]
    rate: Small
    spin: Small = _NONE
    lift: tuple[Small, Small] = (_NONE, _NONE)
    bend: Small = _STILL

    def inward(self, e: Small, keep: Stages) -> Small:
        """Transform the components of vectors from the parent's axes to the link's axes."""
        if self.rotation is not None:
            e = keep.each(self.rotation.T * e)
        return self.turn.back().of(e, keep)

    def outward(self, e: Small, keep: Stages) -> Small:
        """Transform the components of vectors from the link's axes to the parent's axes."""
        e = self.turn.of(e, keep)
        return e if self.rotation is None else keep.each(self.rotation * e)

    def both(self, change: Callable[[Small, Stages], Small], e: Small, keep: Stages) -> Small:
        """Apply `inward` or `outward` to the angular and to the linear rows of e (6, m)."""
        return blocks([[change(half, keep)] for half in halves(e)])

    @property
    def lever(self) -> Small:
        """The matrix [[1, [d]×], [0, 1]], which moves (N, F) from the link's origin to the parent's."""
        unit = Small.of(_EYE)
        return blocks([[unit, wedge(self.shift)], [zeros(3, 3), unit]])


def joints(tree: Tree, keep: Stages) -> list[Joint]:
    """Compute ω and (α, a) of each link, from the ground outward."""
    chain, carrying = list[Joint](), {link.parent for link in tree.links}
    for number, link in enumerate(tree.links):
        axis = link.axis if number in carrying or not link.is_round else None
        parent = chain[link.parent] if link.parent >= 0 else None
        joint = Joint(
            link,
            keep.each(Small.of(link.shift)),
            None if link.rotation == _EYE else keep.each(Small.of(link.rotation)),
            Turn.by(axis, link.angle, keep) if axis is not None else Turn(),
            tuple(map(keep.each, link.columns)),
            keep.each(link.rate),
        )
        chain.append(_with_motion(joint, parent, -Small.of(tree.field), keep))
    return chain


def _with_motion(joint: Joint, parent: Joint | None, ground: Small, keep: Stages) -> Joint:
    """Return the joint with its motion, which is found from the motion of its parent, the joint with the index p.

    u and ḋ are the joint's velocities: α = α_p + ω_p × u + u̇,  a = a_p + K_p d + 2 ω_p × ḋ + d̈.
    """
    w, (b, a) = (parent.spin, parent.lift) if parent else (_NONE, (_NONE, ground))
    (u, d), (u_swing, d_swing) = halves(joint.rate), halves(joint.link.swing)
    a = keep.each(a + parent.bend * joint.shift) if parent else a
    w, b, a = (joint.inward(e, keep) for e in (w, b, a))
    b = keep.each(b + w.cross(u) + keep.each(u_swing))
    a = keep.each(a + w.cross(d) * 2 + keep.each(d_swing))
    w = keep.each(w + u)
    return replace(joint, spin=w, lift=(b, a), bend=keep.each(wedge(b) + keep.symmetric(wedge(w) * wedge(w))))


def tree_energy(tree: Tree, chain: Sequence[Joint], speeds: Sequence[sp.Symbol], keep: Stages) -> sp.Expr:
    """Compute the Jacobi integral v·∂L/∂v − L from the velocities (ω, v) of the links.

    `keep` stores each part as an intermediate result, a stage of the generated program, and returns its symbol.
    If time moves a joint, T = T₂ + T₁ + T₀ in powers of the velocities, and the integral is T₂ − T₀ + V. With the velocities
    V = (ω, v), and V* at v = 0, T₂ − T₀ is ½ V·I V − V·I V*. Goldstein §2.7.
    """
    still = dict.fromkeys(speeds, 0)
    total, motions, fields, depths = -tree.remainder.subs(still), list[Small](), list[Small](), list[sp.Expr]()
    total += sp.Add(*(J * u**2 / 2 for u, J in tree.rotors.items()))
    for joint in chain:
        parent = joint.link.parent
        carried = motions[parent] if parent >= 0 else zeros(6, 2)
        rate = blocks([[joint.link.rate, joint.link.rate.each(lambda e: e.subs(still))]])
        V = keep.each(joint.both(joint.inward, keep.each(joint.lever.T * carried), keep) + rate)
        motions.append(V)
        products = V.T * keep.each(_rigid(joint, keep) * V)
        total += keep(products[0, 0] / 2 - products[0, 1])
        field, depth = (fields[parent], depths[parent]) if parent >= 0 else (Small.of(tree.field), sp.S.Zero)
        fields.append(joint.inward(field, keep))
        depths.append(keep(depth + field.dot(joint.shift)))
        for mass in joint.link.masses:
            total -= keep(mass.mass * (depths[-1] + fields[-1].dot(mass.centre)))
    return total


Column = list[sp.Expr]


@dataclass(frozen=True)
class Factor:
    """The elimination of one joint coordinate, coordinate `number`, as in the articulated-body algorithm.

    The coordinate moves the link along `s`, shape (6, 1). With the articulated inertia J, U = J s, and D is s·U plus the
    inertia of the coordinate's rotor. `E` is U/D, and `x` has (τ − s·(N, F))/D for each column τ of joint forces.
    """

    number: int
    s: Small
    E: Small
    x: Column


def tree_accelerations(
    tree: Tree, chain: Sequence[Joint], speeds: Sequence[sp.Symbol], torques: Sequence[Column], keep: Stages
) -> list[Column]:
    """Compute M⁻¹ (τ − h) for the first column of joint forces, and M⁻¹ τ for the others.

    SingularError is raised if a coordinate moves no mass.
    """
    inertias = [_rigid(joint, keep) for joint in chain]
    forces = [[_bias_force(joint, keep), *[zeros(6, 1)] * (len(torques) - 1)] for joint in chain]
    factors: list[list[Factor]] = []
    for i in reversed(range(len(chain))):
        joint, I, parent = chain[i], inertias[i], chain[i].link.parent
        factors.append([])
        for number, s in zip(joint.link.coordinates, joint.columns, strict=True):
            U = keep.each(I * s)
            D = keep(s.dot(U) + tree.rotors.get(speeds[number], sp.S.Zero))
            if D == 0:
                raise SingularError(
                    f"System: the mass matrix is singular: {speeds[number]} moves no mass; use fewer coordinates, or give the "
                    "bodies that it turns an inertia"
                )
            inverse, axes = keep(1 / D), [k for k in range(6) if s[k] != 0]
            E = keep.each(U * inverse)
            x = [keep(keep(tau[number] - s.dot(f)) * inverse) for tau, f in zip(torques, forces[i], strict=True)]
            direct = (
                len(axes) == 1 and speeds[number] not in tree.rotors
            )  # then s·E = 1, and along s the inertia vanishes
            if direct:  # no division remains
                E.rows[axes[0]][0] = 1 / s[axes[0]]
            factors[-1].append(Factor(number, s, E, x))
            if parent < 0 and s is joint.columns[-1]:
                break
            I = I - U * E.T
            forces[i] = [keep.each(f + U * e) for f, e in zip(forces[i], x, strict=True)]
            if direct:  # the force is τ
                for k in range(6):
                    I.rows[axes[0]][k] = I.rows[k][axes[0]] = sp.S.Zero
                for f, tau in zip(forces[i], torques, strict=True):
                    f.rows[axes[0]][0] = keep(tau[number] / s[axes[0]])
            I = keep.symmetric(I)
        if parent >= 0:
            outer = joint.both(joint.outward, joint.both(joint.outward, I, keep).T, keep)
            inner = keep.each(joint.lever * keep.symmetric(outer)) * joint.lever.T
            inertias[parent] = keep.symmetric(inertias[parent] + keep.symmetric(inner))
            for j, f in enumerate(forces[i]):
                forces[parent][j] = keep.each(forces[parent][j] + joint.lever * joint.both(joint.outward, f, keep))
    factors.reverse()
    return [_outcome(chain, factors, j, keep) for j in range(len(torques))]


def _outcome(chain: Sequence[Joint], factors: Sequence[Sequence[Factor]], j: int, keep: Stages) -> Column:
    """Make the third pass: return the accelerations for column j of the joint forces, in the order of the coordinates."""
    solved: dict[int, sp.Expr] = {}
    places: list[Small] = []
    for joint, eliminated in zip(chain, factors, strict=True):
        a = places[joint.link.parent] if joint.link.parent >= 0 else zeros(6, 1)
        a = joint.both(joint.inward, keep.each(joint.lever.T * a), keep)
        for f in reversed(eliminated):
            x = solved[f.number] = keep(f.x[j] - f.E.dot(a))
            a = keep.each(a + f.s * x)
        places.append(a)
    return [solved[number] for number in range(len(solved))]


def _rigid(joint: Joint, keep: Stages) -> Small:
    """Return the inertia (6, 6) of the bodies on a link about its joint."""
    J, H, m = zeros(3, 3), zeros(3, 3), sp.S.Zero
    for mass in joint.link.masses:
        c = wedge(mass.centre)
        J, H, m = J + mass.inertia - c * c * mass.mass, H + c * mass.mass, m + mass.mass
    return keep.symmetric(blocks([[J, H], [H.T, Small.of(_EYE) * m]]))


def _bias_force(joint: Joint, keep: Stages) -> Small:
    """Return the torque and force (N, F), shape (6, 1), about the joint that the bodies of a link need at q'' = 0.

    F is the sum of f = m (a + K c), and N is the sum of c × f + I α + ω × I ω.
    """
    b, a = joint.lift
    N, F = _NONE, _NONE
    for mass in joint.link.masses:
        force = keep.each(keep.each(a + joint.bend * mass.centre) * mass.mass)
        turning = mass.inertia * b + joint.spin.cross(keep.each(mass.inertia * joint.spin))
        N, F = keep.each(N + turning + mass.centre.cross(force)), keep.each(F + force)
    return blocks([[N], [F]])
