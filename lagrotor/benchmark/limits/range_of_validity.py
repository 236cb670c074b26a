"""The range in which the closed forms, and predictions as such, are valid: amplitude, nearly opposite spins, small spins,
time."""

from dataclasses import replace
from functools import lru_cache
from math import exp, log, pi

import numpy as np

from lagrotor.benchmark.limits.threshold import Limit, threshold
from lagrotor.benchmark.runner import check_work
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import integrate_model
from lagrotor.models.orbits.floquet import floquet_of
from lagrotor.models.orbits.shooting import ExactOrbit, exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import Array
from lagrotor.pair.scene import Scene
from lagrotor.theory.natural_rate import natural_rate
from lagrotor.theory.paired_precession.series import PairedSeries, paired_series, shape_of
from lagrotor.theory.parallel_twist import parallel_scene

PAIR = Scene((10.0, -10.0))
_PHASES = np.linspace(0, 2 * pi, 25)


def _axes(scene: Scene, times: Array, local: float, start: Array | None = None) -> Array:
    run = integrate_model(MODEL, scene, times, local, start=start)
    axes = MODEL.observe(scene, run.states).axes
    check_work("a run of the pair", run.evaluations, axes)
    return axes


def _series(scene: Scene, order: int) -> PairedSeries:
    return paired_series(order, *shape_of(scene))


def series_error(scene: Scene, order: int, r0: float) -> float:
    """Return the largest distance over a turn, in units of R, between the axes of the series and of the exact orbit at equal
    phases."""
    orbit = _orbit(scene, r0)
    times = _PHASES / abs(orbit.frequency)
    exact = _axes(orbit.scene, times, 1e-11)
    return float(np.linalg.norm(_series(scene, order).axes(r0, _PHASES) - exact, axis=-1).max())


@lru_cache(maxsize=256)
def _orbit(scene: Scene, r0: float) -> ExactOrbit:
    return exact_orbit(scene, r0)


def next_term(scene: Scene, order: int) -> float:
    """Return the largest coefficient of r0**(order + 1) over a turn in the series of the axes, in units of R."""
    phases, small = np.linspace(0, 2 * pi, 181), 0.5
    high, low = (_series(scene, n).axes(small, phases) for n in (order + 1, order))
    return float(np.linalg.norm(high - low, axis=-1).max()) / small ** (order + 1)


def amplitude_limits(quick: bool) -> list[Limit]:
    """Return, for some orders of the series, the amplitude at which its error reaches a given value."""
    from scipy.optimize import brentq

    rows = []
    for order, target in ((1, 1e-2), (3, 1e-3), (5, 1e-4)) if quick else ((1, 1e-2), (3, 1e-3), (5, 1e-4), (9, 1e-6)):
        predicted = (target / next_term(PAIR, order)) ** (1 / (order + 1))

        def beyond(x: float, order: int = order, target: float = target) -> float:
            return log(series_error(PAIR, order, exp(x)) / target)

        near, far = log(predicted / 1.5), log(min(1.5 * predicted, 0.8))
        rows.append(
            Limit(
                "amplitude of the closed form",
                f"r0 at which order {order} is off by {target:g} R at equal phase",
                f"(error / c)^(1/{order + 1}), with the next coefficient c",
                predicted,
                exp(brentq(beyond, near, far, xtol=0.02 if quick else 1e-4)),
                "states its order and error; refuses |r0| >= 1",
            )
        )
    return rows


def opposite_spin_error(share: float, r0: float = 0.1) -> float:
    """Return the largest distance of the axes from the periodic orbit within a turn, in units of R. Spin 2 is −(1 − share) times
    spin 1."""
    first, *_ = PAIR.spins
    apart = _within_a_turn((first, -first * (1 - share)), r0) - _within_a_turn(PAIR.spins, r0)
    return float(np.linalg.norm(apart, axis=-1).max())


@lru_cache(maxsize=8)
def _within_a_turn(spins: tuple[float, float], r0: float) -> Array:
    """Return the axes (2, 24, 3) over a turn, for these spins, from the start of the periodic orbit with the amplitude r0."""
    orbit = _orbit(PAIR, r0)
    times = _PHASES[1:] / abs(orbit.frequency)
    return _axes(replace(orbit.scene, spins=spins), times, 1e-12)


def equal_spin_error(share: float, r0: float) -> float:
    """Return the largest distance of the axes of a parallel pair within a turn, in units of R. Spin 2 is (1 − share) times spin
    1."""
    start = parallel_scene(Scene((10.0, 10.0)), r0)
    times = 2 * pi / natural_rate(start) * np.arange(1, 65) / 64
    axes = _axes(replace(start, spins=(10.0, 10.0 * (1 - share))), times, 1e-12)
    return float(np.linalg.norm(axes[1] - axes[0], axis=-1).max())


def spin_limits(quick: bool) -> list[Limit]:
    """Return the limits for spins that are nearly opposite, nearly equal, or small."""
    target, tiny, r0 = 1e-2, 1e-5, 0.1
    measured = threshold(lambda share: opposite_spin_error(share, r0) > target, 1e-4, 0.9, 0.05 if quick else 0.01)
    push, bar = 1.0, Scene((1.0, 1.0))
    heavy = sum(bar.inertias)

    def falls(spin: float) -> bool:
        scene = Scene((spin, spin), rates=((0.0, push, 0.0), (0.0, push, 0.0)))
        turn = 2 * pi / max(natural_rate(scene), push)
        run = simulate(scene, np.linspace(0, turn, 201), "minimal", 1e-7)
        check_work(f"a push at {spin:g} rad/s", run.evaluations, run.axes)
        return bool(run.axes[..., 2].min() < 0)

    return [
        Limit(
            "spins nearly opposite",
            f"(G_1 + G_2)/G_1 that puts the pair {target:g} R off the closed orbit of r0 = {r0:g} in a turn",
            f"error ~ (G_1 + G_2), with the slope measured at {tiny:g}",
            target * tiny / opposite_spin_error(tiny, r0),
            measured,
            "refuses spins that are not exactly opposite",
        ),
        Limit(
            "spins nearly equal",
            f"(G_1 − G_2)/G_1 that twists parallel axes {target:g} R apart in a turn, inclined by {r0:g}",
            f"error ~ (G_1 − G_2), with the slope measured at {tiny:g}",
            target * tiny / equal_spin_error(tiny, r0),
            threshold(lambda share: equal_spin_error(share, r0) > target, 1e-4, 0.9, 0.05 if quick else 0.01),
            "closed_form refuses spins that are not exactly equal or opposite",
        ),
        Limit(
            "spins going to zero",
            f"equal spins (rad/s) below which a push of {push:g} R/s lays the upright axes flat",
            "(a + b) push / I_3: the largest inclination is 2 atan((a + b) push / G)",
            heavy * push / bar.rotor.I3,
            threshold(falls, 0.5 * heavy, 2 * heavy, 0.01 if quick else 0.001),
            "not needed: a parallel pair with equal spins is one rotor in closed form at any inclination",
        ),
    ]


def horizon_limits(quick: bool) -> list[Limit]:
    """Return the limits of prediction: the number of turns after which two solutions, initially 1e-9 apart, differ by 0.01."""
    apart, lost, rows = 1e-9, 1e-2, []
    for r0 in (0.6,) if quick else (0.6, 0.5):
        orbit = _orbit(PAIR, r0)
        predicted = log(lost / apart) / floquet_of(orbit).growth
        turn = 2 * pi / abs(orbit.frequency)
        rows.append(
            Limit(
                "the horizon of prediction",
                f"turns until two starts {apart:g} apart at r0 = {r0:g} differ by {lost:g}",
                "log(lost/apart)/lambda, with lambda from the exact Floquet multipliers",
                predicted,
                _parting(orbit.scene, turn * np.arange(0, 1.1 * predicted, 0.02), apart, lost) / turn,
                "beyond it a run predicts only means",
            )
        )
    return rows


def _parting(scene: Scene, times: Array, apart: float, lost: float) -> float:
    """Return the time in s at which the axes of `scene` and of a perturbed start differ by `lost`; inf if they never do."""
    start = MODEL.start(scene)
    first, second = (_axes(scene, times, apart / 10, start=state) for state in (start, start + apart))
    away = np.linalg.norm(first - second, axis=-1).max(0) > lost
    return float(times[np.argmax(away)]) if away.any() else float("inf")
