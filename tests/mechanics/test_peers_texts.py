"""Systems of Emmy's tests and of the text Learn Multibody Dynamics, written here, against the results that they give.

Emmy: what its tests print as formulas, decided; what they print as numbers, to the digits that they have
(github.com/mentat-collective/emmy, test/emmy/mechanics and test/emmy/sicm). The text: its derivations, by Kane's method, were
run at the states below and their numbers are kept (github.com/moorepants/learn-multibody-dynamics, e93297e). No code is theirs.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.mechanics import Frame, Plane, System, coordinates, t
from lagrotor.mechanics.running.programs import function_program

A, B, C, G, a, g, l, m, m1, m2, omega = sp.symbols("A B C G a g l m m_1 m_2 omega", positive=True)
sin, cos, R = sp.sin, sp.cos, sp.Rational
POLAR, SPHERE = coordinates("r phi"), coordinates("r theta phi")
ONE, EULER = coordinates("theta"), coordinates("theta phi psi")
U, V = sp.Function("U"), sp.Function("V")
(r, phi), (vr, vp), (ar, ap) = POLAR.q, POLAR.v, POLAR.a
(th,), (w,), (dw,) = ONE.q, ONE.v, ONE.a
ROUND = m * (vr**2 + r**2 * vp**2) / 2


def driven(at: sp.Expr) -> System:
    """A pendulum whose support is at the height `at`."""
    bob = Frame(ONE).moved(0, at, 0).turned("z", th).moved(0, -l, 0).body(m)
    return System(ONE, bob.kinetic - bob.potential((0, -g, 0)))


def top(*inertia: sp.Expr, weight: sp.Expr = sp.S.Zero) -> System:
    theta, turn, spin = EULER.q
    body = Frame(EULER).turned("zxz", (turn, theta, spin)).body(1, inertia)
    return System(EULER, body.kinetic - weight * cos(theta))


# The left sides of Lagrange's equations, in the order of the coordinates.
EMMY: dict[str, tuple[System, list[sp.Expr]]] = {
    "central force in polar coordinates": (
        System(POLAR, ROUND - U(r)),
        [-m * r * vp**2 + m * ar + U(r).diff(r), m * r**2 * ap + 2 * m * r * vp * vr],
    ),
    "two particles with any potential": (
        System(
            p := coordinates("x_1 y_1 x_2 y_2"),
            m1 * (p.v[0] ** 2 + p.v[1] ** 2) / 2 + m2 * (p.v[2] ** 2 + p.v[3] ** 2) / 2 - V(*p.q),
        ),
        [mass * p.a[i] + V(*p.q).diff(p.q[i]) for i, mass in enumerate((m1, m1, m2, m2))],
    ),
    "driven pendulum": (
        driven(a * cos(omega * t)),
        [-a * l * m * omega**2 * sin(th) * cos(omega * t) + g * l * m * sin(th) + l**2 * m * dw],
    ),
}


@pytest.mark.parametrize("name", EMMY)
def test_lagranges_equations_are_emmys(name: str) -> None:
    system, theirs = EMMY[name]
    for e, other, v in zip(system.motion, theirs, system.c.v, strict=True):
        assert decide_zero(e - other).answer == "zero" and decide_zero(e - other + m * v).answer == "nonzero"


def test_energies_momenta_and_hamiltonians_are_emmys() -> None:
    """Central force in space, the free body and the top in Euler's angles, Routh's function, angular momentum."""
    (rr, theta, _), (vrr, vtheta, vphi) = SPHERE.q, SPHERE.v
    space = System(SPHERE, m * (vrr**2 + (rr * vtheta) ** 2 + (rr * sin(theta) * vphi) ** 2) / 2 - V(rr))
    pairs = [(space.energy, space.L + 2 * V(rr))]
    (tilt, _, spin), (vt, vf, vs) = EULER.q, EULER.v
    free = top(A, B, C)
    pairs.append((free.mass_matrix.det(), A * B * C * sin(tilt) ** 2))
    pairs.append(
        (
            sp.diff(free.L, vf),
            (A * sin(spin) ** 2 + B * cos(spin) ** 2) * vf * sin(tilt) ** 2
            + (A - B) * vt * sin(spin) * cos(spin) * sin(tilt)
            + C * vf * cos(tilt) ** 2
            + C * vs * cos(tilt),
        )
    )
    upright = sp.Symbol("p_c", real=True)
    routhian = top(A, A, C, weight=G).routh("phi psi")
    bowl = -routhian.L.subs({routhian.c.v[0]: 0, "p_phi": upright, "p_psi": upright})
    bowl = bowl.subs({s: upright for s in bowl.free_symbols if str(s) in ("p_phi", "p_psi")})
    pairs.append((sp.limit(sp.diff(bowl, tilt, 2), tilt, 0), (upright**2 / 4 - A * G) / A))
    heavy, polar = (s.hamiltonian() for s in (top(A, A, C, weight=G), System(POLAR, ROUND + G * m / r)))
    pt, pf, ps = heavy.p
    wanted = pt**2 / (2 * A) + (pf - ps * cos(tilt)) ** 2 / (2 * A * sin(tilt) ** 2) + ps**2 / (2 * C) + G * cos(tilt)
    pairs.append((heavy.H, wanted))
    pairs.append((polar.H, polar.p[0] ** 2 / (2 * m) + polar.p[1] ** 2 / (2 * m * r**2) - G * m / r))
    for mine, theirs in pairs:
        assert decide_zero(mine - theirs).answer == "zero"


RIGID = {"A": 1.0, "B": np.sqrt(2.0), "C": 2.0}


def test_evolved_states_are_emmys() -> None:
    """After 100 s of a free body, in angles and by a quaternion, 1 s of a driven pendulum."""
    run = top(A, B, C).simulate(RIGID, (1, 0, 0), (0.1, 0.1, 0.1), (0, 100), 1e-10)
    wanted = (0.6319896958404042, 1.3610271540831438, 17.43790048472884)
    np.testing.assert_allclose(run.q[-1], wanted, atol=1e-8)
    np.testing.assert_allclose(run.v[-1], (-0.12343716197081755, 0.09016109524917856, 0.07567921658551353), atol=1e-8)
    ball = Frame(coordinates("q0 q1 q2 q3")).ball("q0 q1 q2 q3", omega="w_a w_b w_c").body(1, (A, B, C))
    start = (np.cos(0.5), np.sin(0.5), 0, 0), (0.1, 0.1 * np.sin(1), 0.1 * np.cos(1) + 0.1)
    turned = System(ball.frame.c, ball.kinetic).simulate(RIGID, *start, (0, 100), 1e-11)
    np.testing.assert_allclose(
        turned.u[-1], (-0.07215083472579442, -0.11343682989477462, 0.1484260290508369), atol=1e-8
    )
    values = {m: 1, l: 1, g: 9.8, a: 0.1, omega: 2 * np.sqrt(9.8)}
    swung = driven(a * cos(omega * t)).simulate(values, (1,), (0,), (0, 1), 1e-11)
    assert (swung.q[-1, 0], swung.v[-1, 0]) == pytest.approx((-1.030115687, -1.40985359), abs=1e-8)


def snakeboard() -> System:
    """Chapter Nonholonomic Equations of Motion."""
    c, I = coordinates("q1 q2 q3 q4 q5"), sp.Symbol("I_", positive=True)
    u = sp.symbols("u3 u4 u5", real=True)
    board = Frame(c).planar(*c.q[:3])
    trucks = [board.moved(s * l / 2, 0, 0).pin(q) for s, q in zip((1, -1), c.q[3:], strict=True)]
    L = sum((f.body(m, (0, 0, I)).kinetic for f in (board, *trucks)), sp.S.Zero)
    own = dict(zip(u, (l * c.v[2] / 2, *c.v[3:]), strict=True))
    return System(c, L, rolling=[f.velocity()[1] for f in trucks], velocities=own)


def four_bar() -> System:
    """Chapter Holonomic Constraints: points at the joints of a linkage, in the velocity of the crank."""
    c, (la, lb, lc, ln) = coordinates("q1 q2 q3"), sp.symbols("l_a l_b l_c l_n", positive=True)
    crank = Frame(c).pin(c.q[0])
    second = crank.moved(la, 0, 0).pin(c.q[1])
    third = second.moved(lb, 0, 0).pin(c.q[2])
    L = sum((e.kinetic - e.potential((0, -g, 0)) for e in (second.body(m), third.body(m))), sp.S.Zero)
    return System(c, L, third.coincides(Frame(c), (lc, 0, 0), (ln, 0, 0)), velocities={c.v[0]: c.v[0]})


def ball() -> System:
    """Chapter Equations of Motion with the Lagrange Method: a ball of unlike inertias that rolls, with its reactions."""
    c, rad, I = (
        coordinates("psi theta phi x y z"),
        sp.Symbol("r", positive=True),
        sp.symbols("I_x I_y I_z", positive=True),
    )
    body = Frame(c).moved(*c.q[3:]).turned("zxy", c.q[:3]).body(m, I)
    touch = body.rolls_on(Plane(Frame(c)), rad)
    return System(c, body.kinetic, touch.constraints, touch.rolling)


def jumper() -> System:
    """Chapter Energy and Power: a foot on soft ground, two links with a knee, a trunk above the foot."""
    c, foot = coordinates("q1 q2 q3"), sp.Symbol("m_f", positive=True)
    q1, q2, q3 = c.q
    I1, I2, kf, cf, kk, ck, la, lb, da, db, ma, mb, mu = sp.symbols(
        "I_a I_b k_f c_f k_k c_k l_a l_b d_a d_b m_a m_b m_u", positive=True
    )
    T, down = sp.Symbol("T_k", real=True), (0, -g, 0)
    base = Frame(c).moved(0, q1, 0)
    shank = base.pin(q2)
    thigh = shank.moved(la, 0, 0).pin(q3)
    bodies = [
        base.body(foot),
        shank.body(ma, (0, 0, I1), (da, 0, 0)),
        thigh.body(mb, (0, 0, I2), (db, 0, 0)),
        (hip := thigh.moved(lb, 0, 0)).body(mu),
    ]
    L = sum((e.kinetic - e.potential(down) for e in bodies), sp.S.Zero)
    ground = kf * (-q1) ** R(3, 2) - cf * c.v[0]
    knee = kk * (q3 - sp.pi / 2) + ck * c.v[2] + T
    own = {u: u for u in (c.v[0], c.v[2])}
    return System(c, L, (hip.place()[0],), forces=(ground, 0, -knee), velocities=own)


KNEE = {
    "I_a": 0.4, "I_b": 0.3, "c_f": 3, "c_k": 2, "d_a": 0.2, "d_b": 0.15, "g": 9.81, "k_f": 5e3, "k_k": 12, "l_a": 0.45,
    "l_b": 0.4, "m_a": 3, "m_b": 2, "m_f": 1, "m_u": 5, "T_k": 0.7,
}  # fmt: skip
# A system, values, q, u; what is read; the text's numbers.
TEXT: dict[str, tuple[Callable[[], System], dict[str, float], Any, Any, Callable[[System], Any], list[float]]] = {
    "snakeboard": (
        snakeboard, {"l": 0.7, "I_": 0.1, "m": 1.3}, (0.2, -0.3, 0.4, 0.5, -0.7), (0.1, 0.6, -0.3),
        lambda s: (s.c.a[2] * l / 2, *s.c.a[3:], *s.c.v[:2]),
        [0.067197766002877, -0.191993617151077, -0.191993617151077, 0.140961917922225, 0.036455347418552],
    ),
    "four-bar linkage": (
        four_bar, {"l_a": 0.8, "l_b": 2, "l_c": 1, "l_n": 2, "m": 1, "g": 9.81},
        (np.deg2rad(10), 0.114760036790301, -2.642142839876826), (1.5,), lambda s: (s.c.a[0], *s.c.v[1:]),
        [-7.840643061613761, -2.221981628362386, 0.435078857469851],
    ),
    "rolling ball": (
        ball, {"m": 1.3, "I_x": 0.2, "I_y": 0.3, "I_z": 0.4, "r": 0.6}, (0.3, 0.4, 0.5, 0.1, 0.2, 0.6),
        (0.7, -0.4, 0.9, 0.404233665593157, 0.376264510449678, 0),
        lambda s: (*s.c.a, *s.multipliers[1:], s.multipliers[0]),
        [0.496269175861806, 0.55404153265124, 0.043432416259047, -0.061859043357473, -0.002663418767617, 0,
         -0.080416756364715, -0.003462444397902, 0],
    ),
    "jumper on the ground": (
        jumper, KNEE, (-0.01, 0.7876572647739783, 1.7), (-0.6, 1.1), lambda s: (s.c.a[0], s.c.a[2], s.c.v[1]),
        [-10.821357507039904, -8.712250376453708, -0.476055620952326],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", TEXT)
def test_accelerations_and_reactions_are_those_of_the_text(name: str) -> None:
    make, values, q, u, read, numbers = TEXT[name]
    system = make()
    program = function_program(system, *(sp.sympify(e) for e in read(system))).along(values)
    states = np.concatenate([q, u]) * np.array([[1], [1 + 1e-6]])  # and its twin, beside it
    seen, beside = program(states, np.zeros(2)).T
    np.testing.assert_allclose(seen, numbers, rtol=1e-10, atol=1e-12)
    assert not np.allclose(beside, numbers, rtol=1e-10, atol=1e-12)
