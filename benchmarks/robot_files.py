"""Robot files read by lagrotor against Pinocchio (URDF) and MuJoCo (MJCF): forward and inverse dynamics at random states.

    python -m benchmarks.robot_files [--models FOLDER] [NAME …]

The files are those of packages that ship models: example-robot-data and airo-models for URDF, dm_control and gymnasium for
MJCF. They are sought in the folders of installed packages and in FOLDER. Each row of the table has the coordinates, the seconds
until the first evaluation (lagrotor, engine), the microseconds of one forward dynamics (lagrotor, engine), and the largest
relative differences of forward and inverse dynamics at the random states. A difference above 1e-10 ends the script with
exit status 1.

Angles that lagrotor reads as multiples of π are put into the text that Pinocchio reads, with 17 digits. In a file with
constraints (mimic, equality) the engine's mass matrix and bias forces are solved with the Jacobian of the constraints. MuJoCo's
own constraints are soft springs, so it computes no such motion.
"""

import argparse
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.mechanics import System

LARGEST = 1e-10  # relative difference
_STATES = 3
_ROBOTS = "cmeel.prefix/share/example-robot-data/robots"
URDF = {
    "double_pendulum": f"{_ROBOTS}/double_pendulum_description/urdf/double_pendulum.urdf",
    "double_pendulum_continuous": f"{_ROBOTS}/double_pendulum_description/urdf/double_pendulum_continuous.urdf",
    "twodofs": f"{_ROBOTS}/asr_twodof_description/urdf/TwoDofs.urdf",
    "finger_edu": f"{_ROBOTS}/finger_edu_description/robots/finger_edu.urdf",
    "ur3": f"{_ROBOTS}/ur_description/urdf/ur3_robot.urdf",
    "ur5": f"{_ROBOTS}/ur_description/urdf/ur5_robot.urdf",
    "ur10": f"{_ROBOTS}/ur_description/urdf/ur10_robot.urdf",
    "ur3e": "airo_models/arms/ur3e/ur3e.urdf",
    "ur5e": "airo_models/arms/ur5e/ur5e.urdf",
    "kinova": f"{_ROBOTS}/kinova_description/robots/kinova.urdf",
    "panda": f"{_ROBOTS}/panda_description/urdf/panda.urdf",
    "xarm7": f"{_ROBOTS}/xarm_description/urdf/xarm7.urdf",
    "z1": f"{_ROBOTS}/z1_description/urdf/z1.urdf",
    "so101": f"{_ROBOTS}/so_arm_description/urdf/so101.urdf",
    "talos_left_arm": f"{_ROBOTS}/talos_data/robots/talos_left_arm.urdf",
    "allegro_hand": f"{_ROBOTS}/allegro_hand_description/urdf/allegro_right_hand.urdf",
    "robotiq_2f_85": "airo_models/grippers/robotiq_2f_85/urdf/robotiq_2f_85.urdf",
    "baxter": f"{_ROBOTS}/baxter_description/urdf/baxter.urdf",
    "tiago": f"{_ROBOTS}/tiago_description/robots/tiago.urdf",
}
FLOATING = {
    "iris": f"{_ROBOTS}/iris_description/robots/iris.urdf",
    "hextilt_arm": f"{_ROBOTS}/hextilt_description/urdf/hextilt_flying_arm_5.urdf",
    "solo": f"{_ROBOTS}/solo_description/robots/solo.urdf",
    "solo12": f"{_ROBOTS}/solo_description/robots/solo12.urdf",
    "anymal": f"{_ROBOTS}/anymal_b_simple_description/robots/anymal.urdf",
    "go2": f"{_ROBOTS}/go2_description/urdf/go2.urdf",
    "bolt": f"{_ROBOTS}/bolt_description/robots/bolt.urdf",
    "simple_humanoid": f"{_ROBOTS}/simple_humanoid_description/urdf/simple_humanoid.urdf",
    "talos": f"{_ROBOTS}/talos_data/robots/talos_reduced.urdf",
}
_SUITE, _GYM = "dm_control/suite", "gymnasium/envs/mujoco/assets"
MJCF = {
    "pendulum": f"{_SUITE}/pendulum.xml",
    "acrobot": f"{_SUITE}/acrobot.xml",
    "cartpole": f"{_SUITE}/cartpole.xml",
    "ball_in_cup": f"{_SUITE}/ball_in_cup.xml",
    "reacher": f"{_SUITE}/reacher.xml",
    "hopper": f"{_SUITE}/hopper.xml",
    "walker": f"{_SUITE}/walker.xml",
    "cheetah": f"{_SUITE}/cheetah.xml",
    "swimmer": f"{_SUITE}/swimmer.xml",
    "fish": f"{_SUITE}/fish.xml",
    "humanoid": f"{_SUITE}/humanoid.xml",
    "humanoid_CMU": f"{_SUITE}/humanoid_CMU.xml",
    "ant": f"{_GYM}/ant.xml",
    "half_cheetah": f"{_GYM}/half_cheetah.xml",
    "inverted_double_pendulum": f"{_GYM}/inverted_double_pendulum.xml",
    "pusher": f"{_GYM}/pusher.xml",
}


@dataclass(frozen=True)
class Row:
    """One file: its coordinates, seconds until ready and microseconds of an evaluation of lagrotor and of the engine, and the
    largest relative differences of forward and inverse dynamics."""

    name: str
    coordinates: int
    ready: tuple[float, float]
    each: tuple[float, float]
    forward: float
    inverse: float

    def __str__(self) -> str:
        ready, each = (f"{a:9.2f} {b:9.2g}" for a, b in (self.ready, self.each))
        return f"{self.name:<28} {self.coordinates:>4} {ready} {each}   {self.forward:.1e}  {self.inverse:.1e}"


class Machine:
    """A system from a file with a torque on every joint, its right-hand side and its symbols in order."""

    def __init__(self, read: Callable[[], Any]) -> None:
        begin = perf_counter()
        system = self.read = read()
        turned = {q for joint in system.ball_joints for q in joint.quaternion}
        base = {q for name, own in system.joint_coordinates.items() if len(own) > 1 for q in own}
        self.torques = {q: sp.Symbol(f"tau_{q}", real=True) for q in system.c.q if q not in base | turned}
        self.system = replace(system, forces=tuple(self.torques.get(q, sp.S.Zero) for q in system.c.q))
        self.set(dict.fromkeys(self.torques, 0.0))
        self.rhs(0.0, [*(system.start[str(q)] for q in system.c.q), *[0.0] * len(system.speeds)])
        self.ready = perf_counter() - begin

    def set(self, tau: dict[sp.Symbol, float]) -> None:
        self.rhs: Any = self.system.rhs({**self.read.values, **{self.torques[q]: x for q, x in tau.items()}})


def lasting(call: Callable[[], Any], least: float = 0.05) -> float:
    """Return the microseconds of a call."""
    times, begin = 0, perf_counter()
    while perf_counter() - begin < least:
        call()
        times += 1
    return (perf_counter() - begin) / times * 1e6


def compare_urdf(name: str, path: Path, base: str) -> Row:
    import pinocchio as pin

    machine = Machine(lambda: System.from_urdf(path, base=base))
    system = machine.system
    begin = perf_counter()
    root = [pin.JointModelFreeFlyer()] if base == "floating" else []
    text = "\n".join(exact_lines(path, machine.read.notes))
    model = pin.buildModelFromXML(text, *root)
    data = model.createData()
    ready = perf_counter() - begin
    ids = {joint: model.getJointId(joint) for joint in list(model.names)[1 + len(root) :]}
    assert {*ids} == {*list(system.joint_coordinates)[len(root) :]}, (
        f"{name}: other joints: {ids.keys() ^ {*system.joint_coordinates}}"
    )
    q_of = {q: joint for joint, own in system.joint_coordinates.items() for q in own}
    first = 7 * len(root)
    order = [model.joints[ids[q_of[q]]].idx_v for q in system.c.q[first:]]
    random, forward, inverse = np.random.default_rng(1), [], []
    n, at = len(system.c.q), len(root) * 6
    for _ in range(_STATES):
        y = random.uniform(-1, 1, n + len(system.speeds))
        if base == "floating":
            y[3:7] /= np.linalg.norm(y[3:7])
        tau = random.uniform(-1, 1, model.nv)
        tau[:at] = 0
        q, v = pin.neutral(model), np.zeros(model.nv)
        G = gradient_of(system, order, at, model.nv)
        if len(G):
            onto(system, y, first, at)
        for x, speed, place in zip(y[first:n], y[n + at :], order, strict=True):
            joint = next(j for j in model.joints if j.idx_v == place and j.nv == 1)
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(x), np.sin(x)) if joint.nq == 2 else (x,)
            v[place] = speed
        R = np.eye(3)
        if at:
            q[:7] = [*y[:3], *y[4:7], y[3]]
            R = pin.Quaternion(q[6], q[3], q[4], q[5]).toRotationMatrix()
            v[:6] = [*(R.T @ y[n : n + 3]), *y[n + 3 : n + 6]]
        machine.set({c: tau[place] for c, place in zip(system.c.q[first:], order, strict=True)})
        rate = np.array(machine.rhs(0.0, list(y)))[n:]
        a = np.zeros(model.nv)
        a[order] = rate[at:]
        if at:
            a[:6] = [*(R.T @ rate[:3] - np.cross(v[3:6], v[:3])), *rate[3:6]]
        acting = tau - np.asarray(model.damping) * v
        theirs = pin.aba(model, data, q, v, acting).copy()
        if len(G):
            M = pin.crba(model, data, q)
            M = np.triu(M) + np.triu(M, 1).T
            W = np.linalg.solve(M, G.T)
            lam = -np.linalg.solve(G @ W, G @ theirs)
            theirs += W @ lam
        forward.append(np.abs(a - theirs).max() / np.abs(theirs).max())
        chosen = random.uniform(-1, 1, len(rate))
        a[order] = chosen[at:]
        if at:
            a[:6] = [*(R.T @ chosen[:3] - np.cross(v[3:6], v[:3])), *chosen[3:6]]
        theirs = pin.rnea(model, data, q, v, a) + np.asarray(model.damping) * v
        ours = machine.read.inverse_dynamics(y[:n], y[n:], chosen, machine.read.values)
        back = np.zeros(model.nv)
        back[order] = ours[at:]
        if at:
            back[:6] = [*(R.T @ ours[:3]), *ours[3:6]]
        inverse.append(np.abs(back - theirs).max() / np.abs(theirs).max())
    state, rhs = list(y), machine.rhs
    each = lasting(lambda: rhs(0.0, state)), lasting(lambda: pin.aba(model, data, q, v, acting))
    return Row(name, n, (machine.ready, ready), each, max(forward), max(inverse))


def compare_mjcf(name: str, path: Path) -> Row:
    import mujoco as mj

    machine = Machine(lambda: System.from_mjcf(path))
    system, n = machine.system, len(machine.system.c.q)
    begin = perf_counter()
    model = mj.MjModel.from_xml_path(str(path))
    ready = perf_counter() - begin
    model.opt.disableflags |= (
        mj.mjtDisableBit.mjDSBL_CONTACT | mj.mjtDisableBit.mjDSBL_CONSTRAINT | mj.mjtDisableBit.mjDSBL_ACTUATION
    )
    model.opt.density = model.opt.viscosity = 0
    model.opt.wind[:] = 0
    model.tendon_stiffness[:] = model.tendon_damping[:] = 0
    data = mj.MjData(model)
    assert model.nq == n and model.nv == len(system.speeds), f"{model.nq} and {model.nv} coordinates"
    names = [mj.mj_id2name(model, mj.mjtObj.mjOBJ_JOINT, i) for i in range(model.njnt)]
    wanted = [str(joint) for joint in system.joint_coordinates]
    assert all(a in (b, None) for a, b in zip(names, wanted, strict=True)), f"{names} != {wanted}"
    speeds = [str(u) for u in system.speeds]
    at = {speed: i for i, speed in enumerate(speeds)}
    place: list[int] = []  # of the engine's velocity i among the speeds
    for own in system.joint_coordinates.values():
        if len(own) == 1:
            place.append(at[f"{own[0]}_dot"])
        else:
            place += [at[f"{q}_dot"] for q in own[:-4]] + [at[f"{joint_stem(own)}_w{axis}"] for axis in "xyz"]
    random, forward, inverse = np.random.default_rng(2), [], []
    single = [i for i, u in enumerate(speeds) if u.removesuffix("_dot") in {str(q) for q in machine.torques}]
    for _ in range(_STATES):
        q, u = random.uniform(-1, 1, n), random.uniform(-1, 1, len(speeds))
        for joint in system.ball_joints:
            own = [system.c.q.index(c) for c in joint.quaternion]
            q[own] /= np.linalg.norm(q[own])
        tau = np.zeros(len(speeds))
        tau[single] = random.uniform(-1, 1, len(single))
        machine.set({c: tau[at[f"{c}_dot"]] for c in machine.torques})
        y = [*q, *u]
        a = np.array(machine.rhs(0.0, y))[n:]
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, u[place], tau[place]
        mj.mj_forward(model, data)
        theirs = np.empty(len(a))
        theirs[place] = data.qacc
        forward.append(np.abs(a - theirs).max() / np.abs(theirs).max())
        chosen = random.uniform(-1, 1, len(speeds))
        data.qacc[:] = chosen[place]
        mj.mj_inverse(model, data)
        ours = machine.read.inverse_dynamics(q, u, chosen, machine.read.values)
        inverse.append(np.abs(data.qfrc_inverse - ours[place]).max() / np.abs(ours).max())
    rhs = machine.rhs
    each = lasting(lambda: rhs(0.0, y)), lasting(lambda: mj.mj_forward(model, data))
    return Row(name, n, (machine.ready, ready), each, max(forward), max(inverse))


def joint_stem(own: tuple[sp.Symbol, ...]) -> str:
    """Return the common stem of the coordinates of a ball or free joint."""
    return str(own[-1]).removesuffix("_d")


def constraints_of(system: Any) -> list[sp.Expr]:
    """Return the constraints without those of quaternions."""
    units = {joint.unit_length for joint in system.ball_joints}
    return [e for e in system.constraints if e not in units]


def gradient_of(system: Any, order: list[int], at: int, size: int) -> np.ndarray:
    """Return the Jacobian of constraints that are linear in the joints, in the engine's order."""
    rows = constraints_of(system)
    G = np.zeros((len(rows), size))
    joints = system.c.q[len(system.c.q) - len(order) :]
    for i, e in enumerate(rows):
        for q, place in zip(joints, order, strict=True):
            G[i, place] = float(sp.diff(e, q))
    return G


def onto(system: Any, y: np.ndarray, first: int, at: int) -> None:
    """Move a state onto constraints that give one joint by others."""
    n, joints = len(system.c.q), list(system.c.q)
    for e in constraints_of(system):
        q = next(s for s in joints if sp.diff(e, s) == 1)
        rest = sp.lambdify([joints], q - e)
        y[joints.index(q)] = rest(list(y[:n]))
        slopes = [float(sp.diff(q - e, s)) for s in joints[first:]]
        y[n + at + joints.index(q) - first] = np.dot(slopes, y[n + at :])


def exact_lines(path: Path, notes: tuple[str, ...]) -> Iterator[str]:
    """Return the lines of a file, in which angles that lagrotor reads as multiples of π have 17 digits."""
    changed: dict[int, list[tuple[str, str]]] = {}
    for note in notes:
        if match := re.search(r"line (\d+): the angle (\S+) is read as (\S+)", note):
            exact = repr(float(eval_pi(match[3])))
            changed.setdefault(int(match[1]), []).append((match[2], exact))
    for number, line in enumerate(path.read_text().splitlines(), 1):
        for word, exact in changed.get(number, ()):
            line = re.sub(rf"(?<![\d.]){re.escape(word)}(?![\d.])", exact, line)
        yield line


def eval_pi(text: str) -> float:
    """Return the value of k*pi/n."""
    match = re.fullmatch(r"(-?)(\d+)?\*?pi(?:/(\d+))?", text)
    assert match, text
    return (-1 if match[1] else 1) * int(match[2] or 1) * np.pi / int(match[3] or 1)


def find(relative: str, folders: list[Path]) -> Path | None:
    return next((folder / relative for folder in folders if (folder / relative).is_file()), None)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--models", action="append", type=Path, default=[], metavar="FOLDER")
    options = parser.parse_args()
    folders = [*options.models, *map(Path, sys.path)]
    head = f"{'file':<28} {'q':>4} {'ready [s]':>19} {'forward dynamics [µs]':>19}   forward  inverse"
    wrong = []
    for title, files, compare in (
        ("URDF, fixed base, against Pinocchio", URDF, lambda name, path: compare_urdf(name, path, "fixed")),
        ("URDF, floating base, against Pinocchio", FLOATING, lambda name, path: compare_urdf(name, path, "floating")),
        ("MJCF, against MuJoCo", MJCF, compare_mjcf),
    ):
        print(f"\n{title}\n{head}")
        for name, relative in files.items():
            if options.names and name not in options.names:
                continue
            if (path := find(relative, folders)) is None:
                print(f"{name:<28} not found: {relative}")
                continue
            try:
                row = compare(name, path)
            except Exception as error:
                print(f"{name:<28} {type(error).__name__}: {str(error)[:300]}")
                wrong.append(name)
                continue
            print(row, flush=True)
            if not max(row.forward, row.inverse) < LARGEST:
                wrong.append(name)
    print(f"\nabove {LARGEST:g}, or refused: {', '.join(wrong) or 'none'}")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
