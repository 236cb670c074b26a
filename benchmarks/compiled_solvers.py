"""Solvers that were benchmarked for the fast extra and not chosen: others' solvers on a compiled right-hand side.

Both run the minimal right-hand side, its generated Python compiled by numba; the time that takes counts as set-up.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.benchmark.runner import LSODA_LEAST, Method, Runner, tips
from lagrotor.errors import InputError, IntegrationError
from lagrotor.models import minimal
from lagrotor.numerics.codegen import reduce_common
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
_A_STEP = 12  # evaluations of the right-hand side in a step of DOP853, those for dense output left out


def _compiled(scene: Scene) -> Callable[..., Any]:
    """y ↦ y' as a tuple of six, compiled by numba, for a scene without shock."""
    import numba

    if scene.shock is not None:
        raise InputError("takes no shock")
    program, parameters = minimal.MODEL.program(scene, False)
    stages, outputs = reduce_common(program)
    function = numba.njit(
        sp.lambdify(program.arguments, tuple(outputs), "math", cse=lambda _: (stages, tuple(outputs)))
    )

    @numba.njit
    def rhs(y):  # type: ignore[no-untyped-def]
        return function(y[0], y[1], y[2], y[3], y[4], y[5], *parameters)

    return rhs


def cyrk(scene: Scene, t_eval: Array) -> Runner:
    """CyRK: DOP853 in C++, called with the address of a compiled right-hand side. Local error: a tenth of tol."""
    from CyRK import nb_diffeq_addr, nbsolve2_ivp

    rhs, start = _compiled(scene), minimal.MODEL.start(scene)

    def fill(out, t, y, p):  # type: ignore[no-untyped-def]
        out[0], out[1], out[2], out[3], out[4], out[5] = rhs(y)

    address = nb_diffeq_addr(fill)

    def run(tol: float) -> tuple[Array, int]:
        solution = nbsolve2_ivp(
            address, (0.0, float(t_eval[-1])), start, "DOP853", t_eval=t_eval, rtol=tol / 10, atol=tol / 10
        )
        try:
            if not solution.success:
                raise IntegrationError(f"CyRK stopped with status {solution.status}")
            states, steps = solution.y.T.copy(), int(solution.steps_taken)
        finally:
            solution.free()
        return tips(scene, minimal.MODEL.observe(scene, states).axes), _A_STEP * steps

    return run


def numba_odeint(scene: Scene, t_eval: Array) -> Runner:
    """numba's compiled right-hand side in scipy's odeint. Local error: a hundredth of tol, as LSODA exceeds its own."""
    import numba
    from scipy.integrate import odeint

    rhs, start = _compiled(scene), minimal.MODEL.start(scene)

    @numba.njit
    def array_rhs(t, y):  # type: ignore[no-untyped-def]
        return np.array(rhs(y))

    def run(tol: float) -> tuple[Array, int]:
        error = max(tol / 100, LSODA_LEAST.value)
        states, log = odeint(array_rhs, start, t_eval, tfirst=True, rtol=error, atol=error, full_output=True)
        if log["message"] != "Integration successful.":
            raise IntegrationError(log["message"])
        return tips(scene, minimal.MODEL.observe(scene, states).axes), int(log["nfe"][-1])

    return run


CANDIDATES: dict[str, Method] = {
    "minimal, CyRK": Method("candidate", cyrk, install="--group candidates"),
    "minimal, numba": Method("candidate", numba_odeint, install="--group candidates"),
}
