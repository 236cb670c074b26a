"""The exact large motion of N rotors and B bars under all loads and drives, in unit vectors with Lagrange multipliers.

    sum_j A_ij r_j'' = G_i r_i × r_i' − S_i (g e_z + a(t)) + R_i f_i(t) + hinge, friction, braces + sum_c lam_c grad_i g_c

with |r_i|² = 1 and |X_j − X_i|² = ell² (X_i = p_i + R_i r_i), f_i the force on tip i and a(t) the acceleration of the ground,
in whose frame the equations hold. The hinge has the energy kappa theta²/2, and friction is −c r_i'. The spin friction c_s
lets the axial momentum decay: G_i(t) = G_i exp(−c_s t / I3).

Every evaluation solves one linear system at linear cost:

    [ A⊗1  Gᵀ ] [ r''  ]   [ F ]      G: rows r_i (unit length) and ∓ R d (a bar, d from tip to tip)
    [ G    0  ] [ lam  ] = [ c ]

The rotors are sorted in the order of reverse Cuthill and McKee (1969), each with its bars. Chains and rings of any length then
have a narrow band, and LU with pivoting in the band solves the system (LAPACK's gbsv). Sparse LU solves systems with a wide
band, such as those of grids.

If a bar is in line with both its axes, the constraints are dependent and the continuation is not unique. An integrator may step
over this position without notice. At such a passage the vectors d × r change their sign for the axes r at both ends of the bar.

In the functions below r are the axes and v their rates (1/s), both (N, 3), and G the axial momenta (N,). Their entries are
floats or objects such as symbols; `root` is the square root for these entries.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from math import comb
from typing import Any

import numpy as np

from lagrotor.numerics.segment import RightHandSide, StopError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Coefficients, Index, coefficients

_NEXT, _AFTER = [1, 2, 0], [2, 0, 1]
_TERMS = 17  # of the arc sine's series; the error is 4e-14 for a hanging axis, 1e-16 below 2 rad
Root = Callable[[Array], Array]
Drive = Callable[[float], Array]
_WIDEST = 60  # the largest half bandwidth for LU in the band
_ROWS = 1_000  # of the systems that are solved in one call


def cross_product(a: Array, b: Array) -> Array:
    """Return a × b, (…, 3)."""
    return a[..., _NEXT] * b[..., _AFTER] - a[..., _AFTER] * b[..., _NEXT]


def forces(c: Coefficients, r: Array, v: Array, G: Array, root: Root = np.sqrt) -> Array:
    """Return the torques of spins, friction, weight, hinges and braces on the axes, (N, 3), N m."""
    F = G[:, None] * cross_product(r, v)
    if c.friction.any():
        F = F - c.friction[:, None] * v
    if c.gravity:
        F[:, 2] -= c.gravity * c.S
    if c.hinge.any():
        F[:, 2] += c.hinge * _angle_by_sine(r, root)
    return F + brace_forces(c, r, v, root) if len(c.stiffness) else F


def brace_forces(c: Coefficients, r: Array, v: Array, root: Root = np.sqrt) -> Array:
    """Return the torques of the braces on the axes, (N, 3), N m."""
    tip, joined = c.brace_tip, c.brace_to >= 0
    far_tips, F = c.brace_to[joined], np.zeros_like(r)
    swing = c.R[tip, None] * v[tip]
    swing[joined] -= c.R[far_tips, None] * v[far_tips]
    direction, stretch = stretches(c, r, root)
    pull = (c.stiffness * stretch + c.damping * (direction * swing).sum(1))[:, None] * direction
    np.subtract.at(F, tip, c.R[tip, None] * pull)
    np.add.at(F, far_tips, c.R[far_tips, None] * pull[joined])
    return F


def stretches(c: Coefficients, r: Array, root: Root = np.sqrt) -> tuple[Array, Array]:
    """Return the unit vectors along the braces, (…, braces, 3), and the extensions of the braces in m, for axes r (…, N, 3)."""
    joined = c.brace_to[:, None] >= 0
    foot = np.where(joined, c.feet[c.brace_to], c.brace_point)
    d = c.feet[c.brace_tip] - foot + (c.R[c.brace_tip, None] * r[..., c.brace_tip, :])
    d = d - np.where(joined, c.R[c.brace_to, None], 0.0) * r[..., c.brace_to, :]
    length = root((d * d).sum(-1))
    return d / length[..., None], length - c.brace_length


def _angle_by_sine(r: Array, root: Root) -> Any:
    """Return theta / sin(theta), (N,), for the angle theta of each axis from the vertical. It is 1 upright.

    Entries other than floats have square roots only, so theta = 8 b is halved three times. The quotient b / sin(b) is the arc
    sine's series in sin(b)², and sin(8 b) = 8 sin(b) cos(b) cos(2 b) cos(4 b).
    """
    if root is np.sqrt:
        return 1 / np.sinc(np.arctan2(np.hypot(r[:, 0], r[:, 1]), r[:, 2]) / np.pi)
    half = root((1.0 + r[:, 2]) / 2.0)
    quarter = root((1.0 + half) / 2.0)
    square, series = (1.0 - quarter) / 2.0, 0.0
    for n in reversed(range(_TERMS)):
        series = series * square + comb(2 * n, n) / 4**n / (2 * n + 1)
    return series / (half * quarter * root((1.0 + quarter) / 2.0))


def along_bars(c: Coefficients, r: Array) -> Array:
    """Return the vector d from tip i to tip j of each bar, (…, B, 3), in m, for axes r (…, N, 3)."""
    return c.feet[c.j] - c.feet[c.i] + _swing(c, r)


def _swing(c: Coefficients, v: Array) -> Array:
    """Return the derivative d' of the vector d of each bar, (…, B, 3), in m/s, for rates v (…, N, 3)."""
    return c.R[c.j, None] * v[..., c.j, :] - c.R[c.i, None] * v[..., c.i, :]


def pulls(c: Coefficients, r: Array) -> tuple[Array, Array]:
    """Return −R_i d and R_j d of each bar, both (…, B, 3): half the gradients of |d|² in its two axes, m²."""
    d = along_bars(c, r)
    return -c.R[c.i, None] * d, c.R[c.j, None] * d


def off_constraints(c: Coefficients, r: Array) -> Array:
    """Return the residuals (|r|² − 1)/2 of the N axes, then (|d|² − ell²)/2 of the B bars in m², (…, N + B)."""
    d = along_bars(c, r)
    return np.concatenate([(r * r).sum(-1) - 1, (d * d).sum(-1) - c.ell**2], axis=-1) / 2


def rates_of_constraints(c: Coefficients, r: Array, v: Array) -> Array:
    """Return the time derivatives of `off_constraints`: r · r' of the N axes, then d · d' of the B bars, (…, N + B)."""
    return np.concatenate([(r * v).sum(-1), (along_bars(c, r) * _swing(c, v)).sum(-1)], axis=-1)


def right_side(c: Coefficients, F: Array, v: Array) -> Array:
    """Return the right side (F, c) of the linear system of the module, (4N + B,), for torques F (N, 3) and rates v (N, 3). The
    unknowns are the 3N components of r'', then the multipliers of the N axes, then those of the B bars."""
    swing = _swing(c, v)
    return np.concatenate([F.ravel(), -(v * v).sum(1), -(swing * swing).sum(1)])


@dataclass(frozen=True, eq=False)
class Saddle:
    """The sparsity pattern and the constant entries of the linear system of the module, with n = 4N + B unknowns.

    - `order`: the row of each unknown, (n,). The unknowns are r'' (3N), the multipliers of the axes (N) and of the bars (B).
    - `band`: the half bandwidth.
    - `fixed`: the rows, columns and values of the constant entries, which are the masses.
    - `moving`: the rows and columns of the entries r and ∓ R d, which change with the state. Each occurs twice by symmetry.
    - `base`: the constant entries in banded storage; without rows if the band is too wide for it.
    - `places`: the positions of the `moving` entries in the banded storage.
    """

    order: Index
    band: int
    fixed: tuple[Index, Index, Array]
    moving: tuple[Index, Index]
    base: Array
    places: Index

    def solve(self, r: Array, pulls: tuple[Array, Array], right: Array) -> Array:
        """Solve the systems of s states with k right sides each, and return the unknowns (s, n, k). `r` are the axes (s, N, 3),
        and `pulls` the vectors that the function `pulls` returns for them. A state with a singular system gets NaN."""
        states, n, k = right.shape
        entries = np.concatenate([block.reshape(states, -1) for block in (r, *pulls)], axis=1)
        b = np.empty_like(right)
        b[:, self.order] = right
        if self.band > _WIDEST:
            x = np.array([self._solve_sparse(*row) for row in zip(entries, b, strict=True)]).reshape(right.shape)
        else:
            ab = np.repeat(self.base.reshape(1, -1), states, axis=0)
            ab[:, self.places] = np.concatenate([entries, entries], axis=1)
            x = in_band(self.band, ab.reshape(states * n, -1), b.reshape(-1, k).copy()).reshape(right.shape)
            if states > 1 and not np.isfinite(x).all():  # a singular system spoils the others
                singles = (slice(i, i + 1) for i in range(states))
                return np.concatenate([self.solve(r[i], (pulls[0][i], pulls[1][i]), right[i]) for i in singles])
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
    """Return the sparsity pattern and the constant entries of a structure's linear system."""
    c = coefficients(s)
    N, B = len(c.R), len(c.i)
    order = _order(N, c.i, c.j)
    axis = np.arange(3 * N).reshape(N, 3)
    unit, bar = 3 * N + np.arange(N), 4 * N + np.arange(B)
    heavy = c.coupling != 0
    i, j = axis[c.i[heavy]], axis[c.j[heavy]]
    rows = np.concatenate([axis.ravel(), i.ravel(), j.ravel()])
    columns = np.concatenate([axis.ravel(), j.ravel(), i.ravel()])
    coupling_entries = np.repeat(c.coupling[heavy], 3)
    values = np.concatenate([np.repeat(c.A, 3), coupling_entries, coupling_entries])
    components = np.concatenate([axis.ravel(), axis[c.i].ravel(), axis[c.j].ravel()])
    down = np.concatenate([np.repeat(unit, 3), np.repeat(bar, 3), np.repeat(bar, 3)])
    fixed = order[rows], order[columns], values
    moving = order[np.concatenate([components, down])], order[np.concatenate([down, components])]
    band = int(max(np.abs(fixed[0] - fixed[1]).max(), np.abs(moving[0] - moving[1]).max()))
    width = 3 * band + 1
    base = np.zeros((len(order), width) if band <= _WIDEST else (0, width))
    if len(base):
        base[fixed[1], 2 * band + fixed[0] - fixed[1]] = values
    places = moving[1] * width + 2 * band + moving[0] - moving[1]
    return Saddle(order, band, fixed, moving, base, places)


def _order(N: int, i: Index, j: Index) -> Index:
    """Return the row of each unknown. Rotors are in the order of reverse Cuthill–McKee, and a bar is between its rotors."""
    place = narrow_order(N, i, j)
    key = np.concatenate([np.repeat(place, 3).astype(float), place, (place[i] + place[j]) / 2])
    order = np.empty(len(key), dtype=np.intp)
    order[np.argsort(key, kind="stable")] = np.arange(len(key))
    return order


def narrow_order(N: int, i: Index, j: Index) -> Index:
    """Return the place (N,) of each node in the order of reverse Cuthill and McKee. Edge k joins node i[k] to node j[k]."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    graph: Any = csr_matrix((np.ones(2 * len(i)), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(N, N))
    place = np.empty(N, dtype=np.intp)
    place[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(N)
    return place


def in_band(band: int, ab: Array, b: Array) -> Array:
    """Solve a banded linear system, and return the unknowns; NaN if it is singular. Entry (i, j) of the matrix is at ab[j, 2
    band + i − j]. The arrays `ab` and `b` are overwritten."""
    from scipy.linalg.lapack import dgbsv

    _, _, x, info = dgbsv(band, band, ab.T, b, overwrite_ab=1, overwrite_b=1)
    return np.full_like(b, np.nan) if info else x


@dataclass(frozen=True, eq=False)
class ExactMotion:
    """The equations of motion of the state y = (r, r'/rate), (6N,), in the time s = rate t, with the rate of `c` in rad/s.

    `force` returns the forces (N, 3) on the tips in N at a time t in s. `ground` returns the acceleration (3,) of the ground in
    m/s². None means that no such drive acts.
    """

    c: Coefficients
    saddle: Saddle
    force: Drive | None = None
    ground: Drive | None = None

    def rhs(self, s: float, y: Array) -> Any:
        """Return the derivative dy/ds, (6N,), at the time s. Neither has a unit."""
        N, rate = len(self.c.R), self.c.rate
        r, v = y[: 3 * N].reshape(N, 3), y[3 * N :].reshape(N, 3) * rate
        return np.concatenate([y[3 * N :], self.accelerations(s / rate, r, v).ravel() / rate**2])

    def accelerations(self, t: float, r: Array, v: Array) -> Array:
        """Return r'' (N, 3) in 1/s² at t in s, for axes r (N, 3) and rates v (N, 3) in 1/s."""
        return self.solution(t, r, v)[: r.size].reshape(r.shape)

    def solution(self, t: float, r: Array, v: Array) -> Array:
        """Return the 3N components of r'', then the multipliers of the N axes and those of the B bars, (4N + B,). A bar with
        the multiplier lam exerts the force −lam d on its tip i and lam d on its tip j, in N."""
        right = right_side(self.c, self.forces(t, r, v), v)
        return self.saddle.solve(r[None], pulls(self.c, r[None]), right[None, :, None])[0, :, 0]

    def forces(self, t: float, r: Array, v: Array) -> Array:
        """Return the torques of all loads and drives on the axes, (N, 3), N m. The constraints are not included."""
        c = self.c
        return forces(c, r, v, c.G * np.exp(-c.decay * t) if c.decay.any() else c.G) + self.pushes(t)

    def pushes(self, t: float) -> Any:
        """Return the torques of the drives `ground` and `force` on the axes, (N, 3), N m; the number 0 if there are none."""
        F: Any = 0.0
        if self.ground is not None:
            F = -self.c.S[:, None] * np.asarray(self.ground(t), dtype=float)
        if self.force is not None:
            F = F + self.c.R[:, None] * np.asarray(self.force(t), dtype=float)
        return F

    def across(self, r: Array) -> Array:
        """Return d × r in m for the axes r at both ends of each bar, (2, …, B, 3). It is zero if bar and axis are in line."""
        d = along_bars(self.c, r)
        return np.stack([cross_product(d, r[..., end, :]) for end in (self.c.i, self.c.j)])

    def energy(self, r: Array, v: Array) -> Array:
        """Return the kinetic plus potential energy of n states r, v (n, N, 3) in J, (n,), without the energy of the spins."""
        c = self.c
        kinetic = (c.A * (v * v).sum(-1)).sum(-1) / 2 + (c.coupling * (v[:, c.i] * v[:, c.j]).sum(-1)).sum(-1)
        theta = np.arctan2(np.hypot(r[..., 0], r[..., 1]), r[..., 2])
        potential = c.gravity * r[..., 2] @ c.S + (c.hinge * theta**2).sum(-1) / 2
        _, stretch = stretches(c, r)
        return np.asarray(kinetic + potential + (c.stiffness * stretch**2).sum(-1) / 2)

    def axes_and_rates(self, states: Array) -> Array:
        """Return the axes r and the scaled rates r'/rate of states (n, 6N) as one array (2, n, N, 3)."""
        return states.reshape(-1, 2, len(self.c.R), 3).swapaxes(0, 1)

    def distance(self, first: Array, second: Array) -> Array:
        """Return the largest distance between equal axes of two runs with states (n, 6N), at each of the n times."""
        apart = self.axes_and_rates(first)[0] - self.axes_and_rates(second)[0]
        return np.asarray(np.linalg.norm(apart, axis=-1).max(axis=1))

    def difference_of_rates(self, first: Array, second: Array) -> float:
        """Return the largest difference in a component of r'/rate between two runs with states (n, 6N)."""
        return float(np.abs(self.axes_and_rates(first)[1] - self.axes_and_rates(second)[1]).max(initial=0.0))

    def defect(self, states: Array, conserved: bool) -> Array:
        """Return the residuals of the constraints and, if `conserved`, the changes of the energy. Each is divided by its
        sensitivity to the axes, so that it is the error of an axis that would cause it."""
        c = self.c
        r, v = self.axes_and_rates(states) * np.array([1.0, c.rate])[:, None, None, None]
        R = np.maximum(c.R[c.i], c.R[c.j])
        residual = (off_constraints(c, r) / np.append(np.ones(len(c.R)), R * np.maximum(R, c.ell))).ravel()
        if not conserved:
            return residual
        energy = self.energy(r, v)
        return np.append(residual, (energy - energy[0]) / (self.energy_scale(r, v) or 1.0))

    def energy_scale(self, r: Array, v: Array) -> float:
        """Return the largest change of energy (J), over all states, that a unit error of the axes and of v/rate causes."""
        c = self.c
        speed, theta = np.linalg.norm(v, axis=-1), np.arctan2(np.hypot(r[..., 0], r[..., 1]), r[..., 2])
        momentum = (c.A * speed).sum(-1) + (np.abs(c.coupling) * (speed[:, c.i] + speed[:, c.j])).sum(-1)
        weight = abs(c.gravity) * np.abs(c.S).sum() + (c.hinge * theta).sum(-1)
        _, stretch = stretches(c, r)
        pull = (c.stiffness * np.abs(stretch) * 2 * c.R[c.brace_tip]).sum(-1)
        return float((c.rate * momentum + weight + pull).max())

    def project(self, y: Array) -> Array:
        """Correct a state y, (6N,) or (6N, n), by one Newton step towards the constraints and their time derivatives. The
        correction is the smallest in the metric of the mass matrix."""
        c, N = self.c, len(self.c.R)
        states = np.atleast_2d(y.T)
        r, v = states.reshape(-1, 2, N, 3).swapaxes(0, 1)
        first, second = pulls(c, r)
        right = np.zeros((len(states), 4 * N + len(c.i), 2))
        right[:, 3 * N :, 0], right[:, 3 * N :, 1] = -off_constraints(c, r), -rates_of_constraints(c, r, v)
        at_once = max(_ROWS // right.shape[1], 1)
        corrections = [
            self.saddle.solve(r[chunk], (first[chunk], second[chunk]), right[chunk])[:, : 3 * N]
            for chunk in (slice(k, k + at_once) for k in range(0, len(states), at_once))
        ]
        return (states + np.concatenate(corrections).swapaxes(1, 2).reshape(states.shape)).T.reshape(y.shape)


def exact_motion(s: Assembly, force: Drive | None = None, ground: Drive | None = None) -> ExactMotion:
    """Return the exact equations of motion of a structure.

    Parameters
    ----------
    s : Assembly
        The structure.
    force : callable or None, optional
        A function of t that returns the forces (N, 3) on the tips, N.
    ground : callable or None, optional
        A function of t that returns the acceleration (3,) of the ground, m/s².

    Returns
    -------
    ExactMotion
        The right-hand side with its energy and projection.
    """
    return ExactMotion(coefficients(s), saddle(s), force, ground)


_IN_LINE = 1e-3  # sine of the angle between a bar and both its axes where a stop counts as singular
_AT_ONCE = 64  # states per check
_EVERY = 3  # one of so many evaluations is recorded


def bar_in_line(motion: ExactMotion, y: Array) -> str:
    """Return a sentence that names a bar in line with both its axes at the state y; "" if there is none."""
    c = motion.c
    sines = np.linalg.norm(motion.across(motion.axes_and_rates(y[None])[0, 0]), axis=-1) / c.ell
    bars = np.flatnonzero((sines < _IN_LINE).all(axis=0))
    return f"bar {bars[0]} comes into line with both its axes" if len(bars) else ""


@dataclass
class LineWatch:
    """A record of the axes during a run that detects when a bar passes the line of both its axes. `check` raises StopError if a
    bar was in line with both its axes between two recorded states."""

    motion: ExactMotion
    states: list[tuple[float, Array]] = field(default_factory=list)
    passed: tuple[float, int] | None = None  # when, which bar

    def keep(self, t: float, y: Array) -> None:
        """Record the axes of the state y (6N,) at t. Records of later times belong to a rejected step and are dropped."""
        while self.states and self.states[-1][0] >= t:
            self.states.pop()
        if self.passed and self.passed[0] > t:
            self.passed = None
        self.states.append((t, y[: 3 * len(self.motion.c.R)].copy()))
        if len(self.states) > _AT_ONCE:
            self._look()

    def observe(self, rhs: RightHandSide) -> RightHandSide:
        """Return a right-hand side with the same values that also records every third state at which it is evaluated."""
        evaluations = 0

        def rate(s: float, y: Array) -> list[float]:
            nonlocal evaluations
            evaluations += 1
            if evaluations % _EVERY == 0:
                self.keep(s, y)
            return rhs(s, y)

        return rate if len(self.motion.c.i) else rhs

    def check(self) -> None:
        self._look()
        if self.passed:
            at, bar = self.passed
            raise StopError(at, f"bar {bar} comes into line with both its axes", cause="singular")

    def _look(self) -> None:
        transverse = self.motion.across(np.array([y for _, y in self.states]).reshape(len(self.states), -1, 3))
        reversals = np.argwhere(((transverse[:, 1:] * transverse[:, :-1]).sum(-1) < 0).all(0))
        if len(reversals) and not self.passed:
            self.passed = self.states[reversals[0, 0] + 1][0], int(reversals[0, 1])
        del self.states[:-1]
