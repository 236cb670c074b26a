"""What a multibody engine is given: equal rotors, massless bars, and the start."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.spring_link.rigid_body import rotation_between
from lagrotor.pair.scene import Rotor, Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rig:
    """Equal rotors on ground joints feet (N, 2), massless bars (i, j) as long as their joints are apart, and the start."""

    rotor: Rotor
    feet: Array
    bars: tuple[tuple[int, int], ...]
    spins: Array
    axes: Array
    rates: Array

    @property
    def turns(self) -> list[tuple[Array, Array]]:
        """Each rotor's rotation (3, 3) and angular velocity (3,) in world components, at the start."""
        up = np.array([0.0, 0.0, 1.0])
        return [
            (rotation_between(up, np.array(r)), np.cross(r, v) + spin * np.array(r))
            for r, v, spin in zip(self.axes, self.rates, self.spins, strict=True)
        ]

    def tips(self, axes: Array) -> Array:
        """Tips (N, n, 3) in m of axes (N, n, 3)."""
        return np.pad(self.feet, ((0, 0), (0, 1)))[:, None] + self.rotor.length * axes


def rig_of(scene: Scene) -> Rig:
    """The pair."""
    assert scene.link is not None
    half = scene.link.length / 2
    feet = np.array([(-half, 0.0), (half, 0.0)])
    return Rig(scene.rotor, feet, ((0, 1),), np.array(scene.spins), np.array(scene.axes), np.array(scene.rates))
