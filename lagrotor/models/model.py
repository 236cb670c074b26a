"""What every integrated model offers: its program, how a scene fills the program's parameters, a start, the axes read back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.generated import GeneratedFunction
from lagrotor.numerics.segment import Projection, RightHandSide
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Observed:
    """Axes and rates (2, n, 3), axial momenta (2, n)."""

    axes: Array
    rates: Array
    momenta: Array


@dataclass(frozen=True, eq=False)
class Answer:
    """A closed form for one scene. error: of an axis up to the end of the run (tips: in units of R). reason: a sentence.

    motion: times (n,) in s → axes and rates, each (2, n, 3).
    """

    error: float
    reason: str
    motion: Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True)
class Model:
    """A model that is integrated.

    kind: (scene, driven) → which of the model's programs holds the scene, and the values of its parameters; driven by the
    pulse, the last three are the torque R F (N m) and not among the values. derive: (*kind) → the program of the right-hand
    side, its first `size` arguments the state. rhs: (*kind, bounded) → its function, generated. start: the state (d,) of a
    scene; raises SingularError where the coordinates cannot hold it. observe: axes from states (n, d).
    projection: brings states that drifted off the constraints back onto them. outside: whether a state of a pair with its
    bar lies where the model must not be integrated; time_to_singular: the time after which a state may be there, at the
    earliest. angles: which states may grow without end, their rates being states. progress: called with the time of each
    evaluation of the right-hand side.
    """

    name: str
    size: int
    kind: Callable[[Scene, bool], tuple[tuple[Any, ...], tuple[float, ...]]]
    derive: Callable[..., Program]
    rhs: GeneratedFunction
    start: Callable[[Scene], Array]
    observe: Callable[[Scene, Array], Observed]
    projection: Callable[[Scene], Projection] | None = None
    outside: Callable[[Array], bool] | None = None
    time_to_singular: Callable[[Array], float] | None = None
    angles: tuple[int, ...] = ()
    progress: Callable[[float], None] | None = None

    def program(self, scene: Scene, driven: bool) -> tuple[Program, tuple[float, ...]]:
        """The scene's program, and the values of its parameters but for the torque."""
        kind, values = self.kind(scene, driven)
        return self.derive(*kind), values

    def rate(self, scene: Scene, driven: bool, bounded: bool = False) -> RightHandSide:
        """The right-hand side s, y ↦ y' in Python floats, s the time from the pulse's peak, with the pulse if `driven`.

        A state outside the range of the coordinates gives NaN, which makes a solver shorten its step; bounded: a state
        where the program is badly conditioned, too.
        """
        kind, values = self.kind(scene, driven)
        shock = scene.shock if driven else None
        if shock:
            values = (*values, *(scene.rotor.length * f for f in shock.force), shock.width)
        rate: RightHandSide = self.rhs(*kind, bounded)(*values)
        if self.outside and scene.link:
            rate = _guarded(rate, self.outside, self.size)
        return (
            rate if self.progress is None else _reporting(rate, self.progress, scene.shock.at if scene.shock else 0.0)
        )


def _guarded(rate: RightHandSide, outside: Callable[[Array], bool], size: int) -> RightHandSide:
    def guarded(s: float, y: Array) -> list[float]:
        return [float("nan")] * size if outside(y) else rate(s, y)

    return guarded


def _reporting(rate: RightHandSide, progress: Callable[[float], None], at: float) -> RightHandSide:
    def reporting(s: float, y: Array) -> list[float]:
        progress(s + at)
        return rate(s, y)

    if bare := getattr(rate, "bare", None):
        reporting.bare = _reporting(bare, progress, at)  # type: ignore[attr-defined]
    return reporting


def constant_momenta(scene: Scene, n: int) -> Array:
    """The axial momenta of a model in which the spins are cyclic and already reduced, (2, n)."""
    return np.repeat(np.array(scene.momenta)[:, None], n, axis=1)
