"""A benchmark whose run has no length raises, in each benchmark; with the length that it reports it does not."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from benchmarks import bodies_and_lagrangians, structure_comparison
from benchmarks.mechanisms import comparison, deciding
from benchmarks.ratios import rods, runs
from lagrotor import Scene
from lagrotor.benchmark import throughput
from lagrotor.benchmark.limits import coordinate_singularities, error_map, numerical_drift, range_of_validity, step_size
from lagrotor.benchmark.runner import Case, Method, benchmark, check_work, reference
from lagrotor.benchmark.scenes_and_methods import CASES, METHODS
from lagrotor.errors import LagrotorError
from lagrotor.models import paper_system
from lagrotor.pair import DAMPING, LIGHT, STIFFNESS

MOVING = np.linspace(0, 1, 6).reshape(1, 2, 3)
PAIR = range_of_validity.PAIR


@pytest.mark.parametrize(
    "work",
    [
        {"evaluations": 0},
        {"evaluations": 9, "least": 10},
        {"states": np.ones((1, 2, 3))},
        {"states": np.full((1, 2, 3), np.nan)},
        {"error": 2e-6, "bound": 1e-6},
        {"error": np.nan},
    ],
    ids=str,
)
def test_a_run_without_evaluations_motion_or_the_error_that_is_stated_is_refused(work: dict[str, Any]) -> None:
    right: dict[str, Any] = {"evaluations": 10, "states": MOVING, "error": 1e-6, "bound": 1e-6, "least": 10}
    check_work("a run", **right)
    with pytest.raises(LagrotorError, match="a run: the benchmark did not do its work"):
        check_work("a run", **right | work)


def _only_start(run: Callable[..., Any], place: int) -> Callable[..., Any]:
    """The run through the first of its times alone; `place` is the position of the times."""

    def short(*given: Any, **more: Any) -> Any:
        return run(*given[:place], given[place][:1], *given[place + 1 :], **more)

    return short


_SYSTEM = paper_system(Scene((10.0, -10.0), link=LIGHT), STIFFNESS, DAMPING)
# Of each benchmark: its module, the call that runs, the position of the times in it, and the benchmark.
RUNS: dict[str, tuple[Any, str, int, Callable[[], object]]] = {
    "throughput": (throughput, "sweep", 1, partial(throughput.throughput, 8)),
    "map of errors": (error_map, "sweep", 1, partial(error_map.usefulness, np.array([0.1]), np.array([0.1]), (1,))),
    "pole": (coordinate_singularities, "run_by", 3, partial(coordinate_singularities.past_the_pole, 0.0123, 1e-8)),
    "joint line": (coordinate_singularities, "integrate_model", 2, partial(coordinate_singularities.passes, 2e-5)),
    "fold": (coordinate_singularities, "simulate", 1, partial(coordinate_singularities.fold_difference, 1e-8)),
    "turns": (numerical_drift, "run_by", 3, partial(numerical_drift.long_run, 2, "DOP853", 1e-8)),
    "series": (range_of_validity, "integrate_model", 2, partial(range_of_validity.series_error, PAIR, 1, 0.1)),
    "steps": (step_size, "run_steps", 2, partial(step_size.step_grows, _SYSTEM, 1e-4)),
}


@pytest.mark.parametrize("name", RUNS)
def test_a_limit_of_a_run_without_length_is_not_reported(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module, run, place, work = RUNS[name]
    monkeypatch.setattr(throughput, "DURATION", 0.1)
    work()
    monkeypatch.setattr(module, run, _only_start(getattr(module, run), place))
    if name == "pole":
        coordinate_singularities.past_the_pole.cache_clear()
    with pytest.raises(LagrotorError, match="did not do its work"):
        work()


def test_a_drift_of_no_steps_and_a_chart_of_no_time_are_refused() -> None:
    with pytest.raises(LagrotorError, match="did not do its work"):
        numerical_drift.constraint_drift(numerical_drift.DRIFTING, 0.01, 0, 1)
    scene = CASES["displaced"](True).scene
    with pytest.raises(LagrotorError, match="the reference: the benchmark did not do its work"):
        benchmark("none", Case(scene, np.array([0.0]), 1, "no time"), {"minimal": METHODS["minimal"]}, (1e-6,))
    case = Case(scene, np.linspace(0, 1, 3), 0, "a second")
    tips = reference(case.scene, case.t_eval).tips
    with pytest.raises(LagrotorError, match="idle at 1e-06: the benchmark did not do its work"):
        benchmark("idle", case, {"idle": Method("peer", lambda *_: lambda tol: (tips, 0))}, (1e-6,))
    assert benchmark("closed", case, {"a": Method("closed", lambda *_: lambda tol: (tips, 0))}, (1e-6,)).points
    # A method that evaluates and stays at the start has the whole motion as its error.
    still = benchmark("still", case, {"a": Method("trap", lambda *_: lambda tol: (0 * tips + tips[:, :1], 4))}, (1e-6,))
    assert still.points[0].error == pytest.approx(np.linalg.norm(tips - tips[:, :1], axis=-1).max())


def test_comparisons_with_other_tools_refuse_what_did_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(comparison, "start", lambda kind, n: np.zeros(2 * n))  # rods at rest, hanging
    with pytest.raises(LagrotorError, match="the reference of 2 rods: the benchmark did not do its work"):
        comparison.measure(comparison.OWN["lagrotor"], comparison.Measured("rods", 2, "lagrotor"))
    monkeypatch.setattr(structure_comparison, "TIMES", np.array([0.0]))
    with pytest.raises(LagrotorError, match="the reference of 2 rotors: the benchmark did not do its work"):
        structure_comparison.compared(2, print, set())
    monkeypatch.setattr(rods, "accelerations", lambda q, v: q)
    with pytest.raises(LagrotorError, match="2 rods: the benchmark did not do its work"):
        rods.ready(2)
    monkeypatch.setitem(runs.SCENES, "short bar, shock", lambda x: Scene((10.0, -10.0)))  # at rest
    with pytest.raises(LagrotorError, match="auto, short bar, shock: the benchmark did not do its work"):
        next(runs.auto_and_chosen("short bar, shock", "core"))
    monkeypatch.setattr(bodies_and_lagrangians, "_rates", lambda *given: np.ones(2))
    with pytest.raises(LagrotorError, match="lagrotor, bodies on 1 gyroscope: the benchmark did not do its work"):
        bodies_and_lagrangians._measured(print, lambda: None, "1 gyroscope", "lagrotor, bodies")
    monkeypatch.setattr(deciding, "PAIRS", dict(list(deciding.PAIRS.items())[:1]))
    monkeypatch.setattr(deciding, "EXPECTED", dict.fromkeys(deciding.PAIRS, "nonzero"))
    monkeypatch.setattr(deciding, "_by_simplify", lambda name: (1.0, "did not end"))
    with pytest.raises(LagrotorError, match="same_as says zero, simplify did not end, right is nonzero"):
        deciding.decide_pairs()
