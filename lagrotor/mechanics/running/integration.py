"""States of a system at any times: its program compiled, integrated, and brought back onto its constraints."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrotor.errors import InputError
from lagrotor.mechanics.constraints import project_position, project_velocity
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.programs import (
    Generated,
    depends_on_time,
    motion_program,
    parameter_values,
    projection_program,
    start_program,
)
from lagrotor.numerics.heyoka_programs import taylor_rhs
from lagrotor.numerics.integrate import Engine, Problem, check_engine, integrate
from lagrotor.numerics.taylor import integrate_taylor

Array = NDArray[np.float64]
Values = Mapping[Any, Any]
Rhs = Callable[[float, Array], Any]
MOST = 10_000_000  # evaluations of one integration
_CHUNK = 32  # samples between two projections with the fast engine


def states(
    system: Equations, values: Values, start: Array, begin: float, times: Array, tol: float, engine: Engine
) -> Array:
    """States (n, 2 N) at `times`, from `start` at `begin`."""
    given = motion_program(system)
    parameters = parameter_values(given, values)
    clock = depends_on_time(system)
    if clock:
        start = np.append(start, begin)
        tol = max(tol / (1 + np.abs(times).max()), 1e-13)  # an error is measured against the largest component, t too
    project = projection(system, values) if system.multipliers else None
    wanted = times - begin
    if engine == "fast":
        found = _taylor(given, parameters, start, wanted, tol, project)
    else:
        problem = Problem(given.rhs(*parameters), start, MOST, project=project)
        found = integrate(problem, wanted, tol).states
    return found[:, : 2 * len(system.c.q)]


def rhs(system: Equations, values: Values, engine: Engine = "core") -> Rhs:
    """(t, y) → (v, a), for the state y = (q, v), an array (2 N,): for any solver, and the fastest that the engine has.

    engine: "core", generated Python, which gives a list, or "fast", compiled by heyoka, which gives an array.

    Raises InputError for a value that is missing, another engine, and without heyoka.
    """
    check_engine(engine)
    given = motion_program(system)
    parameters = parameter_values(given, values)
    fast = engine == "fast"
    function = taylor_rhs(given.program, len(given.states), parameters) if fast else given.rhs(*parameters)
    if not depends_on_time(system):
        return function
    return lambda t, y: function(t, np.append(y, t))[:-1]


def _taylor(given: Generated, parameters: Any, start: Array, wanted: Array, tol: float, project: Any) -> Array:
    """By heyoka; under constraints in pieces, each begun on the constraints."""
    pieces = [wanted] if project is None else np.array_split(wanted, max(1, len(wanted) // _CHUNK))
    found, begin = [], 0.0
    for piece in pieces:
        if piece[-1] == begin:
            states = np.repeat(start[None], len(piece), axis=0)
        else:
            states = integrate_taylor(lambda _: (given.program, parameters), start, None, piece - begin, tol).states
        if project is not None:
            states = project(states.T).T
        found.append(states)
        start, begin = states[-1], float(piece[-1])
    return np.concatenate(found)


def projection(system: Equations, values: Values) -> Any:
    given = projection_program(system)
    function, parameters = given.function, parameter_values(given, values)

    def project(y: Array) -> Array:
        with np.errstate(all="ignore"):
            for _ in range(2):
                y = np.array(np.broadcast_arrays(*function(*y, *parameters)), dtype=float)
        return y

    return project


def consistent(system: Equations, values: Values, q0: ArrayLike, v0: ArrayLike, t: float = 0.0) -> tuple[Array, Array]:
    """The state (q, v) on the constraints that is nearest to q0, v0 in the mass metric, at the time t.

    Raises ConstraintError when it is not reached, SingularError where the constraints are dependent.
    """
    n, h = len(system.c.q), len(system.constraints)
    q, v = vector("q0", q0, n), vector("v0", v0, n)
    given = start_program(system)
    rest = (*([t] if depends_on_time(system) else []), *parameter_values(given, values, "consistent"))
    ends = np.cumsum([n * n, h, n * len(system.multipliers)])

    def parts(at: ArrayLike, rates: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """M, g, G and G v + b."""
        with np.errstate(all="ignore"):
            found = np.array(given.function(*np.concatenate([at, rates, rest])), float)
        M, g, G, off = np.split(found, ends)
        return M.reshape(n, n), g, G.reshape(-1, n), off

    if h:
        placed = project_position(lambda at: parts(at, v)[1], lambda at: parts(at, v)[2][:h], q, parts(q, v)[0])
        q = np.asarray(placed, float)
    mass, _, slope, wanted = parts(q, np.zeros(n))  # wanted: b, so that G v + b = 0
    particular = -np.linalg.pinv(slope) @ wanted
    return q, np.asarray(particular + project_velocity(slope, v - particular, mass), float)


def vector(name: str, given: ArrayLike, n: int) -> Array:
    try:
        found = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"simulate: {name} = {given!r} must be {n} numbers") from None
    if found.shape != (n,) or not np.isfinite(found).all():
        raise InputError(f"simulate: {name} = {given!r} must be {n} finite numbers, one for each coordinate")
    return found


def increasing(given: ArrayLike) -> Array:
    try:
        found = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"simulate: t = {given!r} must be an array of times in s") from None
    if found.ndim != 1 or not len(found) or not np.isfinite(found).all() or (np.diff(found) <= 0).any():
        raise InputError(
            f"simulate: t = {_short(given)} must be an increasing array of finite times, t[0] the time of q0 and v0: "
            "np.linspace(0, 10, 101)"
        )
    return found


def _short(given: ArrayLike) -> str:
    text = repr(given)
    return text if len(text) < 60 else f"{text[:57]}…"
