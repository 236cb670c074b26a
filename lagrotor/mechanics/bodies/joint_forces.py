"""Forces and torques in the joints of a mechanism, by the recursion of Newton and Euler.

The pass outward gives each frame, in its own axes, its angular velocity ω and the accelerations α and a of the frame and of
its origin. With the rotation R, the shift d and the turn rate u of the step from the parent,

    ω = Rᵀ ω_p + u,    α = Rᵀ α_p + (Rᵀ ω_p) × u + u',    a = Rᵀ (a_p + α_p × d + ω_p × (ω_p × d) + 2 ω_p × d' + d'').

The pass inward sums what the bodies need, less their weights and the loads, about the origin of each frame:

    F = Σ m (a_c − g) − Σ F_load,        N = Σ (I α + ω × I ω + c × m (a_c − g)) − Σ (T_load + r × F_load).

At the last frame of a joint (N, F) is the torque and the force that the frame before the joint exerts on it. They contain
the bearing, the drive, the spring and the damper of the joint; its component along the joint's axis is the drive. A
multiplier λ of a loop is a load on the two frames that the loop joins.

Luh, Walker & Paul, J. Dyn. Sys. Meas. Control 102 (1980) 69; Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 5.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, near
from lagrotor.mechanics.bodies.moving_frames import Load, MovingFrame, Source, quaternion_rows
from lagrotor.mechanics.bodies.small_matrices import Small, Stages, blocks, halves, wedge, zeros
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import shortest
from lagrotor.mechanics.lagrangian import euler_lagrange, jacobian, total_derivative

_NONE = zeros(3, 1)
Wrenches = dict[MovingFrame, Small]


@dataclass(frozen=True, eq=False)
class JointForce:
    """The force and the torque that one side of a joint exerts on the other, at the joint.

    The frame before a joint exerts them on the frame after it, at the origin of that frame. In a joint that closes a loop,
    `first.coincides(second, name=…)`, the second frame exerts them on the first.

    Attributes
    ----------
    force : Matrix or ndarray
        The force in N: expressions, shape (3, 1), or numbers at the n times of a run, shape (n, 3).
    torque : Matrix or ndarray
        The torque about the joint's origin in N m, in the same form.
    """

    force: Any
    torque: Any


@dataclass(frozen=True)
class FrameMotion:
    """The motion of a frame in its own axes, with the fields (3, k) of weight in these axes.

    A point r of the frame has the acceleration `lift` + K r with K = [α]× + [ω]×², the field `bend`.
    """

    rotation: Small
    shift: Small
    spin: Small
    turn: Small
    lift: Small
    bend: Small
    fields: Small


def frames_of(*ends: MovingFrame) -> list[MovingFrame]:
    """Return the frames on the way from the ground to each end, without the ground, parents first."""
    steps = (step for end in ends for step in reversed(end.to_the_ground) if step.parent is not None)
    return list(dict.fromkeys(steps))


def joint_frames(system: Equations) -> dict[str, MovingFrame]:
    """Return the last frame of each joint that carries bodies, by the joint's name, from the ground outward.

    A joint without a name is called after its coordinates, unless another joint or a constraint has that name.
    """
    found = dict[MovingFrame, str]()
    for body in system.bodies:
        outward, frame = list[tuple[MovingFrame, MovingFrame]](), body.frame
        while frame.parent is not None:
            before = frame.base or frame.parent
            outward.append((frame, before))
            frame = before
        for joint, before in reversed(outward):
            used = set().union(*(step.amount.free_symbols for step in {*frames_of(joint)} - {*frames_of(before)}))
            found[joint] = joint.name or " ".join(str(q) for q in system.c.q if q in used)
    times, taken = Counter(found.values()), {"", *system.multiplier_names}
    return {name: frame for frame, name in found.items() if frame.name or (times[name] == 1 and name not in taken)}


def loops(system: Equations) -> dict[str, list[tuple[sp.Symbol, Load]]]:
    """Return the joints that close loops, by name: each multiplier, with its load on the first frame for a multiplier of 1."""
    named = dict[str, list[tuple[sp.Symbol, Load]]]()
    for lam, source in zip(system.multipliers, _sources(system), strict=True):
        if source is not None and source.name:
            named.setdefault(source.name, []).append((lam, source.loads[0]))
    return named


def joint_names(system: Equations) -> tuple[str, ...]:
    """Return the names of all joints: those that carry bodies, then those that close loops."""
    return tuple(dict.fromkeys((*joint_frames(system), *(loops(system) if system.bodies else ()))))


def joint_force(system: Equations, name: str, axes: str) -> JointForce:
    """Return the force and the torque in a joint as expressions: `System.joint_force`."""
    keep = Stages()
    outputs = joint_outputs(system, [name], axes, placed_loads("joint_force", system), keep)
    written = [shortest(e) for e in written_out([*ball_rates(system), *keep.made], outputs)]
    return JointForce(sp.Matrix(written[3:]), sp.Matrix(written[:3]))


def joint_outputs(
    system: Equations, names: Sequence[str], axes: str, loads: Sequence[Load], keep: Stages
) -> list[sp.Expr]:
    """Return the torque and the force in each joint, six expressions a joint, in the symbols of `keep`."""
    if axes not in ("ground", "joint"):
        raise InputError(f"joint_force: axes = {axes!r} must be 'ground' or 'joint'")
    carrying, closing = joint_frames(system), loops(system)
    if wrong := [name for name in names if name not in {*carrying, *closing}]:
        known = joint_names(system)
        raise InputError(
            f"joint_force: {wrong[0]!r} is none of the joints {', '.join(known) or '(none)'}{near(wrong[0], known)}: name a "
            "joint by Frame.pin(…, name='elbow'); one without a name is called after its coordinates"
        )
    frames = frames_of(*(body.frame for body in system.bodies), *(load.frame for load in loads))
    motions = frame_motions(system, frames, keep)
    total = inward(frames, motions, body_wrenches(system, motions, keep), loads, keep)
    outputs = list[sp.Expr]()
    for name in names:
        if name in carrying:
            frame, wrench = carrying[name], total[carrying[name]]
        else:
            frame, wrench = closing[name][0][1].frame, zeros(6, 1)
            for lam, load in closing[name]:
                wrench += blocks([[in_axes(e, load.axes, frame, keep)] for e in (load.torque, load.force)]) * lam
        for part in halves(wrench):
            seen = in_axes(part, frame, frame.to_the_ground[-1], keep) if axes == "ground" else part
            outputs += [e for (e,) in seen.rows]
    return outputs


def placed_loads(where: str, system: Equations) -> list[Load]:
    """Return the loads on the frames: applied forces, and multipliers of constraints.

    Raise InputError for a term of the system that does not say on which bodies it acts. Forces without a place act in the
    joints of their coordinates.
    """
    c, L = system.c, system.lagrangian
    if not system.bodies:
        raise InputError(
            f"{where}: the Lagrangian has no bodies and says nothing of joints: build it from Frame(c).pin(…).body(…)"
        )

    def refusal(what: str, remedy: str) -> InputError:
        return InputError(f"{where}: {what} does not say on which bodies it acts: {remedy}")

    if (applied := getattr(system.forces, "loads", ())) is None:
        raise refusal(
            f"the force {system.forces}", "use Frame.force on the frames, unchanged; a Pathway knows no bodies"
        )
    moving, balls = (
        {*c.q, *c.v},
        [{*b.quaternion, *(system.c.v[c.q.index(q)] for q in b.quaternion)} for b in system.ball_joints],
    )
    if wrong := unsteady_weights(system):
        raise refusal(f"a weight with {min(map(str, wrong))}", "keep field and factor free of coordinates")
    for term in sp.Add.make_args(L.remainder):
        inside = term.free_symbols & moving
        is_spring = len(inside) == 1 and (s := min(inside)) in c.q and term.is_polynomial(s) and sp.degree(term, s) > 1
        if inside and not is_spring:
            way = "write a weight as body.potential((0, 0, -g)), the spring of a joint as -k*q**2/2, others as frame.force(…)"
            raise refusal(f"the term {term} of L", way)
    for term in sp.Add.make_args(sp.expand(system.dissipation)):
        inside = term.free_symbols & moving
        if (len(inside) > 1 and not any(inside <= ball for ball in balls)) or term.free_symbols & {*system.reactions}:
            way = "friction in a joint depends on that joint's velocity alone; give other friction by frame.force(…)"
            raise refusal(f"the dissipation {term}", way)
    loads, units = list(applied), [joint.unit_length for joint in system.ball_joints]
    everything = (*system.constraints, *system.rolling)
    for i, (e, lam, source) in enumerate(zip(everything, system.multipliers, _sources(system), strict=True)):
        if source is not None:
            loads += [_times(load, lam) for load in source.loads]
        elif e not in units and (i >= len(system.constraints) or len(e.free_symbols & moving) > 1):
            raise refusal(f"the constraint {e} = 0", "build it by coincides, keeps_axis or rolls_on")
    return loads


def _times(load: Load, factor: sp.Expr) -> Load:
    return load.each(lambda component: factor * component)


def _sources(system: Equations) -> list[Source | None]:
    """Return for each constraint the frames between which it acts, as far as a method of frames built it."""
    known = set(frames_of(*(body.frame for body in system.bodies)))
    used = set().union(*(frame.amount.free_symbols for frame in known))
    quasi = {u: e for u, e in system.velocities if u != e}
    places = dict[sp.Expr, Source]()
    for e, candidates in system.c.sources.items():
        for source in candidates:
            steps = {step for load in source.loads for step in frames_of(load.frame)} - known
            if not any(step.amount.free_symbols & used & {*system.c.q} for step in steps):  # frames of this system
                places[e.xreplace(quasi)] = source
    return [places.get(e) for e in (*system.constraints, *system.rolling)]


def ball_rates(system: Equations) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the rates of the angular velocities of ball joints, ω' = 2 E(q) q'', as pairs (symbol, expression)."""
    rate = dict(zip(system.c.q, system.c.a, strict=True))
    return [
        (_rate(w), 2 * sp.Add(*(e * rate[q] for e, q in zip(row, joint.quaternion, strict=True))))
        for joint in system.ball_joints
        for w, row in zip(joint.omega, quaternion_rows(*joint.quaternion), strict=True)
    ]


def _rate(u: sp.Symbol) -> sp.Symbol:
    """Return the symbol of u' as in `Equations.speed_rates`."""
    return sp.Symbol(f"{u}_dot", real=True)


def rate_stages(system: Equations) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the stages that compute v and a from the quasi-velocities and their rates; none if the system has none."""
    relation = system.kinematics
    if relation is None:
        return []
    a = relation.B * sp.Matrix(system.speed_rates) + relation.alpha
    pairs = zip((*system.c.v, *system.c.a), (*relation.velocity, *a), strict=True)
    return [*relation.stages, *((s, e) for s, e in pairs if s != e)]


def written_out(stages: Iterable[tuple[sp.Symbol, sp.Expr]], outputs: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Substitute the stages into the outputs."""
    values = dict[sp.Symbol, sp.Expr]()
    for name, e in stages:
        values[name] = e.xreplace(values)
    return [e.xreplace(values) for e in outputs]


def frame_motions(system: Equations, frames: Sequence[MovingFrame], keep: Stages) -> dict[MovingFrame, FrameMotion]:
    """Compute the motion of each frame, from the ground outward, in q, v, a and t; for ball joints in ω and ω'."""
    ground = _still(system)
    motions = dict[MovingFrame, FrameMotion]()

    def rate_of(e: Small) -> Small:
        return e.each(lambda x: total_derivative(x, system.c))

    for frame in frames:
        p = motions.get(frame.parent, ground) if frame.parent is not None else ground
        if frame.axis is None and frame.amount.cols == 1:
            d = keep.each(Small.of(frame.shift))
            d_rate = rate_of(Small.of(frame.shift))
            lift = p.lift + p.bend * d + p.spin.cross(keep.each(d_rate)) * 2 + keep.each(rate_of(d_rate))
            motions[frame] = FrameMotion(ground.rotation, d, p.spin, p.turn, keep.each(lift), p.bend, p.fields)
            continue
        R = keep.each(Small.of(frame.rotation))
        u = Small.column(*frame.omega) if frame.omega else Small.of(frame.turn_rate)
        u_rate = keep.each(Small.column(*map(_rate, frame.omega)) if frame.omega else rate_of(u))
        u, carried = keep.each(u), keep.each(R.T * p.spin)
        spin, turn = keep.each(carried + u), keep.each(R.T * p.turn + carried.cross(u) + u_rate)
        bend = keep.each(wedge(turn) + keep.symmetric(wedge(spin) * wedge(spin)))
        lift, fields = keep.each(R.T * p.lift), keep.each(R.T * p.fields)
        motions[frame] = FrameMotion(R, _NONE, spin, turn, lift, bend, fields)
    return motions


def _fields(system: Equations) -> list[tuple[sp.Expr, ...]]:
    """Return the different uniform fields of weight, in the ground's axes."""
    return list(dict.fromkeys(field for _, field, _ in system.lagrangian.terms if field is not None))


def unsteady_weights(system: Equations) -> set[sp.Basic]:
    """Return the coordinates and velocities in fields or factors of energies, of which the recursion does not know."""
    parts = (e for _, field, factor in system.lagrangian.terms for e in (factor, *(field or ())))
    return set().union(*(e.free_symbols for e in parts)) & {*system.c.q, *system.c.v}


def _still(system: Equations) -> FrameMotion:
    """Return the motion of the ground."""
    fields = Small(list(zip(*_fields(system), strict=True)) or [[]] * 3)
    return FrameMotion(Small.of(sp.eye(3)), _NONE, _NONE, _NONE, _NONE, zeros(3, 3), fields)


def body_wrenches(system: Equations, motions: Mapping[MovingFrame, FrameMotion], keep: Stages) -> Wrenches:
    """Return the torque and force (N, F) about each frame's origin that its bodies need, less their weights."""
    ground, fields, wrenches = _still(system), _fields(system), Wrenches()
    for body, field, factor in system.lagrangian.terms:
        at, c = motions.get(body.frame, ground), Small.of(body.centre)
        if field is None:
            f, I = (at.lift + at.bend * c) * (factor * body.mass), Small.of(body.inertia) * factor
            n = I * at.turn + at.spin.cross(keep.each(I * at.spin))
        else:
            column = fields.index(field)
            f, n = Small([[row[column]] for row in at.fields.rows]) * (factor * body.mass), _NONE
        wrench = blocks([[n + c.cross(f := keep.each(f))], [f]])
        wrenches[body.frame] = keep.each(wrenches.get(body.frame, zeros(6, 1)) + wrench)
    return wrenches


def inward(
    frames: Sequence[MovingFrame],
    motions: Mapping[MovingFrame, FrameMotion],
    wrenches: Wrenches,
    loads: Sequence[Load],
    keep: Stages,
) -> Wrenches:
    """Sum the wrenches, shape (6, k) each, of all that each frame carries, less the loads, about the origin of the frame."""
    total = dict(wrenches)
    for load in loads:
        f, n = (in_axes(e, load.axes, load.frame, keep) for e in (load.force, load.torque))
        wrench = blocks([[n + Small.column(*load.at).cross(f)], [f]])
        total[load.frame] = keep.each(total.get(load.frame, zeros(6, 1)) - wrench)
    for frame in reversed(frames):
        parent = frame.parent
        if parent is None or parent.parent is None or frame not in total:
            continue
        n, f = halves(total[frame])
        R, d = motions[frame].rotation, motions[frame].shift
        n, f = keep.each(R * n), keep.each(R * f)
        wrench = blocks([[n + wedge(d) * f], [f]])
        total[parent] = keep.each(total[parent] + wrench) if parent in total else keep.each(wrench)
    return total


def in_axes(vector: Any, source: MovingFrame, target: MovingFrame, keep: Stages) -> Small:
    """Return the components of a vector along the axes of `target`, from those along the axes of `source`."""
    e = vector if isinstance(vector, Small) else Small.column(*vector)
    down = frames_of(target)
    for step in reversed(frames_of(source)):
        if step in down:
            down = down[down.index(step) + 1 :]
            break
        e = keep.each(keep.each(Small.of(step.rotation)) * e)
    for step in down:
        e = keep.each(keep.each(Small.of(step.rotation)).T * e)
    return e


def generalised(system: Equations, total: Wrenches, rest: sp.Matrix | None = None) -> sp.Matrix:
    """Return the generalised forces, shape (m, k), for `speeds`, of the wrenches (6, k) at the frames, by virtual power.

    `rest` are further forces for the velocities v, shape (n, k).
    """
    c = system.c
    columns = next((len(wrench.rows[0]) for wrench in total.values()), 1)
    by_v, by_speed = sp.zeros(len(c.q), columns) if rest is None else rest, sp.zeros(len(system.speeds), columns)
    for frame, wrench in total.items():
        n, f = (half.matrix for half in halves(wrench))
        if frame.parent is None:
            continue
        if frame.omega:
            for k, w in enumerate(frame.omega):
                by_speed[system.speeds.index(w), :] += n[k, :]
        elif frame.axis is None and frame.amount.cols == 1:
            rate = [total_derivative(e, c) for e in frame.amount]
            by_v += jacobian(rate, c.v).T * f
        else:
            by_v += jacobian(list(frame.turn_rate), c.v).T * n
    return by_speed + (by_v if system.kinematics is None else system.kinematics.B.T * by_v)


def inverse_outputs(system: Equations, keep: Stages) -> list[sp.Expr]:
    """Return the forces that must act besides those of the system, in q, v and a; for ball joints in ω and ω'."""
    c, frames = system.c, frames_of(*(body.frame for body in system.bodies))
    motions = frame_motions(system, frames, keep)
    total = inward(frames, motions, body_wrenches(system, motions, keep), (), keep)
    rest = euler_lagrange(system.lagrangian.remainder, c) - system.generalised_forces
    return list(generalised(system, total, rest))
