"""What a run costs: at most ten times the best rung's, of those that keep what they promise, at the same accuracy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrotor import Link, Scene, Trajectory, consistent_scene, simulate
from lagrotor.errors import LagrotorError
from lagrotor.models import simulate as simulating
from lagrotor.models.model import natural_units
from lagrotor.numerics import estimated_run
from tests.models.test_wide_scenes import RECORDED, SHORT, TRIALS
from tests.models.wide_scenes import run as run_of
from tests.models.wide_scenes import turns

BESIDE_A_FOLD = consistent_scene(
    (10, 10), [[0.3, 0.2, 0.9], [0.1, -0.3, 0.9]], [[0.1, 0, 0], [0, 0.1, 0]], None, Link(1, 0.01, 0.1)
)
A_CALL = 100  # evaluations that take about as long as all else in the shortest call
BESIDE_THE_DEAD_POINT = (664, 544, 512, 346, 610, 430)  # where rounding is all that tight tolerances resolve
REGULAR = [i for i in SHORT if RECORDED["growth"][i].max() < 1e4][::9]
UNSHAKEN = [i for i in SHORT if RECORDED["growth"][i].max() < 1e2 and TRIALS[i].scene.shock is None][::6]
TOLERANCES = 10.0 ** -np.arange(1, 14)


def farthest(run: Trajectory, exact: np.ndarray) -> float:
    return float(np.linalg.norm(run.axes - exact, axis=-1).max())


def cheapest(
    scene: Scene, times: np.ndarray, exact: np.ndarray, error: float, best: str, tolerances: np.ndarray = TOLERANCES
) -> float:
    """Fewest evaluations of a run by name whose axes are within `error`: of `minimal` only where `auto` can trust it."""
    least = np.inf
    for name in ("minimal", "spheres") if best == "minimal" else ("spheres",):
        for tol in tolerances:
            try:
                run = simulate(scene, [0.0, *times[times > 0]], name, tol)
                run = run.after(times[0])
            except LagrotorError:
                continue
            if farthest(run, exact) <= error:
                least = min(least, run.evaluations)
                break
    return least


def over_cheapest(i: int) -> float:
    """What `simulate` takes for a wide scene, over what the cheapest rung as accurate does; 0 where nothing is integrated."""
    trial, exact = TRIALS[i], RECORDED["axes"][i]
    try:
        run = run_of(trial)
    except LagrotorError:
        return 0.0
    reached = max(farthest(run, exact), trial.tol)
    alone = cheapest(trial.scene, trial.t, exact, reached, run.model) if run.evaluations else np.inf
    return (A_CALL + run.evaluations) / (A_CALL + alone)


@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
def test_no_run_takes_ten_times_as_long_as_the_best_rung(monkeypatch: pytest.MonkeyPatch) -> None:
    ratios = [over_cheapest(i) for i in (*REGULAR, *BESIDE_THE_DEAD_POINT)]
    assert max(ratios) < 10 and sum(ratio > 0 for ratio in ratios) > len(ratios) / 2
    # Twin: an estimate that is far too large is paid in evaluations.
    monkeypatch.setattr(estimated_run, "SAFETY", estimated_run.SAFETY._replace(value=1e4))
    assert np.mean([over_cheapest(i) for i in (*REGULAR, *BESIDE_THE_DEAD_POINT)]) > 1.3 * np.mean(ratios)


def over_plain_dop853(i: int) -> float:
    """Evaluations of `simulate`, over those of one call of scipy's DOP853 that is as exact; 0 where nothing is integrated."""
    trial, exact = TRIALS[i], RECORDED["axes"][i]
    try:
        run = run_of(trial)
    except LagrotorError:
        return 0.0
    if not run.evaluations:
        return 0.0
    model, units = simulating.MODELS[run.model], natural_units(trial.scene)
    rhs, start, times = model.rate(units.scene, False), model.start(units.scene), trial.t * units.rate
    for tol in TOLERANCES:
        found = solve_ivp(rhs, (0, times[-1]), start, "DOP853", times, rtol=max(tol, 2.3e-14), atol=tol)
        if not found.success:
            continue
        axes = model.observe(units.scene, found.y.T).axes
        if np.linalg.norm(axes - exact, axis=-1).max() <= max(farthest(run, exact), 1e-15):
            return (A_CALL + run.evaluations) / (A_CALL + found.nfev)
    return 0.0


@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
def test_no_run_takes_ten_times_a_plain_dop853_that_is_as_exact() -> None:
    ratios = [over_plain_dop853(i) for i in UNSHAKEN]
    assert max(ratios) < 10 and sum(ratio > 0 for ratio in ratios) > len(ratios) / 3


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
def test_no_run_of_up_to_ten_turns_takes_ten_times_as_long_as_the_best_rung() -> None:
    dear = {i: ratio for i, trial in enumerate(TRIALS) if turns(trial) < 10 and (ratio := over_cheapest(i)) > 10}
    assert not dear, dear


@pytest.mark.parametrize("tol", [1e-3, pytest.param(1e-9, marks=pytest.mark.slow)])
def test_beside_a_fold_a_run_costs_little_more_than_by_unit_vectors(tol: float) -> None:
    times = np.linspace(0, 200, 401)
    run = simulate(BESIDE_A_FOLD, times, tol=tol)
    assert run.model == "spheres" and "the coordinates become singular" in run.why
    exact = simulate(BESIDE_A_FOLD, times, "spheres", 1e-12).axes
    assert farthest(run, exact) < tol
    alone = cheapest(BESIDE_A_FOLD, times, exact, tol, run.model, tol / np.array([3.0, 30.0, 300.0]))
    assert run.evaluations < 10 * alone
