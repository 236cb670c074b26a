"""Systems with time, forces, friction and velocity constraints: textbook equations, laws of energy, refusals."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics import System, constrained_accelerations, coordinates, t, total_derivative
from tests.systems import J, Omega, R, g, hoop, k, l, m, sleigh

A, w = sp.symbols("A omega", positive=True)
ANGLE = coordinates("theta")
(theta,), (theta_v,), (theta_a,) = ANGLE.q, ANGLE.v, ANGLE.a
SPACE = coordinates("x y z")
PARTICLE = m * sum(v**2 for v in SPACE.v) / 2 - m * g * SPACE.q[2]


def driven_bead() -> System:
    """The same from the particle in space, its place given in theta and the time."""
    place = (R * sp.sin(theta) * sp.cos(Omega * t), R * sp.sin(theta) * sp.sin(Omega * t), -R * sp.cos(theta))
    return System(SPACE, PARTICLE).in_coordinates(ANGLE, dict(zip(SPACE.q, place, strict=True)))


def kapitza() -> System:
    """A pendulum on a pivot that is shaken by A cos(omega t) up and down; theta from below."""
    height = A * sp.cos(w * t) - l * sp.cos(theta)
    place = {SPACE.q[0]: l * sp.sin(theta), SPACE.q[1]: sp.S.Zero, SPACE.q[2]: height}
    return System(SPACE, PARTICLE).in_coordinates(ANGLE, place)


def test_time_in_the_lagrangian_enters_the_equation_of_motion() -> None:
    """Landau & Lifshitz §30: l theta'' = −(g − A omega² cos omega t) sin theta."""
    expected = -(g - A * w**2 * sp.cos(w * t)) * sp.sin(theta) / l
    found = constrained_accelerations(kapitza())[0][0]
    assert decide_equal(found, expected).answer == "zero"
    # The twin that drops ∂/∂t of the momentum moves otherwise.
    L = kapitza().L
    dropped = -(total_derivative(sp.diff(L, theta_v), ANGLE) - sp.diff(L, theta_v, t) - sp.diff(L, theta)).subs(
        theta_a, 0
    )
    assert decide_equal(dropped / (m * l**2), expected).answer == "nonzero"


def test_a_bead_seen_from_the_ground_moves_as_the_bead_seen_from_the_hoop() -> None:
    decision = driven_bead().same_as(hoop())
    assert decision.answer == "zero"
    slower = hoop().L.subs(Omega, Omega / 2)
    assert driven_bead().power == 0 and kapitza().power != 0  # the time in the first L cancels
    other = driven_bead().same_as(System(ANGLE, slower))
    assert other.answer == "nonzero" and other.witness is not None


def test_the_jacobi_integral_of_the_hoop_is_conserved_and_the_energy_is_not() -> None:
    bead, seen = hoop(), driven_bead()
    assert bead.conserved(bead.energy).answer == "zero"
    assert bead.power == 0
    kinetic_and_potential = bead.energy + m * R**2 * Omega**2 * sp.sin(theta) ** 2
    assert seen.conserved(kinetic_and_potential).answer == "nonzero"
    # The law of energy holds for the driven one too.
    moved = total_derivative(seen.energy, ANGLE).subs(theta_a, constrained_accelerations(seen)[0][0])
    assert decide_equal(moved, seen.power).answer == "zero"


def test_a_moving_constraint_gives_the_motion_of_its_solution_and_its_power() -> None:
    """A particle on a turning straight wire, y = x tan(Omega t): along it r'' = Omega² r."""
    c = coordinates("x y")
    (x, y), (x_v, y_v) = c.q, c.v
    wire = System(c, m * (x_v**2 + y_v**2) / 2, (y * sp.cos(Omega * t) - x * sp.sin(Omega * t),))
    r = coordinates("r")
    place = {x: r.q[0] * sp.cos(Omega * t), y: r.q[0] * sp.sin(Omega * t)}
    solved = wire.in_coordinates(r, place)
    assert solved.constraints == ()
    (along,) = constrained_accelerations(solved)[0]
    assert decide_equal(along, Omega**2 * r.q[0]).answer == "zero"
    a, lam = constrained_accelerations(wire)
    on_wire = place | {v: total_derivative(e, r) for v, e in zip(c.v, place.values(), strict=True)}
    carried = [total_derivative(total_derivative(e, r), r).subs(r.a[0], along) for e in place.values()]
    assert decide_equal(a.subs(on_wire), sp.Matrix(carried)).answer == "zero"
    # dE/dt = −λ ∂g/∂t: the wire does work on the particle, m Omega² r r' + m r Omega² r' .
    work = wire.power.subs(wire.multipliers[0], lam[0]).subs(on_wire)
    assert decide_equal(work, 2 * m * Omega**2 * r.q[0] * r.v[0]).answer == "zero"


def test_chaplygins_sleigh_has_its_equations() -> None:
    """Neimark & Fufaev, ch. II: u' = l omega², (J + m l²) omega' = −m l omega u, u the speed along the blade."""
    system = sleigh()
    phi, (x_v, y_v, phi_v) = system.c.q[2], system.c.v
    u = sp.Symbol("u", real=True)
    rolling = {x_v: u * sp.cos(phi), y_v: u * sp.sin(phi)}
    a, _ = constrained_accelerations(system)
    speed = x_v * sp.cos(phi) + y_v * sp.sin(phi)
    moved = total_derivative(speed, system.c).subs(dict(zip(system.c.a, a, strict=True))).subs(rolling)
    assert decide_equal(moved, l * phi_v**2).answer == "zero"
    assert decide_equal(a[2].subs(rolling), -m * l * phi_v * u / (J + m * l**2)).answer == "zero"
    # Holonomic reactions (d/dt of the constraint's gradient taken as a gradient of L) would keep phi' instead.
    assert decide_equal(a[2].subs(rolling), 0).answer == "nonzero"
    assert system.power == 0


def test_a_gauge_term_makes_the_motion_of_the_centre_a_noether_integral() -> None:
    """Galilean boosts: xi = t changes L by d(m x)/dt, and p t − m x stays."""
    c = coordinates("x y")
    boosted = System(c, m * (c.v[0] ** 2 + c.v[1] ** 2) / 2 - k * c.q[1])
    found = boosted.noether((t, 0), gauge=m * c.q[0])
    assert sp.expand(found.expression - (m * c.v[0] * t - m * c.q[0])) == 0
    assert boosted.conserved(found.expression).answer == "zero"


def test_what_acts_on_the_others_goes_along_with_the_routhian() -> None:
    c = coordinates("r phi")
    (r, _), (r_v, phi_v) = c.q, c.v
    L = m * (r_v**2 + r**2 * phi_v**2) / 2
    p = sp.Symbol("p_phi", real=True)
    dragged = System(c, L, dissipation=k * r_v**2 / 2, forces=(A * phi_v, 0)).routh("phi")
    expected = (p**2 / (m * r**3) - k * r_v + A * p / (m * r**2)) / m
    assert decide_equal(constrained_accelerations(dragged)[0][0], expected).answer == "zero"


def test_lagrangians_that_differ_by_a_factor_or_a_derivative_are_the_same_system() -> None:
    bead = hoop()
    gauge = total_derivative(sp.sin(theta) * t**2, ANGLE)
    assert System(ANGLE, bead.L + gauge).same_as(bead).answer == "zero"
    assert System(ANGLE, 3 * bead.L).same_as(bead).answer == "zero"
    assert System(ANGLE, bead.L + theta**2).same_as(bead).answer == "nonzero"
    # Two free points: each part of L with a factor of its own, which no one factor makes up for.
    c = coordinates("x y")
    apart = System(c, c.v[0] ** 2 + 3 * c.v[1] ** 2 - 3 * m * c.q[1])
    assert apart.same_as(System(c, c.v[0] ** 2 + c.v[1] ** 2 - m * c.q[1])).answer == "undecided"


def test_what_moves_otherwise_is_refuted_at_a_point_before_anything_is_inverted(monkeypatch) -> None:
    """By enclosures that are apart: the witness is a state at which the accelerations differ."""
    monkeypatch.setattr("lagrotor.mechanics.symmetry.constrained_accelerations", None)
    c = coordinates("a b d")
    turned = [sum(c.v[: i + 1]) * sp.cos(sum(c.q[: i + 1])) for i in range(3)]
    L = sum(v**2 for v in c.v) + sum(turned) ** 2 - m * sp.cos(sum(c.q))
    other = System(c, L).same_as(System(c, L + c.v[2] ** 2 / 10**20))
    assert other.answer == "nonzero" and other.witness is not None and 0 < (other.evidence or 0) < 1e-15
    assert {*c.q, *c.v, m} == other.witness.keys()
    assert System(c, L).same_as(System(c, m * L + sum(turned))).answer == "zero"


def test_constrained_systems_are_compared_as_far_as_it_can_be_decided() -> None:
    c = coordinates("x y")
    (x, y), (x_v, y_v) = c.q, c.v
    L = m * (x_v**2 + y_v**2) / 2 - m * g * y
    circle, squared = System(c, L, (x**2 + y**2 - l**2,)), System(c, L, ((x**2 + y**2 - l**2) / 2,))
    assert circle.same_as(squared).answer == "zero"
    assert circle.same_as(System(c, L, (x**2 + y**2 - l**2 + x,))).answer == "undecided"


C = coordinates("x y")


numbers = st.integers(-3, 3)


@settings(max_examples=10, deadline=None)
@given(st.lists(numbers, min_size=6, max_size=6), st.data())
def test_the_law_of_energy_holds_for_any_driven_quadratic_system(terms: list[int], data: st.DataObject) -> None:
    """dE/dt along the motion is `power`, for random mass, drive, friction and force, at random states."""
    (x, y), (x_v, y_v) = C.q, C.v
    a, b, d, e, f, h = terms
    L = (2 + x**2) * x_v**2 / 2 + (3 + t**2) * y_v**2 / 2 + a * x_v * y_v / 4 + b * t * x * y_v - d * x * y * t
    system = System(C, L, dissipation=(e**2 * x_v**2 + y_v**2) / 2, forces=(f * t, h * x_v))
    state = {s: sp.Rational(data.draw(numbers), 2) for s in (*C.q, *C.v, t)}
    moved = dict(zip(C.a, constrained_accelerations(system)[0].subs(state), strict=True))
    left = total_derivative(system.energy, C).subs(moved).subs(state)
    assert left == system.power.subs(state)
    assert not np.isnan(float(left))


def test_the_equations_by_the_names_of_sympy() -> None:
    """M a = forcing, and M a = forcing + Gᵀ λ with a constraint, as LagrangesMethod has them."""
    from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

    x, y = dynamicsymbols("x y")
    c = coordinates("x y")
    clock = dynamicsymbols._t
    L = m * (x.diff() ** 2 + x**2 * y.diff() ** 2) / 2 - m * g * x
    peer = LagrangesMethod(L, (x, y))
    peer.form_lagranges_equations()
    system = System.from_sympy(L, (x, y))
    plain = {x.diff(clock): c.x_dot, y.diff(clock): c.y_dot, x: c.x, y: c.y}

    def difference(mine: sp.Matrix, theirs: sp.Matrix) -> sp.Matrix:
        return (mine - theirs.subs(plain)).applyfunc(sp.simplify)

    assert not any(difference(system.mass_matrix, peer.mass_matrix)) and not any(
        difference(system.forcing, peer.forcing)
    )
    assert not any(difference(system.accelerations, peer.rhs()[2:, :]))
    assert system.momenta == sp.Matrix([m * c.x_dot, m * c.x**2 * c.y_dot])
    bound = System(SPACE, PARTICLE, constraints=(sum(q**2 for q in SPACE.q) - l**2,), dissipation=k * SPACE.x_dot**2)
    a, lam = constrained_accelerations(bound)
    left = bound.mass_matrix * a - bound.forcing - bound.rows.T * lam
    assert a == bound.accelerations and not any(left.applyfunc(sp.simplify))


def test_old_names_of_the_equations_warn() -> None:
    system = System(ANGLE, theta_v**2 / 2, forces=(theta,))
    with pytest.warns(DeprecationWarning, match="Equations.mass is now mass_matrix") as warned:
        assert system.mass == system.mass_matrix  # type: ignore[attr-defined]
    with pytest.warns(DeprecationWarning, match="Equations.push is now generalised_forces"):
        assert system.push == system.generalised_forces  # type: ignore[attr-defined]
    assert warned[0].filename == __file__
    with pytest.raises(AttributeError, match="'System' object has no attribute 'pull'"):
        system.pull  # type: ignore[attr-defined] # noqa: B018


def test_a_start_by_names() -> None:
    c = coordinates("x y")
    system = System(c, (c.x_dot**2 + c.y_dot**2) / 2 - c.x**2, velocities={sp.Symbol("u"): c.x_dot, c.y_dot: c.y_dot})
    u = system.speeds[0]
    by_name = system.simulate({}, {"y": 2, c.x: 1}, {"y_dot": 3, u: 4}, [0, 1])
    assert (by_name.q == system.simulate({}, (1, 2), (4, 3), [0, 1]).q).all()
    placed, moving = system.consistent({}, {"x": 1, "y": 2}, {"u": 4, "y_dot": 3})
    assert (*placed, *moving) == (1, 2, 4, 3)
    refusals = {
        "simulate: q0 names z, which is none of x, y": lambda: system.simulate({}, {"z": 1}, (0, 0), [0, 1]),
        "q0 lacks y: give each of x, y a number": lambda: system.simulate({}, {"x": 1}, (0, 0), [0, 1]),
        r"v0 names x_dot, which is none of u, y_dot: y_dot\?": lambda: system.consistent({}, (0, 0), {"x_dot": 1}),
        "two numbers": lambda: system.consistent({}, {"x": 1, c.x: 1, "y": 0}, (0, 0)),
        "q0 = .* must be 2 finite numbers": lambda: system.consistent({}, {"x": np.nan, "y": 0}, (0, 0)),
    }
    for words, call in refusals.items():
        with pytest.raises(InputError, match=words):
            call()
