"""Enclosures of Γ, of Bessel functions J of rational order, and of elliptic integrals K and E.

J is summed as a power series; K and E come from the arithmetic-geometric mean.

Abramowitz & Stegun, Handbook of Mathematical Functions, chs. 6, 9, 17.
"""

from collections.abc import Sequence
from typing import Any

import sympy as sp
from mpmath import iv, libmp
from mpmath.ctx_iv import ivmpc

from lagrotor.errors import NotExactError

_LARGEST = 60  # largest argument of a series


def _ball(radius: Any) -> Any:
    return iv.mpf([-1, 1]) * radius


def _check(x: Any) -> None:
    if not abs(x).b < _LARGEST:
        raise NotExactError("The argument is too large for the sum of a series.")


def _series(first: Any, ratio: Any, above: Any) -> Any:
    """Enclose first + first*ratio(0) + first*ratio(0)*ratio(1) + …; above(k) bounds |ratio| from index k on."""
    total, term, k = first, first, 0
    least = iv.mpf(2) ** (-iv.prec - 20)
    while True:
        term = term * ratio(k)
        total, k = total + term, k + 1
        q = above(k)
        if q.b < 0.5 and abs(term).b < least.b:
            return total + _ball(abs(term) * q / (1 - q))  # bound by a geometric series
        if k > 20 * iv.prec:
            raise NotExactError("A series does not converge.")


def _gamma(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    [x] = values
    if orders[0].is_integer and orders[0].is_nonpositive:
        raise NotExactError("The gamma function has a pole there.")
    _check(x)
    return iv.gamma(x)


def _binomial(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    if all(order.is_Integer for order in orders):
        value = sp.binomial(*orders)
        return iv.mpf(int(value))
    n, k = values
    return iv.gamma(n + 1) / (iv.gamma(k + 1) * iv.gamma(n - k + 1))


def _bessel(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    """Return the Bessel function J of order v at x, (x/2)ᵛ Σ (−x²/4)ᵏ/(k! Γ(v + k + 1)), for x > 0 or integer v."""
    v, x = orders[0], values[1]
    if not v.is_Rational:
        raise NotExactError("A Bessel function is enclosed at rational orders only.")
    if isinstance(x, ivmpc):
        raise NotExactError("A special function is enclosed at real arguments only.")
    _check(x)
    flip, v = ((-1) ** int(v), -v) if v.is_Integer and v < 0 else (1, v)
    order, quarter, half = iv.mpf(v.p) / v.q, -x * x / 4, x / 2
    if v.is_Integer:
        first = half ** int(v) / iv.gamma(order + 1)
    elif half.a > 0:
        first = iv.exp(order * iv.log(half)) / iv.gamma(order + 1)
    else:
        raise NotExactError("A Bessel function of non-integer order is enclosed at positive arguments only.")
    start = abs(int(v)) + 2
    return flip * _series(
        first,
        lambda k: quarter / ((k + 1) * (order + k + 1)),
        lambda k: abs(quarter) / ((k + 1) * (k + 1 - start)) if k > start else iv.mpf(1),
    )


def _elliptic(orders: Sequence[sp.Expr], values: Sequence[Any], second: bool = False) -> Any:
    """Return K(m) = π/(2 M(1, √(1−m))) with the arithmetic-geometric mean M, or E = K (1 − Σ 2ⁿ⁻¹ cₙ²), for m < 1."""
    if len(values) != 1 or isinstance(values[0], ivmpc) or not values[0].b < 1:
        raise NotExactError("Elliptic integrals are enclosed at m < 1 only.")
    [m] = values
    a, g, total, weight = iv.mpf(1), iv.sqrt(1 - m), m / 2, iv.mpf(1)
    while abs(a - g).b > 2.0 ** (-iv.prec + 8) and weight < 2**200:
        c = (a - g) / 2
        a, g = (a + g) / 2, iv.sqrt(a * g)
        total = total + weight * c * c
        weight = weight * 2
    mean = iv.mpf([min(a.a, g.a), max(a.b, g.b)])
    first = iv.pi / (2 * mean)
    if not second:
        return first
    c = (a - g) / 2  # each further term is at most half of the one before
    return first * (1 - total + _ball(2 * weight * c * c))


SPECIAL: dict[Any, Any] = {
    sp.atan2: lambda orders, values: iv.make_mpf(libmp.mpi_atan2(*(x._mpi_ for x in values), iv.prec)),
    sp.gamma: _gamma,
    sp.factorial: lambda orders, values: _gamma([orders[0] + 1], [values[0] + 1]),
    sp.binomial: _binomial,
    sp.besselj: _bessel,
    sp.elliptic_k: _elliptic,
    sp.elliptic_e: lambda orders, values: _elliptic(orders, values, True),
}
