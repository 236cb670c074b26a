"""The finished chunks of a sweep in a folder, so that one which was interrupted goes on where it stopped: each file says which
sweep it belongs to, and is checked before it is used."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from lagrotor.about import __version__
from lagrotor.errors import InputError
from lagrotor.files import path_of, read_arrays, write_arrays
from lagrotor.numerics.run import Ending
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import UNIT_ERROR

Arrays: TypeAlias = Mapping[str, NDArray[Any]]  # of a chunk, by name
Endings: TypeAlias = tuple[Ending, ...]


@dataclass(frozen=True)
class KeptChunks:
    """The chunks of one sweep; `sweep` is the digest of its scenes, times, tolerance, chunk size, engine and version."""

    path: Path
    sweep: str

    def _file(self, number: int) -> Path:
        return self.path / f"chunk-{number:06d}.npz"

    def write(self, number: int, arrays: Arrays, endings: Endings) -> None:
        about = {"sweep": self.sweep, "chunk": number, "endings": [asdict(ending) for ending in endings]}
        write_arrays(self._file(number), about, arrays)

    def read(self, number: int, blank: Arrays) -> tuple[Arrays, Endings] | None:
        """A finished chunk; None where there is none or a damaged one, which is run again. blank: its arrays before it is run.

        Raises InputError for a chunk of another sweep.
        """
        if not self._file(number).exists():
            return None
        try:
            about, arrays = read_arrays(self._file(number))
        except InputError:
            return None
        if about.get("sweep") != self.sweep:
            raise InputError(
                f"sweep: {self._file(number)} belongs to another sweep (scenes, times, tol, chunk, engine or version "
                "differ): give an empty folder"
            )
        try:
            endings = tuple(Ending(**ending) for ending in about["endings"])
        except (KeyError, TypeError):
            return None
        return (arrays, endings) if about.get("chunk") == number and _is_whole(arrays, endings, blank) else None


def kept_chunks(
    folder: str | Path, scenes: Sequence[Scene], times: NDArray[np.float64], tol: float, chunk: int, engine: str
) -> KeptChunks:
    """Those of this sweep in an existing folder. Raises InputError where there is none."""
    path = path_of("sweep: folder", folder)
    if not path.is_dir():
        raise InputError(f"sweep: there is no folder {path}: make it first")
    arguments = repr((tuple(scenes), times.tolist(), tol, chunk, engine, __version__))
    return KeptChunks(path, sha256(arguments.encode()).hexdigest())


def _is_whole(arrays: Arrays, endings: Endings, blank: Arrays) -> bool:
    """Return whether the arrays are those of a chunk: finite motions of unit axes, NaN only after one that ended early."""
    if {k: (a.shape, a.dtype) for k, a in arrays.items()} != {k: (a.shape, a.dtype) for k, a in blank.items()}:
        return False
    axes, rates, errors, models = (arrays[name] for name in ("axes", "rates", "errors", "models"))
    done, early = np.isfinite(errors), np.array([ending.early for ending in endings])
    return bool(
        len(early) == len(done)
        and ((models >= 0) & (models <= blank["models"]) & (arrays["evaluations"] >= 0)).all()
        and (done.all(1) | early).all()
        and (done[:, :-1] >= done[:, 1:]).all()
        and all((np.isfinite(part).all((1, 3)) == done).all() for part in (axes, rates))
        and (errors[done] >= 0).all()
        and (np.abs(np.linalg.norm(axes, axis=-1) - 1) < UNIT_ERROR)[np.repeat(done[:, None], 2, axis=1)].all()
    )
