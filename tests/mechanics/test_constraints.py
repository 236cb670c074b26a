"""Constraints: the tension of a rod, an independent derivation, and the projections."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.mechanics import Frame, System, constrained_accelerations, coordinates, degrees_of_freedom
from lagrotor.mechanics.constraints import project_position, project_velocity, solve_constrained
from tests.systems import I1, I2, I3, VALUES, ball_top, g, heavy_top, l, m, rod_pendulum, rolling_disc


def two_rods() -> System:
    """The double pendulum in Cartesian coordinates: four coordinates, two rods."""
    c = coordinates("x1 y1 x2 y2")
    x1, y1, x2, y2 = c.q
    L = m * sum(v**2 for v in c.v) / 2 - m * g * (y1 + y2)
    return System(c, L, ((x1**2 + y1**2 - l**2) / 2, ((x2 - x1) ** 2 + (y2 - y1) ** 2 - l**2) / 2))


def geared_pendulums() -> System:
    """Two spherical pendulums whose azimuths are coupled: a mass matrix that depends on the configuration."""
    c = coordinates("theta phi chi")
    (theta, phi, chi), (dtheta, dphi, dchi) = c.q, c.v
    T = m * l**2 * (dtheta**2 + sp.sin(theta) ** 2 * dphi**2 + dchi**2 + dchi * dphi * sp.cos(theta)) / 2
    return System(c, T + m * g * l * sp.cos(theta), (phi - sp.sin(chi) * theta,))


def magnetic_particle() -> System:
    """A charge in a field that changes with x."""
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    return System(c, m * (vx**2 + vy**2) / 2 + g * (x * vy - y * vx) * x - l * x**2 * y)


GALLERY = [rod_pendulum, two_rods, geared_pendulums]


def numbers(expressions: sp.Matrix, state: dict[sp.Symbol, float]) -> np.ndarray:
    given = {symbol: sp.Float(number) for symbol, number in state.items()}
    return np.array(expressions.xreplace(given).tolist(), dtype=float).reshape(expressions.shape)


def consistent_state(system: System, seed: int) -> dict[sp.Symbol, float]:
    """A random state brought onto the constraints: position first, then velocity."""
    draw = np.random.default_rng(seed)
    n, k = len(system.c.q), len(system.constraints)
    g_at = sp.lambdify([system.c.q], [e.subs(VALUES) for e in system.constraints])
    G_at = sp.lambdify([system.c.q], system.rows.subs(VALUES))
    if not k:
        return dict(zip(system.c.q + system.c.v, draw.uniform(0.3, 1.2, 2 * n).tolist(), strict=True)) | VALUES
    q = project_position(lambda q: np.array(g_at(q)), lambda q: np.reshape(G_at(q), (k, n)), draw.uniform(0.3, 1.2, n))
    v = project_velocity(np.reshape(G_at(q), (k, n)), draw.uniform(-1, 1, n))
    return dict(zip(system.c.q + system.c.v, (*q.tolist(), *v.tolist()), strict=True)) | VALUES


def numeric_parts(system: System, state: dict[sp.Symbol, float]) -> list[np.ndarray]:
    """M, h, G and γ at one state."""
    M, h, G, gamma = (numbers(e, state) for e in (system.mass_matrix, system.bias, system.rows, system.gamma))
    return [M, h.ravel(), G, gamma.ravel()]


def test_the_multiplier_of_a_rod_is_minus_its_tension_over_its_length() -> None:
    system = rod_pendulum()
    angle, rate = sp.symbols("vartheta omega", real=True)
    on_the_rod = dict(zip(
        system.c.q + system.c.v,
        (l * sp.sin(angle), -l * sp.cos(angle), l * rate * sp.cos(angle), l * rate * sp.sin(angle)),
        strict=True,
    ))  # fmt: skip
    a, lam = constrained_accelerations(system)
    tension = m * (g * sp.cos(angle) + l * rate**2)
    state = {angle: 0.8, rate: 2.1} | VALUES
    assert float(lam[0].subs(on_the_rod).subs(state)) == pytest.approx(-float((tension / l / 2).subs(state)))
    # The rod pulls along the circle's inward normal, so the tangential acceleration is gravity's.
    tangential = (a[0] * sp.cos(angle) + a[1] * sp.sin(angle)).subs(on_the_rod).subs(state)
    assert float(tangential) == pytest.approx(-VALUES[g] * np.sin(0.8))


@pytest.mark.parametrize("system", GALLERY)
@pytest.mark.parametrize("seed", [1, 2])
def test_accelerations_and_multipliers_satisfy_both_equations(system: Callable[[], System], seed: int) -> None:
    built = system()
    state = consistent_state(built, seed)
    n = len(built.c.q)
    Q = np.linspace(-1, 2, n)
    symbolic = constrained_accelerations(replace(built, forces=tuple(sp.Float(f) for f in Q)))
    M, h, G, gamma = numeric_parts(built, state)
    for a, lam in (solve_constrained(M, h, G, gamma, Q), (numbers(part, state).ravel() for part in symbolic)):
        np.testing.assert_allclose(G @ a + gamma, 0, atol=1e-11)
        np.testing.assert_allclose(M @ a + h - Q - G.T @ lam, 0, atol=1e-11)
    np.testing.assert_allclose(numbers(built.residual, state), 0, atol=1e-13)


@pytest.mark.parametrize("system", [*GALLERY, heavy_top, magnetic_particle])
def test_an_independent_derivation_agrees_in_accelerations_and_multipliers(system: Callable[[], System]) -> None:
    built = system()
    c, state = built.c, consistent_state(built, 3)
    functions = [dynamicsymbols(str(q)) for q in c.q]
    rates = [f.diff(dynamicsymbols._t) for f in functions]
    in_time = dict(zip(c.q + c.v, functions + rates, strict=True))
    oracle = LagrangesMethod(built.L.subs(in_time), functions, hol_coneqs=[e.subs(in_time) for e in built.constraints])
    oracle.form_lagranges_equations()
    backwards = dict(zip(rates + functions, (state[s] for s in c.v + c.q), strict=True)) | VALUES
    M, forcing = (numbers(part.subs(backwards), VALUES) for part in (oracle.mass_matrix_full, oracle.forcing_full))
    solution = np.linalg.solve(M, forcing).ravel()[len(functions) :]
    # Its matrix form reads M a − Gᵀ λ = Q − h, the convention here; its attribute `eom` carries the opposite λ.
    exact = [numbers(part, state).ravel() for part in constrained_accelerations(built)]
    np.testing.assert_allclose(np.concatenate(exact), solution, rtol=1e-9, atol=1e-11)
    if built.constraints:
        solved = solve_constrained(*numeric_parts(built, state), np.zeros(len(functions)))
        np.testing.assert_allclose(np.concatenate(solved), solution, rtol=1e-9, atol=1e-11)


def test_degrees_of_freedom_fall_with_each_independent_constraint() -> None:
    system = two_rods()
    hanging = dict(zip(system.c.q, (0, -1, 0, -2), strict=True))
    assert degrees_of_freedom(system, hanging) == 2
    assert degrees_of_freedom(replace(system, constraints=(*system.constraints, system.constraints[0])), hanging) == 2
    assert degrees_of_freedom(system, dict.fromkeys(system.c.q, 0)) == 4


def circle(q: np.ndarray) -> np.ndarray:
    return np.array([q @ q - 1])


def circle_normal(q: np.ndarray) -> np.ndarray:
    return 2 * q[None, :]


def test_projection_of_a_position_keeps_the_direction_and_stays_where_it_is() -> None:
    q = project_position(circle, circle_normal, np.array([3.0, 4.0]))
    np.testing.assert_allclose(q, [0.6, 0.8], rtol=1e-15)
    np.testing.assert_allclose(project_position(circle, circle_normal, q), q, rtol=1e-15)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 3))
def test_projected_velocities_are_consistent_nearest_and_stay(seed: int, k: int) -> None:
    draw = np.random.default_rng(seed)
    A, G, v = draw.normal(size=(4, 4)), draw.normal(size=(k, 4)), draw.normal(size=4)
    mass = A.T @ A + np.eye(4)
    w = project_velocity(G, v, mass)
    np.testing.assert_allclose(G @ w, 0, atol=1e-9)
    np.testing.assert_allclose(project_velocity(G, w, mass), w, atol=1e-9)
    # Nearest: the change is orthogonal, in the mass metric, to every consistent velocity.
    assert abs((w - v) @ mass @ w) < 1e-8


P, T = coordinates("x y"), np.linspace(0, 1, 3)
(x, y), (u, _) = P.q, P.v


@pytest.mark.parametrize("size", [1.0, 1e-6])
def test_a_unit_quaternion_moves_as_its_ball_joint(size: float) -> None:
    """M has rank three, and the length binds the fourth; small inertias lose no digits."""
    joint, values = ball_top((I1, I2, I3), (0, 0, 0)), {I1: size, I2: 2 * size, I3: 2.5 * size}
    plain = System(joint.c, joint.L, joint.constraints)
    run = plain.simulate(values, (1, 0, 0, 0), (0, 0.1, 0.5, 0.25), T, 1e-10)
    np.testing.assert_allclose(run.q, joint.simulate(values, (1, 0, 0, 0), (0.2, 1, 0.5), T, 1e-10).q, atol=1e-8)
    assert run.drift.max() < 1e-12


def test_a_massless_slider_is_held_by_its_constraint() -> None:
    """A bead of mass 1 at x drives a massless one at y along x + y² = 0 with both weights: x alone has an equation."""
    system = System(P, u**2 / 2 - x - y, (x + y**2,))
    alone = system.in_coordinates(coordinates("y"), {x: -(y**2)}).simulate({}, (1,), (0,), T, 1e-11)
    np.testing.assert_allclose(system.simulate({}, (-1, 1), (0, 0), T, 1e-11).q[:, 1:], alone.q, rtol=1e-7)
    with pytest.raises(LagrotorError, match="singular"):
        System(P, u**2 / 2 - x - y).simulate({}, (-1, 1), (0, 0), T)


def test_what_the_constraints_alone_bind_where_the_mass_is_lost_moves() -> None:
    """Two links in line, the first without mass, welded: M is regular beside the weld and singular on it."""
    mass = Frame(P).turned("x", x).moved(0, 0, -1).turned("x", y).body(m, centre=(0, 0, -1))
    L, one = mass.kinetic - mass.potential((0, 0, -g)), coordinates("q")
    welded = System(P, System(P, L).L, (y,)).simulate({m: 1, g: 10}, (0.1, 0), (0, 0), T, 1e-11)
    single = System(one, 2 * one.v[0] ** 2 + 20 * sp.cos(one.q[0])).simulate({}, (0.1,), (0,), T, 1e-11)
    np.testing.assert_allclose(welded.q[:, :1], single.q, rtol=1e-9)
    with pytest.raises(LagrotorError, match="write the energies out"):
        System(P, L, (y,)).simulate({m: 1, g: 10}, (0.1, 0), (0, 0), T)


def test_a_kinetic_energy_that_is_negative_is_said() -> None:
    """A Lagrangian may have one, as that of a geodesic in spacetime; a mass has not."""
    c, M = coordinates("x"), sp.Symbol("M", real=True)
    with pytest.warns(LagrotorWarning, match="negative"):
        run = System(c, M * c.v[0] ** 2 / 2 - c.q[0] ** 2 / 2).simulate({M: -1}, (0.1,), (0,), T)
    assert run.q[:, 0] == pytest.approx(0.1 * np.cosh(run.t), rel=1e-5)


def test_accelerations_of_a_rolling_disc_are_short_and_those_of_its_right_hand_side() -> None:
    disc, _ = rolling_disc()
    values = {s: VALUES[s] for s in disc.letters if s in VALUES}
    assert sp.count_ops(disc.accelerations) < 1000
    q, v = disc.consistent(values, [0, 0, 1, 0.2, 0.3, 0.5], [0.1, 0.2, 0, 0.4, 0.5, 3])
    at = values | dict(zip((*disc.c.q, *disc.c.v), (*q, *v), strict=True))
    a = [float(e.subs(at)) for e in disc.accelerations]
    assert a == pytest.approx(disc.rhs(values)(0.0, np.concatenate([q, v]))[6:], abs=1e-12)
