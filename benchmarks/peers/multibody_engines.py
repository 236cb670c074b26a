"""Multibody engines on the pair, and on any number of rotors: MuJoCo, Pinocchio and Drake.

A rigid bar without mass is a distance constraint. MuJoCo's are soft, Drake's solver for them goes in steps of first
order; where an engine gives mass matrix, bias and Jacobians instead, the multipliers are solved for as in its examples, or by
sparse LU, and odeint steps the angles. Spin comes last among these, so that they do not turn with the rotor.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.rig import Rig, rig_of
from benchmarks.peers.sympy_mechanics import angles, axes_of, check_odeint
from lagrotor.benchmark.runner import Method, Prepare, Runner
from lagrotor.errors import IntegrationError

Array = NDArray[np.float64]

_LARGEST = 400  # speeds, beyond which Pinocchio's Data takes gigabytes
_MJCF = """<mujoco><option timestep="{step:.17g}" gravity="0 0 0" integrator="RK4" tolerance="1e-12"/>
<worldbody>{rotors}</worldbody><tendon>{bars}</tendon><equality>{equal}</equality></mujoco>"""
_ROTOR = """<body pos="{x:.17g} {y:.17g} 0"><joint type="ball"/><inertial pos="0 0 {middle}" mass="{M}"
diaginertia="{I1} {I1} {I3}"/><site name="tip{i}" pos="0 0 {R}"/></body>"""
_BAR = '<spatial name="bar{k}"><site site="tip{i}"/><site site="tip{j}"/></spatial>'
_EQUAL = '<tendon tendon1="bar{k}" solref="{twice:.17g} 1" solimp="0.9999 0.9999 0.001"/>'


def mujoco(rig: Rig, t_eval: Array) -> Runner:
    """MuJoCo: ball joints, each bar a tendon of fixed length, RK4 for its accuracy, equal output times.

    solref: the stiffest that its documentation advises, a time constant of two steps, critically damped; solimp: its
    upper bound. So the bar gives by what turning pulls at it, in proportion to the step squared.
    """
    import mujoco as mj

    rotor, every = rig.rotor, t_eval[1] - t_eval[0]
    rotors = "".join(
        _ROTOR.format(x=x, y=y, middle=rotor.length / 2, M=rotor.mass, I1=rotor.I1, I3=rotor.I3, R=rotor.length, i=i)
        for i, (x, y) in enumerate(rig.feet)
    )
    bars = "".join(_BAR.format(k=k, i=i, j=j) for k, (i, j) in enumerate(rig.bars))

    def run(step: float) -> tuple[Array, int]:
        equal = "".join(_EQUAL.format(k=k, twice=2 * step) for k in range(len(rig.bars)))
        model = mj.MjModel.from_xml_string(_MJCF.format(step=step, rotors=rotors, bars=bars, equal=equal))
        data, count = mj.MjData(model), round(every / step)
        for i, (R, Omega) in enumerate(rig.turns):
            mj.mju_mat2Quat(data.qpos[4 * i : 4 * i + 4], R.ravel())
            data.qvel[3 * i : 3 * i + 3] = R.T @ Omega
        mj.mj_kinematics(model, data)
        sites = [data.site_xpos.copy()]
        for _ in t_eval[1:]:
            mj.mj_step(model, data, count)
            mj.mj_kinematics(model, data)
            sites.append(data.site_xpos.copy())
        return np.array(sites).swapaxes(0, 1), 4 * count * (len(t_eval) - 1)

    return run


def _solve(rig: Rig, t_eval: Array, rhs: Any) -> Runner:
    """rate(angles and speeds (6 N,)) → speeds and accelerations (6 N,), by odeint."""
    from scipy.integrate import odeint

    start = angles(rig)

    def run(tol: float) -> tuple[Array, int]:
        states, log = odeint(rhs, start, t_eval, rtol=tol, atol=tol, mxstep=100_000, full_output=True)
        check_odeint(log)
        return rig.tips(axes_of(states)), int(log["nfe"][-1])

    return run


def _sparse_accelerations(mass: Array, bias: Array, rows: Array, drift: Array) -> Array:
    """Of M q'' + bias = rowsᵀ lam, rows q'' = −drift, by sparse LU: faster than its own solver for many bars."""
    from scipy.sparse import block_array, csc_array
    from scipy.sparse.linalg import splu

    M, G = csc_array(mass), csc_array(rows)
    return np.asarray(splu(block_array([[M, G.T], [G, None]], format="csc")).solve(np.concatenate([-bias, -drift])))[
        : len(bias)
    ]


def pinocchio(rig: Rig, t_eval: Array, sparse: bool = False) -> Runner:
    """Pinocchio: three hinges a rotor; forwardDynamics with the bars' Jacobian and its drift, or sparse LU; odeint."""
    import pinocchio as pin

    model, rotor = pin.Model(), rig.rotor
    model.gravity = pin.Motion.Zero()
    inertia = pin.Inertia(rotor.mass, np.array([0, 0, rotor.length / 2]), np.diag([rotor.I1, rotor.I1, rotor.I3]))
    for i, (x, y) in enumerate(rig.feet):
        joint, place = 0, pin.SE3(np.eye(3), np.array([x, y, 0.0]))
        for hinge in (pin.JointModelRX(), pin.JointModelRY(), pin.JointModelRZ()):
            joint = model.addJoint(joint, hinge, place, f"{hinge.shortname()} {i}")
            place = pin.SE3.Identity()
        model.appendBodyToJoint(joint, inertia, place)
    if model.nv > _LARGEST:
        raise IntegrationError(
            f"Pinocchio's Data holds four tensors of {model.nv}³ numbers, {32e-9 * model.nv**3:.0f} GB"
        )
    N, data, none = len(rig.feet), model.createData(), np.zeros(model.nv)
    (i, j), columns = np.array(rig.bars).T, np.arange(3 * N).reshape(N, 3)
    each = np.arange(len(i))[:, None]

    def rhs(y: Array, t: float) -> Array:
        q, v = y[: 3 * N], y[3 * N :]
        pin.computeAllTerms(model, data, q, v)
        pin.computeJointJacobiansTimeVariation(model, data, q, v)
        tip = rig.tips(axes_of(y[None]))[:, 0]
        J, dJ = (np.ascontiguousarray(part).reshape(2, 3, N, 3).transpose(0, 2, 3, 1) for part in (data.J, data.dJ))
        speeds = v.reshape(N, 3)
        turning, (moving, turned) = np.einsum("nkm,nk->nm", J[1], speeds), np.einsum("pnkm,nk->pnm", dJ, speeds)
        reach = J[0] + np.cross(J[1], tip[:, None])  # (N, 3 hinges, 3)
        speed = np.einsum("nkm,nk->nm", reach, speeds)
        gap, apart = tip[j] - tip[i], speed[j] - speed[i]
        bent = moving + np.cross(turned, tip) + np.cross(turning, speed)
        drift = (apart * apart).sum(1) + (gap * (bent[j] - bent[i])).sum(1)
        rows = np.zeros((len(i), 3 * N))
        rows[each, columns[j]] = np.einsum("bm,bkm->bk", gap, reach[j])
        rows[each, columns[i]] = -np.einsum("bm,bkm->bk", gap, reach[i])
        if sparse:
            upper = np.triu(data.M)
            mass = upper + np.triu(upper, 1).T
            return np.concatenate([v, _sparse_accelerations(mass, data.nle, rows, drift)])
        return np.concatenate([v, pin.forwardDynamics(model, data, none, rows, drift)])

    return _solve(rig, t_eval, rhs)


def _drake_plant(rig: Rig, step: float) -> tuple[Any, list[Any], list[Any]]:
    """A plant with the rotors, each on a ball joint (a discrete plant) or three hinges; bodies, joints."""
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
    from pydrake.multibody.tree import (
        BallRpyJoint,
        FixedOffsetFrame,
        RevoluteJoint,
        RotationalInertia,
        SpatialInertia,
    )

    plant, rotor, bodies, joints = MultibodyPlant(step), rig.rotor, [], []
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    whole = SpatialInertia.MakeFromCentralInertia(
        rotor.mass, [0, 0, rotor.length / 2], RotationalInertia(rotor.I1, rotor.I1, rotor.I3)
    )
    for i, (x, y) in enumerate(rig.feet):
        frame = plant.AddFrame(FixedOffsetFrame(f"ground {i}", plant.world_frame(), RigidTransform([x, y, 0])))
        if step:
            bodies.append(plant.AddRigidBody(f"rotor {i}", whole))
            joints.append(plant.AddJoint(BallRpyJoint(f"joint {i}", frame, bodies[-1].body_frame())))
            continue
        for name, axis in zip("xyz", np.eye(3), strict=True):
            body = plant.AddRigidBody(f"{name} {i}", whole if name == "z" else SpatialInertia.Zero())
            plant.AddJoint(RevoluteJoint(f"joint {name} {i}", frame, body.body_frame(), axis))
            frame = body.body_frame()
        bodies.append(body)
    if step:
        tip = np.array([0, 0, rotor.length])
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        for i, j in rig.bars:
            length = float(np.linalg.norm(rig.feet[j] - rig.feet[i]))
            plant.AddDistanceConstraint(bodies[i], tip, bodies[j], tip, length)
    plant.Finalize()
    return plant, bodies, joints


def drake_discrete(rig: Rig, t_eval: Array) -> Runner:
    """Drake: ball joints, AddDistanceConstraint of infinite stiffness, a rigid rod, with the SAP solver in its steps."""
    from pydrake.math import RollPitchYaw, RotationMatrix
    from pydrake.systems.analysis import Simulator

    tip = np.array([0, 0, rig.rotor.length])

    def run(step: float) -> tuple[Array, int]:
        plant, bodies, joints = _drake_plant(rig, step)
        simulator = Simulator(plant)
        context, tips = simulator.get_mutable_context(), []
        for joint, (R, Omega) in zip(joints, rig.turns, strict=True):
            joint.set_angles(context, RollPitchYaw(RotationMatrix(R)).vector())
            joint.set_angular_velocity(context, Omega)
        for t in t_eval:
            try:
                simulator.AdvanceTo(t)
            except RuntimeError as refusal:
                raise IntegrationError(f"Drake stopped before t = {t:.3g} s: {str(refusal).split('.')[0]}") from None
            tips.append([plant.EvalBodyPoseInWorld(context, body).multiply(tip) for body in bodies])
        return np.array(tips).swapaxes(0, 1), round(t_eval[-1] / step)

    return run


def drake_multipliers(rig: Rig, t_eval: Array) -> Runner:
    """Drake: a continuous plant, which takes no such constraint; its mass matrix, bias and Jacobians, then sparse LU."""
    from pydrake.multibody.tree import JacobianWrtVariable

    plant, bodies, _ = _drake_plant(rig, 0.0)
    context, world, tip = plant.CreateDefaultContext(), plant.world_frame(), np.array([0, 0, rig.rotor.length])
    speeds, frames = JacobianWrtVariable.kV, [body.body_frame() for body in bodies]
    half = plant.num_velocities()

    def rhs(y: Array, t: float) -> Array:
        plant.SetPositionsAndVelocities(context, y)
        tips = rig.tips(axes_of(y[None]))[:, 0]
        reach = [plant.CalcJacobianTranslationalVelocity(context, speeds, f, tip, world, world) for f in frames]
        bent = [plant.CalcBiasTranslationalAcceleration(context, speeds, f, tip, world, world).ravel() for f in frames]
        rows, drift = np.zeros((len(rig.bars), half)), np.empty(len(rig.bars))
        for k, (i, j) in enumerate(rig.bars):
            gap = tips[j] - tips[i]
            rows[k] = gap @ (reach[j] - reach[i])
            apart = (reach[j] - reach[i]) @ y[half:]
            drift[k] = apart @ apart + gap @ (bent[j] - bent[i])
        accelerations = _sparse_accelerations(plant.CalcMassMatrix(context), plant.CalcBiasTerm(context), rows, drift)
        return np.concatenate([y[half:], accelerations])

    return _solve(rig, t_eval, rhs)


ENGINES: dict[str, tuple[Callable[[Rig, Array], Runner], tuple[float, ...]]] = {
    "MuJoCo": (mujoco, (1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)),
    "Pinocchio": (pinocchio, ()),
    "Pinocchio, sparse": (partial(pinocchio, sparse=True), ()),
    "Drake, SAP": (drake_discrete, (2e-3, 1e-3, 5e-4, 2e-4)),
    "Drake, multipliers": (drake_multipliers, ()),
}


def _on_the_pair(prepare: Callable[[Rig, Array], Runner]) -> Prepare:
    return lambda scene, t_eval: prepare(rig_of(scene), t_eval)


BODIES: dict[str, Method] = {
    name: Method("peer", _on_the_pair(prepare), steps, "--group engines")
    for name, (prepare, steps) in ENGINES.items()
    if name != "Pinocchio, sparse"  # one bar is no sparse system
}
