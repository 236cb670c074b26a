"""Rates and centres read off curves that are known."""

import numpy as np
import pytest

from lagrotor.numerics import first_passage, peak, spectrum, turn_means
from lagrotor.numerics.curves import mean_between


def test_the_peak_of_a_known_sine():
    t = np.linspace(2.3, 10, 1541)
    rate, amplitude = spectrum(t, 3 + 0.2 * np.sin(11.4 * t + 0.3))
    assert peak(rate, amplitude) == pytest.approx(11.4, abs=1e-3)
    assert amplitude.max() == pytest.approx(0.2, rel=5e-3)
    assert peak(*spectrum(t, np.sin(11.5 * t))) != pytest.approx(11.4, abs=1e-2)  # the twin


def test_the_turns_of_two_circles():
    t = np.linspace(0, 10, 2001)
    circle = 0.2 * np.stack([np.cos(5 * t), np.sin(5 * t), 0 * t], -1)
    centres = np.array([[-0.4, 0.1, 1.0], [0.4, -0.1, 1.0]])
    crossings, means = turn_means(t, centres[:, None] + np.array([circle, -circle]))
    assert np.diff(crossings) == pytest.approx(2 * np.pi / 5, abs=1e-4)
    assert np.abs(means - centres[:, None]).max() < 1e-4
    assert np.abs(means - means.mean()).max() > 0.1  # the twin: not one centre for all


def test_the_mean_over_whole_turns_is_the_centre():
    t = np.linspace(0, 10, 2001)
    x = np.column_stack([0.3 + 0.2 * np.cos(5 * t), -0.1 + 0.2 * np.sin(5 * t)])
    turn = 2 * np.pi / 5
    assert mean_between(t, x, 1.0, 1.0 + 3 * turn) == pytest.approx([0.3, -0.1], abs=1e-4)
    assert mean_between(t, x[:, 0], 1.0, 1.0 + 3 * turn) == pytest.approx(0.3, abs=1e-4)
    assert mean_between(t, x[:, 0], 1.0, 1.0 + 3.3 * turn) != pytest.approx(0.3, abs=1e-3)  # the twin


def test_a_passage_is_between_samples():
    """At 40 samples a second, as the claims read their runs: to 10⁻⁶ s; the sample after it, which is the twin, is not."""
    t = 0.3 + np.arange(121) / 40
    x = np.sin(1.7 * (t - 0.3)) ** 2
    exact = 0.3 + np.arcsin(np.sqrt(0.4)) / 1.7
    assert first_passage(t, x, 0.4) == pytest.approx(exact, abs=2e-6)
    assert t[np.argmax(x > 0.4)] != pytest.approx(exact, abs=2e-3)
    assert first_passage(t, x, 1.5) == np.inf and first_passage(t, x, -1.0) == t[0]
    assert first_passage(t, np.sin(9 * t), 0.9999) < t[-1]  # a peak between two samples
