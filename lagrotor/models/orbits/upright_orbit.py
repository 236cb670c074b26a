"""Orbits about upright of two unequal spins, exactly: x swings between ±r0, and the orbit closes up to a turn.

At Phi = 0 and half a turn later the axes are parallel (chi = 0) and U is stationary at ±artanh r0. Unknown are chi', alpha' at
the start and the time of half a turn; Newton's method takes the exact Jacobian of the flow.
"""

from dataclasses import dataclass, replace
from math import atanh, pi

import numpy as np

from lagrotor.errors import DomainError, InputError
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.variational import flow
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series_orbit import amplitude_of

_LAST_STEP = 1e-8  # of Newton's method, relative: the next is its square


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
    inertia, through, u = 2 * sum(scene.inertias), flow(scene), atanh(amplitude)
    # Delta' of the normal mode; Delta = k chi for a bar shorter than the axes.
    guess = 2 * scene.sigma * (first - second) * amplitude / inertia / min(scene.k, 1.0)
    unknowns = np.array([guess, -(first + second) * amplitude / inertia, pi / natural_rate(scene)])
    for _ in range(12):
        now = through(np.array([u, 0, 0, 0, *unknowns[:2]]), unknowns[2])
        slope = np.column_stack([now.slope[[0, 1, 3]][:, [4, 5]], now.rate[[0, 1, 3]]])
        step = -np.linalg.solve(slope, now.end[[0, 1, 3]] + np.array([u, 0, 0]))
        unknowns = unknowns + step
        if not (np.isfinite(unknowns).all() and 0 < unknowns[2] < 20 * pi / natural_rate(scene)):
            break
        if np.abs(step).max() < _LAST_STEP * max(1.0, np.abs(unknowns).max()):
            start = np.array([u, 0, 0, 0, *unknowns[:2]])
            turned, seen = float(through(start, unknowns[2]).end[2]), MODEL.observe(scene, start[None])
            axes, rates = (tuple(tuple(map(float, row)) for row in part[:, 0]) for part in (seen.axes, seen.rates))
            begun = replace(scene, shock=None, axes=axes, rates=rates)  # type: ignore[arg-type]
            return UprightOrbit(begun, pi / float(unknowns[2]), turned / float(unknowns[2]))
    raise DomainError(f"upright_orbit: no orbit of amplitude {r0:g} is found; take a smaller one")
