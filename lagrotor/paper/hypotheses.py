"""Premises as one set of hypotheses: their equations solved for letters as far as they are linear, the rest kept as an ideal.

What is decided under a set does not depend on the order or the form of its premises: of all letters that could be eliminated
the same one is taken first each time, one that a premise replaces before others. Every step is an equivalence, where the
letters are real and what is divided by is known not to vanish; so a set is contradictory exactly if what is left of it is, and
a point of what is left satisfies all of it.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import sympy as sp
from sympy.concrete.expr_with_limits import ExprWithLimits
from sympy.core.relational import Relational

from lagrotor.algebra import decide_zero
from lagrotor.algebra.feasibility import is_infeasible
from lagrotor.algebra.inverses import INVERSES, argument, solved_for
from lagrotor.algebra.numbering import Numbering, letters_in_order
from lagrotor.algebra.signs import Region, region, signs
from lagrotor.errors import InputError
from lagrotor.paper.premises import Premise, relation_text
from lagrotor.paper.readable import readable

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
        order = letters_in_order((sp.S.Zero, *self.region, *left))
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
    wishes = wishes._replace(order=tuple(letters.letters))

    def numbered(e: sp.Basic) -> Any:
        return sp.default_sort_key(letters.there(e))

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
