"""Rung 5: the paper's own coordinates, two sets of Euler angles with a multiplier for the bar. Twelve states.

Exact for any bar, but singular at theta = 0, the equilibrium: a model for comparison.
"""

from __future__ import annotations

from itertools import product
from math import acos, atan2, cos, hypot
from typing import TYPE_CHECKING

import numpy as np

from lagrotor.errors import SingularError
from lagrotor.models.model import Array, Model, Observed
from lagrotor.numerics.segment import Projection
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.numerics.codegen import Program

_LEAST_INCLINATION = 1e-3  # rad; the rate of the azimuth grows as 1/theta below it
Kind = tuple[bool, int]  # massive bar, shocked rotor (0: none)


def program(massive: bool, body: int) -> Program:
    from lagrotor.models.programs import euler_program

    return euler_program.program(massive, body)


@generated((*kind, False) for kind in product((False, True), (0, 1, 2)))
def _rhs(massive: bool, body: int, bounded: bool) -> str:
    from lagrotor.numerics.printers import rhs_source

    return rhs_source(program(massive, body), 12, body > 0, bounded)


@generated(((False,), (True,)))
def _projected(massive: bool) -> str:
    from lagrotor.models.programs.euler_program import projection
    from lagrotor.numerics.printers import program_source

    return program_source(projection(massive), "numpy")


@generated(((),))
def _axes() -> str:
    from lagrotor.models.programs.euler_program import observation
    from lagrotor.numerics.printers import program_source

    return program_source(observation(), "numpy")


def _kind(scene: Scene, driven: bool) -> tuple[Kind, tuple[float, ...]]:
    """Return which generated program runs the scene, and the values of its parameters without the force of the shock."""
    inertia_a, inertia_b = scene.inertias
    massive = inertia_b != 0
    body = scene.shock.body if driven and scene.shock else 0
    ratio = scene.link.length / scene.rotor.length if scene.link else 1.0
    return (massive, body), (inertia_a, *((inertia_b,) if massive else ()), ratio, scene.rotor.I3)


def _projection(scene: Scene) -> Projection:
    _, values = _kind(scene, False)
    function = _projected(scene.inertias[1] != 0)
    return lambda y: np.array(function(*y, *values))


def _start(scene: Scene) -> Array:
    if scene.link is None:
        raise SingularError("euler: the scene has no bar; use model='spheres'")
    q, rates = [], []
    for i, (r, v, spin) in enumerate(zip(scene.axes, scene.rates, scene.spins, strict=True)):
        radius = hypot(r[0], r[1])
        if radius < _LEAST_INCLINATION:
            raise SingularError(
                f"euler: theta_{i + 1} = {radius:.3g} rad: Euler angles are singular at theta = 0, the rest state; "
                "use model='minimal' or 'spheres'"
            )
        theta, phi = acos(r[2] / hypot(*r)), atan2(r[1], r[0])
        phi_v = (r[0] * v[1] - r[1] * v[0]) / radius**2
        theta_v = ((r[0] * v[0] + r[1] * v[1]) * r[2] / radius) - v[2] * radius
        q += [theta, phi, 0.0]
        rates += [theta_v, phi_v, spin - phi_v * cos(theta)]
    return np.array(q + rates)


def _observe(scene: Scene, states: Array) -> Observed:
    columns = _axes()(*states.T)
    blocks = np.stack(columns).reshape(2, 2, 3, -1).transpose(0, 1, 3, 2)
    theta, phi_v, psi_v = states[:, [0, 3]], states[:, [7, 10]], states[:, [8, 11]]
    spins = psi_v + phi_v * np.cos(theta)
    return Observed(blocks[0], blocks[1], scene.rotor.I3 * spins.T)


def _singular(axes: Array) -> str:
    near = [i for i in (0, 1) if hypot(axes[i, 0], axes[i, 1]) < 10 * _LEAST_INCLINATION]
    return f"theta_{near[0] + 1} comes to zero, where Euler angles are singular" if near else ""


MODEL = Model("euler", 12, _kind, program, _rhs, _start, _observe, _singular, _projection)
