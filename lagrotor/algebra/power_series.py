"""Truncated power series in a small quantity, and the first term in which two expressions differ.

With e the small quantity, a series is carried as the finitely many terms

    e**start * (a_0 + a_1*e + ... + a_(n-1)*e**(n-1)) + O(e**(start + n)),

negative powers included, so that sin(e)/e is regular.  A function is expanded about the value u0 of its argument,
f(u0 + v) = sum of f^(m)(u0) * v**m / m!, of which v = O(e) leaves finitely many terms.  For a logarithm, a root or an
inverse function with a branch cut, u0 must lie off the cut or the argument stay on it; e and the symbols of which
nothing is declared are taken to be real.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import sympy as sp

from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.evidence import points, size_at
from lagrotor.algebra.identity import decide_zero
from lagrotor.algebra.scalar import scalar
from lagrotor.errors import InputError, NotExactError

# Analytic wherever they are finite, and real for real arguments, so that expansion by derivatives is right.
_ANALYTIC = (
    sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc,
    sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.sech, sp.csch, sp.exp,
)  # fmt: skip
# Cut along the imaginary axis, from i and -i outwards; the logarithm and the powers along the negative real axis.
_CUT = (sp.atan, sp.asinh)
# How many orders may be lost to division by a power of the small quantity.
_MARGIN = 8
_ARGUMENT = sp.Dummy("z")  # of the functions that are expanded: one, so that sympy remembers their derivatives
# Well above the error of a value computed to more than thirty digits.
_CLEARLY_NONZERO = 1e-15


@dataclass(frozen=True)
class LeadingTerm:
    """The first non-vanishing term coefficient * small**order; order is None if there is none through `through`."""

    order: int | None
    coefficient: sp.Expr
    through: int


def truncated_series(expression: sp.Expr, small: sp.Symbol, order: int) -> sp.Expr:
    """Return the Taylor polynomial of the expression in `small` about 0, through small**order.

    Raises NotExactError if the expression is singular at small = 0 or not known to be analytic there, InputError for what
    is not a scalar expression, a symbol and a whole number from zero on.
    """
    coefficients = _taylor(scalar(expression, "truncated_series"), small, order)
    terms = [
        sp.expand_mul(coefficient) * small**power
        for power, coefficient in enumerate(coefficients)
        if decide_zero(coefficient).answer != "zero"
    ]
    return sp.Add(*terms)


def leading_term(expression: sp.Expr, small: sp.Symbol, through: int = 8) -> LeadingTerm:
    """Return the first term of the expansion in `small` that does not vanish, looking through small**through.

    Raises NotExactError if a coefficient met on the way is undecided, or the expression is singular at small = 0.
    """
    for power, coefficient in enumerate(_taylor(scalar(expression, "leading_term"), small, through)):
        decision = decide_zero(coefficient)
        if decision.answer == "undecided" or decision.partly:
            raise NotExactError(f"coefficient {coefficient} of {small}**{power} is undecided: {decision.reason}")
        if decision.answer == "nonzero":
            return LeadingTerm(power, sp.expand_mul(coefficient), through)
    return LeadingTerm(None, sp.S.Zero, through)


def agreement_order(printed: sp.Expr, derived: sp.Expr, small: sp.Symbol, through: int = 8) -> LeadingTerm:
    """Return the leading term of printed - derived; they agree to order n if its order is None or above n.

    Raises NotExactError as `leading_term` does.
    """
    return leading_term(scalar(printed, "agreement_order") - scalar(derived, "agreement_order"), small, through)


class _Series(NamedTuple):
    """Terms of small**start, small**(start + 1), ...; what follows the last one is unknown."""

    start: int
    terms: tuple[sp.Expr, ...]

    @property
    def end(self) -> int:
        return self.start + len(self.terms)

    def at(self, power: int) -> sp.Expr:
        return self.terms[power - self.start] if self.start <= power else sp.S.Zero


def _taylor(expression: sp.Expr, small: sp.Symbol, order: int) -> list[sp.Expr]:
    """Return the coefficients of small**0 to small**order."""
    if not getattr(small, "is_Symbol", False) or isinstance(order, bool) or not isinstance(order, int) or order < 0:
        raise InputError(
            f"series: small = {small!r} must be a symbol and the order {order!r} a whole number from zero on"
        )
    series = _Series(0, ())
    for length in (order + 1, order + 1 + _MARGIN):
        try:
            series = _regular(_expanded(expression, small, length))
        except _TooShortError:
            continue
        if series.end > order:
            return [series.at(power) for power in range(order + 1)]
    raise NotExactError(f"division by powers of {small} leaves too few terms of {expression}")


class _TooShortError(Exception):
    """Every term that was kept vanishes, so that the leading one is not known."""


def _expanded(node: sp.Expr, small: sp.Symbol, length: int) -> _Series:
    """Expand the node to `length` terms, or to fewer where terms cancel in a denominator."""
    if not node.has(small):
        return _Series(0, _padded([node], length))
    if node == small:
        return _Series(1, _padded([sp.S.One], length))
    if node.is_Add or node.is_Mul:
        total, *others = (_expanded(part, small, length) for part in node.args)
        for other in others:
            total = _plus(total, other) if node.is_Add else _times(total, other)
        return total
    z = _ARGUMENT
    if node.is_Pow and not node.exp.has(small):
        base = _expanded(node.base, small, length)
        if node.exp.is_Integer and node.exp > 0:
            return _power(base, int(node.exp))
        base = _stripped(base)
        if base.start and not node.exp.is_Integer:
            raise NotExactError(f"{node} is singular at {small} = 0")
        if not node.exp.is_Integer:
            _check_cut(node, base)
        shift = base.start * int(node.exp) if base.start else 0
        return _Series(shift, _composed(z**node.exp, z, _Series(0, base.terms)).terms)
    if node.is_Pow and not node.base.has(small):
        return _composed(node.base**z, z, _regular(_expanded(node.exp, small, length)))
    if isinstance(node, (*_ANALYTIC, *_CUT, sp.log)):
        inner = _regular(_expanded(node.args[0], small, length))
        if not isinstance(node, _ANALYTIC):
            _check_cut(node, inner)
        return _composed(node.func(z), z, inner)
    raise NotExactError(f"{node} is not known to be analytic in {small}")


def _composed(function: sp.Expr, z: sp.Symbol, inner: _Series) -> _Series:
    """Return sum of f^(m)(u0) * v**m / m!, u0 + v the inner series."""
    length = len(inner.terms)
    u0 = sp.S.Zero if _vanishes(inner.terms[0]) else inner.terms[0]
    v = _Series(0, (sp.S.Zero, *inner.terms[1:]))
    power = _Series(0, _padded([sp.S.One], length))
    total = _Series(0, (sp.S.Zero,) * length)
    for m in range(length):
        value = function.subs(z, u0) / sp.factorial(m)
        if value.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
            raise NotExactError(f"{function} is singular at {z} = {u0}")
        total = _plus(total, _Series(0, tuple(_product(value, term) for term in power.terms)))
        power = _times(power, v)
        function = derivative(function, z)
    return total


def _check_cut(node: sp.Expr, inner: _Series) -> None:
    """Raise NotExactError unless the argument starts off the branch cut of the function or stays on the cut's line."""
    u0, *tail = inner.terms
    if isinstance(node, _CUT):
        off = _is_real(u0) or u0.is_imaginary is False or (1 + u0**2).is_positive
        on_line = all(_is_real(sp.expand(sp.I * term)) for term in tail)
    else:
        off = u0.is_positive or u0.is_extended_real is False
        on_line = all(map(_is_real, tail))
    if not (off or on_line):
        raise NotExactError(
            f"{node} may lie on a branch cut: its argument starts at {u0} and does not stay on one line"
        )


def _is_real(node: sp.Expr) -> bool:
    """Whether the expression is real wherever it is finite; symbols of which nothing is declared are."""
    if node.is_Symbol:
        return node.is_extended_real is not False and node.is_imaginary is not True
    if node.is_extended_real:
        return True
    if node.is_Pow and not node.exp.is_Integer:
        return bool(node.base.is_nonnegative) and _is_real(node.exp)
    return (node.is_Add or node.is_Mul or node.is_Pow or isinstance(node, (*_ANALYTIC, *_CUT))) and all(
        map(_is_real, node.args)
    )


def _plus(a: _Series, b: _Series) -> _Series:
    start, end = min(a.start, b.start), min(a.end, b.end)
    return _Series(start, tuple(a.at(power) + b.at(power) for power in range(start, end)))


def _times(a: _Series, b: _Series) -> _Series:
    terms = (sp.Add(*map(_product, a.terms[: k + 1], b.terms[k::-1])) for k in range(min(len(a.terms), len(b.terms))))
    return _Series(a.start + b.start, tuple(terms))


def _product(a: sp.Expr, b: sp.Expr) -> sp.Expr:
    """a b; of what is multiplied by zero sympy looks whether it is finite, which takes long."""
    return sp.S.Zero if a is sp.S.Zero or b is sp.S.Zero else a * b


def _power(base: _Series, times: int) -> _Series:
    """base**times, times > 0, by repeated squares."""
    half = _power(base, times // 2) if times > 1 else base
    squared = _times(half, half) if times > 1 else base
    return _times(squared, base) if times % 2 and times > 1 else squared


def _padded(terms: list[sp.Expr], length: int) -> tuple[sp.Expr, ...]:
    return (*terms, *[sp.S.Zero] * (length - len(terms)))


def _stripped(series: _Series) -> _Series:
    """Drop the leading terms that vanish."""
    for place, term in enumerate(series.terms):
        if not _vanishes(term):
            return _Series(series.start + place, series.terms[place:])
    raise _TooShortError


def _regular(series: _Series) -> _Series:
    """Return the series from small**0 on; raise NotExactError if it has a term of negative power."""
    for power in range(series.start, min(series.end, 0)):
        if not _vanishes(series.at(power)):
            raise NotExactError(f"the expansion has the negative power {power}")
    if series.end <= 0:
        raise _TooShortError
    return _Series(0, tuple(series.at(power) for power in range(series.end)))


def _vanishes(coefficient: sp.Expr) -> bool:
    decision = decide_zero(coefficient)
    if decision.answer == "undecided":
        sizes = [size_at(coefficient, point) for point in points(coefficient.free_symbols)]
        clear = min((size for size in sizes if size is not None), default=0) > _CLEARLY_NONZERO
    if decision.partly or (decision.answer == "undecided" and not clear):
        raise NotExactError(f"cannot tell whether {coefficient} vanishes: {decision.reason}")
    return decision.answer == "zero"
