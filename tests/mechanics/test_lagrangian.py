"""Equations of motion: known systems, an independent derivation, and properties of random quadratic Lagrangians."""

import copy
import pickle

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.errors import InputError
from lagrotor.mechanics import (
    Coordinates,
    accelerations,
    coordinates,
    energy,
    euler_lagrange,
    total_derivative,
)
from tests.systems import I1, I3, VALUES, g, heavy_top, l, m


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


def test_a_top_precesses_steadily_at_the_two_roots_of_its_quadratic() -> None:
    L, c = heavy_top().L, heavy_top().c
    theta, (dtheta, dphi, dpsi) = c.q[0], c.v
    tilt, spin = 0.9, 40.0
    i1, i3, mass, gravity, arm = (VALUES[s] for s in (I1, I3, m, g, l))
    for rate in np.roots([i1 * np.cos(tilt), -i3 * spin, mass * gravity * arm]):
        steady = {theta: tilt, dtheta: 0, dphi: rate, dpsi: spin - rate * np.cos(tilt)} | VALUES
        np.testing.assert_allclose(numbers(accelerations(L, c), steady), 0, atol=1e-10)
        faster = steady | {dphi: 1.01 * rate}
        assert abs(numbers(accelerations(L, c), faster)[0, 0]) > 1e-3


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


def test_a_symbol_of_a_configuration_is_found_by_its_name() -> None:
    c = coordinates("theta q")
    assert c.theta is c.q[0] and c["theta_dot"] is c.theta_dot is c.v[0] and c["theta_ddot"] is c.a[0]
    assert c.q == (c["theta"], c["q"]) and c.q_dot is c.v[1]  # the attribute q is all of them
    assert copy.deepcopy(c) == c == pickle.loads(pickle.dumps(c)) and not hasattr(c, "_sympy_")
    with pytest.raises(InputError, match=r"'thetta' is none of theta, q, .*: theta"):
        c["thetta"]
    with pytest.raises(InputError, match=r"0 is none of theta.* by their names"):
        c[0]  # type: ignore[index]
    with pytest.raises(AttributeError, match="'phi' is none of theta"):
        c.phi  # noqa: B018
