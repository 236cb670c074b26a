"""The ledger: it holds what the paper prints, is given what was derived and what was assumed, and decides.

A derivation never says that an equation is right; it states what was derived, by `stating.verdict`. `decide` tries the
premises, fewest first, on both sides at once, and decides by exact identity or by the order of the first term that differs;
nothing else can. `judge` does the same for a printed expression by itself.
"""

import time
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from lagrotor.algebra import Decision, agreement_order, decide_equal
from lagrotor.errors import NotExactError
from lagrotor.mechanics.glossary import Glossary
from lagrotor.paper.letters import read
from lagrotor.paper.premises import Given, Premise, premises_of, subsets
from lagrotor.paper.verdicts import Answer, Relation, Statement, Verdict

# How far a series is looked at beyond the order that is claimed.
BEYOND = 4


@dataclass(frozen=True)
class _Finding:
    answer: Answer
    order: int | None = None
    small: sp.Symbol | None = None
    domain: tuple[sp.Expr, ...] = ()
    reasons: tuple[str, ...] = ()


_AGREES = ("holds", "holds-to-order")


def judge(printed: Any, derived: Any, given: Given = (), small: sp.Symbol | None = None, order: int = 0) -> Verdict:
    """One printed expression held against a derived one: `judge("m*g*l*sin(theta)", derived).verdict`.

    printed: a sympy expression or matrix, or text in the names of the letters of `derived` and `given`. given: what may be
    assumed, as premises or as a substitution {J: I_3}. small, order: where equality is claimed through small**order only.
    Raises InputError for text that cannot be read.
    """
    right, premises = sp.sympify(derived), premises_of(given)
    if isinstance(printed, str):
        sides = [sp.sympify(side) for premise in premises for pair in premise.put.items() for side in pair]
        letters = {s.name: s for side in (right, *sides, *filter(None, [small])) for s in side.free_symbols}
        printed = read(printed, letters, "judge")
    return decide(Statement("", (Relation(sp.sympify(printed), right, small, order),), premises))


def decide(statement: Statement, glossary: Glossary | None = None) -> Verdict:
    """Decide a statement; the correction, where there is one, by the same rules. glossary: what its letters mean."""
    began = time.perf_counter()
    meanings = Glossary() if glossary is None else glossary
    answer, finding, used = _decided(statement.relations, statement, meanings)
    if statement.measured and finding.answer in _AGREES:
        answer = "measured"
    corrected: Answer | None = None
    if statement.correction:
        corrected, _, granted = _decided(statement.correction, statement, meanings)
        used = granted if answer == "refuted" else used
    return Verdict(
        statement=statement,
        verdict=answer,
        premises=used,
        order=finding.order,
        small=finding.small,
        domain=finding.domain,
        correction_verdict=corrected,
        evidence=(*statement.evidence, *finding.reasons),
        seconds=time.perf_counter() - began,
    )


def _decided(
    relations: tuple[Relation, ...], statement: Statement, glossary: Glossary
) -> tuple[Answer, _Finding, tuple[Premise, ...]]:
    """What is decided of relations under the statement's premises, and the fewest of these that it needs."""
    if statement.names:
        return "definition", _Finding("definition"), ()
    finding, used = _fewest_premises(relations, statement.premises)
    if finding.answer not in _AGREES:
        return finding.answer, finding, ()
    if finding.small is not None and all(premise.small != finding.small for premise in used):
        used = (*used, Premise(f"small {glossary.meaning(finding.small)} {finding.small}", small=finding.small))
    return ("holds-if" if finding.answer == "holds" and used else finding.answer), finding, used


def _fewest_premises(
    relations: tuple[Relation, ...], assumed: tuple[Premise, ...]
) -> tuple[_Finding, tuple[Premise, ...]]:
    """The finding under the fewest premises that suffice.

    Where none do: what is wrong in a special case is wrong in general, and the case with the most premises granted shows
    most about what is wrong. Where the premises do not contradict each other, that case is looked at first, since no choice
    of them can mend what it refutes.
    """
    failed: tuple[Premise, ...] = ()
    put = [letter for premise in assumed for letter in premise.put]
    if assumed and len(put) == len(set(put)):
        granted = _find(relation.under(assumed) for relation in relations)
        if granted.answer == "refuted":
            return granted, ()
    for premises in subsets(assumed):
        found: list[_Finding] = []
        for relation in relations:
            found.append(_single(relation.under(premises)))
            if found[-1].answer == "refuted":
                break
        if all(finding.answer in _AGREES for finding in found):
            return _weakest(found), premises
        if found[-1].answer == "refuted":
            failed = premises
    return _find(relation.under(failed) for relation in relations), ()


def _find(relations: Iterable[Relation]) -> _Finding:
    """The weakest of the findings of all relations."""
    return _weakest([_single(relation) for relation in relations])


def _weakest(found: list[_Finding]) -> _Finding:
    rank = ("holds", "holds-to-order", "undecided", "refuted")
    worst = max(found, key=lambda f: (rank.index(f.answer), -(f.order or 0)), default=_Finding("holds"))
    domain = tuple(dict.fromkeys(factor for f in found for factor in f.domain))
    reasons = tuple(dict.fromkeys(reason for f in found for reason in f.reasons))
    return replace(worst, domain=domain, reasons=reasons)


def _single(relation: Relation) -> _Finding:
    if relation.scene:
        there = {side: getattr(relation, side).xreplace(relation.scene) for side in ("printed", "derived")}
        return _single(replace(relation, scene={}, **there))
    if relation.within is not None:
        ratio = _constant(relation.printed / relation.derived)
        near = ratio is not None and bool(abs(ratio - 1) <= relation.within)
        return _Finding("holds" if near else "refuted")
    if isinstance(relation.printed, sp.MatrixBase) != isinstance(relation.derived, sp.MatrixBase):
        kinds = ("a vector", "a number") if isinstance(relation.derived, sp.MatrixBase) else ("a number", "a vector")
        return _Finding("refuted", reasons=("the left side is {}, the printed right side {}".format(*kinds),))
    exact: Decision = decide_equal(relation.printed, relation.derived)
    domain = tuple(f for f in exact.domain if not (f.is_positive or f.is_number))
    if exact.answer == "zero":
        return _Finding("holds", domain=domain)
    if relation.small is None or relation.small not in relation.printed.free_symbols | relation.derived.free_symbols:
        if exact.answer == "undecided":
            seen = "no value found" if exact.evidence is None else f"largest value seen {exact.evidence:.3g}"
            return _Finding("undecided", reasons=(f"{exact.reason} ({seen})",))
        return _Finding("refuted", domain=domain)
    return _to_order(relation, relation.small, domain)


def _constant(ratio: sp.Expr) -> sp.Expr | None:
    """The number that a quotient of rates is, which may hold roots; None where it depends on a letter."""
    square = sp.cancel(ratio**2)
    if not square.is_number:
        return None
    return sp.sqrt(square) * sp.sign(ratio.subs(dict.fromkeys(ratio.free_symbols, sp.Rational(3, 7))))


def _to_order(relation: Relation, small: sp.Symbol, domain: tuple[sp.Expr, ...]) -> _Finding:
    """How far two series agree; of vectors, the first component that differs decides."""
    matrices = isinstance(relation.printed, sp.MatrixBase)
    pairs = zip(relation.printed, relation.derived, strict=True) if matrices else [(relation.printed, relation.derived)]
    try:
        terms = [agreement_order(p, d, small, relation.claimed + BEYOND) for p, d in pairs]
    except NotExactError as refusal:
        return _Finding("undecided", reasons=(str(refusal),))
    first = min(terms, key=lambda term: term.through + 1 if term.order is None else term.order)
    reached = first.through if first.order is None else first.order - 1
    if reached >= relation.claimed:
        return _Finding("holds-to-order", reached, small, domain)
    reason = f"first differs at order {first.order} in {small}, by {first.coefficient}"
    return _Finding("refuted", reached, small, domain, (reason,))
