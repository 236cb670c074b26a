"""Weakly nonlinear motion: periodic orbits as series, their characteristic exponents, and the slow change of an amplitude.

Lindstedt–Poincaré: q = q₀ + Σ εⁿ xₙ(Φ), Φ' = ω₀ (1 + Σ wₙ εⁿ), of a motion that is the same backward. ε is a parameter of the
system, and the amplitude A then any, or, where the system has no such letter, ε is the amplitude itself.

Characteristic exponents: where a system at rest has two displacements that stay (p_0 and q_0, exponent zero), an orbit of
small amplitude eps lets them act on each other. A perturbation of the orbit is sought as

    xi p(Phi) + eta q(Phi),    d xi/d Phi = A eta,    d eta/d Phi = B xi,

with p and q periodic. Put into the equations of motion, linear in the perturbation, this fixes p, q, A and B order by
order in eps; no root is taken. The exponents per radian of phase are ± sqrt(A B).

Averaging: q = a cos νt + b sin νt, q' = ν (−a sin νt + b cos νt), and with F = q'' + ν² q = ε f₁ + ε² f₂ + …

    a' = −F sin νt / ν,        b' = F cos νt / ν.

With y = (a, b), y' = ε g₁(y, t) + ε² g₂(y, t) and u₁ the integral of g₁ − ⟨g₁⟩ without a mean, y = Y + ε u₁(Y, t) gives

    Y' = ε ⟨g₁⟩ + ε² ⟨g₂ + (∂g₁/∂y) u₁⟩ + O(ε³).

q is known to O(εⁿ) through times of 1/ε by the terms through εⁿ. Multiple scales to the same order have the same slow equations.

Nayfeh & Mook, Nonlinear Oscillations, 2.3, 5.3; Sanders, Verhulst & Murdock, Averaging Methods in Nonlinear Dynamical Systems,
chs. 2, 4.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from math import lcm
from operator import mul
from typing import Any

import sympy as sp
from sympy.polys.domains.domain import Domain
from sympy.polys.matrices import DomainMatrix

from lagrotor.algebra import decide_zero, truncated_series
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import by_symbol, expression, no_letter, shortest
from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Series, Waves, constant_series, forget
from lagrotor.mechanics.lagrangian import t

Residual = Callable[[Sequence[Series], Series], list[Series]]
Column = dict[tuple[int, int], Coefficient]  # (equation, harmonic): value
Solver = Callable[[Sequence[Waves], int, Coefficient], tuple[list[Coefficient], Coefficient]]
_ROUNDING = 1e-6  # of a floating-point order's largest coefficient: what need not vanish of what should


@dataclass(frozen=True)
class PeriodicSeries:
    """A periodic orbit: unknowns as Fourier series in (eps, Phi), and the frequency, sum_n omega_n eps^n, all known through
    eps^known_through."""

    unknowns: tuple[FourierSeries, ...]
    frequency: FourierSeries

    @property
    def known_through(self) -> int:
        """The order through which every term is known."""
        return min(series.order for series in (*self.unknowns, self.frequency))

    def at_rest(self, field: Domain) -> "PeriodicSeries":
        """Its terms of order 0, exact also where the series is one of floating-point numbers."""
        still = [
            FourierSeries({(0, h): field.convert(v) for h, v in series.harmonics(0).items()}, series.order)
            for series in (*self.unknowns, self.frequency)
        ]
        return PeriodicSeries(tuple(still[:-1]), still[-1])


def periodic_series(
    residual: Residual,
    rest: Sequence[Coefficient],
    mode: Sequence[Mapping[int, Coefficient]],
    order: int,
    field: Domain,
    numeric: Residual | None = None,
    begins_at: int = 1,
) -> PeriodicSeries:
    """The series of the periodic orbit that starts as rest + eps mode, with frequency 1 + omega_2 eps² + ….

    At order n the coefficients of eps^n enter linearly, harmonic by harmonic, by the operator of the linear mode; where
    that is singular (the mode's own harmonic) the frequency's correction omega_{n − begins_at} makes the system solvable.

    Parameters
    ----------
    residual : Residual
        (unknowns, frequency) → the equations of motion as Fourier series, zero on the orbit; derivatives by the
        phase, time derivatives carried by the frequency.
    rest : sequence
        Unknowns at equilibrium; the value of the first at Phi = 0, less rest, is eps.
    mode : Sequence[mapping
        {harmonic: coefficient} of each at first order (cos for h ≥ 0, sin for h < 0), which also fixes each unknown's
        parity by its sign; an unknown without a first-order part is a cosine series.
    order : int
        Through eps^order.
    field : Domain
        That of the coefficients.
    numeric : Residual or None, optional
        The same equations with floating-point coefficients; the series then has those, and is found ten times as fast.
    begins_at : int, default 1
        The power of eps of the mode; 0 where eps is another small quantity, at which the equations are linear, and the
        mode an amplitude.

    Raises
    ------
    SingularError
        When it is not: a resonance with another mode.
    """
    one = field.one
    sines = [bool(m) and min(m) < 0 for m in mode]
    begins = [
        constant_series(r, order) + FourierSeries({(begins_at, h): v for h, v in m.items()}, order)
        for r, m in zip(rest, mode, strict=True)
    ]
    value = field.convert if numeric is None else float
    *unknowns, frequency = (begin.convert(value) for begin in (*begins, constant_series(one, order)))
    equations = (numeric or residual)(unknowns, frequency)
    operators = _columns(residual, rest, sines, order, one)
    drift, solvers = _frequency_column(residual, begins, one, begins_at), dict[int, Solver]()
    for n in range(begins_at + 1, order + begins_at + 1):
        now, at_zero = [equation.at(n) for equation in equations], value(field.zero)
        # The mode's own harmonic last: it takes what the amplitude's definition leaves. It alone gives the last frequency.
        others = {abs(h) for waves in now for h in waves} - {1} if n <= order else set()
        for h in (*sorted(others, reverse=True), 1):
            if h not in operators:
                operators = _columns(residual, rest, sines, 2 * h, one)
            if h not in solvers:
                extra, fixed = (drift, 0) if h == 1 else (None, None)
                solvers[h] = harmonic_solver(operators[h], extra, fixed, field, value)
            values, shift = solvers[h](now, h, -at_zero)
            for j, coefficient in enumerate(values):
                unknowns[j].assign(n, -h if sines[j] else h, coefficient)
            at_zero += 0 if sines[0] else values[0]
            if shift:
                frequency.assign(n - begins_at, 0, shift)
                forget(equations, n - begins_at)
        forget(equations, n)
    return PeriodicSeries(tuple(u.through(order) for u in unknowns), frequency.through(order))


def _columns(
    residual: Residual, rest: Sequence[Coefficient], sines: Sequence[bool], order: int, one: Coefficient
) -> dict[int, list[Column]]:
    """Harmonic h → the linear operator there: for each unknown the equations' response to a unit of it.

    At rest no harmonic acts on another, so that all are put in together.
    """
    still, columns = [constant_series(r, 1) for r in rest], dict[int, list[Column]]()
    for j, sine in enumerate(sines):
        moved = list(still)
        moved[j] = moved[j] + waves(sine, order, 1, one)
        for h, column in by_harmonic(residual(moved, constant_series(one, 1)), order, 1).items():
            columns.setdefault(h, []).append(column)
    return columns


def waves(sine: bool, most: int, power: int, one: Coefficient) -> FourierSeries:
    """eps**power times the sum of the cosines, or the sines, of all harmonics up to `most`."""
    return FourierSeries({(power, -h if sine else h): one for h in range(int(sine), most + 1)}, power)


def by_harmonic(equations: Sequence[FourierSeries], most: int, power: int) -> dict[int, Column]:
    """Harmonic h up to `most` → the coefficients of eps**power there."""
    columns: dict[int, Column] = {h: {} for h in range(most + 1)}
    for i, equation in enumerate(equations):
        for key, v in equation.harmonics(power).items():
            columns[abs(key)][i, key] = v
    return columns


def _frequency_column(
    residual: Residual, unknowns: Sequence[FourierSeries], one: Coefficient, begins_at: int
) -> dict[tuple[int, int], Coefficient]:
    """The response of the mode to a unit change of frequency; exact, as the equations are quadratic in it."""
    first = [u.through(begins_at) for u in unknowns]
    up, down = (residual(first, constant_series(value, 1)) for value in (one + one, one - one))
    column = {}
    for i, (more, less) in enumerate(zip(up, down, strict=True)):
        for key, v in (more - less).harmonics(begins_at).items():
            column[i, key] = v / 2
    return column


def harmonic_solver(
    columns: list[Column],
    extra: Column | None,
    fixed: int | None,
    field: Domain,
    value: Callable[[Any], Coefficient],
) -> Solver:
    """What solves one harmonic of the equations for the unknowns, and for the shift of a frequency where `extra` is its column.

    Called with the coefficients of an order, the harmonic, and the value of unknown number `fixed`. The system is reduced
    exactly, once for all orders, and then `value`d; what nothing determines is zero. Raises SingularError where an order
    cannot be solved.
    """
    system = [*columns, *([extra] if extra is not None else [])]
    rows = sorted({key for column in system for key in column})
    table = [[column.get(row, field.zero) for column in system] for row in rows]
    if fixed is not None:
        table.append([field.one if j == fixed else field.zero for j in range(len(system))])
    pivots, turned = _eliminate(table, field, value)

    def solve(now: Sequence[Waves], h: int, at: Coefficient) -> tuple[list[Coefficient], Coefficient]:
        left = {(i, key): -v for i, waves in enumerate(now) for key, v in waves.items() if abs(key) == h}
        right = [left.pop(row, 0) for row in rows] + ([] if fixed is None else [at])
        solved = [sum((e * r for e, r in zip(row, right, strict=True) if e and r), value(field.zero)) for row in turned]
        largest = max((abs(v) for waves in now for v in waves.values()), default=0) if value is float else 0
        if any(
            abs(v) > _ROUNDING * (1 + largest) if value is float else v
            for v in (*solved[len(pivots) :], *left.values())
        ):
            raise SingularError("periodic_series: an order cannot be solved: the mode is in resonance with another")
        values = [value(field.zero)] * len(system)
        for j, solution in zip(pivots, solved, strict=False):
            values[j] = solution
        return values[: len(columns)], values[-1] if extra is not None else value(field.zero)

    return solve


def _eliminate(
    table: list[list[Coefficient]], field: Domain, value: Callable[[Any], Coefficient]
) -> tuple[list[int], list[list[Coefficient]]]:
    """The unknowns that a system determines, and the matrix that takes its right side to them, then to what must vanish."""
    n, m = len(table), len(table[0]) if table else 0
    wide = [row + [field.one if i == j else field.zero for j in range(n)] for i, row in enumerate(table)]
    if not wide:
        return [], []
    reduced, pivots = DomainMatrix(wide, (n, m + n), field).rref()
    return [j for j in pivots if j < m], [list(map(value, row[m:])) for row in reduced.to_list()]


@dataclass(frozen=True)
class Perturbed:
    """orbit + xi p + eta q to first order in xi and eta, with xi' = A eta, eta' = B xi.

    It is added, multiplied and differentiated like the series of its parts, so that equations written for an orbit give, put to
    it, the variational equations too. exchange: the sign that p and q take where the equations use half a period later.
    """

    orbit: Series
    p: Series
    q: Series
    A: Series
    B: Series
    exchange: int

    def _with(self, orbit: Series, p: Series, q: Series) -> "Perturbed":
        return Perturbed(orbit, p, q, self.A, self.B, self.exchange)

    def __add__(self, other: "Perturbed") -> "Perturbed":
        return self._with(self.orbit + other.orbit, self.p + other.p, self.q + other.q)

    def __neg__(self) -> "Perturbed":
        return self.times(-1)

    def __sub__(self, other: "Perturbed") -> "Perturbed":
        return self + (-other)

    def __mul__(self, other: "Perturbed") -> "Perturbed":
        first, second = self.orbit, other.orbit
        return self._with(first * second, first * other.p + self.p * second, first * other.q + self.q * second)

    def times(self, factor: Coefficient) -> "Perturbed":
        """factor × f."""
        return self._with(self.orbit.times(factor), self.p.times(factor), self.q.times(factor))

    def derivative(self) -> "Perturbed":
        """df/dPhi: (p' + B q) xi + (q' + A p) eta."""
        p, q = self.p.derivative() + self.B * self.q, self.q.derivative() + self.A * self.p
        return self._with(self.orbit.derivative(), p, q)

    def half_period_later(self) -> "Perturbed":
        """f(Phi + pi), the perturbation with the sign `exchange`."""
        p, q = (part.half_period_later().times(self.exchange) for part in (self.p, self.q))
        return self._with(self.orbit.half_period_later(), p, q)

    def constant(self, value: Coefficient) -> "Perturbed":
        """The constant `value`."""
        return self._with(self.orbit.constant(value), self.p.constant(0), self.q.constant(0))


@dataclass(frozen=True)
class ExponentSeries:
    """A and B as series in the amplitude, and the periodic parts p and q of the perturbations, one for each unknown."""

    A: FourierSeries
    B: FourierSeries
    p: tuple[FourierSeries, ...]
    q: tuple[FourierSeries, ...]

    @property
    def square(self) -> FourierSeries:
        """lambda² = A B, per radian of phase: positive for growth, negative for turning."""
        return self.A * self.B


def characteristic_exponents(
    residual: Residual,
    orbit: PeriodicSeries,
    sines: Sequence[bool],
    neutral: tuple[int, int],
    order: int,
    field: Domain,
    exchange: int = 1,
    numeric: Residual | None = None,
) -> ExponentSeries:
    """A and B through eps**order, for an orbit through at least that order.

    Parameters
    ----------
    residual : Residual
        The equations, over `field`, as `periodic_series` takes them.
    exchange : int, default 1
        The sign that p and q take where the equations use half a period later.
    sines : sequence
        Which unknowns of the orbit are sine series; p has the same parities, q the opposite ones.
    neutral : tuple[int, int]
        The numbers of the unknowns whose unit displacements are p_0 and q_0; later orders leave their means unchanged.
    numeric : Residual or None, optional
        The same equations with floating-point coefficients, for an orbit that has those.

    Raises
    ------
    SingularError
        Where an order cannot be solved: another exponent comes close to zero.
    """
    parity = {"p": list(sines), "q": [not sine for sine in sines]}
    fixed, nothing, one = (
        dict(zip("pq", neutral, strict=True)),
        FourierSeries({}, order),
        constant_series(field.one, order),
    )
    parts = {part: [one if i == fixed[part] else nothing for i in range(len(sines))] for part in "pq"}
    operators, drift = _responses(residual, orbit.at_rest(field), parity, parts, order, field.one, exchange)
    value = field.convert if numeric is None else float
    unknowns = {part: [series.convert(value) for series in parts[part]] for part in "pq"}
    slow = {part: FourierSeries({}, order) for part in "pq"}  # B from the equations' p part, A from their q part
    equations = _varied(numeric or residual, orbit, unknowns, slow, exchange)
    solvers: dict[tuple[str, int], Solver] = {}
    for n in range(1, order + 1):
        now = {part: [getattr(equation, part).at(n) for equation in equations] for part in "pq"}
        for part in "pq":
            for h in range(n, -1, -2):
                if (part, h) not in solvers:
                    extra, mean = (drift[part], fixed[part]) if h == 0 else (None, None)
                    solvers[part, h] = harmonic_solver(operators[part, h], extra, mean, field, value)
                values, shift = solvers[part, h](now[part], h, value(field.zero))
                for j, coefficient in enumerate(values):
                    unknowns[part][j].assign(n, -h if parity[part][j] else h, coefficient)
                slow[part].assign(n, 0, shift)
        forget([part for equation in equations for part in (equation.p, equation.q)], n)
    return ExponentSeries(slow["q"], slow["p"], tuple(unknowns["p"]), tuple(unknowns["q"]))


def _varied(
    residual: Residual,
    orbit: PeriodicSeries,
    parts: Mapping[str, Sequence[Series]],
    slow: Mapping[str, Series],
    exchange: int,
) -> list[Perturbed]:
    """The equations of an orbit with a perturbation of these parts, and of the rates A = slow["q"] and B = slow["p"]."""

    def at(f: FourierSeries, p: Series, q: Series) -> Perturbed:
        return Perturbed(f, p, q, slow["q"], slow["p"], exchange)

    unknowns = [at(*each) for each in zip(orbit.unknowns, parts["p"], parts["q"], strict=True)]
    nothing = FourierSeries({}, orbit.frequency.order)
    return residual(unknowns, at(orbit.frequency, nothing, nothing))


def _responses(
    residual: Residual,
    rest: PeriodicSeries,
    parity: Mapping[str, Sequence[bool]],
    parts: Mapping[str, Sequence[FourierSeries]],
    order: int,
    one: Coefficient,
    exchange: int,
) -> tuple[dict[tuple[str, int], list[Column]], dict[str, Column]]:
    """The linear equations at rest: (part, harmonic) → for each unknown the response of the part to a unit of its harmonic;
    and part → its response to a unit of the slow rate by which the other part drives it.

    At rest no harmonic acts on another, so that all are put in together.
    """
    nothing, operators, drift = FourierSeries({}, order), dict[tuple[str, int], list[Column]](), dict[str, Column]()
    for j in range(len(rest.unknowns)):
        units = {part: [nothing] * len(rest.unknowns) for part in "pq"}
        for part in "pq":
            units[part][j] = waves(parity[part][j], order, 0, one)
        answer = _varied(residual, rest, units, dict.fromkeys("pq", nothing), exchange)
        for part in "pq":
            for h, column in by_harmonic([getattr(r, part) for r in answer], order, 0).items():
                operators.setdefault((part, h), []).append(column)
    for part, other in ("pq", "qp"):
        still, slow = {part: [nothing] * len(rest.unknowns), other: parts[other]}, {other: nothing}
        answer = _varied(residual, rest, still, slow | {part: constant_series(one, order)}, exchange)
        drift[part] = by_harmonic([getattr(r, part) for r in answer], 0, 0)[0]
    return operators, drift


_MOST_ORDER = 2  # of averaging
_MET = 1e-9  # relative: a start that the amplitudes give
_PHASE = sp.Symbol("Phi", real=True)  # of a periodic motion, Φ = ω t


@dataclass(frozen=True, eq=False)
class Oscillation:
    """A family of periodic motions: its frequency, and q over the phase Φ = ω t (Symbol("Phi", real=True)), with q' = 0 at Φ = 0,
    in powers of the small quantity and, where that is a parameter, of the `amplitude`, the value of q at Φ = 0 less its rest.

    Both are known through small**known_through and carry their O().
    """

    frequency: sp.Expr
    motion: sp.Expr
    known_through: int
    small: sp.Symbol
    amplitude: sp.Symbol
    system: Equations

    def error(self, values: Mapping[Any, Any]) -> float:
        """The relative error of the frequency for values of all letters, small and amplitude among them, measured against the
        period of a run from the start that the series gives, which is known to some 10⁻¹¹.

        Raises
        ------
        InputError
            For a letter without a value.
        SingularError
            Where the run does not come back.
        """
        import numpy as np

        from lagrotor.mechanics.running import simulation

        letters = self.frequency.free_symbols | self.motion.free_symbols | self.system.motion.free_symbols
        known = {s: sp.sympify(x, strict=True) for s, x in by_symbol("error: values", values, letters).items()}
        omega = self.frequency.removeO().subs(known)
        start = self.motion.removeO().subs(_PHASE, 0).subs(known)
        no_letter("error", omega.free_symbols | start.free_symbols)
        own = self.system.L.free_symbols | self.system.generalised_forces.free_symbols
        numbers = {str(s): float(x) for s, x in known.items() if s in own}
        (q,), (v,) = self.system.c.q, self.system.c.v
        period = 2 * float(sp.pi) / float(omega)
        times = np.linspace(0, 1.6 * period, 33)
        run = simulation.simulate_system(self.system, numbers, (float(start),), (0.0,), times, 1e-11)
        back = run.crossings(v, direction=1 if run.v[1, 0] > 0 else -1)
        turns = back.t[back.t > 0.4 * period]
        if not len(turns):
            raise SingularError(
                f"error: the motion from {q} = {float(start):.6g} does not come back within 1.6 periods of the series"
            )
        return float(abs(omega / (2 * sp.pi / turns[0]) - 1))


def oscillation(
    system: Equations,
    order: int,
    small: sp.Symbol,
    at: Any = 0,
    amplitude: sp.Symbol | None = None,
) -> Oscillation:
    """Return the series of the periodic motions about q = at: `System.lindstedt_poincare`."""
    _check_one("lindstedt_poincare", system, order, small)
    if not isinstance(amplitude, sp.Symbol | None):
        raise InputError(f"lindstedt_poincare: amplitude = {amplitude!r} must be a symbol")
    A = amplitude or sp.Symbol("A", positive=True)
    rest = expression("lindstedt_poincare: at", at)
    inside = small in system.motion.free_symbols
    terms = _terms_about(rest, system, order, small, A if inside else None)
    K, M = _stiffness_and_mass(terms, f"{system.c.q[0]} = {rest}")
    if inside and any(sum(powers) > 1 and n == 0 for n, *powers in terms):
        raise InputError(
            f"lindstedt_poincare: the equation is not linear where {small} = 0: take the amplitude for the small quantity, "
            "with a letter that the system does not have"
        )
    field, own = _field([*terms.values(), *([A] if inside else [])])
    coefficients = [((n, i, j // 2, k), own(e / K)) for (n, i, j, k), e in terms.items()]

    def residual(unknowns: Sequence[Series], frequency: Series) -> list[Series]:
        (x,) = unknowns
        turn = (frequency * frequency).times(own(K / M))
        first = x.derivative()
        return [_sum_of_products(coefficients, (x, turn * first * first, turn * first.derivative()))]  # of q, v² and a

    mode = {1: own(A) if inside else field.one}
    solved = periodic_series(residual, [field.zero], [mode], order, field, begins_at=0 if inside else 1)
    bound = sp.O(small ** (order + 1))
    factor, moved = (_written(s, field, _PHASE, small) for s in (solved.frequency, solved.unknowns[0]))
    powers = sp.Poly(factor, small).terms()
    frequency = sp.Add(*(sp.sqrt(sp.cancel(K / M)) * sp.factor(c) * small**n for (n,), c in powers)) + bound
    return Oscillation(frequency, rest + moved + bound, solved.known_through, small, A, system)


def _terms_about(
    rest: sp.Expr,
    system: Equations,
    order: int,
    small: sp.Symbol,
    amplitude: sp.Symbol | None,
) -> dict[tuple[int, ...], sp.Expr]:
    """The coefficients of the equation of q − rest by the powers of small, q, v and a. Without an `amplitude` small is
    no letter of the system, but the size of the motion."""
    (q,), (v,), (a,) = system.c.q, system.c.v, system.c.a
    equation = system.motion[0]
    if amplitude is not None and str(amplitude) in map(str, equation.free_symbols):
        raise InputError(f"lindstedt_poincare: amplitude = {amplitude} is a letter of the system: give it another name")
    if t in equation.free_symbols:
        raise InputError("lindstedt_poincare: the system depends on time: use averaged")
    equation = equation.subs(q, rest + q) if rest != 0 else equation
    if amplitude is None:
        e = sp.Dummy("epsilon", positive=True)
        scaled = equation.subs({q: e * q, v: e * v, a: e * a}, simultaneous=True)
        polynomial = _series(scaled, e, order + 1).subs(e, 1)
    else:
        polynomial = _series(equation, small, order)
    poly = _polynomial("lindstedt_poincare", polynomial, (small, q, v, a))
    return {powers: coefficient for powers, coefficient in poly.terms() if decide_zero(coefficient).answer != "zero"}


def _stiffness_and_mass(terms: Mapping[tuple[int, ...], sp.Expr], place: str) -> tuple[sp.Expr, sp.Expr]:
    """The coefficients of q and a where small = 0, of an equation whose small motions are periodic."""
    if any(not any(powers) for _, *powers in terms):
        raise InputError(f"lindstedt_poincare: {place} is no equilibrium: a force is left: give at=")
    if any(j % 2 for _, _, j, _ in terms):
        raise InputError(
            "lindstedt_poincare: the equation has odd powers of the velocity, and is not the same backward: friction makes an "
            "amplitude change, which averaged gives"
        )
    K, M = terms.get((0, 1, 0, 0), sp.S.Zero), terms.get((0, 0, 0, 1), sp.S.Zero)
    if K == 0 or M == 0 or (K / M).is_nonpositive:
        raise InputError(f"lindstedt_poincare: {place} has no frequency of small motion, ω² = {K / M if M else 'K/0'}")
    return K, M


@dataclass(frozen=True, eq=False)
class AveragedMotion:
    """Y' = `rates` for Y = (a, b), through small**order, and q and q' at a time t by a, b and t: with u₁ for the second order.

    Attributes
    ----------
    letters : tuple[Symbol, Symbol]
        A and b.
    frequency : Expr
        Ν.
    """

    letters: tuple[sp.Symbol, sp.Symbol]
    rates: tuple[sp.Expr, sp.Expr]
    state: tuple[sp.Expr, sp.Expr]
    frequency: sp.Expr
    small: sp.Symbol
    order: int

    @property
    def polar(self) -> tuple[sp.Expr, sp.Expr]:
        """(r', β') of q = r cos(νt + β) in the letters r and beta, r_0 and beta_0 where the system has those: a = r cos β,
        b = −r sin β."""
        taken = {str(s) for e in self.rates for s in e.free_symbols}
        names = ["r_0", "beta_0"] if taken & {"r", "beta"} else ["r", "beta"]
        r, beta = sp.Symbol(names[0], positive=True), sp.Symbol(names[1], real=True)
        put = dict(zip(self.letters, (r * sp.cos(beta), -r * sp.sin(beta)), strict=True))
        a_rate, b_rate = (e.xreplace(put) for e in self.rates)
        grown = a_rate * sp.cos(beta) - b_rate * sp.sin(beta)
        turned = -(a_rate * sp.sin(beta) + b_rate * sp.cos(beta)) / r
        return shortest(sp.expand(grown)), shortest(sp.expand(turned))

    def run(self, values: Mapping[Any, Any], q0: float, v0: float, times: Any) -> Any:
        """(q, q') at the times, (2, n), in numbers.

        Parameters
        ----------
        values : mapping
            Of all letters.
        q0 : float
            At times[0].
        v0 : float
            Q' there.
        times
            (n,).

        Raises
        ------
        InputError
            For a letter without a value.
        SingularError
            Where no amplitudes give the start.
        """
        import numpy as np
        from scipy.optimize import root

        from lagrotor.numerics.arrays import check_times, real_array
        from lagrotor.numerics.integrate import Problem, integrate

        grid = check_times("averaged", times)
        given = real_array((q0, v0))
        if given is None or given.shape != (2,) or not np.isfinite(given).all():
            raise InputError(f"averaged: q0 = {q0!r} and v0 = {v0!r} must be finite numbers")
        own = set().union(*(e.free_symbols for e in (*self.rates, *self.state))) - {*self.letters, t}
        known = {s: float(x) for s, x in by_symbol("averaged: values", values, own).items() if s in own}
        no_letter("averaged", own - known.keys())
        slow = sp.lambdify(self.letters, [e.subs(known) for e in self.rates], "numpy")
        there = sp.lambdify((*self.letters, t), [e.subs(known) for e in self.state], "numpy")
        start = root(lambda Y: np.array(there(*Y, grid[0])) - given, [q0, 0.0], tol=1e-13).x
        if not np.abs(np.array(there(*start, grid[0])) - given).max() <= _MET * max(1.0, abs(q0), abs(v0)):
            raise SingularError(
                f"averaged: no amplitudes are found that begin at q = {q0:g}, q' = {v0:g}: {self.small} is too large there "
                "for its second order; take a smaller one, or simulate"
            )
        problem = Problem(lambda s, Y: [float(x) for x in slow(*Y)], start, np.inf)
        Y = np.vstack([start, integrate(problem, grid[1:] - grid[0], 1e-11).states])
        return np.array([np.broadcast_to(e, grid.shape) for e in there(*Y.T, grid)])


def averaged(system: Equations, order: int, small: sp.Symbol, frequency: Any = None) -> AveragedMotion:
    """Return the slow motion of the amplitudes through small**order: `System.averaged`."""
    _check_one("averaged", system, order, small)
    if order > _MOST_ORDER:
        raise InputError(f"averaged: order = {order}: 1 or 2 are known")
    (q,), (v,), (a,) = system.c.q, system.c.v, system.c.a
    equation = system.motion[0]
    slope = sp.diff(equation, a)
    if small not in equation.free_symbols or a in slope.free_symbols:
        raise InputError(f"averaged: small = {small} must be a letter of the system, at which it is linear when zero")
    acceleration = -equation.subs(a, 0) / slope
    still = sp.expand(acceleration.subs(small, 0))
    square = -sp.diff(still, q)
    nu = sp.sqrt(square) if frequency is None else expression("averaged: frequency", frequency)
    if decide_zero(still + nu**2 * q).answer != "zero" or nu.is_nonpositive or nu.has(sp.I):
        raise InputError(
            f"averaged: for {small} = 0 it is {a} = {still}, not −ν² {q} with ν = {nu}: give frequency, or another small"
        )
    F = _series(acceleration + nu**2 * q, small, order)
    base, waves = _trigonometric(F, nu)
    poly = _polynomial("averaged", F.xreplace(waves.put), (small, q, v, *waves.letters))
    A, B, rate = sp.Symbol("a", real=True), sp.Symbol("b", real=True), sp.Dummy("nu", positive=True)
    if {A, B} & system.motion.free_symbols:
        A, B = sp.Symbol("a_c", real=True), sp.Symbol("a_s", real=True)
    field, own = _field([*(c.subs(nu, rate) if nu.is_Symbol else c for _, c in poly.terms()), A, B, rate])
    one, h = field.one, base
    letters = (
        FourierSeries({(0, h): own(A), (0, -h): own(B)}, order),
        FourierSeries({(0, h): own(rate) * own(B), (0, -h): -own(rate) * own(A)}, order),
        *(FourierSeries({(0, k): one}, order) for k in waves.numbers),
    )
    forced = _sum_of_products([(powers, own(e)) for powers, e in poly.terms()], letters)
    sine, cosine = FourierSeries({(0, -h): one}, order), FourierSeries({(0, h): one}, order)
    pushes = [(forced * sine).times(-one / own(rate)), (forced * cosine).times(one / own(rate))]
    means = [[g.harmonics(n).get(0, field.zero) for n in range(1, order + 1)] for g in pushes]
    moved = [A, B]
    if order == 2:
        shift = [_integral(g, 1, own(rate) / h) for g in pushes]
        moved = [s + _written(u, field, nu * t / h, small) for s, u in zip(moved, shift, strict=True)]
        generators = [field.from_sympy(A), field.from_sympy(B)]
        for i, g in enumerate(pushes):
            for place, u in zip(generators, shift, strict=True):
                slope_of_g = FourierSeries({k: c.diff(place) for k, c in g.terms.items() if k[0] == 1}, 2)
                means[i][1] += (slope_of_g * u).harmonics(2).get(0, field.zero)

    def plain(e: sp.Expr) -> sp.Expr:
        return e.subs(rate, nu)

    rates = tuple(plain(sp.Add(*(field.to_sympy(c) * small ** (n + 1) for n, c in enumerate(mean)))) for mean in means)
    c, s = sp.cos(nu * t), sp.sin(nu * t)
    state = (moved[0] * c + moved[1] * s, nu * (moved[1] * c - moved[0] * s))
    return AveragedMotion((A, B), (rates[0], rates[1]), (plain(state[0]), plain(state[1])), nu, small, order)


@dataclass(frozen=True)
class _Waves:
    """Sines and cosines of time as letters, and each one's harmonic of the base frequency, negative for a sine."""

    put: Mapping[sp.Expr, sp.Symbol]
    numbers: tuple[int, ...]

    @property
    def letters(self) -> tuple[sp.Symbol, ...]:
        return tuple(self.put.values())


def _trigonometric(F: sp.Expr, nu: sp.Expr) -> tuple[int, _Waves]:
    """The harmonic that ν is of the greatest frequency of which all are harmonics, and the functions of time in F."""
    nodes = sorted((e for e in F.atoms(sp.sin, sp.cos) if t in e.free_symbols), key=sp.default_sort_key)
    ratios = []
    for e in nodes:
        ratio = sp.cancel(e.args[0] / (nu * t))
        ratio = sp.Rational(str(ratio)) if ratio.is_Float else ratio
        if not ratio.is_Rational or ratio <= 0:
            raise DomainError(
                f"averaged: {e} has no rate that is a rational part of ν = {nu}, or has a phase: write rates like 2 ν, and a "
                "phase by letters for its cosine and sine"
            )
        ratios.append(ratio)
    base = lcm(*(int(ratio.q) for ratio in ratios)) if ratios else 1
    numbers = tuple(
        int(ratio * base) * (-1 if isinstance(e, sp.sin) else 1) for e, ratio in zip(nodes, ratios, strict=True)
    )
    return base, _Waves({e: sp.Dummy(f"w{i}", real=True) for i, e in enumerate(nodes)}, numbers)


def _sum_of_products(coefficients: Sequence[tuple[tuple[int, ...], Coefficient]], letters: Sequence[Series]) -> Series:
    """Σ c smallⁿ Π letterᵢ^kᵢ over ((n, k₁, …), c)."""
    total = letters[0].constant(0)
    for (n, *powers), c in coefficients:
        factors = (letter for letter, k in zip(letters, powers, strict=True) for _ in range(k))
        total = total + reduce(mul, factors, letters[0].constant(c)).raised(n)
    return total


def _integral(g: FourierSeries, n: int, rate: Any) -> FourierSeries:
    """The integral over time, without a mean, of the terms of small**n, of phase' = rate."""
    terms = {}
    for k, c in g.harmonics(n).items():
        if k:
            terms[n, -k] = (c if k > 0 else -c) / (rate * abs(k))
    return FourierSeries(terms, g.order)


def _written(u: FourierSeries, field: Domain, phase: sp.Expr, small: sp.Symbol) -> sp.Expr:
    """A series as an expression of its phase."""
    waves = ((n, k, field.to_sympy(c)) for (n, k), c in u.terms.items())
    return sp.Add(*(c * small**n * (sp.cos(k * phase) if k >= 0 else sp.sin(-k * phase)) for n, k, c in waves))


def _check_one(where: str, system: Equations, order: int, small: sp.Symbol) -> None:
    if len(system.c.q) != 1 or system.multipliers:
        raise InputError(
            f"{where}: one coordinate without constraints is taken: leave out cyclic ones by routh, solve constraints by "
            "in_coordinates; of several modes normal_form gives the frequencies"
        )
    if not isinstance(order, int) or isinstance(order, bool) or order < 1:
        raise InputError(f"{where}: order = {order!r} must be a whole number, at least 1")
    if not isinstance(small, sp.Symbol) or small in (*system.c.q, *system.c.v, *system.c.a, t):
        raise InputError(f"{where}: small = {small!r} must be a symbol, a parameter or the amplitude")


def _series(e: sp.Expr, small: sp.Symbol, order: int) -> sp.Expr:
    return sp.expand(truncated_series(e, small, order))


def _polynomial(where: str, e: sp.Expr, letters: Sequence[sp.Symbol]) -> sp.Poly:
    try:
        poly = sp.Poly(e, *letters)
    except sp.PolynomialError:
        poly = None
    if poly is None or any({*letters, t} & c.free_symbols for c in poly.coeffs()):
        raise DomainError(f"{where}: {e} is no polynomial in {', '.join(map(str, letters))}: expand it first")
    return poly


def _field(coefficients: Sequence[sp.Expr]) -> tuple[Domain, Any]:
    """The field of some expressions, and what takes one into it."""
    field, _ = sp.construct_domain([*coefficients, sp.S.Half], field=True)
    if field.is_EX:
        field, _ = sp.construct_domain([*coefficients, sp.S.Half], field=True, extension=True)
    if field.is_EX or not field.is_Exact:
        raise DomainError(
            f"the coefficients {coefficients} are in no field that is decided: write decimals as fractions"
        )
    return field, lambda e: field.from_sympy(sp.sympify(e, strict=True))
