r"""The reading of a formula: every token is accounted for, or there is none, and it says where it stopped and what would help.

What the print leaves open and custom settles, the reading takes by custom and says so (`guesses`); what custom does not settle
is not read.
"""

from dataclasses import dataclass

from lagrotor.paper.source.boxes import FormulaError, boxes
from lagrotor.paper.source.read_expression import Grammar
from lagrotor.paper.source.read_statements import PrintedStatement, read_statements
from lagrotor.paper.source.usage import Notation


@dataclass(frozen=True)
class Reading:
    """The statements of a formula; none where it is not read. stop: (token, what would help); guesses: what custom settled."""

    statements: tuple[PrintedStatement, ...] = ()
    guesses: tuple[str, ...] = ()
    stop: tuple[str, str] | None = None

    @property
    def whole(self) -> bool:
        """Whether it was read."""
        return self.stop is None and bool(self.statements)


def read_formula(latex: str, notation: Notation | None = None, lead: str = "") -> Reading:
    """The reading of a displayed formula; lead: the left side of the row before, which it continues."""
    source = f"{lead} {latex}" if lead else latex
    reader = Grammar(source, notation or Notation())
    try:
        statements = tuple(read_statements(reader, boxes(source)))
    except FormulaError as stop:
        return Reading(stop=(stop.what, stop.help))
    except RecursionError:
        return Reading(stop=("the formula is nested too deeply", "write it in parts"))
    if not statements:
        return Reading(stop=("there is no formula", "keep it aside"))
    return Reading(statements, tuple(dict.fromkeys(reader.guesses)))
