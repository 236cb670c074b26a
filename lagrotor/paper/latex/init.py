"""The folder of a new paper. It holds one worked example, or the equations of a source, and follows its changes.

An update keeps the id, title, confirmation and comments of an equation with the same label or LaTeX. An equation whose
LaTeX has changed is marked, and its reading must be confirmed again.
"""

import json
import re
import shutil
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from lagrotor.errors import InputError
from lagrotor.files import read_text, write_text
from lagrotor.paper.catalogue import reading_digest, toml
from lagrotor.paper.latex.displays import Displayed, Source, read_source
from lagrotor.paper.latex.notation import declared_notation
from lagrotor.paper.latex.readings import Print, paper_notation, read_print
from lagrotor.paper.scripts import beside

_EXAMPLE = "papers/pendulum"
_HOLDS = "It holds one worked equation, one claim and one figure of a pendulum; replace\nthem by your own."
_HOLDS_SOURCE = (
    "It holds the displayed equations of {name} as they were read:\nconfirm the readings, then derive the equations."
)
_NOT_COPIED = shutil.ignore_patterns("__pycache__", "report", ".*")
_SYMBOLS = '''"""The symbols of the paper: give each its meaning, its unit and its sympy assumptions."""

from lagrotor.paper import Glossary

GLOSSARY = Glossary()
'''
_HEAD = (
    "# The displayed equations of {name}. `lagrotor readings` shows each reading and its formula; confirm it there.\n"
    "# `lagrotor init` updates this file: confirmed and derived equations and the comments above an equation stay."
)


@dataclass(frozen=True)
class NewPaper:
    """The result of `begin_paper`: the folder, the number of its equations, and the number of those that were read.

    notes: sentences about doubtful places of the source. changed: ids of equations whose LaTeX has changed since the
    last update. gone: ids of equations that are no longer in the source.
    """

    folder: Path
    equations: int
    read: int
    notes: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    gone: tuple[str, ...] = ()


def begin_paper(folder: Path, source: Path | None = None) -> NewPaper:
    """Make the folder of a paper with a worked example or with the equations of a source; renew them if it is a paper already.

    Raise InputError before any file is written, if the folder has other contents, or the source has no displayed equation.
    """
    again = (folder / "paper.toml").is_file()
    if again and source is None:
        raise InputError(f"{folder} is a paper already: give its source, --from paper.tex, to read it again")
    if not again and folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} already exists and is not a paper: choose a new or an empty folder")
    if not folder.resolve().parent.is_dir():
        raise InputError(f"{folder}: the folder {folder.resolve().parent} does not exist: make it first")
    if again and source is not None:
        return _from_source(folder, source, again)
    with TemporaryDirectory(prefix=".made.", dir=folder if folder.is_dir() else folder.resolve().parent) as near:
        whole = Path(near) / "paper"  # an interrupt then leaves no half-written paper
        paper = _example(whole, folder.resolve().name) if source is None else _from_source(whole, source, again)
        if folder.is_dir():
            for path in whole.iterdir():
                path.rename(folder / path.name)
        else:
            whole.rename(folder)
    return replace(paper, folder=folder)


def _example(folder: Path, title: str) -> NewPaper:
    shutil.copytree(beside(_EXAMPLE), folder, ignore=_NOT_COPIED)
    about = read_text(folder / "paper.toml")
    about = re.sub(r"^title = .*$", lambda _: f"title = {_text(title)}", about, count=1, flags=re.MULTILINE)
    write_text(folder / "paper.toml", about)
    return NewPaper(folder, 1, 1)


def _from_source(folder: Path, path: Path, again: bool) -> NewPaper:
    source = read_source(path)
    faults = [f"{file or path.name}:{line}: {sentence}" for file, line, sentence in source.faults]
    if not source.equations:
        why = "; ".join([f"--from {path}: it has no displayed equation", *(*faults, *source.notes)[:3]])
        raise InputError(f"{why}: lagrotor init without --from makes a folder with an example")
    old = toml(folder / "equations.toml") if again else {}
    table = toml(folder / "paper.toml").get("notation", {}) if again else {}
    formulas = [*(equation.latex for equation in source.equations), *source.inline]
    notation = paper_notation(formulas, table, str(folder / "paper.toml"))
    prints = [read_print(equation.latex, notation, equation.lead) for equation in source.equations]
    rows, changed, gone = _merge(source.equations, prints, old.get("equation", []), _judged_ids(folder))
    (folder / "derivations").mkdir(parents=True, exist_ok=True)
    _write_about(folder, source, again)
    _write_symbols(folder, prints)
    vectors = _vectors(source.equations, prints, old.get("letters", {}))
    comments = _comments(read_text(folder / "equations.toml")) if again else {}
    text = _catalogue(rows, vectors, comments | {"": [_HEAD.format(name=path.name)]})
    write_text(folder / "equations.toml", text)  # last, because the other files depend on it
    if not again:
        about = read_text(beside(_EXAMPLE) / "README.md").replace(_HOLDS, _HOLDS_SOURCE.format(name=path.name))
        write_text(folder / "README.md", about)
    notes = (*faults, *source.notes)
    read = sum(equation.stop is None for equation in prints)
    return NewPaper(folder, len(prints), read, notes, tuple(changed), tuple(gone))


# ---- equations.toml


def _judged_ids(folder: Path) -> set[str]:
    """Return the ids of the equations for which a derivation in the folder gives a verdict."""
    scripts = (folder / "derivations").glob("*.py")
    return {i for script in scripts for i in re.findall(r"verdict\(\s*[\"']([^\"']+)[\"']", read_text(script))}


def _merge(
    equations: list[Displayed], prints: list[Print], old: list[dict[str, Any]], derived: set[str]
) -> tuple[list[dict[str, Any]], list[str], list[str]]:
    """Return the new rows of equations.toml, the ids of changed equations, and the ids that the source lacks.

    A missing equation keeps its row if it is confirmed or if its id is in `derived`; it is marked as gone.
    """
    matches, ids = _match_rows(equations, old), {row["id"] for row in old}
    new_ids: set[str] = set()
    rows: list[dict[str, Any]] = []
    changed: list[str] = []
    for place, (equation, print_) in enumerate(zip(equations, prints, strict=True)):
        row = _row(equation, print_, old[matches[place]] if place in matches else None, changed)
        while place not in matches and (row["id"] in new_ids or row["id"] in ids):
            row["id"] += "'"
        new_ids.add(row["id"])
        rows.append(row)
    gone = [row for row in old if row["id"] not in new_ids]
    stay = [row | {"read": "gone"} for row in gone if row["id"] in derived or row.get("read") == "confirmed"]
    return [*rows, *stay], changed, [row["id"] for row in gone]


def _match_rows(equations: list[Displayed], old: list[dict[str, Any]]) -> dict[int, int]:
    """Return a map from the place of an equation to the place of its old row.

    Equal label and LaTeX decide first, then an equal label, then equal LaTeX of an equation whose label is new.
    """
    matches: dict[int, int] = {}
    rows = [(str(row.get("label", "")), str(row.get("latex"))) for row in old]
    labels = {equation.label for equation in equations} & {label for label, _ in rows} - {""}
    keys = (
        lambda label, latex: (label, latex),
        lambda label, latex: label,
        lambda label, latex: "" if label in labels else latex,
    )
    for key in keys:
        for place, equation in enumerate(equations):
            name = key(equation.label, equation.latex)
            free = (row for row, names in enumerate(rows) if row not in matches.values() and key(*names) == name)
            if place not in matches and name and (row := next(free, None)) is not None:
                matches[place] = row
    return matches


def _row(equation: Displayed, print_: Print, prior: Mapping[str, Any] | None, changed: list[str]) -> dict[str, Any]:
    """Return the row of an equation with the author's entries in its old row `prior`; add its id to `changed` for new LaTeX."""
    row: dict[str, Any] = {"id": equation.id, "number": equation.number, "section": equation.section}
    title = equation.label or f"displayed equation {equation.id}"
    row |= {"title": title, "label": equation.label, "latex": equation.latex}
    row |= {"lead": equation.lead, "aside": list(print_.aside), "read": "unconfirmed" if print_.lines else ""}
    row["line"] = [dict(line) for line in print_.lines]
    if prior is not None:
        stay = ("id",) if prior.get("title") == prior.get("label") else ("id", "title")
        skip = (*row, "changed", "print")
        row |= {key: value for key, value in prior.items() if key not in skip or key in stay}
        old = prior.get("line", ())  # an author's additions, such as an order, stay if the reading is the same
        row["line"] = [next((dict(line) for line in old if line | new == line), new) for new in row["line"]]
        if prior.get("latex") != equation.latex:
            row["changed"] = str(prior.get("latex"))
            changed.append(row["id"])
        elif old and prior.get("read") != "unconfirmed":
            row["read"] = ""
            row |= {key: value for key, value in prior.items() if key in ("read", "print", "aside", "reading", "line")}
        else:
            row["changed"] = prior.get("changed")
    return {key: value for key, value in row.items() if value not in ("", [], None)}


def _vectors(
    equations: list[Displayed], prints: list[Print], old: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    """Return the tables [letters.SECTION] of equations.toml, extended by the vectors in the equations of each section."""
    letters = {section: dict(rows) for section, rows in old.items()}
    for equation, print_ in zip(equations, prints, strict=True):
        if print_.vectors:
            rows = letters.setdefault(equation.section, {})
            rows["vector"] = " ".join(dict.fromkeys([*rows.get("vector", "").split(), *print_.vectors]))
    return letters


def _comments(text: str) -> dict[str, list[str]]:
    """Return a map from an id to the comments above and inside its equation; "" has the comments that open the file."""
    ids = iter(row["id"] for row in tomllib.loads(text).get("equation", ()))
    lines = text.splitlines()
    head = list(takewhile(lambda line: line.startswith("#"), lines))
    comments, above, identifier = defaultdict(list, {"": head}), list[str](), ""
    for line in lines[len(head) :]:
        if line.startswith("#"):
            above.append(line)
        elif line.strip() and not line.startswith("[letters"):
            identifier = str(next(ids, "")) if line.startswith("[[equation]]") else identifier
            comments[identifier] += above
            above = []
    comments[identifier] += above
    return comments


def _catalogue(
    rows: list[dict[str, Any]], letters: Mapping[str, Mapping[str, str]], comments: Mapping[str, list[str]]
) -> str:
    """Return the text of equations.toml: the tables of letters and the equations, each below its comments."""
    blocks = [comments.get("", [])]
    blocks += [
        [f"[letters.{_text(section)}]", *(f"{kind} = {_text(names)}" for kind, names in kinds.items())]
        for section, kinds in letters.items()
    ]
    blocks += [[*comments.get(str(row["id"]), ()), *_equation(row)] for row in rows]
    return "\n\n".join("\n".join(block) for block in blocks if block) + "\n"


def _equation(row: Mapping[str, Any]) -> Iterator[str]:
    yield "[[equation]]"
    yield from (f"{key} = {_value(key, value)}" for key, value in row.items() if key != "line")
    for line in row.get("line", ()):
        yield ""
        yield "[[equation.line]]"
        yield from (f"{key} = {_value(key, value)}" for key, value in line.items())


def _value(key: str, value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(str(k))} = {_value('', v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value("", item) for item in value) + "]"
    return _latex(value) if key in ("latex", "quantity", "lead", "changed") else _text(value)


def confirm(folder: Path, ids: Iterable[str]) -> list[str]:
    """Confirm the readings of these equations in equations.toml, each with a hash of its LaTeX; return their ids.

    Raises InputError for an unknown id, and for an equation that has no reading or is no longer in the source.
    """
    file = folder / "equations.toml"
    data = toml(file)
    rows = {row["id"]: row for row in data.get("equation", [])}
    identifiers = list(ids)
    for identifier in identifiers:
        row = rows.get(identifier)
        if row is None:
            first_ids = ", ".join(list(rows)[:8])
            raise InputError(f"{file}: there is no equation {identifier!r}: give one of its ids, {first_ids} …")
        if row.get("read") == "gone":
            raise InputError(f"equation {identifier} is no longer in the source: leave it out of --confirm")
        if not row.get("line"):
            why = f"`lagrotor readings {folder}` shows where its reading stopped, or which statements are not compared"
            raise InputError(f"equation {identifier} has no line to confirm: {why}")
    for row in (rows[identifier] for identifier in identifiers):
        row.pop("changed", None)
        row |= {"read": "confirmed", "print": reading_digest(row["latex"], row["line"])}
    write_text(file, _catalogue(list(rows.values()), data.get("letters", {}), _comments(read_text(file))))
    return identifiers


# ---- paper.toml and symbols.py


def declare(folder: Path, kinds: Mapping[str, str]) -> None:
    """Declare the kinds of symbols in [notation] of paper.toml; `kinds` maps a symbol to its kind.

    Raises InputError if a symbol would have two kinds that exclude each other.
    """
    file = folder / "paper.toml"
    table = dict(toml(file).get("notation", {}))
    for letter, kind in kinds.items():
        table[kind] = " ".join(dict.fromkeys([*str(table.get(kind, "")).split(), letter]))
    declared_notation(table, str(file))
    _write_table(file, "notation", [f"{key} = {_text(value)}" for key, value in table.items()])


def _write_table(file: Path, name: str, rows: list[str]) -> None:
    """Replace or append one table of a TOML file; its comments stay above its rows."""
    text = read_text(file)
    old = re.search(rf"^\[{name}\][^\n]*\n(?:(?![\[\n])[^\n]*\n?)*", text, re.MULTILINE)
    comments = [line for line in old[0].splitlines()[1:] if line.startswith("#")] if old else []
    block = "\n".join([old[0].splitlines()[0] if old else f"[{name}]", *comments, *rows]) + "\n"
    write_text(file, text.replace(old[0], block, 1) if old else f"{text.rstrip()}\n\n{block}")


def _write_about(folder: Path, source: Source, again: bool) -> None:
    """Write paper.toml. If it exists (`again`), only its table of sections is replaced."""
    file = folder / "paper.toml"
    sections = [f"{_text(number)} = {_text(title)}" for number, title in source.sections.items()]
    if again:
        return _write_table(file, "sections", sections)
    head = [f"title = {_text(source.title)}", f"authors = {_value('authors', source.authors)}", "results = []"]
    head += [
        'equations_in = "s"',
        'claims_in = "c"',
        *([f"preamble = '''{source.preamble}'''"] * bool(source.preamble)),
    ]
    write_text(file, "\n".join([*head, "", "[sections]", *sections]) + "\n")
    return None


def _write_symbols(folder: Path, prints: Iterable[Print]) -> None:
    """Write symbols.py with a declaration for each symbol of the equations; an existing file gets the new symbols only."""
    file = folder / "symbols.py"
    text = read_text(file) if file.is_file() else _SYMBOLS
    names = {name for call in re.findall(r"\(\s*[\"']([^\"']*)[\"']", text) for name in call.split()}
    letters = dict.fromkeys(letter for print_ in prints for letter in print_.letters)
    new = [_letter(name) for name in letters if re.sub(r"_d?dot$", "", name) not in names]
    write_text(file, "\n".join([text.rstrip("\n"), *new]) + "\n")


def _letter(name: str) -> str:
    return f'{name} = GLOSSARY.letter("{name}", "?", "?", real=True)'


def _text(value: str | float) -> str:
    return json.dumps(value, ensure_ascii=False)


def _latex(value: str) -> str:
    """Return LaTeX as a literal TOML string, in which backslashes need no escape."""
    return f"'''{value}'''" if "'''" not in value and not value.endswith("'") else _text(value)
