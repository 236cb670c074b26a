"""Characteristic exponents of a periodic orbit as power series in its amplitude.

Where a system at rest has two displacements that stay (p_0 and q_0, exponent zero), an orbit of small amplitude eps lets
them act on each other. A perturbation of the orbit is sought as

    xi p(Phi) + eta q(Phi),    d xi/d Phi = A eta,    d eta/d Phi = B xi,

with p and q periodic. Put into the equations of motion, linear in the perturbation, this fixes p, q, A and B order by
order in eps; no root is taken. The exponents per radian of phase are ± sqrt(A B).

Nayfeh & Mook, Nonlinear Oscillations, 5.3 (variational equations along a Lindstedt–Poincaré orbit).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from sympy.polys.domains.domain import Domain

from lagrotor.mechanics.fourier import Coefficient, FourierSeries, Series, constant_series
from lagrotor.mechanics.order_by_order import Unknowns
from lagrotor.mechanics.perturbation import (
    Column,
    PeriodicSeries,
    Residual,
    Solver,
    by_harmonic,
    harmonic_solver,
    waves,
)

Parts = dict[str, list[FourierSeries]]  # of "p" and "q", one series an unknown
_OTHER = {"p": "q", "q": "p"}


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

    Args:
        residual: the equations, over `field`, as `lindstedt_poincare` takes them.
        exchange: the sign that p and q take where the equations use half a period later.
        sines: which unknowns of the orbit are sine series; p has the same parities, q the opposite ones.
        neutral: the numbers of the unknowns whose unit displacements are p_0 and q_0; later orders leave their means unchanged.
        numeric: the same equations with floating-point coefficients, for an orbit that has those.

    Raises:
        SingularError: where an order cannot be solved: another exponent comes close to zero.
    """
    variation = _Variation(residual, field, order, exchange)
    parity = {"p": list(sines), "q": [not sine for sine in sines]}
    parts: Parts = {part: [FourierSeries({}, order) for _ in sines] for part in "pq"}
    fixed = dict(zip("pq", neutral, strict=True))
    for part, i in fixed.items():
        parts[part][i] = constant_series(field.one, order)
    rest = orbit.at_rest(field)
    drift = {part: variation.of_drift(part, parts, rest) for part in "pq"}
    value = field.convert if numeric is None else float
    growing = Unknowns()
    unknowns = {part: [growing.series(series.convert(value)) for series in parts[part]] for part in "pq"}
    slow = {
        part: growing.series(FourierSeries({}, order)) for part in "pq"
    }  # B from the equations' p part, A from their q part
    equations = variation.put_in(numeric or residual, growing.series, unknowns, slow, orbit)
    operators = variation.operators(parity, rest)
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
                    growing.put(unknowns[part][j], n, -h if parity[part][j] else h, coefficient)
                growing.put(slow[part], n, 0, shift)
        growing.forget(n)
    p, q = (tuple(growing.through(series, order) for series in unknowns[part]) for part in "pq")
    return ExponentSeries(growing.through(slow["q"], order), growing.through(slow["p"], order), p, q)


@dataclass(frozen=True)
class _Variation:
    """The variational equations of `residual` along an orbit."""

    residual: Residual
    field: Domain
    order: int
    exchange: int

    def put_in(
        self,
        residual: Residual,
        series: Callable[[FourierSeries], Series],
        parts: Mapping[str, Sequence[Series]],
        slow: Mapping[str, Series],
        orbit: PeriodicSeries,
    ) -> list[Perturbed]:
        """The equations with a perturbation put in whose parts and rates A, B are still to be found; series: of a known one."""

        def at(f: FourierSeries, p: Series, q: Series) -> Perturbed:
            return Perturbed(series(f), p, q, slow["q"], slow["p"], self.exchange)

        nothing = series(FourierSeries({}, self.order))
        unknowns = [at(*each) for each in zip(orbit.unknowns, parts["p"], parts["q"], strict=True)]
        return residual(unknowns, at(orbit.frequency, nothing, nothing))

    def of(self, n: int, parts: Parts, slow: dict[str, FourierSeries], orbit: PeriodicSeries) -> list[Perturbed]:
        """The equations with the perturbation put in, through eps**n."""
        kept = {part: [series.through(n) for series in parts[part]] for part in "pq"}
        rates = {part: series.through(n) for part, series in slow.items()}
        return self.put_in(self.residual, lambda f: f.through(n), kept, rates, orbit)

    @staticmethod
    def column(equations: Sequence[Perturbed], part: str, n: int) -> Column:
        """The coefficients of eps**n in one part of the equations."""
        return {(i, h): v for i, r in enumerate(equations) for h, v in getattr(r, part).harmonics(n).items()}

    def of_drift(self, part: str, parts: Parts, orbit: PeriodicSeries) -> Column:
        """The response at rest of the equations' `part` to a unit of the slow rate: by it the other part drives this one."""
        nothing = FourierSeries({}, self.order)
        other = {part: [nothing] * len(parts[part]), _OTHER[part]: parts[_OTHER[part]]}
        slow = {part: constant_series(self.field.one, self.order), _OTHER[part]: nothing}
        return self.column(self.of(0, other, slow, orbit), part, 0)

    def operators(
        self, parity: Mapping[str, Sequence[bool]], rest: PeriodicSeries
    ) -> dict[tuple[str, int], list[Column]]:
        """(part, harmonic h) → for each unknown the response at rest of the equations' part to a unit of its harmonic h.

        At rest no harmonic acts on another, so that all are put in together.
        """
        nothing, columns = FourierSeries({}, self.order), dict[tuple[str, int], list[Column]]()
        for j in range(len(rest.unknowns)):
            moved = {part: [nothing] * len(rest.unknowns) for part in "pq"}
            for part in "pq":
                moved[part][j] = waves(parity[part][j], self.order, 0, self.field.one)
            answer = self.of(0, moved, dict.fromkeys("pq", nothing), rest)
            for part in "pq":
                for h, column in by_harmonic([getattr(r, part) for r in answer], self.order, 0).items():
                    columns.setdefault((part, h), []).append(column)
        return columns
