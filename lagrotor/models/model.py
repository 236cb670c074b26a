"""What every integrated model offers: its program, how a scene fills the program's parameters, a start, the axes read back."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.codegen import Program
from lagrotor.numerics.integrate import Projection, Rate
from lagrotor.numerics.rhs import rate_factory
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
    """A model that is integrated.

    program: (scene, driven) → the program of the right-hand side, its first `size` arguments the state, and the values of
    its parameters; driven by the pulse, the last three are the torque R F (N m) and not among the values. start: the state
    (d,) of a scene; raises SingularError where the coordinates cannot hold it. observe: axes from states (n, d).
    projection: brings states that drifted off the constraints back onto them. outside: whether a state lies where the
    model must not be integrated; time_to_singular: the time after which a state may be there, at the earliest.
    """

    name: str
    size: int
    program: Callable[[Scene, bool], tuple[Program, tuple[float, ...]]]
    start: Callable[[Scene], Array]
    observe: Callable[[Scene, Array], Observed]
    projection: Callable[[Scene], Projection] | None = None
    outside: Callable[[Array], bool] | None = None
    time_to_singular: Callable[[Array], float] | None = None

    def rate(self, scene: Scene, driven: bool, bounded: bool = False) -> Rate:
        """The right-hand side s, y ↦ y' in Python floats, s the time from the pulse's peak, with the pulse if `driven`.

        A state outside the range of the coordinates gives NaN, which makes a solver shorten its step; bounded: a state
        where the program is badly conditioned, too.
        """
        program, values = self.program(scene, driven)
        shock = scene.shock if driven else None
        if shock:
            values = (*values, *(scene.rotor.length * f for f in shock.force), shock.width)
        rate = _factory(program, self.size, shock is not None, bounded)(*values)
        return rate if self.outside is None else _guarded(rate, self.outside, self.size)


@lru_cache(maxsize=64)
def _factory(program: Program, size: int, driven: bool, bounded: bool) -> Callable[..., Rate]:
    return rate_factory(program, size, driven, bounded)


def _guarded(rate: Rate, outside: Callable[[Array], bool], size: int) -> Rate:
    def guarded(s: float, y: Array) -> list[float]:
        return [float("nan")] * size if outside(y) else rate(s, y)

    return guarded


def constant_momenta(scene: Scene, n: int) -> Array:
    """The axial momenta of a model in which the spins are cyclic and already reduced, (2, n)."""
    return np.repeat(np.array(scene.momenta)[:, None], n, axis=1)
