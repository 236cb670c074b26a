"""Small motion of a pattern at one wave number: the cell's matrices with the phases of its neighbours.

A joint j in the cell n steps away moves as exp(i q . n) times joint j of the cell, turned by n turns. Mass, damping,
gyroscopic and stiffness matrices are sums of exp(i q . n) X_n over cells n steps apart, the bars' rows are A(q), a sum alike,
and the motion is on the null space of A(q). Brillouin, Wave Propagation in Periodic Structures (1946).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Array, Coefficients, coefficients
from lagrotor.structures.small_motion import Matrix, SmallMotion, bar_rows, left_by, matrices, on_basis
from lagrotor.structures.waves.cell import Cell, Shift, Site

_ZERO = 1e-12  # of a bar's largest entry: what is left where phases cancel


@dataclass(frozen=True, eq=False)
class Bloch:
    """parts (k, 4, 2 N, 2 N): mass, damping, gyroscopic, stiffness between cells that are apart (k, d) steps from each other;
    rows (m, B, 2 N): those of the cell's bars on the cells that are away (m, d) steps."""

    parts: Array
    apart: Array
    rows: Array
    away: Array
    rate: float
    inertia: bool = True

    def at(self, q: Array) -> tuple[Matrix, Matrix]:
        """The four matrices (…, 4, 2 N, 2 N) and the rows (…, B, 2 N) at q (…, d), zero where phases cancel."""
        rows = _wave_sum(q, self.away, self.rows)
        small = np.abs(rows) < _ZERO * np.abs(self.rows).max(initial=1.0)
        return _wave_sum(q, self.apart, self.parts), np.where(small, 0, rows)

    def motions(self, q: Array) -> Iterator[tuple[NDArray[np.intp], SmallMotion]]:
        """Of the wave numbers q (n_q, d) those at which the bars leave equally many degrees of freedom, by their places in q,
        and the linear systems there."""
        parts, rows = self.at(q)
        ranks, vectors = left_by(rows)
        for rank in np.unique(ranks):
            (places,) = np.nonzero(ranks == rank)
            motion = on_basis(parts[places], vectors[places, :, rank:], self.rate)
            yield places, motion if self.inertia else motion.without_inertia


def _wave_sum(q: Array, steps: Array, parts: Array) -> Matrix:
    """The sum of exp(i q . n) X_n."""
    return np.asarray(np.tensordot(np.exp(1j * q @ steps.T), parts, 1))


def bloch(p: Cell) -> Bloch:
    """The matrices of a pattern's small motion at any wave number.

    Raises:
        InputError: for what `Structure` refuses in a cell and its neighbours.
    """
    away, (c, rate) = p.neighbours, cell_coefficients(p)
    places = dict.fromkeys([(0,) * len(p.steps), *(shift for _, shift in away)])
    of = {place: _copies(p, away, place) for place in places}
    whole, rows = matrices(c), bar_rows(c)
    parts = dict[tuple[int, ...], Array]()
    for (one, left), (other, right) in product(of.items(), repeat=2):
        apart = tuple(b - a for a, b in zip(one, other, strict=True))
        parts[apart] = parts.get(apart, 0) + left.T @ whole @ right
    between = np.array([*parts.values()])
    between[:, 0] *= p.inertia
    return Bloch(
        between,
        np.array([*parts], dtype=float),
        np.array([rows @ copies for copies in of.values()]),
        np.array([*of], dtype=float),
        rate,
        p.inertia,
    )


def cell_coefficients(p: Cell) -> tuple[Coefficients, float]:
    """The numbers of one cell, the joints of other cells to which its bars and braces lead after its own; the rate of all."""
    N, away = len(p.joints), p.neighbours
    whose = np.array([*range(N), *(j for j, _ in away)])
    number = {(j, shift): N + k for k, (j, shift) in enumerate(away)}

    def end(j: int, shift: tuple[int, ...]) -> int:
        return number.get((j, shift), j)

    bars: Any = tuple((i, end(j, shift)) for i, j, shift in p.bars)
    own = {name: (*getattr(p, name), *[0.0] * len(away)) for name in ("spins", "load", "friction", "hinge")}
    cell = Assembly(
        joints=(*p.joints, *(p.place(site) for site in away)),
        bars=bars,
        rotor=tuple(p.rotor[j] for j in whose),
        link=p.link,
        gravity=p.gravity,
        braces=tuple(Brace(i, end(j, shift), k, d) for i, j, shift, k, d in p.braces),
        **own,
    )
    c, copied = coefficients(cell), np.arange(len(whose)) >= N
    # A neighbour has its own rotor's inertia and weight in its own cell: here only the bars' share is left.
    A = c.A - copied * [rotor.J for rotor in cell.rotor]
    S = c.S - copied * [rotor.mass * rotor.length / 2 for rotor in cell.rotor]
    return replace(c, A=A, S=S), c.rate


def _copies(p: Cell, away: tuple[Site, ...], place: Shift) -> Array:
    """The joints of the cell at one place as turned copies of the pattern's, (2 n, 2 N), the others zero."""
    N = len(p.joints)
    copies = np.zeros((N + len(away), 2, N, 2))
    c, s = cos(place[0] * p.turn), sin(place[0] * p.turn)
    for k, (j, shift) in enumerate([*((j, (0,) * len(p.steps)) for j in range(N)), *away]):
        if shift == place:
            copies[k, :, j] = [[c, -s], [s, c]]
    return copies.reshape(2 * len(copies), 2 * N)
