"""Premises as one set of hypotheses: their equations solved for letters as far as they are linear, the rest kept as an ideal.

What is decided under a set does not depend on the order or the form of its premises: of all letters that could be eliminated
the same one is taken first each time, one that a premise replaces before others. Every step is an equivalence, where the
letters are real and what is divided by is known not to vanish; so a set is contradictory exactly if what is left of it is, and
a point of what is left satisfies all of it.

`vanishes_on` decides membership in the ideal of the equations that are left, or in its radical. Numerators are read in one ring
of generators, with the relations of these, g² = square, among the equations. The radical is reached by one more letter t and the
equation 1 = t N D (Rabinowitsch), which also leaves out where a denominator D vanishes. Cox, Little & O'Shea, Ideals, Varieties,
and Algorithms, chs. 2, 4. `witness` refutes: it is a point of the hypotheses at which an enclosure keeps the two sides apart.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import chain, islice
from typing import Any, Literal, NamedTuple, TypeAlias

import sympy as sp
from sympy.concrete.expr_with_limits import ExprWithLimits
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational
from sympy.polys.groebnertools import groebner
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.algebra import decide_zero
from lagrotor.algebra.analytic_proofs import evaluated
from lagrotor.algebra.enclosed_roots import enclosed_root
from lagrotor.algebra.enclosures import Bounds, are_apart, enclosure, enclosures
from lagrotor.algebra.evidence import points
from lagrotor.algebra.feasibility import has_principal_values, is_infeasible
from lagrotor.algebra.generators import survey
from lagrotor.algebra.inverses import INVERSES, argument, solved_for
from lagrotor.algebra.numbering import Numbering, canonical_order, without_number
from lagrotor.algebra.reading import find_roots, reader
from lagrotor.algebra.signs import Region, conditions, region, signs
from lagrotor.errors import InputError, NotExactError
from lagrotor.paper.plain_text import readable
from lagrotor.paper.premises import Premise, relation_text

_KINDS = ("positive", "negative", "nonnegative", "nonpositive", "nonzero")


@dataclass(frozen=True)
class Hypotheses:
    """put: letter → what it is, in the letters that are left. left: expressions that are zero. region: conditions that hold.

    small: the small quantities. contradiction: why no values of the letters satisfy all of it; empty where none was found.
    meaning: what the new letters of `signed` are.
    """

    put: Mapping[sp.Symbol, sp.Expr]
    left: tuple[sp.Expr, ...] = ()
    region: tuple[Relational, ...] = ()
    small: tuple[sp.Symbol, ...] = ()
    contradiction: str = ""
    meaning: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def on(self, side: Any) -> Any:
        """A side in the letters that are left."""
        return replaced(sp.sympify(side, strict=True), self.put)

    @cached_property
    def signed(self) -> "Hypotheses":
        """The same set with its inequalities as assumptions of letters, as far as they are linear in one that is free."""
        put, left, meaning = dict(self.put), self.left, dict[sp.Symbol, sp.Expr]()
        order = canonical_order((sp.S.Zero, *self.region, *left))
        for relation in sorted(self.region, key=lambda r: not (r.lhs.is_Symbol and r.rhs == 0)):
            step = _as_assumption(relation.xreplace(put), self.small, order)
            if step is not None:
                letter, value = step
                [new] = value.free_symbols - relation.xreplace(put).free_symbols
                if new.name != letter.name:
                    meaning[new] = sp.expand((letter - value.xreplace({new: sp.S.Zero})) / value.diff(new)).xreplace(
                        meaning
                    )
                put = {old: replaced(new, {letter: value}) for old, new in put.items()} | {letter: value}
                left = tuple(replaced(e, {letter: value}) for e in left)
        there = tuple(relation.xreplace(put) for relation in self.region)
        contradiction = next(
            (f"{relation_text(r)} is false" for r, s in zip(self.region, there, strict=True) if s == sp.false), ""
        )
        relations = tuple(r for r in there if isinstance(r, Relational))
        return Hypotheses(put, left, relations, self.small, self.contradiction or contradiction, meaning)

    @property
    def inside(self) -> tuple[Relational, ...]:
        """The inequalities."""
        return tuple(r for r in self.region if not isinstance(r, sp.Ne))


def replaced(e: Any, put: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """Letters replaced by their values; what a derivative, a sum or an integral binds stays bound."""
    bound = put and e.has(sp.Derivative, ExprWithLimits)
    return e.subs(list(put.items()), simultaneous=True) if bound else e.xreplace(put)


def hypotheses(premises: Iterable[Premise], kept: sp.Symbol | None = None) -> Hypotheses:
    """The premises as one set; `kept` is a letter that is eliminated only where no other can be.

    Its `contradiction` says where two of them, or one and a letter's assumptions, exclude each other.
    """
    listed = list(premises)
    small = tuple(sorted({p.small for p in listed if p.small is not None}, key=sp.default_sort_key))
    equations, region = _collected(listed, small)
    replaced = frozenset(old for p in listed for old in p.put if isinstance(old, sp.Symbol))
    under = _solved(equations, region, small, _Wishes(replaced, kept))
    return under if kept is None or kept in small else replace(under, small=(*small, kept))


class _ContradictionError(Exception):
    """No values of the letters satisfy the premises."""


def _collected(
    premises: list[Premise], small: tuple[sp.Symbol, ...]
) -> tuple[frozenset[sp.Expr], frozenset[Relational]]:
    """Every equation as an expression that is zero, and every condition."""
    equations: set[sp.Expr] = set()
    region: set[Relational] = set()
    for premise in premises:
        for left, right in premise.equations:
            a, b = sp.sympify(left, strict=True), sp.sympify(right, strict=True)
            if not isinstance(a, sp.Expr) or not isinstance(b, sp.Expr):
                raise InputError(f"premise {premise.says!r}: {left!r} = {right!r} is no equation of two expressions")
            if premise.small is not None and a.is_Symbol and a in b.free_symbols:
                b = b.xreplace({a: _scaled(a, premise.small)})
            e, conditions = _without_inverse(a - b)
            equations.add(e)
            region.update(conditions)
        region.update(premise.conditions)
    return frozenset(equations), frozenset(region)


def _scaled(letter: sp.Symbol, small: sp.Symbol) -> sp.Symbol:
    """What a letter that is small is of the small quantity."""
    return sp.Symbol(f"({letter.name}/{small.name})", **letter.assumptions0)


def _without_inverse(e: sp.Expr) -> tuple[sp.Expr, tuple[Relational, ...]]:
    """s − acos(g) as g − cos(s) with 0 ≤ s ≤ π; other equations as they are."""
    for sign in (1, -1):
        terms = sp.Add.make_args(sp.expand(sign * e))
        calls = [t for t in terms if (-t).func in INVERSES]
        rest = sp.Add(*(t for t in terms if t not in calls))
        if len(calls) == 1 and rest.is_Symbol:
            value, conditions = argument((-calls[0]).func, rest)
            return (-calls[0]).args[0] - value, conditions
    return e, ()


class _Wishes(NamedTuple):
    """Which letters are eliminated first where several can be, and which last: for reading only."""

    first: frozenset[sp.Symbol] = frozenset()
    last: sp.Symbol | None = None
    order: tuple[sp.Symbol, ...] = ()

    def rank(self, step: "_Step") -> tuple[Any, ...]:
        """The lowest is taken."""
        number, lossy, operations = step.rank
        place = self.order.index(step.letter)
        return step.letter == self.last, number, lossy, step.letter not in self.first, operations, place


# A set is looked at again for each premise that may be left out of it, and for each line.
@lru_cache(maxsize=512)
def _solved(
    equations: frozenset[sp.Expr], region: frozenset[Relational], small: tuple[sp.Symbol, ...], wishes: _Wishes
) -> Hypotheses:
    try:
        return _solved_or_not(equations, region, small, wishes)
    except _ContradictionError as found:
        return Hypotheses({}, small=small, contradiction=str(found))


def _solved_or_not(
    equations: frozenset[sp.Expr], region: frozenset[Relational], small: tuple[sp.Symbol, ...], wishes: _Wishes
) -> Hypotheses:
    put: dict[sp.Symbol, sp.Expr] = {}
    letters = Numbering(sp.S.Zero, *equations, *region)
    wishes = wishes._replace(order=tuple(letters.symbols))

    def numbered(e: sp.Basic) -> Any:
        return sp.default_sort_key(letters.to_numbered(e))

    conditions = sorted(region, key=numbered)
    strict = sp.Ne | sp.StrictGreaterThan | sp.StrictLessThan
    units = {*small, *(r.lhs - r.rhs for r in conditions if isinstance(r, strict))}
    for e in equations:
        units.update(factor for factor, _ in _factor_list(_denominator(e)))
    waiting = sorted(equations, key=numbered)
    while True:
        steps = [step for e in waiting for step in _plain_steps(e, small)]
        if not steps:
            known = _known(units, conditions, put)
            waiting = list(dict.fromkeys(e for each in waiting if (e := _reduced(each, known)) is not None))
            steps = [step for e in waiting for step in _steps(e, small, known)]
        if not steps:
            break
        _, letter, value, own = min(steps, key=wishes.rank)
        conditions += [*own, *_own_conditions(letter, value)]
        put = {old: replaced(new, {letter: value}) for old, new in put.items()} | {letter: value}
        waiting = [e for each in waiting if (e := replaced(each, {letter: value})) != 0]
    return Hypotheses(put, tuple(waiting), tuple(_checked(conditions, put, waiting, small)), small)


def _denominator(e: sp.Expr) -> sp.Expr:
    return sp.Mul(*(term.as_numer_denom()[1] for term in sp.Add.make_args(e)))


class _Known(NamedTuple):
    """Expressions that do not vanish, with their opposites, and where all conditions hold."""

    units: frozenset[sp.Expr]
    where: Region

    def nonzero(self, e: sp.Expr) -> bool:
        """Return whether e does not vanish."""
        if e in self.units or sp.expand(e) in self.units:
            return True
        found = signs(e, self.where)
        return found is not None and 0 not in found


def _known(units: Iterable[sp.Expr], conditions: Iterable[Relational], put: Mapping[sp.Symbol, sp.Expr]) -> _Known:
    there = [r.xreplace(put) for r in conditions if not isinstance(r, sp.Ne)]
    opposites = (sp.expand(sign * u.xreplace(put)) for u in units for sign in (1, -1))
    return _Known(frozenset(u for u in opposites if not u.is_number), region(r for r in there if r is not sp.false))


@lru_cache(maxsize=2048)
def _reduced(e: sp.Expr, known: _Known) -> sp.Expr | None:
    """An equation without factors that do not vanish; None where it holds by itself."""
    if e.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise _ContradictionError("a denominator becomes 0")
    factors: dict[sp.Expr, None] = {}
    for factor, _ in _factor_list(sp.together(e).as_numer_denom()[0]):
        if not known.nonzero(factor):
            factors[factor] = None
    kept = sp.expand(sp.Mul(*factors))
    if kept.is_number or decide_zero(kept).answer == "zero":
        if not factors or (kept != 0 and decide_zero(kept).answer != "zero"):
            raise _ContradictionError(f"{readable(str(e))} is not 0")
        return None
    return min(kept, sp.expand(-kept), key=sp.default_sort_key)


def _factor_list(e: sp.Expr) -> list[tuple[sp.Expr, int]]:
    try:
        number, factors = sp.factor_list(e)
        return factors or [(number, 1)]
    except sp.PolynomialError:
        return [(e, 1)]


class _Step(NamedTuple):
    """A letter that an equation gives, and its value; of all steps that of the lowest rank is taken."""

    rank: tuple[Any, ...]
    letter: sp.Symbol
    value: sp.Expr
    conditions: tuple[Relational, ...] = ()


@lru_cache(maxsize=2048)
def _plain_steps(e: sp.Expr, small: tuple[sp.Symbol, ...]) -> tuple[_Step, ...]:
    """Those of letters that stand in a term by themselves, with a number before them, and nowhere else in the equation."""
    terms, found = sp.Add.make_args(e), []
    for term in terms:
        number, letter = term.as_coeff_Mul()
        if letter.is_Symbol and letter not in small and all(t is term or letter not in t.free_symbols for t in terms):
            found.append(_step(letter, -(e - term) / number))
    return tuple(found)


@lru_cache(maxsize=2048)
def _steps(e: sp.Expr, small: tuple[sp.Symbol, ...], known: _Known) -> tuple[_Step, ...]:
    """Those of letters that an equation is linear in, or in one function of which, their coefficient known not to vanish."""
    found = []
    for letter in e.free_symbols - set(small):
        kernel = _kernel(e, letter)
        if kernel is None:
            continue
        unknown = letter if kernel == letter else sp.Dummy()
        there = e if kernel == letter else e.xreplace({kernel: unknown})
        coefficient = sp.expand(there.diff(unknown))
        if coefficient.has(letter, unknown, sp.Derivative, sp.Subs):
            continue
        if not (coefficient.is_number or all(known.nonzero(f) for f, _ in _factor_list(coefficient))):
            continue
        rest = sp.expand(there.xreplace({unknown: sp.S.Zero}))
        if rest.has(sp.nan, sp.zoo, sp.oo, letter) or (rest != 0 and coefficient.free_symbols & set(small)):
            continue
        value = sp.cancel(-rest / coefficient)
        if kernel == letter:
            found.append(_step(letter, value))
        elif (inverted := solved_for(kernel, letter, value, known.where)) is not None:
            found.append(_step(letter, *inverted))
    return tuple(found)


def _kernel(e: sp.Expr, letter: sp.Symbol) -> sp.Expr | None:
    """The letter where an equation is a polynomial of degree one in it; else the one function or power of it there is."""
    inside = {node for node in sp.preorder_traversal(e) if letter in node.args and not (node.is_Add or node.is_Mul)}
    if not inside:
        return letter
    [kernel] = inside if len(inside) == 1 else [None]
    alone = kernel is not None and kernel.free_symbols == {letter} and not e.xreplace({kernel: sp.S.One}).has(letter)
    return kernel if alone else None


def _step(letter: sp.Symbol, value: sp.Expr, conditions: tuple[Relational, ...] = ()) -> _Step:
    """Numbers first, then values that have the signs that the letter was declared with, then short ones."""
    lossy = len(_own_conditions(letter, value)) + len(conditions)
    return _Step((not value.is_number, lossy, sp.count_ops(value)), letter, value, conditions)


def _own_conditions(letter: sp.Symbol, value: sp.Expr) -> list[Relational]:
    """What the letter's assumptions say of its value, where the value's own do not say it. Raises where they exclude it."""
    found: list[Relational] = []
    tests = {
        "positive": (letter.is_positive, value.is_positive, lambda v: v > 0),
        "negative": (letter.is_negative, value.is_negative, lambda v: v < 0),
        "nonnegative": (letter.is_nonnegative, value.is_nonnegative, lambda v: v >= 0),
        "nonpositive": (letter.is_nonpositive, value.is_nonpositive, lambda v: v <= 0),
        "nonzero": (letter.is_nonzero, value.is_nonzero, lambda v: sp.Ne(v, 0)),
        "real": (letter.is_real, value.is_real, None),
        "integer": (letter.is_integer, value.is_integer, None),
    }
    for name, (declared, known, condition) in tests.items():
        if declared and known is False:
            raise _ContradictionError(f"{letter} = {value}, and {letter} is declared {name}")
        if declared and known is None and condition is not None and not found:
            relation = condition(value)  # type: ignore[no-untyped-call]
            if isinstance(relation, Relational):
                found.append(relation)
    return found


def _checked(
    relations: list[Relational], put: Mapping[sp.Symbol, sp.Expr], left: list[sp.Expr], small: tuple[sp.Symbol, ...]
) -> Iterator[Relational]:
    """The conditions in the letters that are left, each once; raises where they and the equations left exclude each other."""
    found: dict[Relational, None] = {}
    for relation in relations:
        try:
            there = relation.xreplace(put)
        except TypeError:
            raise _ContradictionError(f"{relation_text(relation)} is not real") from None
        if there == sp.false:
            raise _ContradictionError(f"{relation_text(relation)} is false")
        if isinstance(there, Relational):
            if isinstance(there, sp.Ne) and decide_zero(there.lhs - there.rhs).answer == "zero":
                raise _ContradictionError(f"{relation_text(relation)} is false")
            found[there] = None
    inequalities = [r for r in found if not isinstance(r, sp.Ne)]
    if is_infeasible(left, region(inequalities), small):
        all_of_it = (*(f"{readable(str(e))} = 0" for e in left), *map(relation_text, inequalities))
        near = f" near {', '.join(map(str, small))} = 0" if small else ""
        raise _ContradictionError(f"no values of the letters satisfy {' and '.join(all_of_it)}{near}")
    yield from found


def _as_assumption(
    relation: Any, small: tuple[sp.Symbol, ...], order: list[sp.Symbol]
) -> tuple[sp.Symbol, sp.Expr] | None:
    """A letter and its value by a new letter whose assumption is the condition: x ≥ 1 is x = 1 + u, u nonnegative."""
    if not isinstance(relation, sp.Ge | sp.Gt | sp.Le | sp.Lt):
        return None
    e = sp.expand(relation.gts - relation.lts)
    strict = isinstance(relation, sp.StrictGreaterThan | sp.StrictLessThan)
    places = {letter: place for place, letter in enumerate(order)}
    for letter in sorted(e.free_symbols, key=lambda s: (_declared(s), places.get(s, len(order)))):
        slope = sp.expand(e.diff(letter))
        if not slope.is_Rational or slope == 0 or letter.is_integer:
            continue
        kind = {"positive": True} if strict else {"nonnegative": True}
        rest = sp.expand(e - slope * letter)
        if letter in small and rest != 0:
            continue  # what is small stays a letter, of one sign at most
        new = sp.Symbol(letter.name if rest == 0 and slope > 0 else f"({e})", **kind)
        value = (new - rest) / slope
        try:
            if _own_conditions(letter, value):
                continue
        except _ContradictionError:
            continue
        return letter, sp.expand(value)
    return None


def _declared(s: sp.Symbol) -> int:
    """How many signs the letter was declared with: those with none are taken first."""
    return sum(bool(getattr(s, f"is_{kind}")) for kind in _KINDS)


# Bases of more, larger or higher polynomials may take hours.
_MOST_EQUATIONS, _MOST_TERMS, _MOST_DEGREE, _MOST_LETTERS = 6, 60, 6, 9


Answer = Literal["zero", "nonzero", "nowhere", "undecided"]


def vanishes_on(difference: sp.Expr, equations: Sequence[sp.Expr], apart: Sequence[sp.Expr] = ()) -> Answer:
    """Whether the difference is zero wherever every equation is, and neither a denominator nor an expression of `apart`.

    "nowhere": there is no such place, even over the complex numbers. "nonzero": it is not in the radical over the complex
    numbers; of real letters that alone refutes nothing.
    """
    try:
        numerator, relations, units = _in_one_ring(difference, list(equations), list(apart))
    except NotExactError:
        return "undecided"
    found = _used([numerator, *units], relations)
    if found is None:
        return "undecided"
    ring, (target, *others), ideal = found
    order = ring.clone(order=grevlex)
    basis = groebner([p.set_ring(order) for p in ideal], order)
    one_more = PolyRing([*sp.symbols(f"g:{ring.ngens}"), sp.Symbol("t")], ring.domain, grevlex)

    def empty(factors: list[PolyElement]) -> bool:
        """Whether no point of the equations is off the zeros of all factors."""
        product = one_more.gens[-1]
        for p in factors:
            product *= p.set_ring(order).set_ring(one_more)
            if len(product) > 4 * _MOST_TERMS:
                raise NotExactError("The denominators are too large.")
        return bool(groebner([*(p.set_ring(one_more) for p in basis), product - 1], one_more) == [one_more.one])

    try:
        if basis == [order.one] or empty(others):
            return "nowhere"
        return "zero" if not target.set_ring(order).rem(basis) or empty([target, *others]) else "nonzero"
    except NotExactError:
        return "undecided"


def _in_one_ring(
    difference: sp.Expr, equations: list[sp.Expr], apart: list[sp.Expr]
) -> tuple[PolyElement, list[PolyElement], list[PolyElement]]:
    """The numerators of the difference and of the equations, with the relations of the generators, and what is not zero."""
    together = [difference, *equations, *apart]
    found = survey(sp.Add(*(sp.Dummy() * e for e in together)))
    roots = find_roots(found)
    if roots.unsigned:
        raise NotExactError("The sign of a root may differ from region to region.")
    reading = reader(found, roots)
    ring = reading.ring
    quotients = [reading.quotient(e) for e in together]
    squares = [ring.polynomials.gens[i] ** 2 - square for i, square in ring.squares.items()]
    numerators = [q.numerator for q in quotients]
    factors = {f for q in quotients for f in q.factors}
    n = 1 + len(equations)
    return numerators[0], [*numerators[1:n], *squares], [*numerators[n:], *factors]


def _used(
    targets: list[PolyElement], relations: list[PolyElement]
) -> tuple[PolyRing, list[PolyElement], list[PolyElement]] | None:
    """All of them in a ring of the generators that occur; None where they are too many or too large.

    A generator in no relation that is at most a factor of each target, as the m of m (…), decides nothing and is left out.
    """
    everything = [*targets, *relations]
    powers = [[{m[i] for m in p.itermonoms()} for p in everything] for i in range(targets[0].ring.ngens)]
    used = [
        i for i, sets in enumerate(powers) if any(map(any, sets[len(targets) :])) or any(len(each) > 1 for each in sets)
    ] or [*range(targets[0].ring.ngens)]
    sizes = [(len(p), max(map(sum, p.itermonoms()), default=0)) for p in everything]
    if len(relations) > _MOST_EQUATIONS + len(used) or len(used) > _MOST_LETTERS:
        return None
    if any(terms > _MOST_TERMS or degree > _MOST_DEGREE for terms, degree in sizes[len(targets) :]):
        return None
    if sizes[0][0] > 4 * _MOST_TERMS or sizes[0][1] > 2 * _MOST_DEGREE:
        return None
    ring = PolyRing(sp.symbols(f"g:{len(used)}"), sp.QQ)
    moved = [ring.from_dict({tuple(m[i] for i in used): c for m, c in p.iterterms()}) for p in everything]
    return ring, moved[: len(targets)], moved[len(targets) :]


Values: TypeAlias = dict[sp.Symbol, Any]  # letter → an exact value, or two rationals between which it lies
_POINTS, _CHECKED = 40, 2


@dataclass(frozen=True)
class Witness:
    """A point, two rationals of one sign between which the difference of the sides lies, and those of each side there.

    sides: of the printed and of the derived side; None where principal values are meant and that of a side is not real.
    """

    point: Values
    enclosure: Bounds
    sides: tuple[Bounds | None, Bounds | None]


def witness(
    sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr = sp.S.Zero, principal: bool = False
) -> Witness | None:
    """Return a point where the hypotheses hold, both sides are real and |left − right| > beyond ≥ 0; None without one.

    principal: of sides with i or complex letters, and of sides that are real nowhere, principal values count; the absolute
    value of the difference is then enclosed.
    """
    there = sp.Tuple(*map(under.on, sides))
    real = replace(under, region=tuple(dict.fromkeys((*under.region, *conditions(there)))))
    found = _apart(sides, real, beyond, False) if sp.false not in real.region else None
    if found is None and principal and has_principal_values(there, under.left, region(under.inside)):
        return _apart(sides, under, beyond, True)
    return found


def _apart(sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr, principal: bool) -> Witness | None:
    """Return a point of the hypotheses that keeps the sides apart."""
    signed = under.signed
    both = tuple(signed.on(side) for side in sides)
    difference = sides[0] - sides[1]
    e = evaluated(signed.on(difference))
    if signed.contradiction or _says_more(e, signed):
        return None
    for values in _points((e, *both), signed):
        between = enclosure(e, values)
        if principal and between is None:
            between = enclosure(sp.Abs(e, evaluate=False), values)
        if between is not None and (between[0] > beyond or between[1] < -beyond):
            left, right = enclosures(map(evaluated, both), values)
            if principal or (left and right):
                return Witness(_of_letters(difference, under, signed, values), between, (left, right))
    return None


def contradicted(left: Any, right: Any, under: Hypotheses) -> Values | None:
    """Return a point of the hypotheses that keeps two real sides apart that were decided to be equal; None as it should be.

    The sides are enclosed as they came: nothing is put into them.
    """
    signed = under.signed
    for a, b in zip(*(side if isinstance(side, sp.MatrixBase) else [side] for side in (left, right)), strict=True):
        for values in islice(_points([signed.on(a), signed.on(b)], signed), _CHECKED):
            if are_apart(a, b, {**signed.put, **values}):
                return values
    return None


def _says_more(e: sp.Expr, signed: Hypotheses) -> bool:
    """Return whether an equation about a function may fix a derivative of it, or an equation that is left holds one."""
    given = sp.Tuple(*signed.left, *signed.put.values())
    new = e.atoms(sp.Derivative) - given.atoms(sp.Derivative)
    functions = given.atoms(AppliedUndef)
    return any(x.has(AppliedUndef) for x in signed.left) or any(d.has(*functions) for d in new if functions)


def _points(compared: Sequence[sp.Expr], signed: Hypotheses) -> Iterator[Values]:
    """Points of the letters that are left which satisfy all that the hypotheses say."""
    conditions = *signed.left, *signed.region
    order = canonical_order((without_number(compared[0])[1], *compared[1:], *conditions))
    letters = [s for s in order if any(s in x.free_symbols for x in (*compared, *conditions))]
    scales = (1, 2) if signed.region else (1,)
    for at in chain(*(islice(points(letters, _POINTS, sp.Integer(scale)), _POINTS) for scale in scales)):
        values: Values = dict(at)
        if signed.left:
            box = enclosed_root(signed.left, unknowns, at) if (unknowns := _unknowns(signed, order)) else None
            if box is None:
                continue
            values |= box
        if _as_declared(values) and all(_satisfied(relation, values) for relation in signed.region):
            yield values


def _unknowns(signed: Hypotheses, order: list[sp.Symbol]) -> list[sp.Symbol]:
    """A letter for each equation that is left, each once, of those that are in the fewest; empty where there are too few."""
    found: list[sp.Symbol] = []
    for e in sorted(signed.left, key=lambda e: len(e.free_symbols)):
        free = sorted(e.free_symbols - set(found) - set(signed.small), key=order.index)
        if not free:
            return []
        found.append(free[0])
    return found


def _as_declared(values: Values) -> bool:
    """Return whether the letters that an equation fixes have the signs that they were declared with."""
    return all(
        not ((s.is_extended_nonnegative and v[0] <= 0) or (s.is_extended_nonpositive and v[1] >= 0) or s.is_integer)
        for s, v in values.items()
        if isinstance(v, tuple)
    )


def _satisfied(relation: Relational, values: Values) -> bool:
    """Return whether a condition certainly holds at a point."""
    between = enclosure(sp.sympify(relation.lhs - relation.rhs, strict=True), values)
    if between is None:
        return False
    low, high = between
    if isinstance(relation, sp.StrictGreaterThan | sp.StrictLessThan):
        return bool(low > 0 if isinstance(relation, sp.StrictGreaterThan) else high < 0)
    if isinstance(relation, sp.GreaterThan | sp.LessThan):
        return bool(low >= 0 if isinstance(relation, sp.GreaterThan) else high <= 0)
    return bool(low > 0 or high < 0)


def _of_letters(difference: sp.Expr, under: Hypotheses, signed: Hypotheses, values: Values) -> Values:
    """The point in the letters of the statement: what was eliminated has its value, too."""
    exact = {s: v for s, v in values.items() if not isinstance(v, tuple)}
    found: Values = {}
    for letter in sorted(difference.free_symbols | set(under.put), key=sp.default_sort_key):
        value = signed.on(letter)
        if value in values:
            found[letter] = values[value]
        elif value.free_symbols <= set(exact):
            found[letter] = replaced(value, exact)
        elif (between := enclosure(value, values)) is not None:
            found[letter] = between
    return found
