"""Rates of small motion as one or two parameters change: root loci, and boundaries of stability."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import by_symbol, expression, put_in
from lagrotor.mechanics.glossary import latex
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.monodromy import monodromy_matrix
from lagrotor.mechanics.running.state_space import state_space
from lagrotor.numerics.arrays import increasing_array
from lagrotor.result_display import Shown, text_of

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure

_GROWS = 1e-6  # real part over the largest rate: above the rounding of double roots
_HALVINGS = 40  # halvings of the interval between two numbers


@dataclass(frozen=True, eq=False, repr=False)
class RootLocus(Shown):
    """The rates of small motion as functions of one parameter.

    Attributes
    ----------
    letter : Symbol
        The parameter.
    numbers : Array
        Increasing values of the parameter, the boundaries among them, shape (m,).
    rates : NDArray[complex128]
        The n rates in 1/s at each value, shape (m, n); a column follows one rate from value to value.
    boundaries : tuple of float
        Values at which the motion becomes stable or unstable, at most one between two given numbers. There the largest real
        part is a millionth of the largest rate, since rounding changes equal rates by its square root.

    Examples
    --------
    >>> from sympy import Symbol
    >>> from lagrotor.mechanics import System, coordinates
    >>> c, k = coordinates("x"), Symbol("k")
    >>> locus = System(c, (c.v[0]**2 - k * c.q[0]**2) / 2).root_locus({c.q[0]: 0}, {}, k, [-1, 0.5])
    >>> [round(abs(x), 6) for x in locus.boundaries]
    [0.0]
    """

    _shown = (
        (
            "parameter",
            lambda s: f"{text_of(s.letter)}, {len(s.numbers)} values from {s.numbers[0]:g} to {s.numbers[-1]:g}",
        ),
        ("stability changes at", lambda s: s.boundaries or "no value"),
        ("largest growth [1/s]", lambda s: s.growth.max()),
    )

    letter: sp.Symbol
    numbers: Array
    rates: NDArray[np.complex128]
    boundaries: tuple[float, ...]

    @property
    def growth(self) -> Array:
        """The largest real part of the rates at each value, in 1/s, shape (m,)."""
        return np.asarray(self.rates.real.max(1))

    def plot(self) -> "RunFigure":
        """Draw the real and imaginary parts of the rates over the parameter; lines mark the boundaries.

        Returns
        -------
        RunFigure
            A figure that a notebook shows.
        """
        from lagrotor.drawing.run_figure import rates_figure

        return rates_figure(f"${latex(self.letter)}$", self.numbers, self.rates, self.boundaries)


def root_locus(
    system: Equations, at: Mapping[Any, Any], values: Values, letter: sp.Symbol | str, numbers: ArrayLike
) -> RootLocus:
    grid, name = increasing_array("root_locus: numbers", numbers), str(letter)
    rates_at = _rates("root_locus", system, at, values, [name])
    rates_on_grid = [rates_at(x) for x in grid.tolist()]
    boundaries = _boundaries(rates_at, grid, rates_on_grid, _HALVINGS)
    pairs = [*zip(grid.tolist(), rates_on_grid, strict=True), *((x, rates_at(x)) for x in boundaries)]
    pairs.sort(key=lambda pair: pair[0])
    places, rates = np.array([x for x, _ in pairs]), [r for _, r in pairs]
    return RootLocus(sp.Symbol(name, real=True), places, _followed(rates), tuple(boundaries))


@dataclass(frozen=True, eq=False, repr=False)
class StabilityChart(Shown):
    """The largest growth of small motion over two parameters.

    Attributes
    ----------
    letters : tuple of Symbol
        The two parameters.
    numbers : tuple of Array
        Values of the first parameter, shape (m,), and of the second, shape (n,).
    growth : Array
        The largest real part of the rates in 1/s, shape (n, m).
    boundaries : Array
        Values of both parameters at which the motion becomes stable or unstable, shape (k, 2).
    """

    _shown = (
        (
            "parameters",
            lambda s: "; ".join(
                f"{text_of(x)}, {len(n)} values from {n[0]:g} to {n[-1]:g}"
                for x, n in zip(s.letters, s.numbers, strict=True)
            ),
        ),
        ("stable", lambda s: f"{(s.growth <= 0).mean():.0%} of the pairs of values"),
        ("boundary", lambda s: f"{len(s.boundaries)} points"),
        ("largest growth [1/s]", lambda s: s.growth.max()),
    )

    letters: tuple[sp.Symbol, sp.Symbol]
    numbers: tuple[Array, Array]
    growth: Array
    boundaries: Array

    def plot(self) -> "RunFigure":
        """Draw the growth over both parameters as shades, with the boundaries.

        Returns
        -------
        RunFigure
            A figure that a notebook shows.
        """
        from lagrotor.drawing.run_figure import chart_figure

        names = (f"${latex(self.letters[0])}$", f"${latex(self.letters[1])}$")
        return chart_figure(names, self.numbers, self.growth, self.boundaries)


def stability_chart(
    system: Equations, at: Mapping[Any, Any], values: Values, numbers: Mapping[Any, ArrayLike], period: Any = None
) -> StabilityChart:
    if not isinstance(numbers, Mapping) or len({*map(str, numbers)}) != 2:
        raise InputError(f"stability_chart: numbers = {numbers!r} must be {{symbol: numbers, symbol: numbers}}")
    names = [str(letter) for letter in numbers]
    first, second = (increasing_array(f"stability_chart: {name}", places) for name, places in numbers.items())
    rates_at = _rates("stability_chart", system, at, values, names, period)
    rows, edges = list[list[float]](), list[tuple[float, float]]()
    for y in second.tolist():
        rates_on_line = [rates_at(x, y) for x in first.tolist()]
        rows.append([float(rates.real.max()) for rates in rates_on_line])
        edges += [(x, y) for x in _boundaries(lambda x, y=y: rates_at(x, y), first, rates_on_line, _HALVINGS // 2)]  # type: ignore[misc]
    letters = (sp.Symbol(names[0], real=True), sp.Symbol(names[1], real=True))
    return StabilityChart(letters, (first, second), np.array(rows), np.array(edges).reshape(-1, 2))


def _rates(
    where: str, system: Equations, at: Mapping[Any, Any], values: Values, names: Sequence[str], period: Any = None
) -> Callable[..., NDArray[np.complex128]]:
    """Return a function that takes one number for each named parameter and returns the rates of small motion in 1/s. If a period
    T is given, these are ln(μ)/T of the Floquet multipliers μ."""
    if not isinstance(values, Mapping) or {*names} & {*map(str, values)}:
        raise InputError(
            f"{where}: values = {values!r} must be a dictionary without {', '.join(names)}, which takes the numbers"
        )
    if not isinstance(at, Mapping):
        raise InputError(f"{where}: at = {at!r} must be {{coordinate: number or expression, …}}, a dictionary")
    places = {s: expression(f"{where}: at", e) for s, e in at.items()}
    turn = None if period is None else expression(f"{where}: period", period)
    of_period = {str(s) for s in turn.free_symbols} if turn is not None else set()
    period_values = {s: x for s, x in values.items() if str(s) in of_period}
    letters = system.letters.union(*(e.free_symbols for e in system.acting))
    of_system = {*names} & {*map(str, letters)}  # the others occur in `at` or the period alone
    if (
        strangers := {*names}
        - of_system
        - {str(s) for e in (*places.values(), sp.sympify(turn or 0, strict=True)) for s in e.free_symbols}
    ):
        raise InputError(
            f"{where}: {min(strangers)} is no symbol of the system, nor of the motion: give a parameter of these"
        )

    def rates(*numbers: float) -> NDArray[np.complex128]:
        by_name = dict(zip(names, numbers, strict=True))

        def put(e: sp.Expr) -> sp.Expr:
            return put_in(e, {u: by_name[str(u)] for u in e.free_symbols if str(u) in by_name})

        point = {s: put(e) for s, e in places.items()}
        mine = {**values, **{name: x for name, x in by_name.items() if name in of_system}}
        if turn is None:
            return state_space(system, point, mine, where=where).rates
        T = put_in(put(turn), by_symbol(f"{where}: values", period_values, turn.free_symbols))
        monodromy = monodromy_matrix(system, point, mine, T)
        # For a multiplier below its error, the bound of its size.
        roots = np.where(np.isnan(monodromy.multipliers), monodromy.errors, monodromy.multipliers)
        return np.asarray(np.log(roots + (roots == 0)) / float(T))

    return rates


def _boundaries(
    rates_at: Callable[[float], NDArray[np.complex128]],
    grid: Array,
    rates_on_grid: Sequence[NDArray[np.complex128]],
    halvings: int,
) -> list[float]:
    """Find by bisection the numbers at which the motion becomes stable or unstable, at most one between two numbers of the
    grid."""

    def grows(rates: NDArray[np.complex128]) -> bool:
        return bool(rates.real.max() > _GROWS * np.abs(rates).max())

    boundaries = list[float]()
    for low, high, *ends in zip(grid.tolist(), grid[1:].tolist(), rates_on_grid, rates_on_grid[1:], strict=False):
        grows_below, grows_above = map(grows, ends)
        if grows_below == grows_above:
            continue
        for _ in range(halvings):
            middle = (low + high) / 2
            low, high = (middle, high) if grows(rates_at(middle)) == grows_below else (low, middle)
        boundaries.append((low + high) / 2)
    return boundaries


def _followed(rates: Sequence[NDArray[np.complex128]]) -> NDArray[np.complex128]:
    """Order the rates at each number so that column by column they continue the rates at the number before, shape (m, n)."""
    from scipy.optimize import linear_sum_assignment

    rows = [rates[0]]
    for now in rates[1:]:
        _, order = linear_sum_assignment(np.abs(rows[-1][:, None] - now[None]))
        rows.append(now[order])
    return np.array(rows)
