"""Chern numbers of the bands of a pattern in the plane.

Fukui, Hatsugai & Suzuki, J. Phys. Soc. Jpn. 74, 1674 (2005): the flux of Berry's phase through each plaquette of a grid of
wave numbers, the bands of a group together, adds up to 2π times a whole number. The product of two waves is the symplectic
one: with momenta p = M u' + C u/2, i (u_1† p_2 − p_1† u_2), which the motion conserves and which counts waves of positive
rate about a stable rest positive (Shindou et al., Phys. Rev. B 87, 174427 (2013); gyroscopes: Nash et al., PNAS 112, 14495
(2015)).
"""

from dataclasses import dataclass

import numpy as np

from lagrotor.errors import InputError
from lagrotor.structures.coefficients import Array, Complex
from lagrotor.structures.waves.bloch import bloch
from lagrotor.structures.waves.cell import Cell
from lagrotor.structures.waves.dispersion import Dispersion, dispersion

_APART = 1e-6  # of the highest rate: bands nearer to each other at some wave number belong to one group
_STARTS = 4  # local minima of a grid that are followed


@dataclass(frozen=True)
class Chern:
    """groups: (first, last) band of each group that touches no other; numbers: its Chern number; apart: least distance
    (rad/s) from each group to the next one at one wave number; off: how far the sums of flux were from whole numbers."""

    groups: tuple[tuple[int, int], ...]
    numbers: tuple[int, ...]
    apart: tuple[float, ...]
    off: float


def chern_numbers(p: Cell, grid: int = 24) -> Chern:
    """The Chern number of each group of bands, from grid × grid wave numbers.

    Its sign is that of the flux of i ⟨u|∇u⟩ with e_1 × e_2 of the steps as positive. Raises InputError where the pattern
    has one step or friction, where a wave falls or has rate zero, where the bars leave no freedom,
    or more at some q than at others.
    """
    if len(p.steps) != 2:
        raise InputError("chern_numbers: the pattern repeats along one step: a Chern number needs two")
    points = 2 * np.pi * np.arange(grid) / grid
    q = np.stack(np.meshgrid(points, points, indexing="ij"), axis=-1).reshape(-1, 2)
    d = dispersion(p, q)
    _check(d)
    n = d.rates.shape[1]
    between = np.array([_least_distance(d, k, grid) for k in range(n - 1)])
    ends = [k for k in range(n) if k == n - 1 or between[k] > _APART * d.rates.max()]
    groups = tuple(zip([0, *(k + 1 for k in ends[:-1])], ends, strict=True))
    sums = np.array([_flux(d, first, last, grid).sum() / (2 * np.pi) for first, last in groups])
    orientation = np.sign(np.linalg.det(np.array(p.steps)))
    numbers = tuple(int(orientation * round(x)) for x in sums)
    return Chern(
        groups, numbers, tuple(float(between[k]) for k in ends[:-1]), float(np.abs(sums - np.rint(sums)).max())
    )


def _least_distance(d: Dispersion, k: int, grid: int) -> float:
    """The least distance of band k to the next at one wave number, rad/s, from the grid's local minima on, the least four."""
    from scipy.optimize import minimize

    b = bloch(d.pattern)

    def distance(q: Array) -> float:
        ((_, motion),) = b.motions(q[None])
        rates = np.sort(-motion.roots[0].imag)[motion.freedoms :]
        return float(rates[k + 1] - rates[k]) if len(rates) == d.rates.shape[1] else np.inf

    apart = (d.rates[:, k + 1] - d.rates[:, k]).reshape(grid, grid)
    beside = [np.roll(apart, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    lowest = np.flatnonzero(apart <= np.min(beside, axis=0))
    starts = lowest[np.argsort(apart.ravel()[lowest], kind="stable")][:_STARTS]
    options = {"xatol": 1e-9, "fatol": 1e-12 * d.rates.max(), "maxiter": 200}
    return float(min(minimize(distance, d.q[m], method="Nelder-Mead", options=options).fun for m in starts))


def _check(d: Dispersion) -> None:
    if not d.rates.size:
        raise InputError("chern_numbers: the bars leave no freedom at any wave number: there are no bands")
    if np.isnan(d.rates).any():
        raise InputError(
            "chern_numbers: the bars leave more freedoms at some wave numbers, where they carry a self-stress (often q = 0): "
            "the bands break off there and have no Chern number; put springs for bars"
        )
    if any(d.pattern.friction) or any(brace[4] for brace in d.pattern.braces):
        raise InputError(
            "chern_numbers: friction or damping: the waves are not those of a conserved motion; leave it out"
        )
    if d.falls:
        raise InputError("chern_numbers: a wave falls: the bands are those of a motion that stands")
    if not d.rates.min() > 0:
        raise InputError(
            "chern_numbers: a wave has rate zero, and its band no gap to −q's: give a hinge or braces to ground"
        )


def _flux(d: Dispersion, first: int, last: int, grid: int) -> Array:
    """Berry's phase around each plaquette, (grid, grid), the bands first to last together."""
    b = bloch(d.pattern)
    u = d.shapes[:, first : last + 1].reshape(len(d.q), last + 1 - first, -1)
    M, _, G, _ = np.moveaxis(b.at(d.q)[0].swapaxes(-1, -2), -3, 0)
    momenta = -1j * d.rates[:, first : last + 1, None] * (u @ M) + u @ G / 2
    u, momenta = (each.reshape(grid, grid, *each.shape[1:]) for each in (u, momenta))
    along, across = (_link(u, momenta, axis) for axis in (0, 1))
    loop = along * np.roll(across, -1, 0) * np.roll(along, -1, 1).conj() * across.conj()
    return np.asarray(np.angle(loop))


def _link(u: Complex, momenta: Complex, axis: int) -> Complex:
    """det of the products of the waves at each point with those at the next along an axis, (grid, grid)."""
    other, moved = np.roll(u, -1, axis), np.roll(momenta, -1, axis)
    products = np.einsum("abmi,abni->abmn", u.conj(), moved) - np.einsum("abmi,abni->abmn", momenta.conj(), other)
    return np.asarray(np.linalg.det(1j * products))
