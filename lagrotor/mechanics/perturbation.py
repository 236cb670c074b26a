"""The Lindstedt–Poincaré series of a periodic orbit. Nayfeh & Mook, Nonlinear Oscillations, 2.3."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from sympy.polys.domains.domain import Domain
from sympy.polys.matrices import DomainMatrix

from lagrotor.errors import SingularError
from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Series, constant
from lagrotor.mechanics.order_by_order import Unknowns

Residual = Callable[[Sequence[Series], Series], list[Series]]


@dataclass(frozen=True)
class PeriodicSeries:
    """A periodic orbit: unknowns as Fourier series in (eps, Phi), and the frequency, sum_n omega_n eps^n."""

    unknowns: tuple[FourierSeries, ...]
    frequency: FourierSeries


def lindstedt_poincare(
    residual: Residual,
    rest: Sequence[Coefficient],
    mode: Sequence[Mapping[int, Coefficient]],
    order: int,
    field: Domain,
    amplitude: int = 0,
) -> PeriodicSeries:
    """The series of the periodic orbit that starts as rest + eps mode, with frequency 1 + omega_2 eps² + …

    residual(unknowns, frequency): the equations of motion as Fourier series, zero on the orbit; derivatives by the
    phase, time derivatives carried by the frequency. rest: unknowns at equilibrium; mode: {harmonic: coefficient} of
    each at first order (cos for h ≥ 0, sin for h < 0), which also fixes each unknown's parity by its sign; an unknown
    without a first-order part is a cosine series. eps is the value of unknown number `amplitude` at Phi = 0, less rest.

    At order n the coefficients of eps^n enter linearly, harmonic by harmonic, by the operator of the linear mode; where
    that is singular (the mode's own harmonic) the frequency's correction omega_{n−1} makes the system solvable.
    Raises SingularError when it is not: a resonance with another mode.
    """
    one = field.one
    sines = [bool(m) and min(m) < 0 for m in mode]
    begins = [
        constant(r, order) + FourierSeries({(1, h): v for h, v in m.items()}, order)
        for r, m in zip(rest, mode, strict=True)
    ]
    growing = Unknowns()
    unknowns, frequency = [growing.series(begin) for begin in begins], growing.series(constant(one, order))
    equations = residual(unknowns, frequency)
    operators: dict[int, list[dict[tuple[int, int], Coefficient]]] = {}
    drift = _frequency_column(residual, begins, one)

    for n in range(2, order + 1):
        now = [equation.at(n) for equation in equations]
        # The highest harmonics first: the mode's own takes what the amplitude's definition leaves.
        at_zero = field.zero
        for h in range(n, -1, -2):
            if h not in operators:
                operators[h] = _columns(residual, rest, sines, h, one)
            wanted = {(i, key): -v for i, waves in enumerate(now) for key, v in waves.items() if abs(key) == h}
            extra = drift if h == 1 else None
            fixed = (amplitude, -at_zero) if h == 1 else None
            values, shift = solve_harmonic(operators[h], wanted, extra, fixed, field)
            for j, value in enumerate(values):
                growing.found(unknowns[j], n, -h if sines[j] else h, value)
            at_zero += field.zero if sines[amplitude] else values[amplitude]
            if shift:
                growing.found(frequency, n - 1, 0, shift)
                growing.forget(n - 1)
        growing.forget(n)
    return PeriodicSeries(tuple(growing.through(u, order) for u in unknowns), growing.through(frequency, order))


def _columns(
    residual: Residual, rest: Sequence[Coefficient], sines: Sequence[bool], h: int, one: Coefficient
) -> list[dict[tuple[int, int], Coefficient]]:
    """The linear operator at harmonic h: for each unknown the equations' response to a unit of it."""
    still = [constant(r, 1) for r in rest]
    responses = []
    for j, sine in enumerate(sines):
        moved = list(still)
        if not (sine and h == 0):
            moved[j] = moved[j] + FourierSeries({(1, -h if sine else h): one}, 1)
        found = residual(moved, constant(one, 1))
        responses.append({(i, key): v for i, r in enumerate(found) for key, v in r.harmonics(1).items()})
    return responses


def _frequency_column(
    residual: Residual, unknowns: Sequence[FourierSeries], one: Coefficient
) -> dict[tuple[int, int], Coefficient]:
    """The response of the first order to a unit change of frequency; exact, as the equations are quadratic in it."""
    first = [u.through(1) for u in unknowns]
    up, down = (residual(first, constant(value, 1)) for value in (one + one, one - one))
    column = {}
    for i, (more, less) in enumerate(zip(up, down, strict=True)):
        for key, v in (more - less).harmonics(1).items():
            column[i, key] = v / 2
    return column


def solve_harmonic(
    columns: list[dict[tuple[int, int], Coefficient]],
    wanted: dict[tuple[int, int], Coefficient],
    extra: dict[tuple[int, int], Coefficient] | None,
    fixed: tuple[int, Coefficient] | None,
    field: Domain,
) -> tuple[list[Coefficient], Coefficient]:
    """The unknowns of one harmonic, and the shift of frequency where there is one; what nothing determines is zero."""
    system = [*columns, *([extra] if extra is not None else [])]
    rows = sorted({key for column in (*system, wanted) for key in column})
    table = [[column.get(row, field.zero) for column in (*system, wanted)] for row in rows]
    if fixed:
        table.append([field.one if j == fixed[0] else field.zero for j in range(len(system))] + [fixed[1]])
    if not table:
        return [field.zero] * len(columns), field.zero
    reduced, pivots = DomainMatrix(table, (len(table), len(system) + 1), field).rref()
    if len(system) in pivots:
        raise SingularError("lindstedt_poincare: an order cannot be solved: the mode is in resonance with another")
    dense = reduced.to_dense().rep.to_list() if hasattr(reduced.rep, "to_list") else reduced.to_list()
    values = [field.zero] * len(system)
    for i, j in enumerate(pivots):
        values[j] = dense[i][-1]
    return values[: len(columns)], values[-1] if extra is not None else field.zero
