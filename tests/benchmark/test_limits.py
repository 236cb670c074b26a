"""Limits: the predicted thresholds are measured, and lagrotor does what the table says."""

import json
from dataclasses import replace
from importlib.util import find_spec
from math import cos, sin

import numpy as np
import pytest

from lagrotor import Scene, simulate
from lagrotor.benchmark import throughput
from lagrotor.benchmark.limits import coordinate_singularities as coordinates
from lagrotor.benchmark.limits import numerical_drift
from lagrotor.benchmark.limits import range_of_validity as reach
from lagrotor.benchmark.limits.coordinate_singularities import (
    euler_limits,
    joint_line_limits,
    passing,
    past_the_pole,
    projection_limits,
)
from lagrotor.benchmark.limits.error_map import usefulness
from lagrotor.benchmark.limits.numerical_drift import DRIFTING, constraint_drift, drift_limits, long_limits, long_run
from lagrotor.benchmark.limits.range_of_validity import (
    PAIR,
    amplitude_limits,
    horizon_limits,
    next_term,
    off_opposite,
    series_error,
    spin_limits,
)
from lagrotor.benchmark.limits.step_size import LIMITS, step_limits
from lagrotor.benchmark.limits.threshold import Limit, threshold
from lagrotor.benchmark.scipy_solvers import SOLVERS, run_by
from lagrotor.benchmark.throughput import displaced_family
from lagrotor.commands.command_line import main
from lagrotor.errors import IntegrationError, LagrotorWarning, SingularError
from lagrotor.models import euler, exact_orbit, finite_rotation, minimal, spheres
from lagrotor.models.model import problem_of
from lagrotor.numerics import measured_order
from lagrotor.numerics.integrate import integrate
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solvers import dop853


def test_threshold_halves_in_the_logarithm():
    assert threshold(lambda x: x > 3e-7, 1e-12, 1.0, 1e-6) == pytest.approx(3e-7, rel=1e-6)
    assert threshold(lambda x: x < 3e-7, 1e-12, 1.0, 1e-6) == pytest.approx(3e-7, rel=1e-6)
    with pytest.raises(ValueError, match="no change"):
        threshold(lambda x: x > 2, 0.1, 1.0)


def test_a_limit_knows_its_ratio():
    assert Limit("r", "w", "f", 2.0, 3.0, "t").ratio == 1.5


@pytest.mark.parametrize(
    ("tried", "within"),
    [
        (step_limits, 0.03),
        (projection_limits, 0.02),
        (amplitude_limits, 0.03),
        (spin_limits, 0.03),
        (horizon_limits, 0.1),
    ],
)
def test_found_where_predicted(tried, within):
    for limit in tried(True):
        assert limit.ratio == pytest.approx(1, abs=within), limit


def test_joint_line_and_fold():
    fold, in_line = joint_line_limits(True)
    assert 0 < fold.measured < fold.predicted
    assert in_line.ratio == pytest.approx(1, abs=0.2)


@pytest.mark.parametrize("distance", [1.2e-6, 1e-4, 0.1])
def test_the_minimal_model_starts_beside_the_joint_line_with_all_digits(distance: float) -> None:
    """Read off x = tanh u alone they would be lost as eps/(4 d²)."""
    for d in distance * np.linspace(1, 1.5, 40):
        axis = (float(np.sqrt(1 - d * d)), 0.0, float(d))
        scene = Scene((3.0, -3.0), axes=(axis, axis))
        seen = minimal.MODEL.observe(scene, minimal.MODEL.start(scene)[None]).axes[0, 0]
        assert np.hypot(seen[1], seen[2]) == pytest.approx(d, rel=1e-13)


def test_euler_angles_cost_the_logarithm_and_lose_digits_as_the_inverse_of_the_miss():
    cost, digits = euler_limits(True)
    assert 0.8 < cost.ratio < 1.1
    assert 0.2 < digits.ratio < 2
    worst = [max(past_the_pole(m * s, 1e-12)[0] for s in (1, 1.1, 1.2)) for m in (1e-5, 1e-7)]
    assert 20 < worst[1] / worst[0] < 500


def test_minimal_passes_the_pole_unmoved():
    error, spent = past_the_pole(1e-7, 1e-12, minimal.MODEL)
    assert error < 1e-11
    assert spent == past_the_pole(1e-2, 1e-12, minimal.MODEL)[1]


def test_what_the_tool_does_at_the_pole_and_at_the_joint_line():
    near = Scene((0.0, 0.0), axes=((5e-4, 0.0, (1 - 25e-8) ** 0.5),) * 2)
    with pytest.raises(SingularError, match="Euler angles"):
        euler.MODEL.start(near)
    falling = Scene((0.0, 0.0), rates=((0.3, 1.0, 0.0), (0.3, -0.6, 0.0)))  # one axis passes through the joint line
    times = [0.0, 1.0, 2.0]
    with pytest.warns(LagrotorWarning, match="minimal ended early"):
        assert simulate(falling, times, "minimal", 1e-8).ending.early
    runs = [simulate(falling, times, "spheres", tol).axes for tol in (1e-8, 1e-12)]
    assert np.abs(runs[0] - runs[1]).max() < 1e-6
    together = Scene((0.0, 0.0), rates=((1.0, 0.0, 0.0), (1.0, 0.0, 0.0)))  # both: the constraints themselves fail
    for model in ("minimal", "spheres"):
        with pytest.warns(LagrotorWarning, match=f"{model} ended early"):
            assert simulate(together, times, model, 1e-8).ending.early


def test_the_great_circle_is_exact_for_every_model():
    run = simulate(passing(0.2), [0.0, 1.0], "spheres", 1e-12)
    assert past_the_pole(0.2, 1e-12, spheres.MODEL)[0] < 1e-10
    np.testing.assert_allclose(run.axes[0], run.axes[1], atol=1e-12)


def test_the_cured_rotation_has_no_limit():
    for size in (1e-300, 1e-162, 1e-150):
        assert np.isfinite(finite_rotation(np.array([[0.0, 0.0, size]]), 1e-3)).all()


def test_drift_orders():
    time, step, until, kept = drift_limits(True)
    assert time.measured == pytest.approx(2, abs=0.4)
    assert step.measured == pytest.approx(4, abs=0.1)
    assert until.ratio == pytest.approx(1, abs=0.4)
    assert kept.measured < 10 * kept.predicted


def test_projection_stops_the_drift():
    free, held = (constraint_drift(DRIFTING, 0.01, 400, 400, projected)[0] for projected in (False, True))
    assert free > 1e-6
    assert held < 1e-12


def test_series_error_has_the_next_order():
    for order in (1, 3):
        sizes = np.array([0.04, 0.08, 0.16])
        errors = [series_error(PAIR, order, r0) for r0 in sizes]
        assert measured_order(sizes, errors) == pytest.approx(order + 1, abs=0.15)
        assert errors[0] == pytest.approx(next_term(PAIR, order) * sizes[0] ** (order + 1), rel=0.1)


def test_spins_not_quite_opposite_leave_as_their_sum():
    assert off_opposite(2e-4) / off_opposite(1e-4) == pytest.approx(2, rel=1e-2)


@pytest.mark.parametrize("solver", SOLVERS)
def test_solvers_keep_an_orbit(solver):
    orbit = exact_orbit(PAIR, 0.2)
    start = minimal.MODEL.start(orbit.scene)
    times = np.array([0.0, 2 * np.pi / orbit.frequency])
    states, spent = run_by(solver, minimal.MODEL.rate(orbit.scene, False), start, times, 1e-10)
    np.testing.assert_allclose(states[1], start, atol=1e-6)
    assert 100 < spent < 3000


def test_a_solver_that_stops_says_so():
    def lost(t, y):
        return [float("nan")]

    with pytest.warns(UserWarning, match="dop853"), pytest.raises(IntegrationError, match="stopped before"):
        run_by("DOP853", lost, np.array([1.0]), np.array([0.0, 1.0]), 1e-6)


def test_a_long_run_keeps_what_it_should():
    run = long_run(50, "simulate", 1e-9)
    assert run.energy.max() < 1e-7
    assert run.momentum.max() < 1e-8
    assert np.abs(run.phase).max() < 1e-6


@pytest.mark.slow
def test_the_drift_over_ten_thousand_turns_extrapolates_the_first_thousand(monkeypatch):
    """The phase by both parts of its law; twin: ten times what it was after a tenth is not a third of it."""
    runs = []

    def kept(*given):
        runs.append(long_run(*given))
        return runs[-1]

    monkeypatch.setattr(numerical_drift, "long_run", kept)
    for limit in long_limits(False):
        assert limit.ratio == pytest.approx(1, abs=0.5), limit
    assert len(runs) == 4
    assert all(abs(run.phase[-1]) > 30 * np.abs(run.phase[:11]).max() for run in runs)


def test_usefulness_falls_with_amplitude_and_departure():
    found = usefulness(np.array([0.02, 0.2]), np.array([1e-6, 1e-1]), (1, 3))
    assert found.errors.shape == (2, 2, 2)
    assert found.errors[0, 0] == pytest.approx(next_term(PAIR, 1) * found.amplitudes**2, rel=0.5)
    assert (found.errors[1, 0] < found.errors[0, 0] / 3).all()
    assert (found.errors[:, 1] > found.errors[:, 0]).all()


def test_the_displaced_family_starts_on_the_bar():
    scenes = displaced_family(4)
    assert len({scene.axes for scene in scenes}) == 4
    assert all(replace(scene) == scene for scene in scenes)


@pytest.mark.slow
def test_throughput_counts_what_it_ran(monkeypatch):
    monkeypatch.setattr(throughput, "_RUN", 0.1)
    monkeypatch.setattr(throughput, "_BIG", 10_000)
    rows = throughput.throughput(8)
    swept = 2 if find_spec("heyoka") is None else 4
    assert [row.unit for row in rows] == ["trajectories/s"] * swept + ["numbers/s"] + ["points/s"] * 3
    assert all(row.rate > 0 and row.share > 0 for row in rows)


def test_the_command(capsys, monkeypatch):
    for name in [n for n in LIMITS if n != "joint line"]:
        monkeypatch.delitem(LIMITS, name)
    found = Limit("an axis near the joint line", "w", "f", 2.0, 3.0, "t")
    monkeypatch.setitem(LIMITS, "joint line", lambda quick: [found])
    rate = throughput.Throughput("trajectories", "trajectories/s", 1e3, 1.0, "itself")
    monkeypatch.setattr(throughput, "throughput", lambda n: [rate])
    assert main(["stability", "--quick", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["limits"][0]["regime"] == "an axis near the joint line"
    assert {"what", "unit", "rate", "share", "against"} == set(printed["throughput"][0])


def test_what_passes_where_bar_and_axes_are_in_line():
    assert coordinates.passes(2e-5)
    assert not coordinates.passes(5e-6), "nearer than 1e-5 rad the run is refused"


def test_no_solver_steps_over_it_from_afar(monkeypatch):
    """Both axes head for it from 0.6 rad: the time that is left is known before a step of half a radian is taken."""
    swing = Scene((0.0, 0.0), axes=((cos(0.6), 0, sin(0.6)),) * 2, rates=((sin(0.6), 0, -cos(0.6)),) * 2)
    problem = problem_of(spheres.MODEL, swing)

    def run():
        return integrate(problem, np.array([2.0]), 1e-4, lambda segment, _, error: dop853(segment, error))

    with pytest.raises(StopError):
        run()
    monkeypatch.setattr(spheres, "_TOWARDS", 0.95)
    assert run().states.shape == (1, 12)  # twin


def test_spins_not_quite_equal_twist_as_their_difference():
    one, two = reach.off_equal(1e-4, 0.1), reach.off_equal(2e-4, 0.1)
    assert two / one == pytest.approx(2, rel=1e-3)
    assert reach.off_equal(0.0, 0.1) < 1e-10  # twin: equal spins stay together
