"""A machine as its file describes it, links with joints in a tree and the constraints that close loops, and the System of it.

Every number of a description is an exact rational. A link is moved from its parent by a pose and then by its joints, one after
another in the axes turned before, each about an anchor of its own.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import sympy as sp

from lagrotor.algebra.subexpressions import with_shared_parts
from lagrotor.errors import InputError
from lagrotor.mechanics.bodies.moving_frames import AXES
from lagrotor.mechanics.bodies.rigid_bodies import Body, Energy, Frame, check_body
from lagrotor.mechanics.bodies.small_matrices import Small
from lagrotor.mechanics.lagrangian import coordinates
from lagrotor.mechanics.robot_files.geoms import Solid, combined
from lagrotor.mechanics.robot_files.poses import ORIGIN, Pose, rotation_of, to_axis

Symbols = Literal["inertia", "all", "none"]
_ANY = coordinates("q")
_NO_INERTIA = sp.ImmutableMatrix(sp.zeros(3, 3))
_COORDINATES = {
    "revolute": ("",),
    "prismatic": ("",),
    "planar": ("_x", "_y", "_angle"),
    "ball": ("_a", "_b", "_c", "_d"),
    "free": ("_x", "_y", "_z", "_a", "_b", "_c", "_d"),
}


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint of a kind in _COORDINATES, at an anchor in the link, about or along an axis (3, 1).

    At the coordinate `zero` the link has its pose, and at `rest` the spring is free. `rotor` is an inertia that turns or moves
    with the coordinate alone. `start` has the coordinates in the position of the file.
    """

    name: str
    kind: str
    axis: tuple[sp.Rational, ...] = (sp.S.Zero, sp.S.Zero, sp.S.One)
    anchor: sp.Matrix = ORIGIN
    zero: sp.Rational = sp.S.Zero
    damping: sp.Rational = sp.S.Zero
    stiffness: sp.Rational = sp.S.Zero
    rest: sp.Rational = sp.S.Zero
    rotor: sp.Rational = sp.S.Zero
    start: tuple[sp.Rational, ...] = ()


@dataclass(frozen=True, eq=False)
class Link:
    """A link: the index of its parent (−1 for the ground), pose, joints, mass, centre, and inertia about the centre.

    Centre and inertia are in the axes of the link. `fixed` is the name of a joint that does not move, and `where` the place in
    the file, for messages.
    """

    name: str
    parent: int
    pose: Pose
    joints: tuple[Joint, ...] = ()
    mass: sp.Rational = sp.S.Zero
    centre: sp.Matrix = ORIGIN
    inertia: sp.Matrix = _NO_INERTIA
    fixed: str = ""
    where: str = ""


@dataclass(frozen=True, eq=False)
class Closure:
    """A constraint: two points, each in the axes of its link, coincide, or one joint's coordinate is a polynomial in another's.

    With a matrix `turn` the rotations of the links stay in the relation R₂ = R₁ turn, too. Coordinates are counted from `zero`.
    """

    name: str
    links: tuple[int, int] = (-1, -1)
    points: tuple[sp.Matrix, sp.Matrix] = (ORIGIN, ORIGIN)
    turn: sp.Matrix | None = None
    joints: tuple[str, str] = ("", "")
    polynomial: tuple[sp.Rational, ...] = ()


@dataclass(frozen=True, eq=False)
class Description:
    """A machine as its file describes it.

    Each link comes after its parent. `gravity` (3,) is the acceleration in m/s². `not_read` says in words which parts of the
    file were not read, and `notes` which numbers and names were changed.
    """

    name: str
    file: Path
    links: tuple[Link, ...]
    gravity: tuple[sp.Rational, ...]
    closures: tuple[Closure, ...] = ()
    not_read: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


class _Names:
    """The names given to symbols: letters, digits and _ only. No two are equal, not even with _dot or _ddot added."""

    def __init__(self) -> None:
        self.taken = {"t", "g"}
        self.notes: list[str] = []

    def take(self, name: str, quiet: bool = False) -> str:
        plain = re.sub(r"[\W_]+", "_", name).rstrip("_")  # sympy prints a__b as a power, a_ as a
        plain = plain if re.match(r"[^\W\d_]", plain) else f"q_{plain.lstrip('_')}".rstrip("_")
        chosen, number = plain, 2
        while {chosen, f"{chosen}_dot", f"{chosen}_ddot"} & self.taken:
            chosen, number = f"{plain}_{number}", number + 1
        self.taken |= {chosen, f"{chosen}_dot", f"{chosen}_ddot"}
        if chosen != name and not quiet:
            self.notes.append(f"{name!r} has the symbol {chosen}")
        return chosen


class _Parameters:
    """The symbols of numbers, and their values."""

    def __init__(self, names: _Names, symbols: Symbols) -> None:
        self.names, self.symbols, self.values = names, symbols, dict[sp.Symbol, float]()

    def symbol(self, name: str, number: sp.Expr, length: bool = False, **assumptions: bool) -> sp.Expr:
        """Return a symbol with this number as its value; the number itself if it is zero or stays a number."""
        if number == 0 or self.symbols == "none" or (length and self.symbols != "all"):
            return number
        symbol = sp.Symbol(self.names.take(name, quiet=True), real=True, **assumptions)
        self.values[symbol] = float(number)
        return symbol

    def vector(self, name: str, numbers: Sequence[sp.Expr], length: bool = False) -> list[sp.Expr]:
        return [self.symbol(f"{name}_{axis}", e, length) for axis, e in zip(AXES, numbers, strict=True)]


def parts_of(described: Description, symbols: Symbols) -> dict[str, Any]:
    """Return the fields of a `RobotSystem` by name."""
    if symbols not in ("inertia", "all", "none"):
        raise InputError(f"symbols = {symbols!r} must be 'inertia', 'all' or 'none'")
    _check_masses(described)
    links, merged = _possible_bodies(described.links)
    names = _Names()
    stems = {joint.name: names.take(joint.name) for link in described.links for joint in link.joints}
    listed = {
        joint.name: [
            names.take(stems[joint.name] + end, True) if end else stems[joint.name] for end in _COORDINATES[joint.kind]
        ]
        for link in described.links
        for joint in link.joints
    }
    if not listed:
        raise InputError(f"{described.file}: nothing moves in it: no joint is other than fixed; add one that moves")
    c = coordinates([name for group in listed.values() for name in group])
    numbers = _Parameters(names, symbols)
    ground = Frame(c)
    frames, bodies, start = list[Frame](), list[Body](), dict[str, float]()
    remainder = dissipation = sp.S.Zero
    for link in links:
        frame = frames[link.parent] if link.parent >= 0 else ground
        place = numbers.vector(f"l_{link.name}", link.pose.shift, length=True)
        turned = link.pose.rotation != sp.eye(3)
        if any(place):
            frame = frame.moved(place[0], place[1], place[2], "" if turned else link.fixed)
        if turned:
            frame = frame.turned(link.pose.rotation, name=link.fixed)
        for joint in link.joints:
            own = listed[joint.name]
            frame, rates = _moved(frame, joint, own, numbers)
            start |= dict(zip(own, map(float, joint.start), strict=True))
            q = c[own[0]]
            half = sp.Add(*(u**2 for u in rates)) / 2
            remainder += numbers.symbol(f"J_{joint.name}", joint.rotor, True, positive=True) * half
            remainder -= numbers.symbol(f"k_{joint.name}", joint.stiffness, True) * (q - joint.rest) ** 2 / 2
            dissipation += numbers.symbol(f"d_{joint.name}", joint.damping, True) * half
        frames.append(frame)
        if body := _body(frame, link, numbers):
            bodies.append(body)
    fall = _gravity(described.gravity, numbers)
    L: Any = Energy((), remainder)
    for body in bodies:
        L = L + body.kinetic - (body.potential(fall) if any(fall) else 0)
    constraints = _constraints(described, [*frames, ground], {name: c[own[0]] for name, own in listed.items()})
    return {
        "c": c,
        "lagrangian": L,
        "constraints": constraints,
        "dissipation": dissipation,
        "values": numbers.values,
        "start": start,
        "links": {link.name: frame for link, frame in zip(described.links, frames, strict=True)},
        "joint_coordinates": {name: tuple(c[q] for q in own) for name, own in listed.items()},
        "not_read": described.not_read,
        "notes": (*described.notes, *merged, *names.notes),
    }


def _moved(frame: Frame, joint: Joint, own: list[str], numbers: _Parameters) -> tuple[Frame, list[sp.Expr]]:
    """Return the frame after a joint, and the velocities on which its damping acts."""
    c, anchor = frame.c, numbers.vector(f"l_{joint.name}", joint.anchor, length=True)
    v = [c[f"{name}_dot"] for name in own]
    if joint.kind == "free":
        frame = frame.free(own[:3], own[3:], [f"{joint.name}_w{axis}" for axis in AXES], name=joint.name)
        return frame, [*v[:3], *frame.ball_velocities.values()]
    moved = frame.moved(*anchor) if any(anchor) else frame
    if joint.kind == "ball":
        frame = moved.ball(own, [f"{joint.name}_w{axis}" for axis in AXES], name=joint.name)
        v = [*frame.ball_velocities.values()]
    elif joint.kind == "prismatic":
        x, y, z = rotation_of(to_axis(joint.axis))[:, 2] * (c[own[0]] - joint.zero)
        frame = moved.moved(x, y, z, joint.name)
    else:
        along = [i for i in range(3) if joint.axis[i] != 0]
        if joint.kind == "revolute" and len(along) == 1:
            angle = (c[own[0]] - joint.zero) * sp.sign(joint.axis[along[0]])
            frame = moved.turned(AXES[along[0]], [angle], name=joint.name)
        elif joint.kind == "planar" and len(along) == 1 and joint.axis[along[0]] > 0:
            frame = moved.planar(own[0], own[1], own[2], AXES[along[0]], name=joint.name)
        else:
            R = rotation_of(to_axis(joint.axis))
            frame = moved.turned(R) if sp.eye(3) != R else moved
            if joint.kind == "revolute":
                frame = frame.turned("z", [c[own[0]] - joint.zero], name=joint.name)
            else:
                frame = frame.planar(own[0], own[1], own[2], name=joint.name)
            frame = frame.turned(R.T) if sp.eye(3) != R else frame
    return frame.moved(*(-e for e in anchor)) if any(anchor) else frame, v


def _is_possible(link: Link) -> bool:
    try:
        check_body("", Body(Frame(_ANY), link.mass, link.inertia, link.centre))
    except InputError:
        return False
    return True


def _possible_bodies(links: Sequence[Link]) -> tuple[list[Link], list[str]]:
    """Return the moving links and sentences; links fixed to one another are one body if one alone has an impossible inertia.

    Files give sensors placeholders such as ixx = ixy = 10⁻⁶, which no body has. Raises InputError if the whole is impossible.
    """
    carriers, poses, moving = list[int](), list[Pose](), list[bool]()
    for i, link in enumerate(links):
        fixed = link.parent >= 0 and not link.joints
        carriers.append(carriers[link.parent] if fixed else i)
        poses.append(poses[link.parent].then(link.pose) if fixed else Pose())
        moving.append(bool(link.joints) or (link.parent >= 0 and moving[link.parent]))
    nothing = {"mass": sp.S.Zero, "centre": ORIGIN, "inertia": _NO_INERTIA}
    changed = [link if move else replace(link, **nothing) for link, move in zip(links, moving, strict=True)]
    notes = []
    for k in sorted({carriers[i] for i, link in enumerate(changed) if not _is_possible(link)}):
        members = [i for i, link in enumerate(changed) if carriers[i] == k and (link.mass or any(link.inertia))]
        named = ", ".join(repr(links[i].name) for i in members)
        whole = combined([Solid(links[i].mass, links[i].centre, links[i].inertia).seen_from(poses[i]) for i in members])
        for i in members:
            changed[i] = replace(links[i], **nothing)
        changed[k] = replace(links[k], mass=whole.mass, centre=whole.centre, inertia=whole.inertia)
        if not _is_possible(changed[k]):
            raise InputError(
                f"{links[members[0]].where}: the inertia of link {named} is that of no body: of the principal inertias none may "
                f"exceed the two others together; correct it: {changed[k].inertia.evalf(6).tolist()}"
            )
        notes.append(f"links {named} are fixed to one another and have impossible inertias alone: they are one body")
    return changed, notes


def _body(frame: Frame, link: Link, numbers: _Parameters) -> Body | None:
    """Return the body of a link, None without mass; its entries are symbols where the numbers are not zero."""
    if link.mass == 0 and not any(link.inertia):
        return None
    m = numbers.symbol(f"m_{link.name}", link.mass, positive=True)
    centre = numbers.vector(f"c_{link.name}", link.centre)
    I = sp.zeros(3, 3)
    for i in range(3):
        for j in range(i, 3):
            signs = {"positive": True} if i == j else {}
            I[i, j] = I[j, i] = numbers.symbol(f"I_{link.name}_{AXES[i]}{AXES[j]}", link.inertia[i, j], **signs)
    return frame.body(m, I, centre)


def _gravity(gravity: Sequence[sp.Rational], numbers: _Parameters) -> list[sp.Expr]:
    """Return the field, with the symbol g if it is along an axis."""
    along = [i for i in range(3) if gravity[i] != 0]
    if len(along) != 1:
        return list(gravity)
    g = gravity[along[0]]
    if numbers.symbols == "none":
        return list(gravity)
    symbol = sp.Symbol("g", positive=True)
    numbers.values[symbol] = float(abs(g))
    return [symbol * sp.sign(g) if i in along else sp.S.Zero for i in range(3)]


def _check_masses(described: Description) -> None:
    """Raise InputError if a joint moves no mass: its acceleration would not be defined."""
    heavy = [link.mass != 0 or any(link.inertia) for link in described.links]
    for i in reversed(range(len(described.links))):
        link = described.links[i]
        if link.joints and not heavy[i] and not all(joint.rotor for joint in link.joints):
            raise InputError(
                f"{link.where}: joint {link.joints[-1].name!r} moves links without mass, {link.name!r} and all after it: its "
                "acceleration is undefined; give one of them an inertial, or make the joint fixed"
            )
        if link.parent >= 0:
            heavy[link.parent] |= heavy[i]
    _check_free_links(described)


def _check_free_links(described: Description) -> None:
    """Raise InputError for a free link without mass that carries one moving joint: the motions of both cannot be told apart."""
    fixed: list[int] = []  # the first of the links that are fixed to one another
    for i, link in enumerate(described.links):
        fixed.append(fixed[link.parent] if link.parent >= 0 and not link.joints else i)
    for i, link in enumerate(described.links):
        if [joint.kind for joint in link.joints] != ["free"]:
            continue
        whole = [k for k, first in enumerate(fixed) if first == i]
        moved = [k for k, other in enumerate(described.links) if other.joints and other.parent in whole]
        if len(moved) == 1 and not any(described.links[k].mass or any(described.links[k].inertia) for k in whole):
            raise InputError(
                f"{link.where}: the free link {link.name!r} has no mass and carries joint "
                f"{described.links[moved[0]].joints[0].name!r} alone: the motions of both are the same; give it an inertial"
            )


def _constraints(described: Description, frames: list[Frame], q: Mapping[str, sp.Symbol]) -> dict[str, sp.Expr]:
    """Return the constraints by name."""
    named: dict[str, sp.Expr] = {}
    zeros = {joint.name: joint.zero for link in described.links for joint in link.joints}
    for closure in described.closures:
        if closure.polynomial:
            first, second = closure.joints
            x = q[second] - zeros[second] if second else sp.S.Zero
            named[closure.name] = q[first] - zeros[first] - sum(a * x**i for i, a in enumerate(closure.polynomial))
            continue
        one, two = (frames[i] for i in closure.links)
        parts = list[sp.Expr]()
        if any((one.place(closure.points[0]) - two.place(closure.points[1])).expand()):
            parts += one.coincides(two, *closure.points, name=closure.name)
        if closure.turn is not None:
            ours, theirs = _rotation(one), _rotation(two) * Small.of(closure.turn.T)
            turns = [(ours.T * theirs)[i, (i + 1) % 3] for i in range(3)]
            parts += [e for e in turns if e != 0]
        if not parts:
            raise InputError(f"{described.file}: the constraint {closure.name!r} binds no coordinate: leave it out")
        named |= {f"{closure.name} {i + 1}" if len(parts) > 1 else closure.name: e for i, e in enumerate(parts)}
    return named


def _rotation(frame: Frame) -> Small:
    """Return the rotation of a frame into the ground's axes, not multiplied out."""
    R = Small.of(sp.eye(3))
    for step in reversed(frame.to_the_ground):
        R = (R * Small.of(step.rotation)).each(with_shared_parts)
    return R


def skeleton(system: Any) -> list[list[list[sp.Expr]]]:
    """Return the lines of a picture: for each last link, the places of the links from the ground to its centre of mass, in m."""
    carried = {id(body.frame): body for body in system.bodies}
    places = {id(frame): list(frame.place()) for frame in system.links.values()}
    inner = {id(step) for frame in system.links.values() for step in frame.to_the_ground[1:]}
    lines = []
    for frame in system.links.values():
        if id(frame) in inner:
            continue
        line = [places[id(step)] for step in reversed(frame.to_the_ground) if id(step) in places]
        if id(frame) in carried:
            line.append(list(frame.place(carried[id(frame)].centre)))
        if any(a != b for a, b in pairwise(line)):
            lines.append(line)
    return lines
