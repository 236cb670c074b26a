"""Fourier series in an amplitude that are known order by order, and what is made of them, each order computed once.

An equation is written once, of series whose higher orders are still unknown. Its coefficient of eps**n is then evaluated from
those of the parts up to n, which are kept: through order N an equation costs about N**2 products of harmonics, where one that
is evaluated anew for each order costs N**3. van der Hoeven, Relax, but don't be too lazy, J. Symb. Comp. 34 (2002).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from math import lcm

from sympy import QQ, ZZ

from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Waves, add_twice_the_product

Pairs = list[tuple[Waves, Waves]]


@dataclass(eq=False)
class GrowingSeries:
    """A series whose coefficients of eps**n are `compute`d when they are read, and kept. `all`: every series made together."""

    compute: Callable[[int], Waves]
    all: list[GrowingSeries] = field(repr=False)
    kept: dict[int, Waves] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.all.append(self)

    def at(self, n: int) -> Waves:
        """The coefficients of eps**n."""
        if n not in self.kept:
            self.kept[n] = self.compute(n)
        return self.kept[n]

    def _series(self, compute: Callable[[int], Waves]) -> GrowingSeries:
        return GrowingSeries(compute, self.all)

    def __add__(self, other: GrowingSeries) -> GrowingSeries:
        return self._series(lambda n: _sum(self.at(n), other.at(n)))

    def __neg__(self) -> GrowingSeries:
        return self._series(lambda n: {h: -v for h, v in self.at(n).items()})

    def __sub__(self, other: GrowingSeries) -> GrowingSeries:
        return self + (-other)

    def __mul__(self, other: GrowingSeries) -> GrowingSeries:
        return self._series(lambda n: _product([(self.at(m), other.at(n - m)) for m in range(n + 1)]))

    def times(self, factor: Coefficient) -> GrowingSeries:
        """factor × f."""
        return self._series(lambda n: {h: v * factor for h, v in self.at(n).items()})

    def raised(self, n: int) -> GrowingSeries:
        """eps**n × f."""
        return self._series(lambda k: self.at(k - n) if k >= n else {})

    def derivative(self) -> GrowingSeries:
        """df/dPhi."""
        return self._series(lambda n: {-h: -h * v for h, v in self.at(n).items() if h})

    def half_period_later(self) -> GrowingSeries:
        """f(Phi + pi)."""
        return self._series(lambda n: {h: -v if h % 2 else v for h, v in self.at(n).items()})

    def constant(self, value: Coefficient) -> GrowingSeries:
        """The constant `value`."""
        return self._series(lambda n: {0: value} if n == 0 and value else {})


class Unknowns:
    """Series whose coefficients are found order by order, and the equations made of them."""

    def __init__(self) -> None:
        self._all: list[GrowingSeries] = []
        self._known: dict[GrowingSeries, dict[int, dict[int, Coefficient]]] = {}

    def series(self, known: FourierSeries) -> GrowingSeries:
        """An unknown that begins with the terms of `known`."""
        terms = known.by_power()
        made = GrowingSeries(lambda n: terms.get(n, {}), self._all)
        self._known[made] = terms
        return made

    def put(self, series: GrowingSeries, n: int, h: int, value: Coefficient) -> None:
        """Set a coefficient of an unknown; `forget` what was computed without it.

        Args:
            series: the unknown.
            n: of eps**n.
            h: its harmonic.
            value: the coefficient.
        """
        if value:
            self._known[series][n][h] = value

    def forget(self, n: int) -> None:
        """Compute the coefficients of eps**n anew when they are next read."""
        for series in self._all:
            series.kept.pop(n, None)

    def through(self, series: GrowingSeries, order: int) -> FourierSeries:
        """An unknown's terms that are known, through eps**order."""
        terms = self._known[series].items()
        return FourierSeries({(n, h): v for n, waves in terms for h, v in waves.items() if n <= order}, order)


def _sum(a: Waves, b: Waves) -> Waves:
    total = dict(a)
    for h, value in b.items():
        total[h] = total[h] + value if h in total else value
    return {h: v for h, v in total.items() if v}


def _product(pairs: Pairs) -> Waves:
    """The sum of products of waves; of rational ones by whole numbers over one denominator, reduced once a harmonic."""
    whole, below = _over_one_denominator(pairs)
    total: dict[int, Coefficient] = defaultdict(int)
    for first, second in whole:
        add_twice_the_product(total, first, second)
    return {h: QQ(v, 2 * below) if isinstance(v, ZZ.dtype) else v / 2 for h, v in total.items() if v}


def _over_one_denominator(pairs: Pairs) -> tuple[Pairs, int]:
    """Pairs of rational waves as whole numbers, and the denominator of all their products; others as they are, over 1."""
    if not all(isinstance(v, QQ.dtype) for pair in pairs for waves in pair for v in waves.values()):
        return pairs, 1
    each = [(_whole(first), _whole(second)) for first, second in pairs]
    below = lcm(*(a * b for (_, a), (_, b) in each))
    return [(f, {h: v * (below // (a * b)) for h, v in s.items()}) for (f, a), (s, b) in each], below


def _whole(waves: Waves) -> tuple[Waves, int]:
    """Rational waves as whole numbers over one denominator."""
    below = lcm(*(int(v.denominator) for v in waves.values()))
    return {h: v.numerator * (below // v.denominator) for h, v in waves.items()}, below
