"""The paired precession as a function of time, and one amplitude from another."""

import numpy as np
import pytest
import sympy as sp

import lagrotor
from lagrotor import Link, Rotor, Scene, precession_orbit, simulate
from lagrotor.errors import DomainError, InputError
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.numerics.codegen import operations
from lagrotor.numerics.convergence import measured_order
from lagrotor.theory.paired_precession.amplitudes import (
    amplitude_of_first_harmonic,
    first_harmonic,
    largest_inclination,
)
from lagrotor.theory.paired_precession.evaluate import program
from lagrotor.theory.paired_precession.series import evaluate, paired_series, shape_of

SCENES = {
    "massless": Scene(spins=(10, -10)),
    "paper": Scene(spins=(10, -10), link=Link(1, 0.01, 0.1)),
    "heavy, other sense": Scene(spins=(-10, 10), link=Link(1, 1, 1)),
    "long, other rotor": Scene(spins=(7, -7), rotor=Rotor(1.3, 0.8, 0.9, 1.2), link=Link(1.1, 0.6, 0.2)),
}


@pytest.mark.parametrize(("name", "order"), [("paper", 9), ("heavy, other sense", 9), ("massless", 11)])
def test_close_to_the_exact_orbit_over_a_turn(name, order):
    exact, orbit = exact_orbit(SCENES[name], 0.204), precession_orbit(SCENES[name], 0.204, order)
    times = np.linspace(0, 2 * np.pi / abs(exact.frequency), 101)
    run = simulate(exact.scene, times, "minimal", 1e-13)
    assert np.abs(orbit(times) - run.axes).max() < 1e-6
    assert orbit.frequency == pytest.approx(exact.frequency, rel=1e-7)
    assert orbit.momentum == pytest.approx(run.joint_line_momentum[0], abs=1e-5)


@pytest.mark.parametrize("name", SCENES)
def test_default_order_is_close_at_any_time(name):
    """Over a hundred turns, against the exact orbit continued by its period."""
    exact, orbit = exact_orbit(SCENES[name], 0.204), precession_orbit(SCENES[name], 0.204)
    times = np.linspace(0, 2 * np.pi / abs(exact.frequency), 61)
    run = simulate(exact.scene, times, "minimal", 1e-13)
    later = times + 100 * 2 * np.pi / abs(exact.frequency)
    assert np.abs(orbit(later) - run.axes).max() < 1e-6


def test_equals_the_sum_of_the_harmonics():
    scene, order = SCENES["long, other rotor"], 6
    series, phases = paired_series(order, *shape_of(scene)), np.linspace(0, 7, 33)
    axes = precession_orbit(scene, 0.3, order).at_phase(phases)
    width = float(shape_of(scene)[0]) ** 0.5
    for i, (part, scale) in enumerate(((series.x, 1), (series.Y, width), (series.z, 1))):
        assert axes[0, :, i] == pytest.approx(scale * evaluate(part, 0.3, phases), abs=1e-14)
        sign = -1 if i == 0 else 1
        assert axes[1, :, i] == pytest.approx(sign * scale * evaluate(part, 0.3, phases + np.pi), abs=1e-14)


def test_a_point_costs_few_operations():
    """Horner's rule in cos² Phi: six operations an order for both axes, and no wave but one cosine and one sine."""
    counts = {order: operations(program(order)) for order in (9, 15)}
    assert counts[15] - counts[9] <= 6 * 6
    assert counts[15] <= 6 * 15 + 16


def test_shapes_and_start():
    orbit = precession_orbit(SCENES["paper"], 0.2, 3)
    assert orbit(0.0).shape == (2, 3)
    assert orbit(np.zeros((4, 5))).shape == (2, 4, 5, 3)
    assert orbit(0.0)[:, 0] == pytest.approx([0.2, 0.2])
    whole = precession_orbit(SCENES["paper"], 0.2)
    assert np.abs(whole(0.0) - np.array(whole.start.axes)).max() < 1e-9


def test_refused():
    scene = SCENES["paper"]
    with pytest.raises(InputError, match="opposite"):
        precession_orbit(Scene(spins=(10, 10)), 0.1)
    with pytest.raises(InputError, match="order"):
        precession_orbit(scene, 0.1, 0)
    with pytest.raises(InputError, match="order"):
        precession_orbit(scene, 0.1, 2.5)
    for r0 in (1.0, -2, float("nan"), "much"):
        with pytest.raises(DomainError, match="r0"):
            precession_orbit(scene, r0)
    with pytest.raises(DomainError, match="finite"):
        precession_orbit(scene, 0.1, 3)([0.0, np.inf])
    with pytest.raises(InputError, match="ring"):
        largest_inclination("cube")


def test_first_harmonic_of_the_exact_orbit_and_back():
    scene = SCENES["long, other rotor"]
    shape, ratio = (float(v) for v in shape_of(scene))
    sizes, off, back = (0.05, 0.1, 0.2), [], []
    for r0 in sizes:
        orbit = exact_orbit(scene, r0)
        phase = 2 * np.pi * np.arange(32) / 32
        x = simulate(orbit.scene, phase / orbit.frequency, "minimal", 1e-13).axes[0, :, 0]
        seen = float(2 * np.mean(x * np.cos(phase)))
        off.append(abs(float(first_harmonic(3)(r0, shape, ratio)) - seen))
        back.append(abs(float(amplitude_of_first_harmonic(3)(seen, shape, ratio)) - r0))
    assert measured_order(sizes, off) == pytest.approx(5, abs=0.2)
    assert measured_order(sizes, back) == pytest.approx(5, abs=0.2)


@pytest.mark.parametrize(
    ("shape", "link", "order", "slope"),
    [("dumbbell", Link(1.3, 0, 0), 3, 4), ("rod", Link(1.3, 2, 0), 3, 5), ("ring", Link(1, 0.01, 0.1), 3, None)],
)
def test_largest_inclination(shape, link, order, slope):
    scene, form = Scene(spins=(10, -10), link=link), largest_inclination(shape, order)
    sigma, ratio = (float(v) for v in shape_of(scene))
    sizes, off = (0.02, 0.04, 0.08), []
    for r0 in sizes:
        axes = precession_orbit(scene, r0).at_phase(np.linspace(0, 2 * np.pi, 8001))
        seen = np.hypot(axes[..., 0], axes[..., 1]).max()
        off.append(abs(float(form(r0, sigma, ratio)) - seen))
    assert max(off) < 1e-12 if slope is None else measured_order(sizes, off) == pytest.approx(slope, abs=0.2)


def test_public_names():
    for name in lagrotor.__all__:
        found = getattr(lagrotor, name)
        assert found.__doc__, name
    assert lagrotor.paired_momentum(2).expressions[0].has(sp.Symbol("r_0", real=True))
    scene = Scene(spins=(10, -10), link=Link(1, 0.01, 0.1), shock=lagrotor.Shock((40, 0, 0), 2, 1 / 20))
    assert lagrotor.shock_response(scene).frequency == pytest.approx(lagrotor.natural_rate(scene))


def test_a_series_that_does_not_converge_is_refused() -> None:
    with pytest.raises(DomainError, match=r"at r0 = 0\.7 .* does not converge"):
        precession_orbit(SCENES["massless"], 0.7)
    assert precession_orbit(SCENES["massless"], 0.5).frequency == pytest.approx(
        exact_orbit(SCENES["massless"], 0.5).frequency, rel=1e-3
    )
