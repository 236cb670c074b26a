r"""Equation numbers: LaTeX's own from the .aux beside the source; otherwise those of the counters of the standard classes.

A number is printed by \theequation, a macro as in LaTeX, which a source may define anew.
"""

import re
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
_REVTEX = _ARTICLE | {
    "section": r"\Roman{section}",
    "subsection": r"\Alph{subsection}",
    "subsubsection": r"\arabic{subsubsection}",
}
# How each class prints its counters.
_CLASSES = {
    **dict.fromkeys(
        ["article", "amsart", "scrartcl", "extarticle", "elsarticle", "standalone", "subfiles", "beamer"], _ARTICLE
    ),
    **dict.fromkeys(["book", "report", "memoir", "extbook", "extreport"], _BOOK),
    **dict.fromkeys(["scrbook", "scrreprt"], _BOOK | {"equation": r"\thechapter.\arabic{equation}"}),
    **dict.fromkeys(["revtex4", "revtex4-1", "revtex4-2"], _REVTEX),
    "IEEEtran": _ARTICLE | {"section": r"\Roman{section}"},
}
# Classes that number the equations of an appendix by its sections.
_APPENDICES = {
    **dict.fromkeys(["revtex4", "revtex4-1", "revtex4-2"], r"\Alph{section}\arabic{equation}"),
    "elsarticle": r"\Alph{section}.\arabic{equation}",
}
_WITHIN = {"section": "chapter", "subsection": "section", "subsubsection": "subsection"}
_ROMAN = {"m": 1000, "cm": 900, "d": 500, "cd": 400, "c": 100, "xc": 90, "l": 50, "xl": 40, "x": 10,
          "ix": 9, "v": 5, "iv": 4, "i": 1}  # fmt: skip
STYLES: dict[str, Callable[[int], str]] = {
    "arabic": str,
    "roman": lambda n: _roman(n),
    "Roman": lambda n: _roman(n).upper(),
    "alph": lambda n: chr(ord("a") + n - 1) if 0 < n <= 26 else str(n),
    "Alph": lambda n: chr(ord("A") + n - 1) if 0 < n <= 26 else str(n),
}


class Counters:
    """LaTeX's counters: their values, and which counter sets which to zero."""

    def __init__(self) -> None:
        self.values = dict.fromkeys(("part", "chapter", *_ARTICLE), 0)
        self.parents: dict[str, str] = dict(_WITHIN)  # counter → the one whose step sets it to zero
        self.document_class = ""

    def begin(self, expander: Expander, document_class: str) -> None:
        """Print counters as a class does."""
        formats = _CLASSES.get(document_class, _ARTICLE)
        if document_class not in _CLASSES:
            expander.doubt = f"the class {document_class} is not known"
        if "chapter" in formats:
            self.parents["equation"] = "chapter"
        for name, text in formats.items():
            expander.define(rf"\the{name}", Macro.of(text), everywhere=True)

    def step(self, name: str) -> None:
        """Add one to a counter, and set those to zero that are numbered within it."""
        self.values[name] = self.values.get(name, 0) + 1
        self._reset(name)

    def _reset(self, parent: str) -> None:
        for inner in [name for name, outer in self.parents.items() if outer == parent]:
            self.values[inner] = 0
            self._reset(inner)

    def printed(self, expander: Expander, name: str) -> str:
        """Return a counter as it is printed."""
        return plain_number(latex_of(expander.expand((Token("command", rf"\the{name}", 0),))))

    def begin_appendix(self, expander: Expander, star: bool = False) -> None:
        r"""\appendix: letters for chapters or sections."""
        top = "chapter" if r"\thechapter" in expander.macros else "section"
        self.values[top] = 0
        self._reset(top)
        self._print(expander, top, rf"\Alph{{{top}}}")
        if text := _APPENDICES.get(self.document_class):
            self.parents["equation"] = "section"
            self._print(expander, "equation", text.replace("}", "}.", 1) if star else text)

    def _print(self, expander: Expander, name: str, text: str) -> None:
        expander.define(rf"\the{name}", Macro.of(text), everywhere=True)

    # ---- commands

    def primitives(self) -> dict[str, Primitive]:
        """Return the commands that set and print counters."""
        setting = r"\newcounter \setcounter \addtocounter \stepcounter \refstepcounter"
        within = r"\@addtoreset \numberwithin \counterwithin \counterwithout"
        return {
            r"\documentclass": self._class,
            r"\value": self._value,
            r"\chapterdot": self._chapter,
            **dict.fromkeys(setting.split(), self._set),
            **dict.fromkeys(within.split(), self._number_within),
            **{rf"\{style}": self._show for style in STYLES},
        }

    def _class(self, expander: Expander, token: Token) -> bool:
        options, name = latex_of(expander.optional() or ()).strip(), expander.name()
        if not self.document_class:  # a part that could stand by itself has another
            self.document_class = name
            self.begin(expander, name)
            if name == "subfiles":
                expander.notes.append(
                    f"the source is a part of {options}: give this file, whose commands and numbers it uses"
                )
        return True

    def _set(self, expander: Expander, token: Token) -> bool:
        name, values = expander.name(), self.values
        if token.text == r"\newcounter":
            values[name] = 0
            expander.define(rf"\the{name}", Macro.of(rf"\arabic{{{name}}}"), everywhere=True)
            if parent := latex_of(expander.optional() or ()).strip():
                self.parents[name] = parent
        elif "step" in token.text:
            self.step(name)
        else:
            shown = latex_of(expander.expand(expander.argument())).strip()
            if re.fullmatch(r"[+-]?\d+", shown):
                values[name] = int(shown) + (values.get(name, 0) if token.text == r"\addtocounter" else 0)
            else:
                expander.doubt = f"{expander.place(token.at)}: {token.text}{{{name}}}{{{shown}}} is not known"
        return True

    def _number_within(self, expander: Expander, token: Token) -> bool:
        star = expander.star()
        style = latex_of(expander.optional() or ()).strip().lstrip("\\") or "arabic"
        name, parent = expander.name(), expander.name()
        text = rf"\the{parent}.\{style}{{{name}}}"
        if token.text == r"\counterwithout":
            self.parents.pop(name, None)
            text = rf"\arabic{{{name}}}"
        else:
            self.parents[name] = parent
        if not star and token.text != r"\@addtoreset":
            expander.define(rf"\the{name}", Macro.of(text), everywhere=True)
        return True

    def _show(self, expander: Expander, token: Token) -> bool:
        name = expander.name()
        if name not in self.values:
            expander.push(tokenize(f"{{{name}}}", token.at))
            return False
        expander.push(plain(STYLES[token.text[1:]](self.values[name]), token.at))
        return True

    def _value(self, expander: Expander, token: Token) -> bool:
        expander.push(plain(str(self.values.get(expander.name(), 0)), token.at))
        return True

    def _chapter(self, expander: Expander, token: Token) -> bool:
        """Print the number of the chapter before an equation's, where there is one."""
        expander.push(tokenize(r"\thechapter.", token.at) if self.values["chapter"] else ())
        return True


_FONTS = re.compile(
    r"\\(?:ensuremath|text\w*|math\w+|[mh]box|rm|bf|it|normalfont|(?:foot)?notesize|normalsize|small|relax)(?![A-Za-z])|[${}]"
)
_MARKS = {r"\ast": "*", r"\star": "*", r"\ddagger": "‡", r"\dagger": "†", r"^\prime": "'", r"\prime": "'"}


def plain_number(text: str) -> str:
    r"""Return a number without fonts, dollar signs, braces and brackets around it: \textbf{2.1} is 2.1, $3'$ is 3'."""
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
    """Return label → number as LaTeX wrote it beside the source; empty where it has not."""
    file = source.with_suffix(".aux")
    if not file.is_file():
        return {}
    text = file.read_text(encoding="utf-8", errors="replace")
    for name in re.findall(r"\\@input\{([^{}]*)\}", text):
        inner = file.parent / name
        if inner.resolve().is_relative_to(file.parent.resolve()) and inner.is_file():
            text += inner.read_text(encoding="utf-8", errors="replace")
    rows = re.findall(r"\\newlabel\{([^{}]*)\}\{\{((?:[^{}]|\{[^{}]*\})*)\}", text)
    return {label: plain_number(number) for label, number in rows}
