"""Singular positions, measured: a mass matrix, or constraints, whose rank is smaller at a state."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.function_values import Array
from lagrotor.mechanics.running.programs import Generated, energy_program, function_program, mass_program, rows_program
from lagrotor.result_display import scientific

_SINGULAR = 1e-6  # least eigenvalue of the mass matrix over that at the start; least cosine of the constraints' normals
_UNBOUNDED = 1e8
_GROWN = 1e3  # acceleration over that at the start, below which a force is large and stiff, and has a bound
_TAKES_PART = 0.2  # component of a direction from which on a coordinate is named


def singular_position(
    system: Equations, values: Mapping[Any, Any], start: Array, sizes: Array
) -> Callable[[Array], str]:
    """Return a function that takes a state and returns a sentence about its singular position, or "" if it is regular. Each state
    is compared with the regular state `start`."""
    if not system.c.q:
        return lambda _: ""
    lengths = np.sqrt(np.abs(np.diag(mass_at(system, values, start))))
    scale = np.where(lengths > 0, lengths, 1.0)

    def words(state: Array) -> str:
        if not np.isfinite(state).all():
            return ""
        least, direction = _least(mass_at(system, values, state) / np.outer(scale, scale))
        first, _ = _least(mass_at(system, values, start) / np.outer(scale, scale))
        if first > 0 and least < _SINGULAR * first:
            moving = system.c.q if system.kinematics is None else system.speeds
            names = ", ".join(str(q) for q, share in zip(moving, direction, strict=True) if abs(share) > _TAKES_PART)
            return (
                f"the mass matrix has there {scientific(max(least, 0.0) / first, 1)} of its least eigenvalue at the start, along "
                f"{names}: a pole of these coordinates. Angles about three different axes, turned('xyz'), have none where those "
                "of 'zxz' and 'zyz' do, and the reverse; points x, y, z under a constraint have none at all"
            )
        if system.left and (cosine := float(independence(system, values, state[None])[0])) < _SINGULAR:
            return f"the constraints are dependent there: the least singular value of their normals is {scientific(cosine, 1)}"
        return unbounded_force(system, values, start, state, sizes)

    return words


def unbounded_force(system: Equations, values: Mapping[Any, Any], start: Array, state: Array, sizes: Array) -> str:
    """Return a sentence if a force grows without bound, for example at a collision, and "" if none does. Its acceleration has
    grown a thousandfold since the start, and would change a velocity by its size in 10⁻⁸ of the typical time."""
    n, m, program = len(system.c.q), len(system.speeds), function_program(system, *system.c.a)
    if not n:
        return ""
    first, change = (_at(program, system, values, y)[:, 0] for y in (start, state))
    top = np.max(sizes[n : n + m])
    i, typical = int(np.argmax(np.abs(change))), float(top / np.max(sizes[:n]))
    least = max(_UNBOUNDED * typical * top, _GROWN * np.abs(first).max())
    if not least < abs(change[i]) < np.inf:  # also where it is no number
        return ""
    return (
        f"the force grows without bound there: the acceleration of {system.c.q[i]} is {scientific(float(change[i]), 1)}"
    )


def mass_at(system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    """Return the mass matrix M of u' at a state, shape (m, m). For a tree of bodies it follows from the energy, which is
    quadratic in the velocities."""
    n, m = len(system.c.q), len(system.speeds)
    if not system.bodies:
        return _at(mass_program(system), system, values, state).reshape(m, m)
    units = np.eye(m)
    pairs = (units[:, None] + units[None]).reshape(-1, m)
    u = np.vstack([np.zeros(m), units, -units, pairs, -pairs])
    states = np.hstack([np.tile(state[:n], (len(u), 1)), u])
    E = energy_program(system).along(values)(states, np.full(len(u), _time(state, system)))[0]
    alone = (E[1 : m + 1] + E[m + 1 : 2 * m + 1]) / 2 - E[0]
    both = ((E[2 * m + 1 : 2 * m + 1 + m * m] + E[2 * m + 1 + m * m :]) / 2 - E[0]).reshape(m, m)
    return np.asarray(both - alone[:, None] - alone[None])


def rows_at(system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    """Return the coefficients of u', at a state, in the constraints that multipliers enforce, shape (k, m)."""
    rows = _at(rows_program(system), system, values, state) if system.left else np.zeros(0)
    return rows.reshape(len(system.left), len(system.speeds))


def _at(program: Generated, system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    return program.along(values)(state[None], np.array([_time(state, system)]))


def _time(state: Array, system: Equations) -> float:
    size = len(system.variables)
    return float(state[size]) if len(state) > size else 0.0


def _least(matrix: Array) -> tuple[float, Array]:
    if not np.isfinite(matrix).all():
        return 0.0, np.ones(len(matrix))
    values, vectors = np.linalg.eigh(matrix)
    return float(values[0]), vectors[:, 0]


def independence(system: Equations, values: Mapping[Any, Any], states: Array, sizes: Array | float = 1.0) -> Array:
    """Return the least singular value of the rows of G at each of the states (n, d), shape (n,). Each row is given in units of
    the sizes and scaled to length one. The value is zero if a row is zero or not finite."""
    times = np.array([_time(state, system) for state in states])
    G = rows_program(system).along(values)(states, times).T.reshape(len(states), len(system.left), -1) * sizes
    lengths, least = np.linalg.norm(G, axis=2, keepdims=True), np.zeros(len(states))
    whole = np.isfinite(G).all((1, 2)) & lengths.all((1, 2))
    least[whole] = np.linalg.svd(G[whole] / lengths[whole], compute_uv=False)[:, -1]
    return least
