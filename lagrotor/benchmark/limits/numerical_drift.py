"""Errors that grow with time: the violation of index-reduced constraints, and the drift of energy and phase over thousands of
turns."""

from dataclasses import dataclass
from math import pi

import numpy as np

from lagrotor.benchmark.limits.threshold import Limit
from lagrotor.benchmark.runner import check_work
from lagrotor.benchmark.scipy_solvers import run_by
from lagrotor.models import spheres
from lagrotor.models.minimal import MODEL
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.models.simulate import simulate
from lagrotor.numerics.arrays import Array
from lagrotor.numerics.curves import measured_order
from lagrotor.pair.scene import Link, Scene
from lagrotor.pair.trajectory import Trajectory

# A displaced start in large motion; a pair whose paired precession is elliptic, so that errors grow slowly.
DRIFTING = Scene((10.0, -10.0), rates=((1.5, 1.0, 0.0), (1.5, -0.5, 0.0)))
STEADY = Scene((10.0, -10.0), link=Link(1.0, 0.3, 0.02))


def constraint_drift(scene: Scene, step: float, count: int, every: int, projected: bool = False) -> Array:
    """Return the violation of the constraints of `spheres` after each `every` steps of `count` in all, shape (count // every,).

    The steps of `step` seconds are classical Runge–Kutta steps; if `projected` is true, each state is projected onto the
    constraints. The violation is the largest of | |r_i| − 1 | and the bar's |length − ell|, in units of R.
    """
    rate, y = spheres.MODEL.rate(scene, False), spheres.MODEL.start(scene)
    assert scene.link is not None and spheres.MODEL.projection is not None
    project, residuals = spheres.MODEL.projection(scene), []
    k = scene.k
    for number in range(1, count + 1):
        k1 = np.array(rate(0.0, y))
        k2 = np.array(rate(0.0, y + step / 2 * k1))
        k3 = np.array(rate(0.0, y + step / 2 * k2))
        k4 = np.array(rate(0.0, y + step * k3))
        y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if projected:
            y = np.array(project(y))
        if number % every == 0:
            r1, r2 = y[:3], y[3:6]
            bar = np.linalg.norm(np.array([k, 0, 0]) + r2 - r1) - k
            residuals.append(max(abs(np.linalg.norm(r1) - 1), abs(np.linalg.norm(r2) - 1), abs(bar)))
    check_work("the drift of the constraints", 4 * count, np.array([[y, spheres.MODEL.start(scene)]]))
    return np.array(residuals)


def drift_limits(quick: bool) -> list[Limit]:
    """Return how the constraint residual of `spheres` grows: its exponents in time and step size, and the limits that follow.

    It grows because the model sets only the second derivatives of the constraints to zero.
    """
    step, end, allowed = 0.005, 16.0, 1e-6
    steps = np.array([4, 2, 1]) * step
    ends = np.array([constraint_drift(DRIFTING, h, round(end / h), round(end / h))[0] for h in steps])
    drift = constraint_drift(DRIFTING, step, round(end / step), round(end / step) // 16)
    times = end * np.arange(1, 17) / 16
    leading = ends[0] / (end**2 * steps[0] ** 4)
    law = "g'' = 0, so an error h^5 a step in g' gives g ~ t² h⁴"
    regime = "drift of index-reduced equations"
    tool = "spheres is projected; minimal has no constraint"
    residual = constraint_drift(DRIFTING, step, 200, 1, projected=True).max()
    crossing = np.interp(np.log(allowed), np.log(drift), np.log(times))
    return [
        Limit(regime, "power of time, fourth-order steps", law, 2.0, measured_order(times, drift), tool),
        Limit(regime, "power of the step", law, 4.0, measured_order(steps, ends), tool),
        Limit(
            regime,
            f"time (s) to {allowed:g} R with steps of {1e3 * step:g} ms",
            f"g ~ t² h⁴, its factor from steps of {1e3 * steps[0]:g} ms over {end:g} s",
            float(np.sqrt(allowed / (leading * step**4))),
            float(np.exp(crossing)),
            tool,
        ),
        Limit(
            regime,
            "largest violation after a projection (R)",
            "rounding: eps",
            float(np.finfo(float).eps),
            float(residual),
            "projects by one Newton step",
        ),
    ]


@dataclass(frozen=True)
class LongRun:
    """The drift after each number of turns in `turns`: of the energy (relative), of the momentum P (relative to G), and of the
    phase (rad, with its sign, while it is small)."""

    turns: Array
    energy: Array
    momentum: Array
    phase: Array
    evaluations: int


def long_run(turns: int, solver: str, tol: float) -> LongRun:
    """Compute the paired precession of STEADY at r0 = 0.2 by "simulate" or one of SOLVERS, at a hundred whole numbers of turns.

    The orbit is periodic and elliptic. Every turn ends at its start, so that each difference is an error of the method.
    """
    orbit = exact_orbit(STEADY, 0.2)
    times = 2 * pi / abs(orbit.frequency) * np.linspace(0, turns, 101)
    if solver == "simulate":
        run = simulate(orbit.scene, times, "minimal", tol)
    else:
        states, nfev = run_by(solver, MODEL.rate(orbit.scene, False), MODEL.start(orbit.scene), times, tol)
        motion = MODEL.observe(orbit.scene, states)
        run = Trajectory(
            scene=orbit.scene, model="minimal", why=solver, t=times, axes=motion.axes, rates=motion.rates, momenta=motion.momenta,
            errors=np.full(len(times), np.nan), evaluations=nfev,
        )  # fmt: skip
    spinning = (run.momenta[:, 0] ** 2).sum() / (2 * run.scene.rotor.I3)
    check_work(f"{turns} turns by {solver}", run.evaluations, run.rates, least=10 * turns)
    momentum = run.joint_line_momentum
    shift, ahead = run.axes - run.axes[:, :1], run.rates[:, :1]
    phase = abs(orbit.frequency) * (shift * ahead).sum((0, 2)) / (ahead**2).sum()
    energy = np.abs(run.energy / run.energy[0] - 1) * run.energy[0] / (run.energy[0] - spinning)
    drift = np.abs(momentum - momentum[0]) / abs(run.momenta[0, 0])
    return LongRun(np.linspace(0, turns, 101), energy, drift, phase, run.evaluations)


_PHASE_LAW = "v t + c t², fitted to the first tenth: steps are off in phase, and energy lost changes the frequency"


def _phase_from_a_tenth(run: LongRun) -> float:
    """Return |v t + c t²| in rad at the end of the run, with v and c fitted to the first tenth."""
    share = run.turns / run.turns[-1]
    fitted = np.linalg.lstsq(np.stack([share, share**2], axis=1)[:11], run.phase[:11], rcond=None)[0]
    return float(abs(fitted.sum()))


def long_limits(quick: bool) -> list[Limit]:
    """Return the drift after 10,000 turns (200 if quick), compared with the extrapolation of the drift in the first tenth."""
    turns = 200 if quick else 10_000
    runs = [("simulate", 1e-9), ("DOP853", 1e-8)]
    runs += [] if quick else [("Adams (VODE)", 1e-8), ("Dormand–Prince 5", 1e-7)]
    rows = []
    for solver, tol in runs:
        run = long_run(turns, solver, tol)
        steady = "ten times the drift in the first tenth, since it grows as t"
        for name, values, predicted, law in (
            ("energy, relative", run.energy, 10 * run.energy[:11].max(), steady),
            ("momentum P / G", run.momentum, 10 * run.momentum[:11].max(), steady),
            ("phase (rad)", np.abs(run.phase), _phase_from_a_tenth(run), _PHASE_LAW),
        ):
            rows.append(
                Limit(
                    f"{turns:,} turns by {solver} at {tol:g}",
                    f"drift of {name}",
                    law,
                    float(predicted),
                    float(values.max()),
                    f"auto takes the closed form where one holds; else compare the run's own integrals ({run.evaluations:,} "
                    "evaluations)",
                )
            )
    return rows
