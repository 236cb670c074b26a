"""scipy's solvers by name, for runs whose solver is what is looked at, and as engines on the minimal right-hand side."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.runner import Method, Prepare, Run, tips
from lagrotor.errors import IntegrationError
from lagrotor.models import minimal
from lagrotor.models.integrated import problem_of
from lagrotor.numerics.adams import adams
from lagrotor.numerics.integrate import Rate
from lagrotor.numerics.integrators import Engine, StopError, Stretch, dop853
from lagrotor.numerics.integrators import Run as States
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
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
    solver: str, rate: Rate, start: Array, times: Array, tol: float, longest: float = np.inf
) -> tuple[Array, int]:
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
    limit = 0.0 if np.isinf(longest) else longest
    going = ode(counted).set_integrator(
        name, rtol=max(tol, 3e-14), atol=tol, nsteps=2_000_000_000, max_step=limit, **settings
    )
    going.set_initial_value(start, times[0])
    states = [start]
    for t in times[1:]:
        states.append(going.integrate(t).copy())
        if not going.successful():
            raise IntegrationError(f"run_by: {solver} stopped before t = {t:.6g} s: take a larger tol")
    return np.array(states), spent


def ode_engine(solver: str) -> Engine:
    """One of SOLVERS as an engine. It is called for every output time: what has no memory begins anew."""

    def run(stretch: Stretch, error: float) -> States:
        times = np.union1d([stretch.left], stretch.asked)
        states, spent = run_by(solver, stretch.rate, stretch.start, times, error, stretch.longest)
        return States(states[-len(stretch.asked) :], states[-1], spent)

    return run


def ivp_engine(method: str) -> Engine:
    """A method of `solve_ivp` as an engine: one call over the stretch. What a Jacobian takes is counted too."""

    def run(stretch: Stretch, error: float) -> States:
        from scipy.integrate import solve_ivp

        spent = 0

        def counted(s: float, y: Array) -> list[float]:
            nonlocal spent
            spent += 1
            if spent > stretch.allowance:
                raise StopError(s, f"{spent - 1} evaluations spent by s = {s:.3g} s")
            return stretch.rate(s, y)

        found = solve_ivp(
            counted, (stretch.left, stretch.right), stretch.start, method=method, t_eval=stretch.asked,
            rtol=max(error, 2.3e-14), atol=error, max_step=stretch.longest,
        )  # fmt: skip
        if not found.success:
            raise StopError(stretch.right, found.message)
        if not np.isfinite(found.y).all():
            raise StopError(stretch.right, "a value is not finite")
        return States(found.y.T, found.y[:, -1], spent)

    return run


def on_minimal(engine: Engine, sees_shock: bool = True) -> Prepare:
    """The minimal right-hand side, pulse included, by an engine that is called once over the whole run.

    sees_shock: no step is longer than the pulse is wide. Without it this is the trap of a plain call.
    """

    def prepare(scene: Scene, times: Array) -> Run:
        end = float(times[-1])
        problem = problem_of(minimal.MODEL, scene, end)
        longest = problem.width if problem.driven and sees_shock else np.inf
        stretch = Stretch(
            rate=problem.driven or problem.free,
            start=problem.start,
            left=-problem.at,
            right=end - problem.at,
            asked=times - problem.at,
            longest=longest,
            allowance=5 * problem.allowance,
        )

        def run(tol: float) -> tuple[Array, int]:
            found = engine(stretch, tol)
            return tips(scene, minimal.MODEL.observe(scene, found.states).axes), found.evaluations

        return run

    return prepare


ENGINES: dict[str, Method] = {
    "minimal, DOP853": Method("core", on_minimal(dop853)),
    "minimal, Adams": Method("core", on_minimal(adams)),
    **{f"solve_ivp, {name}": Method("scipy", on_minimal(ivp_engine(name))) for name in IVP},
    **{f"ode, {name}": Method("scipy", on_minimal(ode_engine(name))) for name in SOLVERS},
}
# What a plain call makes of a shock that comes after a rest: nothing, or what its step happens to meet.
TRAPS: dict[str, Method] = {
    f"solve_ivp, {name}, one call": Method("trap", on_minimal(ivp_engine(name), sees_shock=False))
    for name in ("RK23", *IVP, "DOP853")
}
