"""A motion in phases, each smooth: between them velocities jump, gaps close and open, dry friction sticks and slips.

In a phase every sign is constant, sticking friction is a rolling constraint, and a closed gap is a holonomic constraint. The
phase ends when one of its conditions fails: a gap or a sliding velocity reaches zero, or a reaction reaches its bound. These
times are zeros of smooth functions on the solver's own steps, so none depends on the sample times of the run.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
import sympy as sp

from lagrotor.algebra import derivative
from lagrotor.mechanics.equations import Equations, reaction, time_derivative
from lagrotor.mechanics.lagrangian import force_column, gradient, jacobian
from lagrotor.mechanics.running.flow import Array, projection_of
from lagrotor.mechanics.running.narrow_features import NarrowPart, with_followed
from lagrotor.mechanics.running.programs import (
    Generated,
    depends_on_time,
    function_program,
    motion_program,
    parameter_values,
)
from lagrotor.mechanics.running.singular_positions import independence, mass_at, rows_at, unbounded_force
from lagrotor.mechanics.running.switches import Event, Impact, Surface, short, with_impacts, without_jumps
from lagrotor.numerics.error_estimate import perturbed_state
from lagrotor.numerics.pulse import Window, segments, windows_since
from lagrotor.numerics.run import Ending
from lagrotor.numerics.segment import Segment, StopError, Stretch, in_units
from lagrotor.numerics.solver_constants import MOST_EVENTS
from lagrotor.numerics.solvers import dop853_steps
from lagrotor.numerics.zeros import zeros_between

_BESIDE = 1e-7  # of a step: so near to its start no zero is sought, as a condition may have just become true
_FRESH = 0.01  # of the first step of a phase, in which a zero may be a condition that has just become true
_ROUNDINGS = 64.0  # rounding errors of a state that make the noise of a condition
_NOISE = 1e-12  # of the size of a velocity or a reaction, below which it is zero
_STEP = 1e-5  # of a size, by which a component is varied for the size of a function
_AT_ONCE = 20  # events at one time, after which the motion is refused
_SWEEPS = 20_000  # steps of the iteration for the impulses of an impact with friction
_HABIT, _GONE = 8, 1e-8  # impacts whose intervals shrink by one factor; the time to their accumulation over the run
_DEPENDENT = (
    1e-8  # least singular value of the rows of contacts that stick, below which their forces are not determined
)
_SLOPE = 1e-4  # increment for slopes over the sliding speed; an inexact slope shortens the steps of Radau
_FROM_REST = 0.25, 30.0  # Radau ends where the rate is so many times that at rest, and over the time since then
SAFETY = 20.0  # local error of a run over the local error of the steps on which its events are sought


class ContactMode(NamedTuple):
    """The state of all contacts of a motion. Its numbers follow q, v and t in the state of a run.

    Attributes
    ----------
    signs : tuple of int
        The sign of the argument of each surface, 1 or −1; 0 if the surface sticks. Friction in several directions has 1 where it
        slides, and the friction of an impact has 1 while its gap is open.
    closed : tuple of int
        1 for each closed gap, 0 for each open one.
    ended : int
        0 while the motion goes on, otherwise the number, from 1 on, of the ending that stopped it.
    """

    signs: tuple[int, ...]
    closed: tuple[int, ...]
    ended: int = 0

    def with_value(self, component: Literal["signs", "closed"], i: int, value: int) -> "ContactMode":
        """Return the mode with one component replaced by `value`."""
        values: list[int] = [*getattr(self, component)]
        values[i] = int(value)
        changed: dict[str, Any] = {component: tuple(values)}
        return self._replace(**changed)


class Moment(NamedTuple):
    """A state y = (q, v, …) at the time t in s, and the mode of its contacts."""

    y: Array
    t: float
    mode: ContactMode


class Hit(NamedTuple):
    """The end of a phase: the time in s since the start of the phase, and the condition that failed. The condition is given by
    its kind, for example gap or event, and by the index i of its surface, impact or event."""

    since: float
    kind: str
    i: int


@dataclass(frozen=True, eq=False)
class Phase:
    """The motion while no contact changes its state.

    Attributes
    ----------
    system : Equations
        The smooth equations, with sticking surfaces and closed gaps as constraints.
    conditions : tuple
        Tuples (kind, index, expression). The phase lasts until one of the expressions reaches zero. During the phase all of
        them are positive, except the expressions of events, which may have either sign.
    """

    system: Equations
    conditions: tuple[tuple[str, int, sp.Expr], ...]

    @cached_property
    def motion(self) -> Generated:
        return motion_program(self.system)

    @cached_property
    def condition_program(self) -> Generated:
        return function_program(self.system, *(e for _, _, e in self.conditions))


Observer = Callable[[float, float, float, Callable[[Array], Array]], None]


@dataclass(frozen=True, eq=False)
class Switched:
    """A system with events and forces that jump. The smooth part is `system`; a symbol replaces each sign that jumps, and
    `surfaces` says where. A run adds to the last four fields.

    Attributes
    ----------
    scale, sizes : Array
        Scale of the solver for each component of (q, u) and its size, shape (N + m,); sizes are zero before they are
        measured.
    windows : tuple of Window
        Times in which a force changes fast.
    narrow : tuple of NarrowPart
        Narrow terms that are integrated along with the motion.
    phases : dict
        The phases so far, by their sticking surfaces and closed gaps.
    endings : list of Ending
        The endings so far, to which `ContactMode.ended` refers.
    hidden : list of tuple
        Intervals of time in s in which a step may hide an event.
    accumulations : dict
        Times in s at which infinitely many impacts accumulate, by the index of the impact.
    """

    system: Equations
    values: Mapping[Any, Any]
    surfaces: tuple[Surface, ...]
    events: tuple[Event | Impact, ...]
    scale: Array
    sizes: Array
    windows: tuple[Window, ...] = ()
    narrow: tuple[NarrowPart, ...] = ()
    phases: dict[tuple[Any, ...], Phase] = field(default_factory=dict)
    endings: list[Ending] = field(default_factory=list)
    hidden: list[tuple[float, float]] = field(default_factory=list)
    accumulations: dict[int, float] = field(default_factory=dict)

    @property
    def n(self) -> int:
        return len(self.system.c.q)

    @property
    def size(self) -> int:
        """The number of components of q, u and the first-order states."""
        return len(self.system.variables)

    @property
    def moving(self) -> slice:
        """The place of the velocities u in a state."""
        return slice(self.n, self.n + len(self.system.speeds))

    @property
    def smooth(self) -> bool:
        """True if the system has no events and no force that jumps."""
        return not (self.surfaces or self.events)

    @property
    def without_planar(self) -> Equations:
        """The system without friction in several directions, which near rest is no narrow feature: a phase ends there."""
        still = {s.sign: sp.S.Zero for s in self.surfaces if s.metric is not None}
        return (
            replace(self.system, forces=tuple(e.xreplace(still) for e in self.system.forces)) if still else self.system
        )

    @property
    def slipping(self) -> ContactMode:
        return ContactMode((1,) * len(self.surfaces), (0,) * len(self.impacts))

    @property
    def impacts(self) -> tuple[Impact, ...]:
        return tuple(e for e in self.events if isinstance(e, Impact))

    def acts(self, i: int, mode: ContactMode) -> bool:
        """Return False for the friction of an impact while its gap is open."""
        impact = self.surfaces[i].impact
        return impact is None or mode.closed[impact] == 1

    def slide(self, i: int, at: Moment) -> tuple[float, float]:
        """Return the argument w of a surface, or the sliding speed √Q if it has several directions, and the size of it."""
        s = self.surfaces[i]
        if s.metric is None:
            (w,) = self.evaluate(self.system, [s.argument], at)
            return float(w), float(self.sizes_of(self.system, [s.argument], at)[0])
        units = [w / sp.sqrt(s.metric[k, k]) for k, w in enumerate(s.slips)]
        (square,) = self.evaluate(self.system, [s.square], at)
        return float(np.sqrt(square)), float(self.sizes_of(self.system, units, at).max())

    def mode(self, state: Array) -> ContactMode:
        numbers = tuple(int(x) for x in np.rint(state[self.size + 1 :]))
        signs = len(self.surfaces)
        return ContactMode(numbers[:signs], numbers[signs:-1], numbers[-1])

    def state(self, y: Array, time: float, mode: ContactMode) -> Array:
        """Return (q, v, t, mode) in one array, from which a run can be continued."""
        return np.concatenate([y[: self.size], [time], mode.signs, mode.closed, [mode.ended]])

    def evaluate(self, system: Equations, expressions: Sequence[sp.Expr], at: Moment) -> Array:
        program = function_program(system, *expressions)
        return program.along(self.numbers(at.mode))(at.y[None], np.array([at.t]))[:, 0]

    def sizes_of(self, system: Equations, expressions: Sequence[sp.Expr], at: Moment) -> Array:
        """Return the size of each of k expressions at one moment, shape (k,). It is the sum over all components y_j of |∂e/∂y_j|
        times the size of y_j."""
        y = at.y[: self.size]
        steps = np.diag(_STEP * np.maximum(np.abs(y), self.sizes))
        values = function_program(system, *expressions).along(self.numbers(at.mode))(
            np.vstack([y + steps, y - steps]), np.full(2 * self.size, at.t)
        )
        with np.errstate(all="ignore"):
            sizes = np.abs(values[:, : self.size] - values[:, self.size :]).sum(1) / (2 * _STEP)
        return np.asarray(np.nan_to_num(sizes, posinf=0.0))

    def numbers(self, mode: ContactMode) -> dict[str, Any]:
        """Return the values of the parameters, and of the signs of all surfaces in this mode, by name."""
        if not isinstance(self.values, Mapping):
            return self.values  # `parameter_values` will refuse it
        signs = zip(self.surfaces, mode.signs, strict=True)
        return {str(k): v for k, v in self.values.items()} | {str(s.sign): float(sign) for s, sign in signs}

    def phase(self, mode: ContactMode) -> Phase:
        """Return the phase in which every contact stays in the state that the mode gives. Slip to either side has the same
        equations, since the sign of a slipping surface is a parameter."""
        sticking = tuple(i for i, sign in enumerate(mode.signs) if sign == 0 and self.acts(i, mode))
        key = (sticking, mode.closed)
        if key not in self.phases:
            self.phases[key] = self._phase(*key)
        return self.phases[key]

    def _phase(self, sticking: tuple[int, ...], closed: tuple[int, ...]) -> Phase:
        base, still = self.system, {self.surfaces[i].sign: sp.S.Zero for i in sticking}
        held = {i: self.surfaces[i].slips or (self.surfaces[i].argument,) for i in sticking}
        gaps = [i for i, state in enumerate(closed) if state]
        labels, h = base.multiplier_names, len(base.constraints)
        directions = [f"held {i + 1}" + "′" * k for i, slips in held.items() for k in range(len(slips))]
        names = (*labels[:h], *(f"gap {i + 1}" for i in gaps), *labels[h:], *directions)
        forces = force_column(base.forces or None, base.c, "System")
        for i, s in enumerate(self.surfaces):
            if i in held and s.bound is None:  # the sign that keeps w at zero acts in place of the reaction Gᵀ λ
                sign = reaction(f"held {i + 1}")
                above, below = (forces.xreplace({s.sign: side}) for side in (sp.S.One, -sp.S.One))
                forces = (above + below + sign * (above - below)) / 2 - sign * gradient(s.argument, base.c.v)
            elif i not in held and s.impact in gaps:
                forces += s.force(base.c)
        system = Equations(
            base.c,
            base.lagrangian.xreplace(still),
            (*base.constraints, *(self.impacts[i].gap for i in gaps)),
            (*base.rolling, *(w.xreplace(still) for slips in held.values() for w in slips)),
            base.dissipation.xreplace(still),
            tuple(forces.xreplace(still)) if base.c.q else (),
            names,
            velocities=base.velocities,
            states=base.states,
        )
        lam, first = system.multipliers, len(base.constraints)
        conditions: list[tuple[str, int, sp.Expr]] = []
        pressing = {*base.multipliers, *(reaction(f"gap {i + 1}") for i in gaps)}
        sizes = {s.sign for s in self.surfaces if s.argument.free_symbols & pressing}  # of reactions, by |λ|
        at = len(lam) - len(directions)
        for i, s in enumerate(self.surfaces):
            if i in held:
                reactions, at = sp.Matrix(lam[at : at + len(held[i])]), at + len(held[i])
                bound = s.bound.xreplace(still) if s.bound is not None else sp.S.One
                if s.metric is None:
                    conditions += [("above", i, bound - reactions[0]), ("below", i, bound + reactions[0])]
                else:
                    conditions.append(("cone", i, bound - sp.sqrt((reactions.T * s.metric * reactions)[0])))
            elif s.impact is None or s.impact in gaps:
                slides = s.sign * s.argument if s.metric is None else s.square - s.least**2
                conditions.append(("surface", i, slides))
                if s.bound is not None and s.bound.free_symbols & pressing and not s.bound.free_symbols & sizes:
                    conditions += [("pull", i, s.bound)] if s.impact is None else []
        for i, impact in enumerate(self.impacts):
            if not closed[i]:
                conditions.append(("gap", i, impact.gap))
            else:
                conditions.append(("reaction", i, lam[first + gaps.index(i)]))
        conditions += [("event", i, e.section) for i, e in enumerate(self.events) if isinstance(e, Event)]
        return Phase(system, tuple(conditions))


def with_events(system: Equations, values: Mapping[Any, Any], events: tuple[Event | Impact, ...] = ()) -> Switched:
    """Return the system with its events. A sign symbol and a surface replace each jump of its forces."""
    smooth, surfaces = without_jumps(system)
    size = len(system.variables)
    surfaces += with_impacts(smooth, [e for e in events if isinstance(e, Impact)])
    return Switched(smooth, values, surfaces, events, np.ones(size), np.zeros(size))


def begin(h: Switched, y: Array, time: float) -> Array:
    """Return the initial state (y, t, mode), y = (q, v, …). Each surface has the sign of its velocity, and all gaps are open
    except those at rest on zero."""
    start = Moment(y, time, h.slipping)
    try:
        mode = _settle(h, start)
    except StopError as stop:
        mode = _end(h, start.mode, Ending(stop.cause, time, stop.reason))
    return h.state(start.y, time, mode)


def march(
    h: Switched,
    start: Array,
    times: Array,
    local: float,
    budget: float,
    observe: Observer | None = None,
    companion: bool = False,
) -> Stretch:
    """Integrate from `start`, the state (q, v, t, mode) at times[0]. Return the states at the times, and the times of jumps. Time
    is counted from the start, since far from zero the clock would round the time of each event. After an event that ends the
    motion, its state and time are repeated. For each step, `observe` is called with the time at which its phase began. It also
    gets the beginning and the end of the step, counted from then, and the dense output. A companion is the second run of an error
    estimate; it takes other steps in narrow terms and brief windows."""
    clock, since = float(start[h.size]), times - times[0]
    end, y, now, mode, evaluations = float(since[-1]), start[: h.size], 0.0, h.mode(start), 0
    if mode.ended:
        return Stretch(np.repeat(start[None], len(times), axis=0), start, 0)
    blocks, jumps, history, habit = [start[None]], list[float](), dict[tuple[str, int], list[float]](), 0.0

    def add(states: Array) -> None:
        later = times[since > now]
        blocks.append(
            np.array([h.state(y, t, mode) for y, t in zip(states, later, strict=False)]).reshape(-1, len(start))
        )

    while now < end and not mode.ended:
        try:
            later = since[since > now] - now
            unused = budget - evaluations
            stretch, hit = _smooth(h, y, clock + now, mode, later, local, unused, observe, habit, companion)
        except StopError as stop:
            reached = stop.reached or Stretch(np.empty((0, h.size)), y, 0)
            add(reached.states)
            last = h.state(reached.end, clock + now + stop.at, mode)
            so_far = Stretch(np.concatenate(blocks), last, evaluations + stop.evaluations, tuple(jumps))
            raise StopError(clock + now + stop.at, stop.reason, so_far, cause=stop.cause) from None
        evaluations += stretch.evaluations
        add(stretch.states)
        y = stretch.end[: h.size]
        if hit is None:
            now = end
            break
        now += hit.since
        past = history.setdefault(hit[1:], [])
        past.append(now)
        habit = past[-1] - past[-2] if len(past) > 1 else 0.0
        try:
            gone = _accumulating(history, past, end, clock)
            y, _, mode = _switch(h, Moment(y, clock + now, mode), hit, gone)
        except StopError as stop:
            mode, now = _end(h, mode, Ending(stop.cause, stop.at, stop.reason.rstrip("."))), stop.at - clock
        if hit.kind in ("gap", "event"):
            jumps.append(clock + now)
    last = h.state(y, clock + now, mode)
    length = sum(map(len, blocks))
    blocks.append(np.repeat(last[None], len(times) - length, axis=0))
    return Stretch(np.concatenate(blocks), last, evaluations, tuple(jumps))


def _end(h: Switched, mode: ContactMode, ending: Ending) -> ContactMode:
    """Record an ending and return the mode that refers to it. Endings of the same kind and reason share one entry."""
    same = [i for i, earlier in enumerate(h.endings) if (earlier.kind, earlier.reason) == (ending.kind, ending.reason)]
    if not same:
        h.endings.append(ending)
    return mode._replace(ended=1 + (same[0] if same else len(h.endings) - 1))


def _smooth(
    h: Switched,
    y: Array,
    now: float,
    mode: ContactMode,
    times: Array,
    local: float,
    budget: float,
    observe: Observer | None,
    habit: float,
    companion: bool,
) -> tuple[Stretch, Hit | None]:
    """Integrate one phase until its first condition fails, or to the last time. Return the motion, and the `Hit` or None. `habit`
    is the time in s between the last two events of the same kind."""
    phase, numbers = h.phase(mode), h.numbers(mode)
    system, scale = phase.system, h.scale
    y, increment = _begin_sliding(h, y, now, mode, local, times[-1], numbers)
    if depends_on_time(system):
        y, scale = np.append(y, now), np.append(scale, 1.0)
    motion = motion_program(system, h.narrow)
    y, scale = np.append(y, np.zeros(len(h.narrow))), with_followed(scale, h.narrow, local / SAFETY, companion)
    project = projection_of(system, numbers) if system.multipliers else None
    y = y if project is None else project(y)
    watch = phase.condition_program.along(numbers)

    rhs = motion.rate(parameter_values(motion, numbers), now)
    segment = in_units(Segment(rhs, y, 0.0, times[-1], times, np.inf, budget, project), scale)
    # From rest, the direction of sliding follows the force at a rate that is the higher the slower it slides.
    blocks, count, solver = [np.empty((0, len(y)))], 0, None
    try:
        for solver in _steps(segment, windows_since(now, h.windows, companion), local / SAFETY, increment):
            begin, end_of_step, dense = solver.t_old, solver.t, solver.dense_output()

            def curve(s: Array, dense: Any = dense) -> Array:
                return np.asarray(dense(s).T * scale)

            def conditions(s: Array, curve: Any = curve) -> Array:
                return watch(curve(s), now + s)

            hit = None
            if phase.conditions:
                ends, at = np.array([dense.y_old, solver.y]) * scale, np.array([now + begin, now + end_of_step])
                values, perturbed = watch(ends, at), watch(perturbed_state(ends, _ROUNDINGS), at)
                by_clock = np.abs(np.diff(values)[:, 0]) * _ROUNDINGS * np.spacing(end_of_step) / (end_of_step - begin)
                rounding = np.abs(perturbed - values).max(1) + by_clock
                hit, hidden = _first(h, phase, conditions, begin, end_of_step, habit, rounding)
                h.hidden.extend((now + a, now + b) for a, b in hidden)
            until = end_of_step if hit is None else hit.since
            if observe is not None:
                observe(now, begin, until, curve)
            reached = int(np.searchsorted(times, until, side="right"))
            if reached > count:
                blocks.append(curve(times[count:reached]))
                count = reached
            if hit is not None:
                y = curve(np.array([until]))[0]
                return Stretch(np.concatenate(blocks), y if project is None else project(y), solver.nfev), hit
    except StopError as stop:
        end = stop.reached.end * scale if stop.reached else y
        so_far = Stretch(np.concatenate(blocks), end, stop.evaluations)
        words = unbounded_force(system, numbers, y, end, h.sizes) if stop.cause == "stopped" and h.sizes.all() else ""
        raise StopError(stop.at, words or stop.reason, so_far, cause="singular" if words else stop.cause) from None
    assert solver is not None  # a phase that is begun has a length
    return Stretch(np.concatenate(blocks), solver.y * scale, solver.nfev), None


def _steps(segment: Segment, windows: Sequence[Window], error: float, stiff: float) -> Iterator[Any]:
    """Yield the solver after each step of DOP853, whose steps are bounded in the windows. A motion that is stiff at first begins
    with Radau, with the increment `stiff` for slopes. The `nfev` of the solver counts all evaluations of the segment so far."""
    y, nfev, at_rest = segment.start, 0, 0.0
    for begin, until, longest in segments(segment.begin, segment.until, windows):
        while begin < until:
            piece = replace(segment, start=y, begin=begin, until=until, longest=longest, budget=segment.budget - nfev)
            try:
                for solver in dop853_steps(piece, error, stiff):
                    solver.nfev += nfev
                    yield solver
                    solver.nfev -= nfev
                    if stiff:
                        rate = float(np.linalg.norm(solver.J, 2))
                        at_rest = at_rest or rate
                        since = solver.t - segment.begin
                        if rate < min(_FROM_REST[0] * at_rest, _FROM_REST[1] / since):
                            stiff = 0.0
                            break
            except StopError as stop:
                stop.evaluations += nfev
                raise
            solver.nfev += nfev
            begin, nfev = solver.t, solver.nfev
            y = segment.project(solver.y) if segment.project else solver.y


def _first(
    h: Switched, phase: Phase, conditions: Any, lower: float, upper: float, habit: float, noise: Array
) -> tuple[Hit | None, list[tuple[float, float]]]:
    """Return the first condition of a phase that fails within a step, or None, and the intervals in which one may be hidden.
    Times count from the start of the phase. The rounding error of each condition is `noise` (k,)."""
    begun = lower > 0
    # The next of accumulating impacts is near to the start of a step, whose size the motion between them determines.
    soon = 4 * habit if not begun and 0 < 4 * habit < upper else lower
    start = lower if begun else _BESIDE * (soon or upper)
    intervals = [zeros_between(conditions, a, b, noise=noise) for a, b in ((lower, soon), (soon, upper)) if b > a]
    hidden = [interval.hidden for interval in intervals if interval.hidden]
    hits = []
    for interval in intervals:
        for s, k, way in zip(interval.t, interval.index, interval.direction, strict=True):
            kind, i, _ = phase.conditions[k]
            event = h.events[i] if kind == "event" else None
            direction = event.direction if isinstance(event, Event) else -1
            # A condition that starts at zero may touch zero again by rounding; then it is true at twice the time.
            rounding = not begun and s < _FRESH * upper and event is None and conditions(np.array([2 * s]))[k, 0] > 0
            if s > start and direction in (0, way) and not rounding:
                hits.append(Hit(polish(conditions, int(k), float(s), lower, upper), kind, i))
    if (
        not begun and not hits
    ):  # seek a condition that is false from the start on, although rounding may hide it at first
        early, late = conditions(np.array([10 * start, upper])).T
        for k, (kind, i, _) in enumerate(phase.conditions):
            if kind != "event" and late[k] < -max(_NOISE * abs(early[k]), noise[k]) and early[k] <= noise[k]:
                return Hit(0.0, kind, i), hidden
    return min(hits, default=None), hidden


def polish(functions: Any, k: int, t: float, lower: float, upper: float) -> float:
    """Refine the zero t of function number k by the secant method, to the last digit of the dense output."""
    second = min(t + 1e-5 * (upper - lower), upper) if t < upper else t - 1e-5 * (upper - lower)
    f, g = functions(np.array([t, second]))[k]
    for _ in range(4):
        if f == g or f == 0:
            break
        following = float(np.clip(t - f * (t - second) / (f - g), lower, upper))
        (value,) = functions(np.array([following]))[k]
        if abs(value) >= abs(f):
            break
        second, g, t, f = t, f, following, value
    return t


def _switch(h: Switched, at: Moment, hit: Hit, gone: float | None) -> Moment:
    """Return the state and the mode after an event. `gone` is the time in s after which infinitely many such events are over;
    None if they do not accumulate."""
    kind, i = hit.kind, hit.i
    mode, v = at.mode, at.y[h.moving]
    if kind == "surface" and h.surfaces[i].argument.free_symbols & {*h.system.multipliers}:
        mode = mode.with_value("signs", i, -mode.signs[i])  # a reaction is reversed
    elif kind == "surface":
        mode = mode.with_value("signs", i, _sign_beyond(h, at, i) if h.surfaces[i].metric is None else 0)
    elif kind == "cone":
        mode = mode.with_value("signs", i, 1)
    elif kind == "pull":
        raise StopError(
            at.t,
            f"{short(h.surfaces[i].bound)} becomes negative: the rubbing contact would pull, and opens or touches on its "
            "other side; a guide that holds on both sides rubs by |reaction(…)|",
        )
    elif kind in ("above", "below"):
        mode = mode.with_value("signs", i, -1 if kind == "above" else 1)
    elif kind == "reaction":
        mode = mode.with_value("closed", i, False)
    elif kind == "gap":
        e = float(h.evaluate(h.system, [h.impacts[i].restitution], at)[0])
        if gone is not None:
            e = 0.0
            h.accumulations[i] = at.t + gone
        v, gentle = _rebound(h, at, i, e)
        mode = mode.with_value("closed", i, e == 0 or gentle)
    else:
        event = h.events[i]
        assert isinstance(event, Event)
        if gone is not None:
            raise StopError(at.t + gone, "infinitely many events accumulate there", cause="event")
        if event.velocities is None:
            raise StopError(at.t, f"{event.section} = 0", cause="event")
        v = h.evaluate(h.system, event.velocities, at)
    if not np.isfinite(v).all():
        raise StopError(at.t, "the velocities after an event are not finite")
    moment = Moment(np.concatenate([at.y[: h.n], v, at.y[h.moving.stop : h.size]]), at.t, mode)
    return moment._replace(mode=_settle(h, moment, fixed=kind in ("above", "below", "surface", "cone")))


def _rebound(h: Switched, at: Moment, i: int, e: float) -> tuple[Array, bool]:
    """Return the velocities (m,) after impact i, and True if the velocity of approach was zero. The impulse Λ obeys M Δv = Gᵀ Λ,
    and the gap opens with e times the velocity of approach."""
    rubs = [k for k, s in enumerate(h.surfaces) if s.impact == i]
    mode = at.mode.with_value("closed", i, True)
    mode = mode._replace(signs=tuple(0 if k in rubs else s or 1 for k, s in enumerate(mode.signs)))
    system = h.phase(mode).system
    speeds = h.evaluate(system, [system.residual[k] for k in system.left], at._replace(mode=mode))
    row = system.left.index(len(h.system.constraints) + sum(mode.closed[:i]))
    G, W = _rows(h, system, at._replace(mode=mode))
    change = -speeds
    gentle = speeds[row] > -_NOISE * float(np.abs(G[row]) @ h.scale[h.moving])
    change[row] *= 1 if gentle else 1 + e
    impulse = np.linalg.lstsq(G @ W, change, rcond=None)[0]
    if rubs:
        (mu,) = h.evaluate(h.system, [h.impacts[i].friction], at)
        tangents = slice(len(change) - len(h.impacts[i].slip), None)
        impulse = _coulomb_impulse(G @ W, change, row, tangents, float(mu), at.t)
        work = impulse @ (2 * speeds + G @ W @ impulse) / 2
        if work > _NOISE * (np.abs(impulse) @ np.abs(speeds)):
            raise StopError(
                at.t,
                f"Newton's restitution and friction would raise the energy by {work:.3g} J in an impact on "
                f"{short(h.impacts[i].gap)} (Kane's paradox): take a smaller restitution, or give Event(velocities=…)",
            )
    return np.asarray(at.y[h.moving] + W @ impulse), bool(gentle)


def _rows(h: Switched, system: Equations, at: Moment) -> tuple[Array, Array]:
    """Return the rows G of the constraints of a phase, shape (k, m), and W = M⁻¹ Gᵀ."""
    numbers, state = h.numbers(at.mode), np.append(at.y[: h.size], at.t)
    G = rows_at(system, numbers, state)
    return G, np.asarray(np.linalg.solve(mass_at(system, numbers, state), G.T))


def _coulomb_impulse(D: Array, change: Array, row: int, tangents: slice, mu: float, at: float) -> Array:
    """Return the impulses Λ (k,) with D Λ = change in all rows but the tangents. There the sliding velocity after the impact,
    s⁺ = D Λ − change, is zero and |Λ_t| ≤ μ Λ_n, or Λ_t = −μ Λ_n s⁺/|s⁺|. The iteration projects Λ_t onto the cone."""
    first = tangents.start
    inner = np.linalg.pinv(D[:first, :first])
    base, coupling = inner @ change[:first], inner @ D[:first, first:]
    S, s = D[first:, first:] - D[first:, :first] @ coupling, D[first:, :first] @ base - change[first:]
    length, push = np.linalg.norm(S, 2), np.zeros(len(change) - first)
    if length <= _NOISE * np.linalg.norm(D[first:, first:], 2):  # what else is closed determines the sliding velocity
        return np.concatenate([base, push])
    for _ in range(_SWEEPS):
        pressure = mu * max(base[row] - coupling[row] @ push, 0.0)
        wanted = push - (s + S @ push) / length
        wanted *= min(1.0, pressure / (np.linalg.norm(wanted) or 1.0))
        settled = np.abs(wanted - push).max() <= 1e-15 * np.abs(wanted).max()
        push = wanted
        if settled:
            return np.concatenate([base - coupling @ push, push])
    raise StopError(at, "friction jams an impact: no impulse obeys Newton's and Coulomb's laws")


def _begin_sliding(
    h: Switched, y: Array, now: float, mode: ContactMode, local: float, duration: float, numbers: dict[str, Any]
) -> tuple[Array, float]:
    """Return the state at the beginning of a phase with friction in several directions, and the increment of velocities for the
    slopes if one slides from rest, otherwise 0. Put the speeds that count as zero into `numbers`."""
    increment = 0.0
    for i, s in enumerate(h.surfaces):
        if s.metric is not None and mode.signs[i] and h.acts(i, mode):
            try:
                y, numbers[str(s.least)], at_rest = _sliding(h, Moment(y, now, mode), i, local, duration)
            except StopError as stop:
                raise StopError(0.0, stop.reason) from None  # counted from the beginning of the phase
            if at_rest:
                increment = _SLOPE * numbers[str(s.least)] / float(h.scale[h.moving].max())
    return y, increment


def _sliding(h: Switched, at: Moment, i: int, local: float, duration: float) -> tuple[Array, float, bool]:
    """Return the state at the beginning of a phase in which friction in several directions slides, the sliding speed that counts
    as zero, the local error, and True if the surface was at rest. Then it gets twice this speed, against the force that would
    hold it."""
    s = h.surfaces[i]
    assert s.metric is not None
    speed, size = h.slide(i, at)
    if speed >= 2 * local * size > 0:
        return at.y, local * size, False
    mode = at.mode
    for k, other in enumerate(h.surfaces):  # other friction that begins to slide from rest has no direction yet, either
        if k == i or (other.metric is not None and mode.signs[k] and h.acts(k, mode) and h.slide(k, at)[0] == 0):
            mode = mode.with_value("signs", k, 0)
    system, count = h.phase(mode).system, len(s.slips)
    held = slice(*(len(system.multipliers) - np.array([count, 0]) - _after(h, mode, i)))
    moment = at._replace(mode=mode)
    _check_held(h, moment)
    G, W = _rows(h, system, moment)
    rows = [system.left.index(k) for k in range(held.start, held.stop)]
    entries = h.evaluate(
        system, [*system.multipliers[held], *s.metric, *(system.residual[k] for k in system.left)], moment
    )
    force, metric, change = (
        entries[:count],
        entries[count : count + count**2].reshape(count, count),
        -entries[count + count**2 :],
    )
    hold = np.sqrt(force @ metric @ force)
    if hold == 0:
        raise StopError(at.t, f"the bound {short(s.bound)} of dry friction is negative")
    if not size:  # all at rest, before sizes are known
        pull = (G @ W)[np.ix_(rows, rows)] @ force
        size = local * duration * np.sqrt(abs(pull @ np.linalg.solve(metric, pull)))
    change[rows] -= 2 * local * size * metric @ force / hold
    y = at.y.copy()
    y[h.moving] += W @ np.linalg.lstsq(G @ W, change, rcond=None)[0]
    return y, local * size, True


def _check_held(h: Switched, at: Moment) -> None:
    """Raise StopError if several contacts stick in velocities that depend on each other."""
    system, state = h.phase(at.mode).system, np.append(at.y[: h.size], at.t)
    if at.mode.signs.count(0) < 2:
        return
    least = independence(system, h.numbers(at.mode), state[None])[0]
    if len(system.left) > len(system.speeds) or least < _DEPENDENT:
        way = "give friction to fewer contacts of a body"
        raise StopError(
            at.t, f"contacts that stick hold the same velocities, and their friction is not determined: {way}"
        )


def _after(h: Switched, mode: ContactMode, i: int) -> int:
    """Return the number of sliding velocities that stick and belong to surfaces after surface i."""
    return sum(len(s.slips) or 1 for k, s in enumerate(h.surfaces) if k > i and mode.signs[k] == 0 and h.acts(k, mode))


def _sign_beyond(h: Switched, at: Moment, i: int) -> int:
    """Return the sign of the argument w of surface i after w = 0, from the rates of w on both sides (Filippov). Return 0 if both
    rates lead back to w = 0, so that the surface sticks."""
    argument = h.surfaces[i].argument
    above, below = _rates_beside(h, at, i, 1)
    if not argument.free_symbols & {*h.system.c.v} and max(abs(above), abs(below)) <= _NOISE * float(
        h.sizes_of(h.system, [time_derivative(h.system, argument)], at)[0]
    ):
        above, below = _rates_beside(h, at, i, 2)  # of a place, passed at rest
    size = _NOISE * (abs(above) + abs(below))
    if abs(above - below) <= size:  # no jump here
        return 1 if above > 0 else -1 if above < 0 else at.mode.signs[i] or 1
    if above > size and below >= -size:
        return 1
    if below < -size and above <= size:
        return -1
    if above > size and below < -size:
        raise StopError(at.t, f"on {short(argument)} = 0 the motion may continue to either side")
    if h.surfaces[i].bound is None and not h.surfaces[i].slips:
        way = "it must be affine in velocities, and only forces may jump there"
        raise StopError(at.t, f"the motion stays on {short(argument)} = 0, which is not followed: {way}")
    return 0


def _rates_beside(h: Switched, at: Moment, i: int, order: int) -> tuple[float, float]:
    """Return the first or second time derivative of the argument w of surface i, above and below the surface."""

    def rate(sign: int) -> float:
        mode, e = at.mode.with_value("signs", i, sign), h.surfaces[i].argument
        system = h.phase(mode).system
        for _ in range(order):
            e = time_derivative(system, e)
        return float(h.evaluate(system, [e], at._replace(mode=mode))[0])

    return rate(1), rate(-1)


def _settle(h: Switched, at: Moment, fixed: bool = False) -> ContactMode:
    """Find a contact mode that agrees with the state and its reactions. If `fixed` is true, an event has decided the signs, and
    they are not taken from the velocities."""
    mode = at.mode
    if h.surfaces and not fixed:
        slides = [h.slide(i, at) for i in range(len(h.surfaces))]
        at_zero = [abs(w) <= _NOISE * size for w, size in slides]
        for i in np.argsort(at_zero, kind="stable").tolist():
            sign = int(np.sign(slides[i][0]))
            if at_zero[i]:
                planar = h.surfaces[i].metric is not None
                sign = int(not h.acts(i, mode)) if planar else _sign_beyond(h, at._replace(mode=mode), i)
            mode = mode.with_value("signs", i, sign)
    for _ in range(2 * (len(mode.signs) + len(mode.closed)) + 1):
        phase = h.phase(mode)
        reactions = [
            condition for condition in phase.conditions if condition[0] in ("above", "below", "cone", "reaction")
        ]
        if not reactions:
            break
        expressions, moment = [e for *_, e in reactions], at._replace(mode=mode)
        _check_held(h, moment)
        for i, s in enumerate(h.surfaces):
            if s.metric is not None and mode.signs[i] and h.acts(i, mode):
                moment = moment._replace(y=_sliding(h, moment, i, _NOISE, 1.0)[0])
        values = h.evaluate(phase.system, expressions, moment)
        worst = int(np.argmin(values))
        size = np.abs(values).max() if len(values) > 1 else 0.0
        if values[worst] >= -_NOISE * (size + float(h.sizes_of(phase.system, expressions, moment)[worst])):
            break
        kind, i, _ = reactions[worst]
        change: tuple[Any, int] = ("closed", 0) if kind == "reaction" else ("signs", -1 if kind == "above" else 1)
        mode = mode.with_value(change[0], i, change[1])
    return mode


def _accumulating(history: Mapping[Any, list[float]], past: list[float], span: float, clock: float) -> float | None:
    """Return the time in s until infinitely many events are over, if it is negligible beside the duration `span`; None otherwise.
    It follows from intervals that shrink by a constant factor. The time at the start is `clock`. Raise StopError for too many
    events."""
    now = past[-1]
    if len(past) > _HABIT:
        intervals = np.diff(past[-_HABIT - 1 :])
        ratio = intervals[-1] / intervals[-2] if intervals[-2] > 0 else 1.0
        remaining = intervals[-1] * ratio / (1 - ratio) if ratio < 1 else np.inf
        if (np.diff(intervals) < 0).all() and remaining <= _GONE * span:
            return float(remaining)
    if len(past) > _AT_ONCE and now - past[-_AT_ONCE] <= 1e-13 * now:
        raise StopError(clock + now, "events follow each other without time between them")
    if sum(map(len, history.values())) > MOST_EVENTS.value:
        raise StopError(clock + now, f"the run did not end within {MOST_EVENTS.value:,} events", cause="budget")
    return None


def evaluate(h: Switched, expression: sp.Expr, times: Array, states: Array) -> Array:
    """Evaluate an expression along a motion in phases, shape (n,). Its accelerations and multipliers are those of each phase. The
    sign of a sticking surface is its friction force divided by the bound."""
    c, values = len(h.system.constraints), np.empty(len(times))
    modes = [h.mode(state) for state in states]
    for mode in dict.fromkeys(modes):
        in_mode = np.array([state_mode == mode for state_mode in modes])
        phase = h.phase(mode)
        lam, closed = phase.system.multipliers, sum(mode.closed)
        substitutions: dict[sp.Expr, sp.Expr] = {
            name: lam[i if i < c else i + closed] for i, name in enumerate(h.system.multipliers)
        }
        sticking = [s for s, sign in zip(h.surfaces, mode.signs, strict=True) if sign == 0]
        at, e = len(lam) - sum(len(s.slips) or 1 for s in sticking), expression
        for s in sticking:
            forces, at = lam[at : at + (len(s.slips) or 1)], at + (len(s.slips) or 1)
            ratio = forces[0] if s.bound is None else -forces[0] / s.bound
            if s.metric is None:
                for w, holding in ((s.argument, ratio), (sp.expand(-s.argument), -ratio)):
                    substitutions |= {sp.sign(w): holding, sp.Abs(w): sp.S.Zero}
            else:
                e = _held(e, s, forces, h)
        program = function_program(phase.system, e.xreplace(substitutions))
        values[in_mode] = program.along(h.numbers(mode))(states[in_mode], times[in_mode])[0]
    return values


def _held(e: sp.Expr, s: Surface, forces: Sequence[sp.Symbol], h: Switched) -> sp.Expr:
    """Return an expression in a phase where friction in several directions sticks. There √Q = 0, and the holding force over the
    bound F replaces w/√Q: w = A_p (v − v₀) becomes −A_pp λ/F."""
    unit, v = sp.Dummy("unit"), h.system.c.v
    e = e.xreplace({1 / sp.sqrt(s.argument): unit, sp.sqrt(s.argument): sp.S.Zero})
    if unit not in e.free_symbols:
        return e
    assert s.metric is not None and s.bound is not None
    rows, slope = jacobian(list(s.slips), v), gradient(derivative(e, unit), v).T
    ratio = slope * rows.T * (rows * rows.T).inv() * s.metric * sp.Matrix(forces) / s.bound
    return e.xreplace({unit: sp.S.Zero}) - ratio[0]
