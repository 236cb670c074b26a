"""What a derivation states of an equation, and what was decided of it: relations, statements, verdicts and their table."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import floor, log10
from typing import Any, Literal, TypeAlias

import sympy as sp
from sympy.core.relational import Relational

from lagrotor.algebra.name_clashes import check_names, symbols_in
from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper.hypotheses import hypotheses
from lagrotor.paper.plain_text import from_latex, readable
from lagrotor.paper.premises import Premise, relation_text
from lagrotor.paper.tables import Table
from lagrotor.paper.theorems import Theorem
from lagrotor.paper.units import Dimensions

Answer = Literal["holds", "holds-if", "holds-to-order", "proved", "refuted", "measured", "definition", "undecided"]
Side: TypeAlias = Any  # a sympy expression or matrix
AGREES: tuple[Answer, ...] = ("holds", "holds-if", "holds-to-order", "proved")


@dataclass(frozen=True)
class Series:
    """A side of which only the terms through small**order are known: what is compared with it holds to that order at most."""

    expression: Side
    small: sp.Symbol
    order: int


@dataclass(frozen=True)
class Relation:
    """`printed` should equal `derived`; with `small`, up to and including small**claimed.

    Attributes
    ----------
    within : Rational or None, optional
        For a number read off a run, the relative error that its printed digits allow.
    quantity : str, default ''
        What both are, in LaTeX.
    scene : mapping, default field(default_factory=dict)
        Values that the text gives for this line, a premise of their own.
    known : tuple[Symbol, int] or None, optional
        The small quantity and the order through which the derived side is known, where it is a series.
    written : str, default ''
        LaTeX of the derived side, in a correction of what should be printed, as a physicist writes it.
    granted : bool, default False
        It is equal under the premises only.
    theorem : Theorem or None, optional
        It encloses the number that is printed, and decides in place of the derived side.
    """

    printed: Side
    derived: Side
    small: sp.Symbol | None = None
    claimed: int = 0
    within: sp.Rational | None = None
    quantity: str = ""
    scene: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    written: str = ""
    granted: bool = False
    known: tuple[sp.Symbol, int] | None = None
    theorem: Theorem | None = None

    @property
    def scene_premises(self) -> tuple[Premise, ...]:
        """The values that the text gives for this line, as a premise."""
        return (Premise("the values that the text gives", self.scene),) if self.scene else ()

    def under(self, premises: Iterable[Premise]) -> "Relation":
        """The relation with premises put into both sides; an approximation makes it one between leading terms."""
        under = hypotheses(premises)
        small = under.small[0] if under.small else self.small
        return replace(self, printed=under.on(self.printed), derived=under.on(self.derived), small=small)


def chain(derived: Side, *printed: Side, small: sp.Symbol | None = None, claimed: int = 0) -> tuple[Relation, ...]:
    """The relations of a line `… = p_1 = p_2 = …`, each member held against the derived expression.

    Parameters
    ----------
    derived : Side
        The expression.
    small : Symbol or None, optional
        The small quantity of a line that holds to an order.
    claimed : int, default 0
        That order.
    printed : Side
        P_1, p_2, ….
    """
    return tuple(
        Relation(sp.sympify(p, strict=True), sp.sympify(derived, strict=True), small, claimed) for p in printed
    )


@dataclass(frozen=True)
class Statement:
    """What one equation of a paper is compared with; id: its id, empty where it belongs to none; title: what it is about.

    Attributes
    ----------
    relations : tuple[Relation, ...]
        Printed against derived, one for each member of each printed line.
    premises : tuple[Premise, ...], default ()
        What may be assumed.
    correction : tuple[Relation, ...], default ()
        What should be printed, as relations of their own.
    wrong : str, default ''
        What is wrong, in a line.
    names : bool, default False
        The line only introduces a letter.
    measured : bool, default False
        It is a number read off a run.
    depends_on : tuple[str, ...], default ()
        Ids of the equations that this one uses.
    evidence : tuple[str, ...], default ()
        Sentences with the numbers that were computed.
    """

    id: str
    relations: tuple[Relation, ...]
    premises: tuple[Premise, ...] = ()
    correction: tuple[Relation, ...] = ()
    wrong: str = ""
    names: bool = False
    measured: bool = False
    depends_on: tuple[str, ...] = ()
    evidence: tuple[str, ...] = ()
    title: str = ""

    def __post_init__(self) -> None:
        if not self.relations and not self.names:
            raise InputError(f"verdict: {self.id}: nothing is compared: give what was derived")
        where = f"verdict: {self.id}" if self.id else "judge"
        sides = [(r.printed, r.derived, r.small, r.scene) for r in (*self.relations, *self.correction)]
        check_names(where, sides, [(premise.put, premise.where, premise.small) for premise in self.premises])


def unconnected(sides: Any, premises: Iterable[Premise]) -> list[Premise]:
    """Return the premises with letters, none of which is in the sides, nor in a premise that is connected with them."""
    known, left = set(symbols_in(sides)), [(p, set(symbols_in((p.put, p.where, p.small)))) for p in premises]
    while near := [letters for _, letters in left if letters & known or not letters]:
        known.update(*near)
        left = [each for each in left if each[1] and not each[1] <= known]
    return [premise for premise, _ in left]


def check_premises(sides: Any, premises: Iterable[Premise]) -> None:
    """Raise InputError for a premise that is not connected with the sides."""
    for premise in unconnected(sides, premises):
        raise InputError(f"judge: no letter of the premise {premise.with_formula} is in the equation: name it alike")


@dataclass(frozen=True)
class LineVerdict:
    """What was decided of one member of one printed line, or of one line of a correction.

    Attributes
    ----------
    premises : tuple[Premise, ...], default ()
        Those that it needs; of what is refuted all that were assumed, under which its difference is stated.
        order, small: of a series.
    domain : tuple[Relational, ...], default ()
        Relations that hold wherever both sides are defined and real.
    difference : Expr or None, optional
        Of what is refuted, printed less derived under the premises; of matrices the entry `place`, of series the
        first coefficient.
    witness : Mapping[Symbol, Any] or None, optional
        Letter → value, a point that satisfies the premises.
    enclosure : tuple[Rational, Rational] or None, optional
        Two rationals of one sign between which the difference lies there.
    sides : tuple[tuple[Rational, Rational] or None, tuple[Rational, Rational] or None] or None, optional
        The same of the printed and of the derived side; None for a side whose principal value there is not real.
    reason : str, default ''
        Why it does not hold, in words.
    dimensions : Dimensions or None, optional
        What the units of the letters say of it; no verdict rests on them.
    """

    relation: Relation
    verdict: Answer
    premises: tuple[Premise, ...] = ()
    order: int | None = None
    small: sp.Symbol | None = None
    domain: tuple[Relational, ...] = ()
    difference: sp.Expr | None = None
    place: tuple[int, int] | None = None
    witness: Mapping[sp.Symbol, Any] | None = None
    enclosure: tuple[sp.Rational, sp.Rational] | None = None
    sides: tuple[tuple[sp.Rational, sp.Rational] | None, tuple[sp.Rational, sp.Rational] | None] | None = None
    reason: str = ""
    dimensions: Dimensions | None = None


def point_text(line: LineVerdict, sides: tuple[str, str] = ("printed", "derived")) -> str:
    """Return where a line was seen to be wrong, with the values there; empty where it is refuted by its order, or not at all."""
    if line.difference is None or line.enclosure is None or line.relation.within is not None:
        return ""
    shown = ", ".join(f"{readable(str(s))} = {_signed(value)}" for s, value in _point(line).items())
    place = f", entry {line.place[0] + 1}, {line.place[1] + 1}," if line.place else ""
    gap = " − ".join(sides) if all(line.sides or ()) else f"|{' − '.join(sides)}|"  # of sides that are not real
    text = f"{gap}{place} is {_signed(_number(line.enclosure))}" + (f" at {shown}" if shown else "")
    values = [f"{name} {_signed(_number(v))}" for name, v in zip(sides, line.sides or (), strict=False) if v]
    letters = line.relation.printed.free_symbols | line.relation.derived.free_symbols
    return text + (f": {', '.join(values)}" if len(values) == 2 and letters <= (line.witness or {}).keys() else "")


def _signed(number: str) -> str:
    return from_latex(number).replace("-", "−")


def point_tex(line: LineVerdict) -> str:
    """The same in LaTeX."""
    at = _point(line)
    place = rf"_{{{line.place[0] + 1},{line.place[1] + 1}}}" if line.place else ""
    shown = ", ".join(f"{latex(s)} = {value}" for s, value in at.items())
    gap = rf"\left(\text{{printed}} - \text{{derived}}\right){place}"
    return rf"{gap} = {_number(line.enclosure)}\quad\text{{at}}\quad {shown}" if at else ""


def _point(line: LineVerdict) -> dict[Any, str]:
    """The letters of the difference with their values, in five digits."""
    if line.witness is None or line.difference is None or line.relation.within is not None:
        return {}
    free = line.difference.free_symbols
    return {s: _number(value) for s, value in line.witness.items() if s in free}


def _number(value: Any) -> str:
    """Return a number, or two between which it lies, in five digits or as many as are certain."""
    low, high = value if isinstance(value, tuple) else (value, value)
    middle, width = (low + high) / 2, high - low
    certain = 5 if width == 0 or middle == 0 else min(5, max(1, floor(log10(abs(middle / width)))))
    mantissa, _, power = f"{float(middle):.{certain}g}".partition("e")
    return rf"{mantissa}\times 10^{{{int(power)}}}" if power else mantissa


@dataclass(frozen=True)
class Verdict:
    """What was decided of one equation: the weakest of its lines. premises: those under which it holds, or, of a refuted one,
    under which its correction does; `order`, `small`: of a series; `domain`: relations that hold wherever both sides are defined
    and real.

    `reaches_result`: for a refuted equation, whether a result of the paper falls with it (None: not refuted).
    """

    statement: Statement
    verdict: Answer
    premises: tuple[Premise, ...]
    order: int | None
    small: sp.Symbol | None
    domain: tuple[Relational, ...]
    correction_verdict: Answer | None
    evidence: tuple[str, ...]
    seconds: float
    reaches_result: bool | None = None
    lines: tuple[LineVerdict, ...] = ()
    correction_lines: tuple[LineVerdict, ...] = ()

    @property
    def id(self) -> str:
        """The equation's id in the catalogue."""
        return self.statement.id

    @property
    def theorems(self) -> tuple[Theorem, ...]:
        """Those that decide its lines, each once."""
        found = [line.relation.theorem for line in self.lines if line.relation.theorem]
        return tuple(theorem for i, theorem in enumerate(found) if theorem not in found[:i])

    @property
    def refuted_under(self) -> tuple[Premise, ...]:
        """The premises under which refuted lines differ as stated, and under which the remarks on them are true."""
        assumed = [premise for line in self.lines if line.verdict == "refuted" for premise in line.premises]
        return tuple(premise for i, premise in enumerate(assumed) if premise not in assumed[:i])

    @property
    def condition(self) -> str | None:
        """The premises as one sentence; None where nothing was assumed."""
        return "; ".join(premise.sentence for premise in self.premises) or None

    def __repr__(self) -> str:
        head, decided, why = _row(self)
        return "\n  ".join((f"{head}: {decided[0]}", *decided[1:], *why))

    def _repr_html_(self) -> str:
        return verdict_table([self])._repr_html_()


def verdict_table(verdicts: Iterable[Verdict]) -> Table:
    """Verdicts below each other, each with its premises or order, what was wrong and the evidence."""
    return Table("Verdicts", ("equation", "verdict", "why"), tuple(map(_row, verdicts)))


def _row(v: Verdict) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    order = f"through order {v.order} in {readable(str(v.small))}" if v.verdict == "holds-to-order" else ""
    corrected = f"the correction: {v.correction_verdict}" if v.verdict == "refuted" and v.correction_verdict else ""
    where = f"where {', '.join(map(relation_text, v.domain))}" if v.domain and v.verdict in AGREES else ""
    # An equation by itself says which premises were given; in a paper all are.
    given = () if v.id else v.statement.premises
    premises = v.premises if v.verdict in AGREES or v.id else given
    under = (f"as stated if {readable(p.with_formula)}" for p in v.refuted_under if v.id)
    said = "corrected if " if corrected else ""
    ifs = (("under the given premise " if p in given else said) + readable(p.with_formula) for p in premises)
    decided = (v.verdict, *under, *(() if corrected else ifs), order, where, corrected, *(ifs if corrected else ()))
    named = f"{v.id}: {v.statement.title}" if v.id else v.statement.title or _equation(v.statement)
    # What a paper says to be wrong is enough; an equation by itself has the point at which it was seen.
    names = ("printed", "derived") if v.id else ("left", "right")
    seen = () if v.statement.wrong or v.verdict != "refuted" else tuple(point_text(line, names) for line in v.lines)
    return named, tuple(filter(None, decided)), tuple(filter(None, (v.statement.wrong, *v.evidence, *seen)))


def _equation(statement: Statement) -> str:
    """Return the members of the first chain of an equation in plain text."""
    last = statement.relations[0].derived
    return readable(" = ".join(map(str, (*(r.printed for r in statement.relations if r.derived == last), last))))
