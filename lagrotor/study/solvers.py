"""scipy's solvers by name, their loops compiled, for runs whose solver is what is looked at."""

import numpy as np
from numpy.typing import NDArray

from ..errors import IntegrationError
from ..numerics.solve import Rate

Array = NDArray[np.float64]
# Name → scipy's integrator and its settings.
SOLVERS = {
    "DOP853": ("dop853", {}),
    "Dormand–Prince 5": ("dopri5", {}),
    "Adams (VODE)": ("vode", {"method": "adams"}),
    "LSODA": ("lsoda", {}),
}


def run_by(solver: str, rate: Rate, start: Array, times: Array, tol: float) -> tuple[Array, int]:
    """States (n, d) at increasing times (n,) from `start` (d,) at times[0], by one of SOLVERS, and evaluations.

    tol: relative and absolute local error as the solver has it. Raises IntegrationError when it stops.
    """
    from scipy.integrate import ode

    spent = 0

    def counted(t: float, y: Array) -> list[float]:
        nonlocal spent
        spent += 1
        return rate(t, y)

    name, settings = SOLVERS[solver]
    going = ode(counted).set_integrator(name, rtol=max(tol, 3e-14), atol=tol, nsteps=2_000_000_000, **settings)
    going.set_initial_value(start, times[0])
    states = [start]
    for t in times[1:]:
        states.append(going.integrate(t).copy())
        if not going.successful():
            raise IntegrationError(f"run_by: {solver} stopped before t = {t:.6g} s: take a larger tol")
    return np.array(states), spent
