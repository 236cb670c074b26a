"""Frames and bodies against rotation matrices differentiated by hand, textbook Lagrangians and Newton–Euler equations."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError
from lagrotor.mechanics import Frame, System, coordinates, t
from tests.systems import I1, I3, R, g, l, m, rolling_disc

ANGLES = coordinates("phi theta psi")


def same(left: sp.Expr | sp.Matrix, right: sp.Expr | sp.Matrix) -> bool:
    return decide_equal(left, right).answer == "zero"


def test_a_top_made_of_a_body_is_the_textbooks() -> None:
    """Goldstein §5.7; the same whichever way the sum is written, which is an expression where sympy wants one."""
    (_, theta, _), (phi_v, theta_v, psi_v) = ANGLES.q, ANGLES.v
    body = Frame(ANGLES).turned("zxz", ANGLES.q).body(mass=m, inertia=(I1, I1, I3), centre=(0, 0, l))
    turning = (I1 + m * l**2) * (theta_v**2 + phi_v**2 * sp.sin(theta) ** 2)
    textbook = turning / 2 + I3 * (psi_v + phi_v * sp.cos(theta)) ** 2 / 2 - m * g * l * sp.cos(theta)
    V = m * g * l * sp.cos(theta)
    for L in (
        body.kinetic - V,
        -V + body.kinetic,
        body.kinetic - body.potential((0, 0, -g)),
        2 * (body.kinetic - V) / 2,
    ):
        top = System(ANGLES, L)
        assert same(top.L, textbook)
        assert top.bodies == (body,)
    # The inertia is about the centre of mass, not about the tip.
    assert sp.diff(body.kinetic, psi_v) == sp.diff(sp.sympify(body.kinetic), psi_v) and same(
        2 - (2 - body.kinetic), body.kinetic
    )
    at_the_tip = Frame(ANGLES).turned("zxz", ANGLES.q).body(m, (I1, I1, I3))
    assert not same(at_the_tip.kinetic - V, textbook)


ORDERS = ["xyz", "zxz", "yxy", "zyx"]


@settings(max_examples=15, deadline=None)
@given(st.sampled_from(ORDERS), st.lists(st.floats(-1.5, 1.5), min_size=12, max_size=12))
def test_velocities_are_those_of_the_moved_points(order: str, numbers: list[float]) -> None:
    """Against scipy's rotations, differentiated by differences: angular velocity, velocity of a point, kinetic energy."""
    q, v, arm, point = (np.array(numbers[i : i + 3]) for i in (0, 3, 6, 9))
    frame = Frame(ANGLES).moved(*arm.tolist()).turned(order, ANGLES.q).moved(0, 0, ANGLES.q[1])
    at = dict(zip((*ANGLES.q, *ANGLES.v), map(sp.Float, (*q, *v)), strict=True))

    def placed(time: float) -> tuple[Rotation, np.ndarray]:
        now = q + v * time
        turned = Rotation.from_euler(order.upper(), now)
        return turned, arm + turned.apply(point + [0, 0, now[1]])

    h = 1e-5
    (before, start), (after, end) = placed(-h), placed(h)
    here = placed(0)[0]
    spin = (before.inv() * after).as_rotvec() / (2 * h)
    assert np.array(frame.angular_velocity.xreplace(at), float).ravel() == pytest.approx(spin, abs=1e-6)
    assert np.array(frame.place(point.tolist()).xreplace(at), float).ravel() == pytest.approx(placed(0)[1], abs=1e-12)
    own = np.array(frame.velocity(point.tolist()).xreplace(at), float).ravel()
    assert here.apply(own) == pytest.approx((end - start) / (2 * h), abs=1e-6)
    inertia = np.array([[2, 0.1, 0], [0.1, 3, 0.2], [0, 0.2, 4]])
    body = frame.body(1.5, inertia.tolist(), point.tolist())
    kinetic = 0.75 * own @ own + spin @ inertia @ spin / 2
    assert float(sp.sympify(body.kinetic).xreplace(at)) == pytest.approx(kinetic, abs=1e-5)


def test_a_rotation_of_ones_own_is_a_turn() -> None:
    phi = ANGLES.q[0]
    by_matrix = Frame(ANGLES).turned([[sp.cos(phi), -sp.sin(phi), 0], [sp.sin(phi), sp.cos(phi), 0], [0, 0, 1]])
    by_letter = Frame(ANGLES).turned("z", phi)
    assert same(by_matrix.angular_velocity, by_letter.angular_velocity)
    driven = Frame(ANGLES).moved(0, 0, sp.sin(3 * t)).turned("z", 2 * t)
    assert list(driven.angular_velocity) == [0, 0, 2] and list(driven.velocity((1, 0, 0))) == [0, 2, 3 * sp.cos(3 * t)]


def newton_euler(times: np.ndarray, Q: np.ndarray, spin: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The same disc from momentum and angular momentum about the centre, with the force at the contact eliminated:
    centres (n, 3). Mass 2, radius 0.5, g = 9.81."""
    mass, radius, up = 2.0, 0.5, np.array([0, 0, 1.0])
    inertia = mass * radius**2 * np.diag([0.25, 0.5, 0.25])

    def cross(a: np.ndarray) -> np.ndarray:
        return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])

    def rhs(_: float, state: np.ndarray) -> np.ndarray:
        Q, w = state[:9].reshape(3, 3), state[9:12]
        n = Q[:, 1]
        across = up - (up @ n) * n
        length, n_v = np.linalg.norm(across), np.cross(w, n)
        across_v = -(up @ n_v) * n - (up @ n) * n_v
        down = -radius * across / length
        down_v = -radius * (across_v / length - across * (across @ across_v) / length**3)
        seen = Q @ inertia @ Q.T
        force = mass * (-np.cross(w, down_v) + 9.81 * up)  # without the part of the unknown angular acceleration
        matrix = seen - mass * cross(down) @ cross(down)
        w_v = np.linalg.solve(matrix, np.cross(down, force) - np.cross(w, seen @ w))
        return np.concatenate([(cross(w) @ Q).ravel(), w_v, -np.cross(w, down)])

    start = np.concatenate([Q.ravel(), spin, place])
    return solve_ivp(rhs, (0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-13).y[12:].T


@pytest.mark.parametrize("engine", ["core", "fast"])
def test_a_rolling_disc_follows_newton_and_euler(engine: str) -> None:
    if engine == "fast":
        pytest.importorskip("heyoka")
    system, wheel = rolling_disc()
    values, times = {m: 2.0, R: 0.5, g: 9.81}, np.linspace(0, 3, 61)
    q0, v0 = (0, 0, 0.5 * np.cos(0.3), 0.2, 0.3, 0.1), (0, 0, 0, 0.8, 0.4, 5.0)
    q0, v0 = system.consistent(values, q0, v0)
    run = system.simulate(values, q0, v0, times, 1e-11, engine)
    at = dict(zip((*system.c.q, *system.c.v), (*q0, *v0), strict=True)) | values
    Q = np.array([wheel.place(e) - wheel.place() for e in np.eye(3, dtype=int).tolist()])
    Q = np.array(sp.Matrix(Q.reshape(3, 3).T).subs(at), float)
    spin = Q @ np.array(wheel.angular_velocity.subs(at), float).ravel()
    oracle = newton_euler(times, Q, spin, np.array(q0[:3]))
    assert np.abs(run.q[:, :3] - oracle).max() < 1e-9
    assert run.drift.max() < 1e-10 and np.ptp(run.energy) < 1e-8
    # The twin that may slide sideways goes elsewhere.
    sliding = System(system.c, system.lagrangian, system.constraints, system.rolling[:1])
    assert np.abs(sliding.simulate(values, q0, v0, times, 1e-9).q[-1, :3] - oracle[-1]).max() > 1e-2


def test_an_uneven_body_is_drawn_by_its_axes_and_a_point_by_itself() -> None:
    frame = Frame(ANGLES).turned("zxz", ANGLES.q)
    assert [len(line) for line in frame.body(m, (I1, I1, I3), (0, 0, l)).outline] == [2, 34]
    block = frame.body(12, (5, 10, 13))  # 3 × 2 × 1
    assert [[abs(x) for x in line[1]] for line in block.outline] == [
        [
            sp.Rational(3, 2) / sp.sqrt(3) if i == 0 else 0,
            1 / sp.sqrt(3) if i == 1 else 0,
            sp.sqrt(3) / 6 if i == 2 else 0,
        ]
        for i in range(3)
    ]
    assert frame.body(m).outline == [[[0, 0, 0], [0, 0, 0]]]


def test_a_body_that_turns_in_a_plane_is_drawn_as_the_rod_that_it_hangs_by() -> None:
    """(0, I, 0) with I = m L²/12 about a centre L/2 below the pivot: from there to L below. The twin has its pivot there."""
    frame = Frame(ANGLES).turned("y", ANGLES.q[0])
    rod = frame.body(m, (0, m * l**2 / 12, 0), (0, 0, -l / 2))
    assert [list(map(sp.simplify, point)) for point in rod.outline[1]] == [[0, 0, 0], [0, 0, -l]]
    assert [len(line) for line in frame.body(m, (0, m * l**2 / 12, 0)).outline] == [34]


ODD = (sp.cos(sp.Rational(1, 10)), sp.sqrt(2) + sp.sqrt(3), sp.pi, sp.log(3), sp.Rational(7, 3) ** sp.Rational(1, 3))
PLACES: dict[str, Callable[[Any], dict[str, Any]]] = {
    "mass": lambda x: {"mass": x},
    "inertia": lambda x: {"inertia": (1 + x, 1 + x, 1 + x)},
    "inertia matrix": lambda x: {"inertia": [[x, 0.1, 0], [0.1, x, 0], [0, 0, x]]},
    "centre": lambda x: {"centre": (0, x, 1)},
    "length": lambda x: {"at": (x, 0, 0)},
    "angle": lambda x: {"angle": x},
    "axis": lambda x: {"axis": (0, x, 1)},
    "weight": lambda x: {"field": (0, x, -9)},
}


def odd_system(mass: Any = 1, inertia: Any = (1, 1, 1), centre: Any = (0, 0, 1), **joint: Any) -> System:
    c = coordinates("p r")
    arm = Frame(c).weld(joint.get("at", (0, 0, 0)), "y", (joint.get("angle", 0),)).pin("p", joint.get("axis", "x"))
    bodies = arm.body(mass, inertia, centre), arm.moved(1).pin("r", "y").body(1, (1, 1, 1), (0, 0, 1))
    return System(c, sum(body.kinetic - body.potential(joint.get("field", (0, 0, -9))) for body in bodies))


@pytest.mark.parametrize("place", PLACES)
def test_constants_that_are_neither_rational_nor_symbols_stand_everywhere(place: str) -> None:
    for x in ODD:
        exact, rounded = odd_system(**PLACES[place](x)), odd_system(**PLACES[place](float(x)))
        y = [0.1, 0.2, 0.3, 0.4]
        assert exact.rhs({})(0, y) == pytest.approx(rounded.rhs({})(0, y), rel=1e-9)


def test_an_inertia_of_odd_constants_that_no_body_has_is_refused() -> None:
    with pytest.raises(InputError, match="no body has the inertia"):
        odd_system(inertia=(sp.sqrt(2), sp.cos(sp.Rational(1, 10)) / 10, 1 / sp.pi))
