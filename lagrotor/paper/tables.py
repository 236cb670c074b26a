"""Tables that the report shows: runs side by side and what holds beyond the paper."""

import re
from dataclasses import dataclass
from html import escape
from typing import TypeAlias

import sympy as sp


@dataclass(frozen=True)
class FigureLink:
    """A cell that leads to the figure with this key."""

    key: str


# Text, a formula, a link, or several of them one below the other.
Cell: TypeAlias = "str | sp.Basic | FigureLink | tuple[str | sp.Basic, ...]"

# A letter named in LaTeX, which sympy's MathML does not read.
_DOTTED = re.compile(r"<mi>\\dot\{(\w+)\}</mi>")


@dataclass(frozen=True)
class Table:
    """A table: every row as long as `head`; `note` says how it was made."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""

    def _repr_html_(self) -> str:
        lines = "".join(f"<tr>{''.join(_html(cell, 'td') for cell in row)}</tr>" for row in self.rows)
        head = "".join(_html(name, "th") for name in self.head)
        note = f"<p><small>{escape(self.note)}</small></p>" if self.note else ""
        return f"<table><caption>{escape(self.title)}</caption><tr>{head}</tr>{lines}</table>{note}"


def _html(cell: Cell, tag: str) -> str:
    # Notebooks set numbers to the right, and sentences with them.
    return f'<{tag} style="text-align:left">{_inside(cell)}</{tag}>'


def _inside(cell: Cell) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_inside, cell))
    if isinstance(cell, sp.Basic):
        drawn = _DOTTED.sub(r"<mover><mi>\1</mi><mo>˙</mo></mover>", sp.mathml(cell, printer="presentation"))
        return f'<math displaystyle="true">{drawn}</math>'
    return escape(f"figure {cell.key}" if isinstance(cell, FigureLink) else cell)
