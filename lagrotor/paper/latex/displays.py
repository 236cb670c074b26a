"""The displayed equations of a LaTeX source with printed numbers, labels, sections and positions."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.latex.definitions import DISPLAYS, HEADINGS, PRIMITIVES
from lagrotor.paper.latex.headings import names_of_authors, plain_heading
from lagrotor.paper.latex.macros import Expander, Macro
from lagrotor.paper.latex.numbers import Counters, aux_numbers, plain_number
from lagrotor.paper.latex.token_stream import EMPTY_LINE, ends_paragraph
from lagrotor.paper.latex.tokens import BRACES, Token, latex_of, plain

# Each row of these environments has a number; any other display has one number.
_ROWS = ("align", "gather", "eqnarray", "alignat", "flalign")
_PAIRS = ("align", "alignat", "flalign")  # in which every second & begins another equation
_BEGINS = {rf"\begin{{{name}{star}}}": name + star for name in DISPLAYS for star in ("", "*")}
_NESTING = {"begin": 1, "end": -1}
_FAULTS = {
    "verb": r"\verb is not closed on its line",
    "]": r"\] has no matching opening",
    ")": r"\) has no matching opening",
}
_ROW_ENDS = (r"\\", r"\cr")
_NO_NUMBER = (r"\nonumber", r"\notag")
_OPERATORS = re.compile(r"[+\-*/]|\\(?:times|cdot|pm|mp|div|wedge|otimes|circ)(?![A-Za-z])")
_RELATIONS = re.compile(
    r"[=<>]|\\(?:approx|sim|simeq|equiv|neq|ne|leq?|geq?|ll|gg|propto|to|cong|doteq|in|Rightarrow|implies|iff|Leftrightarrow"
    r"|overset|stackrel|longrightarrow|rightarrow|lesssim|gtrsim)(?![A-Za-z])"
)
_NO_FORMULA = (r"\[", r"\]", *HEADINGS)  # TeX ends an open formula at these
_LEADING = re.compile(r"(?:[\s&~]|\{\}|\\(?:quad|qquad|,|;|:|!| |hskip|null|displaystyle)(?![A-Za-z]))*")
# Display environments that are refused.
_REFUSED = ("dmath", "dgroup", "darray", "numcases", "subnumcases", "empheq", "IEEEeqnarray")
_SUFFIXES, _LARGEST = (".tex", ".ltx", ".latex"), 20  # MB
_CONTROLS = [chr(code) for code in range(32) if chr(code) not in "\t\n\r\f"]
# Packages that a formula may need and that change no other formula.
_NEEDED = "mathrsfs dsfont bbm bbold esint stmaryrd cancel euscript wasysym textcomp upgreek"


@dataclass(frozen=True, slots=True)
class Displayed:
    """One displayed equation; `number` is the printed one or ''; `latex` is expanded, without labels and numbers.

    lead: the left side of the previous row, if this row continues it. place: file and line. rows: the line of each row.
    """

    id: str
    section: str
    number: str
    label: str
    latex: str
    lead: str = ""
    place: tuple[str, int] = ("", 0)
    rows: tuple[int, ...] = ()


@dataclass
class Source:
    """The displayed equations of a source; section number → heading; inline formula → section; label → number.

    notes: sentences about doubtful readings. faults: (file, line, error at which TeX would stop). preamble: packages for
    the formulas.
    """

    title: str
    authors: tuple[str, ...] = ()
    sections: dict[str, str] = field(default_factory=dict)
    equations: list[Displayed] = field(default_factory=list)
    inline: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    faults: list[tuple[str, int, str]] = field(default_factory=list)
    preamble: str = ""
    labels: dict[str, str] = field(default_factory=dict)
    file: str = ""


@dataclass
class _Row:
    """One row of a display; `stepped` is True if the counter was stepped at the begin of the display."""

    numbered: bool
    stepped: bool
    tokens: list[Token] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    tag: str = ""
    number: str = ""
    latex: str = ""


def read_source(file: Path) -> Source:
    """Read the displayed equations of a .tex file. Raises InputError for any other file."""
    if file.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{file}: give a .tex file")
    if file.is_file() and (size := file.stat().st_size / 1e6) > _LARGEST:
        raise InputError(f"{file} has {size:.0f} MB, more than {_LARGEST}: give its parts one by one")
    text = read_text(file, "latin-1")
    if text.startswith("%PDF") or 20 * sum(map(text.count, _CONTROLS)) > len(text):
        raise InputError(f"{file} is not text: give its LaTeX source")
    return read_latex(text, file, file.stem)


def read_latex(text: str, file: Path | None = None, title: str = "") -> Source:
    """Read the displayed equations of a LaTeX text. Raises InputError for an endless macro."""
    walker = _Walker(text, file, title)
    try:
        walker.read()
    except RecursionError:
        raise InputError(f"{file or 'the source'}: commands are nested too deeply: write them in parts") from None
    return walker.source


class _Walker:
    """A reader of the expanded tokens that counts as LaTeX does."""

    def __init__(self, text: str, file: Path | None, title: str) -> None:
        self.source = Source(title, file=file.name if file is not None else "")
        self.counters = Counters()
        self.expander = Expander(text, file, PRIMITIVES | self.counters.primitives())
        self.counters.begin(self.expander, "article")
        self.aux, self.aux_name = ({}, "") if file is None else (aux_numbers(file), file.with_suffix(".aux").name)
        self.body = r"\documentclass" not in text
        self.section, self.starred, self.numbered_chapters = "0", 0, True
        self.last, self.since = "0", 0  # the last number, the count of later displays without number
        self.outer: list[tuple[int, Macro | None, str]] = []  # subequations: counter value, its macro, number
        self.ids: set[str] = set()
        self.ended = ""  # missing end of a display; its later appearance is no second fault

    def read(self) -> None:
        for token in self.expander:
            if token.text == r"\end{document}" and not self.expander.end_file(token.at):
                break
            self._take(token)
        source, expander = self.source, self.expander
        source.faults = [(*expander.line(at), sentence) for at, sentence in sorted(expander.faults)]
        source.preamble = "\n".join(rf"\usepackage{{{name}}}" for name in _NEEDED.split() if name in expander.loaded)
        source.notes += dict.fromkeys(expander.notes)
        name, missing = self.aux_name, [label for label in source.labels if self.aux and label not in self.aux]
        if missing:
            source.notes.append(f"{name} has no label {missing[0]}: run LaTeX again, which writes the numbers there")
        elif expander.doubt and name and not self.aux and any(equation.number for equation in source.equations):
            helps = f"put {name}, which LaTeX writes, next to the source"
            source.notes.append(f"{expander.doubt}, and the equation numbers may differ: {helps}")

    def _take(self, token: Token) -> None:
        if token.text == r"\[":
            self._display("displaymath", token, r"\]")
        elif token.text == r"\(":
            self._inline(token, r"\)")
        elif token.kind == "command":
            self._command(token)
        elif token.kind == "begin":
            self._begin(token)
        elif token.kind == "math" and not self.body:
            pass
        elif token.text == "$$":
            self._display("displaymath", token, "$$")
        elif token.text == "$":
            self._inline(token, "$")
        elif token.text == r"\end{subequations}" and self.outer:
            self.counters.values["equation"], printed, _ = self.outer.pop()
            self.expander.define(r"\theequation", printed)
        elif token.text.replace(r"\end", r"\begin") in _BEGINS:
            self._unmatched(token, f"{token.text} has no matching opening")
        elif token.text == "^" and self.body:
            inside = next((name for name, _ in self.expander.scopes[::-1] if name != "{"), "")
            where = rf"in \begin{{{inside}}}, which is unknown: define it"
            if not inside.startswith("tikz"):
                alone = "outside any environment: define the command that begins it"
                self._note(token.at, f"a formula is {where if inside else alone}")

    def _note(self, at: int, sentence: str) -> None:
        """Note a formula that is not read; each sentence appears once."""
        if not any(sentence in note for note in self.expander.notes):
            self.expander.notes.append(f"{self.expander.place(at)}: {sentence}")
            self.expander.doubt = self.expander.doubt or "a part of the source is skipped"

    def _unmatched(self, token: Token, fault: str) -> None:
        """Record a fault, unless the token is the late end of a display that was closed with a fault."""
        if token.text != self.ended:
            self.expander.fault(token.at, fault)
        self.ended = ""

    def _command(self, token: Token) -> None:
        name, expander = token.text[1:], self.expander
        if token.text in HEADINGS and self.body and not ((following := expander.peek()) and following.kind == "close"):
            star = expander.star()
            expander.optional()
            self._section(name, self._argument(), star)
        elif name in ("title", "author"):
            expander.optional()
            text = self._argument()
            if name == "title":
                self.source.title = plain_heading(text) or self.source.title
            else:
                self.source.authors += names_of_authors(text)
        elif name in _FAULTS and self.body:
            self._unmatched(token, _FAULTS[name])
        elif name == "label":
            label = expander.name()
            if self.outer:
                self.source.labels[label] = self.aux.get(label, self.outer[-1][2])
        elif name in DISPLAYS and self.body:
            self._note(token.at, rf"\{name} begins a display as a command: write \begin{{{name}}}")
        elif name == "appendix":
            self.counters.begin_appendix(expander)
        elif name in ("frontmatter", "mainmatter", "backmatter"):
            self.numbered_chapters = name == "mainmatter"
        elif name == "mathtoolsset" and "showonlyrefs" in expander.name():
            expander.doubt = "showonlyrefs of mathtools removes numbers"

    def _argument(self) -> str:
        return latex_of(self.expander.expand(self.expander.argument()))

    def _begin(self, token: Token) -> None:
        name = token.text[7:-1]
        kind, end = name.rstrip("*"), rf"\end{{{name}}}"
        if name == "document":
            self.body = True
        elif name == "subequations" and self.body:
            self._begin_subequations()
        elif token.text in _BEGINS and self.body:
            if kind == "alignat":
                self.expander.argument()
            self._display(kind, token, end, name != kind)
        elif kind in _REFUSED:
            self._note(token.at, rf"\begin{{{name}}} is not read: write equation or align")

    def _begin_subequations(self) -> None:
        """Start numbering by letters within the next number."""
        counters, expander = self.counters, self.expander
        counters.step("equation")
        number = counters.printed(expander, "equation")
        self.outer.append((counters.values["equation"], expander.macros.get(r"\theequation"), number))
        expander.define(r"\theparentequation", Macro.of(number))
        expander.define(r"\theequation", Macro.of(r"\theparentequation\alph{equation}"))
        counters.values["equation"] = 0

    def _section(self, level: str, heading: str, star: bool) -> None:
        title = plain_heading(heading)
        if level == "part":
            return
        if star or (level == "chapter" and not self.numbered_chapters):
            self.starred += 1
            self.section = re.sub(r"[a-z]+$", "", self.section).removeprefix("0") + _letters(self.starred)
        else:
            self.counters.step(level)
            printed = self.counters.printed(self.expander, level)
            self.section, self.starred = printed or str(self.counters.values[level]), 0
        self.source.sections.setdefault(self.section, title or level)

    # ---- formulas

    def _inline(self, begin: Token, end: str) -> None:
        inside: list[Token] = []
        braces = 0
        self.expander.in_formula = True
        for token in self.expander:
            if token.text == end and (end != "$" or braces <= 0):  # \text{if $x$}
                break
            if token.text in _NO_FORMULA or token.text in _BEGINS or ends_paragraph(token):
                if not self.expander.doubt:
                    self.expander.fault(begin.at, f"{begin.text} is not closed in its paragraph")
                self.expander.push((token,))
                inside = []
                break
            braces += BRACES.get(token.kind, 0)
            inside.append(token)
        self.expander.in_formula = False
        if latex := latex_of(inside).strip():
            self.source.inline.setdefault(latex, self.section)

    def _display(self, kind: str, token: Token, end: str, starred: bool = False) -> None:
        """Read a display row by row; each row gets its number at its end."""
        by_rows = kind in _ROWS
        numbered = not starred and kind != "displaymath"
        rows = [_Row(numbered, numbered and not by_rows)]
        if rows[0].stepped:
            self.counters.step("equation")
        depth = braces = 0
        self.expander.in_formula = True
        for item in self._inside(token, end):
            depth += _NESTING.get(item.kind, 0)
            braces += BRACES.get(item.kind, 0)
            row = rows[-1]
            if depth == braces == 0 and item.text in _ROW_ENDS:
                self._skip_row_end(item)
                if by_rows:
                    self._finish(row)
                    rows.append(_Row(numbered, False))
                else:
                    row.tokens.append(item)
            elif item.kind != "command" or not self._sets_number(item, row):
                row.tokens.append(item)
        self.expander.in_formula = False
        self._finish(rows[-1])
        self._store(rows, kind, token)

    def _inside(self, begin: Token, end: str) -> Iterator[Token]:
        """Yield the tokens of a display. A missing end is assumed where TeX would stop, with a fault."""
        depth = braces = 0
        may_nest = begin.text.startswith(r"\begin{gather")  # align within gather
        for token in self.expander:
            if depth == 0:
                if token.text == end and token.kind != "text":
                    return
                if token.kind == "end" and token.text != r"\end{document}":
                    return self.expander.fault(token.at, f"{token.text} ends {begin.text}")
                stops = token.kind == "end" or token.text in _NO_FORMULA
                stops |= token.text in _BEGINS and not (braces or may_nest)
                if stops or (braces == 0 and ends_paragraph(token)):
                    line = EMPTY_LINE.search(token.text) if token.kind == "text" else None
                    head = token.text[: line.start()] if line else ""
                    yield Token("text", head, token.at)
                    self.expander.push((Token(token.kind, token.text[len(head) :], token.at + len(head)),))
                    break
            depth += _NESTING.get(token.kind, 0)
            braces += BRACES.get(token.kind, 0)
            yield token
        self.ended = end
        return self.expander.fault(begin.at, f"{begin.text} is not {'ended' if begin.kind == 'begin' else 'closed'}")

    def _skip_row_end(self, token: Token) -> None:
        r"""Consume the star and the space argument after \\."""
        self.expander.star()
        space = latex_of(self.expander.optional() or ()) if self.expander.begins("[") else ""
        if space and not re.search(r"\d|\\", space):  # not a length: it begins the next row
            self.expander.push(plain(f"[{space}]", token.at))

    def _sets_number(self, token: Token, row: _Row) -> bool:
        """Consume a command that concerns the number of a row; return False for any other command."""
        name, expander = token.text, self.expander
        if name == r"\tag" or name in _NO_NUMBER:
            self.counters.values["equation"] -= row.stepped
            row.stepped = False
        if name == r"\tag":
            expander.star()
            row.tag = plain_number(re.sub(r"\\(?:eq)?ref\{([^{}]*)\}", self._number_of, self._argument()))
        elif name in _NO_NUMBER:
            row.numbered = False
        elif name == r"\label":
            row.labels.append(expander.name())
        else:
            return False
        return True

    def _number_of(self, label: re.Match[str]) -> str:
        return self.source.labels.get(label[1], "")

    def _finish(self, row: _Row) -> None:
        """Set the number of a complete row."""
        if row.numbered and not row.tag:
            if not row.stepped:
                self.counters.step("equation")
            row.number = self.counters.printed(self.expander, "equation")
        else:
            row.number = row.tag

    # ---- equations

    def _store(self, rows: list[_Row], kind: str, token: Token) -> None:
        """Store the equations of a display; a row that continues the previous one is joined to it."""
        groups: list[list[_Row]] = []
        for row, following in pairwise(rows):
            if kind in (*_PAIRS, "gather") and not row.number:  # amsmath moves a label to the next numbered row
                row.labels, following.labels = [], row.labels + following.labels
        for row in rows:
            for label in row.labels if row.number else ():
                self.source.labels[label] = row.number = self.aux.get(label, row.number)
            row.latex = " ".join(latex_of(row.tokens).split())
            if groups and not _is_empty(row) and _continues(groups[-1], row):
                groups[-1].append(row)
            elif not _is_empty(row):
                groups.append([row])
        lead = ""
        for group in groups:
            lead = self._add(group, kind, token, lead)

    def _add(self, group: list[_Row], kind: str, token: Token, lead: str) -> str:
        """Store one equation; `lead` is the left side that its first row may continue. Return its left side."""
        number = next((row.number for row in group if row.number), "")
        label = next((label for row in group for label in row.labels), "")
        latex = _without_columns(group[0].tokens, kind)
        if len(group) > 1:
            latex = r"\begin{aligned} " + r" \\ ".join(row.latex for row in group) + r" \end{aligned}"
        elif kind == "multline" and r"\\" in latex:
            latex = rf"\begin{{gathered}} {latex} \end{{gathered}}"
        latex = re.sub(r"\\(begin|end)\{split\}", r"\\\1{aligned}", latex)  # split is valid in a display only
        lead = lead if len(group) == 1 and _RELATIONS.match(_body(latex)) else ""
        self.since = 0 if number else self.since + 1
        self.last = number or self.last
        identifier, source = number or f"{self.last or 0}{_letters(self.since)}", self.source
        while identifier in self.ids or not identifier:
            identifier += "'"
        self.ids.add(identifier)
        source.sections.setdefault(self.section, "Before the first section")
        firsts = [next((t for t in row.tokens if t.text.strip(" \n\t&")), token) for row in group]
        lines = [self.expander.line(t.at + len(t.text) - len(t.text.lstrip())) for t in firsts]
        rows = tuple(n for _, n in lines)
        source.equations.append(Displayed(identifier, self.section, number, label, latex, lead, lines[0], rows))
        return lead or _left_side(group[0].latex)


def _is_empty(row: _Row) -> bool:
    return not any(token.text.strip(" \n\t&") for token in row.tokens)


def _body(latex: str) -> str:
    return latex[_LEADING.match(latex).end() :]  # type: ignore[union-attr]


def _continues(group: list[_Row], row: _Row) -> bool:
    """Return True if a row continues the equation of the previous rows."""
    body, last = _body(row.latex), group[-1].latex.rstrip(" &~")
    if re.search(r"(?:[+\-*/=<>(]|\\(?:times|cdot|pm|left|approx|equiv))\s*$", last):
        return True
    if _OPERATORS.match(body):
        return not last.endswith((",", ";", ".")) or not body.startswith("-")
    if _RELATIONS.match(body) and not body.startswith((r"\Rightarrow", r"\implies", r"\iff", r"\Leftrightarrow")):
        return sum(bool(member.number) for member in (*group, row)) <= 1
    return False


def _left_side(source: str) -> str:
    """Return the part of a row before its first relation."""
    match = _RELATIONS.search(source)
    return source[: match.start()].replace("&", " ").strip() if match else ""


def _without_columns(tokens: list[Token], kind: str) -> str:
    """Return a row as LaTeX without its own &; every second & of align separates two equations."""
    depth = columns = 0
    row: list[Token] = []
    for token in tokens:
        depth += _NESTING.get(token.kind, 0)
        if token.kind == "align" and depth == 0:
            columns += 1
            separates = columns % 2 == 0 and kind in _PAIRS
            token = Token("command", r"\quad", token.at) if separates else Token("text", " ", token.at)
        row.append(token)
    return " ".join(latex_of(row).split())


def _letters(count: int) -> str:
    return (_letters((count - 1) // 26) if count > 26 else "") + chr(ord("a") + (count - 1) % 26)
