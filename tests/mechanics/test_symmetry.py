"""Symmetries: cyclic coordinates, Noether integrals with and without constraints, Legendre and Routh."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.algebra import decide_zero
from lagrotor.errors import DomainError, InputError, NotASymmetryError, SingularError
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
from tests.systems import I1, I3, g, heavy_top, k, kepler, l, m

VALUES = {m: 1.3, l: 0.7, g: 9.81, k: 2.0, I1: 0.6, I3: 0.25}

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
    with pytest.raises(NotASymmetryError, match=r"noether: .*nonzero.*δL = "):
        System(TOP, L).noether((1, 0, 0))


def test_a_rotated_kepler_orbit_keeps_its_angular_momentum() -> None:
    (x, y), (vx, vy) = PLANE.q, PLANE.v
    assert (kepler(2).noether(TURN).expression - m * (x * vy - y * vx)).expand() == 0
    assert kepler(2).invariance(TURN).answer == "zero"


def test_dilation_gives_the_virial_theorem() -> None:
    """d/dt (p · q) = 2 T − k/r: not zero, and the velocities are carried along with the positions."""
    (x, y), (vx, vy) = PLANE.q, PLANE.v
    virial = m * (vx**2 + vy**2) - k / sp.sqrt(x**2 + y**2)
    rate = kepler(2).noether_rate(PLANE.q)
    state = random_state(PLANE, 5)
    assert float((rate - virial).subs(state)) == pytest.approx(0, abs=1e-13)
    moved = dict(zip(PLANE.a, accelerations(kepler(2).L, PLANE), strict=True))
    true_rate = total_derivative(momenta(kepler(2).L, PLANE).dot(PLANE.q), PLANE).subs(moved)
    assert float((true_rate - virial).subs(state)) == pytest.approx(0, abs=1e-13)


def test_a_kepler_orbit_in_a_uniform_field_does_not() -> None:
    pulled = kepler(2).L - g * PLANE.q[1]
    assert (System(PLANE, pulled).variation(TURN) + g * PLANE.q[0]).expand() == 0
    assert System(PLANE, pulled).invariance(TURN).answer != "zero"
    with pytest.raises(NotASymmetryError, match="does not leave the motion invariant"):
        System(PLANE, pulled).noether(TURN)


@pytest.mark.parametrize(("tilt", "conserved"), [(sp.S.Zero, True), (sp.Rational(1, 2), False)])
def test_a_tilted_plane_breaks_the_rotation_that_the_free_fall_has(tilt: sp.Expr, conserved: bool) -> None:
    """The Lagrangian is invariant about the vertical either way; only a tilted plane's normal force has a torque."""
    (x, y, z), (vx, vy, vz) = SPACE.q, SPACE.v
    turn = (-y, x, sp.S.Zero)
    system = System(SPACE, falling(), (z - tilt * x,))
    assert decide_zero(system.variation(turn)).answer == "zero"
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


def test_a_sphere_keeps_the_rotation_about_the_vertical() -> None:
    x, y, z = SPACE.q
    pendulum = System(SPACE, falling(), ((x**2 + y**2 + z**2 - l**2) / 2,))
    assert pendulum.invariance((-y, x, 0)).answer == "zero"
    assert pendulum.invariance((0, -z, y)).answer == "nonzero"


def test_transformations_have_their_shapes() -> None:
    with pytest.raises(InputError, match="one component"):
        kepler(2).variation((1,))
    with pytest.raises(InputError, match="free of accelerations"):
        kepler(2).variation(PLANE.a)
    with pytest.raises(InputError, match=r"gauge = .* contains x_ddot"):
        kepler(2).noether(TURN, PLANE.a[0])


def test_the_routhian_of_a_top_is_its_effective_potential() -> None:
    p_phi, p_psi = sp.symbols("p_phi p_psi", real=True)
    theta, dtheta = TOP.q[0], TOP.v[0]
    effective = (p_phi - p_psi * sp.cos(theta)) ** 2 / (2 * I1 * sp.sin(theta) ** 2) + p_psi**2 / (2 * I3)
    expected = I1 * dtheta**2 / 2 - effective - m * g * l * sp.cos(theta)
    difference = heavy_top().routh("phi psi").L - expected
    assert decide_zero(difference).answer == "zero"


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


def test_only_cyclic_coordinates_are_eliminated() -> None:
    top = heavy_top()
    with pytest.raises(NotASymmetryError, match="depends on theta"):
        top.routh("theta")
    with pytest.raises(InputError, match="p not among"):
        top.routh("p")
    with pytest.raises(InputError, match="each once"):
        top.routh("phi phi")
    with pytest.raises(InputError, match="not used yet; rename"):
        top.routh({"phi": TOP.v[1]})
    with pytest.raises(InputError, match="not used yet; rename"):
        System(TOP, heavy_top().L + sp.Symbol("p_phi", real=True)).routh("phi")
    free = coordinates("x y")
    with pytest.raises(InputError, match="no coordinate is left"):
        System(free, free.v[0] ** 2 + free.v[1] ** 2).routh("x y")


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


def test_a_lagrangian_without_a_hamiltonian_in_closed_form_is_refused() -> None:
    p = sp.symbols("p:2")
    with pytest.raises(DomainError, match="not quadratic"):
        legendre(PLANE.v[0] ** 2 + PLANE.v[1] ** 4, PLANE, p)
    with pytest.raises(SingularError, match="does not determine the velocities"):
        legendre((PLANE.v[0] + PLANE.v[1]) ** 2, PLANE, p)
    with pytest.raises(InputError, match="legendre: momenta"):
        legendre(kepler(2).L, PLANE, p[:1])


small = st.integers(-3, 3)
entries = st.lists(small, min_size=4, max_size=4)


@settings(max_examples=15, deadline=None)
@given(entries, entries, entries, entries)
def test_energy_is_the_hamiltonian_at_the_momenta(
    mass: list[int], field: list[int], well: list[int], at: list[int]
) -> None:
    q, v, A = sp.Matrix(PLANE.q), sp.Matrix(PLANE.v), sp.Matrix(2, 2, mass)
    M = A.T * A + sp.diag(1 + PLANE.q[1] ** 2, 1)
    L = (v.T * M * v)[0] / 2 + (q.T * sp.Matrix(2, 2, field) * v)[0] - (q.T * sp.Matrix(2, 2, well) * q)[0]
    p = sp.symbols("p:2", real=True)
    state = dict(zip(PLANE.q + PLANE.v, at, strict=True))
    at_p = dict(zip(p, momenta(L, PLANE).subs(state), strict=True))
    assert legendre(L, PLANE, p).subs(at_p).subs(state) == energy(L, PLANE).subs(state)


@settings(max_examples=15, deadline=None)
@given(entries)
def test_a_translation_is_a_symmetry_exactly_of_the_springs_it_does_not_stretch(xi: list[int]) -> None:
    """Four particles in a chain of equal springs: only moving all alike leaves every spring unstretched."""
    c = coordinates("x1 x2 x3 x4")
    stretched = sum((right - left) ** 2 for left, right in zip(c.q, c.q[1:], strict=False))
    L = m * sum(v**2 for v in c.v) / 2 - k * stretched / 2
    assert (System(c, L).invariance(xi).answer == "zero") is (len({*xi}) == 1)
