"""Dry friction: stick and slip of textbook systems, against their closed solutions."""

import warnings

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from lagrotor.errors import InputError, LagrotorWarning
from lagrotor.mechanics import (
    Event,
    Frame,
    System,
    constrained_accelerations,
    coordinates,
    reaction,
    total_derivative,
)

C = coordinates("x")
(x,), (v,) = C.q, C.v
F, k, g, mu, angle, belt = sp.symbols("F k g mu alpha u", positive=True)


@settings(max_examples=10, deadline=None)
@given(st.floats(0.02, 0.3), st.floats(0.5, 2.5))
def test_an_oscillator_loses_twice_the_same_length_each_half_cycle_and_stops(friction: float, start: float) -> None:
    """x'' + x = −F sign(x'): each half turn ends 2 F nearer, on the other side; at rest where |x| ≤ F."""
    times = np.pi * np.arange(0, 70)  # 2.5 is 62 times twice the least friction
    run = System(C, v**2 / 2 - x**2 / 2, forces=(-F * sp.sign(v),)).simulate({F: friction}, (start,), (0,), times, 1e-9)
    place, places = start, []
    for _ in times:
        places.append(place)
        if abs(place) > friction:
            place = -np.sign(place) * (abs(place) - 2 * friction)
    assert run.q[:, 0] == pytest.approx(places, abs=1e-7)
    assert abs(run.v[-1, 0]) < 1e-10
    # The force that holds it is that of the spring.
    assert run.evaluate(-F * sp.sign(v))[-1] == pytest.approx(places[-1], abs=1e-7)


def test_sticking_in_two_directions_is_refused_and_the_way_out_creeps_as_said() -> None:
    """On the floor and on a belt; with v_0 under the root the load f = 0.6 F creeps at 0.6/0.8 v_0."""
    plane, small = coordinates("x y"), sp.Symbol("v_0", positive=True)
    a, b = plane.v
    for moving in (sp.S.Zero, belt):
        base = (a - moving) ** 2 + b**2
        made = [
            System(plane, (a**2 + b**2) / 2, dissipation=F * sp.sqrt(e), forces=(0.6 * F, 0))
            for e in (base, base + small**2)
        ]
        values = {F: 1} | ({belt: 0.1} if moving else {})
        with pytest.raises(InputError, match=r"several directions.*v_0\*\*2.*creeps at v_0 f/sqrt"):
            made[0].simulate(values, (0, 0), (0.1, 0.1), (0, 1))
        run = made[1].simulate(values | {small: 1e-2}, (0, 0), (0.1, 0.1), (0, 1), 1e-8)
        creep = np.subtract(run.v[-1], (values.get(belt, 0), 0))
        np.testing.assert_allclose(creep, (0.0075, 0), atol=1e-7)


def test_friction_that_vanishes_with_the_speed_of_sliding_runs_on_a_belt_and_a_ball_that_may_stick_is_refused() -> None:
    """μ tanh(s/v_0) against the motion needs no v_0 under the root; four velocities have s = 0 where two combinations have."""
    plane, small = coordinates("x y"), sp.Symbol("v_0", positive=True)
    (a, b), kinetic = plane.v, sum(v**2 for v in plane.v) / 2
    s = sp.sqrt((a - belt) ** 2 + b**2)
    push = tuple(-F * sp.tanh(s / small) * w / s for w in (a - belt, b))
    run = System(plane, kinetic, forces=push).simulate({F: 0.5, belt: 0.3, small: 0.1}, (0, 0), (1, 0.5), (0, 5))
    np.testing.assert_allclose(run.v[-1], (0.3, 0), atol=1e-7)
    ball = coordinates("x y a b")
    s = sp.sqrt((ball.v[0] - belt + k * ball.v[3]) ** 2 + (ball.v[1] - k * ball.v[2]) ** 2)
    rolling = System(ball, sum(v**2 for v in ball.v) / 2, dissipation=F * s)
    with pytest.raises(InputError, match="several directions"):
        rolling.simulate({F: 1, belt: 0.1, k: 0.2}, (0,) * 4, (1, 0.5, 0, 0), (0, 1))


def test_a_mass_on_a_belt_sticks_and_slips_in_a_limit_cycle() -> None:
    """Friction that falls as soon as it slides, from 1 to 1/2; the mass sticks until the spring pulls as much."""
    w = v - belt
    sliding = sp.Rational(1, 2) + sp.Rational(1, 2) / (1 + 50 * sp.Abs(w))
    run = System(C, v**2 / 2 - x**2 / 2, forces=(-sliding * sp.sign(w),)).simulate(
        {belt: 0.1}, (0,), (0,), np.linspace(0, 80, 1601), 1e-8
    )
    sticking = np.abs(run.v[:, 0] - 0.1) < 1e-9
    assert 0.2 < sticking[800:].mean() < 0.9
    leaving = run.q[:-1, 0][sticking[:-1] & ~sticking[1:]]
    assert leaving == pytest.approx(1, abs=0.1 * 80 / 1600)  # of the last sample before
    assert run.error < 1e-7
    # The cycle repeats itself: crossings of x = 0.9 while it is carried along are equally far apart.
    carried = run.crossings(x - sp.Rational(9, 10), 1).t
    assert np.ptp(np.diff(carried)[1:]) < 1e-6


def test_a_force_that_does_not_jump_is_run_through() -> None:
    """Quadratic drag −k v |v|: v = v_0/(1 + k v_0 t), and a start at rest stays at rest."""
    drag = System(C, v**2 / 2, forces=(-k * v * sp.Abs(v),))
    run = drag.simulate({k: 0.5}, (0,), (2,), np.linspace(0, 9, 10), 1e-10)
    assert run.v[:, 0] == pytest.approx(2 / (1 + run.t), abs=1e-9)
    assert (drag.simulate({k: 0.5}, (0,), (0,), (0, 1.0)).q == 0).all()


def test_a_force_that_holds_but_is_no_friction_ends_the_run_in_words_and_at_once() -> None:
    """Two forces that push across one another's velocity: their sliding motion is outside what is followed."""
    c = coordinates("a b")
    system = System(c, (c.v[0] ** 2 + c.v[1] ** 2) / 2, forces=(-sp.sign(c.v[0]), -sp.sign(c.v[0])))
    with pytest.warns(LagrotorWarning, match="not dry friction"):
        run = system.simulate({}, (0, 0), (1, 0), np.linspace(0, 5, 11))
    assert run.t[-1] == pytest.approx(1, abs=1e-6) and run.evaluations < 5_000


def integrated(slope, start: tuple[float, ...], times: np.ndarray, turning: int) -> np.ndarray:
    """y' = slope(t, y) by another solver, up to where component `turning` is zero, after which it stays."""
    ends = lambda _, y: y[turning]  # noqa: E731
    ends.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(slope, (times[0], times[-1]), start, events=ends, rtol=1e-11, atol=1e-13, dense_output=True)
    return run.sol(np.minimum(times, run.t[-1]))


def test_a_bead_rubs_on_a_hoop_by_what_presses_it() -> None:
    """m R θ'' = −m g sin θ − μ |N| sign θ', N = m (R θ'² + g cos θ): it is pressed outward and inward, and stays where it stops,
    at tan θ < μ."""
    c, N, m, R = coordinates("x z"), reaction("hoop"), *sp.symbols("m R", positive=True)
    (a, z), (va, vz) = c.q, c.v
    L = m * (va**2 + vz**2) / 2 - m * g * z
    along = (a * vz - z * va) / R
    bead = System(c, L, {"hoop": (R**2 - a**2 - z**2) / (2 * R)}, dissipation=mu * abs(N) * abs(along))
    for rough, speed, last in ((0.1, 6.5, 0.6), (0.9, 2.5, 2.0)):
        times = np.linspace(0, last, 13)
        run = bead.simulate({m: 1.7, g: 9.81, R: 1, mu: rough}, (0, -1), (speed, 0), times)

        def slope(_: float, y: np.ndarray, rough: float = rough) -> list[float]:
            return [y[1], -9.81 * np.sin(y[0]) - rough * abs(y[1] ** 2 + 9.81 * np.cos(y[0])) * np.sign(y[1])]

        angle, rate = integrated(slope, (0, speed), times, 1)
        np.testing.assert_allclose(run.q[:, 0], np.sin(angle), atol=1e-7)
        np.testing.assert_allclose(run.evaluate(N), 1.7 * (rate**2 + 9.81 * np.cos(angle)), atol=1e-6)
        assert (run.evaluate(N).min() < 0) == (rough < 0.5) and (abs(rate[-1]) < 1e-9) == (rough > 0.5)
    assert np.tan(angle[-1]) < 0.9
    inward = System(c, L, bead.constraints, names=("hoop",), dissipation=mu * N * abs(along))
    with pytest.warns(LagrotorWarning, match="becomes negative: the rubbing contact would pull"):
        inward.simulate({m: 1.7, g: 9.81, R: 1, mu: 0.1}, (0, -1), (5.5, 0), times)


def test_a_reaction_ends_a_run() -> None:
    """A mass slides from the top of a dome with the speed v: it leaves where cos θ = 2/3 + v²/(3 g R)."""
    c, m, R = coordinates("x z"), *sp.symbols("m R", positive=True)
    L = m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - m * g * c.q[1]
    dome = System(c, L, {"dome": c.q[0] ** 2 + c.q[1] ** 2 - R**2})
    for section in (dome.multipliers[0], reaction("dome")):
        run = dome.simulate({m: 2, g: 9.81, R: 1}, (0, 1), (0.5, 0), (0, 3), events=Event(section))
        assert run.ending.kind == "event"
        assert run.q[-1, 1] == pytest.approx(2 / 3 + 0.25 / 3 / 9.81, abs=1e-8)


def test_a_bowled_ball_slides_and_then_rolls_with_five_sevenths_of_its_speed() -> None:
    """From t = 2 v/(7 μ g) on its lowest point is at rest."""
    c, m, R = coordinates("x y theta"), *sp.symbols("m R", positive=True)
    body = Frame(c).planar(*c.q).body(m, (0, 0, 2 * m * R**2 / 5))
    slip = c.v[0] + R * c.v[2]
    rubs = mu * reaction("floor") * abs(slip)
    ball = System(c, body.kinetic - body.potential((0, -g, 0)), {"floor": c.q[1] - R}, dissipation=rubs)
    run = ball.simulate({m: 2, R: 0.1, g: 9.81, mu: 0.2}, (0, 0.1, 0), (7, 0, 0), (0, 3))
    slides = 2 * 7 / (7 * 0.2 * 9.81)
    assert run.v[-1] == pytest.approx((5, 0, -50), abs=1e-8)
    assert run.q[-1, 0] == pytest.approx(7 * slides - 0.2 * 9.81 * slides**2 / 2 + 5 * (3 - slides), abs=1e-8)


def test_a_ladder_slides_with_friction_at_both_ends() -> None:
    """Newton's and Euler's equations solved at each step for θ'' and both reactions."""
    c, m, l = coordinates("x y theta"), *sp.symbols("m l", positive=True)
    (a, b, th), N = c.q, [reaction("floor"), reaction("wall")]
    foot, top = b - l * sp.sin(th) / 2, a - l * sp.cos(th) / 2
    slides = total_derivative(a + l * sp.cos(th) / 2, c), total_derivative(b + l * sp.sin(th) / 2, c)
    L = m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 + m * l**2 * c.v[2] ** 2 / 24 - m * g * b
    rubs = mu * sum((n * sp.Abs(v) for n, v in zip(N, slides, strict=True)), sp.S.Zero)
    ladder = System(c, L, {"floor": foot, "wall": top}, dissipation=rubs)
    values, times = {m: 1, g: 9.81, l: 1, mu: 0.2}, np.linspace(0, 0.5, 6)
    q0, v0 = ladder.consistent(values, (0.5 * np.cos(1.1), 0.5 * np.sin(1.1), 1.1), (0, 0, -0.01))
    run = ladder.simulate(values, q0, v0, times)

    def solved(th: float, w: float) -> np.ndarray:
        s, k = np.sin(th) / 2, np.cos(th) / 2
        rows = [[-s, 0.2, -1], [k, -1, -0.2], [-1 / 12, -k + 0.2 * s, 0.2 * k + s]]
        return np.linalg.solve(rows, [k * w * w, s * w * w - 9.81, 0])

    twin = integrated(lambda _, y: [y[1], solved(*y)[0]], (1.1, v0[2]), times, 1)
    np.testing.assert_allclose(run.q[:, 2], twin[0], atol=1e-8)
    forces = np.array([solved(*y)[1:] for y in twin.T])
    np.testing.assert_allclose(np.array([*run.reactions.values()]).T, forces, atol=1e-6)
    assert run.evaluate(N[0]) == pytest.approx(run.reactions["floor"])


def test_friction_by_a_reaction_in_a_tree_and_in_velocities_of_ones_own() -> None:
    """m v' = −μ m g v, v = 1 at first; a reaction enters linearly, of a constraint that is there and left."""
    c, N, u = coordinates("x y"), reaction("floor"), sp.Symbol("u", real=True)
    body = Frame(c).moved(*c.q).body(2)
    L, floor = body.kinetic - body.potential((0, -g, 0)), {"floor": c.q[1]}
    values, rubs = {g: 9.81, mu: 0.1}, mu * N * c.v[0] ** 2 / 2
    own = {u: 2 * c.v[0], c.v[1]: c.v[1]}
    for system, v0 in (
        (System(c, L, floor, dissipation=rubs), (1, 0)),
        (System(c, L, floor, dissipation=mu * N * u**2 / 8, velocities=own), (2, 0)),
        (System(c, sp.sympify(L), (c.q[1],), forces=(-mu * reaction(1) * c.v[0], 0)), (1, 0)),
    ):
        run = system.simulate(values, (0, 0), v0, (0, 1))
        assert run.v[-1, 0] == pytest.approx(np.exp(-0.981), abs=1e-8)
        assert min(system.linearise({"x": 0, "y": 0}, values).rates.real) == pytest.approx(-0.981)
    accelerations, _ = constrained_accelerations(System(c, sp.sympify(L), floor, dissipation=rubs))
    assert sp.simplify(accelerations[0] + mu * g * c.v[0]) == 0
    for make, words in (
        (lambda: System(c, L, floor, dissipation=mu * reaction("flor") * abs(c.v[0])), "names no constraint"),
        (lambda: System(c, sp.sympify(L) - N, floor), "may stand in forces and dissipation alone"),
        (lambda: System(c, L, floor, forces=(-mu * N**2, 0)).rhs(values), "must enter linearly"),
        (
            lambda: System(c, L, floor, dissipation=rubs, velocities={u: c.v[0]}).rhs(values),
            "leave these velocities out",
        ),
    ):
        with pytest.raises(InputError, match=words):
            make()


def test_rounding_where_a_mass_is_let_go_hides_no_event() -> None:
    """A slow belt, in seconds: its speed is 10⁻¹² of a unit, and that of sliding begins at zero, below its rounding."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", LagrotorWarning)
        run = System(C, v**2 / 2 - k * x**2 / 2, forces=(-F * sp.sign(v - belt),)).simulate(
            {k: 1e-12, F: 3e-13, belt: 5e-7}, (1.2,), (0,), np.linspace(0, 5e7, 5), 3e-11
        )
    assert run.error < 3e-11
