"""Rates and harmonics fitted to curves that are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrotor.numerics.curves import best_harmonics, harmonics_at

T = np.linspace(0.8, 8.8, 400)


def curve(rate, first=0.2, second=0.05, slope=0.01):
    s = T - T[0]
    return 0.3 + slope * (s - s.mean()) + first * np.cos(rate * s + 0.4) + second * np.sin(2 * rate * s)


def test_the_parts_of_a_known_curve():
    fit = harmonics_at(T, np.column_stack([curve(5.0), curve(5.0, 0.1, 0.0, -0.02)]), 5.0)
    assert fit.constant == pytest.approx([0.3, 0.3])
    assert fit.slope == pytest.approx([0.01, -0.02])
    assert fit.waves[0] == pytest.approx(np.array([0.2, 0.1]) * np.exp(0.4j))
    assert fit.waves[1] == pytest.approx([-0.05j, 0], abs=1e-12)
    assert fit.residual_squares < 1e-20
    assert harmonics_at(T, curve(5.0), 5.2).residual_squares > 0.1  # the twin
    assert harmonics_at(T, curve(5.0), 5.0, count=1).residual_squares > 0.1


@settings(max_examples=30, deadline=None)
@given(st.floats(3.0, 20.0), st.floats(0.85, 1.25))
def test_the_rate_is_found_from_a_guess(rate, off):
    found = best_harmonics(T, curve(rate), rate * off)
    assert found.rate == pytest.approx(rate, rel=1e-5)
    assert found.residual_squares < 1e-6
