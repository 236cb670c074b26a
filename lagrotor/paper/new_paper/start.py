"""A new paper: a folder with one worked equation, claim and figure, or one made from a LaTeX or Markdown source."""

import json
import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import write_text
from lagrotor.paper.new_paper.printed import Print, read_print
from lagrotor.paper.new_paper.source import Displayed, Source, read_source
from lagrotor.paper.scripts import beside

# The worked example that a new folder begins with.
_EXAMPLE = "papers/pendulum"
_NOT_COPIED = shutil.ignore_patterns("__pycache__", "report", ".*")


@dataclass(frozen=True)
class Begun:
    """What was made: the folder, how many equations it has, and of how many the print was read."""

    folder: Path
    equations: int
    read: int


def begin(folder: Path, source: Path | None = None) -> Begun:
    """Make the folder. Raises InputError where it holds something, cannot be made, or the source has no equation."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} is there already: choose a new or an empty folder")
    if not folder.resolve().parent.is_dir():
        raise InputError(f"{folder}: the folder {folder.resolve().parent} is missing: make it first")
    if source is None:
        shutil.copytree(beside(_EXAMPLE), folder, ignore=_NOT_COPIED, dirs_exist_ok=True)
        about = (folder / "paper.toml").read_text(encoding="utf-8")
        title = f"title = {_text(folder.resolve().name)}"
        write_text(folder / "paper.toml", re.sub(r"^title = .*$", lambda _: title, about, count=1, flags=re.MULTILINE))
        return Begun(folder, 1, 1)
    found = read_source(source)
    prints = {equation.id: read_print(equation.latex) for equation in found.equations}
    (folder / "derivations").mkdir(parents=True, exist_ok=True)
    write_text(folder / "paper.toml", _about(found))
    write_text(folder / "equations.toml", _catalogue(found, prints, source.name))
    letters = dict.fromkeys(letter for each in prints.values() if each for letter in each.letters)
    write_text(folder / "symbols.py", _symbols(letters))
    shutil.copyfile(beside(_EXAMPLE) / "README.md", folder / "README.md")
    return Begun(folder, len(prints), sum(each is not None for each in prints.values()))


def _about(found: Source) -> str:
    rows = [
        f"title = {_text(found.title)}",
        f"authors = {json.dumps(found.authors, ensure_ascii=False)}",
        "results = []",
    ]
    rows += ['equations_in = "s"', 'claims_in = "c"', "", "[sections]"]
    return "\n".join([*rows, *(f"{_text(number)} = {_text(title)}" for number, title in found.sections.items())]) + "\n"


def _catalogue(found: Source, prints: dict[str, Print | None], name: str) -> str:
    head = f"# The displayed equations of {name}. Members were read by sympy's parser of LaTeX: compare them with the print."
    return "\n\n".join([head, *("\n".join(_equation(e, prints[e.id])) for e in found.equations)]) + "\n"


def _equation(equation: Displayed, read: Print | None) -> Iterator[str]:
    title = equation.label or f"displayed equation {equation.id}"
    rows = {"id": equation.id, "number": equation.number, "section": equation.section, "title": title}
    yield "[[equation]]"
    yield from (f"{key} = {_text(value)}" for key, value in rows.items() if value)
    yield f"latex = {_latex(equation.latex)}"
    if read:
        yield ""
        yield "[[equation.line]]"
        yield f"quantity = {_latex(read.quantity)}"
        yield f"members = {json.dumps(read.members)}"


def _symbols(letters: Iterable[str]) -> str:
    head = '"""The letters of the paper: give each its meaning, its unit, and what sympy may assume of it."""'
    rows = [head, "", "from lagrotor.paper import Glossary", "", "GLOSSARY = Glossary()"]
    return "\n".join([*rows, *(f'{name} = GLOSSARY.letter("{name}", "?", "?", real=True)' for name in letters)]) + "\n"


def _text(value: str) -> str:
    """A TOML string."""
    return json.dumps(value, ensure_ascii=False)


def _latex(value: str) -> str:
    """A TOML string in which a backslash is a backslash."""
    return f"'''{value}'''" if "'''" not in value and not value.endswith("'") else _text(value)
