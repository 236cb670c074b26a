"""A simulation of any system, and the run that it returns."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError, InputError, LagrotorWarning
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.lagrangian import jacobian
from lagrotor.mechanics.lagrangian import t as time
from lagrotor.mechanics.running import run_plots, sections
from lagrotor.mechanics.running.flow import Array, Values, powers_of_two, projection_of
from lagrotor.mechanics.running.function_values import FunctionValue, event_with, put_functions, with_values
from lagrotor.mechanics.running.initial_state import (
    check_inertia,
    check_pole,
    check_values,
    consistent,
    rounding_of_start,
    state_vector,
)
from lagrotor.mechanics.running.monodromy import Lyapunov, lyapunov_exponent
from lagrotor.mechanics.running.motion import SampledMotion, digest_of, integration_of, with_states
from lagrotor.mechanics.running.narrow_features import narrow_parts, narrowest_words
from lagrotor.mechanics.running.phases import Moment, Switched, begin, with_events
from lagrotor.mechanics.running.programs import depends_on_time, function_program, parameter_values, rows_program
from lagrotor.mechanics.running.redundant_constraints import Redundancy, without, without_redundant
from lagrotor.mechanics.running.scales import Scales, clock_windows, conservation_error_of, motion_scales
from lagrotor.mechanics.running.singular_positions import independence
from lagrotor.mechanics.running.switches import Event, Impact, check_events
from lagrotor.numerics.arrays import check_times
from lagrotor.numerics.error_estimate import EvaluationBudget, Evolution, estimate_run
from lagrotor.numerics.integrate import Engine, check_engine, check_progress, check_tolerance
from lagrotor.numerics.run import Ending, read_run
from lagrotor.numerics.solver_constants import DEPENDENT

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure
    from lagrotor.drawing.view import View

_BELOW = 1e-7  # gap below zero, over its size, at which an initial state is refused
_BUDGET = EvaluationBudget(20_000, 1_600)
_STIFF = EvaluationBudget(200_000, 16_000)  # the turns of a stiff motion take many steps
_PER_TURN = 16  # intervals in a turn, in which rows of constraints do not turn by a right angle
_ALLOWED = 100.0  # residual of a redundant constraint over its size and the error of the run
_BOUND = 0.3  # singular value of all rows over its median, above which they are no more dependent than before
_BETWEEN = 8  # intervals between two samples in which dependent constraints are sought


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SystemRun(SampledMotion):
    """A simulated motion of a system, returned by `System.simulate`.

    The error of a coordinate or velocity is relative to its size, the largest value over the run. The size is at least a
    thousandth of the value that all kinetic energy would give.

    Attributes
    ----------
    t : Array
        Times in s that were reached, shape (n,).
    errors : Array
        Estimated largest error up to each time, shape (n,).
    horizon : float
        The time in s from which the errors exceed `tol`; inf if they never do.
    evaluations : int
        Evaluations of the right-hand side in all integrations.
    ending : Ending
        The reason why the run ended where it did.
    system : Equations
        The system, with expressions in place of unknown functions.
    values : Mapping
        The values of its parameters and functions.
    tol : float
        The error that was asked for.
    engine : {"core", "fast"}
        The solvers: those of the core, or heyoka for "fast".
    scales : Scales
        Typical period and sizes of the motion.
    states : Array
        States of the integration: q, u and, where they enter, time and contact modes, shape (n, d).
    local : float
        The local error of the better of the two integrations that were compared.
    switched : Switched
        The system with its events.
    redundancy : Redundancy or None, default None
        The constraints that the run leaves out as they follow from others, and the reactions that are not determined.

    Examples
    --------
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("x")
    >>> run = System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 1, 2])
    >>> run.error < run.tol, run.ending.kind
    (True, 'end')
    """

    @staticmethod
    def load(path: str | Path, system: Equations, events: Any = (), functions: Values | None = None) -> "SystemRun":
        """Read a run that `save` wrote; a file holds no equations.

        Parameters
        ----------
        path : str or Path
            The .npz file.
        system : Equations
            The system of the run.
        events : Event, Impact or sequence of these, default ()
            The events of the run.
        functions : Values or None, optional
            The values of its unknown functions.

        Returns
        -------
        SystemRun
            The run.

        Raises
        ------
        InputError
            If `save` did not write the file, or it holds a run of another system.

        Examples
        --------
        >>> from tempfile import gettempdir
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> free = System(c, c.v[0]**2 / 2)
        >>> path = free.simulate({}, (0,), (1,), [0, 1]).save(gettempdir() + "/free.npz")
        >>> SystemRun.load(path, free).q.round(6).T
        array([[0., 1.]])
        """
        if not isinstance(system, Equations):
            raise InputError(f"load: system = {system!r} must be the System of the saved run")
        events = check_events(system, events)
        expressions = [e for event in events for e in event.expressions]
        system, callables = put_functions("load", system, functions or {}, expressions)
        events = tuple(event_with(event, lambda e: with_values(e, callables)) for event in events)
        saved = read_run(path)
        about, arrays, c = saved.about, saved.arrays, system.c
        try:
            system, redundancy = without(system, *left_out) if (left_out := about.get("redundant")) else (system, None)
            if about["coordinates"] != [str(q) for q in c.q] or about["equations"] != digest_of(system):
                raise InputError(
                    f"load: {path} is a run of another system, in {', '.join(about['coordinates'])}: give that system"
                )
            y = np.stack([arrays[str(s)] for s in system.variables], 1)
            states = np.hstack([y, np.array(about["modes"], float).reshape(len(y), -1)])
            scales = Scales(float(about["turn"]), np.array(about["sizes"], float), 0)
            values = {str(name): float(value) for name, value in about["values"].items()} | callables
            tol, local, engine = check_tolerance(about["tol"]), float(about["local"]), about["engine"]
            check_engine(engine, "load")
            whole = len(states) == len(saved.fields["t"]) and scales.sizes.shape == (len(system.variables),)
            if not whole or not np.isfinite(states).all():
                raise ValueError("its states are invalid")
        except InputError:
            raise
        except (KeyError, TypeError, ValueError, AttributeError) as refusal:
            raise InputError(f"load: {path} is no run of a system ({refusal}): give a file that `save` wrote") from None
        h = with_events(system, values, events)
        windows = clock_windows(h.phase(h.slipping).system, h.numbers(h.slipping), saved.fields["t"])
        swings = np.repeat(states[:1], 2, axis=0)  # the largest values of the motion, also between its samples
        swings[:, : len(scales.sizes)] = scales.sizes, -scales.sizes
        scales = replace(scales, windows=windows, survey=np.vstack([states, swings]))
        narrow = narrow_parts(h.without_planar, h.numbers(h.slipping), scales.survey)
        h = replace(h, scale=powers_of_two(scales.sizes), sizes=scales.sizes, windows=windows, narrow=narrow)
        return SystemRun(
            **saved.fields, system=system, values=values, tol=tol, engine=engine, scales=scales, states=states,
            local=local, switched=h, redundancy=redundancy,
        )  # fmt: skip

    def crossings(self, section: sp.Expr, direction: int = 0) -> "SystemRun":
        """Find the states where section(q, v, t) = 0 is crossed, in the order of time; there may be none.

        Times and states are as exact as the run. Every zero of the polynomials through the solver's steps is a crossing, also
        two in one step. If the section turns round within tol of zero, it touches zero, and two crossings there may count as
        one or none. The search takes at most twice the evaluations of the run, by the engine "core", and more only for a
        narrow section. A LagrotorWarning says where the section changes faster than the polynomials can follow.

        Parameters
        ----------
        section : Expr
            An expression in q, v and t.
        direction : {0, 1, -1}, default 0
            Upward crossings (1), downward ones (−1), or both and states where the section is touched (0).

        Returns
        -------
        SystemRun
            The run at the crossings.

        Raises
        ------
        InputError
            If the direction is not 0, 1 or −1, the section does not change, or the run has one sample.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> run = System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 6])
        >>> run.crossings(c.q[0], direction=-1).t.round(6)
        array([1.570796])
        """
        return sections.crossings(self, section, direction)

    def lyapunov(self) -> Lyapunov:
        """Compute the largest Lyapunov exponent over the run; for a regular motion it falls as log(t)/t.

        Returns
        -------
        Lyapunov
            The exponent in 1/s with its standard error, and its mean up to each time.

        Raises
        ------
        InputError
            If the run has one sample, or the motion has events or forces that jump.
        IntegrationError
            If a neighbouring motion cannot continue, for example at a singular position.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> run = System(c, (c.v[0]**2 + c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 9])
        >>> round(run.lyapunov().history[-1])
        1
        """
        return lyapunov_exponent(self)

    def plot(self, *quantities: Any) -> "RunFigure":
        """Draw quantities over time; by default the coordinates, the change of the energy and the drift of constraints.

        Parameters
        ----------
        *quantities : str or Expr
            Coordinates, velocities, "E" for the energy, names of constraints for their reactions, or expressions. Give
            Eq(F, expression) to label the curve of a long expression by F.

        Returns
        -------
        RunFigure
            A figure that a notebook shows; `.savefig(path)` writes it.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> figure = System(c, c.v[0]**2 / 2).simulate({}, (0,), (1,), [0, 1]).plot("x", c.v[0]**2)
        """
        return run_plots.plot(self, *quantities)

    def animate(self, path: str | Path, fps: float = 25.0, lines: "Sequence[Sequence[run_plots.Point]]" = ()) -> Path:
        """Write the run as a film of its bodies, or of lines.

        Parameters
        ----------
        path : str or Path
            A file name that ends in .gif.
        fps : float, default 25.0
            Frames per second.
        lines : sequence of sequences of points, default ()
            The points (x, y, z) of each line in m, as expressions in q and t; required for a system without bodies.

        Returns
        -------
        Path
            The file.

        Examples
        --------
        >>> from tempfile import gettempdir
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> run = System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 1])
        >>> run.animate(gettempdir() + "/run.gif", fps=5, lines=[[(0, 0, 0), (c.q[0], 0, 1)]]).name
        'run.gif'
        """
        return run_plots.animate(self, path, fps, lines)

    def view(self, lines: "Sequence[Sequence[run_plots.Point]]" = ()) -> "View":
        """Show the bodies with their frames, or lines, in three dimensions.

        Parameters
        ----------
        lines : sequence of sequences of points, default ()
            The points (x, y, z) of each line in m, as expressions in q and t; required for a system without bodies.

        Returns
        -------
        View
            A notebook shows it, and `.save("motion.html")` writes it.

        Examples
        --------
        >>> from lagrotor.mechanics import System, coordinates
        >>> c = coordinates("x")
        >>> run = System(c, (c.v[0]**2 - c.q[0]**2) / 2).simulate({}, (1,), (0,), [0, 1])
        >>> page = run.view(lines=[[(0, 0, 0), (c.q[0], 0, 1)]])
        """
        return run_plots.view(self, lines)


def simulate_system(
    system: Equations,
    values: Values,
    q0: ArrayLike,
    v0: ArrayLike,
    t: ArrayLike,
    tol: float = 1e-9,
    engine: Engine = "core",
    events: Event | Impact | Sequence[Event | Impact] = (),
    progress: Callable[[float], None] | None = None,
    x0: ArrayLike = (),
) -> SystemRun:
    """Simulate a system for `System.simulate`."""
    times, tol = check_times("simulate", t), check_tolerance(tol)
    check_engine(engine)
    check_progress(progress)
    events = check_events(system, events)
    system, values = put_functions("simulate", system, values, [e for event in events for e in event.expressions])
    events = tuple(event_with(event, lambda e: with_values(e, values)) for event in events)
    if engine == "fast" and any(isinstance(value, FunctionValue) for value in dict(values).values()):
        raise InputError("simulate: engine='fast' takes no callable and no table for a function: use engine='core'")
    n = len(system.c.q)
    q, v = state_vector("simulate", "q0", q0, n), state_vector("simulate", "v0", v0, len(system.speeds), system)
    x = state_vector("simulate", "x0", x0, len(system.states), system)
    system, redundancy = without_redundant("simulate", system, values, q, v, times[0])
    h = with_events(system, values, events)
    parameter_values(h.phase(h.slipping).motion, h.numbers(h.slipping))
    check_values("simulate", system, values, [e for event in h.events for e in event.expressions])
    for event in h.events:
        program = function_program(h.system, *event.expressions)
        at_start = program.along(h.numbers(h.slipping))(np.concatenate([q, v, x])[None], times[:1])[:, 0]
        if isinstance(event, Impact) and not 0 <= at_start[1] <= 1:
            raise InputError(
                f"simulate: the restitution {event.restitution} is {at_start[1]:.6g}: it must lie between 0 and 1"
            )
        if isinstance(event, Impact) and not at_start[2] >= 0:
            raise InputError(f"simulate: the friction {event.friction} is {at_start[2]:.6g}: it must be at least 0")
    if system.multipliers:
        q, v = _on_constraints(system, values, np.concatenate([q, v]), times)
    y = np.concatenate([q, v, x])
    check_pole("simulate", system, values, np.append(y, times[0]))
    if len(q):
        check_inertia("simulate", system, values, np.append(y, times[0]))
    h = replace(h, windows=clock_windows(h.phase(h.slipping).system, h.numbers(h.slipping), times))
    if h.smooth:
        start = np.append(y, [times[0]] * depends_on_time(system))
    elif engine == "fast":
        raise InputError("simulate: engine='fast' takes no events, and no force that jumps: use engine='core'")
    else:
        start = begin(h, y, times[0])

    def survey() -> Scales:
        motion = None if h.smooth else integration_of(system, values, engine, None, h, start)
        return motion_scales(system, values, start, times, motion, h.windows if h.smooth else (), h.narrow)

    scales = survey()
    if narrow := narrow_parts(h.without_planar, h.numbers(h.slipping), scales.survey):
        h, first = replace(h, narrow=narrow), scales
        scales = replace(again := survey(), evaluations=again.evaluations + first.evaluations)
    if not h.smooth:
        h = replace(h, scale=powers_of_two(scales.sizes), sizes=scales.sizes)
        _check_gaps(h, Moment(y, times[0], h.slipping))
    evolution = Evolution(
        start=start,
        # A solver evaluates beyond its last time.
        integrate=integration_of(
            system, values, engine, scales, h, start, progress and (lambda now: progress(min(now, float(times[-1]))))
        ),
        distance=scales.distance,
        turn=scales.turn,
        budget=_STIFF if scales.stiff else _BUDGET,
        project=projection_of(system, values) if system.multipliers and h.smooth else None,
        constraint_uncertainty=_uncertainty(system, values, scales.sizes)
        if len(system.left) > 1 and h.smooth
        else None,
        sizes=np.append(scales.sizes, np.zeros(len(start) - len(scales.sizes))),
        conservation_error=conservation_error_of(system, values, scales.sizes) if h.smooth else None,
        sudden=bool(h.narrow),
    )
    estimate = estimate_run(evolution, times, tol)
    run = SystemRun(
        **estimate.run_fields | {"evaluations": estimate.evaluations + scales.evaluations}, system=system, values=values, tol=tol,
        engine=engine, scales=scales, states=estimate.states, local=estimate.local, switched=h, redundancy=redundancy,
    )  # fmt: skip
    hint = narrowest_words(h.system, h.numbers(h.slipping), h.narrow, estimate)
    estimate.warn_unless_kept(", ".join(map(str, (*system.c.q, *dict(system.states)))), tol, 3, hint)
    if system.multipliers:
        _warn_of_dependence(run)
    run = run if h.smooth else _cut_at_event(run)
    return _cut_where_redundant_fail(run, redundancy) if redundancy else run


def _cut_where_redundant_fail(run: SystemRun, redundancy: Redundancy) -> SystemRun:
    """Cut a run before the first sample at which a constraint that was left out does not hold."""
    sizes = [_ALLOWED * sections.change(run, e) for e in redundancy.residuals]
    allowed = np.outer(sizes, np.maximum(run.errors, run.tol))
    i = int(np.argmax((np.abs(run._values(*redundancy.residuals)) > allowed).any(0)))
    if i == 0:
        return run
    reason = (
        f"the constraints {', '.join(redundancy.dropped)}, which follow from the others at the start, no longer hold at t = "
        f"{run.t[i]:.6g} s: they contradict the others, or the motion has passed a singular position onto another branch"
    )
    ending = Ending("stopped", float(run.t[i - 1]), reason)
    warnings.warn(f"simulate: {ending}", LagrotorWarning, stacklevel=3)
    return replace(with_states(run, run.t[:i], run.states[:i]), ending=ending)


def _uncertainty(system: Equations, values: Values, sizes: Array) -> Callable[[Array], Array]:
    """Return a function that takes states (n, d) and returns the error of each along nearly dependent constraints, shape (n,).
    The unit of the error is the machine epsilon times the size of a component."""
    n, m = len(system.c.q), len(system.speeds)
    unit = sizes[:n] if system.kinematics is None else sizes[n : n + m]

    def uncertainty(states: Array) -> Array:
        least = independence(system, values, states, unit)
        return np.where(least < DEPENDENT.value, 1 / np.maximum(least, np.finfo(float).eps), 1.0)

    return uncertainty


def _check_gaps(h: Switched, at: Moment) -> None:
    """Raise InputError for a gap that is negative at the start."""
    gaps = [impact.gap for impact in h.impacts]
    if not gaps:
        return
    values = h.evaluate(h.system, gaps, at)
    for gap, value, size in zip(gaps, values, h.sizes_of(h.system, gaps, at), strict=True):
        if value < -_BELOW * size:
            raise InputError(
                f"simulate: the gap {gap} is {value:.6g} at t = {at.t:g} s: start where it is not negative"
            )


def _cut_at_event(run: SystemRun) -> SystemRun:
    """Cut the run at the event that ended it, so that the state of the event is the last one."""
    h = run.switched
    if h.hidden:
        a, b = h.hidden[0]
        warnings.warn(
            f"simulate: between t = {a:.6g} and {b:.6g} s a condition of an event changes faster than it can be followed: "
            "an event may be hidden there",
            LagrotorWarning,
            stacklevel=3,
        )
    ended = np.rint(run.states[:, -1]).astype(int)
    if not ended[-1]:
        accumulations = [
            f"impacts on {[e for e in h.events if isinstance(e, Impact)][i].gap} accumulate at t = {at:.9g} s"
            for i, at in h.accumulations.items()
            if at < run.t[-1]
        ]
        return replace(run, ending=replace(run.ending, reason="; ".join(accumulations))) if accumulations else run
    k = int(np.argmax(ended > 0))
    at, ending = float(run.states[k, h.size]), h.endings[ended[k] - 1]
    k += k == 0 or at > run.t[k - 1]  # the state of the end is the last sample
    shorter = with_states(run, np.append(run.t[: k - 1], at), run.states[:k])
    if ending.kind != "event" or "accumulate" in ending.reason:
        warnings.warn(f"simulate: {replace(ending, at=at)}", LagrotorWarning, stacklevel=3)
    return replace(shorter, ending=replace(ending, at=at))


def _on_constraints(system: Equations, values: Values, start: Array, times: Array) -> tuple[Array, Array]:
    """Return the initial state on the constraints. Raise ConstraintError if it is further from the given state than rounding
    explains."""
    n = len(system.c.q)
    q, v = consistent("simulate", system, values, start[:n], start[n:], times[0])
    distance = np.abs(np.concatenate([q, v]) - start)
    if (distance > rounding_of_start(system, values, start, times[0], times[-1] - times[0])).any():
        raise ConstraintError(
            f"simulate: the start is off the constraints by {distance.max():.3g}; the nearest state on them is "
            f"q0 = {_as_text(q)}, v0 = {_as_text(v)} (system.consistent gives it)"
        )
    return q, v


def _warn_of_dependence(run: SystemRun) -> None:
    """Warn if the constraints of a run become dependent between two samples, and name the time. At such a time the product g₁ ∧ …
    ∧ g_k of the rows of G is zero. At a simple zero it changes its sign, so that det(G(t) G(t')ᵀ) < 0 for t before and t' after
    it. Samples between which a row may turn by a right angle are ignored."""
    rows = run.system.rows
    if len(run.t) < 2 or not run.system.left or not rows.free_symbols & {*run.system.c.q, time}:
        return
    from scipy.interpolate import CubicHermiteSpline

    fine = np.append(np.linspace(run.t[:-1], run.t[1:], _BETWEEN, endpoint=False).T.ravel(), run.t[-1])
    still = np.zeros((len(fine), len(run.system.variables) - len(run.system.c.q)))
    states = np.hstack([CubicHermiteSpline(run.t, run.q, run.v)(fine), still])
    G = rows_program(run.system).along(run.values)(states, fine)
    G = G.T.reshape(-1, len(run.system.left), len(run.system.speeds))
    near = np.repeat(np.diff(run.t) < _BETWEEN / _PER_TURN * run.scales.turn, _BETWEEN)
    reversed_after = fine[:-1][near & (np.linalg.det(G[:-1] @ G[1:].swapaxes(1, 2)) < 0)]
    if len(reversed_after) and not _bound_by_redundant(run, states, fine, G, reversed_after[0]):
        warnings.warn(
            f"simulate: near t = {reversed_after[0]:.6g} s the constraints become dependent: their reactions may have no limit "
            "there, and the motion beyond may be one of several; end the run before",
            LagrotorWarning,
            stacklevel=3,
        )


def _bound_by_redundant(run: SystemRun, states: Array, times: Array, G: Array, at: float) -> bool:
    """Return True if constraints that were left out determine the motion where the others, with the rows G, become dependent, as
    two coupling rods at a right angle do at the dead point of one."""
    residuals = run.redundancy.residuals if run.redundancy and run.system.kinematics is None else ()
    program = function_program(run.system, *jacobian(residuals, run.system.c.v))
    others = program.along(run.values)(states, times).T.reshape(len(times), -1, G.shape[2])
    least = np.linalg.svd(np.concatenate([G, others], axis=1), compute_uv=False)[:, G.shape[1] - 1]
    return bool(residuals) and bool(least[times == at] > _BOUND * np.median(least))


def _as_text(values: Sequence[float] | Array) -> str:
    return "(" + ", ".join(f"{float(x):.12g}" for x in values) + ")"
