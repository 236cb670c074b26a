"""What sympy.physics.mechanics holds, taken as it is: its accelerations at random states."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

from lagrotor.errors import InputError
from lagrotor.mechanics import System, constrained_accelerations

m, l, g, k = sp.symbols("m l g k")
q1, q2 = dynamicsymbols("q1 q2")
u1, u2 = dynamicsymbols("q1 q2", 1)
CLOCK, N = dynamicsymbols._t, ReferenceFrame("N")
VALUES = {m: 1.3, l: 0.7, g: 9.81, k: 2.0}
DOUBLE = m * l**2 * (u1**2 + u2**2 / 2 + u1 * u2 * sp.cos(q1 - q2)) + m * g * l * (2 * sp.cos(q1) + sp.cos(q2))


def agree(method: LagrangesMethod, state: np.ndarray) -> float:
    """The largest difference of the accelerations and multipliers at a state (q, v), relative to the largest."""
    method.form_lagranges_equations()
    n, put = (
        len(method.q),
        dict(zip([*method.q.diff(CLOCK), *method.q], [*state[len(method.q) :], *state], strict=False)),
    )
    full = [e.xreplace(put).subs(VALUES | {CLOCK: 0.4}) for e in (method.mass_matrix_full, method.forcing_full)]
    peer = np.linalg.solve(*(np.array(e.tolist(), float) for e in full)).ravel()
    system = System.from_sympy(method)
    at = dict(zip((*system.c.q, *system.c.v), state, strict=True)) | VALUES | {sp.Symbol("t", real=True): 0.4}
    a, lam = (np.array(e.subs(at).tolist(), float).ravel() for e in constrained_accelerations(system))
    mine = np.concatenate([a, lam])
    return float(np.abs(mine - peer[n:]).max() / np.abs(peer[n:]).max())


@pytest.mark.parametrize("seed", range(3))
def test_a_method_of_sympy_has_the_same_accelerations(seed: int) -> None:
    """A double pendulum, pushed at a point and by a torque; a pendulum in x, y under its length; a knife edge."""
    state = np.random.default_rng(seed).uniform(-1, 1, 4)
    point, arm = Point("P"), N.orientnew("A", "Axis", [q2, N.z])
    point.set_vel(N, l * u1 * sp.cos(q1) * N.x + l * u1 * sp.sin(q1) * N.y)
    loads = [(point, -k * u2 * N.x + sp.cos(CLOCK) * N.y), (arm, g * u1 * N.z)]
    assert agree(LagrangesMethod(DOUBLE, [q1, q2], forcelist=loads, frame=N), state) < 1e-12
    free = m * (u1**2 + u2**2) / 2 - m * g * q2
    turn = np.array([np.sin(state[0]), np.cos(state[0])]) * 0.7  # on the circle, along it
    bound = LagrangesMethod(free, [q1, q2], hol_coneqs=[q1**2 + q2**2 - l**2])
    assert agree(bound, np.concatenate([turn, state[1] * np.array([turn[1], -turn[0]])])) < 1e-12
    assert bound.eom.jacobian(bound.lam_vec) == sp.Matrix(
        [2 * q1, 2 * q2]
    )  # there M a + … + Gᵀ λ = 0: the opposite sign
    knife = LagrangesMethod(free, [q1, q2], nonhol_coneqs=[u1 * sp.sin(q2) - u2])
    state[3] = state[2] * np.sin(state[1])
    assert agree(knife, state) < 1e-12


def test_a_lagrangian_of_functions_of_time_is_that_of_letters() -> None:
    system = System.from_sympy(DOUBLE, (q1, q2))
    assert [str(s) for s in (*system.c.q, *system.c.v)] == ["q1", "q2", "q1_dot", "q2_dot"]
    other = System.from_sympy(DOUBLE.subs(g, 2 * g), (q1, q2))
    assert system.same_as(System(system.c, system.L)).answer == "zero" and system.same_as(other).answer == "nonzero"


def test_what_is_none_of_these_is_refused() -> None:
    for given, q, words in (
        ("L", (), "must be a LagrangesMethod"),
        (DOUBLE, (), "with its coordinates"),
        (DOUBLE, (sp.Symbol("q1"),), "dynamicsymbols"),
        (DOUBLE, q1, "must be a tuple"),
        (DOUBLE, "q1 q2", "dynamicsymbols"),
    ):
        with pytest.raises(InputError, match=words):
            System.from_sympy(given, q)
