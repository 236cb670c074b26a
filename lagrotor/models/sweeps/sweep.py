"""`sweep`: many scenes at once, on one machine or on many, in memory or in a folder."""

import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import fields
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.files import path_of
from lagrotor.models.sweeps.chunk import CHUNK, run_chunk
from lagrotor.models.sweeps.column_names import is_table, scenes_of_table
from lagrotor.models.sweeps.ensemble import Ensemble
from lagrotor.models.sweeps.executors import check_executor, completed, pool_of
from lagrotor.models.sweeps.scene_columns import LazyScenes, SceneColumns
from lagrotor.models.sweeps.sweep_folder import FolderStore, MemoryStore, chunk_of, digest, inputs_of
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.integrate import check_engine, check_tolerance
from lagrotor.pair.scene import Scene

_SCENES = "a sequence of at least one Scene, a table with one row per scene, or an iterator of chunks of these"


def sweep(
    scenes: Any, t: ArrayLike, tol: float = 1e-6, *, chunk: int | None = None, folder: str | Path | None = None,
    executor: Any = None, engine: str = "core", progress: Callable[[int, int | None], None] | None = None,
) -> Ensemble:  # fmt: skip
    """Integrate every scene from its initial state, which holds at t[0].

    The same arguments give the same bits with every executor on equal processors. A LagrotorWarning gives the number of runs that
    do not keep `tol`. `Ensemble.failed` lists the runs that ended early.

    Parameters
    ----------
    scenes : sequence of Scene, mapping, DataFrame or iterator
        The scenes. A table has one row per scene. Its columns are named like the fields of `Scene`: `spins` (n, 2), `axes` and
        `rates` (n, 2, 3), or `spins_1`, `axes_1x`, `rates_2z`, `rotor_mass`, `link_length`, `shock_force_x`, `shock_at`. A number
        alone holds for all scenes, a missing column has the default of `Scene`, and `link_length` NaN means no bar. An iterator
        yields chunks, each a sequence of scenes or a table, of which only some are in memory.
    t : array_like
        The increasing times (m,), s.
    tol : float, default 1e-6
        The largest error of an axis over each run, estimated as in `simulate`.
    chunk : int or None, optional
        The number of trajectories in a chunk. By default it is at most CHUNK, and small enough for all workers to have a part.
    folder : str, Path or None, optional
        A folder for the results, which are written chunk by chunk. The same call goes on where an interrupted sweep ended. By
        default the results stay in memory.
    executor : Executor, dask Client, "processes" or None, optional
        An executor of `concurrent.futures`, a client of dask, or "processes" for all cores of this machine. By default chunks run
        here in turn.
    engine : str, default "core"
        "core", or "fast" for heyoka (`pip install lagrotor[fast]`), without shocks.
    progress : callable or None, optional
        A function of the number of finished runs and the number of all runs, called after each chunk. The second is None for an
        iterator.

    Returns
    -------
    Ensemble or Sweep
        The trajectories with their errors. With `folder` it is a Sweep, whose arrays are memory maps.

    Raises
    ------
    InputError
        If a scene is invalid, or the folder has another sweep.
    IntegrationError
        If the workers of the executor are lost.

    Examples
    --------
    >>> from lagrotor import Scene, paired_scene
    >>> starts = [paired_scene(Scene(spins=(10, -10)), r0) for r0 in (0.1, 0.2)]
    >>> ensemble = sweep(starts, [0.0, 1.0, 2.0])
    >>> ensemble.axes.shape, (ensemble.error < 1e-6).all().item(), ensemble.trajectory(1).model
    ((2, 2, 3, 3), True, 'minimal')
    >>> table = {"spins_1": [5.0, 10.0, 15.0], "spins_2": -10.0, "rates": ((0, 0.1, 0), (0, 0.1, 0))}
    >>> sweep(table, [0.0, 1.0]).axes.shape
    (3, 2, 2, 3)
    """
    times, tolerance = check_times("sweep", t), check_tolerance(tol, "sweep")
    if chunk is not None and (isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1):
        raise InputError(f"sweep: chunk = {chunk!r} must be a whole number above zero")
    check_engine(engine, "sweep")
    check_executor(executor)
    if not (progress is None or callable(progress)):
        raise InputError(f"sweep: progress = {progress!r} must be a function of two numbers, or None")
    blocks = _blocks(scenes, chunk or CHUNK, engine)
    whole = None if isinstance(scenes, Iterator) else _joined(list(blocks))
    runs, finished, last = None if whole is None else len(whole), 0, 0

    def advance(n: int) -> None:
        nonlocal finished
        finished += n
        if progress is not None:
            progress(finished, runs)

    def tasks() -> Iterator[tuple[tuple[int, SceneColumns], tuple[Any, ...]]]:
        nonlocal last
        for first, part in _parts(blocks if whole is None else [whole], size):
            last = first + len(part)
            if store.holds(first, part):
                advance(len(part))
            else:
                yield (first, part), (part, times, tolerance, engine)

    with pool_of(executor) as pool:
        size = chunk or (CHUNK if runs is None else min(CHUNK, ceil(runs / pool.workers())))
        store: FolderStore | MemoryStore
        if folder is None:
            store = MemoryStore(times, tolerance)
        else:
            target = path_of("sweep: folder", folder)
            size = chunk or chunk_of(target) or size  # as it began, though there may be more workers now
            about = {"t": times.tolist(), "tol": tolerance, "engine": engine, "chunk": size, "runs": runs}
            store = FolderStore(target, about | {"scenes": whole and digest(inputs_of(whole))})
        with closing(store):
            for (first, part), result in completed(run_chunk, tasks(), pool):
                store.write(first, part, result)
                advance(len(part))
            if not last:
                raise InputError(f"sweep: the iterator has no chunk: scenes must be {_SCENES}")
            ensemble = store.result(last)
    if missed := int((~(ensemble.error <= tolerance)).sum()):
        message = f"sweep: {missed} of {last} runs do not keep tol = {tolerance:g}: see `error` of the result"
        warnings.warn(message, LagrotorWarning, stacklevel=2)
    return ensemble


def _blocks(scenes: Any, chunk: int, engine: str) -> Iterator[SceneColumns]:
    """Yield the scenes as columns, checked."""
    first, scenes = 0, scenes.columns if isinstance(scenes, LazyScenes) else scenes
    for item in _chunks([scenes] if isinstance(scenes, SceneColumns) or is_table(scenes) else scenes, chunk):
        if isinstance(item, SceneColumns):
            block = item
        elif is_table(item):
            block = scenes_of_table(item)
        elif isinstance(item, list | tuple) and item and all(isinstance(scene, Scene) for scene in item):
            block = SceneColumns.of_scenes(item)
        else:
            raise InputError(f"sweep: scenes must be {_SCENES}, not {item!r:.60}")
        block.check(first)
        if engine == "fast" and block.shocked.any():
            raise InputError("sweep: engine='fast' takes no shock: use engine='core'")
        first += len(block)
        yield block


def _chunks(scenes: Any, chunk: int) -> Iterator[Any]:
    """Yield the items of an iterable. Single scenes are collected into lists."""
    if not isinstance(scenes, Iterable) or isinstance(scenes, str):
        raise InputError(f"sweep: scenes must be {_SCENES}, not {scenes!r:.60}")
    single = list[Scene]()
    for item in scenes:
        if isinstance(item, Scene):
            single.append(item)
        if single and (len(single) == chunk or not isinstance(item, Scene)):
            yield single
            single = []
        if not isinstance(item, Scene):
            yield item
    if single:
        yield single


def _joined(blocks: Sequence[SceneColumns]) -> SceneColumns:
    if not blocks:
        raise InputError(f"sweep: scenes must be {_SCENES}")
    return SceneColumns(*(np.concatenate([getattr(b, f.name) for b in blocks]) for f in fields(SceneColumns)))


def _parts(blocks: Iterable[SceneColumns], chunk: int) -> Iterator[tuple[int, SceneColumns]]:
    """Yield (number of the first scene, scenes) for chunks of at most `chunk` scenes."""
    first = 0
    for block in blocks:
        for start in range(0, len(block), chunk):
            yield first + start, block.take(np.arange(start, min(start + chunk, len(block))))
        first += len(block)
