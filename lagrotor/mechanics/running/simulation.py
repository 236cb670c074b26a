"""Simulation of any system: initial values in, a run out."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running import lyapunov, run_pictures, sections
from lagrotor.mechanics.running.dependence import warn_of_dependence
from lagrotor.mechanics.running.integration import (
    Array,
    Values,
    consistent,
    increasing,
    states,
    vector,
)
from lagrotor.mechanics.running.motion import Motion
from lagrotor.mechanics.running.programs import motion_program, parameter_values
from lagrotor.numerics.integrate import Engine, check_engine, check_tolerance

_OFF = 1e-7  # of a start from its constraints, in units of the state's size, beyond which it is refused


@dataclass(frozen=True, eq=False, repr=False)
class Run(Motion):
    """A simulated motion, and what can be computed from it."""

    crossings = sections.crossings
    poincare = sections.poincare
    lyapunov = lyapunov.lyapunov
    plot = run_pictures.plot
    animate = run_pictures.animate


def simulate(
    system: Equations,
    values: Values,
    q0: ArrayLike,
    v0: ArrayLike,
    t: ArrayLike,
    tol: float = 1e-9,
    engine: Engine = "core",
) -> Run:
    """Integrate from q0, v0 (N,) at t[0] through the increasing times t (n,), in s.

    values: {symbol or name: number} for every parameter. tol: the largest error of the whole run, relative to the state's
    size; a motion whose neighbours part fast is off by more. engine: "core", or "fast" with heyoka.

    Raises InputError for a value that is missing or makes no sense, ConstraintError for a start off the constraints,
    SingularError for a singular mass matrix, IntegrationError where the motion cannot go on. A LagrotorWarning names the time
    where it passed a position at which its constraints are dependent.
    """
    times, tol = increasing(t), check_tolerance(tol)
    check_engine(engine)
    n = len(system.c.q)
    start = np.concatenate([vector("q0", q0, n), vector("v0", v0, n)])
    parameter_values(motion_program(system), values)
    if system.multipliers:
        q, v = consistent(system, values, start[:n], start[n:], times[0])
        off = np.abs(np.concatenate([q, v]) - start).max()
        if off > _OFF * (1 + np.abs(start).max()):
            raise ConstraintError(
                f"simulate: the start is off the constraints by {off:.3g}; the nearest state on them is q0 = {_shown(q)}, "
                f"v0 = {_shown(v)} (system.consistent gives it)"
            )
        start = np.concatenate([q, v])
    found = states(system, values, start, times[0], times, tol, engine)
    run = Run(system, values, times, found[:, :n], found[:, n:], tol, engine)
    if system.multipliers:
        warn_of_dependence(run)
    return run


def _shown(values: Sequence[float] | Array) -> str:
    return "(" + ", ".join(f"{float(x):.12g}" for x in values) + ")"
