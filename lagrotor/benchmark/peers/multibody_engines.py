"""Multibody engines on the pair: MuJoCo, Pinocchio and Drake.

A rigid bar without mass is a distance constraint. MuJoCo's are soft, Drake's solver for them goes in steps of first
order; where an engine gives mass matrix, bias and Jacobians instead, the multiplier is solved for as in its examples,
and odeint steps the angles. Spin comes last among these, so that they do not turn with the rotor.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.method import Method, Runner, tips
from lagrotor.benchmark.peers.sympy_mechanics import angles, axes_of, check_odeint
from lagrotor.errors import IntegrationError
from lagrotor.models.spring_link.rigid_body import rotation_between
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]

_MJCF = """<mujoco><option timestep="{step:.17g}" gravity="0 0 0" integrator="RK4"/>
<worldbody>{rotors}</worldbody>
<tendon><spatial name="bar"><site site="tip0"/><site site="tip1"/></spatial></tendon>
<equality><tendon tendon1="bar" solref="{twice:.17g} 1" solimp="0.9999 0.9999 0.001"/></equality></mujoco>"""
_ROTOR = """<body pos="{x} 0 0"><joint type="ball"/><inertial pos="0 0 {middle}" mass="{M}"
diaginertia="{I1} {I1} {I3}"/><site name="tip{i}" pos="0 0 {R}"/></body>"""


def _half(scene: Scene) -> float:
    assert scene.link is not None
    return scene.link.length / 2


def _turns(scene: Scene) -> list[tuple[Array, Array]]:
    """Each rotor's rotation (3, 3) and angular velocity (3,) in world components, at the start."""
    up = np.array([0.0, 0.0, 1.0])
    return [
        (rotation_between(up, np.array(r)), np.cross(r, v) + spin * np.array(r))
        for r, v, spin in zip(scene.axes, scene.rates, scene.spins, strict=True)
    ]


def mujoco(scene: Scene, t_eval: Array) -> Runner:
    """MuJoCo: ball joints, the bar a tendon of fixed length, RK4 for its accuracy, equal output times.

    solref: the stiffest that its documentation advises, a time constant of two steps, critically damped; solimp: its
    upper bound. So the bar gives by what turning pulls at it, in proportion to the step squared.
    """
    import mujoco as mj

    rotor, every = scene.rotor, t_eval[1] - t_eval[0]
    rotors = "".join(
        _ROTOR.format(x=x, middle=rotor.length / 2, M=rotor.mass, I1=rotor.I1, I3=rotor.I3, R=rotor.length, i=i)
        for i, x in enumerate((-_half(scene), _half(scene)))
    )

    def run(step: float) -> tuple[Array, int]:
        model = mj.MjModel.from_xml_string(_MJCF.format(step=step, twice=2 * step, rotors=rotors))
        data, count = mj.MjData(model), round(every / step)
        for i, (R, Omega) in enumerate(_turns(scene)):
            mj.mju_mat2Quat(data.qpos[4 * i : 4 * i + 4], R.ravel())
            data.qvel[3 * i : 3 * i + 3] = R.T @ Omega
        mj.mj_kinematics(model, data)
        found = [data.site_xpos.copy()]
        for _ in t_eval[1:]:
            mj.mj_step(model, data, count)
            mj.mj_kinematics(model, data)
            found.append(data.site_xpos.copy())
        return np.array(found).swapaxes(0, 1), 4 * count * (len(t_eval) - 1)

    return run


def _solve(scene: Scene, t_eval: Array, rhs: Any) -> Runner:
    """rate(angles and speeds (12,)) → speeds and accelerations (12,), by odeint."""
    from scipy.integrate import odeint

    start = angles(scene)

    def run(tol: float) -> tuple[Array, int]:
        states, log = odeint(rhs, start, t_eval, rtol=tol, atol=tol, full_output=True)
        check_odeint(log)
        return tips(scene, axes_of(states)), int(log["nfe"][-1])

    return run


def pinocchio(scene: Scene, t_eval: Array) -> Runner:
    """Pinocchio: three hinges a rotor, forwardDynamics with the bar's Jacobian and its drift, odeint."""
    import pinocchio as pin

    model, rotor, tip = pin.Model(), scene.rotor, []
    model.gravity = pin.Motion.Zero()
    inertia = pin.Inertia(rotor.mass, np.array([0, 0, rotor.length / 2]), np.diag([rotor.I1, rotor.I1, rotor.I3]))
    for i, x in enumerate((-_half(scene), _half(scene))):
        joint, place = 0, pin.SE3(np.eye(3), np.array([x, 0.0, 0.0]))
        for hinge in (pin.JointModelRX(), pin.JointModelRY(), pin.JointModelRZ()):
            joint = model.addJoint(joint, hinge, place, f"{hinge.shortname()} {i}")
            place = pin.SE3.Identity()
        model.appendBodyToJoint(joint, inertia, place)
        end = pin.SE3(np.eye(3), np.array([0, 0, rotor.length]))
        tip.append(model.addFrame(pin.Frame(f"tip {i}", joint, 0, end, pin.FrameType.OP_FRAME)))
    data, none, world = model.createData(), np.zeros(6), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def rhs(y: Array, t: float) -> Array:
        q, v = y[:6], y[6:]
        pin.computeAllTerms(model, data, q, v)
        pin.forwardKinematics(model, data, q, v, none)
        pin.updateFramePlacements(model, data)
        gap = data.oMf[tip[1]].translation - data.oMf[tip[0]].translation
        first, second = (pin.getFrameJacobian(model, data, f, world)[:3] for f in tip)
        slow, fast = (pin.getFrameVelocity(model, data, f, world).linear for f in tip)
        one, two = (pin.getFrameClassicalAcceleration(model, data, f, world).linear for f in tip)
        drift = (fast - slow) @ (fast - slow) + gap @ (two - one)
        bar = (gap @ (second - first))[None]
        return np.concatenate([v, pin.forwardDynamics(model, data, none, bar, np.array([drift]))])

    return _solve(scene, t_eval, rhs)


def _drake_plant(scene: Scene, step: float) -> tuple[Any, list[Any], list[Any]]:
    """A plant with the two rotors, each on a ball joint (a discrete plant) or three hinges; bodies, joints."""
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
    from pydrake.multibody.tree import (
        BallRpyJoint,
        FixedOffsetFrame,
        RevoluteJoint,
        RotationalInertia,
        SpatialInertia,
    )

    plant, rotor, bodies, joints = MultibodyPlant(step), scene.rotor, [], []
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    whole = SpatialInertia.MakeFromCentralInertia(
        rotor.mass, [0, 0, rotor.length / 2], RotationalInertia(rotor.I1, rotor.I1, rotor.I3)
    )
    for i, x in enumerate((-_half(scene), _half(scene))):
        frame = plant.AddFrame(FixedOffsetFrame(f"ground {i}", plant.world_frame(), RigidTransform([x, 0, 0])))
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
        plant.AddDistanceConstraint(bodies[0], tip, bodies[1], tip, 2 * _half(scene))
    plant.Finalize()
    return plant, bodies, joints


def drake_discrete(scene: Scene, t_eval: Array) -> Runner:
    """Drake: ball joints, AddDistanceConstraint of infinite stiffness, a rigid rod, with the SAP solver in its steps."""
    from pydrake.math import RollPitchYaw, RotationMatrix
    from pydrake.systems.analysis import Simulator

    tip = np.array([0, 0, scene.rotor.length])

    def run(step: float) -> tuple[Array, int]:
        plant, bodies, joints = _drake_plant(scene, step)
        simulator = Simulator(plant)
        context, found = simulator.get_mutable_context(), []
        for joint, (R, Omega) in zip(joints, _turns(scene), strict=True):
            joint.set_angles(context, RollPitchYaw(RotationMatrix(R)).vector())
            joint.set_angular_velocity(context, Omega)
        for t in t_eval:
            try:
                simulator.AdvanceTo(t)
            except RuntimeError as refusal:
                raise IntegrationError(f"Drake stopped before t = {t:.3g} s: {str(refusal).split('.')[0]}") from None
            found.append([plant.EvalBodyPoseInWorld(context, body).multiply(tip) for body in bodies])
        return np.array(found).swapaxes(0, 1), round(t_eval[-1] / step)

    return run


def drake_multipliers(scene: Scene, t_eval: Array) -> Runner:
    """Drake: a continuous plant, which takes no such constraint; its mass matrix, bias and Jacobians, solved by numpy."""
    from pydrake.multibody.tree import JacobianWrtVariable

    plant, bodies, _ = _drake_plant(scene, 0.0)
    context, world, tip = plant.CreateDefaultContext(), plant.world_frame(), np.array([0, 0, scene.rotor.length])
    speeds, frames = JacobianWrtVariable.kV, [body.body_frame() for body in bodies]

    def rhs(y: Array, t: float) -> Array:
        plant.SetPositionsAndVelocities(context, y)
        start, end = (plant.EvalBodyPoseInWorld(context, body).multiply(tip) for body in bodies)
        first, second = (plant.CalcJacobianTranslationalVelocity(context, speeds, f, tip, world, world) for f in frames)
        one, two = (
            plant.CalcBiasTranslationalAcceleration(context, speeds, f, tip, world, world).ravel() for f in frames
        )
        apart = (second - first) @ y[6:]
        matrix, right = np.zeros((7, 7)), np.empty(7)
        matrix[:6, :6] = plant.CalcMassMatrix(context)
        matrix[6, :6] = matrix[:6, 6] = (end - start) @ (second - first)
        right[:6], right[6] = -plant.CalcBiasTerm(context), -(apart @ apart + (end - start) @ (two - one))
        return np.concatenate([y[6:], np.linalg.solve(matrix, right)[:6]])

    return _solve(scene, t_eval, rhs)


BODIES: dict[str, Method] = {
    "MuJoCo": Method("peer", mujoco, (1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4), "engines"),
    "Pinocchio": Method("peer", pinocchio, extra="engines"),
    "Drake, SAP": Method("peer", drake_discrete, (2e-3, 1e-3, 5e-4, 2e-4), "engines"),
    "Drake, multipliers": Method("peer", drake_multipliers, extra="engines"),
}
