"""The letters of expressions numbered in an order that the expressions give, so that no decision depends on their names.

Each letter has a color: the assumptions on it, then the places where it stands. A place is known by the parts above it and by
the colors of the letters in these. Colors are refined until no more letters differ; of letters that are alike, the first by
name gets a color of its own. B. D. McKay, Congressus Numerantium 30 (1981) 45.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cmp_to_key
from hashlib import blake2b
from typing import Any

import sympy as sp
from sympy.core.relational import Relational

from lagrotor.algebra.scalar import divided
from lagrotor.algebra.subexpressions import subexpressions

_NAME = re.compile(r"letter_(\d{4})_")
_SORTED = cmp_to_key(sp.Basic.compare)


class Numbering:
    """Letters by their number: `there` gives them names of the number alone, `back` their true names again."""

    def __init__(self, *expressions: sp.Basic) -> None:
        self.letters = letters_in_order(expressions)
        self.new = {
            letter: sp.Symbol(f"letter_{i:04}_", **letter.assumptions0) for i, letter in enumerate(self.letters)
        }
        self.old = {new: letter for letter, new in self.new.items()}

    def there(self, e: Any) -> Any:
        """Return an expression in the numbered letters."""
        return renamed(e, self.new)

    def back(self, e: Any) -> Any:
        """Return an expression in the letters of the input."""
        return renamed(e, self.old)

    def text(self, says: str) -> str:
        """Return a text about numbered letters as one about those of the input."""
        return _NAME.sub(lambda match: str(self.letters[int(match[1])]), says)


def renamed(e: sp.Basic, letters: Mapping[sp.Basic, sp.Basic]) -> Any:
    """Return an expression with letters in place of others, and nothing evaluated."""
    parts: dict[sp.Basic, sp.Basic] = {}
    for part in subexpressions(e):
        if part in letters or not part.args:
            parts[part] = letters.get(part, part)
            continue
        args = [parts[a] for a in part.args]
        if all(a is b for a, b in zip(args, part.args, strict=True)):
            parts[part] = part
        elif isinstance(part, sp.Add | sp.Mul) and part.is_commutative:
            args.sort(key=lambda a: (not a.is_Number, _SORTED(a)))
            parts[part] = part.func._from_args(args)
        elif isinstance(part, sp.Pow | sp.Function | Relational) and not isinstance(part, sp.Piecewise):
            parts[part] = part.func(*args, evaluate=False)
        else:
            parts[part] = part.func(*args)
    return parts[e]


def letters_in_order(expressions: Sequence[sp.Basic]) -> list[sp.Symbol]:
    """Return all letters, bound ones as well, in an order that no name changes, and no order of expressions but the first."""
    nodes = subexpressions(*expressions)
    letters = sorted((e for e in nodes if isinstance(e, sp.Symbol)), key=sp.default_sort_key)
    colors = {letter: _digest(sorted(letter.assumptions0.items())) for letter in letters}
    while True:
        colors = _refined(colors, nodes, expressions)
        counts = Counter(colors.values())
        alike = [letter for letter in letters if counts[colors[letter]] > 1]
        if not alike:
            return sorted(letters, key=colors.__getitem__)
        first = min(alike, key=colors.__getitem__)
        colors[first] = _digest("first", colors[first])


def without_number(e: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return a number that is not zero and the expression divided by it: the same expression for all multiples of one."""
    number, form = divided(e)
    if form.is_Add:
        here, there = (_shapes(subexpressions(side), {})[side] for side in (form, -form))
        return (-number, -form) if there < here else (number, form)
    return number, form


def _refined(
    colors: dict[sp.Symbol, int], nodes: Sequence[sp.Basic], expressions: Sequence[sp.Basic]
) -> dict[sp.Symbol, int]:
    """Return the colors refined by the places of the letters, until their number grows no more."""
    while len(set(colors.values())) < len(colors):
        inside = _shapes(nodes, colors)
        places: dict[sp.Basic, list[int]] = {e: [] for e in nodes}
        for i, e in enumerate(expressions):
            places[e].append(min(i, 1))
        for e in reversed(nodes):
            above = _digest(sorted(places[e]), inside[e]) if e.args else 0
            for i, a in enumerate(e.args):
                places[a].append(above if _commutes(e) else _digest(above, i))
        finer = {letter: _digest(color, sorted(places[letter])) for letter, color in colors.items()}
        if len(set(finer.values())) == len(set(colors.values())):
            return finer
        colors = finer
    return colors


def _shapes(nodes: Iterable[sp.Basic], colors: Mapping[sp.Basic, int]) -> dict[sp.Basic, int]:
    """Return a number for each part that is the same for parts that differ in the names of letters alone."""
    inside = dict[sp.Basic, int]()
    for e in nodes:
        args = [inside[a] for a in e.args]
        kind = colors.get(e, 0) if isinstance(e, sp.Symbol) else type(e).__name__ if args else str(e)
        inside[e] = _digest(kind, sorted(args) if _commutes(e) else args)
    return inside


def _commutes(e: sp.Basic) -> bool:
    return isinstance(e, sp.Add | sp.Mul) and bool(e.is_commutative)


def _digest(*items: Any) -> int:
    return int.from_bytes(blake2b(repr(items).encode(), digest_size=8).digest(), "big")
