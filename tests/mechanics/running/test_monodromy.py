"""Floquet multipliers: Mathieu's tongues, a pendulum's orbit with its period, a rolling disc in its turn."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.special import ellipk, mathieu_a, mathieu_b

from lagrotor.errors import InputError
from lagrotor.mechanics import MonodromyMatrix, System, coordinates, t
from lagrotor.mechanics.running import monodromy

C = coordinates("x")
(x,), (v,) = C.q, C.v
a, q, k = sp.symbols("a q k", real=True)
MATHIEU = System(C, v**2 / 2 - (a - 2 * q * sp.cos(2 * t)) * x**2 / 2)


@pytest.mark.parametrize(("n", "strength"), [(1, 0.3), (2, 1.5)])
def test_the_tongues_of_mathieu_begin_and_end_at_its_characteristic_values(n: int, strength: float) -> None:
    """At a_n and b_n the trace over a period π is 2 (−1)^n; between them the multipliers are real, beside them on the circle."""
    low, high = sorted((float(mathieu_a(n, strength)), float(mathieu_b(n, strength))))

    def of(value: float) -> np.ndarray:
        found = MATHIEU.floquet({x: 0, v: 0}, {a: value, q: strength}, np.pi)
        assert found.error < 1e-8
        assert np.linalg.det(found.matrix) == pytest.approx(1, abs=1e-9)  # area is kept
        return found.multipliers

    for edge in (low, high):
        assert of(edge).sum().real == pytest.approx(2 * (-1) ** n, abs=1e-8)
    assert abs(of((low + high) / 2)[0]) > 1 + 1e-4
    for outside in (low - 0.05, high + 0.05):
        np.testing.assert_allclose(np.abs(of(outside)), 1, atol=1e-7)


def test_a_swing_has_two_multipliers_of_one_at_its_own_period() -> None:
    """In a plane: amplitude 1.5, period 4 K(sin 0.75); the energy changes the period, so that Φ is no unit matrix."""
    pendulum = System(C, v**2 / 2 + sp.cos(x))
    period = 4 * ellipk(np.sin(0.75) ** 2)
    found = pendulum.floquet({"x": 1.5}, {}, period)
    np.testing.assert_allclose(found.matrix.trace(), 2, atol=1e-8)
    assert np.abs(found.matrix - np.eye(2)).max() > 0.1
    with pytest.raises(InputError, match="has not come back"):
        pendulum.floquet({"x": 1.5}, {}, 1.01 * period)
    damped = System(C, v**2 / 2 - x**2 / 2, dissipation=k * v**2)
    rates = damped.linearise({x: 0}, {k: 0.1}).rates
    np.testing.assert_allclose(
        sorted(damped.floquet({x: 0}, {k: 0.1}, 2).multipliers, key=np.imag),
        sorted(np.exp(2 * rates), key=np.imag),
        rtol=1e-9,
    )


def test_a_pulse_in_a_coefficient_is_not_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a body at rest, whose steps nothing else bounds: x'' = −(1 + 3 δ(t − s)) x has the trace 2 cos 7 − 3 sin 7 at any s.

    Without the cut a step may come upon the pulse, which hangs on the processor; not upon each of four.
    """
    width, times = 0.001, (1.1, 2.3, 3.3, 4.7)

    def off(s: float) -> float:
        pulse = 3 * sp.exp(-(((t - s) / width) ** 2)) / (width * np.sqrt(np.pi))
        kicked = System(C, v**2 / 2 - (1 + pulse) * x**2 / 2)
        return float(abs(kicked.floquet({x: 0, v: 0}, {}, 7).matrix.trace() - 2 * np.cos(7) + 3 * np.sin(7)))

    assert max(map(off, times)) < 4 * width
    monkeypatch.setattr(monodromy, "clock_windows", lambda *_: ())
    assert max(map(off, times)) > 1  # twin


def test_a_circle_of_multipliers_has_the_motion_of_its_angle() -> None:
    """The same swing in x, y under the constraint of its length has the same trace."""
    c = coordinates("x y")
    (X, Y), (U, V) = c.q, c.v
    bound = System(c, (U**2 + V**2) / 2 - Y, (X**2 + Y**2 - 1,))
    found = bound.floquet({X: np.sin(1.5), Y: -np.cos(1.5)}, {}, 4 * ellipk(np.sin(0.75) ** 2))
    assert found.matrix.shape == (2, 2)
    np.testing.assert_allclose(found.matrix.trace(), 2, atol=1e-7)


@pytest.mark.parametrize("period", [0, -1, np.nan, "1", None])
def test_a_period_is_a_positive_time(period: object) -> None:
    with pytest.raises(InputError, match="must be a positive time"):
        MATHIEU.floquet({x: 0, v: 0}, {a: 1, q: 1}, period)  # type: ignore[arg-type]


def damped(c: float, stiffness: float, period: float) -> MonodromyMatrix:
    """x'' + c x' + stiffness x = 0: exp(λ T) of the roots λ."""
    return System(C, v**2 / 2 - stiffness * x**2 / 2, dissipation=c * v**2 / 2).floquet({x: 0}, {}, period)


def shaken(c: float, period: float, about: float = 0) -> MonodromyMatrix:
    """θ'' + c θ' + (1 + 1.2 cos 2t) sin θ = 0."""
    L = v**2 / 2 + (1 + 1.2 * sp.cos(2 * t)) * sp.cos(x)
    return System(C, L, dissipation=c * v**2 / 2).floquet({x: about}, {}, period)


def hung() -> MonodromyMatrix:
    """A pendulum of length one in x, y, damped: φ'' + 6 φ' + φ = 0 at its rest."""
    c = coordinates("x y")
    (X, Y), (U, V) = c.q, c.v
    bound = System(c, (U**2 + V**2) / 2 - Y, (X**2 + Y**2 - 1,), dissipation=3 * (U**2 + V**2))
    return bound.floquet({X: 0, Y: -1}, {}, 5)


def roots(c: float, stiffness: float, period: float) -> list[float]:
    return sorted(np.exp(np.roots([1, c, stiffness]) * period).real, reverse=True)


# Exact, or by power series of the solution in 30 digits (the first is issue 343 of BifurcationKit).
SMALL: dict[str, tuple[Callable[[], MonodromyMatrix], list[float], float]] = {
    "shaken about 0": (lambda: shaken(0.1, 20 * np.pi), [3267190.66686926, 5.71574457115e-10], 1e-8),
    "shaken about π": (lambda: shaken(10, 2 * np.pi, np.pi), [1.85530426634, 2.78008311419e-28], 1e-8),
    "damped": (lambda: damped(3, 1, 20), roots(3, 1, 20), 1e-8),
    "overdamped": (lambda: damped(10, 1, 30), roots(10, 1, 30), 1e-8),
    "critical": (lambda: damped(2, 1, 20), [np.exp(-20)] * 2, 1e-5),
    "constrained": (hung, roots(6, 1, 5), 1e-8),
}


@pytest.mark.parametrize("kind", SMALL)
def test_small_multipliers_are_resolved_and_no_error_is_larger_than_told(kind: str) -> None:
    make, expected, accuracy = SMALL[kind]
    turned = make()
    off = np.abs(turned.multipliers - expected)
    assert turned.multipliers == pytest.approx(expected, rel=accuracy, abs=0)
    assert (off <= turned.errors + 1e-9 * np.abs(expected)).all()
    assert (turned.errors < 1e-3 * np.abs(expected)).all()


def test_of_one_matrix_a_small_multiplier_is_rounding_and_is_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twin: without cuts of the period 4.7×10⁻¹⁰ was shown for 5.7×10⁻¹⁰, and 1.4×10⁻²⁰ for 1.8×10⁻²³."""
    monkeypatch.setattr(monodromy, "_CUTS", (1,))
    for kind in ("shaken about 0", "damped"):
        make, (large, small), _ = SMALL[kind]
        turned = make()
        assert turned.multipliers[0] == pytest.approx(large, rel=1e-6)
        assert np.isnan(turned.multipliers[1]) and turned.errors[1] > small
        assert turned.summary()["multiplier 2"].startswith("below ")


def test_the_multipliers_of_a_limit_cycle_have_liouvilles_determinant() -> None:
    """Van der Pol, μ = 4: one is 1, the other exp(∫ 4 (1 − x²) dt) over the cycle, 9×10⁻¹⁵."""
    cycle = System(C, v**2 / 2 - x**2 / 2, forces=(4 * (1 - x**2) * v,))

    def rate(_: float, y: np.ndarray) -> list[float]:
        return [y[1], 4 * (1 - y[0] ** 2) * y[1] - y[0], 4 * (1 - y[0] ** 2)]

    def turns(_: float, y: np.ndarray) -> float:
        return float(y[1])

    turns.direction = -1.0  # type: ignore[attr-defined]
    passed = solve_ivp(rate, (0, 60), (2.0, 0.0, 0.0), method="DOP853", rtol=1e-12, atol=1e-13, events=turns)
    times, states = passed.t_events[0][-2:], passed.y_events[0][-2:]
    turned = cycle.floquet({x: states[0, 0], v: 0}, {}, times[1] - times[0])
    determinant = np.exp(states[1, 2] - states[0, 2])
    assert turned.multipliers[0] == pytest.approx(1, abs=1e-6) and determinant < 1e-12
    assert np.prod(turned.multipliers).real == pytest.approx(determinant, rel=1e-5)


def test_a_chart_of_strong_damping_has_no_gaps() -> None:
    numbers = {"k": [5.0, 20.0], "q": [0.1, 0.3]}
    chart = System(C, MATHIEU.L, dissipation=k * v**2).stability_chart({x: 0}, {a: 1}, numbers, np.pi)
    assert np.isfinite(chart.growth).all() and (chart.growth < 0).all()
