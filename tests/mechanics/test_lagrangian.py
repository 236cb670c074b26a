"""Equations of motion: known systems, an independent derivation, and properties of random quadratic Lagrangians."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import (
    Coordinates,
    accelerations,
    bias,
    coordinates,
    energy,
    euler_lagrange,
    mass_matrix,
    total_derivative,
)
from tests.systems import I1, I3, System, double_pendulum, g, heavy_top, l, m, spherical_pendulum

VALUES = {m: 1.3, l: 0.7, g: 9.81, I1: 0.6, I3: 0.25}


def magnetic_particle() -> System:
    c = coordinates("x y")
    (x, y), (vx, vy) = c.q, c.v
    return System(c, m * (vx**2 + vy**2) / 2 + g * (x * vy - y * vx) * x - l * x**2 * y)


def parts(system: System) -> tuple[sp.Expr, Coordinates]:
    return system.L, system.c


GALLERY = [spherical_pendulum, heavy_top, double_pendulum, magnetic_particle]


def random_state(c: Coordinates, seed: int) -> dict[sp.Symbol, float]:
    draw = np.random.default_rng(seed)
    return {s: float(draw.uniform(0.3, 1.2)) for s in c.q + c.v} | VALUES


def numbers(expressions: sp.Matrix, state: dict[sp.Symbol, float]) -> np.ndarray:
    return np.array(expressions.xreplace({s: sp.Float(v) for s, v in state.items()}).tolist(), dtype=float)


def test_coordinates_are_named_after_their_order() -> None:
    c = coordinates("theta_1, phi_1")
    assert [str(s) for s in c.q + c.v + c.a] == [
        *("theta_1", "phi_1"), *("theta_1_dot", "phi_1_dot"), *("theta_1_ddot", "phi_1_ddot")
    ]  # fmt: skip
    assert all(s.is_real for s in c.q + c.v + c.a)


@pytest.mark.parametrize("names", ["", "x x", "x x_dot"])
def test_names_that_do_not_tell_symbols_apart_are_refused(names: str) -> None:
    with pytest.raises(InputError, match="Coordinates"):
        coordinates(names)


def test_each_coordinate_needs_its_velocity() -> None:
    x, y, z = sp.symbols("x y z")
    with pytest.raises(InputError, match="1 coordinates, 1 velocities, 0 accelerations"):
        Coordinates((x,), (y,), ())
    assert Coordinates((x,), (y,), (z,)).v == (y,)


def test_spherical_pendulum_has_its_textbook_accelerations() -> None:
    L, c = parts(spherical_pendulum())
    theta, (dtheta, dphi) = c.q[0], c.v
    expected = sp.Matrix([
        sp.sin(theta) * sp.cos(theta) * dphi**2 - g / l * sp.sin(theta),
        -2 * sp.cos(theta) / sp.sin(theta) * dtheta * dphi,
    ])  # fmt: skip
    state = random_state(c, 1)
    np.testing.assert_allclose(numbers(accelerations(L, c), state), numbers(expected, state), rtol=1e-13)


def test_a_top_precesses_steadily_at_the_two_roots_of_its_quadratic() -> None:
    L, c = parts(heavy_top())
    theta, (dtheta, dphi, dpsi) = c.q[0], c.v
    tilt, spin = 0.9, 40.0
    parameters = [VALUES[s] for s in (I1, I3, m, g, l)]
    i1, i3, mass, gravity, arm = parameters
    for rate in np.roots([i1 * np.cos(tilt), -i3 * spin, mass * gravity * arm]):
        steady = {theta: tilt, dtheta: 0, dphi: rate, dpsi: spin - rate * np.cos(tilt)} | VALUES
        np.testing.assert_allclose(numbers(accelerations(L, c), steady), 0, atol=1e-10)
        faster = steady | {dphi: 1.01 * rate}
        assert abs(numbers(accelerations(L, c), faster)[0, 0]) > 1e-3


@pytest.mark.parametrize("system", GALLERY)
def test_the_affine_form_is_the_euler_lagrange_equation(system: Callable[[], System]) -> None:
    L, c = parts(system())
    affine = mass_matrix(L, c) * sp.Matrix(c.a) + bias(L, c)
    assert (euler_lagrange(L, c) - affine).expand() == sp.zeros(len(c.q), 1)
    assert mass_matrix(L, c).is_symmetric(simplify=False)


@pytest.mark.parametrize("system", GALLERY)
@pytest.mark.parametrize("seed", [2, 3])
def test_accelerations_agree_with_an_independent_derivation(system: Callable[[], System], seed: int) -> None:
    L, c = parts(system())
    state = random_state(c, seed)
    functions = [dynamicsymbols(str(q)) for q in c.q]
    rates = [f.diff(dynamicsymbols._t) for f in functions]
    oracle = LagrangesMethod(L.subs(dict(zip(c.v + c.q, rates + functions, strict=True))), functions)
    oracle.form_lagranges_equations()
    at = {f: state[v] for f, v in zip(rates, c.v, strict=True)}
    at_q = {f: state[q] for f, q in zip(functions, c.q, strict=True)} | VALUES
    M, forcing = (numbers(part.subs(at), at_q) for part in (oracle.mass_matrix, oracle.forcing))
    np.testing.assert_allclose(numbers(accelerations(L, c), state), np.linalg.solve(M, forcing), rtol=1e-11)


@pytest.mark.parametrize("system", GALLERY)
def test_energy_is_conserved_without_forces_and_fed_by_them(system: Callable[[], System]) -> None:
    L, c = parts(system())
    state = random_state(c, 4)
    rate = total_derivative(energy(L, c), c)
    push = [sp.Rational(i + 1, 3) for i in range(len(c.q))]
    for forces, power in ((None, 0.0), (push, sum(float(f) * state[v] for f, v in zip(push, c.v, strict=True)))):
        moved = dict(zip(c.a, accelerations(L, c, forces), strict=True))
        assert float(rate.subs(moved).subs(state)) == pytest.approx(power, abs=1e-10)


def test_a_lagrangian_that_is_not_regular_is_refused_by_the_velocity_at_fault() -> None:
    c = coordinates("x psi")
    with pytest.raises(SingularError, match=r"not regular in psi_dot; use fewer"):
        accelerations(c.v[0] ** 2 / 2 - c.q[1] * c.q[0], c)
    # No entry of M vanishes, only its determinant, by cos² + sin² = 1.
    theta = c.q[0]
    doubled = (sp.cos(theta) ** 2 + sp.sin(theta) ** 2) * c.v[0] ** 2 / 2 + c.v[0] * c.v[1] + c.v[1] ** 2 / 2
    with pytest.raises(SingularError, match=r"x_dot, psi_dot"):
        accelerations(doubled, c)


def test_forces_are_one_for_each_coordinate() -> None:
    L, c = parts(double_pendulum())
    with pytest.raises(InputError, match="1 forces for 2 coordinates"):
        accelerations(L, c, [sp.S.One])


small = st.integers(-3, 3)


@st.composite
def quadratic_lagrangians(draw: st.DrawFn) -> tuple[sp.Expr, Coordinates]:
    """½ v·M(q) v + b(q)·v − V(q), with M = AᵀA + 1 + diag(q²) positive, polynomial in q."""
    n = draw(st.integers(1, 3))
    c = coordinates([f"q{i}" for i in range(n)])
    q, v = sp.Matrix(c.q), sp.Matrix(c.v)
    A, B, K = (sp.Matrix(n, n, draw(st.lists(small, min_size=n * n, max_size=n * n))) for _ in range(3))
    M = A.T * A + sp.eye(n) + sp.diag(*(s**2 for s in c.q))
    return (v.T * M * v)[0] / 2 + (q.T * B * v)[0] - (q.T * K * q)[0], c


@settings(max_examples=15, deadline=None)
@given(quadratic_lagrangians(), st.data())
def test_quadratic_lagrangians_obey_their_own_equations(
    system: tuple[sp.Expr, Coordinates], data: st.DataObject
) -> None:
    L, c = system
    state = {s: sp.Rational(data.draw(small), 2) for s in c.q + c.v}
    state |= dict(zip(c.a, accelerations(L, c).xreplace(state), strict=True))
    assert euler_lagrange(L, c).xreplace(state) == sp.zeros(len(c.q), 1)
    assert total_derivative(energy(L, c), c).xreplace(state) == 0


@settings(max_examples=15, deadline=None)
@given(quadratic_lagrangians(), small, small)
def test_a_total_derivative_added_to_the_lagrangian_moves_nothing(
    system: tuple[sp.Expr, Coordinates], first: int, second: int
) -> None:
    L, c = system
    gauge = total_derivative(first * c.q[0] ** 3 + second * c.q[0] * c.q[-1] ** 2, c)
    assert (euler_lagrange(L + gauge, c) - euler_lagrange(L, c)).expand().is_zero_matrix
