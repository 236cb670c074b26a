"""What a run costs: at most ten times the best rung's, of those that keep what they promise, at the same accuracy."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, Trajectory, consistent_scene, simulate
from lagrotor.errors import LagrotorError
from lagrotor.models import model as model_module
from lagrotor.models import simulate as simulating
from lagrotor.models.model import natural_units, problem_of
from lagrotor.numerics import error_estimate, printers
from lagrotor.numerics.integrate import integrate
from lagrotor.numerics.solvers import dop853
from tests.models.test_wide_scenes import RECORDED, SHORT, TRIALS
from tests.models.wide_scenes import Wide
from tests.models.wide_scenes import run as run_of

BESIDE_A_FOLD = consistent_scene(
    (10, 10), [[0.3, 0.2, 0.9], [0.1, -0.3, 0.9]], [[0.1, 0, 0], [0, 0.1, 0]], None, Link(1, 0.01, 0.1)
)
A_CALL = 100  # evaluations that take about as long as all else in the shortest call
BESIDE_THE_DEAD_POINT = (664, 544, 512, 346, 610, 430)  # where rounding is all that tight tolerances resolve
REGULAR = [i for i in SHORT if RECORDED["growth"][i].max() < 1e4][::9]
QUIET = [i for i in SHORT if RECORDED["growth"][i].max() < 1e2]
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
    monkeypatch.setattr(error_estimate, "SAFETY", error_estimate.SAFETY._replace(value=1e4))
    assert np.mean([over_cheapest(i) for i in (*REGULAR, *BESIDE_THE_DEAD_POINT)]) > 1.3 * np.mean(ratios)


def over_plain_dop853(trial: Wide, exact: np.ndarray) -> float:
    """Evaluations of `simulate`, over those of plain DOP853 that is as exact, by the cheaper model: no projection, cut at the
    edges of a pulse, no step longer than its width within; 0 where nothing is integrated or DOP853 does not come as near, so
    that nothing is judged."""
    try:
        run = run_of(trial)
    except LagrotorError:
        return 0.0
    scene, least = replace(trial.scene, shock=trial.scene.shock_until(float(trial.t[-1]))), np.inf
    units = natural_units(scene)
    for model in simulating.LADDER if run.evaluations else ():
        for tol in TOLERANCES:
            try:
                plain = replace(problem_of(model, units.scene, budget=1e5), project=None, time_to_singular=None)
                found = integrate(plain, trial.t * units.rate, tol, lambda segment, _, error: dop853(segment, error))
            except LagrotorError:
                continue
            axes = model.observe(units.scene, found.states).axes
            if np.linalg.norm(axes - exact, axis=-1).max() <= max(farthest(run, exact), 1e-15):
                least = min(least, found.evaluations)
                break
    return (A_CALL + run.evaluations) / (A_CALL + least)


@pytest.mark.filterwarnings("ignore::lagrotor.errors.LagrotorWarning")
@pytest.mark.parametrize("shaken", [False, True])
def test_no_run_takes_ten_times_a_plain_dop853_that_is_as_exact(shaken: bool) -> None:
    which = [i for i in QUIET if (TRIALS[i].scene.shock is not None) == shaken][::6]
    ratios = [over_plain_dop853(TRIALS[i], RECORDED["axes"][i]) for i in which]
    assert max(ratios) < 10 and sum(ratio > 0 for ratio in ratios) > len(ratios) / 3


class Unprinted(np.ndarray):
    """An array that refuses to be printed."""

    def __repr__(self) -> str:
        raise AssertionError


@pytest.mark.parametrize("name", ["minimal", "spheres"])
@pytest.mark.parametrize(
    ("shock", "scenes"), [(None, 1), (Shock((4, -1, 0), 0.5, 0.05), 1), (Shock((4, -1, 0), 9, 0.05), 2)]
)
def test_a_run_by_name_repeats_no_work(
    monkeypatch: pytest.MonkeyPatch, name: str, shock: Shock | None, scenes: int
) -> None:
    """Few scenes are made and checked, each integration is observed once, and valid times are not printed."""
    made, observed, model = list[Scene](), list[int](), simulating.MODELS[name]
    scene, times = replace(BESIDE_A_FOLD, shock=shock), np.linspace(0, 2, 9).view(Unprinted)
    check = Scene.__post_init__
    monkeypatch.setattr(Scene, "__post_init__", lambda self: (made.append(self), check(self))[1])
    counting = replace(model, observe=lambda one, states: (observed.append(len(states)), model.observe(one, states))[1])
    monkeypatch.setitem(simulating.MODELS, name, counting)
    run = simulate(scene, times, name, 1e-6)
    # In natural units, and before that without a shock that comes after the end.
    assert len(made) == scenes
    # The start, two integrations, and the requested times of the better one.
    assert len(observed) == 4 and observed[0] == 2 and observed[-1] == len(run.t)


def test_the_range_of_a_fast_run_is_compiled_once(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("heyoka", reason="the fast extra is not installed")
    compiled, right = [], printers.compile_program
    monkeypatch.setattr(printers, "compile_program", lambda *a: (compiled.append(a), right(*a))[1])
    model_module._bounds.cache_clear()
    for tol in (1e-6, 1e-8):
        assert simulate(BESIDE_A_FOLD, np.linspace(0, 2, 9), tol=tol, engine="fast").model == "minimal"
    assert len(compiled) == 1


def test_beside_a_fold_a_run_costs_little_more_than_by_unit_vectors() -> None:
    tol, times = 1e-3, np.linspace(0, 200, 401)
    run = simulate(BESIDE_A_FOLD, times, tol=tol)
    assert run.model == "spheres" and "the coordinates become singular" in run.why
    exact = simulate(BESIDE_A_FOLD, times, "spheres", 1e-12).axes
    assert farthest(run, exact) < tol
    alone = cheapest(BESIDE_A_FOLD, times, exact, tol, run.model, tol / np.array([3.0, 30.0, 300.0]))
    assert run.evaluations < 10 * alone
