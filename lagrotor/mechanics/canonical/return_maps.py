"""The return map of a periodic orbit as power series, and Birkhoff's normal form of a canonical map about a fixed point.

In coordinates in which the linear part Λ is diagonal, z_j → e^{−iα_j} z_j, F = Φ_h ∘ Λ with the flow Φ_h of a series h in unit
time. A change of coordinates Φ_χ of degree d takes h_d to h_d − χ + χ∘Λ⁻¹: degree by degree all goes but the terms with

    |1 − e^{iα·(a − b)}| ≈ 0       of z^a w^b:    F = Φ_K ∘ Λ,     K of the actions I_j = z_j w_j and the resonances.

The angle of a return is then α_j + ∂K/∂I_j.

Of a periodic orbit without drive the section is plane: with x = x₀ + S (x_1, y, p_1), S canonical and x_1 along the motion, it is
x_1 = 0, and p_1(y) is what the energy leaves. dx_1 ∧ dp_1 vanishes on it, so that y has canonical brackets. The motion of a
series in y (see `taylor_series`) gives the map through any degree, and the time of the return as another series. With a drive y
is all of x − x₀.

Birkhoff, Dynamical Systems (1927), ch. III; Moser, Stable and Random Motions in Dynamical Systems (1973), II.3; Arnold,
Mathematical Methods of Classical Mechanics, app. 7.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.algebra import decide_zero, derivative
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.canonical.normal_coordinates import normal_coordinates
from lagrotor.mechanics.canonical.normal_forms import NormalForm, check_form_order
from lagrotor.mechanics.canonical.polynomials import (
    Coefficients,
    Polynomial,
    lie_transform,
    linear_form,
    polynomial,
    total,
    variable,
)
from lagrotor.mechanics.canonical.taylor_series import JetSpace, TruncatedSeries, jet_space
from lagrotor.mechanics.lagrangian import clock_parts, gradient, t
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.codegen import Program
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.printers import compile_program
from lagrotor.numerics.pulse import Window, brief_windows
from lagrotor.numerics.segment import StopError

_RESONANT = 1e-7  # |1 − e^{iα·(a − b)}| that is zero in floating-point numbers
_NEAR = 1e-6  # of 1 or −1: a multiplier that is taken to be it


@dataclass(frozen=True, eq=False, repr=False)
class ReturnMapForm(NormalForm):
    """The return map in normal form, F = Φ_K ∘ Λ with `series` = sum_j α_j z_j w_j + K: `frequencies` are angles α_j of a return.

    α_j (rad) lies between −π and π and is known up to turns, its sign that of Krein, as that of an energy; of a hyperbolic
    pair it is the logarithm of the multiplier, and K a series in its product z w.

    Attributes
    ----------
    period : float, default 0.0
        Of the orbit, s.
    orbit : mapping, optional
        Its start, {q or p: value}.
    frame : tuple[Polynomial, ...], default ()
        (q, p) − (q₀, p₀) of the displacement y, a series of its components (u_1 … u_m, v_1 … v_m).
    unit : float, default 1.0
        Of an action, that of the orbit's size.
    error
        The largest difference of a degree's coefficients over the largest of them, between two integrations, and of the
        map from what the form gives back.
    """

    period: float = 0.0
    orbit: Mapping[sp.Symbol, float] = None  # type: ignore[assignment]
    frame: tuple[Polynomial, ...] = ()
    unit: float = 1.0

    @cached_property
    def multipliers(self) -> NDArray[np.complex128]:
        """Λ: of z_1 … z_m, w_1 … w_m; Floquet's, without the two of the motion along the orbit and across energies."""
        rates = self.weights * np.array(self.frequencies)
        return np.exp(np.concatenate([rates, -rates]))

    @cached_property
    def twist(self) -> Array:
        """∂α_j/∂I_k (m, m) at the orbit, rad per unit of action."""
        rows = np.eye(len(self.frequencies), dtype=int)
        return np.array([[self.actions.get(tuple((a + b).tolist()), 0.0) * (1 + a @ b) for b in rows] for a in rows])

    def rotation_numbers(self, actions: Sequence[float] | None = None) -> tuple[float, ...]:
        """Turns about the orbit in a return, between −½ and ½ at the orbit; of oscillations, resonances left out."""
        at = [0.0] * len(self.frequencies) if actions is None else actions
        return tuple(
            a / (2 * pi) if c == -1j else np.nan for a, c in zip(self.frequencies_at(at), self.weights, strict=True)
        )

    def place(self, z: Sequence[complex]) -> dict[sp.Symbol, float]:
        """The point (q, p) on the section whose normal coordinates are z and w = z̄ (oscillations)."""
        point = np.concatenate([z, np.conj(z)])
        y = [self.original(linear_form(row)).at(point) for row in self.vectors]
        return {s: x + float(f.at(np.array(y)).real) for (s, x), f in zip(self.orbit.items(), self.frame, strict=True)}

    def summary(self) -> dict[str, str]:
        """As `NormalForm.summary`, with the period."""
        return {"period": f"{self.period:.10g} s"} | super().summary()


def map_normal_form(F: Sequence[Polynomial], order: int, detuning: float = 0.0) -> NormalForm:
    """The normal form of a canonical map y → F(y), y = (u_1 … u_m, v_1 … v_m), F(0) = 0, through K of an order.

    Parameters
    ----------
    F : sequence
        Real polynomials through the degree order − 1.
    detuning : float, default 0.0
        |1 − e^{iα·(a − b)}| up to which a resonance is kept.

    Raises
    ------
    InputError
        Where F is no such map to first order.
    SingularError
        Where a multiplier is 1 or −1, above 10⁶, or double and not diagonal, or some too near to 1 beside others
        near −1.
    """
    check_form_order(order, detuning)
    n = len(F)
    if not n or n % 2 or any(not isinstance(f, Polynomial) or f.variables != n for f in F):
        raise InputError("map_normal_form: give 2 m polynomials in as many variables, (u_1 … u_m, v_1 … v_m)")
    m, degree = n // 2, order - 1
    units = np.eye(n, dtype=int)
    M = np.array([[f.terms.get(tuple(e), 0.0) for e in units.tolist()] for f in F]).real
    none, one = np.zeros((m, m)), np.eye(m)
    J = np.block([[none, one], [-one, none]])
    if (
        any(len(f.part(0).coefficients) for f in F)
        or not np.abs(M.T @ J @ M - J).max() < _NEAR * (1 + np.abs(M).max()) ** 2
    ):
        raise InputError(
            f"map_normal_form: F is no canonical map with F(0) = 0: M = {M.tolist()} of its first order has not MᵀJM = J, or F "
            "has a constant"
        )
    if (most := np.abs(np.linalg.eigvals(M)).max()) > 1 / _NEAR:
        raise SingularError(
            f"normal_form: a multiplier is {most:.2g}, too far from its reciprocal for floating-point numbers: "
            "System.floquet gives both"
        )
    for value in (1, -1):
        if (near := np.abs(np.linalg.eigvals(M) - value).min()) < _NEAR:
            way = "name the momentum of a symmetry, or " if value == 1 else ""
            raise SingularError(
                f"normal_form: a multiplier is {value} to {near:.1g}: {way}move a parameter or the energy off this value"
            )
    normal = normal_coordinates(-J @ (M - np.eye(n)) @ np.linalg.inv(M + np.eye(n)), J)  # the same vectors: Cayley
    shares, weights = normal.frequencies, normal.weights
    angles = np.array(
        [2 * np.arctan(s.real) if c == -1j else np.log((1 + s) / (1 - s)) for s, c in zip(shares, weights, strict=True)]
    )
    rates = np.concatenate([weights * angles, -weights * angles])
    back = np.linalg.inv(normal.vectors)
    pair = np.diag(weights)
    brackets = normal.vectors @ np.block([[none, pair], [-pair, none]]) @ normal.vectors.T - J
    left = np.abs(back @ M @ normal.vectors - np.diag(np.exp(rates))).max() / np.abs(np.exp(rates)).max()
    linear = float(max(left, np.abs(brackets).max()))  # multipliers that are taken as equal
    if not linear < _NEAR:
        raise SingularError(
            f"normal_form: the multipliers {np.linalg.eigvals(M).tolist()} are not separated, {linear:.1g} is left: some are "
            "near 1 and others near −1; move a parameter or the energy"
        )
    rows = [linear_form(row) for row in normal.vectors]
    inner = [f.substitute(rows, degree) for f in F]
    z = [variable(k, n) for k in range(n)]
    higher = [total([g.times(c) for c, g in zip(row, inner, strict=True)]) for row in back]
    f = [total([g - g.part(1), z[k].times(np.exp(rates[k]))]) for k, g in enumerate(higher)]
    given, K, generators = f, z[0].part(-1), list[Polynomial]()
    for d in range(3, order + 1):
        h = _exponent(f, K, rates, weights, d)
        shift = 1 - np.exp(-(h.exponents @ rates))
        kept = np.abs(shift) <= max(detuning, _RESONANT)
        K, chi = K + h.where(kept), h.where(~kept).over(shift[~kept])
        generators.append(chi)
        if len(chi.coefficients):
            f = _conjugate(f, chi, weights, degree)
    pairs = {tuple((units[j] + units[m + j]).tolist()): a for j, a in enumerate(angles)}
    series = polynomial(pairs, n) + K
    plain = tuple(complex(a) if abs(a.imag) > 0 else float(a.real) for a in angles)
    form = NormalForm(plain, series, weights, tuple(generators), normal.vectors, order, 0.0)
    return replace(form, error=max(linear, _error(given, form, rates, K)))


def _exponent(f: Sequence[Polynomial], K: Polynomial, rates: Coefficients, weights: Coefficients, d: int) -> Polynomial:
    """h_d of f = Φ_{K + h_d + …} ∘ Λ, from what K leaves of f ∘ Λ⁻¹ at degree d − 1: {x, h_d}, and Euler's rule."""
    m = len(weights)
    parts = []
    for k in range(2 * m):
        part = f[k].part(d - 1)
        left = part.times(np.exp(-(part.exponents @ rates))) - lie_transform(
            variable(k, 2 * m), K, weights, d - 1
        ).part(d - 1)
        other, sign = (k + m, 1) if k < m else (k - m, -1)
        parts.append(left.product(variable(other, 2 * m), d).times(sign / weights[k % m] / d))
    return total(parts)


def _conjugate(f: Sequence[Polynomial], chi: Polynomial, weights: Coefficients, degree: int) -> list[Polynomial]:
    """Φ_χ⁻¹ ∘ f ∘ Φ_χ."""
    away = [lie_transform(variable(k, len(f)), chi.times(-1), weights, degree) for k in range(len(f))]
    return [lie_transform(g.substitute(f, degree), chi, weights, degree) for g in away]


def _error(f: Sequence[Polynomial], form: NormalForm, rates: Coefficients, K: Polynomial) -> float:
    """How far Φ_χ ∘ (Φ_K ∘ Λ) ∘ Φ_χ⁻¹ is from the map."""
    n, degree = len(f), form.known_through - 1
    g = [lie_transform(variable(k, n), K, form.weights, degree) for k in range(n)]
    g = [part.times(np.exp(part.exponents @ rates)) for part in g]
    for chi in reversed(form.generators):
        g = _conjugate(g, chi.times(-1), form.weights, degree) if len(chi.coefficients) else g
    return largest_difference(f, g)


def largest_difference(f: Sequence[Polynomial], g: Sequence[Polynomial]) -> float:
    """The largest difference of coefficients of a degree over the largest of that degree, or of the lowest one."""
    sizes = dict[int, float]()
    for d, part in ((d, part) for whole in f for d, part in whole.parts.items()):
        sizes[d] = max(sizes.get(d, 0.0), float(np.abs(part.coefficients).max()))
    least = sizes[min(sizes)]
    apart = [(d, part) for a, b in zip(f, g, strict=True) for d, part in (a - b).parts.items()]
    return max(
        (float(np.abs(part.coefficients).max()) / max(sizes.get(d, 0.0), least) for d, part in apart), default=0.0
    )


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

    def is_periodic(self, path: Array, period: float) -> bool:
        """Return whether the rates at a path (m, 2n), and at places about it, are the same a period later, to rounding."""
        about = path + np.random.default_rng(1).normal(size=path.shape)
        for share, places in zip(np.linspace(0, 1, len(path)), zip(path, about, strict=True), strict=True):
            time = self.begin + share * period
            for place in places:
                now, later = (np.array(self._rates(*place, at), float) for at in (time, time + period))
                if not np.abs(later - now).max() <= 1e-9 * np.abs(now).max() + 1e-14:
                    return False
        return True

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
        raise DomainError("normal_form: about an orbit of one degree of freedom nothing is left: leave out the period")
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
        if driven and not motion.is_periodic(path, period):
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
