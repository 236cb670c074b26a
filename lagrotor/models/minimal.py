"""Rung 3: three free coordinates (U, chi, alpha). They satisfy the constraint of the bar, so that no run can drift off it.

The model is exact for every bar and every ratio k = ell / R. It is singular only where an axis lies along the joint line.
"""

from __future__ import annotations

from itertools import product
from math import hypot
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
    """Return the source of a function of the parameters of one kind of scene, arrays (n,), that returns the right-hand side."""
    from lagrotor.numerics.printers import arrays_source

    return arrays_source(program(massive, ratio, body), 6, 3 if body else 0)


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
    for i, r in enumerate(scene.axes):
        if hypot(r[1], r[2]) < 1e-6:
            raise SingularError(f"minimal: axis {i + 1} lies along the joint line, r = {r}; use model='spheres'")
    return start_states(ratio, value, np.array(scene.axes), np.array(scene.rates))


def start_states(ratio: Ratio, k: float | Array, axes: Array, rates: Array) -> Array:
    """Return the states (…, 6) of pairs (…) whose unit axes and their rates have the shape (…, 2, 3), with ell / R = k (…)."""
    (x, y, z), (x_v, y_v, z_v) = np.moveaxis(axes, -1, 0), np.moveaxis(rates, -1, 0)
    radius = np.hypot(y, z)
    (u_1, u_2), (u_v1, u_v2) = (np.moveaxis(array, -1, 0) for array in (np.arcsinh(x / radius), x_v / radius**2))
    turn_v = (y * z_v - z * y_v) / radius**2
    (alpha_1, alpha_2), (alpha_v1, alpha_v2) = (np.moveaxis(array, -1, 0) for array in (np.arctan2(-y, z), turn_v))
    twist = (alpha_2 - alpha_1 + np.pi) % (2 * np.pi) - np.pi
    w, twist_v, w_v = u_1 - u_2, alpha_v2 - alpha_v1, u_v1 - u_v2
    chi, chi_v, Delta = twist, twist_v, twist
    if ratio == "short":
        # Delta has an extremum where the bar begins to fold over, but chi and w continue: take the rate from both.
        rho, c, s = k * np.cosh(w) - np.sinh(w), np.cos(twist), np.sin(twist)
        chi = np.arctan2(s, rho)
        chi_v = (rho / c * twist_v + s / c * w_v) / ((rho**2 + s**2) / c**2)
        Delta = np.arcsin(np.clip(k * np.sin(chi), -1.0, 1.0))
    middle = (u_1 + u_2) / 2, chi, alpha_1 + Delta / 2, (u_v1 + u_v2) / 2, chi_v, (alpha_v1 + alpha_v2) / 2
    return np.stack(middle, axis=-1)


def _observe(scene: Scene, states: Array) -> Observed:
    value, ratio = _ratio(scene)
    axes, rates = observe_states(ratio, value, states)
    return Observed(axes, rates, constant_momenta(scene, axes.shape[1]))


def observe_states(ratio: Ratio, k: float | Array, states: Array) -> tuple[Array, Array]:
    """Return the axes and their rates, (2, …, 3) each, for states (…, 6) with ell / R = k (…). Their components are contiguous in
    memory, so that sums over them are fast."""
    blocks = np.stack(_axes(ratio)(*np.moveaxis(states, -1, 0), k))
    axes, rates = np.moveaxis(blocks.reshape(2, 2, 3, *blocks.shape[1:]), 2, -1)
    return axes, rates


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
