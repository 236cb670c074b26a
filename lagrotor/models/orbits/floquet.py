"""Stability of the paired precession: the Floquet multipliers of the exact periodic orbit.

Of the six multipliers four are 1: the energy with the shift of time, the momentum with the turning about the joint
line. The other two, mu and 1/mu, belong to the slow motion of the mean x and the mean twist; their sum is the trace of
the monodromy less four. The orbit is elliptic where |mu + 1/mu| < 2, hyperbolic where mu is real.

A quarter of a turn gives all of it. At Phi = 0 the motion is its own image with time reversed under A = diag(1, −1, −1,
−1, 1, 1), at Phi = pi/2 under B = diag(−1, 1, −1, 1, −1, 1), in (U, chi, alpha, rates). With Q the quarter's derivative by
the start, that of half a turn, brought back by A B, is A Q⁻¹ B Q, and the monodromy is its square.
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
from lagrotor.result_display import Shown
from lagrotor.theory.averaged_motion import slow_frequency

# Bound of the trace's error, relative to the size of the monodromy; held by tests/theory/test_paired_stability.py.
_INTEGRATED = 1e-13
# What reversed time does to the state, about the start and about the end of a quarter of a turn.
_A, _B = np.array([[1.0, -1, -1, -1, 1, 1], [-1.0, 1, -1, 1, -1, 1]])[..., None]


@dataclass(frozen=True, eq=False, repr=False)
class Floquet(Shown):
    """multipliers (6,), complex: four ones, mu, 1/mu, NaN where one is smaller than its error; errors (6,): bounds of their
    errors, zero of the ones. pair_sum: mu + 1/mu. monodromy (6, 6) in (U, chi, alpha, rates).

    growth: log |mu| per turn (0 on an elliptic orbit); turning: angle of mu per turn (rad) on an elliptic orbit.
    frequency: of the orbit (rad/s). error: bound of the error of pair_sum, within which the kind is "unresolved";
    exponent_error: of growth and turning (rad a turn).
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
        """Kind, multipliers and exponents, name → words."""
        pair = multiplier_rows(self.multipliers[4:], self.errors[4:]).values()
        per_turn = f"growth {self.growth:.6g}" if self.kind == "hyperbolic" else f"angle {self.turning:.6g} rad"
        return {
            "kind": self.kind,
            "multipliers besides 1": "; ".join(pair),
            "μ + 1/μ": f"{self.pair_sum:.12g}, known to {self.error:.1g}",
            "per turn": f"{per_turn}, known to {self.exponent_error:.1g}",
            "frequency [rad/s]": f"{self.frequency:.12g}",
        }

    @property
    def slow_frequency(self) -> complex:
        """Of the motion beside the orbit (rad/s), imaginary where it grows; real up to half the orbit's, known to
        exponent_error · |frequency| / 2 pi."""
        angle = self.turning or pi * (self.pair_sum < -2)
        return abs(self.frequency) / (2 * pi) * complex(angle, self.growth)

    @property
    def exponent_error(self) -> float:
        """Bound of the error of growth and turning, rad a turn: d log mu = d(mu + 1/mu) / |mu − 1/mu|, or the root of twice the
        sum's where the kind is unresolved and both are given as zero."""
        apart = sqrt(abs(self.pair_sum**2 - 4))
        root = sqrt(2 * self.error)
        return root if self.kind == "unresolved" or apart <= root else min(2 * self.error / apart, root)


def floquet(scene: Scene, r0: float, momentum: float = 0.0) -> Floquet:
    """Floquet multipliers of the paired precession of amplitude r0, through the variational equations, with their error.

    Parameters
    ----------
    scene : Scene
        With opposite spins and a bar.
    momentum : float, default 0.0
        About the joint line beyond the orbit's own (kg m²/s), a push: the orbit then closes up to a turn about that
        line.

    Raises
    ------
    InputError
        Unless the spins are opposite and there is a bar.
    DomainError
        When no orbit is found.
    """
    orbit = exact_orbit(scene, r0)
    return floquet_of(_pushed(orbit, momentum) if momentum else orbit)


def slow_frequency_error(scene: Scene, r0: float, momentum: float = 0.0) -> float:
    """How far (rad/s, in the complex plane) `slow_frequency` is from the exact orbit's, whose error is added.

    Parameters
    ----------
    scene : Scene
        As in `slow_frequency`.
    r0 : float
        Sine of the inclination at the moments when the axes are parallel, with the push.
    momentum : float, default 0.0
        About the joint line beyond that of the exact paired precession of this r0 (kg m²/s).

    Raises
    ------
    InputError
        As `slow_frequency`.
    DomainError
        Likewise, and where no orbit is found.
    """
    law, orbit = slow_frequency(scene, r0, momentum), floquet(scene, r0, momentum)
    return abs(law - orbit.slow_frequency) + orbit.exponent_error * abs(orbit.frequency) / (2 * pi)


def _pushed(orbit: ExactOrbit, momentum: float) -> ExactOrbit:
    """The orbit of the same amplitude with more momentum about the joint line: chi' at the start and the quarter's time,
    by Newton's method, for U = chi' = 0 at its end. At the start P = 2 (a + b) (1 − x²) alpha'."""
    scene, start = orbit.scene, MODEL.start(orbit.scene)
    inertia = 2 * sum(scene.inertias) * (1 - scene.axes[0][0] ** 2)
    start = start + np.array([0, 0, 0, 0, 0, momentum / inertia])
    turn = 2 * pi / abs(orbit.frequency)
    try:
        start, time = close_arc(flow(scene), start, [4], turn / 4, [0, 4], np.zeros(2), turn / 2)
    except FAILURES:  # an arc of Newton's method ends where bar and axes come into line
        time = 0.0
    if time:
        (begun,) = scenes_from_states(scene, [start])
        return replace(orbit, scene=begun, frequency=copysign(pi / 2 / time, orbit.frequency))
    raise DomainError(f"floquet: no orbit with a momentum of {momentum:g} kg m²/s is found; take a smaller one")


def floquet_of(orbit: ExactOrbit) -> Floquet:
    """The multipliers of an orbit already found."""
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
    """From integration, and from how far the sum of the multipliers' products by pairs is off 4 (mu + 1/mu) + 7.

    The second part is what rounding leaves of a monodromy whose parts are far larger than its trace shows.
    """
    pairs = (np.trace(monodromy) ** 2 - np.trace(monodromy @ monodromy)) / 2
    return float(_INTEGRATED * max(1.0, float(np.linalg.norm(monodromy))) + abs(pairs - 4 * total - 7))
