"""What a certificate is of: one printed line with its hypotheses, the only place where verdicts are read.

The printed side is the catalogue's, the other what was derived, both without any premise put in; premises and the values of a
scene are equations beside them. A letter that a premise scales, such as F in F = epsilon*F, is another one on the right.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import Answer, LineVerdict, Verdict

# What the values that the text gives for a line are called among its premises.
SCENE = "the text's values"


@dataclass(frozen=True)
class Proposition:
    """One line of an equation, or of its correction, as it was line.

    name: that of its theorem, line_1 or correction_1. equations: the premises' and the scene's, (left, right) with the words
    for each; they are what the line holds under, or, of a refuted one, all that were offered. region: their inequalities.
    stands_for: a letter for each derivative and integral, of which nothing is used but that it is the same wherever it stands.
    small, order: of a series.
    """

    name: str
    quantity: str
    verdict: Answer
    printed: Any
    derived: Any
    equations: tuple[tuple[str, sp.Expr, sp.Expr], ...] = ()
    region: tuple[sp.Basic, ...] = ()
    stands_for: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    within: sp.Rational | None = None
    small: sp.Symbol | None = None
    order: int | None = None

    @property
    def pairs(self) -> tuple[tuple[sp.Expr, sp.Expr], ...]:
        """(printed, derived), entry by entry."""
        if isinstance(self.printed, sp.MatrixBase) and isinstance(self.derived, sp.MatrixBase):
            return tuple(zip(self.printed, self.derived, strict=True))
        return ((self.printed, self.derived),)


def propositions(verdict: Verdict) -> Iterator[Proposition]:
    """Every printed line of an equation, then every line of its correction."""
    for kind, lines in (("line", verdict.lines), ("correction", verdict.correction_lines)):
        for number, line in enumerate(lines, 1):
            yield _proposition(f"{kind}_{number}", line, verdict.statement.premises)


def _proposition(name: str, line: LineVerdict, offered: tuple[Premise, ...]) -> Proposition:
    relation = line.relation
    premises = offered if line.verdict == "refuted" else line.premises
    set_otherwise = {old for premise in premises if premise.small is None for old in premise.put}
    rows = [
        (premise.says, old, new)
        for premise in premises
        for old, new in _unscaled(premise)
        if premise.small is None or old not in set_otherwise  # a letter that is zero need not be small
    ]
    where = [each for premise in premises for each in premise.where]
    rows += [(str(each), each.lhs, each.rhs) for each in where if isinstance(each, sp.Eq)]
    rows += [(SCENE, old, new) for old, new in relation.scene.items()]
    rows = [(says, sp.sympify(old, strict=True), sp.sympify(new, strict=True)) for says, old, new in rows]
    held = [relation.printed, relation.derived, *where, *(side for _, *sides in rows for side in sides)]
    letters = _letters_for_operators(held)
    return Proposition(
        name,
        relation.quantity,
        line.verdict,
        relation.printed.xreplace(letters),
        relation.derived.xreplace(letters),
        tuple((says, old.xreplace(letters), new.xreplace(letters)) for says, old, new in rows),
        tuple(each.xreplace(letters) for each in where if not isinstance(each, sp.Eq)),
        tuple((letter, node) for node, letter in letters.items()),
        relation.within,
        line.small,
        line.order,
    )


def _letters_for_operators(held: list[Any]) -> dict[sp.Expr, sp.Symbol]:
    """Derivative or integral -> a letter that no side holds; those that hold others first."""
    nodes = {node for side in held for node in side.atoms(sp.Derivative, sp.Integral)}
    names = {symbol.name for side in held for symbol in side.free_symbols}
    found: dict[sp.Expr, sp.Symbol] = {}
    for node in sorted(nodes, key=lambda each: (-len(str(each)), str(each))):
        kind, count = node.func.__name__.lower(), len(found) + 1
        while f"{kind}_{count}" in names:
            count += 1
        names.add(f"{kind}_{count}")
        found[node] = sp.Symbol(f"{kind}_{count}", real=True)
    return found


def _unscaled(premise: Premise) -> Iterator[tuple[sp.Basic, Any]]:
    """The rows of a premise; a letter that it replaces is another one where it stands on the right."""
    scaled = {old: sp.Symbol(f"{old}_scaled", **old.assumptions0) for old in premise.put if old.is_Symbol}
    for old, new in premise.put.items():
        yield old, sp.sympify(new, strict=True).xreplace(scaled)
