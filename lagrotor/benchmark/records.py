"""Recorded comparisons with other tools, each from one run on a named machine: all methods on the displaced pair, mechanisms,
chains.

Records make reports reproducible. They are renewed in a checkout with the other tools installed: `python -m
benchmarks.speed`, `python -m benchmarks.mechanisms --record`, `python -m benchmarks.structure_comparison`, `python -m
benchmarks.bodies_and_lagrangians --record`. Each record has its date and, for each package that it measured, a digest of the
code. Older records have no such digests.
"""

import ast
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import Any, Literal, TypeVar, get_args

from lagrotor import algebra, mechanics, models, numerics, pair, structures, theory
from lagrotor.errors import LagrotorError
from lagrotor.files import write_text

RecordName = Literal["speed", "mechanisms", "structures", "bodies_and_lagrangians"]
FILES: dict[RecordName, Path] = {
    name: Path(__file__).with_name(f"recorded_{name}.json") for name in get_args(RecordName)
}
KEPT_SOURCES = "generated.txt"
MEASURED_PACKAGES: dict[RecordName, tuple[ModuleType, ...]] = {
    "speed": (models, numerics, pair, theory),
    "mechanisms": (algebra, mechanics, numerics),
    "structures": (mechanics, numerics, structures),
    "bodies_and_lagrangians": (algebra, mechanics, numerics),
}
MechanismKind = Literal["rods", "gyroscopes"]
LINKS: dict[MechanismKind, tuple[int, ...]] = {"rods": (3, 6, 12, 24), "gyroscopes": (1, 3, 6, 12)}  # numbers of links
MECHANISM_ERROR = 1e-8  # rad, error of the timed runs of mechanisms
CHAIN_SIZES = (16, 64, 256)  # rotors in a chain
CHAIN_ERROR = 1e-6  # m, error of the timed runs of chains
Record = TypeVar("Record")


@dataclass(frozen=True)
class Measured:
    """The measurements of one tool on one mechanism, with processor times in s; a missing value is None.

    Attributes
    ----------
    kind, n, tool : MechanismKind, int, str
        The mechanism, its number of links, and the tool.
    ready, rhs, run : float or None
        Times until the equations can be evaluated, of one evaluation, and of a run with the error MECHANISM_ERROR.
    difference : float or None
        Relative difference of the tool's right-hand side from lagrotor's.
    by : str
        The solver that reached the error.
    reason : str
        The reason why a value is missing.
    """

    kind: MechanismKind
    n: int
    tool: str
    ready: float | None = None
    rhs: float | None = None
    difference: float | None = None
    run: float | None = None
    by: str = ""
    reason: str = ""


@dataclass(frozen=True)
class Decided:
    """The processor times in s of same_as (`ours`) and simplify (`theirs`) for a pair of formulations, and their answers. If
    simplify did not end, its answer says so and its time is the limit."""

    pair: str
    ours: float
    answer: str
    theirs: float
    their_answer: str

    @property
    def times(self) -> float:
        return self.theirs / self.ours


@dataclass(frozen=True)
class Comparison:
    """A record of mechanisms. `operations` are the numbers of operations of one evaluation, for each size in LINKS."""

    date: str
    digest: Mapping[str, str] | None
    machine: dict[str, Any]
    versions: dict[str, str]
    measured: list[Measured]
    decided: list[Decided]
    operations: dict[MechanismKind, list[int]]


@dataclass(frozen=True)
class Timed:
    """The measurement of one tool on a chain of n rotors.

    The setting reached the largest error `error` in m. `seconds` and `first` are the processor times in s of a run and of the
    first run, which may compile. If no setting reaches CHAIN_ERROR in time, `seconds` is None and `error` the smallest one
    reached. If the tool refused the chain, the error is infinite (null on record), and `reason` says why.
    """

    n: int
    tool: str
    setting: float
    error: float
    seconds: float | None
    first: float
    reason: str = ""


@cache
def code_digests(name: RecordName) -> dict[str, str]:
    """Return the SHA-256 digest of the code of each package that a record measures, by the name of the package. Comments,
    docstrings and line numbers do not change it."""
    return {
        package.__name__.removeprefix("lagrotor."): _digest(Path(package.__path__[0]))
        for package in MEASURED_PACKAGES[name]
    }


def _digest(folder: Path) -> str:
    """Return the digest of the modules in a folder, and of the kept programs, which are code without words."""
    digest = sha256()
    for file in sorted([*folder.rglob("*.py"), *folder.rglob(KEPT_SOURCES)]):
        code = file.read_text(encoding="utf-8") if file.name == KEPT_SOURCES else _code_of(file.read_bytes())
        digest.update(f"{file.relative_to(folder).as_posix()} {code}".encode())
    return digest.hexdigest()


@cache
def _code_of(source: bytes) -> str:
    """Return the code of a module as text, without docstrings; records share many modules."""
    return str(_code(ast.parse(source)))


def _code(node: object) -> object:
    """Return a syntax tree as nested tuples, without docstrings. Empty fields are omitted, because they differ between Python
    versions."""
    if isinstance(node, ast.AST):
        text = isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)  # a docstring
        fields = ((name, _code(value)) for name, value in ast.iter_fields(node) if value not in (None, []))
        return () if text else (type(node).__name__, *fields)
    return tuple(item for item in map(_code, node) if item) if isinstance(node, list) else repr(node)


def write_record(name: RecordName, data: Mapping[str, Any]) -> Path:
    """Write a record that was measured now, with the date of today and the digests of the present code; return its file."""
    made = {"date": datetime.now(UTC).date().isoformat(), "digest": code_digests(name), **data}
    return write_text(FILES[name], json.dumps(made, indent=1, ensure_ascii=False) + "\n")


def record_age(name: RecordName, date: str, digest: Mapping[str, str] | None) -> str:
    """Return a sentence with the date of a record, which also says in which packages the code has changed since."""
    if not isinstance(digest, Mapping):
        return f"The measurement is of {date}; the code that it measured is not on record."
    changed = [package for package, now in code_digests(name).items() if digest.get(package) != now]
    if not changed:
        return f"The measurement is of {date}, with the present code."
    return f"The measurement is of {date}; since then the code of {', '.join(changed)} has changed."


def recorded_speed() -> dict[str, Any]:
    """Return the record of speed: date, digest, machine, versions, throughput, at_error (error → method → time in s) and set_up
    (method → time in s). Raise LagrotorError if it is unreadable."""
    return _read("speed", dict)


def recorded_multiple(record: dict[str, Any], name: str, error: str, of: str) -> float | None:
    """Return the time of method `name` divided by the time of method `of`, both at an error; None if one never reaches it."""
    seconds = record["at_error"][error]
    return None if None in (seconds[name], seconds[of]) else float(seconds[name] / seconds[of])


def recorded_mechanisms() -> Comparison:
    """Return the record of mechanisms. Raises LagrotorError if it is unreadable."""
    return _read("mechanisms", _comparison)


def _comparison(data: dict[str, Any]) -> Comparison:
    measured = [Measured(**x) for x in data.pop("measured")]
    return Comparison(**data | {"measured": measured, "decided": [Decided(**x) for x in data["decided"]]})


def recorded_structures() -> tuple[dict[str, Any], list[Timed]]:
    """Return the record of chains, and its rows as `Timed`. Raises LagrotorError if it is unreadable."""
    return _read("structures", lambda data: (data, list(map(_timed, data["rows"]))))


def _timed(row: dict[str, Any]) -> Timed:
    return Timed(**row | {"error": math.inf if row["error"] is None else row["error"]})


def recorded_bodies_and_lagrangians() -> dict[str, Any]:
    """Return the record of mechanisms from bodies and from Lagrangians, times in s. Raises LagrotorError if it is unreadable."""
    return _read("bodies_and_lagrangians", dict)


def _read(name: RecordName, build: Callable[[Any], Record]) -> Record:
    try:
        return build(json.loads(FILES[name].read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LagrotorError(f"{FILES[name]} cannot be read ({error}): install lagrotor anew") from None
