"""How well spins quieten a sway, and a tuned mass: optimal brace and damper in closed form, and who wins.

A sway of mass M and stiffness K = M Ω² is coupled by the spins (g) to a motion of inertia m that a brace k_z and a damper
c hold:

    M x'' + K x + g z' = F,   m z'' + c z' + k_z z − g x' = 0,   γ² = g²/(M m Ω²).

For the pair under equal or opposite spins ± G, with tips of inertia a: M = m = 2a, g = 2G, γ = G/(a Ω), z the mean y or the
yaw. Brace k_z = m Ω² f², damper c = 2 ζ m Ω. Derived in derivations/n2_shaken.py; the tuned mass is Den Hartog's
(Mechanical Vibrations, 1956, § 3.3) and Warburton's (Earthquake Eng. Struct. Dyn. 10, 1982).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError
from lagrotor.structures.coefficients import Array


@dataclass(frozen=True, eq=False)
class Absorber:
    """f², the brace's tuning; ζ, the damper; value: the largest |X K/F| over all rates, or the mean square.

    The mean square, under white noise, is that of x K/F in units of π S Ω, S the force's two-sided spectral density: without an
    absorber and with a damping ratio ζ of its own, 1/(2ζ).
    """

    tuning: Array
    damping: Array
    value: Array


def spins_worst_case(gamma: ArrayLike) -> Absorber:
    """The spins' best brace and damper in the worst case: f² = 1 − γ²/2, ζ² = 3γ²/8; the largest |X K/F| is √2/γ.

    That is its height at the two fixed points. Raises DomainError unless 0 < γ < √2.
    """
    g2 = _in_domain("gamma", gamma, 2**0.5) ** 2
    return Absorber(1 - g2 / 2, np.sqrt(3 * g2 / 8), np.sqrt(2 / g2))


def spins_white_noise(gamma: ArrayLike) -> Absorber:
    """The spins' best brace and damper under white noise: f² = 1 − γ²/2, ζ = γ sqrt(4 − γ²)/4.

    The mean square is sqrt(4/γ² − 1). Raises DomainError unless 0 < γ < √2.
    """
    g2 = _in_domain("gamma", gamma, 2**0.5) ** 2
    return Absorber(1 - g2 / 2, np.sqrt(g2 * (4 - g2)) / 4, np.sqrt(4 / g2 - 1))


def mass_worst_case(mu: ArrayLike) -> Absorber:
    """The best tuned mass in the worst case (Den Hartog): f = 1/(1 + μ), ζ² = 3μ/(8 (1 + μ)) of the mass' own rate.

    The largest |X K/F| is sqrt(1 + 2/μ), μ the ratio of masses. Raises DomainError unless μ > 0.
    """
    m = _in_domain("mu", mu, np.inf)
    return Absorber(1 / (1 + m) ** 2, np.sqrt(3 * m / (8 * (1 + m))), np.sqrt(1 + 2 / m))


def mass_white_noise(mu: ArrayLike) -> Absorber:
    """The best tuned mass under white noise (Warburton): f² = (1 + μ/2)/(1 + μ)², ζ² = μ (1 + 3μ/4)/(4 (1 + μ)(1 + μ/2)).

    The mean square is sqrt((4 + 3μ)/(μ (1 + μ))). Raises DomainError unless μ > 0.
    """
    m = _in_domain("mu", mu, np.inf)
    damping = np.sqrt(m * (1 + 3 * m / 4) / (4 * (1 + m) * (1 + m / 2)))
    return Absorber((1 + m / 2) / (1 + m) ** 2, damping, np.sqrt((4 + 3 * m) / (m * (1 + m))))


def spins_win_worst_case(mu: ArrayLike) -> Array:
    """γ from which on the spins do better than a tuned mass in the worst case: sqrt(2μ/(2 + μ))."""
    m = _in_domain("mu", mu, np.inf)
    return np.asarray(np.sqrt(2 * m / (2 + m)))


def spins_win_white_noise(mu: ArrayLike) -> Array:
    """γ from which on the spins do better than a tuned mass under white noise: 2 sqrt(μ (1 + μ))/(2 + μ)."""
    m = _in_domain("mu", mu, np.inf)
    return np.asarray(2 * np.sqrt(m * (1 + m)) / (2 + m))


def _in_domain(name: str, given: ArrayLike, below: float) -> Array:
    """What is given as an array, refused outside its domain."""
    x = np.asarray(given, dtype=float)
    if not ((x > 0) & (x < below)).all():
        raise DomainError(f"{name} = {given!r} must lie between 0 and {below:g}")
    return x
