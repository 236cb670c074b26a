"""Mass, centre and inertia of the solid geoms of MJCF: sphere, capsule, cylinder, box, ellipsoid.

A capsule is a cylinder of half length h with half balls of radius r at its ends. About its centre a half ball of mass m/2 has
the inertia (2/5) (m/2) r², and its centre of mass is 3r/8 from the flat face.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from lagrotor.mechanics.robot_files.poses import Pose, number, to_axis
from lagrotor.mechanics.robot_files.xml_elements import Element

_DENSITY = "1000"  # kg/m³, the default of MJCF
_SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}
WITHOUT_MASS = ("plane", "hfield")


@dataclass(frozen=True, eq=False)
class Solid:
    """A rigid body: mass, centre (3, 1), and inertia (3, 3) about the centre."""

    mass: sp.Rational
    centre: sp.Matrix
    inertia: sp.Matrix

    def seen_from(self, pose: Pose) -> "Solid":
        """Return the body in the axes of a frame in which its own frame has a pose."""
        R = pose.rotation
        return Solid(self.mass, pose.shift + R * self.centre, R * self.inertia * R.T)

    def scaled(self, factor: sp.Rational) -> "Solid":
        return Solid(self.mass * factor, self.centre, self.inertia * factor)


NOTHING = Solid(sp.S.Zero, sp.ImmutableMatrix([0, 0, 0]), sp.ImmutableMatrix(sp.zeros(3, 3)))


def combined(solids: Sequence[Solid]) -> Solid:
    """Return several bodies, fixed to one another, as one."""
    mass = sum((s.mass for s in solids), sp.S.Zero)
    if mass == 0:
        return NOTHING
    centre = sum((s.centre * s.mass for s in solids), sp.zeros(3, 1)) / mass
    inertia = sp.zeros(3, 3)
    for s in solids:
        d = s.centre - centre
        inertia += s.inertia + (sp.eye(3) * d.dot(d) - d * d.T) * s.mass
    return Solid(mass, centre, inertia)


def solid_of(geom: Element, pose: Pose) -> Solid | None:
    """Return the body of a geom whose `pose` comes from its position and orientation; None without mass."""
    kind = geom.text("type", "sphere")
    density = geom.number("density", _DENSITY, least=0)
    given = geom.number("mass", least=0) if "mass" in geom.attributes else None
    if kind in WITHOUT_MASS or given == 0 or (given is None and density == 0):
        return None
    if kind not in _SIZES:
        raise geom.refusal(f"the inertia of a {kind} needs its mesh, which is not read: give the body an <inertial>")
    if geom.text("shellinertia", "false") != "false":
        raise geom.refusal("the inertia of a shell is not read: give the body an <inertial>")
    size = list(geom.numbers("size", range(1, 4)))
    if "fromto" in geom.attributes:
        if kind == "sphere":
            raise geom.refusal("a sphere has no fromto: give pos")
        ends = geom.numbers("fromto", 6)
        first, last = sp.ImmutableMatrix(ends[:3]), sp.ImmutableMatrix(ends[3:])
        if first == last:
            raise geom.refusal("the two points of fromto are one: give two")
        pose = Pose((first + last) / 2, to_axis(list(last - first)))
        half = number((last - first).norm() / 2)
        size = [size[0], half] if _SIZES[kind] == 2 else [size[0], size[0], half]
    if len(size) < _SIZES[kind] or not all(x > 0 for x in size[: _SIZES[kind]]):
        raise geom.refusal(f"size of a {kind} must be {_SIZES[kind]} positive numbers: add them")
    volume, principal = _uniform(kind, size)
    mass = given if given is not None else number(volume * density)
    R = pose.rotation
    return Solid(mass, pose.shift, R * sp.diag(*(number(e * mass) for e in principal)) * R.T)


def _uniform(kind: str, size: Sequence[sp.Rational]) -> tuple[sp.Expr, list[sp.Expr]]:
    """Return the volume and the principal inertias of a uniform solid, in units of its mass."""
    if kind in ("sphere", "ellipsoid"):
        a, b, c = size[:3] if kind == "ellipsoid" else [size[0]] * 3
        return sp.pi * 4 / 3 * a * b * c, [(b**2 + c**2) / 5, (a**2 + c**2) / 5, (a**2 + b**2) / 5]
    if kind == "box":
        a, b, c = size[:3]
        return 8 * a * b * c, [(b**2 + c**2) / 3, (a**2 + c**2) / 3, (a**2 + b**2) / 3]
    r, h = size[:2]
    cylinder = sp.pi * r**2 * 2 * h
    across, along = r**2 / 4 + h**2 / 3, r**2 / 2
    if kind == "cylinder":
        return cylinder, [across, across, along]
    balls = sp.pi * r**3 * 4 / 3
    part = h / (h + r * sp.Rational(2, 3))  # the cylinder's part of the mass
    across = part * across + (1 - part) * (r**2 * sp.Rational(2, 5) + h**2 + h * r * sp.Rational(3, 4))
    along = part * along + (1 - part) * r**2 * sp.Rational(2, 5)
    return cylinder + balls, [across, across, along]
