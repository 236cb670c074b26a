"""What `paper.toml` says of a paper: its title, authors, sections and results, and what its report shows."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from string import Formatter
from typing import Any

from lagrotor.errors import InputError


@dataclass(frozen=True)
class HeadlineEntry:
    """One result that the report begins with: `text` has numbers of the run in braces.

    {C02[rate]:.3f} is a number of a claim's test, {figure 3[period (s)]:.2f} one read off a figure, {2.1} the verdict on an
    equation, {2.1[correction]} that on its correction. ids: what it is shown in. formula: the equation whose derived or
    corrected form is shown; quantity: of which of its lines, in LaTeX. figure: the one that is shown beside it, "figure 19".
    """

    title: str
    text: str
    ids: tuple[str, ...] = ()
    formula: str = ""
    quantity: str = ""
    figure: str = ""


@dataclass(frozen=True)
class Opening:
    """One of the lines that the report opens with: what the paper did, what is right, what is wrong.

    text: with numbers in braces as a headline's; {equations}, {claims}, {holding} and {refuted} are counts.
    """

    label: str
    text: str


@dataclass(frozen=True)
class ReportPart:
    """A part of the report: what some derivations, by the beginnings of their names, and figures, by their letter, show.

    remarks, tables: beginnings of the names of derivations. figures: the letter before their numbers. front: whether it
    stands on the report's first page.
    """

    name: str
    heading: str
    remarks: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    figures: tuple[str, ...] = ()
    front: bool = False


USUAL_PARTS = (
    ReportPart("findings", "Findings", remarks=("",)),
    ReportPart("figures", "Figures", figures=("",)),
    ReportPart("tables", "Tables", tables=("",)),
)


@dataclass(frozen=True)
class TitlePage:
    """The whole of `paper.toml`.

    sections: number → heading. results: ids of the equations in which the paper's work ends. equations_in, claims_in:
    beginnings of the names of the derivations that state equations, and that show tests of claims. model: a module with a
    function `interactive() -> str`, a section of the page in HTML. letters: names of those that the notation begins with.
    notation: how its formulas are to be read, where the print leaves it open. preamble: what its LaTeX needs besides amsmath.
    system: a derivation stated as text, `coordinates`, `L`, `constraints` (`lagrotor.paper.latex.stated_system`).
    """

    title: str
    authors: tuple[str, ...] = ()
    sections: Mapping[str, str] = field(default_factory=dict)
    results: tuple[str, ...] = ()
    equations_in: str = ""
    claims_in: str = ""
    model: str = ""
    letters: tuple[str, ...] = ()
    opening: tuple[Opening, ...] = ()
    headline: tuple[HeadlineEntry, ...] = ()
    part: tuple[ReportPart, ...] = USUAL_PARTS
    notation: Mapping[str, Any] = field(default_factory=dict)
    preamble: str = ""
    system: Mapping[str, Any] = field(default_factory=dict)


def toml(file: Path) -> dict[str, Any]:
    """A TOML file; raises InputError, with the line, where it cannot be read."""
    try:
        with file.open("rb") as opened:
            return tomllib.load(opened)
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}: every paper has this file") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: {error}") from None


def row(kind: type, given: Any, where: str) -> Any:
    """A row of a TOML file as a dataclass; raises InputError that names a key which is missing or means nothing."""
    known = {entry.name: entry for entry in fields(kind)}
    if not isinstance(given, dict):
        raise InputError(
            f"{where}: {given!r} is no table: write {kind.__name__.lower()} as [[{kind.__name__.lower()}]]"
        )
    if unknown := sorted(given.keys() - known.keys()):
        raise InputError(f"{where}: {unknown[0]!r} means nothing here: the keys are {', '.join(known)}")
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
    try:
        return kind(**values)
    except TypeError as error:
        missing = str(error).rpartition("missing ")[2]
        raise InputError(f"{where}: {missing} is missing") from None


def title_page(folder: Path) -> TitlePage:
    """Reads `paper.toml`. Raises InputError where the folder has none, or it says what means nothing."""
    file = folder / "paper.toml"
    if not file.is_file():
        if folder.is_file():
            raise InputError(
                f"{folder} is a file: give a paper's folder; `lagrotor init my-paper --from {folder.name}` makes one"
            )
        raise InputError(
            f"{folder} is no paper: it has no paper.toml; `lagrotor init {folder.name or 'my-paper'}` makes one"
        )
    given = toml(file)
    for key, kind in (("opening", Opening), ("headline", HeadlineEntry), ("part", ReportPart)):
        if key in given:
            given[key] = [_checked(row(kind, each, f"{file}: {key}"), f"{file}: {key}") for each in given[key]]
    return row(TitlePage, given, str(file))


def _checked(found: Any, where: str) -> Any:
    """The same; raises InputError where its text has a brace that is not closed."""
    try:
        list(Formatter().parse(getattr(found, "text", "")))
    except ValueError as error:
        raise InputError(
            f"{where}: text: {error}: numbers go in braces, {{C01[name]:.3f}}; a brace alone is {{{{"
        ) from None
    return found
