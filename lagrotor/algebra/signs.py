"""Signs: which of −, 0, + an expression may take, from the assumptions of its symbols and in a region.

A region is a set of inequalities. Each answer is a set that contains the true sign at every point of the region where the
expression is defined: {-1, 0, 1} for a real expression of unknown sign, None if it is not known to be real.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import permutations, product
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.algebra.work_budget import bounded_cache
from lagrotor.errors import InputError

Signs: TypeAlias = frozenset[int]
Bound: TypeAlias = tuple[sp.Expr, bool]

POSITIVE, NONNEGATIVE, ANY = frozenset({1}), frozenset({0, 1}), frozenset({-1, 0, 1})
_ODD = (sp.sinh, sp.tanh, sp.atan, sp.asinh, sp.erf, sp.asin, sp.atanh)  # odd functions: sign of a real argument
_REAL = (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc, sp.coth, sp.csch, sp.acot, sp.gamma)
# Increasing function -> (its inverse, lower and upper bound of the interval where it increases).
_INCREASING: dict[Any, tuple[Any, Any, Any]] = {
    sp.exp: (sp.log, None, None), sp.log: (sp.exp, sp.S.Zero, None), sp.tan: (sp.atan, -sp.pi / 2, sp.pi / 2),
    sp.sinh: (sp.asinh, None, None), sp.asinh: (sp.sinh, None, None), sp.tanh: (sp.atanh, None, None),
}  # fmt: skip
_FACTORED = 40  # terms of the largest sum that is factored


@dataclass(frozen=True)
class Region:
    """The set of points at which each e of the pairs (e, strict) in `above` is positive (strict) or nonnegative (not strict)."""

    above: tuple[tuple[sp.Expr, bool], ...] = ()

    def with_(self, *relations: Any) -> Region:
        return Region(tuple(dict.fromkeys((*self.above, *region(relations).above))))

    @property
    def relations(self) -> tuple[sp.Basic, ...]:
        return tuple(sp.Gt(e, 0) if strict else sp.Ge(e, 0) for e, strict in self.above)

    def put(self, where: dict[sp.Expr, sp.Expr]) -> Region:
        """Return the region with symbols replaced."""
        return Region(tuple((e.xreplace(where), strict) for e, strict in self.above))


def region(relations: Iterable[Any]) -> Region:
    """Return the region in which all relations hold. Raises InputError if one is no inequality or conjunction of inequalities."""
    inequalities: list[tuple[sp.Expr, bool]] = []
    for relation in relations:
        if relation is True or relation is sp.true:
            continue
        if isinstance(relation, sp.And):
            inequalities += region(relation.args).above
        elif isinstance(relation, sp.Gt | sp.Ge | sp.Lt | sp.Le):
            inequalities.append((relation.gts - relation.lts, isinstance(relation, sp.Gt | sp.Lt)))
        else:
            raise InputError(f"region: {relation} is no inequality: give x > 0, x >= 0, and conjunctions of such")
    return Region(tuple(dict.fromkeys(inequalities)))


def is_real(e: sp.Expr, where: Region = Region()) -> bool:
    return signs(e, where) is not None


def is_positive(e: sp.Expr, where: Region = Region()) -> bool:
    return signs(e, where) == POSITIVE


def is_nonnegative(e: sp.Expr, where: Region = Region()) -> bool:
    possible = signs(e, where)
    return possible is not None and possible <= NONNEGATIVE


def signs(e: sp.Expr, where: Region = Region()) -> Signs | None:
    """Return the possible signs of a real expression; None if it is not known to be real."""
    return _signs_in(where).of(e)


def bounds(e: sp.Expr, where: Region) -> tuple[Bound | None, Bound | None]:
    """Return the known lower and upper bound of a real expression, each as (bound, True if it is not attained), or None."""
    return _signs_in(where).range_of(e)


@bounded_cache(64)
def _signs_in(where: Region) -> _Signs:
    return _Signs(where)


class _Signs:
    def __init__(self, where: Region) -> None:
        self.where = where = Region((*where.above, *(end for fact in where.above for end in _ends(fact))))
        self.facts = [(*_primitive(e), strict) for e, strict in where.above]
        self.bounded = set[sp.Symbol]().union(*(e.free_symbols for e, _ in where.above))
        self.known: dict[sp.Expr, Signs | None] = {}
        self.open: set[sp.Expr] = set()
        self.circles = 0

    def of(self, e: sp.Expr) -> Signs | None:
        """Return the possible signs of e; None if e is not known to be real.

        A result that rests on an unfinished question is not cached, so that the order of the questions does not matter.
        """
        if e in self.known:
            return self.known[e]
        if e in self.open:
            self.circles += 1
            return None
        circles = self.circles
        self.open.add(e)
        try:
            possible = self._sought(e)
        finally:
            self.open.remove(e)
        if self.circles == circles:
            self.known[e] = possible
        return possible

    def _sought(self, e: sp.Expr) -> Signs | None:
        if e.is_zero:
            return frozenset({0})
        declared = _declared(e)
        if declared is not None and len(declared) == 1:
            return declared
        structural = self._structural(e)
        both = [possible for possible in (declared, structural) if possible is not None]
        if not both:
            return None
        possible = reduce(frozenset.intersection, both)
        return possible if len(possible) == 1 or e.is_number else possible & self._from_facts(e)

    def _structural(self, e: sp.Expr) -> Signs | None:
        if e.is_Symbol:
            is_real_symbol = e.is_extended_real or (e.is_extended_real is None and any(self._bounds(e)))
            return ANY if is_real_symbol else None
        if e.is_Add:
            return self._sum(e)
        if e.is_Mul:
            argument_signs = [self.of(argument) for argument in e.args]
            return None if None in argument_signs else reduce(_times, argument_signs)  # type: ignore[arg-type]
        if e.is_Pow or isinstance(e, sp.exp):
            return self._power(*e.as_base_exp())
        return self._function(e) if e.args else None

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> Signs | None:
        base_signs, power = self.of(base), self.of(exponent)
        if base_signs is None or power is None:
            return None
        if base_signs == POSITIVE:
            return POSITIVE
        if exponent.is_integer:
            if exponent.is_even:
                return frozenset({s * s for s in base_signs})
            return base_signs if exponent.is_odd else ANY
        return NONNEGATIVE if base_signs <= NONNEGATIVE else None

    def _sum(self, e: sp.Expr) -> Signs | None:
        term_signs = [self.of(term) for term in e.args]
        if None in term_signs:
            return None
        if self._is_free(e):
            return ANY
        union = frozenset().union(*term_signs)  # type: ignore[arg-type]
        for sign in (1, -1):
            if union <= {0, sign}:
                return frozenset({sign}) if frozenset({sign}) in term_signs else union
        if (bound := self._linear(e)) is not None:
            return bound
        if (bound := self._monotone(e) or self._by_squares(e)) is not None:
            return bound
        if len(e.args) <= _FACTORED:
            factors = sp.factor(e)
            possible = ANY if factors.is_Add else self.of(factors)
            return possible if possible is None or len(possible) == 1 else possible & self._by_factors(factors)
        return ANY

    def _by_factors(self, e: sp.Expr) -> Signs:
        """Return the signs of a product; the region may state the sign of a product of some of the factors."""
        content, odd, even = _factored(e)
        possible = frozenset({content})
        for side, factors, squares, strict in self.products:
            if factors and factors <= odd and (strict or not squares):
                odd = odd - factors
                possible = _times(possible, frozenset({side} if strict else {0, side}))
        if not self.products or len(odd) == len(_factored(e)[1]):
            return ANY
        for factor in odd:
            possible = _times(possible, self.of(factor) or ANY)
        return possible if all(0 not in (self.of(factor) or ANY) for factor in even) else possible | {0}

    @cached_property
    def products(self) -> list[tuple[int, frozenset[sp.Expr], frozenset[sp.Expr], bool]]:
        """The inequalities of the region in factored form.

        Each is a tuple: the sign of the number, the factors of odd powers, the factors of even positive powers, and True if the
        inequality is strict.
        """
        return [(*_factored(sp.factor(e)), strict) for e, strict in self.where.above if len(e.args) <= _FACTORED]

    def _function(self, e: sp.Expr) -> Signs | None:
        u = e.args[0]
        if isinstance(e, sp.Abs):
            argument_signs = self.of(u)
            return NONNEGATIVE if argument_signs is None or 0 in argument_signs else POSITIVE
        argument_signs = self.of(u)
        if argument_signs is None:
            return None
        if isinstance(e, sp.cosh | sp.sech):
            return POSITIVE
        if isinstance(e, sp.asin | sp.acos | sp.atanh):
            if not (self.of(sp.factor(1 - u**2)) or ANY) <= NONNEGATIVE:
                return None
            return NONNEGATIVE if isinstance(e, sp.acos) else argument_signs
        if isinstance(e, sp.acosh):
            return NONNEGATIVE if (self.of(u - 1) or ANY) <= NONNEGATIVE else None
        if isinstance(e, sp.log):
            return self.of(u - 1) if argument_signs <= NONNEGATIVE else None
        if isinstance(e, sp.gamma | sp.factorial) and argument_signs <= NONNEGATIVE:
            return POSITIVE
        if isinstance(e, sp.besselj):
            return ANY if self.of(e.args[1]) == POSITIVE else None
        if isinstance(e, sp.sin | sp.cos | sp.tan):
            return self._circular(e, u)
        return argument_signs if isinstance(e, _ODD) else ANY if isinstance(e, _REAL) else None

    def _circular(self, e: sp.Expr, u: sp.Expr) -> Signs:
        """Return the signs of a sine or similar function from the range of u: sin u has the sign (−1)ᵏ for kπ < u < (k + 1)π."""
        if self._is_free(u):
            return ANY
        start = -sp.pi / 2 if isinstance(e, sp.cos) else sp.S.Zero
        step = sp.pi / 2 if isinstance(e, sp.tan) else sp.pi
        for k in (0, -1, 1, -2, 2):
            sides = [self.of(u - start - k * step), self.of(start + (k + 1) * step - u)]
            if all(side is not None and side <= NONNEGATIVE for side in sides):
                inside = frozenset({-1 if k % 2 else 1})
                return inside if all(side == POSITIVE for side in sides) else inside | {0}
        return ANY

    def _is_free(self, e: sp.Expr) -> bool:
        """Return True if nothing bounds e, because a term or a factor is a symbol without assumptions that occurs only there."""
        parts = [part.as_coeff_Mul()[1] for part in (e.args if e.is_Add or e.is_Mul else (e,))]
        symbols = (part for part in parts if part.is_Symbol and _declared(part) == ANY and part not in self.bounded)
        return any(sum(symbol in part.free_symbols for part in parts) == 1 for symbol in symbols)

    def _monotone(self, e: sp.Expr) -> Signs | None:
        """Return the signs of a + b f(u) for numbers a and b and an increasing f: the signs of b (u − f⁻¹(−a/b))."""
        for number, term in permutations(e.args) if len(e.args) == 2 else ():
            b, call = term.as_independent(*term.free_symbols, as_Add=False)
            if not number.is_number or not b.is_real or call.func not in _INCREASING:
                continue
            u, (inverse, low, high) = call.args[0], _INCREASING[call.func]
            at = inverse(-number / b)
            if at.is_extended_real and at.is_finite and all(self.of(s) == POSITIVE for s in _between(u, low, high)):
                difference_signs = self.of(u - at)
                return None if difference_signs is None else _times(difference_signs, frozenset({int(sp.sign(b))}))
        return None

    def _by_squares(self, e: sp.Expr) -> Signs | None:
        """Return the signs of a − b for nonnegative roots a and b: the signs of a² − b²."""
        for a, b in permutations(e.args) if len(e.args) == 2 and e.has(sp.Pow) else ():
            if (self.of(a) or ANY) <= NONNEGATIVE and (self.of(-b) or ANY) <= NONNEGATIVE:
                square = sp.expand(a**2 - b**2)
                return self.of(square) if sp.count_ops(square) < sp.count_ops(e) else None
        return None

    def _linear(self, e: sp.Expr) -> Signs | None:
        """Return the signs of a sum from the ranges of its terms."""
        ranges = [self.range_of(term) for term in e.args]
        least, greatest = zip(*ranges, strict=True)
        for ends, side in ((least, 1), (greatest, -1)):
            if None in ends:
                continue
            value = sp.Add(*(end[0] for end in ends))
            if (side * value).is_positive or (value.is_zero and any(end[1] for end in ends)):
                return frozenset({side})
            if value.is_zero:
                return frozenset({0, side})
        return None

    def range_of(self, term: sp.Expr) -> tuple[Bound | None, Bound | None]:
        """Return the lower and upper bound of a term, each as (bound, True if it is not attained), or None if unknown."""
        c, dependent = term.as_independent(*term.free_symbols, as_Add=False) if term.free_symbols else (term, sp.S.One)
        base, power = dependent.as_base_exp()
        low: Bound | None = None
        high: Bound | None = None
        if dependent == 1:
            low = high = (sp.S.One, False)
        elif (
            isinstance(base, sp.sin | sp.cos | sp.tanh) and power.is_Integer and power > 0 and self.of(base) is not None
        ):
            open_ = isinstance(base, sp.tanh)
            low, high = ((sp.S.Zero, False) if power.is_even else (sp.S.NegativeOne, open_)), (sp.S.One, open_)
        elif isinstance(base, sp.cosh) and power.is_positive and self.of(base.args[0]) is not None:
            low = sp.S.One, False
        elif isinstance(dependent, sp.asin | sp.acos | sp.atan) and self.of(dependent) is not None:
            start, open_ = sp.S.Zero if isinstance(dependent, sp.acos) else -sp.pi / 2, isinstance(dependent, sp.atan)
            low, high = (start, open_), (start + sp.pi, open_)
        elif dependent.is_Symbol:
            low, high = self._bounds(dependent)
        elif (possible := self.of(dependent)) is not None:
            low = (sp.S.Zero, possible == POSITIVE) if possible <= NONNEGATIVE else None
            high = (sp.S.Zero, possible == {-1}) if possible <= {-1, 0} else None
        low, high = ((end and (c * end[0], end[1])) for end in (low, high))
        return (high, low) if c.is_negative else (low, high) if c.is_positive else (None, None)

    def _bounds(self, symbol: sp.Symbol) -> tuple[Bound | None, Bound | None]:
        """Return the best lower and upper numerical bound of a symbol, each as (bound, True if it is not attained), or None."""
        low: Bound | None = None
        high: Bound | None = None
        if symbol.is_extended_nonnegative:
            low = sp.S.Zero, bool(symbol.is_extended_positive)
            low = (sp.S.One, False) if symbol.is_integer and symbol.is_positive else low
        if symbol.is_extended_nonpositive:
            high = sp.S.Zero, bool(symbol.is_extended_negative)
        for e, strict in self.where.above:
            c = e.coeff(symbol)
            constant = e - c * symbol
            if not (c.is_number and constant.is_number) or c.is_zero:
                continue
            bound = -constant / c
            if c.is_positive and (low is None or (bound - low[0]).is_positive or (bound == low[0] and strict)):
                low = bound, strict
            if c.is_negative and (high is None or (high[0] - bound).is_positive or (bound == high[0] and strict)):
                high = bound, strict
        return low, high

    def _from_facts(self, e: sp.Expr) -> Signs:
        """Return the signs of e that follow from an inequality for a multiple of e, or for e minus a nonnegative number."""
        if e.is_Symbol:
            low, high = self._bounds(e)
            possible = ANY
            if low and low[0].is_nonnegative:
                possible &= POSITIVE if low[1] or low[0].is_positive else NONNEGATIVE
            if high and high[0].is_nonpositive:
                possible &= frozenset({-1}) if high[1] or high[0].is_negative else frozenset({-1, 0})
            return possible
        possible = ANY
        if self.facts:
            content, primitive = _primitive(e)
            for over, primitive_fact, strict in self.facts:
                if primitive_fact in (primitive, -primitive):
                    side = int(sp.sign(content)) * int(sp.sign(over)) * (1 if primitive_fact == primitive else -1)
                    possible &= frozenset({side} if strict else {0, side})
                elif (
                    difference := primitive * content - primitive_fact * over
                ).is_number and difference.is_nonnegative:
                    possible &= POSITIVE if strict or difference.is_positive else NONNEGATIVE
        return possible


def _ends(fact: tuple[sp.Expr, bool]) -> Iterator[tuple[sp.Expr, bool]]:
    """Split an inequality (x − a)(b − x) > 0 or ≥ 0 in one symbol, with rational a < b, into two linear ones.

    Yield (x − a, strict) and (b − x, strict), and nothing for any other inequality.
    """
    e, strict = fact
    polynomial = e.as_poly() if len(e.free_symbols) == 1 and e.is_polynomial() else None
    if not polynomial or polynomial.is_multivariate or not (polynomial.domain.is_ZZ or polynomial.domain.is_QQ):
        return
    roots = sorted(polynomial.ground_roots())
    if polynomial.degree() == len(roots) == 2 and polynomial.LC() < 0:
        yield from ((polynomial.gen - roots[0], strict), (roots[1] - polynomial.gen, strict))


def _between(u: sp.Expr, low: Any, high: Any) -> list[sp.Expr]:
    """Return the expressions that must be positive so that low < u < high; a limit None is left out."""
    return [*(() if low is None else (u - low,)), *(() if high is None else (high - u,))]


def _factored(e: sp.Expr) -> tuple[int, frozenset[sp.Expr], frozenset[sp.Expr]]:
    """Split a product into the sign of its number, its factors of odd powers, and its factors of even positive powers."""
    number, factors = e.as_coeff_mul()
    side, odd, even = int(sp.sign(number)), set[sp.Expr](), set[sp.Expr]()
    for factor in factors:
        base, power = factor.as_base_exp() if factor.is_Pow and factor.exp.is_Integer else (factor, sp.S.One)
        is_negated = base.could_extract_minus_sign()
        side = -side if is_negated and power % 2 else side
        if power % 2 or power > 0:
            (odd if power % 2 else even).add(-base if is_negated else base)
    return side, frozenset(odd), frozenset(even)


def _primitive(e: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return (number, primitive expression) whose product is e, with sums expanded."""
    content, core = (sp.expand_mul(e) if e.is_Mul else e).as_content_primitive()
    number, core = core.as_independent(*core.free_symbols, as_Add=False) if core.free_symbols else (sp.S.One, core)
    return content * number, core


def _declared(e: sp.Expr) -> Signs | None:
    """Return the signs that sympy derives from the symbols' assumptions."""
    if not e.is_extended_real:
        return None
    possible = ANY
    if e.is_extended_nonnegative:
        possible &= NONNEGATIVE
    if e.is_extended_nonpositive:
        possible &= frozenset({-1, 0})
    if e.is_nonzero or e.is_extended_nonzero:
        possible -= {0}
    return possible


def _times(a: Signs, b: Signs) -> Signs:
    return frozenset(s * t for s, t in product(a, b))


BRANCHED = (sp.Abs, sp.sign, sp.asin, sp.acos, sp.atan, sp.acot, sp.acosh, sp.atanh, sp.asinh, sp.log)


def conditions(e: sp.Expr) -> tuple[sp.Basic, ...]:
    """Return inequalities under which every logarithm, root and inverse function of real arguments in e is real."""
    relations: dict[sp.Basic, None] = {}
    for node in sp.preorder_traversal(e):
        for side, strict in _sides(node):
            if not side.has(sp.I) and side.is_real is not False and side.free_symbols <= e.free_symbols:
                relations[sp.Gt(side, 0) if strict else sp.Ge(side, 0)] = None
    return tuple(relation for relation in relations if relation is not sp.true)


def _sides(node: sp.Basic) -> Iterator[tuple[sp.Expr, bool]]:
    if isinstance(node, sp.log) or (node.is_Pow and not node.exp.is_integer):
        yield node.args[0], isinstance(node, sp.log) or not node.exp.is_positive
    elif isinstance(node, sp.asin | sp.acos | sp.atanh):
        yield 1 - node.args[0], isinstance(node, sp.atanh)
        yield 1 + node.args[0], isinstance(node, sp.atanh)
    elif isinstance(node, sp.acosh):
        yield node.args[0] - 1, False
