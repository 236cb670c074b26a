"""Comparisons with other tools on record, each made in one run of one machine, which is named: the displaced pair by every
method, mechanisms, and chains of rotors.

They are read here, so that what is shown is the same bytes everywhere. They are renewed in a checkout, where the other tools
are run: `python -m benchmarks.speed`, `python -m benchmarks.mechanisms --record`, `python -m benchmarks.structure_comparison`,
`python -m benchmarks.bodies_and_lagrangians --record`. Each record has its date and a digest of the code that it measured; the
digest is null in a record that is older than the digest.
"""

import ast
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any, Literal, TypeVar

from lagrotor import algebra, mechanics, models, numerics, pair, structures, theory
from lagrotor.errors import LagrotorError

SPEED, MECHANISMS, STRUCTURES, BODIES_AND_LAGRANGIANS = (
    Path(__file__).with_name(f"recorded_{name}.json")
    for name in ("speed", "mechanisms", "structures", "bodies_and_lagrangians")
)
RecordName = Literal["speed", "mechanisms", "structures", "bodies_and_lagrangians"]
MEASURED_PACKAGES = {
    "speed": (models, numerics, pair, theory),
    "mechanisms": (algebra, mechanics, numerics),
    "structures": (mechanics, numerics, structures),
    "bodies_and_lagrangians": (algebra, mechanics, numerics),
}
MechanismKind = Literal["rods", "gyroscopes"]
LINKS: dict[MechanismKind, tuple[int, ...]] = {"rods": (3, 6, 12, 24), "gyroscopes": (1, 3, 6, 12)}  # of the mechanisms
MECHANISM_ERROR = 1e-8  # rad, at which runs of mechanisms are timed
CHAIN_SIZES = (16, 64, 256)  # of the chains
CHAIN_ERROR = 1e-6  # m, at which runs of chains are timed
Record = TypeVar("Record")


@dataclass(frozen=True)
class Measured:
    """One tool on one mechanism, processor time in s; a reason in place of what was not measured.

    difference: of its right-hand side from lagrotor's, relative. by: what ran it to the error.
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
    """Processor time in s of same_as and of simplify, and their answers; where simplify did not end, the time it was given."""

    pair: str
    ours: float
    answer: str
    theirs: float
    their_answer: str

    @property
    def times(self) -> float:
        """How many times longer simplify takes."""
        return self.theirs / self.ours


@dataclass(frozen=True)
class Comparison:
    """date and digest; machine and versions; tools on mechanisms; pairs of formulations; on each of LINKS operations of one
    evaluation."""

    date: str
    digest: str | None
    machine: dict[str, Any]
    versions: dict[str, str]
    measured: list[Measured]
    decided: list[Decided]
    operations: dict[MechanismKind, list[int]]


@dataclass(frozen=True)
class Timed:
    """A tool on a chain of n rotors: its setting, error (m), processor time of a run and of the first, with compiling (s).

    seconds is None where no setting reaches CHAIN_ERROR before a run takes too long; error is then the least that was reached
    (infinite where it was refused; null on record), and reason why it stopped, where it did.
    """

    n: int
    tool: str
    setting: float
    error: float
    seconds: float | None
    first: float
    reason: str = ""


@cache
def code_digest(name: RecordName) -> str:
    """Return the SHA-256 of the code that a record measures, without comments, docstrings and line numbers."""
    digest = sha256()
    for folder in (Path(package.__path__[0]) for package in MEASURED_PACKAGES[name]):
        for file in sorted(folder.rglob("*.py")):
            name_in_package = file.relative_to(folder.parent).as_posix()
            digest.update(f"{name_in_package} {_code(ast.parse(file.read_bytes()))}".encode())
    return digest.hexdigest()


def _code(node: object) -> object:
    """Return the syntax tree as tuples. Empty fields are left out, since Python versions differ in these."""
    if isinstance(node, ast.AST):
        text = isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)  # such as a docstring
        fields = ((name, _code(value)) for name, value in ast.iter_fields(node) if value not in (None, []))
        return () if text else (type(node).__name__, *fields)
    return tuple(item for item in map(_code, node) if item) if isinstance(node, list) else repr(node)


def stamp(name: RecordName) -> dict[str, str]:
    """Return the date and the digest of a record that is measured today."""
    return {"date": datetime.now(UTC).date().isoformat(), "digest": code_digest(name)}


def record_age(name: RecordName, date: str, digest: str | None) -> str:
    """Return the sentence that says when a record was measured, and whether its code has changed since then."""
    if digest == code_digest(name):
        return f"The measurement is of {date}, with the present code."
    packages = ", ".join(package.__name__.removeprefix("lagrotor.") for package in MEASURED_PACKAGES[name])
    return f"The measurement is of {date}; the code that it measured ({packages}) has changed since then."


def recorded_speed() -> dict[str, Any]:
    """date, digest, machine, versions, at_error (error → method → s), set_up (method → s), throughput. Raises LagrotorError."""
    return _read(SPEED, dict)


def recorded_multiple(record: dict[str, Any], name: str, error: str, of: str) -> float | None:
    """Seconds of a method over those of another at the same error; None where one of them does not reach it."""
    seconds = record["at_error"][error]
    return None if None in (seconds[name], seconds[of]) else float(seconds[name] / seconds[of])


def recorded_mechanisms() -> Comparison:
    """Tools on mechanisms. Raises LagrotorError if it is unreadable."""
    return _read(MECHANISMS, _comparison)


def _comparison(data: dict[str, Any]) -> Comparison:
    measured = [Measured(**x) for x in data.pop("measured")]
    return Comparison(**data | {"measured": measured, "decided": [Decided(**x) for x in data["decided"]]})


def recorded_structures() -> tuple[dict[str, Any], list[Timed]]:
    """Chains of rotors: date, digest, machine and versions, and the rows. Raises LagrotorError if it is unreadable."""
    return _read(STRUCTURES, lambda data: (data, list(map(_timed, data["rows"]))))


def _timed(row: dict[str, Any]) -> Timed:
    return Timed(**row | {"error": math.inf if row["error"] is None else row["error"]})


def recorded_bodies_and_lagrangians() -> dict[str, Any]:
    """Mechanisms from bodies and from their Lagrangian: date, digest, machine, longest (s, of one tool), rows of mechanism, tool,
    ready and rhs in s, difference, reason.

    Raises LagrotorError if it is unreadable.
    """
    return _read(BODIES_AND_LAGRANGIANS, dict)


def _read(file: Path, build: Callable[[Any], Record]) -> Record:
    try:
        return build(json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LagrotorError(f"{file} cannot be read ({error}): install lagrotor anew") from None
