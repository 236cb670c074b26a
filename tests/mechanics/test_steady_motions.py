"""A, B, C, D in symbols: rolling and steady motions, controls; against closed conditions and the numbers of `state_space`."""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import Frame, System, coordinates
from tests.systems import I1, I3, M, R, ball_top, cart_and_pole, g, l, m, rolling_disc

F, w = sp.symbols("F w", positive=True)
POLE = cart_and_pole(F)
(x, theta), (v, om) = POLE.c.q, POLE.c.v
UPRIGHT = {"q0": 1, "q1": 0, "q2": 0, "q3": 0}


def test_the_cart_and_pole_of_textbooks() -> None:
    linear = POLE.linearise({x: 0, theta: 0}, inputs=(F,), outputs=(x, POLE.c.a[0]))
    assert linear.B == POLE.linearise({x: 0, theta: 0}, inputs=("F",)).B  # by its name
    assert linear.states == (x, theta, v, om)
    assert sp.Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [0, -g * m / M, 0, 0], [0, g * (M + m) / (M * l), 0, 0]]) == linear.A
    assert list(linear.B) == [0, 0, 1 / M, -1 / (M * l)]
    assert sp.Matrix([[1, 0, 0, 0], [0, -g * m / M, 0, 0]]) == linear.C and list(linear.D) == [0, 1 / M]


def test_a_rolling_disc_has_its_characteristic_polynomial() -> None:
    """s² = 4 g/(5 R) − 12 w²/5: it stands for w² > g/(3 R)."""
    s = sp.Symbol("s")
    system, _ = rolling_disc()
    straight = dict.fromkeys(system.c.q, 0) | {system.c.q[2]: R, system.c.v[5]: w, system.c.v[0]: R * w}
    linear = system.linearise(straight)
    expected = s**6 * (s**2 - 4 * g / (5 * R) + 12 * w**2 / 5)
    assert sp.expand(linear.characteristic(s) - expected) == 0
    numbers = {m: 1.3, R: 0.3, g: 9.81, w: 7.0}
    own = system.linearise({k: sp.sympify(e).subs(numbers) for k, e in straight.items()}, {m: 1.3, R: 0.3, g: 9.81})
    mine = np.linalg.eigvals(np.array(linear.A.subs(numbers).tolist(), float))
    assert np.abs(np.poly(mine) - np.poly(own.rates)).max() < 1e-9 * np.abs(np.poly(own.rates)).max()


def test_a_steady_precession_is_that_of_numbers() -> None:
    c = coordinates("phi theta psi")
    body = Frame(c).turned("zxz", c.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    top = System(c, body.kinetic - m * g * l * sp.cos(c.q[1]))
    tilt, turn = sp.pi / 3, sp.Symbol("Omega", positive=True)
    J = I1 + m * l**2
    spin = (m * g * l / turn + J * turn * sp.cos(tilt)) / I3 - turn * sp.cos(tilt)
    at = {c.q[1]: tilt, c.q[0]: 0, c.q[2]: 0, c.v[0]: turn, c.v[2]: spin}
    linear = top.linearise(at | {g: g}, inputs=(g,), outputs=(c.q[1],))
    numbers = {I1: 0.1, I3: 0.15, m: 1.0, l: 0.5, g: 9.81, turn: 2.0}
    point = {k: float(sp.sympify(e).subs(numbers)) for k, e in at.items()}
    theirs = top.linearise(point, {I1: 0.1, I3: 0.15, m: 1, l: 0.5, g: 9.81}, inputs=(g,), outputs=(c.q[1],))
    at_g = linear.A.subs(numbers)
    assert [str(s) for s in linear.states] == [str(s) for s in theirs.states]
    assert np.array(at_g.tolist(), float) == pytest.approx(theirs.A, abs=1e-9)
    assert np.array(linear.B.subs(numbers).tolist(), float) == pytest.approx(theirs.B, abs=1e-9)


def test_a_sleeping_top_stands_from_its_least_spin_on() -> None:
    """(I3 w)² = 4 (I1 + m l²) m g l (Routh; Goldstein §5.7), in symbols, in numbers, and about its orbit."""
    numbers = {I1: 0.5, I3: 0.2, m: 1.0, g: 9.81, l: 1.0}
    linear = ball_top().linearise(UPRIGHT | {"r": w})
    threshold = I3**2 * w**2 - 4 * (I1 + m * l**2) * m * g * l
    conditions = [e.lhs for e in linear.stable_if.args]
    assert any(sp.expand(e - threshold) == 0 for e in conditions)
    least = float(sp.sqrt(4 * (I1 + m * l**2) * m * g * l).subs(numbers)) / 0.2
    for spin in (0.99 * least, 1.01 * least):
        own = ball_top().linearise(UPRIGHT | {"r": spin}, numbers)
        assert own.states == linear.states and [str(s) for s in own.states[:3]] == ["turn_p", "turn_q", "turn_r"]
        assert np.array(linear.A.subs({**numbers, w: spin}).tolist(), float) == pytest.approx(own.A, abs=1e-12)
        assert (own.rates.real.max() > 1e-2) == (spin < least) == (not linear.stable_if.subs({**numbers, w: spin}))
    (boundary,) = ball_top().root_locus(UPRIGHT | {"r": w}, numbers, w, np.linspace(30, 45, 3)).boundaries
    assert boundary == pytest.approx(least, rel=1e-8)
    orbit = ball_top().floquet(UPRIGHT | {"r": spin}, numbers, 2 * np.pi / spin)  # after which q is −q
    assert orbit.matrix == pytest.approx(expm(own.A * 2 * np.pi / spin), abs=1e-9) and orbit.states == own.states


def test_a_body_on_a_ball_joint_that_is_not_symmetric_turns_steadily_about_its_axes_alone() -> None:
    """Free: about the middle axis it grows at w √((I2 − I1)(I3 − I2)/(I1 I3)) (Landau & Lifshitz, Mechanics, §37)."""
    rates = ball_top((2, 3, 4), (0, 0, 0)).linearise(UPRIGHT | {"q": 1}, {}).rates
    assert rates.real.max() == pytest.approx(np.sqrt(1 / 8)) and len(rates) == 6
    hung = ball_top((2, 3, 4))
    for values in (
        (),
        ({m: 1, l: 1, g: 9.81},),
    ):  # upright, it may spin about any axis of its own: gravity turns with it
        assert hung.linearise(UPRIGHT | {"r": 1}, *values).states
        with pytest.raises((SingularError, InputError), match=r"not zero|change with time"):
            hung.linearise(UPRIGHT | {"p": 1}, *values)
