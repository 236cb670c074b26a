"""Generated C of arms with seven axes against Pinocchio: the time of one forward dynamics.

    python -m benchmarks.exported_arm [--models FOLDER] [NAME …]

The arms are those of `benchmarks.robot_files` and the KUKA iiwa of pybullet. The coupling of the Panda's two fingers is left out
on both sides, as is the friction of joints. Both programs evaluate the same random states with the same torques: Pinocchio by
`abaInParallel` with one thread, lagrotor by a loop in C around the exported right-hand side, compiled by gcc -O2. The table has
the least processor time of an evaluation in several turns, in which both programs alternate, and the largest relative difference
of the accelerations. A difference above 1e-10, or a ratio of the times above 2, ends the script with exit status 1.
"""

import argparse
import ctypes
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import sympy as sp

from benchmarks.robot_files import LARGEST, URDF, exact_lines, find
from lagrotor.mechanics import System

ARMS = {name: URDF[name] for name in ("panda", "xarm7")} | {"iiwa": "pybullet_data/kuka_iiwa/model.urdf"}
_STATES, _TURNS, _MOST_TIMES = 20_000, 15, 2.0
_LOOP = """#include "{0}.h"
void many(int n, const double *x, const double *p, double *dx)
{{
    int k;
    for (k = 0; k < n; k++)
        {0}_rhs(0.0, x + k * {1}_STATES, p, dx + k * {1}_STATES);
}}
"""


def compare(name: str, path: Path) -> tuple[float, float, float]:
    """Return the microseconds of an evaluation, of lagrotor and of Pinocchio, and the difference of the accelerations."""
    import pinocchio as pin

    read = System.from_urdf(path)
    torques = sp.symbols(f"tau_:{len(read.c.q)}", real=True)
    system = replace(read, constraints=(), names=(), dissipation=sp.S.Zero, forces=torques)
    model = pin.buildModelFromXML("\n".join(exact_lines(path, read.notes)))
    joint_of = {q: joint for joint, own in read.joint_coordinates.items() for q in own}
    joints = [model.joints[model.getJointId(joint_of[q])] for q in system.c.q]
    n, random = len(joints), np.random.default_rng(1)
    x, tau = random.uniform(-1, 1, (_STATES, 2 * n)), random.uniform(-1, 1, n)
    q, v = np.zeros((model.nq, _STATES)), np.zeros((model.nv, _STATES))
    for i, joint in enumerate(joints):
        q[joint.idx_q : joint.idx_q + joint.nq] = [x[:, i]] if joint.nq == 1 else [np.cos(x[:, i]), np.sin(x[:, i])]
        v[joint.idx_v] = x[:, n + i]
    acting, theirs = np.zeros((model.nv, _STATES)), np.zeros((model.nv, _STATES))
    order = [joint.idx_v for joint in joints]
    acting[order] = tau[:, None]
    pool = pin.ModelPool(model, 1)
    with tempfile.TemporaryDirectory() as folder:
        header, source, about = system.export("c", folder, name)
        loop = Path(folder, "loop.c")
        loop.write_text(_LOOP.format(header.stem, header.stem.upper()))
        command = [
            "gcc",
            "-std=c99",
            "-O2",
            "-shared",
            "-fPIC",
            "-o",
            f"{folder}/loop.so",
            str(source),
            str(loop),
            "-lm",
        ]
        subprocess.run(command, check=True)
        many: Any = ctypes.CDLL(f"{folder}/loop.so").many
        given = {str(s): value for s, value in zip(torques, tau, strict=True)}
        rows = json.loads(about.read_text())["parameters"]
        p = np.array([given.get(row["name"], row.get("value")) for row in rows], float)
    ours = np.empty_like(x)
    pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (x, p, ours)]
    times = least_times(lambda: many(_STATES, *pointers), lambda: pin.abaInParallel(1, pool, q, v, acting, theirs))
    size = np.abs(theirs).max(axis=0)
    return *times, float((np.abs(ours[:, n:].T - theirs[order]).max(axis=0) / size).max())


def least_times(*calls: Callable[[], Any]) -> tuple[float, float]:
    """Return the least processor time of each call in microseconds for one state; the calls alternate."""
    times = np.empty((_TURNS, len(calls)))
    for turn in times:
        for k, call in enumerate(calls):
            begin = process_time()
            call()
            turn[k] = process_time() - begin
    first, second = (times.min(axis=0) / _STATES * 1e6).tolist()
    return first, second


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, action="append", default=[], help="a folder of packages with models")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"arms to compare: {', '.join(ARMS)}")
    options = parser.parse_args()
    worst = False
    print(f"{'arm':<8} {'lagrotor':>10} {'Pinocchio':>10} {'ratio':>6} {'difference':>11}")
    for name in options.names or ARMS:
        path = find(ARMS[name], [*options.models, *map(Path, sys.path)])
        if path is None:
            print(f"{name:<8} is not installed")
            continue
        ours, theirs, difference = compare(name, path)
        print(f"{name:<8} {ours:7.3f} µs {theirs:7.3f} µs {ours / theirs:6.2f} {difference:11.1e}")
        worst |= difference > LARGEST or ours > _MOST_TIMES * theirs
    return int(worst)


if __name__ == "__main__":
    sys.exit(main())
