"""The two mechanisms on which tools are compared: n rods in relative angles, and n gyroscopes on each other's tips.

Rods: without mass, length l, a mass m at each end, in the plane y = 0. Gyroscopes: an axis of length l on two angles, about
x and then y, a rotor about its middle on a third, about z; the next stands on its tip. Gravity g along −z.
"""

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.benchmark.records import MechanismKind
from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.mechanics.bodies.rigid_bodies import Energy

Array = NDArray[np.float64]

m, l, g, I1, I3 = sp.symbols("m l g I_1 I_3", positive=True)
VALUES = {m: 1.3, l: 0.7, g: 9.81, I1: 0.3, I3: 0.2}
JOINTS = {"rods": 1, "gyroscopes": 3}  # coordinates of each link


def chain(kind: MechanismKind, n: int) -> System:
    """The system of n links."""
    c = coordinates([f"q_{i}" for i in range(JOINTS[kind] * n)])
    frame, L = Frame(c), Energy(())
    for i in range(n):
        if kind == "rods":
            axis = frame.turned("y", c.q[i])
            body, frame = axis.body(m, centre=(0, 0, -l)), axis.moved(0, 0, -l)
        else:
            axis = frame.turned("xy", c.q[3 * i : 3 * i + 2])
            body, frame = axis.turned("z", c.q[3 * i + 2]).body(m, (I1, I1, I3), (0, 0, l / 2)), axis.moved(0, 0, l)
        L = L + body.kinetic - body.potential((0, 0, -g))
    return System(c, L)


def start(kind: MechanismKind, n: int) -> Array:
    """The state (q, v) from which a run begins: rods at rest and bent, gyroscopes inclined, with a spin of 30 rad/s."""
    if kind == "rods":
        return np.concatenate([np.linspace(0.5, 0.1, n), np.zeros(n)])
    return np.concatenate([np.tile([0.1, 0.05, 0.0], n), np.tile([0.0, 0.0, 30.0], n)])
