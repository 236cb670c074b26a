"""Stability of the paired precession: the Floquet multipliers of the exact periodic orbit.

Of the six multipliers four are 1: the energy with the shift of time, the momentum with the turning about the joint
line. The other two, mu and 1/mu, belong to the slow motion of the mean x and the mean twist; their sum is the trace of
the monodromy less four. The orbit is elliptic where |mu + 1/mu| < 2, hyperbolic where mu is real.
"""

from dataclasses import dataclass
from math import acos, acosh, pi
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.shooting import ExactOrbit, exact_orbit
from lagrotor.models.orbits.variational import flow
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
# The trace of a monodromy is found to about 1e-11; within that the pair cannot be told from 1.
RESOLVED = 2e-11


@dataclass(frozen=True, eq=False)
class Floquet:
    """multipliers (6,), complex: four ones, mu, 1/mu. pair_sum: mu + 1/mu. monodromy (6, 6) in (U, chi, alpha, rates).

    growth: log |mu| per turn (0 on an elliptic orbit); turning: angle of mu per turn (rad) on an elliptic orbit.
    frequency: of the orbit (rad/s).
    """

    multipliers: NDArray[np.complex128]
    pair_sum: float
    kind: Literal["elliptic", "hyperbolic", "unresolved"]
    growth: float
    turning: float
    frequency: float
    monodromy: Array


def floquet(scene: Scene, r0: float) -> Floquet:
    """Floquet multipliers of the paired precession of amplitude r0, through the variational equations.

    Raises InputError unless the spins are opposite and there is a bar, DomainError when no orbit is found at r0.
    """
    return floquet_of(exact_orbit(scene, r0))


def floquet_of(orbit: ExactOrbit) -> Floquet:
    """The multipliers of an orbit already found."""
    period = 2 * pi / abs(orbit.frequency)
    slope = flow(orbit.scene)(MODEL.start(orbit.scene), period).slope
    total = float(np.trace(slope)) - 4
    excess = total - 2
    if abs(excess) < RESOLVED:
        kind: Literal["elliptic", "hyperbolic", "unresolved"] = "unresolved"
        growth = turning = 0.0
    elif abs(total) > 2:
        kind, growth, turning = "hyperbolic", acosh(abs(total) / 2), 0.0
    else:
        kind, growth, turning = "elliptic", 0.0, acos(total / 2)
    mu = (total + np.sqrt(complex(total * total - 4))) / 2
    multipliers = np.array([1, 1, 1, 1, mu, 1 / mu], dtype=complex)
    return Floquet(multipliers, total, kind, growth, turning, orbit.frequency, slope)
