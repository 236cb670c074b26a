"""scipy's solvers by name, for studies of a single solver, and as benchmarked methods on the minimal right-hand side."""

from collections.abc import Callable
from typing import Any

import numpy as np

from lagrotor.benchmark.runner import LSODA_LEAST, Method, Prepare, Runner, tips
from lagrotor.errors import IntegrationError
from lagrotor.models import minimal
from lagrotor.models.model import problem_of
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.segment import RightHandSide, Segment, StopError, Stretch
from lagrotor.numerics.solvers import adams, dop853
from lagrotor.pair.scene import Scene

Solver = Callable[[Segment, float], Stretch]  # a segment and a local error
# Name → scipy's integrator with a compiled loop, and its settings.
SOLVERS: dict[str, tuple[str, dict[str, Any]]] = {
    "DOP853": ("dop853", {}),
    "Dormand–Prince 5": ("dopri5", {}),
    "Adams (VODE)": ("vode", {"method": "adams"}),
    "LSODA": ("lsoda", {}),
}
# solve_ivp's methods, whose loop is Python. Its DOP853 is the engine of that name; RK23 is RK45 with fewer digits.
IVP = ("RK45", "Radau", "BDF", "LSODA")


def run_by(
    solver: str, rhs: RightHandSide, start: Array, t_eval: Array, tol: float, longest: float = np.inf
) -> tuple[Array, int]:
    """Integrate by one of SOLVERS; return the states (n, d) at increasing times t_eval (n,) in s, and the number of evaluations.

    The relative and the absolute local error are `tol`. Raises IntegrationError if the solver stops.
    """
    from scipy.integrate import ode

    nfev = 0

    def counted(t: float, y: Array) -> list[float]:
        nonlocal nfev
        nfev += 1
        return rhs(t, y)

    name, settings = SOLVERS[solver]
    limit = 0.0 if np.isinf(longest) else longest
    settings = settings | {"rtol": max(tol, LSODA_LEAST.value), "atol": tol}
    going = ode(counted).set_integrator(name, nsteps=2_000_000_000, max_step=limit, **settings)
    going.set_initial_value(start, t_eval[0])
    states = [start]
    for t in t_eval[1:]:
        states.append(going.integrate(t).copy())
        if not going.successful():
            raise IntegrationError(f"run_by: {solver} stopped before t = {t:.6g} s: take a larger tol")
    return np.array(states), nfev


def ode_engine(solver: str) -> Solver:
    """Return one of SOLVERS as a function that solves a segment. The solver is called for every output time, so that a one-step
    method starts anew each time."""

    def run(segment: Segment, error: float) -> Stretch:
        t_eval = np.union1d([segment.begin], segment.t_eval)
        states, nfev = run_by(solver, segment.rhs, segment.start, t_eval, error, segment.longest)
        return Stretch(states[-len(segment.t_eval) :], states[-1], nfev)

    return run


def ivp_engine(method: str) -> Solver:
    """Return a method of `solve_ivp` as a function that solves a segment in one call. The evaluations for a Jacobian are counted
    too."""

    def run(segment: Segment, error: float) -> Stretch:
        from scipy.integrate import solve_ivp

        nfev = 0

        def counted(s: float, y: Array) -> list[float]:
            nonlocal nfev
            nfev += 1
            if nfev > segment.budget:
                raise StopError(s, f"{nfev - 1} evaluations by s = {s:.3g} s")
            return segment.rhs(s, y)

        solution = solve_ivp(
            counted, (segment.begin, segment.until), segment.start, method=method, t_eval=segment.t_eval,
            rtol=max(error, 2.3e-14), atol=error, max_step=segment.longest,
        )  # fmt: skip
        if not solution.success:
            raise StopError(segment.until, solution.message)
        if not np.isfinite(solution.y).all():
            raise StopError(segment.until, "a value is not finite")
        return Stretch(solution.y.T, solution.y[:, -1], nfev)

    return run


def on_minimal(engine: Solver, sees_shock: bool = True) -> Prepare:
    """Return the benchmark of a solver on the minimal right-hand side with the pulse, in one call over the whole run.

    If `sees_shock` is true, the width of the pulse limits the steps; otherwise the solver may step over the pulse.
    """

    def prepare(scene: Scene, t_eval: Array) -> Runner:
        end = float(t_eval[-1])
        problem = problem_of(minimal.MODEL, scene)
        longest = scene.shock.width if scene.shock and sees_shock else np.inf
        segment = Segment(
            rhs=problem.driven or problem.free,
            start=problem.start,
            begin=-problem.at,
            until=end - problem.at,
            t_eval=t_eval - problem.at,
            longest=longest,
            budget=100_000 + 1_250 * problem.typical_rate * end,
        )

        def run(tol: float) -> tuple[Array, int]:
            stretch = engine(segment, tol)
            return tips(scene, minimal.MODEL.observe(scene, stretch.states).axes), stretch.evaluations

        return run

    return prepare


ENGINES: dict[str, Method] = {
    "minimal, DOP853": Method("core", on_minimal(dop853)),
    "minimal, Adams": Method("core", on_minimal(adams)),
    **{f"solve_ivp, {name}": Method("scipy", on_minimal(ivp_engine(name))) for name in IVP},
    **{f"ode, {name}": Method("scipy", on_minimal(ode_engine(name))) for name in SOLVERS},
}
# Plain calls can step over a shock that follows a state of rest.
_ONE_CALL = {name: on_minimal(ivp_engine(name), sees_shock=False) for name in ("RK23", *IVP, "DOP853")}
TRAPS: dict[str, Method] = {f"solve_ivp, {name}, one call": Method("trap", run) for name, run in _ONE_CALL.items()}
