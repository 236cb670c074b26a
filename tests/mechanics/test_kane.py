"""KanesMethod and System of sympy, taken as they are: their speeds' derivatives at random states on the constraints."""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import (
    Force,
    ForceActuator,
    KanesMethod,
    LagrangesMethod,
    LinearPathway,
    Particle,
    PinJoint,
    Point,
    PrismaticJoint,
    ReferenceFrame,
    RigidBody,
    SphericalJoint,
    dot,
    dynamicsymbols,
    inertia,
)
from sympy.physics.mechanics import System as TheirSystem
from sympy.physics.mechanics.models import multi_mass_spring_damper, n_link_pendulum_on_cart

from lagrotor.errors import InputError
from lagrotor.mechanics import System, t

m, l, r, g, k, d = sp.symbols("m l r g k d")
VALUES = {m: 1.3, l: 0.7, r: 0.4, g: 9.81, k: 2.0, d: 0.3}
CLOCK, N = dynamicsymbols._t, ReferenceFrame("N")
q1, q2, q3, q4, q5, u1, u2, u3, u4, u5, F = dynamicsymbols("q1:6 u1:6 F")


def agree(method: Any, system: System, seed: int, values: Any = VALUES, near: Any = 0) -> float:
    """The largest difference of q' and u' from those of a KanesMethod, relative to the largest, at a state on the constraints."""
    n, random = len(system.c.q), np.random.default_rng(seed)
    q, v = system.consistent(values, near + random.uniform(-0.6, 0.6, n), random.uniform(-1, 1, n))
    rates = np.array(system.rhs(values)(0.4, np.concatenate([q, v])))
    letters = dict(zip(method.q, system.c.q, strict=True)) | {
        f.diff(CLOCK): s for f, s in zip(method.q, system.c.v, strict=True)
    }
    kinematic = method._k_kqdot_implicit * method._qdot + method._k_ku_implicit * method.u + method._f_k_implicit
    speeds = sp.solve(list(kinematic), list(method.u), dict=True)[0]
    here = {CLOCK: 0.4} | dict(zip((*system.c.q, *system.c.v), (*q, *v), strict=True)) | values
    turned = {u: speeds[u].xreplace(letters) for u in method.u}
    now = {u: float(sp.sympify(e.xreplace(here))) for u, e in turned.items()}
    own = []
    for u in method.u:
        slope = sum(turned[u].diff(s) * x for s, x in zip((*system.c.q, *system.c.v), rates, strict=True)) + turned[
            u
        ].diff(CLOCK)
        own.append(float(sp.sympify(sp.sympify(slope).xreplace(here))))
    at = dict(zip(method.q, q, strict=True)) | now | values | {CLOCK: 0.4}
    M, f = (
        np.array(sp.Matrix(e).subs({F: 0}).xreplace(at).evalf().tolist(), float)
        for e in (method.mass_matrix_full, method.forcing_full)
    )
    theirs = np.linalg.solve(M, f).ravel()
    mine = np.concatenate([v, own])
    return float(np.abs(mine - theirs).max() / np.abs(theirs).max())


def disc() -> KanesMethod:
    """A rolling disc whose velocities are written with its rolling: sympy, test_kane.py, test_rolling_disc."""
    Y = N.orientnew("Y", "Axis", [q1, N.z])
    tilted = Y.orientnew("L", "Axis", [q2, Y.x])
    wheel = tilted.orientnew("R", "Axis", [q3, tilted.y])
    turned = wheel.ang_vel_in(N)
    wheel.set_ang_vel(N, u1 * tilted.x + u2 * tilted.y + u3 * tilted.z)
    contact = Point("C")
    contact.set_vel(N, 0)
    centre = contact.locatenew("Dmc", r * tilted.z)
    centre.v2pt_theory(contact, N, wheel)
    I = inertia(tilted, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2)
    kinematic = [dot(wheel.ang_vel_in(N) - turned, axis) for axis in tilted]
    method = KanesMethod(N, [q1, q2, q3], [u1, u2, u3], kinematic)
    method.kanes_equations([RigidBody("D", centre, wheel, m, (I, centre))], [(centre, -m * g * Y.z)])
    return method


def disc_with_contact() -> KanesMethod:
    """The same with the place of its contact, whose speeds depend: sympy, test_linearize.py, test_linearize_rolling_disc_kane."""
    A = N.orientnew("A", "Axis", [q1, N.z])
    B = A.orientnew("B", "Axis", [q2, A.x])
    C = B.orientnew("C", "Axis", [q3, B.y])
    O = Point("O")
    O.set_vel(N, 0)
    centre = O.locatenew("CO", q4 * N.x + q5 * N.y + r * B.z)
    speeds = u1 * B.x + u2 * B.y + u3 * B.z
    kinematic = [*(dot(C.ang_vel_in(N) - speeds, axis) for axis in B), q4.diff(CLOCK) - u4, q5.diff(CLOCK) - u5]
    rates = sp.solve(kinematic, [f.diff(CLOCK) for f in (q1, q2, q3, q4, q5)])
    C.set_ang_vel(N, speeds)
    moved = centre.pos_from(O).dt(N).subs(rates)
    centre.set_vel(N, moved)
    slip = moved + (speeds ^ (-r * B.z))
    held = [dot(slip, axis) for axis in (N.x, N.y)]
    method = KanesMethod(
        N, [q1, q2, q3, q4, q5], [u1, u2, u3], kinematic, u_dependent=[u4, u5], velocity_constraints=held
    )
    I = inertia(B, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2)
    method.kanes_equations([RigidBody("D", centre, C, m, (I, centre))], [(centre, -m * g * N.z)])
    return method


def bound_pendulum() -> KanesMethod:
    """A pendulum in x and y under its length: sympy, test_linearize.py, test_linearize_pendulum_kane_nonminimal."""
    O = Point("O")
    P = O.locatenew("P", q1 * N.x + q2 * N.y)
    O.set_vel(N, 0)
    P.set_vel(N, P.pos_from(O).dt(N))
    method = KanesMethod(
        N,
        [q2],
        [u2],
        [q1.diff(CLOCK) - u1, q2.diff(CLOCK) - u2],
        q_dependent=[q1],
        u_dependent=[u1],
        configuration_constraints=[q1**2 + q2**2 - l**2],
        velocity_constraints=[q1 * u1 + q2 * u2],
    )
    method.kanes_equations([Particle("P", P, m)], [(P, m * g * N.x)])
    return method


def four_bars() -> TheirSystem:
    """Links joined by pins, whose last point is held: sympy, test_jointsmethod.py, test_four_bar_linkage."""
    lengths, angles, rates = sp.symbols("l1:5"), dynamicsymbols("q1:4"), dynamicsymbols("u1:4")
    base, links = RigidBody("W"), [RigidBody(f"L{i}", mass=m) for i in range(3)]
    system = TheirSystem.from_newtonian(base)
    parent, place = base, 0 * base.x
    for link, length, angle, rate in zip(links, lengths, angles, rates, strict=False):
        link.central_inertia = inertia(link.frame, 0, 0, m * length**2 / 12)
        ends = {"parent_point": place, "child_point": -length / 2 * link.x}
        system.add_joints(PinJoint(f"J{angle.name}", parent, link, angle, rate, joint_axis=base.z, **ends))
        parent, place = link, length / 2 * link.x
    loop = links[-1].masscenter.locatenew("E", place).pos_from(base.masscenter) - lengths[3] * base.x
    system.add_holonomic_constraints(loop.dot(base.x), loop.dot(base.y))
    system.q_ind, system.q_dep = angles[:1], angles[1:]
    system.u_ind, system.u_dep = rates[:1], rates[1:]
    system.add_loads(Force(links[1], k * base.y))
    return system


LENGTHS = dict(zip(sp.symbols("l1:5"), (0.3, 0.8, 0.6, 0.9), strict=True))


@pytest.mark.parametrize("make", [disc, disc_with_contact, bound_pendulum])
def test_a_kanes_method_is_taken_with_its_speeds_and_constraints(make: Any) -> None:
    method = make()
    system = System.from_sympy(method)
    assert [agree(method, system, seed) for seed in (1, 2)] == pytest.approx([0, 0], abs=1e-9)


def test_a_system_with_joints_a_loop_and_loads_is_taken() -> None:
    theirs = four_bars()
    theirs.form_eoms()
    system = System.from_sympy(theirs)
    assert len(system.constraints) == 2 and system.rolling == ()
    assert agree(theirs.eom_method, system, 3, VALUES | LENGTHS, np.array([1.2, -1.0, -1.5])) < 1e-9


def test_a_ball_joint_an_actuator_and_a_model_are_taken() -> None:
    wall, ball, cart = RigidBody("W"), RigidBody("B", mass=m), RigidBody("C", mass=m)
    ball.central_inertia = inertia(ball.frame, m * l**2, m * l**2, m * r**2)
    cart.central_inertia = inertia(cart.frame, 0, 0, 0)
    theirs = TheirSystem.from_newtonian(wall)
    slide = PrismaticJoint("P", wall, cart, dynamicsymbols("x"), dynamicsymbols("v"), joint_axis=wall.x)
    theirs.add_joints(slide, SphericalJoint("S", cart, ball, child_point=l * ball.z, rot_order=213))
    theirs.apply_uniform_gravity(-g * wall.z)
    theirs.add_actuators(ForceActuator(-k * dynamicsymbols("x"), LinearPathway(wall.masscenter, cart.masscenter)))
    theirs.form_eoms()
    assert agree(theirs.eom_method, System.from_sympy(theirs), 1) < 1e-9
    for method in (n_link_pendulum_on_cart(2, True, True), multi_mass_spring_damper(2, True, True)):
        values = {
            s: 0.5 + 0.1 * i
            for i, s in enumerate(
                sorted(method.mass_matrix_full.free_symbols | method.forcing_full.free_symbols, key=str)
            )
        }
        values.pop(CLOCK, None)
        system = System.from_sympy(method)
        functions = {str(f.func): 0 for e in system.forces for f in e.atoms(sp.core.function.AppliedUndef)}
        assert _without(functions, method, system, values) < 1e-9


def _without(functions: Any, method: Any, system: System, values: Any) -> float:
    """The difference where what is prescribed is zero on both sides."""
    still = {sp.Function(name)(CLOCK): 0 for name in functions}

    class Still:
        def __getattr__(self, name: str) -> Any:
            found = getattr(method, name)
            return found.xreplace(still) if name in ("mass_matrix_full", "forcing_full") else found

    quiet = System(
        system.c, system.L, forces=tuple(e.xreplace({f.subs(CLOCK, t): 0 for f in still}) for e in system.forces)
    )
    return agree(Still(), quiet, 2, values)


def test_what_is_prescribed_stays_a_function_of_time() -> None:
    P = Point("P")
    P.set_vel(N, u1 * N.x)
    method = KanesMethod(N, [q1], [u1], [q1.diff(CLOCK) - u1])
    method.kanes_equations([Particle("a", P, m)], [(P, F * N.x)])
    system = System.from_sympy(method)
    assert system.forces == (sp.Function("F")(t),)
    run = system.simulate({m: 2, "F": sp.cos(t)}, (0,), (0,), np.linspace(0, 3, 4), 1e-10)
    assert run.q[:, 0] == pytest.approx((1 - np.cos(run.t)) / 2, abs=1e-9)


def test_lagranges_method_of_a_system_keeps_its_lagrangian() -> None:
    wall, bob = RigidBody("W"), Particle("P", mass=m)
    theirs = TheirSystem.from_newtonian(wall)
    theirs.add_joints(PrismaticJoint("J", wall, bob, q1, q1.diff(CLOCK)))
    bob.potential_energy = k * q1**2 / 2
    theirs.form_eoms(LagrangesMethod)
    system = System.from_sympy(theirs)
    assert system.conserved(system.energy).answer == "zero"
    assert (system.motion[0] - (m * system.c.a[0] + k * system.c.q[0])).expand() == 0


def test_what_is_not_taken_says_why() -> None:
    with pytest.raises(InputError, match="call it first"):
        System.from_sympy(KanesMethod(N, [q1], [u1], [q1.diff(CLOCK) - u1]))
