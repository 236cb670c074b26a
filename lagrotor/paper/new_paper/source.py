r"""Displayed equations of a LaTeX or Markdown source, with their numbers, labels and sections.

Read are the environments equation, align, gather, multline, eqnarray, displaymath, \[ … \], $$ … $$; \tag, \label, \nonumber;
\section to \subsubsection, and # to #### in Markdown. An equation without a number goes by that of the last one and a letter.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text

_ROWS = ("align", "gather", "eqnarray", "alignat", "flalign")  # each row is an equation
_ENVIRONMENTS = (*_ROWS, "equation", "multline", "displaymath")
_LEVELS = {"section": 0, "subsection": 1, "subsubsection": 2}
_TOKENS = re.compile(
    r"\\(?P<level>section|subsection|subsubsection)(?P<bare>\*?)\s*\{"
    r"|\\begin\{(?P<name>" + "|".join(_ENVIRONMENTS) + r")(?P<star>\*?)\}(?P<body>.*?)\\end\{(?P=name)(?P=star)\}"
    r"|\\\[(?P<display>.*?)\\\]|\$\$(?P<dollars>.*?)\$\$(?P<after>\s*\(\w+\))?"
    r"|^(?P<hashes>#{1,6})\s+(?P<heading>[^\n]*)$",
    re.DOTALL | re.MULTILINE,
)


@dataclass(frozen=True)
class Displayed:
    """One displayed equation: `number` as printed, empty where it has none; `latex` without labels and numbers."""

    id: str
    section: str
    number: str
    label: str
    latex: str


@dataclass
class Source:
    """What a source says of a paper: its title, authors, section number → heading, and its displayed equations."""

    title: str
    authors: tuple[str, ...] = ()
    sections: dict[str, str] = field(default_factory=dict)
    equations: list[Displayed] = field(default_factory=list)


def read_source(file: Path) -> Source:
    """Reads a .tex or .md file. Raises InputError for another one, and for one without a displayed equation."""
    if file.suffix not in (".tex", ".md"):
        raise InputError(f"--from {file}: give a .tex or an .md file")
    text = read_text(file)
    if file.suffix == ".tex":
        text = re.sub(r"(?<!\\)%[^\n]*", "", text)
        found = Source(_plain(_argument(text, r"\title")) or file.stem)
        found.authors = tuple(filter(None, map(_plain, re.split(r"\\and|,", _argument(text, r"\author")))))
    else:
        heading = re.search(r"^# (.*)$", text, re.MULTILINE)
        found = Source(_plain(heading[1]) if heading else file.stem)
    _Reader(text, found).read()
    if not found.equations:
        raise InputError(
            f"--from {file}: it has no displayed equation: lagrotor init alone makes a folder to begin with"
        )
    return found


class _Reader:
    """Walks through a source and keeps the counters that LaTeX keeps."""

    def __init__(self, text: str, found: Source) -> None:
        self.text, self.found = text, found
        self.section, self.counts, self.bare = "0", [0, 0, 0], 0
        self.within = re.search(r"\\numberwithin\{equation\}\{section\}", text) is not None
        self.number, self.last, self.since = 0, "", 0

    def read(self) -> None:
        for match in _TOKENS.finditer(self.text):
            if match["level"]:
                self._section(_LEVELS[match["level"]], _braced(self.text, match.end() - 1), match["bare"])
            elif match["hashes"]:
                if len(match["hashes"]) > 1 or not self.found.title:
                    self._section(min(len(match["hashes"]) - 2, 2), match["heading"], "")
            else:
                for body, numbered, printed in _parts(match):
                    self._equation(body, numbered, printed)

    def _section(self, level: int, heading: str, bare: str) -> None:
        title, own = _plain(heading), re.match(r"(\d+(?:\.\d+)*)\.?\s+(.*)", _plain(heading))
        if own:
            self.section, title = own[1], own[2]
        elif bare:
            self.bare += 1
            self.section = ".".join(str(count) for count in self.counts if count) + _letters(self.bare)
        else:
            self.counts = [*self.counts[:level], self.counts[level] + 1, 0, 0][:3]
            self.section, self.bare = ".".join(map(str, self.counts[: level + 1])), 0
        if level == 0 and self.within:
            self.number = 0
        self.found.sections.setdefault(self.section, title)

    def _equation(self, body: str, numbered: bool, printed: str) -> None:
        tag, label = re.search(r"\\tag\*?\{([^{}]*)\}", body), re.search(r"\\label\{([^{}]*)\}", body)
        latex = re.sub(r"\\(?:tag\*?|label)\{[^{}]*\}|\\(?:nonumber|notag)\b", "", body)
        latex = " ".join(latex.replace("&", " ").split())
        if not latex:
            return
        number = tag[1] if tag else printed
        if not number and numbered and not re.search(r"\\(?:nonumber|notag)\b", body):
            self.number += 1
            number = f"{self.counts[0]}.{self.number}" if self.within else str(self.number)
        self.since = 0 if number else self.since + 1
        self.last = number or self.last
        taken = {equation.id for equation in self.found.equations}
        identifier = number or f"{self.last or 0}{_letters(self.since)}"
        while identifier in taken:
            identifier += "'"
        self.found.sections.setdefault(self.section, "Before the first section")
        self.found.equations.append(Displayed(identifier, self.section, number, label[1] if label else "", latex))


def _parts(match: re.Match[str]) -> Iterator[tuple[str, bool, str]]:
    """(LaTeX, whether LaTeX numbers it, a number printed after it) of each equation of an environment."""
    if match["name"]:
        body = re.sub(r"^\s*\{\d+\}", "", match["body"]) if match["name"] == "alignat" else match["body"]
        rows = re.split(r"\\\\(?:\[[^\]]*\])?", body) if match["name"] in _ROWS else [body.replace(r"\\", " ")]
        numbered = not match["star"] and match["name"] != "displaymath"
        yield from ((row, numbered, "") for row in rows)
    else:
        body = match["display"] if match["display"] is not None else match["dollars"]
        yield body, False, (match["after"] or "").strip(" ()\n")


def _letters(count: int) -> str:
    """1 → a, 26 → z, 27 → aa."""
    return (_letters((count - 1) // 26) if count > 26 else "") + chr(ord("a") + (count - 1) % 26)


def _argument(text: str, command: str) -> str:
    at = re.search(re.escape(command) + r"\s*\{", text)
    return _braced(text, at.end() - 1) if at else ""


def _braced(text: str, start: int) -> str:
    """What is between the brace at `start` and the one that closes it."""
    depth = 0
    for end in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[end], 0)
        if depth == 0:
            return text[start + 1 : end]
    return text[start + 1 :]


def _plain(text: str) -> str:
    """A heading or a name without commands and braces."""
    text = re.sub(r"\\(?:thanks|footnote|label)\s*\{[^{}]*\}", "", text)
    text = re.sub(r"\\[A-Za-z]+\*?|[{}$*]|\\\\", " ", text)
    return " ".join(re.sub(r"\\([&%_#])", r"\1", text).split())
