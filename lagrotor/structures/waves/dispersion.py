"""The bands of a pattern: rates against wave number, growth, gaps, zero bands, and speeds of long waves.

A joint j in the cell n steps away moves as exp(i q . n) times joint j of the cell, rotated by n turns. Mass, damping,
gyroscopic and stiffness matrices are sums of exp(i q . n) X_n over cells n steps apart. The constraint rows A(q) of the bars
are such a sum, too, and the motion lies in the null space of A(q). Brillouin, Wave Propagation in Periodic Structures (1946).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.numerics.arrays import finite_array
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Array, Coefficients, Complex, coefficients
from lagrotor.structures.small_motion import Matrix, SmallMotion, bar_rows, left_by, matrices, on_basis
from lagrotor.structures.waves.cell import Cell, Shift, Site

_SAME = 1e-9  # relative to the largest rate: smaller differences are zero
_TOGETHER = 64  # wave numbers per batch
_SMALL = 1e-3  # the largest wave number of long waves, rad per cell
_ZERO = 1e-12  # relative to the largest entry: the rounding where phases cancel


@dataclass(frozen=True, eq=False)
class Bloch:
    """The matrices of a pattern's small motion at any wave number.

    - `blocks`: the mass, damping, gyroscopic and stiffness matrices between two cells, (k, 4, 2N, 2N).
    - `apart`: the number of steps between these two cells, (k, d).
    - `rows`: the constraint rows of the cell's bars that act on another cell, (m, B, 2N).
    - `away`: the number of steps to this other cell, (m, d).
    - `rate`: the unit of rate, rad/s. `inertia` is False for the limit without inertia.
    """

    blocks: Array
    apart: Array
    rows: Array
    away: Array
    rate: float
    inertia: bool = True

    def at(self, q: Array) -> tuple[Matrix, Matrix]:
        """Return the four matrices (…, 4, 2N, 2N) and the constraint rows (…, B, 2N) at wave numbers q (…, d). Entries of the
        rows in which phases cancel up to rounding are set to zero."""
        rows = _wave_sum(q, self.away, self.rows)
        small = np.abs(rows) < _ZERO * np.abs(self.rows).max(initial=1.0)
        return _wave_sum(q, self.apart, self.blocks), np.where(small, 0, rows)

    def motions(self, q: Array) -> Iterator[tuple[NDArray[np.intp], SmallMotion]]:
        """Group the wave vectors q, shape (n_q, d), by their number of degrees of freedom.

        Each group gives (places, system): the indices of its wave vectors, and the system at these, along its leading axis.
        """
        forms, rows = self.at(q)
        ranks, vectors = left_by(rows)
        for rank in np.unique(ranks):
            (places,) = np.nonzero(ranks == rank)
            motion = on_basis(forms[places], vectors[places, :, rank:], self.rate)
            yield places, motion if self.inertia else motion.without_inertia


def _wave_sum(q: Array, steps: Array, blocks: Array) -> Matrix:
    """Return the sum over k blocks X_n of exp(i q . n) X_n, with the steps n (k, d)."""
    return np.asarray(np.tensordot(np.exp(1j * q @ steps.T), blocks, 1))


def bloch(p: Cell) -> Bloch:
    """Return the matrices of a pattern's small motion at any wave number."""
    away, (c, rate) = p.neighbours, cell_coefficients(p)
    places = dict.fromkeys([(0,) * len(p.steps), *(shift for _, shift in away)])
    of = {place: _copies(p, away, place) for place in places}
    whole, rows = matrices(c), bar_rows(c)
    blocks = dict[tuple[int, ...], Array]()
    for (start, left_copies), (end, right_copies) in product(of.items(), repeat=2):
        shift = tuple(b - a for a, b in zip(start, end, strict=True))
        blocks[shift] = blocks.get(shift, 0) + left_copies.T @ whole @ right_copies
    between = np.array([*blocks.values()])
    between[:, 0] *= p.inertia
    apart, away_rows = np.array([*blocks], dtype=float), np.array([rows @ copies for copies in of.values()])
    return Bloch(between, apart, away_rows, np.array([*of], dtype=float), rate, p.inertia)


def cell_coefficients(p: Cell) -> tuple[Coefficients, float]:
    """Return the coefficients of one cell and of the joints in other cells that its bars and braces reach, and a rate. The
    joints of the cell come first. The rate (rad/s) is `Coefficients.rate` of all these joints."""
    N, away = len(p.joints), p.neighbours
    whose = np.array([*range(N), *(j for j, _ in away)])
    number = {(j, shift): N + k for k, (j, shift) in enumerate(away)}

    def end(j: int, shift: tuple[int, ...]) -> int:
        return number.get((j, shift), j)

    bars: Any = tuple((i, end(j, shift)) for i, j, shift in p.bars)
    loads = {name: (*getattr(p, name), *[0.0] * len(away)) for name in ("spins", "load", "friction", "hinge")}
    cell = Assembly(
        joints=(*p.joints, *(p.place(site) for site in away)), bars=bars, rotor=tuple(p.rotor[j] for j in whose),
        link=p.link, gravity=p.gravity, braces=tuple(Brace(i, end(j, shift), k, d) for i, j, shift, k, d in p.braces),
        **loads,
    )  # fmt: skip
    c, copied = coefficients(cell), np.arange(len(whose)) >= N
    # The rotors of neighbours belong to their cells: only the bars contribute here.
    A = c.A - copied * [rotor.J for rotor in cell.rotor]
    S = c.S - copied * [rotor.mass * rotor.length / 2 for rotor in cell.rotor]
    return replace(c, A=A, S=S), c.rate


def _copies(p: Cell, away: tuple[Site, ...], place: Shift) -> Array:
    """Return the matrix (2n, 2N) that copies the tilts of the N joints, rotated, to the joints in the cell at `place`. Its rows
    are those of `cell_coefficients`, with n joints. Rows of joints in other cells are zero."""
    N = len(p.joints)
    copies = np.zeros((N + len(away), 2, N, 2))
    c, s = cos(place[0] * p.turn), sin(place[0] * p.turn)
    for k, (j, shift) in enumerate([*((j, (0,) * len(p.steps)) for j in range(N)), *away]):
        if shift == place:
            copies[k, :, j] = [[c, -s], [s, c]]
    return copies.reshape(2 * len(copies), 2 * N)


@dataclass(frozen=True, eq=False, repr=False)
class Dispersion(Shown):
    """The waves u = Re(shape exp(i (q . n − rate t) + growth t)) of cell n, at q (n_q, d) in rad per cell.

    The half of the roots with the larger rates is kept. The other half are the conjugate waves of −q.

    - `rates`: the rates of the bands, (n_q, n_bands), ascending, rad/s. A row with fewer bands than n_bands ends in nan.
    - `growth`: the growth rates, (n_q, n_bands), 1/s.
    - `shapes`: the x and y of each axis, (n_q, n_bands, N, 2), of unit norm.
    - `dof`: the number of bands at each q, (n_q,).
    - `zero_bands`: the number of degrees of freedom on which no spin, spring or weight acts. It is counted at the wave
      numbers with the fewest degrees of freedom.
    """

    pattern: Cell
    q: Array
    rates: Array
    growth: Array
    shapes: Complex
    dof: Array
    zero_bands: int

    def summary(self) -> dict[str, str]:
        """Return bands, gaps and growth in words."""
        gaps = ", ".join(f"{low:.4g} to {high:.4g}" for low, high in self.gaps) or "none"
        return {
            "wave numbers": str(len(self.q)),
            "bands": f"{self.rates.shape[1]}, of them {self.zero_bands} without a rate",
            "gaps [rad/s]": gaps,
            "falls": "yes" if self.falls else "no",
        }

    @property
    def gaps(self) -> tuple[tuple[float, float], ...]:
        """The intervals (low, high) of rates, rad/s, from zero to the highest rate, in which no wave of these q lies."""
        if not self.rates.size:
            return ()
        low, high = np.nanmin(self.rates, axis=0), np.nanmax(self.rates, axis=0)
        gaps, top = [], 0.0
        for k in np.argsort(low):
            if low[k] > top + _SAME * high.max():
                gaps.append((float(top), float(low[k])))
            top = max(top, high[k])
        return tuple(gaps)

    @property
    def falls(self) -> bool:
        """True if some wave at these q grows."""
        return bool((self.growth > 0).any())


def dispersion(p: Cell, q: ArrayLike) -> Dispersion:
    """Compute the bands at the wave numbers q: see `Pattern.dispersion`."""
    d = len(p.steps)
    points = finite_array("dispersion: q", q)
    points = points[:, None] if points.ndim == 1 and d == 1 else points
    if points.ndim != 2 or points.shape[1] != d or not len(points):
        raise InputError(f"dispersion: q must be numbers (n_q, {d}) in rad per cell, not of shape {points.shape}")
    b, size = bloch(p), 2 * len(p.joints)
    rates, growth = np.full((2, len(points), size), np.nan)
    shapes = np.full((len(points), size, size), np.nan, dtype=complex)
    dof, still = np.zeros(len(points), dtype=int), dict[int, int]()
    for first in range(0, len(points), _TOGETHER):
        for places, motion in b.motions(points[first : first + _TOGETHER]):
            indices, f = first + places, motion.bands
            dof[indices], still[f] = f, min(still.get(f, f), _still(motion))
            if f:
                s, vectors = motion.waves
                u = (motion.basis @ vectors).swapaxes(-1, -2)
                u = u / np.linalg.norm(u, axis=-1, keepdims=True)
                rates[indices, :f], growth[indices, :f], shapes[indices, :f] = _faster(s, u)
    n = int(dof.max())
    bands = shapes[:, :n].reshape(len(points), n, len(p.joints), 2)
    return Dispersion(p, points, rates[:, :n], growth[:, :n], bands, dof, still[min(still)])


def _still(motion: SmallMotion) -> int:
    """Return the least number, over the wave numbers, of degrees of freedom without stiffness, gyroscopic force and damping."""
    acting = np.concatenate(
        [motion.stiffness / motion.rate**2, (motion.gyroscopic + motion.damping) / motion.rate], axis=-2
    )
    if not motion.dof:
        return 0
    least = _SAME * np.maximum(1.0, np.abs(motion.mass).max((-2, -1)))
    return int(motion.dof - np.linalg.matrix_rank(acting, tol=least).max())


def _faster(s: Complex, shapes: Complex) -> tuple[Array, Array, Complex]:
    """Return the half of the waves with the larger rates, ascending: rates and growth (n_q, f), and shapes (n_q, f, 2N)."""
    half = np.lexsort((s.real, -s.imag), axis=-1)[:, s.shape[-1] // 2 :]
    s = np.take_along_axis(s, half, -1)
    return 0.0 - s.imag, s.real, np.take_along_axis(shapes, half[..., None], -2)


def long_wave_speeds(p: Cell, direction: ArrayLike = (1.0,)) -> Array:
    """Return the speeds of long waves: see `Pattern.long_wave_speeds`."""
    unit = np.asarray(direction, dtype=float)
    unit = unit / np.abs(unit).max()
    k = np.linalg.norm(np.linalg.lstsq(np.array(p.steps), unit, rcond=None)[0])
    half, whole = dispersion(p, np.array([[_SMALL / 2], [_SMALL]]) * unit).rates
    linear = (half > 0) & (np.abs(whole / np.where(half > 0, 2 * half, 1) - 1) < 1e-3)
    return np.asarray((8 * half - whole)[linear] / (3 * _SMALL * k))
