"""Motions linearised in numbers: the benchmark bicycle, a rolling disc, a spinning top, inputs and outputs."""

from functools import cache

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.mechanics import Frame, System, coordinates, t

R = sp.Rational
TILT = sp.Symbol("lambda", positive=True)
# Meijaard, Papadopoulos, Ruina & Schwab, Proc. R. Soc. A 463 (2007): M q'' + v C q' + (g K0 + v² K2) q = 0 for lean and steer.
MASS = [[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]]
DAMPING = [[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]]
GRAVITY = [[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]]
SPEED = [[0, 76.59734589573222], [0, 2.65431523794604]]


@cache
def bicycle() -> System:
    """Two knife-edged wheels, frame with rider, and front fork, with the parameters of the benchmark; x ahead, z up."""
    c = coordinates("x y psi phi theta delta gamma_r gamma_f")
    x, y, yaw, lean, pitch, steer, rear_turn, front_turn = c.q
    base, trail, r, f, g = R(102, 100), R(8, 100), R(3, 10), R(35, 100), R(981, 100)
    s, k = sp.sin(TILT), sp.cos(TILT)
    hub = Frame(c).moved(x, y, 0).turned("z", yaw).turned("x", lean).moved(0, 0, r)
    rear = hub.turned("y", rear_turn).body(2, (R(603, 10000), R(12, 100), R(603, 10000)))
    chassis = hub.turned("y", pitch)
    rider = chassis.body(
        85, [[R(92, 10), 0, -R(24, 10)], [0, 11, 0], [-R(24, 10), 0, R(28, 10)]], (R(3, 10), 0, R(6, 10))
    )
    fork = chassis.moved(base + trail, 0, -r).turned("y", -TILT).turned("z", steer)

    def seen(ahead: sp.Expr, up: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """A point of the upright bicycle in the axes of the fork, whose origin is where the steer axis meets the ground."""
        return k * (ahead - base - trail) + s * up, sp.S.Zero, -s * (ahead - base - trail) + k * up

    upright = fork.moved(*seen(R(9, 10), R(7, 10))).turned("y", TILT)
    bar = upright.body(
        4, [[R(5892, 100000), 0, R(756, 100000)], [0, R(6, 100), 0], [R(756, 100000), 0, R(708, 100000)]]
    )
    front_hub = fork.moved(*seen(base, f))
    front = front_hub.turned("y", front_turn).body(3, (R(1405, 10000), R(28, 100), R(1405, 10000)))
    height = front_hub.place()[2]
    rise = sp.Matrix([front_hub.place((1, 0, 0))[2] - height, 0, front_hub.place((0, 0, 1))[2] - height])
    length = sp.sqrt(rise.dot(rise))  # of the upward unit vector in the plane of the front wheel
    slips = rear.frame.velocity((0, 0, -r), hub)[:2] + front.frame.velocity(list(-f * rise / length), front_hub)[:2]
    L = sum(
        (b.kinetic - b.potential((0, 0, -g)) for b in (rider, bar, front)), rear.kinetic - rear.potential((0, 0, -g))
    )
    return System(c, L, (height - f * length,), tuple(slips))


def ridden(speed: float) -> dict[str, float]:
    still = {str(q): 0.0 for q in bicycle().c.q}
    return still | {"x_dot": speed, "gamma_r_dot": speed / 0.3, "gamma_f_dot": speed / 0.35}


def published(speed: float) -> np.ndarray:
    stiffness = 9.81 * np.array(GRAVITY) + speed**2 * np.array(SPEED)
    below = -np.linalg.solve(MASS, np.hstack([stiffness, speed * np.array(DAMPING)]))
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), below]))


def ordered(rates: np.ndarray) -> np.ndarray:
    return rates[np.lexsort((np.round(rates.imag, 6), np.round(rates.real, 6)))]


def test_the_benchmark_bicycle_has_its_published_eigenvalues() -> None:
    """At 0 to 9 m/s; the others are zero: where it is, where it heads, how far the wheels have turned, how fast it goes."""
    for speed in range(0, 11, 3):
        rates = bicycle().linearise(ridden(speed), {TILT: np.pi / 10}).rates
        size = np.abs(rates)
        np.testing.assert_allclose(
            ordered(rates[np.argsort(size)[-4:]]), ordered(published(speed).astype(complex)), rtol=1e-9
        )
        assert len(rates) == 10 and np.sort(size)[:6].max() < 1e-6
    # Self-stable between weave and capsize speed, 4.29 and 6.02 m/s; at another tilt of the steer axis it is another bicycle.
    stable = [
        bicycle().linearise(ridden(v), {TILT: np.pi / 10}).rates.real.max() < 1e-6 for v in (4.29, 4.30, 6.02, 6.03)
    ]
    assert stable == [False, True, True, False]
    other = bicycle().linearise(ridden(5), {TILT: 0.3}).rates
    assert np.abs(ordered(other[np.argsort(np.abs(other))[-4:]]) - ordered(published(5))).max() > 1e-3


def disc() -> System:
    c, g = coordinates("x y psi phi gamma"), sp.Symbol("g", positive=True)
    x, y, yaw, lean, turn = c.q
    hub = Frame(c).moved(x, y, 0).turned("z", yaw).turned("x", lean).moved(0, 0, 1)
    wheel = hub.turned("y", turn).body(1, (R(1, 4), R(1, 2), R(1, 4)))
    slip = wheel.frame.velocity((0, 0, -1), hub)
    return System(c, wheel.kinetic - wheel.potential((0, 0, -g)), rolling=(slip[0], slip[1]))


def test_a_disc_rolls_upright_from_its_least_speed_on() -> None:
    """v² = g R / 3 (Routh, Advanced Rigid Dynamics, §244)."""
    least = np.sqrt(9.81 / 3)
    for speed, unstable in ((0.99 * least, True), (1.01 * least, False)):
        at = {"psi": 0, "phi": 0, "x_dot": speed, "gamma_dot": speed}
        rates = disc().linearise(at, {"g": 9.81}).rates
        assert (rates.real.max() > 1e-2) == unstable
    with pytest.raises(ConstraintError, match="nearest on them"):
        disc().linearise({"psi": 0, "phi": 0, "x_dot": 1}, {"g": 9.81})
    with pytest.raises(SingularError, match="no steady motion"):
        disc().linearise({"psi": 0, "phi": 0.1, "x_dot": 1, "gamma_dot": 1}, {"g": 9.81})


def test_inputs_and_outputs_of_a_cart_with_a_pendulum() -> None:
    """Upright on a cart of mass 2: x'' = (F + …)/2, theta'' = 10 theta + …; the tension of nothing else."""
    c, F = coordinates("x theta"), sp.Symbol("F", real=True)
    (x, theta), (u, w) = c.q, c.v
    L = u**2 + ((u + w * sp.cos(theta)) ** 2 + w**2 * sp.sin(theta) ** 2) / 2 - 10 * sp.cos(theta)
    system = System(c, L, forces=(F, 0))
    found = system.linearise({x: 0, theta: 0}, {}, inputs=(F,), outputs=(x + sp.sin(theta), c.a[0]))
    M = np.array([[3, 1], [1, 1.0]])
    below = np.linalg.solve(M, [[0, 0, 1], [0, 10, 0]])
    np.testing.assert_allclose(found.A[2:, :2], below[:, :2], atol=1e-14)
    np.testing.assert_allclose(found.B[:, 0], [0, 0, *below[:, 2]], atol=1e-14)
    np.testing.assert_allclose(found.C, [[1, 1, 0, 0], found.A[2]], atol=1e-14)
    np.testing.assert_allclose(found.D[:, 0], [0, below[0, 2]], atol=1e-14)
    assert found.states == (x, theta, u, w)


def test_what_is_not_linearised_in_numbers_is_refused() -> None:
    c = coordinates("x y")
    (x, y), (u, w) = c.q, c.v
    free = (u**2 + w**2) / 2
    with pytest.raises(InputError, match="depends on time"):
        System(c, free + t * x).linearise({x: 0, y: 0}, {})
    with pytest.raises(InputError, match="no derivative everywhere"):
        System(c, free, forces=(-sp.sign(u), 0)).linearise({x: 0}, {})
    with pytest.raises(InputError, match="change with time"):
        System(c, free - sp.sin(x) * y**2).linearise({x: 0, y: 0, u: 1}, {})
    with pytest.raises(InputError, match="y without a value"):
        System(c, free - y**2).linearise({x: 0}, {})


@pytest.mark.parametrize("output", ["sqrt(x)", "log(x)", "asin(1 + x)", "sqrt(x² + y²)", "x/sqrt(x² + y²)"])
def test_what_has_no_derivative_at_the_point_is_refused(output: str) -> None:
    """One complex step gave 7×10¹⁴, 10³⁰, 10¹⁵, the slope 1 of a cone and nan; two steps differ. x √(x² + y²) has one."""
    c, k = coordinates("x y"), sp.Symbol("k", positive=True)
    x, y = c.q
    r = sp.sqrt(x**2 + y**2)
    made = {"sqrt(x)": sp.sqrt(x), "log(x)": sp.log(x), "asin(1 + x)": sp.asin(1 + x), "sqrt(x² + y²)": r}
    e, still = made.get(output, x / r), {x: 0, y: 0}
    kinetic = (c.v[0] ** 2 + c.v[1] ** 2) / 2
    with pytest.raises(SingularError, match="no value or no derivative"):
        System(c, kinetic - k * r**2 / 2).linearise(still, {k: 1}, outputs=(e,))
    with pytest.raises((SingularError, InputError), match="no value or no derivative"):
        System(c, kinetic, forces=(-e, -k * y)).linearise(still, {k: 1})
    assert np.array_equal(
        System(c, kinetic - k * r**2 / 2).linearise(still, {k: 1}, outputs=(x * r,)).C, np.zeros((1, 4))
    )


def test_a_hyperbolic_secant_has_a_derivative() -> None:
    """Its code replaces cosh, which overflows, by exp(−|x|); the modulus would lose the derivative by a complex step."""
    c = coordinates("x")
    wall = System(c, c.x_dot**2 / 2 - sp.log(sp.cosh(10 * c.x)) + 10 * sp.tanh(3) * c.x)
    rates = wall.linearise({"x": R(3, 10)}, {}).rates
    np.testing.assert_allclose(np.abs(rates), 10 / np.cosh(3), rtol=1e-10)
