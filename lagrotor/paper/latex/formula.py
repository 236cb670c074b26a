"""The reading of a formula. A reading uses every token, or it says where it stopped and what to write instead."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from lagrotor.paper.latex.boxes import Box, FormulaError, all_boxes, boxes, stem_of
from lagrotor.paper.latex.grammar import Grammar
from lagrotor.paper.latex.notation import Notation
from lagrotor.paper.latex.statements import PrintedStatement, read_statements

_NOTHING = Notation()


@dataclass(frozen=True)
class Reading:
    """The statements of a formula. A formula that is not read has none.

    stop: (reason, remedy) of a reading that stopped, None for a complete reading.
    """

    statements: tuple[PrintedStatement, ...] = ()
    stop: tuple[str, str] | None = None

    @property
    def whole(self) -> bool:
        """True if the formula was read."""
        return self.stop is None and bool(self.statements)


def read_formula(latex: str, notation: Notation = _NOTHING, lead: str = "") -> Reading:
    """Read a displayed formula whose macros are expanded. If it continues a row, `lead` is the left side of that row."""
    source = f"{lead} {latex}" if lead else latex
    try:
        row = boxes(source)
        lowered = frozenset(b.name for box in all_boxes(row) for b in box.sub or () if b.kind == "letter")
        reader = Grammar(source, notation, frozenset(_alone(row)), lowered)
        statements = tuple(read_statements(reader, row))
    except FormulaError as stop:
        return Reading(stop=(stop.what, stop.help))
    except RecursionError:
        return Reading(stop=("the formula is nested too deeply", "write it in parts"))
    if not statements:
        return Reading(stop=("there is no formula", "leave the display out"))
    return Reading(statements)


def _alone(row: Iterable[Box]) -> Iterator[str]:
    """Yield the names of the symbols outside subscripts and superscripts, except a Δ or δ before another symbol."""
    for box, following in pairwise([*row, None]):
        if (
            box is not None
            and box.kind == "letter"
            and not (following and following.kind == "letter" and box.name in ("Delta", "delta"))
        ):
            yield stem_of(box)
        for inner in box.contents if box else ():
            yield from _alone(inner)


@lru_cache(maxsize=10_000)
def letters_printed(latex: str) -> frozenset[str]:
    """Return the names of all symbols in a formula, even if its reading stops; none if it cannot be split into boxes."""
    try:
        return frozenset(stem_of(box) for box in all_boxes(boxes(latex)) if box.kind == "letter")
    except (FormulaError, RecursionError):
        return frozenset()
