"""The paper's scene as three bodies on spring-dampers: listings of 4.1 and 5.2.1."""

from collections.abc import Callable

import numpy as np

from lagrotor.errors import InputError
from lagrotor.models.spring_link.rigid_body import Array, RigidBody, rotation_between
from lagrotor.models.spring_link.system import RigidBodySystem
from lagrotor.pair.scene import Link, Scene

TIP = 2  # the vertex of a rotor that bears the bar and the shock; vertex 1 is at the ground


def paper_bodies(scene: Scene, bar_height: float | None = None) -> list[RigidBody]:
    """The bodies of `scene` (listings of 4.1 and 5.2.1): the rotors and, where the scene has one, the bar as the third.

    Rotors: centre half way up the axis, vertices at ∓R/2 along it, inertia diag(I1, I1, I3). Bar: centre midway between the
    tips, vertices at ∓ell/2 along it, inertia K·1 as in the paper: its axial inertia is K too, which has no effect, as no
    force acts off its line.

    bar_height (m) puts the bar's centre at that z instead. The paper's z starts at the rotors' centres (grounds at
    −0.5, tips at 0.5), ours at the ground joints: its right 0.5 is our 1.0, its mistaken 1 (section 4.1) our 1.5.

    Raises InputError for a bar without mass or without inertia, which no third body can be.
    """
    rotor, link = scene.rotor, scene.link
    half = (link.length if link else rotor.length) / 2
    inertia, ends = np.diag([rotor.I1, rotor.I1, rotor.I3]), rotor.length / 2 * np.array([[0, 0, -1.0], [0, 0, 1.0]])
    bodies = []
    for r, v, spin, x in zip(np.array(scene.axes), np.array(scene.rates), scene.spins, (-half, half), strict=True):
        centre, R = np.array([x, 0, 0]) + rotor.length / 2 * r, rotation_between(np.array([0, 0, 1.0]), r)
        bodies.append(RigidBody(centre, ends, inertia, R, rotor.mass, np.cross(r, v) + spin * r, rotor.length / 2 * v))
    return bodies if link is None else [*bodies, _bar(scene, link, bar_height)]


def _bar(scene: Scene, link: Link, height: float | None) -> RigidBody:
    if not (link.mass > 0 and link.inertia > 0):
        raise InputError(
            f"paper_bodies: a bar of mass {link.mass:g} kg and inertia {link.inertia:g} kg m² cannot be a third body, "
            "moved by force over mass; give it both, as Link(mass=0.01, inertia=0.1), or use lagrotor.simulate"
        )
    R, axes, rates = scene.rotor.length, np.array(scene.axes), np.array(scene.rates)
    centre = R * axes.mean(0)
    centre[2] = centre[2] if height is None else height
    e = np.array([1.0, 0, 0]) + R / link.length * (axes[1] - axes[0])
    e /= np.linalg.norm(e)
    Omega = np.cross(e, R / link.length * (rates[1] - rates[0]))
    ends = link.length / 2 * np.array([[-1.0, 0, 0], [1.0, 0, 0]])
    turned = rotation_between(np.array([1.0, 0, 0]), e)
    return RigidBody(centre, ends, link.inertia * np.eye(3), turned, link.mass, Omega, R * rates.mean(0))


def paper_system(
    scene: Scene, stiffness: float, damping: float, bar_height: float | None = None, **laws: Callable[..., Array]
) -> RigidBodySystem:
    """The paper's program for `scene`: its `paper_bodies`, vertex 1 of each rotor grounded, the bar linked to both tips.

    stiffness S in N/m, damping D in kg/s. A scene without a bar gives two rotors and two links. `laws`: the `force`,
    `rotation` and `transform` of RigidBodySystem.
    """
    system = RigidBodySystem(paper_bodies(scene, bar_height), stiffness, damping, **laws)
    system.ground(2, 1)
    system.ground(1, 1)
    join_bar(system)
    return system


def join_bar(system: RigidBodySystem) -> None:
    """Link the tips of the rotors to the ends of the bar, where there is one."""
    if len(system.vertices) == 3:
        system.link(1, 3, TIP, 1)
        system.link(2, 3, TIP, 2)
