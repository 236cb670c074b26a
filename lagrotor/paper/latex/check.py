r"""What can be judged of a source without any derivation: chains step by step, equations against those they cite, dimensions,
orders, letters.

No reading is confirmed here: what agrees "would hold", what differs "would be refuted". A step of a chain may rest on physics
that is in the text; it is refuted only where its right side has no letter but those of the left, with the definitions that its
section gives put in and derivatives taken; where no equation before can make the two sides agree, the difference is decided, and
one change of sign, factor or power makes them agree: a slip, not a law.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from functools import cached_property, partial
from itertools import chain, pairwise
from typing import Any

import sympy as sp

from lagrotor.algebra import agreement_order
from lagrotor.errors import LagrotorError, WorkError
from lagrotor.paper.latex.compared import (
    LARGE,
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
from lagrotor.paper.latex.consistency import (
    BEFORE,
    MEANINGS,
    UNITS,
    VALUED,
    ReadStatement,
    other_dimensions,
    other_letters,
    statement_letters,
    two_meanings_of_e,
)
from lagrotor.paper.latex.displays import Displayed, Source
from lagrotor.paper.latex.formula import Reading, read_formula, with_progress
from lagrotor.paper.latex.settled import (
    ANY_BASE,
    is_of_argument,
    is_of_numbers,
    is_of_operators,
    is_settled,
    may_not_commute,
    other_readings,
)
from lagrotor.paper.latex.slips import change_to_agree, constant_value, functions_of
from lagrotor.paper.latex.statements import PrintedStatement, Side
from lagrotor.paper.latex.substitution import WANTED, PrintedMeaning, SectionMeanings, put_for, rounds
from lagrotor.paper.latex.tree import (
    KNOWN,
    Call,
    Letter,
    Node,
    Number,
    Opaque,
    has_opaque,
    letters_of,
    number,
    sympy_expression,
    text_of,
    walk,
)
from lagrotor.paper.latex.usage import Notation, letters_printed, notation_of
from lagrotor.paper.latex.words_beside import (
    AGAIN,
    CASES,
    CONDITIONS,
    IDENTITY,
    NEGATIVE,
    OPENING,
    TO_BE_SOLVED,
    said_of,
)

HOLDS, REFUTED, NO_IDENTITY, FAULT = "would hold", "would be refuted", "no identity", "no LaTeX"
FOUND = (REFUTED, NO_IDENTITY, UNITS, MEANINGS, BEFORE, FAULT)
WRONG = (REFUTED, UNITS, FAULT)
# Where a reading stops at what a package may define.
_UNKNOWN = re.compile(r"(\\(?:[A-Za-z@]+|begin\{[^{}]*\})) is not known")
# What the text may say of letters; relations that make nothing of one letter out of another.
_RELATION = re.compile(r"=|>|\\(?:equiv|approx|simeq|sim|to|ll|gg|rightarrow|propto|cong)\b")
_DOTTED = re.compile(r"(\w+?)_(d*)ot")
_BOUNDS = frozenset(("<", ">", "<=", ">=", "!="))


@dataclass(frozen=True)
class StepFinding:
    """What was found of one equation: `step` counts the relations of its chain from 1; 0: of the whole.

    equation: empty where LaTeX itself would stop at the line.
    """

    equation: str
    step: int
    line: int
    verdict: str
    why: str
    file: str = ""

    def as_data(self) -> dict[str, Any]:
        """{equation, step, line, verdict, why}; the file, from the folder of the source, where it is not the source itself."""
        row = asdict(self)
        return row if self.file else {key: value for key, value in row.items() if key != "file"}


def check_source(
    source: Source, said: Notation | None = None, progress: Callable[[str], None] | None = None
) -> list[StepFinding]:
    """The findings on the displayed equations of a source; said: its [notation].

    progress: called with what is done next, before each `EVERY` displays are read, and before they are checked.
    """
    notation = notation_of([*(each.latex for each in source.equations), *source.inline], said)
    readings = [
        (each, read_formula(each.latex, notation, each.lead))
        for each in with_progress("read", source.equations, progress)
    ]
    checker = _Checker(source, readings, notation)
    order = {each.id: place for place, each in enumerate(source.equations)}
    faults = [
        StepFinding("", 0, n, FAULT, said, file if file != source.file else "") for file, n, said in source.faults
    ]
    return faults + sorted(checker.findings(progress), key=lambda found: (order[found.equation], found.step))


@dataclass(frozen=True)
class _Way:
    """Two sides with premises put in round by round, None where there is no expression; value: of any side, in the same way.

    opaque: whether letters were held fixed in derivatives, or taken as positive.
    """

    left: Any
    right: Any
    put: list[dict[Node, PrintedMeaning]]
    value: Callable[[Node], Any]
    opaque: Opaque

    @property
    def used(self) -> list[PrintedMeaning]:
        return [each for one in self.put for each in one.values()]

    @property
    def named(self) -> str:
        names = dict.fromkeys(each.name for each in self.used)
        fixing = ["the other letters fixed in derivatives and integrals"] if self.opaque.fixing else []
        return (
            ", ".join([*names, *fixing, *(["positive letters"] if self.opaque.assuming else [])]) or "derivatives taken"
        )

    @property
    def roots(self) -> set[str]:
        """The letters of which a square is given, and the positive root was taken."""
        return {each.meaning.name for each in self.used if each.is_a_root and isinstance(each.meaning, Letter)}

    @property
    def has_signs(self) -> bool:
        """Whether no sign was taken that is not printed: of a root, of letters."""
        return not self.opaque.assuming and not any(each.is_a_root for each in self.used)

    def differs(self, a: Any, b: Any) -> bool:
        """Whether anything was put in or taken, and it can be compared."""
        known = self.left is not None and self.right is not None and (self.left, self.right) != (a, b)
        return known and not is_large(self.left, self.right)


class _Checker:
    def __init__(self, source: Source, readings: list[tuple[Displayed, Reading]], notation: Notation) -> None:
        self.source, self.readings, self.notation = source, readings, notation
        self.opaque = Opaque()
        self.given, self.told = SectionMeanings(), set[str]()  # the sections whose text was taken over
        self.labelled: defaultdict[str, list[Displayed]] = defaultdict(list)  # those before, by label
        self.place = 0
        self.statements = [
            ReadStatement(each, s) for each, reading in readings if not _guess(reading) for s in reading.statements
        ]
        self.rates = _rates(s for _, reading in readings for s in reading.statements)

    def findings(self, progress: Callable[[str], None] | None = None) -> Iterator[StepFinding]:
        """Every finding."""
        for place, (each, reading) in enumerate(with_progress("check", self.readings, progress)):
            self.place = place
            if not reading.whole:
                what, helps = reading.stop or ("", "")
                if (name := _UNKNOWN.fullmatch(what)) and (missing := self.source.missing):
                    files = " and ".join(f"{file}, loaded in line {line}," for file, line in missing.items())
                    verb = "is" if len(missing) == 1 else "are"
                    helps = f"{files} {verb} not beside the source: {name[1]} may be defined there"
                yield self._finding(each, 0, None, "not read", f"{what}: {helps}")
                continue
            self._take_text(each.section)
            for statement in reading.statements:
                self.given.add(statement, f"({each.id})", each.section, place)
            for nth, statement in enumerate(reading.statements):
                yield from self._steps(each, statement, statement if nth else self._continued(each, statement))
            self.labelled[each.label].append(each)
        for each, why in other_dimensions(self.statements, self._values(), self.source.words):
            yield self._finding(each, 0, None, UNITS, why)
        equations = [each for each, _ in self.readings]
        letters = other_letters(self.statements, lambda one, other: bounded(self._differ, one, other) is True)
        for each, which, why in chain(letters, two_meanings_of_e(equations, self.notation)):
            yield self._finding(each, 0, None, which, why)

    def _finding(self, each: Displayed, step: int, side: Side | None, verdict: str, why: str) -> StepFinding:
        line = each.place[1]
        if side is not None and len(each.rows) > 1:
            line = each.rows[min(each.latex[: side.at].count(r"\\"), len(each.rows) - 1)]
        own = each.place[0]
        return StepFinding(each.id, step, line, verdict, why, own if own != self.source.file else "")

    # ---- chains

    def _steps(self, each: Displayed, printed: PrintedStatement, statement: PrintedStatement) -> Iterator[StepFinding]:
        """Each step of a chain but the first, which says what is meant; printed: without what it continues."""
        sides = statement.sides
        for step in range(1 if statement is printed else 2, len(sides)):
            left, right, relation = sides[step - 1], sides[step], statement.relations[step - 1]
            last = step == len(sides) - 1
            of_order = statement.order is not None and last and step > 1
            if not of_order and (
                relation not in ("=", ":=") or (step == 1 and not self._identity(left.node, right.node))
            ):
                continue
            if of_order:
                verdict, why, *used = bounded(self._order, left.node, right.node, statement.order)
            else:
                verdict, why, *used = bounded(self._step, left.node, right.node, printed, step == 1, last)
            if verdict in (HOLDS, REFUTED) and (guess := self._open(verdict, left, right, used, printed)):
                verdict, why = "undecided", f"{why}; but it is a guess that {guess}"
            if step > 1 or verdict in (HOLDS, REFUTED, NO_IDENTITY):
                yield self._finding(each, step, right, verdict, why)

    def _open(
        self, verdict: str, left: Side, right: Side, used: list[PrintedMeaning], printed: PrintedStatement
    ) -> str:
        """The guess that a verdict on two sides, with premises, rests on, each read by itself; nothing where none does."""
        whole = self.readings[self.place][1]
        if not _guess(whole) and not used:
            return ""
        alone = read_formula(f"{left.latex} = {right.latex}", self.notation)
        same = alone.whole and [side.node for side in alone.statements[0].sides] == [left.node, right.node]
        own = (alone if same else whole).guesses
        guesses = (*own, *(each for one in used for each in read_formula(one.latex, self.notation).guesses))
        nodes = (left.node, right.node, *(each.value for each in used))
        for each in guesses:
            if is_of_argument(each) and each not in own:
                return each
            others = other_readings(each, left.node, right.node) if verdict == REFUTED and each in own else ()
            if any(bounded(self._step, *other, printed, False, False)[0] == HOLDS for other in others):
                return each
            if not (
                is_settled(each, nodes, [one.meaning for one in used]) or (is_of_operators(each) and self._of_numbers)
            ):
                return each
        return ""

    def _continued(self, each: Displayed, statement: PrintedStatement) -> PrintedStatement:
        """A row that continues the one before, with the last side of that row in its place."""
        before = self.readings[self.place - 1][1] if each.lead and self.place else None
        if (
            before is None
            or not before.whole
            or before.statements[-1].kind != "equation"
            or before.statements[-1].order
        ):
            return statement
        last = replace(before.statements[-1].sides[-1], at=0)
        first = replace(statement.sides[0], at=0)
        shifted = [replace(side, at=max(side.at - len(each.lead) - 1, 0)) for side in statement.sides[1:]]
        return replace(statement, sides=(first, last, *shifted), relations=("=", *statement.relations))

    def _identity(self, left: Node, right: Node) -> bool:
        """Whether the first step may be an identity: no letter stands alone, a number beside functions alone."""
        of_functions = any(isinstance(each, Call) and each.name in KNOWN for each in walk(left))
        beside = bool(letters_of(right)) or (of_functions and isinstance(right, Number) and right.value != 0)
        if len(self._cited) > 1 and any(each.name in self._cited for each in self.given.known.get(left, ())):
            return True  # it is what follows from the equations that the text before it names
        if self._is_stated_again(left):
            return True
        dotted = _DOTTED.fullmatch(left.name) if isinstance(left, Letter) else None
        if dotted and any(_DOTTED.sub(r"\1", name) == dotted[1] for name in letters_of(right)):
            return False  # an equation of motion
        return (bool(dotted) or isinstance(left, Call)) and not isinstance(right, Letter) and beside

    def _step(self, left: Node, right: Node, printed: PrintedStatement, first: bool, last: bool) -> tuple[Any, ...]:
        """The verdict on a step, why, and each premise that was put in; first and last: of its chain."""
        self.opaque.assuming = False
        a, b = self._value(left), self._value(right)
        assuming = self.opaque.assuming
        if a is None or b is None:
            return "undecided", "the two sides cannot be compared"
        if a != b and is_large(a, b):
            return LARGE
        answer = decided(a, b) if may_agree(a, b) else "nonzero"
        tried = self._ways(left, right, printed) if answer != "zero" else ()
        ways = [way for way in tried if way.differs(a, b) and not way.roots & self.negative]
        if held := self._holding(left, right, a, b, answer, ways):
            return HOLDS, *held
        if answer == "undecided":
            return "undecided", "the difference is outside what is decided exactly"
        verdict, why = self._refuted(left, right, a, b, first)
        again = first and self._is_stated_again(left)
        if verdict != REFUTED and (not first or self._is_taken(left, printed, last)):
            for way in ways:
                if again and all(each.meaning == left for each in way.used):
                    continue  # with nothing else put in, it is of something else
                if self._are_sure(way.used, printed) and (slip := self._slip_with(left, right, way)):
                    if "sign" in slip and not way.has_signs:
                        continue
                    return REFUTED, f"with {way.named} the two sides differ; {slip}", *way.used
        if verdict == REFUTED and (
            (assuming and "sign" in why) or may_not_commute((left, right)) or decided(a, b) != "nonzero"
        ):
            return "undecided", "the difference is outside what is decided exactly"
        return verdict, why

    def _holding(self, left: Node, right: Node, a: Any, b: Any, answer: str, ways: list[_Way]) -> tuple[Any, ...]:
        """Why two sides agree, and each premise that was put in; nothing where they are not known to: answer is that of a = b."""
        said = f"{text_of(left)} = {text_of(right)} is an identity"
        if answer == "zero":
            return (f"{said} where its roots are real" if radicands(a, b) else said,)
        positive = partial(agree_for_positive, negative=self.negative)
        for agreeing, condition in ((agree, ""), (positive, "positive letters")):
            if condition and answer == "undecided" and agreeing(a, b):
                return (f"{said} for {condition}",)
            for way in ways:
                if agreeing(way.left, way.right):
                    return f"with {', '.join(filter(None, (way.named, condition)))}", *way.used
        return ()

    def _is_stated_again(self, left: Node) -> bool:
        """Whether a letter has a value before, and the text says that others are put into it."""
        known = isinstance(left, Letter) and not _DOTTED.fullmatch(left.name) and left in self.given.known
        return known and bool(self._says(AGAIN, {name for name, *_ in self._said}))

    def _is_taken(self, left: Node, printed: PrintedStatement, last: bool) -> bool:
        """Whether a side is worked out from what is given, so that its first equation is no condition: V′ of V′ = … = 0."""
        called = self.given.is_called(left, printed)
        if called or (isinstance(left, Call) and left.name in ("Derivative", "Integral", "at_constant")):
            return not (last and self._says(TO_BE_SOLVED))
        if isinstance(left, Call) and len(names := letters_of(left)) > 1:  # r₁ r₂ = …, both known
            letters, section = map(Letter, names), self.readings[self.place][0].section
            last &= len([*self.given.of(letters, self.place, section, printed)]) < len(names)
        return (isinstance(left, Letter) or not last) and not self._says(TO_BE_SOLVED)

    def _ways(self, left: Node, right: Node, printed: PrintedStatement) -> Iterator["_Way"]:
        """The two sides with derivatives taken and premises put in: for letters of the one, of the other, of both."""
        section = self.readings[self.place][0].section

        def premises(parts: Iterable[Node]) -> Iterator[PrintedMeaning]:
            return self.given.of(parts, self.place, section, printed)

        tried: list[list[dict[Node, PrintedMeaning]]] = []
        for wanted in WANTED:
            put = rounds(left, right, premises, wanted)
            if put in tried:
                continue
            tried.append(put)
            opaque = Opaque(self.opaque.names, self.rates, positive=self.positive)

            def value(node: Node, put: list[dict[Node, PrintedMeaning]] = put, opaque: Opaque = opaque) -> Any:
                return expression_of(_put(node, put), opaque)

            sides = value(left), value(right)
            yield _Way(*sides, put, value, opaque)

    def _are_sure(self, used: list[PrintedMeaning], printed: PrintedStatement) -> bool:
        """Whether premises are cited, or all that the section gives; and no word is against them, or begins another case."""
        each = self.readings[self.place][0]
        names = {premise.name for premise in used}
        case = used and (self._says(CASES) or (not names & self._cited and self._says(OPENING, names)))
        return not (case or self._says(CONDITIONS)) and all(
            premise.name in self._cited
            or (premise.section == each.section and self.given.is_given_once(premise, printed))
            for premise in used
        )

    @property
    def _cited(self) -> set[str]:
        """The equations that the text before the one in place names."""
        labels = self.readings[self.place][0].cites
        return {f"({equation.id})" for label in labels for equation in self.labelled[label]}

    def _says(self, what: re.Pattern[str], premises: Collection[str] = ()) -> str:
        """What the words beside the equation in place say."""
        return said_of(self.source.words.get(self.readings[self.place][0].id, ""), what, premises)

    def _slip_with(self, left: Node, right: Node, way: "_Way") -> str | None:
        """The one change of the right side with which it is the left one, the premises put in."""
        own, others = (set(letters_of(_put(side, way.put))) for side in (left, right))
        if None in (way.left, way.right) or not others or not _comparable(way.left, way.right):
            return None
        names, factors = own | set(letters_of(right)), functions_of(_put(side, way.put) for side in (left, right))
        slip = _but_for_dots(others, own) and change_to_agree(way.left, right, names, way.value, factors=factors)
        return slip if slip and not self._related(own | others, way.left, way.right) else None

    def _refuted(self, left: Node, right: Node, a: Any, b: Any, first: bool) -> tuple[str, str]:
        """Whether a difference that is not zero refutes the step; first: of the whole equation."""
        own, others = set(letters_of(left)), set(letters_of(right))
        if not _comparable(a, b) or (has_opaque(a, b) and (first or not others)):
            return "undecided", "derivatives, integrals or functions may be related"
        of_terms = isinstance(a, sp.Add) and _but_for_dots(others, own)  # of one term, as p' = p, it may be a condition
        if (more := sorted(others - own)) and not of_terms:
            return "undecided", f"{', '.join(more)} may be related to the letters before"
        if words := self._says(CONDITIONS):
            return "undecided", f"the text beside it says: {words}"
        if not others and own:
            if (value := constant_value(a)) is not None and decided(a, value) == "zero":
                return REFUTED, f"the left side is {value} for all values of its letters"
            if (
                not first
                and a.has(sp.Function)
                and (slip := change_to_agree(b, left, own, self._value))
                and "sign" in slip
            ):
                return REFUTED, f"the left side is not {b}; {slip}"
            return "undecided", "it is a condition, not an identity"
        solved, identity = self._says(TO_BE_SOLVED), self._says(IDENTITY)
        if first and (not (a.has(sp.Function) and b.has(sp.Function)) or (solved and not identity)):
            return "undecided", "it may be a condition"
        slip = self._slip(left, right, a, b, first)
        if slip is None:
            return "undecided", f"the two sides differ by {_difference(a, b)}: it may be a condition"
        if related := self._related(own, a, b):
            return "undecided", f"{related} may be used"
        if first and (solved or not identity):
            return NO_IDENTITY, f"the two sides differ by {_difference(a, b)}; {slip}; or it is a condition"
        return REFUTED, f"the two sides differ by {_difference(a, b)}; {slip}"

    def _slip(self, left: Node, right: Node, a: Any, b: Any, first: bool) -> str | None:
        """The one change with which the two sides agree."""
        names = {*letters_of(left), *letters_of(right)}
        return change_to_agree(a, right, names, self._value, first) or change_to_agree(
            b, left, names, self._value, first
        )

    def _value(self, node: Node) -> Any:
        return expression_of(node, self.opaque)

    def _related(self, letters: set[str], a: Any, b: Any) -> str:
        """What the text, or an equation before, says of these letters and no others, so that two sides may agree."""
        before = ((f"({each.id})", each.latex, reading) for each, reading in self.readings[: self.place])
        for name, latex, reading in chain(before, self._said):
            if reading.whole:
                related = any(
                    statement_letters(s) <= letters and {*s.relations} - _BOUNDS and self._may_explain(s, a, b)
                    for s in reading.statements
                )
            else:
                named = letters_printed(latex, self.notation)
                related = bool(named) and named <= {letter.split("_")[0] for letter in letters}
            if related:
                return name
        return ""

    def _may_explain(self, statement: PrintedStatement, a: Any, b: Any) -> bool:
        """Whether two sides agree, or may agree, where a statement holds, and are not both zero: it is solved for each letter."""
        sides = [self._value(side.node) for side in statement.sides]
        if None in sides or statement.kind != "equation" or any(isinstance(e, sp.MatrixBase) for e in (*sides, a, b)):
            return not self._says_nothing(sides)
        for left, right in pairwise(sides):
            if not _hidden(left) | _hidden(right) <= _hidden(a) | _hidden(b):
                continue  # it gives a function that neither side has
            shared = sorted((left - right).free_symbols & (a - b).free_symbols, key=str)
            zeros = [zero for symbol in shared if (zero := _zero_in(left - right, symbol)) is not None]
            if shared and not zeros and not agree(left, right):
                return True
            for zero in zeros:
                put = a.subs(*zero), b.subs(*zero)
                if agree(*put) and not agree(put[0], sp.S.Zero):
                    return True
        return False

    @cached_property
    def _of_numbers(self) -> bool:
        """Whether the source prints rates, and nothing is printed or said of operators in it."""
        formulas = [*(each.latex for each in self.source.equations), *self.source.inline]
        words = (*self.source.words.values(), *self.source.sections.values())
        return any(r"\dot" in each for each in formulas) and is_of_numbers((*formulas, *words))

    @cached_property
    def _said(self) -> list[tuple[str, str, Reading]]:
        """The relations of the text."""
        return [
            (f"${latex}$", latex, read_formula(latex, self.notation))
            for latex in self.source.inline
            if _RELATION.search(latex)
        ]

    @cached_property
    def positive(self) -> frozenset[str]:
        """The letters of which the text says that they are positive."""
        sides = ((s.sides, s.relations) for _, _, reading in self._said for s in reading.statements)
        return frozenset(
            left.node.name
            for (left, *others), relations in sides
            if isinstance(left.node, Letter) and ">" in relations and any(each.node == number(0) for each in others)
        )

    @cached_property
    def negative(self) -> frozenset[str]:
        """The letters of which the text says anywhere that they are negative."""
        text = " ".join([*self.source.words.values(), *(f"${latex}$" for latex in self.source.inline)])
        said = {next(filter(None, m.groups())) for m in NEGATIVE.finditer(text)}
        read = (read_formula(each, self.notation) for each in said)
        nodes = (s.sides[0].node for each in read for s in each.statements)
        return frozenset(each.name for each in nodes if isinstance(each, Letter))

    def _take_text(self, section: str) -> None:
        """Take over what the text of a section gives, at the first display of it."""
        for name, latex, reading in self._said if section not in self.told else ():
            if self.source.inline[latex] == section:
                for statement in reading.statements:
                    if letters_of(statement.sides[-1].node):  # x = 0 is what comes out, and no premise
                        self.given.add(statement, name, section, -1)
        self.told.add(section)

    def _says_nothing(self, sides: list[Any]) -> bool:
        """Whether an equation is an identity, which relates no letters."""
        return None not in sides and all(agree(a, b) for a, b in pairwise(sides))

    def _order(self, left: Node, right: Node, order: tuple[str, int]) -> tuple[str, str]:
        """A step that is claimed through an order of a small letter."""
        name, power = order
        small = sp.Symbol(name, real=True)
        try:
            a, b = sympy_expression(left, self.opaque), sympy_expression(right, self.opaque)
            if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or small not in a.free_symbols:
                return "undecided", f"the left side has no {name}"
            rates = re.compile(rf"{re.escape(name)}_d+ot")  # of what is small, they are as small
            scaled = {s: small * s for s in a.free_symbols | b.free_symbols if rates.fullmatch(s.name)}
            term = counted(agreement_order, a.xreplace(scaled), b.xreplace(scaled), small, power - 1)
        except WorkError:
            raise
        except (LagrotorError, TypeError, ValueError, ArithmeticError, AttributeError):
            return "undecided", "the series cannot be compared"
        if term.order is None:
            return HOLDS, f"through order {power - 1} in {name}"
        if has_opaque(a, b):
            return "undecided", f"derivatives or functions may be small as {name} is"
        return REFUTED, f"the two sides part at order {term.order} in {name}; O({name}**{power}) is claimed"

    def _values(self) -> Iterator[tuple[str, list[Node]]]:
        """Sections and sides of what the text gives a value, m = 2 kg."""
        for latex, section in self.source.inline.items():
            if "=" in latex and VALUED.search(latex):
                reading = read_formula(latex, self.notation)
                for each in reading.statements:
                    if each.kind == "equation" and not _guess(reading):
                        yield section, [side.node for side in each.sides]

    def _differ(self, one: ReadStatement, other: ReadStatement) -> bool:
        """Whether two definitions differ, as they are and with those before put in."""
        left, right = (each.statement.sides[1].node for each in (one, other))
        ways = ((way.left, way.right) for way in self._ways(left, right, other.statement))
        pairs = chain([(self._value(left), self._value(right))], ways)
        return all(None not in pair and decided(*pair) == "nonzero" for pair in pairs)


def _put(node: Node, put: list[dict[Node, PrintedMeaning]]) -> Node:
    for one in put:
        node = put_for(node, {key: each.value for key, each in one.items()})
    return node


def _real(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


def _zero_in(e: Any, symbol: sp.Symbol) -> tuple[sp.Symbol, Any] | None:
    """Where an expression that is linear in a letter is zero."""
    slope = e.diff(symbol)
    return None if slope == 0 or symbol in slope.free_symbols else (symbol, symbol - e / slope)


def _difference(a: Any, b: Any) -> str:
    return "a vector" if isinstance(a, sp.MatrixBase) else sp.sstr(counted(sp.factor_terms, a - b))


def _comparable(a: Any, b: Any) -> bool:
    """Whether the same derivatives, integrals and unknown functions stand on both sides, and both are vectors or neither."""
    return _hidden(a) == _hidden(b) and isinstance(a, sp.MatrixBase) == isinstance(b, sp.MatrixBase)


def _hidden(side: Any) -> set[sp.Symbol]:
    """The derivatives, integrals and unknown functions of a side."""
    return {symbol for symbol in side.free_symbols if has_opaque(symbol)}


def _but_for_dots(others: set[str], own: set[str]) -> bool:
    """Whether letters are those of the other side, but for dots: a rate is not the letter itself."""
    return {_DOTTED.sub(r"\1", name) for name in others - own} <= {_DOTTED.sub(r"\1", name) for name in own}


def _rates(statements: Iterable[PrintedStatement]) -> dict[sp.Symbol, sp.Symbol]:
    """Letters of which there are dots, and components of vectors, to their rates."""
    rates: dict[sp.Symbol, sp.Symbol] = {}
    for letter in {each for statement in statements for side in statement.sides for each in walk(side.node)}:
        if isinstance(letter, Letter) and (dotted := _DOTTED.fullmatch(letter.name)):
            stem, dots = dotted[1], len(dotted[2])
            names = [stem, *(f"{stem}_{'d' * n}ot" for n in range(1, dots + 2))]
            for end in ("_1", "_2", "_3") if letter.vector else ("",):
                rates |= {_real(a + end): _real(b + end) for a, b in pairwise(names)}
    return rates


def _guess(reading: Reading) -> str:
    """The guess that a reading rests on; nothing where it rests on none."""
    return next((each for each in reading.guesses if not each.startswith(ANY_BASE)), "")
