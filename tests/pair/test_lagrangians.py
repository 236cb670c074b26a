"""The pair's Lagrangians against oracles made of rotation matrices, rigid bodies and numbers."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.mechanics import Coordinates, System, total_derivative
from lagrotor.mechanics.constraints import project_position, project_velocity, solve_constrained
from lagrotor.pair import (
    INERTIAS,
    J_OF,
    ansatz_integrals,
    axes_pair,
    axis,
    bar_curve,
    joint_line_momentum,
    link_constraint,
    mercator_axis,
    mercator_lagrangian,
    minimal_embedding,
    pair_lagrangian,
    pair_with_bar,
)
from lagrotor.pair.lagrangians import JOINT_LINE, ansatz_lagrangian
from lagrotor.pair.notation import (
    ANSATZ,
    AXES,
    G_1,
    G_2,
    I1,
    I3,
    MERCATOR,
    MINIMAL,
    PAIR,
    J,
    K,
    M,
    R,
    a,
    b,
    ell,
    k,
    m,
)

SEEDS = range(2)
VALUES = {M: 1.3, R: 0.9, I1: 0.7, I3: 1.1, m: 0.4, K: 0.05, ell: 1.2, G_1: 2.3, G_2: -1.7}
VALUES[J] = float(J_OF.subs(VALUES))
VALUES |= {s: float(e.subs(VALUES)) for s, e in INERTIAS.items()}


def evaluate(expressions: Any, state: dict[sp.Symbol, float]) -> np.ndarray:
    return np.array(sp.Matrix([expressions]).xreplace({s: sp.Float(v) for s, v in state.items()}).tolist(), dtype=float)


def value(expression: sp.Expr, state: dict[sp.Symbol, float]) -> float:
    return float(evaluate(expression, state)[0, 0])


def rotation(theta: complex, phi: complex, psi: complex) -> np.ndarray:
    """Rz(phi) Ry(theta) Rz(psi): carries the body's axis from e_z to (theta, phi)."""

    def about_z(x: complex) -> np.ndarray:
        return np.array([[np.cos(x), -np.sin(x), 0], [np.sin(x), np.cos(x), 0], [0, 0, 1]])

    tilt = np.array([[np.cos(theta), 0, np.sin(theta)], [0, 1, 0], [-np.sin(theta), 0, np.cos(theta)]])
    return about_z(phi) @ tilt @ about_z(psi)


def rotor_energy(q: np.ndarray, v: np.ndarray) -> float:
    """Centre's energy plus turning energy, angular velocity read off Rᵀ R' (R' by a complex step, exact)."""
    turned = rotation(*(q + 1e-30j * v))
    still, moving = turned.real, turned.imag / 1e-30
    skew = still.T @ moving
    body = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    centre = VALUES[R] / 2 * moving @ np.array([0, 0, 1])
    inertia = np.diag([VALUES[I1], VALUES[I1], VALUES[I3]])
    return VALUES[M] / 2 * centre @ centre + body @ inertia @ body / 2


def constrained(seed: int, c: Coordinates, g: tuple[sp.Expr, ...], guess: np.ndarray) -> dict[sp.Symbol, float]:
    """A random state of the coordinates c on the constraints g."""
    draw = np.random.default_rng(seed)
    g_at = sp.lambdify([c.q], [e.subs(VALUES) for e in g])
    G_at = sp.lambdify([c.q], sp.Matrix(g).jacobian(c.q).subs(VALUES))
    near = guess + draw.normal(0, 0.3, len(guess))
    q = project_position(lambda q: np.array(g_at(q)), lambda q: np.array(G_at(q)), near)
    v = project_velocity(np.array(G_at(q)), draw.normal(0, 1.5, len(guess)))
    return dict(zip(c.q + c.v, (*q.tolist(), *v.tolist()), strict=True)) | VALUES


@lru_cache
def state_of_axes(seed: int) -> dict[sp.Symbol, float]:
    return constrained(seed, AXES, axes_pair().constraints, np.array([0, 0, 1.0, 0, 0, 1.0]))


@lru_cache
def state_of_angles(seed: int) -> dict[sp.Symbol, float]:
    return constrained(seed, PAIR, pair_with_bar().constraints, np.array([0.8, 0.3, 1.0, 0.8, 0.3, 0.2]))


def accelerated(system: System, state: dict[sp.Symbol, float]) -> np.ndarray:
    """Constrained accelerations at one state."""
    parts = (system.mass_matrix, system.bias, system.rows, system.gamma, system.generalised_forces)
    M_at, h, G, gamma, Q_at = (evaluate(e, state) for e in parts)
    return solve_constrained(M_at, h.ravel(), G, gamma.ravel(), Q_at.ravel())[0]


def bar_energy(r1: np.ndarray, r2: np.ndarray, v1: np.ndarray, v2: np.ndarray) -> float:
    """A rigid bar between the tips: velocity of its centre, and d × d' / ell² its angular velocity."""
    length, reach = VALUES[ell], VALUES[R]
    d, d_v = np.array([length, 0, 0]) + reach * (r2 - r1), reach * (v2 - v1)
    centre, turning = reach * (v1 + v2) / 2, np.cross(d, d_v) / length**2
    assert np.linalg.norm(d) == pytest.approx(length)
    return VALUES[m] / 2 * centre @ centre + VALUES[K] / 2 * turning @ turning


@pytest.mark.parametrize("seed", SEEDS)
def test_the_bars_energy_is_that_of_a_rigid_body(seed: int) -> None:
    state = state_of_angles(seed)
    q, v = np.array([state[s] for s in PAIR.q]), np.array([state[s] for s in PAIR.v])
    r = [rotation(*q[i : i + 3])[:, 2] for i in (0, 3)]
    r_v = [rotation(*(q[i : i + 3] + 1e-30j * v[i : i + 3]))[:, 2].imag / 1e-30 for i in (0, 3)]
    whole = rotor_energy(q[:3], v[:3]) + rotor_energy(q[3:], v[3:]) + bar_energy(*r, *r_v)
    assert value(pair_with_bar().L, state) == pytest.approx(whole, rel=1e-12)
    # Twin: the coupling of the wrong sign.
    assert value(pair_with_bar().L, state | {b: -state[b]}) != pytest.approx(whole, rel=1e-4)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_axes_energy_is_that_of_the_bodies(seed: int) -> None:
    state = state_of_axes(seed)
    x, v = (np.array([state[s] for s in symbols]).reshape(2, 3) for symbols in (AXES.q, AXES.v))
    whole = VALUES[J] / 2 * (v**2).sum() + bar_energy(*x, *v)
    assert value(axes_pair().L, state) == pytest.approx(whole, rel=1e-12)
    assert value(axes_pair().L, state | {a: VALUES[J]}) != pytest.approx(whole, rel=1e-3)


def test_the_bars_constraint_is_its_length() -> None:
    r1, r2 = (sp.Matrix(AXES.q[i : i + 3]) for i in (0, 3))
    d = ell * JOINT_LINE + R * (r2 - r1)
    squares = sp.expand((d.dot(d) - ell**2) / (2 * R**2))
    z1, z2 = AXES.q[2], AXES.q[5]
    unit = {z1**2: 1 - r1[0] ** 2 - r1[1] ** 2, z2**2: 1 - r2[0] ** 2 - r2[1] ** 2}
    constraint = link_constraint(r1, r2)
    assert sp.expand(squares.subs(unit) - constraint.subs(k, ell / R)) == 0
    assert sp.expand(squares.subs(unit) - constraint.subs(k, -ell / R)) != 0


def test_the_ansatz_is_the_pair_turning_oppositely() -> None:
    (theta_1, theta_2, phi, psi), (dtheta_1, dtheta_2, dphi, dpsi) = ANSATZ.q, ANSATZ.v
    inserted = dict(zip(PAIR.q, (theta_1, phi, psi, theta_2, -phi, -psi), strict=True))
    inserted |= dict(zip(PAIR.v, (dtheta_1, dphi, dpsi, dtheta_2, -dphi, -dpsi), strict=True))
    assert sp.expand(pair_lagrangian().subs(inserted, simultaneous=True) - ansatz_lagrangian()) == 0
    A, B = ansatz_integrals()
    assert sp.expand(A - ansatz_lagrangian().diff(dphi)) == 0
    assert sp.expand(B - ansatz_lagrangian().diff(dpsi)) == 0


@lru_cache
def reduced_pair() -> System:
    """The spins taken out by Routh: four angles, the bar."""
    return pair_with_bar().routh({PAIR.q[2]: G_1, PAIR.q[5]: G_2})


def axes_and_accelerations(state: dict[sp.Symbol, float], signs: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """r'' of both axes from the Routhian in Euler angles, and from the axes with gyroscopic forces (signed)."""
    system = reduced_pair()
    q = system.c.q
    moved = state | dict(zip(system.c.a, accelerated(system, state), strict=True))
    r = sp.Matrix([*axis(q[0], q[1]), *axis(q[2], q[3])])
    v = r.applyfunc(lambda e: total_derivative(e, system.c))
    by_angles = evaluate(v.applyfunc(lambda e: total_derivative(e, system.c)), moved).ravel()
    at = VALUES | dict(zip((*AXES.q, *AXES.v), (*evaluate(r, state).ravel(), *evaluate(v, state).ravel()), strict=True))
    at |= {G_1: signs[0] * VALUES[G_1], G_2: signs[1] * VALUES[G_2]}
    return by_angles, axes_accelerated(at)


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_routh_reduction_leaves_a_gyroscopic_force_on_each_axis(seed: int) -> None:
    by_angles, by_axes = axes_and_accelerations(state_of_angles(seed), (1, 1))
    assert by_axes == pytest.approx(by_angles, abs=1e-10)
    # Twin: one spin turned round.
    _, wrong = axes_and_accelerations(state_of_angles(seed), (1, -1))
    assert np.abs(wrong - by_angles).max() > 1e-2


def axes_accelerated(state: dict[sp.Symbol, float]) -> np.ndarray:
    return accelerated(axes_pair(), state)


def rate_of(expression: sp.Expr, state: dict[sp.Symbol, float]) -> float:
    """d/dt of f(axes, rates) along the constrained pair with its gyroscopic forces."""
    moved = dict(zip(AXES.a, axes_accelerated(state), strict=True))
    return value(total_derivative(expression, AXES), state | moved)


@pytest.mark.parametrize("seed", SEEDS[:2])
def test_the_momentum_about_the_joint_line_is_conserved_and_the_ansatz_integral_is_not(seed: int) -> None:
    state = state_of_axes(seed)
    assert rate_of(joint_line_momentum(), state) == pytest.approx(0, abs=1e-12)
    # The ansatz integral A = p_phi1 − p_phi2 on the axes: the bar does not let it be.
    x1, y1, z1, x2, y2, z2 = AXES.q
    x1_v, y1_v, _, x2_v, y2_v, _ = AXES.v
    about_1, about_2 = J * (x1 * y1_v - y1 * x1_v) + G_1 * z1, J * (x2 * y2_v - y2 * x2_v) + G_2 * z2
    assert abs(rate_of(about_1 - about_2, state)) > 1e-2
    # Nor is P with one spin's share of the wrong sign.
    assert abs(rate_of(joint_line_momentum() - 2 * G_1 * x1, state)) > 1e-2


def test_turning_about_the_joint_line_is_a_symmetry_of_the_pair_and_turning_about_the_vertical_is_not() -> None:
    r1, r2 = (sp.Matrix(AXES.q[i : i + 3]) for i in (0, 3))

    def invariance(about: sp.Matrix, bar: bool = True) -> str:
        turn = [*about.cross(r1), *about.cross(r2)]
        return replace(axes_pair(bar), forces=()).invariance(turn).answer

    assert invariance(JOINT_LINE) == "zero"
    assert invariance(sp.Matrix([0, 0, 1])) == "nonzero"
    # Without the bar every turn is one.
    assert invariance(sp.Matrix([0, 0, 1]), bar=False) == "zero"


def test_in_mercator_coordinates_the_bar_knows_only_twist_and_latitude() -> None:
    u1, al1, u2, al2 = MERCATOR.q
    by_name = {sp.tanh(u): sp.sinh(u) / sp.cosh(u) for u in (u1, u2)}
    scaled = link_constraint(mercator_axis(u1, al1), mercator_axis(u2, al2)).subs(by_name) * sp.cosh(u1) * sp.cosh(u2)
    w, Delta = u1 - u2, al2 - al1

    def difference(sign: int) -> sp.Expr:
        """Zero by the addition theorems alone, once everything is in functions of one angle."""
        claimed = sp.cosh(w) - sign * k * sp.sinh(w) - sp.cos(Delta)
        return sp.expand(scaled - sp.expand_trig(claimed))

    assert difference(1) == 0
    assert difference(-1) != 0


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))])
def test_the_mercator_lagrangian_moves_the_axes_alike(seed: int) -> None:
    """Its constrained accelerations, seen on the axes, are those of the unit vectors with gyroscopic forces."""
    state = state_of_axes(seed)
    x, v = (np.array([state[s] for s in symbols]).reshape(2, 3) for symbols in (AXES.q, AXES.v))
    u, alpha = np.arctanh(x[:, 0]), np.arctan2(-x[:, 1], x[:, 2])
    squared = 1 - x[:, 0] ** 2
    u_v, alpha_v = v[:, 0] / squared, (x[:, 1] * v[:, 2] - x[:, 2] * v[:, 1]) / squared
    at = VALUES | dict(zip(MERCATOR.q, (u[0], alpha[0], u[1], alpha[1]), strict=True))
    at |= dict(zip(MERCATOR.v, (u_v[0], alpha_v[0], u_v[1], alpha_v[1]), strict=True))
    r = [mercator_axis(*MERCATOR.q[:2]), mercator_axis(*MERCATOR.q[2:])]
    system = System(MERCATOR, mercator_lagrangian(), (link_constraint(*r),))
    moved = at | dict(zip(MERCATOR.a, accelerated(system, at), strict=True))
    rates = sp.Matrix([*r[0], *r[1]]).applyfunc(lambda e: total_derivative(e, MERCATOR))
    by_mercator = evaluate(rates.applyfunc(lambda e: total_derivative(e, MERCATOR)), moved).ravel()
    assert by_mercator == pytest.approx(axes_accelerated(state), abs=1e-10)
    assert value(mercator_lagrangian().subs({G_1: 0, G_2: 0}), at) == pytest.approx(value(axes_pair().L, state))


RATIOS = {"short": 0.7, "equal": 1.0, "long": 1.6}


@pytest.mark.parametrize("ratio", RATIOS)
@settings(max_examples=5, deadline=None)
@given(chi=st.floats(-1.5, 1.5), U=st.floats(-1, 1), alpha=st.floats(-3, 3))
def test_the_bars_curve_satisfies_the_bar(ratio: Any, chi: float, U: float, alpha: float) -> None:
    curve = bar_curve(ratio)
    at = dict(zip(MINIMAL.q, (U, chi, alpha), strict=True)) | {k: RATIOS[ratio]}
    # Folded over, where |chi| > pi/2, the short bar's curve goes on; so does the long one's.
    if ratio != "equal":
        at[MINIMAL.q[1]] = 2 * chi
    embedding = minimal_embedding(curve.twist, curve.latitude)
    u1, al1, u2, al2 = (embedding[q] for q in MERCATOR.q)
    g = link_constraint(mercator_axis(u1, al1), mercator_axis(u2, al2))
    assert value(g, at) == pytest.approx(0, abs=1e-12)
    rho = k * sp.cosh(curve.latitude) - sp.sinh(curve.latitude)
    size = value(sp.cosh(curve.latitude), at)
    assert value(curve.rho, at) == pytest.approx(value(rho, at), abs=1e-13 * size**2)
