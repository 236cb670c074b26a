"""Starts that satisfy their constraints: bringing a state onto the bar, and onto the paired precession."""

from dataclasses import replace
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics import project_position, project_velocity
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.scene import Link, Rotor, Scene, Shock
from lagrotor.pair.symbols import AXES, a, b, k

Array = NDArray[np.floating[Any]]


def consistent_scene(
    spins: tuple[float, float],
    axes: ArrayLike,
    rates: ArrayLike = ((0, 0, 0), (0, 0, 0)),
    rotor: Rotor | None = None,
    link: Link | None = None,
    shock: Shock | None = None,
) -> Scene:
    """The scene whose start is nearest, in the mass metric, to the given axes and rates (2, 3) and satisfies the bar.

    Raises ConstraintError when the axes cannot be brought onto the bar, InputError for what Scene refuses.
    """
    scene = Scene(spins, rotor or Rotor(), link or Link(), shock)
    try:
        q, v = (np.asarray(part, dtype=float).reshape(6) for part in (axes, rates))
    except (TypeError, ValueError):
        raise InputError(f"consistent_scene: axes {axes!r} and rates {rates!r} must be two vectors each") from None
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        raise InputError("consistent_scene: axes and rates must be finite")
    system = axes_pair()
    values: dict[Any, float] = dict(zip((a, b), scene.inertias, strict=True))
    values[k] = (link or Link()).length / scene.rotor.length
    mass = np.array(system.mass.subs(values), dtype=float)
    g = sp.lambdify([AXES.q], [e.subs(values) for e in system.constraints])
    G = sp.lambdify([AXES.q], system.rows.subs(values))

    def residual(state: Array) -> Array:
        return np.array(g(state), dtype=float)

    def slope(state: Array) -> Array:
        return np.array(G(state), dtype=float)

    q = project_position(residual, slope, q, mass)
    v = project_velocity(slope(q), v, mass)
    return replace(scene, axes=_pair(q), rates=_pair(v))


def _pair(flat: Array) -> Any:
    return tuple(tuple(float(x) for x in part) for part in flat.reshape(2, 3))
