"""Inversion of functions: x² = v with x ≥ 0 is x = √v with v ≥ 0; cos x = v on [0, π] is x = acos v.

Each step is an equivalence for real symbols under its conditions.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeAlias

import sympy as sp

from lagrotor.algebra.signs import Region, is_nonnegative, is_real, signs

Conditioned: TypeAlias = "tuple[sp.Expr, tuple[sp.Basic, ...]]"

# Inverse function -> (its inverse, lower and upper bound of its values).
INVERSES: dict[Any, tuple[Any, Any, Any]] = {
    sp.acos: (sp.cos, sp.S.Zero, sp.pi), sp.asin: (sp.sin, -sp.pi / 2, sp.pi / 2),
    sp.atan: (sp.tan, -sp.pi / 2, sp.pi / 2), sp.log: (sp.exp, None, None), sp.asinh: (sp.sinh, None, None),
    sp.acosh: (sp.cosh, sp.S.Zero, None), sp.atanh: (sp.tanh, None, None),
}  # fmt: skip
_TURNS = (0, -1, 1, -2, 2)


def argument(function: Any, value: sp.Expr) -> Conditioned:
    """Solve function(u) = value for u, and return u with its conditions: acos u = v gives u = cos v with 0 ≤ v ≤ π."""
    inner, low, high = INVERSES[function]
    return inner(value), (
        *(_at_least(value, low) if low is not None else ()),
        *(_at_least(high, value) if high else ()),
    )


def solved_for(kernel: sp.Expr, symbol: sp.Symbol, value: sp.Expr, where: Region) -> Conditioned | None:
    """Solve kernel = value for the symbol, and return the solution with its conditions.

    The result is None if the region admits several solutions, or if no inverse of the kernel is known.
    """
    if not is_real(symbol, where) or not is_real(value, where):
        return None
    if kernel.is_Pow and kernel.base == symbol and kernel.exp.is_Rational:
        return _root(kernel.exp, symbol, value, where)
    if kernel.func in INVERSES and kernel.args == (symbol,):
        return argument(kernel.func, value)
    if isinstance(kernel, sp.exp):
        return sp.log(value), (sp.Gt(value, 0, evaluate=False),)
    if isinstance(kernel, sp.sinh):
        return sp.asinh(value), ()
    if isinstance(kernel, sp.cosh):
        side = _side(symbol, where)
        return (side * sp.acosh(value), _at_least(value, sp.S.One)) if side else None
    return next(_arcs(kernel, symbol, value, where), None)


def _at_least(e: sp.Expr, low: sp.Expr) -> tuple[sp.Basic, ...]:
    return (sp.Ge(e, low, evaluate=False),)


def _side(e: sp.Expr, where: Region) -> int:
    """Return 1 if e ≥ 0 in the region, −1 if e ≤ 0, and 0 if the sign of e is unknown."""
    return 1 if is_nonnegative(e, where) else -1 if is_nonnegative(-e, where) else 0


def _root(n: sp.Rational, symbol: sp.Symbol, value: sp.Expr, where: Region) -> Conditioned | None:
    side = _side(symbol, where)
    if n == sp.S.Half or (side == 1 and (n > 0 or 0 not in (signs(value, where) or {0}))):
        return value ** (1 / n), _at_least(value, sp.S.Zero)
    if not n.is_Integer or n < 0:
        return None
    if n % 2 == 0:
        return (-(value ** (1 / n)), _at_least(value, sp.S.Zero)) if side else None
    side = side or _side(value, where)
    return (side * (side * value) ** (1 / n), _at_least(side * value, sp.S.Zero)) if side else None


def _arcs(kernel: sp.Expr, symbol: sp.Symbol, value: sp.Expr, where: Region) -> Iterator[Conditioned]:
    """Yield (solution, conditions) of kernel = value for sin, cos or tan of a symbol, on the monotone piece that contains it."""
    conditions = (*_at_least(value, sp.S.NegativeOne), *_at_least(sp.S.One, value))
    for k in _TURNS:
        start = k * sp.pi - (0 if isinstance(kernel, sp.cos) else sp.pi / 2)
        if not (is_nonnegative(symbol - start, where) and is_nonnegative(start + sp.pi - symbol, where)):
            continue
        if isinstance(kernel, sp.sin):
            yield k * sp.pi + (-1) ** k * sp.asin(value), conditions
        elif isinstance(kernel, sp.cos):
            yield (k + k % 2) * sp.pi + (-1) ** k * sp.acos(value), conditions
        elif isinstance(kernel, sp.tan):
            yield k * sp.pi + sp.atan(value), ()
