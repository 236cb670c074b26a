"""What acts on the axes of a structure and what holds them, for numbers of any kind.

r, v: the axes and their rates, (N, 3), 1/s; G: the axial momenta (N,). They are arrays of floats, or of objects: symbols, or
numbers that record or are compiled, whose square roots `root` takes element by element.
"""

from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np

from lagrotor.structures.coefficients import Array, Coefficients

_NEXT, _AFTER = [1, 2, 0], [2, 0, 1]
_TERMS = 17  # of the series of the arc sine, which leave 4e-14 where an axis hangs down, 1e-16 below 2 rad
Root = Callable[[Array], Array]


def cross_product(a: Array, b: Array) -> Array:
    """a × b, (…, 3)."""
    return a[..., _NEXT] * b[..., _AFTER] - a[..., _AFTER] * b[..., _NEXT]


def forces(c: Coefficients, r: Array, v: Array, G: Array, root: Root = np.sqrt) -> Array:
    """What spins, friction, weight, hinges and braces exert on the axes, (N, 3), N m."""
    F = G[:, None] * cross_product(r, v)
    if c.friction.any():
        F = F - c.friction[:, None] * v
    if c.gravity:
        F[:, 2] -= c.gravity * c.S
    if c.hinge.any():
        F[:, 2] += c.hinge * _angle_by_sine(r, root)
    return F + brace_forces(c, r, v, root) if len(c.stiffness) else F


def brace_forces(c: Coefficients, r: Array, v: Array, root: Root = np.sqrt) -> Array:
    """What braces exert on the axes, (N, 3), N m."""
    tip, joined = c.brace_tip, c.brace_to >= 0
    other, F = c.brace_to[joined], np.zeros_like(r)
    swing = c.R[tip, None] * v[tip]
    swing[joined] -= c.R[other, None] * v[other]
    along, stretch = stretches(c, r, root)
    pull = (c.stiffness * stretch + c.damping * (along * swing).sum(1))[:, None] * along
    np.subtract.at(F, tip, c.R[tip, None] * pull)
    np.add.at(F, other, c.R[other, None] * pull[joined])
    return F


def stretches(c: Coefficients, r: Array, root: Root = np.sqrt) -> tuple[Array, Array]:
    """Along which unit vectors the braces pull, (…, braces, 3), and by how much they are longer, m; r (…, N, 3)."""
    joined = c.brace_to[:, None] >= 0
    foot = np.where(joined, c.feet[c.brace_to], c.brace_point)
    d = c.feet[c.brace_tip] - foot + (c.R[c.brace_tip, None] * r[..., c.brace_tip, :])
    d = d - np.where(joined, c.R[c.brace_to, None], 0.0) * r[..., c.brace_to, :]
    guided, length = np.any(c.brace_along, axis=1), root((d * d).sum(-1))
    along = np.where(guided[:, None], c.brace_along, d / np.where(guided, 1.0, length)[..., None])
    return along, np.where(guided, (along * d).sum(-1), length) - c.brace_length


def _angle_by_sine(r: Array, root: Root) -> Any:
    """theta / sin(theta), regular where an axis is upright.

    Where square roots are all there is: theta = 8 b, and b / sin(b) is the arc sine's series in sin(b)²;
    sin(8 b) = 8 sin(b) cos(b) cos(2 b) cos(4 b).
    """
    if root is np.sqrt:
        return 1 / np.sinc(np.arctan2(np.hypot(r[:, 0], r[:, 1]), r[:, 2]) / np.pi)
    half = root((1.0 + r[:, 2]) / 2.0)
    quarter = root((1.0 + half) / 2.0)
    square, series = (1.0 - quarter) / 2.0, 0.0
    for n in reversed(range(_TERMS)):
        series = series * square + comb(2 * n, n) / 4**n / (2 * n + 1)
    return series / (half * quarter * root((1.0 + quarter) / 2.0))


def along_bars(c: Coefficients, r: Array) -> Array:
    """d from tip i to tip j of the bars, m, (…, B, 3); r (…, N, 3)."""
    return c.feet[c.j] - c.feet[c.i] + _swing(c, r)


def _swing(c: Coefficients, v: Array) -> Array:
    """d' of the bars."""
    return c.R[c.j, None] * v[..., c.j, :] - c.R[c.i, None] * v[..., c.i, :]


def pulls(c: Coefficients, r: Array) -> tuple[Array, Array]:
    """−R_i d and R_j d of the bars (…, B, 3): half the gradients of |d|²; r (…, N, 3)."""
    d = along_bars(c, r)
    return -c.R[c.i, None] * d, c.R[c.j, None] * d


def off_constraints(c: Coefficients, r: Array) -> Array:
    """How far the constraints are from zero, [|r|² − 1 (N), |d|² − ell² (B)], halved, (…, N + B); r (…, N, 3)."""
    d = along_bars(c, r)
    return np.concatenate([(r * r).sum(-1) - 1, (d * d).sum(-1) - c.ell**2], axis=-1) / 2


def rates_of_constraints(c: Coefficients, r: Array, v: Array) -> Array:
    """Their rates, [r · r', d · d'], (…, N + B)."""
    return np.concatenate([(r * v).sum(-1), (along_bars(c, r) * _swing(c, v)).sum(-1)], axis=-1)


def right_side(c: Coefficients, F: Array, v: Array) -> Array:
    """Of the equations for [r'' (3 N), multipliers of the axes (N) and of the bars (B)], with F (N, 3) on the axes."""
    swing = _swing(c, v)
    return np.concatenate([F.ravel(), -(v * v).sum(1), -(swing * swing).sum(1)])
