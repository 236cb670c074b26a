"""Rung 3: three free coordinates (U, chi, alpha). They satisfy the constraint of the bar, so that no run can drift off it.

The model is exact for every bar and every ratio k = ell / R. It is singular only where an axis lies along the joint line.
"""

from __future__ import annotations

from itertools import product
from math import asin, asinh, atan2, cosh, hypot, sin, sinh
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, SingularError
from lagrotor.models.model import Array, Model, Observed, constant_momenta, scenes_of
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.models.programs.minimal_program import Ratio
    from lagrotor.numerics.codegen import Program

_NEAR = 1e-3  # rad from the joint line, where U diverges
Kind = tuple[bool, "Ratio", int]  # massive bar, ell against R, shocked rotor (0: none)
RATIOS: tuple[Ratio, ...] = ("short", "equal", "long")
_KINDS: tuple[Kind, ...] = tuple(product((False, True), RATIOS, (0, 1, 2)))


def program(massive: bool, ratio: Ratio, body: int) -> Program:
    from lagrotor.models.programs import minimal_program

    return minimal_program.program(massive, ratio, body)


@generated((*kind, bounded) for kind in _KINDS for bounded in (False, True))
def _rhs(massive: bool, ratio: Ratio, body: int, bounded: bool) -> str:
    from lagrotor.numerics.printers import rhs_source

    return rhs_source(program(massive, ratio, body), 6, body > 0, bounded)


@generated(_KINDS)
def rhs_on_arrays(massive: bool, ratio: Ratio, body: int) -> str:
    """Return the source of the right-hand side for one kind of scene, on arrays that broadcast."""
    from lagrotor.numerics.printers import program_source

    return program_source(program(massive, ratio, body), "numpy")


@generated((ratio,) for ratio in RATIOS)
def _axes(ratio: Ratio) -> str:
    from lagrotor.models.programs.minimal_program import observation
    from lagrotor.numerics.printers import program_source

    return program_source(observation(ratio), "numpy")


def _ratio(scene: Scene) -> tuple[float, Ratio]:
    if scene.link is None:
        raise SingularError("minimal: the scene has no bar to eliminate; use model='spheres'")
    value = scene.link.length / scene.rotor.length
    return value, "equal" if value == 1 else "short" if value < 1 else "long"


def _kind(scene: Scene, driven: bool) -> tuple[Kind, tuple[float, ...]]:
    """Return the kind of program of the scene, and the values of its parameters except the force of the shock."""
    inertia_a, inertia_b = scene.inertias
    value, ratio = _ratio(scene)
    massive = inertia_b != 0
    body = scene.shock.body if driven and scene.shock else 0
    optional = (*((inertia_b,) if massive else ()), *(() if ratio == "equal" else (value,)))
    return (massive, ratio, body), (inertia_a, *optional, *scene.momenta)


def _start(scene: Scene) -> Array:
    value, ratio = _ratio(scene)
    u, alpha, u_v, alpha_v = [], [], [], []
    for i, (r, v) in enumerate(zip(scene.axes, scene.rates, strict=True)):
        radius = hypot(r[1], r[2])
        if radius < 1e-6:
            raise SingularError(f"minimal: axis {i + 1} lies along the joint line, r = {r}; use model='spheres'")
        u.append(asinh(r[0] / radius))
        alpha.append(atan2(-r[1], r[2]))
        u_v.append(v[0] / radius**2)
        alpha_v.append((r[1] * v[2] - r[2] * v[1]) / radius**2)
    twist = (alpha[1] - alpha[0] + np.pi) % (2 * np.pi) - np.pi
    w, twist_v, w_v = u[0] - u[1], alpha_v[1] - alpha_v[0], u_v[0] - u_v[1]
    if ratio == "short":
        # Delta has an extremum where the bar begins to fold over, but chi and w continue: take the rate from both.
        rho, c, s = value * cosh(w) - sinh(w), np.cos(twist), sin(twist)
        chi = atan2(s, rho)
        chi_v = (rho / c * twist_v + s / c * w_v) / ((rho**2 + s**2) / c**2)
    else:
        chi, chi_v = twist, twist_v
    Delta = asin(max(-1.0, min(1.0, value * sin(chi)))) if ratio == "short" else chi
    middle = [(u[0] + u[1]) / 2, chi, alpha[0] + Delta / 2]
    return np.array([*middle, (u_v[0] + u_v[1]) / 2, chi_v, (alpha_v[0] + alpha_v[1]) / 2])


def _observe(scene: Scene, states: Array) -> Observed:
    value, ratio = _ratio(scene)
    blocks = np.stack(_axes(ratio)(*states.T, value)).reshape(2, 2, 3, -1).transpose(0, 1, 3, 2)
    return Observed(blocks[0], blocks[1], constant_momenta(scene, blocks.shape[2]))


def scenes_from_states(scene: Scene, states: ArrayLike) -> list[Scene]:
    """Return a list of n scenes, each with one of the states (n, 6) as its start: U, chi, alpha and their rates (1/s)."""
    table = np.asarray(states, dtype=float)
    if table.ndim != 2 or table.shape[1] != 6 or not np.isfinite(table).all():
        raise InputError(f"scenes_from_states: states of shape {table.shape} must be finite numbers of shape (n, 6)")
    return scenes_of(scene, MODEL.observe(scene, table))


def _singular(axes: Array) -> str:
    near = [i for i in (0, 1) if hypot(axes[i, 1], axes[i, 2]) < _NEAR]
    return f"axis {near[0] + 1} lies along the joint line" if near else ""


MODEL = Model("minimal", 6, _kind, program, _rhs, _start, _observe, _singular, angles=(1, 2))
