"""The slow motion after a shock, measured on exact runs: mean rates, the force that cancels a drift, times to leave.

Oscillations are averaged out by the weight exp(−1/(u (1 − u))) over the window, u from 0 to 1: of one with n turns within
it about exp(−sqrt(4 pi n)) is left (`mean_error`). A mean rate depends on the window besides, as the rate itself changes.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError
from lagrotor.models.model import Array, scenes_of
from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import check_times
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.theory.averaged_motion import time_to_reach
from lagrotor.theory.charged_particle import guiding_centre
from lagrotor.theory.drift_after_shock import cancelling_force
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.shock_response import shock_response

_SAMPLES = 32  # a turn of the swing
_AT_ENDS = 185.51  # 2 sqrt(pi)/(e Z), Z = 0.0070298584
_ROUNDED = 1e-15
_CENTRES = 9  # of the exact motion within a swing
_LONGEST, _MOST = 3, 10_000  # times what the averaged motion takes, of an exact run; swings that it lasts


def mean_over(t: Array, values: Array) -> float:
    """Mean of values (n,) at evenly spaced times t (n,), oscillations averaged out.

    Raises:
        DomainError: for n < 8.
    """
    if len(t) < 8:
        raise DomainError(f"mean_over: {len(t)} values are too few for a mean")
    u = (t[1:-1] - t[0]) / (t[-1] - t[0])
    weight = np.exp(-1 / (u * (1 - u)))
    return float((weight * values[1:-1]).sum() / weight.sum())


def mean_error(values: Array, turns: float) -> float:
    """What an oscillation of `turns` periods within the window can add to `mean_over` of values (…, n).

    The amplitude, at most half the range of the values over cos(pi turns/(n − 1)), times the weight's Fourier transform, to
    which the ends of the window contribute, where the weight is exp(−1/u − 1):

        2 sqrt(pi)/(e Z) (2 pi turns)^(−3/4) exp(−sqrt(4 pi turns)),    Z = ∫ exp(−1/(u (1 − u))) du,

    whose next term, −0.57/sqrt(2 pi turns) of it, is negative. The run's own tolerance comes on top.

    Raises:
        DomainError: below 4 turns, or with fewer than 3 values a turn, where it is no bound.
    """
    if not 4 <= turns <= (values.shape[-1] - 1) / 3:
        raise DomainError(
            f"mean_error: {values.shape[-1]} values over {turns:g} turns: take 4 turns or more, and 3 values or more of each"
        )
    left = _AT_ENDS * (2 * np.pi * turns) ** -0.75 * np.exp(-np.sqrt(4 * np.pi * turns))
    amplitude = np.ptp(values) / 2 / np.cos(np.pi * turns / (values.shape[-1] - 1))
    return float(left * amplitude + _ROUNDED * np.abs(values).max())


def turning_rate(run: Trajectory) -> float:
    """Mean alpha' (rad/s) of both axes over a run of evenly spaced times, alpha the angle about the joint line."""
    r, v = run.axes, run.rates
    rate = (r[..., 1] * v[..., 2] - r[..., 2] * v[..., 1]) / (r[..., 1] ** 2 + r[..., 2] ** 2)
    return mean_over(run.t, rate.mean(0))


def wandering_rate(run: Trajectory) -> float:
    """Mean x' (1/s) of both axes over a run of evenly spaced times."""
    return mean_over(run.t, run.rates[..., 0].mean(0))


def run_after(scene: Scene, turns: int = 24, tol: float = 1e-11) -> Trajectory:
    """An exact run from the end of a scene's shock, evenly sampled.

    Args:
        scene: with a shock.
        turns: swings that it lasts.
        tol: as in `simulate`.

    Raises:
        InputError: without a shock or spin.
    """
    response = shock_response(scene)
    if scene.shock is None or response.frequency == 0:
        raise InputError("run_after: the scene needs a shock and a spin")
    begin = scene.shock.end
    t = np.linspace(begin, begin + turns * 2 * np.pi / response.frequency, turns * _SAMPLES + 1)
    return simulate(scene, [0.0, *t], "minimal", tol).after(begin)


def exact_cancelling_force(scene: Scene, turns: int = 24) -> float:
    """F_y (N) beside the scene's force along x for which the exact mean turning over `turns` swings vanishes.

    To 1e-7 of itself; it depends on `turns`, as the turning that is left changes with time.

    Raises:
        InputError: as `cancelling_force`.
        DomainError: where no such force is found.
    """
    from scipy.optimize import newton

    if scene.shock is None:
        raise InputError("exact_cancelling_force: the scene has no shock")
    shock, guess = scene.shock, cancelling_force(scene)

    def turning(force: float) -> float:
        moved = replace(shock, force=(shock.force[0], force, 0.0))
        return turning_rate(run_after(replace(scene, shock=moved), turns, 1e-10))

    try:
        return float(newton(turning, guess, x1=1.03 * guess, tol=1e-7 * abs(guess), maxiter=20))
    except RuntimeError:
        raise DomainError(
            f"exact_cancelling_force: no force near {guess:.4g} N, that of a weak shock, is found that stops the turning; "
            "take a weaker shock or fewer turns"
        ) from None


def time_to_wander(scene: Scene, bound: float, longest: float) -> float:
    """Time (s) from the shock's peak until the mean of both x, averaged over six swings, reaches ± `bound`.

    Args:
        scene: with a shock.
        bound: of x, in units of R.
        longest: s, after which it is given up.

    Raises:
        DomainError: when it does not within `longest`.
    """
    time = _time_to_wander(scene, bound, longest)
    if time == np.inf:
        raise DomainError(f"the bound {bound:g} is not reached within {longest:g} s")
    return time


def time_to_reach_error(scene: Scene, x: float) -> float:
    """How far (s) `time_to_reach` is from the time at which the exact mean over six swings (`time_to_wander`) gets there.

    A sample of that run, 1/32 swing, is added. inf where either does not get there, the exact one within 3 times as long.

    Raises:
        InputError: as `time_to_reach`.
        DomainError: likewise, where x is reached within the first swings, and where the exact run is longer than 10⁴ swings.
    """
    law, turn = time_to_reach(scene, x), 2 * np.pi / natural_rate(scene)
    swings = _LONGEST * law / turn
    if _MOST < swings < np.inf:
        raise DomainError(
            f"time_to_reach_error: the exact run takes up to {swings:.2g} swings, more than {_MOST}: the averaged motion gives "
            f"{law:.4g} s; take a larger shock or a smaller x"
        )
    return float(abs(_time_to_wander(scene, x, _LONGEST * law) - law)) + turn / _SAMPLES if law < np.inf else np.inf


def guiding_centre_error(scene: Scene, t: ArrayLike) -> Array:
    """How far (rad) `guiding_centre(scene).path(t)` is from the exact motion, (n,): in beta, h or alpha from the centre of the
    exact state, the most in a swing about each time, as that centre, of leading order itself, swings a little.

    Raises:
        InputError: as `guiding_centre` and its path.
        DomainError: likewise, where the exact motion has no centre, and where it is longer than 10⁴ swings.
    """
    centre, turn = guiding_centre(scene), 2 * np.pi / abs(natural_rate(scene))
    times = check_times("guiding_centre_error", t)
    if (swings := times[-1] / turn) > _MOST:
        raise DomainError(
            f"guiding_centre_error: the exact run is {swings:.2g} swings long, more than {_MOST}: take earlier times, or compare "
            "with lagrotor.simulate"
        )
    centre.path(times)  # refuses what it does not reach
    around = np.maximum(times[:, None] + turn * (np.arange(_CENTRES) / (_CENTRES - 1) - 0.5), 0.0)
    each, of = np.unique(np.append(around, 0.0), return_inverse=True)
    run, path = simulate(scene, each, "minimal", 1e-9), centre.path(each)
    off = path - [guiding_centre(start).place for start in scenes_of(scene, run)]
    off[:, 2] = (off[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return np.asarray(np.abs(off).max(1)[of[:-1]].reshape(around.shape).max(1))


def _time_to_wander(scene: Scene, bound: float, longest: float) -> float:
    """As `time_to_wander`; inf where it is not reached."""
    run = run_after(scene, 6 + int(np.ceil(longest * shock_response(scene).frequency / (2 * np.pi))), 1e-9)
    t, values, shock = run.t, run.axes[..., 0].mean(0), scene.shock
    assert shock is not None
    u = (np.arange(6 * _SAMPLES) + 0.5) / (6 * _SAMPLES)
    weight = np.exp(-1 / (u * (1 - u)))
    mean = np.convolve(values, weight / weight.sum(), "valid")
    centre = t[0] + (np.arange(len(mean)) + (len(u) - 1) / 2) * (t[1] - t[0])
    beyond = np.abs(mean) >= bound
    if not beyond.any():
        return np.inf
    i = int(np.argmax(beyond))
    if i == 0:
        raise DomainError(f"the bound {bound:g} is reached within the first swings: take a larger one")
    share = (bound - abs(mean[i - 1])) / (abs(mean[i]) - abs(mean[i - 1]))
    return float(centre[i - 1] + share * (centre[i] - centre[i - 1]) - shock.at)
