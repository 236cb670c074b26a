"""Files with odd constructs against Pinocchio and MuJoCo; `benchmarks/robot_files.py` compares the models of packages."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.robot_files import LARGEST, compare_mjcf, compare_urdf
from lagrotor.mechanics import System

pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
mj = pytest.importorskip("mujoco", reason="MuJoCo is not installed")


def _link(name: str, seed: int) -> str:
    x = np.random.default_rng(seed).uniform(0.1, 1, 9).round(4)
    inertia = f'ixx="{2 + x[0]}" iyy="{2 + x[1]}" izz="{2 + x[2]}" ixy="0.1" ixz="-0.2" iyz="0.3"'
    origin = f'<origin xyz="{x[3]} {-x[4]} {x[5]}" rpy="{x[6]} {x[7]} {-x[8]}"/>'
    return f'<link name="{name}"><inertial>{origin}<mass value="{1 + x[0]}"/><inertia {inertia}/></inertial></link>'


def _joint(name: str, kind: str, ends: str, axis: str, inside: str = "") -> str:
    origin = '<origin xyz="0.3 -0.2 0.5" rpy="0.3 1.5707963 -0.7"/>'
    a, b = ends.split()
    parts = f'<parent link="{a}"/><child link="{b}"/>{origin}<axis xyz="{axis}"/>{inside}'
    return f'<joint name="{name}" type="{kind}">{parts}</joint>'


_LIMIT = '<limit effort="1" velocity="1"/>'
_PARTS = (
    *(_link(name, i) for i, name in enumerate("abcdef")),
    '<link name="none"/>',
    _joint("p", "revolute", "a b", "0.6 0.8 0", _LIMIT + '<dynamics damping="0.7"/>'),
    _joint("q", "prismatic", "b none", "1 2 3", _LIMIT),
    _joint("f", "fixed", "none c", "1 0 0"),
    _joint("r", "continuous", "c d", "0 0 -1"),
    _joint("s", "revolute", "c e", "0 -1 0", _LIMIT),
    _joint("u", "revolute", "e f", "1 1 1", _LIMIT + '<mimic joint="p" multiplier="-1.5" offset="0.2"/>'),
)
URDF = f'<robot name="odd">{"".join(_PARTS)}</robot>'


@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_odd_urdf_against_pinocchio(tmp_path: Path, base: str) -> None:
    (tmp_path / "odd.urdf").write_text(URDF)
    row = compare_urdf("odd", tmp_path / "odd.urdf", base)
    assert max(row.forward, row.inverse) < LARGEST


_SOLID = """<geom type="capsule" size="0.1" fromto="0 0 0 0.3 0.1 0.5"/>
<geom type="box" size="0.1 0.2 0.3" pos="0.1 0 0" euler="10 20 30"/>"""
MJCF = f"""<mujoco><compiler eulerseq="zYx"/><option gravity="1 -2 -9"/><default><joint damping="0.2" armature="0.05"/>
<default class="stiff"><joint stiffness="3" springref="20"/></default></default><worldbody>
<body name="a" pos="0 0 1" euler="10 20 30"><joint name="p" axis="1 2 3" pos="0.1 0 0" ref="15"/>{_SOLID}
<body name="b" pos="0.3 0.1 0.5" childclass="stiff"><joint name="q" axis="0 1 0"/>
<joint name="r" type="slide" axis="1 0 1" ref="0.1"/>
<inertial pos="0.1 0 0" mass="2" fullinertia="1 1.1 1.2 0.1 0.2 0.3"/><frame pos="0.2 0 0" axisangle="1 1 0 40">
<body name="c"><joint name="s" type="ball" armature="0" stiffness="0" pos="0 0.1 0"/>{_SOLID}<body name="d" pos="0.5 0 0">
<joint name="u" axis="0 0 1"/>{_SOLID}<site name="tip" pos="0.3 0.2 0.1"/></body></body></frame></body></body>
<body name="e" pos="2 0 0" quat="1 2 3 4"><freejoint name="f"/>{_SOLID}</body></worldbody>{{}}</mujoco>"""


def test_odd_mjcf_against_mujoco(tmp_path: Path) -> None:
    (tmp_path / "odd.xml").write_text(MJCF.format(""))
    row = compare_mjcf("odd", tmp_path / "odd.xml")
    assert max(row.forward, row.inverse) < LARGEST


SPEEDS = [
    "p_dot",
    "q_dot",
    "r_dot",
    "s_wx",
    "s_wy",
    "s_wz",
    "u_dot",
    *(f"f_{x}_dot" for x in "xyz"),
    "f_wx",
    "f_wy",
    "f_wz",
]
_POSE = "-2 0 0 0.18257418583505536 -0.3651483716701107 -0.5477225575051661 -0.7302967433402214"
EQUALITIES = {
    "connect": '<connect body1="d" body2="world" anchor="0.2 0.1 0"/>',
    "connect two bodies": '<connect body1="d" body2="e" anchor="0.2 0.1 0"/>',
    "weld": '<weld body1="d" body2="e"/>',
    "weld of a pose": '<weld body1="e" body2="world" relpose="POSE"/>',
    "joint": '<joint joint1="p" joint2="u" polycoef="0 2 3 1"/><joint joint1="q"/>',
}


@pytest.mark.parametrize("name", EQUALITIES)
def test_equality_constraints_against_mujoco(tmp_path: Path, name: str) -> None:
    """M a + h = Gᵀ λ, G a = −G' v with MuJoCo's M, h and G; G' v is a difference quotient, so it is checked to 10⁻⁶ alone."""
    path = tmp_path / "loop.xml"
    path.write_text(MJCF.format(f"<equality>{EQUALITIES[name].replace('POSE', _POSE)}</equality>"))
    system, model = System.from_mjcf(path), mj.MjModel.from_xml_path(str(path))
    model.opt.jacobian = mj.mjtJacobian.mjJAC_DENSE
    model.opt.disableflags |= mj.mjtDisableBit.mjDSBL_CONTACT
    data, names = mj.MjData(model), [str(u) for u in system.speeds]
    place = [names.index(u) for u in SPEEDS]
    start = np.array([*system.start.values()])

    def rows(q: np.ndarray) -> np.ndarray:
        data.qpos[:], data.qvel[:] = q, 0
        mj.mj_forward(model, data)
        return data.efc_J.reshape(-1, model.nv).copy()

    G = rows(start)
    _, sizes, directions = np.linalg.svd(G)
    v = directions[(sizes > 1e-9).sum() :].T @ np.random.default_rng(3).uniform(-1, 1, model.nv - (sizes > 1e-9).sum())
    for scale, largest in ((0.0, LARGEST), (1.0, 1e-6)):
        ahead, back = start.copy(), start.copy()
        mj.mj_integratePos(model, ahead, v * scale, 1e-5)
        mj.mj_integratePos(model, back, v * scale, -1e-5)
        drift = (rows(ahead) - rows(back)) @ v * scale / 2e-5
        data.qpos[:], data.qvel[:] = start, v * scale
        mj.mj_forward(model, data)
        W = np.empty((len(G), model.nv))
        mj.mj_solveM(model, data, W, G)
        unbound = data.qacc_smooth
        theirs = unbound - W.T @ np.linalg.lstsq(G @ W.T, G @ unbound + drift, rcond=1e-12)[0]
        u = np.empty(model.nv)
        u[place] = v * scale
        ours = np.array(system.rhs(system.values)(0, [*start, *u]))[len(start) :][place]
        assert np.abs(ours - theirs).max() < largest * np.abs(theirs).max()
