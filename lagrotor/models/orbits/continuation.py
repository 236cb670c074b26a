"""The paired precession from small amplitudes to the end of its family, by continuation along the curve of orbits.

Unknown are u = artanh r0, chi'(0), alpha'(0) (in units of Omega_0) and the quarter period's phase; at a quarter period
U = alpha = chi' = 0. Newton's method with the exact Jacobian of the flow, and steps along the curve, not along r0, so
that a turn of the family is passed and not mistaken for its end.
"""

from dataclasses import dataclass, replace
from math import atanh, pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import DomainError, IntegrationError
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.shooting import ExactOrbit
from lagrotor.models.orbits.variational import flow
from lagrotor.pair.scene import Scene
from lagrotor.theory.paired_precession.series import shape_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OrbitFamily:
    """Orbits along the family: amplitudes r0 (n,), frequencies (rad/s) (n,), unknowns (n, 4), and why it stopped.

    `turns`: amplitudes at which the family turns back in r0 (largest r0 of the two branches that meet there).
    """

    scene: Scene
    amplitudes: Array
    frequencies: Array
    unknowns: Array
    turns: tuple[float, ...]
    reason: str

    def orbit(self, index: int) -> ExactOrbit:
        """The orbit number `index`, as a scene that starts on it."""
        state = _state(self.unknowns[index], _natural(self.scene))
        seen = MODEL.observe(self.scene, state[None])
        axes, rates = (tuple(tuple(map(float, row)) for row in part[:, 0]) for part in (seen.axes, seen.rates))
        return ExactOrbit(replace(self.scene, axes=axes, rates=rates), float(self.frequencies[index]))  # type: ignore[arg-type]


def _natural(scene: Scene) -> float:
    inertia_a, inertia_b = scene.inertias
    return scene.momenta[0] / float(np.sqrt(inertia_a**2 - inertia_b**2))


def _state(unknown: Array, natural: float) -> Array:
    return np.array([unknown[0], 0.0, 0.0, 0.0, unknown[1] * natural, unknown[2] * natural])


class _Curve:
    """The equations of the family and their Jacobian at a point of it."""

    def __init__(self, scene: Scene) -> None:
        self.natural = _natural(scene)
        self.through = flow(scene)

    def __call__(self, z: Array) -> tuple[Array, Array]:
        scale = self.natural
        now = self.through(_state(z, scale), z[3] / abs(scale))
        rows, weights = [0, 2, 4], np.array([1.0, 1.0, 1 / scale])
        slope = np.column_stack(
            [now.slope[rows, 0], now.slope[rows, 4] * scale, now.slope[rows, 5] * scale, now.rate[rows] / abs(scale)]
        )
        return weights * now.end[rows], weights[:, None] * slope

    def correct(self, z: Array, row: Array, value: float) -> Array:
        """Newton to the curve on the plane row . z = value. Raises DomainError when it does not converge."""
        for _ in range(9):
            miss, slope = self(z)
            error = np.append(miss, row @ z - value)
            z = z - np.linalg.solve(np.vstack([slope, row]), error)
            if np.abs(error).max() < 1e-11:
                return z
            if not np.isfinite(z).all() or np.abs(z).max() > 60:
                break
        raise DomainError("orbit_family: Newton's method does not converge")

    def tangent(self, z: Array, along: Array) -> Array:
        """Unit tangent of the curve at z, on the side of `along`."""
        null = np.linalg.svd(self(z)[1])[2][-1]
        return null if null @ along >= 0 else -null


def _first(scene: Scene) -> Array:
    """The linear orbit per unit of amplitude: U = r0, chi' = 2 r0 sqrt(sigma) Omega_0 (k-dependent for a short bar)."""
    inertia_a, inertia_b = scene.inertias
    assert scene.link is not None
    fold = min(scene.link.length / scene.rotor.length, 1.0)  # a short bar's chi: Delta = k chi
    return np.array([1.0, 2 * np.sqrt((inertia_a + inertia_b) / (inertia_a - inertia_b)) / fold, 0.0, 0.0])


def trace_family(
    scene: Scene, start: float = 0.05, step: float = 0.1, most: int = 200, largest: float = 0.99
) -> OrbitFamily:
    """Follow the family from r0 = `start` until it ends, r0 reaches `largest`, or `most` orbits are found.

    step: length of the first step along the curve; it grows to five times that, and is halved where Newton fails.
    The family is said to end where steps below 1e-5 fail: the period or the speed grows without bound, or the orbit
    meets a singular position.
    Raises InputError unless the spins are opposite.
    """
    shape_of(scene)
    still = replace(scene, shock=None, axes=((0.0, 0.0, 1.0),) * 2, rates=((0.0, 0.0, 0.0),) * 2)
    curve = _Curve(still)
    z = curve.correct(atanh(start) * _first(scene) + [0, 0, 0, pi / 2], np.array([1.0, 0, 0, 0]), atanh(start))
    along = curve.tangent(z, np.array([1.0, 0, 0, 0]))
    points, turns, reason, length = [z], [], f"{most} orbits found", step
    while len(points) < most:
        try:
            ahead = curve.correct(z + length * along, along, float(along @ z + length))
            turned = curve.tangent(ahead, along)
            if turned @ along < 0.9:
                raise DomainError("orbit_family: the step turned too far")
        except (DomainError, IntegrationError, np.linalg.LinAlgError, ValueError):
            length /= 2
            if length < 1e-5:
                reason = "no orbit beyond: steps along the curve fail"
                break
            continue
        if turned[0] * along[0] < 0:
            turns.append(float(np.tanh(max(z[0], ahead[0]))))
        z, along, length = ahead, turned, min(5 * step, 1.3 * length)
        points.append(z)
        if abs(np.tanh(z[0])) > largest:
            reason = f"r0 reached {largest:g}"
            break
    return _family(still, np.array(points), tuple(turns), reason)


def orbit_family(scene: Scene, amplitudes: NDArray[np.float64] | list[float]) -> OrbitFamily:
    """The orbits at the given increasing amplitudes r0 (n,), each found from the one before.

    Raises InputError unless the spins are opposite, DomainError when an amplitude is outside (0, 1), not above the one
    before, or past the first turn or the end of the family.
    """
    shape_of(scene)
    wanted = np.asarray(amplitudes, float)
    if wanted.ndim != 1 or not len(wanted) or wanted[0] <= 0 or wanted[-1] >= 1 or (np.diff(wanted) <= 0).any():
        raise DomainError("orbit_family: amplitudes must increase within (0, 1)")
    still = replace(scene, shock=None, axes=((0.0, 0.0, 1.0),) * 2, rates=((0.0, 0.0, 0.0),) * 2)
    curve, row = _Curve(still), np.array([1.0, 0, 0, 0])
    u = min(atanh(wanted[0]), 0.2)
    z = curve.correct(u * _first(scene) + [0, 0, 0, pi / 2], row, u)
    points, step = [], 0.3
    for r0 in wanted:
        goal = atanh(r0)
        while z[0] < goal - 1e-15:
            tangent = curve.tangent(z, row)
            if tangent[0] < 0.02 or step < 1e-5:
                raise DomainError(
                    f"orbit_family: r0 = {r0:g} is past {np.tanh(z[0]):.6g}, where the family turns or ends"
                )
            u = min(goal, z[0] + step)
            try:
                z = curve.correct(z + (u - z[0]) / tangent[0] * tangent, row, u)
                step = min(0.4, 1.5 * step)
            except (DomainError, IntegrationError, np.linalg.LinAlgError, ValueError):
                step /= 2
        points.append(curve.correct(z, row, goal))
    return _family(still, np.array(points), (), "all amplitudes found")


def _family(scene: Scene, points: Array, turns: tuple[float, ...], reason: str) -> OrbitFamily:
    return OrbitFamily(scene, np.tanh(points[:, 0]), pi / 2 * _natural(scene) / points[:, 3], points, turns, reason)
