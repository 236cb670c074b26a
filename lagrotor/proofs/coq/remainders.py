"""The order to which two sides agree in a small quantity.

Their difference is a power of the small quantity times a factor that is finite at zero. Near zero cos b = 1 - u sin(b)^2 with u
= 1/(1 + cos b). A root y of R with the value y_0 at zero is y = y_0 + (R - y_0^2) w with w = 1/(y + y_0). Terms of too low an
order that contain u or w are expanded by u = 1/2 + u^2 sin(b)^2/2 and w = 1/(2 y_0) - (R - y_0^2) w^2/(2 y_0). These identities
give a polynomial; its terms of low order must vanish. The others are written in cosines and roots again, so that Coq checks an
exact identity.
"""

from dataclasses import dataclass

import sympy as sp

from lagrotor.errors import NotExactError
from lagrotor.proofs.coq.equality_steps import Sides

_MOST_TERMS = 4000


@dataclass(frozen=True)
class SeriesRemainder:
    """A difference as power * factor; `at_zero` is the factor at small = 0, None if it is only a limit there."""

    power: sp.Expr
    factor: sp.Expr
    at_zero: sp.Expr | None = None


def value_at_zero(sides: Sides, expression: sp.Expr, small: sp.Symbol) -> sp.Expr:
    """Return the value of an expression at small = 0, in functions of the other symbols."""
    over, under = sides.in_generators(expression)
    return sp.cancel((over / under).xreplace(sides.meaning()).xreplace({small: sp.S.Zero}))


def remainder(sides: Sides, difference: sp.Expr, small: sp.Symbol, order: int) -> SeriesRemainder:
    """Write a difference as small**order * factor, or as a power of the sine of small times a factor.

    Raises NotExactError if terms of lower order do not vanish, or a function has no such form.
    """
    over, under = sides.in_generators(difference)
    near = _Near(sides, small)
    meaning, used = near.meaning, near.small_symbols(over)
    for function in (meaning.get(x, x) for x in over.free_symbols - {*near.put, *near.weights}):
        if small in function.free_symbols:
            raise NotExactError(f"{function} is a series in {small}")
    if under.xreplace(meaning).xreplace({small: sp.S.Zero}) == 0:
        raise NotExactError(f"the difference is not finite where {small} is zero")
    polynomial = near.expanded(over, order)
    if len(used) <= 1 and all(near.weights[x] == 1 for x in used):
        symbol = next(iter(used), small)
        power = meaning.get(symbol, symbol)
        factor = (sp.expand(polynomial / symbol**order) / under).xreplace(meaning)
        return SeriesRemainder(power**order, factor, factor.xreplace({small: sp.S.Zero}))
    over_small = {x: sp.Dummy() for x in used if x is not small}
    scaled = polynomial.xreplace({x: y * small ** near.weights[x] for x, y in over_small.items()})
    meanings = {y: meaning[x] / small ** near.weights[x] for x, y in over_small.items()}
    factor = (sp.expand(scaled / small**order) / under).xreplace(meaning).xreplace(meanings)
    return SeriesRemainder(small**order, factor)


class _Near:
    """The expansion of the generators near small = 0.

    `weights` has the order of each small symbol. `put` has the value of each cosine and root in small symbols and rule symbols.
    `rules` has the expansion of each rule symbol to the next order. `meaning` has the function for which a symbol stands.
    """

    def __init__(self, sides: Sides, small: sp.Symbol) -> None:
        self.small, self.meaning = small, sides.meaning()
        self.weights: dict[sp.Symbol, int] = {small: 1}
        self.put: dict[sp.Symbol, sp.Expr] = {}
        self.rules: dict[sp.Symbol, sp.Expr] = {}
        at_zero: dict[sp.Symbol, sp.Expr] = {small: sp.S.Zero}
        for base, (cosine, sine) in sides.small_pairs(small).items():
            symbol = sp.Dummy("u")
            self.weights[sine] = int(base.as_powers_dict()[small])
            self.put[cosine] = 1 - sine**2 * symbol
            self.rules[symbol] = sp.S.Half + sine**2 * symbol**2 / 2
            self.meaning[symbol] = 1 / (1 + self.meaning[cosine])
            at_zero |= {sine: sp.S.Zero, cosine: sp.S.One}
        earlier: list[tuple[sp.Symbol, sp.Expr]] = []
        for generator, square in sorted(sides.roots(), key=lambda row: str(row[0])):
            if small in self.meaning[generator].free_symbols:
                value = sp.sqrt(sp.expand(square.xreplace(at_zero)))
                self._add_root(generator, sp.expand(square.xreplace(self.put)), value, earlier)

    def _add_root(
        self, root: sp.Symbol, square: sp.Expr, at_zero: sp.Expr, earlier: list[tuple[sp.Symbol, sp.Expr]]
    ) -> None:
        """Expand a root about the earlier root or number whose square agrees with the radicand to the highest order."""
        if not at_zero.is_Rational or at_zero == 0:
            raise NotExactError(
                f"{self.meaning[root]} has no nonzero rational value at {self.small} = 0, which a certificate needs"
            )
        symbol, bases = sp.Dummy("w"), [(at_zero, at_zero**2), *earlier]
        gaps = [(y, sp.expand(square - base_square)) for y, base_square in bases]
        base, gap = max(gaps, key=lambda row: self.least(row[1]))
        self.put[root] = base + gap * symbol
        self.meaning[symbol] = 1 / (self.meaning[root] + self.meaning.get(base, base))
        if base is at_zero:
            self.rules[symbol] = 1 / (2 * at_zero) - gap * symbol**2 / (2 * at_zero)
        earlier.append((root, square))

    def small_symbols(self, expression: sp.Expr) -> set[sp.Symbol]:
        """Return the small symbols of an expression after substitution of its cosines and roots."""
        symbols = expression.free_symbols
        inner = (self.small_symbols(self.put[symbol]) for symbol in symbols if symbol in self.put)
        return set(symbols & set(self.weights)).union(*inner)

    def least(self, expression: sp.Expr) -> int:
        """Return the lowest order of a polynomial in the small symbols; a large number for zero."""
        return min(map(self._order_of, sp.Add.make_args(expression))) if expression != 0 else 10**6

    def _order_of(self, term: sp.Expr) -> int:
        powers = term.as_powers_dict()
        return sum(int(powers.get(symbol, 0)) * weight for symbol, weight in self.weights.items())

    def expanded(self, over: sp.Expr, order: int) -> sp.Expr:
        """Substitute every cosine and root in a polynomial, and return it; terms below the order must cancel."""
        while over.free_symbols & set(self.put):
            over = _bounded(sp.expand(over.xreplace(self.put)))
        high = sp.S.Zero
        while over != 0:
            low = [term for term in sp.Add.make_args(over) if self._order_of(term) < order]
            high += over - sp.Add(*low)
            if low and not any(term.free_symbols & set(self.rules) for term in low):
                raise NotExactError(f"the two sides differ at order {self.least(sp.Add(*low))} in {self.small}")
            over = _bounded(sp.expand(sp.Add(*map(self._next, low))))
        return sp.expand(high)

    def _next(self, term: sp.Expr) -> sp.Expr:
        """Expand one rule symbol in a term of too low an order; a term without rule symbols is returned unchanged."""
        symbol = next((x for x in self.rules if x in term.free_symbols), None)
        return term if symbol is None else term / symbol * self.rules[symbol]


def _bounded(expression: sp.Expr) -> sp.Expr:
    if len(sp.Add.make_args(expression)) > _MOST_TERMS:
        raise NotExactError(f"its series has more than {_MOST_TERMS} terms")
    return expression
