"""URDF files of one construct each, with energies and accelerations that are derived by hand."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.mechanics import System
from lagrotor.mechanics.robot_files.xml_elements import as_multiple_of_pi

INERTIAL = '<inertial>{}<mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>'


def link(name: str, mass: float = 0, inertia: tuple[float, ...] = (2, 3, 4), origin: str = "") -> str:
    return f'<link name="{name}">{INERTIAL.format(origin, mass, *inertia) if mass else ""}</link>'


def joint(name: str, kind: str, parent: str, child: str, inside: str = "") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Any]:
    def read(*parts: str, **options: Any) -> Any:
        (tmp_path / "machine.urdf").write_text(f'<robot name="machine">{"".join(parts)}</robot>')
        return System.from_urdf(tmp_path / "machine.urdf", **options)

    return read


X, Z = '<axis xyz="1 0 0"/>', '<axis xyz="0 0 1"/>'
# One joint from the link a to the link b of mass 5 and inertia (2, 3, 4): what is in it, the inertial's origin, L by hand.
ONE_JOINT: dict[str, tuple[str, str, str, Callable[..., Any]]] = {
    "revolute, default axis x": ("revolute", "", "", lambda q, v: v[0] ** 2),
    "continuous": ("continuous", Z, "", lambda q, v: 2 * v[0] ** 2),
    "against the axis": ("continuous", '<axis xyz="0 -2 0"/>', "", lambda q, v: 3 * v[0] ** 2 / 2),
    "oblique axis": ("revolute", '<axis xyz="0.6 0 0.8"/>', "", lambda q, v: (2 * 0.36 + 4 * 0.64) * v[0] ** 2 / 2),
    "axis without length 1": ("revolute", '<axis xyz="3 0 4"/>', "", lambda q, v: (2 * 0.36 + 4 * 0.64) * v[0] ** 2 / 2),
    "inertial turned": ("revolute", X, '<origin rpy="0 0 1.5707963"/>', lambda q, v: 3 * v[0] ** 2 / 2),
    "centre off the axis": (
        "revolute", X, '<origin xyz="7 0 -2"/>', lambda q, v: (2 + 5 * 4) * v[0] ** 2 / 2 + 5 * 9.81 * 2 * sp.cos(q[0])
    ),
    "joint turned": (
        "revolute", '<origin xyz="0 0 1" rpy="1.57079632679 0 0"/>' + Z, '<origin xyz="2 0 0"/>',
        lambda q, v: (4 + 5 * 4) * v[0] ** 2 / 2 - 5 * 9.81 * (1 + 2 * sp.sin(q[0])),
    ),
    "prismatic, oblique": ("prismatic", '<axis xyz="0.6 0 0.8"/>', "", lambda q, v: 5 * v[0] ** 2 / 2 - 5 * 9.81 * 0.8 * q[0]),
    "planar": ("planar", Z, "", lambda q, v: 5 * (v[0] ** 2 + v[1] ** 2) / 2 + 2 * v[2] ** 2),
    "planar, normal x": (
        "planar", X, "", lambda q, v: 5 * (v[0] ** 2 + v[1] ** 2) / 2 + v[2] ** 2 - 5 * 9.81 * (0 * q[0] + q[1])
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ONE_JOINT)
@pytest.mark.parametrize("symbols", ["none", "inertia", "all"])
def test_one_joint(read: Callable[..., Any], name: str, symbols: str) -> None:
    kind, inside, origin, by_hand = ONE_JOINT[name]
    system = read(link("a"), link("b", 5, origin=origin), joint("q", kind, "a", "b", inside), symbols=symbols)
    L = sp.expand(system.L.subs(system.values))
    moving = dict(zip((*system.c.q, *system.c.v), (0.3, 0.5, 0.7, 1.1, 1.3, 1.7), strict=False))
    assert float((L - by_hand(system.c.q, system.c.v)).subs(moving)) == pytest.approx(0, abs=1e-12)
    assert bool(system.values) == (symbols != "none")


def test_names_and_frames_of_the_file(read: Callable[..., Any]) -> None:
    system = read(
        link("a"), link("b", 1), link("tool"),
        joint("elbow", "continuous", "a", "b", Z), joint("flange", "fixed", "b", "tool", '<origin xyz="2 0 0"/>'),
    )  # fmt: skip
    assert [str(q) for q in system.c.q] == ["elbow"] and system.joint_coordinates == {"elbow": system.c.q}
    assert sp.Matrix([[2 * sp.cos(system.c.elbow), 2 * sp.sin(system.c.elbow), 0]]) == system.links["tool"].place().T
    assert system.links["tool"].name == "flange" and "elbow" in system.joints and not system.notes
    assert {str(s) for s in system.values} == {"m_b", "I_b_xx", "I_b_yy", "I_b_zz", "g"}


def test_changed_names_are_said(read: Callable[..., Any]) -> None:
    names = ("joint-1", "1st", "t", "a.b", "a_b")
    bodies = [link(f"l{i}", 1) for i in range(5)]
    joints = [joint(name, "continuous", f"l{i - 1}" if i else "base", f"l{i}") for i, name in enumerate(names)]
    system = read(link("base"), *bodies, *joints)
    assert [str(q) for q in system.c.q] == ["joint_1", "q_1st", "t_2", "a_b", "a_b_2"]
    assert len(system.notes) == 5 and "'joint-1' has the symbol joint_1" in system.notes


def test_mimic_is_a_constraint(read: Callable[..., Any]) -> None:
    """Masses 1 and 2 on vertical guides, the second at 3 s + 1/2: (1 + 2·9) s'' = −(1 + 2·3) g."""
    mimic = '<mimic joint="s" multiplier="3" offset="0.5"/>'
    system = read(
        link("a"), link("b", 1), link("c", 2),
        joint("s", "prismatic", "a", "b", Z), joint("u", "prismatic", "a", "c", Z + mimic),
    )  # fmt: skip
    s, u = system.c.q
    assert system.names == ("mimic u",) and system.constraints == (u - 3 * s - sp.Rational(1, 2),)
    rates = system.rhs(system.values)(0, [0.1, 0.8, 0.2, 0.6])
    assert rates[2:] == pytest.approx([-7 / 19 * 9.81, -21 / 19 * 9.81], rel=1e-14)


def test_a_mimic_of_a_fixed_joint_holds_its_joint(read: Callable[..., Any]) -> None:
    mimic = '<mimic joint="f" multiplier="3" offset="0.5"/>'
    parts = joint("f", "fixed", "a", "b"), joint("u", "prismatic", "b", "c", Z + mimic)
    system = read(link("a"), link("b"), link("c", 2), *parts)
    assert system.constraints == (system.c.u - sp.Rational(1, 2),)


def test_a_massless_link_between_two_joints(read: Callable[..., Any]) -> None:
    system = read(
        link("a"), link("b"), link("c", 5),
        joint("p", "continuous", "a", "b", Z), joint("q", "continuous", "b", "c", X), symbols="none",
    )  # fmt: skip
    q, (u, v) = system.c.q[1], system.c.v
    kinetic = (2 * v**2 + (3 * sp.sin(q) ** 2 + 4 * sp.cos(q) ** 2) * u**2) / 2
    assert sp.simplify(system.L - kinetic) == 0


def test_a_tree_of_two_branches_and_damping(read: Callable[..., Any]) -> None:
    dynamics = '<dynamics damping="8" friction="3" for_others="2"/>'
    system = read(
        link("a"), link("b", 5), link("c", 5),
        joint("p", "continuous", "a", "b", X + dynamics), joint("q", "continuous", "a", "c", Z), symbols="none",
    )  # fmt: skip
    assert sp.Matrix([[-4 * system.c.v[0], 0]]) == system.accelerations.T
    assert system.not_read == ("dry friction of joints: 1",)


def test_a_floating_base_falls_and_turns_as_euler_says(read: Callable[..., Any]) -> None:
    system = read(link("body", 5), base="floating")
    assert system.start == {"body_x": 0, "body_y": 0, "body_z": 0, "body_a": 1, "body_b": 0, "body_c": 0, "body_d": 0}
    rates = system.rhs(system.values)(0, [*system.start.values(), 0, 0, 0, 1, 2, 3])
    assert rates[7:] == pytest.approx([0, 0, -9.81, (3 - 4) * 6 / 2, (4 - 2) * 3 / 3, (2 - 3) * 2 / 4], rel=1e-14)
    child = joint("f", "floating", "world", "body", '<origin xyz="0 0 1"/>')
    assert read(link("world"), link("body", 5), child).links["body"].place()[2] == sp.Symbol("f_z", real=True) + 1


def test_an_angle_is_exactly_orthogonal_and_near(read: Callable[..., Any]) -> None:
    """An angle in three decimals gives a rational rotation that differs from it by less than rounding."""
    origin = '<origin rpy="0.123 -1.7 3.1"/>'
    system = read(link("a"), link("b", 5), joint("q", "continuous", "a", "b", origin))
    R = system.links["b"].parent.rotation
    r, p, y = 0.123, -1.7, 3.1
    turns = [sp.rot_axis1(-r), sp.rot_axis2(-p), sp.rot_axis3(-y)]
    assert sp.eye(3) == R * R.T and all(e.is_Rational for e in R)
    assert np.abs(np.array(R.evalf(), float) - np.array(turns[2] * turns[1] * turns[0], float)).max() < 4e-16


DIGITS = {
    "1.5707963": sp.pi / 2,
    "-1.57": -sp.pi / 2,
    "3.14": sp.pi,
    "0.785398": sp.pi / 4,
    "1.0472": sp.pi / 3,
    "1.5708e0": sp.pi / 2,
    "1.5": None,
    "1.58": None,
    "0.785": None,
    "1.5707": sp.pi / 2,
    "1.5706": None,
    "0": None,
}


@pytest.mark.parametrize("word", DIGITS)
def test_which_decimals_are_multiples_of_pi(word: str) -> None:
    value = sp.Rational(word)
    exact = DIGITS[word]
    assert as_multiple_of_pi(word, value) == (value if exact is None else exact)


def test_changed_angles_are_said(read: Callable[..., Any]) -> None:
    origin = '<origin rpy="0 1.5707963 0.3"/>'
    system = read(link("a"), link("b", 5), joint("q", "continuous", "a", "b", origin))
    assert system.notes == ("machine.urdf, line 1: the angle 1.5707963 is read as pi/2",)
    assert "1.5707963" in repr(system)


def test_placeholders_of_sensors_join_the_body_that_carries_them(read: Callable[..., Any]) -> None:
    sensor = link("imu", 0.001).replace(
        'ixx="2" iyy="3" izz="4" ixy="0"', 'ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="1e-6"'
    )
    carried = joint("f", "fixed", "b", "imu", '<origin xyz="0 1 0"/>')
    system = read(link("a"), link("b", 5), sensor, joint("q", "continuous", "a", "b", X), carried, symbols="none")
    assert len(system.bodies) == 1 and "'b', 'imu' are fixed to one another" in system.notes[0]
    assert float(system.mass_matrix[0].subs(system.values)) == pytest.approx(2 + 1e-6 + 0.001)
