"""Dispersion relations of patterns: bands, gaps, zero bands, group velocity."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.structures.coefficients import Array, Complex
from lagrotor.structures.periodic import Bloch, Pattern, bloch
from lagrotor.structures.small_motion import ZERO

_STEP = 1e-5  # rad a cell: of the differences in q


@dataclass(frozen=True, eq=False)
class Bands:
    """q (m, vectors); rates (m, b) in rad/s, sorted, of e^(i(q.n − ω t)), both signs; growth (m, b), 1/s.

    velocity (m, vectors, b): dω/dq, cells a second, NaN where bands meet or grow. zero: how many bands are zero at every q.
    """

    q: Array
    rates: Array
    growth: Array
    velocity: Array
    zero: int

    def gaps(self) -> list[tuple[float, float]]:
        """Intervals of positive rates without a wave, between bands, (from, to) in rad/s."""
        low, high = self.rates.min(axis=0), self.rates.max(axis=0)
        between = zip(np.maximum(high[:-1], 0.0), low[1:], strict=True)
        return [(float(left), float(right)) for left, right in between if right > left + 1e-9 * high[-1]]


def dispersion(p: Pattern, q: ArrayLike) -> Bands:
    """The bands of a pattern at q (m,) or (m, vectors), in rad a cell.

    The number of bands is twice that of the freedoms which the bars leave. Raises InputError where it is not the
    same at all q
    (at q = 0 rigid bars leave more: a structure moves as a whole), or none is left.
    """
    points = np.asarray(q, dtype=float)
    points = points.reshape(len(points) if points.ndim else 1, -1)
    parts = [bloch(p, each) for each in points]
    bases = [part.freedoms() for part in parts]
    counts = {basis.shape[1] for basis in bases}
    if len(counts) > 1 or not max(counts):
        raise InputError(
            f"dispersion: the bars leave {' or '.join(map(str, sorted(counts)))} freedoms a cell at these q: "
            "leave out those where "
            "more move, as at q = 0 the structure as a whole, or take out bars where there are none"
        )
    found = [_roots(part, basis) for part, basis in zip(parts, bases, strict=True)]
    roots = np.array([s for s, _ in found])
    rates, growth = -roots.imag, roots.real
    order = np.argsort(rates, axis=1, kind="stable")
    rates, growth = (np.take_along_axis(part, order, axis=1) for part in (rates, growth))
    velocity = np.array(
        [
            _velocity(p, point, part, s[k], u[:, k])
            for point, part, (s, u), k in zip(points, parts, found, order, strict=True)
        ]
    )
    return Bands(points, rates, growth, velocity, int((np.abs(rates + 1j * growth).max(axis=0) == 0).sum()))


def _roots(part: Bloch, basis: Complex) -> tuple[Complex, Complex]:
    """Roots s = growth − i ω and vectors u (2 n, b)."""
    M, C, K = (basis.conj().T @ each @ basis for each in (part.mass, part.gyroscopic, part.stiffness))
    f = len(M)
    below = np.linalg.solve(M, np.hstack([-K, -C]))
    s, vectors = np.linalg.eig(np.vstack([np.hstack([np.zeros((f, f)), np.eye(f)]), below]))
    size = max(float(np.abs(s).max()), 1e-300)
    s = np.where(np.abs(s.real) < ZERO * size, 1j * s.imag, s)
    s = np.where(np.abs(s.imag) < ZERO * size, s.real, s) + 0j
    return s, basis @ vectors[:f]


def _velocity(p: Pattern, q: Array, part: Bloch, s: Complex, u: Complex) -> Array:
    """dω/dq (vectors, b): by first-order perturbation of the Hermitian pencil bordered by the bars."""
    w = -s.imag
    found = np.full((len(q), len(s)), np.nan)
    turning = np.flatnonzero((s.real == 0) & (w != 0))
    turning = np.array(
        [k for k in turning if np.abs(np.delete(w, k) - w[k]).min(initial=np.inf) > 1e-6 * abs(w[k])], dtype=int
    )
    for axis in range(len(q)):
        step = np.zeros(len(q))
        step[axis] = _STEP
        after, before = bloch(p, q + step), bloch(p, q - step)
        for k in turning:
            x, rate = u[:, k], w[k]
            held = (part.stiffness - rate**2 * part.mass - 1j * rate * part.gyroscopic) @ x
            lam = -np.linalg.lstsq(part.rows.conj().T, held, rcond=None)[0] if len(part.rows) else held[:0]
            slope = _form(after, rate, x, lam) - _form(before, rate, x, lam)
            by_rate = -2 * rate * (x.conj() @ part.mass @ x) - 1j * (x.conj() @ part.gyroscopic @ x)
            found[axis, k] = -(slope / (2 * _STEP) / by_rate).real
    return found


def _form(part: Bloch, rate: float, x: Complex, lam: NDArray[Any]) -> complex:
    own = x.conj() @ (part.stiffness - rate**2 * part.mass - 1j * rate * part.gyroscopic) @ x
    return complex(own + 2 * (lam.conj() @ (part.rows @ x)).real)
