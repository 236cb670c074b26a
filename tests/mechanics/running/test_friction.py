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
    Impact,
    Plane,
    System,
    constrained_accelerations,
    coordinates,
    reaction,
    t,
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


PLANE = coordinates("x y")
A, B = PLANE.v
SLIDING = (A**2 + B**2) / 2


# The sliding speed of the friction F = 2 on v = (3, 4), and the place and time of rest: v²/(2 F) ahead after v/F.
RESTS = {
    "floor": (sp.sqrt(A**2 + B**2), (3.75, 5), 2.5),
    "expanded": (sp.sqrt(A**2 + A * B + B**2 - A * B), (3.75, 5), 2.5),
    "belt": (sp.sqrt((A - 3) ** 2 + B**2), (6, 4), 2.0),
    "two coordinates of one velocity": (sp.sqrt((A - B) ** 2 + 3 * (A + B) ** 2) / 2, None, None),
}


@pytest.mark.filterwarnings("error::lagrotor.errors.LagrotorWarning")
@pytest.mark.parametrize("case", RESTS)
def test_friction_in_a_plane_brings_a_body_to_rest(case: str) -> None:
    speed, place, after = RESTS[case]
    run = System(PLANE, SLIDING, dissipation=F * speed).simulate({F: 2}, (0, 0), (3, 4), np.linspace(0, 8, 17), 1e-10)
    assert run.error < 1e-10 and run.ending.kind == "end"
    if place is None:  # compared with the same motion of smooth equations, up to the stop
        form = np.array([[1, 0.5], [0.5, 1]])
        slope = lambda _, y: [*y[2:], *(-2 * form @ y[2:] / np.sqrt(y[2:] @ form @ y[2:]))]  # noqa: E731
        twin = integrated(slope, (0, 0, 3, 4), np.linspace(0, 1, 3), 2)
        assert run.q[2] == pytest.approx(twin[:2, -1], abs=1e-8) and (run.v[-1] == 0).all()
        return
    carried = 3.0 * (case == "belt")
    sliding, stopped = run.t < after - 1e-9, run.t > after + 1e-9
    np.testing.assert_allclose(
        run.q[stopped] - carried * (run.t[stopped, None] - after) * (1, 0), (place,) * stopped.sum()
    )
    np.testing.assert_allclose(run.v[stopped], ((carried, 0),) * stopped.sum(), atol=1e-12)
    assert run.evaluate(B / speed)[sliding] == pytest.approx(4 / (5 if not carried else 4))
    assert run.evaluate(B / speed)[stopped] == pytest.approx(0, abs=1e-12)


def test_a_load_that_grows_is_held_up_to_the_cone_and_then_slides() -> None:
    """Held until (t, 0.6) has the size of the bound, 1, at t = 0.8; then by LSODA from a speed of 10⁻¹⁰. With v_0 under the
    root the body creeps before, and afterwards is as far away as v_0."""
    small, times = sp.Symbol("v_0", positive=True), np.linspace(0, 2, 9)
    load, D = (t, sp.Rational(3, 5)), F * sp.sqrt(A**2 + B**2)
    run = System(PLANE, SLIDING, dissipation=D, forces=load).simulate({F: 1}, (0, 0), (0, 0), times)
    held = times < 0.8
    assert (run.q[held] == 0).all() and run.error < 1e-9
    np.testing.assert_allclose(run.evaluate(-F * A / sp.sqrt(A**2 + B**2))[held], -times[held], atol=1e-12)
    twin = solve_ivp(
        lambda s, y: [*y[2:], *(np.array([s, 0.6]) - y[2:] / np.hypot(*y[2:]))],
        (0.8, 2), (0, 0, 0.8e-10, 0.6e-10), "LSODA", rtol=1e-11, atol=1e-12,
    ).y[:, -1]  # fmt: skip
    np.testing.assert_allclose([*run.q[-1], *run.v[-1]], twin, atol=2e-9)
    near = System(PLANE, SLIDING, dissipation=F * sp.sqrt(A**2 + B**2 + small**2), forces=load)
    smooth = [near.simulate({F: 1, small: v_0}, (0, 0), (0, 0), times, 1e-6).q for v_0 in (1e-2, 1e-3)]
    far, close = (np.abs(q - run.q).max() for q in smooth)
    assert 1e-5 < close < far / 4


def test_friction_in_a_plane_may_be_given_as_forces() -> None:
    push = tuple(-v / sp.sqrt(A**2 + B**2) for v in (A, B))
    run = System(PLANE, SLIDING, forces=push).simulate({}, (0, 0), (3, 4), (0, 5, 6))
    np.testing.assert_allclose(run.q[1:], [(7.5, 10)] * 2, atol=1e-8)
    assert (run.v[2] == 0).all()


def test_the_cone_of_a_form_with_mixed_terms() -> None:
    """Q = a² + a b + b²: a load (t, 0) is held while its size by the inverse form, 2 t/√3, is at most the bound."""
    system = System(PLANE, SLIDING, dissipation=F * sp.sqrt(A**2 + A * B + B**2), forces=(t, 0))
    run = system.simulate({F: 1}, (0, 0), (0, 0), (0, np.sqrt(3) / 2 - 1e-6, np.sqrt(3) / 2 + 0.01, 2), 1e-8)
    assert np.abs(run.v[1]).max() < 1e-12 and run.v[2, 0] > 1e-5 and run.error < 1e-8


def test_a_load_that_turns_never_lets_a_body_stick() -> None:
    """Three times the bound; by DOP853 of scipy, as the force is smooth where it slides. A bound of 4 holds it."""
    load = (3 * sp.cos(t), 3 * sp.sin(t))
    system, times = System(PLANE, SLIDING, dissipation=F * sp.sqrt(A**2 + B**2), forces=load), np.linspace(0, 9, 4)
    run = system.simulate({F: 1}, (0, 0), (1, 0), times)
    force = lambda s, v: 3 * np.array([np.cos(s), np.sin(s)]) - v / np.hypot(*v)  # noqa: E731
    twin = solve_ivp(
        lambda s, y: [*y[2:], *force(s, y[2:])], (0, 9), (0, 0, 1, 0), "DOP853", times, rtol=1e-12, atol=1e-12
    )
    np.testing.assert_allclose(run.q, twin.y[:2].T, atol=1e-7)
    held = system.simulate({F: 4}, (0, 0), (1, 0), times)
    assert (held.v[1:] == 0).all()


@pytest.mark.filterwarnings("error::lagrotor.errors.LagrotorWarning")
def test_a_block_leaves_its_place_on_a_turntable_where_its_acceleration_is_that_of_friction() -> None:
    """Ω = t/5, r = 1: (1/5)² + Ω⁴ = (μ g)² at t = 5 √(μ g)(1 − …), with the normal force a reaction."""
    c, m = coordinates("x y z"), sp.Symbol("m", positive=True)
    (x, y, z), (a, b, d), Om = c.q, c.v, t / 5
    slip = sp.sqrt((a + Om * y) ** 2 + (b - Om * x) ** 2)
    L = m * (a**2 + b**2 + d**2) / 2 - m * g * z
    system = System(c, L, {"floor": z}, dissipation=mu * reaction("floor") * slip)
    leaves = 5 * ((0.2 * 10) ** 2 - 1 / 25) ** 0.25
    run = system.simulate({m: 2, g: 10, mu: 0.2}, (1, 0, 0), (0, 0, 0), [0, leaves - 0.1, leaves + 0.5, 8], 1e-8)
    angle = run.t**2 / 10
    np.testing.assert_allclose(run.q[1, :2], (np.cos(angle[1]), np.sin(angle[1])), atol=1e-8)
    behind = run.q[:, 1] * np.cos(angle) - run.q[:, 0] * np.sin(angle)
    assert behind[2] < -1e-4 and np.hypot(*run.q[3, :2]) > 1.05


def test_friction_that_vanishes_with_the_speed_of_sliding_runs_on_a_belt_and_a_ball_comes_to_roll() -> None:
    """μ tanh(s/v_0) against the motion needs no v_0. A ball whose lowest point slides with v − R ω rolls with (5 v + 2 R ω)/7."""
    plane, small = coordinates("x y"), sp.Symbol("v_0", positive=True)
    (a, b), kinetic = plane.v, sum(v**2 for v in plane.v) / 2
    s = sp.sqrt((a - belt) ** 2 + b**2)
    push = tuple(-F * sp.tanh(s / small) * w / s for w in (a - belt, b))
    run = System(plane, kinetic, forces=push).simulate({F: 0.5, belt: 0.3, small: 0.1}, (0, 0), (1, 0.5), (0, 5))
    np.testing.assert_allclose(run.v[-1], (0.3, 0), atol=1e-7)
    c, m, R = coordinates("x y a b"), *sp.symbols("m R", positive=True)
    (a, b, wa, wb), values = c.v, {m: 0.2, R: 0.03, g: 9.81, mu: 0.2}
    s = sp.sqrt((a - R * wb) ** 2 + (b + R * wa) ** 2)
    ball = System(c, m * (a**2 + b**2) / 2 + m * R**2 * (wa**2 + wb**2) / 5, dissipation=mu * m * g * s)
    run = ball.simulate(values, (0,) * 4, (2, 0, 40, -20), (0, 1.5, 3))
    np.testing.assert_allclose(run.v[1:, :2], ((8.8 / 7, -2.4 / 7),) * 2, atol=1e-9)
    assert run.evaluate(s).max() > 2.8 and abs(run.evaluate(s)[1:]).max() < 1e-12


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


s1 = sp.sign(A - B)
THREE = coordinates("a b d")
s2, s3 = sp.sign(THREE.v[0] - THREE.v[1]), sp.sign(THREE.v[1] - THREE.v[2])
SURFACE = sp.sign(x + v)
# Coordinates, forces, start and the velocities, or the place, at the last time; Filippov's convex combination by hand.
SLIDING_MODES = {
    "two velocities": (PLANE, (-2 * s1, -sp.Rational(3, 4) + 9 * s1 / 4), (0, 0), (1.5, 1), 1, (31 / 34, 31 / 34)),
    "across": (PLANE, (-sp.sign(A), -sp.sign(A)), (0, 0), (1, 0), 5, (0, -1)),
    "two surfaces": (THREE, (-2 * s2, s2 - s3 + 0.1, 2 * s3), (0,) * 3, (2, 0, -1), 3, (0.4, 0.4, 0.4)),
    "a controller": (C, (-SURFACE,), (-0.5,), (0.5,), 2, (0.5 * np.exp(-2),)),
}


@pytest.mark.parametrize("case", SLIDING_MODES)
def test_a_force_that_jumps_keeps_a_velocity_at_zero_by_a_value_between(case: str) -> None:
    """v₁' = −2 s, v₂' = −3/4 + 9/4 s: s = 3/17 where v₁ = v₂. The mean of both sides, s = 0, would be elsewhere."""
    c, forces, q0, v0, last, wanted = SLIDING_MODES[case]
    run = System(c, sum(w**2 for w in c.v) / 2, forces=forces).simulate({}, q0, v0, np.linspace(0, last, 5), 1e-10)
    np.testing.assert_allclose(run.v[-1], wanted, atol=1e-9)
    assert run.ending.kind == "end" and run.error < 1e-10
    if case == "two velocities":
        assert run.evaluate(s1)[1:] == pytest.approx(3 / 17) and np.abs(run.v[-1] - (1.5 - 2 / 7)).max() > 0.1


def test_a_force_that_holds_a_place_or_a_state_ends_the_run_in_words_and_at_once() -> None:
    charge = sp.Symbol("x", real=True)
    with pytest.warns(LagrotorWarning, match="stays on x = 0, which is not followed: it must be affine"):
        run = System(states={charge: sp.Rational(1, 2) - sp.sign(charge)}).simulate({}, t=(0, 5), x0=(1,))
    assert run.t[-1] == pytest.approx(2, abs=1e-6) and run.evaluations < 5_000


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


DISC, k_I = coordinates("x y theta"), sp.Symbol("k", positive=True)
FALLING = System(DISC, (DISC.v[0] ** 2 + DISC.v[1] ** 2 + k_I * DISC.v[2] ** 2) / 2 - 10 * DISC.q[1])


@pytest.mark.parametrize(("inertia", "share"), [(2 / 5, 5 / 7), (1 / 2, 2 / 3)], ids=["ball", "coin"])
@pytest.mark.parametrize("rough", [0.05, 0.6])
def test_what_bounces_with_friction_slides_and_rolls_at_last(inertia: float, share: float, rough: float) -> None:
    """The first impact takes μ (1 + e) v_n from the velocity, or, if the lowest point sticks, all but the share of rolling.
    Impacts accumulate at √(2 h/g) (1 + e)/(1 − e) = 3 √(1/5). Afterwards it rolls with that share, and loses no energy."""
    lands, normal = np.sqrt(1 / 5), np.sqrt(20)
    for friction in (rough, 0):
        floor = Impact(DISC.q[1] - 1, 0.5, friction, DISC.v[0] + DISC.v[2] if friction else ())
        times = [0, lands + 1e-6, 3 * lands + 0.1, 20]
        run = FALLING.simulate({k_I: inertia}, (0, 2, 0), (6, 0, 0), times, 1e-10, events=floor)
        assert "accumulate at t = 1.34164" in run.ending.reason and (np.diff(run.energy) < 1e-10).all()
        after = max(6 - friction * 1.5 * normal, 6 * share)
        assert run.v[1] == pytest.approx((after, normal / 2 - 1e-5, -(6 - after) / inertia), abs=1e-9)
        rolls = 6 * share if friction else 6
        assert run.v[-1] == pytest.approx((rolls, 0, -(6 - rolls) / inertia), abs=1e-9)
    assert run.evaluate(DISC.v[0] + DISC.v[2])[-1] == pytest.approx(6)  # without friction it slides for ever


def test_a_ball_falls_on_a_floor_in_space_and_rolls() -> None:
    """The contact gives both sliding velocities: five sevenths of (2, 1) at the end."""
    c, m, R = coordinates("x y z a b s"), *sp.symbols("m R", positive=True)
    ground = Frame(c)
    ball = ground.moved(*c.q[:3]).turned("xyz", c.q[3:]).body(m, (2 * m * R**2 / 5,) * 3)
    floor = Impact(ball.rolls_on(Plane(ground), R), sp.Rational(1, 2), friction=mu)
    system, values = System(c, ball.kinetic - ball.potential((0, 0, -g))), {m: 1, R: 0.1, g: 9.81, mu: 0.3}
    run = system.simulate(values, (0, 0, 0.3, 0, 0, 0), (2, 1, 0, 0, 0, 0), (0, 1, 1.5), 1e-7, events=floor)
    assert run.v[1:, :3] == pytest.approx(np.array(((10 / 7, 5 / 7, 0),) * 2), abs=1e-6)


def test_an_impact_that_would_raise_the_energy_ends_the_run_in_words() -> None:
    """A rod strikes with its lower end: Newton's restitution with friction (Kane & Levinson 1985). The same rod without friction
    loses 1 − e² of what it can."""
    (a, b, th), h = DISC.q, sp.Rational(1, 2)
    rod = System(DISC, FALLING.lagrangian.subs(k_I, sp.Rational(1, 12)))
    gap, slip = b - h * sp.sin(th), total_derivative(a - h * sp.cos(th), DISC)
    start = (0, 1, 1), (3, 0, 0), (0, 0.45)
    rows = np.array([[1, 0, np.sin(1) / 2], [0, 1, -np.cos(1) / 2]])  # of the end, which sticks
    D, falls = rows @ np.diag([1, 1, 12]) @ rows.T, np.sqrt(20 * (1 - np.sin(1) / 2))
    impulse = np.linalg.solve(D, (-3, 1.9 * falls))
    assert abs(impulse[0]) < 0.5 * impulse[1]
    gained = impulse @ ((3, -falls) + D @ impulse / 2)
    with pytest.warns(LagrotorWarning, match=f"raise the energy by {gained:.3g} J .*Kane's paradox"):
        run = rod.simulate({}, *start, events=Impact(gap, 0.9, friction=0.5, slip=slip))
    free = rod.simulate({}, *start, events=Impact(gap, 0.9))
    # With less friction the end slides back after the impact, and the impulse is along (μ, 1).
    slides = rod.simulate({}, *start[:2], (0, run.t[-1] + 1e-7), events=Impact(gap, 0.9, friction=0.1, slip=slip))
    push = np.array([0.1, 1]) * 1.9 * falls / (D[1, 1] + 0.1 * D[1, 0])
    assert 3 + (D @ push)[0] < 0
    assert slides.v[-1] == pytest.approx((3, -falls, 0) + np.diag([1, 1, 12]) @ rows.T @ push, abs=1e-5)
    assert run.t[-1] < 0.35 < free.t[-1] and free.energy[-1] < free.energy[0]


def test_contacts_that_hold_the_same_velocity_end_the_run_in_words() -> None:
    """A rod that clatters to rest on both ends, whose friction forces are not determined."""
    (a, b, th), h = DISC.q, sp.Rational(1, 2)
    rod = System(DISC, FALLING.lagrangian.subs(k_I, sp.Rational(1, 12)))
    ends = [(a + s * h * sp.cos(th), b + s * h * sp.sin(th)) for s in (-1, 1)]
    events = [Impact(up, 0.5, friction=0.2, slip=total_derivative(along, DISC)) for along, up in ends]
    with pytest.warns(LagrotorWarning, match="hold the same velocities, and their friction is not determined"):
        run = rod.simulate({}, (0, 1, 0.4), (1, 0, 0), np.linspace(0, 3, 31), 1e-7, events=events)
    assert np.abs(run.q[-1, 1:]).max() < 1e-9 and run.energy[-1] == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("height", [0, 1, 1000])
@pytest.mark.parametrize("rough", [0, 0.3])
def test_a_disc_let_go_on_an_incline_at_any_height_does_not_fall_through_it(height: float, rough: float) -> None:
    """The gap y − height starts at zero, where the rounding of y hides how it closes. Rolling takes a third of g sin α."""
    L = FALLING.lagrangian.subs({k_I: 0.5, DISC.q[1]: 0}) - 10 * np.cos(0.5) * DISC.q[1] + 10 * np.sin(0.5) * DISC.q[0]
    floor = Impact(DISC.q[1] - height, 0.5, rough, DISC.v[0] + DISC.v[2] if rough else ())
    run = System(DISC, L).simulate({}, (0, height, 0), (0, 0, 0), (0, 1, 2), 1e-9, events=floor)
    ahead = 20 * np.sin(0.5) * (2 / 3 if rough else 1)
    np.testing.assert_allclose(run.q[-1, :2], (ahead, height), atol=1e-9)
    assert run.error < 1e-9


def test_a_block_on_a_floor_meets_a_rough_wall_along_which_it_cannot_move() -> None:
    """From 6 by μ g = 2 to 4 at the wall x = 5, back with half of it, and at rest 1 m from the wall."""
    floor, wall = Impact(PLANE.q[1], 0, 0.2, A), Impact(5 - PLANE.q[0], 0.5, 0.2, B)
    run = System(PLANE, SLIDING - 10 * PLANE.q[1]).simulate(
        {}, (0, 0), (6, 0), (0, 1, 2, 4), 1e-9, events=(floor, wall)
    )
    np.testing.assert_allclose(run.q, [(0, 0), (5, 0), (4, 0), (4, 0)], atol=1e-9)


@pytest.mark.parametrize(("load", "start"), [(3 * t, 0), (5, 0), (3 * sp.sin(2 * t), 1)])
def test_a_stack_of_two_blocks_in_a_plane_slides_as_on_a_line(load: sp.Expr, start: float) -> None:
    """The lower of two blocks is pulled along (3, 4)/5: one contact, the other, or both at once begin to slide from rest."""
    c, along, times = coordinates("x y z w"), np.array([[0.6, 0], [0.8, 0], [0, 0.6], [0, 0.8]]), np.linspace(0, 2, 5)
    a, b, d, e = c.v
    rubs = sp.sqrt(a**2 + b**2) + sp.sqrt((a - d) ** 2 + (b - e) ** 2) / 2
    stack = System(c, sum(v**2 for v in c.v) / 2, forces=(0.6 * load, 0.8 * load, 0, 0), dissipation=rubs)
    line = System(PLANE, SLIDING, forces=(load, 0), dissipation=sp.Abs(A) + sp.Abs(A - B) / 2)
    run = stack.simulate({}, (0,) * 4, along @ (0, start), times, 1e-9)
    np.testing.assert_allclose(run.v @ along, line.simulate({}, (0, 0), (0, start), times, 1e-9).v, atol=1e-9)
    assert run.error < 1e-9


def test_a_disc_that_spins_in_a_corner_rubs_on_both_walls_and_stops_in_words() -> None:
    """N₁ + μ N₂ = m g and N₂ = μ N₁: the spin falls by 2 μ (1 + μ) g/(1 + μ²). At rest both contacts hold the same spin."""
    rate = 2 * 0.2 * 1.2 * 10 / 1.04
    floor, wall = Impact(DISC.q[1] - 1, 0, 0.2, DISC.v[0] + DISC.v[2]), Impact(DISC.q[0], 0, 0.2, DISC.v[1] - DISC.v[2])
    with pytest.warns(LagrotorWarning, match="hold the same velocities"):
        run = FALLING.simulate({k_I: 0.5}, (0, 1, 0), (0, 0, 30), (0, 1, 5, 10), 1e-9, events=(floor, wall))
    np.testing.assert_allclose(run.v[:, 2], 30 - rate * run.t, atol=1e-8)
    assert run.ending.at == pytest.approx(30 / rate, abs=1e-6)
