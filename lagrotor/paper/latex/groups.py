r"""What is open in a source, as TeX keeps it: braces, environments, \left; the definitions that end with each, and what is not
ended."""

from collections.abc import Iterable
from dataclasses import dataclass

from lagrotor.paper.latex.tokens import Token, latex_of

# Groups that programs of macros open and close in parts: nothing is said of them.
_SILENT = (r"\begingroup", r"\bgroup")
_NOT_CLOSED = {"{": "{ is not closed", r"\left": r"\left is not closed by \right"}


@dataclass(frozen=True)
class Macro:
    """A definition: `head`, what must follow its name, arguments as #1; `default` of an optional first argument."""

    body: tuple[Token, ...]
    head: tuple[Token, ...] = ()
    default: tuple[Token, ...] | None = None
    spec: str = ""


def numbered(count: Iterable[Token] | None, default: int = 0) -> tuple[Token, ...]:
    """The arguments #1 … #n of a definition that states n by `count`, [2]."""
    digits = latex_of(count or ()).strip()
    return tuple(Token("param", f"#{n + 1}", 0) for n in range(int(digits) if digits.isdigit() else default))


class Macros(dict[str, Macro | None]):
    """Definitions by name, each of which ends with the group that it is made in.

    groups: what is open, and where it began; faults: places, what stands there where no macro does, and what is wrong.
    """

    def __init__(self, known: dict[str, Macro | None]) -> None:
        super().__init__(known)
        self.groups: list[tuple[str, int]] = []
        self.faults: dict[tuple[int, str, str], None] = {}
        self.passed = 0  # { that the end of an environment has closed
        self._before: list[dict[str, Macro | None]] = []  # of each open group, what its definitions hide; None: nothing

    def __setitem__(self, name: str, macro: Macro | None) -> None:
        if self._before:
            self._before[-1].setdefault(name, self.get(name))
        super().__setitem__(name, macro)

    def define_globally(self, name: str, macro: Macro) -> None:
        """As \\gdef does: for all groups that are open."""
        for hidden in self._before:
            hidden.pop(name, None)
        super().__setitem__(name, macro)

    def forget_globally(self, name: str) -> None:
        """No definition is left of a name, whatever groups are open."""
        for hidden in self._before:
            hidden.pop(name, None)
        self.pop(name, None)

    def fault(self, at: int, mark: str, said: str) -> None:
        """Something that TeX would stop at."""
        self.faults[at, mark, said] = None

    def open(self, mark: str, at: int) -> None:
        """Begin a group: {, \\left, \\begingroup, or the name of an environment."""
        self.groups.append((mark, at))
        self._before.append({})

    def begin_body(self) -> None:
        """What a preamble leaves open is part of its programs, \\AtBeginDocument{\\begin{…}}: nothing is said of it."""
        self.faults.clear()
        self.groups = [(_SILENT[0], at) for _, at in self.groups]

    def close_to(self, level: int, say: bool = True) -> None:
        """End the groups above a level, of which none should be open."""
        while len(self.groups) > level:
            mark, at = self.groups.pop()
            for name, macro in self._before.pop().items():
                if macro is None:
                    super().pop(name, None)
                else:
                    super().__setitem__(name, macro)
            if say and mark not in _SILENT:
                begun = mark if mark in _NOT_CLOSED else rf"\begin{{{mark}}}"
                self.fault(at, begun, _NOT_CLOSED.get(mark, f"{begun} is not ended"))

    def innermost(self, name: str = "") -> int:
        """The level of the innermost environment, or of the one with this name; −1 where none is open."""
        for place in range(len(self.groups) - 1, -1, -1):
            mark = self.groups[place][0]
            if mark == name or not (name or mark in _NOT_CLOSED or mark in _SILENT):
                return place
        return -1

    def close(self, token: Token) -> None:
        """End the group that a token ends; one that ends nothing is passed over."""
        if token.text in (r"\endgroup", r"\egroup"):
            if self.groups and self.groups[-1][0] in ("{", *_SILENT):
                self.close_to(len(self.groups) - 1, say=False)
            return
        opening, within = {"}": ("{", (r"\left", *_SILENT)), r"\right": (r"\left", _SILENT)}[token.text]
        place = len(self.groups) - 1
        while place >= 0 and self.groups[place][0] in within:
            place -= 1
        if place < 0 or self.groups[place][0] != opening:
            if token.text == "}" and self.passed:  # one slip, one fault
                self.passed -= 1
                return None
            return self.fault(token.at, token.text, f"{token.text} closes no {opening}")
        self.close_to(place + 1)
        self.close_to(place, say=False)

    def end_cell(self) -> None:
        r"""& and \\ part what \left and \right must hold together."""
        while self.groups and self.groups[-1][0] == r"\left":
            self.close_to(len(self.groups) - 1)

    def end_environment(self, name: str, at: int) -> int:
        """End what is open within an environment, and give its level, to which its group is closed once it is read."""
        place, inner = self.innermost(name), self.innermost()
        if place < 0:
            begun = rf"ends \begin{{{self.groups[inner][0]}}}" if inner >= 0 else "ends nothing that has begun"
            self.fault(at, r"\end", rf"\end{{{name}}} {begun}")
            place = inner
        self.passed += sum(mark == "{" for mark, _ in self.groups[place + 1 :])
        self.close_to(place + 1)
        return place if place >= 0 else len(self.groups)
