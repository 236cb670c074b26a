r"""The print of an equation as data: what sympy's parser of LaTeX can read of `quantity = member = member …`.

Each letter with its index and dots is handed to the parser as one name, and what it gives back must hold the same letters and
numbers: a line that is not read whole is not read at all.
"""

import re
from dataclasses import dataclass
from importlib.util import find_spec
from keyword import iskeyword

import sympy as sp
from sympy.core.alphabets import greeks

from lagrotor.paper.letters import FUNCTIONS

_GREEK = {*greeks, "varphi", "vartheta", "varepsilon", "ell", "hbar"} - {"pi"}
_SPACES = re.compile(r"\\(?:,|;|:|!| |quad|qquad|displaystyle|left|right|bigl?|bigr?|Bigl?|Bigr?)(?![A-Za-z])|~")
_INDEX = r"(?:_(?:\{[A-Za-z0-9,]+\}|[A-Za-z0-9]))?"
_LETTER = re.compile(
    r"\\(?P<dots>d?dot)\s*(?:\{\s*(?P<in>\\?[A-Za-z]+)\s*(?P<inner>_(?:\{\w+\}|\w))?\s*\}|(?P<on>\\[A-Za-z]+|\s[A-Za-z]))"
    + rf"(?P<after>{_INDEX})"
    + rf"|(?P<name>\\[A-Za-z]+|[A-Za-z])(?P<index>{_INDEX})"
)
_RELATION = re.compile(
    r"\\(?:approx|sim|simeq|equiv|neq|leq?|geq?|ll|gg|propto|to|pm|mp|o?int|sum|prod|partial|vec|hat|bar|mathbf)(?![A-Za-z])|[<>]"
    r"|\\frac\s*\{\s*(?:d\s|d\\?[a-z]|d\})"  # d/dt
)


@dataclass(frozen=True)
class Print:
    """A line that was read: the quantity in LaTeX, its members as text in the names of `letters`."""

    quantity: str
    members: tuple[str, ...]
    letters: tuple[str, ...]


def can_read() -> bool:
    """Whether sympy's parser of LaTeX has what it needs."""
    return find_spec("antlr4") is not None


def read_print(latex: str) -> Print | None:
    """The printed line as data; None where it is no equation or cannot be read whole."""
    text = re.sub(r"[.,;]\s*$", "", latex.strip()).replace(r"\tfrac", r"\frac").replace(r"\dfrac", r"\frac")
    sides = [side.strip() for side in _split(text)]
    if len(sides) < 2 or not all(sides) or _RELATION.search(text) or not can_read():
        return None
    read = [_member(side) for side in sides[1:]]
    found = [each for each in read if each is not None]
    if len(found) < len(read):
        return None
    letters = dict.fromkeys(name for _, names in found for name in names)
    return Print(sides[0], tuple(member for member, _ in found), tuple(letters))


def _split(text: str) -> list[str]:
    """The sides of the equals signs that are in no braces."""
    sides, depth = [""], 0
    for character in text:
        depth += {"{": 1, "}": -1}.get(character, 0)
        if character == "=" and depth == 0:
            sides.append("")
        else:
            sides[-1] += character
    return sides


def _member(source: str) -> tuple[str, list[str]] | None:
    """One side as text, and its letters; None where the parser refuses or leaves something out."""
    from sympy.parsing.latex import LaTeXParsingError, parse_latex

    names: dict[str, str] = {}

    def placed(match: re.Match[str]) -> str:
        plain = (match["name"] or "").removeprefix("\\")
        if match["name"] and match["name"].startswith("\\") and plain not in _GREEK:
            return match[0]
        name = _name_of(match)
        place = names.setdefault(name, rf"\xi_{{{len(names) + 1}}}")
        return f" {place} "

    text = _LETTER.sub(placed, _SPACES.sub(" ", source))
    text = re.sub(r"(\\(?:sin|cos|tan)(?:\^\{?\d+\}?)?)\s*(\\xi_\{\d+\})\s*(?=\()", r"\1(\2) \\cdot ", text)
    if re.search(r"\\xi_\{\d+\}\s*\(\s*(?:\\xi_\{\d+\}|\d+)\s*\)", text):
        return None  # f(t) or K(1): a function, not a product
    text = re.sub(r"(\\xi_\{\d+\}|\))\s*(?=\()", r"\1 \\cdot ", text)
    try:
        value = parse_latex(text)
    except (LaTeXParsingError, TypeError, ValueError, AttributeError):
        return None
    places = {place.lstrip("\\"): name for name, place in names.items()}
    if not isinstance(value, sp.Expr) or value.has(sp.Derivative, sp.Integral, sp.Sum):
        return None
    if {s.name for s in value.free_symbols} - {"pi"} != set(places) or not _same_numbers(text, value):
        return None
    meant = {s: _meant(places.get(s.name, s.name)) for s in value.free_symbols}
    exact = {number: sp.Rational(str(number)) for number in value.atoms(sp.Float)}
    letters = [name for name in names if name != "e"]
    return str(value.xreplace({**meant, **exact})), letters


def _meant(name: str) -> sp.Expr:
    """The letter of this name; pi and e are the numbers."""
    return {"pi": sp.pi, "e": sp.E}.get(name) or sp.Symbol(name)


def _same_numbers(text: str, value: sp.Expr) -> bool:
    """Whether the decimals of the source are all there."""
    written = {sp.Rational(n) for n in re.findall(r"(?<![_\d{])\d+\.\d+", re.sub(r"\\xi_\{\d+\}", "", text))}
    return written <= {sp.Rational(str(number)) for number in value.atoms(sp.Float)}


def _name_of(match: re.Match[str]) -> str:
    r"""theta_1_dot for \dot\theta_1: a name that Python and sympy take."""
    stem = (match["in"] or match["on"] or match["name"]).strip().removeprefix("\\")
    stem = {"lambda": "lamda"}.get(stem, stem)
    index = (match["inner"] or "") + (match["after"] or "") + (match["index"] or "")
    name = stem + "".join("_" + part for part in re.findall(r"[A-Za-z0-9]+", index))
    name += f"_{match['dots']}" if match["dots"] else ""
    return f"{name}_" if iskeyword(name) or name in FUNCTIONS else name
