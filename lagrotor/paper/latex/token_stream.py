"""The tokens of a source and of the files that it takes in, one after the other, and the arguments read from them."""

import os
import re
from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterable, Iterator
from itertools import islice
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.latex.groups import Macro, Macros
from lagrotor.paper.latex.tokens import BRACES, Token, latex_of, plain, tokenize, tokens_of

_MOST_TOKENS, _MOST_FILES = 2_000_000, 500
_AHEAD = 4096  # tokens of a file that are made at a time
# TeX passes over NUL; another control character is no part of a formula, nor of a file that keeps one.
_CONTROL = {0: None, **{c: "\ufffd" for c in (*range(1, 32), 127) if chr(c) not in "\t\n\r"}}
_EMPTY_LINE = re.compile(r"\n\s*\n")
_NO_ARGUMENT = (r"\left", r"\right", r"\begin", r"\end")


def _from_folder(file: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # on another drive
        return file.name


class FileTokens(list[Token]):
    """The next tokens of a file in reverse order; the others are made as they are needed."""

    def __init__(self, text: str, at: int) -> None:
        super().__init__()
        self.after: list[Token] = []  # what comes next once the file has ended
        self.options: list[str] = []  # with which it is loaded
        self.prefix = ""  # of the names of what holds them
        self.declared: dict[str, list[Token]] = {}  # what each option of it does
        self.begin(text, at)

    def begin(self, text: str, at: int) -> None:
        """Go on with this text, whose first character has this place."""
        self.rest = tokens_of(text, at)
        self.clear()

    def read_on(self) -> list[Token]:
        """Take in some tokens more, and give them in their order; none at the end."""
        more = list(islice(self.rest, _AHEAD))
        self[:0] = more[::-1]
        return more


class TokenStream:
    """Tokens as they stand, by `next()`; what is put before them, by `push()`; what is open in them, `macros`."""

    def __init__(self, text: str, file: Path | None = None, bare: Collection[str] = ()) -> None:
        self.file, self.bare = file, bare  # bare: suffixes of files beside the source that are not read
        self.macros = Macros({r"\empty": Macro(()), r"\@empty": Macro(())})
        self.files = 0
        self.in_vain = 0  # tokens looked at for the end of an argument that did not come
        self.most = _MOST_TOKENS  # tokens that may wait: as many as the files have characters, and what expansions add
        # where each file begins, its path from the folder of the first, its ends of lines, its text
        self.starts: list[tuple[int, str, list[int], str]] = []
        self.end = 0
        self.reading: list[tuple[Path, FileTokens]] = []  # files, and what is left of each
        self.waiting: list[list[Token]] = []  # tokens in reverse order, the innermost file or expansion last
        self.take_in(text, file or Path())

    def take_in(self, text: str, file: Path) -> None:
        text = text.translate(_CONTROL)
        self.files += 1
        self.reading = [each for each in self.reading if any(each[1] is tokens for tokens in self.waiting)]
        if file in (known for known, _ in self.reading):
            raise InputError(f"{file} takes in itself, by itself or through another file: leave out one \\input")
        if self.files > _MOST_FILES:
            raise InputError(f"{self.file}: more than {_MOST_FILES} files are taken in: give its parts")
        path = _from_folder(file, self.file.parent) if self.file is not None else file.name
        self.starts.append((self.end, path, [m.start() for m in re.finditer("\n", text)], text))
        tokens = FileTokens(text, self.end)
        self.waiting.append(tokens)
        self.reading.append((file, tokens))
        self.most += len(text)
        self.end += len(text) + 1

    def read_file(self, name: str, suffixes: tuple[str, ...] = (".tex", "")) -> bool:
        """Take in a file beside the source, beside the file that names it, or in a folder of TEXINPUTS; whether it is there."""
        if self.file is None or suffixes[0] in self.bare:
            return False
        within = next((path for path, tokens in self.reading if tokens is self.innermost_file()), self.file)
        for suffix in suffixes:
            for folder in (self.file.parent, within.parent, self.file.parent.parent, *_tex_inputs()):
                path = folder / (name.replace('"', "") + suffix)
                if not path.is_file() and path.parent.is_dir():  # as kpathsea finds it on every system
                    path = next(
                        (each for each in path.parent.iterdir() if each.name.lower() == path.name.lower()), path
                    )
                if path.is_file() and path.suffix in (".tex", ".sty", ".cls", ".ltx", ".def", ".inp"):
                    self.take_in(read_text(path, "latin-1"), path)
                    return True
        return False

    def line(self, at: int) -> tuple[str, int]:
        """The file and the line of a place."""
        start, name, ends, _ = self.file_of(at)
        return name, bisect_left(ends, at - start) + 1

    def file_of(self, at: int) -> tuple[int, str, list[int], str]:
        return self.starts[bisect_right(self.starts, at, key=lambda each: each[0]) - 1]

    def leave_file(self, at: int) -> bool:
        r"""Whether a place is in a part that could stand by itself, which \end{document} ends."""
        if not self.file_of(at)[0] or (within := self.innermost_file()) is None:
            return False
        while self.waiting.pop() is not within:
            pass
        return True

    def innermost_file(self) -> FileTokens | None:
        """What is left of the file that is read now."""
        return next((tokens for tokens in reversed(self.waiting) if isinstance(tokens, FileTokens)), None)

    def next(self) -> Token | None:
        """The next token as it stands; None at the end."""
        while self.waiting:
            tokens = self.waiting[-1]
            if tokens or (isinstance(tokens, FileTokens) and tokens.read_on()):
                return tokens.pop()
            self.waiting.pop()
            if isinstance(tokens, FileTokens) and tokens.after:
                self.waiting.append(tokens.after[::-1])
        return None

    def ahead(self) -> Iterator[Token]:
        """What `next()` will give, which stays."""
        for tokens in reversed(self.waiting):
            yield from reversed(tokens)
            while isinstance(tokens, FileTokens) and (more := tokens.read_on()):
                yield from more

    def pass_over(self, start: int, end: int, text: str) -> None:
        """Take what stands between two places; what a token has taken over the end is read again: the text behind it."""
        while (token := self.next()) is not None:
            if not start <= token.at < end:
                return self.push([token])
            if token.at + len(token.text) > end:  # a comment, or \verb
                tokens = self.waiting[-1]
                if isinstance(tokens, FileTokens):
                    tokens.begin(text, end)
                else:
                    tokens[:] = tokenize(text, end)[::-1]
        return None

    def push(self, tokens: Iterable[Token]) -> None:
        """Put tokens before what comes next."""
        added = list(tokens)
        added.reverse()
        if self.waiting and len(self.waiting[-1]) < 64:
            self.waiting[-1].extend(added)
        elif added:
            self.waiting.append(added)

    def skip_spaces(self) -> None:
        while (token := self.next()) is not None:
            if token.kind != "text":
                self.push([token])
                return
            if rest := token.text.lstrip():
                self.push([Token("text", rest, token.at + len(token.text) - len(rest))])
                return

    def peek(self) -> Token | None:
        token = self.next()
        if token is not None:
            self.push([token])
        return token

    def begins(self, sign: str) -> bool:
        """Whether a sign comes next."""
        token = self.peek()
        return token is not None and token.text.startswith(sign)

    def argument(self) -> list[Token]:
        """The next argument: what is in braces, or one character or command."""
        self.skip_spaces()
        token = self.next()
        if token is None or token.kind in ("close", "math") or token.text in _NO_ARGUMENT:
            self.push([token] if token else [])
            return []
        if token.kind == "open":
            return self.group(token.at)
        if token.kind == "text" and len(token.text) > 1:
            self.push([Token("text", token.text[1:], token.at + 1)])
            return [Token("text", token.text[0], token.at)]
        return [token]

    def following(self) -> str:
        """The argument in braces that comes next, which stays, as plain text."""
        found = self.argument()
        self.push([Token("open", "{", 0), *found, Token("close", "}", 0)])
        return latex_of(found).strip()

    def group(self, at: int) -> list[Token]:
        """What is before the brace that closes the one at a place."""
        found: list[Token] = []
        depth = 1
        while (token := self.next()) is not None:
            depth += BRACES.get(token.kind, 0)
            if depth == 0:
                return found
            found.append(token)
        self.macros.fault(at, "{", "{ is not closed: what follows is taken as its argument")
        return found

    def delimited(self, opening: str, closing: str) -> list[Token] | None:
        """What is between two characters, such as brackets, where the first comes next; None where it does not."""
        self.skip_spaces()
        token = self.peek()
        if token is None or not token.text.startswith(opening):
            return None
        self.take(Token("text", opening, 0))
        found: list[Token] = []
        at, braces, depth = token.at, 0, 1
        while (token := self.next()) is not None:
            if token.kind == "text" and not braces:
                for place, character in enumerate(token.text):
                    depth += (character == opening != closing) - (character == closing)
                    if depth == 0:
                        found += plain(token.text[:place], token.at)
                        rest = token.text[place + 1 :]
                        self.push(plain(rest, token.at + place + 1))
                        return found
            braces += BRACES.get(token.kind, 0)
            if braces < 0:
                self.push([token])
                return found
            found.append(token)
            if token.kind == "text" and not braces and _EMPTY_LINE.search(token.text):
                break
        self._looked_in_vain(found, closing, at)
        self.push([Token("text", opening, at), *found])
        return None

    def optional(self) -> list[Token] | None:
        """An optional argument, [..]; None where there is none."""
        return self.delimited("[", "]")

    def star(self, mark: str = "*") -> bool:
        """Whether a star, or another mark, comes next, which is taken."""
        if not self.begins(mark):
            return False
        self.take(Token("text", mark, 0))
        return True

    def name(self) -> str:
        """An argument as plain text."""
        return latex_of(self.argument()).strip()

    def until(self, end: Token, macro: Token) -> list[Token]:
        """The tokens before `end`, which is taken; nothing is taken where the paragraph or the group ends first."""
        found: list[Token] = []
        depth = 0
        for token in self.ahead():
            ends = (
                depth == 0
                and token.kind == end.kind
                and end.text in (token.text if end.kind == "text" else (token.text,))
            )
            before, _, rest = token.text.partition(end.text) if ends else (token.text, "", "")
            depth += BRACES.get(token.kind, 0)
            if token.text == r"\par" or ("\n" in before and _EMPTY_LINE.search(before)) or (depth < 0 and not ends):
                break
            if ends:
                for _ in range(len(found) + 1):
                    self.next()
                self.push(plain(rest, token.at))
                return found + plain(before, token.at)
            found.append(token)
        self._looked_in_vain(found, end.text, macro.at)
        return []

    def _looked_in_vain(self, passed: list[Token], end: str, at: int) -> None:
        """Count what was passed to find the end of an argument, which TeX would stop at; a source has only so much of it."""
        self.in_vain += len(passed)
        if self.in_vain > self.most:
            said = f"the argument that begins here, as many before, has no {end.strip() or 'end'} in its paragraph"
            raise InputError("{}:{}: {}: end it".format(*self.line(at), said))

    def take(self, part: Token) -> None:
        """Take what comes next; of a run of characters, those of this part."""
        token = self.next()
        if token is not None and part.kind == "text" and token.kind == "text" and token.text.startswith(part.text):
            self.push(plain(token.text[len(part.text) :], token.at + len(part.text)))


def _tex_inputs() -> list[Path]:
    """The folders in which TeX looks for files, as its user says."""
    return [Path(each.rstrip("/")) for each in os.environ.get("TEXINPUTS", "").split(os.pathsep) if each.strip("/. ")]
