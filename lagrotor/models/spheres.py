"""Rung 4: two unit vectors with multipliers. Twelve states, exact for any bar or none, regular everywhere.

    a r_i'' + b r_j'' = G_i r_i × r_i' + F_i + sum_c lam_c grad_i g_c

What vanishes on the constraints is left out of the generated code (|r_i|² = 1, r_1 . r_2 = 1 + k (x_2 − x_1)).
"""

from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp

from ..mechanics import acceleration_bias, bias, jacobian, mass_matrix, velocity_residual
from ..mechanics.lagrangian import linear_solve
from ..numerics.codegen import Program, compile_program, solve_symmetric
from ..numerics.solve import Projection, Rate
from ..rotors.lagrangians import axes_pair
from ..rotors.parameters import Scene
from ..symbols import AXES, G_1, G_2, a, b, k
from .model import Array, Model, Observed, constant_momenta, python_rate

FORCE = sp.symbols("F_x F_y F_z", real=True)


def _on_constraint(expression: sp.Expr, bar: bool) -> sp.Expr:
    """`expression` with z_1², z_2² and, under the bar, z_1 z_2 eliminated by the constraints."""
    x1, y1, z1, x2, y2, z2 = AXES.q
    rules = {z1**2: 1 - x1**2 - y1**2, z2**2: 1 - x2**2 - y2**2}
    if bar:
        rules[z1 * z2] = 1 + k * (x2 - x1) - x1 * x2 - y1 * y2
    return sp.expand(sp.expand(expression).subs(rules))


@lru_cache(maxsize=32)
def program(massive: bool, bar: bool, body: int) -> Program:
    """(r_1, r_2, r_1', r_2'; a, b, k, G_1, G_2[, F]) → rates of the twelve; `body` 0: no force."""
    system, gyroscopic = axes_pair(bar)
    lagrangian = system.L if massive else system.L.subs(b, 0)
    mass, G = mass_matrix(lagrangian, AXES), jacobian(system.g, AXES)
    force = gyroscopic - bias(lagrangian, AXES)
    if body:
        force[3 * body - 3 : 3 * body, 0] += sp.Matrix(FORCE)
    # M⁻¹ of the block matrix [[a, b], [b, a]] ⊗ 1.
    p, q = sp.symbols("p q", real=True)
    inverse = sp.Matrix([[p, q], [q, p]]) if massive else sp.Matrix([[p, 0], [0, p]])
    pivots = [(p, a / (a**2 - b**2)), (q, -b / (a**2 - b**2))] if massive else [(p, 1 / a)]
    whole = sp.kronecker_product(inverse, sp.eye(3))
    assert (whole * mass).xreplace(dict(pivots)).applyfunc(sp.cancel) == sp.eye(6)

    free = whole * force
    gamma = acceleration_bias(system.g, AXES)
    named_gamma = [(sp.Symbol(f"g_{i}", real=True), e) for i, e in enumerate(gamma)]
    # The gyroscopic part of G M⁻¹ Q vanishes where r . (r × r') does.
    right = -(G * free).applyfunc(lambda e: _on_constraint(e, bar)) - sp.Matrix([s for s, _ in named_gamma])
    schur = (G * whole * G.T).applyfunc(lambda e: sp.collect(_on_constraint(e, bar), (p, q)))
    stages, lam = solve_symmetric(schur, right, "s")
    acceleration = free + whole * G.T * lam
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()), G_1, G_2, *(FORCE if body else ()))
    return Program((*AXES.q, *AXES.v, *parameters), (*pivots, *named_gamma, *stages), (*AXES.v, *acceleration))


@lru_cache(maxsize=32)
def _compiled(massive: bool, bar: bool, body: int) -> Any:
    return compile_program(program(massive, bar, body))


def _rate(scene: Scene, pulsed: bool) -> Rate:
    inertia_a, inertia_b = scene.inertias
    bar, massive = scene.link is not None, inertia_b != 0
    body = scene.shock.body if pulsed and scene.shock else 0
    ratio = (scene.link.length / scene.rotor.length,) if scene.link else ()
    parameters = (inertia_a, *((inertia_b,) if massive else ()), *ratio, *scene.momenta)
    return python_rate(scene, _compiled(massive, bar, body), parameters, pulsed)


@lru_cache(maxsize=8)
def _projection_function(massive: bool, bar: bool) -> Any:
    """One Newton step onto the constraints and their rates, along M⁻¹ Gᵀ: q − M⁻¹ Gᵀ S⁻¹ g, v − M⁻¹ Gᵀ S⁻¹ G v."""
    system, _ = axes_pair(bar)
    mass = mass_matrix(system.L if massive else system.L.subs(b, 0), AXES)
    G, pull = jacobian(system.g, AXES), linear_solve(mass, jacobian(system.g, AXES).T, "the axes' mass matrix")
    off = sp.Matrix(system.g).row_join(velocity_residual(system.g, AXES))
    stages, x = solve_symmetric(G * pull, off, "p")
    corrected = sp.Matrix([*AXES.q, *AXES.v]) - (pull * x[:, 0]).col_join(pull * x[:, 1])
    parameters = (a, *((b,) if massive else ()), *((k,) if bar else ()))
    return compile_program(Program((*AXES.q, *AXES.v, *parameters), tuple(stages), tuple(corrected)))


def _projection(scene: Scene) -> Projection:
    inertia_a, inertia_b = scene.inertias
    massive = inertia_b != 0
    ratio = (scene.link.length / scene.rotor.length,) if scene.link else ()
    function = _projection_function(massive, scene.link is not None)
    parameters = (inertia_a, *((inertia_b,) if massive else ()), *ratio)
    return lambda y: np.array(function(*y.tolist(), *parameters))


def _start(scene: Scene) -> Array:
    return np.array([*scene.axes[0], *scene.axes[1], *scene.rates[0], *scene.rates[1]])


def _observe(scene: Scene, states: Array) -> Observed:
    parts = states.reshape(-1, 2, 2, 3).transpose(1, 2, 0, 3)
    return Observed(parts[0], parts[1], constant_momenta(scene, len(states)))


MODEL = Model("spheres", _start, _rate, _observe, _projection)
