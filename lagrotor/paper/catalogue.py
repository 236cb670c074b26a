"""The catalogue of a paper: `paper.toml`, its equations, claims and figures in its order, and its symbols."""

import json
import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, fields
from functools import cached_property
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from string import Formatter
from types import ModuleType
from typing import Any, TypeVar

from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError
from lagrotor.files import path_of
from lagrotor.mechanics.glossary import Entry, Glossary, latex
from lagrotor.paper.grammar import Letters, Line, components, declared, read, read_line
from lagrotor.paper.plain_text import from_latex
from lagrotor.paper.scripts import importable
from lagrotor.result_display import Printed


@dataclass(frozen=True)
class HeadlineEntry:
    """A result at the beginning of the report; `text` contains computed numbers in braces.

    {C02[rate]:.3f} is a number of a claim's test, and {figure 3[period (s)]:.2f} a number of a figure. {2.1} is the verdict on
    an equation, and {2.1[correction]} the verdict on its correction. `ids` are the equations and claims of the result.
    `formula` is the id of an equation whose derived side is shown, in its line for `quantity` (LaTeX). `figure`, such as
    "figure 19", is shown beside the text.
    """

    title: str
    text: str
    ids: tuple[str, ...] = ()
    formula: str = ""
    quantity: str = ""
    figure: str = ""


@dataclass(frozen=True)
class Opening:
    """One line of the report's opening; the text may contain the counts {equations}, {claims}, {holding} and {refuted}."""

    label: str
    text: str


@dataclass(frozen=True)
class ReportPart:
    """A part of the report.

    `remarks` and `tables` are prefixes of the names of derivations whose remarks or tables the part shows. `figures` are the
    letters before the numbers of its figures. If `front` is True, the part stands on the report's first page.
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
    """The content of `paper.toml`.

    `sections` maps numbers to headings; `results` are the ids of the paper's main equations. `equations_in` and `claims_in` are
    the prefixes of the names of derivations that state equations and test claims. `model` is a module whose `interactive() ->
    str` gives a section of the page in HTML. `letters` are the first symbols of the notation. `notation` declares how ambiguous
    formulas are read, `preamble` has LaTeX besides amsmath, and `system` describes a derivation
    (`lagrotor.paper.latex.stated_system`).
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
    """Return the content of a TOML file; raise InputError, with the line, if it cannot be read."""
    try:
        with file.open("rb") as opened:
            return tomllib.load(opened)
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}: every paper needs this file") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: {error}") from None


def row(kind: type, table: Any, where: str) -> Any:
    """Convert a table of a TOML file to a dataclass of type `kind`. Raise InputError that names a missing or unknown key."""
    columns = {entry.name: entry for entry in fields(kind)}
    if not isinstance(table, dict):
        raise InputError(
            f"{where}: {table!r} is not a table: write {kind.__name__.lower()} as [[{kind.__name__.lower()}]]"
        )
    if unknown := sorted(table.keys() - columns.keys()):
        raise InputError(f"{where}: {unknown[0]!r} is not a key: the keys are {', '.join(columns)}")
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in table.items()}
    try:
        return kind(**values)
    except TypeError as error:
        missing = str(error).rpartition("missing ")[2]
        raise InputError(f"{where}: {missing} is missing") from None


def title_page(folder: Path) -> TitlePage:
    """Read `paper.toml` in a folder; raise InputError if it is missing or has an unknown key."""
    file = folder / "paper.toml"
    if not file.is_file():
        if folder.is_file():
            raise InputError(
                f"{folder} is a file: give a paper's folder; `lagrotor init my-paper --from {folder.name}` makes one"
            )
        raise InputError(
            f"{folder} is not a paper: it has no paper.toml; `lagrotor init {folder.name or 'my-paper'}` makes one"
        )
    page = toml(file)
    for key, kind in (("opening", Opening), ("headline", HeadlineEntry), ("part", ReportPart)):
        if key in page:
            page[key] = [_check_braces(row(kind, entry, f"{file}: {key}"), f"{file}: {key}") for entry in page[key]]
    return row(TitlePage, page, str(file))


def _check_braces(entry: Any, where: str) -> Any:
    """Return the entry; raise InputError if a brace in its text is not closed."""
    try:
        list(Formatter().parse(getattr(entry, "text", "")))
    except ValueError as error:
        raise InputError(
            f"{where}: text: {error}: write a number as {{C01[name]:.3f}} and a single brace as {{{{"
        ) from None
    return entry


Row = TypeVar("Row", bound="Equation | Claim | Figure")
_CLAIM = re.compile(r"C\d+")
# The keys of a printed line.
_LINE = ("quantity", "members", "order", "small", "read_off", "scene", "names")


@dataclass(frozen=True)
class Equation(Printed):
    """One printed equation; `latex` is its source, `number` its number in the paper.

    `line` has the printed lines as the catalogue writes them; `reading` is a remark on how they were read. `letters` are
    meanings that the text around the equation gives to symbols. `refers` maps a symbol to the id of the equation that defines
    it. `measured` is True for a number read off a simulation. `place` is the heading in the paper, if `section` comprises more
    than this heading.

    Lines read from LaTeX have `read` "unconfirmed", "confirmed" or, if the source no longer has the equation, "gone"; `print`
    is a hash of the confirmed lines. `label` is the equation's name in the source, `lead` the left side of the row that it
    continues. `aside` has statements that are not compared, `changed` the print before the source changed.
    """

    _shown = (
        ("equation", "id"),
        ("section", "section"),
        ("title", "title"),
        ("print", lambda e: from_latex(e.latex)),
    )

    id: str
    section: str
    title: str
    latex: str
    number: int | str | None = None
    line: tuple[Mapping[str, Any], ...] = ()
    reading: str = ""
    letters: Mapping[str, str] = field(default_factory=dict)
    refers: Mapping[str, str] = field(default_factory=dict)
    measured: bool = False
    place: str = ""
    read: str = ""
    print: str = ""
    label: str = ""
    lead: str = ""
    aside: tuple[str, ...] = ()
    changed: str = ""

    @property
    def is_confirmed(self) -> bool:
        """True if the author wrote the equation's lines, or confirmed the lines in their present form."""
        return not self.read or (self.read == "confirmed" and self.print == reading_digest(self.latex, self.line))

    @property
    def cited(self) -> str:
        """The citation of the equation: its number and section, or its section if it has no number."""
        where = f"section {self.place or self.section}"
        return f"({self.number}), {where}" if self.number else where


@dataclass(frozen=True)
class Claim(Printed):
    """A statement that the paper makes in words; `equations` are the ids of the equations that it concerns."""

    _shown = (("claim", "id"), ("section", "section"), ("text", "text"), ("equations", "equations"))

    id: str
    section: str
    text: str
    equations: tuple[str, ...] = ()

    @property
    def figures(self) -> tuple[str, ...]:
        """The numbers of the figures that the claim's text names."""
        named = re.findall(r"figures? (\d+(?:, \d+)*)", self.text)
        return tuple(number for group in named for number in group.split(", "))


@dataclass(frozen=True)
class Figure:
    """A figure. Its `kind` is diagram, simulated, analytical or both; `equations` are the ids of the equations it shows."""

    number: int
    kind: str
    section: str
    shows: str
    equations: tuple[str, ...] = ()

    @property
    def id(self) -> int:
        """The number of the figure."""
        return self.number


def reading_digest(latex: str, lines: Iterable[Mapping[str, Any]]) -> str:
    """Return a hash of an equation's LaTeX and its lines, by which a confirmed reading is recognised."""
    text = json.dumps([latex, [dict(line) for line in lines]], sort_keys=True, default=str)
    return sha256(text.encode()).hexdigest()[:16]


def is_claim(identifier: str) -> bool:
    """Return True if an id is the id of a claim: C and a number."""
    return _CLAIM.fullmatch(identifier) is not None


def known_id(identifier: str, ids: Collection[str]) -> str:
    """Return the id if the paper has it; otherwise raise InputError, which names similar ids such as 5.01 for 5.1."""
    if identifier in ids:
        return identifier
    if not ids:
        raise InputError(f"{identifier!r} is not in the catalogue, which is empty")
    section, _, place = str(identifier).rpartition(".")
    near_ones = [i for i in (f"{section}.0{place}", f"{section}.{place}0", f"C{place.lstrip('Cc'):0>2}") if i in ids]
    first, last = next(iter(ids)), list(ids)[-1]
    hint = f"{' or '.join(near_ones)}?" if near_ones else f"its ids run from {first} to {last}"
    raise InputError(f"{identifier!r} is not in the catalogue: {hint}")


@dataclass(frozen=True)
class Catalogue:
    """The data in a paper's folder: `paper.toml`, `equations.toml` and, if present, claims, figures and symbols.

    Raises InputError, with the file and the id, if `paper.toml` is missing, an id is given twice, or a section, an equation or
    a key is unknown. The printed lines are read when they are first used.
    """

    folder: Path
    modules: dict[str, ModuleType] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "folder", path_of("Paper: folder", self.folder).resolve())
        for problem in self._problems():
            raise InputError(problem)

    @cached_property
    def about(self) -> TitlePage:
        """The content of `paper.toml`."""
        return title_page(self.folder)

    @property
    def title(self) -> str:
        """The paper's title."""
        return self.about.title

    @cached_property
    def equations(self) -> dict[str, Equation]:
        """The equations by id, in the paper's order."""
        return self._rows("equations", "equation", Equation)

    @cached_property
    def claims(self) -> dict[str, Claim]:
        """The claims by id, in the paper's order."""
        return self._rows("claims", "claim", Claim) if (self.folder / "claims.toml").is_file() else {}

    @cached_property
    def figures(self) -> dict[int, Figure]:
        """The figures by number."""
        return self._rows("figures", "figure", Figure) if (self.folder / "figures.toml").is_file() else {}

    @property
    def data(self) -> list[Path]:
        """The files on which every verdict depends: the TOML files and `symbols.py`."""
        names = (*(f"{name}.toml" for name in ("paper", "equations", "claims", "figures")), "symbols.py")
        return sorted(file for name in names if (file := self.folder / name).is_file())

    @cached_property
    def _equations_toml(self) -> dict[str, Any]:
        return toml(self.folder / "equations.toml")

    def _rows(self, name: str, key: str, kind: type[Row]) -> dict[Any, Row]:
        file = self.folder / f"{name}.toml"
        content = self._equations_toml if name == "equations" else toml(file)
        if unknown := sorted(content.keys() - {key, "letters", "units", "meanings"}):
            raise InputError(f"{file}: {unknown[0]!r} is not a key: write [[{key}]]")
        rows: dict[Any, Row] = {}
        for entry in content.get(key, []):
            where = f"{file}: {key} {entry.get('id', entry.get('number', '?')) if isinstance(entry, dict) else '?'}"
            read: Row = row(kind, entry, where)
            if read.id in rows:
                raise InputError(f"{where}: the id is given twice: change one of the two")
            rows[read.id] = read
        return rows

    def _problems(self) -> Iterator[str]:
        """Yield one sentence for each inconsistency between the paper's files."""
        file, sections = self.folder / "paper.toml", self.about.sections
        yield from self._problems_of_lines(self.folder / "equations.toml")
        for name, rows in (("equations", self.equations), ("claims", self.claims), ("figures", self.figures)):
            for entry in rows.values():
                where = f"{self.folder / name}.toml: {entry.id}"
                if name == "equations" and entry.section not in sections:
                    yield f"{where}: section {entry.section!r} is not among the sections of {file}"
                if (name == "claims") != is_claim(str(entry.id)):
                    yield f"{where}: ids of claims, and only these, are C and a number"
                named = entry.refers.values() if isinstance(entry, Equation) else entry.equations
                yield from (
                    f"{where}: there is no equation {reference}"
                    for reference in named
                    if reference not in self.equations
                )
        yield from (f"{file}: results: there is no equation {i}" for i in self.about.results if i not in self.equations)
        model = self.about.model
        is_local = model.isidentifier() and (self.folder / f"{model}.py").is_file()
        if model and not (is_local or model.startswith("lagrotor.report.")):
            yield f"{file}: model: {model!r} is not a module of this folder"

    def _problems_of_lines(self, file: Path) -> Iterator[str]:
        """Yield one sentence for each inconsistency in the printed lines and in the sections' symbols and units."""
        for equation in self.equations.values():
            for line in equation.line:
                for key in sorted(line.keys() - set(_LINE)):
                    yield f"{file}: {equation.id}: {key!r} is not a key of a line: the keys are {', '.join(_LINE)}"
                if "quantity" not in line:
                    yield f"{file}: {equation.id}: a line has no quantity: name in LaTeX the quantity that it gives"
        for key in ("letters", "units", "meanings"):
            for section in self._equations_toml.get(key, {}).keys() - self.about.sections.keys():
                yield f"{file}: {key}: section {section!r} is not among the sections of paper.toml"
        for section, rows in self._equations_toml.get("meanings", {}).items():
            for tex, pair in rows.items():
                if not (isinstance(pair, list) and list(map(type, pair)) == [str, str]):
                    yield f"{file}: meanings: section {section}: {tex} has {pair!r}: write [meaning, unit]"

    def equation(self, identifier: str) -> Equation:
        """Return one equation.

        Parameters
        ----------
        identifier : str
            The equation's id.

        Returns
        -------
        Equation
            The equation with its LaTeX and its printed lines.

        Raises
        ------
        InputError
            If the paper does not have the id; the message names similar ones.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> PAPER.equation("5.24").cited
        'section 5.3'
        """
        return self.equations[known_id(identifier, self.equations)]

    def importable(self) -> AbstractContextManager[None]:
        """Return a context in which the modules of the paper's folder can be imported by name.

        Returns
        -------
        AbstractContextManager[None]
            The context; in it two papers may have modules of the same name.
        """
        return importable(self.folder, self.modules)

    @cached_property
    def _symbols(self) -> ModuleType | None:
        """The module `symbols` of the folder, or None. It defines GLOSSARY and optionally FUNCTIONS, LATEX and WRITTEN_OUT."""
        if not (self.folder / "symbols.py").is_file():
            return None
        with self.importable():
            try:
                return import_module("symbols")
            except Exception as error:
                raise InputError(f"{self.folder / 'symbols.py'}: {type(error).__name__}: {error}") from error

    @property
    def glossary(self) -> Glossary:
        """The paper's symbols with their meanings and units."""
        return getattr(self._symbols, "GLOSSARY", None) or Glossary()

    @property
    def written_out(self) -> Mapping[Any, Any]:
        """Abbreviating symbols and their expressions. They are expanded before a scene's values are substituted."""
        return getattr(self._symbols, "WRITTEN_OUT", {})

    def letters(self, section: str) -> Letters:
        """Return the symbols and functions of a section.

        Parameters
        ----------
        section : str
            Number of the section.

        Returns
        -------
        Letters
            The symbols and functions, without `grammar.FUNCTIONS`, which every paper may call.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> PAPER.letters("5.2").names["theta_0"]
        theta_0
        """
        section_letters = self._equations_toml.get("letters", {}).get(section, {})
        names = {**self._glossary_names, **getattr(self._symbols, "FUNCTIONS", {}), **declared(section_letters)}
        return Letters(names, getattr(self._symbols, "LATEX", {}))

    @cached_property
    def _glossary_names(self) -> dict[str, Any]:
        """The symbols of the glossary by name; no two share one."""
        check_names(str(self.folder / "symbols.py"), list(self.glossary), dict(self.written_out))
        return {symbol.name: symbol for symbol in self.glossary}

    def lines(self, identifier: str) -> tuple[Line, ...]:
        r"""Read the printed lines of an equation.

        Parameters
        ----------
        identifier : str
            The equation's id.

        Returns
        -------
        tuple[Line, ...]
            The printed lines, with their members as sympy expressions.

        Raises
        ------
        InputError
            If a line cannot be read.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> PAPER.lines("5.24")[0].quantity
        '\\dot\\phi'
        """
        entry = self.equation(identifier)
        names, where = dict(self.letters(entry.section).names), f"{self.folder / 'equations.toml'}: {identifier}"
        for letter, meaning in entry.letters.items():
            names[letter] = read(meaning, names, f"{where}, symbol {letter}")
        return tuple(read_line(line, names, where) for line in entry.line)


def section_glossary(catalogue: Catalogue, section: str) -> Glossary:
    """Return the glossary with the units that `equations.toml` gives for a section. Raise InputError for an unknown symbol."""
    names, glossary = catalogue.letters(section).names, Glossary(catalogue.glossary)
    for unit, letters in catalogue._equations_toml.get("units", {}).get(section, {}).items():
        for name in letters.split():
            if name not in names:
                raise InputError(
                    f"{catalogue.folder / 'equations.toml'}: units: section {section} has no symbol {name!r}"
                )
            glossary |= {symbol: Entry(symbol, "parameter", unit) for symbol in components([names[name]])}
    return glossary


def section_meanings(catalogue: Catalogue, section: str) -> dict[str, tuple[str, str]]:
    """Return LaTeX → (meaning, unit) of the glossary's symbols; those that `equations.toml` gives for a section go first."""
    known = {latex(entry.symbol): (entry.meaning, entry.unit) for entry in catalogue.glossary.values()}
    given = catalogue._equations_toml.get("meanings", {}).get(section, {})
    return known | {tex: (meaning, unit) for tex, (meaning, unit) in given.items()}
