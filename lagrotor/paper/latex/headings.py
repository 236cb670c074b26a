"""Titles, headings and names of authors as plain text. Accents and formulas become Unicode; footnotes are removed."""

import re
import unicodedata

from lagrotor.paper.plain_text import from_latex

_GROUP = r"\{(?:[^{}]|\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\})*\}"
_NOTES = re.compile(
    rf"\\(?:thanks|footnote|label|inst|cite\w*|(?:eq)?ref|[hv]space|textsuperscript|color)\*?\s*(?:\[[^][]*\]|{_GROUP})+"
    r"|\$\s*\^[^$]*\$"  # marks of notes
)
_LATTER = re.compile(rf"\\(?:(?:texorpdfstring|href)\s*{_GROUP}|textcolor\s*(?:\[\w+\])?\{{[^{{}}]*\}})")
_FORMULA = re.compile(rf"\$((?:[^$\\]|\\.)*)\$|\\\((.*?)\\\)|\\ensuremath\s*({_GROUP})", re.DOTALL)
_ACCENT = re.compile(
    r"\\(?:(['`^\"~=.])|([cvHukrdb])(?![A-Za-z]))\s*(?:\{\s*\\?([A-Za-z])\s*\}|\\([ij])(?![A-Za-z])|([A-Za-z]))"
)
# The command of an accent → its mark in Unicode.
ACCENTS = {
    "'": "\u0301", "`": "\u0300", "^": "\u0302", '"': "\u0308", "~": "\u0303", "=": "\u0304", ".": "\u0307", "c": "\u0327",
    "v": "\u030c", "H": "\u030b", "u": "\u0306", "k": "\u0328", "r": "\u030a", "d": "\u0323", "b": "\u0331",
}  # fmt: skip
_LETTERS = {
    "ss": "ß", "o": "ø", "O": "Ø", "l": "ł", "L": "Ł", "ae": "æ", "AE": "Æ", "oe": "œ", "OE": "Œ", "aa": "å", "AA": "Å",
    "i": "i", "j": "j", "LaTeX": "LaTeX", "TeX": "TeX", "textquotesingle": "'",
}  # fmt: skip


def plain_heading(text: str) -> str:
    r"""Return LaTeX as plain text: Jos\'e~\surname{Garc{\'\i}a}\thanks{…} gives José García, $E=mc^2$ gives E=mc²."""
    text = re.sub(r"``|''", '"', _LATTER.sub(" ", _NOTES.sub("", text)))
    text = _ACCENT.sub(_accented, re.sub(r"(?<!\\)\\[,;:!/ ]", " ", text))
    text = _FORMULA.sub(lambda match: from_latex(next(filter(None, match.groups()), "")), text)
    text = re.sub(rf"\\({'|'.join(_LETTERS)})(?![A-Za-z])(?:\s+|\{{\}})?", lambda match: _LETTERS[match[1]], text)
    text = re.sub(r"\\[A-Za-z]+\*?(?=\{)|(?<!\\)[{}$*]", "", text)
    text = re.sub(r"\\[A-Za-z]+\*?|\\\\(?:\[[^][]*\])?|~", " ", text)
    return " ".join(re.sub(r"\\([&%_#${}])", r"\1", text).split())


def _accented(match: re.Match[str]) -> str:
    mark = ACCENTS[match[1] or match[2]]
    return unicodedata.normalize("NFC", (match[3] or match[4] or match[5]) + mark)


def names_of_authors(text: str) -> tuple[str, ...]:
    r"""Return the names in the argument of \author. They are separated by \and or commas; lines after the first are cut."""
    blocks = re.split(r"\\and\b", _NOTES.sub("", re.sub(r"(?<!\\)\\[,;:!/ ]", " ", text)))
    firsts = (re.split(r"\\\\", block)[0] for block in blocks)
    names = (plain_heading(name) for first in firsts for name in re.split(r",|(?<=[\s~])and(?=[\s~])", first))
    return tuple(filter(None, names))
