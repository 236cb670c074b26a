"""All equilibria in a box, against those of many starts of Newton's method, closed forms, and the exact solver."""

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import brentq, fsolve

from lagrotor.errors import LagrotorWarning
from lagrotor.mechanics import System, coordinates

c, d = coordinates("x"), coordinates("a b")
(x,), (v,) = c.q, c.v
(a, b), (u, w) = d.q, d.v
g, k, R, Omega = sp.symbols("g k R Omega", positive=True)


def many_starts(system: System, values: dict, sides: list[tuple[float, float]]) -> list[tuple[float, ...]]:
    """The distinct roots of the forces that Newton's method finds from 400 starts, inside the box."""
    force = [sp.diff(system.L, q).subs(values).subs(dict.fromkeys(system.c.v, 0)) for q in system.c.q]
    f = sp.lambdify([system.c.q], force)
    slope = sp.lambdify([system.c.q], sp.Matrix(force).jacobian(list(system.c.q)))
    generator, kept = np.random.default_rng(3), list[tuple[float, ...]]()
    for _ in range(400):
        start = [generator.uniform(*side) for side in sides]
        root, _, found, _ = fsolve(f, start, fprime=slope, full_output=True, xtol=1e-13)
        inside = all(low <= r <= high for r, (low, high) in zip(root, sides, strict=True))
        if found == 1 and np.abs(f(root)).max() < 1e-10 and inside:
            kept += [tuple(root)] if all(np.abs(np.subtract(root, other)).max() > 1e-6 for other in kept) else []
    return sorted(kept)


@pytest.mark.parametrize(
    ("potential", "values"),
    [
        (2 * sp.cos(a) + sp.cos(b) - (a - b) ** 2 / 8, {}),
        (g * sp.cos(a) + sp.sin(b) * a - k * a**2 - b**2 / 3, {g: 2.0, k: 0.3}),
        (-((a**2 + b - 11) ** 2) / 20 - (a + b**2 - 7) ** 2 / 20, {}),
        (sp.cos(b) - 10 * a**2, {}),  # a is found at once, long before b permits the proof of a root
    ],
)
def test_a_box_holds_what_many_starts_find_and_no_less(potential: sp.Expr, values: dict) -> None:
    system, sides = System(d, (u**2 + w**2) / 2 + potential), [(-4.1, 4.3), (-4.2, 4.0)]
    found = system.equilibria(values=values, box=dict(zip(d.q, sides, strict=True)))
    places = [tuple(float(e) for e in each.at.values()) for each in found]
    known = many_starts(system, values, sides)
    assert len(places) == len(known) > 1
    np.testing.assert_allclose(places, known, atol=1e-8)
    for each in found:
        for q, (low, high) in each.enclosure.items():
            assert 0 < high - low < 1e-20 and abs(float(each.at[q]) - float(low)) < 1e-15


def test_roots_on_the_rim_and_on_a_cut_are_found_once() -> None:
    """sin x on [−2π, 2π] is zero five times, at the middle too; beyond the rim none is told of."""
    pendulum = System(c, v**2 / 2 + g * sp.cos(x))
    found = pendulum.equilibria(values={g: 9.81}, box={x: (-7, 7)})
    np.testing.assert_allclose([float(e.at[x]) for e in found], np.pi * np.arange(-2, 3), atol=1e-15)
    assert len(pendulum.equilibria(values={"g": 9.81}, box={"x": (0, 3)})) == 1
    assert len(pendulum.equilibria(values={g: 9.81}, box={x: (0.001, 3.1415)})) == 0
    assert System(c, v**2 / 2 - sp.exp(x)).equilibria(values={}, box={x: (-9, 9)}) == ()


def test_regular_equilibria_come_first_and_stand_for_their_point() -> None:
    """A spring pendulum also rests at r = 0, where its mass matrix is singular."""
    c, (m, k, l, g) = coordinates("r theta"), sp.symbols("m k l g", positive=True)
    (r, theta), (u, w) = c.q, c.v
    system = System(c, m * (u**2 + r**2 * w**2) / 2 + m * g * r * sp.cos(theta) - k * (r - l) ** 2 / 2)
    places, values = system.equilibria(), {"m": 1, "k": 40, "l": 1, "g": 9.81}
    assert [place.regular for place in places] == [True, True, False, False]
    hanging = places[0]
    assert hanging.at[theta] == 0 and system.linearise(hanging).modes()
    rates = system.floquet(system.equilibria(values=values, box={"r": (1, 2), "theta": (-1, 1)})[0], values, 1.0)
    assert abs(rates.multipliers) == pytest.approx(1)
    rational = {m: 1, k: 4, l: 1, g: sp.Rational(1, 3)}
    assert system.hamiltonian().normal_form(2, hanging, rational).frequencies


def test_a_pole_of_a_force_is_no_equilibrium() -> None:
    """Beside the lesser of two primaries that turn: Lagrange's L2."""
    nu = sp.Rational(1, 5)
    (x, y), (X, Y) = d.q, d.v
    far, near = sp.sqrt((x + nu) ** 2 + y**2), sp.sqrt((x - 1 + nu) ** 2 + y**2)
    moon = System(d, (X**2 + Y**2 + x**2 + y**2) / 2 + x * Y - y * X + (1 - nu) / far + nu / near)
    (second,) = moon.equilibria(values={}, box={x: (0.79, 1.3), y: (-0.01, 0.02)})  # the lesser primary is at 0.8
    place = float(second.at[x])
    assert float(second.at[y]) == 0 and abs(place - 0.8 / (place + 0.2) ** 2 - 0.2 / (place - 0.8) ** 2) < 1e-12


@pytest.mark.parametrize("edge", [np.pi, sp.pi])
def test_an_equilibrium_on_an_edge_that_is_rounded_is_in_the_box(edge: float | sp.Expr) -> None:
    """The double next to π is less than π, and 0.3 less than 3/10."""
    pendulum = System(c, v**2 / 2 + sp.cos(x))
    assert [round(float(e.at[x]), 3) for e in pendulum.equilibria(box={x: (-edge, edge)})] == [-3.142, 0, 3.142]
    assert len(pendulum.equilibria(box={x: (0, float(edge) - 1e-15)})) == 1
    spring = System(c, v**2 / 2 - (x - sp.Rational(3, 10)) ** 2 / 2)
    assert [len(spring.equilibria(box={x: (0, end)})) for end in (0.3, 0.3 - 1e-16, sp.Rational(0.3))] == [1, 0, 0]


@pytest.mark.parametrize(
    ("force", "roots"),
    [
        (1 - x * sp.Abs(x), (1.0,)),
        (sp.tan(x) - x - 1, (brentq(lambda s: np.tan(s) - s - 1, 0.5, 1.5),)),  # it rises from pole to pole
        (sp.Rational(1, 2) - x - 50 * sp.Max(x - 1, 0) ** 2 + sp.Max(-x, 0), (0.5,)),  # stops on both sides
        (sp.Min(sp.sin(x), sp.cos(x)), (0.0, np.pi / 2)),
        (sp.Piecewise((1, x < 0), (2, True)), ()),  # a jump that does not pass zero
        (1 - x - sp.Heaviside(x) * x, (0.5,)),
        (sp.Piecewise((-1, x <= 1), (x - 2, (x > 1) & (x < 2.5)), (1, True)), (2.0,)),
    ],
)
def test_equilibria_of_forces_in_pieces(force: sp.Expr, roots: tuple[float, ...]) -> None:
    """Stops, contacts, friction cones: on each piece, and none on another."""
    rests = System(c, v**2 / 2, forces=(force,)).equilibria(box={x: (-2, 3)})
    assert [float(e.at[x]) for e in rests] == pytest.approx(roots, abs=1e-15)


@pytest.mark.parametrize(
    ("force", "roots"),
    [(sp.sign(1 - x), []), (sp.Piecewise((x + 1, x < 0), (x - 1, True)), [1.0]), (sp.Abs(x), [])],
)
def test_a_jump_through_zero_proves_nothing(force: sp.Expr, roots: list[float]) -> None:
    """Where the force jumps from one sign to the other no piece is zero: the slopes of the pieces would say otherwise."""
    with pytest.warns(LagrotorWarning, match="nothing is decided where (x|x - 1) = 0"):
        rests = System(c, v**2 / 2, forces=(force,)).equilibria(box={x: (-0.5, 1.4)})
    assert [float(e.at[x]) for e in rests] == roots


@pytest.mark.parametrize(
    ("box", "inside"),
    [
        ({a: (0.3, 3), b: (-0.5, 1.1)}, slice(2, 4)),
        pytest.param({a: (-3, 3), b: (-3, 3)}, slice(4), marks=pytest.mark.slow),
    ],
)
def test_equilibria_on_an_ellipse_are_those_by_its_own_angle(box: dict, inside: slice) -> None:
    """A spring to (1/2, 0) and x = 2 cos φ, y = sin φ: sin φ = 0, or cos φ = 1/3."""
    spring = ((a - sp.Rational(1, 2)) ** 2 + b**2) / 2
    places = System(d, (u**2 + w**2) / 2 - spring, constraints=(a**2 / 4 + b**2 - 1,)).equilibria(values={}, box=box)
    across = np.sqrt(8) / 3
    expected = [(-2, 0), (2 / 3, -across), (2 / 3, across), (2, 0)][inside]
    assert np.array([(e.at[a], e.at[b]) for e in places], float) == pytest.approx(np.array(expected), abs=1e-12)


@pytest.mark.parametrize("factor", [sp.Rational(1, 10**6), 10**6])
def test_equilibria_under_a_constraint_do_not_depend_on_its_units(factor: sp.Expr) -> None:
    """V = 10⁵ (y + x y / 3) on a circle, by its angle: cos φ + cos 2φ / 3 = 0."""
    system = System(d, (u**2 + w**2) / 2 - 10**5 * (b + a * b / 3), constraints=(factor * (a**2 + b**2 - 1),))
    places = system.equilibria(values={}, box={a: (-2, 2), b: (-2, 2)})
    x = (np.sqrt(17) - 3) / 4
    expected = [(x, -np.sqrt(1 - x**2)), (x, np.sqrt(1 - x**2))]
    assert np.array([(e.at[a], e.at[b]) for e in places], float) == pytest.approx(np.array(expected), abs=1e-12)


KINKS = {
    "spring at its hook": (
        -sp.Rational(981, 100) * b - 50 * (sp.sqrt(a**2 + b**2) - 1) ** 2,
        "a.*2 . b.*2 = 0, ",
        [(0, -1.0981), (0, 0.9019)],
    ),
    "two hooks": (
        -sum(50 * (sp.sqrt((a - s) ** 2 + b**2) - sp.Rational(1, 2)) ** 2 for s in (1, -1)) - b**2,
        ".*a . 1.* or .*a . 1.* = 0, ",
        [(0, 0)],
    ),
    "a ridge": (-sp.Abs(a) - (b - 1) ** 2, "a = 0, first about a = .*, b = ", []),
}


@pytest.mark.parametrize("kind", KINKS)
def test_a_kink_is_named_and_hides_no_equilibrium(kind: str) -> None:
    """The spring of length l hangs at −l − m g/k and balances at l − m g/k."""
    potential, place, expected = KINKS[kind]
    with pytest.warns(LagrotorWarning, match=f"nothing is decided where {place}"):
        places = System(d, (u**2 + w**2) / 2 + potential).equilibria(values={}, box={a: (-3, 3), b: (-3, 3)})
    assert np.array([(e.at[a], e.at[b]) for e in places], float).reshape(-1, 2) == pytest.approx(
        np.array(expected, float).reshape(-1, 2), abs=1e-12
    )
