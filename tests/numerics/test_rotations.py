"""Axes between samples: on the unit sphere, with tangent rates, of fourth order."""

import numpy as np
import pytest

from lagrotor.errors import InputError
from lagrotor.numerics import measured_order
from lagrotor.numerics.rotations import between_samples


def circles(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two axes on cones about z, turning in opposite senses, and their rates."""
    axes, rates = [], []
    for rho, rate in ((0.3, 2.0), (0.8, -3.0)):
        c, s, up = np.cos(rate * t), np.sin(rate * t), np.full(len(t), np.sqrt(1 - rho**2))
        axes.append(np.stack([rho * c, rho * s, up], axis=-1))
        rates.append(np.stack([-rho * rate * s, rho * rate * c, 0 * t], axis=-1))
    return np.array(axes), np.array(rates)


def test_axes_between_samples_are_unit_vectors_of_fourth_order_and_rates_of_third() -> None:
    times = np.linspace(0, 2, 301)
    exact, exact_rates = circles(times)
    steps, off, off_rates = (0.2, 0.1, 0.05), [], []
    for h in steps:
        t = np.linspace(0, 2, round(2 / h) + 1)
        axes, rates = between_samples(t, *circles(t), times)
        assert np.linalg.norm(axes, axis=-1) == pytest.approx(1, abs=1e-14)
        assert np.abs((axes * rates).sum(-1)).max() < 1e-13
        off.append(float(np.abs(axes - exact).max()))
        off_rates.append(float(np.abs(rates - exact_rates).max()))
    assert measured_order(steps, off) == pytest.approx(4, abs=0.3)
    assert measured_order(steps, off_rates) == pytest.approx(3, abs=0.3)


def test_times_outside_the_samples_and_a_single_sample_are_refused() -> None:
    t = np.array([0.0, 1.0])
    between_samples(t, *circles(t), t)
    for samples, times in ((t, [-0.1, 0.5]), (t, [0.5, 1.1]), (t[:1], [0.0])):
        with pytest.raises(InputError, match="between_samples"):
            between_samples(samples, *circles(samples), np.array(times))
