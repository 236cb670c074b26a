"""Transfer functions about upright, and two optimal absorbers of a swaying motion: spins with brace and damper, or a mass.

    X = R Z (−ω² M + i ω C + K)⁻¹ Zᵀ f,   f_i = R_i F_i − S_i a_ground,

for forces F e^(iωt) on the tips and the acceleration a e^(iωt) of the ground, exact for small motion. The spins couple a sway
x, of mass M and stiffness K = M Ω², to a motion z. The coupling is g; the motion z has the inertia m, a brace k_z = m Ω² f² and
a damper c = 2 ζ m Ω:

    M x'' + K x + g z' = F,   m z'' + c z' + k_z z − g x' = 0,   γ² = g²/(M m Ω²).

A pair with tips of inertia a has M = m = 2a, g = 2G and γ = G/(a Ω). There z is the mean y for equal spins and the yaw for
opposite spins. At the optimum for the worst case both peaks of |X| have the same height, the least that any brace and damper
allow. Den Hartog's fixed points (Mechanical Vibrations, 1956, § 3.3) are only a lower bound. Derived in
derivations/n2_shaken.py. Tuned mass: Nishihara & Asami (J. Vib. Acoust. 124, 576, 2002), Warburton (Earthquake Eng. Struct.
Dyn. 10, 1982).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError
from lagrotor.numerics.arrays import finite_array
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Complex, coefficients
from lagrotor.structures.small_motion import check_upright, small_motion


def response(
    s: Assembly, rates: ArrayLike, force: ArrayLike | None = None, at: int | None = None,
    ground: ArrayLike | None = None,
) -> Complex:  # fmt: skip
    """Return the amplitudes of the tips under harmonic excitation: see `Structure.response`."""
    check_upright(s, "response")
    c, linear = coefficients(s), small_motion(s)
    N, w = len(c.R), np.atleast_1d(finite_array("response: rates", rates))
    if w.ndim != 1:
        raise InputError(f"response: rates must be a row of numbers in rad/s, not of shape {w.shape}")
    F = np.zeros((N, 2), dtype=complex)
    if force is not None:
        F += c.R[:, None] * _forces(force, at, N)
    if ground is not None:
        F -= c.S[:, None] * finite_array("response: ground", ground, (2,), complex)
    if force is None and ground is None:
        raise InputError("response: give a force (x, y) in N with its tip `at`, or ground (x, y) in m/s²")
    right = linear.basis.T @ F.ravel()
    square = (w**2)[:, None, None]
    pencil = linear.stiffness - square * linear.mass + 1j * w[:, None, None] * (linear.damping + linear.gyroscopic)
    try:
        q = np.linalg.solve(pencil, np.broadcast_to(right[:, None], (len(w), len(right), 1)))[..., 0]
    except np.linalg.LinAlgError:
        raise InputError(
            "response: one of the rates is the rate of an undamped mode, so the response is infinite: give other rates, "
            "or damping"
        ) from None
    return np.asarray((q @ linear.basis.T).reshape(-1, N, 2) * c.R[:, None])


def _forces(force: ArrayLike, at: int | None, N: int) -> Complex:
    if at is None:
        return finite_array("response: force", force, (N, 2), complex)
    if isinstance(at, bool) or not isinstance(at, int) or not 0 <= at < N:
        raise InputError(f"response: at = {at!r} is no rotor: rotors are numbered 0 to {N - 1}")
    amplitudes = np.zeros((N, 2), dtype=complex)
    amplitudes[at] = finite_array("response: force", force, (2,), complex)
    return amplitudes


@dataclass(frozen=True, eq=False)
class Absorber:
    """An optimal absorber.

    - `tuning`: the tuning f² of the brace, or of the tuned mass.
    - `damping`: the damping ratio ζ.
    - `value`: the peak of |X K/F|, or the mean square of x K/F under white noise in units of π S Ω. S is the two-sided spectral
      density of the force. A sway without absorber and with the damping ratio ζ has the mean square 1/(2ζ).
    """

    tuning: Array
    damping: Array
    value: Array


def _worst_case(d: Array) -> tuple[Array, Array]:
    """Return γ² and 1 − ρ at the optimum for the worst case, for given d = 1 − f²/ρ in (0, 1), with ρ² = 1 − 1/peak²."""
    over = 8 - 8 * d - d**2 + 2 * d**3
    return 2 * d * (2 - d) ** 2 * (4 - 3 * d) / over, d * (8 - 11 * d + 4 * d**2) / over


def _d_where(quantity: int, values: Array) -> Array:
    """Return the d at which result number `quantity` of `_worst_case`, which increases with d, has the given values."""
    from scipy.optimize import brentq

    solve = np.vectorize(
        lambda value: brentq(lambda d: _worst_case(d)[quantity] - value, 0, 1, xtol=1e-30), otypes=[float]
    )
    return np.asarray(solve(values))


def spins_worst_case(gamma: ArrayLike) -> Absorber:
    """Return the brace and damper that minimise the highest peak of a sway coupled by spins.

    Let N = 8 − 8d − d² + 2d³, and let d in (0, 1) solve γ² = 2d (2 − d)² (4 − 3d)/N. With 1 − ρ = d (8 − 11d + 4d²)/N the
    optimum has f² = (1 − d) ρ, ζ² = (1 − ρ)(3 − 2d)/2 and peak² = 1/(1 − ρ²). For small γ these become f² = 1 − γ²/2,
    ζ² = 3γ²/8 and a peak of √2/γ.

    Parameters
    ----------
    gamma : array_like
        The coupling γ, 0 < γ < √2.

    Returns
    -------
    Absorber
        The optimum, with the peak as its value.

    Examples
    --------
    >>> round(float(spins_worst_case(0.5).value), 4)
    2.8392
    """
    d = _d_where(0, _in_domain("gamma", gamma, 2**0.5) ** 2)
    below = _worst_case(d)[1]
    return Absorber((1 - d) * (1 - below), np.sqrt(below * (3 - 2 * d) / 2), 1 / np.sqrt(below * (2 - below)))


def spins_white_noise(gamma: ArrayLike) -> Absorber:
    """Return the brace and damper that minimise the mean square of a sway coupled by spins.

    The optimum has f² = 1 − γ²/2, ζ = γ sqrt(4 − γ²)/4 and the mean square sqrt(4/γ² − 1).

    Parameters
    ----------
    gamma : array_like
        The coupling γ, 0 < γ < √2.

    Returns
    -------
    Absorber
        The optimum under white noise.
    """
    g2 = _in_domain("gamma", gamma, 2**0.5) ** 2
    return Absorber(1 - g2 / 2, np.sqrt(g2 * (4 - g2)) / 4, np.sqrt(4 / g2 - 1))


def mass_worst_case(mu: ArrayLike) -> Absorber:
    """Return the tuned mass that minimises the highest peak of a sway.

    With s = sqrt(4 + 3μ) and the damping ratio ζ of the absorber itself (Nishihara & Asami), the optimum is
    f² = 24/((s − 1)² (3s² + 4s + 4)),   ζ² = 9μ (3s + 2)/(16 (s + 2)(s² − 1)),
    peak = (3s² + 4s + 4)/(3 sqrt(μ (s + 2)(3s + 2))).

    Parameters
    ----------
    mu : array_like
        The ratio μ of the masses.

    Returns
    -------
    Absorber
        The optimum, with the peak as its value. At Den Hartog's fixed points |X K/F| is sqrt(1 + 2/μ).
    """
    m = _in_domain("mu", mu, np.inf)
    s = np.sqrt(4 + 3 * m)
    form = 3 * s**2 + 4 * s + 4
    damping = np.sqrt(9 * m * (3 * s + 2) / (s + 2) / (s**2 - 1)) / 4
    return Absorber(24 / ((s - 1) ** 2 * form), damping, form / (3 * np.sqrt(m * (s + 2) * (3 * s + 2))))


def spins_win_worst_case(mu: ArrayLike) -> Array:
    """Return the coupling γ above which spins have a lower peak than a tuned mass.

    Parameters
    ----------
    mu : array_like
        The ratio μ of the masses.

    Returns
    -------
    Array
        The coupling γ, about sqrt(μ) for small μ.
    """
    inverse = mass_worst_case(mu).value ** -2.0
    return np.asarray(np.sqrt(_worst_case(_d_where(1, inverse / (1 + np.sqrt(1 - inverse))))[0]))


def spins_win_white_noise(mu: ArrayLike) -> Array:
    """Return the coupling γ above which spins have a smaller mean square than a tuned mass.

    Parameters
    ----------
    mu : array_like
        The ratio μ of the masses.

    Returns
    -------
    Array
        The coupling γ = 2 sqrt(μ (1 + μ))/(2 + μ). The mean square of a tuned mass is
        sqrt((4 + 3μ)/(μ (1 + μ))) (Warburton).
    """
    m = _in_domain("mu", mu, np.inf)
    return np.asarray(2 * np.sqrt(m * (1 + m)) / (2 + m))


def _in_domain(name: str, values: ArrayLike, below: float) -> Array:
    """Return the values as an array. Raises DomainError if one is not between 0 and `below`."""
    x = np.asarray(values, dtype=float)
    if not ((x > 0) & (x < below)).all():
        raise DomainError(f"{name} = {values!r} must lie between 0 and {below:g}")
    return x
