"""The Lindstedt–Poincaré series of a periodic orbit. Nayfeh & Mook, Nonlinear Oscillations, 2.3."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sympy.polys.domains.domain import Domain
from sympy.polys.matrices import DomainMatrix

from lagrotor.errors import SingularError
from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Series, Waves, constant_series
from lagrotor.mechanics.order_by_order import Unknowns

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


def lindstedt_poincare(
    residual: Residual,
    rest: Sequence[Coefficient],
    mode: Sequence[Mapping[int, Coefficient]],
    order: int,
    field: Domain,
    amplitude: int = 0,
    numeric: Residual | None = None,
    begins_at: int = 1,
) -> PeriodicSeries:
    """The series of the periodic orbit that starts as rest + eps mode, with frequency 1 + omega_2 eps² + ….

    At order n the coefficients of eps^n enter linearly, harmonic by harmonic, by the operator of the linear mode; where
    that is singular (the mode's own harmonic) the frequency's correction omega_{n − begins_at} makes the system solvable.

    Args:
        residual: (unknowns, frequency) → the equations of motion as Fourier series, zero on the orbit; derivatives by the
            phase, time derivatives carried by the frequency.
        rest: unknowns at equilibrium.
        mode: {harmonic: coefficient} of each at first order (cos for h ≥ 0, sin for h < 0), which also fixes each unknown's
            parity by its sign; an unknown without a first-order part is a cosine series.
        order: through eps^order.
        field: that of the coefficients.
        amplitude: the number of the unknown whose value at Phi = 0, less rest, is eps.
        numeric: the same equations with floating-point coefficients; the series then has those, and is found ten times as fast.
        begins_at: the power of eps of the mode; 0 where eps is another small quantity, at which the equations are linear, and the
            mode an amplitude.

    Raises:
        SingularError: when it is not: a resonance with another mode.
    """
    one = field.one
    sines = [bool(m) and min(m) < 0 for m in mode]
    begins = [
        constant_series(r, order) + FourierSeries({(begins_at, h): v for h, v in m.items()}, order)
        for r, m in zip(rest, mode, strict=True)
    ]
    value = field.convert if numeric is None else float
    growing = Unknowns()
    *unknowns, frequency = (growing.series(begin.convert(value)) for begin in (*begins, constant_series(one, order)))
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
                extra, fixed = (drift, amplitude) if h == 1 else (None, None)
                solvers[h] = harmonic_solver(operators[h], extra, fixed, field, value)
            values, shift = solvers[h](now, h, -at_zero)
            for j, coefficient in enumerate(values):
                growing.put(unknowns[j], n, -h if sines[j] else h, coefficient)
            at_zero += 0 if sines[amplitude] else values[amplitude]
            if shift:
                growing.put(frequency, n - begins_at, 0, shift)
                growing.forget(n - begins_at)
        growing.forget(n)
    return PeriodicSeries(tuple(growing.through(u, order) for u in unknowns), growing.through(frequency, order))


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
            raise SingularError("lindstedt_poincare: an order cannot be solved: the mode is in resonance with another")
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
