"""The paired precession to a given error, from its series or, if this is not accurate enough, the exact periodic orbit."""

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

_ORDERS = (5, 9, 13)  # above these shooting is faster
_SAMPLES = (16, 32, 64, 128, 256)  # of a quarter period


def precession_orbit(scene: Scene, r0: float, tol: float = 1e-9) -> PrecessionOrbit:
    """Return the paired precession of amplitude r0 to a given error.

    The result has bounds of its errors, `error` and `frequency_error`, and names its method. It corrects equations 5.21 and
    5.22 of the paper.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.
    r0 : float
        The sine of the inclination when the axes are parallel.
    tol : float, default 1e-9
        The error of the axes at equal phase, and of the frequency in units of Omega_0. A series through at most r0^13 is
        tried; then the exact periodic orbit is found by shooting.

    Returns
    -------
    PrecessionOrbit
        The orbit as harmonics.

    Raises
    ------
    InputError
        Unless the spins are opposite, there is a bar, and 0 < tol < 1.
    DomainError
        Unless |r0| < 1, and if `tol` is not reached.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> orbit = precession_orbit(Scene(spins=(10, -10)), r0=0.204)
    >>> round(orbit.frequency, 8), orbit.frequency_error < 1e-9
    (7.91814127, True)
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
    """Return an exact orbit as harmonics, as many as its error requires. Raises DomainError if it requires more than 512."""
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
    method = f"exact orbit, {count - 1} harmonics"
    return PrecessionOrbit(scene, r0, exact.frequency, exact.frequency_error, error, method, harmonics[:count])


def _harmonics(exact: ExactOrbit, n: int) -> Array:
    """Return the harmonics (2n + 1, 3) of r_1, computed from both axes at n + 1 phases from 0 to a quarter period.

    The axis r_2 is r_1 at Phi + pi with x → −x. The rest of the turn follows because x and z are even and y is odd in Phi.
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
    """Return a scene started on its paired precession at Phi = 0.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.
    r0 : float
        The sine of the inclination when the axes are parallel.
    tol : float, default 1e-9
        The axes differ from the periodic orbit by at most 2 tol, their rates by at most 2 tol Omega_0. The bar keeps its
        length exactly.

    Returns
    -------
    Scene
        The start of `precession_orbit(scene, r0, tol)`.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> start = paired_scene(Scene(spins=(10, -10)), r0=0.204)
    >>> [round(x, 6) for x in start.axes[0]]
    [0.204, 0.0, 0.978971]
    """
    return precession_orbit(scene, r0, tol).start
