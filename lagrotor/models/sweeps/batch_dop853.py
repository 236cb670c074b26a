"""Parallel integration of many trajectories of one right-hand side by DOP853, each with its own time, step and tolerance.

A step of all n costs the same array operations as a step of one, so that the overhead of the interpreter is paid once.
Trajectories that have arrived leave the batch.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.error_estimate import Leg
from lagrotor.numerics.pulse import COMPANION_STEP, PULSE_REACH
from lagrotor.numerics.segment import Array, StopError, Stretch

Index = NDArray[np.intp]
# (s (n,), y (d, n), into (d, n)): writes y' into its last argument. It is rebuilt for the active problems.
Rates = Callable[[Array, Array, Array], None]
_SHRINK, _GROW, _SAFE = 0.2, 10.0, 0.9
_TIGHTEST = 2.3e-14  # the least local error: below it rounding rejects every step
_LEAST = 1e-14  # the least step relative to the run or the width of the pulse
_BETWEEN = 0.38  # the fraction of a leg at which a companion ends a step, so that its steps differ
_PATIENCE = 5_000  # evaluations before they are compared with the progress in the leg


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


def march_swarm(swarm: Swarm, legs: Mapping[int, Leg]) -> dict[int, Stretch | StopError]:
    """Integrate segments of some problems, and return {number of the problem: its states, or the error that stopped it}.

    `legs` maps the number of a problem to its segment. The method is DOP853 (Hairer, Nørsett & Wanner, II.5) with scipy's error
    norm for each trajectory and dense output between the steps. As in `numerics.integrate`, the local error is a twentieth of
    the local error of the segment.
    """
    requests, n = list(legs.values()), len(legs)
    who, m = np.array(list(legs)), np.array([len(leg.times) for leg in requests])
    times = np.full((n, m.max()), np.inf)
    for row, leg in zip(times, requests, strict=True):
        row[: len(leg.times)] = leg.times
    times -= swarm.at[who, None]
    states = np.empty((*times.shape, len(requests[0].start)))
    states[:, 0] = [leg.start for leg in requests]
    with np.errstate(all="ignore"):
        return _march(swarm, who, requests, times, m, states)


def _march(
    swarm: Swarm, who: Index, requests: list[Leg], times: Array, m: NDArray[np.int64], states: Array
) -> dict[int, Stretch | StopError]:
    n = len(who)
    error = np.array([max(leg.local / 20, _TIGHTEST) for leg in requests])
    longest = np.array([COMPANION_STEP if leg.companion else 1.0 for leg in requests]) * swarm.width[who]
    budget = np.array([leg.budget for leg in requests])
    s, y, reach = times[:, 0].copy(), states[:, 0].T.copy(), PULSE_REACH * swarm.width[who]
    begin, end = s, times[np.arange(n), m - 1]
    between = np.array([_BETWEEN if leg.companion else 1.0 for leg in requests]) * (end - begin) + begin
    halts = np.array([between, end, -reach, np.where(reach > 0, reach, -np.inf)])
    least = _LEAST * np.where(reach > 0, np.minimum(swarm.width[who], end - begin), end - begin)
    h, evaluations, following = 0.5 * error ** (1 / 8) / swarm.first, np.ones(n, np.int64), np.ones(n, np.int64)
    answers: dict[int, Stretch | StopError] = {}
    lane = np.arange(n)  # the active problems
    rates, room = swarm.rates(who), np.empty((13, *y.shape))
    rates(s, y, room[0])
    while lane.size:
        stop = np.where(halts[:, lane] > s, halts[:, lane], np.inf).min(0)
        pulsed = (s >= -reach[lane]) & (s < reach[lane])
        step = np.minimum(np.where(pulsed, np.minimum(h, longest[lane]), h), stop - s)
        proposed, size = _step(rates, s, y, step, error[lane], room)
        evaluations[lane] += 12
        ok = size < 1
        factor = np.clip(np.nan_to_num(_SAFE * size ** (-1 / 8), nan=_SHRINK), _SHRINK, _GROW)
        later = np.where(step == stop - s, stop, s + step)
        # Output within a step costs three more evaluations, at the end of a leg none.
        at = np.flatnonzero(ok & (times[lane, following[lane]] < later))
        if at.size:
            evaluations[lane[at]] += 3
            dense = _dense_output(
                swarm.rates(who[lane[at]]), s[at], y[:, at], proposed[:, at], step[at], room[:, :, at]
            )
            inside = np.arange(at.size)
            while inside.size:
                lanes = lane[at[inside]]
                x = (times[lanes, following[lanes]] - s[at[inside]]) / step[at[inside]]
                states[lanes, following[lanes]] = (y[:, at[inside]] + _interpolated(dense[:, :, inside], x)).T
                following[lanes] += 1
                inside = inside[times[lanes, following[lanes]] < later[at[inside]]]
        h = np.where(ok & (step < h), np.maximum(h, step * factor), step * factor)
        s, y = np.where(ok, later, s), np.where(ok, proposed, y)
        np.copyto(room[0], room[12], where=ok)
        arrived = s == end[lane]
        share = (s - begin[lane]) / (end[lane] - begin[lane])
        over = evaluations[lane] > np.minimum(budget[lane], _PATIENCE + share * budget[lane])
        stay = ~arrived & ~over & (ok | (step > least[lane]))
        if not stay.all():
            for i in np.flatnonzero(~stay):
                k, used, read = int(who[lane[i]]), int(evaluations[lane[i]]), following[lane[i]]
                states[lane[i], read:] = y[:, i]
                stretch = Stretch(states[lane[i], : m[lane[i]] if arrived[i] else read], y[:, i].copy(), used)
                reason = f"{used} evaluations spent" if over[i] else "the step is below what doubles resolve"
                answers[k] = (
                    stretch
                    if arrived[i]
                    else StopError(float(s[i] + swarm.at[k]), reason, stretch, cause="budget" if over[i] else "stopped")
                )
            lane, s, h, y, f = lane[stay], s[stay], h[stay], y[:, stay], room[0][:, stay]
            rates, room = swarm.rates(who[lane]), np.empty((13, *y.shape))
            room[0] = f
    return answers


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
