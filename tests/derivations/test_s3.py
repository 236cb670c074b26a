"""Section 3: particles, rigid bodies, the time step. Verdicts, their twins, and numbers from other sources."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from lagrotor.paper.audit import statements
from lagrotor.paper.ledger import Relation, judge

STATED = {s.id: s for stem in ("s3a_rigid_body", "s3b_time_step") for s in statements(stem)}
VERDICTS = {
    "3.01": "definition",
    "3.02": "definition",
    "3.03": "definition",
    "3.04": "refuted",
    "3.05": "holds",
    "3.06": "definition",
    "3.07": "holds",
    "3.08": "holds-if",
    "3.09": "holds",
    "3.10": "holds",
    "3.11": "definition",
    "3.12": "refuted",
    "3.13": "holds-to-order",
    "3.14": "refuted",
    "3.15": "holds-if",
    "3.16": "refuted",
    "3.17": "refuted",
    "3.18": "refuted",
    "3.19": "refuted",
    "3.20": "holds",
}
RANDOM = np.random.default_rng(3)


def changed(relation: Relation) -> Relation:
    """The twin: the first entry of the printed side that is not zero, with its sign turned."""
    side = relation.printed
    if not isinstance(side, sp.MatrixBase):
        return replace(relation, printed=-side)
    side = sp.Matrix(side)
    place = next(i for i, entry in enumerate(side) if entry != 0)
    side[place] *= -1
    return replace(relation, printed=side)


def test_every_equation_of_the_section_has_one_statement():
    assert list(STATED) == list(VERDICTS)


@pytest.mark.parametrize("identifier", VERDICTS)
def test_verdict(identifier):
    verdict = judge(STATED[identifier])
    assert verdict.verdict == VERDICTS[identifier]
    assert (verdict.verdict == "refuted") <= (verdict.correction_verdict == "holds")


@pytest.mark.parametrize("identifier", VERDICTS)
def test_a_changed_sign_is_refuted(identifier):
    statement = STATED[identifier]
    held = statement.correction if VERDICTS[identifier] == "refuted" else statement.relations
    for relation in held:
        assert judge(replace(statement, relations=(changed(relation),), correction=())).verdict == "refuted"


def test_conditions_and_order():
    assert judge(STATED["3.08"]).condition.startswith("s = 0")
    assert judge(STATED["3.13"]).order == 1
    assert "I_y = I_x" in judge(STATED["3.13"]).condition
    assert judge(replace(STATED["3.13"], given={})).order == 0  # unequal inertias: Omega lags


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
