"""Stability of the paired precession: the Floquet multipliers of the exact periodic orbit.

Of the six multipliers four are 1. Two of them belong to the energy and the shift of time, two to the momentum and the rotation
about the joint line. The other two, mu and 1/mu, belong to the slow motion of the mean x and the mean twist; their sum is the
trace of the monodromy matrix minus four. The orbit is elliptic if |mu + 1/mu| < 2, hyperbolic if mu is real.

A quarter of a turn suffices. The matrix A = diag(1, −1, −1, −1, 1, 1) on (U, chi, alpha, rates) maps the motion to its own
reversal in time about Phi = 0, and B = diag(−1, 1, −1, 1, −1, 1) does so about Phi = pi/2. Let Q be the derivative of the state
after a quarter of a turn by the start. The derivative after half a turn, mapped back by A B, is A Q⁻¹ B Q, and the monodromy
matrix is the square of this matrix.
"""

from dataclasses import dataclass, replace
from math import acos, acosh, copysign, pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import DomainError
from lagrotor.models.minimal import MODEL, scenes_from_states
from lagrotor.models.orbits.shooting import FAILURES, ExactOrbit, exact_orbit
from lagrotor.models.orbits.variational import Array, close_arc, flow
from lagrotor.numerics.floquet_multipliers import multiplier_rows, resolved_multipliers
from lagrotor.pair.scene import Scene
from lagrotor.result_display import Shown, scientific
from lagrotor.theory.averaged_motion import slow_frequency

# Bound of the error of the trace relative to the monodromy matrix, checked in tests/theory/test_paired_stability.py.
_INTEGRATED = 1e-13
# Time reversal of the state about the start and about the end of a quarter turn.
_A, _B = np.array([[1.0, -1, -1, -1, 1, 1], [-1.0, 1, -1, 1, -1, 1]])[..., None]


@dataclass(frozen=True, eq=False, repr=False)
class Floquet(Shown):
    """The Floquet multipliers of an orbit.

    - `multipliers`: four ones, mu and 1/mu, complex (6,). A multiplier smaller than its error is NaN.
    - `pair_sum`: the sum mu + 1/mu, and `error` a bound of its error.
    - `kind`: "elliptic", "hyperbolic", or "unresolved" if the error of the sum does not decide it.
    - `growth`: log |mu| per turn on a hyperbolic orbit, otherwise 0.
    - `turning`: the angle of mu per turn (rad) on an elliptic orbit, otherwise 0.
    - `frequency`: the frequency of the orbit, rad/s.
    - `monodromy`: the monodromy matrix (6, 6) in (U, chi, alpha, rates).
    - `errors`: bounds of the errors of the multipliers, (6,).
    """

    multipliers: NDArray[np.complex128]
    pair_sum: float
    kind: Literal["elliptic", "hyperbolic", "unresolved"]
    growth: float
    turning: float
    frequency: float
    error: float
    monodromy: Array
    errors: Array

    def summary(self) -> dict[str, str]:
        """Return kind, multipliers and exponents in words."""
        pair = multiplier_rows(self.multipliers[4:], self.errors[4:]).values()
        per_turn = f"growth {self.growth:.6g}" if self.kind == "hyperbolic" else f"angle {self.turning:.6g} rad"
        return {
            "kind": self.kind,
            "multipliers besides 1": "; ".join(pair),
            "μ + 1/μ": f"{self.pair_sum:.12g}, known to {scientific(self.error)}",
            "per turn": f"{per_turn}, known to {scientific(self.exponent_error)}",
            "frequency [rad/s]": f"{self.frequency:.12g}",
        }

    @property
    def slow_frequency(self) -> complex:
        """The frequency of the slow motion about the orbit (rad/s), imaginary if the motion grows: see `exponent_error`."""
        angle = self.turning or pi * (self.pair_sum < -2)
        return abs(self.frequency) / (2 * pi) * complex(angle, self.growth)

    @property
    def exponent_error(self) -> float:
        """A bound of the error of growth and turning per turn, which follows from the bound for mu + 1/mu."""
        apart = sqrt(abs(self.pair_sum**2 - 4))
        root = sqrt(2 * self.error)
        return root if self.kind == "unresolved" or apart <= root else min(2 * self.error / apart, root)


def floquet(scene: Scene, r0: float, momentum: float = 0.0) -> Floquet:
    """Compute the Floquet multipliers of the paired precession, by the variational equations, with their errors.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.
    r0 : float
        The sine of the inclination when the axes are parallel.
    momentum : float, default 0.0
        Additional momentum about the joint line, kg m²/s. The orbit then closes only after a rotation.

    Returns
    -------
    Floquet
        The multipliers, the kind of stability, and the slow frequency.

    Raises
    ------
    InputError
        Unless the spins are opposite and there is a bar.
    DomainError
        If no orbit is found.

    Examples
    --------
    >>> from lagrotor import Scene
    >>> orbit = floquet(Scene(spins=(10, -10)), r0=0.204)
    >>> orbit.kind, round(orbit.growth, 6)
    ('hyperbolic', 0.005559)
    """
    orbit = exact_orbit(scene, r0)
    return floquet_of(_pushed(orbit, momentum) if momentum else orbit)


def slow_frequency_error(scene: Scene, r0: float, momentum: float = 0.0) -> float:
    """Return the distance in the complex plane between `slow_frequency` and the slow frequency of the exact orbit.

    Parameters
    ----------
    scene : Scene
        The pair, with opposite spins and a bar.
    r0 : float
        The sine of the inclination when the axes are parallel.
    momentum : float, default 0.0
        Additional momentum about the joint line, kg m²/s.

    Returns
    -------
    float
        The distance plus the error of the exact orbit, rad/s.
    """
    law, orbit = slow_frequency(scene, r0, momentum), floquet(scene, r0, momentum)
    return abs(law - orbit.slow_frequency) + orbit.exponent_error * abs(orbit.frequency) / (2 * pi)


def _pushed(orbit: ExactOrbit, momentum: float) -> ExactOrbit:
    """Return the orbit of the same amplitude with an additional momentum P = 2 (a + b) (1 − x²) alpha' at the start."""
    scene, start = orbit.scene, MODEL.start(orbit.scene)
    inertia = 2 * sum(scene.inertias) * (1 - scene.axes[0][0] ** 2)
    start = start + np.array([0, 0, 0, 0, 0, momentum / inertia])
    turn = 2 * pi / abs(orbit.frequency)
    try:
        start, time = close_arc(flow(scene), start, [4], turn / 4, [0, 4], np.zeros(2), turn / 2)
    except FAILURES:  # an arc of Newton's method reached a singular position
        time = 0.0
    if time:
        (begun,) = scenes_from_states(scene, [start])
        return replace(orbit, scene=begun, frequency=copysign(pi / 2 / time, orbit.frequency))
    raise DomainError(f"floquet: no orbit with a momentum of {momentum:g} kg m²/s is found; take a smaller one")


def floquet_of(orbit: ExactOrbit) -> Floquet:
    """Compute the Floquet multipliers of an exact orbit, with the kind of stability and their errors."""
    quarter = flow(orbit.scene)(MODEL.start(orbit.scene), pi / 2 / abs(orbit.frequency)).slope
    half = _A * np.linalg.solve(quarter, _B * quarter)
    slope = half @ half
    total = float(np.trace(slope)) - 4
    excess, error = total - 2, _error(slope, total)
    growth = turning = 0.0
    if abs(excess) < error:
        kind: Literal["elliptic", "hyperbolic", "unresolved"] = "unresolved"
    elif abs(total) > 2:
        kind, growth = "hyperbolic", acosh(abs(total) / 2)
    else:
        kind, turning = "elliptic", acos(total / 2)
    mu = (total + np.sqrt(complex(total * total - 4))) / 2
    multipliers = np.array([1, 1, 1, 1, mu, 1 / mu], dtype=complex)
    result = Floquet(multipliers, total, kind, growth, turning, orbit.frequency, error, slope, np.zeros(6))
    bounds = np.append(np.zeros(4), np.abs(multipliers[4:]) * result.exponent_error)
    values, errors = resolved_multipliers(multipliers, bounds)
    return replace(result, multipliers=values, errors=errors)


def _error(monodromy: Array, total: float) -> float:
    """Return a bound of the error of mu + 1/mu by integration and rounding. The sum of the products of pairs of multipliers is
    4 (mu + 1/mu) + 7. Its deviation measures the rounding."""
    pairs = (np.trace(monodromy) ** 2 - np.trace(monodromy @ monodromy)) / 2
    return float(_INTEGRATED * max(1.0, float(np.linalg.norm(monodromy))) + abs(pairs - 4 * total - 7))
