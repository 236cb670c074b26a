r"""LaTeX's counters: what resets what, and how a number is printed, \theequation."""

from collections.abc import Callable
from itertools import pairwise

# The classes that have chapters, in which equations are numbered by chapter.
_CHAPTERED = "book report memoir scrbook scrreprt ctexbook ctexrep extbook extreport tufte-book"
_WITH_CHAPTERS = frozenset(_CHAPTERED.split())
_ROMAN = {"m": 1000, "cm": 900, "d": 500, "cd": 400, "c": 100, "xc": 90, "l": 50, "xl": 40, "x": 10,
          "ix": 9, "v": 5, "iv": 4, "i": 1}  # fmt: skip
# What stands between the letter of an appendix and the equation's number, in classes that number equations by appendices.
_APPENDIX = {"revtex": "", "mnras": "", "aastex": "", "elsarticle": ".", "iopart": "."}
_SECTIONS = ("part", "chapter", "section", "subsection", "subsubsection", "paragraph", "subparagraph")


class Counters:
    """Values by name; `within`: counter → (the one it is numbered by, style)."""

    def __init__(self) -> None:
        self.values = dict.fromkeys((*_SECTIONS, "equation", "parentequation", "figure", "table"), 0)
        self.within: dict[str, tuple[str, str]] = {}
        self.resets: dict[str, list[str]] = {}
        self.chapters = self.appendix = self.journal = self.institute = self.koma = False
        self.joint: str | None = None
        for outer, inner in pairwise(_SECTIONS[1:]):
            self.reset_by(inner, outer)

    def begin(self, document_class: str) -> None:
        """What a class sets."""
        self.chapters = document_class in (*_WITH_CHAPTERS, "amsbook")
        self.koma = document_class.startswith("scr")
        self.journal = document_class.startswith("revtex")
        self.institute = document_class.startswith(("IEEEtran", "ieeeconf"))
        self.joint = next((sign for name, sign in _APPENDIX.items() if document_class.startswith(name)), None)
        if document_class in _WITH_CHAPTERS:
            self.reset_by("equation", "chapter")

    def add(self, name: str, within: str = "") -> None:
        """A new counter."""
        self.values.setdefault(name, 0)
        self.chapters = self.chapters or name == "chapter"  # of a class beside the source
        if within:
            self.reset_by(name, within)

    def reset_by(self, name: str, parent: str) -> None:
        """A step of `parent` sets `name` to zero."""
        self.values.setdefault(name, 0)
        if name not in self.resets.setdefault(parent, []):
            self.resets[parent].append(name)

    def free(self, name: str, parent: str) -> None:
        """No step of `parent` sets `name` to zero any more."""
        if name in self.resets.get(parent, []):
            self.resets[parent].remove(name)
        self.within[name] = "", "arabic"

    def step(self, name: str) -> None:
        """One more; what it resets begins again."""
        self.values[name] = self.values.get(name, 0) + 1
        self._reset(name)

    def _reset(self, name: str, above: tuple[str, ...] = ()) -> None:
        for inner in self.resets.get(name, []):
            if inner not in (name, *above):
                self.values[inner] = 0
                self._reset(inner, (name, *above))

    def begin_appendix(self, star: bool = False) -> None:
        r"""What \appendix does; star: \appendix* of revtex, one appendix."""
        self.appendix = True
        for name in ("chapter", "section") if self.chapters else ("section", "subsection"):
            self.values[name] = 0
        if self.joint is not None:
            self.joint = "." if star else self.joint
            self.values["equation"] = self.values["equation"] if self.journal else 0
            self.reset_by("equation", "section")

    def printed(self, name: str, printed: Callable[[str], str]) -> str:
        r"""A counter as its class prints it; printed: how others are, which the author may have changed."""
        value = self.values.get(name, 0)
        if name in self.within:
            parent, style = self.within[name]
            own = self.style(value, style)
            return f"{printed(parent)}.{own}" if parent else own
        if name == "chapter":
            return self.style(value, "Alph" if self.appendix else "arabic")
        if name == "section":
            if self.chapters:
                return f"{printed('chapter')}.{value}"
            return self.style(
                value, "Alph" if self.appendix else "Roman" if self.journal or self.institute else "arabic"
            )
        if name == "subsection" and self.institute:
            return f"{printed('section')}-{self.style(value, 'Alph')}"
        if name in ("subsection", "subsubsection"):
            outer = "section" if name == "subsection" else "subsection"
            own = self.style(value, "Alph" if outer == "section" else "arabic")
            return own if self.journal else f"{printed(outer)}.{value}"
        if (
            name == "equation"
            and "equation" in self.resets.get("chapter", ())
            and (self.koma or self.values["chapter"] > 0)
        ):
            return f"{printed('chapter')}.{value}"
        if name == "equation" and self.joint is not None and self.appendix:
            return f"{self.style(self.values['section'], 'Alph')}{self.joint}{value}"
        return str(value)

    def before(self, name: str, printed: Callable[[str], str]) -> str:
        r"""What a reference has before the number, \p@subsection: in revtex the numbers above, as II A."""
        above = ("section", "subsection")[: {"subsection": 1, "subsubsection": 2}.get(name, 0) if self.journal else 0]
        return "".join(f"{printed(each)} " for each in above)

    @staticmethod
    def style(value: int, style: str) -> str:
        """A number in arabic, roman, Roman, alph or Alph."""
        if style in ("roman", "Roman"):
            roman = _roman(value)
            return roman if style == "roman" else roman.upper()
        if style in ("alph", "Alph"):
            letter = chr(ord("a") + value - 1) if 0 < value <= 26 else str(value)
            return letter if style == "alph" else letter.upper()
        return str(value)


def _roman(value: int) -> str:
    found = ""
    for mark, size in _ROMAN.items():
        found += mark * (value // size)
        value %= size
    return found
