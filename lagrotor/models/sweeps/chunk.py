"""The runs of one chunk of scenes, from arrays to arrays.

`run_chunk` needs only its arguments, so that any executor can run it, here or on another machine. The scenes of one kind are
integrated together by the minimal model, each twice and with its own steps, and all are compared at once. A scene whose first
two integrations do not keep the tolerance continues as in `simulate`. The model `spheres` runs scenes that the minimal model
cannot represent.
"""

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import IntegrationError, LagrotorError, LagrotorWarning, SingularError
from lagrotor.models.minimal import MODEL, Kind, program, rhs_on_arrays
from lagrotor.models.model import PACE, TURN, NaturalUnits, check_range, natural_units
from lagrotor.models.simulate import evolution_of, simulate, trajectory_of
from lagrotor.models.sweeps.batch_dop853 import Index, Rates, Swarm, march_swarm
from lagrotor.models.sweeps.endings import Endings
from lagrotor.models.sweeps.natural_columns import NaturalColumns, kind_of_number
from lagrotor.models.sweeps.scene_columns import SceneColumns
from lagrotor.numerics.error_estimate import (
    MOST_EVALUATIONS,
    UNKNOWN,
    EvaluationBudget,
    Evolution,
    Leg,
    Legs,
    Motions,
    compare_runs,
    comparison_times,
    conserves,
    estimate_runs,
    first_local_error,
    is_feasible,
    march_legs,
    next_local_error,
    perturbed_state,
    unavoidable_error,
)
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Array, StopError, Stretch
from lagrotor.numerics.solver_constants import APART
from lagrotor.numerics.taylor import march_lanes
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory

CHUNK = 2048  # trajectories, integrated twice: an array of both is 32 KiB
MODELS = ("minimal", "spheres", "none")
# Three times the evaluations of motions far from singular positions at a tolerance of 1e-13.
_PATIENCE = EvaluationBudget(5_000, 250 * 2 * pi)
_MOST_STATES = 4_000_000  # of one batch, 200 MB
_COMPARED = 16_384  # states that are compared at once, whose arrays stay in the cache


@dataclass(frozen=True, eq=False)
class ChunkRuns:
    """The runs of n scenes at m times as arrays.

    - `axes` and `rates` (1/s): (n, 2, m, 3), and `errors`: (n, m); NaN after the end of a run.
    - `evaluations` and `models`, indices into MODELS: (n,).
    - `endings`: the endings of the runs.
    """

    axes: Array
    rates: Array
    errors: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]
    endings: Endings

    @classmethod
    def none(cls, n: int, times: Array) -> "ChunkRuns":
        """Return the runs of n scenes that were not run."""
        (axes, rates), errors = np.full((2, n, 2, len(times), 3), np.nan), np.full((n, len(times)), np.nan)
        endings = Endings(np.zeros(n, np.int8), np.full(n, times[-1]), {})
        return cls(axes, rates, errors, np.zeros(n, np.int64), np.full(n, MODELS.index("none")), endings)


@dataclass(frozen=True, eq=False)
class _Member:
    """A scene that the minimal model runs: its number, the scene in SI and in natural units, and its motion."""

    number: int
    scene: Scene
    units: NaturalUnits
    evolution: Evolution


def run_chunk(columns: SceneColumns, times: Array, tol: float, engine: str) -> ChunkRuns:
    """Run some thousand scenes at increasing times (m,) in s, with the largest error `tol`, by the engine "core" or "fast"."""
    begin, since = float(times[0]), times - times[0]
    columns = columns.since(begin, float(since[-1]))
    runs = ChunkRuns.none(len(columns), times)
    with np.errstate(all="ignore"):
        # The minimal model represents no axis along the joint line.
        minimal = columns.linked & (np.abs(columns.axes[..., 0]).max(1) <= 1 - 1e-12)
        settled = np.zeros(len(columns), bool)
        rows = np.flatnonzero(minimal & ~columns.shocked)
        natural = NaturalColumns.of(columns.take(rows))
        for number in np.unique(natural.kinds).tolist():
            same = np.flatnonzero(natural.kinds == number)
            same = same[np.argsort(natural.rate[same], kind="stable")]  # neighbours take about as many steps
            together = max(1, _MOST_STATES // (2 * len(comparison_times(since))))
            for first in range(0, len(same), together):
                part = same[first : first + together]
                scenes = natural.take(part)
                settled[rows[part]] = _settle(kind_of_number(number), scenes, since, tol, engine, runs, rows[part])
    alone = dict[int, Trajectory]()
    for kind, members in _members(columns, np.flatnonzero(minimal & ~settled), since, engine).items():
        alone |= _by_minimal(kind, members, since, tol, engine, runs)
    endings = [Ending("end", float(times[-1]))] * len(columns)
    for i in np.flatnonzero(~settled).tolist():
        try:
            with warnings.catch_warnings():  # one warning for all follows
                warnings.simplefilter("ignore", LagrotorWarning)
                run = alone.get(i) or simulate(columns.scene(i), since, "spheres", tol)
        except (IntegrationError, SingularError) as refusal:
            endings[i] = Ending("stopped", begin, str(refusal))
            continue
        reached, endings[i] = len(run.t), replace(run.ending, at=begin + run.ending.at)
        runs.evaluations[i] += run.evaluations
        runs.axes[i, :, :reached], runs.rates[i, :, :reached] = run.axes, run.rates
        runs.errors[i, :reached], runs.models[i] = run.errors, MODELS.index(run.model)
    return replace(runs, endings=Endings.of(endings))


def _settle(
    kind: Kind, scenes: NaturalColumns, since: Array, tol: float, engine: str, runs: ChunkRuns, rows: Index
) -> NDArray[np.bool_]:
    """Integrate each scene of one kind by pairs until a pair keeps the tolerance or none can, and write the best run of each
    into the rows of `runs`. Return True for these. Motions that separate, stop or do not conserve are left to `estimate_runs`."""
    common = comparison_times(since)
    t, read = common * scenes.rate[:, None], np.searchsorted(common, since)
    turns = t[:, -1] / TURN
    starts, start_errors, conditioned = scenes.starts(kind)
    perturbed, parameters = perturbed_state(starts, start_errors[:, None]), scenes.parameters(kind)
    budget = np.minimum(_PATIENCE.base + _PATIENCE.per_turn * turns, MOST_EVALUATIONS)
    settled, evaluations, smallest = (
        np.zeros(len(rows), bool),
        np.zeros(len(rows), np.int64),
        np.full(len(rows), np.inf),
    )
    pending = np.flatnonzero(conditioned & is_feasible(turns))
    # Of the looser integration of each pair: its local error, whether it is a companion, and whether it is to be computed.
    local, companion, fresh = (
        first_local_error(turns, tol)[pending],
        np.ones(len(pending), bool),
        np.ones(len(pending), bool),
    )
    previous = np.empty((MODEL.size, 0, len(common)))
    while pending.size:
        who, own = np.concatenate([pending[fresh], pending]), np.concatenate([companion[fresh], ~companion])
        legs = Legs(
            np.where(own[:, None], perturbed[who], starts[who]), t[who], np.concatenate([local[fresh], local / APART.value]),
            own, budget[who],
        )  # fmt: skip
        motions = _march(kind, parameters[:, who], legs, engine)
        failed = motions.evaluations > legs.budget
        failed[list(motions.stops)] = True
        np.add.at(evaluations, who, motions.evaluations)
        looser, tighter = motions.components[:, : -len(pending)], motions.components[:, -len(pending) :]
        if not fresh.all():
            new, looser = looser, np.empty(tighter.shape)
            looser[:, fresh], looser[:, ~fresh] = new, previous
        sound, error = ~np.isin(pending, who[failed]), np.empty(len(pending))
        size = max(1, _COMPARED // len(common))
        for first in range(0, len(pending), size):
            place = slice(first, first + size)
            part, states = pending[place], (looser[:, place], tighter[:, place])
            some = scenes.take(part)
            loose, tight = (some.observed(kind, np.moveaxis(components, 0, -1)) for components in states)
            found = compare_runs(
                t[part], TURN, local[place] / APART.value,
                np.sqrt(((loose.axes - tight.axes) ** 2).sum(-1)).max(0),
                [some.conserved(observed).changes() for observed in (loose, tight)],
                concave=len(since) > 2,
            )  # fmt: skip
            apart = np.abs(loose.rates - tight.rates).max((0, 2, 3)) / PACE
            error[place] = found.grown[:, -1]
            sound[place] &= conserves(found, apart) & ~(found.lost < np.inf) & np.isfinite(error[place])
            ready = np.flatnonzero(sound[place] & (error[place] <= smallest[part]))
            smallest[part[ready]], done = error[place][ready], rows[part[ready]]
            runs.axes[done] = tight.axes[:, ready][:, :, read].swapaxes(0, 1)
            runs.rates[done] = (tight.rates[:, ready][:, :, read] * some.rate[ready, None, None]).swapaxes(0, 1)
            runs.errors[done] = np.minimum(found.grown[ready][:, read], UNKNOWN)
        third, following = next_local_error(local, local / APART.value, error, tol)
        onward = sound & (error > tol) & (unavoidable_error(turns[pending]) <= tol) & (following < local)
        settled[pending[sound & ~onward]] = True
        previous, fresh = tighter[:, onward & third], ~third[onward]
        companion = np.where(third, ~companion, True)[onward]
        pending, local = pending[onward], following[onward]
    runs.evaluations[rows[settled]], runs.models[rows[settled]] = evaluations[settled], MODELS.index("minimal")
    return settled


def _march(kind: Kind, parameters: Array, legs: Legs, engine: str) -> Motions:
    """Integrate legs of scenes without a shock, each with its column of the parameters (p, n)."""
    if legs.times.shape[1] == 1:
        return Motions.begun(legs)
    if engine == "fast":
        return march_lanes(program(*kind), parameters, legs)
    return march_swarm(_swarm(kind, parameters), np.arange(len(legs.times)), legs)


def _members(columns: SceneColumns, rows: Index, since: Array, engine: str) -> dict[Kind, list[_Member]]:
    """Return the scenes of some rows by the kind of their program, without those that are badly conditioned at the start."""
    groups: dict[Kind, list[_Member]] = {}
    for i in rows.tolist():
        scene = columns.scene(i)
        units = natural_units(scene)
        try:
            check_range(MODEL, units.scene)
            end = float(since[-1] * units.rate)
            evolution = evolution_of(MODEL, units.scene, end, _PATIENCE, engine, bounded=True)
        except LagrotorError:
            continue
        groups.setdefault(MODEL.kind(units.scene, True)[0], []).append(_Member(i, scene, units, evolution))
    return groups


def _by_minimal(
    kind: Kind, members: Sequence[_Member], since: Array, tol: float, engine: str, runs: ChunkRuns
) -> dict[int, Trajectory]:
    """Return {number of the scene: its run} for the scenes of one kind whose runs reach the end. The evaluations of the other
    runs are added to those of `runs`."""
    alone = dict[int, Trajectory]()
    rows = len(since) + max(73 + len(member.evolution.watch) for member in members)
    together = max(1, _MOST_STATES // rows)
    for first in range(0, len(members), together):
        batch = members[first : first + together]
        scenes = [member.units.scene for member in batch]
        columns = np.array([MODEL.kind(scene, True)[1] for scene in scenes]).T
        swarm = _swarm(kind, columns, scenes)

        def march(who: Index, legs: Legs, columns: Array = columns, swarm: Swarm = swarm) -> Motions:
            if engine == "fast":
                return march_lanes(program(*kind), columns[:, who], legs)
            return march_swarm(swarm, who, legs)

        def integrate(legs: Mapping[int, Leg], march: object = march) -> Mapping[int, Stretch | StopError]:
            return march_legs(legs, march)  # type: ignore[arg-type]

        estimates = estimate_runs([m.evolution for m in batch], [since * m.units.rate for m in batch], tol, integrate)
        for member, run in zip(batch, estimates, strict=True):
            if isinstance(run, IntegrationError) or run.ending.early:
                runs.evaluations[member.number] += run.evaluations
            else:
                run, units = run.by_clock(0.0, 1 / member.units.rate), member.units
                alone[member.number] = trajectory_of(member.scene, units, "minimal", "", since, run)
    return alone


def _swarm(kind: Kind, parameters: Array, scenes: Iterable[Scene] = ()) -> Swarm:
    """Return problems of one kind, with parameters (p, n), to be integrated together. The scenes, in natural units, have the
    shocks of a kind with a shocked rotor."""
    body, make, n = kind[2], rhs_on_arrays(*kind), parameters.shape[1]
    at, width, force = np.zeros(n), np.zeros(n), np.zeros((3, n))
    if body:
        shocks = [scene.shock for scene in scenes if scene.shock]
        at, width = np.array([s.at for s in shocks]), np.array([s.width for s in shocks])
        force = np.array([s.force for s in shocks]).T

    def rates(who: Index) -> Rates:
        function, push, broad = make(*parameters[:, who]), force[:, who], width[who]

        def into(s: Array, y: Array, out: Array) -> None:
            pulse = push * np.exp(-((s / broad) ** 2)) if body else ()
            out[:3] = y[3:]  # the velocities
            for row, values in zip(out[3:], function(*y, *pulse)[3:], strict=True):
                row[:] = values

        return into

    return Swarm(rates, PACE, at, width)
