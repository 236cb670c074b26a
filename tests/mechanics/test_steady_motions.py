"""A, B, C, D in symbols: rolling and steady motions, controls; against closed conditions and the numbers of `state_space`."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import Frame, Plane, System, coordinates, t

m, M, r, g, w, F, l, I1, I3 = sp.symbols("m M r g w F l I_1 I_3", positive=True)
CART = coordinates("x theta")
(x, theta), (v, om) = CART.q, CART.v
POLE = System(
    CART,
    M * v**2 / 2 + m * (v**2 + 2 * l * v * om * sp.cos(theta) + l**2 * om**2) / 2 - m * g * l * sp.cos(theta),
    forces=(F, 0),
)
SPRING, QUARTIC = (
    System(CART, v**2 / 2 + om**2 / 2 - x**n / n) for n in (2, 4)
)  # whose slopes stay, at first or for good
PLANE = coordinates("x theta y")
y, vy = PLANE.q[2], PLANE.v[2]
SLOT = System(  # on a line that turns, whose rows turn where no reaction does: x'' = (w² − 1) x
    PLANE, (v**2 + vy**2 + om**2 - x**2 - y**2) / 2, (x * sp.sin(theta) - y * sp.cos(theta),)
)
C = coordinates("x y z phi theta psi")
GROUND = Frame(C)
WHEEL = GROUND.moved(*C.q[:3]).turned("zxy", C.q[3:]).body(m, (m * r**2 / 4, m * r**2 / 2, m * r**2 / 4))
STRAIGHT = dict.fromkeys(C.q, 0) | {C.q[2]: r, C.v[5]: w, C.v[0]: r * w}


@cache
def rolling_disc() -> System:
    """Two seconds, which the collection of other tests need not wait for."""
    contact = WHEEL.rolls_on(Plane(GROUND), r, axis=(0, 1, 0))
    return System(C, WHEEL.kinetic - WHEEL.potential((0, 0, -g)), contact.constraints, contact.rolling)


def test_the_cart_and_pole_of_textbooks() -> None:
    linear = POLE.linearise({x: 0, theta: 0}, inputs=(F,), outputs=(x, CART.a[0]))
    assert linear.B == POLE.linearise({x: 0, theta: 0}, inputs=("F",)).B  # by its name
    assert linear.states == (x, theta, v, om)
    assert sp.Matrix([[0, 0, 1, 0], [0, 0, 0, 1], [0, -g * m / M, 0, 0], [0, g * (M + m) / (M * l), 0, 0]]) == linear.A
    assert list(linear.B) == [0, 0, 1 / M, -1 / (M * l)]
    assert sp.Matrix([[1, 0, 0, 0], [0, -g * m / M, 0, 0]]) == linear.C and list(linear.D) == [0, 1 / M]


def test_a_rolling_disc_has_its_characteristic_polynomial() -> None:
    """s² = 4 g/(5 r) − 12 w²/5: it stands for w² > g/(3 r)."""
    s = sp.Symbol("s")
    linear = rolling_disc().linearise(STRAIGHT)
    expected = s**6 * (s**2 - 4 * g / (5 * r) + 12 * w**2 / 5)
    assert sp.expand(linear.characteristic(s) - expected) == 0
    numbers = {m: 1.3, r: 0.3, g: 9.81, w: 7.0}
    own = rolling_disc().linearise(
        {k: sp.sympify(e).subs(numbers) for k, e in STRAIGHT.items()}, {m: 1.3, r: 0.3, g: 9.81}
    )
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


def sleeping() -> System:
    """A top on a ball joint, which has no pole where it stands upright."""
    frame = Frame(coordinates("q0 q1 q2 q3")).ball("q0 q1 q2 q3", omega="p q r")
    body = frame.body(m, (I1, I1, I3), (0, 0, l))
    return System(frame.c, body.kinetic - body.potential((0, 0, -g)))


UPRIGHT = {"q0": 1, "q1": 0, "q2": 0, "q3": 0}


def test_a_sleeping_top_stands_from_its_least_spin_on() -> None:
    """(I3 w)² = 4 (I1 + m l²) m g l (Routh; Goldstein §5.7), in symbols, in numbers, and about its orbit."""
    numbers = {I1: 0.5, I3: 0.2, m: 1.0, g: 9.81, l: 1.0}
    linear = sleeping().linearise(UPRIGHT | {"r": w})
    threshold = I3**2 * w**2 - 4 * (I1 + m * l**2) * m * g * l
    conditions = [e.lhs for e in linear.stable_if.args]
    assert any(sp.expand(e - threshold) == 0 for e in conditions)
    least = float(sp.sqrt(4 * (I1 + m * l**2) * m * g * l).subs(numbers)) / 0.2
    for spin in (0.99 * least, 1.01 * least):
        own = sleeping().linearise(UPRIGHT | {"r": spin}, numbers)
        assert own.states == linear.states and [str(s) for s in own.states[:3]] == ["turn_p", "turn_q", "turn_r"]
        assert np.array(linear.A.subs({**numbers, w: spin}).tolist(), float) == pytest.approx(own.A, abs=1e-12)
        assert (own.rates.real.max() > 1e-2) == (spin < least) == (not linear.stable_if.subs({**numbers, w: spin}))
    (boundary,) = sleeping().root_locus(UPRIGHT | {"r": w}, numbers, w, np.linspace(30, 45, 3)).boundaries
    assert boundary == pytest.approx(least, rel=1e-8)
    orbit = sleeping().floquet(UPRIGHT | {"r": spin}, numbers, 2 * np.pi / spin)  # after which q is −q
    assert orbit.matrix == pytest.approx(expm(own.A * 2 * np.pi / spin), abs=1e-9) and orbit.states == own.states


def test_a_body_on_a_ball_joint_that_is_not_symmetric_turns_steadily_about_its_axes_alone() -> None:
    """Free: about the middle axis it grows at w √((I2 − I1)(I3 − I2)/(I1 I3)) (Landau & Lifshitz, Mechanics, §37)."""
    frame = Frame(coordinates("q0 q1 q2 q3")).ball("q0 q1 q2 q3", omega="p q r")
    free = frame.body(m, (2, 3, 4))
    rates = System(frame.c, free.kinetic).linearise(UPRIGHT | {"q": 1}, {}).rates
    assert rates.real.max() == pytest.approx(np.sqrt(1 / 8)) and len(rates) == 6
    heavy = frame.body(m, (2, 3, 4), (0, 0, l))
    hung = System(frame.c, heavy.kinetic - heavy.potential((0, 0, -g)))
    for values in (
        (),
        ({m: 1, l: 1, g: 9.81},),
    ):  # upright, it may spin about any axis of its own: gravity turns with it
        assert hung.linearise(UPRIGHT | {"r": 1}, *values).states
        with pytest.raises((SingularError, InputError), match=r"left over|change with time"):
            hung.linearise(UPRIGHT | {"p": 1}, *values)


def test_what_is_in_a_point_is_a_letter_of_the_system() -> None:
    for strange in ("phi_dot", "q0_dot", "W"):
        for values in ((), ({I1: 0.5, I3: 0.2, m: 1, g: 9.81, l: 1},)):
            with pytest.raises(InputError, match=f"{strange} in the point"):
                sleeping().linearise(UPRIGHT | {strange: 1}, *values)


def test_what_is_no_steady_motion_says_why() -> None:
    rolled = dict.fromkeys(C.q, 0) | {C.q[2]: r}
    for make, error, words in (
        (lambda: POLE.linearise({x: 0, theta: 1}, inputs=(F,)), SingularError, "is left over"),
        (lambda: POLE.linearise({x: 0}, inputs=(F,)), InputError, "theta without a value"),
        (lambda: POLE.linearise({theta: 0}, inputs=(sp.Symbol("u"),)), InputError, "inputs u"),
        (lambda: POLE.linearise({theta: 0}, inputs=(F, F)), InputError, "different letters"),
        (lambda: POLE.linearise({theta: 0}, {m: 1}, inputs=(F, "F")), InputError, "different letters"),
        (lambda: POLE.linearise({theta: 0, om: 1}, inputs=(F,)), InputError, "change with time"),
        (lambda: QUARTIC.linearise({x: 0, v: 1}, outputs=(x,)), InputError, "change with time"),
        (lambda: QUARTIC.linearise({x: 0, v: 1}, {}, outputs=(x,)), InputError, "change with time"),
        (lambda: SPRING.linearise({x: 0, v: 1}, outputs=(x,)), InputError, "forces change with time"),
        (lambda: SLOT.linearise(dict.fromkeys((x, y, theta), 0) | {om: w}), InputError, "theta moves there"),
        (lambda: SPRING.linearise({x: 0, v: 1}, {}, outputs=(x,)), InputError, "change with time"),
        (lambda: POLE.linearise({theta: 0}, inputs=(F,), outputs=("x",)), InputError, "no expression"),
        (lambda: rolling_disc().linearise(rolled | {C.v[5]: w}), InputError, "off the constraints"),
        (
            lambda: System(CART, POLE.L, forces=(F * t, 0)).linearise({theta: 0}, inputs=(F,)),
            InputError,
            "depends on time",
        ),
    ):
        with pytest.raises(error, match=words):
            make()
