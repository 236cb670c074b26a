"""Every system of which sympy's own mechanics tests form equations, taken by `from_sympy` and held to sympy's own equations.

The tests that sympy ships are run, the methods that they make are kept, and at random states on the constraints the derivatives
of coordinates and speeds are compared with those of sympy's mass_matrix_full and forcing_full.
"""

import importlib
import sys
import warnings
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.physics.mechanics import (
    ForceActuator,
    KanesMethod,
    LagrangesMethod,
    LinearPathway,
    Particle,
    Point,
    PrismaticJoint,
    ReferenceFrame,
    RigidBody,
    SphericalJoint,
    dynamicsymbols,
    inertia,
)
from sympy.physics.mechanics import System as TheirSystem

from lagrotor.errors import LagrotorError
from lagrotor.mechanics import System, constrained_accelerations, t

CLOCK, AT = dynamicsymbols._t, 0.4


def methods_of(
    module: str, name: str, monkeypatch: pytest.MonkeyPatch, stop: type[Exception] | None = None
) -> list[Any]:
    """The methods whose equations a test of sympy forms, each once; by `stop` it may be ended."""
    made: dict[int, Any] = {}

    def keep(method: type, call: str) -> None:
        own = getattr(method, call)

        def kept(self: Any, *given: Any, **more: Any) -> Any:
            result = own(self, *given, **more)
            made[id(self)] = self
            return result

        monkeypatch.setattr(method, call, kept)

    keep(KanesMethod, "kanes_equations")
    keep(LagrangesMethod, "form_lagranges_equations")
    try:
        tests = importlib.import_module(f"sympy.physics.mechanics.tests.{module}")
    except ModuleNotFoundError:
        pytest.skip("this sympy is installed without its tests")
    with warnings.catch_warnings(), suppress(*([stop] if stop else [])):
        warnings.simplefilter("ignore")
        group, _, one = name.rpartition(".")
        getattr(getattr(tests, group)() if group else tests, one)()
    monkeypatch.undo()
    return list(made.values())


def difference(method: Any, seed: int) -> float:
    """The largest difference of q' and u', of q' and q'' and multipliers, relative to the largest."""
    system, random = System.from_sympy(method), np.random.default_rng(seed)
    n, size = len(method.q), len(system.c.q)
    full = [sp.Matrix(e) for e in (method.mass_matrix_full, method.forcing_full)]
    rates = [f.diff(CLOCK) for f in method.q]
    kane = isinstance(method, KanesMethod)
    speeds = list(method.u) if kane else rates
    parts = (system.L, *system.forces, *system.constraints, *system.rolling)
    known = set().union(*(e.free_symbols for e in parts))
    letters = set().union(known, *(e.free_symbols for e in full)) - {*system.c.q, *system.c.v, CLOCK, t}
    values = {s: random.uniform(0.5, 1.5) for s in sorted(letters, key=str)}
    prescribed = {f for e in full for f in e.atoms(AppliedUndef) if f.args == (CLOCK,)} - {*method.q, *speeds}
    constants = {f: random.uniform(-1, 1) for f in sorted(prescribed, key=str)}
    constants |= dict.fromkeys(getattr(method, "_uaux", ()), 0.0)  # of forces that do no work
    functions = {str(f.func) for e in parts for f in e.atoms(AppliedUndef)}
    taken = {str(s): x for s, x in values.items() if s in known}
    taken |= {str(f.func): x for f, x in constants.items() if str(f.func) in functions}
    for _ in range(8):
        try:
            q, v = system.consistent(taken, random.uniform(-0.9, 0.9, size), random.uniform(-1, 1, size), AT)
            break
        except LagrotorError as refusal:
            last = refusal
    else:
        raise last
    moved = np.array(system.rhs(taken)(AT, np.concatenate([q, v])))[size:]
    at = dict(zip(method.q, q[:n], strict=True)) | values
    still = {f.diff(CLOCK): 0 for f in constants}
    moving = dict(zip(rates, v[:n], strict=True))
    own = [s for s in speeds if f"q_{s.func.__name__}" in map(str, system.c.q[n:])] if kane else []

    def number(e: sp.Matrix, *puts: Any) -> np.ndarray:
        for put in (*puts, moving, still, constants, at, {CLOCK: AT}):
            e = e.xreplace(put)
        return np.array(e.evalf().tolist(), float)

    u, names = v, dict(zip(speeds, sp.symbols(f"u:{len(speeds)}", cls=sp.Dummy), strict=True))
    if kane:
        held = method._k_nh * method.u + method._f_nh if len(method._k_nh) else sp.zeros(0, 1)
        kinematic = method._k_kqdot_implicit * method._qdot + method._k_ku_implicit * method.u + method._f_k_implicit
        turning = [u - x for u, x in zip(own, v[n:], strict=True)]
        both = sp.Matrix([*kinematic, *held, *turning]).xreplace(names)
        rest = both.xreplace(dict.fromkeys(names.values(), 0))
        u = np.linalg.lstsq(number(both.jacobian(list(names.values()))), -number(rest), rcond=None)[0].ravel()
    put = dict(zip(speeds, u, strict=True))
    theirs = np.linalg.lstsq(*(number(e, put) for e in full), rcond=None)[0].ravel()
    if kane:  # q'' from theirs: the kinematic equations, differentiated along the motion
        accelerations = sp.symbols(f"a:{n}", cls=sp.Dummy)
        turning = kinematic.diff(CLOCK).xreplace({r.diff(CLOCK): a for r, a in zip(rates, accelerations, strict=True)})
        turning = turning.xreplace({s.diff(CLOCK): x for s, x in zip(speeds, theirs[n:], strict=True)})
        rest = turning.xreplace(dict.fromkeys(accelerations, 0))
        rates_of_own = [theirs[n + speeds.index(s)] for s in own]
        theirs = np.linalg.solve(number(turning.jacobian(accelerations), put), -number(rest, put)).ravel()
        theirs = np.append(theirs, rates_of_own)
    else:
        theirs = theirs[n : 2 * n]
    return float(np.abs(moved - theirs).max() / max(1.0, np.abs(theirs).max()))


QUICK = {
    "test_kane": "one_dof two_dof pend rolling_disc",
    "test_kane2": "sub_qdot",
    "test_kane4": "replace_qdots_in_force",
    "test_lagrange": "disc_on_an_incline_plane simp_pen nonminimal_pendulum dub_pen",
    "test_lagrange2": "lagrange_2forces",
    "test_linearize": "linearize_pendulum_kane_nonminimal",
    "test_models": "multi_mass_spring_damper_higher_order n_link_pendulum_on_cart_inputs",
    "test_jointsmethod": "chaos_pendulum simple_pedulum",
    "test_system_class": "TestSystemExamples.box_on_ground",
}
LONG = {
    "test_kane": "aux parallel_axis input_format implicit_kinematics",
    "test_kane2": "aux_dep non_central_inertia",
    "test_kane5": "kane_rolling_disc_lu",
    "test_lagrange": "rolling_disc",
    "test_jointsmethod": (
        "jointsmethod rigid_body_particle_compatibility complete_simple_double_pendulum two_dof_joints "
        "four_bar_linkage_with_manual_constraints"
    ),
    "test_linearize": (
        "linearize_rolling_disc_kane linearize_pendulum_kane_minimal "
        "linearize_pendulum_lagrange_minimal linearize_pendulum_lagrange_nonminimal linearize_rolling_disc_lagrange"
    ),
    "test_models": "multi_mass_spring_damper_inputs n_link_pendulum_on_cart_higher_order",
    "test_system_class": "TestSystemExamples.cart_pendulum_kanes TestSystemExamples.cart_pendulum_lagrange",
}


def cases(table: dict[str, str]) -> list[tuple[str, str]]:
    return [
        (module, ".".join([*groups, f"test_{name}"]))
        for module, names in table.items()
        for *groups, name in (each.split(".") for each in names.split())
    ]


@pytest.mark.parametrize(
    ("module", "name"),
    [*cases(QUICK), *(pytest.param(*each, marks=pytest.mark.slow) for each in cases(LONG))],
)
def test_it_moves_as_sympy_says(module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    methods = methods_of(module, name, monkeypatch)
    assert methods
    assert max(difference(method, 1) for method in methods) < 1e-9


@pytest.mark.slow
def test_the_bicycle_moves_as_sympy_says_and_has_the_matrix_of_its_test(monkeypatch: pytest.MonkeyPatch) -> None:
    """test_kane3.py, stopped before sympy linearises, its numbers read there (Meijaard et al., 2007)."""
    numbers: dict[Any, Any] = {}

    class FormedError(Exception):
        pass

    def stopped(self: Any, **_: Any) -> None:
        numbers.update(sys._getframe(1).f_locals["val_dict"])
        raise FormedError

    monkeypatch.setattr(KanesMethod, "linearize", stopped)
    (method,) = methods_of("test_kane3", "test_bicycle", monkeypatch, FormedError)
    assert difference(method, 1) < 1e-9
    system = System.from_sympy(method)
    v, values = sp.Symbol("v"), {s: float(x) for s, x in numbers.items() if isinstance(s, sp.Symbol)}
    for speed in (1, 5):
        spins = {f"q_{s.func.__name__}_dot": x.subs(v, speed) for s, x in numbers.items() if sp.sympify(x).has(v)}
        still = dict.fromkeys(map(str, (*system.c.q, *system.c.v)), 0)
        rates = system.linearise(still | spins, values).rates
        lean = [9.48977444677355, -0.891197738059089 * speed**2 - 0.571523173729245]
        steer = [11.7194768719633, -1.97171508499972 * speed**2 + 30.9087533932407]
        lean += [-0.105522449805691 * speed, -0.330515398992311 * speed]
        steer += [3.67680523332152 * speed, -3.08486552743311 * speed]
        theirs = np.linalg.eigvals(np.array([[0, 0, 1, 0], [0, 0, 0, 1], lean, steer]))
        assert max(np.abs(rates - root).min() for root in theirs) < 1e-9
        assert sum(abs(rate) > 1e-6 for rate in rates) == 4


def test_another_motion_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The twin: a pendulum with another force than sympy's."""
    (method,) = methods_of("test_lagrange", "test_simp_pen", monkeypatch)
    assert difference(method, 1) < 1e-12
    own = System.from_sympy(method)
    monkeypatch.setattr(System, "from_sympy", staticmethod(lambda _: System(own.c, own.L, forces=(own.c.q[0],))))
    assert difference(method, 1) > 1e-3


m, l, g, k = sp.symbols("m l g k")
N = ReferenceFrame("N")
q1, q2, u1, F = dynamicsymbols("q1 q2 u1 F")
v1, v2 = q1.diff(), q2.diff()
DOUBLE = m * l**2 * (v1**2 + v2**2 / 2 + v1 * v2 * sp.cos(q1 - q2)) + m * g * l * (2 * sp.cos(q1) + sp.cos(q2))


def test_multipliers_are_those_of_sympys_matrices() -> None:
    """A double pendulum, pushed at a point and by a torque; a pendulum in x, y under its length; a knife edge."""
    values, (a, b, c, d) = {m: 1.3, l: 0.7, g: 9.81, k: 2.0}, np.random.default_rng(1).uniform(-1, 1, 4)
    point, arm = Point("P"), N.orientnew("A", "Axis", [q2, N.z])
    point.set_vel(N, l * v1 * sp.cos(q1) * N.x + l * v1 * sp.sin(q1) * N.y)
    loads = [(point, -k * v2 * N.x + sp.cos(CLOCK) * N.y), (arm, g * v1 * N.z)]
    free, x, y = m * (v1**2 + v2**2) / 2 - m * g * q2, 0.7 * np.sin(a), 0.7 * np.cos(a)
    bound = LagrangesMethod(free, [q1, q2], hol_coneqs=[q1**2 + q2**2 - l**2])
    for method, state in (
        (LagrangesMethod(DOUBLE, [q1, q2], forcelist=loads, frame=N), (a, b, c, d)),
        (bound, (x, y, b * y, -b * x)),
        (LagrangesMethod(free, [q1, q2], nonhol_coneqs=[v1 * sp.sin(q2) - v2]), (a, b, c, c * np.sin(b))),
    ):
        method.form_lagranges_equations()
        put = dict(zip((v1, v2, q1, q2), (*state[2:], *state[:2]), strict=True))
        full = (e.xreplace(put).subs(values | {CLOCK: AT}) for e in (method.mass_matrix_full, method.forcing_full))
        theirs = np.linalg.solve(*(np.array(e.tolist(), float) for e in full)).ravel()[2:]
        system = System.from_sympy(method)
        here = dict(zip((*system.c.q, *system.c.v, t), (*state, AT), strict=True)) | values
        both = (np.array(e.subs(here).tolist(), float).ravel() for e in constrained_accelerations(system))
        np.testing.assert_allclose(np.concatenate(list(both)), theirs, rtol=1e-12)
    assert list(bound.eom.jacobian(bound.lam_vec)) == [2 * q1, 2 * q2]  # there M a + … + Gᵀ λ = 0: the opposite sign


def test_a_lagrangian_of_functions_of_time_is_that_of_letters() -> None:
    system = System.from_sympy(DOUBLE, (q1, q2))
    assert [str(s) for s in (*system.c.q, *system.c.v)] == ["q1", "q2", "q1_dot", "q2_dot"]
    other = System.from_sympy(DOUBLE.subs(g, 2 * g), (q1, q2))
    assert system.same_as(System(system.c, system.L)).answer == "zero" and system.same_as(other).answer == "nonzero"


def test_a_ball_joint_and_an_actuator_are_taken() -> None:
    wall, ball, cart = RigidBody("W"), RigidBody("B", mass=m), RigidBody("C", mass=m)
    ball.central_inertia, cart.central_inertia = (
        inertia(ball.frame, m * l**2, m * l**2, m * k),
        inertia(cart.frame, 0, 0, 0),
    )
    theirs = TheirSystem.from_newtonian(wall)
    slide = PrismaticJoint("P", wall, cart, dynamicsymbols("x"), dynamicsymbols("v"), joint_axis=wall.x)
    theirs.add_joints(slide, SphericalJoint("S", cart, ball, child_point=l * ball.z, rot_order=213))
    theirs.apply_uniform_gravity(-g * wall.z)
    theirs.add_actuators(ForceActuator(-k * dynamicsymbols("x"), LinearPathway(wall.masscenter, cart.masscenter)))
    theirs.form_eoms()
    assert System.from_sympy(theirs) == System.from_sympy(theirs.eom_method)
    assert difference(theirs.eom_method, 1) < 1e-9


def test_what_is_prescribed_stays_a_function_of_time() -> None:
    P = Point("P")
    P.set_vel(N, u1 * N.x)
    method = KanesMethod(N, [q1], [u1], [q1.diff() - u1])
    method.kanes_equations([Particle("a", P, m)], [(P, F * N.x)])
    system = System.from_sympy(method)
    assert system.forces == (sp.Function("F")(t),)
    run = system.simulate({m: 2, "F": sp.cos(t)}, (0,), (0,), np.linspace(0, 3, 4), 1e-10)
    assert run.q[:, 0] == pytest.approx((1 - np.cos(run.t)) / 2, abs=1e-9)


def test_lagranges_method_of_a_system_keeps_its_lagrangian() -> None:
    wall, bob = RigidBody("W"), Particle("P", mass=m)
    theirs = TheirSystem.from_newtonian(wall)
    theirs.add_joints(PrismaticJoint("J", wall, bob, q1, q1.diff()))
    bob.potential_energy = k * q1**2 / 2
    theirs.form_eoms(LagrangesMethod)
    system = System.from_sympy(theirs)
    assert system.conserved(system.energy).answer == "zero"
    assert (system.motion[0] - (m * system.c.a[0] + k * system.c.q[0])).expand() == 0
