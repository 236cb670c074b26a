"""The check of a source without derivations. It examines the steps of chains, claimed orders and indices of sums.

A chain a = b = c has one step for each equality sign; the expressions on both sides are the members of the step.

A step holds if its two members are proved equal, as printed or after evaluation of derivatives and integrals. It is
refuted if the members differ, no earlier equation relates their symbols, and one small change makes them equal. The
change is one sign, factor, power or function; it distinguishes a slip from a law. Any other step is not judged, for a
reason listed below. The first step of a chain may define a symbol or state a condition, so it is never refuted.

No reading is confirmed: the kinds of symbols come from the `paper.toml` next to the source, or from one sweep.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import sympy as sp

from lagrotor.algebra import agreement_order
from lagrotor.errors import LagrotorError, WorkError
from lagrotor.paper.latex.comparison import (
    TOO_LARGE,
    agree,
    agree_for_positive,
    bound_work,
    count_calls,
    equality,
    expression_of,
    is_large,
    may_agree,
    radicands,
)
from lagrotor.paper.latex.displays import Displayed, Source
from lagrotor.paper.latex.formula import Reading, letters_printed, read_formula
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.slips import change_to_agree, constant_value
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.tree import (
    BINDING,
    KNOWN,
    Call,
    Letter,
    Node,
    Number,
    Opaque,
    has_opaque,
    letters_of,
    number,
    put_for,
    rates_of,
    sympy_expression,
    text_of,
    walk,
)

HOLDS, REFUTED, NOT_JUDGED = "holds", "refuted", "not judged"
INDEX, FAULT = "index outside its sum", "no LaTeX"
# Findings that are errors; they are listed even without --all.
WRONG = (REFUTED, INDEX, FAULT)
# Reasons not to judge a step.
NOT_READ = "the display is not read"
UNCOMPARABLE = "a member cannot be evaluated as an expression"
OUTSIDE = "the exact decision does not cover the difference"
FUNCTIONS = "the members have derivatives, integrals or functions that may be related"
LETTERS = "the right member has symbols that the left member lacks"
BEFORE = "an earlier equation relates its symbols"
MAYBE = "the step may state a condition"
ROUNDED = "a decimal number may be rounded"
ALL_REAL = Notation()
_VERDICT = tuple[str, str]
_RELATION = re.compile(r"=|[<>]|\\(?:equiv|approx|simeq|sim|to|ll|gg|rightarrow|propto|cong|leq?|geq?)\b")
_BOUNDS = frozenset(("<", ">", "<=", ">=", "!="))


@dataclass(frozen=True)
class StepFinding:
    """One finding of the check. `step` is the number of the step in its chain, from 1; 0 stands for the whole equation.

    equation: the id of the equation, '' for a LaTeX error. line: its line in the file. verdict: HOLDS, REFUTED,
    NOT_JUDGED, INDEX or FAULT. why: the reason in words. members: both sides of the step as they were read. file: the
    included file that contains the line, '' for the main file.
    """

    equation: str
    step: int
    line: int
    verdict: str
    why: str
    members: tuple[str, ...] = ()
    file: str = ""

    def as_data(self) -> dict[str, Any]:
        """Return the finding as a dictionary for JSON; empty fields other than `equation` are left out."""
        return {key: value for key, value in asdict(self).items() if value not in ("", ()) or key == "equation"}


@dataclass(frozen=True)
class Check:
    """All findings of the check of one source."""

    findings: tuple[StepFinding, ...]

    @property
    def counts(self) -> dict[str, int]:
        """The number of findings with each of the verdicts HOLDS, REFUTED and NOT_JUDGED."""
        counts = Counter(finding.verdict for finding in self.findings)
        return {verdict: counts[verdict] for verdict in (HOLDS, REFUTED, NOT_JUDGED)}

    @property
    def reasons(self) -> dict[str, int]:
        """The three most frequent reasons why steps are not judged, each with the number of these steps."""
        reasons = Counter(finding.why.partition(": ")[0] for finding in self.findings if finding.verdict == NOT_JUDGED)
        return dict(reasons.most_common(3))


def check_source(source: Source, declared: Notation = ALL_REAL) -> Check:
    """Check the displayed equations of a source. The formulas suggest the kinds of symbols that are not in `declared`."""
    notation = with_proposals(declared, propose([*(equation.latex for equation in source.equations), *source.inline]))
    readings = [(equation, read_formula(equation.latex, notation, equation.lead)) for equation in source.equations]
    faults = [
        StepFinding("", 0, n, FAULT, sentence, file=file if file != source.file else "")
        for file, n, sentence in source.faults
    ]
    return Check((*faults, *_Checker(source, readings, notation).findings()))


class _Checker:
    def __init__(self, source: Source, readings: list[tuple[Displayed, Reading]], notation: Notation) -> None:
        self.source, self.readings, self.notation = source, readings, notation
        sides = (s.node for _, reading in readings for statement in reading.statements for s in statement.sides)
        self.opaque = Opaque()
        self.moving = Opaque(self.opaque.names, rates_of(sides))  # with rates: derivatives are evaluated
        self.place = 0

    def findings(self) -> Iterator[StepFinding]:
        for place, (equation, reading) in enumerate(self.readings):
            self.place = place
            if not reading.whole:
                what, helps = reading.stop or ("", "")
                yield self._finding(equation, 0, None, NOT_JUDGED, f"{NOT_READ}: {what}: {helps}")
            for nth, statement in enumerate(reading.statements):
                yield from (self._finding(equation, 0, None, INDEX, why) for why in _open_indices(statement))
                yield from self._steps(equation, statement, statement if nth else self._join_row(equation, statement))

    def _finding(
        self, equation: Displayed, step: int, sides: tuple[Side, Side] | None, verdict: str, why: str
    ) -> StepFinding:
        file, line = equation.place
        if sides is not None and len(equation.rows) > 1:
            line = equation.rows[min(equation.latex[: sides[1].at].count(r"\\"), len(equation.rows) - 1)]
        members = tuple(text_of(side.node) for side in sides or ())
        return StepFinding(equation.id, step, line, verdict, why, members, file if file != self.source.file else "")

    def _steps(
        self, display: Displayed, printed: PrintedStatement, statement: PrintedStatement
    ) -> Iterator[StepFinding]:
        """Yield the findings on the steps of a chain. The first step is reported only if it is an identity.

        `printed` is the statement without the member that `statement` takes from the previous row.
        """
        order_before = None if statement is printed else self.readings[self.place - 1][1].statements[-1].order
        steps = enumerate(zip(statement.sides, statement.sides[1:], statement.relations, strict=False), 1)
        for step, (lhs, rhs, relation) in steps:
            claimed = (rhs is statement.sides[-1] and statement.order) or (step == 2 and order_before)
            if step == 1 and (statement is not printed or not _may_be_identity(lhs.node, rhs.node)):
                continue
            decide: Callable[..., _VERDICT] = self._step
            arguments: tuple[Any, ...] = (lhs.node, rhs.node)
            if claimed and step > 1:
                decide, arguments = self._order, (*arguments, claimed)
            elif relation not in ("=", ":="):
                continue
            verdict, why = bound_work(decide, *arguments, too_large=(NOT_JUDGED, TOO_LARGE))
            if step > 1 or verdict == HOLDS:
                yield self._finding(display, step, (lhs, rhs), verdict, why)

    def _join_row(self, equation: Displayed, statement: PrintedStatement) -> PrintedStatement:
        """Return a statement. If its row continues the previous row, the last member of that row is inserted."""
        previous = self.readings[self.place - 1][1] if equation.lead and self.place else None
        if previous is None or not previous.whole or previous.statements[-1].kind != "equation":
            return statement
        last = replace(previous.statements[-1].sides[-1], at=0)
        first = replace(statement.sides[0], at=0)
        shifted = [replace(side, at=max(side.at - len(equation.lead) - 1, 0)) for side in statement.sides[1:]]
        return replace(statement, sides=(first, last, *shifted), relations=("=", *statement.relations))

    def _step(self, lhs: Node, rhs: Node) -> _VERDICT:
        """Return the verdict on a step, and the reason for it in words."""
        a, b = self._value(lhs), self._value(rhs)
        if a is None or b is None:
            return NOT_JUDGED, UNCOMPARABLE
        if a != b and is_large(a, b):
            return NOT_JUDGED, TOO_LARGE
        answer = equality(a, b) if may_agree(a, b) else "nonzero"
        if answer == "zero":
            return HOLDS, "an identity where its roots are real" if radicands(a, b) else "an identity"
        if agree_for_positive(a, b):
            return HOLDS, "for positive symbols"
        if answer == "undecided":
            return NOT_JUDGED, OUTSIDE
        if assumption := self._with_derivatives_taken(lhs, rhs, (a, b)):
            return HOLDS, assumption
        reason, why = self._refuted(lhs, rhs, a, b)
        if reason or equality(a, b) != "nonzero":
            return NOT_JUDGED, reason or OUTSIDE
        return REFUTED, why

    def _with_derivatives_taken(self, lhs: Node, rhs: Node, values: tuple[Any, Any]) -> str:
        """Evaluate the derivatives in both members. Return the assumption of it in words if they then agree, else ""."""
        self.moving.fixing = False
        a, b = (expression_of(node, self.moving) for node in (lhs, rhs))
        if a is None or b is None or (a, b) == values or is_large(a, b) or not agree(a, b):
            return ""
        fixed = "the other symbols constant in derivatives and integrals"
        return f"with {fixed if self.moving.fixing else 'derivatives taken'}"

    def _refuted(self, lhs: Node, rhs: Node, a: Any, b: Any) -> tuple[str, str]:
        """Decide whether unequal members refute their step; `a` and `b` are the values of `lhs` and `rhs`.

        Return two sentences: the reason not to refute the step ("" if it is refuted), and how the members differ.
        """
        letters, others = set(letters_of(lhs)), set(letters_of(rhs))
        if not _comparable(a, b):
            return FUNCTIONS, ""
        if others - letters:
            return LETTERS, ""
        numbers = (node.value for side in (lhs, rhs) for node in walk(side) if isinstance(node, Number))
        if any(value.denominator not in (1, 2, 4) for value in numbers):
            return ROUNDED, ""
        if not others:  # a constant on the right is refuted only by another constant
            value = constant_value(a)
            return (MAYBE, "") if value is None else ("", f"the left member is {value} for all values of its symbols")
        if self._has_relation(letters):
            return BEFORE, ""
        for side, fixed, changing in (("right", a, rhs), ("left", b, lhs)):
            if slip := change_to_agree(fixed, changing, self._value):
                differ = f"the members differ by {_difference(a, b)}"
                return "", f"{differ}; they would agree with {slip} in the {side} member"
        return MAYBE, ""

    def _value(self, node: Node) -> Any:
        return expression_of(node, self.opaque)

    def _has_relation(self, letters: set[str]) -> bool:
        """Return True if an earlier equation or a formula in the text relates only these symbols, so that members may agree."""
        stems = {letter.split("_")[0] for letter in letters}
        for latex, reading in (*((equation.latex, r) for equation, r in self.readings[: self.place]), *self._text):
            if not reading.whole and (names := letters_printed(latex)) and names <= stems:
                return True
            if any(self._explains(s, letters) for s in reading.statements):
                return True
        return False

    def _explains(self, statement: PrintedStatement, letters: set[str]) -> bool:
        """Return True if a statement relates only these symbols. An inequality and an identity do not count."""
        nodes = [side.node for side in statement.sides]
        if not {name for node in nodes for name in letters_of(node)} <= letters or {*statement.relations} <= _BOUNDS:
            return False
        pairs = pairwise(map(self._value, nodes))
        return statement.kind != "equation" or not all(None not in pair and agree(*pair) for pair in pairs)

    @cached_property
    def _text(self) -> list[tuple[str, Reading]]:
        """The formulas in the text that contain a relation sign, in LaTeX, each with its reading."""
        formulas = (latex for latex in self.source.inline if _RELATION.search(latex))
        return [(latex, read_formula(latex, self.notation)) for latex in formulas]

    def _order(self, lhs: Node, rhs: Node, order: tuple[str, int]) -> _VERDICT:
        """Return the verdict on a step that claims agreement up to O(x^n); `order` is (x, n). Also return the reason."""
        name, power = order
        small = sp.Symbol(name, real=True)
        try:
            a, b = sympy_expression(lhs, self.opaque), sympy_expression(rhs, self.opaque)
            if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or small not in a.free_symbols:
                return NOT_JUDGED, LETTERS
            rates = re.compile(rf"{re.escape(name)}_d+ot")  # rates of a small quantity are of the same order
            scaled = {s: small * s for s in a.free_symbols | b.free_symbols if rates.fullmatch(s.name)}
            term = count_calls(agreement_order, a.xreplace(scaled), b.xreplace(scaled), small, power - 1)
        except WorkError:
            raise
        except (LagrotorError, TypeError, ValueError, ArithmeticError, AttributeError):
            return NOT_JUDGED, OUTSIDE
        if term.order is None:
            return HOLDS, f"through order {power - 1} in {name}"
        if has_opaque(a, b):
            return NOT_JUDGED, FUNCTIONS
        return REFUTED, f"the members differ at order {term.order} in {name}; O({name}**{power}) is claimed"


def _may_be_identity(lhs: Node, rhs: Node) -> bool:
    """Return True if the first step of a chain can be an identity rather than a definition."""
    numeric = isinstance(rhs, Number) and rhs.value != 0 and any(call.name in KNOWN for call in _calls(lhs))
    return isinstance(lhs, Call) and (numeric or bool(letters_of(rhs) and not isinstance(rhs, Letter)))


def _open_indices(statement: PrintedStatement) -> Iterator[str]:
    """Yield a sentence for each index that occurs outside its sum on one side of a statement, but not on all sides.

    An index is the symbol itself, or a subscript that also occurs inside the sum. In E_k = Σ_k v_k the k of E_k is a
    label. A product or an integral over the index binds it as a sum does.
    """
    sums = [n for side in statement.sides for n in _calls(side.node) if n.name == "Sum"]
    for index in dict.fromkeys(n.args[1].name for n in sums if isinstance(n.args[1], Letter)):
        inside = {name for n in sums if n.args[1] == Letter(index) for name in letters_of(n.args[0])}
        names = {name for name in inside if index in name.split("_")[1:]} | {index}
        outside = [names & set(letters_of(_without_bound(side.node, index))) for side in statement.sides]
        if not all(outside) and (side := next((s for s, n in zip(statement.sides, outside, strict=True) if n), None)):
            yield f"{index} occurs outside the sum over {index} in {text_of(side.node)}"


def _calls(node: Node) -> Iterator[Call]:
    return (inner for inner in walk(node) if isinstance(inner, Call))


def _without_bound(node: Node, index: str) -> Node:
    """Return a node in which every sum, product and integral over an index is replaced by zero."""
    calls = (call for call in _calls(node) if call.name in BINDING)
    return put_for(node, {call: number(0) for call in calls if any(index in letters_of(e) for e in call.args[1:])})


def _difference(a: Any, b: Any) -> str:
    if isinstance(a, sp.MatrixBase):
        return "a vector"
    return sp.sstr(count_calls(sp.factor_terms, count_calls(sp.expand, a - b)))


def _comparable(a: Any, b: Any) -> bool:
    """Return True if both members are vectors or both numbers, with the same derivatives, integrals and functions."""
    hidden = [{symbol for symbol in side.free_symbols if has_opaque(symbol)} for side in (a, b)]
    return hidden[0] == hidden[1] and isinstance(a, sp.MatrixBase) == isinstance(b, sp.MatrixBase)
