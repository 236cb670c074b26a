"""scipy's solvers as engines, and the traps of calling them plainly. No times."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrotor import Scene, Shock, consistent_scene, simulate
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.benchmark.scipy_solvers import ENGINES, IVP, TRAPS, ivp_engine
from lagrotor.models import minimal, spheres
from lagrotor.numerics.segment import Segment, StopError
from lagrotor.numerics.solvers import adams, dop853, lsoda

COURSES = {name: CASES[name](True) for name in ("displaced", "shock")}
TIMES = np.linspace(0, 4, 41)
# The smallest tolerance at which an engine is still fast here.
TIGHT = {"solve_ivp, Radau": 1e-8, "solve_ivp, BDF": 1e-8}


@pytest.fixture(scope="module")
def truths() -> dict[str, Any]:
    return {name: simulate(COURSES[name].scene, TIMES, "minimal", 1e-13).tips for name in ("displaced", "shock")}


def off(tips: Any, truth: Any) -> float:
    return float(np.linalg.norm(tips - truth, axis=-1).max())


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("course", ["displaced", "shock"])
def test_an_engine_gets_there_and_sees_the_shock(name: str, course: str, truths: dict[str, Any]) -> None:
    if (name, course) == ("ode, DOP853", "shock"):
        pytest.skip("its step vanishes where the shock's square underflows; see the test below")
    run = ENGINES[name].prepare(COURSES[course].scene, TIMES)
    tight = TIGHT.get(name, 1e-10)
    (_, few), (tips, many) = run(1e-4), run(tight)
    assert off(tips, truths[course]) < 2000 * tight
    assert 100 < few < many < 20_000


def test_a_shock_too_small_to_square_stops_one_of_them() -> None:
    with pytest.warns(UserWarning, match="too small"), pytest.raises(Exception, match="DOP853 stopped"):
        ENGINES["ode, DOP853"].prepare(COURSES["shock"].scene, COURSES["shock"].t_eval)(1e-6)


def test_an_engine_that_crawls_is_stopped() -> None:
    scene = COURSES["displaced"].scene
    segment = Segment(minimal.MODEL.rate(scene, False), minimal.MODEL.start(scene), 0.0, 4.0, TIMES, budget=100)
    with pytest.raises(StopError, match="100 evaluations by"):
        ivp_engine("RK45")(segment, 1e-8)


# Trap: a plain call over the run.


@pytest.mark.parametrize("method", ["RK23", *IVP])
def test_a_solver_called_once_over_the_run_does_not_see_the_shock(method: str) -> None:
    scene = Scene((10, -10), shock=Shock((40, -11, 0), at=5.0, width=1 / 200))
    rate, start = minimal.MODEL.rate(scene, True), minimal.MODEL.start(scene)
    naive = solve_ivp(lambda t, y: rate(t - 5.0, y), (0, 10), start, method=method)
    assert naive.success
    assert np.abs(naive.y[:, -1]).max() < 1e-12
    assert np.abs(simulate(scene, [0.0, 10.0], "minimal", 1e-3).axes[:, 1, :2]).max() > 1e-3


@pytest.mark.parametrize("name", TRAPS)
def test_the_charts_traps_stand_still_through_its_shock(name: str) -> None:
    course = COURSES["shock"]
    tips, spent = TRAPS[name].prepare(course.scene, course.t_eval)(1e-4)
    moved = float(np.abs(tips - tips[:, :1]).max())
    if "DOP853" in name:  # it looks at twelve places a step, and happens to look at the shock
        assert moved > 0.1
    else:
        assert moved < 1e-6
        assert spent < 100
    # With no step longer than the shock the same solver sees it.
    seeing = name.removesuffix(", one call")
    if seeing in ENGINES:
        tips, _ = ENGINES[seeing].prepare(course.scene, course.t_eval)(1e-4)
        assert np.abs(tips - tips[:, :1]).max() > 0.1


# Trap: a generated function that gives the same list or array each time.


def test_generated_functions_do_not_reuse_their_output() -> None:
    scene = COURSES["displaced"].scene
    for model in (minimal, spheres):
        rate, y = model.MODEL.rate(scene, False), model.MODEL.start(scene)
        first = rate(0.0, y)
        kept = list(first)
        second = rate(0.0, y * 1.01)
        assert first is not second
        assert first == kept
        assert second != kept


def test_a_reused_output_is_silently_wrong() -> None:
    """The twin: DOP853 keeps the rate it was handed, and takes the last stage's for the first's; nothing is raised."""
    scene = COURSES["displaced"].scene
    rate, start, out = minimal.MODEL.rate(scene, False), minimal.MODEL.start(scene), np.empty(6)

    def reused(s: float, y: Any) -> Any:
        out[:] = rate(s, y)
        return out

    times = np.linspace(0, 1, 11)
    for engine, hurt in ((dop853, True), (adams, False), (lsoda, False)):
        sound, twin = (engine(Segment(f, start, 0.0, 1.0, times), 1e-9).states for f in (rate, reused))
        assert np.isfinite(twin).all()
        assert (np.abs(twin - sound).max() > 1e-3) == hurt


# Trap: a displaced start without its velocity of second order.


def test_a_start_without_its_velocity_of_second_order_drifts_and_falls() -> None:
    """The linear orbit has y_1' = −y_2' here; what is missing is of second order in r_0, and turns the pair away."""
    scene = COURSES["displaced"].scene
    across = (scene.rates[0][1] - scene.rates[1][1]) / 2
    plain = consistent_scene(scene.spins, scene.axes, ((0, across, 0), (0, -across, 0)))
    assert abs(scene.rates[0][1] - across) < 0.204**2 * 8
    kept, lost = (simulate(s, np.linspace(0, 20, 401), "minimal", 1e-9).axes for s in (scene, plain))
    drift = np.abs(lost[:, :, 1].mean(0)[:100] - kept[:, :, 1].mean(0)[:100])
    assert drift[-1] > 0.1
    assert np.abs(kept[..., 1]).max() < 0.2
    assert kept[..., 2].min() > 0.97
    assert lost[..., 2].min() < -0.99
