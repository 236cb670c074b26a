"""Functions as ingredients: in the equations as what they are, in a run as an expression, callables, a table or a spline."""

import numpy as np
import pytest
import sympy as sp
from scipy.interpolate import CubicSpline, PPoly, make_interp_spline

from lagrotor.errors import InputError, IntegrationError, LagrotorWarning
from lagrotor.mechanics import Event, Frame, System, SystemRun, coordinates, t

U, y, u, F = (sp.Function(name) for name in ("U", "y_s", "u", "F"))
m, k, d, g, l = sp.symbols("m k d g l", positive=True)
C, PLANE = coordinates("x"), coordinates("r phi")
(x,), (v,) = C.q, C.v
r, r_dot, phi_dot = PLANE.q[0], *PLANE.v
CENTRAL = System(PLANE, m * (r_dot**2 + r**2 * phi_dot**2) / 2 - U(r))
SUPPORTED = System(C, m * (v + y(t).diff(t)) ** 2 / 2 - k * x**2 / 2, dissipation=d * v**2 / 2, forces=(u(t),))
WELL = System(C, m * v**2 / 2 - U(x))
NUMBERS = {m: 1, k: 4, d: 0.1}
T, FINE = np.linspace(0, 6, 25), np.linspace(0.3, 1.2, 1000)


@pytest.mark.parametrize(
    "value",
    [sp.Lambda(x, -1 / x), (lambda r: -1 / r, lambda r: 1 / r**2), CubicSpline(FINE, -1 / FINE)],
    ids=["Lambda", "callables", "spline"],
)  # fmt: skip
def test_each_kind_of_value_gives_the_motion_of_the_expression(value: object) -> None:
    times = np.linspace(0, 1.5, 6)  # some hundred knots
    exact = CENTRAL.simulate({m: 1, U: -1 / r}, (1, 0), (0, 0.8), times, 1e-9)
    run = CENTRAL.simulate({m: 1, U: value}, (1, 0), (0, 0.8), times, 1e-9)
    assert run.q == pytest.approx(exact.q, abs=1e-8)
    assert run.evaluate(U(r) + r * U(r).diff(r)) == pytest.approx(np.zeros(6), abs=1e-6)
    assert run.energy == pytest.approx(exact.energy, abs=1e-9)


KNOTS, HEIGHTS = np.array([0, 1.3, 2.1, 6.0]), np.array([0, 1.0, -1.0, 0.5])
BENDS = np.diff(np.diff(HEIGHTS) / np.diff(KNOTS), prepend=0.0)
SINCE = np.maximum(T[:, None] - KNOTS[:-1], 0)


@pytest.mark.parametrize(
    ("force", "exact"),
    [
        (make_interp_spline(KNOTS, HEIGHTS, k=1), (SINCE - np.sin(SINCE)) @ BENDS),  # x'' + x = s H(s) gives s − sin s
        (lambda s: float(s > np.pi), (1 + np.cos(T)) * (np.pi < T)),
    ],
)
def test_corners_of_a_table_and_jumps_of_a_callable_are_within_the_estimate(force: object, exact: np.ndarray) -> None:
    spring = System(C, v**2 / 2 - x**2 / 2, forces=(u(t),))
    run = spring.simulate({u: force}, (0.2,), (0,), T, 1e-7)
    assert np.abs(run.q[:, 0] - 0.2 * np.cos(T) - exact).max() <= run.error < 1e-7


def test_knots_of_a_potential_are_passed_and_stood_on() -> None:
    places = np.linspace(-1, 1, 5)
    table = (places, 2 * places**2)
    swung = WELL.simulate({m: 1, U: table}, (0.5,), (0,), T, 1e-11)
    assert swung.q[:, 0] == pytest.approx(0.5 * np.cos(2 * T), abs=1e-11)
    notch = PPoly(np.array([[-1.0, 1.0], [1.0, 0.0]]), np.array([-1.0, 0, 1]))  # U = |x|
    bounced = WELL.simulate({m: 1, U: notch}, (0.5,), (0,), np.array([0, 1.0, 4.0]), 1e-7)
    assert np.abs(bounced.q[:, 0] - [0.5, 0, 0.5]).max() <= bounced.error < 1e-7


def test_a_run_ends_where_its_table_does() -> None:
    with pytest.warns(LagrotorWarning, match="ended early"):
        run = WELL.simulate({m: 1, U: ([-1, 0, 1], [0, 0, 0])}, (0.5,), (1,), T)
    assert run.ending.at == pytest.approx(0.5) and run.q[-1, 0] == pytest.approx(1, abs=0.3)


def test_bodies_move_with_a_support_and_runs_are_kept(tmp_path: object) -> None:
    c = coordinates("a b")
    first = Frame(c).moved(0, 0, y(t)).turned("y", c.q[0])
    bodies = [frame.body(mass=m, centre=(0, 0, -l)) for frame in (first, first.moved(0, 0, -2 * l).turned("y", c.q[1]))]
    system = System(c, sum(b.kinetic - b.potential((0, 0, -g)) for b in bodies) - U(c.q[0] - c.q[1]))
    written, times = System(c, system.L), np.linspace(0, 2, 9)
    functions = {y: (np.linspace(0, 2, 9), np.sin(np.linspace(0, 2, 9))), U: (lambda s: s**2, lambda s: 2 * s)}
    start = (0.3, 0.1), (0, 0), times, 1e-9
    run, other = (s.simulate({m: 1, g: 9.81, l: 0.5} | functions, *start) for s in (system, written))
    assert run.q == pytest.approx(other.q, abs=1e-8)
    run.save(f"{tmp_path}/run.npz")
    again = SystemRun.load(f"{tmp_path}/run.npz", system, (), functions)
    assert again.at([0.77]).q == pytest.approx(run.at([0.77]).q, abs=1e-12)
    ended = system.simulate({m: 1, g: 9.81, l: 0.5} | functions, *start, events=Event(y(t) - c.q[0]))
    assert "y_s(t)" in ended.ending.reason and ended.evaluate(y(t) - c.q[0])[-1] == pytest.approx(0, abs=1e-12)


def test_small_motion_and_neighbours_have_the_second_derivative() -> None:
    values = ([lambda s: s**2, lambda s: 2 * s, lambda s: 2.0], x**2, ([-1, 0, 1, 2], [1, 0, 1, 4]))
    for value in values:
        assert WELL.linearise({x: 0}, {m: 1, U: value}).rates.imag == pytest.approx([-(2**0.5), 2**0.5])
    with pytest.raises(InputError, match="contain U'', which a callable for U alone does not give"):
        WELL.linearise({x: 0}, {m: 1, U: values[0][:2]})
    three = WELL.simulate({m: 1, U: values[0]}, (1,), (0,), np.linspace(0, 20, 5))
    assert abs(three.lyapunov().exponent) < 0.1


def test_what_is_no_function_is_refused_in_words() -> None:
    for value, words in (
        ("x**2", "is no function of 1 argument"),
        ((1, 2), "is no function"),
        (None, "is no function"),
        (True, "is no function"),
        (([1, 1], [2, 3]), "increase"),
        (([1, 2], [2, np.nan]), "finite"),
        (([1, 2, 3], [2, 3]), "3 and 2"),
        (sp.Function("W")(x), "without a value"),
        (v, "does not depend on it"),
        (sp.Symbol("zz") * x, "zz without a value"),
        (sp.Lambda((x, v), x), "has 2 arguments"),
        (lambda s: s**2, r"U', which a callable for U alone does not give: give values={U: \(U, U'\)}"),
        (([2, 3], [1, 1]), "no real value at the start"),
    ):
        with pytest.raises(InputError, match=words):
            WELL.simulate({m: 1, U: value}, (0.5,), (0,), T)
    with pytest.raises(IntegrationError, match="not a number"):
        WELL.simulate({m: 1, U: [abs, lambda s: None]}, (0.5,), (0,), T)
    for values, words in (
        ({m: 1}, "U without a value"),
        ({m: 1, U: x, "U": 1}, "give U twice"),
        ({m: 1, U: x**2, F: x}, "function F, which the system does not"),
    ):
        with pytest.raises(InputError, match=words):
            WELL.simulate(values, (0.5,), (0,), T)
    with pytest.raises(InputError, match="engine='core'"):
        WELL.simulate({m: 1, U: ([0, 1], [0, 1])}, (0.5,), (0,), T, engine="fast")
    with pytest.raises(InputError, match="a symbol of the system and a function"):
        System(C, m * v**2 / 2 - sp.Function("m")(x)).simulate({m: 1, "m": x}, (0,), (0,), T)
    for potential, words in (
        (sp.Function("x")(t), "plain"),
        (sp.Derivative(x, t), "plain"),
        (U(sp.Symbol("t")), "'t'"),
    ):
        with pytest.raises(InputError, match=words):
            System(C, v**2 / 2 - potential)


def test_all_equilibria_of_a_written_potential_are_found() -> None:
    wells = WELL.equilibria(values={m: 1, U: x**4 - 2 * x**2}, box={x: (-2, 2.5)})
    assert [float(e.at[x]) for e in wells] == pytest.approx([-1, 0, 1])
    for value, words in ((lambda s: s, "callable or a table"), (([0, 1], [0, 1]), "callable or a table")):
        with pytest.raises(InputError, match=words):
            WELL.equilibria(values={m: 1, U: value}, box={x: (-2, 2.5)})
    with pytest.raises(InputError, match="U without a value"):
        WELL.equilibria(values={m: 1}, box={x: (-2, 2.5)})


def test_a_function_that_is_only_in_a_velocity_of_ones_own_has_a_value() -> None:
    c, f, u = coordinates("x"), sp.Function("f"), sp.Symbol("u", real=True)
    moved, known = (System(c, c.v[0] ** 2 / 2, velocities={u: (2 + e) * c.v[0]}) for e in (f(c.q[0]), sp.sin(c.q[0])))
    run, other = (
        moved.simulate({f: (np.sin, np.cos)}, (0.1,), (0.2,), (0, 1)),
        known.simulate({}, (0.1,), (0.2,), (0, 1)),
    )
    np.testing.assert_allclose(run.q, other.q, atol=1e-8)
    with pytest.raises(InputError, match="f without a value"):
        moved.simulate({}, (0.1,), (0.2,), (0, 1))


def test_a_value_may_be_named_with_the_arguments_of_its_function() -> None:
    values = {m: 1, U(x): x**2}
    run = WELL.simulate(values, (1,), (0,), T)
    np.testing.assert_array_equal(run.q, WELL.simulate({m: 1, U: x**2}, (1,), (0,), T).q)
    z = sp.Symbol("z")
    np.testing.assert_array_equal(WELL.simulate({m: 1, U(z): z**2}, (1,), (0,), T).q, run.q)
    assert float(WELL.equilibria(values={m: 1, U(x): x**2}, box={x: (-1, 1)})[0].at[x]) == 0
    for key, words in ((U(2 * x), r"values name U\(2\*x\), no function of different symbols: name U alone"),):
        with pytest.raises(InputError, match=words):
            WELL.simulate({m: 1, key: x}, (1,), (0,), T)
    for key, words in ((U, "two values, as U and as"), ("U", "values give U twice")):
        with pytest.raises(InputError, match=words):
            WELL.simulate({**values, key: x}, (1,), (0,), T)
