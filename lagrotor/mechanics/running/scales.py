"""The scales of a motion and its conserved quantities, by which errors of a run are measured in any units.

Jacobi's integral and the momenta of cyclic coordinates are checked while a motion is run. A run that does not conserve them
within its error estimate is refused. Constraints need no such check, since each state is projected onto them.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.algebra import decide_zero, derivative
from lagrotor.errors import InputError
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.expressions import longer, put_in
from lagrotor.mechanics.running.flow import Array, Rhs, Values, smooth_motion
from lagrotor.mechanics.running.narrow_features import NarrowPart
from lagrotor.mechanics.running.programs import (
    Generated,
    clock_program,
    depends_on_time,
    energy_program,
    function_program,
    motion_program,
    parameter_values,
    velocities_along,
)
from lagrotor.mechanics.symmetry import cyclic_coordinates
from lagrotor.numerics.pulse import Window, brief_windows
from lagrotor.numerics.segment import Integrate, Segment, StopError, Stretch
from lagrotor.numerics.solvers import dop853, lsoda

_COARSE, _EVALUATIONS = 1e-3, 4_000  # local error and budget of the survey of a motion
_PEAK = 100.0  # a component over its median, beyond which it does not count for its size
_AT_REST = 1e-10  # median over the largest value of a component, below which it was at rest
_PER_TURN = 50  # evaluations of the survey per turn
_STIFF = 30.0  # rate at which neighbouring motions approach each other, times the duration
_LOST = 1e-12  # velocity over the largest, below which it does not change the energy in a double
_ROUNDING = 1e-14  # position over the largest, below which it is rounding of the others under constraints
_OVERFLOWS = 1e75  # a number whose fourth power overflows
_QUIET = 1e-3  # least velocity over the velocity that all kinetic energy would give a coordinate
_WRITTEN = 600  # operations of a Lagrangian up to which its cyclic coordinates are sought
_STEP = 1e-5  # of a size, by which a component is varied for the slope of an integral


@dataclass(frozen=True, eq=False)
class Scales:
    """The typical period `turn` in s and the size of each component of (q, u), shape (N + m,), of a motion. A size is the largest
    value, or the value that a thousandth of the velocity with all kinetic energy would give, if that is larger. In a stiff motion
    neighbouring motions approach each other so fast that a stiff method may be used. The states that were measured are `survey`
    (m, d). In the windows a force changes fast."""

    turn: float
    sizes: Array
    evaluations: int
    stiff: bool = False
    windows: tuple[Window, ...] = ()
    survey: Array = field(default_factory=lambda: np.empty((0, 0)))

    def distance(self, first: Array, second: Array) -> Array:
        """Return the distance of two runs, states (n, d) each, at each time, shape (n,). It is the largest difference of a
        component divided by the component's size, at most 2."""
        size = len(self.sizes)
        sizes = np.maximum(self.sizes, np.abs(second[:, :size]))
        return np.asarray(np.minimum((np.abs(first[:, :size] - second[:, :size]) / sizes).max(1), 2.0))


def clock_windows(system: Equations, values: Values, times: Array) -> tuple[Window, ...]:
    """Find the windows of time in which terms that depend on t alone change faster than in most of the run."""
    program = clock_program(system)
    if program is None:
        return ()
    outputs = program.along(values)
    try:
        return brief_windows(lambda looks: outputs(looks[:, None], looks), float(times[0]), float(times[-1]))
    except (ArithmeticError, ValueError) as refusal:
        raise InputError(
            f"simulate: a function of time fails at a time between t = {times[0]:g} and {times[-1]:g} s ({refusal}): end the run "
            "before, or return a number"
        ) from None


def motion_scales(
    system: Equations,
    values: Values,
    start: Array,
    times: Array,
    motion: Integrate | None = None,
    windows: tuple[Window, ...] = (),
    followed: tuple[NarrowPart, ...] = (),
) -> Scales:
    """Measure the scales of a motion by a coarse integration over the times. If its small budget is spent before the end, only
    the part up to there is measured. A motion with events needs its own integration as `motion`. The narrow terms in `followed`
    are integrated along with the motion."""
    span = float(times[-1] - times[0])
    if span == 0:
        return Scales(1.0, _sizes(system, values, start[None], 1.0), 0, survey=start[None])
    smooth, grid = motion is None, np.linspace(times[0], times[-1], 400)
    size = len(system.variables)
    guess = size + 2 if smooth else 0  # evaluations of `first_sizes`
    if motion is None:
        motion = _coarse_motion(system, values, start, span, windows, followed)
    try:
        stretch, reached = motion(start, grid, _COARSE, False, _EVALUATIONS), span
    except StopError as stop:
        stretch = stop.reached or Stretch(start[None], start, 1)
        # A motion that stops at once has an unknown scale; one whose budget is spent was followed up to there.
        reached = max(stop.at - float(times[0]), 0.0 if stop.cause == "budget" else 1e-3 * span)
        if stop.cause != "budget":  # a motion to infinity is as large as its last steps make it
            stretch = replace(stretch, states=stretch.states[: len(stretch.states) * 9 // 10], end=start)
    states, evaluations, stiff = _finite(start, stretch), guess + stretch.evaluations, False
    if smooth and (system.forces or system.dissipation != 0 or system.states):
        program = motion_program(system)
        bare = program.rhs(*parameter_values(program, values))
        n, some = len(system.c.q), states[:: max(1, len(states) // 8)]
        ends = n, n + len(system.speeds), size
        stiff = min(_rates(bare, state, ends).real.min() for state in some) * span < -_STIFF
        evaluations += len(some) * (size + 1)
    if stiff and reached < span:  # the decaying modes, not the motion, determine DOP853's steps
        try:
            motion = _coarse_motion(system, values, start, span, windows, followed, lsoda)
            stretch = motion(start, grid, _COARSE, False, _EVALUATIONS)
            states, evaluations, reached = _finite(states, stretch), evaluations + guess + stretch.evaluations, span
        except StopError as stop:
            evaluations += guess + stop.evaluations
    turn = min(reached * _PER_TURN / max(stretch.evaluations, 1), span)
    usual = states if windows else _without_peaks(states)  # after a pulse a motion may be far larger than before
    return Scales(turn, _sizes(system, values, usual, turn), evaluations, bool(stiff), windows, states)


def _without_peaks(states: Array) -> Array:
    """Remove the states in which a component exceeds _PEAK times its median. A motion to infinity has large values at its end;
    errors before must not be measured by these. A component that is at rest most of the time is not tested."""
    mostly, largest = np.median(np.abs(states), 0), np.abs(states).max(0)
    return np.asarray(states[(np.abs(states) <= np.where(mostly > _AT_REST * largest, _PEAK * mostly, np.inf)).all(1)])


def _finite(start: Array, stretch: Stretch) -> Array:
    states = np.vstack([start, stretch.states, stretch.end])
    return np.asarray(states[np.isfinite(states).all(1)])


def _coarse_motion(
    system: Equations,
    values: Values,
    start: Array,
    span: float,
    windows: tuple[Window, ...],
    followed: tuple[NarrowPart, ...],
    solver: Callable[[Segment, float], Stretch] = dop853,
) -> Integrate:
    program, n, m = motion_program(system), len(system.c.q), len(system.speeds)
    ends = n, n + m, len(system.variables)
    sizes = first_sizes(program.rhs(*parameter_values(program, values)), start, span, ends)
    by_one = lambda segment, _, tol: solver(segment, tol)  # noqa: E731
    return smooth_motion(system, values, "core", sizes, span, start, windows, followed, solver=by_one)


def first_sizes(bare: Rhs, start: Array, span: float, ends: tuple[int, int, int]) -> Array:
    """Guess the size of each component from the state, its derivative and the fastest rate of the motion linearised there. The
    coordinates, the velocities and the first-order states end at the indices `ends`."""
    n, m, size = ends
    rates = np.nan_to_num(np.asarray(bare(0.0, start), float)[:size], posinf=0.0, neginf=0.0)
    rate = max(float(np.abs(_rates(bare, start, ends)).max()), 1 / span)
    places, speeds, states = np.split(np.maximum(np.abs(start[:size]), np.abs(rates) / rate), [n, m])
    if m == 2 * n:
        places = np.maximum(places, np.abs(rates[n:m]) / rate / rate)
        speeds = np.maximum(speeds, np.abs(start[:n]) / span)
    return np.concatenate([_positive(part, 1e-6) for part in (places, speeds, states)])


def _rates(bare: Rhs, state: Array, ends: tuple[int, int, int]) -> NDArray[np.complex128]:
    """Return the eigenvalues in 1/s of the motion linearised about a state; one zero if the linearised motion is not finite."""
    n, m, size = ends
    value, slope = np.asarray(bare(0.0, state), float)[:size], np.zeros((size, size))
    for j in range(size):
        part = state[:n] if j < n else state[n:m] if j < m else state[m:size]
        step = 1e-6 * (np.abs(part).max() or 1.0)
        displaced = state.copy()
        displaced[j] += step
        slope[:, j] = (np.asarray(bare(0.0, displaced), float)[:size] - value) / step
    return np.asarray(np.linalg.eigvals(slope) if np.isfinite(slope).all() else [0.0], complex)


def _sizes(system: Equations, values: Values, states: Array, turn: float) -> Array:
    """Return the size of each component of states (m, d). The typical period in s is `turn`. The size of a first-order state is
    its largest value."""
    n, m, jacobi = len(system.c.q), len(system.speeds), energy_program(system).along(values)
    q, u = states[:, :n], states[:, n : n + m]
    d = len(system.variables)
    x, times = states[:, n + m : d], states[:, d] if states.shape[1] > d else np.zeros(len(states))
    if not n:
        return _positive(np.abs(x).max(0))

    def energy(u: Array) -> Array:
        return jacobi(np.hstack([q, u]), times)[0]

    largest = np.abs(states[:, : n + m]).max(0)
    at_rest, moving = energy(0 * u), energy(u)
    if not np.isfinite(moving[0]) and np.abs(states[0, : n + m]).max() > _OVERFLOWS:
        raise InputError("simulate: the energy overflows at the start: take other units, or a smaller q0 or v0")
    if not np.isfinite(moving[0]):
        raise InputError("simulate: the energy has no real value at the start: give a Lagrangian that has one there")
    kinetic = float(np.nanmax(np.abs(moving - at_rest), initial=0.0))
    least, top = np.zeros(m), float(largest[n:].max()) or 1.0
    for i, speed in enumerate(np.where(largest[n:] > _LOST * top, largest[n:], top)):
        direction = 0 * u + speed * np.eye(m)[i]
        mass = np.nanmedian(energy(direction) + energy(-direction) - 2 * at_rest) / speed**2
        least[i] = _QUIET * np.sqrt(2 * kinetic / mass) if mass > 0 else 0.0
    speeds = np.maximum(largest[n:], least)
    if system.kinematics is None:
        places = np.maximum(largest[:n], speeds * turn / (2 * np.pi))
    else:
        alone = [0 * u, u, *(0 * u + speed * e for speed, e in zip(speeds, np.eye(m), strict=True))]
        still, *v = (velocities_along(system, values, np.hstack([q, speeds_alone, x]), times) for speeds_alone in alone)
        places = np.maximum(largest[:n], np.abs(np.array(v) - still).max((0, 1)) * turn / (2 * np.pi))
    rounding = 0.0
    if system.multipliers:
        rounding, places = _ROUNDING, _positive(places, _ROUNDING)
    if system.kinematics is None:
        through = places * 2 * np.pi / turn
        speeds = np.where(speeds > rounding * through, speeds, through)
    return np.concatenate([_positive(places), _positive(speeds), _positive(np.abs(x).max(0))])


def _positive(sizes: Array, least: float = 0.0) -> Array:
    """Replace each size that is not finite, or at most `least` times the largest size, by the largest size."""
    largest = float(np.nanmax(sizes, initial=0.0)) or 1.0
    return np.where(np.isfinite(sizes) & (sizes > least * largest), sizes, largest)


@lru_cache(maxsize=64)
def integrals(system: Equations) -> tuple[Generated, ...]:
    """Return a program for each conserved quantity that the form of the equations shows: the Jacobi integral and the momenta of
    cyclic coordinates."""
    is_expression = isinstance(system.lagrangian, sp.Expr)
    programs = []
    if not system.c.q:
        return ()
    if not (depends_on_time(system) or system.forces or system.dissipation != 0):
        at_rest = dict.fromkeys(system.c.v, sp.S.Zero)
        if all(decide_zero(put_in(e, at_rest)).answer == "zero" for e in system.rolling):
            programs.append(energy_program(system))
    if is_expression and not longer(system.L, _WRITTEN):
        for q in cyclic_coordinates(system):
            programs.append(function_program(system, derivative(system.L, system.c.v[system.c.q.index(q)])))
    return tuple(programs)


def conservation_error_of(system: Equations, values: Values, sizes: Array) -> Callable[[Array, Array], Array] | None:
    """Return a function that measures how well a run keeps its conserved quantities, or None if there are none. It takes times
    (n,) and states (n, d). For each quantity in turn, it returns the n signed relative state errors that would explain its
    change."""
    conserved = [program.along(values) for program in integrals(system)]
    n = len(system.variables)

    def conservation_error(times: Array, states: Array) -> Array:
        errors = []
        for integral in conserved:
            y = states[:, :n]
            slope = np.zeros(len(times))
            for step in np.diag(_STEP * sizes):
                with np.errstate(all="ignore"):
                    slope += np.abs(integral(y + step, times) - integral(y - step, times))[0] / (2 * _STEP)
            slope = np.nan_to_num(slope, posinf=0.0)  # where a step leaves the integral's domain
            level = integral(y, times)[0]
            change, rounding = level - level[0], 1e-15 * np.abs(level).max()
            change = np.sign(change) * np.maximum(np.abs(change) - rounding, 0.0)
            errors.append(change / np.maximum(slope, 1e-3 * slope.max() + 1e-300))
        return np.concatenate(errors)

    return conservation_error if conserved else None
