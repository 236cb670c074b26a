"""Comparisons of the linear motion about upright with the exact motion: its growth, and whether it stays bounded."""

from dataclasses import replace

import numpy as np

from lagrotor.errors import InputError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.structure_run import simulate_structure
from lagrotor.structures.small_motion import SmallMotion, check_upright, modes, small_motion


def measured_growth(s: Assembly, folds: float = 3.0) -> float:
    """Measure the growth rate of an exact motion that starts as the fastest growing mode.

    The amplitude is the projection on the left eigenvector of this mode, to which no other mode contributes.

    Parameters
    ----------
    s : Assembly
        The structure.
    folds : float, default 3.0
        The duration of the run in units of 1/growth of the mode.

    Returns
    -------
    float
        The growth rate, 1/s.
    """
    check_upright(s, "measured_growth")
    linear, normal = small_motion(s), modes(s)
    root = normal.growth[0] + 1j * normal.rates[0]
    if not root.real > 0:
        raise InputError("measured_growth: no mode grows about upright: give an unstable structure")
    shape = 1e-5 * normal.shapes[0]  # the tolerance is 10⁻⁵ of this tilt
    run = simulate_structure(s, [0.0, folds / root.real], shape.real, (root * shape).real, tol=1e-10)
    roots, left_vectors = np.linalg.eig(replace(linear, rate=1.0).first_order.T)
    w = left_vectors[:, np.argmin(np.abs(roots - root))]
    first, last = (abs(w @ state) for state in _coordinates(linear, run.axes, run.rates).T)
    return float(np.log(last / first) * root.real / folds)


def bounded_motion(s: Assembly, turns: float = 20.0) -> tuple[float, float]:
    """Compare an exact run from a random state of size 10⁻⁶ with the linear motion.

    Parameters
    ----------
    s : Assembly
        The structure.
    turns : float, default 20.0
        The duration in periods of the slowest mode.

    Returns
    -------
    tuple
        The largest tilt of the exact run, and its largest distance from the linear motion. Both are divided by the
        largest tilt at the start.
    """
    from scipy.linalg import expm

    check_upright(s, "bounded_motion")
    linear, normal = small_motion(s), modes(s)
    rates = normal.rates[normal.rates > 0]
    t = np.linspace(0, 2 * np.pi * turns / rates.min(), 400)
    draw = np.random.default_rng(0).standard_normal((linear.dof,))
    run = simulate_structure(s, t, 1e-6 * (linear.basis @ draw).reshape(-1, 2) / np.abs(draw).max(), tol=1e-10)
    exact = _coordinates(linear, run.axes, run.rates)
    step, states = expm(replace(linear, rate=1.0).first_order * t[1]), [exact[:, 0]]
    for _ in t[1:]:
        states.append(step @ states[-1])
    n = linear.dof
    size = np.abs(exact[:n, 0]).max()
    return float(np.abs(exact[:n]).max() / size), float(np.abs(exact[:n] - np.array(states).T[:n]).max() / size)


def _coordinates(linear: SmallMotion, axes: Array, rates: Array) -> Array:
    """Return the coordinates q of a run on the degrees of freedom, followed by their rates q', (2n, times)."""
    columns = [
        vectors[..., :2].swapaxes(0, 1).reshape(vectors.shape[1], -1) @ linear.basis for vectors in (axes, rates)
    ]
    return np.hstack(columns).T
