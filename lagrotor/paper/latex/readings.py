"""The readings of a paper's equations beside their print: confirmed, unconfirmed, written by hand, or where they stopped."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.latex.formula import with_progress
from lagrotor.paper.latex.notation import KINDS, Notation, declared_notation, propose
from lagrotor.paper.latex.printed import paper_notation, read_print


@dataclass(frozen=True)
class EquationReading:
    """The reading of one equation.

    status: confirmed, unconfirmed, by hand, changed (the print has changed since), gone (the source no longer has it), aside
    (read, and nothing in it is compared), not read. said: its lines, and statements that are kept aside, as text. stopped,
    helps: the token where a reading stopped, and the way out. number: the printed one, where it is another than the id.
    """

    id: str
    title: str
    print: str
    status: str
    said: tuple[str, ...] = ()
    stopped: str = ""
    helps: str = ""
    number: str = ""

    def as_data(self) -> dict[str, Any]:
        """Return the reading as an object of JSON."""
        return asdict(self)


def readings(paper: Catalogue, progress: Callable[[str], None] | None = None) -> Iterator[EquationReading]:
    """Read every equation, in the paper's order.

    Parameters
    ----------
    paper : Catalogue
        The paper.
    progress : callable, optional
        Called with a sentence before each `EVERY` equations.

    Raises
    ------
    InputError
        If the table [notation] cannot be read.
    """
    equations = list(paper.equations.values())
    notation = paper_notation((e.latex for e in equations), paper.about.notation, str(paper.folder / "paper.toml"))
    for entry in with_progress("read", equations, progress):
        moved = entry.number and entry.read != "gone" and str(entry.number) != entry.id
        yield replace(_reading(entry, notation), number=str(entry.number) if moved else "")


def _reading(entry: Equation, notation: Notation) -> EquationReading:
    shown = EquationReading(entry.id, entry.title, entry.latex, "gone", _said(entry.line))
    if entry.read == "gone":
        return shown
    if entry.line:
        status = "by hand" if not entry.read else "confirmed" if entry.is_confirmed else "unconfirmed"
        status = "changed" if entry.changed and status == "unconfirmed" else status
        return replace(shown, status=status, said=(*shown.said, *entry.aside))
    print_ = read_print(entry.latex, notation, entry.lead)
    if print_.stop is not None:
        return replace(shown, status="not read", stopped=print_.stop[0], helps=print_.stop[1])
    if print_.lines:  # [notation] has changed since init
        return replace(shown, status="unread so far", said=_said(print_.lines))
    return replace(shown, status="aside", said=print_.aside)


@dataclass(frozen=True)
class LetterKind:
    """The kind of one letter: declared in [notation], or proposed by the formula `evidence`."""

    letter: str
    kind: str
    declared: bool
    evidence: str = ""


def letter_kinds(paper: Catalogue) -> list[LetterKind]:
    """Return the letters of a paper that are no plain real numbers, the declared ones first."""
    table = declared_notation(paper.about.notation, str(paper.folder / "paper.toml"))
    kinds = [LetterKind(letter, kind, True) for kind in KINDS for letter in sorted(getattr(table, kind))]
    known = {each.letter for each in kinds}
    proposals = propose(entry.latex for entry in paper.equations.values())
    return kinds + [LetterKind(p.letter, p.kind, False, p.evidence) for p in proposals if p.letter not in known]


def _said(lines: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Printed lines as text, with the order that each claims."""
    claimed = (f" + O({row['small']}**{row.get('order', 0) + 1})" if row.get("small") else "" for row in lines)
    texts = (" = ".join([row["quantity"], *map(str, row.get("members", ()))]) for row in lines)
    return tuple(map("".join, zip(texts, claimed, strict=True)))


def as_printed(text: str, printed: str) -> str:
    """A reading in which decimals stand as in the print, and units without their prefix: 981/100*unit_m is 9.81*m."""

    def decimal(match: re.Match[str]) -> str:
        number = Fraction(match[0])
        digits = str(Decimal(number.numerator) / number.denominator)
        return digits if digits in printed.replace("{,}", "").replace(",", ".") else match[0]

    return re.sub(r"(?<![\w.])\d+/\d+(?![\w.])", decimal, text).replace("unit_", "")


def typeset_lines(paper: Catalogue, identifier: str) -> tuple[str, ...]:
    """The printed lines of an equation as they are judged, in LaTeX; none where a letter of theirs is not declared."""
    try:
        lines = paper.lines(identifier)
    except InputError:
        return ()
    return tuple(" = ".join([line.quantity, *map(latex, line.members)]) for line in lines)
