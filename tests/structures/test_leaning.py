"""Rest away from upright and small motion about it: a pendulum on a spring, the exact motion, upright as a case of it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrotor import Link, Structure
from lagrotor.errors import InputError
from lagrotor.structures import example
from lagrotor.structures.coefficients import coefficients

HEAVY = {"gravity": 9.81, "load": 1.0}
BENT = Structure(
    [(0, 0), (1, 0), (1.3, 1)], [(0, 1), (1, 2)], [6, -3, 4], link=Link(mass=0.2, inertia=0.02), hinge=9.0, **HEAVY
)


def test_a_weight_on_a_hinge_that_is_too_weak_leans_and_swings() -> None:
    """κ θ = g S sin θ; then A ω² = κ − g S cos θ across, and round the vertical nothing holds it."""
    s = Structure([(0, 0)], hinge=12.0, **HEAVY)
    c, kappa = coefficients(s), 12.0
    pull = 9.81 * c.S[0]
    lean = brentq(lambda x: kappa * x - pull * np.sin(x), 0.1, 3.0)
    axes = s.rest_near([(0.3, 0.4)])
    assert np.arccos(axes[0, 2]) == pytest.approx(lean, rel=1e-10) and axes[0, 1] / axes[0, 0] == pytest.approx(4 / 3)
    modes = s.modes_about(axes)
    assert (
        modes.rates == pytest.approx([0, np.sqrt((kappa - pull * np.cos(lean)) / c.A[0])], abs=1e-5)
        and not modes.topple
    )
    # With a spin the lean precesses: one zero root, one nutation at sqrt(ω² + (G/A)²).
    spun = replace(s, spins=(8.0,)).modes_about(axes)
    assert spun.rates.max() == pytest.approx(np.hypot(modes.rates.max(), 8.0 * s.rotor[0].I3 / c.A[0]), rel=1e-6)


@pytest.mark.parametrize("name", ["corner", "square"])
def test_upright_is_a_rest_like_others(name: str) -> None:
    s = replace(example(name), hinge=4.0)
    axes = s.rest_near(np.zeros((len(s.joints), 2)))
    one, other = s.modes_about(axes), s.modes()
    assert np.sort(one.rates) == pytest.approx(np.sort(other.rates), abs=1e-5)
    assert np.sort(one.growth) == pytest.approx(np.sort(other.growth), abs=1e-5) and one.topple == other.topple


def test_the_exact_motion_beside_a_lean_is_that_of_its_modes() -> None:
    axes = BENT.rest_near(0.5 * np.ones((3, 2)))
    assert np.hypot(*axes[:, :2].T).max() > 0.3
    modes = BENT.modes_about(axes)
    fastest = int(modes.rates.argmax())
    rate, shape, off = modes.rates[fastest], modes.shapes[fastest], []
    t = np.linspace(0, 6 / rate, 40)
    for size in (1e-3, 2e-3, 4e-3):
        run = BENT.simulate(t, axes + size * shape.real, -size * rate * shape.imag, tol=1e-9)
        wave = (shape[:, None] * np.exp(1j * rate * t)[:, None]).real
        off.append(np.abs(run.axes - axes[:, None] - size * wave).max())
    assert np.polyfit(np.log((1e-3, 2e-3, 4e-3)), np.log(off), 1)[0] == pytest.approx(2, abs=0.15)


def test_an_axis_that_rests_level_swings_up_and_down() -> None:
    """κ π/2 = g S; up and down A ω² = κ, and x and y alone could not tell it."""
    s = Structure([(0, 0)], **HEAVY)
    c = coefficients(s)
    level = replace(s, hinge=9.81 * c.S[0] / (np.pi / 2))
    axes = level.rest_near([(0.99, 0)])
    modes = level.modes_about(axes)
    assert axes[0] == pytest.approx([1, 0, 0]) and modes.rates == pytest.approx(
        [0, np.sqrt(level.hinge[0] / c.A[0])], abs=1e-6
    )
    assert np.abs(modes.shapes[:, 0]) == pytest.approx(np.array([[0, 1, 0], [0, 0, 1]]), abs=1e-9)


def test_bars_of_any_length_have_modes_where_they_rest() -> None:
    s = Structure([(0, 0), (1, 0)], [(0, 1, 0.8)], hinge=5.0)
    with pytest.raises(InputError, match="modes_about"):
        s.modes()
    axes = s.rest_near([(0.1, 0), (-0.1, 0)])
    assert axes[0, 0] == pytest.approx(0.1, abs=1e-6) and axes[1, 0] == pytest.approx(-0.1, abs=1e-6)
    assert len(s.modes_about(axes).rates) == 3 and not s.modes_about(axes).topple
