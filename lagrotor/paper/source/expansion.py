r"""A source as TeX sees it: macros expanded, files taken in, what \iffalse hides left out, counters kept.

Nothing is executed: definitions are lists of tokens, and their expansion is bounded.
"""

import re
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, pairwise
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.source.counters import Counters
from lagrotor.paper.source.groups import Macro, Macros
from lagrotor.paper.source.tokens import Token, is_word, latex_of, tokenize

# Expansions of what stands at one place, and tokens that wait; beyond, a macro calls itself without end.
_MOST_EXPANSIONS, _MOST_TOKENS, _MOST_FILES = 20_000, 2_000_000, 500
_MOST_OF_STYLES = 1_000  # as many, of a package whose conditions are not known
# TeX passes over NUL; another control character is no part of a formula, nor of a file that keeps one.
_CONTROL = {0: None, **{c: "\ufffd" for c in (*range(1, 32), 127) if chr(c) not in "\t\n\r"}}
_EMPTY_LINE = re.compile(r"\n\s*\n")
_INPUTS = (r"\input", r"\include", r"\subfile", r"\subfileinclude", r"\@input")
_DEFINITIONS = (
    r"\newcommand", r"\renewcommand", r"\providecommand", r"\DeclareRobustCommand", r"\newrobustcmd",
    r"\renewrobustcmd",
)  # fmt: skip
_DOCUMENT_COMMANDS = (
    r"\NewDocumentCommand", r"\RenewDocumentCommand", r"\ProvideDocumentCommand", r"\DeclareDocumentCommand",
    r"\NewExpandableDocumentCommand",
)  # fmt: skip
_ENVIRONMENTS = (r"\newenvironment", r"\renewenvironment", r"\NewDocumentEnvironment")
_VERBATIM = "VerbatimEnvironment verbatim @verbatim Verbatim lstlisting minted comment tcblisting"
_VERBATIM_COMMANDS = {rf"\{name}" for name in _VERBATIM.split()}
# In another environment, of a class or package that is not beside the source, LaTeX may be shown and not set.
_SET = (
    "document equation align gather multline eqnarray flalign alignat displaymath math subequations split aligned gathered"
    " alignedat cases array matrix pmatrix bmatrix vmatrix Vmatrix Bmatrix smallmatrix itemize enumerate description figure"
    " table tabular tabularx longtable minipage center flushleft flushright quote quotation abstract proof frame"
    " thebibliography"
)
_SHOWN_SOURCE = re.compile(
    r"(?<!\\)%[^\n]*|\\begin\s*\{([^{}\n]+)\}|\\(?!left|right|middle|[bB]ig)[A-Za-z]+\*?(?:\[[^]\n]*\])?"
    r"(?:\|[^|\n]*\||\{[^{}\n\\]*%[^{}\n]*\})"
)
_NO_CONDITIONS = ("iff", "ifthenelse", "ifstrempty", "ifbool", "iftoggle", "ifblank", "ifdef", "ifstrequal")
_DISPLAYS = ("equation", "align", "gather", "multline", "eqnarray", "flalign", "displaymath", "subequations")
_HEADINGS = (r"\part", r"\chapter", r"\section", r"\subsection", r"\subsubsection", r"\appendix")
_OPENING, _CLOSING = ("{", r"\left", r"\begingroup", r"\bgroup"), ("}", r"\right", r"\endgroup", r"\egroup")
_NO_ARGUMENT = (r"\left", r"\right", r"\begin", r"\end")
STYLES = (".sty", ".cls", ".def")
_SHOWN = (r"\arabic", r"\roman", r"\Roman", r"\alph", r"\Alph")


# A command of a package: takes its arguments from the source and gives the tokens that stand for it.
Package = Callable[["Expander"], Iterable[Token] | None]


class Expander:
    """The expanded tokens of a source, one after the other, by `tokens()`."""

    def __init__(
        self, text: str, file: Path | None = None, packages: dict[str, Package] | None = None, bare: bool = False
    ) -> None:
        self.file, self.packages, self.bare = file, packages or {}, bare  # bare: without the packages beside the source
        self.own: dict[str, Package] = {}  # commands that the source defines and no list of tokens can hold
        self.macros = Macros({r"\empty": Macro(()), r"\@empty": Macro(())})
        self.level: int | None = None  # to which groups are closed, once what read an environment has its number
        self.original = False  # whether the environment that comes next is the one that the source has defined anew
        self.theorems: dict[str, str] = {}  # environments that count: their counter
        self.environments: dict[str, tuple[Macro, tuple[Token, ...]]] = {}
        self.verbatim: set[str] = set()  # environments of the source that show what stands in them
        self.flags: dict[str, bool] = {}
        self.counters = Counters()
        self.loaded: set[str] = set()
        self.document_class = ""
        self.notes: list[str] = []
        self.stepped = ""  # the number that \refstepcounter in the text gave
        self.files = 0
        self.expansions: Counter[int] = Counter()  # by place: what a macro stands for has the place of the macro
        self.in_vain = 0  # tokens looked at for the end of an argument that did not come
        self.most = _MOST_TOKENS  # tokens that may wait: those of the files, and what expansions add
        self.starts: list[
            tuple[int, str, list[int], str]
        ] = []  # where each file begins, its name, its ends of lines, its text
        self.end = 0
        self.reading: list[tuple[Path, list[Token]]] = []  # files, and what is left of each
        self.waiting: list[list[Token]] = []  # tokens in reverse order, the innermost file or expansion last
        self._take_in(text, file or Path())

    def _take_in(self, text: str, file: Path) -> None:
        text = text.translate(_CONTROL)
        self.files += 1
        self.reading = [each for each in self.reading if any(each[1] is tokens for tokens in self.waiting)]
        if file in (known for known, _ in self.reading):
            raise InputError(f"{file} takes in itself, by itself or through another file: leave out one \\input")
        if self.files > _MOST_FILES:
            raise InputError(f"{self.file}: more than {_MOST_FILES} files are taken in: give its parts")
        self.starts.append((self.end, file.name, [m.start() for m in re.finditer("\n", text)], text))
        self.waiting.append(tokenize(text, self.end)[::-1])
        self.reading.append((file, self.waiting[-1]))
        self.most += len(self.waiting[-1])
        self.end += len(text) + 1

    def line(self, at: int) -> tuple[str, int]:
        """The file and the line of a place."""
        start, name, ends, _ = self._file(at)
        return name, bisect_left(ends, at - start) + 1

    def _file(self, at: int) -> tuple[int, str, list[int], str]:
        return self.starts[bisect_right(self.starts, at, key=lambda each: each[0]) - 1]

    def leave_file(self, at: int) -> bool:
        r"""Whether a place is in a part that could stand by itself, which \end{document} ends."""
        within = [tokens for _, tokens in self.reading if any(tokens is each for each in self.waiting)]
        if not self._file(at)[0] or not within:
            return False
        while self.waiting.pop() is not within[-1]:
            pass
        return True

    def faults(self) -> list[tuple[str, int, str]]:
        """File and line of what TeX would stop at, where the source itself has it: of a macro's parts too little is known."""
        macros = self.macros
        macros.close_to(len(macros.groups) if self.level is None else self.level, say=False)
        open_braces = next((n for n, (mark, _) in enumerate(macros.groups) if mark != "{"), len(macros.groups))
        macros.close_to(open_braces)
        for _, at in macros.groups:  # TeX ends, and warns
            self.notes.append("{}:{}: {{ is not closed".format(*self.line(at)))
        macros.close_to(0, say=False)
        made, shown = [], dict[int, list[tuple[int, int]]]()
        for at, mark, said in sorted(macros.faults):
            start, name, _, text = self._file(at)
            if at < 0 or name.endswith(STYLES) or not self._stands(mark, text, at - start):
                continue
            if start not in shown:
                shown[start] = self._shown_source(text)
            if not any(first <= at - start < last for first, last in shown[start]):
                made.append((*self.line(at), said))
        return list(dict.fromkeys(made))

    def _stands(self, mark: str, text: str, at: int) -> bool:
        r"""Whether a mark stands at a place of the text, \begin{…} by a macro too that is nothing else."""
        if not mark.startswith(r"\begin"):
            return text.startswith(mark, at)
        word = re.compile(r"\\begin\s*\{[^{}]*\}|\\[A-Za-z@]+").match(text, at)
        macro = self.macros.get(word[0]) if word else None
        return bool(word) and (latex_of(macro.body) if macro else "".join(word[0].split())).strip() == mark  # type: ignore[index]

    def _shown_source(self, text: str) -> list[tuple[int, int]]:
        r"""Where a file may show LaTeX that is not set: environments that nothing defines, \code|…|."""
        spans, place = [], 0
        while (span := _SHOWN_SOURCE.search(text, place)) is not None:
            place = span.end()
            if (name := span[1]) is not None:
                known = name.rstrip("*") in _SET.split() or name in self.environments or name in self.theorems
                end = -1 if known or rf"\{name}" in self.macros else text.find(rf"\end{{{name}}}", place)
                place = max(place, end)
                if end < 0:
                    continue
            if not span[0].startswith("%"):
                spans.append((span.start(), place + 1))
        return spans

    # ---- tokens without expansion

    def next(self) -> Token | None:
        """The next token as it stands; None at the end."""
        while self.waiting:
            if self.waiting[-1]:
                return self.waiting[-1].pop()
            self.waiting.pop()
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
            depth += {"open": 1, "close": -1}.get(token.kind, 0)
            if depth == 0:
                return found
            found.append(token)
        self.macros.fault(at, "{", "{ is not closed: what follows is taken as its argument")
        return found

    def delimited(self, opening: str, closing: str) -> list[Token] | None:
        """What is between two characters, such as brackets, where the first comes next; None where it does not."""
        self.skip_spaces()
        token = self.next()
        if token is None or token.kind != "text" or not token.text.startswith(opening):
            self.push([token] if token else [])
            return None
        self.push([Token("text", token.text[1:], token.at + 1)] if token.text[1:] else [])
        found: list[Token] = []
        at, braces, depth = token.at, 0, 1
        while (token := self.next()) is not None:
            if token.kind == "text" and not braces:
                for place, character in enumerate(token.text):
                    depth += (character == opening != closing) - (character == closing)
                    if depth == 0:
                        found += [Token("text", token.text[:place], token.at)] if place else []
                        rest = token.text[place + 1 :]
                        self.push([Token("text", rest, token.at + place + 1)] if rest else [])
                        return found
            braces += {"open": 1, "close": -1}.get(token.kind, 0)
            if braces < 0:
                self.push([token])
                return found
            found.append(token)
            if token.kind == "text" and not braces and _EMPTY_LINE.search(token.text):
                break
        self._looked_in_vain(found, closing, at)
        self.push([Token("text", opening, at), *found])
        return None

    def _looked_in_vain(self, passed: list[Token], end: str, at: int) -> None:
        """Count what was passed to find the end of an argument, which TeX would stop at; a source has only so much of it."""
        self.in_vain += len(passed)
        if self.in_vain > self.most:
            said = f"the argument that begins here, as many before, has no {end.strip() or 'end'} in its paragraph"
            raise InputError("{}:{}: {}: end it".format(*self.line(at), said))

    def optional(self) -> list[Token] | None:
        """An optional argument, [..]; None where there is none."""
        return self.delimited("[", "]")

    def star(self) -> bool:
        """Whether a star comes next, which is taken."""
        token = self.next()
        if token is not None and token.kind == "text" and token.text.startswith("*"):
            self.push([Token("text", token.text[1:], token.at + 1)] if token.text[1:] else [])
            return True
        self.push([token] if token else [])
        return False

    def name(self) -> str:
        """An argument as plain text."""
        return latex_of(self.argument()).strip()

    # ---- expansion

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
                handler = _HANDLERS.get(token.text)
                if handler is None or not handler(self, token):
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
            style = (
                self._file(macro.body[0].at)[1] if self.expansions[token.at] > _MOST_OF_STYLES and macro.body else ""
            )
            if style.endswith(STYLES):
                self.notes.append(f"{name} of {style} expands without end, and is left out")
                self.macros.define_globally(name, Macro(()))
                return True
            self._count(name, token.at)
            self.push(self._body(macro, token))
            return True
        command = self.own.get(name) or self.packages.get(name)
        if command is not None and name not in self.macros:
            given = command(self)
            if given is None:
                return False
            self._count(name, token.at)
            self.push(Token(t.kind, t.text, token.at) for t in given)
            return True
        if name in _HANDLERS:
            return _HANDLERS[name](self, token)
        if name.startswith(r"\if") and is_word(token) and name != r"\iff":
            return self._condition(token)
        if name in (r"\else", r"\fi"):
            if name == r"\else":
                self._skip_to(("fi",), token)
            return True
        if name.startswith(r"\the") and name[4:] in self.counters.values:
            self.push(self._plain(self.printed(name[4:]), token.at))
            return True
        for ending, value in (("true", True), ("false", False)):
            if name.endswith(ending) and name[1 : -len(ending)] in self.flags:
                self.flags[name[1 : -len(ending)]] = value
                return True
        return False

    def _count(self, name: str, at: int) -> None:
        self.expansions[at] += 1
        if self.expansions[at] > _MOST_EXPANSIONS or sum(map(len, self.waiting[-3:])) > self.most:
            raise InputError(
                f"{self.file or 'the source'}: {name} expands without end: a macro that calls itself cannot be taken in"
            )

    def _body(self, macro: Macro, token: Token) -> list[Token]:
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
                    values.append(self._until(following, token) if delimited and following else self.argument())
                elif (part.kind != "text" or part.text.strip()) and not (place and head[place - 1].kind == "param"):
                    self._take(part)
        made: list[Token] = []
        for part in macro.body:
            if part.kind == "param" and part.text[1:].isdigit():
                number = int(part.text[1:])
                made += values[number - 1] if number <= len(values) else []
            elif part.kind == "param" and part.text.startswith("##"):
                made.append(Token("param", part.text[1:], token.at))
            else:
                made.append(Token(part.kind, part.text, token.at))
        if len(made) > _MOST_TOKENS:
            raise InputError(f"{self.file or 'the source'}: {token.text} expands to more than {_MOST_TOKENS} tokens")
        return made

    def _by_spec(self, letter: str, default: list[Token]) -> list[Token]:
        if letter == "s":
            return [Token("text", "*" if self.star() else "", 0)]
        if letter in "oOdD":
            given = self.optional() if letter in "oO" else self.delimited("(", ")")
            return given if given is not None else default if letter in "OD" else [_NO_VALUE]
        if letter in "gG" and ((following := self.peek()) is None or following.kind != "open"):
            return default if letter == "G" else [_NO_VALUE]
        return self.argument()

    def _if_value(self, token: Token) -> bool:
        r"""\IfValueTF, \IfNoValueT, \IfBooleanTF: of an argument of \NewDocumentCommand."""
        tested = self.argument()
        if token.text.startswith(r"\IfBoolean"):
            holds = latex_of(tested).strip() == "*"
        else:
            holds = (_NO_VALUE in tested) == token.text.startswith(r"\IfNoValue")
        ending = re.search("T?F?$", token.text)[0]  # type: ignore[index]
        branches = {letter: self.argument() for letter in ending}
        self.push(branches.get("T" if holds else "F", ()))
        return True

    def _if_then_else(self, token: Token) -> bool:
        r"""\ifthenelse{\boolean{long}}{…}{…}; what cannot be known is taken as false."""
        test, yes, no = latex_of(self.argument()).strip(), self.argument(), self.argument()
        denied = re.match(r"\\(?:NOT|not)\b\s*", test)
        bare = test[denied.end() :] if denied else test
        said = re.fullmatch(r"\\boolean\s*\{(\w+)\}", bare)
        same = re.fullmatch(r"\\equal\s*\{([^{}]*)\}\s*\{([^{}]*)\}", bare)
        if said:
            holds = self.flags.get(f"if{said[1]}", False)
        elif same:
            first, second = (latex_of(self.expand(tokenize(each))).strip() for each in same.groups())
            holds = first == second
        else:
            self.notes.append(rf"\ifthenelse{{{test}}} is taken as false")
            holds = bool(denied)
        self.push(yes if holds != bool(denied) else no)
        return True

    def _boolean(self, token: Token) -> bool:
        name = f"if{self.name()}"
        self.flags[name] = token.text == r"\setboolean" and self.name() == "true"
        return True

    def _theorem(self, token: Token) -> bool:
        r"""\newtheorem{name}[counter]{Title}[within]: an environment that counts."""
        if self.star():
            return True
        name, shared = self.name(), self.optional()
        self.argument()
        within = self.optional()
        self.theorems[name] = latex_of(shared).strip() if shared is not None else name
        if shared is None:
            self.counters.add(name, latex_of(within).strip() if within is not None else "")
        return True

    def _take(self, part: Token) -> None:
        token = self.next()
        if token is not None and part.kind == "text" and token.kind == "text" and token.text.startswith(part.text):
            rest = token.text[len(part.text) :]
            self.push([Token("text", rest, token.at)] if rest else [])

    def _until(self, end: Token, macro: Token) -> list[Token]:
        """The tokens before `end`, which is taken; nothing is taken where the paragraph or the group ends first."""
        found: list[Token] = []
        depth = 0
        for token in chain.from_iterable(map(reversed, reversed(self.waiting))):
            ends = (
                depth == 0
                and token.kind == end.kind
                and end.text in (token.text if end.kind == "text" else (token.text,))
            )
            before, _, rest = token.text.partition(end.text) if ends else (token.text, "", "")
            depth += {"open": 1, "close": -1}.get(token.kind, 0)
            if token.text == r"\par" or ("\n" in before and _EMPTY_LINE.search(before)) or (depth < 0 and not ends):
                break
            if ends:
                for _ in range(len(found) + 1):
                    self.next()
                self.push(self._plain(rest, token.at))
                return found + self._plain(before, token.at)
            found.append(token)
        self._looked_in_vain(found, end.text, macro.at)
        return []

    @staticmethod
    def _plain(text: str, at: int) -> list[Token]:
        return [Token("text", text, at)] if text else []

    # ---- counters

    def printed(self, counter: str) -> str:
        r"""A counter as it is printed, \theequation."""
        own = self.macros.get(rf"\the{counter}")
        if own is not None:
            return latex_of(self.expand(own.body)).strip()
        return self.counters.printed(counter, self.printed)

    def number(self) -> int:
        r"""The number of an argument: digits, \value{…}, \arabic{…}, a sum of them is not needed."""
        return self._number(self.argument())

    def _number(self, tokens: Iterable[Token]) -> int:
        text = latex_of(self.expand(tokens)).strip()
        for constant, value in ((r"\z@", "0"), (r"\@ne", "1"), (r"\tw@", "2"), (r"\m@ne", "-1")):
            text = text.replace(constant, value)
        text = re.sub(r"\\c@(\w+)", lambda m: str(self.counters.values.get(m[1], 0)), text)
        total = 0
        for sign, digits in re.findall(r"([+-]?)\s*(\d+)", text):
            total += -int(digits) if sign == "-" else int(digits)
        return total

    # ---- conditions

    def _condition(self, token: Token) -> bool:
        r"""Take the branch of \if…: what cannot be known is taken as false."""
        name = token.text[1:]
        if name == "ifnum":
            holds = self._compared()
        elif name in ("iftrue", "ifmmode", "ifpdf", "ifPDFTeX"):
            holds = True
        elif name in self.flags:
            holds = self.flags[name]
        elif name == "ifx":
            first, second = self.next(), self.next()
            holds = first is not None and second is not None and self._same(first, second)
        elif name in ("iffalse", "ifdraft", "ifluatex", "ifxetex", "ifLuaTeX", "ifXeTeX"):
            holds = False
        elif name in (
            "ifdim",
            "if",
            "ifcat",
            "ifodd",
            "ifdefined",
            "ifcsname",
            "ifvmode",
            "ifhmode",
            "ifinner",
            "ifcase",
        ):
            self.notes.append(rf"\{name} is taken as false")
            holds = False
        else:
            return False
        if not holds:
            self._skip_to(("else", "fi"), token)
        return True

    def _same(self, first: Token, second: Token) -> bool:
        a, b = self.macros.get(first.text), self.macros.get(second.text)
        if a is not None and b is not None:
            return [t[:2] for t in a.body] == [t[:2] for t in b.body]
        return a is None and b is None and first.text == second.text

    def _compared(self) -> bool:
        found: list[Token] = []
        while (token := self.next()) is not None:
            found.append(token)
            if token.kind == "text" and re.search(r"[<>=]\s*-?\d+\s", token.text):
                break
            if token.kind == "command" and token.text in (r"\relax", r"\z@", r"\@ne", r"\tw@"):
                break
            if len(found) > 12:
                break
        for place, token in enumerate(found):
            if token.kind == "text" and (sign := re.search(r"[<>=]", token.text)):
                relation = sign[0]
                left_tokens = [*found[:place], Token("text", token.text[: sign.start()], token.at)]
                right = re.match(r"\s*-?\d+\s?", token.text[sign.end() :])
                right_text = right[0] if right else ""
                rest = token.text[sign.end() + len(right_text) :]
                right_tokens = [Token("text", right_text, token.at)] if right else found[place + 1 :]
                if right:
                    self.push([*self._plain(rest, token.at), *found[place + 1 :]])
                a, b = self._number(left_tokens), self._number(right_tokens)
                return {"<": a < b, ">": a > b, "=": a == b}[relation]
        self.push(found)
        self.notes.append(r"\ifnum is taken as false")
        return False

    def _skip_to(self, ends: tuple[str, ...], condition: Token) -> None:
        """Leave out tokens to the \\else or \\fi of this condition."""
        depth = 0
        while (token := self.next()) is not None:
            if token.kind != "command":
                continue
            word = token.text[1:]
            if depth == 0 and word in ends:
                return
            if word == "fi":
                depth -= 1
            elif word.startswith("if") and word not in _NO_CONDITIONS:
                depth += 1
        self.macros.fault(condition.at, condition.text, rf"{condition.text} has no \fi: what follows is left out")

    # ---- definitions

    def _defined(self, token: Token) -> bool:
        self.star()
        self.skip_spaces()
        named = self.argument()
        count = self.optional()
        default = self.optional() if count is not None else None
        body = self.argument()
        name = next((t.text for t in named if t.kind == "command"), "")
        if not name or (token.text == r"\providecommand" and (name in self.macros or name in self.packages)):
            return True
        if self._is_kept(name, body):
            return True
        digits = latex_of(count or ()).strip()
        head = [Token("param", f"#{n + 1}", 0) for n in range(int(digits) if digits.isdigit() else 0)]
        self.macros[name] = Macro(tuple(body), tuple(head), None if default is None else tuple(default))
        return True

    @staticmethod
    def _is_kept(name: str, body: list[Token]) -> bool:
        """Whether a class says by LaTeX's inner commands how a command looks whose meaning is known here, or reads ahead."""
        known = name in _HEADINGS or name in _HANDLERS
        return any(
            t.text in (r"\@setfontsize", r"\futurelet", r"\not@math@alphabet")
            or (known and "@" in t.text and t.kind == "command")
            for t in body
        )

    def _target(self) -> Token | None:
        r"""The command that is defined next, \csname … \endcsname too."""
        self.skip_spaces()
        while (token := self.next()) is not None and token.text == r"\expandafter":
            self.skip_spaces()
        if token is None or token.text != r"\csname":
            return token
        name: list[Token] = []
        while (part := self.next()) is not None and part.text != r"\endcsname":
            name.append(part)
        return Token("command", "\\" + latex_of(self.expand(name)).strip(), token.at)

    def _if_next(self, token: Token) -> bool:
        r"""\@ifnextchar[{…}{…} and \@ifstar{…}{…}: what comes next says which of the two."""
        wanted = latex_of(self.argument()).strip() if token.text == r"\@ifnextchar" else "*"
        first, second = self.argument(), self.argument()
        self.skip_spaces()
        after = self.next()
        self.push([after] if after else [])
        comes = after is not None and latex_of([after]).startswith(wanted)
        if comes and token.text == r"\@ifstar":
            self.star()
        self.push(first if comes else second)
        return True

    def _named(self, token: Token) -> bool:
        self.push([token])
        made = self._target()
        self.push([made] if made else [])
        return True

    def _def(self, token: Token) -> bool:
        target = self._target()
        head: list[Token] = []
        while (part := self.next()) is not None and part.kind != "open":
            head.append(part)
        body = self.group(token.at)
        by_lines = any(a.text == b.text == "^" for a, b in pairwise(head))  # ^^M: it reads lines as they stand
        if target is not None and target.kind == "command" and not by_lines and not self._is_kept(target.text, body):
            if token.text in (r"\edef", r"\xdef"):  # a command that is not known yet cannot stand for itself
                body = [part for part in self.expand(body) if part.text != target.text]
            macro = Macro(tuple(body), tuple(head))
            if token.text in (r"\gdef", r"\xdef"):
                self.macros.define_globally(target.text, macro)
            else:
                self.macros[target.text] = macro
        return True

    def _let(self, token: Token) -> bool:
        target, source = self._target(), self._target()
        if source is not None and source.kind == "text" and source.text.startswith("="):
            rest = source.text[1:].lstrip()
            if rest:
                self.push([Token("text", rest, source.at)])
            source = self._target()
        if source is not None and source.kind == "text" and len(source.text) > 1:
            self.push([Token("text", source.text[1:], source.at + 1)])
            source = Token("text", source.text[0], source.at)
        if target is not None and source is not None and target.kind == "command":
            known = self.macros.get(source.text)
            if known is not None:
                self.macros[target.text] = known
            elif source.kind == "command" and source.text in self.packages:
                self.own[target.text] = self.packages[source.text]
            elif source.text != target.text:
                kind = "primitive" if source.kind == "command" else source.kind
                self.macros[target.text] = Macro((Token(kind, source.text, source.at),))
        return True

    def _operator(self, token: Token) -> bool:
        star = "*" if self.star() else ""
        named, body = self.argument(), self.argument()
        if named:
            made = [Token("command", r"\operatorname", 0), *self._plain(star, 0), Token("open", "{", 0)]
            self.macros[named[0].text] = Macro((*made, *body, Token("close", "}", 0)))
        return True

    def _pair(self, token: Token) -> bool:
        r"""\DeclarePairedDelimiter{\abs}{|}{|}; \DeclarePairedDelimiterX{\ip}[2]{<}{>}{#1,#2}."""
        named = self.argument()
        count = latex_of(self.optional() or ()).strip()
        left, right = self.argument(), self.argument()
        body = self.argument() if token.text.endswith("X") else [Token("param", "#1", 0)]
        opened, closed = Token("command", r"\left", 0), Token("command", r"\right", 0)
        inside = [each for each in body if each.text != r"\delimsize"]
        head = tuple(Token("param", f"#{n + 1}", 0) for n in range(int(count) if count.isdigit() else 1))
        made = Macro((opened, *left, *inside, closed, *right), head)

        def paired(expander: Expander) -> Iterable[Token]:
            if not expander.star():
                expander.optional()
            return expander._body(made, token)

        if named:
            self.macros.pop(named[0].text, None)
            self.own[named[0].text] = paired
        return True

    def _document_command(self, token: Token) -> bool:
        named, spec, body = self.argument(), latex_of(self.argument()), self.argument()
        if named:
            self.macros[named[0].text] = Macro(tuple(body), spec=spec.strip() or " ")
        return True

    def _environment(self, token: Token) -> bool:
        self.star()
        name = self.name()
        if token.text == r"\NewDocumentEnvironment":
            spec, begin, end = latex_of(self.argument()), self.argument(), self.argument()
            self.environments[name] = Macro(tuple(begin), spec=spec.strip() or " "), tuple(end)
            return True
        count = self.optional()
        default = self.optional() if count is not None else None
        begin, end = self.argument(), self.argument()
        if _VERBATIM_COMMANDS & {part.text for part in begin}:
            self.verbatim.add(name)
        digits = latex_of(count or ()).strip()
        head = tuple(Token("param", f"#{n + 1}", 0) for n in range(int(digits) if digits.isdigit() else 0))
        self.environments[name] = Macro(tuple(begin), head, None if default is None else tuple(default)), tuple(end)
        return True

    def _verbatim_environment(self, token: Token) -> bool:
        r"""\lstnewenvironment, \DefineVerbatimEnvironment, \newminted, \newtcblisting, \excludecomment."""
        first = self.optional()
        name = self.name()
        if token.text == r"\newminted":
            name = latex_of(first).strip() if first else f"{name}code"
        self.verbatim.add(name)
        parts = {r"\excludecomment": 0, r"\lstnewenvironment": 2, r"\DefineVerbatimEnvironment": 2}.get(token.text, 1)
        parts += token.text in (r"\DeclareTCBListing", r"\NewTCBListing")
        while self.optional() is not None:
            pass
        for _ in range(parts):
            self.argument()
        return True

    def _pass_over(self, name: str, at: int) -> bool:
        """Pass over an environment that shows what stands in it, where the source itself has it."""
        start, _, _, text = self._file(at)
        ending = rf"\end{{{name}}}"
        place = text.find(ending, at - start)
        if place < 0 or not text.startswith(r"\begin", at - start):
            return False
        end = start + place + len(ending)
        while self.waiting and not (self.waiting[-1] and not start <= self.waiting[-1][-1].at < end):
            tokens = self.waiting.pop()
            if tokens:
                last = tokens.pop()
                if last.at + len(last.text) > end:  # taken as a comment or \verb over the end
                    tokens[:] = tokenize(text[end - start :], end)[::-1]
                self.waiting.append(tokens)
        return True

    def _environment_of(self, name: list[Token]) -> tuple[Macro, tuple[Token, ...]] | None:
        known = None if self.original else self.environments.get(latex_of(name).strip())
        self.original = False
        return known

    def _begin(self, token: Token) -> bool:
        name = self.argument()
        known = self._environment_of(name)
        if known is None and (command := self._command_of(latex_of(name).strip(), "", token.at)):
            self.macros.open(latex_of(name).strip(), token.at)
            self.push([command])
            return True
        if latex_of(name).strip() in self.verbatim and self._pass_over(latex_of(name).strip(), token.at):
            return True
        if latex_of(name).strip() not in ("document", ""):
            self.macros.open(latex_of(name).strip(), self._own_place(known, token))
        if known is None:
            if (counter := self.theorems.get(latex_of(name).strip())) is not None:
                self.counters.step(counter)
            self.push([Token("open", "{", token.at), *name, Token("close", "}", token.at)])
            return False
        self._count(rf"\begin{{{latex_of(name)}}}", token.at)
        self.push(self._body(known[0], token))
        return True

    def _end(self, token: Token) -> bool:
        name = self.argument()
        known = self._environment_of(name)
        if known is None and (command := self._command_of(latex_of(name).strip(), "end", token.at)):
            self.push([command, Token("scope", latex_of(name).strip(), token.at)])
            return True
        if known is None:
            if latex_of(name).strip() not in ("document", ""):
                self.level = self.macros.end_environment(latex_of(name).strip(), token.at)
            self.push([Token("open", "{", token.at), *name, Token("close", "}", token.at)])
            return False
        self._count(rf"\end{{{latex_of(name)}}}", token.at)
        self.push(
            [
                *(Token(t.kind, t.text, token.at) for t in known[1]),
                Token("scope", latex_of(name).strip(), self._own_place(known, token)),
            ]
        )
        return True

    def _own_place(self, known: tuple[Macro, tuple[Token, ...]] | None, token: Token) -> int:
        """The place of a token; none where a package beside the source defines the environment and may end its parts."""
        parts = (*known[0].body, *known[1]) if known else ()
        return -1 if parts and self._file(parts[0].at)[1].endswith(STYLES) else token.at

    def _command_of(self, name: str, verb: str, at: int) -> Token | None:
        r"""\begin{x} is \x where the source defines \x and \endx."""
        defined = rf"\{name}" in self.macros and rf"\end{name}" in self.macros
        return Token("command", rf"\{verb}{name}", at) if defined else None

    def _display(self, token: Token) -> bool:
        r"""\align and \endalign, as definitions of environments have them: what \begin{align} and \end{align} are."""
        name = token.text[1:]
        verb, name = (r"\end", name[3:]) if name.startswith("end") else (r"\begin", name)
        self.original = token.kind == "primitive"
        self.push(tokenize(rf"{verb}{{{name}}}", token.at))
        return True

    # ---- files and packages

    def _input(self, token: Token) -> bool:
        self.skip_spaces()
        following = self.peek()
        if token.text == r"\input" and following is not None and following.kind == "text":
            self.next()
            name = following.text.partition("\n")[0].partition(" ")[0]
            self.push([Token("text", following.text[len(name) :], following.at)])
        else:
            name = self.name()
        return self._part(name, token)

    def _part(self, name: str, token: Token) -> bool:
        """Take in a part of the source, a note where it is missing."""
        if not self.read_file(name) and self.file is not None:
            self.notes.append(f"{name} is missing, which line {self.line(token.at)[1]} takes in")
        return True

    def _import(self, token: Token) -> bool:
        self.star()
        folder, name = self.name(), self.name()
        return self._part(f"{folder.rstrip('/')}/{name}", token)

    def read_file(self, name: str, suffixes: tuple[str, ...] = (".tex", "")) -> bool:
        """Take in a file beside the source; whether it is there."""
        if self.file is None or (self.bare and suffixes[0] != ".tex"):
            return False
        for suffix in suffixes:
            for folder in (self.file.parent, self.file.parent.parent):
                path = folder / f"{name}{suffix}"
                if not path.is_file() and path.parent.is_dir():  # as kpathsea finds it on every system
                    path = next(
                        (each for each in path.parent.iterdir() if each.name.lower() == path.name.lower()), path
                    )
                if path.is_file() and path.suffix in (".tex", ".sty", ".cls", ".ltx", ".def", ".inp"):
                    self._take_in(read_text(path, "latin-1"), path)
                    return True
        return False

    def _use(self, token: Token) -> bool:
        self.optional()
        for name in map(str.strip, self.name().split(",")):
            if name not in self.loaded:  # TeX takes in a package once
                self.loaded.add(name)
                self.read_file(name, (".sty",))
        self.optional()
        return True

    def _class(self, token: Token) -> bool:
        options = latex_of(self.optional() or ()).split(",")
        name = self.name()
        if self.document_class and name == "subfiles":
            return True
        if name == "subfiles":
            for option in options:
                self.document_class = self.document_class or "article"
                self._preamble_of(option.strip())
            return True
        if self.files > 1 and self.document_class and token.text == r"\documentclass":
            self._preamble_of(None)  # a file taken in that could stand by itself: its own preamble is read as it comes
            return True
        if not self.read_file(name, (".cls",)) or token.text == r"\LoadClass":
            self.document_class = name
        self.document_class = self.document_class or name
        self.counters.begin(name)
        return True

    def _preamble_of(self, name: str | None) -> None:
        """The preamble of the main file of a subfile."""
        if name and self.file is not None:
            path = self.file.parent / (name if name.endswith(".tex") else f"{name}.tex")
            if path.is_file():
                preamble = read_text(path, "latin-1").partition(r"\begin{document}")[0]
                self.document_class = ""
                self._take_in(preamble, path)

    def _counted(self, token: Token) -> bool:
        c, name = self.counters, token.text
        if name == r"\newcounter":
            counter = self.name()
            within = self.optional()
            c.add(counter, latex_of(within).strip() if within is not None else "")
        elif name == r"\setcounter":
            counter = self.name()
            c.values[counter] = self.number()
        elif name == r"\addtocounter":
            counter = self.name()
            c.values[counter] = c.values.get(counter, 0) + self.number()
        elif name in (r"\stepcounter", r"\refstepcounter"):
            counter = self.name()
            c.step(counter)
            if name == r"\refstepcounter":
                self.stepped = self.printed(counter)
        elif name == r"\@addtoreset":
            counter = self.name()
            c.reset_by(counter, self.name())
        elif name in (r"\numberwithin", r"\counterwithin"):
            kept = self.star() if name == r"\counterwithin" else False
            style = self.optional()
            counter, parent = self.name(), self.name()
            shown = latex_of(style).strip() if style else r"\arabic"
            c.reset_by(counter, parent)
            if not kept:
                self.macros.pop(rf"\the{counter}", None)
                c.within[counter] = parent, shown.lstrip("\\")
        elif name == r"\counterwithout":
            self.star()
            self.optional()
            counter, parent = self.name(), self.name()
            c.free(counter, parent)
            self.macros.pop(rf"\the{counter}", None)
        return True

    def _shown(self, token: Token) -> bool:
        name = self.name()
        value = self.counters.values.get(name)
        if value is None:
            self.push([Token("open", "{", token.at), Token("text", name, token.at), Token("close", "}", token.at)])
            return False
        self.push(self._plain(Counters.style(value, token.text[1:]), token.at))
        return True

    def _value(self, token: Token) -> bool:
        self.push(self._plain(str(self.counters.values.get(self.name(), 0)), token.at))
        return True

    def _new_flag(self, token: Token) -> bool:
        self.skip_spaces()
        named = self.next()
        if named is not None:
            self.flags[named.text[1:]] = False
            self.flags[named.text[3:]] = False
            self._alias(named.text[1:])
        return True

    def _alias(self, name: str) -> None:
        """\\draftfalse and \\drafttrue set \\ifdraft."""
        short = name[2:]

        def setter(value: bool) -> Package:
            def take(expander: Expander) -> Iterable[Token]:
                expander.flags[name] = value
                return ()

            return take

        self.own |= {rf"\{short}true": setter(True), rf"\{short}false": setter(False)}

    def _ignored(self, token: Token) -> bool:
        return True

    def _ensured(self, token: Token) -> bool:
        self.push(self.argument())
        return True


def _spec(text: str) -> Iterator[tuple[str, list[Token]]]:
    """The arguments of \\NewDocumentCommand: a letter each, with its default."""
    for match in re.finditer(r"([mosODdr])\s*(?:[()]{2})?\s*(?:\{([^{}]*)\})?", text):
        yield match[1], tokenize(match[2] or "")


# What stands for an optional argument that is not given.
_NO_VALUE = Token("command", r"\NoValue", 0)
Handler = Callable[[Expander, Token], bool]
_HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(_DEFINITIONS, Expander._defined),
    **dict.fromkeys((r"\def", r"\gdef", r"\edef", r"\xdef"), Expander._def),
    **dict.fromkeys(_DOCUMENT_COMMANDS, Expander._document_command),
    **dict.fromkeys(_ENVIRONMENTS, Expander._environment),
    **dict.fromkeys(
        (
            r"\lstnewenvironment", r"\DefineVerbatimEnvironment", r"\newminted", r"\newtcblisting", r"\DeclareTCBListing",
            r"\NewTCBListing", r"\excludecomment",
        ),
        Expander._verbatim_environment,
    ),
    **dict.fromkeys(_INPUTS, Expander._input),
    **dict.fromkeys((r"\import", r"\subimport", r"\subincludefrom", r"\includefrom"), Expander._import),
    **dict.fromkeys((r"\usepackage", r"\RequirePackage"), Expander._use),
    **dict.fromkeys((r"\documentclass", r"\LoadClass"), Expander._class),
    **dict.fromkeys(
        (
            r"\newcounter", r"\setcounter", r"\addtocounter", r"\stepcounter", r"\refstepcounter", r"\@addtoreset",
            r"\numberwithin", r"\counterwithin", r"\counterwithout",
        ),
        Expander._counted,
    ),
    **dict.fromkeys(_SHOWN, Expander._shown),
    **dict.fromkeys((r"\long", r"\global", r"\protected", r"\outer", r"\relax", r"\protect"), Expander._ignored),
    **dict.fromkeys((r"\makeatletter", r"\makeatother", r"\ensuremath@", r"\xspace"), Expander._ignored),
    **{rf"\{end}{name}": Expander._display for name in _DISPLAYS for end in ("", "end")},
    **dict.fromkeys(
        [rf"\If{test}{ending}" for test in ("Value", "NoValue", "Boolean") for ending in ("T", "F", "TF")],
        Expander._if_value,
    ),
    **dict.fromkeys((r"\newboolean", r"\provideboolean", r"\setboolean"), Expander._boolean),
    r"\ifthenelse": Expander._if_then_else,
    r"\newtheorem": Expander._theorem,
    **dict.fromkeys((r"\@ifnextchar", r"\@ifstar"), Expander._if_next),
    r"\csname": Expander._named,
    r"\expandafter": Expander._ignored,
    r"\let": Expander._let,
    r"\DeclareMathOperator": Expander._operator,
    **dict.fromkeys((r"\DeclarePairedDelimiter", r"\DeclarePairedDelimiterX"), Expander._pair),
    r"\begin": Expander._begin,
    r"\end": Expander._end,
    r"\value": Expander._value,
    r"\newif": Expander._new_flag,
    r"\ensuremath": Expander._ensured,
}  # fmt: skip
