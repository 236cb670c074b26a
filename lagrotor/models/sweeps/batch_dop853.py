"""Many trajectories of one right-hand side side by side, by DOP853, each with its own time and step.

One step of all n costs the same array operations as a step of one, so that the interpreter is paid for once. Those that
have arrived leave; nobody waits.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.pulse import PULSE_REACH

Array = NDArray[np.float64]
Index = NDArray[np.intp]
# (s (n,), y (d, n), into (d, n)): writes y' into its last argument. Made anew for those who are left.
Rates = Callable[[Array, Array, Array], None]
_SHRINK, _GROW, _SAFE = 0.2, 10.0, 0.9
LEAST_TOLERANCE = 20 * 2.3e-14  # below it every step is refused for what rounding leaves
_LEAST = 1e-14  # of the run or of the pulse's width: a step below it goes nowhere
# Evaluations in all, and more for each radian of `fastest` that is done: three times what motions take at a tolerance of 1e-13
# that stay clear of singular positions.
_PATIENCE, _PER_RADIAN = 5_000, 250


@dataclass(frozen=True, eq=False)
class Swarm:
    """n problems y' = rates(s, y) with s = t − at, y = start (d, n) at t = 0.

    rates: given the indices of those still on their way, their right-hand side. fastest (n,), rad/s: for the first step, and
    for the evaluations after which one is stopped. at, width (n,), s: pulses, within 6.5 widths of which no step is longer
    than `longest` widths, and at whose edges a step ends; width 0 for none.
    """

    rates: Callable[[Index], Rates]
    start: Array
    fastest: Array
    at: Array
    width: Array
    longest: float = 1.0

    def part(self, who: Index) -> "Swarm":
        """Those of the indices `who`."""
        return replace(
            self,
            rates=lambda left: self.rates(who[left]),
            start=self.start[:, who],
            fastest=self.fastest[who],
            at=self.at[who],
            width=self.width[who],
        )


def march_swarm(swarm: Swarm, times: Array, tol: float) -> tuple[Array, NDArray[np.int64]]:
    """States (n, m, d) at the times (m,), increasing from 0 or later, and evaluations (n,).

    DOP853 (Hairer, Nørsett & Wanner, II.5) with the error norm of scipy's, taken for each trajectory by itself, and a
    local error of tol / 20, as in `numerics.solve`. One that gets stuck or takes far more evaluations than what is
    done is worth leaves NaN from there on.
    """
    (d, n), m, error = swarm.start.shape, len(times), max(tol / 20, 2.3e-14)
    states, spent = np.full((n, m, d), np.nan), np.zeros(n, np.int64)
    first = int(times[0] == 0)
    if first:
        states[:, 0] = swarm.start.T
    if first == m:
        return states, spent
    with np.errstate(all="ignore"):
        _march(swarm, times, error, first, states, spent)
    return states, spent


def _march(swarm: Swarm, times: Array, error: float, first: int, states: Array, spent: NDArray[np.int64]) -> None:
    n, m = states.shape[:2]
    who, reach = np.arange(n), PULSE_REACH * swarm.width
    s, y, h = -swarm.at, swarm.start, 0.5 * error ** (1 / 8) / swarm.fastest
    least = _LEAST * np.where(swarm.width > 0, np.minimum(swarm.width, times[-1]), times[-1])
    following, pulsed = np.full(n, first), bool((swarm.width > 0).any())
    rates, room = swarm.rates(who), np.empty((13, *y.shape))
    rates(s, y, room[0])
    spent += 1
    while who.size:
        target = times[following] - swarm.at[who]
        stop, longest = target, h
        if pulsed:
            edge = reach[who]
            stop = np.minimum(target, np.where(s < -edge, -edge, np.where(s < edge, edge, np.inf)))
            longest = np.where((s >= -edge) & (s < edge), np.minimum(h, swarm.longest * swarm.width[who]), h)
        step = np.minimum(longest, stop - s)
        last = step == stop - s
        after, size = _step(rates, s, y, step, error, room)
        spent[who] += 12
        ok = size < 1
        factor = np.clip(np.nan_to_num(_SAFE * size ** (-1 / 8), nan=_SHRINK), _SHRINK, _GROW)
        h = np.where(ok & (step < h), np.maximum(h, step * factor), step * factor)
        s = np.where(ok, np.where(last, stop, s + step), s)
        y = np.where(ok, after, y)
        np.copyto(room[0], room[12], where=ok)
        there = ok & (s == target)
        if there.any():
            states[who[there], following[there]] = y[:, there].T
            following = following + there
        worth = _PATIENCE + _PER_RADIAN * swarm.fastest[who] * (s + swarm.at[who])
        stay = (following < m) & (spent[who] < worth) & (ok | (step > least[who]))
        if not stay.all():
            who, s, h, following = who[stay], s[stay], h[stay], following[stay]
            f, y, rates = room[0][:, stay], y[:, stay], swarm.rates(who)
            room = np.empty((13, *y.shape))
            room[0] = f


def _step(rates: Rates, s: Array, y: Array, h: Array, error: float, room: Array) -> tuple[Array, Array]:
    """One step h (n,) of all from y (d, n), whose rates are room[0]: y after it, and the error's norm (n,) in units of
    what is allowed. room (13, d, n): the stages; its last holds the rates after the step."""
    from scipy.integrate import DOP853

    d, n = y.shape
    flat, place = room.reshape(13, d * n), np.empty((d, n))

    def moved(weights: Array) -> Array:
        # Not a matrix product: its threads would fight for the cores that other chunks run on.
        np.einsum("i,ik->k", weights, flat[: len(weights)], out=place.reshape(d * n))
        np.multiply(place, h, out=place)
        return place

    for i in range(1, 12):
        rates(s + DOP853.C[i] * h, np.add(moved(DOP853.A[i, :i]), y, out=place), room[i])
    after = moved(DOP853.B) + y
    rates(s + h, after, room[12])
    scale = error * (1 + np.maximum(abs(y), abs(after)))
    fifth, third = (((moved(weights) / scale) ** 2).sum(0) for weights in (DOP853.E5, DOP853.E3))
    size = fifth / np.sqrt((fifth + 0.01 * third) * d)
    return after, np.where(fifth == 0, 0.0, size)
