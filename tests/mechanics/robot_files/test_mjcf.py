"""MJCF files of one construct each, with energies and accelerations that are derived by hand."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad

from lagrotor.mechanics import System

HEAVY = '<inertial pos="{}" mass="5" diaginertia="2 3 4"/>'
BODY = '<body name="b">{}' + HEAVY.format("0 0 0") + "</body>"


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Any]:
    def read(bodies: str, rest: str = "", **options: Any) -> Any:
        (tmp_path / "m.xml").write_text(f"<mujoco>{rest}<worldbody>{bodies}</worldbody></mujoco>")
        return System.from_mjcf(tmp_path / "m.xml", **{"symbols": "none"} | options)

    return read


NO_WEIGHT = '<option gravity="0 0 0"/>'
RADIAN = '<compiler angle="radian"/>'
# What is in the body b of mass 5 and inertia (2, 3, 4), what is before <worldbody>, and L by hand.
ONE_BODY: dict[str, tuple[str, str, Callable[..., Any]]] = {
    "hinge, default axis z": ('<joint name="q"/>', "", lambda q, v: 2 * v[0] ** 2),
    "hinge at an anchor": ('<joint name="q" pos="2 0 0"/>', "", lambda q, v: (4 + 5 * 4) * v[0] ** 2 / 2),
    "slide against gravity": ('<joint name="q" type="slide"/>', "", lambda q, v: 5 * v[0] ** 2 / 2 - 5 * 9.81 * q[0]),
    "gravity along x": (
        '<joint name="q" type="slide" axis="1 0 0"/>', '<option gravity="-2 0 0"/>', lambda q, v: 5 * v[0] ** 2 / 2 - 10 * q[0]
    ),
    "gravity of the last option": (
        '<joint name="q" type="slide"/>', '<option gravity="0 0 -2"/><option gravity="0 0 -3"/>',
        lambda q, v: 5 * v[0] ** 2 / 2 - 15 * q[0],
    ),
    "gravity disabled": (
        '<joint name="q" type="slide"/>', '<option><flag gravity="disable"/></option>', lambda q, v: 5 * v[0] ** 2 / 2
    ),
    "ref and springref in degrees": (
        '<joint name="q" axis="1 0 0" pos="0 0 1" ref="90" springref="45" stiffness="6"/>', "",
        lambda q, v: (2 + 5) * v[0] ** 2 / 2 - 3 * (q[0] - sp.pi / 4) ** 2 - 5 * 9.81 * (1 - sp.cos(q[0] - sp.pi / 2)),
    ),
    "springs disabled": (
        '<joint name="q" stiffness="6" axis="1 0 0"/>', '<option><flag spring="disable"/></option>', lambda q, v: v[0] ** 2
    ),
    "armature": ('<joint name="q" armature="3"/>', "", lambda q, v: (4 + 3) * v[0] ** 2 / 2),
    "two joints": (
        '<joint name="p"/><joint name="q" axis="1 0 0"/>', "",
        lambda q, v: (2 * v[1] ** 2 + (3 * sp.sin(q[1]) ** 2 + 4 * sp.cos(q[1]) ** 2) * v[0] ** 2) / 2,
    ),
    "slide in turned axes": (
        '<joint name="p" axis="0 1 0"/><joint name="q" type="slide" axis="1 0 0"/>', "",
        lambda q, v: (3 * v[0] ** 2 + 5 * (v[1] ** 2 + (q[1] * v[0]) ** 2)) / 2 + 5 * 9.81 * q[1] * sp.sin(q[0]),
    ),
    "settotalmass": ('<joint name="q"/>', '<compiler settotalmass="10"/>', lambda q, v: 4 * v[0] ** 2),
}  # fmt: skip


@pytest.mark.parametrize("name", ONE_BODY)
@pytest.mark.parametrize("symbols", ["none", "inertia", "all"])
def test_one_body(read: Callable[..., Any], name: str, symbols: str) -> None:
    inside, before, by_hand = ONE_BODY[name]
    system = read(BODY.format(inside), before, symbols=symbols)
    moving = dict(zip((*system.c.q, *system.c.v), (0.3, 0.5, 0.7, 1.1), strict=False))
    difference = system.L.subs(system.values) - by_hand(system.c.q, system.c.v)
    assert float(difference.subs(moving)) == pytest.approx(0, abs=1e-12)


ORIENTATIONS = {
    'quat="0.7071 0.7071 0 0"': [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    'axisangle="0 0 2 90"': [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    'xyaxes="0 2 0 -1 5 0"': [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    'zaxis="0 3 0"': [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    'euler="90 0 90"': [[0, -1, 0], [0, 0, -1], [1, 0, 0]],
}


@pytest.mark.parametrize("text", ORIENTATIONS)
def test_orientations(read: Callable[..., Any], text: str) -> None:
    system = read(f'<body name="b" {text}><joint name="q"/>{HEAVY.format("0 0 0")}</body>')
    assert system.links["b"].parent.rotation == sp.Matrix(ORIENTATIONS[text])


@pytest.mark.parametrize(("sequence", "turned"), [("zyx", [0, 0, 1]), ("XYZ", [-1, 0, 0]), ("xyz", [0, 0, 1])])
def test_sequences_of_euler_angles(read: Callable[..., Any], sequence: str, turned: list[int]) -> None:
    """Two quarter turns take the axis z of the body to `turned`: about z and y, first y then x about fixed axes, and so on."""
    angles = {"zyx": "90 0 0", "XYZ": "90 0 0", "xyz": "0 0 90"}[sequence] if sequence != "XYZ" else "0 -90 0"
    compiler = f'<compiler eulerseq="{sequence}"/>'
    system = read(f'<body name="b" euler="{angles}"><joint name="q"/>{HEAVY.format("0 0 0")}</body>', compiler)
    assert list(system.links["b"].parent.rotation[:, 2]) == turned


def test_classes_give_attributes_to_their_children(read: Callable[..., Any]) -> None:
    classes = """<default><joint damping="1"/><geom density="0"/><default class="leg"><joint damping="2" axis="1 0 0"/>
      <default class="foot"><joint damping="3"/></default></default></default>"""
    system = read(
        f"""<body name="a"><joint name="p"/>{HEAVY.format("0 0 0")}
        <body name="b" childclass="leg"><joint name="q"/>{HEAVY.format("0 0 0")}
        <body name="c"><joint name="r" class="foot"/>{HEAVY.format("0 0 0")}</body></body></body>""",
        classes,
    )
    p, q, r = system.c.v
    assert sp.expand(system.dissipation - (p**2 + 2 * q**2 + 3 * r**2) / 2) == 0
    assert system.links["c"].axis == 0


def test_a_ball_joint_turns_as_euler_says(read: Callable[..., Any]) -> None:
    system = read(BODY.format('<joint name="q" type="ball"/>'), symbols="inertia")
    assert [str(u) for u in system.speeds] == ["q_wx", "q_wy", "q_wz"]
    rates = system.rhs(system.values)(0, [1, 0, 0, 0, 1, 2, 3])
    assert rates[4:] == pytest.approx([(3 - 4) * 6 / 2, (4 - 2) * 3 / 3, (2 - 3) * 2 / 4], rel=1e-14)


def test_a_free_body_starts_where_the_file_puts_it(read: Callable[..., Any]) -> None:
    system = read(BODY.replace('name="b"', 'name="b" pos="1 2 3" quat="3 0 0 4"').format('<freejoint name="f"/>'))
    assert list(system.start.values()) == [1, 2, 3, 0.6, 0, 0, 0.8]
    assert system.rhs({})(0, [*system.start.values(), 0, 0, 0, 0, 0, 1])[7:] == pytest.approx([0, 0, -9.81, 0, 0, 0])


def test_nested_frames_and_included_files(read: Callable[..., Any], tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "arm.xml").write_text(
        f'<mujocoinclude><body name="arm" pos="1 0 0"><joint name="q"/>{HEAVY.format("0 0 0")}</body></mujocoinclude>'
    )
    system = read(
        '<frame pos="0 0 2" euler="0 0 90"><frame pos="1 0 0"><include file="parts/arm.xml"/></frame></frame>'
    )
    assert list(system.links["arm"].place()) == [0, 2, 2]


SHAPES = {
    'type="sphere" size="2"': (lambda x: 4 - x * x, "ball"),
    'type="cylinder" size="2 3"': (3, "round"),
    'type="capsule" size="2 3"': (3, "capsule"),
    'type="capsule" size="2" fromto="0 0 -3 0 0 3"': (3, "capsule"),
}


@pytest.mark.parametrize("text", SHAPES)
def test_solids_of_revolution_by_their_integrals(read: Callable[..., Any], text: str) -> None:
    """With the radius r(z), m = π ρ ∫ r² dz, I_z = ½ π ρ ∫ r⁴ dz, I_x = ½ I_z + π ρ ∫ r² z² dz."""
    kind = text.split('"')[1]
    h = 0 if kind == "sphere" else 3
    top = h if kind == "cylinder" else h + 2

    def square(z: float) -> float:
        return 4.0 if kind == "cylinder" else 4 - max(abs(z) - h, 0) ** 2

    def integral(f: Callable[[float], float]) -> float:
        points = [-h, 0, h] if h else [0]
        return float(quad(f, -top, top, points=points, epsabs=1e-12)[0]) * np.pi * 7

    system = read(f'<body name="b"><joint name="q"/><geom density="7" {text}/></body>')
    body = system.bodies[0]
    axial = integral(lambda z: square(z) ** 2) / 2
    across = axial / 2 + integral(lambda z: square(z) * z * z)
    assert float(body.mass) == pytest.approx(integral(square), rel=1e-12)
    assert np.allclose(np.array(body.inertia.tolist(), float), np.diag([across, across, axial]), rtol=1e-12)


def test_boxes_and_ellipsoids_and_their_sum(read: Callable[..., Any]) -> None:
    """Two boxes of 12 kg at ±2 on y, seen from their common centre; an ellipsoid of 5 kg has m (b² + c²)/5."""
    box = '<geom type="box" size="1 2 3" mass="12" pos="0 {} 0"/>'
    system = read(f'<body name="b"><joint name="q"/>{box.format(4)}{box.format(0)}</body>')
    (body,) = system.bodies
    assert body.mass == 24 and list(body.centre) == [0, 2, 0]
    assert body.inertia == sp.diag(2 * 4 * 13 + 24 * 4, 2 * 4 * 10, 2 * 4 * 5 + 24 * 4)
    geom = '<geom type="ellipsoid" size="1 2 3" mass="5" euler="0 0 90"/><geom type="plane" size="1 1 1"/>'
    (body,) = read(f'<body name="b"><joint name="q"/>{geom}</body>').bodies
    assert body.inertia == sp.diag(10, 13, 5)


def test_inertials_before_geoms_unless_the_compiler_says_otherwise(read: Callable[..., Any]) -> None:
    both = '<body name="b"><joint name="q"/>{}<geom size="1" mass="1" group="3"/></body>'
    full = '<inertial pos="0 0 0" mass="2" fullinertia="2 3 4 0.1 0.2 0.3"/>'
    assert sp.Matrix([[2, sp.Rational(1, 10), sp.Rational(1, 5)]]) == read(both.format(full)).bodies[0].inertia[:, 0].T
    assert read(both.format(full), '<compiler inertiafromgeom="true"/>').bodies[0].mass == 1
    turned = '<inertial pos="0 0 0" mass="2" diaginertia="2 3 4" quat="1 1 0 0"/>'
    assert read(both.format(turned)).bodies[0].inertia == sp.diag(2, 4, 3)


FREE_IN_PLANE = (
    '<joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide"/><joint name="a" axis="0 1 0"/>'
)


def test_connect_makes_a_pendulum(read: Callable[..., Any]) -> None:
    """A body in a plane, held at a point 2 m from its centre: α = m g l/(I + m l²) at the start."""
    equality = '<equality><connect name="pin" body1="b" anchor="-2 0 0"/></equality>'
    system = read(BODY.format(FREE_IN_PLANE), equality)
    assert system.names == ("pin 1", "pin 2") and len(system.constraints) == 2
    rates = system.rhs({})(0, [0] * 6)
    alpha = 5 * 9.81 * 2 / (3 + 5 * 4)
    assert rates[3:] == pytest.approx([0, -2 * alpha, alpha], abs=1e-12)


def test_weld_makes_one_body_of_two(read: Callable[..., Any]) -> None:
    """Two bodies on vertical guides, one with a spring: z'' = −g − k z/10."""
    two = BODY.format('<joint name="p" type="slide" stiffness="40" springref="-1"/>')
    two += BODY.replace('"b"', '"c" pos="1 0 0"').format('<joint name="q" type="slide"/>')
    system = read(two, '<equality><weld name="glue" body1="b" body2="c"/></equality>')
    assert len(system.constraints) == 1
    assert system.rhs({})(0, [0.5, 0.5, 0, 0])[2:] == pytest.approx([-9.81 - 40 * 1.5 / 10] * 2)
    turning = BODY.format('<joint name="p"/>') + BODY.replace('"b"', '"c" euler="0 0 30"').format('<joint name="q"/>')
    system = read(turning, '<equality><weld body1="b" body2="c"/></equality>')
    (g, *others), (p, q) = system.constraints, system.c.q
    assert not others
    assert abs(float(g.subs({p: 0.2, q: 0.2}))) < 1e-15 < abs(float(g.subs({p: 0.2, q: 0.3})))


def test_sites_connect(read: Callable[..., Any]) -> None:
    site = '<site name="s" pos="-2 0 0"/>'
    equality = '<equality><connect site1="s" site2="w"/></equality>'
    system = read('<site name="w" pos="-2 0 0"/>' + BODY.format(FREE_IN_PLANE + site), equality)
    assert system.rhs({})(0, [0] * 6)[5] == pytest.approx(5 * 9.81 * 2 / (3 + 5 * 4))


def test_a_polynomial_couples_two_joints(read: Callable[..., Any]) -> None:
    two = BODY.format('<joint name="p" type="slide" ref="1"/>') + BODY.replace('"b"', '"c"').format(
        '<joint name="q" type="slide"/>'
    )
    equality = (
        '<equality><joint joint1="p" joint2="q" polycoef="0.5 2 3"/><joint joint1="q" active="false"/></equality>'
    )
    system = read(two, equality)
    p, q = system.c.q
    assert system.constraints == (p - 1 - (sp.Rational(1, 2) + 2 * q + 3 * q**2),)
    assert "inactive equality constraints: 1" in system.not_read


def test_what_is_not_read_is_listed(read: Callable[..., Any]) -> None:
    sections = """<option density="2"/><actuator><motor joint="q"/></actuator><sensor><jointpos joint="q"/></sensor>
      <keyframe><key/></keyframe><asset><mesh file="a.stl"/></asset>"""
    system = read(BODY.format('<joint name="q" range="0 1" frictionloss="2"/><geom size="1"/>'), sections)
    assert set(system.not_read) >= {
        "limits of joints: 1", "dry friction of joints: 1", "<actuator>: 1", "<sensor>: 1", "<keyframe>: 1",
        "forces of the fluid (density): 1", "shapes of contact and drawing: 1",
    }  # fmt: skip


def test_armatures_stay_in_the_recursion(read: Callable[..., Any]) -> None:
    """M a = −h of two hinges with armatures, by the recursion and from the expanded Lagrangian."""
    inner = f'<body pos="1 0 0"><joint name="q" axis="0 1 0" armature="0.7"/>{HEAVY.format("0.5 0 0.2")}</body>'
    system = read(f'<body><joint name="p" axis="0 1 0" armature="0.3"/>{HEAVY.format("0.4 0 0")}{inner}</body>')
    state = [0.3, -0.4, 1.1, 0.6]
    exact = system.accelerations.subs(dict(zip((*system.c.q, *system.c.v), state, strict=True)))
    assert system.rhs({})(0, state)[2:] == pytest.approx([float(e) for e in exact], rel=1e-13)
    run = system.simulate({}, state[:2], state[2:], [0, 0.5, 1], tol=1e-9)
    assert np.ptp(run.energy) < 1e-7
