"""Finished chunks of a sweep in a folder: each file says which sweep it belongs to and is checked whole before use."""

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import numpy as np

from lagrotor.about import __version__
from lagrotor.errors import InputError
from lagrotor.files import read_arrays, write_arrays
from lagrotor.models.sweeps.chunk import MODELS, Array, Chunk
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
        write_arrays(self.file(number), {"sweep": self.sweep, "chunk": number}, found._asdict())

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
        whole = about.get("chunk") == number and held.keys() == set(Chunk._fields) and _is_whole(Chunk(**held), shape)
        return Chunk(**held) if whole else None


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
    """Whether the arrays are those of a chunk of this shape: finite motions of unit axes, NaN only where none ended."""
    n = shape[0]
    if any(part.shape != s for part, s in zip(found, (shape, shape, (n, shape[2]), (n,), (n,)), strict=True)):
        return False
    if not all(part.dtype == kind for part, kind in zip(found, (float, float, float, np.int64, np.int64), strict=True)):
        return False
    none = found.models == MODELS.index("none")
    done = ~none
    return bool(
        ((found.models >= 0) & (found.models < len(MODELS)) & (found.evaluations >= 0)).all()
        and np.isnan(found.axes[none]).all()
        and np.isfinite(found.axes[done]).all()
        and np.isfinite(found.rates[done]).all()
        and (found.errors[done] >= 0).all()
        and (np.abs(np.linalg.norm(found.axes[done], axis=-1) - 1) < UNIT_ERROR).all()
    )
