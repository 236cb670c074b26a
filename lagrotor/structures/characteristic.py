"""The linear system of a small structure in symbols: its characteristic polynomial, exact.

Letters: G_i = I3 ω_i; a (a_i) the inertias A_ii, b (b_k) the couplings A_ij of the bars, kappa (kappa_i) = g S_i − hinge_i,
c (c_i) friction, k_j and d_j a brace's stiffness and damping. Equal values share a letter; a value zero has none.
Lengths of axes and directions of bars are the numbers given, as rationals.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.linear_modes import LinearSystem
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.small_motion import bar_rows, check_upright, matrices

s = sp.Symbol("s")
_MOST = 6  # rotors


@dataclass(frozen=True, repr=False)
class Characteristic(Shown):
    """polynomial in `s`, up to a constant factor; system: the matrices; values: {letter: its number}."""

    polynomial: sp.Expr
    system: LinearSystem
    values: dict[sp.Symbol, float]

    def summary(self) -> dict[str, str]:
        """The polynomial and the numbers of its letters, name → words."""
        return {
            "polynomial": str(self.polynomial),
            "letters": ", ".join(f"{letter} = {value:.6g}" for letter, value in self.values.items()) or "none",
        }


def characteristic(structure: Assembly) -> Characteristic:
    """det(M s² + C s + K) on the degrees of freedom that the bars leave, factored, in symbols; at most 6 rotors.

    Raises InputError for more, or where a bar is not as long as its tips are apart when upright.
    """
    N = len(structure.joints)
    if N > _MOST:
        raise InputError(f"characteristic: {N} rotors are too many for symbols: at most {_MOST}; use modes()")
    check_upright(structure, "characteristic")
    c, values, exact = coefficients(structure), dict[sp.Symbol, float](), np.vectorize(_exact, otypes=[object])
    G = [sp.Symbol(f"G_{i + 1}", real=True) if g else sp.Integer(0) for i, g in enumerate(c.G)]
    values |= {letter: float(g) for letter, g in zip(G, c.G, strict=True) if g}
    a = _letters("a", c.A, values)
    b = _letters("b", c.coupling, values, real=True)
    kappa = _letters("kappa", c.gravity * c.S - c.hinge, values, real=True)
    friction = _letters("c", c.friction, values)
    stiffness, damping = _letters("k", c.stiffness, values), _letters("d", c.damping, values)
    tips = [structure.upright_tip(brace.tip) for brace in structure.braces]
    extents = exact(np.array(tips).reshape(-1, 3)) - exact(c.brace_point)
    letters: dict[str, Any] = {
        "G": G, "A": a, "coupling": b, "hinge": [-k for k in kappa], "S": [0] * N, "friction": friction,
        "stiffness": stiffness, "damping": damping, "brace_length": [sp.sqrt(sum(x**2 for x in d)) for d in extents],
        "ell": [1] * len(b),  # a bar's row up to a factor
    }  # fmt: skip
    symbolic = replace(
        c,
        gravity=0,
        **{name: np.array(list(entries), dtype=object) for name, entries in letters.items()},
        **{name: exact(getattr(c, name)) for name in ("R", "feet", "brace_point")},
    )
    M, C, gyroscopic, K = (sp.Matrix(matrix.tolist()) for matrix in matrices(symbolic))
    rows = bar_rows(symbolic).tolist()
    basis = sp.Matrix.hstack(*sp.Matrix(rows).nullspace()) if rows else sp.eye(2 * N)
    mass, rates, springs = (basis.T * matrix * basis for matrix in (M, C + gyroscopic, K))
    system = LinearSystem(mass, rates, springs, basis)
    return Characteristic(system.characteristic(s), system, values)


def _letters(name: str, numbers: Array, values: dict[sp.Symbol, float], real: bool = False) -> list[sp.Expr]:
    """A symbol for each distinct value, positive unless `real`; what it stands for is put into `values`."""
    distinct = [v for v in dict.fromkeys(numbers.tolist()) if v]
    sign = {"real": True} if real else {"positive": True}
    letters = {v: sp.Symbol(name if len(distinct) == 1 else f"{name}_{k + 1}", **sign) for k, v in enumerate(distinct)}
    values.update({letter: v for v, letter in letters.items()})
    return [letters[float(v)] if v else sp.Integer(0) for v in numbers]


def _exact(value: float) -> sp.Rational:
    """The simplest fraction within 1e-12 of a number: 0.1 is 1/10."""
    fraction = Fraction(value).limit_denominator(10**6)
    return sp.Rational(fraction if abs(float(fraction) - value) <= 1e-12 * max(1.0, abs(value)) else Fraction(value))
