"""Parallel integration of many trajectories of one right-hand side by DOP853, each with its own time, step and tolerance.

A step of all n costs the same array operations as a step of one, so that the overhead of the interpreter is paid once.
Trajectories that have arrived leave the batch, a tenth of them at a time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.error_estimate import Legs, Motions
from lagrotor.numerics.pulse import COMPANION_STEP, PULSE_REACH
from lagrotor.numerics.segment import Array, Cause, StopError, Stretch

Index = NDArray[np.intp]
# (s (n,), y (d, n), into (d, n)): writes y' into its last argument. It is rebuilt for the active problems.
Rates = Callable[[Array, Array, Array], None]
_SHRINK, _GROW, _SAFE = 0.2, 10.0, 0.9
_TIGHTEST = 2.3e-14  # the least local error: below it rounding rejects every step
_LEAST = 1e-14  # the least step relative to the run or the width of the pulse
_BETWEEN = 0.38  # the fraction of a leg at which a companion ends a step, so that its steps differ
_PATIENCE = 5_000  # evaluations before they are compared with the progress in the leg
_FULL = 0.9  # the fraction of active legs below which the others leave the batch


@dataclass(frozen=True, eq=False)
class Swarm:
    """n problems y' = rates(s, y) with s = t − at, which are integrated together.

    - `rates`: a function of the indices of the active problems that returns their right-hand side.
    - `first`: a rate, rad/s, that bounds the first step.
    - `at` and `width`: the time and the width of the pulse of each problem, (n,); the width 0 means none. Steps end at the
      edges of a pulse, and no step within it exceeds the width.
    """

    rates: Callable[[Index], Rates]
    first: float
    at: Array
    width: Array


def march_swarm(swarm: Swarm, who: Index, legs: Legs) -> Motions:
    """Integrate n legs, each of the problem with the number in `who` (n,).

    The method is DOP853 (Hairer, Nørsett & Wanner, II.5) with scipy's error norm for each trajectory and dense output between
    the steps. As in `numerics.integrate`, the local error is a twentieth of the local error of the leg.
    """
    with np.errstate(all="ignore"):
        return _march(swarm, who, legs)


def _march(swarm: Swarm, who: Index, legs: Legs) -> Motions:
    motions, width = Motions.begun(legs), swarm.width[who]
    times, reach = legs.times - swarm.at[who, None], PULSE_REACH * width
    begin, end = times[:, 0], times[:, -1]
    between = np.where(legs.companion, _BETWEEN, 1.0) * (end - begin) + begin
    # By leg: where its steps end, the edges and the longest step of its pulse, its error, times, least step and budget.
    columns = np.array([
        between, end, -reach, np.where(reach > 0, reach, -np.inf), reach,
        np.where(legs.companion, COMPANION_STEP, 1.0) * width, np.maximum(legs.local / 20, _TIGHTEST), begin, end,
        _LEAST * np.where(reach > 0, np.minimum(width, end - begin), end - begin), legs.budget,
    ])  # fmt: skip
    error, following, evaluations = columns[6], np.ones(len(who), np.int64), np.ones(len(who), np.int64)
    lane = np.arange(len(who))  # the legs in the batch; those that have ended take steps of length zero
    s, y, h, active = begin.copy(), legs.start.T.copy(), 0.5 * error ** (1 / 8) / swarm.first, np.ones(len(who), bool)
    rates, room, pulses = swarm.rates(who), np.empty((13, *y.shape)), bool(reach.any())
    rates(s, y, room[0])
    while active.any():
        halts, (reach, longest, error, begin, end, least, budget) = columns[:4], columns[4:]
        stop = np.where(halts > s, halts, np.inf).min(0)
        step = np.minimum(np.where((s >= -reach) & (s < reach), np.minimum(h, longest), h) if pulses else h, stop - s)
        step[~active] = 0.0
        proposed, size = _step(rates, s, y, step, error, room)
        ok = (size < 1) & active
        factor = np.fmax(np.minimum(_SAFE * size ** (-1 / 8), _GROW), _SHRINK)
        later = np.where(step == stop - s, stop, s + step)
        # Output within a step costs three more evaluations, at the end of a leg none.
        at = np.flatnonzero(ok & (times[lane, following] < later))
        evaluations += 12 * active
        if at.size:
            evaluations[at] += 3
            dense = _dense_output(
                swarm.rates(who[lane[at]]), s[at], y[:, at], proposed[:, at], step[at], room[:, :, at]
            )
            inside = np.arange(at.size)
            while inside.size:
                chosen = at[inside]
                lanes, place = lane[chosen], following[chosen]
                x = (times[lanes, place] - s[chosen]) / step[chosen]
                motions.components[:, lanes, place] = y[:, chosen] + _interpolated(dense[:, :, inside], x)
                following[chosen] += 1
                inside = inside[times[lanes, place + 1] < later[chosen]]
        h = np.where(ok & (step < h), np.maximum(h, step * factor), step * factor)
        s, y = np.where(ok, later, s), np.where(ok, proposed, y)
        np.copyto(room[0], room[12], where=ok)
        arrived, share = s == end, (s - begin) / (end - begin)
        over = evaluations > np.minimum(budget, _PATIENCE + share * budget)
        ended = active & (arrived | over | ~(ok | (step > least)))
        if not ended.any():
            continue
        for i in np.flatnonzero(ended).tolist():
            k, first, used = int(lane[i]), int(following[i]), int(evaluations[i])
            motions.components[:, k, first:], motions.evaluations[k] = y[:, i, None], used
            if not arrived[i]:
                cause: Cause = "budget" if over[i] else "stopped"
                reason = f"{used} evaluations spent" if over[i] else "the step is below what doubles resolve"
                reached = Stretch(motions.states[k, :first].copy(), y[:, i].copy(), used)
                motions.reached[k] = first
                motions.stops[k] = StopError(float(s[i] + swarm.at[who[k]]), reason, reached, cause=cause)
        active &= ~ended
        if active.sum() < _FULL * len(active):
            lane, following, evaluations = lane[active], following[active], evaluations[active]
            s, h, y, columns, f = s[active], h[active], y[:, active], columns[:, active], room[0][:, active]
            active = np.ones(len(lane), bool)
            rates, room = swarm.rates(who[lane]), np.empty((13, *y.shape))
            room[0] = f
    return motions


def _step(rates: Rates, s: Array, y: Array, h: Array, error: Array, room: Array) -> tuple[Array, Array]:
    """Return the states y (d, n) after a step h (n,) of each problem, and the norm of each error (n,). `room` (13, d, n) has
    the derivative at the start in its first entry, and receives the other stages of the method."""
    from scipy.integrate import DOP853

    d, n = y.shape
    flat, place = room.reshape(13, d * n), np.empty((d, n))

    def moved(weights: Array) -> Array:
        # Not a matrix product, whose threads would compete with other chunks for the cores.
        np.einsum("i,ik->k", weights, flat[: len(weights)], out=place.reshape(d * n))
        np.multiply(place, h, out=place)
        return place

    for i in range(1, 12):
        rates(s + DOP853.C[i] * h, np.add(moved(DOP853.A[i, :i]), y, out=place), room[i])
    end = moved(DOP853.B) + y
    rates(s + h, end, room[12])
    scale = error * (1 + np.maximum(abs(y), abs(end)))
    fifth, third = (((moved(weights) / scale) ** 2).sum(0) for weights in (DOP853.E5, DOP853.E3))
    size = fifth / np.sqrt((fifth + 0.01 * third) * d)
    return end, np.where(fifth == 0, 0.0, size)


def _dense_output(rates: Rates, s: Array, y: Array, end: Array, h: Array, room: Array) -> Array:
    """Return the coefficients (7, d, n) of the interpolation over a step h (n,) from y (d, n) to `end` (d, n). `room` (13, d,
    n) contains the stages of the step."""
    from scipy.integrate import DOP853

    stages = np.concatenate([room, np.empty((3, *y.shape))])
    for i, (a, c) in enumerate(zip(DOP853.A_EXTRA, DOP853.C_EXTRA, strict=True), start=13):
        rates(s + c * h, y + h * np.einsum("i,idn->dn", a[:i], stages[:i]), stages[i])
    change = end - y
    first = [change, h * stages[0] - change, 2 * change - h * (stages[12] + stages[0])]
    return np.concatenate([first, h * np.einsum("ji,idn->jdn", DOP853.D, stages)])


def _interpolated(dense: Array, x: Array) -> Array:
    """Return the change (d, n) of the states from the start of a step to its fraction x (n,)."""
    value = np.zeros(dense.shape[1:])
    for i, coefficient in enumerate(dense[::-1]):
        value = (value + coefficient) * (1 - x if i % 2 else x)
    return value
