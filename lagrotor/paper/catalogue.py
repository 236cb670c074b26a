"""The scope of the audit as data: every equation, claim and figure of the paper, in its order."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
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
class Line:
    """One printed line `quantity = member = member …`, each member an expression in the paper's letters.

    quantity: what the line is about, in LaTeX. order, small: where it is claimed through small**order only. within: for a
    number read off a run, half a unit of its last printed digit, relative. scene: values that the text gives for this line.
    names: the line only introduces a letter.
    """

    quantity: str
    members: tuple[Any, ...] = ()
    order: int = 0
    small: Any = None
    within: Any = None
    scene: Mapping[Any, Any] = field(default_factory=dict)
    names: bool = False


@dataclass(frozen=True)
class Equation:
    """One printed equation: `latex` as the source prints it, `number` the paper's own where it gives one.

    line: its printed lines as written in the catalogue. reading: how they were read, where sympy's parser of LaTeX does not
    read them. letters: what the text around the equation says of its letters. refers: letter → id of the equation that
    defines it, whose derived side stands for it. measured: the equation is a number read off a run.
    """

    id: str
    section: str
    title: str
    latex: str
    number: int | None = None
    line: tuple[Mapping[str, Any], ...] = ()
    reading: str = ""
    letters: Mapping[str, str] = field(default_factory=dict)
    refers: Mapping[str, str] = field(default_factory=dict)
    measured: bool = False

    @property
    def declared(self) -> dict[str, Any]:
        """The letters that the equation's section has besides the glossary's, by name."""
        from lagrotor.paper.letters import declared

        return declared(_letters(self.section))

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """The printed lines as expressions. Raises InputError where one cannot be read."""
        from lagrotor.paper.letters import read

        names = self.declared
        for letter, meaning in self.letters.items():
            names[letter] = read(meaning, names, f"equation {self.id}, letter {letter}")
        return tuple(_line(row, names, f"equation {self.id}") for row in self.line)


def _line(row: Mapping[str, Any], names: Mapping[str, Any], where: str) -> Line:
    from lagrotor.paper.letters import components, read

    def read_off(digits: str) -> Any:
        number = read(digits, {}, where)
        return read("1", {}, where) / (2 * number * 10 ** len(digits.partition(".")[2]))

    scene = [(read(name, names, where), read(value, names, where)) for name, value in row.get("scene", {}).items()]
    return Line(
        quantity=row["quantity"],
        members=tuple(read(member, names, where) for member in row.get("members", ())),
        order=row.get("order", 0),
        small=read(row["small"], names, where) if "small" in row else None,
        within=read_off(row["read_off"]) if "read_off" in row else None,
        scene=dict(zip(*(components(side) for side in zip(*scene, strict=True)), strict=True)) if scene else {},
        names=row.get("names", False),
    )


@cache
def _letters(section: str) -> Mapping[str, str]:
    """The letters that a section has besides the glossary's, kind → names."""
    with (_FOLDER / "equations.toml").open("rb") as file:
        found: Mapping[str, str] = tomllib.load(file).get("letters", {}).get(section, {})
    return found


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
