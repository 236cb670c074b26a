"""Many scenes at once: the minimal model on arrays, every trajectory with its own step, in chunks that a cache holds.

A chunk is one call of `run_chunk`, which needs nothing but its arguments: any executor of `concurrent.futures` can run
it, on this machine or on others.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass, replace
from functools import lru_cache
from hashlib import sha256
from math import hypot
from pathlib import Path
from typing import NamedTuple
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError, IntegrationError
from lagrotor.files import write_beside, write_text
from lagrotor.models.minimal import MODEL
from lagrotor.models.minimal_program import Ratio, program
from lagrotor.models.simulate import check_times, simulate
from lagrotor.numerics.batch_dop853 import Index, Rates, Swarm, march
from lagrotor.numerics.codegen import compile_program
from lagrotor.numerics.integrate import TIGHTEST, check_tolerance
from lagrotor.numerics.taylor import march_taylor
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory

Array = NDArray[np.float64]
Kind = tuple[bool, Ratio, int]  # massive bar, ell against R, shocked rotor (0: none)

CHUNK = 2048  # trajectories: an array of them is 16 KiB, and those that one evaluation needs stay in the cache
MODELS = ("minimal", "spheres", "none")


class Chunk(NamedTuple):
    """axes, rates (n, 2, m, 3), evaluations (n,), models (n,) of part of an ensemble."""

    axes: Array
    rates: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Ensemble:
    """n trajectories at m times t (m,) in s: axes, rates (n, 2, m, 3), evaluations (n,).

    models (n,): index into MODELS. "spheres" ran, one by one, those without a bar and those that met a singular position
    of the minimal coordinates; what neither could finish is "none", its axes NaN.
    """

    scenes: tuple[Scene, ...]
    t: Array
    axes: Array
    rates: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]

    @property
    def failed(self) -> NDArray[np.int64]:
        """Indices of the trajectories that no model could finish: theirs are NaN throughout."""
        return np.flatnonzero(self.models == MODELS.index("none"))

    def trajectory(self, i: int) -> Trajectory:
        """Number i, with all that can be read off it."""
        scene, name = self.scenes[i], MODELS[self.models[i]]
        momenta = np.repeat(np.array(scene.momenta)[:, None], len(self.t), axis=1)
        spent = int(self.evaluations[i])
        return Trajectory(scene, name, "one of an ensemble", self.t, self.axes[i], self.rates[i], momenta, spent)


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
    """Run every scene from t = 0 and read it at the times `t` (m,) in s.

    tol: local relative and absolute error, as of `simulate` with a model by name; what gathers over the run is more, by
    about ten for small motions. Look at `failed` of the result: rows of what no model could finish are NaN.

    engine: "core", or "fast" with heyoka (`pip install lagrotor[fast]`), which takes no shock. chunk: trajectories at a
    time. executor: where chunks run; here, one after another, when None. folder: an existing
    folder into which each finished chunk is written whole; called again with the same arguments, the sweep takes what
    is there and goes on. progress: called with the trajectories done and how many there are, after each chunk.

    A step ends at each asked time: a few times cost little, a thousand a good deal.
    Raises InputError for bad arguments, no scene, or a folder that holds another sweep.
    """
    times, tolerance = check_times(t), check_tolerance(tol)
    members = tuple(scenes) if isinstance(scenes, Iterable) else ()
    if not members or not all(isinstance(scene, Scene) for scene in members):
        raise InputError("sweep: scenes must be a sequence of at least one Scene")
    if isinstance(chunk, bool) or not isinstance(chunk, int) or chunk < 1:
        raise InputError(f"sweep: chunk = {chunk!r} must be a whole number above zero")
    if engine not in ("core", "fast"):
        raise InputError(f"sweep: engine = {engine!r} is neither core nor fast")
    if engine == "fast" and any(scene.shock for scene in members):
        raise InputError("sweep: engine='fast' takes no shock: use engine='core'")
    order = sorted(range(len(members)), key=lambda i: _kind(members[i]) or (False, "", 0))  # alike beside alike
    parts = [order[i : i + chunk] for i in range(0, len(order), chunk)]
    target = None if folder is None else _own(Path(folder), repr((members, times.tolist(), tolerance, chunk, engine)))
    shape, none = (len(members), 2, len(times), 3), np.zeros(len(members), np.int64)
    whole = Ensemble(members, times, np.empty(shape), np.empty(shape), none, none.copy())
    done = 0

    def keep(number: int, found: Chunk, new: bool) -> None:
        nonlocal done
        if new and target is not None:
            _write(_file(target, number), found)
        for name, values in found._asdict().items():
            getattr(whole, name)[parts[number]] = values
        done += len(parts[number])
        if progress is not None:
            progress(done, len(members))

    waiting = list(range(len(parts)))
    if target is not None:
        for number in list(waiting):
            if (found := _read(_file(target, number))) is not None:
                keep(number, found, False)
                waiting.remove(number)
    tasks = {number: [members[i] for i in parts[number]] for number in waiting}
    if executor is None:
        for number, part in tasks.items():
            keep(number, run_chunk(part, times, tolerance, engine), True)
        return whole
    futures = {executor.submit(run_chunk, part, times, tolerance, engine): number for number, part in tasks.items()}
    try:
        for future in as_completed(futures):
            keep(futures[future], future.result(), True)
    finally:
        for future in futures:
            future.cancel()
    return whole


def started(scene: Scene, states: ArrayLike) -> list[Scene]:
    """`scene` started from each of the minimal model's states (n, 6): U, chi, alpha and their rates (1/s).

    Every state of the minimal model is on the bar, so no start needs to be brought onto it.
    Raises InputError for states that are not finite or of another shape, SingularError without a bar.
    """
    table = np.asarray(states, dtype=float)
    if table.ndim != 2 or table.shape[1] != 6 or not np.isfinite(table).all():
        raise InputError(f"started: states of shape {table.shape} must be finite and of shape (n, 6)")
    seen = MODEL.observe(scene, table)
    axes, rates = (part.swapaxes(0, 1).tolist() for part in (seen.axes, seen.rates))
    return [replace(scene, axes=r, rates=v) for r, v in zip(axes, rates, strict=True)]


def run_chunk(scenes: Sequence[Scene], times: Array, tol: float, engine: str) -> Chunk:
    """The work of one process: a few thousand scenes at once by `minimal`, those that it cannot hold by `spheres`."""
    n, shape = len(scenes), (len(scenes), 2, len(times), 3)
    found = Chunk(np.full(shape, np.nan), np.full(shape, np.nan), np.zeros(n, np.int64), np.full(n, 2))
    groups: dict[Kind | None, list[int]] = {}
    for i, scene in enumerate(scenes):
        groups.setdefault(_kind(scene), []).append(i)
    for kind, group in groups.items():
        if kind is not None:
            _by_minimal(kind, [scenes[i] for i in group], np.array(group), times, tol, engine, found)
    for i in np.flatnonzero(found.models == MODELS.index("none")).tolist():
        # Beside a singular position any error grows a millionfold: the solver gives all it has.
        try:
            run = simulate(scenes[i], times, "spheres", TIGHTEST if scenes[i].link else tol)
        except IntegrationError:
            continue
        found.axes[i], found.rates[i], found.models[i] = run.axes, run.rates, MODELS.index("spheres")
        found.evaluations[i] += run.evaluations
    return found


def _kind(scene: Scene) -> Kind | None:
    """Which program runs the scene; None where the minimal model has no coordinates for it."""
    if scene.link is None or max(abs(r[0]) for r in scene.axes) > 1 - 1e-12:
        return None
    k = scene.link.length / scene.rotor.length
    ratio: Ratio = "equal" if k == 1 else "short" if k < 1 else "long"
    return scene.inertias[1] != 0, ratio, scene.shock.body if scene.shock else 0


@lru_cache(maxsize=32)
def _compiled(kind: Kind) -> Callable[..., list[Array]]:
    return compile_program(program(*kind), "numpy")


def _by_minimal(
    kind: Kind, scenes: list[Scene], places: Index, times: Array, tol: float, engine: str, found: Chunk
) -> None:
    """Run scenes of one kind side by side and put what comes out whole into its places."""
    ratios = np.array([scene.link.length / scene.rotor.length for scene in scenes if scene.link])
    columns, start = _columns(kind, scenes, ratios), np.array([MODEL.start(scene) for scene in scenes]).T.copy()
    if engine == "fast":
        states, spent = march_taylor(program(*kind), start, np.array(columns), times, tol)
    else:
        states, spent = march(_swarm(kind, scenes, columns, start), times, tol)
    found.evaluations[places] = spent
    whole = np.isfinite(states).all((1, 2))
    found.models[places[whole]] = MODELS.index("minimal")
    for k in np.unique(ratios):
        alike = np.flatnonzero(whole & (ratios == k))
        if len(alike):
            seen = MODEL.observe(scenes[alike[0]], states[alike].reshape(-1, 6))
            for name, part in (("axes", seen.axes), ("rates", seen.rates)):
                rows = part.reshape(2, len(alike), len(times), 3).swapaxes(0, 1)
                getattr(found, name)[places[alike]] = rows


def _columns(kind: Kind, scenes: list[Scene], ratios: Array) -> list[Array]:
    """The program's parameters but for the force, each for all scenes (n,)."""
    massive, ratio, _ = kind
    inertias = np.array([scene.inertias for scene in scenes])
    momenta = np.array([scene.momenta for scene in scenes])
    columns = [inertias[:, 0], *([inertias[:, 1]] if massive else []), *([] if ratio == "equal" else [ratios])]
    return [*columns, momenta[:, 0], momenta[:, 1]]


def _swarm(kind: Kind, scenes: list[Scene], columns: list[Array], start: Array) -> Swarm:
    """The scenes of one kind as arrays."""
    body, function = kind[2], _compiled(kind)
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
    return Swarm(rates, start, fastest, 20_000 + 500 * fastest, at, width)


def _fastest(scene: Scene) -> float:
    """A rate (rad/s) that the motion does not exceed by much: spins, start and shock against the tilting inertia."""
    shock = hypot(*scene.shock.impulse) * scene.rotor.length if scene.shock else 0.0
    spin = abs(scene.momenta[0]) + abs(scene.momenta[1])
    return 1 + (spin + shock) / scene.rotor.J + hypot(*scene.rates[0]) + hypot(*scene.rates[1])


def _own(folder: Path, arguments: str) -> Path:
    """The folder, marked as that of the sweep with these arguments. Raises InputError where it is another's."""
    if not folder.is_dir():
        raise InputError(f"sweep: there is no folder {folder}: make it first")
    mark, digest = folder / "sweep.txt", sha256(arguments.encode()).hexdigest()
    if not mark.exists():
        write_text(mark, digest + "\n")
    elif mark.read_text().strip() != digest:
        raise InputError(
            f"sweep: {folder} holds another sweep (scenes, times, tol, chunk or engine differ): give an empty one"
        )
    return folder


def _file(folder: Path, number: int) -> Path:
    return folder / f"chunk-{number:06d}.npz"


def _write(target: Path, found: Chunk) -> None:
    write_beside(target, lambda file: np.savez(file, **found._asdict()))


def _read(target: Path) -> Chunk | None:
    """A finished chunk; None where there is none, or a damaged one, which is then run again."""
    try:
        with np.load(target) as stored:
            return Chunk(**stored)
    except (OSError, ValueError, TypeError, EOFError, BadZipFile):
        return None
