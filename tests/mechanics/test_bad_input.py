"""Bad input of a hundred kinds: each is refused in words that name it, none ends in another error, none is accepted."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.mechanics import (
    Coordinates,
    Event,
    Frame,
    Impact,
    Pathway,
    System,
    SystemRun,
    coordinates,
    legendre,
    t,
)

m, l, g, k = sp.symbols("m l g k", positive=True)
b, M = sp.symbols("b M", real=True)
A, P, S = coordinates("theta"), coordinates("x y"), coordinates("phi theta psi")
(q,), (v,), (a,) = A.q, A.v, A.a
(x, y), (u, w) = P.q, P.v
T = np.linspace(0, 1, 3)
STRANGER = sp.Symbol("theta")  # of the name of a coordinate, and not it
SWING = m * l**2 * v**2 / 2 + m * g * l * sp.cos(q)
FLAT = m * (u**2 + w**2) / 2
VALUES = {m: 1, l: 1, g: 10}
pendulum, point = System(A, SWING), System(P, FLAT)
weak = System(A, v**2 / 2 - q**2 / 2 - k * q**4)
circle = System(P, FLAT - m * g * y, (x**2 + y**2 - l**2,))
knife = System(S, (S.v[0] ** 2 + S.v[1] ** 2 + S.v[2] ** 2) / 2, rolling=(S.v[0] * sp.sin(S.q[2]) - S.v[1],))
ground = Frame(A)


def body(*given: Any, **named: Any) -> Any:
    return ground.turned("x", q).body(*given, **named)


def run(
    system: System = pendulum, values: Any = VALUES, q0: Any = (0.1,), v0: Any = (0,), times: Any = T, **more: Any
) -> Any:
    return system.simulate(values, q0, v0, times, **more)


def top(**values: Any) -> Any:
    I1, I3 = sp.symbols("I1 I3", real=True)
    made = Frame(S).turned("zxz", S.q).body(M, (I1, I1, I3), (0, 0, l))
    system = System(S, made.kinetic - made.potential((0, 0, -g)))
    start = values.pop("start", (0, 0.5, 0))
    return system.simulate({"M": 1, "l": 1, "g": 10, "I1": 1, "I3": 1} | values, start, (0, 0, 9), T)


BAD: dict[str, Callable[[], Any]] = {
    # Coordinates
    "no name": lambda: coordinates(""),
    "a number for names": lambda: coordinates(3),  # type: ignore[arg-type]
    "symbols for names": lambda: coordinates([sp.Symbol("x")]),  # type: ignore[list-item]
    "a name twice": lambda: coordinates("x y x"),
    "the time as a coordinate": lambda: coordinates("t"),
    "a coordinate that is another's velocity": lambda: coordinates("x x_dot"),
    "fewer velocities than coordinates": lambda: Coordinates(P.q, (u,), P.a),
    # Lagrangians
    "another theta in L": lambda: System(A, v**2 / 2 + sp.cos(STRANGER)),
    "another theta_dot in L": lambda: System(A, sp.Symbol("theta_dot") ** 2 / 2),
    "another time in L": lambda: System(A, v**2 / 2 + sp.cos(sp.Symbol("t")) * q),
    "another theta in a force": lambda: System(A, v**2 / 2, forces=(STRANGER,)),
    "another theta_ddot in a force": lambda: System(A, v**2 / 2, forces=(sp.Symbol("theta_ddot"),)),
    "another theta in a constraint": lambda: System(P, FLAT, (sp.Symbol("x") - y,)),
    "another theta in a rolling constraint": lambda: System(P, FLAT, rolling=(u - sp.Symbol("y_dot"),)),
    "another theta in a dissipation": lambda: System(A, SWING, dissipation=v**2 * STRANGER**2),
    "another theta turns a frame": lambda: ground.turned("x", STRANGER),
    "another theta is a mass": lambda: System(A, body(STRANGER, (1, 1, 1)).kinetic),
    "another theta in a field": lambda: System(A, body(1, (1, 1, 1)).kinetic - body(1).potential((0, 0, STRANGER))),
    "an acceleration in L": lambda: System(A, a * q),
    "a function of time in L": lambda: System(A, sp.Function("theta")(t) ** 2),
    "text for L": lambda: System(A, "theta_dot**2"),  # type: ignore[arg-type]
    "nothing for L": lambda: System(A, None),  # type: ignore[arg-type]
    "a matrix for L": lambda: System(A, sp.eye(2)),  # type: ignore[arg-type]
    "a complex L": lambda: System(A, sp.I * v**2),
    "an infinite L": lambda: System(A, v**2 + sp.oo),
    "L first": lambda: System(SWING, A),  # type: ignore[arg-type]
    "no velocity in L": lambda: run(System(A, sp.cos(q)), {}),
    "a velocity that moves nothing": lambda: run(System(P, u**2 - x**2), {}, (0, 0), (0, 0)),
    "a mass matrix of rank one, hidden": lambda: run(
        System(P, (u * sp.cos(x) + w * sp.cos(x)) ** 2 - x**2), {}, (0, 0), (0, 0)
    ),
    "a mass of zero by its value": lambda: run(System(A, M * v**2 - q**2), {M: 0}),
    "a mass that is zero at the start": lambda: run(System(P, u**2 * x**2 + w**2), {}, (0, 0), (1, 0)),
    "angles at their pole": lambda: top(start=(0, 0, 0)),
    # Constraints
    "the constraint 1 = 0": lambda: System(A, SWING, (sp.S.One,)),
    "the constraint 0 = 0": lambda: System(A, SWING, (sp.S.Zero,)),
    "sin² + cos² = 2": lambda: System(A, SWING, (sp.sin(q) ** 2 + sp.cos(q) ** 2 - 2,)),
    "a constraint on time": lambda: System(A, SWING, (t - 1,)),
    "a constraint on a parameter": lambda: System(A, SWING, (m - 1,)),
    "a velocity in a constraint": lambda: System(P, FLAT, (u,)),
    "a constraint that is no tuple": lambda: System(P, FLAT, x - y),  # type: ignore[arg-type]
    "an equation for a constraint": lambda: System(P, FLAT, (sp.Eq(x, y),)),  # type: ignore[arg-type]
    "no velocity in a rolling constraint": lambda: System(P, FLAT, rolling=(x,)),
    "a rolling constraint that cancels": lambda: System(
        P, FLAT, rolling=((sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1) * u + 1,)
    ),
    "a square of a velocity that rolls": lambda: System(P, FLAT, rolling=(u**2 - w,)),
    "the same constraint twice": lambda: run(System(P, FLAT, (x - y, 2 * x - 2 * y)), {m: 1}, (0, 0), (0, 0)),
    "a constraint nowhere satisfied": lambda: run(System(P, FLAT, (x**2 + y**2 + 1,)), {m: 1}, (1, 0), (0, 0)),
    "a start off the constraint": lambda: run(circle, VALUES, (1, 1), (0, 0)),
    "a velocity off the constraint": lambda: run(circle, VALUES, (1, 0), (1, 0)),
    "a start off what rolls": lambda: run(knife, {}, (0, 0, 0), (0, 1, 0)),
    # Forces and friction
    "a force too few": lambda: System(P, FLAT, forces=(1,)),
    "an acceleration in a force": lambda: System(A, SWING, forces=(a,)),
    "a force that is no tuple": lambda: System(A, SWING, forces=q),  # type: ignore[arg-type]
    "a text for a force": lambda: System(A, SWING, forces=("q",)),  # type: ignore[arg-type]
    "a dissipation of the place": lambda: System(A, SWING, dissipation=q**2),
    "a dissipation that feeds": lambda: System(A, SWING, dissipation=-k * v**2),
    "a dissipation of the first degree": lambda: System(A, SWING, dissipation=k * v),
    "a dissipation of the third degree": lambda: System(A, SWING, dissipation=k * v**3),
    "a dissipation with the sign of a place": lambda: System(A, SWING, dissipation=q * v**2),
    "a dissipation that is not definite": lambda: System(P, FLAT, dissipation=u**2 + w**2 + 3 * u * w),
    "a dissipation that feeds by its value": lambda: run(System(A, SWING, dissipation=b * v**2), VALUES | {b: -1}),
    # Frames and bodies
    "a mirror for a rotation": lambda: ground.turned(sp.diag(1, 1, -1)),
    "a mirror that turns": lambda: ground.turned(
        sp.Matrix([[sp.cos(q), sp.sin(q), 0], [sp.sin(q), -sp.cos(q), 0], [0, 0, 1]])
    ),
    "a stretch for a rotation": lambda: ground.turned(sp.diag(2, 1, 1)),
    "a rotation of the plane": lambda: ground.turned(sp.eye(2)),
    "no such axis": lambda: ground.turned("w", q),
    "an angle too few": lambda: ground.turned("xyz", (q, q)),
    "an angle of text": lambda: ground.turned("x", "q"),
    "a shift of text": lambda: ground.moved("x"),
    "a frame of no coordinates": lambda: Frame("theta"),  # type: ignore[arg-type]
    "a negative mass": lambda: body(-1),
    "a negative mass of letters": lambda: body(-m),
    "a negative inertia": lambda: body(1, (1, -1, 1)),
    "an inertia that no body has": lambda: body(1, (1, 1, 5)),
    "a full inertia that no body has": lambda: body(1, [[1, 0, 0], [0, 1, 2], [0, 2, 1]]),
    "an inertia that is not symmetric": lambda: body(1, [[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
    "four inertias": lambda: body(1, (1, 1, 1, 1)),
    "an inertia of text": lambda: body(1, "abc"),
    "a centre in the plane": lambda: body(1, (1, 1, 1), (0, 1)),
    "a mass that depends on a coordinate": lambda: body(1 + q**2),
    "a mass that depends on a velocity": lambda: body(1 + v**2),
    "a mass that depends on time": lambda: body(m * sp.exp(-t)),
    "an inertia that depends on a coordinate": lambda: body(1, (q**2, 1, 1)),
    "a field in the plane": lambda: body(1).potential((0, -g)),
    "a negative mass by its value": lambda: top(M=-1),
    "an inertia that no body has, by its values": lambda: top(I3=5),
    "a negative inertia by its value": lambda: top(I3=-1),
    # Values
    "a value too few": lambda: run(values={m: 1, l: 1}),
    "a misspelt value beside the right one": lambda: run(values={"m": 1, "l": 1, "g": 10, "lenght": 2}),
    "a name of nothing": lambda: run(values={"m": 1, "l": 1, "g": 10, "k": 2}),
    "a value of a coordinate": lambda: run(values=VALUES | {"theta": 1}),
    "a value of the time": lambda: run(System(A, SWING + t * q), VALUES | {"t": 1}),
    "a negative value of what is positive": lambda: run(values=VALUES | {m: -1}),
    "a fraction for a whole number": lambda: run(System(A, v**2 / 2 - sp.Symbol("n", integer=True) * q**2), {"n": 0.5}),
    "values as a list": lambda: run(values=[1, 1, 10]),
    "a value of text": lambda: run(values=VALUES | {m: "1"}),
    "a value that is no number": lambda: run(values=VALUES | {m: float("nan")}),
    "an infinite value": lambda: run(values=VALUES | {m: np.inf}),
    "a complex value": lambda: run(values=VALUES | {m: 1j}),
    "an array for a value": lambda: run(values=VALUES | {m: np.ones(3)}),
    "nothing for a value": lambda: run(values=VALUES | {m: None}),
    "a misspelt name of a right-hand side": lambda: pendulum.rhs({"m": 1, "l": 1, "g": 10, "lenght": 2}),
    "a right-hand side of three numbers": lambda: pendulum.rhs(VALUES)(0.0, [1, 2, 3]),
    "a right-hand side of text": lambda: pendulum.rhs(VALUES)(0.0, ["a", 2]),
    "a right-hand side of an array of text": lambda: pendulum.rhs(VALUES)(0.0, np.array(["0.1", "2"])),
    "a right-hand side of complex numbers": lambda: pendulum.rhs(VALUES)(0.0, np.array([0.1, 2j])),
    "dry friction in two directions": lambda: run(
        System(P, FLAT, dissipation=k * sp.sqrt(u**2 + w**2)), {m: 1, k: 1}, (0, 0), (1, 2)
    ),
    "a list of values for a box": lambda: pendulum.equilibria(values=[1, 2], box={q: (-1, 1)}),  # type: ignore[arg-type]
    "a negative value of a right-hand side": lambda: pendulum.rhs(VALUES | {l: -1}),
    # Starts and times
    "two coordinates for one": lambda: run(q0=(1, 2)),
    "truth for a place": lambda: run(q0=(True,)),
    "truths for places": lambda: run(q0=np.array([True])),
    "nothing for a velocity": lambda: run(v0=None),
    "a place that is no number": lambda: run(q0=(np.nan,)),
    "an infinite velocity": lambda: run(v0=(np.inf,)),
    "times that fall": lambda: run(times=[1, 0]),
    "a time twice": lambda: run(times=[0, 0]),
    "a table of times": lambda: run(times=[[0, 1]]),
    "no time": lambda: run(times=[]),
    "a negative tolerance": lambda: run(tol=-1e-9),
    "a tolerance of one": lambda: run(tol=2),
    "a tolerance of text": lambda: run(tol="1e-9"),
    "no such engine": lambda: run(engine="slow"),
    "an event that is none": lambda: run(events=q),
    "a section that is a number": lambda: Event(sp.S.One),
    "a gap without a coordinate": lambda: run(events=Impact(l)),
    "a restitution above one": lambda: Impact(q, sp.Integer(2)),
    # What is asked of a system and a run
    "a section of another theta": lambda: run(events=Event(STRANGER - 1)),
    "a stranger along a run": lambda: run().evaluate(STRANGER),
    "text along a run": lambda: run().evaluate("theta"),
    "a time beyond a run": lambda: run().at(2),
    "a field of two components": lambda: pendulum.noether((1, 0)),
    "what is no symmetry": lambda: pendulum.noether((1,)),
    "a momentum that is not conserved": lambda: pendulum.routh("theta"),
    "every coordinate ignored": lambda: point.routh("x y"),
    "a coordinate of nothing ignored": lambda: pendulum.routh("phi"),
    "a number ignored": lambda: pendulum.routh(3),
    "values for unknowns": lambda: pendulum.equilibria(VALUES),
    "an unknown that is none": lambda: pendulum.equilibria("phi"),
    "equilibria in time": lambda: System(A, SWING + t * q).equilibria(),
    "small motion off an equilibrium": lambda: pendulum.linearise({q: 1}),
    "small motion at no point": lambda: pendulum.linearise({}),
    "small motion at a text": lambda: pendulum.linearise("here"),  # type: ignore[arg-type]
    "small motion in time": lambda: System(A, SWING + t * q).linearise({q: 0}),
    "numbers at a text": lambda: pendulum.linearise("here", VALUES),  # type: ignore[arg-type]
    "numbers at no number": lambda: point.linearise({x: np.nan}, {m: 1}),
    "numbers at a letter": lambda: pendulum.linearise({q: k}, VALUES),
    "numbers at a stranger": lambda: pendulum.linearise({q: 0, "phi": 0}, VALUES),
    "numbers of a list": lambda: pendulum.linearise({q: 0}, [1, 1, 10]),  # type: ignore[arg-type]
    "numbers off an equilibrium": lambda: pendulum.linearise({q: 1}, VALUES),
    "numbers off a small one": lambda: pendulum.linearise({q: 1}, VALUES | {g: 1e-9}),
    "numbers off the constraint": lambda: circle.linearise({x: 1, y: 1}, VALUES),
    "an input that is none": lambda: pendulum.linearise({q: 0}, VALUES, (k,)),
    "a coordinate for an input": lambda: pendulum.linearise({q: 0}, VALUES, (q,)),
    "an input that is no tuple": lambda: pendulum.linearise({q: 0}, VALUES, m),  # type: ignore[arg-type]
    "an output of text": lambda: pendulum.linearise({q: 0}, VALUES, (), ("theta",)),  # type: ignore[arg-type]
    "an output of a stranger": lambda: pendulum.linearise({q: 0}, VALUES, (), (k,)),
    "inputs of symbols": lambda: pendulum.linearise({q: 0}, inputs=(m,)),  # type: ignore[call-overload]
    "a box with a value too few": lambda: pendulum.equilibria(values={m: 1, l: 1}, box={q: (-1, 1)}),
    "a box of nothing": lambda: pendulum.equilibria(values=VALUES, box={}),
    "a box of another coordinate": lambda: pendulum.equilibria(values=VALUES, box={"phi": (-1, 1)}),
    "an empty box": lambda: pendulum.equilibria(values=VALUES, box={q: (1, -1)}),
    "an infinite box": lambda: pendulum.equilibria(values=VALUES, box={q: (0, np.inf)}),
    "a box of text": lambda: pendulum.equilibria(values=VALUES, box={q: ("a", "b")}),
    "a box that is none": lambda: pendulum.equilibria(values=VALUES, box=3),  # type: ignore[arg-type]
    "a box under two constraints": lambda: System(circle.c, circle.L, constraints=(x**2 + y**2 - 1, x - y)).equilibria(
        values=VALUES, box={x: (-1, 1), y: (-1, 1)}
    ),
    "a box in time": lambda: System(A, SWING + t * q).equilibria(values=VALUES, box={q: (-1, 1)}),
    "a box with a degenerate rest": lambda: System(A, v**2 / 2 - q**4).equilibria(values={}, box={q: (-1, 2)}),
    "an orbit of text": lambda: pendulum.floquet("here", VALUES, 1),  # type: ignore[arg-type]
    "an orbit that is open": lambda: pendulum.floquet({q: 1}, VALUES, 1),
    "an orbit of a list": lambda: pendulum.floquet({q: 0}, [1, 1, 10], 1),  # type: ignore[arg-type]
    "a comparison with nothing": lambda: pendulum.same_as(3),  # type: ignore[arg-type]
    "a comparison in other coordinates": lambda: pendulum.same_as(point),
    "a coordinate that is lost": lambda: point.in_coordinates(A, {x: q}),
    "momenta that are taken": lambda: legendre(SWING, A, (q,)),
    "a first integral of text": lambda: pendulum.conserved("E"),  # type: ignore[arg-type]
    # Doors
    "an infinite value in a box": lambda: pendulum.equilibria(values=VALUES | {"g": np.inf}, box={q: (-1, 1)}),
    "a letter of no system in a box": lambda: pendulum.equilibria(values=VALUES | {"z": 1}, box={q: (-1, 1)}),
    "an equilibrium's velocity": lambda: pendulum.equilibria("theta_dot"),
    "a number for unknowns": lambda: pendulum.equilibria(3),  # type: ignore[arg-type]
    "whether an acceleration is conserved": lambda: pendulum.conserved(a),
    "whether a letter is conserved": lambda: pendulum.conserved(g),
    "old coordinates for new": lambda: pendulum.in_coordinates(3, {q: q}),  # type: ignore[arg-type]
    "a run of nothing": lambda: SystemRun.load("run.npz", None),  # type: ignore[arg-type]
    "an energy that is not real": lambda: run(System(A, v**2 / 2 - sp.log(q)), {}, (-1,)),
    "a section that does not change": lambda: run().crossings(m),
    "a picture of no crossing": lambda: run().crossings(q - 7).plot(),
    "an input that moves": lambda: pendulum.linearise({q: 0}, VALUES, inputs=(q,)),
    "small motion at nothing": lambda: pendulum.linearise({q: None}),
    "numbers of a row": lambda: pendulum.linearise({q: 0}, VALUES | {m: [1]}),
    "a complex value of a rate": lambda: pendulum.rhs(VALUES | {m: 1j}),
    "an orbit from no time": lambda: pendulum.floquet({q: 0, t: np.nan}, VALUES, 1),
    "a number for the amplitude": lambda: pendulum.lindstedt_poincare(2, k, amplitude=3),  # type: ignore[arg-type]
    "values of a series in a number": lambda: pendulum.lindstedt_poincare(2, k).error(3),  # type: ignore[arg-type]
    "an averaged motion from nan": lambda: weak.averaged(1, k).run({k: 0.1}, np.nan, 0, [0, 1]),
    "an averaged motion at no time": lambda: weak.averaged(1, k).run({k: 0.1}, 1, 0, []),
    "an averaged motion backward": lambda: weak.averaged(1, k).run({k: 0.1}, 1, 0, [1, 0]),
    "a loop closed on a number": lambda: Frame(A).pin(q).coincides(3),  # type: ignore[arg-type]
    "an axis kept along nothing": lambda: Frame(A).pin(q).keeps_axis(None),  # type: ignore[arg-type]
    "a radius without a sign": lambda: Pathway.around(P, (2, 0, 0), (x, y, 0), M),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.filterwarnings("error::lagrotor.errors.LagrotorWarning")
def test_bad_input_is_refused_in_words(name: str) -> None:
    with pytest.raises(LagrotorError) as refusal:
        BAD[name]()
    assert len(str(refusal.value)) > 30


def test_a_hundred_kinds_are_tried_and_their_neighbours_are_accepted() -> None:
    """Without each fault the same calls are taken."""
    assert len(BAD) >= 100
    assert np.isfinite(run().q).all() and np.isfinite(top().q).all()
    assert np.isfinite(run(circle, VALUES, (1, 0), (0, 0)).q).all()
    assert np.isfinite(run(knife, {}, (0, 0, 0), (0, 0, 1)).q).all()
    shared = VALUES | {k: 3}  # a table that several systems share, by symbols
    assert np.array_equal(run(values=shared).q, run().q)
    for dissipation in (k * v**2, k * sp.Abs(v), k * (v - 1) ** 2, b * v**2, k * sp.Abs(v) ** 3):
        assert System(A, SWING, dissipation=dissipation).dissipation == dissipation
    System(P, FLAT, dissipation=u**2 + w**2 + sp.Rational(19, 10) * u * w)
    assert body(1, (1, 1, 2)).mass == 1 and body(0, (0, 0, 5)).mass == 0  # a disc; motion in a plane


@pytest.mark.parametrize(
    ("door", "call"),
    {
        "consistent": lambda: circle.consistent(VALUES, (1, 2, 3), (0, 0)),
        "linearise": lambda: circle.linearise({x: 0, y: 0}, VALUES),
        "root_locus": lambda: pendulum.root_locus({q: 0}, {m: 1, l: 1}, g, [-1, 1]),
        "crossings": lambda: run().crossings(q - sp.Symbol("h")),
        "System": lambda: System(P, m * u**2 / 2).rhs({m: 1}),
    }.items(),
)
def test_a_refusal_names_the_door(door: str, call: Callable[[], Any]) -> None:
    with pytest.raises(LagrotorError, match=f"^{door}: "):
        call()


def test_a_kinetic_energy_that_is_negative_is_said() -> None:
    """A Lagrangian may have one, as that of a geodesic in spacetime; a mass has not."""
    with pytest.warns(LagrotorWarning, match="negative"):
        moved = run(System(A, M * v**2 / 2 - q**2 / 2), {M: -1})
    assert moved.q[:, 0] == pytest.approx(0.1 * np.cosh(moved.t), rel=1e-5)


def unit_quaternion() -> System:
    """A body that turns about its centre, by the four components of a quaternion of length one."""
    c = coordinates("q0 q1 q2 q3")
    q0, q1, q2, q3 = c.q
    turning = 2 * sp.Matrix([[-q1, q0, q3, -q2], [-q2, -q3, q0, q1], [-q3, q2, -q1, q0]]) * sp.Matrix(c.v)
    inertia = sp.diag(*sp.symbols("A B C", positive=True))
    return System(c, turning.dot(inertia * turning) / 2, (q0**2 + q1**2 + q2**2 + q3**2 - 1,))


@pytest.mark.parametrize("size", [1.0, 1e-6])
def test_a_unit_quaternion_moves_as_eulers_equations(size: float) -> None:
    """M has rank three, and the length binds the fourth; small inertias lose no digits."""
    from scipy.integrate import solve_ivp

    system, I = unit_quaternion(), size * np.array([1.0, 2.0, 2.5])
    values = dict(zip("ABC", I, strict=True))
    start = (0, 0.1, 0.5, 0.25)
    found = system.simulate(values, (1, 0, 0, 0), start, [0, 1, 2], 1e-10)
    q, qd = found.q, found.v
    spin = 2 * np.stack(
        [
            q[:, 0] * qd[:, i] - q[:, i] * qd[:, 0] - q[:, j] * qd[:, k] + q[:, k] * qd[:, j]
            for i, j, k in ((1, 2, 3), (2, 3, 1), (3, 1, 2))
        ]
    )
    known = solve_ivp(
        lambda s, w: -np.cross(w, I * w) / I,
        (0, 2),
        2 * np.array(start[1:]),
        "DOP853",
        [0, 1, 2],
        rtol=1e-12,
        atol=1e-13,
    ).y
    np.testing.assert_allclose(spin, known, rtol=0, atol=1e-8)
    assert found.drift.max() < 1e-12


def test_a_massless_slider_is_held_by_its_constraint() -> None:
    """A bead of mass 1 at x drives a massless one at y along x + y² = 0 with both weights: x alone has an equation."""
    system = System(P, u**2 / 2 - x - y, (x + y**2,))
    found = system.simulate({}, (-1, 1), (0, 0), T, 1e-11)
    # x = −y²: 4 y² y'' + 4 y y'² = 2 y − 1.
    from scipy.integrate import solve_ivp

    known = solve_ivp(
        lambda s, z: (z[1], ((2 * z[0] - 1) / 4 - z[0] * z[1] ** 2) / z[0] ** 2),
        (0, 1),
        (1, 0),
        "DOP853",
        T,
        rtol=1e-12,
    ).y[0]
    np.testing.assert_allclose(found.q[:, 1], known, rtol=1e-7)
    with pytest.raises(LagrotorError, match="singular"):
        System(P, u**2 / 2 - x - y).simulate({}, (-1, 1), (0, 0), T)


def test_what_the_constraints_alone_bind_where_the_mass_is_lost_moves() -> None:
    """Two links in line, the first without mass, welded: M is regular beside the weld and singular on it."""
    c = coordinates("p q")
    first = Frame(c).turned("x", c.q[0])
    mass = first.moved(0, 0, -1).turned("x", c.q[1]).body(m, centre=(0, 0, -1))
    L = mass.kinetic - mass.potential((0, 0, -g))
    welded = System(c, System(c, L).L, (c.q[1],)).simulate({m: 1, g: 10}, (0.1, 0), (0, 0), T, 1e-11)
    single = System(A, 2 * m * v**2 + 2 * m * g * sp.cos(q)).simulate({m: 1, g: 10}, (0.1,), (0,), T, 1e-11)
    np.testing.assert_allclose(welded.q[:, 0], single.q[:, 0], rtol=1e-9)
    with pytest.raises(LagrotorError, match="write the energies out"):
        System(c, L, (c.q[1],)).simulate({m: 1, g: 10}, (0.1, 0), (0, 0), T)
