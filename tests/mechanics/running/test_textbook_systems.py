"""Systems that are not in the gallery, each against its equations of motion written by hand, and a twin that is elsewhere."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from lagrotor.mechanics import Frame, System, coordinates, t

m, M, l, g, k, R, h, I, J, r, w, A, b = sp.symbols("m M l g k R h I J r omega A b", positive=True)
cos, sin, sqrt = sp.cos, sp.sin, sp.sqrt
DOWN = (0, 0, -g)
VALUES = {m: 0.3, M: 1.2, l: 0.5, g: 9.81, k: 40.0, R: 0.4, h: 0.2, I: 0.01, J: 0.05, r: 0.1, w: 3.0, A: 0.7, b: 0.4}
m_, M_, l_, g_, k_, R_, h_, I_, J_, r_, w_, A_, b_ = VALUES.values()


@dataclass(frozen=True)
class Case:
    make: Callable[[], System]
    accelerations: Callable[[float, np.ndarray, np.ndarray], object]
    q: tuple[float, ...]
    v: tuple[float, ...]
    twin: sp.Symbol = m


def cart() -> System:
    c = coordinates("x theta")
    top = Frame(c).moved(c.q[0])
    bob, wagon = top.turned("y", c.q[1]).body(m, centre=(0, 0, -l)), top.body(M)
    L = wagon.kinetic + bob.kinetic - bob.potential(DOWN)
    return System(c, L, dissipation=b * c.v[0] ** 2 / 2, forces=(A * cos(w * t), 0))


def cart_by_hand(s: float, q: np.ndarray, v: np.ndarray) -> object:
    S, C = np.sin(q[1]), np.cos(q[1])
    push = [A_ * np.cos(w_ * s) - b_ * v[0] - m_ * l_ * S * v[1] ** 2, -m_ * g_ * l_ * S]
    return np.linalg.solve([[M_ + m_, -m_ * l_ * C], [-m_ * l_ * C, m_ * l_**2]], push)


def furuta() -> System:
    c = coordinates("phi theta")
    arm = Frame(c).turned("z", c.q[0])
    pendulum = arm.moved(R).turned("x", c.q[1]).body(m, (I, I, 0), (0, 0, -l))
    L = arm.body(M, (0, 0, J)).kinetic + pendulum.kinetic - pendulum.potential(DOWN)
    return System(c, L, dissipation=b * c.v[0] ** 2 / 2, forces=(A, 0))


def furuta_by_hand(s: float, q: np.ndarray, v: np.ndarray) -> object:
    S, C, K, H = np.sin(q[1]), np.cos(q[1]), I_ + m_ * l_**2, m_ * R_ * l_
    mass = [[J_ + m_ * R_**2 + K * S**2, H * C], [H * C, K]]
    first = A_ - b_ * v[0] - 2 * K * S * C * v[0] * v[1] + H * S * v[1] ** 2
    return np.linalg.solve(mass, [first, K * S * C * v[0] ** 2 - m_ * g_ * l_ * S])


def shaken_top() -> System:
    c = coordinates("phi theta psi")
    body = Frame(c).moved(0, 0, A * cos(w * t)).turned("zxz", c.q).body(m, (J, J, I), (0, 0, l))
    return System(c, body.kinetic - body.potential(DOWN))


def shaken_top_by_hand(s: float, q: np.ndarray, v: np.ndarray) -> object:
    S, C, K, pull = np.sin(q[1]), np.cos(q[1]), J_ + m_ * l_**2, g_ - A_ * w_**2 * np.cos(w_ * s)
    spin = v[2] + v[0] * C
    first = (I_ * spin * v[1] - 2 * K * v[0] * v[1] * C) / (K * S)
    second = S * (K * v[0] ** 2 * C - I_ * spin * v[0] + m_ * pull * l_) / K
    return first, second, -first * C + v[0] * v[1] * S


def of(system: System) -> dict[sp.Symbol, float]:
    """The values of letters that are none of its coordinates."""
    return {letter: value for letter, value in VALUES.items() if letter.name not in map(str, system.c.q)}


CASES = {
    "a pendulum on a driven cart with friction": Case(cart, cart_by_hand, (0, 1.0), (0, 0.5)),
    "a Furuta pendulum": Case(furuta, furuta_by_hand, (0, 1.0), (0.5, 0.2)),
    "a top on a shaken support": Case(shaken_top, shaken_top_by_hand, (0, 0.6, 0), (0.3, 0, 300), J),
}


@pytest.mark.parametrize("name", CASES)
def test_it_moves_as_its_equations_by_hand(name: str) -> None:
    case, times = CASES[name], np.linspace(0, 1, 21)
    n = len(case.q)

    def rhs(s: float, y: np.ndarray) -> np.ndarray:
        return np.append(y[n:], case.accelerations(s, y[:n], y[n:]))

    found = solve_ivp(rhs, (0, 1), (*case.q, *case.v), "DOP853", times, rtol=1e-12, atol=1e-12).y.T
    run = case.make().simulate(of(case.make()), case.q, case.v, times, 1e-11)
    scale = 1 + np.abs(found).max()
    assert np.abs(np.hstack([run.q, run.v]) - found).max() < 1e-9 * scale
    assert run.drift.max() < 1e-12
    other = case.make().simulate(of(case.make()) | {case.twin: 1.001 * VALUES[case.twin]}, case.q, case.v, times, 1e-11)
    assert np.abs(np.hstack([other.q, other.v]) - found).max() > 1e-6 * scale


def test_a_ball_on_a_turntable_goes_in_circles_at_two_sevenths_of_its_rate() -> None:
    """Two rolling constraints that the table drives; Euler angles of the ball."""
    c = coordinates("x y phi theta psi")
    centre = Frame(c).moved(c.q[0], c.q[1], r)
    turned = centre.turned("zxz", c.q[2:])
    contact = turned.velocity((0, 0, -r), frame=centre)
    rolling = (contact[0] + w * c.q[1], contact[1] - w * c.q[0])
    ball = System(c, turned.body(m, (I, I, I)).kinetic, rolling=rolling)
    values = VALUES | {I: 2 / 5 * m_ * r_**2}
    start = ball.consistent(values, (0.3, 0, 0.1, 1.2, 0), (0.2, 0.1, 0.3, 0.2, 0.5))
    times = np.linspace(0, 4, 41)

    def circle(run_values: dict) -> float:
        run = ball.simulate(run_values, *start, times, 1e-10)
        z, z_v = run.q[:, 0] + 1j * run.q[:, 1], run.v[0, 0] + 1j * run.v[0, 1]
        rate = 2 / 7 * w_
        return float(np.abs(z - z[0] - z_v / (1j * rate) * (np.exp(1j * rate * times) - 1)).max())

    assert circle(values) < 1e-9
    assert circle(values | {I: 1 / 2 * m_ * r_**2}) > 1e-3


def test_the_hinge_force_of_a_tree_is_the_multiplier_of_what_holds_it() -> None:
    """A four-bar linkage by the recursion: multipliers as from the mass matrix."""
    c = coordinates("a b c")
    frame, L = Frame(c), sp.S.Zero
    for q in c.q:
        frame = frame.turned("y", q)
        bob, frame = frame.body(m, centre=(0, 0, -l)), frame.moved(0, 0, -l)
        L = L + bob.kinetic - bob.potential(DOWN)
    x, _, z = frame.place()
    loop = (x - l, z + l)
    tree, plain = System(c, L, loop), System(c, System(c, L).L, loop)
    q, v = tree.consistent(of(tree), (0.3, -1.2, -0.5), (0.4, 0, 0))
    runs = [system.simulate(of(tree), q, v, np.linspace(0, 0.5, 6), 1e-11) for system in (tree, plain)]
    for lam in tree.multipliers:
        np.testing.assert_allclose(runs[0].evaluate(lam), runs[1].evaluate(lam), rtol=1e-7)
