"""The conversion of LaTeX text to tokens (commands, braces, scripts, runs of characters), and of tokens to text."""

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

_VERBATIM = r"verbatim\*?|Verbatim\*?|BVerbatim|lstlisting|minted|comment|filecontents\*?|asy|asydef"
_DEFINED = r"(?:\[[^][\n]*\]|\{[^{}\n]*\})*[\s%]*\}[\s%]*\{"  # the definition of another environment follows
_TOKEN = re.compile(
    rf"(?P<raw>\\begin\{{(?P<name>{_VERBATIM})\}}(?!{_DEFINED}).*?\\end\{{(?P=name)\}}"
    r"|\\(?:verb\*?|lstinline(?:\[[^][\n]*\])?)(?P<mark>[^A-Za-z\s*{[])[^\n]*?(?P=mark)"
    r"|\\(?:url|href|path|nolinkurl)\s*\{[^{}\n]*\})"
    r"|(?P<comment>%[^\n]*(?:\n[ \t]*)?)"
    r"|(?P<command>\\(?:[A-Za-z@]+|.|\n))"
    r"|(?P<open>\{)|(?P<close>\})|(?P<math>\$\$?)|(?P<align>&)|(?P<script>[\^_])|(?P<param>\#\#?\d?)"
    r"|(?P<text>[^\\{}$%&#^_]+)|(?P<stray>\\)",
    re.DOTALL,
)

# The change of nesting depth at a token: of environments by its text, of braces by its kind.
NESTING = {r"\begin": 1, r"\end": -1}
BRACES = {"open": 1, "close": -1}


class Token(NamedTuple):
    r"""One token; `kind` is command, open, close, math, align, script, param, text or raw; `at` is its position.

    An `Expander` adds the kinds begin and end (\begin{x} and \end{x} as one token) and primitive (a command that no
    definition changes). Its kind scope marks the end of the definitions inside an environment.
    """

    kind: str
    text: str
    at: int


def tokenize(text: str, base: int = 0) -> list[Token]:
    """Return the tokens of a text without its comments; `base` is the position of its first character."""
    return list(tokens_of(text, base))


def tokens_of(text: str, base: int = 0) -> Iterator[Token]:
    for match in _TOKEN.finditer(text):
        kind = match.lastgroup or "text"
        if kind in ("name", "mark"):
            kind = "raw"
        if kind != "comment":
            yield Token(kind, match[0], base + match.start())


def latex_of(tokens: Iterable[Token]) -> str:
    """Return the tokens as LaTeX, with a space between a command and a letter after it."""
    pieces: list[str] = []
    word = False
    for token in tokens:
        if word and token.text[:1].isalpha():
            pieces.append(" ")
        pieces.append(token.text)
        word = token.kind == "command" and token.text[-1].isalpha()
    return "".join(pieces)


def plain(text: str, at: int) -> list[Token]:
    """Return a run of characters as a list with one token; an empty text gives an empty list."""
    return [Token("text", text, at)] if text else []
