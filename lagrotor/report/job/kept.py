"""Products of the last run, taken again where nothing that they were made from has changed.

A product (what a derivation states, a claim's numbers, a figure) is kept in the report's folder as a pickle, with a seal on all
that it was made from and on the digests of its files. It is taken only if all of these still agree; whatever is missing,
damaged or out of date is made anew. A pickle can call anything, so that none is read but of this user's own runs: the seal is
made with a key that lies in this user's folder of states, not in the report's.
"""

import hmac
import json
import os
import pickle
import secrets
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from lagrotor.files import write_beside, write_text
from lagrotor.report.job.folder import MADE, PRODUCTS
from lagrotor.report.job.reach import digest


@dataclass
class Kept:
    """Products of the last report of a paper in the folder `old`, and those of the one that is made in the folder `new`."""

    old: Path
    new: Path
    paper: Any = None
    taken: list[str] = field(default_factory=list)
    _parts: dict[str, Any] = field(default_factory=dict)
    _last: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        with suppress(OSError, ValueError, TypeError):  # no last report, or a damaged one: everything is made anew
            self._last = dict(json.loads((self.old / MADE).read_text(encoding="utf-8")))

    def __contains__(self, name: str) -> bool:
        """Whether the last report has a product of that name, up to date or not."""
        return name in self._last

    def last(self, name: str, made_from: str) -> Any:
        """A product of the last report; None unless it was made from the same, by this user, and is undamaged."""
        return self._sealed(name, made_from)[0]

    def _sealed(self, name: str, made_from: str) -> tuple[Any, dict[str, bytes]]:
        """A product and its files; (None, {}) where the seal is not theirs."""
        # Which error depends on what is damaged; what has the seal was whole when it was written.
        with suppress(Exception):
            part = self._last[name]
            if not hmac.compare_digest(part["seal"], self._seal(made_from, part["files"])):
                return None, {}
            files = {file: (self.old / file).read_bytes() for file in part["files"]}
            if all(digest(held) == part["files"][file] for file, held in files.items()):
                return pickle.loads(files[_file_of(name)]), files
        return None, {}

    def take(self, name: str, made_from: str) -> Any:
        """The same, and its files copied into the new report."""
        value, files = self._sealed(name, made_from)
        if value is not None:
            self._parts[name] = self._last[name]
            for file, held in files.items():
                (self.new / file).parent.mkdir(exist_ok=True)
                (self.new / file).write_bytes(held)
            self.taken.append(name)
        return value

    def keep(self, name: str, made_from: str, value: Any, files: Iterable[Path] = ()) -> None:
        """Keep a product of the new report for the next run, with its files in the folder `new`."""
        (self.new / PRODUCTS).mkdir(exist_ok=True)
        own = write_beside(self.new / _file_of(name), lambda file: pickle.dump(value, file, protocol=5))
        seen = {path.relative_to(self.new).as_posix(): digest(path.read_bytes()) for path in sorted({own, *files})}
        self._parts[name] = {"seal": self._seal(made_from, seen), "files": seen}

    def _seal(self, made_from: str, files: dict[str, str]) -> str:
        place = [str(self.paper.folder), str(self.paper.scripts_in)] if self.paper else []
        return hmac.digest(_key(), json.dumps([place, made_from, files], sort_keys=True).encode(), "sha256").hex()

    def write(self) -> None:
        """Write what the next run will read."""
        write_text(self.new / MADE, json.dumps(dict(sorted(self._parts.items())), indent=1, ensure_ascii=False) + "\n")


def _file_of(name: str) -> str:
    return f"{PRODUCTS}/{name.replace(' ', '-')}.pickle"


@cache
def _key() -> bytes:
    """This user's key, made at the first report; one for this process alone where none can be kept."""
    new = secrets.token_bytes(32)
    with suppress(OSError, RuntimeError):  # no home, or none that can be written to
        states = Path(os.environ.get("XDG_STATE_HOME", ""))
        if not states.is_absolute():  # from there a folder that came from elsewhere could bring its own key
            states = Path.home() / ".local" / "state"
        file = states / "lagrotor" / "report.key"
        file.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileExistsError), open(os.open(file, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600), "wb") as made:
            made.write(new)
        if len(key := file.read_bytes()) == len(new):
            return key
        file.write_bytes(new)  # one that was cut short
    return new
