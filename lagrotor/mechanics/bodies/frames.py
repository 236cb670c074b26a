"""The frame from which a mechanism is built."""

from dataclasses import dataclass

from lagrotor.mechanics.bodies import rigid_bodies
from lagrotor.mechanics.bodies.moving_frames import MovingFrame


@dataclass(frozen=True, eq=False, repr=False)
class Frame(MovingFrame):
    """Frame(c) is the ground; `turned` and `moved` lead to others; `body` fixes a rigid body to one.

    c = coordinates("phi theta psi")
    top = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    System(c, top.kinetic - top.potential((0, 0, -g)))
    """

    body = rigid_bodies.make_body
