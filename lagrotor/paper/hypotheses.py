"""The premises of an equation as one set of hypotheses.

Equations that are linear in a symbol are solved for it; the other equations generate an ideal of polynomials. A decision does
not depend on the order or the form of the premises, because the symbols are eliminated in a fixed order. Every step is an
equivalence for real symbols and divisors that do not vanish. The set is therefore contradictory exactly if the remaining
equations and conditions are. A point that satisfies these satisfies the whole set.

`vanishes_on` decides membership in the ideal of the unsolved equations, or in its radical. All numerators lie in one ring of
generators g; if g is a root, g² = square is among the equations. The radical needs one more variable t and the equation 1 = t N
D (Rabinowitsch), which also excludes the zeros of a denominator D: Cox, Little & O'Shea, Ideals, Varieties, and Algorithms,
chs. 2, 4. `witness` refutes by a point of the hypotheses at which enclosures separate the two sides.
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
    """The premises of an equation, combined into one set.

    `values` gives each eliminated symbol in terms of the remaining ones. `equations` are the remaining expressions that are
    zero, `region` the conditions that hold, `small` the small quantities. `contradiction` says in words why no point satisfies
    the set; it is empty otherwise. `meaning` gives the new symbols that `signed` introduces in terms of the old ones.
    """

    values: Mapping[sp.Symbol, sp.Expr]
    equations: tuple[sp.Expr, ...] = ()
    region: tuple[Relational, ...] = ()
    small: tuple[sp.Symbol, ...] = ()
    contradiction: str = ""
    meaning: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def on(self, side: Any) -> Any:
        """Return a side of an equation in terms of the remaining symbols."""
        return replaced(sp.sympify(side, strict=True), self.values)

    @cached_property
    def signed(self) -> "Hypotheses":
        """The same set, with inequalities that are linear in a free symbol turned into assumptions of symbols."""
        values, equations, meaning = dict(self.values), self.equations, dict[sp.Symbol, sp.Expr]()
        order = canonical_order((sp.S.Zero, *self.region, *equations))
        for relation in sorted(self.region, key=lambda r: not (r.lhs.is_Symbol and r.rhs == 0)):
            step = _as_assumption(relation.xreplace(values), self.small, order)
            if step is not None:
                letter, value = step
                [new] = value.free_symbols - relation.xreplace(values).free_symbols
                if new.name != letter.name:
                    meaning[new] = sp.expand((letter - value.xreplace({new: sp.S.Zero})) / value.diff(new)).xreplace(
                        meaning
                    )
                values = {old: replaced(new, {letter: value}) for old, new in values.items()} | {letter: value}
                equations = tuple(replaced(e, {letter: value}) for e in equations)
        substituted = tuple(relation.xreplace(values) for relation in self.region)
        contradiction = next(
            (f"{relation_text(r)} is false" for r, s in zip(self.region, substituted, strict=True) if s == sp.false), ""
        )
        relations = tuple(r for r in substituted if isinstance(r, Relational))
        return Hypotheses(values, equations, relations, self.small, self.contradiction or contradiction, meaning)

    @property
    def inside(self) -> tuple[Relational, ...]:
        """The conditions with <, ≤, > or ≥, without those of the form a ≠ b."""
        return tuple(r for r in self.region if not isinstance(r, sp.Ne))


def replaced(e: Any, values: Mapping[sp.Symbol, sp.Expr]) -> Any:
    """Replace symbols by their values; symbols bound by a derivative, a sum or an integral stay."""
    bound = values and e.has(sp.Derivative, ExprWithLimits)
    return e.subs(list(values.items()), simultaneous=True) if bound else e.xreplace(values)


def hypotheses(premises: Iterable[Premise], last: sp.Symbol | None = None) -> Hypotheses:
    """Combine premises into one set. The symbol `last` is eliminated only if no other symbol can be."""
    listed = list(premises)
    small = tuple(sorted({p.small for p in listed if p.small is not None}, key=sp.default_sort_key))
    equations, region = _collected(listed, small)
    replaced = frozenset(old for p in listed for old in p.put if isinstance(old, sp.Symbol))
    under = _eliminate_or_contradict(equations, region, small, _Wishes(replaced, last))
    return under if last is None or last in small else replace(under, small=(*small, last))


class _ContradictionError(Exception):
    """The error that no values of the symbols satisfy the premises; its message says why."""


def _collected(
    premises: list[Premise], small: tuple[sp.Symbol, ...]
) -> tuple[frozenset[sp.Expr], frozenset[Relational]]:
    """Return the equations of all premises, as expressions that are zero, and their conditions."""
    equations: set[sp.Expr] = set()
    region: set[Relational] = set()
    for premise in premises:
        for lhs, rhs in premise.equations:
            a, b = sp.sympify(lhs, strict=True), sp.sympify(rhs, strict=True)
            if not isinstance(a, sp.Expr) or not isinstance(b, sp.Expr):
                raise InputError(
                    f"premise {premise.says!r}: {lhs!r} = {rhs!r} does not equate two expressions: write each component"
                )
            if premise.small is not None and a.is_Symbol and a in b.free_symbols:
                b = b.xreplace({a: _scaled(a, premise.small)})
            e, conditions = _without_inverse(a - b)
            equations.add(e)
            region.update(conditions)
        region.update(premise.conditions)
    return frozenset(equations), frozenset(region)


def _scaled(letter: sp.Symbol, small: sp.Symbol) -> sp.Symbol:
    """Return a symbol that stands for letter/small, the ratio of a small symbol to the small quantity."""
    return sp.Symbol(f"({letter.name}/{small.name})", **letter.assumptions0)


def _without_inverse(e: sp.Expr) -> tuple[sp.Expr, tuple[Relational, ...]]:
    """Turn an equation s = acos(g), or one with asin or atan, into g = cos(s) with a range of s, here 0 ≤ s ≤ π.

    Return it as an expression that is zero, with the conditions on the range. Other equations are returned unchanged.
    """
    for sign in (1, -1):
        terms = sp.Add.make_args(sp.expand(sign * e))
        calls = [t for t in terms if (-t).func in INVERSES]
        remainder = sp.Add(*(t for t in terms if t not in calls))
        if len(calls) == 1 and remainder.is_Symbol:
            value, conditions = argument((-calls[0]).func, remainder)
            return (-calls[0]).args[0] - value, conditions
    return e, ()


class _Wishes(NamedTuple):
    """The symbols to be eliminated first and last. The choice affects only how readable results are."""

    first: frozenset[sp.Symbol] = frozenset()
    last: sp.Symbol | None = None
    order: tuple[sp.Symbol, ...] = ()

    def rank(self, step: "_Step") -> tuple[Any, ...]:
        """Return the sort key of an elimination step; the step with the lowest key is taken."""
        number, lossy, operations = step.rank
        place = self.order.index(step.letter)
        return step.letter == self.last, number, lossy, step.letter not in self.first, operations, place


# The same set occurs for each premise that may be omitted, and for each line.
@lru_cache(maxsize=512)
def _eliminate_or_contradict(
    equations: frozenset[sp.Expr], region: frozenset[Relational], small: tuple[sp.Symbol, ...], wishes: _Wishes
) -> Hypotheses:
    try:
        return _eliminate(equations, region, small, wishes)
    except _ContradictionError as error:
        return Hypotheses({}, small=small, contradiction=str(error))


def _eliminate(
    equations: frozenset[sp.Expr], region: frozenset[Relational], small: tuple[sp.Symbol, ...], wishes: _Wishes
) -> Hypotheses:
    values: dict[sp.Symbol, sp.Expr] = {}
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
            domain = _known(units, conditions, values)
            waiting = list(dict.fromkeys(e for equation in waiting if (e := _reduced(equation, domain)) is not None))
            steps = [step for e in waiting for step in _steps(e, small, domain)]
        if not steps:
            break
        _, letter, value, step_conditions = min(steps, key=wishes.rank)
        conditions += [*step_conditions, *_implied_conditions(letter, value)]
        values = {old: replaced(new, {letter: value}) for old, new in values.items()} | {letter: value}
        waiting = [e for equation in waiting if (e := replaced(equation, {letter: value})) != 0]
    return Hypotheses(values, tuple(waiting), tuple(_consistent_conditions(conditions, values, waiting, small)), small)


def _denominator(e: sp.Expr) -> sp.Expr:
    return sp.Mul(*(term.as_numer_denom()[1] for term in sp.Add.make_args(e)))


class _Known(NamedTuple):
    """The knowledge about signs: expressions that do not vanish, with their opposites, and the region of the conditions."""

    units: frozenset[sp.Expr]
    where: Region

    def nonzero(self, e: sp.Expr) -> bool:
        """Return True if the conditions prove that e does not vanish."""
        if e in self.units or sp.expand(e) in self.units:
            return True
        sign_set = signs(e, self.where)
        return sign_set is not None and 0 not in sign_set


def _known(units: Iterable[sp.Expr], conditions: Iterable[Relational], values: Mapping[sp.Symbol, sp.Expr]) -> _Known:
    substituted = [r.xreplace(values) for r in conditions if not isinstance(r, sp.Ne)]
    opposites = (sp.expand(sign * u.xreplace(values)) for u in units for sign in (1, -1))
    return _Known(
        frozenset(u for u in opposites if not u.is_number), region(r for r in substituted if r is not sp.false)
    )


@lru_cache(maxsize=2048)
def _reduced(e: sp.Expr, domain: _Known) -> sp.Expr | None:
    """Divide an equation by its factors that do not vanish. Return None if it holds identically; raise if it cannot hold."""
    if e.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise _ContradictionError("they make a denominator 0")
    factors: dict[sp.Expr, None] = {}
    for factor, _ in _factor_list(sp.together(e).as_numer_denom()[0]):
        if not domain.nonzero(factor):
            factors[factor] = None
    remainder = sp.expand(sp.Mul(*factors))
    if remainder.is_number or decide_zero(remainder).answer == "zero":
        if not factors or (remainder != 0 and decide_zero(remainder).answer != "zero"):
            raise _ContradictionError(f"{readable(str(e))} is not 0")
        return None
    return min(remainder, sp.expand(-remainder), key=sp.default_sort_key)


def _factor_list(e: sp.Expr) -> list[tuple[sp.Expr, int]]:
    try:
        number, factors = sp.factor_list(e)
        return factors or [(number, 1)]
    except sp.PolynomialError:
        return [(e, 1)]


class _Step(NamedTuple):
    """An elimination step: a symbol that an equation determines, its value, and the conditions on which the value is right."""

    rank: tuple[Any, ...]
    letter: sp.Symbol
    value: sp.Expr
    conditions: tuple[Relational, ...] = ()


@lru_cache(maxsize=2048)
def _plain_steps(e: sp.Expr, small: tuple[sp.Symbol, ...]) -> tuple[_Step, ...]:
    """Return a step for each symbol that occurs in one term of the equation only, multiplied by a number."""
    terms, steps = sp.Add.make_args(e), []
    for term in terms:
        number, letter = term.as_coeff_Mul()
        if letter.is_Symbol and letter not in small and all(t is term or letter not in t.free_symbols for t in terms):
            steps.append(_step(letter, -(e - term) / number))
    return tuple(steps)


@lru_cache(maxsize=2048)
def _steps(e: sp.Expr, small: tuple[sp.Symbol, ...], domain: _Known) -> tuple[_Step, ...]:
    """Return the steps that solve an equation, linear in a symbol or in one function of it, for the symbol."""
    steps = []
    for letter in e.free_symbols - set(small):
        kernel = _kernel(e, letter)
        if kernel is None:
            continue
        unknown = letter if kernel == letter else sp.Dummy()
        linear = e if kernel == letter else e.xreplace({kernel: unknown})
        coefficient = sp.expand(linear.diff(unknown))
        if coefficient.has(letter, unknown, sp.Derivative, sp.Subs):
            continue
        if not (coefficient.is_number or all(domain.nonzero(f) for f, _ in _factor_list(coefficient))):
            continue
        remainder = sp.expand(linear.xreplace({unknown: sp.S.Zero}))
        if remainder.has(sp.nan, sp.zoo, sp.oo, letter) or (remainder != 0 and coefficient.free_symbols & set(small)):
            continue
        value = sp.cancel(-remainder / coefficient)
        if kernel == letter:
            steps.append(_step(letter, value))
        elif (inverted := solved_for(kernel, letter, value, domain.where)) is not None:
            steps.append(_step(letter, *inverted))
    return tuple(steps)


def _kernel(e: sp.Expr, letter: sp.Symbol) -> sp.Expr | None:
    """Return the expression in which an equation may be linear, None if there is none.

    This is the symbol x, or its function or power, such as sin x or x², if x occurs nowhere else.
    """
    inside = {node for node in sp.preorder_traversal(e) if letter in node.args and not (node.is_Add or node.is_Mul)}
    if not inside:
        return letter
    [kernel] = inside if len(inside) == 1 else [None]
    alone = kernel is not None and kernel.free_symbols == {letter} and not e.xreplace({kernel: sp.S.One}).has(letter)
    return kernel if alone else None


def _step(letter: sp.Symbol, value: sp.Expr, conditions: tuple[Relational, ...] = ()) -> _Step:
    """Return an elimination step. Numbers rank first, then values that add no condition, then short values."""
    lossy = len(_implied_conditions(letter, value)) + len(conditions)
    return _Step((not value.is_number, lossy, sp.count_ops(value)), letter, value, conditions)


def _implied_conditions(letter: sp.Symbol, value: sp.Expr) -> list[Relational]:
    """Return the conditions on `value` that follow from the assumptions of `letter`; raise if the value violates them."""
    relations: list[Relational] = []
    tests = {
        "positive": (letter.is_positive, value.is_positive, lambda v: v > 0),
        "negative": (letter.is_negative, value.is_negative, lambda v: v < 0),
        "nonnegative": (letter.is_nonnegative, value.is_nonnegative, lambda v: v >= 0),
        "nonpositive": (letter.is_nonpositive, value.is_nonpositive, lambda v: v <= 0),
        "nonzero": (letter.is_nonzero, value.is_nonzero, lambda v: sp.Ne(v, 0)),
        "real": (letter.is_real, value.is_real, None),
        "integer": (letter.is_integer, value.is_integer, None),
    }
    for name, (declared, value_sign, condition) in tests.items():
        if declared and value_sign is False:
            raise _ContradictionError(f"{letter} = {value}, and {letter} is declared {name}")
        if declared and value_sign is None and condition is not None and not relations:
            relation = condition(value)  # type: ignore[no-untyped-call]
            if isinstance(relation, Relational):
                relations.append(relation)
    return relations


def _consistent_conditions(
    relations: list[Relational],
    values: Mapping[sp.Symbol, sp.Expr],
    equations: list[sp.Expr],
    small: tuple[sp.Symbol, ...],
) -> Iterator[Relational]:
    """Yield the conditions in the remaining symbols, without repetition. Raise if they contradict the remaining equations."""
    reduced: dict[Relational, None] = {}
    for relation in relations:
        try:
            substituted = relation.xreplace(values)
        except TypeError:
            raise _ContradictionError(f"{relation_text(relation)} is not real") from None
        if substituted == sp.false:
            raise _ContradictionError(f"{relation_text(relation)} is false")
        if isinstance(substituted, Relational):
            if isinstance(substituted, sp.Ne) and decide_zero(substituted.lhs - substituted.rhs).answer == "zero":
                raise _ContradictionError(f"{relation_text(relation)} is false")
            reduced[substituted] = None
    inequalities = [r for r in reduced if not isinstance(r, sp.Ne)]
    if is_infeasible(equations, region(inequalities), small):
        all_of_it = (*(f"{readable(str(e))} = 0" for e in equations), *map(relation_text, inequalities))
        near = f" near {', '.join(map(str, small))} = 0" if small else ""
        raise _ContradictionError(f"no values of the symbols satisfy {' and '.join(all_of_it)}{near}")
    yield from reduced


def _as_assumption(
    relation: Any, small: tuple[sp.Symbol, ...], order: list[sp.Symbol]
) -> tuple[sp.Symbol, sp.Expr] | None:
    """Turn a condition into an assumption: return a symbol and its value in a new symbol.

    For x ≥ 1 the value is x = 1 + u with the assumption u ≥ 0. Return None if the condition is not linear in a symbol.
    """
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
        remainder = sp.expand(e - slope * letter)
        if letter in small and remainder != 0:
            continue  # the variable of a series must remain a symbol
        new = sp.Symbol(letter.name if remainder == 0 and slope > 0 else f"({e})", **kind)
        value = (new - remainder) / slope
        try:
            if _implied_conditions(letter, value):
                continue
        except _ContradictionError:
            continue
        return letter, sp.expand(value)
    return None


def _declared(s: sp.Symbol) -> int:
    """Return how many assumptions on its sign a symbol has; symbols without any are taken first."""
    return sum(bool(getattr(s, f"is_{kind}")) for kind in _KINDS)


# Gröbner bases of more, larger or higher polynomials may take hours.
_MOST_EQUATIONS, _MOST_TERMS, _MOST_DEGREE, _MOST_LETTERS = 6, 60, 6, 9


Answer = Literal["zero", "nonzero", "nowhere", "undecided"]


def vanishes_on(difference: sp.Expr, equations: Sequence[sp.Expr], apart: Sequence[sp.Expr] = ()) -> Answer:
    """Decide whether the difference vanishes wherever the equations hold and denominators and `apart` do not vanish.

    Return "zero" if it vanishes at all these points, and "nowhere" if there are none, even over the complex numbers. Return
    "nonzero" if it does not vanish at a complex point; real symbols may still make it vanish.
    """
    try:
        numerator, relations, units = _in_one_ring(difference, list(equations), list(apart))
    except NotExactError:
        return "undecided"
    system = _in_small_ring([numerator, *units], relations)
    if system is None:
        return "undecided"
    ring, (target, *others), ideal = system
    order = ring.clone(order=grevlex)
    basis = groebner([p.set_ring(order) for p in ideal], order)
    one_more = PolyRing([*sp.symbols(f"g:{ring.ngens}"), sp.Symbol("t")], ring.domain, grevlex)

    def empty(factors: list[PolyElement]) -> bool:
        """Return True if the product of the factors vanishes at every point of the equations."""
        product = one_more.gens[-1]
        for p in factors:
            product *= p.set_ring(order).set_ring(one_more)
            if len(product) > 4 * _MOST_TERMS:
                raise NotExactError("The product of the denominators has too many terms.")
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
    """Write all expressions as polynomials in common generators.

    Return the numerator of the difference, the polynomials that are zero, and those that are not. The second are the numerators
    of the equations and the squares of roots, the third the denominators and the numerators of `apart`.
    """
    together = [difference, *equations, *apart]
    generators = survey(sp.Add(*(sp.Dummy() * e for e in together)))
    roots = find_roots(generators)
    if roots.unsigned:
        raise NotExactError("The sign of a root may differ from region to region.")
    reading = reader(generators, roots)
    ring = reading.ring
    quotients = [reading.quotient(e) for e in together]
    squares = [ring.polynomials.gens[i] ** 2 - square for i, square in ring.squares.items()]
    numerators = [q.numerator for q in quotients]
    factors = {f for q in quotients for f in q.factors}
    n = 1 + len(equations)
    return numerators[0], [*numerators[1:n], *squares], [*numerators[n:], *factors]


def _in_small_ring(
    targets: list[PolyElement], relations: list[PolyElement]
) -> tuple[PolyRing, list[PolyElement], list[PolyElement]] | None:
    """Return a ring of the generators that matter and the polynomials in it; None if these are too many or large."""
    everything = [*targets, *relations]
    # A generator that is only a common factor of a target, as m in m (…), decides nothing.
    powers = [[{m[i] for m in p.itermonoms()} for p in everything] for i in range(targets[0].ring.ngens)]
    used = [
        i
        for i, sets in enumerate(powers)
        if any(map(any, sets[len(targets) :])) or any(len(exponents) > 1 for exponents in sets)
    ] or [*range(targets[0].ring.ngens)]
    sizes = [(len(p), max(map(sum, p.itermonoms()), default=0)) for p in everything]
    if len(relations) > _MOST_EQUATIONS + len(used) or len(used) > _MOST_LETTERS:
        return None
    if any(terms > _MOST_TERMS or degree > _MOST_DEGREE for terms, degree in sizes[len(targets) :]):
        return None
    if sizes[0][0] > 4 * _MOST_TERMS or sizes[0][1] > 2 * _MOST_DEGREE:
        return None
    ring = PolyRing(sp.symbols(f"g:{len(used)}"), sp.QQ)
    polynomials = [ring.from_dict({tuple(m[i] for i in used): c for m, c in p.iterterms()}) for p in everything]
    return ring, polynomials[: len(targets)], polynomials[len(targets) :]


Values: TypeAlias = dict[sp.Symbol, Any]  # letter → an exact value, or two rationals between which it lies
_POINTS, _CHECKED = 40, 2


@dataclass(frozen=True)
class Witness:
    """A counterexample: a point, and bounds there of the difference and of each side (None if that is not real)."""

    point: Values
    enclosure: Bounds
    sides: tuple[Bounds | None, Bounds | None]


def witness(
    sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr = sp.S.Zero, principal: bool = False
) -> Witness | None:
    """Return a point of the hypotheses at which both sides are real and |left − right| > beyond ≥ 0; None if none is found.

    If `principal` is True, a side may be complex: its principal value is then used, and |left − right| is enclosed.
    """
    substituted = sp.Tuple(*map(under.on, sides))
    real = replace(under, region=tuple(dict.fromkeys((*under.region, *conditions(substituted)))))
    result = _separating_point(sides, real, beyond, False) if sp.false not in real.region else None
    if result is None and principal and has_principal_values(substituted, under.equations, region(under.inside)):
        return _separating_point(sides, under, beyond, True)
    return result


def _separating_point(
    sides: tuple[sp.Expr, sp.Expr], under: Hypotheses, beyond: sp.Expr, principal: bool
) -> Witness | None:
    """Return a point of the hypotheses at which enclosures prove that the sides differ; None if none is found."""
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
            lhs, rhs = enclosures(map(evaluated, both), values)
            if principal or (lhs and rhs):
                return Witness(_point_in_symbols(difference, under, signed, values), between, (lhs, rhs))
    return None


def contradicted(printed: Any, derived: Any, under: Hypotheses) -> Values | None:
    """Return a point at which two sides differ that were proved to be equal; None unless there is such a bug."""
    signed = under.signed
    for a, b in zip(*(side if isinstance(side, sp.MatrixBase) else [side] for side in (printed, derived)), strict=True):
        for values in islice(_points([signed.on(a), signed.on(b)], signed), _CHECKED):
            if are_apart(a, b, {**signed.values, **values}):
                return values
    return None


def _says_more(e: sp.Expr, signed: Hypotheses) -> bool:
    """Return True if a point is no counterexample because the premises concern functions.

    This is so if a remaining equation contains a function, or if a premise may determine a derivative in `e`.
    """
    premises = sp.Tuple(*signed.equations, *signed.values.values())
    new = e.atoms(sp.Derivative) - premises.atoms(sp.Derivative)
    functions = premises.atoms(AppliedUndef)
    return any(x.has(AppliedUndef) for x in signed.equations) or any(d.has(*functions) for d in new if functions)


def _points(compared: Sequence[sp.Expr], signed: Hypotheses) -> Iterator[Values]:
    """Yield points, as values of the remaining symbols, that satisfy all hypotheses."""
    conditions = *signed.equations, *signed.region
    order = canonical_order((without_number(compared[0])[1], *compared[1:], *conditions))
    letters = [s for s in order if any(s in x.free_symbols for x in (*compared, *conditions))]
    scales = (1, 2) if signed.region else (1,)
    for at in chain(*(islice(points(letters, _POINTS, sp.Integer(scale)), _POINTS) for scale in scales)):
        values: Values = dict(at)
        if signed.equations:
            box = enclosed_root(signed.equations, unknowns, at) if (unknowns := _unknowns(signed, order)) else None
            if box is None:
                continue
            values |= box
        if _as_declared(values) and all(_satisfied(relation, values) for relation in signed.region):
            yield values


def _unknowns(signed: Hypotheses, order: list[sp.Symbol]) -> list[sp.Symbol]:
    """Choose one symbol for each remaining equation, to be solved for. Return an empty list if there are too few symbols."""
    unknowns: list[sp.Symbol] = []
    for e in sorted(signed.equations, key=lambda e: len(e.free_symbols)):
        free = sorted(e.free_symbols - set(unknowns) - set(signed.small), key=order.index)
        if not free:
            return []
        unknowns.append(free[0])
    return unknowns


def _as_declared(values: Values) -> bool:
    """Return True if the values of the solved symbols have the signs that the symbols were declared with."""
    return all(
        not ((s.is_extended_nonnegative and v[0] <= 0) or (s.is_extended_nonpositive and v[1] >= 0) or s.is_integer)
        for s, v in values.items()
        if isinstance(v, tuple)
    )


def _satisfied(relation: Relational, values: Values) -> bool:
    """Return True if enclosures prove that a condition holds at a point."""
    between = enclosure(sp.sympify(relation.lhs - relation.rhs, strict=True), values)
    if between is None:
        return False
    low, high = between
    if isinstance(relation, sp.StrictGreaterThan | sp.StrictLessThan):
        return bool(low > 0 if isinstance(relation, sp.StrictGreaterThan) else high < 0)
    if isinstance(relation, sp.GreaterThan | sp.LessThan):
        return bool(low >= 0 if isinstance(relation, sp.GreaterThan) else high <= 0)
    return bool(low > 0 or high < 0)


def _point_in_symbols(difference: sp.Expr, under: Hypotheses, signed: Hypotheses, values: Values) -> Values:
    """Return a point in the symbols of the statement: the values of the eliminated symbols are added."""
    exact = {s: v for s, v in values.items() if not isinstance(v, tuple)}
    point: Values = {}
    for letter in sorted(difference.free_symbols | set(under.values), key=sp.default_sort_key):
        value = signed.on(letter)
        if value in values:
            point[letter] = values[value]
        elif value.free_symbols <= set(exact):
            point[letter] = replaced(value, exact)
        elif (between := enclosure(value, values)) is not None:
            point[letter] = between
    return point
