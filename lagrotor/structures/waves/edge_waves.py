"""Waves that run along the border of a strip, at a rate in a gap of the bulk.

As many more run one way than the other along a border as the Chern numbers of the bands below the gap add up to
(Hatsugai, Phys. Rev. Lett. 71, 3697 (1993)).
"""

from dataclasses import dataclass

import numpy as np

from lagrotor.structures.coefficients import Array
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
    """The waves of the strip of `width` cells at a rate (rad/s) inside a gap of the bulk.

    Raises InputError for a pattern with one step.
    """
    d = dispersion(p.strip(width), np.linspace(0, 2 * np.pi, points))
    share = (np.abs(d.shapes) ** 2).sum(-1).reshape(*d.rates.shape, width, -1).sum(-1)
    place = share @ np.arange(width) / share.sum(-1) / max(width - 1, 1)
    above = d.rates > rate
    crossing = above[1:].astype(int) - above[:-1]
    there = (place[1:] + place[:-1]) / 2
    return EdgeWaves(int(crossing[there < 0.5].sum()), int(crossing[there > 0.5].sum()), d, place)
