"""Joints by name, each as steps written by hand; ball joints beside Euler angles, closed forms and conservation laws."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipj

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates
from lagrotor.mechanics.bodies.trees import tree_of
from lagrotor.mechanics.running.programs import function_program
from tests.systems import I1, I2, I3, VALUES, ball_top, g, l, m, values_of

GRAVITY = (0, 0, -g)


def at(system: System, y: np.ndarray, *expressions: sp.Expr) -> np.ndarray:
    """Expressions at a state (q, u)."""
    letters = {str(s): VALUES[s] for s in (m, l, g, I1, I2, I3)}
    return function_program(system, *expressions).along(letters)(y[None], np.zeros(1))[:, 0]


def of_angles(angles: np.ndarray) -> np.ndarray:
    """The unit quaternion of turns 'zxz'."""
    f, h, s = np.asarray(angles) / 2
    return np.array(
        [np.cos(f + s) * np.cos(h), np.cos(f - s) * np.sin(h), np.sin(f - s) * np.sin(h), np.sin(f + s) * np.cos(h)]
    )


def branched(ball: bool) -> tuple[System, list[sp.Expr], Frame]:
    """A cart, on it a body on a ball joint, on this a hinge and a second ball joint; in quaternions, or in Euler's angles."""
    one, two = ("q0 q1 q2 q3", "e0 e1 e2 e3") if ball else ("f h s", "d n k")
    c = coordinates(f"x {one} a {two}")
    by_name = {str(q): q for q in c.q}

    def turned(frame: Frame, names: str, omega: str) -> Frame:
        return frame.ball(names, omega) if ball else frame.turned("zxz", [by_name[n] for n in names.split()])

    cart = Frame(c).prismatic(by_name["x"], "x")
    first = turned(cart.moved(0, l, 0), one, "p q r")
    arm = first.moved(l, 0, l / 2).turned("y", by_name["a"])
    last = turned(arm.moved(0, 0, -l), two, "w1 w2 w3")
    bodies = [
        cart.body(m),
        first.body(m, (I1, I2, I3), (l / 3, 0, l)),
        arm.body(m / 2, (I2, I3, I1), (0, l / 2, 0)),
        last.body(m, (I3, I1, I2), (0, l / 4, -l)),
    ]
    L = sum((b.kinetic - b.potential(GRAVITY) for b in bodies), sp.S.Zero)
    return System(c, L), [first, last], last


def relative(frame: Frame) -> sp.Matrix:
    """The angular velocity of three turns together, in the axes that they lead to."""
    one, two, three = frame.parent.parent, frame.parent, frame
    return three.rotation.T * (two.rotation.T * one.turn_rate + two.turn_rate) + three.turn_rate


def test_a_tree_with_ball_joints_moves_as_in_eulers_angles() -> None:
    """At random states: the accelerations of a point of the last body, the energy, the rates of both angular velocities."""
    (quaternions, turned, last), (angles, twins, other) = branched(True), branched(False)
    assert tree_of(quaternions) is not None and not quaternions.left
    rng = np.random.default_rng(1)
    for _ in range(3):
        euler = np.concatenate([rng.uniform(0.3, 1.2, 8), rng.uniform(-1, 1, 8)])
        w = [at(angles, euler, *relative(frame)) for frame in twins]
        q = [euler[:1], of_angles(euler[1:4]), euler[4:5], of_angles(euler[5:8])]
        y = np.concatenate([*q, euler[8:9], w[0], euler[12:13], w[1]])

        def seen(frame: Frame) -> list[sp.Expr]:
            place, c = frame.place((l, l / 2, 0)), frame.c
            speed = place.jacobian(c.q) * sp.Matrix(c.v)
            return [*place, *speed, *(speed.jacobian(c.q) * sp.Matrix(c.v) + place.jacobian(c.q) * sp.Matrix(c.a))]

        np.testing.assert_allclose(
            at(quaternions, y, *seen(last)), at(angles, euler, *seen(other)), rtol=1e-9, atol=1e-9
        )
        for frame, wanted in zip(turned, w, strict=True):
            np.testing.assert_allclose(at(quaternions, y, *frame.turn_rate), wanted, atol=1e-12)


def test_a_top_started_at_its_pole_runs_as_quickly_as_any_other() -> None:
    """Evaluations from upright, and from a tilt at which Euler's angles are at their best; upright these have a pole."""
    system = ball_top()
    values, times = values_of(system), np.linspace(0, 5, 11)
    upright = system.simulate(values, (1, 0, 0, 0), (0.3, 0, 30), times)
    tilted = system.simulate(values, of_angles(np.array([0, 1.2, 0])), (0.3, 0, 30), times)
    assert upright.evaluations < 1.3 * tilted.evaluations
    assert np.ptp(upright.energy) < 1e-7 * abs(upright.energy[0]) and upright.drift.max() < 1e-13
    body = Frame(c := coordinates("phi theta psi")).turned("zxz", c.q).body(m, (I1, I1, I3), (0, 0, l))
    angles = System(c, body.kinetic - body.potential(GRAVITY))
    twin = angles.simulate(values, (0, 1.2, 0), (0, 0.3, 30), times)
    heights = [run.evaluate(run.system.bodies[0].frame.place((0, 0, 1))[2]) for run in (tilted, twin)]
    assert np.abs(heights[0] - heights[1]).max() < 1e-7


def test_a_free_body_turns_by_jacobis_elliptic_functions() -> None:
    """I1 > I2 > I3 about its long axis, Landau & Lifshitz, Mechanics, §37."""
    system = ball_top((I1, I2, I3), (0, 0, 0))
    A, B, C = 0.5, 0.4, 0.2
    w1, w3, times = 0.3, 2.0, np.linspace(0, 20, 41)
    run = system.simulate({I1: A, I2: B, I3: C}, (1, 0, 0, 0), (w1, 0, w3), times, 1e-10)
    # M² < 2 E B: the axis of the least inertia is circled.
    E2, M2 = A * w1**2 + C * w3**2, (A * w1) ** 2 + (C * w3) ** 2
    assert M2 < E2 * B
    tau = times * np.sqrt((B - C) * (E2 * A - M2) / (A * B * C))
    k2 = (A - B) * (M2 - E2 * C) / ((B - C) * (E2 * A - M2))
    sn, cn, dn, _ = ellipj(tau, k2)
    wanted = np.stack([w1 * cn, np.sqrt((M2 - E2 * C) / (B * (B - C))) * sn, w3 * dn], 1)
    signs = np.sign(run.u[1] * wanted[1])
    np.testing.assert_allclose(run.u, wanted * signs, atol=1e-7)


A_, S_, B_ = sp.symbols("a s b", real=True)
TILT = sp.atan(sp.Rational(3, 4))
NAMED: dict[str, tuple[Callable[[Frame], Frame], Callable[[Frame], Frame]]] = {
    "pin": (lambda f: f.pin(A_, "y").pin(B_), lambda f: f.turned("yz", [A_, B_])),
    "a pin about a direction": (
        lambda f: f.pin(A_, (0, 3, 4)).prismatic(B_, "x"),
        lambda f: f.turned("xzx", [-TILT, A_, TILT]).moved(B_, 0, 0),
    ),
    "prismatic": (
        lambda f: f.prismatic(A_, (3, 0, 4)).pin(B_, "x"),
        lambda f: f.moved(3 * A_ / 5, 0, 4 * A_ / 5).turned("x", B_),
    ),
    "cylindrical": (lambda f: f.cylindrical(A_, B_, "x"), lambda f: f.moved(A_, 0, 0).turned("x", B_)),
    "universal": (lambda f: f.universal(A_, B_), lambda f: f.turned("xy", [A_, B_])),
    "screw": (
        lambda f: f.screw(A_, l, "y").prismatic(B_),
        lambda f: f.moved(0, l * A_ / (2 * sp.pi), 0).turned("y", A_).moved(0, 0, B_),
    ),
    "weld": (
        lambda f: f.pin(A_).weld((l, 0, 0), "x", sp.pi / 3).pin(B_),
        lambda f: f.turned("z", A_).moved(l, 0, 0).turned("x", sp.pi / 3).turned("z", B_),
    ),
    "planar": (
        lambda f: f.planar(A_, B_, S_, "x"),
        lambda f: f.moved(0, A_, B_).turned("x", S_),
    ),
}


@pytest.mark.parametrize("name", NAMED)
def test_a_joint_by_name_moves_as_its_steps(name: str) -> None:
    c = coordinates("a b s" if name == "planar" else "a b")

    def of(make: Callable[[Frame], Frame]) -> System:
        body = make(Frame(c).turned("x", sp.pi / 7)).body(m, (I1, I2, I3), (l / 2, l, l / 4))
        return System(c, body.kinetic - body.potential(GRAVITY))

    by_name, by_steps = (of(make) for make in NAMED[name])
    assert (tree_of(by_name) is None) == (name == "screw")
    y = np.random.default_rng(3).uniform(0.2, 1, 2 * len(c.q))
    np.testing.assert_allclose(at(by_name, y, *c.a, by_name.energy), at(by_steps, y, *c.a, by_steps.energy), rtol=1e-9)


def test_axes_kept_along_each_other_close_a_pin() -> None:
    """A door on a ball joint: its point and its axis held leave one angle, as a pin; and a shaft kept along a tilted one."""
    c = coordinates("q0 q1 q2 q3")
    door = Frame(c).ball("q0 q1 q2 q3", omega="p q r")
    body = door.body(m, (I1, I2, I3), (l / 2, 0, -l))
    L, axis = body.kinetic - body.potential(GRAVITY), (0, 3, 4)
    pin = Frame(e := coordinates("theta")).pin(e.q[0], axis).body(m, (I1, I2, I3), (l / 2, 0, -l))
    twin = System(e, pin.kinetic - pin.potential(GRAVITY))
    system = System(c, L, door.keeps_axis(Frame(c), axis))
    assert len(system.left) == 2
    values, times = {s: VALUES[s] for s in (m, l, g, I1, I2, I3)}, np.linspace(0, 2, 9)
    turn = np.array([np.cos(0.4), *(np.sin(0.4) * np.array(axis) / 5)])
    run = system.simulate(values, turn, np.array(axis) / 5, times)
    angle = twin.simulate(values, (0.8,), (1.0,), times)
    rate = run.u @ np.array(axis) / 5
    np.testing.assert_allclose(rate, angle.v[:, 0], atol=1e-6)
    np.testing.assert_allclose(run.u - np.outer(rate, axis) / 5, 0, atol=1e-9)
    tilted = Frame(c).turned("x", -TILT)  # whose z axis is (0, 3, 4)/5
    held = door.keeps_axis(tilted, axis, other_axis="z")
    wanted = [sp.expand(x) for x in door.keeps_axis(Frame(c), axis)]
    seen = np.array(at(system, np.r_[turn, 0, 0, 0], *held))
    assert len(held) == len(wanted) == 2 and np.abs(seen).max() < 1e-15
    with pytest.raises(InputError, match="binds no coordinate"):
        Frame(c).keeps_axis(tilted, axis)


def test_a_loop_of_ball_joints_moves_as_a_pendulum_about_the_line_of_its_ends() -> None:
    """A rod on two ball joints at the ends of a line, closed by `coincides`, swings about that line."""
    c = coordinates("q0 q1 q2 q3")
    swing = Frame(c).ball("q0 q1 q2 q3", omega="p q r")
    body = swing.body(m, (I1, I2, I3), (l / 2, 0, -l))
    held = swing.coincides(Frame(c).moved(l, 0, 0), (l, 0, 0))
    values = {s: VALUES[s] for s in (m, l, g, I1, I2, I3)}
    e = coordinates("theta")
    twin = System(e, (I1 + m * l**2) * e.v[0] ** 2 / 2 + m * g * l * sp.cos(e.q[0]))
    plane = twin.simulate({s: VALUES[s] for s in (m, l, g, I1)}, (0.8,), (0,), np.linspace(0, 2, 9))
    # Two of the three components bind the axis; the third follows from them, and is left out where it is given.
    for closure in (held[1:], held, (*held, *held)):
        system = System(c, body.kinetic - body.potential(GRAVITY), closure)
        run = system.simulate(values, (np.cos(0.4), np.sin(0.4), 0, 0), (0, 0, 0), np.linspace(0, 2, 9))
        np.testing.assert_allclose(run.u[:, 0], plane.v[:, 0], atol=1e-6)
        assert np.abs(run.u[:, 1:]).max() < 1e-9 and run.drift.max() < 1e-10
        assert len(run.redundancy.dropped if run.redundancy else ()) == len(closure) - 2


def test_a_tree_moves_alike_in_velocities_that_are_no_joints() -> None:
    """A ball joint and a hinge, with the speed of a point for the hinge's rate, and a wire that stays a constraint."""
    c = coordinates("q0 q1 q2 q3 a")
    first = Frame(c).ball("q0 q1 q2 q3", omega="p q r")
    arm = first.moved(l, 0, l / 2).pin(c.q[4], "y")
    bodies = [first.body(m, (I1, I2, I3), (l / 3, 0, l)), arm.body(m / 2, (I2, I3, I1), (0, l / 2, l))]
    L = sum((b.kinetic - b.potential(GRAVITY) for b in bodies), sp.S.Zero)
    wire = (arm.place((0, 0, l))[0],)
    speed, p = sp.Symbol("s", real=True), first.omega[0]
    natural = System(c, L, wire)
    own = System(c, L, wire, velocities={speed: l * c.v[4] * (2 + sp.cos(c.q[4])) + p})
    assert own.speeds == (speed, *first.omega) and tree_of(own) is None and own.left == natural.left == (0,)
    q = [*of_angles(np.array([0.3, 0.7, 0.2])), 0.4]
    twin = np.array([*q, 0.3, -0.2, 0.5, 0.7])
    y = np.array([*q, VALUES[l] * 0.7 * (2 + np.cos(0.4)) + 0.3, 0.3, -0.2, 0.5])
    wanted = (*c.v, *c.a, natural.multipliers[0], natural.energy)
    np.testing.assert_allclose(at(own, y, *wanted), at(natural, twin, *wanted), rtol=1e-9, atol=1e-9)


def test_joints_take_names_and_symbols() -> None:
    c = coordinates("alpha beta x y k l m n")
    ground, u = Frame(c), sp.symbols("u v w", real=True)
    pairs = (
        (ground.pin("alpha", "x"), ground.pin(c.alpha, "x")),
        (ground.prismatic("x"), ground.prismatic(c.x)),
        (ground.screw("alpha", 2), ground.screw(c.alpha, 2)),
        (ground.cylindrical("x", "alpha"), ground.cylindrical(c.x, c.alpha)),
        (ground.universal("alpha", "beta"), ground.universal(c.alpha, c.beta)),
        (ground.planar("x", "y", "alpha"), ground.planar(c.x, c.y, c.alpha)),
        (ground.turned("zx", "alpha beta"), ground.turned("zx", (c.alpha, c.beta))),
        (ground.turned("z", "alpha"), ground.turned("z", c.alpha)),
        (ground.moved("x", 0, "y"), ground.moved(c.x, 0, c.y)),
        (ground.ball("k l m n", "u v w"), ground.ball(c.q[4:], u)),
        (ground.free("x y alpha", "k l m n", "u v w"), ground.free((c.x, c.y, c.alpha), c.q[4:], list(u))),
    )
    for by_name, by_symbol in pairs:
        assert by_name.place((1, 2, 3)) == by_symbol.place((1, 2, 3)) and by_name.omega == by_symbol.omega
        assert by_name.velocity((1, 2, 3)) == by_symbol.velocity((1, 2, 3))
    for words, call in (
        ("pin: angle: z is none of the coordinates alpha, beta", lambda: ground.pin("z")),
        ("moved: .* 2 is none of", lambda: ground.moved("2")),
        ("ball: omega = .* must be 3 names", lambda: ground.ball("k l m n", (1, 2, 3))),
    ):
        with pytest.raises(InputError, match=words):
            call()
