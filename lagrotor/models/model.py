"""What every rung of the ladder that is integrated offers: a start, a rate, and the axes read back."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.integrate import Projection, Rate
from lagrotor.numerics.integrators import LOST
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Observed:
    """Axes and rates (2, n, 3), axial momenta (2, n)."""

    axes: Array
    rates: Array
    momenta: Array


@dataclass(frozen=True)
class Model:
    """One rung: `start` gives the state (d,) of a scene (and refuses what the rung cannot do), `rate` its right-hand
    side with or without the pulse, `observe` the axes from states (n, d); `projection`, where the rung has constraints,
    brings a state that drifted off them back."""

    name: str
    start: Callable[[Scene], Array]
    rate: Callable[[Scene, bool], Rate]
    observe: Callable[[Scene, Array], Observed]
    projection: Callable[[Scene], Projection] | None = None


def python_rate(
    scene: Scene, function: Callable[..., list[float]], parameters: tuple[float, ...], pulsed: bool
) -> Rate:
    """The rate s, y ↦ function(*y, *parameters[, *force]) in Python floats, the fastest where one state comes at a time.

    `force` is R F on the shocked tip (N m). A state outside the coordinates' reach gives NaN, which makes the solver
    shorten its step.
    """
    lost = [float("nan")]
    if not pulsed or scene.shock is None:

        def rate(s: float, y: Array) -> list[float]:
            try:
                return function(*y.tolist(), *parameters)
            except LOST:
                return lost * len(y)

        return rate

    width, R = scene.shock.width, scene.rotor.length
    fx, fy, fz = (R * f for f in scene.shock.force)

    def driven(s: float, y: Array) -> list[float]:
        pulse = exp(-((s / width) ** 2))
        try:
            return function(*y.tolist(), *parameters, fx * pulse, fy * pulse, fz * pulse)
        except LOST:
            return lost * len(y)

    return driven


def constant_momenta(scene: Scene, n: int) -> Array:
    """The axial momenta of a model in which the spins are cyclic and already reduced, (2, n)."""
    return np.repeat(np.array(scene.momenta)[:, None], n, axis=1)
