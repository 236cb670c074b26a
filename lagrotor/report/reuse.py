"""What the last run found, taken again where nothing that it was made from has changed.

A part (a claim, a figure, the whole report) is kept in the report's `made.json` with a digest of all that it was made
from, its values, and the digests of its files. It is taken only if all of these still agree; whatever is missing,
damaged or out of date is made anew.
"""

import hashlib
import json
import platform
import shutil
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lagrotor.about import __version__
from lagrotor.files import write_text
from lagrotor.paper import scripts
from lagrotor.report.folder import MADE

_PACKAGE = Path(__file__).resolve().parent.parent
_TOOLS = ("sympy", "mpmath", "numpy", "scipy", "matplotlib")
# The rooms that write what was found: no claim and no figure depends on them, the report does.
_WRITERS = ("report", "commands")
# What lies inside an installed package, or was drawn by it, and is no source of it.
_NO_SOURCE = {".cff", ".gif", ".png"}
_CATALOGUE, _FINDS = "catalogue of equations, claims, figures", "package, what finds"


def digest(*parts: bytes | str) -> str:
    """SHA-256 of some parts, each with its length, so that no two lists of parts are read as one."""
    seen = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        seen.update(len(data).to_bytes(8, "big") + data)
    return seen.hexdigest()


def digest_of(files: Iterable[Path], base: Path) -> str:
    """SHA-256 of files: their names within `base` and their bytes."""
    parts = sorted((path.relative_to(base).as_posix(), path.read_bytes()) for path in files)
    return digest(*(part for name, data in parts for part in (name, data)))


def versions() -> dict[str, str]:
    """What a run is made with."""
    return {"Python": platform.python_version(), "lagrotor": __version__} | {name: version(name) for name in _TOOLS}


@cache
def inputs() -> dict[str, str]:
    """What a run is made from: name → SHA-256."""
    package = {path for path in _PACKAGE.rglob("*") if path.is_file() and "__pycache__" not in path.parts}
    package -= {path for path in package if path.suffix in _NO_SOURCE}
    package -= {path for kind in ("derivations", "figures") for path in (_PACKAGE / kind).rglob("*")}
    toml = {path for path in package if path.suffix == ".toml"}
    writers = set(filter(_writes, package))
    found = {
        _CATALOGUE: digest_of(toml, _PACKAGE),
        _FINDS: digest_of(package - toml - writers, _PACKAGE),
        "package, what writes the report": digest_of(writers, _PACKAGE),
    }
    for kind in ("derivations", "figures"):
        folder = scripts.folder(kind)
        found[kind] = digest_of(folder.glob("*.py"), folder)
    return found


def _writes(path: Path) -> bool:
    """Whether a file of the package is in one of `_WRITERS`."""
    return path.relative_to(_PACKAGE).parts[0] in _WRITERS


def foundation() -> str:
    """Digest of all that a claim or a figure can be made from, but for the figure's own script."""
    made = inputs()
    names = (_CATALOGUE, _FINDS, "derivations")
    return digest(*(made[name] for name in names), json.dumps(versions()), platform.machine(), platform.system())


@dataclass
class Kept:
    """Parts of the last report in the folder `old`, and those of the one that is made in the folder `new`."""

    old: Path
    new: Path
    taken: list[str] = field(default_factory=list)
    _parts: dict[str, Any] = field(default_factory=dict)
    _last: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        with suppress(OSError, ValueError, TypeError):  # no last report, or a damaged one: everything is made anew
            self._last = dict(json.loads((self.old / MADE).read_text(encoding="utf-8")))

    def last(self, name: str, made_from: str) -> Any:
        """The values of a part of the last report; None unless it was made from the same and is undamaged."""
        try:
            part = self._last[name]
            whole = part["seal"] == _seal(made_from, part["value"], part["files"]) and all(
                digest((self.old / file).read_bytes()) == seen for file, seen in part["files"].items()
            )
        except (OSError, TypeError, KeyError, AttributeError):
            return None
        return part["value"] if whole else None

    def take(self, name: str, made_from: str) -> Any:
        """The same, and its files copied into the new report."""
        value = self.last(name, made_from)
        if value is not None:
            part = self._parts[name] = self._last[name]
            for file in part["files"]:
                shutil.copyfile(self.old / file, self.new / file)
            self.taken.append(name)
        return value

    def keep(self, name: str, made_from: str, value: Any, files: Iterable[Path] = ()) -> None:
        """Keep a part of the new report for the next run: values that JSON can hold, files in the folder `new`."""
        seen = {path.relative_to(self.new).as_posix(): digest(path.read_bytes()) for path in sorted(files)}
        self._parts[name] = {"seal": _seal(made_from, value, seen), "value": value, "files": seen}

    def write(self) -> None:
        """Write what the next run will read."""
        write_text(self.new / MADE, json.dumps(dict(sorted(self._parts.items())), indent=1, ensure_ascii=False) + "\n")


def _seal(made_from: str, value: Any, files: dict[str, str]) -> str:
    return digest(made_from, json.dumps(value, sort_keys=True), json.dumps(files, sort_keys=True))
