"""Premises: what is assumed when an equation is judged, in words, as a substitution, and whether the paper's scene keeps it."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.paper.readable import readable


@dataclass(frozen=True)
class Premise:
    """What is assumed. says: in a physicist's words. put: the substitution that states it, made on both sides at once.

    small: for an approximation, the quantity in which only the leading terms are kept; `put` then brings it in.
    broken: how far the paper's own scene is from it, in words; empty where the scene keeps it.
    """

    says: str
    put: Mapping[sp.Basic, Any] = field(default_factory=dict)
    small: sp.Symbol | None = None
    broken: str = ""

    @property
    def sentence(self) -> str:
        """What is assumed, and by how much the paper's own scene breaks it."""
        return f"{self.says} (broken by the paper's own scene: {self.broken})" if self.broken else self.says

    def on(self, side: Any) -> Any:
        """A side with the premise put in."""
        if all(isinstance(old, sp.Symbol) for old in self.put):
            return side.xreplace({old: sp.sympify(new) for old, new in self.put.items()})
        return side.subs(list(self.put.items()), simultaneous=True)


def parameter_premise(
    says: str,
    put: Mapping[sp.Symbol, Any],
    own: Mapping[sp.Symbol, Any],
    meanings: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> Premise:
    """A premise about parameters, such as ell = R: how far the paper's own values break it is computed from them.

    own: letter → the value of the paper's own scene. meanings: letters that stand for expressions in other letters.
    """
    off = []
    for left, right in put.items():
        sides = [(side, written_out(sp.sympify(side), meanings or {}).subs(own)) for side in (left, right)]
        (_, here), (_, there) = sides
        if here.is_number and there.is_number and here != there:
            off += [f"{sp.pretty(side)} = {float(value):g}" for side, value in sides if side != value]
    return Premise(says, put, broken=", ".join(off))


def written_out(expression: Any, meanings: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """The expression with each letter replaced by what it stands for, one after the other: later ones may be in earlier."""
    for letter, meaning in meanings.items():
        expression = expression.xreplace({letter: sp.sympify(meaning)})
    return expression


Given: TypeAlias = "Mapping[sp.Basic, Any] | Iterable[Premise]"


def premises_of(given: Given) -> tuple[Premise, ...]:
    """Premises as they are, or one for each row of a substitution, old → new."""
    if isinstance(given, Mapping):
        return tuple(Premise(f"{readable(str(old))} = {readable(str(new))}", {old: new}) for old, new in given.items())
    return tuple(given)


def subsets(premises: tuple[Premise, ...]) -> Iterator[tuple[Premise, ...]]:
    """Every choice of premises, fewest first: the first under which an equation holds is what it needs."""
    for size in range(len(premises) + 1):
        yield from combinations(premises, size)
