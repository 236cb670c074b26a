"""Floquet multipliers: Mathieu's tongues, a pendulum's orbit with its period, a rolling disc in its turn."""

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk, mathieu_a, mathieu_b

from lagrotor.errors import InputError, SingularError
from lagrotor.mechanics import System, coordinates, t
from lagrotor.mechanics.running import monodromy

C = coordinates("x")
(x,), (v,) = C.q, C.v
a, q, k = sp.symbols("a q k", real=True)
MATHIEU = System(C, v**2 / 2 - (a - 2 * q * sp.cos(2 * t)) * x**2 / 2)


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("strength", [0.3, 1.5])
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


@pytest.mark.parametrize("force", [-sp.sqrt(x), -sp.cbrt(x)])
def test_a_start_without_a_derivative_is_refused_before_the_run(force: sp.Expr) -> None:
    with pytest.raises(SingularError, match="floquet: the rate of x_dot has no value or no derivative"):
        System(C, v**2 / 2, forces=(force,)).floquet({x: 0, v: 0}, {}, 2)


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
