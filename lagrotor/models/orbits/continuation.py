"""The paired precession from small amplitudes to the end of its family, by continuation along the curve of orbits.

Steps run along the curve, not along r0, so that a turn of the family is passed and not mistaken for its end.
"""

from dataclasses import dataclass
from math import atanh, pi

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import DomainError
from lagrotor.models.orbits.shooting import FAILURES, ExactOrbit, QuarterPeriod
from lagrotor.pair.scene import Scene
from lagrotor.shown import Shown

Array = NDArray[np.float64]
_START, _LARGEST = 0.05, 0.99  # amplitudes
_STEP, _MOST = 0.1, 200  # the first step along the curve; orbits


@dataclass(frozen=True, eq=False, repr=False)
class OrbitFamily(Shown):
    """Orbits along the family: amplitudes r0 (n,), frequencies (rad/s) (n,), unknowns (n, 4), and why it stopped.

    `turns`: amplitudes at which the family turns back in r0 (largest r0 of the two branches that meet there).
    """

    curve: QuarterPeriod
    amplitudes: Array
    frequencies: Array
    unknowns: Array
    turns: tuple[float, ...]
    reason: str

    def summary(self) -> dict[str, str]:
        """How many orbits, from where to where, name → words."""
        return {
            "orbits": str(len(self.amplitudes)),
            "amplitudes": f"{self.amplitudes.min():.6g} to {self.amplitudes.max():.6g}",
            "frequencies [rad/s]": f"{self.frequencies.min():.6g} to {self.frequencies.max():.6g}",
            "turns back at": ", ".join(f"{turn:.6g}" for turn in self.turns) or "nowhere",
            "ended": self.reason,
        }

    def orbit(self, index: int) -> ExactOrbit:
        """The orbit number `index`, as a scene that starts on it, with its error."""
        return self.curve.orbit(self.unknowns[index])

    @property
    def frequency_errors(self) -> Array:
        """Bounds of the frequencies' errors (rad/s), (n,)."""
        return np.array([self.orbit(i).frequency_error for i in range(len(self.amplitudes))])


def trace_family(scene: Scene) -> OrbitFamily:
    """Follow the family from r0 = 0.05 until it ends, r0 reaches 0.99, or 200 orbits are found.

    Steps along the curve grow from 0.1 to five times that, and are halved where Newton's method fails.
    The family is said to end where steps below 1e-5 fail: the period or the speed grows without bound, or the orbit
    reaches a singular position.

    Raises:
        InputError: unless the spins are opposite.
    """
    curve = QuarterPeriod(scene)
    z = curve.correct(curve.linear(atanh(_START)), np.array([1.0, 0, 0, 0]), atanh(_START))
    along = curve.tangent(z, np.array([1.0, 0, 0, 0]))
    points, turns, reason, length = [z], [], f"{_MOST} orbits found", _STEP
    while len(points) < _MOST:
        try:
            ahead = curve.correct(z + length * along, along, float(along @ z + length))
            turned = curve.tangent(ahead, along)
            if turned @ along < 0.9:
                raise DomainError("orbit_family: the step turned too far")
        except FAILURES:
            length /= 2
            if length < 1e-5:
                reason = "no orbit beyond: steps along the curve fail"
                break
            continue
        if turned[0] * along[0] < 0:
            turns.append(float(np.tanh(max(z[0], ahead[0]))))
        z, along, length = ahead, turned, min(5 * _STEP, 1.3 * length)
        points.append(z)
        if abs(np.tanh(z[0])) > _LARGEST:
            reason = f"r0 reached {_LARGEST:g}"
            break
    return _family(curve, np.array(points), tuple(turns), reason)


def orbit_family(scene: Scene, amplitudes: NDArray[np.float64] | list[float]) -> OrbitFamily:
    """The orbits at the given increasing amplitudes r0 (n,), each found from the one before.

    Raises:
        InputError: unless the spins are opposite.
        DomainError: when an amplitude is outside (0, 1), not above the one before, or past the first turn or the end of the
            family.
    """
    curve = QuarterPeriod(scene)
    wanted = np.asarray(amplitudes, float)
    if wanted.ndim != 1 or not len(wanted) or wanted[0] <= 0 or wanted[-1] >= 1 or (np.diff(wanted) <= 0).any():
        raise DomainError("orbit_family: amplitudes must increase within (0, 1)")
    points: list[Array] = []
    for r0 in wanted:
        points.append(curve.follow(points[-1] if points else None, float(r0)))
    return _family(curve, np.array(points), (), "all amplitudes found")


def _family(curve: QuarterPeriod, points: Array, turns: tuple[float, ...], reason: str) -> OrbitFamily:
    return OrbitFamily(curve, np.tanh(points[:, 0]), pi / 2 * curve.natural / points[:, 3], points, turns, reason)
