"""Closed forms: values against the exact models, broadcasting, and refusals."""

import numpy as np
import pytest

from lagrotor import Link, Scene, consistent_scene, corrected_trajectories, natural_rate, simulate
from lagrotor.errors import DomainError, InputError, SingularError
from lagrotor.theory import corrected_inclinations, free_precession_rate, pair_precession_rate, rotor_precession_rate
from lagrotor.theory.natural_frequency import natural_frequency

ALL = (
    rotor_precession_rate,
    pair_precession_rate,
    natural_frequency,
    corrected_trajectories,
    corrected_inclinations,
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


def test_the_rotor_s_rate_is_what_its_momenta_say() -> None:
    """A free rotor simulated: phi' from M_z, M_3 at each sample equals phi' from the motion."""
    scene = Scene(spins=(9, 0), link=None, axes=((0.6, 0, 0.8), (0, 0, 1)), rates=((0.4, 1.0, -0.3), (0, 0, 0)))
    run = simulate(scene, np.linspace(0, 3, 61), "spheres", 1e-12)
    r, v = run.axes[0], run.rates[0]
    J, G = scene.rotor.J, scene.momenta[0]
    rho2 = r[:, 0] ** 2 + r[:, 1] ** 2
    seen = (r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0]) / rho2
    M_z = J * (r[:, 0] * v[:, 1] - r[:, 1] * v[:, 0]) + G * r[:, 2]
    assert np.ptp(M_z) < 1e-9
    predicted = rotor_precession_rate()(run.inclinations[0], M_z, G, J)
    assert np.abs(predicted - seen).max() < 1e-8
    assert np.abs(rotor_precession_rate()(run.inclinations[0], M_z, -G, J) - seen).max() > 1


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
        (rotor_precession_rate, (0.0, 1.0, 1.0, 1.0), "outside its domain"),
        (rotor_precession_rate, (0.3, 1.0, 1.0, -1.0), "greater than zero"),
        (rotor_precession_rate, (float("nan"), 1.0, 1.0, 1.0), "not finite"),
        (pair_precession_rate, (0.0, 0.0, 1.0, 1.0, 1.0, 1.0), "outside its domain"),
        (natural_frequency, (1.0, 2.0, 1.0, 1.0), "outside its domain"),
        (corrected_trajectories, (1.2, 0.0, 1.0, 1.0), "outside its domain"),
        (corrected_trajectories, (np.array([0.1, -1.0]), 0.0, 1.0, 1.0), "r_0 = -1"),
        (corrected_inclinations, (-0.2, 0.0, 1.0), "outside its domain"),
        (free_precession_rate, (np.pi, 10.0, float("inf")), "not finite"),
    ],
)
def test_what_lies_outside_is_refused(make, values, words) -> None:
    with pytest.raises(DomainError, match=words):
        make()(*values)


def test_wrong_numbers_of_arguments_are_refused() -> None:
    with pytest.raises(InputError, match="takes 4 arguments"):
        corrected_trajectories()(0.1)
    with pytest.raises(InputError, match="must be a Scene"):
        natural_rate("scene")  # type: ignore[arg-type]


def test_consistent_scene_brings_a_state_onto_the_bar() -> None:
    scene = consistent_scene(
        (10, -10), ((0.2, 0.1, 1), (0.15, -0.1, 1)), ((1, 0, 0), (0, 1, 0)), link=Link(1.3, 1, 0.2)
    )
    run = simulate(scene, [0.0, 0.5], tol=1e-10)
    assert run.link_length == pytest.approx(1.3, abs=1e-12)
    with pytest.raises(SingularError, match="dependent"):
        consistent_scene((10, -10), ((0, 0, 0), (0, 0, 0)))
    with pytest.raises(InputError, match="finite"):
        consistent_scene((10, -10), ((np.nan, 0, 0), (0, 0, 1)))
    with pytest.raises(InputError, match="two vectors"):
        consistent_scene((10, -10), (1, 2))
