"""Whether a position is singular, measured: a mass matrix, or constraints, that have lost a direction there."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.programs import Generated, energy_program, mass_program, rows_program
from lagrotor.shown import scientific

Array = NDArray[np.float64]
_SINGULAR = (
    1e-6  # least eigenvalue of the mass matrix over that at the start; of the cosines of the constraints' normals
)
_TAKES_PART = 0.2  # component of a direction from which on a coordinate is named


def singular_position(system: Equations, values: Mapping[Any, Any], start: Array) -> Callable[[Array], str]:
    """state → the words of the singular position that is measured there, none where it is regular; `start`: a regular state."""
    n = len(system.c.q)
    known = np.sqrt(np.abs(np.diag(mass_at(system, values, start))))
    scale = np.where(known > 0, known, 1.0)

    def words(state: Array) -> str:
        if not np.isfinite(state).all():
            return ""
        least, direction = _least(mass_at(system, values, state) / np.outer(scale, scale))
        first, _ = _least(mass_at(system, values, start) / np.outer(scale, scale))
        if first > 0 and least < _SINGULAR * first:
            names = ", ".join(str(q) for q, part in zip(system.c.q, direction, strict=True) if abs(part) > _TAKES_PART)
            return (
                f"the mass matrix has there {scientific(max(least, 0.0) / first, 1)} of its least eigenvalue at the start, along "
                f"{names}: a pole of these coordinates. Angles about three different axes, turned('xyz'), have none where those "
                "of 'zxz' and 'zyz' do, and the reverse; points x, y, z under a constraint have none at all"
            )
        if system.multipliers and (cosine := _dependence(system, values, state)) < _SINGULAR:
            return f"the constraints are dependent there: the least singular value of their normals is {scientific(cosine, 1)}"
        return ""

    return words if n else lambda state: ""


def mass_at(system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    """M at a state, (N, N); of a tree of bodies from the energy, which is quadratic in the velocities."""
    n, program = len(system.c.q), energy_program(system)
    if not system.bodies:
        return _at(mass_program(system), system, values, state).reshape(n, n)
    units = np.eye(n)
    pairs = (units[:, None] + units[None]).reshape(-1, n)
    v = np.vstack([np.zeros(n), units, -units, pairs, -pairs])
    states = np.hstack([np.tile(state[:n], (len(v), 1)), v])
    E = program.along(values)(states, np.full(len(v), _time(state, n)))[0]
    alone = (E[1 : n + 1] + E[n + 1 : 2 * n + 1]) / 2 - E[0]
    both = ((E[2 * n + 1 : 2 * n + 1 + n * n] + E[2 * n + 1 + n * n :]) / 2 - E[0]).reshape(n, n)
    return np.asarray(both - alone[:, None] - alone[None])


def rows_at(system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    """G at a state, (k, N)."""
    found = _at(rows_program(system), system, values, state) if system.multipliers else np.zeros(0)
    return found.reshape(system.rows.shape)


def _at(program: Generated, system: Equations, values: Mapping[Any, Any], state: Array) -> Array:
    return program.along(values)(state[None], np.array([_time(state, len(system.c.q))]))


def _time(state: Array, n: int) -> float:
    return float(state[2 * n]) if len(state) > 2 * n else 0.0


def _least(matrix: Array) -> tuple[float, Array]:
    if not np.isfinite(matrix).all():
        return 0.0, np.ones(len(matrix))
    values, vectors = np.linalg.eigh(matrix)
    return float(values[0]), vectors[:, 0]


def _dependence(system: Equations, values: Mapping[Any, Any], state: Array) -> float:
    """The least singular value of the rows of G, each of length one."""
    G = rows_at(system, values, state)
    lengths = np.linalg.norm(G, axis=1, keepdims=True)
    if not np.isfinite(G).all() or not lengths.all():
        return 0.0
    return float(np.linalg.svd(G / lengths, compute_uv=False)[-1])
