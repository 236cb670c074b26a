"""Signs: which of −, 0, + an expression may take, from what its letters are declared to be and in a region.

A region is a set of inequalities. Every answer is a set that holds the true sign at every point of the region where the
expression is defined; {-1, 0, 1} where nothing is known of a real one, and None where it is not known to be real.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import permutations, product
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.algebra.work_budget import kept
from lagrotor.errors import InputError

Signs: TypeAlias = frozenset[int]
Bound: TypeAlias = tuple[sp.Expr, bool]

POSITIVE, NONNEGATIVE, ANY = frozenset({1}), frozenset({0, 1}), frozenset({-1, 0, 1})
_ODD = (sp.sinh, sp.tanh, sp.atan, sp.asinh, sp.erf, sp.asin, sp.atanh)  # of the sign of their argument, where real
_REAL = (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc, sp.coth, sp.csch, sp.acot, sp.gamma)
# Increasing functions: their inverse, and between which numbers they are that.
_INCREASING: dict[Any, tuple[Any, Any, Any]] = {
    sp.exp: (sp.log, None, None),
    sp.log: (sp.exp, sp.S.Zero, None),
    sp.tan: (sp.atan, -sp.pi / 2, sp.pi / 2),
    sp.sinh: (sp.asinh, None, None),
    sp.asinh: (sp.sinh, None, None),
    sp.tanh: (sp.atanh, None, None),
}
_FACTORED = 40  # terms of the largest sum whose factors are looked at


@dataclass(frozen=True)
class Region:
    """Where all of `above` are positive (True beside it) or not negative (False)."""

    above: tuple[tuple[sp.Expr, bool], ...] = ()

    def with_(self, *relations: Any) -> Region:
        return Region(tuple(dict.fromkeys((*self.above, *region(relations).above))))

    @property
    def relations(self) -> tuple[sp.Basic, ...]:
        return tuple(sp.Gt(e, 0) if strict else sp.Ge(e, 0) for e, strict in self.above)

    def put(self, where: dict[sp.Expr, sp.Expr]) -> Region:
        """The region in other letters."""
        return Region(tuple((e.xreplace(where), strict) for e, strict in self.above))


def region(relations: Iterable[Any]) -> Region:
    """The region where inequalities, and conjunctions of them, hold; raise InputError for anything else."""
    found: list[tuple[sp.Expr, bool]] = []
    for relation in relations:
        if relation is True or relation is sp.true:
            continue
        if isinstance(relation, sp.And):
            found += region(relation.args).above
        elif isinstance(relation, sp.Gt | sp.Ge | sp.Lt | sp.Le):
            found.append((relation.gts - relation.lts, isinstance(relation, sp.Gt | sp.Lt)))
        else:
            raise InputError(f"region: {relation} is no inequality: give x > 0, x >= 0, and conjunctions of such")
    return Region(tuple(dict.fromkeys(found)))


def is_real(e: sp.Expr, where: Region = Region()) -> bool:
    return signs(e, where) is not None


def is_positive(e: sp.Expr, where: Region = Region()) -> bool:
    return signs(e, where) == POSITIVE


def is_nonnegative(e: sp.Expr, where: Region = Region()) -> bool:
    found = signs(e, where)
    return found is not None and found <= NONNEGATIVE


def signs(e: sp.Expr, where: Region = Region()) -> Signs | None:
    """The signs that a real expression may have; None where it is not known to be real."""
    return _signs_in(where).of(e)


def bounds(e: sp.Expr, where: Region) -> tuple[Bound | None, Bound | None]:
    """The least and the largest value that are known of a real expression, each with whether it is only approached."""
    return _signs_in(where).range_of(e)


@kept(64)
def _signs_in(where: Region) -> _Signs:
    return _Signs(where)


class _Signs:
    def __init__(self, where: Region) -> None:
        self.where = where = Region((*where.above, *(end for fact in where.above for end in _ends(fact))))
        self.facts = [(*_primitive(e), strict) for e, strict in where.above]
        self.known: dict[sp.Expr, Signs | None] = {}
        self.open: set[sp.Expr] = set()
        self.circles = 0

    def of(self, e: sp.Expr) -> Signs | None:
        """The signs of a part; what rests on one still sought is not kept, so that none depends on the order of asking."""
        if e in self.known:
            return self.known[e]
        if e in self.open:
            self.circles += 1
            return None
        circles = self.circles
        self.open.add(e)
        try:
            found = self._sought(e)
        finally:
            self.open.remove(e)
        if self.circles == circles:
            self.known[e] = found
        return found

    def _sought(self, e: sp.Expr) -> Signs | None:
        if e.is_zero:
            return frozenset({0})
        declared = _declared(e)
        if declared is not None and len(declared) == 1:
            return declared
        structural = self._structural(e)
        both = [found for found in (declared, structural) if found is not None]
        if not both:
            return None
        found = reduce(frozenset.intersection, both)
        return found if len(found) == 1 or e.is_number else found & self._from_facts(e)

    def _structural(self, e: sp.Expr) -> Signs | None:
        if e.is_Symbol:
            known = e.is_extended_real or (e.is_extended_real is None and any(self._bounds(e)))
            return ANY if known else None
        if e.is_Add:
            return self._sum(e)
        if e.is_Mul:
            parts = [self.of(part) for part in e.args]
            return None if None in parts else reduce(_times, parts)  # type: ignore[arg-type]
        if e.is_Pow or isinstance(e, sp.exp):
            return self._power(*e.as_base_exp())
        return self._function(e) if e.args else None

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> Signs | None:
        found, power = self.of(base), self.of(exponent)
        if found is None or power is None:
            return None
        if found == POSITIVE:
            return POSITIVE
        if exponent.is_integer:
            if exponent.is_even:
                return frozenset({s * s for s in found})
            return found if exponent.is_odd else ANY
        return NONNEGATIVE if found <= NONNEGATIVE else None

    def _sum(self, e: sp.Expr) -> Signs | None:
        parts = [self.of(part) for part in e.args]
        if None in parts:
            return None
        union = frozenset().union(*parts)  # type: ignore[arg-type]
        for one in (1, -1):
            if union <= {0, one}:
                return frozenset({one}) if frozenset({one}) in parts else union
        if (bound := self._linear(e)) is not None:
            return bound
        if (bound := self._monotone(e) or self._by_squares(e)) is not None:
            return bound
        if len(e.args) <= _FACTORED:
            factors = sp.factor(e)
            found = ANY if factors.is_Add else self.of(factors)
            return found if found is None or len(found) == 1 else found & self._by_factors(factors)
        return ANY

    def _by_factors(self, e: sp.Expr) -> Signs:
        """Return the signs of a product from the facts that are products of some of its factors."""
        content, odd, even = _factored(e)
        found = frozenset({content})
        for side, factors, squares, strict in self.products:
            if factors and factors <= odd and (strict or not squares):
                odd = odd - factors
                found = _times(found, frozenset({side} if strict else {0, side}))
        if not self.products or len(odd) == len(_factored(e)[1]):
            return ANY
        for part in odd:
            found = _times(found, self.of(part) or ANY)
        return found if all(0 not in (self.of(part) or ANY) for part in even) else found | {0}

    @cached_property
    def products(self) -> list[tuple[int, frozenset[sp.Expr], frozenset[sp.Expr], bool]]:
        """The facts as signs, factors of odd powers, and squares in numerators; whether a fact is strict."""
        return [(*_factored(sp.factor(e)), strict) for e, strict in self.where.above if len(e.args) <= _FACTORED]

    def _function(self, e: sp.Expr) -> Signs | None:
        u = e.args[0]
        if isinstance(e, sp.Abs):
            found = self.of(u)
            return NONNEGATIVE if found is None or 0 in found else POSITIVE
        found = self.of(u)
        if found is None:
            return None
        if isinstance(e, sp.cosh | sp.sech):
            return POSITIVE
        if isinstance(e, sp.asin | sp.acos | sp.atanh):
            if not (self.of(sp.factor(1 - u**2)) or ANY) <= NONNEGATIVE:
                return None
            return NONNEGATIVE if isinstance(e, sp.acos) else found
        if isinstance(e, sp.acosh):
            return NONNEGATIVE if (self.of(u - 1) or ANY) <= NONNEGATIVE else None
        if isinstance(e, sp.log):
            return self.of(u - 1) if found <= NONNEGATIVE else None
        if isinstance(e, sp.gamma | sp.factorial) and found <= NONNEGATIVE:
            return POSITIVE
        if isinstance(e, sp.besselj):
            return ANY if self.of(e.args[1]) == POSITIVE else None
        if isinstance(e, sp.sin | sp.cos | sp.tan):
            return self._circular(e, u)
        return found if isinstance(e, _ODD) else ANY if isinstance(e, _REAL) else None

    def _circular(self, e: sp.Expr, u: sp.Expr) -> Signs:
        """From where the argument lies: sin u has the sign of (−1)ᵏ where kπ < u < (k + 1)π, cos and tan likewise."""
        start = -sp.pi / 2 if isinstance(e, sp.cos) else sp.S.Zero
        step = sp.pi / 2 if isinstance(e, sp.tan) else sp.pi
        for k in (0, -1, 1, -2, 2):
            sides = [self.of(u - start - k * step), self.of(start + (k + 1) * step - u)]
            if all(side is not None and side <= NONNEGATIVE for side in sides):
                inside = frozenset({-1 if k % 2 else 1})
                return inside if all(side == POSITIVE for side in sides) else inside | {0}
        return ANY

    def _monotone(self, e: sp.Expr) -> Signs | None:
        """a + b f(u) of numbers a, b and an increasing f has the sign of b (u − f⁻¹(−a/b))."""
        for number, term in permutations(e.args) if len(e.args) == 2 else ():
            b, call = term.as_independent(*term.free_symbols, as_Add=False)
            if not number.is_number or not b.is_real or call.func not in _INCREASING:
                continue
            u, (inverse, low, high) = call.args[0], _INCREASING[call.func]
            at = inverse(-number / b)
            if at.is_extended_real and at.is_finite and all(self.of(s) == POSITIVE for s in _between(u, low, high)):
                found = self.of(u - at)
                return None if found is None else _times(found, frozenset({int(sp.sign(b))}))
        return None

    def _by_squares(self, e: sp.Expr) -> Signs | None:
        """a − b of roots, neither negative, has the sign of a² − b²."""
        for a, b in permutations(e.args) if len(e.args) == 2 and e.has(sp.Pow) else ():
            if (self.of(a) or ANY) <= NONNEGATIVE and (self.of(-b) or ANY) <= NONNEGATIVE:
                square = sp.expand(a**2 - b**2)
                return self.of(square) if sp.count_ops(square) < sp.count_ops(e) else None
        return None

    def _linear(self, e: sp.Expr) -> Signs | None:
        """Of a sum from the ranges of its terms, each a number times something of known range."""
        ranges = [self.range_of(term) for term in e.args]
        least, most = zip(*ranges, strict=True)
        for ends, side in ((least, 1), (most, -1)):
            if None in ends:
                continue
            value = sp.Add(*(end[0] for end in ends))
            if (side * value).is_positive or (value.is_zero and any(end[1] for end in ends)):
                return frozenset({side})
            if value.is_zero:
                return frozenset({0, side})
        return None

    def range_of(self, term: sp.Expr) -> tuple[Bound | None, Bound | None]:
        """The least and the largest value, each with whether it is only approached."""
        c, rest = term.as_independent(*term.free_symbols, as_Add=False) if term.free_symbols else (term, sp.S.One)
        base, power = rest.as_base_exp()
        low: Bound | None = None
        high: Bound | None = None
        if rest == 1:
            low = high = (sp.S.One, False)
        elif (
            isinstance(base, sp.sin | sp.cos | sp.tanh) and power.is_Integer and power > 0 and self.of(base) is not None
        ):
            open_ = isinstance(base, sp.tanh)
            low, high = ((sp.S.Zero, False) if power.is_even else (sp.S.NegativeOne, open_)), (sp.S.One, open_)
        elif isinstance(base, sp.cosh) and power.is_positive and self.of(base.args[0]) is not None:
            low = sp.S.One, False
        elif isinstance(rest, sp.asin | sp.acos | sp.atan) and self.of(rest) is not None:
            start, open_ = sp.S.Zero if isinstance(rest, sp.acos) else -sp.pi / 2, isinstance(rest, sp.atan)
            low, high = (start, open_), (start + sp.pi, open_)
        elif rest.is_Symbol:
            low, high = self._bounds(rest)
        elif (found := self.of(rest)) is not None:
            low = (sp.S.Zero, found == POSITIVE) if found <= NONNEGATIVE else None
            high = (sp.S.Zero, found == {-1}) if found <= {-1, 0} else None
        low, high = ((end and (c * end[0], end[1])) for end in (low, high))
        return (high, low) if c.is_negative else (low, high) if c.is_positive else (None, None)

    def _bounds(self, letter: sp.Symbol) -> tuple[Bound | None, Bound | None]:
        """The largest lower and the least upper bound that is a number, each with whether it is open."""
        low: Bound | None = None
        high: Bound | None = None
        if letter.is_extended_nonnegative:
            low = sp.S.Zero, bool(letter.is_extended_positive)
            low = (sp.S.One, False) if letter.is_integer and letter.is_positive else low
        if letter.is_extended_nonpositive:
            high = sp.S.Zero, bool(letter.is_extended_negative)
        for e, strict in self.where.above:
            c = e.coeff(letter)
            rest = e - c * letter
            if not (c.is_number and rest.is_number) or c.is_zero:
                continue
            bound = -rest / c
            if c.is_positive and (low is None or (bound - low[0]).is_positive or (bound == low[0] and strict)):
                low = bound, strict
            if c.is_negative and (high is None or (high[0] - bound).is_positive or (bound == high[0] and strict)):
                high = bound, strict
        return low, high

    def _from_facts(self, e: sp.Expr) -> Signs:
        """What the region says of e itself, of a multiple of it, or of e less a number."""
        if e.is_Symbol:
            low, high = self._bounds(e)
            found = ANY
            if low and low[0].is_nonnegative:
                found &= POSITIVE if low[1] or low[0].is_positive else NONNEGATIVE
            if high and high[0].is_nonpositive:
                found &= frozenset({-1}) if high[1] or high[0].is_negative else frozenset({-1, 0})
            return found
        found = ANY
        if self.facts:
            content, primitive = _primitive(e)
            for over, part, strict in self.facts:
                if part in (primitive, -primitive):
                    side = int(sp.sign(content)) * int(sp.sign(over)) * (1 if part == primitive else -1)
                    found &= frozenset({side} if strict else {0, side})
                elif (rest := primitive * content - part * over).is_number and rest.is_nonnegative:
                    found &= POSITIVE if strict or rest.is_positive else NONNEGATIVE
        return found


def _ends(fact: tuple[sp.Expr, bool]) -> Iterator[tuple[sp.Expr, bool]]:
    """Yield x − a and b − x of a fact (x − a)(b − x) in one letter, with rational a < b."""
    e, strict = fact
    polynomial = e.as_poly() if len(e.free_symbols) == 1 and e.is_polynomial() else None
    if not polynomial or polynomial.is_multivariate or not (polynomial.domain.is_ZZ or polynomial.domain.is_QQ):
        return
    roots = sorted(polynomial.ground_roots())
    if polynomial.degree() == len(roots) == 2 and polynomial.LC() < 0:
        yield from ((polynomial.gen - roots[0], strict), (roots[1] - polynomial.gen, strict))


def _between(u: sp.Expr, low: Any, high: Any) -> list[sp.Expr]:
    """What is positive where u lies between the two."""
    return [*(() if low is None else (u - low,)), *(() if high is None else (high - u,))]


def _factored(e: sp.Expr) -> tuple[int, frozenset[sp.Expr], frozenset[sp.Expr]]:
    """Return the sign of the number before a product, its factors of odd powers, and those of even positive powers."""
    number, factors = e.as_coeff_mul()
    side, odd, even = int(sp.sign(number)), set[sp.Expr](), set[sp.Expr]()
    for factor in factors:
        base, power = factor.as_base_exp() if factor.is_Pow and factor.exp.is_Integer else (factor, sp.S.One)
        turned = base.could_extract_minus_sign()
        side = -side if turned and power % 2 else side
        if power % 2 or power > 0:
            (odd if power % 2 else even).add(-base if turned else base)
    return side, frozenset(odd), frozenset(even)


def _primitive(e: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """A number and the rest of which e is the product, sums multiplied out."""
    content, rest = (sp.expand_mul(e) if e.is_Mul else e).as_content_primitive()
    number, rest = rest.as_independent(*rest.free_symbols, as_Add=False) if rest.free_symbols else (sp.S.One, rest)
    return content * number, rest


def _declared(e: sp.Expr) -> Signs | None:
    """What sympy knows from the letters' assumptions."""
    if not e.is_extended_real:
        return None
    found = ANY
    if e.is_extended_nonnegative:
        found &= NONNEGATIVE
    if e.is_extended_nonpositive:
        found &= frozenset({-1, 0})
    if e.is_nonzero or e.is_extended_nonzero:
        found -= {0}
    return found


def _times(a: Signs, b: Signs) -> Signs:
    return frozenset(s * t for s, t in product(a, b))


BRANCHED = (sp.Abs, sp.sign, sp.asin, sp.acos, sp.atan, sp.acot, sp.acosh, sp.atanh, sp.asinh, sp.log)


def conditions(e: sp.Expr) -> tuple[sp.Basic, ...]:
    """Inequalities under which every logarithm, root and inverse function of real arguments in e is real."""
    found: dict[sp.Basic, None] = {}
    for node in sp.preorder_traversal(e):
        for side, strict in _sides(node):
            if not side.has(sp.I) and side.is_real is not False and side.free_symbols <= e.free_symbols:
                found[sp.Gt(side, 0) if strict else sp.Ge(side, 0)] = None
    return tuple(relation for relation in found if relation is not sp.true)


def _sides(node: sp.Basic) -> Iterator[tuple[sp.Expr, bool]]:
    if isinstance(node, sp.log) or (node.is_Pow and not node.exp.is_integer):
        yield node.args[0], isinstance(node, sp.log) or not node.exp.is_positive
    elif isinstance(node, sp.asin | sp.acos | sp.atanh):
        yield 1 - node.args[0], isinstance(node, sp.atanh)
        yield 1 + node.args[0], isinstance(node, sp.atanh)
    elif isinstance(node, sp.acosh):
        yield node.args[0] - 1, False
