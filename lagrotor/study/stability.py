"""Where methods fail: thresholds found by trying, to be held against the predicted ones."""

from copy import deepcopy

import numpy as np

from ..models.spring_link import RigidBodySystem, step_limit


def step_grows(system: RigidBodySystem, dt: float, steps: int = 1000) -> bool:
    """Whether a disturbance of 1e-9 m in the bodies' places has opened a joint beyond 1e-5 m after so many steps of dt."""
    moving = deepcopy(system)
    moving.X[:-1] += 1e-9 * np.random.default_rng(1).normal(size=moving.X[:-1].shape)
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(steps):
            moving.compute_forces()
            moving.step(dt)
            if not np.abs(moving.gaps(moving.X, moving.R)).max() < 1e-5:
                return True
    return False


def found_step_limit(system: RigidBodySystem, halvings: int = 7) -> float:
    """The longest stable step (s) by bisection between 0.8 and 1.2 of the predicted one; to 0.4 / 2**halvings of it."""
    predicted = step_limit(system).whole
    low, high = 0.8 * predicted, 1.2 * predicted
    for _ in range(halvings):
        middle = (low + high) / 2
        low, high = (low, middle) if step_grows(system, middle) else (middle, high)
    return (low + high) / 2
