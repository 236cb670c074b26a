"""Small motion about upright: the linear system on the degrees of freedom that remain with the bars, and its modes.

With u_i = (x, y) of axis i, M u'' + C u' + K u = 0 under n_b . (R_i u_i − R_j u_j) = 0 for each bar along n_b:

    M = A ⊗ 1,   C = friction − G_i [[0, −1], [1, 0]],   K = hinge − g S_i + sum_braces k (n nᵀ).

Upright, the bars carry no force (weight acts along the axes), so that they enter only as constraints: u = Z q, with Z a basis
of the null space of their rows. Merkin, Introduction to the Theory of Stability, ch. 6; rigidity matrices: Graver, Servatius &
Servatius (1993).
"""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import InputError, SingularError
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Coefficients, Complex, coefficients

Matrix = NDArray[Any]  # real of a structure, complex of a pattern

# Real or imaginary parts below these fractions of a root are rounding. Double roots are known to half of a double's digits.
_ZERO = 1e-6
_DAMPED = 1e-10  # with friction, where the real part need not be zero
_ROUNDED = 1e-13  # the same relative to the fastest root, for real parts
WIDEST = 1e6  # the largest ratio of rates at which the slow one keeps enough digits
_SLOWEST = 1e-9  # relative to the rate of a pattern: slower waves count as zero
_ALIKE = 1e-6  # relative difference of equal sizes
_NEUTRAL = 1e-12  # relative to masses × pull²: a smaller stiffness is the rounding of zero
_DEPENDENT = 1e-10  # relative to the largest singular value: smaller ones are zero


@dataclass(frozen=True, eq=False, repr=False)
class Modes(Shown):
    """The n normal modes u = Re(shape e^((growth + i rate) t)): rates (n,) in rad/s, growth (n,) in 1/s, shapes (n, N, 2).

    Of each conjugate pair of roots, the one with a positive rate is kept. Of the real roots, the larger half is kept.

    - `rates`: the angular frequencies, (n,), rad/s; 0 for a mode that does not oscillate.
    - `growth`: the growth rates, (n,), 1/s. A growth below 1e-13 of the fastest root is set to zero.
    - `shapes`: the x and y of each axis, (n, N, 2), with the largest component 1.
    - `topple`: the number of modes that grow.
    - `energy_signs`: the sign of ω² ū·M u + ū·K u, (n,): −1 if an oscillation has less energy than the equilibrium, 1 if it
      has more, 0 if the mode does not oscillate or grows.
    - `left_out`: in the limit of fast spins, the first-order decrease of each rate by the inertia, (n,), rad/s; negative under
      weight.
    """

    rates: Array
    growth: Array
    shapes: Complex
    topple: int
    energy_signs: NDArray[np.int64]
    left_out: Array

    def summary(self) -> dict[str, str]:
        """Return rate and growth of each mode, and the number of growing modes."""
        indices = range(min(len(self.rates), 12))
        signs = {1: "", 0: "", -1: ", of negative energy"}
        rows = {
            f"mode {i + 1}": f"{self.rates[i]:.6g} rad/s, growth {self.growth[i]:.3g} 1/s{signs[int(self.energy_signs[i])]}"
            for i in indices
        }
        remainder = {"further ones": str(len(self.rates) - 12)} if len(self.rates) > 12 else {}
        return rows | remainder | {"topple": f"{self.topple} of {len(self.rates)}"}


@dataclass(frozen=True, eq=False)
class SmallMotion:
    """The linear system M q'' + (damping + gyroscopic) q' + K q = 0 of n degrees of freedom q.

    For waves at many wave numbers each array has one more leading axis, and so have the roots.

    - `mass`, `damping`, `stiffness`: the symmetric matrices, (n, n).
    - `gyroscopic`: the antisymmetric matrix of the spins, (n, n).
    - `basis`: the matrix Z, (2N, n), in the tilts u = Z q.
    - `rate`: a typical rate, rad/s, in units of which the eigenvalues are computed.
    - `pull`: `Coefficients.pull`, the scale of rounding of the stiffness; 0 if it is unknown.
    """

    mass: Matrix
    damping: Matrix
    gyroscopic: Matrix
    stiffness: Matrix
    basis: Matrix
    rate: float
    pull: float = 0.0

    @property
    def dof(self) -> int:
        """The number of degrees of freedom."""
        return int(self.mass.shape[-1])

    @property
    def bands(self) -> int:
        """The number of roots with each conjugate pair counted once: dof, or dof // 2 without inertia."""
        return self.dof if self.mass.any() else self.dof // 2

    @property
    def without_inertia(self) -> "SmallMotion":
        """The limit of fast spins, C u' + K u = 0, whose roots are the roots that stay finite for M → 0."""
        unit = np.abs(self.stiffness).max(initial=0) / (np.abs(self.gyroscopic).max(initial=0) or 1.0)
        return replace(self, mass=0 * self.mass, rate=float(unit) or self.rate)

    def at_spins(self, factor: float) -> "SmallMotion":
        """Return the system with all spins multiplied by a factor."""
        return replace(self, gyroscopic=factor * self.gyroscopic)

    def with_momenta(self, G: Array) -> "SmallMotion":
        """Return the system with other axial momenta G (N,), kg m²/s, of the rotors."""
        return replace(self, gyroscopic=self.basis.T @ np.kron(np.diag(G), [[0, 1], [-1, 0]]) @ self.basis)

    @cached_property
    def roots(self) -> Complex:
        """The 2n roots s of det(M s² + C s + K) in 1/s, or n roots without inertia. Nearly zero roots are set to zero."""
        return self.waves[0]

    @cached_property
    def waves(self) -> tuple[Complex, Complex]:
        """The roots (m,) in 1/s and their vectors q as columns, (n, m). Raises SingularError if the inertia is left out and no
        spin acts on some motion."""
        if not self.mass.any():
            return self._of_first_order
        s, x = np.linalg.eig(self.first_order)
        return self._in_seconds(s), x[..., : self.dof, :] + 0j

    @property
    def _of_first_order(self) -> tuple[Complex, Complex]:
        """The roots and vectors of (s C + K) q = 0, the limit without inertia."""
        C, K = (self.gyroscopic + self.damping) * self.rate, self.stiffness + 0j
        sizes = np.linalg.svd(C, compute_uv=False)
        if self.dof and not (sizes[..., -1] > _DEPENDENT * sizes[..., 0]).all():
            raise SingularError(
                "fast spins: a motion on which no spin acts has no rate without inertia: give each rotor a spin and leave "
                f"an even number of degrees of freedom (here {self.dof}), or keep the inertia"
            )
        s, vectors = np.linalg.eig(-np.linalg.solve(C, K))
        return self._in_seconds(s), vectors

    def energy_signs(self, roots: Complex, vectors: Complex) -> NDArray[np.int64]:
        """Return the signs (m,) of the energies ω² ū·M u + ū·K u, for roots (m,) and vectors u (n, m)."""
        kinetic, elastic = _forms(vectors, self.mass, self.stiffness)
        return np.sign(kinetic * roots.imag**2 + elastic).astype(np.int64)

    @cached_property
    def _definite(self) -> bool:
        """True if K is positive definite and there is no damping, so that all roots are imaginary."""
        if self.damping.any() or not self.dof:
            return False
        sizes = np.linalg.eigvalsh(self.stiffness)
        return bool((sizes[..., 0] > _DEPENDENT * np.abs(sizes).max(-1)).all())

    @property
    def first_order(self) -> Matrix:
        """The matrix W, (2n, 2n), of the first-order system z' = W z with z = (q, q'), where the prime is the derivative by the
        dimensionless time rate · t."""
        n, unit = self.dof, self.rate
        below = np.concatenate([self.stiffness / -(unit**2), (self.damping + self.gyroscopic) / -unit], axis=-1)
        W = np.zeros((*below.shape[:-2], 2 * n, 2 * n), dtype=below.dtype)
        W[..., :n, n:] = np.eye(n)
        W[..., n:, :] = np.linalg.solve(self.mass, below)
        return W

    def _in_seconds(self, s: Matrix) -> Complex:
        sizes = np.abs(np.linalg.eigvalsh(self.stiffness)) if self.dof else np.ones(1)
        neutral = (sizes <= _DEPENDENT * sizes.max(-1, keepdims=True)).any(
            -1, keepdims=True
        )  # otherwise no root is zero
        if s.ndim == 1 and neutral[0] and not self._definite:
            s, neutral, slowest = s + 0j, np.array([False]), np.argsort(np.abs(s))
            free, unturned, unrubbed = self._neutral
            creeping, restored = slowest[free + unrubbed : free + unturned], slowest[free + unturned :]
            s[slowest[: free + unrubbed]] = 0
            s[creeping[np.abs(s[creeping]) < _ZERO * (np.abs(s[restored[0]]) if len(restored) else 1.0)]] = 0
        near = np.maximum(np.abs(s), np.where(neutral, 1.0, _SLOWEST if s.ndim > 1 else 0.0))
        still = np.abs(s.real) < (_DAMPED if self.damping.any() else _ZERO) * near
        still |= np.abs(s.real) < _ROUNDED * np.abs(s).max(initial=0.0)
        return np.asarray(
            self.rate * (np.where(still, 0, s.real) + 1j * np.where(np.abs(s.imag) < _ZERO * near, 0, s.imag))
        )

    @property
    def _neutral(self) -> tuple[int, int, int]:
        """The dimensions of three nested spaces of motions v.

        The first space has K v = 0. The second has those v of it for which the gyroscopic matrix, restricted to the first
        space, vanishes. The third has those v of the second for which the restricted friction matrix vanishes, too.

        Zero is a root once for each dimension of the first space, and once more for each of the third.
        """
        sizes, shapes = np.linalg.eigh(self.stiffness)
        none = max(_DEPENDENT * np.abs(sizes).max(), _NEUTRAL * np.abs(self.mass).max() * self.pull**2)
        free = shapes[:, np.abs(sizes) <= none]
        rotated, rubbed = (
            _dagger(free) @ form @ free / (np.abs(form).max() or 1.0) for form in (self.gyroscopic, self.damping)
        )
        unturned, unrubbed = (
            int((np.linalg.svd(rows, compute_uv=False) <= _DEPENDENT).sum())
            for rows in (rotated, np.vstack([rotated, rubbed]))
        )
        return free.shape[1], unturned, unrubbed

    @property
    def growth(self) -> float:
        """The largest real part of a root, 1/s; zero if no motion grows."""
        return float(max(self.roots.real.max(), 0.0))

    @property
    def extremes(self) -> tuple[float, float]:
        """The slowest nonzero root and the fastest root, rad/s. The stiffness determines how many roots are zero."""
        if not self.dof:
            return 1.0, 1.0
        sizes = np.sort(np.abs(np.linalg.eigvals(self.first_order)))
        free, unturned, _ = self._neutral
        nonzero = sizes[free + unturned :]  # the roots in between, of friction alone, may be arbitrarily slow
        return (self.rate * float(nonzero[0]), self.rate * float(nonzero[-1])) if len(nonzero) else (1.0, 1.0)

    @property
    def drifts(self) -> bool:
        """True if some displacement grows at constant speed, that is, if one motion has the double root zero."""
        return bool(self.dof and self._neutral[2])


@lru_cache(maxsize=64)
def small_motion(s: Assembly) -> SmallMotion:
    """Return the linear system about upright. Raises InputError if a bar does not have its upright length."""
    check_upright(s, "small_motion")
    c = coefficients(s)
    rank, vectors = left_by(bar_rows(c))
    return replace(on_basis(matrices(c), vectors[:, int(rank) :], c.rate), pull=c.pull)


def check_upright(s: Assembly, where: str) -> None:
    """Raise InputError, which names the caller `where`, if a bar does not have its upright length."""
    if not s.natural:
        raise InputError(
            f"{where}: a bar does not have its upright length, and this linear motion is about upright axes: "
            "simulate it"
        )


def check_rates(s: Assembly, where: str) -> SmallMotion:
    """Return the linear system about upright. Raises InputError if the fastest rate exceeds 10⁶ times the slowest."""
    check_upright(s, where)
    linear = small_motion(s)
    slowest, fastest = linear.extremes
    if fastest > WIDEST * slowest:
        raise InputError(
            f"{where}: the fastest rate, {fastest:.3g} rad/s, is more than 10⁶ times the slowest, {slowest:.1g} rad/s, which "
            "rounding hides: take slower spins, stiffer springs, or the limit modes(inertia=False)"
        )
    return linear


def left_by(rows: Matrix) -> tuple[NDArray[np.intp], Matrix]:
    """Return the rank (…,) of the rows (…, B, n) of the bars, and an orthonormal basis (…, n, n). The columns of the basis from
    number `rank` on span the null space of the rows."""
    _, sizes, vectors = np.linalg.svd(rows)
    ranks = np.asarray((sizes > _DEPENDENT * sizes.max(-1, initial=0.0, keepdims=True)).sum(-1))
    return ranks, _dagger(vectors)


def on_basis(forms: Matrix, basis: Matrix, rate: float) -> SmallMotion:
    """Return the linear system of four matrices `forms`, (…, 4, n, n), in the f columns of a basis (…, n, f). The matrices are
    in the order of `matrices`. All arrays may be complex."""
    if basis.shape[-1] < basis.shape[-2]:
        forms = _dagger(basis)[..., None, :, :] @ forms @ basis[..., None, :, :]
    mass, damping, gyroscopic, stiffness = np.moveaxis(forms, -3, 0)
    return SmallMotion(mass, damping, gyroscopic, stiffness, basis, rate)


def _forms(vectors: Complex, *matrices: Matrix) -> list[Array]:
    """Return for each matrix A the real numbers ū·A u, (m,), with u the columns of `vectors` (n, m)."""
    return [(vectors.conj() * (A @ vectors)).sum(0).real for A in matrices]


def _dagger(x: Matrix) -> Matrix:
    return x.conj().swapaxes(-1, -2)


def matrices(c: Coefficients) -> Array:
    """Return the mass, damping, gyroscopic and stiffness matrices of the tilts u, (4, 2N, 2N), as if there were no bars."""
    identity = np.eye(2, dtype=int)
    C, K = (np.kron(np.diag(d), identity) for d in (c.friction, c.hinge - c.gravity * c.S))
    for k, row in enumerate(_brace_rows(c)):
        C += c.damping[k] * np.outer(row, row)
        K += c.stiffness[k] * np.outer(row, row)
    return np.array([np.kron(c.inertia, identity), C, np.kron(np.diag(c.G), [[0, 1], [-1, 0]]), K])


def bar_rows(c: Coefficients) -> Array:
    """Return the matrix (B, 2N) that takes the tilts u to n · (R_i u_i − R_j u_j) of each bar, which its constraint keeps zero.
    n is the horizontal part of the unit vector along the bar."""
    n = (c.feet[c.j] - c.feet[c.i])[:, :2] / c.ell[:, None]
    rows = np.zeros((len(c.i), len(c.R), 2), dtype=c.R.dtype)
    index = np.arange(len(c.i))
    rows[index, c.i], rows[index, c.j] = c.R[c.i, None] * n, -c.R[c.j, None] * n
    return rows.reshape(len(c.i), 2 * len(c.R))


def _brace_rows(c: Coefficients) -> Array:
    """Return the matrix (braces, 2N) that takes the tilts u to the extensions of the braces in m."""
    tip = c.feet[c.brace_tip] + c.R[c.brace_tip, None] * [0, 0, 1]
    n = ((tip - c.brace_point) / c.brace_length[:, None])[:, :2]
    rows = np.zeros((len(n), len(c.R), 2), dtype=c.R.dtype)
    for k, (i, j) in enumerate(zip(c.brace_tip, c.brace_to, strict=True)):
        rows[k, i] += c.R[i] * n[k]
        if j >= 0:
            rows[k, j] -= c.R[j] * n[k]
    return rows.reshape(len(n), 2 * len(c.R))


def modes(s: Assembly, inertia: bool = True) -> Modes:
    """Compute the normal modes about upright: see `Structure.modes`."""
    check_upright(s, "modes")
    if not isinstance(inertia, bool):
        raise InputError(f"modes: inertia = {inertia!r} must be True or False")
    whole = check_rates(s, "modes") if inertia else small_motion(s)
    return modes_of(whole, whole if inertia else whole.without_inertia)


def first_largest(sizes: Array) -> Any:
    """Return the first index, along the last axis, of a size that is the largest up to rounding. All processors agree on it."""
    return (sizes > (1 - _ALIKE) * sizes.max(-1, keepdims=True)).argmax(-1)


def modes_of(whole: SmallMotion, linear: SmallMotion) -> Modes:
    """Return the normal modes of `linear`, which is the system `whole` or its limit without inertia."""
    roots, vectors = linear.waves
    turning = np.flatnonzero(roots.imag > 0)
    real = np.flatnonzero(roots.imag == 0)
    real = real[np.argsort(-roots[real].real, kind="stable")][: linear.bands - len(turning)]
    chosen = np.concatenate([turning, real])
    chosen = chosen[np.lexsort((roots[chosen].imag, -roots[chosen].real))]
    shapes = (linear.basis @ vectors[:, chosen]).T.reshape(len(chosen), -1, 2)
    largest = np.abs(shapes).reshape(len(chosen), -1)
    lead = shapes.reshape(len(chosen), -1)[np.arange(len(chosen)), first_largest(largest)]
    shapes = shapes / lead[:, None, None]
    signs = np.where(
        (roots[chosen].imag > 0) & (roots[chosen].real <= 0), linear.energy_signs(roots, vectors)[chosen], 0
    )
    left_out = np.zeros(len(chosen))
    if linear is not whole:
        rates, u = roots[chosen].imag, vectors[:, chosen]
        heavy, gyroscopic = ((u.conj() * (form @ u)).sum(0) for form in (whole.mass, whole.gyroscopic))
        np.divide(rates**2 * heavy.real, gyroscopic.imag, out=left_out, where=rates > 0)
    return Modes(roots[chosen].imag, roots[chosen].real, shapes, int((roots[chosen].real > 0).sum()), signs, left_out)
