"""Rung 4: two unit vectors with multipliers, twelve states. The model is exact with every bar and without one.

Its coordinates are regular everywhere. Only the constraints can fail: at r_1 = r_2 = ± e_x, the dead point, bar and axes are in
line and the constraints dependent. A run that comes within CLEARANCE of this position stops.
"""

from __future__ import annotations

from math import hypot, inf
from typing import TYPE_CHECKING

import numpy as np

from lagrotor.errors import SingularError
from lagrotor.models.model import Array, Model, Observed, constant_momenta
from lagrotor.numerics.segment import Projection
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program

CLEARANCE = 1e-5  # rad; below it the multipliers have fewer than six digits
_TOWARDS = 0.4  # cos 1.16
_NEAR = 1e-3  # rad from the dead point, where a stop counts as reaching it
# Massive bar, bar, shocked rotor (0: none).
_Kind = tuple[bool, bool, int]
_KINDS: tuple[_Kind, ...] = tuple(
    (*bars, body) for bars in ((False, False), (False, True), (True, True)) for body in (0, 1, 2)
)


def program(massive: bool, bar: bool, body: int) -> Program:
    from lagrotor.models.programs import spheres_program

    return spheres_program.program(massive, bar, body)


@generated((*kind, False) for kind in _KINDS)
def _rhs(massive: bool, bar: bool, body: int, bounded: bool) -> str:
    from lagrotor.numerics.printers import rhs_source

    return rhs_source(program(massive, bar, body), 12, body > 0, bounded)


@generated(kind[:2] for kind in _KINDS if kind[2] == 0)
def _projected(massive: bool, bar: bool) -> str:
    from lagrotor.models.programs.spheres_program import projection
    from lagrotor.numerics.printers import program_source

    return program_source(projection(massive, bar), "numpy")


def _kind(scene: Scene, driven: bool) -> tuple[_Kind, tuple[float, ...]]:
    """Return the kind of program of the scene, and the values of its parameters except the force of the shock."""
    inertia_a, inertia_b = scene.inertias
    bar, massive = scene.link is not None, inertia_b != 0
    body = scene.shock.body if driven and scene.shock else 0
    ratio = (scene.link.length / scene.rotor.length,) if scene.link else ()
    return (massive, bar, body), (inertia_a, *((inertia_b,) if massive else ()), *ratio, *scene.momenta)


def _at_dead_point(y: Array) -> bool:
    """Return True if a state (12,) is within CLEARANCE of r_1 = r_2 = ± e_x, where the constraints are dependent."""
    return bool(y[0] * y[3] > 0.9 and _across(y) < CLEARANCE)


def _time_to_dead_point(y: Array) -> float:
    """Return twice a lower bound of the time from a state (12,) to the dead point r_1 = r_2 = ± e_x; inf if it moves away.

    The components of the axes transverse to the joint line move on a cone with its apex at this position. No force
    distinguishes a straight motion through it from a motion around it, and a step over it would pass undetected. For an axis at
    the angle θ from the line with the rate θ', the result is tan θ/θ' while the remaining time is θ/θ'. Half of the result is a
    lower bound up to θ = 1.16.
    """
    if not (min(y[0], y[3]) > _TOWARDS or max(y[0], y[3]) < -_TOWARDS):
        return inf
    transverse, speed = y[[1, 2, 4, 5]], y[[7, 8, 10, 11]]
    return _across(y) / float(np.linalg.norm(speed)) if transverse @ speed < 0 else inf


def slack(states: Array) -> Array:
    """Return the uncertainty (n,) of states (n, 12) that follows from the constraints, in units of the rounding error.

    The gradient of the bar's constraint differs from a combination of the two other gradients only by the transverse components
    of the axes. A projection divides the rounding errors of the constraints by these components.
    """
    transverse = np.linalg.norm(states[:, [1, 2, 4, 5]], axis=1)
    return np.where(states[:, 0] * states[:, 3] > 0.9, 1 / np.clip(transverse, np.finfo(float).tiny, 1.0), 1.0)


def _across(y: Array) -> float:
    return hypot(y[1], y[2], y[4], y[5])


def _projection(scene: Scene) -> Projection:
    inertia_a, inertia_b = scene.inertias
    massive = inertia_b != 0
    ratio = (scene.link.length / scene.rotor.length,) if scene.link else ()
    function = _projected(massive, scene.link is not None)
    parameters = (inertia_a, *((inertia_b,) if massive else ()), *ratio)
    return lambda y: np.array(function(*y, *parameters))


def _start(scene: Scene) -> Array:
    start = np.array([*scene.axes[0], *scene.axes[1], *scene.rates[0], *scene.rates[1]])
    if scene.link and _at_dead_point(start):
        raise SingularError(
            f"spheres: the axes {scene.axes} start {_across(start):.1e} rad from the position where bar and axes are in line and "
            f"the motion is not determined, nearer than {CLEARANCE:g}: tilt an axis"
        )
    return start


def _observe(scene: Scene, states: Array) -> Observed:
    blocks = states.reshape(-1, 2, 2, 3).transpose(1, 2, 0, 3)
    return Observed(blocks[0], blocks[1], constant_momenta(scene, len(states)))


def _singular(axes: Array) -> str:
    near = axes[0, 0] * axes[1, 0] > 0.9 and _across(axes.ravel()) < _NEAR
    return "bar and axes come into line, where the motion is not determined" if near else ""


MODEL = Model(
    "spheres", 12, _kind, program, _rhs, _start, _observe, _singular, _projection,
    outside=_at_dead_point, time_to_singular=_time_to_dead_point, slack=slack,
)  # fmt: skip
