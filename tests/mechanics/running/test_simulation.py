"""Runs of any system: closed solutions, independent integrations, conserved quantities, refusals."""

import importlib.util
import math
import warnings
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import simpson, solve_ivp
from scipy.special import ellipj, ellipk

from lagrotor.errors import ConstraintError, InputError, IntegrationError, LagrotorWarning
from lagrotor.mechanics import System, SystemRun, coordinates, t
from lagrotor.mechanics.running import programs, simulation
from lagrotor.mechanics.running.initial_state import rounding_of_start
from tests.systems import Omega, R, double_pendulum, g, henon_heiles, k, l, m, pendulum, values_of
from tests.systems import rod_pendulum as rod

w, A = sp.symbols("omega A", positive=True)
VALUES = {m: 1.3, l: 0.8, g: 9.81, k: 0.2, R: 0.5, Omega: 6.0, w: 20.0, A: 0.1}
ANGLE, PLANE = coordinates("theta"), coordinates("x y")


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


@pytest.mark.parametrize("name", ["bare", "s", "c_0", "y0_", "_0", "lambda", "pi"])
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


@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_how_far_off_the_constraints_a_start_may_be_goes_by_the_size_of_the_motion(size: float) -> None:
    values, times = {m: 1.0, g: 9.81, l: size}, [0, size**0.5]
    with pytest.raises(
        ConstraintError, match=r"off the constraints.*nearest state on them is q0 = \(1(e-06|000000), 0\), v0"
    ):
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


@pytest.mark.parametrize("size", [1e-6, 1.0])
def test_a_place_that_is_rounding_has_the_size_of_the_others(size: float) -> None:
    """A pendulum that hangs at rest at x = sin(π) l: in units of 10⁻¹⁶ l a run has no end."""
    values, times = {m: 1.0, g: 9.81, l: size}, [0, size**0.5]
    run = rod().simulate(values, (np.sin(np.pi) * size, -size), (0, 0), times)
    assert run.scales.sizes[:2] == pytest.approx([size, size]) and run.evaluations < 1000
    assert run.q[-1] == pytest.approx([0, -size], abs=1e-14 * size)
    swing = rod().simulate(values, (1e-9 * size, -size), (0, 0), times)  # twin: a motion of its own
    assert swing.scales.sizes[0] < 1e-8 * size


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


def test_dense_output_is_as_exact_as_the_run(engine: str) -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), np.linspace(0, 6, 4), 1e-11, engine)
    times = np.array([0.0, 0.3, 1.9999, 2.0, 4.7, 6.0])
    assert np.abs(run.at(times).q[:, 0] - elliptic(times, 2.5)).max() < 1e-9
    with pytest.raises(InputError, match="between 0 and 6 s"):
        run.at([6.1])


def test_without_velocities_a_start_is_at_rest() -> None:
    system, times = double_pendulum(), [0.0, 0.5]
    resting = system.simulate(VALUES, {"alpha": 1, "beta": 2}, t=times)
    assert (resting.states == system.simulate(VALUES, (1, 2), (0, 0), times).states).all()
    q, v = rod().consistent(VALUES, (0.5, -0.5))
    assert np.hypot(*q) == pytest.approx(0.8) and (v == 0).all()


def test_expressions_are_evaluated_along_a_run() -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), np.linspace(0, 6, 31), 1e-11)
    height = run.evaluate(l * (1 - sp.cos(ANGLE.q[0])))
    assert height == pytest.approx(0.8 * (1 - np.cos(run.q[:, 0])))
    assert run.evaluate(sp.S.One).shape == (31,)
    assert run.evaluate("theta_dot") == pytest.approx(run.v[:, 0])
    with pytest.raises(InputError, match="unheard without a value"):
        run.evaluate(sp.Symbol("unheard"))


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
    assert run.crossings(c.q[0] - 2).q.shape == (0, 1)


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
    assert header[0] == "t [s],x,y,x_dot,y_dot,energy [J],drift" and len(header) == 12
    frame = run.to_dataframe() if importlib.util.find_spec("pandas") else None
    assert frame is None or list(frame.columns) == ["x", "y", "x_dot", "y_dot", "energy", "drift"]


def test_a_poincare_section_of_henon_and_heiles_lies_on_the_energy_surface() -> None:
    run = henon_heiles().simulate({}, (0, 0.1), (0.45, 0.1), np.linspace(0, 100, 1001), 1e-10)
    x, (y, y_v) = PLANE.q[0], (PLANE.q[1], PLANE.v[1])
    there = run.crossings(x, 1)
    height, rate = there.evaluate(y), there.evaluate(y_v)
    assert len(height) > 10
    kinetic = run.energy[0] - (height**2 / 2 - height**3 / 3) - rate**2 / 2
    assert (kinetic > 0).all()
    assert there.v[:, 0] ** 2 / 2 == pytest.approx(kinetic, abs=1e-8)


@pytest.mark.slow
def test_the_lyapunov_exponent_tells_chaos_from_order_and_is_that_of_two_neighbours() -> None:
    """A double pendulum; the oracle is the growth of the distance of two runs, renormalised by hand."""
    double, times = double_pendulum(), np.linspace(0, 200, 401)
    values = dict.fromkeys(values_of(double), 1.0)
    chaotic = double.simulate(values, (2, 2.5), (0, 0), times, 1e-9).lyapunov()
    calm = double.simulate(values, (0.1, 0.1), (0, 0), times, 1e-9).lyapunov()
    assert chaotic.exponent > 5 * chaotic.error > 0 and abs(calm.exponent) < 0.05
    apart, y, other, growth = 1e-7, np.array([2, 2.5, 0, 0]), np.array([2, 2.5, 1e-7, 0]), 0.0
    for _ in range(200):
        ends = [double.simulate(values, s[:2], s[2:], [0, 1.0], 1e-11) for s in (y, other)]
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


def test_a_neighbour_that_cannot_go_on_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    run = pendulum().simulate(VALUES, (2.5,), (0,), (0, 10), 1e-9)
    monkeypatch.setattr("lagrotor.mechanics.running.monodromy.MOST", 2000)
    with pytest.raises(IntegrationError):
        run.lyapunov()


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


@pytest.mark.parametrize(("power", "near", "n"), [(sp.Rational(3, 2), 2e-4, 2), (3, 1e-3, 300)])
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


def test_a_run_is_drawn_and_filmed(tmp_path: Path) -> None:
    run = rod().simulate(VALUES, (0.8, 0), (0, 0), np.linspace(0, 0.4, 11), 1e-9)
    figure = run.plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["$x$", "$y$", "E − E(0) (J)", "largest |g|"]
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_ydata(), run.q[:, 0])
    from PIL import Image

    film = run.animate(tmp_path / "rod.gif", lines=[[(0, 0, 0), (PLANE.q[0], 0, PLANE.q[1])]])
    with Image.open(film) as image:
        assert image.n_frames > 5
    with pytest.raises(InputError, match=r"give lines="):
        run.animate(tmp_path / "none.gif")


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


@pytest.mark.parametrize("unit", [1.0, 1e-5])
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


@pytest.mark.parametrize("times", [(0, 10, 20.0), np.linspace(0, 4, 21)])
def test_a_row_that_turns_round_is_not_taken_for_dependent_ones(times: object) -> None:
    """A sleigh on its blade, its centre of mass over it, goes round in circles: up to 11 turns between two samples."""
    (_, _, h), v = (c := coordinates("x y theta")).q, c.v
    sleigh = System(c, (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2, rolling=(-sp.sin(h) * v[0] + sp.cos(h) * v[1],))
    with warnings.catch_warnings():
        warnings.simplefilter("error", LagrotorWarning)
        run = sleigh.simulate({}, (0, 0, 0), (1, 0, 7), times, 1e-6)
    assert run.q[:, 0] == pytest.approx(np.sin(7 * run.t) / 7, abs=1e-5)


def test_every_evaluation_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the survey, of a companion that was given up, and of `at`."""
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
    stiff = System(c, v**2 / 2 - x**2 / 2, forces=(-k * v,))
    for damping in (1, 1e3):
        calls = 0
        run = stiff.simulate({k: damping}, (1,), (0,), [0, 10], 1e-4)
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


def test_a_pulse_in_a_function_that_never_rests_is_not_passed_over() -> None:
    """cos 0.3 t and a pulse in one function, on a slow body at rest; its steps are long but where the pulse is."""
    ((x,), (v,)), width = (ANGLE.q, ANGLE.v), 0.001
    system = System(ANGLE, v**2 / 2 - (0.3 * x) ** 2 / 2, forces=(sp.Function("F")(t),))
    run = system.simulate({"F": lambda s: np.cos(0.3 * s) + bell(s, 5, width)}, (0,), (0,), [0, 10], tol=1e-6)
    shift = math.sqrt(math.pi) * width / 0.3  # x(10) = 10 sin(3)/0.6, and what the pulse adds
    exact = 10 * math.sin(3) / 0.6 + shift * math.sin(1.5) * math.exp(-((0.15 * width) ** 2))
    assert abs(run.q[-1, 0] - exact) <= run.error * np.abs(run.q).max()
    assert shift * math.sin(1.5) > 1e3 * run.error  # what it adds would be seen
    assert run.evaluations < 2_500  # 13,489 with short steps all the way


def test_the_time_of_a_drive_is_not_added_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock that is added up step by step is off by the rounding of all steps, alike in both runs; t − 1024 is exact."""
    (x,), (v,) = ANGLE.q, ANGLE.v
    p = sp.Symbol("p", real=True)
    system = System(ANGLE, v**2 / 2 - (40 * x) ** 2 / 2, forces=(sp.exp(16 * (sp.cos(44 * (t - p)) - 1)),))

    def off() -> float:
        runs = [system.simulate({p: at}, (0,), (0,), at + np.linspace(0, 4, 3), tol=1e-10) for at in (0.0, 1024.0)]
        return float(runs[0].scales.distance(*(np.hstack([run.q, run.v]) for run in runs)).max())

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        exact = off()
        monkeypatch.setattr(programs.Generated, "rate", lambda program, parameters, _: program.rhs(*parameters))
        assert exact < 1e-10 and off() > 5 * max(exact, 1e-12)  # twin


def test_a_function_of_time_that_ends_before_the_run_does_is_refused_and_one_without_a_number_ends_it() -> None:
    (x,), (v,) = ANGLE.q, ANGLE.v
    system = System(ANGLE, v**2 / 2 - x**2 / 2, forces=(sp.Function("F")(t),))
    with pytest.raises(InputError, match=r"fails at a time between t = 0 and 10 s \(math domain error\)"):
        system.simulate({"F": lambda s: math.sqrt(8 - s)}, (0,), (0,), [0, 10])
    force = {"F": lambda s: bell(s, 5.1, 0.02) if s < 8 else math.nan}
    with pytest.warns(LagrotorWarning, match="ended early"):
        run = system.simulate(force, (0,), (0,), np.linspace(0, 10, 51))
    pulse = math.sqrt(math.pi) * 0.02 * math.sin(run.t[-1] - 5.1)
    assert run.t[-1] <= 8 and run.q[-1, 0] == pytest.approx(pulse, rel=1e-3)
