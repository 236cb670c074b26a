"""Section 5.1: the responses of the opposite-spin pair, against the equations put into numbers and the exact pair."""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor import Link, Scene, Shock, simulate
from lagrotor.errors import ProofError
from lagrotor.pair.notation import G_1, G_2, G, Omega, R, t
from lagrotor.paper import Remark, Stated, prove
from lagrotor.paper.rotor_pair.own_paper import PAPER

BAR = Link(mass=1, inertia=1)
NUMBERS = {"p": 1.75, "q": 3.25, "G": 10.0}


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    return PAPER.scripts.run("derivations", "s5_1_toppling")


def test_it_states_no_equation_and_its_remarks_are_sentences() -> None:
    shown = PAPER.scripts.executed("derivations", "s5_1_toppling")
    assert shown.shown(Stated) == []
    remarks = shown.shown(Remark)
    assert len({remark.title for remark in remarks}) == len(remarks) >= 5
    assert all(remark.title and remark.text.endswith(".") for remark in remarks)


@pytest.mark.parametrize("steady", [True, False])
@pytest.mark.parametrize("force", [(0.3, 0.0), (0.0, 0.3)])
def test_responses_solve_the_linear_pair(script: dict[str, Any], steady: bool, force: tuple[float, float]) -> None:
    """Against the pair written in (y_1, X, y_2) by hand and solved in numbers."""
    p, q, spin = NUMBERS.values()
    a, b = (p + q) / 2, (p - q) / 2
    mass = np.array([[a, 0, b], [0, 2 * p, 0], [b, 0, a]])
    turning = np.array([[0, -spin, 0], [spin, 0, -spin], [0, spin, 0]])
    load = np.array([force[1], force[0], 0.0])
    start = np.zeros(6) if steady else np.concatenate([np.zeros(3), np.linalg.solve(mass, load)])

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        pull = load if steady else 0 * load
        return np.concatenate([state[3:], np.linalg.solve(mass, pull - turning @ state[3:])])

    times = np.linspace(0, 3, 31)
    run = solve_ivp(rate, (0, 3), start, t_eval=times, rtol=1e-11, atol=1e-13).y
    expected = np.array([run[0] + run[2], run[1], run[0] - run[2]])
    name = ("steady" if steady else "shock") + ("_x" if force[0] else "_y")
    values = {R: 1, G: spin, script["p"]: p, Omega: spin / np.sqrt(p * q)}
    kind = "F" if steady else "P"
    values |= {script[f"{kind}_x"]: force[0], script[f"{kind}_y"]: force[1]}
    got = np.array([sp.lambdify(t, part.subs(values))(times) * np.ones(31) for part in script[name]])
    np.testing.assert_allclose(got, expected, atol=1e-8)


@pytest.mark.parametrize("name", ["steady_x", "steady_y", "shock_x", "shock_y", "both"])
@pytest.mark.parametrize("twin", [-1, 2, sp.Rational(1, 2)])
def test_twins_of_the_responses_are_refused(script: dict[str, Any], name: str, twin: Any) -> None:
    """With one component turned or scaled a response no longer satisfies the equations from rest."""
    right = script[name]
    kept = script["balance"](right)
    prove(kept, script["balance"](right))
    for i in (i for i in range(3) if right[i] != 0):
        wrong = sp.Matrix(right)
        wrong[i] *= twin
        with pytest.raises(ProofError):
            prove(script["balance"](wrong), kept)


def test_equal_spins_do_hold_toppling_and_leave_the_twist(script: dict[str, Any]) -> None:
    assert script["opposite"][0, 1] == 0 != script["opposite"][1, 2]
    equal = script["gyroscopic"].subs({G_1: G, G_2: G})
    assert equal[1, 2] == 0 != equal[0, 1]


@pytest.mark.parametrize(("direction", "mean"), [((1, 0), 0.0), ((0, 1), -1 / 20)])
def test_mean_x_after_a_small_real_shock(direction: tuple[int, int], mean: float) -> None:
    """A Gaussian pulse of finite width leaves the same mean: it is no matter of the impulse's shortness."""
    impulse, width = 0.01, 0.05
    force = impulse / (width * np.sqrt(np.pi))
    shock = Shock((direction[0] * force, direction[1] * force, 0), at=0.5, width=width)
    period = 2 * np.pi * np.sqrt(1.75 * 3.25) / 10
    times = 1.0 + np.linspace(0, period, 61)
    run = simulate(Scene(spins=(10, -10), link=BAR, shock=shock), [0.0, *times], "minimal", 1e-10).after(1.0)
    assert run.axes[:, :-1, 0].mean() / impulse == pytest.approx(mean, abs=5e-4)
