"""Where a motion crosses a section, and Poincaré sections: on the exact motion, whatever the times at which it was read."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf
from typing import Any, TypeVar

import numpy as np
import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.mechanics.expressions import expression, vector_of
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.flow import Array
from lagrotor.mechanics.running.function_values import with_values
from lagrotor.mechanics.running.motion import SampledMotion
from lagrotor.mechanics.running.phases import march, polish
from lagrotor.mechanics.running.programs import function_program
from lagrotor.numerics.zeros import zeros_between

Kind = TypeVar("Kind", bound=SampledMotion)
_ONE = 1e-5  # of a step: zeros so near to each other and in the same direction are one
_LEAST = 1e-13  # of the section's size, below which it is zero


def crossings(run: Kind, section: sp.Expr, direction: int = 0) -> Kind:
    """The states where section(q, v, t) = 0 is crossed: upward (direction = 1), downward (−1), or both (0), with those where it
    is touched: where it turns round at zero, to within the run's tolerance. The start is none; there may be none.

    Sought on the dense output of an integration from each sample to the next, of whose series all zeros are found. A
    LagrotorWarning says where the section changes faster than that can be followed.
    """
    if direction not in (-1, 0, 1):
        raise InputError(f"crossings: direction = {direction!r} must be 1 (upward), −1 (downward) or 0 (both)")
    if len(run.t) < 2:
        raise InputError("crossings: a run of one sample crosses nothing: simulate to a later time")
    section, size = with_values(expression("crossings: section", section), run.values), run.switched.size
    value = function_program(run.system, section).along(run.values, "crossings")
    touch = max(run.tol, _LEAST) * _change(run, section)
    passages: list[tuple[float, int, Array]] = []
    hidden: list[tuple[float, float]] = []
    side, evaluations = 0.0, run.evaluations

    def observe(begun: float, left: float, right: float, curve: Any) -> None:
        nonlocal side

        def values(s: Array) -> Array:
            return value(curve(s), begun + s)

        zeros = zeros_between(values, left, right, touch)
        hidden.extend([(begun + zeros.hidden[0], begun + zeros.hidden[1])] if zeros.hidden else [])
        for s, way in zip(zeros.t, zeros.direction, strict=True):
            since = float(s) if way == 0 else polish(values, 0, float(s), left, right)
            at, near = begun + since, _ONE * (right - left)
            if at > run.t[0] + near and not (passages and passages[-1][1] == way and at - passages[-1][0] <= near):
                passages.append((at, int(way), curve(np.array([since]))[0][:size]))
        side = float(values(np.array([right]))[0, 0])

    # A run without events is followed in one phase, with the time among its states.
    phases = run.switched
    full = (
        run.states
        if not phases.smooth
        else np.array([phases.state(y, t, phases.slipping) for y, t in zip(run.states, run.t, strict=True)])
    )
    known = value(run.states, run.t)[0]
    for i, (a, b) in enumerate(pairwise(run.t)):
        evaluations += march(phases, full[i], np.array([a, b]), run.local, inf, observe).evaluations
        if side * known[i + 1] < 0:  # between the end of a piece and the beginning of the next
            way = 1 if known[i + 1] > 0 else -1
            near_end = bool(passages) and b - passages[-1][0] < 1e-3 * (b - a)
            if near_end and passages[-1][1] == -way:
                passages.pop()  # the next piece begins before it
            elif not near_end:
                passages.append((float(b), way, full[i + 1][:size]))
    if hidden:
        warnings.warn(
            f"crossings: between t = {hidden[0][0]:.6g} and {hidden[0][1]:.6g} s the section changes faster than it can be "
            "followed: crossings may be hidden there",
            LagrotorWarning,
            stacklevel=2,
        )
    kept = [(t, y) for t, way, y in passages if direction in (0, way)]
    times = np.array([t for t, _ in kept])
    tail = run.states.shape[1] - size
    rows = np.array([y for _, y in kept]).reshape(-1, size)
    before = np.clip(np.searchsorted(run.t, times, side="right") - 1, 0, len(run.t) - 1)
    more = run.states[before, size:].copy()
    if tail:
        more[:, 0] = times
    return replace(run.read(times, np.hstack([rows, more])), evaluations=evaluations)


def poincare(run: SampledMotion, section: sp.Expr, of: Sequence[sp.Expr], direction: int = 1) -> Array:
    """The values of the expressions `of` at the crossings, (m, len(of)): of two, the points of a Poincaré section."""
    wanted = vector_of("poincare: of", of, len(of) if isinstance(of, Sequence) else 2)
    there = crossings(run, section, direction)
    return np.stack([there.evaluate(e) for e in wanted], axis=1)


def _change(run: SampledMotion, section: sp.Expr) -> float:
    """The most by which a section changes where each component of the state changes by its size."""
    symbols, sizes = (*run.system.c.q, *run.system.speeds), run.scales.sizes
    if not section.free_symbols & {*symbols, *run.system.c.v, *run.system.c.a, *run.system.multipliers, t}:
        raise InputError(f"crossings: section = {section} does not change: give q, v or t in it")
    if run.system.kinematics is not None:
        moving = [v for v in run.system.c.v if v not in symbols]
        symbols, sizes = (*symbols, *moving), np.append(sizes, [np.abs(run.evaluate(v)).max() for v in moving])
    program = function_program(run.system, *(derivative(section, s) for s in symbols))
    slopes = program.along(run.values)(run.states, run.t)
    return float((np.abs(slopes).T @ sizes).max())
