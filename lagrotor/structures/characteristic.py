"""The linear system of a small structure in symbols: its characteristic polynomial, exact.

Letters: G_i = I3 ω_i; a (a_i) the inertias A_ii, b (b_k) the couplings A_ij of the bars, kappa (kappa_i) = g S_i − hinge_i,
c (c_i) friction, k_j and d_j a brace's stiffness and damping. Equal values share a letter; a value zero has none.
Lengths of axes and directions of bars are the numbers given, as rationals.
"""

from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.linear_modes import LinearSystem
from lagrotor.shown import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients

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
    """det(M s² + C s + K) on the freedoms that the bars leave, factored, in symbols; at most 6 rotors.

    Raises InputError for more, or where a bar is not as long as its tips are apart when upright.
    """
    N = len(structure.joints)
    if N > _MOST:
        raise InputError(f"characteristic: {N} rotors are too many for symbols: at most {_MOST}; use modes()")
    if not structure.natural:
        raise InputError("characteristic: a bar is not as long as its tips are apart when upright: simulate it")
    c, values = coefficients(structure), dict[sp.Symbol, float]()
    G = [sp.Symbol(f"G_{i + 1}", real=True) if g else sp.Integer(0) for i, g in enumerate(c.G)]
    values |= {letter: float(g) for letter, g in zip(G, c.G, strict=True) if g}
    a = _letters("a", c.A, values)
    b = _letters("b", c.coupling, values, real=True)
    kappa = _letters("kappa", c.gravity * c.S - c.hinge, values, real=True)
    friction = _letters("c", c.friction, values)
    M, C, K = (sp.zeros(2 * N, 2 * N) for _ in range(3))
    for i in range(N):
        for k in (2 * i, 2 * i + 1):
            M[k, k], C[k, k], K[k, k] = a[i], friction[i], -kappa[i]
        C[2 * i, 2 * i + 1], C[2 * i + 1, 2 * i] = G[i], -G[i]
    for (i, j, _), coupling in zip(structure.bars, b, strict=True):
        for k in (0, 1):
            M[2 * i + k, 2 * j + k] = M[2 * j + k, 2 * i + k] = coupling
    braces = [_brace_row(structure, k) for k in range(len(structure.braces))]
    for row, k, d in zip(braces, _letters("k", c.stiffness, values), _letters("d", c.damping, values), strict=True):
        K, C = K + k * row.T * row, C + d * row.T * row
    rows = [_row(structure, i, j) for i, j, _ in structure.bars]
    basis = sp.Matrix.hstack(*sp.Matrix.vstack(*rows).nullspace()) if rows else sp.eye(2 * N)
    mass, gyroscopic, stiffness = (basis.T * part * basis for part in (M, C, K))
    system = LinearSystem(mass, gyroscopic, stiffness, basis)
    return Characteristic(system.characteristic(s), system, values)


def _letters(name: str, given: Array, values: dict[sp.Symbol, float], real: bool = False) -> list[sp.Expr]:
    """A symbol for each distinct value, positive unless `real`; what it stands for is put into `values`."""
    distinct = [v for v in dict.fromkeys(given.tolist()) if v]
    sign = {"real": True} if real else {"positive": True}
    letters = {v: sp.Symbol(name if len(distinct) == 1 else f"{name}_{k + 1}", **sign) for k, v in enumerate(distinct)}
    values.update({letter: v for v, letter in letters.items()})
    return [letters[float(v)] if v else sp.Integer(0) for v in given]


def _row(structure: Assembly, i: int, j: int) -> sp.Matrix:
    """A bar's row on u (1, 2 N), times its length."""
    row = sp.zeros(1, 2 * len(structure.joints))
    for k in (0, 1):
        n = _exact(structure.joints[j][k]) - _exact(structure.joints[i][k])
        row[2 * i + k] = _exact(structure.rotor[i].length) * n
        row[2 * j + k] = -_exact(structure.rotor[j].length) * n
    return row


def _brace_row(structure: Assembly, k: int) -> sp.Matrix:
    """The extension of a brace by u, (1, 2 N)."""
    brace = structure.braces[k]
    ends = structure.upright_tip(brace.tip), structure.upright_tip(brace.to) if isinstance(brace.to, int) else brace.to
    n = [_exact(p) - _exact(q) for p, q in zip(*ends, strict=True)]
    length = sp.sqrt(sum(e**2 for e in n))
    row = sp.zeros(1, 2 * len(structure.joints))
    for m in (0, 1):
        row[2 * brace.tip + m] += _exact(structure.rotor[brace.tip].length) * n[m] / length
        if isinstance(brace.to, int):
            row[2 * brace.to + m] -= _exact(structure.rotor[brace.to].length) * n[m] / length
    return row


def _exact(value: float) -> sp.Rational:
    """The simplest fraction within 1e-12 of a number: 0.1 is 1/10."""
    fraction = Fraction(value).limit_denominator(10**6)
    return sp.Rational(fraction if abs(float(fraction) - value) <= 1e-12 * max(1.0, abs(value)) else Fraction(value))
