"""Velocities of one's own: Euler's equations, non-holonomic frames, and what is refused."""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from lagrotor.errors import InputError
from lagrotor.mechanics import Event, Impact, System, coordinates, motion_program, t
from lagrotor.mechanics.running.programs import equations_of_speeds, function_program
from lagrotor.numerics import operations
from tests.mechanics.running.test_state_space import TILT, bicycle, ordered, published
from tests.systems import I1, I2, I3, ball_top, g, l, m, turning_top

a = sp.Symbol("a", positive=True)
p, q, r, u, w = sp.symbols("p q r u w", real=True)
VALUES = {I1: 1.0, I2: 2.0, I3: 2.5, m: 1.3, l: 0.4, a: 0.4, g: 9.81}


def sleigh() -> System:
    """Chaplygin's: a blade at the distance a behind the centre; u along it, w the turning."""
    c = coordinates("x y phi")
    (_, _, phi), (x, y, turn) = c.q, c.v
    along, across = x * sp.cos(phi) + y * sp.sin(phi), y * sp.cos(phi) - x * sp.sin(phi)
    L = m * (along**2 + (across + a * turn) ** 2) / 2 + I1 * turn**2 / 2
    return System(c, L, rolling=(across,), velocities={u: along, w: turn})


def disc() -> System:
    """Thin, on a rough plane; the velocities are those of its turning in the axes that do not spin with it."""
    c = coordinates("x y psi phi gamma")
    (_, _, yaw, lean, _), (x, y, turn, fall, roll) = c.q, c.v
    w1, w2, w3 = fall, turn * sp.sin(lean) + roll, turn * sp.cos(lean)
    centre = (
        x + a * (turn * sp.cos(yaw) * sp.sin(lean) + fall * sp.sin(yaw) * sp.cos(lean)),
        y + a * (turn * sp.sin(yaw) * sp.sin(lean) - fall * sp.cos(yaw) * sp.cos(lean)),
        -a * fall * sp.sin(lean),
    )
    T = m * sum(e**2 for e in centre) / 2 + m * a**2 * (w1**2 + 2 * w2**2 + w3**2) / 8
    slips = (x - a * roll * sp.cos(yaw), y - a * roll * sp.sin(yaw))
    return System(c, T - m * g * a * sp.cos(lean), rolling=slips, velocities={p: w1, q: w2, r: w3})


def without(system: System) -> System:
    return System(system.c, system.L, system.constraints, system.rolling, system.dissipation, system.forces)


def at(system: System, y: np.ndarray, *expressions: sp.Expr) -> np.ndarray:
    """Expressions at a state (q, u, t)."""
    return function_program(system, *expressions).along(VALUES)(y[None, :-1], y[-1:])[:, 0]


def assert_same_motion(system: System, seed: int = 1) -> None:
    """Velocities, accelerations and multipliers as of the same system in v alone."""
    y = np.random.default_rng(seed).uniform(0.2, 1, len(system.c.q) + len(system.speeds) + 1)
    v = at(system, y, *system.c.v)
    wanted = (*system.c.a, *system.multipliers, system.energy)
    plain = at(without(system), np.concatenate([y[: len(v)], v, y[-1:]]), *wanted)
    np.testing.assert_allclose(at(system, y, *wanted), plain, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(at(system, y, *(e for _, e in system.velocities)), y[len(v) : -1], rtol=1e-12)


def test_a_top_in_its_own_angular_velocities_obeys_eulers_equations() -> None:
    system = turning_top()
    _, M, push = equations_of_speeds(system)
    assert (M - sp.diag(I1, I2, I3)).applyfunc(sp.simplify).is_zero_matrix
    _, theta, psi = system.c.q
    torque = m * g * l * sp.sin(theta) * sp.Matrix([sp.cos(psi), -sp.sin(psi), 0])
    euler = sp.Matrix([(I2 - I3) * q * r, (I3 - I1) * r * p, (I1 - I2) * p * q]) + torque
    assert (push - euler).applyfunc(sp.simplify).is_zero_matrix
    u_dot = sp.Matrix(sp.symbols("p_dot q_dot r_dot", real=True))
    assert (system.hamel - (sp.diag(I1, I2, I3) * u_dot - euler)).applyfunc(sp.simplify).is_zero_matrix
    assert system.kinematics is not None and system.kinematics.poles == (sp.sin(theta),)
    assert_same_motion(system)
    # Half of what the angles' own rates take, and less.
    assert 2 * operations(motion_program(system).program) < operations(motion_program(without(system)).program)


@pytest.mark.parametrize("make", [sleigh, disc])
def test_fewer_velocities_than_coordinates_use_the_constraints_up(make: object) -> None:
    system = make()  # type: ignore[operator]
    assert len(system.speeds) == len(system.c.q) - len(system.multipliers) and not system.left
    assert_same_motion(system)
    assert operations(motion_program(system).program) < operations(motion_program(without(system)).program) / 2


def test_chaplygins_sleigh_has_its_equations_and_its_run_is_read_back(tmp_path: object) -> None:
    """u' = a w², w' = −m a u w / (I + m a²): Neimark & Fufaev, ch. III."""
    _, M, push = equations_of_speeds(sleigh())
    wanted = sp.Matrix([a * w**2, -m * a * u * w / (I1 + m * a**2)])
    assert (M.LUsolve(push) - wanted).applyfunc(sp.simplify).is_zero_matrix
    run = sleigh().simulate(VALUES, (0, 0, 0.3), (0.7, 1.1), np.linspace(0, 1, 5))
    path = run.save(tmp_path / "run.npz")  # type: ignore[operator]
    back = type(run).load(path, sleigh())
    assert (back.u == run.u).all() and np.allclose(back.v, run.v)
    with pytest.raises(InputError, match="another system"):
        type(run).load(path, without(sleigh()))


def test_a_run_in_velocities_of_ones_own_is_that_of_the_coordinates() -> None:
    system = sleigh()
    times = np.linspace(0, 4, 9)
    run = system.simulate(VALUES, (0, 0, 0.3), (0.7, 1.1), times, 1e-9)
    assert run.u.shape == (9, 2) and run.q.shape == run.v.shape == (9, 3)
    plain = without(system).simulate(VALUES, (0, 0, 0.3), run.v[0], times, 1e-9)
    size = np.abs(plain.q).max()
    assert np.abs(run.q - plain.q).max() < 1e-8 * size and np.abs(run.v - plain.v).max() < 1e-8 * size
    assert np.ptp(run.energy) < 1e-8 * run.energy[0] and run.drift.max() < 1e-12
    np.testing.assert_allclose(run.evaluate(system.multipliers[0]), plain.evaluate(system.multipliers[0]), atol=1e-7)
    np.testing.assert_allclose(
        run.at(1.3).u[0], system.simulate(VALUES, (0, 0, 0.3), (0.7, 1.1), (0, 1.3)).u[-1], atol=1e-7
    )
    x, phi = system.c.q[0], system.c.q[2]
    turned = run.crossings(phi - sp.Rational(1, 2), 1)
    np.testing.assert_allclose(turned.t, plain.crossings(phi - sp.Rational(1, 2), 1).t, atol=1e-8)
    np.testing.assert_allclose(run.crossings(system.c.v[0]).t, plain.crossings(system.c.v[0]).t, atol=1e-8)
    assert x in system.c.q and {"u", "x_dot"} <= run.quantities().keys()
    assert run.plot("u").axes[0].lines[0].get_ydata() == pytest.approx(run.u[:, 0])


def test_expressions_may_be_written_in_velocities_of_ones_own() -> None:
    """Friction on the top's spin, a motor on the sleigh, and an affine velocity that time moves."""
    c = turning_top().c
    braked = System(c, turning_top().L, dissipation=r**2 / 5, velocities=turning_top().velocities)
    assert_same_motion(braked)
    run = braked.simulate(VALUES, (0.1, 0.8, 0.2), (0, 0, 4), (0, 1))
    assert run.energy[1] < run.energy[0] - 1
    moving = coordinates("x y")
    (x, y), (x_v, y_v) = moving.q, moving.v
    relative = {u: x_v - t * y_v - sp.sin(t), w: (2 + sp.cos(x)) * y_v + t}
    L = m * (x_v**2 + (1 + x**2) * y_v**2 + u * w) / 2 - g * y
    assert_same_motion(System(moving, L, forces=(u * w, -w), velocities=relative))


def test_constraints_that_are_left_are_kept_by_multipliers() -> None:
    """A rolling sleigh whose blade's point is on a wire as well, and a top with an axle."""
    base = sleigh()
    x, y, _ = base.c.q
    held = System(base.c, base.L, (x - y**2,), base.rolling, velocities=base.velocities)
    assert held.left == (0,) and held.kinematics is not None and held.kinematics.used == (1,)
    system = turning_top()
    axle = System(system.c, system.L, (sp.sin(system.c.q[0]) + system.c.q[1],), velocities=system.velocities)
    assert axle.left == (0,)
    q0, u0 = axle.consistent(VALUES, (0.5, -0.4, 0.3), (0.4, 0.2, 3))
    run = axle.simulate(VALUES, q0, u0, np.linspace(0, 2, 9))
    assert run.drift.max() < 1e-10
    plain = without(axle).simulate(VALUES, q0, run.v[0], np.linspace(0, 2, 9))
    assert np.abs(run.q - plain.q).max() < 1e-7 and np.abs(run.v - plain.v).max() < 1e-6


def test_events_act_on_velocities_of_ones_own() -> None:
    """A sleigh against a wall along y: with the blade held, the same impact as in the coordinates."""
    system = sleigh()
    wall = Impact(1 - system.c.q[0], sp.Rational(1, 2))
    run = system.simulate(VALUES, (0, 0, 0.3), (1.0, 0.5), np.linspace(0, 2, 5), events=wall)
    plain = without(system).simulate(VALUES, (0, 0, 0.3), run.v[0], np.linspace(0, 2, 5), events=wall)
    np.testing.assert_allclose(run.q, plain.q, atol=1e-7)
    halted = system.simulate(VALUES, (0, 0, 0.3), (1.0, 0.5), (0, 2), events=Event(w - sp.Rational(1, 4)))
    assert halted.u[-1][1] == pytest.approx(0.25) and halted.ending.kind == "event"


def test_motions_are_linearised_in_velocities_of_ones_own() -> None:
    """The least speed of a rolling disc, v² = g a / 3; the spin of a sleeping top has a pole in these angles."""
    least = np.sqrt(VALUES[g] * VALUES[a] / 3) / VALUES[a]
    for rate, unstable in ((0.99 * least, True), (1.01 * least, False)):
        lin = disc().linearise({"psi": 0, "phi": 0, "q": rate}, {g: VALUES[g], a: VALUES[a], m: VALUES[m]})
        assert (lin.rates.real.max() > 1e-2) == unstable and len(lin.states) == 8
    matrix = disc().floquet({"psi": 0, "phi": 0, "q": rate}, {s: VALUES[s] for s in (g, a, m)}, 0.5)
    np.testing.assert_allclose(matrix.matrix, expm(lin.A * 0.5), atol=1e-8 * np.abs(matrix.matrix).max())


@pytest.mark.slow
def test_the_benchmark_bicycle_moves_in_three_velocities() -> None:
    """Lean, steer and rear wheel, from bodies; nothing but its three degrees of freedom is left to be integrated."""
    base = bicycle()
    lean, steer, roll = sp.symbols("u_lean u_steer u_roll", real=True)
    own = {lean: base.c.v[3], steer: base.c.v[5], roll: base.c.v[6]}
    system = System(base.c, base.lagrangian, base.constraints, base.rolling, velocities=own)
    assert not system.left and len(system.kinematics.used) == 5  # type: ignore[union-attr]
    assert operations(motion_program(system).program) < 4200
    for speed in (2.0, 5.0, 8.0):
        at = {str(q): 0.0 for q in base.c.q} | {"u_roll": speed / 0.3}
        rates = system.linearise(at, {TILT: np.pi / 10}).rates
        moving = rates[np.argsort(np.abs(rates))[-4:]]
        np.testing.assert_allclose(ordered(moving), ordered(published(speed).astype(complex)), rtol=1e-9)


def test_integrals_are_decided_in_velocities_of_ones_own() -> None:
    """The energy and the vertical angular momentum of a top on a ball joint; its spin, where it is symmetric."""
    for inertia, spins in (((I1, I1, I3), "zero"), ((I1, I2, I3), "undecided")):
        system = ball_top(inertia)
        (joint,) = system.ball_joints
        assert system.conserved(joint.omega[2]).answer == spins
        assert system.conserved(joint.omega[0]).answer == "undecided"
        J = sp.diag(*inertia) + m * l**2 * sp.diag(1, 1, 0)
        vertical = (joint.rotation * J * sp.Matrix(joint.omega))[2]
        assert system.conserved(vertical).answer == "zero"
    assert system.conserved(system.energy).answer == "zero"
    energy = u**2 * m / 2 + w**2 * (I1 + m * a**2) / 2
    assert sleigh().conserved(energy).answer == "zero"
    assert sleigh().conserved(w).answer == "undecided"


def test_identities_are_decided_as_in_the_coordinates() -> None:
    system = turning_top()
    assert system.same_as(without(system)).answer == "zero"
    assert system.conserved(system.energy).answer == "zero"
    assert system.cyclic == (system.c.q[0],)
    assert system.routh("phi").velocities == ()
