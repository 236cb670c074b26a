"""Forces in joints against closed formulas, Newton's and Euler's laws for every body, multipliers, and Pinocchio."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, Impact, Pathway, Plane, System, coordinates, total_derivative
from lagrotor.mechanics.bodies.moving_frames import in_ground

m, g, l, k = sp.symbols("m g l k", positive=True)
HALF = sp.Rational(1, 2)
WEIGHT = (0, -g, 0)


def pendulum(inertia: Any = 0) -> tuple[Any, System]:
    c = coordinates("theta")
    body = Frame(c).pin("theta", name="hook").body(m, (0, 0, inertia), (0, -l, 0))
    return c, System(c, body.kinetic - body.potential(WEIGHT))


@pytest.mark.parametrize(
    ("angle", "rate", "inertia", "force"),
    [
        (np.pi / 3, 0, 0, 4.905),  # m g cos θ, at release
        (np.pi / 2, 0, 0, 0),  # a point mass falls freely
        (np.pi / 2, 0, 1 / 3, 9.81 / 4),  # a rod of length 2 l: a quarter of its weight
        (0, 2, 0, 9.81 + 4),  # m g + m l ω²
    ],
)
def test_a_pin_holds_a_pendulum_as_the_text_says(angle: float, rate: float, inertia: float, force: float) -> None:
    _, swing = pendulum(sp.nsimplify(inertia, rational=True))
    run = swing.simulate({m: 1, g: 9.81, l: 1}, (angle,), (rate,), [0, 0.5], 1e-11)
    assert list(run.reactions) == ["hook"]
    assert np.linalg.norm(run.reactions["hook"].force[0]) == pytest.approx(force, abs=1e-9)
    assert run.reactions["hook"].torque == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    along = run.joint_force("hook", axes="joint").force
    tension = 9.81 * np.cos(run.q[:, 0]) + run.v[:, 0] ** 2
    assert along[:, 1] == pytest.approx(tension, abs=1e-9)


def test_rods_of_a_double_pendulum_pull_as_the_text_says() -> None:
    """S₂ = m (g cos θ₂ + l θ₁'' sin(θ₁ − θ₂) + l θ₁'² cos(θ₁ − θ₂) + l θ₂'²) with the angles to the vertical."""
    c = coordinates("alpha beta")
    upper = Frame(c).pin("alpha", name="shoulder")
    first = upper.body(m, centre=(0, -l, 0))
    second = upper.moved(0, -l).pin(c.beta - c.alpha, name="elbow").body(m, centre=(0, -l, 0))
    L = first.kinetic + second.kinetic - first.potential(WEIGHT) - second.potential(WEIGHT)
    a, b = c.q
    (x, y), (u, _) = c.v, c.a
    tension = m * (g * sp.cos(b) + l * u * sp.sin(a - b) + l * x**2 * sp.cos(a - b) + l * y**2)
    system = System(c, L)
    assert system.joints == ("shoulder", "elbow")
    assert sp.simplify(system.joint_force("elbow", "joint").force[1] - tension) == 0
    both = system.joint_force("shoulder").force - system.joint_force("elbow").force
    place = first.frame.place(first.centre)
    twice = place.applyfunc(lambda e: total_derivative(total_derivative(e, c), c))
    assert not any((both - m * (twice - sp.Matrix(WEIGHT))).applyfunc(sp.simplify))


KINDS = ("pin", "pin x", "prismatic", "universal", "screw", "planar", "ball", "weld")


def tree(kinds: list[str], branch: bool) -> System:
    """A chain or a star of joints of these kinds, each with a body."""
    size = {"universal": 2, "planar": 3, "ball": 4, "weld": 0}
    names = [[f"q{i}{j}" for j in range(size.get(kind, 1))] for i, kind in enumerate(kinds)]
    frame = ground = Frame(c := coordinates([n for group in names for n in group]))
    L = sp.S.Zero
    for i, (kind, q) in enumerate(zip(kinds, names, strict=True)):
        base, label = (ground if branch else frame).moved(1, i, HALF).turned("y", HALF), f"joint {i}"
        if kind == "weld":
            frame = base.weld((0, 1, 0), "x", (HALF,), name=label)
        elif kind == "ball":
            frame = base.ball(q, [f"w{i}{j}" for j in range(3)], name=label)
        elif kind == "screw":
            frame = base.screw(q[0], 2, (0, 3, 4), name=label)
        elif kind == "pin x":
            frame = base.pin(q[0], "x", name=label)
        else:
            frame = getattr(base, kind)(*q, name=label)
        body = frame.body(1 + i, (1, 2, HALF + 1), (0, HALF, 1))
        L = L + body.kinetic - body.potential((1, 0, -9))
    return System(c, L)


def state(system: System, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return random coordinates, with quaternions of length 1, and velocities."""
    random, c = np.random.default_rng(seed), system.c
    q, u = random.uniform(-1, 1, len(c.q)), random.uniform(-1, 1, len(system.speeds))
    for joint in system.ball_joints:
        at = [c.q.index(s) for s in joint.quaternion]
        q[at] /= np.linalg.norm(q[at])
    return q, u


@settings(max_examples=6, deadline=None)
@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=2), st.booleans(), st.integers(0, 99))
@example(["ball", "planar"], False, 1)
@example(["pin", "weld", "screw"], False, 2)
@example(["universal", "prismatic"], True, 3)
def test_forces_in_joints_obey_newton_and_euler_for_every_body(kinds: list[str], branch: bool, seed: int) -> None:
    """On each body the joint before it and the joints after it act, and the weight: m a = Σ F, d/dt(I ω) = Σ (T + r × F)."""
    if {*kinds} == {"weld"}:
        return
    system = tree(kinds, branch)
    run = system.simulate({}, *state(system, seed), [0, 1e-3])
    quasi = dict(system.velocities)

    def number(e: sp.Matrix) -> np.ndarray:
        return run._values(*e)[:, 0]

    def rate(e: sp.Matrix) -> sp.Matrix:
        return e.applyfunc(lambda x: total_derivative(x, system.c))

    joints = [run.reactions[f"joint {i}"] for i in range(len(kinds))]
    for i, body in enumerate(system.bodies):
        R, w = in_ground(body.frame)
        centre = body.frame.place(body.centre)
        spin = R * body.inertia * R.T * w.xreplace(quasi)
        force = body.mass * rate(rate(centre)) - body.mass * sp.Matrix((1, 0, -9))
        acting = [(body.frame, joints[i], 1)]
        if not branch and i + 1 < len(kinds):
            acting.append((system.bodies[i + 1].frame, joints[i + 1], -1))
        F, T = np.zeros(3), np.zeros(3)
        for frame, joint, sign in acting:
            F += sign * joint.force[0]
            T += sign * (joint.torque[0] + np.cross(number(frame.place() - centre), joint.force[0]))
        np.testing.assert_allclose(F, number(force), atol=1e-8)
        np.testing.assert_allclose(T, number(rate(spin)), atol=1e-8)


def four_bar() -> tuple[System, tuple[Any, ...]]:
    c = coordinates("p q r")
    ground = Frame(c)
    crank = ground.pin("p", name="A")
    coupler = crank.moved(1).pin("q", name="B")
    rocker = ground.moved(2).pin("r", name="D")
    bodies = (
        crank.body(1, (0, 0, HALF), (HALF, 0, 0)),
        coupler.body(2, (0, 0, HALF), (1, 0, 0)),
        rocker.body(3 * HALF, (0, 0, HALF), (HALF, 0, 0)),
    )
    closing = coupler.coincides(rocker, (2, 0, 0), (3 * HALF, 0, 0), name="C")
    L = sum(body.kinetic - body.potential((0, -9, 0)) for body in bodies)
    return System(c, L, (*closing,), dissipation=c.p_dot**2 / 5, forces=(3, 0, 0)), bodies


def test_a_loop_is_held_by_its_joints_and_its_multipliers() -> None:
    system, bodies = four_bar()
    q, v = system.consistent({}, (1.0, -0.5, 1.8), (1.0, 0, 0))
    run = system.simulate({}, q, v, np.linspace(0, 0.6, 4))
    A, B, C, D = (run.reactions[name] for name in "ABCD")
    assert [*run.reactions] == ["1", "2", "A", "B", "D", "C"]
    np.testing.assert_allclose(C.force.T[:2], [run.reactions["1"], run.reactions["2"]], rtol=1e-12)
    for body, F in zip(bodies, (A.force - B.force, B.force + C.force, D.force - C.force), strict=True):
        place = body.frame.place(body.centre)
        a = [run.evaluate(total_derivative(total_derivative(e, system.c), system.c)) for e in place]
        np.testing.assert_allclose(F, float(body.mass) * (np.array(a).T - [0, -9, 0]), atol=1e-9)
    assert A.torque[:, 2] == pytest.approx(3 - 0.4 * run.v[:, 0])  # the drive and the damper
    for pin in (B, C, D):
        assert pin.torque == pytest.approx(np.zeros((4, 3)), abs=1e-9)


def test_a_pin_that_closes_a_loop_carries_what_the_pin_of_a_tree_does() -> None:
    """A door on a ball joint whose axis is kept: force and torque at the hinge are those of a door on a pin."""
    (e, c), values = (coordinates("theta"), coordinates("a b d e")), {m: 2, g: 9.81, l: 0.7}
    pin = Frame(e).pin("theta", name="hinge").body(m, (1, 2, 3), (l, 0, l))
    twin = System(e, pin.kinetic - pin.potential((1, 2, -g)))
    door = Frame(c).ball("a b d e", "u v w", name="ball")
    body = door.body(m, (1, 2, 3), (l, 0, l))
    system = System(c, body.kinetic - body.potential((1, 2, -g)), door.keeps_axis(Frame(c), name="axis"))
    wanted = twin.simulate(values, (0.8,), (1.0,), [0, 1]).reactions["hinge"]
    run = system.simulate(values, (np.cos(0.4), 0, 0, np.sin(0.4)), (0, 0, 1), [0, 1])
    np.testing.assert_allclose(run.reactions["ball"].force, wanted.force, atol=1e-6)
    np.testing.assert_allclose(run.reactions["axis"].torque, wanted.torque, atol=1e-6)
    assert run.reactions["ball"].torque == pytest.approx(np.zeros((2, 3)), abs=1e-8)


def test_loads_reach_the_joints_from_where_they_act() -> None:
    """A statically loaded beam: clamping force and moment; a motor between two links; a wheel whose rolling pushes its axle."""
    c, F = coordinates("s"), sp.Symbol("F")
    beam = Frame(c).prismatic("s", "z").weld((2, 0, 0), name="cut")
    body = beam.body(m)
    pushed = beam.force((0, F, 0), at=(3, 0, 0)) * 2 + beam.torque((0, 0, k)) - sp.Matrix([7])
    system = System(c, body.kinetic, forces=pushed)
    at = system.joint_force("cut")
    assert list(at.force) == [0, -2 * F, m * c.s_ddot] and list(at.torque) == [0, 0, -6 * F - k]
    assert list(system.joint_force("s").torque) == [0, -2 * m * c.s_ddot, -10 * F - k]
    d = coordinates("x theta")
    axle = Frame(d).moved("x", 0, HALF)
    wheel, cart = axle.pin("theta", "y", name="axle").body(2, (1, HALF**2, 1)), axle.body(5)
    contact = wheel.rolls_on(Plane(Frame(d)), HALF, axis=(0, 1, 0))
    L = wheel.kinetic + cart.kinetic - wheel.potential((0, 0, -10)) - cart.potential((0, 0, -10))
    run = System(d, L, rolling=contact.rolling, forces=axle.force((3, 0, 0))).simulate({}, (0, 0), (1, 2), [0, 1])
    a = 3 / (7 + 1)  # m r² = I of the wheel's rim
    assert run.reactions["along 1"] == pytest.approx([-a, -a])
    assert run.reactions["axle"].force == pytest.approx(np.array([[3 * a, 0, 20]] * 2))


def test_dry_friction_of_a_load_is_that_of_the_run() -> None:
    """A block on a rail is held by a joint that carries all; the load of a rope that sticks is its true force, not sign(0)."""
    c = coordinates("s")
    block = Frame(c).prismatic("s", "x", name="rail")
    body = block.body(1)
    rubs = System(c, body.kinetic - c.s**2 / 2, forces=block.force((-2 * sp.sign(c.s_dot), 0, 0)))
    run = rubs.simulate({}, (1.5,), (0,), [0, 1])
    assert run.evaluate(sp.sign(c.s_dot)) == pytest.approx([-0.75, -0.75])
    assert run.reactions["rail"].force[:, 0] == pytest.approx([-1.5, -1.5])  # of the spring, which is in the joint


def test_a_body_that_rests_on_an_impact_has_no_forces_in_joints() -> None:
    c = coordinates("s")
    block = Frame(c).prismatic("s", name="rail").body(1)
    fall = System(c, block.kinetic - block.potential((0, 0, -9)))
    run = fall.simulate({}, (1,), (0,), [0, 0.1, 1], events=Impact(c.s, 0))
    with pytest.raises(InputError, match="the gap of an Impact is closed"):
        _ = run.reactions["rail"]
    flight = fall.simulate({}, (1,), (0,), [0, 0.1], events=Impact(c.s, 0)).reactions["rail"]
    assert flight.force == pytest.approx(np.zeros((2, 3)), abs=1e-9)


c2 = coordinates("a b")
FIRST = Frame(c2).pin("a", name="one")
SECOND = FIRST.moved(l).pin("b")
BODY = SECOND.body(m, (1, 1, 1))
T = BODY.kinetic
ROPE = Pathway.line(c2, (0, 0, 0), SECOND.place((l, 0, 0)))
REFUSED: dict[str, Callable[[], Any]] = {
    "none of the joints one, b: name": lambda: System(c2, T).joint_force("two"),
    "none of the joints one, b: one[?]": lambda: System(c2, T).joint_force("onee"),
    "axes = 'x' must be 'ground' or 'joint'": lambda: System(c2, T).joint_force("one", axes="x"),
    "the Lagrangian has no bodies": lambda: System(c2, c2.a_dot**2 + c2.b_dot**2).joint_force("one"),
    "have the name one": lambda: System(c2, T + FIRST.moved(1).pin("b", name="one").body(1).kinetic),
    "have the name  one": lambda: Frame(c2).pin("a", name=" one"),
    "term .*cos.a. of L does not say": lambda: System(c2, T - m * g * sp.cos(c2.q[0])).joint_force("one"),
    "term -b.g.m of L does not say": lambda: System(c2, T - m * g * c2.b).joint_force("one"),
    "dissipation .* does not say": lambda: System(c2, T, dissipation=ROPE.damper(1)).joint_force("one"),
    "force .* a Pathway knows no bodies": lambda: System(c2, T, forces=ROPE.actuator(k)).joint_force("one"),
    "force .* use Frame.force on the frames, unchanged": lambda: System(
        c2, T, forces=SECOND.force((1, 2, 3)).applyfunc(sp.expand)
    ).joint_force("b"),
    "constraint .* = 0 does not say": lambda: System(c2, T, (SECOND.place((l, 0, 0))[1],)).joint_force("one"),
    "energy .*a_dot.* an armature spins on an unknown body": lambda: System(c2, T + c2.a_dot**2).joint_force("one"),
    "a weight with a ": lambda: System(c2, T - BODY.potential((c2.q[0], 0, 0))).joint_force("one"),
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_has_no_place_is_refused(words: str) -> None:
    match = words if words != "have the name  one" else "text without blanks"
    with pytest.raises(InputError, match=match):
        REFUSED[words]()


def test_joints_have_the_names_of_their_coordinates_or_those_given() -> None:
    c = coordinates("a b s")
    arm = Frame(c).turned("xy", "a b")
    gear = arm.moved(1).pin(2 * c.s, "y")
    bodies = [arm.pin("s").body(1, (1, 1, 1)), gear.body(1, (1, 1, 1)), arm.weld((1, 0, 0)).body(1)]
    system = System(c, sum(body.kinetic for body in bodies))
    assert system.joints == ("a b",)  # two joints move with s, and a weld without a name is none
    locked = System(c, bodies[0].kinetic, {"s": c.s - 1})
    assert locked.joints == ("a b",) and locked.joint_force("a b").force.shape == (3, 1)


def pinocchio_twin(pin: Any, n: int, random: np.random.Generator) -> tuple[Any, System, np.ndarray]:
    """A random arm of turning and sliding joints for Pinocchio, and the same of frames."""
    model, parent = pin.Model(), 0
    c = coordinates([f"q{i}" for i in range(n)])
    frame, L = Frame(c), sp.S.Zero
    for i in range(n):
        angles, shift = random.integers(-3, 4, 3) / 5, random.integers(-3, 4, 3) / 4
        R = np.eye(3)
        for axis, angle in zip("xyz", angles, strict=True):
            R = (
                R @ getattr(pin.utils, f"rot{axis.upper()}")(angle)
                if hasattr(pin.utils, "rotX")
                else R @ np.array(pin.AngleAxis(float(angle), np.eye(3)["xyz".index(axis)]).toRotationMatrix())
            )
        slides = i % 3 == 2
        joint = pin.JointModelPZ() if slides else pin.JointModelRZ()
        parent = model.addJoint(parent, joint, pin.SE3(R, shift), f"j{i}")
        mass, centre, inertia = 1 + i, random.integers(-3, 4, 3) / 4, np.diag([1.0, 1.5, 2.0])
        model.appendBodyToJoint(parent, pin.Inertia(float(mass), centre, inertia), pin.SE3.Identity())
        rational = [sp.nsimplify(float(x), rational=True) for x in (*angles, *shift, *centre)]
        base = frame.moved(*rational[3:6]).turned("xyz", rational[:3])
        frame = (base.prismatic if slides else base.pin)(c.q[i], name=f"j{i}")
        body = frame.body(mass, (1, 3 * HALF, 2), rational[6:])
        L = L + body.kinetic - body.potential((0, 0, -sp.Rational(981, 100)))
    return model, System(c, L), random.uniform(-1, 1, (3, n))


@pytest.mark.parametrize("n", [3, 6])
def test_an_arm_has_the_forces_of_pinocchio(n: int) -> None:
    pin = pytest.importorskip("pinocchio")
    model, system, (q, v, a) = pinocchio_twin(pin, n, np.random.default_rng(n))
    data = model.createData()
    torques = pin.rnea(model, data, q, v, a)
    np.testing.assert_allclose(system.inverse_dynamics(q, v, a), torques, rtol=1e-10, atol=1e-10)
    run = system.simulate({}, q, v, [0, 1e-3])
    a = np.array([run.evaluate(s)[0] for s in system.c.a])
    pin.rnea(model, data, q, v, a)
    np.testing.assert_allclose(a, pin.aba(model, model.createData(), q, v, np.zeros(n)), rtol=1e-9, atol=1e-9)
    for i in range(n):
        joint = run.joint_force(f"j{i}", axes="joint")
        np.testing.assert_allclose(joint.force[0], data.f[i + 1].linear, rtol=1e-9, atol=1e-8)
        np.testing.assert_allclose(joint.torque[0], data.f[i + 1].angular, rtol=1e-9, atol=1e-8)


def test_forces_that_give_an_acceleration_are_those_of_the_equations() -> None:
    """M a + h − Q by the recursion and by Lagrange's equations, at one state and at many; zero along a motion."""
    system = tree(["pin x", "screw", "universal"], False)
    system = System(system.c, system.lagrangian, dissipation=system.c.v[0] ** 2 * k, forces=(1, 0, system.c.v[1], 0))
    plain = System(system.c, system.L, dissipation=system.dissipation, forces=system.forces)
    q, v, a = np.random.default_rng(1).uniform(-1, 1, (3, 5, 4))
    found = system.inverse_dynamics(q, v, a, {k: 0.3})
    np.testing.assert_allclose(found, plain.inverse_dynamics(q, v, a, {k: 0.3}), atol=1e-10)
    np.testing.assert_allclose(found[2], system.inverse_dynamics(q[2], v[2], a[2], {"k": 0.3}))
    assert found.shape == (5, 4)
    c = coordinates("s")
    body = Frame(c).prismatic("s").body(2)
    pulled = System(c, body.kinetic - body.potential((0, 0, -c.s)))  # of a field that is not uniform
    assert pulled.inverse_dynamics() == sp.Matrix([2 * c.s_ddot + 4 * c.s])
    ball = tree(["ball", "pin"], False)
    q, u = state(ball, 3)
    rates = ball.rhs({})(0, [*q, *u])[len(q) :]
    assert ball.inverse_dynamics(q, u, rates) == pytest.approx(np.zeros(4), abs=1e-9)
    flat = System(ball.c, ball.L, ball.constraints, velocities=dict(ball.velocities))
    np.testing.assert_allclose(ball.inverse_dynamics(q, u, [1, 2, 3, 4]), flat.inverse_dynamics(q, u, [1, 2, 3, 4]))
    c, swing = pendulum()
    assert swing.inverse_dynamics(c.q, [0], {"theta_ddot": 2}) == sp.Matrix(
        [g * l * m * sp.sin(c.theta) + 2 * l**2 * m]
    )
    with pytest.raises(InputError, match=r"q has the shape \(2,\): its last axis must have 1 numbers, for theta"):
        swing.inverse_dynamics([1, 2], [0], [0], {m: 1, g: 1, l: 1})
