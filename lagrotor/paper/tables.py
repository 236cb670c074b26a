"""Tables that the report shows: runs side by side (scripts m…), and what holds beyond the paper (scripts p…)."""

from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

from . import scripts


@dataclass(frozen=True)
class FigureLink:
    """A cell that leads to the figure with this key."""

    key: str


# Text, a formula, a link, or several of them one below the other.
Cell: TypeAlias = "str | sp.Basic | FigureLink | tuple[str | sp.Basic, ...]"


@dataclass(frozen=True)
class Table:
    """A table: every row as long as `head`; `note` says how it was made."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""


def tables(prefix: str = "m") -> list[Table]:
    """Every table of the derivations with this prefix, in the order of the scripts."""
    found: list[Table] = []
    for stem in scripts.names("derivations", prefix):
        found += scripts.run("derivations", stem)["tables"]
    return found
