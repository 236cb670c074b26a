"""Finished chunks of a sweep in a folder: each file says which sweep it belongs to and is checked whole before use."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path

import numpy as np

from lagrotor.about import __version__
from lagrotor.errors import InputError
from lagrotor.files import read_arrays, write_arrays
from lagrotor.models.sweeps.chunk import MODELS, Array, Chunk
from lagrotor.numerics.any_run import Ending
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import UNIT_ERROR


@dataclass(frozen=True)
class ChunkFolder:
    """The chunks of one sweep; `sweep` is the digest of its scenes, times, tolerance, chunk size, engine and version."""

    path: Path
    sweep: str

    def file(self, number: int) -> Path:
        return self.path / f"chunk-{number:06d}.npz"

    def write(self, number: int, found: Chunk) -> None:
        arrays = found._asdict()
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
            found = Chunk(**held, endings=[Ending(**ending) for ending in about["endings"]])
        except (KeyError, TypeError, InputError):
            return None
        return found if about.get("chunk") == number and _is_whole(found, shape) else None


def chunk_folder(
    folder: str | Path, scenes: Sequence[Scene], times: Array, tol: float, chunk: int, engine: str
) -> ChunkFolder:
    """The folder of this sweep. Raises InputError where there is none, or where it holds chunks of another sweep."""
    path = Path(folder)
    if not path.is_dir():
        raise InputError(f"sweep: there is no folder {path}: make it first")
    arguments = repr((tuple(scenes), times.tolist(), tol, chunk, engine, __version__))
    return ChunkFolder(path, sha256(arguments.encode()).hexdigest())


def _is_whole(found: Chunk, shape: tuple[int, ...]) -> bool:
    """Whether the arrays are those of a chunk of this shape: finite motions of unit axes, NaN only after one that ended early."""
    n, m = shape[0], shape[2]
    arrays, wanted = found[:-1], (shape, shape, (n, m), (n,), (n,))
    if any(part.shape != s for part, s in zip(arrays, wanted, strict=True)) or len(found.endings) != n:
        return False
    if any(part.dtype != kind for part, kind in zip(arrays, (float, float, float, np.int64, np.int64), strict=True)):
        return False
    done = np.isfinite(found.errors)
    early = np.array([ending.early for ending in found.endings])
    return bool(
        ((found.models >= 0) & (found.models < len(MODELS)) & (found.evaluations >= 0)).all()
        and (done.all(1) | early).all()
        and (done[:, :-1] >= done[:, 1:]).all()
        and all((np.isfinite(part).all((1, 3)) == done).all() for part in (found.axes, found.rates))
        and (found.errors[done] >= 0).all()
        and (np.abs(np.linalg.norm(found.axes, axis=-1) - 1) < UNIT_ERROR)[np.repeat(done[:, None], 2, axis=1)].all()
    )
