r"""The displayed equations of a LaTeX source with their numbers as printed, their labels, sections and places."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.paper.latex.definitions import DISPLAYS, HEADINGS, PRIMITIVES
from lagrotor.paper.latex.headings import names_of_authors, plain_heading
from lagrotor.paper.latex.macros import Expander, Macro
from lagrotor.paper.latex.numbers import Counters, aux_numbers, plain_number
from lagrotor.paper.latex.token_stream import EMPTY_LINE, ends_paragraph
from lagrotor.paper.latex.tokens import BRACES, Token, latex_of, plain

# Each row of these is an equation with a number; the others have one number.
_ROWS = ("align", "gather", "eqnarray", "alignat", "flalign", "IEEEeqnarray")
_PAIRS = ("align", "alignat", "flalign")  # in which every second & begins another equation
_WITH_ARGUMENT = ("alignat", "IEEEeqnarray")
_BEGINS = {rf"\begin{{{name}{star}}}": name + star for name in DISPLAYS for star in ("", "*")}
_NESTING = {"begin": 1, "end": -1}
UNCLOSED = "unclosed@"  # Markdown writes it for $$ without a partner
_FAULTS = {
    UNCLOSED: "$$ is not closed",
    "verb": r"\verb is not closed in its line",
    "]": r"\] ends nothing that has begun",
    ")": r"\) ends nothing that has begun",
}
_BETWEEN = (r"\intertext", r"\shortintertext")
_ROW_ENDS = (r"\\", r"\cr", *_BETWEEN)
_NO_NUMBER = (r"\nonumber", r"\notag", r"\IEEEnonumber")
_OPERATORS = re.compile(r"[+\-*/]|\\(?:times|cdot|pm|mp|div|wedge|otimes|circ)(?![A-Za-z])")
_RELATIONS = re.compile(
    r"[=<>]|\\(?:approx|sim|simeq|equiv|neq|ne|leq?|geq?|ll|gg|propto|to|cong|doteq|in|Rightarrow|implies|iff|Leftrightarrow"
    r"|overset|stackrel|longrightarrow|rightarrow|lesssim|gtrsim)(?![A-Za-z])"
)
_NO_FORMULA = (r"\[", r"\]", *HEADINGS)  # TeX does not go on in a formula behind these
_LEADING = re.compile(r"(?:[\s&~]|\{\}|\\(?:quad|qquad|,|;|:|!| |hskip|null|displaystyle)(?![A-Za-z]))*")
_REFERENCES = (r"\eqref", r"\refeq", r"\ref", r"\cref", r"\Cref", r"\autoref")
# Environments that number formulas in a way of their own, and those that hold = and _ in drawings and code.
_REFUSED = ("dmath", "dgroup", "darray", "numcases", "subnumcases")
_NO_DISPLAY = re.compile("tikz|pic|axis|scope|code|list|verb|prog|console|tab|array|graph|diagram|CD|algo|bib")
# Packages that a formula may need, and whose commands other formulas do not disturb.
_NEEDED = "mathrsfs dsfont bbm bbold esint stmaryrd cancel euscript wasysym textcomp upgreek"


@dataclass(frozen=True, slots=True)
class Displayed:
    """One displayed equation: `number` as printed, empty if there is none; `latex` expanded, without labels and numbers.

    lead: the left side of the row before, which this row continues. place: file and line; rows: the line of each row. cites:
    labels that the text before it names.
    """

    id: str
    section: str
    number: str
    label: str
    latex: str
    lead: str = ""
    place: tuple[str, int] = ("", 0)
    rows: tuple[int, ...] = ()
    cites: tuple[str, ...] = ()


@dataclass
class Source:
    """The displayed equations of a source; section number → heading; inline formula → section; label → number.

    notes: sentences about what could not be known; faults: file, line, and the error at which TeX would stop; words: id → the
    text of the paragraph before and behind, formulas in $; preamble: packages that the formulas need; file: its name.
    """

    title: str
    authors: tuple[str, ...] = ()
    sections: dict[str, str] = field(default_factory=dict)
    equations: list[Displayed] = field(default_factory=list)
    inline: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    faults: list[tuple[str, int, str]] = field(default_factory=list)
    words: dict[str, str] = field(default_factory=dict)
    preamble: str = ""
    labels: dict[str, str] = field(default_factory=dict)
    file: str = ""


@dataclass
class _Row:
    """One row of a display as it is read."""

    numbered: bool
    tokens: list[Token] = field(default_factory=list)
    tag: str = ""
    labels: list[str] = field(default_factory=list)
    number: str = ""
    stepped: bool = False


def read_latex(text: str, file: Path | None = None, title: str = "") -> Source:
    """Return the displayed equations of a LaTeX source. Raises InputError for a macro without end."""
    walker = _Walker(text, file, title)
    try:
        walker.read()
    except RecursionError:
        raise InputError(f"{file or 'the source'}: commands are nested too deeply: write them in parts") from None
    if file is not None:
        _number_by_aux(walker.source, file, walker.expander.doubt)
    return walker.source


def _number_by_aux(source: Source, file: Path, doubt: str) -> None:
    """Give each equation with a label the number that LaTeX wrote beside the source; say which numbers are not certain."""
    numbers, name = aux_numbers(file), file.with_suffix(".aux").name
    labels = Counter(each.label for each in source.equations if each.label and each.number)
    others = [
        each
        for each in source.equations
        if labels[each.label] == 1 and numbers.get(each.label, each.number) != each.number
    ]
    if others:
        first, more = others[0], f", as {len(others) - 1} more differ" if others[1:] else ""
        said = f"{first.label} is ({numbers[first.label]}) in {name} and ({first.number}) by the source{more}"
        source.notes.append(f"{said}: the first is taken, and equations without a label are counted")
    if numbers and (missing := [label for label in labels if label not in numbers]):
        source.notes.append(f"{name} has no label {missing[0]}: run LaTeX again, which writes the numbers there")
    elif doubt and not numbers and any(each.number for each in source.equations):
        source.notes.append(
            f"{doubt}, and the numbers may be others: put {name}, which LaTeX writes, beside the source"
        )
    ids: set[str] = set()
    words = dict(source.words)
    for place, each in enumerate(source.equations):
        number = numbers[each.label] if each in others else each.number
        identifier = number if each in others else each.id
        while identifier in ids:
            identifier += "'"
        ids.add(identifier)
        source.words[identifier] = words[each.id]
        source.equations[place] = replace(each, number=number, id=identifier)
        source.labels |= {each.label: number} if each in others else {}


class _Walker:
    """A reader of the expanded tokens, which counts as LaTeX does."""

    def __init__(self, text: str, file: Path | None, title: str) -> None:
        self.source = Source(title, file=file.name if file is not None else "")
        self.counters = Counters()
        self.expander = Expander(text, file, PRIMITIVES | self.counters.primitives())
        self.counters.begin(self.expander, "article")
        self.whole = r"\documentclass" in text
        self.body = not self.whole
        self.section, self.starred, self.numbered_chapters = "0", 0, True
        self.last, self.since = "0", 0  # the last number, and how many displays without one came since
        self.parent = ""  # of subequations
        self.outer: list[tuple[int, Macro | None]] = []  # subequations: the value of the counter, and its print
        self.cited: list[str] = []  # labels named since the last display
        self.words = ""  # of the paragraph, since the last display
        self.neighbours: list[str] = []  # displays to which the next words belong
        self.ids: set[str] = set()
        self.ended = ""  # a display whose end was missing: what ends it later ends nothing
        self.conditions = 0  # those that the preamble has and that are not decided
        self.passed: dict[str, int] = {}  # environments that are not known: their place

    def read(self) -> None:
        """Read the whole source."""
        for token in self.expander:
            if token.text == r"\end{document}" and not self.expander.end_file(token.at):
                break
            self._take(token)
        source, expander = self.source, self.expander
        source.faults = [(*expander.line(at), said) for at, said in sorted(expander.faults)]
        source.notes += dict.fromkeys(expander.notes)
        for name in dict.fromkeys(name for name, _ in expander.undecided):
            first, *others = (place for each, place in expander.undecided if each == name)
            more = f", nor in {len(others)} more places" if others else ""
            helps = r"both branches are left out; write \iftrue or \iffalse"
            source.notes.append(f"{first}: {name} is not decided{more}: {helps}")
        if self.passed or self.conditions < len(expander.undecided):
            expander.doubt = expander.doubt or "a part of the source is left out"
        source.notes += [
            rf"{expander.place(at)}: \begin{{{name}}} is not known, and its formula is passed over: write equation, or define it"
            rf" by \newenvironment{{{name}}}"
            for name, at in self.passed.items()
        ]
        source.preamble = "\n".join(rf"\usepackage{{{name}}}" for name in _NEEDED.split() if name in expander.loaded)

    def _take(self, token: Token) -> None:
        if token.kind == "text":
            self._text(token.text)
        elif token.kind == "command":
            self._command(token)
        elif token.kind == "begin":
            self._begin(token)
        elif token.kind == "math" and self.body:
            if token.text == "$$":
                self._display("displaymath", token, "$$")
            else:
                self._inline("$", token)
        elif token.kind == "end":
            if token.text == r"\end{subequations}":
                self._end_subequations()
            elif token.text == self.ended:
                self.ended = ""
            elif token.text.replace(r"\end", r"\begin") in _BEGINS:
                self.expander.fault(token.at, f"{token.text} ends nothing that has begun")
        elif token.kind == "script" and self.body and self.expander.scopes:
            name = self.expander.scopes[-1][0]
            if name != "{" and not _NO_DISPLAY.search(name):
                self.passed.setdefault(name, token.at)

    def _command(self, token: Token) -> None:
        name = token.text[1:]
        if token.text in HEADINGS and self.body:
            if (after := self.expander.peek()) is None or after.kind != "close":
                star = self.expander.star()
                self.expander.optional()
                self._section(name, latex_of(self.expander.expand(self.expander.argument())), star)
        elif name == "label":
            label = self.expander.name()
            if self.outer:
                self.source.labels[label] = self.parent
        elif name == "title":
            self.expander.optional()
            self.source.title = plain_heading(self._argument()) or self.source.title
        elif name == "author":
            self.expander.optional()
            self.source.authors += names_of_authors(self._argument())
        elif name == "[":
            self._display("displaymath", token, r"\]")
        elif name == "(":
            self._inline(r"\)", token)
        elif name in _FAULTS and self.body:
            if token.text == self.ended:
                self.ended = ""
            else:
                self.expander.fault(token.at, _FAULTS[name])
        elif name == "appendix":
            self.counters.begin_appendix(self.expander, self.expander.star())
        elif name in ("frontmatter", "mainmatter", "backmatter"):
            self.numbered_chapters = name == "mainmatter"
        elif name == "mathtoolsset" and "showonlyrefs" in self.expander.name():
            self.expander.doubt = "showonlyrefs of mathtools withdraws numbers"
        elif token.text in _REFERENCES:
            self.cited += (label.strip() for label in self.expander.name().split(","))

    def _argument(self) -> str:
        return latex_of(self.expander.expand(self.expander.argument()))

    def _begin(self, token: Token) -> None:
        name = token.text[7:-1]
        if name == "document":
            self.body, self.conditions = True, len(self.expander.undecided)
        elif not self.body:
            pass
        elif name == "subequations":
            self._begin_subequations()
        elif name == "empheq":
            self.expander.optional()
            inner = self.expander.name().partition("=")[0]
            self._display(inner.rstrip("*"), token, r"\end{empheq}", inner.endswith("*"))
        elif token.text in _BEGINS:
            kind = name.rstrip("*")
            if kind in _WITH_ARGUMENT:
                self.expander.optional()
                self.expander.argument()
            self._display(kind, token, rf"\end{{{name}}}", name.endswith("*"))
        elif name == "math":
            self._inline(r"\end{math}", token)
        elif name.rstrip("*") in _REFUSED:
            self.passed.setdefault(name, token.at)

    def _begin_subequations(self) -> None:
        """Number by letters within the next number."""
        counters, expander = self.counters, self.expander
        counters.step("equation")
        self.outer.append((counters.values["equation"], expander.macros.get(r"\theequation")))
        self.parent = counters.printed(expander, "equation")
        expander.define(r"\theparentequation", Macro.of(self.parent))
        expander.define(r"\theequation", Macro.of(r"\theparentequation\alph{equation}"))
        counters.values["equation"] = 0

    def _end_subequations(self) -> None:
        if self.outer:
            self.counters.values["equation"], printed = self.outer.pop()
            self.expander.define(r"\theequation", printed)

    def _text(self, text: str) -> None:
        """Give the words of a paragraph to the display before them and to the one behind."""
        first, *others = EMPTY_LINE.split(text)
        for display in self.neighbours:
            self.source.words[display] += first
        self.words = others[-1] if others else self.words + first
        if others:
            self.neighbours = []

    def _section(self, level: str, heading: str, star: bool) -> None:
        title = plain_heading(heading)
        numbered = re.match(r"(\d+(?:\.\d+)*)\.?\s+(.*)", title) if not self.whole else None
        if level == "part":
            return
        if numbered:
            self.section, title = numbered[1], numbered[2]
        elif star or (level == "chapter" and not self.numbered_chapters):
            self.starred += 1
            self.section = re.sub(r"[a-z]+$", "", self.section).removeprefix("0") + _letters(self.starred)
        else:
            self.counters.step(level)
            printed = self.counters.printed(self.expander, level)
            self.section, self.starred = printed or str(self.counters.values[level]), 0
        self.source.sections.setdefault(self.section, title or level)

    # ---- formulas

    def _inline(self, end: str, begin: Token) -> None:
        inside: list[Token] = []
        braces = 0
        self.expander.in_formula = True
        for token in self.expander:
            if token.text == end and (end != "$" or braces <= 0):  # \text{if $x$} is within
                break
            if token.text in _NO_FORMULA or token.text in _BEGINS or ends_paragraph(token):
                self.expander.fault(begin.at, f"{begin.text} is not closed in its paragraph")
                self.expander.in_formula = False
                return self.expander.push((token,))
            braces += BRACES.get(token.kind, 0)
            inside.append(token)
        self.expander.in_formula = False
        latex = latex_of(inside).strip()
        self.source.inline.setdefault(latex, self.section)
        return self._text(f" ${latex}$ ")

    def _display(self, kind: str, token: Token, end: str, starred: bool = False) -> None:
        """Read a display row by row, each of which gets its number as it ends."""
        by_rows = kind in _ROWS
        numbered = not starred and kind != "displaymath"
        rows = [_Row(numbered)]
        if numbered and not by_rows:
            self.counters.step("equation")
            rows[0].stepped = True
        depth = braces = 0
        self.expander.in_formula = True
        for part in self._inside(token, end):
            depth += _NESTING.get(part.kind, 0)
            braces += BRACES.get(part.kind, 0)
            row = rows[-1]
            if depth == 0 and part.text in _ROW_ENDS and (braces == 0 or part.text in _BETWEEN):
                self._pass_end(part)
                if by_rows and (part.text not in _BETWEEN or _has_text(row.tokens)):
                    self._finish(row, by_rows)
                    rows.append(_Row(numbered))
                elif part.text not in _BETWEEN:
                    row.tokens.append(part)
            elif part.kind != "command" or not self._sets_number(part, row):
                row.tokens.append(part)
        self.expander.in_formula = False
        self._finish(rows[-1], by_rows)
        if end == "$$" and not rows[-1].tag:
            self._number_behind(rows[-1])
        self._keep(rows, kind, token)

    def _inside(self, begin: Token, end: str) -> Iterator[Token]:
        """Yield the tokens of a display. A display that is not ended where TeX would stop is ended there, with a fault."""
        depth = braces = 0
        for part in self.expander:
            if depth == 0:
                if part.text == end and part.kind != "text":
                    return
                if part.kind == "end" and part.text != r"\end{document}":
                    return self.expander.fault(part.at, f"{part.text} ends {begin.text}")
                stops = part.kind == "end" or part.text in _NO_FORMULA
                if stops or (braces == 0 and (part.text in _BEGINS or ends_paragraph(part))):
                    line = EMPTY_LINE.search(part.text) if part.kind == "text" else None
                    before = part.text[: line.start()] if line else ""
                    yield Token("text", before, part.at)
                    self.expander.push((Token(part.kind, part.text[len(before) :], part.at + len(before)),))
                    break
            depth += _NESTING.get(part.kind, 0)
            braces += BRACES.get(part.kind, 0)
            yield part
        self.ended = end
        kind = "ended" if begin.kind == "begin" else "closed"
        return self.expander.fault(begin.at, f"{begin.text} is not {kind}")

    def _pass_end(self, part: Token) -> None:
        r"""Take the star and the space behind \\, the text of \intertext."""
        if part.text in _BETWEEN:
            self.expander.argument()
        self.expander.star()
        space = latex_of(self.expander.optional() or ()) if self.expander.begins("[") else ""
        if space and not re.search(r"\d|\\", space):  # no length: the row begins with it
            self.expander.push(plain(f"[{space}]", part.at))

    def _sets_number(self, part: Token, row: _Row) -> bool:
        """Take a command that says something of the number of a row only; return False for another one."""
        name, expander = part.text, self.expander
        if name in (r"\tag", r"\eqno", r"\leqno"):
            self._withdraw(row)
            if name == r"\tag":
                expander.star()
                row.tag = plain_number(re.sub(r"\\(?:eq)?ref\{([^{}]*)\}", self._number_of, self._argument()))
            else:
                shown = expander.argument()
                row.tag = plain_number(
                    latex_of(shown) + (latex_of((expander.next() or part,)) if latex_of(shown) == "(" else "")
                )
        elif name in _NO_NUMBER:
            self._withdraw(row)
            row.numbered = False
        elif name in (r"\yesnumber", r"\IEEEyesnumber"):
            row.numbered = True
        elif name == r"\label":
            row.labels.append(expander.name())
        elif name == r"\displaybreak":
            expander.optional()
        elif name in (r"\raisetag", r"\noalign"):
            expander.argument()
        else:
            return name == r"\allowdisplaybreaks"
        return True

    def _number_of(self, label: re.Match[str]) -> str:
        return self.source.labels.get(label[1], "")

    def _finish(self, row: _Row, by_rows: bool) -> None:
        """Give a row that has ended its number."""
        if row.tag:
            row.number = row.tag
        elif row.numbered:
            if by_rows:
                self.counters.step("equation")
            row.number = self.counters.printed(self.expander, "equation")

    def _withdraw(self, row: _Row) -> None:
        """Take back the number that a display took as it began."""
        if row.stepped:
            self.counters.values["equation"] -= 1
            row.stepped = False

    def _number_behind(self, row: _Row) -> None:
        """Take a number in brackets behind $$ … $$, as Markdown has it."""
        after = self.expander.peek()
        if not self.whole and after is not None and after.kind == "text":
            match = re.match(r"\s*\((\w[\w.]*)\)", after.text)
            row.number = match[1] if match else ""

    # ---- equations

    def _keep(self, rows: list[_Row], kind: str, token: Token) -> None:
        """Keep the equations of a display: rows that continue the one before are joined with it."""
        known = len(self.source.equations)
        group: list[_Row] = []
        sources: list[str] = []
        previous = ""
        for row, after in pairwise(rows):
            if kind in _PAIRS + ("gather",) and not row.number:  # amsmath keeps a label until a row has a number
                row.labels, after.labels = [], row.labels + after.labels
        for row in rows:
            source = " ".join(latex_of(row.tokens).split())
            self.source.labels |= dict.fromkeys(row.labels if row.number else (), row.number)
            if not source.replace("&", "").strip():
                continue
            if group and self._continues(group, row, source):
                group.append(row)
                sources.append(source)
                continue
            if group:
                previous = self._one(group, sources, kind, token, previous)
            group, sources = [row], [source]
        if group:
            self._one(group, sources, kind, token, previous)
        self.cited, self.words = [], ""
        self.neighbours = [each.id for each in self.source.equations[known:]]

    def _continues(self, group: list[_Row], row: _Row, source: str) -> bool:
        """Return True if a row continues the equation of the rows before."""
        body = source[_LEADING.match(source).end() :]  # type: ignore[union-attr]
        before = latex_of(group[-1].tokens).rstrip(" &~")
        if re.search(r"(?:[+\-*/=<>(]|\\(?:times|cdot|pm|left|approx|equiv|quad))\s*$", before) and not re.search(
            r"\\quad\s*$", before
        ):
            return True
        if _OPERATORS.match(body):
            return not before.endswith((",", ";", ".")) or not body.startswith("-")
        if _RELATIONS.match(body) and not body.startswith((r"\Rightarrow", r"\implies", r"\iff", r"\Leftrightarrow")):
            return sum(bool(each.number) for each in (*group, row)) <= 1
        return _unbalanced(" ".join(latex_of(each.tokens) for each in group))

    def _one(self, group: list[_Row], sources: list[str], kind: str, token: Token, previous: str) -> str:
        """Keep one equation of rows and their LaTeX; return its left side."""
        number = next((row.number for row in group if row.number), "")
        labels = [label for row in group for label in row.labels]
        if len(sources) > 1:
            latex = r"\begin{aligned} " + r" \\ ".join(sources) + r" \end{aligned}"
        else:
            latex = _without_columns(group[0].tokens, kind)
        if kind == "multline" and r"\\" in latex:
            latex = rf"\begin{{gathered}} {latex} \end{{gathered}}"
        latex = re.sub(r"\\(begin|end)\{split\}", r"\\\1{aligned}", latex)  # which stands in any formula
        body = latex[_LEADING.match(latex).end() :]  # type: ignore[union-attr]
        continues = bool(len(sources) == 1 and _RELATIONS.match(body)) and previous
        self._add(number, labels, latex, previous if continues else "", group, token)
        return previous if continues else _left_side(sources[0])

    def _add(self, number: str, labels: list[str], latex: str, lead: str, group: list[_Row], token: Token) -> None:
        self.since = 0 if number else self.since + 1
        self.last = number or self.last
        identifier = number or f"{self.last or 0}{_letters(self.since)}"
        while identifier in self.ids or not identifier:
            identifier += "'"
        self.ids.add(identifier)
        source = self.source
        source.words[identifier] = f"{self.words} □ "  # where the display stands in its sentence
        source.sections.setdefault(self.section, "Before the first section")
        firsts = [next((t for t in row.tokens if t.text.strip(" \n\t&")), token) for row in group]
        places = [first.at + len(first.text) - len(first.text.lstrip()) for first in firsts]
        lines = [self.expander.line(at) for at in places]
        label, rows = labels[0] if labels else "", tuple(n for _, n in lines)
        cites = tuple(self.cited)
        source.equations.append(Displayed(identifier, self.section, number, label, latex, lead, lines[0], rows, cites))


def _has_text(tokens: list[Token]) -> bool:
    return any(each.text.strip(" \n&") for each in tokens)


def _unbalanced(source: str) -> bool:
    """Return True if a bracket is open at the end of a row."""
    lefts, rights = (len(re.findall(rf"\\{side}(?![a-z])", source)) for side in ("left", "right"))
    if lefts != rights:
        return True
    bare = re.sub(r"\\(?:left|right|[bB]igg?[lrm]?)(?![a-z])\s*|\\[{}]", "", source)
    return bare.count("(") > bare.count(")") or (bare.count("[") > bare.count("]") and ")" not in bare)


def _left_side(source: str) -> str:
    """Return the part of a row before its first relation."""
    match = _RELATIONS.search(source)
    return source[: match.start()].replace("&", " ").strip() if match else ""


def _without_columns(tokens: list[Token], kind: str) -> str:
    """Return a row as LaTeX without the & of the row itself; every second one parts two equations of align."""
    depth = columns = 0
    row: list[Token] = []
    for token in tokens:
        depth += _NESTING.get(token.kind, 0)
        if token.kind == "align" and depth == 0:
            columns += 1
            parts = columns % 2 == 0 and kind in _PAIRS
            token = Token("command", r"\quad", token.at) if parts else Token("text", " ", token.at)
        row.append(token)
    return " ".join(latex_of(row).split())


def _letters(count: int) -> str:
    """Return 1 as a, 26 as z, 27 as aa."""
    return (_letters((count - 1) // 26) if count > 26 else "") + chr(ord("a") + (count - 1) % 26)
