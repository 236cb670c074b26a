"""Rung 1: motions known in closed form, at any time at once.

- A pair at rest without shock does not move, as there is no gravity.
- A free rotor turns about its angular momentum L = J r × r' + G r at the rate |L|/J, exactly.
- Equal spins with parallel axes are one such rotor of inertia a + b, exactly.
- Opposite spins on their paired precession follow its periodic series, of the order that the tolerance requires.
"""

from math import pi

import numpy as np

from lagrotor.errors import DomainError
from lagrotor.models.model import Array, ClosedMotion
from lagrotor.models.orbits.paired_fit import ROUND, paired_answer
from lagrotor.pair.scene import Scene

_FARTHEST_APART = 1e-14  # distance of parallel axes, by rounding
_FARTHEST_OUT = 0.995  # the largest |x| of parallel axes
_MAY_PART = 1e-9  # the error by growth of rounding


def closed_form(scene: Scene, t_end: float, tol: float, best: bool = False) -> ClosedMotion:
    """Return the closed form of a scene up to t_end (s).

    `tol` chooses the order of a series, at most 15; the error of the result may be larger. With `best` the series goes
    through r0^21. Raises DomainError if no closed form represents the scene.
    """
    if scene.shock_until(t_end):
        raise DomainError("closed_form: no closed form goes through a shock; use model='linear' or 'minimal'")
    axes, rates = np.array(scene.axes), np.array(scene.rates)
    if not rates.any():
        return ClosedMotion(0.0, "at rest without shock: nothing moves", lambda t: (_still(axes, t), _still(rates, t)))
    if scene.link is None:
        reason = "no bar: each rotor turns about its own angular momentum, exactly"
        return _tops(axes, rates, scene.rotor.J, scene.momenta, t_end, reason)
    if scene.spins[0] == scene.spins[1]:
        return _parallel(scene, axes, rates, t_end)
    if scene.spins[0] == -scene.spins[1]:
        return paired_answer(scene, axes, rates, t_end, tol, best)
    raise DomainError(
        f"closed_form: none is known for a bar and spins {scene.spins[0]:g}, {scene.spins[1]:g} rad/s: they must be equal "
        "or opposite; use model='linear' or 'minimal'"
    )


def _still(value: Array, t: Array) -> Array:
    return np.repeat(value[:, None, :], len(t), axis=1)


def _tops(
    axes: Array, rates: Array, inertia: float, momenta: tuple[float, float], t_end: float, reason: str
) -> ClosedMotion:
    """Return the motion of two free tops, whose axes r turn about L = inertia r × r' + G r at the rate |L|/inertia."""
    turns = (inertia * np.cross(axes, rates) + np.array(momenta)[:, None] * axes) / inertia
    speeds = np.linalg.norm(turns, axis=1)
    poles = turns / np.where(speeds > 0, speeds, 1.0)[:, None]
    axial = (poles * axes).sum(axis=1, keepdims=True) * poles
    out, transverse = axes - axial, np.cross(poles, axes)

    def motion(t: Array) -> tuple[Array, Array]:
        phase = (speeds[:, None] * t)[..., None]
        c, s = np.cos(phase), np.sin(phase)
        positions = axial[:, None] + c * out[:, None] + s * transverse[:, None]
        return positions, np.cross(turns[:, None], positions)

    fastest = float(speeds.max()) * t_end
    residual = float(np.abs((axes**2).sum(1) - 1).max() + np.abs((axes * rates).sum(1)).max() / (speeds.max() or 1.0))
    return ClosedMotion((residual + ROUND) * (1 + fastest), reason, motion)


def _parallel(scene: Scene, axes: Array, rates: Array, t_end: float) -> ClosedMotion:
    """Return the motion of equal spins with parallel axes, which turn as one rotor of inertia a + b. Axes that are not exactly
    parallel may twist apart, which adds to the error. Raises DomainError if they are not parallel."""
    inertia, shared = scene.inertias
    mean, mean_rate = axes.mean(axis=0), rates.mean(axis=0)
    turn = float(np.linalg.norm(np.cross(mean, mean_rate) + scene.momenta[0] / (inertia + shared) * mean))
    apart = float(np.linalg.norm(axes[1] - axes[0]) + np.linalg.norm(rates[1] - rates[0]) / (turn or 1.0))
    if not apart <= _FARTHEST_APART:
        raise DomainError(
            f"closed_form: equal spins are one rotor only with parallel axes that turn alike, not {apart:.2g} apart; "
            "use model='linear' or 'minimal'"
        )
    top = _tops(
        np.tile(mean, (2, 1)), np.tile(mean_rate, (2, 1)), inertia + shared, scene.momenta, t_end,
        "equal spins, parallel axes: one rotor of both inertias, exactly",
    )  # fmt: skip
    phases = np.linspace(0, 2 * pi, 65)
    (positions, _), _ = top.motion(phases / turn)
    if float(np.abs(positions[:, 0]).max()) > _FARTHEST_OUT:
        raise DomainError(
            "closed_form: the parallel pair comes near the joint line, where bar and axes are in line and it may part; use "
            "model='minimal' or 'spheres'"
        )
    return ClosedMotion(top.error + (_MAY_PART if apart else 0.0), top.reason, top.motion)
