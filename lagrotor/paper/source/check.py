r"""What can be judged of a source without any derivation: chains step by step, equations against those they cite, dimensions,
orders, letters.

No reading is confirmed here: what agrees "would hold", what differs "would be refuted". A step of a chain may rest on physics
that is in the text; it is refuted only where its right side has no letter but those of the left, no equation before relates
these, the difference is decided, and one change of sign, factor or power makes the two sides agree: a slip, not a law.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterator
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import Any

import sympy as sp

from lagrotor.algebra import agreement_order, decide_equal
from lagrotor.algebra.scalar import degree
from lagrotor.algebra.work import at_most
from lagrotor.errors import LagrotorError, WorkError
from lagrotor.paper.source.dimensions import FormulaDimensions
from lagrotor.paper.source.displays import Displayed, Source
from lagrotor.paper.source.formula import Reading, read_formula, with_progress
from lagrotor.paper.source.read_statements import PrintedStatement, Side
from lagrotor.paper.source.tree import (
    KNOWN,
    Call,
    Letter,
    Node,
    Number,
    Opaque,
    has_opaque,
    letters_of,
    sympy_expression,
    text_of,
    walk,
)
from lagrotor.paper.source.usage import Notation, letters_printed, notation_of

HOLDS, REFUTED, NO_IDENTITY, UNITS, MEANINGS, BEFORE, FAULT = (
    "would hold", "would be refuted", "no identity", "dimensions differ", "two meanings", "used before it is given", "no LaTeX",
)  # fmt: skip
FOUND = (REFUTED, NO_IDENTITY, UNITS, MEANINGS, BEFORE, FAULT)
WRONG = (REFUTED, UNITS, FAULT)
# Terms of which each is tried with the other sign, to say what is wrong; the degree and the calls of functions, a few seconds,
# beyond which a step is not decided.
_MOST_TERMS, _MOST_DEGREE, _MOST_CALLS = 12, 1000, 3_000_000
_LARGE = "undecided", "the difference is too large"
_LARGEST = 1e300  # of numbers that are compared
# Functions that are taken for each other.
_TAKEN_FOR = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh"}
# Changes that are tried to find a slip; equations back to which a step may refer.
_MOST_SLIPS, _MEMORY = 120, 60
# Formulas of the text that give a value: with a unit, or in units where it is 1.
_VALUED = re.compile(r"\\(?:mathrm|rm|text|hbar)\b|k_")
# Where a reading stops at what a package may define.
_UNKNOWN = re.compile(r"(\\(?:[A-Za-z@]+|begin\{[^{}]*\})) is not known")
# What the text may say of letters; relations that make nothing of one letter out of another.
_RELATION = re.compile(r"=|\\(?:equiv|approx|simeq|sim|to|ll|gg|rightarrow|propto|cong)\b")
# What the text says where two sides agree only under a condition.
_CONDITIONS = re.compile(
    r"\b(?:modulo|up to|(?:anti)?symmetr\w*|neglect\w*|drop\w*|ignor\w*|omit\w*|order|approximat\w*|by parts|boundary|relabel\w*"
    r"|renam\w*|exchang\w*|interchang\w*|rescal\w*|redefin\w*|absorb\w*|vanish\w*|limit|small|assum\w*|on.shell|constraint)\b",
    re.IGNORECASE,
)
_TO_BE_SOLVED = re.compile(
    r"\b(?:if|when\w*|where|unless|until|only|satisf\w*|sol[uv]\w*|roots?|condition\w*|equations?|require\w*|must|equilibri\w*)\b",
    re.IGNORECASE,
)
# What it says of an equation that holds for all values of its letters; □: where the equation stands.
_IDENTITY = re.compile(
    r"\b(?:identit\w*|theorems?|formula\w*|recall|remember|for (?:all|any|every)|trigonometr\w*|(?:double|half).angles?)\b"
    r"|\b(?:using|used?|since|because|note that|known?(?: that)?)[\s,:]*□",
    re.IGNORECASE,
)
_BOUNDS = frozenset(("<", ">", "<=", ">=", "!="))
# The one guess that verdicts rest on: that log is the natural logarithm.
_ANY_BASE = "log is"


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
        """{equation, step, line, verdict, why}, and the file where it is not the source itself."""
        row = asdict(self)
        return row if self.file else {key: value for key, value in row.items() if key != "file"}


@dataclass(frozen=True)
class _Read:
    """One statement of an equation."""

    equation: Displayed
    statement: PrintedStatement


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
    main = source.equations[0].place[0] if source.equations else ""
    faults = [
        StepFinding("", 0, n, FAULT, said, file if main not in ("", file) else "") for file, n, said in source.faults
    ]
    return faults + sorted(checker.findings(progress), key=lambda found: (order[found.equation], found.step))


class _Checker:
    def __init__(self, source: Source, readings: list[tuple[Displayed, Reading]], notation: Notation) -> None:
        self.source, self.readings, self.notation = source, readings, notation
        self.opaque = Opaque()
        self.before: list[_Read] = []
        self.labelled: defaultdict[str, list[_Read]] = defaultdict(list)  # those before, by label
        self.place = 0
        self.statements = [
            _Read(each, s) for each, reading in readings if not _guess(reading) for s in reading.statements
        ]

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
            for number, statement in enumerate(reading.statements):
                yield from self._steps(each, statement if number else self._continued(each, statement), reading)
            if (judged := _bounded(self._against_cited, each, reading)) is not None:
                yield self._finding(each, 0, None, *judged)
            if not _guess(reading):
                made = [_Read(each, s) for s in reading.statements if s.kind == "equation"]
                self.before += made
                self.labelled[each.label] += made
        yield from self._dimensions()
        yield from self._letters()

    def _finding(self, each: Displayed, step: int, side: Side | None, verdict: str, why: str) -> StepFinding:
        line = each.place[1]
        if side is not None and len(each.rows) > 1:
            line = each.rows[min(each.latex[: side.at].count(r"\\"), len(each.rows) - 1)]
        own = Path(each.place[0]).name
        main = self.source.equations[0].place[0]
        return StepFinding(each.id, step, line, verdict, why, own if own != main else "")

    # ---- chains

    def _steps(self, each: Displayed, statement: PrintedStatement, reading: Reading) -> Iterator[StepFinding]:
        """Each step of a chain but the first, which says what is meant."""
        sides = statement.sides
        for step in range(1, len(sides)):
            left, right, relation = sides[step - 1], sides[step], statement.relations[step - 1]
            last = step == len(sides) - 1
            if statement.order is not None and last and step > 1:
                yield from self._order(each, step, left, right, statement.order)
                continue
            if relation not in ("=", ":=") or (step == 1 and not self._identity(left.node, right.node)):
                continue
            verdict, why = _bounded(self._step, left.node, right.node, step == 1)
            if (guess := _guess(reading)) and verdict in (HOLDS, REFUTED):
                verdict, why = "undecided", f"{why}; but it is a guess that {guess}"
            if step > 1 or verdict in (HOLDS, REFUTED, NO_IDENTITY):
                yield self._finding(each, step, right, verdict, why)

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
        return isinstance(left, Call) and not isinstance(right, Letter) and beside

    def _step(self, left: Node, right: Node, first: bool) -> tuple[str, str]:
        try:
            a, b = sympy_expression(left, self.opaque), sympy_expression(right, self.opaque)
        except (TypeError, ValueError, ArithmeticError, AttributeError) as error:
            return "undecided", f"the two sides cannot be compared: {error}"
        if a != b and _is_large(a, b):
            return _LARGE
        answer = decided(a, b) if _may_agree(a, b) else "nonzero"
        if answer == "zero":
            return HOLDS, f"{text_of(left)} = {text_of(right)} is an identity"
        given, used = self._put_in(a, b)
        if _is_large(*given):
            given, used = (a, b), []
        if used and _agree(*given):
            return HOLDS, f"with {', '.join(used)}"
        if answer == "undecided":
            return "undecided", "the difference is outside what is decided exactly"
        if answer == "shape":
            return "undecided", "one side is printed as a vector, the other as a number"
        verdict, why = self._refuted(left, right, a, b, first)
        if (
            verdict != REFUTED
            and used
            and not first
            and self._are_near(used)
            and (slip := self._slip_from(given[0], b, right))
        ):
            return REFUTED, f"with {', '.join(used)} the two sides differ; {slip}"
        if verdict == REFUTED and decided(a, b) != "nonzero":
            return "undecided", "the difference is outside what is decided exactly"
        return verdict, why

    def _are_near(self, used: list[str]) -> bool:
        """Whether equations are cited, or among the last three of the section."""
        each = self.readings[self.place][0]
        last = [e for e, _ in self.readings[max(self.place - 3, 0) : self.place] if e.section == each.section]
        near = [*last, *(read.equation for label in each.cites for read in self.labelled[label])]
        return {*used} <= {f"({e.id})" for e in near} and not self._says(_CONDITIONS)

    def _says(self, condition: re.Pattern[str]) -> str:
        words = condition.search(self.source.words.get(self.readings[self.place][0].id, ""))
        return words[0] if words else ""

    def _slip_from(self, put: Any, b: Any, right: Node) -> str | None:
        """The one change of the right side with which it is the left one, `put`, whose letters no other equation relates."""
        if any(isinstance(side, sp.MatrixBase) for side in (put, b)) or has_opaque(put, b):
            return None
        letters = {symbol.name for symbol in put.free_symbols}
        if {symbol.name for symbol in b.free_symbols} != letters or next(self._related(letters), None):
            return None
        return self._change(put, right, letters)

    def _refuted(self, left: Node, right: Node, a: Any, b: Any, first: bool) -> tuple[str, str]:
        """Whether a difference that is not zero refutes the step; first: of the whole equation."""
        own, others = set(letters_of(left)), set(letters_of(right))
        if has_opaque(a, b):
            return "undecided", "derivatives, integrals or functions may be related"
        if more := sorted(others - own):
            return "undecided", f"{', '.join(more)} may be related to the letters before"
        if words := self._says(_CONDITIONS):
            return "undecided", f"the text beside it says: {words}"
        if not others and own:
            if (value := _constant(a)) is not None and decided(a, value) == "zero":
                return REFUTED, f"the left side is {value} for all values of its letters"
            if not first and a.has(sp.Function) and (slip := self._change(b, left, own)) and "sign" in slip:
                return REFUTED, f"the left side is not {b}; {slip}"
            return "undecided", "it is a condition, not an identity"
        difference = "a vector" if isinstance(a, sp.MatrixBase) else sp.sstr(sp.factor_terms(a - b))
        solved, identity = self._says(_TO_BE_SOLVED), self._says(_IDENTITY)
        if first and (not (a.has(sp.Function) and b.has(sp.Function)) or (solved and not identity)):
            return "undecided", "it may be a condition"
        slip = self._slip(left, right, a, b, first)
        if slip is None:
            return "undecided", f"the two sides differ by {difference}: it may be a condition"
        if related := next(self._related(own), None):
            return "undecided", f"{related} may be used"
        if first and (solved or not identity):
            return NO_IDENTITY, f"the two sides differ by {difference}; {slip}; or it is a condition"
        return REFUTED, f"the two sides differ by {difference}; {slip}"

    def _slip(self, left: Node, right: Node, a: Any, b: Any, first: bool) -> str | None:
        """The one change with which the two sides agree."""
        names = {*letters_of(left), *letters_of(right)}
        return self._change(a, right, names, first) or self._change(b, left, names, first)

    def _change(self, fixed: Any, changing: Node, names: set[str], by_identity: bool = False) -> str | None:
        """The one change of a side with which it is the other, `fixed`.

        by_identity: by more than to the same print, as cos x = sin x, and not by putting θ₁ for θ₂: both may be conditions.
        """
        given = _expression_of(changing, self.opaque)
        letters = (sp.Symbol(name, real=True) for name in names)
        symbols = sorted({*fixed.free_symbols, *given.free_symbols, *letters}, key=str)
        point = {symbol: sp.Rational(2 * place + 3, 2 * place + 5) for place, symbol in enumerate(symbols)}
        value = _number(fixed, point)
        ratio = _ratio(fixed, given, point)
        if ratio is not None and not (by_identity and fixed == sp.Rational(str(ratio)) * given):
            return f"with the factor {ratio} of the whole they agree"
        whole = () if by_identity else _whole(changing)  # tan x = cot x may be a condition
        for mutant, said in islice(chain(whole, slips(changing, () if by_identity else names)), _MOST_SLIPS):
            other = _expression_of(mutant, self.opaque)
            if other is None or (by_identity and fixed == other):
                continue
            if _near(value, _number(other, point)) and decided(fixed, other) == "zero":
                return f"with {said} they agree"
        return None

    def _related(self, letters: set[str]) -> Iterator[str]:
        """What the text, and the equations before whether they are read or not, say of these letters and no others."""
        before = ((f"({each.id})", each.latex, reading) for each, reading in self.readings[: self.place])
        for name, latex, reading in chain(before, self._said):
            if reading.whole:
                related = any(
                    _letters_of(s) <= letters and {*s.relations} - _BOUNDS and not self._says_nothing(s)
                    for s in reading.statements
                )
            else:
                named = letters_printed(latex, self.notation)
                related = bool(named) and named <= {letter.split("_")[0] for letter in letters}
            if related:
                yield name

    @cached_property
    def _said(self) -> list[tuple[str, str, Reading]]:
        """The relations of the text."""
        return [
            (f"${latex}$", latex, read_formula(latex, self.notation))
            for latex in self.source.inline
            if _RELATION.search(latex)
        ]

    def _says_nothing(self, statement: PrintedStatement) -> bool:
        """Whether an equation is an identity, which relates no letters."""
        sides = [_expression_of(side.node, self.opaque) for side in statement.sides]
        return None not in sides and all(_agree(a, b) for a, b in pairwise(sides))

    def _put_in(self, a: Any, b: Any) -> tuple[tuple[Any, Any], list[str]]:
        """Both sides with the definitions before put in, and the equations that were used."""
        used: list[str] = []
        put: set[str] = set()  # each letter once: x by y and y by x go on without end
        for _ in range(4):
            free = {s.name for side in (a, b) for s in side.free_symbols} - put
            meanings = {}
            for read in self.before[-_MEMORY:]:
                first, last = read.statement.sides[0].node, read.statement.sides[-1].node
                if not isinstance(first, Letter) or first.vector or first.name not in free:
                    continue
                if first.name in letters_of(last):
                    continue
                try:
                    value = sympy_expression(last, self.opaque)
                except (TypeError, ValueError, ArithmeticError, AttributeError):
                    continue
                if isinstance(value, sp.MatrixBase):
                    continue
                meanings[sp.Symbol(first.name, real=True)] = value, f"({read.equation.id})"
            if not meanings:
                break
            put |= free
            values = {symbol: value for symbol, (value, _) in meanings.items()}
            used += [name for _, name in meanings.values()]
            a, b = a.subs(values), b.subs(values)
        return (a, b), list(dict.fromkeys(used))

    def _order(
        self, each: Displayed, step: int, left: Side, right: Side, order: tuple[str, int]
    ) -> Iterator[StepFinding]:
        """A step that is claimed through an order of a small letter."""
        name, power = order
        small = sp.Symbol(name, real=True)
        try:
            a, b = sympy_expression(left.node, self.opaque), sympy_expression(right.node, self.opaque)
            if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase) or small not in a.free_symbols:
                return
            rates = re.compile(rf"{re.escape(name)}_d+ot")  # of what is small, they are as small
            scaled = {s: small * s for s in a.free_symbols | b.free_symbols if rates.fullmatch(s.name)}
            term = at_most(_MOST_CALLS, agreement_order, a.xreplace(scaled), b.xreplace(scaled), small, power - 1)
        except (LagrotorError, TypeError, ValueError, ArithmeticError, AttributeError, RecursionError):
            yield self._finding(each, step, right, "undecided", "the series cannot be compared")
            return
        if term.order is None:
            yield self._finding(each, step, right, HOLDS, f"through order {power - 1} in {name}")
        elif has_opaque(a, b):
            yield self._finding(each, step, right, "undecided", f"derivatives or functions may be small as {name} is")
        else:
            yield self._finding(
                each,
                step,
                right,
                REFUTED,
                f"the two sides part at order {term.order} in {name}; O({name}**{power}) is claimed",
            )

    # ---- equations and what they cite

    def _against_cited(self, each: Displayed, reading: Reading) -> tuple[str, str] | None:
        """An equation against two that the text before it names, where the one is a definition in the other."""
        if len(each.cites) < 2 or len(reading.statements) != 1:
            return None
        named = [read for label in each.cites for read in self.labelled[label]]
        new = self._difference(reading.statements[0])
        if new is None:
            return None
        for definition in named:
            first = definition.statement.sides[0].node
            if not isinstance(first, Letter) or len(definition.statement.sides) != 2:
                continue
            value = sympy_expression(definition.statement.sides[1].node, self.opaque)
            for other in named:
                old = self._difference(other.statement)
                symbol = sp.Symbol(first.name, real=True)
                if (
                    other is definition
                    or old is None
                    or symbol not in old.free_symbols
                    or isinstance(value, sp.MatrixBase)
                ):
                    continue
                put = old.subs(symbol, value)
                names = f"({definition.equation.id}) in ({other.equation.id})"
                if put.free_symbols != new.free_symbols or _is_large(put, new):
                    continue
                if guess := _guess(reading):
                    return "undecided", f"it cites {names}; but it is a guess that {guess}"
                if _proportional(put, new):
                    return HOLDS, f"it is {names}"
                if (terms := _changed(put, new)) is not None:
                    return REFUTED, f"{names} gives it with {terms[1]} for {terms[0]}"
                return "undecided", f"it is not {names} alone"
        return None

    def _difference(self, statement: PrintedStatement) -> sp.Expr | None:
        if statement.kind != "equation" or len(statement.sides) != 2:
            return None
        try:
            left, right = (sympy_expression(side.node, self.opaque) for side in statement.sides)
        except (TypeError, ValueError, ArithmeticError, AttributeError):
            return None
        vectors = isinstance(left, sp.MatrixBase) or isinstance(right, sp.MatrixBase)
        return None if vectors or has_opaque(left, right) else left - right

    # ---- dimensions and letters

    def _dimensions(self) -> Iterator[StepFinding]:
        """Equations whose dimensions contradict those of the others.

        They are known where the paper prints units, of displays or in the text. A letter that several equations need otherwise
        than the rest has another meaning there: of these only what contradicts its own section is reported.
        """
        printed = [r for r in self.statements if r.statement.kind in ("equation", "approximation", "inequality")]
        held = [
            *self._values(),
            *((read.equation.section, _without_values(read.statement), read) for read in printed),
        ]
        numbers = {
            side.name
            for _, sides, _ in held
            if any(isinstance(side, Number) for side in sides)
            for side in sides
            if isinstance(side, Letter)
        }
        whole = FormulaDimensions(numbers)
        sections: defaultdict[str, FormulaDimensions] = defaultdict(lambda: FormulaDimensions(numbers))
        broken: list[tuple[_Read, str, bool]] = []
        for section, sides, read in held:
            near = sections[section.split(".")[0]].add(sides) is not None
            why = whole.add(sides)
            if why is not None and read is not None:
                broken.append((read, why, near))
        letters = Counter(name for read, _, _ in broken for name in _letters_of(read.statement))
        for read, why, near in broken:
            if near or all(letters[name] == 1 for name in _letters_of(read.statement)):
                yield self._finding(read.equation, 0, None, UNITS, why)

    def _values(self) -> Iterator[tuple[str, list[Node], None]]:
        """Sections and sides of what the text gives a value, m = 2 kg."""
        for latex, section in self.source.inline.items():
            if "=" in latex and _VALUED.search(latex):
                reading = read_formula(latex, self.notation)
                for each in reading.statements:
                    if each.kind == "equation" and not _guess(reading):
                        yield section, [side.node for side in each.sides], None

    def _differ(self, one: _Read, other: _Read) -> bool:
        """Whether two definitions differ, as they are and with those before put in."""
        a, b = (sympy_expression(each.statement.sides[1].node, self.opaque) for each in (one, other))
        return decided(a, b) == "nonzero" and decided(*self._put_in(a, b)[0]) == "nonzero"

    def _letters(self) -> Iterator[StepFinding]:
        """Letters that are defined twice, used before they are given, or have two meanings."""
        definitions: dict[str, tuple[int, _Read]] = {}
        for place, read in enumerate(self.statements):
            first = read.statement.sides[0].node
            if not isinstance(first, Letter) or ":=" not in read.statement.relations[:1]:
                continue
            if first.name in definitions:
                _, other = definitions[first.name]
                if _bounded(self._differ, other, read) is True:
                    yield self._finding(
                        read.equation, 0, None, MEANINGS, f"{first.name} is defined in ({other.equation.id}) otherwise"
                    )
                continue
            definitions[first.name] = place, read
        # by letter and chapter, the first use: in another chapter a letter may have another meaning
        used: dict[tuple[str, str], tuple[int, _Read]] = {}
        for place, read in enumerate(self.statements):
            for name in _letters_of(read.statement):
                used.setdefault((name, read.equation.section.split(".")[0]), (place, read))
        for name, (place, read) in definitions.items():
            first_use, user = used[name, read.equation.section.split(".")[0]]
            if first_use < place and user.equation.id != read.equation.id:
                yield self._finding(user.equation, 0, None, BEFORE, f"{name} is given in ({read.equation.id})")
        if self.notation.exponential and "e" in self.notation.bare:
            own = [(each, notation_of([each.latex], Notation(made=self.notation.made))) for each, _ in self.readings]
            letter = [each for each, seen in own if "e" in seen.bare]  # none: e is a letter in the text alone
            places = [*letter, *(each for each, seen in own if seen.exponential), self.readings[0][0]]
            yield self._finding(places[0], 0, None, MEANINGS, "e is a letter and the base of exponentials")


def _letters_of(statement: PrintedStatement) -> set[str]:
    return {name for side in statement.sides for name in letters_of(side.node)}


def _without_values(statement: PrintedStatement) -> list[Node]:
    """Its sides, but those behind a ≈ with a number that the side before has not: it may be a quantity without its unit."""
    nodes = [side.node for side in statement.sides]
    numbers = [{each for each in walk(node) if isinstance(each, Number)} for node in nodes]
    pairs = zip(statement.relations, numbers, numbers[1:], nodes[1:], strict=False)
    return [nodes[0], *(node for relation, before, own, node in pairs if relation != "~" or own <= before)]


def _guess(reading: Reading) -> str:
    """The guess that a reading rests on; nothing where it rests on none."""
    return next((each for each in reading.guesses if not each.startswith(_ANY_BASE)), "")


def _expression_of(node: Node, opaque: Opaque) -> Any:
    """The node as a sympy expression; None where it has none."""
    try:
        return sympy_expression(node, opaque)
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return None


def slips(node: Node, names: Collection[str] = ()) -> Iterator[tuple[Node, str]]:
    """The node with one sign, factor 2, power, index or function changed, and what was changed; names: letters about."""
    if isinstance(node, Letter) and not node.vector:
        for name in sorted(names):
            if name != node.name and name.split("_")[0] == node.name.split("_")[0]:
                yield Letter(name), f"{name} for {node.name}"
        yield Call("power", (node, Number(Fraction(2)))), f"{node.name} squared"
    if not isinstance(node, Call):
        return
    if node.name in _TAKEN_FOR:
        yield Call(_TAKEN_FOR[node.name], node.args), f"{_TAKEN_FOR[node.name]} for {node.name}"
    if node.name == "sum":
        for place, term in enumerate(node.args):
            other = term.args[0] if isinstance(term, Call) and term.name == "negative" else Call("negative", (term,))
            yield _with(node, place, other), f"the sign of {text_of(term)} changed"
            yield _with(node, place, Call("product", (Number(Fraction(2)), term))), f"{text_of(term)} doubled"
            yield _with(node, place, Call("quotient", (term, Number(Fraction(2))))), f"{text_of(term)} halved"
    if node.name == "power" and isinstance(node.args[1], Number):
        for more in (1, -1):
            yield _with(node, 1, Number(node.args[1].value + more)), f"the power of {text_of(node)} changed by one"
    if node.name == "exp":
        yield _with(node, 0, Call("negative", node.args)), f"the sign in {text_of(node)} changed"
    for place, part in enumerate(node.args):
        for changed, said in slips(part, names):
            yield _with(node, place, changed), said


def _whole(node: Node) -> Iterator[tuple[Node, str]]:
    """The node with its sign changed, or turned over."""
    if not (isinstance(node, Call) and node.name == "sum"):
        yield Call("negative", (node,)), "the sign of the whole changed"
    yield Call("quotient", (Number(Fraction(1)), node)), "the whole turned over"
    yield Call("sqrt", (node,)), "the root of the whole"
    yield Call("power", (node, Number(Fraction(2)))), "the whole squared"


def _ratio(a: Any, b: Any, point: dict[sp.Symbol, sp.Rational]) -> Fraction | None:
    """The number of few digits by which b is multiplied to be a."""
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase):
        return None
    value, other = _number(a, point), _number(b, point)
    if not (value.is_real and other.is_real and value and other):
        return None
    if abs(value / other) > _LARGEST:
        return None
    ratio = Fraction(float(value / other)).limit_denominator(100)
    exact = sp.Rational(ratio.numerator, ratio.denominator)
    return ratio if ratio > 0 and _near(value, exact * other) and decided(a, exact * b) == "zero" else None


def _constant(a: Any) -> sp.Rational | None:
    """The number that an expression may be, whatever its letters are."""
    if isinstance(a, sp.MatrixBase):
        return None
    values = {}
    for shift in (3, 7):
        point = {s: sp.Rational(2 * n + shift, 2 * n + 5) for n, s in enumerate(sorted(a.free_symbols, key=str))}
        values[shift] = _number(a, point)
    if not all(value.is_real for value in values.values()) or not _near(*values.values()):
        return None
    return sp.Rational(str(Fraction(float(values[3])).limit_denominator(100)))


def _with(node: Call, place: int, part: Node) -> Call:
    return Call(node.name, (*node.args[:place], part, *node.args[place + 1 :]))


def _number(side: Any, point: dict[sp.Symbol, sp.Rational]) -> Any:
    """The value at a point; nan beyond what floats hold."""
    entry = next((e for e in side if e != 0), sp.S.Zero) if isinstance(side, sp.MatrixBase) else side
    try:
        value = sp.N(entry.xreplace(point), 15)
        return value if abs(complex(value)) < _LARGEST else sp.nan
    except (ArithmeticError, ValueError, TypeError):
        return sp.nan


def _near(a: Any, b: Any) -> bool:
    try:
        return bool(abs(a - b) <= 1e-9 * (abs(a) + abs(b)))
    except TypeError:
        return False


def _may_agree(a: Any, b: Any) -> bool:
    """Whether no point is known where two expressions are real numbers that differ: only then is it worth deciding exactly."""
    if isinstance(a, sp.MatrixBase) or isinstance(b, sp.MatrixBase):
        return True
    symbols = sorted(a.free_symbols | b.free_symbols, key=str)
    for shift in (3, 7, 19):
        point = {s: sp.Rational(2 * n + shift, 5 * n + 7) for n, s in enumerate(symbols)}
        values = _number(a, point), _number(b, point)
        if all(value.is_real and value.is_finite for value in values):
            return _near(*values)
    return True


def _bounded(work: Callable[..., Any], *arguments: Any) -> Any:
    """What it gives; that it is too large beyond the bound on the work of a step."""
    try:
        return at_most(_MOST_CALLS, work, *arguments)
    except (WorkError, RecursionError):
        return _LARGE


def _is_large(*sides: Any) -> bool:
    """Whether a degree is beyond what sums of polynomials are multiplied out to."""
    entries = (e for side in sides for e in (side if isinstance(side, sp.MatrixBase) else [side]))
    return any(degree(e) > _MOST_DEGREE for e in entries)


def _agree(a: Any, b: Any) -> bool:
    return _may_agree(a, b) and decided(a, b) == "zero"


def decided(a: Any, b: Any) -> str:
    """zero, nonzero or undecided; shape where one side is a vector and the other is not."""
    matrices = isinstance(a, sp.MatrixBase), isinstance(b, sp.MatrixBase)
    if any(matrices) and not all(matrices):
        return "zero" if not any(matrices) else "shape" if sp.S.Zero not in (a, b) else _all(a if matrices[0] else b)
    if all(matrices):
        return _all(a - b)
    return _single(a, b)


def _all(matrix: sp.MatrixBase) -> str:
    answers = {_single(entry, sp.S.Zero) for entry in matrix}
    return next(each for each in ("nonzero", "undecided", "zero") if each in answers)


def _single(a: Any, b: Any) -> str:
    if any(part.has(sp.oo, sp.nan, sp.zoo, sp.I) for part in (a, b)):
        return "undecided"
    try:
        found = decide_equal(a, b)
    except (LagrotorError, TypeError, ValueError, ArithmeticError):
        return "undecided"
    return "undecided" if found.partly else found.answer


def _proportional(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two differences say the same: their quotient is a product of letters and numbers."""
    ratio = sp.cancel(sp.together(a) / sp.together(b))
    return not any(
        isinstance(part, sp.Add) for factor in ratio.as_numer_denom() for part in sp.Mul.make_args(sp.factor(factor))
    )


def _changed(a: sp.Expr, b: sp.Expr) -> tuple[str, str] | None:
    """The term of b that must change its sign, or be twice or half as large, for the two to say the same; what it must be."""
    terms = sp.Add.make_args(sp.expand(b))
    if len(terms) > _MOST_TERMS:
        return None
    changes = ((term, factor * term) for factor in (-1, 2, sp.Rational(1, 2)) for term in terms)
    return next(((sp.sstr(t), sp.sstr(new)) for t, new in changes if _proportional(a, sp.expand(b) - t + new)), None)
