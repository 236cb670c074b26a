"""A new paper: a folder with one worked equation, claim and figure, or one made from a source; it can be made again.

Made again from a source that has changed, what is confirmed or derived stays, and what has changed is marked.
"""

import json
import re
import shutil
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import compress, product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from lagrotor.errors import InputError
from lagrotor.files import read_text, write_text
from lagrotor.paper.catalogue import reading_digest
from lagrotor.paper.latex.displays import Displayed, Source
from lagrotor.paper.latex.markup import read_source
from lagrotor.paper.latex.printed import Print, paper_notation, read_print
from lagrotor.paper.scripts import beside
from lagrotor.paper.title_page import toml

# The worked example that a new folder begins with.
_EXAMPLE = "papers/pendulum"
_HOLDS = "It holds one worked equation, one claim and one figure of a pendulum; replace\nthem by your own."
_HOLDS_SOURCE = (
    "It holds the displayed equations of {name} as they were read:\nconfirm the readings, then derive the equations."
)
_NOT_COPIED = shutil.ignore_patterns("__pycache__", "report", ".*")
_HEAD = (
    "# The displayed equations of {name}. Each reading is unconfirmed until `lagrotor readings` shows it to you and you\n"
    "# confirm it. Made again by `lagrotor init`: what is confirmed or derived stays, and comments\n"
    "# stand above their equation."
)


@dataclass(frozen=True)
class Begun:
    """What was made: the folder, how many equations it has, of how many the print was read, and what is to be said of it.

    changed, gone: ids of equations whose print has changed, and that the source no longer has. moved: those with another
    number now, in words.
    """

    folder: Path
    equations: int
    read: int
    notes: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    gone: tuple[str, ...] = ()
    moved: tuple[str, ...] = ()


def begin_paper(folder: Path, source: Path | None = None) -> Begun:
    """Make the folder, or make it again from its source. Raises InputError before anything is written.

    Where it holds something that is no paper, cannot be made, or the source has no equation.
    """
    again = (folder / "paper.toml").is_file()
    if again and source is None:
        raise InputError(f"{folder} is a paper already: give its source, --from paper.tex, to read it again")
    if not again and folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} is there already and is no paper: choose a new or an empty folder")
    if not folder.resolve().parent.is_dir():
        raise InputError(f"{folder}: the folder {folder.resolve().parent} is missing: make it first")
    if again and source is not None:
        return _from_source(folder, source, again)
    with TemporaryDirectory(prefix=".made.", dir=folder if folder.is_dir() else folder.resolve().parent) as near:
        made = Path(near) / "paper"  # made whole there, so that what is interrupted leaves nothing
        begun = _example(made, folder.resolve().name) if source is None else _from_source(made, source, again)
        if folder.is_dir():
            for each in made.iterdir():
                each.rename(folder / each.name)
        else:
            made.rename(folder)
    return replace(begun, folder=folder)


def _example(folder: Path, title: str) -> Begun:
    shutil.copytree(beside(_EXAMPLE), folder, ignore=_NOT_COPIED)
    about = read_text(folder / "paper.toml")
    made = re.sub(r"^title = .*$", lambda _: f"title = {_text(title)}", about, count=1, flags=re.MULTILINE)
    write_text(folder / "paper.toml", made)
    return Begun(folder, 1, 1)


def _from_source(folder: Path, source: Path, again: bool) -> Begun:
    given = read_source(source)
    faults = [f"{file or source.name}:{line}: {said}" for file, line, said in given.faults]
    if not given.equations:
        why = "; ".join([f"--from {source}: it has no displayed equation", *(*faults, *given.notes)[:3]])
        raise InputError(f"{why}: lagrotor init alone makes a folder to begin with")
    found, differences = _numbered(given, aux_numbers(source), source)
    old = toml(folder / "equations.toml") if again else {}
    said = toml(folder / "paper.toml").get("notation", {}) if again else {}
    notation = paper_notation(
        [*(each.latex for each in found.equations), *found.inline], said, str(folder / "paper.toml")
    )
    prints = [read_print(each.latex, notation, each.lead) for each in found.equations]
    rows, changed, gone = _merged(found, prints, old.get("equation", []), _derived(folder))
    (folder / "derivations").mkdir(parents=True, exist_ok=True)
    titles = _write_about(folder, found, rows, again)
    _write_symbols(folder, prints, again)
    text = _catalogue(
        _HEAD.format(name=source.name), rows, _vectors(found, prints, old), _comments(folder / "equations.toml")
    )
    write_text(folder / "equations.toml", text)  # last: what stands before it is of these equations
    if not again:
        about = read_text(beside(_EXAMPLE) / "README.md").replace(_HOLDS, _HOLDS_SOURCE.format(name=source.name))
        write_text(folder / "README.md", about)
    notes = (*faults, *found.notes, *differences, *titles)
    numbers = {row["id"]: row.get("number") for row in old.get("equation", [])}
    moved = [
        f"{row['id']} is ({row['number']})"
        for row in rows
        if row.get("number") not in (None, row["id"], numbers.get(row["id"], row.get("number")))
    ]
    return Begun(
        folder, len(prints), sum(each.read for each in prints), notes, tuple(changed), tuple(gone), tuple(moved)
    )


def _numbered(found: Source, aux: Mapping[str, str], source: Path) -> tuple[Source, list[str]]:
    """The source with the numbers that LaTeX wrote beside it, and where they differ from those that its text gives."""
    said: list[str] = []
    if found.counting and not aux and any(each.number for each in found.equations):
        said.append(
            f"{' and '.join(found.counting)} may number equations in a way of {'its' if len(found.counting) == 1 else 'their'} "
            f"own: LaTeX's numbers are taken where {source.with_suffix('.aux').name} lies beside the source"
        )
    ids = {each.id for each in found.equations}
    labels = Counter(each.label for each in found.equations)
    for place, each in enumerate(found.equations):
        number = aux.get(each.label, each.number) if labels[each.label] == 1 and each.label else each.number
        if number not in (each.number, found.labels.get(each.label)):
            said.append(
                f"{each.label} is ({number}) in {source.with_suffix('.aux').name} and ({each.number or 'without a number'}) by "
                "the source: the first is taken"
            )
            identifier = number if number not in ids else each.id
            found.equations[place] = replace(each, number=number, id=identifier)
    return found, said


def aux_numbers(source: Path) -> dict[str, str]:
    """Label → number as LaTeX wrote it beside the source; empty where it has not."""
    file = source.with_suffix(".aux")
    if not file.is_file():
        return {}
    text = file.read_text(encoding="utf-8", errors="replace")
    for name in re.findall(r"\\@input\{([^{}]*)\}", text):
        if (inner := file.parent / name).is_file():
            text += inner.read_text(encoding="utf-8", errors="replace")
    rows = re.findall(r"\\newlabel\{([^{}]*)\}\{\{((?:[^{}]|\{[^{}]*\})*)\}", text)
    return {label: re.sub(r"[{}$]|\\relax\s*", "", number).replace(r"^\prime", "'") for label, number in rows}


# ---- equations.toml


def _derived(folder: Path) -> set[str]:
    """Ids that a derivation states."""
    scripts = (folder / "derivations").glob("*.py")
    return {i for script in scripts for i in re.findall(r"verdict\(\s*[\"']([^\"']+)[\"']", read_text(script))}


def _merged(
    found: Source, prints: list[Print], old: list[dict[str, Any]], derived: set[str]
) -> tuple[list[dict[str, Any]], list[str], list[str]]:
    """The rows of equations.toml: those of the source, with what was known of them; ids changed; ids gone."""
    before, ids = _known(found.equations, old), {row["id"] for row in old}
    taken: set[str] = set()
    rows: list[dict[str, Any]] = []
    changed: list[str] = []
    for place, (each, made) in enumerate(zip(found.equations, prints, strict=True)):
        known = old[before[place]] if place in before else None
        row = _row(each, made, known, changed)
        if known is None:
            while row["id"] in taken or row["id"] in ids:
                row["id"] += "'"
        taken.add(row["id"])
        rows.append(row)
    gone = [row["id"] for row in old if row["id"] not in taken]
    kept = [
        row | {"read": "gone"}
        for row in old
        if row["id"] in gone and (row["id"] in derived or row.get("read") == "confirmed")
    ]
    return [*rows, *kept], changed, gone


def _known(equations: list[Displayed], old: list[dict[str, Any]]) -> dict[int, int]:
    """Place of an equation → place of its row before: alike in label and print, in label, in print.

    What then remains between the same two is paired in order where it is as many, else by its id; what has two labels is two.
    """
    known: dict[int, int] = {}
    names = [(str(row.get("label", "")), str(row.get("latex"))) for row in old]
    for kept in ((True, True), (True, False), (False, True)):
        rows: dict[tuple[str, ...], list[int]] = {}
        for place in sorted({*range(len(old))}.difference(known.values())):
            rows.setdefault(tuple(compress(names[place], kept)), []).append(place)
        rows.pop(("",), None)
        for place, each in enumerate(equations):
            if place not in known and (alike := rows.get(tuple(compress((each.label, each.latex), kept)))):
                known[place] = alike.pop(0)
    gone = {place for place, row in enumerate(old) if row.get("read") == "gone"}
    news = _between({place: known.get(place) for place in range(len(equations))})
    olds = _between(
        {place: place if place in known.values() else None for place in range(len(old)) if place not in gone}
    )
    for last, left in olds.items():
        new = news.get(last, [])
        pairs = zip(new, left, strict=True) if len(new) == len(left) else product(new, left)
        for one, other in pairs:
            if (len(new) == len(left) or equations[one].id == old[other]["id"]) and not (
                equations[one].label and names[other][0]
            ):
                known[one] = other
    return known


def _between(places: Mapping[int, int | None]) -> dict[int, list[int]]:
    """The row that stands before → the places behind it that have none."""
    found: dict[int, list[int]] = {}
    last = -1
    for place, row in places.items():
        if row is None:
            found.setdefault(last, []).append(place)
        else:
            last = row
    return found


def _row(each: Displayed, made: Print, known: Mapping[str, Any] | None, changed: list[str]) -> dict[str, Any]:
    title = each.label or f"displayed equation {each.id}"
    row: dict[str, Any] = {"id": each.id, "number": each.number, "section": each.section, "title": title}
    row |= {"label": each.label, "latex": each.latex, "lead": each.lead}
    lines = [dict(line) for line in made.lines]
    row |= {"read": "unconfirmed" if lines else "", "guesses": list(made.guesses), "aside": list(made.aside)}
    if known is not None:
        same = known.get("latex") == each.latex
        kept = ("id",) if known.get("title") == known.get("label") else ("id", "title")
        row |= {k: v for k, v in known.items() if k not in (*row, "line", "changed", "print") or k in kept}
        before = known.get(
            "line", ()
        )  # what the author added to a line, such as an order, stays with what is read alike
        lines = [dict(next((old for old in before if old | line == old), line)) for line in lines]
        if same and known.get("read") != "unconfirmed" and known.get("line"):
            row |= {k: v for k, v in known.items() if k in ("read", "print", "guesses", "aside", "reading")}
            row["read"] = known.get("read", "")
            lines = [dict(line) for line in known["line"]]
        elif not same:
            row["changed"] = str(known.get("latex"))
            changed.append(row["id"])
        elif known.get("changed"):
            row["changed"] = known["changed"]
    if lines:
        row["line"] = lines
    return {key: value for key, value in row.items() if value not in ("", [], None)}


def _vectors(found: Source, prints: list[Print], old: Mapping[str, Any]) -> dict[str, dict[str, str]]:
    """The letters of each section besides the paper's own: those that are printed as vectors."""
    known: dict[str, dict[str, str]] = {section: dict(rows) for section, rows in old.get("letters", {}).items()}
    for each, made in zip(found.equations, prints, strict=True):
        if made.vectors:
            rows = known.setdefault(each.section, {})
            names = dict.fromkeys([*rows.get("vector", "").split(), *made.vectors])
            rows["vector"] = " ".join(names)
    return known


def _comments(file: Path) -> dict[str, list[str]]:
    """Id → the comments above and within its equation; none where there is no file yet."""
    found: dict[str, list[str]] = {}
    text = read_text(file) if file.is_file() else ""
    above: list[str] = []  # what stands behind a blank line belongs to the equation that follows
    identifier, blank = "", True
    for line in text[len(_head(text)) :].splitlines():
        if line.startswith("#"):
            (above if blank or not identifier else found[identifier]).append(line)
        elif match := re.match(r'id = "(.*)"$', line):
            identifier = match[1]
            found[identifier], above = above, []
        elif line.startswith("[[equation.line]]") and identifier:
            found[identifier] += above
            above = []
        blank = not line.strip() or (blank and line.startswith("#"))
    if identifier:
        found[identifier] += above
    return found


def _catalogue(
    head: str, rows: list[dict[str, Any]], letters: Mapping[str, Mapping[str, str]], comments: Mapping[str, list[str]]
) -> str:
    blocks = [head] if head else []
    for section, given in letters.items():
        blocks.append(
            "\n".join([f"[letters.{_text(section)}]", *(f"{kind} = {_text(names)}" for kind, names in given.items())])
        )
    blocks += ["\n".join([*comments.get(str(row["id"]), ()), *_equation(row)]) for row in rows]
    return "\n\n".join(blocks) + "\n"


def _head(text: str) -> str:
    """The comments that a file begins with."""
    match = re.match(r"(?:#[^\n]*\n)*", text)
    return match[0] if match else ""


def _equation(row: Mapping[str, Any]) -> Iterator[str]:
    yield "[[equation]]"
    yield from (f"{key} = {_value(key, value)}" for key, value in row.items() if key != "line")
    for line in row.get("line", ()):
        yield ""
        yield "[[equation.line]]"
        yield from (f"{key} = {_value(key, value)}" for key, value in line.items())


def _value(key: str, value: Any) -> str:
    """A TOML value."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(str(k))} = {_value('', v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value("", each) for each in value) + "]"
    return _latex(value) if key in ("latex", "quantity", "lead", "changed") else _text(value)


def confirm(folder: Path, ids: Iterable[str]) -> list[str]:
    """Write `read = "confirmed"` and a hash of the print for these equations, named by id, label or (number); their ids.

    Raises InputError for one without a reading.
    """
    file = folder / "equations.toml"
    given = toml(file)
    rows = {row["id"]: row for row in given.get("equation", [])}
    names: dict[str, list[str]] = {}
    for identifier, row in rows.items():
        for name in (row.get("label"), f"({row.get('number')})"):
            if row.get("read") != "gone":
                names.setdefault(str(name), []).append(identifier)
    wanted = []
    for each in ids:
        said = [each] if each in rows else names.get(each, [each])
        if len(said) > 1:
            raise InputError(f"{each} is more than one equation: name one by its id, {', '.join(said[:8])}")
        wanted += said
    for identifier in wanted:
        if identifier not in rows:
            raise InputError(f"{file}: there is no equation {identifier!r}: its ids are {', '.join(list(rows)[:8])} …")
        if rows[identifier].get("read") == "gone":
            raise InputError(f"equation {identifier} is no longer in the source: there is no print to confirm it by")
        if not rows[identifier].get("line"):
            raise InputError(
                f"equation {identifier} has no line to confirm: `lagrotor readings {folder}` says where its reading stopped, or "
                "what was kept aside"
            )
    for identifier in wanted:
        row = rows[identifier]
        lines = row.pop("line")
        row.pop("changed", None)
        row |= {"read": "confirmed", "print": reading_digest(row["latex"], lines)}
        row["line"] = lines
    text = _catalogue(_head(read_text(file)).rstrip(), list(rows.values()), given.get("letters", {}), _comments(file))
    write_text(file, text)
    return wanted


# ---- paper.toml and symbols.py


def _write_about(folder: Path, found: Source, rows: list[dict[str, Any]], again: bool) -> list[str]:
    """Write paper.toml, or renew its sections; what is to be said of them."""
    file = folder / "paper.toml"
    if again:
        return _renew_sections(file, found.sections)
    sections = [f"{_text(number)} = {_text(title)}" for number, title in found.sections.items()]
    head = [
        f"title = {_text(found.title)}",
        f"authors = {json.dumps(found.authors, ensure_ascii=False)}",
        "results = []",
        'equations_in = "s"',
        'claims_in = "c"',
    ]
    if found.preamble:
        head.append(f"preamble = '''{found.preamble}'''")
    write_text(file, "\n".join([*head, "", "[sections]", *sections]) + "\n")
    return []


def _renew_sections(file: Path, sections: Mapping[str, str]) -> list[str]:
    """The titles of the source, in its order; one that the source has nowhere is the author's, which stays and is said."""
    text, known = read_text(file), toml(file).get("sections", {})
    own = {number: title for number, title in known.items() if title not in sections.values()}
    made = {**sections, **own}
    if [*made.items()] != [*known.items()]:
        head, found, rest = _in_two(text, r"^\[ *sections *\][^\n]*\n?")
        block, table, after = _in_two(rest, r"^\[")
        rows = [f"{_text(number)} = {_text(title)}" for number, title in made.items()]
        others = [line for line in block.splitlines() if line.startswith("#") or "=" not in line]
        block = "\n".join([(found or "[sections]").rstrip("\n"), *rows, *others])
        write_text(file, f"{head.rstrip()}\n\n{block.rstrip()}\n" + (f"\n{table}{after}" if table else ""))
    return [
        f'section {number} is "{sections[number]}", which paper.toml calls "{title}": it stays so'
        for number, title in own.items()
        if number in sections
    ]


def _in_two(text: str, pattern: str) -> tuple[str, str, str]:
    """What stands before the first match, the match, and what stands behind it."""
    match = re.search(pattern, text, re.MULTILINE)
    return (text[: match.start()], match[0], text[match.end() :]) if match else (text, "", "")


def _write_symbols(folder: Path, prints: Iterable[Print], again: bool) -> None:
    file = folder / "symbols.py"
    letters = dict.fromkeys(letter for each in prints for letter in each.letters)
    known = read_text(file) if again and file.is_file() else ""
    if known:
        names = {name for call in re.findall(r"\(\s*[\"']([^\"']*)[\"']", known) for name in call.split()}
        new = [name for name in letters if _stem(name) not in names]
        if new:
            write_text(file, known.rstrip("\n") + "\n" + "\n".join(map(_letter, new)) + "\n")
        return
    head = '"""The letters of the paper: give each its meaning, its unit, and what sympy may assume of it."""'
    rows = [head, "", "from lagrotor.paper import Glossary", "", "GLOSSARY = Glossary()"]
    write_text(file, "\n".join([*rows, *map(_letter, letters)]) + "\n")


def _stem(name: str) -> str:
    return re.sub(r"_d?dot$", "", name)


def _letter(name: str) -> str:
    return f'{name} = GLOSSARY.letter("{name}", "?", "?", real=True)'


def _text(value: str | float) -> str:
    """A string, a number, true or false in TOML."""
    return json.dumps(value, ensure_ascii=False)


def _latex(value: str) -> str:
    """A TOML string in which a backslash is a backslash."""
    return f"'''{value}'''" if "'''" not in value and not value.endswith("'") else _text(value)
