"""Zero test for algebraic numbers made of radicals and roots of unity.

Let α = U/L with algebraic integers U and L of a field of degree D, whose conjugates have absolute values at most u and l. The
norm of U is an integer, so α is zero or |α| ≥ 1/(u**(D−1) l). u, l and D follow from the form of α (Burnikel, Funke, Mehlhorn,
Schirra & Schmitt, Algorithmica 55, 14, 2009), and a sufficiently narrow enclosure of α decides.
"""

from __future__ import annotations

from math import lcm, prod

import sympy as sp
from mpmath import iv

from lagrotor.algebra.enclosures import enclosed_at, excludes_zero
from lagrotor.errors import NotExactError

_MOST_BITS = 30_000


def is_zero(number: sp.Expr) -> bool | None:
    """Return True if a number made of radicals, sines and cosines of rational multiples of π is zero; None if undecided."""
    try:
        bound = _Bound()
        over, _ = bound.of(number)
        bits = int(bound.degree * over) + 8
        if bits > _MOST_BITS:
            return None
        for precision in (60, int(0.302 * bits) + 60):
            value = enclosed_at(number, {}, precision)
            if excludes_zero(value):
                return False
            if max(iv.log(abs(x).b, 2).b if abs(x).b > 0 else -iv.inf for x in (value.real, value.imag)) < -bits:
                return True
    except (NotExactError, ArithmeticError, ValueError, TypeError):
        return None
    return None


class _Bound:
    """The bounds u and l of the module's text for each subexpression, as base-2 logarithms, and the degree D of the field."""

    def __init__(self) -> None:
        self.roots: dict[sp.Expr, int] = {}
        self.turns = 1

    @property
    def degree(self) -> int:
        degree = prod(self.roots.values()) * int(sp.totient(self.turns))
        if degree > _MOST_BITS:
            raise NotExactError("The degree of the number field is too large.")
        return degree

    def of(self, e: sp.Expr) -> tuple[float, float]:
        if e.is_Rational:
            return float(sp.log(max(abs(e.p), 1), 2)), float(sp.log(e.q, 2))
        if e is sp.I:
            self._turn(4)
            return 0.0, 0.0
        if e.is_Add:
            terms = [self.of(argument) for argument in e.args]
            under = sum(low for _, low in terms)
            return max(up + under - low for up, low in terms) + float(sp.log(len(terms), 2)), under
        if e.is_Mul:
            terms = [self.of(argument) for argument in e.args]
            return sum(up for up, _ in terms), sum(low for _, low in terms)
        if isinstance(e, sp.sin | sp.cos | sp.exp):
            turn = e.args[0] / (sp.I * sp.pi if isinstance(e, sp.exp) else sp.pi)
            if turn.is_Rational:
                self._turn(lcm(4, 2 * int(turn.q)))
                return (0.0, 0.0) if isinstance(e, sp.exp) else (1.0, 1.0)
        if isinstance(e, sp.tan | sp.cot) and (e.args[0] / sp.pi).is_Rational:
            return self._tangent(e)
        if e.is_Pow and e.exp.is_Rational:
            return self._power(e)
        raise NotExactError(f"{e} is no algebraic number in the class.")

    def _tangent(self, e: sp.Expr) -> tuple[float, float]:
        self._turn(lcm(4, 2 * int((e.args[0] / sp.pi).q)))
        return 2.0, 2.0

    def _turn(self, n: int) -> None:
        self.turns = lcm(self.turns, n)

    def _power(self, e: sp.Expr) -> tuple[float, float]:
        up, low = self.of(e.base)
        n, q = abs(int(e.exp.p)), int(e.exp.q)
        if q > 1:
            key = sp.Pow(e.base, sp.Rational(1, q), evaluate=False)
            self.roots[key] = q
            up, low = (up + (q - 1) * low) / q, low
        up, low = n * up, n * low
        return (low, up) if e.exp < 0 else (up, low)
