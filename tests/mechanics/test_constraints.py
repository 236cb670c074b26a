"""Constraints: the tension of a rod, an independent derivation, and the projections."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics import (
    System,
    accelerations,
    constrained_accelerations,
    coordinates,
    degrees_of_freedom,
    project_position,
    project_velocity,
    solve_constrained,
    total_derivative,
)

m, l, g = sp.symbols("m l g", positive=True)
VALUES = {m: 1.3, l: 0.7, g: 9.81}


def rod_pendulum() -> System:
    """A bob in the plane, y upwards, on a rod of length l."""
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    return System(c, m * (vx**2 + vy**2) / 2 - m * g * y, ((x**2 + y**2 - l**2) / 2,))


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
    q = project_position(lambda q: np.array(g_at(q)), lambda q: np.reshape(G_at(q), (k, n)), draw.uniform(0.3, 1.2, n))
    v = project_velocity(np.reshape(G_at(q), (k, n)), draw.uniform(-1, 1, n))
    return dict(zip(system.c.q + system.c.v, (*q.tolist(), *v.tolist()), strict=True)) | VALUES


def numeric_parts(
    system: System, state: dict[sp.Symbol, float]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """M, h, G and γ at one state."""
    return (
        numbers(system.mass, state),
        numbers(system.bias, state).ravel(),
        numbers(system.rows, state),
        numbers(system.gamma, state).ravel(),
    )


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
    assert float(lam[0].subs(on_the_rod).subs(state)) == pytest.approx(-float((tension / l).subs(state)))
    # The rod pulls along the circle's inward normal, so the tangential acceleration is gravity's.
    tangential = (a[0] * sp.cos(angle) + a[1] * sp.sin(angle)).subs(on_the_rod).subs(state)
    assert float(tangential) == pytest.approx(-9.81 * np.sin(0.8))


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


@pytest.mark.parametrize("system", GALLERY)
def test_an_independent_derivation_agrees_in_accelerations_and_multipliers(system: Callable[[], System]) -> None:
    built = system()
    state = consistent_state(built, 3)
    functions = [dynamicsymbols(str(q)) for q in built.c.q]
    rates = [f.diff(dynamicsymbols._t) for f in functions]
    in_time = dict(zip(built.c.q + built.c.v, functions + rates, strict=True))
    oracle = LagrangesMethod(built.L.subs(in_time), functions, hol_coneqs=[e.subs(in_time) for e in built.constraints])
    oracle.form_lagranges_equations()
    backwards = dict(zip(rates + functions, (state[s] for s in built.c.v + built.c.q), strict=True)) | VALUES
    M, forcing = (numbers(part.subs(backwards), VALUES) for part in (oracle.mass_matrix_full, oracle.forcing_full))
    solution = np.linalg.solve(M, forcing).ravel()[len(functions) :]
    a, lam = solve_constrained(*numeric_parts(built, state), np.zeros(len(functions)))
    # Its matrix form reads M a − Gᵀ λ = Q − h, the convention here; its attribute `eom` carries the opposite λ.
    np.testing.assert_allclose(np.concatenate([a, lam]), solution, rtol=1e-9, atol=1e-11)


def test_gamma_is_what_remains_of_the_second_derivative() -> None:
    system = geared_pendulums()
    second = total_derivative(total_derivative(system.constraints[0], system.c), system.c)
    affine = system.rows * sp.Matrix(system.c.a) + system.gamma
    assert (second - affine[0]).expand() == 0


def test_a_system_without_constraints_is_the_free_one() -> None:
    bound = geared_pendulums()
    free = System(bound.c, bound.L)
    a, lam = constrained_accelerations(free)
    assert a == accelerations(bound.L, bound.c)
    assert lam.shape == (0, 1)
    assert degrees_of_freedom(free, {}) == 3
    nothing = np.zeros((0, 2))
    assert solve_constrained(np.eye(2), np.ones(2), nothing, np.zeros(0), np.zeros(2))[0].tolist() == [-1, -1]


def test_dependent_constraints_are_refused_in_symbols_and_in_numbers() -> None:
    system = rod_pendulum()
    twice = replace(system, constraints=(system.constraints[0], 3 * system.constraints[0]))
    with pytest.raises(SingularError, match="dependent"):
        constrained_accelerations(twice)
    G = np.array([[1.0, 2.0, 0.0], [3.0, 6.0, 1e-9]])
    with pytest.raises(SingularError, match="solve_constrained: the constraints are dependent"):
        solve_constrained(np.eye(3), np.zeros(3), G, np.zeros(2), np.zeros(3))
    with pytest.raises(SingularError, match="lengths of the normals"):
        project_velocity(np.zeros((1, 3)), np.ones(3))
    with pytest.raises(SingularError, match="mass matrix is singular"):
        project_velocity(G, np.ones(3), np.zeros((3, 3)))
    # The same directions in units far apart are independent: the refusal is blind to scale.
    assert np.allclose(project_velocity(np.array([[1e9, 0, 0], [0, 1e-9, 0]]), np.ones(3)), [0, 0, 1])


def test_degrees_of_freedom_fall_with_each_independent_constraint() -> None:
    system = two_rods()
    hanging = dict(zip(system.c.q, (0, -1, 0, -2), strict=True))
    assert degrees_of_freedom(system, hanging) == 2
    assert degrees_of_freedom(replace(system, constraints=(*system.constraints, system.constraints[0])), hanging) == 2
    assert degrees_of_freedom(system, dict.fromkeys(system.c.q, 0)) == 4
    with pytest.raises(InputError, match="y2 without a value"):
        degrees_of_freedom(system, dict(zip(system.c.q[:3], (0, -1, 0), strict=True)))


def test_a_velocity_is_no_holonomic_constraint() -> None:
    c = coordinates("x y")
    with pytest.raises(InputError, match=r"constraints\[1\] contains y_dot: .* give it to rolling"):
        System(c, c.v[0] ** 2, (c.q[0], c.v[1] - c.q[0]))


def circle(q: np.ndarray) -> np.ndarray:
    return np.array([q @ q - 1])


def circle_normal(q: np.ndarray) -> np.ndarray:
    return 2 * q[None, :]


def test_projection_of_a_position_keeps_the_direction_and_stays_where_it_is() -> None:
    q = project_position(circle, circle_normal, np.array([3.0, 4.0]))
    np.testing.assert_allclose(q, [0.6, 0.8], rtol=1e-15)
    np.testing.assert_allclose(project_position(circle, circle_normal, q), q, rtol=1e-15)


def test_projection_is_nearest_in_the_mass_metric_to_first_order() -> None:
    mass = np.diag([1.0, 9.0])
    on, off = np.array([0.6, 0.8]), np.array([1.0, 0.3])
    tangent = np.array([-0.8, 0.6])
    misses = []
    for distance in (1e-2, 1e-3):
        q = on + distance * off
        misses.append(abs(tangent @ mass @ (project_position(circle, circle_normal, q, mass) - q)))
    assert misses[1] < 0.02 * misses[0]


def test_projection_that_cannot_arrive_says_what_is_left() -> None:
    with pytest.raises(ConstraintError, match=r"\|g\| = .* left after 20 steps"):
        project_position(lambda q: np.array([q @ q + 1]), circle_normal, np.array([0.3, 0.4]))
    with pytest.raises(SingularError, match="project_position"):
        project_position(circle, circle_normal, np.zeros(2))


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
