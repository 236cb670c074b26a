"""Tables that the report shows: figures of several runs side by side, made by the scripts m… in derivations/."""

from dataclasses import dataclass

from . import scripts


@dataclass(frozen=True)
class Table:
    """A table of plain text: every row as long as `head`; `note` says how it was made."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def tables() -> list[Table]:
    """Every table, in the order of the scripts."""
    found: list[Table] = []
    for stem in scripts.names("derivations", "m"):
        found += scripts.run("derivations", stem)["tables"]
    return found
