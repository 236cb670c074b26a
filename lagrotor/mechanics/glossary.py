"""A glossary of letters with meanings and units, and expressions as LaTeX with the dots of velocities."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp
from sympy.printing.latex import tex_greek_dictionary
from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.mechanics.lagrangian import Coordinates


@dataclass(frozen=True)
class Entry:
    """One row of a glossary."""

    symbol: sp.Symbol
    meaning: str
    unit: str


class Glossary(dict[sp.Symbol, Entry]):
    """Symbol → what it means, in the order in which the letters are declared."""

    def letter(self, name: str, meaning: str, unit: str, **assumptions: bool) -> sp.Symbol:
        """A symbol that enters the glossary as it is declared.

        Args:
            name: as sympy takes it.
            meaning: in words.
            unit: as in "kg m^2"; 1 for a number.
            assumptions: sympy's, such as positive=True.
        """
        symbol = sp.Symbol(name, **assumptions)
        self[symbol] = Entry(symbol, meaning, unit)
        return symbol

    def moving(self, c: Coordinates, *rows: tuple[str, str]) -> Coordinates:
        """The coordinates with their velocities and accelerations; `rows`: (meaning, unit) of each coordinate."""
        for q, v, acc, (meaning, unit) in zip(c.q, c.v, c.a, rows, strict=True):
            self[q] = Entry(q, meaning, unit)
            self[v] = Entry(v, f"rate of {q.name}", f"{unit}/s")
            self[acc] = Entry(acc, f"acceleration of {q.name}", f"{unit}/s²")
        return c

    def meaning(self, symbol: sp.Symbol) -> str:
        """What a letter means, in a few words; "parameter" where the glossary does not hold it."""
        return self[symbol].meaning.split(":")[0] if symbol in self else "parameter"


def latex(expression: Any, names: Mapping[sp.Symbol, str] | None = None) -> str:
    """LaTeX of an expression, with dots over what a symbol's name calls a velocity or an acceleration; names: of letters."""
    free = (s for s in getattr(expression, "free_symbols", ()) if isinstance(s, sp.Symbol))
    return light(sp.latex(expression, symbol_names={s: letter_latex(s) for s in free} | dict(names or {})))


# sin, cos or tan, perhaps to a power, of one letter in brackets.
_OF_A_LETTER = re.compile(r"(\\(?:sin|cos|tan)(?:\^\{\d+\})?)\{\\left\((\\?[A-Za-z]+(?:_(?:\{\w+\}|\w))?) ?\\right\)\}")


def light(source: str) -> str:
    r"""LaTeX in which sine, cosine and tangent of one letter need no brackets: \cos\theta."""
    return _OF_A_LETTER.sub(r"\1 \2", source)


# Greek letters, and ℓ, as commands of LaTeX.
GREEK = {letter: tex_greek_dictionary.get(name, rf"\{name}") for name, letter in greek_unicode.items()} | {
    "ϑ": r"\vartheta",
    "ℓ": r"\ell",
}
_GREEK = re.compile(f"[{''.join(GREEK)}](?=([A-Za-z{''.join(GREEK)}])?)")
_MARKS = {"\\": r"\backslash ", "^": r"\wedge ", "~": r"\sim ", " ": r"\ "} | {c: rf"\{c}" for c in "&%#$_{}"}
_MARKS |= {letter: f"{command} " for letter, command in GREEK.items()}
_FOREIGN = re.compile(r"[^\x00-\x7f]+")  # letters that have no place in a formula: é


@cache
def letter_latex(symbol: sp.Symbol) -> str:
    r"""LaTeX of one letter: theta_1_dot is \dot{\theta}_1, d_dotx is \dot{d}_x, α is \alpha."""
    if reaction := re.fullmatch(r"reaction\((.+)\)", symbol.name):
        return multiplier_latex("lambda", reaction[1])
    # A component of a vector of rates, d_dotx or r_1_dotx.
    name = re.sub(r"(_\d+)?_(d?dot)([xyz])$", lambda m: f"{m[1] or '_'}{m[3]}_{m[2]}", symbol.name)
    dotted = re.fullmatch(r"(.+?)_(d?dot)", name)
    source = sp.latex(sp.Symbol(dotted[1]) if dotted else symbol)
    if dotted:
        source = re.sub(r"^(.+?)(_\{.*)?$", rf"\\{dotted[2]}{{\1}}\2", source)
    source = re.sub(r"(?<!\\)[&%#$]", r"\\\g<0>", source)
    source = _GREEK.sub(lambda m: GREEK[m[0]] + " " * (m[1] is not None), source)
    return re.sub(r"_\{(\w)\}$", r"_\1", _FOREIGN.sub(r"\\text{\g<0>}", source))


def multiplier_latex(letter: str, name: str) -> str:
    """LaTeX of λ with the name, in upright letters, or the number of its constraint."""
    upright = _FOREIGN.sub(r"\\text{\g<0>}", "".join(_MARKS.get(c, c) for c in name))
    return rf"\{letter}_{{{name}}}" if name.isdigit() else rf"\{letter}_{{\mathrm{{{upright}}}}}"
