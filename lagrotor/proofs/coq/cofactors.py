"""Polynomials under equations: symbols are eliminated, a quotient becomes one fraction, and cofactors are found.

Buchberger's algorithm finds the cofactors q_i of p = sum q_i zero_i + rest, where the zero_i vanish. Each member of the basis
carries its own cofactors.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import sympy as sp
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.errors import NotExactError

SymbolEquation = tuple[sp.Expr, sp.Expr]
# The largest number of terms in a numerator.
_MOST_TERMS = 4000


def elimination(equations: Sequence[SymbolEquation]) -> tuple[dict[sp.Symbol, sp.Expr], dict[int, sp.Expr]]:
    """Solve the equations with a symbol alone on one side; return {symbol: value}, and {place: difference} of the others.

    Places are counted from 1. Raises NotExactError for an equation that contradicts the earlier ones.

    Raises NotExactError for an equation that contradicts the earlier ones.
    """
    values: dict[sp.Symbol, sp.Expr] = {}
    others: dict[int, sp.Expr] = {}
    for place, (lhs, rhs) in enumerate(equations, 1):
        a, b = lhs.xreplace(values), rhs.xreplace(values)
        for symbol, value in ((a, b), (b, a)):
            if sp.expand(a - b) != 0 and symbol.is_Symbol and symbol not in value.free_symbols:
                values = {old: new.xreplace({symbol: value}) for old, new in values.items()} | {symbol: value}
                break
        else:
            others[place] = a - b
    left_over = {place: e for place, difference in others.items() if sp.expand(e := difference.xreplace(values)) != 0}
    for place, e in left_over.items():
        if not e.free_symbols:
            lhs, rhs = equations[place - 1]
            raise NotExactError(f"the premise {lhs} = {rhs} contradicts those before it")
    return values, left_over


# The largest basis.
_MOST_MEMBERS = 40


def cofactors_of(target: PolyElement, zeros: Sequence[PolyElement]) -> tuple[list[PolyElement], PolyElement]:
    """Return the cofactors q_i and the remainder of target = sum q_i zero_i + remainder.

    Becker & Weispfenning, Groebner Bases, 5.6.

    Raises NotExactError if the basis is too large.
    """
    ring = target.ring.clone(order=sp.grevlex)
    basis: list[tuple[PolyElement, list[PolyElement]]] = []

    def reduce_by_basis(p: PolyElement, row: list[PolyElement]) -> tuple[PolyElement, list[PolyElement]]:
        """Return the remainder of p modulo the basis, and the row plus the cofactors of p − remainder."""
        remainder = ring.zero
        while p:
            for member, combination in basis:
                over = ring.monomial_div(p.LM, member.LM)
                if over is not None:
                    factor = ring.term_new(over, p.LC / member.LC)
                    p = _bounded(p - factor * member)
                    row = [a + factor * b for a, b in zip(row, combination, strict=True)]
                    break
            else:
                remainder, p = remainder + p.leading_term(), p - p.leading_term()
        return remainder, row

    def add_member(p: PolyElement, row: list[PolyElement]) -> None:
        """Extend the basis by the remainder of p modulo the basis; `row` has the cofactors of p."""
        remainder, used = reduce_by_basis(p, [ring.zero] * len(zeros))
        if remainder:
            pairs.extend((i, len(basis)) for i in range(len(basis)))
            basis.append((remainder, [a - b for a, b in zip(row, used, strict=True)]))
        if len(basis) > _MOST_MEMBERS:
            raise NotExactError("the premises have too large a basis")

    pairs: list[tuple[int, int]] = []
    for place, zero in enumerate(zeros):
        add_member(zero.set_ring(ring), [ring.one if i == place else ring.zero for i in range(len(zeros))])
    while pairs:
        pairs.sort(key=lambda pair: -sum(ring.monomial_lcm(basis[pair[0]][0].LM, basis[pair[1]][0].LM)))
        (p, of_p), (q, of_q) = (basis[i] for i in pairs.pop())
        common = ring.monomial_lcm(p.LM, q.LM)
        if common == ring.monomial_mul(p.LM, q.LM):  # Buchberger's first criterion
            continue
        by_p, by_q = (ring.term_new(ring.monomial_div(common, g.LM), 1 / g.LC) for g in (p, q))
        add_member(by_p * p - by_q * q, [by_p * a - by_q * b for a, b in zip(of_p, of_q, strict=True)])
    remainder, row = reduce_by_basis(target.set_ring(ring), [ring.zero] * len(zeros))
    return [q.set_ring(target.ring) for q in row], remainder.set_ring(target.ring)


@dataclass(frozen=True)
class Fraction:
    """A polynomial divided by a monomial."""

    numerator: PolyElement
    under: sp.Expr
    ring: PolyRing


def one_fraction(value: sp.Expr, symbols: Sequence[sp.Symbol]) -> Fraction:
    """Return a value, whose denominators are monomials, as one fraction. Raises NotExactError if it is too large."""
    ring = PolyRing(list(symbols) or [sp.Dummy()], sp.QQ, sp.lex)
    quotient = _quotient(value, ring, {symbol: ring.gens[i] for i, symbol in enumerate(symbols)})
    numerator, powers = quotient
    under = sp.Mul(*(symbol**n for symbol, n in zip(symbols, powers, strict=False) if n))
    return Fraction(numerator, under, ring)


_Quotient = tuple[PolyElement, tuple[int, ...]]


def _quotient(node: sp.Expr, ring: PolyRing, symbols: dict[sp.Symbol, PolyElement]) -> _Quotient:
    """Return the numerator of a value, and the exponents of the monomial that is the denominator."""
    none = (0,) * ring.ngens
    if node.is_Rational:
        return ring(sp.QQ(node.p, node.q)), none
    if node.is_Symbol:
        return symbols[node], none
    fractions = [_quotient(argument, ring, symbols) for argument in (node.args if not node.is_Pow else node.args[:1])]
    if node.is_Add:
        common = tuple(map(max, *(powers for _, powers in fractions)))
        shifts = [tuple(a - b for a, b in zip(common, powers, strict=True)) for _, powers in fractions]
        raised = (p * ring({shift: sp.QQ(1)}) for (p, _), shift in zip(fractions, shifts, strict=True))
        return _bounded(reduce(lambda a, b: a + b, raised)), common
    if node.is_Mul:
        return reduce(_times, fractions)
    [(over, under)], n = fractions, int(node.exp)
    if n > 0:
        return reduce(_times, [(over, under)] * n)
    if len(over) != 1:
        raise NotExactError(f"{node} is divided by a sum")
    [(powers, coefficient)] = over.terms()
    reciprocal: _Quotient = ring({tuple(under): 1 / coefficient}), powers
    return reduce(_times, [reciprocal] * -n)


def _times(a: _Quotient, b: _Quotient) -> _Quotient:
    over, under = _bounded(a[0] * b[0]), tuple(x + y for x, y in zip(a[1], b[1], strict=True))
    if not over or not any(under):
        return over, under if over else (0,) * len(under)
    shared = [min(least, n) for least, n in zip(map(min, zip(*over.itermonoms(), strict=True)), under, strict=True)]
    if any(shared):
        over = over.ring({tuple(x - y for x, y in zip(m, shared, strict=True)): c for m, c in over.terms()})
    return over, tuple(x - y for x, y in zip(under, shared, strict=True))


def _bounded(polynomial: PolyElement) -> PolyElement:
    if len(polynomial) > _MOST_TERMS:
        raise NotExactError(f"its numerator has more than {_MOST_TERMS} terms")
    return polynomial
