"""Canonical numbering of the symbols of expressions, so that no decision depends on their names.

Each symbol has a color: a digest of its assumptions, then of its positions. A position is given by the subexpressions above it
and the colors of their symbols. Colors are refined until no more symbols differ; then the first of several symbols with one
color gets a new color. B. D. McKay, Congressus Numerantium 30 (1981) 45.
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

from lagrotor.algebra.scalar import split_content
from lagrotor.algebra.subexpressions import subexpressions

_NAME = re.compile(r"letter_(\d{4})_")
_SORTED = cmp_to_key(sp.Basic.compare)


class Numbering:
    """The symbols of some expressions, renamed after their canonical numbers; `to_input` restores the original names."""

    def __init__(self, *expressions: sp.Basic) -> None:
        self.symbols = canonical_order(expressions)
        self.new = {s: sp.Symbol(f"letter_{i:04}_", **s.assumptions0) for i, s in enumerate(self.symbols)}
        self.old = {new: symbol for symbol, new in self.new.items()}

    def to_numbered(self, e: Any) -> Any:
        """Return an expression in the numbered symbols."""
        return replace_symbols(e, self.new)

    def to_input(self, e: Any) -> Any:
        """Return an expression in the symbols of the input."""
        return replace_symbols(e, self.old)

    def text(self, says: str) -> str:
        """Return a text with the names of the input in place of the numbered names."""
        return _NAME.sub(lambda match: str(self.symbols[int(match[1])]), says)


def replace_symbols(e: sp.Basic, symbols: Mapping[sp.Basic, sp.Basic]) -> Any:
    """Return an expression with symbols replaced and nothing evaluated."""
    images: dict[sp.Basic, sp.Basic] = {}
    for node in subexpressions(e):
        if node in symbols or not node.args:
            images[node] = symbols.get(node, node)
            continue
        args = [images[a] for a in node.args]
        if all(a is b for a, b in zip(args, node.args, strict=True)):
            images[node] = node
        elif isinstance(node, sp.Add | sp.Mul) and node.is_commutative:
            args.sort(key=lambda a: (not a.is_Number, _SORTED(a)))
            images[node] = node.func._from_args(args)
        elif isinstance(node, sp.Pow | sp.Function | Relational) and not isinstance(node, sp.Piecewise):
            images[node] = node.func(*args, evaluate=False)
        else:
            images[node] = node.func(*args)
    return images[e]


def canonical_order(expressions: Sequence[sp.Basic]) -> list[sp.Symbol]:
    """Return all symbols, also bound ones, in an order independent of names and of the order of all but the first expression."""
    nodes = subexpressions(*expressions)
    symbols = sorted((e for e in nodes if isinstance(e, sp.Symbol)), key=sp.default_sort_key)
    colors = {symbol: _digest(sorted(symbol.assumptions0.items())) for symbol in symbols}
    while True:
        colors = _refined(colors, nodes, expressions)
        counts = Counter(colors.values())
        alike = [symbol for symbol in symbols if counts[colors[symbol]] > 1]
        if not alike:
            return sorted(symbols, key=colors.__getitem__)
        first = min(alike, key=colors.__getitem__)
        colors[first] = _digest("first", colors[first])


def without_number(e: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return (number, expression / number); all nonzero multiples of an expression give the same second entry."""
    number, form = split_content(e)
    if form.is_Add:
        shape, opposite = (_shapes(subexpressions(side), {})[side] for side in (form, -form))
        return (-number, -form) if opposite < shape else (number, form)
    return number, form


def _refined(
    colors: dict[sp.Symbol, int], nodes: Sequence[sp.Basic], expressions: Sequence[sp.Basic]
) -> dict[sp.Symbol, int]:
    """Refine the colors by the positions at which the symbols occur, until the number of different colors stays the same."""
    while len(set(colors.values())) < len(colors):
        inside = _shapes(nodes, colors)
        places: dict[sp.Basic, list[int]] = {e: [] for e in nodes}
        for i, e in enumerate(expressions):
            places[e].append(min(i, 1))
        for e in reversed(nodes):
            above = _digest(sorted(places[e]), inside[e]) if e.args else 0
            for i, a in enumerate(e.args):
                places[a].append(above if _commutes(e) else _digest(above, i))
        finer = {symbol: _digest(color, sorted(places[symbol])) for symbol, color in colors.items()}
        if len(set(finer.values())) == len(set(colors.values())):
            return finer
        colors = finer
    return colors


def _shapes(nodes: Iterable[sp.Basic], colors: Mapping[sp.Basic, int]) -> dict[sp.Basic, int]:
    """Return a digest of each subexpression, equal for subexpressions that differ only in names of symbols."""
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
