"""Digits that coordinates and formulas lose: Euler angles at the pole, bar and axes in line, the printed projection."""

from functools import cache
from math import cos, sin, sqrt

import numpy as np

from lagrotor.benchmark.limits.threshold import Limit, threshold
from lagrotor.benchmark.runner import check_work
from lagrotor.benchmark.scipy_solvers import run_by
from lagrotor.errors import IntegrationError
from lagrotor.models import euler, minimal, spheres
from lagrotor.models.minimal import scenes_from_states
from lagrotor.models.model import Model, integrate_model
from lagrotor.models.simulate import simulate
from lagrotor.models.spheres import CLEARANCE
from lagrotor.models.spring_link.rigid_body import printed_rotation
from lagrotor.numerics.arrays import Array
from lagrotor.pair.scene import Link, Scene

_EPS = float(np.finfo(float).eps)
_TINIEST = float(np.finfo(float).smallest_subnormal)
# Initial inclination (rad) of both axes, and the time (s) in which they pass the pole.
_LEAN, _PASS = 0.5, 1.0


def passing(miss: float) -> Scene:
    """Return a pair without spins whose parallel axes move on a great circle past the pole, at a distance of `miss` rad after 0.5
    s.

    No force acts, since the bar only translates. Both axes turn uniformly by 1 rad/s, so that the motion is known exactly.
    """
    start, slope = (r[0] for r in _great_circle(miss, np.array([0.0])))
    axis, rate = tuple(map(float, start)), tuple(map(float, slope))
    return Scene((0.0, 0.0), axes=(axis, axis), rates=(rate, rate))  # type: ignore[arg-type]


def _great_circle(miss: float, t: Array) -> tuple[Array, Array]:
    """Return the axis r and its rate r' in 1/s at the times t (n,), shape (n, 3) each. The axis moves on a great circle towards
    +x and is at (0, sin miss, cos miss) at t = 0.5 s."""
    nearest, ahead = np.array([0.0, sin(miss), cos(miss)]), np.array([1.0, 0.0, 0.0])
    phase = (t - _LEAN)[:, None]
    return np.cos(phase) * nearest + np.sin(phase) * ahead, np.cos(phase) * ahead - np.sin(phase) * nearest


@cache
def past_the_pole(miss: float, tol: float, model: Model = euler.MODEL) -> tuple[float, int]:
    """Return the error in rad of axes that have passed the pole at a distance of `miss` rad, and the number of evaluations. The
    solver is DOP853 with the local error `tol`."""
    scene = passing(miss)
    states, nfev = run_by("DOP853", model.rate(scene, False), model.start(scene), np.array([0.0, _PASS]), tol)
    axes = model.observe(scene, states).axes
    error = float(np.abs(axes[:, -1] - _great_circle(miss, np.array([_PASS]))[0]).max())
    check_work(f"a pass at {miss:g} rad by {model.name}", nfev, axes, error, _PASS)
    return error, nfev


def euler_limits(quick: bool) -> list[Limit]:
    """Return the limits of the Euler angles on paths near theta = 0, one of cost and one of accuracy."""
    tol, target = 1e-12, 1e-10
    far, near, nearest = 1e-2, 1e-3, 1e-5
    nfev = {miss: past_the_pole(miss, tol)[1] for miss in (far, near, nearest)}
    cost = nfev[near] + (nfev[near] - nfev[far]) * np.log(near / nearest) / np.log(far / near)

    def lost(miss: float) -> bool:
        return any(past_the_pole(miss * share, tol)[0] > target for share in (1.0, 1.1, 1.2))

    miss_limit = threshold(lost, _EPS / target / 30, 30 * _EPS / target, 0.3 if quick else 0.03)
    tool = "euler refuses a start within 1e-3 rad; auto never takes it"
    regular = past_the_pole(nearest, tol, minimal.MODEL)[1]
    return [
        Limit(
            "Euler angles near theta = 0: cost",
            f"evaluations over 1 rad that misses the pole by {nearest:g} rad (minimal: {regular})",
            "N + c log(1/miss), N and c from 1e-2 and 1e-3",
            float(cost),
            float(nfev[nearest]),
            tool,
        ),
        Limit(
            "Euler angles near theta = 0: digits",
            f"least miss (rad) with an error under {target:g}, the local error being {tol:g}",
            "error = eps/(4 miss): psi' and phi', each 1/miss there and rounded, make up the spin",
            _EPS / (4 * target),
            miss_limit,
            tool,
        ),
    ]


def joint_line_limits(quick: bool) -> list[Limit]:
    """Return the limits of a bar that folds over, and of a bar in line with the axes."""
    tol = 1e-10
    return [
        Limit(
            "a bar shorter than the axes, folding over (chi past pi/2)",
            "largest difference between minimal and spheres during the fold (R)",
            "chi is regular there, so the difference is at most the tolerance",
            tol,
            fold_difference(tol),
            "nothing needs to be done",
        ),
        Limit(
            "the constraints where bar and axes are in line",
            "least distance (rad) at which spheres continues past that position",
            f"{CLEARANCE:g}/sqrt(2), since both axes count: within it the three gradients are nearly dependent",
            CLEARANCE / sqrt(2),
            threshold(lambda miss: not passes(miss), CLEARANCE / 10, 10 * CLEARANCE, 0.1 if quick else 0.01),
            "spheres stops and names the position; closed_form refuses the scene",
        ),
    ]


def passes(miss: float) -> bool:
    """Return True if the spheres model integrates a pair without spins past r_1 = r_2 = e_x at a distance of `miss` rad."""
    swing = Scene((0.0, 0.0), rates=((cos(miss), sin(miss), 0.0),) * 2)  # 1 rad/s: a quarter turn to e_x
    times, turn = np.array([0.0, 2.0]), np.array([cos(miss) * sin(2), sin(miss) * sin(2), cos(2)])
    try:
        run = integrate_model(spheres.MODEL, swing, times, 1e-8)
    except IntegrationError:
        return False
    axes = spheres.MODEL.observe(swing, run.states).axes
    check_work(f"a swing at {miss:g} rad", run.evaluations, axes, float(np.abs(axes[:, -1] - turn).max()), 1e-2)
    return True


def fold_difference(tol: float) -> float:
    """Return the largest difference, in units of R, of the axes between the minimal and the spheres model while a bar of 0.6 R
    folds over."""
    scene = scenes_from_states(Scene((3.0, -3.0), link=Link(0.6)), [[0.0, 0.3, 0.0, 0.2, 3.0, 0.1]])[0]
    first, second = (simulate(scene, np.linspace(0, 1, 51), model, tol) for model in ("minimal", "spheres"))
    difference = float(np.abs(first.axes - second.axes).max())
    check_work("a bar that folds over", min(first.evaluations, second.evaluations), first.axes, difference, 1e-2)
    return difference


def projection_limits(quick: bool) -> list[Limit]:
    """Return the |Omega| in rad/s below which the printed projection (3.16), Omegaᵀ Omega / |Omega|², underflows to 0/0."""
    return [
        Limit(
            "the printed projection at tiny angular velocity",
            "|Omega| (rad/s) below which it is 0/0",
            "sqrt(least double / 2): |Omega|² is rounded to zero",
            sqrt(0.5) * sqrt(_TINIEST),
            threshold(
                lambda size: not np.isnan(printed_rotation(np.array([[0.0, 0.0, size]]), 1e-3)).any(), 1e-170, 1e-150
            ),
            "finite_rotation divides by hypot: right for every Omega",
        )
    ]
