"""Chern numbers of the bands of a pattern in the plane, and the number of waves along its edge.

Fukui, Hatsugai & Suzuki, J. Phys. Soc. Jpn. 74, 1674 (2005): the flux of Berry's phase through each plaquette of a grid of wave
numbers, summed over the bands of a group, is 2π times an integer. The product of two waves is the symplectic one: with momenta
p = M u' + C u/2, i (u_1† p_2 − p_1† u_2). The motion conserves it, and it is positive for waves of positive rate about a stable
equilibrium (Shindou et al., Phys. Rev. B 87, 174427 (2013); gyroscopes: Nash et al., PNAS 112, 14495 (2015)). At a rate in a
gap of the bulk, the waves along a border in one direction outnumber those in the other by the sum of the Chern numbers of the
bands below the gap (Hatsugai, Phys. Rev. Lett. 71, 3697 (1993)).
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lagrotor.errors import InputError
from lagrotor.renamed import old_attribute
from lagrotor.structures.coefficients import Array, Complex
from lagrotor.structures.waves.cell import Cell
from lagrotor.structures.waves.dispersion import Dispersion, bloch, dispersion

_APART = 1e-6  # relative to the highest rate: bands with a smaller distance belong to one group
_STARTS = 4  # starts of the search, the wave numbers with the least distances on the grid


@dataclass(frozen=True)
class Chern:
    """The Chern numbers of a pattern, `numbers`, for groups of bands, each (first, last), that touch no other band.

    apart: the least distance (rad/s) from each group to the next at one wave number; flux_error: the largest distance of a
    flux sum from an integer.
    """

    groups: tuple[tuple[int, int], ...]
    numbers: tuple[int, ...]
    apart: tuple[float, ...]
    flux_error: float

    if not TYPE_CHECKING:
        __getattr__ = old_attribute


def chern_numbers(p: Cell, grid: int = 24) -> Chern:
    """Compute the Chern number of each group of bands: see `Pattern.chern_numbers`."""
    if len(p.steps) != 2:
        raise InputError("chern_numbers: the pattern repeats along one step: a Chern number needs two")
    points = 2 * np.pi * np.arange(grid) / grid
    q = np.stack(np.meshgrid(points, points, indexing="ij"), axis=-1).reshape(-1, 2)
    d = dispersion(p, q)
    _check(d)
    n = d.rates.shape[1]
    between = _least_distances(d, grid)
    ends = [k for k in range(n) if k == n - 1 or between[k] > _APART * d.rates.max()]
    groups = tuple(zip([0, *(k + 1 for k in ends[:-1])], ends, strict=True))
    sums = np.array([_flux(d, first, last, grid).sum() / (2 * np.pi) for first, last in groups])
    orientation = np.sign(np.linalg.det(np.array(p.steps)))
    numbers = tuple(int(orientation * round(x)) for x in sums)
    return Chern(
        groups, numbers, tuple(float(between[k]) for k in ends[:-1]), float(np.abs(sums - np.rint(sums)).max())
    )


def _least_distances(d: Dispersion, grid: int) -> Array:
    """Return the least distance of each band but the last to the next, rad/s, sought from the least on the grid."""
    from scipy.optimize import minimize

    b, n = bloch(d.pattern), d.rates.shape[1]
    corners, highest = np.array([[0, 0], [1, 0], [0, 1]]) * np.pi / grid, float(d.rates.max())

    def apart(q: Array, band: int) -> float:
        ((_, motion),) = b.motions(q[None])
        if motion.bands != n:  # another number of degrees of freedom
            return highest
        rates = np.sort(-motion.roots.imag[0])[n:]
        return float(rates[band + 1] - rates[band])

    def least(band: int, starts: Array) -> float:
        options = {"xatol": 1e-9, "fatol": 1e-12 * highest}
        return min(
            float(minimize(apart, q, (band,), "Nelder-Mead", options=options | {"initial_simplex": q + corners}).fun)
            for q in starts
        )

    nearest = np.argsort(np.diff(d.rates, axis=1), axis=0, kind="stable")[:_STARTS]
    return np.array([least(band, d.q[places]) for band, places in enumerate(nearest.T)])


def _check(d: Dispersion) -> None:
    if not d.rates.size:
        raise InputError(
            "chern_numbers: no degree of freedom remains with the bars at any wave number: there are no bands"
        )
    if np.isnan(d.rates).any():
        raise InputError(
            "chern_numbers: at some wave numbers the bars carry a self-stress (often q = 0), and there are more degrees of "
            "freedom: the bands end there and have no Chern number; replace the bars by springs"
        )
    if any(d.pattern.friction) or any(brace[4] for brace in d.pattern.braces):
        raise InputError("chern_numbers: with friction or damping the motion conserves no energy; set them to zero")
    if d.falls:
        raise InputError("chern_numbers: a wave grows: Chern numbers need a stable pattern")
    if not d.rates.min() > 0:
        raise InputError(
            "chern_numbers: a wave has rate zero, and no gap separates its band from those of −q: give hinges"
        )


def _flux(d: Dispersion, first: int, last: int, grid: int) -> Array:
    """Return Berry's phase around each plaquette, (grid, grid), of the bands first to last together."""
    b = bloch(d.pattern)
    u = d.shapes[:, first : last + 1].reshape(len(d.q), last + 1 - first, -1)
    M, _, G, _ = np.moveaxis(b.at(d.q)[0].swapaxes(-1, -2), -3, 0)
    momenta = -1j * d.rates[:, first : last + 1, None] * (u @ M) + u @ G / 2
    u, momenta = (array.reshape(grid, grid, *array.shape[1:]) for array in (u, momenta))
    links_1, links_2 = (_link(u, momenta, axis) for axis in (0, 1))
    loop = links_1 * np.roll(links_2, -1, 0) * np.roll(links_1, -1, 1).conj() * links_2.conj()
    return np.asarray(np.angle(loop))


def _link(u: Complex, momenta: Complex, axis: int) -> Complex:
    """Return det of the products of the waves at each point with those at the next along an axis, (grid, grid)."""
    next_u, next_momenta = np.roll(u, -1, axis), np.roll(momenta, -1, axis)
    products = np.einsum("abmi,abni->abmn", u.conj(), next_momenta) - np.einsum(
        "abmi,abni->abmn", momenta.conj(), next_u
    )
    return np.asarray(np.linalg.det(1j * products))


@dataclass(frozen=True, eq=False)
class EdgeWaves:
    """The waves of a strip at one rate: along its first border (the start of the second step) and along its last one.

    first, last: the number of waves along the first step minus that against it; strip: the bands; place (n_q, n_bands): the
    position of each wave, 0 at the first border and 1 at the last.
    """

    first: int
    last: int
    strip: Dispersion
    place: Array


def edge_waves(p: Cell, rate: float, width: int = 16, points: int = 181) -> EdgeWaves:
    """Count the waves of a strip in a gap of the bulk: see `Pattern.edge_waves`."""
    d = dispersion(p.strip(width), np.linspace(0, 2 * np.pi, points))
    share = (np.abs(d.shapes) ** 2).sum(-1).reshape(*d.rates.shape, width, -1).sum(-1)
    place = share @ np.arange(width) / share.sum(-1) / max(width - 1, 1)
    above = d.rates > rate
    crossing = above[1:].astype(int) - above[:-1]
    crossing_place = (place[1:] + place[:-1]) / 2
    return EdgeWaves(int(crossing[crossing_place < 0.5].sum()), int(crossing[crossing_place > 0.5].sum()), d, place)
