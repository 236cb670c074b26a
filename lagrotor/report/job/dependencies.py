"""The inputs on which the result of a script depends: the script, the scripts it runs, the paper's folder, the package.

The result of an earlier run is reused if the digest of these inputs and of the versions of Python and libraries is the same.
"""

import hashlib
import platform
import re
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from lagrotor.about import __version__
from lagrotor.paper.papers import Paper

_PACKAGE = Path(__file__).resolve().parents[2]
_TOOLS = ("sympy", "mpmath", "numpy", "scipy", "matplotlib")
# Packages that convert the text of a derivation to HTML, if they are installed.
_CONVERTERS = ("latex2mathml", "markdown-it-py", "mdit-py-plugins", "pillow")
TIMES = "times.json"  # computing times; in a paper's folder those of an earlier run, from which the order of the steps follows
# Files that are no inputs: the record is only compared with, the times only give an order, and drawings are outputs.
_NO_SOURCE = {".py", ".pyc", ".gif", ".png", ".svg", ".cff", ".md"}
_NO_DATA = {"recorded.toml", TIMES}
_WORD = re.compile(r"""["'](\w+)["']""")


def digest(*items: bytes | str) -> str:
    """Return the SHA-256 of a list of items. The length of each is included, so that no two lists share their bytes."""
    hash_ = hashlib.sha256()
    for item in items:
        data = item.encode() if isinstance(item, str) else item
        hash_.update(len(data).to_bytes(8, "big") + data)
    return hash_.hexdigest()


@cache
def versions() -> dict[str, str]:
    """Return the versions of Python, of lagrotor and of its dependencies."""
    return {"Python": platform.python_version(), "lagrotor": __version__} | {name: version(name) for name in _TOOLS}


@cache
def converters() -> dict[str, str]:
    """Return the versions of those packages in `_CONVERTERS` that are installed."""
    found = {}
    for name in _CONVERTERS:
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _texts(path: Path) -> frozenset[str]:
    """Return the contents of all string literals of a script that are one word."""
    return frozenset(_WORD.findall(_text(path)))


@cache
def _stems(paper: Paper) -> frozenset[str]:
    return frozenset(paper.scripts.names("derivations"))


@cache
def scripts_named(path: Path, paper: Paper) -> tuple[str, ...]:
    """Return the stems of the derivations that a script names in a string, and whose values it may import."""
    stems = _texts(path) & _stems(paper)
    return tuple(sorted(stem for stem in stems if paper.scripts.path("derivations", stem) != path))


def values_taken(stem: str, paper: Paper) -> frozenset[str]:
    """Return the names that other scripts may import from a derivation: all strings in the scripts that name it."""
    others = (path for kind in ("derivations", "figures") for path in (paper.scripts.base / kind).glob("*.py"))
    return frozenset(text for path in others if stem in scripts_named(path, paper) for text in _texts(path))


def source_digest(path: Path, paper: Paper) -> str:
    """Return the digest of all inputs on which the result of a script depends, including the whole package."""
    reached, stack = {path}, [path]
    while stack:
        new = {paper.scripts.path("derivations", stem) for stem in scripts_named(stack.pop(), paper)} - reached
        reached |= new
        stack += new
    return digest(_shared(paper), _digest_of(reached, paper))


@cache
def _shared(paper: Paper) -> str:
    """Return the digest of the inputs that all scripts share: package, catalogue, data files, versions, machine."""
    data = [
        f
        for kind in ("derivations", "figures")
        for f in (paper.scripts.base / kind).glob("*.*")
        if f.suffix not in _NO_SOURCE
    ]
    shared = inputs(paper)
    digests = (shared["package"], shared["catalogue of equations, claims, figures"], _digest_of(data, paper))
    tools = (versions() | converters()).items()
    return digest(*digests, *map(str, tools), platform.machine(), platform.system())


def _digest_of(files: Iterable[Path], paper: Paper) -> str:
    """Return the digest of the relative paths and the contents of some files."""
    rows = sorted((_place(file, paper), digest(file.read_bytes())) for file in files)
    return digest(*(item for row in rows for item in row))


@cache
def _place(file: Path, paper: Paper) -> str:
    """Return the relative path of a file; it is the same in a checkout and in an installed package."""
    for kind in ("derivations", "figures"):
        if file.parent == paper.scripts.base / kind:
            return f"{kind}/{file.name}"
    for folder in (_PACKAGE, paper.folder):
        if folder in file.parents:
            return file.relative_to(folder).as_posix()
    return file.name


def inputs(paper: Paper) -> dict[str, str]:
    """Return a map from each kind of input of a whole run, such as "package" or "figures", to its SHA-256."""
    package = {f for f in _PACKAGE.rglob("*") if f.is_file() and "__pycache__" not in f.parts}
    package -= {f for kind in ("derivations", "figures", "papers") for f in (_PACKAGE / kind).rglob("*")}
    catalogue = {f for f in paper.folder.iterdir() if f.is_file()}
    package, catalogue = (
        {f for f in files if f.suffix not in _NO_SOURCE - {".py"} and f.name not in _NO_DATA}
        for files in (package - catalogue, catalogue)
    )
    digests = {
        "catalogue of equations, claims, figures": _digest_of(catalogue, paper),
        "package": _digest_of(package, paper),
    }
    scripts = {kind: (paper.scripts.base / kind).glob("*.*") for kind in ("derivations", "figures")}
    sources = {kind: [f for f in files if f.suffix not in _NO_SOURCE - {".py"}] for kind, files in scripts.items()}
    return digests | {kind: _digest_of(files, paper) for kind, files in sources.items()}
