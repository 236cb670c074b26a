"""Section 5.1: the responses of the opposite-spin pair, against the equations put into numbers and the exact pair."""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.pair.notation import G, Omega, R, t
from lagrotor.paper.rotor_pair.own_paper import PAPER

NUMBERS = {"p": 1.75, "q": 3.25, "G": 10.0}


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    return PAPER.scripts.run("derivations", "s5_1_toppling")


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
