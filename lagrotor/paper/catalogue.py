"""The scope of the audit as data: every equation, claim and figure of the paper, in its order."""

import re
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError

_FOLDER = Path(__file__).parent
# The paper's headings over its equations.
SECTIONS = {
    "2": "Preliminary analysis",
    "3": "Rigid body simulation",
    "4": "Modeling and validation",
    "5.2": "Free precessions of the anti-spin rotor pair",
    "5.2.1": "Confirmation of theory",
    "5.3": "Natural precession rate of the coupled oscillators",
    "6": "Conclusion",
}


@dataclass(frozen=True)
class Equation:
    """One printed equation: `latex` as the source prints it, `number` the paper's own where it gives one."""

    id: str
    section: str
    title: str
    latex: str
    number: int | None = None


@dataclass(frozen=True)
class Claim:
    """What the paper states in words: `equations` are the ids of those that it is about."""

    id: str
    section: str
    text: str
    equations: tuple[str, ...] = ()

    @property
    def figures(self) -> tuple[str, ...]:
        """Numbers of the figures that the text names."""
        named = re.findall(r"figures? (\d+(?:, \d+)*)", self.text)
        return tuple(number for group in named for number in group.split(", "))


@dataclass(frozen=True)
class Figure:
    """One figure: `kind` is diagram, simulated, analytical or both; `equations` are the ids of those that it shows."""

    number: int
    kind: str
    section: str
    shows: str
    equations: tuple[str, ...] = ()


def _rows(name: str, key: str) -> list[dict[str, Any]]:
    with (_FOLDER / f"{name}.toml").open("rb") as file:
        rows = tomllib.load(file)[key]
    return [{name: tuple(value) if isinstance(value, list) else value for name, value in row.items()} for row in rows]


@cache
def equations() -> dict[str, Equation]:
    """Every equation by id, in the paper's order."""
    return {row["id"]: Equation(**row) for row in _rows("equations", "equation")}


@cache
def claims() -> dict[str, Claim]:
    """Every claim by id, in the paper's order."""
    return {row["id"]: Claim(**row) for row in _rows("claims", "claim")}


@cache
def figures() -> dict[int, Figure]:
    """Every figure by number."""
    return {row["number"]: Figure(**row) for row in _rows("figures", "figure")}


def equation(identifier: str) -> Equation:
    """One equation; refuses an id that the paper does not have."""
    try:
        return equations()[identifier]
    except KeyError:
        raise InputError(
            f"equation {identifier!r} is not in the catalogue: ids run from {next(iter(equations()))} "
            f"to {next(reversed(equations()))}"
        ) from None
