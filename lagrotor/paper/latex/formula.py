"""The reading of a formula: every token is accounted for, or the reading names the token where it stopped and what would help."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from lagrotor.paper.latex import usage
from lagrotor.paper.latex.boxes import Box, FormulaError, boxes
from lagrotor.paper.latex.notation import Notation, stem_of
from lagrotor.paper.latex.read_expression import Grammar
from lagrotor.paper.latex.read_statements import read_statements
from lagrotor.paper.latex.rows import all_boxes
from lagrotor.paper.latex.statements import PrintedStatement

EVERY = 500  # equations whose reading is said together
_T = TypeVar("_T")
_NOTHING = Notation()


@dataclass(frozen=True)
class Reading:
    """The statements of a formula; none where it is not read. stop: (token, the entry or the words that would allow it)."""

    statements: tuple[PrintedStatement, ...] = ()
    stop: tuple[str, str] | None = None

    @property
    def guesses(self) -> tuple[str, ...]:
        """Nothing: no reading rests on a guess."""
        return ()

    @property
    def whole(self) -> bool:
        """Whether it was read."""
        return self.stop is None and bool(self.statements)


def _lowered(row: list[Box]) -> Iterator[str]:
    """The letters that stand in an index, in a mark, in a ket or by themselves on a side: no factors."""
    for box in all_boxes(row):
        raised = box.sup or [] if box.name != "e" else []
        held = [*(box.sub or []), *raised] if box.kind != "partial" else []
        if box.kind == "bracket" and {box.name, box.closing} & {"|", r"\langle", r"\rangle", "<", ">"}:
            held += box.parts[0]
        if box.kind == "binomial":
            held += [each for part in box.parts for each in part]
        yield from (each.name for each in held if each.kind == "letter")


def read_formula(
    latex: str, notation: Notation | usage.Notation = _NOTHING, lead: str = "", subject: str = ""
) -> Reading:
    """The reading of a displayed formula; lead: the left side of the row before, which it continues."""
    source = f"{lead} {latex}" if lead else latex
    if isinstance(notation, Notation):
        letters = notation.indices | notation.positive | notation.complex
        said = usage.Notation(functions=notation.functions, letters=letters, numbers=notation.numbers)
        notation = usage.notation_of([latex], said)
    reader = Grammar(source, notation)
    try:
        row = reader.notation.boxes(source)
        reader.row, reader.lowered = row, frozenset(_lowered(row))
        statements = tuple(read_statements(reader, row))
    except FormulaError as stop:
        return Reading(stop=(stop.what, stop.help))
    except RecursionError:
        return Reading(stop=("the formula is nested too deeply", "write it in parts"))
    if not statements:
        return Reading(stop=("there is no formula", "keep it aside"))
    return Reading(statements)


def letters_printed(latex: str) -> set[str]:
    """The letters of a formula, whether it is read or not; none where it falls into no parts."""
    try:
        return {stem_of(box) for box in all_boxes(boxes(latex)) if box.kind == "letter"}
    except (FormulaError, RecursionError):
        return set()


def with_progress(what: str, rows: Sequence[_T], progress: Callable[[str], None] | None) -> Iterator[_T]:
    """The rows; before each `EVERY` of them it is said what is done with them. Fewer go by without a word."""
    for place, row in enumerate(rows):
        if progress and place % EVERY == 0 and len(rows) > EVERY:
            progress(f"{what} equations {place + 1:,} to {min(place + EVERY, len(rows)):,}")
        yield row
