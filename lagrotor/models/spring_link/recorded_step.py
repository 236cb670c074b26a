"""The paper's step of a few bodies in single numbers: so few operations cost less than calling arrays does."""

from collections.abc import Callable, Sequence
from copy import copy
from typing import Any

import numpy as np

from lagrotor.models.spring_link.paper_bodies import TIP
from lagrotor.models.spring_link.rigid_body import finite_rotation, inertia_transform
from lagrotor.models.spring_link.system import RigidBodySystem, link_force
from lagrotor.numerics import recorded_numbers
from lagrotor.numerics.generated import function_of
from lagrotor.numerics.recorded_numbers import Recorded
from lagrotor.pair.scene import Shock

MOST = 12  # bodies beyond which arrays cost less
_STRAIGHT = link_force, finite_rotation, inertia_transform  # laws that branch on no value


def step_function(
    system: RigidBodySystem, shock: Shock | None, dt: float
) -> Callable[[Sequence[float], float], list[float]]:
    """(`system.state`, strength of the shock) → the state dt later, by `compute_forces`, `push` and `step` of the system.

    With few bodies and laws that branch on no value these are gone through once, with numbers that record, and what they
    have recorded is compiled.
    """
    moving, n = copy(system), len(system.vertices)

    def stepped(state: Sequence[Any], strength: Any) -> list[Any]:
        moving.load(np.array(state))
        moving.compute_forces()
        if shock is not None:
            moving.push(shock.body, TIP, shock.force, strength)
        moving.step(dt)
        after: list[Any] = moving.state.tolist()
        return after

    if n > MOST or (system.force, system.rotation, system.transform) != _STRAIGHT:
        return stepped
    tape: list[Recorded] = []
    names = [f"y{k}" for k in range(21 * n)]
    after = stepped([Recorded(tape, name) for name in names], Recorded(tape, "strength"))
    lines, found = recorded_numbers.lines(after, tape)
    body = [f"{', '.join(names)} = state", *lines, f"return [{', '.join(found)}]"]
    return function_of("\n    ".join(["from math import *\ndef step(state, strength):", *body]))
