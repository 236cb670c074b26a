"""Others' compiled solvers: beside the fast extra they show what its error estimate costs.

CyRK and numba run the minimal right-hand side, its generated Python compiled by numba. heyoka alone and diffrax run the full
equations. The time that compiling takes counts as set-up.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from benchmarks.full_equations import diffrax_alone, heyoka_alone
from lagrotor.benchmark.runner import Method, Runner, tips
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


def _stages(rhs: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The weighted sum of the rows of an array (n, 6), and the function that fills rows of it with stages, both compiled."""
    import numba
    from scipy.integrate import DOP853

    A = np.zeros((16, 16))  # row 12 ends the step, and the last three are for dense output
    A[:12, :12], A[12, :12], A[13:] = DOP853.A[:12, :12], DOP853.B, DOP853.A_EXTRA

    @numba.njit
    def weighted(K, weights):  # type: ignore[no-untyped-def]
        total = np.zeros(6)
        for i in range(len(weights)):  # a loop, since a matrix product of this size is slower
            if weights[i] != 0:
                for j in range(6):
                    total[j] += weights[i] * K[i, j]
        return total

    @numba.njit
    def fill(K, y, h, first, last):  # type: ignore[no-untyped-def]
        for i in range(first, last):
            place = y + h * weighted(K, A[i, :i])
            K[i] = np.array(rhs(place))
        return place

    return weighted, fill


def numba_dop853(scene: Scene, t_eval: Array) -> Runner:
    """DOP853 with scipy's coefficients and error norm, its loop compiled by numba. Local error: a tenth of tol."""
    import numba
    from scipy.integrate import DOP853

    rhs, start = _compiled(scene), minimal.MODEL.start(scene)
    weighted, fill = _stages(rhs)
    E3, E5, D = DOP853.E3, DOP853.E5, DOP853.D

    @numba.njit
    def read(K, y, end, h, x, states):  # type: ignore[no-untyped-def]
        F = np.empty((7, 6))
        F[0], F[1], F[2] = end - y, h * K[0] - (end - y), 2 * (end - y) - h * (K[12] + K[0])
        for i in range(4):
            F[3 + i] = h * weighted(K, D[i])
        for k in range(len(x)):
            value = np.zeros(6)
            for i in range(6, -1, -1):
                value = (value + F[i]) * (x[k] if i % 2 == 0 else 1 - x[k])
            states[k] = y + value

    @numba.njit
    def solve(y, times, tol):  # type: ignore[no-untyped-def]
        states, K = np.empty((len(times), 6)), np.empty((16, 6))
        first, t, end, used = 0, times[0], times[-1], 1
        K[0] = np.array(rhs(y))
        h, least = 0.5 * tol**0.125 / np.abs(K[0]).max(), 1e-14 * (end - t)
        while first < len(times) and h > least:
            after = min(t + h, end)
            h = after - t
            later, used = fill(K, y, h, 1, 13), used + 12
            scale = tol * (1 + np.maximum(np.abs(y), np.abs(later)))
            fifth, third = ((weighted(K, E5) / scale) ** 2).sum(), ((weighted(K, E3) / scale) ** 2).sum()
            size = h * fifth / np.sqrt((fifth + 0.01 * third) * 6) if fifth > 0 else 1e-10
            if size < 1:
                last = np.searchsorted(times, after, side="right")
                if last > first:
                    fill(K, y, h, 13, 16)
                    read(K, y, later, h, (times[first:last] - t) / h, states[first:last])
                    first, used = last, used + 3
                t, y, K[0] = after, later, K[12]
            h *= min(10.0, max(0.2, 0.9 * size**-0.125))
        return states[:first], used

    def run(tol: float) -> tuple[Array, int]:
        states, evaluations = solve(start, t_eval, tol / 10)
        return tips(scene, minimal.MODEL.observe(scene, states).axes), evaluations

    return run


_INSTALL = "--group compiled"
COMPILED: dict[str, Method] = {
    "minimal, CyRK": Method("compiled", cyrk, install=_INSTALL),
    "minimal, numba DOP853": Method("compiled", numba_dop853, install=_INSTALL),
    "heyoka alone": Method("compiled", heyoka_alone, install=_INSTALL),
    "diffrax": Method("compiled", diffrax_alone, install=_INSTALL),
}
