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
        """Product, with cos p cos q = (cos(p−q) + cos(p+q))/2 and its kin; terms beyond the order are dropped."""
        total: dict[Key, Coefficient] = defaultdict(int)
        halves = sorted((m, q, v / 2) for (m, q), v in other.terms.items())
        for (n, p), u in self.terms.items():
            for m, q, v in halves:
                if n + m > self.order:
                    break
                half = u * v
                i, j = abs(p), abs(q)
                if p >= 0 and q >= 0:
                    total[n + m, abs(i - j)] += half
                    total[n + m, i + j] += half
                elif p < 0 and q < 0:
                    total[n + m, abs(i - j)] += half
                    total[n + m, i + j] -= half
                else:
                    sine, cosine = (i, j) if p < 0 else (j, i)
                    total[n + m, -(i + j)] += half
                    if sine != cosine:
                        total[n + m, -abs(sine - cosine)] += half if sine > cosine else -half
        return FourierSeries({k: v for k, v in total.items() if v}, self.order)

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
