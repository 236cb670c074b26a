"""The paired precession of a scene as a function of time, from the series through a given order, with its error."""

from dataclasses import dataclass
from math import copysign, inf

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError
from lagrotor.pair.initial_conditions import consistent_scene
from lagrotor.pair.scene import Scene
from lagrotor.result_display import Shown, scientific, superscript
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.orbit_harmonics import Array, axes_of, harmonic_momentum, start_of
from lagrotor.theory.paired_precession.series import paired_series, shape_of

SERIES_ROUNDING = 1e-13  # of a sum of harmonics and of a frequency, relative to 1


@dataclass(frozen=True, eq=False, repr=False)
class PrecessionOrbit(Shown):
    """A paired precession with error bounds. A call with times returns both axes; at t = 0 they are parallel.

    Attributes
    ----------
    scene : Scene
        The rotors, the bar and the spins.
    r0 : float
        Amplitude, the sine of the inclination at the moments of parallel axes.
    frequency : float
        Angular frequency in rad/s, negative if rotor 1 spins negatively.
    frequency_error : float
        Bound of the frequency's error in rad/s.
    error : float
        Bound of the error of an axis, and of its derivative by the phase, at equal phase over a whole period, in units of R.
    method : str
        Method of computation in words.
    harmonics : ndarray
        Harmonics of r_1, shape (H + 1, 3): row h has the coefficients (X, Y, Z) of cos h Phi, sin h Phi and cos h Phi.
    """

    scene: Scene
    r0: float
    frequency: float
    frequency_error: float
    error: float
    method: str
    harmonics: Array

    def summary(self) -> dict[str, str]:
        """Summarise the orbit, its method and its errors.

        Returns
        -------
        dict[str, str]
            Name → value in words.
        """
        return {
            "amplitude": f"{self.r0:g}",
            "frequency [rad/s]": f"{self.frequency:.12g}, known to {scientific(self.frequency_error)}",
            "error of an axis": f"{scientific(self.error)} at most",
            "method": self.method,
            "momentum about the joint line [kg m²/s]": f"{self.momentum:.9g}",
        }

    def __call__(self, t: ArrayLike) -> Array:
        """Return the axes at times t (…) in s, shape (2, …, 3). Raises DomainError for a time that is not finite."""
        return self.at_phase(self.frequency * np.asarray(t, dtype=float))

    def at_phase(self, phase: ArrayLike) -> Array:
        """Return both axes at phases.

        Parameters
        ----------
        phase : array_like
            Phases in rad, any shape.

        Returns
        -------
        ndarray
            Unit vectors, shape (2, …, 3).

        Raises
        ------
        DomainError
            For a phase that is not finite.
        """
        phases = np.asarray(phase, dtype=float)
        if not np.isfinite(phases).all():
            raise DomainError("precession_orbit: a time is not finite")
        return axes_of(self.harmonics, phases)

    @property
    def momentum(self) -> float:
        """The momentum P about the joint line in kg m²/s."""
        return harmonic_momentum(self.harmonics, self.frequency, self.scene.inertias, self.scene.momenta[0])

    @property
    def start(self) -> Scene:
        """The scene started on the orbit at t = 0: the bar's constraint holds exactly.

        The axes, and the rates in units of `frequency`, differ from those of the orbit by at most twice `error`.
        """
        (axes, slope), scene = start_of(self.harmonics), self.scene
        return consistent_scene(scene.spins, axes, self.frequency * slope, scene.rotor, scene.link, scene.shock)


def amplitude_of(r0: object, where: str) -> float:
    """Return r0 as a number. Raises DomainError unless −1 < r0 < 1."""
    if isinstance(r0, bool) or not (isinstance(r0, int | float | np.floating) and -1 < r0 < 1):
        raise DomainError(f"{where}: r0 = {r0} must lie between −1 and 1: it is the sine of an inclination")
    return float(r0)


def series_orbit(scene: Scene, r0: float, order: int) -> PrecessionOrbit:
    """Compute the paired precession of amplitude r0 by its series, however large the error is.

    The error of the axes at equal phase is O(r0**(order + 1)); for an odd order so is the error of the frequency. The bounds
    are inf for order < 5, since such a series has too few terms for an estimate.

    Parameters
    ----------
    scene : Scene
        Opposite spins with a bar.
    r0 : float
        Sine of the inclination at the moments of parallel axes.
    order : int
        Highest power of r0.

    Returns
    -------
    PrecessionOrbit
        The orbit with its error bounds.

    Raises
    ------
    InputError
        Unless the spins are opposite, there is a bar, and order is at least 1.
    DomainError
        Unless |r0| < 1, or if the terms of the series do not decrease.

    References
    ----------
    Equations (5.21) and (5.22) of the paper, corrected; derivations/t3_paired_orbit.py.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(series_orbit(Scene(spins=(10, -10)), r0=0.2, order=9).frequency, 3)
    7.921
    """
    amplitude = amplitude_of(r0, "precession_orbit")
    series = paired_series(order, *shape_of(scene))
    remainder = series.remainder(amplitude)
    if remainder.axes == inf and order >= 5:
        raise DomainError(
            f"precession_orbit: at r0 = {r0:g} the terms of the series of order {order} do not fall: it does not converge "
            "there; take a smaller amplitude, or lagrotor.precession_orbit, which goes over to the exact orbit"
        )
    natural = natural_rate(scene)
    frequency = copysign(natural * series.relative_frequency(amplitude), scene.spins[0])
    errors = natural * (remainder.frequency + SERIES_ROUNDING), remainder.axes + SERIES_ROUNDING
    method, harmonics = f"series through r₀{superscript(order)}", series.harmonics(amplitude)
    return PrecessionOrbit(scene, amplitude, frequency, *errors, method, harmonics)
