"""Steady precessions of a structure, the periodic orbits that continue its modes to finite tilts, and small motion about them.

Bars keep their directions while the axes turn. The motion linearised about a precession therefore has periodic coefficients,
and Floquet multipliers replace modes. Shooting finds the orbit of a state y = (r, r'/rate) and a period T:

    φ_T(y) = y,    u = tilt,    u' = 0,

where u is the component of an axis that is largest in the mode. It proceeds by Gauss–Newton steps along the family from small
tilts (Lyapunov's centre theorem; Meyer & Offin, Introduction to Hamiltonian Dynamical Systems, ch. 9). The monodromy matrix
comes from differences of the exact flow. Two of its multipliers are 1, along the orbit and transverse to the energy; they are
removed before the others are computed. The orbit of one top is its steady precession, with A Ω² cos θ − G Ω + S g = 0.
"""

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.errors import ConstraintError, InputError, LagrotorError
from lagrotor.numerics.floquet_multipliers import multiplier_rows, resolved_multipliers
from lagrotor.numerics.integrate import TIGHTEST, Problem, integrate
from lagrotor.numerics.segment import RightHandSide
from lagrotor.pair.quantities import finite_number
from lagrotor.result_display import Shown
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array, coefficients
from lagrotor.structures.exact.bar_closure import close_bars
from lagrotor.structures.exact.compiled_motion import right_hand_side
from lagrotor.structures.exact.exact_motion import ExactMotion, exact_motion, pulls
from lagrotor.structures.small_motion import check_upright, first_largest, left_by, modes

_STEP = 1e-3  # of the differences of fourth order for the monodromy; half of it, of second order, in Newton's steps
_CLOSED = 1e-11  # of axes and rates: the mismatch of a closed orbit
_NULL = 1e-7  # relative to the largest singular value: smaller ones belong to a family of orbits and are not corrected
_AHEAD = 0.1  # the largest step of the tilt along the family
_LEAST = 1e-3  # the least step; the family ends if it fails
_EQUAL = 1e-6  # relative difference of equal rates
_COARSE, _DIFFERENCES = 1e-7, 5e-11  # tolerances of the differences in Newton's steps and for the multipliers
_MISSED = 10.0  # bound of the relative error of the differences over their tolerance
_NEWTON = 8  # steps to an orbit
_MOST = 100_000  # evaluations of a period
_TOGETHER = 1_000  # components of the states that are integrated with the same steps
_ADVICE = {
    False: "if a mode has a multiple of its rate there may be none; take another mode, or change a spin",
    True: "its family ends or turns near {:.3g}; take a smaller tilt",
}


@dataclass(frozen=True, eq=False, repr=False)
class SteadyPrecession(Shown):
    """A periodic orbit of a structure and its Floquet multipliers.

    - `tilt`: the largest horizontal component of an axis.
    - `period`: the period, s.
    - `axes`: the axes at the moment of largest tilt, (N, 3).
    - `rates`: the rates of the axes at this moment, (N, 3), 1/s.
    - `multipliers`: the Floquet multipliers, (2n,), of which the first two are 1. A multiplier smaller than its error is NaN.
    - `errors`: the estimated error of each multiplier, (2n,). For NaN it is a bound of the modulus.
    - `growth`: the logarithm of the largest modulus per turn; 0 if no multiplier leaves the unit circle by more than its error.
    - `mismatch`: the largest difference of the state (r, r'/rate) after one period.
    """

    tilt: float
    period: float
    axes: Array
    rates: Array
    multipliers: NDArray[np.complex128]
    errors: Array
    growth: float
    mismatch: float

    def summary(self) -> dict[str, str]:
        """Return period, multipliers and growth in words."""
        rows = {"tilt": f"{self.tilt:g}", "period [s]": f"{self.period:.10g}"}
        rows |= {"rate [rad/s]": f"{2 * pi / self.period:.10g}"} | multiplier_rows(
            self.multipliers[2:], self.errors[2:]
        )
        return rows | {"growth": f"{self.growth:.6g} per turn" if self.growth else "none beyond the error"}


def constraint_tangents(motion: ExactMotion, r: Array) -> Array:
    """Return an orthonormal basis (3N, n) of the tangent space of the constraints at the axes r (N, 3)."""
    c, N = motion.c, len(r)
    rows = np.zeros((N + len(c.i), N, 3))
    rows[np.arange(N), np.arange(N)] = r
    bars = N + np.arange(len(c.i))
    rows[bars, c.i], rows[bars, c.j] = pulls(c, r)
    rank, vectors = left_by(rows.reshape(len(rows), -1))
    return np.asarray(vectors[:, int(rank) :])


@dataclass(frozen=True, eq=False)
class _Shooting:
    """The flow of states y (6N,) in the time c.rate t. The axis component number `component` of y is held at the tilt."""

    motion: ExactMotion
    rhs: RightHandSide
    component: int

    def end(self, y: Array, duration: float, local: float = TIGHTEST) -> Array:
        problem = Problem(self.rhs, y, _MOST, project=self.motion.project, typical_rate=1.0)
        return integrate(problem, np.array([duration]), local).end

    def ends(self, states: Array, duration: float, local: float) -> Array:
        """Return the final states, (6N, m), of m neighbouring states. Groups of them share their steps, so that the error of a
        difference is relative to the difference."""
        size = len(states)

        def rates(s: float, y: Array) -> Any:
            return np.transpose([self.rhs(s, state) for state in y.reshape(-1, size)]).T.ravel()

        def project(y: Array) -> Array:
            columns = y.reshape(-1, size, *y.shape[1:]).swapaxes(0, 1)
            return self.motion.project(columns.reshape(size, -1)).reshape(columns.shape).swapaxes(0, 1).reshape(y.shape)

        blocks = []
        for some in np.array_split(states.T, -(-states.size // _TOGETHER)):
            problem = Problem(rates, some.ravel(), _MOST, project=project, typical_rate=1.0)
            blocks.append(integrate(problem, np.array([duration]), local).end.reshape(some.shape))
        return np.concatenate(blocks).T

    def slopes(self, y: Array, duration: float, weights: dict[float, Array], local: float) -> Array:
        """Return derivatives of the start y and of the state after `duration`, (k, 2, 6N, 2n). They are differences along 2n
        directions on the constraints. `weights` maps a step to its weights in k formulas."""
        tangents = np.kron(np.eye(2), constraint_tangents(self.motion, y[: len(y) // 2].reshape(-1, 3)))
        steps, shares = np.array(list(weights)), np.array(list(weights.values()))
        moved = (y[:, None, None] + steps[:, None] * tangents[:, None]).reshape(len(y), -1)
        states = self.motion.project(self.motion.project(moved))
        both = np.stack([states, self.ends(states, duration, local)])
        return np.einsum("sk,aisj->kaij", shares, both.reshape(2, len(y), len(steps), -1))

    def orbit(self, y: Array, duration: float, tilt: float) -> tuple[Array, float, float]:
        """Find the orbit of a tilt by Newton's method from y, and return (start, duration, mismatch). Raises
        ConstraintError."""
        fixed = [self.component, len(y) // 2 + self.component]
        sides = {k * _STEP / 2: np.array([k / _STEP]) for k in (1, -1)}
        for _ in range(_NEWTON):
            end = self.end(y, duration)
            residual = np.concatenate([end - y, y[fixed] - [tilt, 0.0]])
            if np.abs(residual).max() < _CLOSED:
                return y, duration, float(np.abs(end - y).max())
            start, later = self.slopes(y, duration, sides, _COARSE)[0]
            ahead = np.append(np.asarray(self.rhs(0.0, end)), [0.0, 0.0])
            rows = np.column_stack([np.vstack([later - start, start[fixed]]), ahead])
            change = np.linalg.lstsq(rows, -residual, rcond=_NULL)[0]
            if not np.abs(change).max() < 0.5 * duration:
                break
            y = self.motion.project(self.motion.project(y + start @ change[:-1]))
            duration += float(change[-1])
        raise ConstraintError("Newton's method does not reach a periodic orbit")


def steady_precession(s: Assembly, mode: int = 0, tilt: float = 0.1) -> SteadyPrecession:
    """Find the periodic orbit of a mode at a finite tilt: see `Structure.steady_precession`."""
    where = "steady_precession"
    rate, shape = precessing_mode(s, mode, where)
    size = finite_number(tilt, f"{where}: tilt", "parts of a unit vector")
    if not 0 < size < 1:
        raise InputError(f"{where}: tilt = {size:g} must lie between 0 and 1, the sine of a right angle")
    if size < _STEP:
        raise InputError(
            f"{where}: tilt = {size:g} is below {_STEP:g}, the step of the differences: use modes() instead"
        )
    motion = exact_motion(s)
    c = motion.c
    lead = int(first_largest(np.abs(shape).ravel()))
    shoot = _Shooting(motion, right_hand_side(motion), 3 * (lead // 2) + lead % 2)
    zeros = np.zeros((len(shape), 1))

    def scaled(y: Array, ratio: float) -> Array:
        """Return the state y with all tilts and rates multiplied by `ratio`, projected onto the constraints."""
        r, v = y.reshape(2, -1, 3) * ratio
        r[:, 2] = np.sqrt(np.maximum(1 - (r[:, :2] ** 2).sum(1), 1e-3))
        r = close_bars(motion, r / np.linalg.norm(r, axis=1)[:, None])
        return motion.project(motion.project(np.concatenate([r.ravel(), v.ravel()])))

    begin = np.hstack([shape.real, zeros, -shape.imag * rate / c.rate, zeros]).reshape(-1, 2, 3).swapaxes(0, 1).ravel()
    at, ahead, duration = 0.0, min(_AHEAD, size), 2 * pi * c.rate / rate
    y = begin
    while at < size:
        target = min(size, at + ahead)
        try:
            y, duration, mismatch = shoot.orbit(scaled(y, target / (at or 1.0)), duration, target)
            at, ahead = target, min(_AHEAD, 2 * ahead)
        except (LagrotorError, np.linalg.LinAlgError):
            ahead /= 2
            if ahead < _LEAST:
                raise InputError(
                    f"{where}: no periodic orbit of tilt {size:g} is reached from mode {mode}: {_ADVICE[at > 0].format(at)}"
                ) from None
    multipliers, errors = _multipliers(shoot, y, duration)
    outside = np.abs(multipliers) > 1 + errors  # False for NaN, a multiplier too small to be resolved
    growth = float(np.log(np.abs(multipliers[outside]).max())) if outside.any() else 0.0
    axes, rates = y.reshape(2, -1, 3)
    return SteadyPrecession(size, duration / c.rate, axes, c.rate * rates, multipliers, errors, growth, mismatch)


def precessing_mode(s: Assembly, mode: int, where: str) -> tuple[float, NDArray[np.complex128]]:
    """Return the rate (rad/s) and the shape (N, 2) of a mode that continues as a steady precession at finite tilt. Raises
    InputError if the mode grows, has no rate or shares its rate, and if friction acts."""
    check_upright(s, where)
    linear, c = modes(s), coefficients(s)
    count = len(linear.rates)
    if isinstance(mode, bool) or not isinstance(mode, int | np.integer) or not 0 <= mode < count:
        raise InputError(f"{where}: mode = {mode!r} is not a number from 0 to {count - 1}, as modes() has them")
    if c.decay.any() or c.friction.any() or c.damping.any():
        raise InputError(f"{where}: friction or a damper dissipates energy, and no motion is periodic: set it to zero")
    rate, growth = float(linear.rates[mode]), linear.growth[mode]
    if growth or rate == 0:
        why = f"{'grows' if growth > 0 else 'decays'}, {abs(growth):.3g} 1/s" if growth else "has no rate"
        raise InputError(f"{where}: mode {mode} {why}: only oscillations continue as precessions; take another")
    if (np.abs(np.delete(linear.rates, mode) - rate) < _EQUAL * rate).any():
        raise InputError(
            f"{where}: other modes have the rate of mode {mode}, {rate:.6g} rad/s: any sum of them is a mode, and it is not "
            "known which sums become precessions; change a spin"
        )
    return rate, linear.shapes[mode]


def _multipliers(shoot: _Shooting, y: Array, duration: float) -> tuple[NDArray[np.complex128], Array]:
    """Return the Floquet multipliers and their errors, (2n,) each. The errors compare differences with two steps."""
    shares = {1: (8, 0), 2: (-1, 4), 4: (0, -0.5)}  # weights of differences by one step and by two
    weights = {k * sign * _STEP: sign * np.array(w) / (12 * _STEP) for k, w in shares.items() for sign in (1, -1)}
    slopes = shoot.slopes(y, duration, weights, _DIFFERENCES)
    forms, start = [np.linalg.lstsq(*slope)[0] for slope in slopes], slopes[0, 0]
    flow = np.linalg.lstsq(start, np.asarray(shoot.rhs(0.0, y)))[0]
    neighbours = np.concatenate([y[None] + k * _STEP * start.T for k in (1, -1, 2, -2)])
    axes, rates = shoot.motion.axes_and_rates(neighbours)
    energy = np.split(shoot.motion.energy(axes, shoot.motion.c.rate * rates), 4)
    gained = np.tensordot([8, -8, -1, 1], energy, 1)
    both = np.stack([flow / np.linalg.norm(flow), gained / np.linalg.norm(gained)])
    transverse = np.linalg.svd(both)[2][2:].T
    inner, coarse = (transverse.T @ form @ transverse for form in forms)
    values, right = np.linalg.eig(inner)
    conditions = np.linalg.norm(np.linalg.pinv(right), axis=1) * np.linalg.norm(right, axis=0)
    errors = conditions * (np.linalg.norm(inner - coarse, 2) + _MISSED * _DIFFERENCES * np.linalg.norm(inner, 2))
    order = np.lexsort((-values.imag, np.abs(np.angle(values)), -np.round(np.abs(values), 6)))
    return resolved_multipliers(np.append([1.0, 1.0], values[order]), np.append([0.0, 0.0], errors[order]))
