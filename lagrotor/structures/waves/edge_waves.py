"""Waves that run along the border of a strip or a piece, at a rate in a gap of the bulk.

As many more run one way than the other along a border as the Chern numbers of the bands below the gap add up to
(Hatsugai, Phys. Rev. Lett. 71, 3697 (1993)).
"""

from dataclasses import dataclass

import numpy as np

from lagrotor.errors import InputError
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.structure_run import StructureRun
from lagrotor.structures.structure import Structure
from lagrotor.structures.waves.cell import Cell
from lagrotor.structures.waves.dispersion import Dispersion, dispersion


@dataclass(frozen=True, eq=False)
class EdgeWaves:
    """Waves of a strip at one rate: along its first border (the start of the second step) and along the last, those that
    run along the first step less those that run against it; strip: its bands; place (n_q, n_bands): where each wave is, 0 at
    the first border, 1 at the last."""

    first: int
    last: int
    strip: Dispersion
    place: Array


def edge_waves(p: Cell, rate: float, width: int = 16, points: int = 181) -> EdgeWaves:
    """The waves of a strip inside a gap of the bulk.

    Args:
        p: the pattern.
        rate: rad/s.
        width: cells.
        points: wave numbers that are tried.

    Raises:
        InputError: for a pattern with one step.
    """
    d = dispersion(p.strip(width), np.linspace(0, 2 * np.pi, points))
    share = (np.abs(d.shapes) ** 2).sum(-1).reshape(*d.rates.shape, width, -1).sum(-1)
    place = share @ np.arange(width) / share.sum(-1) / max(width - 1, 1)
    above = d.rates > rate
    crossing = above[1:].astype(int) - above[:-1]
    there = (place[1:] + place[:-1]) / 2
    return EdgeWaves(int(crossing[there < 0.5].sum()), int(crossing[there > 0.5].sum()), d, place)


def border_packet(p: Cell, count: int, gap: tuple[float, float]) -> tuple[Structure, Array, Array]:
    """A piece of cells, and tilts and rates (N, 2) at which a packet starts from the middle of its lower border.

    The packet is a push on that rotor, of which the piece's modes at rates in the gap are kept; its largest tilt is 0.01.

    Args:
        p: the pattern.
        count: the piece has count × count cells.
        gap: (lowest, highest), rad/s.

    Raises:
        InputError: where none is in the gap.
    """
    s = p.piece(count, count)
    m, (low, high) = s.modes(), gap
    inside = (m.rates > low) & (m.rates < high)
    if not inside.any():
        raise InputError(
            f"border_packet: {count} × {count} cells have no mode from {low:g} to {high:g} rad/s: take more"
        )
    x = np.array(s.joints) - np.mean(s.joints, axis=0)
    pushed = int(np.argmin(np.hypot(x[:, 0], x[:, 1] - x[:, 1].min())))
    rates, shapes = m.rates[inside], m.shapes[inside]
    parts = np.conj(shapes[:, pushed, 0])[:, None, None] * shapes
    u, v = parts.sum(0), (1j * rates[:, None, None] * parts).sum(0)
    size = 0.01 / np.abs(u).max()
    return s, size * u.real, size * v.real


def way_round(run: StructureRun) -> Array:
    """Angle (n,) of the centre of the squared tilts about the middle of the structure, rad; positive round e_z."""
    x = np.array(run.structure.joints) - np.mean(run.structure.joints, axis=0)
    centre = (run.axes[..., :2] ** 2).sum(-1).T @ x
    return np.unwrap(np.arctan2(centre[:, 1], centre[:, 0]))
