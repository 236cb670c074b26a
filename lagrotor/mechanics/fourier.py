"""Truncated power series in an amplitude whose coefficients are trigonometric polynomials of a phase.

    f(eps, Phi) = sum_n eps^n sum_h ( c_nh cos(h Phi) + s_nh sin(h Phi) ),    n <= order,

with coefficients in any exact field (rationals, or rational functions of parameters as sympy domain elements).
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Key = tuple[int, int]  # (power of eps, harmonic): cos(h Phi) for h >= 0, sin(|h| Phi) for h < 0
Coefficient = Any  # an element of the field
Waves = Mapping[int, Coefficient]  # of one power of eps
Series = Any  # a FourierSeries, or what is added, multiplied and differentiated like one


@dataclass(frozen=True)
class FourierSeries:
    """The nonzero coefficients {(n, h): value} through eps**order: of eps^n cos(h Phi), for h < 0 of eps^n sin(|h| Phi)."""

    terms: Mapping[Key, Coefficient]
    order: int

    def __add__(self, other: "FourierSeries") -> "FourierSeries":
        total = dict(self.terms)
        for key, value in other.terms.items():
            total[key] = total[key] + value if key in total else value
        return FourierSeries({k: v for k, v in total.items() if v}, self.order)

    def __neg__(self) -> "FourierSeries":
        return self.times(-1)

    def __sub__(self, other: "FourierSeries") -> "FourierSeries":
        return self + (-other)

    def __mul__(self, other: "FourierSeries") -> "FourierSeries":
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

    def times(self, factor: Coefficient) -> "FourierSeries":
        """factor × f."""
        return FourierSeries({k: v * factor for k, v in self.terms.items()}, self.order)

    def raised(self, n: int) -> "FourierSeries":
        """eps**n × f."""
        return FourierSeries({(m + n, h): v for (m, h), v in self.terms.items() if m + n <= self.order}, self.order)

    def convert(self, value: Callable[[Any], Coefficient]) -> "FourierSeries":
        """The same series with its coefficients converted, as by `float`."""
        return FourierSeries({k: value(v) for k, v in self.terms.items()}, self.order)

    def derivative(self) -> "FourierSeries":
        """df/dPhi."""
        return FourierSeries({(n, -h): -h * v for (n, h), v in self.terms.items() if h}, self.order)

    def half_period_later(self) -> "FourierSeries":
        """f(Phi + pi)."""
        return FourierSeries({(n, h): -v if h % 2 else v for (n, h), v in self.terms.items()}, self.order)

    def constant(self, value: Coefficient) -> "FourierSeries":
        """The constant `value`, through the same order."""
        return constant_series(value, self.order)

    def through(self, order: int) -> "FourierSeries":
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
