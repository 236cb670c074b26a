"""The initial state of a run: checks of values, positions and velocities, and the nearest state on the constraints.

Each value must belong to a symbol of the system and have the sign with which the symbol was declared. Bodies must have possible
masses, and friction must dissipate energy. The mass matrix and the constraints must determine the accelerations.
"""

from collections.abc import Iterable, Mapping
from typing import Any
from warnings import warn

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError, InputError, LagrotorWarning, SingularError, near
from lagrotor.mechanics.bodies.rigid_bodies import check_body
from lagrotor.mechanics.constraints import project_position, project_velocity
from lagrotor.mechanics.equations import Equations, check_friction
from lagrotor.mechanics.expressions import by_symbol, in_order, put_in
from lagrotor.mechanics.lagrangian import t as time
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.function_values import FunctionValue
from lagrotor.mechanics.running.programs import (
    function_program,
    parameter_values,
    start_program,
    tree_motion,
    velocities_along,
)
from lagrotor.mechanics.running.redundant_constraints import without_redundant
from lagrotor.mechanics.running.singular_positions import mass_at, rows_at
from lagrotor.mechanics.steady_motions import no_turn
from lagrotor.numerics.arrays import finite_array, real_array

_POLE = 1e-13  # a factor of det [A; G] counts as zero below this number
_RANK = 1e-11  # eigenvalue over the largest, below which a direction has no mass
_OFF = 1e-7  # distance from the constraints over 1 + the largest number of a start
_SMALL = 1e-5  # distance from the constraints over the size of a small component
_SLOW = 1e-3  # least size of a position over the distance that the velocities cover
_LEAST = 1e-8  # least size of a position, which may be rounding of parameters of size one
_LEAST_NORM = 1e-3  # least norm of a quaternion that can be scaled to norm 1


def check_values(where: str, system: Equations, values: Values, others: Iterable[sp.Expr] = ()) -> None:
    """Raise InputError for an unknown name, a value of the wrong sign, or an impossible body or friction. A key that is a symbol
    of another system is ignored, so that several systems can share one dictionary."""
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be {{symbol: number, …}}, a dictionary")
    moving = {*system.c.v, *system.c.a, *system.variables, time}
    acting = (*system.acting, *others, *(e for _, e in system.velocities))
    every = system.letters.union(*(getattr(e, "free_symbols", ()) for e in acting))
    letters = {str(s): s for s in every if s not in moving}
    values = {
        name: _number(where, name, value)
        for name, value in values.items()
        if not isinstance(value, FunctionValue | sp.Lambda)
    }
    if strangers := sorted({name for name in values if isinstance(name, str)} - letters.keys()):
        choices = f"its symbols are {', '.join(sorted(letters))}" if letters else "it has no symbol but its coordinates"
        meant = near(strangers[0], letters) if len(strangers) == 1 else ""
        it = "it" if len(strangers) == 1 else "them"
        raise InputError(
            f"{where}: values name {', '.join(strangers)}, which the system does not have"
            f"{meant or '; ' + choices}: leave {it} out"
        )
    for name, value in values.items():
        letter = letters.get(str(name))
        if letter is None:
            continue
        wrong = (letter.is_extended_nonnegative and value < 0) or (letter.is_extended_nonpositive and value > 0)
        if wrong or (letter.is_integer and value != round(value)):
            kind = "a whole number" if letter.is_integer and not wrong else "positive" if value < 0 else "negative"
            raise InputError(
                f"{where}: {letter} = {value:g} was declared {kind}: derived results hold only for such values"
            )
    numbers = {
        s: sp.sympify(value, strict=True)
        for s, value in by_symbol(f"{where}: values", values, letters.values()).items()
    }
    for body in system.bodies:
        check_body(where, body, numbers)
    check_friction(where, put_in(system.dissipation, numbers), system.c)


def _number(where: str, name: Any, value: Any) -> float:
    try:
        if isinstance(value, str):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where}: {name} = {value!r} must be a real number") from None


def check_pole(where: str, system: Equations, values: Values, state: Array) -> None:
    """Raise SingularError if the quasi-velocities u do not determine the velocities v at the state."""
    kinematics = system.kinematics
    if kinematics is None:
        return
    size = len(system.variables)
    at, now = state[None, :size], np.append(state, 0.0)[size : size + 1]
    speeds = ", ".join(map(str, system.speeds))
    poles = [function_program(system, e).along(values)(at, now).item() for e in kinematics.poles]
    if (lost := np.abs(poles) <= _POLE).any():
        raise SingularError(
            f"{where}: {kinematics.poles[int(np.argmax(lost))]} = 0 there, where {speeds} do not give the velocities "
            "of the coordinates: start near it, or turn by unit quaternions, which have no pole: frame.ball(…)"
        )
    if not np.isfinite(velocities_along(system, values, at, now)).all():
        raise SingularError(
            f"{where}: {speeds} do not give the velocities of the coordinates there: det [A; G] = 0; start near it"
        )


def check_inertia(where: str, system: Equations, values: Values, state: Array) -> None:
    """Raise SingularError if the mass matrix M and the constraints do not determine the accelerations at the state. Warn if the
    kinetic energy of some velocities is negative."""
    M = mass_at(system, values, state)
    G = rows_at(system, values, state)
    size = np.sqrt(np.abs(np.diag(M)))
    size = np.where(size > 1e-150, size, size.max() or 1.0)
    M, G = M / np.outer(size, size), G / size
    lengths = np.linalg.norm(G, axis=1, keepdims=True)
    if not (np.isfinite(M).all() and np.isfinite(G).all() and lengths.all()):
        return  # the right-hand side or the constraints will be refused
    _, weights, directions = np.linalg.svd(G / lengths) if len(G) else (None, np.zeros(0), np.eye(len(M)))
    free = directions[int((weights > _RANK).sum()) :]
    kinetic = np.linalg.eigvalsh(free @ M @ free.T) if len(free) else np.ones(1)
    if np.abs(kinetic).min() <= _RANK * max(np.abs(kinetic).max(), np.abs(M).max()):
        _, vectors = np.linalg.eigh(free @ M @ free.T)
        idle = np.abs(free.T @ vectors[:, int(np.abs(kinetic).argmin())])
        names = ", ".join(str(v) for v, weight in zip(system.speeds, idle, strict=True) if weight > 0.2 * idle.max())
        raise SingularError(
            f"{where}: the mass matrix is singular at the start (det M = 0): no mass moves with {names}, and no constraint "
            "determines it; use fewer coordinates, give its body a mass, or start away from a pole"
        )
    if np.linalg.svd(M, compute_uv=False)[-1] <= _RANK * np.abs(M).max() and tree_motion(system) is not None:
        raise SingularError(
            f"{where}: the mass matrix is singular at the start (det M = 0), where the constraints alone bind a coordinate: "
            "write the energies out, System(c, system.L, constraints)"
        )
    if kinetic.min() < 0:
        warn(
            f"{where}: the kinetic energy of some velocities is negative at the start: check the signs of masses",
            LagrotorWarning,
            stacklevel=3,
        )


def consistent(
    where: str, system: Equations, values: Values, q0: ArrayLike, v0: ArrayLike, t: float = 0.0
) -> tuple[Array, Array]:
    """Return the state on the constraints, q (N,) and u (m,), that is nearest to q0, v0 at the time t in s, for
    `System.consistent`. Distances are measured by the mass matrix; for quasi-velocities they are Euclidean."""
    n, m, h = len(system.c.q), len(system.speeds), len(system.constraints)
    q, v = state_vector(where, "q0", q0, n), state_vector(where, "v0", v0, m, system)
    if not system.c.q:
        return q, v
    for joint in system.ball_joints:
        if (size := float(np.linalg.norm(q[[system.c.q.index(s) for s in joint.quaternion]]))) < _LEAST_NORM:
            raise InputError(f"{where}: {no_turn(joint.quaternion, size)}")
    program = start_program(system)
    arguments = (float(finite_array(f"{where}: t", t, ())), *parameter_values(program, values, where))
    ends = np.cumsum([m * m, h, h * n, len(system.left) * m])

    def matrices(at: ArrayLike, rates: ArrayLike) -> tuple[Array, Array, Array, Array, Array]:
        """Return M, g, ∂g/∂q, G and the residual G u + b at a state."""
        with np.errstate(all="ignore"):
            numbers = np.array(program.function(*np.concatenate([at, rates, arguments])), float)
        M, g, slope, G, residual = np.split(numbers, ends)
        return M.reshape(m, m), g, slope.reshape(h, n), G.reshape(-1, m), residual

    if h:
        M, _, slope, _, _ = matrices(q, v)
        metric_there = metric(M, slope) if system.kinematics is None else None
        try:
            placed = project_position(lambda at: matrices(at, v)[1], lambda at: matrices(at, v)[2], q, metric_there)
        except (ConstraintError, SingularError) as error:
            reduced, redundancy = without_redundant(where, system, values, q, v, float(arguments[0]), True)
            if redundancy is not None:
                return consistent(where, reduced, values, q0, v0, t)
            raise type(error)(str(error).replace("project_position", where, 1)) from None
        q = np.asarray(placed, float)
    reduced, redundancy = without_redundant(where, system, values, q, v, float(arguments[0]))
    if redundancy is not None:
        return consistent(where, reduced, values, q, v0, t)
    mass, _, _, slope, offset = matrices(q, np.zeros(m))  # b, so that G u + b = 0
    if not system.left:
        return q, v
    mass = metric(mass, slope)
    particular = -np.linalg.pinv(slope) @ offset
    return q, np.asarray(particular + project_velocity(slope, v - particular, mass), float)


def numbers_of_start(where: str, system: Equations, q0: Any, v0: Any) -> tuple[Any, Any]:
    """Return the coordinates and the velocities of a start in the order of the system. Without v0 the system is at rest."""
    if v0 is None:
        still = dict.fromkeys(system.c.v, sp.S.Zero)
        if moving := [u for u, e in system.velocities if put_in(e, still) != 0]:
            raise InputError(
                f"{where}: v0 is missing, and {moving[0]} is not zero at rest: give v0 = {{{moving[0]}: …}}"
            )
        v0 = [0.0] * len(system.speeds)
    return in_order(f"{where}: q0", q0, system.c.q), in_order(f"{where}: v0", v0, system.speeds)


def rounding_of_start(system: Equations, values: Values, start: Array, t: float, duration: float = 1.0) -> Array:
    """Return, for each component of an initial state (q, u), the distance from the constraints that counts as rounding, shape (N
    + m,). It is 10⁻⁷ (1 + max |start|), or 10⁻⁵ of the component's size if that is less. The size of a coordinate x_k is max_j
    √M_jj |x_j| / √M_kk, since the mass metric makes metres and radians comparable. For quasi-velocities M is replaced by 1. The
    size of a velocity is at least the size of its coordinate divided by the duration, or by one second if the run is longer."""
    n, m, program, weight = len(system.c.q), len(system.speeds), start_program(system), np.ones(1)
    if system.kinematics is None:
        with np.errstate(all="ignore"):
            M = np.array(program.function(*start, t, *parameter_values(program, values)), float)[: m * m].reshape(m, m)
        weight = np.sqrt(np.nan_to_num(np.abs(M.diagonal()), posinf=0.0))
    length, speed = (float((weight * np.abs(values_of)).max()) for values_of in (start[:n], start[n:]))
    duration = min(duration, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):  # the size of a massless component is infinite
        places = np.where(weight > 0, np.maximum(max(length, _SLOW * duration * speed) / weight, _LEAST), np.inf)
        speeds = np.fmax(np.where(weight > 0, speed / weight, np.inf), places / duration)
    sizes = np.append(np.broadcast_to(places, n), np.broadcast_to(speeds, m))
    return np.asarray(np.minimum(_OFF * (1 + np.abs(start).max()), _SMALL * sizes))


def metric(mass: Array, slope: Array) -> Array:
    """Return a regular metric for projections: M if it is regular, else M + Gᵀ W G with the weights W of `programs.inertia`. The
    rows G of the constraints are `slope`."""
    if not len(slope) or np.linalg.matrix_rank(mass, hermitian=True) == len(mass):
        return mass
    return np.asarray(mass + slope.T / np.square(slope).sum(1) @ slope * np.trace(mass) / len(mass))


def state_vector(where: str, name: str, numbers: ArrayLike, n: int, system: Equations | None = None) -> Array:
    """Check that `numbers` are n finite numbers, and return them, shape (n,). If a system is given, they are its velocities, or
    its first-order states if their name is x0."""
    vector = real_array(numbers)
    if vector is None:
        raise InputError(f"{where}: {name} = {numbers!r} must be {n} numbers")
    if vector.shape != (n,) or not np.isfinite(vector).all():
        quasi = system is not None and system.kinematics is not None
        meaning = f"of {', '.join(map(str, system.speeds))}" if system and quasi else "one for each coordinate"
        if system and name == "x0":
            meaning = f"of {', '.join(str(x) for x, _ in system.states) or 'no state, as the system has none'}"
        raise InputError(
            f"{where}: {name} = {numbers!r} must be {'a finite number' if n == 1 else f'{n} finite numbers'}, {meaning}"
        )
    return vector
