"""MJCF, the format of MuJoCo: nested bodies with several joints each, default classes, equality constraints, inertia from geoms.

A joint turns or moves the body in the axes that the joints before it have left, about its anchor. Its coordinate has the value
`ref` where the body is placed as the file says. Angles are in degrees unless the compiler says otherwise. Damping, springs
and armatures of joints are read. Equality constraints hold exactly, while MuJoCo's are soft.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path

import sympy as sp

from lagrotor.errors import near
from lagrotor.mechanics.robot_files.description import Closure, Description, Joint, Link
from lagrotor.mechanics.robot_files.geoms import NOTHING, ORIENTATION, Solid, combined, solid_of
from lagrotor.mechanics.robot_files.poses import ORIGIN, UNTURNED, Pose, about, number, product, quaternion_of, to_axis
from lagrotor.mechanics.robot_files.xml_elements import Element, read_xml

_KINDS = {"hinge": "revolute", "slide": "prismatic", "ball": "ball", "free": "free"}
_BODY = "body joint freejoint inertial geom site frame camera light"
_TURNED = "pos quat axisangle xyaxes zaxis euler"
_ATTRIBUTES = {
    "body": f"name childclass mocap gravcomp sleep user {_TURNED}",
    "frame": f"name childclass {_TURNED}",
    "joint": "name class type group pos axis springdamper limited actuatorfrclimited solreflimit solimplimit solreffriction "
    "range actuatorfrcrange solimpfriction stiffness damping frictionloss armature ref springref margin user actuatorgravcomp "
    "align",
    "geom": f"name class type contype conaffinity condim group priority size material friction mass density shellinertia solmix "
    f"solref solimp margin gap fromto hfield mesh fitscale rgba fluidshape fluidcoef user {_TURNED}",
    "compiler": "autolimits boundmass boundinertia settotalmass balanceinertia strippath coordinate angle fitaabb eulerseq "
    "meshdir texturedir assetdir discardvisual usethread fusestatic inertiafromgeom inertiagrouprange alignfree saveinertial "
    "convexhull exactmeshinertia conflict",
    "option": "timestep apirate impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance mpr_tolerance sleep_tolerance "
    "gravity wind magnetic density viscosity o_margin o_solref o_solimp o_friction integrator cone jacobian solver iterations "
    "ls_iterations noslip_iterations ccd_iterations mpr_iterations sdf_iterations sdf_initpoints actuatorgroupdisable collision",
    "flag": "constraint equality frictionloss limit contact passive spring damper gravity clampctrl warmstart filterparent "
    "actuation refsafe sensor midphase nativeccd eulerdamp autoreset override energy fwdinv invdiscrete multiccd island sleep",
}
_OF_EQUALITY = (
    "name class active solref solimp body1 body2 site1 site2 anchor relpose torquescale joint1 joint2 polycoef"
)
_REFUSED = ("composite", "flexcomp", "replicate", "attach")
_SECTIONS = (
    "compiler option default worldbody equality size visual statistic asset contact actuator sensor tendon keyframe custom "
    "extension deformable include"
)
_ALTERS = ("boundmass", "boundinertia", "balanceinertia")


@dataclass
class _Reading:
    """The state of reading: the settings of the compiler, the defaults by class, and the links so far."""

    compiler: dict[str, str]
    flags: dict[str, str]
    defaults: dict[str, dict[str, dict[str, str]]]
    links: list[Link] = field(default_factory=list)
    homes: list[Pose] = field(default_factory=list)
    solids: list[Solid] = field(default_factory=list)
    sites: dict[str, tuple[int, Pose]] = field(default_factory=dict)
    names: set[str] = field(default_factory=set)
    named: dict[str, set[str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)

    @property
    def degrees(self) -> bool:
        return self.compiler.get("angle", "degree") == "degree"

    def count(self, what: str, how_many: int = 1) -> None:
        if how_many:
            self.counts[what] = self.counts.get(what, 0) + how_many

    def with_defaults(self, element: Element, inherited: str) -> Element:
        """Return the element with the attributes of its class, or else of the class that its body gives to its children."""
        name = element.attributes.get("class", inherited)
        if name not in self.defaults:
            raise element.refusal(f"there is no default class {name!r}{near(name, self.defaults) or ': define it'}")
        given = dict(self.defaults[name].get(element.tag, {}))
        if any(key in element.attributes for key in ORIENTATION):
            given = {key: value for key, value in given.items() if key not in ORIENTATION}
        return replace(element, attributes=given | element.attributes)


def read_mjcf(path: str | Path) -> Description:
    """Return the description of an MJCF file, with the files of its folder that it includes."""
    root = read_xml(path)
    if root.tag != "mujoco":
        way = ": read it by System.from_urdf" if root.tag == "robot" else ": give an MJCF file"
        raise root.refusal(f"an MJCF file has the root element <mujoco>{way}")
    root = replace(root, children=list(_included(root, root.file.resolve().parent, {root.file.resolve()})))
    unknown = root.check_children(_SECTIONS)
    flags = {k: v for option in root.all("option") for flag in option.all("flag") for k, v in flag.attributes.items()}
    compiler = {k: v for e in root.all("compiler") for k, v in e.attributes.items()}
    for element in root.all("compiler"):
        _check_compiler(element)
    named = _checked_names(root)
    reading = _Reading(compiler, flags, {"main": {}}, named=named)
    for element in root.all("default"):
        _read_defaults(element, reading.defaults, "")
    for world in root.all("worldbody"):
        _read_body(world, -1, "main", Pose(), False, reading)
    if "settotalmass" in compiler:
        total = next(e for e in reversed(root.all("compiler")) if "settotalmass" in e.attributes).number("settotalmass")
        if total > 0:
            if not (mass := sum(solid.mass for solid in reading.solids)):
                raise root.refusal(f"no body has a mass that settotalmass={total} could scale: give one a mass")
            factor = total / mass
            reading.solids = [solid.scaled(factor) for solid in reading.solids]
    links = tuple(
        replace(link, mass=solid.mass, centre=solid.centre, inertia=solid.inertia)
        for link, solid in zip(reading.links, reading.solids, strict=True)
    )
    held = "disable" not in (flags.get("equality"), flags.get("constraint"))
    closures = tuple(_closures(root, reading)) if held else ()
    gravity = next(
        (e.numbers("gravity", 3) for e in reversed(root.all("option")) if "gravity" in e.attributes),
        (sp.S.Zero, sp.S.Zero, sp.Rational("-9.81")),
    )
    if flags.get("gravity") == "disable":
        gravity = (sp.S.Zero,) * 3
    for tag in ("actuator", "sensor", "tendon", "keyframe", "contact", "deformable"):
        reading.count(f"<{tag}>", sum(len(section.children) for section in root.all(tag)))
    for name, size in (("density", 1), ("viscosity", 1), ("wind", 3)):
        said = [e.numbers(name, size) for e in root.all("option") if name in e.attributes]
        if said and any(said[-1]):
            reading.count(f"forces of the fluid ({name})")
    for element in unknown:
        reading.count(f"<{element.tag}>")
    not_read = tuple(f"{what}: {count}" for what, count in reading.counts.items())
    name = root.text("model", Path(path).stem)
    return Description(name, root.file, links, gravity, closures, not_read, tuple(reading.notes))


def _checked_names(root: Element) -> dict[str, set[str]]:
    """Check the attributes of all elements that are read, and return the names that the file gives to bodies and joints."""
    inside = [
        e
        for tag in ("compiler", "option", "default", "worldbody")
        for section in root.all(tag)
        for e in _inside(section)
    ]
    for element in inside:
        element.check_attributes(_ATTRIBUTES.get(element.tag, ""))
        if element.tag == "flag" and (wrong := {*element.attributes.values()} - {"enable", "disable"}):
            raise element.refusal(f"{min(wrong)!r} must be enable or disable")
    return {
        kind: {e.text("name") for e in inside if e.tag.endswith(kind) and "name" in e.attributes}
        for kind in ("body", "joint")
    }


def _inside(element: Element) -> Iterator[Element]:
    """Yield an element and all elements inside it."""
    yield element
    for child in element.children:
        yield from _inside(child)


def _unused(name: str, taken: set[str]) -> str:
    """Return the name, with a number if it is taken."""
    return next(chosen for i in count(1) if (chosen := name if i == 1 else f"{name}_{i}") not in taken)


def _included(element: Element, folder: Path, seen: set[Path]) -> Iterator[Element]:
    """Yield the children of an element, with those of included files in the place of <include>."""
    for child in element.children:
        if child.tag != "include":
            yield replace(child, children=list(_included(child, folder, seen)))
            continue
        name = child.text("file")
        target = (folder / name).resolve()
        if not target.is_relative_to(folder):
            raise child.refusal(f"file={name!r} is outside the folder {folder}: move it there")
        if not target.is_file():
            raise child.refusal(f"file={name!r} is no file in {folder}: correct the name")
        if target in seen:
            raise child.refusal(f"file={name!r} is included already: a file is included once")
        yield from _included(read_xml(target), folder, seen | {target})


def _check_compiler(element: Element) -> None:
    if element.text("coordinate", "local") != "local":
        raise element.refusal("coordinate='global' has no meaning in MuJoCo any more: write local coordinates")
    if element.text("angle", "degree") not in ("degree", "radian"):
        raise element.refusal(f"angle={element.text('angle')!r} must be degree or radian")
    if element.text("inertiafromgeom", "auto") not in ("auto", "true", "false"):
        raise element.refusal(f"inertiafromgeom={element.text('inertiafromgeom')!r} must be auto, true or false")
    sequence = element.text("eulerseq", "xyz")
    if len(sequence) != 3 or {*sequence} - {*"xyzXYZ"}:
        raise element.refusal(f"eulerseq={sequence!r} must be three letters of x, y, z, X, Y, Z")
    if not re.fullmatch(r"\d+ +\d+", element.text("inertiagrouprange", "0 5").strip()):
        raise element.refusal(f"inertiagrouprange={element.text('inertiagrouprange')!r} must be two whole numbers")
    for name in _ALTERS:
        if element.text(name, "0") not in ("0", "false"):
            raise element.refusal(
                f"{name} changes inertias of the file: write the changed ones into it, and leave it out"
            )


def _read_defaults(element: Element, defaults: dict[str, dict[str, dict[str, str]]], parent: str) -> None:
    name = element.text("class", None if parent else "main")
    if (name in defaults) if parent else (name != "main"):
        reason = "is there already: name another" if parent else "cannot replace 'main', the outermost: nest it"
        raise element.refusal(f"class={name!r} {reason}")
    values = {tag: dict(attributes) for tag, attributes in defaults.get(parent or name, {}).items()}
    for child in element.children:
        if child.tag != "default":
            values[child.tag] = values.get(child.tag, {}) | child.attributes
    defaults[name] = values
    for child in element.all("default"):
        _read_defaults(child, defaults, name)


def _read_body(body: Element, index: int, inherited: str, prefix: Pose, moving: bool, reading: _Reading) -> None:
    """Read the elements in a <body>, <worldbody> or <frame>. `index` is the number of the link, and `prefix` the pose in it."""
    for element in body.check_children(_BODY):
        if element.tag in _REFUSED:
            raise element.refusal(
                "it makes bodies that are not read: let MuJoCo save the compiled model, and give that file"
            )
        reading.count(f"<{element.tag}>")
    reading.count("shapes of contact and drawing", len(body.all("geom")))
    for child in body.children:
        if child.tag == "frame":
            pose = prefix.then(_pose(child, reading))
            _read_body(child, index, child.attributes.get("childclass", inherited), pose, moving, reading)
        elif child.tag == "body":
            _add_body(child, index, child.attributes.get("childclass", inherited), prefix, moving, reading)
        elif child.tag == "site" and "name" in child.attributes:
            reading.sites[child.text("name")] = (
                index,
                prefix.then(_pose(reading.with_defaults(child, inherited), reading)),
            )
        elif child.tag in ("joint", "freejoint", "inertial") and body.tag != "body":
            raise child.refusal(f"it belongs into a body, not into a {body.tag}: move it there")


def _add_body(body: Element, parent: int, inherited: str, prefix: Pose, moving: bool, reading: _Reading) -> None:
    index = len(reading.links)
    if (name := body.attributes.get("name", "")) and any(link.name == name for link in reading.links):
        raise body.refusal("another body has the same name: rename one")
    name = name or _unused(f"body{index + 1}", {link.name for link in reading.links} | reading.named["body"])
    pose = prefix.then(_pose(body, reading))
    home = reading.homes[parent].then(pose) if parent >= 0 else pose
    joints = [_joint(e, name, inherited, pose, reading) for e in body.all("joint", "freejoint")]
    if any(joint.kind == "free" for joint in joints):
        if len(joints) > 1 or parent >= 0:
            raise body.refusal("a free joint must be the only joint of a body in <worldbody>: move it")
        pose = Pose()
    moving = moving or bool(joints)
    where = f"{body.file}, line {body.line}"
    reading.links.append(Link(name, parent, pose, tuple(joints), where=where))
    reading.homes.append(home)
    needed = moving or "settotalmass" in reading.compiler
    reading.solids.append(_solid(body, inherited, reading) if needed else NOTHING)
    reading.count("gravity compensation", body.number("gravcomp", "0") != 0)
    _read_body(body, index, inherited, Pose(), moving, reading)


def _joint(element: Element, body: str, inherited: str, pose: Pose, reading: _Reading) -> Joint:
    joint = reading.with_defaults(element, inherited) if element.tag == "joint" else element
    kind = "free" if element.tag == "freejoint" else joint.text("type", "hinge")
    if kind not in _KINDS:
        raise element.refusal(f"type={kind!r} is none of {', '.join(_KINDS)}{near(kind, _KINDS)}")
    if (name := element.attributes.get("name", "")) in reading.names:
        raise element.refusal(f"another joint has the name {name!r}: rename one")
    name = name or _unused(f"{body}_joint", reading.names | reading.named["joint"])
    reading.names.add(name)
    reading.count("limits of joints", "range" in joint.attributes and joint.text("limited", "auto") != "false")
    reading.count("dry friction of joints", joint.number("frictionloss", "0") != 0)
    passive = reading.flags.get("passive") != "disable"
    springs, dampers = (passive and reading.flags.get(flag) != "disable" for flag in ("spring", "damper"))
    numbers = {key: joint.number(key, "0", least=0) for key in ("damping", "stiffness", "armature")}
    if kind in ("ball", "free") and (numbers["armature"] or numbers["stiffness"]):
        raise element.refusal(f"armature and stiffness of a {kind} joint are not read: set them to 0")
    if "springdamper" in joint.attributes and any(joint.numbers("springdamper", 2)):
        raise element.refusal("springdamper depends on the masses: write stiffness and damping")
    align = joint.text("align", "auto")
    if align == "true" or (kind == "free" and align == "auto" and reading.compiler.get("alignfree") == "true"):
        raise element.refusal("align='true', or alignfree of the compiler, moves the axes of the body: write 'false'")
    axis = joint.numbers("axis", 3, "0 0 1")
    if not any(axis):
        raise element.refusal("axis = 0 0 0 is no direction: give one")
    turned = kind == "hinge"
    zero, rest = (
        joint.angles(key, "0", turned and reading.degrees, reading.notes)[0] if turned else joint.number(key, "0")
        for key in ("ref", "springref")
    )
    start: tuple[sp.Expr, ...] = (zero,)
    if kind in ("ball", "free"):
        a, b, c, d = pose.quaternion if kind == "free" else UNTURNED
        length = sp.sqrt(a * a + b * b + c * c + d * d)
        start = (*(pose.shift if kind == "free" else ()), *(number(x / length) for x in (a, b, c, d)))
    return Joint(
        name, _KINDS[kind], axis, sp.ImmutableMatrix(joint.numbers("pos", 3, "0 0 0")) if kind != "free" else ORIGIN,
        zero, numbers["damping"] if dampers else sp.S.Zero, numbers["stiffness"] if springs else sp.S.Zero, rest,
        numbers["armature"], start,
    )  # fmt: skip


def _pose(element: Element, reading: _Reading) -> Pose:
    """Return the pose that pos and one of quat, axisangle, xyaxes, zaxis, euler give."""
    shift = sp.ImmutableMatrix(element.numbers("pos", 3, "0 0 0"))
    given = [name for name in ORIENTATION if name in element.attributes]
    if len(given) > 1:
        raise element.refusal(f"it has both {given[0]} and {given[1]}: give one orientation")
    return Pose(shift, _orientation(element, given[0], reading) if given else UNTURNED)


def _orientation(element: Element, name: str, reading: _Reading) -> tuple[sp.Rational, ...]:
    count = {"quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}[name]
    numbers = element.numbers(name, count)
    if not any(numbers[:4] if name == "quat" else numbers[:3]) and name != "euler":
        raise element.refusal(f"{name}={element.text(name)!r} gives no direction: correct it")
    if name == "quat":
        return numbers
    if name == "zaxis":
        return to_axis(numbers)
    if name == "xyaxes":
        x, y = sp.Matrix(numbers[:3]), sp.Matrix(numbers[3:])
        if x.cross(y).is_zero_matrix:
            raise element.refusal(f"xyaxes={element.text(name)!r} are parallel: give two directions")
        z = x.cross(y)
        return quaternion_of(sp.Matrix.hstack(*(e / e.norm() for e in (x, z.cross(x), z))))
    angles = element.angles(name, "", reading.degrees, reading.notes)
    if name == "axisangle":
        return about(numbers[:3], angles[3])
    total = UNTURNED
    for letter, angle in zip(reading.compiler.get("eulerseq", "xyz"), angles, strict=True):
        turn = about([int(letter.lower() == axis) for axis in "xyz"], angle)
        total = product(total, turn) if letter.islower() else product(turn, total)
    return total


def _solid(body: Element, inherited: str, reading: _Reading) -> Solid:
    """Return the rigid body of <inertial>, or of the geoms."""
    mode, inertial = reading.compiler.get("inertiafromgeom", "auto"), body.one("inertial")
    counts = mode == "true" or (mode == "auto" and inertial is None)
    whole = _solid_of_geoms(body, inherited, reading) if counts else NOTHING
    if inertial is not None and whole.mass == 0:
        inertial.check_attributes("pos quat axisangle xyaxes zaxis euler mass diaginertia fullinertia")
        pose = _pose(inertial, reading)
        R = pose.rotation
        if "fullinertia" in inertial.attributes:
            if inertial.attributes.keys() & {"diaginertia", *ORIENTATION}:
                raise inertial.refusal(
                    "fullinertia is in the axes of the body: leave out diaginertia and the orientation"
                )
            xx, yy, zz, xy, xz, yz = inertial.numbers("fullinertia", 6)
            I = sp.Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        else:
            I = sp.diag(*inertial.numbers("diaginertia", 3))
        return Solid(inertial.number("mass", least=0), pose.shift, R * I * R.T)
    return whole


def _solid_of_geoms(body: Element, inherited: str, reading: _Reading) -> Solid:
    first, last = map(int, reading.compiler.get("inertiagrouprange", "0 5").split())
    solids = []
    for element, prefix, own in _geoms(body, inherited, Pose(), reading):
        geom = reading.with_defaults(element, own)
        if first <= geom.number("group", "0") <= last:
            solids.append(
                solid_of(geom, prefix.then(_pose(geom, reading)) if "fromto" not in geom.attributes else prefix)
            )
    return combined([solid for solid in solids if solid is not None])


def _geoms(body: Element, inherited: str, prefix: Pose, reading: _Reading) -> Iterator[tuple[Element, Pose, str]]:
    for child in body.all("geom", "frame"):
        if child.tag == "geom":
            yield child, prefix, inherited
        else:
            own = child.attributes.get("childclass", inherited)
            yield from _geoms(child, own, prefix.then(_pose(child, reading)), reading)


def _closures(root: Element, reading: _Reading) -> Iterator[Closure]:
    """Yield the equality constraints."""
    number_of = {link.name: i for i, link in enumerate(reading.links)} | {"world": -1}
    kinds = {joint.name: joint.kind for link in reading.links for joint in link.joints}
    names: set[str] = set()
    for element in (e for section in root.all("equality") for e in section.children):
        if element.tag not in ("connect", "weld", "joint"):
            raise element.refusal(
                "it couples parts that are not read: leave it out, or set it inactive and leave it out"
            )
        element.check_attributes(_OF_EQUALITY)
        active = reading.with_defaults(replace(element, tag="equality"), "main").text("active", "true")
        if active not in ("true", "false"):
            raise element.refusal(f"active={active!r} must be true or false")
        if active == "false":
            reading.count("inactive equality constraints")
            continue
        name = element.attributes.get("name") or f"{element.tag} {len(names) + 1}"
        name = name if name not in reading.names | names else f"constraint {len(names) + 1}, {name}"
        names.add(name)
        if element.tag == "joint":
            pair = element.text("joint1"), element.text("joint2", "")
            for joint in pair:
                if joint and kinds.get(joint) not in ("revolute", "prismatic"):
                    raise element.refusal(
                        f"{joint!r} is no hinge and no slide{near(joint, kinds) or ': correct the name'}"
                    )
            coefficients = element.numbers("polycoef", range(1, 6), "0 1 0 0 0")
            yield Closure(name, joints=pair, polynomial=coefficients if pair[1] else coefficients[:1])
        else:
            yield _held(element, name, number_of, reading)


def _held(element: Element, name: str, number_of: Mapping[str, int], reading: _Reading) -> Closure:
    """Return the closure of connect or weld."""
    is_weld = element.tag == "weld"
    turns = not is_weld or element.number("torquescale", "1") != 0
    if "site1" in element.attributes:
        sites = [element.text(f"site{i}") for i in (1, 2)]
        for site in sites:
            if site not in reading.sites:
                raise element.refusal(f"there is no site {site!r}{near(site, reading.sites) or ': correct the name'}")
        (one, first), (two, second) = (reading.sites[site] for site in sites)
        turn = first.rotation * second.rotation.T if is_weld and turns else None
        return Closure(name, (one, two), (first.shift, second.shift), turn)
    pair = element.text("body1"), element.text("body2", "world")
    for body in pair:
        if body not in number_of:
            raise element.refusal(f"there is no body {body!r}{near(body, number_of) or ': correct the name'}")
    one, two = (number_of[body] for body in pair)
    home, other = (reading.homes[i] if i >= 0 else Pose() for i in (one, two))
    if not is_weld:
        anchor = sp.ImmutableMatrix(element.numbers("anchor", 3))
        place = home.shift + home.rotation * anchor
        return Closure(name, (one, two), (anchor, other.rotation.T * (place - other.shift)))
    anchor = sp.ImmutableMatrix(element.numbers("anchor", 3, "0 0 0"))
    relative = element.numbers("relpose", 7, "0 1 0 0 0 0 0")
    if any(relative[3:]):
        pose = Pose(sp.ImmutableMatrix(relative[:3]), relative[3:])
        shift, turn = pose.shift, pose.rotation
    else:
        shift, turn = home.rotation.T * (other.shift - home.shift), home.rotation.T * other.rotation
    return Closure(name, (one, two), (shift + turn * anchor, anchor), turn if turns else None)
