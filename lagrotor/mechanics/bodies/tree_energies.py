"""The energy of a tree of bodies, in stages, with the velocities (ω, v) of the links.

Where time moves a joint, T = T₂ + T₁ + T₀ in powers of the velocities, and the Jacobi integral is T₂ − T₀ + V. With v* the
velocity that time alone gives, T₂ − T₀ is ½ m (v − 2 v*)·v, and likewise for the turning. Goldstein §2.7.
"""

from collections.abc import Sequence

import sympy as sp

from lagrotor.mechanics.bodies.joints import Joint
from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.mechanics.bodies.stages import Stages
from lagrotor.mechanics.bodies.trees import ZERO, Pair, Tree
from lagrotor.mechanics.lagrangian import Coordinates


def tree_energy(tree: Tree, chain: Sequence[Joint], c: Coordinates, keep: Stages) -> sp.Expr:
    """v·∂L/∂v − L."""
    total, fields, depths = -tree.rest.subs(dict.fromkeys(c.v, 0)), list[Small](), list[sp.Expr]()
    moving = _velocities(chain, [joint.rate for joint in chain], keep)
    by_time = [(_at_rest(u, c), _at_rest(d, c)) for u, d in (joint.link.rate for joint in chain)]
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


def _at_rest(rate: Small, c: Coordinates) -> Small:
    return rate.each(lambda e: e.subs(dict.fromkeys(c.v, 0)))


def _velocities(chain: Sequence[Joint], rates: Sequence[Pair], keep: Stages) -> list[Pair]:
    """(ω, v) of each link, in its axes: its parent's, and its own relative to it."""
    found: list[Pair] = []
    for joint, (u, d) in zip(chain, rates, strict=True):
        w, v = found[joint.link.parent] if joint.link.parent >= 0 else (ZERO, ZERO)
        v = joint.inward(keep.each(v + w.cross(joint.shift)), keep)
        found.append((keep.each(joint.inward(w, keep) + u), keep.each(v + d)))
    return found
