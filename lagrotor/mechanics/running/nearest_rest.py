"""The equilibrium to which Newton's method leads from a configuration: closed loops, and first-order states.

At rest the rates u' and x' of the constrained motion vanish. They are functions of the coordinates and states on the constraints,
and their derivatives along the tangent space of these give the step δ of (∂(u', x')/∂(q, x)) T δ = −(u', x'). Each step is
shortened until the rates follow the linear prediction, so that the search stays in the neighbourhood, and is followed by a
projection onto the constraints. The last steps go to rounding.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.errors import InputError, LagrotorError, SingularError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.running.flow import Values
from lagrotor.mechanics.running.initial_state import check_values, consistent
from lagrotor.mechanics.running.programs import depends_on_time, motion_program
from lagrotor.mechanics.running.state_space import check_smooth, motion_slope, point_state, state_space, tangent_space
from lagrotor.mechanics.steady_motions import small_turns

_STEPS = 200
_LEAST = 1e-9  # share of a step, below which the search ends
_REACH = 0.5  # longest step over 1 + the largest coordinate or state
_LINEAR = 0.5  # deviation from the linear prediction over the predicted change, beyond which a step is halved
_SHORT = 1e-15  # step over the size of the state, below which Newton's method has ended
_ROUNDING = 1e-10  # rates below this fraction of the largest term of J δ count as zero
_RANK = 1e-12  # singular value over the largest, below which a direction is free
_BOUNDED = 1e-6  # growth rate over the largest rate, below which small motion is bounded


def nearest_rest(system: Equations, near: Mapping[Any, Any], values: Values) -> Equilibrium:
    """Find the equilibrium for `System.rest`."""
    check_values("rest", system, values)
    if depends_on_time(system):
        raise InputError("rest: a force or a constraint depends on time: there is no equilibrium; simulate it")
    system, y = point_state("rest", system, near, values, moved=True)
    n, m, k = len(system.c.q), len(system.speeds), len(system.states)
    if y[n : n + m].any():
        raise InputError(f"rest: near = {dict(near)} has velocities: give coordinates and states alone")
    motion = motion_slope("rest", motion_program(system), values)
    check_smooth("rest", motion, y, [f"the rate of {s}" for s in system.variables], near)
    (rate, J, _), share = motion(y), 1.0
    for _ in range(_STEPS):
        free, T = tangent_space("rest", system, values, y)
        P = np.array(small_turns(system, y)[0], float)
        first = P.shape[1] - m - k  # the small displacements of velocities begin here
        places = P @ T[:, [not first <= i < first + m for i in np.flatnonzero(free)]]
        step = -places @ np.linalg.lstsq((J @ places)[n:], rate[n:], rcond=_RANK)[0]
        length, size = np.abs(step).max(initial=0), 1 + np.abs(y).max()
        if length <= _SHORT * size:
            break
        share = min(1.0, _REACH * size / length)
        while share > _LEAST:
            place = y + share * step
            if system.multipliers:
                place[: n + m] = np.concatenate(consistent("rest", system, values, place[:n], y[n : n + m]))
            after, J_there, _ = motion(place)
            if np.linalg.norm(after[n:] - (1 - share) * rate[n:]) <= _LINEAR * share * np.linalg.norm(rate[n:]):
                break
            share /= 2
        if share <= _LEAST:
            break
        y, rate, J = place, after, J_there
    left = np.abs(rate[n:])
    at = {s: sp.Float(float(x)) for s, x in zip(system.variables, y, strict=True) if s not in system.speeds}
    if not (left <= _ROUNDING * (np.abs(J[n:]) @ (np.abs(y) + 1))).all():
        raise SingularError(
            f"rest: Newton's method ends at {', '.join(f'{s} = {float(x):.6g}' for s, x in at.items())}, where the rates are "
            f"still {left.max():.3g}: there may be no equilibrium in this direction; start near={{…}} nearer to one"
        )
    return Equilibrium(at, residual=float(left.max(initial=0)), stability=_stability(system, at, values))


def _stability(system: Equations, at: Mapping[sp.Symbol, sp.Expr], values: Values) -> str:
    """Return the stability to first order in words."""
    try:
        rates = state_space(system, at, values, where="rest").rates
    except LagrotorError:
        return "unknown: the linear equations are not regular there"
    growth, least = float(rates.real.max(initial=-np.inf)), _BOUNDED * float(np.abs(rates).max(initial=0))
    if abs(growth) <= least:
        return "no small motion grows exponentially"
    verdict = "unstable: a small motion grows" if growth > 0 else "stable: every small motion decays, the slowest"
    return f"{verdict} at {abs(growth):.4g} 1/s"
