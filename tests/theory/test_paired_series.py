"""The periodic series of the paired precession against the exact orbit, and the exact orbit against itself."""

import numpy as np
import pytest
import sympy as sp

from lagrotor import (
    Link,
    Rotor,
    Scene,
    Shock,
    corrected_trajectories,
    natural_rate,
    paired_frequency,
    paired_momentum,
    paired_scene,
    simulate,
)
from lagrotor.errors import DomainError, InputError
from lagrotor.models import exact_orbit
from lagrotor.numerics import measured_order
from lagrotor.pair.notation import Phi, k, r0, sigma
from lagrotor.theory import paired_series, series_orbit

SCENES = {
    "massless": Scene(spins=(10, -10)),
    "heavy bar": Scene(spins=(10, -10), link=Link(1, 1, 1)),
    "long bar, other rotor": Scene(spins=(-7, 7), rotor=Rotor(1.3, 0.8, 0.9, 1.2), link=Link(1.1, 0.6, 0.2)),
    "short bar": Scene(spins=(12, -12), link=Link(0.7, 0.5, 0.1)),
}


def test_second_order_by_hand() -> None:
    """From the bar, x_1 − x_2 = 2 r_0² sin² Phi at sigma = k = 1; from J y'' = G x', y has −r_0²/4 sin 2 Phi."""
    series = paired_series(2, sp.Integer(1), sp.Integer(1))
    x = series.expression(series.x).coeff(r0, 2)
    y = series.expression(series.Y).coeff(r0, 2)
    assert sp.expand(sp.expand_trig(x - sp.sin(Phi) ** 2)).subs(sp.cos(Phi) ** 2, 1 - sp.sin(Phi) ** 2).expand() == 0
    assert sp.expand(y + sp.sin(2 * Phi) / 4) == 0


def test_coefficients_for_numbers_are_those_of_the_symbols() -> None:
    numbers = {sigma: sp.Rational(5, 9), k: sp.Rational(13, 10)}
    general, special = paired_series(4), paired_series(4, numbers[sigma], numbers[k])
    for name in ("x", "Y", "z", "frequency"):
        whole = general.expression(getattr(general, name)).subs(numbers)
        assert sp.expand(whole - special.expression(getattr(special, name))) == 0


@pytest.mark.parametrize("name", SCENES)
def test_the_series_keeps_unit_axes_and_the_bar_to_its_order(name: str) -> None:
    shape, ratio = SCENES[name].sigma, SCENES[name].k
    phases = np.linspace(0, 2 * np.pi, 41)
    for order in (2, 3):
        gaps = []
        for amplitude in (0.01, 0.02):
            r = np.array(corrected_trajectories(order)(amplitude, phases, shape, ratio)).reshape(2, 3, -1)
            unit = np.abs((r**2).sum(1) - 1).max()
            bar = np.abs(ratio * (r[1, 0] - r[0, 0]) + 1 - (r[0] * r[1]).sum(0)).max()
            gaps.append(max(unit, bar))
        assert measured_order((0.01, 0.02), gaps) > order + 0.9


@pytest.mark.parametrize("name", SCENES)
def test_the_exact_orbit_closes_and_has_its_symmetry(name: str) -> None:
    orbit = exact_orbit(SCENES[name], 0.2)
    turn = 2 * np.pi / abs(orbit.frequency)
    run = simulate(orbit.scene, np.linspace(0, turn, 41), "minimal", 1e-12)
    assert np.abs(run.axes[:, -1] - run.axes[:, 0]).max() < 1e-9
    half = run.axes[:, 20:41]
    mirrored = run.axes[::-1, :21] * np.array([-1.0, 1.0, 1.0])
    assert np.abs(half - mirrored).max() < 1e-9
    assert run.axes[0, 0, 0] == pytest.approx(0.2, abs=1e-12)
    other = simulate(orbit.scene, np.linspace(0, 0.9 * turn, 3), "minimal", 1e-12)
    assert np.abs(other.axes[:, -1] - other.axes[:, 0]).max() > 1e-3


@pytest.mark.parametrize(
    ("name", "order"),
    [
        *((name, order) for name in ("heavy bar", "short bar") for order in (2, 3, 5)),
        *(("long bar, other rotor", order) for order in (1, 4)),
        ("short bar", 9),
    ],
)
def test_errors_fall_with_the_order(name: str, order: int) -> None:
    """Error of the axes against the exact orbit ~ r_0**(order + 1), of the frequency ~ r_0**(next even power)."""
    scene = SCENES[name]
    shape, ratio = scene.sigma, scene.k
    amplitudes = {1: (0.04, 0.05, 0.06), 9: (0.13, 0.15, 0.17)}.get(order, (0.06, 0.08, 0.1))
    phases = np.linspace(0, 2 * np.pi, 33)
    axes_errors, rate_errors = [], []
    for amplitude in amplitudes:
        orbit = exact_orbit(scene, amplitude)
        run = simulate(orbit.scene, phases / abs(orbit.frequency), "minimal", 1e-13)
        sign = np.sign(orbit.frequency)
        series = np.array(corrected_trajectories(order)(amplitude, sign * phases, shape, ratio)).reshape(2, 3, -1)
        axes_errors.append(np.abs(series.transpose(0, 2, 1) - run.axes).max())
        rate = paired_frequency(order)(amplitude, shape, ratio) * natural_rate(scene)
        rate_errors.append(abs(rate - abs(orbit.frequency)))
    assert measured_order(amplitudes, axes_errors) == pytest.approx(order + 1, abs=0.35)
    assert measured_order(amplitudes, rate_errors) == pytest.approx(2 * (order // 2 + 1), abs=0.2)


def test_the_momentum_is_that_of_exact_orbits() -> None:
    scene, off = SCENES["long bar, other rotor"], []
    for r in (0.05, 0.1, 0.2):
        run = simulate(exact_orbit(scene, r).scene, [0.0, 0.3], "minimal", 1e-13)
        P = run.joint_line_momentum[1] / scene.momenta[0]
        off.append(abs(float(paired_momentum(4)(r, scene.sigma, scene.k)) - P))
    assert measured_order((0.05, 0.1, 0.2), off) == pytest.approx(6, abs=0.3)


def test_a_paired_scene_stays_on_the_orbit_and_a_plain_one_drifts() -> None:
    """The trap: a displaced start without its second-order velocity drifts in y."""
    scene = SCENES["massless"]
    t = np.linspace(0, 10, 201)
    amplitude = 0.204
    paired = simulate(paired_scene(scene, amplitude), t, "minimal", 1e-10)
    first = Scene(
        spins=(10, -10),
        axes=((amplitude, 0, np.sqrt(1 - amplitude**2)),) * 2,
        rates=((0, 8 * amplitude, 0), (0, -8 * amplitude, 0)),
    )
    plain = simulate(first, t, "minimal", 1e-10)
    mean = [abs(run.tips[:, -50:, 1].mean()) for run in (paired, plain)]
    assert mean[0] < 1e-3
    assert mean[1] > 0.3


def test_refusals() -> None:
    with pytest.raises(InputError, match="opposite spins"):
        exact_orbit(Scene(spins=(10, 10)), 0.1)
    with pytest.raises(InputError, match="opposite spins"):
        paired_scene(Scene(spins=(10, -9)), 0.1)
    with pytest.raises(DomainError, match="sine"):
        exact_orbit(SCENES["massless"], 1.5)
    with pytest.raises(DomainError, match="sine"):
        paired_scene(SCENES["massless"], 1.5)
    kept = paired_scene(Scene(spins=(10, -10), shock=Shock((1, 0, 0), 1, 0.1)), 0.1)
    assert kept.shock is not None
    with pytest.raises(InputError, match="order = 100 is above 16, from where it takes minutes"):
        corrected_trajectories(100)
    with pytest.raises(InputError, match="order = 33 is above 32"):
        series_orbit(SCENES["massless"], 0.1, 33)
    assert series_orbit(SCENES["massless"], 0.1, 17).error < 1e-12
