"""The readings of a paper's equations beside their print: confirmed, unconfirmed, written by hand, or where they stopped."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from typing import Any

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.catalogue import Catalogue, Equation
from lagrotor.paper.latex.formula import with_progress
from lagrotor.paper.latex.printed import paper_notation, read_print
from lagrotor.paper.latex.usage import Notation


@dataclass(frozen=True)
class EquationReading:
    """How one equation was read.

    status: confirmed, unconfirmed, by hand, changed (the print has changed since), gone (the source no longer has it), aside
    (read, and nothing in it is compared), not read. said: its lines and what is kept aside, as text. guesses: what custom
    settled; stopped, helps: where a reading stopped and what would help. number: the printed one, where it is another than the
    id, which stays.
    """

    id: str
    title: str
    print: str
    status: str
    said: tuple[str, ...] = ()
    guesses: tuple[str, ...] = ()
    stopped: str = ""
    helps: str = ""
    number: str = ""

    def as_data(self) -> dict[str, Any]:
        """As an object of JSON."""
        return asdict(self)


def readings(paper: Catalogue, progress: Callable[[str], None] | None = None) -> Iterator[EquationReading]:
    """The reading of every equation, in the paper's order. Raises InputError for a [notation] that means nothing.

    progress: called with what is done next, before each `EVERY` equations.
    """
    equations = list(paper.equations.values())
    notation = paper_notation((e.latex for e in equations), paper.about.notation, str(paper.folder / "paper.toml"))
    for entry in with_progress("read", equations, progress):
        moved = entry.number and entry.read != "gone" and str(entry.number) != entry.id
        yield replace(_reading(entry, notation), number=str(entry.number) if moved else "")


def _reading(entry: Equation, notation: Notation) -> EquationReading:
    said = _said(entry.line)
    if entry.read == "gone":
        return EquationReading(entry.id, entry.title, entry.latex, "gone", said)
    if entry.line:
        status = "by hand" if not entry.read else "confirmed" if entry.is_confirmed else "unconfirmed"
        status = "changed" if entry.changed and status == "unconfirmed" else status
        guesses = entry.guesses
        if guesses and status == "unconfirmed":  # what [notation] says since then
            made = read_print(entry.latex, notation, entry.lead, entry.subject)
            now = _said(made.lines)
            guesses = made.guesses if now == said else (*guesses, "[notation] reads it otherwise now: repeat init")
        return EquationReading(entry.id, entry.title, entry.latex, status, (*said, *entry.aside), guesses)
    made = read_print(entry.latex, notation, entry.lead, entry.subject)
    if made.stop is not None:
        stopped, helps = made.stop
        return EquationReading(entry.id, entry.title, entry.latex, "not read", stopped=stopped, helps=helps)
    if made.lines:
        return EquationReading(entry.id, entry.title, entry.latex, "unread so far", _said(made.lines), made.guesses)
    return EquationReading(entry.id, entry.title, entry.latex, "aside", made.aside, made.guesses)


def _said(lines: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """Printed lines as text, with the order that each claims."""
    claimed = (f" + O({row['small']}**{row.get('order', 0) + 1})" if row.get("small") else "" for row in lines)
    texts = (" = ".join([row["quantity"], *map(str, row.get("members", ()))]) for row in lines)
    return tuple(map("".join, zip(texts, claimed, strict=True)))


def as_printed(text: str, printed: str) -> str:
    """Return a reading with decimals as in the print, and units without their prefix: 981/100*unit_m is 9.81*m.

    A fraction is a whole quotient of two numbers: of x**2/2 and x/3/4 no part is.
    """
    plain = printed.replace("{,}", "").replace(",", ".")
    decimals = {Fraction(digits): digits for digits in re.findall(r"\d+\.\d+", plain)}
    fraction = r"(?<![\w./])(?<!\*\*)\d+/\d+(?![\w./]|\*\*)"
    return re.sub(fraction, lambda match: decimals.get(Fraction(match[0]), match[0]), text).replace("unit_", "")


def typeset_lines(paper: Catalogue, identifier: str) -> tuple[str, ...]:
    """The printed lines of an equation as they are judged, in LaTeX; none where a letter of theirs is not declared."""
    try:
        lines = paper.lines(identifier)
    except InputError:
        return ()
    return tuple(" = ".join([line.quantity, *map(latex, line.members)]) for line in lines)
