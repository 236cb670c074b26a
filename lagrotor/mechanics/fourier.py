"""Truncated power series in an amplitude whose coefficients are trigonometric polynomials of a phase.

    f(eps, Phi) = sum_n eps^n sum_h ( c_nh cos(h Phi) + s_nh sin(h Phi) ),    n <= order,

with coefficients in any exact field (rationals, or rational functions of parameters as sympy domain elements).

A `GrowingSeries` is such a series that is known order by order. An equation is written once, of series whose higher orders are
still unknown. Its coefficient of eps**n is then evaluated from those of the parts up to n, which are kept: through order N an
equation costs about N**2 products of harmonics, where one that is evaluated anew for each order costs N**3.
van der Hoeven, Relax, but don't be too lazy, J. Symb. Comp. 34 (2002).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import lcm
from typing import Any

from sympy import QQ, ZZ

Key = tuple[int, int]  # (power of eps, harmonic): cos(h Phi) for h >= 0, sin(|h| Phi) for h < 0
Coefficient = Any  # an element of the field
Waves = Mapping[int, Coefficient]  # of one power of eps
Series = Any  # a FourierSeries, or what is added, multiplied and differentiated like one


@dataclass(frozen=True)
class FourierSeries:
    """The nonzero coefficients {(n, h): value} through eps**order: of eps^n cos(h Phi), for h < 0 of eps^n sin(|h| Phi)."""

    terms: Mapping[Key, Coefficient]
    order: int

    def __add__(self, other: FourierSeries) -> FourierSeries:
        total = dict(self.terms)
        for key, value in other.terms.items():
            total[key] = total[key] + value if key in total else value
        return FourierSeries({k: v for k, v in total.items() if v}, self.order)

    def __neg__(self) -> FourierSeries:
        return self.times(-1)

    def __sub__(self, other: FourierSeries) -> FourierSeries:
        return self + (-other)

    def __mul__(self, other: FourierSeries) -> FourierSeries:
        """Product; terms beyond the order are dropped."""
        one, two = self.by_power(), other.by_power()
        total: dict[int, dict[int, Coefficient]] = defaultdict(lambda: defaultdict(int))
        for n, first in one.items():
            for m, second in two.items():
                if n + m <= self.order:
                    add_twice_the_product(total[n + m], first, second)
        return FourierSeries({(n, h): v / 2 for n, waves in total.items() for h, v in waves.items() if v}, self.order)

    def by_power(self) -> dict[int, dict[int, Coefficient]]:
        """The coefficients {n: {h: value}}; empty for every other n."""
        powers: dict[int, dict[int, Coefficient]] = defaultdict(dict)
        for (n, h), value in self.terms.items():
            powers[n][h] = value
        return powers

    def times(self, factor: Coefficient) -> FourierSeries:
        """factor × f."""
        return FourierSeries({k: v * factor for k, v in self.terms.items()}, self.order)

    def raised(self, n: int) -> FourierSeries:
        """eps**n × f."""
        return FourierSeries({(m + n, h): v for (m, h), v in self.terms.items() if m + n <= self.order}, self.order)

    def convert(self, value: Callable[[Any], Coefficient]) -> FourierSeries:
        """The same series with its coefficients converted, as by `float`."""
        return FourierSeries({k: value(v) for k, v in self.terms.items()}, self.order)

    def derivative(self) -> FourierSeries:
        """df/dPhi."""
        return FourierSeries({(n, -h): -h * v for (n, h), v in self.terms.items() if h}, self.order)

    def half_period_later(self) -> FourierSeries:
        """f(Phi + pi)."""
        return FourierSeries({(n, h): -v if h % 2 else v for (n, h), v in self.terms.items()}, self.order)

    def constant(self, value: Coefficient) -> FourierSeries:
        """The constant `value`, through the same order."""
        return constant_series(value, self.order)

    def through(self, order: int) -> FourierSeries:
        """The same series truncated at, or meant through, another order."""
        return FourierSeries({k: v for k, v in self.terms.items() if k[0] <= order}, order)

    def harmonics(self, n: int) -> dict[int, Coefficient]:
        """The coefficients {h: value} of eps**n."""
        return {h: v for (m, h), v in self.terms.items() if m == n}


def constant_series(value: Coefficient, order: int, power: int = 0) -> FourierSeries:
    """value eps**power, without a phase."""
    return FourierSeries({(power, 0): value} if value else {}, order)


def add_twice_the_product(total: dict[int, Coefficient], first: Waves, second: Waves) -> None:
    """Twice the product is added to the total, by 2 cos p cos q = cos(p−q) + cos(p+q) and its kin."""
    for q, v in second.items():
        for p, u in first.items():
            part = u * v
            i, j = abs(p), abs(q)
            if p >= 0 and q >= 0:
                total[abs(i - j)] += part
                total[i + j] += part
            elif p < 0 and q < 0:
                total[abs(i - j)] += part
                total[i + j] -= part
            else:
                sine, cosine = (i, j) if p < 0 else (j, i)
                total[-(i + j)] += part
                if sine != cosine:
                    total[-abs(sine - cosine)] += part if sine > cosine else -part


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
