"""Orbits about upright of two unequal spins, exactly: x swings between ±r0, and the orbit closes up to a turn.

At Phi = 0 and half a turn later the axes are parallel (chi = 0) and U is stationary at ±artanh r0. Unknown are chi', alpha' at
the start and the time of half a turn; Newton's method takes the exact Jacobian of the flow.
"""

from dataclasses import dataclass, replace
from math import atanh, pi

import numpy as np

from lagrotor.errors import DomainError, InputError
from lagrotor.models.minimal import scene_at
from lagrotor.models.orbits.variational import close_arc, flow
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series_orbit import amplitude_of


@dataclass(frozen=True)
class UprightOrbit:
    """A scene that starts on the orbit at Phi = 0, its frequency (rad/s), and the mean rate alpha' of turning about the joint
    line (rad/s)."""

    scene: Scene
    frequency: float
    turning: float


def upright_orbit(scene: Scene, r0: float) -> UprightOrbit:
    """The orbit of amplitude r0 = sin(inclination) where the axes are parallel, of the scene's rotor, bar and spins.

    Raises:
        InputError: without a bar, without spin, and for opposite spins, whose orbit is `exact_orbit`.
        DomainError: unless 0 < |r0| < 1, and where Newton's method, begun at the linear motion, finds none.
    """
    amplitude, (first, second) = amplitude_of(r0, "upright_orbit"), scene.momenta
    if scene.link is None or first + second == 0:
        raise InputError(
            f"upright_orbit: needs a bar and spins that are not opposite, not {scene.spins}; see exact_orbit"
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
        turned = float(through(start, time).end[2])
        return UprightOrbit(scene_at(replace(scene, shock=None), start), pi / time, turned / time)
    raise DomainError(f"upright_orbit: no orbit of amplitude {r0:g} is found; take a smaller one")
