"""Zero test of an expression modulo relations between its symbols.

Some symbols ρ represent roots, ρ**q = B; others represent algebraic numbers.  A numerator is reduced to degree below q in each
ρ and vanishes if each of its coefficients, algebraic numbers, vanishes.  This proves zero for any further relations between the
symbols; a nonzero result decides nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import sympy as sp
from sympy.polys.rings import PolyElement

from lagrotor.algebra.algebraic_numbers import is_zero
from lagrotor.algebra.generators import survey
from lagrotor.algebra.quotients import Ring
from lagrotor.algebra.reading import Reader, find_roots, reader
from lagrotor.errors import NotExactError

# symbol -> (q, B): symbol**q = B, where B holds only symbols with earlier relations.
Relations: TypeAlias = Mapping[sp.Symbol, tuple[int, sp.Expr]]


def vanishes(expression: sp.Expr, relations: Relations, numbers: Mapping[sp.Symbol, sp.Expr]) -> tuple[Ring, bool]:
    """Return the ring, which has recorded all divisors, and True if the relations imply that the expression is zero.

    Raise NotExactError if the expression is outside the class.
    """
    content = survey(expression, *relations, *(value for _, value in relations.values()))
    roots = find_roots(content)
    if roots.unsigned:
        raise NotExactError("The sign of a root may differ from region to region.")
    reading = reader(content, roots)
    numerator = reading.quotient(expression).numerator
    divisors = list(reading.ring.divisors)
    if any(_is_null(divisor, reading, relations, numbers) for divisor in divisors):
        raise NotExactError("A denominator vanishes identically.")
    return reading.ring, _is_null(numerator, reading, relations, numbers)


def _is_null(
    polynomial: PolyElement, reading: Reader, relations: Relations, numbers: Mapping[sp.Symbol, sp.Expr]
) -> bool:
    ring = reading.ring
    for symbol, (q, value) in reversed(list(relations.items())):
        polynomial = _reduced(polynomial, ring.names.index(symbol), q, reading, value)
    if not polynomial or not numbers:
        return not polynomial
    constant = [not (name.free_symbols - set(numbers)) and name is not sp.pi for name in ring.names]
    coefficients: dict[tuple[int, ...], sp.Expr] = {}
    for monomial, c in polynomial.iterterms():
        key = tuple(0 if fixed else n for n, fixed in zip(monomial, constant, strict=True))
        term = sp.Mul(
            sp.Rational(int(c.numerator), int(c.denominator)),
            *(
                name.xreplace(dict(numbers)) ** n
                for name, n, fixed in zip(ring.names, monomial, constant, strict=True)
                if fixed
            ),
        )
        coefficients[key] = coefficients.get(key, sp.S.Zero) + term
    return all(is_zero(coefficient) for coefficient in coefficients.values())


def _reduced(polynomial: PolyElement, place: int, q: int, reading: Reader, value: sp.Expr) -> PolyElement:
    """Reduce a polynomial to degree below q in the symbol ρ at index `place`, by the relation ρ**q = value.

    The result is a multiple of the polynomial, because the denominators of the value are multiplied out.
    """
    degree = max((monomial[place] for monomial in polynomial.itermonoms()), default=0)
    if degree < q:
        return polynomial
    ring, (over, factors) = reading.ring, reading.quotient(value)
    under = ring.expanded(factors)
    blocks: dict[int, dict[tuple[int, ...], object]] = {}
    for monomial, c in polynomial.iterterms():
        times, remainder = divmod(monomial[place], q)
        blocks.setdefault(times, {})[(*monomial[:place], remainder, *monomial[place + 1 :])] = c
    total = ring.polynomials.zero
    for times, block in blocks.items():
        scale = ring.product(ring.power(over, times), ring.power(under, degree // q - times))
        total += ring.product(scale, ring.polynomials.from_dict(block))
    return total
