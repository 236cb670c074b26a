"""The scope of an audit as data: `paper.toml`, the equations, claims and figures of a paper in its order, and its letters."""

import json
import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping
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
from lagrotor.mechanics.glossary import Entry, Glossary
from lagrotor.paper.grammar import Letters, Line, components, declared, read, read_line
from lagrotor.paper.scripts import importable


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


Row = TypeVar("Row", bound="Equation | Claim | Figure")
_CLAIM = re.compile(r"C\d+")
# The keys of a printed line.
_LINE = ("quantity", "members", "order", "small", "read_off", "scene", "names")


@dataclass(frozen=True)
class Equation:
    """One printed equation: `latex` as the source prints it, `number` the paper's own where it gives one.

    line: its printed lines as written in the catalogue. reading: a remark on how they were read. read: of lines that were read
    from a source, "unconfirmed" or "confirmed", then with `print`, a hash of the confirmed lines; "gone" where the source no
    longer has it. label, lead: its name in the source, and the left side of the row that it continues. aside: statements that
    were read and are compared with nothing. changed: its print before the source changed. letters: meanings that the text
    around the equation gives its letters. refers: letter → id of the equation that defines it, whose derived side stands for
    it. measured: the equation is a number read off a run. place: the paper's own heading over it, where `section` is wider.
    """

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
        """Whether its lines are the author's word: written by hand, or confirmed as they stand."""
        return not self.read or (self.read == "confirmed" and self.print == reading_digest(self.latex, self.line))

    @property
    def cited(self) -> str:
        """How to point to it in the paper: its own number, or its section."""
        where = f"section {self.place or self.section}"
        return f"({self.number}), {where}" if self.number else where


@dataclass(frozen=True)
class Claim:
    """What the paper states in words: `equations` are the ids of those that it is about."""

    id: str
    section: str
    text: str
    equations: tuple[str, ...] = ()

    @property
    def figures(self) -> tuple[str, ...]:
        """Numbers of the figures that the text names."""
        named = re.findall(r"figures? (\d+(?:, \d+)*)", self.text)
        return tuple(number for group in named for number in group.split(", "))


@dataclass(frozen=True)
class Figure:
    """One figure: `kind` is diagram, simulated, analytical or both; `equations` are the ids of those that it shows."""

    number: int
    kind: str
    section: str
    shows: str
    equations: tuple[str, ...] = ()

    @property
    def id(self) -> int:
        """Its number."""
        return self.number


def reading_digest(latex: str, lines: Iterable[Mapping[str, Any]]) -> str:
    """A hash of a print and its lines: what was confirmed is this and nothing else."""
    said = json.dumps([latex, [dict(line) for line in lines]], sort_keys=True, default=str)
    return sha256(said.encode()).hexdigest()[:16]


def is_claim(identifier: str) -> bool:
    """Return whether an id is that of a claim, C and a number, not that of an equation."""
    return _CLAIM.fullmatch(identifier) is not None


def known_id(identifier: str, ids: Collection[str]) -> str:
    """An id that the paper has. Raises InputError that names near ones: 5.1 may be 5.01 or 5.10."""
    if identifier in ids:
        return identifier
    if not ids:
        raise InputError(f"{identifier!r} is not in the catalogue: it is empty")
    section, _, place = str(identifier).rpartition(".")
    near_ones = [i for i in (f"{section}.0{place}", f"{section}.{place}0", f"C{place.lstrip('Cc'):0>2}") if i in ids]
    first, last = next(iter(ids)), list(ids)[-1]
    hint = f"{' or '.join(near_ones)}?" if near_ones else f"ids run from {first} to {last}"
    raise InputError(f"{identifier!r} is not in the catalogue: {hint}")


@dataclass(frozen=True)
class Catalogue:
    """What a paper's folder says: `paper.toml`, `equations.toml`, and, where there are any, claims, figures, symbols.

    Raises InputError, with the file and the id, for a folder without `paper.toml`, an id given twice, a section or an
    equation that the paper does not have, a key that means nothing. The printed lines are read when they are used.
    """

    folder: Path
    modules: dict[str, ModuleType] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "folder", path_of("Paper: folder", self.folder).resolve())
        for problem in self._problems():
            raise InputError(problem)

    @cached_property
    def about(self) -> TitlePage:
        """The whole of `paper.toml`."""
        return title_page(self.folder)

    @property
    def title(self) -> str:
        """The paper's title."""
        return self.about.title

    @cached_property
    def equations(self) -> dict[str, Equation]:
        """Every equation by id, in the paper's order."""
        return self._rows("equations", "equation", Equation)

    @cached_property
    def claims(self) -> dict[str, Claim]:
        """Every claim by id, in the paper's order."""
        return self._rows("claims", "claim", Claim) if (self.folder / "claims.toml").is_file() else {}

    @cached_property
    def figures(self) -> dict[int, Figure]:
        """Every figure by number."""
        return self._rows("figures", "figure", Figure) if (self.folder / "figures.toml").is_file() else {}

    @property
    def data(self) -> list[Path]:
        """The files that every verdict rests on: the TOML files and the letters."""
        names = (*(f"{name}.toml" for name in ("paper", "equations", "claims", "figures")), "symbols.py")
        return sorted(file for name in names if (file := self.folder / name).is_file())

    @cached_property
    def _equations_toml(self) -> dict[str, Any]:
        return toml(self.folder / "equations.toml")

    def _rows(self, name: str, key: str, kind: type[Row]) -> dict[Any, Row]:
        file = self.folder / f"{name}.toml"
        given = self._equations_toml if name == "equations" else toml(file)
        if unknown := sorted(given.keys() - {key, "letters", "units"}):
            raise InputError(f"{file}: {unknown[0]!r} means nothing here: write [[{key}]]")
        rows: dict[Any, Row] = {}
        for each in given.get(key, []):
            where = f"{file}: {key} {each.get('id', each.get('number', '?')) if isinstance(each, dict) else '?'}"
            read: Row = row(kind, each, where)
            if read.id in rows:
                raise InputError(f"{where}: the id is given twice")
            rows[read.id] = read
        return rows

    def _problems(self) -> Iterator[str]:
        """What does not fit together, one sentence each."""
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
                yield from (f"{where}: there is no equation {other}" for other in named if other not in self.equations)
        yield from (f"{file}: results: there is no equation {i}" for i in self.about.results if i not in self.equations)
        model = self.about.model
        own = model.isidentifier() and (self.folder / f"{model}.py").is_file()
        if model and not (own or model.startswith("lagrotor.report.")):
            yield f"{file}: model: {model!r} is no module of this folder"

    def _problems_of_lines(self, file: Path) -> Iterator[str]:
        """What is wrong with the printed lines and the letters of the sections."""
        for each in self.equations.values():
            for line in each.line:
                for key in sorted(line.keys() - set(_LINE)):
                    yield f"{file}: {each.id}: a line has no {key!r}: its keys are {', '.join(_LINE)}"
                if "quantity" not in line:
                    yield f"{file}: {each.id}: a line has no quantity: say in LaTeX what it is about"
        for key in ("letters", "units"):
            for section in self._equations_toml.get(key, {}).keys() - self.about.sections.keys():
                yield f"{file}: {key}: section {section!r} is not among the sections of paper.toml"

    def equation(self, identifier: str) -> Equation:
        """One equation; refuses an id that the paper does not have."""
        return self.equations[known_id(identifier, self.equations)]

    def importable(self) -> Any:
        """A context in which modules of the paper's folder can be imported by their names."""
        return importable(self.folder, self.modules)

    @cached_property
    def _symbols(self) -> ModuleType | None:
        """The module `symbols` of the folder; it defines GLOSSARY, and may define FUNCTIONS, LATEX, WRITTEN_OUT."""
        if not (self.folder / "symbols.py").is_file():
            return None
        with self.importable():
            try:
                return import_module("symbols")
            except Exception as error:
                raise InputError(f"{self.folder / 'symbols.py'}: {type(error).__name__}: {error}") from error

    @property
    def glossary(self) -> Glossary:
        """The paper's letters with meanings and units."""
        return getattr(self._symbols, "GLOSSARY", None) or Glossary()

    @property
    def written_out(self) -> Mapping[Any, Any]:
        """Letters that stand for expressions in others; they are written out before the values of a scene are put in."""
        return getattr(self._symbols, "WRITTEN_OUT", {})

    def letters(self, section: str) -> Letters:
        """What the printed lines of a section are written in, besides the functions of every paper."""
        check_names(str(self.folder / "symbols.py"), list(self.glossary), dict(self.written_out))
        own = {symbol.name: symbol for symbol in self.glossary}
        given = self._equations_toml.get("letters", {}).get(section, {})
        names = {**own, **getattr(self._symbols, "FUNCTIONS", {}), **declared(given)}
        return Letters(names, getattr(self._symbols, "LATEX", {}))

    def meanings(self, section: str) -> Glossary:
        """The glossary, and the units that `[units]` gives to the letters of a section: unit → names in a row.

        Raises InputError for a name that the section does not have.
        """
        names, glossary = self.letters(section).names, Glossary(self.glossary)
        for unit, letters in self._equations_toml.get("units", {}).get(section, {}).items():
            for name in letters.split():
                if name not in names:
                    raise InputError(
                        f"{self.folder / 'equations.toml'}: units: section {section} has no letter {name!r}"
                    )
                glossary |= {symbol: Entry(symbol, "parameter", unit) for symbol in components([names[name]])}
        return glossary

    def lines(self, identifier: str) -> tuple[Line, ...]:
        """The printed lines of an equation as expressions. Raises InputError where one cannot be read."""
        entry = self.equation(identifier)
        names, where = dict(self.letters(entry.section).names), f"{self.folder / 'equations.toml'}: {identifier}"
        for letter, meaning in entry.letters.items():
            names[letter] = read(meaning, names, f"{where}, letter {letter}")
        return tuple(read_line(each, names, where) for each in entry.line)
