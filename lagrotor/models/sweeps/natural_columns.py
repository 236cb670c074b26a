"""Scenes with a bar and without a shock in natural units, as arrays for the minimal model."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.models.minimal import RATIOS, Kind, observe_states, rhs_on_arrays, start_states
from lagrotor.models.model import FARTHEST_ALONG, PACE, Conserved, Observed, conserved
from lagrotor.models.simulate import start_error
from lagrotor.models.sweeps.scene_columns import SceneColumns
from lagrotor.numerics.arrays import Array


@dataclass(frozen=True, eq=False)
class NaturalColumns:
    """The scenes of one chunk in the units of `model.NaturalUnits`.

    - `rate`: the unit of rate in rad/s, (n,).
    - `inertias`: a and b in units of inertia, (2, n, 1); `k` is ell/R, (n, 1), and `momenta` are those of the spins, (2, n, 1).
    - `axes` and `rates` are those of the start, (2, n, 3).
    """

    rate: Array
    inertias: Array
    k: Array
    momenta: Array
    axes: Array
    rates: Array

    @classmethod
    def of(cls, columns: SceneColumns) -> "NaturalColumns":
        """Return scenes with a bar in natural units, by the formulas of `model.natural_units` and `model.typical_rate`."""
        (M, R, I1, I3), (ell, m, K) = columns.rotor.T, columns.link.T
        J, v1, v2 = I1 + M * R**2 / 4, columns.rates[:, 0], columns.rates[:, 1]
        together, apart = J + m * R**2 / 2, J + 2 * K * (R / ell) ** 2
        inertia = np.minimum(together, apart)
        total, difference = (np.sqrt(((v1 + sign * v2) ** 2).sum(1)) for sign in (1, -1))
        fastest = np.hypot(np.sqrt(together / inertia) * total, np.sqrt(apart / inertia) * difference) / np.sqrt(2)
        fastest += np.abs(I3[:, None] * columns.spins).sum(1) / inertia
        rate = np.where(fastest > 0, fastest / PACE, 1.0)
        k, weight = ell / R, R * R / inertia
        whole, twist = m * weight / 4, K / inertia * (1 / k) ** 2
        inertias = np.array([I1 / inertia + M * weight / 4 + whole + twist, whole - twist])
        momenta = (I3 / inertia / rate * columns.spins.T)[..., None]
        swapped = (np.ascontiguousarray(array.swapaxes(0, 1)) for array in (columns.axes, columns.rates))
        axes, rates = swapped
        return cls(rate, inertias[..., None], k[:, None], momenta, axes, rates / rate[:, None])

    def take(self, rows: NDArray[np.intp] | slice) -> "NaturalColumns":
        """Return the scenes of some rows."""
        return NaturalColumns(
            self.rate[rows], self.inertias[:, rows], self.k[rows], self.momenta[:, rows], self.axes[:, rows],
            self.rates[:, rows],
        )  # fmt: skip

    @property
    def kinds(self) -> NDArray[np.intp]:
        """The kind of program of each scene as a number, (n,); `kind` returns the kind of a number."""
        ratio = 1 + (self.k > 1).astype(np.intp) - (self.k < 1)
        return np.asarray((len(RATIOS) * (self.inertias[1] != 0) + ratio)[:, 0])

    def parameters(self, kind: Kind) -> Array:
        """Return the values of the parameters of the program, (p, n)."""
        massive, ratio, _ = kind
        a, b = self.inertias
        rows = [a, *([b] if massive else []), *([] if ratio == "equal" else [self.k]), *self.momenta]
        return np.stack(rows)[..., 0]

    def starts(self, kind: Kind) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Return the states (n, 6) at the start, their errors (n,) in units of rounding, and False for the scenes (n,) at whose
        start the model is badly conditioned."""
        ratio = kind[1]
        states = start_states(ratio, self.k[:, 0], self.axes.swapaxes(0, 1), self.rates.swapaxes(0, 1))
        errors = start_error(self.axes, self.rates, lambda y: observe_states(ratio, self.k, y), states)
        changes = np.array(rhs_on_arrays(*kind)(*self.parameters(kind))(*states.T))
        along, whole = FARTHEST_ALONG
        conditioned = (np.abs(self.axes[..., 0]) < along / whole).all(0)
        return states, errors, conditioned & np.isfinite(changes).all(0)

    def observed(self, kind: Kind, states: Array) -> Observed:
        """Return axes and rates (2, n, m, 3) and momenta (2, n, 1) of states (n, m, 6)."""
        axes, rates = observe_states(kind[1], self.k, states)
        return Observed(axes, rates, self.momenta)

    def conserved(self, observed: Observed) -> Conserved:
        a, b = self.inertias
        return conserved((a, b), self.k, observed)


def kind_of_number(number: int) -> Kind:
    """Return the kind of program for a number of `NaturalColumns.kinds`."""
    massive, ratio = divmod(number, len(RATIOS))
    return bool(massive), RATIOS[ratio], 0
