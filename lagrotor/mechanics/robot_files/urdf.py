"""URDF: links and joints of a tree, `wiki.ros.org/urdf/XML`.

A link's inertia is about its centre of mass, in the axes of the inertial's origin. A joint's origin places the child in the
parent, rpy are turns about the fixed axes x, y, z. A mimic joint is a constraint q = multiplier · q_other + offset. Damping is
Rayleigh's dissipation; dry friction is not read.
"""

from pathlib import Path

import sympy as sp

from lagrotor.errors import InputError, near
from lagrotor.mechanics.robot_files.description import Closure, Description, Joint, Link
from lagrotor.mechanics.robot_files.poses import UNTURNED, Pose, about, product
from lagrotor.mechanics.robot_files.xml_elements import Element, read_xml

_KINDS = {
    "fixed": "",
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "planar": "planar",
    "floating": "free",
}
_GRAVITY = (sp.S.Zero, sp.S.Zero, sp.Rational("-9.81"))
_ELEMENTS = {
    "link": "inertial visual collision",
    "inertial": "origin mass inertia",
    "joint": "origin parent child axis calibration dynamics limit mimic safety_controller",
}
_FREE_START = (0, 0, 0, 1, 0, 0, 0)


def read_urdf(path: str | Path, base: str = "fixed") -> Description:
    """Return the description of a URDF file; the root link is fixed to the ground or free."""
    if base not in ("fixed", "floating"):
        raise InputError(f"from_urdf: base = {base!r} must be 'fixed' or 'floating'")
    robot = read_xml(path)
    if robot.tag != "robot":
        way = ": read it by System.from_mjcf" if robot.tag == "mujoco" else ": give a URDF file"
        raise robot.refusal(f"a URDF file has the root element <robot>{way}")
    left_out = robot.check_children("link joint material transmission gazebo")
    links = _by_name(robot.all("link"))
    joints = _by_name(robot.all("joint"))
    notes: list[str] = []
    into: dict[str, Element] = {}
    for joint in joints.values():
        child = _link(joint, "child", links)
        if child in into:
            raise joint.refusal(
                f"link {child!r} is already the child of joint {into[child].text('name')!r}: URDF has no loops"
            )
        into[child] = joint
    roots = [name for name in links if name not in into]
    if len(roots) != 1:
        what = f"the links {', '.join(roots)} are no child of a joint" if roots else "the joints form a ring"
        raise robot.refusal(f"{what}: a URDF file is one tree with one root; join them by fixed joints")
    children: dict[str, list[str]] = {}
    for child, joint in into.items():
        children.setdefault(_link(joint, "parent", links), []).append(child)
    described, number, waiting = list[Link](), dict[str, int](), [roots[0]]
    while waiting:
        name = waiting.pop()
        number[name] = len(described)
        described.append(_described(links[name], into.get(name), number, notes, base))
        waiting += reversed(children.get(name, []))
    if len(described) < len(links):
        lost = next(name for name in links if name not in number)
        raise links[lost].refusal("the joints before this link form a ring: URDF has no loops")
    closures = [_mimic(joint, joints) for joint in joints.values() if joint.one("mimic") and _KINDS[joint.text("type")]]
    return Description(
        robot.text("name", Path(path).stem), robot.file, tuple(described), _GRAVITY, tuple(closures),
        _not_read(robot, left_out), tuple(notes),
    )  # fmt: skip


def _by_name(elements: list[Element]) -> dict[str, Element]:
    named: dict[str, Element] = {}
    for element in elements:
        if (name := element.text("name")) in named:
            raise element.refusal(f"line {named[name].line} has the same name: rename one")
        named[name] = element
        element.check_children(_ELEMENTS[element.tag])
    return named


def _link(joint: Element, end: str, links: dict[str, Element]) -> str:
    if (element := joint.one(end)) is None:
        raise joint.refusal(f'it has no <{end} link="…"/>: add it')
    if (name := element.text("link")) not in links:
        raise element.refusal(f"there is no link {name!r} in the file{near(name, links) or ': correct the name'}")
    return name


def _described(link: Element, joint: Element | None, number: dict[str, int], notes: list[str], base: str) -> Link:
    name, mass, centre, inertia = link.text("name"), *_inertial(link, notes)
    where = f"{link.file}, line {link.line}"
    if joint is None:
        moving = (Joint(name, "free", start=_FREE_START),) if base == "floating" else ()
        return Link(name, -1, Pose(), moving, mass, centre, inertia, where=where)
    kind = joint.text("type")
    if kind not in _KINDS:
        raise joint.refusal(f"type={kind!r} is none of {', '.join(_KINDS)}{near(kind, _KINDS)}")
    joint.check_attributes("name type")
    moving = (_moving(joint, _KINDS[kind]),) if _KINDS[kind] else ()
    parent = number[joint.one("parent").text("link")]  # type: ignore[union-attr]
    fixed = "" if moving else joint.text("name")
    return Link(name, parent, _pose(joint.one("origin"), notes), moving, mass, centre, inertia, fixed, where)


def _moving(joint: Element, kind: str) -> Joint:
    axis = (sp.S.One, sp.S.Zero, sp.S.Zero)
    if (element := joint.one("axis")) is not None and kind != "free":
        axis = element.numbers("xyz", 3)
        if not any(axis):
            raise element.refusal("xyz = 0 0 0 is no direction: give one")
    damping = sp.S.Zero
    if (dynamics := joint.one("dynamics")) is not None:
        dynamics.check_attributes("damping friction")
        damping = dynamics.number("damping", "0", least=0)
    start = _FREE_START if kind == "free" else (0, 0, 0) if kind == "planar" else (0,)
    return Joint(joint.text("name"), kind, axis, damping=damping, start=tuple(map(sp.Integer, start)))


def _pose(origin: Element | None, notes: list[str]) -> Pose:
    if origin is None:
        return Pose()
    origin.check_attributes("xyz rpy quat_xyzw")
    if "quat_xyzw" in origin.attributes:
        raise origin.refusal("quat_xyzw is not read: write the rotation as rpy")
    shift = sp.ImmutableMatrix(origin.numbers("xyz", 3, "0 0 0"))
    origin.numbers("rpy", 3, "0 0 0")
    quaternion = UNTURNED
    for axis, angle in zip(((1, 0, 0), (0, 1, 0), (0, 0, 1)), origin.angles("rpy", "0 0 0", notes=notes), strict=True):
        quaternion = product(about(axis, angle), quaternion)
    return Pose(shift, quaternion)


def _inertial(link: Element, notes: list[str]) -> tuple[sp.Rational, sp.Matrix, sp.Matrix]:
    """Return mass, centre and inertia (3, 3) about the centre in the axes of the link."""
    if (inertial := link.one("inertial")) is None:
        return sp.S.Zero, sp.ImmutableMatrix([0, 0, 0]), sp.ImmutableMatrix(sp.zeros(3, 3))
    inertial.check_children(_ELEMENTS["inertial"])
    if (mass := inertial.one("mass")) is None:
        raise inertial.refusal(
            f'link {link.text("name")!r} has no <mass value="…"/>: add it, or leave out the inertial'
        )
    if (tensor := inertial.one("inertia")) is None:
        raise inertial.refusal(f'link {link.text("name")!r} has no <inertia ixx="…" …/>: add it')
    tensor.check_attributes("ixx ixy ixz iyy iyz izz")
    axes = "xyz"
    entries = {
        name: tensor.number(name, None if name[1] == name[2] else "0")
        for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    }
    I = sp.Matrix(3, 3, lambda i, j: entries[f"i{axes[min(i, j)]}{axes[max(i, j)]}"])
    pose = _pose(inertial.one("origin"), notes)
    R = pose.rotation
    return mass.number("value", least=0), pose.shift, (R * I * R.T).as_immutable()


def _mimic(joint: Element, joints: dict[str, Element]) -> Closure:
    mimic = joint.one("mimic")
    assert mimic is not None
    mimic.check_attributes("joint multiplier offset")
    name, other = joint.text("name"), mimic.text("joint")
    if other not in joints or other == name:
        raise mimic.refusal(
            f"there is no other joint {other!r} in the file{near(other, joints) or ': correct the name'}"
        )
    for one in (joint, joints[other]):
        if one.text("type") in ("planar", "floating"):
            raise mimic.refusal(
                f"joint {one.text('name')!r} is {one.text('type')}, which has no single coordinate: leave it out"
            )
    offset, multiplier = mimic.number("offset", "0"), mimic.number("multiplier", "1")
    if joints[other].text("type") == "fixed":
        return Closure(f"mimic {name}", joints=(name, ""), polynomial=(offset,))
    return Closure(f"mimic {name}", joints=(name, other), polynomial=(offset, multiplier))


def _not_read(robot: Element, unknown: list[Element]) -> tuple[str, ...]:
    """Say in words how many elements of each kind were not read."""
    counts = {
        "shapes (visual, collision)": sum(len(link.all("visual", "collision")) for link in robot.all("link")),
        "limits of joints": sum(len(joint.all("limit", "safety_controller")) for joint in robot.all("joint")),
        "dry friction of joints": sum(
            joint.one("dynamics") is not None and joint.one("dynamics").number("friction", "0") != 0  # type: ignore[union-attr]
            for joint in robot.all("joint")
        ),
        "transmissions (actuators)": len(robot.all("transmission")),
        "elements of Gazebo": len(robot.all("gazebo")),
    } | {f"<{tag}>": sum(e.tag == tag for e in unknown) for tag in dict.fromkeys(e.tag for e in unknown)}
    return tuple(f"{what}: {count}" for what, count in counts.items() if count)
