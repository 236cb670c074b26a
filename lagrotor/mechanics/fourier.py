"""Truncated power series in an amplitude whose coefficients are trigonometric polynomials of a phase.

    f(eps, Phi) = sum_n eps^n sum_h ( c_nh cos(h Phi) + s_nh sin(h Phi) ),    n <= order,

with coefficients in any exact field (rationals, or rational functions of parameters as sympy domain elements).

The coefficient of eps**n of a sum or product is computed when it is read, and cached. An equation is therefore written once, of
series whose higher orders are still unknown. Order N costs about N**2 products of harmonics instead of N**3.
van der Hoeven, Relax, but don't be too lazy, J. Symb. Comp. 34 (2002).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from math import lcm
from typing import Any

from sympy import QQ, ZZ

Key = tuple[int, int]  # (power of eps, harmonic): cos(h Phi) for h >= 0, sin(|h| Phi) for h < 0
Coefficient = Any  # an element of the field
Waves = Mapping[int, Coefficient]  # {harmonic: value} of one power of eps
Series = Any  # a FourierSeries, or an object with the same arithmetic
Pairs = list[tuple[Waves, Waves]]


class FourierSeries:
    """A series through eps**order from {(n, h): coefficient} of eps^n cos(h Phi), or of eps^n sin(|h| Phi) if h < 0."""

    def __init__(self, terms: Mapping[Key, Coefficient], order: int) -> None:
        powers: dict[int, dict[int, Coefficient]] = defaultdict(dict)
        for (n, h), value in terms.items():
            powers[n][h] = value
        self.order = order
        self._compute: Callable[[int], Waves] = powers.__getitem__
        self._parts: tuple[FourierSeries, ...] = ()
        self._cache: dict[int, Waves] = {}

    def _from(self, compute: Callable[[int], Waves], *others: FourierSeries) -> FourierSeries:
        series = FourierSeries({}, self.order)
        series._compute, series._parts = compute, (self, *others)
        return series

    def at(self, n: int) -> Waves:
        """Return the coefficients {h: value} of eps**n."""
        if n not in self._cache:
            self._cache[n] = self._compute(n)
        return self._cache[n]

    def assign(self, n: int, h: int, value: Coefficient) -> None:
        """Set one coefficient of a series that was made from terms. Call `forget` for series computed from it before."""
        if value:
            self._compute(n)[h] = value  # type: ignore[index]

    @property
    def terms(self) -> dict[Key, Coefficient]:
        """The coefficients {(n, h): value}."""
        return {(n, h): value for n in range(self.order + 1) for h, value in self.at(n).items()}

    def harmonics(self, n: int) -> dict[int, Coefficient]:
        """Return a copy of the coefficients {h: value} of eps**n."""
        return dict(self.at(n))

    def __add__(self, other: FourierSeries) -> FourierSeries:
        def total(n: int) -> Waves:
            waves = dict(self.at(n))
            for h, value in other.at(n).items():
                waves[h] = waves[h] + value if h in waves else value
            return {h: v for h, v in waves.items() if v}

        return self._from(total, other)

    def __neg__(self) -> FourierSeries:
        return self.times(-1)

    def __sub__(self, other: FourierSeries) -> FourierSeries:
        return self + (-other)

    def __mul__(self, other: FourierSeries) -> FourierSeries:
        return self._from(lambda n: _product([(self.at(m), other.at(n - m)) for m in range(n + 1)]), other)

    def times(self, factor: Coefficient) -> FourierSeries:
        return self._from(lambda n: {h: v * factor for h, v in self.at(n).items()})

    def raised(self, n: int) -> FourierSeries:
        """Return this series times eps**n."""
        return self._from(lambda k: self.at(k - n) if k >= n else {})

    def convert(self, value: Callable[[Any], Coefficient]) -> FourierSeries:
        """Return the same series with its coefficients converted, for instance by `float`."""
        return FourierSeries({k: value(v) for k, v in self.terms.items()}, self.order)

    def derivative(self) -> FourierSeries:
        """Return df/dPhi."""
        return self._from(lambda n: {-h: -h * v for h, v in self.at(n).items() if h})

    def half_period_later(self) -> FourierSeries:
        """Return f(Phi + pi)."""
        return self._from(lambda n: {h: -v if h % 2 else v for h, v in self.at(n).items()})

    def constant(self, value: Coefficient) -> FourierSeries:
        """Return the constant series `value` of the same order."""
        return constant_series(value, self.order)

    def through(self, order: int) -> FourierSeries:
        """Return the terms up to the power eps**order, as a series of that order."""
        return FourierSeries({k: v for k, v in self.terms.items() if k[0] <= order}, order)


def constant_series(value: Coefficient, order: int, power: int = 0) -> FourierSeries:
    return FourierSeries({(power, 0): value} if value else {}, order)


def forget(series: Sequence[FourierSeries], n: int) -> None:
    """Discard the cached coefficients of eps**n of these series and of all series that they depend on."""
    queue, visited = [*series], set[FourierSeries]()
    while queue:
        item = queue.pop()
        if item not in visited:
            visited.add(item)
            item._cache.pop(n, None)
            queue += item._parts


def _product(pairs: Pairs) -> Waves:
    """Return the harmonics of the sum of products f g over pairs (f, g) of trigonometric sums.

    Rational coefficients are multiplied as integers over one denominator, and reduced once for each harmonic.
    """
    integers, below = _over_one_denominator(pairs)
    total: dict[int, Coefficient] = defaultdict(int)
    for first, second in integers:
        _add_twice_the_product(total, first, second)
    return {h: QQ(v, 2 * below) if isinstance(v, ZZ.dtype) else v / 2 for h, v in total.items() if v}


def _add_twice_the_product(total: dict[int, Coefficient], first: Waves, second: Waves) -> None:
    """Add twice the product of two trigonometric sums to the total, by 2 cos p cos q = cos(p−q) + cos(p+q) and its like."""
    for q, v in second.items():
        for p, u in first.items():
            product = u * v
            i, j = abs(p), abs(q)
            if p >= 0 and q >= 0:
                total[abs(i - j)] += product
                total[i + j] += product
            elif p < 0 and q < 0:
                total[abs(i - j)] += product
                total[i + j] -= product
            else:
                sine, cosine = (i, j) if p < 0 else (j, i)
                total[-(i + j)] += product
                if sine != cosine:
                    total[-abs(sine - cosine)] += product if sine > cosine else -product


def _over_one_denominator(pairs: Pairs) -> tuple[Pairs, int]:
    """Return pairs with integer coefficients, and the common denominator of their products; if not rational, pairs and 1."""
    if not all(isinstance(v, QQ.dtype) for pair in pairs for waves in pair for v in waves.values()):
        return pairs, 1
    integers = [(_integers(first), _integers(second)) for first, second in pairs]
    below = lcm(*(a * b for (_, a), (_, b) in integers))
    return [(f, {h: v * (below // (a * b)) for h, v in s.items()}) for (f, a), (s, b) in integers], below


def _integers(waves: Waves) -> tuple[Waves, int]:
    """Return the rational coefficients of a trigonometric sum as integer numerators, and their common denominator."""
    below = lcm(*(int(v.denominator) for v in waves.values()))
    return {h: v.numerator * (below // v.denominator) for h, v in waves.items()}, below
