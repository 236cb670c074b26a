"""The motion that all methods are compared with: the exact pair by two formulations, and how far they are apart."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.method import tips
from lagrotor.models import minimal, spheres
from lagrotor.models.model import integrate_model
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reference:
    """Tips (2, n, 3) in m, and `floor`: the largest distance (m) of the two formulations' tips, from rounding."""

    tips: Array
    floor: float


def reference(scene: Scene, t_eval: Array) -> Reference:
    """The bar eliminated (six states) and two unit vectors with multipliers (twelve), both at 1e-13.

    tests/benchmark/reference.json holds 10 s of the displaced pair with thirty digits, by extrapolation, to compare.
    """
    runs = ((model, integrate_model(model, scene, t_eval, TIGHTEST).states) for model in (minimal.MODEL, spheres.MODEL))
    one, other = (tips(scene, model.observe(scene, states).axes) for model, states in runs)
    return Reference(one, float(np.linalg.norm(one - other, axis=-1).max()))
