"""Crossings of sections on the steps of the run, independent of its sample times.

A smooth motion is integrated again from sample to sample, by the solver and the local error of the run. A stage is a part of
the run that begins and ends at samples. In each stage a first integration records the times of the evaluations. A second one
reads the states at Chebyshev's nodes of panels; a panel spans _STEPS of these times. The polynomial through a panel's nodes is
resolved to the local error, or the panel is halved. The sizes of its coefficients exclude a zero of the section in most panels.
So the search costs two integrations; a run costs two or more.
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

import numpy as np
import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.mechanics.expressions import expression
from lagrotor.mechanics.lagrangian import t
from lagrotor.mechanics.running.flow import Array
from lagrotor.mechanics.running.function_values import with_values
from lagrotor.mechanics.running.motion import Kind, SampledMotion, integration_of, with_states
from lagrotor.mechanics.running.narrow_features import narrow_parts
from lagrotor.mechanics.running.phases import Observer, march, polish
from lagrotor.mechanics.running.programs import function_program
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solver_constants import CROSSOVER
from lagrotor.numerics.zeros import chebyshev_nodes, interpolant, may_vanish, zeros_between

_ONE = 1e-5  # distance, over the step, below which zeros of the same direction are one
_LEAST = 1e-13  # of the section's size, below which it is zero
_TURNS = 8  # turns in a stage: few, so that neighbouring motions stay close, but the first steps of a stage cost little
_STEPS = 8  # times of evaluations in a panel, which has twice as many intervals between its nodes
_HALVINGS = 8  # of a panel whose polynomial is not resolved
_BUDGET = 60_000, 4_800  # evaluations of a stage, in all and per turn: three times those of a run
_CLOCK = 1e3  # spacings of doubles at the time in the shortest panel
_Step = tuple[float, float, float, Callable[[Array], Array]]  # the arguments of an Observer
Values = Callable[[Array, Array], Array]  # states (m, d) and times (m,) → the section (1, m)


@dataclass
class _Search:
    """The search for crossings after the time `begin`, step by step in the order of time. The section is the function `value` of
    the state. The crossings so far are `passages`, each (time, direction, state); `hidden` are intervals of time that may hide
    one. The list `near_zero` collects consecutive short steps in which the section stays within `touch` of zero."""

    value: Values
    begin: float
    size: int
    touch: float
    passages: list[tuple[float, int, Array]] = field(default_factory=list)
    hidden: list[tuple[float, float]] = field(default_factory=list)
    near_zero: list[_Step] = field(default_factory=list)

    def observe(self, begun: float, lower: float, upper: float, curve: Any) -> None:
        nodes = chebyshev_nodes(np.array([lower, upper]))[0]
        if self.near_zero and begun + lower > self.near_zero[-1][0] + self.near_zero[-1][2] + _ONE * (upper - lower):
            self.leave()
        if begun + lower > self.begin and np.abs(self.value(curve(nodes), begun + nodes)).max() <= self.touch:
            self.near_zero.append((begun, lower, upper, curve))
            return
        self.leave()
        self._search(begun, lower, upper, curve, self.touch)

    def leave(self) -> None:
        """Search the steps in `near_zero` if the section has changed its sign over them, then empty the list."""
        signs = [
            [bool(self.value(curve(np.array([s])), np.array([begun + s]))[0, 0] > 0) for s in (lower, upper)]
            for begun, lower, upper, curve in self.near_zero
        ]
        for step, (sign_before, sign_after) in zip(self.near_zero, signs, strict=True):
            if signs[0][0] != signs[-1][1] and sign_before != sign_after:
                self._search(*step, 0.0)
        self.near_zero.clear()

    def _search(self, begun: float, lower: float, upper: float, curve: Any, touch: float) -> None:
        def values(s: Array) -> Array:
            return self.value(curve(s), begun + s)

        zeros, passages = zeros_between(values, lower, upper, touch), self.passages
        self.hidden += [(begun + zeros.hidden[0], begun + zeros.hidden[1])] if zeros.hidden else []
        for s, way in zip(zeros.t, zeros.direction, strict=True):
            since = float(s) if way == 0 else polish(values, 0, float(s), lower, upper)
            at, near = begun + since, _ONE * (upper - lower)
            if at > self.begin + near and not (passages and passages[-1][1] == way and at - passages[-1][0] <= near):
                passages.append((at, int(way), curve(np.array([since]))[0][: self.size]))


def crossings(run: Kind, section: sp.Expr, direction: int = 0) -> Kind:
    """Find the crossings of a section for `SystemRun.crossings`."""
    if direction not in (-1, 0, 1):
        raise InputError(f"crossings: direction = {direction!r} must be 1 (upward), −1 (downward) or 0 (both)")
    if len(run.t) < 2:
        raise InputError("crossings: a run of one sample crosses nothing: simulate to a later time")
    section, size = with_values(expression("crossings: section", section), run.values), run.switched.size
    value = function_program(run.system, section).along(run.values, "crossings")
    touch = max(run.tol, _LEAST) * change(run, section)
    h = run.switched
    features = (*narrow_parts(h.system, h.numbers(h.slipping), run.scales.survey, section), *h.narrow)
    narrow = {feature.argument: feature for feature in features}
    run = replace(run, switched=replace(h, narrow=tuple(narrow.values())))
    search = _Search(value, float(run.t[0]), size, touch)
    passages, evaluations = search.passages, run.evaluations
    values_at_samples = value(run.states, run.t)[0]
    for i, j in _stages(run):
        end, cost = _stage(run, i, j, value, touch, search.observe)
        evaluations += cost
        side = float(value(end[None], run.t[[j]])[0, 0])
        if side * values_at_samples[j] < 0:  # a zero between the end of a stage and the beginning of the next
            way = 1 if values_at_samples[j] > 0 else -1
            near_end = bool(passages) and run.t[j] - passages[-1][0] < 1e-3 * (run.t[j] - run.t[j - 1])
            if near_end and passages[-1][1] == -way:
                passages.pop()  # the next stage begins before it
            elif not near_end:
                passages.append((float(run.t[j]), way, run.states[j, :size]))
    search.leave()
    if hidden := search.hidden:
        warnings.warn(
            f"crossings: between t = {hidden[0][0]:.6g} and {hidden[0][1]:.6g} s the section changes faster than it can be "
            "followed: crossings may be hidden there",
            LagrotorWarning,
            stacklevel=3,
        )
    selected = [(t, y) for t, way, y in passages if direction in (0, way)]
    times = np.array([t for t, _ in selected])
    tail = run.states.shape[1] - size
    rows = np.array([y for _, y in selected]).reshape(-1, size)
    samples = np.clip(np.searchsorted(run.t, times, side="right") - 1, 0, len(run.t) - 1)
    clock_and_mode = run.states[samples, size:].copy()
    if tail:
        clock_and_mode[:, 0] = times
    states = np.hstack([rows, clock_and_mode])
    return replace(with_states(run, times, states), evaluations=evaluations, switched=h)


def _stages(run: SampledMotion) -> Iterator[tuple[int, int]]:
    """Yield the first and the last sample of each stage, which lasts at most _TURNS periods or one interval. If several samples
    have one time, the last of them begins a stage."""
    i, n = 0, len(run.t)
    while (i := int(np.searchsorted(run.t, run.t[i], side="right")) - 1) < n - 1:
        j = int(np.searchsorted(run.t, run.t[i] + _TURNS * run.scales.turn, side="right")) - 1
        yield i, (j := max(i + 1, j))
        i = j


def _stage(run: SampledMotion, i: int, j: int, value: Values, touch: float, observe: Observer) -> tuple[Array, int]:
    """Integrate from sample i to sample j, and call `observe` with each step in which the section may be zero. Return the last
    state and the number of evaluations."""
    begin, end = run.t[[i, j]]
    # Below CROSSOVER no stiff method is chosen, and the others take too many steps.
    local = max(run.local, CROSSOVER.value) if run.scales.stiff else run.local
    if not run.switched.smooth:
        stretch = march(run.switched, run.states[i], run.t[[i, j]], local, inf, observe)
        return stretch.end, stretch.evaluations
    sizes, evaluations = run.scales.sizes, 0

    def states_at(times: Array, start: Array, record: Callable[[float], None] | None = None) -> Array:
        nonlocal evaluations
        budget = _BUDGET[0] + _BUDGET[1] * float(times[-1] - times[0]) / run.scales.turn
        run_on = integration_of(run.system, run.values, "core", run.scales, run.switched, run.states[0], record)
        try:
            stretch = run_on(start, times, local, False, budget)
        except StopError:  # LSODA may fail by rounding at many output times
            stretch = run_on(start, times, 10 * local, False, budget)
        evaluations += stretch.evaluations
        return stretch.states

    def look(edges: Array, start: Array, halvings: int) -> Array:
        nodes = chebyshev_nodes(edges)
        times, m = np.append(nodes[:, :-1], edges[-1]), nodes.shape[1] - 1
        states = states_at(times, start)
        panels = np.arange(len(nodes))[:, None] * m + np.arange(m + 1)
        values = value(states, times)[0][panels]
        short = np.abs(values).max(1) <= touch
        for k in np.flatnonzero(may_vanish(values, touch) | short | ~np.isfinite(values).all(1)):
            lower, upper = edges[k : k + 2]
            curve, last = interpolant(upper - lower, states[panels[k], : len(sizes)])
            if halvings and (last > max(local, _LEAST) * sizes).any():
                look(np.array([lower, (lower + upper) / 2, upper]), states[panels[k, 0]], halvings - 1)
            else:
                observe(float(lower), 0.0, float(upper - lower), curve)
        return states[-1]

    log: list[float] = []
    states_at(run.t[[i, j]], run.states[i], log.append)
    times, least = np.unique(log), _CLOCK * np.spacing(max(abs(begin), abs(end)))
    edges = times[(times > begin) & (times < end - least)][_STEPS - 1 :: _STEPS]
    edges = edges[np.diff(edges, prepend=begin) > least]
    return look(np.concatenate([[begin], edges, [end]]), run.states[i], _HALVINGS), evaluations


def change(run: SampledMotion, section: sp.Expr) -> float:
    """Return the largest change of a section along the run if each component of the state changes by its size."""
    symbols, sizes = run.system.variables, run.scales.sizes
    if not section.free_symbols & {*symbols, *run.system.c.v, *run.system.c.a, *run.system.multipliers, t}:
        raise InputError(f"crossings: section = {section} does not change: give q, v or t in it")
    if run.system.kinematics is not None:
        moving = [v for v in run.system.c.v if v not in symbols]
        symbols, sizes = (*symbols, *moving), np.append(sizes, [np.abs(run.evaluate(v)).max() for v in moving])
    program = function_program(run.system, *(derivative(section, s) for s in symbols))
    slopes = program.along(run.values)(run.states, run.t)
    return float((np.abs(slopes).T @ sizes).max())
