"""The description of an integrated model, its integration in natural units, and the conservation laws of the pair.

Every integration runs in natural units of the scene. The absolute tolerance of a solver then means the same for every scene,
and the result depends on the units of mass, length and time by rounding alone. Every motion conserves its energy minus the work
of the shock, the momentum about the joint line, and the lengths of bar and axes. A run that violates this by more than its
error estimate is refused, whatever the solver reports.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from math import hypot, inf, nan, pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.pulse import pulse_windows
from lagrotor.numerics.segment import OutsideError, Projection, RightHandSide, Stretch, reporting
from lagrotor.numerics.source_cache import GeneratedFunction
from lagrotor.pair.scene import Link, Rotor, Scene
from lagrotor.pair.trajectory import Inertias, Trajectory, momentum_about_joints, tilting_energy

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program


# Rates of PACE and axes of 1 share an absolute tolerance, so that rates and energy are PACE times more accurate.
PACE = 16.0
TURN = 2 * pi / PACE  # the typical period in natural units
FARTHEST_ALONG = 49, 50  # the largest |x| of an axis, as a fraction; there Mercator coordinates magnify errors fivefold


@dataclass(frozen=True)
class NaturalUnits:
    """A scene in units in which R = 1, min(a + b, a − b) = 1 and its typical rate is PACE. `rate` (rad/s) and `inertia` (kg m²)
    are the units of rate and of inertia."""

    scene: Scene
    rate: float
    inertia: float


def natural_units(scene: Scene, rate: float = 0.0) -> NaturalUnits:
    """Return the scene in natural units. `rate` (rad/s) is the unit of rate; 0 takes the typical rate of the scene / PACE."""
    inertia, R = min(_together_and_apart(scene)), scene.rotor.length
    rate = rate or typical_rate(scene) / PACE or 1.0
    rotor, link, shock = scene.rotor, scene.link, scene.shock
    weight = R * R / inertia
    force: Any = tuple(f * R / inertia / rate**2 for f in shock.force) if shock else None
    in_units = replace(
        scene,
        spins=(scene.spins[0] / rate, scene.spins[1] / rate),
        rotor=Rotor(rotor.mass * weight, 1.0, rotor.I1 / inertia, rotor.I3 / inertia),
        link=link and Link(link.length / R, link.mass * weight, link.inertia / inertia),
        shock=shock and replace(shock, force=force, at=shock.at * rate, width=shock.width * rate),
        rates=tuple(tuple(x / rate for x in v) for v in scene.rates),  # type: ignore[arg-type]
    )
    return NaturalUnits(in_units, rate, inertia)


def _together_and_apart(scene: Scene) -> tuple[float, float]:
    """Return the inertia J + m R²/2 of axes that move alike, and J + 2 K R²/ell² of axes that move oppositely, kg m²."""
    if scene.link is None:
        return scene.rotor.J, scene.rotor.J
    R, link = scene.rotor.length, scene.link
    return scene.rotor.J + link.mass * R**2 / 2, scene.rotor.J + 2 * link.inertia * (R / link.length) ** 2


def typical_rate(scene: Scene) -> float:
    """Return a rate (rad/s) that the motion hardly exceeds: (|G_1| + |G_2|)/I, plus `tilting_rate`. I is the smaller inertia."""
    return tilting_rate(scene) + (abs(scene.momenta[0]) + abs(scene.momenta[1])) / min(_together_and_apart(scene))


def tilting_rate(scene: Scene) -> float:
    """Return a rate (rad/s) that the axes hardly exceed: sqrt(2T/I), plus a rate for the shock.

    I is the smaller inertia and T the energy of tilting. A pulse adds its impulse over I, or sqrt(force R / I) if it is so
    broad that the rotor turns during it.
    """
    (together, apart), (v1, v2) = _together_and_apart(scene), scene.rates
    inertia = min(together, apart)
    total, difference = (hypot(*(x + sign * y for x, y in zip(v1, v2, strict=True))) for sign in (1, -1))
    rate = hypot(sqrt(together / inertia) * total, sqrt(apart / inertia) * difference) / sqrt(2)
    if scene.shock:
        torque = hypot(*scene.shock.force) * scene.rotor.length / inertia
        rate += min(2 * torque * scene.shock.width, sqrt(torque))
    return rate


_BETWEEN_PROJECTIONS = 3.0  # rad of the typical rate between projections, by the fast extra
_BUDGET = 1_000_000.0  # evaluations of one integration, by default


@dataclass(frozen=True)
class Observed:
    """The axes and their rates (2, n, 3), and the axial momenta (2, n), of n states of a model."""

    axes: Array
    rates: Array
    momenta: Array


@dataclass(frozen=True, eq=False)
class ClosedMotion:
    """A closed form of the motion of one scene.

    - `error`: the largest error of an axis up to the end of the run, which is that of a tip in units of R.
    - `reason`: the reason for the closed form in words.
    - `motion`: a function of times (n,) in s that returns the axes and their rates, (2, n, 3) each.
    - `errors`: a function of times that returns the error up to each; None if the growth of the error is not known.
    - `evaluations`: the number of evaluations that the closed form needed.
    """

    error: float
    reason: str
    motion: Callable[[Array], tuple[Array, Array]]
    errors: Callable[[Array], Array] | None = None
    evaluations: int = 0


@dataclass(frozen=True)
class Model:
    """A model that is integrated, with states (d,). Most fields are functions.

    - `kind`: from (scene, driven) to the kind of program and the values of its parameters. A driven program takes the torque
      R F (N m) and the width of the pulse as further parameters.
    - `derive`: from (*kind) to the program, whose first `size` arguments are the state.
    - `rhs`: from (*kind, bounded) to the generated right-hand side.
    - `start`: from a scene to its state (d,). It raises SingularError if the coordinates cannot represent the scene.
    - `observe`: from a scene and states (n, d) to axes, rates and momenta.
    - `singular`: from axes (2, 3) to a sentence that names their singular position; "" if there is none.
    - `projection`: from a scene to the projection of a state onto the constraints; None without constraints.
    - `outside`: True for a state of a pair with a bar at which the model must not be integrated.
    - `time_to_singular`: from a state to a time; half of it is at most the time until `outside` becomes True.
    - `slack`: from states (n, d) to the uncertainty of the constraints (n,), in units of rounding.
    - `angles`: the indices of the states that may grow without bound and whose rates are states.
    - `progress`: a function that is called with the time of each evaluation.
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
    slack: Callable[[Array], Array] | None = None
    angles: tuple[int, ...] = ()
    progress: Callable[[float], None] | None = None

    def parameters(self, scene: Scene, driven: bool) -> tuple[tuple[Any, ...], tuple[float, ...]]:
        """Return the kind of program of the scene and its parameter values, with torque and width of the pulse if `driven`."""
        kind, values = self.kind(scene, driven)
        if driven and scene.shock:
            values = (*values, *(scene.rotor.length * f for f in scene.shock.force), scene.shock.width)
        return kind, values

    def program(self, scene: Scene, driven: bool) -> tuple[Program, tuple[float, ...]]:
        """Return the program of the scene and the values of its parameters."""
        kind, values = self.parameters(scene, driven)
        return self.derive(*kind), values

    def rate(self, scene: Scene, driven: bool, bounded: bool = False) -> RightHandSide:
        """Return the right-hand side s, y ↦ y' in Python floats, with s the time from the peak of the pulse.

        A state outside the range of the coordinates gives NaN, so that a solver shortens its step. With `bounded`, a
        state at which the program is badly conditioned gives NaN, too.
        """
        kind, values = self.parameters(scene, driven)
        rate: RightHandSide = self.rhs(*kind, bounded)(*values)
        if self.outside and scene.link:
            bare, outside = rate, self.outside

            def rate(s: float, y: Array) -> list[float]:
                return [nan] * self.size if outside(y) else bare(s, y)

        return rate if self.progress is None else reporting(rate, self.progress, scene.shock.at if scene.shock else 0.0)


def without_idle_shock(scene: Scene, t_end: float) -> Scene:
    """Return the scene without a shock that does not act between 0 and t_end (s); the same object if nothing changes."""
    return replace(scene, shock=None) if scene.shock and not scene.shock_until(t_end) else scene


def scenes_of(scene: Scene, observed: Observed | Trajectory) -> list[Scene]:
    """Return a list of n scenes, each with one of the n observed states as its start."""
    axes, rates = (array.swapaxes(0, 1).tolist() for array in (observed.axes, observed.rates))
    return [replace(scene, axes=r, rates=v) for r, v in zip(axes, rates, strict=True)]


def constant_momenta(scene: Scene, n: int) -> Array:
    """Return the axial momenta of the scene at n times, (2, n), which a model without spin angles keeps constant."""
    return np.repeat(np.array(scene.momenta)[:, None], n, axis=1)


def problem_of(
    model: Model, scene: Scene, bounded: bool = False, start: Array | None = None, budget: float = _BUDGET,
    companion: bool = False,
) -> Problem:  # fmt: skip
    """Return the integration problem of a scene from the state `start` of the model, by default the start of the scene."""
    shock = scene.shock
    return Problem(
        free=model.rate(scene, False, bounded),
        start=model.start(scene) if start is None else start,
        budget=budget,
        driven=model.rate(scene, True, bounded) if shock else None,
        at=shock.at if shock else 0.0,
        windows=pulse_windows(shock.width, companion) if shock else (),
        project=model.projection(scene) if model.projection else None,
        typical_rate=typical_rate(scene),
        time_to_singular=model.time_to_singular if scene.link else None,
    )


def integrate_model(
    model: Model, scene: Scene, times: Array, local: float, engine: str = "core", bounded: bool = False,
    companion: bool = False, start: Array | None = None, budget: float = _BUDGET,
) -> Stretch:  # fmt: skip
    """Integrate from t = 0 through increasing `times` (n,) in s with a local error, to the states (n, d).

    With `companion` the integration takes other steps, so that a comparison estimates the error. Raises SingularError if the
    coordinates cannot represent the start, and StopError if the run cannot continue. With `bounded` it also stops where the
    model is badly conditioned.
    """
    problem = problem_of(model, scene, bounded, start, budget, companion)
    if engine == "core":
        return integrate(problem, times, local)
    from lagrotor.numerics.taylor import taylor_order, taylor_solver

    between = _BETWEEN_PROJECTIONS / typical_rate(scene) if problem.project else inf
    solver = taylor_solver(
        lambda driven: model.program(scene, driven), taylor_order(local, companion), between, model.angles
    )
    run = integrate(problem, times, local, solver)
    if bounded:
        program, values = model.program(scene, False)
        outside = ~np.all([bound > 0 for bound in _bounds(program)(*run.states.T, *values)], axis=0)
        if outside.any():
            raise OutsideError(float(times[np.argmax(outside)]))
    return run


@lru_cache(maxsize=16)
def _bounds(program: Program) -> Callable[..., list[Array]]:
    """Compile the expressions of a program that are positive where it is well conditioned, for arrays of states."""
    from lagrotor.numerics.printers import compile_program

    return compile_program(replace(program, outputs=program.positive), "numpy")


def check_range(model: Model, scene: Scene) -> None:
    """Raise SingularError if the model cannot represent the start, OutsideError if it is badly conditioned there."""
    if not np.isfinite(model.rate(scene, False, bounded=True)(0.0, model.start(scene))).all():
        raise OutsideError(0.0)


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_MOST_PANELS = 2_000  # the most panels; broader pulses are not integrated


# Weights of ninth degree without the two middle nodes.
_KEPT, _LOWER = np.r_[0:5, 7:12], np.zeros(12)
_LOWER[_KEPT] = np.linalg.solve(
    np.vander(_NODES[_KEPT], increasing=True).T, [2 / (n + 1) * (1 - n % 2) for n in range(10)]
)


@dataclass(frozen=True, eq=False)
class PulseNodes:
    """Nodes t (n,) and weights (n,) of a Gauss–Legendre quadrature over a pulse up to `end`. `lower` (n,) are weights of a
    lower order, whose result differs by about the error."""

    t: Array
    weights: Array
    lower: Array
    end: float


def pulse_nodes(scene: Scene, t_end: float) -> PulseNodes | None:
    """Return the nodes for the work of the shock on a scene in natural units; None without shock, or if it lasts too long."""
    if scene.shock is None:
        return None
    begin, end = max(0.0, scene.shock.begin), min(t_end, scene.shock.end)
    count = int(np.ceil((end - begin) / min(scene.shock.width, 1 / PACE)))
    if not 0 < count <= _MOST_PANELS:
        return None
    edges = np.linspace(begin, end, count + 1)
    half = np.diff(edges)[:, None] / 2
    t = (edges[:-1, None] + half * (1 + _NODES)).ravel()
    return PulseNodes(t, (half * _WEIGHTS).ravel(), (half * _LOWER).ravel(), end)


@dataclass(frozen=True)
class Conserved:
    """The quantities that the motions of pairs in natural units conserve, with leading axes for the pairs.

    - `lengths`: the residuals (…, n) of the lengths of axes and bar.
    - `energy` and `momentum`: the energy and the momentum about the joint line, (…, n).
    - `scales`: their largest changes, (…, 1), by an error of 1 in the axes and of PACE in the rates.
    """

    lengths: list[Array]
    energy: Array
    momentum: Array
    scales: tuple[Array, Array]

    def changes(self) -> Array:
        """Return the violations (…, q) of the conservation laws if no force acts, as errors of axes and rates."""
        changes = list[Array]()
        for values, scale in zip((self.energy, self.momentum), self.scales, strict=True):
            change = values - values[..., :1]
            changes.append(np.divide(change, scale, out=np.zeros(change.shape), where=scale > 0))
        return np.concatenate([*self.lengths, *changes], axis=-1)


def conserved(inertias: Inertias, k: float | Array | None, observed: Observed) -> Conserved:
    """Return the conserved quantities of observed states with axes (2, …, n, 3). Inertias and k = ell/R (None without a bar) are
    numbers or arrays (…, 1)."""
    (a, b), (v1, v2), axes = inertias, observed.rates, observed.axes
    # |a v_1 + b v_2|² + |a v_2 + b v_1|²
    squared = (a * a + b * b) * (v1**2 + v2**2).sum(-1) + 4 * a * b * (v1 * v2).sum(-1)
    size = np.sqrt(np.maximum(squared, 0.0).max(-1, keepdims=True))
    lengths = [np.sqrt((r**2).sum(-1)) - 1 for r in axes]
    if k is not None:
        bar = axes[1] - axes[0]
        bar[..., 0] += k
        lengths.append((np.sqrt((bar**2).sum(-1)) - k) * np.minimum(1.0, k))
    scales = PACE * size, size + 2 * PACE * a + np.abs(observed.momenta).max(0).max(-1, keepdims=True)
    energy = tilting_energy(inertias, observed.rates)
    return Conserved(lengths, energy, momentum_about_joints(inertias, axes, observed.rates, observed.momenta), scales)


def conservation_defect(scene: Scene, t: Array, observed: Observed, nodes: PulseNodes | None) -> Array:
    """Return the violations of the conservation laws along a run, each as the error of axes and rates that would cause it. The
    scene is in natural units. The laws are those of the lengths, the energy and the momentum about the joint line."""
    kept = conserved(scene.inertias, scene.k if scene.link else None, observed)
    if scene.shock is None:
        return kept.changes()
    prior = t <= max(scene.shock.begin, t[0])
    posterior = t >= min(scene.shock.end, nodes.end if nodes else inf)
    work, turn = _received(scene, t, observed, nodes) if nodes else ((0.0, 0.0), (0.0, 0.0))
    defects = list(kept.lengths)
    quantities = zip((kept.energy, kept.momentum), (work, turn), kept.scales, strict=True)
    for values, (received, uncertainty), scale in quantities:
        if scale > 0:
            later = values[posterior] - (values[0] + received if nodes else values[posterior][:1])
            later = np.sign(later) * np.maximum(np.abs(later) - uncertainty, 0.0)
            defects += [(values[prior] - values[0]) / scale, later / scale]
    return np.concatenate(defects)


def _received(
    scene: Scene, t: Array, observed: Observed, nodes: PulseNodes
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return two pairs (value, bound of its quadrature error): the work of the pulse, and its angular impulse."""
    assert scene.shock is not None
    at = np.searchsorted(t, nodes.t)
    i = scene.shock.body - 1
    r, v = observed.axes[i, at], observed.rates[i, at]
    pulse = np.exp(-(((nodes.t - scene.shock.at) / scene.shock.width) ** 2))
    torque = scene.rotor.length * np.array(scene.shock.force)
    power, turning = pulse * (v @ torque), pulse * np.cross(r, torque)[:, 0]

    def total(values: Array) -> tuple[float, float]:
        whole = float(nodes.weights @ values)
        return whole, abs(whole - float(nodes.lower @ values))

    return total(power), total(turning)
