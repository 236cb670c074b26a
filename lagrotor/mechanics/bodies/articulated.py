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
from dataclasses import dataclass

import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics.bodies.joints import Joint
from lagrotor.mechanics.bodies.small_matrices import Small, Stages, wedge, zeros
from lagrotor.mechanics.bodies.trees import ZERO, Pair

Column = list[sp.Expr]


@dataclass(frozen=True)
class Inertia:
    """J (3, 3) symmetric, H (3, 3), M (3, 3) symmetric."""

    J: Small
    H: Small
    M: Small


@dataclass(frozen=True)
class Factor:
    """What a coordinate leaves: its number and column s, E = U/D, and x = (τ − s·(N, F))/D for each column of torques."""

    number: int
    s: Pair
    E: Pair
    x: Column


def tree_accelerations(
    chain: Sequence[Joint], speeds: Sequence[sp.Symbol], torques: Sequence[Column], keep: Stages
) -> list[Column]:
    """M⁻¹ (τ − h) for the first column of joint forces, velocities and field included, and M⁻¹ τ for the others.

    Raises SingularError where a coordinate moves no mass.
    """
    inertias = [_rigid(joint, keep) for joint in chain]
    forces = [[_bias_force(joint, keep), *[(ZERO, ZERO)] * (len(torques) - 1)] for joint in chain]
    factors: list[list[Factor]] = []
    for i in reversed(range(len(chain))):
        joint, I, parent = chain[i], inertias[i], chain[i].link.parent
        factors.append([])
        for number, s in zip(joint.link.coordinates, joint.columns, strict=True):
            U = keep.each(I.J * s[0] + I.H * s[1]), keep.each(I.H.T * s[0] + I.M * s[1])
            D = keep(s[0].dot(U[0]) + s[1].dot(U[1]))
            if D == 0:
                raise SingularError(
                    f"System: the mass matrix is singular: {speeds[number]} moves no mass; use fewer coordinates, or give the "
                    "bodies that it turns an inertia"
                )
            inverse = keep(1 / D)
            E = _share(U, inverse, s, keep)
            left = [
                keep(tau[number] - s[0].dot(N) - s[1].dot(F)) for tau, (N, F) in zip(torques, forces[i], strict=True)
            ]
            factors[-1].append(Factor(number, s, E, [keep(u * inverse) for u in left]))
            if parent < 0 and s is joint.columns[-1]:
                break
            I = _inertia_left(I, U, E, s, keep)
            forces[i] = [
                _net_force(needed, U, x, tau[number], s, keep)
                for needed, x, tau in zip(forces[i], factors[-1][-1].x, torques, strict=True)
            ]
        if parent >= 0:
            mine, own = inertias[parent], _in_parent(joint, I, keep)
            inertias[parent] = Inertia(
                keep.symmetric(mine.J + own.J), keep.each(mine.H + own.H), keep.symmetric(mine.M + own.M)
            )
            for j, (N, F) in enumerate(forces[i]):
                N, F, (to_N, to_F) = joint.outward(N, keep), joint.outward(F, keep), forces[parent][j]
                forces[parent][j] = keep.each(to_N + N + joint.shift.cross(F)), keep.each(to_F + F)
    factors.reverse()
    return [_outcome(chain, factors, j, keep) for j in range(len(torques))]


def _outcome(chain: Sequence[Joint], factors: Sequence[Sequence[Factor]], j: int, keep: Stages) -> Column:
    """Outward again: the accelerations of column j, in the order of the coordinates."""
    solved: dict[int, sp.Expr] = {}
    places: list[Pair] = []
    for joint, eliminated in zip(chain, factors, strict=True):
        b, a = places[joint.link.parent] if joint.link.parent >= 0 else (ZERO, ZERO)
        a = joint.inward(keep.each(a + b.cross(joint.shift)), keep)
        b = joint.inward(b, keep)
        for f in reversed(eliminated):
            x = solved[f.number] = keep(f.x[j] - f.E[0].dot(b) - f.E[1].dot(a))
            b, a = keep.each(b + f.s[0] * x), keep.each(a + f.s[1] * x)
        places.append((b, a))
    return [solved[number] for number in range(len(solved))]


def _rigid(joint: Joint, keep: Stages) -> Inertia:
    """The inertia of the bodies on a link, about its joint."""
    J, H, m = zeros(3, 3), zeros(3, 3), sp.S.Zero
    for mass in joint.masses:
        J, H, m = J + mass.about_joint, H + wedge(mass.centre) * mass.mass, m + mass.mass
    m = keep(m)
    return Inertia(
        keep.symmetric(J), keep.each(H), Small([[m if i == j else sp.S.Zero for j in range(3)] for i in range(3)])
    )


def _bias_force(joint: Joint, keep: Stages) -> Pair:
    """(N, F) about the joint, Σ m (a + K c) and its moment, with I α + ω × I ω, for the motion without q''."""
    b, a = joint.lift
    N, F = ZERO, ZERO
    for mass in joint.masses:
        force = keep.each(keep.each(a + joint.bend * mass.centre) * mass.mass)
        N = keep.each(N + mass.inertia * b + _gyroscopic(mass.inertia, joint.spin, keep) + mass.centre.cross(force))
        F = keep.each(F + force)
    return N, F


def _gyroscopic(I: Small, w: Small, keep: Stages) -> Small:
    """ω × I ω; in the principal axes, (I_k − I_j) ω_j ω_k in turn."""
    if any(I[i, j] != 0 for i in range(3) for j in range(i)):
        return w.cross(keep.each(I * w))
    products = keep.symmetric(w * w.T)
    return Small.column(*(keep(I[k, k] - I[j, j]) * products[j, k] for j, k in ((1, 2), (2, 0), (0, 1))))


def _only_axis(s: Pair) -> tuple[int, int] | None:
    """Whether a column turns (0) or shifts (1), and about which axis, where it is one alone."""
    axes = [(part, k) for part in (0, 1) for k in range(3) if s[part][k] != 0]
    return axes[0] if len(axes) == 1 else None


def _share(U: Pair, inverse: sp.Expr, s: Pair, keep: Stages) -> Pair:
    """E = U/D, with s·E = 1: along s, where that is one axis, no division is left."""
    E = keep.each(U[0] * inverse), keep.each(U[1] * inverse)
    if along := _only_axis(s):
        part, k = along
        E[part].rows[k][0] = 1 / s[part][k]
    return E


def _net_force(needed: Pair, U: Pair, x: sp.Expr, tau: sp.Expr, s: Pair, keep: Stages) -> Pair:
    """(N, F) + U x, with s·((N, F) + U x) = τ."""
    wrench = keep.each(needed[0] + U[0] * x), keep.each(needed[1] + U[1] * x)
    if along := _only_axis(s):
        part, k = along
        wrench[part].rows[k][0] = keep(tau / s[part][k])
    return wrench


def _inertia_left(I: Inertia, U: Pair, E: Pair, s: Pair, keep: Stages) -> Inertia:
    """I − U Uᵀ/D; along s, where that is one axis, nothing is left."""
    J, H, M = I.J - U[0] * E[0].T, I.H - U[0] * E[1].T, I.M - U[1] * E[1].T
    if along := _only_axis(s):
        part, k = along
        for i in range(3):
            if part == 0:
                J.rows[k][i] = J.rows[i][k] = H.rows[k][i] = sp.S.Zero
            else:
                M.rows[k][i] = M.rows[i][k] = H.rows[i][k] = sp.S.Zero
    return Inertia(keep.symmetric(J), keep.each(H), keep.symmetric(M))


def _in_parent(joint: Joint, I: Inertia, keep: Stages) -> Inertia:
    """The inertia in the parent's axes, about the parent's joint: H + [d] M, J − H [d] + [d] Hᵀ − [d] M [d]."""
    J, M = (joint.outward_symmetric(part, keep) for part in (I.J, I.M))
    H = joint.outward(joint.outward(I.H, keep).T, keep).T
    if joint.shift.is_zero:
        return Inertia(J, H, M)
    d = wedge(joint.shift)
    carried = keep.each(H + keep.each(d * M))
    return Inertia(keep.symmetric(J - keep.each(H * d) + d * carried.T), carried, M)
