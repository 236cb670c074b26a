"""The paired precession to a given error: by its series where that reaches it, else by the exact periodic orbit."""

from dataclasses import replace
from math import copysign, pi

import numpy as np

from lagrotor.errors import DomainError, InputError
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.shooting import ExactOrbit, exact_orbit
from lagrotor.numerics.integrate import TIGHTEST, Problem, integrate
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.orbit_harmonics import Array
from lagrotor.theory.paired_precession.series_orbit import PrecessionOrbit, amplitude_of, series_orbit

_ORDERS = (5, 9, 13)  # beyond which shooting takes less time
_SAMPLES = (16, 32, 64, 128, 256)  # of a quarter period


def precession_orbit(scene: Scene, r0: float, tol: float = 1e-9) -> PrecessionOrbit:
    """The paired precession of amplitude r0, its axes within `tol` at equal phase and its frequency within tol Omega_0.

    The answer has its own bounds, `error` and `frequency_error`, and says how it was found.
    Source: 5.21 and 5.22 of the paper, corrected.

    Parameters
    ----------
    scene : Scene
        With opposite spins and a bar.
    r0 : float
        Sine of the inclination when the axes are parallel.
    tol : float, default 1e-09
        A series through as many orders as that needs, at most r0^13; beyond, the exact periodic orbit, found by shooting and
        sampled as harmonics.

    Raises
    ------
    InputError
        Unless the spins are opposite, there is a bar, and 0 < tol < 1.
    DomainError
        Unless |r0| < 1, and where neither reaches `tol`.
    """
    amplitude = amplitude_of(r0, "precession_orbit")
    if isinstance(tol, bool) or not (isinstance(tol, int | float | np.floating) and 0 < tol < 1):
        raise InputError(f"precession_orbit: tol = {tol!r} must be a number between 0 and 1")
    target = tol * natural_rate(scene)
    for order in _ORDERS:
        try:
            orbit = series_orbit(scene, amplitude, order)
        except DomainError:
            break
        if orbit.error <= tol and orbit.frequency_error <= target:
            return orbit
    orbit = orbit_harmonics(exact_orbit(scene, amplitude), scene, amplitude)
    if orbit.error > tol or orbit.frequency_error > target:
        raise DomainError(
            f"precession_orbit: at r0 = {r0:g} neither the series nor the exact orbit, known to {orbit.error:.1e}, reaches "
            f"tol = {tol:g}; take a larger tol"
        )
    return orbit


def orbit_harmonics(exact: ExactOrbit, scene: Scene, r0: float) -> PrecessionOrbit:
    """An exact orbit as harmonics: sampled over a quarter period, as many times as the harmonics need to fall to its error.

    Raises DomainError where 512 harmonics are too few.
    """
    for n in _SAMPLES:
        harmonics = _harmonics(exact, n)
        remainder = float(np.linalg.norm(np.arange(n, 2 * n)[:, None] * harmonics[n : 2 * n]))
        if remainder <= max(exact.error, TIGHTEST):
            break
    else:
        raise DomainError(
            f"precession_orbit: at r0 = {r0:g} the motion is too uneven for {2 * n} harmonics; integrate the scene of "
            "lagrotor.models.orbits.shooting.exact_orbit"
        )
    count = int(np.flatnonzero(np.abs(harmonics).max(1) > TIGHTEST / 100)[-1]) + 1
    error = 3 * exact.error + remainder
    return PrecessionOrbit(
        scene,
        r0,
        exact.frequency,
        exact.frequency_error,
        error,
        f"exact orbit, {count - 1} harmonics",
        harmonics[:count],
    )


def _harmonics(exact: ExactOrbit, n: int) -> Array:
    """Harmonics (2 n + 1, 3) of r_1 from both axes at n + 1 phases from 0 to a quarter period.

    r_1 at Phi and r_2, which is r_1 at Phi + pi with x → −x; x, z even and y odd in Phi give the other half of the turn.
    """
    still = replace(exact.scene, shock=None)
    times = pi / 2 / abs(exact.frequency) * np.arange(n + 1) / n
    problem = Problem(MODEL.rate(still, False), MODEL.start(still), 50_000)
    first, second = MODEL.observe(still, integrate(problem, times, TIGHTEST).states).axes
    flip = np.array([1.0, -1.0, 1.0])
    later = second * [-1.0, 1.0, 1.0]  # r_1 at pi … 3 pi/2
    turn = np.concatenate([first, (later * flip)[::-1][1:], later[1:], (first * flip)[::-1][1:-1]])
    waves = np.fft.rfft(turn, axis=0) / len(turn)
    waves[1:-1] *= 2
    # Where the frequency is negative the samples run backwards in the phase.
    return np.stack([waves[:, 0].real, -copysign(1, exact.frequency) * waves[:, 1].imag, waves[:, 2].real], axis=1)


def paired_scene(scene: Scene, r0: float, tol: float = 1e-9) -> Scene:
    """A scene started on its paired precession at Phi = 0: `precession_orbit(scene, r0, tol).start`.

    Parameters
    ----------
    scene : Scene
        With opposite spins and a bar.
    r0 : float
        Amplitude.
    tol : float, default 1e-09
        The start is exact on the bar; its axes are within 2 tol of the periodic orbit, its velocities within 2 tol Omega_0.

    Raises
    ------
    InputError
        As `precession_orbit`.
    DomainError
        Likewise.
    """
    return precession_orbit(scene, r0, tol).start
