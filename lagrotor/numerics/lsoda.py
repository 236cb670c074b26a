"""LSODA, Adams and BDF methods of variable order (Petzold 1983), in scipy's compiled loop: only the right-hand side is Python."""

import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from lagrotor.numerics.segment import LOST, Array, Cause, RightHandSide, Segment, StopError, Stretch

_BUDGET_OF_A_PART = 5_000  # between two projections; beyond it the solver no longer follows the motion
_LEAST_CUT = 1e-12  # of a segment: shorter parts between two projections come nowhere
_DRIFT = 200.0  # local errors that the constraints may gather between projections: the error of the run as a whole


def lsoda(segment: Segment, error: float) -> Stretch:
    """The segment at a local error `error`, relative and absolute.

    The first step is given, not found from the first output, so outputs do not change the run. Where there are
    constraints the run is cut about once a turn and projected: their error grows exponentially where the axes are pressed.
    Raises StopError with what was reached.
    """
    if segment.project is None:
        return _lsoda(segment, error)
    parts, spent, left, y, longest_cut = [np.empty((0, len(segment.start)))], 0, segment.left, segment.start, np.inf

    def stopped(reason: str, cause: Cause = "stopped") -> StopError:
        return StopError(left, reason, _on_constraints(segment, parts, y, spent), cause=cause)

    while left < segment.right:
        if spent > segment.budget:
            raise stopped(f"{spent} evaluations spent", "budget")
        cut = min(5 / (replace(segment, left=left, start=y).relative_speed + 1e-300), longest_cut, segment.clear(y))
        if cut < _LEAST_CUT * (segment.right - segment.left):
            raise stopped("the next step might pass a singular position")
        right = left + cut if left + 1.5 * cut < segment.right else segment.right
        # A state with constraints moves no more than a fifth in a step, so that none leaps over where they fail.
        longest = min(segment.longest, cut / 25)
        part = replace(segment, start=y, left=left, right=right, longest=longest)
        try:
            part, run = _up_to_singular(part, min(segment.budget - spent, _BUDGET_OF_A_PART), error)
            end, spent = segment.project(run.end), spent + run.evaluations + 1
            drifted = np.abs(end - run.end).max() / (1 + np.abs(end).max())
        except StopError as stop:
            drifted, spent = np.inf, spent + stop.evaluations
            if cut < longest_cut / 2 or spent > segment.budget:
                raise stopped(stop.reason, stop.cause) from None
        if not drifted <= _DRIFT * error:  # what has grown so far would not be brought back to where it left
            longest_cut = cut / 8
            if longest_cut < 1e-6 * (segment.right - segment.left):
                raise stopped("the constraints drift faster than they can be kept")
            continue
        parts.append(run.states)
        y, left, longest_cut = end, part.right, 1.5 * longest_cut
    run = _on_constraints(segment, parts, y, spent)
    if not np.isfinite(run.states).all():
        raise StopError(segment.left, "a state could not be brought back onto its constraints", evaluations=spent)
    return run


def _on_constraints(segment: Segment, parts: list[Array], y: Array, spent: int) -> Stretch:
    states = np.concatenate(parts)
    if segment.project and len(states):
        states = segment.project(segment.project(states.T)).T  # of a drift one step leaves about the square
    return Stretch(states, y, spent)


def _up_to_singular(part: Segment, budget: float, error: float) -> tuple[Segment, Stretch]:
    """The part of a run, or what of it comes before its steps might pass a singular position, and its run."""
    wanted = part.t_eval[(part.t_eval > part.left) & (part.t_eval <= part.right)]
    if part.time_to_singular is None:
        return part, _lsoda(replace(part, t_eval=wanted, budget=budget), error)
    count = 65 + int(2 * (part.right - part.left) / part.longest)  # two times or more in a longest step
    # The end is one of them: a run that stopped between the last time before it and the end has not come to the end.
    t_eval = np.union1d(wanted, np.linspace(part.left, part.right, count)[1:])
    run = _lsoda(replace(part, t_eval=t_eval, budget=budget), error)
    n = len(run.states)
    shorter = part if n == len(t_eval) else replace(part, right=float(t_eval[n - 1]))
    wanted = wanted[wanted <= shorter.right]
    return shorter, replace(run, states=run.states[np.searchsorted(t_eval, wanted)])


def _lsoda(segment: Segment, error: float) -> Stretch:
    """The segment, or what of it comes before a state whose next step might pass a singular position."""
    left, right, spent, lost, near, stopped = segment.left, segment.right, 0, False, False, False
    at = done = left  # the time of the last evaluation, and one before it up to which the steps are accepted
    rest = [0.0] * len(segment.start)

    def watched(s: float, y: Array) -> list[float]:
        # LSODA takes NaN for a number and may step over where it came from; DOP853 does not. Once it is to stop, it is given
        # a state at rest: it soon comes to the end, and what it read off before is kept.
        nonlocal spent, lost, near, stopped, at, done
        if stopped:
            return rest
        at, done = s, at if s > at else done
        velocity = segment.rhs(s, y)
        spent, lost = spent + 1, velocity[0] != velocity[0]
        near = segment.clear(y) < segment.longest
        stopped = lost or near or spent > segment.budget
        return rest if stopped else velocity

    first = min(np.sqrt(error) / (1 + np.abs(segment.rhs(left, segment.start)).max()), segment.longest, right - left)
    bare, unwatched = None if segment.time_to_singular else getattr(segment.rhs, "bare", None), 0
    if bare:

        def counted(s: float, y: Array) -> list[float]:
            nonlocal unwatched
            unwatched += 1
            if unwatched > segment.budget:  # scipy's bound is one of steps between two outputs
                raise OverflowError
            velocity: list[float] = bare(s, y)
            return velocity

        try:
            states, log = _odeint(segment, counted, error, first)
            if _successful(states, log):
                return Stretch(states[1:-1], states[-1], unwatched + 1)
        except LOST:
            pass
    # What fails unwatched is run again to see where: it takes the same steps.
    states, log = _odeint(segment, watched, error, first)
    spent += 1 + unwatched
    if stopped or not _successful(states, log):
        # Of one that fails by itself, what comes after its last step is no number that it made.
        states = states[1:-1][segment.t_eval <= done]
        whole = np.isfinite(states).all(1)
        states = states if whole.all() else states[: int(np.argmin(whole))]
        reached = Stretch(states, states[-1], spent) if len(states) else None
        if near and reached:
            return reached
        reasons = {
            "the right-hand side is not finite": lost,
            "the next step might pass a singular position": near,
            f"{spent} evaluations spent": stopped,
            log["message"]: True,
        }
        until = float(segment.t_eval[len(states) - 1]) if reached else left
        cause: Cause = "budget" if stopped and not (lost or near) else "stopped"
        raise StopError(until, next(why for why, so in reasons.items() if so), reached, spent, cause)
    return Stretch(states[1:-1], states[-1], spent)


def _odeint(segment: Segment, rhs: RightHandSide, error: float, first: float) -> tuple[Array, dict[str, Any]]:
    """States at the segment's ends and the times between them, and scipy's log."""
    from scipy.integrate import odeint

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        states, log = odeint(
            rhs,
            segment.start,
            np.concatenate([[segment.left], segment.t_eval, [segment.right]]),
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
