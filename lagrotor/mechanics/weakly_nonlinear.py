"""Weakly nonlinear motion: series of periodic orbits, their characteristic exponents, and averaging.

Lindstedt–Poincaré: q = q₀ + Σ εⁿ xₙ(Φ), Φ' = ω₀ (1 + Σ wₙ εⁿ), for a motion symmetric under time reversal. ε is a parameter of
the system, with an arbitrary amplitude A, or ε is the amplitude itself.

Characteristic exponents: a system at rest has two constant displacements, p_0 and q_0, with exponent zero. An orbit of small
amplitude eps couples them. A perturbation of the orbit has the form

    xi p(Phi) + eta q(Phi),    d xi/d Phi = A eta,    d eta/d Phi = B xi,

with p and q periodic. The linearised equations of motion fix p, q, A and B order by order in eps; no root is taken. The
exponents per radian of phase are ± sqrt(A B).

Averaging: q = a cos νt + b sin νt, q' = ν (−a sin νt + b cos νt), and with F = q'' + ν² q = ε f₁ + ε² f₂ + …

    a' = −F sin νt / ν,        b' = F cos νt / ν.

With y = (a, b), y' = ε g₁(y, t) + ε² g₂(y, t) and u₁ the integral of g₁ − ⟨g₁⟩ of zero mean, y = Y + ε u₁(Y, t) gives

    Y' = ε ⟨g₁⟩ + ε² ⟨g₂ + (∂g₁/∂y) u₁⟩ + O(ε³).

The terms through εⁿ give q to O(εⁿ) for times of order 1/ε. Multiple scales give the same slow equations.

Nayfeh & Mook, Nonlinear Oscillations, 2.3, 5.3; Sanders, Verhulst & Murdock, Averaging Methods, chs. 2, 4.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from math import lcm
from operator import mul
from typing import TYPE_CHECKING, Any

import sympy as sp
from sympy.polys.domains.domain import Domain
from sympy.polys.matrices import DomainMatrix

from lagrotor.algebra import decide_zero, truncated_series
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.mechanics.equations import Equations, no_states
from lagrotor.mechanics.expressions import by_symbol, expression, no_letter, shortest
from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Series, Waves, constant_series, forget
from lagrotor.mechanics.lagrangian import t
from lagrotor.renamed import accept_old_keywords, old_attribute
from lagrotor.result_display import Shown, text_of

Residual = Callable[[Sequence[Series], Series], list[Series]]
Column = dict[tuple[int, int], Coefficient]  # (equation, harmonic): value
Solver = Callable[[Sequence[Waves], int, Coefficient], tuple[list[Coefficient], Coefficient]]
_ROUNDING = 1e-6  # largest residual of a solvable order in floating point, over its largest coefficient


@dataclass(frozen=True)
class PeriodicSeries:
    """A periodic orbit: unknowns as Fourier series in (eps, Phi), and the frequency sum_n omega_n eps^n."""

    unknowns: tuple[FourierSeries, ...]
    frequency: FourierSeries

    @property
    def known_through(self) -> int:
        """The order through which every term is known."""
        return min(series.order for series in (*self.unknowns, self.frequency))

    def at_rest(self, field: Domain) -> "PeriodicSeries":
        """Return the terms of order 0 alone. Their coefficients, exact or in floating point, are converted into `field`."""
        still = [
            FourierSeries({(0, h): field.convert(v) for h, v in series.harmonics(0).items()}, series.order)
            for series in (*self.unknowns, self.frequency)
        ]
        return PeriodicSeries(tuple(still[:-1]), still[-1])


@accept_old_keywords
def periodic_series(
    residual: Residual,
    equilibrium: Sequence[Coefficient],
    mode: Sequence[Mapping[int, Coefficient]],
    order: int,
    field: Domain,
    numeric: Residual | None = None,
    mode_power: int = 1,
) -> PeriodicSeries:
    """Return the series of the periodic orbit equilibrium + eps mode + …, with frequency 1 + omega_2 eps² + ….

    `residual`(unknowns, frequency) returns the equations of motion as Fourier series; a time derivative in them is frequency
    × d/dPhi. `mode` has for each unknown {harmonic: coefficient} (cos for h ≥ 0, sin for h < 0), which fixes the parity of
    the unknown. `field` is the field of the coefficients. `numeric` returns the same equations in floating point, ten times
    as fast. `mode_power` is the power of eps of the mode; it is 0 if eps multiplies the nonlinearity and the amplitude of the
    mode is arbitrary.

    Order n is linear in the coefficients of eps^n; at the mode's own harmonic the correction omega_{n − mode_power} makes the
    system solvable. Raises SingularError at a resonance with another mode.
    """
    unit = field.one
    sines = [bool(m) and min(m) < 0 for m in mode]
    begins = [
        constant_series(r, order) + FourierSeries({(mode_power, h): v for h, v in m.items()}, order)
        for r, m in zip(equilibrium, mode, strict=True)
    ]
    value = field.convert if numeric is None else float
    *unknowns, frequency = (begin.convert(value) for begin in (*begins, constant_series(unit, order)))
    equations = (numeric or residual)(unknowns, frequency)
    operators = _columns(residual, equilibrium, sines, order, unit)
    drift, solvers = _frequency_column(residual, begins, unit, mode_power), dict[int, Solver]()
    for n in range(mode_power + 1, order + mode_power + 1):
        now, at_zero = [equation.at(n) for equation in equations], value(field.zero)
        # The mode's own harmonic comes last: its coefficient keeps the amplitude at Phi = 0. It alone gives the last frequency.
        others = {abs(h) for waves in now for h in waves} - {1} if n <= order else set()
        for h in (*sorted(others, reverse=True), 1):
            if h not in operators:
                operators = _columns(residual, equilibrium, sines, 2 * h, unit)
            if h not in solvers:
                extra, fixed = (drift, 0) if h == 1 else (None, None)
                solvers[h] = harmonic_solver(operators[h], extra, fixed, field, value)
            values, shift = solvers[h](now, h, -at_zero)
            for j, coefficient in enumerate(values):
                unknowns[j].assign(n, -h if sines[j] else h, coefficient)
            at_zero += 0 if sines[0] else values[0]
            if shift:
                frequency.assign(n - mode_power, 0, shift)
                forget(equations, n - mode_power)
        forget(equations, n)
    return PeriodicSeries(tuple(u.through(order) for u in unknowns), frequency.through(order))


def _columns(
    residual: Residual, equilibrium: Sequence[Coefficient], sines: Sequence[bool], order: int, unit: Coefficient
) -> dict[int, list[Column]]:
    """Return the equations linearised at the equilibrium: {harmonic: one column for each unknown}.

    A column has the coefficients of the equations for a unit of that harmonic in the unknown. At equilibrium harmonics do not
    couple, so that one evaluation serves all.
    """
    still, columns = [constant_series(r, 1) for r in equilibrium], dict[int, list[Column]]()
    for j, sine in enumerate(sines):
        displaced = list(still)
        displaced[j] = displaced[j] + waves(sine, order, 1, unit)
        for h, column in by_harmonic(residual(displaced, constant_series(unit, 1)), order, 1).items():
            columns.setdefault(h, []).append(column)
    return columns


def waves(sine: bool, highest: int, power: int, unit: Coefficient) -> FourierSeries:
    """Return eps**power times the sum of all cosines, or sines, up to the highest harmonic."""
    return FourierSeries({(power, -h if sine else h): unit for h in range(int(sine), highest + 1)}, power)


def by_harmonic(equations: Sequence[FourierSeries], highest: int, power: int) -> dict[int, Column]:
    """Return for each harmonic up to `highest` the coefficients of eps**power in the equations."""
    columns: dict[int, Column] = {h: {} for h in range(highest + 1)}
    for i, equation in enumerate(equations):
        for key, v in equation.harmonics(power).items():
            columns[abs(key)][i, key] = v
    return columns


def _frequency_column(
    residual: Residual, unknowns: Sequence[FourierSeries], unit: Coefficient, mode_power: int
) -> dict[tuple[int, int], Coefficient]:
    """Return the change of the equations per unit of the frequency, exact because the frequency enters quadratically."""
    first = [u.through(mode_power) for u in unknowns]
    up, down = (residual(first, constant_series(value, 1)) for value in (unit + unit, unit - unit))
    column = {}
    for i, (faster, slower) in enumerate(zip(up, down, strict=True)):
        for key, v in (faster - slower).harmonics(mode_power).items():
            column[i, key] = v / 2
    return column


def harmonic_solver(
    columns: list[Column], extra: Column | None, fixed: int | None, field: Domain, value: Callable[[Any], Coefficient]
) -> Solver:
    """Return a function that solves the equations at one harmonic of an order.

    It takes the residuals of the order, the harmonic, and the value of the unknown with the index `fixed`. It returns the
    coefficients of the unknowns, and the shift of the frequency if `extra` is the column of that, else zero. The system is
    reduced exactly once for all orders, and undetermined unknowns are zero. The function raises SingularError for an
    unsolvable order.
    """
    system = [*columns, *([extra] if extra is not None else [])]
    rows = sorted({key for column in system for key in column})
    table = [[column.get(row, field.zero) for column in system] for row in rows]
    if fixed is not None:
        table.append([field.one if j == fixed else field.zero for j in range(len(system))])
    pivots, inverse = _eliminate(table, field, value)

    def solve(now: Sequence[Waves], h: int, at: Coefficient) -> tuple[list[Coefficient], Coefficient]:
        remainder = {(i, key): -v for i, waves in enumerate(now) for key, v in waves.items() if abs(key) == h}
        right = [remainder.pop(row, 0) for row in rows] + ([] if fixed is None else [at])
        zero = value(field.zero)
        solved = [sum((e * r for e, r in zip(row, right, strict=True) if e and r), zero) for row in inverse]
        largest = max((abs(v) for waves in now for v in waves.values()), default=0) if value is float else 0
        if any(
            abs(v) > _ROUNDING * (1 + largest) if value is float else v
            for v in (*solved[len(pivots) :], *remainder.values())
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
    """Return the indices of the determined unknowns, and a matrix that multiplies the right side of the equations.

    The product begins with the values of these unknowns. The other numbers in it vanish if the equations can be solved.
    """
    n, m = len(table), len(table[0]) if table else 0
    wide = [row + [field.one if i == j else field.zero for j in range(n)] for i, row in enumerate(table)]
    if not wide:
        return [], []
    reduced, pivots = DomainMatrix(wide, (n, m + n), field).rref()
    return [j for j in pivots if j < m], [list(map(value, row[m:])) for row in reduced.to_list()]


@dataclass(frozen=True)
class Perturbed:
    """A perturbed orbit, orbit + xi p + eta q to first order, with xi' = A eta, eta' = B xi.

    Its arithmetic turns the equations of an orbit into the variational equations. `exchange` is the sign of p and q in the
    equations half a period later.
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
        return self._with(self.orbit.times(factor), self.p.times(factor), self.q.times(factor))

    def derivative(self) -> "Perturbed":
        """Return df/dPhi; in it (p' + B q) xi + (q' + A p) eta takes the place of the perturbation p xi + q eta of f."""
        p, q = self.p.derivative() + self.B * self.q, self.q.derivative() + self.A * self.p
        return self._with(self.orbit.derivative(), p, q)

    def half_period_later(self) -> "Perturbed":
        """Return f(Phi + pi), with the perturbation multiplied by `exchange`."""
        p, q = (series.half_period_later().times(self.exchange) for series in (self.p, self.q))
        return self._with(self.orbit.half_period_later(), p, q)

    def constant(self, value: Coefficient) -> "Perturbed":
        return self._with(self.orbit.constant(value), self.p.constant(0), self.q.constant(0))


@dataclass(frozen=True)
class ExponentSeries:
    """A and B as series in the amplitude, and the periodic functions p and q of the perturbations, one for each unknown."""

    A: FourierSeries
    B: FourierSeries
    p: tuple[FourierSeries, ...]
    q: tuple[FourierSeries, ...]

    @property
    def square(self) -> FourierSeries:
        """The square lambda² = A B per radian² of phase: positive for growth, negative for oscillation."""
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
    """Return A and B through eps**order for an orbit known through at least that order.

    `residual` and `numeric` are the equations of motion that `periodic_series` describes. `exchange` is the sign of p and q
    in the equations half a period later. `sines` is True for each unknown with a sine series; p has the same parities, q the
    opposite ones. `neutral` has the indices of the unknowns whose unit displacements are p_0 and q_0. The means of these two
    unknowns have no terms of higher order. Raises SingularError if another exponent is close to zero.
    """
    parity = {"p": list(sines), "q": [not sine for sine in sines]}
    fixed = dict(zip("pq", neutral, strict=True))
    nothing, unit = FourierSeries({}, order), constant_series(field.one, order)
    perturbation = {name: [unit if i == fixed[name] else nothing for i in range(len(sines))] for name in "pq"}
    operators, drift = _responses(residual, orbit.at_rest(field), parity, perturbation, order, field.one, exchange)
    value = field.convert if numeric is None else float
    unknowns = {name: [series.convert(value) for series in perturbation[name]] for name in "pq"}
    slow = {name: FourierSeries({}, order) for name in "pq"}  # B from the equations' p part, A from their q part
    equations = _varied(numeric or residual, orbit, unknowns, slow, exchange)
    solvers: dict[tuple[str, int], Solver] = {}
    for n in range(1, order + 1):
        now = {name: [getattr(equation, name).at(n) for equation in equations] for name in "pq"}
        for name in "pq":
            for h in range(n, -1, -2):
                if (name, h) not in solvers:
                    extra, mean = (drift[name], fixed[name]) if h == 0 else (None, None)
                    solvers[name, h] = harmonic_solver(operators[name, h], extra, mean, field, value)
                values, shift = solvers[name, h](now[name], h, value(field.zero))
                for j, coefficient in enumerate(values):
                    unknowns[name][j].assign(n, -h if parity[name][j] else h, coefficient)
                slow[name].assign(n, 0, shift)
        forget([series for equation in equations for series in (equation.p, equation.q)], n)
    return ExponentSeries(slow["q"], slow["p"], tuple(unknowns["p"]), tuple(unknowns["q"]))


def _varied(
    residual: Residual,
    orbit: PeriodicSeries,
    perturbation: Mapping[str, Sequence[Series]],
    slow: Mapping[str, Series],
    exchange: int,
) -> list[Perturbed]:
    """Evaluate the equations of motion on an orbit with this perturbation, for A = slow["q"] and B = slow["p"]."""

    def at(f: FourierSeries, p: Series, q: Series) -> Perturbed:
        return Perturbed(f, p, q, slow["q"], slow["p"], exchange)

    unknowns = [at(*triple) for triple in zip(orbit.unknowns, perturbation["p"], perturbation["q"], strict=True)]
    nothing = FourierSeries({}, orbit.frequency.order)
    return residual(unknowns, at(orbit.frequency, nothing, nothing))


def _responses(
    residual: Residual,
    equilibrium: PeriodicSeries,
    parity: Mapping[str, Sequence[bool]],
    perturbation: Mapping[str, Sequence[FourierSeries]],
    order: int,
    unit: Coefficient,
    exchange: int,
) -> tuple[dict[tuple[str, int], list[Column]], dict[str, Column]]:
    """Return the perturbed equations at rest, as two mappings to columns of coefficients.

    The first maps ("p" or "q", harmonic) to one column for a unit of each unknown. The second maps "p" to the column for a
    unit of B, and "q" to that for a unit of A. At equilibrium harmonics do not couple, so that one evaluation serves all.
    """
    nothing, operators, drift = FourierSeries({}, order), dict[tuple[str, int], list[Column]](), dict[str, Column]()
    for j in range(len(equilibrium.unknowns)):
        units = {name: [nothing] * len(equilibrium.unknowns) for name in "pq"}
        for name in "pq":
            units[name][j] = waves(parity[name][j], order, 0, unit)
        answer = _varied(residual, equilibrium, units, dict.fromkeys("pq", nothing), exchange)
        for name in "pq":
            for h, column in by_harmonic([getattr(r, name) for r in answer], order, 0).items():
                operators.setdefault((name, h), []).append(column)
    for name, driver in ("pq", "qp"):
        still, slow = {name: [nothing] * len(equilibrium.unknowns), driver: perturbation[driver]}, {driver: nothing}
        answer = _varied(residual, equilibrium, still, slow | {name: constant_series(unit, order)}, exchange)
        drift[name] = by_harmonic([getattr(r, name) for r in answer], 0, 0)[0]
    return operators, drift


_HIGHEST_ORDER = 2  # of averaging
_START_TOLERANCE = 1e-9  # relative residual of the initial state
_PHASE = sp.Symbol("Phi", real=True)  # the phase Φ = ω t of a periodic motion


@dataclass(frozen=True, eq=False, repr=False)
class Oscillation(Shown):
    """A family of periodic motions in powers of a small quantity, with q' = 0 at phase Φ = ω t = 0.

    Attributes
    ----------
    frequency : Expr
        Angular frequency ω in rad/s, with its O() term.
    motion : Expr
        The coordinate q as a function of Symbol("Phi", real=True), with its O() term.
    known_through : int
        The power of `small` through which both are known.
    small : Symbol
        The expansion parameter: a parameter of the system, or the amplitude itself.
    amplitude : Symbol
        The value of q at Φ = 0 minus its value at equilibrium.
    system : Equations
        The system in motion, which has one coordinate.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c, A = coordinates("theta"), sp.Symbol("A", positive=True)
    >>> System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0])).lindstedt_poincare(2, A).frequency
    1 - A**2/16 + O(A**3)
    """

    _shown = (
        ("frequency ω [rad/s]", "frequency"),
        ("motion, Φ = ω t", "motion"),
    )

    frequency: sp.Expr
    motion: sp.Expr
    known_through: int
    small: sp.Symbol
    amplitude: sp.Symbol
    system: Equations

    def error(self, values: Mapping[Any, Any]) -> float:
        """Measure the relative error of the frequency against the period of a simulation, which is accurate to 10⁻¹¹.

        Parameters
        ----------
        values : mapping
            {symbol: number} for all symbols, `small` and `amplitude` among them.

        Returns
        -------
        float
            Absolute difference of the two frequencies, divided by the simulated one.

        Raises
        ------
        InputError
            For a symbol without a value.
        SingularError
            When the simulated motion does not return within 1.6 periods.
        """
        import numpy as np

        from lagrotor.mechanics.running import simulation

        symbols = self.frequency.free_symbols | self.motion.free_symbols | self.system.motion.free_symbols
        numeric = {s: sp.sympify(x, strict=True) for s, x in by_symbol("error: values", values, symbols).items()}
        omega = self.frequency.removeO().subs(numeric)
        start = self.motion.removeO().subs(_PHASE, 0).subs(numeric)
        no_letter("error", omega.free_symbols | start.free_symbols)
        parameters = self.system.L.free_symbols | self.system.generalised_forces.free_symbols
        numbers = {str(s): float(x) for s, x in numeric.items() if s in parameters}
        (q,), (v,) = self.system.c.q, self.system.c.v
        period = 2 * float(sp.pi) / float(omega)
        times = np.linspace(0, 1.6 * period, 33)
        run = simulation.simulate_system(self.system, numbers, (float(start),), (0.0,), times, 1e-11)
        returns = run.crossings(v, direction=1 if run.v[1, 0] > 0 else -1)
        turns = returns.t[returns.t > 0.4 * period]
        if not len(turns):
            raise SingularError(
                f"error: the motion from {q} = {float(start):.6g} does not return within 1.6 periods: try a smaller amplitude"
            )
        return float(abs(omega / (2 * sp.pi / turns[0]) - 1))


def oscillation(
    system: Equations, order: int, small: sp.Symbol, at: Any = 0, amplitude: sp.Symbol | None = None
) -> Oscillation:
    """Return the series of the periodic motions about q = at: `System.lindstedt_poincare`."""
    _check_one("lindstedt_poincare", system, order, small)
    if not isinstance(amplitude, sp.Symbol | None):
        raise InputError(f"lindstedt_poincare: amplitude = {amplitude!r} must be a symbol")
    A = amplitude or sp.Symbol("A", positive=True)
    equilibrium = expression("lindstedt_poincare: at", at)
    inside = small in system.motion.free_symbols
    terms = _terms_about(equilibrium, system, order, small, A if inside else None)
    K, M = _stiffness_and_mass(terms, f"{system.c.q[0]} = {equilibrium}")
    if inside and any(sum(powers) > 1 and n == 0 for n, *powers in terms):
        raise InputError(
            f"lindstedt_poincare: the equation is not linear where {small} = 0: to expand in the amplitude instead, "
            "give a symbol that the system does not contain as the small quantity"
        )
    field, convert = _field([*terms.values(), *([A] if inside else [])])
    coefficients = [((n, i, j // 2, k), convert(e / K)) for (n, i, j, k), e in terms.items()]

    def residual(unknowns: Sequence[Series], frequency: Series) -> list[Series]:
        (x,) = unknowns
        turn = (frequency * frequency).times(convert(K / M))
        first = x.derivative()
        return [_sum_of_products(coefficients, (x, turn * first * first, turn * first.derivative()))]  # q, v², a

    mode = {1: convert(A) if inside else field.one}
    solved = periodic_series(residual, [field.zero], [mode], order, field, mode_power=0 if inside else 1)
    bound = sp.O(small ** (order + 1))
    factor, displacement = (_expression_of(s, field, _PHASE, small) for s in (solved.frequency, solved.unknowns[0]))
    powers = sp.Poly(factor, small).terms()
    frequency = sp.Add(*(sp.sqrt(sp.cancel(K / M)) * sp.factor(c) * small**n for (n,), c in powers)) + bound
    return Oscillation(frequency, equilibrium + displacement + bound, solved.known_through, small, A, system)


def _terms_about(
    equilibrium: sp.Expr, system: Equations, order: int, small: sp.Symbol, amplitude: sp.Symbol | None
) -> dict[tuple[int, ...], sp.Expr]:
    """Expand the equation about the equilibrium: return {(powers of small, q, v, a): coefficient}.

    If `amplitude` is None, `small` is the size of the motion, and q, v and a are of first order in it.
    """
    (q,), (v,), (a,) = system.c.q, system.c.v, system.c.a
    equation = system.motion[0]
    if amplitude is not None and str(amplitude) in map(str, equation.free_symbols):
        raise InputError(f"lindstedt_poincare: amplitude = {amplitude} is a symbol of the system: give it another name")
    if t in equation.free_symbols:
        raise InputError("lindstedt_poincare: the system depends on time: use averaged")
    equation = equation.subs(q, equilibrium + q) if equilibrium != 0 else equation
    if amplitude is None:
        e = sp.Dummy("epsilon", positive=True)
        scaled = equation.subs({q: e * q, v: e * v, a: e * a}, simultaneous=True)
        polynomial = _series(scaled, e, order + 1).subs(e, 1)
    else:
        polynomial = _series(equation, small, order)
    poly = _polynomial("lindstedt_poincare", polynomial, (small, q, v, a))
    return {powers: coefficient for powers, coefficient in poly.terms() if decide_zero(coefficient).answer != "zero"}


def _stiffness_and_mass(terms: Mapping[tuple[int, ...], sp.Expr], place: str) -> tuple[sp.Expr, sp.Expr]:
    """Return the coefficients K of q and M of a where `small` is zero. Raises InputError unless small motions are periodic."""
    if any(not any(powers) for _, *powers in terms):
        raise InputError(f"lindstedt_poincare: {place} is no equilibrium: the force is not zero: give one as at=")
    if any(j % 2 for _, _, j, _ in terms):
        raise InputError(
            "lindstedt_poincare: the equation has odd powers of the velocity, and is not the same backward: use averaged, which "
            "gives the change of the amplitude"
        )
    K, M = terms.get((0, 1, 0, 0), sp.S.Zero), terms.get((0, 0, 0, 1), sp.S.Zero)
    if K == 0 or M == 0 or (K / M).is_nonpositive:
        raise InputError(
            f"lindstedt_poincare: {place} has no frequency of small motion, ω² = {K / M if M else 'K/0'}: give a stable at="
        )
    return K, M


@dataclass(frozen=True, eq=False, repr=False)
class AveragedMotion(Shown):
    """The averaged equations of the slow amplitudes (a, b) of q = a cos νt + b sin νt.

    Attributes
    ----------
    amplitudes : tuple[Symbol, Symbol]
        The symbols a and b, in the unit of q.
    rates : tuple[Expr, Expr]
        The averaged rates a' and b', as series through small**order.
    state : tuple[Expr, Expr]
        The coordinate q and the velocity q' as expressions in a, b and t. For order 2 they contain the correction ε u₁.
    frequency : Expr
        The unperturbed angular frequency ν in rad/s.
    small : Symbol
        The expansion parameter.
    order : int
        1 or 2.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c, e = coordinates("x"), sp.Symbol("epsilon", positive=True)
    >>> van_der_pol = System(c, (c.v[0] ** 2 - c.q[0] ** 2) / 2, forces=(e * (1 - c.q[0] ** 2) * c.v[0],))
    >>> van_der_pol.averaged(1, e).polar
    (-epsilon*r**3/8 + epsilon*r/2, 0)
    """

    _shown = (
        ("motion", lambda s: f"q = {text_of(s.state[0])}"),
        (
            "slow rates",
            lambda s: "; ".join(f"{text_of(a)}' = {text_of(e)}" for a, e in zip(s.amplitudes, s.rates, strict=True)),
        ),
        ("polar", lambda s: "r' = {}; β' = {}".format(*map(text_of, s.polar))),
        ("order", lambda s: f"{s.order} in {text_of(s.small)}"),
    )

    amplitudes: tuple[sp.Symbol, sp.Symbol]
    rates: tuple[sp.Expr, sp.Expr]
    state: tuple[sp.Expr, sp.Expr]
    frequency: sp.Expr
    small: sp.Symbol
    order: int

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    @property
    def polar(self) -> tuple[sp.Expr, sp.Expr]:
        """The rates (r', β') of q = r cos(νt + β), in the symbols r and beta.

        If the system already uses one of these names, the symbols are r_0 and beta_0.
        """
        used = {str(s) for e in self.rates for s in e.free_symbols}
        names = ["r_0", "beta_0"] if used & {"r", "beta"} else ["r", "beta"]
        r, beta = sp.Symbol(names[0], positive=True), sp.Symbol(names[1], real=True)
        polar_form = dict(zip(self.amplitudes, (r * sp.cos(beta), -r * sp.sin(beta)), strict=True))
        a_rate, b_rate = (e.xreplace(polar_form) for e in self.rates)
        amplitude_rate = a_rate * sp.cos(beta) - b_rate * sp.sin(beta)
        phase_rate = -(a_rate * sp.sin(beta) + b_rate * sp.cos(beta)) / r
        return shortest(sp.expand(amplitude_rate)), shortest(sp.expand(phase_rate))

    def run(self, values: Mapping[Any, Any], q0: float, v0: float, times: Any) -> Any:
        """Integrate the averaged equations in numbers.

        Parameters
        ----------
        values : mapping
            {symbol: number} for all symbols.
        q0 : float
            Coordinate at times[0].
        v0 : float
            Velocity at times[0].
        times : array_like
            Times in s, shape (n,).

        Returns
        -------
        ndarray
            The coordinate and the velocity, shape (2, n).

        Raises
        ------
        InputError
            For a symbol without a value.
        SingularError
            When no amplitudes match the initial state.
        """
        import numpy as np
        from scipy.optimize import root

        from lagrotor.numerics.arrays import check_times, real_array
        from lagrotor.numerics.integrate import Problem, integrate

        grid = check_times("averaged", times)
        initial = real_array((q0, v0))
        if initial is None or initial.shape != (2,) or not np.isfinite(initial).all():
            raise InputError(f"averaged: q0 = {q0!r} and v0 = {v0!r} must be finite numbers")
        parameters = set().union(*(e.free_symbols for e in (*self.rates, *self.state))) - {*self.amplitudes, t}
        numeric = {s: float(x) for s, x in by_symbol("averaged: values", values, parameters).items() if s in parameters}
        no_letter("averaged", parameters - numeric.keys())
        slow = sp.lambdify(self.amplitudes, [e.subs(numeric) for e in self.rates], "numpy")
        state_at = sp.lambdify((*self.amplitudes, t), [e.subs(numeric) for e in self.state], "numpy")
        start = root(lambda Y: np.array(state_at(*Y, grid[0])) - initial, [q0, 0.0], tol=1e-13).x
        residual = np.abs(np.array(state_at(*start, grid[0])) - initial).max()
        if not residual <= _START_TOLERANCE * max(1.0, abs(q0), abs(v0)):
            raise SingularError(
                f"averaged: no amplitudes match the initial state q = {q0:g}, q' = {v0:g}: {self.small} is too large there "
                "for its second order; take a smaller one, or simulate"
            )
        problem = Problem(lambda s, Y: [float(x) for x in slow(*Y)], start, np.inf)
        Y = np.vstack([start, integrate(problem, grid[1:] - grid[0], 1e-11).states])
        return np.array([np.broadcast_to(e, grid.shape) for e in state_at(*Y.T, grid)])


def averaged(system: Equations, order: int, small: sp.Symbol, frequency: Any = None) -> AveragedMotion:
    """Return the slow motion of the amplitudes through small**order: `System.averaged`."""
    _check_one("averaged", system, order, small)
    if order > _HIGHEST_ORDER:
        raise InputError(f"averaged: order = {order} must be 1 or 2: no higher one is derived")
    (q,), (v,), (a,) = system.c.q, system.c.v, system.c.a
    equation = system.motion[0]
    slope = sp.diff(equation, a)
    if small not in equation.free_symbols or a in slope.free_symbols:
        raise InputError(f"averaged: small = {small} must be a symbol of the system, which is linear where it is zero")
    acceleration = -equation.subs(a, 0) / slope
    still = sp.expand(acceleration.subs(small, 0))
    square = -sp.diff(still, q)
    nu = sp.sqrt(square) if frequency is None else expression("averaged: frequency", frequency)
    if decide_zero(still + nu**2 * q).answer != "zero" or nu.is_nonpositive or nu.has(sp.I):
        raise InputError(f"averaged: for {small} = 0, {a} = {still} is not −ν² {q} with ν = {nu}: give frequency")
    F = _series(acceleration + nu**2 * q, small, order)
    base, waves = _trigonometric(F, nu)
    poly = _polynomial("averaged", F.xreplace(waves.symbol_of), (small, q, v, *waves.symbols))
    A, B, rate = sp.Symbol("a", real=True), sp.Symbol("b", real=True), sp.Dummy("nu", positive=True)
    if {A, B} & system.motion.free_symbols:
        A, B = sp.Symbol("a_c", real=True), sp.Symbol("a_s", real=True)
    field, convert = _field([*(c.subs(nu, rate) if nu.is_Symbol else c for _, c in poly.terms()), A, B, rate])
    unit, h = field.one, base
    factors = (
        FourierSeries({(0, h): convert(A), (0, -h): convert(B)}, order),
        FourierSeries({(0, h): convert(rate) * convert(B), (0, -h): -convert(rate) * convert(A)}, order),
        *(FourierSeries({(0, k): unit}, order) for k in waves.harmonics),
    )
    forced = _sum_of_products([(powers, convert(e)) for powers, e in poly.terms()], factors)
    sine, cosine = FourierSeries({(0, -h): unit}, order), FourierSeries({(0, h): unit}, order)
    pushes = [(forced * sine).times(-unit / convert(rate)), (forced * cosine).times(unit / convert(rate))]
    means = [[g.harmonics(n).get(0, field.zero) for n in range(1, order + 1)] for g in pushes]
    amplitudes = [A, B]
    if order == 2:
        shift = [_integral(g, 1, convert(rate) / h) for g in pushes]
        amplitudes = [s + _expression_of(u, field, nu * t / h, small) for s, u in zip(amplitudes, shift, strict=True)]
        generators = [field.from_sympy(A), field.from_sympy(B)]
        for i, g in enumerate(pushes):
            for place, u in zip(generators, shift, strict=True):
                slope_of_g = FourierSeries({k: c.diff(place) for k, c in g.terms.items() if k[0] == 1}, 2)
                means[i][1] += (slope_of_g * u).harmonics(2).get(0, field.zero)

    def plain(e: sp.Expr) -> sp.Expr:
        return e.subs(rate, nu)

    rates = tuple(plain(sp.Add(*(field.to_sympy(c) * small ** (n + 1) for n, c in enumerate(mean)))) for mean in means)
    c, s = sp.cos(nu * t), sp.sin(nu * t)
    state = (amplitudes[0] * c + amplitudes[1] * s, nu * (amplitudes[1] * c - amplitudes[0] * s))
    return AveragedMotion((A, B), (rates[0], rates[1]), (plain(state[0]), plain(state[1])), nu, small, order)


@dataclass(frozen=True)
class _Waves:
    """The sines and cosines of time in a force: {function: symbol}, and the harmonic number of each, negative for a sine."""

    symbol_of: Mapping[sp.Expr, sp.Symbol]
    harmonics: tuple[int, ...]

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        return tuple(self.symbol_of.values())


def _trigonometric(F: sp.Expr, nu: sp.Expr) -> tuple[int, _Waves]:
    """Return the integer ν/ν₀ for the largest common base frequency ν₀, and the sines and cosines of time in F."""
    nodes = sorted((e for e in F.atoms(sp.sin, sp.cos) if t in e.free_symbols), key=sp.default_sort_key)
    ratios = []
    for e in nodes:
        ratio = sp.cancel(e.args[0] / (nu * t))
        ratio = sp.Rational(str(ratio)) if ratio.is_Float else ratio
        if not ratio.is_Rational or ratio <= 0:
            raise DomainError(
                f"averaged: the frequency of {e} is no rational multiple of ν = {nu}, or it has a phase: write frequencies like "
                "2 ν, and symbols for the cosine and sine of a phase"
            )
        ratios.append(ratio)
    base = lcm(*(int(ratio.q) for ratio in ratios)) if ratios else 1
    signs = [-1 if isinstance(e, sp.sin) else 1 for e in nodes]
    numbers = tuple(int(ratio * base) * sign for ratio, sign in zip(ratios, signs, strict=True))
    return base, _Waves({e: sp.Dummy(f"w{i}", real=True) for i, e in enumerate(nodes)}, numbers)


def _sum_of_products(coefficients: Sequence[tuple[tuple[int, ...], Coefficient]], series: Sequence[Series]) -> Series:
    """Return the sum of c smallⁿ Π seriesᵢ^kᵢ over the entries ((n, k₁, …), c) of `coefficients`."""
    total = series[0].constant(0)
    for (n, *powers), c in coefficients:
        factors = (f for f, k in zip(series, powers, strict=True) for _ in range(k))
        total = total + reduce(mul, factors, series[0].constant(c)).raised(n)
    return total


def _integral(g: FourierSeries, n: int, rate: Any) -> FourierSeries:
    """Integrate the terms of small**n over time, with zero mean; `rate` is the time derivative of the phase."""
    terms = {}
    for k, c in g.harmonics(n).items():
        if k:
            terms[n, -k] = (c if k > 0 else -c) / (rate * abs(k))
    return FourierSeries(terms, g.order)


def _expression_of(u: FourierSeries, field: Domain, phase: sp.Expr, small: sp.Symbol) -> sp.Expr:
    """Return a series as an expression in its phase and `small`."""
    waves = ((n, k, field.to_sympy(c)) for (n, k), c in u.terms.items())
    return sp.Add(*(c * small**n * (sp.cos(k * phase) if k >= 0 else sp.sin(-k * phase)) for n, k, c in waves))


def _check_one(where: str, system: Equations, order: int, small: sp.Symbol) -> None:
    no_states(where, system, "the series are of one coordinate alone: simulate it, or use floquet")
    if len(system.c.q) != 1 or system.multipliers:
        raise InputError(
            f"{where}: one coordinate without constraints is taken: eliminate others by routh if cyclic, constraints by "
            "in_coordinates; for several modes use Hamiltonian.normal_form"
        )
    if not isinstance(order, int) or isinstance(order, bool) or order < 1:
        raise InputError(f"{where}: order = {order!r} must be a whole number, at least 1")
    if not isinstance(small, sp.Symbol) or small in (*system.c.q, *system.c.v, *system.c.a, t):
        raise InputError(f"{where}: small = {small!r} must be a symbol, a parameter or the amplitude")


def _series(e: sp.Expr, small: sp.Symbol, order: int) -> sp.Expr:
    return sp.expand(truncated_series(e, small, order))


def _polynomial(where: str, e: sp.Expr, variables: Sequence[sp.Symbol]) -> sp.Poly:
    try:
        poly = sp.Poly(e, *variables)
    except sp.PolynomialError:
        poly = None
    if poly is None or any({*variables, t} & c.free_symbols for c in poly.coeffs()):
        raise DomainError(f"{where}: {e} is no polynomial in {', '.join(map(str, variables))}: expand it first")
    return poly


def _field(coefficients: Sequence[sp.Expr]) -> tuple[Domain, Any]:
    """Return an exact field that contains the expressions, and the function that converts an expression into its element."""
    field, _ = sp.construct_domain([*coefficients, sp.S.Half], field=True)
    if field.is_EX:
        field, _ = sp.construct_domain([*coefficients, sp.S.Half], field=True, extension=True)
    if field.is_EX or not field.is_Exact:
        raise DomainError(f"the coefficients {coefficients} belong to no exact field: write decimals as fractions")
    return field, lambda e: field.from_sympy(sp.sympify(e, strict=True))
