"""The slow motion measured on exact runs: mean rates after a shock, the force that cancels a drift, times to leave, and by how
much the laws of `theory` for them are wrong.

Oscillations are averaged out by the weight exp(−1/(u (1 − u))) over the window, u from 0 to 1: of one with n turns within
it about exp(−sqrt(4 pi n)) is left. A mean rate depends on the window besides, as the rate itself changes.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import DomainError, InputError
from lagrotor.models.model import Array, scenes_of
from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import check_times
from lagrotor.pair.quantities import finite_number
from lagrotor.pair.scene import Scene
from lagrotor.pair.trajectory import Trajectory
from lagrotor.theory.averaged_motion import time_to_reach
from lagrotor.theory.charged_particle import guiding_centre
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.shock_response import shock_response

_SAMPLES = 32  # a turn of the swing
_LEAST = 4  # swings of an exact run, below which no mean separates the drift from the swing
_MOST = 10_000  # swings of an exact run, beyond which it takes too long
_LONGEST = 3  # times what the averaged motion takes, of an exact run


def mean_over(t: Array, values: Array) -> float:
    """Return the mean of values (n,) at evenly spaced times t (n,), oscillations averaged out.

    Raises
    ------
    DomainError
        For n < 8.
    """
    if len(t) < 8:
        raise DomainError(f"mean_over: {len(t)} values are too few for a mean")
    u = (t[1:-1] - t[0]) / (t[-1] - t[0])
    weight = np.exp(-1 / (u * (1 - u)))
    return float((weight * values[1:-1]).sum() / weight.sum())


def turning_rate(run: Trajectory) -> float:
    """Return the mean alpha' (rad/s) of both axes over a run of evenly spaced times, alpha the angle about the joint line."""
    r, v = run.axes, run.rates
    rate = (r[..., 1] * v[..., 2] - r[..., 2] * v[..., 1]) / (r[..., 1] ** 2 + r[..., 2] ** 2)
    return mean_over(run.t, rate.mean(0))


def wandering_rate(run: Trajectory) -> float:
    """Return the mean x' (1/s) of both axes over a run of evenly spaced times."""
    return mean_over(run.t, run.rates[..., 0].mean(0))


def run_after(scene: Scene, turns: float = 24, tol: float = 1e-11) -> Trajectory:
    """Return an exact run from the end of a scene's shock, evenly sampled.

    Parameters
    ----------
    scene : Scene
        With a shock.
    turns : float, default 24
        Swings that it lasts.
    tol : float, default 1e-11
        As in `simulate`.

    Raises
    ------
    InputError
        Without a shock or spin.
    """
    response = shock_response(scene)
    if scene.shock is None or response.frequency == 0:
        raise InputError("run_after: the scene needs a shock and a spin")
    begin = scene.shock.end
    t = np.linspace(begin, begin + turns * 2 * np.pi / response.frequency, round(turns * _SAMPLES) + 1)
    return simulate(scene, [0.0, *t], "minimal", tol).after(begin)


def exact_cancelling_force(scene: Scene, turns: float = 24) -> float:
    """Return F_y (N) beside the force along x for which the exact mean turning over `turns` swings vanishes.

    To 1e-7 of itself; it depends on `turns`, as the turning that is left changes with time.

    Raises
    ------
    InputError
        As `cancelling_force`.
    DomainError
        Where no such force is found.
    """
    from scipy.optimize import newton

    if scene.shock is None:
        raise InputError("exact_cancelling_force: the scene has no shock")
    shock, guess = scene.shock, cancelling_force(scene)

    def turning(force: float) -> float:
        trial = replace(shock, force=(shock.force[0], force, 0.0))
        return turning_rate(run_after(replace(scene, shock=trial), turns, 1e-10))

    try:
        return float(newton(turning, guess, x1=1.03 * guess, tol=1e-7 * abs(guess), maxiter=20))
    except RuntimeError:
        raise DomainError(
            f"exact_cancelling_force: no force near {guess:.4g} N, that of a weak shock, is found that stops the turning; "
            "take a weaker shock or fewer turns"
        ) from None


def time_to_wander(scene: Scene, bound: float, longest: float) -> float:
    """Return the time (s) from the shock's peak until the mean of both x, averaged over six swings, reaches ± `bound`.

    Parameters
    ----------
    scene : Scene
        With a shock.
    bound : float
        Of x, in units of R.
    longest : float
        S, after which it is given up.

    Raises
    ------
    DomainError
        When it does not within `longest`, or does within the first swings.
    """
    run = run_after(scene, 6 + int(np.ceil(longest * shock_response(scene).frequency / (2 * np.pi))), 1e-9)
    t, values, shock = run.t, run.axes[..., 0].mean(0), scene.shock
    assert shock is not None
    u = (np.arange(6 * _SAMPLES) + 0.5) / (6 * _SAMPLES)
    weight = np.exp(-1 / (u * (1 - u)))
    mean = np.abs(np.convolve(values, weight / weight.sum(), "valid"))
    if mean.max() < bound:
        raise DomainError(f"the bound {bound:g} is not reached within {longest:g} s")
    if (i := int(np.argmax(mean >= bound))) == 0:
        raise DomainError(f"the bound {bound:g} is reached within the first swings: take a larger one")
    index = i - 1 + (bound - mean[i - 1]) / (mean[i] - mean[i - 1]) + (len(u) - 1) / 2
    return float(t[0] + index * (t[1] - t[0]) - shock.at)


def toppling_error(scene: Scene, duration: float) -> float:
    """Return how far (rad/s) `toppling_after_shock` is from the exact mean rate.

    The mean is from the pulse's end to `duration` s after its peak.

    Raises
    ------
    InputError
        As `toppling_after_shock`, or the duration is no finite number.
    DomainError
        Below 4 swings after the pulse, or beyond 10⁴.
    """
    law = toppling_after_shock(scene)
    return abs(turning_rate(run_after(scene, _turns(scene, duration, "toppling_error"))) - law)


def wander_error(scene: Scene, duration: float) -> float:
    """Return how far (1/s) `wander_after_shock` is from the exact mean rate of x, over the same time as in `toppling_error`.

    Raises
    ------
    InputError
        As `toppling_error`.
    DomainError
        As `toppling_error`.
    """
    law = wander_after_shock(scene)
    return abs(wandering_rate(run_after(scene, _turns(scene, duration, "wander_error"))) - law)


def cancelling_force_error(scene: Scene, duration: float) -> float:
    """Return how far (N) `cancelling_force` is from the force that leaves no exact mean turning.

    The mean is over the same time as in `toppling_error`.

    Raises
    ------
    InputError
        As `toppling_error`.
    DomainError
        As `toppling_error` and `exact_cancelling_force`.
    """
    law, turns = cancelling_force(scene), _turns(scene, duration, "cancelling_force_error")
    return abs(exact_cancelling_force(scene, turns) - law) if law else 0.0  # nothing along x, nothing to cancel


def _turns(scene: Scene, duration: float, where: str) -> float:
    """Return the swings from the pulse's end to `duration` s after its peak."""
    assert scene.shock is not None
    delay, turn = scene.shock.end - scene.shock.at, 2 * np.pi / natural_rate(scene)
    turns = (finite_number(duration, f"{where}: duration", "s") - delay) / turn
    if not _LEAST * (1 - 1e-9) <= turns <= _MOST:
        raise DomainError(
            f"{where}: duration = {duration:g} s is {turns:.3g} swings after the pulse, over which no mean is known: take "
            f"{_LEAST * turn + delay:.3g} to {_MOST * turn + delay:.3g} s after its peak"
        )
    return turns


def time_to_reach_error(scene: Scene, x: float) -> float:
    """Return how far (s) `time_to_reach` is from the time at which the exact mean over six swings (`time_to_wander`) gets there.

    A sample of that run, 1/32 swing, is added. It is inf where the averaged motion does not get there.

    Raises
    ------
    InputError
        As `time_to_reach`.
    DomainError
        As `time_to_reach`, where the exact motion reaches x within the first swings or not within 3 times as
        long, and where its run is longer than 10⁴ swings.
    """
    law, turn = time_to_reach(scene, x), 2 * np.pi / natural_rate(scene)
    if law == np.inf:
        return law
    if (swings := _LONGEST * law / turn) > _MOST:
        raise DomainError(
            f"time_to_reach_error: the exact run takes up to {swings:.2g} swings, more than {_MOST}: the averaged motion gives "
            f"{law:.4g} s; take a larger shock or a smaller x"
        )
    return abs(time_to_wander(scene, x, _LONGEST * law) - law) + turn / _SAMPLES


def guiding_centre_error(scene: Scene, t: ArrayLike) -> Array:
    """Return how far (rad), in beta, h or alpha, `guiding_centre(scene).path(t)` is from the centre of the exact state, (n,).

    The centre of the exact state, of leading order itself, swings a little.

    Raises
    ------
    InputError
        As `guiding_centre` and its path.
    DomainError
        Likewise, where the exact motion has no centre, and where it is longer than 10⁴ swings.
    """
    centre, turn = guiding_centre(scene), 2 * np.pi / abs(natural_rate(scene))
    times = check_times("guiding_centre_error", t)
    if (swings := times[-1] / turn) > _MOST:
        raise DomainError(
            f"guiding_centre_error: the exact run is {swings:.2g} swings long, more than {_MOST}: take earlier times, or compare "
            "with lagrotor.simulate"
        )
    path = centre.path(times)
    run = simulate(scene, np.union1d(0.0, times), "minimal", 1e-9)
    difference = path - [guiding_centre(start).place for start in scenes_of(scene, run)][-len(times) :]
    difference[:, 2] = (difference[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return np.asarray(np.abs(difference).max(1))
