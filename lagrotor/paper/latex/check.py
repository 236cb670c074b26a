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
from itertools import chain, pairwise
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
from lagrotor.paper.latex.substitution import WANTED, PrintedMeaning, SectionMeanings, put_rounds, rounds
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
ALL_REAL = Notation()
_VERDICTS = tuple[str, str, list[PrintedMeaning]]
_RELATION = re.compile(r"=|[<>]|\\(?:equiv|approx|simeq|sim|to|ll|gg|rightarrow|propto|cong|leq?|geq?)\b")
_DOTTED = re.compile(r"(\w+?)_(d*)ot")
_BINDING = ("Sum", "Product", "Integral", "limit", "at")
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
    """Two members with premises put in round by round; `value` evaluates any node in the same way."""

    left: Any
    right: Any
    put: list[dict[Node, PrintedMeaning]]
    value: Callable[[Node], Any]
    opaque: Opaque

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

    @property
    def takes_a_sign(self) -> bool:
        """Whether a sign was taken that is not printed: of a root, of letters."""
        return self.opaque.assuming or any(each.is_a_root for each in self.used)

    def takes_root_of(self, letters: frozenset[str]) -> bool:
        """Return whether the positive root was taken for one of these letters, whose square is given."""
        return any(
            each.is_a_root and isinstance(each.meaning, Letter) and each.meaning.name in letters for each in self.used
        )

    def differs(self, a: Any, b: Any) -> bool:
        """Return whether the premises change two members, which can then be compared."""
        known = self.left is not None and self.right is not None and (self.left, self.right) != (a, b)
        return known and not is_large(self.left, self.right)


class _Checker:
    def __init__(self, source: Source, readings: list[tuple[Displayed, Reading]], notation: Notation) -> None:
        self.source, self.readings, self.notation = source, readings, notation
        self.opaque = Opaque()
        self.given, self.sections_read = SectionMeanings(), set[str]()
        self.labelled: defaultdict[str, list[Displayed]] = defaultdict(list)
        self.place = 0
        self.statements = [(each, s) for each, reading in readings for s in reading.statements]
        self.rates = rates_of(side.node for _, statement in self.statements for side in statement.sides)

    def findings(self, progress: Callable[[str], None] | None = None) -> Iterator[StepFinding]:
        """Every finding."""
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
        """The steps of a chain but the first, unless that may be an identity; printed: without the row before."""
        sides, order = statement.sides, statement.order
        order_before = None if statement is printed else self.readings[self.place - 1][1].statements[-1].order
        for step in range(1 if statement is printed else 2, len(sides)):
            left, right, relation = sides[step - 1], sides[step], statement.relations[step - 1]
            claimed = order if step == len(sides) - 1 and step > 1 else None
            claimed = claimed or (order_before if step == 2 else None)
            if claimed:
                verdict = bounded(self._order, left.node, right.node, claimed, too_large=(NOT_JUDGED, TOO_LARGE, []))
            elif relation not in ("=", ":=") or (step == 1 and not self._is_judged_alone(left.node, right.node)):
                continue
            else:
                verdict = bounded(
                    self._step, left.node, right.node, printed, step == 1, too_large=(NOT_JUDGED, TOO_LARGE, [])
                )
            if step > 1 or verdict[0] != NOT_JUDGED:
                yield self._finding(each, step, (left, right), verdict[0], verdict[1])

    def _continued(self, each: Displayed, statement: PrintedStatement) -> PrintedStatement:
        """Return a row that continues the one before, with the last side of that row in its place."""
        before = self.readings[self.place - 1][1] if each.lead and self.place else None
        if before is None or not before.whole or before.statements[-1].kind != "equation":
            return statement
        last = replace(before.statements[-1].sides[-1], at=0)
        first = replace(statement.sides[0], at=0)
        shifted = [replace(side, at=max(side.at - len(each.lead) - 1, 0)) for side in statement.sides[1:]]
        return replace(statement, sides=(first, last, *shifted), relations=("=", *statement.relations))

    def _is_judged_alone(self, left: Node, right: Node) -> bool:
        """Return whether the first step of a chain may follow from its letters or from the equations that it cites."""
        of_functions = any(isinstance(each, Call) and each.name in KNOWN for each in walk(left))
        if len(self._cited) > 1 and any(each.name in self._cited for each in self.given.known.get(left, ())):
            return True
        dotted = _DOTTED.fullmatch(left.name) if isinstance(left, Letter) else None
        if dotted and any(_DOTTED.sub(r"\1", name) == dotted[1] for name in letters_of(right)):
            return False  # an equation of motion
        speaks = bool(letters_of(right)) or (of_functions and isinstance(right, Number) and right.value != 0)
        return (bool(dotted) or isinstance(left, Call)) and not isinstance(right, Letter) and speaks

    def _step(self, left: Node, right: Node, printed: PrintedStatement, first: bool) -> _VERDICTS:
        """Return the verdict on a step, the reason, and the premises that were put in."""
        self.opaque.assuming = False
        a, b = self._value(left), self._value(right)
        assuming = self.opaque.assuming
        if a is None or b is None:
            return NOT_JUDGED, UNCOMPARABLE, []
        if a != b and is_large(a, b):
            return NOT_JUDGED, TOO_LARGE, []
        answer = decided(a, b) if may_agree(a, b) else "nonzero"
        if answer == "zero":
            return HOLDS, "an identity where its roots are real" if radicands(a, b) else "an identity", []
        ways = [way for way in self._ways(left, right, printed) if way.differs(a, b)]
        if answer == "undecided" and agree_for_positive(a, b):
            return HOLDS, "for positive letters", []
        for agreeing, condition in ((agree, ""), (agree_for_positive, ", positive letters")):
            for way in ways:
                if agreeing(way.left, way.right) and not way.takes_root_of(self._negative):
                    return HOLDS, f"with {way.name}{condition}", way.used
        if answer == "undecided":
            return NOT_JUDGED, OUTSIDE, []
        reason, why = self._refuted(left, right, a, b, first, bool(ways))
        if not reason and not assuming and decided(a, b) == "nonzero":
            return REFUTED, why, []
        for way in ways if not first or self._follows(left, printed) else ():
            slip = self._slip_with(left, right, way) if self._are_sure(way.used, printed) else ""
            if slip and not ("sign" in slip and way.takes_a_sign):
                return REFUTED, f"with {way.name} the two members differ; {slip}", way.used
        return NOT_JUDGED, reason or OUTSIDE, []

    def _refuted(self, left: Node, right: Node, a: Any, b: Any, first: bool, premises: bool) -> tuple[str, str]:
        """Return the reason for which a difference that is not zero refutes nothing, or "" and how the members differ.

        Without a slip that explains it, a difference refutes only where nothing before speaks of its letters.
        """
        letters, others = set(letters_of(left)), set(letters_of(right))
        if not _comparable(a, b) or (has_opaque(a, b) and (first or not others)):
            return FUNCTIONS, ""
        if others - letters and not (isinstance(a, sp.Add) and _but_for_dots(others, letters)):
            return LETTERS, ""
        if self._says(ASSUMPTION) or self._says(CONDITION):
            return WORDS, ""
        if first and not (a.has(sp.Function) and b.has(sp.Function) and self._says(IDENTITY)):
            return MAYBE, ""
        differ = f"the members differ by {_difference(a, b)}"
        if not others and letters:
            if (value := constant_value(a)) is not None:
                return "", f"the left member is {value} for all values of its letters"
            slip = change_to_agree(b, left, letters, self._value) if a.has(sp.Function) else None
            return ("", f"{differ}; {slip}") if slip and "sign" in slip else (MAYBE, "")
        if self._related(letters, a, b):
            return BEFORE, ""
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
        return change_to_agree(a, right, names, self._value, first) or change_to_agree(
            b, left, names, self._value, first
        )

    def _slip_with(self, left: Node, right: Node, way: _Way) -> str | None:
        """Return the one change of the right member with which it is the left one, the premises put in."""
        letters, others = (set(letters_of(put_rounds(side, way.put))) for side in (left, right))
        if None in (way.left, way.right) or not others or not _comparable(way.left, way.right):
            return None
        if not _but_for_dots(others, letters) or self._related(letters | others, way.left, way.right):
            return None
        return change_to_agree(way.left, right, letters | set(letters_of(right)), way.value)

    def _value(self, node: Node) -> Any:
        return expression_of(node, self.opaque)

    def _ways(self, left: Node, right: Node, printed: PrintedStatement) -> Iterator[_Way]:
        """The two members with derivatives taken and premises put in: for letters of the one, of the other, of both."""
        section = self.readings[self.place][0].section

        def premises(parts: Iterable[Node]) -> Iterator[PrintedMeaning]:
            return self.given.of(parts, self.place, section, printed)

        tried: list[list[dict[Node, PrintedMeaning]]] = []
        for wanted in WANTED:
            put = rounds(left, right, premises, wanted)
            if put in tried:
                continue
            tried.append(put)
            opaque = Opaque(self.opaque.names, self.rates, positive=self._positive)

            def value(node: Node, put: list[dict[Node, PrintedMeaning]] = put, opaque: Opaque = opaque) -> Any:
                return expression_of(put_rounds(node, put), opaque)

            sides = value(left), value(right)
            yield _Way(*sides, put, value, opaque)

    def _follows(self, left: Node, printed: PrintedStatement) -> bool:
        """Return whether the left member of a first step is worked out from what is given, so that it is no condition."""
        derived = isinstance(left, Call) and left.name in ("Derivative", "Integral", "at_constant", "rate")
        cited = len(self._cited) > 1 and isinstance(left, Letter)
        moving = isinstance(left, Letter) and bool(_DOTTED.fullmatch(left.name))
        return derived or cited or moving or self.given.is_called(left, printed)

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

    def _related(self, letters: set[str], a: Any, b: Any) -> bool:
        """Return whether the text or an equation before speaks of these letters only, so that two members may agree."""
        for _, latex, reading in chain(((each, each.latex, r) for each, r in self.readings[: self.place]), self._text):
            if not reading.whole:
                named = {name.split("_")[0] for name in letters_printed(latex)}
                if named and named <= {letter.split("_")[0] for letter in letters}:
                    return True
            elif any(
                letters_of_statement(s) <= letters and {*s.relations} - _BOUNDS and self._may_explain(s, a, b)
                for s in reading.statements
            ):
                return True
        return False

    def _speaks_of(self, difference: Any) -> bool:
        """Return whether the text or an equation before has a letter of a difference."""
        stems = {symbol.name.split("_")[0] for symbol in difference.free_symbols}
        start = self.place
        while start and self.readings[start][0].lead:  # the first row of the chain
            start -= 1
        formulas = chain((each.latex for each, _ in self.readings[:start]), (latex for _, latex, _ in self._text))
        return any(stems & {name.split("_")[0] for name in letters_printed(latex)} for latex in formulas)

    def _may_explain(self, statement: PrintedStatement, a: Any, b: Any) -> bool:
        """Return whether two members agree, or may agree, where a statement holds; it is solved for each letter in turn."""
        sides = [self._value(side.node) for side in statement.sides]
        if None in sides or statement.kind != "equation" or any(isinstance(e, sp.MatrixBase) for e in (*sides, a, b)):
            return True
        for left, right in pairwise(sides):
            if agree(left, right) or not _hidden(left) | _hidden(right) <= _hidden(a) | _hidden(b):
                continue  # an identity, or a function that neither member has
            shared = sorted((left - right).free_symbols & (a - b).free_symbols, key=str)
            slopes = {
                s: slope for s in shared if s not in (slope := (left - right).diff(s)).free_symbols and slope != 0
            }
            if shared and not slopes:
                return True
            for s, slope in slopes.items():
                one, other = (e.subs(s, s - (left - right) / slope) for e in (a, b))
                if agree(one, other) and not agree(one, sp.S.Zero):
                    return True
        return False

    def _order(self, left: Node, right: Node, order: tuple[str, int]) -> _VERDICTS:
        """Return the verdict on a step that is claimed through an order of a small letter."""
        name, power = order
        small = sp.Symbol(name, real=True)
        try:
            a, b = sympy_expression(left, self.opaque), sympy_expression(right, self.opaque)
            if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or small not in a.free_symbols:
                return NOT_JUDGED, LETTERS, []
            rates = re.compile(rf"{re.escape(name)}_d+ot")  # the rates of a small quantity are as small
            scaled = {s: small * s for s in a.free_symbols | b.free_symbols if rates.fullmatch(s.name)}
            term = counted(agreement_order, a.xreplace(scaled), b.xreplace(scaled), small, power - 1)
        except WorkError:
            raise
        except (LagrotorError, TypeError, ValueError, ArithmeticError, AttributeError):
            return NOT_JUDGED, OUTSIDE, []
        if term.order is None:
            return HOLDS, f"through order {power - 1} in {name}", []
        if has_opaque(a, b):
            return NOT_JUDGED, FUNCTIONS, []
        return REFUTED, f"the members differ at order {term.order} in {name}; O({name}**{power}) is claimed", []

    # ---- the text

    @cached_property
    def _text(self) -> list[tuple[str, str, Reading]]:
        """The relations of the text: name, LaTeX, reading."""
        return [
            (f"${latex}$", latex, read_formula(latex, self.notation))
            for latex in self.source.inline
            if _RELATION.search(latex)
        ]

    def _compared_with_zero(self, relations: tuple[str, ...]) -> frozenset[str]:
        """The letters that the text compares with zero by one of these relations."""
        statements = (s for _, _, reading in self._text for s in reading.statements)
        return frozenset(
            s.sides[0].node.name
            for s in statements
            if isinstance(s.sides[0].node, Letter)
            and {*s.relations[:1]} & {*relations}
            and s.sides[-1].node == number(0)
        )

    @cached_property
    def _positive(self) -> frozenset[str]:
        """The letters that the author declares, or the text says, to be positive."""
        return self.notation.positive | self._compared_with_zero((">",))

    @cached_property
    def _negative(self) -> frozenset[str]:
        """The letters that the text says to be negative."""
        return self._compared_with_zero(("<", "<="))

    def _take_text(self, section: str) -> None:
        """Take over the equations in the text of a section, at its first display."""
        for name, latex, reading in self._text if section not in self.sections_read else ():
            if self.source.inline[latex] == section:
                for statement in reading.statements:
                    if letters_of(statement.sides[-1].node):  # x = 0 is a result, and no premise
                        self.given.add(statement, name, section, -1)
        self.sections_read.add(section)

    def _values(self) -> Iterator[tuple[str, list[Node]]]:
        """Sections and sides of equations in the text, which may give a unit: m = 2 kg."""
        for _, latex, reading in self._text:
            for each in reading.statements:
                if each.kind == "equation" and re.search(r"\\(?:mathrm|rm|text|hbar)\b|k_", latex):
                    yield self.source.inline[latex], [side.node for side in each.sides]

    def _other_meanings(self) -> Iterator[tuple[Displayed, str]]:
        """Equations that define a letter with := or ≡ otherwise than one before."""
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
        ways = ((way.left, way.right) for way in self._ways(left, right, other))
        pairs = chain([(self._value(left), self._value(right))], ways)
        return all(None not in pair and decided(*pair) == "nonzero" for pair in pairs)


def _open_indices(statement: PrintedStatement) -> Iterator[str]:
    """Sentences on indices that stand outside their sum on one side, and on another side do not.

    An index is the letter itself, or a subscript of a letter that also stands inside the sum: E_k = Σ_k v_k has a label.
    Products and integrals over the same letter bind it as well.
    """
    sums = [n for side in statement.sides for n in walk(side.node) if isinstance(n, Call) and n.name == "Sum"]
    for index in dict.fromkeys(n.args[1].name for n in sums if isinstance(n.args[1], Letter)):
        inside = {name for n in sums if n.args[1] == Letter(index) for name in letters_of(n.args[0])}
        names = {name for name in inside if index in name.split("_")[1:]} | {index}
        outside = [names & set(_outside(side.node, index)) for side in statement.sides]
        if not all(outside) and (side := next((s for s, n in zip(statement.sides, outside, strict=True) if n), None)):
            yield f"{index} stands outside the sum over it in {text_of(side.node)}"


def _outside(node: Node, index: str) -> Iterator[str]:
    """The letters of a node that stand outside its sums over an index."""
    if isinstance(node, Letter):
        yield node.name
    elif isinstance(node, Call) and not (node.name in _BINDING and any(index in letters_of(e) for e in node.args[1:])):
        for part in node.args:
            yield from _outside(part, index)


def letters_of_statement(statement: PrintedStatement) -> set[str]:
    """Return the letters of all sides."""
    return {name for side in statement.sides for name in letters_of(side.node)}


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
