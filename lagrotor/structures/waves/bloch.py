"""Small motion of a pattern at one wave number: the cell's matrices with the phases of its neighbours.

A joint j in the cell n steps away moves as exp(i q . n) times joint j of the cell, turned by n turns. With u' = P(q) u the
cell and its neighbours, Mass, damping, gyroscopic and stiffness matrices are P† … P, the bars' rows are A(q) = rows P, and
the motion is on the null space of A(q). Brillouin, Wave Propagation in Periodic Structures (1946).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Array, Complex, coefficients
from lagrotor.structures.small_motion import Matrix, SmallMotion, bar_rows, matrices, on_freedoms, rank_of
from lagrotor.structures.waves.cell import Cell

_ZERO = 1e-12  # of a bar's largest entry: what is left where phases cancel


@dataclass(frozen=True, eq=False)
class Bloch:
    """parts: mass, damping, gyroscopic, stiffness of the cell with its neighbours, (4, 2 n, 2 n); rows (B, 2 n) of its bars;
    copies (2 n, 2 N): the neighbours as turned copies of the cell's joints; shifts (2 n, d): how many steps away."""

    parts: Array
    rows: Array
    copies: Array
    shifts: Array
    rate: float

    def phases(self, q: Array) -> Complex:
        """P(q), (…, 2 n, 2 N), of wave numbers (…, d)."""
        return np.asarray(np.exp(1j * q @ self.shifts.T)[..., None] * self.copies)

    def at(self, q: Array) -> tuple[Matrix, Matrix]:
        """The four matrices (…, 4, 2 N, 2 N) and the rows (…, B, 2 N) at q (…, d)."""
        P = self.phases(q)
        return _between(P, self.parts, P), self.rows @ P

    def slopes(self, q: Array, k: int) -> tuple[Matrix, Matrix]:
        """Their derivatives by q_k."""
        P = self.phases(q)
        dP = 1j * self.shifts[:, k, None] * P
        return _between(dP, self.parts, P) + _between(P, self.parts, dP), self.rows @ dP

    def motions(self, q: Array) -> Iterator[tuple[NDArray[np.intp], SmallMotion]]:
        """Of the wave numbers q (n_q, d) those at which the bars leave equally many freedoms, by their places in q, and the
        linear systems there."""
        parts, rows = self.at(q)
        rows = np.where(np.abs(rows) < _ZERO * np.abs(self.rows).max(initial=1.0), 0, rows)
        ranks = rank_of(np.linalg.svd(rows, compute_uv=False)) if rows.shape[-2] else np.zeros(len(q), dtype=np.intp)
        for rank in np.unique(ranks):
            (places,) = np.nonzero(ranks == rank)
            yield places, on_freedoms(parts[places], rows[places], self.rate)


def _between(left: Complex, parts: Array, right: Complex) -> Complex:
    """left† part right of each of four parts, (…, 4, 2 N, 2 N)."""
    return np.asarray(left.conj().swapaxes(-1, -2)[..., None, :, :] @ parts @ right[..., None, :, :])


def bloch(p: Cell) -> Bloch:
    """The matrices of a pattern's small motion at any wave number.

    Raises InputError for what `Structure` refuses in a cell and its neighbours.
    """
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
    c = replace(c, A=A, S=S)
    shifts = np.array([*[(0,) * len(p.steps)] * N, *(shift for _, shift in away)], dtype=float)
    copies = np.zeros((len(whose), 2, N, 2))
    angles = shifts[:, 0] * p.turn
    turns = np.array([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]])
    copies[np.arange(len(whose)), :, whose] = turns.transpose(2, 0, 1)
    rate = coefficients(cell).rate
    return Bloch(matrices(c), bar_rows(c), copies.reshape(2 * len(whose), 2 * N), np.repeat(shifts, 2, 0), rate)
