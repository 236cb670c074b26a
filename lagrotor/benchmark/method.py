"""What is benchmarked: a method with its runner and accuracy settings, on a case, a scene with its output times."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
Runner = Callable[[float], tuple[Array, int]]
Prepare = Callable[[Scene, Array], Runner]
Family = Literal["closed", "core", "fast", "scipy", "springs", "candidate", "peer", "trap"]

TOLERANCES = tuple(10.0**-n for n in range(3, 14))


@dataclass(frozen=True)
class Method:
    """A benchmarked method: its family, how its runner is made, its accuracy settings.

    prepare(scene, t_eval) → runner(setting) → tips (2, n, 3) in m, and nfev. The setting is a tolerance, or one of `steps`
    (s) of a method with equal steps. install: what pip installs for it.
    """

    family: Family
    prepare: Prepare
    steps: tuple[float, ...] = ()
    install: str = ""


def tips(scene: Scene, axes: Array) -> Array:
    """Tips (2, n, 3) in m of axes (2, n, 3)."""
    half = (scene.link.length if scene.link else scene.rotor.length) / 2
    return np.array([[[-half, 0, 0]], [[half, 0, 0]]]) + scene.rotor.length * axes


@dataclass(frozen=True)
class Case:
    """A scene, its output times t_eval (n,) in s, how many samples are taken of each run after the first, and a sentence."""

    scene: Scene
    t_eval: Array
    repeats: int
    says: str
