"""The equilibrium nearest to a configuration: a four-bar linkage against its reduction to one angle, and refusals."""

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import ConstraintError, InputError, LagrotorError, SingularError
from lagrotor.mechanics import Frame, System, coordinates, t

P = coordinates("A B phi")
a, b, r, d, g = sp.symbols("a b r d g", positive=True)
VALUES: dict[Any, float] = {a: 1, b: 2.5, r: 2, d: 3, g: 9.81}
C = coordinates("theta")
SWING = System(C, C.theta_dot**2 / 2 + sp.cos(C.theta))


def _four_bar() -> System:
    """A crank a, a coupler b and a rocker r, uniform rods of mass 1 kg/m that hang from two pins at the distance d."""
    first, last = sp.Matrix([0, 0]), sp.Matrix([d, 0])
    left = a * sp.Matrix([sp.cos(P.A), sp.sin(P.A)])
    right, over = last + r * sp.Matrix([sp.cos(P.B), sp.sin(P.B)]), left + b * sp.Matrix([sp.cos(P.phi), sp.sin(P.phi)])
    lagrangian = sp.S.Zero
    for one, two, mass in ((first, left, a), (left, over, b), (last, right, r)):
        v, w = (e.jacobian(P.q) * sp.Matrix(P.v) for e in (one, two))
        lagrangian += mass * (v.dot(v) + v.dot(w) + w.dot(w)) / 6 - mass * g * (one + two)[1] / 2
    return System(P, lagrangian, constraints=tuple(over - right))


FOUR_BAR = _four_bar()


def _one_angle(near: float) -> tuple[float, float]:
    """Return the equilibrium angle of the crank and the frequency of small motion, from the closed form of the loop."""
    mp.mp.dps = 30

    def angles(A: Any) -> tuple[Any, Any]:
        x, y = 3 - mp.cos(A), -mp.sin(A)
        distance = mp.hypot(x, y)
        phi = mp.atan2(y, x) - mp.acos((mp.mpf("6.25") + distance**2 - 4) / (5 * distance))
        return phi, mp.atan2(mp.mpf("2.5") * mp.sin(phi) - y, mp.mpf("2.5") * mp.cos(phi) - x)

    def potential(A: Any) -> Any:
        y, top = mp.sin(A), 2 * mp.sin(angles(A)[1])
        return mp.mpf("9.81") * (y / 2 + mp.mpf("2.5") * (y + top) / 2 + top)

    A = mp.findroot(lambda s: mp.diff(potential, s), near)
    turn = 2 * mp.diff(lambda s: angles(s)[1], A)
    v = mp.matrix([-mp.sin(A), mp.cos(A)])
    w = turn * mp.matrix([-mp.sin(angles(A)[1]), mp.cos(angles(A)[1])])
    dot = lambda p, q: p[0] * q[0] + p[1] * q[1]  # noqa: E731
    mass = (dot(v, v) + mp.mpf("2.5") * (dot(v, v) + dot(v, w) + dot(w, w)) + 2 * dot(w, w)) / 3
    return float(A), float(mp.sqrt(mp.diff(potential, A, 2) / mass))


def test_a_four_bar_linkage_agrees_with_its_reduction_to_one_angle() -> None:
    place = FOUR_BAR.rest({"A": -1.5, "B": -1.2, "phi": 0.1}, VALUES)
    angle, frequency = _one_angle(-1.33)
    assert float(place.at[P.A]) == pytest.approx(angle, abs=1e-14)
    assert place.residual is not None
    assert place.residual < 1e-13
    assert place.stability == "no small motion grows exponentially"
    rates = FOUR_BAR.linearise(place, VALUES).rates
    np.testing.assert_allclose(rates.imag, [-frequency, frequency], rtol=1e-12)
    again = FOUR_BAR.rest(place, VALUES)
    assert {s: float(x) for s, x in again.at.items()} == pytest.approx({s: float(x) for s, x in place.at.items()})
    assert "largest rate left" in place.summary()
    with pytest.raises(SingularError, match=r"system\.rest finds one"):
        SWING.linearise({"theta": 1e-6}, {})


@pytest.mark.parametrize(("near", "at", "words"), [(1.5, 0, "no small motion grows"), (1.6, np.pi, "grows at 1 1/s")])
def test_the_search_stays_in_the_neighbourhood(near: float, at: float, words: str) -> None:
    """An undamped step from 1.5 would lead to −12.6."""
    place = SWING.rest({"theta": near}, {})
    assert float(place.at[C.theta]) == pytest.approx(at, abs=1e-12)
    assert words in place.stability


def test_a_step_is_shortened_where_the_force_is_not_linear() -> None:
    """The force tanh 10 θ, whose slope at 0.3 is a hundredth of that at rest: steps of the full length would alternate."""
    place = System(C, C.theta_dot**2 / 2 - sp.log(sp.cosh(10 * C.theta))).rest({"theta": 0.3}, {})
    assert float(place.at[C.theta]) == pytest.approx(0, abs=1e-12)


def test_rest_of_ball_joints_and_of_rolling_bodies() -> None:
    """A body hangs below its ball joint; a loaded wheel rolls to the place where its load is lowest, x = R θ."""
    c = coordinates("q0 q1 q2 q3")
    ball = Frame(c).ball(c.q, sp.symbols("p q r", real=True))
    body = ball.body(mass=1, centre=(0, 0, -1), inertia=(1, 2, 3))
    place = System(c, body.kinetic - body.potential((0, 0, -9.81))).rest({"q0": 1, "q1": 0.3, "q2": 0.2, "q3": 0}, {})
    np.testing.assert_allclose([float(place.at[s]) for s in c.q[1:3]], 0, atol=1e-12)
    w = coordinates("s theta")
    energy = w.s_dot**2 / 2 + w.theta_dot**2 / 2 + sp.cos(w.theta - sp.Rational(1, 5))
    wheel = System(w, energy, rolling=(w.s_dot - 2 * w.theta_dot,))
    at = wheel.rest({"s": 3, "theta": 0}, {}).at
    assert float(at[w.theta]) == pytest.approx(0.2)


REFUSED: dict[str, tuple[type[LagrotorError], Callable[[], Any]]] = {
    "there may be no equilibrium": (SingularError, lambda: System(C, C.theta_dot**2 + C.theta).rest({"theta": 1}, {})),
    "depends on time": (InputError, lambda: System(C, C.theta_dot**2 + C.theta * t).rest({"theta": 1}, {})),
    "has velocities": (InputError, lambda: SWING.rest({"theta": 1, "theta_dot": 1}, {})),
    "theta without a value": (InputError, lambda: SWING.rest({}, {})),
    "no derivative everywhere": (
        InputError,
        lambda: System(C, C.theta_dot**2 - C.theta**2, dissipation=sp.Abs(C.theta_dot)).rest({"theta": 1}, {}),
    ),
    "no value or no derivative": (
        SingularError,
        lambda: System(P, sum(v**2 for v in P.v) - sp.sqrt(P.A**2 + P.B**2)).rest({"A": 0, "B": 0}, {}),
    ),
    "not reached the constraints": (
        ConstraintError,
        lambda: FOUR_BAR.rest({"A": 1, "B": 0, "phi": 0}, VALUES | {b: 20}),
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_it_is_refused_in_words(message: str) -> None:
    kind, action = REFUSED[message]
    with pytest.raises(kind, match=message):
        action()
