"""Symmetries: cyclic coordinates, Noether integrals with and without constraints, Legendre and Routh."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.algebra import decide_zero
from lagrotor.mechanics import (
    Coordinates,
    Frame,
    System,
    accelerations,
    constrained_accelerations,
    coordinates,
    energy,
    legendre,
    momenta,
    total_derivative,
)
from lagrotor.mechanics.symmetry import variation
from tests.systems import I1, I3, VALUES, g, heavy_top, k, kepler, l, m

TOP = coordinates("theta phi psi")
PLANE = coordinates("x y")
SPACE = coordinates("x y z")
TURN = (-PLANE.q[1], PLANE.q[0])


def falling() -> sp.Expr:
    return m * sum(v**2 for v in SPACE.v) / 2 - m * g * SPACE.q[2]


def random_state(c: Coordinates, seed: int) -> dict[sp.Symbol, float]:
    draw = np.random.default_rng(seed)
    return {s: float(draw.uniform(0.3, 1.2)) for s in c.q + c.v} | VALUES


def test_the_angles_a_top_does_not_feel_are_cyclic() -> None:
    assert heavy_top().cyclic == TOP.q[1:]
    # Present in the expression, absent from the function.
    x, y = PLANE.q
    hidden = PLANE.v[0] ** 2 + (sp.sin(x) ** 2 + sp.cos(x) ** 2) * PLANE.v[1] ** 2 - y**2
    assert System(PLANE, hidden).cyclic == (x,)


def test_the_momenta_of_cyclic_angles_are_noether_integrals_and_stay() -> None:
    L = heavy_top().L
    moved = dict(zip(TOP.a, accelerations(L, TOP), strict=True))
    for index, xi in ((1, (0, 1, 0)), (2, (0, 0, 1))):
        integral = System(TOP, L).noether(xi).expression
        assert (integral - momenta(L, TOP)[index]).expand() == 0
        drift = total_derivative(integral, TOP).subs(moved)
        assert float(drift.subs(random_state(TOP, 1))) == pytest.approx(0, abs=1e-11)


def test_dilation_gives_the_virial_theorem_and_a_turn_the_angular_momentum() -> None:
    """d/dt (p · q) = 2 T − k/r: not zero, and the velocities are carried along with the positions."""
    (x, y), (vx, vy), orbit = PLANE.q, PLANE.v, kepler(2)
    virial = m * (vx**2 + vy**2) - k / sp.sqrt(x**2 + y**2)
    state = random_state(PLANE, 5)
    moved = dict(zip(PLANE.a, accelerations(orbit.L, PLANE), strict=True))
    true_rate = total_derivative(momenta(orbit.L, PLANE).dot(PLANE.q), PLANE).subs(moved)
    for rate in (orbit.noether_rate(PLANE.q), true_rate):
        assert float((rate - virial).subs(state)) == pytest.approx(0, abs=1e-13)
    assert (orbit.noether(TURN).expression - m * (x * vy - y * vx)).expand() == 0
    pulled = System(PLANE, orbit.L - g * y)
    assert (variation(pulled, TURN) + g * x).expand() == 0 and pulled.invariance(TURN).answer != "zero"


@pytest.mark.parametrize(("tilt", "conserved"), [(sp.S.Zero, True), (sp.Rational(1, 2), False)])
def test_a_tilted_plane_breaks_the_rotation_that_the_free_fall_has(tilt: sp.Expr, conserved: bool) -> None:
    """The Lagrangian is invariant about the vertical either way; only a tilted plane's normal force has a torque."""
    (x, y, z), (vx, vy, vz) = SPACE.q, SPACE.v
    turn = (-y, x, sp.S.Zero)
    system = System(SPACE, falling(), (z - tilt * x,))
    assert decide_zero(variation(system, turn)).answer == "zero"
    assert (system.noether_rate(turn) - system.multipliers[0] * tilt * y).expand() == 0
    assert (system.invariance(turn).answer == "zero") is conserved
    # The rate is the true one along the constrained motion.
    a, multipliers = constrained_accelerations(system)
    state = random_state(SPACE, 2) | {vz: 0.4}
    moved = dict(zip(SPACE.a, a, strict=True))
    true_rate = total_derivative(m * (x * vy - y * vx), SPACE).subs(moved)
    predicted = system.noether_rate(turn).subs(system.multipliers[0], multipliers[0])
    assert float((true_rate - predicted).subs(state)) == pytest.approx(0, abs=1e-11)
    assert (abs(float(true_rate.subs(state))) < 1e-12) is conserved


def test_the_routhian_of_a_body_is_free_of_the_cyclic_coordinates_and_runs() -> None:
    """A body's energy holds its spin angle in sin² + cos² = 1 until that is reduced."""
    theta, phi, psi = TOP.q
    body = Frame(TOP).turned("zxz", (phi, theta, psi)).body(m, (I1, I1, I3), (0, 0, l))
    reduced = System(TOP, body.kinetic - m * g * l * sp.cos(theta)).routh("phi psi")
    assert not reduced.L.free_symbols & {phi, psi}
    values = {I1: 1, I3: 0.5, m: 1, g: 9.81, l: 1, "p_phi": 8, "p_psi": 9}
    run = reduced.simulate(values, (0.5,), (0,), np.linspace(0, 1, 3))
    assert np.ptp(run.energy) < 1e-7 and np.ptp(run.q) > 0.1


@pytest.mark.parametrize("cyclic", [(1,), (2,), (1, 2), (2, 1)])
def test_the_routhian_moves_the_other_coordinates_as_the_lagrangian_does(cyclic: tuple[int, ...]) -> None:
    L, kept = heavy_top().L, [i for i in range(3) if i not in cyclic]
    p = sp.symbols(f"p:{len(cyclic)}", real=True)
    reduced_top = System(TOP, L).routh(dict(zip((TOP.q[i] for i in cyclic), p, strict=True)))
    assert not reduced_top.L.free_symbols & {TOP.v[i] for i in cyclic}
    state = random_state(TOP, 3)
    values = {symbol: momenta(L, TOP)[i].subs(state) for symbol, i in zip(p, cyclic, strict=True)}
    reduced = accelerations(reduced_top.L, reduced_top.c).subs(state | values)
    full = accelerations(L, TOP).subs(state)
    np.testing.assert_allclose([float(x) for x in reduced], [float(full[i]) for i in kept], rtol=1e-10)


def test_hamiltons_equations_reproduce_the_top() -> None:
    L, p = heavy_top().L, sp.symbols("p:3", real=True)
    H = legendre(L, TOP, p)
    state = random_state(TOP, 4)
    at_p = dict(zip(p, momenta(L, TOP).subs(state), strict=True)) | state
    moved = dict(zip(TOP.a, accelerations(L, TOP).subs(state), strict=True))
    assert float(H.subs(at_p)) == pytest.approx(float(energy(L, TOP).subs(state)))
    for q, v, a_momentum, momentum in zip(TOP.q, TOP.v, p, momenta(L, TOP), strict=True):
        assert float(sp.diff(H, a_momentum).subs(at_p)) == pytest.approx(state[v])
        change = total_derivative(momentum, TOP).subs(moved).subs(state)
        assert float(-sp.diff(H, q).subs(at_p)) == pytest.approx(float(change), abs=1e-10)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(-3, 3), min_size=4, max_size=4))
def test_a_translation_is_a_symmetry_exactly_of_the_springs_it_does_not_stretch(xi: list[int]) -> None:
    """Four particles in a chain of equal springs: only moving all alike leaves every spring unstretched."""
    c = coordinates("x1 x2 x3 x4")
    stretched = sum((right - left) ** 2 for left, right in zip(c.q, c.q[1:], strict=False))
    L = m * sum(v**2 for v in c.v) / 2 - k * stretched / 2
    assert (System(c, L).invariance(xi).answer == "zero") is (len({*xi}) == 1)
