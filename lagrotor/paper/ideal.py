"""Whether a difference vanishes wherever some polynomial equations hold: membership in their ideal, or in its radical.

Numerators are read in one ring of generators, with the relations of these, g² = square, among the equations. The radical is
reached by one more letter t and the equation 1 = t N D (Rabinowitsch), which also leaves out where a denominator D vanishes.
Cox, Little & O'Shea, Ideals, Varieties, and Algorithms, chs. 2, 4.
"""

from collections.abc import Sequence
from typing import Literal

import sympy as sp
from sympy.polys.groebnertools import groebner
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.algebra.generators import survey
from lagrotor.algebra.reading import find_roots, reader
from lagrotor.errors import NotExactError

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
