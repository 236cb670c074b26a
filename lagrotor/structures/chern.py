"""Chern numbers of bands over two phases: Fukui, Hatsugai & Suzuki (J. Phys. Soc. Jpn. 74, 2005).

In (K^½ u, M^½ u'), whose square is twice the energy, waves are those of the Hermitian matrix

    H(q) = [[0, i K^½ M^-½], [−i M^-½ K^½, −i M^-½ C M^-½]]

on the freedoms that the bars leave. It needs K > 0, a gap on both sides of the band, and as many freedoms at every q.
Gyroscopes joined by springs on a honeycomb: Nash et al., PNAS 112 (2015) 14495.
"""

import numpy as np

from lagrotor.errors import InputError
from lagrotor.structures.coefficients import Array, Complex
from lagrotor.structures.periodic import Bloch, Pattern, bloch

_TOUCH = 1e-6  # of the largest rate: bands nearer to each other touch


def chern_numbers(p: Pattern, mesh: int = 24) -> tuple[int, ...]:
    """The Chern number of each band of positive rate, slowest first, on a mesh × mesh of phases.

    Raises InputError where the pattern has one vector, its freedoms change with q, K is not positive, or bands touch.
    """
    if len(p.vectors) != 2:
        raise InputError("chern_numbers: a pattern with two vectors is needed")
    phases = 2 * np.pi * (np.arange(mesh) + 0.5) / mesh
    frames = [[_frame(bloch(p, (a, b))) for b in phases] for a in phases]
    if len({vectors.shape for row in frames for _, vectors in row}) > 1 or bloch(p, (0, 0)).freedoms().shape[
        1
    ] * 2 != len(frames[0][0][0]):
        raise InputError(
            "chern_numbers: the bars leave different freedoms at different q (as a whole at q = 0): no bundle"
        )
    rates = np.array([[w for w, _ in row] for row in frames])
    half = rates.shape[2] // 2
    positive = rates[..., half:]
    for k in range(positive.shape[2] - 1):
        least = _least_gap(
            p, half + k, phases[list(np.unravel_index(np.argmin(np.diff(positive)[..., k]), (mesh, mesh)))]
        )
        if least < _TOUCH * positive.max():
            raise InputError(f"chern_numbers: bands {k} and {k + 1} touch: neither has a number")
    return tuple(
        _chern(np.array([[v[:, half + k] for _, v in row] for row in frames])) for k in range(positive.shape[2])
    )


def _least_gap(p: Pattern, k: int, start: Array) -> float:
    """The least distance of bands k and k + 1 of H near phases (2,)."""
    from scipy.optimize import minimize

    def gap(q: Array) -> float:
        rates, _ = _frame(bloch(p, q))
        return float(rates[k + 1] - rates[k])

    return float(minimize(gap, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}).fun)


def _frame(part: Bloch) -> tuple[Array, Complex]:
    """Rates and vectors of H in a gauge that depends on q smoothly: in the full (u, u') of the cell."""
    basis = part.freedoms()
    M, C, K = (basis.conj().T @ each @ basis for each in (part.mass, part.gyroscopic, part.stiffness))
    stiff, vectors = np.linalg.eigh(K)
    if stiff[0] <= 0:
        raise InputError("chern_numbers: K is not positive at some q: give springs or hinges that hold every freedom")
    root_K = (vectors * np.sqrt(stiff)) @ vectors.conj().T
    heavy, vectors = np.linalg.eigh(M)
    root_M = (vectors / np.sqrt(heavy)) @ vectors.conj().T
    across = 1j * root_K @ root_M
    H = np.block([[np.zeros_like(K), across], [across.conj().T, -1j * root_M @ C @ root_M]])
    rates, states = np.linalg.eigh(H)
    f = len(K)
    return rates, np.vstack([basis @ states[:f], basis @ states[f:]])


def _chern(v: Complex) -> int:
    """From the vectors (m, m, d) of a band over the torus: the sum of the phases around each plaquette, over 2π."""
    right, up = np.roll(v, -1, axis=0), np.roll(v, -1, axis=1)
    corner = np.roll(right, -1, axis=1)

    def link(a: Complex, b: Complex) -> Complex:
        return np.asarray((a.conj() * b).sum(-1))

    around = link(v, right) * link(right, corner) * link(corner, up) * link(up, v)
    return round(float(np.angle(around).sum() / (2 * np.pi)))
