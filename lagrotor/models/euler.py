"""Rung 5: the paper's own coordinates, two sets of Euler angles with a multiplier for the bar. Twelve states.

Exact for any bar, but singular at theta = 0, which is the rest state: kept to be compared, not to be preferred.
"""

from functools import lru_cache
from math import acos, atan2, cos, hypot
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import SingularError
from lagrotor.mechanics import bias, mass_matrix, total_derivative
from lagrotor.models.model import Array, Model, Observed
from lagrotor.numerics.codegen import Program, compile_program, solve_symmetric
from lagrotor.numerics.integrate import Projection
from lagrotor.pair.lagrangians import axis, pair_with_bar
from lagrotor.pair.scene import Scene
from lagrotor.pair.symbols import I3, PAIR, a, b, k

FORCE = sp.symbols("F_x F_y F_z", real=True)
# The spins first: their pivot is I_3, and what is left of the azimuth's is then a sin² theta.
ORDER = [2, 5, 0, 3, 1, 4]
LEAST_INCLINATION = 1e-3  # rad; the rate of the azimuth grows as 1/theta below it


@lru_cache(maxsize=32)
def program(massive: bool, body: int) -> Program:
    """(theta_1, phi_1, psi_1, theta_2, phi_2, psi_2, rates; a, b, k, I_3[, F]) → rates of the twelve."""
    system = pair_with_bar()
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, PAIR), system.rows
    force = -bias(lagrangian, PAIR)
    if body:
        i = 3 * (body - 1)
        tip = axis(PAIR.q[i], PAIR.q[i + 1])
        for j in (0, 1):
            force[i + j] += sp.Matrix(FORCE).dot(tip.diff(PAIR.q[i + j]))
    mass, force, G = mass.extract(ORDER, ORDER), force.extract(ORDER, [0]), G.extract([0], ORDER)
    stages, free = solve_symmetric(mass, force.row_join(G.T), "m")
    # I_3 cos² theta cancels from the azimuth's pivot here: in floating point it would leave more than a sin² theta is.
    ratios = {name: e for name, e in stages if e in (sp.cos(PAIR.q[0]), sp.cos(PAIR.q[3]))}
    stages = [(name, sp.expand(e.subs(ratios)) if e.has(*ratios) else e) for name, e in stages]
    lam = sp.Symbol("lam", real=True)
    row, acceleration, pull = G.row(0), free[:, 0], free[:, 1]
    gamma = system.gamma[0]
    stages.append((lam, -(row.dot(acceleration) + gamma) / row.dot(pull)))
    moved = acceleration + lam * pull
    accelerations = [moved[ORDER.index(i)] for i in range(6)]
    parameters = (a, *((b,) if massive else ()), k, I3, *(FORCE if body else ()))
    return Program((*PAIR.q, *PAIR.v, *parameters), tuple(stages), (*PAIR.v, *accelerations))


def _program(scene: Scene, driven: bool) -> tuple[Program, tuple[float, ...]]:
    """The scene's program and the values of its parameters but for the force."""
    inertia_a, inertia_b = scene.inertias
    massive = inertia_b != 0
    body = scene.shock.body if driven and scene.shock else 0
    ratio = scene.link.length / scene.rotor.length if scene.link else 1.0
    return program(massive, body), (inertia_a, *((inertia_b,) if massive else ()), ratio, scene.rotor.I3)


@lru_cache(maxsize=2)
def _projection_function(massive: bool) -> Any:
    """One Newton step onto the bar's constraint and its rate, along M⁻¹ Gᵀ."""
    system = pair_with_bar()
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, PAIR), system.rows
    stages, pull = solve_symmetric(mass.extract(ORDER, ORDER), G.T.extract(ORDER, [0]), "p")
    along = [pull[ORDER.index(i)] for i in range(6)]
    strength = sum(x * y for x, y in zip(G, along, strict=True))
    off, moving = system.constraints[0] / strength, system.residual[0] / strength
    corrected = [*(q - off * x for q, x in zip(PAIR.q, along, strict=True))]
    corrected += [v - moving * x for v, x in zip(PAIR.v, along, strict=True)]
    parameters = (a, *((b,) if massive else ()), k, I3)
    return compile_program(Program((*PAIR.q, *PAIR.v, *parameters), tuple(stages), tuple(corrected)), "numpy")


def _projection(scene: Scene) -> Projection:
    _, values = _program(scene, False)
    function = _projection_function(scene.inertias[1] != 0)
    return lambda y: np.array(function(*y, *values))


def _start(scene: Scene) -> Array:
    if scene.link is None:
        raise SingularError("euler: the scene has no bar; use model='spheres'")
    q, rates = [], []
    for i, (r, v, spin) in enumerate(zip(scene.axes, scene.rates, scene.spins, strict=True)):
        radius = hypot(r[0], r[1])
        if radius < LEAST_INCLINATION:
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


@lru_cache(maxsize=1)
def _axes_function() -> Any:
    q = PAIR.q
    r = [*axis(q[0], q[1]), *axis(q[3], q[4])]
    v = [total_derivative(e, PAIR) for e in r]
    return compile_program(Program((*q, *PAIR.v), (), (*r, *v)), "numpy")


def _observe(scene: Scene, states: Array) -> Observed:
    columns = _axes_function()(*states.T)
    parts = np.stack(columns).reshape(2, 2, 3, -1).transpose(0, 1, 3, 2)
    theta, phi_v, psi_v = states[:, [0, 3]], states[:, [7, 10]], states[:, [8, 11]]
    spins = psi_v + phi_v * np.cos(theta)
    return Observed(parts[0], parts[1], scene.rotor.I3 * spins.T)


MODEL = Model("euler", 12, _program, _start, _observe, _projection)
