"""What every integrated model offers: its program, how a scene fills the program's parameters, a start, the axes read back;
and one integration of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.natural_units import typical_rate
from lagrotor.numerics.generated import GeneratedFunction
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.pulse import COMPANION_STEP
from lagrotor.numerics.segment import OutsideError, Projection, RightHandSide, Stretch
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program

Array = NDArray[np.float64]
BETWEEN_PROJECTIONS = 3.0  # rad of the scene's typical rate, by the fast extra
BUDGET = 1_000_000.0  # evaluations of one integration, where a caller sets none


@dataclass(frozen=True)
class Observed:
    """Axes and rates (2, n, 3), axial momenta (2, n)."""

    axes: Array
    rates: Array
    momenta: Array


@dataclass(frozen=True, eq=False)
class ClosedMotion:
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
    earliest. singular: the words of the singular position that axes (2, 3) at which a solver stopped are at, or none. angles:
    which states may grow without end, their rates being states. progress: called with the time of each evaluation of the
    right-hand side.
    """

    name: str
    size: int
    kind: Callable[[Scene, bool], tuple[tuple[Any, ...], tuple[float, ...]]]
    derive: Callable[..., Program]
    rhs: GeneratedFunction
    start: Callable[[Scene], Array]
    observe: Callable[[Scene, Array], Observed]
    singular: Callable[[Array], str]
    projection: Callable[[Scene], Projection] | None = None
    outside: Callable[[Array], bool] | None = None
    time_to_singular: Callable[[Array], float] | None = None
    angles: tuple[int, ...] = ()
    progress: Callable[[float], None] | None = None

    def parameters(self, scene: Scene, driven: bool) -> tuple[tuple[Any, ...], tuple[float, ...]]:
        """The scene's kind and the values of its parameters, with the torque and the width of the pulse if `driven`."""
        kind, values = self.kind(scene, driven)
        if driven and scene.shock:
            values = (*values, *(scene.rotor.length * f for f in scene.shock.force), scene.shock.width)
        return kind, values

    def program(self, scene: Scene, driven: bool) -> tuple[Program, tuple[float, ...]]:
        """The scene's program, and the values of its parameters as `parameters` has them."""
        kind, values = self.parameters(scene, driven)
        return self.derive(*kind), values

    def rate(self, scene: Scene, driven: bool, bounded: bool = False) -> RightHandSide:
        """The right-hand side s, y ↦ y' in Python floats, s the time from the pulse's peak, with the pulse if `driven`.

        A state outside the range of the coordinates gives NaN, which makes a solver shorten its step; bounded: a state
        where the program is badly conditioned, too.
        """
        kind, values = self.parameters(scene, driven)
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


def problem_of(
    model: Model,
    scene: Scene,
    bounded: bool = False,
    start: Array | None = None,
    budget: float = BUDGET,
    companion: bool = False,
) -> Problem:
    """What `integrate` is given of a scene and a model; bounded: the run ends where the model is badly conditioned.

    start: the model's state at t = 0, where it is not that of the scene.
    """
    shock = scene.shock
    return Problem(
        free=model.rate(scene, False, bounded),
        start=model.start(scene) if start is None else start,
        budget=budget,
        driven=model.rate(scene, True, bounded) if shock else None,
        at=shock.at if shock else 0.0,
        width=shock.width if shock else 0.0,
        longest=COMPANION_STEP if companion else 1.0,
        project=model.projection(scene) if model.projection else None,
        typical_rate=typical_rate(scene),
        time_to_singular=model.time_to_singular if scene.link else None,
    )


def integrate_model(
    model: Model,
    scene: Scene,
    times: Array,
    local: float,
    engine: str = "core",
    bounded: bool = False,
    companion: bool = False,
    start: Array | None = None,
    budget: float = BUDGET,
) -> Stretch:
    """One integration from t = 0 through increasing `times` (n,) in s with a local error: the model's states (n, d).

    companion: by steps that a run without it does not take. start: the model's state at t = 0, where it is not the scene's.

    Raises SingularError where the coordinates cannot hold the start, StopError where the run cannot go on, with `bounded`
    also where the model is badly conditioned, InputError without heyoka.
    """
    problem = problem_of(model, scene, bounded, start, budget, companion)
    if engine == "core":
        return integrate(problem, times, local)
    from lagrotor.numerics.taylor import companion_order, taylor_order, taylor_solver

    order = companion_order(local) if companion else taylor_order(local)
    between = BETWEEN_PROJECTIONS / typical_rate(scene) if problem.project else inf
    solver = taylor_solver(lambda driven: model.program(scene, driven), order, between, model.angles)
    run = integrate(problem, times, local, solver)
    if bounded:
        from lagrotor.numerics.printers import compile_program

        program, values = model.program(scene, False)
        bounds = compile_program(replace(program, outputs=program.positive), "numpy")
        outside = ~np.all([bound > 0 for bound in bounds(*run.states.T, *values)], axis=0)
        if outside.any():
            raise OutsideError(float(times[np.argmax(outside)]))
    return run


def check_range(model: Model, scene: Scene) -> None:
    """Raises SingularError where the model cannot hold the scene's start, OutsideError where it is badly conditioned there."""
    if not np.isfinite(model.rate(scene, False, bounded=True)(0.0, model.start(scene))).all():
        raise OutsideError(0.0)
