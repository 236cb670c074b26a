"""Small displacements y of a state (q, u), in which a ball joint has three turns ϑ about the axes of ω for its four quaternions:

    δ(q, u) = P y,    δq = ½ Eᵀ(q) ϑ of a quaternion,        y' = P⁻ (∂f/∂(q, u) P − P') y

about a motion (q, u)' = f, P⁻ the left inverse. In the turned axes nothing changes with time where a body only spins.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp

from lagrotor.mechanics.bodies.moving_frames import quaternion_rows
from lagrotor.mechanics.equations import Equations


def small_states(system: Equations) -> tuple[sp.Symbol, ...]:
    """The names of y: coordinates and velocities, turn_p for the small turn of a ball joint about the axis of p."""
    first = {joint.quaternion[0]: joint.omega for joint in system.ball_joints}
    gone = {q for joint in system.ball_joints for q in joint.quaternion[1:]}
    names = [
        [sp.Symbol(f"turn_{w}", real=True) for w in first[q]] if q in first else [q]
        for q in system.c.q
        if q not in gone
    ]
    return (*(s for part in names for s in part), *system.speeds)


def small_turns(system: Equations, state: Any) -> tuple[list[list[Any]], list[list[Any]]]:
    """P (d, k) and P⁻ (k, d) at a state of d components, affine in it."""
    c, joints = system.c, {joint.quaternion[0]: joint for joint in system.ball_joints}
    gone = {q for joint in joints.values() for q in joint.quaternion[1:]}
    columns, rows = list[dict[int, Any]](), list[dict[int, Any]]()
    for i, s in enumerate((*c.q, *system.speeds)):
        if s in joints:
            places = [c.q.index(q) for q in joints[s].quaternion]
            for row in quaternion_rows(*(state[j] for j in places)):
                columns.append({j: x / 2 for j, x in zip(places, row, strict=True)})
                rows.append({j: 2 * x for j, x in zip(places, row, strict=True)})
        elif s not in gone:
            columns.append({i: 1})
            rows.append({i: 1})
    d = len(c.q) + len(system.speeds)
    return [[e.get(j, 0) for e in columns] for j in range(d)], [[e.get(j, 0) for j in range(d)] for e in rows]


def no_turn(quaternion: Sequence[sp.Symbol], norm: float) -> str:
    """Why a quaternion cannot be a start."""
    return f"the quaternion ({', '.join(map(str, quaternion))}) has norm {norm:.3g} and gives no direction: give one of norm 1"
