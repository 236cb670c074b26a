"""The exact characteristic polynomial of a small structure, in symbols.

The symbol G_i = I3 ω_i is an axial momentum, a an inertia A_ii, b the coupling A_ij of a bar, and kappa a value of g S_i −
hinge_i. c is the friction on an axis, k the stiffness and d the damping of a brace. Several different values have indices, as
a_1 and a_2. Equal values share a symbol, and the value zero has none. Lengths of axes and directions of bars enter as rational
numbers.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.linear_modes import LinearSystem
from lagrotor.result_display import Shown, text_of
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.small_motion import bar_rows, check_upright, matrices

s = sp.Symbol("s")
_MOST = 6  # rotors


@dataclass(frozen=True, repr=False)
class Characteristic(Shown):
    """The characteristic polynomial in the symbol `s`, up to a constant factor. `system` has the matrices in symbols on the
    degrees of freedom that the bars leave, and `values` maps each symbol to its numerical value."""

    polynomial: sp.Expr
    system: LinearSystem
    values: dict[sp.Symbol, float]

    def summary(self) -> dict[str, str]:
        """Return the polynomial and the value of each symbol, as rows of a table."""
        return {
            "polynomial": text_of(self.polynomial),
            "symbols": text_of(self.values) or "none",
        }


def characteristic(structure: Assembly) -> Characteristic:
    """Derive the characteristic polynomial of a structure: see `Structure.characteristic`."""
    N = len(structure.joints)
    if N > _MOST:
        raise InputError(f"characteristic: {N} rotors are too many for symbols, at most {_MOST}: use modes()")
    check_upright(structure, "characteristic")
    c, values, exact = coefficients(structure), dict[sp.Symbol, float](), np.vectorize(_exact, otypes=[object])
    G = [sp.Symbol(f"G_{i + 1}", real=True) if g else sp.Integer(0) for i, g in enumerate(c.G)]
    values |= {symbol: float(g) for symbol, g in zip(G, c.G, strict=True) if g}
    a = _symbols("a", c.A, values)
    b = _symbols("b", c.coupling, values, real=True)
    kappa = _symbols("kappa", c.gravity * c.S - c.hinge, values, real=True)
    friction = _symbols("c", c.friction, values)
    stiffness, damping = _symbols("k", c.stiffness, values), _symbols("d", c.damping, values)
    tips = [structure.upright_tip(brace.tip) for brace in structure.braces]
    extents = exact(np.array(tips).reshape(-1, 3)) - exact(c.brace_point)
    symbols: dict[str, Any] = {
        "G": G, "A": a, "coupling": b, "hinge": [-k for k in kappa], "S": [0] * N, "friction": friction,
        "stiffness": stiffness, "damping": damping, "brace_length": [sp.sqrt(sum(x**2 for x in d)) for d in extents],
        "ell": [1] * len(b),  # a bar's row up to a factor
    }  # fmt: skip
    symbolic = replace(
        c,
        gravity=0,
        **{name: np.array(list(entries), dtype=object) for name, entries in symbols.items()},
        **{name: exact(getattr(c, name)) for name in ("R", "feet", "brace_point")},
    )
    M, C, gyroscopic, K = (sp.Matrix(matrix.tolist()) for matrix in matrices(symbolic))
    rows = bar_rows(symbolic).tolist()
    basis = sp.Matrix.hstack(*sp.Matrix(rows).nullspace()) if rows else sp.eye(2 * N)
    mass, rates, springs = (basis.T * matrix * basis for matrix in (M, C + gyroscopic, K))
    system = LinearSystem(mass, rates, springs, basis)
    return Characteristic(system.characteristic(s), system, values)


def _symbols(name: str, numbers: Array, values: dict[sp.Symbol, float], real: bool = False) -> list[sp.Expr]:
    """Return the symbols of some numbers, one per distinct value, and add {symbol: value} to `values`. The symbols are declared
    positive, or only real if `real` is True. The number zero stays zero."""
    distinct = [v for v in dict.fromkeys(numbers.tolist()) if v]
    sign = {"real": True} if real else {"positive": True}
    symbols = {v: sp.Symbol(name if len(distinct) == 1 else f"{name}_{k + 1}", **sign) for k, v in enumerate(distinct)}
    values.update({symbol: v for v, symbol in symbols.items()})
    return [symbols[float(v)] if v else sp.Integer(0) for v in numbers]


def _exact(value: float) -> sp.Rational:
    """Return the simplest fraction within 1e-12 of a number, so that 0.1 becomes 1/10."""
    fraction = Fraction(value).limit_denominator(10**6)
    return sp.Rational(fraction if abs(float(fraction) - value) <= 1e-12 * max(1.0, abs(value)) else Fraction(value))
