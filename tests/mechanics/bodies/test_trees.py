"""The articulated-body recursion against the mass matrix of the same Lagrangian, on random trees, with and without loops."""

import sys
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.algebra.subexpressions import forget
from lagrotor.mechanics import Frame, System, coordinates, motion_program, t
from lagrotor.mechanics.bodies.moving_frames import turn_matrix
from lagrotor.mechanics.bodies.trees import tree_of
from lagrotor.mechanics.running.programs import energy_program, parameter_values
from lagrotor.numerics import operations
from lagrotor.numerics.codegen import reduce_common
from lagrotor.numerics.printers import compile_program
from tests.systems import I1, I2, I3, VALUES, chain, g, k, l, m

GRAVITY = (0, 0, -g)
KNOWN = {s: VALUES[s] for s in (m, l, g, k, I1, I2, I3)}


def derivative(system: System, y: np.ndarray) -> np.ndarray:
    given = motion_program(system)
    return np.array(given.rhs(*parameter_values(given, KNOWN))(0.0, y[: len(given.states)]))


def energy(system: System, y: np.ndarray) -> float:
    given = energy_program(system)
    return float(compile_program(given.program)(*y[: len(given.states)], *parameter_values(given, KNOWN))[0])


def plain(system: System) -> System:
    """The same system with its Lagrangian as an expression: no tree to be seen."""
    return System(system.c, system.L, system.constraints, system.rolling, system.dissipation, system.forces)


def assert_same_motion(system: System, seed: int = 1) -> None:
    assert tree_of(system) is not None and tree_of(plain(system)) is None
    y = np.random.default_rng(seed).uniform(-1, 1, 2 * len(system.c.q) + 1)  # the last, a time
    by_tree, by_mass = derivative(system, y), derivative(plain(system), y)
    np.testing.assert_allclose(by_tree, by_mass, rtol=1e-9, atol=1e-9 * np.abs(by_mass).max())
    assert energy(system, y) == pytest.approx(energy(plain(system), y), rel=1e-10, abs=1e-10)


def gyroscopes(n: int) -> System:
    """A chain of gyroscopes, each on the tip of the one before, two angles and a spin."""
    c = coordinates([f"{s}{i}" for i in range(n) for s in ("a", "b", "s")])
    frame, L = Frame(c), sp.S.Zero
    for i in range(n):
        axis = frame.turned("xy", c.q[3 * i : 3 * i + 2])
        rotor = axis.turned("z", c.q[3 * i + 2]).body(m, (I1, I1, I3), (0, 0, l / 2))
        L, frame = L + rotor.kinetic - rotor.potential(GRAVITY), axis.moved(0, 0, l)
    return System(c, L)


@pytest.mark.parametrize(
    "system",
    [chain(3), gyroscopes(1), pytest.param(gyroscopes(2), marks=pytest.mark.slow)],
    ids=["pendulum", "gyroscope", "two"],
)
def test_chains_move_by_the_recursion_as_by_their_mass_matrix(system: System) -> None:
    for seed in (1, 2):
        assert_same_motion(system, seed)


STEPS = st.tuples(
    st.sampled_from(["turn", "back", "slide", "fixed turn"]), st.integers(0, 2), st.integers(0, 3), st.booleans()
)


@settings(max_examples=12, deadline=None)
@given(st.lists(STEPS, min_size=2, max_size=3), st.integers(0, 100))
def test_random_trees_move_by_the_recursion_as_by_their_mass_matrix(steps: list, seed: int) -> None:
    """Turns, slides, fixed turns, branches; every joint carries a body, so that no mass matrix is singular."""
    c = coordinates([f"q{i}" for i in range(len(steps))])
    frames, L = [Frame(c)], sp.S.Zero
    for q, (kind, axis, parent, shifted) in zip(c.q, steps, strict=True):
        frame = frames[parent % len(frames)]
        if shifted:
            frame = frame.moved(l / 3, 0, -l)
        if kind == "fixed turn":
            frame = frame.turned("x", sp.pi / 6)
        frame = (
            frame.moved(*(q if i == axis else 0 for i in range(3)))
            if kind == "slide"
            else frame.turned("xyz"[axis], -q if kind == "back" else q)
        )
        frames.append(frame)
        body = frame.body(m, (I1, I2, I3), (l / 2, 0, l / 4))
        L = L + body.kinetic - body.potential(GRAVITY)
    assert_same_motion(System(c, L), seed)


JOINTS = {
    "a rotation matrix of two coordinates": lambda f, q: f.moved(l, 0, 0).turned(
        turn_matrix(0, q[0]) * turn_matrix(1, q[1])
    ),
    "a ball joint, Euler angles": lambda f, q: f.turned("zxz", q[:3]),
    "a floating base": lambda f, q: f.moved(*q[:3]).turned("xyz", q[3:6]),
    "a bead on a helix": lambda f, q: f.moved(l * sp.cos(q[0]), l * sp.sin(q[0]), q[0] / 5),
    "a cart on a driven table": lambda f, q: f.turned("z", k * t).moved(l * t**2, 0, sp.sin(t)).moved(*q[:2], 0),
    "a turn by a function": lambda f, q: f.turned("y", sp.sin(q[0]) + q[0] * t),
    "a screw through a driven nut": lambda f, q: f.turned("z", t**2 / 2).moved(0, l, k * q[0] - t),
}


# Of those that take three coordinates and more; two coordinates in one matrix are in the fast suite.
SEVERAL = ("a ball joint, Euler angles", "a floating base")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in SEVERAL else name for name in JOINTS]
)
def test_joints_of_several_coordinates_and_of_time_move_as_their_mass_matrix(name: str) -> None:
    """Each between the ground and an arm with a second arm on it."""
    needed = {"floating": 6, "Euler": 3, "two": 2, "cart": 2}
    n = next((count for word, count in needed.items() if word in name), 1)
    c = coordinates([f"q{i}" for i in range(n + 1)])
    frame = JOINTS[name](Frame(c), c.q)
    body = frame.body(m, (I1, I2, I3), (l / 2, 0, l / 4))
    elbow = frame.moved(l, 0, 0).turned("y", c.q[n])
    arm = elbow.body(m / 2, (I2, I3, I1), (0, l, l))
    L = body.kinetic + arm.kinetic - body.potential(GRAVITY) - arm.potential(GRAVITY)
    assert_same_motion(System(c, L))
    assert_same_motion(System(c, L, (elbow.place((l, l, l)).dot((1, 2, 3)),)))


def test_terms_linear_in_the_velocities_act_as_forces_on_a_tree() -> None:
    """A magnetic field along z on the end of a double pendulum, a potential that time drives, friction and forces."""
    system = chain(2)
    (a, b), (u, w) = system.c.q, system.c.v
    L = system.lagrangian + k * sp.sin(b) * u * t - k * sp.cos(t) * a**2
    assert_same_motion(System(system.c, L, dissipation=k * w**2 / 2, forces=(k * sp.sin(w), k)))


@pytest.mark.parametrize(("make", "each"), [(chain, 81), (gyroscopes, 421)])
def test_each_link_more_costs_the_same_number_of_operations(make: Callable[[int], System], each: int) -> None:
    """And no more than it did."""
    counts = [operations(motion_program(make(n)).program) for n in (3, 4, 5)]
    assert np.diff(counts) == pytest.approx(each, abs=1)
    assert operations(motion_program(plain(chain(3))).program) > operations(motion_program(chain(3)).program)


def test_a_round_rotor_is_not_turned_by_its_spin() -> None:
    """The spin angle of a symmetric rotor is in no stage."""
    given = motion_program(gyroscopes(1))
    spin = given.program.arguments[2]
    assert not any(spin in e.free_symbols for _, e in reduce_common(given.program)[0])
    uneven = Frame(coordinates("a s")).turned("x", sp.Symbol("a", real=True)).turned("z", sp.Symbol("s", real=True))
    rotor = uneven.body(m, (I1, I2, I3), (0, 0, l))
    other = motion_program(System(uneven.c, rotor.kinetic))
    assert any(other.program.arguments[1] in e.free_symbols for _, e in reduce_common(other.program)[0])


def test_what_is_no_tree_takes_the_mass_matrix() -> None:
    c = coordinates("a b")
    a, b = c.q
    absolute = Frame(c).turned("y", a - b).body(m, (I1, I2, I3))
    other = Frame(c).turned("y", b).body(m, (I1, I2, I3))
    assert tree_of(System(c, absolute.kinetic + other.kinetic)) is None
    twice = Frame(c).turned("y", a).turned("x", a).body(m, (I1, I2, I3))
    assert tree_of(System(c, twice.kinetic + other.kinetic)) is None
    shared = Frame(c).moved(a, b).turned("z", b).body(m, (I1, I2, I3))
    assert tree_of(System(c, shared.kinetic)) is None
    right = Frame(c).turned("y", a).moved(0, 0, b).body(m, (I1, I2, I3))
    assert tree_of(System(c, right.kinetic)) is not None
    assert tree_of(System(c, 2 * right.kinetic)) is None
    assert tree_of(System(c, right.kinetic + c.v[0] ** 2 * b)) is None


def spatial_chain(n: int) -> System:
    """Return n rods on ball joints."""
    c = coordinates([f"{name}{i}" for i in range(n) for name in "abcd"])
    frame, L = Frame(c), sp.S.Zero
    for i in range(n):
        rod = frame.ball([f"{name}{i}" for name in "abcd"], [f"{name}{i}" for name in "uvw"])
        body, frame = rod.body(m, (I1, I1, I3), (0, 0, -l / 2)), rod.moved(0, 0, -l)
        L = body.kinetic - body.potential(GRAVITY) + L
    return System(c, L)


def calls(work: Callable[[], object]) -> int:
    """Count the calls of Python functions."""
    count = 0

    def counted(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event == "call"

    forget()
    sys.setprofile(counted)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize(("make", "sizes"), [(chain, (16, 32)), (spatial_chain, (6, 12))])
def test_the_work_to_derive_a_chain_grows_in_proportion_to_its_length(make, sizes) -> None:
    few, many = (calls(lambda n=n: make(n).rhs(KNOWN)) for n in sizes)
    assert many < 2.3 * few


def test_the_program_of_a_chain_grows_in_proportion_to_its_length() -> None:
    programs = [motion_program(chain(n)).program for n in (16, 32, 64)]
    for count in (operations, lambda program: len(reduce_common(program)[0])):
        assert all(more <= 2.1 * less for less, more in pairwise(map(count, programs)))


@pytest.mark.slow
def test_a_chain_of_100_rods_runs_for_a_second_and_keeps_its_energy() -> None:
    run = chain(100).simulate({m: 1.3, l: 0.7, g: 9.81}, np.linspace(0.05, 0.01, 100), np.zeros(100), [0, 0.5, 1], 1e-8)
    assert run.error < 1e-8
    assert np.ptp(run.energy) < 1e-10 * np.abs(run.energy).max()
