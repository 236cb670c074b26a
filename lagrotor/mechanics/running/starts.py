"""Where a run starts: coordinates, velocities and times as they are given, and the nearest state on the constraints."""

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics.constraints import project_position, project_velocity
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.programs import parameter_values, start_program
from lagrotor.mechanics.steady_motions import no_turn
from lagrotor.numerics.arrays import finite_array, real_array

_OFF = 1e-7  # of 1 and the largest number of a start: how far it may be off its constraints
_SMALL = 1e-5  # of the size of what is small, how far it may be off
_SLOW = 1e-3  # of the way that the velocities cover: as large a place counts at least
_LEAST = 1e-8  # a place that is smaller counts as this: it may be rounding of parameters of size one
_LEAST_NORM = 1e-3  # of a quaternion, from which the nearest of norm 1 is reached


def consistent(
    where: str, system: Equations, values: Values, q0: ArrayLike, v0: ArrayLike, t: float = 0.0
) -> tuple[Array, Array]:
    """The state (q, v) on the constraints that is nearest to q0, v0 in the mass metric, at the time t; (q, u) for velocities of
    one's own, in the metric of their numbers.

    Raises ConstraintError when it is not reached, SingularError where the constraints are dependent, InputError for a quaternion
    of norm 0.
    """
    n, m, h = len(system.c.q), len(system.speeds), len(system.constraints)
    q, v = state_vector(where, "q0", q0, n), state_vector(where, "v0", v0, m, system)
    for joint in system.ball_joints:
        if (size := float(np.linalg.norm(q[[system.c.q.index(s) for s in joint.quaternion]]))) < _LEAST_NORM:
            raise InputError(f"{where}: {no_turn(joint.quaternion, size)}")
    given = start_program(system)
    rest = (float(finite_array(f"{where}: t", t, ())), *parameter_values(given, values, where))
    ends = np.cumsum([m * m, h, h * n, len(system.left) * m])

    def parts(at: ArrayLike, rates: ArrayLike) -> tuple[Array, Array, Array, Array, Array]:
        """M, g, ∂g/∂q, G and G u + b."""
        with np.errstate(all="ignore"):
            numbers = np.array(given.function(*np.concatenate([at, rates, rest])), float)
        M, g, slope, G, off = np.split(numbers, ends)
        return M.reshape(m, m), g, slope.reshape(h, n), G.reshape(-1, m), off

    if h:
        M, _, slope, _, _ = parts(q, v)
        metric_there = metric(M, slope) if system.kinematics is None else None
        try:
            placed = project_position(lambda at: parts(at, v)[1], lambda at: parts(at, v)[2], q, metric_there)
        except (ConstraintError, SingularError) as error:
            raise type(error)(str(error).replace("project_position", where, 1)) from None
        q = np.asarray(placed, float)
    mass, _, _, slope, wanted = parts(q, np.zeros(m))  # wanted: b, so that G u + b = 0
    if not system.left:
        return q, v
    mass = metric(mass, slope)
    particular = -np.linalg.pinv(slope) @ wanted
    return q, np.asarray(particular + project_velocity(slope, v - particular, mass), float)


def rounding_of_start(system: Equations, values: Values, start: Array, t: float, duration: float = 1.0) -> Array:
    """How far each component of a start (q, u), (N + m,), may be off the constraints: 10⁻⁷ (1 + max |start|), and where that is
    less, 10⁻⁵ of its size, in whatever unit of length.

    The sizes of x_k are max_j √M_jj |x_j| / √M_kk: the mass metric compares metres with radians; for velocities of one's own it
    is 1. Velocities are no smaller than what leads through the places in the duration, or in one second where that is shorter.
    """
    n, m, given, weight = len(system.c.q), len(system.speeds), start_program(system), np.ones(1)
    if system.kinematics is None:
        with np.errstate(all="ignore"):
            M = np.array(given.function(*start, t, *parameter_values(given, values)), float)[: m * m].reshape(m, m)
        weight = np.sqrt(np.nan_to_num(np.abs(M.diagonal()), posinf=0.0))
    length, speed = (float((weight * np.abs(part)).max()) for part in (start[:n], start[n:]))
    duration = min(duration, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):  # what has no mass has no size: infinity
        places = np.where(weight > 0, np.maximum(max(length, _SLOW * duration * speed) / weight, _LEAST), np.inf)
        speeds = np.fmax(np.where(weight > 0, speed / weight, np.inf), places / duration)
    sizes = np.append(np.broadcast_to(places, n), np.broadcast_to(speeds, m))
    return np.asarray(np.minimum(_OFF * (1 + np.abs(start).max()), _SMALL * sizes))


def metric(mass: Array, slope: Array) -> Array:
    """M, or where it is singular M + Gᵀ W G, W as in `programs.inertia`: a metric in which distances are measured."""
    if not len(slope) or np.linalg.matrix_rank(mass, hermitian=True) == len(mass):
        return mass
    return np.asarray(mass + slope.T / np.square(slope).sum(1) @ slope * np.trace(mass) / len(mass))


def state_vector(where: str, name: str, given: ArrayLike, n: int, system: Equations | None = None) -> Array:
    """n finite numbers; of velocities where a system is given."""
    vector = real_array(given)
    if vector is None:
        raise InputError(f"{where}: {name} = {given!r} must be {n} numbers")
    if vector.shape != (n,) or not np.isfinite(vector).all():
        own = system is not None and system.kinematics is not None
        each = f"of {', '.join(map(str, system.speeds))}" if system and own else "one for each coordinate"
        raise InputError(f"{where}: {name} = {given!r} must be {n} finite numbers, {each}")
    return vector
