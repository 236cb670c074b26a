"""Patterns that repeat: waves u e^(i(q.n − ω t)), n the number of the cell, on the freedoms that the bars leave at each q.

    (K(q) − ω² M(q) − i ω C) u + g(q)† lam = 0,   g(q) u = 0,

each bar from a rotor to one `cells` further on entering with e^(i q.cells); q in rad a cell. A ring is a pattern whose
cells
are turned: rotor k of the next cell stands at the angle `turn` further on, and waves are those in the turned axes.
"""

import itertools
from dataclasses import dataclass, field
from functools import lru_cache
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.pair.scene import Link
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Complex, coefficients
from lagrotor.structures.structure import Structure

Joined = tuple[int, int, tuple[int, ...]]
Spring = tuple[int, int, tuple[int, ...], float]
_RANK = 1e-9  # of the largest singular value: a bar's row below it is one of the others


@dataclass(frozen=True)
class Pattern:
    """Rotors and bars that repeat along one vector or two.

    rotors: those of one cell, without bars; vectors: from cell to cell, m; bars: (i, j, cells), from rotor i to rotor j
    `cells` further on; springs: the same and a stiffness, N/m; link: of every bar; turn: of each cell, rad (rings).
    """

    rotors: Assembly
    vectors: tuple[tuple[float, float], ...]
    bars: tuple[Joined, ...] = ()
    springs: tuple[Spring, ...] = ()
    link: Link = field(default_factory=Link)
    turn: float = 0.0

    def __post_init__(self) -> None:
        if self.rotors.bars or self.rotors.braces or any(self.rotors.friction):
            raise InputError("Pattern: give the rotors without bars, braces and friction; bars go to the pattern")
        if len(self.vectors) not in (1, 2) or (self.turn and len(self.vectors) == 2):
            raise InputError(f"Pattern: vectors = {self.vectors!r} must be one or two, one where cells are turned")
        if len({rotor.length for rotor in self.rotors.rotor}) > 1:
            raise InputError("Pattern: the axes must be of one length")
        for i, j, cells in (*self.bars, *(spring[:3] for spring in self.springs)):
            if not (0 <= i < len(self.rotors.joints) > j >= 0 and len(cells) == len(self.vectors)) or (
                i == j and not any(cells)
            ):
                raise InputError(f"Pattern: ({i}, {j}, {cells}) joins no two rotors of the pattern")

    def finite(self, *counts: int) -> Structure:
        """The structure of `counts` cells along the vectors, its outer bars cut off; cell by cell, the last vector first."""
        one, N = self.rotors, len(self.rotors.joints)
        cells = list(np.ndindex(*counts))
        place = {cell: k for k, cell in enumerate(cells)}
        joints = [self.joint(i, cell) for cell in cells for i in range(N)]

        def number(j: int, cell: tuple[int, ...], by: tuple[int, ...]) -> int | None:
            other = place.get(tuple(n + k for n, k in zip(cell, by, strict=True)))
            return None if other is None else other * N + j

        ends = [(place[cell] * N + i, number(j, cell, by)) for cell in cells for i, j, by in self.bars]
        held = [(place[cell] * N + i, number(j, cell, by), k) for cell in cells for i, j, by, k in self.springs]
        every = len(cells)
        return Structure(
            joints=joints,
            bars=[(i, j) for i, j in ends if j is not None],
            spins=one.spins * every,
            rotor=one.rotor * every,
            link=self.link,
            gravity=one.gravity,
            load=one.load * every,
            hinge=one.hinge * every,
            braces=[(i, j, k) for i, j, k in held if j is not None],
        )

    def joint(self, i: int, cell: tuple[int, ...]) -> tuple[float, float]:
        """Where rotor i of a cell stands, m."""
        x, y = self.rotors.joints[i]
        angle = self.turn * cell[0]
        x, y = x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)
        moved = (
            [0.0, 0.0]
            if self.turn
            else [sum(n * v[k] for n, v in zip(cell, self.vectors, strict=True)) for k in (0, 1)]
        )
        return x + moved[0], y + moved[1]

    def direction(self, i: int, j: int, cells: tuple[int, ...]) -> tuple[Array, float]:
        """Unit vector and length of what joins rotor i of cell 0 to rotor j of another."""
        d = np.subtract(self.joint(j, cells), self.joint(i, tuple(0 for _ in cells)))
        return d / np.linalg.norm(d), float(np.linalg.norm(d))


@dataclass(frozen=True, eq=False)
class Bloch:
    """Matrices at one q, (2 n, 2 n): mass, gyroscopic, stiffness, Hermitian but the second, which is anti-Hermitian; rows
    (bars, 2 n) of the bars."""

    mass: Complex
    gyroscopic: Complex
    stiffness: Complex
    rows: Complex

    def freedoms(self) -> Complex:
        """An orthonormal basis (2 n, f) of what the bars leave."""
        if not len(self.rows):
            return np.eye(len(self.mass), dtype=complex)
        _, sizes, right = np.linalg.svd(self.rows)
        return right[int((sizes > _RANK * max(1.0, sizes[0])).sum()) :].conj().T


@lru_cache(maxsize=16)
def _own(p: Pattern) -> tuple[Array, Array, Array]:
    """A_ii, G_i and the stiffness hinge − g S of each rotor of a cell, bars included."""
    c = coefficients(p.rotors)
    A, S = c.A.copy(), c.S.copy()
    for i, j, cells in p.bars:
        _, ell = p.direction(i, j, cells)
        for end in (i, j):
            A[end] += c.R[end] ** 2 * (p.link.mass / 4 + p.link.inertia / ell**2)
            S[end] += c.R[end] * p.link.mass / 2
    return A, c.G, c.hinge - c.gravity * S


def bloch(p: Pattern, q: ArrayLike) -> Bloch:
    """The matrices of a pattern at q (one phase a vector, rad)."""
    phases = np.atleast_1d(np.asarray(q, dtype=float))
    if phases.shape != (len(p.vectors),) or not np.isfinite(phases).all():
        raise InputError(f"dispersion: q = {q!r} must be {len(p.vectors)} finite phases in rad a cell")
    A, G, K_own = _own(p)
    n, R = len(A), p.rotors.rotor[0].length
    M, K = (np.kron(np.diag(part), np.eye(2)).astype(complex) for part in (A, K_own))
    C = np.kron(np.diag(G), [[0, 1], [-1, 0]]).astype(complex)
    rows = np.zeros((len(p.bars), 2 * n), dtype=complex)

    def there(cells: tuple[int, ...]) -> Complex:
        """What takes u of the cell 0 to u of another, in the axes of the first: the phase, and the turn."""
        angle = p.turn * cells[0]
        turned = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        return turned * np.exp(1j * phases @ np.array(cells))

    for row, (i, j, cells) in zip(rows, p.bars, strict=True):
        along, ell = p.direction(i, j, cells)
        row[2 * i : 2 * i + 2] += along
        row[2 * j : 2 * j + 2] -= along @ there(cells)
        coupling = R**2 * (p.link.mass / 4 - p.link.inertia / ell**2)
        M[2 * i : 2 * i + 2, 2 * j : 2 * j + 2] += coupling * there(cells)
        M[2 * j : 2 * j + 2, 2 * i : 2 * i + 2] += coupling * there(cells).conj().T
    for i, j, cells, stiffness in p.springs:
        along, _ = p.direction(i, j, cells)
        row = np.zeros(2 * n, dtype=complex)
        row[2 * i : 2 * i + 2] += R * along
        row[2 * j : 2 * j + 2] -= R * along @ there(cells)
        K += stiffness * np.outer(row.conj(), row)
    return Bloch(M, C, K, rows)


def path(corners: ArrayLike, steps: int) -> NDArray[np.float64]:
    """q (m, vectors) along straight lines from corner to corner, `steps` each."""
    points = np.asarray(corners, dtype=float)
    lines = [np.linspace(a, b, steps, endpoint=False) for a, b in itertools.pairwise(points)]
    return np.concatenate([*lines, points[-1:]])
