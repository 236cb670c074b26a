"""Linear modes, equilibria and conditions of stability of textbook systems."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, LinearSystem, System, coordinates
from tests.systems import I1, I3, Omega, R, g, heavy_top, hoop, k, l, m, pendulum, rod_pendulum


def test_a_rod_holds_its_pendulum_by_a_multiplier() -> None:
    """x² + y² = l²: hanging, the linear stiffness comes from the rod's force alone; w² = g/l, as of the angle."""
    system = rod_pendulum()
    (x, y), (theta,) = system.c.q, pendulum().c.q
    assert {e.at[y] for e in system.equilibria()} == {l, -l}
    assert [dict(e.at) for e in pendulum().equilibria()] == [{theta: 0}, {theta: sp.pi}]
    hanging, standing = (system.linearise({x: 0, y: end}) for end in (-l, l))
    assert hanging.basis.shape == (2, 1) and standing.stable_if == sp.false and hanging.stable_if == sp.true
    for mode in (*hanging.modes(), *pendulum().linearise({theta: 0}).modes()):
        assert decide_equal(mode.rate**2, -g / l).answer == "zero"


def test_a_bead_leaves_the_lowest_point_when_the_hoop_turns_faster_than_g_over_R() -> None:
    """Goldstein, problem 2.17: cos theta = g/(R Omega²), stable where it exists; the bottom is stable below."""
    system = hoop()
    theta = system.c.q[0]
    found = {e.at[theta]: e for e in system.equilibria()}
    tilted = sp.acos(g / (R * Omega**2))
    assert set(found) == {0, sp.pi, tilted, -tilted}
    assert system.linearise(found[0]).stable_if == (g - R * Omega**2 > 0)
    assert system.linearise(found[tilted]).stable_if == (R * Omega**2 - g > 0)
    assert sp.Le(g / (R * Omega**2), 1) in found[tilted].domain


def test_a_top_sleeps_when_its_momentum_squared_exceeds_4_I1_m_g_l() -> None:
    """Goldstein §5.7. Upright, both momenta are equal, and the Routhian is 0/0 there: it is reduced first."""
    p = sp.Symbol("p", real=True)
    upright = heavy_top().routh({"phi": p, "psi": p}).linearise({heavy_top().c.q[0]: 0})
    assert upright.stable_if == sp.Gt(p**2 - 4 * I1 * m * g * l, 0)
    # The same from two regular angles, where the gyroscopic term is at work.
    c = coordinates("a b psi")
    (a, b, _), (a_v, b_v, psi_v) = c.q, c.v
    across = a_v**2 * sp.cos(b) ** 2 + b_v**2
    regular = System(c, (I1 * across + I3 * (psi_v + a_v * sp.sin(b)) ** 2) / 2 - m * g * l * sp.cos(a) * sp.cos(b))
    assert regular.routh({"psi": p}).linearise({a: 0, b: 0}).stable_if == sp.Gt(p**2 - 4 * I1 * m * g * l, 0)


def test_steady_precession_is_solved_for_the_momentum_where_the_angle_is_a_quartic() -> None:
    reduced = heavy_top().routh("phi psi")
    found = reduced.equilibria("p_phi")
    assert len(found) == 2
    # Against the quadratic of the precession rate, I1 cos(theta) n² − p_psi n + m g l = 0 with p_phi = I1 n sin² + p_psi cos.
    values = {I1: 0.7, m: 1.1, g: 9.81, l: 0.4, sp.Symbol("p_psi", real=True): 5.0, heavy_top().c.q[0]: 0.6}
    rates = np.roots([0.7 * np.cos(0.6), -5.0, 1.1 * 9.81 * 0.4])
    expected = sorted(0.7 * n * np.sin(0.6) ** 2 + 5.0 * np.cos(0.6) for n in rates)
    solved = sorted(float(e.at[sp.Symbol("p_phi", real=True)].subs(values)) for e in found)
    assert solved == pytest.approx(expected, rel=1e-12)


def test_what_no_force_depends_on_stays_free_in_an_equilibrium() -> None:
    """At x = 0 the angle is any; elsewhere cos φ would have to be −2."""
    c = coordinates("x phi")
    (x, phi), (x_v, phi_v) = c.q, c.v
    assert [e.at for e in System(c, x_v**2 + phi_v**2 - x**2 * (2 + sp.cos(phi))).equilibria()] == [{x: 0, phi: phi}]


def test_friction_makes_the_condition_of_routh_and_hurwitz() -> None:
    """A follower-free pair: s² + c s + k is stable for k > 0 alone; a negative friction never."""
    c, w = coordinates("x"), sp.Symbol("w", real=True)
    damped = System(c, c.v[0] ** 2 / 2 - w * c.q[0] ** 2 / 2, dissipation=k * c.v[0] ** 2 / 2)
    assert damped.linearise({c.q[0]: 0}).stable_if == sp.Gt(w, 0)
    driven = System(c, c.v[0] ** 2 / 2 - w * c.q[0] ** 2 / 2, forces=(k * c.v[0],))
    assert driven.linearise({c.q[0]: 0}).stable_if == sp.false


def test_a_steady_turn_is_linearised_with_its_velocity() -> None:
    """A spherical pendulum that turns at the rate Omega: the frequency of its nutation, Omega² (1 + 3 cos² theta)."""
    c = coordinates("theta phi")
    (theta, _), (theta_v, phi_v) = c.q, c.v
    L = m * l**2 * (theta_v**2 + sp.sin(theta) ** 2 * phi_v**2) / 2 + m * g * l * sp.cos(theta)
    tilt = sp.Symbol("theta_0", real=True)
    steady = System(c, L.subs(g, l * Omega**2 * sp.cos(tilt))).linearise({theta: tilt, phi_v: Omega})
    s = sp.Symbol("s")
    squared = steady.characteristic(s) / (steady.mass.det() * s**2) - s**2
    assert decide_equal(squared, Omega**2 * (1 + 3 * sp.cos(tilt) ** 2)).answer == "zero"


def test_modes_are_numbers_where_no_closed_form_is() -> None:
    c = coordinates("x y z")
    springs = sum((k + i) * (a - b) ** 2 for i, (a, b) in enumerate(zip(c.q, (*c.q[1:], 0), strict=True)))
    system = System(c, sum(v**2 for v in c.v) / 2 - springs / 2)
    linear = system.linearise(dict.fromkeys(c.q, 0))
    rates = system.linearise(dict.fromkeys(c.q, 0), {k: 2.0}).rates
    stiffness = np.array(linear.stiffness.subs(k, 2.0).tolist(), float)
    assert sorted(abs(rates)) == pytest.approx(np.sqrt(np.linalg.eigvalsh(stiffness)).repeat(2), rel=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(-4, 4), min_size=4, max_size=4))
def test_the_condition_of_stability_says_what_the_eigenvalues_say(entries: list[int]) -> None:
    """Random gyroscopic systems of two coordinates, exact condition against numeric roots, away from the border."""
    b, p, q, r = entries
    K, C = sp.Matrix([[p, q], [q, r]]), sp.Matrix([[0, b], [-b, 0]])
    linear = LinearSystem(sp.eye(2), C, K, sp.eye(2))
    s = sp.Symbol("s")
    squares = np.roots([float(x) for x in sp.Poly(linear.characteristic(s), s).all_coeffs()[::2]])
    gap = min(abs(squares[0] - squares[1]), *abs(squares))
    if gap < 1e-6:
        return
    stable = bool((abs(squares.imag) < 1e-9).all() and (squares.real < 0).all())
    assert bool(linear.stable_if) is stable


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(1, 6), min_size=5, max_size=5))
def test_the_determinants_of_routh_and_hurwitz_say_what_the_roots_say(entries: list[int]) -> None:
    """Two damped coordinates with a circulatory force: every coefficient is positive, so that the determinants decide."""
    p, q, r, b, d = entries
    K, C = sp.Matrix([[p, q], [-q, r]]), sp.diag(b, d)
    linear = LinearSystem(sp.eye(2), C, K, sp.eye(2))
    s = sp.Symbol("s")
    coefficients = [float(x) for x in sp.Poly(linear.characteristic(s), s).all_coeffs()]
    roots = np.roots(coefficients)
    if np.abs(roots.real).min() > 1e-6:
        assert bool(linear.stable_if) is bool((roots.real < 0).all())


def test_where_the_coordinates_are_singular_an_equilibrium_says_so() -> None:
    """A pendulum turned about x, then y: of its eight points without a force along a coordinate, four are horizontal."""
    c = coordinates("a b")
    bob = Frame(c).turned("xy", c.q).body(m, centre=(0, 0, -l))
    found = System(c, bob.kinetic - bob.potential((0, 0, -g))).equilibria()
    assert {(e.regular, abs(e.at[c.q[0]])) for e in found} == {(True, 0), (True, sp.pi), (False, sp.pi / 2)}


def test_rates_of_independent_modes_may_be_equal_and_those_of_dependent_ones_not() -> None:
    k, d = sp.symbols("k d", real=True)
    c = coordinates("x y")
    (x, y), (u, v) = c.q, c.v
    free, rest = (u**2 + v**2) / 2, {x: 0, y: 0}
    assert System(c, free - k * (x**2 + y**2) / 2).linearise(rest).stable_if == (k > 0)
    damped = System(c, free - (x**2 + y**2) / 2, forces=(-d * u, -d * v))
    assert damped.linearise(rest).stable_if == damped.linearise(rest, inputs=(), outputs=(x,)).stable_if == (d > 0)
    assert (
        System(c, free - (x**2 + y**2) / 2, forces=(0, x)).linearise(rest).stable_if == sp.false
    )  # y grows as t sin t
    ring = System(c, free - (x**2 + (x - y) ** 2 + y**2) / 2 - k * (x + y) ** 2 / 2)
    assert ring.linearise(rest).stable_if == sp.And(k + 2 > 0, 2 * k + 1 > 0)


def test_zero_rates_are_left_aside_only_where_motions_drift() -> None:
    """Beside a steady velocity nothing may grow: x'' = w y', y'' = −w x' − k y has y = t², x ~ t³ at k = −w²."""
    c = coordinates("x y")
    (x, y), (u, v) = c.q, c.v
    free, rest = (u**2 + v**2) / 2 + 2 * y * u, {x: 0, y: 0}
    assert System(c, free + k * y**2 / 2).linearise(rest).stable_if == (4 - k > 0)
    assert System(c, free + 2 * y**2).linearise(rest).stable_if == sp.false
    assert System(c, (u**2 + v**2) / 2, forces=(y, 0)).linearise(rest).stable_if == sp.false
    for L in (free, (u**2 + v**2) / 2, (u**2 + v**2 - (x - y) ** 2) / 2):
        assert System(c, L).linearise(rest).stable_if == sp.true


def test_a_damped_mode_is_judged_beside_an_undamped_one() -> None:
    c, d = coordinates("x y"), sp.Symbol("d", real=True)
    (x, y), (u, v) = c.q, c.v
    L, rest = (u**2 + v**2 - x**2 - k * y**2) / 2, {x: 0, y: 0}
    assert System(c, L, forces=(-d * u, 0)).linearise(rest).stable_if == (d > 0)
    assert System(c, L, forces=(-d * u, 2 * k * y)).linearise(rest).stable_if == sp.false


@pytest.mark.parametrize("stiffness", [0.7, sp.sqrt(2)])
def test_equal_rates_of_gyroscopic_systems_are_seen_in_any_numbers(stiffness: float | sp.Expr) -> None:
    turn = sp.diag(*[sp.Matrix([[0, -1], [1, 0]])] * 2) * stiffness / 2
    assert LinearSystem(sp.eye(4), turn, sp.eye(4) * stiffness, sp.eye(4)).stable_if == sp.true
    coupled = sp.eye(4) * stiffness
    coupled[0, 2] = coupled[1, 3] = sp.Rational(1, 10)  # the second drives the first at its own rate
    assert LinearSystem(sp.eye(4), turn, coupled, sp.eye(4)).stable_if == sp.false


def test_modes_in_numbers_have_the_shapes_of_the_generalized_eigenvalue_problem() -> None:
    """Two masses and three different springs: K u = w² M u by scipy; a symbol without a value is named."""
    c = coordinates("x y")
    (x, y), (v, w) = c.q, c.v
    linear = System(c, m * v**2 / 2 + w**2 - k * x**2 / 2 - (x - y) ** 2 - y**2 / 4).linearise({x: 0, y: 0})
    squares, shapes = eigh([[3.5, -2], [-2, 2.5]], np.diag([0.7, 2.0]))
    modes = linear.modes({m: 0.7, k: 1.5})
    assert [abs(complex(mode.rate)) for mode in modes] == pytest.approx(np.sqrt(np.repeat(squares, 2)))
    for mode, shape in zip(modes[::2], shapes.T, strict=True):
        assert complex(mode.shape[1] / mode.shape[0]) == pytest.approx(shape[1] / shape[0])
    with pytest.raises(InputError, match="modes"):
        linear.modes({m: 0.7})
