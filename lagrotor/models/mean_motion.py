"""The slow motion measured on exact runs: mean rates after a shock, the force that cancels a drift, times to a bound.

The functions `*_error` compare the laws of `theory` with these measurements. A mean has the weight exp(−1/(u (1 − u))),
u from 0 to 1 over the window, which reduces an oscillation of n turns to about exp(−sqrt(4 pi n)) of its size. A mean rate also
depends on the window, because the rate itself changes.
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

_SAMPLES = 32  # per swing
_LEAST = 4  # the fewest swings whose mean separates drift and swing
_MOST = 10_000  # the most swings of an exact run
_LONGEST = 3  # the length of an exact run in times of the averaged motion


def mean_over(t: Array, values: Array) -> float:
    """Return the mean of values at evenly spaced times, with oscillations averaged out.

    Parameters
    ----------
    t, values : Array
        The times, s, and the values, (n,) with n ≥ 8.

    Returns
    -------
    float
        The weighted mean.
    """
    if len(t) < 8:
        raise DomainError(f"mean_over: {len(t)} values are too few for a mean: give 8 or more")
    u = (t[1:-1] - t[0]) / (t[-1] - t[0])
    weight = np.exp(-1 / (u * (1 - u)))
    return float((weight * values[1:-1]).sum() / weight.sum())


def turning_rate(run: Trajectory) -> float:
    """Return the mean rotation rate of both axes about the joint line.

    Parameters
    ----------
    run : Trajectory
        A run with evenly spaced times.

    Returns
    -------
    float
        The mean of alpha', rad/s.
    """
    r, v = run.axes, run.rates
    rate = (r[..., 1] * v[..., 2] - r[..., 2] * v[..., 1]) / (r[..., 1] ** 2 + r[..., 2] ** 2)
    return mean_over(run.t, rate.mean(0))


def wandering_rate(run: Trajectory) -> float:
    """Return the mean drift rate of both axes along the joint line.

    Parameters
    ----------
    run : Trajectory
        A run with evenly spaced times.

    Returns
    -------
    float
        The mean of x', 1/s.
    """
    return mean_over(run.t, run.rates[..., 0].mean(0))


def run_after(scene: Scene, turns: float = 24, tol: float = 1e-11) -> Trajectory:
    """Integrate an exact run from the end of a scene's shock, with evenly spaced times.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock and a spin.
    turns : float, default 24
        The number of swings.
    tol : float, default 1e-11
        The largest error of an axis, as in `simulate`.

    Returns
    -------
    Trajectory
        The run after the shock.
    """
    response = shock_response(scene)
    if scene.shock is None or response.frequency == 0:
        raise InputError("run_after: the scene has no shock or no spin: give both")
    begin = scene.shock.end
    t = np.linspace(begin, begin + turns * 2 * np.pi / response.frequency, round(turns * _SAMPLES) + 1)
    return simulate(scene, [0.0, *t], "minimal", tol).after(begin)


def exact_cancelling_force(scene: Scene, turns: float = 24) -> float:
    """Return the force along y for which the exact mean rotation vanishes.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock that has a force along x.
    turns : float, default 24
        The mean is taken over this number of swings. The force depends on it.

    Returns
    -------
    float
        The force F_y, N, with a relative error of 1e-7.
    """
    from scipy.optimize import newton

    if scene.shock is None:
        raise InputError("exact_cancelling_force: the scene has no shock: give one with a force along x")
    shock, guess = scene.shock, cancelling_force(scene)

    def turning(force: float) -> float:
        trial = replace(shock, force=(shock.force[0], force, 0.0))
        return turning_rate(run_after(replace(scene, shock=trial), turns, 1e-10))

    try:
        return float(newton(turning, guess, x1=1.03 * guess, tol=1e-7 * abs(guess), maxiter=20))
    except RuntimeError:
        raise DomainError(
            f"exact_cancelling_force: no force near {guess:.4g} N, the value for a weak shock, stops the turning; "
            "take a weaker shock or fewer turns"
        ) from None


def time_to_wander(scene: Scene, bound: float, longest: float) -> float:
    """Return the time from the peak of the shock until the mean x of both axes reaches `bound` or −`bound`.

    The mean is taken over six swings.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock.
    bound : float
        The bound of x, in units of R.
    longest : float
        The end of the search, s. A DomainError is raised if the bound is not reached by then.

    Returns
    -------
    float
        The time, s.
    """
    run = run_after(scene, 6 + int(np.ceil(longest * shock_response(scene).frequency / (2 * np.pi))), 1e-7)
    t, values, shock = run.t, run.axes[..., 0].mean(0), scene.shock
    assert shock is not None
    u = (np.arange(6 * _SAMPLES) + 0.5) / (6 * _SAMPLES)
    weight = np.exp(-1 / (u * (1 - u)))
    mean = np.abs(np.convolve(values, weight / weight.sum(), "valid"))
    if mean.max() < bound:
        raise DomainError(f"time_to_wander: the bound {bound:g} is not reached within {longest:g} s: lower it")
    if (i := int(np.argmax(mean >= bound))) == 0:
        raise DomainError(f"time_to_wander: the bound {bound:g} is reached within the first swings: take a larger one")
    index = i - 1 + (bound - mean[i - 1]) / (mean[i] - mean[i - 1]) + (len(u) - 1) / 2
    return float(t[0] + index * (t[1] - t[0]) - shock.at)


def toppling_error(scene: Scene, duration: float) -> float:
    """Return the difference between the rate of `toppling_after_shock` and the mean rate of an exact run.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock.
    duration : float
        Time from the peak of the pulse to the end of the averaging interval, s: 4 to 10⁴ swings. The interval begins at
        the end of the pulse.

    Returns
    -------
    float
        The error, rad/s.
    """
    law = toppling_after_shock(scene)
    return abs(turning_rate(run_after(scene, _turns(scene, duration, "toppling_error"))) - law)


def wander_error(scene: Scene, duration: float) -> float:
    """Return the difference between the rate of `wander_after_shock` and the mean rate of x in an exact run.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock.
    duration : float
        Time from the peak of the pulse to the end of the averaging interval, s.

    Returns
    -------
    float
        The error, 1/s.
    """
    law = wander_after_shock(scene)
    return abs(wandering_rate(run_after(scene, _turns(scene, duration, "wander_error"), 1e-10)) - law)


def cancelling_force_error(scene: Scene, duration: float) -> float:
    """Return the difference between `cancelling_force` and the force at which the exact mean rotation vanishes.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock.
    duration : float
        Time from the peak of the pulse to the end of the averaging interval, s.

    Returns
    -------
    float
        The error, N.
    """
    law, turns = cancelling_force(scene), _turns(scene, duration, "cancelling_force_error")
    return abs(exact_cancelling_force(scene, turns) - law) if law else 0.0  # without force along x there is no drift


def _turns(scene: Scene, duration: float, where: str) -> float:
    """Return the number of swings from the end of the pulse to `duration` s after its peak."""
    assert scene.shock is not None
    delay, turn = scene.shock.end - scene.shock.at, 2 * np.pi / natural_rate(scene)
    turns = (finite_number(duration, f"{where}: duration", "s") - delay) / turn
    if not _LEAST * (1 - 1e-9) <= turns <= _MOST:
        raise DomainError(
            f"{where}: duration = {duration:g} s leaves {turns:.3g} swings after the pulse, too few or too many for a mean: take "
            f"{_LEAST * turn + delay:.3g} to {_MOST * turn + delay:.3g} s after its peak"
        )
    return turns


def time_to_reach_error(scene: Scene, x: float) -> float:
    """Return the difference between `time_to_reach` and the time at which the mean of an exact run reaches a bound.

    The mean is taken over six swings.

    Parameters
    ----------
    scene : Scene
        The pair, with a shock.
    x : float
        The bound, in units of R.

    Returns
    -------
    float
        The difference plus the sampling step of 1/32 swing, s; inf if the averaged motion does not reach x.
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
    """Return the distance of `guiding_centre(scene).path(t)` from the guiding centre of an exact run.

    Parameters
    ----------
    scene : Scene
        The pair.
    t : array_like
        The times (n,), s.

    Returns
    -------
    Array
        The largest of the differences in beta, h and alpha at each time, (n,), rad. The centre of the exact run is
        computed to leading order, so that it oscillates slightly.
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
