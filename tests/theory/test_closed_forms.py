"""Closed forms: values against the exact models, broadcasting, and refusals."""

import numpy as np
import pytest

from lagrotor import corrected_trajectories, natural_rate
from lagrotor.errors import DomainError, InputError
from lagrotor.theory import free_precession_rate, pair_precession_rate
from lagrotor.theory.natural_frequency import natural_frequency

ALL = (
    pair_precession_rate,
    natural_frequency,
    corrected_trajectories,
    free_precession_rate,
)


@pytest.mark.parametrize("make", ALL)
def test_every_form_says_what_it_is(make) -> None:
    form = make()
    assert form.assumptions
    assert form.source
    assert len(form.outputs) == len(form.expressions)
    assert form is make(), "derived once"
    assert (form.order is None) == (form.small is None)


def test_broadcasting_and_shapes() -> None:
    phases = np.linspace(0, 6, 5)[:, None]
    amplitudes = np.array([0.1, 0.2, 0.3])
    outputs = corrected_trajectories()(amplitudes, phases, 1.0, 1.0)
    assert len(outputs) == 6
    assert all(o.shape == (5, 3) for o in outputs)
    again = corrected_trajectories()(amplitudes, phases + 1, 1.0, 1.0)
    assert outputs[0] is not again[0]
    assert not np.shares_memory(outputs[0], again[0])
    assert free_precession_rate()(0.0, 10.0, 1.25).shape == ()


@pytest.mark.parametrize(
    ("make", "values", "words"),
    [
        (free_precession_rate, (0.3, 1.0, -1.0), "greater than zero"),
        (free_precession_rate, (float("nan"), 1.0, 1.0), "not finite"),
        (pair_precession_rate, (0.0, 0.0, 1.0, 1.0, 1.0, 1.0), "outside its domain"),
        (natural_frequency, (1.0, 2.0, 1.0, 1.0), "outside its domain"),
        (corrected_trajectories, (1.2, 0.0, 1.0, 1.0), "outside its domain"),
        (corrected_trajectories, (np.array([0.1, -1.0]), 0.0, 1.0, 1.0), "r_0 = -1"),
    ],
)
def test_what_lies_outside_is_refused(make, values, words) -> None:
    with pytest.raises(DomainError, match=words):
        make()(*values)


def test_wrong_numbers_of_arguments_are_refused() -> None:
    with pytest.raises(InputError, match="takes 4 arguments"):
        corrected_trajectories()(0.1)
    with pytest.raises(InputError, match="give numbers or arrays"):
        corrected_trajectories(3)("a", 1.0, 1.0, 1.0)
    with pytest.raises(InputError, match="must be a Scene"):
        natural_rate("scene")  # type: ignore[arg-type]
