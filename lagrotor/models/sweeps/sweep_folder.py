"""The results of a sweep: as arrays in memory, or as the files of a folder, from which the same sweep goes on.

The folder has `sweep.json` with the arguments of the sweep, one `.npy` file for each column, and `chunks.jsonl`. A chunk counts
only after its line in `chunks.jsonl`, which has digests of its rows. So a process that is killed leaves no half chunk.
"""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.about import __version__
from lagrotor.errors import InputError
from lagrotor.files import path_of, write_text
from lagrotor.models.sweeps.chunk import ChunkRuns
from lagrotor.models.sweeps.endings import Endings
from lagrotor.models.sweeps.ensemble import Ensemble
from lagrotor.models.sweeps.scene_columns import LazyScenes, SceneColumns
from lagrotor.numerics.arrays import Array

_ABOUT, _CHUNKS, _HEADER = "sweep.json", "chunks.jsonl", 128  # bytes
_FORMAT = 1
Rows = Mapping[str, NDArray[Any]]


_SCENES = {"spins": (2,), "rotor": (4,), "link": (3,), "shock": (6,), "axes": (2, 3), "rates": (2, 3)}


def _kinds(m: int) -> dict[str, np.dtype[Any]]:
    """Return the type of one row of each column of a sweep at m times."""
    rows: dict[str, tuple[int, ...]] = {f"scene_{name}": row for name, row in _SCENES.items()}
    rows |= {"axes": (2, m, 3), "rates": (2, m, 3), "errors": (m,), "ending_times": ()}
    counts = {"evaluations": "<i8", "models": "|i1", "ending_kinds": "|i1"}
    return {name: np.dtype(("<f8", row)) for name, row in rows.items()} | {
        n: np.dtype(kind) for n, kind in counts.items()
    }


def inputs_of(scenes: SceneColumns) -> Rows:
    """Return the columns of the scenes by the names of their files."""
    return {f"scene_{name}": getattr(scenes, name) for name in _SCENES}


def _results_of(part: ChunkRuns) -> Rows:
    endings: dict[str, NDArray[Any]] = {"ending_times": part.endings.times, "ending_kinds": part.endings.kinds}
    return endings | {name: getattr(part, name) for name in ("axes", "rates", "errors", "evaluations", "models")}


def _fields(rows: Rows, chunks: Mapping[int, Mapping[Any, str]], times: Array, tol: float) -> dict[str, Any]:
    """Return the fields of an Ensemble with these columns. The chunks state the reasons of their endings."""
    plain = {name: rows[name] for name in ("axes", "rates", "errors", "evaluations", "models")}
    scenes = LazyScenes(SceneColumns(**{name: rows[f"scene_{name}"] for name in _SCENES}))
    reasons = {first + int(i): reason for first, chunk in chunks.items() for i, reason in chunk.items()}
    endings = Endings(rows["ending_kinds"], rows["ending_times"], reasons)
    return {"scenes": scenes, "t": times, "tol": tol, "endings": endings} | plain


def digest(rows: Rows) -> str:
    """Return the SHA-256 digest of some columns."""
    whole = sha256()
    for name, values in sorted(rows.items()):
        whole.update(f"{name} {values.shape}".encode())
        whole.update(np.ascontiguousarray(values).data)
    return whole.hexdigest()


class MemoryStore:
    """The results of a sweep in memory."""

    def __init__(self, times: Array, tol: float) -> None:
        self.times, self.tol, self.chunks = times, tol, dict[int, tuple[dict[str, NDArray[Any]], Mapping[int, str]]]()

    def holds(self, first: int, scenes: SceneColumns) -> bool:
        """Return False: no chunk is there before it is run."""
        return False

    def write(self, first: int, scenes: SceneColumns, part: ChunkRuns) -> None:
        """Keep the results of a chunk, whose first scene has the number `first`."""
        self.chunks[first] = ({**inputs_of(scenes), **_results_of(part)}, part.endings.reasons)

    def result(self, runs: int) -> Ensemble:
        """Return the results of all runs."""
        parts = [rows for _, (rows, _) in sorted(self.chunks.items())]
        whole = {name: np.concatenate([rows.pop(name) for rows in parts]) for name in list(parts[0])}
        reasons = {first: reasons for first, (_, reasons) in self.chunks.items()}
        return Ensemble(**_fields(whole, reasons, self.times, self.tol))

    def close(self) -> None:
        """Do nothing: there is no file."""


class FolderStore:
    """The results of a sweep in a folder, which is made anew or has a part of the same sweep."""

    def __init__(self, folder: Path, about: Mapping[str, Any]) -> None:
        self.folder, self.about = folder, {"format": _FORMAT, "lagrotor": __version__, **about}
        _begin(folder, self.about)
        self.kinds, self.chunks = _kinds(len(about["t"])), _read_chunks(folder)
        self.files = {name: (folder / f"{name}.npy").open("r+b") for name in self.kinds}

    def holds(self, first: int, scenes: SceneColumns) -> bool:
        """Return True if the folder has the undamaged chunk of these scenes; raise InputError if it has other scenes there."""
        if (chunk := self.chunks.get(first)) is None:
            return False
        inputs, n = inputs_of(scenes), len(scenes)
        if (chunk["runs"], chunk["scenes"]) != (n, digest(inputs)):
            raise _another(self.folder, f"its scenes from number {first} on are others")
        rows = {  # fewer than n if a file is too short
            name: np.fromfile(file.name, self.kinds[name], n, offset=_HEADER + first * self.kinds[name].itemsize)
            for name, file in self.files.items()
        }
        if digest({name: rows.pop(name) for name in inputs}) == chunk["scenes"] and digest(rows) == chunk["results"]:
            return True
        del self.chunks[first]
        return False

    def write(self, first: int, scenes: SceneColumns, part: ChunkRuns) -> None:
        """Write a chunk, whose first scene has the number `first`."""
        inputs, results = inputs_of(scenes), _results_of(part)
        rows = {name: np.ascontiguousarray(v, self.kinds[name].base) for name, v in {**inputs, **results}.items()}
        chunk = {"first": first, "runs": len(scenes), "scenes": digest(inputs), "reasons": dict(part.endings.reasons)}
        chunk["results"] = digest({name: rows[name] for name in results})
        try:
            for name, values in rows.items():
                self.files[name].seek(_HEADER + first * self.kinds[name].itemsize)
                self.files[name].write(values.data)
                self.files[name].flush()
            with (self.folder / _CHUNKS).open("ab") as lines:
                lines.write(b"\n" * bool(lines.tell()) + json.dumps(chunk).encode())
        except OSError as error:
            says = "the chunks that are finished stay; make room, then the same call goes on"
            raise InputError(f"sweep: {self.folder}: {error.strerror}: {says}") from None
        self.chunks[first] = chunk

    def result(self, runs: int) -> "Sweep":
        """Record that all runs are there, and return them."""
        if max(self.chunks) >= runs:
            raise _another(self.folder, f"it has more than {runs} runs")
        write_text(self.folder / _ABOUT, json.dumps({**self.about, "runs": runs}))
        self.close()
        return Sweep.open(self.folder)

    def close(self) -> None:
        """Write the numbers of rows into the headers, so that numpy reads the columns, and close the files."""
        for name, file in self.files.items():
            if not file.closed:
                with suppress(OSError), file:
                    file.seek(0)
                    file.write(_header(self.kinds[name], _finished(self.chunks)))


def _begin(folder: Path, about: Mapping[str, Any]) -> None:
    """Make the folder and its files, unless it has the same sweep. Raises InputError if the folder has anything else."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / _ABOUT).exists():
            if foreign := sorted(path.name for path in folder.iterdir() if not path.name.startswith(".")):
                raise InputError(f"sweep: the folder {folder} has other files ({foreign[0]}): give a new folder")
            write_text(folder / _ABOUT, json.dumps(about))
        there = _read_about(folder)
        for name, value in about.items():
            if there.get(name) != value and not (name == "runs" and value is None):
                values = " differs" if name in ("scenes", "t") else f" = {there.get(name)}, not {value}"
                raise _another(folder, f"{name}{values}")
        for name, kind in _kinds(len(about["t"])).items():
            with (folder / f"{name}.npy").open("ab") as file:
                if file.tell() < _HEADER:
                    file.truncate(0)
                    file.write(_header(kind, 0))
    except OSError as error:
        raise InputError(f"sweep: {folder}: {error.strerror}: give a folder that can be written to") from None


def chunk_of(folder: Path) -> int | None:
    """Return the number of scenes in a chunk of the sweep in a folder; None if the folder has no sweep."""
    return int(_read_about(folder)["chunk"]) if (folder / _ABOUT).exists() else None


def _another(folder: Path, difference: str) -> InputError:
    return InputError(f"sweep: the folder {folder} has another sweep: {difference}; give another folder")


def _read_about(folder: Path) -> dict[str, Any]:
    """Return the arguments of the sweep in a folder."""
    try:
        about = json.loads((folder / _ABOUT).read_bytes())
        if isinstance(about, dict) and about.get("format") == _FORMAT and about["chunk"] and len(about["t"]):
            return about
    except OSError as error:
        raise InputError(f"{folder / _ABOUT}: {error.strerror}: give the folder of a sweep") from None
    except (ValueError, KeyError, TypeError):
        pass
    raise InputError(f"{folder / _ABOUT} describes no sweep that this version reads: give the folder of a sweep")


def _read_chunks(folder: Path) -> dict[int, dict[str, Any]]:
    """Return the finished chunks by the numbers of their first runs. A line that was cut short is passed over."""
    chunks, file = dict[int, dict[str, Any]](), folder / _CHUNKS
    for line in file.read_bytes().splitlines() if file.exists() else ():
        with suppress(ValueError):
            chunk = json.loads(line)
            chunks[chunk["first"]] = chunk
    return chunks


def _finished(chunks: Mapping[int, Mapping[str, Any]]) -> int:
    """Return the number of runs before the first chunk that is missing."""
    runs = 0
    while runs in chunks:
        runs += chunks[runs]["runs"]
    return runs


def _header(kind: np.dtype[Any], runs: int) -> bytes:
    """Return the header of an .npy file, always of the same length."""
    says = f"{{'descr': '{kind.base.str}', 'fortran_order': False, 'shape': {(runs, *kind.shape)}, }}"
    return b"\x93NUMPY\x01\x00" + (_HEADER - 10).to_bytes(2, "little") + f"{says:{_HEADER - 11}}\n".encode()


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Ensemble):
    """The runs in the folder of a sweep. Their columns are memory maps: numbers are read when they are used.

    Attributes
    ----------
    scenes : Sequence of Scene
    t : Array
    axes : Array
    rates : Array
    errors : Array
    tol : float
    evaluations : Array
    models : Array
    endings : Sequence of Ending
        The fields of `Ensemble`. Of an unfinished sweep they have the runs before the first missing chunk.
    folder : Path
        The folder.
    total : int or None
        The number of runs of the whole sweep; None while it is not known.
    """

    folder: Path
    total: int | None

    @staticmethod
    def open(folder: str | Path) -> "Sweep":
        """Open the folder of a sweep, finished or not.

        Parameters
        ----------
        folder : str or Path
            The folder that `sweep` was given.

        Returns
        -------
        Sweep
            Its runs.

        Raises
        ------
        InputError
            If the folder has no sweep, no finished chunk or a damaged file.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> from lagrotor import sweep
        >>> with TemporaryDirectory() as folder:
        ...     table = {"spins_1": [5.0, 10.0], "spins_2": -10.0}
        ...     runs = sweep(table, [0.0, 1.0], folder=f"{folder}/out")
        ...     Sweep.open(f"{folder}/out").axes.shape
        (2, 2, 2, 3)
        """
        folder = path_of("Sweep.open: folder", folder)
        about, chunks = _read_about(folder), _read_chunks(folder)
        if not (n := _finished(chunks)):
            raise InputError(f"Sweep.open: no chunk of {folder} is finished: let the sweep go on")
        rows = dict[str, NDArray[Any]]()
        for name, kind in _kinds(len(about["t"])).items():
            try:
                rows[name] = np.memmap(folder / f"{name}.npy", kind.base, "r", _HEADER, (n, *kind.shape))
            except (OSError, ValueError):
                remedy = "the call of the sweep computes it again"
                raise InputError(f"Sweep.open: {folder / name}.npy is missing or cut short: {remedy}") from None
        reasons = {first: chunk["reasons"] for first, chunk in chunks.items()}
        fields = _fields(rows, reasons, np.array(about["t"], float), about["tol"])
        return Sweep(**fields, folder=folder, total=about["runs"])

    def summary(self) -> dict[str, str]:
        """Return the folder, the number of runs, their models and errors in words.

        Returns
        -------
        dict of str
            The rows of the table.
        """
        total = "" if self.total == len(self) else f" of {self.total or 'an unknown number'}"
        return {"folder": str(self.folder)} | super().summary() | {"runs": f"{len(self)}{total}"}
