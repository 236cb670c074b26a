"""The return map of a periodic orbit as power series, and its normal form: see `return_maps`.

Without drive the section is plane: with x = x₀ + S (x_1, y, p_1), S canonical and x_1 along the motion, it is x_1 = 0, and p_1(y)
is what the energy leaves. dx_1 ∧ dp_1 vanishes on it, so that y has canonical brackets. The motion of a series in y
(see `jets`) gives the map through any degree, and the time of the return as another series. With a drive y is all of x − x₀.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.algebra import decide_zero
from lagrotor.errors import DomainError, InputError, IntegrationError
from lagrotor.mechanics.canonical.jets import JetSpace, TruncatedSeries, jet_space
from lagrotor.mechanics.canonical.polynomials import Polynomial
from lagrotor.mechanics.canonical.return_maps import ReturnMapForm, largest_difference, map_normal_form
from lagrotor.mechanics.lagrangian import gradient, t
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.printers import compile_program

Array = NDArray[np.float64]
_LOCAL = (1e-11, 1e-13)  # errors of a step: of the map that is compared, and of the one that is read
_MOST = 200_000  # evaluations
_NEWTON = 15  # steps to the orbit
_CLOSED = 1e-11  # of the orbit's size: the last of them
_OTHER = 1e-6  # of the orbit's momentum: another one at the same place
_FAR = 0.5  # of the orbit's size or period, without a drive: a step to another orbit than the one that was named


class _Motion:
    """Hamilton's equations for jets."""

    def __init__(self, H: sp.Expr, x: Sequence[sp.Symbol], begin: float) -> None:
        n = len(x) // 2
        rates = (*gradient(H, x[n:]), *-gradient(H, x[:n]))
        self._rates, self._H = (compile_program(Program((*x, t), (), e), "numpy") for e in (rates, (H,)))
        self.begin = begin

    def rate(self, X: list[TruncatedSeries], time: float) -> list[TruncatedSeries]:
        return [_jet(f, X[0].space) for f in self._rates(*X, time)]

    def energy(self, X: list[TruncatedSeries]) -> TruncatedSeries:
        return _jet(self._H(*X, self.begin)[0], X[0].space)

    def path(self, X: list[TruncatedSeries], duration: TruncatedSeries, local: float, shares: Array) -> Array:
        """(k, 2n, N) at shares of a duration that is a series, too: dx/dσ = duration f(x), 0 ≤ σ ≤ 1."""
        space = X[0].space

        def rate(s: float, state: Array) -> list[float]:
            at = [TruncatedSeries(row, space) for row in state.reshape(len(X), -1)]
            moving = self.rate(at, self.begin + s * duration.coefficients[0])
            return np.concatenate([(duration * f).coefficients for f in moving]).tolist()

        start = np.concatenate([f.coefficients for f in X])
        return integrate(Problem(rate, start, _MOST), shares, local).states.reshape(len(shares), len(X), -1)

    def moved(self, X: list[TruncatedSeries], duration: TruncatedSeries, local: float) -> list[TruncatedSeries]:
        return [TruncatedSeries(row, duration.space) for row in self.path(X, duration, local, np.ones(1))[0]]


@dataclass(frozen=True, eq=False)
class _Return:
    """y → F(y) of displacements in the orbit's units, the start x of y, both as jets, and the period."""

    F: list[TruncatedSeries]
    start: list[TruncatedSeries]
    period: float
    apart: float = 0.0  # of p_1, that the energy leaves: it may leave two


def _jet(value: Any, space: JetSpace) -> TruncatedSeries:
    return value if isinstance(value, TruncatedSeries) else space.constant(float(value))


def _combined(columns: Array, parts: Sequence[TruncatedSeries]) -> list[TruncatedSeries]:
    """Sᵀ times a vector of jets."""
    rows = np.array([f.coefficients for f in parts])
    return [TruncatedSeries(row, parts[0].space) for row in columns.T @ rows]


def _along(rate: Array) -> Array:
    """S, orthogonal and canonical, (2n, 2n), x_1 along a rate: a unitary matrix for q + i p."""
    n = len(rate) // 2
    Q, R = np.linalg.qr(np.column_stack([rate[:n] + 1j * rate[n:], np.eye(n)]))
    Q[:, 0] *= R[0, 0] / abs(R[0, 0])
    return np.block([[Q.real, -Q.imag], [Q.imag, Q.real]])


@dataclass(frozen=True, eq=False)
class _Orbit:
    """What one return is followed with: units (2n,) of x, the angles' turns, and E, None with a drive."""

    motion: _Motion
    units: Array
    turns: Array
    energy: float | None

    def returned(self, x: Array, period: float, degree: int, local: float) -> _Return:
        n = len(x) // 2
        space = jet_space(2 * n - 2 * (self.energy is not None), degree)
        y = [space.variable(k) for k in range(space.exponents.shape[1])]
        if self.energy is None:
            start = [y[k] * self.units[k] + x[k] for k in range(2 * n)]
            end = self._back(self.motion.moved(start, space.constant(period), local), x)
            return _Return(end, start, period)
        speed = np.array([f.coefficients[0] for f in self.motion.rate(_numbers(x), self.motion.begin)]) / self.units
        if not np.abs(speed).max() * period > 1e-6:
            raise InputError("normal_form: nothing moves at this start: leave out the period for an equilibrium")
        S = _along(speed)
        slope = self.units[0] * self.units[n] * np.linalg.norm(speed)  # ∂H/∂p_1
        place, p = [space.constant(0.0), *y[: n - 1], space.constant(0.0), *y[n - 1 :]], space.constant(0.0)
        start = []
        for _ in range(degree + 2):
            place[n] = p
            start = [f * u + s for f, u, s in zip(_combined(S.T, place), self.units, x, strict=True)]
            p = p - (self.motion.energy(start) - self.energy) / slope
        X, ahead = self.motion.moved(start, space.constant(period), local), S[:, :1]
        for _ in range(degree.bit_length() + 2):
            late = _combined(ahead, self._back(X, x))[0]
            rate = [f / u for f, u in zip(self.motion.rate(X, self.motion.begin), self.units, strict=True)]
            wait = -late / _combined(ahead, rate)[0]
            if not abs(wait.coefficients[0]) < _FAR * period:
                raise InputError(
                    f"normal_form: no return near t = {period:.6g} s: give a start on the orbit and its period"
                )
            period += wait.coefficients[0]
            X = self.motion.moved(X, wait, local)
        there = _combined(S, self._back(X, x))
        return _Return([*there[1:n], *there[n + 1 :]], start, period, abs(float((there[n] - p).coefficients[0])))

    def _back(self, X: list[TruncatedSeries], x: Array) -> list[TruncatedSeries]:
        """(X − x)/units, without whole turns."""
        return [(f - s) / u for f, s, u in zip(X, x + self.turns, self.units, strict=True)]


def _numbers(x: Array) -> list[TruncatedSeries]:
    return [jet_space(1, 0).constant(value) for value in x]


def return_map_form(
    H: sp.Expr, x: Sequence[sp.Symbol], at: Mapping[Any, float], period: float, order: int, detuning: float
) -> ReturnMapForm:
    """The normal form about the periodic orbit near the start `at`, of the same energy, or of the drive's period.

    Raises InputError where there is none near, or it does not move; DomainError where H is not analytic; SingularError as
    `map_normal_form`.
    """
    n, begin, driven = len(x) // 2, float(at.get(t, 0.0)), H.has(t)
    if n == 1 and not driven:
        raise DomainError("normal_form: about an orbit of one degree of freedom nothing is left: see `libration`")
    start = np.array([float(at[s]) for s in x])
    motion = _Motion(H, x, begin)
    try:
        path = motion.path(_numbers(start), jet_space(1, 0).constant(period), _LOCAL[1], np.linspace(0, 1, 65))[..., 0]
        if driven and not _of_drive(motion, path, period):
            raise InputError(f"normal_form: H has not the period {period:.9g} s: give that of what drives")
        turned = np.round((path[-1] - start) / (2 * pi)) * (np.arange(2 * n) < n)
        same = {s: s + 2 * sp.pi * int(k) for s, k in zip(x, turned, strict=True) if k}
        turns = 2 * pi * turned * (decide_zero(H.xreplace(same) - H).answer == "zero")
        orbit = _Orbit(
            motion, _units(path), turns, None if driven else float(motion.energy(_numbers(start)).coefficients[0])
        )
        for _ in range(_NEWTON):
            one = orbit.returned(start, period, 1, _LOCAL[1])
            c, M = np.array([f.coefficients[0] for f in one.F]), np.array([f.coefficients[1:] for f in one.F])
            step = np.linalg.lstsq(np.eye(len(c)) - M, c)[0]
            if not np.abs(step).max() < (np.inf if driven else _FAR):
                raise InputError(
                    f"normal_form: after {one.period:.6g} s the motion is off its start by {np.abs(c).max():.2g} of its size, "
                    "and no periodic orbit is near: give a start on it and its period"
                )
            start = np.array([f.coefficients @ np.append(1.0, step) for f in one.start])
            period = one.period
            if np.abs(step).max() < _CLOSED:
                break
        else:
            raise InputError("normal_form: the orbit is not found to rounding: give a start nearer to it")
        if one.apart > _OTHER:
            raise InputError(
                f"normal_form: after {period:.6g} s the motion from {dict(at)} is at its start with another momentum: the orbit "
                "is not closed; give its whole period"
            )
        returns = [orbit.returned(start, period, order - 1, local) for local in _LOCAL]
    except IntegrationError as stop:
        raise InputError(f"normal_form: the motion from {dict(at)} cannot be followed: {stop}") from None
    maps = [[f.polynomial.where(f.polynomial.exponents.sum(1) > 0) for f in one.F] for one in returns]
    coarse, fine = (map_normal_form(F, order, detuning * period) for F in maps)
    error = max(
        fine.error, largest_difference(maps[1], maps[0]), largest_difference([fine.series], [coarse.series]),
        *(abs(float(f.coefficients[0])) for f in returns[1].F),
    )  # fmt: skip
    unit = orbit.units[0] * orbit.units[n]  # of an action

    def scaled(f: Polynomial, power: int) -> Polynomial:
        return f.times(unit ** (power - f.exponents.sum(1) / 2))

    beginning = {s: float(f.coefficients[0]) for s, f in zip(x, returns[1].start, strict=True)}
    return ReturnMapForm(
        **vars(replace(
            fine, series=scaled(fine.series, 1), generators=tuple(scaled(g, 1) for g in fine.generators), error=error
        )),
        period=returns[1].period, orbit=beginning,
        frame=tuple(scaled((f - f.coefficients[0]).polynomial, 0) for f in returns[1].start), unit=float(unit),
    )  # fmt: skip


def _of_drive(motion: _Motion, path: Array, period: float) -> bool:
    """Whether the rates are the same a period later, beside the orbit and to rounding of its number."""
    for share, place in zip(np.linspace(0, 1, len(path)), path, strict=True):
        beside = _numbers(place + 0.1 * np.cos(np.arange(len(place)) + 7 * share))
        time = motion.begin + share * period
        now, later = (np.array([f.coefficients[0] for f in motion.rate(beside, s)]) for s in (time, time + period))
        if not np.abs(later - now).max() < 1e-9 * (1 + np.abs(now).max()):
            return False
    return True


def _units(path: Array) -> Array:
    """Of q and p, (2n,), with the same product in each pair, in which the orbit is about 1 wide."""
    n = path.shape[1] // 2
    q, p = np.split(np.ptp(path, axis=0) / 2, 2)
    wide = (q > 1e-9 * q.max()) & (p > 1e-9 * p.max())
    if not wide.any():
        return np.ones(2 * n)
    ratios = np.where(wide, q / np.where(wide, p, 1.0), np.exp(np.log(q[wide] / p[wide]).mean()))
    action = (q * p).max()
    return np.concatenate([np.sqrt(action * ratios), np.sqrt(action / ratios)])
