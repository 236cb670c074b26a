"""scipy's solvers as engines, and the traps of calling them plainly. No times."""

from typing import Any

import numpy as np
import pytest

from lagrotor import simulate
from lagrotor.benchmark.scenes_and_methods import CASES
from lagrotor.benchmark.scipy_solvers import ENGINES, TRAPS, ivp_engine
from lagrotor.models import minimal, spheres
from lagrotor.numerics.segment import Segment, StopError

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


# Trap: a displaced start without its velocity of second order.
