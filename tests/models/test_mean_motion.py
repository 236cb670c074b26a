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


def test_too_few_samples_are_refused():
    with pytest.raises(DomainError, match="too few"):
        mean_over(np.arange(3.0), np.arange(3.0))
    with pytest.raises(DomainError, match="too few"):
        mean_error(np.ones(9), 3)
