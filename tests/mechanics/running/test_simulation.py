"""Runs of any system: closed solutions, independent integrations, conserved quantities, refusals."""

import importlib.util
import math
import warnings
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson, solve_ivp
from scipy.special import ellipj, ellipk

from lagrotor.errors import ConstraintError, InputError, IntegrationError, LagrotorWarning, SingularError
from lagrotor.mechanics import Frame, System, SystemRun, coordinates, t
from lagrotor.mechanics.running import flow, programs, simulation
from lagrotor.mechanics.running.scales import defect_of
from lagrotor.mechanics.running.start import rounding_of_start
from lagrotor.numerics.segment import StopError

m, l, g, k, R, Omega, w, A = sp.symbols("m l g k R Omega omega A", positive=True)
VALUES = {m: 1.3, l: 0.8, g: 9.81, k: 0.2, R: 0.5, Omega: 6.0, w: 20.0, A: 0.1}
ANGLE, PLANE = coordinates("theta"), coordinates("x y")


def pendulum(**more: object) -> System:
    (theta,), (theta_v,) = ANGLE.q, ANGLE.v
    return System(ANGLE, m * l**2 * theta_v**2 / 2 + m * g * l * sp.cos(theta), **more)


def rod() -> System:
    (x, y), v = PLANE.q, PLANE.v
    return System(PLANE, m * (v[0] ** 2 + v[1] ** 2) / 2 - m * g * y, (x**2 + y**2 - l**2,))


def elliptic(times: np.ndarray, amplitude: float) -> np.ndarray:
    """sin(theta/2) = k sn(K − w t), the pendulum let go at rest."""
    modulus, rate = np.sin(amplitude / 2), np.sqrt(9.81 / 0.8)
    sn, *_ = ellipj(ellipk(modulus**2) - rate * times, modulus**2)
    return 2 * np.arcsin(modulus * sn)


@pytest.fixture(params=["core", "fast"])
def engine(request: pytest.FixtureRequest) -> str:
    if request.param == "fast":
        pytest.importorskip("heyoka")
    return request.param


@pytest.mark.parametrize("tol", [1e-6, 1e-9, 1e-12])
def test_a_pendulum_follows_its_elliptic_function_to_the_tolerance(tol: float, engine: str) -> None:
    times = np.linspace(0, 10, 101)
    run = pendulum().simulate(VALUES, (2.5,), (0,), times, tol, engine)
    assert np.abs(run.q[:, 0] - elliptic(times, 2.5)).max() < 10 * tol
    assert np.ptp(run.energy) < 1e3 * tol
    # Its twin with another length is elsewhere.
    longer = pendulum().simulate(VALUES | {l: 0.81}, (2.5,), (0,), times, tol, engine)
    assert np.abs(longer.q[:, 0] - elliptic(times, 2.5)).max() > 1e-2


def test_a_run_that_is_spent_before_a_pole_names_it() -> None:
    """A top that falls nearly without azimuthal rate; with much of it the same budget is enough, and no pole is spoken of."""
    c = coordinates("phi theta psi")
    body = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(1, 1, sp.Rational(1, 2)), centre=(0, 0, l))
    bodies, values = System(c, body.kinetic - m * g * l * sp.cos(c.q[1])), {m: 1, g: 9.81, l: 1}
    top = System(c, bodies.L)  # the recursion of bodies loses no digits there, and passes
    with pytest.warns(LagrotorWarning, match=r"a pole of these coordinates.*turned\('xyz'\)"):
        run = top.simulate(values, (0, 0.5, 0), (1e-9, -1.5, 0), np.linspace(0, 1, 11), 1e-6)
    assert run.ending.kind == "singular" and run.t[-1] == 0.4 and 0.42 < run.ending.at < 0.43
    assert top.simulate(values, (0, 0.5, 0), (0.1, -1.5, 0), np.linspace(0, 1, 11), 1e-6).ending.kind == "end"


def test_a_run_that_is_spent_elsewhere_ends_where_it_was_and_counts_what_was_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The steps after it are no part of the run, and their evaluations are."""
    start, times = np.array([1.0, 0.0]), np.linspace(0, 1000, 11)
    motion = flow.smooth_motion(pendulum(), VALUES, "core", np.ones(2), 2.0, start, False, ())
    with pytest.raises(StopError) as stop:
        motion(start, times, 1e-9, False, 500)
    monkeypatch.setattr(flow, "_some_steps_on", lambda _, since, y, rest: (since + rest, y, 0))
    with pytest.raises(StopError) as bare:
        motion(start, times, 1e-9, False, 500)
    assert stop.value.cause == bare.value.cause == "budget" and stop.value.at == bare.value.at < 1000
    assert 0 < stop.value.evaluations - bare.value.evaluations < 2_000


def test_a_rod_of_multipliers_swings_as_the_angle_does_and_keeps_its_length(engine: str) -> None:
    times = np.linspace(0, 10, 101)
    angle = pendulum().simulate(VALUES, (1.2,), (0.5,), times, 1e-11)
    place = 0.8 * np.array([np.sin(1.2), -np.cos(1.2)])
    speed = 0.8 * 0.5 * np.array([np.cos(1.2), np.sin(1.2)])
    run = rod().simulate(VALUES, place, speed, times, 1e-11, engine)
    expected = 0.8 * np.column_stack([np.sin(angle.q[:, 0]), -np.cos(angle.q[:, 0])])
    assert np.abs(run.q - expected).max() < 1e-9
    assert run.drift.max() < 1e-12
    assert run.drift.shape == run.energy.shape == (101,)


def test_a_right_hand_side_is_for_any_solver_and_knows_the_time(engine: str) -> None:
    """A pendulum whose support moves up and down, by scipy's solver and by its equation."""
    (theta,), (theta_v,) = ANGLE.q, ANGLE.v
    L = m * l**2 * theta_v**2 / 2 + m * l * (g - A * w**2 * sp.cos(w * t)) * sp.cos(theta)
    driven = System(ANGLE, L, dissipation=k * theta_v**2 / 2)
    rhs = driven.rhs(VALUES, engine)
    assert isinstance(rhs(0.0, np.zeros(2)), np.ndarray if engine == "fast" else list)
    for time, y in ((0.3, (0.5, 0.2)), (1.7, (-1.0, 3.0))):
        pull = 9.81 - 0.1 * 20**2 * np.cos(20 * time)
        expected = [y[1], -pull / 0.8 * np.sin(y[0]) - 0.2 * y[1] / (1.3 * 0.8**2)]
        np.testing.assert_allclose(rhs(time, np.array(y)), expected, rtol=1e-13)
    found = solve_ivp(rhs, (0, 1), (0.5, 0.2), "DOP853", rtol=1e-11, atol=1e-11).y[:, -1]
    run = driven.simulate(VALUES, (0.5,), (0.2,), (0, 1), 1e-11)
    np.testing.assert_allclose(found, [run.q[-1, 0], run.v[-1, 0]], atol=1e-8)
    with pytest.raises(InputError, match="A, k, l, m, omega without a value"):
        driven.rhs({g: 9.81})


@pytest.mark.parametrize("name", ["rate", "bare", "s", "y", "c_0", "y0_", "_0", "d0_", "lambda", "e", "pi", "sin"])
def test_a_parameter_may_have_any_name(name: str) -> None:
    """None meets a name of the generated code."""
    K, (theta,), (theta_v,) = sp.Symbol(name, positive=True), ANGLE.q, ANGLE.v
    L = K * theta_v**2 / 2 * (1 + sp.sin(theta) ** 2) + K * g * sp.cos(theta)
    run, other = (
        System(ANGLE, L.subs(K, s)).simulate({s: 1.7, g: 9.81}, (0.5,), (0.2,), (0, 0.5, 1))
        for s in (K, sp.Symbol("K"))
    )
    assert (run.q == other.q).all() and (run.energy == other.energy).all()
    np.testing.assert_array_equal(run.evaluate(K * theta), 1.7 * run.q[:, 0])


def test_a_start_off_the_constraints_is_refused_with_the_nearest_on_them() -> None:
    with pytest.raises(ConstraintError, match=r"nearest state on them is q0 = \(0\.8, 0\), v0 = \(0, 1\)"):
        rod().simulate(VALUES, (1.0, 0), (0.5, 1), [0, 1])
    q, v = rod().consistent(VALUES, (1.0, 0), (0.5, 1))
    assert rod().simulate(VALUES, q, v, [0, 1]).drift.max() < 1e-12


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_how_far_off_the_constraints_a_start_may_be_goes_by_the_size_of_the_motion(size: float) -> None:
    values, times = {m: 1.0, g: 9.81, l: size}, [0, size**0.5]
    with pytest.raises(ConstraintError, match="off the constraints"):
        rod().simulate(values, (1.0001 * size, 0), (0, 0), times)
    with pytest.raises(ConstraintError, match="off the constraints"):
        rod().linearise({"x": 0, "y": -1.0001 * size}, values)
    run = rod().simulate(values, ((1 + 1e-9) * size, 0), (0, 0), times)  # twin
    assert run.q[0] == pytest.approx([size, 0], rel=1e-12, abs=1e-12 * size)
    assert rod().linearise({"x": 0, "y": -(1 + 1e-9) * size}, values)


@pytest.mark.parametrize("size", [1e-6, 1.0])
def test_metres_beside_radians_are_compared_by_the_mass_metric(size: float) -> None:
    """A rod that hangs by one end, its place typed with a relative error: the angle is one in either unit of length."""
    c = coordinates("x y theta")
    x, y, theta = c.q
    kinetic = m * (c.v[0] ** 2 + c.v[1] ** 2 + l**2 / 12 * c.v[2] ** 2) / 2
    bar = System(c, kinetic - m * g * y, (x - l / 2 * sp.sin(theta), y + l / 2 * sp.cos(theta)))

    def bound(scale: float) -> np.ndarray:
        start = np.array([scale / 2 * np.sin(1.0), -scale / 2 * np.cos(1.0), 1.0, 0, 0, 0])
        return rounding_of_start(bar, {m: 1.0, g: 9.81, l: scale}, start, 0.0)

    assert (bound(size)[:2] < 1e-5 * size).all() and bound(size)[2] == pytest.approx(2e-7)
    assert (bound(1.0)[:2] == 2e-7).all()  # twin


@pytest.mark.parametrize(
    "start", [(1, 1, 1e-3, 1e-3), (1, 1e-9, 1e-3, 0), (0.3, 0.5, 0, 0), (0.2, 0, 1, 5), (1e3, 2, 1e-3, 1e-4)]
)
def test_among_sizes_of_one_the_bound_is_that_of_the_largest_number(start: tuple[float, ...]) -> None:
    """Also of a component, or a velocity, that is small: seven digits of a start are enough."""
    values, state = {m: 1.0, g: 9.81, l: 1.0}, np.array(start)
    assert (rounding_of_start(rod(), values, state, 0.0, 100.0) == 1e-7 * (1 + state.max())).all()
    small = 1e-6 * state  # twin
    assert (rounding_of_start(rod(), values, small, 0.0, 100.0) < 1e-7).all()


@pytest.mark.parametrize("decimals", [5, 7])
def test_a_start_typed_with_seven_decimals_is_taken_and_with_five_is_not(decimals: int) -> None:
    angle, rate = 0.8765432, 1.234e-3
    q, v = np.array([np.sin(angle), -np.cos(angle)]), rate * np.array([np.cos(angle), np.sin(angle)])
    start, values = (q.round(decimals), v.round(9)), {m: 1.0, g: 9.81, l: 1.0}
    if decimals == 7:
        assert rod().simulate(values, *start, [0, 0.1]).drift.max() < 1e-12
    else:
        with pytest.raises(ConstraintError, match="off the constraints"):
            rod().simulate(values, *start, [0, 0.1])


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_a_place_that_is_rounding_has_the_size_of_the_others(size: float) -> None:
    """A pendulum that hangs at rest at x = sin(π) l: in units of 10⁻¹⁶ l a run has no end."""
    values, times = {m: 1.0, g: 9.81, l: size}, [0, size**0.5]
    run = rod().simulate(values, (np.sin(np.pi) * size, -size), (0, 0), times)
    assert run.scales.sizes[:2] == pytest.approx([size, size]) and run.evaluations < 1000
    assert run.q[-1] == pytest.approx([0, -size], abs=1e-14 * size)
    swing = rod().simulate(values, (1e-9 * size, -size), (0, 0), times)  # twin: a motion of its own
    assert swing.scales.sizes[0] < 1e-8 * size


def test_a_component_of_rounding_is_not_taken_for_off_the_constraints() -> None:
    (x, y), v = PLANE.q, PLANE.v
    still = System(PLANE, m * (v[0] ** 2 + v[1] ** 2) / 2, (x + y - 1,))
    run = still.simulate({m: 1.0}, (3e-17, 1 - 2e-16), (0, 0), [0, 1])
    assert run.q[-1] == pytest.approx([0, 1], abs=1e-15)
    with pytest.raises(ConstraintError, match="off the constraints"):  # twin
        still.simulate({m: 1.0}, (3e-17, 1 - 1e-6), (0, 0), [0, 1])
    bowl = System(PLANE, m * (v[0] ** 2 + v[1] ** 2) / 2 - m * g * y, (y - x**2,))  # at rest at the origin
    assert bowl.simulate({m: 1.0, g: 9.81}, (0, 1e-16), (0, 0), [0, 1]).drift.max() < 1e-15
    with pytest.raises(ConstraintError, match="off the constraints"):  # twin
        bowl.simulate({m: 1.0, g: 9.81}, (0, 1e-6), (0, 0), [0, 1])


def test_a_wire_that_turns_carries_its_bead_outward(engine: str) -> None:
    """r'' = Omega² r: r = r_0 cosh(Omega t), started at a time that is not zero."""
    (x, y), v = PLANE.q, PLANE.v
    wire = System(PLANE, m * (v[0] ** 2 + v[1] ** 2) / 2, (y * sp.cos(Omega * t) - x * sp.sin(Omega * t),))
    times = np.linspace(1.0, 1.3, 31)
    values = {m: 1.0, Omega: 6.0}
    along, across = np.array([np.cos(6.0), np.sin(6.0)]), np.array([-np.sin(6.0), np.cos(6.0)])
    run = wire.simulate(values, 0.1 * along, 0.6 * across, times, 1e-10, engine)
    assert np.hypot(*run.q.T) == pytest.approx(0.1 * np.cosh(6.0 * (times - 1)), abs=1e-8)
    assert run.drift.max() < 1e-10
    _, v0 = wire.consistent(values, 0.1 * along, (0, 0), 1.0)
    assert np.abs(v0 - 0.6 * across).max() < 1e-12


def test_explicit_time_friction_and_force_agree_with_scipy_from_the_textbook_equation(engine: str) -> None:
    (theta,), (theta_v,) = ANGLE.q, ANGLE.v
    shaken = pendulum(dissipation=k * theta_v**2 / 2, forces=(A * sp.cos(w * t) * sp.sin(theta),))
    times = np.linspace(0.5, 8, 60)
    run = shaken.simulate(VALUES, (1.0,), (0.3,), times, 1e-10, engine)

    def rhs(s: float, y: np.ndarray) -> list[float]:
        inertia = 1.3 * 0.8**2
        torque = -1.3 * 9.81 * 0.8 * np.sin(y[0]) - 0.2 * y[1] + 0.1 * np.cos(20 * s) * np.sin(y[0])
        return [y[1], torque / inertia]

    oracle = solve_ivp(rhs, (0.5, 8), [1.0, 0.3], "DOP853", times, rtol=1e-12, atol=1e-13).y.T
    assert np.abs(np.column_stack([run.q, run.v]) - oracle).max() < 1e-8


def test_dense_output_is_as_exact_as_the_run(engine: str) -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), np.linspace(0, 6, 4), 1e-11, engine)
    times = np.array([0.0, 0.3, 1.9999, 2.0, 4.7, 6.0])
    assert np.abs(run.at(times).q[:, 0] - elliptic(times, 2.5)).max() < 1e-9
    with pytest.raises(InputError, match="between 0 and 6 s"):
        run.at([6.1])


def test_expressions_are_evaluated_along_a_run() -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), np.linspace(0, 6, 31), 1e-11)
    height = run.evaluate(l * (1 - sp.cos(ANGLE.q[0])))
    assert height == pytest.approx(0.8 * (1 - np.cos(run.q[:, 0])))
    assert run.evaluate(sp.S.One).shape == (31,)
    with pytest.raises(InputError, match="unheard without a value"):
        run.evaluate(sp.Symbol("unheard"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"values": {m: 1, l: 1}}, "g without a value"),
        ({"values": VALUES | {g: "much"}}, "must be a number"),
        ({"values": VALUES | {g: np.nan}}, "must be finite"),
        ({"q0": (1, 2)}, "one for each coordinate"),
        ({"v0": (np.inf,)}, "1 finite numbers"),
        ({"t": [0, 1, 1]}, "increasing"),
        ({"t": "soon"}, "array of times"),
        ({"tol": 1e-20}, "tol"),
        ({"engine": "warp"}, "is neither core nor fast"),
    ],
)
def test_what_cannot_be_run_is_refused_before_it_runs(arguments: dict, message: str) -> None:
    ready = {"values": VALUES, "q0": (1,), "v0": (0,), "t": [0, 1]} | arguments
    with pytest.raises(InputError, match=message):
        pendulum().simulate(**ready)


def test_a_symbol_of_the_same_name_but_other_assumptions_is_pointed_out() -> None:
    for stranger in (sp.Symbol("theta"), sp.Symbol("t")):
        with pytest.raises(InputError, match=f"System: two different symbols are called '{stranger}'"):
            System(ANGLE, ANGLE.v[0] ** 2 / 2 + t * ANGLE.q[0] * sp.cos(stranger))


def test_a_lagrangian_without_a_mass_is_refused() -> None:
    with pytest.raises(SingularError, match=r"not regular in y_dot; use fewer"):
        System(PLANE, PLANE.v[0] ** 2 / 2 - PLANE.q[1] ** 2).simulate({}, (0, 0), (0, 0), [0, 1])
    twice = System(PLANE, rod().L, (rod().constraints[0], 2 * rod().constraints[0]))
    with pytest.raises(SingularError, match="dependent"):
        twice.simulate(VALUES, (0.8, 0), (0, 0), [0, 1])


def test_names_that_are_words_of_a_language_are_no_trouble() -> None:
    c = coordinates("y lambda")
    odd = sp.symbols("s gamma in", positive=True)
    L = odd[0] * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - odd[1] * c.q[0] ** 2 / 2 - odd[2] * c.q[1] ** 2 / 2
    run = System(c, L).simulate({"s": 1, "gamma": 4, "in": 9}, (1, 1), (0, 0), np.linspace(0, 3, 31), 1e-10)
    assert run.q == pytest.approx(np.column_stack([np.cos(2 * run.t), np.cos(3 * run.t)]), abs=1e-8)


def test_crossings_are_found_where_the_solution_has_them(engine: str) -> None:
    c = coordinates("x")
    oscillator = System(c, c.v[0] ** 2 / 2 - 4 * c.q[0] ** 2 / 2)
    run = oscillator.simulate({}, (1,), (0,), np.linspace(0, 10, 41), 1e-12, engine)
    half = sp.Rational(1, 2)
    up, down, both = (run.crossings(c.q[0] - half, d) for d in (1, -1, 0))
    expected = np.arccos(0.5) / 2
    turns = np.arange(0, 10, np.pi)
    assert down.t == pytest.approx((turns + expected)[turns + expected < 10], abs=1e-11)
    assert up.t == pytest.approx((turns + np.pi - expected)[turns + np.pi - expected < 10], abs=1e-11)
    assert len(both.t) == len(up.t) + len(down.t)
    assert np.abs(both.q - 0.5).max() < 1e-12
    assert len(run.crossings(c.q[0] - 2).t) == 0
    assert run.poincare(c.q[0] - 2, (c.q[0], c.v[0])).shape == (0, 2)
    with pytest.raises(InputError, match="direction"):
        run.crossings(c.q[0], 2)


def test_a_run_is_saved_and_read_again_with_its_system(tmp_path: Path) -> None:
    """The file holds no equations: the system is given with it, and what is read goes on as the run does."""
    run = rod().simulate(VALUES, (0.8, 0), (0, 0), np.linspace(0, 0.4, 11), 1e-9)
    again = SystemRun.load(run.save(tmp_path / "run.npz"), rod())
    for name in ("t", "q", "v", "errors", "energy", "drift"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    assert again.ending == run.ending and again.horizon == run.horizon and again.evaluations == run.evaluations
    np.testing.assert_array_equal(again.at([0.123]).q, run.at([0.123]).q)
    np.testing.assert_array_equal(
        again.crossings(PLANE.q[0] - PLANE.q[1] - 1).t, run.crossings(PLANE.q[0] - PLANE.q[1] - 1).t
    )
    with pytest.raises(InputError, match="another system, in x, y"):
        SystemRun.load(tmp_path / "run.npz", System(PLANE, rod().L))
    with pytest.raises(InputError, match="another system"):
        SystemRun.load(tmp_path / "run.npz", pendulum())
    header = run.save(tmp_path / "run.csv").read_text().splitlines()
    assert header[0].startswith("t [s],x") and len(header) == 12
    frame = run.to_dataframe() if importlib.util.find_spec("pandas") else None
    assert frame is None or list(frame.columns) == ["x", "y", "x_dot", "y_dot", "energy", "drift"]


def test_time_is_no_component_of_the_error(engine: str) -> None:
    """The same driven motion, begun at 0 and, its phase with it, at 10⁵ s: as exact, for as many evaluations.

    Twins: a tolerance divided by 1 + t takes many more; one measured with the time among the states is not kept.
    """
    p = sp.Symbol("p", real=True)
    shaken = pendulum(dissipation=k * ANGLE.v[0] ** 2 / 2, forces=(A * sp.cos(w * t - p) * sp.sin(ANGLE.q[0]),))
    late = 2 * np.pi / 20 * 318_310
    runs = [
        shaken.simulate(VALUES | {p: 20 * begin}, (1.0,), (0.3,), begin + np.linspace(0, 8, 30), 1e-8, engine)
        for begin in (0.0, late)
    ]
    assert np.abs(runs[0].q - runs[1].q).max() < 2e-8
    assert max(run.error for run in runs) < 1e-8
    assert runs[1].evaluations < 1.3 * runs[0].evaluations


def test_two_crossings_between_two_samples_are_both_found() -> None:
    c = coordinates("x")
    run = System(c, c.v[0] ** 2 / 2 + c.q[0]).simulate({}, (-1,), (2,), [0, 1.0], 1e-12)  # x = −1 + 2 t + t²/2
    thrown = System(c, c.v[0] ** 2 / 2 - 4 * c.q[0]).simulate({}, (-0.1,), (2,), [0, 1.0], 1e-12)
    assert len(run.crossings(c.q[0]).t) == 1
    assert thrown.crossings(c.q[0]).t == pytest.approx(np.roots([-2, 2, -0.1])[::-1], abs=1e-11)


def henon_heiles() -> System:
    (x, y), (x_v, y_v) = PLANE.q, PLANE.v
    return System(PLANE, (x_v**2 + y_v**2) / 2 - (x**2 + y**2) / 2 - x**2 * y + y**3 / 3)


def test_a_poincare_section_of_henon_and_heiles_lies_on_the_energy_surface() -> None:
    run = henon_heiles().simulate({}, (0, 0.1), (0.45, 0.1), np.linspace(0, 100, 1001), 1e-10)
    x, (y, y_v) = PLANE.q[0], (PLANE.q[1], PLANE.v[1])
    points = run.poincare(x, (y, y_v))
    assert len(points) > 10
    kinetic = run.energy[0] - (points[:, 0] ** 2 / 2 - points[:, 0] ** 3 / 3) - points[:, 1] ** 2 / 2
    assert (kinetic > 0).all()
    there = run.crossings(x, 1)
    assert there.v[:, 0] ** 2 / 2 == pytest.approx(kinetic, abs=1e-8)


@pytest.mark.slow
def test_the_lyapunov_exponent_tells_chaos_from_order_and_is_that_of_two_neighbours() -> None:
    """A double pendulum; the oracle is the growth of the distance of two runs, renormalised by hand."""
    (a, b), (a_v, b_v) = PLANE.q, PLANE.v
    L = a_v**2 + b_v**2 / 2 + a_v * b_v * sp.cos(a - b) + 2 * sp.cos(a) + sp.cos(b)
    double, times = System(PLANE, L), np.linspace(0, 200, 401)
    chaotic = double.simulate({}, (2, 2.5), (0, 0), times, 1e-9).lyapunov()
    calm = double.simulate({}, (0.1, 0.1), (0, 0), times, 1e-9).lyapunov()
    assert chaotic.exponent > 5 * chaotic.error > 0
    assert abs(calm.exponent) < 0.05
    apart, y, other, growth = 1e-7, np.array([2, 2.5, 0, 0]), np.array([2, 2.5, 1e-7, 0]), 0.0
    for _ in range(200):
        ends = [double.simulate({}, s[:2], s[2:], [0, 1.0], 1e-11) for s in (y, other)]
        y, end = (np.concatenate([r.q[-1], r.v[-1]]) for r in ends)
        distance = np.linalg.norm(end - y)
        growth, other = growth + np.log(distance / apart), y + (end - y) * apart / distance
    assert growth / 200 == pytest.approx(chaotic.exponent, abs=4 * chaotic.error)


def test_the_exponent_of_a_saddle_is_its_rate() -> None:
    c = coordinates("x")
    saddle = System(c, c.v[0] ** 2 / 2 + 4 * c.q[0] ** 2 / 2)
    found = saddle.simulate({}, (0,), (0,), [0, 50.0], 1e-9).lyapunov()
    assert found.exponent == pytest.approx(2, abs=0.1)
    assert found.history.shape == found.t.shape == (200,)
    assert found.exponent == found.history[-1] and found.t[-1] == 50
    with pytest.raises(InputError, match="one sample"):
        saddle.simulate({}, (0,), (0,), [0.0]).lyapunov()


def test_a_parameter_that_is_in_no_equation_is_no_trouble(engine: str) -> None:
    run = System(ANGLE, k * ANGLE.v[0] ** 2 - k * ANGLE.q[0] ** 2).simulate({k: 2}, (1,), (0,), (0, 1.0), 1e-9, engine)
    assert run.q[-1, 0] == pytest.approx(np.cos(1), abs=1e-8)
    assert run.summary()["coordinates"] == "theta" and run.summary()["times"] == "2, from 0 to 1 s"


def test_a_neighbour_that_cannot_go_on_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), (0, 10), 1e-9)
    monkeypatch.setattr("lagrotor.mechanics.running.monodromy.MOST", 2000)
    with pytest.raises(IntegrationError):
        run.lyapunov()


REFUSED = {
    "of one sample crosses": lambda run: run.at([0.0]).crossings(ANGLE.q[0]),
    "must lie between 1 and": lambda run: run.animate("film.gif", lines=[[(0, 0, 0), (0, 0, l)]], fps=0),
    "must be 3 expressions": lambda run: run.animate("film.gif", lines=[[(0, 0), (0, l)]]),
    "is no line": lambda run: run.animate("film.gif", lines=[0]),
    "no System": lambda run: run.system.same_as("pendulum"),
    "must be names": lambda run: coordinates(3),
    "f = 'x' is no expression": lambda run: run.system.conserved("x"),
    "gauge = 'x' is no expression": lambda run: run.system.noether((0,), gauge="x"),
    "one component": lambda run: run.system.noether("x"),
    "theta = 'x' is no expression": lambda run: run.system.in_coordinates(coordinates("x"), {ANGLE.q[0]: "x"}),
    "consistent: l, m without a value": lambda run: rod().consistent({}, (1, 0), (0, 0)),
}


@pytest.mark.parametrize("power", [sp.Rational(3, 2), 3])
def test_a_motion_that_goes_to_infinity_ends_there(power: sp.Expr) -> None:
    """x'² = x^{2p} with x = 1 at first: x = (1 − (p − 1) t)^{−1/(p − 1)}, and in the other direction for ever."""
    (x,), (v,) = (c := coordinates("x")).q, c.v
    escape, power = System(c, v**2 / 2 + x ** (2 * power) / 2), float(power)
    times = np.linspace(0, 3 / (power - 1), 40)
    end = 1 / (power - 1)
    with pytest.warns(LagrotorWarning, match="ended early"):
        run = escape.simulate({}, (1,), (1,), times, 1e-8)
    assert run.ending.kind == "singular" and "grows without bound" in run.ending.reason
    assert run.ending.at == pytest.approx(end, rel=0.01) and run.t[-1] <= end
    exact = (1 - (power - 1) * run.t) ** (-1 / (power - 1))
    states, same = np.hstack([run.q, run.v]), np.stack([exact, exact**power], 1)
    assert (run.scales.distance(states, same) <= run.errors + 1e-12).all() and run.errors[1] < 1e-6
    back = escape.simulate({}, (1,), (-1,), times, 1e-8)
    assert back.ending.kind == "end"


@pytest.mark.parametrize(
    ("power", "near", "n"), [(sp.Rational(3, 2), 2e-4, 2), (sp.Rational(3, 2), 2e-3, 50), (2, 1e-3, 2), (3, 1e-3, 300)]
)
def test_a_motion_on_its_way_to_infinity_is_as_exact_as_it_is_told(power: sp.Expr, near: float, n: int) -> None:
    """At x = 1 steps were judged by the size of the end, 10^11 times larger: the first ended at 62 for 2·10^7, told to 4e-7."""
    (x,), (v,) = (c := coordinates("x")).q, c.v
    escape, power = System(c, v**2 / 2 + x ** (2 * power) / 2), float(power)
    run = escape.simulate({}, (1,), (1,), np.linspace(0, (1 - near) / (power - 1), n), 1e-7)
    exact = (1 - (power - 1) * run.t) ** (-1 / (power - 1))
    states, same = np.hstack([run.q, run.v]), np.stack([exact, exact**power], 1)
    off = run.scales.distance(states, same)
    assert run.ending.kind == "end" and run.error <= 1e-7 and (off <= run.errors + 1e-14 / near).all()
    assert run.scales.sizes[0] < 1e4


@pytest.mark.parametrize("message", REFUSED)
def test_what_makes_no_sense_is_refused_in_words(message: str) -> None:
    run = pendulum().simulate(VALUES, (1,), (0,), (0, 1), 1e-6)
    with pytest.raises(InputError, match=message):
        REFUSED[message](run)


def test_names_stand_for_symbols_wherever_values_are_given() -> None:
    named = {str(s): value for s, value in VALUES.items()}
    assert rod().consistent(named, (1, 0), (0, 0))[0][0] == pytest.approx(0.8)
    swing = {name: named[name] for name in ("m", "g", "l")}
    assert abs(pendulum().linearise({"theta": 0}, swing).rates[0]) == pytest.approx(np.sqrt(9.81 / 0.8))


def test_a_run_is_drawn_and_filmed(tmp_path: Path) -> None:
    run = rod().simulate(VALUES, (0.8, 0), (0, 0), np.linspace(0, 0.4, 11), 1e-9)
    figure = run.plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["$x$", "$y$", "E − E(0)", "largest |g|"]
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_ydata(), run.q[:, 0])
    from PIL import Image

    film = run.animate(tmp_path / "rod.gif", lines=[[(0, 0, 0), (PLANE.q[0], 0, PLANE.q[1])]])
    with Image.open(film) as image:
        assert image.n_frames > 5
    with pytest.raises(InputError, match=r"give lines="):
        run.animate(tmp_path / "none.gif")


@settings(max_examples=8, deadline=None)
@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(0.5, 3))
def test_a_charge_in_a_uniform_field_turns_at_the_cyclotron_rate(x_v: float, y_v: float, rate: float) -> None:
    (x, y), v = PLANE.q, PLANE.v
    B = sp.Symbol("B")
    charge = System(PLANE, (v[0] ** 2 + v[1] ** 2) / 2 + B * (x * v[1] - y * v[0]) / 2)
    times = np.linspace(0, 5, 11)
    run = charge.simulate({B: rate}, (0, 0), (x_v, y_v), times, 1e-10)
    turned = (x_v + 1j * y_v) * np.exp(-1j * rate * times)
    assert run.v[:, 0] + 1j * run.v[:, 1] == pytest.approx(turned, abs=1e-7)


def test_a_run_past_dependent_constraints_says_where() -> None:
    """A snakeboard whose steering passes a right angle: both wheels then forbid the same."""
    c = coordinates("x y theta psi phi")
    (_, _, th, _, ph), (x_v, y_v, th_v, ps_v, ph_v) = c.q, c.v
    L = 3 * (x_v**2 + y_v**2) + th_v**2 / 100 + (th_v + ps_v) ** 2 / 30 + ph_v**2 / 1000
    wheels = [
        side * l * sp.cos(ph) * th_v - sp.sin(th - side * ph) * x_v + sp.cos(th - side * ph) * y_v for side in (1, -1)
    ]
    board = System(c, L, rolling=tuple(wheels))
    q0, v0 = board.consistent({l: 0.2}, (0, 0, 0.1, 0, 0.3), (0.3, 0, 0, 0.1, 1.0))
    with pytest.warns(LagrotorWarning, match=r"near t = 1.2\d* s the constraints become dependent"):
        board.simulate({l: 0.2}, q0, v0, np.linspace(0, 2, 41))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        before = board.simulate({l: 0.2}, q0, v0, np.linspace(0, 1, 21))
    assert before.ending.kind == "end" and before.t[-1] == 1 and before.q[-1, 4] < np.pi / 2


def test_constraints_that_turn_round_stay_independent() -> None:
    """The twin: a skate turns right round, and its one constraint with it."""
    c = coordinates("x y phi")
    skate = System(
        c, (c.v[0] ** 2 + c.v[1] ** 2 + c.v[2] ** 2) / 2, rolling=(sp.sin(c.q[2]) * c.v[0] - sp.cos(c.q[2]) * c.v[1],)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = skate.simulate({}, (0, 0, 0), (1, 0, 3), np.linspace(0, 4, 9), 1e-8)
    assert run.q[:, :2] == pytest.approx(np.column_stack([np.sin(3 * run.t), 1 - np.cos(3 * run.t)]) / 3, abs=1e-7)


def test_a_complex_lagrangian_is_refused() -> None:
    with pytest.raises(InputError, match="is complex"):
        System(ANGLE, sp.I * ANGLE.v[0] ** 2)


def test_constraints_that_are_nearly_dependent_are_known_no_better_than_they_can_be(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A plane 1e-8 below the pole of a unit sphere cuts a circle of 1.4e-4: rounding of 1e-16 there is 5e-9 of its radius."""
    c, low = coordinates("x y z"), 1 - sp.Rational(1, 10**8)
    (x, y, z), (x_v, y_v, z_v) = c.q, c.v
    system = System(c, (x_v**2 + y_v**2 + z_v**2) / 2, constraints=(x**2 + y**2 + z**2 - 1, z - low))
    radius, rate, times = float(sp.sqrt(1 - low**2)), 3.0, np.linspace(0, 10, 21)
    turned, still = np.exp(1j * rate * times), 0 * times
    exact = radius * np.array([turned.real, turned.imag, still, -rate * turned.imag, rate * turned.real, still])
    exact[2] = float(low)

    def told_and_true() -> tuple[float, float]:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LagrotorWarning)
            run = system.simulate({}, exact[:3, 0], exact[3:, 0], times, 1e-8)
        return run.error, float(run.scales.distance(exact.T, np.hstack([run.q, run.v])).max())

    told, true = told_and_true()
    assert told > true
    monkeypatch.setattr(simulation, "DEPENDENT", simulation.DEPENDENT._replace(value=0.0))  # twin
    told, true = told_and_true()
    assert true > 2 * told


def test_special_functions_have_an_energy() -> None:
    """A particle in the field of a smeared charge: V = erf q."""
    c = coordinates("q")
    run = System(c, c.v[0] ** 2 / 2 - sp.erf(c.q[0])).simulate({}, (0.5,), (1.0,), [0, 0.5, 1.0])
    np.testing.assert_allclose(run.energy, 0.5 + math.erf(0.5), rtol=1e-8)


def test_an_integral_is_heard_where_its_slope_cannot_be_measured() -> None:
    """A step from x = 10⁻¹² leaves the domain of √x: not a number there made all else unheard, as its twin in numpy shows."""
    c = coordinates("x")
    defect = defect_of(System(c, c.v[0] ** 2 / 2 - sp.sqrt(c.q[0])), {}, np.ones(2))
    off = defect(np.arange(3.0), np.array([[1, 0], [1e-12, 1.4], [1, 0.1]]))
    assert np.isfinite(off).all() and np.abs(off).max() > 1e-3
    assert not np.array([1.0, np.nan]).max() > 1e-3


@pytest.mark.parametrize("unit", [1.0, 1e-5, 1e6])
def test_damping_that_is_soon_over_does_not_set_the_cost_of_the_rest(unit: float) -> None:
    """x'' + D x' + k x = 0 with D = 10⁶, k = 2·10⁵ over 12 s, in any unit of time: a step of an explicit method is 6 µs."""
    D, k_ = 1e6 / unit, 2e5 / unit**2
    (x,), (v,) = (c := coordinates("x")).q, c.v
    times = unit * np.linspace(0, 12, 7)
    run = System(c, v**2 / 2 - k * x**2 / 2, forces=(-m * v,)).simulate({m: D, k: k_}, (1,), (0,), times, 1e-7)
    fast = -(D + math.sqrt(D**2 - 4 * k_)) / 2
    slow = k_ / fast
    assert abs(run.q[:, 0] - (fast * np.exp(slow * times) - slow * np.exp(fast * times)) / (fast - slow)).max() < 1e-7
    assert run.error <= 1e-7 and run.evaluations < 20_000  # another motion like it took 18.7 million


def test_a_row_that_turns_much_between_two_samples_is_not_taken_for_dependent_ones() -> None:
    """A sleigh on its blade, its centre of mass over it, goes round in circles: 11 turns between two samples."""
    (_, _, h), v = (c := coordinates("x y theta")).q, c.v
    sleigh = System(c, (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2, rolling=(-sp.sin(h) * v[0] + sp.cos(h) * v[1],))
    with warnings.catch_warnings():
        warnings.simplefilter("error", LagrotorWarning)
        run = sleigh.simulate({}, (0, 0, 0), (1, 0, 7), [0, 10, 20.0], 1e-6)
    assert run.q[:, 0] == pytest.approx(np.sin(7 * run.t) / 7, abs=1e-5)


def test_every_evaluation_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the survey, of a companion that was given up, of a look at constraints between two samples, and of `at`."""
    calls, rhs = 0, programs.Generated.__dict__["rhs"].func

    def counting(program: programs.Generated) -> object:
        def of(*parameters: object) -> object:
            inner = rhs(program)(*parameters)

            def counted(s: float, y: np.ndarray) -> object:
                nonlocal calls
                calls += 1
                return inner(s, y)

            return counted

        return of

    monkeypatch.setattr(programs.Generated, "rhs", property(counting))
    (x,), (v,) = (c := coordinates("x")).q, c.v
    (*_, h), u = (plane := coordinates("x y theta")).q, plane.v
    stiff = System(c, v**2 / 2 - x**2 / 2, forces=(-k * v,))
    sleigh = System(plane, sum(e**2 for e in u) / 2, rolling=(-sp.sin(h) * u[0] + sp.cos(h) * u[1],))
    for system, values, q, speeds in (
        (stiff, {k: 1}, (1,), (0,)),
        (stiff, {k: 1e3}, (1,), (0,)),
        (sleigh, {}, (0, 0, 0), (1, 0, 7)),
    ):
        calls = 0
        run = system.simulate(values, q, speeds, [0, 10], 1e-4)
        assert run.evaluations == calls
        assert run.at([1, 2.5]).evaluations == calls


def bell(s, at, width, exp=np.exp):
    return exp(-(((s - at) / width) ** 2))


BRIEF = {
    "pulse": (bell(t, 5.1, 0.02, sp.exp), lambda s: bell(s, 5.1, 0.02)),
    "two": (bell(t, 3, 0.01, sp.exp) - bell(t, 9, 0.02, sp.exp), lambda s: bell(s, 3, 0.01) - bell(s, 9, 0.02)),
    "step": (sp.tanh((t - 5) / 0.001) + 1, lambda s: np.tanh((s - 5) / 0.001) + 1),
}


@pytest.mark.parametrize("name", BRIEF)
def test_what_acts_briefly_by_the_clock_is_not_passed_over(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a body at rest, where nothing else limits a step; Duhamel's integral is x(10)."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    force, shape = BRIEF[name]
    system, times = System(ANGLE, v**2 / 2 - x**2 / 2, forces=(force,)), np.linspace(0, 10, 2)
    s = np.linspace(0, 10, 400_001)
    with np.errstate(over="ignore"):
        exact = float(simpson(np.sin(10 - s) * shape(s), x=s))
    run = system.simulate({}, (0,), (0,), times, tol=1e-7)
    assert abs(run.q[-1, 0] - exact) <= max(run.error, 1e-9) * np.abs(run.states[:, :2]).max() < 1
    monkeypatch.setattr(simulation, "clock_windows", lambda *_: ())
    blind = system.simulate({}, (0,), (0,), times, tol=1e-7)
    assert name == "step" or abs(blind.q[-1, 0] - exact) > 1e3 * max(blind.error, 1e-9) * abs(
        exact
    )  # twin: it is missed


@pytest.mark.parametrize("shape", [sp.sech((t - 5) * 1000) ** 2, sp.cosh((t - 5) / k) ** -2])
def test_a_pulse_of_another_shape_is_zero_far_away(shape: sp.Expr) -> None:
    """1/cosh²(s/w), the cosh of which is beyond what a double holds; from its transform, π w²/sinh(π w/2)."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    values = {k: 0.001} if k in shape.free_symbols else {}
    run = System(ANGLE, v**2 / 2 - x**2 / 2, forces=(shape,)).simulate(values, (0,), (0,), [0, 10], 1e-8)
    exact = math.pi * 1e-6 / math.sinh(math.pi * 0.001 / 2) * math.sin(5)
    assert abs(run.q[-1, 0] - exact) <= run.error * abs(exact) <= 1e-8


def test_what_a_late_pulse_leaves_is_the_size_of_the_motion() -> None:
    """A wave packet near the end of a run: what the coarse run was off by before it counted for the size of the motion."""
    packet = sp.exp(-((16 * (t - 40.5)) ** 2)) * sp.sin(48 * (t - 40.5))
    c = coordinates("x")
    run = System(c, c.v[0] ** 2 / 2 - c.q[0] ** 2 / 2, forces=(packet,)).simulate(
        {}, (0,), (0,), np.linspace(0, 44, 101), 1e-6
    )
    largest = float(np.abs(run.q).max())
    assert largest < run.scales.sizes[0] < 20 * largest  # it was 0.004 of it
    assert run.error < 1e-6 and run.evaluations < 3_000


def test_a_force_that_never_rests_is_not_brief() -> None:
    (x,), (v,) = ANGLE.q, ANGLE.v
    run = System(ANGLE, v**2 / 2 - x**2 / 2, forces=(sp.cos(3 * t),)).simulate({}, (0,), (0,), np.linspace(0, 30, 3))
    assert run.scales.windows == ()


@pytest.mark.parametrize("width", [0.001, 0.01, 0.1])
def test_a_pulse_in_a_function_that_never_rests_is_not_passed_over(width: float) -> None:
    """cos 0.3 t and a pulse in one function, on a slow body at rest; its steps are long but where the pulse is."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    system = System(ANGLE, v**2 / 2 - (0.3 * x) ** 2 / 2, forces=(sp.Function("F")(t),))
    run = system.simulate({"F": lambda s: np.cos(0.3 * s) + bell(s, 5, width)}, (0,), (0,), [0, 10], tol=1e-6)
    shift = math.sqrt(math.pi) * width / 0.3  # x(10) = 10 sin(3)/0.6, and what the pulse adds
    exact = 10 * math.sin(3) / 0.6 + shift * math.sin(1.5) * math.exp(-((0.15 * width) ** 2))
    assert abs(run.q[-1, 0] - exact) <= run.error * np.abs(run.q).max()
    assert shift * math.sin(1.5) > 1e3 * run.error  # what it adds would be seen
    assert run.evaluations < 2_500  # 13,489 with short steps all the way


def test_the_time_of_a_drive_is_not_added_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Far from zero a clock that is added up step by step is off by the rounding of all steps, alike in both runs: by 2·10⁻¹¹ s
    here. Of exp(16 cos 44 t) = Σ I_n(16) cos 44 n t the motion is known term by term."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    system = System(ANGLE, v**2 / 2 - (40 * x) ** 2 / 2, forces=(sp.exp(16 * (sp.cos(44 * t) - 1)),))
    times = np.linspace(71, 73.8, 3)
    with mpmath.workdps(30):
        terms = [((1 + (n > 0)) * mpmath.besseli(n, 16) * mpmath.exp(-16), 44 * n) for n in range(60)]

        def forced(s: float) -> tuple[mpmath.mpf, mpmath.mpf]:
            parts = [(a / (40**2 - w**2), w, w * mpmath.mpf(s)) for a, w in terms]
            return sum(b * mpmath.cos(p) for b, _, p in parts), -sum(b * w * mpmath.sin(p) for b, w, p in parts)

        (a, b), rows = forced(71), []
        for s in map(float, times):
            (f, g), p = forced(s), 40 * (mpmath.mpf(s) - 71)
            c, d = mpmath.cos(p), mpmath.sin(p)
            rows.append([f - a * c - b / 40 * d, g + 40 * a * d - b * c])

    def off() -> float:
        run = system.simulate({}, (0,), (0,), times, tol=1e-10)
        return float(run.scales.distance(np.hstack([run.q, run.v]), np.array(rows, float)).max())

    assert (exact := off()) < 1e-10
    monkeypatch.setattr(programs.Generated, "rate", lambda program, parameters, _: program.rhs(*parameters))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        assert off() > 5 * max(exact, 1e-12)  # twin


def test_a_function_of_time_that_ends_before_the_run_does_ends_it_in_words() -> None:
    """It is looked at over the whole run; the pulse before its end is not passed over."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    system = System(ANGLE, v**2 / 2 - x**2 / 2, forces=(sp.Function("F")(t),))
    with pytest.warns(LagrotorWarning, match="ended early"):
        run = system.simulate(
            {"F": lambda s: math.sqrt(8 - s) * 0 + bell(s, 5.1, 0.02)}, (0,), (0,), np.linspace(0, 10, 51)
        )
    assert run.t[-1] <= 8 and run.q[-1, 0] == pytest.approx(
        math.sqrt(math.pi) * 0.02 * math.sin(run.t[-1] - 5.1), rel=1e-3
    )
