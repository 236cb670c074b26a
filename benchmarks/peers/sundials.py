"""SUNDIALS called from Python: its CVODE on our own minimal right-hand side, by CasADi and by scikit-sundae."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.runner import Method, Prepare, Runner, tips
from lagrotor.models import minimal
from lagrotor.numerics.codegen import reduce_common
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]


def _casadi(multistep: str) -> Prepare:
    """CasADi: CVODES on our own minimal right-hand side in its expressions, an integrator built once a tolerance."""

    def prepare(scene: Scene, t_eval: Array) -> Runner:
        import casadi
        import sympy as sp

        program, parameters = minimal.MODEL.program(scene, False)
        stages, outputs = reduce_common(program)
        function = sp.lambdify(program.arguments, outputs, modules=[casadi], cse=lambda _: (stages, outputs))
        y = casadi.SX.sym("y", 6)
        ode = casadi.vertcat(*function(*casadi.vertsplit(y), *parameters))
        start = minimal.MODEL.start(scene)

        @cache
        def built(tol: float) -> Any:
            options: dict[str, Any] = {"reltol": tol, "abstol": tol, "max_num_steps": 1_000_000}
            options["linear_multistep_method"] = multistep
            return casadi.integrator("run", "cvodes", {"x": y, "ode": ode}, 0.0, list(t_eval), options)

        def run(tol: float) -> tuple[Array, int]:
            states = np.array(built(tol)(x0=start)["xf"]).T
            nfev = int(built(tol).stats().get("nfevals", 0))
            return tips(scene, minimal.MODEL.observe(scene, states).axes), nfev

        return run

    return prepare


def sundae(scene: Scene, t_eval: Array) -> Runner:
    """scikit-sundae: CVODE's Adams methods on our own minimal right-hand side in Python."""
    from sksundae.cvode import CVODE

    rhs, start = minimal.MODEL.rate(scene, False), minimal.MODEL.start(scene)

    def fill(t: float, y: Array, out: Array) -> None:
        out[:] = rhs(t, y)

    def run(tol: float) -> tuple[Array, int]:
        solution = CVODE(fill, rtol=tol, atol=tol, method="Adams", max_num_steps=1_000_000).solve(t_eval, start)
        return tips(scene, minimal.MODEL.observe(scene, solution.y).axes), int(solution.nfev)

    return run


SUNDIALS: dict[str, Method] = {
    "CasADi CVODES": Method("peer", _casadi("bdf"), install="--group peers"),  # its default
    "CasADi CVODES, Adams": Method("peer", _casadi("adams"), install="--group peers"),
    "scikit-sundae": Method("peer", sundae, install="--group peers"),
}
