"""Products of the last run, taken again where nothing that they were made from has changed.

A product (what a derivation states, a claim's numbers, a figure) is kept in the report's folder as a pickle, with a digest of
all that it was made from and the digests of its files. It is taken only if all of these still agree; whatever is missing,
damaged or out of date is made anew.
"""

import io
import json
import pickle
import shutil
from collections import Counter, OrderedDict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, is_dataclass
from enum import Enum
from fractions import Fraction
from pathlib import Path, PurePath
from types import MappingProxyType
from typing import Any

from sympy.parsing import sympy_parser

from lagrotor.files import write_beside, write_text
from lagrotor.report.job.folder import MADE, PRODUCTS
from lagrotor.report.job.reach import digest

# What a product may be made of, and the few functions that make it again: a pickle that names anything else is not read. A
# class may be given text; while a product is read, no text is parsed as an expression.
_ROOMS = ("sympy.", "lagrotor.", "numpy.", "pathlib.", "collections.", "fractions.", "mpmath.", "types.")
_SYMPY = tuple(
    f"sympy.{room}."
    for room in ("core", "functions", "matrices", "polys", "logic", "sets", "concrete", "integrals", "series")
)
_FUNCTIONS = {
    ("copyreg", "_reconstructor"),
    ("copyreg", "__newobj__"),
    ("copyreg", "__newobj_ex__"),
    ("_codecs", "encode"),
    *((f"numpy.{core}.multiarray", name) for core in ("core", "_core") for name in ("_reconstruct", "scalar")),
    *((f"numpy.{core}.numeric", "_frombuffer") for core in ("core", "_core")),
}
_BUILTINS = {
    "dict",
    "list",
    "tuple",
    "set",
    "frozenset",
    "int",
    "float",
    "complex",
    "str",
    "bytes",
    "bool",
    "slice",
    "object",
}


def _is_part(module: str, value: Any) -> bool:
    """Whether a class may be a part of a product: making one does nothing but hold its values."""
    if not isinstance(value, type):
        return False
    room = module.partition(".")[0]
    if room == "numpy":  # not its subclasses, of which one maps files
        import numpy as np

        return value is np.ndarray or issubclass(value, np.generic | np.dtype)
    if room == "lagrotor":
        return is_dataclass(value) or issubclass(value, Enum | tuple | dict)
    plain = issubclass(value, PurePath | Fraction | OrderedDict | Counter | MappingProxyType)
    return plain or module.startswith((*_SYMPY, "mpmath.ctx_mp_python"))


class _Reader(pickle.Unpickler):
    """Reads products, and refuses a pickle that would call anything else; of papers there is the one that is reported."""

    def __init__(self, data: bytes, paper: Any) -> None:
        super().__init__(io.BytesIO(data))
        self.paper = paper

    def _same_paper(self, folder: Any, scripts_in: Any = None) -> Any:
        if self.paper is None or (folder, scripts_in) != (self.paper.folder, self.paper.scripts_in):
            raise pickle.UnpicklingError("a product is of another paper")
        return self.paper

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == ("lagrotor.paper.papers", "opened"):
            return self._same_paper
        known = (module, name) in _FUNCTIONS or (module == "builtins" and name in _BUILTINS)
        if not known and not f"{module}.".startswith(_ROOMS):
            raise pickle.UnpicklingError(f"{module}.{name} is no part of a product")
        value = super().find_class(module, name)
        if not known and not _is_part(module, value):
            raise pickle.UnpicklingError(f"{module}.{name} is no part of a product")
        return value


def _read(data: bytes, paper: Any = None) -> Any:
    """The product; raises UnpicklingError for one that names what it may not, or that holds text to be parsed."""

    def refuse(*text: Any, **options: Any) -> Any:
        raise pickle.UnpicklingError("a product holds text where an expression should be")

    with patched(sympy_parser, "parse_expr", refuse), patched(sympy_parser, "eval_expr", refuse):
        return _Reader(data, paper).load()


@contextmanager
def patched(module: Any, name: str, value: Any) -> Iterator[None]:
    """Within the block the module's name stands for the value."""
    before = getattr(module, name)
    setattr(module, name, value)
    try:
        yield
    finally:
        setattr(module, name, before)


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
        """A product of the last report; None unless it was made from the same and is undamaged."""
        try:
            part = self._last[name]
            whole = part["seal"] == _seal(made_from, part["files"])
            whole = whole and all(
                digest((self.old / file).read_bytes()) == seen for file, seen in part["files"].items()
            )
            return _read((self.old / _file_of(name)).read_bytes(), self.paper) if whole else None
        except (
            OSError,
            TypeError,
            ValueError,
            KeyError,
            AttributeError,
            pickle.UnpicklingError,
            EOFError,
            ImportError,
            IndexError,
        ):
            return None

    def take(self, name: str, made_from: str) -> Any:
        """The same, and its files copied into the new report."""
        value = self.last(name, made_from)
        if value is not None:
            part = self._parts[name] = self._last[name]
            for file in part["files"]:
                (self.new / file).parent.mkdir(exist_ok=True)
                shutil.copyfile(self.old / file, self.new / file)
            self.taken.append(name)
        return value

    def keep(self, name: str, made_from: str, value: Any, files: Iterable[Path] = ()) -> None:
        """Keep a product of the new report for the next run, with its files in the folder `new`."""
        (self.new / PRODUCTS).mkdir(exist_ok=True)
        own = write_beside(self.new / _file_of(name), lambda file: pickle.dump(value, file, protocol=5))
        seen = {path.relative_to(self.new).as_posix(): digest(path.read_bytes()) for path in sorted({own, *files})}
        self._parts[name] = {"seal": _seal(made_from, seen), "files": seen}

    def write(self) -> None:
        """Write what the next run will read."""
        write_text(self.new / MADE, json.dumps(dict(sorted(self._parts.items())), indent=1, ensure_ascii=False) + "\n")


def _file_of(name: str) -> str:
    return f"{PRODUCTS}/{name.replace(' ', '-')}.pickle"


def _seal(made_from: str, files: dict[str, str]) -> str:
    return digest(made_from, json.dumps(files, sort_keys=True))
