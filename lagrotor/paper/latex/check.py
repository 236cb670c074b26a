r"""The check of a source without any derivation: chains, equations against those they cite, dimensions, letters.

A step holds if its two members are proved equal, as they are or with the equations and text before it put in. It is
refuted only if its right member has no letter that the left one has not, the difference is decided, no equation before
relates these letters, and the words beside it state no condition. With a premise put in, one changed sign, factor or
power must also make the two agree: this tells a slip from a law. Every other step is not judged, for a reason below.

No reading is confirmed here: the kinds of letters are those that `paper.toml` beside the source declares, or one sweep proposes.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
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
    bounded,
    counted,
    decided,
    expression_of,
    is_large,
    may_agree,
    radicands,
)
from lagrotor.paper.latex.dimensions import other_dimensions
from lagrotor.paper.latex.displays import Displayed, Source
from lagrotor.paper.latex.formula import Reading, letters_printed, read_formula, with_progress
from lagrotor.paper.latex.notation import Notation, propose, with_proposals
from lagrotor.paper.latex.sentence import ASSUMPTION, CONDITION, IDENTITY, REASON, said_of
from lagrotor.paper.latex.slips import change_to_agree, constant_value
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.substitution import BINDING, PrintedMeaning, SectionMeanings, put_for, put_rounds, rounds
from lagrotor.paper.latex.tree import (
    KNOWN,
    Call,
    Letter,
    Node,
    Number,
    Opaque,
    has_opaque,
    is_vector,
    letters_of,
    number,
    rates_of,
    sympy_expression,
    text_of,
    walk,
)

HOLDS, REFUTED, NOT_JUDGED = "holds", "refuted", "not judged"
INDEX, UNITS, MEANINGS, FAULT = "index outside its sum", "dimensions differ", "two meanings", "no LaTeX"
# Findings that are shown without --all, and those that are errors.
FOUND = (REFUTED, INDEX, UNITS, MEANINGS, FAULT)
WRONG = (REFUTED, INDEX, UNITS, FAULT)
# Reasons for which a step is not judged.
NOT_READ = "the display is not read"
UNCOMPARABLE = "a member has no value that could be compared"
OUTSIDE = "the difference is outside what is decided exactly"
FUNCTIONS = "derivatives, integrals or functions may be related"
LETTERS = "the right member has letters that the left one has not"
WORDS = "the words beside it state a condition or a reason"
BEFORE = "an equation before relates its letters"
MAYBE = "it may be a condition"
ROUNDED = "a decimal number may be rounded"
ALL_REAL = Notation()
_VERDICT = tuple[str, str]
_RELATION = re.compile(r"=|[<>]|\\(?:equiv|approx|simeq|sim|to|ll|gg|rightarrow|propto|cong|leq?|geq?)\b")
_DOTTED = re.compile(r"(\w+?)_(d*)ot")
_BOUNDS = frozenset(("<", ">", "<=", ">=", "!="))


@dataclass(frozen=True)
class StepFinding:
    """One finding. `step` counts the relations of a chain from 1; 0 means the whole equation.

    equation: its id, empty where LaTeX itself would stop at the line. members: the two sides of a step as they were read.
    """

    equation: str
    step: int
    line: int
    verdict: str
    why: str
    members: tuple[str, ...] = ()
    file: str = ""

    def as_data(self) -> dict[str, Any]:
        """Return the finding as an object of JSON, without what is empty."""
        return {key: value for key, value in asdict(self).items() if value not in ("", ()) or key == "equation"}


@dataclass(frozen=True)
class Check:
    """The findings on a source."""

    findings: tuple[StepFinding, ...]

    @property
    def counts(self) -> dict[str, int]:
        """The number of steps that hold, are refuted, and are not judged."""
        counts = Counter(each.verdict for each in self.findings)
        return {verdict: counts[verdict] for verdict in (HOLDS, REFUTED, NOT_JUDGED)}

    @property
    def reasons(self) -> dict[str, int]:
        """The three commonest reasons for which steps are not judged, with their numbers."""
        reasons = Counter(each.why.partition(": ")[0] for each in self.findings if each.verdict == NOT_JUDGED)
        return dict(reasons.most_common(3))


def check_source(source: Source, declared: Notation = ALL_REAL, progress: Callable[[str], None] | None = None) -> Check:
    """Check the displayed equations of a source.

    Parameters
    ----------
    source : Source
        The displays with the words beside them.
    declared : Notation
        The kinds of letters that the author declares; one sweep proposes the others.
    progress : callable, optional
        Called with a sentence before each `EVERY` displays.

    Returns
    -------
    Check
        The findings in the order of the source.
    """
    notation = with_proposals(declared, propose([*(each.latex for each in source.equations), *source.inline]))
    readings = [
        (each, read_formula(each.latex, notation, each.lead))
        for each in with_progress("read", source.equations, progress)
    ]
    checker = _Checker(source, readings, notation)
    order = {each.id: place for place, each in enumerate(source.equations)}
    faults = [
        StepFinding("", 0, n, FAULT, said, file=file if file != source.file else "") for file, n, said in source.faults
    ]
    findings = sorted(checker.findings(progress), key=lambda each: (order[each.equation], each.step))
    return Check((*faults, *findings))


@dataclass(frozen=True)
class _Way:
    """Two members, as expressions, with premises put in round by round."""

    put: list[dict[Node, PrintedMeaning]]
    opaque: Opaque
    left: Any
    right: Any

    def value(self, node: Node) -> Any:
        """Return any node as an expression with the premises put in."""
        return expression_of(put_rounds(node, self.put), self.opaque)

    @property
    def used(self) -> list[PrintedMeaning]:
        """The premises."""
        return [each for one in self.put for each in one.values()]

    @property
    def name(self) -> str:
        """The premises and assumptions, in words."""
        names = [*dict.fromkeys(each.name for each in self.used)]
        names += ["the other letters fixed in derivatives and integrals"] * self.opaque.fixing
        return ", ".join([*names, *["positive letters"] * self.opaque.assuming]) or "derivatives taken"


class _Checker:
    def __init__(self, source: Source, readings: list[tuple[Displayed, Reading]], notation: Notation) -> None:
        self.source, self.readings, self.notation = source, readings, notation
        self.opaque = Opaque()
        self.given, self.sections_read = SectionMeanings(negative=self._compared_with_zero("<", "<=")), set[str]()
        self.labelled: defaultdict[str, list[Displayed]] = defaultdict(list)
        self.place = 0
        self.statements = [(each, s) for each, reading in readings for s in reading.statements]
        self.rates = rates_of(side.node for _, statement in self.statements for side in statement.sides)

    def findings(self, progress: Callable[[str], None] | None = None) -> Iterator[StepFinding]:
        """Yield every finding."""
        for place, (each, reading) in enumerate(with_progress("check", self.readings, progress)):
            self.place = place
            if not reading.whole:
                self.given.unread |= {(each.section, name) for name in letters_printed(each.latex.partition("=")[0])}
                what, helps = reading.stop or ("", "")
                yield self._finding(each, 0, None, NOT_JUDGED, f"{NOT_READ}: {what}: {helps}")
                continue
            self._take_text(each.section)
            for statement in reading.statements:
                self.given.add(statement, f"({each.id})", each.section, place)
            for nth, statement in enumerate(reading.statements):
                yield from self._steps(each, statement, statement if nth else self._continued(each, statement))
                yield from (self._finding(each, 0, None, INDEX, why) for why in _open_indices(statement))
            self.labelled[each.label].append(each)
        for each, why in other_dimensions(self.statements, self._values(), self.source.words):
            yield self._finding(each, 0, None, UNITS, why)
        for each, why in self._other_meanings():
            yield self._finding(each, 0, None, MEANINGS, why)

    def _finding(
        self, each: Displayed, step: int, sides: tuple[Side, Side] | None, verdict: str, why: str
    ) -> StepFinding:
        file, line = each.place
        if sides is not None and len(each.rows) > 1:
            line = each.rows[min(each.latex[: sides[1].at].count(r"\\"), len(each.rows) - 1)]
        members = tuple(text_of(side.node) for side in sides or ())
        return StepFinding(each.id, step, line, verdict, why, members, file if file != self.source.file else "")

    # ---- chains

    def _steps(self, each: Displayed, printed: PrintedStatement, statement: PrintedStatement) -> Iterator[StepFinding]:
        """Yield the steps of a chain but the first, unless that may be an identity; printed: without the row before."""
        order_before = None if statement is printed else self.readings[self.place - 1][1].statements[-1].order
        steps = enumerate(zip(statement.sides, statement.sides[1:], statement.relations, strict=False), 1)
        for step, (left, right, relation) in steps:
            claimed = (right is statement.sides[-1] and statement.order) or (step == 2 and order_before)
            arguments: tuple[Any, ...] = (self._step, left.node, right.node, printed, step == 1)
            if step == 1 and (statement is not printed or not self._is_judged_alone(left.node, right.node, printed)):
                continue
            if claimed and step > 1:
                arguments = (self._order, left.node, right.node, claimed)
            elif relation not in ("=", ":="):
                continue
            verdict, why = bounded(*arguments, too_large=(NOT_JUDGED, TOO_LARGE))
            if step > 1 or verdict != NOT_JUDGED:
                yield self._finding(each, step, (left, right), verdict, why)

    def _continued(self, each: Displayed, statement: PrintedStatement) -> PrintedStatement:
        """Return a row that continues the one before, with the last side of that row in its place."""
        before = self.readings[self.place - 1][1] if each.lead and self.place else None
        if before is None or not before.whole or before.statements[-1].kind != "equation":
            return statement
        last = replace(before.statements[-1].sides[-1], at=0)
        first = replace(statement.sides[0], at=0)
        shifted = [replace(side, at=max(side.at - len(each.lead) - 1, 0)) for side in statement.sides[1:]]
        return replace(statement, sides=(first, last, *shifted), relations=("=", *statement.relations))

    def _is_judged_alone(self, left: Node, right: Node, printed: PrintedStatement) -> bool:
        """Return whether the first step of a chain may be an identity, or may be worked out from the text."""
        numeric = isinstance(right, Number) and right.value != 0 and any(each.name in KNOWN for each in _calls(left))
        speaks = numeric or (letters_of(right) and not isinstance(right, Letter))
        return bool(speaks) and (isinstance(left, Call) or self._is_worked_out(left, right, printed))

    def _step(self, left: Node, right: Node, printed: PrintedStatement, first: bool) -> _VERDICT:
        """Return the verdict on a step, and the reason."""
        self.opaque.assuming = False
        a, b = self._value(left), self._value(right)
        assuming = self.opaque.assuming
        if a is None or b is None:
            return NOT_JUDGED, UNCOMPARABLE
        if a != b and is_large(a, b):
            return NOT_JUDGED, TOO_LARGE
        answer = decided(a, b) if may_agree(a, b) else "nonzero"
        if answer == "zero":
            return HOLDS, "an identity where its roots are real" if radicands(a, b) else "an identity"
        ways = [*self._ways(left, right, a, b, printed)]
        if answer == "undecided" and agree_for_positive(a, b):
            return HOLDS, "for positive letters"
        for agreeing, condition in ((agree, ""), (agree_for_positive, ", positive letters")):
            for way in ways:
                if agreeing(way.left, way.right):
                    return HOLDS, f"with {way.name}{condition}"
        if answer == "undecided":
            return NOT_JUDGED, OUTSIDE
        reason, why = self._refuted(left, right, a, b, first, bool(ways))
        if not reason and not assuming and decided(a, b) == "nonzero":
            return REFUTED, why
        for way in ways if not first or self._is_worked_out(left, right, printed) else ():
            slip = self._slip_with(left, right, way) if self._are_sure(way.used, printed) else ""
            takes_a_sign = way.opaque.assuming or any(each.is_a_root for each in way.used)
            if slip and not ("sign" in slip and takes_a_sign):
                return REFUTED, f"with {way.name} the two members differ; {slip}"
        return NOT_JUDGED, reason or OUTSIDE

    def _refuted(self, left: Node, right: Node, a: Any, b: Any, first: bool, premises: bool) -> tuple[str, str]:
        """Return the reason for which a difference that is not zero refutes nothing, or "" and how the members differ.

        Without a slip that explains it, a difference refutes only where nothing before speaks of its letters.
        """
        letters, others = set(letters_of(left)), set(letters_of(right))
        if not _comparable(a, b) or (has_opaque(a, b) and (first or not others)):
            return FUNCTIONS, ""
        if others - letters and not (isinstance(a, sp.Add) and _but_for_dots(others, letters)):
            return LETTERS, ""
        numbers = (each.value for side in (left, right) for each in walk(side) if isinstance(each, Number))
        if any(value.denominator not in (1, 2, 4) for value in numbers):
            return ROUNDED, ""
        if self._says(ASSUMPTION) or self._says(CONDITION):
            return WORDS, ""
        if first and not (a.has(sp.Function) and b.has(sp.Function) and self._says(IDENTITY)):
            return MAYBE, ""
        differ = f"the members differ by {_difference(a, b)}"
        if not others and letters:
            value = constant_value(a)
            if value is not None:
                return "", f"the left member is {value} for all values of its letters"
            slip = change_to_agree(b, left, letters, self._value) if a.has(sp.Function) else None
            return ("", f"{differ}; {slip}") if slip and "sign" in slip else (MAYBE, "")
        if self._related(letters):
            return BEFORE, ""
        fewer = [a.subs(each, 0) for each in a.free_symbols if each.name in letters - others]
        if any(agree(each, b) for each in (*fewer, *(a - term for term in sp.Add.make_args(a)))):  # v₀² + 2as = 2as
            return MAYBE, ""
        if slip := self._slip(left, right, a, b, first):
            return "", f"{differ}; {slip}"
        if first or premises or has_opaque(a, b) or any(map(is_vector, walk(left))):
            return MAYBE, ""
        if self._says(REASON):
            return WORDS, ""
        return (BEFORE, "") if self._speaks_of(a - b) else ("", differ)

    def _slip(self, left: Node, right: Node, a: Any, b: Any, first: bool) -> str | None:
        """Return the one change with which the two members agree."""
        names = {*letters_of(left), *letters_of(right)}
        slips = (change_to_agree(fixed, node, names, self._value, first) for fixed, node in ((a, right), (b, left)))
        return next(filter(None, slips), None)

    def _slip_with(self, left: Node, right: Node, way: _Way) -> str | None:
        """Return the one change of the right member with which it is the left one, the premises put in."""
        letters, others = (set(letters_of(put_rounds(side, way.put))) for side in (left, right))
        if None in (way.left, way.right) or not others or not _comparable(way.left, way.right):
            return None
        if not _but_for_dots(others, letters) or self._related(letters | others, way.used):
            return None
        return change_to_agree(way.left, right, letters | set(letters_of(right)), way.value)

    def _value(self, node: Node) -> Any:
        return expression_of(node, self.opaque)

    def _ways(self, left: Node, right: Node, a: Any, b: Any, printed: PrintedStatement) -> Iterator[_Way]:
        """Yield the members a and b, derivatives taken and premises put in: for letters of either one alone, of both."""
        section = self.readings[self.place][0].section

        def premises(parts: Iterable[Node]) -> Iterator[PrintedMeaning]:
            return self.given.of(parts, self.place, section, printed)

        tried: list[list[dict[Node, PrintedMeaning]]] = []
        for constant_side in (1, 0, None):
            put = rounds((left, right), premises, constant_side)
            if put in tried:
                continue
            tried.append(put)
            opaque = Opaque(self.opaque.names, self.rates, positive=self._positive)
            sides = [expression_of(put_rounds(node, put), opaque) for node in (left, right)]
            if None not in sides and sides != [a, b] and not is_large(*sides):
                yield _Way(put, opaque, *sides)

    def _is_worked_out(self, left: Node, right: Node, printed: PrintedStatement) -> bool:
        """Return whether the left member of a first step is worked out from the text, so that the step is no condition."""
        if not isinstance(left, Letter):
            derived = isinstance(left, Call) and left.name in ("Derivative", "Integral", "at_constant", "rate")
            return derived or self.given.is_called(left, printed)
        if dotted := _DOTTED.fullmatch(left.name):  # an equation of motion has the letter itself
            return all(_DOTTED.sub(r"\1", name) != dotted[1] for name in letters_of(right))
        return len(self._cited) > 1 and any(each.name in self._cited for each in self.given.known.get(left, ()))

    def _are_sure(self, used: list[PrintedMeaning], printed: PrintedStatement) -> bool:
        """Return whether premises are cited, or all that the section gives, and no word tells of another case."""
        each = self.readings[self.place][0]
        named = {premise.name for premise in used}
        return not (self._says(ASSUMPTION) or self._says(CONDITION, named)) and all(
            premise.name in self._cited
            or (premise.section == each.section and self.given.is_given_once(premise, printed))
            for premise in used
        )

    @property
    def _cited(self) -> set[str]:
        """The equations that the text before the one in place names."""
        labels = self.readings[self.place][0].cites
        return {f"({equation.id})" for label in labels for equation in self.labelled[label]}

    def _says(self, what: re.Pattern[str], premises: Iterable[str] = ()) -> str:
        """Return the words of a kind beside the equation in place."""
        return said_of(self.source.words.get(self.readings[self.place][0].id, ""), what, [*premises])

    def _related(self, letters: set[str], premises: Iterable[PrintedMeaning] = ()) -> bool:
        """Return whether an equation of these letters only stands in the text or before, so that two members may agree."""
        stems = {letter.split("_")[0] for letter in letters}
        known = [each.statement for each in premises]
        for latex, reading in self._before(self.place):
            if not reading.whole and (names := letters_printed(latex)) and names <= stems:
                return True
            if any(s not in known and self._explains(s, letters) for s in reading.statements):
                return True
        return False

    def _explains(self, statement: PrintedStatement, letters: set[str]) -> bool:
        """Return whether a statement relates no other letters than these: no bound, and no identity."""
        nodes = [side.node for side in statement.sides]
        if not {name for node in nodes for name in letters_of(node)} <= letters or {*statement.relations} <= _BOUNDS:
            return False
        pairs = pairwise(map(self._value, nodes))
        return statement.kind != "equation" or not all(None not in pair and agree(*pair) for pair in pairs)

    def _speaks_of(self, difference: Any) -> bool:
        """Return whether the text or an equation before has a letter of a difference."""
        stems = {symbol.name.split("_")[0] for symbol in difference.free_symbols}
        start = self.place
        while start and self.readings[start][0].lead:  # the first row of the chain
            start -= 1
        return any(stems & letters_printed(latex) for latex, _ in self._before(start))

    def _before(self, place: int) -> Iterator[tuple[str, Reading]]:
        """Yield the displays before a place, and the relations of the text."""
        yield from ((each.latex, reading) for each, reading in self.readings[:place])
        yield from self._text

    def _order(self, left: Node, right: Node, order: tuple[str, int]) -> _VERDICT:
        """Return the verdict on a step that is claimed through an order of a small letter."""
        name, power = order
        small = sp.Symbol(name, real=True)
        try:
            a, b = sympy_expression(left, self.opaque), sympy_expression(right, self.opaque)
            if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or small not in a.free_symbols:
                return NOT_JUDGED, LETTERS
            rates = re.compile(rf"{re.escape(name)}_d+ot")  # the rates of a small quantity are as small
            scaled = {s: small * s for s in a.free_symbols | b.free_symbols if rates.fullmatch(s.name)}
            term = counted(agreement_order, a.xreplace(scaled), b.xreplace(scaled), small, power - 1)
        except WorkError:
            raise
        except (LagrotorError, TypeError, ValueError, ArithmeticError, AttributeError):
            return NOT_JUDGED, OUTSIDE
        if term.order is None:
            return HOLDS, f"through order {power - 1} in {name}"
        if has_opaque(a, b):
            return NOT_JUDGED, FUNCTIONS
        return REFUTED, f"the members differ at order {term.order} in {name}; O({name}**{power}) is claimed"

    # ---- the text

    @cached_property
    def _text(self) -> list[tuple[str, Reading]]:
        """The relations of the text, with their readings."""
        formulas = (latex for latex in self.source.inline if _RELATION.search(latex))
        return [(latex, read_formula(latex, self.notation)) for latex in formulas]

    def _compared_with_zero(self, *relations: str) -> frozenset[str]:
        """Return the letters that the text compares with zero by one of these relations."""
        statements = [s for _, reading in self._text for s in reading.statements if s.sides[-1].node == number(0)]
        nodes = (s.sides[0].node for s in statements if {*s.relations[:1]} & {*relations})
        return frozenset(node.name for node in nodes if isinstance(node, Letter))

    @cached_property
    def _positive(self) -> frozenset[str]:
        """The letters that the author declares, or the text says, to be positive."""
        return self.notation.positive | self._compared_with_zero(">")

    def _take_text(self, section: str) -> None:
        """Take over the equations in the text of a section, at its first display."""
        for latex, reading in self._text if section not in self.sections_read else ():
            for statement in reading.statements if self.source.inline[latex] == section else ():
                if letters_of(statement.sides[-1].node):  # x = 0 is a result, and no premise
                    self.given.add(statement, f"${latex}$", section, -1)
        self.sections_read.add(section)

    def _values(self) -> Iterator[tuple[str, list[Node]]]:
        """Yield sections and sides of equations in the text, which may give a unit: m = 2 kg."""
        for latex, reading in self._text:
            for each in reading.statements if re.search(r"\\(?:mathrm|rm|text|hbar)\b|k_", latex) else ():
                if each.kind == "equation":
                    yield self.source.inline[latex], [side.node for side in each.sides]

    def _other_meanings(self) -> Iterator[tuple[Displayed, str]]:
        """Yield equations that define a letter with := or ≡ otherwise than one before."""
        definitions: dict[str, tuple[Displayed, PrintedStatement]] = {}
        for each, statement in self.statements:
            letter = statement.sides[0].node
            if isinstance(letter, Letter) and ":=" in statement.relations[:1]:
                first, other = definitions.setdefault(letter.name, (each, statement))
                if statement is not other and bounded(self._differ, other, statement) is True:
                    yield each, f"{letter.name} is defined in ({first.id}) otherwise"

    def _differ(self, one: PrintedStatement, other: PrintedStatement) -> bool:
        """Return whether two definitions differ, as they are and with those before put in."""
        left, right = one.sides[1].node, other.sides[1].node
        a, b = self._value(left), self._value(right)
        ways = [(a, b), *((way.left, way.right) for way in self._ways(left, right, a, b, other))]
        return all(None not in pair and decided(*pair) == "nonzero" for pair in ways)


def _open_indices(statement: PrintedStatement) -> Iterator[str]:
    """Sentences on indices that stand outside their sum on one side, and on another side do not.

    An index is the letter itself, or a subscript of a letter that also stands inside the sum: E_k = Σ_k v_k has a label.
    Products and integrals over the same letter bind it as well.
    """
    sums = [n for side in statement.sides for n in _calls(side.node) if n.name == "Sum"]
    for index in dict.fromkeys(n.args[1].name for n in sums if isinstance(n.args[1], Letter)):
        inside = {name for n in sums if n.args[1] == Letter(index) for name in letters_of(n.args[0])}
        names = {name for name in inside if index in name.split("_")[1:]} | {index}
        outside = [names & set(letters_of(_without_bound(side.node, index))) for side in statement.sides]
        if not all(outside) and (side := next((s for s, n in zip(statement.sides, outside, strict=True) if n), None)):
            yield f"{index} stands outside the sum over it in {text_of(side.node)}"


def _calls(node: Node) -> Iterator[Call]:
    return (each for each in walk(node) if isinstance(each, Call))


def _without_bound(node: Node, index: str) -> Node:
    """Return a node with zero for its sums, products and integrals over an index."""
    calls = (each for each in _calls(node) if each.name in BINDING)
    return put_for(node, {each: number(0) for each in calls if any(index in letters_of(e) for e in each.args[1:])})


def _difference(a: Any, b: Any) -> str:
    return "a vector" if isinstance(a, sp.MatrixBase) else sp.sstr(counted(sp.factor_terms, counted(sp.expand, a - b)))


def _comparable(a: Any, b: Any) -> bool:
    """Return whether both members have the same derivatives, integrals and unknown functions, and are vectors or not."""
    return _hidden(a) == _hidden(b) and isinstance(a, sp.MatrixBase) == isinstance(b, sp.MatrixBase)


def _hidden(side: Any) -> set[sp.Symbol]:
    """Return the symbols for derivatives, integrals and unknown functions of a side."""
    return {symbol for symbol in side.free_symbols if has_opaque(symbol)}


def _but_for_dots(others: set[str], letters: set[str]) -> bool:
    """Return whether the new letters are those of the other member, but for dots: a rate is another quantity."""
    return {_DOTTED.sub(r"\1", name) for name in others - letters} <= {_DOTTED.sub(r"\1", name) for name in letters}
