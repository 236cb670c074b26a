"""The ledger, which compares printed lines with derived sides and decides whether they agree.

A derivation never says that an equation is right; it states the derived side by `equation_statements.verdict`. Each member of a
printed line is decided under all premises at once (`hypotheses`): by exact identity, by the ideal of the premises' equations,
or by the order of the first term that differs. Premises that are not needed are then omitted. A refuted line has a certified
counterexample, or an order at which the sides differ; every other line is undecided. `judge` does the same without a paper.
"""

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import sympy as sp
from sympy.core.relational import Relational

from lagrotor.algebra import LeadingTerm, decide_equal, leading_term, normal_form, truncated_series
from lagrotor.algebra.branches import sided
from lagrotor.algebra.identity import differ
from lagrotor.algebra.scalar import sympified
from lagrotor.algebra.signs import is_positive
from lagrotor.errors import InputError, LagrotorError, NotExactError
from lagrotor.mechanics.glossary import Glossary
from lagrotor.paper.grammar import read
from lagrotor.paper.hypotheses import Hypotheses, contradicted, hypotheses, vanishes_on, witness
from lagrotor.paper.plain_text import readable
from lagrotor.paper.premises import Assumptions, Premise, premises_of, relation_text
from lagrotor.paper.units import Dimensions, dimensions
from lagrotor.paper.verdicts import AGREES, Answer, LineVerdict, Relation, Series, Statement, Verdict, check_premises
from lagrotor.renamed import accept_old_keywords

# Orders beyond the claimed one through which series are compared.
BEYOND = 4
# A difference with more symbols is not simplified; a fraction with a larger denominator is shown in digits.
_MOST_LETTERS, _LARGEST_DENOMINATOR = 7, 100
_SINGULAR = (type(sp.nan), type(sp.zoo), type(sp.oo), type(-sp.oo))
_RANK: tuple[Answer, ...] = ("proved", "holds", "holds-if", "holds-to-order", "undecided", "refuted")


@accept_old_keywords
def judge(
    printed: Any, derived: Any, premises: Assumptions = (), small: sp.Symbol | None = None, order: int = 0
) -> Verdict:
    """Judge a printed expression against a derived one.

    Parameters
    ----------
    printed : Expr, Matrix or str
        A sympy object, or text in the names of the symbols of `derived` and `premises`.
    derived : Expr, Matrix or Series
        A sympy object, or a `Series` of known order.
    premises : Relational, Mapping, Premise or Iterable, default ()
        The assumptions in any order and form: Eq(a, b), x >= 0, Ne(a, b), {J: I_3}, a Premise, or several of these.
    small : Symbol or None, optional
        The variable of the series, if equality is claimed through small**order only.
    order : int, default 0
        The order in `small` through which equality is claimed.

    Returns
    -------
    Verdict
        The verdict, with the premises that are needed or a counterexample.

    Raises
    ------
    InputError
        If the text cannot be read, or if a premise is none of these types.

    Examples
    --------
    >>> from sympy import Symbol, cos, sqrt
    >>> x = Symbol("x", real=True)
    >>> judge(sqrt(x**2), x, premises=x >= 0).verdict
    'holds-if'
    >>> judge(cos(x), 1 - x**2 / 2, small=x, order=3).order
    3
    >>> judge("2*cos(x)", cos(2 * x)).lines[0].difference
    2*cos(x) - cos(2*x)
    """
    right, premise_list = derived if isinstance(derived, Series) else sympified(derived, "judge"), premises_of(premises)
    if small is not None and not isinstance(small, sp.Symbol):
        raise InputError(f"judge: small = {small!r} must be a symbol that occurs in the expressions")
    if not isinstance(order, int | sp.Integer) or order < 0:
        raise InputError(f"judge: order = {order!r} must be a whole number from 0 on")
    side = right.expression if isinstance(right, Series) else right
    if isinstance(printed, str):
        sides = [sp.sympify(s, strict=True) for p in premise_list for pair in p.equations for s in pair]
        sides += [side for p in premise_list for r in p.conditions for side in r.args]
        letters = {s.name: s for e in (side, *sides, *filter(None, [small])) for s in e.free_symbols}
        printed = read(printed, letters, "judge")
    known_order = (right.small, right.order) if isinstance(right, Series) else None
    statement = Statement(
        "", (Relation(sympified(printed, "judge"), side, small, order, known=known_order),), premise_list
    )
    check_premises([printed, side, small], premise_list)
    return decide(statement)


def decide(statement: Statement, glossary: Glossary | None = None) -> Verdict:
    """Return the verdict on a statement and its correction; `glossary` gives the units for the dimensional analysis."""
    began = time.perf_counter()
    meanings = Glossary() if glossary is None else glossary
    lines, right = (
        tuple(
            replace(
                _line(relation, statement.premises, meanings), dimensions=_dimensions(relation, statement, meanings)
            )
            for relation in relations
        )
        for relations in (statement.relations, statement.correction)
    )
    worst = _weakest(lines)
    answer: Answer = "definition" if statement.names else worst.verdict
    corrected = _weakest(right).verdict if right else None
    if statement.measured and answer in AGREES and answer != "proved":
        answer = "measured"
    used = right if answer == "refuted" else lines if answer in (*AGREES, "measured") else ()
    return Verdict(
        statement=statement,
        verdict=answer,
        premises=_union(used, statement.premises),
        order=worst.order,
        small=worst.small,
        domain=tuple(dict.fromkeys(relation for line in lines for relation in line.domain)),
        correction_verdict=corrected,
        evidence=(
            *statement.evidence,
            *dict.fromkeys(line.reason for line in lines if line.reason and line.verdict == answer),
        ),
        seconds=time.perf_counter() - began,
        lines=lines,
        correction_lines=right,
    )


def _dimensions(relation: Relation, statement: Statement, glossary: Glossary) -> Dimensions | None:
    """Return the dimensional analysis of a line; None if the glossary is empty."""
    assumed = (*statement.premises, *relation.scene_premises)
    values = {
        sp.sympify(old, strict=True): sp.sympify(new, strict=True)
        for premise in assumed
        for old, new in premise.equations
    }
    return dimensions(relation.printed, relation.derived, glossary, values) if glossary else None


def _weakest(lines: Sequence[LineVerdict]) -> LineVerdict:
    nothing = LineVerdict(Relation(sp.S.Zero, sp.S.Zero), "holds")
    return max(lines, key=lambda line: (_RANK.index(line.verdict), -(line.order or 0)), default=nothing)


def _union(lines: Iterable[LineVerdict], offered: tuple[Premise, ...]) -> tuple[Premise, ...]:
    """Return the premises that the lines need, without repetition: first the offered ones, in the order of `offered`."""
    needed = [premise for line in lines for premise in line.premises]
    union: list[Premise] = [premise for premise in offered if premise in needed]
    for premise in needed:
        if premise not in union:
            union.append(premise)
    return tuple(union)


def _line(relation: Relation, offered: tuple[Premise, ...], glossary: Glossary) -> LineVerdict:
    """Return the verdict on one equation of a printed line; of the offered premises it assumes only those that it needs."""
    if relation.theorem is not None and relation.theorem.bounds is not None:
        return _verdict(relation, _enclosed(relation, *relation.theorem.bounds), (), glossary)
    assumed = (*offered, *relation.scene_premises)
    if _under(relation, (), refute=False).answer == "holds":
        return _verdict(relation, _under(relation, ()), (), glossary)
    whole = _under(relation, assumed)
    if whole.answer in AGREES:
        used, finding = _needed(relation, assumed, whole)
        if circular := next((p for p in used if _is_conclusion(relation, p)), None):
            reason = f"circular: the premise is the conclusion, {circular.with_formula}"
            return _verdict(relation, replace(finding, answer="undecided", reasons=(reason,)), (), glossary)
        if finding.trivial:
            reason = f"trivial: under the premises ({'; '.join(p.with_formula for p in used)}) both sides are 0"
            return _verdict(relation, replace(finding, answer="undecided", reasons=(reason,)), (), glossary)
        return _verdict(relation, finding, used, glossary)
    if whole.may_branch and (branch := _branch(relation, assumed)):
        used, finding = _needed(relation, (*assumed, *branch), _under(relation, (*assumed, *branch)))
        return _verdict(relation, finding, used, glossary)
    return _verdict(relation, whole, assumed if whole.answer == "refuted" else (), glossary)


def _verdict(relation: Relation, finding: "_Finding", used: tuple[Premise, ...], glossary: Glossary) -> LineVerdict:
    answer: Answer = finding.answer
    small = finding.small
    if answer == "holds-to-order" and small is not None and all(premise.small != small for premise in used):
        used = (*used, Premise(f"small {glossary.meaning(small)} {small}", small=small))
    if answer == "holds" and used:
        answer = "holds-if"
    return LineVerdict(
        relation,
        answer,
        used,
        finding.order,
        small,
        finding.domain,
        None if finding.difference is None else _shortest(finding.difference),
        finding.place,
        finding.counterexample.point if finding.counterexample else None,
        finding.counterexample.enclosure if finding.counterexample else None,
        finding.counterexample.sides if finding.counterexample else None,
        "; ".join(finding.reasons),
    )


@dataclass(frozen=True)
class _Finding:
    """The decision on a relation under given premises.

    `trivial` is True if both sides become 0, `may_branch` if the sign of a root may decide.
    """

    answer: Answer
    order: int | None = None
    small: sp.Symbol | None = None
    domain: tuple[Relational, ...] = ()
    reasons: tuple[str, ...] = ()
    difference: sp.Expr | None = None
    place: tuple[int, int] | None = None
    counterexample: Any = None
    trivial: bool = False
    may_branch: bool = False


def _needed(relation: Relation, assumed: tuple[Premise, ...], whole: _Finding) -> tuple[tuple[Premise, ...], _Finding]:
    """Return a minimal set of premises, from which none can be omitted, and the decision under it."""
    # The result must not depend on the order in which the premises are given.
    ordered = sorted(assumed, key=lambda p: (len(p.equations), p.says, p.formula))
    # A set under which both sides are 0 is the last choice.
    minimal_sets: list[tuple[tuple[Premise, ...], _Finding]] = []
    for row in (ordered, ordered[::-1]):
        needed, finding = list(assumed), whole
        for premise in row:
            remaining = [p for p in needed if p is not premise]
            without = _under(relation, remaining, refute=False)
            if without.answer in AGREES and _RANK.index(without.answer) <= _RANK.index(finding.answer):
                if without.trivial and not finding.trivial:
                    continue
                needed, finding = remaining, without
        minimal_sets.append((tuple(needed), finding))
    used, _ = min(
        minimal_sets, key=lambda candidate: (candidate[1].trivial, len(candidate[0]), candidate[1].answer != "holds")
    )
    return used, whole if len(used) == len(assumed) else _under(relation, used)


def _is_conclusion(relation: Relation, premise: Premise) -> bool:
    """Return True if the premise is the line itself: their differences, left − right, are multiples of each other."""
    if premise.small is not None or premise.defines:
        return False
    equations = [
        e for a, b in premise.equations if sp.expand(e := sp.sympify(a, strict=True) - sp.sympify(b, strict=True)) != 0
    ]
    gap = relation.printed - relation.derived
    is_multiple = False
    for entry in gap if isinstance(gap, sp.MatrixBase) else [gap]:
        if any(_are_multiples(entry, e) for e in equations):
            is_multiple = True
        elif not equations or sp.expand(entry) != 0:
            return False
    return is_multiple


def _are_multiples(a: sp.Expr, b: sp.Expr) -> bool:
    """Return True if a is a rational multiple of the numerator of b; the denominator of a must be a number."""
    if a == 0 or a.free_symbols != b.free_symbols:
        return False
    above, below = sp.together(a).as_numer_denom()
    if below.free_symbols:
        return False
    primitive_a, primitive_b = (
        sp.expand(e).as_content_primitive()[1] for e in (above, sp.together(b).as_numer_denom()[0])
    )
    return 0 in (sp.expand(primitive_a - primitive_b), sp.expand(primitive_a + primitive_b))


def _branch(relation: Relation, assumed: tuple[Premise, ...]) -> tuple[Premise, ...]:
    """Return as premises the conditions on the sign of a root under which the line is proved; empty if there are none."""
    under = hypotheses(assumed)
    exact = decide_equal(under.on(relation.printed), under.on(relation.derived), under.inside)
    branch = tuple(Premise(relation_text(condition), where=(condition,)) for condition in exact.branch)
    on_branch = _under(relation, (*assumed, *branch)) if branch else None
    is_proved = on_branch is not None and on_branch.answer in AGREES and not on_branch.trivial
    return branch if is_proved and all(_has_room(condition, assumed) for condition in exact.branch) else ()


def _has_room(condition: Relational, assumed: tuple[Premise, ...]) -> bool:
    """Return True if a point of the premises satisfies a condition strictly, not only at its edge, where a root is 0."""
    inside = sp.StrictGreaterThan(condition.gts, condition.lts)
    return not isinstance(inside, Relational) or bool(
        witness((sp.S.One, sp.S.Zero), hypotheses((*assumed, Premise("inside", where=(inside,)))))
    )


def _under(relation: Relation, premises: Iterable[Premise], refute: bool = True) -> _Finding:
    """Decide a relation under all the given premises.

    If `refute` is False, only the answers of lines that agree are certain, and a series has no domain.
    """
    under = hypotheses(premises, relation.small)
    if under.signed.contradiction:
        reason = f"the premises contradict each other or the assumptions of their symbols: {under.signed.contradiction}"
        return _Finding("undecided", reasons=(reason,))
    if isinstance(relation.printed, sp.MatrixBase) != isinstance(relation.derived, sp.MatrixBase):
        kinds = ("a vector", "a number") if isinstance(relation.derived, sp.MatrixBase) else ("a number", "a vector")
        return _Finding("refuted", reasons=("the left side is {}, the printed right side {}".format(*kinds),))
    printed, derived = (under.signed.on(side) for side in (relation.printed, relation.derived))
    if printed.has(sp.Limit) or derived.has(sp.Limit):
        return _Finding("undecided", reasons=("a side contains a limit, and limits are not decided",))
    if _is_singular(relation.printed) or _is_singular(relation.derived):
        return _Finding("undecided", reasons=("a side contains an infinite or undefined value",))
    if _is_singular(printed) or _is_singular(derived):
        return _Finding("undecided", reasons=("the premises contradict the domain: they make a denominator 0",))
    if relation.within is not None and relation.known is not None:
        return _read_off_series(relation, printed / derived, *relation.known, under)
    if relation.within is not None:
        return _read_off(relation, printed, derived, under)
    small = _small(relation, printed, derived, under)
    if not refute and not under.signed.equations and differ(printed, derived, under.signed.inside):
        return _Finding("undecided") if small is None else _to_order(relation, printed, derived, small, (), under)
    return _compared(relation, printed, derived, small, under, refute)


def _compared(
    relation: Relation, printed: Any, derived: Any, small: sp.Symbol | None, under: Hypotheses, refute: bool
) -> _Finding:
    exact = decide_equal(printed, derived, under.signed.inside)
    factors = (f for f in exact.domain if not (is_positive(f) or f.is_number))
    domain = tuple(sp.Ne(factor, 0, evaluate=False) for factor in factors)
    if exact.answer == "zero":
        domain += exact.branch
    domain = tuple(_in_printed_symbols(relation, under.signed) for relation in domain)
    on_equations = _in_ideal(printed, derived, under)
    if on_equations == "nowhere":
        return _Finding("undecided", reasons=("the premises contradict each other or the domain of the sides",))
    if exact.answer == "zero" or on_equations == "zero":
        if refute and (at := contradicted(relation.printed, relation.derived, under)) is not None:
            both = f"{relation.printed} and {relation.derived}"
            raise LagrotorError(f"{both} were decided to be equal, but differ at {at}: report this error of lagrotor")
        trivial = _is_trivial(relation, under.signed)
        if relation.known is not None:
            return _Finding("holds-to-order", relation.known[1], relation.known[0], domain, trivial=trivial)
        return _Finding("holds", domain=domain, trivial=trivial)
    if "denominator vanishes" in exact.reason:
        return _Finding("undecided", reasons=("the premises contradict the domain: they make a denominator 0",))
    if small is not None:
        return _to_order(relation, printed, derived, small, domain, under)
    place, sides = _where_apart(relation, under)
    gap = sides[0] - sides[1] if sides else None
    counterexample = witness(sides, under, principal=exact.answer == "nonzero") if sides else None
    if counterexample is not None:
        return _Finding("refuted", None, None, domain, (), gap, place, counterexample, may_branch=exact.partly)
    value = "" if exact.evidence is None else f" (at random points left − right is at most {exact.evidence:.3g})"
    reason = f"{exact.reason}{value}" if exact.answer == "undecided" else "no counterexample could be certified"
    return _Finding("undecided", None, None, domain, (reason,), gap, place, may_branch=True)


def _in_printed_symbols(relation: Relational, signed: Hypotheses) -> Relational:
    """Return a relation in the printed symbols, which replace the new symbols of `Hypotheses.signed`."""
    substituted = relation.xreplace(signed.meaning)
    if substituted == relation or isinstance(substituted, sp.Ne):
        return substituted
    return sided(
        sp.expand(substituted.gts - substituted.lts), isinstance(substituted, sp.StrictGreaterThan | sp.StrictLessThan)
    )


def _shortest(difference: sp.Expr) -> sp.Expr:
    """Return a difference or its normal form, whichever is shorter as text."""
    if len(difference.free_symbols) > _MOST_LETTERS:
        return difference
    try:
        return min(normal_form(difference), difference, key=lambda e: len(str(e)))
    except NotExactError:
        return difference


def _text(difference: sp.Expr) -> str:
    """Return a difference as text. If a number in it is not a short fraction, all numbers get four digits."""
    e = _shortest(difference)
    is_long = any(n.is_Rational and n.q > _LARGEST_DENOMINATOR for n in e.atoms(sp.Number)) or any(
        node.is_number and not node.is_Rational for node in sp.preorder_traversal(e)
    )
    return readable(str(sp.N(e, 4) if is_long else e))


def _small(relation: Relation, printed: Any, derived: Any, under: Hypotheses) -> sp.Symbol | None:
    """Return the symbol in which the sides are compared as series, from a premise or from the line; None if there is none."""
    letters = printed.free_symbols | derived.free_symbols
    series_symbol = relation.known[0] if relation.known else None
    candidates = (*under.small, relation.small, series_symbol)
    return next((s for s in candidates if s is not None and under.signed.on(s).free_symbols & letters), None)


def _is_singular(side: Any) -> bool:
    """Return True if a part of the side has no finite value; the limits of sums and integrals may be infinite."""
    if isinstance(side, sp.MatrixBase):
        return any(map(_is_singular, side))
    if isinstance(side, sp.Sum | sp.Integral):
        return _is_singular(side.function)
    return isinstance(side, _SINGULAR) or any(map(_is_singular, side.args))


def _is_zero(side: Any) -> bool:
    return all(sp.expand(e) == 0 for e in (side if isinstance(side, sp.MatrixBase) else [side]))


def _is_trivial(relation: Relation, signed: Hypotheses) -> bool:
    """Return True if the premises make every term of both sides zero. This is never so for an equation Q = 0."""
    sides = [relation.printed, relation.derived]
    entries = (e for side in sides for e in (side if isinstance(side, sp.MatrixBase) else [side]))
    return all(_is_zero(signed.on(term)) for e in entries for term in sp.Add.make_args(e)) and not any(
        map(_is_zero, sides)
    )


def _in_ideal(printed: Any, derived: Any, under: Hypotheses) -> str:
    """Return the answer of `vanishes_on`: whether printed − derived vanishes wherever the unsolved equations hold."""
    signed = under.signed
    if not signed.equations:
        return "undecided"
    gap = printed - derived
    apart = [r.lhs - r.rhs for r in signed.region if isinstance(r, sp.Ne | sp.StrictGreaterThan | sp.StrictLessThan)]
    answers = {vanishes_on(e, signed.equations, apart) for e in (gap if isinstance(gap, sp.MatrixBase) else [gap])}
    return next((answer for answer in ("nowhere", "nonzero", "undecided") if answer in answers), "zero")


def _where_apart(
    relation: Relation, under: Hypotheses
) -> tuple[tuple[int, int] | None, tuple[sp.Expr, sp.Expr] | None]:
    """Find the first entry of two matrices that is not proved to be equal.

    Return its row and column, and both sides there in the symbols of the statement. For scalars the place is None.
    """
    printed, derived = under.on(relation.printed), under.on(relation.derived)
    if not isinstance(printed, sp.MatrixBase):
        return None, (printed, derived)
    pairs = list(zip(printed, derived, strict=True))
    for answer in ("nonzero", "undecided"):
        for i, pair in enumerate(pairs):
            if decide_equal(*pair).answer == answer:
                return divmod(i, printed.cols), pair
    return None, None


def _enclosed(relation: Relation, low: sp.Rational, high: sp.Rational) -> _Finding:
    """Decide a printed number by the bounds `low` and `high` of a theorem, to the accuracy of the printed digits."""
    tolerance = relation.within or sp.S.Zero
    printed = sp.Rational(str(relation.printed)) if relation.printed.is_Float else relation.printed
    if not printed.is_Rational or low > high or low * high <= 0:
        return _Finding(
            "undecided", reasons=("a theorem decides only a printed number, by two bounds of the same sign",)
        )
    errors = [printed / end - 1 for end in (low, high)]
    if all(abs(error) <= tolerance for error in errors):
        return _Finding("proved")
    where = f"between {sp.N(low, 12)} and {sp.N(high, 12)}"
    if min(errors) > tolerance or max(errors) < -tolerance:
        return _Finding("refuted", reasons=(f"a theorem encloses it {where}",), difference=printed - (low + high) / 2)
    return _Finding("undecided", reasons=(f"a theorem encloses it {where}, which is too wide to decide the digits",))


def _read_off(relation: Relation, printed: Any, derived: Any, under: Hypotheses) -> _Finding:
    """Decide a number that the paper read off a simulation, to the accuracy of its digits."""
    tolerance = relation.within if relation.within is not None else sp.S.Zero
    ratio = _constant(printed / derived, under)
    if ratio is not None:
        error = abs(ratio - 1)
        near = bool(error <= tolerance)
        reason = f"the printed value is {sp.N(ratio, 6)} times the derived one; its digits allow {sp.N(100 * tolerance, 2)} %"
        gap = None if near else printed - derived
        return _Finding("holds" if near else "refuted", reasons=() if near else (reason,), difference=gap)
    gap = under.on(relation.printed) / under.on(relation.derived) - 1
    counterexample = witness((gap, sp.S.Zero), under, tolerance)
    if counterexample is None:
        return _Finding(
            "undecided", reasons=("printed/derived depends on symbols, and no counterexample could be certified",)
        )
    return _Finding(
        "refuted", reasons=("printed/derived is not constant",), difference=gap, counterexample=counterexample
    )


def _read_off_series(relation: Relation, ratio: sp.Expr, small: sp.Symbol, order: int, under: Hypotheses) -> _Finding:
    """Decide a printed rate against a derived series: the ratio of the sides must be constant through the known order."""
    tolerance = relation.within if relation.within is not None else sp.S.Zero
    try:
        terms = truncated_series(ratio, small, order)
    except NotExactError as refusal:
        return _Finding("undecided", reasons=(str(refusal),))
    fixed, changing = terms.as_independent(small, as_Add=True)
    first, constant = leading_term(changing, small, order), _constant(fixed, under)
    if first.order is not None:
        by = _text(first.coefficient)
        reason = (
            f"printed/derived is not constant: order {first.order} in {readable(str(small))} has the coefficient {by}"
        )
        return _Finding("refuted", first.vanishes_through, small, reasons=(reason,), difference=first.coefficient)
    if constant is None:
        return _Finding("undecided", reasons=("printed/derived depends on symbols",))
    near = bool(abs(constant - 1) <= tolerance)
    reason = (
        f"the printed value is {sp.N(constant, 6)} times the derived one; its digits allow {sp.N(100 * tolerance, 2)} %"
    )
    return _Finding("holds-to-order" if near else "refuted", order, small, reasons=() if near else (reason,))


def _constant(ratio: sp.Expr, under: Hypotheses) -> sp.Expr | None:
    """Return a ratio of rates as a number, which may contain roots; None if its value or sign depends on a symbol."""
    square = sp.cancel(ratio**2)
    if not square.is_number:
        return None
    root, inside = sp.sqrt(square), under.signed.inside
    if ratio.is_positive:
        return root
    return next(
        (candidate for candidate in (root, -root) if decide_equal(ratio, candidate, inside).answer == "zero"), None
    )


def _to_order(
    relation: Relation, printed: Any, derived: Any, small: sp.Symbol, domain: tuple[Relational, ...], under: Hypotheses
) -> _Finding:
    """Decide through which order two series agree. For vectors the component that differs at the lowest order decides."""
    pairs = list(zip(printed, derived, strict=True)) if isinstance(printed, sp.MatrixBase) else [(printed, derived)]
    name, known_order = readable(str(small)), relation.known[1] if relation.known else None
    furthest = relation.claimed + BEYOND if known_order is None else min(relation.claimed + BEYOND, known_order)
    try:
        terms = [_first_term(p - d, small, furthest, under) for p, d in pairs]
        place, first = min(enumerate(terms), key=lambda t: t[1].through + 1 if t[1].order is None else t[1].order)
        reached = first.vanishes_through
        lead = _leading_order(pairs, small, furthest, under)
    except NotExactError as refusal:
        return _Finding("undecided", reasons=(str(refusal),))
    if lead is None:
        reason = f"both sides vanish through order {furthest} in {name}, so that nothing was compared"
        return _Finding("undecided", None, small, domain, (reason,))
    if reached >= relation.claimed and (first.order is None or first.order > lead):
        return _Finding("holds-to-order", reached, small, domain)
    if first.order is None:
        reason = f"the derived side is known through order {furthest} in {name}, but the line claims order {relation.claimed}"
        return _Finding("undecided", reached, small, domain, (reason,))
    reason = f"the sides first differ at order {first.order} in {name}; the coefficient is {_text(first.coefficient)}"
    if lead > relation.claimed:
        reason = f"both sides vanish through order {ceil(lead) - 1} in {name}; {reason}"
    at = divmod(place, printed.cols) if isinstance(printed, sp.MatrixBase) else None
    if (under.signed.equations or under.signed.region) and witness((first.coefficient, sp.S.Zero), under) is None:
        reason = f"no counterexample could be certified at order {first.order} in {name}"
        return _Finding("undecided", None, small, domain, (reason,), first.coefficient, at)
    return _Finding("refuted", reached, small, domain, (reason,), first.coefficient, at)


def _first_term(side: sp.Expr, small: sp.Symbol, through: int, under: Hypotheses) -> LeadingTerm:
    """Return the leading term of a series, skipping coefficients that vanish wherever the unsolved equations hold."""
    sign, letter = under.signed.on(small).as_coeff_Mul()  # a condition may fix the sign of the small quantity
    if any(letter in e.free_symbols for e in under.signed.equations):
        raise NotExactError(f"a premise that is not linear determines {small}, so that there is no series in {small}")
    while True:
        term = leading_term(side, letter, through)
        if term.order is None:
            return term
        if _in_ideal(term.coefficient, sp.S.Zero, under) != "zero":
            return replace(term, coefficient=term.coefficient * sign**term.order)
        side -= term.coefficient * letter**term.order


def _leading_order(
    pairs: list[tuple[Any, Any]], small: sp.Symbol, through: int, under: Hypotheses
) -> int | sp.Rational | None:
    """Return the lowest order at which one of the sides has a term; None if all vanish through order `through`."""
    for limit in (0, through):
        orders = [_first_term(side, small, limit, under).order for pair in pairs for side in pair]
        if known_orders := [order for order in orders if order is not None]:
            return min(known_orders)
    return None
