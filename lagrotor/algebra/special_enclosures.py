"""Enclosures of special functions at rational orders: power series with a bound on what is left out, means for K and E.

Abramowitz & Stegun, Handbook of Mathematical Functions, chs. 7, 9, 17.
"""

from collections.abc import Sequence
from math import ceil, factorial
from typing import Any

import sympy as sp
from mpmath import iv, libmp
from mpmath.ctx_iv import ivmpc

from lagrotor.errors import NotExactError

_LARGEST = 60  # arguments beyond which the series are not summed


def _ball(radius: Any) -> Any:
    return iv.mpf([-1, 1]) * radius


def _check(x: Any) -> None:
    if not abs(x).b < _LARGEST:
        raise NotExactError("A series is not summed at so large an argument.")


def _series(first: Any, ratio: Any, above: Any) -> Any:
    """Sum of the terms first, first*ratio(0), …, whose ratios fall; above(k) is at least |ratio| from k on."""
    total, term, k = first, first, 0
    least = iv.mpf(2) ** (-iv.prec - 20)
    while True:
        term = term * ratio(k)
        total, k = total + term, k + 1
        q = above(k)
        if q.b < 0.5 and abs(term).b < least.b:
            return total + _ball(abs(term) * q / (1 - q))  # geometric
        if k > 20 * iv.prec:
            raise NotExactError("A series does not settle.")


def _erf(_: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    """2/√π Σ (−1)ᵏ x²ᵏ⁺¹/(k! (2k + 1)), real x."""
    [x] = values
    _real(x)
    _check(x)
    square = x * x
    total, power, k = x, x, 0
    while True:
        k += 1
        power = -power * square / k
        total = total + power / (2 * k + 1)
        if k > 2 * ceil(float(square.b)) + 2 and abs(power).b < 2.0 ** (-iv.prec - 20):
            return (total + _ball(2 * abs(power))) * 2 / iv.sqrt(iv.pi)


def _real(x: Any) -> None:
    if isinstance(x, ivmpc):
        raise NotExactError("A special function is enclosed at real arguments only.")


def _gamma(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    [x] = values
    if orders[0].is_integer and orders[0].is_nonpositive:
        raise NotExactError("A pole of the gamma function.")
    _check(x)
    return iv.gamma(x)


def _binomial(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    if all(order.is_Integer for order in orders):
        value = sp.binomial(*orders)
        return iv.mpf(int(value))
    n, k = values
    return iv.gamma(n + 1) / (iv.gamma(k + 1) * iv.gamma(n - k + 1))


def _beta(_: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    a, b = values
    _check(a)
    _check(b)
    return iv.gamma(a) * iv.gamma(b) / iv.gamma(a + b)


def _log_gamma(_: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    [x] = values
    if isinstance(x, ivmpc) or not x.a > 0:
        raise NotExactError("ln Γ is enclosed at x > 0 only.")
    return iv.log(iv.gamma(x))


def _polygamma(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
    """ψ⁽ⁿ⁾(x), x > 0: shifted up, then its asymptotic series, whose rest has the sign of its first term and is less than it
    (Abramowitz & Stegun 6.3.18, 6.4.11)."""
    n, x = orders[0], values[1]
    if not n.is_Integer or not 0 <= n <= 20 or isinstance(x, ivmpc) or not x.a > 0:
        raise NotExactError("ψ is enclosed at x > 0, of whole order, only.")
    n, total, sign = int(n), iv.mpf(0), 1 if int(n) % 2 else -1
    while x.a < 40:
        total += sign * factorial(n) / x ** (n + 1)
        x = x + 1
    series = factorial(n) / (2 * x ** (n + 1)) + (factorial(n - 1) / x**n if n else 0)
    for k in range(1, 30):
        b = sp.bernoulli(2 * k)
        term = iv.mpf(b.p) / b.q * factorial(2 * k + n - 1) / (factorial(2 * k) * x ** (2 * k + n))
        series += term if k < 29 else iv.mpf([min(term.a, 0), max(term.b, 0)])
    return total + sign * series + (iv.log(x) if not n else 0)


def _bessel(sign: int) -> Any:
    """(x/2)ᵛ Σ (±x²/4)ᵏ/(k! Γ(v + k + 1)), x > 0 or v whole; − for J, + for I."""

    def value(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
        v, x = orders[0], values[1]
        if not v.is_Rational:
            raise NotExactError("A Bessel function is enclosed at rational orders only.")
        _real(x)
        _check(x)
        if v.is_Integer and v < 0:
            v, flip = -v, (-1) ** int(v) if sign < 0 else 1
        else:
            flip = 1
        order = iv.mpf(v.p) / v.q
        quarter = sign * x * x / 4
        half = x / 2
        if v.is_Integer:
            first = half ** int(v) / iv.gamma(order + 1)
        elif half.a > 0:
            first = iv.exp(order * iv.log(half)) / iv.gamma(order + 1)
        else:
            raise NotExactError("A Bessel function of broken order is enclosed at positive arguments only.")
        start = abs(int(v)) + 2
        return flip * _series(
            first,
            lambda k: quarter / ((k + 1) * (order + k + 1)),
            lambda k: abs(quarter) / ((k + 1) * (k + 1 - start)) if k > start else iv.mpf(1),
        )

    return value


_J, _I = _bessel(-1), _bessel(1)


def _second(sign: int) -> Any:
    """Y (−) and K (+), x > 0: from J or I of orders ±v, or the series with digamma where v is whole."""
    first = _J if sign < 0 else _I

    def value(orders: Sequence[sp.Expr], values: Sequence[Any]) -> Any:
        v, x = orders[0], values[1]
        if not v.is_Rational or isinstance(x, ivmpc) or not x.a > 0:
            raise NotExactError("A Bessel function is enclosed at rational orders and positive arguments only.")
        _check(x)
        plus, minus = (first([each], [None, x]) for each in (v, -v))
        if not v.is_Integer:
            angle = iv.pi * v.p / v.q
            if sign < 0:
                return (plus * iv.cos(angle) - minus) / iv.sin(angle)
            return iv.pi / 2 * (minus - plus) / iv.sin(angle)
        n = abs(int(v))
        flip = (-1) ** n if int(v) < 0 and sign < 0 else 1
        plus = first([sp.Integer(n)], [None, x])
        quarter, half = sign * x * x / 4, x / 2
        low = sum(
            (iv.mpf(int(sp.factorial(n - k - 1))) / int(sp.factorial(k)) * (-quarter) ** k for k in range(n)), iv.mpf(0)
        )
        low = low / half**n
        sums = [-2 * iv.euler + sum((iv.mpf(1) / j for j in range(1, n + 1)), iv.mpf(0))]
        total, weight, k = iv.mpf(0), iv.mpf(1) / int(sp.factorial(n)), 0
        while True:
            term = weight * sums[-1]
            total = total + term
            k += 1
            weight = weight * quarter / (k * (n + k))
            sums.append(sums[-1] + iv.mpf(1) / k + iv.mpf(1) / (n + k))
            # from here the ratio of terms is below |x²/4|/k² (1 + 2/k) < 1/2, so that as much is left as the last term
            if k * k > 8 * abs(quarter).b + 64 and abs(weight * sums[-1]).b < 2.0 ** (-iv.prec - 20):
                total = total + _ball(2 * abs(weight * sums[-1]))
                break
        if sign < 0:
            return flip * (-low + 2 * iv.log(half) * plus - half**n * total) / iv.pi
        return low / 2 + (-1) ** (n + 1) * iv.log(half) * plus + (-1) ** n * half**n * total / 2

    return value


def _elliptic(orders: Sequence[sp.Expr], values: Sequence[Any], second: bool = False) -> Any:
    """K(m) = π/(2 M(1, √(1−m))), M the arithmetic-geometric mean; E/K = 1 − Σ 2ⁿ⁻¹ cₙ²; m < 1."""
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
    sp.beta: _beta,
    sp.loggamma: _log_gamma,
    sp.polygamma: _polygamma,
    sp.erf: _erf,
    sp.erfc: lambda orders, values: 1 - _erf(orders, values),
    sp.besselj: _J,
    sp.besseli: _I,
    sp.bessely: _second(-1),
    sp.besselk: _second(1),
    sp.elliptic_k: _elliptic,
    sp.elliptic_e: lambda orders, values: _elliptic(orders, values, True),
}
