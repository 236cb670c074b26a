"""The energy of a tree of bodies, in stages: with the velocities that the recursion has."""

from collections.abc import Sequence

import sympy as sp

from lagrotor.mechanics.bodies.articulated import Joint, Stages
from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.mechanics.bodies.trees import Tree


def tree_energy(tree: Tree, chain: Sequence[Joint], keep: Stages) -> sp.Expr:
    """T + V."""
    total, fields, depths = -tree.rest, list[Small](), list[sp.Expr]()
    for joint in chain:
        parent = joint.link.parent
        field, depth = (fields[parent], depths[parent]) if parent >= 0 else (Small.of(tree.field), sp.S.Zero)
        fields.append(joint.inward(field, keep))
        depths.append(keep(depth + field.dot(joint.shift)))
        w, v = joint.motion
        for mass in joint.link.masses:
            centre = Small.of(mass.centre)
            at = keep.each(v + w.cross(centre))
            total += keep(mass.mass * at.dot(at) / 2 + w.dot(Small.of(mass.inertia) * w) / 2)
            total -= keep(mass.mass * (depths[-1] + fields[-1].dot(centre)))
    return total
