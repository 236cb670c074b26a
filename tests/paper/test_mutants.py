"""Every judged equation has twins with one sign or coefficient changed, made here, and each is refuted."""

import random
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import pytest
import sympy as sp

from lagrotor.paper import scripts
from lagrotor.paper.audit import statements
from lagrotor.paper.ledger import Relation, Statement, judge

MOST = 6  # twins of one relation that are judged


def twins(e: sp.Expr) -> Iterator[sp.Expr]:
    """Expressions that differ from `e` in one sign or one coefficient."""
    if e.is_Number:
        yield e + 1
        return
    if e.is_Symbol:
        yield 2 * e
        yield -e
        return
    if e.is_Add:
        for term in e.args:
            yield e - 2 * term
            yield e + term
    if e.is_Mul:
        yield -e
        yield 2 * e
    for i, part in enumerate(e.args):
        if isinstance(part, sp.Expr) and not (e.is_Pow and i == 1):
            for other in twins(part):
                yield e.func(*e.args[:i], other, *e.args[i + 1 :])


def side_twins(side: sp.Expr | sp.MatrixBase) -> Iterator[sp.Expr | sp.MatrixBase]:
    """Twins of an expression, or of one entry of a matrix."""
    if not isinstance(side, sp.MatrixBase):
        yield from twins(side)
        return
    for i, entry in enumerate(side):
        for other in twins(entry):
            changed = side.as_mutable()
            changed[i] = other
            yield changed


def difference(one: sp.Expr | sp.MatrixBase, other: sp.Expr | sp.MatrixBase, point: dict) -> float:
    """Largest difference of two sides at a point."""
    gap = one - other
    entries = list(gap) if isinstance(gap, sp.MatrixBase) else [gap]
    return max(abs(complex(entry.subs(point).evalf(30))) for entry in entries)


def is_another(relation: Relation, twin: Relation, given: dict, seed: int) -> bool:
    """Whether the twin differs at all where the relation is claimed: cos(−x) for cos(x) is no change, and a change
    beyond the claimed order of a series is none either."""
    given = dict(given)
    sides = [r.printed.subs(list(given.items()), simultaneous=True) for r in (relation, twin)]
    symbols = set().union(*(side.free_symbols for side in sides))
    generator = random.Random(seed)
    point = {s: sp.Rational(generator.randint(20, 90), 97) for s in sorted(symbols, key=str)}
    if relation.small is None or relation.small not in symbols:
        return difference(*sides, point) > 1e-12
    gaps = []
    for size in (sp.Rational(1, 1000), sp.Rational(1, 2000)):
        gaps.append(difference(*sides, {**point, relation.small: size}))
    if gaps[0] < 1e-25:
        return False
    order = float(sp.log(gaps[0] / gaps[1], 2)) if gaps[1] else 99
    return order < relation.claimed + 0.5


def judged() -> list:
    cases = []
    for stem in scripts.names("derivations", "s"):
        cases += [pytest.param(statement, id=statement.id) for statement in statements(stem)]
    return cases


def twin_statements(statement: Statement) -> Iterator[Statement]:
    """The statement with one relation changed; of a refuted one it is the correction that is changed and judged."""
    verdict = judge(statement).verdict
    refuted = verdict == "refuted"
    relations = statement.correction if refuted else statement.relations
    given = {} if refuted or verdict == "holds" else statement.given
    for i, relation in enumerate(relations):
        candidates = (replace(relation, printed=side) for side in side_twins(relation.printed))
        real = (c for seed, c in enumerate(candidates) if is_another(relation, c, given, seed))
        for twin in islice(real, MOST):
            changed = (*relations[:i], twin, *relations[i + 1 :])
            yield replace(statement, relations=changed, given=given, correction=(), definition=False)


@pytest.mark.parametrize("statement", judged())
def test_every_twin_is_refuted(statement: Statement) -> None:
    made = list(twin_statements(statement))
    assert made, f"{statement.id}: nothing in it can be changed: it says nothing"
    for twin in made:
        verdict = judge(twin)
        assert verdict.verdict == "refuted", (statement.id, [r.printed for r in twin.relations], verdict.verdict)


@pytest.mark.parametrize("statement", judged())
def test_a_refuted_equation_has_a_correction_that_holds(statement: Statement) -> None:
    verdict = judge(statement)
    assert verdict.verdict != "undecided", verdict.evidence
    if verdict.verdict == "refuted":
        assert verdict.correction_verdict in ("holds", "holds-to-order"), statement.id
        assert statement.wrong, f"{statement.id}: say in a line what was wrong"
        assert len(statement.quantities) == len(statement.correction), f"{statement.id}: name what is corrected"
    elif statement.correction:  # what holds where the printed condition does not
        assert verdict.correction_verdict in ("holds", "holds-to-order"), statement.id
