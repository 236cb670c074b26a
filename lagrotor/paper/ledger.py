"""The ledger: it is handed what the paper prints and what was derived, and decides.

A derivation never says that an equation is right. It makes a `Statement`: pairs of a printed and a derived expression,
the condition under which they may agree, the small quantity in which they may only be close. `judge` turns it into a
`Verdict`, by exact identity or by the order of the first term that differs; nothing else can.
"""

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

import sympy as sp

from lagrotor.algebra import Decision, agreement_order, decide_equal
from lagrotor.errors import InputError, NotExactError
from lagrotor.paper.catalogue import equation
from lagrotor.paper.tables import Cell, Table

Answer = Literal["holds", "holds-if", "holds-to-order", "refuted", "measured", "definition", "undecided"]
Side: TypeAlias = Any  # a sympy expression or matrix
# How far a series is looked at beyond the order that is claimed.
BEYOND = 4


@dataclass(frozen=True)
class Relation:
    """`printed` should equal `derived`; with `small`, up to and including small**claimed.

    within: for a number read off a run, the relative error that its printed digits allow.
    """

    printed: Side
    derived: Side
    small: sp.Symbol | None = None
    claimed: int = 0
    within: sp.Rational | None = None


def chain(derived: Side, *printed: Side, small: sp.Symbol | None = None, claimed: int = 0) -> tuple[Relation, ...]:
    """The relations of a printed line `… = p_1 = p_2 = …`, each member held against the derived expression."""
    return tuple(Relation(sp.sympify(p), sp.sympify(derived), small, claimed) for p in printed)


@dataclass(frozen=True)
class Statement:
    """What one equation of the paper is held to.

    relations: printed against derived. given: substitutions that state a condition, tried when the bare relations fail.
    correction: what should stand there, as relations of its own; quantities: what each of them gives, in LaTeX.
    wrong: what was wrong, in a line.
    definition: the line only names something.
    measured: the line is a number read off a run; the relations hold what it should have been, and how near.
    depends_on: ids of the equations that this one uses. evidence: sentences with the numbers that were computed.
    """

    id: str
    relations: tuple[Relation, ...]
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    condition: str = ""
    correction: tuple[Relation, ...] = ()
    wrong: str = ""
    quantities: tuple[str, ...] = ()
    definition: bool = False
    measured: bool = False
    depends_on: tuple[str, ...] = ()
    evidence: tuple[str, ...] = ()
    steps: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for identifier in (self.id, *self.depends_on):
            equation(identifier)
        if not self.relations:
            raise InputError(f"Statement: {self.id} holds nothing against anything: give it a relation")


@dataclass(frozen=True)
class Verdict:
    """What was decided of one equation. `order`, `small`: for holds-to-order; `domain`: factors that must not vanish.

    `reaches_result`: for a refuted equation, whether a result of the paper falls with it (None: nothing to ask).
    """

    statement: Statement
    verdict: Answer
    condition: str | None
    order: int | None
    small: sp.Symbol | None
    domain: tuple[sp.Expr, ...]
    correction_verdict: Answer | None
    evidence: tuple[str, ...]
    seconds: float
    reaches_result: bool | None = None

    @property
    def id(self) -> str:
        """The equation's id in the catalogue."""
        return self.statement.id

    def _repr_html_(self) -> str:
        return verdict_table([self])._repr_html_()


def verdict_table(verdicts: Iterable[Verdict]) -> Table:
    """Verdicts below each other, each with its condition or order, what was wrong and the evidence."""
    return Table("Verdicts", ("equation", "verdict", "why"), tuple(map(_row, verdicts)))


def _row(v: Verdict) -> tuple[Cell, ...]:
    order = f"through order {v.order} in {v.small}" if v.verdict == "holds-to-order" else ""
    corrected = f"the correction: {v.correction_verdict}" if v.verdict == "refuted" and v.correction_verdict else ""
    decided = tuple(filter(None, (v.verdict, v.condition, order, corrected)))
    return f"{v.id}: {equation(v.id).title}", decided, tuple(filter(None, (v.statement.wrong, *v.evidence)))


@dataclass(frozen=True)
class _Finding:
    answer: Answer
    order: int | None = None
    small: sp.Symbol | None = None
    domain: tuple[sp.Expr, ...] = ()
    reasons: tuple[str, ...] = ()


def judge(statement: Statement) -> Verdict:
    """Decide a statement; the correction, where there is one, by the same rules."""
    began = time.perf_counter()
    finding, condition = _with_condition(statement)
    correction: Answer | None = None
    if statement.correction:
        correction = _find(statement.correction).answer
    if finding.answer != "undecided" and statement.definition:
        finding = replace(finding, answer="definition") if finding.answer == "holds" else finding
    if statement.measured and finding.answer == "holds":
        finding = replace(finding, answer="measured")
    return Verdict(
        statement=statement,
        verdict=finding.answer,
        condition=condition,
        order=finding.order,
        small=finding.small,
        domain=finding.domain,
        correction_verdict=correction,
        evidence=(*statement.evidence, *finding.reasons),
        seconds=time.perf_counter() - began,
    )


def _with_condition(statement: Statement) -> tuple[_Finding, str | None]:
    bare = _find(statement.relations)
    if bare.answer in ("holds", "holds-to-order") or not statement.given:
        return bare, None
    under = _find(tuple(_given(r, statement.given) for r in statement.relations))
    if under.answer in ("holds", "holds-to-order"):
        text = ", ".join(f"{name} = {value}" for name, value in statement.given.items())
        condition = f"{text} ({statement.condition})" if statement.condition else text
        answer: Answer = "holds-if" if under.answer == "holds" else "holds-to-order"
        return replace(under, answer=answer), condition
    return bare, None


def _given(relation: Relation, given: Mapping[sp.Symbol, sp.Expr]) -> Relation:
    def put(side: Side) -> Side:
        return side.subs(list(given.items()), simultaneous=True)

    return replace(relation, printed=put(relation.printed), derived=put(relation.derived))


def _find(relations: Iterable[Relation]) -> _Finding:
    """The weakest of the findings of all relations."""
    rank = ("holds", "holds-to-order", "undecided", "refuted")
    found = [_single(relation) for relation in relations]
    worst = max(found, key=lambda f: (rank.index(f.answer), -(f.order or 0)), default=_Finding("holds"))
    domain = tuple(dict.fromkeys(factor for f in found for factor in f.domain))
    reasons = tuple(dict.fromkeys(reason for f in found for reason in f.reasons))
    return replace(worst, domain=domain, reasons=reasons)


def _single(relation: Relation) -> _Finding:
    if relation.within is not None:
        ratio = sp.cancel(relation.printed / relation.derived)
        near = ratio.is_number and bool(abs(ratio - 1) <= relation.within)
        return _Finding("holds" if near else "refuted")
    exact: Decision = decide_equal(relation.printed, relation.derived)
    domain = tuple(f for f in exact.domain if not (f.is_positive or f.is_number))
    if exact.answer == "zero":
        return _Finding("holds", domain=domain)
    if relation.small is None:
        if exact.answer == "undecided":
            seen = "no value found" if exact.evidence is None else f"largest value seen {exact.evidence:.3g}"
            return _Finding("undecided", reasons=(f"{exact.reason} ({seen})",))
        return _Finding("refuted", domain=domain)
    try:
        first = agreement_order(relation.printed, relation.derived, relation.small, relation.claimed + BEYOND)
    except NotExactError as refusal:
        return _Finding("undecided", reasons=(str(refusal),))
    reached = first.through if first.order is None else first.order - 1
    if reached >= relation.claimed:
        return _Finding("holds-to-order", reached, relation.small, domain)
    reason = f"first differs at order {first.order} in {relation.small}, by {first.coefficient}"
    return _Finding("refuted", reached, relation.small, domain, (reason,))


# The equations in which the paper's work ends: the rate, the trajectories, the natural frequency.
RESULTS = ("2.12", "5.15", "5.22", "5.28", "6.02")


def follow_errors(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """For each refuted equation, whether a result of the paper that rests on it falls too, judged from sound premises."""
    listed = list(verdicts)
    by_id = {v.id: v for v in listed}
    users = {i: [v.id for v in listed if i in v.statement.depends_on] for i in by_id}

    def reaches(identifier: str, seen: frozenset[str]) -> bool:
        if by_id[identifier].verdict == "refuted" and identifier in RESULTS:
            return True
        return any(reaches(u, seen | {u}) for u in users[identifier] if u not in seen)

    return [
        replace(v, reaches_result=reaches(v.id, frozenset({v.id}))) if v.verdict == "refuted" else v for v in listed
    ]
