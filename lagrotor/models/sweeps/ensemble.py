"""Many scenes at once: the minimal model on arrays, in chunks, each trajectory with its own step and error estimate.

A chunk is one call of `run_chunk`, which needs only its arguments: any executor of `concurrent.futures` can run it, here or on
other machines.
"""

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError, IntegrationError, LagrotorError, LagrotorWarning, SingularError
from lagrotor.models.minimal import MODEL, Kind, program, rhs_on_arrays
from lagrotor.models.model import PACE, NaturalUnits, check_range, constant_momenta, natural_units
from lagrotor.models.simulate import evolution_of, simulate, trajectory_of
from lagrotor.models.sweeps.batch_dop853 import Index, Rates, Swarm, march_swarm
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.error_estimate import EvaluationBudget, Evolution, Leg, estimate_runs, first_time
from lagrotor.numerics.integrate import check_engine, check_tolerance
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Array, StopError, Stretch
from lagrotor.numerics.taylor import march_lanes
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.result_display import Shown, scientific

CHUNK = 2048  # trajectories: an array of them is 16 KiB, and the arrays of one evaluation stay in the cache
MODELS = ("minimal", "spheres", "none")
# Three times the evaluations of motions far from singular positions at a tolerance of 1e-13.
_PATIENCE = EvaluationBudget(5_000, 250 * 2 * pi)
_MOST_ROWS = 4_000_000  # the most states of one batch, 200 MB


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Shown):
    """The trajectories of n scenes at m times.

    Attributes
    ----------
    scenes : tuple of Scene
        The scenes.
    t : Array
        The times, (m,), s.
    axes : Array
        The unit vectors of the axes, (n, 2, m, 3); NaN after the end of a run.
    rates : Array
        The rates of the axes, (n, 2, m, 3), 1/s; NaN after the end of a run.
    errors : Array
        The estimated largest error of an axis up to each time, (n, m); NaN after the end of a run.
    tol : float
        The tolerance.
    evaluations : Array
        The number of evaluations of each run, (n,).
    models : Array
        Indices into MODELS, (n,). "spheres" ran scenes without a bar or near a singular position. "none" means that
        the run reached no time.
    endings : tuple of Ending
        The reason for which each run ended.
    """

    scenes: tuple[Scene, ...]
    t: Array
    axes: Array
    rates: Array
    errors: Array
    tol: float
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]
    endings: tuple[Ending, ...]

    def summary(self) -> dict[str, str]:
        """Return the number of runs, their models and errors in words.

        Returns
        -------
        dict
            The rows of the table.
        """
        by_model = {name: int((self.models == i).sum()) for i, name in enumerate(MODELS)}
        return {
            "runs": str(len(self.scenes)),
            "times": f"{len(self.t)}, from {self.t[0]:g} to {self.t[-1]:g} s",
            "models": ", ".join(f"{count} by {name}" for name, count in by_model.items() if count),
            "evaluations": f"{int(self.evaluations.sum()):,}",
            "largest estimated error": scientific(float(np.nanmax(self.error, initial=0.0)), 1),
            "failed": str(len(self.failed)),
        }

    @property
    def error(self) -> Array:
        """The estimated largest error of an axis over each run, (n,); NaN for a run that ended early."""
        return self.errors[:, -1]

    @property
    def failed(self) -> NDArray[np.int64]:
        """The indices of the runs that ended early."""
        return np.flatnonzero([ending.early for ending in self.endings])

    def trajectory(self, i: int) -> Trajectory:
        """Return one run up to its end.

        Parameters
        ----------
        i : int
            The number of the scene.

        Returns
        -------
        Trajectory
            The run.
        """
        n = int(np.isfinite(self.errors[i]).sum())
        if not n:
            raise InputError(f"trajectory: the run of scene {i} reached no time: {self.endings[i]}")
        scene, errors, name = self.scenes[i], self.errors[i, :n], MODELS[self.models[i]]
        return Trajectory(
            scene=scene, model=name, why="one of an ensemble", t=self.t[:n], axes=self.axes[i, :, :n], rates=self.rates[i, :, :n],
            momenta=constant_momenta(scene, n), errors=errors, horizon=first_time(self.t[:n], errors > self.tol),
            evaluations=int(self.evaluations[i]), ending=self.endings[i],
        )  # fmt: skip


def sweep(
    scenes: Sequence[Scene], t: ArrayLike, tol: float = 1e-6, *, chunk: int = CHUNK, executor: Executor | None = None,
    engine: str = "core", progress: Callable[[int, int], None] | None = None,
) -> Ensemble:  # fmt: skip
    """Integrate every scene from its initial state, which holds at t[0].

    A LagrotorWarning gives the number of runs that do not keep `tol`. `Ensemble.failed` lists the runs that ended early.

    Parameters
    ----------
    scenes : sequence of Scene
        The scenes.
    t : array_like
        The increasing times (m,), s.
    tol : float, default 1e-6
        The largest error of an axis over each run, estimated as in `simulate`.
    chunk : int, default CHUNK
        The number of trajectories in a chunk.
    executor : Executor or None, optional
        An executor of `concurrent.futures`, for dask `client.get_executor()`. By default chunks run here in turn.
    engine : str, default "core"
        "core", or "fast" for heyoka (`pip install lagrotor[fast]`), without shocks.
    progress : callable or None, optional
        A function of the number of finished runs and the number of all runs, called after each chunk.

    Returns
    -------
    Ensemble
        The trajectories with their errors.

    Examples
    --------
    >>> from lagrotor import Scene, paired_scene
    >>> starts = [paired_scene(Scene(spins=(10, -10)), r0) for r0 in (0.1, 0.2)]
    >>> ensemble = sweep(starts, [0.0, 1.0, 2.0])
    >>> ensemble.axes.shape, (ensemble.error < 1e-6).all().item(), ensemble.trajectory(1).model
    ((2, 2, 3, 3), True, 'minimal')
    """
    times, tolerance, members = check_times("sweep", t), check_tolerance(tol, "sweep"), _checked(scenes, chunk, engine)
    if not (progress is None or callable(progress)):
        raise InputError(f"sweep: progress = {progress!r} must be a function of two numbers, or None")
    if not (executor is None or isinstance(executor, Executor)):
        way = "an executor of concurrent.futures; a dask client has one: client.get_executor()"
        raise InputError(f"sweep: executor = {executor!r} must be {way}")
    order = sorted(range(len(members)), key=lambda i: kind_of(members[i]) or (False, "", 0))  # equal kinds adjacent
    chunks = [order[i : i + chunk] for i in range(0, len(order), chunk)]
    whole, endings, finished = _not_run(members, times, tolerance), dict[int, Ending](), 0
    work = {number: ([members[i] for i in indices], times, tolerance, engine) for number, indices in enumerate(chunks)}
    for number, result in _run(work, executor):
        for name in ("axes", "rates", "errors", "evaluations", "models"):
            getattr(whole, name)[chunks[number]] = getattr(result, name)
        endings.update(zip(chunks[number], result.endings, strict=True))
        finished += len(chunks[number])
        if progress is not None:
            progress(finished, len(members))
    whole = replace(whole, endings=tuple(ending for _, ending in sorted(endings.items())))
    if missed := int((~(whole.error <= tolerance)).sum()):
        message = f"sweep: {missed} of {len(members)} runs do not keep tol = {tolerance:g}: see `error` of the result"
        warnings.warn(message, LagrotorWarning, stacklevel=2)
    return whole


def _not_run(scenes: Sequence[Scene], times: Array, tol: float) -> Ensemble:
    """Return the ensemble of scenes that were not run, with NaN in all arrays."""
    n, m = len(scenes), len(times)
    axes, rates = np.full((2, n, 2, m, 3), np.nan)
    none, evaluations = np.full(n, MODELS.index("none")), np.zeros(n, np.int64)
    return Ensemble(tuple(scenes), times, axes, rates, np.full((n, m), np.nan), tol, evaluations, none, (Ending(),) * n)


def _checked(scenes: Sequence[Scene], chunk: int, engine: str) -> tuple[Scene, ...]:
    members = tuple(scenes) if isinstance(scenes, Iterable) else ()
    if not members or not all(isinstance(scene, Scene) for scene in members):
        raise InputError("sweep: scenes must be a sequence of at least one Scene")
    if isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1:
        raise InputError(f"sweep: chunk = {chunk!r} must be a whole number above zero")
    check_engine(engine, "sweep")
    if engine == "fast" and any(scene.shock for scene in members):
        raise InputError("sweep: engine='fast' takes no shock: use engine='core'")
    return members


def _run(work: Mapping[int, tuple[Any, ...]], executor: Executor | None) -> Iterator[tuple[int, Ensemble]]:
    """Yield (number of the chunk, its ensemble) as the chunks are finished; without an executor they run in turn."""
    if executor is None:
        for number, arguments in work.items():
            yield number, run_chunk(*arguments)
        return
    futures = {executor.submit(run_chunk, *arguments): number for number, arguments in work.items()}
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        for future in futures:
            future.cancel()


@dataclass(frozen=True, eq=False)
class _Member:
    """A scene that the minimal model runs: its number, the scene in SI and in natural units, and its motion."""

    number: int
    scene: Scene
    units: NaturalUnits
    evolution: Evolution


def run_chunk(scenes: Sequence[Scene], times: Array, tol: float, engine: str) -> Ensemble:
    """Run some thousand scenes at once by `minimal`. The scenes that `minimal` cannot represent are run by `spheres`."""
    chunk, begin = _not_run(scenes, times, tol), float(times[0])
    scenes, times, endings = [scene.since(begin) for scene in scenes], times - begin, list(chunk.endings)
    groups: dict[Kind, list[_Member]] = {}
    for i, scene in enumerate(scenes):
        units = natural_units(replace(scene, shock=scene.shock_until(float(times[-1]))))
        try:
            if kind := kind_of(units.scene):
                check_range(MODEL, units.scene)
                end = float(times[-1] * units.rate)
                evolution = evolution_of(MODEL, units.scene, end, _PATIENCE, engine, bounded=True)
                groups.setdefault(kind, []).append(_Member(i, scene, units, evolution))
        except LagrotorError:  # badly conditioned at the start
            continue
    runs = dict[int, Trajectory]()
    for kind, members in groups.items():
        runs |= _by_minimal(kind, members, times, tol, engine, chunk.evaluations)
    for i, scene in enumerate(scenes):
        try:
            with warnings.catch_warnings():  # one warning for all follows
                warnings.simplefilter("ignore", LagrotorWarning)
                run = runs.get(i) or simulate(scene, times, "spheres", tol)
        except (IntegrationError, SingularError) as refusal:
            endings[i] = Ending("stopped", begin, str(refusal))
            continue
        reached = len(run.t)
        chunk.evaluations[i] += run.evaluations
        chunk.axes[i, :, :reached], chunk.rates[i, :, :reached] = run.axes, run.rates
        chunk.errors[i, :reached], chunk.models[i] = run.errors, MODELS.index(run.model)
        endings[i] = replace(run.ending, at=begin + run.ending.at)
    return replace(chunk, endings=tuple(endings))


def kind_of(scene: Scene) -> Kind | None:
    """Return the kind of program of the minimal model for a scene; None if the model cannot represent the scene."""
    if scene.link is None or max(abs(r[0]) for r in scene.axes) > 1 - 1e-12:
        return None
    return MODEL.kind(scene, True)[0]


def _by_minimal(
    kind: Kind, members: list[_Member], times: Array, tol: float, engine: str, evaluations: NDArray[np.int64]
) -> dict[int, Trajectory]:
    """Return {number of the scene: its run} for the scenes of one kind whose runs reach the end. The evaluations of the other
    runs are added to `evaluations` (n,)."""
    runs = dict[int, Trajectory]()
    rows = len(times) + max(65 + len(member.evolution.watch) for member in members)
    together = max(1, _MOST_ROWS // rows)
    for first in range(0, len(members), together):
        batch = members[first : first + together]
        scenes = [member.units.scene for member in batch]
        columns = np.array([MODEL.kind(scene, True)[1] for scene in scenes]).T
        swarm = _swarm(kind, scenes, columns)

        def integrate(
            legs: Mapping[int, Leg], columns: Array = columns, swarm: Swarm = swarm
        ) -> Mapping[int, Stretch | StopError]:
            return march_lanes(program(*kind), columns, legs) if engine == "fast" else march_swarm(swarm, legs)

        estimates = estimate_runs([m.evolution for m in batch], [times * m.units.rate for m in batch], tol, integrate)
        for member, run in zip(batch, estimates, strict=True):
            if isinstance(run, IntegrationError) or run.ending.early:
                evaluations[member.number] += run.evaluations
            else:
                run, units = run.by_clock(0.0, 1 / member.units.rate), member.units
                runs[member.number] = trajectory_of(member.scene, units, "minimal", "", times, run)
    return runs


def _swarm(kind: Kind, scenes: list[Scene], columns: Array) -> Swarm:
    """Return the scenes of one kind, which are in natural units, as problems to be integrated together."""
    body, function = kind[2], rhs_on_arrays(*kind)
    at, width, force = np.zeros(len(scenes)), np.zeros(len(scenes)), np.zeros((3, len(scenes)))
    if body:
        shocks = [scene.shock for scene in scenes if scene.shock]
        at, width = np.array([s.at for s in shocks]), np.array([s.width for s in shocks])
        force = np.array([s.force for s in shocks]).T

    def rates(who: Index) -> Rates:
        # Parameters that all share are scalars, whose products are cheap.
        parameters = [float(c[0]) if (c == c[0]).all() else c[who] for c in columns]
        push, broad = force[:, who], width[who]

        def into(s: Array, y: Array, out: Array) -> None:
            pulse = push * np.exp(-((s / broad) ** 2)) if body else ()
            for row, values in zip(out, function(*y, *parameters, *pulse), strict=True):
                row[:] = values

        return into

    return Swarm(rates, PACE, at, width)
