"""Birkhoff's normal form of a canonical map about a fixed point, as the return map of a periodic orbit is one.

In coordinates in which the linear part Λ is diagonal, z_j → e^{−iα_j} z_j, F = Φ_h ∘ Λ with the flow Φ_h of a series h in unit
time. A change of coordinates Φ_χ of degree d takes h_d to h_d − χ + χ∘Λ⁻¹: degree by degree all goes but the terms with

    |1 − e^{iα·(a − b)}| ≈ 0       of z^a w^b:    F = Φ_K ∘ Λ,     K of the actions I_j = z_j w_j and the resonances.

The angle of a return is then α_j + ∂K/∂I_j. Birkhoff, Dynamical Systems (1927), ch. III; Moser, Stable and Random Motions in
Dynamical Systems (1973), II.3; Arnold, Mathematical Methods of Classical Mechanics, app. 7.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics.canonical.normal_forms import NormalForm, check_form_order
from lagrotor.mechanics.canonical.polynomials import (
    Coefficients,
    Polynomial,
    lie_transform,
    linear_form,
    polynomial,
    total,
    variable,
)
from lagrotor.mechanics.canonical.symplectic import normal_coordinates
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.floquet_multipliers import multiplier_rows

_RESONANT = 1e-7  # |1 − e^{iα·(a − b)}| that is zero in floating-point numbers
_NEAR = 1e-6  # of 1 or −1: a multiplier that is taken to be it


@dataclass(frozen=True, eq=False, repr=False)
class ReturnMapForm(NormalForm):
    """The return map in normal form, F = Φ_K ∘ Λ with `series` = sum_j α_j z_j w_j + K: `frequencies` are angles α_j of a return.

    α_j (rad) lies between −π and π and is known up to turns, its sign that of Krein, as that of an energy; of a hyperbolic
    pair it is the logarithm of the multiplier, and K a series in its product z w.

    Attributes:
        period: of the orbit, s.
        orbit: its start, {q or p: value}.
        frame: (q, p) − (q₀, p₀) of the displacement y, a series of its components (u_1 … u_m, v_1 … v_m).
        unit: of an action, that of the orbit's size.
        error: the largest difference of a degree's coefficients over the largest of them, between two integrations, and of the
            map from what the form gives back.
    """

    period: float = 0.0
    orbit: Mapping[sp.Symbol, float] = None  # type: ignore[assignment]
    frame: tuple[Polynomial, ...] = ()
    unit: float = 1.0

    @cached_property
    def multipliers(self) -> NDArray[np.complex128]:
        """Λ: of z_1 … z_m, w_1 … w_m; Floquet's, without the two of the motion along the orbit and across energies."""
        rates = self.weights * np.array(self.frequencies)
        return np.exp(np.concatenate([rates, -rates]))

    @property
    def errors(self) -> Array:
        """The errors of the multipliers; of a pair μ, 1/μ both have the same relative one."""
        sizes, right, left = np.abs(self.multipliers), np.abs(self.vectors), np.abs(np.linalg.inv(self.vectors))
        largest = ((right * sizes) @ left).max()  # no element of the map's first order is larger
        relative = self.error * largest * left.sum(1) * right.sum(0) / sizes
        return sizes * np.tile(np.minimum(*np.split(relative, 2)), 2)

    @cached_property
    def twist(self) -> Array:
        """∂α_j/∂I_k (m, m) at the orbit, rad per unit of action."""
        rows = np.eye(len(self.frequencies), dtype=int)
        return np.array([[self.actions.get(tuple((a + b).tolist()), 0.0) * (1 + a @ b) for b in rows] for a in rows])

    def rotation_numbers(self, actions: Sequence[float] | None = None) -> tuple[float, ...]:
        """Turns about the orbit in a return, between −½ and ½ at the orbit; of oscillations, resonances left out."""
        at = [0.0] * len(self.frequencies) if actions is None else actions
        return tuple(
            a / (2 * pi) if c == -1j else np.nan for a, c in zip(self.frequencies_at(at), self.weights, strict=True)
        )

    @property
    def stable(self) -> bool | None:
        """Of the motion of the orbit's energy, or of a drive: False where a multiplier is larger than 1. True by Moser's theorem
        for one pair: no resonance of an order up to four, a twist that is by far larger than the error. None: undecided.
        """
        if (self.weights != -1j).any():
            return False
        low = min((sum(e) for e in self.resonances), default=5)
        decided = len(self.frequencies) == 1 and self.known_through >= 4 and low > 4
        return True if decided and abs(self.twist[0, 0]) * self.unit > 1e3 * self.error else None

    def place(self, z: Sequence[complex]) -> dict[sp.Symbol, float]:
        """The point (q, p) on the section whose normal coordinates are z and w = z̄ (oscillations)."""
        point = np.concatenate([z, np.conj(z)])
        y = [self.original(linear_form(row)).at(point) for row in self.vectors]
        return {s: x + float(f.at(np.array(y)).real) for (s, x), f in zip(self.orbit.items(), self.frame, strict=True)}

    def summary(self) -> dict[str, str]:
        """As `NormalForm.summary`, with the period and the multipliers."""
        listed = multiplier_rows(self.multipliers, self.errors)
        return {"period": f"{self.period:.10g} s"} | listed | super().summary()


def map_normal_form(F: Sequence[Polynomial], order: int, detuning: float = 0.0) -> NormalForm:
    """The normal form of a canonical map y → F(y), y = (u_1 … u_m, v_1 … v_m), F(0) = 0, through K of an order.

    Args:
        F: real polynomials through the degree order − 1.
        detuning: |1 − e^{iα·(a − b)}| up to which a resonance is kept.

    Raises:
        InputError: where F is no such map to first order.
        SingularError: where a multiplier is 1 or −1, above 10⁶, or double and not diagonal, or some too near to 1 beside others
            near −1.
    """
    check_form_order(order, detuning)
    n = len(F)
    if not n or n % 2 or any(not isinstance(f, Polynomial) or f.variables != n for f in F):
        raise InputError("map_normal_form: give 2 m polynomials in as many variables, (u_1 … u_m, v_1 … v_m)")
    m, degree = n // 2, order - 1
    units = np.eye(n, dtype=int)
    M = np.array([[f.terms.get(tuple(e), 0.0) for e in units.tolist()] for f in F]).real
    none, one = np.zeros((m, m)), np.eye(m)
    J = np.block([[none, one], [-one, none]])
    if (
        any(len(f.part(0).coefficients) for f in F)
        or not np.abs(M.T @ J @ M - J).max() < _NEAR * (1 + np.abs(M).max()) ** 2
    ):
        raise InputError(
            f"map_normal_form: F is no canonical map with F(0) = 0: M = {M.tolist()} of its first order has not MᵀJM = J, or F "
            "has a constant"
        )
    if (most := np.abs(np.linalg.eigvals(M)).max()) > 1 / _NEAR:
        raise SingularError(
            f"normal_form: a multiplier is {most:.2g}, too far from its reciprocal for floating-point numbers: "
            "System.floquet gives both"
        )
    for value in (1, -1):
        if (near := np.abs(np.linalg.eigvals(M) - value).min()) < _NEAR:
            way = "name the momentum of a symmetry, or " if value == 1 else ""
            raise SingularError(
                f"normal_form: a multiplier is {value} to {near:.1g}: {way}move a parameter or the energy off this value"
            )
    normal = normal_coordinates(-J @ (M - np.eye(n)) @ np.linalg.inv(M + np.eye(n)), J)  # the same vectors: Cayley
    shares, weights = normal.frequencies, normal.weights
    angles = np.array(
        [2 * np.arctan(s.real) if c == -1j else np.log((1 + s) / (1 - s)) for s, c in zip(shares, weights, strict=True)]
    )
    rates = np.concatenate([weights * angles, -weights * angles])
    back = np.linalg.inv(normal.vectors)
    pair = np.diag(weights)
    brackets = normal.vectors @ np.block([[none, pair], [-pair, none]]) @ normal.vectors.T - J
    left = np.abs(back @ M @ normal.vectors - np.diag(np.exp(rates))).max() / np.abs(np.exp(rates)).max()
    linear = float(max(left, np.abs(brackets).max()))  # multipliers that are taken as equal
    if not linear < _NEAR:
        raise SingularError(
            f"normal_form: the multipliers {np.linalg.eigvals(M).tolist()} are not separated, {linear:.1g} is left: some are "
            "near 1 and others near −1; move a parameter or the energy"
        )
    rows = [linear_form(row) for row in normal.vectors]
    inner = [f.substitute(rows, degree) for f in F]
    z = [variable(k, n) for k in range(n)]
    higher = [total([g.times(c) for c, g in zip(row, inner, strict=True)]) for row in back]
    f = [total([g - g.part(1), z[k].times(np.exp(rates[k]))]) for k, g in enumerate(higher)]
    given, K, generators = f, z[0].part(-1), list[Polynomial]()
    for d in range(3, order + 1):
        h = _exponent(f, K, rates, weights, d)
        shift = 1 - np.exp(-(h.exponents @ rates))
        kept = np.abs(shift) <= max(detuning, _RESONANT)
        K, chi = K + h.where(kept), h.where(~kept).over(shift[~kept])
        generators.append(chi)
        if len(chi.coefficients):
            f = _conjugate(f, chi, weights, degree)
    pairs = {tuple((units[j] + units[m + j]).tolist()): a for j, a in enumerate(angles)}
    series = polynomial(pairs, n) + K
    plain = tuple(complex(a) if abs(a.imag) > 0 else float(a.real) for a in angles)
    form = NormalForm(plain, series, weights, tuple(generators), normal.vectors, order, 0.0)
    return replace(form, error=max(linear, _error(given, form, rates, K)))


def _exponent(f: Sequence[Polynomial], K: Polynomial, rates: Coefficients, weights: Coefficients, d: int) -> Polynomial:
    """h_d of f = Φ_{K + h_d + …} ∘ Λ, from what K leaves of f ∘ Λ⁻¹ at degree d − 1: {x, h_d}, and Euler's rule."""
    m = len(weights)
    parts = []
    for k in range(2 * m):
        part = f[k].part(d - 1)
        left = part.times(np.exp(-(part.exponents @ rates))) - lie_transform(
            variable(k, 2 * m), K, weights, d - 1
        ).part(d - 1)
        other, sign = (k + m, 1) if k < m else (k - m, -1)
        parts.append(left.product(variable(other, 2 * m), d).times(sign / weights[k % m] / d))
    return total(parts)


def _conjugate(f: Sequence[Polynomial], chi: Polynomial, weights: Coefficients, degree: int) -> list[Polynomial]:
    """Φ_χ⁻¹ ∘ f ∘ Φ_χ."""
    away = [lie_transform(variable(k, len(f)), chi.times(-1), weights, degree) for k in range(len(f))]
    return [lie_transform(g.substitute(f, degree), chi, weights, degree) for g in away]


def _error(f: Sequence[Polynomial], form: NormalForm, rates: Coefficients, K: Polynomial) -> float:
    """How far Φ_χ ∘ (Φ_K ∘ Λ) ∘ Φ_χ⁻¹ is from the map."""
    n, degree = len(f), form.known_through - 1
    g = [lie_transform(variable(k, n), K, form.weights, degree) for k in range(n)]
    g = [part.times(np.exp(part.exponents @ rates)) for part in g]
    for chi in reversed(form.generators):
        g = _conjugate(g, chi.times(-1), form.weights, degree) if len(chi.coefficients) else g
    return largest_difference(f, g)


def largest_difference(f: Sequence[Polynomial], g: Sequence[Polynomial]) -> float:
    """The largest difference of coefficients of a degree over the largest of that degree, or of the lowest one."""
    sizes = dict[int, float]()
    for d, part in ((d, part) for whole in f for d, part in whole.parts.items()):
        sizes[d] = max(sizes.get(d, 0.0), float(np.abs(part.coefficients).max()))
    least = sizes[min(sizes)]
    apart = [(d, part) for a, b in zip(f, g, strict=True) for d, part in (a - b).parts.items()]
    return max(
        (float(np.abs(part.coefficients).max()) / max(sizes.get(d, 0.0), least) for d, part in apart), default=0.0
    )
