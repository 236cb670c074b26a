"""Constancy on a connected region: a continuous function with zero derivatives is zero if it is zero at one point."""

from __future__ import annotations

from collections.abc import Callable
from math import lcm

import sympy as sp

from lagrotor.algebra.algebraic_numbers import is_zero
from lagrotor.algebra.differentiation import derivative
from lagrotor.algebra.enclosures import enclosed_at, enclosure
from lagrotor.algebra.signs import ANY, NONNEGATIVE, Region, is_nonnegative, is_positive, is_real, signs
from lagrotor.errors import NotExactError

_ENTIRE = (sp.sin, sp.cos, sp.sinh, sp.cosh, sp.exp, sp.erf)
_REAL = (sp.atan, sp.tanh, sp.asinh, sp.sech, sp.Abs)  # continuous for real arguments
_PLACES = (sp.S.Zero, sp.S.Half, sp.S.One, sp.Integer(2), -sp.S.Half, sp.Integer(-2))
_MOST_SYMBOLS = 3


def is_continuous(e: sp.Expr, where: Region, symbols: frozenset[sp.Symbol]) -> bool:
    """Return True if e is certainly continuous in these symbols throughout the region."""
    if not e.free_symbols & symbols or e.is_Symbol:
        return True
    if not all(is_continuous(argument, where, symbols) for argument in e.args):
        return False
    if e.is_Add or e.is_Mul or isinstance(e, _ENTIRE):
        return True
    u = e.args[0]
    argument_signs = signs(u, where)
    if e.is_Pow:
        if e.exp.is_Integer:
            return bool(e.exp > 0) or (argument_signs is not None and 0 not in argument_signs)
        if (e.exp.is_Rational and e.exp > 0) or is_positive(e.exp, where):
            return argument_signs is not None and argument_signs <= NONNEGATIVE
        return is_positive(u, where)
    return _is_function_continuous(e, u, where)


def _is_function_continuous(e: sp.Expr, u: sp.Expr, where: Region) -> bool:
    """Return True if a function with singular points or a branch cut is continuous at the continuous argument u."""
    if isinstance(e, sp.log):
        return is_positive(u, where) or is_positive(sp.re(u), where)
    if isinstance(e, _REAL):
        return is_real(u, where)
    if isinstance(e, sp.tan | sp.sec):
        return 0 not in (signs(sp.cos(u), where) or ANY)
    if isinstance(e, sp.cot | sp.csc):
        return 0 not in (signs(sp.sin(u), where) or ANY)
    if isinstance(e, sp.coth | sp.csch | sp.acot):
        return 0 not in (signs(u, where) or ANY)
    if isinstance(e, sp.asin | sp.acos):
        return is_nonnegative(sp.factor(1 - u**2), where)
    if isinstance(e, sp.atanh):
        return is_positive(sp.factor(1 - u**2), where)
    return isinstance(e, sp.acosh) and is_nonnegative(u - 1, where)


def is_connected(where: Region) -> bool:
    """Return True if the region is certainly connected: convex, or star-shaped about the origin."""
    s = sp.Dummy(positive=True)
    for e, _ in where.above:
        symbols = sorted(e.free_symbols, key=sp.default_sort_key)
        try:
            polynomial = sp.Poly(e, *symbols)
        except sp.PolynomialError:
            return False
        if polynomial.total_degree() <= 1:
            continue
        scaled = sp.Poly(e.xreplace({symbol: s * symbol for symbol in symbols}), s)
        degrees = [n for (n,) in scaled.monoms() if n]
        # a homogeneous e plus a constant is monotonic on every ray from the origin
        if len(degrees) != 1 or not scaled.eval(0).is_positive or not all(_holds_origin(e) for e, _ in where.above):
            return False
    return True


def _holds_origin(e: sp.Expr) -> bool:
    return bool(e.xreplace(dict.fromkeys(e.free_symbols, sp.S.Zero)).is_nonnegative)


def is_constant_zero(expression: sp.Expr, where: Region, vanishes: Callable[[sp.Expr, Region], bool]) -> bool:
    """Return True if an expression is proved to be zero by continuity, zero derivatives and one zero value.

    The region must be connected. `vanishes` decides whether an expression is zero in a region.
    """
    symbols = sorted(expression.free_symbols, key=sp.default_sort_key)
    if len(symbols) > _MOST_SYMBOLS or any(symbol.is_integer or not is_real(symbol, where) for symbol in symbols):
        return False
    if not is_connected(where) or not is_continuous(expression, where, frozenset(symbols)):
        return False
    if not all(vanishes(derivative(expression, symbol), where) for symbol in symbols):
        return False
    return any(_is_zero(expression.subs(point), vanishes) for point in _places(symbols, where))


def _places(symbols: list[sp.Symbol], where: Region) -> list[dict[sp.Symbol, sp.Expr]]:
    candidates = []
    for place in _PLACES:
        point = dict.fromkeys(symbols, place)
        if any((symbol.is_positive and place <= 0) or (symbol.is_negative and place >= 0) for symbol in symbols):
            continue
        try:
            if all(enclosed_at(e, point).real.a > 0 for e, _ in where.above):
                candidates.append(point)
        except NotExactError:
            continue
    return candidates[:3]


def _is_zero(value: sp.Expr, vanishes: Callable[[sp.Expr, Region], bool]) -> bool:
    if value.has(sp.nan, sp.zoo, sp.oo):
        return False
    return bool(is_zero(value) or vanishes(value, Region()) or is_small_angle(value, vanishes))


def is_small_angle(expression: sp.Expr, vanishes: Callable[[sp.Expr, Region], bool]) -> bool:
    """Return True if a sum of asin, acos and atan of numbers is proved to be zero.

    The proof: an integer multiple of the sum has the sine 0 and an absolute value below 3, which is less than π.
    """
    if expression.free_symbols or not expression.has(sp.asin, sp.acos, sp.atan):
        return False
    rates = [term.as_coeff_Mul()[0] for term in sp.Add.make_args(sp.expand(expression))]
    angle = sp.expand(lcm(*(int(rate.q) for rate in rates if rate.is_Rational)) * expression)
    ends = enclosure(angle, {})
    small = ends is not None and all(abs(end) < 3 for end in ends)
    return small and vanishes(sp.sin(angle, evaluate=False), Region())
