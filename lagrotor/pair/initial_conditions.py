"""Starts that satisfy their constraints: bringing a state onto the bar, and onto the paired precession."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

Array = NDArray[np.floating[Any]]


@generated(((),))
def _constraint_equations() -> str:
    """(r_1, r_2, a, b, k) → the three constraints, their rows (3, 6) and the mass matrix (6, 6), 57 numbers."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.lagrangians import axes_pair
    from lagrotor.pair.notation import AXES, a, b, k

    system = axes_pair()
    return program_source(Program((*AXES.q, a, b, k), (), (*system.constraints, *system.rows, *system.mass_matrix)))


def consistent_scene(
    spins: tuple[float, float],
    axes: ArrayLike,
    rates: ArrayLike = ((0, 0, 0), (0, 0, 0)),
    rotor: Rotor | None = None,
    link: Link | None = None,
    shock: Shock | None = None,
) -> Scene:
    """The scene whose start is nearest, in the mass metric, to what is given and satisfies the bar.

    Parameters
    ----------
    spins : tuple[float, float]
        Rad/s.
    axes : array_like
        (2, 3).
    rates : array_like, default ((0, 0, 0), (0, 0, 0))
        (2, 3), 1/s.
    rotor : Rotor or None, optional
        As in `Scene`.
    link : Link or None, optional
        As in `Scene`.
    shock : Shock or None, optional
        As in `Scene`.

    Raises
    ------
    ConstraintError
        When the axes cannot be brought onto the bar.
    InputError
        For what Scene refuses.
    """
    scene = Scene(spins, rotor or Rotor(), link or Link(), shock)
    try:
        q, v = (np.asarray(vectors, dtype=float).reshape(6) for vectors in (axes, rates))
    except (TypeError, ValueError):
        raise InputError(f"consistent_scene: axes {axes!r} and rates {rates!r} must be two vectors each") from None
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        raise InputError("consistent_scene: axes and rates must be finite")

    from lagrotor.mechanics.constraints import project_position, project_velocity

    def parts(state: Array) -> Array:
        return np.array(_constraint_equations()(*state.tolist(), *scene.inertias, scene.k), dtype=float)

    def residual(state: Array) -> Array:
        return parts(state)[:3]

    def slope(state: Array) -> Array:
        return parts(state)[3:21].reshape(3, 6)

    mass = parts(q)[21:].reshape(6, 6)
    q = project_position(residual, slope, q, mass)
    v = project_velocity(slope(q), v, mass)
    return replace(scene, axes=_pair(q), rates=_pair(v))


def _pair(flat: Array) -> Any:
    return tuple(tuple(float(x) for x in vector) for vector in flat.reshape(2, 3))
