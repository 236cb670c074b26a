r"""The displayed equations of a LaTeX source with their numbers as printed, their labels, sections and places."""

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.paper.latex import packages
from lagrotor.paper.latex.counters import Counters
from lagrotor.paper.latex.expansion import STYLES, Expander, unstyled
from lagrotor.paper.latex.groups import Macro
from lagrotor.paper.latex.headings import names_of_authors, plain_heading
from lagrotor.paper.latex.primitives import PRIMITIVES
from lagrotor.paper.latex.source_faults import faults_of
from lagrotor.paper.latex.tokens import BRACES, NESTING, Token, latex_of, tokenize
from lagrotor.paper.latex.unknown_environments import UnknownEnvironments

# Each row of these is an equation with a number of its own; the others have one number.
_ROWS_WORDS = "align gather eqnarray alignat flalign xalignat xxalignat IEEEeqnarray numcases subnumcases"
_ROWS = frozenset(_ROWS_WORDS.split())
_ENVIRONMENTS = (*_ROWS, "equation", "multline", "displaymath", "dmath")
_PAIRS = ("align", "alignat", "flalign", "xalignat", "xxalignat")  # in which every second & begins another equation
_WITH_ARGUMENT = ("alignat", "xalignat", "xxalignat", "IEEEeqnarray", "numcases", "subnumcases")
_NEVER = ("displaymath", "xxalignat")
_LEVELS = ("part", "chapter", "section", "subsection", "subsubsection")
UNCLOSED = "unclosed@"  # what Markdown leaves of $$ without a partner
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
# What a class or a package has that counts in a way of its own.
_COUNTS = re.compile(
    r"\\(?:(?:set|addto|step|refstep|new)counter|c@(?:equation|section|chapter)|the(?:equation|section|chapter)|@addtoreset"
    r"|numberwithin|counterwith(?:in|out)|appendix)(?![A-Za-z@])"
)
_EMPTY_LINE = re.compile(r"\n\s*\n\s*")
_PROSE = re.compile(r"[A-Za-z]{3,}[\s,.:]|[A-Za-z]{2,}\s+[A-Za-z]{2,}")
_NO_FORMULA = (r"\[", r"\]", *(rf"\{level}" for level in _LEVELS))  # in none of these does TeX go on
_LEADING = re.compile(r"(?:[\s&~]|\{\}|\\(?:quad|qquad|,|;|:|!| |hskip|null|displaystyle)(?![A-Za-z]))*")


@dataclass(frozen=True, slots=True)
class Displayed:
    """One displayed equation: `number` as printed, empty where it has none; `latex` expanded, without labels and numbers.

    lead: the left side, in LaTeX, of the row before, which this row continues. place: file and line; rows: the line of each of
    its rows. cites: labels that the text before it names.
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
    """What a source says of a paper: title, authors, section number → heading, displayed equations; inline formula → section.

    notes: what could not be known of it; faults: file, line, and what TeX would stop at there; words: id → the text of the
    paragraph before and behind, formulas in $; preamble: packages that its formulas need; missing: packages and classes that are
    loaded, and neither distributed with TeX nor beside the source: file → line; counting: those of them, and classes and packages
    beside the source, that may number in a way of their own; file: its name, as in places.
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
    missing: dict[str, int] = field(default_factory=dict)
    counting: list[str] = field(default_factory=list)
    file: str = ""


@dataclass
class Row:
    """One row of a display as it is read."""

    tokens: list[Token] = field(default_factory=list)
    tag: str = ""
    labels: list[str] = field(default_factory=list)
    numbered: bool = True
    number: str = ""
    stepped: bool = False
    referred: str = ""  # what a reference to a display says whose number is withdrawn


def read_latex(text: str, file: Path | None = None, title: str = "") -> Source:
    """The displayed equations of a LaTeX source. Raises InputError for a macro without end."""
    name = file.name if file is not None else ""
    found = Source(title, file=name)
    try:
        # without the class, without packages: lost in what one beside the source does
        tried = []
        for bare in ((), (".cls",), STYLES):
            found = Source(title, file=name)
            walker = _Walker(text, file, found, bare=bare)
            try:
                walker.read()
            except InputError:
                if bare == STYLES or not walker.has_styles():
                    raise
                continue
            tried.append((walker, found, bare))
            if walker.ended or not walker.has_styles():
                break
        walker, found, bare = next(
            (each for each in tried if each[0].ended), next((each for each in tried if each[0].body), tried[0])
        )
        if walker.only_cited:  # what has a number is known at the end
            found = Source(title, file=name)
            _Walker(text, file, found, walker.referred, bare).read()
        if found.faults and not bare and walker.has_styles():
            other = Source(
                title, file=name
            )  # without the packages beside it: a fault that they have a part in is not said
            _Walker(text, file, other, bare=STYLES).read()
            found.faults = [each for each in found.faults if each in other.faults]
    except RecursionError:
        raise InputError(f"{file or 'the source'}: environments are nested too deeply: write them in parts") from None
    return found


class _Walker:
    """Walks through the expanded tokens and keeps the counters that LaTeX keeps."""

    def __init__(
        self, text: str, file: Path | None, found: Source, numbered: set[str] | None = None, bare: Collection[str] = ()
    ) -> None:
        whole = r"\documentclass" in text
        self.expander = Expander(text, file, PRIMITIVES, packages.commands((), everything=not whole), bare)
        self.unknown = UnknownEnvironments(self.expander)
        self.found, self.whole = found, whole
        self.section, self.bare, self.numbered_chapters = "0", 0, True
        self.last, self.since = "0", 0
        self.parent = ""
        self.cited: list[str] = []  # labels named since the last display
        self.words = ""  # of the paragraph, since the last display
        self.beside: list[str] = []  # displays by which the next words stand
        self.ids: set[str] = set()
        self.only_cited = False  # \mathtoolsset{showonlyrefs}
        self.referred: set[str] = set()  # by \eqref
        self.numbered = numbered  # labels that have a number; None: all
        self.body = not whole
        self.ended = False  # whether it came to the end of the document

    @property
    def counters(self) -> Counters:
        return self.expander.counters

    def has_styles(self) -> bool:
        """Whether packages or a class beside the source are taken in."""
        return any(name.endswith(STYLES) for _, name, *_ in self.expander.starts)

    def read(self) -> None:
        for token in self.expander.tokens():
            if token.text != r"\end":
                self._take(token)
            elif (name := self.expander.name()) != "document":
                self.unknown.end(name, token.at)
            elif not self.expander.leave_file(token.at):
                self.ended = self.body
                break
        else:
            if self.whole and self.body:
                self.expander.macros.fault(len(self.expander.starts[0][3]) - 1, "", r"\end{document} is missing")
        if self.whole and not self.body:
            self.expander.macros.fault(0, "", r"\begin{document} is missing")
        self.found.faults = faults_of(self.expander)
        self.found.notes = list(dict.fromkeys((*self.expander.notes, *self.unknown.notes())))
        self.found.missing = self.expander.missing
        styles = (
            Path(name).name
            for _, name, _, text in self.expander.starts
            if name.endswith(STYLES) and _COUNTS.search(text)
        )
        self.found.counting = [*styles, *(name for name in self.found.missing if name.endswith(".cls"))]
        self.found.preamble = "\n".join(
            rf"\usepackage{{{name}}}" for name in _NEEDED.split() if name in self.expander.loaded
        )

    def _take(self, token: Token) -> None:
        """What a token of the text does."""
        if token.kind == "command":
            self._command(token)
        elif token.text == "$$" and self.body:
            self._display("displaymath", token, "$$", starred=True)
        elif token.kind == "math" and self.body:
            self._inline("$", token)
        elif token.kind == "text":
            self._text(token.text)

    def _command(self, token: Token) -> None:
        name = token.text[1:]
        if name in _LEVELS:
            self.expander.stepped = ""
        if name == "begin":
            self._begin(self.expander.name(), token)
        elif name in _LEVELS and self.body and ((after := self.expander.peek()) is None or after.kind != "close"):
            star = self.expander.star()
            self.expander.optional()
            self._section(name, latex_of(self.expander.expand(self.expander.argument())), star)
        elif name == "label" and self.expander.stepped:
            self.found.labels[self.expander.name()] = self.expander.stepped
        elif name in ("title", "author"):
            self._title_page(name)
        elif name == "[":
            self._display("displaymath", token, r"\]", starred=True)
        elif name == "(":
            self._inline(r"\)", token)
        elif name in _FAULTS and self.body:
            self.expander.macros.fault(token.at, "", _FAULTS[name])
        elif name == "appendix":
            self._begin_appendix(self.expander.star())
        elif name in ("frontmatter", "mainmatter", "backmatter"):
            self.numbered_chapters = name == "mainmatter"
        elif name == "mathtoolsset":
            self.only_cited = "showonlyrefs" in latex_of(self.expander.argument())
        elif name in ("eqref", "refeq", "ref", "cref", "Cref", "autoref"):
            labels = [label.strip() for label in self.expander.name().split(",")]
            self.cited += labels
            self.referred.update(labels if name in ("eqref", "refeq") else ())

    def _title_page(self, name: str) -> None:
        self.expander.optional()
        said = latex_of(self.expander.expand(self.expander.argument()))
        if name == "title":
            self.found.title = plain_heading(said) or self.found.title
        else:
            self.found.authors += names_of_authors(said)

    def _begin(self, name: str, token: Token) -> None:
        if name == "document":
            self.expander.expand(self.expander.first)
            if not self.body:
                self.expander.macros.begin_body()
            self.body = True
            self.expander.packages = packages.commands(self.expander.loaded)
        elif name in ("subequations", "dgroup"):
            kept = self._begin_subequations()
            self._until(name)
            self._end_subequations(kept)
        elif name == "appendices":
            self._begin_appendix()
        elif name == "empheq":
            self.expander.optional()
            inner = self.expander.name()
            self._display(inner.split("=")[0].rstrip("*"), token, "empheq", starred="*" in inner)
        elif name.rstrip("*") in _ENVIRONMENTS and self.body:
            if name.rstrip("*") in _WITH_ARGUMENT:
                self.expander.optional()
                argument = self.expander.argument()
            else:
                argument = []
            options = latex_of(self.expander.optional() or ()) if name.startswith("dmath") else ""
            lettered = self._begin_subequations() if name == "subnumcases" else None
            lead = self._without_label(argument, self.parent) if "cases" in name else []
            self._display(name.rstrip("*"), token, name, name.endswith("*"), lead, options)
            if lettered is not None:
                self._end_subequations(lettered)
        elif name == "math":
            self._inline(r"\end", token)
            self.expander.name()
        elif self.body:
            if name == "frame" and self.expander.document_class == "beamer":
                self._begin_frame()
            self.unknown.begin(name, token.at)

    def _begin_appendix(self, star: bool = False) -> None:
        r"""\appendix: from now on letters, whatever a class or the source has \thechapter or \thesection be."""
        self.counters.begin_appendix(star)
        self.expander.macros.forget_globally(r"\thechapter" if self.counters.chapters else r"\thesection")

    def _begin_frame(self) -> None:
        """A slide of beamer has a number, to which a label without one refers."""
        self.counters.step("framenumber")
        self.expander.refer(self.expander.printed("framenumber"))

    def _begin_subequations(self) -> tuple[int, Macro | None]:
        """Number by letters within the next number; gives what is to be put back."""
        macros, counters = self.expander.macros, self.counters
        counters.step("equation")
        kept = counters.values["equation"], macros.get(r"\theequation")
        self.parent = self.expander.printed("equation")
        counters.values["parentequation"] = kept[0]
        macros[r"\theparentequation"] = Macro(tuple(tokenize(self.parent)))
        macros[r"\theequation"] = Macro(tuple(tokenize(rf"{self.parent}\alph{{equation}}")))
        counters.values["equation"] = 0
        return kept

    def _end_subequations(self, kept: tuple[int, Macro | None]) -> None:
        self.counters.values["equation"], own = kept
        if own is None:
            self.expander.macros.pop(r"\theequation", None)
        else:
            self.expander.macros[r"\theequation"] = own

    def _without_label(self, tokens: list[Token], number: str) -> list[Token]:
        """The tokens without a label, which gets the number."""
        source = latex_of(tokens)
        for label in re.findall(r"\\label\{([^{}]*)\}", source):
            self.found.labels[label] = number
        return tokenize(re.sub(r"\\label\{[^{}]*\}", "", source))

    def _until(self, end: str) -> None:
        """Read on until an environment ends."""
        for token in self.expander.tokens():
            if token.text == r"\end":
                name = self.expander.name()
                if name == end:
                    return
                if name == "document":
                    return self.expander.push(tokenize(r"\end{document}", token.at))
                self.unknown.end(name, token.at)
            elif token.text == r"\label":
                self.found.labels[self.expander.name()] = self.parent
            else:
                self._take(token)

    def _text(self, text: str) -> None:
        """The words of a paragraph stand by the display before them and by the one behind."""
        first, *others = _EMPTY_LINE.split(text)
        for display in self.beside:
            self.found.words[display] += first
        self.words = others[-1] if others else self.words + first
        if others:
            self.beside = []

    # ---- sections

    def _section(self, level: str, heading: str, star: bool) -> None:
        title = plain_heading(heading)
        own = re.match(r"(\d+(?:\.\d+)*)\.?\s+(.*)", title) if not self.whole else None
        if level == "part":
            return
        if own:
            self.section, title = own[1], own[2]
        elif star or (level == "chapter" and not self.numbered_chapters):
            self.bare += 1
            self.section = re.sub(r"[a-z]+$", "", self.section).removeprefix("0") + _letters(self.bare)
        else:
            self.counters.step(level)
            printed = self.expander.printed(level)
            self.section, self.bare = printed or str(self.counters.values[level]), 0
            before = self.counters.before(level, self.expander.printed)
            self.expander.refer(before + printed, everywhere=True)  # a heading may stand in \hypertarget{…}{…}
        self.found.sections.setdefault(self.section, title or level)

    # ---- formulas

    def _inline(self, end: str, begin: Token) -> None:
        found: list[Token] = []
        macros = self.expander.macros
        level = len(macros.groups)
        for token in self.expander.tokens():
            if token.text == end and (end != "$" or len(macros.groups) <= level):  # \text{if $x$} is within
                macros.close_to(level)
                break
            stray = token.kind == "text" and _EMPTY_LINE.search(token.text)
            if stray or token.text in _NO_FORMULA or self._is_display(token) or len(found) > 4000:
                macros.fault(begin.at, begin.text, f"{begin.text} is not closed in its paragraph")
                macros.close_to(level, say=False)
                self.expander.push([token])
                return
            found.append(token)
        latex = latex_of(found).strip()
        self.found.inline.setdefault(latex, self.section)
        self._text(f" ${latex}$ ")

    def _is_display(self, token: Token) -> bool:
        r"""Whether a token is the \begin of a display."""
        return token.text == r"\begin" and self.expander.following().rstrip("*") in _ENVIRONMENTS

    def _display(
        self, kind: str, token: Token, end: str, starred: bool, lead: list[Token] | None = None, options: str = ""
    ) -> None:
        """Read a display row by row, each of which gets its number as it ends."""
        rows: list[Row] = []
        numbered = not starred and kind not in _NEVER
        by_rows = kind in _ROWS
        row = Row(numbered=numbered, labels=re.findall(r"label=\{([^{}]*)\}", options))
        if numbered and not by_rows:
            self.counters.step("equation")
            row.stepped = True
        depth = braces = 0
        for part in self._inside(token, end):
            depth += NESTING.get(part.text, 0)
            braces += BRACES.get(part.kind, 0)
            if (
                part.text == r"\begin"
                and row.stepped
                and self._is_display(part)
                and self.expander.following()[-1] == "*"
            ):
                row.referred, row.stepped = (
                    self.expander.printed("equation"),
                    False,
                )  # whose number a tag cannot take back
            if depth == 0 and part.text in _ROW_ENDS and (braces == 0 or part.text in _BETWEEN):
                self._pass_end(part)
                if by_rows and (part.text not in _BETWEEN or _has_text(row.tokens)):
                    self._finish(row, kind)
                    rows.append(row)
                    row = Row(numbered=numbered)
                elif part.text not in _BETWEEN:
                    row.tokens.append(part)
            elif part.kind != "command" or not self._taken(part, row):
                row.tokens.append(part)
        self._finish(row, kind)
        rows.append(row)
        if end == "$$" and not row.tag:
            self._number_behind(row)
        self._keep(rows, kind, token, lead or [])

    def _inside(self, begin: Token, end: str) -> Iterator[Token]:
        """The tokens of a display until it ends. Where TeX would stop since it is not ended, it is ended, and that is said."""
        macros = self.expander.macros
        level = len(macros.groups)
        paragraph = False  # whether an empty line came
        for part in self.expander.tokens():
            if part.text == end and part.kind in ("command", "math") and (end != "$$" or macros.innermost() < level):
                return macros.close_to(level)
            if part.text == r"\end":
                if self.expander.level is not None and self.expander.level < level:
                    if begin.text == r"\begin":
                        self.expander.name()
                        return None
                    self.expander.level = None
                    self.expander.push([part])
                    break
                if self.expander.following() == "document":
                    self.expander.push([part])
                    break
            if part.kind == "text" and (line := _EMPTY_LINE.search(part.text)):
                paragraph = True
                if len(macros.groups) == level and _PROSE.match(part.text, line.end()):
                    yield Token("text", part.text[: line.start()], part.at)
                    self.expander.push([Token("text", part.text[line.start() :], part.at + line.start())])
                    break
            if part.text in (*_NO_FORMULA, "$$") and part.text != end and (paragraph or len(macros.groups) == level):
                self.expander.push([part])
                break
            if paragraph and self._is_display(part):
                macros.close_to(len(macros.groups) - 1, say=False)
                self.expander.push([part])
                break
            yield part
        if begin.text == r"\begin":
            macros.close_to(level - 1)
        else:
            macros.fault(begin.at, begin.text, f"{begin.text} is not closed")
            macros.close_to(level)

    def _pass_end(self, part: Token) -> None:
        r"""Take the star and the space behind \\, the text of \intertext."""
        if part.text in _BETWEEN:
            self.expander.argument()
            return
        self.expander.star()
        given = latex_of(self.expander.optional() or ()) if self.expander.begins("[") else ""
        if given and not re.search(r"\d|\\", given):  # no length: the row begins with it
            self.expander.push([Token("text", f"[{given}]", part.at)])

    def _taken(self, part: Token, row: Row) -> bool:
        """Whether a command of a row says something of its number only."""
        name = part.text
        if name in (r"\tag", r"\eqno", r"\leqno"):
            self._withdraw(row)
            if name == r"\tag":
                self.expander.star()
                shown = latex_of(self.expander.expand(self.expander.argument()))
                row.tag = _plain_number(re.sub(r"\\(?:eq)?ref\{([^{}]*)\}", self._number_of, shown))
            else:
                shown = latex_of(self.expander.argument())
                if shown == "(" and (more := self.expander.next()) is not None:
                    shown += more.text
                row.tag = _plain_number(shown.strip())
            return True
        if name in _NO_NUMBER:
            self._withdraw(row)
            row.numbered = False
            return True
        if name in (r"\yesnumber", r"\IEEEyesnumber"):
            row.numbered = True
            return True
        if name == r"\label":
            row.labels.append(self.expander.name())
            return True
        if name in (r"\raisetag", r"\displaybreak", r"\allowdisplaybreaks", r"\vspace", r"\noalign"):
            if name == r"\displaybreak":
                self.expander.optional()
            elif name != r"\allowdisplaybreaks":
                self.expander.argument()
            return True
        return False

    def _number_of(self, label: re.Match[str]) -> str:
        return self.found.labels.get(label[1], "")

    def _finish(self, row: Row, kind: str) -> None:
        """The number of a row that has ended."""
        if self.numbered is not None and row.numbered and not self.numbered & set(row.labels):
            self._withdraw(row)
            row.numbered, row.referred = False, ""
        if row.tag:
            row.number = row.tag
        elif row.numbered:
            if kind in _ROWS:
                self.counters.step("equation")
            row.number = self.expander.printed("equation")
        elif kind == "eqnarray" and row.labels:  # whose counter is a number ahead
            self.counters.step("equation")
            row.stepped = True
            self._withdraw(row)

    def _withdraw(self, row: Row) -> None:
        """The number that a display took as it began is not used."""
        if row.stepped:
            row.referred = self.expander.printed("equation")
            self.counters.values["equation"] -= 1
            row.stepped = False

    def _number_behind(self, row: Row) -> None:
        """A number in brackets after $$ … $$, as Markdown has it."""
        following = self.expander.peek()
        if not self.whole and following is not None and following.kind == "text":
            match = re.match(r"\s*\((\w[\w.]*)\)", following.text)
            row.number = match[1] if match else ""

    # ---- what is kept

    def _keep(self, rows: list[Row], kind: str, token: Token, lead: list[Token]) -> None:
        """The equations of a display: rows that continue the one before are joined with it."""
        known = len(self.found.equations)
        group: list[Row] = []
        sources: list[str] = []
        previous = ""
        for place, row in enumerate(rows if kind in ("align", "gather", "alignat", "flalign") else ()):
            after = next((each for each in rows[place + 1 :] if each.number), None)
            if after is not None and not (row.number or after.labels):  # amsmath keeps a label until a row has a number
                row.labels, after.labels = [], row.labels
        for row in rows:
            source = " ".join(latex_of(row.tokens).split())
            if not source.replace("&", "").strip():
                for label in row.labels:
                    self.found.labels[label] = row.number or row.referred or self.expander.referred()
                continue
            if group and self._continues(group, row, source):
                group.append(row)
                sources.append(source)
                continue
            if group:
                previous = self._one(group, sources, kind, token, previous, lead)
            group, sources = [row], [source]
        if group:
            self._one(group, sources, kind, token, previous, lead)
        self.cited, self.words = [], ""
        self.beside = [each.id for each in self.found.equations[known:]]

    def _continues(self, group: list[Row], row: Row, source: str) -> bool:
        body = source[_LEADING.match(source).end() :]  # type: ignore[union-attr]
        before = latex_of(group[-1].tokens).rstrip(" &~")
        numbers = sum(bool(each.number) for each in (*group, row))
        if re.search(r"(?:[+\-*/=<>(]|\\(?:times|cdot|pm|left|approx|equiv|quad))\s*$", before) and not re.search(
            r"\\quad\s*$", before
        ):
            return True
        if _OPERATORS.match(body):
            return not before.endswith((",", ";", ".")) or not body.startswith("-")
        if _RELATIONS.match(body) and not body.startswith((r"\Rightarrow", r"\implies", r"\iff", r"\Leftrightarrow")):
            return numbers <= 1
        whole = " ".join(latex_of(each.tokens) for each in group)
        return _unbalanced(whole)

    def _one(
        self, group: list[Row], sources: list[str], kind: str, token: Token, previous: str, lead: list[Token]
    ) -> str:
        """One equation of rows and their LaTeX; gives its left side."""
        number = next((row.number for row in group if row.number), "")
        labels = [label for row in group for label in row.labels]
        for row in group:
            for label in row.labels:
                self.found.labels[label] = row.number or row.referred or number or self.expander.referred()
        if len(sources) > 1:
            latex = r"\begin{aligned} " + r" \\ ".join(sources) + r" \end{aligned}"
        else:
            latex = _without_columns(group[0].tokens, kind)
        if kind == "multline" and r"\\" in latex:
            latex = rf"\begin{{gathered}} {latex} \end{{gathered}}"
        latex = re.sub(r"\\(begin|end)\{split\}", r"\\\1{aligned}", latex)  # which stands in any formula
        if lead:
            latex = f"{latex_of(lead)} {latex}"
        body = latex[_LEADING.match(latex).end() :]  # type: ignore[union-attr]
        continues = bool(len(sources) == 1 and _RELATIONS.match(body)) and previous
        self._add(number, labels, latex, previous if continues else "", group, token)
        return previous if continues else _left_side(sources[0])

    def _add(self, number: str, labels: list[str], latex: str, lead: str, group: list[Row], token: Token) -> None:
        self.since = 0 if number else self.since + 1
        self.last = number or self.last
        identifier = number or f"{self.last or 0}{_letters(self.since)}"
        while identifier in self.ids or not identifier:
            identifier += "'"
        self.ids.add(identifier)
        self.found.words[identifier] = f"{self.words} □ "  # where the display stands in its sentence
        self.found.sections.setdefault(self.section, "Before the first section")
        firsts = [next((t for t in row.tokens if t.text.strip(" \n\t&")), token) for row in group]
        places = [first.at + len(first.text) - len(first.text.lstrip()) for first in firsts]
        lines = [self.expander.line(at) for at in places]
        label = labels[0] if labels else ""
        self.found.equations.append(
            Displayed(
                identifier,
                self.section,
                number,
                label,
                latex,
                lead,
                lines[0],
                tuple(n for _, n in lines),
                tuple(self.cited),
            )
        )


_NEEDED = "mathrsfs dsfont bbm bbold esint stmaryrd cancel euscript wasysym textcomp upgreek"


def _has_text(tokens: list[Token]) -> bool:
    return any(each.text.strip(" \n&") for each in tokens)


def _unbalanced(source: str) -> bool:
    """Whether a bracket is open at the end of a row."""
    lefts, rights = (len(re.findall(rf"\\{side}(?![a-z])", source)) for side in ("left", "right"))
    if lefts != rights:
        return True
    bare = re.sub(r"\\(?:left|right|[bB]igg?[lrm]?)(?![a-z])\s*|\\[{}]", "", source)
    return bare.count("(") > bare.count(")") or (bare.count("[") > bare.count("]") and ")" not in bare)


def _left_side(source: str) -> str:
    """What is before the first relation of a row."""
    match = _RELATIONS.search(source)
    return source[: match.start()].replace("&", " ").strip() if match else ""


def _without_columns(tokens: list[Token], kind: str) -> str:
    """The tokens of a row as LaTeX without the & of the row itself; every second one parts two equations of align."""
    depth = braces = columns = 0
    kept: list[Token] = []
    words: list[Token] | None = None  # the second column of numcases is text, in which $ begins a formula
    for token in tokens:
        depth += NESTING.get(token.text, 0)
        braces += BRACES.get(token.kind, 0)
        if token.kind == "align" and depth == 0:
            columns += 1
            parts = "cases" in kind or (columns % 2 == 0 and kind in _PAIRS)
            kept += [Token("command", r"\quad", token.at)] if parts else [Token("text", " ", token.at)]
            words = [] if "cases" in kind else None
        elif token.kind == "math" and "cases" in kind:
            kept += _text(words or [])
            words = [] if words is None else None
        else:
            (kept if words is None else words).append(token)
    kept += _text(words or [])
    return " ".join(latex_of(kept).split())


def _text(words: list[Token]) -> list[Token]:
    r"""Words of a column of text, as \text{…}."""
    plain = all(t.kind == "text" for t in words) and any(c.isalpha() for t in words for c in t.text)
    return [Token("command", r"\text", 0), Token("open", "{", 0), *words, Token("close", "}", 0)] if plain else words


def _letters(count: int) -> str:
    """1 → a, 26 → z, 27 → aa."""
    return (_letters((count - 1) // 26) if count > 26 else "") + chr(ord("a") + (count - 1) % 26)


_MARKS = {r"\ast": "*", r"\star": "*", r"\ddagger": "‡", r"\dagger": "†", r"^\prime": "'", r"\prime": "'"}


def _plain_number(text: str) -> str:
    """A number without dollar signs, braces and brackets around it: $3'$ is 3'."""
    text = unstyled(text)
    for mark, sign in _MARKS.items():
        text = text.replace(mark, sign)
    return re.sub(r"^\((.*)\)$", r"\1", text.strip()).strip()
