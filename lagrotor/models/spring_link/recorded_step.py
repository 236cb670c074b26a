"""A step of a few bodies, or the rates of their state, in single numbers: arrays cost more for so few operations."""

from collections.abc import Callable, Sequence
from copy import copy
from typing import Any

import numpy as np

from lagrotor.models.spring_link.paper_bodies import TIP
from lagrotor.models.spring_link.rigid_body import Array, finite_rotation, inertia_transform
from lagrotor.models.spring_link.system import RigidBodySystem, link_force
from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.numerics.rotations import skew_matrix
from lagrotor.pair.scene import Shock

OfState = Callable[[Sequence[float], float], list[float]]  # of a state and the strength of a shock
_MOST = 12  # bodies beyond which arrays cost less
_STRAIGHT = link_force, finite_rotation, inertia_transform  # laws that branch on no value


def step_function(system: RigidBodySystem, shock: Shock | None, dt: float) -> OfState:
    """`system.state` → the state dt later, by `compute_forces`, `push` and `step` of the system."""

    def after(moving: RigidBodySystem) -> Array:
        moving.step(dt)
        return moving.state

    return _recorded(system, shock, after, 21)


def rate_function(system: RigidBodySystem, shock: Shock | None) -> OfState:
    """The state y (18 n,) of X, U, L, R of n bodies → y', by `compute_forces` and `push` of the system."""

    def rates(moving: RigidBodySystem) -> Array:
        turning = skew_matrix(moving.Omega) @ moving.R
        changes = moving.U, moving.F * moving.inverse_mass, moving.tau, turning
        return np.concatenate([change[:-1].ravel() for change in changes])

    return _recorded(system, shock, rates, 18)


def _recorded(
    system: RigidBodySystem, shock: Shock | None, read: Callable[[RigidBodySystem], Array], size: int
) -> OfState:
    """What `read` finds when the forces on a state, of `size` numbers a body, are computed.

    With few bodies and laws that branch on no value this is gone through once, with numbers that record, and what they have
    recorded is compiled.
    """
    moving, n = copy(system), len(system.vertices)

    def found(state: Sequence[Any], strength: Any) -> list[Any]:
        moving.load(np.array(state))
        moving.compute_forces()
        if shock is not None:
            moving.push(shock.body, TIP, shock.force, strength)
        numbers: list[Any] = read(moving).tolist()
        return numbers

    if n > _MOST or (system.force, system.rotation, system.transform) != _STRAIGHT:
        return found
    tape: list[Recorded] = []
    names = [f"y{k}" for k in range(size * n)]
    outputs = found([Recorded(tape, name) for name in names], Recorded(tape, "strength"))
    lines, texts = recorded_numbers.lines(outputs, tape)
    body = [f"{', '.join(names)} = state", *lines, f"return [{', '.join(texts)}]"]
    return function_of("\n    ".join(["from math import *\ndef of_state(state, strength):", *body]))
