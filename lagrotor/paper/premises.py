"""Premises: what is assumed when an equation is judged, in words, as a substitution, and whether the paper's scene keeps it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import sympy as sp

from lagrotor.pair.lagrangians import INERTIAS, J_OF
from lagrotor.pair.symbols import I1, I3, J, K, M, R, ell, m

# The paper's own rotor and bar (sections 4.1 and 5.2.1), SI units. Its lighter bar has m = 0.01, K = 0.1.
PAPERS_OWN: Mapping[sp.Symbol, sp.Expr] = {I1: 1, I3: 1, M: 1, R: 1, ell: 1, m: 1, K: 1}


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
        return side.subs(list(self.put.items()), simultaneous=True) if self.put else side


def parameter_premise(
    says: str, put: Mapping[sp.Symbol, sp.Expr], own: Mapping[sp.Symbol, Any] = PAPERS_OWN
) -> Premise:
    """A premise about parameters, such as J = I_3: how far the paper's own values break it is computed from them."""
    off = []
    for left, right in put.items():
        sides = [(side, in_parameters(sp.sympify(side)).subs(own)) for side in (left, right)]
        (_, here), (_, there) = sides
        if here.is_number and there.is_number and here != there:
            off += [f"{sp.pretty(side)} = {float(value):g}" for side, value in sides if side != value]
    return Premise(says, put, broken=", ".join(off))


def in_parameters(expression: Any) -> Any:
    """The expression in the rotor's and the bar's own parameters: a, b, k, J by what they are."""
    return expression.subs(INERTIAS, simultaneous=True).subs(J, J_OF)


def subsets(premises: tuple[Premise, ...]) -> Iterator[tuple[Premise, ...]]:
    """Every choice of premises, fewest first: the first under which an equation holds is what it needs."""
    for size in range(len(premises) + 1):
        yield from combinations(premises, size)
