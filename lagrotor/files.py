"""Files, which are written atomically, and arrays, which are checked before they are used."""

import json
import os
import tempfile
import tomllib
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeAlias
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from lagrotor.about import __version__
from lagrotor.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

PICTURES, FILMS = (".png", ".svg", ".pdf"), (".gif",)
# The largest array and description that are read, in bytes.
_LARGEST, _LARGEST_ABOUT = 2**31, 2**20

Arrays: TypeAlias = "dict[str, NDArray[Any]]"


def write_beside(target: Path, write: Callable[[IO[bytes]], Any]) -> Path:
    """Let `write` fill a file in the folder of `target`, then rename it, so that no reader sees half a file."""
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise InputError(f"{target}: {error.strerror}: choose an existing folder that can be written to") from None
    try:
        with os.fdopen(handle, "wb") as file:
            write(file)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, target)
    except OSError as error:
        raise InputError(f"{target}: {error.strerror}: choose another file") from None
    finally:
        Path(name).unlink(missing_ok=True)
    return target


def path_of(where: str, path: str | Path) -> Path:
    """Return the path of a file or a folder; raise InputError unless it is a text or a Path."""
    try:
        return Path(path)
    except TypeError:
        raise InputError(f"{where} = {path!r} must be a path, as text or as a Path") from None


def read_text(path: str | Path, otherwise: str = "") -> str:
    """Read a text file in UTF-8 or UTF-16, else in the encoding `otherwise`; raise InputError if it cannot be read."""
    try:
        with path_of("path", path).open("rb") as file:
            wide = file.read(2) in (b"\xff\xfe", b"\xfe\xff")
        return Path(path).read_text(encoding="utf-16" if wide else "utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}: give a file that can be read") from None
    except UnicodeError:
        if otherwise:
            return Path(path).read_text(encoding=otherwise)
        raise InputError(f"{path} is no text in UTF-8: save it in that encoding") from None


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file; raise InputError if it cannot be read."""
    try:
        return tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path} is no TOML: {error}: correct the file there") from None


def write_text(target: Path, text: str) -> Path:
    """Write UTF-8 text atomically."""
    return write_beside(target, lambda file: file.write(text.encode()))


def write_together(folder: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Write files of UTF-8 text, by name, into a folder, which is made if it is missing. All are written under other names first,
    and renamed last, so that a full disk leaves the folder as it was."""
    new = not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder, prefix=".") as beside:
            for name, text in texts.items():
                Path(beside, name).write_text(text, encoding="utf-8", newline="\n")
            return tuple(Path(beside, name).replace(folder / name) for name in texts)
    except OSError as error:
        if new and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
        raise InputError(f"{folder}: {error.strerror or error}: choose a folder that can be written to") from None


def write_arrays(target: Path, about: Mapping[str, Any], arrays: Mapping[str, Any]) -> Path:
    """Write arrays as .npz. The entry "about" is JSON: `about`, the version and a SHA-256 digest of all contents."""
    import numpy as np

    rows: dict[str, Any] = {name: np.ascontiguousarray(values) for name, values in arrays.items()}
    described = {**about, "lagrotor": __version__}
    described["digest"] = _digest(described, rows)
    return write_beside(target, lambda file: np.savez_compressed(file, about=json.dumps(described), **rows))


def read_arrays(path: Path) -> tuple[dict[str, Any], Arrays]:
    """Return the description and the arrays that `write_arrays` wrote; raise InputError if the file is damaged.

    Sizes and types are checked in the headers before any array is read.
    """
    try:
        with ZipFile(path) as archive:
            entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
            if "about" not in entries:
                raise InputError(f"{path}: it has no description: give a file that lagrotor wrote")
            arrays = {name: _read_array(archive, path, name, entry) for name, entry in entries.items()}
        about = json.loads(str(arrays.pop("about")))
        if not isinstance(about, dict) or about.pop("digest", None) != _digest(about, arrays):
            raise InputError(f"{path}: its contents do not have the digest that it was written with: make it anew")
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}: give a file that can be read") from None
    except Exception as error:  # the type depends on the damaged byte
        raise InputError(f"{path}: it is damaged or no .npz file ({type(error).__name__}): make it anew") from None
    return about, arrays


def _read_array(archive: ZipFile, path: Path, name: str, entry: ZipInfo) -> "NDArray[Any]":
    """Read one array of the archive, after checking its type and its size against the header."""
    import numpy as np

    if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise InputError(f"{path}: {name} is compressed in an unknown way: make it anew")
    with archive.open(entry) as file:
        version = np.lib.format.read_magic(file)
        if version != (1, 0):
            raise InputError(f"{path}: the header of {name} has format {version}, not (1, 0): make it anew")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
        if dtype.kind not in ("U" if name == "about" else "fi") or fortran:
            raise InputError(f"{path}: {name} holds {dtype}, not plain numbers: make it anew")
        size = int(np.prod(shape, dtype=object)) * dtype.itemsize
        if size > (_LARGEST_ABOUT if name == "about" else _LARGEST) or size != entry.file_size - file.tell():
            raise InputError(f"{path}: {name} declares {size} bytes, too many or not its size: make it anew")
        data = file.read(size)
    return np.frombuffer(data, dtype).reshape(shape).copy()


def _digest(about: Mapping[str, Any], arrays: "Mapping[str, NDArray[Any]]") -> str:
    import numpy as np

    whole = sha256(json.dumps(about, sort_keys=True).encode())
    for name, values in sorted(arrays.items()):
        whole.update(f"{name} {values.dtype.str} {values.shape}".encode())
        whole.update(np.ascontiguousarray(values).tobytes())
    return whole.hexdigest()
