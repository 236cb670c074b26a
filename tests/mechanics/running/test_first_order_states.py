"""First-order states: Robertson's and Stuart and Landau's equations, a motor with a pendulum, a controller, dry friction."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.errors import InputError, LagrotorError
from lagrotor.mechanics import Event, Frame, Impact, System, SystemRun, coordinates, reaction, t

x, y, z, I, e = sp.symbols("x y z I e", real=True)
mu, w, b = sp.symbols("mu omega beta", positive=True)
m, l, g, k, L, R, U, F = sp.symbols("m l g k L R U F", positive=True)
C = coordinates("theta")
ROBERTSON = System(
    states={
        x: -x / 25 + 10**4 * y * z,
        y: x / 25 - 10**4 * y * z - 3 * 10**7 * y**2,
        z: 3 * 10**7 * y**2,
    }
)
STUART_LANDAU = System(
    states={
        x: mu * x - w * y - (x**2 + y**2) * (x - b * y),
        y: w * x + mu * y - (x**2 + y**2) * (b * x + y),
    }
)
CYCLE: dict[Any, float] = {mu: 0.3, w: 2, b: 0.5}
MOTOR = System(
    C,
    m * l**2 * C.theta_dot**2 / 2 + m * g * l * sp.cos(C.theta),
    forces=(k * I,),
    states={I: (U - R * I - k * C.theta_dot) / L},
)
NUMBERS: dict[Any, float] = {m: 1, l: 1, g: 9.81, k: 0.5, L: 0.1, R: 2, U: 3}


@pytest.mark.parametrize(
    ("end", "reference"),
    [
        (40, [7.15827068719405e-01, 9.1855347645578e-06, 2.84163745745831e-01]),
        (4e5, [4.93827452099e-03, 1.984994087958e-08, 9.950617056291e-01]),
    ],
)
def test_the_stiff_equations_of_robertson_keep_their_tolerance(end: float, reference: list[float]) -> None:
    """The references are two integrations by Radau IIA, at 1e-11 and 1e-13, which agree to twelve digits."""
    run = ROBERTSON.simulate({}, t=[0, end], x0={"x": 1, "y": 0, "z": 0}, tol=1e-7)
    sizes = [1, 3.65e-5, 1]  # y is largest after milliseconds
    error = (np.abs(run.x[-1] - reference) / sizes).max()
    assert error < 1e-7
    assert run.error < 1e-7
    assert run.evaluations < 100_000
    assert ROBERTSON.conserved(x + y + z).answer == "zero"
    assert ROBERTSON.conserved(x).answer == "nonzero"


def test_the_cycle_of_stuart_and_landau() -> None:
    """r² = μ/(1 + (μ/r0² − 1) exp(−2 μ t)); on the cycle the rate is ω − ... β μ, the multipliers 1 and exp(−2 μ T)."""
    r2 = lambda s: 0.3 / (1 + (0.3 / 1e-4 - 1) * np.exp(-0.6 * s))  # noqa: E731
    times = np.linspace(0, 40, 9)
    run = STUART_LANDAU.simulate(CYCLE, t=times, x0={x: 0.01, y: 0})
    np.testing.assert_allclose((run.x**2).sum(1), r2(times), atol=1e-9)
    np.testing.assert_allclose(run.at([3.3]).x[0] @ run.at([3.3]).x[0], r2(3.3), atol=1e-9)
    assert run.error < 1e-9
    period = 2 * np.pi / (2 - 0.5 * 0.3)
    multipliers = STUART_LANDAU.floquet({x: np.sqrt(0.3), y: 0}, CYCLE, period).multipliers
    np.testing.assert_allclose(multipliers, [1, np.exp(-0.6 * period)], rtol=1e-9)
    late = run.crossings(y, 1).t[-2:]
    np.testing.assert_allclose(np.diff(late), period, rtol=1e-6)
    assert sp.Matrix([[mu, -w], [w, mu]]) == STUART_LANDAU.linearise({x: 0, y: 0}).A
    np.testing.assert_allclose(STUART_LANDAU.linearise({x: 0, y: 0}, CYCLE).rates, [0.3 - 2j, 0.3 + 2j])
    with pytest.raises(InputError, match="has not come back"):
        STUART_LANDAU.floquet({x: np.sqrt(0.3), y: 0}, CYCLE, 1.01 * period)


def test_a_motor_turns_a_pendulum(tmp_path: Path) -> None:
    times = np.linspace(0, 5, 6)
    run = MOTOR.simulate(NUMBERS, {"theta": 0.1}, {"theta_dot": 0}, times, x0={"I": 0})
    oracle = solve_ivp(
        lambda _, s: [s[1], -9.81 * np.sin(s[0]) + 0.5 * s[2], (3 - 2 * s[2] - 0.5 * s[1]) / 0.1],
        (0, 5), [0.1, 0, 0], "DOP853", times, rtol=1e-12, atol=1e-13,
    ).y  # fmt: skip
    np.testing.assert_allclose(np.hstack([run.q, run.v, run.x]).T, oracle, atol=1e-9)
    assert run.error < 1e-9
    assert MOTOR.rhs(NUMBERS)(0, [0.1, 0, 0]) == pytest.approx([0, -9.81 * np.sin(0.1), 30])
    np.testing.assert_allclose(run.evaluate(C.theta_ddot - k * I + g * sp.sin(C.theta)), 0, atol=1e-12)
    assert [*run.quantities()] == ["theta", "theta_dot", "I", "energy"]
    assert run.summary()["states"] == "I"
    again = SystemRun.load(run.save(tmp_path / "motor.npz"), MOTOR)
    np.testing.assert_array_equal(again.x, run.x)
    other = System(C, MOTOR.lagrangian, forces=MOTOR.forces, states={I: -I})
    with pytest.raises(InputError, match="another system"):
        SystemRun.load(tmp_path / "motor.npz", other)


def test_linear_equations_of_a_motor() -> None:
    A = sp.Matrix([[0, 1, 0], [-g / l, 0, k / (l**2 * m)], [0, -k / L, -R / L]])
    linear = MOTOR.linearise({C.theta: 0, I: 0, U: 0}, inputs=[U], outputs=[C.theta])
    assert (linear.A - A).expand() == sp.zeros(3)
    assert sp.Matrix([0, 0, 1 / L]) == linear.B
    place = MOTOR.rest({"theta": 0.5, "I": 0}, NUMBERS)
    assert place.at[C.theta] == pytest.approx(np.arcsin(0.75 / 9.81))
    assert place.at[I] == pytest.approx(1.5)
    at = A.subs(NUMBERS | {U: 3}).tolist()
    at[1][0] = -9.81 * np.cos(np.arcsin(0.75 / 9.81))
    np.testing.assert_allclose(MOTOR.linearise(place, NUMBERS).A, np.array(at, float), rtol=1e-12)
    exact = System(C, MOTOR.lagrangian, forces=(k * I - F,), states={I: U - R * I}).equilibria()
    assert all(e.at[I] == U / R for e in exact)
    assert len(exact) == 2


def test_the_integral_part_of_a_controller_makes_it_unstable() -> None:
    """s³ + k_d s² + k_p s + k_i is Hurwitz for k_i < k_d k_p; with saturation the run agrees with a hand-written one."""
    cart, (kp, ki, kd) = coordinates("s"), sp.symbols("k_p k_i k_d")
    command = -kp * cart.s - ki * e - kd * cart.s_dot
    free = System(cart, cart.s_dot**2 / 2, forces=(command,), states={e: cart.s})
    locus = free.root_locus({"s": 0, "e": 0}, {kp: 4, kd: 1}, ki, [1, 3, 6])
    assert locus.boundaries == pytest.approx((4,), rel=1e-4)
    bounded = System(
        cart, cart.s_dot**2 / 2, forces=((sp.Abs(command + 1) - sp.Abs(command - 1)) / 2,), states={e: cart.s}
    )
    run = bounded.simulate({kp: 4, ki: 1, kd: 2}, [3], [0], [0, 10], x0=[0])
    oracle = solve_ivp(
        lambda _, s: [s[1], np.clip(-4 * s[0] - s[2] - 2 * s[1], -1, 1), s[0]],
        (0, 10), [3, 0, 0], "DOP853", rtol=1e-11, atol=1e-11, max_step=0.02,
    ).y[:, -1]  # fmt: skip
    np.testing.assert_allclose([run.q[-1, 0], run.x[-1, 0]], oracle[[0, 2]], atol=1e-6)


def test_dry_friction_holds_a_motor_until_its_current_is_large_enough() -> None:
    """k I = ½ · 3/2 (1 − exp(−20 t)) reaches the bound ½ at t = ln(3)/20; the motion after it is linear."""
    system = System(
        C,
        C.theta_dot**2 / 2,
        forces=(k * I,),
        dissipation=F * sp.Abs(C.theta_dot),
        states={I: (U - R * I - k * C.theta_dot) / L},
    )
    with pytest.warns(match="does not keep tol"):
        run = system.simulate(
            {k: 0.5, L: 0.1, R: 2, U: 3, F: 0.5}, {"theta": 0}, {"theta_dot": 0}, [0, 0.05, 5], x0={"I": 0}
        )
    assert not run.q[1].any()
    oracle = solve_ivp(
        lambda _, s: [s[1], 0.5 * s[2] - 0.5, (3 - 2 * s[2] - 0.5 * s[1]) / 0.1],
        (np.log(3) / 20, 5), [0, 0, 1], "DOP853", rtol=1e-12, atol=1e-13,
    ).y[:, -1]  # fmt: skip
    np.testing.assert_allclose([*run.q[-1], *run.v[-1], *run.x[-1]], oracle, atol=1e-9)


@pytest.mark.parametrize("event", [Event(x - 1, (-C.theta_dot,)), Impact(2 - C.theta)])
def test_events_change_no_state(event: Event | Impact) -> None:
    """θ = t, x = ∫θ until the event, at t = √2 or 2, and θ = 2 t_e − t after it."""
    run = System(C, C.theta_dot**2 / 2, states={x: C.theta}).simulate({}, [0], [1], [0, 3], events=event, x0=[0])
    at = 2.0 if isinstance(event, Impact) else np.sqrt(2)
    assert run.q[-1, 0] == pytest.approx(2 * at - 3)
    assert run.x[-1, 0] == pytest.approx(at**2 / 2 + 2 * at * (3 - at) - (9 - at**2) / 2)


def test_bodies_constraints_and_quasi_velocities_take_states() -> None:
    """A motor in the elbow of a double pendulum of bodies, and a wheel that rolls, against the same systems in plain terms."""
    c = coordinates("A B")
    first = Frame(c).pin(c.A)
    second = first.weld(at=(0, -1, 0)).pin(c.B)
    energies = [f.body(mass=m, centre=(0, -1, 0), inertia=(1, 1, 1)) for f in (first, second)]
    lagrangian = energies[0].kinetic + energies[1].kinetic - sum(body.potential((0, -g, 0)) for body in energies)
    extra = {"forces": (0, k * I), "states": {I: U - R * I - k * c.B_dot}}
    values = {m: 1, g: 9.81, k: 0.5, R: 2, U: 3}
    runs = [
        System(c, whole, **extra).simulate(values, [0.3, 0], [0, 0], [0, 2], x0=[0])
        for whole in (lagrangian, System(c, lagrangian).L)
    ]
    np.testing.assert_allclose(runs[0].states, runs[1].states, atol=1e-8)
    d, u = coordinates("s phi"), sp.Symbol("u", real=True)
    rolling = d.s_dot - R * d.phi_dot
    wheel = {"rolling": (rolling,), "forces": (0, k * I), "states": {I: U - I - k * d.phi_dot}}
    kinetic = (d.s_dot**2 + d.phi_dot**2) / 2
    plain = System(d, kinetic, **wheel).simulate(values, [0, 0], [2, 1], [0, 2], x0=[0])
    own = System(d, kinetic, velocities={u: d.phi_dot}, **wheel).simulate(values, [0, 0], [1], [0, 2], x0=[0])
    np.testing.assert_allclose(own.q, plain.q, atol=1e-8)
    np.testing.assert_allclose(own.x, plain.x, atol=1e-8)
    # 5 phi'' = −phi + k I, I' = U − I − k phi'
    by_hand = np.linalg.eigvals([[0, 1, 0], [-0.2, 0, 0.1], [0, -0.5, -1]])
    for velocities in ({}, {u: d.phi_dot}):
        held = System(d, kinetic - d.phi**2 / 2, velocities=velocities, **wheel)
        rates = held.linearise({"s": 0, "phi": 1.5, "I": 3}, {R: 2, k: 0.5, U: 3}).rates
        np.testing.assert_allclose(np.sort_complex(rates[np.abs(rates) > 1e-9]), np.sort_complex(by_hand), rtol=1e-9)


def test_a_state_that_depends_on_time_and_a_function() -> None:
    voltage = sp.Function("V")
    coil = System(states={I: voltage(t) - R * I})
    exact = (np.sin(1) - np.cos(1) + np.exp(-1)) / 2
    for value in (sp.sin(t), np.sin):
        run = coil.simulate({R: 1, voltage: value}, t=[0, 1], x0={I: 0})
        assert run.x[-1, 0] == pytest.approx(exact, abs=1e-9)
    assert "\\dot{I} &= - I R" in System(states={I: -R * I}).latex()
    assert "I'  −I R" in repr(System(states={I: -R * I}))


REFUSED: dict[str, Callable[[], Any]] = {
    "no coordinates and no states": lambda: System(),
    "must be a dictionary {x: rate of x}": lambda: System(C, C.theta_dot**2, states=[I]),  # type: ignore[arg-type]
    "each x a symbol that is no coordinate": lambda: System(C, C.theta_dot**2, states={C.theta: 1}),
    "the rate of I contains theta_ddot": lambda: System(C, C.theta_dot**2, states={I: C.theta_ddot}),
    "write its force into forces": lambda: System(C, C.theta_dot**2 - I * C.theta, states={I: -I}),
    "in L, a constraint or a velocity": lambda: System(C, C.theta_dot**2, rolling=(C.theta_dot - I,), states={I: -I}),
    "may stand in forces and dissipation alone": lambda: System(
        C, C.theta_dot**2, constraints=(C.theta,), states={I: reaction(1)}
    ),
    "x0 = () must be a finite number, of I": lambda: MOTOR.simulate(NUMBERS, [0], [0], [0, 1]),
    "x0 names J, which is none of I": lambda: MOTOR.simulate(NUMBERS, [0], [0], [0, 1], x0={"J": 0}),
    "as the system has none": lambda: System(C, C.theta_dot**2).simulate({}, [0], [0], [0, 1], x0=[1]),
    "give its start by q0, v0 or x0": lambda: MOTOR.simulate(NUMBERS | {I: 1}, [0], [0], [0, 1], x0=[0]),
    "routh: the system has first-order states": lambda: MOTOR.routh("theta"),
    "hamiltonian: the system has first-order states": lambda: STUART_LANDAU.hamiltonian(),
    "noether: the system has first-order states": lambda: MOTOR.noether((I,)),
    "same_as: the system has first-order states": lambda: MOTOR.same_as(MOTOR),
    "the series are of one coordinate": lambda: MOTOR.lindstedt_poincare(2, sp.Symbol("a")),
    "a box holds coordinates alone": lambda: MOTOR.equilibria(values=NUMBERS, box={C.theta: (0, 1)}),
    "would bind a velocity to a first-order state": lambda: System(
        C, C.theta_dot**2 / 2, dissipation=sp.Abs(C.theta_dot - x), states={x: -x}
    ).simulate({}, [0], [0], [0, 1], x0=[1]),
}


@pytest.mark.parametrize("message", REFUSED)
def test_it_is_refused_in_words(message: str) -> None:
    with pytest.raises(LagrotorError) as refusal:
        REFUSED[message]()
    assert message in str(refusal.value)


def test_a_relay_stops_where_it_would_slide() -> None:
    with pytest.warns(match="stays on x = 0, which is not followed"):
        run = System(states={x: -sp.sign(x)}).simulate({}, t=[0, 0.5, 2], x0=[1])
    np.testing.assert_allclose(run.t, [0, 0.5, 1])
