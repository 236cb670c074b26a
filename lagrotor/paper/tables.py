"""Tables of the report and of notebooks."""

import re
from dataclasses import dataclass
from html import escape
from typing import TypeAlias

import sympy as sp


@dataclass(frozen=True)
class FigureLink:
    """A cell of a table that links to a figure of the report.

    Attributes
    ----------
    key : str
        Number of the figure as text, such as "19".
    """

    key: str


# Text, a formula, a link, or several of them one below the other.
Cell: TypeAlias = "str | sp.Basic | FigureLink | tuple[str | sp.Basic, ...]"

# sympy's MathML does not convert a symbol whose name is LaTeX.
_DOTTED = re.compile(r"<mi>\\dot\{(\w+)\}</mi>")


@dataclass(frozen=True)
class Table:
    """A table for the report; notebooks show it as HTML.

    Attributes
    ----------
    title : str
        Caption of the table.
    head : tuple[str, ...]
        Names of the columns.
    rows : tuple[tuple[Cell, ...], ...]
        The rows, each as long as `head`. A cell is text, a sympy object, a `FigureLink`, or a tuple of these that is shown
        as one below the other.
    note : str, default ''
        A sentence below the table on how the values were obtained.

    Examples
    --------
    >>> Table("Periods", ("length (m)", "period (s)"), (("1", "2.01"), ("2", "2.84"))).rows[1]
    ('2', '2.84')
    """

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
    # Notebooks align cells to the right by default, sentences included.
    return f'<{tag} style="text-align:left">{_inside(cell)}</{tag}>'


def _inside(cell: Cell) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_inside, cell))
    if isinstance(cell, sp.Basic):
        drawn = _DOTTED.sub(r"<mover><mi>\1</mi><mo>˙</mo></mover>", sp.mathml(cell, printer="presentation"))
        return f'<math displaystyle="true">{drawn}</math>'
    return escape(f"figure {cell.key}" if isinstance(cell, FigureLink) else cell)
