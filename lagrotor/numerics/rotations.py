"""Rotation matrices of bodies along a run, carried by their axes and axial spins. No angle is singular."""

import numpy as np

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import Array as Array

_ONE = np.eye(3)
# v @ _LEVI_CIVITA is the cross product matrix of v, row by row.
_LEVI_CIVITA = np.array(
    [[0, 0, 0, 0, 0, -1, 0, 1, 0], [0, 0, 1, 0, 0, 0, -1, 0, 0], [0, -1, 0, 1, 0, 0, 0, 0, 0]], dtype=float
)


def turn_between(u: Array, v: Array) -> Array:
    """Return the shortest rotations P with P u = v, shape (…, 3, 3): P = (u·v) 1 + [n]× + n nᵀ/(1 + u·v), n = u × v. Raises
    InputError if v is opposite to u, since then no rotation is the shortest."""
    n, c = np.cross(u, v), (u * v).sum(-1)[..., None, None]
    if (1 + c < 1e-12).any():
        raise InputError("turn_between: an axis reverses between two samples; take more samples")
    rotation: Array = c * np.eye(3) + skew_matrix(n) + n[..., :, None] * n[..., None, :] / (1 + c)
    return rotation


def body_rotations(t: Array, axes: Array, rates: Array, spins: Array) -> Array:
    """Compute the rotation of each body, body to world, from Q' = [Omega]× Q, Omega = r × r' + omega r.

    At t[0] the body is turned the shortest way from e_z to r (by way of ±e_x if r hangs down). From sample to sample r is
    carried along the great circle, Q → P(r_0 → r_1) exp([r_0]× (omega h + area)) Q. The area lies between the path u(t) of r
    and that circle. About the pole p = r_0 it grows at the rate p·(u × u')/(1 + p·u), which is zero to first order at p. So
    the area is h/3 times this rate at the other end, averaged over both poles. Its error in a step is O(h⁵). The axis r is
    exact to rounding, and the angle about r has an error of O(h⁴).

    Parameters
    ----------
    t : Array
        Times in s, shape (n,).
    axes : Array
        Unit vectors r, shape (k, n, 3).
    rates : Array
        Their derivatives r' in 1/s, shape (k, n, 3).
    spins : Array
        Constant axial spins omega in rad/s, shape (k,).

    Returns
    -------
    Array
        Rotation matrices Q, shape (k, n, 3, 3).

    Raises
    ------
    InputError
        If an axis turns by pi between two samples.
    """
    r0, r1, v0, v1 = axes[:, :-1], axes[:, 1:], rates[:, :-1], rates[:, 1:]
    carried, h = turn_between(r0, r1), np.diff(t)
    swept = (r0 * np.cross(r1, v1)).sum(-1) + (r1 * np.cross(r0, v0)).sum(-1)
    angle = h * (spins[:, None] + swept / (6 * (1 + (r0 * r1).sum(-1))))
    steps = carried @ turn_about(r0, angle)
    Q = np.empty((*axes.shape, 3))
    e_z, side = np.eye(3)[2], np.where(axes[:, 0, :1] < 0, -1.0, 1.0) * np.eye(3)[0]
    over = np.where(axes[:, 0, 2:] < 0, side, e_z)
    Q[:, 0] = turn_between(over, axes[:, 0]) @ turn_between(e_z, over)
    for i in range(len(h)):
        Q[:, i + 1] = steps[:, i] @ Q[:, i]
    return Q


def between_samples(t: Array, axes: Array, rates: Array, times: Array) -> tuple[Array, Array]:
    """Interpolate unit axes and their tangent rates (k, n, 3) at other times (m,) by Hermite cubics, to O(h⁴). Raises
    InputError for times outside the samples, or fewer than two samples."""
    if len(t) < 2 or times.min() < t[0] or times.max() > t[-1]:
        raise InputError("between_samples: the run needs at least two times, and all times must lie between them")
    from scipy.interpolate import CubicHermiteSpline

    curve = CubicHermiteSpline(t, axes, rates, axis=1)
    r, v = curve(times), curve(times, 1)
    size = np.linalg.norm(r, axis=-1, keepdims=True)
    r /= size
    v /= size
    return r, v - (v * r).sum(-1, keepdims=True) * r


def turn_about(n: Array, angle: Array) -> Array:
    """Return rotations by `angle` (…,) about unit vectors n (…, 3), shape (…, 3, 3): 1 + sin(angle) [n]× + (1 − cos(angle))
    [n]×². With q = sin(angle/2) n this is 1 + 2 cos(angle/2) [q]× + 2 [q]×²."""
    half = angle[..., None] / 2
    crossed = skew_matrix(np.sin(half) * n)
    rotation: Array = _ONE + 2 * (np.cos(half)[..., None] * crossed + crossed @ crossed)
    return rotation


def skew_matrix(v: Array) -> Array:
    """Return [v]×, shape (…, 3, 3), with [v]× w = v × w."""
    return v.dot(_LEVI_CIVITA).reshape(*v.shape, 3)


def turning_sum(products: Array) -> Array:
    """Return Σ a × b, shape (…, 3), from the sums Σ a bᵀ, shape (…, 3, 3)."""
    total: Array = products.reshape(*products.shape[:-2], 9).dot(-_LEVI_CIVITA.T)
    return total
