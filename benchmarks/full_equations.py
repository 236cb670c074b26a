"""The pair as a user of heyoka or diffrax writes it: two unit vectors and their rates, the bar's force by one multiplier.

With J = I1 + M R²/4, G_i = I3 ω_i, and the bar d = ell e_x + R (r_2 − r_1), which pulls the tips by λ d and −λ d:

    r_i'' = −|r_i'|² r_i + (G_i/J) r_i × r_i' ± λ (R/J) (d − (r_i·d) r_i),   d·d'' + |d'|² = 0 gives λ.

The bar has no mass, and no pulse acts. What is compiled for one tolerance is kept for the next run.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.benchmark.runner import Runner, tips
from lagrotor.errors import InputError, IntegrationError
from lagrotor.pair.scene import Scene

Array = NDArray[np.float64]
Constants = tuple[float, float, float, float, float]  # J, R, ell, G_1, G_2
_MOST_STEPS = 100_000


def constants(scene: Scene) -> Constants:
    """J (kg m²), R and ell (m), G_1 and G_2 (kg m²/s). Raises InputError for a scene that the equations do not describe."""
    rotor, link = scene.rotor, scene.link
    if link is None or link.mass or link.inertia or scene.shock:
        raise InputError("takes a massless bar and no shock")
    return (rotor.I1 + rotor.mass * rotor.length**2 / 4, rotor.length, link.length, *scene.momenta)


def start(scene: Scene) -> Array:
    """The state (12,): r_1, r_2 and their rates."""
    return np.ravel([*scene.axes, *scene.rates])


def rates(y: Sequence[Any], of: Constants) -> list[Any]:
    """The derivative of the state (12 scalars of any library)."""
    J, R, ell, *G = of
    r, v = (y[0:3], y[3:6]), (y[6:9], y[9:12])
    free = [
        [G[i] / J * w - _dot(v[i], v[i]) * x for w, x in zip(_cross(r[i], v[i]), r[i], strict=True)] for i in (0, 1)
    ]
    d = [R * (b - a) + (ell if k == 0 else 0.0) for k, (a, b) in enumerate(zip(*r, strict=True))]
    moving = [R * (b - a) for a, b in zip(*v, strict=True)]
    along = [_dot(x, d) for x in r]
    pull = _dot(moving, moving) + R * _dot(d, [b - a for a, b in zip(*free, strict=True)])
    force = pull / (R * (2.0 * _dot(d, d) - along[0] * along[0] - along[1] * along[1]))  # λ R / J
    turned = [
        [f + sign * force * (x - along[i] * a) for f, x, a in zip(free[i], d, r[i], strict=True)]
        for i, sign in ((0, 1.0), (1, -1.0))
    ]
    return [*v[0], *v[1], *turned[0], *turned[1]]


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def axes_of(states: Array) -> Array:
    """Unit axes (2, n, 3) of states (n, 12)."""
    return states[:, :6].reshape(-1, 2, 3).swapaxes(0, 1)


@cache
def _taylor(of: Constants, tol: float, lanes: int) -> Any:
    """heyoka's integrator with its default settings, for one trajectory or for `lanes` at once."""
    import heyoka

    names = heyoka.make_vars(*(f"y{i}" for i in range(12)))
    equations = list(zip(names, rates(names, of), strict=True))
    if lanes == 1:
        return heyoka.taylor_adaptive(equations, [0.0] * 12, tol=tol)
    return heyoka.taylor_adaptive_batch(equations, np.zeros((12, lanes)), tol=tol)


def heyoka_alone(scene: Scene, t_eval: Array) -> Runner:
    """heyoka: taylor_adaptive, read at the times by its dense output."""
    of, begin = constants(scene), start(scene)

    def run(tol: float) -> tuple[Array, int]:
        solver = _taylor(of, tol, 1)
        solver.time, solver.state[:] = 0.0, begin
        outcome, *_, steps, _, states = solver.propagate_grid(t_eval, max_steps=_MOST_STEPS)
        if "time_limit" not in str(outcome):
            raise IntegrationError(f"heyoka stopped: {outcome}")
        return tips(scene, axes_of(states)), steps * solver.order

    return run


def heyoka_lanes(scenes: Sequence[Scene], t_end: float, tol: float, lanes: int = 8) -> Array:
    """The states (n, 12) at t_end (s) of scenes with the same constants, by taylor_adaptive_batch."""
    solver, begins = _taylor(constants(scenes[0]), tol, lanes), np.array([start(s) for s in scenes])
    ends = np.empty_like(begins)
    for first in range(0, len(begins), lanes):
        batch = np.minimum(np.arange(first, first + lanes), len(begins) - 1)  # copies fill the last lanes
        solver.set_time(0.0)
        solver.state[:] = begins[batch].T
        solver.propagate_until(t_end, max_steps=_MOST_STEPS)
        if not all("time_limit" in str(outcome) for outcome, *_ in solver.propagate_res):
            raise IntegrationError(f"heyoka stopped: {solver.propagate_res}")
        ends[batch] = solver.state.T
    return ends


@cache
def _diffrax(of: Constants, t_end: float, n: int, together: bool) -> Callable[..., Any]:
    """diffrax's Dopri8 with a PID controller, compiled: (state, times (n,), tolerance) → states (n, 12), evaluations."""
    import diffrax
    import jax

    jax.config.update("jax_enable_x64", True)
    from jax import numpy as jnp

    term = diffrax.ODETerm(lambda t, y, of: jnp.stack(rates(y, of)))

    def solve(y: Any, times: Any, tol: Any) -> tuple[Any, Any]:
        solution = diffrax.diffeqsolve(
            term, diffrax.Dopri8(), 0.0, t_end, None, y, of, saveat=diffrax.SaveAt(ts=times), max_steps=_MOST_STEPS,
            stepsize_controller=diffrax.PIDController(rtol=tol, atol=tol), throw=False,
        )  # fmt: skip
        return solution.ys, solution.stats["num_steps"] * 13

    return jax.jit(jax.vmap(solve, (0, None, None)) if together else solve)


def _solved(states: Any) -> Array:
    """States of jax as an array. Raises IntegrationError where diffrax did not reach a time."""
    states = np.asarray(states)
    if not np.isfinite(states).all():
        raise IntegrationError(f"diffrax did not reach the end in {_MOST_STEPS} steps")
    return states


def diffrax_alone(scene: Scene, t_eval: Array) -> Runner:
    """diffrax (jax in double precision): Dopri8, the relative and the absolute local error are the setting."""
    solve, begin = _diffrax(constants(scene), float(t_eval[-1]), len(t_eval), False), start(scene)

    def run(tol: float) -> tuple[Array, int]:
        states, evaluations = solve(begin, t_eval, tol)
        return tips(scene, axes_of(_solved(states))), int(evaluations)

    return run


def diffrax_vmap(scenes: Sequence[Scene], t_end: float, tol: float) -> Array:
    """The states (n, 12) at t_end (s) of scenes with the same constants, by jax.vmap of diffrax's solve."""
    solve = _diffrax(constants(scenes[0]), t_end, 1, True)
    states, _ = solve(np.array([start(s) for s in scenes]), np.array([t_end]), tol)
    return _solved(states)[:, 0]
