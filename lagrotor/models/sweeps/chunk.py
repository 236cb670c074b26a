"""Scenes of one kind side by side: the minimal model on arrays, every trajectory with its own step."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError, LagrotorError, LagrotorWarning, SingularError
from lagrotor.models.conserved import conservation_defect
from lagrotor.models.minimal import MODEL, Kind, program, rhs_on_arrays
from lagrotor.models.model import Observed, check_range, constant_momenta
from lagrotor.models.natural_units import natural_units, typical_rate
from lagrotor.models.simulate import simulate
from lagrotor.models.sweeps.batch_dop853 import LEAST_TOLERANCE, Index, Rates, Swarm, march_swarm
from lagrotor.numerics.any_run import Ending
from lagrotor.numerics.estimate_constants import APART, FIRST, LOST
from lagrotor.numerics.estimated_run import UNKNOWN, errors_up_to, estimated_errors, start_beside
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.numerics.pulse import COMPANION_STEP
from lagrotor.numerics.taylor import march_lanes
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
MODELS = ("minimal", "spheres", "none")
_MOST_WATCHED = 16  # times, one a turn, at which two runs are compared besides those they are read at
_BETWEEN = 0.38  # of the way from one time to the next, where a companion stops besides


class Chunk(NamedTuple):
    """axes, rates (n, 2, m, 3), errors (n, m), evaluations (n,), models (n,) of part of an ensemble, NaN after what was reached;
    how each of its runs ended."""

    axes: Array
    rates: Array
    errors: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]
    endings: list[Ending]


def run_chunk(scenes: Sequence[Scene], times: Array, tol: float, engine: str) -> Chunk:
    """The work of one process: a few thousand scenes at once by `minimal`, those that it cannot hold by `spheres`.

    Each scene starts at times[0] = 0. Every run is within `tol` by its estimate, or has the best there is.
    """
    n, m = len(scenes), len(times)
    axes, rates = np.full((2, n, 2, m, 3), np.nan)
    none = np.full(n, MODELS.index("none"))
    end = Ending("end", float(times[-1]))
    chunk = Chunk(axes, rates, np.full((n, m), np.nan), np.zeros(n, np.int64), none, [end] * n)
    groups: dict[Kind | None, list[int]] = {}
    for i, scene in enumerate(scenes):
        groups.setdefault(kind_of(scene) if _in_range(scene) else None, []).append(i)
    for kind, group in groups.items():
        if kind is not None:
            _by_minimal(kind, [scenes[i] for i in group], np.array(group), times, tol, engine, chunk)
    for i in np.flatnonzero(chunk.models == MODELS.index("none")).tolist():
        with warnings.catch_warnings():  # what is not kept is said once for all
            warnings.simplefilter("ignore", LagrotorWarning)
            try:
                run = simulate(scenes[i], times, "spheres", tol)
            except (IntegrationError, SingularError) as refusal:
                chunk.endings[i] = Ending("stopped", 0.0, str(refusal))
                continue
        reached = len(run.t)
        chunk.evaluations[i] += run.evaluations
        chunk.axes[i, :, :reached], chunk.rates[i, :, :reached] = run.axes, run.rates
        chunk.errors[i, :reached], chunk.endings[i] = run.errors, run.ending
        chunk.models[i] = MODELS.index("spheres")
    return chunk


def _in_range(scene: Scene) -> bool:
    """Whether the minimal model is well conditioned at the scene's start."""
    try:
        check_range(MODEL, scene)
    except LagrotorError:
        return False
    return True


def _defects(scenes: list[Scene], times: Array, axes: Array, rates: Array) -> Array:
    """The error that explains how far each run is from conserving what it must, (n,): what rounding leaves in states that are
    badly conditioned, which two runs may have in common. The work of a shock is not known: after it, what it is kept from then
    on."""
    found = np.empty(len(scenes))
    for i, scene in enumerate(scenes):
        units = natural_units(replace(scene, shock=scene.shock_until(float(times[-1]))))
        seen = Observed(axes[i], rates[i] / units.rate, constant_momenta(units.scene, len(times)))
        found[i] = conservation_defect(units.scene, times * units.rate, seen, None)
    return found


def kind_of(scene: Scene) -> Kind | None:
    """Which program runs the scene; None where the minimal model has no coordinates for it."""
    if scene.link is None or max(abs(r[0]) for r in scene.axes) > 1 - 1e-12:
        return None
    k = scene.link.length / scene.rotor.length
    return (
        scene.inertias[1] != 0,
        "equal" if k == 1 else "short" if k < 1 else "long",
        scene.shock.body if scene.shock else 0,
    )


def _by_minimal(
    kind: Kind, scenes: list[Scene], places: Index, times: Array, tol: float, engine: str, chunk: Chunk
) -> None:
    """Run scenes of one kind side by side, at one local error after another, each APART times tighter, until two that follow
    each other agree within `tol`; put what comes out whole into its places."""
    ratios = np.array([scene.link.length / scene.rotor.length for scene in scenes if scene.link])
    turn = 2 * np.pi / np.array([typical_rate(scene) or 1e-300 for scene in scenes])
    # Two runs may agree by chance at the few times at which they are read.
    watched = int(min(_MOST_WATCHED, np.ceil(np.median(times[-1] / turn))))
    grid = np.union1d(times, np.linspace(0, times[-1], watched + 1))
    read, turns = np.isin(grid, times), grid / turn[:, None]
    columns, start = _columns(kind, scenes, ratios), np.array([MODEL.start(scene) for scene in scenes]).T.copy()
    swarm, who, local, companion = _swarm(kind, scenes, columns, start), np.arange(len(scenes)), tol * FIRST.value, True
    before, tightest = (
        np.full((len(scenes), 2, len(grid), 3), np.nan),
        TIGHTEST if engine == "fast" else LEAST_TOLERANCE,
    )
    while who.size:
        local = max(local, tightest)
        begun = start_beside(start[:, who].T).T if companion else start[:, who]
        if engine == "fast":
            parameters = np.array([column[who] for column in columns])
            states, spent = march_lanes(program(*kind), begun, parameters, grid, local, companion)
        else:
            # A step ends at each time, and in a pulse all may be as long as they can be: a companion's end at others and
            # are shorter, so that no two take the same few steps.
            t = np.union1d(grid, grid[:-1] + _BETWEEN * np.diff(grid)) if companion else grid
            longest = COMPANION_STEP if companion else 1.0
            states, spent = march_swarm(replace(swarm.part(who), start=begun, longest=longest), t, local)
            states = states[:, np.isin(t, grid)]
        chunk.evaluations[places[who]] += spent
        whole = np.isfinite(states).all((1, 2))
        who, states = who[whole], states[whole]
        axes, rates = np.empty((2, len(who), 2, len(grid), 3))
        for k in np.unique(ratios[who]):
            alike = np.flatnonzero(ratios[who] == k)
            seen = MODEL.observe(scenes[who[alike[0]]], states[alike].reshape(-1, 6))
            for rows, part in ((axes, seen.axes), (rates, seen.rates)):
                rows[alike] = part.reshape(2, len(alike), len(grid), 3).swapaxes(0, 1)
        apart = np.linalg.norm(axes - before[who], axis=-1).max(axis=1)
        apart = np.maximum(apart, _defects([scenes[i] for i in who], grid, axes, rates)[:, None])
        errors = errors_up_to(grid, estimated_errors(apart, local, turns[who], independent=not kind[2]), turn[who])[
            :, read
        ]
        errors[errors > LOST.value] = UNKNOWN
        before[who] = axes
        if not np.isnan(apart).any():  # of the first there is nothing to compare
            # Where a tighter run is farther from the last than that was from the one before it, rounding is all that differs.
            better = who[~(errors[:, -1] >= chunk.errors[places[who], -1])]
            at = np.searchsorted(who, better)
            here = places[better]
            chunk.axes[here], chunk.rates[here] = axes[at][:, :, read], rates[at][:, :, read]
            chunk.errors[here] = errors[at]
            chunk.models[here] = MODELS.index("minimal")
            who = who[(errors[:, -1] > tol) & (local > tightest)]
        local, companion = local / APART.value, not companion
    for i in places:
        lost = np.flatnonzero(chunk.errors[i] == UNKNOWN)
        chunk.endings[i] = Ending("lost", float(times[lost[0]])) if len(lost) else chunk.endings[i]


def _columns(kind: Kind, scenes: list[Scene], ratios: Array) -> list[Array]:
    """The program's parameters but for the force, each for all scenes (n,)."""
    massive, ratio, _ = kind
    inertias = np.array([scene.inertias for scene in scenes])
    momenta = np.array([scene.momenta for scene in scenes])
    columns = [inertias[:, 0], *([inertias[:, 1]] if massive else []), *([] if ratio == "equal" else [ratios])]
    return [*columns, momenta[:, 0], momenta[:, 1]]


def _swarm(kind: Kind, scenes: list[Scene], columns: list[Array], start: Array) -> Swarm:
    """The scenes of one kind as arrays."""
    body, function = kind[2], rhs_on_arrays(*kind)
    at, width, force = np.zeros(len(scenes)), np.zeros(len(scenes)), np.zeros((3, len(scenes)))
    if body:
        shocks = [(scene.shock, scene.rotor.length) for scene in scenes if scene.shock]
        at, width = np.array([s.at for s, _ in shocks]), np.array([s.width for s, _ in shocks])
        force = np.array([[R * f for f in s.force] for s, R in shocks]).T

    def rates(who: Index) -> Rates:
        # What all share goes in as a number: numbers among themselves cost nothing beside arrays.
        given = [float(c[0]) if (c == c[0]).all() else c[who] for c in columns]
        push, broad = force[:, who], width[who]

        def into(s: Array, y: Array, out: Array) -> None:
            pulse = push * np.exp(-((s / broad) ** 2)) if body else ()
            for row, values in zip(out, function(*y, *given, *pulse), strict=True):
                row[:] = values

        return into

    fastest = np.array([_fastest(scene) for scene in scenes])
    return Swarm(rates, start, fastest, at, width)


def _fastest(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: spins, start and shock against the tilting inertia."""
    shock = hypot(*scene.shock.impulse) * scene.rotor.length if scene.shock else 0.0
    spin = abs(scene.momenta[0]) + abs(scene.momenta[1])
    return 1 + (spin + shock) / scene.rotor.J + hypot(*scene.rates[0]) + hypot(*scene.rates[1])
