"""One table of refusals of the mechanics: by the kind of error, a fragment of the message and the call that must raise it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import KanesMethod, ReferenceFrame, dynamicsymbols
from sympy.physics.mechanics import System as TheirSystem

from lagrotor.errors import (
    ConstraintError,
    DomainError,
    InputError,
    LagrotorError,
    NotASymmetryError,
    SingularError,
)
from lagrotor.mechanics import (
    Coordinates,
    Cylinder,
    Event,
    Frame,
    Impact,
    Pathway,
    Plane,
    Sphere,
    System,
    SystemRun,
    accelerations,
    constrained_accelerations,
    coordinates,
    degrees_of_freedom,
    legendre,
    reaction,
    t,
)
from lagrotor.mechanics.constraints import project_position, project_velocity, solve_constrained
from tests.systems import ball_top, cart_and_pole, heavy_top, rolling_disc, sleigh, turning_top

m, l, g, k, s = sp.symbols("m l g k s", positive=True)
b, M, p, r, w1, w2 = sp.symbols("b M p r w_1 w_2", real=True)
A, P, S, Q = (
    coordinates("theta"),
    coordinates("x y"),
    coordinates("phi theta psi"),
    coordinates("q0 q1 q2 q3 e0 e1 e2 e3"),
)
(q,), (v,), (a,) = A.q, A.v, A.a
(x, y), (u, w) = P.q, P.v
T = np.linspace(0, 1, 3)
STRANGER = sp.Symbol("theta")  # of the name of a coordinate, and not it
SWING = m * l**2 * v**2 / 2 + m * g * l * sp.cos(q)
FLAT = m * (u**2 + w**2) / 2
VALUES = {m: 1, l: 1, g: 10}
UNIT, BOX = v**2 / 2 - q**2 / 2, {x: (-1, 1), y: (-1, 1)}
pendulum, point = System(A, SWING), System(P, FLAT)
weak, forced = System(A, UNIT - k * q**4), System(A, UNIT, forces=(k * (1 - q**2) * v,))
timed = System(A, SWING + t * q)
circle = System(P, FLAT - m * g * y, (x**2 + y**2 - l**2,))
knife = System(S, (S.v[0] ** 2 + S.v[1] ** 2 + S.v[2] ** 2) / 2, rolling=(S.v[0] * sp.sin(S.q[2]) - S.v[1],))
wheel = System(P, FLAT, rolling=(u - 2 * w,))
ground, GROUND = Frame(A), Frame(Q)
LINE = Pathway.line(P, (0, 0, 0), (x, y, 0))
q1, u1 = dynamicsymbols("q1 u1")
TURNED = dict.fromkeys(Q.q[:4], 0)
F = sp.Symbol("F", positive=True)
CART = cart_and_pole(F)
(cx, ct), (cv, cw) = CART.c.q, CART.c.v
SPRING, QUARTIC = (System(P, FLAT / m - x**n / n) for n in (2, 4))  # whose slopes stay, at first or for good
# On a line that turns, whose rows turn where no reaction does: x'' = (w² − 1) x.
SLOT = System(
    S, sum(v**2 - e**2 for v, e in zip(S.v, S.q, strict=True)), (S.q[0] * sp.sin(S.q[2]) - S.q[1] * sp.cos(S.q[2]),)
)
SPRINGS = sum((k + i) * (a - b) ** 2 for i, (a, b) in enumerate(zip(S.q, (*S.q[1:], 0), strict=True)))
THREE = System(S, sum(v**2 for v in S.v) / 2 - SPRINGS / 2).linearise(dict.fromkeys(S.q, 0))
DISC = dict.fromkeys(("x", "y", "phi", "theta", "psi"), 0) | {"z": sp.Symbol("R", positive=True)}
UPRIGHT = {"q0": 1, "q1": 0, "q2": 0, "q3": 0}
BODY = {"m": 1.3, "l": 0.7, "g": 9.81, "I_1": 0.3, "I_3": 0.2}


def body(*given: Any, **named: Any) -> Any:
    return ground.turned("x", q).body(*given, **named)


BALL = ground.moved(0, 0, q).body(1, (1, 1, 1))


def run(
    system: System = pendulum, values: Any = VALUES, q0: Any = (0.1,), v0: Any = (0,), times: Any = T, **more: Any
) -> Any:
    return system.simulate(values, q0, v0, times, **more)


def top(**values: Any) -> Any:
    I1, I3 = sp.symbols("I1 I3", real=True)
    rotor = Frame(S).turned("zxz", S.q).body(M, (I1, I1, I3), (0, 0, l))
    system = System(S, rotor.kinetic - rotor.potential((0, 0, -g)))
    start = values.pop("start", (0, 0.5, 0))
    return system.simulate({"M": 1, "l": 1, "g": 10, "I1": 1, "I3": 1} | values, start, (0, 0, 9), T)


def spun_point() -> System:
    """A point on the axis about which the second angle turns it."""
    return System(P, Frame(P).turned("xz", P.q).body(m, centre=(0, 0, -l)).kinetic)


def own(velocities: Any) -> System:
    return System(P, FLAT, velocities=velocities)


def jointed(*omega: str) -> System:
    """Two ball joints, the second by its own coordinates."""
    frames = (GROUND.ball("q0 q1 q2 q3", omega[0]), GROUND.ball(omega[1], omega[2]))
    return System(Q, sum(f.body(1, (1, 2, 2.5)).kinetic for f in frames))


def boxed(system: System = pendulum, values: Any = VALUES, box: Any = None) -> Any:
    return system.equilibria(values=values, box={q: (-1, 1)} if box is None else box)


REFUSED: dict[type[LagrotorError], dict[str, Callable[[], Any]]] = {
    InputError: {
        # Coordinates
        "no coordinates and no states": lambda: System(coordinates(""), 0),
        "2 coordinates, 1 velocities, 2 accel": lambda: Coordinates(P.q, (u,), P.a),
        "coordinates: 3 must be names": lambda: coordinates(3),
        "coordinates: x must be a name": lambda: coordinates([sp.Symbol("x")]),
        "'2x' would be another symbol": lambda: coordinates("2x"),
        "x, x_ddot, x_dot repeated": lambda: coordinates("x y x"),
        "Coordinates: t repeated": lambda: coordinates("t"),
        "Coordinates: x_dot repeated": lambda: coordinates("x x_dot"),
        # Lagrangians
        "System: two different symbols are called 'theta',": lambda: System(A, v**2 / 2 + sp.cos(STRANGER)),
        "called 't'": lambda: System(A, sp.Function("q")(sp.Symbol("t")).diff() ** 2),
        "called 'x'": lambda: System(P, FLAT, (sp.Symbol("x") - y,)),
        "called 'theta_dot'": lambda: System(A, SWING, dissipation=sp.Symbol("theta_dot") ** 2),
        "called 'phi'": lambda: System(S, Frame(S).turned("x", S.q[0]).body(sp.Symbol("phi"), (1, 1, 1)).kinetic),
        "Frame: two different symbols": lambda: ground.turned("x", STRANGER),
        "L contains theta_ddot": lambda: System(A, a * q),
        r"L contains theta\(t\): .* plain symbols here": lambda: System(A, sp.Function("theta")(t) ** 2),
        r"L = 'theta_dot\*\*2' is no expression": lambda: System(A, "theta_dot**2"),
        "L = Matrix.* is no expression": lambda: System(A, sp.Matrix([v])),
        "is complex": lambda: System(A, sp.I * v**2),
        "L = oo is not finite": lambda: System(A, v**2 + sp.oo),
        "the first argument": lambda: System(SWING, A),
        # Constraints, forces and friction
        "constraints.0.: 1 = 0 binds no coordinate": lambda: System(A, SWING, (sp.S.One,)),
        "- 2 = 0 binds no coordinate": lambda: System(A, SWING, (sp.sin(q) ** 2 + sp.cos(q) ** 2 - 2,)),
        r"constraints\[1\] contains y_dot: .* give it to rolling": lambda: System(P, FLAT, (x, w - x)),
        r"constraints = x - y must be .* write \(x - y,\)": lambda: System(P, FLAT, x - y),
        r"Eq\(x, y\) is no expression": lambda: System(P, FLAT, (sp.Eq(x, y),)),
        "x has no velocity: give it to constraints": lambda: System(P, FLAT, rolling=(x,)),
        "binds no velocity": lambda: System(P, FLAT, rolling=((sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1) * u + 1,)),
        "not affine in the velocities: its reaction": lambda: System(P, FLAT, rolling=(u**2 - w,)),
        "'' in constraints is no name": lambda: System(P, FLAT, {"": x}),
        "'a' in rolling is no name": lambda: System(P, FLAT, {"a": x}, {"a": u}),
        "System: 1 forces for 2": lambda: System(P, FLAT, forces=(1,)),
        r"forces\[0\] contains theta_ddot": lambda: System(A, SWING, forces=(a,)),
        r"forces = .* must be a tuple of expressions$": lambda: System(A, SWING, forces={q: 1}),
        r"dissipation = theta\*\*2 has no velocity": lambda: System(A, SWING, dissipation=q**2),
        r"= -k\*theta_dot\*\*2 falls": lambda: System(A, SWING, dissipation=-k * v**2),
        r"3\*x_dot\*y_dot .* falls": lambda: System(P, FLAT, dissipation=u**2 + w**2 + 3 * u * w),
        "simulate: dissipation = -1.0": lambda: run(System(A, SWING, dissipation=b * v**2), VALUES | {b: -1}),
        "y without a value: the rank": lambda: degrees_of_freedom(circle, {x: 0}),
        # Velocities of one's own
        r"velocities\[w_1\] = 'x_dot' is no expression": lambda: own({w1: "x_dot"}),
        "velocities = 5 must be": lambda: own(5),
        r"velocities\[x\]: .* named by a symbol": lambda: own({x: u}),
        "cannot be redefined": lambda: own({u: 2 * u}),
        "x has no velocity of a coordinate": lambda: own({w1: x}),
        "is not affine in the velocities: write": lambda: own({w1: u**2, w2: w}),
        "contains x_ddot: write it": lambda: own({w1: P.a[0], w2: w}),
        "w_2 depends on the velocities before it": lambda: own({w1: u + w, w2: 2 * u + 2 * w}),
        "contains w_2, which is defined after it": lambda: own({w1: u + w2, w2: w}),
        "do not give x_dot, y_dot: 1 more": lambda: own({w1: u}),
        "leave some out": lambda: own({w1: u, w2: w, r: u - w}),
        "must be a finite number, of w_1": lambda: run(
            System(P, FLAT, rolling=(u - w,), velocities={w1: u}), {m: 1}, (0, 0), (1, 0)
        ),
        # Frames, joints and bodies
        "Frame: 'theta' must be Coordinates": lambda: Frame("theta"),
        "it reflects": lambda: ground.turned([[sp.cos(q), sp.sin(q), 0], [sp.sin(q), -sp.cos(q), 0], [0, 0, 1]]),
        "with R Rᵀ = 1": lambda: ground.turned([[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
        "neither letters": lambda: ground.turned(7),
        "axes 'w' and angles theta: give one angle": lambda: ground.turned("w", q),
        "turned: angle: q is none of the coordinates": lambda: ground.turned("x", "q"),
        r"moved: .* x is none of the coordinates": lambda: ground.moved("x"),
        r"moved: x, y and z are three arguments: moved\(1, 0, 0\)": lambda: ground.moved((1, 0, 0)),
        "from which this one was turned": lambda: ground.velocity(frame=ground.turned("z", 1)),
        "must be 4 names": lambda: GROUND.ball("q0 q1 q2", "p q r"),
        "must be 3 names": lambda: GROUND.ball("q0 q1 q2 q3", "p q"),
        "z is none of the coordinates": lambda: GROUND.ball("q0 q1 q2 z", "p q r"),
        "'q0 q1 q2 q2' .* different names": lambda: GROUND.ball("q0 q1 q2 q2", "p q r"),
        "another ball joint": lambda: GROUND.ball("q0 q1 q2 q3", "p q r").ball("q0 q1 q2 q3", "u v w"),
        "p is in two ball joints": lambda: jointed("p q r", "e0 e1 e2 e3", "p v w"),
        "p is a velocity of a ball joint and a symbol of": lambda: System(
            Q, GROUND.ball("q0 q1 q2 q3", "p q r").body(p, (1, 2, 2.5)).kinetic
        ),
        "a weld is fixed": lambda: ground.weld((q, 0, 0)),
        "axis = 'w'": lambda: ground.pin(q, "w"),
        "pin: axis = .* not zero": lambda: ground.pin(q, (0, 0, 0)),
        "in numbers": lambda: ground.prismatic(q, (m, 0, 0)),
        "two different letters": lambda: ground.universal(q, q, "xx"),
        "pin: angle: a is none of the coordinates": lambda: ground.pin("a"),
        "coincides: 0, 0, 0 = 0 binds no coordinate": lambda: ground.coincides(ground, (l, 0, 0), (l, 0, 0)),
        "keeps_axis: .* binds no coordinate": lambda: ground.keeps_axis(ground.turned("x", 1), (0, 3, 4)),
        "coincides: 3 must be a Frame": lambda: ground.pin(q).coincides(3),
        r"quaternion \(q0, q1, q2, q3\) has norm 1e-09": lambda: run(ball_top(), BODY, (1e-9, 0, 0, 0), (0, 0, 1)),
        "linearise: the quaternion .* has norm 0": lambda: ball_top().linearise(TURNED),
        "mass = -m must not be negative": lambda: body(-m),
        "inertia = .* must not be negative about": lambda: body(1, (1, -1, 1)),
        "no body has the inertia .*5.0": lambda: body(1, (1, 1, 5)),
        "or a symmetric": lambda: body(1, [[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
        r"inertia = \(1, 1, 1, 1\) must be": lambda: body(1, (1, 1, 1, 1)),
        "inertia = 'abc', centre": lambda: body(1, "abc"),
        r"\(1, 1, 1\) must be .* the centre": lambda: body(1, (1, 1, 1), (0, 1)),
        "body: t in a rigid body": lambda: body(m * sp.exp(-t)),
        "body: theta in a rigid body.* move its frame": lambda: body(1, (1, 1, 1), (q, 0, 0)),
        r"field = \(0, -g\) must be 3 expressions": lambda: body(1).potential((0, -g)),
        "simulate: mass = -1": lambda: top(M=-1),
        "simulate: no body has the inertia": lambda: top(I3=5),
        "simulate: inertia = .* must not be negative": lambda: top(I3=-1),
        # Contacts and force elements
        "'table' is no surface": lambda: BALL.rolls_on("table", l),
        r"Plane\(frame=3\) is no surface": lambda: BALL.rolls_on(Plane(3), l),
        "other coordinates than the body": lambda: BALL.rolls_on(Plane(Frame(P)), l),
        "radius of the surface = 'R'": lambda: BALL.rolls_on(Sphere(ground, "R"), l),
        "radius = 0 of the surface must be positive": lambda: BALL.rolls_on(Cylinder(ground, 0), l),
        "larger than the radius 3 of the ball inside": lambda: BALL.rolls_on(Sphere(ground, 1, hollow=True), 3),
        "rolls on a Plane": lambda: BALL.rolls_on(Sphere(ground, k), l, axis=(0, 0, 1)),
        "is no direction": lambda: BALL.rolls_on(Plane(ground), l, axis=(0, 0, 0)),
        "rolls_on: centre = .* 3 expressions": lambda: BALL.rolls_on(Plane(ground), l, centre=(0, 0)),
        "Pathway: a point": lambda: Pathway.line(P, (0, 0), (x, y, 0)),
        r"axis = \(0, 0, 0\), side = 1: .* a direction": lambda: Pathway.around(
            P, (2, 0, 0), (x, y, 0), 1, axis=(0, 0, 0)
        ),
        "radius = M, .* positive": lambda: Pathway.around(P, (2, 0, 0), (x, y, 0), M),
        "side = 2: .* ±1": lambda: Pathway.around(P, (2, 0, 0), (x, y, 0), 1, side=2),
        "inside the cylinder of radius 1": lambda: Pathway.around(P, (0.5, 0, 0), (x, y, 0), 1),
        "spring: stiffness = 'k' is no": lambda: LINE.spring("k"),
        "damper: the length l depends on none of": lambda: Pathway.line(P, (0, 0, 0), (0, 0, l)).damper(1),
        "force: components = .* 3 expressions": lambda: ground.force((1, 2)),
        "against = 'b' must be a Frame": lambda: ground.torque((1, 0, 0), against="b"),
        # Values, starts and times of a run
        "^consistent: ": lambda: circle.consistent(VALUES, (1, 2, 3), (0, 0)),
        "^root_locus: ": lambda: pendulum.root_locus({q: 0}, {m: 1, l: 1}, g, [-1, 1]),
        "^crossings: ": lambda: run().crossings(q - sp.Symbol("h")),
        "simulate: g without a value": lambda: run(values={m: 1, l: 1}),
        "simulate: values name lenght": lambda: run(values={"m": 1, "l": 1, "g": 10, "lenght": 2}),
        "rhs: values name lenght": lambda: pendulum.rhs({"m": 1, "l": 1, "g": 10, "lenght": 2}),
        "values give theta a value, which varies in time": lambda: run(values=VALUES | {"theta": 1}),
        "simulate: m = -1 was declared positive": lambda: run(values=VALUES | {m: -1}),
        "declared a whole number": lambda: run(System(A, UNIT - sp.Symbol("n", integer=True) * q**2), {"n": 0.5}),
        r"simulate: values = \[1, 1, 10\] must be {symbol": lambda: run(values=[1, 1, 10]),
        "m = '1' must be a number": lambda: run(values=VALUES | {m: "1"}),
        "m = 1j must be a number": lambda: run(values=VALUES | {m: 1j}),
        "m = array.* must be a number": lambda: run(values=VALUES | {m: np.ones(3)}),
        "rhs: m = 1j must be a real number": lambda: pendulum.rhs(VALUES | {m: 1j}),
        r"y = \[1, 2, 3\] must be 2 numbers": lambda: pendulum.rhs(VALUES)(0.0, [1, 2, 3]),
        "y = array.*U3": lambda: pendulum.rhs(VALUES)(0.0, np.array(["0.1", "2"])),
        r"no friction −F ∂√Q/∂v there": lambda: run(
            System(P, FLAT, forces=(-k * u / sp.sqrt(u**2 + w**2), 0)), {m: 1, k: 1}, (0, 0), (1, 2)
        ),
        r"square of one velocity w: write Abs\(w\)": lambda: run(
            System(P, FLAT, dissipation=k * sp.sqrt(u**2 + 2 * u * w + w**2)), {m: 1, k: 1}, (0, 0), (1, 2)
        ),
        "friction = 1 with 0 sliding velocities: with friction give slip": lambda: Impact(q, friction=1),
        "friction = -1 must be a coefficient": lambda: Impact(q, friction=-1, slip=u),
        "slip .*must be affine in the velocities": lambda: run(events=Impact(q, friction=1, slip=v**2)),
        r"q0 = \(1, 2\) must be a finite": lambda: run(q0=(1, 2)),
        r"q0 = array\(\[ True\]\) must be 1": lambda: run(q0=np.array([True])),
        r"v0 = \(inf,\) must be a finite": lambda: run(v0=(np.inf,)),
        r"t = \[1, 0\] must be an increasing": lambda: run(times=[1, 0]),
        r"t = \[\] must be an increasing": lambda: run(times=[]),
        "t = 5 must be an increasing array.*linspace": lambda: run(times=5),
        "tol = 2 must lie between": lambda: run(tol=2),
        "engine = 'slow' is neither": lambda: run(engine="slow"),
        "events = theta must be Event": lambda: run(events=q),
        "section = 1 is a number": lambda: Event(sp.S.One),
        "the gap l contains no coordinate": lambda: run(events=Impact(l)),
        "restitution = 2 must lie": lambda: Impact(q, sp.Integer(2)),
        "Program: two different symbols": lambda: run().evaluate(STRANGER),
        "evaluate: 'thta' is none of theta, theta_dot: theta": lambda: run().evaluate("thta"),
        "simulate: t, the times in s, is missing": lambda: pendulum.simulate(VALUES, (0.1,), T),
        "simulate: v0 is missing, and u is not zero at rest": lambda: System(
            A, UNIT, velocities={sp.Symbol("u"): v - 1}
        ).simulate({}, (0.1,), t=T),
        "evaluate: expression = Matrix.* is no": lambda: run().evaluate(sp.Matrix([q])),
        "at: times must lie between 0 and 1 s": lambda: run().at(2),
        "crossings: section = m does not change": lambda: run().crossings(m),
        "plot: the run has no times": lambda: run().crossings(q - 7).plot(),
        "load: system = None must be the System": lambda: SystemRun.load("run.npz", None),
        "the energy has no real value": lambda: run(System(A, v**2 / 2 - sp.log(q)), {}, (-1,)),
        r"besselj\(1, theta\) has no code": lambda: run(System(A, v**2 - sp.besselj(0, q)), {}),
        "the Lagrangian jumps where theta = 0": lambda: run(System(A, v**2 - sp.Heaviside(q) / 3), {}, (-0.5,), (1,)),
        "floquet: at = 'here' must be": lambda: pendulum.floquet("here", VALUES, 1),
        "the motion has not come back": lambda: pendulum.floquet({q: 1}, VALUES, 1),
        "t = nan must be a time": lambda: pendulum.floquet({q: 0, t: np.nan}, VALUES, 1),
        # Symmetry and other coordinates
        r"ξ = \(1, 0\): give one component": lambda: pendulum.noether((1, 0)),
        "ξ = 1: give one component": lambda: pendulum.noether(1),
        "without accelerations": lambda: pendulum.invariance(A.a),
        "gauge = theta_ddot contains theta_ddot": lambda: pendulum.noether((1,), a),
        "conserved: f = 'E' is no": lambda: pendulum.conserved("E"),
        "conserved: f = g must be": lambda: pendulum.conserved(g),
        "no coordinate remains": lambda: point.routh("x y"),
        "routh: phi not among": lambda: pendulum.routh("phi"),
        "routh: 3 must name": lambda: pendulum.routh(3),
        "each once": lambda: heavy_top().routh("phi phi"),
        r"routh: momenta \(phi_dot,\) .* not used yet; rename": lambda: heavy_top().routh({"phi": S.v[0]}),
        r"routh: momenta \(p_x,\) .* rename": lambda: System(P, FLAT + sp.Symbol("p_x", real=True)).routh("x"),
        r"legendre: momenta \(theta,\)": lambda: legendre(SWING, A, (q,)),
        r"legendre: momenta \(p,\) for": lambda: legendre(FLAT, P, (p,)),
        "same_as: 3 is no System": lambda: pendulum.same_as(3),
        "are not the same coordinates: .*in_coordinates": lambda: pendulum.same_as(point),
        "y neither given nor among": lambda: point.in_coordinates(A, {x: q}),
        r"give new coordinates\(…\)": lambda: pendulum.in_coordinates(3, {q: q}),
        # Equilibria
        "unknowns must be names of symbols: give": lambda: pendulum.equilibria(VALUES),
        "no phi in the system": lambda: pendulum.equilibria("phi"),
        "unknowns = 3 must be names": lambda: pendulum.equilibria(3),
        "equilibria: .* depends on time: .* simulate it": lambda: timed.equilibria(),
        "name another unknown": lambda: heavy_top().routh("phi psi").equilibria("theta"),
        "or give linearise a point": lambda: System(P, FLAT - sp.sqrt(x**2 + y**2)).equilibria(),
        "all coordinates are unknown": lambda: pendulum.equilibria("theta", box={q: (0, 1)}),
        r"equilibria: values = \[1, 2\]": lambda: boxed(values=[1, 2]),
        "equilibria: g = inf must be a finite": lambda: boxed(
            values={str(s): x for s, x in VALUES.items()} | {"g": np.inf}
        ),
        "values name z": lambda: boxed(values=VALUES | {"z": 1}),
        "g without a value: in a box": lambda: boxed(values={m: 1, l: 1}),
        "box = {} must be": lambda: boxed(box={}),
        "box = {'phi'": lambda: boxed(box={"phi": (-1, 1)}),
        "box of theta is empty": lambda: boxed(box={q: (1, -1)}),
        "box of theta = inf": lambda: boxed(box={q: (0, np.inf)}),
        "one constraint at most: rest": lambda: boxed(replace(circle, constraints=(x * y - 1, x - y)), box=BOX),
        "a force depends on the reaction of a constraint": lambda: boxed(
            replace(circle, forces=(reaction(1), 0)), box=BOX
        ),
        "with rolling, equilibria": lambda: boxed(wheel, {m: 1}, BOX),
        # Small motion
        "linearise: theta without a value": lambda: pendulum.linearise({}),
        "at = 'here' must be an equilibrium": lambda: pendulum.linearise("here"),
        "linearise: .* depends on time explicitly: .*simulate it": lambda: timed.linearise({q: 0}),
        "a residual is 3": lambda: System(P, FLAT, (x**2 + y**2 - 1,)).linearise({x: 2, y: 0}),
        "y moves there and enters": lambda: System(P, FLAT - x**2 + sp.cos(y)).linearise({x: 0, y: 0, w: 1}),
        "x = nan is not finite": lambda: point.linearise({x: np.nan}, {m: 1}),
        "{theta: k} must be numbers": lambda: pendulum.linearise({q: k}, VALUES),
        "the point has phi": lambda: pendulum.linearise({q: 0, "phi": 0}, VALUES),
        r"give it coordinates and velocities \(p, q, r\)": lambda: ball_top().linearise(UPRIGHT | {"q0_dot": 1}, BODY),
        "W in the point": lambda: ball_top().linearise(UPRIGHT | {"W": 1}),
        r"linearise: m = \[1\] must be a real": lambda: pendulum.linearise({q: 0}, VALUES | {m: [1]}),
        "values name k": lambda: pendulum.linearise({q: 0}, VALUES, (k,)),
        "the input theta moves": lambda: pendulum.linearise({q: 0}, VALUES, (q,)),
        "inputs theta are no symbols": lambda: pendulum.linearise({q: 0}, inputs=(q,)),
        "inputs = m must be a tuple": lambda: pendulum.linearise({q: 0}, VALUES, m),
        "must be different symbols": lambda: CART.linearise({ct: 0}, {m: 1}, inputs=(F, "F")),
        r"outputs\[0\] = 'theta' is no": lambda: pendulum.linearise({q: 0}, VALUES, (), ("theta",)),
        "linearise: k without a value": lambda: pendulum.linearise({q: 0}, VALUES, (), (k,)),
        "x moves there .* forces change": lambda: SPRING.linearise({x: 0, u: 1}, outputs=(x,)),
        "change with time": lambda: QUARTIC.linearise({x: 0, u: 1}, {}, outputs=(x,)),
        "psi moves there": lambda: SLOT.linearise(dict.fromkeys(S.q, 0) | {S.v[2]: k}),
        "the point is off the constraints: ": lambda: rolling_disc()[0].linearise(DISC | {"psi_dot": 1}),
        "theta moves there and enters": lambda: CART.linearise({ct: 0, cw: 1}, inputs=(F,)),
        r"write a symbol for an input F\(t\)": lambda: cart_and_pole(F * t).linearise({ct: 0}, inputs=(F,)),
        r"for a function F\(t\) write a symbol F": lambda: System(A, UNIT + v * sp.Function("F")(t).diff(t)).linearise(
            {q: 0}, inputs=(sp.Function("F")(t),)
        ),
        # Weakly nonlinear motion
        "one coordinate without constraints": lambda: point.lindstedt_poincare(2, k),
        "not the same backward": lambda: forced.lindstedt_poincare(2, k),
        "depends on time: use averaged": lambda: timed.lindstedt_poincare(2, s),
        "theta = 1 is no equilibrium": lambda: pendulum.lindstedt_poincare(2, s, at=1),
        "has no frequency": lambda: pendulum.lindstedt_poincare(2, s, at=sp.pi),
        "order = 0 must be a whole number": lambda: pendulum.lindstedt_poincare(0, s),
        "small = 's' must be a symbol": lambda: pendulum.lindstedt_poincare(2, "s"),
        "amplitude = 3 must be a symbol": lambda: pendulum.lindstedt_poincare(2, k, amplitude=3),
        "amplitude = k is a symbol": lambda: weak.lindstedt_poincare(2, k, amplitude=k),
        "amplitude = A is a symbol": lambda: System(A, UNIT - sp.Symbol("A") * k * q**4).lindstedt_poincare(2, k),
        "error: values = 3 must be": lambda: pendulum.lindstedt_poincare(2, s).error(3),
        "error: .* without a value": lambda: pendulum.lindstedt_poincare(2, s).error({s: 0.1}),
        "order = 3 must be 1 or 2": lambda: weak.averaged(3, k),
        "must be a symbol of the system, which is linear": lambda: pendulum.averaged(1, s),
        "with ν = 2": lambda: weak.averaged(1, k, frequency=2),
        "q0 = nan and v0 = 0": lambda: weak.averaged(1, k).run({k: 0.1}, np.nan, 0, [0, 1]),
        r"averaged: t = \[1, 0\]": lambda: weak.averaged(1, k).run({k: 0.1}, 1, 0, [1, 0]),
        # Systems of sympy
        "must be a LagrangesMethod": lambda: System.from_sympy("L"),
        "with its coordinates": lambda: System.from_sympy(q1.diff() ** 2),
        "must be dynamicsymbols": lambda: System.from_sympy(q1.diff() ** 2, (sp.Symbol("q1"),)),
        "must be a tuple of coordinates": lambda: System.from_sympy(q1.diff() ** 2, q1),
        "after form_eoms": lambda: System.from_sympy(TheirSystem()),
        "after kanes_equations": lambda: System.from_sympy(
            KanesMethod(ReferenceFrame("N"), [q1], [u1], [q1.diff() - u1])
        ),
        "modes: .* gives numbers": lambda: THREE.modes(),
    },
    SingularError: {
        r"not regular in psi_dot; use fewer": lambda: accelerations(S.v[0] ** 2 + S.v[1] ** 2 - S.q[2], S),
        "^System: .*y_dot": lambda: System(P, m * u**2 / 2).rhs({m: 1}),
        "^linearise: ": lambda: circle.linearise({x: 0, y: 0}, VALUES),
        "not regular in theta_dot": lambda: run(System(A, sp.cos(q)), {}),
        "not regular in x_dot, y_dot": lambda: accelerations((u * sp.cos(x) + w * sp.cos(x)) ** 2 - x**2, P),
        "no mass moves with theta_dot": lambda: run(System(A, M * v**2 - q**2), {M: 0}),
        "no mass moves with phi_dot, psi_dot": lambda: top(start=(0, 0, 0)),
        "y_dot moves no mass; use fewer coordinates": lambda: run(spun_point(), {m: 1, l: 1}, (0.1, 0), (0, 0)),
        r"sin\(theta\)": lambda: run(turning_top(), BODY | {"I_2": 0.4}, (0, 0, 0), (0, 0, 4)),
        "simulate: .* dependent .singular values of S": lambda: run(
            System(P, FLAT, (y, y - x**2)), {m: 1}, (0, 0), (0, 0)
        ),
        "simulate: .* dependent .lengths": lambda: run(System(P, FLAT, (x**2 + y**2 + 1,)), {m: 1}, (1, 0), (0, 0)),
        "det S = 0": lambda: constrained_accelerations(replace(circle, constraints=(x - y, 3 * x - 3 * y))),
        "solve_constrained: the constraints are dependent": lambda: solve_constrained(
            np.eye(3), np.zeros(3), np.array([[1.0, 2, 0], [3, 6, 1e-9]]), np.zeros(2), np.zeros(3)
        ),
        "project_velocity: .*lengths of the normals": lambda: project_velocity(np.zeros((1, 3)), np.ones(3)),
        "mass matrix is singular at this": lambda: project_velocity(np.ones((1, 3)), np.ones(3), np.zeros((3, 3))),
        "project_position": lambda: project_position(lambda q: q[:1] - 1, lambda q: 0 * q[None], np.zeros(2)),
        "does not determine the velocities": lambda: legendre((u + w) ** 2, P, sp.symbols("p:2")),
        "{theta: 1} is no equilibrium": lambda: pendulum.linearise({q: 1}),
        "theta_ddot = -8.41e-10 is not zero": lambda: pendulum.linearise({q: 1}, VALUES | {g: 1e-9}),
        "is no steady motion: .* is not zero": lambda: CART.linearise({cx: 0, ct: 1}, inputs=(F,)),
        "the constraints are dependent at": lambda: System(P, FLAT, (x**2 + y**2 - 1, x**2 + y**2 - 1)).linearise(
            {x: 1, y: 0}
        ),
        "singular at": lambda: heavy_top().routh("phi psi").linearise({heavy_top().c.q[0]: 0}),
        "the mass matrix is singular at": lambda: System(P, u**2 + x**2 * w**2 - x**2).linearise({x: 0, y: 0}),
        "the mass matrix is singular, or the constraints": lambda: pendulum.linearise({q: 0}, inputs=(m,)),
        "1 regions of the box are undecided": lambda: boxed(System(A, v**2 / 2 - q**4), {}, {q: (-1, 2)}),
        r"first about theta = 1(.|\n)*Proved elsewhere in it: theta = 2$": lambda: boxed(
            System(A, v**2 / 2, forces=((q - 1) ** 3 * (2 - q),)), {}, {q: (0.5, 3)}
        ),
        "2 regions .* the first about theta = 0.999.* or degenerate": lambda: boxed(
            System(A, v**2 / 2, forces=(sp.Abs(q) * (q - 1) ** 3,)), {}, {q: (-0.5, 3)}
        ),
        "undecided, the first about x = .*a coordinate on which no force depends": lambda: boxed(
            System(P, FLAT - x**2), {m: 1}, BOX
        ),
        "undecided, the first about x = .*, a constraint whose derivative is zero": lambda: boxed(
            System(P, FLAT - y, (x**2 - y**3,)), {m: 1}, BOX
        ),
        "k is too large there": lambda: System(A, UNIT - k * q**3 / 3).averaged(2, k).run({k: 1}, 1, 0.3, [0, 1]),
    },
    ConstraintError: {
        "off the constraints by 0.293": lambda: run(circle, VALUES, (1, 1), (0, 0)),
        r"nearest state on them is q0 = \(1, 0\), v0 = \(0, 0\)": lambda: run(circle, VALUES, (1, 0), (1, 0)),
        "off the constraints by 1; .* v0 = .0, 0, 0.": lambda: run(knife, {}, (0, 0, 0), (0, 1, 0)),
        "off the constraints": lambda: run(ball_top(), BODY, (1, 0.2, 0, 0), (0, 0, 1)),
        "the point is off the constraints; the nearest": lambda: circle.linearise({x: 1, y: 1}, VALUES),
        r"\|g\| = .* after 20 steps": lambda: project_position(
            lambda q: np.array([q @ q + 1]), lambda q: 2 * q[None, :], np.array([0.3, 0.4])
        ),
    },
    NotASymmetryError: {
        "noether: .*nonzero.*δL = .* give gauge=F": lambda: pendulum.noether((1,)),
        "does not leave the motion invariant": lambda: sleigh().noether((1, 0, 0)),
        "depends on theta: its momentum": lambda: pendulum.routh("theta"),
        "depends on y: its momentum": lambda: System(P, FLAT, dissipation=w**2).routh("y"),
        "y enters the forces": lambda: System(P, FLAT, forces=(sp.sin(y), 0)).routh("y"),
    },
    DomainError: {
        "legendre: L is not quadratic": lambda: legendre(u**2 + w**4, P, sp.symbols("p:2")),
        "lindstedt_poincare: .* is no polynomial": lambda: pendulum.lindstedt_poincare(2, m),
        "averaged: .* is no polynomial": lambda: System(A, UNIT - k * sp.exp(q)).averaged(1, k),
        "is no rational multiple of": lambda: System(A, UNIT + k * sp.sin(sp.sqrt(2) * t) * q).averaged(1, k),
        "or it has a phase": lambda: System(A, UNIT + k * sp.cos(t + 1) * q).averaged(1, k),
    },
}


CASES = [pytest.param(error, words, id=words) for error, table in REFUSED.items() for words in table]


@pytest.mark.parametrize(("error", "words"), CASES)
@pytest.mark.filterwarnings("error::lagrotor.errors.LagrotorWarning")
def test_it_is_refused_in_words(error: type[LagrotorError], words: str) -> None:
    with pytest.raises(error, match=words):
        REFUSED[error][words]()


def test_without_each_fault_the_same_calls_are_taken() -> None:
    assert np.isfinite(run().q).all() and np.isfinite(top().q).all()
    assert np.isfinite(run(circle, VALUES, (1, 0), (0, 0)).q).all()
    assert np.isfinite(run(knife, {}, (0, 0, 0), (0, 0, 1)).q).all()
    assert np.isfinite(run(values={"m": sp.Rational(1, 2), g: 9.81, l: sp.pi}).q).all()
    shared = VALUES | {k: 3}  # a table that several systems share, by symbols
    assert np.array_equal(run(values=shared).q, run().q)
    for dissipation in (k * v**2, k * sp.Abs(v), k * (v - 1) ** 2, b * v**2, k * sp.Abs(v) ** 3):
        assert System(A, SWING, dissipation=dissipation).dissipation == dissipation
    System(P, FLAT, dissipation=u**2 + w**2 + sp.Rational(19, 10) * u * w)
    assert body(1, (1, 1, 2)).mass == 1 and body(0, (0, 0, 5)).mass == 0  # a disc; motion in a plane
    assert len(jointed("p q r", "e0 e1 e2 e3", "u v w").speeds) == 6
    assert System(A, v**2, [q]).constraints == (q,)
    assert Pathway.line(P, (0, 0, 0), (t, 0, 0)).rate == sp.sign(t)  # an end that time moves
    # The same directions in units far apart are independent.
    assert np.allclose(project_velocity(np.array([[1e9, 0, 0], [0, 1e-9, 0]]), np.ones(3)), [0, 0, 1])


def test_a_function_that_the_fast_engine_does_not_know_is_named() -> None:
    pytest.importorskip("heyoka")
    for force, words in (
        (-v * sp.Abs(v), "no force that jumps"),
        (-v * sp.loggamma(2 + q**2), "the function loggamma"),
    ):
        with pytest.raises(InputError, match=f"{words}: use engine='core'"):
            run(System(A, v**2 / 2, forces=(force,)), {}, (1,), (1,), engine="fast")
