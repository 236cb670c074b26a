"""The paired precession of a scene as a function of time, with its error; by the series through one order."""

from dataclasses import dataclass
from math import copysign, inf

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError
from lagrotor.pair.initial_conditions import consistent_scene
from lagrotor.pair.scene import Scene
from lagrotor.result_display import Shown, superscript
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.orbit_harmonics import Array, axes_of, harmonic_momentum, start_of
from lagrotor.theory.paired_precession.series import paired_series, shape_of

SERIES_ROUNDING = 1e-13  # of a sum of harmonics and of a frequency, relative to 1


@dataclass(frozen=True, eq=False, repr=False)
class PrecessionOrbit(Shown):
    """A paired precession with bounds of its errors. Called with times it gives both axes. At t = 0 they are parallel.

    Attributes
    ----------
    frequency : float
        Angular, rad/s, negative where rotor 1 spins negatively.
    frequency_error : float
        Its bound, rad/s.
    error : float
        Bound of the distance of an axis, and of its derivative by the phase, from the exact orbit's at equal phase, over a
        whole turn (of a tip: in units of R).
    method : str
        How it was found.
    harmonics : Array
        Of r_1, (H + 1, 3), as in lagrotor.theory.paired_precession.orbit_harmonics.
    """

    scene: Scene
    r0: float
    frequency: float
    frequency_error: float
    error: float
    method: str
    harmonics: Array

    def summary(self) -> dict[str, str]:
        """The orbit, how it was found and how well it is known, name → words."""
        return {
            "amplitude": f"{self.r0:g}",
            "frequency [rad/s]": f"{self.frequency:.12g}, known to {self.frequency_error:.1g}",
            "error of an axis": f"{self.error:.1g} at most",
            "method": self.method,
            "momentum about the joint line [kg m²/s]": f"{self.momentum:.9g}",
        }

    def __call__(self, t: ArrayLike) -> Array:
        """Axes at times t (…) in s: (2, …, 3). Raises DomainError for a time that is not finite."""
        return self.at_phase(self.frequency * np.asarray(t, dtype=float))

    def at_phase(self, phase: ArrayLike) -> Array:
        """Axes at phases (…) in rad: (2, …, 3), as of a run.

        Raises
        ------
        DomainError
            For a phase that is not finite.
        """
        phases = np.asarray(phase, dtype=float)
        if not np.isfinite(phases).all():
            raise DomainError("precession_orbit: a time is not finite")
        return axes_of(self.harmonics, phases)

    def error_at(self, t: ArrayLike) -> Array:
        """Bound of an axis' error at times t (…) in s: `error`, and the phase that the frequency's error adds up to."""
        speed = np.linalg.norm(np.arange(len(self.harmonics)) @ np.abs(self.harmonics))  # a bound of |dr/dPhi|
        return self.error + speed * self.frequency_error * np.abs(np.asarray(t, dtype=float))

    @property
    def momentum(self) -> float:
        """P about the joint line, kg m²/s."""
        return harmonic_momentum(self.harmonics, self.frequency, self.scene.inertias, self.scene.momenta[0])

    @property
    def momentum_error(self) -> float:
        """Bound of the momentum's error, kg m²/s.

        At Phi = 0 the axes of both orbits are parallel, so that G drops out and P = −sum_i z_i (a y_i' + b y_j').
        """
        own, shared = self.scene.inertias
        r, slope = start_of(self.harmonics)
        height, across = np.abs(r[:, 2]), np.abs(slope[:, 1])
        of_axes = abs(self.frequency) * (height.sum() + across.sum() + 2 * self.error) * self.error
        of_frequency = (height.max() + self.error) * (across.sum() + 2 * self.error) * self.frequency_error
        return float((own + abs(shared)) * (of_axes + of_frequency))

    @property
    def start(self) -> Scene:
        """The scene started on the orbit at t = 0, to be simulated: exact on the bar, within twice `error` of the orbit.

        So are its rates, in units of `frequency`.
        """
        (axes, slope), scene = start_of(self.harmonics), self.scene
        return consistent_scene(scene.spins, axes, self.frequency * slope, scene.rotor, scene.link, scene.shock)


def amplitude_of(r0: object, where: str) -> float:
    """r0 as a number. Raises DomainError unless −1 < r0 < 1."""
    if isinstance(r0, bool) or not (isinstance(r0, int | float | np.floating) and -1 < r0 < 1):
        raise DomainError(f"{where}: r0 = {r0} must lie between −1 and 1: it is the sine of an inclination")
    return float(r0)


def series_orbit(scene: Scene, r0: float, order: int) -> PrecessionOrbit:
    """The paired precession of amplitude r0 by its series, of whatever error that has.

    At equal phase the error is O(r0**(order + 1)), the frequency's O(r0**(order + 1)) for an odd order. Both are infinite
    for order < 5, whose terms are too few for an estimate. Source: 5.21 and 5.22 of the paper, corrected.

    Parameters
    ----------
    scene : Scene
        With opposite spins and a bar.
    r0 : float
        Sine of the inclination when the axes are parallel.
    order : int
        Through r0**order.

    Raises
    ------
    InputError
        Unless the spins are opposite, there is a bar, and order is at least 1.
    DomainError
        Unless |r0| < 1, and where the terms of the series do not fall.
    """
    amplitude = amplitude_of(r0, "precession_orbit")
    series = paired_series(order, *shape_of(scene))
    rest = series.remainder(amplitude)
    if rest.axes == inf and order >= 5:
        raise DomainError(
            f"precession_orbit: at r0 = {r0:g} the terms of the series of order {order} do not fall: it does not converge "
            "there; take a smaller amplitude, or lagrotor.precession_orbit, which goes over to the exact orbit"
        )
    natural = natural_rate(scene)
    return PrecessionOrbit(
        scene,
        amplitude,
        copysign(natural * series.relative_frequency(amplitude), scene.spins[0]),
        natural * (rest.frequency + SERIES_ROUNDING),
        rest.axes + SERIES_ROUNDING,
        f"series through r₀{superscript(order)}",
        series.harmonics(amplitude),
    )
