"""Scenes of one kind side by side: the minimal model on arrays, every trajectory with its own step, each held to the contract
of runs as it is alone; finished ones in a folder, where each file says which sweep it belongs to and is checked before use."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from hashlib import sha256
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrotor.about import __version__
from lagrotor.errors import InputError, IntegrationError, LagrotorError, LagrotorWarning, SingularError
from lagrotor.files import read_arrays, write_arrays
from lagrotor.models.minimal import MODEL, Kind, program, rhs_on_arrays
from lagrotor.models.model import PACE, NaturalUnits, check_range, natural_units
from lagrotor.models.simulate import evolution_of, simulate, trajectory_of
from lagrotor.models.sweeps.batch_dop853 import Index, Rates, Swarm, march_swarm
from lagrotor.numerics.any_run import Ending
from lagrotor.numerics.estimated_run import Evolution, Leg, Patience, estimate_runs
from lagrotor.numerics.segment import StopError, Stretch
from lagrotor.numerics.taylor import march_lanes
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import UNIT_ERROR, Trajectory

Array = NDArray[np.float64]
MODELS = ("minimal", "spheres", "none")
# Three times what motions take at a tolerance of 1e-13 that stay clear of singular positions.
_PATIENCE = Patience(5_000, 250 * 2 * pi)
_MOST_ROWS = 4_000_000  # states of all that are run side by side, at the times at which they are watched: 200 MB


class Chunk(NamedTuple):
    """axes, rates (n, 2, m, 3), errors (n, m), evaluations (n,), models (n,) of part of an ensemble, NaN after what was reached;
    how each of its runs ended."""

    axes: Array
    rates: Array
    errors: Array
    evaluations: NDArray[np.int64]
    models: NDArray[np.int64]
    endings: list[Ending]


@dataclass(frozen=True, eq=False)
class _Member:
    """A scene that the minimal model can hold, in its own units."""

    number: int
    scene: Scene
    units: NaturalUnits
    evolution: Evolution


def run_chunk(scenes: Sequence[Scene], times: Array, tol: float, engine: str) -> Chunk:
    """The work of one process: a few thousand scenes at once by `minimal`, those that it cannot hold by `spheres`.

    Each scene starts at times[0] = 0. Every run is within `tol` by its estimate, or has the best there is.
    """
    n, m = len(scenes), len(times)
    axes, rates = np.full((2, n, 2, m, 3), np.nan)
    none = np.full(n, MODELS.index("none"))
    chunk = Chunk(axes, rates, np.full((n, m), np.nan), np.zeros(n, np.int64), none, [Ending()] * n)
    groups: dict[Kind, list[_Member]] = {}
    for i, scene in enumerate(scenes):
        units = natural_units(replace(scene, shock=scene.shock_until(float(times[-1]))))
        try:
            if kind := kind_of(units.scene):
                check_range(MODEL, units.scene)
                end = float(times[-1] * units.rate)
                evolution = evolution_of(MODEL, units.scene, end, _PATIENCE, engine, bounded=True)
                evolution = replace(evolution, independent=units.scene.shock is None)
                groups.setdefault(kind, []).append(_Member(i, scene, units, evolution))
        except LagrotorError:  # badly conditioned at the start
            continue
    runs = dict[int, Trajectory]()
    for kind, members in groups.items():
        runs |= _by_minimal(kind, members, times, tol, engine, chunk.evaluations)
    for i, scene in enumerate(scenes):
        try:
            run = runs.get(i) or _alone(scene, times, tol)
        except (IntegrationError, SingularError) as refusal:
            chunk.endings[i] = Ending("stopped", 0.0, str(refusal))
            continue
        reached = len(run.t)
        chunk.evaluations[i] += run.evaluations
        chunk.axes[i, :, :reached], chunk.rates[i, :, :reached] = run.axes, run.rates
        chunk.errors[i, :reached], chunk.endings[i] = run.errors, run.ending
        chunk.models[i] = MODELS.index(run.model)
    return chunk


def _alone(scene: Scene, times: Array, tol: float) -> Trajectory:
    with warnings.catch_warnings():  # what is not kept is said once for all
        warnings.simplefilter("ignore", LagrotorWarning)
        return simulate(scene, times, "spheres", tol)


def kind_of(scene: Scene) -> Kind | None:
    """Which program runs the scene; None where the minimal model has no coordinates for it."""
    if scene.link is None or max(abs(r[0]) for r in scene.axes) > 1 - 1e-12:
        return None
    return MODEL.kind(scene, True)[0]


def _by_minimal(
    kind: Kind, members: list[_Member], times: Array, tol: float, engine: str, evaluations: NDArray[np.int64]
) -> dict[int, Trajectory]:
    """The runs of scenes of one kind that reach their end, by number; `evaluations` (n,) is given what the others took."""
    runs = dict[int, Trajectory]()
    rows = len(times) + max(65 + len(member.evolution.watch) for member in members)
    together = max(1, _MOST_ROWS // rows)
    for first in range(0, len(members), together):
        part = members[first : first + together]
        scenes = [member.units.scene for member in part]
        columns = np.array([MODEL.kind(scene, True)[1] for scene in scenes]).T
        swarm = _swarm(kind, scenes, columns)

        def integrate(
            legs: Mapping[int, Leg], columns: Array = columns, swarm: Swarm = swarm
        ) -> Mapping[int, Stretch | StopError]:
            return march_lanes(program(*kind), columns, legs) if engine == "fast" else march_swarm(swarm, legs)

        estimates = estimate_runs(
            [one.evolution for one in part], [times * one.units.rate for one in part], tol, integrate
        )
        for member, run in zip(part, estimates, strict=True):
            if isinstance(run, IntegrationError) or run.ending.early:
                evaluations[member.number] += run.evaluations
            else:
                run, units = run.by_clock(0.0, 1 / member.units.rate), member.units
                runs[member.number] = trajectory_of(member.scene, units, "minimal", "", times, run)
    return runs


def _swarm(kind: Kind, scenes: list[Scene], columns: Array) -> Swarm:
    """The scenes of one kind, in natural units, as arrays."""
    body, function = kind[2], rhs_on_arrays(*kind)
    at, width, force = np.zeros(len(scenes)), np.zeros(len(scenes)), np.zeros((3, len(scenes)))
    if body:
        shocks = [scene.shock for scene in scenes if scene.shock]
        at, width = np.array([s.at for s in shocks]), np.array([s.width for s in shocks])
        force = np.array([s.force for s in shocks]).T

    def rates(who: Index) -> Rates:
        # What all share goes in as a number: numbers among themselves cost nothing beside arrays.
        given = [float(c[0]) if (c == c[0]).all() else c[who] for c in columns]
        push, broad = force[:, who], width[who]

        def into(s: Array, y: Array, out: Array) -> None:
            pulse = push * np.exp(-((s / broad) ** 2)) if body else ()
            for row, values in zip(out, function(*y, *given, *pulse), strict=True):
                row[:] = values

        return into

    return Swarm(rates, PACE, at, width)


@dataclass(frozen=True)
class ChunkFolder:
    """The chunks of one sweep; `sweep` is the digest of its scenes, times, tolerance, chunk size, engine and version."""

    path: Path
    sweep: str

    def file(self, number: int) -> Path:
        return self.path / f"chunk-{number:06d}.npz"

    def write(self, number: int, chunk: Chunk) -> None:
        arrays = chunk._asdict()
        endings = [asdict(ending) for ending in arrays.pop("endings")]
        write_arrays(self.file(number), {"sweep": self.sweep, "chunk": number, "endings": endings}, arrays)

    def read(self, number: int, shape: tuple[int, ...]) -> Chunk | None:
        """A finished chunk of this shape; None where there is none or a damaged one, which is run again.

        Raises InputError for a chunk of another sweep.
        """
        if not self.file(number).exists():
            return None
        try:
            about, held = read_arrays(self.file(number))
        except InputError:
            return None
        if about.get("sweep") != self.sweep:
            raise InputError(
                f"sweep: {self.file(number)} belongs to another sweep (scenes, times, tol, chunk, engine or version "
                "differ): give an empty folder"
            )
        try:
            chunk = Chunk(**held, endings=[Ending(**ending) for ending in about["endings"]])
        except (KeyError, TypeError, InputError):
            return None
        return chunk if about.get("chunk") == number and _is_whole(chunk, shape) else None


def chunk_folder(
    folder: str | Path, scenes: Sequence[Scene], times: Array, tol: float, chunk: int, engine: str
) -> ChunkFolder:
    """The folder of this sweep. Raises InputError where there is none, or where it holds chunks of another sweep."""
    path = Path(folder)
    if not path.is_dir():
        raise InputError(f"sweep: there is no folder {path}: make it first")
    arguments = repr((tuple(scenes), times.tolist(), tol, chunk, engine, __version__))
    return ChunkFolder(path, sha256(arguments.encode()).hexdigest())


def _is_whole(chunk: Chunk, shape: tuple[int, ...]) -> bool:
    """Whether the arrays are those of a chunk of this shape: finite motions of unit axes, NaN only after one that ended early."""
    n, m = shape[0], shape[2]
    arrays, wanted = chunk[:-1], (shape, shape, (n, m), (n,), (n,))
    if any(part.shape != s for part, s in zip(arrays, wanted, strict=True)) or len(chunk.endings) != n:
        return False
    if any(part.dtype != kind for part, kind in zip(arrays, (float, float, float, np.int64, np.int64), strict=True)):
        return False
    done = np.isfinite(chunk.errors)
    early = np.array([ending.early for ending in chunk.endings])
    return bool(
        ((chunk.models >= 0) & (chunk.models < len(MODELS)) & (chunk.evaluations >= 0)).all()
        and (done.all(1) | early).all()
        and (done[:, :-1] >= done[:, 1:]).all()
        and all((np.isfinite(part).all((1, 3)) == done).all() for part in (chunk.axes, chunk.rates))
        and (chunk.errors[done] >= 0).all()
        and (np.abs(np.linalg.norm(chunk.axes, axis=-1) - 1) < UNIT_ERROR)[np.repeat(done[:, None], 2, axis=1)].all()
    )
