"""The linear response of a scene at rest and upright to its Gaussian pulse: motion, drift, oscillation and energy.

A Gaussian pulse of width w has the effect of an impulse of the same size, with the oscillation multiplied by exp(−(Omega_0
w)²/4). The matrices are those of `theory.impulse_response`. The response is of first order in the shock, with an error of
second order.
"""

from dataclasses import dataclass
from math import exp, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene, Shock
from lagrotor.result_display import Shown
from lagrotor.theory.natural_rate import natural_frequency_value

# A pulse that peaks later than this many widths after the start has less than 1e-8 of its impulse before the start.
_WIDTHS_BEFORE = 4.0


@dataclass(frozen=True, eq=False, repr=False)
class ShockResponse(Shown):
    """The response to a pulse, to first order in it. Vectors are (x, y_1, y_2), shape (3,).

    After the pulse, with s = t − at,

        q = displacement (1 − A cos Omega_0 s) + drift s + A swing sin(Omega_0 s) / Omega_0.

    Attributes
    ----------
    shock : Shock
        The whole pulse.
    frequency : float
        Natural frequency Omega_0 in rad/s.
    impulse : ndarray
        R times the impulse on the tip, in N m s.
    displacement : ndarray
        Centre of the precession at the peak of the pulse, in units of R.
    drift : ndarray
        Velocity of the centre in 1/s.
    swing : ndarray
        Velocity of the oscillation after a short pulse of the same impulse, in 1/s.
    attenuation : float
        Factor A = exp(−(Omega_0 w)²/4).
    energy : float
        Energy gained, in J.
    impulse_energy : float
        Energy gained in the limit of a short pulse, in J.
    """

    shock: Shock
    frequency: float
    impulse: Array
    displacement: Array
    drift: Array
    swing: Array
    attenuation: float
    energy: float
    impulse_energy: float

    def summary(self) -> dict[str, str]:
        """Return the response as {name: value in words}; vectors are (x, y_1, y_2)."""

        def three(vector: Array) -> str:
            return ", ".join(f"{value + 0.0:.6g}" for value in vector)  # −0 is 0

        return {
            "frequency [rad/s]": f"{self.frequency:.9g}",
            "impulse [N m s]": three(self.impulse),
            "displacement of the centre (x, y₁, y₂)": three(self.displacement),
            "drift [1/s]": three(self.drift),
            "swing [1/s]": three(self.swing),
            "attenuation by the width": f"{self.attenuation:.6g}",
            "energy gained [J]": f"{self.energy:.9g}",
        }

    @property
    def cosine(self) -> Array:
        """The coefficients of cos Omega_0 s in the oscillation, in units of R, shape (3,)."""
        return -self.attenuation * self.displacement

    @property
    def sine(self) -> Array:
        """The coefficients of sin Omega_0 s in the oscillation, in units of R, shape (3,)."""
        return self.attenuation * self.swing / self.frequency if self.frequency else 0 * self.swing

    @property
    def amplitude(self) -> Array:
        """The amplitudes of the oscillation in x, y_1, y_2, sqrt(cosine² + sine²), shape (3,)."""
        return np.hypot(self.cosine, self.sine)

    @property
    def toppling_rate(self) -> float:
        """The mean rate alpha' about the joint line in rad/s, −(y_1' + y_2')/2, to first order in the shock.

        For opposite spins and a shock along the bar it is zero, and `toppling_after_shock` gives the second order.
        """
        return float(-(self.drift[1] + self.drift[2]) / 2)

    def after(self, t: ArrayLike) -> Array:
        """Return (x, y_1, y_2) in units of R at times t (n,) in s, as if the whole pulse were over, shape (n, 3)."""
        s = np.atleast_1d(np.asarray(t, float))[:, None] - self.shock.at
        phase = self.frequency * s
        return self.displacement + self.drift * s + self.cosine * np.cos(phase) + self.sine * np.sin(phase)

    def through(self, t: ArrayLike) -> Array:
        """Return (x, y_1, y_2) in units of R at times t (n,) in s, before, in and after the pulse, shape (n, 3).

        With E = (1 + erf(s/w))/2 the fraction of the impulse received, s in the drift becomes s E + w exp(−(s/w)²)/(2
        sqrt(pi)), and exp(i Omega s) in the oscillation becomes exp(i Omega s − (Omega w)²/4) (1 + erf(s/w + i Omega w/2))/2.
        """
        from scipy.special import erfc, wofz

        s = np.atleast_1d(np.asarray(t, float))[:, None] - self.shock.at
        w, Omega = self.shock.width, self.frequency
        received = erfc(-s / w) / 2
        ramp = s * received + w * np.exp(-((s / w) ** 2)) / (2 * sqrt(pi))
        z = s / w + 0.5j * Omega * w
        # wofz(i z) = exp(z²) erfc(z), bounded for Re z > 0: each half line has its own form.
        tail = np.exp(-((s / w) ** 2)) * wofz(1j * np.where(s > 0, z, -z)) / 2
        wave = np.where(s > 0, self.attenuation * np.exp(1j * Omega * s) - tail, tail)
        sine = self.swing / Omega if Omega else 0 * self.swing
        return self.displacement * (received - wave.real) + self.drift * ramp + sine * wave.imag


def shock_response(scene: Scene) -> ShockResponse:
    """Compute the linear response of the pair, at rest and upright, to the scene's Gaussian pulse, for any spins and any bar.

    The error is proportional to the square of the shock and grows with time; `lagrotor.models.linear.shock_response_error`
    estimates it. A force along z has no effect to this order.

    Parameters
    ----------
    scene : Scene
        Any two spins at rest upright, with a bar and a shock.

    Returns
    -------
    ShockResponse
        Motion, drift, oscillation and energy.

    Raises
    ------
    InputError
        If there is no shock or no bar, if the pair is not at rest and upright, or if the pulse began before t = 0.

    References
    ----------
    Sections 4.2, 5 and 5.2.1 of the paper, which reads them from simulations; derivations/t2_shock_response.py.

    Examples
    --------
    >>> from lagrotor import Scene, Shock
    >>> response = shock_response(Scene(spins=(20, -20), shock=Shock((100, 0, 0), at=1.0, width=0.01)))
    >>> round(response.frequency, 6), response.impulse.round(4).tolist()
    (16.0, [1.7725, 0.0, 0.0])
    """
    if not isinstance(scene, Scene) or scene.shock is None or scene.link is None:
        raise InputError(f"shock_response: {scene!r} must be a Scene with a bar and a shock")
    if scene.axes != ((0, 0, 1), (0, 0, 1)) or scene.rates != ((0, 0, 0), (0, 0, 0)):
        raise InputError("shock_response: the pair must start at rest and upright; use simulate for other starts")
    earliest = _WIDTHS_BEFORE * scene.shock.width
    if scene.shock.at < earliest:
        raise InputError(
            f"shock_response: the pulse at {scene.shock.at:g} s of width {scene.shock.width:g} s began before t = 0; "
            f"place it at {earliest:g} s or later"
        )
    return pulse_response(scene, scene.shock)


@generated(((),))
def _response() -> str:
    """Return the source code of a function of (a, b, G_1, G_2, p_x, p_1, p_2) with 11 outputs.

    They are the displacement, the drift and the swing, three numbers each, and both energies.
    """
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.theory.impulse_response import shock_displacement, shock_drift, shock_energy, shock_swing

    forms = shock_displacement(), shock_drift(), shock_swing(), shock_energy()
    return program_source(Program(forms[0].arguments, (), tuple(e for form in forms for e in form.expressions)))


@generated(((),))
def _mass() -> str:
    """Return the source code of a function of (a, b) whose 9 outputs are the mass matrix of the linear pair in (x, y_1, y_2)."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import a, b
    from lagrotor.theory.impulse_response import impulse_matrices

    return program_source(Program((a, b), (), tuple(impulse_matrices().mass)))


def pulse_response(scene: Scene, shock: Shock) -> ShockResponse:
    """Return the response to a whole pulse, even if it began before t = 0.

    Without any spin nothing oscillates, and the drift is M⁻¹ p.
    """
    px, py, _ = (scene.rotor.length * i for i in shock.impulse)
    impulse = np.array([px, py, 0.0] if shock.body == 1 else [px, 0.0, py])
    inertia_a, inertia_b = scene.inertias
    first, second = scene.momenta
    if first == second == 0:
        mass = np.array(_mass()(inertia_a, inertia_b)).reshape(3, 3)
        drift = np.linalg.solve(mass, impulse)
        gained = float(impulse @ drift) / 2
        zero = np.zeros(3)
        return ShockResponse(shock, 0.0, impulse, zero, drift, zero, 1.0, gained, gained)
    arguments = (inertia_a, inertia_b, first, second, *impulse)
    numbers = np.array(_response()(*arguments))
    (displacement, drift, swing), (of_drift, of_swing) = numbers[:9].reshape(3, 3), numbers[9:].tolist()
    Omega = float(natural_frequency_value()(inertia_a, inertia_b, first, second)[0])
    attenuation = exp(-((Omega * shock.width) ** 2) / 4)
    energy = of_drift + attenuation**2 * of_swing
    return ShockResponse(shock, Omega, impulse, displacement, drift, swing, attenuation, energy, of_drift + of_swing)
