"""Initial states on the constraints of the bar."""

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
    """Return the code of a function of (r_1, r_2, a, b, k).

    It gives the three constraints, their Jacobian (3, 6) and the mass matrix (6, 6) as one flat tuple.
    """
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
    """Return the scene whose initial state satisfies the bar's constraint and is nearest to an approximate one.

    Distances are those of the mass metric.

    Parameters
    ----------
    spins : tuple of float
        The axial angular velocities in rad/s.
    axes : array_like
        Approximate axes, shape (2, 3).
    rates : array_like, default ((0, 0, 0), (0, 0, 0))
        Approximate rates in 1/s, shape (2, 3).
    rotor, link, shock : optional
        The fields of `Scene`.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    ConstraintError
        If Newton's method does not reach the constraint.

    Examples
    --------
    >>> scene = consistent_scene((10, -10), ((0.1, 0.0, 1.0), (0.1, 0.0, 1.0)))
    >>> round(scene.axes[0][0], 6) == round(scene.axes[1][0], 6)
    True
    """
    scene = Scene(spins, rotor or Rotor(), link or Link(), shock)
    try:
        q, v = (np.asarray(vectors, dtype=float).reshape(6) for vectors in (axes, rates))
    except (TypeError, ValueError):
        raise InputError(f"consistent_scene: axes {axes!r} and rates {rates!r} must be two vectors each") from None
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        raise InputError("consistent_scene: axes and rates must be finite numbers: correct them")

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
