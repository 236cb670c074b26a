"""The return map of a periodic orbit as power series, and Birkhoff's normal form of a canonical map about a fixed point.

With the linear part Λ diagonal, z_j → e^{−iα_j} z_j, the map is F = Φ_h ∘ Λ with the flow Φ_h of a series h in unit time. A
change of coordinates Φ_χ of degree d changes h_d to h_d − χ + χ∘Λ⁻¹, and removes all terms z^a w^b except the resonant ones,
with

    |1 − e^{iα·(a − b)}| ≈ 0:    F = Φ_K ∘ Λ,     K of the actions I_j = z_j w_j and the resonances.

The rotation angle per return is then α_j + ∂K/∂I_j.

Without a drive the section of a periodic orbit is a plane: with x = x₀ + S (x_1, y, p_1), S canonical and x_1 along the motion,
it is x_1 = 0, and energy conservation gives p_1(y). dx_1 ∧ dp_1 vanishes there, so that y has canonical brackets. The motion of
a series in y (see `taylor_series`) gives the map through any degree, and the return time as another series. With a drive y is
all of x − x₀.

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

_RESONANT = 1e-7  # |1 − e^{iα·(a − b)}| that counts as zero in floating point
_NEAR = 1e-6  # distance from 1 or −1 below which a multiplier counts as equal


@dataclass(frozen=True, eq=False, repr=False)
class ReturnMapForm(NormalForm):
    """The return map of a periodic orbit in normal form, F = Φ_K ∘ Λ.

    Attributes
    ----------
    frequencies : tuple[Any, ...]
        Rotation angle α_j per return in rad, between −π and π, with Krein's sign; for a hyperbolic pair the logarithm of its
        multiplier.
    series : Polynomial
        The polynomial sum_j α_j z_j w_j + K.
    weights : ndarray
        The brackets {z_j, w_j}, shape (m,): −i of oscillations, 1 of hyperbolic pairs.
    generators : tuple[Polynomial, ...]
        The functions χ of degree 3, 4, … in the order in which exp(L_χ) act.
    vectors : ndarray
        The matrix that gives the displacement y from the normal coordinates (z, w) of Λ, shape (2m, 2m).
    known_through : int
        Degree through which the series is known.
    error : float
        Largest relative error of the coefficients of one degree, from the difference between two integrations and from the
        map that is recovered from the normal form.
    field : None
        Coefficients are floating-point numbers.
    period : float
        Period of the orbit in s.
    orbit : mapping
        Initial state of the orbit, {q or p: value}.
    frame : tuple[Polynomial, ...]
        The state (q, p) − (q₀, p₀) as series in the components (u_1 … u_m, v_1 … v_m) of y.
    unit : float
        Unit of the action, from the size of the orbit, in J s.
    """

    _rate, _unit, _series = "rotation per return", "rad", "the series"

    period: float = 0.0
    orbit: Mapping[sp.Symbol, float] = None  # type: ignore[assignment]
    frame: tuple[Polynomial, ...] = ()
    unit: float = 1.0

    @cached_property
    def multipliers(self) -> NDArray[np.complex128]:
        """The diagonal of Λ for z_1 … z_m, w_1 … w_m: Floquet multipliers without the two trivial ones, shape (2m,)."""
        rates = self.weights * np.array(self.frequencies)
        return np.exp(np.concatenate([rates, -rates]))

    @cached_property
    def twist(self) -> Array:
        """The derivatives ∂α_j/∂I_k at the orbit in rad per unit of action, shape (m, m)."""
        rows = np.eye(len(self.frequencies), dtype=int)
        return np.array([[self.actions.get(tuple((a + b).tolist()), 0.0) * (1 + a @ b) for b in rows] for a in rows])

    def rotation_numbers(self, actions: Sequence[float] | None = None) -> tuple[float, ...]:
        """Return the number of turns about the orbit per return, without resonances.

        Parameters
        ----------
        actions : sequence of float, optional
            The actions in J s, length m; zero, the orbit itself, by default.

        Returns
        -------
        tuple[float, ...]
            One number for each mode, between −½ and ½ on the orbit; nan for a hyperbolic pair.
        """
        at = [0.0] * len(self.frequencies) if actions is None else actions
        rates = zip(self.frequencies_at(at), self.weights, strict=True)
        return tuple(a / (2 * pi) if c == -1j else np.nan for a, c in rates)

    def place(self, z: Sequence[complex]) -> dict[sp.Symbol, float]:
        """Return the point on the section with given normal coordinates z and w = z̄ (oscillations).

        Parameters
        ----------
        z : sequence of complex
            Normal coordinates, length m.

        Returns
        -------
        dict[Symbol, float]
            The coordinates and momenta, {q or p: value}.
        """
        point = np.concatenate([z, np.conj(z)])
        y = [self.original(linear_form(row)).at(point) for row in self.vectors]
        return {s: x + float(f.at(np.array(y)).real) for (s, x), f in zip(self.orbit.items(), self.frame, strict=True)}

    def summary(self) -> dict[str, str]:
        """Summarise the period, the angles, the action terms, the resonances and the error.

        Returns
        -------
        dict[str, str]
            Name → value in words.
        """
        return {"period": f"{self.period:.10g} s"} | super().summary()


def map_normal_form(F: Sequence[Polynomial], order: int, detuning: float = 0.0) -> NormalForm:
    """Return the normal form of a canonical map y → F(y), y = (u_1 … u_m, v_1 … v_m), F(0) = 0, with K through an order.

    `F` are real polynomials through the degree order − 1. Terms with |1 − e^{iα·(a − b)}| up to `detuning` are kept as
    resonances. Raises InputError if F is not canonical to first order. Raises SingularError if a multiplier is 1 or −1, above
    10⁶, or double with too few eigenvectors.
    """
    check_form_order(order, detuning)
    n = len(F)
    if not n or n % 2 or any(not isinstance(f, Polynomial) or f.variables != n for f in F):
        raise InputError("map_normal_form: give 2 m polynomials in as many variables, (u_1 … u_m, v_1 … v_m)")
    m, degree = n // 2, order - 1
    units = np.eye(n, dtype=int)
    M = np.array([[f.terms.get(tuple(e), 0.0) for e in units.tolist()] for f in F]).real
    none, identity = np.zeros((m, m)), np.eye(m)
    J = np.block([[none, identity], [-identity, none]])
    if (
        any(len(f.part(0).coefficients) for f in F)
        or not np.abs(M.T @ J @ M - J).max() < _NEAR * (1 + np.abs(M).max()) ** 2
    ):
        raise InputError(
            f"map_normal_form: F is no canonical map with F(0) = 0: M = {M.tolist()} of its first order violates MᵀJM = J, or F "
            "has a constant term; correct F"
        )
    if (largest := np.abs(np.linalg.eigvals(M)).max()) > 1 / _NEAR:
        raise SingularError(
            f"normal_form: a multiplier is {largest:.2g}, too far from its reciprocal for floating-point numbers: "
            "System.floquet gives both"
        )
    for value in (1, -1):
        if (near := np.abs(np.linalg.eigvals(M) - value).min()) < _NEAR:
            way = "name the momentum of a symmetry, or " if value == 1 else ""
            raise SingularError(
                f"normal_form: a multiplier is {value} within {near:.1g}: {way}change a parameter or energy"
            )
    normal = normal_coordinates(-J @ (M - np.eye(n)) @ np.linalg.inv(M + np.eye(n)), J)  # Cayley: same vectors
    shares, weights = normal.frequencies, normal.weights
    modes = zip(shares, weights, strict=True)
    angles = np.array([2 * np.arctan(s.real) if c == -1j else np.log((1 + s) / (1 - s)) for s, c in modes])
    rates = np.concatenate([weights * angles, -weights * angles])
    inverse = np.linalg.inv(normal.vectors)
    pair = np.diag(weights)
    brackets = normal.vectors @ np.block([[none, pair], [-pair, none]]) @ normal.vectors.T - J
    mismatch = np.abs(inverse @ M @ normal.vectors - np.diag(np.exp(rates))).max() / np.abs(np.exp(rates)).max()
    linear = float(max(mismatch, np.abs(brackets).max()))  # large if unequal multipliers count as equal
    if not linear < _NEAR:
        raise SingularError(
            f"normal_form: the multipliers {np.linalg.eigvals(M).tolist()} are not separated (residual {linear:.1g}): some are "
            "near 1 and others near −1; change a parameter or the energy"
        )
    rows = [linear_form(row) for row in normal.vectors]
    inner = [f.substitute(rows, degree) for f in F]
    z = [variable(k, n) for k in range(n)]
    higher = [total([g.times(c) for c, g in zip(row, inner, strict=True)]) for row in inverse]
    f = [total([g - g.part(1), z[k].times(np.exp(rates[k]))]) for k, g in enumerate(higher)]
    original, K, generators = f, z[0].part(-1), list[Polynomial]()
    for d in range(3, order + 1):
        h = _exponent(f, K, rates, weights, d)
        shift = 1 - np.exp(-(h.exponents @ rates))
        resonant = np.abs(shift) <= max(detuning, _RESONANT)
        K, chi = K + h.where(resonant), h.where(~resonant).over(shift[~resonant])
        generators.append(chi)
        if len(chi.coefficients):
            f = _conjugate(f, chi, weights, degree)
    pairs = {tuple((units[j] + units[m + j]).tolist()): a for j, a in enumerate(angles)}
    series = polynomial(pairs, n) + K
    plain = tuple(complex(a) if abs(a.imag) > 0 else float(a.real) for a in angles)
    form = NormalForm(plain, series, weights, tuple(generators), normal.vectors, order, 0.0)
    return replace(form, error=max(linear, _error(original, form, rates, K)))


def _exponent(f: Sequence[Polynomial], K: Polynomial, rates: Coefficients, weights: Coefficients, d: int) -> Polynomial:
    """Return the terms h_d of degree d in f = Φ_{K + h_d + …} ∘ Λ.

    {x, h_d} is the residual of f ∘ Λ⁻¹ at degree d − 1, and Euler's rule for homogeneous functions gives h_d from it.
    """
    m = len(weights)
    summands = []
    for k in range(2 * m):
        homogeneous = f[k].part(d - 1)
        flow = lie_transform(variable(k, 2 * m), K, weights, d - 1).part(d - 1)
        remainder = homogeneous.times(np.exp(-(homogeneous.exponents @ rates))) - flow
        conjugate, sign = (k + m, 1) if k < m else (k - m, -1)
        summands.append(remainder.product(variable(conjugate, 2 * m), d).times(sign / weights[k % m] / d))
    return total(summands)


def _conjugate(f: Sequence[Polynomial], chi: Polynomial, weights: Coefficients, degree: int) -> list[Polynomial]:
    """Return the map Φ_χ⁻¹ ∘ f ∘ Φ_χ through a degree."""
    away = [lie_transform(variable(k, len(f)), chi.times(-1), weights, degree) for k in range(len(f))]
    return [lie_transform(g.substitute(f, degree), chi, weights, degree) for g in away]


def _error(f: Sequence[Polynomial], form: NormalForm, rates: Coefficients, K: Polynomial) -> float:
    """Return the largest relative difference between the map f and the one that its form gives, Φ_χ ∘ (Φ_K ∘ Λ) ∘ Φ_χ⁻¹."""
    n, degree = len(f), form.known_through - 1
    g = [lie_transform(variable(k, n), K, form.weights, degree) for k in range(n)]
    g = [component.times(np.exp(component.exponents @ rates)) for component in g]
    for chi in reversed(form.generators):
        g = _conjugate(g, chi.times(-1), form.weights, degree) if len(chi.coefficients) else g
    return largest_difference(f, g)


def largest_difference(f: Sequence[Polynomial], g: Sequence[Polynomial]) -> float:
    """Return the largest relative difference between the coefficients of two maps.

    In each degree it is relative to the largest coefficient of f in that degree, or in the lowest degree if that is larger.
    """
    sizes = dict[int, float]()
    for d, homogeneous in ((d, homogeneous) for whole in f for d, homogeneous in whole.parts.items()):
        sizes[d] = max(sizes.get(d, 0.0), float(np.abs(homogeneous.coefficients).max()))
    least = sizes[min(sizes)]
    apart = [(d, homogeneous) for a, b in zip(f, g, strict=True) for d, homogeneous in (a - b).parts.items()]
    return max((float(np.abs(h.coefficients).max()) / max(sizes.get(d, 0.0), least) for d, h in apart), default=0.0)


_LOCAL = (1e-11, 1e-13)  # errors of a step: of the map for comparison, and of the result
_EVALUATIONS = 200_000  # largest number for one integration
_RESCALINGS = 6  # largest number, to the units of the orbit
_NEWTON = 15  # largest number of steps to the orbit
_CLOSED = 1e-11  # of the orbit's size: the last Newton step
_OPEN = 1e-6  # of the orbit's momentum: a larger difference means an open orbit
_FAR = 0.5  # of the orbit's size or period, without a drive: a larger step leads to another orbit


class _Motion:
    """Hamilton's equations for jets of x, which are truncated power series in a displacement of the initial state.

    The scales `units`, shape (2n,), have the same product in each canonical pair.
    """

    def __init__(self, H: sp.Expr, x: Sequence[sp.Symbol], begin: float, units: Array) -> None:
        n = len(x) // 2
        scaled = H.xreplace({s: sp.Float(u, 17) * s for s, u in zip(x, units, strict=True)})
        H = scaled / sp.Float(units[0] * units[n], 17)
        rates = (*gradient(H, x[n:]), *-gradient(H, x[:n]))
        self._rates, self._H = (compile_program(Program((*x, t), (), e), "numpy") for e in (rates, (H,)))
        _, drives = clock_parts((), rates, {*x})
        self._drives = compile_program(Program((t,), (), tuple(drives)), "numpy") if drives else None
        self.begin = begin

    def windows(self, duration: float) -> tuple[Window, ...]:
        """Return the short intervals in which a drive acts, as fractions of a duration."""
        drives, begin = self._drives, self.begin
        if drives is None:
            return ()

        def along(shares: Array) -> Array:
            return np.vstack([np.broadcast_to(f, shares.shape) for f in drives(begin + shares * duration)])

        return brief_windows(along, 0.0, 1.0)

    def rate(self, X: list[TruncatedSeries], time: float) -> list[TruncatedSeries]:
        return [_jet(f, X[0].space) for f in self._rates(*X, time)]

    def is_periodic(self, path: Array, period: float) -> bool:
        """Return True if the rates on a path (m, 2n), and at random points near it, repeat after a period, to rounding."""
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
        """Integrate dx/dσ = duration f(x) for a duration that is a series, too; return x at the fractions σ in `shares`.

        The result has the shape (k, 2n, N), with the N coefficients of each component.
        """
        space = X[0].space

        def rate(s: float, state: Array) -> list[float]:
            at = [TruncatedSeries(row, space) for row in state.reshape(len(X), -1)]
            moving = self.rate(at, self.begin + s * duration.coefficients[0])
            return np.concatenate([(duration * f).coefficients for f in moving]).tolist()

        start = np.concatenate([f.coefficients for f in X])
        problem = Problem(rate, start, _EVALUATIONS, windows=self.windows(duration.coefficients[0]))
        return integrate(problem, shares, local).states.reshape(len(shares), len(X), -1)

    def advance(self, X: list[TruncatedSeries], duration: TruncatedSeries, local: float) -> list[TruncatedSeries]:
        return [TruncatedSeries(row, duration.space) for row in self.path(X, duration, local, np.ones(1))[0]]


@dataclass(frozen=True, eq=False)
class _Return:
    """The return map y → F(y) and the initial state x(y), both as jets in the orbit's units, and the period in s."""

    F: list[TruncatedSeries]
    start: list[TruncatedSeries]
    period: float
    apart: float = 0.0  # difference of p_1, since two values can have the same energy


def _jet(value: Any, space: JetSpace) -> TruncatedSeries:
    return value if isinstance(value, TruncatedSeries) else space.constant(float(value))


def _combined(columns: Array, jets: Sequence[TruncatedSeries]) -> list[TruncatedSeries]:
    """Return the product of the transpose of `columns` and a vector of jets."""
    rows = np.array([f.coefficients for f in jets])
    return [TruncatedSeries(row, jets[0].space) for row in columns.T @ rows]


def _along(rate: Array) -> Array:
    """Return an orthogonal and canonical matrix S, shape (2n, 2n), whose first column is parallel to a rate of shape (2n,).

    As a map of q + i p it is unitary.
    """
    n = len(rate) // 2
    Q, R = np.linalg.qr(np.column_stack([rate[:n] + 1j * rate[n:], np.eye(n)]))
    Q[:, 0] *= R[0, 0] / abs(R[0, 0])
    return np.block([[Q.real, -Q.imag], [Q.imag, Q.real]])


@dataclass(frozen=True, eq=False)
class _Orbit:
    """An orbit to be followed for one return, with the whole turns of its angles in that time, and its energy.

    Under a drive the energy is None.
    """

    motion: _Motion
    turns: Array
    energy: float | None

    def returned(self, x: Array, period: float, degree: int, local: float) -> _Return:
        n = len(x) // 2
        space = jet_space(2 * n - 2 * (self.energy is not None), degree)
        y = [space.variable(k) for k in range(space.exponents.shape[1])]
        if self.energy is None:
            start = [y[k] + x[k] for k in range(2 * n)]
            end = self._back(self.motion.advance(start, space.constant(period), local), x)
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
        X, ahead = self.motion.advance(start, space.constant(period), local), S[:, :1]
        for _ in range(degree.bit_length() + 2):
            late = _combined(ahead, self._back(X, x))[0]
            wait = -late / _combined(ahead, self.motion.rate(X, self.motion.begin))[0]
            if not abs(wait.coefficients[0]) < _FAR * period:
                raise InputError(
                    f"normal_form: no return near t = {period:.6g} s: give a start on the orbit and its period"
                )
            period += wait.coefficients[0]
            X = self.motion.advance(X, wait, local)
        landing = _combined(S, self._back(X, x))
        return _Return([*landing[1:n], *landing[n + 1 :]], start, period, abs(float((landing[n] - p).coefficients[0])))

    def _back(self, X: list[TruncatedSeries], x: Array) -> list[TruncatedSeries]:
        """Return X − x without the whole turns of the angles."""
        return [f - s for f, s in zip(X, x + self.turns, strict=True)]


def _numbers(x: Array) -> list[TruncatedSeries]:
    return [jet_space(1, 0).constant(value) for value in x]


def return_map_form(
    H: sp.Expr, x: Sequence[sp.Symbol], at: Mapping[Any, float], period: float, order: int, detuning: float
) -> ReturnMapForm:
    """Return the normal form of the return map of the periodic orbit near the initial state `at`.

    The orbit has the energy of that state, or under a drive its period. Raises InputError if no orbit is near or nothing
    moves, DomainError if H is not analytic, and SingularError for the multipliers that `map_normal_form` refuses.
    """
    n, begin, driven = len(x) // 2, float(at.get(t, 0.0)), H.has(t)
    if n == 1 and not driven:
        raise DomainError("normal_form: an orbit of one degree of freedom has no normal form: leave out the period")
    start, units = np.array([float(at[s]) for s in x]), np.ones(2 * n)
    values = {s: sp.Float(at[s]) for s in (*x, t)}
    mobility = [derivative(derivative(H, s), s).xreplace(values) for s in x[n:]]
    ratios = np.array([abs(float(e)) if e.is_finite else 1.0 for e in mobility]) * period / (2 * pi)
    try:
        for _ in range(_RESCALINGS):
            motion = _Motion(H, x, begin, units)
            duration = jet_space(1, 0).constant(period)
            path = motion.path(_numbers(start / units), duration, _LOCAL[1], np.linspace(0, 1, 65))[..., 0]
            wide = _units(path * units, ratios)
            if np.abs(np.log2(wide / units)).max() < 1:
                break
            units = wide
        if driven and not motion.is_periodic(path, period):
            raise InputError(f"normal_form: H has not the period {period:.9g} s: give the period of the drive")
        windings = np.round((path[-1] * units - start) / (2 * pi)) * (np.arange(2 * n) < n)
        same = {s: s + 2 * sp.pi * int(k) for s, k in zip(x, windings, strict=True) if k}
        turns = 2 * pi * windings * (decide_zero(H.xreplace(same) - H).answer == "zero") / units
        start = start / units
        orbit = _Orbit(motion, turns, None if driven else float(motion.energy(_numbers(start)).coefficients[0]))
        for _ in range(_NEWTON):
            linear = orbit.returned(start, period, 1, _LOCAL[1])
            c, M = np.array([f.coefficients[0] for f in linear.F]), np.array([f.coefficients[1:] for f in linear.F])
            step = np.linalg.lstsq(np.eye(len(c)) - M, c)[0]
            if not np.abs(step).max() < (np.inf if driven else _FAR):
                raise InputError(
                    f"normal_form: after {linear.period:.6g} s the motion is off its start by {np.abs(c).max():.2g} of its size, "
                    "and no periodic orbit is near: give a start on it and its period"
                )
            start = np.array([f.coefficients @ np.append(1.0, step) for f in linear.start])
            period = linear.period
            if np.abs(step).max() < _CLOSED:
                break
        else:
            raise InputError("normal_form: Newton's method did not converge to the orbit: give a start nearer to it")
        if linear.apart > _OPEN:
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
    maps = [[f.polynomial.where(f.polynomial.exponents.sum(1) > 0) for f in returned.F] for returned in returns]
    coarse, fine = (map_normal_form(F, order, detuning * period) for F in maps)
    error = max(
        fine.error, largest_difference(maps[1], maps[0]), largest_difference([fine.series], [coarse.series]),
        *(abs(float(f.coefficients[0])) for f in returns[1].F),
    )  # fmt: skip
    unit = units[0] * units[n]  # unit of the action

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
    """Return units of q and p, shape (2n,), in which the orbit is about 1 wide and which have one product in each pair.

    `ratios` are the ratios of the units of q to those of p, for pairs that do not move.
    """
    q, p = np.split(np.ptp(path, axis=0) / 2, 2)
    wide = (q > 1e-9 * q.max()) & (p > 1e-9 * p.max())
    if wide.any():
        ratios = np.where(wide, q / np.where(wide, p, 1.0), np.exp(np.log(q[wide] / p[wide]).mean()))
        action = (q * p).max()
    else:
        ratios = np.where((ratios > 0) & (ratios < np.inf), ratios, 1.0)
        action = 1 / ratios.max()
    return np.concatenate([np.sqrt(action * ratios), np.sqrt(action / ratios)])
