"""The tokens of a source and of the files that it includes, in their order, and the reading of arguments from them."""

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.latex.tokens import BRACES, Token, latex_of, plain, tokens_of

_MOST_FILES, _LONGEST_NAME = 500, 80
# TeX ignores NUL. Another control character belongs to no formula and to no file that stores one.
_CONTROL = {0: None, **{c: "\ufffd" for c in (*range(1, 32), 127) if chr(c) not in "\t\n\r"}}
EMPTY_LINE = re.compile(r"\n\s*\n\s*")
_NO_ARGUMENT = (r"\left", r"\right", r"\begin", r"\end")


class TokenStream:
    """A stream of tokens without expansion: `next()` returns the next token, `push()` puts tokens back before it.

    `notes` holds sentences about doubtful readings. The keys (position, sentence) of `faults` are errors at which TeX
    would stop.
    """

    def __init__(self, text: str, file: Path | None = None) -> None:
        self.file = file
        self.notes: list[str] = []
        self.faults: dict[tuple[int, str], None] = {}
        self.waiting: list[Iterator[Token]] = []  # the innermost file or expansion is the last
        self.length = 0  # of all files, in characters
        self._starts: list[tuple[int, str, list[int]]] = []  # a row per file: first position, name, line ends
        self._reading: list[tuple[Path, Iterator[Token]]] = []
        self.take_in(text, file or Path("source"))

    # ---- files

    def take_in(self, text: str, file: Path) -> None:
        """Read the text of a file next. Raises InputError if the file includes itself, or after _MOST_FILES files."""
        text = text.translate(_CONTROL)
        if file in (path for path, _ in self._open_files()):
            raise InputError(f"{file} includes itself, directly or through another file: remove one \\input")
        if len(self._starts) == _MOST_FILES:
            raise InputError(f"{self.file}: more than {_MOST_FILES} files are included: give its parts one by one")
        name = "" if self.file is None else file.name
        if self.file is not None and self._starts:
            name = file.resolve().relative_to(self.file.resolve().parent).as_posix()
        self._starts.append((self.length, name, [m.start() for m in re.finditer("\n", text)]))
        tokens = tokens_of(text, self.length)
        self.waiting.append(tokens)
        self._reading.append((file, tokens))
        self.length += len(text) + 1

    def _included_file(self, name: str) -> Path | None:
        """Return the path of an included file; None if it is missing or lies outside the folder of the source.

        It is sought in the folder of the source and in that of the including file; a note names a file outside.
        """
        if self.file is None or len(name) > _LONGEST_NAME:
            return None
        root = self.file.resolve().parent
        folders = (self.file.parent, (self._open_files() or self._reading)[-1][0].parent)
        for path in (folder / (name.strip('" ') + suffix) for folder in folders for suffix in (".tex", "")):
            if path.is_file() and path.resolve().is_relative_to(root):
                return path
            if path.is_file():
                self.notes.append(f"{name} is outside the folder of the source and is not read: copy it there")
        return None

    def read_file(self, name: str, at: int) -> None:
        r"""Read the file that \input names; add a note if it is missing."""
        if (path := self._included_file(name)) is not None:
            self.take_in(read_text(path, "latin-1"), path)
        elif self.file is not None:
            self.notes.append(
                f"{self.place(at)}: {name[:_LONGEST_NAME]} is missing: put it into the folder of the source"
            )

    def end_file(self, at: int) -> bool:
        r"""Stop reading the included file that contains a position; return False if this is the main file."""
        if self._file_of(at) == 0 or len(reading := self._open_files()) < 2:
            return False
        while self.waiting.pop() is not reading[-1][1]:
            pass
        return True

    def _open_files(self) -> list[tuple[Path, Iterator[Token]]]:
        """Return the files that are not yet read to their end, each with its tokens; the innermost is the last."""
        return [row for row in self._reading if row[1] in self.waiting]

    def _file_of(self, at: int) -> int:
        return max(bisect_right(self._starts, at, key=lambda start: start[0]) - 1, 0)

    def line(self, at: int) -> tuple[str, int]:
        """Return the name of the file that contains a position, and the number of the line there, from 1."""
        start, name, ends = self._starts[self._file_of(at)]
        return name, bisect_left(ends, at - start) + 1

    def place(self, at: int) -> str:
        """Return the file and line of a position as a message begins with them: paper.tex:12, or line 12."""
        name, line = self.line(at)
        return f"{name}:{line}" if name else f"line {line}"

    def fault(self, at: int, sentence: str) -> None:
        """Record an error at which TeX would stop."""
        self.faults[at, sentence] = None

    # ---- tokens

    def next(self) -> Token | None:
        """Return the next token without expansion, or None at the end."""
        while self.waiting:
            for token in self.waiting[-1]:
                return token
            self.waiting.pop()
        return None

    def push(self, tokens: Iterable[Token]) -> None:
        self.waiting.append(iter(tokens))

    def peek(self) -> Token | None:
        """Return the next token without consuming it."""
        token = self.next()
        if token is not None:
            self.push((token,))
        return token

    def begins(self, sign: str) -> bool:
        token = self.peek()
        return token is not None and token.text.startswith(sign)

    def take(self, prefix: str) -> None:
        """Consume the next token. If it is a run of characters that begins with `prefix`, consume the prefix only."""
        token = self.next()
        if token is not None and token.kind == "text" and token.text.startswith(prefix):
            self.push(plain(token.text[len(prefix) :], token.at + len(prefix)))

    def skip_spaces(self) -> str:
        """Consume white space and return it."""
        spaces = ""
        while (token := self.next()) is not None:
            text = token.text.lstrip() if token.kind == "text" else token.text
            spaces += token.text[: len(token.text) - len(text)]
            if text:
                self.push((Token(token.kind, text, token.at + len(token.text) - len(text)),))
                break
        return spaces

    # ---- arguments

    def argument(self) -> list[Token]:
        """Consume the next argument and return its tokens: those in braces, or one character or command; [] if none."""
        self.skip_spaces()
        token = self.next()
        if token is None or token.kind in ("close", "math") or token.text in _NO_ARGUMENT:
            self.push((token,) if token else ())
            return []
        if token.kind == "open":
            return self.group(token.at)
        if token.kind == "text" and len(token.text) > 1:
            self.push(plain(token.text[1:], token.at + 1))
        return [Token(token.kind, token.text[0] if token.kind == "text" else token.text, token.at)]

    def name(self) -> str:
        """Consume an argument and return it as plain text."""
        return latex_of(self.argument()).strip()

    def group(self, at: int) -> list[Token]:
        """Consume the tokens up to the brace that closes the group opened at position `at`; return those before it."""
        inside: list[Token] = []
        depth = 1
        while (token := self.next()) is not None:
            depth += BRACES.get(token.kind, 0)
            if depth == 0:
                return inside
            inside.append(token)
        self.fault(at, "{ is not closed: the text up to the end becomes the argument")
        return inside

    def _until(self, opening: str, closing: str, at: int) -> list[Token]:
        """Consume the tokens up to the matching closing sign, and this sign; return those before it.

        Pairs of the two signs may be nested. `at` is the position of the opening sign.
        """
        inside: list[Token] = []
        braces, depth = 0, 1
        while (token := self.next()) is not None:
            text = EMPTY_LINE.split(token.text)[0] if token.kind == "text" and not braces else ""
            for place, sign in enumerate(text):
                depth += (sign == opening) - (sign == closing)
                if depth == 0:
                    self.push(plain(token.text[place + 1 :], token.at + place + 1))
                    return inside + plain(text[:place], token.at)
            braces += BRACES.get(token.kind, 0)
            if braces < 0 or ends_paragraph(token):
                self.push((token,))
                break
            inside.append(token)
        self.fault(at, f"the argument has no closing {closing} in its paragraph")
        return inside

    def delimited(self, opening: str, closing: str) -> list[Token] | None:
        """Consume an argument between two characters and return its tokens; None if the first does not come next."""
        spaces, first = self.skip_spaces(), self.peek()
        if first is None or first.kind != "text" or not first.text.startswith(opening):
            self.push(plain(spaces, first.at - len(spaces) if first else 0))
            return None
        self.take(opening)
        return self._until(opening, closing, first.at)

    def optional(self) -> list[Token] | None:
        """Consume an optional argument in square brackets and return its tokens; None if there is none."""
        return self.delimited("[", "]")

    def star(self) -> bool:
        """Consume a star; return True if there was one."""
        if not self.begins("*"):
            return False
        self.take("*")
        return True


def ends_paragraph(token: Token) -> bool:
    return token.text == r"\par" or (token.kind == "text" and EMPTY_LINE.search(token.text) is not None)
