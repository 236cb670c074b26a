"""The paired precession by the ansatz, by the paper's correction and by the series, beside the exact orbit at one phase."""

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.models.orbits.shooting import ExactOrbit
from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import Array
from lagrotor.theory.paired_precession.closed_forms import corrected_trajectories


def ansatz_axes(sines: ArrayLike, phase: Array) -> Array:
    """Axes (2, n, 3) of the ansatz phi_1 = −phi_2 = phase (n,), the sines of their inclinations (2,) or (2, n)."""
    size = np.broadcast_to(np.asarray(sines, dtype=float).reshape(2, -1), (2, len(phase)))
    azimuths = np.array([phase, -phase])
    return np.stack([size * np.cos(azimuths), size * np.sin(azimuths), np.sqrt(1 - size**2)], -1)


def paper_axes(r0: float, phase: Array) -> Array:
    """Axes (2, n, 3) by the paper's correction (5.20): inclinations of sine r_0 ∓ r_0² cos(phase)."""
    change = r0**2 * np.cos(phase)
    return ansatz_axes(np.array([r0 - change, r0 + change]), phase)


def series_axes(order: int, r0: float, phase: Array) -> Array:
    """Axes (2, n, 3) by the corrected series of this order in r_0, massless bar, ell = R."""
    return np.array(corrected_trajectories(order)(r0, phase, 1, 1)).reshape(2, 3, -1).swapaxes(1, 2)


def against_orbit(orbit: ExactOrbit, phase: Array, curves: dict[str, Array], tol: float) -> dict[str, Array]:
    """Tips (2, n, 3) in m of `curves`, axes (2, n, 3) by name, and of the orbit, `exact`, at the same phases (n,).

    With each curve `<name>_distance`: how far its tip 1 is from the exact one, (n,) in m.
    """
    run = simulate(orbit.scene, phase / orbit.frequency, "minimal", tol)
    tips = {name: run.joints[:, None] + run.scene.rotor.length * axes for name, axes in curves.items()}
    away = {f"{name}_distance": np.linalg.norm(curve[0] - run.tips[0], axis=-1) for name, curve in tips.items()}
    return {"phase": phase, **tips, "exact": run.tips, **away}
