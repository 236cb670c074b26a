"""Normal coordinates of a quadratic Hamiltonian ½ x·A x with brackets {x_a, x_b} = Ω_ab, and the sign of each mode's energy.

The flow is x' = Ω A x. A mode of the rates ∓ i ω has vectors v, v̄ with Ω A v = −i ω v; with x = z v + w v̄ its energy is
z w v†A v, so that with v†A v = ω

    H = ω z w,     {z, w} = −i,     w = z̄,     the action I = z w ≥ 0:  ω < 0 where the energy is negative (Krein).

What grows and decays, ± λ with vectors v, u, has H = λ z w, {z, w} = 1. What has the rate zero is left as it is, with a
canonical basis. Williamson, Amer. J. Math. 58 (1936) 141; Yakubovich & Starzhinskii, Linear Differential Equations with
Periodic Coefficients, ch. III.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import SingularError

Matrix = NDArray[Any]
_DEFECTIVE = 1e-9  # of the rate: smaller energies of vectors of length 1 are those of a mode that is not diagonal
_CLOSE = 1e-7  # of the largest rate: rates nearer to each other, or to zero, are taken to be equal


@dataclass(frozen=True, eq=False)
class NormalCoordinates:
    """x = vectors (2n, 2n) (z_1 … z_n, w_1 … w_n), {z_j, w_j} = weights_j, and ½ x·A x = sum_j frequencies_j z_j w_j + rest.

    frequencies (n,): ω of signed energy where the weight is −i, λ where it is 1, and 0 of what the rest of the quadratic
    form is about. Oscillations come first, by |ω|.
    """

    vectors: Matrix
    weights: Matrix
    frequencies: Matrix


def normal_coordinates(A: Matrix, bracket: Matrix) -> NormalCoordinates:
    """Normal coordinates in floating-point numbers, A symmetric and the bracket's matrix Ω regular.

    Raises SingularError where a rate other than zero is double and its vectors do not suffice.
    """
    rates, vectors = np.linalg.eig(bracket @ A)
    size = max(float(np.abs(rates).max()), 1e-300)
    near = _CLOSE * size
    still = np.abs(rates) < 10 * near
    modes: list[tuple[complex, complex, Matrix, Matrix]] = []  # frequency, weight, vector of z, vector of w
    left = [int(k) for k in np.flatnonzero(~still)]
    while left:
        rate = max((rates[k] for k in left), key=lambda s: (round(abs(s) / near), s.imag, s.real))
        group = [k for k in left if abs(rates[k] - rate) < near]
        other = [k for k in left if abs(rates[k] + rate) < near]
        left = [k for k in left if k not in {*group, *other}]
        V, U = vectors[:, group], vectors[:, other]
        if abs(rate.real) < near:
            modes += _oscillations(A, V.conj(), abs(rate.imag), near)
        else:
            pairing = V.T @ A @ U
            _check(pairing, rate)
            U = U @ np.linalg.inv(pairing) * rate
            modes += [(rate, 1.0, V[:, j], U[:, j]) for j in range(len(group))]
    modes.sort(key=lambda mode: (mode[1] == 1.0, abs(mode[0])))
    modes += [(0.0, 1.0, v, u) for v, u in _standing(A, bracket, int(still.sum()))]
    columns = [mode[2] for mode in modes] + [mode[3] for mode in modes]
    weights, frequencies = np.array([mode[1] for mode in modes]), np.array([mode[0] for mode in modes])
    return NormalCoordinates(np.array(columns).T + 0j, weights + 0j, frequencies + 0j)


def _check(form: Matrix, rate: complex) -> None:
    if np.linalg.svd(form, compute_uv=False)[-1] < _DEFECTIVE * abs(rate):
        raise SingularError(
            f"normal_form: the rate {rate:.6g} is double and not diagonal: move a parameter off this value"
        )


def _oscillations(A: Matrix, V: Matrix, omega: float, near: float) -> list[tuple[complex, complex, Matrix, Matrix]]:
    """The modes of Ω A v = −i ω v, with the signs of their energies."""
    form = V.conj().T @ A @ V
    _check(form, 1j * omega)
    energies, turned = np.linalg.eigh(form)
    modes: list[tuple[complex, complex, Matrix, Matrix]] = []
    for energy, column in zip(energies, (V @ turned).T, strict=True):
        lead = column[np.argmax(np.abs(column))]
        v = column * np.sqrt(omega / abs(energy)) * abs(lead) / lead
        modes += [(omega, -1j, v, v.conj())] if energy > 0 else [(-omega, -1j, v.conj(), v)]
    return modes


def _standing(A: Matrix, bracket: Matrix, count: int) -> list[tuple[Matrix, Matrix]]:
    """A canonical basis of the generalised null space of Ω A, by pairs (v, u) with the form v·Ω⁻¹u = −1 as q and p have.

    In each pair v·A u = 0. Where u·A u is not zero u drives v: v is along Ω A u.
    """
    if not count:
        return []
    W = bracket @ A
    size = max(np.abs(W).max(), 1e-300)
    _, _, rows = np.linalg.svd(np.linalg.matrix_power(W / size, count))
    basis, form, pairs = rows[len(rows) - count :].conj(), np.linalg.inv(bracket), list[tuple[Matrix, Matrix]]()
    while len(basis):
        values, turned = np.linalg.eigh(basis @ A @ basis.T)
        *others, u = turned.T[np.argsort(np.abs(values), kind="stable")] @ basis
        driven = np.abs(values).max() > _CLOSE * size
        v = W @ u if driven else others.pop(int(np.argmax([abs(x @ form @ u) for x in others])))
        v = v / -(v @ form @ u)
        pairs.append((v, u))
        left = [x + (x @ form @ u) * v - (x @ form @ v) * u for x in others]
        _, _, rows = np.linalg.svd(np.array(left).reshape(-1, len(A)))
        basis = rows[: len(basis) - 2]
    return pairs
