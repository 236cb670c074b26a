"""Limits: the predicted thresholds are measured, and lagrotor does what the table says."""

import json
from importlib.util import find_spec
from math import cos, sin

import numpy as np
import pytest

from lagrotor import Scene, simulate
from lagrotor.benchmark import throughput
from lagrotor.benchmark.limits.coordinate_singularities import (
    euler_limits,
    joint_line_limits,
    past_the_pole,
    projection_limits,
)
from lagrotor.benchmark.limits.error_map import usefulness
from lagrotor.benchmark.limits.numerical_drift import drift_limits, long_run
from lagrotor.benchmark.limits.range_of_validity import (
    PAIR,
    amplitude_limits,
    horizon_limits,
    next_term,
    spin_limits,
)
from lagrotor.benchmark.limits.step_size import LIMITS, step_limits
from lagrotor.benchmark.limits.threshold import Limit, threshold
from lagrotor.benchmark.scipy_solvers import SOLVERS, run_by
from lagrotor.commands.command_line import main
from lagrotor.errors import LagrotorWarning, SingularError
from lagrotor.models import euler, exact_orbit, finite_rotation, minimal, spheres
from lagrotor.models.model import problem_of
from lagrotor.numerics.integrate import integrate
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solvers import dop853


def test_threshold_halves_in_the_logarithm():
    assert threshold(lambda x: x > 3e-7, 1e-12, 1.0, 1e-6) == pytest.approx(3e-7, rel=1e-6)
    assert threshold(lambda x: x < 3e-7, 1e-12, 1.0, 1e-6) == pytest.approx(3e-7, rel=1e-6)
    with pytest.raises(ValueError, match="the result is the same"):
        threshold(lambda x: x > 2, 0.1, 1.0)


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


def test_the_cured_rotation_has_no_limit():
    for size in (1e-300, 1e-162, 1e-150):
        assert np.isfinite(finite_rotation(np.array([[0.0, 0.0, size]]), 1e-3)).all()


def test_drift_orders():
    time, step, until, kept = drift_limits(True)
    assert time.measured == pytest.approx(2, abs=0.4)
    assert step.measured == pytest.approx(4, abs=0.1)
    assert until.ratio == pytest.approx(1, abs=0.4)
    assert kept.measured < 10 * kept.predicted


@pytest.mark.parametrize("solver", SOLVERS)
def test_solvers_keep_an_orbit(solver):
    orbit = exact_orbit(PAIR, 0.2)
    start = minimal.MODEL.start(orbit.scene)
    times = np.array([0.0, 2 * np.pi / orbit.frequency])
    states, spent = run_by(solver, minimal.MODEL.rate(orbit.scene, False), start, times, 1e-10)
    np.testing.assert_allclose(states[1], start, atol=1e-6)
    assert 100 < spent < 3000


def test_a_long_run_keeps_what_it_should():
    run = long_run(50, "simulate", 1e-9)
    assert run.energy.max() < 1e-7
    assert run.momentum.max() < 1e-8
    assert np.abs(run.phase).max() < 1e-6


def test_usefulness_falls_with_amplitude_and_departure():
    found = usefulness(np.array([0.02, 0.2]), np.array([1e-6, 1e-1]), (1, 3))
    assert found.errors.shape == (2, 2, 2)
    assert found.errors[0, 0] == pytest.approx(next_term(PAIR, 1) * found.amplitudes**2, rel=0.5)
    assert (found.errors[1, 0] < found.errors[0, 0] / 3).all()
    assert (found.errors[:, 1] > found.errors[:, 0]).all()


@pytest.mark.slow
def test_throughput_counts_what_it_ran(monkeypatch):
    monkeypatch.setattr(throughput, "DURATION", 0.1)
    rows = throughput.throughput(8)
    swept = 2 if find_spec("heyoka") is None else 4
    assert [row.unit for row in rows] == ["trajectories/s"] * swept
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
