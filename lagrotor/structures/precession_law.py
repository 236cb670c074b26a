"""The rate and the stability of a mode's precession at small tilts, from the normal form of fourth order.

With the actions I_k of the normal coordinates z_k the Hamiltonian is H = sum_k ω_k I_k + ½ sum_kl A_kl I_k I_l + …. A motion in
mode j alone stays in this mode if no multiple of ω_j is another rate (Lyapunov 1907; equal rates: Weinstein 1973, Moser 1976):

    Ω = ω_j + A_jj I_j + O(I_j²),    multipliers exp(±2πi (ω_k + A_jk I_j)/Ω).

The axis that moves most tilts by a + b a², where a = 2 |its component of the mode| √I_j and b comes from the terms forced at
0 and 2Ω. Hence

    Ω = ω_j + ω_j2 (tilt² − 2 b tilt³) + O(tilt⁴).

If m|ω_j| is near |ω_k + ω_l|, with rates that have the signs of their energies, the terms c z_j^m z̄_k z̄_l, or with z̄_j, are
kept. They couple the two modes. Multipliers leave the unit circle if |c| I_j^(m/2) (twice this for k = l) exceeds half of the
detuning of the rates at I_j.
"""

from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.canonical.polynomials import Polynomial, lie_transform, linear_form
from lagrotor.pair.quantities import finite_number
from lagrotor.renamed import old_attribute
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.resonances import MOST_DOF, normal_form_of, signed_rates
from lagrotor.structures.small_motion import small_motion
from lagrotor.structures.steady_precession import precessing_mode
from lagrotor.structures.upright_hamiltonian import local_hamiltonian

_NEAR = 0.1  # relative to the largest rate: the largest detuning of resonant terms
_NEGLIGIBLE = 1e-9  # relative to the largest coefficient: smaller ones are zero
_LARGEST = 0.5  # limit of the tilt, and of the modes that harmonics drive relative to the mode
_TILTS = 400  # tilts in the search for the edge
_ROUNDING = 1e-9  # of a multiplier's modulus
_EXACT = 1e-6  # relative detuning below which a mode is resonant


@dataclass(frozen=True, eq=False, repr=False)
class PrecessionLaw(Shown):
    """The precession rate Ω = rate + shift (tilt² − 2 skew tilt³) + O(tilt⁴) of a mode, in rad/s.

    others (n − 1,): the other rates, rad/s, negative for modes of negative energy; sign: the sign of this mode's energy.
    reach: the largest tilt of the law, 0.5 or less if harmonics drive other modes. action: I_j/a² in the units of
    `quadratic`. quadratic: the terms in z_j, z̄_j that are of second degree in the other z, z̄, rad/s.
    """

    rate: float
    shift: float
    skew: float
    others: Array
    reach: float
    sign: int
    action: float
    quadratic: Polynomial
    structure: Assembly
    mode: int

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    def rate_at(self, tilt: float) -> float:
        """Return Ω in rad/s at a tilt, which is defined as for `Structure.steady_precession`."""
        return self.rate + self.shift * self._square(tilt)

    def multipliers_at(self, tilt: float) -> NDArray[np.complex128]:
        """Return the Floquet multipliers (2n − 2,) other than the two that are 1, at a tilt."""
        from scipy.linalg import expm

        period, rotation = 2 * pi / self.rate_at(tilt), np.exp(-2 * pi * self._turning)
        return np.asarray(np.linalg.eigvals(rotation[:, None] * expm(self._slopes(self._root(tilt)) * period)))

    def growth_at(self, tilt: float) -> float:
        """Return the logarithm of the largest modulus of a multiplier per turn; 0 if it is below 1e-9."""
        exponent = float(np.log(np.abs(self.multipliers_at(tilt)).max(initial=1.0)))
        return exponent if exponent > _ROUNDING else 0.0

    @property
    def edge(self) -> float:
        """The least of 400 tilts, refined, at which a multiplier leaves the unit circle; inf if none does within `reach`."""
        tilts = np.linspace(0, self.reach, _TILTS + 1)[1:]
        beyond = next((float(tilt) for tilt in tilts if self.growth_at(tilt)), inf)
        stable = beyond - float(tilts[0])
        while beyond < inf and beyond - stable > 1e-9 * self.reach:
            middle = (stable + beyond) / 2
            stable, beyond = (stable, middle) if self.growth_at(middle) else (middle, beyond)
        return beyond

    @property
    def _turning(self) -> NDArray[np.complex128]:
        """The values i ν/Ω of ζ and ζ̄ in z_k = ζ_k exp(−iν_k t), where the equations of ζ are autonomous."""
        nu = self.sign * _frame(self.quadratic)[0]
        return np.asarray(1j * np.append(nu, -nu), complex)

    @cached_property
    def _powers(self) -> NDArray[np.complex128]:
        """The matrices S₀, S₁, S₂ of (ζ, ζ̄)' = (S₀ + r S₁ + r² S₂) (ζ, ζ̄), with r² the action, (3, 2n − 2, 2n − 2)."""
        half = len(self.others)
        Q = np.zeros((3, 2 * half, 2 * half), complex)
        for c, e in zip(self.quadratic.coefficients, self.quadratic.exponents, strict=True):
            k, l = (i for i, m in enumerate(e[2:]) for _ in range(m))
            Q[sum(e[:2]), k, l] += c
            Q[sum(e[:2]), l, k] += c
        slopes = -1j * np.concatenate([Q[:, half:], -Q[:, :half]], axis=1)
        slopes[[0, 2]] += np.diag(self._turning) * np.array([self.rate, self.shift / self.action])[:, None, None]
        return np.asarray(slopes)

    def _slopes(self, root: float) -> NDArray[np.complex128]:
        return np.asarray(np.tensordot([1, root, root**2], self._powers, 1))

    def _root(self, tilt: float) -> float:
        return float((self._square(tilt) * self.action) ** 0.5)

    def summary(self) -> dict[str, str]:
        """Return the law in numbers and the edge of stability."""
        return {
            "rate [rad/s]": f"{self.rate:.8g} + ({self.shift:.6g}) (tilt² − 2 ({self.skew:.4g}) tilt³)",
            "stable": f"up to a tilt of {self.edge:.4g}"
            if self.edge < inf
            else f"up to a tilt of {self.reach:.4g} at least, to which it is trusted",
        }

    def _square(self, tilt: float) -> float:
        """Return a² at a tilt."""
        tilt = finite_number(tilt, "precession_law: tilt", "parts of a unit vector")
        if not 0 <= tilt <= self.reach * (1 + _ROUNDING):
            raise InputError(
                f"precession_law: tilt = {tilt:g} must lie between 0 and {self.reach:.4g}, to which the expansion is trusted: "
                "take steady_precession(mode, tilt)"
            )
        return tilt**2 * (1 - 2 * self.skew * tilt)


def precession_law(s: Assembly, mode: int = 0) -> PrecessionLaw:
    """Expand the precessions of a mode at small tilts: see `Structure.precession_law`."""
    where = "precession_law"
    rate, shape = precessing_mode(s, mode, where)
    rates, n = signed_rates(small_motion(s)), small_motion(s).dof
    if n > MOST_DOF:
        raise InputError(f"{where}: {n} degrees of freedom: at most {MOST_DOF} are expanded")
    if len(rates) < n:
        raise InputError(
            f"{where}: another mode grows or has no rate, and only oscillations are expanded: take steady_precession(mode, tilt)"
        )
    h, detuning = local_hamiltonian(s), inf
    while True:
        form = normal_form_of(s, 1.0, min(detuning, _NEAR * rate / h.rate))
        signed = np.real(form.frequencies)
        j = int(np.abs(np.abs(signed) * h.rate - rate).argmin())
        others = np.delete(np.arange(n), j)
        series = form.series.where(
            np.abs(form.series.coefficients) > _NEGLIGIBLE * np.abs(form.series.coefficients).max()
        )
        series = Polynomial(series.exponents[:, [j, n + j, *others, *(n + others)]], h.rate * series.coefficients)
        degree = series.exponents[:, 2:].sum(1)
        single, pushed, quadratic = (series.where(degree == d) for d in range(3))
        spoils = pushed if len(pushed.coefficients) else quadratic if _frame(quadratic)[1] > _NEGLIGIBLE else None
        if spoils is None:
            break
        gaps = np.abs(_steps(spoils.exponents[:, :2]) @ signed[[j]] + _steps(spoils.exponents[:, 2:]) @ signed[others])
        if (detuning := 0.999 * float(gaps.max())) < _EXACT * abs(signed[j]):
            raise InputError(
                f"{where}: a multiple of the rate of mode {mode}, {rate:.6g} rad/s, is the rate of another mode, which it "
                "drives: change a spin"
            )
    lead = int(np.abs(shape).argmax())
    component = 2 * h.basis[lead] @ form.vectors[:n, j]
    action, sign = 1 / abs(component) ** 2, 1 if signed[j] > 0 else -1
    at = np.zeros(2 * n, complex)
    at[[j, n + j]] = 1 / component, 1 / component.conjugate()  # the state at a = 1 with the largest tilt of the axis
    tilt = h.axes[lead // 2][lead % 2].through(2)
    tilt = Polynomial(tilt.exponents, tilt.coefficients + 0j).substitute(
        [linear_form(row) for row in form.vectors[:n]], 2
    )
    skew = float(np.real(lie_transform(tilt, form.generators[0], form.weights, 2).part(2).at(at)))
    reach = _LARGEST / max(1.0, 2 * abs(skew))
    for degree, generator in enumerate(form.generators, 3):
        driven = max((abs(generator.derivative(k).at(at)) for k in (*others, *(n + others))), default=0.0) / action**0.5
        reach = min(reach, (_LARGEST / max(driven, _NEGLIGIBLE)) ** (1 / (degree - 2)))
    shift = 2 * sign * action * float(np.real(single.terms.get((2, 2, *(0,) * (2 * n - 2)), 0.0)))
    return PrecessionLaw(rate, shift, skew, h.rate * signed[others], reach, sign, action, quadratic, s, mode)


def _steps(exponents: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the powers of the z minus those of the z̄."""
    half = exponents.shape[1] // 2
    return exponents[:, :half] - exponents[:, half:]


def _frame(quadratic: Polynomial) -> tuple[Array, float]:
    """Return the ν_k/Ω in which the terms of mode j and two others are constant, and their remaining rate."""
    steps = _steps(quadratic.exponents[:, 2:]).astype(float)
    steps_of_mode = -_steps(quadratic.exponents[:, :2])[:, 0]
    nu: Array = np.linalg.pinv(steps) @ steps_of_mode
    return nu, float(np.abs(steps @ nu - steps_of_mode).max(initial=0.0))
