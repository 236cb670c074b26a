"""The linear system of every evaluation: masses bordered by the gradients of the constraints, solved at linear cost.

    [ A⊗1  Gᵀ ] [ r''  ]   [ F ]      G: rows r_i (unit length) and ∓ R d (a bar, d from tip to tip)
    [ G    0  ] [ lam  ] = [ c ]

The unknowns of a rotor and of its bars stand together, the rotors in the order of reverse Cuthill and McKee (1969), so that
chains and rings give a narrow band whatever their length: LU with pivoting in the band (LAPACK's gbsv). Where the band is
wide (grids), sparse LU.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Index, coefficients

_WIDEST = 60  # half bandwidth beyond which sparse LU is faster


@dataclass(frozen=True, eq=False)
class Saddle:
    """Where the entries stand. order (n,): from [r'' (3 N), lam (N), bars (B)] to rows; band: half bandwidth.

    base: the entries that do not change, at `fixed`; `moving`: places of r, and of the two ends' R d, each twice.
    """

    order: Index
    band: int
    fixed: tuple[Index, Index, Array]
    moving: tuple[Index, Index]
    base: Array
    places: Index

    def solve(self, r: Array, pulls: tuple[Array, Array], right: Array) -> Array:
        """The unknowns (s, n, k) of s states with axes r (s, N, 3), gradients of the bars by r_i and r_j (s, B, 3), and right
        sides (s, n, k).

        A singular system gives NaN, for its own state only.
        """
        states, n, k = right.shape
        entries = np.concatenate([each.reshape(states, -1) for each in (r, *pulls)], axis=1)
        b = np.empty_like(right)
        b[:, self.order] = right
        if self.band > _WIDEST:
            x = np.array([self._solve_sparse(*each) for each in zip(entries, b, strict=True)]).reshape(right.shape)
        else:
            ab = np.repeat(self.base.reshape(1, -1), states, axis=0)
            ab[:, self.places] = np.concatenate([entries, entries], axis=1)
            x = in_band(self.band, ab.reshape(states * n, -1), b.reshape(-1, k).copy()).reshape(right.shape)
            if states > 1 and not np.isfinite(x).all():  # one of them is singular, and they were solved as one
                each = (slice(i, i + 1) for i in range(states))
                return np.concatenate([self.solve(r[i], (pulls[0][i], pulls[1][i]), right[i]) for i in each])
        return np.asarray(x[:, self.order])

    def _solve_sparse(self, entries: Array, b: Array) -> Array:
        from scipy.sparse import csc_matrix
        from scipy.sparse.linalg import splu

        rows, columns = (np.concatenate([self.fixed[k], self.moving[k]]) for k in (0, 1))
        values = np.concatenate([self.fixed[2], entries, entries])
        n = len(self.order)
        try:
            return np.asarray(splu(csc_matrix((values, (rows, columns)), shape=(n, n))).solve(b))
        except RuntimeError:  # exactly singular
            return np.full_like(b, np.nan)


@lru_cache(maxsize=64)
def saddle(s: Assembly) -> Saddle:
    """The pattern of a structure's linear system."""
    c = coefficients(s)
    N, B = len(c.R), len(c.i)
    order = _order(N, c.i, c.j)
    axis = np.arange(3 * N).reshape(N, 3)
    unit, bar = 3 * N + np.arange(N), 4 * N + np.arange(B)
    heavy = c.coupling != 0
    i, j = axis[c.i[heavy]], axis[c.j[heavy]]
    rows = np.concatenate([axis.ravel(), i.ravel(), j.ravel()])
    columns = np.concatenate([axis.ravel(), j.ravel(), i.ravel()])
    off = np.repeat(c.coupling[heavy], 3)
    values = np.concatenate([np.repeat(c.A, 3), off, off])
    across = np.concatenate([axis.ravel(), axis[c.i].ravel(), axis[c.j].ravel()])
    down = np.concatenate([np.repeat(unit, 3), np.repeat(bar, 3), np.repeat(bar, 3)])
    fixed = order[rows], order[columns], values
    moving = order[np.concatenate([across, down])], order[np.concatenate([down, across])]
    band = int(max(np.abs(fixed[0] - fixed[1]).max(), np.abs(moving[0] - moving[1]).max()))
    width = 3 * band + 1
    base = np.zeros((len(order), width) if band <= _WIDEST else (0, width))
    if len(base):
        base[fixed[1], 2 * band + fixed[0] - fixed[1]] = values
    places = moving[1] * width + 2 * band + moving[0] - moving[1]
    return Saddle(order, band, fixed, moving, base, places)


def _order(N: int, i: Index, j: Index) -> Index:
    """Row of each unknown: rotors as reverse Cuthill–McKee orders them, a bar between its two rotors."""
    place = narrow_order(N, i, j)
    key = np.concatenate([np.repeat(place, 3).astype(float), place, (place[i] + place[j]) / 2])
    order = np.empty(len(key), dtype=np.intp)
    order[np.argsort(key, kind="stable")] = np.arange(len(key))
    return order


def narrow_order(N: int, i: Index, j: Index) -> Index:
    """Place of each of N that are joined by the pairs i, j, in the order of reverse Cuthill and McKee."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    graph: Any = csr_matrix((np.ones(2 * len(i)), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(N, N))
    place = np.empty(N, dtype=np.intp)
    place[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(N)
    return place


def in_band(band: int, ab: Array, b: Array) -> Array:
    """The solution for the right side b of a band, entry (i, j) of it at ab[j, 2 band + i − j]; NaN where it is singular.

    Overwrites ab and b.
    """
    from scipy.linalg.lapack import dgbsv

    _, _, x, info = dgbsv(band, band, ab.T, b, overwrite_ab=1, overwrite_b=1)
    return np.full_like(b, np.nan) if info else x
