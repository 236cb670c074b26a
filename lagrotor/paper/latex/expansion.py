r"""A source as TeX sees it: macros expanded, what \iffalse hides left out, counters kept.

Nothing is executed: definitions are lists of tokens, and their expansion is bounded.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.paper.latex.counters import Counters
from lagrotor.paper.latex.groups import Macro
from lagrotor.paper.latex.token_stream import TokenStream
from lagrotor.paper.latex.tokens import Token, latex_of, plain, tokenize

_MOST_EXPANSIONS = 20_000  # of what stands at one place; beyond, a macro calls itself without end
_MOST_OF_STYLES = 1_000  # as many, of a package whose conditions are not known
_OPENING, _CLOSING = ("{", r"\left", r"\begingroup", r"\bgroup"), ("}", r"\right", r"\endgroup", r"\egroup")
STYLES = (".sty", ".cls", ".def")
# What stands for an optional argument that is not given.
NO_VALUE = Token("command", r"\NoValue", 0)

# A command of a package: takes its arguments from the source and gives the tokens that stand for it.
Package = Callable[["Expander"], Iterable[Token] | None]
# A command of TeX or LaTeX: acts; whether no token of it is left.
Primitive = Callable[["Expander", Token], bool]


class Expander(TokenStream):
    """The expanded tokens of a source, one after the other, by `tokens()`."""

    def __init__(
        self,
        text: str,
        file: Path | None,
        primitives: Mapping[str, Primitive],
        packages: Mapping[str, Package] | None = None,
        bare: Collection[str] = (),
    ) -> None:
        super().__init__(text, file, bare)
        self.primitives, self.packages = primitives, packages or {}
        self.own: dict[str, Package] = {}  # commands that the source defines and no list of tokens can hold
        self.level: int | None = None  # to which groups are closed, once what read an environment has its number
        self.original = False  # whether the environment that comes next is the one that the source has defined anew
        self.theorems: dict[str, str] = {}  # environments that count: their counter
        self.environments: dict[str, tuple[Macro, tuple[Token, ...]]] = {}
        self.verbatim: set[str] = set()  # environments of the source that show what stands in them
        self.flags: dict[str, bool] = {}
        self.counters = Counters()
        self.loaded: set[str] = set()
        self.passed: dict[str, list[str]] = {}  # package or class → options that it is to be loaded with
        # packages and classes of no distribution that are not beside the source: their line
        self.missing: dict[str, int] = {}
        self.first: list[Token] = []  # what is done at the beginning of the document
        self.document_class = ""
        self.notes: list[str] = []
        self.stepped = ""  # the number that \refstepcounter in the text gave
        self.expansions: Counter[int] = Counter()  # by place: what a macro stands for has the place of the macro

    def tokens(self) -> Iterator[Token]:
        """Every token that is left after expansion, definitions and conditions taken out."""
        while (token := self.next()) is not None:
            if self.level is not None:
                self.macros.close_to(self.level, say=False)
                self.level = None
            if token.kind == "scope":
                self.macros.close_to(self.macros.end_environment(token.text, token.at), say=False)
                continue
            if token.kind != "text" and token.text not in self.macros:
                if token.text in _OPENING:
                    self.macros.open(token.text, token.at)
                elif token.text in _CLOSING:
                    self.macros.close(token)
                elif token.kind == "align" or token.text == r"\\":
                    self.macros.end_cell()
            if token.kind == "command":
                if not self._expanded(token):
                    yield token
            elif token.kind == "primitive":  # what a name meant before it was defined anew
                primitive = self.primitives.get(token.text)
                if primitive is None or not primitive(self, token):
                    yield Token("command", token.text, token.at)
            else:
                yield token

    def expand(self, tokens: Iterable[Token]) -> list[Token]:
        """These tokens, expanded by themselves."""
        kept, level, depth = self.waiting, self.level, len(self.macros.groups)
        self.waiting, self.level = [list(tokens)[::-1]], None
        try:
            return list(self.tokens())
        finally:
            self.waiting, self.level = kept, level
            self.macros.close_to(depth, say=False)

    def _expanded(self, token: Token) -> bool:
        """Whether the token stood for others, which now come next, or defined something."""
        name = token.text
        macro = self.macros.get(name)
        if macro is not None:
            style = self.file_of(macro.body[0].at)[1] if macro.body else ""
            if self.expansions[token.at] > _MOST_OF_STYLES and style.endswith(STYLES):
                self.notes.append(f"{name} of {style} expands without end, and is left out")
                self.macros.define_globally(name, Macro(()))
                return True
            self.count(name, token.at)
            self.push(self.body(macro, token))
            return True
        command = self.own.get(name) or self.packages.get(name)
        if command is not None:
            given = command(self)
            if given is None:
                return False
            self.count(name, token.at)
            self.push(Token(t.kind, t.text, token.at) for t in given)
            return True
        counter = name[3:] if name.startswith(r"\c@") else ""
        known = r"\if" if name[1:] in self.flags else r"\c@" if counter in self.counters.values else name
        primitive = self.primitives.get(known)
        if primitive is not None:
            return primitive(self, token)
        if name.startswith(r"\the") and name[4:] in self.counters.values:
            self.push(plain(self.printed(name[4:]), token.at))
            return True
        return False

    def count(self, name: str, at: int) -> None:
        """One expansion more at a place, of which there may be so many."""
        self.expansions[at] += 1
        if self.expansions[at] > _MOST_EXPANSIONS or sum(map(len, self.waiting[-3:])) > self.most:
            raise InputError(
                f"{self.file or 'the source'}: {name} expands without end: a macro that calls itself cannot be taken in"
            )

    def body(self, macro: Macro, token: Token) -> list[Token]:
        """The body of a macro with its arguments put in; every token has the place of the macro."""
        values: list[list[Token]] = []
        if macro.spec:
            values = [self._by_spec(letter, default) for letter, default in _spec(macro.spec)]
        else:
            head = list(macro.head)
            if macro.default is not None:
                given = self.optional()
                values.append(list(macro.default) if given is None else given)
                head = head[1:]
            for place, part in enumerate(head):
                following = head[place + 1] if place + 1 < len(head) else None
                if part.kind == "param":
                    delimited = following is not None and following.kind != "param"
                    values.append(self.until(following, token) if delimited and following else self.argument())
                elif (part.kind != "text" or part.text.strip()) and not (place and head[place - 1].kind == "param"):
                    self.take(part)
        made: list[Token] = []
        for part in macro.body:
            if part.kind == "param" and part.text[1:].isdigit():
                number = int(part.text[1:])
                made += values[number - 1] if number <= len(values) else []
            elif part.kind == "param" and part.text.startswith("##"):
                made.append(Token("param", part.text[1:], token.at))
            else:
                made.append(Token(part.kind, part.text, token.at))
        if len(made) > self.most:
            raise InputError(f"{self.file or 'the source'}: {token.text} expands to more than {self.most} tokens")
        return made

    def _by_spec(self, letter: str, default: list[Token]) -> list[Token]:
        if letter == "s":
            return [Token("text", "*" if self.star() else "", 0)]
        if letter in "oOdD":
            given = self.optional() if letter in "oO" else self.delimited("(", ")")
            return given if given is not None else default if letter in "OD" else [NO_VALUE]
        return self.argument()

    def printed(self, counter: str) -> str:
        r"""A counter as it is printed, \theequation."""
        own = self.macros.get(rf"\the{counter}")
        if own is not None:
            return unstyled(latex_of(self.expand(own.body)))
        return self.counters.printed(counter, self.printed)

    def refer(self, number: str, everywhere: bool = False) -> None:
        r"""What a label refers to from now on, \@currentlabel: in the group that is open, or in all."""
        said = Macro(tuple(plain(number, 0)))
        if everywhere:
            self.macros.define_globally(r"\@currentlabel", said)
        else:
            self.macros[r"\@currentlabel"] = said

    def referred(self) -> str:
        """What a label refers to that has no number of its own."""
        known = self.macros.get(r"\@currentlabel")
        return unstyled(latex_of(known.body)) if known is not None else ""

    def number(self, tokens: Iterable[Token]) -> int:
        r"""A sum of digits, \value{…}, \arabic{…}."""
        values = self.counters.values
        shown = [plain(str(values.get(t.text[3:], 0)), t.at)[0] if t.text.startswith(r"\c@") else t for t in tokens]
        text = latex_of(self.expand(shown)).strip()
        for constant, value in ((r"\z@", "0"), (r"\@ne", "1"), (r"\tw@", "2"), (r"\m@ne", "-1"), (r"\@m", "1000")):
            text = re.sub(re.escape(constant) + "(?![A-Za-z@])", value, text)
        return sum(int(sign + digits) for sign, digits in re.findall(r"([+-]?)\s*(\d+)", text))


def _spec(text: str) -> Iterator[tuple[str, list[Token]]]:
    """The arguments of \\NewDocumentCommand: a letter each, with its default."""
    for match in re.finditer(r"([mosODdr])\s*(?:[()]{2})?\s*(?:\{([^{}]*)\})?", text):
        yield match[1], tokenize(match[2] or "")


def unstyled(text: str) -> str:
    """A number without dollar signs, braces and fonts: \\textbf{2.1} is 2.1."""
    fonts = (
        r"\\(?:ensuremath|text\w*|math\w+|[mh]box|rm|bf|it|normalfont|(?:foot)?notesize|normalsize|small)(?![A-Za-z])"
    )
    return re.sub(rf"{fonts}|[${{}}]", "", text).strip()
