"""Many scenes at once: the minimal model on arrays, every trajectory with its own step, in chunks that a cache holds.

A chunk is one call of `run_chunk`, which needs nothing but its arguments: any executor of `concurrent.futures` can run
it, on this machine or on others.
"""

import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models.model import constant_momenta
from lagrotor.models.sweeps.chunk import MODELS, Array, Chunk, chunk_folder, kind_of, run_chunk
from lagrotor.numerics.any_run import Ending
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.estimated_run import first_time
from lagrotor.numerics.integrate import check_engine, check_tolerance
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.shown import Shown, scientific

CHUNK = 2048  # trajectories: an array of them is 16 KiB, and those that one evaluation needs stay in the cache


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Shown):
    """n trajectories at m times t (m,) in s: axes, rates (n, 2, m, 3), errors (n, m), evaluations (n,).

    models (n,): index into MODELS. "spheres" ran, one by one, those without a bar and those that met a singular position
    of the minimal coordinates; "none" is one of which nothing was reached. endings (n,): how each ended; after its end its axes,
    rates and errors are NaN.

    Attributes:
        errors: the estimated largest error of an axis up to each time, as a `Trajectory` has it.
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
        """How many runs, by which models, name → words."""
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
        """The estimated largest error of an axis over each run, (n,); NaN for one that ended early."""
        return self.errors[:, -1]

    @property
    def failed(self) -> NDArray[np.int64]:
        """Indices of the trajectories that ended early."""
        return np.flatnonzero([ending.early for ending in self.endings])

    def trajectory(self, i: int) -> Trajectory:
        """Number i up to its end, with all that can be read off it.

        Raises:
            InputError: where nothing of it was reached.
        """
        n = int(np.isfinite(self.errors[i]).sum())
        if not n:
            raise InputError(f"trajectory: of scene {i} nothing was reached: {self.endings[i]}")
        scene, errors, name = self.scenes[i], self.errors[i, :n], MODELS[self.models[i]]
        return Trajectory(
            scene=scene, model=name, why="one of an ensemble", t=self.t[:n], axes=self.axes[i, :, :n], rates=self.rates[i, :, :n],
            momenta=constant_momenta(scene, n), errors=errors, horizon=first_time(self.t[:n], errors > self.tol),
            evaluations=int(self.evaluations[i]), ending=self.endings[i],
        )  # fmt: skip


def sweep(
    scenes: Sequence[Scene],
    t: ArrayLike,
    tol: float = 1e-6,
    *,
    chunk: int = CHUNK,
    executor: Executor | None = None,
    engine: str = "core",
    folder: str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Ensemble:
    """Run every scene from its start, which holds at t[0], and read it at the times `t` (m,) in s.

    Args:
        scenes: as many as there are runs.
        tol: the largest error of an axis over each whole run, as of `simulate` and by the same estimate. A LagrotorWarning says
            how many runs do not keep it. Look at `failed` of the result: rows that ended early are NaN from there on.
        engine: "core", or "fast" with heyoka (`pip install lagrotor[fast]`), which takes no shock.
        chunk: trajectories at a time.
        executor: where chunks run; here, one after another, when None.
        folder: an existing folder for the finished chunks; a later sweep with the same arguments runs only those that are missing
            or damaged.
        progress: called with the number of trajectories done and of all, after each chunk.

    Raises:
        InputError: for bad arguments, no scene, or a folder with a chunk of another sweep.
    """
    times, tolerance, members = check_times("sweep", t), check_tolerance(tol), _checked(scenes, chunk, engine)
    order = sorted(range(len(members)), key=lambda i: kind_of(members[i]) or (False, "", 0))  # alike beside alike
    parts = [order[i : i + chunk] for i in range(0, len(order), chunk)]
    target = None if folder is None else chunk_folder(folder, members, times, tolerance, chunk, engine)
    shape = (len(members), 2, len(times), 3)
    (axes, rates), errors = np.empty((2, *shape)), np.empty((len(members), len(times)))
    evaluations, models = np.zeros((2, len(members)), np.int64)
    endings = [Ending()] * len(members)
    done, begin = 0, float(times[0])

    def keep(number: int, result: Chunk) -> None:
        nonlocal done
        for values, part in zip((axes, rates, errors, evaluations, models), result[:-1], strict=True):
            values[parts[number]] = part
        for i, ending in zip(parts[number], result.endings, strict=True):
            endings[i] = replace(ending, at=begin + ending.at)
        done += len(parts[number])
        if progress is not None:
            progress(done, len(members))

    work: dict[int, tuple[list[Scene], Array, float, str]] = {}
    for number, part in enumerate(parts):
        if target and (stored := target.read(number, (len(part), *shape[1:]))):
            keep(number, stored)
        else:
            work[number] = [members[i].since(begin) for i in part], times - begin, tolerance, engine
    for number, result in _run(work, executor):
        if target:
            target.write(number, result)
        keep(number, result)
    whole = Ensemble(members, times, axes, rates, errors, tolerance, evaluations, models, tuple(endings))
    if missed := int((~(whole.error <= tolerance)).sum()):
        said = f"sweep: {missed} of {len(members)} runs do not keep tol = {tolerance:g}: see `error` of the result"
        warnings.warn(said, LagrotorWarning, stacklevel=2)
    return whole


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


def _run(work: Mapping[int, tuple[Any, ...]], executor: Executor | None) -> Iterator[tuple[int, Chunk]]:
    """Chunks with their numbers, as they are finished; here, one after another, without an executor."""
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
