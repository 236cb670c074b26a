"""The limits of all methods: a formula predicts each one, and a measurement confirms it. Here: the longest stable step."""

import warnings
from collections.abc import Callable
from copy import deepcopy

import numpy as np

from lagrotor.benchmark.limits.coordinate_singularities import euler_limits, joint_line_limits, projection_limits
from lagrotor.benchmark.limits.numerical_drift import drift_limits, long_limits
from lagrotor.benchmark.limits.range_of_validity import amplitude_limits, horizon_limits, spin_limits
from lagrotor.benchmark.limits.threshold import Limit
from lagrotor.benchmark.runner import check_work
from lagrotor.errors import LagrotorWarning
from lagrotor.models.spring_link.rigid_body import RigidBody
from lagrotor.models.spring_link.run import run_steps
from lagrotor.models.spring_link.system import RigidBodySystem, paper_system, step_limit
from lagrotor.pair.examples import DAMPING, HEAVY_LINK, LIGHT, STIFFNESS
from lagrotor.pair.scene import Link, Scene


def step_grows(system: RigidBodySystem, dt: float) -> bool:
    """Return True if steps of `dt` are unstable: a perturbation of 1e-9 m opens a joint by more than 1e-5 m within 1,000
    steps."""
    moving = deepcopy(system)
    moving.X[:-1] += 1e-9 * np.random.default_rng(1).normal(size=moving.X[:-1].shape)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        run = run_steps(moving, None, dt * np.arange(0, 1001, 20), dt)
    if not run.ending.early:
        check_work(f"steps of {dt:g} s", run.evaluations, run.tips)
    return run.ending.early or bool(run.stretches.max() > 1e-5)


def step_limit_by_bisection(system: RigidBodySystem, halvings: int = 7) -> float:
    """Return the longest stable step in s, by bisection within 20 % of the predicted one. Its accuracy is 0.4 / 2**halvings of
    the predicted step."""
    predicted = step_limit(system).whole
    low, high = 0.8 * predicted, 1.2 * predicted
    for _ in range(halvings):
        middle = (low + high) / 2
        low, high = (low, middle) if step_grows(system, middle) else (middle, high)
    return (low + high) / 2


def _bar_on_rotor(bar: Link) -> RigidBodySystem:
    """Return a rotor and the bar, connected by one tip joint and without other joints."""
    zero, identity, x, z = np.zeros(3), np.eye(3), np.array([0.5, 0.0, 0.0]), np.array([0.0, 0.0, 0.5])
    rotor = RigidBody(z, np.array([-z, z]), identity, identity, 1.0, zero, zero)
    link = RigidBody(2 * z + x, np.array([-x, x]), bar.inertia * identity, identity, bar.mass, zero, zero)
    system = RigidBodySystem([rotor, link], STIFFNESS, DAMPING)
    system.link(1, 2, 2, 1)
    return system


def step_limits(quick: bool) -> list[Limit]:
    """Return the longest stable steps of the paper's method, for each kind of joint alone and for all joints together."""
    systems = {
        "a ground joint alone": paper_system(Scene((0.0, 0.0), link=None), STIFFNESS, DAMPING),
        "a tip joint alone, bar of 1 kg": _bar_on_rotor(HEAVY_LINK),
        "a tip joint alone, bar of 0.01 kg": _bar_on_rotor(LIGHT),
        "all joints, bar of 1 kg": paper_system(Scene((10.0, -10.0), link=HEAVY_LINK), STIFFNESS, DAMPING),
        "all joints, bar of 0.01 kg": paper_system(Scene((10.0, -10.0), link=LIGHT), STIFFNESS, DAMPING),
    }
    law = "4/(w D + sqrt((w D)² + 4 w S)), w the largest mobility"
    tool = "run_steps stops where the state blows up, and names the limit"
    rows = []
    for name, system in systems.items():
        what, predicted = f"longest stable step (s): {name}", step_limit(system).whole
        measured = step_limit_by_bisection(system, 4 if quick else 7)
        rows.append(Limit("explicit steps on stiff links", what, law, predicted, measured, tool))
    return rows


LIMITS: dict[str, Callable[[bool], list[Limit]]] = {
    "stiff links": step_limits,
    "Euler angles": euler_limits,
    "joint line": joint_line_limits,
    "projection": projection_limits,
    "drift": drift_limits,
    "amplitude": amplitude_limits,
    "spins": spin_limits,
    "long runs": long_limits,
    "horizon": horizon_limits,
}


def limits(quick: bool = False, step: Callable[[str], None] = lambda name: None) -> list[Limit]:
    """Return every limit. If `quick` is true, runs are shorter and thresholds coarser. The function `step` is called with the
    name of each regime."""
    rows = []
    for name, measure in LIMITS.items():
        step(name)
        rows += measure(quick)
    return rows
