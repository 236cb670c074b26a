"""What every integrated model offers: its program, how a scene fills the program's parameters, a start, the axes read back;
one integration of it, in units of the scene's own, and what the pair's motion keeps by any model.

Every integration runs in the scene's own units, so that a solver's absolute tolerance means the same for every scene and the
answer depends on the units of mass, length and time by rounding alone. Every motion keeps its energy less the shock's work, the
momentum about the joint line, and the lengths of bar and axes: a run that does not, within what its error estimate allows, is
not the pair's motion, whatever the solver says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import hypot, inf, nan, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrotor.numerics.arrays import Array as Array
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.pulse import pulse_windows
from lagrotor.numerics.segment import OutsideError, Projection, RightHandSide, Stretch, reporting
from lagrotor.numerics.source_cache import GeneratedFunction
from lagrotor.pair.scene import Link, Rotor, Scene, Shock
from lagrotor.pair.trajectory import Trajectory, momentum_about_joints, tilting_energy

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program


# Rates of PACE and axes of 1 share an absolute tolerance: rates are held as many times more accurately, as the energy is.
PACE = 16.0


@dataclass(frozen=True)
class NaturalUnits:
    """`scene` with R = 1, min(a + b, a − b) = 1 and a typical rate of PACE; the units of rate (rad/s) and inertia (kg m²)."""

    scene: Scene
    rate: float
    inertia: float


def natural_units(scene: Scene, rate: float = 0.0) -> NaturalUnits:
    """The scene in its own units, `rate` (rad/s) for the unit of rate if one is given; at rest, without spins or shock, 1/s."""
    inertia, R = min(_together_and_apart(scene)), scene.rotor.length
    rate = rate or typical_rate(scene) / PACE or 1.0
    rotor, link, shock = scene.rotor, scene.link, scene.shock
    weight = R * R / inertia
    in_units = replace(
        scene,
        spins=(scene.spins[0] / rate, scene.spins[1] / rate),
        rotor=Rotor(rotor.mass * weight, 1.0, rotor.I1 / inertia, rotor.I3 / inertia),
        link=link and Link(link.length / R, link.mass * weight, link.inertia / inertia),
        shock=shock
        and Shock(
            tuple(f * R / inertia / rate**2 for f in shock.force),  # type: ignore[arg-type]
            shock.at * rate,
            shock.width * rate,
            shock.body,
        ),
        rates=tuple(tuple(x / rate for x in v) for v in scene.rates),  # type: ignore[arg-type]
    )
    return NaturalUnits(in_units, rate, inertia)


def _together_and_apart(scene: Scene) -> tuple[float, float]:
    """Inertias a + b = J + m R²/2 of the axes' sum, a − b = J + 2 K R²/ell² of their difference (kg m²)."""
    if scene.link is None:
        return scene.rotor.J, scene.rotor.J
    R, link = scene.rotor.length, scene.link
    return scene.rotor.J + link.mass * R**2 / 2, scene.rotor.J + 2 * link.inertia * (R / link.length) ** 2


def typical_rate(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: (|G_1| + |G_2|)/I + sqrt(2T/I) and the shock's, I the smaller
    of the inertias, T the energy of the tilting.

    A pulse adds its impulse over I or, where it is so broad that the rotor turns meanwhile, sqrt(force R / I).
    """
    (together, apart), (v1, v2) = _together_and_apart(scene), scene.rates
    inertia = min(together, apart)
    total, difference = (hypot(*(x + sign * y for x, y in zip(v1, v2, strict=True))) for sign in (1, -1))
    rate = hypot(sqrt(together / inertia) * total, sqrt(apart / inertia) * difference) / sqrt(2)
    if scene.shock:
        torque = hypot(*scene.shock.force) * scene.rotor.length / inertia
        rate += min(2 * torque * scene.shock.width, sqrt(torque))
    return rate + (abs(scene.momenta[0]) + abs(scene.momenta[1])) / inertia


_BETWEEN_PROJECTIONS = 3.0  # rad of the scene's typical rate, by the fast extra
_BUDGET = 1_000_000.0  # evaluations of one integration, where a caller sets none


@dataclass(frozen=True)
class Observed:
    """Axes and rates (2, n, 3), axial momenta (2, n)."""

    axes: Array
    rates: Array
    momenta: Array


@dataclass(frozen=True, eq=False)
class ClosedMotion:
    """A closed form for one scene. error: of an axis up to the end of the run (tips: in units of R). reason: a sentence.

    motion: times (n,) in s → axes and rates, each (2, n, 3). errors: times → the errors up to them, where it is known how they
    grow. evaluations: of what was integrated.
    """

    error: float
    reason: str
    motion: Callable[[Array], tuple[Array, Array]]
    errors: Callable[[Array], Array] | None = None
    evaluations: int = 0


@dataclass(frozen=True)
class Model:
    """A model that is integrated.

    kind: (scene, driven) → which of the model's programs holds the scene, and the values of its parameters; driven by the
    pulse, the last three are the torque R F (N m) and not among the values. derive: (*kind) → the program of the right-hand
    side, its first `size` arguments the state. rhs: (*kind, bounded) → its function, generated. start: the state (d,) of a
    scene; raises SingularError where the coordinates cannot hold it. observe: axes from states (n, d).
    projection: brings states that drifted off the constraints back onto them. outside: whether a state of a pair with its
    bar lies where the model must not be integrated; time_to_singular: a time of which half is no more than what is left until
    a state is there. slack: of states (n, d) of such a pair, as `Evolution` has it. singular: the words of the singular
    position that axes (2, 3) at which a solver stopped are at, or none. angles: which states may grow without end, their
    rates being states. progress: called with the time of each evaluation of the right-hand side.
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
            bare, outside = rate, self.outside

            def rate(s: float, y: Array) -> list[float]:
                return [nan] * self.size if outside(y) else bare(s, y)

        return rate if self.progress is None else reporting(rate, self.progress, scene.shock.at if scene.shock else 0.0)


def scenes_of(scene: Scene, observed: Observed | Trajectory) -> list[Scene]:
    """The scene, begun in each of the states (n,) that are seen."""
    axes, rates = (array.swapaxes(0, 1).tolist() for array in (observed.axes, observed.rates))
    return [replace(scene, axes=r, rates=v) for r, v in zip(axes, rates, strict=True)]


def constant_momenta(scene: Scene, n: int) -> Array:
    """The axial momenta of a model in which the spins are cyclic and already reduced, (2, n)."""
    return np.repeat(np.array(scene.momenta)[:, None], n, axis=1)


def problem_of(
    model: Model,
    scene: Scene,
    bounded: bool = False,
    start: Array | None = None,
    budget: float = _BUDGET,
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
        windows=pulse_windows(shock.width, companion) if shock else (),
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
    budget: float = _BUDGET,
) -> Stretch:
    """One integration from t = 0 through increasing `times` (n,) in s with a local error: the model's states (n, d).

    companion: by steps that a run without it does not take. start: the model's state at t = 0, where it is not the scene's.

    Raises SingularError where the coordinates cannot hold the start, StopError where the run cannot go on, with `bounded`
    also where the model is badly conditioned, InputError without heyoka.
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


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_MOST_PANELS = 2_000  # beyond, the work of a broad pulse is not followed


# Weights that integrate polynomials up to the ninth degree, the two nodes in the middle left out.
_KEPT, _LOWER = np.r_[0:5, 7:12], np.zeros(12)
_LOWER[_KEPT] = np.linalg.solve(
    np.vander(_NODES[_KEPT], increasing=True).T, [2 / (n + 1) * (1 - n % 2) for n in range(10)]
)


@dataclass(frozen=True, eq=False)
class PulseNodes:
    """Gauss–Legendre nodes t (n,) and weights (n,) over the part of the pulse up to `end` (s).

    lower (n,): weights of lower order; the difference of the two sums bounds the error of the first.
    """

    t: Array
    weights: Array
    lower: Array
    end: float


def pulse_nodes(scene: Scene, t_end: float) -> PulseNodes | None:
    """Nodes for the shock's work on a scene in natural units; none without shock, or for a pulse of too many turns."""
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


def conservation_defect(scene: Scene, t: Array, observed: Observed, nodes: PulseNodes | None) -> Array:
    """The errors of axes and rates, signed, that would explain how far a run is from conserving what it must.

    Parameters
    ----------
    scene : Scene
        In natural units.
    t : Array
        The run's times (n,).
    observed : Observed
        Its states at them.
    nodes : PulseNodes or None
        Times of a shock, among t. Without them its work is not known, and what comes after it is held to the first state
        after it.
    """
    (a, b), (v1, v2) = scene.inertias, observed.rates
    size = float(np.sqrt(((a * v1 + b * v2) ** 2 + (a * v2 + b * v1) ** 2).sum(-1)).max())
    lengths = [np.linalg.norm(observed.axes, axis=-1) - 1]
    if scene.link:
        k = scene.link.length / scene.rotor.length
        bar = observed.axes[1] - observed.axes[0] + np.array([k, 0.0, 0.0])
        lengths.append((np.linalg.norm(bar, axis=-1) - k) * min(1.0, k))
    defects = [residual.ravel() for residual in lengths]
    before_pulse, after_pulse = np.ones(len(t), bool), np.zeros(len(t), bool)
    work, turn = (0.0, 0.0), (0.0, 0.0)
    if scene.shock:
        before_pulse, after_pulse = (
            t <= max(scene.shock.begin, t[0]),
            t >= min(scene.shock.end, nodes.end if nodes else inf),
        )
    if nodes:
        work, turn = _received(scene, t, observed, nodes)
    conserved = (
        tilting_energy(scene, observed.rates),
        momentum_about_joints(scene, observed.axes, observed.rates, observed.momenta),
    )
    # How much an error of 1 in the axes, and of PACE in the rates, may change each.
    scales = PACE * size, size + 2 * PACE * a + float(np.abs(observed.momenta).max())
    for values, (received, unsure), scale in zip(conserved, (work, turn), scales, strict=True):
        if scale > 0:
            later = values[after_pulse] - (values[0] + received if nodes else values[after_pulse][:1])
            later = np.sign(later) * np.maximum(np.abs(later) - unsure, 0.0)
            defects += [(values[before_pulse] - values[0]) / scale, later / scale]
    return np.concatenate(defects)


def _received(
    scene: Scene, t: Array, observed: Observed, nodes: PulseNodes
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Work and angular impulse of the pulse, each with a bound on the error of its quadrature."""
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
