"""The articulated-body recursion against the mass matrix of the same Lagrangian, on random trees, with and without loops."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.mechanics import Frame, System, coordinates, t
from lagrotor.mechanics.bodies.trees import tree_of
from lagrotor.mechanics.running.integration import rhs_factory
from lagrotor.mechanics.running.programs import energy_program, motion_program, parameter_values
from lagrotor.numerics.codegen import compile_program, operations, reduce_common

m, l, g, I1, I2, I3, k = sp.symbols("m l g I_1 I_2 I_3 k", positive=True)
VALUES = {m: 1.3, l: 0.7, g: 9.81, I1: 0.3, I2: 0.4, I3: 0.2, k: 0.5}
GRAVITY = (0, 0, -g)


def derivative(system: System, y: np.ndarray) -> np.ndarray:
    given = motion_program(system)
    return np.array(rhs_factory(given)(*parameter_values(given, VALUES))(0.0, y))


def energy(system: System, y: np.ndarray) -> float:
    given = energy_program(system)
    return float(compile_program(given.program)(*y, *parameter_values(given, VALUES))[0])


def plain(system: System) -> System:
    """The same system with its Lagrangian as an expression: no tree to be seen."""
    return System(system.c, system.L, system.constraints, system.rolling, system.dissipation, system.forces)


def assert_same_motion(system: System, seed: int = 1) -> None:
    assert tree_of(system) is not None and tree_of(plain(system)) is None
    y = np.random.default_rng(seed).uniform(-1, 1, 2 * len(system.c.q))
    by_tree, by_mass = derivative(system, y), derivative(plain(system), y)
    np.testing.assert_allclose(by_tree, by_mass, rtol=1e-9, atol=1e-9 * np.abs(by_mass).max())
    assert energy(system, y) == pytest.approx(energy(plain(system), y), rel=1e-10, abs=1e-10)


def pendulum(n: int) -> System:
    """n points on massless links, relative angles."""
    c = coordinates([f"q{i}" for i in range(n)])
    frame, L = Frame(c), sp.S.Zero
    for q in c.q:
        frame = frame.turned("y", q)
        point = frame.body(m, centre=(0, 0, -l))
        L, frame = L + point.kinetic - point.potential(GRAVITY), frame.moved(0, 0, -l)
    return System(c, L)


def gyroscopes(n: int) -> System:
    """A chain of gyroscopes, each on the tip of the one before, two angles and a spin."""
    c = coordinates([f"{s}{i}" for i in range(n) for s in ("a", "b", "s")])
    frame, L = Frame(c), sp.S.Zero
    for i in range(n):
        axis = frame.turned("xy", c.q[3 * i : 3 * i + 2])
        rotor = axis.turned("z", c.q[3 * i + 2]).body(m, (I1, I1, I3), (0, 0, l / 2))
        L, frame = L + rotor.kinetic - rotor.potential(GRAVITY), axis.moved(0, 0, l)
    return System(c, L)


@pytest.mark.parametrize("system", [pendulum(3), gyroscopes(1), gyroscopes(2)], ids=["pendulum", "gyroscope", "two"])
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


def test_springs_friction_and_forces_act_on_the_joints_of_a_tree() -> None:
    system = pendulum(3)
    q, v = system.c.q, system.c.v
    bound = System(
        system.c,
        system.lagrangian - k * q[1] ** 2 / 2 * sp.cos(q[0]),
        dissipation=k * v[2] ** 2 / 2,
        forces=(k * sp.sin(v[1]), 0, k),
    )
    assert_same_motion(bound)
    y = np.random.default_rng(1).uniform(-1, 1, 6)
    assert np.abs(derivative(bound, y) - derivative(system, y)).max() > 1e-2


def test_a_loop_closes_a_tree_by_multipliers() -> None:
    """A four-bar linkage as an open chain of three bars whose end is held."""
    chain = pendulum(3)
    frame = Frame(chain.c)
    for q in chain.c.q:
        frame = frame.turned("y", q).moved(0, 0, -l)
    x, _, z = frame.place()
    assert_same_motion(System(chain.c, chain.lagrangian, (x - l, z + l / 2)))


@pytest.mark.parametrize("n", [4, 8])
def test_operations_grow_with_the_links_and_not_faster(n: int) -> None:
    few, many, more = (operations(motion_program(pendulum(k)).program) for k in (n, 2 * n, 3 * n))
    assert more - many == pytest.approx(many - few, abs=1)
    assert operations(motion_program(plain(pendulum(3))).program) > operations(motion_program(pendulum(3)).program)


def test_each_gyroscope_more_costs_the_same() -> None:
    counts = [operations(motion_program(gyroscopes(n)).program) for n in (3, 4, 5, 6)]
    assert np.ptp(np.diff(counts)) <= 2


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
    driven = Frame(c).turned("z", t).turned("y", a).moved(0, 0, b).body(m, (I1, I2, I3))
    assert tree_of(System(c, driven.kinetic)) is None
    right = Frame(c).turned("y", a).moved(0, 0, b).body(m, (I1, I2, I3))
    assert tree_of(System(c, right.kinetic)) is not None
    assert tree_of(System(c, 2 * right.kinetic)) is None
    assert tree_of(System(c, right.kinetic + c.v[0] * c.q[1])) is None


def test_a_long_chain_keeps_its_energy() -> None:
    chain = pendulum(12)
    start = np.linspace(0.2, 0.1, 12)
    run = chain.simulate(VALUES, start, 0 * start, np.linspace(0, 2, 21), 1e-9)
    assert np.ptp(run.energy) < 1e-6 * np.abs(run.energy).max()
