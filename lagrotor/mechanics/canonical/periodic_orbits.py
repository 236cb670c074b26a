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

from lagrotor.algebra import decide_zero, derivative
from lagrotor.errors import DomainError, InputError
from lagrotor.mechanics.canonical.jets import JetSpace, TruncatedSeries, jet_space
from lagrotor.mechanics.canonical.polynomials import Polynomial
from lagrotor.mechanics.canonical.return_maps import ReturnMapForm, largest_difference, map_normal_form
from lagrotor.mechanics.lagrangian import clock_parts, gradient, t
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.printers import compile_program
from lagrotor.numerics.pulse import Window, brief_windows
from lagrotor.numerics.segment import StopError

_LOCAL = (1e-11, 1e-13)  # errors of a step: of the map that is compared, and of the one that is read
_MOST = 200_000  # evaluations
_RESCALED = 6  # times, until the units are those of the orbit
_NEWTON = 15  # steps to the orbit
_CLOSED = 1e-11  # of the orbit's size: the last of them
_OTHER = 1e-6  # of the orbit's momentum: another one at the same place
_FAR = 0.5  # of the orbit's size or period, without a drive: a step to another orbit than the one that was named


class _Motion:
    """Hamilton's equations for jets of x in units (2n,), the same product in each pair."""

    def __init__(self, H: sp.Expr, x: Sequence[sp.Symbol], begin: float, units: Array) -> None:
        n = len(x) // 2
        H = H.xreplace({s: sp.Float(u, 17) * s for s, u in zip(x, units, strict=True)}) / sp.Float(
            units[0] * units[n], 17
        )
        rates = (*gradient(H, x[n:]), *-gradient(H, x[:n]))
        self._rates, self._H = (compile_program(Program((*x, t), (), e), "numpy") for e in (rates, (H,)))
        _, parts = clock_parts((), rates, {*x})
        self._drives = compile_program(Program((t,), (), tuple(parts)), "numpy") if parts else None
        self.begin = begin

    def windows(self, duration: float) -> tuple[Window, ...]:
        """Where a drive acts briefly, by shares of a duration."""
        drives, begin = self._drives, self.begin
        if drives is None:
            return ()

        def along(shares: Array) -> Array:
            return np.vstack([np.broadcast_to(f, shares.shape) for f in drives(begin + shares * duration)])

        return brief_windows(along, 0.0, 1.0)

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
        problem = Problem(rate, start, _MOST, windows=self.windows(duration.coefficients[0]))
        return integrate(problem, shares, local).states.reshape(len(shares), len(X), -1)

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
    """What one return is followed with: the angles' turns, and E, None with a drive."""

    motion: _Motion
    turns: Array
    energy: float | None

    def returned(self, x: Array, period: float, degree: int, local: float) -> _Return:
        n = len(x) // 2
        space = jet_space(2 * n - 2 * (self.energy is not None), degree)
        y = [space.variable(k) for k in range(space.exponents.shape[1])]
        if self.energy is None:
            start = [y[k] + x[k] for k in range(2 * n)]
            end = self._back(self.motion.moved(start, space.constant(period), local), x)
            return _Return(end, start, period)
        speed = np.array([f.coefficients[0] for f in self.motion.rate(_numbers(x), self.motion.begin)])
        if not np.abs(speed).max() * period > 1e-6:
            raise InputError("normal_form: nothing moves at this start: leave out the period for an equilibrium")
        S = _along(speed)
        place, p = [space.constant(0.0), *y[: n - 1], space.constant(0.0), *y[n - 1 :]], space.constant(0.0)
        start = []
        for _ in range(degree + 2):
            place[n] = p
            start = [f + s for f, s in zip(_combined(S.T, place), x, strict=True)]
            p = p - (self.motion.energy(start) - self.energy) / np.linalg.norm(speed)  # ∂H/∂p_1
        X, ahead = self.motion.moved(start, space.constant(period), local), S[:, :1]
        for _ in range(degree.bit_length() + 2):
            late = _combined(ahead, self._back(X, x))[0]
            wait = -late / _combined(ahead, self.motion.rate(X, self.motion.begin))[0]
            if not abs(wait.coefficients[0]) < _FAR * period:
                raise InputError(
                    f"normal_form: no return near t = {period:.6g} s: give a start on the orbit and its period"
                )
            period += wait.coefficients[0]
            X = self.motion.moved(X, wait, local)
        there = _combined(S, self._back(X, x))
        return _Return([*there[1:n], *there[n + 1 :]], start, period, abs(float((there[n] - p).coefficients[0])))

    def _back(self, X: list[TruncatedSeries], x: Array) -> list[TruncatedSeries]:
        """X − x, without whole turns."""
        return [f - s for f, s in zip(X, x + self.turns, strict=True)]


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
    start, units = np.array([float(at[s]) for s in x]), np.ones(2 * n)
    there = {s: sp.Float(at[s]) for s in (*x, t)}
    mobility = [derivative(derivative(H, s), s).xreplace(there) for s in x[n:]]
    ratios = np.array([abs(float(e)) if e.is_finite else 1.0 for e in mobility]) * period / (2 * pi)
    try:
        for _ in range(_RESCALED):
            motion = _Motion(H, x, begin, units)
            duration = jet_space(1, 0).constant(period)
            path = motion.path(_numbers(start / units), duration, _LOCAL[1], np.linspace(0, 1, 65))[..., 0]
            wide = _units(path * units, ratios)
            if np.abs(np.log2(wide / units)).max() < 1:
                break
            units = wide
        if driven and not _of_drive(motion, path, period, order):
            raise InputError(f"normal_form: H has not the period {period:.9g} s: give that of what drives")
        turned = np.round((path[-1] * units - start) / (2 * pi)) * (np.arange(2 * n) < n)
        same = {s: s + 2 * sp.pi * int(k) for s, k in zip(x, turned, strict=True) if k}
        turns = 2 * pi * turned * (decide_zero(H.xreplace(same) - H).answer == "zero") / units
        start = start / units
        orbit = _Orbit(motion, turns, None if driven else float(motion.energy(_numbers(start)).coefficients[0]))
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
    except StopError as stop:
        raise InputError(
            f"normal_form: the motion from {dict(at)} cannot be followed for {period:.6g} s: {stop.reason}; give a start on an "
            "orbit and its period"
        ) from None
    maps = [[f.polynomial.where(f.polynomial.exponents.sum(1) > 0) for f in one.F] for one in returns]
    coarse, fine = (map_normal_form(F, order, detuning * period) for F in maps)
    error = max(
        fine.error, largest_difference(maps[1], maps[0]), largest_difference([fine.series], [coarse.series]),
        *(abs(float(f.coefficients[0])) for f in returns[1].F),
    )  # fmt: skip
    unit = units[0] * units[n]  # of an action

    def scaled(f: Polynomial, power: int) -> Polynomial:
        return f.times(unit ** (power - f.exponents.sum(1) / 2))

    begins = [f * u for f, u in zip(returns[1].start, units, strict=True)]
    beginning = {s: float(f.coefficients[0]) for s, f in zip(x, begins, strict=True)}
    return ReturnMapForm(
        **vars(replace(
            fine, series=scaled(fine.series, 1), generators=tuple(scaled(g, 1) for g in fine.generators), error=error
        )),
        period=returns[1].period, orbit=beginning,
        frame=tuple(scaled((f - f.coefficients[0]).polynomial, 0) for f in begins), unit=float(unit),
    )  # fmt: skip


def _of_drive(motion: _Motion, path: Array, period: float, order: int) -> bool:
    """Whether the rates' series through the form's degree are the same a period later, to rounding of its number."""
    n = path.shape[1]
    space = jet_space(n, order - 1)
    degrees = space.exponents.sum(1)
    for share, place in zip(np.linspace(0, 1, len(path)), path, strict=True):
        time, near = motion.begin + share * period, [space.variable(k) + place[k] for k in range(n)]
        now, later = (np.array([f.coefficients for f in motion.rate(near, s)]) for s in (time, time + period))
        least = 1e-14 * np.abs(now).max()
        for d in range(order):
            part = np.abs(now[:, degrees == d]).max(), np.abs((later - now)[:, degrees == d]).max()
            if not part[1] <= 1e-9 * part[0] + least:
                return False
    return True


def _units(path: Array, ratios: Array) -> Array:
    """Of q and p, (2n,), with the same product in each pair, in which the orbit is about 1 wide. ratios: of q to p at rest."""
    q, p = np.split(np.ptp(path, axis=0) / 2, 2)
    wide = (q > 1e-9 * q.max()) & (p > 1e-9 * p.max())
    if wide.any():
        ratios = np.where(wide, q / np.where(wide, p, 1.0), np.exp(np.log(q[wide] / p[wide]).mean()))
        action = (q * p).max()
    else:
        ratios = np.where((ratios > 0) & (ratios < np.inf), ratios, 1.0)
        action = 1 / ratios.max()
    return np.concatenate([np.sqrt(action * ratios), np.sqrt(action / ratios)])
