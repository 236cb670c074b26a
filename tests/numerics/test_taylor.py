"""The fast extra: the same motion as the core's, orders and steps set apart, and a word where it is not installed."""

import sys

import numpy as np
import pytest

from lagrotor import Scene, Shock, simulate
from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.models import minimal, spheres
from lagrotor.models import simulate as simulating
from lagrotor.models.programs.minimal_program import program
from lagrotor.numerics import taylor
from lagrotor.numerics.integrate import Problem, integrate
from lagrotor.numerics.segment import StopError, Stretch
from lagrotor.numerics.taylor import compiled_solver, dummy_size, taylor_march, taylor_order, taylor_solver
from lagrotor.pair import SHOCK_PAIRED

TIMES = np.array([0.0, 0.7, 2.0, 2.01, 4.0])
MOVING = {"rates": ((0.4, 1, 0), (0.4, -0.5, 0))}


@pytest.fixture
def heyoka():
    return pytest.importorskip("heyoka", reason="the fast extra is not installed")


def test_without_the_fast_extra_a_word_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "heyoka", None)
    taylor._solver.cache_clear()  # what another test has compiled
    with pytest.raises(InputError, match=r"pip install 'lagrotor\[fast\]'"):
        simulate(Scene((10, -10), rates=((0.1, 0, 0), (0.1, 0, 0))), [0.0, 1.0], "minimal", 3e-4, engine="fast")
    with pytest.raises(InputError, match="take minimal, or engine='core'"):
        simulate(Scene((10, -10), axes=((0.6, 0, 0.8),) * 2), [1.0], "spheres", engine="fast")


@pytest.mark.parametrize("shock", [None, SHOCK_PAIRED, Shock((4, 1, 0), at=0.02, width=0.1, body=2)])
def test_the_fast_extra_gives_the_same_motion(heyoka, shock: Shock | None) -> None:
    scene = Scene((10, -7), shock=shock, **MOVING)
    core, fast = (simulate(scene, TIMES, "minimal", 1e-11, engine) for engine in ("core", "fast"))
    assert fast.axes == pytest.approx(core.axes, abs=1e-10)
    assert fast.rates == pytest.approx(core.rates, abs=1e-9)
    loose = simulate(scene, TIMES, "minimal", 1e-5, "fast")
    assert loose.axes == pytest.approx(core.axes, abs=1e-4)
    assert loose.evaluations < fast.evaluations


def test_unit_vectors_run_by_taylor_steps_only_where_there_is_no_bar_to_come_into_line_with() -> None:
    paired, apart = Scene((10, -7)), Scene((10, -7), link=None)
    found = [
        simulating._fast_runs(model, scene) for model in (minimal.MODEL, spheres.MODEL) for scene in (paired, apart)
    ]
    assert found == [True, True, False, True]


@pytest.mark.parametrize(
    ("tol", "order"), [(0.1, 10), (1e-3, 10), (1e-7, 10), (9e-8, 14), (1e-11, 14), (9e-12, 16), (1e-13, 16)]
)
def test_the_order_is_the_one_asked_for_and_a_step_leaves_what_is_asked(heyoka, tol: float, order: int) -> None:
    assert taylor_order(tol) == order
    assert taylor._solver(program(False, "equal", 0), 6, False, order, 1, 0).order == order
    scene = Scene((10, -7), **MOVING)
    exact = simulate(scene, TIMES, "minimal", 1e-13)
    error = np.abs(simulate(scene, TIMES, "minimal", tol, "fast").axes - exact.axes).max()
    assert error < max(tol, 1e-12)


def test_an_azimuth_of_many_turns_costs_no_digit(heyoka) -> None:
    """alpha is cyclic, chi an angle: ten thousand turns more change no step; twin: where chi is not said to be one, they do."""
    scene = Scene((10, -7), **MOVING)
    start, (form, values) = minimal.MODEL.start(scene), minimal.MODEL.program(scene, False)
    far = start + np.array([0, 0, 2e4 * np.pi, 0, 0, 0])
    rate = minimal.MODEL.rate(scene, False)

    def run(y: np.ndarray, angles: tuple[int, ...] = ()) -> Stretch:
        solver = taylor_solver(lambda _: (form, values), taylor_order(1e-11), angles=angles)
        return integrate(Problem(rate, y, np.inf), TIMES, 1e-11, solver)

    near_run, far_run = run(start), run(far)
    assert far_run.evaluations == near_run.evaluations
    assert far_run.states[:, :2] == pytest.approx(near_run.states[:, :2], abs=1e-13)
    assert taylor._cyclic(form, 6) == [2]
    twisted = start + np.array([0, 2e4 * np.pi, 0, 0, 0, 0])
    spent, in_full = (run(twisted, angles).evaluations for angles in (minimal.MODEL.angles, ()))
    assert spent == near_run.evaluations > 1.3 * in_full
    driven, _ = minimal.MODEL.program(Scene((10, -7), shock=SHOCK_PAIRED), True)
    assert taylor._cyclic(driven, 6) == []


def test_what_reaches_the_joint_line_stops_and_says_so(heyoka) -> None:
    falling = Scene((0.0, 0.0), axes=((0, 0, 1),) * 2, rates=((1, 0, 0),) * 2)
    with pytest.warns(LagrotorWarning, match="engine='core' may continue|axis 1 lies along the joint line"):
        run = simulate(falling, [0.0, 1.0, 20.0], "minimal", 1e-9, "fast")
    assert run.ending.early and 1 < run.ending.at < 20 and run.t.tolist() == [0, 1]


def test_what_stops_a_run_is_seen_at_its_last_step_and_not_at_the_last_time_read(heyoka) -> None:
    """x' = x², x = 1/(1 − t): between the times 0.5 and 2 there is no step over t = 1."""
    x = heyoka.make_vars("x")
    solver = compiled_solver([(x, x**2)], 16)
    with pytest.raises(StopError) as stop:
        taylor_march(solver, np.array([1.0]), np.array([0.0, 0.5, 2.0]), (0.0, 2.0), dummy_size(1e-10, 16))
    assert 1 - stop.value.at < 1e-6 and stop.value.reached.end[0] > 1e6 and len(stop.value.reached.states) == 2
