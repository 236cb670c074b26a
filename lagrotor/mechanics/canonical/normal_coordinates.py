"""Normal coordinates of a quadratic Hamiltonian ½ x·A x with brackets {x_a, x_b} = Ω_ab, and the sign of each mode's energy.

The flow is x' = Ω A x. A mode of rates ∓ i ω has vectors v, v̄ with Ω A v = −i ω v. With x = z v + w v̄ and v†A v = ω its
energy is

    H = ω z w,     {z, w} = −i,     w = z̄,     the action I = z w ≥ 0:  ω < 0 for negative energy (Krein).

A saddle with rates ± λ and vectors v, u has H = λ z w, {z, w} = 1. Modes of rate zero are not diagonalised; they get a
canonical basis.

`exact_coordinates` works without rounding for frequencies that are rational, or rational in parameters. The vector w of each
mode is scaled by ω/(v†A v), so that no root is needed: w = k z̄ with k > 0, and the action is z w.

Williamson, Amer. J. Math. 58 (1936) 141; Yakubovich & Starzhinskii, Linear Differential Equations with
Periodic Coefficients, ch. III.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from sympy import QQ_I
from sympy.polys.matrices import DomainMatrix
from sympy.polys.polyerrors import CoercionFailed

from lagrotor.errors import NotExactError, SingularError

Matrix = NDArray[Any]
_DEFECTIVE = 1e-9  # energy of a unit vector divided by the rate; below it a mode is not diagonalizable
_CLOSE = 1e-7  # of the largest rate: rates closer to each other, or to zero, count as equal


@dataclass(frozen=True, eq=False)
class NormalCoordinates:
    """Normal coordinates (z, w) in which ½ x·A x is sum_j frequencies_j z_j w_j + N.

    x = vectors (z, w), with `vectors` of shape (2n, 2n), and {z_j, w_j} = weights_j, shape (n,). A frequency is ω with the
    sign of the energy if its weight is −i, λ if the weight is 1, and 0 for the modes in N. Oscillations come first, by |ω|.
    """

    vectors: Matrix
    weights: Matrix
    frequencies: Matrix


def normal_coordinates(A: Matrix, bracket: Matrix) -> NormalCoordinates:
    """Return normal coordinates in floating-point numbers for symmetric A and a regular matrix Ω of brackets.

    Raises SingularError for a nonzero double rate without enough eigenvectors.
    """
    rates, vectors = np.linalg.eig(bracket @ A)
    size = max(float(np.abs(rates).max()), 1e-300)
    near = _CLOSE * size
    still = np.abs(rates) < 10 * near
    modes: list[tuple[complex, complex, Matrix, Matrix]] = []  # frequency, weight, vector of z, vector of w
    remaining = [int(k) for k in np.flatnonzero(~still)]
    while remaining:
        rate = max((rates[k] for k in remaining), key=lambda s: (round(abs(s) / near), s.imag, s.real))
        group = [k for k in remaining if abs(rates[k] - rate) < near]
        opposite = [k for k in remaining if abs(rates[k] + rate) < near]
        remaining = [k for k in remaining if k not in {*group, *opposite}]
        V, U = vectors[:, group], vectors[:, opposite]
        if abs(rate.real) < near:
            modes += _oscillations(A, V.conj(), abs(rate.imag), near)
        else:
            pairing = V.T @ A @ U
            _check(pairing, rate)
            U = U @ np.linalg.inv(pairing) * rate
            modes += [(rate, 1.0, V[:, j], U[:, j]) for j in range(len(group))]
    modes.sort(key=lambda mode: (mode[1] == 1.0, abs(mode[0])))
    modes += [(0.0, 1.0, v, u) for v, u in _zero_rate_pairs(A, bracket, int(still.sum()))]
    columns = [mode[2] for mode in modes] + [mode[3] for mode in modes]
    weights, frequencies = np.array([mode[1] for mode in modes]), np.array([mode[0] for mode in modes])
    return NormalCoordinates(np.array(columns).T + 0j, weights + 0j, frequencies + 0j)


def _check(form: Matrix, rate: complex) -> None:
    if np.linalg.svd(form, compute_uv=False)[-1] < _DEFECTIVE * abs(rate):
        raise SingularError(f"normal_form: the rate {rate:.6g} is double and not diagonal: change a parameter")


def _oscillations(A: Matrix, V: Matrix, omega: float, near: float) -> list[tuple[complex, complex, Matrix, Matrix]]:
    """Return the modes Ω A v = −i ω v as tuples (frequency with the sign of the energy, weight, vector of z, vector of w)."""
    form = V.conj().T @ A @ V
    _check(form, 1j * omega)
    energies, rotation = np.linalg.eigh(form)
    modes: list[tuple[complex, complex, Matrix, Matrix]] = []
    for energy, column in zip(energies, (V @ rotation).T, strict=True):
        lead = column[np.argmax(np.abs(column))]
        v = column * np.sqrt(omega / abs(energy)) * abs(lead) / lead
        modes += [(omega, -1j, v, v.conj())] if energy > 0 else [(-omega, -1j, v.conj(), v)]
    return modes


def _zero_rate_pairs(A: Matrix, bracket: Matrix, count: int) -> list[tuple[Matrix, Matrix]]:
    """Return a canonical basis of the generalised null space of Ω A, as pairs (v, u) like (q, p): v·Ω⁻¹u = −1, v·A u = 0.

    If u·A u is not zero, u drives v: v is parallel to Ω A u.
    """
    if not count:
        return []
    W = bracket @ A
    size = max(np.abs(W).max(), 1e-300)
    _, _, rows = np.linalg.svd(np.linalg.matrix_power(W / size, count))
    basis, form, pairs = rows[len(rows) - count :].conj(), np.linalg.inv(bracket), list[tuple[Matrix, Matrix]]()
    while len(basis):
        values, rotation = np.linalg.eigh(basis @ A @ basis.T)
        *others, u = rotation.T[np.argsort(np.abs(values), kind="stable")] @ basis
        driven = np.abs(values).max() > _CLOSE * size
        v = W @ u if driven else others.pop(int(np.argmax([abs(x @ form @ u) for x in others])))
        v = v / -(v @ form @ u)
        pairs.append((v, u))
        projected = [x + (x @ form @ u) * v - (x @ form @ v) * u for x in others]
        _, _, rows = np.linalg.svd(np.array(projected).reshape(-1, len(A)))
        basis = rows[: len(basis) - 2]
    return pairs


@dataclass(frozen=True)
class ExactCoordinates:
    """Normal coordinates of oscillations as expressions, and the field that contains them."""

    vectors: sp.Matrix
    frequencies: tuple[sp.Expr, ...]
    field: Any


def exact_coordinates(A: sp.Matrix, bracket: sp.Matrix, parameters: set[sp.Symbol]) -> ExactCoordinates:
    """Return normal coordinates of ½ x·A x without rounding errors.

    Raises NotExactError for a frequency that is not rational, not real, or zero.
    """
    field = QQ_I.frac_field(*sorted(parameters, key=str)) if parameters else QQ_I
    modes: list[tuple[sp.Expr, sp.Matrix, sp.Matrix]] = []
    for omega in _frequencies(bracket * A):
        for v in _orthogonal(_null_vectors(bracket * A + sp.I * omega * sp.eye(A.rows), field), A, field):
            modes.append(_signed(omega, v, A, field))
    modes.sort(key=lambda mode: sp.default_sort_key(abs(mode[0])) if A.free_symbols else float(abs(mode[0])))
    if 2 * len(modes) != A.rows:
        raise NotExactError("normal_form: a frequency is double and not diagonal")
    vectors = sp.Matrix.hstack(*(mode[1] for mode in modes), *(mode[2] for mode in modes))
    return ExactCoordinates(vectors, tuple(mode[0] for mode in modes), field)


def _frequencies(W: sp.Matrix) -> list[sp.Expr]:
    """Return the different positive ω of det(W + i ω) = 0, which is even in ω."""
    s, rates = sp.Dummy("s"), list[sp.Expr]()
    squares = sp.Poly(W.charpoly().all_coeffs()[::2], s)
    for factor, _ in sp.factor_list(squares.as_expr(), s)[1]:
        if not factor.has(s):
            continue
        root = sp.solve(factor, s)[0] if sp.degree(factor, s) == 1 else sp.S.One
        omega = sp.sqrt(sp.factor(-root))
        if not omega.is_positive or not omega.is_rational_function(*W.free_symbols) or omega.is_rational is False:
            raise NotExactError(f"normal_form: {factor} = 0 has no rational frequency")
        rates.append(omega)
    return rates


def element(field: Any, e: sp.Expr) -> Any:
    """Return an expression as an element of the field. Raises NotExactError if it is not in the field."""
    try:
        return field.from_sympy(e if field.is_Frac else e.expand())
    except (CoercionFailed, ValueError, NotImplementedError):
        raise NotExactError(f"normal_form: {e} is not in the field of the frequencies") from None


def _null_vectors(M: sp.Matrix, field: Any) -> list[sp.Matrix]:
    entries = [[element(field, M[i, j]) for j in range(M.cols)] for i in range(M.rows)]
    rows = DomainMatrix(entries, M.shape, field).nullspace().to_Matrix()
    return [rows[k, :].T for k in range(rows.rows)]


def _orthogonal(vectors: list[sp.Matrix], A: sp.Matrix, field: Any) -> list[sp.Matrix]:
    """Return a basis of the span of `vectors` with v†A u = 0 for each two of them and v†A v ≠ 0 for each."""
    remaining, basis = list(vectors), list[sp.Matrix]()
    while remaining:
        energies = [_reduced((v.H * A * v)[0], field) for v in remaining]
        best = next((k for k, energy in enumerate(energies) if energy != 0), None)
        if best is None:
            raise NotExactError("normal_form: modes of equal frequency whose energies vanish")
        v, energy = remaining.pop(best), energies[best]
        remaining = [(u - v * ((v.H * A * u)[0] / energy)).applyfunc(lambda e: _reduced(e, field)) for u in remaining]
        basis.append(v)
    return basis


def _reduced(e: sp.Expr, field: Any) -> sp.Expr:
    """Return the canonical form of the expression in its field."""
    return field.to_sympy(element(field, e))


def _signed(omega: sp.Expr, v: sp.Matrix, A: sp.Matrix, field: Any) -> tuple[sp.Expr, sp.Matrix, sp.Matrix]:
    """Return ω with the sign of the energy, the vector of z, and the vector of w."""
    energy, bar = _reduced((v.H * A * v)[0], field), v.conjugate()
    sign = _sign(energy)
    scaled = [(x * (sign * omega / energy)).applyfunc(lambda e: _reduced(e, field)) for x in (bar, v)]
    return (omega, v, scaled[0]) if sign > 0 else (-omega, bar, scaled[1])


def _sign(energy: sp.Expr) -> int:
    """Return the sign, 1 or −1, of a number or of an expression that does not change its sign."""
    odd = energy
    if energy.free_symbols:
        coefficient, factors = sp.factor_list(sp.numer(sp.together(energy)) * sp.denom(sp.together(energy)))
        odd = coefficient * sp.Mul(*(factor for factor, power in factors if power % 2))
    if not (odd.is_positive or odd.is_negative):
        raise NotExactError(f"normal_form: the sign of the energy {energy} is not known")
    return 1 if odd.is_positive else -1
