"""Runs on the precession of a given amplitude, for the claims on the ansatz, its correction and the rate."""

from functools import cache

import numpy as np

from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.pair.examples import LIGHT
from lagrotor.pair.initial_conditions import consistent_scene
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.trajectory import Trajectory

OPPOSITE, EQUAL = (10.0, -10.0), (10.0, 10.0)
MASSLESS, PAPER_BAR = Link(), LIGHT  # the bar of the theory, and that of the listing in 5.2.1
PAPER_R0 = 0.204  # the amplitude of figure 21
AMPLITUDES = (0.051, 0.102, PAPER_R0)


@cache
def precession_scene(spins: Spins, r0: float, bar: Link) -> tuple[Scene, float]:
    """The scene on its precession of amplitude r0, and its rate (rad/s): of opposite spins the exact orbit.

    Of any other spins both axes start at x = r0 and go round the vertical, each in the sense of its own spin, at
    G/((a + b) cos θ): the motion of equal spins with parallel axes.
    """
    scene = Scene(spins, link=bar)
    if spins[0] == -spins[1] != 0:
        orbit = exact_orbit(scene, r0)
        return orbit.scene, orbit.frequency
    upright = (1 - r0**2) ** 0.5
    rate = abs(scene.momenta[0]) / (sum(scene.inertias) * upright)
    start = [(0, np.sign(spin) * rate * r0, 0) for spin in spins]
    return consistent_scene(spins, ((r0, 0, upright),) * 2, start, link=bar), rate


@cache
def once_round(spins: Spins, r0: float, bar: Link) -> Trajectory:
    """One turn of that precession, at 361 times."""
    scene, rate = precession_scene(spins, r0, bar)
    return simulate(scene, np.linspace(0, 2 * np.pi / rate, 361), "minimal", 1e-11)
