"""Relations between a printed and a derived side, statements that collect them for one equation, and the verdicts."""

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
from lagrotor.result_display import ShownInOneLine, text_of

Answer = Literal["holds", "holds-if", "holds-to-order", "proved", "refuted", "measured", "definition", "undecided"]
Side: TypeAlias = Any  # a sympy expression or matrix
AGREES: tuple[Answer, ...] = ("holds", "holds-if", "holds-to-order", "proved")


@dataclass(frozen=True)
class Series:
    """A derived side that is a series. Its terms are known only up to the power small**order.

    Attributes
    ----------
    expression : Any
        The known terms, a sympy expression or matrix.
    small : Symbol
        The variable of the series.
    order : int
        The highest known order. A line that is compared with the series can hold to this order at most.

    Examples
    --------
    >>> from lagrotor.paper import judge
    >>> from sympy import cos, symbols
    >>> x = symbols("x", real=True)
    >>> judge(cos(x), Series(1 - x**2 / 2, x, 3)).verdict
    'holds-to-order'
    """

    expression: Side
    small: sp.Symbol
    order: int


@dataclass(frozen=True)
class Relation:
    """A printed side and the derived side to which it should be equal, exactly, or through small**claimed if `small` is given.

    `quantity` is the LaTeX of the quantity that both sides give. `scene` holds the values that the text gives for this line;
    they count as a premise. For a number read off a simulation, `within` is the relative error that its digits allow, and
    `theorem` decides in place of `derived`. `known` is (variable, highest known order) of a derived series. `written` is the
    derived side, or in a correction the printed one, in a physicist's LaTeX; `granted` is True if this form is equal under the
    premises only.
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
        """The values of `scene` as one premise; an empty tuple if there are none."""
        return (Premise("the values that the text gives", self.scene),) if self.scene else ()

    def under(self, premises: Iterable[Premise]) -> "Relation":
        """Substitute premises into both sides. If a premise is an approximation, the result compares leading terms only."""
        under = hypotheses(premises)
        small = under.small[0] if under.small else self.small
        return replace(self, printed=under.on(self.printed), derived=under.on(self.derived), small=small)


def chain(derived: Side, *printed: Side, small: sp.Symbol | None = None, claimed: int = 0) -> tuple[Relation, ...]:
    """Return one relation for each member of a line `p_1 = p_2 = …`; each member is compared with the derived expression."""
    return tuple(
        Relation(sp.sympify(p, strict=True), sp.sympify(derived, strict=True), small, claimed) for p in printed
    )


@dataclass(frozen=True)
class Statement:
    """One equation of a paper with its printed and derived sides; `id` is empty for an equation that belongs to no paper.

    `relations` has one row for each member of each printed line, and `correction` has the lines that should be printed. `wrong`
    is the error in one sentence, `depends_on` the ids of the equations that this one uses. `names` is True if the line only
    introduces a symbol, `measured` if the line gives a number read off a simulation.
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
            raise InputError(f"verdict: {self.id}: there is nothing to compare: give the derived side")
        where = f"verdict: {self.id}" if self.id else "judge"
        sides = [(r.printed, r.derived, r.small, r.scene) for r in (*self.relations, *self.correction)]
        check_names(where, sides, [(premise.put, premise.where, premise.small) for premise in self.premises])


def unconnected(sides: Any, premises: Iterable[Premise]) -> list[Premise]:
    """Return the premises that share no symbol with the sides, neither directly nor through other premises."""
    connected, waiting = set(symbols_in(sides)), [(p, set(symbols_in((p.put, p.where, p.small)))) for p in premises]
    while near := [letters for _, letters in waiting if letters & connected or not letters]:
        connected.update(*near)
        waiting = [row for row in waiting if row[1] and not row[1] <= connected]
    return [premise for premise, _ in waiting]


def check_premises(sides: Any, premises: Iterable[Premise]) -> None:
    for premise in unconnected(sides, premises):
        raise InputError(
            f"judge: no symbol of the premise {premise.with_formula} is in the equation: use the same symbols in both"
        )


@dataclass(frozen=True, repr=False)
class LineVerdict(ShownInOneLine):
    """The verdict on one member of a printed line, or on one line of a correction.

    Attributes
    ----------
    relation : Relation
        The compared sides.
    verdict : str
        One of the words in `Verdict.verdict`, except 'definition' and 'measured'.
    premises : tuple[Premise, ...], default ()
        The premises that the line needs; if it is refuted, all premises under which `difference` is stated.
    order : int or None, optional
        For a series, the order through which the sides agree.
    small : Symbol or None, optional
        The variable of that series.
    domain : tuple[Relational, ...], default ()
        Relations that hold wherever both sides are defined and real.
    difference : Expr or None, optional
        For a refuted line, printed − derived under the premises. If the sides are matrices it is the entry `place`; if they
        are series it is the coefficient of the first term that differs.
    place : tuple[int, int] or None, optional
        Row and column (from 0) of the matrix entry that differs; None if the sides are no matrices.
    witness : Mapping[Symbol, Any] or None, optional
        A counterexample: the value of each symbol at a point that satisfies the premises.
    enclosure : tuple[Rational, Rational] or None, optional
        Two rationals of one sign that enclose the difference at the witness.
    sides : tuple or None, optional
        Enclosures of the printed and the derived side at the witness; None in place of a side that is not real.
    reason : str, default ''
        The reason in words why the line does not hold or is undecided; empty if it holds.
    dimensions : Dimensions or None, optional
        The dimensional analysis; no verdict depends on it.
    """

    _shown = (
        ("line", lambda v: f"{text_of(v.relation.printed)} = {text_of(v.relation.derived)}"),
        ("verdict", "verdict"),
        ("under", lambda v: "; ".join(premise.says for premise in v.premises)),
        ("left − right", "difference"),
        ("through order", "order"),
        ("reason", "reason"),
    )

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
    """Return the counterexample of a refuted line in words, with the difference and the sides there; empty without one."""
    if line.difference is None or line.enclosure is None or line.relation.within is not None:
        return ""
    point = ", ".join(f"{readable(str(s))} = {_signed(value)}" for s, value in _point(line).items())
    place = f", entry {line.place[0] + 1}, {line.place[1] + 1}," if line.place else ""
    gap = (
        " − ".join(sides) if all(line.sides or ()) else f"|{' − '.join(sides)}|"
    )  # the absolute value, if a side is not real
    text = f"{gap}{place} is {_signed(_number(line.enclosure))}" + (f" at {point}" if point else "")
    values = [f"{name} {_signed(_number(v))}" for name, v in zip(sides, line.sides or (), strict=False) if v]
    letters = line.relation.printed.free_symbols | line.relation.derived.free_symbols
    return text + (f": {', '.join(values)}" if len(values) == 2 and letters <= (line.witness or {}).keys() else "")


def _signed(number: str) -> str:
    return from_latex(number).replace("-", "−")


def point_tex(line: LineVerdict) -> str:
    """Return the counterexample of a refuted line in LaTeX; an empty string if it has none."""
    at = _point(line)
    place = rf"_{{{line.place[0] + 1},{line.place[1] + 1}}}" if line.place else ""
    values = ", ".join(f"{latex(s)} = {value}" for s, value in at.items())
    gap = rf"\left(\text{{printed}} - \text{{derived}}\right){place}"
    return rf"{gap} = {_number(line.enclosure)}\quad\text{{at}}\quad {values}" if at else ""


def _point(line: LineVerdict) -> dict[Any, str]:
    """Return, for each symbol in the difference of a refuted line, its value at the counterexample, in five digits."""
    if line.witness is None or line.difference is None or line.relation.within is not None:
        return {}
    free = line.difference.free_symbols
    return {s: _number(value) for s, value in line.witness.items() if s in free}


def _number(value: Any) -> str:
    """Return a number, or the middle of two bounds, as text in five digits, or in as many as the bounds make certain."""
    low, high = value if isinstance(value, tuple) else (value, value)
    middle, width = (low + high) / 2, high - low
    certain = 5 if width == 0 or middle == 0 else min(5, max(1, floor(log10(abs(middle / width)))))
    mantissa, _, power = f"{float(middle):.{certain}g}".partition("e")
    return rf"{mantissa}\times 10^{{{int(power)}}}" if power else mantissa


@dataclass(frozen=True)
class Verdict:
    """The verdict on one equation: the weakest of the verdicts on its lines.

    Attributes
    ----------
    statement : Statement
        The compared sides.
    verdict : str
        'holds', 'holds-if', 'holds-to-order', 'proved', 'refuted', 'measured', 'definition' or 'undecided'.
    premises : tuple[Premise, ...]
        The premises under which the equation holds; if it is refuted, those under which its correction holds.
    order : int or None
        For a series, the order through which the sides agree.
    small : Symbol or None
        The variable of that series.
    domain : tuple[Relational, ...]
        Relations that hold wherever both sides are defined and real.
    correction_verdict : str or None
        The verdict on the correction; None if there is no correction.
    evidence : tuple[str, ...]
        Sentences with computed numbers and reasons.
    seconds : float
        Computing time in s.
    reaches_result : bool or None, optional
        For a refuted equation, True if a result of the paper depends on it; None if the equation is not refuted.
    lines : tuple[LineVerdict, ...], default ()
        The verdicts on the members of the equation's lines.
    correction_lines : tuple[LineVerdict, ...], default ()
        The verdicts on the lines of the correction.

    Examples
    --------
    >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
    >>> verdict = PAPER.audit("2.01")
    >>> verdict.verdict, [premise.says for premise in verdict.premises]
    ('holds-if', ['the link is massless, m = 0'])
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
        """The theorems that decide lines of the equation, without repetition."""
        theorems = [line.relation.theorem for line in self.lines if line.relation.theorem]
        return tuple(theorem for i, theorem in enumerate(theorems) if theorem not in theorems[:i])

    @property
    def refuted_under(self) -> tuple[Premise, ...]:
        """The premises under which the refuted lines were compared."""
        assumed = [premise for line in self.lines if line.verdict == "refuted" for premise in line.premises]
        return tuple(premise for i, premise in enumerate(assumed) if premise not in assumed[:i])

    @property
    def condition(self) -> str | None:
        """The premises as one sentence; None if there are no premises."""
        return "; ".join(premise.sentence for premise in self.premises) or None

    def __repr__(self) -> str:
        head, decided, why = _row(self)
        return "\n  ".join((f"{head}: {decided[0]}", *decided[1:], *why))

    def _repr_html_(self) -> str:
        return verdict_table([self])._repr_html_()


def verdict_table(verdicts: Iterable[Verdict]) -> Table:
    """Return a table with one row for each verdict: the equation, the verdict with premises and order, error and evidence."""
    return Table("Verdicts", ("equation", "verdict", "why"), tuple(map(_row, verdicts)))


def _row(v: Verdict) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    order = f"through order {v.order} in {readable(str(v.small))}" if v.verdict == "holds-to-order" else ""
    is_corrected = v.verdict == "refuted" and v.correction_verdict
    corrected = f"the verdict on the correction is {v.correction_verdict}" if is_corrected else ""
    where = f"where {', '.join(map(relation_text, v.domain))}" if v.domain and v.verdict in AGREES else ""
    # Of an equation outside a paper the user has given the premises.
    judge_premises = () if v.id else v.statement.premises
    premises = v.premises if v.verdict in AGREES or v.id else judge_premises
    under = (f"refuted under the premise {readable(p.with_formula)}" for p in v.refuted_under if v.id)
    prefix = "the correction holds if " if corrected else ""
    ifs = (("under the given premise " if p in judge_premises else prefix) + readable(p.with_formula) for p in premises)
    decided = (v.verdict, *under, *(() if corrected else ifs), order, where, corrected, *(ifs if corrected else ()))
    named = f"{v.id}: {v.statement.title}" if v.id else v.statement.title or _equation(v.statement)
    # An equation without a description of its error shows the counterexample.
    names = ("printed", "derived") if v.id else ("left", "right")
    points = () if v.statement.wrong or v.verdict != "refuted" else tuple(point_text(line, names) for line in v.lines)
    return named, tuple(filter(None, decided)), tuple(filter(None, (v.statement.wrong, *v.evidence, *points)))


def _equation(statement: Statement) -> str:
    """Return the first chain of an equation as plain text: the printed members, then the derived side."""
    last = statement.relations[0].derived
    return readable(" = ".join(map(str, (*(r.printed for r in statement.relations if r.derived == last), last))))
