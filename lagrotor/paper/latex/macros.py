r"""The expansion of the macros in a source; the parts that \iffalse hides are removed.

Nothing is executed. A definition is a list of tokens, and the number of expansions is bounded. Only the conditions
\iftrue and \iffalse are decided. For any other condition both branches are skipped, the names that they define become
unknown, and a note gives the line.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from lagrotor.errors import InputError
from lagrotor.paper.latex import packages
from lagrotor.paper.latex.token_stream import TokenStream
from lagrotor.paper.latex.tokens import Token, plain, tokenize

_MOST_EXPANSIONS = 20_000  # at one position of the source; a macro that needs more is recursive
_MOST_TOKENS = 2_000_000  # of all expansions, in addition to ten per character of the source
# A skipped branch that contains one of these commands is reported in a note.
_MATTER = [
    r"\begin",
    r"\[",
    r"$$",
    r"\input",
    r"\include",
    r"\chapter",
    r"\section",
    r"\subsection",
    r"\appendix",
    r"\tag",
]
_NO_VALUE = (Token("command", r"\NoValue", 0),)
# One entry of an argument specification of \NewDocumentCommand.
_ARGUMENT = re.compile(r"([msg])|([oO]|[dD]\s*(\S)(\S))\s*(?:\{([^{}]*)\})?")


class Parameter(NamedTuple):
    r"""One argument of a macro.

    kind: its letter in \NewDocumentCommand, m (mandatory), o (optional), g (optional in braces) or s (star). marks: the
    two signs around an optional argument. default: the tokens that replace a missing argument.
    """

    kind: str
    marks: str = "[]"
    default: tuple[Token, ...] = _NO_VALUE


class Macro(NamedTuple):
    """A definition: the tokens that replace a name. The tokens #1, #2, … stand for the arguments that `head` lists."""

    body: tuple[Token, ...]
    head: tuple[Parameter, ...] = ()

    @staticmethod
    def of(text: str, spec: str = "") -> "Macro":
        r"""Return the macro with the body `text` in LaTeX; `spec` lists its arguments as in \NewDocumentCommand."""
        return Macro(tuple(tokenize(text)), head_of(spec))


def head_of(spec: str) -> tuple[Parameter, ...]:
    r"""Return the arguments that a specification lists in the letters of \NewDocumentCommand, such as "som"."""
    head = []
    for letter, optional, opening, closing, default in _ARGUMENT.findall(spec):
        value = tuple(tokenize(default)) if optional[:1] in ("O", "D") else _NO_VALUE
        head.append(Parameter(letter) if letter else Parameter("o", (opening + closing) or "[]", value))
    return tuple(head)


# A command that changes the expansion; it returns False if its token remains in the text.
Primitive = Callable[["Expander", Token], bool | None]


class Expander(TokenStream):
    """An iterator over the expanded tokens of a source.

    `macros` holds the definitions that are valid at the present position. Inside a formula (`in_formula`) an undecided
    condition remains as a token, so that the reader of formulas refuses it.
    """

    def __init__(self, text: str, file: Path | None, primitives: Mapping[str, Primitive]) -> None:
        super().__init__(text, file)
        self.primitives = primitives
        self.macros: dict[str, Macro] = {}
        self.scopes: list[tuple[str, dict[str, Macro | None]]] = []  # open groups: mark, hidden definitions
        self.in_formula = False
        self.loaded: set[str] = set()
        self.doubt = ""  # reason for which equation numbers may be wrong
        self.branches = 0  # number of open conditions
        self._expansions: Counter[int] = Counter()
        self._output_size = 0
        self._stream = self._expanded()
        self.load("")

    def __iter__(self) -> Iterator[Token]:
        return self._stream

    def _expanded(self) -> Iterator[Token]:
        while (token := self.next()) is not None:
            if token.kind in ("command", "primitive"):
                if self._execute(token):
                    continue
                token = Token("command", token.text, token.at)
            elif token.kind == "open":
                self.begin_group("{")
            elif token.kind == "close":
                self.end_group("{")
            elif token.kind == "scope":
                self.end_group(token.text)
                continue
            yield token

    def expand(self, tokens: Iterable[Token]) -> list[Token]:
        """Return the expansion of these tokens; groups that they leave open are closed."""
        waiting, self.waiting = self.waiting, [iter(list(tokens))]
        depth = len(self.scopes)
        try:
            return list(self._expanded())
        finally:
            self.waiting = waiting
            self._close_to(depth)

    def _execute(self, token: Token) -> bool:
        """Expand or execute a command; return False if its token remains in the text."""
        name = token.text
        if token.kind == "command" and (macro := self.macros.get(name)) is not None:
            body = self._body(macro, token)
            self._expansions[token.at] += 1
            self._output_size += len(body)
            if self._expansions[token.at] > _MOST_EXPANSIONS or self._output_size > _MOST_TOKENS + 10 * self.length:
                sentence = f"{name} expands without end: define it without a call of itself"
                raise InputError(f"{self.place(token.at)}: {sentence}")
            self.push(body)
            return True
        if (primitive := self.primitives.get(name)) is not None:
            return primitive(self, token) is not False
        if name in (r"\begingroup", r"\bgroup"):
            self.begin_group("{")
        elif name in (r"\endgroup", r"\egroup"):
            self.end_group("{")
        elif name.startswith(r"\if") and name != r"\iff" and not self.in_formula:
            self.skip_condition(token)
            return True
        return False

    def _body(self, macro: Macro, token: Token) -> list[Token]:
        """Consume the arguments of a macro; return its body with them inserted, at the position of the calling `token`."""
        values: list[Iterable[Token]] = []
        for kind, marks, default in macro.head:
            value: list[Token] | None = None
            if kind == "s":
                value = plain("*" if self.star() else "", token.at)
            elif kind == "o":
                value = self.delimited(*marks)
            elif kind == "m" or self.begins("{"):
                value = self.argument()
            values.append(default if value is None else value)
        expansion: list[Token] = []
        for item in macro.body:
            if item.kind != "param":
                expansion.append(Token(item.kind, item.text, token.at))
            elif item.text[1:].isdigit():
                expansion += values[int(item.text[1:]) - 1] if int(item.text[1:]) <= len(values) else ()
            elif item.text.startswith("##"):
                expansion.append(Token("param", item.text[1:], token.at))
        return expansion

    # ---- definitions

    def define(self, name: str, macro: Macro | None, everywhere: bool = False) -> None:
        """Define a name in the innermost group, or in all groups (`everywhere`); None makes the name undefined."""
        if everywhere:
            for _, hidden in self.scopes:
                hidden.pop(name, None)
        elif self.scopes:
            self.scopes[-1][1].setdefault(name, self.macros.get(name))
        if macro is None:
            self.macros.pop(name, None)
        else:
            self.macros[name] = macro

    def begin_group(self, mark: str) -> None:
        """Begin a group; its mark is { or the name of an environment."""
        self.scopes.append((mark, {}))

    def end_group(self, mark: str) -> None:
        """End the innermost group that has this mark, and all groups inside it; their definitions end too."""
        for place in range(len(self.scopes) - 1, -1, -1):
            if self.scopes[place][0] == mark:
                return self._close_to(place)
        return None

    def _close_to(self, depth: int) -> None:
        while len(self.scopes) > depth:
            for name, macro in self.scopes.pop()[1].items():
                self.macros.pop(name, None)
                if macro is not None:
                    self.macros[name] = macro

    def load(self, package: str) -> None:
        """Record that a package is loaded, and define its commands if it is in the table of known packages."""
        self.loaded.add(package)
        for line in packages.TABLE.get(package, "").splitlines():
            names, _, definition = line.strip().partition(" ")
            spec, _, body = definition.partition(" ")
            for name in filter(None, names.split(",")):
                macro = Macro.of(body, spec)
                same = tuple(Token("primitive" if t.text == name else t.kind, t.text, 0) for t in macro.body)
                self.define(name, Macro(same, macro.head))

    # ---- conditions

    def skip_condition(self, condition: Token) -> None:
        """Skip the branches of an undecided condition; the names that they define become undefined.

        A note is added if the branches contain equations, headings, counters or included files.
        """
        passed: list[Token] = []
        if not self.begins("{"):
            self.skip((r"\fi",), condition, passed)
        while self.begins("{"):  # \ifthenelse{…}{…}{…}
            passed += self.argument()
        for name, following in pairwise(token.text for token in passed if token.kind == "command"):
            if name in (r"\let", r"\DeclareMathOperator") or "def" in name or "newcommand" in name:
                self.define(following, None, everywhere=True)
        if any(token.text in _MATTER or token.text.endswith("counter") for token in passed):
            helps = r"both branches are skipped; write \iftrue or \iffalse instead"
            self.notes.append(f"{self.place(condition.at)}: {condition.text} is not decided: {helps}")
            self.doubt = self.doubt or "a part of the source is skipped"

    def skip(self, ends: tuple[str, ...], condition: Token, passed: list[Token] | None = None) -> str:
        r"""Skip the tokens of a branch up to one of `ends` (\else, \fi) at its level; return the one it found.

        The skipped tokens are appended to `passed`. Return "" with a fault if the end is missing.
        """
        depth = 0
        while (token := self.next()) is not None:
            if depth == 0 and token.text in ends:
                return token.text
            depth += -1 if token.text == r"\fi" else self.is_condition(token)
            if passed is not None:
                passed.append(token)
        self.fault(condition.at, rf"{condition.text} has no \fi: the text up to the end is skipped")
        return ""

    def is_condition(self, token: Token) -> bool:
        r"""Return True if a command begins a condition that \fi ends. A command whose arguments are in braces does not."""
        return token.text.startswith(r"\if") and token.text != r"\iff" and not self.begins("{")
