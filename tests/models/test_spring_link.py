"""The paper's simulator: bodies against exact free motion, links against the exact pair, steps against their limit."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from lagrotor import Link, Rotor, Scene, Shock, simulate
from lagrotor.benchmark.limits.step_size import step_grows, step_limit_by_bisection
from lagrotor.errors import LagrotorWarning
from lagrotor.models import (
    RigidBody,
    RigidBodySystem,
    finite_rotation,
    link_force,
    paper_system,
    run_solver,
    run_steps,
    step_limit,
)
from lagrotor.models.spring_link.rigid_body import (
    inertia_transform,
    printed_inertia_transform,
    printed_rotation,
)
from lagrotor.models.spring_link.run import rate_function, step_function
from lagrotor.models.spring_link.system import join_bar, paper_bodies

ZERO, ONE = np.zeros(3), np.eye(3)
BAR = Link(length=1, mass=1, inertia=1)
MOVING = Scene(spins=(10, -6), link=BAR, rates=((0.5, 0.3, 0), (0.5, -0.2, 0)))
TILTED = Rotation.from_rotvec([0.4, -0.9, 0.3]).as_matrix()


def slope(x, y):
    """Exponent p of y ~ x^p."""
    return np.polyfit(np.log(x), np.log(y), 1)[0]


def spun(inertia, transform=inertia_transform):
    body = RigidBody(ZERO, [[0, 0, 1]], inertia, TILTED, 1.0, [1.0, 2.0, 3.0], ZERO)
    return RigidBodySystem([body], 1.0, 0.0, transform=transform)


def turned(inertia, dt, t=2.0, transform=inertia_transform):
    system = spun(inertia, transform)
    for _ in range(round(t / dt)):
        system.compute_forces()
        system.step(dt)
    return system


def energy(system):
    return float((system.angular_velocity() * system.L).sum() / 2)


def free_precession(t):
    """R(t) = exp([L] t / I1) exp([e] (1/I3 − 1/I1)(L . e) t) R(0) of a symmetric body with axis e."""
    L, e = spun(np.diag([2, 2, 1.0])).L[0], TILTED[:, 2]
    return (Rotation.from_rotvec(L * t / 2) * Rotation.from_rotvec(e * (1 - 0.5) * (L @ e) * t)).as_matrix() @ TILTED


def test_free_body_converges_to_the_exact_motion_at_first_order():
    steps, inertia = np.array([4e-3, 2e-3, 1e-3]), np.diag([2, 2, 1.0])
    start = spun(inertia)
    runs = [turned(inertia, dt) for dt in steps]
    assert all((run.L == start.L).all() for run in runs)
    off = [abs(run.R[0] - free_precession(2.0)).max() for run in runs]
    lost = [abs(energy(run) - energy(start)) for run in runs]
    assert slope(steps, off) == pytest.approx(1, abs=0.1)
    assert slope(steps, lost) == pytest.approx(1, abs=0.1)


def test_the_printed_inertia_transform_fails_unless_the_body_is_isotropic():
    unequal, equal = np.diag([2, 2, 1.0]), np.eye(3)
    printed = [turned(unequal, dt, transform=printed_inertia_transform).R[0] for dt in (2e-3, 5e-4)]
    assert min(abs(R - free_precession(2.0)).max() for R in printed) > 0.3
    assert turned(equal, 1e-3, transform=printed_inertia_transform).R[0] == pytest.approx(turned(equal, 1e-3).R[0])


component = st.floats(-1e3, 1e3) | st.floats(-1e-300, 1e-300) | st.sampled_from([0.0, 5e-324, -5e-324, 1e-170, 1e-160])


@given(st.tuples(component, component, component), st.floats(1e-6, 1.0))
def test_finite_rotation_is_the_rotation_for_every_angular_velocity(Omega, dt):
    dR = finite_rotation(np.array([Omega]), dt)[0]
    assert abs(dR - Rotation.from_rotvec(np.array(Omega) * dt).as_matrix()).max() < 1e-12
    assert abs(dR @ dR.T - ONE).max() < 1e-14


def test_the_papers_shocked_run_turns_nan_with_the_printed_rotation_only():
    scene = Scene(spins=(10, 10), link=BAR, shock=Shock((50, 0, 0), at=0.6, width=1 / 50))
    t = np.array([0.05, 0.3, 1.0])
    with pytest.warns(LagrotorWarning, match="not a number"):
        lost = run_steps(paper_system(scene, 1e4, 250, rotation=printed_rotation), scene.shock, t, 1e-3)
    assert lost.ending.kind == "stopped" and lost.t[-1] <= lost.ending.at <= 1 and np.isfinite(lost.axes).all()
    run = run_steps(paper_system(scene, 1e4, 250), scene.shock, t, 1e-3)
    assert run.paper_energy == pytest.approx([100, 100, 100.44], abs=0.01)


def test_link_forces_by_hand():
    gap, along, across = np.array([[0.1, 0, 0]]), np.array([[2.0, 0, 0]]), np.array([[0, 2.0, 0]])
    assert link_force(gap, along, 30.0, 5.0) == pytest.approx(np.array([[-13.0, 0, 0]]))
    assert link_force(gap, across, 30.0, 5.0) == pytest.approx(np.array([[-3.0, -10.0, 0]]))


@pytest.mark.parametrize("rotation", [finite_rotation, printed_rotation])
def test_a_run_repeats_the_step_of_the_arrays(rotation):
    shock = Shock(force=(40, -11, 0), at=0.2, width=1 / 50)
    scene = Scene(spins=(10, -6), rotor=Rotor(I1=1.0, I3=0.4), link=BAR, rates=MOVING.rates, shock=shock)
    by_hand, unshaken = (paper_system(scene, 1e4, 250, rotation=rotation) for _ in range(2))
    step, state = step_function(by_hand, shock, 1e-3), by_hand.state.tolist()
    for strength in np.linspace(0.2, 1.0, 20):
        state = step(state, strength)
        for system in (by_hand, unshaken):
            system.compute_forces()
            if system is by_hand:
                system.push(1, 2, strength * np.array(shock.force))
            system.step(1e-3)
    assert abs(state - by_hand.state).max() < 1e-13
    assert abs(state - unshaken.state).max() > 1e-2


def test_the_papers_step_converges_to_the_solver_at_first_order():
    t, steps = np.array([0.5, 1.0]), np.array([2e-3, 1e-3, 5e-4])
    system = paper_system(MOVING, 2e3, 20)
    exact = run_solver(system, None, t, 1e-9)
    off = [abs(run_steps(system, None, t, dt).tips - exact.tips).max() for dt in steps]
    assert slope(steps, off) == pytest.approx(1, abs=0.1)


def test_springs_converge_to_the_exact_pair_as_one_over_stiffness():
    t, stiffness = np.linspace(0, 1, 11), np.array([1e3, 4e3, 1.6e4, 6.4e4])
    exact = simulate(MOVING, t, model="spheres", tol=1e-11)
    off = [
        abs(run_solver(paper_system(MOVING, S, 2 * S**0.5), None, t, 1e-9).tips - exact.tips).max() for S in stiffness
    ]
    assert slope(stiffness, off) == pytest.approx(-1, abs=0.15)
    assert off[-1] < 1e-3


def test_energy_is_kept_without_damping_and_lost_with_it():
    t = np.linspace(0, 1, 21)
    kept = run_solver(paper_system(MOVING, 1e3, 0), None, t, 1e-10)
    assert kept.energy == pytest.approx(kept.energy[0], rel=1e-9)
    assert kept.energy == pytest.approx(kept.translation.sum(0) + kept.rotation.sum(0) + kept.spring.sum(0))
    assert abs(kept.paper_energy - kept.paper_energy[0]).max() > 1e-4
    assert kept.energy[0] == pytest.approx(simulate(MOVING, [0.0]).energy[0])
    lost = run_solver(paper_system(MOVING, 1e3, 30), None, t, 1e-10)
    assert (np.diff(lost.energy) < 1e-9).all()
    assert lost.energy[-1] < lost.energy[0] - 1e-4


def test_the_misplaced_bar_is_the_papers_energy_spike():
    scene, t = Scene(spins=(10, 10), link=BAR), np.arange(501) * 1e-3
    assert run_steps(paper_system(scene, 1e4, 250), None, t, 1e-3).energy == pytest.approx(100, abs=1e-9)
    spike = run_steps(paper_system(scene, 1e4, 250, bar_height=1.5), None, t, 1e-3)
    assert spike.paper_energy.max() > 150
    assert spike.paper_energy[[0, -1]] == pytest.approx([100, 100], abs=0.05)
    assert spike.energy[0] == pytest.approx(100 + 2 * 1e4 * 0.5**2 / 2)


@pytest.mark.parametrize(
    ("S", "D", "link", "spin"),
    [(1e4, 250, BAR, 10), (1e4, 0, BAR, 0), (1e4, 10, Link(1, 0.01, 0.1), 10), (1e5, 1, Link(1, 0.3, 0.02), 5),
     (1e4, 30, None, 3)],
)  # fmt: skip
def test_step_limit_is_where_the_step_fails(S, D, link, spin):
    system = paper_system(Scene(spins=(spin, -spin), link=link), S, D)
    limit = step_limit(system)
    assert limit.whole <= limit.joints.min() * (1 + 1e-12)
    assert step_limit_by_bisection(system) == pytest.approx(limit.whole, rel=0.01)
    assert step_grows(system, 1.05 * limit.whole)
    assert not step_grows(system, 0.95 * limit.whole)


def test_a_step_beyond_the_limit_says_so():
    system = paper_system(MOVING, 1e4, 250)
    with pytest.warns(LagrotorWarning, match="longest stable step"):
        run = run_steps(system, None, np.arange(11) * 0.1, 5e-3)
    assert run.ending.early and len(run.t) < 11 and run.summary()["estimated error"] == "not known"


def test_bodies_without_grounds_keep_their_momenta_and_a_ground_takes_them():
    free = RigidBodySystem(paper_bodies(MOVING), 1e4, 0.0)
    join_bar(free)
    t = np.arange(0, 1.0, 0.05)
    run = run_steps(free, None, t, 1e-3)
    start = sum(body.mass * body.velocity for body in paper_bodies(MOVING))
    assert np.abs(run.momentum - start).max() < 1e-12
    assert np.ptp(run.angular_momentum, axis=0).max() < 1e-12  # springs alone are central
    turning = sum(body.momentum + np.cross(body.centre, body.mass * body.velocity) for body in paper_bodies(MOVING))
    assert run.angular_momentum[0] == pytest.approx(turning)
    held = run_steps(paper_system(MOVING, 1e4, 0.0), None, t, 1e-3)
    assert np.ptp(held.momentum, axis=0).max() > 0.1


def test_a_run_that_begins_far_from_the_zero_of_the_clock_is_as_exact():
    """LSODA gathered the rounding of the clock, 4×10⁻⁹ s: it told 10⁻⁵ of a run that is known to 10⁻¹⁰."""
    system, t = paper_system(MOVING, 200, 1), np.array([0.0, 0.0625, 0.25])
    near, far = (run_solver(system, None, begin + t, 1e-9) for begin in (0.0, 2.0**24))
    assert far.error == pytest.approx(near.error) and far.error < 1e-9
    assert abs(far.tips - near.tips).max() < 1e-11


@pytest.mark.parametrize(
    "t", [[0.0, 0.1, 0.25], [-0.2, -0.05, 0.0], [0.14, 0.2], [0.01, 0.05, 0.1], [-0.2, 0.13]], ids=str
)
def test_a_run_is_cut_at_a_shock_wherever_it_begins_and_ends(t):
    """A shock at 0 of width 0.02 s, at the start, at the end, before the run, around its start, up to an edge."""
    scene = replace(MOVING, shock=Shock((5.0, 0.0, 0.0), 0.0, 0.02))
    system = paper_system(scene, 200, 1)
    n = len(system.vertices)
    run = run_solver(system, scene.shock, t, 1e-7)

    def centres(force):
        rate = rate_function(system, force)
        strength = (lambda s: np.exp(-((s / 0.02) ** 2))) if force else (lambda s: 0.0)
        exact = solve_ivp(
            lambda s, y: rate(y.tolist(), strength(s)), (t[0], t[-1]), system.state[: 18 * n], "DOP853", t,
            rtol=1e-11, atol=1e-12, max_step=0.01,
        )  # fmt: skip
        return exact.y[: 3 * n].reshape(n, 3, -1).swapaxes(1, 2)

    assert run.t == pytest.approx(t) and run.ending.kind == "end"
    assert abs(run.centres - centres(scene.shock)).max() < run.error
    once = run_solver(system, scene.shock, t[:1], 1e-7)  # a single time, its start
    assert once.centres == pytest.approx(run.centres[:, :1], abs=1e-12) and once.evaluations == 0
    if t[0] < 0.13:  # twin: the shock is felt
        assert abs(run.centres - centres(None)).max() > 1e-5
