"""The exact motion of N rotors and B bars: unit vectors with multipliers, large motion, every load and drive.

    sum_j A_ij r_j'' = G_i r_i × r_i' − S_i (g e_z + a(t)) + R_i f_i(t) + hinge, friction, braces + sum_c lam_c grad_i g_c

with |r_i|² = 1 and |X_j − X_i|² = ell² (X_i = p_i + R_i r_i), f_i the force on tip i, a(t) the ground's acceleration: the
equations are those in the ground's frame. The hinge's energy is kappa theta²/2, friction is −c r_i', and the axial momentum
decays by its own friction, G_i(t) = G_i exp(−c_s t / I3). For N = 2 without load: `lagrotor.models.spheres`.

Where a bar is in line with both its axes the constraints are dependent: the motion has no unique continuation, and an integrator
that steps over the place goes on along one of them without notice. The direction of the bar across an axis, d × r, turns round
where the two are in line. If it turns round at both ends from one state of a run to the next, the place lies between them.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lagrotor.numerics.segment import RightHandSide, StopError
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, Coefficients, coefficients
from lagrotor.structures.exact.forces import (
    along_bars,
    cross_product,
    forces,
    off_constraints,
    pulls,
    rates_of_constraints,
    right_side,
    stretches,
)
from lagrotor.structures.exact.saddle import Saddle, saddle

Drive = Callable[[float], Array]
_ROWS = 1_000  # of the systems that are solved together


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

    def distance(self, one: Array, other: Array) -> Array:
        """The largest difference of an axis between states (n, 6 N), (n,)."""
        apart = self.axes_and_rates(one)[0] - self.axes_and_rates(other)[0]
        return np.asarray(np.linalg.norm(apart, axis=-1).max(axis=1))

    def difference_of_rates(self, one: Array, other: Array) -> float:
        """The largest difference of a component of r'/rate between states (n, 6 N)."""
        return float(np.abs(self.axes_and_rates(one)[1] - self.axes_and_rates(other)[1]).max(initial=0.0))

    def defect(self, states: Array, conserved: bool) -> Array:
        """The errors of axes that explain how far states (n, 6 N) are off the constraints and, where conserved, their energy."""
        c = self.c
        r, v = self.axes_and_rates(states) * np.array([1.0, c.rate])[:, None, None, None]
        R = np.maximum(c.R[c.i], c.R[c.j])
        off = (off_constraints(c, r) / np.append(np.ones(len(c.R)), R * np.maximum(R, c.ell))).ravel()
        if not conserved:
            return off
        energy = self.energy(r, v)
        return np.append(off, (energy - energy[0]) / (self.energy_scale(r, v) or 1.0))

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
        moved = [
            self.saddle.solve(r[part], (first[part], second[part]), right[part])[:, : 3 * N]
            for part in (slice(k, k + at_once) for k in range(0, len(states), at_once))
        ]
        return (states + np.concatenate(moved).swapaxes(1, 2).reshape(states.shape)).T.reshape(y.shape)


def exact_motion(s: Assembly, force: Drive | None = None, ground: Drive | None = None) -> ExactMotion:
    """The exact model of a structure.

    Args:
        s: the structure.
        force: t → forces on its tips, (N, 3), N.
        ground: t → accelerations of its ground.
    """
    return ExactMotion(coefficients(s), saddle(s), force, ground)


_IN_LINE = 1e-3  # sine of the angle between a bar and both its axes at which a solver that stops has come to it
_AT_ONCE = 64  # states that are looked at together
_EVERY = 3  # evaluation of a right-hand side is looked at


def bar_in_line(motion: ExactMotion, y: Array) -> str:
    """The words of a state at which a solver stopped as a bar had come into line with both its axes; none where none has."""
    c = motion.c
    across = np.linalg.norm(motion.across(motion.axes_and_rates(y[None])[0, 0]), axis=-1) / c.ell
    bars = np.flatnonzero((across < _IN_LINE).all(axis=0))
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
        across = self.motion.across(np.array([y for _, y in self.kept]).reshape(len(self.kept), -1, 3))
        turned = np.argwhere(((across[:, 1:] * across[:, :-1]).sum(-1) < 0).all(0))
        if len(turned) and not self.passed:
            self.passed = self.kept[turned[0, 0] + 1][0], int(turned[0, 1])
        del self.kept[:-1]
