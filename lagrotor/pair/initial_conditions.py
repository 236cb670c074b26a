"""Starts that satisfy their constraints: bringing a state onto the bar, and onto the paired precession."""

from dataclasses import replace
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics import jacobian, mass_matrix, project_position, project_velocity
from lagrotor.pair.symbols import AXES, a, b, k
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.theory.paired_precession.series import evaluate, last_terms, paired_series, shape_of
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

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
    system, _ = axes_pair()
    values: dict[Any, float] = dict(zip((a, b), scene.inertias, strict=True))
    values[k] = (link or Link()).length / scene.rotor.length
    mass = np.array(mass_matrix(system.L, AXES).subs(values), dtype=float)
    g = sp.lambdify([AXES.q], [e.subs(values) for e in system.g])
    G = sp.lambdify([AXES.q], jacobian(system.g, AXES).subs(values))

    def residual(state: Array) -> Array:
        return np.array(g(state), dtype=float)

    def slope(state: Array) -> Array:
        return np.array(G(state), dtype=float)

    q = project_position(residual, slope, q, mass)
    v = project_velocity(slope(q), v, mass)
    return replace(scene, axes=_pair(q), rates=_pair(v))


def paired_scene(scene: Scene, r0: float, order: int = 9) -> Scene:
    """`scene` started on its paired precession of amplitude r0 at Phi = 0, by the series through r0**order.

    The start is exact on the bar; its velocities are off the periodic orbit by O(r0**(order + 1)) Omega.
    Raises InputError unless the spins are opposite; DomainError unless |r0| < 1, and where the series has not converged.
    """
    from lagrotor.theory.natural_frequency import natural_rate

    shape, ratio = shape_of(scene)
    if not -1 < r0 < 1:
        raise DomainError(f"paired_scene: r0 = {r0:g} must lie between −1 and 1: it is the sine of an inclination")
    series = paired_series(order, shape, ratio)
    rate = natural_rate(scene) * float(evaluate(series.frequency, r0, 0.0)) * np.sign(scene.spins[0])
    if (off := last_terms(series, r0)) > 1e-3:
        raise DomainError(
            f"paired_scene: at r0 = {r0:g} the last terms of the series of order {order} are still {off:.1g}: take a smaller "
            "amplitude or a higher order, or find the orbit by lagrotor.models.orbits.shooting.exact_orbit"
        )
    widths = np.array([1.0, np.sqrt(float(shape)), 1.0])
    first, slope = (
        widths * [float(evaluate(part, r0, 0.0)) for part in parts]
        for parts in ((series.x, series.Y, series.z), [p.derivative() for p in (series.x, series.Y, series.z)])
    )
    later = widths * [float(evaluate(p, r0, np.pi)) for p in (series.x, series.Y, series.z)]
    later_slope = widths * [float(evaluate(p.derivative(), r0, np.pi)) for p in (series.x, series.Y, series.z)]
    mirror = np.array([-1.0, 1.0, 1.0])
    axes, rates = (first, mirror * later), (rate * slope, rate * mirror * later_slope)
    return consistent_scene(scene.spins, axes, rates, scene.rotor, scene.link, scene.shock)


def _pair(flat: Array) -> Any:
    return tuple(tuple(float(x) for x in part) for part in flat.reshape(2, 3))
