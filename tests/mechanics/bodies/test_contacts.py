"""What rolls on planes, spheres and cylinders, against closed solutions; reactions by their names."""

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import Cylinder, Frame, Plane, Sphere, System, coordinates, t

m, r, R, g, Om = sp.symbols("m r R g Omega", positive=True)
UNIFORM = (2 * m * r**2 / 5,) * 3
C = coordinates("x y z a b s")
GROUND = Frame(C)
BALL = GROUND.moved(*C.q[:3]).turned("xyz", C.q[3:]).body(mass=m, inertia=UNIFORM)
LAGRANGIAN = BALL.kinetic - BALL.potential((0, 0, -g))
VALUES = {m: 1, r: 0.2, R: 1, g: 9.81}


def test_a_ball_on_a_turntable_goes_round_in_circles_at_two_sevenths_of_its_rate() -> None:
    """Routh, Advanced Rigid Dynamics, §225."""
    c = coordinates("x y a b s")
    ground = Frame(c)
    ball = ground.moved(*c.q[:2], r).turned("xyz", c.q[2:]).body(mass=m, inertia=UNIFORM)
    contact = ball.rolls_on(Plane(ground.turned("z", Om * t)), r)
    assert contact.constraints == {}  # its coordinates keep it on the table
    system, values = System(c, ball.kinetic, rolling=contact.rolling), {m: 1, r: 0.1, Om: 3}
    q, v = system.consistent(values, (1, 0, 0, 0, 0), (0, 0.5, 0, 0, 0))
    times = np.linspace(0, 1.2, 7)
    run, w = system.simulate(values, q, v, times, 1e-9), 6 / 7
    exact = 1 + (v[0] + 1j * v[1]) * (np.exp(1j * w * times) - 1) / (1j * w)
    assert run.q[:, 0] + 1j * run.q[:, 1] == pytest.approx(exact, abs=1e-9)
    sideways = (run.reactions["along 1"] + 1j * run.reactions["along 2"]) * np.exp(
        3j * times
    )  # along axes of the table
    assert sideways == pytest.approx(1j * w * (v[0] + 1j * v[1]) * np.exp(1j * w * times), abs=1e-8)  # m a


def test_a_ball_leaves_a_sphere_where_nothing_presses_it() -> None:
    """From rest at the angle α it leaves at cos θ = 10/17 cos α."""
    contact = BALL.rolls_on(Sphere(GROUND, R), r)
    system = System(C, LAGRANGIAN, constraints=contact.constraints, rolling=contact.rolling)
    assert [str(s) for s in system.multipliers] == ["lambda_normal", "lambda_along_1", "lambda_along_2"]
    q, v = system.consistent(VALUES, (1.2 * np.sin(0.3), 0, 1.2 * np.cos(0.3), 0, 0, 0), (0,) * 6)
    run = system.simulate(VALUES, q, v, np.linspace(0, 1.2, 61), 1e-8)
    pressed, height = run.reactions["normal"], run.q[:, 2] / 1.2
    i = int(np.argmax(pressed < 0))
    left = np.interp(0, [pressed[i], pressed[i - 1]], [height[i], height[i - 1]])
    assert left == pytest.approx(10 / 17 * np.cos(0.3), abs=1e-6)
    assert run.drift.max() < 1e-9


def test_a_ball_in_an_upright_pipe_comes_up_again() -> None:
    """Rolling inside a cylinder it falls and rises at the rate √(2/7) φ'. Neimark & Fufaev, ch. III, §3."""
    contact = BALL.rolls_on(Cylinder(GROUND, R, hollow=True), r)
    system = System(C, LAGRANGIAN, constraints=contact.constraints, rolling=contact.rolling)
    q, v = system.consistent(VALUES, (0.8, 0, 0, 0, 0, 0), (0, 3, 0, 0, 0, 0))
    times = np.linspace(0, 1, 11)
    run, w = system.simulate(VALUES, q, v, times, 1e-8), np.sqrt(2 / 7) * v[1] / 0.8
    assert run.q[:, 2] == pytest.approx(-5 / 7 * 9.81 / w**2 * (1 - np.cos(w * times)), abs=1e-7)
    assert run.reactions["normal"] == pytest.approx(np.full(11, v[1] ** 2 / 0.8), abs=1e-6)


def test_a_disc_stands_from_its_least_speed_on() -> None:
    """A thin disc that rolls straight on is stable for ψ'² > g/(3 r). Neimark & Fufaev, ch. VI."""
    disc = GROUND.moved(*C.q[:3]).turned("zxy", C.q[3:]).body(m, (m * r**2 / 4, m * r**2 / 2, m * r**2 / 4))
    contact = disc.rolls_on(Plane(GROUND), r, axis=(0, 1, 0))
    system = System(C, disc.kinetic - disc.potential((0, 0, -g)), contact.constraints, contact.rolling)
    least = np.sqrt(9.81 / 0.6)
    for factor, stable in ((0.99, False), (1.01, True)):
        spin = factor * least
        at = dict.fromkeys(C.q, 0.0) | {C.q[2]: 0.2, C.v[5]: spin, C.v[0]: 0.2 * spin}
        assert (system.linearise(at, {m: 1, r: 0.2, g: 9.81}).rates.real.max() < 1e-6) == stable


def test_names_go_with_their_constraints() -> None:
    c = coordinates("x y")
    x, y = c.q
    rod = System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - m * g * y, {"rod": sp.sqrt(x**2 + y**2) - R})
    run = rod.simulate(VALUES, (0, -1), (2, 0), np.linspace(0, 1, 5), 1e-9)
    assert run.reactions["rod"] == pytest.approx(
        -(run.v**2).sum(1) + 9.81 * run.q[:, 1], abs=1e-7
    )  # a pull is negative
    assert list(System(c, rod.L, rod.constraints).multipliers) == sp.symbols(["lambda_1"], real=True)
    two = System(c, rod.L, {"a": x - y}, {"b": c.v[0] - 1})
    assert two.names == ("a", "b") and two.in_coordinates(coordinates("x"), {y: x}).names == ("b",)
    for constraints, rolling, words in (
        ({"": x}, (), "no name"),
        ({1: x}, (), "no name"),
        ({"a": x}, {"a": c.v[0]}, "no name"),
        ({"a": "x"}, (), "no expression"),
    ):
        with pytest.raises(InputError, match=words):
            System(c, rod.L, constraints, rolling)


SWING = coordinates("phi")
STOPS = {
    "Heaviside": 500 * sp.sin(SWING.q[0]) ** 2 * sp.Heaviside(sp.sin(SWING.q[0])),
    "Max": 500 * sp.Max(0, sp.sin(SWING.q[0])) ** 2,
    "Hertz": 500 * sp.Max(0, sp.sin(SWING.q[0])) ** sp.Rational(5, 2),
    "Abs": 5 * sp.Abs(SWING.q[0] - sp.Rational(1, 10)) ** 3 + sp.Abs(SWING.q[0]),
}


@pytest.mark.parametrize("kind", STOPS)
def test_a_stop_beside_bodies_is_one_of_the_lagrangian_without(kind: str) -> None:
    """Its surface is passed exactly, as in a Lagrangian of a coordinate: twin, a potential that jumps is refused."""
    bar = Frame(SWING).turned("z", SWING.q).body(mass=1, inertia=(1, 1, 1))
    plain, times = SWING.v[0] ** 2 / 2, np.linspace(0, 3, 7)
    bodies, alone = (
        System(SWING, kinetic - STOPS[kind]).simulate({}, (-0.5,), (1,), times) for kinetic in (bar.kinetic, plain)
    )
    assert bodies.q == pytest.approx(alone.q, abs=1e-9) and bodies.error < 1e-8
    assert np.abs(bodies.q - System(SWING, plain).simulate({}, (-0.5,), (1,), times).q).max() > 0.1
    for kinetic in (bar.kinetic, plain):
        with pytest.raises(InputError, match="the Lagrangian jumps where phi = 0"):
            System(SWING, kinetic - sp.Heaviside(SWING.q[0]) / 3).simulate({}, (-0.5,), (1,), times)
