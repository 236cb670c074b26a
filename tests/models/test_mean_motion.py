"""The mean of an oscillating run, and the error of taking it over a few turns."""

import numpy as np
import pytest

from lagrotor.errors import DomainError
from lagrotor.models import mean_error, mean_over


@pytest.mark.parametrize("turns", [4, 6.3, 8, 12.7, 24])
def test_the_mean_of_an_oscillation_is_below_its_error(turns):
    t = np.linspace(0, 1, 2001)
    for phase in np.linspace(0, np.pi, 9):
        wave = np.cos(2 * np.pi * turns * t + phase)
        assert abs(mean_over(t, wave)) < mean_error(wave, turns)
        assert abs(wave.mean()) > 0 or phase  # a plain mean leaves more


def test_ten_thousand_oscillations_are_below_the_error():
    """Of 4 to 60 turns, any phase, 3 to 12 values a turn, about any level."""
    rng, worst = np.random.default_rng(0), 0.0
    for turns in 10 ** rng.uniform(np.log10(4), 1.8, 10_000):
        t, level = np.linspace(0, 1, int(np.ceil(turns * rng.uniform(3, 12))) + 1), rng.uniform(-2, 2)
        wave = level + np.cos(2 * np.pi * turns * t + rng.uniform(0, 2 * np.pi))
        worst = max(worst, abs(mean_over(t, wave) - level) / mean_error(wave, turns))
    assert 0.9 < worst < 1


def test_too_few_samples_are_refused():
    with pytest.raises(DomainError, match="too few"):
        mean_over(np.arange(3.0), np.arange(3.0))
    with pytest.raises(DomainError, match="90 values over 3 turns"):
        mean_error(np.ones(90), 3)
    with pytest.raises(DomainError, match="20 values over 10 turns"):
        mean_error(np.ones(20), 10)
