"""The paired precession of opposite spins as the exact model has it: a periodic orbit found by shooting.

At Phi = 0 the axes are parallel in the x-z plane and turn through it (chi = alpha = 0, U' = 0, x = r_0); a quarter
period later the symmetries put U = alpha = 0, chi' = 0. Three conditions for chi'(0), alpha'(0) and the period.
"""

from dataclasses import dataclass, replace
from math import atanh, pi

import numpy as np

from lagrotor.errors import DomainError, IntegrationError
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import Array
from lagrotor.numerics.integrate import TIGHTEST, Problem, integrate
from lagrotor.pair.scene import Scene
from lagrotor.theory.paired_precession.series import shape_of


@dataclass(frozen=True)
class ExactOrbit:
    """A scene that starts on the orbit at Phi = 0, and the orbit's angular frequency (rad/s)."""

    scene: Scene
    frequency: float


def exact_orbit(scene: Scene, r0: float) -> ExactOrbit:
    """The orbit of amplitude r0 = sin(theta) when the axes are parallel, for the scene's rotor, bar and spins.

    Raises InputError unless the spins are opposite, DomainError when no orbit of that amplitude is found.
    """
    from scipy.optimize import root

    shape_of(scene)
    if not 0 < abs(r0) < 1:
        raise DomainError(f"exact_orbit: r0 = {r0:g} must lie between 0 and 1: it is the sine of an inclination")
    still = replace(scene, shock=None, axes=((0.0, 0.0, 1.0),) * 2, rates=((0.0, 0.0, 0.0),) * 2)
    a, b = scene.inertias
    G = scene.momenta[0]
    natural = G / np.sqrt(a * a - b * b)
    rate = MODEL.rate(still, False)

    def start(unknown: Array) -> Array:
        return np.array([atanh(r0), 0.0, 0.0, 0.0, unknown[0] * natural, unknown[1] * natural])

    def miss(unknown: Array) -> Array:
        quarter = unknown[2] / abs(natural)
        try:
            end = integrate(Problem(rate, start(unknown), 20_000), np.array([quarter]), TIGHTEST).states[0]
        except (IntegrationError, ValueError):
            return np.full(3, 1e3)
        return np.array([end[0], end[2], end[4] / natural])

    # The linear orbit: y = ± r0 sqrt(sigma) sin Phi, so alpha_2' − alpha_1' = 2 r0 sqrt(sigma).
    guess = np.array([2 * r0 * np.sqrt((a + b) / (a - b)), 0.0, pi / 2])
    found = root(miss, guess, tol=1e-14)
    if np.abs(miss(found.x)).max() > 1e-10:
        raise DomainError(
            f"exact_orbit: no periodic orbit found at r0 = {r0:g}: follow the family from a smaller amplitude"
        )
    seen = MODEL.observe(still, start(found.x)[None])
    axes, rates = (tuple(tuple(map(float, row)) for row in part[:, 0]) for part in (seen.axes, seen.rates))
    return ExactOrbit(replace(still, axes=axes, rates=rates), float(pi / 2 * natural / found.x[2]))  # type: ignore[arg-type]
