"""What the chart holds side by side: a way to run a scene, whose it is, and what it takes for accuracy."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
Run = Callable[[float], tuple[Array, int]]
Prepare = Callable[[Scene, Array], Run]
Family = Literal["closed", "core", "fast", "scipy", "springs", "candidate", "peer", "trap"]


@dataclass(frozen=True)
class Method:
    """prepare(scene, times) → run(knob) → tips (2, n, 3) in m, and evaluations.

    The knob is a tolerance, or one of `steps` (s) for what goes in equal steps; `extra`: what of pyproject installs it.
    """

    family: Family
    prepare: Prepare
    steps: tuple[float, ...] = ()
    extra: str = ""


def tips(scene: Scene, axes: Array) -> Array:
    """Tips (2, n, 3) in m of axes (2, n, 3)."""
    half = (scene.link.length if scene.link else scene.rotor.length) / 2
    return np.array([[[-half, 0, 0]], [[half, 0, 0]]]) + scene.rotor.length * axes
