"""The files that a script depends on: its own, modules of the package, the data beside them, other scripts.

The digest of all this, with the versions of the tools, is what a product of the last run must agree with to be taken again.
"""

import hashlib
import platform
import re
from collections.abc import Iterable
from functools import cache
from importlib.metadata import version
from pathlib import Path

from lagrotor.about import __version__
from lagrotor.faces import names_of_face
from lagrotor.paper.papers import Paper

_PACKAGE = Path(__file__).resolve().parents[2]
_TOOLS = ("sympy", "mpmath", "numpy", "scipy", "matplotlib")
# What lies beside a module and is no source of it: the record is only compared with, drawings are made from the rest.
_NO_SOURCE = {".py", ".pyc", ".gif", ".png", ".svg", ".cff", ".md"}
_NO_DATA = {"recorded.toml"}
# Read off the text, since parsing takes ten times as long; what looks like an import or a string and is none does no harm.
_IMPORT = re.compile(r"^[ ]*(?:from ([\w.]+) import (\([^)]*\)|.*)|import (.*))$", re.MULTILINE)
_NAME = re.compile(r"[\w.]+")
_WORD = re.compile(r"""["'](\w+)["']""")


def digest(*parts: bytes | str) -> str:
    """SHA-256 of some parts, each with its length, so that no two lists of parts are read as one."""
    seen = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        seen.update(len(data).to_bytes(8, "big") + data)
    return seen.hexdigest()


@cache
def versions() -> dict[str, str]:
    """Return the versions of Python, of lagrotor and of its dependencies."""
    return {"Python": platform.python_version(), "lagrotor": __version__} | {name: version(name) for name in _TOOLS}


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def _face(package: str) -> dict[str, str]:
    """Name → module, of what a part of the package, or the package, hands on; empty for a module and for a paper's folder."""
    file = _PACKAGE.joinpath(*package.split(".")[1:], "__init__.py")
    return names_of_face(file) if package.startswith("lagrotor") and file.is_file() else {}


@cache
def imports(path: Path, folder: Path) -> frozenset[Path]:
    """The files of the package, and of a paper's folder, that one file imports, wherever in it."""
    names: set[str] = set()
    for module, inside, line in _IMPORT.findall(_text(path)):
        handed = _face(module)
        names |= {handed.get(name, f"{module}.{name}") for name in _NAME.findall(inside)} if inside else set()
        names |= set() if handed else {module, *_NAME.findall(line)}
    return frozenset(file for name in names if (file := _file_of(name, folder)))


def _file_of(module: str, folder: Path) -> Path | None:
    first, *rest = module.split(".")
    base = _PACKAGE.joinpath(*rest) if first == "lagrotor" and rest else folder.joinpath(first, *rest)
    return next((file for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()), None)


def _texts(path: Path) -> frozenset[str]:
    """Every string of one word in a script."""
    return frozenset(_WORD.findall(_text(path)))


@cache
def _stems(paper: Paper) -> frozenset[str]:
    return frozenset(paper.scripts.names("derivations"))


@cache
def scripts_named(path: Path, paper: Paper) -> tuple[str, ...]:
    """Stems of the derivations that a script names: it may run them."""
    stems = _texts(path) & _stems(paper)
    return tuple(sorted(stem for stem in stems if paper.scripts.path("derivations", stem) != path))


def values_taken(stem: str, paper: Paper) -> frozenset[str]:
    """Names that other scripts may take from a derivation: the strings in those that name it."""
    others = (path for kind in ("derivations", "figures") for path in (paper.scripts.base / kind).glob("*.py"))
    return frozenset(text for path in others if stem in scripts_named(path, paper) for text in _texts(path))


@cache
def files_reached(path: Path, paper: Paper) -> tuple[Path, ...]:
    """Every file that a script is made from: itself, what it imports and runs, in turn, and the data beside each of them and
    in the paper's folder."""
    reached, left = {path}, [path]
    while left:
        current = left.pop()
        scripts = {paper.scripts.path("derivations", stem) for stem in scripts_named(current, paper)}
        new = (imports(current, paper.folder) | scripts) - reached
        reached |= new
        left += new
    folders = {file.parent for file in reached if file.parent != _PACKAGE} | {paper.folder}
    beside = {file for folder in folders for file in _data_in(folder)}
    letters = {file for file in [paper.folder / "symbols.py"] if file.is_file()}
    return tuple(sorted(reached | letters | {file for file in beside if file.name not in _NO_DATA}))


@cache
def _data_in(folder: Path) -> tuple[Path, ...]:
    return tuple(file for file in folder.iterdir() if file.is_file() and file.suffix not in _NO_SOURCE)


@cache
def _file_digest(path: Path) -> str:
    return digest(path.read_bytes())


def source_digest(path: Path, paper: Paper) -> str:
    """Digest of all that a script's product is made from."""
    files = sorted((_place(file, paper), _file_digest(file)) for file in files_reached(path, paper))
    return digest(
        *(part for file in files for part in file), *map(str, versions().items()), platform.machine(), platform.system()
    )


def _digest_of(files: Iterable[Path], paper: Paper) -> str:
    """Digest of some files, by their places and their bytes."""
    return digest(*(part for file in sorted((_place(f, paper), _file_digest(f)) for f in files) for part in file))


@cache
def _place(file: Path, paper: Paper) -> str:
    """A file's place, the same in a checkout and in an installed package."""
    for kind in ("derivations", "figures"):
        if file.parent == paper.scripts.base / kind:
            return f"{kind}/{file.name}"
    for folder in (_PACKAGE, paper.folder):
        if folder in file.parents:
            return file.relative_to(folder).as_posix()
    return file.name


def inputs(paper: Paper) -> dict[str, str]:
    """Return the SHA-256 of each kind of input of a whole run, by name."""
    package = {f for f in _PACKAGE.rglob("*") if f.is_file() and "__pycache__" not in f.parts}
    package -= {f for kind in ("derivations", "figures", "papers") for f in (_PACKAGE / kind).rglob("*")}
    own = {f for f in paper.folder.iterdir() if f.is_file()}
    package, own = (
        {f for f in files if f.suffix not in _NO_SOURCE - {".py"} and f.name not in _NO_DATA}
        for files in (package - own, own)
    )
    digests = {"catalogue of equations, claims, figures": _digest_of(own, paper), "package": _digest_of(package, paper)}
    scripts = {kind: (paper.scripts.base / kind).glob("*.*") for kind in ("derivations", "figures")}
    kept = {kind: [f for f in files if f.suffix not in _NO_SOURCE - {".py"}] for kind, files in scripts.items()}
    return digests | {kind: _digest_of(files, paper) for kind, files in kept.items()}
