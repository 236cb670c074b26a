"""The solvers of a segment, one function each, and when each is chosen.

========== ========================================= ============================================================
solver     method                                    chosen by `integrate.by_fastest`
========== ========================================= ============================================================
`lsoda`    Adams and BDF of variable order (Petzold  at a tolerance from CROSSOVER on: only the right-hand side is
           1983), scipy's compiled loop              Python
`adams`    Adams predictor and corrector of order    below CROSSOVER, where no force acts briefly: it alone reaches
           10 or 12 in equal steps (Hairer, Nørsett  an error of 10⁻¹³
           & Wanner, III.1)
`dop853`   Runge–Kutta of order 8 (Hairer, Nørsett   for a while, where another stops; below CROSSOVER in a pulse;
           & Wanner, II.5), scipy's, step by step    between events
`taylor`   Taylor series, compiled by heyoka         engine = "fast", in a module of its own
========== ========================================= ============================================================
"""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any

import numpy as np

from lagrotor.numerics.segment import (
    LOST,
    Array,
    Cause,
    RightHandSide,
    Segment,
    StopError,
    Stretch,
    states_on_constraints,
)

_PATIENCE = 5_000  # evaluations before they are compared with the completed share of the segment
_TURN = 0.5  # largest relative change of a state with constraints in a step, which might pass a singular position
_FIRST = 1e-6  # first step over the segment, where scipy's own first step leaves the range of the right-hand side
_LEAST_RELATIVE = 2.3e-14  # scipy's solvers take no smaller relative tolerance
_PIECE_BUDGET = 5_000  # evaluations between two projections, beyond which the solver no longer follows the motion
_LEAST_CUT = 1e-12  # least time between two projections over the segment
_DRIFT = 200.0  # drift of the constraints between projections in local errors: the error of the whole run
_BLOCK = 100
_SWEEPS = 25
_PIECE = 2_000  # steps, after which a step longer than one that failed is tried again
_IN_VAIN = 3  # times that a step is shortened at one place without a smaller error


def dop853_steps(segment: Segment, error: float, stiff: float = 0.0) -> Iterator[Any]:
    """Yield scipy's solver DOP853 after each step; after that the state is projected onto the constraints. The local error,
    relative and absolute, is `error`. If `stiff` is not zero, the solver is Radau, for a motion whose fastest rate falls as the
    time since the start grows. Then no step is longer than this time, and `stiff` is the increment for slopes."""
    from scipy.integrate import DOP853, Radau

    project, increment, first_rate = segment.project, stiff, 0.0

    def slopes(t: float, y: Array) -> Array:
        f, steps = np.asarray(segment.rhs(t, y)), np.maximum(increment, 4 * np.spacing(np.abs(y)))
        return np.array([np.asarray(segment.rhs(t, y + each)) - f for each in np.diag(steps)]).T / steps

    with np.errstate(divide="ignore", invalid="ignore"):  # scipy's first step, where values are not finite
        solver = (partial(Radau, jac=slopes) if stiff else DOP853)(
            segment.rhs,
            segment.begin,
            segment.start,
            segment.until,
            rtol=max(error, _LEAST_RELATIVE),
            atol=error,
            max_step=segment.longest,
        )
    if not np.isfinite(solver.f).all():
        raise StopError(segment.begin, "the right-hand side is not finite", evaluations=solver.nfev)
    if not np.isfinite(solver.h_abs):  # scipy would repeat this first step for ever
        solver.h_abs = _FIRST * (segment.until - segment.begin)
    while solver.status == "running":
        longest = segment.longest
        if stiff:  # an old Jacobian would hide the error
            solver.J, solver.LU_real, solver.LU_complex = slopes(solver.t, solver.y), None, None
            rate = float(np.linalg.norm(solver.J, 2))
            first_rate = first_rate or rate
            increment = stiff * first_rate / rate
            longest = min(longest, max(solver.t - segment.begin, 1 / rate))
            solver.max_step = longest
            solver.h_abs = min(solver.h_abs, longest)
        if project is not None:  # no step over a singular position of the constraints
            limit = _TURN * (1 + np.abs(solver.y).max()) / (np.abs(solver.f).max() + 1e-300)
            solver.max_step = min(longest, limit, segment.clear(solver.y))
        t, y = solver.t, solver.y
        with np.errstate(over="ignore", invalid="ignore"):  # a step too long in a stiff motion, which scipy repeats
            message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            reached = Stretch(np.empty((0, len(y))), y, solver.nfev)
            raise StopError(t, message or "a value is not finite", reached)
        yield solver
        share = (solver.t - segment.begin) / (segment.until - segment.begin)
        if solver.status == "running" and solver.nfev > min(segment.budget, _PATIENCE + share * segment.budget):
            reached = Stretch(np.empty((0, len(y))), solver.y, solver.nfev)
            raise StopError(solver.t, f"the run did not end within {solver.nfev} evaluations", reached, cause="budget")
        if project is not None:
            solver.y = project(solver.y)
            solver.f = np.asarray(segment.rhs(solver.t, solver.y))
            solver.nfev += 1


def dop853(segment: Segment, error: float) -> Stretch:
    """Solve the segment by DOP853, with `error` as relative and absolute local error."""
    t_eval = segment.t_eval
    states, count, solver = np.empty((len(t_eval), len(segment.start))), 0, None
    try:
        for solver in dop853_steps(segment, error):
            reached = int(np.searchsorted(t_eval, solver.t, side="right"))
            if reached > count:
                states[count:reached] = solver.dense_output()(t_eval[count:reached]).T
                count = reached
    except StopError as stop:
        end = stop.reached.end if stop.reached else segment.start
        stretch = Stretch(states_on_constraints(segment.project, states[:count]), end, stop.evaluations)
        raise StopError(stop.at, stop.reason, stretch, cause=stop.cause) from None
    assert solver is not None  # a segment has a length
    return Stretch(states_on_constraints(segment.project, states[:count]), solver.y, solver.nfev)


def lsoda(segment: Segment, error: float) -> Stretch:
    """Solve the segment by LSODA, with `error` as relative and absolute local error. The first step does not depend on the first
    output time, so that outputs do not change the run. With constraints the run is interrupted about once a turn and the state
    projected. Otherwise the violation of the constraints may grow exponentially, as it does if the bar is under pressure."""
    if segment.project is None:
        return _lsoda(segment, error)
    now, y, evaluations, longest_cut = segment.begin, segment.start, 0, np.inf
    blocks = [np.empty((0, len(y)))]

    def stopped(reason: str, cause: Cause = "stopped") -> StopError:
        return StopError(now, reason, _on_constraints(segment, blocks, y, evaluations), cause=cause)

    while now < segment.until:
        if evaluations > segment.budget:
            raise stopped(f"the run did not end within {evaluations} evaluations", "budget")
        cut = min(5 / (replace(segment, begin=now, start=y).relative_speed + 1e-300), longest_cut, segment.clear(y))
        if cut < _LEAST_CUT * (segment.until - segment.begin):
            raise stopped("the next step might pass a singular position")
        until = now + cut if now + 1.5 * cut < segment.until else segment.until
        # A state with constraints changes by at most a fifth in a step, so that no step leaps over a singular position.
        longest = min(segment.longest, cut / 25)
        piece = replace(segment, start=y, begin=now, until=until, longest=longest)
        try:
            piece, run = _up_to_singular(piece, min(segment.budget - evaluations, _PIECE_BUDGET), error)
            end, evaluations = segment.project(run.end), evaluations + run.evaluations + 1
            drifted = np.abs(end - run.end).max() / (1 + np.abs(end).max())
        except StopError as stop:
            drifted, evaluations = np.inf, evaluations + stop.evaluations
            if cut < longest_cut / 2 or evaluations > segment.budget:
                raise stopped(stop.reason, stop.cause) from None
        if not drifted <= _DRIFT * error:  # a projection would not bring so large a drift back to the motion
            longest_cut = cut / 8
            if longest_cut < 1e-6 * (segment.until - segment.begin):
                raise stopped("the constraints drift faster than they can be kept")
            continue
        blocks.append(run.states)
        y, now, longest_cut = end, piece.until, 1.5 * longest_cut
    run = _on_constraints(segment, blocks, y, evaluations)
    if not np.isfinite(run.states).all():
        reason = "a state could not be brought back onto its constraints"
        raise StopError(segment.begin, reason, evaluations=evaluations)
    return run


def _on_constraints(segment: Segment, blocks: list[Array], y: Array, evaluations: int) -> Stretch:
    states = np.concatenate(blocks)
    if segment.project and len(states):
        states = segment.project(segment.project(states.T)).T  # one step squares the drift
    return Stretch(states, y, evaluations)


def _up_to_singular(segment: Segment, budget: float, error: float) -> tuple[Segment, Stretch]:
    """Solve the part of a segment before its steps might pass a singular position. Return this part and its states."""
    times = segment.t_eval[(segment.t_eval > segment.begin) & (segment.t_eval <= segment.until)]
    if segment.time_to_singular is None:
        return segment, _lsoda(replace(segment, t_eval=times, budget=budget), error)
    count = 65 + int(2 * (segment.until - segment.begin) / segment.longest)  # two times or more in a longest step
    # The end is one of the times, so that a stop between the last output and the end is seen.
    t_eval = np.union1d(times, np.linspace(segment.begin, segment.until, count)[1:])
    run = _lsoda(replace(segment, t_eval=t_eval, budget=budget), error)
    n = len(run.states)
    shorter = segment if n == len(t_eval) else replace(segment, until=float(t_eval[n - 1]))
    times = times[times <= shorter.until]
    return shorter, replace(run, states=run.states[np.searchsorted(t_eval, times)])


def _lsoda(segment: Segment, error: float) -> Stretch:
    """Solve the segment without projection, up to its end or to a state whose next step might pass a singular position."""
    begin, right, evaluations, lost, near, stopped = segment.begin, segment.until, 0, False, False, False
    at = accepted = begin  # times of the last evaluation and of the last accepted step
    zero_rate = [0.0] * len(segment.start)

    def watched(s: float, y: Array) -> list[float]:
        # LSODA takes NaN for a number and may step over its place; DOP853 does not. To stop LSODA, its rate becomes zero: it
        # soon comes to the end, and the earlier states remain valid.
        nonlocal evaluations, lost, near, stopped, at, accepted
        if stopped:
            return zero_rate
        at, accepted = s, at if s > at else accepted
        velocity = segment.rhs(s, y)
        evaluations, lost = evaluations + 1, velocity[0] != velocity[0]
        near = segment.clear(y) < segment.longest
        stopped = lost or near or evaluations > segment.budget
        return zero_rate if stopped else velocity

    first = min(np.sqrt(error) / (1 + np.abs(segment.rhs(begin, segment.start)).max()), segment.longest, right - begin)
    bare, unwatched = None if segment.time_to_singular else getattr(segment.rhs, "bare", None), 0
    if bare:

        def counted(s: float, y: Array) -> list[float]:
            nonlocal unwatched
            unwatched += 1
            if unwatched > segment.budget:  # scipy's own bound counts the steps between two outputs
                raise OverflowError
            velocity: list[float] = bare(s, y)
            return velocity

        try:
            states, log = _odeint(segment, counted, error, first)
            if _successful(states, log):
                return Stretch(states[1:-1], states[-1], unwatched + 1)
        except LOST:
            pass
    # A failed run is repeated with the same steps to find the time of its failure.
    states, log = _odeint(segment, watched, error, first)
    evaluations += 1 + unwatched
    if stopped or not _successful(states, log):
        # After the last step of a run that fails by itself, the states are undefined.
        states = states[1:-1][segment.t_eval <= accepted]
        whole = np.isfinite(states).all(1)
        states = states if whole.all() else states[: int(np.argmin(whole))]
        reached = Stretch(states, states[-1], evaluations) if len(states) else None
        if near and reached:
            return reached
        reasons = {
            "the right-hand side is not finite": lost,
            "the next step might pass a singular position": near,
            f"the run did not end within {evaluations} evaluations": stopped,
            log["message"]: True,
        }
        until = float(segment.t_eval[len(states) - 1]) if reached else begin
        cause: Cause = "budget" if stopped and not (lost or near) else "stopped"
        raise StopError(until, next(why for why, so in reasons.items() if so), reached, evaluations, cause)
    return Stretch(states[1:-1], states[-1], evaluations)


def _odeint(segment: Segment, rhs: RightHandSide, error: float, first: float) -> tuple[Array, dict[str, Any]]:
    """Solve a segment by scipy's odeint. Return the states at its beginning, at the output times and at its end, and scipy's
    log."""
    from scipy.integrate import odeint

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        states, log = odeint(
            rhs,
            segment.start,
            np.concatenate([[segment.begin], segment.t_eval, [segment.until]]),
            tfirst=True,
            rtol=error,
            atol=error,
            full_output=True,
            h0=first,
            hmax=0.0 if np.isinf(segment.longest) else segment.longest,
            mxstep=int(min(segment.budget, 2**30)) + 1,
        )
    return states, log


def _successful(states: Array, log: dict[str, Any]) -> bool:
    return log["message"] == "Integration successful." and bool(np.isfinite(states).all())


def adams_order(error: float) -> int:
    """Return the order of the Adams pair for a local error. A higher order needs fewer steps for accuracy, but shorter ones for
    stability."""
    return 10 if error >= 1e-10 else 12


@lru_cache(maxsize=8)
def adams_weights(q: int) -> tuple[Array, Array, Array, Array]:
    """Return the weights A, B, S, P of an Adams pair of q nodes, computed exactly from the Lagrange polynomials l_j and then
    rounded. A are integrals over the step after the last node (Adams–Bashforth), B over the step before it (Adams–Moulton). Both
    have the shape (2, q): the rounded weights, and their rounding error, which all steps of all runs would otherwise share. S (q,
    q) are the integrals from the first node to each node. P (q, q + 1) are the coefficients of the integral of l_j from node q //
    2, as a polynomial in the number of steps."""
    middle, last = q // 2, q - 1 - q // 2
    nodes = [i - middle for i in range(q)]
    rows = []
    for j in nodes:
        lagrange = [Fraction(1)]  # coefficients of ascending powers
        for i in nodes:
            if i != j:
                pairs = zip([Fraction(0), *lagrange], [*lagrange, Fraction(0)], strict=True)
                lagrange = [(shifted - i * coefficient) / (j - i) for shifted, coefficient in pairs]
        rows.append([Fraction(0), *(c / (n + 1) for n, c in enumerate(lagrange))])

    def at(row: list[Fraction], x: int) -> Fraction:
        return sum((c * x**n for n, c in enumerate(row)), Fraction(0))

    def in_two(weights: list[Fraction]) -> Array:
        return np.array([[float(w) for w in weights], [float(w - Fraction(float(w))) for w in weights]])

    A = in_two([at(row, last + 1) - at(row, last) for row in rows])
    B = in_two([at(row, last) - at(row, last - 1) for row in rows])
    S = [[at(row, node) - at(row, nodes[0]) for row in rows] for node in nodes]
    return A, B, np.array(S, float), np.array(rows, float)


@dataclass(frozen=True)
class _Piece:
    """A run of n equal steps h from the time t, by the Adams pair of order q. `states` and their rates y' in `velocities` have
    the shape (n + 1, d). The next step is `change` times as long."""

    q: int
    t: float
    h: float
    states: Array
    velocities: Array
    evaluations: int
    change: float

    def read(self, times: Array) -> Array:
        """Return the states (m, d) at times (m,) within the piece, by the interpolating polynomial of the Adams pair."""
        q = self.q
        P = adams_weights(q)[3]
        steps = (times - self.t) / self.h
        middle = np.clip(np.floor(steps).astype(int), q // 2, len(self.states) - q + q // 2)
        weights = np.vander(steps - middle, q + 1, increasing=True) @ P.T
        window = self.velocities[middle[:, None] + np.arange(q) - q // 2]
        return self.states[middle] + self.h * np.einsum("mj,mjd->md", weights, window)


def _piece(segment: Segment, q: int, y: Array, t: float, h: float, steps: int, limit: float) -> _Piece:
    """Take equal steps h until `steps` are made, or until h proves too long (change < 1) or needlessly short (change > 1). A step
    predicts, evaluates, corrects and evaluates. It keeps (corrector − predictor)/h below `limit` (Hairer, Nørsett & Wanner,
    III.1)."""
    rhs = segment.rhs
    A, B, _, _ = adams_weights(q)
    states, velocities, differences = np.empty((3, steps + 1, len(y)))
    evaluations, settled = _first_nodes(segment, q, y, t, h, states[:q], velocities[:q])
    if not settled:
        return _Piece(q, t, h, states[:1], velocities[:1], evaluations, 0.5)

    # Rounding error of (corrector − predictor)/h in the component that is fastest for its size.
    fastest = (np.abs(velocities[:q]).max(axis=0) / (1 + np.abs(states[q - 1]))).max()
    noise = 4 * np.finfo(float).eps * (np.abs(A[0]).sum() * fastest + 1 / h)
    limit = max(limit, noise)
    last, n = states[q - 1], q
    while n <= steps:
        block = range(n, min(n + (_BLOCK if n > q else 2 * q), steps + 1))
        for n in block:
            mean, residue = A.dot(velocities[n - q : n])
            predicted = last + h * (mean + residue)
            velocities[n] = rhs(t + n * h, predicted)
            mean, residue = B.dot(velocities[n - q + 1 : n + 1])
            states[n] = last = last + h * (mean + residue)
            differences[n] = last - predicted
            velocities[n] = rhs(t + n * h, last)
        evaluations += 2 * len(block)
        # Each component relative to its own size: an azimuth that grows without end would loosen all others.
        worst = (np.abs(differences[block.start : n + 1]).max(axis=0) / (1 + np.abs(last))).max() / h + 1e-300
        change = min(max(0.3, (limit / worst / 4) ** (1 / q)), 3.0) if np.isfinite(worst) else 0.3
        near = segment.time_to_singular and any(segment.clear(y) < h for y in states[block.start - q : n + 1])
        if near or not worst <= limit:
            change = min(change, 0.5) if near else change
            count = block.start if block.start > q else 1
            return _Piece(q, t, h, states[:count], velocities[:count], evaluations, change)
        if segment.project is not None:
            states[n] = last = segment.project(last)
        n += 1
        if worst < max(limit / 300, noise) and n <= steps and 1.3 * h < segment.longest:
            return _Piece(q, t, h, states[:n], velocities[:n], evaluations, change)
    return _Piece(q, t, h, states, velocities, evaluations, 1.0)


def _first_nodes(
    segment: Segment, q: int, y: Array, t: float, h: float, states: Array, velocities: Array
) -> tuple[int, bool]:
    """Compute the first q states and rates by iterating the integral equation of the motion. Return the number of evaluations,
    and True if the iteration converged."""
    S, size = h * adams_weights(q)[2], 1 + np.abs(y).max()
    states[:], velocities[:] = y, segment.rhs(t, y)
    evaluations = 1
    for sweep in range(_SWEEPS):
        previous = states.copy()
        states[:] = y + S @ velocities
        for i in range(1, q):
            velocities[i] = segment.rhs(t + i * h, states[i])
        evaluations += q - 1
        change = np.abs(states - previous).max()
        if sweep and not change > 2e-15 * size:
            break
    return evaluations, bool(change < 1e-13 * size)


def adams(segment: Segment, error: float) -> Stretch:
    """Solve the segment by the Adams predictor and corrector in equal steps, whose length follows from the difference of the two.
    Raise StopError if the evaluations so far imply far more than the budget, or if shorter steps have no smaller error. In the
    latter case the right-hand side is not accurate enough."""
    t_eval, right, y, t, longest = segment.t_eval, segment.until, segment.start, segment.begin, segment.longest
    q, limit = adams_order(error), min(100 * error, 1e-3)  # at order 10, steps with a larger difference are unstable
    h = min(
        (right - t) / q,
        segment.longest,
        min(limit ** (1 / q) / 5, 0.05) / (max(segment.relative_speed, segment.typical_rate) + 1e-300),
    )
    states, count, evaluations, end, in_vain = np.empty((len(t_eval), len(y))), 0, 1, y, 0
    while t < right:
        steps = min(max(int(np.ceil((right - t) / h)), q), _PIECE)
        with np.errstate(all="ignore"):  # too long a step overflows, and is shortened
            piece = _piece(replace(segment, longest=longest), q, y, t, h, steps, limit)
        evaluations += piece.evaluations
        in_vain = in_vain + 1 if len(piece.states) == 1 and piece.change > 0.5 else 0
        # A step that was too long, for its error or its stability, is not tried again for a while.
        if piece.change < 1:
            longest = 1.2 * piece.change * h
        elif len(piece.states) > _PIECE:
            longest = min(1.5 * longest, segment.longest)
        if len(piece.states) > 1:
            reached = t + (len(piece.states) - 1) * h
            until = int(np.searchsorted(t_eval, reached, side="right")) if reached < right else len(t_eval)
            states[count:until] = piece.read(t_eval[count:until])
            end = piece.read(np.array([right]))[0] if reached >= right else end
            count, t, y = until, reached, piece.states[-1]
        h = min(h * min(piece.change, 2.0), longest)
        share = (t - segment.begin) / (right - segment.begin)
        exhausted = evaluations > min(segment.budget, _PATIENCE + share * segment.budget)
        if t < right and (exhausted or in_vain == _IN_VAIN or t + h == t):
            reason = f"steps of {h:.1e} have no smaller error than longer ones"
            reason = f"the run did not end within {evaluations} evaluations" if exhausted else reason
            reached = Stretch(states_on_constraints(segment.project, states[:count]), y, evaluations)
            raise StopError(t, reason, reached, cause="budget" if exhausted else "stopped")
    if not (np.isfinite(end).all() and np.isfinite(states).all()):
        raise StopError(t, "a value is not finite", evaluations=evaluations)
    end = segment.project(end) if segment.project else end
    return Stretch(states_on_constraints(segment.project, states), end, evaluations)
