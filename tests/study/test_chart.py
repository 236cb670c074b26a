"""The chart: its reference, its bookkeeping, its error ceilings, and the traps it must not fall into. No times."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrotor import Scene, Shock, consistent_scene, simulate
from lagrotor.errors import InputError, LagrotorError
from lagrotor.models import minimal, spheres
from lagrotor.report.chart_command import as_data, draw, in_words
from lagrotor.report.command_line import main
from lagrotor.study.chart import METHODS, Course, Point, chart, courses, front, ratios, seconds_at
from lagrotor.study.reference import reference

STORED = json.loads(Path(__file__).with_name("reference.json").read_text())
TIMES = np.array([0.0, *STORED["times"]])
STATES = np.array([[float(x) for x in row] for row in STORED["states"]])


def displaced() -> Scene:
    return Scene((10, -10), axes=STORED["scene"]["axes"], rates=STORED["scene"]["rates"])


def off(axes: Any) -> float:
    return float(np.abs(axes[:, 1:] - np.array(STORED["axes"])).max())


def test_the_stored_reference_is_the_charts_scene() -> None:
    assert np.array(courses()["displaced"].scene.axes) == pytest.approx(np.array(displaced().axes), abs=1e-15)
    assert np.array(courses()["displaced"].scene.rates) == pytest.approx(np.array(displaced().rates), abs=1e-14)
    assert STORED["formulations_apart"] < 3e-15


@pytest.mark.parametrize("model", ["minimal", "spheres"])
def test_both_formulations_meet_thirty_digits_to_1e_13(model: str) -> None:
    assert off(simulate(displaced(), TIMES, model, 1e-13).axes) < 1e-13
    # Twin: a spin changed in its eleventh digit is seen.
    changed = replace(displaced(), spins=(10.0000000001, -10))
    assert off(simulate(changed, TIMES, model, 1e-13).axes) > 1e-12


def test_the_reference_says_how_far_its_formulations_are_apart() -> None:
    found = reference(displaced(), TIMES)
    assert 0 < found.floor < 1e-13
    assert found.tips.shape == (2, 11, 3)


# Largest error of an axis over 10 s for a tolerance; four times what was measured.
CEILINGS = {
    "minimal": {1e-4: 5e-5, 1e-6: 1.1e-6, 1e-8: 7e-8, 1e-10: 1e-10, 1e-12: 2e-13},
    "spheres": {1e-4: 7e-4, 1e-6: 2e-5, 1e-8: 1e-7, 1e-10: 3e-10, 1e-12: 3e-12},
}
EVALUATIONS = {
    "minimal": {1e-6: 2410, 1e-8: 3522, 1e-10: 4972, 1e-12: 5344},
    "spheres": {1e-6: 2900, 1e-8: 3940, 1e-10: 5400, 1e-12: 4400},
}


@pytest.mark.parametrize("model", CEILINGS)
def test_errors_and_evaluations_stay_under_their_ceilings(model: str) -> None:
    for tol, ceiling in CEILINGS[model].items():
        run = simulate(displaced(), TIMES, model, tol)
        assert off(run.axes) < ceiling
        assert run.evaluations < 1.15 * EVALUATIONS[model].get(tol, 2500)


def test_an_error_that_is_asked_for_less_gets_smaller_down_to_the_floor() -> None:
    found = [off(simulate(displaced(), TIMES, "minimal", tol).axes) for tol in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)]
    assert found == sorted(found, reverse=True)
    assert found[0] / found[-1] > 1e9


# Traps.


@pytest.mark.parametrize("method", ["RK45", "RK23", "Radau", "BDF", "LSODA"])
def test_a_solver_called_once_over_the_run_does_not_see_the_shock(method: str) -> None:
    scene = Scene((10, -10), shock=Shock((40, -11, 0), at=5.0, width=1 / 200))
    rate, start = minimal.MODEL.rate(scene, True), minimal.MODEL.start(scene)
    naive = solve_ivp(lambda t, y: rate(t - 5.0, y), (0, 10), start, method=method)
    assert np.abs(naive.y[:, -1]).max() < 1e-12
    assert np.abs(simulate(scene, [10.0], "minimal", 1e-3).axes[:, 0, :2]).max() > 1e-3


def test_generated_functions_do_not_reuse_their_output() -> None:
    for model in (minimal, spheres):
        rate, y = model.MODEL.rate(displaced(), False), model.MODEL.start(displaced())
        first = rate(0.0, y)
        kept = list(first)
        second = rate(0.0, y * 1.01)
        assert first is not second
        assert first == kept
        assert second != kept


def test_a_start_without_its_velocity_of_second_order_drifts() -> None:
    """The linear orbit has y_1' = −y_2' here; what is missing is of second order in r_0, and turns the pair away."""
    scene = displaced()
    across = (scene.rates[0][1] - scene.rates[1][1]) / 2
    plain = consistent_scene(scene.spins, scene.axes, ((0, across, 0), (0, -across, 0)))
    times = np.linspace(0, 60, 1201)
    away = [abs(simulate(s, times, "minimal", 1e-9).axes[:, -400:, 1].mean()) for s in (scene, plain)]
    assert abs(scene.rates[0][1] - across) < 0.204**2 * 8
    assert away[0] < 0.01
    assert away[1] > 10 * away[0]


# The chart's own bookkeeping.


def small() -> Course:
    return Course(displaced(), np.linspace(0, 1, 11), 1, "one second")


def broken(scene: Scene, times: Any) -> Any:
    raise LagrotorError("does not do this")


def absent(scene: Scene, times: Any) -> Any:
    raise ImportError("no module", name="pydy")


def halfway(scene: Scene, times: Any) -> Any:
    def run(tol: float) -> Any:
        if tol < 1e-4:
            raise RuntimeError("too tight")
        return np.zeros((2, len(times), 3)), 1

    return run


def test_what_fails_is_listed_and_what_is_absent_is_said() -> None:
    methods = {"minimal": METHODS["minimal"], "broken": broken, "absent": absent, "halfway": halfway}
    found = chart("small", small(), methods, (1e-3, 1e-6))
    assert {(p.method, p.tol) for p in found.points} == {("minimal", 1e-3), ("minimal", 1e-6), ("halfway", 1e-3)}
    assert found.failures["broken"] == "does not do this"
    assert "lagrotor[peers]" in found.failures["absent"]
    assert found.failures["halfway, tol 1e-06"] == "too tight"
    assert set(found.setup) == {"minimal", "halfway"}
    assert min(p.error for p in found.points) >= found.floor
    words = in_words([found])
    assert "not there: broken: does not do this" in words
    assert json.loads(json.dumps(as_data([found])))["charts"][0]["scene"] == "small"
    assert len(draw(found).axes) == 2


def test_the_front_keeps_what_nothing_beats() -> None:
    points = [Point("a", 1, e, n, s) for e, n, s in ((1, 10, 1), (0.1, 5, 2), (0.2, 7, 3), (0.01, 20, 4), (2, 9, 9))]
    assert [p.error for p in front(points)] == [1, 0.1, 0.01]
    assert [p.error for p in front(points, "evaluations")] == [0.1, 0.01]
    assert seconds_at(points, 0.1) == pytest.approx(2)
    assert seconds_at(points, 0.1 / 10**0.5) == pytest.approx(8**0.5)
    assert seconds_at(points, 1e-3) is None
    assert seconds_at([], 1) is None


def test_ratios_compare_at_equal_error() -> None:
    points = [Point("minimal", 1, 1e-6, 1, 0.01), Point("minimal, fast", 1, 1e-6, 1, 0.001)]
    points += [Point("PyDy, Cython", 1, 1e-5, 1, 0.1), Point("PyDy, Cython", 1, 1e-7, 1, 0.4)]
    found = replace(chart("small", small(), {"minimal": METHODS["minimal"]}, (1e-3,)), points=tuple(points))
    row = ratios(found, [1e-6])["1e-06"]
    assert row["PyDy, Cython / core"] == pytest.approx(20)
    assert row["core / fast"] == pytest.approx(10)
    assert row["CasADi CVODES / core"] is None


def test_the_command_refuses_a_folder_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chart", "--out", "/no/such/folder"]) == 2
    assert "no folder" in capsys.readouterr().err


def test_an_unknown_engine_is_refused() -> None:
    with pytest.raises(InputError, match="neither core nor fast"):
        simulate(displaced(), [1.0], "minimal", engine="slow")
