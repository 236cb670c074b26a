"""The exact motion of N rotors and B bars: unit vectors with multipliers, large motion, every load and drive.

    sum_j A_ij r_j'' = G_i r_i × r_i' − S_i (g e_z + a(t)) + R_i f_i(t) + hinge, friction, braces + sum_c lam_c grad_i g_c

with |r_i|² = 1 and |X_j − X_i|² = ell² (X_i = p_i + R_i r_i), f_i the force on tip i, a(t) the ground's acceleration: the
equations are those in the ground's frame. The hinge's energy is kappa theta²/2, friction is −c r_i', and the axial momentum
decays by its own friction, G_i(t) = G_i exp(−c_s t / I3). For N = 2 without load: `lagrotor.models.spheres`.

Every evaluation solves one linear system, the masses bordered by the gradients of the constraints, at linear cost:

    [ A⊗1  Gᵀ ] [ r''  ]   [ F ]      G: rows r_i (unit length) and ∓ R d (a bar, d from tip to tip)
    [ G    0  ] [ lam  ] = [ c ]

The unknowns of a rotor and of its bars stand together, the rotors in the order of reverse Cuthill and McKee (1969), so that
chains and rings give a narrow band whatever their length: LU with pivoting in the band (LAPACK's gbsv). Where the band is
wide (grids), sparse LU.

Where a bar is in line with both its axes the constraints are dependent: the motion has no unique continuation, and an integrator
that steps over the place goes on along one of them without notice. The direction of the bar across an axis, d × r, turns round
where the two are in line. If it turns round at both ends from one state of a run to the next, the place lies between them.

In the functions of forces and constraints r and v are the axes and their rates, (N, 3), 1/s, and G the axial momenta (N,). They
are arrays of floats, or of objects: symbols, or numbers that record or are compiled, whose square roots `root` takes.
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
_TERMS = 17  # of the series of the arc sine, which leave 4e-14 where an axis hangs down, 1e-16 below 2 rad
Root = Callable[[Array], Array]
Drive = Callable[[float], Array]
_WIDEST = 60  # half bandwidth beyond which sparse LU is faster
_ROWS = 1_000  # of the systems that are solved together


def cross_product(a: Array, b: Array) -> Array:
    """a × b, (…, 3)."""
    return a[..., _NEXT] * b[..., _AFTER] - a[..., _AFTER] * b[..., _NEXT]


def forces(c: Coefficients, r: Array, v: Array, G: Array, root: Root = np.sqrt) -> Array:
    """What spins, friction, weight, hinges and braces exert on the axes, (N, 3), N m."""
    F = G[:, None] * cross_product(r, v)
    if c.friction.any():
        F = F - c.friction[:, None] * v
    if c.gravity:
        F[:, 2] -= c.gravity * c.S
    if c.hinge.any():
        F[:, 2] += c.hinge * _angle_by_sine(r, root)
    return F + brace_forces(c, r, v, root) if len(c.stiffness) else F


def brace_forces(c: Coefficients, r: Array, v: Array, root: Root = np.sqrt) -> Array:
    """What braces exert on the axes, (N, 3), N m."""
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
    """Along which unit vectors the braces pull, (…, braces, 3), and by how much they are longer, m; r (…, N, 3)."""
    joined = c.brace_to[:, None] >= 0
    foot = np.where(joined, c.feet[c.brace_to], c.brace_point)
    d = c.feet[c.brace_tip] - foot + (c.R[c.brace_tip, None] * r[..., c.brace_tip, :])
    d = d - np.where(joined, c.R[c.brace_to, None], 0.0) * r[..., c.brace_to, :]
    length = root((d * d).sum(-1))
    return d / length[..., None], length - c.brace_length


def _angle_by_sine(r: Array, root: Root) -> Any:
    """theta / sin(theta), regular where an axis is upright.

    Where square roots are all there is: theta = 8 b, and b / sin(b) is the arc sine's series in sin(b)²;
    sin(8 b) = 8 sin(b) cos(b) cos(2 b) cos(4 b).
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
    """d from tip i to tip j of the bars, m, (…, B, 3); r (…, N, 3)."""
    return c.feet[c.j] - c.feet[c.i] + _swing(c, r)


def _swing(c: Coefficients, v: Array) -> Array:
    """d' of the bars."""
    return c.R[c.j, None] * v[..., c.j, :] - c.R[c.i, None] * v[..., c.i, :]


def pulls(c: Coefficients, r: Array) -> tuple[Array, Array]:
    """−R_i d and R_j d of the bars (…, B, 3): half the gradients of |d|²; r (…, N, 3)."""
    d = along_bars(c, r)
    return -c.R[c.i, None] * d, c.R[c.j, None] * d


def off_constraints(c: Coefficients, r: Array) -> Array:
    """How far the constraints are from zero, [|r|² − 1 (N), |d|² − ell² (B)], halved, (…, N + B); r (…, N, 3)."""
    d = along_bars(c, r)
    return np.concatenate([(r * r).sum(-1) - 1, (d * d).sum(-1) - c.ell**2], axis=-1) / 2


def rates_of_constraints(c: Coefficients, r: Array, v: Array) -> Array:
    """Their rates, [r · r', d · d'], (…, N + B)."""
    return np.concatenate([(r * v).sum(-1), (along_bars(c, r) * _swing(c, v)).sum(-1)], axis=-1)


def right_side(c: Coefficients, F: Array, v: Array) -> Array:
    """Of the equations for [r'' (3 N), multipliers of the axes (N) and of the bars (B)], with F (N, 3) on the axes."""
    swing = _swing(c, v)
    return np.concatenate([F.ravel(), -(v * v).sum(1), -(swing * swing).sum(1)])


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
        entries = np.concatenate([block.reshape(states, -1) for block in (r, *pulls)], axis=1)
        b = np.empty_like(right)
        b[:, self.order] = right
        if self.band > _WIDEST:
            x = np.array([self._solve_sparse(*row) for row in zip(entries, b, strict=True)]).reshape(right.shape)
        else:
            ab = np.repeat(self.base.reshape(1, -1), states, axis=0)
            ab[:, self.places] = np.concatenate([entries, entries], axis=1)
            x = in_band(self.band, ab.reshape(states * n, -1), b.reshape(-1, k).copy()).reshape(right.shape)
            if states > 1 and not np.isfinite(x).all():  # one of them is singular, and they were solved as one
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


@dataclass(frozen=True, eq=False)
class ExactMotion:
    """The right-hand side in the state y = (r, r'/rate), (6 N,), and the time s = rate t.

    force: t → forces (N, 3) on the tips, N; ground: t → acceleration (3,) of the ground, m/s².
    """

    c: Coefficients
    saddle: Saddle
    force: Drive | None = None
    ground: Drive | None = None

    def rhs(self, s: float, y: Array) -> Any:
        """y' at s, both without unit."""
        N, rate = len(self.c.R), self.c.rate
        r, v = y[: 3 * N].reshape(N, 3), y[3 * N :].reshape(N, 3) * rate
        return np.concatenate([y[3 * N :], self.accelerations(s / rate, r, v).ravel() / rate**2])

    def accelerations(self, t: float, r: Array, v: Array) -> Array:
        """r'' (N, 3) in 1/s² of axes r and rates v (N, 3)."""
        return self.solution(t, r, v)[: r.size].reshape(r.shape)

    def solution(self, t: float, r: Array, v: Array) -> Array:
        """[r'' (3 N), multipliers of the axes (N) and of the bars (B)]: the pull of a bar on its tips is −lam times d, in N."""
        right = right_side(self.c, self.forces(t, r, v), v)
        return self.saddle.solve(r[None], pulls(self.c, r[None]), right[None, :, None])[0, :, 0]

    def forces(self, t: float, r: Array, v: Array) -> Array:
        """What acts on the axes besides the constraints, (N, 3), N m."""
        c = self.c
        return forces(c, r, v, c.G * np.exp(-c.decay * t) if c.decay.any() else c.G) + self.pushes(t)

    def pushes(self, t: float) -> Any:
        """What the ground's acceleration and the forces on the tips exert on the axes, (N, 3) or zero, N m."""
        F: Any = 0.0
        if self.ground is not None:
            F = -self.c.S[:, None] * np.asarray(self.ground(t), dtype=float)
        if self.force is not None:
            F = F + self.c.R[:, None] * np.asarray(self.force(t), dtype=float)
        return F

    def across(self, r: Array) -> Array:
        """The bars' d × r with the axes at both ends, (2, …, B, 3): zero where a bar is in line with both; r (…, N, 3)."""
        d = along_bars(self.c, r)
        return np.stack([cross_product(d, r[..., end, :]) for end in (self.c.i, self.c.j)])

    def energy(self, r: Array, v: Array) -> Array:
        """T + V of states r, v (n, N, 3), (n,), in J, the spins' own energy left out."""
        c = self.c
        kinetic = (c.A * (v * v).sum(-1)).sum(-1) / 2 + (c.coupling * (v[:, c.i] * v[:, c.j]).sum(-1)).sum(-1)
        theta = np.arctan2(np.hypot(r[..., 0], r[..., 1]), r[..., 2])
        potential = c.gravity * r[..., 2] @ c.S + (c.hinge * theta**2).sum(-1) / 2
        _, stretch = stretches(c, r)
        return np.asarray(kinetic + potential + (c.stiffness * stretch**2).sum(-1) / 2)

    def axes_and_rates(self, states: Array) -> Array:
        """r and r'/rate, (2, n, N, 3), of states (n, 6 N)."""
        return states.reshape(-1, 2, len(self.c.R), 3).swapaxes(0, 1)

    def distance(self, first: Array, second: Array) -> Array:
        """The largest difference of an axis between states (n, 6 N), (n,)."""
        apart = self.axes_and_rates(first)[0] - self.axes_and_rates(second)[0]
        return np.asarray(np.linalg.norm(apart, axis=-1).max(axis=1))

    def difference_of_rates(self, first: Array, second: Array) -> float:
        """The largest difference of a component of r'/rate between states (n, 6 N)."""
        return float(np.abs(self.axes_and_rates(first)[1] - self.axes_and_rates(second)[1]).max(initial=0.0))

    def defect(self, states: Array, conserved: bool) -> Array:
        """The errors of axes that explain how far states (n, 6 N) are off the constraints and, where conserved, their energy."""
        c = self.c
        r, v = self.axes_and_rates(states) * np.array([1.0, c.rate])[:, None, None, None]
        R = np.maximum(c.R[c.i], c.R[c.j])
        residual = (off_constraints(c, r) / np.append(np.ones(len(c.R)), R * np.maximum(R, c.ell))).ravel()
        if not conserved:
            return residual
        energy = self.energy(r, v)
        return np.append(residual, (energy - energy[0]) / (self.energy_scale(r, v) or 1.0))

    def energy_scale(self, r: Array, v: Array) -> float:
        """How much the energy (J) of some of the states r, v (n, N, 3) changes by an error of 1 of axes and v/rate, at most."""
        c = self.c
        speed, theta = np.linalg.norm(v, axis=-1), np.arctan2(np.hypot(r[..., 0], r[..., 1]), r[..., 2])
        momentum = (c.A * speed).sum(-1) + (np.abs(c.coupling) * (speed[:, c.i] + speed[:, c.j])).sum(-1)
        weight = abs(c.gravity) * np.abs(c.S).sum() + (c.hinge * theta).sum(-1)
        _, stretch = stretches(c, r)
        pull = (c.stiffness * np.abs(stretch) * 2 * c.R[c.brace_tip]).sum(-1)
        return float((c.rate * momentum + weight + pull).max())

    def project(self, y: Array) -> Array:
        """One Newton step onto the constraints and their rates in the metric of the masses: states (6 N,) or (6 N, n)."""
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
    """The exact model of a structure.

    Parameters
    ----------
    s : Assembly
        The structure.
    force : Drive or None, optional
        T → forces on its tips, (N, 3), N.
    ground : Drive or None, optional
        T → accelerations of its ground.
    """
    return ExactMotion(coefficients(s), saddle(s), force, ground)


_IN_LINE = 1e-3  # sine of the angle between a bar and both its axes at which a solver that stops has come to it
_AT_ONCE = 64  # states that are looked at together
_EVERY = 3  # evaluation of a right-hand side is looked at


def bar_in_line(motion: ExactMotion, y: Array) -> str:
    """The words of a state at which a solver stopped as a bar had come into line with both its axes; none where none has."""
    c = motion.c
    sines = np.linalg.norm(motion.across(motion.axes_and_rates(y[None])[0, 0]), axis=-1) / c.ell
    bars = np.flatnonzero((sines < _IN_LINE).all(axis=0))
    return f"bar {bars[0]} comes into line with both its axes" if len(bars) else ""


@dataclass
class LineWatch:
    """States of a run as they come; `check` raises StopError if such a place lies between two of them."""

    motion: ExactMotion
    kept: list[tuple[float, Array]] = field(default_factory=list)
    passed: tuple[float, int] | None = None  # when, which bar

    def keep(self, t: float, y: Array) -> None:
        """The axes of the state y (6 N,) at t; what was kept of a later time belongs to a trial, and is forgotten."""
        while self.kept and self.kept[-1][0] >= t:
            self.kept.pop()
        if self.passed and self.passed[0] > t:
            self.passed = None
        self.kept.append((t, y[: 3 * len(self.motion.c.R)].copy()))
        if len(self.kept) > _AT_ONCE:
            self._look()

    def observe(self, rhs: RightHandSide) -> RightHandSide:
        """The right-hand side, which keeps states of which it is evaluated."""
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
        transverse = self.motion.across(np.array([y for _, y in self.kept]).reshape(len(self.kept), -1, 3))
        reversals = np.argwhere(((transverse[:, 1:] * transverse[:, :-1]).sum(-1) < 0).all(0))
        if len(reversals) and not self.passed:
            self.passed = self.kept[reversals[0, 0] + 1][0], int(reversals[0, 1])
        del self.kept[:-1]
