"""Multibody engines on a mechanism: MuJoCo, Pinocchio and Drake, in the same joint coordinates.

MuJoCo needs mass in every body that moves: where there is none, 10⁻¹⁴ kg and 10⁻¹⁴ kg m² take its place.
"""

from typing import Any

import numpy as np

from benchmarks.mechanisms.chains import I1, I3, VALUES, g, l, m
from benchmarks.mechanisms.tool import Array, Ready, Tool
from lagrotor.benchmark.records import MechanismKind

_M, _L, _G, _I1, _I3 = (VALUES[s] for s in (m, l, g, I1, I3))
_NONE = 1e-14


def mujoco(kind: MechanismKind, n: int) -> Ready:
    """MuJoCo: mj_forward for the right-hand side, its Runge–Kutta of fourth order for runs."""
    import mujoco as mj

    model = mj.MjModel.from_xml_string(_mjcf(kind, n))
    data = mj.MjData(model)

    def rhs(t: float, y: Array) -> Array:
        data.qpos[:], data.qvel[:] = y[: model.nq], y[model.nq :]
        mj.mj_forward(model, data)
        return np.concatenate([data.qvel, data.qacc])

    def run(start: Array, times: Array, step: float) -> Array:
        count = round(float(times[1] - times[0]) / step)
        model.opt.timestep = (times[1] - times[0]) / count
        data.qpos[:], data.qvel[:] = start[: model.nq], start[model.nq :]
        coordinates = [start[: model.nq]]
        for _ in times[1:]:
            mj.mj_step(model, data, count)
            coordinates.append(data.qpos.copy())
        return np.array(coordinates)

    return Ready(rhs, run, tuple(0.01 / 2**k for k in range(10)))


def _mjcf(kind: MechanismKind, n: int) -> str:
    """Nested bodies in MuJoCo's format."""
    text, mass = "", f'<inertial pos="0 0 {{}}" mass="{_M}" diaginertia="{{}} {{}} {{}}"/>'
    for i in reversed(range(n)):
        if kind == "rods":
            at = -_L if i else 0.0
            own = f'<joint type="hinge" axis="0 1 0"/>{mass.format(-_L, _NONE, _NONE, _NONE)}'
        else:
            at = _L if i else 0.0
            none = f'<inertial pos="0 0 0" mass="{_NONE}" diaginertia="{_NONE} {_NONE} {_NONE}"/>'
            rotor = f'<body><joint type="hinge" axis="0 0 1"/>{mass.format(_L / 2, _I1, _I1, _I3)}</body>'
            own = f'<joint type="hinge" axis="1 0 0"/><joint type="hinge" axis="0 1 0"/>{none}{rotor}'
        text = f'<body pos="0 0 {at}">{own}{text}</body>'
    return (
        f'<mujoco><option gravity="0 0 {-_G}" integrator="RK4"><flag contact="disable" constraint="disable"/></option>'
        f"<worldbody>{text}</worldbody></mujoco>"
    )


def pinocchio(kind: MechanismKind, n: int) -> Ready:
    """Pinocchio: the articulated-body algorithm, aba."""
    import pinocchio as pin

    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -_G])
    here, none = pin.SE3.Identity(), np.zeros(3 * n if kind == "gyroscopes" else n)
    joint, place = 0, here
    for i in range(n):
        if kind == "rods":
            joint = model.addJoint(joint, pin.JointModelRY(), place, f"y{i}")
            inertia = pin.Inertia(_M, np.array([0, 0, -_L]), np.zeros((3, 3)))
            model.appendBodyToJoint(joint, inertia, here)
            place = pin.SE3(np.eye(3), np.array([0, 0, -_L]))
            continue
        joint = model.addJoint(joint, pin.JointModelRX(), place, f"x{i}")
        joint = model.addJoint(joint, pin.JointModelRY(), here, f"y{i}")
        rotor = model.addJoint(joint, pin.JointModelRZ(), here, f"z{i}")
        inertia = pin.Inertia(_M, np.array([0, 0, _L / 2]), np.diag([_I1, _I1, _I3]))
        model.appendBodyToJoint(rotor, inertia, here)
        place = pin.SE3(np.eye(3), np.array([0, 0, _L]))
    data = model.createData()

    def rhs(t: float, y: Array) -> Array:
        v = y[model.nq :]
        return np.concatenate([v, pin.aba(model, data, y[: model.nq], v, none)])

    return Ready(rhs)


def drake(kind: MechanismKind, n: int) -> Ready:
    """Drake: a continuous MultibodyPlant, its time derivatives, and runs by its Runge–Kutta of fifth order."""
    from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

    plant = _drake_plant(kind, n)
    context = plant.CreateDefaultContext()
    size = plant.num_positions()

    def rhs(t: float, y: Array) -> Array:
        plant.SetPositionsAndVelocities(context, y)
        return np.asarray(plant.EvalTimeDerivatives(context).CopyToVector())

    def run(start: Array, times: Array, tol: float) -> Array:
        simulator = Simulator(plant)
        ResetIntegratorFromFlags(simulator, "runge_kutta5", 0.1)
        simulator.get_mutable_integrator().set_target_accuracy(tol)
        inside = simulator.get_mutable_context()
        plant.SetPositionsAndVelocities(inside, start)
        simulator.Initialize()
        coordinates = [start[:size]]
        for t in times[1:]:
            simulator.AdvanceTo(t)
            coordinates.append(plant.GetPositions(inside).copy())
        return np.array(coordinates)

    return Ready(rhs, run, tuple(10.0**-k for k in range(5, 14)))


def _drake_plant(kind: MechanismKind, n: int) -> Any:
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import FixedOffsetFrame, RevoluteJoint, RotationalInertia, SpatialInertia, UnitInertia

    plant = MultibodyPlant(0.0)
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -_G])
    ball = SpatialInertia(_M, [0, 0, -_L], UnitInertia.PointMass([0, 0, -_L]))
    wheel = SpatialInertia.MakeFromCentralInertia(_M, [0, 0, _L / 2], RotationalInertia(_I1, _I1, _I3))
    none, frame = SpatialInertia.Zero(), plant.world_frame()

    def hinge(name: str, axis: int, before: Any, inertia: Any) -> Any:
        body = plant.AddRigidBody(name, inertia)
        plant.AddJoint(RevoluteJoint(name, before, body.body_frame(), np.eye(3)[axis]))
        return body.body_frame()

    for i in range(n):
        if kind == "rods":
            frame, length = hinge(f"y{i}", 1, frame, ball), -_L
        else:
            frame, length = hinge(f"y{i}", 1, hinge(f"x{i}", 0, frame, none), none), _L
            hinge(f"z{i}", 2, frame, wheel)
        frame = plant.AddFrame(FixedOffsetFrame(f"end{i}", frame, RigidTransform([0, 0, length])))
    plant.Finalize()
    return plant


ENGINES = {
    "MuJoCo": Tool(mujoco, "mujoco", "--group engines"),
    "Pinocchio": Tool(pinocchio, "pinocchio", "--group engines"),
    "Drake": Tool(drake, "pydrake", "--group engines"),
}
