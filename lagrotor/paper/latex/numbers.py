r"""Equation numbers: from the .aux file next to the source; otherwise from the counters of the standard classes.

A number is printed by \theequation, a macro as in LaTeX, which a source may redefine.
"""

import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from lagrotor.paper.latex.macros import Expander, Macro, Primitive
from lagrotor.paper.latex.tokens import Token, latex_of, plain, tokenize

_ARTICLE = {
    "section": r"\arabic{section}",
    "subsection": r"\thesection.\arabic{subsection}",
    "subsubsection": r"\thesubsection.\arabic{subsubsection}",
    "equation": r"\arabic{equation}",
}
_BOOK = _ARTICLE | {
    "chapter": r"\arabic{chapter}",
    "section": r"\thechapter.\arabic{section}",
    "equation": r"\chapterdot\arabic{equation}",
}
_CLASSES = {
    **dict.fromkeys(("article", "amsart", "scrartcl", "standalone"), _ARTICLE),
    **dict.fromkeys(("book", "report", "memoir"), _BOOK),
}
_WITHIN = {"section": "chapter", "subsection": "section", "subsubsection": "subsection"}
_ROMAN = {"m": 1000, "cm": 900, "d": 500, "cd": 400, "c": 100, "xc": 90, "l": 50, "xl": 40, "x": 10,
          "ix": 9, "v": 5, "iv": 4, "i": 1}  # fmt: skip
STYLES: dict[str, Callable[[int], str]] = {
    "arabic": str,
    "roman": lambda n: _roman(n),
    "Roman": lambda n: _roman(n).upper(),
    "alph": lambda n: chr(ord("a") + n - 1) if 0 < n <= 26 else "",
    "Alph": lambda n: chr(ord("A") + n - 1) if 0 < n <= 26 else "",
}


class Counters:
    """LaTeX's counters: their values, and which counter resets which."""

    def __init__(self) -> None:
        self.values = dict.fromkeys(("part", "chapter", *_ARTICLE), 0)
        self.parents = dict(_WITHIN)  # counter → the counter that resets it
        self.document_class = ""

    def begin(self, expander: Expander, document_class: str) -> None:
        """Define the printed form of the counters of a document class."""
        formats = _CLASSES.get(document_class, _ARTICLE)
        if document_class not in _CLASSES:
            expander.doubt = f"the class {document_class} is unknown"
        if "chapter" in formats:
            self.parents["equation"] = "chapter"
        for name, text in formats.items():
            expander.define(rf"\the{name}", Macro.of(text), everywhere=True)

    def step(self, name: str, by: int = 1) -> None:
        """Add one to a counter, and reset the counters numbered within it."""
        self.values[name] = self.values.get(name, 0) + by
        for inner in [counter for counter, parent in self.parents.items() if parent == name]:
            self.values[inner] = 0
            self.step(inner, by=0)

    def printed(self, expander: Expander, name: str) -> str:
        return plain_number(latex_of(expander.expand((Token("command", rf"\the{name}", 0),))))

    def begin_appendix(self, expander: Expander) -> None:
        r"""Start numbering chapters or sections by letters, as after \appendix."""
        top, below = ("chapter", "section") if r"\thechapter" in expander.macros else ("section", "subsection")
        self.values |= {top: 0, below: 0}
        expander.define(rf"\the{top}", Macro.of(rf"\Alph{{{top}}}"), everywhere=True)

    def primitives(self) -> dict[str, Primitive]:
        """Return the commands that set and print counters."""
        setting = (r"\setcounter", r"\addtocounter", r"\stepcounter", r"\refstepcounter")
        nesting = (r"\@addtoreset", r"\numberwithin", r"\counterwithin", r"\counterwithout")
        printing = [rf"\{style}" for style in STYLES]
        return {
            r"\documentclass": self._class,
            r"\chapterdot": self._chapter,
            **dict.fromkeys(setting, self._set),
            **dict.fromkeys(nesting, self._number_within),
            **dict.fromkeys(printing, self._show),
        }

    def _class(self, expander: Expander, token: Token) -> None:
        expander.optional()
        name = expander.name()
        if not self.document_class:  # an included document may have another
            self.document_class = name
            self.begin(expander, name)

    def _set(self, expander: Expander, token: Token) -> None:
        name, values = expander.name(), self.values
        if "step" in token.text:
            self.step(name)
        elif re.fullmatch(r"[+-]?\d+", text := latex_of(expander.expand(expander.argument())).strip()):
            values[name] = int(text) + (values.get(name, 0) if token.text == r"\addtocounter" else 0)
        else:
            expander.doubt = f"{expander.place(token.at)}: {token.text}{{{name}}}{{{text}}} is unknown"

    def _number_within(self, expander: Expander, token: Token) -> None:
        star = expander.star()
        name, parent = expander.name(), expander.name()
        self.parents[name] = parent if token.text != r"\counterwithout" else ""
        if not star and token.text != r"\@addtoreset":
            text = (rf"\the{parent}." if self.parents[name] else "") + rf"\arabic{{{name}}}"
            expander.define(rf"\the{name}", Macro.of(text), everywhere=True)

    def _show(self, expander: Expander, token: Token) -> None:
        value = self.values.get(expander.name(), 0)
        expander.push(plain(STYLES[token.text[1:]](value), token.at))

    def _chapter(self, expander: Expander, token: Token) -> None:
        """Print the chapter number before an equation number, if there is one."""
        expander.push(tokenize(r"\thechapter.", token.at) if self.values["chapter"] else ())


_FONTS = re.compile(
    r"\\(?:ensuremath|text\w*|math\w+|[mh]box|rm|bf|it|normalfont|(?:foot)?notesize|normalsize|small|relax)(?![A-Za-z])|[${}]"
)
_MARKS = {r"\ast": "*", r"\star": "*", r"\ddagger": "‡", r"\dagger": "†", r"^\prime": "'", r"\prime": "'"}


def plain_number(text: str) -> str:
    r"""Return a number without fonts, dollar signs, braces and brackets: 2.1 for \textbf{2.1}, 3' for $3'$."""
    text = _FONTS.sub("", text)
    for mark, sign in _MARKS.items():
        text = text.replace(mark, sign)
    return re.sub(r"^\((.*)\)$", r"\1", text.strip()).strip()


def _roman(value: int) -> str:
    text = ""
    for mark, size in _ROMAN.items():
        text += mark * (value // size)
        value %= size
    return text


def aux_numbers(source: Path) -> dict[str, str]:
    """Return label → number from the .aux file, without repeated labels; the result is empty without the file."""
    file = source.with_suffix(".aux")
    text = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
    for name in re.findall(r"\\@input\{([^{}]*)\}", text):
        inner = file.parent / name
        if inner.resolve().is_relative_to(file.parent.resolve()) and inner.is_file():
            text += inner.read_text(encoding="utf-8", errors="replace")
    rows = re.findall(r"\\newlabel\{([^{}]*)\}\{\{((?:[^{}]|\{[^{}]*\})*)\}", text)
    times = Counter(label for label, _ in rows)
    return {label: plain_number(number) for label, number in rows if times[label] == 1}
