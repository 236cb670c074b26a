"""How the rates of small motion move as one letter is changed: the root locus, and where it becomes unstable."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import expression, put_in
from lagrotor.mechanics.glossary import latex
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.state_space import state_space
from lagrotor.numerics.arrays import check_times

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure

_GROWS = 1e-6  # of the largest rate: a real part that is above rounding, of double roots too
_DIGITS = 40  # halvings of the interval between two numbers


@dataclass(frozen=True, eq=False)
class RootLocus:
    """rates (m, n), 1/s, at the numbers (m,) of a letter; boundaries: its values at which the motion becomes stable or unstable,
    each alone between two of the numbers that were given, among which they are put. They are known to about a millionth:
    rates that coincide, as zero ones do, are not known better than to the root of rounding."""

    letter: sp.Symbol
    numbers: Array
    rates: NDArray[np.complex128]
    boundaries: tuple[float, ...]

    @property
    def growth(self) -> Array:
        """The largest real part, (m,), 1/s."""
        return np.asarray(self.rates.real.max(1))

    def plot(self) -> "RunFigure":
        """Real and imaginary parts over the letter, the boundaries as lines."""
        from lagrotor.drawing.run_figure import rates_figure

        return rates_figure(f"${latex(self.letter)}$", self.numbers, self.rates, self.boundaries)


def root_locus(
    system: Equations, at: Mapping[Any, Any], values: Values, letter: sp.Symbol | str, numbers: ArrayLike
) -> RootLocus:
    """The rates of small motion about `at`, whose coordinates and velocities may be expressions in the letter, at the increasing
    numbers of the letter.

    Raises InputError where the letter has a value already, and what `linearise` raises.
    """
    grid, name = check_times("root_locus", numbers), str(letter)
    if not isinstance(values, Mapping) or name in map(str, values):
        raise InputError(
            f"root_locus: values = {values!r} must be a dictionary without {name}, which takes the numbers"
        )
    if not isinstance(at, Mapping):
        raise InputError(f"root_locus: at = {at!r} must be {{coordinate: number or expression, …}}, a dictionary")
    places = {s: expression("root_locus: at", e) for s, e in at.items()}

    acting = (system.lagrangian, *system.constraints, *system.rolling, system.dissipation, *system.forces)
    own = {name} & {str(s) for e in acting for s in e.free_symbols}  # or it is a letter of the motion alone

    def rates_at(x: float) -> NDArray[np.complex128]:
        point = {s: put_in(e, {u: x for u in e.free_symbols if str(u) == name}) for s, e in places.items()}
        return state_space(system, point, {**values, **dict.fromkeys(own, x)}).rates

    def grows(rates: NDArray[np.complex128]) -> bool:
        return bool(rates.real.max() > _GROWS * np.abs(rates).max())

    rates = [rates_at(float(x)) for x in grid]
    boundaries = []
    for i in range(len(grid) - 1):
        low, high, before = float(grid[i]), float(grid[i + 1]), grows(rates[i])
        if before == grows(rates[i + 1]):
            continue
        for _ in range(_DIGITS):
            middle = (low + high) / 2
            low, high = (middle, high) if grows(rates_at(middle)) == before else (low, middle)
        boundaries.append((low + high) / 2)
    grid = np.sort(np.append(grid, boundaries))
    return RootLocus(sp.Symbol(name, real=True), grid, _followed([rates_at(float(x)) for x in grid]), tuple(boundaries))


def _followed(rates: Sequence[NDArray[np.complex128]]) -> NDArray[np.complex128]:
    """The rates in an order in which each is nearest to the one before it."""
    from scipy.optimize import linear_sum_assignment

    rows = [rates[0]]
    for now in rates[1:]:
        _, order = linear_sum_assignment(np.abs(rows[-1][:, None] - now[None]))
        rows.append(now[order])
    return np.array(rows)
