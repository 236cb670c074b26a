"""Periodic orbits of the exact model by shooting, and their family. Newton's method takes the exact Jacobian of the flow.

On the paired precession of opposite spins, at Phi = 0 the axes are parallel in the x-z plane and turn through it (chi = alpha =
0, U' = 0, x = r_0). A quarter period later the symmetries require U = alpha = 0, chi' = 0. The unknowns are u = artanh r_0,
chi'(0), alpha'(0) (in units of Omega_0) and the phase Omega_0 t of the quarter period. The family is followed from small
amplitudes to its end by steps along the curve of orbits, not along r0, so that a fold of the family is passed and not mistaken
for its end.

About upright, with spins that are not opposite, x oscillates between ±r_0, and the orbit closes up to a rotation: at Phi = 0
and half a turn later the axes are parallel and U is stationary at ±artanh r_0. The unknowns are chi'(0), alpha'(0) and the time
of half a turn.
"""

from dataclasses import dataclass, replace
from math import atanh, copysign, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import DomainError, InputError, IntegrationError
from lagrotor.models.minimal import scenes_from_states
from lagrotor.models.orbits.variational import Array, close_arc, flow
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.pair.scene import Scene
from lagrotor.result_display import Shown
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series import shape_of
from lagrotor.theory.paired_precession.series_orbit import amplitude_of

# Bound of the error of a quarter period at the tightest tolerance, relative to the derivative of the flow; calibrated
# against orbits in numbers of 64 bits in tests/models/test_orbit_errors.py.
_INTEGRATED = 3e-14
_LAST_MISS = 1e-8  # before the last step of Newton's method, which squares it
# Tolerance of the flow until the residual is below _NEAR, at a quarter of the cost.
_COARSE, _NEAR = 1e-9, 1e-5
_SAME_SLOPE = 1e-6  # the largest distance at which the Jacobian is reused
_START, _LARGEST = 0.05, 0.99  # amplitudes of a family
_STEP, _MOST = 0.1, 200  # the first step along the curve; orbits
_NO_STEP = 1e-5  # the least step along the family before it turns or ends
FAILURES = (DomainError, IntegrationError, np.linalg.LinAlgError, ValueError)


@dataclass(frozen=True)
class ExactOrbit:
    """A scene that starts on a periodic orbit at Phi = 0, and the frequency (rad/s), with the sign of rotor 1's spin.

    `error` bounds the error of the axes at equal phase over a turn, `frequency_error` the error of the frequency in rad/s.
    """

    scene: Scene
    frequency: float
    error: float
    frequency_error: float


class QuarterPeriod:
    """The equations of the curve of orbits: three conditions a quarter period after the start, for the four unknowns z."""

    def __init__(self, scene: Scene) -> None:
        """Raise InputError unless the spins are opposite and there is a bar."""
        shape_of(scene)
        self.scene = replace(scene, shock=None, axes=((0.0, 0.0, 1.0),) * 2, rates=((0.0, 0.0, 0.0),) * 2)
        inertia, shared = scene.inertias
        self.natural = scene.momenta[0] / sqrt(inertia**2 - shared**2)
        self._flow = flow(self.scene)
        self._last = np.full(4, np.nan), np.empty((3, 4))

    def state(self, z: Array) -> Array:
        """Return the state (U, chi, alpha and their rates), (6,), at Phi = 0 for the unknowns z (4,)."""
        return np.array([z[0], 0.0, 0.0, 0.0, z[1] * self.natural, z[2] * self.natural])

    def __call__(self, z: Array, tol: float = TIGHTEST) -> tuple[Array, Array]:
        """Return the residuals of the conditions (3,) and their Jacobian (3, 4), from a flow integrated at `tol`."""
        scale = self.natural
        now = self._flow(self.state(z), z[3] / abs(scale), tol)
        rows, weights = [0, 2, 4], np.array([1.0, 1.0, 1 / scale])
        slope = np.column_stack(
            [now.slope[rows, 0], now.slope[rows, 4] * scale, now.slope[rows, 5] * scale, now.rate[rows] / abs(scale)]
        )
        self._last = z, weights[:, None] * slope
        return weights * now.end[rows], self._last[1]

    def _slope(self, z: Array) -> Array:
        """Return the Jacobian (3, 4) at z. The last one is reused if it was computed within 1e-6 of z."""
        near = bool(np.abs(z - self._last[0]).max() < _SAME_SLOPE)
        return self._last[1] if near else self(z)[1]

    def linear(self, u: float) -> Array:
        """Return the unknowns z of the orbit of small amplitude u: chi' = 2 u sqrt(sigma) Omega_0, divided by k if k < 1."""
        return np.array([u, 2 * u * sqrt(self.scene.sigma) / min(self.scene.k, 1.0), 0.0, pi / 2])

    def correct(self, z: Array, row: Array, value: float) -> Array:
        """Find the point of the curve on the plane row . z = value by Newton's method. Raises DomainError if it diverges."""
        tol = _COARSE
        for _ in range(9):
            miss, slope = self(z, tol)
            error = np.append(miss, row @ z - value)
            z = z - np.linalg.solve(np.vstack([slope, row]), error)
            if np.abs(error).max() < _LAST_MISS and tol == TIGHTEST:
                return z
            tol = TIGHTEST if np.abs(error).max() < _NEAR else tol
            if not np.isfinite(z).all() or np.abs(z).max() > 60 or z[3] <= 0:  # a quarter period is positive
                break
        raise DomainError("the periodic orbit: Newton's method does not converge; take a smaller amplitude")

    def tangent(self, z: Array, side: Array) -> Array:
        """Return the unit tangent (4,) of the curve at z that has a positive product with `side`."""
        null = np.linalg.svd(self._slope(z))[2][-1]
        return null if null @ side >= 0 else -null

    def follow(self, z: Array | None, r0: float) -> Array:
        """Follow the family from z, or from rest if z is None, to r0 > 0. Raises DomainError if it turns or ends before."""
        goal, row, step = atanh(r0), np.array([1.0, 0.0, 0.0, 0.0]), 0.4
        if z is None:
            u = min(goal, 0.5)
            while True:
                try:
                    z = self.correct(self.linear(u), row, u)
                    break
                except FAILURES:
                    u /= 2
                    if u < _NO_STEP:
                        raise
        while z[0] < goal - 1e-15:
            tangent = self.tangent(z, row)
            if tangent[0] < 0.02 or step < _NO_STEP:
                raise DomainError(
                    f"the periodic orbit of r0 = {r0:g}: the family turns or ends at {np.tanh(z[0]):.6g}; take a smaller "
                    "amplitude, or follow the turn by lagrotor.models.trace_family"
                )
            u = min(goal, z[0] + step)
            try:
                z = self.correct(z + (u - z[0]) / tangent[0] * tangent, row, u)
                step = min(0.4, 1.5 * step)
            except FAILURES:
                step /= 2
        return z

    def orbit(self, z: Array) -> ExactOrbit:
        """Return the orbit with the unknowns z: a scene that starts on it, the frequency, and their errors."""
        frequency = pi / 2 * self.natural / float(z[3])
        # The error at the end of the quarter period, propagated to the unknowns at fixed amplitude and to the axes.
        slope = self._slope(z)
        error = _INTEGRATED * float(np.linalg.norm(slope)) * float(np.linalg.norm(np.linalg.inv(slope[:, 1:]), 2))
        (start,) = scenes_from_states(self.scene, [self.state(z)])
        return ExactOrbit(start, frequency, error * float(np.linalg.norm(slope)), error * abs(frequency / float(z[3])))


def exact_orbit(scene: Scene, r0: float) -> ExactOrbit:
    """Find the exact periodic orbit of an amplitude for opposite spins.

    Parameters
    ----------
    scene : Scene
        The pair. Only its rotor, bar and spins are used.
    r0 : float
        The sine of the inclination when the axes are parallel, 0 < |r0| < 1.

    Returns
    -------
    ExactOrbit
        A scene that starts on the orbit, its frequency, and the errors of both.

    Raises
    ------
    InputError
        Unless the spins are opposite.
    DomainError
        If r0 is out of range, or no such orbit is found.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> round(exact_orbit(Scene(spins=(10, -10)), 0.204).frequency, 8)
    7.91814127
    """
    if amplitude_of(r0, "exact_orbit") == 0:
        raise DomainError("exact_orbit: r0 = 0 is the pair at rest, with no orbit; take an amplitude above 0")
    family = QuarterPeriod(scene)
    z = family.follow(None, abs(r0))
    # Of −r0: the same orbit half a period later.
    return family.orbit(z * np.array([copysign(1, r0), copysign(1, r0), 1.0, 1.0]))


@dataclass(frozen=True, eq=False, repr=False)
class OrbitFamily(Shown):
    """Orbits along the family of paired precessions.

    Attributes
    ----------
    curve : QuarterPeriod
        The equations of the family.
    amplitudes : Array
        The amplitudes r0, (n,).
    frequencies : Array
        The frequencies, (n,), rad/s.
    unknowns : Array
        The unknowns of the shooting, (n, 4).
    turns : tuple
        The amplitudes at which the family turns back in r0.
    reason : str
        The reason for which the family ends.
    """

    curve: QuarterPeriod
    amplitudes: Array
    frequencies: Array
    unknowns: Array
    turns: tuple[float, ...]
    reason: str

    def summary(self) -> dict[str, str]:
        """Return the number and range of the orbits in words.

        Returns
        -------
        dict
            The rows of the table.
        """
        return {
            "orbits": str(len(self.amplitudes)),
            "amplitudes": f"{self.amplitudes.min():.6g} to {self.amplitudes.max():.6g}",
            "frequencies [rad/s]": f"{self.frequencies.min():.6g} to {self.frequencies.max():.6g}",
            "turns back at": ", ".join(f"{turn:.6g}" for turn in self.turns) or "nowhere",
            "ended": self.reason,
        }

    def orbit(self, index: int) -> ExactOrbit:
        """Return one orbit of the family.

        Parameters
        ----------
        index : int
            The number of the orbit.

        Returns
        -------
        ExactOrbit
            A scene that starts on the orbit, with its errors.
        """
        return self.curve.orbit(self.unknowns[index])

    @property
    def frequency_errors(self) -> Array:
        """Bounds of the errors of the frequencies (rad/s), (n,)."""
        return np.array([self.orbit(i).frequency_error for i in range(len(self.amplitudes))])


def trace_family(scene: Scene) -> OrbitFamily:
    """Follow the family of paired precessions from r0 = 0.05 until it ends, r0 reaches 0.99, or there are 200 orbits.

    Steps along the curve grow from 0.1 to 0.5, and are halved if Newton's method fails. The family ends where steps below
    1e-5 fail. There the period or the speed diverges, or the orbit reaches a singular position.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.

    Returns
    -------
    OrbitFamily
        The orbits.
    """
    curve = QuarterPeriod(scene)
    z = curve.correct(curve.linear(atanh(_START)), np.array([1.0, 0, 0, 0]), atanh(_START))
    tangent = curve.tangent(z, np.array([1.0, 0, 0, 0]))
    points, turns, reason, length = [z], [], f"{_MOST} orbits found", _STEP
    while len(points) < _MOST:
        try:
            ahead = curve.correct(z + length * tangent, tangent, float(tangent @ z + length))
            next_tangent = curve.tangent(ahead, tangent)
            if next_tangent @ tangent < 0.9:
                raise DomainError("orbit_family: the step turned too far")
        except FAILURES:
            length /= 2
            if length < 1e-5:
                reason = "no orbit beyond: steps along the curve fail"
                break
            continue
        if next_tangent[0] * tangent[0] < 0:
            turns.append(float(np.tanh(max(z[0], ahead[0]))))
        z, tangent, length = ahead, next_tangent, min(5 * _STEP, 1.3 * length)
        points.append(z)
        if abs(np.tanh(z[0])) > _LARGEST:
            reason = f"r0 reached {_LARGEST:g}"
            break
    return _family(curve, np.array(points), tuple(turns), reason)


def orbit_family(scene: Scene, amplitudes: NDArray[np.float64] | list[float]) -> OrbitFamily:
    """Find the orbits of increasing amplitudes, starting Newton's method for each from the orbit before.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.
    amplitudes : array_like
        The amplitudes r0 (n,), increasing in (0, 1).

    Returns
    -------
    OrbitFamily
        The orbits, with their frequencies.

    Raises
    ------
    InputError
        Unless the spins are opposite.
    DomainError
        If an amplitude is out of range or order, or past the first fold or the end of the family.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> orbit_family(Scene(spins=(10, -10)), [0.1, 0.2]).frequencies.round(6).tolist()
    [7.980085, 7.921273]
    """
    curve = QuarterPeriod(scene)
    targets = np.asarray(amplitudes, float)
    if targets.ndim != 1 or not len(targets) or targets[0] <= 0 or targets[-1] >= 1 or (np.diff(targets) <= 0).any():
        raise DomainError("orbit_family: amplitudes must increase, from above 0 to below 1")
    points: list[Array] = []
    for r0 in targets:
        points.append(curve.follow(points[-1] if points else None, float(r0)))
    return _family(curve, np.array(points), (), "all amplitudes found")


def _family(curve: QuarterPeriod, points: Array, turns: tuple[float, ...], reason: str) -> OrbitFamily:
    return OrbitFamily(curve, np.tanh(points[:, 0]), pi / 2 * curve.natural / points[:, 3], points, turns, reason)


@dataclass(frozen=True)
class UprightOrbit:
    """A scene that starts on an orbit about upright at Phi = 0, its frequency, and `turning`, its mean alpha', in rad/s."""

    scene: Scene
    frequency: float
    turning: float


def upright_orbit(scene: Scene, r0: float) -> UprightOrbit:
    """Find the periodic orbit about upright of an amplitude, for spins that are not opposite.

    Parameters
    ----------
    scene : Scene
        The pair. Only its rotor, bar and spins are used.
    r0 : float
        The sine of the inclination when the axes are parallel, 0 < |r0| < 1.

    Returns
    -------
    UprightOrbit
        A scene that starts on the orbit, its frequency, and its rotation rate.
    """
    amplitude, (first, second) = amplitude_of(r0, "upright_orbit"), scene.momenta
    if scene.link is None or first + second == 0:
        raise InputError(
            f"upright_orbit: give a bar and spins that are not opposite, not {scene.spins}; for opposite ones use exact_orbit"
        )
    if amplitude == 0:
        raise DomainError("upright_orbit: r0 = 0 is the pair at rest; take an amplitude above 0")
    inertia, through, natural = 2 * sum(scene.inertias), flow(scene), natural_rate(scene)
    # Delta' of the normal mode; Delta = k chi for a bar shorter than the axes.
    twist = 2 * scene.sigma * (first - second) * amplitude / inertia / min(scene.k, 1.0)
    guess = np.array([atanh(amplitude), 0, 0, 0, twist, -(first + second) * amplitude / inertia])
    start, time = close_arc(
        through, guess, [4, 5], pi / natural, [0, 1, 3], np.array([-guess[0], 0, 0]), 20 * pi / natural
    )
    if time:
        angle = float(through(start, time).end[2])
        (begun,) = scenes_from_states(replace(scene, shock=None), [start])
        return UprightOrbit(begun, pi / time, angle / time)
    raise DomainError(f"upright_orbit: no orbit of amplitude {r0:g} is found; take a smaller one")
