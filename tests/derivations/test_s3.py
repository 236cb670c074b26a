"""Section 3: particles, rigid bodies, the time step. Verdicts, their twins, and numbers from other sources."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from lagrotor.paper import Premise, decide
from lagrotor.paper.grammar import symmetric
from lagrotor.paper.rotor_pair.own_paper import PAPER

PARTICLES, BODY_SCRIPT, STEP, ROTATION, LINK = (
    "s3a_particles",
    "s3b_rigid_body",
    "s3c_time_step",
    "s3d_rotation",
    "s3e_link",
)
SECTION = [identifier for identifier in PAPER.equations if identifier.startswith("3.")]
RANDOM = np.random.default_rng(3)


@cache
def stated():
    return {s.id: s for stem in (PARTICLES, BODY_SCRIPT, STEP, ROTATION, LINK) for s in PAPER.statements(stem)}


def words(verdict):
    return [premise.says for premise in verdict.premises]


def test_every_equation_of_the_section_has_one_statement():
    assert sorted(stated()) == SECTION


@pytest.mark.parametrize(
    ("identifier", "assumed"),
    [
        *((identifier, ()) for identifier in ("3.01", "3.03", "3.05", "3.06", "3.11", "3.20")),
        *((identifier, ("opposite forces",)) for identifier in ("3.02", "3.07")),
        ("3.08", ("opposite forces", "central")),
        *((identifier, ("rigid",)) for identifier in ("3.09", "3.10")),
        ("3.13", ("time step", "principal inertias are equal")),
        ("3.14", ("rigid",)),
        ("3.15", ("bars in the sine",)),
        *((identifier, ()) for identifier in ("3.04", "3.12", "3.16", "3.17", "3.18", "3.19")),
    ],
)
def test_each_needs_these_premises_and_none_can_be_dropped(identifier, assumed):
    verdict = decide(stated()[identifier])
    assert len(verdict.premises) == len(assumed)
    assert all(part in said for part, said in zip(assumed, words(verdict), strict=True))
    for premise in verdict.premises:
        left = tuple(other for other in verdict.premises if other != premise)
        without = decide(replace(stated()[identifier], premises=left))
        assert without.verdict == "refuted"
        assert without.correction_verdict in (None, "refuted")


def test_unequal_inertias_let_omega_lag_by_one_order():
    verdict = decide(stated()["3.13"])
    assert (verdict.verdict, verdict.order) == ("holds-to-order", 1)
    step = tuple(premise for premise in verdict.premises if premise.small is not None)
    lagging = decide(replace(stated()["3.13"], premises=step))
    assert (lagging.verdict, lagging.order) == ("refuted", 0)


def test_equal_inertias_hide_what_is_wrong_in_3_12_and_3_17():
    principal = sp.symbols("I_x I_y I_z", positive=True)
    for identifier in ("3.17", "3.18"):
        equal = Premise("equal principal inertias", dict.fromkeys(principal[1:], principal[0]))
        assert decide(replace(stated()[identifier], premises=(equal,))).verdict == "holds-if"
    I_0 = symmetric("I_0")
    equal = Premise("equal principal inertias", dict(zip(I_0, principal[0] * sp.eye(3), strict=True)))
    assert decide(replace(stated()["3.12"], premises=(equal,))).verdict == "holds-if"


def test_the_number_in_3_19_is_seen_to_stand_for_a_vector():
    assert "the left side is a vector, the printed right side a number" in decide(stated()["3.19"]).evidence


def test_a_cross_product_turned_round_in_the_angular_momentum(changed_physics):
    edit = (PARTICLES, "summed(m * cross(d, U - U_cm)", "summed(m * cross(U - U_cm, d)")
    changed = changed_physics([edit], PARTICLES, BODY_SCRIPT)
    assert [changed[i].verdict for i in ("3.05", "3.10", "3.06", "3.11")] == ["refuted", "refuted", "holds", "holds"]


def test_twice_the_inertial_mass_in_newtons_law(changed_physics):
    changed = changed_physics([(PARTICLES, "[m * A - inside(i)", "[2 * m * A - inside(i)")], PARTICLES)
    assert [changed[i].verdict for i in ("3.07", "3.08", "3.02")] == ["refuted", "refuted", "holds-if"]


def test_a_body_that_turns_the_other_way(changed_physics):
    field = (BODY_SCRIPT, "field = U_cm + rate(Q) * d", "field = U_cm - rate(Q) * d")
    moments = (BODY_SCRIPT, "C_turned = Q * C_0 * Q.T", "C_turned = Q.T * C_0 * Q")
    changed = changed_physics([field, moments], BODY_SCRIPT)
    assert (changed["3.09"].verdict, changed["3.12"].verdict) == (
        "refuted",
        "holds",
    )  # 3.12 is that of the inverse turn
    assert changed["3.12"].correction_verdict == "refuted"


def test_changed_physics_of_a_step(changed_physics):
    light = changed_physics([(STEP, "exact_U = U + F / M * dt", "exact_U = U + 2 * F / M * dt")], STEP)
    assert light["3.13"].verdict == "refuted"
    other_way = changed_physics(
        [(ROTATION, "sp.eye(3) + sp.sin(angle) * N", "sp.eye(3) - sp.sin(angle) * N")], ROTATION
    )
    assert (other_way["3.15"].verdict, other_way["3.16"].correction_verdict) == ("refuted", "holds")
    one_sided = changed_physics([(LINK, "length_squared = (X_1 - X_2)", "length_squared = (X_1 - 2 * X_2)")], LINK)
    assert (one_sided["3.20"].verdict, one_sided["3.19"].correction_verdict) == ("refuted", "refuted")


def inertia(masses, places):
    return sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(masses, places, strict=True))


def test_the_inertia_tensor_turns_as_r_i_rt():
    masses, places = RANDOM.uniform(1, 2, 5), RANDOM.normal(size=(5, 3))
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    first, turned = inertia(masses, places), inertia(masses, places @ turn.T)
    np.testing.assert_allclose(turned, turn @ first @ turn.T, rtol=1e-12, atol=1e-12)
    assert np.abs(turned - turn.T @ first @ turn).max() > 0.1
    cube = np.vstack([np.eye(3), -np.eye(3)])  # isotropic: cannot tell
    same = inertia(np.ones(6), cube @ turn.T)
    np.testing.assert_allclose(same, turn.T @ inertia(np.ones(6), cube) @ turn, atol=1e-12)


def test_the_rows_of_the_program_give_omega_with_r_and_rt_exchanged():
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    first, omega = np.diag([1.0, 2.0, 2.5]), np.array([0.4, -1.0, 2.0])
    row = turn @ first @ turn.T @ omega  # numpy's one-dimensional arrays are the rows L
    stored = np.linalg.inv(first)
    np.testing.assert_allclose(row @ turn @ stored @ turn.T, omega)
    assert np.abs(row @ turn.T @ stored @ turn - omega).max() > 0.1


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rodrigues(omega, dt, normalise=True, sign=1.0):
    size = np.linalg.norm(omega)
    projector = np.outer(omega, omega) / (size**2 if normalise else 1)
    turned = np.cos(size * dt) * (np.eye(3) - projector)
    return projector + turned + sign * np.sin(size * dt) * cross(omega / size)


def test_the_finite_rotation_is_the_exponential():
    omega, dt = np.array([1.0, -2.0, 3.0]), 0.2
    exact = expm(dt * cross(omega))
    np.testing.assert_allclose(rodrigues(omega, dt), exact, atol=1e-14)
    np.testing.assert_allclose(rodrigues(omega, dt), Rotation.from_rotvec(omega * dt).as_matrix(), atol=1e-14)
    assert np.abs(rodrigues(omega, dt, normalise=False) - exact).max() > 0.1
    assert np.abs(rodrigues(omega, dt, sign=-1.0) - exact).max() > 0.1  # the sign of 3.14
    stretched = rodrigues(omega, dt, normalise=False)
    assert np.abs(stretched @ stretched.T - np.eye(3)).max() > 0.1


def test_internal_forces_across_the_line_turn_a_free_system():
    masses, places = np.array([1.0, 2.0, 3.0]), RANDOM.normal(size=(3, 3))

    def moment_rate(forces):
        centre = masses @ places / masses.sum()
        return sum(np.cross(x - centre, f) for x, f in zip(places, forces, strict=True))

    def pushed(direction):
        forces = np.zeros((3, 3))
        for i, j in ((0, 1), (0, 2), (1, 2)):
            f = direction(places[i] - places[j])
            forces[i] += f
            forces[j] -= f
        return forces

    assert np.abs(moment_rate(pushed(lambda d: 2.0 * d))).max() < 1e-12
    assert np.abs(moment_rate(pushed(lambda d: np.cross(d, [0, 0, 1.0])))).max() > 0.1


BODY = np.diag([1.0, 2.0, 2.5])


def stepped(dt, end, turn_sign=1.0):
    """The paper's step, corrected, for a free body of unequal inertias: its L, R and last Omega."""
    R, omega = np.eye(3), np.array([1.0, 0.5, -0.8])
    L = BODY @ omega
    for _ in range(round(end / dt)):
        omega = R @ np.linalg.inv(BODY) @ R.T @ L
        R = rodrigues(omega, dt, sign=turn_sign) @ R
    return R, omega


def test_the_step_is_of_first_order_though_omega_lags():
    start = np.array([1.0, 0.5, -0.8])

    def rates(_, y):
        R = y.reshape(3, 3)
        return (cross(R @ np.linalg.inv(BODY) @ R.T @ (BODY @ start)) @ R).ravel()

    exact = solve_ivp(rates, (0, 1), np.eye(3).ravel(), rtol=1e-11, atol=1e-12).y[:, -1].reshape(3, 3)
    errors = [np.abs(stepped(dt, 1.0)[0] - exact).max() for dt in (0.01, 0.005)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1, abs=0.1)
    wrong = [np.abs(stepped(dt, 1.0, turn_sign=-1.0)[0] - exact).max() for dt in (0.01, 0.005)]
    assert wrong[1] > 0.5 * wrong[0] > 0.05  # the wrong sign does not converge


def link_energy(sign):
    """Energy of two unit masses on the link along its run; `sign` turns the damper."""
    S, D = 30.0, 0.5

    def force(d, v):
        e = d / np.linalg.norm(d)
        return -(S * np.linalg.norm(d) + sign * D * (v @ e)) * e

    def rates(_, y):
        f = force(y[:3] - y[3:6], y[6:9] - y[9:])
        return np.concatenate([y[6:], f, -f])

    start = np.array([0.5, 0, 0, -0.5, 0, 0, 0.1, 1.0, 0, -0.3, -1.0, 0.2])
    y = solve_ivp(rates, (0, 3), start, rtol=1e-9, atol=1e-10, t_eval=np.linspace(0, 3, 200)).y
    momentum = y[6:9] + y[9:]
    assert np.abs(momentum - momentum[:, :1]).max() < 1e-8  # action and reaction
    return ((y[6:] ** 2).sum(0) + S * ((y[:3] - y[3:6]) ** 2).sum(0)) / 2


def test_the_corrected_link_never_gains_energy():
    assert np.diff(link_energy(1.0)).max() < 1e-7
    assert np.diff(link_energy(-1.0)).max() > 1e-3
