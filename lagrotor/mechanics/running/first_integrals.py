"""What a motion of a system conserves, watched while it is run: Jacobi's integral, the momenta of cyclic coordinates.

A run that does not keep them within what its error estimate allows is not the system's motion, whatever the solver says.
Constraints are kept by projection.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import sympy as sp

from lagrotor.algebra import decide_zero, derivative
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import longer, put_in
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.programs import Generated, depends_on_time, energy_program, function_program
from lagrotor.mechanics.symmetry import cyclic_coordinates

_WRITTEN = 600  # operations of a Lagrangian up to which its cyclic coordinates are sought
_STEP = 1e-5  # of a size, by which a component is varied for the slope of an integral


@lru_cache(maxsize=64)
def integrals(system: Equations) -> tuple[Generated, ...]:
    """The programs of what every motion of the system conserves, as far as that is seen at once."""
    written = isinstance(system.lagrangian, sp.Expr)
    kept = []
    if not (depends_on_time(system) or system.forces or system.dissipation != 0):
        at_rest = dict.fromkeys(system.c.v, sp.S.Zero)
        if all(decide_zero(put_in(e, at_rest)).answer == "zero" for e in system.rolling):
            kept.append(energy_program(system))
    if written and not longer(system.L, _WRITTEN):
        for q in cyclic_coordinates(system):
            kept.append(function_program(system, derivative(system.L, system.c.v[system.c.q.index(q)])))
    return tuple(kept)


def defect_of(system: Equations, values: Values, sizes: Array) -> Callable[[Array, Array], Array] | None:
    """(times (n,), states (n, d)) → the errors, relative to the sizes, that would explain how far the integrals are off."""
    conserved = [program.along(values) for program in integrals(system)]
    n = len(system.c.q) + len(system.speeds)

    def defect(times: Array, states: Array) -> Array:
        errors = []
        for integral in conserved:
            y = states[:, :n]
            slope = np.zeros(len(times))
            for step in np.diag(_STEP * sizes):
                with np.errstate(all="ignore"):
                    slope += np.abs(integral(y + step, times) - integral(y - step, times))[0] / (2 * _STEP)
            slope = np.nan_to_num(slope, posinf=0.0)  # where a step leaves the integral's domain
            known = integral(y, times)[0]
            rounding = 1e-15 * np.abs(known).max()
            off = np.sign(known - known[0]) * np.maximum(np.abs(known - known[0]) - rounding, 0.0)
            errors.append(off / np.maximum(slope, 1e-3 * slope.max() + 1e-300))
        return np.concatenate(errors)

    return defect if conserved else None
