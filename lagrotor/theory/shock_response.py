"""The linear response of a scene at rest and upright to its Gaussian pulse: motion, drift, swing and energy.

A Gaussian pulse of width w leaves what an impulse of the same size leaves, but for the swing, which is multiplied by
exp(−(Omega_0 w)²/4); the matrices are those of `theory.impulse_response`. First order in the shock: the error is of
second order, and `lagrotor.models.linear.shock_response_error` estimates it.
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

# A pulse that peaks later than this many widths after the start has lost less than 1e-8 of its impulse before it.
_WIDTHS_BEFORE = 4.0


@dataclass(frozen=True, eq=False, repr=False)
class ShockResponse(Shown):
    """What a pulse leaves, to first order in it. Vectors are (x, y_1, y_2), (3,).

    shock: the pulse, whole. frequency: Omega_0 (rad/s). impulse: R times the impulse on the tip (N m s). displacement:
    centre of the precession when the pulse peaks (1); with `drift` (1/s) it moves. swing: velocity of the swing that a
    short pulse of the same impulse would start (1/s). attenuation: A = exp(−(Omega_0 w)²/4). After the pulse, with
    s = t − at,

        q = displacement (1 − A cos Omega_0 s) + drift s + A swing sin(Omega_0 s) / Omega_0.

    energy: gained (J); impulse_energy: the limit of a short pulse (J).
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
        """What the pulse leaves, name → words; vectors are (x, y_1, y_2)."""

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
        """The swing's coefficients of cos Omega_0 s, (3,)."""
        return -self.attenuation * self.displacement

    @property
    def sine(self) -> Array:
        """The swing's coefficients of sin Omega_0 s, (3,)."""
        return self.attenuation * self.swing / self.frequency if self.frequency else 0 * self.swing

    @property
    def amplitude(self) -> Array:
        """Amplitudes of the swing in x, y_1, y_2, (3,): sqrt(cosine² + sine²)."""
        return np.hypot(self.cosine, self.sine)

    @property
    def toppling_rate(self) -> float:
        """Rate of the mean turning about the joint line, −(y_1' + y_2')/2, as alpha' (rad/s), to first order in the shock.

        Of opposite spins a shock along the bar alone has none; the second order, `toppling_after_shock`, then decides.
        """
        return float(-(self.drift[1] + self.drift[2]) / 2)

    def after(self, t: ArrayLike) -> Array:
        """(x, y_1, y_2) at times t (n,), as if the whole pulse were over, (n, 3)."""
        s = np.atleast_1d(np.asarray(t, float))[:, None] - self.shock.at
        phase = self.frequency * s
        return self.displacement + self.drift * s + self.cosine * np.cos(phase) + self.sine * np.sin(phase)

    def through(self, t: ArrayLike) -> Array:
        """(x, y_1, y_2) at times t (n,) before, in and after the pulse, (n, 3).

        With E = (1 + erf(s/w))/2 the impulse received so far, the drift's s becomes s E + w exp(−(s/w)²)/(2 sqrt(pi))
        and the swing's exp(i Omega s) becomes exp(i Omega s − (Omega w)²/4) (1 + erf(s/w + i Omega w/2))/2.
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
    """The linear response of the pair, at rest and upright, to the scene's Gaussian pulse; any spins, any bar.

    The error against the exact motion falls as the square of the shock and grows with time;
    `lagrotor.models.linear.shock_response_error` estimates it. A force along z does nothing to this order.
    Source: 4.2, 5 and 5.2.1 of the paper, where these are read off simulations.

    Raises
    ------
    InputError
        Without a shock or a bar, when the pair is not at rest upright, or when the pulse began before t = 0.
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
    """(a, b, G_1, G_2, p_x, p_1, p_2) → displacement, drift, swing, both energies: 11 numbers."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.theory.impulse_response import shock_displacement, shock_drift, shock_energy, shock_swing

    forms = shock_displacement(), shock_drift(), shock_swing(), shock_energy()
    return program_source(Program(forms[0].arguments, (), tuple(e for form in forms for e in form.expressions)))


@generated(((),))
def _mass() -> str:
    """(a, b) → the mass matrix of the linear pair in (x, y_1, y_2), 9 numbers."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import a, b
    from lagrotor.theory.impulse_response import impulse_matrices

    return program_source(Program((a, b), (), tuple(impulse_matrices().mass)))


def pulse_response(scene: Scene, shock: Shock) -> ShockResponse:
    """The response of the scene's pair, at rest and upright, to the whole of a pulse, wherever it began.

    Without any spin nothing swings: the drift is M⁻¹ p.
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
    displacement, drift, swing, (along, across) = numbers[:3], numbers[3:6], numbers[6:9], numbers[9:].tolist()
    Omega = float(natural_frequency_value()(inertia_a, inertia_b, first, second)[0])
    attenuation = exp(-((Omega * shock.width) ** 2) / 4)
    energy = along + attenuation**2 * across
    return ShockResponse(shock, Omega, impulse, displacement, drift, swing, attenuation, energy, along + across)
