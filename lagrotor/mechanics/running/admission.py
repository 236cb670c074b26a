"""What numbers must be so that a system of them moves: letters that it has, of their declared sign; masses that bodies have;
friction that takes energy; a mass matrix that, with the constraints, gives one acceleration."""

from collections.abc import Iterable, Mapping
from typing import Any
from warnings import warn

import numpy as np
import sympy as sp

from lagrotor.errors import InputError, LagrotorWarning, SingularError, near
from lagrotor.mechanics.bodies.rigid_bodies import check_body
from lagrotor.mechanics.equations import Equations, check_friction
from lagrotor.mechanics.expressions import by_symbol, put_in
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.flow import Array, Values
from lagrotor.mechanics.running.function_values import FunctionValue
from lagrotor.mechanics.running.programs import function_program, tree_motion, velocities_along
from lagrotor.mechanics.running.singular import mass_at, rows_at

_POLE = 1e-13  # of a factor of det [A; G], below which it is zero
_RANK = 1e-11  # of the largest eigenvalue, what is left of a direction that nothing moves, by rounding


def check_values(where: str, system: Equations, values: Values, others: Iterable[sp.Expr] = ()) -> None:
    """Raise InputError for names that are no letters of the system, or of `others`; for a value whose sign is not the
    letter's; for a body or a friction that there is none of. A symbol of another system, of a table that several share, is
    passed over."""
    if not isinstance(values, Mapping):
        raise InputError(f"{where}: values = {values!r} must be {{symbol: number, …}}, a dictionary")
    moving = {*system.c.q, *system.c.v, *system.c.a, *system.speeds, t}
    acting = (*system.acting, *others, *(e for _, e in system.velocities))
    every = system.letters.union(*(getattr(e, "free_symbols", ()) for e in acting))
    letters = {str(s): s for s in every if s not in moving}
    values = {
        name: _number(where, name, value)
        for name, value in values.items()
        if not isinstance(value, FunctionValue | sp.Lambda)
    }
    if strangers := sorted({name for name in values if isinstance(name, str)} - letters.keys()):
        known = f"its letters are {', '.join(sorted(letters))}" if letters else "it has no letter but its coordinates"
        meant = near(strangers[0], letters) if len(strangers) == 1 else ""
        it = "it" if len(strangers) == 1 else "them"
        raise InputError(
            f"{where}: values name {', '.join(strangers)}, which the system does not have{meant or '; ' + known}: leave {it} out"
        )
    for name, value in values.items():
        letter = letters.get(str(name))
        if letter is None:
            continue
        wrong = (letter.is_extended_nonnegative and value < 0) or (letter.is_extended_nonpositive and value > 0)
        if wrong or (letter.is_integer and value != round(value)):
            kind = "a whole number" if letter.is_integer and not wrong else "positive" if value < 0 else "negative"
            raise InputError(
                f"{where}: {letter} = {value:g} was declared {kind}: what is derived of it holds for these alone"
            )
    put = {
        s: sp.sympify(value, strict=True)
        for s, value in by_symbol(f"{where}: values", values, letters.values()).items()
    }
    for body in system.bodies:
        check_body(where, body, put)
    check_friction(where, put_in(system.dissipation, put), system.c)


def _number(where: str, name: Any, value: Any) -> float:
    try:
        if isinstance(value, str):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{where}: {name} = {value!r} must be a real number") from None


def check_pole(where: str, system: Equations, values: Values, state: Array) -> None:
    """Raise SingularError where velocities of one's own do not give v at a state."""
    given = system.kinematics
    if given is None:
        return
    size = len(system.c.q) + len(system.speeds)
    at, time = state[None, :size], np.append(state, 0.0)[size : size + 1]
    own = ", ".join(map(str, system.speeds))
    poles = [function_program(system, e).along(values)(at, time).item() for e in given.poles]
    if (lost := np.abs(poles) <= _POLE).any():
        raise SingularError(
            f"{where}: {given.poles[int(np.argmax(lost))]} = 0 there, where {own} do not give the velocities of the coordinates: "
            "start beside it, or turn by unit quaternions, which have no pole: frame.ball(…)"
        )
    if not np.isfinite(velocities_along(system, values, at, time)).all():
        raise SingularError(
            f"{where}: {own} do not give the velocities of the coordinates there: det [A; G] = 0; start beside it"
        )


def check_inertia(where: str, system: Equations, values: Values, state: Array) -> None:
    """Raise SingularError where M, with the constraints, does not give one acceleration at a state; warn where the kinetic
    energy of a velocity that the constraints allow is negative."""
    M = mass_at(system, values, state)
    G = rows_at(system, values, state)
    size = np.sqrt(np.abs(np.diag(M)))
    size = np.where(size > 1e-150, size, size.max() or 1.0)
    M, G = M / np.outer(size, size), G / size
    lengths = np.linalg.norm(G, axis=1, keepdims=True)
    if not (np.isfinite(M).all() and np.isfinite(G).all() and lengths.all()):
        return  # said of the right-hand side, or of the constraints
    _, weights, turned = np.linalg.svd(G / lengths) if len(G) else (None, np.zeros(0), np.eye(len(M)))
    free = turned[int((weights > _RANK).sum()) :]
    kinetic = np.linalg.eigvalsh(free @ M @ free.T) if len(free) else np.ones(1)
    if np.abs(kinetic).min() <= _RANK * max(np.abs(kinetic).max(), np.abs(M).max()):
        _, vectors = np.linalg.eigh(free @ M @ free.T)
        idle = np.abs(free.T @ vectors[:, int(np.abs(kinetic).argmin())])
        names = ", ".join(str(v) for v, part in zip(system.speeds, idle, strict=True) if part > 0.2 * idle.max())
        raise SingularError(
            f"{where}: the mass matrix is singular at the start (det M = 0): no mass moves with {names}, and no constraint "
            "gives it; use fewer coordinates, give what it moves a mass, or start beside a pole"
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
